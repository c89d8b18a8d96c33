//! Matrices as OpenCV's `FileStorage` writes them in YAML.

use super::checked::{checked, shown};
use super::error::FormatError;
use crate::{FrameTag, NamedTransform, Transform};
use nalgebra::{Matrix4, UnitQuaternion, Vector3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;

const REMEDY: &str = "give one 4x4 or 3x4 matrix; or a rotation, R (3x3) or rvec (3), with a translation, t, T or tvec (3), as cv::FileStorage writes them, in metres";

#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Matrix {
        rows: usize,
        cols: usize,
        data: Vec<f64>,
    },
    Other(IgnoredAny),
}

/// A YAML file with the 4×4 matrix `T` and, for `cv::` functions that take them apart, `R` (3×3), `t` (3×1) and
/// `rvec` (3×1, axis times angle in radians). The frames stand in a comment and in `to` and `from`.
pub fn to_opencv_yaml<To: FrameTag, From: FrameTag>(named: &NamedTransform<To, From>) -> String {
    let m = named.transform.matrix();
    let rvec = crate::twist::rotation_vector(&named.transform.rotation());
    let matrix = |name: &str, rows: usize, cols: usize, at: &dyn Fn(usize, usize) -> f64| {
        let data: Vec<String> = (0..rows)
            .flat_map(|i| (0..cols).map(move |j| (i, j)))
            .map(|(i, j)| shown(at(i, j)))
            .collect();
        format!(
            "{name}: !!opencv-matrix\n   rows: {rows}\n   cols: {cols}\n   dt: d\n   data: [ {} ]\n",
            data.join(", ")
        )
    };
    let quoted = |s: &str| serde_json::Value::from(s).to_string();
    format!(
        "%YAML:1.0\n---\nto: {}\nfrom: {}\n{}{}{}{}",
        quoted(&named.to),
        quoted(&named.from),
        matrix("T", 4, 4, &|i, j| m[(i, j)]),
        matrix("R", 3, 3, &|i, j| m[(i, j)]),
        matrix("t", 3, 1, &|i, _| m[(i, 3)]),
        matrix("rvec", 3, 1, &|i, _| rvec[i]),
    )
}

/// The transform of such a file. It is that of the one 4×4 or 3×4 matrix, whatever its name; without one that
/// of `R` or `rvec` with `t`, `T` or `tvec`. `to` and `from` name its frames: OpenCV's files do not.
///
/// # Errors
///
/// [`FormatError`] for what is no such file, holds several 4×4 matrices, or none and no pair.
pub fn from_opencv_yaml<To: FrameTag, From: FrameTag>(
    text: &str,
    to: &str,
    from: &str,
) -> Result<NamedTransform<To, From>, FormatError> {
    // The directive and the tag are OpenCV's own, and no YAML.
    let body: String = text
        .lines()
        .map(|line| {
            let dropped = line.starts_with('%') || line.trim() == "---";
            let line = if dropped { "" } else { line };
            line.replace("!!opencv-matrix", "") + "\n"
        })
        .collect();
    let entries: BTreeMap<String, Entry> = serde_saphyr::from_str(&body).map_err(|e| {
        let place = e
            .location()
            .map_or_else(|| "YAML".to_owned(), |at| format!("line {}", at.line()));
        FormatError::new(place, e.without_snippet(), REMEDY)
    })?;
    let mut whole = Vec::new();
    for (name, entry) in &entries {
        if let Entry::Matrix { rows, cols, data } = entry {
            if rows.checked_mul(*cols) != Some(data.len()) {
                let problem = format!("{rows}x{cols} numbers must stand there, {} do", data.len());
                return Err(FormatError::new(name, problem, REMEDY));
            }
            if *cols == 4 && (*rows == 3 || *rows == 4) {
                whole.push(data);
            }
        }
    }
    let matrix = match whole[..] {
        [data] => Matrix4::from_fn(|i, j| {
            let last = if j == 3 { 1.0 } else { 0.0 };
            data.get(4 * i + j).copied().unwrap_or(last)
        }),
        [] => from_parts(&entries)?,
        _ => {
            let problem = "there are several 4x4 matrices";
            return Err(FormatError::new("YAML", problem, REMEDY));
        }
    };
    checked(Transform::from_matrix(&matrix)?, to, from, REMEDY)
}

fn from_parts(entries: &BTreeMap<String, Entry>) -> Result<Matrix4<f64>, FormatError> {
    let find = |names: &[&str], numbers: usize| {
        names.iter().find_map(|name| match entries.get(*name) {
            Some(Entry::Matrix { data, .. }) if data.len() == numbers => Some(data.as_slice()),
            _ => None,
        })
    };
    let missing = |what: &str| FormatError::new(what, "there is none", REMEDY);
    let t = find(&["t", "T", "tvec"], 3).ok_or_else(|| missing("translation"))?;
    let r = if let Some(r) = find(&["R"], 9) {
        nalgebra::Matrix3::from_row_slice(r)
    } else {
        let rvec = find(&["rvec", "R"], 3).ok_or_else(|| missing("rotation"))?;
        let rvec = Vector3::new(rvec[0], rvec[1], rvec[2]);
        UnitQuaternion::from_scaled_axis(rvec)
            .to_rotation_matrix()
            .into_inner()
    };
    let mut m = Matrix4::identity();
    m.fixed_view_mut::<3, 3>(0, 0).copy_from(&r);
    m.fixed_view_mut::<3, 1>(0, 3).copy_from_slice(t);
    Ok(m)
}
