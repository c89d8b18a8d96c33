//! YOLO label text: `class cx cy w h [score]` on each line, as fractions of the image.

use super::labelled::{LabelKind, LabelledBox};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use std::fmt::Write;

const REMEDY: &str =
    "give `class cx cy w h [score]` on each line, as fractions of the image's width and height";

pub(super) fn parse(
    text: &str,
    width: usize,
    height: usize,
) -> Result<Vec<LabelledBox>, Malformed> {
    let (width, height) = (width as f64, height as f64);
    let mut boxes = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let fault = |problem: String| Malformed::new(format!("line {number}"), problem, REMEDY);
        let tokens: Vec<&str> = line.split_whitespace().collect();
        if tokens.is_empty() {
            continue;
        }
        if !(5..=6).contains(&tokens.len()) {
            return Err(fault(format!(
                "{} values where a box has 5 or 6",
                tokens.len()
            )));
        }
        let class: u32 = tokens[0]
            .parse()
            .map_err(|_| fault(format!("class `{}` is no whole number", tokens[0])))?;
        let mut values = [0.0, 0.0, 0.0, 0.0, 1.0];
        for (value, token) in values.iter_mut().zip(&tokens[1..]) {
            *value = token
                .parse()
                .map_err(|_| fault(format!("`{token}` is not a number")))?;
        }
        let [cx, cy, w, h, score] = values;
        let bounds = PixelBox {
            name: boxes.len().to_string(),
            x_min: (cx - 0.5 * w) * width,
            y_min: (cy - 0.5 * h) * height,
            x_max: (cx + 0.5 * w) * width,
            y_max: (cy + 0.5 * h) * height,
            score,
        };
        boxes.push(LabelledBox {
            bounds,
            class_number: Some(class.into()),
            class_name: None,
            kind: LabelKind::Object,
        });
    }
    Ok(boxes)
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

    #[test]
    fn reads_fractions_with_and_without_score() {
        let boxes = parse(
            "0 0.5 0.5 0.25 0.5\r\n\r\n53 0.25 0.25 0.5 0.5 0.75\n",
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
        assert_eq!(parse("", 8, 4).unwrap(), []);
    }

    #[test]
    fn faults_name_the_line() {
        assert_eq!(
            parse("0 0.5 0.5 0.2 0.5\n0 1 2 3", 8, 4).unwrap_err().place,
            "line 2"
        );
        assert!(
            parse("apple 0.5 0.5 0.2 0.5", 8, 4)
                .unwrap_err()
                .problem
                .contains("`apple`")
        );
        assert!(
            parse("0 0.5 x 0.2 0.5", 8, 4)
                .unwrap_err()
                .problem
                .contains("`x`")
        );
        assert!(
            parse("0 0.1 0.1 0.2 0.1 0.2 0.2", 8, 4)
                .unwrap_err()
                .problem
                .contains('7')
        );
    }
}
