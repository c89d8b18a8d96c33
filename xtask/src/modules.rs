//! The modules of a crate and the arrows between them, read from its sources.
//!
//! An arrow runs from a module to another that defines what the first one names: in a `use`, in a path, or in a
//! path inside a macro. Re-exports are followed to the module that defines the name, so that nothing hides
//! behind `use crate::{…}`. What only tests see is left out.

mod arrows;
mod circles;
mod resolve;
mod scan;
mod tokens;
mod tree;

pub(crate) use arrows::{Arrow, arrows};
pub(crate) use circles::{circles, on_circles};
pub(crate) use tree::Crate;

#[cfg(test)]
mod tests;
