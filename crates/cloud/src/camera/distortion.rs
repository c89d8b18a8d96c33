use super::error::CameraError;
use super::lens::Lens;
use serde::{Deserialize, Serialize};

/// Lens distortion, by model name and coefficients in OpenCV's order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distortion {
    /// Name of the model, for example `plumb_bob`; the names of ROS, `RealSense`, Kalibr and OpenCV are known.
    pub model: String,
    /// Its coefficients.
    pub coefficients: Vec<f64>,
}

impl Distortion {
    /// The distortion that a file describes: `None` for one that bends nothing. A model that is not named is told by
    /// the number of its coefficients, as OpenCV does.
    pub(super) fn from_file(model: &str, coefficients: Vec<f64>) -> Option<Self> {
        let model = match canonical(model) {
            name if name.is_empty() && coefficients.len() > 5 => "rational_polynomial".to_owned(),
            name if name.is_empty() => "plumb_bob".to_owned(),
            name => name,
        };
        // Of the fisheye model, zeros are a lens of their own.
        let is_fisheye = EQUIDISTANT.contains(&&*model);
        let bends = is_fisheye || coefficients.iter().any(|&c| c != 0.0);
        bends.then_some(Self {
            model,
            coefficients,
        })
    }
}

/// Radial and tangential distortion: names in ROS, in `RealSense`, and in Kalibr.
const PLUMB_BOB: [&str; 4] = ["plumb_bob", "brown_conrady", "radtan", "radial_tangential"];
/// The same with a denominator.
const RATIONAL: [&str; 2] = ["rational_polynomial", "rational"];
/// Kannala and Brandt's model: names in ROS and Kalibr, in OpenCV, and in `RealSense`.
const EQUIDISTANT: [&str; 4] = [
    "equidistant",
    "fisheye",
    "kannala_brandt",
    "kannala_brandt4",
];
/// The polynomial that leads from pixels to rays.
const INVERSE: &str = "inverse_brown_conrady";
const NONE: [&str; 2] = ["none", ""];

/// A model's name as programs write it (`distortion.brown_conrady`, `Inverse Brown Conrady`) in one form.
fn canonical(model: &str) -> String {
    let name = model.trim().to_ascii_lowercase().replace([' ', '-'], "_");
    let name = name.strip_prefix("rs2_distortion_").unwrap_or(&name);
    name.strip_prefix("distortion.").unwrap_or(name).to_owned()
}

impl TryFrom<&Distortion> for Lens {
    type Error = CameraError;

