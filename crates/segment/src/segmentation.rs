use crate::{
    classes::{Classes, Role},
    error::SegmentError,
};
use pomona_cloud::{GrayImage, PixelWindow};

/// The class number of a pixel that nobody asked about.
pub const UNSEEN: u8 = 255;

/// How far the probabilities of a pixel may add up to something else than 1, which single precision and averaging
/// leave.
const SUM_TOLERANCE: f32 = 1e-3;

/// The probability of each class for each pixel of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    width: usize,
    height: usize,
    classes: Classes,
    /// One plane for each class, row by row; NaN where unseen, in every plane.
    planes: Vec<Vec<f32>>,
}

impl Segmentation {
    /// A plane of probabilities, row by row, for each class; a pixel that is NaN in the first plane is unseen.
    ///
    /// # Errors
    ///
    /// [`SegmentError::Segmentation`] where the planes are not as many as the classes or not of the image's size, or a
    /// pixel's probabilities are no probabilities: below 0, not finite, or not adding up to 1.
    pub fn new(
        [width, height]: [usize; 2],
        classes: Classes,
        mut planes: Vec<Vec<f32>>,
    ) -> Result<Self, SegmentError> {
        let fault = |problem: String, remedy| SegmentError::Segmentation {
            width,
            height,
            problem,
            remedy,
        };
        if planes.len() != classes.len() {
            let problem = format!("{} planes for {} classes", planes.len(), classes.len());
            return Err(fault(problem, "give one plane for each class"));
        }
        let count = width.checked_mul(height);
        if let Some(plane) = planes.iter().find(|plane| Some(plane.len()) != count) {
            let problem = format!("a plane of {} pixels", plane.len());
            return Err(fault(
                problem,
                "give each plane one number for each pixel, row by row",
            ));
        }
        for k in 0..planes[0].len() {
            if planes[0][k].is_nan() {
                for plane in &mut planes {
                    plane[k] = f32::NAN;
                }
                continue;
            }
            let sum: f32 = planes.iter().map(|plane| plane[k]).sum();
            let least = planes.iter().map(|plane| plane[k]).fold(0.0, f32::min);
            if least < 0.0 || !((sum - 1.0).abs() <= SUM_TOLERANCE) {
                let (u, v) = (k % width, k / width);
                let problem = format!(
                    "pixel ({u}, {v}) has probabilities that add up to {sum}, the least {least}"
                );
                return Err(fault(
                    problem,
                    "give probabilities from 0 to 1 that add up to 1",
                ));
            }
        }
        Ok(Self {
            width,
            height,
            classes,
            planes,
        })
    }

    /// Planes that are known to be what [`Segmentation::new`] asks for.
    pub(crate) fn of_probabilities(
        [width, height]: [usize; 2],
        classes: Classes,
        planes: Vec<Vec<f32>>,
    ) -> Self {
        Self {
            width,
            height,
            classes,
            planes,
        }
    }

    /// Moves the probabilities by `share` of the way to those of `other`, which is of the same image and classes; what
    /// either has not seen is unseen.
    pub(crate) fn mix(&mut self, other: &Self, share: f32) {
        for (plane, others) in self.planes.iter_mut().zip(&other.planes) {
            for (p, q) in plane.iter_mut().zip(others) {
                *p += share * (q - *p);
            }
        }
    }

    /// The same, seen within `windows` only.
    #[must_use]
    pub fn within(mut self, windows: &[PixelWindow]) -> Self {
        for v in 0..self.height {
            for u in 0..self.width {
                let asked = windows
                    .iter()
                    .any(|w| (w.x0..w.x1).contains(&u) && (w.y0..w.y1).contains(&v));
                if !asked {
                    let k = v * self.width + u;
                    for plane in &mut self.planes {
                        plane[k] = f32::NAN;
                    }
                }
            }
        }
        self
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The classes.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }

    /// The probability of the class of this number, for all pixels row by row; NaN where unseen.
    pub fn plane(&self, class: usize) -> Option<&[f32]> {
        self.planes.get(class).map(Vec::as_slice)
    }

    /// The probability that the pixel plays this role; `None` where unseen or outside the image.
    pub fn probability(&self, role: Role, u: usize, v: usize) -> Option<f32> {
        if u >= self.width || v >= self.height {
            return None;
        }
        let k = v * self.width + u;
        let seen = !self.planes[0][k].is_nan();
        seen.then(|| {
            self.classes
                .of(role)
                .map(|class| self.planes[class][k])
                .sum()
        })
    }

