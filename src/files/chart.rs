//! A chart: two axes with units, curves that are told apart by dash, marker and grey, and bars.
//!
//! Nothing is told by colour, so that it can be printed in grey.

use std::fmt::Write as _;

use super::scale::Scale;
use super::svg::{self, label, upright};

const WIDTH: f64 = 760.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 28.0;
const TOP: f64 = 64.0;
/// Of the plot itself, px.
const HEIGHT: f64 = 330.0;
/// Of a row of the legend, px.
const ROW: f64 = 20.0;
/// Markers on one curve.
const MARKERS: usize = 9;

/// A chart.
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// Second line of the title.
    pub note: String,
    /// What goes across, with its unit.
    pub x: String,
    /// What goes up, with its unit.
    pub y: String,
    /// What goes up does so by its logarithm.
    pub logarithmic: bool,
    /// What is drawn, the first at the back.
    pub series: Vec<Series>,
}

/// One thing that is drawn.
pub struct Series {
    /// Its name in the legend; empty if it has none there.
    pub name: String,
    /// How it is drawn.
    pub draw: Draw,
}

/// How values are drawn.
pub enum Draw {
    /// A line through points, with some markers on it.
    Line(Vec<[f64; 2]>, Look),
    /// A marker at every point.
    Dots(Vec<[f64; 2]>, Marker),
    /// Bars from zero: left, right and height of each, and a grey.
    Bars(Vec<[f64; 3]>, &'static str),
}

/// How a line looks.
#[derive(Clone, Copy)]
pub struct Look {
    grey: &'static str,
    width: f64,
    dash: &'static str,
    marker: Option<Marker>,
}

/// What stands at a point.
#[derive(Clone, Copy)]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

const fn look(grey: &'static str, width: f64, dash: &'static str, marker: Option<Marker>) -> Look {
    Look {
        grey,
        width,
        dash,
        marker,
    }
}

/// Looks that can be told apart, the plainest first.
pub const LOOKS: [Look; 8] = [
    look("#000000", 1.8, "", None),
    look("#000000", 1.4, "9 4", Some(Marker::Circle)),
    look("#000000", 1.6, "2 3", Some(Marker::Square)),
    look("#8c8c8c", 2.4, "", Some(Marker::Triangle)),
    look("#4d4d4d", 1.4, "10 3 2 3", Some(Marker::Diamond)),
    look("#8c8c8c", 1.8, "6 3", Some(Marker::Cross)),
    look("#4d4d4d", 1.2, "", Some(Marker::Square)),
    look("#6b6b6b", 1.4, "3 2", Some(Marker::Circle)),
];

/// A limit.
pub const LIMIT: Look = look("#000000", 0.9, "14 4", None);

/// What something is compared with.
pub const GREY: Look = look("#8c8c8c", 2.4, "", None);

/// Its plain dashes.
pub const DASHED: Look = look("#000000", 1.4, "9 4", None);

impl Series {
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>, look: Look) -> Self {
        Self {
            name: name.into(),
            draw: Draw::Line(points, look),
        }
    }

    pub fn dots(name: impl Into<String>, points: Vec<[f64; 2]>, marker: Marker) -> Self {
        Self {
            name: name.into(),
            draw: Draw::Dots(points, marker),
        }
    }

    /// All corners that must be seen.
    fn corners(&self) -> Vec<[f64; 2]> {
        match &self.draw {
            Draw::Line(points, _) | Draw::Dots(points, _) => points.clone(),
            Draw::Bars(bars, _) => bars
                .iter()
                .flat_map(|[left, right, height]| [[*left, 0.0], [*right, *height]])
                .collect(),
        }
    }
}

impl Chart {
    /// How high the picture is, px.
    pub fn height(&self) -> f64 {
        let rows = self.named().len().div_ceil(self.columns());
        TOP + HEIGHT + 58.0 + ROW * rows as f64
    }

    /// What stands in the legend.
    fn named(&self) -> Vec<&Series> {
        let series = self.series.iter();
        series.filter(|series| !series.name.is_empty()).collect()
    }

    /// Columns of the legend.
    fn columns(&self) -> usize {
        let names = self
            .named()
            .into_iter()
            .map(|series| series.name.chars().count());
        columns(names.max().unwrap_or(0))
    }

    /// The picture.
    pub fn svg(&self) -> String {
        let corners: Vec<[f64; 2]> = self.series.iter().flat_map(Series::corners).collect();
        let x = Scale::new(corners.iter().map(|corner| corner[0]), 10.0, false);
        let ups = corners.iter().map(|corner| corner[1]);
        let y = if self.logarithmic {
            Scale::decades(ups)
        } else {
            Scale::new(ups, 8.0, true)
        };
        let named = self.named();
        let columns = self.columns();
        let mut svg = svg::open(WIDTH, self.height());
        label(&mut svg, [WIDTH / 2.0, 24.0], "middle", &self.title);
        label(&mut svg, [WIDTH / 2.0, 44.0], "middle", &self.note);
        axes(&mut svg, &x, &y);
        label(
            &mut svg,
            [LEFT + width() / 2.0, TOP + HEIGHT + 38.0],
            "middle",
            &self.x,
        );
        upright(&mut svg, [18.0, TOP + HEIGHT / 2.0], &self.y);
        let place = |[across, up]: [f64; 2]| {
            [
                LEFT + width() * x.share(across),
                TOP + HEIGHT * (1.0 - y.share(up)),
            ]
        };
        for (index, series) in self.series.iter().enumerate() {
            draw(&mut svg, &series.draw, index, place);
        }
        for (index, series) in named.iter().enumerate() {
            let column = width() / columns as f64;
            let left = LEFT + column * (index % columns) as f64;
            let middle = TOP + HEIGHT + 60.0 + ROW * (index / columns) as f64;
            sample(&mut svg, &series.draw, left, middle);
            label(&mut svg, [left + 46.0, middle + 4.5], "start", &series.name);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn width() -> f64 {
    WIDTH - LEFT - RIGHT
}

/// Columns of the legend for names of so many letters.
fn columns(longest: usize) -> usize {
    // A letter is about 7.2 px wide.
    let wide = 46.0 + 7.2 * longest as f64 + 12.0;
    ((width() / wide) as usize).clamp(1, 3)
}

fn axes(svg: &mut String, x: &Scale, y: &Scale) {
    let (right, bottom) = (LEFT + width(), TOP + HEIGHT);
    for (value, text) in y.ticks() {
        let up = bottom - HEIGHT * y.share(value);
        line(svg, [LEFT, up], [right, up], "#d0d0d0", 0.7);
        line(svg, [LEFT - 5.0, up], [LEFT, up], "#000000", 1.0);
        label(svg, [LEFT - 9.0, up + 4.5], "end", &text);
    }
    for (value, text) in x.ticks() {
        let across = LEFT + width() * x.share(value);
        line(
            svg,
            [across, bottom],
            [across, bottom + 5.0],
            "#000000",
            1.0,
        );
        label(svg, [across, bottom + 19.0], "middle", &text);
    }
    let _ = writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"#000000\" stroke-width=\"1\"/>",
        width()
    );
}

fn line(svg: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], grey: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{grey}\" stroke-width=\"{width}\"/>"
    );
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
    }
}

fn polyline(svg: &mut String, places: &[[f64; 2]], look: &Look) {
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
    }
}
