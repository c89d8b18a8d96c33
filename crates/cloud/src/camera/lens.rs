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
    /// The formula of [`Lens::Radial`] from the image plane to rays, so that it is the distortion that is its inverse:
    /// `inverse_brown_conrady` as librealsense documents it.
    InverseRadial {
        /// k1 … k6.
        k: [f64; 6],
        /// p1, p2.
        p: [f64; 2],
    },
    /// A fisheye lens: a ray at the angle θ from the axis lands at the distance θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸)
    /// from the centre. Kannala and Brandt, A generic camera model and calibration method for conventional, wide-angle,
    /// and fish-eye lenses, 2006, in the form of OpenCV's `fisheye`.
    Equidistant {
        /// k1 … k4.
        k: [f64; 4],
    },
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

    /// Where it lands; `None` where the model has folded over.
    fn unfolded(&self) -> Option<(f64, f64)> {
        (self.determinant() > 0.0).then_some((self.x, self.y))
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

/// Allowed residual on the plane z = 1: a millionth of a pixel at f = 10⁴ px.
const TOLERANCE: f64 = 1e-10;
/// Newton's method needs a few; one that does not settle in so many does not converge.
const ITERATIONS: usize = 40;

/// What is bent to (x, y), by Newton's method; `None` where the iteration does not converge or leaves the unfolded
/// part of the model.
fn unbend(k: &[f64; 6], p: &[f64; 2], x: f64, y: f64) -> Option<(f64, f64)> {
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

/// How far from the centre a ray at the angle `theta` lands, and the derivative by it.
fn fisheye(k: &[f64; 4], theta: f64) -> (f64, f64) {
    let t2 = theta * theta;
    let gain = 1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])));
    let slope = 1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
    (theta * gain, slope)
}

/// The angle from the axis of what lands at `distance` from the centre, below a right angle.
fn fisheye_angle(k: &[f64; 4], distance: f64) -> Option<f64> {
    let mut theta = distance;
    for _ in 0..ITERATIONS {
        let (lands, slope) = fisheye(k, theta);
        let error = distance - lands;
        // Also refuses NaN.
        if slope.is_nan() || slope <= 0.0 {
            return None;
        }
        theta += error / slope;
        if error.abs() < TOLERANCE {
            return (theta < std::f64::consts::FRAC_PI_2).then_some(theta);
        }
    }
    None
}

impl Lens {
    /// A lens with these coefficients of [`Lens::Radial`]; a pinhole where all are 0.
    pub(super) fn radial(k: [f64; 6], p: [f64; 2]) -> Self {
        if k.iter().chain(&p).any(|&c| c != 0.0) {
            Self::Radial { k, p }
        } else {
            Self::Pinhole
        }
    }

    /// Where the ray (x, y) lands on the plane z = 1; `None` where the model has folded
    /// over, so that a ray further out would land further in.
    pub fn distort(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        match self {
            Self::Pinhole => Some((x, y)),
            Self::Radial { k, p } => bend(k, p, x, y).unfolded(),
            Self::InverseRadial { k, p } => unbend(k, p, x, y),
            Self::Equidistant { k } => {
                let r = x.hypot(y);
                let (distance, slope) = fisheye(k, r.atan());
                // On the axis the gain is 1.
                let gain = if r > 0.0 { distance / r } else { 1.0 };
                (slope > 0.0 && gain.is_finite()).then_some((gain * x, gain * y))
            }
        }
    }

    /// The ray that lands at (x, y) on the plane z = 1; `None` where the model has no inverse there, or folds over.
    pub fn undistort(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        match self {
            Self::Pinhole => (x.is_finite() && y.is_finite()).then_some((x, y)),
            Self::Radial { k, p } => unbend(k, p, x, y),
            Self::InverseRadial { k, p } => bend(k, p, x, y).unfolded(),
            Self::Equidistant { k } => {
                let distance = x.hypot(y);
                let theta = fisheye_angle(k, distance)?;
                let gain = if distance > 0.0 {
                    theta.tan() / distance
                } else {
                    1.0
                };
                Some((gain * x, gain * y))
            }
        }
    }
}
