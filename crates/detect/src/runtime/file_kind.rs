/// A file that is no ONNX model, by its first bytes: what it is, and what to do with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FileKind {
    pub(super) what: &'static str,
    pub(super) remedy: &'static str,
}

const EXPORT: &str = "export the model to ONNX and give that file";
const GIVE_MODEL: &str = "give the model's .onnx file";
const UNPACK: &str = "unpack it and give the .onnx file in it";

/// What begins with these bytes at this place.
const MAGIC: [(usize, &[u8], FileKind); 16] = [
    (0, b"\x89PNG\r\n", kind("a PNG image", GIVE_MODEL)),
    (0, b"\xff\xd8\xff", kind("a JPEG image", GIVE_MODEL)),
    (0, b"GIF8", kind("a GIF image", GIVE_MODEL)),
    (0, b"%PDF", kind("a PDF document", GIVE_MODEL)),
    (
        0,
        b"\x7fELF",
        kind(
            "a program or shared library",
            "give the model's .onnx file here and a library with --runtime",
        ),
    ),
    (0, b"MZ", kind("a Windows program or library", GIVE_MODEL)),
    (0, b"\x1f\x8b", kind("a gzip archive", UNPACK)),
    (0, b"BZh", kind("a bzip2 archive", UNPACK)),
    (0, b"\xfd7zXZ", kind("an xz archive", UNPACK)),
    (
        0,
        b"\x89HDF",
        kind("an HDF5 file, such as Keras weights", EXPORT),
    ),
    (0, b"RTEN", kind("a model in rten's own format", EXPORT)),
    (4, b"TFL3", kind("a TensorFlow Lite model", EXPORT)),
    (
        4,
        b"ORTM",
        kind(
            "a model in ONNX Runtime's own format",
            "give the .onnx file that it was made from",
        ),
    ),
    (
        0,
        b"\x80\x02",
        kind("a Python pickle, such as an old PyTorch checkpoint", EXPORT),
    ),
    (0, b"\0\0\0\0\x02\0\0\0", kind("Darknet weights", EXPORT)),
    (257, b"ustar", kind("a tar archive", UNPACK)),
];

/// What begins with these words, blanks and letter case aside.
const WORDS: [(&str, FileKind); 7] = [
    (
        "version https://git-lfs",
        kind(
            "a pointer that Git LFS left in place of the file",
            "fetch the file with `git lfs pull`",
        ),
    ),
    (
        "<!doctype html",
        kind(
            "a web page, perhaps saved in place of a download",
            "download the file itself",
        ),
    ),
    (
        "<html",
        kind(
            "a web page, perhaps saved in place of a download",
            "download the file itself",
        ),
    ),
    (
        "<?xml",
        kind("an XML file, such as an OpenVINO model", EXPORT),
    ),
    ("{", kind("a JSON file", GIVE_MODEL)),
    ("[net]", kind("a Darknet configuration", EXPORT)),
    ("#!", kind("a script", GIVE_MODEL)),
];

const fn kind(what: &'static str, remedy: &'static str) -> FileKind {
    FileKind { what, remedy }
}

impl FileKind {
    /// What a file is that begins with `bytes`; `None` for one that may be an ONNX model.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        if bytes.is_empty() {
            return Some(kind("empty", "export or download it again"));
        }
        if bytes.starts_with(b"PK\x03\x04") {
            return Some(archive(bytes));
        }
        let begins = |&(at, magic, kind): &(usize, &[u8], FileKind)| {
            bytes.get(at..)?.starts_with(magic).then_some(kind)
        };
        MAGIC.iter().find_map(begins).or_else(|| text(bytes))
    }
}

/// A zip archive; checkpoints of `PyTorch` are such.
fn archive(bytes: &[u8]) -> FileKind {
    let head = &bytes[..bytes.len().min(256)];
    let holds = |name: &[u8]| head.windows(name.len()).any(|part| part == name);
    if holds(b"data.pkl") || holds(b"/version") || holds(b".format_version") || holds(b"/.data/") {
        kind("a PyTorch checkpoint", EXPORT)
    } else {
        kind("a zip archive", UNPACK)
    }
}

/// A file whose first bytes are all text.
fn text(bytes: &[u8]) -> Option<FileKind> {
    let head = &bytes[..bytes.len().min(512)];
    let head = match std::str::from_utf8(head) {
        Ok(head) => head,
        // A letter may be cut in two at the end.
        Err(error) if error.error_len().is_none() => {
            std::str::from_utf8(&head[..error.valid_up_to()]).ok()?
        }
        Err(_) => return None,
    };
    let is_text = |letter: char| !letter.is_control() || matches!(letter, '\n' | '\r' | '\t');
    if head.is_empty() || !head.chars().all(is_text) {
        return None;
    }
    let start = head.trim_start().to_ascii_lowercase();
    let known = WORDS.iter().find(|(word, _)| start.starts_with(word));
    Some(match known {
        Some(&(_, kind)) => kind,
        None if head.lines().any(|line| line.contains(" = ")) => {
            kind("a text file, such as TOML", GIVE_MODEL)
        }
        None => kind("a text file", GIVE_MODEL),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn what(bytes: &[u8]) -> Option<&'static str> {
        FileKind::of(bytes).map(|kind| kind.what)
    }

    #[test]
    fn files_of_other_kinds_are_known() {
        assert_eq!(what(b""), Some("empty"));
        assert_eq!(what(b"\x89PNG\r\n\x1a\n"), Some("a PNG image"));
        assert_eq!(what(b"PK\x03\x04\x14\0"), Some("a zip archive"));
        assert_eq!(
            what(b"PK\x03\x04\0\0\0\0\0\0\0best/data.pkl"),
            Some("a PyTorch checkpoint")
        );
        assert_eq!(
            what(b"\x80\x02}q\0"),
            Some("a Python pickle, such as an old PyTorch checkpoint")
        );
        assert_eq!(
            what(b"[model]\nfamily = \"yolox\"\n"),
            Some("a text file, such as TOML")
        );
        assert_eq!(
            what(b"  <!DOCTYPE HTML>"),
            Some("a web page, perhaps saved in place of a download")
        );
        assert_eq!(
            what(b"version https://git-lfs.github.com/spec/v1"),
            Some("a pointer that Git LFS left in place of the file")
        );
    }

    #[test]
    fn a_model_may_be_one() {
        assert_eq!(what(b"\x08\x07\x12\x07pytorch"), None);
        assert_eq!(what(b"\x08\x0a"), None);
    }
}
