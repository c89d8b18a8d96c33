//! Plots as SVG elements.

use plotters::prelude::*;
use std::ops::Range;

/// A colour of a series: red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rgb(pub u8, pub u8, pub u8);

/// Red.
pub const RED: Rgb = Rgb(178, 42, 48);
/// Blue.
pub const BLUE: Rgb = Rgb(56, 98, 160);
/// Green.
pub const GREEN: Rgb = Rgb(70, 140, 60);
/// Gray, for what is of less weight.
pub const GRAY: Rgb = Rgb(150, 156, 164);
/// Orange.
pub const ORANGE: Rgb = Rgb(214, 140, 30);
/// Violet.
pub const VIOLET: Rgb = Rgb(120, 70, 150);

const AXIS_COLOR: RGBColor = RGBColor(150, 156, 164);
const TEXT_COLOR: RGBColor = RGBColor(52, 58, 66);
const GRID_COLOR: RGBColor = RGBColor(232, 235, 238);

/// A plot could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("plot `{name}`: {reason}")]
#[non_exhaustive]
pub struct PlotError {
    /// The plot, by its axes.
    pub name: String,
    /// Why.
    pub reason: String,
}

/// One axis.
pub struct Axis<'a> {
    /// What it shows, with the unit.
    pub label: &'a str,
    /// From where to where; it may run backwards.
    pub range: Range<f64>,
    /// Names of the places 1, 2, 3 … in place of numbers; none for an axis of numbers.
    pub names: &'a [&'a str],
}

impl<'a> Axis<'a> {
    /// An axis of numbers.
    pub fn new(label: &'a str, range: Range<f64>) -> Self {
        Self {
            label,
            range,
            names: &[],
        }
    }

    fn tick(&self, value: f64) -> String {
        if self.names.is_empty() {
            return tick(value, &self.range);
        }
        let name = self.names.get((value.round() as usize).wrapping_sub(1));
        name.map_or_else(String::new, |name| (*name).to_owned())
    }
}

/// How a series is drawn.
pub enum Marks {
    /// Bars that stand on the axis: from, to, height.
    Bars(Vec<(f64, f64, f64)>),
    /// A line through all points.
    Line(Vec<(f64, f64)>),
    /// Lines, each from a point to a point.
    Segments(Vec<[(f64, f64); 2]>),
    /// Small dots.
    Dots(Vec<(f64, f64)>),
    /// Large rings.
    Rings(Vec<(f64, f64)>),
    /// Values with an interval: x, low, value, high.
    Intervals(Vec<(f64, f64, f64, f64)>),
}

/// One series; the caption says what its colour means.
pub struct Series {
    /// Its colour.
    pub color: Rgb,
    /// Its values, and how they are drawn.
    pub marks: Marks,
}

/// A plot of `width` × `height` pixels as an SVG element.
///
/// # Errors
///
/// [`PlotError`] where the axes cannot be drawn.
pub fn plot(
    (width, height): (u32, u32),
    x: &Axis<'_>,
    y: &Axis<'_>,
    series: &[Series],
) -> Result<String, PlotError> {
    let mut svg = String::new();
    draw(&mut svg, (width, height), x, y, series).map_err(|reason| PlotError {
        name: format!("{} over {}", y.label, x.label),
        reason,
    })?;
    // A page says what an image shows; the prologue is for files.
    let start = svg.find("<svg").unwrap_or(0);
    let label = format!(
        "<svg role=\"img\" aria-label=\"{} over {}\"",
        y.label, x.label
    );
    Ok(svg[start..].replacen("<svg", &label, 1))
}

