//! Rules of one setting and of several.

use crate::oven::{Heat, OvenConfig, TrayConfig};

fn broken(change: impl FnOnce(&mut OvenConfig)) -> String {
    let config = OvenConfig::default().with(change);
    config
        .validate()
        .expect_err("one setting breaks a rule")
        .to_string()
}

#[test]
fn defaults_are_sound() {
    OvenConfig::default().validate().unwrap();
}

#[test]
fn each_rule_names_setting_value_and_rule() {
    for (message, expected) in [
        (
            broken(|c| c.temperature.high_deg_c = 301.0),
            "setting temperature.high_deg_c = 301.0: it must be over 0 and at most 300",
        ),
        (
            broken(|c| c.temperature.low_deg_c = 200.0),
            "setting temperature.high_deg_c = 180.0: it must be over temperature.low_deg_c = 200.0",
        ),
        (
            broken(|c| c.temperature.probe_m = Some([0.0, f64::NAN, 0.0])),
            "setting temperature.probe_m = [0.0, nan, 0.0]: it must be from -1 to 1",
        ),
        (
            broken(|c| c.tray.normal = [0.0, 1.0, 1.0]),
            "setting tray.normal = [0.0, 1.0, 1.0]: it must be of norm 1; copy all digits",
        ),
        (
            broken(|c| c.tray.level = 3),
            "setting tray.level = 3: it must be below 3 with the fan",
        ),
    ] {
        assert_eq!(message, expected);
    }
    let level = OvenConfig::default().with(|c| (c.heat, c.tray.level) = (Heat::Static, 4));
    level.validate().unwrap();
}

#[test]
fn a_section_alone_has_no_prefix() {
    let tray = TrayConfig::default().with(|c| c.level = 0);
    let message = tray.validate().unwrap_err().to_string();
    assert!(message.starts_with("setting level = 0"), "{message}");
}
