//! Numbers that contradict nothing and are yet not those of a camera as people build it.

use super::Camera;
use pomona_files::{Warning, WarningCode};

/// Share of the image's width or height by which the principal point of a camera lies off its middle. Of the RGB-D
/// cameras in use it is below 4 % (factory intrinsics of D435, D455, L515, Azure Kinect, Femto Bolt, ZED 2).
const OFF_CENTER: f64 = 0.1;
/// Share by which the two focal lengths differ: pixels are square to within the accuracy of a calibration.
const NOT_SQUARE: f64 = 0.03;
/// Field of view along the larger side, degrees: from a telephoto lens to the widest of these cameras, 120° of Azure
/// Kinect's depth.
const FIELD_OF_VIEW_DEG: std::ops::RangeInclusive<f64> = 20.0..=130.0;
/// Metres in a depth unit: from 0.01 mm to 10 mm. Cameras store 0.1 mm to 1 mm.
const DEPTH_UNIT_M: std::ops::RangeInclusive<f64> = 1e-5..=1e-2;
/// By how much the ratios of principal point and middle may differ between x and y for numbers of an image of another
/// size.
const SAME_RATIO: f64 = 0.06;

impl Camera {
    /// What is doubtful about the numbers: a principal point far from the middle of the image, pixels that are not
    /// square, a field of view or a depth unit that cameras do not have. None of it is impossible, as
    /// [`Camera::validate`] refuses it: a part may have been cut out of the image.
    pub fn doubts(&self) -> Vec<Warning> {
        let mut doubts = Vec::new();
        doubts.extend(self.principal_point_doubt());
        let ratio = self.fx / self.fy;
        if (ratio - 1.0).abs() > NOT_SQUARE {
            let message = format!(
                "camera: focal lengths {:.1} and {:.1} px along x and y, as if pixels were not square; of most cameras \
                 they are equal: copy the numbers again",
                self.fx, self.fy
            );
            doubts.push(Warning::new(WarningCode::FocalLengthsDiffer, message));
        }
        if let Some(degrees) = self.field_of_view_deg()
            && !FIELD_OF_VIEW_DEG.contains(&degrees)
        {
            let message = format!(
                "camera: a field of view of {degrees:.0}°, which no RGB-D camera has: copy the focal lengths, in pixels, \
                 and the image size again"
            );
            doubts.push(Warning::new(WarningCode::FieldOfViewImplausible, message));
        }
        if !DEPTH_UNIT_M.contains(&self.depth_scale) {
            let message = format!(
                "camera: a unit of the depth image is {} mm, which no camera stores: `depth_scale` is in metres per unit \
                 (0.001 for millimetres)",
                self.depth_scale * 1e3
            );
            doubts.push(Warning::new(WarningCode::DepthScaleImplausible, message));
        }
        doubts
    }

    fn principal_point_doubt(&self) -> Option<Warning> {
        let middle = [
            (self.width as f64 - 1.0) / 2.0,
            (self.height as f64 - 1.0) / 2.0,
        ];
        let off = [
            (self.cx - middle[0]).abs() / self.width as f64,
            (self.cy - middle[1]).abs() / self.height as f64,
        ];
        let worst = off[0].max(off[1]);
        if worst <= OFF_CENTER {
            return None;
        }
        let found = format!(
            "camera: the principal point ({:.1}, {:.1}) lies {:.0} % of the image off its middle",
            self.cx,
            self.cy,
            worst * 100.0
        );
        // Pixel centres: half a pixel before the first.
        let ratios = [
            (2.0 * self.cx + 1.0) / self.width as f64,
            (2.0 * self.cy + 1.0) / self.height as f64,
        ];
        let ratio = f64::midpoint(ratios[0], ratios[1]);
        if ratio > 0.0 && (ratios[0] - ratios[1]).abs() <= SAME_RATIO * ratio {
            let size = [self.width, self.height].map(|side| (side as f64 * ratio).round());
            let message = format!(
                "{found}, where that of an image of {} x {} would be: give the numbers for images of {} x {}, or divide \
                 them by {ratio:.2}",
                size[0], size[1], self.width, self.height
            );
            return Some(Warning::new(WarningCode::IntrinsicsOfAnotherSize, message));
        }
        let message = format!(
            "{found}: copy cx and cy again, or subtract the corner of a part that was cut out"
        );
        Some(Warning::new(WarningCode::PrincipalPointOffCenter, message))
    }

