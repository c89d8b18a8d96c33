//! URDF's `<origin xyz rpy>`.

use super::checked::{checked, number, shown};
use super::error::FormatError;
use super::static_transform::with_angles;
use crate::{EulerZyx, FrameTag, NamedTransform};
use roxmltree::{Document, Node};

const REMEDY: &str = "give one `<origin xyz=\"x y z\" rpy=\"roll pitch yaw\"/>` in metres and radians, alone or in a `<joint>` with `<parent link>` and `<child link>`";

/// `<origin xyz="…" rpy="…"/>`: where the source's frame is in the destination's, metres and radians; roll,
/// pitch, yaw are rx, ry, rz of [`EulerZyx`], about fixed axes.
pub fn to_urdf_origin<To: FrameTag, From: FrameTag>(named: &NamedTransform<To, From>) -> String {
    let t: [f64; 3] = named.transform.translation_m().into();
    let EulerZyx { rx, ry, rz } = EulerZyx::from_rotation(&named.transform.rotation());
    let list = |n: [f64; 3]| n.map(shown).join(" ");
    format!(
        "<origin xyz=\"{}\" rpy=\"{}\"/>",
        list(t),
        list([rx, ry, rz])
    )
}

/// A fixed joint with that origin: the destination is the parent link, the source the child link.
pub fn to_urdf_joint<To: FrameTag, From: FrameTag>(
    named: &NamedTransform<To, From>,
    name: &str,
) -> String {
    format!(
        "<joint name=\"{}\" type=\"fixed\">\n  <parent link=\"{}\"/>\n  <child link=\"{}\"/>\n  {}\n</joint>\n",
        escaped(name),
        escaped(&named.to),
        escaped(&named.from),
        to_urdf_origin(named)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

/// The transform of the one `<origin>` in the text. In a `<joint>` the frames are named by its links;
/// elsewhere, and where these are absent, `to` and `from` name them. Attributes that are absent are zeros,
/// as URDF has it.
///
/// # Errors
///
/// [`FormatError`] for what is no XML, for no origin or several, and for what are not three numbers each.
pub fn from_urdf_origin<To: FrameTag, From: FrameTag>(
    text: &str,
    to: &str,
    from: &str,
) -> Result<NamedTransform<To, From>, FormatError> {
    let document = Document::parse(text)
        .map_err(|e| FormatError::new(format!("line {}", e.pos().row), e, REMEDY))?;
    let mut origins = document.descendants().filter(|n| n.has_tag_name("origin"));
    let (Some(origin), None) = (origins.next(), origins.next()) else {
        let problem = "there is no <origin>, or more than one";
        return Err(FormatError::new("URDF", problem, REMEDY));
    };
    let xyz = numbers(&document, origin, "xyz")?;
    let [rx, ry, rz] = numbers(&document, origin, "rpy")?;
    let joint = origin.parent().filter(|p| p.has_tag_name("joint"));
    let link = |tag: &str| {
        let element = joint?.children().find(|c| c.has_tag_name(tag))?;
        element.attribute("link").map(str::to_owned)
    };
    let to = link("parent").unwrap_or_else(|| to.to_owned());
    let from = link("child").unwrap_or_else(|| from.to_owned());
    checked(
        with_angles(xyz, EulerZyx { rx, ry, rz })?,
        &to,
        &from,
        REMEDY,
    )
}

fn numbers(
    document: &Document<'_>,
    origin: Node<'_, '_>,
    attribute: &str,
) -> Result<[f64; 3], FormatError> {
    let Some(text) = origin.attribute(attribute) else {
        return Ok([0.0; 3]);
    };
    let row = document.text_pos_at(origin.range().start).row;
    let place = format!("line {row}, attribute {attribute}");
    let numbers: Vec<f64> = text
        .split_whitespace()
        .map(|word| number(word, &place, REMEDY))
        .collect::<Result<_, _>>()?;
    <[f64; 3]>::try_from(numbers).map_err(|n| {
        FormatError::new(
            place,
            format!("{} numbers stand there, 3 must", n.len()),
            REMEDY,
        )
    })
}
