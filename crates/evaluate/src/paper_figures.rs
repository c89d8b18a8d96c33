//! Every figure of the paper that ours is set beside, in metres, radians and seconds.
//!
//! Source: Gao, Zhou, Cao and Jiang 2022, "An Algorithm for Calculating Apple Picking Direction
//! Based on 3D Vision", Agriculture 12(8), 1170, doi 10.3390/agriculture12081170. The tables and
//! sections stand at each figure.

/// One row of Tables 1–3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PaperOrientation {
    /// Name of the orientation in the lab suites, such as `x-90`.
    pub(crate) name: &'static str,
    /// Fitted radius, metres.
    pub(crate) radius: f64,
    /// Direction calculated, as printed.
    pub(crate) direction: [f64; 3],
    /// Angle error as printed, degrees.
    pub(crate) angle_error_deg: f64,
}

const fn row(
    name: &'static str,
    radius_mm: f64,
    direction: [f64; 3],
    angle_error_deg: f64,
) -> PaperOrientation {
    PaperOrientation {
        name,
        radius: radius_mm / 1000.0,
        direction,
        angle_error_deg,
    }
}

/// Tables 1 to 3. The vector of the first row is misprinted: its norm is 1.166, and it lies 34.2°
/// off the true one instead of the 5.23° printed beside it.
pub(crate) const ORIENTATIONS: [PaperOrientation; 15] = [
    row("x-90", 24.744, [-0.026, -0.655, 0.964], 5.23),
    row("x-45", 27.780, [-0.012, -0.707, 0.708], 0.71),
    row("x0", 26.700, [0.000, -0.999, -0.033], 1.87),
    row("x45", 25.735, [0.040, -0.710, -0.704], 2.30),
    row("x90", 21.022, [-0.012, -0.119, -0.993], 6.85),
    row("y-60", 26.618, [-0.076, -0.971, 0.000], 4.45),
    row("y-30", 26.733, [-0.013, -0.993, -0.119], 6.89),
    row("y0", 26.544, [0.029, -0.999, -0.032], 2.51),
    row("y30", 27.106, [0.010, -0.989, -0.041], 2.43),
    row("y60", 26.999, [0.014, -0.999, -0.037], 2.27),
    row("z-90", 27.411, [0.998, 0.045, 0.035], 3.27),
    row("z-45", 27.705, [0.721, -0.671, -0.171], 10.08),
    row("z0", 26.712, [0.000, -0.996, -0.090], 5.15),
    row("z45", 26.669, [-0.706, -0.698, -0.116], 6.65),
    row("z90", 26.959, [-0.992, -0.045, -0.119], 7.304),
];

/// True radius of the lab's apple, metres (section 2.2.6).
pub(crate) const LAB_RADIUS: f64 = 0.025_78;

/// The 474 repeats of section 3, Figures 13 to 15.
pub(crate) mod repeats {
    /// How many.
    pub(crate) const COUNT: usize = 474;
    /// Measured radius of the apple, metres.
    pub(crate) const TRUE_RADIUS: f64 = 0.041_67;
    /// Mean fitted radius, metres.
    pub(crate) const RADIUS_MEAN: f64 = 0.042_64;
    /// Standard deviation of the radius, metres.
    pub(crate) const RADIUS_SD: f64 = 0.001_79;
    /// Standard deviation of the coordinates of O, metres: at most.
    pub(crate) const CENTER_SD_AT_MOST: f64 = 0.0025;
    /// Standard deviation of the coordinates of C, metres; the paper gives one number for all three.
    pub(crate) const FOOT_SD: f64 = 0.015_60;
    /// Mean angle to the mean direction, degrees.
    pub(crate) const ANGLE_MEAN_DEG: f64 = 11.81;
    /// Its standard deviation, degrees.
    pub(crate) const ANGLE_SD_DEG: f64 = 13.65;
    /// Share within 10°.
    pub(crate) const WITHIN_10_DEG: f64 = 0.626_58;
    /// Share within 20°.
    pub(crate) const WITHIN_20_DEG: f64 = 0.850_21;
    /// Share at 50° or more.
    pub(crate) const AT_LEAST_50_DEG: f64 = 0.033_76;
}

/// A line of Table 4: mean and standard deviation, seconds, on an AMD R7-5800H.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PaperTime {
    /// Mean.
    pub(crate) mean_s: f64,
    /// Standard deviation.
    pub(crate) sd_s: f64,
}

/// Table 4: finding the apple in the colour image.
pub(crate) const TIME_DETECTION: PaperTime = PaperTime {
    mean_s: 0.042,
    sd_s: 0.004,
};
/// Table 4: fitting the sphere.
pub(crate) const TIME_SPHERE: PaperTime = PaperTime {
    mean_s: 0.273,
    sd_s: 0.061,
};
/// Table 4: fitting the line, and the direction.
pub(crate) const TIME_LINE: PaperTime = PaperTime {
    mean_s: 0.228,
    sd_s: 0.009,
};
/// Table 4: all of it.
pub(crate) const TIME_TOTAL: PaperTime = PaperTime {
    mean_s: 0.543,
    sd_s: 0.063,
};

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use pomona_geometry::angle_between;

    /// The mean that the project's notes state, and the printed vectors against the printed angles.
    #[test]
    fn the_table_agrees_with_itself() {
        let mean = ORIENTATIONS.iter().map(|o| o.angle_error_deg).sum::<f64>() / 15.0;
        assert!((mean - 4.53).abs() < 0.005, "{mean}");
        let s = std::f64::consts::FRAC_1_SQRT_2;
        for (name, truth) in [
            ("x45", [0.0, -s, -s]),
            ("x90", [0.0, 0.0, -1.0]),
            ("y-60", [0.0, -1.0, 0.0]),
            ("z-90", [1.0, 0.0, 0.0]),
            ("z-45", [s, -s, 0.0]),
            ("z90", [-1.0, 0.0, 0.0]),
        ] {
            let row = ORIENTATIONS.iter().find(|o| o.name == name).unwrap();
            let angle =
                angle_between(&Vector3::from(row.direction), &Vector3::from(truth)).unwrap();
            assert!(
                (angle.to_degrees() - row.angle_error_deg).abs() < 0.15,
                "{name}: {angle}"
            );
        }
    }
}
