//! All engines fit the same clouds in turns; then ours is compared with each.

use super::{
    clouds::{Cloud, Mode, Primitive},
    engine::{Answer, Engine, Process},
    interval::{interval, mean, median},
};
use anyhow::Result;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Engine, cloud, primitive, mode.
type Key = (usize, usize, Primitive, Mode);

/// Engines and their answers; the first engine is ours.
pub(super) struct Contest {
    engines: Vec<Engine>,
    /// One answer for each round; `None` where the program died.
    answers: BTreeMap<Key, Vec<Option<Answer>>>,
}

impl Contest {
    pub(super) fn new(engines: Vec<Engine>) -> Self {
        Self {
            engines,
            answers: BTreeMap::new(),
        }
    }

    /// Names of the engines that could not take part, and why.
    pub(super) fn absent(&self) -> impl Iterator<Item = (&str, &str)> {
        self.engines
            .iter()
            .filter_map(|e| Some((e.name, e.program.as_ref().err()?.as_str())))
    }

    /// Every engine fits every cloud, `rounds` times.
    ///
    /// They take turns at every job, in an order that changes with the round, so that what else
    /// the machine does slows all of them.
    pub(super) fn run(&mut self, clouds: &[Cloud], rounds: u32) -> Result<()> {
        let mut processes: Vec<Option<Process>> = Vec::new();
        for engine in &self.engines {
            let program = engine.program.as_ref().ok();
            processes.push(program.map(|program| Process::start(program)).transpose()?);
        }
        for round in 0..rounds {
            eprintln!("round {} of {rounds}", round + 1);
            for (number, cloud) in clouds.iter().enumerate() {
                let before = clouds[..number]
                    .iter()
                    .filter(|c| c.suite == cloud.suite)
                    .count();
                for (primitive, mode) in JOBS {
                    let job = cloud.job(primitive, mode, round);
                    for turn in 0..self.engines.len() {
                        let index = (turn + round as usize) % self.engines.len();
                        let engine = &self.engines[index];
                        let slow = engine.max_scenes != usize::MAX;
                        if before >= engine.max_scenes
                            || (slow && round > 0)
                            || !engine.does(primitive, mode)
                        {
                            continue;
                        }
                        let (Ok(program), Some(process)) = (&engine.program, &mut processes[index])
                        else {
                            continue;
                        };
                        let answer = process.ask(&job).ok();
                        if answer.is_none() {
                            *process = Process::start(program)?;
                        }
                        self.answers
                            .entry((index, number, primitive, mode))
                            .or_default()
                            .push(answer);
                    }
                }
            }
        }
        Ok(())
    }
}

const JOBS: [(Primitive, Mode); 4] = [
    (Primitive::Sphere, Mode::Full),
    (Primitive::Sphere, Mode::Adaptive),
    (Primitive::Line, Mode::Full),
    (Primitive::Line, Mode::Adaptive),
];

/// One suite, one primitive, one way to stop: a row for each engine.
pub(super) struct Comparison {
    pub suite: String,
    pub primitive: Primitive,
    pub mode: Mode,
    /// Median over the clouds.
    pub points: f64,
    pub rows: Vec<Row>,
}

/// An engine's figures.
pub(super) struct Row {
    pub name: &'static str,
    pub remark: &'static str,
    pub clouds: usize,
    /// Median over the clouds of the median over the rounds.
    pub milliseconds: f64,
    /// Median over the clouds of its time over ours, and its 95 % interval.
    pub ratio: f64,
    pub ratio_interval: [f64; 2],
    /// Median of the models scored.
    pub hypotheses: Option<f64>,
    /// Mean over the clouds.
    pub error: f64,
    /// Mean over the clouds of its error less ours, and its 95 % interval.
    pub excess: f64,
    pub excess_interval: [f64; 2],
    /// Tries that gave no model, and those in which the program died.
    pub without_model: usize,
    pub crashes: usize,
}

/// What one engine made of one cloud.
struct Outcome {
    milliseconds: f64,
    error: f64,
}

impl Comparison {
    pub(super) fn new(
        contest: &Contest,
        clouds: &[Cloud],
        suite: &str,
        primitive: Primitive,
        mode: Mode,
    ) -> Self {
        let numbers: Vec<usize> = (0..clouds.len())
            .filter(|&number| clouds[number].suite == suite)
            .collect();
        let points: Vec<f64> = numbers
            .iter()
            .map(|&number| clouds[number].points(primitive) as f64)
            .collect();
        let mut rows = Vec::new();
        for (index, engine) in contest.engines.iter().enumerate() {
            let answers_of = |engine, number| {
                contest
                    .answers
                    .get(&(engine, number, primitive, mode))
                    .map_or(&[][..], Vec::as_slice)
            };
            let outcome_of = |engine, number| {
                Outcome::of(&clouds[number], primitive, answers_of(engine, number))
            };
            let answers: Vec<&Option<Answer>> = numbers
                .iter()
                .flat_map(|&number| answers_of(index, number))
                .collect();
            if answers.is_empty() {
                continue;
            }
            let pairs = numbers
                .iter()
                .filter_map(|&n| Some((outcome_of(index, n)?, outcome_of(0, n)?)));
            let pairs: Vec<(Outcome, Outcome)> = pairs.collect();
            rows.push(Row::new(engine, &answers, &pairs));
        }
        Self {
            suite: suite.into(),
            primitive,
            mode,
            points: median(&points),
            rows,
        }
    }

