//! What is printed from a declaration.

use crate::oven::{Heat, OvenConfig};
use pomona_settings::{ConfigError, Description, Kind, set};
use serde_json::json;

#[test]
fn every_setting_is_listed_in_order() {
    let description = Description::of::<OvenConfig>();
    let paths: Vec<&str> = description
        .settings
        .iter()
        .map(|s| s.path.as_str())
        .collect();
    assert_eq!(
        paths,
        [
            "heat",
            "light",
            "temperature.low_deg_c",
            "temperature.high_deg_c",
            "temperature.probe_m",
            "tray.level",
            "tray.normal"
        ]
    );
    let sections: Vec<&str> = description
        .sections
        .iter()
        .map(|s| s.path.as_str())
        .collect();
    assert_eq!(sections, ["temperature", "tray"]);
    let high = description.setting("temperature.high_deg_c").unwrap();
    assert_eq!(high.meaning, "Upper end. More: browner.");
    assert_eq!(high.unit, "degrees Celsius");
    assert_eq!(high.default, Some(180.0.into()));
    let rules = high.rules().unwrap();
    assert_eq!(
        rules,
        "over 0 and at most 300, and over temperature.low_deg_c"
    );
    let heat = description.setting("heat").unwrap();
    assert!(matches!(heat.kind, Kind::Choice(all) if all.len() == Heat::ALL.len()));
}

#[test]
fn the_file_explains_itself() {
    let text = Description::of::<OvenConfig>().toml("An oven.", &OvenConfig::default());
    for part in [
        "# An oven.\n\n# How it heats. static: From above and below. hot-air: With a fan. Unit: name; default\n# \"hot-air\".\nheat = \"hot-air\"\n",
        "\n# How warm it gets.\n[temperature]\n",
        "\n# probe_m = [0.0, 0.1, 0.2]\n",
        "level = 2\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn tables_hold_every_setting() {
    let text = Description::of::<OvenConfig>().markdown();
    for line in [
        "| `heat` | `\"hot-air\"` | name | `static`, `hot-air` | How it heats. |",
        "| `light` | `true` | yes or no | `true`, `false` | Whether the light is on. On: one sees \\| smells more. |",
        "### `[tray]`",
        "| `probe_m` | left out | metres | from -1 to 1 | Where the probe is; left out: there is none. |",
    ] {
        assert!(text.lines().any(|other| other == line), "{line}\n{text}");
    }
}

#[test]
fn the_schema_has_every_bound() {
    let schema = Description::of::<OvenConfig>().json_schema("An oven");
    assert_eq!(schema["additionalProperties"], false);
    let low = &schema["properties"]["temperature"]["properties"]["low_deg_c"];
    assert_eq!(low["exclusiveMinimum"], 0);
    assert_eq!(low["default"], 150.0);
    let tray = &schema["properties"]["tray"];
    assert_eq!(tray["additionalProperties"], false);
    let level = &tray["properties"]["level"];
    assert_eq!(
        (&level["type"], &level["minimum"], &level["maximum"]),
        (&json!("integer"), &json!(1), &json!(4))
    );
    let probe = &schema["properties"]["temperature"]["properties"]["probe_m"];
    assert_eq!(
        (&probe["maxItems"], &probe["items"]["minimum"]),
        (&json!(3), &json!(-1))
    );
    assert!(probe.get("default").is_none());
    let heat = &schema["properties"]["heat"]["oneOf"];
    assert_eq!(
        heat[1],
        json!({"const": "hot-air", "description": "With a fan."})
    );
}

#[test]
fn every_setting_has_another_value_that_its_rule_allows() {
    for setting in Description::of::<OvenConfig>().settings {
        let default = OvenConfig::default();
        let others = setting.other_values();
        // A unit vector has no other that is made by scaling.
        assert_eq!(others.is_empty(), setting.path == "tray.normal");
        for value in others {
            let changed = set(&default, &setting.path, value.clone()).unwrap();
            assert_ne!(changed, default, "{} = {value}", setting.path);
            if let Err(ConfigError::Value { rule, .. }) = changed.validate() {
                assert!(
                    setting.relations.contains(&rule) || rule.contains(" = "),
                    "{rule}"
                );
            }
        }
    }
}
