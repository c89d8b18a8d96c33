use pomona_cloud::{Frame, PixelBox};
use pomona_scenes::{CameraAxis, Lab, Orientation, Scene, Sensor, Shot};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// One lab apple under its branch in a small frame.
pub(crate) fn scene(id: &str) -> Scene {
    let camera = Shot::paper_camera().with_intrinsics([320, 240], [540.0; 2], [159.5, 119.5]);
    let upright = Orientation {
        axis: CameraAxis::X,
        degrees: 0,
    };
    Shot::new(id, camera, Sensor::paper(), 1).take(&Lab::default().world(upright))
}

pub(crate) fn pixel_box(name: &str, [x_min, y_min, x_max, y_max]: [f64; 4]) -> PixelBox {
    PixelBox {
        name: name.to_owned(),
        x_min,
        y_min,
        x_max,
        y_max,
        score: 1.0,
    }
}

/// The small frame with two boxes more: one without depth in it, and one of two pixels.
pub(crate) fn frame(id: &str) -> Frame {
    let mut frame = scene(id).frame;
    for v in 0..40 {
        frame.depth.readings[v * 320..v * 320 + 40].fill(0);
    }
    let more = [
        pixel_box("blind", [2.0, 3.0, 30.0, 33.0]),
        pixel_box("tiny", [300.0, 200.0, 302.0, 201.0]),
    ];
    frame.boxes.get_or_insert_default().extend(more);
    frame
}

/// A folder of its own for a test, with a frame `a` in it.
pub(crate) struct Bench {
    dir: TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        frame("a").write(dir.path().join("a")).unwrap();
        Self { dir }
    }

    pub(crate) fn root(&self) -> &Path {
        self.dir.path()
    }

    /// A path in the test's folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    /// The same as text, for arguments.
    pub(crate) fn text(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub(crate) fn read_json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(name)).unwrap()
    }
}
