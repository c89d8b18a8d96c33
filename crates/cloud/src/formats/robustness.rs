//! Damaged files give an error or a cloud, never a panic and never more points than bytes.

use super::*;

/// A repeatable stream of numbers (`SplitMix64`; Steele, Lea, Flood 2014, doi 10.1145/2660193.2660195).
struct Draws(u64);

impl Draws {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }
}

fn sample() -> PointCloud {
    let numbers = |step: f32| {
        (0..24)
            .map(|i| if i == 5 { f32::NAN } else { i as f32 * step })
            .collect()
    };
    PointCloud {
        x: numbers(0.01),
        y: numbers(-0.5),
        z: numbers(0.0),
        colors: Some((0..24).map(|i| [i, 2 * i, 255 - i]).collect()),
        size: Some((6, 4)),
    }
}

/// Parses and checks that a cloud, if one comes out, is whole and no larger than the file allows.
fn survives(bytes: &[u8], format: CloudFormat) -> bool {
    match parse(bytes, Some(format)) {
        Ok(cloud) => {
            assert_eq!(cloud.inconsistency(), None, "{format:?}");
            // A point of compressed zeros takes least: 12 bytes of 88 packed in one.
            assert!(
                cloud.len() <= 8 * bytes.len() && cloud.x.capacity() <= 16 * bytes.len().max(64)
            );
            true
        }
        Err(fault) => {
            assert!(
                !fault.place.is_empty() && !fault.problem.is_empty() && !fault.remedy.is_empty()
            );
            false
        }
    }
}

#[test]
fn files_cut_at_every_length() {
    for format in CloudFormat::ALL {
        let whole = format_as(&sample(), format).unwrap();
        assert!(survives(&whole, format));
        for length in 0..whole.len() {
            let read = survives(&whole[..length], format);
            let binary = !matches!(
                format,
                CloudFormat::PcdAscii | CloudFormat::PlyAscii | CloudFormat::Xyz
            );
            assert!(
                !(read && binary),
                "{format:?} cut at {length} of {}",
                whole.len()
            );
        }
    }
}

#[test]
fn files_with_changed_bytes() {
    let mut draws = Draws(7);
    for format in CloudFormat::ALL {
        let whole = format_as(&sample(), format).unwrap();
        for _ in 0..4000 {
            let mut bytes = whole.clone();
            for _ in 0..=draws.below(4) {
                let at = draws.below(bytes.len());
                match draws.below(4) {
                    0 => bytes[at] ^= 1 << draws.below(8),
                    1 => bytes[at] = b"0123456789 \n-.e#"[draws.below(16)],
                    2 => bytes.insert(at, b'0' + draws.below(10) as u8),
                    _ => {
                        bytes.remove(at);
                    }
                }
            }
            survives(&bytes, format);
        }
    }
}

#[test]
fn noise_behind_a_true_header() {
    let mut draws = Draws(11);
    for format in CloudFormat::ALL {
        let whole = format_as(&sample(), format).unwrap();
        for _ in 0..500 {
            let kept = draws.below(whole.len());
            let mut bytes = whole[..kept].to_vec();
            bytes.extend((0..draws.below(600)).map(|_| draws.below(256) as u8));
            survives(&bytes, format);
        }
    }
}
