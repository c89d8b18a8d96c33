use crate::{
    detection::Detection,
    suppress::{Scope, best_first, is_box, suppress, widest},
};
use pomona_cloud::PixelWindow;
use std::collections::HashMap;

/// A box that ends within so many pixels of the network's input from a tile's inner border counts as cut by it: the
/// error of a network's box edge where it sees half an apple.
const CUT_MARGIN_PX: f64 = 4.0;

/// A cut box of which more than this share of the area lies in a whole one is part of it.
const PART_OF_WHOLE: f64 = 0.5;

/// A box of which more than this share of the area lies in a larger one may be a fragment of the same fruit.
const INSIDE: f64 = 0.85;

/// Least score that a box weighs by: boxes of score 0 must still have a mean.
const LEAST_SCORE: f64 = 1e-6;

/// What was seen in one window of an image.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct View {
    /// The window.
    pub window: PixelWindow,
    /// Pixels of the network's input for each pixel of the image.
    pub scale: f64,
    /// The boxes, in pixels of the image.
    pub detections: Vec<Detection>,
}

/// One set of boxes from the views of an image of `[width, height]` pixels, best first: no two of a class have an `IoU`
/// above `nms_iou`.
///
/// Boxes of one class that lie on each other become their weighted mean (Solovyev, Wang and Gabruseva, Weighted boxes
/// fusion, Image and Vision Computing 107, 2021, section 3, doi 10.1016/j.imavis.2021.104117): the best box first,
/// each joins the mean that it overlaps most, or begins one of its own. It differs in four things, since here not
/// several networks see one image, but one network sees parts of it:
///
/// - a box weighs its score times the square of the view's scale, for the errors of a network are of a size in
///   pixels of its input;
/// - the mean has the score of its best box, for a tile that does not reach there has no say;
/// - a box that ends at an inner border of its view is *cut*, and never changes a whole one. It goes where most of it
///   lies in a whole box, to which it leaves its score if it shows what can be seen of that one there. Cut boxes for
///   which there is no whole one, those of apples larger than the tiles' overlap, are compared by what both views show,
///   and joined to the box around all their parts.
/// - a box counts as cut, too, where it lies inside a larger one that its view does not show to the end, and the view that
///   does has no such box there: it is a fragment of the same fruit that ends before the border.
///
/// The order of the views, and of the boxes in them, changes nothing.
pub fn fuse(views: &[View], [width, height]: [usize; 2], nms_iou: f64) -> Vec<Detection> {
    let mut sightings: Vec<Sighting> = Vec::new();
    for (number, view) in views.iter().enumerate() {
        let boxes = view.detections.iter().filter(|d| is_box(d));
        sightings.extend(boxes.map(|d| Sighting::new(*d, view, number, [width, height])));
    }
    sightings.sort_by(|a, b| {
        best_first(&a.detection, &b.detection).then_with(|| b.weight.total_cmp(&a.weight))
    });
    let all: Vec<Detection> = sightings.iter().map(|s| s.detection).collect();
    let cell = widest(&all);
    mark_fragments(&mut sightings, cell, nms_iou);
    let (cut, whole): (Vec<Sighting>, Vec<Sighting>) = sightings.into_iter().partition(|s| s.cut);
    let (mut fused, near) = fuse_whole(&whole, cell, nms_iou);
    let left = absorb(&cut, &mut fused, &near, nms_iou);
    fused.extend(join(&left, cell, nms_iou));
    suppress(&mut fused, nms_iou, Scope::PerClass);
    fused
}

/// A box and how it was seen.
#[derive(Clone, Copy)]
struct Sighting {
    detection: Detection,
    /// The view's window as a box.
    seen: Detection,
    cut: bool,
    weight: f64,
    /// Number of its view.
    view: usize,
    /// Pixels of the image for the error of an edge.
    margin: f64,
}

impl Sighting {
    fn new(detection: Detection, view: &View, number: usize, [width, height]: [usize; 2]) -> Self {
        let window = view.window;
        let seen = Detection {
            x_min: window.x0 as f64,
            y_min: window.y0 as f64,
            x_max: window.x1 as f64,
            y_max: window.y1 as f64,
            ..detection
        };
        let margin = CUT_MARGIN_PX / view.scale;
        let cut = (window.x0 > 0 && detection.x_min < seen.x_min + margin)
            || (window.y0 > 0 && detection.y_min < seen.y_min + margin)
            || (window.x1 < width && detection.x_max > seen.x_max - margin)
            || (window.y1 < height && detection.y_max > seen.y_max - margin);
        let weight = detection.score.max(LEAST_SCORE) * view.scale * view.scale;
        Self {
            detection,
            seen,
            cut,
            weight,
            view: number,
            margin,
        }
    }

    /// Whether its view shows a box to the end.
    fn shows(&self, other: &Detection) -> bool {
        other.x_min >= self.seen.x_min - self.margin
            && other.y_min >= self.seen.y_min - self.margin
            && other.x_max <= self.seen.x_max + self.margin
            && other.y_max <= self.seen.y_max + self.margin
    }
}

/// Marks as cut what lies inside a larger box that its view does not show to the end, unless the larger one's view shows
/// it there too.
fn mark_fragments(sightings: &mut [Sighting], cell: f64, nms_iou: f64) {
    let mut near = Near::new(cell);
    for (number, sighting) in sightings.iter().enumerate() {
        near.insert(number, &sighting.detection);
    }
    let is_fragment = |small: &Sighting| {
        let box_of = |k: usize| &sightings[k];
        let around = near.of(&small.detection).map(box_of).filter(|large| {
            let area = small.detection.area();
            !large.cut
                && large.detection.area() > area
                && common(&small.detection, &large.detection).area() > INSIDE * area
                && !small.shows(&large.detection)
        });
        around.into_iter().any(|large| {
            let of_view = near.of(&small.detection).map(box_of);
            let mut same = of_view.filter(|other| other.view == large.view);
            !same.any(|other| other.detection.iou(&small.detection) > nms_iou)
        })
    };
    let fragments: Vec<bool> = sightings.iter().map(|s| !s.cut && is_fragment(s)).collect();
    for (sighting, fragment) in sightings.iter_mut().zip(fragments) {
        sighting.cut |= fragment;
    }
}

