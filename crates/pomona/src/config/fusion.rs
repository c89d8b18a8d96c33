//! Here and not in `pomona-fusion`, which reads it: that crate depends on this one, and `Config` holds every section.

use pomona_settings::settings;

settings! {
    /// Settings of the fusion of several frames of one tree.
    pub struct FusionConfig {
        /// Of pairs of sightings of one apple at rest, the share that may be called `moved`. Smaller: small movements
        /// are taken for noise.
        moved_rate: f64 = 0.001, "share", within(1e-12, 0.1);
        /// Of right directions, the share that may be dropped for contradicting the other frames. Smaller: wrong ones
        /// are kept more often.
        direction_rate: f64 = 0.001, "share", within(1e-12, 0.1);
        /// Standard deviation of a centre along each axis where a frame states none (method `paper`).
        center_sd_m: f64 = 0.003, "metres", within(1e-5, 1.0);
        /// Added to a stated one for what the method cannot know, as a standard deviation along each axis. Larger:
        /// fewer false movements, and small ones are overlooked.
        center_floor_m: f64 = 0.0015, "metres", within(0.0, 1.0);
        /// The same for a radius.
        radius_floor_m: f64 = 0.0007, "metres", within(0.0, 1.0);
        /// Standard deviation of a direction where a frame states none (method `paper`).
        direction_sd_rad: f64 = 0.15, "radians", above(0.0).at_most(1.6);
        /// Added to a stated one, as a standard deviation.
        direction_floor_rad: f64 = 0.04, "radians", within(0.0, 1.6);
        /// Standard deviation, along each axis, of how far a whole tree sways between frames, or a pose is off beyond
        /// what it states. 0: nothing sways.
        sway_sd_m: f64 = 0.01, "metres", within(0.0, 1.0);
        /// The same for turning, about each axis.
        sway_sd_rad: f64 = 0.005, "radians", within(0.0, 1.6);
        /// Two places are of one moved apple up to this share of the sum of their radii; farther apart are two apples.
        moved_reach: f64 = 0.95, "share", above(0.0).at_most(3.0);
        /// Least visible share of an apple at both places for it to have moved; what is seen worse is a misfit, as
        /// spheres of occluded apples are at times wrong by centimetres.
        moved_visible: f64 = 0.3, "share", within(0.0, 1.0);
        /// Confidence of a direction where a frame states none (method `paper`).
        confidence: f64 = 0.7, "probability", above(0.0).below(1.0);
        /// Of wrong directions, the share that another frame repeats. Larger: agreement counts for less.
        repeated_error: f64 = 0.3, "share", above(0.0).below(1.0);
        /// Fused answers with a smaller confidence are refused. Higher: fewer and better answers.
        least_confidence: f64 = 0.35, "probability", within(0.0, 1.0);
        /// Edge of the cells in which the points of the fused cloud are joined. Larger: fewer points, less detail.
        voxel_m: f64 = 0.002, "metres", within(1e-5, 1.0);
    }
}
