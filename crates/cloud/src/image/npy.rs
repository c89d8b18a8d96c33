//! NPY, NumPy's form of one array. <https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>

use super::depth_values::DepthValues;
use pomona_files::Malformed;

const REMEDY: &str = "give a depth image as numpy.save writes it: two axes, of u2 in units of `depth_scale`, or of f4 or f8 in \
                      metres";

/// The first bytes of every such file.
const MAGIC: &[u8] = b"\x93NUMPY";

/// Whether a file begins as an NPY does.
pub(super) fn is(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

pub(super) fn parse(bytes: &[u8]) -> Result<DepthValues, Malformed> {
    let fault = |problem: String| Malformed::new("NPY header", problem, REMEDY);
    let (header, data) = split(bytes).ok_or_else(|| fault("cut short".to_owned()))?;
    let header = String::from_utf8_lossy(header);
    let text = |key: &str| {
        let (_, after) = header.split_once(&format!("'{key}':"))?;
        Some(after.trim_start())
    };
    let kind = text("descr")
        .and_then(|after| after.strip_prefix('\'')?.split_once('\''))
        .map(|(kind, _)| kind)
        .ok_or_else(|| fault("no `descr` of one type".to_owned()))?;
    let shape = text("shape")
        .and_then(|after| after.strip_prefix('(')?.split_once(')'))
        .map(|(shape, _)| shape)
        .ok_or_else(|| fault("no `shape`".to_owned()))?;
    let sides: Option<Vec<usize>> = shape
        .split(',')
        .map(str::trim)
        .filter(|side| !side.is_empty())
        .map(|side| side.parse().ok())
        .collect();
    let (Some([height, width] | [height, width, 1]), Some(order)) =
        (sides.as_deref(), text("fortran_order"))
    else {
        return Err(fault(format!(
            "its shape is ({shape}), not (height, width)"
        )));
    };
    let (width, height) = (*width, *height);
    let (is_big, kind) = match kind.split_at_checked(1) {
        Some((">", kind)) => (true, kind),
        Some(("<" | "|" | "=", kind)) => (false, kind),
        _ => (false, kind),
    };
    let size = match kind {
        "u2" | "i2" => 2,
        "u4" | "i4" | "f4" => 4,
        "u8" | "i8" | "f8" => 8,
        _ => return Err(fault(format!("its type is `{kind}`"))),
    };
    let count = width
        .checked_mul(height)
        .and_then(|count| count.checked_mul(size));
    if count != Some(data.len()) || data.is_empty() {
        let problem = format!(
            "{width}x{height} values of {size} bytes, but {} bytes follow",
            data.len()
        );
        return Err(Malformed::new(
            "NPY data",
            problem,
            "write the file again; it is cut short or damaged",
        ));
    }
    let number = |bytes: &[u8]| -> f64 {
        let mut eight = [0; 8];
        for (k, byte) in bytes.iter().enumerate() {
            // Little-endian from here on.
            eight[if is_big { size - 1 - k } else { k }] = *byte;
        }
        let [a, b, c, d, ..] = eight;
        match kind {
            "i2" => f64::from(i16::from_le_bytes([a, b])),
            "i4" => f64::from(i32::from_le_bytes([a, b, c, d])),
            "i8" => i64::from_le_bytes(eight) as f64,
            "f4" => f64::from(f32::from_le_bytes([a, b, c, d])),
            "f8" => f64::from_le_bytes(eight),
            _ => u64::from_le_bytes(eight) as f64,
        }
    };
    let mut values: Vec<f64> = data.chunks_exact(size).map(number).collect();
    if order.starts_with("True") {
        values = (0..values.len())
            .map(|k| values[k % width * height + k / width])
            .collect();
    }
    DepthValues::new(width, height, values, kind.starts_with('f'))
}

/// The header's text, and what stands behind it.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let rest = bytes.strip_prefix(MAGIC)?;
    let (version, rest) = rest.split_first_chunk::<2>()?;
    let (length, rest) = if version[0] == 1 {
        let (length, rest) = rest.split_first_chunk::<2>()?;
        (usize::from(u16::from_le_bytes(*length)), rest)
    } else {
        let (length, rest) = rest.split_first_chunk::<4>()?;
        (usize::try_from(u32::from_le_bytes(*length)).ok()?, rest)
    };
    rest.split_at_checked(length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DepthImage;

    fn file(kind: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let header =
            format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let length = u16::try_from(header.len()).unwrap().to_le_bytes();
        [MAGIC, &[1, 0], &length, header.as_bytes(), data].concat()
    }

    fn units(width: usize, height: usize, readings: &[u16]) -> DepthValues {
        DepthValues::Units(DepthImage {
            width,
            height,
            readings: readings.to_vec(),
        })
    }

    #[test]
    fn arrays_of_every_order_and_type() {
        let little: Vec<u8> = [1_u16, 2, 3, 4, 5, 600]
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let big: Vec<u8> = [1_u16, 2, 3, 4, 5, 600]
            .iter()
            .flat_map(|x| x.to_be_bytes())
            .collect();
        let rows = units(3, 2, &[1, 2, 3, 4, 5, 600]);
        assert_eq!(
            parse(&file("<u2", "False", "(2, 3)", &little)),
            Ok(rows.clone())
        );
        assert_eq!(
            parse(&file(">u2", "False", "(2, 3)", &big)),
            Ok(rows.clone())
        );
        assert_eq!(parse(&file("<i2", "False", "(2, 3, 1)", &little)), Ok(rows));
        let columns = units(3, 2, &[1, 3, 5, 2, 4, 600]);
        assert_eq!(parse(&file("<u2", "True", "(2, 3)", &little)), Ok(columns));
        let metres: Vec<u8> = [1.5_f32, f32::NAN]
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let Ok(DepthValues::Metres {
            width,
            height,
            values,
        }) = parse(&file("<f4", "False", "(1, 2)", &metres))
        else {
            panic!("no metres");
        };
        assert_eq!(
            (width, height, values[0], values[1].is_nan()),
            (2, 1, 1.5, true)
        );
    }

    #[test]
    fn what_is_no_depth_image_is_refused() {
        for (file, words) in [
            (file("<u2", "False", "(2, 3)", &[0; 10]), "10 bytes follow"),
            (file("<c8", "False", "(1, 1)", &[0; 8]), "`c8`"),
            (file("|u1", "False", "(1, 1)", &[0]), "`u1`"),
            (file("<u2", "False", "(6,)", &[0; 12]), "(6,)"),
            (file("<u2", "False", "(1, 1, 3)", &[0; 6]), "(1, 1, 3)"),
            (
                file("<u2", "False", "(99999999999, 99999999999)", &[0; 6]),
                "6 bytes follow",
            ),
            (b"\x93NUMPY\x01\x00\xff\xff{}".to_vec(), "cut short"),
        ] {
            let fault = parse(&file).unwrap_err();
            assert!(fault.problem.contains(words), "{fault:?}");
        }
        let whole = file("<u2", "False", "(2, 3)", &[0; 12]);
        for length in 0..whole.len() {
            assert!(parse(&whole[..length]).is_err(), "{length}");
        }
    }
}
