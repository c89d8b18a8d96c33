use serde::Serialize;

/// A class of boxes by their size: the root of their area, pixels of the image as it was given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SizeClass {
    /// Its name.
    pub name: &'static str,
    /// Side of a square of the smallest area that belongs to it, pixels.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub from_px: f64,
    /// Side of a square of the smallest area that no longer does; absent where there is no bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub below_px: Option<f64>,
}

impl SizeClass {
    const fn new(name: &'static str, from_px: f64, below_px: Option<f64>) -> Self {
        Self {
            name,
            from_px,
            below_px,
        }
    }

    /// Whether a box of this area, in square pixels, belongs to it.
    pub fn holds(&self, area: f64) -> bool {
        let below = self.below_px.is_none_or(|side| area < side * side);
        area >= self.from_px * self.from_px && below
    }
}

/// The classes of COCO: bounds at 32² and 96² pixels.
///
/// Here each area belongs to one class; COCO's own program counts a box of exactly 32² or 96² in both.
pub const COCO_SIZES: [SizeClass; 3] = [
    SizeClass::new("small", 0.0, Some(32.0)),
    SizeClass::new("medium", 32.0, Some(96.0)),
    SizeClass::new("large", 96.0, None),
];

/// Finer classes: apples of an orchard are mostly small by COCO's measure, and what a detector misses is the
/// smallest of them.
pub const FINE_SIZES: [SizeClass; 7] = [
    SizeClass::new("under 12 px", 0.0, Some(12.0)),
    SizeClass::new("12-16 px", 12.0, Some(16.0)),
    SizeClass::new("16-24 px", 16.0, Some(24.0)),
    SizeClass::new("24-32 px", 24.0, Some(32.0)),
    SizeClass::new("32-48 px", 32.0, Some(48.0)),
    SizeClass::new("48-96 px", 48.0, Some(96.0)),
    SizeClass::new("from 96 px", 96.0, None),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_area_belongs_to_one_class() {
        for side in 0..200 {
            let area = 0.5 * f64::from(side * side);
            for classes in [&COCO_SIZES[..], &FINE_SIZES[..]] {
                assert_eq!(
                    classes.iter().filter(|c| c.holds(area)).count(),
                    1,
                    "{area}"
                );
            }
        }
        assert!(COCO_SIZES[1].holds(32.0 * 32.0) && COCO_SIZES[2].holds(96.0 * 96.0));
    }
}
