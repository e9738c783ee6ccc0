//! Several plots over one axis.

use super::Series;
use super::plot::{LEFT, PlotArea, ROW, TOP, WIDTH, columns_of, legend, titles, width};
use crate::files::scale::Scale;
use crate::files::svg::{self, label, upright};

/// From one plot to the one below, px.
const GAP: f64 = 16.0;

/// Plots below one another that share what goes across.
pub struct Panels {
    /// What they show.
    pub title: String,
    /// Second line of the title.
    pub note: String,
    /// What goes across, with its unit.
    pub x: String,
    /// It goes across by its logarithm.
    pub logarithmic: bool,
    /// The plots, the first at the top; a name of the legend counts for all of them.
    pub panels: Vec<Panel>,
}

/// One of them.
pub struct Panel {
    /// What goes up, with its unit.
    pub y: String,
    /// What goes up does so by its logarithm.
    pub logarithmic: bool,
    /// How high the plot is, px.
    pub height: f64,
    /// What is drawn, the first at the back.
    pub series: Vec<Series>,
}

impl Panels {
    /// The picture.
    pub fn svg(&self) -> String {
        let all = || self.panels.iter().flat_map(|panel| &panel.series);
        let corners: Vec<[f64; 2]> = all().flat_map(Series::corners).collect();
        let across = corners.iter().map(|corner| corner[0]);
        let x = match self.logarithmic {
            true => Scale::decades(across),
            false => Scale::new(across, 10.0, false),
        };
        let mut named: Vec<&Series> = Vec::new();
        for series in all() {
            let known = named.iter().any(|known| known.name == series.name);
            if !series.name.is_empty() && !known {
                named.push(series);
            }
        }
        let plots: f64 = self.panels.iter().map(|panel| panel.height + GAP).sum();
        let bottom = TOP + plots - GAP;
        let rows = named.len().div_ceil(columns_of(&named));
        let mut svg = svg::open(WIDTH, bottom + 58.0 + ROW * rows as f64);
        titles(&mut svg, &self.title, &self.note);
        let mut top = TOP;
        for (index, panel) in self.panels.iter().enumerate() {
            let last = index + 1 == self.panels.len();
            let corners: Vec<[f64; 2]> = panel.series.iter().flat_map(Series::corners).collect();
            let ups = corners.iter().map(|corner| corner[1]);
            let y = match panel.logarithmic {
                true => Scale::decades(ups),
                false => Scale::new(ups, (panel.height / 40.0).max(2.0), true),
            };
            let area = PlotArea { top, height: panel.height };
            area.plot(&mut svg, [&x, &y], &panel.series, last);
            upright(&mut svg, [18.0, top + panel.height / 2.0], &panel.y);
            top += panel.height + GAP;
        }
        let middle = LEFT + width() / 2.0;
        label(&mut svg, [middle, bottom + 38.0], "middle", &self.x);
        legend(&mut svg, &named, bottom);
        svg.push_str("</svg>\n");
        svg
    }
}
