use super::facts::Facts;
use crate::frame_arguments::FrameArguments;
use pomona_cloud::Camera;
use std::path::Path;

/// A camera, as JSON or YAML.
pub(super) fn facts(path: &Path, read: FrameArguments) -> anyhow::Result<Facts> {
    let read = Camera::read_with(path, &read.camera())?;
    let camera = read.value;
    let mut facts = Facts::new(path, "camera");
    facts.warn(read.warnings);
    facts.warn(camera.doubts());
    facts.size(camera.width, camera.height);
    add_camera(&mut facts, &camera);
    Ok(facts)
}

/// Adds what a camera file holds apart from the image size.
pub(super) fn add_camera(facts: &mut Facts, camera: &Camera) {
    let Camera { fx, fy, cx, cy, .. } = *camera;
    facts.add("focal_px", vec![fx, fy], format!("{fx} x {fy} px"));
    facts.add(
        "principal_point_px",
        vec![cx, cy],
        format!("({cx}, {cy}) px"),
    );
    facts.add(
        "depth_scale",
        camera.depth_scale,
        format!("{} mm per unit", camera.depth_scale * 1000.0),
    );
    facts.say("frame_id", camera.frame_id.clone());
    match &camera.distortion {
        None => facts.add("distortion", serde_json::Value::Null, "none"),
        Some(d) => facts.add(
            "distortion",
            d.model.clone(),
            format!("{} {:?}", d.model, d.coefficients),
        ),
    }
}
