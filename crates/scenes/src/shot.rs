use crate::random::{Normal, Purpose, stream};
use crate::raycast::{Raycast, raycast};
use crate::scene::{Scene, SceneClass};
use crate::scenery::photographed;
use crate::sensing::sense;
use crate::sensor::Sensor;
use crate::shade::shade;
use crate::truth::{AppleTruth, Truth};
use crate::visibility::look_at;
use crate::wood_seen::visible_wood;
use crate::world::{Bark, Owner, Shape, World};
use pomona_cloud::{Camera, ColorImage, Frame, GrayImage, PixelBox};

/// How a frame is taken of a world.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Shot {
    /// Name of the frame.
    pub id: String,
    /// The true camera; its depth scale is replaced by the sensor's.
    pub camera: Camera,
    /// The model of the depth sensor.
    pub sensor: Sensor,
    /// Seed of the sensor's noise.
    pub seed: u64,
    /// Pixels by which a box is wider on each side than what shows of its apple.
    pub box_margin_px: f64,
    /// Pixels that must show of an apple for it to be boxed and known to the truth.
    pub least_pixels: usize,
    /// Number of the apple that the scene is made for, where it is made for one.
    pub target: Option<usize>,
    /// Share of an apple that must show for it to be boxed and known to the truth.
    pub least_visible: f64,
    /// Standard deviation by which each edge of a frame's box differs from the truth's, pixels: a person or a detector
    /// draws it.
    pub box_sd_px: f64,
}

impl Shot {
    /// A shot with boxes 2 pixels wide of their apples, of which 30 pixels must show.
    pub fn new(id: impl Into<String>, camera: Camera, sensor: Sensor, seed: u64) -> Self {
        Self {
            id: id.into(),
            camera,
            sensor,
            seed,
            box_margin_px: 2.0,
            least_pixels: 30,
            target: None,
            least_visible: 0.0,
            box_sd_px: 0.0,
        }
    }

    /// The paper's camera: 1280×960 pixels, f = 1080 px.
    pub fn paper_camera() -> Camera {
        let mut camera = Camera::new([1280, 960], [1080.0; 2], [639.5, 479.5]);
        camera.depth_scale = Sensor::paper().depth_scale;
        camera
    }

    /// Takes the frame. The bytes depend on the world and on this shot alone.
    ///
    /// The camera's lens distortion is not applied: the world is seen through a pinhole.
    pub fn take(&self, world: &World) -> Scene {
        let cast = raycast(world, &self.camera);
        self.develop(world, &cast)
    }

    pub(crate) fn develop(&self, world: &World, cast: &Raycast) -> Scene {
        let sensor = &self.sensor;
        let mut real = self.camera.clone();
        (real.depth_scale, real.distortion) = (sensor.depth_scale, None);
        let mut stated = real.clone();
        stated.fx *= 1.0 + sensor.focal_error;
        stated.fy *= 1.0 + sensor.focal_error;
        let known = |index: usize| {
            let apple = look_at(
                world,
                &real,
                cast,
                index,
                self.box_margin_px,
                self.least_pixels,
            )?;
            if apple.visible_share < Some(self.least_visible) {
                return None;
            }
            let bounds = moved(apple.bounds, sensor.color_shift_px, &real);
            let target = self.target.map(|target| target == index);
            Some(AppleTruth {
                bounds,
                target,
                ..apple
            })
        };
        let apples: Vec<_> = (0..world.apples.len()).filter_map(known).collect();
        let color = shifted(shade(world, &real, cast), sensor.color_shift_px);
        let color = match world.scenery {
            Some(_) => photographed(&color, self.seed),
            None => color,
        };
        let depth = sense(world, &real, cast, sensor, self.seed);
        let mut frame = Frame::new(&self.id, stated.clone(), color, depth);
        frame.boxes = Some(self.drawn_boxes(&apples));
        let mut wood = visible_wood(world, &real, cast);
        let (right, down) = sensor.color_shift_px;
        for point in wood.iter_mut().flat_map(|stretch| &mut stretch.points) {
            point[0] += f64::from(right);
            point[1] += f64::from(down);
        }
        let mut truth = Truth::new(apples);
        truth.seed = Some(self.seed);
        truth.sensor = Some(sensor.name.to_string());
        truth.camera = (stated != real).then_some(real);
        let classes = shifted_classes(&class_of_pixels(world, cast), cast, sensor.color_shift_px);
        Scene {
            frame,
            truth,
            classes: Some(classes),
            wood: Some(wood),
        }
    }

