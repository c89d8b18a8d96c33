//! The apple's spheroid fitted to its surface and outline: a sphere flattened along its stem.

use super::ray::nearest_on_ray;
use crate::optics::DepthNoise;
use nalgebra::{Matrix3, Point3, SMatrix, SVector, Unit, Vector3};
use pomona_geometry::Sphere;

/// A flattened sphere: its surface lies at R(u) = r (1 − f (u·a)²) along the unit vector u from the centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spheroid {
    /// Centre of the largest circle.
    pub(crate) center: Point3<f64>,
    /// Radius r of that circle.
    pub(crate) radius: f64,
    /// Share f by which the poles are lower.
    pub(crate) flattening: f64,
    /// Direction a of the poles.
    pub(crate) axis: Unit<Vector3<f64>>,
}

impl Spheroid {
    pub(crate) fn round(sphere: &Sphere, axis: Unit<Vector3<f64>>) -> Self {
        Self {
            center: sphere.center,
            radius: sphere.radius,
            flattening: 0.0,
            axis,
        }
    }

    pub(crate) fn sphere(&self) -> Sphere {
        Sphere {
            center: self.center,
            radius: self.radius,
        }
    }

    /// Distance of a point from the surface along the ray from the centre, negative inside.
    pub(crate) fn signed_distance(&self, p: &Point3<f64>) -> f64 {
        let d = p - self.center;
        let rho = d.norm().max(1e-9);
        let s = d.dot(&self.axis) / rho;
        rho - self.radius * (1.0 - self.flattening * s * s)
    }
}

/// The prior of an apple: means and standard deviations before it is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpheroidPrior {
    pub(crate) radius: (f64, f64),
    pub(crate) flattening: (f64, f64),
    pub(crate) axis: Unit<Vector3<f64>>,
    pub(crate) axis_sd: f64,
    /// Of what the model leaves out of the surface, metres.
    pub(crate) shape_sd: f64,
}

/// What a spheroid is fitted to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceObservations<'a> {
    /// Points on the surface, each with its noise as a share of that of one reading.
    pub(crate) points: &'a [(Point3<f64>, f64)],
    /// Rays that graze the spheroid.
    pub(crate) rays: &'a [Unit<Vector3<f64>>],
    /// Standard deviation of the distance of a grazing ray from the surface, metres.
    pub(crate) ray_sd: f64,
    pub(crate) noise: DepthNoise,
}

/// The iterations of a fit, and what it holds fixed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FitSchedule<'a> {
    /// Where the robust weight ends, in standard deviations, for each step.
    pub(crate) cuts: &'a [f64],
    /// Whether the shape stays that of the start.
    pub(crate) fix_shape: bool,
    /// Whether the start is so good that rays far off are errors; otherwise background that is seen through the spheroid
    /// pushes however far off it is.
    pub(crate) reject_outlying_rays: bool,
}

/// A fitted spheroid with its uncertainty.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpheroidFit {
    pub(crate) spheroid: Spheroid,
    /// Covariance of the centre, m².
    pub(crate) covariance: Matrix3<f64>,
    /// Standard deviation of the radius, m.
    pub(crate) radius_sd: f64,
    /// Root mean square of the residuals of what supports it, m.
    pub(crate) rms: f64,
    /// Sum of the robust weights of the points.
    pub(crate) weight: f64,
}

/// Parameters of a spheroid: centre, radius, flattening, and two turns of its axis.
const N: usize = 7;

/// Largest turn of the axis in one step, radians.
const MAX_TURN_RAD: f64 = 0.5;

/// Largest shift of the centre in one step, metres: no apple's fit needs more.
const MAX_SHIFT_M: f64 = 0.03;

/// Flattening within which a fit stays: apples are up to a quarter lower than wide, some a little higher.
const FLATTENING_RANGE: (f64, f64) = (-0.05, 0.25);

/// Variance of a reading across its ray, as a share of that along it.
const LATERAL_NOISE: f64 = 0.02;

/// Standard deviations from which the weight of a ray that enters the spheroid falls as 1/|e| (Huber 1964, doi
/// 10.1214/aoms/1177703732): background seen through it counts however deep it is.
const OUTSIDE_HUBER: f64 = 0.7;

