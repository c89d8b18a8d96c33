//! One vertex of a PLY file of any layout.

use crate::formats::channels::ChannelKind;
use ply_rs_bw::ply::{
    ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType,
    ScalarType,
};

/// Position and colour of a vertex; other properties are passed over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) position: [f32; 3],
    /// As the file has it.
    pub(super) color: [f32; 3],
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

/// What the numbers of a vertex's colour are; `None` where it has none, or not all of it.
pub(super) fn color_kinds(element: &ElementDef) -> Option<[ChannelKind; 3]> {
    let mut kinds = [None; 3];
    for property in element.properties.values() {
        if let (Some(Slot::Color(index)), PropertyType::Scalar(kind)) =
            (Slot::of(property), &property.data_type)
        {
            kinds[index] = Some(match kind {
                ScalarType::Float | ScalarType::Double => ChannelKind::Fraction,
                ScalarType::UShort => ChannelKind::Wide,
                _ => ChannelKind::Byte,
            });
        }
    }
    let [red, green, blue] = kinds;
    Some([red?, green?, blue?])
}

impl Vertex {
    fn set(&mut self, slot: Slot, value: f64) {
        match slot {
            Slot::Axis(axis) => self.position[axis] = value as f32,
            Slot::Color(index) => self.color[index] = value as f32,
        }
    }

    /// The element whose numbers `next` gives, by the names of their properties.
    pub(super) fn from_numbers<E>(
        element: &ElementDef,
        next: &mut impl FnMut(&str) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let mut vertex = Self::new();
        for property in element.properties.values() {
            let value = next(&property.name)?;
            match (&property.data_type, Slot::of(property)) {
                (PropertyType::Scalar(_), Some(slot)) => vertex.set(slot, value),
                (PropertyType::Scalar(_), None) => {}
                // Never more than the text has.
                (PropertyType::List(..), _) => {
                    for _ in 0..value as u64 {
                        next(&property.name)?;
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
            color: [0.0; 3],
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let value = match property {
            Property::Char(value) => f64::from(value),
            Property::UChar(value) => f64::from(value),
            Property::Short(value) => f64::from(value),
            Property::UShort(value) => f64::from(value),
            Property::Int(value) => f64::from(value),
            Property::UInt(value) => f64::from(value),
            Property::Float(value) => f64::from(value),
            Property::Double(value) => value,
            _ => return PropertyAccessResult::Ignored,
        };
        let Some(slot) = Slot::named(name) else {
            return PropertyAccessResult::Ignored;
        };
        self.set(slot, value);
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
            Slot::Color(index) => Some(self.color[index] as u8),
            Slot::Axis(_) => None,
        }
    }
}
