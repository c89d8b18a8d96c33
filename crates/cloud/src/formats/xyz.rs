//! XYZ text: `x y z` or `x y z r g b` on each line, colours as bytes.
//!
//! Values are separated by blanks, tabs, commas or semicolons; `#` and `//` begin
//! comments. A comment `pomona organised WIDTH HEIGHT` keeps the size of an organised cloud.

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
            let is_byte = |c: &f64| c.fract() == 0.0 && (0.0..=255.0).contains(c);
            if let Some(wrong) = [r, g, b].iter().find(|c| !is_byte(c)) {
                return Err(fault(format!(
                    "{wrong} in columns 4 to 6 is no colour (a normal?)"
                )));
            }
            cloud
                .colors
                .get_or_insert_default()
                .push([r as u8, g as u8, b as u8]);
        }
        cloud.x.push(x as f32);
        cloud.y.push(y as f32);
        cloud.z.push(z as f32);
    }
    cloud.size = size.filter(|&(width, height)| width.checked_mul(height) == Some(cloud.len()));
    Ok(cloud)
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
