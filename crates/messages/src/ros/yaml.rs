//! YAML as the tools of ROS read it.

use serde::Serialize;
use serde_json::Value;
use std::fmt::Write;

/// Decimals of a float: a nanometre, a billionth of a radian.
const DECIMALS: usize = 9;

/// A message as YAML: block style, lists of numbers in one line, fields by their names' order.
///
/// Every float has a point and no exponent, nine decimals: YAML 1.1, which ROS's tools read, takes
/// `1e-05` for a string. Strings are in double quotes. Messages contain no numbers that are not finite; one would become
/// `.nan`.
pub fn to_yaml(message: &impl Serialize) -> String {
    let mut text = String::new();
    if let Ok(value) = serde_json::to_value(message) {
        block(&value, 0, &mut text);
    }
    text
}

fn block(value: &Value, indent: usize, text: &mut String) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                entry(&format!("{:indent$}{key}:", ""), value, indent + 2, text);
            }
        }
        Value::Array(list) => {
            for value in list {
                let mut inner = String::new();
                block(value, indent + 2, &mut inner);
                // The first line of an entry follows its dash.
                let first = inner.trim_start();
                let _ = write!(text, "{:indent$}- {first}", "");
            }
        }
        scalar => {
            let _ = writeln!(text, "{}", inline(scalar));
        }
    }
}

fn entry(head: &str, value: &Value, indent: usize, text: &mut String) {
    let nested = match value {
        Value::Object(map) => !map.is_empty(),
        Value::Array(list) => list.iter().any(|v| v.is_object() || v.is_array()),
        _ => false,
    };
    if nested {
        let _ = writeln!(text, "{head}");
        block(value, indent, text);
    } else {
        let _ = writeln!(text, "{head} {}", inline(value));
    }
}

fn inline(value: &Value) -> String {
    match value {
        Value::Number(number) if number.is_f64() => number.as_f64().map_or_else(
            || ".nan".to_owned(),
            |number| {
                let text = format!("{number:.DECIMALS$}");
                let short = text.trim_end_matches('0');
                match short.strip_suffix('.') {
                    Some("-0") => "0.0".to_owned(),
                    Some(whole) => format!("{whole}.0"),
                    None => short.to_owned(),
                }
            },
        ),
        Value::Array(list) => {
            let parts: Vec<_> = list.iter().map(inline).collect();
            format!("[{}]", parts.join(", "))
        }
        Value::Object(_) => "{}".to_owned(),
        Value::Null => ".nan".to_owned(),
        // JSON's strings, booleans and integers are YAML's.
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn numbers_are_numbers_to_yaml_1_1() {
        for (number, text) in [
            (1e-5, "0.00001"),
            (-1e-12, "0.0"),
            (2.0, "2.0"),
            (-0.5, "-0.5"),
            (1e6, "1000000.0"),
            (f64::NAN, ".nan"),
        ] {
            assert_eq!(inline(&json!(number)), text, "{number}");
        }
        assert_eq!(inline(&json!([1.5, 2.0])), "[1.5, 2.0]");
    }

    #[test]
    fn maps_and_lists_are_blocks() {
        let value = json!({"a": {"b": 1, "c": [{"d": "x", "e": []}, {"d": "y\"", "e": [1.0]}]}});
        let text =
            "a:\n  b: 1\n  c:\n    - d: \"x\"\n      e: []\n    - d: \"y\\\"\"\n      e: [1.0]\n";
        assert_eq!(to_yaml(&value), text);
    }
}
