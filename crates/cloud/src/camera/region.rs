//! Binning and regions of interest of a ROS `CameraInfo`: its numbers are those of the whole sensor, and the images show
//! a part of it, several pixels joined in one.

use super::draft::Pinhole;
use pomona_files::Malformed;
use serde::Deserialize;

/// Pixels by which two principal points or focal lengths differ that are the same but for rounding, and but for where a
/// pixel is thought to have its centre.
const SAME_PX: f64 = 1.0;

/// The region of interest of a `CameraInfo`; all zero for the whole image.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Roi {
    x_offset: usize,
    y_offset: usize,
    width: usize,
    height: usize,
}

/// Which part of the sensor the images show, and how.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    offset: [usize; 2],
    /// Pixels of the sensor; those of the whole where there is no region of interest.
    extent: [usize; 2],
    binning: [usize; 2],
    /// Width and height that the file gives.
    stated: [usize; 2],
}

/// The numbers of the images.
pub(super) struct Seen {
    pub(super) size: [usize; 2],
    pub(super) camera_matrix: Pinhole,
    pub(super) projection: Option<Pinhole>,
    /// What has been applied, in words; `None` where nothing had to be.
    pub(super) applied: Option<String>,
}

impl Region {
    /// A binning of 0 means none, as in the message.
    pub(super) fn new(stated: [usize; 2], binning: [usize; 2], roi: Roi) -> Self {
        let is_whole = roi.width == 0 && roi.height == 0;
        Self {
            offset: [roi.x_offset, roi.y_offset],
            extent: if is_whole {
                stated
            } else {
                [roi.width, roi.height]
            },
            binning: binning.map(|b| b.max(1)),
            stated,
        }
    }

    fn is_whole_sensor(&self) -> bool {
        self.offset == [0, 0] && self.extent == self.stated && self.binning == [1, 1]
    }

    /// The numbers of the images from those of the whole sensor.
    fn apply(&self, sensor: Pinhole) -> Pinhole {
        let of_axis = |i: usize| {
            let binning = self.binning[i] as f64;
            // Pixel (0, 0) has its centre at (0, 0), so its edge is half a pixel before that.
            let from_edge = sensor.center[i] - self.offset[i] as f64 + 0.5;
            (sensor.focal[i] / binning, from_edge / binning - 0.5)
        };
        let ((fx, cx), (fy, cy)) = (of_axis(0), of_axis(1));
        Pinhole {
            focal: [fx, fy],
            center: [cx, cy],
        }
    }

    /// Width and height of the images, where the region lies on the sensor.
    fn size(&self) -> Option<[usize; 2]> {
        let lies_inside = (0..2).all(|i| self.offset[i] + self.extent[i] <= self.stated[i]);
        let size = [
            self.extent[0] / self.binning[0],
            self.extent[1] / self.binning[1],
        ];
        (lies_inside && size[0] > 0 && size[1] > 0).then_some(size)
    }

    /// The numbers of the images, whose size `image` is where it is known.
    ///
    /// Some drivers state the size of the images in place of the sensor's, or apply binning and region to P and not to
    /// K. Where P is what K becomes by them, there is no doubt; else the sizes must agree.
    pub(super) fn seen(
        &self,
        camera_matrix: Pinhole,
        projection: Option<Pinhole>,
        image: Option<[usize; 2]>,
    ) -> Result<Seen, Malformed> {
        if self.is_whole_sensor() {
            return Ok(Seen {
                size: self.stated,
                camera_matrix,
                projection,
                applied: None,
            });
        }
        let applied = self.apply(camera_matrix);
        let is_witness = projection.is_some_and(|p| p.is_about(&applied));
        let by_sizes = self
            .size()
            .filter(|size| image.is_none_or(|image| image == *size));
        let by_witness = || {
            let of_images = [self.stated, self.extent];
            let size = image.unwrap_or(self.stated);
            (is_witness && of_images.contains(&size)).then_some(size)
        };
        let Some(size) = by_sizes.or_else(by_witness) else {
            return Err(self.fault(image));
        };
        let projection = projection.map(|p| if is_witness { p } else { self.apply(p) });
        Ok(Seen {
            size,
            camera_matrix: applied,
            projection,
            applied: Some(self.words()),
        })
    }

    fn words(&self) -> String {
        let ([bx, by], [x, y], [width, height]) = (self.binning, self.offset, self.extent);
        let region = format!("the region of interest ({width} x {height} at {x}, {y})");
        match (
            self.binning != [1, 1],
            self.extent != self.stated || self.offset != [0, 0],
        ) {
            (true, true) => format!("binning ({bx} x {by}) and {region}"),
            (true, false) => format!("binning ({bx} x {by})"),
            _ => region,
        }
    }

    fn fault(&self, image: Option<[usize; 2]>) -> Malformed {
        let [width, height] = self.stated;
        let expected = match (self.size(), image) {
            (Some([w, h]), Some([iw, ih])) => {
                format!("would give images of {w} x {h}, and they have {iw} x {ih}")
            }
            _ => "does not lie in it".to_owned(),
        };
        let place = if self.binning == [1, 1] {
            "roi"
        } else {
            "binning_x, binning_y, roi"
        };
        Malformed::new(
            place,
            format!(
                "{} of a sensor of {width} x {height} {expected}",
                self.words()
            ),
            "give width, height and k of the whole sensor; or, if they are those of the images already, set binning and \
             roi to 0",
        )
    }
}

impl Pinhole {
    /// Whether two cameras are the same but for rounding.
    pub(super) fn is_about(&self, other: &Self) -> bool {
        let (a, b) = (
            self.focal.iter().chain(&self.center),
            other.focal.iter().chain(&other.center),
        );
        a.zip(b).all(|(a, b)| (a - b).abs() <= SAME_PX)
    }
}
