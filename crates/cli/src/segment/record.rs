use pomona_segment::{Classes, Role, SegmenterReport, UNSEEN};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Schema of [`ClassesRecord`]; a change of meaning changes its number.
const SCHEMA: &str = "pomona.classes/1";

/// What `pomona segment` found in colour images, as it writes it to classes.json. Sizes in pixels, times in
/// milliseconds. What is not known is absent.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub(super) struct ClassesRecord {
    /// Name and version of this form.
    #[cfg_attr(test, schemars(extend("const" = SCHEMA)))]
    schema: &'static str,
    /// Version of the program.
    version: &'static str,
    /// What segmented.
    #[cfg_attr(test, schemars(with = "pomona_schema::SegmenterReport"))]
    segmenter: SegmenterReport,
    /// Time to load the model and its inference backend.
    #[cfg_attr(test, schemars(range(min = 0)))]
    open_ms: f64,
    /// The classes, in the order of their values.
    classes: Vec<ClassRecord>,
    /// The value in `*.classes.png` of pixels that were not looked at.
    #[cfg_attr(test, schemars(extend("const" = UNSEEN)))]
    unseen: u8,
    /// In the order given.
    pub(super) images: Vec<SegmentedImage>,
}

/// One class.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
struct ClassRecord {
    /// Its value in `*.classes.png`.
    value: u8,
    /// Its name, the model's own.
    name: String,
    /// What it is to a picking robot.
    #[cfg_attr(test, schemars(with = "String", extend("enum" = Role::ALL.map(Role::name))))]
    role: Role,
}

/// One image.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
pub(super) struct SegmentedImage {
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
    /// Of all pixels, the share of each class by its name.
    #[cfg_attr(test, schemars(with = "BTreeMap<String, pomona_schema::Share>"))]
    pub(super) share: BTreeMap<String, f64>,
    /// The file of the likeliest class of each pixel, `*.classes.png`, beside this one.
    pub(super) classes: String,
    /// The file of the probability of wood, `*.wood.png`, where 255 is 1.
    pub(super) wood: String,
    /// The image with the classes drawn over it, beside this file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) picture: Option<String>,
    /// Time to segment it.
    #[cfg_attr(test, schemars(range(min = 0)))]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<ClassesRecord>(SCHEMA, "classes.schema.json");
    }
}
