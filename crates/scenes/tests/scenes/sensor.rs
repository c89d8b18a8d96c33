//! What a sensor does to depth has the statistics that its fields state.
//!
//! Bounds are four standard errors of the statistic in question: with fixed
//! seeds they hold or do not, and a change of the draws meets them by chance
//! but once in 16 000.

use nalgebra::{Point3, Vector3};
use pomona_cloud::{Camera, DepthImage};
use pomona_geometry::Plane;
use pomona_scenes::{
    Apple, Axial, Bias, Branch, Curve, Dropout, Edges, Light, Make, Sensor, Shot, Sunlight, Thin,
    World,
};

const WIDTH: usize = 320;
const HEIGHT: usize = 240;
const COUNT: f64 = (WIDTH * HEIGHT) as f64;

fn camera() -> Camera {
    Shot::paper_camera().with_intrinsics([WIDTH, HEIGHT], [270.0; 2], [159.5, 119.5])
}

fn wall(z: f64) -> World {
    let mut world = World::new(Light::default());
    world.add_backdrop(Plane::new(Point3::new(0.0, 0.0, z), -Vector3::z()).unwrap());
    world
}

fn wall_and_ball() -> World {
    let mut world = wall(1.0);
    world.add_apple(Apple::sphere(Point3::new(0.0, 0.0, 0.7), 0.2));
    world
}

fn depth(world: &World, sensor: Sensor, seed: u64) -> DepthImage {
    Shot::new("test", camera(), sensor, seed)
        .take(world)
        .frame
        .depth
}

fn metres(image: &DepthImage, sensor: &Sensor) -> Vec<f64> {
    image
        .readings
        .iter()
        .map(|&r| f64::from(r) * sensor.depth_scale)
        .collect()
}

fn mean_and_variance(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (
        mean,
        values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0),
    )
}

fn assert_share(found: usize, of: usize, stated: f64) {
    let share = found as f64 / of as f64;
    let error = (stated * (1.0 - stated) / of as f64).sqrt();
    assert!(
        (share - stated).abs() < 4.0 * error,
        "{share} of {of} against {stated} ± {error}"
    );
}

fn assert_share_or_none(found: usize, of: usize, stated: f64) {
    if stated == 0.0 {
        assert_eq!(found, 0);
    } else {
        assert_share(found, of, stated);
    }
}

#[test]
fn axial_noise_has_the_stated_deviation_and_no_bias() {
    for z in [0.8, 1.5, 3.0] {
        let sensor = Sensor::paper().with(|s| s.range_m = (0.1, 6.0));
        let values = metres(&depth(&wall(z), sensor.clone(), 5), &sensor);
        let (mean, variance) = mean_and_variance(&values);
        // Rounding to a step adds a twelfth of its square.
        let stated = sensor.axial.sigma(z).powi(2) + sensor.step_m.powi(2) / 12.0;
        assert!(
            (mean - z).abs() < 4.0 * (stated / COUNT).sqrt(),
            "mean {mean} at {z}"
        );
        assert!(
            (variance / stated - 1.0).abs() < 4.0 * (2.0 / COUNT).sqrt(),
            "{variance} at {z}"
        );
        let neighbours: f64 = values
            .windows(2)
            .map(|w| (w[0] - mean) * (w[1] - mean))
            .sum();
        let correlation = neighbours / COUNT / variance;
        assert!(
            correlation.abs() < 4.0 / COUNT.sqrt(),
            "correlation {correlation} at {z}"
        );
    }
}

#[test]
fn every_make_has_the_deviation_and_the_edges_that_it_states() {
    for make in Make::ALL {
        let sensor = make.sensor();
        let values = metres(&depth(&wall(1.0), sensor.clone(), 9), &sensor);
        let (mean, variance) = mean_and_variance(&values);
        let stated = sensor.axial.sigma(1.0).powi(2) + sensor.step_m.powi(2) / 12.0;
        // Neighbours that share their error leave fewer independent values.
        let independent = COUNT / (sensor.correlation_px as f64).powi(2);
        let name = make.name();
        assert!(
            (mean - 1.0).abs() < 4.0 * (stated / independent).sqrt(),
            "{name}: {mean}"
        );
        let error = (2.0 / independent).sqrt();
        assert!(
            (variance / stated - 1.0).abs() < 4.0 * error,
            "{name}: {variance}"
        );

        // Edges alone, without what else moves or moves aside a reading.
        let still = Sensor::perfect().with(|s| s.edges = sensor.edges);
        let exact = metres(&depth(&wall_and_ball(), Sensor::perfect(), 0), &still);
        let found = metres(&depth(&wall_and_ball(), still.clone(), 9), &still);
        let edge = edges(&exact, still.edges.jump_m);
        let lost = edge.iter().filter(|(i, _)| found[*i] == 0.0).count();
        assert_share_or_none(lost, edge.len(), still.edges.invalid_share);
        let kept = edge.len() - lost;
        let mixed = edge
            .iter()
            .filter(|(i, _)| found[*i] != 0.0 && found[*i] != exact[*i])
            .count();
        assert_share_or_none(mixed, kept, still.edges.mixed_share);
    }
}

