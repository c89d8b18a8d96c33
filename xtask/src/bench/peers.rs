//! The engines that `--peers` knows, and how each is built where it can be.

use super::{
    clouds::{Mode, Primitive},
    engine::Engine,
};
use crate::workspace::{cargo, root};
use std::{
    env,
    ffi::OsString,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

const ALL: &[(Primitive, Mode)] = &[
    (Primitive::Sphere, Mode::Full),
    (Primitive::Sphere, Mode::Adaptive),
    (Primitive::Line, Mode::Full),
    (Primitive::Line, Mode::Adaptive),
];
const FULL: &[(Primitive, Mode)] = &[
    (Primitive::Sphere, Mode::Full),
    (Primitive::Line, Mode::Full),
];
const OWN_STOP: &[(Primitive, Mode)] = &[
    (Primitive::Sphere, Mode::Adaptive),
    (Primitive::Line, Mode::Adaptive),
];
const SPHERE: &[(Primitive, Mode)] = &[(Primitive::Sphere, Mode::Adaptive)];

/// Ours first; `folder` takes what is built. Peers of a registry are fetched only with `install`.
pub(super) fn all(ours: &Path, folder: &Path, install: bool) -> Vec<Engine> {
    let engine = |name, remark, jobs, program| Engine {
        name,
        remark,
        jobs,
        max_scenes: usize::MAX,
        program,
    };
    let rust = |name| rust(name, folder, install);
    let ours = |pruning: &str| Ok(vec![ours.into(), "serve".into(), pruning.into()]);
    vec![
        engine(
            "pomona",
            "loses the best hypothesis once in a hundred searches at most",
            ALL,
            ours("statistical"),
        ),
        engine("pomona, lossless", "", ALL, ours("lossless")),
        engine(
            "pomona, no pruning",
            "every model scored on every point",
            ALL,
            ours("never"),
        ),
        engine("PCL -O3 native", "", ALL, pcl(folder, true)),
        engine("PCL as packaged", "", ALL, pcl(folder, false)),
        engine(
            "arrsac",
            "its own schedule, inliers refitted by us",
            OWN_STOP,
            rust("arrsac"),
        ),
        engine("inlier", "", ALL, rust("inlier")),
        engine("kornia-3d", "", ALL, rust("kornia-3d")),
        engine(
            "engeom",
            "MAGSAC++, its own schedule",
            SPHERE,
            rust("engeom"),
        ),
        Engine {
            max_scenes: 3,
            ..engine(
                "pyransac3d",
                "knows neither bounds nor refit; three clouds, one round",
                FULL,
                python(folder, install),
            )
        },
    ]
}

/// PCL from `PCL_ROOT`, or from where the distribution puts it.
///
/// As packaged, its compiled library does the work; natively, its templates
/// are compiled into the program with all that this machine's processor can do.
fn pcl(folder: &Path, native: bool) -> Result<Vec<OsString>, String> {
    let prefix = PathBuf::from(env::var_os("PCL_ROOT").unwrap_or_else(|| "/usr".into()));
    let include = prefix.join("include");
    let headers = fs::read_dir(&include)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path());
    let headers = headers
        .filter(|path| path.join("pcl/sample_consensus/ransac.h").is_file())
        .max()
        .ok_or_else(|| {
            format!(
                "no PCL under {}; install libpcl-dev or set PCL_ROOT to one that is unpacked",
                include.display()
            )
        })?;

    let program = folder.join(if native { "pcl-native" } else { "pcl-packaged" });
    let mut compiler = Command::new(env::var_os("CXX").unwrap_or_else(|| "c++".into()));
    compiler
        .arg("-std=c++17")
        .arg(root().join("xtask/peers/pcl/fit.cpp"))
        .arg("-o")
        .arg(&program);
    // The compiler's own folder must keep its place in the order of search.
    let own = (include != Path::new("/usr/include")).then(|| include.clone());
    for path in [headers, include.join("eigen3")].into_iter().chain(own) {
        compiler.arg("-isystem").arg(path);
    }
    for path in libraries(&prefix) {
        compiler
            .arg("-L")
            .arg(&path)
            .arg(format!("-Wl,-rpath,{}", path.display()));
    }
    compiler.arg("-Wl,--allow-shlib-undefined");
    if native {
        compiler.args([
            "-O3",
            "-march=native",
            "-DPCL_NO_PRECOMPILE",
            "-lpcl_common",
        ]);
    } else {
        compiler.args(["-O2", "-lpcl_sample_consensus", "-lpcl_common"]);
    }
    build("PCL's program", &mut compiler)?;
    Ok(vec![program.into()])
}

/// `lib` and the folders of single architectures in it that hold PCL.
fn libraries(prefix: &Path) -> Vec<PathBuf> {
    let lib = prefix.join("lib");
    let inner = fs::read_dir(&lib)
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path());
    let mut folders: Vec<PathBuf> = inner
        .chain([lib])
        .filter(|path| path.join("libpcl_common.so").exists())
        .collect();
    folders.sort();
    folders
}

fn python(folder: &Path, install: bool) -> Result<Vec<OsString>, String> {
    const REQUIREMENT: &str = "pyransac3d==0.7.0";
    let environment = folder.join("python");
    let python = environment.join("bin/python");
    if install {
        build(
            "a Python environment",
            Command::new("python3")
                .args(["-m", "venv"])
                .arg(&environment),
        )?;
        build(
            REQUIREMENT,
            Command::new(&python).args(["-m", "pip", "install", "--quiet", REQUIREMENT]),
        )?;
    }
    let found = Command::new(&python)
        .args(["-c", "import pyransac3d"])
        .output();
    if !found.is_ok_and(|output| output.status.success()) {
        return Err("not installed; `cargo xtask bench --peers --install` gets it".into());
    }
    Ok(vec![
        python.into(),
        root().join("xtask/peers/python/fit.py").into(),
    ])
}

/// One of the crates of `xtask/peers/rust`, each behind a feature of its name.
fn rust(name: &str, folder: &Path, install: bool) -> Result<Vec<OsString>, String> {
    let target = folder.join("rust");
    let mut command = cargo();
    command.args([
        "build",
        "--release",
        "--locked",
        "--bin",
        name,
        "--features",
        name,
    ]);
    command
        .arg("--manifest-path")
        .arg(root().join("xtask/peers/rust/Cargo.toml"));
    command.arg("--target-dir").arg(&target);
    if !install {
        command.arg("--offline");
    }
    build(name, &mut command).map_err(|reason| {
        format!("{reason}; `cargo xtask bench --peers --install` gets what it needs")
    })?;
    Ok(vec![target.join("release").join(name).into()])
}

/// Runs a command that makes `what`; the reason is the first line in which it speaks of an error, or its last.
pub(super) fn build(what: &str, command: &mut Command) -> Result<(), String> {
    eprintln!("building {what}");
    let output = command
        .output()
        .map_err(|error| format!("cannot start what builds it: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    let line = errors
        .lines()
        .find(|line| line.contains("error"))
        .or(errors.lines().last());
    Err(format!(
        "does not build: {}",
        line.unwrap_or("without a word").trim()
    ))
}
