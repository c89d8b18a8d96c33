//! PCD, the Point Cloud Library's format, through `pcd-rs`.
//!
//! What `pcd-rs` does not do: it trusts the header's counts (memory for any claimed size,
//! and a panic where compressed columns are shorter than the header says), so they are
//! checked against the file first; it reads static records only where a file has exactly
//! their fields, so [`PcdPoint`] picks its fields by name; it takes a packed `rgb` through
//! f32 text, which turns opaque colours into NaN; and it does not interpret WIDTH and HEIGHT.

mod point;

use super::channels::to_bytes;
use super::claim::check_claim;
use crate::PointCloud;
use pcd_rs::{DataKind, PcdMeta, Reader, Schema, ValueKind, ViewPoint, WriterInit};
use point::PcdPoint;
use pomona_files::Malformed;
use std::io::Cursor;

const DAMAGED: &str = "write the cloud again; this file is cut short or damaged";
const FIELDS: &str = "give a PCD file with the fields x, y, z and perhaps rgb or rgba";

/// Bytes that a point of a sane file takes at most; it keeps sizes from overflowing.
const MAX_POINT_BYTES: u64 = 1 << 20;
/// A back reference of LZF makes 264 bytes out of 3, which no file exceeds.
const MAX_LZF_RATIO: u64 = 88;

pub(super) fn parse(bytes: &[u8]) -> Result<PointCloud, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let meta = PcdMeta::from_reader(&mut cursor)
        .map_err(|e| Malformed::new("PCD header", e.to_string(), FIELDS))?;
    let body = bytes.get(cursor.position() as usize..).unwrap_or_default();
    for axis in ["x", "y", "z"] {
        let field = meta.field_defs.iter().find(|field| field.name == axis);
        if field.is_none_or(|field| field.count != 1) {
            let problem = format!("no field `{axis}` of one number");
            return Err(Malformed::new("PCD header, FIELDS", problem, FIELDS));
        }
    }
    check_size(&meta, body)?;
    let size = organised_size(&meta)?;
    let kinds = point::color_kinds(&meta.field_defs.fields);

    let at_point = |index: usize, e: pcd_rs::Error| {
        let place = match meta.data {
            DataKind::Ascii => format!(
                "point {} of {} (counted from 1)",
                index + 1,
                meta.num_points
            ),
            _ => format!("binary data, point {} of {}", index + 1, meta.num_points),
        };
        Malformed::new(place, e.to_string(), DAMAGED)
    };
    let reader = Reader::<PcdPoint, _>::from_bytes(bytes)
        .map_err(|e| Malformed::new("PCD data", e.to_string(), DAMAGED))?;
    let count = meta.num_points as usize;
    let mut cloud = PointCloud {
        x: Vec::with_capacity(count),
        y: Vec::with_capacity(count),
        z: Vec::with_capacity(count),
        colors: None,
        size,
    };
    let mut raw = Vec::with_capacity(if kinds.is_some() { count } else { 0 });
    for (index, record) in reader.enumerate() {
        let record = record.map_err(|e| at_point(index, e))?;
        let [x, y, z] = record.position;
        cloud.x.push(x);
        cloud.y.push(y);
        cloud.z.push(z);
        if kinds.is_some() {
            raw.push(record.color);
        }
    }
    cloud.colors = kinds.map(|kinds| to_bytes(&raw, kinds));
    Ok(cloud)
}

