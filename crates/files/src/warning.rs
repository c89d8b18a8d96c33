use serde::ser::{Serialize, SerializeStruct, Serializer};
use std::fmt;
use std::path::Path;

/// How much a [`Warning`] matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Level {
    /// What was taken for granted where the input leaves it open; right for most inputs.
    Note,
    /// What makes the answers doubtful until somebody has looked at the input.
    Warning,
}

impl Level {
    /// Its name in records and before its message.
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
        }
    }
}

/// Declares the codes once, each with its meaning, its name in records and its level.
macro_rules! codes {
    ($($(#[doc = $meaning:literal])+ $variant:ident = $name:literal, $level:ident;)+) => {
        /// What a [`Warning`] is about, for programs to test. A name, once published, keeps its meaning.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum WarningCode {
            $($(#[doc = $meaning])+ $variant,)+
        }

        impl WarningCode {
            /// All codes, in the order of their declaration.
            pub const ALL: &[Self] = &[$(Self::$variant,)+];

            /// Its name in records.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// How much it matters.
            pub fn level(self) -> Level {
                match self { $(Self::$variant => Level::$level,)+ }
            }

            /// What it means, in a sentence or two.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($($meaning, "\n"),+).trim_ascii(),)+ }
            }
        }
    };
}

codes! {
    /// A camera file does not name its frame; a common name is taken.
    FrameIdAssumed = "frame_id_assumed", Note;
    /// A camera file does not say how long a unit of the depth image is; a millimetre is taken.
    DepthScaleAssumed = "depth_scale_assumed", Note;
    /// Boxes of other classes, crowd regions or boxes of a low score in a box file are left out.
    BoxesLeftOut = "boxes_left_out", Note;
    /// A box file has one class, whose name is not that of an apple; its boxes are taken.
    BoxClassAssumed = "box_class_assumed", Note;
    /// A box file names another image than the frame's, and no second one; its boxes are taken.
    BoxImageAssumed = "box_image_assumed", Note;
    /// A model does not state what is needed to read it, such as the size of its input or which of its classes is an apple.
    DetectorAssumed = "detector_assumed", Note;
    /// EXIF data turn or mirror a picture for viewers; it is read as stored.
    ImageTurned = "image_turned", Warning;
    /// A box file has boxes, and none of them is of the frame's image.
    NoBoxesOfImage = "no_boxes_of_image", Warning;
    /// Boxes of a YOLO text reach beyond the image, and would lie in it if the numbers stood in another order.
    BoxOrderDoubtful = "box_order_doubtful", Warning;
    /// A camera file gives no image size; that of the frame's images is taken.
    ImageSizeAssumed = "image_size_assumed", Note;
    /// A camera file does not name the model of its distortion; it is told by the number of coefficients.
    DistortionModelAssumed = "distortion_model_assumed", Note;
    /// The camera matrix K is zero, and the projection matrix P is taken: for rectified images.
    ProjectionMatrixTaken = "projection_matrix_taken", Note;
    /// Binning or a region of interest of a camera file is applied to the sensor's numbers.
    SensorRegionApplied = "sensor_region_applied", Note;
    /// A camera file describes raw and rectified images with different numbers, and nobody said which the images are; they are taken to be raw.
    RawImagesAssumed = "raw_images_assumed", Warning;
    /// A lens is called `inverse_brown_conrady`, a name that drivers give to two different models.
    InverseLens = "inverse_lens", Warning;
    /// A frame's folder holds several camera files; the first is taken.
    OtherCamerasIgnored = "other_cameras_ignored", Warning;
    /// The principal point lies far from the middle of the image.
    PrincipalPointOffCenter = "principal_point_off_center", Warning;
    /// The intrinsics are those of an image of another size.
    IntrinsicsOfAnotherSize = "intrinsics_of_another_size", Warning;
    /// The focal lengths along x and y differ as if pixels were not square.
    FocalLengthsDiffer = "focal_lengths_differ", Warning;
    /// The field of view is one that no RGB-D camera has.
    FieldOfViewImplausible = "field_of_view_implausible", Warning;
    /// A unit of the depth image is longer or shorter than any camera stores.
    DepthScaleImplausible = "depth_scale_implausible", Warning;
    /// A transform's file names no frames; common names are taken.
    TransformFramesAssumed = "transform_frames_assumed", Note;
    /// The camera is farther from its robot than arms reach; the translation may be in millimetres.
    CameraFarFromRobot = "camera_far_from_robot", Warning;
    /// A frame's folder has a pose of its own, which is taken in place of the transform given for all frames.
    OwnPoseTaken = "own_pose_taken", Note;
    /// A frame's folder has the flange's pose, which is not used without a transform from the camera to the flange.
    FlangePoseUnused = "flange_pose_unused", Note;
    /// The unit of lengths or angles in a file of calibration samples is told by the size of the numbers.
    SampleUnitsAssumed = "sample_units_assumed", Note;
    /// So few calibration samples are used that a wrong one may go unnoticed.
    FewSamples = "few_samples", Warning;
    /// More than a quarter of the calibration samples are rejected.
    ManyRejected = "many_rejected", Warning;
    /// Distances between points differ by a factor between camera and robot.
    CameraScale = "camera_scale", Warning;
    /// The calibration board is of another size than its detector was told.
    BoardScale = "board_scale", Warning;
    /// What the boxes hold is too large or too small for fruit, by one factor in all of them.
    SizesImplausible = "sizes_implausible", Warning;
}

impl fmt::Display for WarningCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What was assumed about an input that does not state it, or what is doubtful about it.
///
/// It is no error: there is an answer, and whoever uses it should know. What contradicts itself is refused instead.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Warning {
    /// What it is about, for programs.
    pub code: WarningCode,
    /// The same for people: where (a file's name, a place in it), what was found and taken, and how to state it.
    pub message: String,
}

impl Warning {
    /// A warning and its message.
    pub fn new(code: WarningCode, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
        }
    }

    /// The warning of a parser, for the file that it was given: the message begins with the file's name. The folder is
    /// left out, so that records do not depend on where a file lies.
    #[must_use]
    pub fn in_file(self, path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Self {
            message: format!("{name}: {}", self.message),
            ..self
        }
    }

    /// How much it matters: its code's level.
    pub fn level(&self) -> Level {
        self.code.level()
    }
}

