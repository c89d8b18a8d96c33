//! Pascal VOC annotation XML, with the tag names of the standard (`annotation`, `bndbox`)
//! or those of the recordings that have `annotations` and `bbox`.

use super::cvat;
use super::labelled::{LabelKind, LabelledBox};
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use roxmltree::{Document, Node};
use std::fmt::Write;

const REMEDY: &str =
    "give VOC XML: annotation / object / name and bndbox with xmin, ymin, xmax, ymax";

/// What every object is of in the files that we write.
const CLASS: &str = "apple";

pub(super) fn parse(text: &str) -> Result<Parsed, Malformed> {
    let document =
        Document::parse(text).map_err(|e| Malformed::new("XML", e.to_string(), REMEDY))?;
    if cvat::is(&document) {
        return cvat::parse(&document);
    }
    let root = document.root_element();
    if !matches!(root.tag_name().name(), "annotation" | "annotations") {
        let problem = format!(
            "root element `{}`, not `annotation`",
            root.tag_name().name()
        );
        return Err(Malformed::new(place(&document, root), problem, REMEDY));
    }
    let mut image = ImageBoxes {
        name: text_in(root, "filename"),
        ..ImageBoxes::default()
    };
    if let Some(size) = child(root, &["size"]) {
        let stated = [
            number(&document, size, "width")?,
            number(&document, size, "height")?,
        ];
        image.size = Some(("<size>".to_owned(), stated));
    }
    let labels: Result<_, _> = root
        .children()
        .filter(|node| node.has_tag_name("object"))
        .enumerate()
        .map(|(index, object)| {
            let edges = child(object, &["bndbox", "bbox"]).ok_or_else(|| {
                Malformed::new(place(&document, object), "object without a box", REMEDY)
            })?;
            let class = text_in(object, "name");
            let own = text_in(object, "id").or_else(|| class.clone());
            let score = child(object, &["score", "confidence"]);
            let score_name = score.map_or("score", |node| node.tag_name().name());
            let difficult = child(object, &["difficult"]).is_some()
                && number(&document, object, "difficult")? != 0.0;
            let bounds = PixelBox {
                name: own.unwrap_or_else(|| index.to_string()),
                x_min: number(&document, edges, "xmin")?,
                y_min: number(&document, edges, "ymin")?,
                x_max: number(&document, edges, "xmax")?,
                y_max: number(&document, edges, "ymax")?,
                score: if score.is_some() {
                    number(&document, object, score_name)?
                } else {
                    1.0
                },
            };
            Ok(LabelledBox {
                bounds,
                class_number: None,
                class_name: class,
                kind: if difficult {
                    LabelKind::Difficult
                } else {
                    LabelKind::Object
                },
            })
        })
        .collect();
    image.labels = labels?;
    Ok(Parsed::of_one(image))
}

