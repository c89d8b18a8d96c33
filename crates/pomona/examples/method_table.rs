//! Accuracy of a method over scene suites, one row each: for work on the method itself.
//!
//! `cargo run --release -p pomona --example method_table -- METHOD SUITE[:FROM..TO]...`
//! Frames are cut about their target and kept in `$TMPDIR`, so that a second run takes seconds.

use pomona::{Config, Method, Picker, Status};
use pomona_cloud::{Camera, ColorImage, DepthImage, Frame, PixelBox};
use pomona_scenes::{AppleTruth, Suite};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

#[derive(Serialize, Deserialize)]
struct Head {
    id: String,
    camera: Camera,
    boxes: Vec<PixelBox>,
    width: usize,
    height: usize,
    truths: Vec<AppleTruth>,
    real: Option<Camera>,
}

struct Cut {
    frame: Frame,
    truths: Vec<AppleTruth>,
}

fn folder(suite: Suite) -> PathBuf {
    std::env::temp_dir().join("pomona-cuts").join(suite.name())
}

fn cut(suite: Suite, number: usize) -> Cut {
    let path = folder(suite).join(format!("{number:05}"));
    if let (Ok(head), Ok(body)) = (
        std::fs::read(path.with_extension("json")),
        std::fs::read(path.with_extension("raw")),
    ) {
        let head: Head = serde_json::from_slice(&head).unwrap();
        let readings = body
            .chunks_exact(2)
            .map(|b| u16::from_le_bytes([b[0], b[1]]))
            .collect();
        let frame = Frame {
            id: head.id,
            camera: head.camera,
            color: ColorImage::filled(head.width, head.height, [0, 0, 0]),
            depth: DepthImage {
                width: head.width,
                height: head.height,
                readings,
            },
            boxes: Some(head.boxes),
        };
        return Cut {
            frame,
            truths: head.truths,
        };
    }
    let case = suite.cases_to(number + 1).last().unwrap();
    let scene = case.scene();
    let frame = &scene.frame;
    let (w, h) = (frame.depth.width, frame.depth.height);
    let targets: Vec<&AppleTruth> = scene
        .truth
        .apples
        .iter()
        .filter(|a| a.target != Some(false))
        .collect();
    let (mut x0, mut y0, mut x1, mut y1) = (0, 0, w, h);
    if let [one] = targets[..] {
        let c = one.center;
        let f = frame.camera.fx;
        let (u, v) = (
            f * c[0] / c[2] + frame.camera.cx,
            f * c[1] / c[2] + frame.camera.cy,
        );
        let reach = (4.2 * one.radius * f / (c[2] - one.radius)).max(150.0);
        x0 = (u - reach).max(0.0) as usize;
        y0 = (v - reach).max(0.0) as usize;
        x1 = ((u + reach).max(1.0) as usize).min(w);
        y1 = ((v + reach).max(1.0) as usize).min(h);
    }
    let mut readings = Vec::new();
    for y in y0..y1 {
        readings.extend_from_slice(&frame.depth.readings[y * w + x0..y * w + x1]);
    }
    let shift = |b: &PixelBox| PixelBox {
        x_min: b.x_min - x0 as f64,
        x_max: b.x_max - x0 as f64,
        y_min: b.y_min - y0 as f64,
        y_max: b.y_max - y0 as f64,
        ..b.clone()
    };
    let camera = Camera {
        width: x1 - x0,
        height: y1 - y0,
        cx: frame.camera.cx - x0 as f64,
        cy: frame.camera.cy - y0 as f64,
        ..frame.camera.clone()
    };
    let inside = |b: &PixelBox| {
        b.x_max > 5.0
            && b.y_max > 5.0
            && b.x_min < (x1 - x0) as f64 - 5.0
            && b.y_min < (y1 - y0) as f64 - 5.0
    };
    let mut boxes = Vec::new();
    let mut truths = Vec::new();
    for (b, t) in frame.boxes.iter().flatten().zip(&scene.truth.apples) {
        let b = shift(b);
        if inside(&b) {
            boxes.push(b);
            truths.push(t.clone());
        }
    }
    let head = Head {
        id: frame.id.clone(),
        camera,
        boxes,
        width: x1 - x0,
        height: y1 - y0,
        truths,
        real: scene.truth.camera.clone(),
    };
    std::fs::create_dir_all(folder(suite)).unwrap();
    let body: Vec<u8> = readings
        .iter()
        .flat_map(|r: &u16| r.to_le_bytes())
        .collect();
    std::fs::write(path.with_extension("raw"), body).unwrap();
    std::fs::write(
        path.with_extension("json"),
        serde_json::to_string(&head).unwrap(),
    )
    .unwrap();
    cut(suite, number)
}

