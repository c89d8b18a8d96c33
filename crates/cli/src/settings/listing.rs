//! Every setting with its unit and meaning.

/// One setting, as `pomona config` explains it.
pub(crate) struct Setting {
    /// Its name, as in the file.
    pub(crate) name: &'static str,
    /// What its number counts or measures.
    pub(crate) unit: &'static str,
    /// What it is, and what more or less of it costs.
    pub(crate) meaning: &'static str,
}

const fn setting(name: &'static str, unit: &'static str, meaning: &'static str) -> Setting {
    Setting {
        name,
        unit,
        meaning,
    }
}

/// Every setting, in the order of the file.
pub(crate) const SETTINGS: &[Setting] = &[
    setting(
        "method",
        "name",
        "The method. robust: ours. paper: Gao et al. 2022, doi 10.3390/agriculture12081170.",
    ),
    setting(
        "paper.sphere_iterations",
        "count",
        "Spheres tried within the radius bounds. More: steadier, and slower in proportion. The paper's figure.",
    ),
    setting(
        "paper.sphere_band",
        "share of the radius",
        "A point within this share of the radius supports a sphere. Wider: more noise is \
         borne, and leaves pass for surface. The paper's figure is 1/5.",
    ),
    setting(
        "paper.radius_min_m",
        "metres",
        "Smallest radius of an apple. The paper states none. Too small: spheres in a dent or a leaf.",
    ),
    setting(
        "paper.radius_max_m",
        "metres",
        "Largest radius of an apple. The paper states none. Too large: spheres that take leaves for surface.",
    ),
    setting(
        "paper.sphere_min_points",
        "count",
        "Fewest points that make an apple. Fewer: small and hidden apples are answered, and less reliably.",
    ),
    setting(
        "paper.shell_inner",
        "radii",
        "The branch is looked for from this far from the centre. Nearer: the apple's own surface gets in. \
         The paper's figure.",
    ),
    setting(
        "paper.shell_outer",
        "radii",
        "And up to this far. Farther: more of the branch, and more of other things. The paper's figure.",
    ),
    setting(
        "paper.line_iterations",
        "count",
        "Lines tried at an allowed distance. More: steadier, and slower in proportion. The paper's figure.",
    ),
    setting(
        "paper.line_band_m",
        "metres",
        "A point within this distance supports a line. Wider: thick and bent branches, and leaves. \
         The paper's figure.",
    ),
    setting(
        "paper.line_distance_min",
        "radii",
        "A line passes the centre at no less than this. Less: lines through the apple itself. The paper's figure.",
    ),
    setting(
        "paper.line_distance_max",
        "radii",
        "And at no more than this. More: branches that the apple does not hang from. The paper's figure.",
    ),
    setting(
        "paper.line_min_points",
        "count",
        "Fewest points that make a branch. Fewer: thin branches are found, and chance rows of points.",
    ),
    setting(
        "robust.sensor",
        "name",
        "The depth camera: generic, paper, kinect, azure-kinect or d400. Decides from which difference on two readings disagree.",
    ),
    setting(
        "robust.noise_m",
        "metres",
        "Standard deviation of a depth reading at depth z as a + b z + c z²: [a, b, c], metres. Empty: that of sensor.",
    ),
    setting(
        "robust.radius_min_m",
        "metres",
        "Smallest radius of a sphere that is tried; a fit more than a tenth below it is refused.",
    ),
    setting(
        "robust.radius_max_m",
        "metres",
        "Largest radius of a sphere that is tried; a fit more than a tenth above it is refused.",
    ),
    setting(
        "robust.radius_mean_m",
        "metres",
        "Radius that apples are believed to have. Counts where little of one shows.",
    ),
    setting(
        "robust.radius_sd_m",
        "metres",
        "Standard deviation of that belief. Smaller: hidden apples are steadier, odd sizes worse.",
    ),
    setting(
        "robust.box_radius_sd_m",
        "metres",
        "Standard deviation, metres, of a radius read off the smaller side of a box; 0 (default): boxes do not say how large apples are. For drawn boxes and smeared depth 0.001, for boxes of what shows of hidden apples 0.",
    ),
    setting(
        "robust.rim_share",
        "share",
        "Share of a box's width and height on each side whose readings are left out. For time-of-flight cameras, which smear an apple's rim backwards, 0.15.",
    ),
    setting(
        "robust.flattening_mean",
        "share",
        "Share by which apples are believed to be lower than wide.",
    ),
    setting(
        "robust.flattening_sd",
        "share",
        "Standard deviation of that belief.",
    ),
    setting(
        "robust.stem_sd_rad",
        "radians",
        "Standard deviation of the stem's angle to the image's upward direction.",
    ),
    setting(
        "robust.min_readings",
        "count",
        "Fewest readings in a box that make an apple.",
    ),
    setting(
        "robust.sphere_draws",
        "count",
        "Spheres tried through four random points. More: steadier among leaves, and slower.",
    ),
    setting(
        "robust.sphere_kept",
        "count",
        "Spheres of these that are refined.",
    ),
    setting(
        "robust.blocks",
        "count",
        "Blocks along the longer side of a box, over which readings are averaged. More: finer and slower.",
    ),
    setting(
        "robust.box_weight",
        "weight",
        "Weight of the box against the points when spheres compete. 0 for boxes that mean little.",
    ),
    setting(
        "robust.contour_sd_px",
        "pixels",
        "Standard deviation of the place of the apple's outline.",
    ),
    setting(
        "robust.shape_sd_m",
        "metres",
        "Standard deviation of an apple's surface about a flattened sphere.",
    ),
    setting(
        "robust.branch_radius_min_m",
        "metres",
        "Smallest radius of a branch. Smaller: stalks count as branches.",
    ),
    setting(
        "robust.branch_radius_max_m",
        "metres",
        "Largest radius of a branch.",
    ),
    setting(
        "robust.branch_near",
        "radii",
        "Least distance of a branch's axis from the apple's centre.",
    ),
    setting(
        "robust.branch_far",
        "radii",
        "Largest distance of a branch's axis from the apple's centre.",
    ),
    setting(
        "robust.branch_reach",
        "radii",
        "Length to either side of its foot along which a branch is looked at.",
    ),
    setting(
        "robust.branch_bend_sd_per_m",
        "per metre",
        "Standard deviation of a branch's bend: way aside over distance squared.",
    ),
    setting(
        "robust.branch_guesses",
        "count",
        "Lines that are looked at. More: branches that hardly show are found more often, and slower.",
    ),
    setting(
        "robust.least_confidence",
        "probability",
        "Answers with a smaller confidence are refused. Higher: fewer and better answers.",
    ),
    setting(
        "detection.depth_check",
        "yes or no",
        "Whether depth has a say about a detector's boxes. false: they are taken as they come.",
    ),
    setting(
        "detection.pick_marked",
        "yes or no",
        "Whether boxes that depth refuses are picked all the same. They keep their marks.",
    ),
    setting(
        "detection.radius_min_m",
        "metres",
        "Smallest radius of what is taken for an apple.",
    ),
    setting(
        "detection.radius_max_m",
        "metres",
        "Largest radius of what is taken for an apple.",
    ),
    setting(
        "detection.range_max_m",
        "metres",
        "Farthest depth at which an apple is worth picking.",
    ),
    setting(
        "detection.min_readings",
        "count",
        "Fewest readings in a box by which depth can judge; with fewer it is marked no_depth and left to the method.",
    ),
    setting(
        "detection.least_roundness",
        "share",
        "Least curvature of the surface in every direction, as a share of a sphere's. Higher: more of what is no apple is marked, and more apples that leaves cut up.",
    ),
    setting(
        "detection.merge_distance",
        "radii",
        "Two boxes are of one apple where their spheres' centres are nearer than this. 0: none are joined.",
    ),
    setting(
        "detection.depth_search",
        "yes or no",
        "Whether apples that the colour misses are looked for in depth. true: more is found, some of it no apple, and a frame takes longer.",
    ),
    setting(
        "detection.search_coverage",
        "share",
        "Least share of its outline on which an apple found in depth shows. Lower: hidden apples are found, and more of what is none.",
    ),
    setting(
        "fallback.kind",
        "name",
        "What a refused apple with a sphere gets beside its refusal: none, surface_normal (from the side that shows) or away_from_obstacle (from the side that faces away from the nearest obstacle). A guess, labelled as such.",
    ),
    setting(
        "fusion.moved_rate",
        "share",
        "Of pairs of sightings of one apple at rest, those that may be called moved. Smaller: small movements are taken for noise.",
    ),
    setting(
        "fusion.direction_rate",
        "share",
        "Of right directions, those that may be dropped for contradicting the other frames.",
    ),
    setting(
        "fusion.center_sd_m",
        "metres",
        "Standard deviation of a centre along each axis where a frame states none (method paper).",
    ),
    setting(
        "fusion.center_floor_m",
        "metres",
        "Added to a stated one for what the method cannot know. Larger: fewer false movements, and small ones are overlooked.",
    ),
    setting("fusion.radius_floor_m", "metres", "The same for a radius."),
    setting(
        "fusion.direction_sd_rad",
        "radians",
        "Standard deviation of a direction where a frame states none (method paper).",
    ),
    setting(
        "fusion.direction_floor_rad",
        "radians",
        "Added to a stated one.",
    ),
    setting(
        "fusion.sway_sd_m",
        "metres",
        "Standard deviation, along each axis, of the way that a whole tree may sway between frames, or a pose may be off beyond what it states. 0: nothing sways.",
    ),
    setting(
        "fusion.sway_sd_rad",
        "radians",
        "The same for turning, about each axis.",
    ),
    setting(
        "fusion.moved_reach",
        "share",
        "Two places are of one moved apple up to this share of the sum of their radii; farther apart are two apples.",
    ),
    setting(
        "fusion.moved_visible",
        "share",
        "Least visible share of an apple at both places for it to have moved; what is seen worse is a misfit.",
    ),
    setting(
        "fusion.confidence",
        "probability",
        "Confidence of a direction where a frame states none (method paper).",
    ),
    setting(
        "fusion.repeated_error",
        "share",
        "Of wrong directions, those that another frame repeats. Larger: agreement counts for less.",
    ),
    setting(
        "fusion.least_confidence",
        "probability",
        "Fused answers with a smaller confidence are refused. Higher: fewer and better answers.",
    ),
    setting(
        "fusion.voxel_m",
        "metres",
        "Edge of the cells in which the points of the fused cloud are joined.",
    ),
];
