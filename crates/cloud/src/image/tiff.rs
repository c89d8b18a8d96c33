//! TIFF, as programs write depth in it: one grey channel of 16 bits or in floating point.

use super::claim::check_claim;
use super::depth_values::DepthValues;
use pomona_files::Malformed;
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult};

/// Pixels that one byte of a TIFF can stand for at most: deflate shrinks by 1032 at best, and a depth pixel has 2 bytes.
const PIXELS_PER_BYTE: usize = 1032;

/// Whether a file begins as a TIFF does, in either order of bytes.
pub(super) fn is(bytes: &[u8]) -> bool {
    [b"II*\0", b"MM\0*"]
        .iter()
        .any(|magic| bytes.starts_with(*magic))
}

#[expect(clippy::needless_pass_by_value, reason = "`map_err` hands errors over")]
fn fault(problem: impl ToString) -> Malformed {
    Malformed::new(
        "TIFF data",
        problem.to_string(),
        "write depth again, as TIFF or PNG of 16 bits or as TIFF in floating point",
    )
}

pub(super) fn parse(bytes: &[u8]) -> Result<DepthValues, Malformed> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(fault)?;
    let (width, height) = decoder.dimensions().map_err(fault)?;
    let (width, height) = (width as usize, height as usize);
    check_claim(width, height, bytes, PIXELS_PER_BYTE)?;
    let kind = decoder.colortype().map_err(fault)?;
    let tiff::ColorType::Gray(bits) = kind else {
        return Err(fault(format!(
            "{kind:?} pixels where depth has one channel"
        )));
    };
    if bits < 16 {
        return Err(fault(format!(
            "{bits} bits to a pixel, which are too few for depth"
        )));
    }
    let (values, is_floating): (Vec<f64>, bool) = match decoder.read_image().map_err(fault)? {
        DecodingResult::U16(values) => (values.into_iter().map(f64::from).collect(), false),
        DecodingResult::I16(values) => (values.into_iter().map(f64::from).collect(), false),
        DecodingResult::U32(values) => (values.into_iter().map(f64::from).collect(), false),
        DecodingResult::I32(values) => (values.into_iter().map(f64::from).collect(), false),
        DecodingResult::F16(values) => (values.into_iter().map(f64::from).collect(), true),
        DecodingResult::F32(values) => (values.into_iter().map(f64::from).collect(), true),
        DecodingResult::F64(values) => (values, true),
        _ => return Err(fault(format!("{bits}-bit numbers of another kind"))),
    };
    DepthValues::new(width, height, values, is_floating)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DepthImage;
    use tiff::encoder::{TiffEncoder, colortype};

    #[test]
    fn grey_of_16_bits_and_in_floating_point() {
        let mut units = Cursor::new(Vec::new());
        let data: [u16; 6] = [0, 1, 2, 300, 4, 65535];
        TiffEncoder::new(&mut units)
            .unwrap()
            .write_image::<colortype::Gray16>(3, 2, &data)
            .unwrap();
        let expected = DepthImage {
            width: 3,
            height: 2,
            readings: data.to_vec(),
        };
        assert!(is(units.get_ref()));
        assert_eq!(parse(units.get_ref()), Ok(DepthValues::Units(expected)));

        let mut metres = Cursor::new(Vec::new());
        let data: [f32; 2] = [1.25, 0.0];
        TiffEncoder::new(&mut metres)
            .unwrap()
            .write_image::<colortype::Gray32Float>(2, 1, &data)
            .unwrap();
        let expected = DepthValues::Metres {
            width: 2,
            height: 1,
            values: data.to_vec(),
        };
        assert_eq!(parse(metres.get_ref()), Ok(expected));
        let whole = metres.into_inner();
        for length in 0..whole.len() {
            let _ = parse(&whole[..length]);
        }
    }

    #[test]
    fn colours_and_bytes_are_refused() {
        let mut color = Cursor::new(Vec::new());
        TiffEncoder::new(&mut color)
            .unwrap()
            .write_image::<colortype::RGB8>(1, 1, &[1, 2, 3])
            .unwrap();
        assert!(
            parse(color.get_ref())
                .unwrap_err()
                .problem
                .contains("one channel")
        );
        let mut bytes = Cursor::new(Vec::new());
        TiffEncoder::new(&mut bytes)
            .unwrap()
            .write_image::<colortype::Gray8>(1, 1, &[1])
            .unwrap();
        assert!(
            parse(bytes.get_ref())
                .unwrap_err()
                .problem
                .contains("8 bits")
        );
    }
}