struct Row {
    number: usize,
    name: String,
    status: Status,
    angle: Option<f64>,
    center: Option<[f64; 3]>,
    radius: Option<f64>,
    foot: Option<f64>,
    confidence: Option<f64>,
    answerable: bool,
    ms: [f64; 4],
    share: f64,
    text: String,
}

fn row(picker: &Picker, suite: Suite, number: usize) -> Vec<Row> {
    let cut = cut(suite, number);
    let outcome = picker.pick(&cut.frame, 0, None).unwrap();
    let mut rows = Vec::new();
    for (pick, truth) in outcome.record.picks.iter().zip(&cut.truths) {
        if truth.target == Some(false) {
            continue;
        }
        let v = |a: [f64; 3]| nalgebra::Vector3::from(a);
        if let Ok(path) = std::env::var("DUMP") {
            use std::io::Write;
            let mut file = std::fs::OpenOptions::new()
                .create(true)
                .append(true)
                .open(path)
                .unwrap();
            let line = serde_json::json!({"suite": suite.name(), "number": number, "pick": pick, "truth": truth}).to_string() + "\n";
            file.write_all(line.as_bytes()).unwrap();
        }
        let picked = pick.status == Status::Picked;
        let angle = pick
            .direction
            .filter(|_| picked)
            .zip(truth.direction)
            .map(|(a, b)| v(a).angle(&v(b)).to_degrees());
        let branch = truth.branch.as_ref();
        rows.push(Row {
            number,
            name: truth.bounds.name.clone(),
            status: pick.status,
            angle,
            center: pick
                .apple
                .as_ref()
                .map(|a| (v(a.center) - v(truth.center)).into()),
            radius: pick.apple.as_ref().map(|a| a.radius - truth.radius),
            foot: pick
                .foot
                .zip(branch)
                .map(|(f, b)| (v(f) - v(b.point)).norm()),
            confidence: pick.confidence,
            answerable: truth.visible_share.unwrap_or(1.0) >= 0.1
                && branch.is_some_and(|b| {
                    b.visible_length.unwrap_or(1.0) >= 0.01 && b.visible_pixels.unwrap_or(99) >= 20
                }),
            ms: [
                pick.timing_ms.crop,
                pick.timing_ms.sphere,
                pick.timing_ms.branch,
                pick.timing_ms.total,
            ],
            share: truth.visible_share.unwrap_or(1.0),
            text: format!(
                "{} r {:.1} b {:.1} vis {:.2} len {:.0} px {} z {:.2} leaves {}",
                oracle(pick, truth),
                truth.radius * 1e3,
                branch.map_or(0.0, |b| b.radius * 1e3),
                truth.visible_share.unwrap_or(1.0),
                branch.and_then(|b| b.visible_length).unwrap_or(0.0) * 1e3,
                branch.and_then(|b| b.visible_pixels).unwrap_or(0),
                truth.center[2],
                truth.leaves.unwrap_or(0),
            ),
        });
    }
    rows
}

fn mean(v: &[f64]) -> f64 {
    v.iter().sum::<f64>() / v.len().max(1) as f64
}

