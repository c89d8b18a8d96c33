use super::claim::check_claim;
use crate::ColorImage;
use pomona_files::Malformed;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Pixels that one byte of a JPEG can stand for at most: a block of 16x16 pixels takes six
/// codes of one bit or more.
const PIXELS_PER_BYTE: usize = 512;

type Decoder<'a> = JpegDecoder<ZCursor<&'a [u8]>>;

pub(super) fn parse(bytes: &[u8]) -> Result<ColorImage, Malformed> {
    // The decoder takes a file that is cut short in its last rows.
    if !reaches_end(bytes) {
        return Err(fault(
            "the file is cut short: no end-of-image marker".to_owned(),
        ));
    }
    let (mut decoder, (width, height)) = open(bytes)?;
    let data = decoder.decode().map_err(|e| fault(e.to_string()))?;
    let pixels = data.as_chunks::<3>().0.to_vec();
    if pixels.len() != width * height || data.len() != 3 * pixels.len() {
        return Err(fault(format!(
            "{} bytes came out for {width}x{height} RGB pixels",
            data.len()
        )));
    }
    Ok(ColorImage {
        width,
        height,
        pixels,
    })
}

/// Whether a file begins as a JPEG does.
pub(super) fn is(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xff\xd8")
}

/// The EXIF data, where there are any.
pub(super) fn exif(bytes: &[u8]) -> Result<Option<Vec<u8>>, Malformed> {
    let (decoder, _) = open(bytes)?;
    Ok(decoder.exif().cloned())
}

pub(super) fn parse_size(bytes: &[u8]) -> Result<(usize, usize), Malformed> {
    open(bytes).map(|(_, size)| size)
}

/// A decoder that has read the headers, and the size that they state.
fn open(bytes: &[u8]) -> Result<(Decoder<'_>, (usize, usize)), Malformed> {
    // Without strict mode a file that is cut short comes back as a picture with a grey rest.
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| fault(e.to_string()))?;
    let (width, height) = decoder
        .dimensions()
        .ok_or_else(|| fault("the header has no size".to_owned()))?;
    check_claim(width, height, bytes, PIXELS_PER_BYTE)?;
    Ok((decoder, (width, height)))
}

fn fault(problem: String) -> Malformed {
    Malformed::new(
        "JPEG data",
        problem,
        "write the picture again, as baseline or progressive JPEG or as PNG",
    )
}

/// Whether the end-of-image marker stands where the segments lead to: a thumbnail inside the
/// metadata has one of its own.
fn reaches_end(bytes: &[u8]) -> bool {
    const START_OF_SCAN: u8 = 0xda;
    const END_OF_IMAGE: u8 = 0xd9;
    let mut rest = bytes.get(2..).unwrap_or_default();
    loop {
        let [0xff, marker, tail @ ..] = rest else {
            return false;
        };
        rest = match *marker {
            END_OF_IMAGE => return true,
            // Fill bytes before a marker.
            0xff => &rest[1..],
            // Markers without a length.
            0x01 | 0xd0..=0xd7 => tail,
            _ => {
                let Some(length) = tail.first_chunk::<2>() else {
                    return false;
                };
                let segment_end = usize::from(u16::from_be_bytes(*length));
                let Some(after) = tail.get(segment_end..) else {
                    return false;
                };
                if *marker == START_OF_SCAN {
                    after_scan(after)
                } else {
                    after
                }
            }
        };
    }
}

/// The bytes from the marker on that ends a scan's compressed data.
fn after_scan(data: &[u8]) -> &[u8] {
    // 0xff in the data is followed by 0, or is a restart marker.
    let is_marker = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 0xd0..=0xd7);
    data.windows(2)
        .position(is_marker)
        .map_or(&[], |at| &data[at..])
}
