//! Label Studio's JSON, also its 'JSON-MIN': a list of tasks, each with an image and its regions, in percent of it.
//! <https://labelstud.io/guide/export>

use super::coco::fault_of;
use super::labelled::LabelledBox;
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use serde::Deserialize;
use serde_json::Value;

const REMEDY: &str = "export it from Label Studio as JSON, JSON-MIN, COCO, VOC or YOLO";

/// What regions are measured in.
const WHOLE: f64 = 100.0;

#[derive(Deserialize)]
struct Task {
    #[serde(default)]
    data: Option<Value>,
    #[serde(default)]
    annotations: Vec<Annotation>,
    /// JSON-MIN has the data beside the regions.
    #[serde(flatten)]
    rest: serde_json::Map<String, Value>,
}

#[derive(Deserialize)]
struct Annotation {
    #[serde(default)]
    result: Vec<Value>,
    #[serde(default)]
    was_cancelled: bool,
}

/// One region of the full form, whose numbers are in `value`.
#[derive(Deserialize)]
struct Region {
    #[serde(default)]
    value: Option<Value>,
    #[serde(default)]
    original_width: Option<f64>,
    #[serde(default)]
    original_height: Option<f64>,
    #[serde(default)]
    score: Option<f64>,
}

#[derive(Deserialize)]
struct Shape {
    #[serde(default)]
    x: Option<f64>,
    #[serde(default)]
    y: Option<f64>,
    #[serde(default)]
    width: Option<f64>,
    #[serde(default)]
    height: Option<f64>,
    #[serde(default)]
    rotation: f64,
    #[serde(default, rename = "radiusX")]
    radius_x: Option<f64>,
    #[serde(default, rename = "radiusY")]
    radius_y: Option<f64>,
    #[serde(default)]
    points: Vec<[f64; 2]>,
    #[serde(
        default,
        alias = "polygonlabels",
        alias = "ellipselabels",
        alias = "labels"
    )]
    rectanglelabels: Vec<String>,
}

/// Whether a JSON list is of such tasks.
pub(super) fn is(first: &Value) -> bool {
    let has = |key: &str| first.get(key).is_some();
    (has("data") && (has("annotations") || has("predictions")))
        || (has("image") && has("annotator"))
}

pub(super) fn parse(text: &str, width: usize, height: usize) -> Result<Parsed, Malformed> {
    let tasks: Vec<Task> = serde_json::from_str(text).map_err(|e| fault_of(&e, REMEDY))?;
    let mut parsed = Parsed::default();
    for (index, task) in tasks.iter().enumerate() {
        let place = format!("task {index}");
        let data = task
            .data
            .as_ref()
            .and_then(Value::as_object)
            .unwrap_or(&task.rest);
        let mut image = ImageBoxes {
            name: image_of(data),
            ..ImageBoxes::default()
        };
        let regions: Vec<&Value> = if task.data.is_some() {
            // The last one is the one that was handed in last.
            let done = task
                .annotations
                .iter()
                .rfind(|annotation| !annotation.was_cancelled);
            done.iter()
                .flat_map(|annotation| &annotation.result)
                .collect()
        } else {
            task.rest
                .values()
                .filter_map(Value::as_array)
                .flatten()
                .collect()
        };
        for region in regions {
            add(&mut image, region, &place, [width, height])?;
        }
        parsed.images.push(image);
    }
    Ok(parsed)
}

/// The image's file: the first text of the data that is called so, without what the upload put before its name.
fn image_of(data: &serde_json::Map<String, Value>) -> Option<String> {
    let named = data
        .get("image")
        .or_else(|| data.get("img"))
        .or_else(|| data.get("url"));
    let path = named?.as_str()?.rsplit("?d=").next()?;
    let (folder, name) = path
        .rsplit_once('/')
        .map_or(("", path), |(folder, name)| (folder, name));
    // An upload is called `0123abcd-color.png`.
    let own = match name.split_once('-') {
        Some((prefix, own))
            if prefix.len() == 8 && prefix.chars().all(|c| c.is_ascii_hexdigit()) =>
        {
            own
        }
        _ => return Some(path.to_owned()),
    };
    Some(if folder.contains("/upload") {
        own.to_owned()
    } else {
        format!("{folder}/{own}")
    })
}