    /// The boxes as they are drawn: those of the truth where nobody errs.
    fn drawn_boxes(&self, apples: &[AppleTruth]) -> Vec<PixelBox> {
        let mut boxes: Vec<PixelBox> = apples.iter().map(|a| a.bounds.clone()).collect();
        if self.box_sd_px > 0.0 {
            let mut rng = stream(self.seed, Purpose::Boxes, 0);
            let mut normal = Normal::default();
            let mut error = || normal.draw(&mut rng).clamp(-2.0, 2.0) * self.box_sd_px;
            let (width, height) = (self.camera.width as f64, self.camera.height as f64);
            for bounds in &mut boxes {
                bounds.x_min = (bounds.x_min + error()).clamp(0.0, width - 2.0);
                bounds.y_min = (bounds.y_min + error()).clamp(0.0, height - 2.0);
                bounds.x_max = (bounds.x_max + error()).clamp(bounds.x_min + 1.0, width);
                bounds.y_max = (bounds.y_max + error()).clamp(bounds.y_min + 1.0, height);
            }
        }
        boxes
    }
}

/// The class of each pixel's part.
fn class_of_pixels(world: &World, cast: &Raycast) -> Vec<u8> {
    let class = |part: &u32| {
        let class = match world.parts.get(*part as usize).map(|p| (p.owner, p.shape)) {
            Some((Owner::Apple(_), _)) => SceneClass::Fruit,
            Some((_, Shape::Limb(_, Bark::Green))) => SceneClass::Peduncle,
            Some((_, Shape::Limb(..))) => SceneClass::Wood,
            _ => SceneClass::Rest,
        };
        class as u8
    };
    cast.part.iter().map(class).collect()
}

/// The classes moved with the colour image.
fn shifted_classes(classes: &[u8], cast: &Raycast, shift: (i32, i32)) -> GrayImage {
    let (width, height) = (cast.width, cast.height);
    GrayImage {
        width,
        height,
        values: shifted_values(classes, (width, height), shift),
    }
}

/// The image moved right and down; its edge is repeated where nothing comes in.
fn shifted(image: ColorImage, shift: (i32, i32)) -> ColorImage {
    if shift == (0, 0) {
        return image;
    }
    let pixels = shifted_values(&image.pixels, (image.width, image.height), shift);
    ColorImage { pixels, ..image }
}

fn shifted_values<T: Copy>(
    values: &[T],
    (width, height): (usize, usize),
    (right, down): (i32, i32),
) -> Vec<T> {
    let (w, h) = (width as i64, height as i64);
    let mut moved = Vec::with_capacity(values.len());
    for y in 0..h {
        let from_y = (y - i64::from(down)).clamp(0, h - 1);
        let row = &values[(from_y * w) as usize..((from_y + 1) * w) as usize];
        moved.extend((0..w).map(|x| row[(x - i64::from(right)).clamp(0, w - 1) as usize]));
    }
    moved
}

/// A box that moves with the colour image, inside it.
fn moved(bounds: PixelBox, (right, down): (i32, i32), camera: &Camera) -> PixelBox {
    let (right, down) = (f64::from(right), f64::from(down));
    let (width, height) = (camera.width as f64, camera.height as f64);
    PixelBox {
        x_min: (bounds.x_min + right).clamp(0.0, width - 1.0),
        y_min: (bounds.y_min + down).clamp(0.0, height - 1.0),
        x_max: (bounds.x_max + right).clamp(1.0, width),
        y_max: (bounds.y_max + down).clamp(1.0, height),
        ..bounds
    }
}
