use super::variants::{METHOD, Variant};
use anyhow::{Context, Result};
use serde_json::Value;
use std::f64::consts::PI;

const DEG: f64 = 180.0 / PI;
const MM: f64 = 1000.0;
const PER_CENT: f64 = 100.0;

/// The method as it is and its variants over one suite, as a Markdown table.
pub(super) fn of(suite: &str, evaluation: &Value, variants: &[&Variant]) -> Result<String> {
    let whole = result(evaluation, METHOD)?;
    let cases = whole.pointer("/cases").and_then(Value::as_u64).unwrap_or(0);
    let mut text = format!(
        "`{suite}`, {cases} scenes\n\n\
         | off | mean ° | difference ° | ≤ 10° % | ≥ 50° % | centre mm | difference mm | answered % |\n\
         |---|---|---|---|---|---|---|---|\n"
    );
    text += &line("nothing", whole, None);
    for variant in variants {
        let own = result(evaluation, &variant.name)?;
        let off = format!("{} (`{}`)", variant.off, variant.name);
        text += &line(&off, own, comparison(evaluation, &variant.name));
    }
    Ok(text)
}

fn line(off: &str, result: &Value, against: Option<&Value>) -> String {
    let number = |pointer: &str, per_si: f64, digits: usize| {
        let value = result.pointer(pointer).and_then(Value::as_f64);
        value.map_or_else(|| "–".to_owned(), |v| format!("{:.digits$}", v * per_si))
    };
    let difference = |field: &str, per_si: f64| {
        against.map_or_else(String::new, |pair| {
            difference(pair, field, per_si).unwrap_or_else(|| "–".to_owned())
        })
    };
    format!(
        "| {off} | {} | {} | {} | {} | {} | {} | {} |\n",
        number("/angle/error/mean", DEG, 2),
        difference("angle_difference", DEG),
        number("/angle/within_10_deg/share", PER_CENT, 1),
        number("/angle/at_least_50_deg/share", PER_CENT, 1),
        number("/center_error/mean", MM, 2),
        difference("center_difference", MM),
        number("/answered/share", PER_CENT, 1),
    )
}

/// Mean and interval of a paired difference; bold where the interval does not hold zero.
fn difference(pair: &Value, field: &str, per_si: f64) -> Option<String> {
    let of = pair.get(field)?;
    let mean = of.get("mean")?.as_f64()? * per_si;
    let end = |i: usize| Some(of.get("mean_interval")?.get(i)?.as_f64()? * per_si);
    let (low, high) = (end(0)?, end(1)?);
    let text = format!("{mean:+.2} ({low:+.2} to {high:+.2})");
    Some(if low > 0.0 || high < 0.0 {
        format!("**{text}**")
    } else {
        text
    })
}

fn result<'a>(evaluation: &'a Value, method: &str) -> Result<&'a Value> {
    let results = evaluation.get("results").and_then(Value::as_array);
    results
        .into_iter()
        .flatten()
        .find(|r| r.get("method").and_then(Value::as_str) == Some(method))
        .with_context(|| format!("no result of `{method}`"))
}

fn comparison<'a>(evaluation: &'a Value, method: &str) -> Option<&'a Value> {
    let text = |pair: &Value, key: &str| pair.get(key).and_then(Value::as_str).map(str::to_owned);
    evaluation
        .get("comparisons")?
        .as_array()?
        .iter()
        .find(|pair| {
            text(pair, "first").as_deref() == Some(METHOD)
                && text(pair, "second").as_deref() == Some(method)
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_row_for_each_variant_with_its_paired_difference() {
        let result = |method: &str, mean: f64| {
            json!({ "suite": "s", "method": method, "cases": 9, "answered": { "share": 1.0 },
                    "angle": { "error": { "mean": mean }, "within_10_deg": { "share": 0.9 },
                               "at_least_50_deg": { "share": 0.0 } },
                    "center_error": { "mean": 0.001 } })
        };
        let evaluation = json!({
            "results": [result(METHOD, 0.01), result("no-box", 0.02)],
            "comparisons": [{ "first": METHOD, "second": "no-box",
                              "angle_difference": { "mean": 0.01, "mean_interval": [0.005, 0.015] },
                              "center_difference": { "mean": 0.0, "mean_interval": [-0.001, 0.001] } }],
        });
        let variant = Variant {
            name: "no-box".to_owned(),
            off: "the box".to_owned(),
            robust: toml::Table::new(),
        };
        let text = of("s", &evaluation, &[&variant]).unwrap();
        assert!(
            text.contains("| nothing | 0.57 |  | 90.0 | 0.0 | 1.00 |  | 100.0 |"),
            "{text}"
        );
        assert!(text.contains("**+0.57 (+0.29 to +0.86)**"), "{text}");
        assert!(text.contains("| +0.00 (-1.00 to +1.00) |"), "{text}");
        assert!(of("s", &json!({}), &[]).is_err());
    }
}