/// Weight of Tukey's biweight for a residual of `e` scales, 0 from `cut` on.
pub(crate) fn biweight(e: f64, cut: f64) -> f64 {
    let q = e / cut;
    if q.abs() < 1.0 {
        (1.0 - q * q).powi(2)
    } else {
        0.0
    }
}

/// Two unit vectors across `axis` and each other.
fn across(axis: &Unit<Vector3<f64>>) -> (Vector3<f64>, Vector3<f64>) {
    let mut helper = Vector3::zeros();
    helper[axis.iamin()] = 1.0;
    let e = axis.cross(&helper).normalize();
    (e, axis.cross(&e))
}

/// Refines `start` by reweighted Gauss–Newton steps on the distances of points and grazing rays from the surface.
///
/// A point's variance is that of its depth reading seen along the surface's normal, plus that of the shape. A
/// ray's distance is that of its point nearest to the centre. `None` where too little supports the spheroid or nothing
/// determines it.
pub(crate) fn fit_spheroid(
    observations: &SurfaceObservations<'_>,
    start: Spheroid,
    prior: &SpheroidPrior,
    schedule: &FitSchedule<'_>,
) -> Option<SpheroidFit> {
    const LEAST_WEIGHT: f64 = 6.0;
    let mut spheroid = start;
    let mut last = None;
    for &cut in schedule.cuts {
        let mut equations = NormalEquations::of(
            observations,
            &spheroid,
            prior.shape_sd,
            cut,
            schedule.reject_outlying_rays,
        );
        equations.add_prior(&spheroid, prior);
        if schedule.fix_shape {
            equations.hold_fixed(4..N);
        }
        if equations.weights < LEAST_WEIGHT {
            return None;
        }
        let factor = equations.normal.cholesky()?;
        spheroid = stepped(&spheroid, &factor.solve(&(-equations.gradient)))?;
        last = Some((factor.inverse(), equations));
    }
    let (inverse, equations) = last?;
    // Scatter beyond what was assumed widens the covariance.
    let excess = (equations.squares / equations.weights.max(1.0)).max(1.0);
    Some(SpheroidFit {
        spheroid,
        covariance: inverse.fixed_view::<3, 3>(0, 0).into_owned() * excess,
        radius_sd: (inverse[(3, 3)] * excess).sqrt(),
        rms: (equations.raw / equations.weights.max(1e-9)).sqrt(),
        weight: equations.point_weights,
    })
}

fn stepped(spheroid: &Spheroid, step: &SVector<f64, N>) -> Option<Spheroid> {
    let (e, f) = across(&spheroid.axis);
    // Steps that no apple's fit needs are cut short.
    let turn = (e * step[5] + f * step[6]).cap_magnitude(MAX_TURN_RAD);
    let shift = Vector3::new(step[0], step[1], step[2]).cap_magnitude(MAX_SHIFT_M);
    let next = Spheroid {
        center: spheroid.center + shift,
        radius: (spheroid.radius + step[3]).clamp(0.5 * spheroid.radius, 2.0 * spheroid.radius),
        flattening: (spheroid.flattening + step[4]).clamp(FLATTENING_RANGE.0, FLATTENING_RANGE.1),
        axis: Unit::try_new(spheroid.axis.into_inner() + turn, 1e-9)?,
    };
    let finite = next.center.iter().all(|c| c.is_finite()) && next.radius.is_finite();
    finite.then_some(next)
}

/// The normal equations of one step.
struct NormalEquations {
    normal: SMatrix<f64, N, N>,
    gradient: SVector<f64, N>,
    weights: f64,
    point_weights: f64,
    squares: f64,
    raw: f64,
}

