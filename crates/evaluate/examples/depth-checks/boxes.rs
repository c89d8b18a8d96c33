//! Right and wrong boxes, drawn by seed.

use pomona_cloud::{Frame, PixelBox};
use pomona_detect::Detection;
use pomona_scenes::AppleTruth;
use pomona_statistics::upper_median;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// A false box covers no apple by more than this, as intersection over union.
const MOST_OVERLAP: f64 = 0.1;

/// A detector's box is off by up to this share of its size at each edge.
const JITTER: f64 = 0.06;

/// False boxes are tried so often for each apple.
const TRIES: usize = 12;

/// What is between an apple's depth and that of something of its tree, at most, metres.
const TREE_DEPTH_M: f64 = 0.3;

/// Where boxes are put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// About apples.
    True,
    /// Beside an apple, by one to one and a half of its size: leaves, branches, gaps.
    Beside,
    /// Anywhere on what is as far off as the apples.
    Tree,
    /// Anywhere on what is farther off, or has no depth.
    Background,
    /// About a picture of an apple: the apple's colours on a tilted plane.
    Poster,
}

impl Kind {
    pub(crate) const ALL: [Self; 5] = [
        Self::True,
        Self::Beside,
        Self::Tree,
        Self::Background,
        Self::Poster,
    ];
}

/// A box and what it is counted under.
pub(crate) struct Made {
    pub(crate) detection: Detection,
    pub(crate) group: &'static str,
}

/// Random numbers in 0..1.
pub(crate) struct Draw(ChaCha8Rng);

impl Draw {
    pub(crate) fn new(seed: u64, purpose: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(
            seed.wrapping_mul(31).wrapping_add(purpose),
        ))
    }

    pub(crate) fn share(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / (f64::from(u32::MAX) + 1.0)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// About normal with standard deviation 1: the sum of twelve even draws.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.share()).sum::<f64>() - 6.0
    }
}

/// The boxes of one kind on one frame.
pub(crate) fn make(kind: Kind, frame: &Frame, apples: &[AppleTruth], seed: u64) -> Vec<Made> {
    let mut draw = Draw::new(seed, kind as u64);
    let each = apples.iter();
    each.filter_map(|truth| {
        let (detection, group) = match kind {
            Kind::True => (jittered(&truth.bounds, &mut draw), visibility(truth)),
            Kind::Poster => (jittered(&truth.bounds, &mut draw), "poster"),
            Kind::Beside | Kind::Tree | Kind::Background => {
                misplaced(kind, frame, truth, apples, &mut draw)?
            }
        };
        Some(Made { detection, group })
    })
    .collect()
}

/// How much of the apple shows.
pub(crate) fn visibility(truth: &AppleTruth) -> &'static str {
    match truth.visible_share.unwrap_or(1.0) {
        share if share >= 0.6 => "true_60_to_100",
        share if share >= 0.3 => "true_30_to_60",
        _ => "true_under_30",
    }
}

/// What a box alone says of its apple.
pub(crate) fn presumed(frame: &Frame, bounds: &PixelBox) -> AppleTruth {
    let z = depth_in(frame, &of_box(bounds)).unwrap_or(0.0);
    let (u, v) = bounds.center();
    let radius = 0.25 * (bounds.width() + bounds.height()) * z / frame.camera.fx;
    AppleTruth {
        bounds: bounds.clone(),
        center: frame.camera.deproject(u, v, z + 0.5 * radius).into(),
        radius,
        branch: None,
        direction: None,
        target: None,
        visible_share: None,
        leaves: None,
    }
}

pub(crate) fn jittered(b: &PixelBox, draw: &mut Draw) -> Detection {
    let (w, h) = (b.width(), b.height());
    let mut off = || JITTER * (2.0 * draw.share() - 1.0);
    Detection {
        x_min: b.x_min + w * off(),
        y_min: b.y_min + h * off(),
        x_max: b.x_max + w * off(),
        y_max: b.y_max + h * off(),
        score: 0.9,
        class: 0,
    }
}

pub(crate) fn of_box(b: &PixelBox) -> Detection {
    Detection {
        x_min: b.x_min,
        y_min: b.y_min,
        x_max: b.x_max,
        y_max: b.y_max,
        score: 0.9,
        class: 0,
    }
}

/// A box of the apple's size on no apple.
fn misplaced(
    kind: Kind,
    frame: &Frame,
    truth: &AppleTruth,
    apples: &[AppleTruth],
    draw: &mut Draw,
) -> Option<(Detection, &'static str)> {
    let (w, h) = (truth.bounds.width(), truth.bounds.height());
    let (width, height) = (frame.color.width as f64, frame.color.height as f64);
    (0..TRIES).find_map(|_| {
        let (u, v) = if kind == Kind::Beside {
            let (u, v) = truth.bounds.center();
            let (sin, cos) = draw.between(0.0, std::f64::consts::TAU).sin_cos();
            let far = draw.between(1.0, 1.5);
            (u + far * w * cos, v + far * h * sin)
        } else {
            (
                draw.between(0.5 * w, width - 0.5 * w),
                draw.between(0.5 * h, height - 0.5 * h),
            )
        };
        let detection = Detection {
            x_min: u - 0.5 * w,
            y_min: v - 0.5 * h,
            x_max: u + 0.5 * w,
            y_max: v + 0.5 * h,
            score: 0.9,
            class: 0,
        };
        let inside = detection.x_min >= 0.0
            && detection.y_min >= 0.0
            && detection.x_max <= width
            && detection.y_max <= height;
        let free = apples
            .iter()
            .all(|a| detection.iou(&of_box(&a.bounds)) <= MOST_OVERLAP);
        if !(inside && free) {
            return None;
        }
        let on_tree = depth_in(frame, &detection)
            .is_some_and(|z| (z - truth.center[2]).abs() <= TREE_DEPTH_M);
        match kind {
            Kind::Tree if on_tree => Some((detection, "false_tree")),
            Kind::Background if !on_tree => Some((detection, "false_background")),
            Kind::Beside => Some((detection, "false_beside")),
            _ => None,
        }
    })
}

/// The middle one of the depths in a box, metres.
fn depth_in(frame: &Frame, b: &Detection) -> Option<f64> {
    let mut depths = Vec::new();
    for v in (b.y_min as usize..b.y_max as usize).step_by(3) {
        for u in (b.x_min as usize..b.x_max as usize).step_by(3) {
            depths.extend(frame.depth.get(u, v));
        }
    }
    let middle = upper_median(&mut depths)?;
    Some(f64::from(middle) * frame.camera.depth_scale)
}
