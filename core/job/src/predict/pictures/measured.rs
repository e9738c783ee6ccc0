//! The picture of a recorded log: errors as measured and as predicted, and what is left between them, over time; after
//! figs. 9 to 12 of Zhang, Chen 2025.

use post_machine::axis_words;
use post_machine::description::Machine;

use super::{MICRO, PredictionFile, file_name};
use crate::files::chart::{DASHED, Draw, Envelope, GREY, LineStyle, Panel, Panels, Series};
use crate::predict::Prediction;
use crate::predict::measured::{MeasuredFound, MeasuredPoint};
use crate::text::number;

/// Its name in the folder.
pub const NAME: &str = "measured.svg";

/// Of each quantity: measured, predicted, and predicted minus measured.
const CURVES: usize = 3;

/// What is kept of a log for its picture.
pub struct MeasuredRoom {
    axes: Vec<LoggedAxis>,
    /// Time from row to row, s.
    period: f64,
    /// Channels of the axes, then of the contour error.
    errors: Envelope,
}

/// An axis that may be in a log.
struct LoggedAxis {
    place: usize,
    name: String,
    rotary: bool,
}

impl MeasuredRoom {
    /// For rows every `period` seconds.
    pub fn new(machine: &Machine, period: f64) -> Self {
        let axes = axis_words::order(machine).into_iter().map(|place| LoggedAxis {
            place,
            name: machine.axes[place].name.clone(),
            rotary: machine.axes[place].joint.rotary,
        });
        let axes: Vec<LoggedAxis> = axes.collect();
        Self { period, errors: Envelope::new(CURVES * (axes.len() + 1), period), axes }
    }

    /// Takes the next row of the log.
    pub fn take(&mut self, point: &MeasuredPoint) {
        let three = |[measured, predicted]: [f64; 2]| [measured, predicted, predicted - measured];
        let axes = self.axes.iter().map(|axis| point.following[axis.place]);
        let contour = match point.cuts {
            true => point.contour,
            false => [f64::NAN; 2],
        };
        let values = axes.chain([contour]).flat_map(three);
        // A log may begin before the program does.
        self.errors.take(point.time.max(0.0), values);
    }

    /// The picture; none where nothing is known both ways.
    pub fn file(&self, found: &Prediction, laid: &MeasuredFound) -> Option<PredictionFile> {
        let mut panels = Vec::new();
        for (place, axis) in self.axes.iter().enumerate() {
            let (unit, scale) = match axis.rotary {
                true => ("0.001°", 1f64.to_degrees() * MICRO),
                false => ("µm", MICRO),
            };
            panels.extend(self.panels(place, &axis.name, unit, scale));
        }
        panels.extend(self.panels(self.axes.len(), "contour", "µm", MICRO));
        if panels.is_empty() {
            return None;
        }
        let panels = Panels {
            title: "Measured and predicted: following errors of the axes, contour error in cuts"
                .to_owned(),
            note: format!(
                "{} on {}; log {}, a row every {} ms",
                file_name(&found.program),
                found.machine,
                file_name(&laid.log),
                number(1e3 * self.period, 3)
            ),
            x: "time from the beginning of the program, s".to_owned(),
            logarithmic: false,
            panels,
        };
        Some((NAME, panels.svg()))
    }

    /// Both over one another, and below them the difference in a measure of its own; none where they are not known.
    fn panels(&self, quantity: usize, name: &str, unit: &str, scale: f64) -> Vec<Panel> {
        let runs = |curve: usize| self.errors.runs(CURVES * quantity + curve, scale);
        let measured = runs(0);
        if measured.is_empty() {
            return Vec::new();
        }
        // In a narrow share of the time least and largest are close: one line in the middle of them.
        let middle = |run: Vec<[f64; 3]>| {
            let points = run.iter();
            points.map(|[at, low, high]| [*at, (low + high) / 2.0]).collect()
        };
        let bands = |name: &str, runs: Vec<Vec<[f64; 3]>>, grey: &'static str| Series {
            name: name.to_owned(),
            draw: Draw::Bands(runs, grey),
        };
        // The grey of what was measured is seen between the dashes of what is predicted.
        let lines = |curve: usize, name: &str, look: LineStyle| {
            let lines = runs(curve).into_iter().map(middle);
            let lines = lines.map(|line| Series::line(name, line, look));
            lines.collect::<Vec<Series>>()
        };
        let mut both = vec![bands("", measured, "#c4c4c4")];
        both.extend(lines(0, "measured", GREY));
        both.extend(lines(1, "predicted", DASHED));
        let difference = bands("predicted minus measured", runs(2), "#5a5a5a");
        let panel = |y: String, height: f64, series: Vec<Series>| Panel {
            y,
            logarithmic: false,
            height,
            series,
        };
        vec![
            panel(format!("{name}, {unit}"), 120.0, both),
            panel(format!("diff., {unit}"), 70.0, vec![difference]),
        ]
    }
}
