mod channels;
mod claim;
mod pcd;
mod ply;
mod xyz;

use crate::{CloudError, PointCloud};
use pomona_files::{Malformed, write_atomically};
use std::path::Path;

/// A file format of point clouds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CloudFormat {
    /// PCD, one line of text for each point.
    PcdAscii,
    /// PCD, packed records.
    PcdBinary,
    /// PCD, packed columns compressed with LZF.
    PcdBinaryCompressed,
    /// PLY, one line of text for each point.
    PlyAscii,
    /// PLY, packed little-endian records.
    PlyBinaryLittleEndian,
    /// PLY, packed big-endian records.
    PlyBinaryBigEndian,
    /// One `x y z [r g b]` line for each point.
    Xyz,
}

impl CloudFormat {
    /// Every format.
    pub const ALL: [Self; 7] = [
        Self::PcdAscii,
        Self::PcdBinary,
        Self::PcdBinaryCompressed,
        Self::PlyAscii,
        Self::PlyBinaryLittleEndian,
        Self::PlyBinaryBigEndian,
        Self::Xyz,
    ];

    /// The format to write where only a file's name is given: binary for `.pcd` and
    /// `.ply`, text for `.xyz`, `.txt`, `.asc` and `.csv`; `None` for other extensions.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let extension = path.as_ref().extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "pcd" => Some(Self::PcdBinary),
            "ply" => Some(Self::PlyBinaryLittleEndian),
            "xyz" | "txt" | "asc" | "csv" => Some(Self::Xyz),
            _ => None,
        }
    }
}

impl PointCloud {
    /// Reads a PCD, PLY or XYZ file, recognised by its content, or else by its extension.
    ///
    /// Coordinates become f32. A file's own number of points is compared with the file's
    /// size before memory is taken for them. NaN points are kept. PCD's `rgb` and `rgba`
    /// fields and PLY's `red`, `green`, `blue` become colours; fields that a
    /// [`PointCloud`] does not have, and PLY elements other than `vertex`, are left out.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for an unknown or damaged file.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let cloud = parse(&bytes, CloudFormat::from_path(path)).map_err(|fault| fault.at(path))?;
        Ok(cloud)
    }

    /// Writes the cloud in the given format. An organised cloud reads back organised.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also where the arrays do not have one length.
    pub fn write(&self, path: impl AsRef<Path>, format: CloudFormat) -> Result<(), CloudError> {
        let path = path.as_ref();
        let bytes = format_as(self, format).map_err(|fault| fault.at(path))?;
        write_atomically(path, &bytes)?;
        Ok(())
    }
}

fn parse(bytes: &[u8], by_extension: Option<CloudFormat>) -> Result<PointCloud, Malformed> {
    let starts_with_line = |word: &[u8]| {
        bytes
            .split_at_checked(word.len())
            .is_some_and(|(start, rest)| {
                start.eq_ignore_ascii_case(word)
                    && rest.first().is_some_and(u8::is_ascii_whitespace)
            })
    };
    if bytes.is_empty() {
        return Err(Malformed::new(
            "byte 0",
            "an empty file",
            "write the cloud again",
        ));
    }
    if starts_with_line(b"ply") {
        return ply::parse(bytes);
    }
    if bytes.starts_with(b"# .PCD") || starts_with_line(b"VERSION") {
        return pcd::parse(bytes);
    }
    match by_extension {
        Some(CloudFormat::Xyz) => xyz::parse(bytes),
        Some(CloudFormat::PcdAscii | CloudFormat::PcdBinary | CloudFormat::PcdBinaryCompressed) => {
            pcd::parse(bytes)
        }
        Some(_) => Err(Malformed::new(
            "line 1",
            "not `ply`",
            "give a PLY file, or name it after its format",
        )),
        None => Err(Malformed::new(
            "byte 0",
            "neither a PCD nor a PLY file",
            "give PCD or PLY, or `x y z` lines in a file named .xyz, .txt, .asc or .csv",
        )),
    }
}

fn format_as(cloud: &PointCloud, format: CloudFormat) -> Result<Vec<u8>, Malformed> {
    if let Some(problem) = cloud.inconsistency() {
        return Err(Malformed::new(
            "cloud to write",
            problem,
            "give arrays of one length",
        ));
    }
    match format {
        CloudFormat::PcdAscii => pcd::format(cloud, pcd_rs::DataKind::Ascii),
        CloudFormat::PcdBinary => pcd::format(cloud, pcd_rs::DataKind::Binary),
        CloudFormat::PcdBinaryCompressed => pcd::format(cloud, pcd_rs::DataKind::BinaryCompressed),
        CloudFormat::PlyAscii => ply::format(cloud, ply_rs_bw::ply::Encoding::Ascii),
        CloudFormat::PlyBinaryLittleEndian => {
            ply::format(cloud, ply_rs_bw::ply::Encoding::BinaryLittleEndian)
        }
        CloudFormat::PlyBinaryBigEndian => {
            ply::format(cloud, ply_rs_bw::ply::Encoding::BinaryBigEndian)
        }
        CloudFormat::Xyz => Ok(xyz::format(cloud)),
    }
}

#[cfg(test)]
mod robustness;
#[cfg(test)]
mod round_trip;
