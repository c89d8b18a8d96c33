use super::class::StrokeClass;
use super::image::ImageStrokes;
use super::path::{Stroke, StrokePoint};
use crate::error::LabelsError;
use std::path::Path;

/// Largest coordinate and half width in pixels: beyond it, a number is a slip of the pen.
const LARGEST: f64 = 1e5;

/// Reads a file of strokes.
///
/// Each line is `image NAME`, which begins the strokes of an image, or a stroke of it: its class and its points
/// `x,y,half_width` in pixels, separated by blanks. A `#` begins a comment.
///
/// # Errors
///
/// [`LabelsError::Io`], and [`LabelsError::Malformed`] with the line: an unknown class, a number that is none, a stroke
/// of fewer than two points or before the first image, an image that stands twice.
pub fn read_strokes(path: &Path) -> Result<Vec<ImageStrokes>, LabelsError> {
    let bytes = std::fs::read(path).map_err(|source| LabelsError::Io {
        path: path.to_owned(),
        source,
    })?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let problem = format!("byte {} is no text", error.valid_up_to());
        LabelsError::malformed(path, &problem, "give a text file of strokes in UTF-8")
    })?;
    parse_strokes(text, path)
}

/// The strokes in a text; `path` names it in messages.
///
/// ```
/// use pomona_labels::{StrokeClass, parse_strokes};
///
/// let text = "image tree.jpg  # by the gate\nwood 84,82,2 75,110,3\npost 0,30,9 0,120,9\n";
/// let images = parse_strokes(text, "strokes.txt".as_ref())?;
/// assert_eq!(images[0].name, "tree.jpg");
/// assert_eq!(images[0].of(StrokeClass::Wood).count(), 1);
/// # Ok::<(), pomona_labels::LabelsError>(())
/// ```
///
/// # Errors
///
/// As [`read_strokes`], but for the file.
pub fn parse_strokes(text: &str, path: &Path) -> Result<Vec<ImageStrokes>, LabelsError> {
    let mut images: Vec<ImageStrokes> = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let fault = |problem: String, remedy: &str| {
            LabelsError::malformed(path, &format!("line {number}: {problem}"), remedy)
        };
        let line = line.split('#').next().unwrap_or_default().trim();
        let Some((word, rest)) = line
            .split_once(char::is_whitespace)
            .or_else(|| (!line.is_empty()).then_some((line, "")))
        else {
            continue;
        };
        if word == "image" {
            let name = rest.trim();
            if name.is_empty() {
                return Err(fault(
                    "an image without a name".to_owned(),
                    "write `image NAME`",
                ));
            }
            if images.iter().any(|image| image.name == name) {
                let problem = format!("image {name} stands a second time");
                return Err(fault(problem, "keep all strokes of an image together"));
            }
            images.push(ImageStrokes::new(name, Vec::new()));
            continue;
        }
        let Some(class) = StrokeClass::ALL
            .into_iter()
            .find(|class| class.name() == word)
        else {
            let names = StrokeClass::ALL.map(StrokeClass::name).join(", ");
            let remedy = format!("write `image NAME`, or a stroke of {names}");
            return Err(fault(format!("'{word}' begins no line"), &remedy));
        };
        let Some(image) = images.last_mut() else {
            return Err(fault(
                "a stroke of no image".to_owned(),
                "write `image NAME` before it",
            ));
        };
        let points = rest.split_whitespace().map(|text| {
            point(text).ok_or_else(|| {
                let problem = format!("'{text}' is no point");
                fault(
                    problem,
                    "write x,y,half_width in pixels, such as 84,82.5,2, the half width above 0",
                )
            })
        });
        let points: Vec<StrokePoint> = points.collect::<Result<_, _>>()?;
        if points.len() < 2 {
            let problem = format!("a stroke of {} points", points.len());
            return Err(fault(problem, "give at least two, x,y,half_width each"));
        }
        image.strokes.push(Stroke::new(class, points));
    }
    Ok(images)
}

fn point(text: &str) -> Option<StrokePoint> {
    let mut numbers = text.split(',').map(|number| number.parse::<f64>().ok());
    let (x, y, half_width) = (numbers.next()??, numbers.next()??, numbers.next()??);
    let in_range =
        x.abs() <= LARGEST && y.abs() <= LARGEST && half_width > 0.0 && half_width <= LARGEST;
    (in_range && numbers.next().is_none()).then_some(StrokePoint { x, y, half_width })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Vec<ImageStrokes>, LabelsError> {
        parse_strokes(text, Path::new("s.txt"))
    }

    #[test]
    fn images_without_strokes_are_images() {
        let images =
            parse("# mine\n\nimage a.jpg\nimage b c.jpg\n  wood 1,2,3 4,5.5,6 # bent\n").unwrap();
        assert_eq!((images.len(), images[0].strokes.len()), (2, 0));
        assert_eq!(images[1].name, "b c.jpg");
        assert_eq!(images[1].strokes[0].points[1].y, 5.5);
        assert!(parse("").unwrap().is_empty());
    }

    #[test]
    fn each_fault_has_its_line() {
        for (text, part) in [
            ("wood 1,2,3 4,5,6", "line 1: a stroke of no image"),
            ("image", "line 1: an image without a name"),
            ("image a\nimage a", "line 2: image a stands a second time"),
            ("image a\nwod 1,2,3 4,5,6", "line 2: 'wod' begins no line"),
            ("image a\nwood", "a stroke of 0 points"),
            ("image a\nwood 1,2,3", "a stroke of 1 points"),
            ("image a\nwood 1,2 4,5,6", "'1,2' is no point"),
            ("image a\nwood 1,2,3,4 4,5,6", "'1,2,3,4' is no point"),
            ("image a\nwood 1,2,0 4,5,6", "is no point"),
            ("image a\nwood nan,2,1 4,5,6", "is no point"),
            ("image a\nwood 1,inf,1 4,5,6", "is no point"),
            ("image a\nwood 1e9,2,1 4,5,6", "is no point"),
            ("image a\nwood x,2,1 4,5,6", "is no point"),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(
                message.starts_with("s.txt: line ") && message.contains(part),
                "{message}"
            );
        }
    }

    #[test]
    fn files_that_are_no_text_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("strokes.txt");
        assert!(matches!(read_strokes(&path), Err(LabelsError::Io { .. })));
        std::fs::write(&path, [b'#', 0xff, 0xfe]).unwrap();
        let message = read_strokes(&path).unwrap_err().to_string();
        assert!(message.contains("strokes.txt: byte 1"), "{message}");
    }
}
