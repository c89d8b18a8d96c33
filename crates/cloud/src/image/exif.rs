//! How a picture's EXIF data turn it: viewers and labelling tools show it turned, while its pixels and the depth image's
//! lie as the camera stored them.

use super::{jpeg, png};
use crate::{CloudError, ColorImage};
use pomona_files::{Warning, WarningCode};
use std::path::Path;

/// The tag of the orientation (Exif 2.3, section 4.6.4, A).
const ORIENTATION: u16 = 0x0112;

/// Bytes of an entry in a directory of tags.
const ENTRY: usize = 12;

impl ColorImage {
    /// What is to be said of a picture that viewers show turned, while it is read as stored; nothing for others.
    ///
    /// # Errors
    ///
    /// As [`ColorImage::read_size`].
    pub fn turned_by_exif(path: impl AsRef<Path>) -> Result<Option<Warning>, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let exif = if png::is(&bytes) {
            png::exif(&bytes)
        } else if jpeg::is(&bytes) {
            jpeg::exif(&bytes)
        } else {
            Ok(None)
        };
        let exif = exif.map_err(|fault| fault.at(path))?;
        let how = exif.as_deref().and_then(orientation).and_then(turn);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(how.map(|how| {
            Warning::new(
                WarningCode::ImageTurned,
                format!(
                    "{name}: viewers {how}, as its EXIF data say; it is read as stored, like its depth. Boxes drawn in \
                     a viewer that turns it do not fit: save the picture turned, with its depth, or draw them anew"
                ),
            )
        }))
    }
}

/// What an orientation other than the first does.
fn turn(orientation: u16) -> Option<&'static str> {
    match orientation {
        2 => Some("mirror it"),
        3 => Some("turn it by 180 degrees"),
        4 => Some("turn it by 180 degrees and mirror it"),
        5 => Some("turn it by 90 degrees to the right and mirror it"),
        6 => Some("turn it by 90 degrees to the right"),
        7 => Some("turn it by 90 degrees to the left and mirror it"),
        8 => Some("turn it by 90 degrees to the left"),
        _ => None,
    }
}

/// The orientation in EXIF data, which are those of a TIFF file; `None` where they state none or are damaged.
fn orientation(exif: &[u8]) -> Option<u16> {
    let exif = exif.strip_prefix(b"Exif\0\0").unwrap_or(exif);
    let is_big = match exif.first_chunk::<4>()? {
        b"II*\0" => false,
        b"MM\0*" => true,
        _ => return None,
    };
    let short = |at: usize| -> Option<u16> {
        let bytes = *exif.get(at..)?.first_chunk::<2>()?;
        Some(if is_big {
            u16::from_be_bytes(bytes)
        } else {
            u16::from_le_bytes(bytes)
        })
    };
    let long = |at: usize| -> Option<usize> {
        let bytes = *exif.get(at..)?.first_chunk::<4>()?;
        let value = if is_big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        };
        usize::try_from(value).ok()
    };
    let directory = long(4)?;
    let first = directory.checked_add(2)?;
    (0..usize::from(short(directory)?)).find_map(|index| {
        let entry = first.checked_add(index * ENTRY)?;
        (short(entry)? == ORIENTATION).then(|| short(entry + 8))?
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// EXIF data with two tags, the second the orientation.
    fn exif(value: u16, is_big: bool) -> Vec<u8> {
        let short = |x: u16| {
            if is_big {
                x.to_be_bytes()
            } else {
                x.to_le_bytes()
            }
        };
        let long = |x: u32| {
            if is_big {
                x.to_be_bytes()
            } else {
                x.to_le_bytes()
            }
        };
        let mut bytes = if is_big {
            b"MM\0*".to_vec()
        } else {
            b"II*\0".to_vec()
        };
        bytes.extend(long(8));
        bytes.extend(short(2));
        for (tag, value) in [(0x0100, 9), (ORIENTATION, value)] {
            bytes.extend([short(tag), short(3)].concat());
            bytes.extend(long(1));
            bytes.extend([short(value), short(0)].concat());
        }
        bytes
    }

    #[test]
    fn the_orientation_is_found_in_both_orders_of_bytes() {
        for is_big in [false, true] {
            for value in 1..=8 {
                assert_eq!(orientation(&exif(value, is_big)), Some(value));
            }
        }
        assert_eq!(
            orientation(&[b"Exif\0\0", &exif(6, true)[..]].concat()),
            Some(6)
        );
        assert_eq!((turn(1), turn(6).is_some(), turn(9)), (None, true, None));
    }

    #[test]
    fn damaged_data_state_nothing() {
        let whole = exif(6, false);
        for length in 0..whole.len() - 4 {
            assert_eq!(orientation(&whole[..length]), None, "{length}");
        }
        assert_eq!(orientation(b"II*\0\xff\xff\xff\xff"), None);
    }

    #[test]
    fn a_png_that_is_turned_is_warned_of() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("color.png");
        ColorImage::filled(4, 3, [9; 3]).write(&path).unwrap();
        assert_eq!(ColorImage::turned_by_exif(&path).unwrap(), None);
        let mut file = std::fs::File::create(&path).unwrap();
        let mut info = ::png::Info::with_size(4, 3);
        info.color_type = ::png::ColorType::Rgb;
        info.bit_depth = ::png::BitDepth::Eight;
        info.exif_metadata = Some(exif(6, true).into());
        let encoder = ::png::Encoder::with_info(&mut file, info).unwrap();
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[9; 36]).unwrap();
        writer.finish().unwrap();
        let warning = ColorImage::turned_by_exif(&path).unwrap().unwrap();
        assert_eq!(warning.code, WarningCode::ImageTurned);
        assert!(
            warning
                .message
                .starts_with("color.png: viewers turn it by 90"),
            "{warning}"
        );
        assert_eq!(ColorImage::read(&path).unwrap().width, 4);
    }
}
