//! CVAT's own XML, 'CVAT for images 1.1': `annotations` with an `image` for each picture, in it a `box` or a `polygon`
//! for each object. <https://docs.cvat.ai/docs/manual/advanced/xml_format/>

use super::labelled::LabelledBox;
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use roxmltree::{Document, Node};

const REMEDY: &str = "export it again as 'CVAT for images 1.1', or as COCO or Pascal VOC";

/// Whether a document is such a file: recordings with the root `annotations` have no `image` in it.
pub(super) fn is(document: &Document<'_>) -> bool {
    let root = document.root_element();
    let has = |name: &str| root.children().any(|node| node.has_tag_name(name));
    root.has_tag_name("annotations") && (has("image") || has("track")) && !has("object")
}

pub(super) fn parse(document: &Document<'_>) -> Result<Parsed, Malformed> {
    let root = document.root_element();
    if let Some(track) = root.children().find(|node| node.has_tag_name("track")) {
        let problem = "tracks of a video, not boxes of images";
        return Err(Malformed::new(place(document, track), problem, REMEDY));
    }
    let declared = root.descendants().filter(|node| node.has_tag_name("label"));
    let names = declared.filter_map(|label| {
        label
            .children()
            .find(|node| node.has_tag_name("name"))?
            .text()
    });
    let images = root.children().filter(|node| node.has_tag_name("image"));
    Ok(Parsed {
        images: images
            .map(|image| of_image(document, image))
            .collect::<Result<_, _>>()?,
        classes: names.map(|name| name.trim().to_owned()).collect(),
        ..Parsed::default()
    })
}

fn of_image(document: &Document<'_>, image: Node<'_, '_>) -> Result<ImageBoxes, Malformed> {
    let mut boxes = ImageBoxes {
        name: image.attribute("name").map(str::to_owned),
        ..ImageBoxes::default()
    };
    if image.has_attribute("width") {
        let size = [
            number(document, image, "width")?,
            number(document, image, "height")?,
        ];
        boxes.size = Some((place(document, image), size));
    }
    for shape in image.children().filter(Node::is_element) {
        let edges = match shape.tag_name().name() {
            "box" => [
                number(document, shape, "xtl")?,
                number(document, shape, "ytl")?,
                number(document, shape, "xbr")?,
                number(document, shape, "ybr")?,
            ],
            "polygon" => bounds(document, shape)?,
            "ellipse" => {
                let [x, y] = [
                    number(document, shape, "cx")?,
                    number(document, shape, "cy")?,
                ];
                let [a, b] = [
                    number(document, shape, "rx")?,
                    number(document, shape, "ry")?,
                ];
                [x - a, y - b, x + a, y + b]
            }
            "tag" | "points" | "polyline" => continue,
            other => {
                let problem = format!("`{other}`, of which no box is known");
                return Err(Malformed::new(place(document, shape), problem, REMEDY));
            }
        };
        let [x_min, y_min, x_max, y_max] = edges;
        boxes.labels.push(LabelledBox {
            class_name: shape.attribute("label").map(str::to_owned),
            ..LabelledBox::new(PixelBox {
                name: boxes.labels.len().to_string(),
                x_min,
                y_min,
                x_max,
                y_max,
                score: 1.0,
            })
        });
    }
    Ok(boxes)
}

/// The bounds of a polygon: `x,y;x,y;…`.
fn bounds(document: &Document<'_>, shape: Node<'_, '_>) -> Result<[f64; 4], Malformed> {
    let text = shape.attribute("points").unwrap_or_default();
    let corner = |pair: &str| -> Option<[f64; 2]> {
        let (x, y) = pair.split_once(',')?;
        Some([x.trim().parse().ok()?, y.trim().parse().ok()?])
    };
    let corners: Option<Vec<[f64; 2]>> = text.split(';').map(corner).collect();
    let corners = corners.ok_or_else(|| {
        let problem = "`points` are not pairs of numbers";
        Malformed::new(place(document, shape), problem, REMEDY)
    })?;
    let least = |axis: usize| {
        corners
            .iter()
            .map(|c| c[axis])
            .fold(f64::INFINITY, f64::min)
    };
    let most = |axis: usize| {
        corners
            .iter()
            .map(|c| c[axis])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    Ok([least(0), least(1), most(0), most(1)])
}

fn number(document: &Document<'_>, node: Node<'_, '_>, name: &str) -> Result<f64, Malformed> {
    let text = node.attribute(name).unwrap_or_default();
    text.trim().parse().map_err(|_| {
        let problem = format!(
            "`{name}` of `{}` is `{text}`, not a number",
            node.tag_name().name()
        );
        Malformed::new(place(document, node), problem, REMEDY)
    })
}

fn place(document: &Document<'_>, node: Node<'_, '_>) -> String {
    format!("line {}", document.text_pos_at(node.range().start).row)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(inside: &str) -> Result<Parsed, Malformed> {
        let xml = format!("<annotations><version>1.1</version>{inside}</annotations>");
        let document = Document::parse(&xml).unwrap();
        assert!(is(&document));
        parse(&document)
    }

    #[test]
    fn boxes_and_polygons_of_each_image() {
        let found = parsed(
            "<meta><task><labels><label><name>apple</name></label><label><name>leaf</name></label></labels></task></meta>
            <image id='0' name='a/color.png' width='64' height='48'>
            <box label='apple' source='manual' occluded='0' xtl='1.5' ytl='2' xbr='9' ybr='8' z_order='0'></box>
            <polygon label='leaf' points='4,5;9.5,7;6,12' z_order='0'/><points label='stem' points='1,1'/></image>
            <image id='1' name='b.png' width='64' height='48'/>",
        )
        .unwrap();
        assert_eq!(found.classes, ["apple", "leaf"]);
        let [first, second] = &*found.images else {
            panic!("{found:?}")
        };
        assert_eq!(
            (
                first.name.as_deref(),
                first.labels.len(),
                second.labels.len()
            ),
            (Some("a/color.png"), 2, 0)
        );
        let leaf = &first.labels[1];
        let edges = [
            leaf.bounds.x_min,
            leaf.bounds.y_min,
            leaf.bounds.x_max,
            leaf.bounds.y_max,
        ];
        assert_eq!(
            (edges, leaf.class_name.as_deref()),
            ([4.0, 5.0, 9.5, 12.0], Some("leaf"))
        );
    }

    #[test]
    fn what_is_no_box_is_refused_by_its_line() {
        for (inside, word) in [
            (
                "<image name='a'><box xtl='one'/></image>",
                "`xtl` of `box` is `one`",
            ),
            ("<image name='a'><mask rle='1'/></image>", "`mask`"),
            ("<image name='a'><polygon points='4'/></image>", "pairs"),
            ("<track id='0' label='apple'/>", "tracks of a video"),
        ] {
            let fault = parsed(inside).unwrap_err();
            assert!(
                fault.problem.contains(word) && fault.place == "line 1",
                "{fault:?}"
            );
        }
        let recording = Document::parse("<annotations><object/></annotations>").unwrap();
        assert!(!is(&recording));
    }
}
