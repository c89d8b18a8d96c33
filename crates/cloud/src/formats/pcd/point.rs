//! One point of a PCD file of any layout, as `pcd-rs` reads and writes it.

use crate::formats::channels::ChannelKind;
use pcd_rs::{Error, FieldDef, PcdDeserialize, PcdSerialize, Result, Schema, ValueKind};
use std::io::{BufRead, Seek, Write};

/// Position and colour of a point; other fields are passed over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PcdPoint {
    pub(super) position: [f32; 3],
    /// As the file has it.
    pub(super) color: [f32; 3],
}

/// Where a field's colour goes: all of the colour, or one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channel {
    /// 0x00RRGGBB or 0xAARRGGBB in four bytes, whatever type the header gives them.
    Packed,
    Single(usize),
}

pub(super) fn color_channel(field: &FieldDef) -> Option<Channel> {
    if field.count != 1 {
        return None;
    }
    match (field.name.as_str(), field.kind) {
        ("rgb" | "rgba", ValueKind::F32 | ValueKind::U32 | ValueKind::I32) => Some(Channel::Packed),
        ("r" | "red", _) => Some(Channel::Single(0)),
        ("g" | "green", _) => Some(Channel::Single(1)),
        ("b" | "blue", _) => Some(Channel::Single(2)),
        _ => None,
    }
}

/// What the numbers of a point's colour are; `None` where it has none, or not all of it.
pub(super) fn color_kinds(fields: &[FieldDef]) -> Option<[ChannelKind; 3]> {
    let mut kinds = [None; 3];
    for field in fields {
        match color_channel(field) {
            Some(Channel::Packed) => return Some([ChannelKind::Byte; 3]),
            Some(Channel::Single(index)) => {
                kinds[index] = Some(match field.kind {
                    ValueKind::F32 | ValueKind::F64 => ChannelKind::Fraction,
                    ValueKind::U16 => ChannelKind::Wide,
                    _ => ChannelKind::Byte,
                });
            }
            None => {}
        }
    }
    let [red, green, blue] = kinds;
    Some([red?, green?, blue?])
}

impl PcdPoint {
    const NONE: Self = Self {
        position: [f32::NAN; 3],
        color: [0.0; 3],
    };

    /// Takes a number of field `field`; `bits` are the four bytes of a packed colour.
    fn set(&mut self, field: &FieldDef, value: f64, bits: u32) {
        match field.name.as_str() {
            "x" => self.position[0] = value as f32,
            "y" => self.position[1] = value as f32,
            "z" => self.position[2] = value as f32,
            _ => match color_channel(field) {
                Some(Channel::Packed) => {
                    let [_, r, g, b] = bits.to_be_bytes();
                    self.color = [r, g, b].map(f32::from);
                }
                Some(Channel::Single(channel)) => self.color[channel] = value as f32,
                None => {}
            },
        }
    }

    fn packed(&self) -> u32 {
        let [r, g, b] = self.color.map(|channel| channel as u8);
        u32::from_be_bytes([0, r, g, b])
    }
}

/// The value of `kind` at the start of `b`, and the first four bytes as they are.
fn decode(kind: ValueKind, b: [u8; 8]) -> (f64, u32) {
    let [b0, b1, b2, b3, ..] = b;
    let four = [b0, b1, b2, b3];
    let value = match kind {
        ValueKind::U8 => f64::from(b0),
        ValueKind::I8 => f64::from(b0 as i8),
        ValueKind::U16 => f64::from(u16::from_le_bytes([b0, b1])),
        ValueKind::I16 => f64::from(i16::from_le_bytes([b0, b1])),
        ValueKind::U32 => f64::from(u32::from_le_bytes(four)),
        ValueKind::I32 => f64::from(i32::from_le_bytes(four)),
        ValueKind::F32 => f64::from(f32::from_le_bytes(four)),
        ValueKind::U64 => u64::from_le_bytes(b) as f64,
        ValueKind::I64 => i64::from_le_bytes(b) as f64,
        ValueKind::F64 => f64::from_le_bytes(b),
    };
    (value, u32::from_le_bytes(four))
}

/// The bits of a packed colour in text: a whole number is the bits, anything else
/// a float of these bits.
fn packed_bits(token: &str) -> Option<u32> {
    let whole = token.parse::<u32>().ok();
    let signed = || token.parse::<i32>().ok().map(i32::cast_unsigned);
    whole
        .or_else(signed)
        .or_else(|| token.parse::<f32>().ok().map(f32::to_bits))
}

impl PcdDeserialize for PcdPoint {
    fn is_dynamic() -> bool {
        true
    }

    fn read_spec() -> Vec<(Option<String>, ValueKind, Option<usize>)> {
        Vec::new()
    }

    fn read_chunk<R: BufRead>(reader: &mut R, fields: &Schema) -> Result<Self> {
        let mut record = Self::NONE;
        for field in fields {
            for _ in 0..field.count {
                let mut bytes = [0; 8];
                reader.read_exact(&mut bytes[..field.kind.byte_size()])?;
                let (value, bits) = decode(field.kind, bytes);
                record.set(field, value, bits);
            }
        }
        Ok(record)
    }

    fn read_line<R: BufRead>(reader: &mut R, fields: &Schema) -> Result<Self> {
        let mut line = Vec::new();
        // Blank lines stand in no point's place.
        while line.trim_ascii().is_empty() {
            line.clear();
            if reader.read_until(b'\n', &mut line)? == 0 {
                return Err(std::io::Error::from(std::io::ErrorKind::UnexpectedEof).into());
            }
        }
        let line = String::from_utf8_lossy(&line);
        let mut tokens = line.split_ascii_whitespace();
        let mut record = Self::NONE;
        for field in fields {
            for _ in 0..field.count {
                let found = tokens.next();
                let token = found.ok_or_else(|| bad_value(field, "the line ends before it"))?;
                let is_packed = color_channel(field) == Some(Channel::Packed);
                let bits = if is_packed {
                    packed_bits(token)
                } else {
                    Some(0)
                };
                let value = if is_packed {
                    Some(0.0)
                } else {
                    token.parse().ok()
                };
                let (Some(value), Some(bits)) = (value, bits) else {
                    return Err(bad_value(field, &format!("`{token}` is not a number")));
                };
                record.set(field, value, bits);
            }
        }
        Ok(record)
    }
}

fn bad_value(field: &FieldDef, problem: &str) -> Error {
    Error::InvalidArgumentError {
        desc: format!("field `{}`: {problem}", field.name),
    }
}

impl PcdSerialize for PcdPoint {
    fn is_dynamic() -> bool {
        true
    }

    fn write_spec() -> Schema {
        Schema { fields: Vec::new() }
    }

    fn write_chunk<W: Write + Seek>(&self, writer: &mut W, fields: &Schema) -> Result<()> {
        for value in self.position {
            writer.write_all(&value.to_le_bytes())?;
        }
        if fields.len() > 3 {
            writer.write_all(&self.packed().to_le_bytes())?;
        }
        Ok(())
    }

    fn write_line<W: Write + Seek>(&self, writer: &mut W, fields: &Schema) -> Result<()> {
        let mut separator = "";
        for value in self.position {
            // PCL writes and expects `nan` so.
            if value.is_nan() {
                write!(writer, "{separator}nan")?;
            } else {
                write!(writer, "{separator}{value}")?;
            }
            separator = " ";
        }
        if fields.len() > 3 {
            write!(writer, " {}", self.packed())?;
        }
        writeln!(writer)?;
        Ok(())
    }
}