#[test]
fn correlated_noise_keeps_its_deviation_and_is_shared() {
    let axial = Axial::Disparity {
        sigma_px: 0.1,
        focal_px: 900.0,
        baseline_m: 0.055,
    };
    let sensor = Sensor::perfect().with(|s| {
        s.axial = axial;
        s.correlation_px = 4;
    });
    let values = metres(&depth(&wall(1.0), sensor.clone(), 5), &sensor);
    let (mean, variance) = mean_and_variance(&values);
    let stated = axial.sigma(1.0).powi(2);
    // A lattice of 4 pixels leaves about a sixteenth as many independent values.
    assert!(
        (variance / stated - 1.0).abs() < 4.0 * (2.0 * 16.0 / COUNT).sqrt(),
        "{variance}"
    );
    let neighbours: f64 = values
        .windows(2)
        .map(|w| (w[0] - mean) * (w[1] - mean))
        .sum();
    assert!(neighbours / COUNT / variance > 0.5);
}

#[test]
fn readings_are_multiples_of_the_step() {
    let sensor = Sensor::paper().with(|s| {
        s.step_m = 0.001;
        s.depth_scale = 0.0001;
    });
    let image = depth(&wall(0.8), sensor, 1);
    assert!(image.readings.iter().all(|r| r % 10 == 0 && *r > 0));
}

#[test]
fn out_of_range_there_is_no_reading() {
    let sensor = || Sensor::perfect().with(|s| s.range_m = (0.7, 3.5));
    assert_eq!(depth(&wall(0.69), sensor(), 0).reading_count(), 0);
    assert_eq!(depth(&wall(3.51), sensor(), 0).reading_count(), 0);
    assert_eq!(
        depth(&wall(0.71), sensor(), 0).reading_count(),
        WIDTH * HEIGHT
    );
}

/// Pixels with a neighbour farther than `jump` in depth, and that neighbour's depth.
fn edges(exact: &[f64], jump: f64) -> Vec<(usize, f64)> {
    let around = |i: usize| {
        let (x, y) = (i % WIDTH, i / WIDTH);
        let mut near = Vec::new();
        if x > 0 {
            near.push(i - 1);
        }
        if x + 1 < WIDTH {
            near.push(i + 1);
        }
        if y > 0 {
            near.push(i - WIDTH);
        }
        if y + 1 < HEIGHT {
            near.push(i + WIDTH);
        }
        near
    };
    (0..exact.len())
        .filter_map(|i| {
            let gap = |j: usize| (exact[j] - exact[i]).abs();
            let far = around(i)
                .into_iter()
                .max_by(|&a, &b| gap(a).total_cmp(&gap(b)))?;
            (gap(far) > jump).then_some((i, exact[far]))
        })
        .collect()
}

