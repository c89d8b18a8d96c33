use super::claim::check_claim;
use super::color::{parse_color, parse_size};
use super::*;
use crate::ColorImage;
use crate::DepthImage;
use ::png::{BitDepth, ColorType, Encoder};

/// 24x16 pixels, (200, 30, 40) left of column 12 and (20, 160, 60) right of it.
const BASELINE: &[u8] = include_bytes!("../../tests/data/two_colors_baseline.jpg");
const PROGRESSIVE: &[u8] = include_bytes!("../../tests/data/two_colors_progressive.jpg");

fn encoded(color: ColorType, bits: BitDepth, palette: Option<&[u8]>, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(color);
    encoder.set_depth(bits);
    if let Some(palette) = palette {
        encoder.set_palette(palette);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    bytes
}

fn color_image() -> ColorImage {
    let pixels = (0..35).map(|i| [i, 7 * i, 255 - i]).collect();
    ColorImage {
        width: 7,
        height: 5,
        pixels,
    }
}

fn depth_image() -> DepthImage {
    let readings = (0..35).map(|i| i * 1871).collect();
    DepthImage {
        width: 7,
        height: 5,
        readings,
    }
}

#[test]
fn png_reads_back_what_it_wrote() {
    let (color, depth) = (color_image(), depth_image());
    assert_eq!(
        parse_color(&png::format_color(&color).unwrap()).unwrap(),
        color
    );
    assert_eq!(
        png::parse_depth(&png::format_depth(&depth).unwrap()).unwrap(),
        depth
    );
}

#[test]
fn every_kind_of_png_becomes_rgb() {
    let palette: &[u8] = &[1, 2, 3, 200, 100, 50];
    for (color, bits, palette, data, expected) in [
        (
            ColorType::Rgb,
            BitDepth::Eight,
            None,
            &[1, 2, 3, 200, 100, 50][..],
            [[1, 2, 3], [200, 100, 50]],
        ),
        (
            ColorType::Rgba,
            BitDepth::Eight,
            None,
            &[1, 2, 3, 0, 200, 100, 50, 9],
            [[1, 2, 3], [200, 100, 50]],
        ),
        (
            ColorType::Grayscale,
            BitDepth::Eight,
            None,
            &[9, 250],
            [[9; 3], [250; 3]],
        ),
        (
            ColorType::Grayscale,
            BitDepth::One,
            None,
            &[0b0100_0000],
            [[0; 3], [255; 3]],
        ),
        (
            ColorType::GrayscaleAlpha,
            BitDepth::Eight,
            None,
            &[9, 0, 250, 1],
            [[9; 3], [250; 3]],
        ),
        (
            ColorType::Grayscale,
            BitDepth::Sixteen,
            None,
            &[9, 99, 250, 1],
            [[9; 3], [250; 3]],
        ),
        (
            ColorType::Indexed,
            BitDepth::Eight,
            Some(palette),
            &[0, 1],
            [[1, 2, 3], [200, 100, 50]],
        ),
        (
            ColorType::Indexed,
            BitDepth::One,
            Some(palette),
            &[0b0100_0000],
            [[1, 2, 3], [200, 100, 50]],
        ),
    ] {
        let image = parse_color(&encoded(color, bits, palette, data)).unwrap();
        assert_eq!((image.width, image.height), (2, 1));
        assert_eq!(image.pixels, expected, "{color:?} {bits:?}");
    }
}

#[test]
fn depth_that_is_not_16_bit_grey_is_refused_with_the_remedy() {
    for (color, bits, data) in [
        (ColorType::Grayscale, BitDepth::Eight, &[1, 2][..]),
        (ColorType::Rgb, BitDepth::Eight, &[1; 6]),
        (ColorType::Rgb, BitDepth::Sixteen, &[1; 12]),
    ] {
        let fault = png::parse_depth(&encoded(color, bits, None, data)).unwrap_err();
        assert!(fault.remedy.contains("16-bit grey PNG"), "{fault:?}");
    }
    let eight = encoded(ColorType::Grayscale, BitDepth::Eight, None, &[1, 2]);
    assert!(
        png::parse_depth(&eight)
            .unwrap_err()
            .problem
            .contains("8-bit")
    );
}

#[test]
fn jpeg_is_read_baseline_and_progressive() {
    for bytes in [BASELINE, PROGRESSIVE] {
        let image = parse_color(bytes).unwrap();
        assert_eq!((image.width, image.height), (24, 16));
        for (u, expected) in [(3, [200, 30, 40]), (20, [20, 160, 60])] {
            let pixel = image.get(u, 8).unwrap();
            assert!(
                pixel.iter().zip(expected).all(|(&a, b)| a.abs_diff(b) <= 4),
                "{pixel:?}"
            );
        }
    }
}

#[test]
fn images_cut_at_every_length_are_refused() {
    let (color, depth) = (
        png::format_color(&color_image()).unwrap(),
        png::format_depth(&depth_image()).unwrap(),
    );
    for length in 0..color.len() {
        assert!(
            parse_color(&color[..length]).is_err(),
            "colour cut at {length} of {}",
            color.len()
        );
    }
    for length in 0..depth.len() {
        assert!(
            png::parse_depth(&depth[..length]).is_err(),
            "depth cut at {length}"
        );
    }
    for whole in [BASELINE, PROGRESSIVE] {
        for length in 0..whole.len() {
            assert!(
                parse_color(&whole[..length]).is_err(),
                "JPEG cut at {length} of {}",
                whole.len()
            );
        }
    }
}

#[test]
fn images_with_changed_bytes_are_an_image_or_an_error() {
    let color = png::format_color(&color_image()).unwrap();
    let depth = png::format_depth(&depth_image()).unwrap();
    for whole in [&color[..], &depth, BASELINE, PROGRESSIVE] {
        for at in 0..whole.len() {
            for change in [1, 0x10, 0x80, 0xff] {
                let mut bytes = whole.to_vec();
                bytes[at] ^= change;
                if let Ok(image) = parse_color(&bytes) {
                    assert_eq!(image.pixels.len(), image.width * image.height);
                }
                if let Ok(image) = png::parse_depth(&bytes) {
                    assert_eq!(image.readings.len(), image.width * image.height);
                }
            }
        }
    }
}

#[test]
fn a_small_file_cannot_claim_a_huge_picture() {
    // IHDR of a 2^31 - 1 square image, with its checksum.
    let mut bytes =
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x10\0\0\0\0".to_vec();
    bytes.extend(0xa4ed_c34f_u32.to_be_bytes());
    assert!(parse_color(&bytes).is_err() && png::parse_depth(&bytes).is_err());
    assert!(
        check_claim(1 << 31, 1 << 31, &bytes, 8 * 1032)
            .unwrap_err()
            .problem
            .contains("2147483648")
    );
    assert!(check_claim(0, 5, &bytes, 1).is_err());
    assert!(check_claim(usize::MAX, 2, &bytes, 1).is_err());
}

#[test]
fn images_of_the_wrong_number_of_pixels_are_not_written() {
    let short = ColorImage {
        height: 6,
        ..color_image()
    };
    assert!(
        png::format_color(&short)
            .unwrap_err()
            .problem
            .contains("35 pixels")
    );
    let empty = DepthImage {
        width: 0,
        height: 0,
        readings: vec![],
    };
    assert!(png::format_depth(&empty).is_err());
    assert!(parse_color(b"GIF89a").is_err());
}

#[test]
fn the_size_is_read_from_the_header_alone() {
    let png = png::format_color(&color_image()).unwrap();
    assert_eq!(parse_size(&png), Ok((7, 5)));
    assert_eq!(parse_size(BASELINE), Ok((24, 16)));
    assert_eq!(parse_size(PROGRESSIVE), Ok((24, 16)));
    assert!(parse_size(&png[..20]).is_err() && parse_size(b"GIF89a").is_err());
}