fn check_size(meta: &PcdMeta, body: &[u8]) -> Result<(), Malformed> {
    let mut values: u64 = 0;
    let mut point_bytes: u64 = 0;
    for field in &meta.field_defs {
        values = values.saturating_add(field.count);
        let size = (field.kind.byte_size() as u64).saturating_mul(field.count);
        point_bytes = point_bytes.saturating_add(size);
    }
    if point_bytes > MAX_POINT_BYTES {
        let problem = format!("a point of {point_bytes} bytes");
        return Err(Malformed::new(
            "PCD header, SIZE and COUNT",
            problem,
            FIELDS,
        ));
    }
    match meta.data {
        // A digit and a separator for each value, which the last one may lack.
        DataKind::Ascii => check_claim(meta.num_points, 2 * values, body.len() + 1),
        DataKind::Binary => check_claim(meta.num_points, point_bytes, body.len()),
        DataKind::BinaryCompressed => {
            let fault = |problem| Malformed::new("compressed data", problem, DAMAGED);
            let Some((sizes, data)) = body.split_first_chunk::<8>() else {
                return Err(fault("cut short before its sizes".to_owned()));
            };
            let sizes = u64::from_le_bytes(*sizes);
            let (compressed, raw) = (sizes & 0xffff_ffff, sizes >> 32);
            let expected = meta.num_points.checked_mul(point_bytes);
            if expected != Some(raw) {
                return Err(fault(format!(
                    "{raw} bytes when unpacked, but {} points of {point_bytes} bytes in the header",
                    meta.num_points
                )));
            }
            if compressed > data.len() as u64 || raw > compressed.saturating_mul(MAX_LZF_RATIO) {
                return Err(fault(format!(
                    "{raw} bytes packed in {compressed} are claimed, but {} follow",
                    data.len()
                )));
            }
            Ok(())
        }
    }
}

/// Width and height where the points stand in rows; a cloud of one row is a list.
fn organised_size(meta: &PcdMeta) -> Result<Option<(usize, usize)>, Malformed> {
    if meta.height <= 1 {
        // POINTS counts here: some writers leave a wrong WIDTH behind.
        return Ok(None);
    }
    if meta.width.checked_mul(meta.height) != Some(meta.num_points) {
        let problem = format!(
            "WIDTH {} times HEIGHT {} is not POINTS {}",
            meta.width, meta.height, meta.num_points
        );
        return Err(Malformed::new(
            "PCD header",
            problem,
            "correct the header, or set HEIGHT to 1",
        ));
    }
    Ok(Some((meta.width as usize, meta.height as usize)))
}

pub(super) fn format(cloud: &PointCloud, kind: DataKind) -> Result<Vec<u8>, Malformed> {
    let fault =
        |problem: String| Malformed::new("cloud to write", problem, "write it in another format");
    let mut fields = vec![
        ("x", ValueKind::F32, 1),
        ("y", ValueKind::F32, 1),
        ("z", ValueKind::F32, 1),
    ];
    if cloud.colors.is_some() {
        // PCL's readers take both; text of packed floats would lose colours, and old
        // readers of binary data know the float only. The bytes are the same.
        let packed = if kind == DataKind::Ascii {
            ValueKind::U32
        } else {
            ValueKind::F32
        };
        fields.push(("rgb", packed, 1));
    }
    let bytes_each = 4 * fields.len();
    let unpacked = cloud
        .len()
        .checked_mul(bytes_each)
        .and_then(|size| u32::try_from(size).ok());
    if kind == DataKind::BinaryCompressed && unpacked.is_none() {
        return Err(fault(format!(
            "{} points are too many for binary_compressed",
            cloud.len()
        )));
    }
    let (width, height) = cloud.size.unwrap_or((cloud.len(), 1));
    let mut bytes = Vec::new();
    let init = WriterInit {
        width: width as u64,
        height: height as u64,
        viewpoint: ViewPoint::default(),
        data_kind: kind,
        schema: Some(fields.into_iter().collect::<Schema>()),
        version: None,
    };
    let mut writer = init
        .build_from_writer::<PcdPoint, _>(Cursor::new(&mut bytes))
        .map_err(|e| fault(e.to_string()))?;
    let pushed = (0..cloud.len()).try_for_each(|i| {
        let color = cloud
            .colors
            .as_ref()
            .map(|colors| colors[i])
            .unwrap_or_default();
        writer.push(&PcdPoint {
            position: [cloud.x[i], cloud.y[i], cloud.z[i]],
            color: color.map(f32::from),
        })
    });
    // Always finished: the writer panics when it is dropped before.
    let finished = writer.finish();
    pushed.and(finished).map_err(|e| fault(e.to_string()))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests;