#[test]
fn flying_pixels_are_the_stated_share_of_the_edges_and_lie_between_the_sides() {
    let perfect = Sensor::perfect();
    let exact = metres(&depth(&wall_and_ball(), perfect.clone(), 0), &perfect);
    let edges_of = |mixed_share| Edges {
        mixed_share,
        ..perfect.edges
    };
    let mut ways = Vec::new();
    let (mut mixed, mut all) = (0, 0);
    for seed in 0..4 {
        let sensor = perfect.clone().with(|s| s.edges = edges_of(0.3));
        let flying = metres(&depth(&wall_and_ball(), sensor, seed), &perfect);
        let edge = edges(&exact, perfect.edges.jump_m);
        all += edge.len();
        for &(i, other) in &edge {
            if flying[i] != exact[i] {
                mixed += 1;
                ways.push((flying[i] - exact[i]) / (other - exact[i]));
            }
        }
        let inner = (0..exact.len()).filter(|i| edge.iter().all(|e| e.0 != *i));
        assert!(inner.into_iter().all(|i| flying[i] == exact[i]));
    }
    assert!(all > 2000, "{all} edge pixels");
    assert_share(mixed, all, 0.3);
    assert!(ways.iter().all(|w| (-0.01..1.01).contains(w)));
    let (mean, variance) = mean_and_variance(&ways);
    // An even law over 0..1 has variance 1/12, and its variance an error of √(1/180 n).
    let n = ways.len() as f64;
    assert!(
        (mean - 0.5).abs() < 4.0 * (1.0 / 12.0 / n).sqrt(),
        "mean {mean}"
    );
    assert!(
        (variance - 1.0 / 12.0).abs() < 4.0 * (1.0 / 180.0 / n).sqrt(),
        "variance {variance}"
    );
}

#[test]
fn rims_lose_the_stated_share_and_nothing_else() {
    let perfect = Sensor::perfect();
    let exact = metres(&depth(&wall_and_ball(), perfect.clone(), 0), &perfect);
    let edge = edges(&exact, perfect.edges.jump_m);
    for rim_px in [1, 2, 3] {
        let edges = Edges {
            invalid_share: 0.6,
            rim_px,
            ..perfect.edges
        };
        let image = depth(
            &wall_and_ball(),
            perfect.clone().with(|s| s.edges = edges),
            3,
        );
        let mut rim = vec![false; exact.len()];
        for &(i, _) in &edge {
            let (x, y) = ((i % WIDTH) as i64, (i / WIDTH) as i64);
            let reach = rim_px as i64 - 1;
            for j in -reach..=reach {
                for k in -reach..=reach {
                    rim[(y + j) as usize * WIDTH + (x + k) as usize] = true;
                }
            }
        }
        let lost = |i: &usize| image.readings[*i] == 0;
        assert_share(
            (0..rim.len()).filter(|&i| rim[i]).filter(lost).count(),
            rim.iter().filter(|r| **r).count(),
            0.6,
        );
        assert_eq!((0..rim.len()).filter(|&i| !rim[i]).filter(lost).count(), 0);
    }
}

#[test]
fn dropout_takes_its_share_in_patches() {
    let sensor = Sensor::perfect().with(|s| {
        s.dropout = Dropout {
            share: 0.2,
            patch_px: 4,
        }
    });
    let image = depth(&wall(1.0), sensor, 2);
    let lost = image.readings.iter().filter(|r| **r == 0).count();
    assert_eq!(lost % 16, 0);
    assert_share(lost / 16, WIDTH * HEIGHT / 16, 0.2);
}

#[test]
fn thin_wood_is_filled_to_the_stated_share_and_thick_wood_wholly() {
    let thin = Thin {
        thickness_m: 0.006,
        fill: 0.4,
    };
    let limb = |radius: f64| {
        let mut world = World::new(Light::default());
        for i in 0..6 {
            let y = -0.15 + 0.06 * f64::from(i);
            let curve = Curve::straight(Point3::new(-0.4, y, 0.5), Point3::new(0.4, y, 0.5));
            world.add_branch(Branch {
                curve,
                start_radius: radius,
                end_radius: radius,
            });
        }
        let whole = depth(&world, Sensor::perfect(), 0).reading_count();
        (
            depth(&world, Sensor::perfect().with(|s| s.thin = thin), 0).reading_count(),
            whole,
        )
    };
    let (left, whole) = limb(0.0029);
    // Patches of four by four pixels fall together: about four rows of a branch at once.
    let share = left as f64 / whole as f64;
    let error = (0.4 * 0.6 / (whole as f64 / 16.0)).sqrt();
    assert!((share - 0.4).abs() < 4.0 * error, "{share} of {whole}");
    let (left, whole) = limb(0.0031);
    assert_eq!(left, whole);
}

