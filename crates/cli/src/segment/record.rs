use pomona_segment::{Classes, Role, SegmenterReport, UNSEEN};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Schema of [`ClassesRecord`]; a change of meaning changes its number.
const SCHEMA: &str = "pomona.classes/1";

/// What `classes.json` holds.
#[derive(Debug, Serialize)]
pub(super) struct ClassesRecord {
    schema: &'static str,
    version: &'static str,
    /// What segmented.
    segmenter: SegmenterReport,
    /// Time to open it, milliseconds.
    open_ms: f64,
    /// The classes, in the order of the values in `*.classes.png`.
    classes: Vec<ClassRecord>,
    /// The value of pixels that were not looked at.
    unseen: u8,
    /// In the order given.
    pub(super) images: Vec<SegmentedImage>,
}

#[derive(Debug, Serialize)]
struct ClassRecord {
    value: u8,
    name: String,
    role: Role,
}

/// One image.
#[derive(Debug, Serialize)]
pub(super) struct SegmentedImage {
    pub(super) name: String,
    pub(super) file: String,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Of all pixels, the share of each class.
    pub(super) share: BTreeMap<String, f64>,
    /// The file of the likeliest class of each pixel, beside the record.
    pub(super) classes: String,
    /// The file of the probability of wood, 0 to 255.
    pub(super) wood: String,
    /// The picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) picture: Option<String>,
    /// Time to segment it, milliseconds.
    pub(super) segment_ms: f64,
}

impl ClassesRecord {
    pub(super) fn new(
        segmenter: SegmenterReport,
        classes: &Classes,
        open_ms: f64,
        images: Vec<SegmentedImage>,
    ) -> Self {
        let named = classes.names().iter().zip(classes.roles());
        let record = |(value, (name, role)): (u8, (&String, &Role))| ClassRecord {
            value,
            name: name.clone(),
            role: *role,
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            segmenter,
            open_ms,
            classes: (0..).zip(named).map(record).collect(),
            unseen: UNSEEN,
            images,
        }
    }

    /// What segmented, in one line.
    pub(super) fn what(&self) -> String {
        let runtime = self.segmenter.runtime.as_ref();
        let runtime = runtime.map(|r| format!(", run by {} {}", r.name, r.version));
        self.segmenter.name.clone() + &runtime.unwrap_or_default()
    }
}

/// The files that an earlier run left, by its record.
pub(super) fn files_of_earlier_run(record: &Path) -> Vec<String> {
    #[derive(Deserialize)]
    struct Record {
        schema: String,
        images: Vec<Image>,
    }
    #[derive(Deserialize)]
    struct Image {
        classes: String,
        wood: String,
        picture: Option<String>,
    }
    let read = || serde_json::from_slice::<Record>(&std::fs::read(record).ok()?).ok();
    let Some(earlier) = read().filter(|r| r.schema == SCHEMA) else {
        return Vec::new();
    };
    let own = record
        .file_name()
        .map(|name| name.to_string_lossy().into_owned());
    let of_images = earlier
        .images
        .into_iter()
        .flat_map(|i| [Some(i.classes), Some(i.wood), i.picture]);
    own.into_iter().chain(of_images.flatten()).collect()
}
