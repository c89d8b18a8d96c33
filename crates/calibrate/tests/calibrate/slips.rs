//! Slips of whoever writes samples: each is named, or corrected where the file itself tells it.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use pomona_calibrate::{
    CalibrateError, Options, PoseSample, SampleOptions, SampleSet, Samples, WarningCode,
    calibrate_eye_to_hand,
};
use pomona_transforms::Transform;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::fmt::Write;

/// A flange's pose and a board's, as the samples of a file have them.
type Pair = [Isometry3<f64>; 2];
/// Where the camera is, and the warnings.
type Answer = (Isometry3<f64>, Vec<(WarningCode, String)>);

/// Stops of an arm with a board on its flange, and where the camera is. The board's poses are off by a millimetre and a
/// tenth of a degree.
fn stops() -> (Vec<Pair>, Isometry3<f64>) {
    let rng = &mut ChaCha8Rng::seed_from_u64(5);
    let camera = Isometry3::new(Vector3::new(0.4, -0.3, 1.1), Vector3::new(-1.2, 1.1, -1.2));
    let board = Isometry3::new(Vector3::new(0.05, 0.02, 0.1), Vector3::new(0.1, 0.2, 1.0));
    let mut vector = |size: f64| Vector3::from_fn(|_, _| rng.random_range(-size..size));
    let pairs = (0..15).map(|_| {
        let flange = Isometry3::new(Vector3::new(1.0, 0.0, 1.1) + vector(0.25), vector(0.5));
        let seen = camera.inv_mul(&(flange * board));
        let moved = seen.translation.vector + vector(1e-3);
        let turned = UnitQuaternion::from_scaled_axis(vector(2e-3)) * seen.rotation;
        [
            flange,
            Isometry3::from_parts(Translation3::from(moved), turned),
        ]
    });
    (pairs.collect(), camera)
}

fn samples(pairs: &[Pair]) -> Vec<PoseSample> {
    let sample = |(i, [flange, board]): (usize, &Pair)| {
        PoseSample::new(
            format!("s{i}"),
            Transform::from_isometry(flange).unwrap(),
            Transform::from_isometry(board).unwrap(),
        )
    };
    pairs.iter().enumerate().map(sample).collect()
}

fn calibrate(samples: &[PoseSample]) -> Result<Answer, CalibrateError> {
    let rng = &mut ChaCha8Rng::seed_from_u64(0);
    let found = calibrate_eye_to_hand(samples, &Options::default(), rng)?;
    let warnings = found.quality.warnings.into_iter();
    Ok((
        found.camera.transform.isometry(),
        warnings.map(|w| (w.code, w.message)).collect(),
    ))
}

fn off(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.to_homogeneous() - b.to_homogeneous()).amax()
}

#[test]
fn good_samples_raise_no_doubt() {
    let (pairs, camera) = stops();
    let (found, warnings) = calibrate(&samples(&pairs)).unwrap();
    assert!(off(&found, &camera) < 3e-3);
    assert_eq!(warnings, []);
}

/// The pose whose quaternion is read x y z w from numbers in the order w x y z.
fn misread(pose: &Isometry3<f64>) -> Isometry3<f64> {
    let [x, y, z, w]: [f64; 4] = pose.rotation.coords.into();
    let wrong = nalgebra::Quaternion::new(z, w, x, y);
    Isometry3::from_parts(pose.translation, UnitQuaternion::new_normalize(wrong))
}

#[test]
fn w_first_is_named_after_trying_it() {
    let (pairs, _) = stops();
    for (robot, camera, words) in [
        (true, true, "both poses"),
        (false, true, "`camera_from_target`"),
        (true, false, "`robot_from_flange`"),
    ] {
        let wrong: Vec<Pair> = pairs
            .iter()
            .map(|[flange, board]| {
                [
                    if robot { misread(flange) } else { *flange },
                    if camera { misread(board) } else { *board },
                ]
            })
            .collect();
        let error = calibrate(&samples(&wrong)).unwrap_err();
        assert!(matches!(error, CalibrateError::WFirst { .. }), "{error}");
        let message = error.to_string();
        assert!(
            message.contains(words) && message.contains("w comes first"),
            "{message}"
        );
    }
}

