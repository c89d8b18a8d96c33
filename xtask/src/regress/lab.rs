use super::table::aligned;
use serde_json::Value;

/// The paper's Tables 1–3 beside ours; empty where the result has no lab rows, or one draw of each only.
pub(super) fn tables(result: &Value) -> String {
    let rows: Vec<&Value> = result
        .get("lab")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .collect();
    let mut text = String::new();
    if rows.first().is_none_or(|row| draws(row) < 2) {
        return text;
    }
    for (table, axis) in [(1, 'x'), (2, 'y'), (3, 'z')] {
        let own: Vec<&&Value> = rows
            .iter()
            .filter(|row| name(row).starts_with(axis))
            .collect();
        if own.is_empty() {
            continue;
        }
        let title = format!(
            "Table {table}: rotated about {axis}, paper (2022) and ours over {} draws each\n",
            draws(own[0])
        );
        text += &title;
        let header = [
            "angle °",
            "r mm paper",
            "ours",
            "± sd",
            "O off mm",
            "error ° paper",
            "ours mean",
            "ours max",
        ];
        let mut lines = vec![header.map(str::to_owned)];
        lines.extend(own.iter().map(|row| line(row)));
        text += &(aligned(&lines) + "\n");
    }
    if rows.len() == 15 {
        let mean = |pointer: &str| {
            let values: Vec<f64> = rows
                .iter()
                .filter_map(|row| row.pointer(pointer)?.as_f64())
                .collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let means = format!(
            "Mean of the fifteen angle errors: paper {:.2}°, ours {:.2}°\n",
            mean("/paper_angle_error").to_degrees(),
            mean("/angle_error/mean").to_degrees()
        );
        text += &means;
    }
    text
}

fn name(row: &Value) -> &str {
    row.get("orientation")
        .and_then(Value::as_str)
        .unwrap_or_default()
}

fn draws(row: &Value) -> u64 {
    row.get("draws").and_then(Value::as_u64).unwrap_or_default()
}

fn line(row: &Value) -> [String; 8] {
    let number = |pointer: &str, per_si: f64| {
        let value = row.pointer(pointer).and_then(Value::as_f64);
        value.map_or_else(|| "-".to_owned(), |v| format!("{:.2}", v * per_si))
    };
    let (mm, deg) = (1000.0, 180.0 / std::f64::consts::PI);
    [
        name(row)[1..].to_owned(),
        number("/paper_radius", mm),
        number("/radius/mean", mm),
        number("/radius/sd", mm),
        number("/center_error/mean", mm),
        number("/paper_angle_error", deg),
        number("/angle_error/mean", deg),
        number("/angle_error/max", deg),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn paper_and_ours_stand_in_one_line() {
        let row = json!({"orientation": "x-45", "draws": 10, "radius": {"mean": 0.026, "sd": 0.0001},
            "paper_radius": 0.02778, "paper_angle_error": 0.012_391_8, "angle_error": {"mean": 0.05, "max": 0.06},
            "center_error": {"mean": 0.001}});
        let text = tables(&json!({ "lab": [row] }));
        for part in [
            "Table 1", "10 draws", "-45", "27.78", "26.00", "0.71", "2.86", "3.44",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert_eq!(tables(&json!({ "lab": [] })), "");
    }
}
