//! Folders of the TUM RGB-D benchmark: `rgb.txt` and `depth.txt` list images by time.

use crate::folder::folder_name;
use crate::frame::Frame;
use crate::{Camera, CloudError, ColorImage, DepthImage};
use pomona_files::Malformed;
use std::path::{Path, PathBuf};

/// Seconds by which a colour and a depth image of one frame may differ: the benchmark's own tools'.
const MAX_DIFFERENCE_S: f64 = 0.02;
/// Metres in a unit of the benchmark's depth images.
const DEPTH_SCALE: f64 = 1.0 / 5000.0;

/// One frame of a TUM RGB-D folder: a colour image and the depth image nearest in time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TumEntry {
    /// Time of the colour image, in seconds.
    pub time_s: f64,
    /// File of the colour image.
    pub color: PathBuf,
    /// File of the depth image.
    pub depth: PathBuf,
}

/// Lists the frames of a TUM RGB-D folder, in order of time; colour images without a depth
/// image within 0.02 s are left out.
///
/// # Errors
///
/// [`CloudError::File`] where `rgb.txt` or `depth.txt` is missing, and for a line in them that is not a time and a
/// file.
pub fn read_tum(dir: impl AsRef<Path>) -> Result<Vec<TumEntry>, CloudError> {
    let dir = dir.as_ref();
    let depths = list(&dir.join("depth.txt"))?;
    let colors = list(&dir.join("rgb.txt"))?;
    let entries = colors.into_iter().filter_map(|(time_s, color)| {
        let after = depths.partition_point(|(time, _)| *time < time_s);
        let nearby = depths.get(after.saturating_sub(1)..depths.len().min(after + 1))?;
        let apart = |entry: &&(f64, String)| (entry.0 - time_s).abs();
        let (time, depth) = nearby.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        ((time - time_s).abs() <= MAX_DIFFERENCE_S).then(|| TumEntry {
            time_s,
            color: dir.join(color),
            depth: dir.join(depth),
        })
    });
    Ok(entries.collect())
}

impl TumEntry {
    /// Reads the frame. Its id is the folder's name and the colour image's.
    ///
    /// The benchmark's folders hold no camera; its calibration page gives one for each device.
    /// Its depth scale is replaced by the benchmark's, 1/5000 m.
    ///
    /// # Errors
    ///
    /// As [`Frame::read`].
    pub fn read(&self, camera: &Camera) -> Result<Frame, CloudError> {
        let folder = self
            .color
            .ancestors()
            .nth(2)
            .map(folder_name)
            .unwrap_or_default();
        let name = self.color.file_stem().unwrap_or_default().to_string_lossy();
        let frame = Frame {
            id: format!("{folder}-{name}"),
            camera: Camera {
                depth_scale: DEPTH_SCALE,
                ..camera.clone()
            },
            color: ColorImage::read(&self.color)?,
            depth: DepthImage::read(&self.depth)?,
            boxes: None,
            warnings: Vec::new(),
        };
        frame.validate_as(&self.color)?;
        Ok(frame)
    }
}

/// Times and file names of a list, in order of time.
fn list(path: &Path) -> Result<Vec<(f64, String)>, CloudError> {
    let bytes = pomona_files::read(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut entries = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut tokens = line.split_whitespace();
        let time = tokens
            .next()
            .and_then(|t| t.parse::<f64>().ok())
            .filter(|t| t.is_finite());
        let (Some(time), Some(name)) = (time, tokens.next()) else {
            let problem = format!("`{line}` is not a time and a file");
            let remedy = "give `seconds file` on each line";
            return Err(Malformed::new(format!("line {number}"), problem, remedy)
                .at(path)
                .into());
        };
        entries.push((time, name.to_owned()));
    }
    entries.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_files::FileError;
    use std::fs;

    #[test]
    fn images_are_paired_by_time() {
        let parent = tempfile::tempdir().unwrap();
        let dir = parent.path().join("freiburg1_xyz");
        fs::create_dir_all(dir.join("rgb")).unwrap();
        fs::create_dir_all(dir.join("depth")).unwrap();
        fs::write(
            dir.join("rgb.txt"),
            "# color images\n9.5 rgb/b.png\n1.00 rgb/a.png\n",
        )
        .unwrap();
        fs::write(
            dir.join("depth.txt"),
            "# depth\n0.97 depth/x.png\n1.01 depth/y.png\n1.03 depth/z.png\n",
        )
        .unwrap();
        let entries = read_tum(&dir).unwrap();
        assert_eq!(entries.len(), 1);
        assert!(entries[0].depth.ends_with("depth/y.png") && entries[0].time_s == 1.0);

        ColorImage::filled(4, 3, [1, 2, 3])
            .write(&entries[0].color)
            .unwrap();
        let depth = DepthImage {
            width: 4,
            height: 3,
            readings: vec![5000; 12],
        };
        depth.write(&entries[0].depth).unwrap();
        let camera = Camera {
            width: 4,
            height: 3,
            fx: 4.0,
            fy: 4.0,
            cx: 1.5,
            cy: 1.0,
            depth_scale: 1.0,
            frame_id: "optical".to_owned(),
            distortion: None,
        };
        let frame = entries[0].read(&camera).unwrap();
        assert_eq!(frame.id, "freiburg1_xyz-a");
        let points = frame.window(crate::PixelWindow::full(4, 3)).unwrap();
        assert_eq!((points.len(), points.z[0]), (12, 1.0));
        let wide = Camera { width: 5, ..camera };
        assert!(matches!(
            entries[0].read(&wide),
            Err(CloudError::SizeMismatch { .. })
        ));
    }

    #[test]
    fn bad_lists_are_refused_by_line() {
        let dir = tempfile::tempdir().unwrap();
        assert!(matches!(
            read_tum(dir.path()),
            Err(CloudError::File(FileError::Read { .. }))
        ));
        fs::write(dir.path().join("depth.txt"), "1.0 a.png\n").unwrap();
        fs::write(dir.path().join("rgb.txt"), "1.0 a.png\nsoon b.png\n").unwrap();
        let error = read_tum(dir.path()).unwrap_err().to_string();
        assert!(
            error.contains("rgb.txt") && error.contains("line 2"),
            "{error}"
        );
    }
}
