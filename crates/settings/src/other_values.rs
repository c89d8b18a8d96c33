//! Values that a setting may have beside its default.

use crate::{Kind, Setting, rule::within};
use toml::Value;

/// By what a number is multiplied to get another one, the likeliest to be allowed first.
const FACTORS: [f64; 6] = [2.0, 0.5, 1.1, 0.9, 100.0, 1000.0];

/// Numbers beside a default of 0.
const BESIDE_ZERO: [f64; 4] = [0.001, 0.1, -0.001, 1.0];

/// The largest count that an end of a range may offer: larger ones only cost time.
const LARGEST_COUNT: f64 = 1e3;

impl Setting {
    /// Values other than the default that its own rule allows; rules beside other settings may forbid them. By them a
    /// test can see that every setting has a reader.
    pub fn other_values(&self) -> Vec<Value> {
        let shown = self.default.as_ref().or(self.example.as_ref());
        let values: Vec<Value> = match (self.kind, shown) {
            (Kind::Flag, _) => vec![true.into(), false.into()],
            (Kind::Choice(choices), _) => choices.iter().map(|c| c.name.into()).collect(),
            (Kind::Count, Some(Value::Integer(n))) => {
                let numbers = self.numbers_beside(*n as f64);
                let small = within(0.0, LARGEST_COUNT.max(1e3 * *n as f64));
                let counts = numbers.into_iter().filter(|x| small.allows(&[*x]));
                counts.map(|x| Value::Integer(x.ceil() as i64)).collect()
            }
            (Kind::Number, Some(Value::Float(x))) => {
                let numbers = self.numbers_beside(*x);
                numbers.into_iter().map(Value::Float).collect()
            }
            (Kind::Numbers(_), Some(Value::Array(list))) => FACTORS
                .iter()
                .map(|factor| {
                    let scaled = list.iter().filter_map(Value::as_float);
                    Value::Array(scaled.map(|x| Value::Float(factor * x)).collect())
                })
                .collect(),
            _ => Vec::new(),
        };
        let shown = values.into_iter().chain(self.example.clone());
        shown
            .filter(|value| {
                Some(value) != self.default.as_ref() && self.rule.allows(&numbers(value))
            })
            .collect()
    }

    fn numbers_beside(&self, x: f64) -> Vec<f64> {
        let range = self.rule.range();
        let ends = range.into_iter().flat_map(|r| [r.lower(), r.upper()]);
        let near = if x == 0.0 {
            BESIDE_ZERO.to_vec()
        } else {
            FACTORS.map(|factor| factor * x).to_vec()
        };
        near.into_iter().chain(ends.flatten()).collect()
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Integer(n) => vec![*n as f64],
        Value::Float(x) => vec![*x],
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}
