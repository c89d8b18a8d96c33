//! PLY, the Stanford polygon format, through `ply-rs-bw`.
//!
//! What `ply-rs-bw` does not do: a count is compared with the file's size; a property
//! named twice, of which it would keep one and so misread all that follows, is refused;
//! its grammar of text data knows no `nan`, `inf`, `.5` or `5.`, so text is read here; headers
//! with other than UTF-8 comments, blank lines or old Macintosh line ends are normalised first.
//!
//! PLY has no organised clouds: a comment `pomona organised WIDTH HEIGHT` keeps the size, and
//! the `obj_info num_cols` and `num_rows` of range scanners are read too, where they make up the points.

mod tokens;
mod vertex;

use super::channels::to_bytes;
use super::claim::check_claim;
use crate::PointCloud;
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    Addable, ElementDef, Encoding, Header, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;
use pomona_files::Malformed;
use tokens::Tokens;
use vertex::Vertex;

const DAMAGED: &str = "write the cloud again; this file is cut short or damaged";
const SCHEMA: &str =
    "give a PLY file with `element vertex` and its properties x, y, z and perhaps red, green, blue";
const ORGANISED: &str = "pomona organised";

pub(super) fn parse(bytes: &[u8]) -> Result<PointCloud, Malformed> {
    let (header, body, header_lines) = parse_header(bytes)?;
    let vertex = header
        .elements
        .get("vertex")
        .ok_or_else(|| Malformed::new("PLY header", "no `element vertex`", SCHEMA))?;
    for axis in ["x", "y", "z"] {
        let data_type = vertex
            .properties
            .get(axis)
            .map(|property| &property.data_type);
        if !matches!(data_type, Some(PropertyType::Scalar(_))) {
            let problem = format!("no property `{axis}` of one number");
            return Err(Malformed::new(
                "PLY header, element vertex",
                problem,
                SCHEMA,
            ));
        }
    }
    check_sizes(&header, body.len())?;

    let kinds = vertex::color_kinds(vertex);
    let mut raw = Vec::with_capacity(if kinds.is_some() { vertex.count } else { 0 });
    let mut cloud = PointCloud {
        x: Vec::with_capacity(vertex.count),
        y: Vec::with_capacity(vertex.count),
        z: Vec::with_capacity(vertex.count),
        colors: None,
        size: organised_size(&header, vertex.count),
    };
    let mut source = match header.encoding {
        Encoding::Ascii => Source::Text(Tokens::new(body, header_lines)),
        Encoding::BinaryLittleEndian => Source::LittleEndian(body),
        Encoding::BinaryBigEndian => Source::BigEndian(body),
    };
    for element in header.elements.values() {
        let is_vertex = element.name == "vertex";
        for index in 0..element.count {
            let read = source.next(element, index)?;
            if is_vertex {
                let [x, y, z] = read.position;
                cloud.x.push(x);
                cloud.y.push(y);
                cloud.z.push(z);
                if kinds.is_some() {
                    raw.push(read.color);
                }
            }
        }
        if is_vertex {
            break;
        }
    }
    cloud.colors = kinds.map(|kinds| to_bytes(&raw, kinds));
    Ok(cloud)
}

/// The header, the bytes behind it, and the number of its lines.
fn parse_header(bytes: &[u8]) -> Result<(Header, &[u8], usize), Malformed> {
    let mut lines = Tokens::new(bytes, 0);
    let mut plain = String::new();
    let (mut elements, mut properties) = (0, 0);
    loop {
        let Some(line) = lines.next_line() else {
            return Err(Malformed::new(
                "PLY header",
                "no `end_header` line",
                DAMAGED,
            ));
        };
        let text = header_line(&String::from_utf8_lossy(line));
        elements += usize::from(text.starts_with("element "));
        properties += usize::from(text.starts_with("property "));
        if !text.is_empty() {
            plain.push_str(&text);
            plain.push('\n');
        }
        if text == "end_header" {
            break;
        }
    }
    let header = Parser::<Vertex>::new()
        .read_header(&mut Reader::new(plain.as_bytes()))
        .map_err(|e| Malformed::new("PLY header", one_line(&e.to_string()), SCHEMA))?;
    let kept: usize = header
        .elements
        .values()
        .map(|element| element.properties.len())
        .sum();
    if header.elements.len() != elements || kept != properties {
        return Err(Malformed::new(
            "PLY header",
            "an element or a property is named twice",
            SCHEMA,
        ));
    }
    Ok((header, lines.rest, lines.line))
}

/// A line of the header as the grammar of `ply-rs-bw` has it: one space between words, and small letters but in
/// comments.
fn header_line(line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    if let Some((first, rest)) = words.split_first() {
        let first = first.to_ascii_lowercase();
        if first == "comment" || first == "obj_info" {
            return format!("{first} {}", rest.join(" "));
        }
    }
    words.join(" ").to_ascii_lowercase()
}

