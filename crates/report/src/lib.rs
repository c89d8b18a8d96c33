//! Parts of a self-contained HTML page: tables, numbers, plots as SVG.
//!
//! ```
//! use pomona_report::html::{figures, page, table};
//! use pomona_report::number::mm;
//! use pomona_report::plot::{Axis, Marks, RED, Series, plot};
//!
//! let rows = [vec!["a".to_owned(), mm(0.0042)]];
//! let curve = Series { color: RED, marks: Marks::Line(vec![(0.0, 0.0), (1.0, 4.2)]) };
//! let svg = plot((480, 300), &Axis::new("time (s)", 0.0..1.0), &Axis::new("error (mm)", 0.0..5.0), &[curve])?;
//!
//! let body = table(&["apple", "error mm"], &rows) + &figures(1, &[(svg, "Error over time.".to_owned())]);
//! let text = page("Errors", &body);
//! assert!(text.contains("<td>4.20</td>") && text.contains("<svg"));
//! # Ok::<(), pomona_report::plot::PlotError>(())
//! ```
//!
//! # Concepts
//!
//! - [`html`]: elements and the enclosing page; text is escaped, style sheets and plots are inline.
//! - [`number`]: numbers as table cells, in human-readable units.
//! - [`plot`](mod@plot): axes and series of marks, drawn as an SVG element.
//!
//! # Not here
//!
//! What is reported: `pomona-evaluate` and `pomona-labels` compose their own pages. Terminal tables belong to the
//! command line.

pub mod html;
pub mod number;
pub mod plot;
