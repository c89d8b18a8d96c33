//! YOLO label text, as fractions of the image: `class cx cy w h [score]` on each line, or `class` and the corners of a
//! polygon, `x y x y x y … [score]`, which count by their bounds.

use super::labelled::{LabelKind, LabelledBox};
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use super::yolo_doubts;
use pomona_files::Malformed;
use std::fmt::Write;

const REMEDY: &str =
    "give `class cx cy w h [score]` on each line, as fractions of the image's width and height";

/// No share of an image is as large: where two numbers of a box are beyond, they are of pixels.
const LARGEST_SHARE: f64 = 2.0;

/// Fewest numbers of a polygon: three corners.
const FEWEST_OF_POLYGON: usize = 6;

/// Reads the text; `file` is its name in warnings.
pub(super) fn parse(
    text: &str,
    file: &str,
    width: usize,
    height: usize,
) -> Result<Parsed, Malformed> {
    let mut labels: Vec<LabelledBox> = Vec::new();
    let mut lines: Vec<Vec<f64>> = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let fault = |problem: String| Malformed::new(format!("line {number}"), problem, REMEDY);
        let tokens: Vec<&str> = line.split_whitespace().collect();
        let Some((class, numbers)) = tokens.split_first() else {
            continue;
        };
        if numbers.len() < 4 {
            return Err(fault(format!(
                "{} values where a box has 5 or 6",
                tokens.len()
            )));
        }
        // Some tools write the class with a fraction of zero.
        let whole = class.strip_suffix(".0").unwrap_or(class);
        let class: u32 = whole
            .parse()
            .map_err(|_| fault(format!("class `{class}` is no whole number")))?;
        let numbers: Vec<f64> = numbers
            .iter()
            .map(|token| {
                token
                    .parse()
                    .map_err(|_| fault(format!("`{token}` is not a number")))
            })
            .collect::<Result<_, _>>()?;
        let mut large = numbers.iter().filter(|x| x.abs() > LARGEST_SHARE);
        if let (Some(pixels), Some(_)) = (large.next(), large.next()) {
            return Err(Malformed::new(
                format!("line {number}"),
                format!(
                    "{pixels} where a share of the image belongs, 0 to 1: these look like pixels"
                ),
                format!(
                    "divide x and width by {width}, y and height by {height}, or give pixels as COCO or VOC"
                ),
            ));
        }
        let (shares, score) = bounds(&numbers);
        let [x0, y0, x1, y1] = shares;
        let (width, height) = (width as f64, height as f64);
        labels.push(LabelledBox {
            bounds: PixelBox {
                name: labels.len().to_string(),
                x_min: x0 * width,
                y_min: y0 * height,
                x_max: x1 * width,
                y_max: y1 * height,
                score,
            },
            class_number: Some(class.into()),
            class_name: None,
            kind: LabelKind::Object,
        });
        lines.push(numbers);
    }
    let mut parsed = Parsed::of_one(ImageBoxes {
        labels,
        ..ImageBoxes::default()
    });
    parsed.warnings.extend(yolo_doubts::of(&lines, file));
    Ok(parsed)
}

/// Left, top, right and bottom edge, and the score, of the numbers behind a class.
fn bounds(numbers: &[f64]) -> ([f64; 4], f64) {
    if numbers.len() < FEWEST_OF_POLYGON {
        let score = numbers.get(4).copied().unwrap_or(1.0);
        return (
            yolo_doubts::from_centre([numbers[0], numbers[1], numbers[2], numbers[3]]),
            score,
        );
    }
    // What is left over behind the last corner is a score.
    let corners = numbers.chunks_exact(2);
    let score = corners.remainder().first().copied().unwrap_or(1.0);
    let mut edges = [numbers[0], numbers[1], numbers[0], numbers[1]];
    for corner in corners {
        edges[0] = edges[0].min(corner[0]);
        edges[1] = edges[1].min(corner[1]);
        edges[2] = edges[2].max(corner[0]);
        edges[3] = edges[3].max(corner[1]);
    }
    (edges, score)
}

pub(super) fn format(boxes: &[PixelBox], width: usize, height: usize) -> String {
    let (width, height) = (width as f64, height as f64);
    let mut text = String::new();
    for b in boxes {
        let (cx, cy) = b.center();
        let (cx, cy, w, h) = (
            cx / width,
            cy / height,
            b.width() / width,
            b.height() / height,
        );
        // Writing to a string cannot fail.
        let _ = writeln!(text, "0 {cx} {cy} {w} {h} {}", b.score);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, width: usize, height: usize) -> Result<Vec<LabelledBox>, Malformed> {
        parse(text, "boxes.txt", width, height).map(|mut parsed| parsed.images.remove(0).labels)
    }

    #[test]
    fn reads_fractions_with_and_without_score() {
        let boxes = read(
            "0 0.5 0.5 0.25 0.5\r\n\r\n53.0 0.25 0.25 0.5 0.5 0.75\n",
            8,
            4,
        )
        .unwrap();
        assert_eq!(boxes.len(), 2);
        assert_eq!(
            (boxes[0].class_number, boxes[1].class_number),
            (Some(0), Some(53))
        );
        let b = &boxes[0].bounds;
        assert_eq!(
            (b.x_min, b.y_min, b.x_max, b.y_max, b.score),
            (3.0, 1.0, 5.0, 3.0, 1.0)
        );
        let second = &boxes[1].bounds;
        assert_eq!((second.name.as_str(), second.score), ("1", 0.75));
        assert_eq!(read("", 8, 4).unwrap(), []);
    }

    #[test]
    fn polygons_count_by_their_bounds() {
        let boxes = read(
            "2 0.5 0.25 0.75 0.5 0.625 1 0.5\n0 0.25 0.25 0.5 0.25 0.5 0.5 0.25 0.5",
            8,
            4,
        )
        .unwrap();
        let edges = |k: usize| {
            let b = &boxes[k].bounds;
            [b.x_min, b.y_min, b.x_max, b.y_max, b.score]
        };
        assert_eq!(edges(0), [4.0, 1.0, 6.0, 4.0, 0.5]);
        assert_eq!(edges(1), [2.0, 1.0, 4.0, 2.0, 1.0]);
    }

    #[test]
    fn pixels_are_refused_with_the_numbers_to_divide_by() {
        let fault = read("0 0.5 0.5 0.2 0.5\n0 566 565 98 92", 1280, 960).unwrap_err();
        assert_eq!(fault.place, "line 2");
        assert!(
            fault.problem.contains("566") && fault.problem.contains("pixels"),
            "{fault:?}"
        );
        assert!(
            fault.remedy.contains("1280") && fault.remedy.contains("960"),
            "{fault:?}"
        );
    }

    #[test]
    fn faults_name_the_line() {
        assert_eq!(
            read("0 0.5 0.5 0.2 0.5\n0 1 2 3", 8, 4).unwrap_err().place,
            "line 2"
        );
        let problem = |text: &str| read(text, 8, 4).unwrap_err().problem;
        assert!(problem("apple 0.5 0.5 0.2 0.5").contains("`apple`"));
        assert!(problem("0 0.5 x 0.2 0.5").contains("`x`"));
        assert!(problem("0.5 0.5 0.2 0.5 0.1").contains("`0.5`"));
    }
}
