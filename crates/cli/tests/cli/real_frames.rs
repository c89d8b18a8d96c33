//! Real frames, where the folder `shared` with them lies beside the project.

use crate::binary::pomona;
use crate::scene::Bench;
use std::path::Path;

#[test]
fn every_box_of_the_orchard_frames_has_an_answer() {
    let frames = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/frames");
    let paths = ["orchard-1218", "orchard-1235"].map(|name| frames.join(name));
    if !paths.iter().all(|path| path.is_dir()) {
        println!("skipped: no orchard frames in {}", frames.display());
        return;
    }
    let bench = Bench::new();
    // The bounds of `paper`; those of `robust`, and the tenth beyond them up to which a fit is answered.
    let methods = [("paper", 0.02..=0.05), ("robust", 0.018..=0.0605)];
    for (path, (method, radii)) in paths
        .iter()
        .flat_map(|path| methods.iter().map(move |m| (path, m)))
    {
        let path = path.to_str().unwrap();
        let run = pomona(&[
            "pick",
            path,
            "--method",
            method,
            "--json",
            "--no-picture",
            "--out",
            &bench.text("out"),
        ])
        .succeeded();
        let record = run.json();
        let picks = record["picks"].as_array().unwrap();
        let boxes = std::fs::read_to_string(format!("{path}/boxes.xml")).unwrap();
        assert_eq!(picks.len(), boxes.matches("<object>").count());
        let picked = picks.iter().filter(|p| p["status"] == "picked");
        for pick in picked.clone() {
            let radius = pick["apple"]["radius"].as_f64().unwrap();
            assert!(radii.contains(&radius), "{method}: {pick}");
        }
        assert!(picked.count() >= 5, "{}", run.out);
    }
}
