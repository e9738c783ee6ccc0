//! A chart: two axes with units, curves that are told apart by dash, marker and grey, and bars.
//!
//! Nothing is told by colour, so that it can be printed in grey.

mod envelope;
mod panels;
mod plot;

use super::scale::Scale;
use super::svg::{self, label, upright};
pub use envelope::Envelope;
pub use panels::{Panel, Panels};
use plot::{HEIGHT, LEFT, PlotArea, ROW, TOP, WIDTH, columns_of, legend, titles, width};

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
    Line(Vec<[f64; 2]>, LineStyle),
    /// A marker at every point.
    Dots(Vec<[f64; 2]>, Marker),
    /// Bars from zero: left, right and height of each, and a grey.
    Bars(Vec<[f64; 3]>, &'static str),
    /// Everything between two curves: runs of place, low and high, and a grey.
    Bands(Vec<Vec<[f64; 3]>>, &'static str),
}

/// How a line looks.
#[derive(Clone, Copy)]
pub struct LineStyle {
    grey: &'static str,
    width: f64,
    dash: &'static str,
    marker: Option<Marker>,
}

/// What stands at a point.
#[expect(missing_docs, reason = "a shape is what it is called")]
#[derive(Clone, Copy)]
pub enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

const fn look(
    grey: &'static str,
    width: f64,
    dash: &'static str,
    marker: Option<Marker>,
) -> LineStyle {
    LineStyle { grey, width, dash, marker }
}

/// Looks that can be told apart, the plainest first.
pub const LOOKS: [LineStyle; 8] = [
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
pub const LIMIT: LineStyle = look("#000000", 0.9, "14 4", None);

/// What something is compared with.
pub const GREY: LineStyle = look("#8c8c8c", 2.4, "", None);

/// Dots that no other line has.
pub const DOTTED: LineStyle = look("#000000", 1.6, "2 3", None);

/// Its plain dashes.
pub const DASHED: LineStyle = look("#000000", 1.4, "9 4", None);

impl Series {
    /// Points joined by a line.
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>, look: LineStyle) -> Self {
        Self { name: name.into(), draw: Draw::Line(points, look) }
    }

    /// Points by themselves.
    pub fn dots(name: impl Into<String>, points: Vec<[f64; 2]>, marker: Marker) -> Self {
        Self { name: name.into(), draw: Draw::Dots(points, marker) }
    }

    /// All corners that must be seen.
    fn corners(&self) -> Vec<[f64; 2]> {
        match &self.draw {
            Draw::Line(points, _) | Draw::Dots(points, _) => points.clone(),
            Draw::Bars(bars, _) => bars
                .iter()
                .flat_map(|[left, right, height]| [[*left, 0.0], [*right, *height]])
                .collect(),
            Draw::Bands(runs, _) => runs
                .iter()
                .flatten()
                .flat_map(|[at, low, high]| [[*at, *low], [*at, *high]])
                .collect(),
        }
    }
}

impl Chart {
    /// How high the picture is, px.
    pub fn height(&self) -> f64 {
        let named = self.named();
        let rows = named.len().div_ceil(columns_of(&named));
        TOP + HEIGHT + 58.0 + ROW * rows as f64
    }

    /// What stands in the legend.
    fn named(&self) -> Vec<&Series> {
        let series = self.series.iter();
        series.filter(|series| !series.name.is_empty()).collect()
    }

    /// The picture.
    pub fn svg(&self) -> String {
        let corners: Vec<[f64; 2]> = self.series.iter().flat_map(Series::corners).collect();
        let x = Scale::new(corners.iter().map(|corner| corner[0]), 10.0, false);
        let ups = corners.iter().map(|corner| corner[1]);
        let y = if self.logarithmic { Scale::decades(ups) } else { Scale::new(ups, 8.0, true) };
        let mut svg = svg::open(WIDTH, self.height());
        titles(&mut svg, &self.title, &self.note);
        let area = PlotArea { top: TOP, height: HEIGHT };
        area.plot(&mut svg, [&x, &y], &self.series, true);
        let middle = LEFT + width() / 2.0;
        label(&mut svg, [middle, TOP + HEIGHT + 38.0], "middle", &self.x);
        upright(&mut svg, [18.0, TOP + HEIGHT / 2.0], &self.y);
        legend(&mut svg, &self.named(), TOP + HEIGHT);
        svg.push_str("</svg>\n");
        svg
    }
}
