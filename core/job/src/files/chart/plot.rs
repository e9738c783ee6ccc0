//! How a plot and what stands around it is drawn.

use std::fmt::Write as _;

use super::{Draw, LineStyle, Marker, Series};
use crate::files::scale::Scale;
use crate::files::svg::{label, line};

pub(super) const WIDTH: f64 = 760.0;
pub(super) const LEFT: f64 = 78.0;
const RIGHT: f64 = 28.0;
pub(super) const TOP: f64 = 64.0;
/// Of the plot itself, px.
pub(super) const HEIGHT: f64 = 330.0;
/// Of a row of the legend, px.
pub(super) const ROW: f64 = 20.0;
/// Markers on one curve.
const MARKERS: usize = 9;

pub(super) fn width() -> f64 {
    WIDTH - LEFT - RIGHT
}

/// Columns of the legend.
pub(super) fn columns_of(named: &[&Series]) -> usize {
    let names = named.iter().map(|series| series.name.chars().count());
    columns(names.max().unwrap_or(0))
}

/// Columns of the legend for names of so many letters.
fn columns(longest: usize) -> usize {
    // A letter is about 7.2 px wide.
    let wide = 46.0 + 7.2 * longest as f64 + 12.0;
    ((width() / wide) as usize).clamp(1, 3)
}

pub(super) fn titles(svg: &mut String, title: &str, note: &str) {
    label(svg, [WIDTH / 2.0, 24.0], "middle", title);
    label(svg, [WIDTH / 2.0, 44.0], "middle", note);
}

/// The names below a plot that ends at `bottom`.
pub(super) fn legend(svg: &mut String, named: &[&Series], bottom: f64) {
    let columns = columns_of(named);
    for (index, series) in named.iter().enumerate() {
        let column = width() / columns as f64;
        let left = LEFT + column * (index % columns) as f64;
        let middle = bottom + 60.0 + ROW * (index / columns) as f64;
        sample(svg, &series.draw, left, middle);
        label(svg, [left + 46.0, middle + 4.5], "start", &series.name);
    }
}

/// Where a plot stands in its picture, px.
pub(super) struct PlotArea {
    pub top: f64,
    pub height: f64,
}

impl PlotArea {
    /// Frame, ticks and curves; what goes across is numbered if it is said.
    pub fn plot(&self, svg: &mut String, [x, y]: [&Scale; 2], series: &[Series], numbered: bool) {
        self.axes(svg, x, y, numbered);
        let place = |[across, up]: [f64; 2]| {
            [LEFT + width() * x.share(across), self.top + self.height * (1.0 - y.share(up))]
        };
        for (index, series) in series.iter().enumerate() {
            draw(svg, &series.draw, index, place);
        }
    }

    fn axes(&self, svg: &mut String, x: &Scale, y: &Scale, numbered: bool) {
        let Self { top, height } = self;
        let (right, bottom) = (LEFT + width(), top + height);
        for (value, text) in y.ticks() {
            let up = bottom - height * y.share(value);
            line(svg, [LEFT, up], [right, up], "#d0d0d0", 0.7);
            line(svg, [LEFT - 5.0, up], [LEFT, up], "#000000", 1.0);
            label(svg, [LEFT - 9.0, up + 4.5], "end", &text);
        }
        for (value, text) in x.ticks() {
            let across = LEFT + width() * x.share(value);
            line(svg, [across, bottom], [across, bottom + 5.0], "#000000", 1.0);
            if numbered {
                label(svg, [across, bottom + 19.0], "middle", &text);
            }
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{top}\" width=\"{}\" height=\"{height}\" fill=\"none\" stroke=\"#000000\" stroke-width=\"1\"/>",
            width()
        );
    }
}

