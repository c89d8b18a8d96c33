use crate::{Line, Point, Primitive, Sphere};
use std::time::Instant;

/// What is asked; `xtask/peers/README.md` says how it is written.
#[derive(Clone, Copy, Debug)]
pub struct Job {
    pub hypotheses: usize,
    /// 0 where exactly so many hypotheses are to be scored.
    pub confidence: f64,
    pub threshold: f64,
    pub min: f64,
    pub max: f64,
    pub seed: u64,
    /// The point that a line has to pass between `min` and `max`.
    pub point: Point,
}

/// What a peer found.
pub struct Fitted<M> {
    pub model: M,
    /// 0 where it does not tell.
    pub hypotheses: usize,
}

/// Answers the jobs on standard input.
///
/// `prepare` turns the points into what the peer works on, which is not timed.
pub fn serve<D>(
    prepare: impl Fn(&[Point], &Job) -> D,
    fit_sphere: impl Fn(&D, &Job) -> Option<Fitted<Sphere>>,
    fit_line: impl Fn(&D, &Job) -> Option<Fitted<Line>>,
) {
    for line in std::io::stdin().lines() {
        let line = line.expect("standard input is text");
        let words: Vec<&str> = line.split_whitespace().collect();
        let [primitive, file, numbers @ ..] = words.as_slice() else {
            panic!("not a job: {line}");
        };
        let numbers: Vec<f64> = numbers
            .iter()
            .map(|word| word.parse().expect("a number"))
            .collect();
        let job = Job {
            hypotheses: numbers[0] as usize,
            confidence: numbers[1],
            threshold: numbers[2],
            min: numbers[3],
            max: numbers[4],
            seed: numbers[5] as u64,
            point: Point::from_iterator(numbers.iter().copied().skip(6).chain([0.0; 3]).take(3)),
        };
        let data = prepare(&read(file), &job);
        match *primitive {
            "sphere" => answer(|| fit_sphere(&data, &job)),
            _ => answer(|| fit_line(&data, &job)),
        }
    }
}

fn answer<M: Primitive>(fit: impl Fn() -> Option<Fitted<M>>) {
    let start = Instant::now();
    let fitted = fit();
    let milliseconds = start.elapsed().as_secs_f64() * 1e3;
    let hypotheses = fitted.as_ref().map_or(0, |fitted| fitted.hypotheses);
    print!("{milliseconds:.6} {hypotheses}");
    for coefficient in fitted.iter().flat_map(|fitted| fitted.model.coefficients()) {
        print!(" {coefficient:.9}");
    }
    println!();
}

fn read(path: &str) -> Vec<Point> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let numbers: Vec<f64> = bytes
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]).into())
        .collect();
    numbers
        .chunks_exact(3)
        .map(|p| Point::new(p[0], p[1], p[2]))
        .collect()
}
