//! The whole way from a frame to the gripper in the base's frame, with a simulated calibration.

use pomona::{ApproachConfig, Config, Method, Picker, Robot};
use pomona_evaluate::{
    CalibrationNoise, Evaluation, PickMethod, RobotTrial, Subject, evaluate_with_robot,
};

fn run(methods: &[Method], noise: CalibrationNoise, suite: &str, count: usize) -> Evaluation {
    let subjects = Subject::named(suite, Some(count)).expect("a suite");
    let pickers: Vec<Picker> = methods
        .iter()
        .map(|&method| {
            let config = Config::default().with(|c| c.method = method);
            Picker::new(config).expect("the default settings make sense")
        })
        .collect();
    let methods: Vec<&dyn PickMethod> = pickers.iter().map(|p| p as &dyn PickMethod).collect();
    let robot = Robot::new(ApproachConfig::default()).expect("the default settings make sense");
    let trial = RobotTrial::new(robot, noise);
    evaluate_with_robot(&subjects, &methods, 0, &trial, &|| {}).expect("an evaluation")
}

#[test]
fn without_noise_the_errors_in_the_base_are_those_in_the_camera() {
    let mut exact = CalibrationNoise::default();
    (exact.rotation_rad, exact.translation_m) = (0.0, 0.0);
    let evaluation = run(&[Method::Robust, Method::Paper], exact, "lab15", 5);
    assert_eq!(evaluation.apples.len(), 10);
    for row in &evaluation.apples {
        let base = row.base.as_ref().expect("answered");
        let direction = base.direction.expect("a branch");
        assert!((base.position.total.error - row.center_error.unwrap()).abs() < 1e-9);
        assert!((direction.total.error - row.angle_error.unwrap()).abs() < 1e-9);
        assert!(base.position.calibration.error < 1e-9 && direction.calibration.error < 1e-9);
        if let Some(planned) = &base.planned
            && planned.tilt == Some(0.0)
        {
            let place = planned.position_error.unwrap();
            assert!((place - base.position.total.error).abs() < 1e-12);
            let turn = planned.direction_error.unwrap();
            assert!((turn - direction.total.error).abs() < 1e-9);
        }
    }
}

#[test]
fn with_noise_the_calibration_is_in_the_budget_and_the_same_for_each_method() {
    let noise = CalibrationNoise::default();
    let evaluation = run(&[Method::Robust, Method::Paper], noise, "lab15", 5);
    let [robust, paper] = [0, 1].map(|i| evaluation.results[i].base.as_ref().expect("answers"));
    let term = |of: &pomona_evaluate::BaseResult, name: &str| {
        let found = of.position.iter().find(|t| t.name == name);
        found.expect("a part of the budget").clone()
    };
    let calibration = term(robust, "calibration");
    // 0.5 mm in the median at 0.8 m (docs/calibration.md).
    assert!((0.1e-3..1.5e-3).contains(&calibration.error.median));
    assert!(calibration.stated_rms.is_some());
    // Which centre it acts on differs by millimetres only.
    let other = term(paper, "calibration_translation").rms;
    assert_eq!(term(robust, "calibration_translation").rms, other);
    assert!(term(paper, "total").stated_rms.is_none() && paper.position_coverage.is_none());
    let coverage = robust.position_coverage.as_ref().expect("a covariance");
    assert_eq!((coverage.freedom, coverage.within_95.of), (3, 5));
    // Independent parts: the total lies between the greatest of them and their sum.
    for row in &evaluation.apples {
        let t = row.base.as_ref().expect("answered").position;
        assert!(t.total.error <= t.sphere_center.error + t.calibration.error + 1e-12);
        let parts = t.calibration_rotation.error + t.calibration_translation.error;
        assert!(t.calibration.error <= parts + 1e-12);
    }
    let text = serde_json::to_string(&evaluation).unwrap();
    assert_eq!(
        serde_json::from_str::<Evaluation>(&text).unwrap(),
        evaluation
    );
}