fn draw(
    svg: &mut String,
    size: (u32, u32),
    x: &Axis<'_>,
    y: &Axis<'_>,
    series: &[Series],
) -> Result<(), String> {
    let text = |e: &dyn std::fmt::Display| e.to_string();
    let area = SVGBackend::with_string(svg, size).into_drawing_area();
    let mut chart = ChartBuilder::on(&area)
        .margin(8)
        .margin_right(16)
        .x_label_area_size(44)
        .y_label_area_size(58)
        .build_cartesian_2d(x.range.clone(), y.range.clone())
        .map_err(|e| text(&e))?;
    let font = ("sans-serif", 14).into_font().color(&TEXT_COLOR);
    chart
        .configure_mesh()
        .x_labels(if x.names.is_empty() {
            7
        } else {
            2 * x.names.len()
        })
        .y_labels(6)
        .x_desc(x.label)
        .y_desc(y.label)
        .label_style(font.clone())
        .axis_desc_style(font.clone())
        .axis_style(AXIS_COLOR)
        .bold_line_style(GRID_COLOR)
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|v| x.tick(*v))
        .y_label_formatter(&|v| y.tick(*v))
        .draw()
        .map_err(|e| text(&e))?;
    for one in series {
        let Rgb(red, green, blue) = one.color;
        let color = RGBColor(red, green, blue);
        match &one.marks {
            Marks::Bars(bars) => chart.draw_series(bars.iter().map(|&(from, to, h)| {
                let mut bar = Rectangle::new([(from, 0.0), (to, h)], color.mix(0.75).filled());
                bar.set_margin(0, 0, 1, 1);
                bar.into_dyn()
            })),
            Marks::Line(points) => {
                chart.draw_series([
                    PathElement::new(points.clone(), color.stroke_width(2)).into_dyn()
                ])
            }
            Marks::Segments(segments) => chart.draw_series(
                segments
                    .iter()
                    .map(|s| PathElement::new(s.to_vec(), color.mix(0.3)).into_dyn()),
            ),
            Marks::Dots(points) => chart.draw_series(
                points
                    .iter()
                    .map(|&p| Circle::new(p, 2, color.mix(0.45).filled()).into_dyn()),
            ),
            Marks::Rings(points) => chart.draw_series(
                points
                    .iter()
                    .map(|&p| Circle::new(p, 5, color.stroke_width(2)).into_dyn()),
            ),
            Marks::Intervals(values) => {
                chart.draw_series(values.iter().map(|&(x, low, mid, high)| {
                    ErrorBar::new_vertical(x, low, mid, high, color.stroke_width(2).filled(), 8)
                        .into_dyn()
                }))
            }
        }
        .map_err(|e| text(&e))?;
    }
    area.present().map_err(|e| text(&e))
}

/// A tick's number, with the digits that the range asks for.
fn tick(value: f64, range: &Range<f64>) -> String {
    let span = (range.end - range.start).abs();
    let value = if value.abs() < span * 1e-9 {
        0.0
    } else {
        value
    };
    if span >= 20.0 {
        format!("{value:.0}")
    } else if span >= 2.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
}

/// The range of values with a twentieth to spare on both sides; of one value, or none, a unit about it.
pub fn range_of(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    if !(high > low) {
        let middle = if low.is_finite() { low } else { 0.0 };
        return middle - 0.5..middle + 0.5;
    }
    let spare = 0.05 * (high - low);
    low - spare..high + spare
}

/// From zero to the largest value and a little more.
pub fn from_zero(values: impl Iterator<Item = f64>) -> Range<f64> {
    let high = values.fold(0.0, f64::max);
    0.0..if high > 0.0 { 1.08 * high } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_is_an_svg_element_with_its_labels() {
        let x = Axis::new("angle (°)", 0.0..90.0);
        let y = Axis::new("share (%)", 0.0..100.0);
        let series = [
            Series {
                color: RED,
                marks: Marks::Bars(vec![(0.0, 5.0, 60.0)]),
            },
            Series {
                color: BLUE,
                marks: Marks::Intervals(vec![(20.0, 1.0, 2.0, 3.0)]),
            },
        ];
        let svg = plot((480, 300), &x, &y, &series).unwrap();
        assert!(svg.starts_with("<svg role=\"img\"") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains("angle (°)") && svg.contains("share (%)"));
    }

    #[test]
    fn ranges_of_nothing_and_of_one_value_can_be_drawn() {
        assert_eq!(range_of(std::iter::empty()), -0.5..0.5);
        assert_eq!(range_of([3.0].into_iter()), 2.5..3.5);
        assert_eq!(from_zero(std::iter::empty()), 0.0..1.0);
    }
}
