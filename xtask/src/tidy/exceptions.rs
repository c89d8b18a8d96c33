//! Every exception to a rule of `tidy`, each with its reason.

/// Files that may be longer than the rest: path and reason.
pub(super) const LONG_FILES: &[(&str, &str)] = &[];

/// Dependencies that no source names: package, dependency and reason.
pub(super) const UNNAMED_DEPENDENCIES: &[(&str, &str, &str)] = &[(
    "pomona-cli",
    "idna_adapter",
    "its version keeps tables of host names out of boon",
)];

/// Crates whose modules still form circles. The list only shrinks.
pub(super) const CRATES_WITH_CIRCLES: &[&str] = &[];
