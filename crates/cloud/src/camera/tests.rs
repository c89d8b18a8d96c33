use super::*;
use crate::CloudError;
use pomona_files::FileError;
use proptest::prelude::*;
use std::path::Path;

fn camera(model: &str, coefficients: &[f64]) -> Camera {
    Camera {
        width: 640,
        height: 480,
        fx: 600.0,
        fy: 610.0,
        cx: 320.0,
        cy: 240.0,
        depth_scale: 0.001,
        frame_id: "optical".to_owned(),
        distortion: (!model.is_empty()).then(|| Distortion {
            model: model.to_owned(),
            coefficients: coefficients.to_vec(),
        }),
    }
}

const PLUMB_BOB: [f64; 5] = [-0.28, 0.07, 0.0012, -0.0007, 0.01];
const RATIONAL: [f64; 8] = [0.52, -2.71, 0.0006, -0.0002, 1.51, 0.40, -2.52, 1.43];

const FISHEYE: [f64; 4] = [-0.01, 0.02, -0.003, 0.0005];

fn cameras() -> [Camera; 6] {
    [
        camera("", &[]),
        camera(
            "inverse_brown_conrady",
            &[-0.05, 0.06, 0.0004, 0.0007, -0.02],
        ),
        camera("equidistant", &FISHEYE),
        camera("plumb_bob", &PLUMB_BOB),
        camera("brown_conrady", &PLUMB_BOB),
        camera("rational_polynomial", &RATIONAL),
    ]
}

#[test]
fn projects_as_opencv_does() {
    // cv2.projectPoints of OpenCV 5.0.0 with the same camera.
    let points = [[0.1, -0.2, 1.0], [-0.5, 0.3, 1.25], [0.45, 0.35, 0.9]].map(Point3::from);
    let expected: [(Camera, [(f64, f64); 3]); 2] = [
        (
            camera("plumb_bob", &PLUMB_BOB),
            [
                (379.112_375, 119.798_737_499_999_99),
                (93.438_484_093_337_54, 378.306_058_783_063),
                (589.772_333_796_225_7, 453.746_933_219_251_45),
            ],
        ),
        (
            camera("rational_polynomial", &RATIONAL),
            [
                (380.304_753_960_471_1, 117.386_433_613_708_73),
                (75.483_911_670_807, 389.218_527_160_807_75),
                (628.080_199_168_696_7, 483.796_489_452_393_87),
            ],
        ),
    ];
    for (camera, pixels) in expected {
        for (point, (u, v)) in points.iter().zip(pixels) {
            let (got_u, got_v) = camera.project(point).unwrap();
            assert!(
                (got_u - u).abs() < 1e-9 && (got_v - v).abs() < 1e-9,
                "{got_u} {got_v}"
            );
        }
    }
}

proptest! {
    #[test]
    fn deprojection_undoes_projection(
        u in 0.0..639.0f64, v in 0.0..479.0f64, z in 0.1..5.0f64, which in 0..6usize,
    ) {
        let camera = &cameras()[which];
        let point = camera.deproject(u, v, z);
        prop_assert_eq!(point.z, z);
        let (back_u, back_v) = camera.project(&point).unwrap();
        prop_assert!((back_u - u).abs() < 1e-6 && (back_v - v).abs() < 1e-6);
    }
}

#[test]
fn every_model_is_valid_and_reads_back() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("camera.json");
    for camera in cameras() {
        camera.validate().unwrap();
        camera.write(&path).unwrap();
        assert_eq!(Camera::read(&path).unwrap(), camera);
    }
}

#[test]
fn points_that_no_pixel_sees_have_none() {
    let pinhole = camera("", &[]);
    for z in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(pinhole.project(&Point3::new(0.1, 0.1, z)), None);
    }
    assert_eq!(pinhole.project(&Point3::new(f64::NAN, 0.1, 1.0)), None);
    assert_eq!(pinhole.project(&Point3::new(1e308, 0.0, 1e-308)), None);
    // Barrel distortion folds over beyond x/z = 1/sqrt(3 · 0.3).
    let barrel = camera("plumb_bob", &[-0.3, 0.0, 0.0, 0.0, 0.0]);
    assert!(barrel.project(&Point3::new(1.0, 0.0, 1.0)).is_some());
    assert_eq!(barrel.project(&Point3::new(1.1, 0.0, 1.0)), None);
    assert!(barrel.deproject(2000.0, 240.0, 1.0).x.is_nan());
}

