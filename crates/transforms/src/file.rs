use crate::TransformFileError;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// All bytes of a file.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, TransformFileError> {
    fs::read(path).map_err(|source| TransformFileError::Read {
        path: path.to_owned(),
        source,
    })
}

/// Writes a whole file under a temporary name beside `path` and renames it,
/// so that `path` holds either what it held before or all of `bytes`.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), TransformFileError> {
    let temporary = temporary_beside(path);
    let written = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&temporary)
        .and_then(|mut file| file.write_all(bytes))
        .and_then(|()| fs::rename(&temporary, path));
    written.map_err(|source| {
        // The first error is the one to report; a leftover that cannot be
        // removed has the same cause.
        let _ = fs::remove_file(&temporary);
        TransformFileError::Write {
            path: path.to_owned(),
            source,
        }
    })
}

/// A hidden name in the same folder that no other call of any process takes.
fn temporary_beside(path: &Path) -> PathBuf {
    static CALLS: AtomicU64 = AtomicU64::new(0);
    let call = CALLS.fetch_add(1, Ordering::Relaxed);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}-{call}.part", std::process::id()))
}