/// As it is in records: `code`, `level` and `message`.
impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut record = serializer.serialize_struct("Warning", 3)?;
        record.serialize_field("code", self.code.name())?;
        record.serialize_field("level", self.level().name())?;
        record.serialize_field("message", &self.message)?;
        record.end()
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]", self.message, self.code)
    }
}

/// What was read, and what had to be assumed or is doubtful about it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct WithWarnings<T> {
    /// What was read.
    pub value: T,
    /// In the order in which they were met.
    pub warnings: Vec<Warning>,
}

impl<T> WithWarnings<T> {
    /// A value with its warnings.
    pub fn new(value: T, warnings: Vec<Warning>) -> Self {
        Self { value, warnings }
    }

    /// The value; its warnings go to the end of `list`.
    pub fn append_to(self, list: &mut Vec<Warning>) -> T {
        list.extend(self.warnings);
        self.value
    }

    /// The same warnings, of the file at `path`.
    #[must_use]
    pub fn in_file(self, path: &Path) -> Self {
        let warnings = self.warnings.into_iter();
        Self {
            value: self.value,
            warnings: warnings.map(|warning| warning.in_file(path)).collect(),
        }
    }

    /// The same warnings about what `change` makes of the value.
    pub fn map<U>(self, change: impl FnOnce(T) -> U) -> WithWarnings<U> {
        WithWarnings::new(change(self.value), self.warnings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_distinct_snake_case_and_explained() {
        let mut names: Vec<_> = WarningCode::ALL.iter().map(|code| code.name()).collect();
        for (code, name) in WarningCode::ALL.iter().zip(&names) {
            assert!(
                name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'),
                "{name}"
            );
            assert!(code.meaning().ends_with('.'), "{name}: {}", code.meaning());
        }
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), WarningCode::ALL.len());
    }

    #[test]
    fn a_warning_reads_as_its_message_and_its_code() {
        let warning = Warning::new(WarningCode::FrameIdAssumed, "no `frame_id`")
            .in_file(Path::new("frames/a/camera.json"));
        assert_eq!(
            warning.to_string(),
            "camera.json: no `frame_id` [frame_id_assumed]"
        );
        assert_eq!(warning.level().name(), "note");
        let mut list = Vec::new();
        let value = WithWarnings::new(3, vec![warning]).map(|n| n + 1);
        assert_eq!((value.append_to(&mut list), list.len()), (4, 1));
    }
}