    pub(super) fn to_json(&self) -> Value {
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                json!({
                    "engine": row.name, "remark": row.remark, "clouds": row.clouds,
                    "time_ms": row.milliseconds, "hypotheses": row.hypotheses,
                    "ratio": row.ratio, "ratio_interval": row.ratio_interval,
                    "error": row.error, "excess": row.excess, "excess_interval": row.excess_interval,
                    "without_model": row.without_model, "crashes": row.crashes,
                })
            })
            .collect();
        json!({
            "suite": self.suite, "primitive": self.primitive.name(),
            "adaptive": self.mode == Mode::Adaptive,
            "points": self.points, "error_is": self.primitive.error_name(), "engines": rows,
        })
    }
}

impl Row {
    fn new(engine: &Engine, answers: &[&Option<Answer>], pairs: &[(Outcome, Outcome)]) -> Self {
        let column = |value: fn(&(Outcome, Outcome)) -> f64| -> Vec<f64> {
            pairs.iter().map(value).collect()
        };
        let ratios = column(|(theirs, ours)| theirs.milliseconds / ours.milliseconds);
        let excess = column(|(theirs, ours)| theirs.error - ours.error);
        let given: Vec<&Answer> = answers
            .iter()
            .filter_map(|answer| answer.as_ref())
            .collect();
        let hypotheses: Vec<f64> = given
            .iter()
            .filter_map(|answer| answer.hypotheses)
            .collect();
        Self {
            name: engine.name,
            remark: engine.remark,
            clouds: pairs.len(),
            milliseconds: median(&column(|(theirs, _)| theirs.milliseconds)),
            ratio: median(&ratios),
            ratio_interval: interval(&ratios, median),
            hypotheses: (!hypotheses.is_empty()).then(|| median(&hypotheses)),
            error: mean(&column(|(theirs, _)| theirs.error)),
            excess: mean(&excess),
            excess_interval: interval(&excess, mean),
            without_model: given
                .iter()
                .filter(|answer| answer.model.is_empty())
                .count(),
            crashes: answers.len() - given.len(),
        }
    }
}

impl Outcome {
    /// Median time and mean error of the rounds that gave a model; `None` where none did.
    fn of(cloud: &Cloud, primitive: Primitive, answers: &[Option<Answer>]) -> Option<Self> {
        let (mut times, mut errors) = (Vec::new(), Vec::new());
        for answer in answers.iter().flatten() {
            if let Some(error) = cloud.error(primitive, &answer.model) {
                times.push(answer.milliseconds);
                errors.push(error);
            }
        }
        (!times.is_empty()).then(|| Self {
            milliseconds: median(&times),
            error: mean(&errors),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn engine(name: &'static str) -> Engine {
        Engine {
            name,
            remark: "",
            jobs: &JOBS,
            max_scenes: usize::MAX,
            program: Err("not here".into()),
        }
    }

    fn answer(milliseconds: f64, x: f64) -> Answer {
        Answer {
            milliseconds,
            hypotheses: Some(1000.0),
            model: vec![x, 0.0, 0.8, 0.04],
        }
    }

    #[test]
    fn engines_are_compared_cloud_by_cloud() {
        let clouds = [Cloud::example(), Cloud::example()];
        let mut contest = Contest::new(vec![engine("ours"), engine("theirs"), engine("another")]);
        let mut answered = |engine, cloud, answers| {
            contest
                .answers
                .insert((engine, cloud, Primitive::Sphere, Mode::Full), answers);
        };
        answered(
            0,
            0,
            vec![
                Some(answer(1.0, 0.001)),
                Some(answer(3.0, 0.001)),
                Some(answer(2.0, 0.001)),
            ],
        );
        answered(0, 1, vec![Some(answer(4.0, 0.002))]);
        answered(1, 0, vec![Some(answer(20.0, 0.002)), None]);
        answered(1, 1, vec![Some(answer(40.0, 0.003))]);

        let comparison = Comparison::new(&contest, &clouds, "lab15", Primitive::Sphere, Mode::Full);
        assert_eq!(
            comparison.rows.len(),
            2,
            "an engine without answers has no row"
        );
        let [ours, theirs] = comparison.rows.as_slice() else {
            unreachable!()
        };
        assert_eq!((ours.milliseconds, ours.ratio), (3.0, 1.0));
        assert_eq!((theirs.milliseconds, theirs.ratio), (30.0, 10.0));
        assert!((theirs.excess - 1.0).abs() < 1e-9);
        assert_eq!((theirs.crashes, theirs.without_model), (1, 0));
    }

    #[test]
    fn an_absent_engine_is_named() {
        let contest = Contest::new(vec![engine("theirs")]);
        assert_eq!(
            contest.absent().collect::<Vec<_>>(),
            [("theirs", "not here")]
        );
    }
}