#[test]
fn cameras_that_cannot_be_computed_with_are_refused_by_field() {
    let base = camera("", &[]);
    let error = |c: Camera| c.validate().unwrap_err().to_string();
    assert!(
        error(Camera {
            fx: 0.0,
            ..base.clone()
        })
        .contains("`fx` is 0")
    );
    assert!(
        error(Camera {
            fy: -1.0,
            ..base.clone()
        })
        .contains("`fy`")
    );
    assert!(
        error(Camera {
            cx: f64::NAN,
            ..base.clone()
        })
        .contains("`cx`")
    );
    assert!(
        error(Camera {
            depth_scale: f64::INFINITY,
            ..base.clone()
        })
        .contains("`depth_scale`")
    );
    assert!(error(Camera { width: 0, ..base }).contains("`width`"));
    assert!(error(camera("ftheta", &[0.1; 4])).contains("`ftheta`"));
    let far = Camera {
        cx: 3000.0,
        ..camera("", &[])
    };
    assert!(error(far).contains("away from the axis"));
    assert!(error(camera("plumb_bob", &[0.1; 3])).contains("3 are given"));
    assert!(error(camera("rational_polynomial", &[0.1; 5])).contains("5 are given"));
    assert!(error(camera("plumb_bob", &[f64::NAN; 5])).contains("distortion.coefficients"));
    assert!(
        error(camera("plumb_bob", &[-5.0, 0.0, 0.0, 0.0, 0.0]))
            .contains("no inverse at pixel (0, 0)")
    );
}

#[test]
fn bad_files_are_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("camera.json");
    assert!(matches!(
        Camera::read(&path),
        Err(CloudError::File(FileError::Read { .. }))
    ));
    let zero = r#"{"width":640,"height":480,"fx":0,"fy":610,"cx":320,"cy":240,"depth_scale":0.001,"frame_id":"a"}"#;
    for (bytes, message) in [
        (zero.as_bytes(), "`fx` is 0"),
        (zero.replace("frame_id", "frame").as_bytes(), "`frame`"),
        (
            zero.replace("\"fx\":0", "\"fx\":1e999").as_bytes(),
            "out of range",
        ),
        (b"\xff\xfe", "UTF-8"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let error = Camera::read(&path).unwrap_err().to_string();
        assert!(
            error.contains("camera.json") && error.contains(message),
            "{error}"
        );
    }
    let unwritable = Camera {
        fx: 0.0,
        ..camera("", &[])
    };
    assert!(matches!(
        unwritable.write(&path),
        Err(CloudError::Camera { .. })
    ));
}

#[test]
fn bytes_of_any_kind_are_a_camera_or_an_error() {
    let valid = json::format(&camera("plumb_bob", &PLUMB_BOB));
    for name in ["camera.json", "camera.yaml"] {
        for length in 0..valid.len() {
            let _ = Camera::parse(
                Path::new(name),
                &valid.as_bytes()[..length],
                &CameraOptions::default(),
            );
            let mut changed = valid.clone().into_bytes();
            changed[length] = changed[length].wrapping_add(3);
            let _ = Camera::parse(Path::new(name), &changed, &CameraOptions::default());
        }
    }
}

#[test]
fn fisheye_lenses_project_as_kannala_and_brandt_say() {
    let camera = camera("equidistant", &FISHEYE);
    // At 45° from the axis, in closed form.
    let theta = std::f64::consts::FRAC_PI_4;
    let [k1, k2, k3, k4] = FISHEYE;
    let distance =
        theta + k1 * theta.powi(3) + k2 * theta.powi(5) + k3 * theta.powi(7) + k4 * theta.powi(9);
    let (u, v) = camera.project(&Point3::new(2.0, 0.0, 2.0)).unwrap();
    assert!((u - (320.0 + 600.0 * distance)).abs() < 1e-9 && (v - 240.0).abs() < 1e-9);
    let (x, y) = camera.ray(u, v).unwrap();
    assert!((x - 1.0).abs() < 1e-9 && y.abs() < 1e-9);
}

#[test]
fn the_inverse_model_leads_from_pixels_to_rays() {
    let camera = camera("inverse_brown_conrady", &[-0.05, 0.0, 0.0, 0.0, 0.0]);
    let (x, y) = camera.ray(320.0 + 300.0, 240.0).unwrap();
    assert!((x - 0.5 * (1.0 - 0.05 * 0.25)).abs() < 1e-12 && y.abs() < 1e-12);
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    let dir = tempfile::tempdir().unwrap();
    let written = camera("", &[]);
    let text = format!("\u{feff}{}", json::format(&written));
    for name in ["camera.json", "camera.yaml"] {
        let path = dir.path().join(name);
        if name.ends_with("json") {
            std::fs::write(&path, &text).unwrap();
            assert_eq!(Camera::read(&path).unwrap(), written);
        } else {
            let info = "\u{feff}width: 640\nheight: 480\nk: [600.0, 0.0, 320.0, 0.0, 610.0, 240.0, 0.0, 0.0, 1.0]\n";
            std::fs::write(&path, info).unwrap();
            assert_eq!(Camera::read(&path).unwrap().fx, 600.0);
        }
    }
}
