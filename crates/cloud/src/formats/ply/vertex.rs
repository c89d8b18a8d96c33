//! One vertex of a PLY file of any layout.

use ply_rs_bw::ply::{
    ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType,
    ScalarType,
};

/// Position and colour of a vertex; other properties are passed over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) position: [f32; 3],
    pub(super) color: [u8; 3],
}

/// Where a property goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    Axis(usize),
    Color(usize),
}

impl Slot {
    pub(super) fn of(property: &PropertyDef) -> Option<Self> {
        match property.data_type {
            PropertyType::Scalar(_) => Self::named(&property.name),
            PropertyType::List(..) => None,
        }
    }

    fn named(name: &str) -> Option<Self> {
        match name {
            "x" => Some(Self::Axis(0)),
            "y" => Some(Self::Axis(1)),
            "z" => Some(Self::Axis(2)),
            "red" | "r" | "diffuse_red" => Some(Self::Color(0)),
            "green" | "g" | "diffuse_green" => Some(Self::Color(1)),
            "blue" | "b" | "diffuse_blue" => Some(Self::Color(2)),
            _ => None,
        }
    }
}

/// A colour channel as a byte: fractions are of one, 16-bit values of 65535.
fn channel(value: f64, kind: &ScalarType) -> u8 {
    match kind {
        ScalarType::Float | ScalarType::Double => (value * 255.0).round() as u8,
        ScalarType::UShort => (value / 257.0).round() as u8,
        _ => value as u8,
    }
}

impl Vertex {
    fn set(&mut self, slot: Slot, value: f64, kind: &ScalarType) {
        match slot {
            Slot::Axis(axis) => self.position[axis] = value as f32,
            Slot::Color(index) => self.color[index] = channel(value, kind),
        }
    }

    /// The element on a line of text; tokens beyond it are left alone.
    pub(super) fn from_text(line: &str, element: &ElementDef) -> Result<Self, String> {
        let mut tokens = line.split_ascii_whitespace();
        let mut vertex = Self::new();
        for property in element.properties.values() {
            let name = &property.name;
            let mut next = || {
                let token = tokens
                    .next()
                    .ok_or_else(|| format!("ends before property `{name}`"))?;
                let value = token.parse::<f64>();
                value.map_err(|_| format!("property `{name}` is `{token}`, not a number"))
            };
            let value = next()?;
            match (&property.data_type, Slot::of(property)) {
                (PropertyType::Scalar(kind), Some(slot)) => vertex.set(slot, value, kind),
                (PropertyType::Scalar(_), None) => {}
                // Never more than the line has tokens for.
                (PropertyType::List(..), _) => {
                    for _ in 0..value as u64 {
                        next()?;
                    }
                }
            }
        }
        Ok(vertex)
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: [f32::NAN; 3],
            color: [0; 3],
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let (value, kind) = match property {
            Property::Char(value) => (f64::from(value), ScalarType::Char),
            Property::UChar(value) => (f64::from(value), ScalarType::UChar),
            Property::Short(value) => (f64::from(value), ScalarType::Short),
            Property::UShort(value) => (f64::from(value), ScalarType::UShort),
            Property::Int(value) => (f64::from(value), ScalarType::Int),
            Property::UInt(value) => (f64::from(value), ScalarType::UInt),
            Property::Float(value) => (f64::from(value), ScalarType::Float),
            Property::Double(value) => (value, ScalarType::Double),
            _ => return PropertyAccessResult::Ignored,
        };
        let Some(slot) = Slot::named(name) else {
            return PropertyAccessResult::Ignored;
        };
        self.set(slot, value, &kind);
        PropertyAccessResult::Set
    }

    fn get_float(&self, name: &str) -> Option<f32> {
        match Slot::named(name)? {
            Slot::Axis(axis) => Some(self.position[axis]),
            Slot::Color(_) => None,
        }
    }

    fn get_uchar(&self, name: &str) -> Option<u8> {
        match Slot::named(name)? {
            Slot::Color(index) => Some(self.color[index]),
            Slot::Axis(_) => None,
        }
    }
}