/// The text in an element's child; nothing where it is missing or empty.
fn text_in(parent: Node<'_, '_>, name: &str) -> Option<String> {
    let text = child(parent, &[name])?.text()?.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

fn place(document: &Document<'_>, node: Node<'_, '_>) -> String {
    format!("line {}", document.text_pos_at(node.range().start).row)
}

fn child<'a, 'i>(parent: Node<'a, 'i>, names: &[&str]) -> Option<Node<'a, 'i>> {
    parent
        .children()
        .find(|node| node.is_element() && names.contains(&node.tag_name().name()))
}

fn number(document: &Document<'_>, parent: Node<'_, '_>, name: &str) -> Result<f64, Malformed> {
    let fault = |problem: String| Malformed::new(place(document, parent), problem, REMEDY);
    let node = child(parent, &[name])
        .ok_or_else(|| fault(format!("`{}` without `{name}`", parent.tag_name().name())))?;
    let text = node.text().unwrap_or_default().trim();
    text.parse()
        .map_err(|_| fault(format!("`{name}` is `{text}`, not a number")))
}

pub(super) fn format(boxes: &[PixelBox], width: usize, height: usize) -> String {
    let mut xml = format!(
        "<annotation>\n  <size>\n    <width>{width}</width>\n    <height>{height}</height>\n    <depth>3</depth>\n  </size>\n"
    );
    for b in boxes {
        // Writing to a string cannot fail.
        let _ = write!(
            xml,
            "  <object>\n    <name>{CLASS}</name>\n    <id>{}</id>\n    <score>{}</score>\n    <bndbox>\n      <xmin>{}</xmin>\n      <ymin>{}</ymin>\n      <xmax>{}</xmax>\n      <ymax>{}</ymax>\n    </bndbox>\n  </object>\n",
            escape(&b.name),
            b.score,
            b.x_min,
            b.y_min,
            b.x_max,
            b.y_max
        );
    }
    xml.push_str("</annotation>\n");
    xml
}

/// `text` as XML character data; characters that XML cannot hold are replaced.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {
                escaped.push(char::REPLACEMENT_CHARACTER);
            }
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(xml: &str) -> Vec<LabelledBox> {
        parse(xml).unwrap().images.remove(0).labels
    }

    #[test]
    fn reads_the_standard_tags_and_those_of_the_recordings() {
        for (root, tag) in [("annotation", "bndbox"), ("annotations", "bbox")] {
            let xml = format!(
                "<{root}>\r\n<size><width>9</width><height>8</height></size><object><name> 2118 </name><{tag}><xmin>1</xmin><ymin>2.5</ymin><xmax>3</xmax><ymax>4</ymax></{tag}></object><object><{tag}><xmin>1</xmin><ymin>2</ymin><xmax>3</xmax><ymax>4</ymax></{tag}></object></{root}>"
            );
            let boxes: Vec<_> = labels(&xml).into_iter().map(|label| label.bounds).collect();
            assert_eq!(boxes.len(), 2);
            assert_eq!(
                (boxes[0].name.as_str(), boxes[0].y_min, boxes[0].score),
                ("2118", 2.5, 1.0)
            );
            assert_eq!(boxes[1].name, "1");
        }
    }

    #[test]
    fn names_are_classes_and_difficult_ones_are_marked() {
        let object = |more: &str| {
            format!(
                "<object><name>apple</name>{more}<bndbox><xmin>1</xmin><ymin>2</ymin><xmax>3</xmax><ymax>4</ymax></bndbox></object>"
            )
        };
        let parse_one = |more: &str| parse(&format!("<annotation>{}</annotation>", object(more)));
        for (more, kind) in [
            ("", LabelKind::Object),
            ("<difficult>0</difficult>", LabelKind::Object),
            ("<difficult>1</difficult>", LabelKind::Difficult),
        ] {
            let label = parse_one(more).unwrap().images[0].labels.remove(0);
            assert_eq!(
                (label.class_name.as_deref(), label.kind),
                (Some("apple"), kind)
            );
        }
        let fault = parse_one("<difficult>no</difficult>").unwrap_err();
        assert!(fault.problem.contains("difficult"), "{fault:?}");
    }

    #[test]
    fn the_parts_of_an_object_are_not_its_box() {
        let xml = "<annotation><filename>x.png</filename><object><name>apple</name><part><name>stem</name><bndbox>\
            <xmin>1</xmin><ymin>1</ymin><xmax>2</xmax><ymax>2</ymax></bndbox></part><bndbox><xmin>3</xmin>\
            <ymin>3</ymin><xmax>8</xmax><ymax>8</ymax></bndbox></object></annotation>";
        let image = parse(xml).unwrap().images.remove(0);
        assert_eq!(image.name.as_deref(), Some("x.png"));
        assert_eq!((image.labels.len(), image.labels[0].bounds.x_min), (1, 3.0));
    }

    #[test]
    fn faults_name_the_line() {
        let fault = parse("<annotation>\n<object/>\n</annotation>").unwrap_err();
        assert_eq!(fault.place, "line 2");
        let bad = "<annotation><object><bndbox>\n<xmin>one</xmin></bndbox></object></annotation>";
        assert!(parse(bad).unwrap_err().problem.contains("`xmin` is `one`"));
        assert!(parse("<html/>").unwrap_err().problem.contains("`html`"));
        assert!(parse("<annotation><object>").is_err());
    }
}
