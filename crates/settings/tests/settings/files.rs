//! Reading, writing and changing settings.

use crate::oven::{Heat, OvenConfig};
use pomona_settings::{ConfigError, Description, parse, read, set, word_or_value};

fn oven(text: &str) -> Result<OvenConfig, ConfigError> {
    parse(text, "oven.toml")
}

#[test]
fn what_a_file_leaves_out_keeps_its_default() {
    assert_eq!(oven("").unwrap(), OvenConfig::default());
    let config = oven("heat = \"static\"\n[temperature]\nhigh_deg_c = 220\n").unwrap();
    assert_eq!(config.heat, Heat::Static);
    assert_eq!(config.temperature.high_deg_c, 220.0);
    assert_eq!(config.temperature.low_deg_c, 150.0);
}

#[test]
fn a_printed_file_reads_back_the_same() {
    let changed = OvenConfig::default().with(|c| {
        c.temperature.probe_m = Some([0.1, 0.0, 0.0]);
        c.temperature.low_deg_c = 0.1 + 0.2;
        c.light = false;
    });
    let description = Description::of::<OvenConfig>();
    for config in [OvenConfig::default(), changed] {
        let text = description.toml("An oven.", &config);
        assert_eq!(oven(&text).unwrap(), config, "{text}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("oven.toml");
        std::fs::write(&path, text).unwrap();
        assert_eq!(read::<OvenConfig>(path).unwrap(), config);
    }
}

#[test]
fn what_is_none_of_the_settings_is_refused_with_its_place() {
    for (text, parts) in [
        ("heet = \"static\"", &["line 1", "did you mean `heat`"][..]),
        (
            "[temperature]\n\nhigh = 200",
            &["line 3", "temperature.high_deg_c"],
        ),
        ("[tray]\nlow_deg_c = 3", &["`temperature.low_deg_c`"]),
        ("[trey]\n", &["line 1", "trey"]),
        ("[zzz]\n", &["there are heat, light"]),
        (
            "temperature = 3",
            &["it is a section, with temperature.low"],
        ),
        ("[light]\n", &["light", "true or false"]),
        ("light = \"on\"", &["light = \"on\"", "true or false"]),
        ("heat = \"cold\"", &["one of static, hot-air"]),
        ("[tray]\nlevel = -1", &["line 2", "a whole number"]),
        ("[tray]\nlevel = 1.5", &["a whole number"]),
        ("[tray]\nnormal = [0, 1]", &["a list of 3 numbers"]),
        (
            "[temperature]\nlow_deg_c = nan",
            &["low_deg_c = nan", "over 0"],
        ),
        ("[temperature", &["oven.toml"]),
    ] {
        let message = oven(text).unwrap_err().to_string();
        for part in parts.iter().chain(&["oven.toml"]) {
            assert!(message.contains(part), "{text}: {message}");
        }
    }
    let gone = read::<OvenConfig>("/nowhere/oven.toml").unwrap_err();
    assert!(gone.to_string().contains("/nowhere/oven.toml"));
}

#[test]
fn one_setting_can_be_changed_by_its_name() {
    let config = OvenConfig::default();
    let value = |text| word_or_value(text);
    assert_eq!(
        set(&config, "heat", value("static")).unwrap().heat,
        Heat::Static
    );
    let probed = set(&config, "temperature.probe_m", value("[0, 0, 0.5]")).unwrap();
    assert_eq!(probed.temperature.probe_m, Some([0.0, 0.0, 0.5]));
    // Rules are asked once all changes are made.
    let hot = set(&config, "temperature.low_deg_c", value(" 200 ")).unwrap();
    assert!(hot.validate().is_err());
    let hotter = set(&hot, "temperature.high_deg_c", value("250")).unwrap();
    hotter.validate().unwrap();

    for (name, text, part) in [
        ("temperature", "1", "it is a section"),
        ("tray.levl", "1", "tray.level"),
        ("light", "maybe", "true or false"),
        ("heat", "cold", "static"),
    ] {
        let message = set(&config, name, value(text)).unwrap_err().to_string();
        assert!(message.contains(part), "{name}: {message}");
    }
}
