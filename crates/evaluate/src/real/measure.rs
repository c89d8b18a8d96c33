use super::agreement::{Pair, between, repeated};
use super::apple_wood::{AppleWoodTable, WoodSeen};
use super::frame::RealFrame;
use super::perturbation::{depth_noise, perturbed};
use super::record::{
    FrameAgreement, PerturbedAgreement, REAL_SCHEMA, RealAgreement, RealFigures, RealFrameFigures,
    RealFrameSummary, RealReport, RealResult, RealRow,
};
use super::verdict::Sight;
use super::wood_near::{distance_from_box, radius_px};
use crate::error::EvaluateError;
use crate::method::PickMethod;
use pomona::{AppleAnswer, CheckedFrame, FrameAnswer, PickError};
use pomona_cloud::PixelBox;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Without a table, wood within so many radii of the middle of a box is that of its apple, unless the caller says
/// otherwise: the distance within which the strokes of the orchard frames were drawn.
const APPLE_RADII: f64 = 3.0;

/// How methods are measured on real frames.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RealOptions {
    /// Seed of the methods.
    pub seed: u64,
    /// Whether a person sees the wood of each apple. `None`: it is seen where wood is drawn near the box, and elsewhere
    /// there is none.
    pub apples: Option<AppleWoodTable>,
    /// How near that is, in radii of the box.
    pub apple_radii: f64,
    /// Number of perturbed copies of each frame whose answers are compared with the frame's own.
    pub repeats: usize,
    /// What the frames' probability of wood comes from, for the record.
    pub wood: Option<String>,
}

impl RealOptions {
    /// Number of answers for each method and frame: the frame's and those of its copies.
    pub fn answers(&self) -> usize {
        1 + self.repeats
    }
}

impl Default for RealOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            apples: None,
            apple_radii: APPLE_RADII,
            repeats: 0,
            wood: None,
        }
    }
}

/// Measures methods on real frames: whether their directions point at the wood that a person sees, and agree with those from
/// other frames of the tree and from perturbed copies of the frame. `done` is called after each answered frame and copy, one
/// of [`RealOptions::answers`] for each method and frame.
///
/// # Errors
///
/// [`EvaluateError::Pick`] for a frame that a method cannot work on, [`EvaluateError::Malformed`] for a table that
/// names boxes that the frames have not.
pub fn measure_real(
    frames: &[RealFrame],
    methods: &[&dyn PickMethod],
    options: &RealOptions,
    done: &(dyn Fn() + Sync),
) -> Result<RealReport, EvaluateError> {
    if let Some(table) = &options.apples {
        table.check(frames)?;
    }
    let results = methods.iter().map(|method| {
        let answers: Vec<FrameAnswer> = frames
            .par_iter()
            .map(|frame| answer(*method, frame, options.seed).inspect(|_| done()))
            .collect::<Result<_, _>>()?;
        let copies: Vec<Vec<Pair>> = frames
            .par_iter()
            .zip(&answers)
            .map(|(frame, own)| copies(*method, frame, own, options, done))
            .collect::<Result<_, _>>()?;
        Ok(result(method.name(), frames, &answers, &copies, options))
    });
    Ok(RealReport {
        schema: REAL_SCHEMA.to_owned(),
        seed: options.seed,
        wood: options.wood.clone(),
        apple_radii: options.apples.is_none().then_some(options.apple_radii),
        results: results.collect::<Result<_, EvaluateError>>()?,
        frames: frames.iter().map(|frame| summary(frame, options)).collect(),
    })
}

fn answer(method: &dyn PickMethod, frame: &RealFrame, seed: u64) -> Result<FrameAnswer, PickError> {
    let mut checked = CheckedFrame::new(&frame.frame)?;
    if let Some(wood) = &frame.wood {
        checked = checked.with_wood(wood)?;
    }
    Ok(method.answer(&checked, seed)?.without_evidence())
}

