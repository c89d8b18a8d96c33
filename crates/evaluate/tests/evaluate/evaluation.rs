//! The evaluation as a whole: same answers for any number of threads, several methods side by side, folders.

use pomona::{CheckedFrame, Config, FrameAnswer, Method, PickError, Picker};
use pomona_evaluate::{EvaluateError, Evaluation, PickMethod, Subject, evaluate};
use rayon::ThreadPoolBuilder;

fn picker() -> Picker {
    Picker::new(Config::default().with(|c| c.method = Method::Paper))
        .expect("the default settings make sense")
}

fn run(threads: usize) -> Evaluation {
    let subjects = Subject::named("lab15", Some(4)).expect("a suite");
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    pool.install(|| evaluate(&subjects, &[&picker()], 3, &|| {}))
        .expect("an evaluation")
        .without_timing()
}

#[test]
fn threads_do_not_change_the_outcome() {
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(
        serde_json::to_string(&one).unwrap(),
        serde_json::to_string(&run(3)).unwrap()
    );
}

#[test]
fn what_was_written_reads_back() {
    let evaluation = run(2);
    let text = serde_json::to_string(&evaluation).unwrap();
    assert_eq!(
        serde_json::from_str::<Evaluation>(&text).unwrap(),
        evaluation
    );
    assert_eq!(evaluation.schema, "pomona.evaluation/1");
    let cases: Vec<&str> = evaluation
        .apples
        .iter()
        .map(|row| row.case.as_str())
        .collect();
    assert_eq!(
        cases,
        ["lab-x-90-s0", "lab-x-45-s0", "lab-x0-s0", "lab-x45-s0"]
    );
}

/// Answers nothing.
struct Silent(Picker);

impl PickMethod for Silent {
    fn name(&self) -> &'static str {
        "silent"
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        let mut answer = self.0.answer(frame, seed)?;
        for apple in &mut answer.apples {
            apple.status = pomona::Status::NoBranch;
            (apple.pick, apple.branch) = (None, None);
        }
        Ok(answer)
    }
}

#[test]
fn a_method_that_refuses_what_can_be_seen_has_no_hits_and_is_wrong_to() {
    let subjects = Subject::named("lab15", Some(3)).unwrap();
    let (paper, silent) = (picker(), Silent(picker()));
    let evaluation = evaluate(&subjects, &[&paper, &silent], 0, &|| {}).unwrap();
    let [answers, refuses] = evaluation.results.as_slice() else {
        panic!("one entry for each method");
    };
    assert_eq!((answers.answered.count, answers.refusals.wrong), (3, 0));
    assert_eq!(
        (
            refuses.answered.count,
            refuses.refusals.wrong,
            refuses.refusals.hits.count
        ),
        (0, 3, 0)
    );
    assert!(refuses.angle.is_none() && refuses.center_error.is_some());
    let [pair] = evaluation.comparisons.as_slice() else {
        panic!("one pair of methods");
    };
    assert_eq!(
        (pair.only_first_answered, pair.only_second_answered),
        (3, 0)
    );
    let centers = pair.center_difference.as_ref().unwrap();
    assert_eq!((centers.count, centers.max), (3, 0.0));
}

#[test]
fn folders_give_what_memory_gives() {
    let folder = tempfile::tempdir().unwrap();
    let suite = pomona_scenes::Suite::named("lab15").unwrap();
    for case in suite.cases().take(2) {
        case.scene().write(folder.path().join(&case.name)).unwrap();
    }
    let in_memory = evaluate(&Subject::of_suite(suite, Some(2)), &[&picker()], 0, &|| {}).unwrap();
    let on_disk = Subject::of_folder(folder.path(), None).unwrap();
    let from_disk = evaluate(&on_disk, &[&picker()], 0, &|| {}).unwrap();
    for row in &in_memory.apples {
        let same = from_disk
            .apples
            .iter()
            .find(|other| other.case == row.case)
            .unwrap();
        assert_eq!(
            (row.direction, row.angle_error),
            (same.direction, same.angle_error),
            "{}",
            row.case
        );
    }
    let one = Subject::of_folder(folder.path().join("lab-x-90-s0"), None).unwrap();
    assert_eq!(one.len(), 1);
}

#[test]
fn what_has_no_truth_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let error = Subject::of_folder(folder.path(), None).unwrap_err();
    assert!(matches!(error, EvaluateError::NoTruth { .. }));
    let error = Subject::named("lab16", None).unwrap_err().to_string();
    assert!(
        error.contains("lab16") && error.contains("lab150"),
        "{error}"
    );
}
