use serde_json::Value;
use std::f64::consts::PI;

/// A number of a suite's result that may be limited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Its name in `xtask/regress.toml`, with the unit that people read.
    pub name: &'static str,
    /// Where it stands in a suite's result, in SI units.
    pub pointer: &'static str,
    /// The people's unit in SI units.
    pub per_si: f64,
    /// Which way is better.
    pub better: Better,
}

/// Which way a field is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Better {
    /// The less the better.
    Less,
    /// The more the better.
    More,
    /// The nearer to zero the better: a bias.
    NearZero,
}

const DEG: f64 = 180.0 / PI;
const MM: f64 = 1000.0;
const ONE: f64 = 1.0;

const fn field(name: &'static str, pointer: &'static str, per_si: f64, better: Better) -> Field {
    Field {
        name,
        pointer,
        per_si,
        better,
    }
}

/// Every field that may be limited. One whose pointer holds `*` stands for each row of an array,
/// named by the row's `orientation`.
pub const FIELDS: &[Field] = &[
    field("angle_mean_deg", "/angle/error/mean", DEG, Better::Less),
    field("angle_median_deg", "/angle/error/median", DEG, Better::Less),
    field("angle_p95_deg", "/angle/error/p95", DEG, Better::Less),
    field("angle_max_deg", "/angle/error/max", DEG, Better::Less),
    field("angle_sd_deg", "/angle/error/sd", DEG, Better::Less),
    field(
        "within_10_deg_share",
        "/angle/within_10_deg/share",
        ONE,
        Better::More,
    ),
    field(
        "within_20_deg_share",
        "/angle/within_20_deg/share",
        ONE,
        Better::More,
    ),
    field(
        "at_least_50_deg_share",
        "/angle/at_least_50_deg/share",
        ONE,
        Better::Less,
    ),
    field("hits_share", "/refusals/hits/share", ONE, Better::More),
    field("answered_share", "/answered/share", ONE, Better::More),
    field("refused_wrongly", "/refusals/wrong", ONE, Better::Less),
    field(
        "calibration_error",
        "/reliability/calibration_error",
        ONE,
        Better::Less,
    ),
    field(
        "doubted_of_wrong_share",
        "/reliability/doubted_of_wrong/share",
        ONE,
        Better::More,
    ),
    field("stray_picks", "/stray_picks", ONE, Better::Less),
    field("center_mean_mm", "/center_error/mean", MM, Better::Less),
    field("center_p95_mm", "/center_error/p95", MM, Better::Less),
    field("radius_bias_mm", "/radius_error/mean", MM, Better::NearZero),
    field(
        "radius_absolute_mm",
        "/radius_error_absolute/mean",
        MM,
        Better::Less,
    ),
    field("foot_mean_mm", "/foot_error/mean", MM, Better::Less),
    field(
        "repeat_angle_mean_deg",
        "/repeatability/angle_to_mean/error/mean",
        DEG,
        Better::Less,
    ),
    field(
        "repeat_angle_sd_deg",
        "/repeatability/angle_to_mean/error/sd",
        DEG,
        Better::Less,
    ),
    field(
        "repeat_within_10_deg_share",
        "/repeatability/angle_to_mean/within_10_deg/share",
        ONE,
        Better::More,
    ),
    field(
        "repeat_within_20_deg_share",
        "/repeatability/angle_to_mean/within_20_deg/share",
        ONE,
        Better::More,
    ),
    field(
        "repeat_at_least_50_deg_share",
        "/repeatability/angle_to_mean/at_least_50_deg/share",
        ONE,
        Better::Less,
    ),
    field(
        "repeat_radius_mean_mm",
        "/repeatability/radius/mean",
        MM,
        Better::Less,
    ),
    field(
        "repeat_radius_sd_mm",
        "/repeatability/radius/sd",
        MM,
        Better::Less,
    ),
    // Real frames.
    field(
        "seen_answered_share",
        "/all/seen/answered/share",
        ONE,
        Better::More,
    ),
    field(
        "right_of_answers_share",
        "/all/seen/right/share",
        ONE,
        Better::More,
    ),
    field(
        "right_of_apples_share",
        "/all/seen/hits/share",
        ONE,
        Better::More,
    ),
    field(
        "on_wood_share",
        "/all/seen/on_wood/share",
        ONE,
        Better::More,
    ),
    field("brier", "/all/reliability/brier", ONE, Better::Less),
    field(
        "right_of_confident_share",
        "/all/reliability/right_of_confident/share",
        ONE,
        Better::More,
    ),
    field(
        "frames_within_20_deg_share",
        "/between_frames/within_20_deg/share",
        ONE,
        Better::More,
    ),
    field(
        "frames_beyond_50_deg_share",
        "/between_frames/beyond_50_deg/share",
        ONE,
        Better::Less,
    ),
    field(
        "copies_within_20_deg_share",
        "/all/perturbed/directions/within_20_deg/share",
        ONE,
        Better::More,
    ),
    field(
        "copies_flipped_share",
        "/all/perturbed/flipped/share",
        ONE,
        Better::Less,
    ),
    field(
        "orientation_angle_mean_deg",
        "/lab/*/angle_error/mean",
        DEG,
        Better::Less,
    ),
];

impl Field {
    /// The field of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        FIELDS.iter().find(|field| field.name == name)
    }

    /// Its values in a suite's result, in SI units: key and value; the key is the pointer without
    /// its first slash, with the row's name in place of `*`.
    pub fn values(&self, result: &Value) -> Vec<(String, f64)> {
        let key = |pointer: &str| pointer.trim_start_matches('/').to_owned();
        let Some((array, inner)) = self.pointer.split_once("/*") else {
            let value = result.pointer(self.pointer).and_then(Value::as_f64);
            return value.map(|v| (key(self.pointer), v)).into_iter().collect();
        };
        let rows = result.pointer(array).and_then(Value::as_array);
        rows.into_iter()
            .flatten()
            .filter_map(|row| {
                let name = row.get("orientation")?.as_str()?;
                let value = row.pointer(inner)?.as_f64()?;
                Some((key(&format!("{array}/{name}{inner}")), value))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_star_stands_for_each_row() {
        let result = json!({"lab": [
            {"orientation": "x0", "angle_error": {"mean": 0.1}},
            {"orientation": "x45", "angle_error": null},
            {"orientation": "x90", "angle_error": {"mean": 0.3}},
        ]});
        let values = Field::named("orientation_angle_mean_deg")
            .unwrap()
            .values(&result);
        let expected = [
            ("lab/x0/angle_error/mean".to_owned(), 0.1),
            ("lab/x90/angle_error/mean".to_owned(), 0.3),
        ];
        assert_eq!(values, expected);
    }

    #[test]
    fn names_are_used_once() {
        for (i, field) in FIELDS.iter().enumerate() {
            assert!(
                FIELDS[i + 1..].iter().all(|other| other.name != field.name),
                "{}",
                field.name
            );
        }
    }
}