#[test]
fn rows_one_off_are_named_after_trying_it() {
    let (pairs, _) = stops();
    let count = pairs.len();
    for (offset, rows, words) in [
        (1, 1, "moved down by 1"),
        (count - 1, 1, "moved up by 1"),
        (2, 2, "moved down by 2"),
    ] {
        let wrong: Vec<Pair> = (0..count)
            .map(|i| [pairs[i][0], pairs[(i + offset) % count][1]])
            .collect();
        let error = calibrate(&samples(&wrong)).unwrap_err();
        assert!(
            matches!(error, CalibrateError::Shifted { rows: r, .. } if r == rows),
            "{error}"
        );
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn samples_that_agree_in_no_way_get_no_invented_cause() {
    let (pairs, _) = stops();
    let rng = &mut ChaCha8Rng::seed_from_u64(8);
    let mut vector = |size: f64| Vector3::from_fn(|_, _| rng.random_range(-size..size));
    let wrong: Vec<Pair> = pairs
        .iter()
        .map(|[flange, _]| [*flange, Isometry3::new(vector(1.0), vector(2.0))])
        .collect();
    let error = calibrate(&samples(&wrong)).unwrap_err();
    let is_plain = matches!(
        error,
        CalibrateError::NoConsensus { .. } | CalibrateError::Undetermined
    );
    assert!(is_plain, "{error}");
}

#[test]
fn a_board_of_another_size_gives_the_factor_that_fits() {
    let (pairs, _) = stops();
    for size in [1.03, 0.97, 1.008] {
        let wrong: Vec<Pair> = pairs
            .iter()
            .map(|[flange, board]| {
                let place = board.translation.vector * size;
                [*flange, Isometry3::from_parts(place.into(), board.rotation)]
            })
            .collect();
        let (_, warnings) = calibrate(&samples(&wrong)).unwrap();
        let [(code, message)] = &warnings[..] else {
            panic!("{size}: {warnings:?}");
        };
        assert_eq!(*code, WarningCode::BoardScale);
        let factor = message.split("multiplied by ").nth(1).unwrap();
        let factor: f64 = factor.split(' ').next().unwrap().parse().unwrap();
        assert!((factor * size - 1.0).abs() < 4e-3, "{size}: {message}");
    }
}

fn read(name: &str, text: &str, options: &SampleOptions) -> Result<SampleSet, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    SampleSet::read_with(&path, options).map_err(|e| e.to_string())
}

/// Checks that a file holds the stops.
#[track_caller]
fn holds(name: &str, text: &str, options: &SampleOptions, pairs: &[Pair], warnings: usize) {
    let set = read(name, text, options).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let Samples::Poses(found) = &set.samples else {
        panic!("poses");
    };
    assert_eq!(found.len(), pairs.len());
    for (sample, [flange, board]) in found.iter().zip(pairs) {
        assert!(
            off(&sample.robot_from_flange.isometry(), flange) < 1e-6,
            "{name}"
        );
        assert!(
            off(&sample.camera_from_target.isometry(), board) < 1e-6,
            "{name}"
        );
    }
    assert_eq!(set.warnings.len(), warnings, "{:?}", set.warnings);
    assert!(
        set.warnings
            .iter()
            .all(|w| w.code == WarningCode::SampleUnitsAssumed && w.message.starts_with(name))
    );
}

/// Tables with the numbers that `numbers` makes of a pose.
fn table(
    pairs: &[Pair],
    header: &str,
    between: &str,
    numbers: impl Fn(&Isometry3<f64>) -> Vec<f64>,
) -> String {
    let mut text = header.to_owned() + "\n";
    for (i, pair) in pairs.iter().enumerate() {
        let _ = write!(text, "s{i}");
        for number in pair.iter().flat_map(&numbers) {
            let _ = write!(text, "{between}{number:.9}");
        }
        text.push('\n');
    }
    text
}

/// Angles about z, the new y and the new x, degrees: nalgebra's are roll, pitch, yaw.
fn abc(pose: &Isometry3<f64>) -> [f64; 3] {
    let (roll, pitch, yaw) = pose.rotation.euler_angles();
    [yaw, pitch, roll].map(f64::to_degrees)
}

#[test]
fn tables_of_other_programs_are_read() {
    let (pairs, _) = stops();
    let none = SampleOptions::default();
    let mm = |pose: &Isometry3<f64>| -> Vec<f64> {
        pose.translation.vector.iter().map(|c| c * 1e3).collect()
    };
    let kuka = |pose: &Isometry3<f64>| [mm(pose), abc(pose).to_vec()].concat();
    let header = "id,x,y,z,a,b,c,tx,ty,tz,ta,tb,tc";
    holds(
        "kuka.csv",
        &table(&pairs, header, ",", kuka),
        &none,
        &pairs,
        4,
    );
    let mut said = none;
    said.lengths = Some(pomona_calibrate::LengthUnit::Millimetres);
    said.angles = Some(pomona_calibrate::AngleUnit::Degrees);
    holds(
        "kuka.csv",
        &table(&pairs, header, ",", kuka),
        &said,
        &pairs,
        0,
    );

    let own = "id,robot_from_flange_x_m,robot_from_flange_y_m,robot_from_flange_z_m,robot_from_flange_qx,robot_from_flange_qy,\
        robot_from_flange_qz,robot_from_flange_qw,camera_from_target_x_m,camera_from_target_y_m,camera_from_target_z_m,\
        camera_from_target_qx,camera_from_target_qy,camera_from_target_qz,camera_from_target_qw";
    let quaternion = |pose: &Isometry3<f64>| {
        let [x, y, z, w]: [f64; 4] = pose.rotation.coords.into();
        [pose.translation.vector.as_slice(), &[x, y, z, w]].concat()
    };
    let semicolons = table(&pairs, &own.replace(',', ";"), ";", quaternion);
    holds("semicolons.csv", &semicolons, &none, &pairs, 0);
    holds(
        "commas.csv",
        &semicolons.replace('.', ","),
        &none,
        &pairs,
        0,
    );
    let w_first = |pose: &Isometry3<f64>| {
        let [x, y, z, w]: [f64; 4] = pose.rotation.coords.into();
        [pose.translation.vector.as_slice(), &[w, x, y, z]].concat()
    };
    let mut said = none;
    said.rotations = Some("quaternion-wxyz".parse().unwrap());
    holds("w.csv", &table(&pairs, own, ",", w_first), &said, &pairs, 0);

    let vector = |pose: &Isometry3<f64>| {
        [pose.translation.vector, pose.rotation.scaled_axis()]
            .iter()
            .flat_map(|v| v.iter().copied())
            .collect()
    };
    let header = "id,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad,target_x_m,target_y_m,target_z_m,target_rx_rad,target_ry_rad,target_rz_rad";
    let text = table(&pairs, header, ",", vector);
    let unsaid = read("vectors.csv", &text, &none).unwrap_err();
    assert!(
        unsaid.contains("--rotations") && unsaid.contains("rotation vector"),
        "{unsaid}"
    );
    said.rotations = Some("rotation-vector".parse().unwrap());
    holds("vectors.csv", &text, &said, &pairs, 0);
    said.lengths = Some(pomona_calibrate::LengthUnit::Millimetres);
    assert!(
        read("vectors.csv", &text, &said)
            .unwrap_err()
            .contains("columns say metres")
    );
}

#[test]
fn samples_of_ros_programs_are_read() {
    let (pairs, _) = stops();
    let matrix = |pose: &Isometry3<f64>| {
        let m = pose.to_homogeneous();
        let rows = (0..16).map(|i| format!("{:.9}", m[(i / 4, i % 4)]));
        format!("[{}]", rows.collect::<Vec<_>>().join(", "))
    };
    let mut moveit = String::new();
    for [flange, board] in &pairs {
        let (flange, board) = (matrix(flange), matrix(board));
        let _ = write!(
            moveit,
            "- effector_wrt_world: {flange}\n  object_wrt_sensor: {board}\n"
        );
    }
    let none = SampleOptions::default();
    holds("moveit.yaml", &moveit, &none, &pairs, 0);
    let rigid = |pose: &Isometry3<f64>| {
        let (t, q) = (pose.translation.vector, pose.rotation.coords);
        format!(
            "{{translation: {{x: {:.9}, y: {:.9}, z: {:.9}}}, rotation: {{x: {:.9}, y: {:.9}, z: {:.9}, w: {:.9}}}}}",
            t.x, t.y, t.z, q.x, q.y, q.z, q.w
        )
    };
    let mut easy = "samples:\n".to_owned();
    for [flange, board] in &pairs {
        let _ = write!(
            easy,
            "- robot: {}\n  tracking: {}\n",
            rigid(flange),
            rigid(board)
        );
    }
    holds("easy_handeye.yaml", &easy, &none, &pairs, 0);
    holds(
        "easy_handeye.yaml",
        &easy.replace("tracking", "optical"),
        &none,
        &pairs,
        0,
    );
    let mut said = none;
    said.rotations = Some("rpy".parse().unwrap());
    assert!(
        read("easy.yaml", &easy, &said)
            .unwrap_err()
            .contains("for CSV")
    );
    let short = moveit.replacen(", 1.000000000]", "]", 1);
    let fault = read("moveit.yaml", &short, &none).unwrap_err();
    assert!(
        fault.contains("sample 1") && fault.contains("15 numbers"),
        "{fault}"
    );
}