    fn try_from(distortion: &Distortion) -> Result<Self, CameraError> {
        let Distortion {
            model,
            coefficients,
        } = distortion;
        let wrong_count = |expected| CameraError::CoefficientCount {
            model: model.clone(),
            expected,
            found: coefficients.len(),
        };
        if let Some(&value) = coefficients.iter().find(|c| !c.is_finite()) {
            return Err(CameraError::NotFinite {
                field: "distortion.coefficients",
                value,
            });
        }
        let name = canonical(model);
        let is = |names: &[&str]| names.contains(&&*name);
        // Programs pad with zeros what their model does not have.
        let used = coefficients
            .iter()
            .rposition(|&c| c != 0.0)
            .map_or(0, |i| i + 1);
        let polynomial = || match coefficients[..] {
            [k1, k2, p1, p2] => Ok(([k1, k2, 0.0, 0.0, 0.0, 0.0], [p1, p2])),
            [k1, k2, p1, p2, k3, ..] if used <= 5 => Ok(([k1, k2, k3, 0.0, 0.0, 0.0], [p1, p2])),
            _ => Err(wrong_count("5 (or 4, k3 being 0)")),
        };
        if is(&PLUMB_BOB) {
            let (k, p) = polynomial()?;
            Ok(Self::radial(k, p))
        } else if name == INVERSE {
            let (k, p) = polynomial()?;
            Ok(if used == 0 {
                Self::Pinhole
            } else {
                Self::InverseRadial { k, p }
            })
        } else if is(&RATIONAL) {
            match coefficients[..] {
                [k1, k2, p1, p2, k3, k4, k5, k6] => {
                    Ok(Self::radial([k1, k2, k3, k4, k5, k6], [p1, p2]))
                }
                // OpenCV's further ones: thin prism s1 … s4, and the tilt of the sensor.
                [k1, k2, p1, p2, k3, k4, k5, k6, ..] if matches!(coefficients.len(), 12 | 14) => {
                    if used > 8 {
                        return Err(CameraError::ThinPrism {
                            model: model.clone(),
                        });
                    }
                    Ok(Self::radial([k1, k2, k3, k4, k5, k6], [p1, p2]))
                }
                _ => Err(wrong_count("8 (or 12 or 14, the further ones being 0)")),
            }
        } else if is(&EQUIDISTANT) {
            match coefficients[..] {
                [k1, k2, k3, k4] => Ok(Self::Equidistant {
                    k: [k1, k2, k3, k4],
                }),
                [k1, k2, k3, k4, _] if used <= 4 => Ok(Self::Equidistant {
                    k: [k1, k2, k3, k4],
                }),
                _ => Err(wrong_count("4 (k1 k2 k3 k4)")),
            }
        } else if is(&NONE) {
            if used > 0 {
                return Err(wrong_count("none, or zeros"));
            }
            Ok(Self::Pinhole)
        } else {
            Err(CameraError::UnknownModel {
                model: model.clone(),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens(model: &str, coefficients: &[f64]) -> Result<Lens, CameraError> {
        Lens::try_from(&Distortion {
            model: model.to_owned(),
            coefficients: coefficients.to_vec(),
        })
    }

    #[test]
    fn every_programs_name_of_a_model_is_known() {
        let brown = lens("plumb_bob", &[0.1, -0.2, 0.001, 0.002, 0.05]).unwrap();
        for name in [
            "radtan",
            "brown_conrady",
            "Brown Conrady",
            "distortion.brown_conrady",
            "RS2_DISTORTION_BROWN_CONRADY",
        ] {
            let same = lens(name, &[0.1, -0.2, 0.001, 0.002, 0.05, 0.0, 0.0, 0.0]);
            assert_eq!(same.unwrap(), brown, "{name}");
        }
        let fisheye = lens("equidistant", &[0.1, 0.2, 0.3, 0.4]).unwrap();
        assert_eq!(fisheye, lens("fisheye", &[0.1, 0.2, 0.3, 0.4]).unwrap());
        let padded = [0.1, 0.2, 0.3, 0.4, 0.0];
        assert_eq!(fisheye, lens("Kannala Brandt4", &padded).unwrap());
        for name in ["none", "None", "distortion.none", ""] {
            assert_eq!(lens(name, &[0.0; 5]).unwrap(), Lens::Pinhole, "{name}");
        }
        assert_eq!(lens("none", &[]).unwrap(), Lens::Pinhole);
        assert!(lens("none", &[0.1]).is_err());
    }

    #[test]
    fn further_coefficients_count_only_where_they_are_not_zero() {
        let eight = [0.5, -2.7, 0.0007, -0.0001, 1.5, 0.38, -2.5, 1.46];
        let rational = lens("rational_polynomial", &eight).unwrap();
        for length in [12, 14] {
            let mut longer = eight.to_vec();
            longer.resize(length, 0.0);
            assert_eq!(lens("rational_polynomial", &longer).unwrap(), rational);
            longer[9] = 0.001;
            let error = lens("rational_polynomial", &longer).unwrap_err();
            assert!(error.to_string().contains("thin-prism"), "{error}");
        }
        assert!(lens("plumb_bob", &eight).is_err());
    }

    #[test]
    fn a_model_without_a_name_is_told_by_its_coefficients() {
        let model = |count: usize| Distortion::from_file("", vec![0.1; count]).unwrap().model;
        assert_eq!(model(5), "plumb_bob");
        assert_eq!(model(8), "rational_polynomial");
        assert_eq!(Distortion::from_file("plumb_bob", vec![0.0; 5]), None);
        assert!(Distortion::from_file("equidistant", vec![0.0; 4]).is_some());
    }
}