/// The answers to each box of each copy of a frame beside the frame's `own`.
fn copies(
    method: &dyn PickMethod,
    frame: &RealFrame,
    own: &FrameAnswer,
    options: &RealOptions,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Pair>, PickError> {
    // A frame without three readings side by side has nothing to be perturbed.
    let noise = depth_noise(&frame.frame.depth).unwrap_or_default();
    let pairs: Vec<Vec<Pair>> = (0..options.repeats)
        .into_par_iter()
        .map(|copy| {
            let copy = perturbed(frame, copy, options.seed, noise);
            let answer = answer(method, &copy, options.seed)?;
            done();
            Ok(repeated(own, &answer))
        })
        .collect::<Result<_, PickError>>()?;
    Ok(pairs.concat())
}

fn wood_seen(frame: &RealFrame, bounds: &PixelBox, options: &RealOptions) -> WoodSeen {
    if let Some(table) = &options.apples {
        return table.wood(&frame.frame.id, &bounds.name);
    }
    let reach = options.apple_radii * radius_px(bounds);
    match distance_from_box(frame, bounds) {
        Some(distance) if distance <= reach => WoodSeen::Seen,
        _ => WoodSeen::None,
    }
}

fn summary(frame: &RealFrame, options: &RealOptions) -> RealFrameSummary {
    let mut boxes = BTreeMap::new();
    for bounds in frame.boxes() {
        *boxes.entry(wood_seen(frame, bounds, options)).or_insert(0) += 1;
    }
    RealFrameSummary {
        frame: frame.frame.id.clone(),
        depth_noise: depth_noise(&frame.frame.depth)
            .map(|noise| noise * frame.frame.camera.depth_scale),
        wood_strokes: frame.wood_strokes().count(),
        boxes,
    }
}

fn result(
    method: &str,
    frames: &[RealFrame],
    answers: &[FrameAnswer],
    copies: &[Vec<Pair>],
    options: &RealOptions,
) -> RealResult {
    let figures = |rows: &[RealRow], copies: &[Pair]| RealFigures {
        perturbed: PerturbedAgreement::of(copies, options.repeats),
        ..RealFigures::of(rows.iter())
    };
    let mut apples: Vec<RealRow> = Vec::new();
    let mut of_frames = Vec::new();
    for ((frame, answer), copies) in frames.iter().zip(answers).zip(copies) {
        let rows: Vec<RealRow> = answer
            .apples
            .iter()
            .map(|apple| row(frame, apple, wood_seen(frame, &apple.bounds, options)))
            .collect();
        of_frames.push(RealFrameFigures {
            frame: frame.frame.id.clone(),
            figures: figures(&rows, copies),
        });
        apples.extend(rows);
    }
    let firsts = answers.iter().enumerate();
    let (pairs, directions): (Vec<FrameAgreement>, Vec<Vec<Pair>>) = firsts
        .flat_map(|(i, first)| {
            answers[i + 1..]
                .iter()
                .map(move |second| between(first, second))
        })
        .unzip();
    RealResult {
        method: method.to_owned(),
        all: figures(&apples, &copies.concat()),
        frames: of_frames,
        between_frames: RealAgreement::of(&directions.concat()),
        pairs,
        apples,
    }
}

fn row(frame: &RealFrame, answer: &AppleAnswer, wood: WoodSeen) -> RealRow {
    let sight = Sight::of(frame, answer);
    let radius_px = radius_px(&answer.bounds);
    let near = sight.wood.as_ref();
    let center = answer.apple.map(|apple| apple.center.point());
    RealRow {
        frame: frame.frame.id.clone(),
        box_name: answer.bounds.name.clone(),
        box_radius_px: radius_px,
        wood,
        verdict: sight.verdict(answer, wood == WoodSeen::Seen),
        status: answer.status.name().to_owned(),
        confidence: answer.confidence,
        image_angle: sight.angle,
        wood_distance_radii: near.map(|wood| wood.distance_px / radius_px),
        foot_from_wood_radii: sight.foot_from_wood_px.map(|d| d / radius_px),
        foot_off_wood_radii: sight.foot_off_wood_px.map(|d| d / radius_px),
        passed_over: near.map_or(0, |wood| wood.passed_over),
        distance: center.map(|c| c.coords.norm()),
        radius: answer.apple.map(|apple| apple.radius_m),
        center: center.map(Into::into),
        foot: answer.pick.map(|pick| pick.foot.point().into()),
        center_px: sight.center_px,
        foot_px: sight.foot_px,
        wood_px: near.map(|wood| wood.feet.clone()).unwrap_or_default(),
    }
}
