//! Pictures of the apples whose wood is seen, with what each method says of them.

use crate::output_folder::Staging;
use pomona_cloud::ColorImage;
use pomona_evaluate::{RealFrame, RealReport, RealResult, RealRow, Verdict, WoodSeen};
use pomona_labels::{Stroke, StrokeClass};
use pomona_view::{ContactSheetImage, Enlargement, contact_sheet};

/// Half of a picture's side, radii of the apple's box.
const HALF_SIDE_RADII: f64 = 4.5;
/// Side of a picture, pixels: an apple of 28 pixels of radius is enlarged threefold.
const SIDE: usize = 756;
/// Pictures in a row of a sheet.
const COLUMNS: usize = 4;
/// Pictures on a sheet.
const ON_A_SHEET: usize = 12;
/// Widths in pixels of the picture: of what a person drew, and of what a method says.
const THIN: f32 = 1.2;
const WIDE: f32 = 3.0;
/// Width of the dark rim that sets a line off from red apples and bright sky.
const RIM: f32 = 6.0;
const DARK: [u8; 3] = [20, 22, 28];
/// Radius of a dot.
const DOT: f32 = 5.0;

const RIGHT: [u8; 3] = [30, 235, 60];
const ELSEWHERE: [u8; 3] = [255, 60, 220];
const REFUSED: [u8; 3] = [255, 150, 20];
const WOOD: [u8; 3] = [255, 222, 0];
const OTHER_STROKE: [u8; 3] = [150, 200, 255];

/// The file of a sheet: numbers of the method and of the sheet, counted from 1.
fn name(method: usize, sheet: usize) -> String {
    format!("worst-{method}-{sheet}.png")
}

/// Whether a file of this name is such a sheet.
pub(super) fn is_picture(name: &str) -> bool {
    let numbers = name
        .strip_prefix("worst-")
        .and_then(|n| n.strip_suffix(".png"))
        .and_then(|n| n.split_once('-'));
    numbers.is_some_and(|(a, b)| a.parse::<usize>().is_ok() && b.parse::<usize>().is_ok())
}

/// Writes the sheets of each method; their names.
pub(super) fn write(
    frames: &[RealFrame],
    report: &RealReport,
    output: &Staging<'_>,
) -> anyhow::Result<Vec<Vec<String>>> {
    let mut names = Vec::new();
    for (method, result) in (1..).zip(&report.results) {
        let mut own = Vec::new();
        for (sheet, rows) in (1..).zip(worst_first(result).chunks(ON_A_SHEET)) {
            let pictures: Vec<ContactSheetImage> = rows
                .iter()
                .map(|row| picture(frames, row))
                .collect::<anyhow::Result<_>>()?;
            let file = name(method, sheet);
            contact_sheet(&pictures, COLUMNS, SIDE)?.write(output.file(&file))?;
            own.push(file);
        }
        names.push(own);
    }
    Ok(names)
}

/// The apples whose wood is seen: those whose answers point elsewhere, the most confident first, then the refused ones
/// and the right ones.
fn worst_first(result: &RealResult) -> Vec<&RealRow> {
    let seen = result
        .apples
        .iter()
        .filter(|row| row.wood == WoodSeen::Seen);
    let mut rows: Vec<&RealRow> = seen.collect();
    let class = |row: &RealRow| match row.verdict {
        Verdict::Elsewhere => 0,
        Verdict::Refused => 1,
        _ => 2,
    };
    let badness = |row: &RealRow| {
        (
            row.confidence.unwrap_or(1.0),
            row.image_angle.unwrap_or(0.0),
        )
    };
    rows.sort_by(|a, b| {
        let (x, y) = (badness(a), badness(b));
        class(a)
            .cmp(&class(b))
            .then(y.0.total_cmp(&x.0))
            .then(y.1.total_cmp(&x.1))
    });
    rows
}

fn picture(frames: &[RealFrame], row: &RealRow) -> anyhow::Result<ContactSheetImage> {
    let frame = frames.iter().find(|frame| frame.frame.id == row.frame);
    let image = frame.map_or_else(|| Ok(ColorImage::filled(1, 1, [0; 3])), |f| drawn(f, row))?;
    let confidence = row
        .confidence
        .map_or_else(String::new, |c| format!(", confidence {c:.2}"));
    let angle = row
        .image_angle
        .map_or_else(String::new, |a| format!(", {:.0} deg off", a.to_degrees()));
    let what = match row.verdict {
        Verdict::Refused => row.status.as_str(),
        verdict => verdict.name(),
    };
    let caption = format!("{} {}: {what}{confidence}{angle}", row.frame, row.box_name);
    Ok(ContactSheetImage::new(image, Vec::new(), caption))
}

/// The surroundings of an apple: strokes thin, the nearest wood as dots, the method's sphere, and its line to the foot in
/// the colour of the verdict.
fn drawn(frame: &RealFrame, row: &RealRow) -> anyhow::Result<ColorImage> {
    let color = match row.verdict {
        Verdict::Right => RIGHT,
        Verdict::Refused => REFUSED,
        _ => ELSEWHERE,
    };
    let boxes = frame.boxes().iter();
    let mut of_box = boxes.filter(|b| b.name == row.box_name).map(|b| {
        [
            f64::midpoint(b.x_min, b.x_max),
            f64::midpoint(b.y_min, b.y_max),
        ]
    });
    let middle = of_box.next().or(row.center_px).unwrap_or_default();
    let half_side = HALF_SIDE_RADII * row.box_radius_px;
    let mut picture = Enlargement::new(&frame.frame.color, middle, half_side, SIDE)?;
    for stroke in &frame.strokes.strokes {
        let color = match stroke.class {
            StrokeClass::Wood => WOOD,
            _ => OTHER_STROKE,
        };
        picture.line(&line_of(stroke), color, THIN);
    }
    for &wood in &row.wood_px {
        picture.dot(wood, DOT, WOOD);
    }
    if let (Some(center), Some(radius), Some([_, _, z])) = (row.center_px, row.radius, row.center) {
        let focal_px = f64::midpoint(frame.frame.camera.fx, frame.frame.camera.fy);
        picture.circle(center, radius * focal_px / z, color, THIN);
        if let Some(foot) = row.foot_px {
            picture.line(&[center, foot], DARK, RIM);
            picture.dot(foot, DOT + (RIM - WIDE) / 2.0, DARK);
            picture.line(&[center, foot], color, WIDE);
            picture.dot(foot, DOT, color);
        }
    }
    Ok(picture.into_image())
}

fn line_of(stroke: &Stroke) -> Vec<[f64; 2]> {
    stroke.points.iter().map(|p| [p.x, p.y]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_files_are_known_by_their_names() {
        assert!(is_picture(&name(2, 13)));
        for other in [
            "worst-1.png",
            "worst-a-1.png",
            "worst-1-1.jpg",
            "best-1-1.png",
        ] {
            assert!(!is_picture(other), "{other}");
        }
    }
}
