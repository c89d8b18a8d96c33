use super::choice::RuntimeChoice;
use super::isolated::panic_message;
use super::places::{Surroundings, version_in_name};
use super::truncation::is_truncated;
use crate::error::NetworkError;
use ort::environment::Environment;
use std::error::Error;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// ONNX Runtime, loaded.
#[derive(Clone)]
pub(super) struct Library {
    pub(super) path: PathBuf,
    pub(super) version: String,
    pub(super) environment: Environment,
}

/// What the process has loaded. It can load one library once: the binding keeps it for good.
static LOADED: Mutex<Option<Result<Library, Stuck>>> = Mutex::new(None);

/// A library that was loaded and then would not start.
#[derive(Clone)]
struct Stuck {
    path: PathBuf,
    problem: String,
}

const NAME: &str = "ONNX Runtime";

/// What to do where none is found.
const INSTALL: &str = "install it (`pip install onnxruntime` will do) or name its library by --runtime or ORT_DYLIB_PATH";

/// What to do with a damaged one.
const AGAIN: &str = "install it again: `pip install onnxruntime` will do";

/// Loads the library that `choice` or the environment names, or the first usable one of the usual places.
///
/// One that is named, by the choice or by `ORT_DYLIB_PATH`, must be usable; no other is tried in its place.
pub(super) fn load(choice: &RuntimeChoice) -> Result<Library, NetworkError> {
    let mut loaded = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
    let named = match choice {
        RuntimeChoice::Library(path) => Some(path.clone()),
        _ => std::env::var_os("ORT_DYLIB_PATH")
            .filter(|path| !path.is_empty())
            .map(PathBuf::from),
    };
    match (named, &*loaded) {
        (Some(path), Some(present)) => same(&path, present),
        (None, Some(present)) => present.clone().map_err(|stuck| stuck.error()),
        (Some(path), None) => start(&path, &mut loaded),
        (None, None) => search(&mut loaded),
    }
}

/// The library that is present, if it is the one that is asked for.
fn same(path: &Path, present: &Result<Library, Stuck>) -> Result<Library, NetworkError> {
    let present_path = match present {
        Ok(library) => &library.path,
        Err(stuck) => &stuck.path,
    };
    let path = resolve(path)?;
    if path == *present_path {
        return present.clone().map_err(|stuck| stuck.error());
    }
    Err(refused(
        &path,
        &format!(
            "this process has loaded {}, and can load only one",
            present_path.display()
        ),
        "use that one, or start another process",
    ))
}

type Slot = Option<Result<Library, Stuck>>;

fn search(slot: &mut Slot) -> Result<Library, NetworkError> {
    let variable = |name: &str| std::env::var_os(name);
    let surroundings = Surroundings {
        variable: &variable,
        program: std::env::current_exe()
            .ok()
            .and_then(|program| program.parent().map(Path::to_owned)),
        root: PathBuf::from("/"),
    };
    let mut tried = String::new();
    for path in surroundings.libraries() {
        match start(&path, slot) {
            Ok(library) => return Ok(library),
            // One that was loaded and is stuck bars all others.
            Err(error) if slot.is_some() => return Err(error),
            Err(error) => {
                let separator = if tried.is_empty() { "" } else { "; " };
                let _ = write!(tried, "{separator}{error}");
            }
        }
    }
    let problem = if tried.is_empty() {
        "no library of it was found in the usual places".to_owned()
    } else {
        format!("no usable library of it was found in the usual places ({tried})")
    };
    Err(NetworkError::Runtime {
        runtime: NAME.to_owned(),
        problem,
        remedy: INSTALL.to_owned(),
    })
}

/// The file itself, links followed.
fn resolve(path: &Path) -> Result<PathBuf, NetworkError> {
    path.canonicalize()
        .map_err(|error| refused(path, &format!("cannot be read: {error}"), INSTALL))
}