fn quantile(v: &mut [f64], q: f64) -> f64 {
    if v.is_empty() {
        return f64::NAN;
    }
    v.sort_by(f64::total_cmp);
    v[((v.len() - 1) as f64 * q) as usize]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let worst = std::env::var("WORST")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(0);
    let mut config = match std::env::var("CONFIG") {
        Ok(path) => Config::read(path).unwrap(),
        Err(_) => Config::default(),
    };
    config.method = serde_json::from_value::<Method>(arguments[0].clone().into()).unwrap();
    println!(
        "suite                 n  ans%  (of seen) | mean   med   p95   <=10   >=50 | O mean  med  p95 | bias x y z mm | dr mean |dr| | foot med | ms med sphere branch total"
    );
    for argument in &arguments[1..] {
        let (name, range) = argument.split_once(':').unwrap_or((argument, ""));
        let suite = Suite::named(name).unwrap();
        let (from, to) = range.split_once("..").map_or((0, suite.len()), |(a, b)| {
            (a.parse().unwrap(), b.parse().unwrap())
        });
        #[allow(unused_mut)]
        let mut picker_config = config.clone();
        if std::env::var("CONFIG").is_err() {
            sensor_of(name, &mut picker_config);
        }
        let picker = Picker::new(picker_config).unwrap();
        let done = AtomicUsize::new(0);
        let start = Instant::now();
        let mut rows: Vec<Row> = (from..to)
            .into_par_iter()
            .flat_map_iter(|n| {
                let r = row(&picker, suite, n);
                done.fetch_add(1, Ordering::Relaxed);
                r
            })
            .collect();
        let n = rows.len();
        let answered: Vec<&Row> = rows.iter().filter(|r| r.angle.is_some()).collect();
        let seen = rows.iter().filter(|r| r.answerable).count();
        let seen_answered = rows
            .iter()
            .filter(|r| r.answerable && r.angle.is_some())
            .count();
        let mut angles: Vec<f64> = answered.iter().filter_map(|r| r.angle).collect();
        let share = |f: &dyn Fn(f64) -> bool| {
            100.0 * angles.iter().filter(|&&a| f(a)).count() as f64 / angles.len().max(1) as f64
        };
        let (le10, ge50) = (share(&|a| a <= 10.0), share(&|a| a >= 50.0));
        let mut centers: Vec<f64> = rows
            .iter()
            .filter_map(|r| r.center)
            .map(|c| nalgebra::Vector3::from(c).norm() * 1e3)
            .collect();
        let bias = [0, 1, 2].map(|k| {
            mean(
                &rows
                    .iter()
                    .filter_map(|r| r.center)
                    .map(|c| c[k] * 1e3)
                    .collect::<Vec<_>>(),
            )
        });
        let radii: Vec<f64> = rows
            .iter()
            .filter_map(|r| r.radius)
            .map(|r| r * 1e3)
            .collect();
        let mut feet: Vec<f64> = answered
            .iter()
            .filter_map(|r| r.foot)
            .map(|f| f * 1e3)
            .collect();
        let ms =
            [1, 2, 3].map(|k| quantile(&mut rows.iter().map(|r| r.ms[k]).collect::<Vec<_>>(), 0.5));
        println!(
            "{name:18} {n:5} {:5.1} ({:5.1})  | {:5.2} {:5.2} {:5.2} {:6.2} {:6.2} | {:5.2} {:5.2} {:5.2} | {:5.2} {:5.2} {:5.2} | {:5.2} {:5.2} | {:5.2} | {:.2} {:.2} {:.2}   [{:.1} s]",
            100.0 * answered.len() as f64 / n as f64,
            100.0 * seen_answered as f64 / seen.max(1) as f64,
            mean(&angles),
            quantile(&mut angles, 0.5),
            quantile(&mut angles, 0.95),
            le10,
            ge50,
            mean(&centers),
            quantile(&mut centers, 0.5),
            quantile(&mut centers, 0.95),
            bias[0],
            bias[1],
            bias[2],
            mean(&radii),
            mean(&radii.iter().map(|r| r.abs()).collect::<Vec<_>>()),
            quantile(&mut feet, 0.5),
            ms[0],
            ms[1],
            ms[2],
            start.elapsed().as_secs_f64(),
        );
        if worst > 0 {
            let by_center = std::env::var("BY").is_ok_and(|b| b == "center");
            let off = |r: &Row| {
                r.center
                    .map_or(0.0, |c| nalgebra::Vector3::from(c).norm() * 1e3)
            };
            let key = |r: &Row| {
                if by_center {
                    off(r)
                } else {
                    r.angle.unwrap_or(if r.answerable { 30.0 } else { 0.0 })
                }
            };
            rows.sort_by(|a, b| key(b).total_cmp(&key(a)));
            for r in rows.iter().take(worst) {
                let c = r.center.unwrap_or_default().map(|c| c * 1e3);
                println!(
                    "  #{} {} {:?} angle {:.1} O {:.1} ({:.1} {:.1} {:.1}) dr {:.1} conf {:.2} seen {} | {}",
                    r.number,
                    r.name,
                    r.status,
                    r.angle.unwrap_or(f64::NAN),
                    off(r),
                    c[0],
                    c[1],
                    c[2],
                    r.radius.unwrap_or_default() * 1e3,
                    r.confidence.unwrap_or(f64::NAN),
                    r.answerable,
                    r.text
                );
            }
        }
        let _ = rows.iter().map(|r| r.share).sum::<f64>();
    }
}

fn sensor_of(_suite: &str, _config: &mut Config) {}

/// The candidates of a pick: each with its angle, distance in radii, score and lengths.
fn oracle(pick: &pomona::Pick, truth: &AppleTruth) -> String {
    let Some(apple) = &pick.apple else {
        return String::new();
    };
    let v = |a: [f64; 3]| nalgebra::Vector3::from(a);
    let mut text = String::new();
    for c in pick.candidates.iter().take(4) {
        let angle = truth.direction.map_or(f64::NAN, |d| {
            (v(c.foot) - v(apple.center)).angle(&v(d)).to_degrees()
        });
        text += &format!(
            "[{angle:.0}° {:.2}r b{:.1} {:.2}: {:.0}/{:.0} o{:.0} e{:.0} h{:.0}] ",
            c.distance / apple.radius,
            c.radius * 1e3,
            c.score,
            c.shown * 1e3,
            c.shown_lesser_side * 1e3,
            c.odd * 1e3,
            c.empty * 1e3,
            c.hidden * 1e3
        );
    }
    text
}
