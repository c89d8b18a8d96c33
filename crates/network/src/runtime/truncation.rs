use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Where a 64-bit ELF header says where the table of sections is, how long an entry is, and how many there are.
const SECTIONS_OFFSET: usize = 40;
const ENTRY_SIZE: usize = 58;
const ENTRY_COUNT: usize = 60;

/// Whether a shared library is an ELF file (64-bit, little-endian) that ends before its table of sections, which
/// linkers write last.
///
/// The system's loader reports other faults, but a truncated library, as a broken download is, it maps beyond the
/// end of the file: the process is killed at the first access there.
///
/// Source: System V Application Binary Interface, "ELF Header".
pub(super) fn is_truncated(library: &Path) -> io::Result<bool> {
    let mut file = File::open(library)?;
    let mut header = [0; 64];
    let read = file.read(&mut header)?;
    if !header.starts_with(b"\x7fELF\x02\x01") {
        return Ok(false);
    }
    let number = |at: usize, bytes: usize| {
        let digits = header[at..at + bytes].iter().rev();
        digits.fold(0_u64, |number, &byte| number << 8 | u64::from(byte))
    };
    let table = number(ENTRY_SIZE, 2) * number(ENTRY_COUNT, 2);
    let end = number(SECTIONS_OFFSET, 8).saturating_add(table);
    Ok(read < header.len() || end > file.metadata()?.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truncated(bytes: &[u8]) -> bool {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("library.so");
        std::fs::write(&path, bytes).unwrap();
        is_truncated(&path).unwrap()
    }

    /// A library whose last bytes are a table of two sections.
    fn library() -> Vec<u8> {
        let mut bytes = vec![0; 4096];
        bytes[..6].copy_from_slice(b"\x7fELF\x02\x01");
        bytes[SECTIONS_OFFSET..SECTIONS_OFFSET + 2].copy_from_slice(&3968_u16.to_le_bytes());
        bytes[ENTRY_SIZE] = 64;
        bytes[ENTRY_COUNT] = 2;
        bytes
    }

    #[test]
    fn a_whole_library_passes_and_one_cut_short_does_not() {
        assert!(!truncated(&library()));
        for length in [4095, 100, 64, 20] {
            assert!(truncated(&library()[..length]), "{length}");
        }
        let mut absurd = library();
        absurd[SECTIONS_OFFSET..SECTIONS_OFFSET + 8].fill(0xff);
        assert!(truncated(&absurd));
    }

    #[test]
    fn other_files_are_left_to_the_loader() {
        assert!(!truncated(b""));
        assert!(!truncated(b"/* GNU ld script"));
        let mut narrow = library();
        narrow[4] = 1;
        assert!(!truncated(&narrow[..100]));
    }
}