    /// The angle between the rays of the first and the last pixel of the larger side, through the image's middle.
    fn field_of_view_deg(&self) -> Option<f64> {
        let (right, bottom) = (
            self.width.saturating_sub(1) as f64,
            self.height.saturating_sub(1) as f64,
        );
        let (a, b) = if right >= bottom {
            (self.ray(0.0, bottom / 2.0)?, self.ray(right, bottom / 2.0)?)
        } else {
            (self.ray(right / 2.0, 0.0)?, self.ray(right / 2.0, bottom)?)
        };
        let dot = a.0 * b.0 + a.1 * b.1 + 1.0;
        let lengths = a.0.hypot(a.1).hypot(1.0) * b.0.hypot(b.1).hypot(1.0);
        Some((dot / lengths).clamp(-1.0, 1.0).acos().to_degrees())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(camera: &Camera) -> Vec<WarningCode> {
        camera.doubts().iter().map(|doubt| doubt.code).collect()
    }

    /// Factory intrinsics of usual cameras.
    fn usual() -> [Camera; 4] {
        [
            Camera::new([1280, 720], [912.4, 911.9], [641.2, 358.8]),
            Camera::new([1920, 1080], [914.1, 913.7], [957.6, 551.8]),
            Camera::new([640, 480], [606.1, 605.6], [326.8, 247.9]),
            Camera::new([720, 1280], [911.9, 912.4], [358.8, 641.2]),
        ]
    }

    #[test]
    fn usual_cameras_raise_no_doubt() {
        for camera in usual() {
            assert_eq!(codes(&camera), [], "{camera:?}");
        }
    }

    #[test]
    fn numbers_of_a_larger_or_smaller_image_are_recognised_by_their_ratio() {
        for camera in usual() {
            for factor in [1.5, 2.0, 0.5] {
                let of_other = |length: f64| length * factor;
                let other = Camera {
                    fx: of_other(camera.fx),
                    fy: of_other(camera.fy),
                    cx: of_other(camera.cx),
                    cy: of_other(camera.cy),
                    ..camera.clone()
                };
                let doubts = other.doubts();
                let found = doubts
                    .iter()
                    .find(|d| d.code == WarningCode::IntrinsicsOfAnotherSize);
                let message = &found.unwrap_or_else(|| panic!("{other:?}")).message;
                let said = message.split("divide them by ").nth(1).unwrap();
                let said: f64 = said.parse().unwrap();
                // Principal points of these cameras lie up to 3.5 % off the middle, and the message has two digits.
                assert!((said / factor - 1.0).abs() < 0.05, "{message}");
            }
        }
    }

    #[test]
    fn each_doubt_has_its_code() {
        let [camera, ..] = usual();
        let aside = Camera {
            cx: 1100.0,
            ..camera.clone()
        };
        assert_eq!(codes(&aside), [WarningCode::PrincipalPointOffCenter]);
        let flat = Camera {
            fy: camera.fy / 2.0,
            ..camera.clone()
        };
        assert_eq!(codes(&flat), [WarningCode::FocalLengthsDiffer]);
        for factor in [0.2, 10.0] {
            let odd = Camera {
                fx: camera.fx * factor,
                fy: camera.fy * factor,
                ..camera.clone()
            };
            assert_eq!(codes(&odd), [WarningCode::FieldOfViewImplausible]);
        }
        for depth_scale in [1.0, 1e-6] {
            let odd = Camera {
                depth_scale,
                ..camera.clone()
            };
            assert_eq!(codes(&odd), [WarningCode::DepthScaleImplausible]);
        }
    }
}