fn draw(svg: &mut String, what: &Draw, index: usize, place: impl Fn([f64; 2]) -> [f64; 2]) {
    match what {
        Draw::Line(points, look) => {
            let places: Vec<[f64; 2]> = points.iter().map(|point| place(*point)).collect();
            polyline(svg, &places, look);
            if let Some(shape) = look.marker {
                // Staggered, so that curves that lie on one another can be told apart.
                let every = places.len().div_ceil(MARKERS).max(1);
                let first = (index * every / 4) % every;
                for at in places.iter().skip(first).step_by(every) {
                    marker(svg, *at, shape, look.grey);
                }
            }
        }
        Draw::Dots(points, shape) => {
            for point in points {
                marker(svg, place(*point), *shape, "#000000");
            }
        }
        Draw::Bars(bars, grey) => {
            for [left, right, height] in bars {
                let [[x1, y1], [x2, y2]] = [place([*left, *height]), place([*right, 0.0])];
                if y2 - y1 > 0.0 {
                    bar(svg, [x1, y1], [x2 - x1, y2 - y1], grey);
                }
            }
        }
        Draw::Bands(runs, grey) => {
            let runs = runs.iter().map(|run| {
                let lows = run.iter().map(|[at, low, _]| place([*at, *low]));
                let highs = run.iter().rev().map(|[at, _, high]| place([*at, *high]));
                lows.chain(highs).collect()
            });
            bands(svg, runs, grey);
        }
    }
}

fn polyline(svg: &mut String, places: &[[f64; 2]], look: &LineStyle) {
    let mut points = String::new();
    for [x, y] in places {
        let _ = write!(points, "{x:.2},{y:.2} ");
    }
    let dash = if look.dash.is_empty() {
        String::new()
    } else {
        format!(" stroke-dasharray=\"{}\"", look.dash)
    };
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}/>",
        points.trim_end(),
        look.grey,
        look.width
    );
}

/// Areas with a stroke, so that one of no height is seen.
fn bands(svg: &mut String, outlines: impl Iterator<Item = Vec<[f64; 2]>>, grey: &str) {
    let mut path = String::new();
    for outline in outlines {
        for (index, [x, y]) in outline.iter().enumerate() {
            let word = if index == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{word}{x:.1} {y:.1}");
        }
        path.push('Z');
    }
    let _ = writeln!(
        svg,
        "<path d=\"{path}\" fill=\"{grey}\" stroke=\"{grey}\" stroke-width=\"1\" stroke-linejoin=\"round\"/>"
    );
}

fn bar(svg: &mut String, [x, y]: [f64; 2], [width, height]: [f64; 2], grey: &str) {
    let _ = writeln!(
        svg,
        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"{grey}\" stroke=\"#000000\" stroke-width=\"0.7\"/>"
    );
}

fn marker(svg: &mut String, [x, y]: [f64; 2], shape: Marker, grey: &str) {
    let path = match shape {
        Marker::Circle => {
            let _ = writeln!(
                svg,
                "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3.2\" fill=\"#ffffff\" stroke=\"{grey}\" stroke-width=\"1.1\"/>"
            );
            return;
        }
        Marker::Square => "m-2.8 -2.8h5.6v5.6h-5.6z",
        Marker::Triangle => "m0 -3.8l3.6 6.4h-7.2z",
        Marker::Diamond => "m0 -4l3.6 4l-3.6 4l-3.6 -4z",
        Marker::Cross => "m-3 -3l6 6m-6 0l6 -6",
    };
    let _ = writeln!(
        svg,
        "<path d=\"M{x:.2} {y:.2}{path}\" fill=\"#ffffff\" stroke=\"{grey}\" stroke-width=\"1.1\"/>"
    );
}

/// What stands before a name in the legend.
fn sample(svg: &mut String, what: &Draw, left: f64, middle: f64) {
    match what {
        Draw::Line(_, look) => {
            polyline(svg, &[[left, middle], [left + 38.0, middle]], look);
            if let Some(shape) = look.marker {
                marker(svg, [left + 19.0, middle], shape, look.grey);
            }
        }
        Draw::Dots(_, shape) => marker(svg, [left + 19.0, middle], *shape, "#000000"),
        Draw::Bars(_, grey) => bar(svg, [left + 8.0, middle - 7.0], [22.0, 14.0], grey),
        Draw::Bands(_, grey) => {
            let [top, foot, right] = [middle - 3.0, middle + 3.0, left + 38.0];
            let outline = vec![[left, top], [right, top], [right, foot], [left, foot]];
            bands(svg, std::iter::once(outline), grey);
        }
    }
}
