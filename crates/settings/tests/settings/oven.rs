//! Settings of an oven: every kind, and every way to relate two of them.

use pomona_settings::{choices, settings};

choices! {
    /// How an oven heats.
    pub(crate) enum Heat {
        /// From above and below.
        Static = "static",
        /// With a fan.
        Fan = "hot-air",
    }
}

settings! {
    /// Settings of an oven.
    pub(crate) struct OvenConfig {
        /// How it heats.
        heat: Heat = Heat::Fan, "name", any();
        /// Whether the light is on. On: one sees | smells more.
        light: bool = true, "yes or no", any();
    }
    sections {
        /// How warm it gets.
        temperature: TemperatureConfig;
        /// Where the tray is.
        tray: TrayConfig;
    }
    require {
        tray.level: "below 3 with the fan" => |s| s.heat != Heat::Fan || s.tray.level < 3;
    }
}

settings! {
    /// Temperatures.
    pub(crate) struct TemperatureConfig {
        /// Lower end.
        low_deg_c: f64 = 150.0, "degrees Celsius", above(0.0);
        /// Upper end. More:
        /// browner.
        high_deg_c: f64 = 180.0, "degrees Celsius", above(0.0).at_most(300.0);
        /// Where the probe is; left out: there is none.
        probe_m: Option<[f64; 3]> = None, "metres", within(-1.0, 1.0), example [0.0, 0.1, 0.2];
    }
    order {
        high_deg_c > low_deg_c;
    }
}

settings! {
    /// The tray.
    pub(crate) struct TrayConfig {
        /// Level from below.
        level: usize = 2, "count", within(1.0, 4.0);
        /// Its normal.
        normal: [f64; 3] = [0.0, 0.0, 1.0], "unit vector", unit();
    }
}
