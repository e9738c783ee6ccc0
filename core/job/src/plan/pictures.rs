//! The pictures of a planned feed, after figs. 3 and 4 of the feedrate paper: feed, velocity, acceleration and jerk of the
//! axes, chord error and contour error along the path, limits drawn in. They are fed point by point and kept in rooms
//! that do not grow with the path.

use crate::files::chart::{Draw, Envelope, LIMIT, Panel, Panels, Series};

/// The files that there can be.
pub const NAMES: [&str; 6] = [
    "feed.svg",
    "axis-velocity.svg",
    "axis-acceleration.svg",
    "axis-jerk.svg",
    "chord-error.svg",
    "contour-error.svg",
];

/// A share of the way at first, mm.
const WIDTH: f64 = 1e-3;

/// Velocity, acceleration and jerk.
const ORDERS: usize = 3;

/// An axis that is drawn.
#[derive(Clone, Debug)]
pub struct PlannedAxis {
    /// `X`, as its words are called.
    pub name: String,
    /// Values are rad, not mm.
    pub rotary: bool,
    /// Velocity, acceleration and jerk, mm or rad and s; infinite where there is no limit.
    pub limits: [f64; ORDERS],
}

/// Limits along the path; infinite where there is none.
#[derive(Clone, Copy, Debug)]
pub struct DrawnLimits {
    /// mm/s.
    pub feed: f64,
    /// mm.
    pub chord_error: f64,
    /// mm.
    pub contour_error: f64,
}

/// A point of a planned path. What is not known of it is NaN.
#[derive(Clone, Copy, Debug)]
pub struct DrawnPoint<'a> {
    /// Of the tip from the beginning, mm.
    pub way: f64,
    /// mm/s.
    pub feed: f64,
    /// By axis, mm/s or rad/s.
    pub velocity: &'a [f64],
    /// By axis, mm/s² or rad/s².
    pub acceleration: &'a [f64],
    /// By axis, mm/s³ or rad/s³.
    pub jerk: &'a [f64],
    /// mm.
    pub chord_error: f64,
    /// mm.
    pub contour_error: f64,
}

/// What is kept of a path for its pictures.
pub struct PlanRooms {
    axes: Vec<PlannedAxis>,
    limits: DrawnLimits,
    /// Feed, chord error, contour error.
    along: Envelope,
    /// Of each axis velocity, acceleration and jerk.
    motion: Envelope,
    way: f64,
}

impl PlanRooms {
    /// No point yet.
    pub fn new(axes: Vec<PlannedAxis>, limits: DrawnLimits) -> Self {
        Self {
            along: Envelope::new(3, WIDTH),
            motion: Envelope::new(ORDERS * axes.len().max(1), WIDTH),
            axes,
            limits,
            way: 0.0,
        }
    }

    /// What is told apart of the way, mm: points that are farther apart leave gaps.
    pub fn width(&self) -> f64 {
        self.along.width()
    }

    /// Takes the next point.
    pub fn take(&mut self, point: &DrawnPoint<'_>) {
        let along = [point.feed, point.chord_error, point.contour_error];
        self.along.take(point.way, along.into_iter());
        let orders = [point.velocity, point.acceleration, point.jerk];
        let values = orders.into_iter().flat_map(|values| values.iter().copied());
        self.motion.take(point.way, values);
        self.way = self.way.max(point.way);
    }

    /// All pictures that there is something to show in; `note` says of what.
    pub fn files(&self, note: &str) -> Vec<(&'static str, String)> {
        let mut files = vec![("feed.svg", self.feed(note).svg())];
        let titles = [
            ("axis-velocity.svg", "Velocity of the axes", ["mm/s", "°/s"]),
            ("axis-acceleration.svg", "Acceleration of the axes", ["mm/s²", "°/s²"]),
            ("axis-jerk.svg", "Jerk of the axes", ["mm/s³", "°/s³"]),
        ];
        for (order, (name, title, units)) in titles.into_iter().enumerate() {
            files.push((name, self.axes(order, title, units, note).svg()));
        }
        let errors = [
            (
                1,
                "chord-error.svg",
                "Chord error of one interpolation period",
                self.limits.chord_error,
            ),
            (
                2,
                "contour-error.svg",
                "Contour error by the formula of the steady state",
                self.limits.contour_error,
            ),
        ];
        for (channel, name, title, limit) in errors {
            let runs = self.along.runs(channel, 1e3);
            if runs.is_empty() {
                continue;
            }
            let panel = self.panel("µm".to_owned(), runs, &[1e3 * limit], 330.0);
            files.push((name, panels(title, note, vec![panel]).svg()));
        }
        files
    }

    fn feed(&self, note: &str) -> Panels {
        let runs = self.along.runs(0, 60.0);
        let panel = self.panel("feed, mm/min".to_owned(), runs, &[60.0 * self.limits.feed], 330.0);
        panels("Planned feed of the tip against the part", note, vec![panel])
    }

    fn axes(&self, order: usize, title: &str, units: [&str; 2], note: &str) -> Panels {
        let each = self.axes.iter().enumerate().map(|(place, axis)| {
            let (unit, scale) = match axis.rotary {
                true => (units[1], 1f64.to_degrees()),
                false => (units[0], 1.0),
            };
            let runs = self.motion.runs(order * self.axes.len() + place, scale);
            let limit = scale * axis.limits[order];
            self.panel(format!("{}, {unit}", axis.name), runs, &[limit, -limit], 150.0)
        });
        panels(title, note, each.collect())
    }

    /// Values between their least and largest on each share of the way, and their limits.
    fn panel(&self, y: String, runs: Vec<Vec<[f64; 3]>>, limits: &[f64], height: f64) -> Panel {
        let mut series = vec![Series {
            name: "lowest to highest at each place".to_owned(),
            draw: Draw::Bands(runs, "#5a5a5a"),
        }];
        for limit in limits.iter().filter(|limit| limit.is_finite()) {
            let line = vec![[0.0, *limit], [self.way.max(1e-6), *limit]];
            series.push(Series::line("limit", line, LIMIT));
        }
        Panel { y, logarithmic: false, height, series }
    }
}

fn panels(title: &str, note: &str, panels: Vec<Panel>) -> Panels {
    Panels {
        title: title.to_owned(),
        note: note.to_owned(),
        x: "way of the tip along the path, mm".to_owned(),
        logarithmic: false,
        panels,
    }
}
