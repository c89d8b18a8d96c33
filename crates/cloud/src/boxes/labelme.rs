//! `LabelMe` JSON: one file for each image, with `shapes`. <https://github.com/wkentaro/labelme>

use super::coco::fault_of;
use super::labelled::LabelledBox;
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use serde::Deserialize;

const REMEDY: &str =
    "give LabelMe JSON with `shapes`, each with `label` and `points`, or COCO, VOC or YOLO";

#[derive(Deserialize)]
struct File {
    shapes: Vec<Shape>,
    #[serde(default, rename = "imagePath")]
    image_path: Option<String>,
    #[serde(default, rename = "imageWidth")]
    width: Option<f64>,
    #[serde(default, rename = "imageHeight")]
    height: Option<f64>,
}

#[derive(Deserialize)]
struct Shape {
    label: String,
    points: Vec<[f64; 2]>,
    #[serde(default, rename = "shape_type")]
    kind: Option<String>,
    #[serde(default)]
    score: Option<f64>,
}

pub(super) fn parse(text: &str) -> Result<Parsed, Malformed> {
    let file: File = serde_json::from_str(text).map_err(|e| fault_of(&e, REMEDY))?;
    let mut image = ImageBoxes {
        name: file.image_path,
        size: file
            .width
            .zip(file.height)
            .map(|(w, h)| ("`imageWidth`".to_owned(), [w, h])),
        labels: Vec::new(),
    };
    for (index, shape) in file.shapes.iter().enumerate() {
        let Some([x_min, y_min, x_max, y_max]) = bounds(shape, index)? else {
            continue;
        };
        image.labels.push(LabelledBox {
            class_name: Some(shape.label.clone()),
            ..LabelledBox::new(PixelBox {
                name: index.to_string(),
                x_min,
                y_min,
                x_max,
                y_max,
                score: shape.score.unwrap_or(1.0),
            })
        });
    }
    Ok(Parsed::of_one(image))
}

/// The bounds of a shape; nothing for points and lines, which bound no fruit.
fn bounds(shape: &Shape, index: usize) -> Result<Option<[f64; 4]>, Malformed> {
    let fault = |problem: String| Malformed::new(format!("`shapes`[{index}]"), problem, REMEDY);
    let kind = shape.kind.as_deref().unwrap_or("polygon");
    let points = &shape.points;
    match (kind, &**points) {
        ("point" | "points" | "line" | "linestrip", _) => Ok(None),
        ("circle", [[x, y], [u, v]]) => {
            let radius = (u - x).hypot(v - y);
            Ok(Some([x - radius, y - radius, x + radius, y + radius]))
        }
        ("circle", _) => Err(fault(format!(
            "a circle of {} points; it has its centre and a point on it",
            points.len()
        ))),
        ("rectangle" | "polygon" | "mask" | "rotation", [first, _, ..]) => {
            let [mut x0, mut y0] = *first;
            let [mut x1, mut y1] = *first;
            for &[x, y] in points {
                (x0, y0, x1, y1) = (x0.min(x), y0.min(y), x1.max(x), y1.max(y));
            }
            Ok(Some([x0, y0, x1, y1]))
        }
        ("rectangle" | "polygon" | "mask" | "rotation", _) => {
            Err(fault(format!("a {kind} of {} points", points.len())))
        }
        _ => Err(fault(format!(
            "`shape_type` is `{kind}`, of which no box is known"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_count_by_their_bounds() {
        let text = r#"{"version":"5.4.1","flags":{},"imagePath":"..\\a\\color.png","imageData":null,"imageHeight":48,
            "imageWidth":64,"shapes":[
            {"label":"apple","points":[[9.5,8],[1.5,2]],"shape_type":"rectangle","group_id":null,"flags":{}},
            {"label":"leaf","points":[[4,5],[9,7],[6,12]],"shape_type":"polygon"},
            {"label":"apple","points":[[20,20],[23,24]],"shape_type":"circle"},
            {"label":"stem","points":[[1,1]],"shape_type":"point"}]}"#;
        let image = parse(text).unwrap().images.remove(0);
        assert_eq!(image.name.as_deref(), Some("..\\a\\color.png"));
        assert_eq!(image.size, Some(("`imageWidth`".to_owned(), [64.0, 48.0])));
        let edges: Vec<[f64; 4]> = image
            .labels
            .iter()
            .map(|l| {
                [
                    l.bounds.x_min,
                    l.bounds.y_min,
                    l.bounds.x_max,
                    l.bounds.y_max,
                ]
            })
            .collect();
        assert_eq!(
            edges,
            [
                [1.5, 2.0, 9.5, 8.0],
                [4.0, 5.0, 9.0, 12.0],
                [15.0, 15.0, 25.0, 25.0]
            ]
        );
        assert_eq!(image.labels[1].class_name.as_deref(), Some("leaf"));
    }

    #[test]
    fn shapes_without_bounds_are_refused_by_their_place() {
        for (shape, word) in [
            (
                r#"{"label":"a","points":[[1,1]],"shape_type":"rectangle"}"#,
                "a rectangle of 1 points",
            ),
            (
                r#"{"label":"a","points":[[1,1]],"shape_type":"circle"}"#,
                "a circle of 1 points",
            ),
            (
                r#"{"label":"a","points":[[1,1],[2,2]],"shape_type":"cuboid"}"#,
                "`cuboid`",
            ),
        ] {
            let fault = parse(&format!(r#"{{"shapes":[{shape}]}}"#)).unwrap_err();
            assert!(
                fault.problem.contains(word) && fault.place == "`shapes`[0]",
                "{fault:?}"
            );
        }
    }
}
