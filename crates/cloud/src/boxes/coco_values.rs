//! Values of COCO files as programs write them: ids as numbers or texts, sizes with a fraction, flags as words.

use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// How a COCO file identifies an image, a class or a box.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum ImageKey {
    /// A number; also one written as a text or with a fraction of zero.
    Number(u64),
    /// A text; some programs put the file's name without its ending here.
    Name(String),
}

impl Default for ImageKey {
    fn default() -> Self {
        Self::Number(0)
    }
}

impl From<u64> for ImageKey {
    fn from(number: u64) -> Self {
        Self::Number(number)
    }
}

impl fmt::Display for ImageKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl Serialize for ImageKey {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => serializer.serialize_u64(*number),
            Self::Name(name) => serializer.serialize_str(name),
        }
    }
}

impl<'de> Deserialize<'de> for ImageKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Key;
        impl Visitor<'_> for Key {
            type Value = ImageKey;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an id: a number or a text")
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<ImageKey, E> {
                Ok(ImageKey::Number(number))
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<ImageKey, E> {
                // An id below zero identifies as well as any other.
                Ok(ImageKey::Name(number.to_string()))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<ImageKey, E> {
                exact(number)
                    .map(ImageKey::Number)
                    .ok_or_else(|| E::invalid_value(Unexpected::Float(number), &self))
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<ImageKey, E> {
                // `007` may be the name of a file.
                let number = text
                    .parse::<u64>()
                    .ok()
                    .filter(|number| number.to_string() == text);
                Ok(number.map_or_else(|| ImageKey::Name(text.to_owned()), ImageKey::Number))
            }
        }
        deserializer.deserialize_any(Key)
    }
}

/// A whole number that is not negative.
fn exact(number: f64) -> Option<u64> {
    // Beyond 2^53 neighbouring whole numbers are one.
    let is_whole = number.fract() == 0.0 && (0.0..=9_007_199_254_740_992.0).contains(&number);
    is_whole.then_some(number as u64)
}

/// A whole number of pixels, which some tools write with a fraction of zero; 0 for `null`.
pub(super) fn whole<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let Some(number) = Option::<f64>::deserialize(deserializer)? else {
        return Ok(0);
    };
    let whole = exact(number).and_then(|number| u32::try_from(number).ok());
    whole.ok_or_else(|| {
        D::Error::invalid_value(Unexpected::Float(number), &"a whole number of pixels")
    })
}

/// 0 or 1, which some tools write as `false` or `true`.
pub(super) fn flag<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    struct Flag;
    impl Visitor<'_> for Flag {
        type Value = u8;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("0 or 1")
        }

        fn visit_bool<E: Error>(self, word: bool) -> Result<u8, E> {
            Ok(u8::from(word))
        }

        fn visit_u64<E: Error>(self, number: u64) -> Result<u8, E> {
            Ok(u8::from(number != 0))
        }

        fn visit_f64<E: Error>(self, number: f64) -> Result<u8, E> {
            Ok(u8::from(number != 0.0))
        }

        fn visit_unit<E: Error>(self) -> Result<u8, E> {
            Ok(0)
        }
    }
    deserializer.deserialize_any(Flag)
}

/// x, y, width and height; nothing where they are missing, `null` or an empty list.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounds(pub(super) Option<[f64; 4]>);

impl Serialize for Bounds {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Bounds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Four;
        impl<'de> Visitor<'de> for Four {
            type Value = Bounds;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("`bbox` as four numbers: x, y, width, height")
            }

            fn visit_unit<E: Error>(self) -> Result<Bounds, E> {
                Ok(Bounds(None))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Bounds, A::Error> {
                let mut four = [0.0; 4];
                let mut count = 0;
                while let Some(number) = list.next_element::<f64>()? {
                    if let Some(place) = four.get_mut(count) {
                        *place = number;
                    }
                    count += 1;
                }
                match count {
                    0 => Ok(Bounds(None)),
                    4 => Ok(Bounds(Some(four))),
                    _ => Err(A::Error::invalid_length(count, &self)),
                }
            }
        }
        deserializer.deserialize_any(Four)
    }
}

/// The bounds of polygons, as left, top, right and bottom edge; nothing where there are none, or another form of mask.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Polygons(pub(super) Option<[f64; 4]>);

impl Polygons {
    fn include(&mut self, corner: [f64; 2]) {
        let [x, y] = corner;
        let [x0, y0, x1, y1] = self.0.unwrap_or([x, y, x, y]);
        self.0 = Some([x0.min(x), y0.min(y), x1.max(x), y1.max(y)]);
    }
}

impl<'de> Deserialize<'de> for Polygons {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Corners;
        impl<'de> Visitor<'de> for Corners {
            type Value = Polygons;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("polygons, each a list of x and y in turn")
            }

            fn visit_unit<E: Error>(self) -> Result<Polygons, E> {
                Ok(Polygons(None))
            }

            fn visit_str<E: Error>(self, _: &str) -> Result<Polygons, E> {
                Ok(Polygons(None))
            }

            fn visit_map<A: MapAccess<'de>>(self, mut mask: A) -> Result<Polygons, A::Error> {
                while mask.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
                Ok(Polygons(None))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Polygons, A::Error> {
                let mut bounds = Polygons(None);
                while let Some(polygon) = list.next_element::<Vec<f64>>()? {
                    for corner in polygon.chunks_exact(2) {
                        bounds.include([corner[0], corner[1]]);
                    }
                }
                Ok(bounds)
            }
        }
        deserializer.deserialize_any(Corners)
    }
}
