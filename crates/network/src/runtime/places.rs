use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The machine as the search for the library sees it.
///
/// A test gives its own.
pub(super) struct Surroundings<'a> {
    /// A variable of the environment.
    pub(super) variable: &'a dyn Fn(&str) -> Option<OsString>,
    /// Folder of the program itself.
    pub(super) program: Option<PathBuf>,
    /// The file system's root.
    pub(super) root: PathBuf,
}

/// The system's folders of libraries, relative to the root.
const SYSTEM: [&str; 7] = [
    "usr/local/lib",
    "usr/local/lib64",
    "usr/lib",
    "usr/lib64",
    "usr/lib/x86_64-linux-gnu",
    "usr/lib/aarch64-linux-gnu",
    "opt/homebrew/lib",
];

/// Where the system's own Python packages are, relative to the root.
const SYSTEM_PREFIXES: [&str; 3] = ["usr/local", "usr", "opt/homebrew"];

/// Variables that list folders for the system's loader; on Windows that is `PATH`.
const LOADER_PATHS: &[&str] = if cfg!(windows) {
    &["PATH"]
} else {
    &["LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH"]
};

impl Surroundings<'_> {
    /// Every ONNX Runtime library in the usual places, nearest place first, newest first within one.
    ///
    /// These are: beside the program, the folders that the system's loader is told of, the system's own,
    /// and the Python package `onnxruntime` of the active environment, of the user and of the system.
    pub(super) fn libraries(&self) -> Vec<PathBuf> {
        let mut folders: Vec<PathBuf> = Vec::new();
        if let Some(program) = &self.program {
            folders.extend(["", "lib", "../lib"].map(|folder| program.join(folder)));
        }
        folders.extend(LOADER_PATHS.iter().flat_map(|name| self.paths(name)));
        folders.extend(SYSTEM.iter().map(|folder| self.root.join(folder)));
        let prefixes = self.python_prefixes();
        let packages = prefixes.iter().flat_map(|prefix| site_packages(prefix));
        folders.extend(packages.map(|folder| folder.join("onnxruntime/capi")));

        let mut libraries = Vec::new();
        for library in folders.iter().flat_map(|folder| libraries_in(folder)) {
            if !libraries.contains(&library) {
                libraries.push(library);
            }
        }
        libraries
    }

    /// The folders into which Pythons are installed, and their environments.
    fn python_prefixes(&self) -> Vec<PathBuf> {
        let path = |name: &str| self.paths(name).into_iter().next();
        let mut prefixes: Vec<PathBuf> = Vec::new();
        prefixes.extend(path("VIRTUAL_ENV"));
        prefixes.extend(path("CONDA_PREFIX"));
        for folder in self.paths("PATH") {
            let has_python = |name: &&str| folder.join(name).exists();
            if ["python3", "python.exe"].iter().any(has_python) {
                // On Windows it lies in its prefix, elsewhere in the prefix's `bin`.
                prefixes.extend(
                    [folder.parent(), Some(&folder)]
                        .into_iter()
                        .flatten()
                        .map(Into::into),
                );
            }
        }
        if let Some(home) = path("HOME") {
            prefixes.push(home.join(".local"));
            prefixes.extend(entries(&home.join(".pyenv/versions"), ""));
        }
        prefixes.extend(SYSTEM_PREFIXES.map(|prefix| self.root.join(prefix)));
        prefixes
    }

    /// The folders that a variable lists. Relative ones are passed over: what is loaded must not depend on
    /// the folder from which the program was started.
    fn paths(&self, name: &str) -> Vec<PathBuf> {
        let value = (self.variable)(name).unwrap_or_default();
        std::env::split_paths(&value)
            .filter(|folder| folder.is_absolute())
            .collect()
    }
}

/// Folders of packages of a Python that is installed here.
fn site_packages(prefix: &Path) -> Vec<PathBuf> {
    let versions = entries(&prefix.join("lib"), "python3").into_iter();
    let packages = versions.flat_map(|v| [v.join("site-packages"), v.join("dist-packages")]);
    packages.chain([prefix.join("Lib/site-packages")]).collect()
}

/// Whether a file of this name is an ONNX Runtime library, on this system.
fn is_library(name: &str) -> bool {
    if cfg!(windows) {
        name.eq_ignore_ascii_case("onnxruntime.dll")
    } else if cfg!(target_vendor = "apple") {
        name.starts_with("libonnxruntime.") && name.ends_with("dylib")
    } else {
        name == "libonnxruntime.so" || name.starts_with("libonnxruntime.so.")
    }
}

/// The libraries in one folder, newest first; links to another of them are left out.
fn libraries_in(folder: &Path) -> Vec<PathBuf> {
    let mut libraries: Vec<PathBuf> = entries(folder, "")
        .into_iter()
        .filter(|path| {
            let name = path.file_name().and_then(|name| name.to_str());
            name.is_some_and(is_library)
        })
        // A link that leads nowhere stays as it is: trying it tells what is wrong with it.
        .map(|path| path.canonicalize().unwrap_or(path))
        .collect();
    libraries.sort_by_key(|path| std::cmp::Reverse(version_in_name(path)));
    libraries.dedup();
    libraries
}

