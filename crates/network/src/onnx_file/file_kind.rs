use pomona_files::Malformed;

const EXPORT: &str = "export the model to ONNX and give that file";
const GIVE_MODEL: &str = "give the model's .onnx file";
const UNPACK: &str = "unpack it and give the .onnx file in it";
const DOWNLOAD: &str = "export or download it again";

/// First bytes of the files that are most often given in place of a model, what they are, and what to do. Letter case
/// and leading blanks do not count.
const PREFIXES: [(&[u8], &str, &str); 6] = [
    (b"\x89PNG\r\n", "a PNG image", GIVE_MODEL),
    (b"\xff\xd8\xff", "a JPEG image", GIVE_MODEL),
    (
        b"\x80\x02",
        "a Python pickle, such as an old PyTorch checkpoint",
        EXPORT,
    ),
    (
        b"version https://git-lfs",
        "a pointer that Git LFS left in place of the file",
        "fetch the file with `git lfs pull`",
    ),
    (b"<!doctype html", SAVED_PAGE, "download the file itself"),
    (b"<html", SAVED_PAGE, "download the file itself"),
];

const SAVED_PAGE: &str = "a web page, perhaps saved in place of a download";

/// How much of a file is examined, bytes.
const HEAD: usize = 512;

/// The fault of a file that is of another kind, by its first bytes; `None` for one that may be an ONNX model.
pub(super) fn foreign_kind(bytes: &[u8]) -> Option<Malformed> {
    let head = bytes[..bytes.len().min(HEAD)].trim_ascii_start();
    let begins = |prefix: &[u8]| {
        let start = head.get(..prefix.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(prefix))
    };
    let known = PREFIXES.iter().find(|(prefix, ..)| begins(prefix));
    let (what, remedy) = if bytes.is_empty() {
        ("empty", DOWNLOAD)
    } else if begins(b"PK\x03\x04") {
        archive(head)
    } else if let Some(&(_, what, remedy)) = known {
        (what, remedy)
    } else if is_text(head) {
        ("a text file, such as TOML", GIVE_MODEL)
    } else {
        return None;
    };
    let problem = format!("is not an ONNX model but {what}");
    Some(Malformed::new("first bytes", problem, remedy))
}

/// A zip archive; checkpoints of `PyTorch` are such.
fn archive(head: &[u8]) -> (&'static str, &'static str) {
    let holds = |name: &[u8]| head.windows(name.len()).any(|part| part == name);
    if holds(b"data.pkl") || holds(b"/version") {
        ("a PyTorch checkpoint", EXPORT)
    } else {
        ("a zip archive", UNPACK)
    }
}

/// Whether the first bytes are printable ASCII: an ONNX model begins with a field of number 1, key 8, a control
/// character.
fn is_text(head: &[u8]) -> bool {
    let printable = |byte: &u8| matches!(byte, b' '..=b'~' | b'\n' | b'\r' | b'\t');
    head.iter().all(printable)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(bytes: &[u8]) -> Option<String> {
        let problem = foreign_kind(bytes)?.problem;
        Some(problem.replace("is not an ONNX model but ", ""))
    }

    #[test]
    fn files_of_other_kinds_are_known() {
        for (bytes, what) in [
            (&b""[..], "empty"),
            (b"\x89PNG\r\n\x1a\n", "a PNG image"),
            (b"PK\x03\x04\x14\0", "a zip archive"),
            (
                b"PK\x03\x04\0\0\0\0\0\0\0best/data.pkl",
                "a PyTorch checkpoint",
            ),
            (
                b"\x80\x02}q\0",
                "a Python pickle, such as an old PyTorch checkpoint",
            ),
            (
                b"[model]\nfamily = \"yolox\"\n",
                "a text file, such as TOML",
            ),
            (b"  <!DOCTYPE HTML>", SAVED_PAGE),
            (
                b"version https://git-lfs.github.com/spec/v1",
                "a pointer that Git LFS left in place of the file",
            ),
        ] {
            assert_eq!(problem(bytes).as_deref(), Some(what));
        }
    }

    #[test]
    fn a_model_may_be_one() {
        assert_eq!(problem(b"\x08\x07\x12\x07pytorch"), None);
        assert_eq!(problem(b"\x08\x0a"), None);
    }
}