/// Loads one library.
fn start(path: &Path, slot: &mut Slot) -> Result<Library, NetworkError> {
    let path = resolve(path)?;
    match is_truncated(&path) {
        Ok(false) => (),
        Ok(true) => return Err(refused(&path, "is truncated", AGAIN)),
        Err(error) => return Err(refused(&path, &format!("cannot be read: {error}"), INSTALL)),
    }
    // The binding checks the version before it keeps the library, so another one can be tried after it.
    let attempt = catch_unwind(AssertUnwindSafe(|| ort::init_from(&path)));
    let builder = match attempt {
        Ok(Ok(builder)) => builder,
        Ok(Err(error)) => return Err(refused_by_binding(&path, error)),
        Err(panic) => return Err(refused(&path, &panic_message(panic.as_ref()), INSTALL)),
    };
    let builder = builder.with_name("pomona").with_telemetry(false);
    let environment = match catch_unwind(AssertUnwindSafe(|| builder.build())) {
        Ok(Ok(environment)) => Ok(environment),
        Ok(Err(error)) => Err(error.to_string()),
        Err(panic) => Err(panic_message(panic.as_ref())),
    };
    let started = match environment {
        Ok(environment) => Ok(Library {
            version: version_of(&path),
            path,
            environment,
        }),
        Err(problem) => Err(Stuck { path, problem }),
    };
    *slot = Some(started.clone());
    started.map_err(|stuck| stuck.error())
}

impl Stuck {
    fn error(&self) -> NetworkError {
        let problem = format!("was loaded but does not start: {}", self.problem);
        refused(
            &self.path,
            &problem,
            "start the program again with another library",
        )
    }
}

fn refused(path: &Path, problem: &str, remedy: &str) -> NetworkError {
    NetworkError::Runtime {
        runtime: format!("{NAME} library {}", path.display()),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}

fn refused_by_binding(path: &Path, error: ort::LoadDynamicError) -> NetworkError {
    use ort::LoadDynamicError as Failure;
    match error {
        Failure::Dlopen { error, .. } => refused(
            path,
            &format!("the system's loader refuses it: {}", innermost(&error)),
            "give ONNX Runtime's own library for this system: `pip install onnxruntime` installs one",
        ),
        Failure::MissingApi { .. } => refused(
            path,
            "is a shared library, but not ONNX Runtime: it has no `OrtGetApiBase`",
            "name ONNX Runtime's own library, such as libonnxruntime.so",
        ),
        Failure::InvalidVersionString => refused(
            path,
            "does not tell its version",
            "install an official build",
        ),
        Failure::BadVersion { version_str, .. } => refused(
            path,
            &format!(
                "is version {version_str}, and at least 1.{} is needed",
                ort::MINOR_VERSION
            ),
            "install a newer one: `pip install --upgrade onnxruntime` will do",
        ),
    }
}

/// The message of an error's first cause: that of the system's loader, below the binding's own.
fn innermost(mut error: &dyn Error) -> String {
    while let Some(cause) = error.source() {
        error = cause;
    }
    error.to_string()
}

/// The version of a library that the binding found new enough: from its name, else from the version under
/// which it exports its symbols.
fn version_of(path: &Path) -> String {
    let named = version_in_name(path);
    if named.len() >= 2 {
        return named
            .iter()
            .map(u32::to_string)
            .collect::<Vec<_>>()
            .join(".");
    }
    let exported = std::fs::read(path)
        .ok()
        .and_then(|bytes| exported_version(&bytes));
    exported.unwrap_or_else(|| format!("1.{} or newer", ort::MINOR_VERSION))
}

/// What follows `VERS_` in a library's table of names.
fn exported_version(bytes: &[u8]) -> Option<String> {
    const MARK: &[u8] = b"\0VERS_";
    let start = bytes.windows(MARK.len()).position(|part| part == MARK)? + MARK.len();
    let rest = &bytes[start..bytes.len().min(start + 16)];
    let end = rest.iter().position(|&byte| byte == 0)?;
    let version = std::str::from_utf8(&rest[..end]).ok()?;
    let is_version = version.split('.').all(|part| part.parse::<u32>().is_ok());
    is_version.then(|| version.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_version_of_a_library() {
        assert_eq!(
            version_of(Path::new("/x/libonnxruntime.so.1.24.2")),
            "1.24.2"
        );
        assert_eq!(
            version_of(Path::new("/x/libonnxruntime.1.24.2.dylib")),
            "1.24.2"
        );
        assert_eq!(version_of(Path::new("/x/onnxruntime.dll")), "1.24 or newer");
        assert_eq!(
            exported_version(b"abc\0VERS_1.25.0\0x"),
            Some("1.25.0".into())
        );
        assert_eq!(exported_version(b"abc\0VERS_x\0x"), None);
    }
}
