//! The picture of a recorded log: errors as measured and as predicted, and what is left between them, over time; after
//! figs. 9 to 12 of Zhang, Chen 2025.

use post_machine::axis_words;
use post_machine::description::Machine;

use super::envelope::Envelope;
use super::pictures::{File, MICRO, file_name};
use crate::files::chart::{Draw, LOOKS, Panel, Panels, Series};
use crate::job::predict::Prediction;
use crate::job::predict::measured::{MeasuredFound, MeasuredPoint};

/// Its name in the folder.
pub const NAME: &str = "measured.svg";

/// Of each quantity: measured, predicted, and predicted minus measured.
const CURVES: usize = 3;

/// What is kept of a log for its picture.
pub struct MeasuredRoom {
    axes: Vec<Drawn>,
    /// Time from row to row, s.
    period: f64,
    /// Channels of the axes, then of the contour error.
    errors: Envelope,
}

/// An axis that may be in a log.
struct Drawn {
    place: usize,
    name: String,
    rotary: bool,
}

impl MeasuredRoom {
    /// For rows every `period` seconds.
    pub fn new(machine: &Machine, period: f64) -> Self {
        let axes = axis_words::order(machine).into_iter().map(|place| Drawn {
            place,
            name: machine.axes[place].name.clone(),
            rotary: machine.axes[place].joint.rotary,
        });
        let axes: Vec<Drawn> = axes.collect();
        Self {
            period,
            errors: Envelope::new(CURVES * (axes.len() + 1), period),
            axes,
        }
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
    pub fn file(&self, found: &Prediction, laid: &MeasuredFound) -> Option<File> {
        let mut panels = Vec::new();
        for (place, axis) in self.axes.iter().enumerate() {
            let (unit, scale) = match axis.rotary {
                true => ("0.001°", 1f64.to_degrees() * MICRO),
                false => ("µm", MICRO),
            };
            panels.extend(self.panel(place, &format!("{}, {unit}", axis.name), scale, 130.0));
        }
        panels.extend(self.panel(self.axes.len(), "contour error, µm", MICRO, 190.0));
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
                crate::terminal::number(1e3 * self.period, 3)
            ),
            x: "time from the beginning of the program, s".to_owned(),
            logarithmic: false,
            panels,
        };
        Some((NAME, panels.svg()))
    }

    /// Three curves over one another; none where the quantity is not known.
    fn panel(&self, quantity: usize, y: &str, unit: f64, height: f64) -> Option<Panel> {
        let runs = |curve: usize| self.errors.runs(CURVES * quantity + curve, unit);
        let measured = runs(0);
        if measured.is_empty() {
            return None;
        }
        // In a narrow share of the time least and largest are close: one line in the middle of them.
        let predicted: Vec<Vec<[f64; 2]>> = runs(1)
            .into_iter()
            .map(|run| {
                run.iter()
                    .map(|[at, low, high]| [*at, (low + high) / 2.0])
                    .collect()
            })
            .collect();
        let mut series = vec![
            Series {
                name: "measured, from least to largest".to_owned(),
                draw: Draw::Bands(measured, "#a8a8a8"),
            },
            Series {
                name: "predicted minus measured".to_owned(),
                draw: Draw::Bands(runs(2), "#5a5a5a"),
            },
        ];
        series.extend(
            predicted
                .into_iter()
                .map(|run| Series::line("predicted", run, LOOKS[0])),
        );
        Some(Panel {
            y: y.to_owned(),
            logarithmic: false,
            height,
            series,
        })
    }
}
