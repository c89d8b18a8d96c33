//! A broken method must not pass the regression gate: the committed limits and goldens against methods that
//! are spoilt on purpose.

use nalgebra::Vector3;
use pomona::{CheckedFrame, Config, FrameAnswer, Method, PickError, Picker};
use pomona_evaluate::{PickMethod, Subject, evaluate};
use pomona_transforms::Direction;
use std::path::Path;
use xtask_gate::{Finding, Golden, Limits, SuiteLimits, Verdict, failures, judge};

/// How the answers of a method are spoilt.
#[derive(Clone, Copy)]
enum Sabotage {
    None,
    /// Away from the branch in place of towards it.
    Flipped,
    /// The radius 5 % too large.
    Swollen,
    /// Towards any place about the apple.
    RandomBranch,
}

struct Spoilt {
    method: Picker,
    sabotage: Sabotage,
}

impl PickMethod for Spoilt {
    fn name(&self) -> &str {
        self.method.name()
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        let mut answer = self.method.answer(frame, seed)?;
        for (i, apple) in answer.apples.iter_mut().enumerate() {
            match self.sabotage {
                Sabotage::None => {}
                Sabotage::Flipped => {
                    if let Some(pick) = &mut apple.pick {
                        pick.direction = -pick.direction;
                    }
                }
                Sabotage::Swollen => apple.apple.iter_mut().for_each(|a| a.radius_m *= 1.05),
                Sabotage::RandomBranch => {
                    // Points of a Fibonacci lattice on the sphere, in an order that the frame's name decides.
                    let n = frame.frame().id.bytes().map(usize::from).sum::<usize>() * 17 + i;
                    let z = 1.0 - 2.0 * ((n % 97) as f64 + 0.5) / 97.0;
                    let turn = n as f64 * 2.399_963_229_728_653;
                    let ring = (1.0 - z * z).sqrt();
                    if let Some(pick) = &mut apple.pick {
                        let any = Vector3::new(ring * turn.cos(), ring * turn.sin(), z);
                        pick.direction = Direction::new(any).expect("a direction");
                    }
                }
            }
        }
        Ok(answer)
    }
}

/// What the gate says of `lab15` under a method that is spoilt in this way.
fn findings(sabotage: Sabotage) -> Vec<Finding> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let limits = Limits::read(&root.join("xtask/regress.toml")).expect("the limits");
    let suite: &SuiteLimits = limits
        .suites
        .iter()
        .find(|s| s.id() == "lab15.paper")
        .expect("a run of lab15");
    let golden = Golden::read(&root.join("fixtures/golden"), suite).expect("a golden run");

    let subjects = Subject::named(&suite.name, suite.count).expect("a suite");
    let config = Config::default().with(|c| c.method = Method::Paper);
    let method = Spoilt {
        method: Picker::new(config).expect("the default settings make sense"),
        sabotage,
    };
    let evaluation = evaluate(&subjects, &[&method], suite.seed, &|| {}).expect("an evaluation");
    let result = serde_json::to_value(&evaluation.results[0]).expect("JSON");
    judge(&result, suite, golden.as_ref())
}

fn failed(findings: &[Finding]) -> Vec<(&str, Verdict)> {
    failures(findings)
        .map(|f| (f.field.as_str(), f.verdict))
        .collect()
}

#[test]
fn the_method_as_it_is_passes() {
    assert_eq!(failed(&findings(Sabotage::None)), []);
}

#[test]
fn a_flipped_direction_fails() {
    let findings = findings(Sabotage::Flipped);
    let failed = failed(&findings);
    assert!(
        failed.contains(&("angle_mean_deg", Verdict::AboveCeiling)),
        "{failed:?}"
    );
    assert!(
        failed.contains(&("hits_share", Verdict::BelowFloor)),
        "{failed:?}"
    );
}

#[test]
fn a_radius_five_per_cent_too_large_fails() {
    let findings = findings(Sabotage::Swollen);
    let failed = failed(&findings);
    assert!(
        failed.contains(&("radius_bias_mm", Verdict::Worse)),
        "{failed:?}"
    );
}

#[test]
fn a_branch_chosen_at_random_fails() {
    let findings = findings(Sabotage::RandomBranch);
    let failed = failed(&findings);
    assert!(
        failed.contains(&("angle_mean_deg", Verdict::AboveCeiling)),
        "{failed:?}"
    );
}