/// The version in a library's name: `[1, 32, 0]` of `libonnxruntime.so.1.32.0`.
pub(super) fn version_in_name(path: &Path) -> Vec<u32> {
    let name = path.file_name().and_then(|name| name.to_str());
    let parts = name.unwrap_or_default().split('.');
    parts.filter_map(|part| part.parse().ok()).collect()
}

/// What is in a folder and begins so, in a fixed order; nothing where there is no such folder.
fn entries(folder: &Path, prefix: &str) -> Vec<PathBuf> {
    let Ok(listing) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = listing
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(prefix))
        .map(|entry| entry.path())
        .collect();
    paths.sort_by_cached_key(|path| (version_in_name(path), path.clone()));
    paths.reverse();
    paths
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use super::*;

    struct Machine(tempfile::TempDir);

    impl Machine {
        fn with(files: &[&str]) -> Self {
            let machine = Self(tempfile::tempdir().unwrap());
            for file in files {
                let path = machine.0.path().join(file);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(path, "").unwrap();
            }
            machine
        }

        /// What is found, relative to the root, with variables whose paths begin at the root.
        fn found(&self, variables: &[(&str, &str)]) -> Vec<String> {
            let root = self.0.path().canonicalize().unwrap();
            let variable = |name: &str| {
                let value = variables.iter().find(|(key, _)| *key == name)?.1;
                let paths = value.split(':').map(|path| match path.strip_prefix('/') {
                    Some(path) => root.join(path),
                    None => PathBuf::from(path),
                });
                Some(std::env::join_paths(paths).unwrap())
            };
            let surroundings = Surroundings {
                variable: &variable,
                program: Some(root.join("program")),
                root: root.clone(),
            };
            let libraries = surroundings.libraries();
            let names = libraries
                .iter()
                .map(|path| path.strip_prefix(&root).unwrap());
            names.map(|path| path.display().to_string()).collect()
        }
    }

    #[test]
    fn nothing_is_found_where_nothing_is() {
        assert!(
            Machine::with(&[])
                .found(&[("HOME", "/home/me"), ("PATH", "/usr/bin")])
                .is_empty()
        );
    }

    #[test]
    fn the_nearest_place_comes_first() {
        let machine = Machine::with(&[
            "usr/lib/python3/dist-packages/onnxruntime/capi/libonnxruntime.so.1.25.0",
            "usr/lib/libonnxruntime.so.1.24.1",
            "own/libonnxruntime.so",
            "program/libonnxruntime.so",
        ]);
        let expected = [
            "program/libonnxruntime.so",
            "own/libonnxruntime.so",
            "usr/lib/libonnxruntime.so.1.24.1",
            "usr/lib/python3/dist-packages/onnxruntime/capi/libonnxruntime.so.1.25.0",
        ];
        assert_eq!(
            machine.found(&[("LD_LIBRARY_PATH", "/own:relative")]),
            expected
        );
    }

    #[test]
    fn the_newest_comes_first_and_links_count_once() {
        let machine = Machine::with(&[
            "usr/lib/libonnxruntime.so.1.9.0",
            "usr/lib/libonnxruntime.so.1.24.1",
            "usr/lib/libonnxruntime_providers_shared.so",
        ]);
        let folder = machine.0.path().join("usr/lib");
        std::os::unix::fs::symlink("libonnxruntime.so.1.24.1", folder.join("libonnxruntime.so"))
            .unwrap();
        let expected = [
            "usr/lib/libonnxruntime.so.1.24.1",
            "usr/lib/libonnxruntime.so.1.9.0",
        ];
        assert_eq!(machine.found(&[]), expected);
    }

    #[test]
    fn python_packages_of_environments_and_users() {
        let capi = "site-packages/onnxruntime/capi/libonnxruntime.so.1.32.0";
        let files = [
            format!("venv/lib/python3.11/{capi}"),
            format!("conda/lib/python3.9/{capi}"),
            format!("conda/lib/python3.12/{capi}"),
            format!("home/me/.local/lib/python3.13/{capi}"),
            format!("home/me/.pyenv/versions/3.12.1/lib/python3.12/{capi}"),
            format!("other/lib/python3.12/{capi}"),
            "other/bin/python3".to_owned(),
        ];
        let machine = Machine::with(&files.each_ref().map(String::as_str));
        let found = |variables| machine.found(variables);
        assert_eq!(found(&[("VIRTUAL_ENV", "/venv")]), files[..1]);
        let conda = found(&[("CONDA_PREFIX", "/conda")]);
        assert_eq!(conda, [files[2].as_str(), files[1].as_str()]);
        assert_eq!(found(&[("HOME", "/home/me")]), files[3..5]);
        assert_eq!(found(&[("PATH", "/other/bin")]), files[5..6]);
    }
}
