use nalgebra::Point3;
use pomona_geometry::Circle;

/// The circle through three points.
///
/// With the first point as origin, p and q the others and n = p × q, the centre is
/// (|p|² q − |q|² p) × n / (2 |n|²).
///
/// `None` where they lie on one line (the sine of the angle at the first under 1e-9), coincide, or
/// are not finite.
pub fn circle_through(points: [Point3<f64>; 3]) -> Option<Circle> {
    let (p, q) = (points[1] - points[0], points[2] - points[0]);
    let normal = p.cross(&q);
    // Written so that NaN refuses as well.
    if !(normal.norm() > 1e-9 * p.norm() * q.norm()) {
        return None;
    }
    let center = (q * p.norm_squared() - p * q.norm_squared()).cross(&normal)
        / (2.0 * normal.norm_squared());
    Circle::new(points[0] + center, normal, center.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degenerate_samples_give_no_circle() {
        let p = |x: f64| Point3::new(x, 2.0 * x, 0.3);
        assert!(circle_through([p(0.0), p(1.0), p(2.0)]).is_none());
        assert!(circle_through([p(0.0), p(0.0), p(2.0)]).is_none());
        assert!(circle_through([p(0.0), p(f64::NAN), p(2.0)]).is_none());
        let right = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, 5.0));
        let circle = circle_through(right).unwrap();
        assert!((circle.center - Point3::new(0.0, 0.0, 5.0)).norm() < 1e-15);
        assert!((circle.radius - 1.0).abs() < 1e-15);
    }
}
