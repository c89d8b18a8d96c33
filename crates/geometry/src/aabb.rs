use nalgebra::Point3;

/// A box whose sides are parallel to the axes; its faces belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Point3<f64>,
    /// The corner with the largest coordinates.
    pub max: Point3<f64>,
}

impl Aabb {
    /// A box between two corners, or `None` where they are inverted or not finite.
    #[inline]
    pub fn new(min: Point3<f64>, max: Point3<f64>) -> Option<Self> {
        let valid = (0..3).all(|i| min[i].is_finite() && max[i].is_finite() && min[i] <= max[i]);
        valid.then_some(Self { min, max })
    }

    /// The smallest box that holds all finite points of `points`; `None` if there is none.
    #[inline]
    pub fn around(points: impl IntoIterator<Item = Point3<f64>>) -> Option<Self> {
        let mut finite = points
            .into_iter()
            .filter(|p| p.iter().all(|c| c.is_finite()));
        let first = finite.next()?;
        Some(finite.fold(
            Self {
                min: first,
                max: first,
            },
            |b, p| Self {
                min: b.min.inf(&p),
                max: b.max.sup(&p),
            },
        ))
    }

    /// Whether the box holds `point`; never for a point that is not finite.
    #[inline]
    pub fn contains(&self, point: &Point3<f64>) -> bool {
        (0..3).all(|i| self.min[i] <= point[i] && point[i] <= self.max[i])
    }

    /// Its centre.
    #[inline]
    pub fn center(&self) -> Point3<f64> {
        nalgebra::center(&self.min, &self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn around_skips_what_is_not_finite() {
        let nan = Point3::new(f64::NAN, 0.0, 0.0);
        assert!(Aabb::around([nan]).is_none());
        let b =
            Aabb::around([nan, Point3::new(1.0, 2.0, 3.0), Point3::new(0.0, 5.0, 3.0)]).unwrap();
        assert_eq!(b.min, Point3::new(0.0, 2.0, 3.0));
        assert_eq!(b.max, Point3::new(1.0, 5.0, 3.0));
        assert!(b.contains(&b.center()) && b.contains(&b.max));
        assert!(!b.contains(&nan));
        assert!(Aabb::new(b.max, b.min).is_none());
    }
}