fn add(
    image: &mut ImageBoxes,
    region: &Value,
    place: &str,
    size: [usize; 2],
) -> Result<(), Malformed> {
    let fault = |problem: String| Malformed::new(place, problem, REMEDY);
    let read = |e: &serde_json::Error| fault(e.to_string());
    let head = Region::deserialize(region).map_err(|e| read(&e))?;
    let shape = Shape::deserialize(head.value.as_ref().unwrap_or(region)).map_err(|e| read(&e))?;
    let Some(percent) = bounds(&shape).map_err(fault)? else {
        return Ok(());
    };
    let [width, height] = match (head.original_width, head.original_height) {
        (Some(width), Some(height)) => {
            image
                .size
                .get_or_insert((place.to_owned(), [width, height]));
            [width, height]
        }
        _ => size.map(|side| side as f64),
    };
    let [x0, y0, x1, y1] = percent.map(|p| p / WHOLE);
    image.labels.push(LabelledBox {
        class_name: shape.rectanglelabels.first().cloned(),
        ..LabelledBox::new(PixelBox {
            name: image.labels.len().to_string(),
            x_min: x0 * width,
            y_min: y0 * height,
            x_max: x1 * width,
            y_max: y1 * height,
            score: head.score.unwrap_or(1.0),
        })
    });
    Ok(())
}

/// The bounds of a region in percent; nothing for what is none, such as a choice for the whole image.
fn bounds(shape: &Shape) -> Result<Option<[f64; 4]>, String> {
    if shape.rotation != 0.0 {
        return Err(format!(
            "a region turned by {} degrees; boxes here are upright",
            shape.rotation
        ));
    }
    if let (Some(x), Some(y), Some(w), Some(h)) = (shape.x, shape.y, shape.width, shape.height) {
        return Ok(Some([x, y, x + w, y + h]));
    }
    if let (Some(x), Some(y), Some(a), Some(b)) = (shape.x, shape.y, shape.radius_x, shape.radius_y)
    {
        return Ok(Some([x - a, y - b, x + a, y + b]));
    }
    let mut points = shape.points.iter();
    let Some(&[x, y]) = points.next() else {
        return Ok(None);
    };
    Ok(Some(
        points.fold([x, y, x, y], |[x0, y0, x1, y1], &[x, y]| {
            [x0.min(x), y0.min(y), x1.max(x), y1.max(y)]
        }),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(label: &LabelledBox) -> [f64; 4] {
        let b = &label.bounds;
        [b.x_min, b.y_min, b.x_max, b.y_max]
    }

    #[test]
    fn regions_of_the_last_annotation_in_pixels() {
        let text = r#"[{"id":3,"data":{"image":"/data/upload/1/0123abcd-color.png"},"predictions":[],"annotations":[
            {"was_cancelled":false,"result":[]},
            {"was_cancelled":false,"result":[
              {"type":"rectanglelabels","original_width":200,"original_height":100,"image_rotation":0,
               "value":{"x":10,"y":20,"width":5,"height":10,"rotation":0,"rectanglelabels":["apple"]}},
              {"type":"polygonlabels","original_width":200,"original_height":100,
               "value":{"points":[[1,2],[3,1],[2,8]],"polygonlabels":["leaf"]}},
              {"type":"choices","value":{"choices":["good"]}}]},
            {"was_cancelled":true,"result":[]}]}]"#;
        let image = parse(text, 200, 100).unwrap().images.remove(0);
        assert_eq!(image.name.as_deref(), Some("color.png"));
        assert_eq!(image.labels.len(), 2);
        assert_eq!(edges(&image.labels[0]), [20.0, 20.0, 30.0, 30.0]);
        assert_eq!(edges(&image.labels[1]), [2.0, 1.0, 6.0, 8.0]);
        assert_eq!(image.labels[1].class_name.as_deref(), Some("leaf"));
    }

    #[test]
    fn the_short_form_and_what_is_refused() {
        let text = |rotation: u32| {
            format!(
                r#"[{{"image":"/data/local-files/?d=a/color.png","id":1,"annotator":1,"label":[{{"x":50,"y":50,
                "width":10,"height":10,"rotation":{rotation},"rectanglelabels":["apple"],"original_width":40,
                "original_height":20}}]}}]"#
            )
        };
        let image = parse(&text(0), 40, 20).unwrap().images.remove(0);
        assert_eq!(image.name.as_deref(), Some("a/color.png"));
        assert_eq!(edges(&image.labels[0]), [20.0, 10.0, 24.0, 12.0]);
        let fault = parse(&text(30), 40, 20).unwrap_err();
        assert!(
            fault.problem.contains("turned by 30 degrees") && fault.place == "task 0",
            "{fault:?}"
        );
    }
}