#[test]
fn sunlight_burns_holes_of_the_stated_area_where_the_sun_is_faced() {
    let sunlight = Sunlight {
        cell_share: 0.2,
        least_cosine: 0.3,
    };
    let sensor = || Sensor::perfect().with(|s| s.sunlight = sunlight);
    let mut lost = 0;
    let frames = 12;
    for seed in 0..frames {
        lost += WIDTH * HEIGHT - depth(&wall(1.0), sensor(), seed).reading_count();
    }
    // Radii even in 3..10 cover π·(10³ − 3³)/(3·7) pixels of 24² on average; discs that
    // overlap count once: a share of 1 − e^(−λ) for discs at random, less than λ on a lattice.
    let lambda = 0.2 * std::f64::consts::PI * 973.0 / 21.0 / 576.0;
    let share = lost as f64 / (COUNT * frames as f64);
    let discs = COUNT * frames as f64 / 576.0 * 0.2;
    // The area of one disc has a relative deviation of 0.66.
    let error = lambda * (1.0f64 + 0.44).sqrt() / discs.sqrt();
    assert!(
        share > 1.0 - (-lambda).exp() - 4.0 * error && share < lambda + 4.0 * error,
        "{share}"
    );
    let mut backlit = World::new(Light {
        toward_sun: Vector3::z_axis(),
        ..Light::default()
    });
    backlit.add_backdrop(Plane::new(Point3::new(0.0, 0.0, 1.0), -Vector3::z()).unwrap());
    assert_eq!(depth(&backlit, sensor(), 0).reading_count(), WIDTH * HEIGHT);
}

#[test]
fn bias_is_constant_and_tilted() {
    let bias = Bias {
        constant_m: 0.004,
        tilt: (0.01, -0.02),
    };
    let sensor = Sensor::perfect().with(|s| s.bias = bias);
    let values = metres(&depth(&wall(1.0), sensor.clone(), 0), &sensor);
    for (x, y) in [(0, 0), (319, 0), (10, 230), (160, 120)] {
        let (right, down) = ((x as f64 - 159.5) / 270.0, (y as f64 - 119.5) / 270.0);
        let expected = 1.004 + 0.01 * right - 0.02 * down;
        assert!((values[y * WIDTH + x] - expected).abs() < 0.6e-4);
    }
}

#[test]
fn lateral_noise_moves_readings_across_a_slope() {
    // Depth grows by 0.25 per metre to the right: a displacement of one pixel is
    // 0.25·z/f·z/(z − 0.25·x) or about 1 mm here.
    let mut world = World::new(Light::default());
    let normal = Vector3::new(0.25, 0.0, -1.0);
    world.add_backdrop(Plane::new(Point3::new(0.0, 0.0, 1.0), normal).unwrap());
    let sensor = Sensor::perfect().with(|s| s.lateral_px = 1.5);
    let exact = metres(&depth(&world, Sensor::perfect(), 0), &sensor);
    let moved = metres(&depth(&world, sensor.clone(), 8), &sensor);
    let shifts: Vec<f64> = (0..exact.len())
        .filter(|i| (20..WIDTH - 20).contains(&(i % WIDTH)))
        .map(|i| (moved[i] - exact[i]) / ((exact[i + 1] - exact[i - 1]) / 2.0))
        .collect();
    let (_, variance) = mean_and_variance(&shifts);
    // Rounding to whole pixels adds a twelfth; units of 0.1 mm against a slope of 1 mm another hundredth.
    assert!(
        (variance / (2.25 + 1.0 / 12.0) - 1.0).abs() < 0.04,
        "{variance}"
    );
}

#[test]
fn a_wrong_focal_length_and_a_shifted_colour_are_told_by_the_truth_alone() {
    let sensor = Sensor::perfect().with(|s| {
        s.focal_error = 0.02;
        s.color_shift_px = (2, 0);
    });
    let shot = |sensor| Shot::new("test", camera(), sensor, 0).take(&wall_and_ball());
    let (plain, wrong) = (shot(Sensor::perfect()), shot(sensor));
    assert_eq!(wrong.frame.camera.fx, 1.02 * 270.0);
    assert_eq!(wrong.truth.camera.as_ref().map(|c| c.fx), Some(270.0));
    assert_eq!(plain.truth.camera, None);
    assert_eq!(wrong.frame.depth, plain.frame.depth);
    assert_eq!(
        wrong.frame.color.get(102, 50),
        plain.frame.color.get(100, 50)
    );
    let center = |s: &pomona_scenes::Scene| s.truth.apples[0].center;
    assert_eq!(center(&plain), center(&wrong));
}
