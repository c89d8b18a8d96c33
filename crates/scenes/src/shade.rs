use crate::apple::Variety;
use crate::leaf::Leaf;
use crate::light::Light;
use crate::random::value_noise;
use crate::ray::{Ray, Surface};
use crate::raycast::{NOTHING, Raycast};
use crate::shadow::ShadowGrid;
use crate::world::{Bark, Part, Shape, World};
use nalgebra::{Point3, Vector3};
use pomona_cloud::{Camera, ColorImage};
use rayon::prelude::*;

type Rgb = Vector3<f64>;

/// The colour image of what the rays met.
///
/// A pixel whose neighbours show another part averages four rays over the
/// parts around it, which takes the stairs off the edges.
pub(crate) fn shade(world: &World, camera: &Camera, cast: &Raycast) -> ColorImage {
    let encode = gamma_table();
    let shadows = ShadowGrid::new(world);
    let painter = Painter {
        world,
        camera,
        shadows: shadows.as_ref(),
    };
    let bytes =
        |color: Rgb| std::array::from_fn(|i| encode[(color[i].clamp(0.0, 1.0) * 4095.0) as usize]);
    // A wall shows one colour all over: worked out once instead of a million times.
    let walls = world.parts.iter().map(|part| painter.wall(part).map(bytes));
    let walls: Vec<Option<[u8; 3]>> = walls.collect();
    let mut pixels = vec![[0u8; 3]; cast.width * cast.height];
    pixels
        .par_chunks_mut(cast.width)
        .enumerate()
        .for_each(|(y, row)| {
            let plain_sky = painter.sky(y);
            let plain_bytes = bytes(plain_sky);
            for (x, pixel) in row.iter_mut().enumerate() {
                let (sky, sky_bytes) = match &world.scenery {
                    Some(scenery)
                        if cast.part[y * cast.width + x] == NOTHING || edge(cast, x, y) =>
                    {
                        let ray = Ray::of_pixel(camera, x as f64, y as f64);
                        let color = scenery.color(&ray, &world.light.up);
                        (color, bytes(color))
                    }
                    _ => (plain_sky, plain_bytes),
                };
                let around = around(cast, x, y);
                let own = around[0];
                let plain = if own == NOTHING {
                    Some(sky_bytes)
                } else {
                    walls[own as usize]
                };
                *pixel = match plain {
                    Some(plain) if around == [own; 5] => plain,
                    _ => bytes(painter.pixel(cast, (x, y), &around, sky)),
                };
            }
        });
    ColorImage {
        width: cast.width,
        height: cast.height,
        pixels,
    }
}

/// The parts that a pixel and its four neighbours show.
fn around(cast: &Raycast, x: usize, y: usize) -> [u32; 5] {
    let (w, h) = (cast.width, cast.height);
    let pixel = y * w + x;
    [
        cast.part[pixel],
        cast.part[pixel - usize::from(x > 0)],
        cast.part[pixel + usize::from(x + 1 < w)],
        cast.part[if y > 0 { pixel - w } else { pixel }],
        cast.part[if y + 1 < h { pixel + w } else { pixel }],
    ]
}

/// Whether a pixel beside this one shows nothing.
fn edge(cast: &Raycast, x: usize, y: usize) -> bool {
    around(cast, x, y).contains(&NOTHING)
}

struct Painter<'a> {
    world: &'a World,
    camera: &'a Camera,
    shadows: Option<&'a ShadowGrid<'a>>,
}

