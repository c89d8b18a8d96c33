use super::facts::{Facts, range};
use pomona_cloud::PointCloud;
use std::path::Path;

/// Whether a file that begins so is a PCD or a PLY.
pub(super) fn is_cloud(start: &[u8]) -> bool {
    let is_ply = start
        .first_chunk::<3>()
        .is_some_and(|word| word.eq_ignore_ascii_case(b"ply"));
    let is_pcd = [&b"# .PCD"[..], b"VERSION"]
        .iter()
        .any(|magic| start.starts_with(magic));
    is_ply || is_pcd
}

pub(super) fn facts(path: &Path) -> anyhow::Result<Facts> {
    let cloud = PointCloud::read(path)?;
    let mut facts = Facts::new(path, "point cloud");
    facts.say("points", cloud.len());
    match cloud.size {
        Some((width, height)) => {
            facts.add(
                "organised",
                vec![width, height],
                format!("{width} x {height}"),
            );
        }
        None => facts.add("organised", serde_json::Value::Null, "no"),
    }
    facts.add(
        "colours",
        cloud.colors.is_some(),
        if cloud.colors.is_some() { "yes" } else { "no" },
    );
    let missing = cloud.len() - cloud.finite_points().count();
    let meaning = match (missing, cloud.size) {
        (0, _) => "",
        (_, Some(_)) => " (pixels without a reading)",
        (_, None) => " (`pomona convert --drop-nan` leaves them out)",
    };
    facts.add("not_finite", missing, format!("{missing}{meaning}"));
    for (name, axis) in [("x", 0), ("y", 1), ("z", 2)] {
        if let Some((low, high)) = range(cloud.finite_points().map(|p| p[axis])) {
            let text = format!("{:.1} to {:.1} mm", low * 1000.0, high * 1000.0);
            facts.add(name, vec![low, high], text);
        }
    }
    Ok(facts)
}
