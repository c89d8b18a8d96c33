//! What `cargo metadata` knows of the workspace.

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::{
    collections::BTreeMap,
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

const INCREMENTAL: &str = "CARGO_INCREMENTAL";

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
    #[serde(default)]
    pub rust_version: Option<String>,
    #[serde(default)]
    pub description: Option<String>,
    #[serde(default)]
    pub keywords: Vec<String>,
    #[serde(default)]
    pub categories: Vec<String>,
    #[serde(default)]
    pub readme: Option<PathBuf>,
    pub features: BTreeMap<String, Vec<String>>,
    /// Where it may be published: `None` anywhere, an empty list nowhere.
    #[serde(default)]
    pub publish: Option<Vec<String>>,
}

#[derive(Deserialize)]
pub(crate) struct Dependency {
    pub name: String,
    pub rename: Option<String>,
    /// `None` for a normal dependency, else `dev` or `build`.
    pub kind: Option<String>,
    pub optional: bool,
    #[serde(default)]
    pub uses_default_features: bool,
    #[serde(default)]
    pub features: Vec<String>,
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

    /// Writes the workspace's profiles to a file that `cargo --config` reads where no workspace is.
    pub(crate) fn profile_file(&self) -> Result<PathBuf> {
        let manifest = self.root.join("Cargo.toml");
        let text = fs::read_to_string(&manifest).with_context(|| manifest.display().to_string())?;
        let mut table: toml::Table = text.parse()?;
        table.retain(|key, _| key == "profile");
        let path = self.target_directory.join("profiles.toml");
        fs::create_dir_all(&self.target_directory)
            .and_then(|()| fs::write(&path, table.to_string()))
            .with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
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

    /// Its features but `default`.
    pub(crate) fn own_features(&self) -> impl Iterator<Item = &str> {
        let names = self.features.keys().map(String::as_str);
        names.filter(|name| *name != "default")
    }

    /// May it be published?
    pub(crate) fn is_public(&self) -> bool {
        self.publish
            .as_ref()
            .is_none_or(|places| !places.is_empty())
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
///
/// What is compiled for a check is not edited between two builds, and is compiled faster as a whole; whoever wants it
/// otherwise sets the variable.
pub(crate) fn cargo() -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    if env::var_os(INCREMENTAL).is_none() {
        command.env(INCREMENTAL, "0");
    }
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
