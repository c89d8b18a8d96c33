use crate::field::{Better, Field};
use crate::golden::Golden;
use crate::limits::{FieldLimits, SuiteLimits};
use serde_json::Value;

/// One field of one run: what it was, what it is, and what to think of it. Values in the unit of the field's name.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Suite and method.
    pub run: String,
    /// Name of the field, and of the row where it has several.
    pub field: String,
    /// The golden value.
    pub golden: Option<f64>,
    /// The value now.
    pub now: Option<f64>,
    /// What is asked of it.
    pub limits: FieldLimits,
    /// What to think of it.
    pub verdict: Verdict,
}

/// What to think of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within its tolerance of the golden value, and within its limits.
    Same,
    /// Better than the golden value by more than the tolerance: bless it.
    Better,
    /// Worse than the golden value by more than the tolerance.
    Worse,
    /// Below its floor.
    BelowFloor,
    /// Above its ceiling.
    AboveCeiling,
    /// The run did not give it.
    Missing,
    /// No golden value to compare it with: bless one.
    NoGolden,
}

impl Verdict {
    /// Whether the gate closes.
    pub fn fails(self) -> bool {
        !matches!(self, Self::Same | Self::Better)
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::Better => "better",
            Self::Worse => "WORSE",
            Self::BelowFloor => "BELOW FLOOR",
            Self::AboveCeiling => "ABOVE CEILING",
            Self::Missing => "MISSING",
            Self::NoGolden => "NO GOLDEN",
        }
    }
}

/// Judges one suite's result (an entry of `results` in `evaluation.json`) field by field.
pub fn judge(result: &Value, limits: &SuiteLimits, golden: Option<&Golden>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let run = limits.id();
    // The same number of cases and the same seed, or the values say nothing of each other.
    let golden = golden.filter(|golden| {
        result.get("cases").and_then(Value::as_u64) == Some(golden.cases)
            && golden.seed == limits.seed
    });
    for (name, &asked) in &limits.fields {
        let Some(field) = Field::named(name) else {
            continue;
        };
        let finding = |row: Option<&str>, golden: Option<f64>, now: Option<f64>| Finding {
            run: run.clone(),
            field: row.map_or_else(|| name.clone(), |row| format!("{name} {row}")),
            golden,
            now,
            limits: asked,
            verdict: verdict(field, asked, golden, now),
        };
        let values = field.values(result);
        let before = |key: &str| {
            golden
                .and_then(|g| g.values.get(key))
                .map(|v| v * field.per_si)
        };
        if values.is_empty() {
            findings.push(finding(None, None, None));
        }
        for (key, value) in &values {
            findings.push(finding(
                row_of(field, key),
                before(key),
                Some(value * field.per_si),
            ));
        }
        // A row that was there and is gone would otherwise pass unseen.
        let gone = golden
            .into_iter()
            .flat_map(|g| g.values.keys())
            .filter(|key| row_of(field, key).is_some() && !values.iter().any(|(k, _)| k == *key));
        findings.extend(gone.map(|key| finding(row_of(field, key), before(key), None)));
    }
    findings
}

/// The findings that close the gate.
pub fn failures(findings: &[Finding]) -> impl Iterator<Item = &Finding> {
    findings.iter().filter(|finding| finding.verdict.fails())
}

/// The row of a key of a field with rows.
fn row_of<'a>(field: &Field, key: &'a str) -> Option<&'a str> {
    let (array, inner) = field.pointer.split_once("/*")?;
    key.strip_prefix(array.trim_start_matches('/'))?
        .strip_prefix('/')?
        .strip_suffix(inner)
}

