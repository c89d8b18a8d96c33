use pomona_settings::readers::{Situation, unread};
use pomona_settings::settings;

settings! {
    /// Settings of a lamp.
    pub struct LampConfig {
        /// Brightness.
        brightness: f64 = 1.0, "share", within(0.0, 2.0);
        /// Hue, of which only one value is seen.
        hue: f64 = 1.0, "radians", within(0.0, 100.0);
        /// Nobody looks at it.
        forgotten: usize = 3, "count", within(1.0, 9.0);
    }
}

#[test]
fn a_setting_that_nobody_reads_is_named() {
    let answer = |lamp: &LampConfig| format!("{} {}", lamp.brightness, lamp.hue == 77.0);
    let situations = [
        Situation::new(LampConfig::default(), |_| "dark".to_owned()).about(&["hue"]),
        Situation::new(LampConfig::default(), answer),
    ];
    assert_eq!(unread(&situations, &[], |_| true), ["hue", "forgotten"]);
    let special = [("hue", "77.0")];
    assert_eq!(unread(&situations, &special, |_| true), ["forgotten"]);
    let none = unread(&situations, &special, |path| path != "forgotten");
    assert!(none.is_empty());
}