/// The messages of `ply-rs-bw` are several lines with tabs.
fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Refuses elements, up to the vertices, that need more than the `available` bytes.
fn check_sizes(header: &Header, available: usize) -> Result<(), Malformed> {
    for element in header.elements.values() {
        if element.properties.is_empty() && element.count > 0 {
            let problem = format!("element `{}` has no property", element.name);
            return Err(Malformed::new("PLY header", problem, SCHEMA));
        }
        let binary_size = |property: &PropertyDef| match &property.data_type {
            PropertyType::Scalar(kind) | PropertyType::List(kind, _) => scalar_size(kind),
        };
        let claim = element.count as u64;
        match header.encoding {
            // A digit and a separator for each value, which the last one may lack.
            Encoding::Ascii => {
                check_claim(claim, 2 * element.properties.len() as u64, available + 1)?;
            }
            _ => check_claim(
                claim,
                element.properties.values().map(binary_size).sum(),
                available,
            )?,
        }
        if element.name == "vertex" {
            break;
        }
    }
    Ok(())
}

fn scalar_size(kind: &ScalarType) -> u64 {
    match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

fn organised_size(header: &Header, count: usize) -> Option<(usize, usize)> {
    let ours = header.comments.iter().find_map(|comment| {
        let (width, height) = comment
            .trim()
            .strip_prefix(ORGANISED)?
            .trim()
            .split_once(' ')?;
        Some((
            width.parse::<usize>().ok()?,
            height.trim().parse::<usize>().ok()?,
        ))
    });
    let info = |name: &str| {
        let find = |line: &String| line.trim().strip_prefix(name)?.trim().parse::<usize>().ok();
        header.obj_infos.iter().find_map(find)
    };
    let size = ours.or_else(|| Some((info("num_cols")?, info("num_rows")?)))?;
    // Programs that remove points leave the comments as they were.
    (size.0.checked_mul(size.1) == Some(count)).then_some(size)
}

/// The data behind the header.
enum Source<'a> {
    Text(Tokens<'a>),
    LittleEndian(&'a [u8]),
    BigEndian(&'a [u8]),
}

impl Source<'_> {
    fn next(&mut self, element: &ElementDef, index: usize) -> Result<Vertex, Malformed> {
        let parser = Parser::<Vertex>::new();
        let read = match self {
            Self::Text(tokens) => return tokens.vertex(element, index),
            Self::LittleEndian(rest) => parser.read_little_endian_element(rest, element),
            Self::BigEndian(rest) => parser.read_big_endian_element(rest, element),
        };
        read.map_err(|e| {
            let place = format!("{} {} of {}", element.name, index + 1, element.count);
            Malformed::new(place, one_line(&e.to_string()), DAMAGED)
        })
    }
}

pub(super) fn format(cloud: &PointCloud, encoding: Encoding) -> Result<Vec<u8>, Malformed> {
    let mut element = ElementDef::new("vertex".to_owned());
    element.count = cloud.len();
    for axis in ["x", "y", "z"] {
        element.properties.add(scalar(axis, ScalarType::Float));
    }
    if cloud.colors.is_some() {
        for channel in ["red", "green", "blue"] {
            element.properties.add(scalar(channel, ScalarType::UChar));
        }
    }
    let mut header = Header::new();
    header.encoding = encoding;
    if let Some((width, height)) = cloud.size {
        header
            .comments
            .push(format!("{ORGANISED} {width} {height}"));
    }
    header.elements.add(element.clone());

    let writer = Writer::<Vertex>::new();
    let mut bytes = Vec::new();
    let mut written = writer.write_header(&mut bytes, &header);
    for i in 0..cloud.len() {
        let color = cloud
            .colors
            .as_ref()
            .map(|colors| colors[i])
            .unwrap_or_default();
        let vertex = Vertex {
            position: [cloud.x[i], cloud.y[i], cloud.z[i]],
            color: color.map(f32::from),
        };
        written = written.and_then(|_| match encoding {
            Encoding::Ascii => writer.write_ascii_element(&mut bytes, &vertex, &element),
            Encoding::BinaryLittleEndian => {
                writer.write_little_endian_element(&mut bytes, &vertex, &element)
            }
            Encoding::BinaryBigEndian => {
                writer.write_big_endian_element(&mut bytes, &vertex, &element)
            }
        });
    }
    written.map_err(|e| {
        Malformed::new(
            "cloud to write",
            e.to_string(),
            "write it in another format",
        )
    })?;
    Ok(bytes)
}

fn scalar(name: &str, kind: ScalarType) -> PropertyDef {
    PropertyDef::new(name.to_owned(), PropertyType::Scalar(kind))
}

#[cfg(test)]
mod tests;
