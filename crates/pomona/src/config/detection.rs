use pomona_settings::settings;

settings! {
    /// Settings of what depth says about the boxes of a detector.
    ///
    /// The noise of the readings is that of [`RobustConfig`](crate::RobustConfig), whichever the method; the size of
    /// the fruit is that of [`FruitConfig`](crate::FruitConfig).
    pub struct DetectionConfig {
        /// Whether depth checks a detector's boxes. false: they are taken as they come.
        depth_check: bool = true, "yes or no", any();
        /// Whether boxes that depth refuses are picked all the same. They keep their marks.
        pick_marked: bool = false, "yes or no", any();
        /// Farthest depth at which an apple is worth picking.
        range_max_m: f64 = 2.5, "metres", above(0.0).at_most(100.0);
        /// Fewest readings in a box by which depth can judge; with fewer it is marked `no_depth` and left to the
        /// method.
        min_readings: usize = 20, "count", within(8.0, 1e4);
        /// Least curvature of the surface in every direction, as a share of a sphere's. Higher: more of what is no
        /// apple is marked, and more apples that leaves cut up.
        least_roundness: f64 = 0.35, "share", within(0.0, 1.0);
        /// Two boxes are of one apple where their spheres' centres are nearer than this. 0: none are joined.
        merge_distance: f64 = 0.5, "radii", within(0.0, 1.0);
        /// Whether apples that the colour misses are looked for in depth. true: more is found, some of it no apple,
        /// and a frame takes longer.
        depth_search: bool = false, "yes or no", any();
        /// Least share of its silhouette on which an apple found in depth is visible. Lower: occluded apples are
        /// found, and more of what is no apple.
        search_coverage: f64 = 0.5, "share", within(0.0, 1.0);
    }
}
