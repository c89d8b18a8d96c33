use pomona_settings::settings;

settings! {
    /// Settings of the method `paper`.
    ///
    /// The defaults are the figures of Gao et al. 2022, sections 2.2.3–2.2.4, but for the least numbers of points. The
    /// window of radii, of which it states none, is that of [`FruitConfig`](crate::FruitConfig): without one, its wide
    /// inlier band prefers spheres far too large.
    pub struct PaperConfig {
        /// Spheres tried within the window of radii. More: steadier, and slower in proportion. The paper's figure.
        sphere_iterations: u64 = 1000, "count", within(1.0, 1e7);
        /// A point within this share of the radius supports a sphere. Wider: more noise is tolerated, and leaves pass
        /// for surface. The paper's figure is 1/5.
        sphere_band: f64 = 0.2, "share of the radius", above(0.0).below(1.0);
        /// Fewest points that make an apple. Fewer: small and occluded apples are answered, and less reliably.
        sphere_min_points: usize = 20, "count", at_least(4.0);
        /// The branch is looked for from this far from the centre. Nearer: the apple's own surface gets in. The paper's
        /// figure.
        shell_inner: f64 = 1.2, "radii", at_least(1.0);
        /// And up to this far. Farther: more of the branch, and more of other things. The paper's figure.
        shell_outer: f64 = 3.0, "radii", at_least(1.0).at_most(100.0);
        /// Lines tried at an allowed distance. More: steadier, and slower in proportion. The paper's figure.
        line_iterations: u64 = 3000, "count", within(1.0, 1e7);
        /// A point within this distance supports a line. Wider: thick and bent branches, and leaves. The paper's figure.
        line_band_m: f64 = 0.005, "metres", above(0.0).at_most(1.0);
        /// A line passes the centre at no less than this distance. Less: lines through the apple itself. The paper's
        /// figure.
        line_distance_min: f64 = 0.5, "radii", at_least(0.0);
        /// And at no more than this. More: branches that the apple does not hang from. The paper's figure.
        line_distance_max: f64 = 1.5, "radii", at_least(0.0);
        /// Fewest points that make a branch. Fewer: thin branches are found, and chance rows of points.
        line_min_points: usize = 10, "count", at_least(2.0);
    }
    order {
        shell_outer > shell_inner;
        line_distance_max > line_distance_min;
    }
}
