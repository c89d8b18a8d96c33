use super::table::aligned;
use serde_json::Value;
use std::f64::consts::PI;

const DEG: f64 = 180.0 / PI;
const MM: f64 = 1000.0;
const PER_CENT: f64 = 100.0;

/// The methods of one evaluation beside each other, with their 95 % intervals; empty where there is one.
pub(super) fn table(evaluation: &Value) -> String {
    let list = |key: &str| evaluation.get(key).and_then(Value::as_array);
    let results: Vec<&Value> = list("results").into_iter().flatten().collect();
    if results.len() < 2 {
        return String::new();
    }
    let header = [
        "suite",
        "method",
        "answered %",
        "mean °",
        "median °",
        "≤ 10° %",
        "≥ 50° %",
        "centre mm",
        "ECE",
    ];
    let mut rows = vec![header.map(str::to_owned)];
    rows.extend(results.iter().map(|result| row(result)));
    let mut text = aligned(&rows);
    for pair in list("comparisons").into_iter().flatten() {
        let name = |key: &str| pair.get(key).and_then(Value::as_str).unwrap_or_default();
        let line = format!(
            "{} less {}, on the same apples: {} °, centre {} mm\n",
            name("second"),
            name("first"),
            mean(pair, "/angle_difference", DEG),
            mean(pair, "/center_difference", MM)
        );
        text += &line;
    }
    text
}

fn row(result: &Value) -> [String; 9] {
    let word = |key: &str| {
        let word = result.get(key).and_then(Value::as_str);
        word.unwrap_or_default().to_owned()
    };
    [
        word("suite"),
        word("method"),
        share(result, "/answered"),
        mean(result, "/angle/error", DEG),
        number(result, "/angle/error/median", DEG),
        share(result, "/angle/within_10_deg"),
        share(result, "/angle/at_least_50_deg"),
        mean(result, "/center_error", MM),
        number(result, "/reliability/calibration_error", 1.0),
    ]
}

fn value(of: &Value, pointer: &str) -> Option<f64> {
    of.pointer(pointer).and_then(Value::as_f64)
}

fn number(of: &Value, pointer: &str, per_si: f64) -> String {
    let digits = if per_si > 1.0 { 2 } else { 3 };
    value(of, pointer).map_or_else(|| "-".to_owned(), |v| format!("{:.digits$}", v * per_si))
}

/// A mean with its interval.
fn mean(of: &Value, pointer: &str, per_si: f64) -> String {
    let part = |name: &str| value(of, &format!("{pointer}/{name}")).map(|v| v * per_si);
    let parts = (
        part("mean"),
        part("mean_interval/0"),
        part("mean_interval/1"),
    );
    let (Some(mean), Some(low), Some(high)) = parts else {
        return "-".to_owned();
    };
    format!("{mean:.2} ({low:.2} to {high:.2})")
}

/// A share in per cent with its interval.
fn share(of: &Value, pointer: &str) -> String {
    let part = |name: &str| value(of, &format!("{pointer}/{name}")).map(|v| v * PER_CENT);
    let (Some(share), Some(low), Some(high)) = (part("share"), part("low"), part("high")) else {
        return "-".to_owned();
    };
    format!("{share:.1} ({low:.1} to {high:.1})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn two_methods_stand_beside_each_other_and_one_needs_no_table() {
        let result = |method: &str, mean: f64| {
            json!({ "suite": "s", "method": method, "answered": { "share": 0.5, "low": 0.4, "high": 0.6 },
                    "angle": { "error": { "mean": mean, "mean_interval": [mean, mean], "median": mean } } })
        };
        let pair = json!({ "first": "paper", "second": "robust",
                           "angle_difference": { "mean": -0.1, "mean_interval": [-0.2, -0.05] } });
        let both = json!({ "results": [result("paper", 0.2), result("robust", 0.1)], "comparisons": [pair] });
        let text = table(&both);
        for part in [
            "50.0 (40.0 to 60.0)",
            "11.46 (11.46 to 11.46)",
            "robust less paper",
            "-5.73 (-11.46 to -2.86)",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert_eq!(
            table(&json!({ "results": [result("paper", 0.2)], "comparisons": [] })),
            ""
        );
    }
}
