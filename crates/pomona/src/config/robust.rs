use pomona_settings::{choices, settings};

choices! {
    /// A depth camera whose noise is known.
    pub enum SensorPreset {
        /// No camera in particular: 0.5 mm + 1.4 mm/m² z², which lies near all of the others from 0.7 to 1.5 m.
        Generic = "generic",
        /// The paper's structured-light camera: 1 mm at 0.8 m, growing with z².
        Paper = "paper",
        /// The first Kinect: 1.2 mm + 1.9 mm/m² (z − 0.4 m)² (Nguyen, Izadi and Lovell 2012,
        /// doi 10.1109/3DIMPVT.2012.84).
        Kinect = "kinect",
        /// Azure Kinect: 0.7 mm + 0.8 mm/m z.
        AzureKinect = "azure-kinect",
        /// RealSense D400: 0.08 pixels of disparity, shared by neighbours within 4 pixels.
        D400 = "d400",
    }
}

settings! {
    /// Settings of the method `robust`.
    pub struct RobustConfig {
        /// The depth camera. Decides how far two readings may differ before they disagree; also for the depth check,
        /// whichever the method. With `generic`, the fits take the noise of smeared depth from the image itself.
        sensor: SensorPreset = SensorPreset::Generic, "name", any();
        /// Standard deviation of a depth reading at depth z as a + b z + c z²: [a, b, c] for metres. Left out: that of
        /// `sensor`.
        noise_m: Option<[f64; 3]> = None, "metres", within(-1.0, 1.0), example [0.0005, 0.0, 0.0014];
        /// Mean of the prior of an apple's radius. Counts where little of one is visible. Left out: three fifths of
        /// the way through the window of radii, 0.038 for the default one.
        radius_mean_m: Option<f64> = None, "metres", above(0.0).at_most(1.0), example 0.038;
        /// Standard deviation of that prior. Smaller: occluded apples are steadier, odd sizes worse. Left out: a fifth
        /// of the window of radii, 0.006 for the default one.
        radius_sd_m: Option<f64> = None, "metres", above(0.0).at_most(1.0), example 0.006;
        /// Standard deviation of a radius read off the smaller side of a box. 0: boxes do not say how large apples
        /// are. Left out: by the frame, 0.001 where its depth is smeared, 0 where edges are sharp.
        box_radius_sd_m: Option<f64> = None, "metres", within(0.0, 1.0), example 0.001;
        /// Share of a box's width and height on each side whose readings are left out. Left out: by the frame, 0.15
        /// where its depth is smeared, 0 where edges are sharp.
        rim_share: Option<f64> = None, "share", within(0.0, 0.4), example 0.15;
        /// Mean of the prior of the flattening: the share by which apples are lower than wide.
        flattening_mean: f64 = 0.07, "share", within(0.0, 1.0);
        /// Standard deviation of that prior. Larger: shapes are fitted more freely, and noise with them.
        flattening_sd: f64 = 0.04, "share", above(0.0).at_most(1000.0);
        /// Standard deviation of the stem's angle to the image's upward direction. Larger: for apples that hang askew,
        /// and less is known of occluded ones.
        stem_sd_rad: f64 = 0.7, "radians", above(0.0).at_most(1000.0);
        /// Whether a box is refused where depth and colour show more probably no apple than one, whoever drew it. Off
        /// for boxes that a person has drawn about apples: what is hidden or smeared beyond recognition is answered too.
        check_boxes: bool = true, "yes or no", any();
        /// Fewest readings in a box that make an apple. Fewer: small and occluded apples are answered, and less
        /// reliably.
        min_readings: usize = 20, "count", within(1.0, 1e5);
        /// Spheres tried through four random points. More: steadier among leaves, and slower.
        sphere_draws: usize = 200, "count", within(1.0, 1e5);
        /// Spheres of these that are refined. More: steadier among leaves, and slower.
        sphere_kept: usize = 4, "count", within(1.0, 1e5);
        /// Blocks along the longer side of a box, over which readings are averaged. More: finer and slower.
        blocks: usize = 24, "count", within(1.0, 1e5);
        /// Weight of the box against the points when spheres compete. 0 for boxes that mean little.
        box_weight: f64 = 0.2, "weight", within(0.0, 100.0);
        /// Standard deviation of the place of the apple's silhouette. Larger: the silhouette counts for less. Left out:
        /// by the frame, from 0.7 where edges are sharp to 3 where depth is smeared.
        contour_sd_px: Option<f64> = None, "pixels", above(0.0).at_most(1000.0), example 0.7;
        /// Standard deviation of an apple's surface about a spheroid. Larger: single readings count for less. Left
        /// out: by the frame, 0.0003, and where depth is smeared the error that neighbouring readings share.
        shape_sd_m: Option<f64> = None, "metres", above(0.0).at_most(1000.0), example 0.0003;
        /// Smallest radius of a branch. Smaller: stalks count as branches.
        branch_radius_min_m: f64 = 0.0013, "metres", above(0.0).at_most(0.1);
        /// Largest radius of a branch. Larger: posts and trunks count as branches.
        branch_radius_max_m: f64 = 0.018, "metres", above(0.0).at_most(0.1);
        /// Least distance of a branch's axis from the apple's centre. Less: leaves and stalks on the apple itself.
        branch_near: f64 = 0.85, "radii", above(0.0).at_most(10.0);
        /// Largest distance of a branch's axis from the apple's centre. More: branches that the apple does not hang
        /// from.
        branch_far: f64 = 1.9, "radii", above(0.0).at_most(10.0);
        /// Length to either side of its foot along which a branch is looked at. More: longer evidence, and bends that
        /// do not fit.
        branch_reach: f64 = 2.9, "radii", above(1.0).at_most(10.0);
        /// Standard deviation of a branch's bend: distance aside over the square of that along. More: bent branches
        /// are followed, and chance arcs.
        branch_bend_sd_per_m: f64 = 0.2, "per metre", above(0.0).at_most(1000.0);
        /// Lines that are looked at. More: branches that are barely visible are found more often, and slower.
        branch_guesses: usize = 45, "count", within(1.0, 1e5);
        /// Whether the nearest candidate that is probably a branch is answered. Off: the likeliest to be one, near or
        /// far.
        nearest_first: bool = true, "yes or no", any();
        /// Answers with a smaller confidence are refused. Higher: fewer and better answers.
        least_confidence: f64 = 0.35, "probability", within(0.0, 1.0);
    }
    order {
        branch_radius_max_m > branch_radius_min_m;
        branch_far > branch_near;
    }
}
