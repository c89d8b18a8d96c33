//! XYZ text: `x y z` or `x y z r g b` on each line, colours as bytes or as fractions of one. Unit vectors in the place
//! of the colours are normals, and passed over.
//!
//! Values are separated by blanks, tabs, commas or semicolons; `#` and `//` begin
//! comments. A comment `pomona organised WIDTH HEIGHT` keeps the size of an organised cloud.

use super::channels::{ChannelKind, to_bytes};
use crate::PointCloud;
use pomona_files::Malformed;
use std::fmt::Write;

const REMEDY: &str = "give `x y z` or `x y z r g b` on each line, in metres, with colours 0 to 255";
const ORGANISED: &str = "pomona organised";

pub(super) fn parse(bytes: &[u8]) -> Result<PointCloud, Malformed> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        Malformed::new(
            format!("byte {}", e.valid_up_to()),
            "not UTF-8 text",
            REMEDY,
        )
    })?;
    let mut cloud = PointCloud::new();
    let mut size = None;
    let mut columns = None;
    let mut more = Vec::new();
    for (line, number) in text.trim_start_matches('\u{feff}').lines().zip(1..) {
        let fault = |problem: String| Malformed::new(format!("line {number}"), problem, REMEDY);
        let (data, comment) = split_comment(line);
        size = comment.and_then(organised_size).or(size);
        let mut values = [0.0; 6];
        let mut count = 0;
        let tokens = data.split(|c: char| c.is_whitespace() || c == ',' || c == ';');
        for token in tokens.filter(|token| !token.is_empty()) {
            let value = token
                .parse::<f64>()
                .map_err(|_| fault(format!("`{token}` is not a number")))?;
            if let Some(place) = values.get_mut(count) {
                *place = value;
            }
            count += 1;
        }
        if count == 0 {
            continue;
        }
        if !matches!(count, 3 | 6) {
            return Err(fault(format!("{count} values where a point has 3 or 6")));
        }
        if *columns.get_or_insert(count) != count {
            return Err(fault(format!(
                "{count} values where the points before have another number"
            )));
        }
        let [x, y, z, r, g, b] = values;
        if count == 6 {
            more.push(More {
                line: number,
                numbers: [r, g, b],
            });
        }
        cloud.x.push(x as f32);
        cloud.y.push(y as f32);
        cloud.z.push(z as f32);
    }
    cloud.colors = colors(&more)?;
    cloud.size = size.filter(|&(width, height)| width.checked_mul(height) == Some(cloud.len()));
    Ok(cloud)
}

/// What stands behind a point.
struct More {
    line: usize,
    numbers: [f64; 3],
}

/// How far the length of a normal may be from 1: three decimals are written of some.
const NORMAL_TOLERANCE: f64 = 0.01;

/// The colours behind the points; `None` where there is nothing, or normals.
fn colors(more: &[More]) -> Result<Option<Vec<[u8; 3]>>, Malformed> {
    let is_normal = |m: &More| {
        let length = m.numbers.iter().map(|c| c * c).sum::<f64>().sqrt();
        (length - 1.0).abs() <= NORMAL_TOLERANCE
    };
    if more.iter().all(is_normal) {
        return Ok(None);
    }
    let is_byte = |c: &f64| c.fract() == 0.0 && (0.0..=255.0).contains(c);
    let is_fraction = |c: &f64| (0.0..=1.0).contains(c);
    let all = |is: &dyn Fn(&f64) -> bool| more.iter().all(|m| m.numbers.iter().all(is));
    let kind = if all(&is_byte) {
        ChannelKind::Byte
    } else if all(&is_fraction) {
        ChannelKind::Fraction
    } else {
        let wrong = more
            .iter()
            .find_map(|m| Some((m.line, m.numbers.iter().find(|c| !is_byte(c))?)));
        let (line, wrong) = wrong.unwrap_or((0, &f64::NAN));
        let problem = format!(
            "{wrong} in columns 4 to 6 is no colour, and they are not the unit vectors that normals are"
        );
        return Err(Malformed::new(format!("line {line}"), problem, REMEDY));
    };
    let raw: Vec<[f32; 3]> = more.iter().map(|m| m.numbers.map(|c| c as f32)).collect();
    Ok(Some(to_bytes(&raw, [kind; 3])))
}

fn split_comment(line: &str) -> (&str, Option<&str>) {
    let start = [line.find('#'), line.find("//")]
        .into_iter()
        .flatten()
        .min();
    start.map_or((line, None), |at| (&line[..at], Some(&line[at..])))
}

fn organised_size(comment: &str) -> Option<(usize, usize)> {
    let (_, numbers) = comment.split_once(ORGANISED)?;
    let (width, height) = numbers.trim().split_once(' ')?;
    Some((width.parse().ok()?, height.parse().ok()?))
}

pub(super) fn format(cloud: &PointCloud) -> Vec<u8> {
    let mut text = String::from(if cloud.colors.is_some() {
        "# x y z r g b\n"
    } else {
        "# x y z\n"
    });
    if let Some((width, height)) = cloud.size {
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(text, "# {ORGANISED} {width} {height}");
    }
    for i in 0..cloud.len() {
        let _ = write!(text, "{} {} {}", cloud.x[i], cloud.y[i], cloud.z[i]);
        if let Some(colors) = &cloud.colors {
            let [r, g, b] = colors[i];
            let _ = write!(text, " {r} {g} {b}");
        }
        text.push('\n');
    }
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_separators_comments_and_nan() {
        let cloud = parse(b"//X Y Z\r\n1 2\t3 # first\r\n\r\n-1e-3,.5;nan\r\n").unwrap();
        assert_eq!((cloud.x[0], cloud.y[0], cloud.z[0]), (1.0, 2.0, 3.0));
        assert!(cloud.x[1] == -0.001 && cloud.z[1].is_nan() && cloud.len() == 2);
        assert_eq!(cloud.colors, None);
        let colored = parse(b"1 2 3 255 0 7\n").unwrap();
        assert_eq!(colored.colors.unwrap(), [[255, 0, 7]]);
    }

    #[test]
    fn normals_are_not_colours_and_fractions_are() {
        let colors = |text: &str| parse(text.as_bytes()).unwrap().colors;
        assert_eq!(colors("1 2 3 0 0 1\n1 2 3 0 1 0\n"), None);
        assert_eq!(colors("1 2 3 0.6 0 -0.8\n1 2 3 0.577 0.577 0.577\n"), None);
        assert_eq!(
            colors("1 2 3 0 0 1\n1 2 3 9 1 0\n"),
            Some(vec![[0, 0, 1], [9, 1, 0]])
        );
        assert_eq!(
            colors("1 2 3 0 0 1\n1 2 3 0.5 0.5 1\n"),
            Some(vec![[0, 0, 255], [128, 128, 255]])
        );
    }

    #[test]
    fn faults_name_the_line() {
        for (text, problem) in [
            ("1 2 3\n1 2\n", "2 values"),
            ("1 2 3\n1 2 3 4 5 6\n", "6 values"),
            ("0 0 0\n1 2 x\n", "`x`"),
            ("0 0 0 1 1 1\n1 2 3 0.5 0 -1\n", "0.5"),
        ] {
            let fault = parse(text.as_bytes()).unwrap_err();
            assert!(
                fault.place == "line 2" && fault.problem.contains(problem),
                "{fault:?}"
            );
        }
        assert!(parse(b"1 2 \xff").is_err());
    }
}
