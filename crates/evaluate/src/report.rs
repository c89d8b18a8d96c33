//! The pages that a person reads.

mod caliper_page;
mod colors;
mod difficulty;
mod evaluation_page;
mod lab_tables;
mod overview;
mod real_page;
mod reliability;
mod repeats;
mod spread;

pub use caliper_page::caliper_page;
pub use evaluation_page::report_page;
pub use real_page::real_page;
