use pomona_cloud::PixelBox;
use pomona_detect::{Detection, DetectorReport};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Schema of [`DetectionsRecord`]; a change of meaning changes its number.
const SCHEMA: &str = "pomona.detections/1";

/// What `pomona detect` saw in colour images, as it writes it to detections.json. Edges in pixels of the image, counted
/// from its left and upper edge; a box may reach beyond the image. Times in milliseconds. What is not known is absent.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub(super) struct DetectionsRecord {
    /// Name and version of this form.
    #[cfg_attr(test, schemars(extend("const" = SCHEMA)))]
    schema: &'static str,
    /// Version of the program.
    version: &'static str,
    /// What detected.
    #[cfg_attr(test, schemars(with = "pomona_schema::DetectorReport"))]
    pub(super) detector: DetectorReport,
    /// Time to load the model and its inference backend.
    #[cfg_attr(test, schemars(range(min = 0)))]
    open_ms: f64,
    /// In the order given.
    pub(super) images: Vec<ImageRecord>,
}

/// One image.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub(super) struct ImageRecord {
    /// The file's name without its ending, or the frame's.
    pub(super) name: String,
    /// The image, as the command line named it.
    pub(super) file: String,
    /// Its width.
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub(super) width: usize,
    /// Its height.
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub(super) height: usize,
    /// Best first.
    pub(super) detections: Vec<DetectionRecord>,
    /// The box file that holds them, beside this one.
    pub(super) boxes: String,
    /// The image with the boxes drawn over it, beside this file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) picture: Option<String>,
    /// How long it took.
    pub(super) timing_ms: TimingRecord,
}

/// Times, milliseconds.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub(super) struct TimingRecord {
    /// Reading the image.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub(super) read: f64,
    /// Detecting in it, from pixels to boxes.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub(super) detect: f64,
}

/// One box, pixels.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub(super) struct DetectionRecord {
    /// Left edge.
    x_min: f64,
    /// Upper edge.
    y_min: f64,
    /// Right edge.
    x_max: f64,
    /// Lower edge.
    y_max: f64,
    /// How sure the detector is.
    #[cfg_attr(test, schemars(range(min = 0, max = 1)))]
    pub(super) score: f64,
    /// Number of the class in the model's own list.
    class: usize,
}

impl From<&Detection> for DetectionRecord {
    fn from(d: &Detection) -> Self {
        Self {
            x_min: d.x_min,
            y_min: d.y_min,
            x_max: d.x_max,
            y_max: d.y_max,
            score: d.score,
            class: d.class,
        }
    }
}

impl DetectionRecord {
    pub(super) fn to_pixel_box(&self, name: &str) -> PixelBox {
        PixelBox {
            name: name.to_owned(),
            x_min: self.x_min,
            y_min: self.y_min,
            x_max: self.x_max,
            y_max: self.y_max,
            score: self.score,
        }
    }
}

impl DetectionsRecord {
    pub(super) fn new(detector: DetectorReport, open_ms: f64, images: Vec<ImageRecord>) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            detector,
            open_ms,
            images,
        }
    }
}

/// The files that the run which left this record wrote, the record among them; none where it is no record of ours.
pub(super) fn files_of_earlier_run(record: &Path) -> Vec<String> {
    #[derive(Deserialize)]
    struct Record {
        schema: String,
        images: Vec<Image>,
    }
    #[derive(Deserialize)]
    struct Image {
        boxes: String,
        picture: Option<String>,
    }
    let read = || serde_json::from_slice::<Record>(&std::fs::read(record).ok()?).ok();
    let Some(earlier) = read().filter(|r| r.schema.starts_with("pomona.detections/")) else {
        return Vec::new();
    };
    let own = record
        .file_name()
        .map(|name| name.to_string_lossy().into_owned());
    let of_images = earlier
        .images
        .into_iter()
        .flat_map(|i| [Some(i.boxes), i.picture]);
    own.into_iter().chain(of_images.flatten()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<DetectionsRecord>(SCHEMA, "detections.schema.json");
    }

    #[test]
    fn only_a_record_of_ours_says_what_is_ours() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("detections.json");
        assert!(files_of_earlier_run(&path).is_empty());
        for foreign in ["[]", "{}", r#"{"schema": "other/1", "images": []}"#] {
            std::fs::write(&path, foreign).unwrap();
            assert!(files_of_earlier_run(&path).is_empty(), "{foreign}");
        }
        let image = ImageRecord {
            name: "a".to_owned(),
            file: "a.png".to_owned(),
            width: 4,
            height: 4,
            detections: Vec::new(),
            boxes: "a.xml".to_owned(),
            picture: Some("a-boxes.png".to_owned()),
            timing_ms: TimingRecord {
                read: 0.0,
                detect: 0.0,
            },
        };
        let record = DetectionsRecord::new(DetectorReport::default(), 0.0, vec![image]);
        std::fs::write(&path, serde_json::to_string(&record).unwrap()).unwrap();
        let files = files_of_earlier_run(&path);
        assert_eq!(files, ["detections.json", "a.xml", "a-boxes.png"]);
    }
}
