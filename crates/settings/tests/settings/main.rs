//! What is made from one declaration.

mod checks;
mod description;
mod files;
mod oven;
mod readers;
