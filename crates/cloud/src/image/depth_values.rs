use crate::DepthImage;
use pomona_files::Malformed;

/// A depth image as a file holds it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DepthValues {
    /// Whole numbers, in units of [`crate::Camera::depth_scale`].
    Units(DepthImage),
    /// Floating point: metres, unless the camera states another unit (REP-118).
    Metres {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// `width * height` values, row by row; 0, negative and not finite is 'no reading'.
        values: Vec<f32>,
    },
}

/// Metres to a unit of the image that floating point is rounded to, where all of it fits into 16 bits: far below the
/// noise of any depth camera.
const UNIT_M: f64 = 1e-4;

/// Median depths that a camera on fruit can have, in metres.
const PLAUSIBLE_M: std::ops::Range<f64> = 0.05..200.0;

impl DepthValues {
    /// Values of a file, in floating point or whole numbers.
    pub(super) fn new(
        width: usize,
        height: usize,
        values: Vec<f64>,
        is_floating: bool,
    ) -> Result<Self, Malformed> {
        if values.len() != width * height {
            let problem = format!("{} values came out for {width}x{height}", values.len());
            return Err(Malformed::new(
                "data",
                problem,
                "write the file again; it is damaged",
            ));
        }
        if is_floating {
            let values = values.into_iter().map(|value| value as f32).collect();
            return Ok(Self::Metres {
                width,
                height,
                values,
            });
        }
        if let Some(large) = values.iter().find(|value| **value > f64::from(u16::MAX)) {
            let problem = format!(
                "a reading of {large}, where depth has 16 bits: at most {}",
                u16::MAX
            );
            let remedy = "store depth in a larger unit, such as 0.1 mm or 1 mm, and state it as `depth_scale`";
            return Err(Malformed::new("data", problem, remedy));
        }
        // Below zero is no reading.
        let readings = values.into_iter().map(|value| value as u16).collect();
        Ok(Self::Units(DepthImage {
            width,
            height,
            readings,
        }))
    }

    /// The image in 16 bits, and the metres to its unit, of a file whose values count `scale` metres each; for floating
    /// point `None` is metres.
    ///
    /// # Errors
    ///
    /// Where depths in floating point cannot be those of fruit under this scale.
    pub(crate) fn in_units(
        self,
        scale: Option<f64>,
    ) -> Result<(DepthImage, Option<f64>), Malformed> {
        let (width, height, values) = match self {
            Self::Units(image) => return Ok((image, None)),
            Self::Metres {
                width,
                height,
                values,
            } => (width, height, values),
        };
        let factor = scale.unwrap_or(1.0);
        let mut depths: Vec<f64> = values
            .iter()
            .map(|value| f64::from(*value) * factor)
            .collect();
        for depth in &mut depths {
            if !depth.is_finite() || *depth < 0.0 {
                *depth = 0.0;
            }
        }
        let mut known: Vec<f64> = depths
            .iter()
            .copied()
            .filter(|depth| *depth > 0.0)
            .collect();
        known.sort_by(f64::total_cmp);
        let (median, most) = (known.get(known.len() / 2), known.last());
        let unit = match (median, most) {
            (Some(median), _) if !PLAUSIBLE_M.contains(median) => {
                let problem = format!(
                    "half of the depths are up to {median} m, at {factor} m to 1.0 of this floating-point image"
                );
                let remedy = "state in the camera's `depth_scale` how many metres 1.0 is: 1 for metres, 0.001 for millimetres";
                return Err(Malformed::new("depths", problem, remedy));
            }
            (_, Some(most)) => UNIT_M.max(most / f64::from(u16::MAX)),
            (_, None) => UNIT_M,
        };
        let readings = depths
            .iter()
            .map(|depth| (depth / unit).round() as u16)
            .collect();
        let image = DepthImage {
            width,
            height,
            readings,
        };
        Ok((image, Some(unit)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metres(values: &[f32]) -> DepthValues {
        DepthValues::Metres {
            width: values.len(),
            height: 1,
            values: values.to_vec(),
        }
    }

    #[test]
    fn floating_point_becomes_tenths_of_millimetres() {
        let (image, unit) = metres(&[1.25, f32::NAN, -1.0, 0.5, f32::INFINITY])
            .in_units(None)
            .unwrap();
        assert_eq!(
            (image.readings, unit),
            (vec![12500, 0, 0, 5000, 0], Some(1e-4))
        );
        let (image, unit) = metres(&[1250.0, 900.0]).in_units(Some(1e-3)).unwrap();
        assert_eq!((image.readings, unit), (vec![12500, 9000], Some(1e-4)));
        // A far wall needs a longer unit.
        let (image, unit) = metres(&[13.107, 2.0, 3.0]).in_units(None).unwrap();
        assert_eq!((image.readings[0], image.readings[1]), (65535, 10000));
        assert!((unit.unwrap() - 2e-4).abs() < 1e-9);
        let (image, _) = metres(&[0.0, 0.0]).in_units(None).unwrap();
        assert_eq!(image.readings, [0, 0]);
    }

    #[test]
    fn a_scale_that_cannot_be_is_refused() {
        for (values, scale) in [(&[1.2_f32, 1.4][..], Some(1e-3)), (&[1200.0, 1400.0], None)] {
            let fault = metres(values).in_units(scale).unwrap_err();
            assert!(fault.remedy.contains("depth_scale"), "{fault:?}");
        }
    }

    #[test]
    fn more_than_16_bits_are_refused() {
        let fault = DepthValues::new(1, 1, vec![70000.0], false).unwrap_err();
        assert!(fault.problem.contains("70000"), "{fault:?}");
        let DepthValues::Units(image) = DepthValues::new(2, 1, vec![-3.0, 65535.0], false).unwrap()
        else {
            panic!("no units");
        };
        assert_eq!(image.readings, [0, 65535]);
    }
}
