//! Whether numbers that were read as YOLO's can be meant so: other programs write the same numbers in another order.

use pomona_files::{Warning, WarningCode};

/// How far boxes may reach beyond the image, in shares of it: labelling tools leave edges outside by less.
const BEYOND: f64 = 0.02;

/// An order in which other programs write the numbers behind the class.
struct Order {
    name: &'static str,
    /// How many numbers it has.
    numbers: usize,
    edges: fn(&[f64]) -> [f64; 4],
}

const ORDERS: [Order; 3] = [
    Order {
        name: "left, top, right and bottom edge",
        numbers: 4,
        edges: |n| [n[0], n[1], n[2], n[3]],
    },
    Order {
        name: "left, top, right and bottom edge, and a score",
        numbers: 5,
        edges: |n| [n[0], n[1], n[2], n[3]],
    },
    Order {
        name: "the score first, then centre and size",
        numbers: 5,
        edges: |n| from_centre([n[1], n[2], n[3], n[4]]),
    },
];

/// A warning where boxes reach far beyond the image as they were read, and all lie in it in another order.
pub(super) fn of(lines: &[Vec<f64>], file: &str) -> Option<Warning> {
    let boxes = || {
        lines
            .iter()
            .filter(|numbers| matches!(numbers.len(), 4 | 5))
    };
    let count = boxes().count();
    let outside = boxes()
        .filter(|n| !lies_in_image(from_centre([n[0], n[1], n[2], n[3]])))
        .count();
    if outside == 0 {
        return None;
    }
    let fits = |order: &&Order| {
        boxes().all(|n| n.len() == order.numbers && lies_in_image((order.edges)(n)))
    };
    let order = ORDERS.iter().find(fits)?;
    Some(Warning::new(
        WarningCode::BoxOrderDoubtful,
        format!(
            "{file}: {outside} of {count} boxes reach beyond the image, read as YOLO's centre, size and score; all lie \
             in it if the numbers are {}: write them as `class cx cy w h [score]`",
            order.name
        ),
    ))
}

fn lies_in_image([x0, y0, x1, y1]: [f64; 4]) -> bool {
    let inside = |share: f64| (-BEYOND..=1.0 + BEYOND).contains(&share);
    [x0, y0, x1, y1].into_iter().all(inside) && x0 < x1 && y0 < y1
}

/// The edges of a box by its centre and size.
pub(super) fn from_centre([cx, cy, w, h]: [f64; 4]) -> [f64; 4] {
    [cx - 0.5 * w, cy - 0.5 * h, cx + 0.5 * w, cy + 0.5 * h]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn doubt(lines: &[&[f64]]) -> Option<String> {
        let lines: Vec<Vec<f64>> = lines.iter().map(|line| line.to_vec()).collect();
        of(&lines, "boxes.txt").map(|warning| warning.message)
    }

    #[test]
    fn another_order_that_fits_is_named() {
        let corners = doubt(&[&[0.4, 0.5, 0.5, 0.6], &[0.8, 0.7, 0.9, 0.8]]).unwrap();
        assert!(
            corners.contains("1 of 2 boxes")
                && corners.contains("left, top, right and bottom edge:"),
            "{corners}"
        );
        let scored = doubt(&[&[0.8, 0.7, 0.9, 0.8, 0.3]]).unwrap();
        assert!(scored.contains("edge, and a score"), "{scored}");
        let first = doubt(&[&[0.83, 0.44, 0.59, 0.08, 0.1]]).unwrap();
        assert!(first.contains("score first"), "{first}");
    }

    #[test]
    fn boxes_that_lie_in_the_image_or_nowhere_raise_no_doubt() {
        assert_eq!(doubt(&[]), None);
        assert_eq!(doubt(&[&[0.4, 0.5, 0.5, 0.6]]), None);
        assert_eq!(
            doubt(&[&[0.5, 0.5, 1.0, 1.0, 0.9], &[0.99, 0.5, 0.05, 0.1, 0.2]]),
            None
        );
        // Beyond the image in every order.
        assert_eq!(
            doubt(&[&[0.98, 0.5, 0.2, 0.1], &[0.1, 0.1, 0.3, 0.3]]),
            None
        );
    }
}
