//! Which library of ONNX Runtime is used, and what happens where it cannot be: a process loads one library
//! once, so each case has a process of its own.

use crate::onnx;
use crate::support::{has_onnx_runtime, noise, open_bytes};
use pomona_network::{ModelSource, RuntimeChoice, open_network};
use std::path::{Path, PathBuf};
use std::process::Command;

/// One process that opens networks, one after the other, and prints what runs them.
///
/// A case is `automatic`, `onnxruntime`, `embedded` or a library's path.
#[test]
#[ignore = "the other tests start it"]
fn open_in_turn() {
    let model: &'static [u8] = onnx::small().to_bytes().leak();
    let source = ModelSource::BuiltIn {
        name: "small",
        bytes: model,
    };
    for case in std::env::var("CASES").unwrap().split('|') {
        let choice = match case {
            "automatic" => RuntimeChoice::Automatic,
            "onnxruntime" => RuntimeChoice::OnnxRuntime,
            "embedded" => RuntimeChoice::Embedded,
            path => RuntimeChoice::Library(path.into()),
        };
        match open_network(&source, &choice, 1) {
            Ok(network) => {
                let report = network.report();
                let outputs = network.run(&noise(network.as_ref(), 0, 1.0)).unwrap();
                assert_eq!(outputs[0].shape, [1, 6, 8, 8]);
                let reason = report.fallback_reason.unwrap_or_default();
                println!(
                    "\n=> {} {} {reason}",
                    report.name,
                    report.library.unwrap_or_default()
                );
            }
            Err(error) => println!("\n=> error {error}"),
        }
    }
}

/// What such a process prints for each case, in an environment with these variables and no others of use.
fn outcomes(cases: &[&str], variables: &[(&str, &Path)]) -> Vec<String> {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args([
        "--exact",
        "library::open_in_turn",
        "--ignored",
        "--nocapture",
    ]);
    command.env("CASES", cases.join("|"));
    for name in [
        "ORT_DYLIB_PATH",
        "LD_LIBRARY_PATH",
        "VIRTUAL_ENV",
        "CONDA_PREFIX",
        "HOME",
        "PYENV_ROOT",
        "PATH",
    ] {
        command.env_remove(name);
    }
    command.envs(variables.iter().copied());
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success(),
        "{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let lines: Vec<String> = text
        .lines()
        .filter_map(|line| line.strip_prefix("=> "))
        .map(Into::into)
        .collect();
    assert_eq!(lines.len(), cases.len(), "{text}");
    lines
}

fn outcome(case: &str, variables: &[(&str, &Path)]) -> String {
    outcomes(&[case], variables).remove(0)
}

/// The library that this machine has, if any; prints that there is none.
fn library() -> Option<PathBuf> {
    if !has_onnx_runtime() {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let network = open_bytes(
        folder.path(),
        &onnx::small().to_bytes(),
        &RuntimeChoice::OnnxRuntime,
    )
    .unwrap();
    network.report().library.map(PathBuf::from)
}

/// The C library: a shared library, but not of ONNX Runtime.
fn other_library() -> Option<PathBuf> {
    let places = [
        "/lib/x86_64-linux-gnu/libc.so.6",
        "/lib64/libc.so.6",
        "/usr/lib/libc.so.6",
        "/lib/aarch64-linux-gnu/libc.so.6",
    ];
    let found = places.iter().map(PathBuf::from).find(|path| path.exists());
    if found.is_none() {
        println!("skipped: no C library in {places:?}");
    }
    found
}

#[test]
fn a_library_that_is_named_and_missing() {
    let missing = Path::new("/no/such/libonnxruntime.so");
    for case in ["/no/such/libonnxruntime.so", "onnxruntime"] {
        let said = outcome(case, &[("ORT_DYLIB_PATH", missing)]);
        assert!(
            said.starts_with(
                "error ONNX Runtime library /no/such/libonnxruntime.so: cannot be read"
            ),
            "{said}"
        );
        assert!(said.contains("pip install onnxruntime"), "{said}");
    }
    let said = outcome("automatic", &[("ORT_DYLIB_PATH", missing)]);
    assert!(
        said.starts_with(
            "embedded  ONNX Runtime library /no/such/libonnxruntime.so: cannot be read"
        ),
        "{said}"
    );
    assert_eq!(
        outcome("embedded", &[("ORT_DYLIB_PATH", missing)]),
        "embedded  "
    );
}

#[test]
fn files_that_are_no_usable_library() {
    let folder = tempfile::tempdir().unwrap();
    let check = |name: &str, content: &[u8], problem: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        let said = outcome(path.to_str().unwrap(), &[]);
        assert!(
            said.starts_with("error ONNX Runtime library") && said.contains(problem),
            "{said}"
        );
        let said = outcome("automatic", &[("ORT_DYLIB_PATH", &path)]);
        assert!(
            said.starts_with("embedded  ONNX Runtime library") && said.contains(problem),
            "{said}"
        );
    };
    check("empty.so", b"", "file too short");
    check(
        "text.so",
        &b"INPUT(libonnxruntime.so.1)\n".repeat(9),
        "invalid ELF header",
    );
    check("head.so", b"\x7fELF\x02\x01\x01", "is truncated");
    if let Some(other) = other_library() {
        let whole = std::fs::read(&other).unwrap();
        check("other.so", &whole, "has no `OrtGetApiBase`");
        check("short.so", &whole[..whole.len() / 2], "is truncated");
    }
    let said = outcome(folder.path().to_str().unwrap(), &[]);
    assert!(said.contains("cannot be read: Is a directory"), "{said}");
}

