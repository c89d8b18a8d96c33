use nalgebra::Point3;
use pomona::{Evidence, Outcome, Pick, Status};
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_geometry::Sphere;
use pomona_view::{AppleMark, Overlay, ViewError};

/// The frame's colour image with its answers drawn over it.
pub(crate) fn draw(frame: &Frame, outcome: &Outcome) -> Result<ColorImage, ViewError> {
    let picks = outcome.record.picks.iter();
    let marks: Vec<AppleMark> = picks
        .zip(&outcome.evidence)
        .map(|(p, e)| mark(p, e))
        .collect();
    Overlay::new(&frame.color, &frame.camera).draw(&marks)
}

fn mark<'a>(pick: &Pick, evidence: &'a Evidence) -> AppleMark<'a> {
    let b = &pick.pixel_box;
    let bounds = PixelBox {
        name: b.name.clone(),
        x_min: b.x_min,
        y_min: b.y_min,
        x_max: b.x_max,
        y_max: b.y_max,
        score: b.score,
    };
    let mut mark = AppleMark::new(pick.id, bounds);
    mark.surface_pixels = &evidence.surface;
    mark.branch_pixels = &evidence.branch;
    if let Some(apple) = &pick.apple {
        let center = Point3::from(apple.center);
        mark.sphere = Sphere::new(center, apple.radius);
        mark.arrow = pick.foot.map(|foot| (center, Point3::from(foot)));
        mark.caption = Some(format!("r {:.0} mm", apple.radius * 1000.0));
    }
    if pick.status != Status::Picked {
        mark.refused = Some(pick.status.name().replace('_', " "));
    }
    mark
}