/// The weighted means of whole boxes, and where they are.
fn fuse_whole(whole: &[Sighting], cell: f64, nms_iou: f64) -> (Vec<Detection>, Near) {
    let mut near = Near::new(cell);
    let mut fused: Vec<Detection> = Vec::new();
    let mut weights: Vec<f64> = Vec::new();
    for Sighting {
        detection, weight, ..
    } in whole
    {
        let mut best: Option<(f64, usize)> = None;
        for k in near.of(detection) {
            let iou = fused[k].iou(detection);
            let better = best.is_none_or(|(most, at)| iou > most || (iou == most && k < at));
            if iou > nms_iou && better {
                best = Some((iou, k));
            }
        }
        let Some((_, k)) = best else {
            near.insert(fused.len(), detection);
            fused.push(*detection);
            weights.push(*weight);
            continue;
        };
        let before = fused[k];
        weights[k] += weight;
        let share = weight / weights[k];
        let mean = |old: f64, new: f64| old + (new - old) * share;
        fused[k] = Detection {
            x_min: mean(before.x_min, detection.x_min),
            y_min: mean(before.y_min, detection.y_min),
            x_max: mean(before.x_max, detection.x_max),
            y_max: mean(before.y_max, detection.y_max),
            ..before
        };
        near.move_to(k, &before, &fused[k]);
    }
    (fused, near)
}

/// The cut boxes that are part of no whole one.
fn absorb(cut: &[Sighting], whole: &mut [Detection], near: &Near, nms_iou: f64) -> Vec<Sighting> {
    let mut left = Vec::new();
    for sighting in cut {
        let part = common(&sighting.detection, &sighting.seen);
        let mut absorbed = false;
        for k in near.of(&sighting.detection) {
            if common(&part, &whole[k]).area() > PART_OF_WHOLE * part.area() {
                absorbed = true;
                if part.iou(&common(&whole[k], &sighting.seen)) > nms_iou {
                    whole[k].score = whole[k].score.max(sighting.detection.score);
                }
            }
        }
        if !absorbed {
            left.push(*sighting);
        }
    }
    left
}

/// Boxes around the parts of what no view shows whole.
fn join(cut: &[Sighting], cell: f64, nms_iou: f64) -> Vec<Detection> {
    let mut near = Near::new(cell);
    let mut groups: Vec<Detection> = Vec::new();
    let mut group_of: Vec<usize> = Vec::new();
    for (number, sighting) in cut.iter().enumerate() {
        let Sighting {
            detection, seen, ..
        } = sighting;
        let same = |k: &usize| {
            let other = &cut[*k];
            let in_both = common(&common(detection, &other.seen), seen)
                .iou(&common(&common(&other.detection, seen), &other.seen));
            in_both.max(detection.iou(&other.detection)) > nms_iou
        };
        let group = near.of(detection).filter(same).map(|k| group_of[k]).min();
        let group = group.unwrap_or_else(|| {
            groups.push(*detection);
            groups.len() - 1
        });
        let around = &mut groups[group];
        around.x_min = around.x_min.min(detection.x_min);
        around.y_min = around.y_min.min(detection.y_min);
        around.x_max = around.x_max.max(detection.x_max);
        around.y_max = around.y_max.max(detection.y_max);
        group_of.push(group);
        near.insert(number, detection);
    }
    groups
}

/// What two boxes have in common; inverted, so of no area, where that is nothing.
fn common(a: &Detection, b: &Detection) -> Detection {
    Detection {
        x_min: a.x_min.max(b.x_min),
        y_min: a.y_min.max(b.y_min),
        x_max: a.x_max.min(b.x_max),
        y_max: a.y_max.min(b.y_max),
        ..*a
    }
}

/// Finds the boxes of a class that may touch one: they are in columns as wide as the widest box, by their centres.
struct Near {
    cell: f64,
    columns: HashMap<(usize, i64), Vec<usize>>,
}

impl Near {
    fn new(cell: f64) -> Self {
        Self {
            cell,
            columns: HashMap::new(),
        }
    }

    fn column(&self, detection: &Detection) -> (usize, i64) {
        let centre = f64::midpoint(detection.x_min, detection.x_max);
        (detection.class, (centre / self.cell).floor() as i64)
    }

    fn insert(&mut self, number: usize, detection: &Detection) {
        let column = self.column(detection);
        self.columns.entry(column).or_default().push(number);
    }

    fn move_to(&mut self, number: usize, from: &Detection, to: &Detection) {
        let (from, new) = (self.column(from), self.column(to));
        if from != new {
            self.columns
                .entry(from)
                .or_default()
                .retain(|&k| k != number);
            self.columns.entry(new).or_default().push(number);
        }
    }

    /// Numbers of all that may touch this box.
    fn of(&self, detection: &Detection) -> impl Iterator<Item = usize> {
        let (class, column) = self.column(detection);
        let columns = [column.saturating_sub(1), column, column.saturating_add(1)];
        let distinct = columns.into_iter().enumerate();
        let distinct = distinct.filter(move |(k, column)| !columns[..*k].contains(column));
        let lists = distinct.filter_map(move |(_, column)| self.columns.get(&(class, column)));
        lists.flatten().copied()
    }
}

#[cfg(test)]
mod tests;
