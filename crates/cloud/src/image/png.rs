use super::claim::check_claim;
use crate::{ColorImage, DepthImage, GrayImage};
use png::{BitDepth, ColorType, Decoder, Encoder, Reader, Transformations};
use pomona_files::Malformed;
use std::io::Cursor;

/// Bits that one byte of a PNG can stand for at most: deflate shrinks by 1032 at best.
const BITS_PER_BYTE: usize = 8 * 1032;

type PngReader<'a> = Reader<Cursor<&'a [u8]>>;

#[expect(clippy::needless_pass_by_value, reason = "`map_err` hands errors over")]
fn fault(problem: impl ToString) -> Malformed {
    Malformed::new(
        "PNG data",
        problem.to_string(),
        "write the picture again; this file is damaged or no PNG",
    )
}

fn open(bytes: &[u8], transformations: Transformations) -> Result<PngReader<'_>, Malformed> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(transformations);
    let header = decoder.read_header_info().map_err(fault)?;
    let (width, height) = (header.width as usize, header.height as usize);
    check_claim(
        width,
        height,
        bytes,
        BITS_PER_BYTE / header.bits_per_pixel().max(1),
    )?;
    decoder.read_info().map_err(fault)
}

fn pixel_bytes(reader: &mut PngReader<'_>) -> Result<Vec<u8>, Malformed> {
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| fault("too large for this machine"))?;
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(fault)?;
    data.truncate(frame.buffer_size());
    // Reads to the end, so that a file cut short behind the pixels is refused as well.
    reader.finish().map_err(fault)?;
    Ok(data)
}

/// Whether a file begins as a PNG does.
pub(super) fn is(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG")
}

/// The EXIF data before the pixels, where there are any.
pub(super) fn exif(bytes: &[u8]) -> Result<Option<Vec<u8>>, Malformed> {
    let reader = open(bytes, Transformations::IDENTITY)?;
    Ok(reader
        .info()
        .exif_metadata
        .as_ref()
        .map(|exif| exif.to_vec()))
}

pub(super) fn parse_size(bytes: &[u8]) -> Result<(usize, usize), Malformed> {
    let reader = open(bytes, Transformations::IDENTITY)?;
    Ok((reader.info().width as usize, reader.info().height as usize))
}

pub(super) fn parse_color(bytes: &[u8]) -> Result<ColorImage, Malformed> {
    let mut reader = open(bytes, Transformations::EXPAND | Transformations::STRIP_16)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let data = pixel_bytes(&mut reader)?;
    let pixels: Vec<[u8; 3]> = match reader.output_color_type() {
        (ColorType::Rgb, BitDepth::Eight) => data.as_chunks::<3>().0.to_vec(),
        (ColorType::Rgba, BitDepth::Eight) => data
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&[r, g, b, _]| [r, g, b])
            .collect(),
        (ColorType::Grayscale, BitDepth::Eight) => data.iter().map(|&y| [y; 3]).collect(),
        (ColorType::GrayscaleAlpha, BitDepth::Eight) => data
            .as_chunks::<2>()
            .0
            .iter()
            .map(|&[y, _]| [y; 3])
            .collect(),
        (color, depth) => return Err(fault(format!("{color:?} pixels of {depth:?} bits"))),
    };
    if pixels.len() != width * height {
        return Err(fault(format!(
            "{} pixels came out for {width}x{height}",
            pixels.len()
        )));
    }
    Ok(ColorImage {
        width,
        height,
        pixels,
    })
}

pub(super) fn parse_depth(bytes: &[u8]) -> Result<DepthImage, Malformed> {
    let mut reader = open(bytes, Transformations::IDENTITY)?;
    let (color, bits) = reader.output_color_type();
    if (color, bits) != (ColorType::Grayscale, BitDepth::Sixteen) {
        let channels = color.samples();
        let problem = format!(
            "a {}-bit {color:?} image ({} bits to a pixel) where depth must be 16-bit grey",
            bits as u8,
            channels * bits as usize
        );
        let remedy = "store depth as 16-bit grey PNG in units of `depth_scale`, or as TIFF or NPY; a coloured or 8-bit picture of depth has lost it";
        return Err(Malformed::new("PNG header", problem, remedy));
    }
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let data = pixel_bytes(&mut reader)?;
    let readings: Vec<u16> = data
        .as_chunks::<2>()
        .0
        .iter()
        .map(|&pair| u16::from_be_bytes(pair))
        .collect();
    if readings.len() != width * height {
        return Err(fault(format!(
            "{} readings came out for {width}x{height}",
            readings.len()
        )));
    }
    Ok(DepthImage {
        width,
        height,
        readings,
    })
}

pub(super) fn parse_gray(bytes: &[u8]) -> Result<GrayImage, Malformed> {
    let mut reader = open(bytes, Transformations::EXPAND)?;
    let (color, bits) = reader.output_color_type();
    if (color, bits) != (ColorType::Grayscale, BitDepth::Eight) {
        let problem = format!(
            "a {}-bit {color:?} image where a mask must be 8-bit grey",
            bits as u8
        );
        let remedy = "store the mask as 8-bit grey PNG without transparency";
        return Err(Malformed::new("PNG header", problem, remedy));
    }
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let values = pixel_bytes(&mut reader)?;
    if values.len() != width * height {
        return Err(fault(format!(
            "{} values came out for {width}x{height}",
            values.len()
        )));
    }
    Ok(GrayImage {
        width,
        height,
        values,
    })
}

pub(super) fn format_gray(image: &GrayImage) -> Result<Vec<u8>, Malformed> {
    let kind = (ColorType::Grayscale, BitDepth::Eight);
    encode(
        image.width,
        image.height,
        image.values.len(),
        &image.values,
        kind,
    )
}

pub(super) fn format_color(image: &ColorImage) -> Result<Vec<u8>, Malformed> {
    let data = image.pixels.as_flattened();
    encode(
        image.width,
        image.height,
        image.pixels.len(),
        data,
        (ColorType::Rgb, BitDepth::Eight),
    )
}

pub(super) fn format_depth(image: &DepthImage) -> Result<Vec<u8>, Malformed> {
    let data: Vec<u8> = image
        .readings
        .iter()
        .flat_map(|r| r.to_be_bytes())
        .collect();
    let kind = (ColorType::Grayscale, BitDepth::Sixteen);
    encode(image.width, image.height, image.readings.len(), &data, kind)
}

fn encode(
    width: usize,
    height: usize,
    pixel_count: usize,
    data: &[u8],
    (color, bits): (ColorType, BitDepth),
) -> Result<Vec<u8>, Malformed> {
    let fault = |problem: String| {
        Malformed::new(
            "image to write",
            problem,
            "give an image with as many pixels as its size says",
        )
    };
    if width.checked_mul(height) != Some(pixel_count) || pixel_count == 0 {
        return Err(fault(format!(
            "{pixel_count} pixels for a size of {width}x{height}"
        )));
    }
    let (Ok(wide), Ok(high)) = (u32::try_from(width), u32::try_from(height)) else {
        return Err(fault(format!("{width}x{height} is too large for a PNG")));
    };
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, wide, high);
    encoder.set_color(color);
    encoder.set_depth(bits);
    encoder
        .write_header()
        .and_then(|mut writer| {
            writer.write_image_data(data)?;
            writer.finish()
        })
        .map_err(|e| fault(e.to_string()))?;
    Ok(bytes)
}