#[test]
fn a_library_that_is_too_old() {
    // A library that only tells its version, made with the C compiler that Rust links with.
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("old.c");
    let old = folder.path().join("libonnxruntime.so.1.16.3");
    std::fs::write(
        &source,
        "struct base { void *(*api)(unsigned); const char *(*version)(void); };\n\
         static void *api(unsigned v) { return 0; }\n\
         static const char *version(void) { return \"1.16.3\"; }\n\
         static struct base it = { api, version };\n\
         struct base *OrtGetApiBase(void) { return &it; }\n",
    )
    .unwrap();
    let compiled = Command::new("cc")
        .args(["-shared", "-fPIC", "-o"])
        .arg(&old)
        .arg(&source)
        .status();
    if !compiled.is_ok_and(|status| status.success()) {
        println!("skipped: no C compiler");
        return;
    }
    let said = outcome(old.to_str().unwrap(), &[]);
    assert!(
        said.contains("is version 1.16.3, and at least 1.24 is needed; install a newer one"),
        "{said}"
    );
    let said = outcome("automatic", &[("ORT_DYLIB_PATH", &old)]);
    assert!(
        said.starts_with("embedded ") && said.contains("1.16.3"),
        "{said}"
    );
    // In one of the usual places it is passed over, and the next one serves where there is one.
    let variables = [("LD_LIBRARY_PATH", folder.path())];
    let said = outcome("automatic", &variables);
    assert!(
        said.starts_with("onnxruntime ") || said.contains("is version 1.16.3"),
        "{said}"
    );
    if let Some(library) = library() {
        let cases = [old.to_str().unwrap(), library.to_str().unwrap()];
        let said = outcomes(&cases, &[]);
        assert!(
            said[0].starts_with("error ") && said[1].starts_with("onnxruntime "),
            "{said:?}"
        );
    }
}

#[test]
fn a_library_is_found_where_it_is() {
    let Some(library) = library() else { return };
    let folder = library.parent().unwrap();
    let place = library.display();
    assert_eq!(
        outcome(library.to_str().unwrap(), &[]),
        format!("onnxruntime {place} ")
    );
    assert_eq!(
        outcome("onnxruntime", &[("ORT_DYLIB_PATH", &library)]),
        format!("onnxruntime {place} ")
    );
    assert_eq!(
        outcome("automatic", &[("LD_LIBRARY_PATH", folder)]),
        format!("onnxruntime {place} ")
    );
    // The Python package of an active environment.
    let environment = tempfile::tempdir().unwrap();
    let packages = environment
        .path()
        .join("lib/python3.12/site-packages/onnxruntime");
    std::fs::create_dir_all(&packages).unwrap();
    std::os::unix::fs::symlink(folder, packages.join("capi")).unwrap();
    let said = outcome("automatic", &[("VIRTUAL_ENV", environment.path())]);
    assert!(said.starts_with("onnxruntime "), "{said}");
}

#[test]
fn a_process_loads_one_library() {
    let Some(library) = library() else { return };
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("link.so");
    let copy = folder.path().join("copy.so");
    std::os::unix::fs::symlink(&library, &link).unwrap();
    std::fs::copy(&library, &copy).unwrap();
    let paths = [&library, &link, &copy].map(|path| path.to_str().unwrap());
    let said = outcomes(
        &[
            paths[0],
            "automatic",
            paths[1],
            paths[2],
            "embedded",
            "onnxruntime",
        ],
        &[],
    );
    for index in [0, 1, 2, 5] {
        assert!(said[index].starts_with("onnxruntime "), "{said:?}");
    }
    assert!(
        said[3].starts_with("error ") && said[3].contains("can load only one"),
        "{said:?}"
    );
    assert_eq!(said[4], "embedded  ");
    // Cut short, it is found out before the system's loader touches it.
    let whole = std::fs::read(&library).unwrap();
    std::fs::write(&copy, &whole[..whole.len() / 3]).unwrap();
    let said = outcome("automatic", &[("ORT_DYLIB_PATH", &copy)]);
    assert!(
        said.starts_with("embedded ") && said.contains("is truncated"),
        "{said}"
    );
}
