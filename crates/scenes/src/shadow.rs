use crate::apple::frame_across;
use crate::ray::Ray;
use crate::world::{Part, World};
use nalgebra::{Point3, Vector3};

/// Finds whether anything shades a point from the sun.
///
/// Shadow rays are parallel, so a grid across their direction says which
/// parts a ray can meet.
pub(crate) struct ShadowGrid<'a> {
    parts: &'a [Part],
    toward_sun: Vector3<f64>,
    across: (Vector3<f64>, Vector3<f64>),
    origin: (f64, f64),
    columns: usize,
    cells: Vec<Vec<u32>>,
}

/// Side of a cell, metres: about the size of what casts shadows here.
const CELL_M: f64 = 0.02;

/// How far off its surface a shadow ray starts, metres: no part darkens itself by rounding.
const OFFSET_M: f64 = 1.5e-3;

impl<'a> ShadowGrid<'a> {
    /// `None` where the world casts no shadows.
    pub(crate) fn new(world: &'a World) -> Option<Self> {
        if !world.light.shadows {
            return None;
        }
        let toward_sun = world.light.toward_sun;
        let across = frame_across(&toward_sun);
        let flat = |p: &Point3<f64>| (p.coords.dot(&across.0), p.coords.dot(&across.1));
        let spans: Vec<(u32, [f64; 4])> = (0u32..)
            .zip(&world.parts)
            .filter_map(|(i, part)| Some((i, part.hull()?)))
            .map(|(i, hull)| {
                let start = [
                    f64::INFINITY,
                    f64::INFINITY,
                    f64::NEG_INFINITY,
                    f64::NEG_INFINITY,
                ];
                let span = hull.iter().map(flat).fold(start, |s, (x, y)| {
                    [s[0].min(x), s[1].min(y), s[2].max(x), s[3].max(y)]
                });
                (i, span)
            })
            .collect();
        let origin = spans
            .iter()
            .fold((f64::INFINITY, f64::INFINITY), |o, (_, s)| {
                (o.0.min(s[0]), o.1.min(s[1]))
            });
        let cell = |x: f64, from: f64| ((x - from) / CELL_M) as usize;
        let columns = spans.iter().map(|(_, s)| cell(s[2], origin.0) + 1).max()?;
        let rows = spans.iter().map(|(_, s)| cell(s[3], origin.1) + 1).max()?;
        let mut cells = vec![Vec::new(); columns * rows];
        for (i, span) in &spans {
            for row in cell(span[1], origin.1)..=cell(span[3], origin.1) {
                for column in cell(span[0], origin.0)..=cell(span[2], origin.0) {
                    cells[row * columns + column].push(*i);
                }
            }
        }
        let parts = &world.parts;
        Some(Self {
            parts,
            toward_sun: toward_sun.into_inner(),
            across,
            origin,
            columns,
            cells,
        })
    }

    /// Whether something shades `point` from the sun.
    pub(crate) fn is_shadowed(&self, point: &Point3<f64>, normal: &Vector3<f64>) -> bool {
        let origin = point + normal * OFFSET_M;
        let x = (origin.coords.dot(&self.across.0) - self.origin.0) / CELL_M;
        let y = (origin.coords.dot(&self.across.1) - self.origin.1) / CELL_M;
        if x < 0.0 || y < 0.0 || x as usize >= self.columns {
            return false;
        }
        let Some(cell) = self.cells.get(y as usize * self.columns + x as usize) else {
            return false;
        };
        let ray = Ray {
            origin,
            direction: self.toward_sun,
        };
        cell.iter()
            .any(|&i| self.parts[i as usize].hit(&ray).is_some())
    }
}
