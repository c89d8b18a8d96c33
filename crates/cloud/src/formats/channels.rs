//! Colour channels of clouds, which programs write as bytes, as 16-bit numbers and as fractions.

/// What the numbers of a channel are, by their type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ChannelKind {
    /// 0 to 255.
    #[default]
    Byte,
    /// 16 bits: 0 to 65535; some programs write 0 to 255 in them.
    Wide,
    /// Floating point: 0 to 1; some programs write 0 to 255 in them.
    Fraction,
}

/// Largest byte.
const BYTE: f32 = 255.0;

/// What a 16-bit number is divided by, so that the largest becomes the largest byte.
const WIDE_TO_BYTE: f32 = 257.0;

/// Fractions may exceed 1 by this: interpolated and compressed colours do.
const ABOVE_ONE: f32 = 1.05;

/// The colours of a cloud as bytes. What the numbers of a kind are is told by the largest of all points.
pub(super) fn to_bytes(raw: &[[f32; 3]], kinds: [ChannelKind; 3]) -> Vec<[u8; 3]> {
    let largest = |kind: ChannelKind| {
        let of_kind = raw
            .iter()
            .flat_map(|color| color.iter().zip(kinds).filter(move |(_, k)| *k == kind));
        of_kind.fold(0.0_f32, |most, (value, _)| most.max(*value))
    };
    let fraction = if largest(ChannelKind::Fraction) > ABOVE_ONE {
        1.0
    } else {
        BYTE
    };
    let wide = if largest(ChannelKind::Wide) > BYTE {
        WIDE_TO_BYTE.recip()
    } else {
        1.0
    };
    let scale = kinds.map(|kind| match kind {
        ChannelKind::Byte => 1.0,
        ChannelKind::Wide => wide,
        ChannelKind::Fraction => fraction,
    });
    let byte = |color: &[f32; 3]| [0, 1, 2].map(|k| (color[k] * scale[k]).round() as u8);
    raw.iter().map(byte).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ChannelKind::{Byte, Fraction, Wide};

    #[test]
    fn the_largest_number_tells_what_a_channel_counts_in() {
        let bytes = |raw: &[[f32; 3]], kind| to_bytes(raw, [kind; 3]);
        assert_eq!(bytes(&[[255.0, 0.0, 7.0]], Byte), [[255, 0, 7]]);
        assert_eq!(bytes(&[[1.0, 0.0, 0.5]], Fraction), [[255, 0, 128]]);
        assert_eq!(
            bytes(&[[255.0, 0.0, 7.0], [1.0, 1.0, 1.0]], Fraction),
            [[255, 0, 7], [1, 1, 1]]
        );
        assert_eq!(bytes(&[[65535.0, 257.0, 0.0]], Wide), [[255, 1, 0]]);
        assert_eq!(bytes(&[[200.0, 257.0 - 2.0, 0.0]], Wide), [[200, 255, 0]]);
        assert_eq!(bytes(&[[f32::NAN, -3.0, 1.01]], Fraction), [[0, 0, 255]]);
        assert_eq!(
            to_bytes(&[[0.5, 9.0, 1.0]], [Fraction, Byte, Fraction]),
            [[128, 9, 255]]
        );
    }
}