impl Painter<'_> {
    fn pixel(&self, cast: &Raycast, at: (usize, usize), around: &[u32; 5], sky: Rgb) -> Rgb {
        let own = around[0];
        let (u, v) = (at.0 as f64, at.1 as f64);
        if around.iter().all(|&p| p == own) {
            let ray = Ray::of_pixel(self.camera, u, v);
            let depth = f64::from(cast.depth[at.1 * cast.width + at.0]);
            let part = self.world.parts.get(own as usize);
            return part.map_or(sky, |part| self.surface(part, &ray, depth));
        }
        let offsets = [
            (-0.25, -0.125),
            (0.125, -0.25),
            (0.25, 0.125),
            (-0.125, 0.25),
        ];
        let sum = offsets.iter().map(|(du, dv)| {
            let ray = Ray::of_pixel(self.camera, u + du, v + dv);
            let nearest = around
                .iter()
                .filter(|&&p| p != NOTHING)
                .map(|&p| &self.world.parts[p as usize])
                .filter_map(|part| Some((part, part.hit(&ray)?)))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            match nearest {
                Some((part, t)) => self.surface(part, &ray, t),
                None => sky,
            }
        });
        sum.sum::<Rgb>() / 4.0
    }

    /// The colour of a wall on which no shadow can fall; `None` for all other parts.
    ///
    /// It is that of the wall's point nearest to the lens: light from afar
    /// falls on all of it alike.
    fn wall(&self, part: &Part) -> Option<Rgb> {
        let Shape::Plane(plane) = &part.shape else {
            return None;
        };
        let direction = plane.normal.into_inner() * plane.offset;
        let ray = Ray {
            origin: Point3::origin(),
            direction,
        };
        self.shadows
            .is_none()
            .then(|| self.surface(part, &ray, 1.0))
    }

    /// Pale above the horizon, bluer towards the zenith, a hazy green below it; one colour a row.
    fn sky(&self, y: usize) -> Rgb {
        let ray = Ray::of_pixel(self.camera, self.camera.cx, y as f64);
        let rise = ray.direction.dot(&self.world.light.up) / ray.direction.norm();
        let haze = Rgb::new(0.80, 0.85, 0.88);
        if rise >= 0.0 {
            haze.lerp(&Rgb::new(0.36, 0.56, 0.86), (rise * 1.4).min(1.0))
        } else {
            haze.lerp(&Rgb::new(0.34, 0.42, 0.24), (-rise * 5.0).min(1.0))
        }
    }

    fn surface(&self, part: &Part, ray: &Ray, t: f64) -> Rgb {
        let point = ray.at(t);
        let surface = part.surface(&point);
        let light = &self.world.light;
        let backside = surface.normal.dot(&ray.direction) > 0.0;
        let normal = if backside {
            -surface.normal
        } else {
            surface.normal
        };
        let weathered = self.world.scenery.is_some();
        let finish = finish(part, &surface, &point, (backside, weathered), light);
        let facing = normal.dot(&light.toward_sun);
        let lit = match self.shadows {
            Some(grid) if grid.is_shadowed(&point, &(normal * facing.signum())) => 0.0,
            _ => 1.0,
        };
        let sun = Rgb::from(light.sun);
        let above = 0.5 + 0.5 * normal.dot(&light.up);
        let ambient = Rgb::from(light.ground).lerp(&Rgb::from(light.sky), above);
        let through = finish.translucency * (-facing).max(0.0);
        let diffuse = ambient + sun * (lit * (facing.max(0.0) + through));
        let color = finish.albedo.component_mul(&diffuse);
        if finish.gloss * lit == 0.0 {
            return color;
        }
        let view = -ray.direction.normalize();
        let half = (light.toward_sun.into_inner() + view).normalize();
        color + sun * (finish.gloss * normal.dot(&half).max(0.0).powi(finish.sharpness))
    }
}

/// How a surface answers to light.
struct Finish {
    albedo: Rgb,
    gloss: f64,
    sharpness: i32,
    /// Share of the light from behind that shines through.
    translucency: f64,
}

fn finish(
    part: &Part,
    surface: &Surface,
    point: &Point3<f64>,
    (backside, weathered): (bool, bool),
    light: &Light,
) -> Finish {
    match &part.shape {
        Shape::Apple(apple) => {
            let cheek = (point - apple.center).normalize().dot(&light.toward_sun);
            let key = (apple.radius * 1e7) as u64;
            let albedo = apple_skin(apple.variety, surface, cheek, key);
            Finish {
                albedo,
                gloss: 0.22,
                sharpness: 28,
                translucency: 0.0,
            }
        }
        Shape::Limb(limb, bark) => {
            let thickness = limb.thickness();
            Finish {
                albedo: match (bark, weathered) {
                    (Bark::Wood, true) => weathered_bark(surface, point, thickness),
                    _ => bark_skin(*bark, surface, point, thickness),
                },
                gloss: 0.02,
                sharpness: 8,
                translucency: 0.0,
            }
        }
        Shape::Leaf(leaf) => Finish {
            albedo: if weathered {
                weathered_leaf(leaf, surface, backside)
            } else {
                leaf_skin(leaf.tint, surface, backside)
            },
            gloss: if backside { 0.02 } else { 0.08 },
            sharpness: 14,
            translucency: 0.75,
        },
        Shape::Plane(_) => {
            let albedo = Rgb::new(0.55, 0.53, 0.50);
            Finish {
                albedo,
                gloss: 0.0,
                sharpness: 1,
                translucency: 0.0,
            }
        }
    }
}

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Red over yellow-green, streaked from stem to calyx, with a russet cavity and a dark calyx.
fn apple_skin(variety: Variety, surface: &Surface, cheek: f64, key: u64) -> Rgb {
    let ground = Rgb::new(0.60, 0.58, 0.12);
    let red = Rgb::new(0.52, 0.025, 0.035);
    let (turn, c) = (surface.u, surface.v);
    // The turn closes on itself: noise on a circle has no seam.
    let (x, y) = (turn.cos(), turn.sin());
    let streak = value_noise(key, x * 7.0, y * 7.0, c * 2.0)
        + 0.7 * value_noise(key ^ 2, x * 19.0, y * 19.0, c * 2.5)
        - 0.85;
    let cloud = value_noise(key ^ 1, x * 1.6, y * 1.6, c * 1.6) - 0.5;
    let blush = match variety {
        Variety::Red => 0.92 + 0.25 * cloud + 0.14 * streak + 0.10 * cheek,
        Variety::Blushed => 0.55 + 0.55 * cheek + 0.55 * cloud + 0.16 * streak,
        Variety::Yellow => 0.10 + 0.25 * cloud,
    };
    let around_stem = smoothstep(0.82, 0.99, c);
    let skin = ground.lerp(&red, (blush - 0.5 * around_stem).clamp(0.0, 1.0));
    let russet = skin.lerp(&Rgb::new(0.30, 0.22, 0.08), smoothstep(0.95, 1.0, c) * 0.6);
    russet.lerp(&Rgb::new(0.05, 0.03, 0.02), smoothstep(-0.975, -0.995, c))
}