impl NormalEquations {
    fn of(
        observations: &SurfaceObservations<'_>,
        spheroid: &Spheroid,
        shape_sd: f64,
        cut: f64,
        reject_outlying_rays: bool,
    ) -> Self {
        let mut equations = Self {
            normal: SMatrix::zeros(),
            gradient: SVector::zeros(),
            weights: 0.0,
            point_weights: 0.0,
            squares: 0.0,
            raw: 0.0,
        };
        let frame = across(&spheroid.axis);
        let shape = shape_sd * shape_sd;
        for (p, share) in observations.points {
            let d = p - spheroid.center;
            let along = d.dot(&p.coords).powi(2) / (d.norm_squared() * p.coords.norm_squared());
            let reading = (observations.noise.sigma(p.z) * share).powi(2);
            // Seen at a slant a reading's noise lies within the surface, but for that of its place on the image.
            let variance = shape + reading * (along + LATERAL_NOISE);
            equations.point_weights +=
                equations.add(spheroid, &frame, p, variance, |e| biweight(e, cut));
        }
        let variance = shape + observations.ray_sd.powi(2);
        for ray in observations.rays {
            let p = nearest_on_ray(ray, &spheroid.center);
            equations.add(spheroid, &frame, &p, variance, |e| {
                if e < 0.0 && !reject_outlying_rays {
                    (OUTSIDE_HUBER / -e).min(1.0)
                } else {
                    biweight(e, cut)
                }
            });
        }
        for a in 0..N {
            for b in 0..a {
                equations.normal[(a, b)] = equations.normal[(b, a)];
            }
        }
        equations
    }

    /// Adds a point that should lie on the surface; its robust weight is returned.
    #[inline]
    fn add(
        &mut self,
        spheroid: &Spheroid,
        (e1, e2): &(Vector3<f64>, Vector3<f64>),
        p: &Point3<f64>,
        variance: f64,
        robust: impl Fn(f64) -> f64,
    ) -> f64 {
        let (r, f) = (spheroid.radius, spheroid.flattening);
        let d = p - spheroid.center;
        let rho = d.norm().max(1e-9);
        let u = d / rho;
        let s = u.dot(&spheroid.axis);
        let residual = rho - r * (1.0 - f * s * s);
        let scaled = residual / variance.sqrt();
        let robust = robust(scaled);
        if robust == 0.0 {
            return 0.0;
        }
        let w = robust / variance;
        let g = 2.0 * r * f * s;
        let by_center = -u - (spheroid.axis.into_inner() - u * s) * (g / rho);
        let row = [
            by_center.x,
            by_center.y,
            by_center.z,
            -1.0 + f * s * s,
            r * s * s,
            g * u.dot(e1),
            g * u.dot(e2),
        ];
        for (a, ra) in row.iter().enumerate() {
            let wa = w * ra;
            self.gradient[a] += wa * residual;
            for (b, rb) in row.iter().enumerate().skip(a) {
                self.normal[(a, b)] += wa * rb;
            }
        }
        self.weights += robust;
        self.squares += robust * scaled * scaled;
        self.raw += robust * residual * residual;
        robust
    }

    fn add_prior(&mut self, spheroid: &Spheroid, prior: &SpheroidPrior) {
        let (e1, e2) = across(&spheroid.axis);
        // An axis has no sign.
        let expected = prior.axis.into_inner() * spheroid.axis.dot(&prior.axis).signum();
        let off = spheroid.axis.into_inner() - expected;
        let priors = [
            (3, spheroid.radius - prior.radius.0, prior.radius.1),
            (
                4,
                spheroid.flattening - prior.flattening.0,
                prior.flattening.1,
            ),
            (5, off.dot(&e1), prior.axis_sd),
            (6, off.dot(&e2), prior.axis_sd),
        ];
        for (k, off, sd) in priors {
            let w = 1.0 / (sd * sd);
            self.normal[(k, k)] += w;
            self.gradient[k] += w * off;
        }
        // So weak that it only keeps the matrix regular.
        for k in 0..3 {
            self.normal[(k, k)] += 1.0;
        }
    }

    fn hold_fixed(&mut self, parameters: std::ops::Range<usize>) {
        for k in parameters {
            self.normal.row_mut(k).fill(0.0);
            self.normal.column_mut(k).fill(0.0);
            self.normal[(k, k)] = 1.0;
            self.gradient[k] = 0.0;
        }
    }
}
