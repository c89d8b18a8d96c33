use super::error::CameraError;
use serde::{Deserialize, Serialize};

/// Lens distortion, by model name and coefficients in OpenCV's order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distortion {
    /// Name of the model, for example `plumb_bob`.
    pub model: String,
    /// Its coefficients.
    pub coefficients: Vec<f64>,
}

/// A lens: how the ray (x/z, y/z) of a point is bent before it meets the image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Lens {
    /// No distortion.
    Pinhole,
    /// Radial and tangential distortion; the polynomial model has k4 = k5 = k6 = 0.
    ///
    /// With r² = x² + y² and
    /// g = (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶),
    /// x' = g x + 2 p1 x y + p2 (r² + 2x²) and y' = g y + p1 (r² + 2y²) + 2 p2 x y:
    /// Brown, Close-range camera calibration, 1971, in the form of OpenCV's `calib3d`.
    Radial {
        /// k1 … k6.
        k: [f64; 6],
        /// p1, p2.
        p: [f64; 2],
    },
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
        let (k, p) = match model.as_str() {
            "plumb_bob" | "brown_conrady" => match coefficients[..] {
                [k1, k2, p1, p2] => ([k1, k2, 0.0, 0.0, 0.0, 0.0], [p1, p2]),
                [k1, k2, p1, p2, k3] => ([k1, k2, k3, 0.0, 0.0, 0.0], [p1, p2]),
                _ => return Err(wrong_count("5 (or 4, k3 being 0)")),
            },
            "rational_polynomial" => match coefficients[..] {
                [k1, k2, p1, p2, k3, k4, k5, k6] => ([k1, k2, k3, k4, k5, k6], [p1, p2]),
                _ => return Err(wrong_count("8")),
            },
            _ => {
                return Err(CameraError::UnknownModel {
                    model: model.clone(),
                });
            }
        };
        if let Some(&value) = coefficients.iter().find(|c| !c.is_finite()) {
            return Err(CameraError::NotFinite {
                field: "distortion.coefficients",
                value,
            });
        }
        let bends = k.iter().chain(&p).any(|&c| c != 0.0);
        Ok(if bends {
            Self::Radial { k, p }
        } else {
            Self::Pinhole
        })
    }
}

/// Where a ray lands, and the Jacobian [∂x'/∂x, ∂x'/∂y, ∂y'/∂x, ∂y'/∂y] there.
struct Bent {
    x: f64,
    y: f64,
    jacobian: [f64; 4],
}

impl Bent {
    fn determinant(&self) -> f64 {
        self.jacobian[0] * self.jacobian[3] - self.jacobian[1] * self.jacobian[2]
    }
}

fn bend(k: &[f64; 6], p: &[f64; 2], x: f64, y: f64) -> Bent {
    let r2 = x * x + y * y;
    let numerator = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
    let denominator = 1.0 + r2 * (k[3] + r2 * (k[4] + r2 * k[5]));
    let gain = numerator / denominator;
    // dg/d(r²), by the quotient rule.
    let numerator_slope = k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[2]);
    let denominator_slope = k[3] + r2 * (2.0 * k[4] + r2 * 3.0 * k[5]);
    let slope = (numerator_slope - gain * denominator_slope) / denominator;
    let cross = 2.0 * slope * x * y + 2.0 * p[0] * x + 2.0 * p[1] * y;
    Bent {
        x: gain * x + 2.0 * p[0] * x * y + p[1] * (r2 + 2.0 * x * x),
        y: gain * y + p[0] * (r2 + 2.0 * y * y) + 2.0 * p[1] * x * y,
        jacobian: [
            gain + 2.0 * slope * x * x + 2.0 * p[0] * y + 6.0 * p[1] * x,
            cross,
            cross,
            gain + 2.0 * slope * y * y + 6.0 * p[0] * y + 2.0 * p[1] * x,
        ],
    }
}

impl Lens {
    /// Where the ray (x, y) lands on the plane z = 1; `None` where the model has folded
    /// over, so that a ray further out would land further in.
    pub fn distort(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        match self {
            Self::Pinhole => Some((x, y)),
            Self::Radial { k, p } => {
                let bent = bend(k, p, x, y);
                (bent.determinant() > 0.0).then_some((bent.x, bent.y))
            }
        }
    }

    /// The ray that lands at (x, y) on the plane z = 1, by Newton's method; `None`
    /// where the iteration does not converge or leaves the unfolded part of the model.
    pub fn undistort(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        const ITERATIONS: usize = 40;
        /// Allowed residual on the plane z = 1: a millionth of a pixel at f = 10⁴ px.
        const TOLERANCE: f64 = 1e-10;
        let (k, p) = match self {
            Self::Pinhole => return (x.is_finite() && y.is_finite()).then_some((x, y)),
            Self::Radial { k, p } => (k, p),
        };
        let (mut ray_x, mut ray_y) = (x, y);
        for _ in 0..ITERATIONS {
            let bent = bend(k, p, ray_x, ray_y);
            let (error_x, error_y) = (x - bent.x, y - bent.y);
            let determinant = bent.determinant();
            // Also refuses NaN.
            if determinant.is_nan() || determinant <= 0.0 {
                return None;
            }
            let [xx, xy, yx, yy] = bent.jacobian;
            let step_x = (yy * error_x - xy * error_y) / determinant;
            let step_y = (xx * error_y - yx * error_x) / determinant;
            (ray_x, ray_y) = (ray_x + step_x, ray_y + step_y);
            if error_x.hypot(error_y) < TOLERANCE {
                return Some((ray_x, ray_y));
            }
        }
        None
    }
}
