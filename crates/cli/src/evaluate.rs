//! `pomona evaluate`: methods against truth and against strokes of wood, fitted radii against calipers, and detectors
//! and segmenters against labels.

mod arguments;
mod calipers;
mod calipers_text;
mod detection;
mod detection_text;
mod methods;
mod modes;
mod real;
mod real_arguments;
mod real_pictures;
mod real_text;
mod results;
mod robot;
mod robot_text;
mod segmentation;
mod segmentation_text;
mod suites;
mod suites_text;
mod text_table;
mod worst_sheet;

use crate::terminal::Terminal;
use methods::pickers;
use pomona_evaluate::PickMethod;

pub(crate) use arguments::EvaluateArguments;
pub(crate) use modes::check_mode;

pub(crate) fn run(arguments: &EvaluateArguments, terminal: Terminal) -> anyhow::Result<()> {
    if let Some(labelled) = &arguments.detection.detection {
        let (count, seed) = (arguments.count, arguments.seed);
        return detection::run(
            &arguments.detection,
            labelled,
            count,
            seed,
            &arguments.results,
            terminal,
        );
    }
    if let Some(folder) = &arguments.segmentation.segmentation {
        return segmentation::run(
            &arguments.segmentation,
            arguments.detection.settings(),
            folder,
            (arguments.count, arguments.seed),
            &arguments.results,
            terminal,
        );
    }
    let pickers = pickers(arguments)?;
    let methods: Vec<&dyn PickMethod> = pickers.iter().map(|p| p as &dyn PickMethod).collect();
    if arguments.real.real {
        return real::run(arguments, &methods, terminal);
    }
    match &arguments.calipers {
        Some(file) => calipers::run(arguments, file, &methods, terminal),
        None => suites::run(arguments, &methods, terminal),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pick::PICKS;
    use crate::settings::SettingValues;
    use detection::DetectionArguments;
    use real_arguments::RealArguments;
    use results::{REPORT, Results};
    use robot::RobotArguments;
    use segmentation::SegmentationArguments;
    use std::path::PathBuf;
    use suites::{APPLES, EVALUATION};

    fn arguments(methods: &[&str]) -> EvaluateArguments {
        EvaluateArguments {
            subjects: vec!["lab15".to_owned()],
            results: Results {
                out: PathBuf::new(),
                json: false,
            },
            methods: methods.iter().map(ToString::to_string).collect(),
            variants: Vec::new(),
            seed: 0,
            count: Some(1),
            calipers: None,
            robot: RobotArguments {
                robot: None,
                calibration_noise_deg: 0.2,
                calibration_noise_mm: 1.0,
                calibration_poses: 15,
            },
            real: RealArguments::default(),
            detection: DetectionArguments::default(),
            segmentation: SegmentationArguments::default(),
            settings: SettingValues::default(),
        }
    }

    #[test]
    fn each_method_once_and_by_its_name() {
        assert_eq!(pickers(&arguments(&[])).unwrap().len(), 1);
        assert_eq!(pickers(&arguments(&["paper"])).unwrap()[0].name(), "paper");
        let Err(twice) = pickers(&arguments(&["paper", "paper"])) else {
            panic!("one method twice");
        };
        assert!(twice.to_string().contains("twice"));
    }

    #[test]
    fn a_variant_bears_the_name_of_its_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("no-box.toml");
        std::fs::write(&path, "method = \"robust\"\n[robust]\nbox_weight = 0.0\n").unwrap();
        let mut arguments = arguments(&["robust"]);
        arguments.variants = vec![path.clone()];
        let named = pickers(&arguments).unwrap();
        let names: Vec<&str> = named.iter().map(PickMethod::name).collect();
        assert_eq!(names, ["robust", "no-box"]);
        assert_eq!(named[1].picker.config().robust.box_weight, 0.0);
        arguments.variants.push(path);
        let Err(twice) = pickers(&arguments) else {
            panic!("one name twice");
        };
        assert!(twice.to_string().contains("no-box"));
    }

    #[test]
    fn a_run_writes_its_files_and_may_be_repeated() {
        let dir = tempfile::tempdir().unwrap();
        let mut arguments = arguments(&["paper"]);
        arguments.results.out = dir.path().join("out");
        arguments.results.json = true;
        let terminal = Terminal::new(clap::ColorChoice::Never);
        run(&arguments, terminal).unwrap();
        run(&arguments, terminal).unwrap();
        for name in [EVALUATION, APPLES, REPORT] {
            assert!(arguments.results.out.join(name).is_file(), "{name}");
        }
        arguments.results.out = dir.path().join("picks");
        std::fs::create_dir(&arguments.results.out).unwrap();
        std::fs::write(arguments.results.out.join(PICKS), "{}").unwrap();
        let refused = run(&arguments, terminal).unwrap_err().to_string();
        assert!(
            refused.contains("picks") && refused.contains("--out"),
            "{refused}"
        );
    }

    #[test]
    fn a_robot_is_measured_in_the_base_and_bad_noise_refused() {
        let dir = tempfile::tempdir().unwrap();
        let mut arguments = arguments(&["robust"]);
        arguments.results.out = dir.path().join("out");
        arguments.robot.robot = Some(None);
        let terminal = Terminal::new(clap::ColorChoice::Never);
        run(&arguments, terminal).unwrap();
        let text = std::fs::read_to_string(arguments.results.out.join(EVALUATION)).unwrap();
        let evaluation: pomona_evaluate::Evaluation = serde_json::from_str(&text).unwrap();
        let page = suites_text::tables(&evaluation, terminal);
        assert!(
            page.contains("sphere center") && page.contains("NEES"),
            "{page}"
        );
        arguments.robot.calibration_noise_mm = -1.0;
        let refused = run(&arguments, terminal).unwrap_err().to_string();
        assert!(refused.contains("-0.001"), "{refused}");
    }

    #[test]
    fn what_is_no_subject_is_refused_with_the_suites() {
        let mut arguments = arguments(&[]);
        arguments.subjects = vec!["lab16".to_owned()];
        let terminal = Terminal::new(clap::ColorChoice::Never);
        let refused = run(&arguments, terminal).unwrap_err().to_string();
        assert!(
            refused.contains("lab16") && refused.contains("lab150"),
            "{refused}"
        );
    }
}
