//! What `cargo metadata` knows of the workspace.

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::{
    collections::BTreeMap,
    env,
    path::{Path, PathBuf},
    process::Command,
};

/// The workspace's packages; no others are listed.
#[derive(Deserialize)]
pub(crate) struct Workspace {
    pub packages: Vec<Package>,
    #[serde(rename = "workspace_root")]
    pub root: PathBuf,
    pub target_directory: PathBuf,
}

#[derive(Deserialize)]
pub(crate) struct Package {
    pub name: String,
    pub manifest_path: PathBuf,
    pub dependencies: Vec<Dependency>,
    pub targets: Vec<Target>,
    pub features: BTreeMap<String, Vec<String>>,
}

#[derive(Deserialize)]
pub(crate) struct Dependency {
    pub name: String,
    pub rename: Option<String>,
    /// `None` for a normal dependency, else `dev` or `build`.
    pub kind: Option<String>,
    pub optional: bool,
}

#[derive(Deserialize)]
pub(crate) struct Target {
    pub name: String,
    pub kind: Vec<String>,
    pub src_path: PathBuf,
}

impl Workspace {
    /// Asks cargo.
    pub(crate) fn read() -> Result<Self> {
        Self::read_at(root())
    }

    /// Asks cargo about another checkout.
    pub(crate) fn read_at(root: &Path) -> Result<Self> {
        let output = cargo()
            .current_dir(root)
            .args(["metadata", "--format-version=1", "--no-deps"])
            .output()
            .context("cannot start cargo")?;
        let errors = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "cargo metadata failed:\n{errors}");
        serde_json::from_slice(&output.stdout).context("cargo metadata printed something else")
    }

    pub(crate) fn package(&self, name: &str) -> Option<&Package> {
        self.packages.iter().find(|package| package.name == name)
    }

    /// A path as a reader of the repository writes it.
    pub(crate) fn relative<'a>(&self, path: &'a Path) -> &'a Path {
        path.strip_prefix(&self.root).unwrap_or(path)
    }
}

impl Package {
    pub(crate) fn folder(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(&self.manifest_path)
    }

    /// The root source file of the first target of this kind (`lib`, `bin`).
    pub(crate) fn root_file(&self, kind: &str) -> Option<&Path> {
        let mut targets = self.targets.iter();
        let target = targets.find(|target| target.kind.iter().any(|k| k == kind))?;
        Some(&target.src_path)
    }

    /// The root source files of its library and its programs.
    pub(crate) fn roots(&self) -> impl Iterator<Item = &Path> {
        let kind = |kind: &String| kind == "lib" || kind == "bin";
        let targets = self
            .targets
            .iter()
            .filter(move |target| target.kind.iter().any(kind));
        targets.map(|target| target.src_path.as_path())
    }
}

impl Dependency {
    /// Is it linked into what users of the package get?
    pub(crate) fn is_normal(&self) -> bool {
        self.kind.is_none()
    }

    /// The dependency as Rust code names it.
    pub(crate) fn identifier(&self) -> String {
        self.rename.as_ref().unwrap_or(&self.name).replace('-', "_")
    }
}

/// The cargo that runs us, in the workspace's root.
pub(crate) fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// The workspace's root.
pub(crate) fn root() -> &'static Path {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask)
}

#[cfg(test)]
impl Workspace {
    /// These packages, in a folder that does not exist.
    pub(crate) fn of(packages: Vec<Package>) -> Self {
        Self {
            packages,
            root: "/nowhere".into(),
            target_directory: "/nowhere/target".into(),
        }
    }
}