    /// The probability of this role for all pixels, row by row; NaN where unseen.
    pub fn role(&self, role: Role) -> Vec<f32> {
        let mut sum: Vec<f32> = self.planes[0]
            .iter()
            .map(|p| if p.is_nan() { *p } else { 0.0 })
            .collect();
        for class in self.classes.of(role) {
            for (sum, p) in sum.iter_mut().zip(&self.planes[class]) {
                *sum += p;
            }
        }
        sum
    }

    /// The probabilities of a role × 255, rounded; 0 where unseen. This is the form of `NAME.wood.png`.
    pub fn mask(&self, role: Role) -> GrayImage {
        // A cast of NaN is 0.
        let byte = |p: &f32| (p * 255.0).round() as u8;
        GrayImage {
            width: self.width,
            height: self.height,
            values: self.role(role).iter().map(byte).collect(),
        }
    }

    /// The number of the likeliest class of each pixel, row by row, the first of equals; [`UNSEEN`] where unseen.
    pub fn likeliest(&self) -> Vec<u8> {
        let mut best = self.planes[0].clone();
        let mut numbers: Vec<u8> = best
            .iter()
            .map(|p| if p.is_nan() { UNSEEN } else { 0 })
            .collect();
        for (class, plane) in self.planes.iter().enumerate().skip(1) {
            for ((number, best), &p) in numbers.iter_mut().zip(&mut best).zip(plane) {
                if p > *best {
                    (*best, *number) = (p, class as u8);
                }
            }
        }
        numbers
    }

    /// Of the pixels, the share that was seen; 0 for an image without pixels.
    pub fn seen_share(&self) -> f64 {
        let seen = self.planes[0].iter().filter(|p| !p.is_nan()).count();
        seen as f64 / self.planes[0].len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classes() -> Classes {
        Classes::by_names(["leaf", "branch", "trunk"]).unwrap()
    }

    #[test]
    fn roles_add_up_their_classes() {
        let planes = vec![vec![0.5, f32::NAN], vec![0.2, 0.1], vec![0.3, 0.1]];
        let seen = Segmentation::new([2, 1], classes(), planes).unwrap();
        assert_eq!(seen.probability(Role::Wood, 0, 0), Some(0.5));
        assert_eq!(seen.probability(Role::Wood, 1, 0), None);
        assert_eq!(seen.probability(Role::Wood, 0, 1), None);
        assert_eq!(seen.probability(Role::Post, 0, 0), Some(0.0));
        let wood = seen.role(Role::Wood);
        assert!(wood[0] == 0.5 && wood[1].is_nan());
        assert!(seen.role(Role::Post)[1].is_nan());
        assert_eq!(seen.likeliest(), [0, UNSEEN]);
        assert_eq!(seen.seen_share(), 0.5);
        assert!(seen.plane(1).unwrap()[1].is_nan(), "unseen in every plane");
    }

    #[test]
    fn windows_limit_what_is_seen() {
        let planes = vec![vec![0.0; 6], vec![1.0; 6], vec![0.0; 6]];
        let seen = Segmentation::new([3, 2], classes(), planes).unwrap();
        let window = PixelWindow {
            x0: 1,
            y0: 0,
            x1: 3,
            y1: 1,
        };
        assert_eq!(
            seen.within(&[window]).likeliest(),
            [UNSEEN, 1, 1, UNSEEN, UNSEEN, UNSEEN]
        );
    }

    #[test]
    fn what_are_no_probabilities_is_refused() {
        let message = |planes| {
            Segmentation::new([1, 1], classes(), planes)
                .unwrap_err()
                .to_string()
        };
        assert!(message(vec![vec![1.0]]).contains("1 planes for 3 classes"));
        assert!(message(vec![vec![1.0], vec![0.0], vec![]]).contains("a plane of 0 pixels"));
        assert!(message(vec![vec![0.6], vec![0.6], vec![0.0]]).contains("pixel (0, 0)"));
        assert!(message(vec![vec![1.5], vec![-0.5], vec![0.0]]).contains("-0.5"));
        assert!(message(vec![vec![0.5], vec![f32::NAN], vec![0.5]]).contains("NaN"));
        assert!(message(vec![vec![f32::INFINITY], vec![0.0], vec![0.0]]).contains("inf"));
        let huge = Segmentation::new([usize::MAX, 2], classes(), vec![vec![1.0]; 3]);
        assert!(huge.is_err());
    }
}
