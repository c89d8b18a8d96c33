//! What a person sees in an overlay, read off its pixels.

use nalgebra::Point3;
use pomona_cloud::{Camera, ColorImage, PixelBox};
use pomona_geometry::Sphere;
use pomona_view::{AppleMark, Overlay, ViewError, palette};
use proptest::prelude::*;

const WIDTH: usize = 480;
const HEIGHT: usize = 360;
const GROUND: [u8; 3] = [100, 100, 100];

fn image() -> ColorImage {
    ColorImage {
        width: WIDTH,
        height: HEIGHT,
        pixels: vec![GROUND; WIDTH * HEIGHT],
    }
}

fn camera() -> Camera {
    Camera::new([WIDTH, HEIGHT], [400.0; 2], [239.5, 179.5])
}

fn bounds(x_min: f64, y_min: f64, x_max: f64, y_max: f64) -> PixelBox {
    PixelBox {
        name: String::from("apple"),
        x_min,
        y_min,
        x_max,
        y_max,
        score: 1.0,
    }
}

fn draw(marks: &[AppleMark<'_>]) -> ColorImage {
    let picture = Overlay::new(&image(), &camera()).legend(false).draw(marks);
    picture.expect("an image with pixels can be drawn on")
}

fn at(picture: &ColorImage, u: usize, v: usize) -> [u8; 3] {
    picture.pixels[v * WIDTH + u]
}

/// Whether every channel is within `tolerance`: strokes are anti-aliased over what lies beneath.
fn is_near(a: [u8; 3], b: [u8; 3], tolerance: u8) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= tolerance)
}

#[test]
fn without_marks_the_picture_is_the_image() {
    assert_eq!(
        Overlay::new(&image(), &camera()).draw(&[]).unwrap(),
        image()
    );
}

#[test]
fn a_box_is_blue_on_its_edges_only() {
    let picture = draw(&[AppleMark::new(0, bounds(200.0, 150.0, 280.0, 230.0))]);
    for edge in [(200, 190), (280, 190), (240, 230)] {
        let (u, v) = edge;
        let pixels = [
            at(&picture, u, v),
            at(&picture, u - 1, v),
            at(&picture, u, v - 1),
        ];
        assert!(
            pixels.iter().any(|p| p[2] > p[0] + 80),
            "{edge:?} {pixels:?}"
        );
    }
    assert_eq!(at(&picture, 240, 190), GROUND);
    assert_eq!(at(&picture, 20, 20), GROUND);
}

#[test]
fn points_are_tinted_and_translucent() {
    let index = |u: usize, v: usize| (v * WIDTH + u) as u32;
    let (surface, branch) = ([index(240, 190), u32::MAX], [index(220, 100)]);
    let mut mark = AppleMark::new(0, bounds(200.0, 150.0, 280.0, 230.0));
    mark.surface_pixels = &surface;
    mark.branch_pixels = &branch;
    let picture = draw(&[mark]);
    let pink = at(&picture, 240, 190);
    assert!(pink[0] > GROUND[0] && pink[0] < palette::SURFACE[0]);
    let green = at(&picture, 220, 100);
    assert!(green[1] > GROUND[1] && green[1] < palette::BRANCH[1] && green[0] < GROUND[0]);
}

#[test]
fn overlapping_points_tint_once() {
    let index = |u: usize, v: usize| (v * WIDTH + u) as u32;
    let one = [index(240, 190)];
    let many = [
        index(240, 190),
        index(240, 190),
        index(241, 190),
        index(240, 191),
    ];
    let draw_surface = |pixels: &[u32]| {
        let mut mark = AppleMark::new(0, bounds(200.0, 150.0, 280.0, 230.0));
        mark.surface_pixels = pixels;
        at(&draw(&[mark]), 240, 190)
    };
    assert_eq!(draw_surface(&one), draw_surface(&many));
}

#[test]
fn an_arrow_is_red_along_its_way() {
    let mut mark = AppleMark::new(3, bounds(200.0, 150.0, 280.0, 230.0));
    // From the principal point 80 px upwards.
    mark.arrow = Some((Point3::new(0.0, 0.0, 1.0), Point3::new(0.0, -0.2, 1.0)));
    let picture = draw(&[mark]);
    for v in [105, 130, 170] {
        let p = at(&picture, 239, v);
        assert!(p[0] > 180 && p[1] < 120, "row {v}: {p:?}");
    }
}

#[test]
fn arrows_along_the_sight_are_seen_and_told_apart() {
    let marker = |z: f64| {
        let mut mark = AppleMark::new(3, bounds(200.0, 140.0, 280.0, 220.0));
        mark.arrow = Some((Point3::new(0.0, 0.0, 1.0), Point3::new(0.0, 0.0, z)));
        draw(&[mark])
    };
    let (towards, away) = (marker(0.9), marker(1.1));
    let red = |p: &&[u8; 3]| is_near(**p, palette::DIRECTION, 30);
    assert!(towards.pixels.iter().filter(red).count() > 10);
    assert!(away.pixels.iter().filter(red).count() > 10);
    assert_ne!(towards, away);
}