/// Streaks along the wood, lighter on thick limbs; fresh green stems.
fn bark_skin(bark: Bark, surface: &Surface, point: &Point3<f64>, thickness: f64) -> Rgb {
    let along = value_noise(77, surface.u * 90.0, thickness * 300.0, 0.0);
    let grain = value_noise(78, point.x * 350.0, point.y * 350.0, point.z * 350.0);
    match bark {
        Bark::Green => Rgb::new(0.30, 0.34, 0.10) * (0.85 + 0.3 * along),
        Bark::Wood => {
            let old = smoothstep(0.006, 0.03, thickness);
            let tone = Rgb::new(0.25, 0.135, 0.075).lerp(&Rgb::new(0.27, 0.225, 0.18), old);
            tone * (0.65 + 0.4 * along + 0.3 * grain)
        }
    }
}

/// Green above, paler below, with a light midrib and side veins.
fn leaf_skin(tint: f64, surface: &Surface, backside: bool) -> Rgb {
    let (u, v) = (surface.u, surface.v);
    let top = Rgb::new(0.055, 0.15, 0.022).lerp(&Rgb::new(0.20, 0.34, 0.05), tint);
    let blade = if backside {
        top.lerp(&Rgb::new(0.30, 0.38, 0.22), 0.5)
    } else {
        top
    };
    let midrib = 1.0 - smoothstep(0.02, 0.07, v.abs());
    // Side veins leave the midrib towards the tip: lines of equal u − 0.3|v|.
    let phase = ((u - 0.3 * v.abs()) * 9.0).rem_euclid(1.0);
    let vein = 1.0 - smoothstep(0.0, 0.12, (phase - 0.5).abs());
    let pale = Rgb::new(0.42, 0.48, 0.20);
    blade.lerp(&pale, 0.45 * midrib + 0.10 * vein * (1.0 - midrib))
}

/// A leaf late in the season: dull above with patches and a paler rim, greyish below.
fn weathered_leaf(leaf: &Leaf, surface: &Surface, backside: bool) -> Rgb {
    let (u, v) = (surface.u, surface.v);
    let key = (leaf.length * 1e8) as u64;
    let patch = value_noise(key, u * 4.0, v * 3.0, 0.0);
    let top = Rgb::new(0.045, 0.085, 0.030).lerp(&Rgb::new(0.20, 0.29, 0.07), leaf.tint);
    let blade = if backside {
        top.lerp(&Rgb::new(0.30, 0.34, 0.25), 0.65)
    } else {
        top
    };
    let midrib = 1.0 - smoothstep(0.02, 0.08, v.abs());
    let phase = ((u - 0.3 * v.abs()) * 8.0).rem_euclid(1.0);
    let vein = 1.0 - smoothstep(0.0, 0.14, (phase - 0.5).abs());
    let rim = smoothstep(0.6, 1.0, v.abs());
    let pale = Rgb::new(0.36, 0.40, 0.18);
    let veined = blade.lerp(
        &pale,
        0.40 * midrib + 0.12 * vein * (1.0 - midrib) + 0.10 * rim,
    );
    let dry = smoothstep(0.86, 0.97, patch) * 0.6;
    veined.lerp(&Rgb::new(0.22, 0.13, 0.05), dry) * (0.8 + 0.4 * patch)
}

/// Bark outdoors: grey-brown, ringed and streaked, with pale patches of lichen on older wood.
fn weathered_bark(surface: &Surface, point: &Point3<f64>, thickness: f64) -> Rgb {
    let ring = value_noise(79, surface.u * 160.0, thickness * 300.0, 0.0);
    let grain = value_noise(80, point.x * 500.0, point.y * 180.0, point.z * 500.0);
    let lichen = smoothstep(
        0.62,
        0.85,
        value_noise(81, point.x * 70.0, point.y * 70.0, 0.0),
    );
    let old = smoothstep(0.005, 0.02, thickness);
    let tone = Rgb::new(0.19, 0.13, 0.10).lerp(&Rgb::new(0.28, 0.235, 0.21), old);
    let tone = tone * (0.65 + 0.35 * ring + 0.35 * grain);
    tone.lerp(&Rgb::new(0.38, 0.37, 0.32), lichen * (0.25 + 0.35 * old))
}

/// From linear light in 4096 steps to sRGB bytes (IEC 61966-2-1).
fn gamma_table() -> Vec<u8> {
    let encode = |x: f64| {
        if x <= 0.003_130_8 {
            12.92 * x
        } else {
            1.055 * x.powf(1.0 / 2.4) - 0.055
        }
    };
    (0..4096)
        .map(|i| (encode(f64::from(i) / 4095.0) * 255.0).round() as u8)
        .collect()
}
