//! The planes of a point cloud, largest first, out of a PCD file (ASCII, binary or compressed).
//!
//! `cargo run --release -p pomona-ransac --example plane_pcd [FILE [THRESHOLD]]`
//!
//! The threshold is in the file's unit, 0.02 unless given. Without a file, or with `--demo`, a room's
//! corner is made, written to the folder for temporary files, read back and taken apart.

use pcd_rs::{DataKind, DynReader, DynRecord, Field, Schema, ValueKind, ViewPoint, WriterInit};
use pomona_ransac::{
    Candidates, Confidence, Ended, Estimator, Extraction, LeastSquares, Msac, Ransac, RansacError,
    Sequential, Shuffle, Statistical,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::error::Error;
use std::ops::Range;
use std::path::Path;

type Vector = [f64; 3];

fn dot([a, b, c]: Vector, [x, y, z]: Vector) -> f64 {
    a * x + b * y + c * z
}

fn minus([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [a - x, b - y, c - z]
}

fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// The same direction with length 1; `None` without a direction.
fn unit(v: Vector) -> Option<Vector> {
    let length = dot(v, v).sqrt();
    (length.is_normal()).then(|| v.map(|c| c / length))
}

/// The points p with normal · p = offset.
#[derive(Clone, Debug)]
struct Plane {
    normal: Vector,
    offset: f64,
}

struct Points(Vec<Vector>);

impl Estimator for Points {
    type Model = Plane;
    const SAMPLE_SIZE: usize = 3;

    fn len(&self) -> usize {
        self.0.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Plane>) {
        let [a, b, c] = [sample[0], sample[1], sample[2]].map(|i| self.0[i]);
        // Three points on a line have no direction across them: no plane.
        if let Some(normal) = unit(cross(minus(b, a), minus(c, a))) {
            let offset = dot(normal, a);
            candidates.push(Plane { normal, offset });
        }
    }

    /// The plane through the centroid, across the direction of least scatter.
    fn refit(&self, inliers: &[usize], current: &Plane) -> Option<Plane> {
        let n = inliers.len() as f64;
        let center = [0, 1, 2].map(|k| inliers.iter().map(|&i| self.0[i][k]).sum::<f64>() / n);
        let mut scatter = [[0.0; 3]; 3];
        for &i in inliers {
            let d = minus(self.0[i], center);
            for (row, r) in scatter.iter_mut().zip(d) {
                for (entry, c) in row.iter_mut().zip(d) {
                    *entry += r * c / n;
                }
            }
        }
        // The scatter's cofactors are its inverse times a number, and exist without the inverse: their
        // largest direction is the scatter's smallest, and powers of them turn to it.
        let [x, y, z] = scatter;
        let cofactors = [cross(y, z), cross(z, x), cross(x, y)];
        let mut normal = current.normal;
        for _ in 0..20 {
            normal = unit(cofactors.map(|row| dot(row, normal)))?;
        }
        let offset = dot(normal, center);
        Some(Plane { normal, offset })
    }

    fn residuals(&self, plane: &Plane, block: Range<usize>, out: &mut [f64]) {
        for (r, &p) in out.iter_mut().zip(&self.0[block]) {
            *r = (dot(plane.normal, p) - plane.offset).abs();
        }
    }
}

/// Up to `most` planes of at least `least` points, each taken away before the next is looked for.
fn planes(
    points: &[Vector],
    threshold: f64,
    most: usize,
    least: usize,
    rng: &mut ChaCha8Rng,
) -> Result<Extraction<Plane>, RansacError> {
    let search = Ransac::new(Msac::within(threshold))
        .local_optimization(LeastSquares::default())
        .preemption(Statistical::with_error(0.01))
        .stopping(Confidence::new(0.99, 20_000));
    let found = Sequential::default()
        .max_structures(most)
        .min_inliers(least)
        .run(points.len(), |left| {
            search.run(&Points(left.iter().map(|&i| points[i]).collect()), rng)
        });
    match found.ended {
        Ended::NoModel(error) if found.structures.is_empty() => Err(error),
        // Nothing large enough was left: that is how it should end.
        _ => Ok(found),
    }
}

/// The points of a file; those without a finite place are left out.
fn read(path: &Path) -> Result<Vec<Vector>, Box<dyn Error>> {
    let reader = DynReader::open(path).map_err(|e| format!("{}: {e}", path.display()))?;
    // Padding is declared, but no record holds it.
    let fields = reader.meta().field_defs.iter().filter(|f| !f.is_padding());
    let column = |name: &str| {
        let at = fields.clone().position(|field| field.name == name);
        at.ok_or_else(|| format!("{}: no field `{name}`", path.display()))
    };
    let columns = [column("x")?, column("y")?, column("z")?];
    let mut points = Vec::new();
    for record in reader {
        let DynRecord(values) = record?;
        let point = columns.map(|column| match values.get(column) {
            Some(Field::F32(v)) => v.first().map_or(f64::NAN, |&v| f64::from(v)),
            Some(Field::F64(v)) => v.first().copied().unwrap_or(f64::NAN),
            _ => f64::NAN,
        });
        if point.iter().all(|c| c.is_finite()) {
            points.push(point);
        }
    }
    Ok(points)
}

/// A floor, two walls and clutter, in metres, row by row as a scanner gives them.
fn corner(rng: &mut ChaCha8Rng) -> Vec<Vector> {
    let mut points = Vec::new();
    let mut sheet = |count: usize, place: fn(f64, f64, f64) -> Vector| {
        for _ in 0..count {
            let [a, b] = [0, 1].map(|_| rng.random_range(0.0..3.0));
            points.push(place(a, b, rng.random_range(-0.01..0.01)));
        }
    };
    sheet(6000, |a, b, off| [a, b, off]);
    sheet(4000, |a, b, off| [a, 3.0 + off, b]);
    // A wall that leans by one in ten.
    sheet(3000, |a, b, off| [3.0 + 0.1 * b + off, a, b]);
    for _ in 0..3000 {
        points.push([0, 1, 2].map(|_| rng.random_range(0.0..3.0)));
    }
    points
}

fn write(path: &Path, points: &[Vector], data_kind: DataKind) -> Result<(), Box<dyn Error>> {
    let fields = ["x", "y", "z"].map(|name| (name, ValueKind::F32, 1));
    let mut writer = WriterInit {
        width: points.len() as u64,
        height: 1,
        viewpoint: ViewPoint::default(),
        data_kind,
        schema: Some(Schema::from_iter(fields)),
        version: None,
    }
    .create::<DynRecord, _>(path)?;
    for point in points {
        let record = point.map(|c| Field::F32(vec![c as f32])).to_vec();
        writer.push(&DynRecord(record))?;
    }
    Ok(writer.finish()?)
}

/// Reads the file, and prints its planes.
fn segment(path: &Path, threshold: f64) -> Result<Extraction<Plane>, Box<dyn Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let points = read(path)?;
    // In random order, because `Statistical` judges by the first few hundred.
    let order = Shuffle::new(points.len(), &mut rng);
    let points = order.apply(&points);
    let least = points.len().div_ceil(20).max(100);
    let found = planes(&points, threshold, 6, least, &mut rng)?;

    println!("{}: {} points", path.display(), points.len());
    println!("plane   normal                        offset   points      rms");
    for (number, report) in (1..).zip(&found.structures) {
        let Plane { normal, offset } = report.model;
        let [x, y, z] = normal;
        println!(
            "{number:5}   ({x:7.4}, {y:7.4}, {z:7.4}) {offset:9.4} {:8} {:8.5}",
            report.inliers.len(),
            report.residuals.rms
        );
    }
    println!("on no plane: {} points\n", found.rest.len());
    Ok(found)
}

/// Writes the made corner in each format, and finds its three planes in each file.
fn demo() -> Result<(), Box<dyn Error>> {
    let points = corner(&mut ChaCha8Rng::seed_from_u64(1));
    let formats = [
        ("ascii", DataKind::Ascii),
        ("binary", DataKind::Binary),
        ("compressed", DataKind::BinaryCompressed),
    ];
    for (name, kind) in formats {
        let file = format!("pomona-ransac-{name}-{}.pcd", std::process::id());
        let path = std::env::temp_dir().join(file);
        let found = write(&path, &points, kind).and_then(|()| segment(&path, 0.02));
        std::fs::remove_file(&path)?;
        let found = found?;

        let lean = 1.01_f64.sqrt();
        let truth = [
            ([0.0, 0.0, 1.0], 0.0),
            ([0.0, 1.0, 0.0], 3.0),
            ([1.0 / lean, 0.0, -0.1 / lean], 3.0 / lean),
        ];
        assert_eq!(found.structures.len(), truth.len());
        for (report, (normal, offset)) in found.structures.iter().zip(truth) {
            let plane = &report.model;
            let side = dot(plane.normal, normal).signum();
            let turn = cross(plane.normal, normal);
            assert!(dot(turn, turn).sqrt().asin().to_degrees() < 0.1);
            assert!((side * plane.offset - offset).abs() < 0.005);
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    match arguments.next() {
        Some(file) if file != "--demo" => {
            let threshold = arguments.next().map_or(Ok(0.02), |given| {
                let number = given.parse();
                number.map_err(|e| format!("threshold `{given}`: {e}"))
            })?;
            segment(Path::new(&file), threshold)?;
            Ok(())
        }
        _ => demo(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_corners_planes_are_found() {
        super::demo().unwrap();
    }
}