#[test]
fn a_refused_box_is_hatched_and_says_why() {
    let mut mark = AppleMark::new(0, bounds(200.0, 150.0, 280.0, 230.0));
    let plain = draw(std::slice::from_ref(&mark));
    mark.refused = Some("no_branch".into());
    let picture = draw(&[mark]);
    // Along the box's middle row hatching and ground alternate.
    let row: Vec<bool> = (204..276).map(|u| at(&picture, u, 190)[0] > 150).collect();
    let changes = row.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes >= 8, "{changes} changes");
    let bright = |p: &ColorImage| {
        p.pixels
            .iter()
            .filter(|p| is_near(**p, [255; 3], 80))
            .count()
    };
    assert!(
        bright(&picture) > bright(&plain) + 50,
        "the reason is written"
    );
}

#[test]
fn a_sphere_is_outlined() {
    let mut mark = AppleMark::new(0, bounds(0.0, 0.0, 20.0, 20.0));
    mark.sphere = Sphere::new(Point3::new(0.0, 0.0, 1.0), 0.1);
    let picture = draw(&[mark]);
    // tan(asin(0.1)) at 400 px is 40.2 px.
    let brightest = (276..284).map(|u| at(&picture, u, 180)[0]).max().unwrap();
    assert!(brightest > 150);
    assert_eq!(at(&picture, 240, 180), GROUND);
}

#[test]
fn the_legend_explains_only_what_is_drawn() {
    let mark = AppleMark::new(0, bounds(230.0, 170.0, 250.0, 190.0));
    let with = Overlay::new(&image(), &camera())
        .draw(std::slice::from_ref(&mark))
        .unwrap();
    let without = Overlay::new(&image(), &camera())
        .legend(false)
        .draw(&[mark])
        .unwrap();
    let changed: Vec<usize> = (0..WIDTH * HEIGHT)
        .filter(|i| with.pixels[*i] != without.pixels[*i])
        .collect();
    let rows = changed.iter().map(|i| i / WIDTH).max().unwrap()
        - changed.iter().map(|i| i / WIDTH).min().unwrap();
    assert!(rows < 60, "one line, not {rows} rows");
}

#[test]
fn an_image_that_is_none_is_an_error() {
    let empty = ColorImage {
        width: 0,
        height: 0,
        pixels: vec![],
    };
    assert!(matches!(
        Overlay::new(&empty, &camera()).draw(&[]),
        Err(ViewError::Size { .. })
    ));
    let short = ColorImage {
        pixels: vec![GROUND; 3],
        ..image()
    };
    assert!(matches!(
        Overlay::new(&short, &camera()).draw(&[]),
        Err(ViewError::PixelCount { .. })
    ));
}

#[test]
fn thousands_of_marks_on_a_small_picture() {
    let marks: Vec<AppleMark<'_>> = (0..5000)
        .map(|i| {
            let (x, y) = (f64::from(i % 97) * 5.0, f64::from(i % 71) * 5.0);
            let mut mark = AppleMark::new(i as usize, bounds(x, y, x + 20.0, y + 20.0));
            mark.caption = Some("r 36 mm".into());
            mark
        })
        .collect();
    let picture = Overlay::new(&image(), &camera()).draw(&marks).unwrap();
    assert_eq!(picture.pixels.len(), WIDTH * HEIGHT);
}

fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -600.0..900.0f64,
        3 => -2.0..2.0f64,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 0.0, -0.0,
        ]),
    ]
}

type Wild = (
    [f64; 4],
    [f64; 6],
    f64,
    Vec<u32>,
    Option<String>,
    Option<String>,
);

fn wild_mark() -> impl Strategy<Value = Wild> {
    (
        prop::array::uniform4(wild()),
        [wild(), wild(), wild(), wild(), wild(), wild()],
        wild(),
        prop::collection::vec(any::<u32>(), 0..20),
        prop::option::of(".{0,80}"),
        prop::option::of("[a-z_]{0,12}"),
    )
}

proptest! {
    #[test]
    fn no_mark_panics_and_the_picture_is_the_same_twice(
        wilds in prop::collection::vec(wild_mark(), 0..12),
        width in 1usize..200,
        height in 1usize..160,
        (fx, cx) in (wild(), wild()),
    ) {
        let image = ColorImage { width, height, pixels: vec![GROUND; width * height] };
        let mut camera = camera();
        (camera.fx, camera.cx) = (fx, cx);
        let marks: Vec<AppleMark<'_>> = wilds
            .iter()
            .enumerate()
            .map(|(i, ([a, b, c, d], p, radius, pixels, caption, refused))| {
                let mut mark = AppleMark::new(i * i * 12345, bounds(*a, *b, *c, *d));
                let start = Point3::new(p[0], p[1], p[2]);
                mark.arrow = Some((start, Point3::new(p[3], p[4], p[5])));
                // Its fields are public, so that a sphere need not be one.
                mark.sphere = Some(Sphere { center: start, radius: *radius });
                mark.surface_pixels = pixels;
                mark.branch_pixels = pixels;
                mark.caption.clone_from(caption);
                mark.refused.clone_from(refused);
                mark
            })
            .collect();
        let overlay = Overlay::new(&image, &camera);
        let picture = overlay.draw(&marks).unwrap();
        prop_assert_eq!((picture.width, picture.height), (width, height));
        prop_assert_eq!(overlay.draw(&marks).unwrap(), picture);
    }
}