fn verdict(field: &Field, limits: FieldLimits, golden: Option<f64>, now: Option<f64>) -> Verdict {
    let Some(now) = now else {
        return Verdict::Missing;
    };
    // `!(a <= b)` closes the gate on NaN too.
    if limits.ceiling.is_some_and(|ceiling| !(now <= ceiling)) {
        return Verdict::AboveCeiling;
    }
    if limits.floor.is_some_and(|floor| !(now >= floor)) {
        return Verdict::BelowFloor;
    }
    let Some(tolerance) = limits.tolerance else {
        return Verdict::Same;
    };
    let Some(golden) = golden else {
        return Verdict::NoGolden;
    };
    let worse = match field.better {
        Better::Less => now - golden,
        Better::More => golden - now,
        Better::NearZero => now.abs() - golden.abs(),
    };
    // What the golden file's digits and another build of the same code may differ by is no move.
    let slack = tolerance + 1e-9 * golden.abs();
    if !(worse <= slack) {
        Verdict::Worse
    } else if worse < -slack {
        Verdict::Better
    } else {
        Verdict::Same
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(name: &str, limits: FieldLimits, golden: Option<f64>, now: Option<f64>) -> Verdict {
        verdict(Field::named(name).unwrap(), limits, golden, now)
    }

    #[test]
    fn each_direction_of_a_move_is_told_apart() {
        let within = FieldLimits {
            tolerance: Some(0.2),
            ..FieldLimits::default()
        };
        for (field, golden, now, expected) in [
            ("angle_mean_deg", 5.0, 5.1, Verdict::Same),
            ("angle_mean_deg", 5.0, 5.3, Verdict::Worse),
            ("angle_mean_deg", 5.0, 4.7, Verdict::Better),
            ("answered_share", 0.9, 0.6, Verdict::Worse),
            ("answered_share", 0.5, 0.9, Verdict::Better),
            ("radius_bias_mm", -1.0, 1.1, Verdict::Same),
            ("radius_bias_mm", 0.1, -1.0, Verdict::Worse),
            ("angle_mean_deg", 5.0, f64::NAN, Verdict::Worse),
        ] {
            assert_eq!(
                judged(field, within, Some(golden), Some(now)),
                expected,
                "{field} {golden} {now}"
            );
        }
    }

    #[test]
    fn limits_hold_whatever_the_golden_says() {
        let limits = FieldLimits {
            floor: Some(1.0),
            ceiling: Some(6.0),
            tolerance: None,
        };
        assert_eq!(
            judged("angle_mean_deg", limits, Some(9.0), Some(6.5)),
            Verdict::AboveCeiling
        );
        assert_eq!(
            judged("angle_mean_deg", limits, None, Some(0.5)),
            Verdict::BelowFloor
        );
        assert_eq!(
            judged("angle_mean_deg", limits, None, Some(3.0)),
            Verdict::Same
        );
        assert_eq!(
            judged("angle_mean_deg", limits, None, Some(f64::NAN)),
            Verdict::AboveCeiling
        );
        assert_eq!(
            judged("angle_mean_deg", limits, None, None),
            Verdict::Missing
        );
        let golden_only = FieldLimits {
            tolerance: Some(0.1),
            ..FieldLimits::default()
        };
        assert_eq!(
            judged("angle_mean_deg", golden_only, None, Some(3.0)),
            Verdict::NoGolden
        );
    }

    #[test]
    fn a_row_that_is_gone_is_missed() {
        let limits = super::super::Limits::parse(
            "[[suite]]\nname = \"lab15\"\nmethod = \"paper\"\n[suite.fields]\norientation_angle_mean_deg = { tolerance = 1 }\n",
        )
        .unwrap();
        let of = |rows: Value| serde_json::json!({"cases": 15, "lab": rows});
        let row =
            |name: &str| serde_json::json!({"orientation": name, "angle_error": {"mean": 0.1}});
        let golden = Golden::of(
            &of(serde_json::json!([row("x0"), row("x45")])),
            &limits.suites[0],
        )
        .unwrap();
        let findings = judge(
            &of(serde_json::json!([row("x0")])),
            &limits.suites[0],
            Some(&golden),
        );
        let failed: Vec<_> = failures(&findings)
            .map(|f| (f.field.as_str(), f.verdict))
            .collect();
        assert_eq!(
            failed,
            [("orientation_angle_mean_deg x45", Verdict::Missing)]
        );
    }
}
