use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Whether the system's loader can load a file without harm; what is wrong with it if not.
///
/// The loader itself tells of most faults, but a library that was cut short, as a broken download is, it
/// maps beyond the file's end: the program dies at the first touch. So the file's own table of contents is
/// checked first.
///
/// Source: System V Application Binary Interface, "Object Files" and "Program Header".
pub(super) fn check(path: &Path) -> Result<(), String> {
    let mut file = File::open(path).map_err(|error| format!("cannot be read: {error}"))?;
    let about = file
        .metadata()
        .map_err(|error| format!("cannot be read: {error}"))?;
    if !about.is_file() {
        return Err("is a folder, not a shared library".to_owned());
    }
    let mut head = Vec::new();
    let read = file.by_ref().take(64).read_to_end(&mut head);
    read.map_err(|error| format!("cannot be read: {error}"))?;
    if cfg!(windows) {
        return begins(&head, &[b"MZ"]);
    }
    if cfg!(target_vendor = "apple") {
        let magic: [&[u8]; 3] = [
            b"\xcf\xfa\xed\xfe",
            b"\xca\xfe\xba\xbe",
            b"\xca\xfe\xba\xbf",
        ];
        return begins(&head, &magic);
    }
    begins(&head, &[b"\x7fELF"])?;
    let wide = head.get(4) == Some(&2);
    if wide != cfg!(target_pointer_width = "64") {
        let bits = if wide { 64 } else { 32 };
        return Err(format!(
            "is made for {bits}-bit programs, which this one is not"
        ));
    }
    if head.get(5) != Some(&if cfg!(target_endian = "little") { 1 } else { 2 }) {
        return Err("is made for processors of the other byte order".to_owned());
    }
    if let (Some(made_for), Some(needed)) = (number::<2>(&head, 18), machine())
        && made_for != needed
    {
        let names = |code| {
            MACHINES
                .iter()
                .find(|(_, other)| *other == code)
                .map(|(name, _)| *name)
        };
        return Err(format!(
            "is made for {} processors, this one is {}",
            names(made_for).unwrap_or("other"),
            std::env::consts::ARCH
        ));
    }
    // Narrow files have another table; they are left to the loader.
    if !wide || cfg!(target_endian = "big") {
        return Ok(());
    }
    segments(&mut file, &head, about.len())
}

/// Processors by the names that Rust uses.
const MACHINES: [(&str, u64); 7] = [
    ("x86", 3),
    ("arm", 40),
    ("s390x", 22),
    ("x86_64", 62),
    ("aarch64", 183),
    ("riscv64", 243),
    ("loongarch64", 258),
];

fn machine() -> Option<u64> {
    let named = |entry: &&(&str, u64)| entry.0 == std::env::consts::ARCH;
    MACHINES.iter().find(named).map(|&(_, code)| code)
}

fn begins(head: &[u8], magic: &[&[u8]]) -> Result<(), String> {
    if magic.iter().any(|magic| head.starts_with(magic)) {
        Ok(())
    } else {
        Err("is no shared library".to_owned())
    }
}

/// Checks that every part that the loader maps lies within the file.
fn segments(file: &mut File, head: &[u8], length: u64) -> Result<(), String> {
    let short = || "is truncated".to_owned();
    let table = number::<8>(head, 32).ok_or_else(short)?;
    let entry = number::<2>(head, 54).ok_or_else(short)?;
    let count = number::<2>(head, 56).ok_or_else(short)?;
    let mut bytes = vec![0; (entry * count) as usize];
    file.seek(SeekFrom::Start(table))
        .and_then(|_| file.read_exact(&mut bytes))
        .map_err(|_| short())?;
    for segment in bytes.chunks_exact((entry as usize).max(1)) {
        let loaded = number::<4>(segment, 0) == Some(1);
        let start = number::<8>(segment, 8).ok_or_else(short)?;
        let size = number::<8>(segment, 32).ok_or_else(short)?;
        let end = start.checked_add(size).ok_or_else(short)?;
        if loaded && end > length {
            return Err(format!("is truncated: {length} bytes of at least {end}"));
        }
    }
    Ok(())
}

/// The little-endian number of `N` bytes at this place.
fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<u64> {
    let bytes = bytes.get(at..at + N)?;
    Some(
        bytes
            .iter()
            .rev()
            .fold(0, |number, &byte| number << 8 | u64::from(byte)),
    )
}

#[cfg(test)]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod tests {
    use super::*;

    fn outcome(bytes: &[u8]) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("library.so");
        std::fs::write(&path, bytes).unwrap();
        check(&path).err().unwrap_or_default()
    }

    /// A library with one part of 4 KiB that is mapped.
    fn library() -> Vec<u8> {
        let mut bytes = vec![0; 4096];
        bytes[..6].copy_from_slice(b"\x7fELF\x02\x01");
        bytes[18] = 62;
        bytes[32] = 64;
        bytes[54] = 56;
        bytes[56] = 1;
        bytes[64] = 1;
        bytes[64 + 33] = 0x10;
        bytes
    }

    #[test]
    fn a_whole_library_passes_and_one_cut_short_does_not() {
        assert_eq!(outcome(&library()), "");
        assert_eq!(
            outcome(&library()[..4095]),
            "is truncated: 4095 bytes of at least 4096"
        );
        assert_eq!(outcome(&library()[..100]), "is truncated");
        assert_eq!(outcome(&library()[..20]), "is truncated");
    }

    #[test]
    fn foreign_files_are_told_apart() {
        assert_eq!(outcome(b""), "is no shared library");
        assert_eq!(outcome(b"/* GNU ld script"), "is no shared library");
        let mut other = library();
        other[18] = 183;
        assert_eq!(
            outcome(&other),
            "is made for aarch64 processors, this one is x86_64"
        );
        other[4] = 1;
        assert_eq!(
            outcome(&other),
            "is made for 32-bit programs, which this one is not"
        );
        assert!(check(Path::new("/")).unwrap_err().contains("folder"));
    }
}
