//! The pictures of a prediction: what is kept for them while it runs, and the charts. The figures that they follow are
//! those of Zhang, Chen 2025: axis errors (figs. 9 to 11), feed (fig. 8), contour error (fig. 12).

mod measured;
mod path;
mod spectrum;
mod trail;

use post_machine::axis_words;
use post_machine::description::Machine;

use super::{Prediction, Sample};
use crate::files::chart::{DASHED, DOTTED, Draw, Envelope, LOOKS, Panel, Panels, Series};
pub use measured::MeasuredRoom;
use spectrum::Spectrum;
use trail::Trail;

/// The files that there can be.
pub const NAMES: [&str; 7] = [
    "axis-errors.svg",
    "feed.svg",
    "contour.svg",
    "contour-vectors.svg",
    "path.svg",
    "spectrum.svg",
    measured::NAME,
];

/// Micrometres of a millimetre, thousandths of a degree of a degree.
pub const MICRO: f64 = 1e3;

/// The lowest frequency of the spectrum, Hz: what is below it is the path.
const LOWEST: f64 = 1.0;

/// A file of a prediction: its name and its text.
pub type PredictionFile = (&'static str, String);

/// What is kept of the set-points for the pictures.
pub struct PredictRooms {
    axes: Vec<ServoAxis>,
    period: f64,
    /// Errors of the axes over time: a channel each in cuts, and one each at rapid.
    lags: Envelope,
    /// Feed in cuts over time: that of the tip, that of the program.
    feeds: Envelope,
    /// Along the path: the tip's error, the tool axis' error.
    contour: Envelope,
    trail: Trail,
    spectra: Vec<Spectrum>,
}

/// An axis whose servo is described.
struct ServoAxis {
    /// Its place in the chain.
    place: usize,
    name: String,
    rotary: bool,
}

impl ServoAxis {
    /// From the core's unit to that of the picture.
    fn unit(&self) -> f64 {
        match self.rotary {
            true => 1f64.to_degrees() * MICRO,
            false => MICRO,
        }
    }

    fn label(&self) -> String {
        let unit = if self.rotary { "0.001°" } else { "µm" };
        format!("{}, {unit}", self.name)
    }
}

impl PredictRooms {
    /// Of nothing yet; set-points come every `period` seconds.
    pub fn new(machine: &Machine, period: f64) -> Self {
        let axes =
            axis_words::order(machine).into_iter().map(|place| (place, &machine.axes[place]));
        let axes: Vec<ServoAxis> = axes
            .filter(|(_, axis)| axis.servo.is_some())
            .map(|(place, axis)| ServoAxis {
                place,
                name: axis.name.clone(),
                rotary: axis.joint.rotary,
            })
            .collect();
        Self {
            period,
            lags: Envelope::new(2 * axes.len().max(1), period),
            feeds: Envelope::new(2, period),
            contour: Envelope::new(2, 1e-3),
            trail: Trail::new(),
            spectra: axes.iter().map(|_| Spectrum::new(period)).collect(),
            axes,
        }
    }

    /// Takes the next set-point.
    pub fn take(&mut self, sample: &Sample) {
        let lag = |axis: &ServoAxis| {
            let point = &sample.point;
            point.commanded_joints[axis.place] - point.actual_joints[axis.place]
        };
        let lags = [sample.at.cuts, !sample.at.cuts].into_iter().flat_map(|now| {
            let axes = self.axes.iter();
            axes.map(move |axis| if now { lag(axis) } else { f64::NAN })
        });
        self.lags.take(sample.point.time, lags);
        for (axis, spectrum) in self.axes.iter().zip(&mut self.spectra) {
            match sample.at.cuts {
                true => spectrum.take(lag(axis)),
                false => spectrum.pause(),
            }
        }
        let feeds = match sample.feed > 0.0 {
            true => [sample.feed, sample.programmed],
            false => [f64::NAN; 2],
        };
        self.feeds.take(sample.point.time, feeds.into_iter());
        self.trail.take(sample);
        if sample.counts() {
            let errors = [sample.size(), sample.axis()];
            self.contour.take(self.trail.way, errors.into_iter());
        }
    }

    /// All pictures that there is something to show in.
    pub fn files(&self, found: &Prediction) -> Vec<PredictionFile> {
        let note = format!(
            "{} on {}, set-points every {} ms",
            file_name(&found.program),
            found.machine,
            1e3 * found.period_s
        );
        let cuts = self.trail.cuts();
        let mut files = vec![("feed.svg", self.feed(&note).svg())];
        if !self.axes.is_empty() {
            files.push(("axis-errors.svg", self.axis_errors(&note).svg()));
        }
        if found.contour.tip_mm.largest > 0.0 {
            files.push(("contour.svg", self.along(found, &note).svg()));
            let vectors = path::vectors(found, &note, &cuts);
            files.push(("contour-vectors.svg", vectors));
            files.push(("path.svg", path::path(found, &note, &cuts)));
        }
        if let Some(spectrum) = self.spectrum(&note) {
            files.push(("spectrum.svg", spectrum.svg()));
        }
        files
    }

    /// Where each axis is commanded minus where it is, over time.
    fn axis_errors(&self, note: &str) -> Panels {
        let panels = self.axes.iter().enumerate().map(|(channel, axis)| {
            let cuts = self.lags.runs(channel, axis.unit());
            let mut rapids = self.lags.runs(self.axes.len() + channel, axis.unit());
            let largest = cuts
                .iter()
                .flatten()
                .fold(0.0, |largest: f64, [_, low, high]| largest.max(-low).max(*high));
            if largest > 0.0 {
                // What the axis lags behind at rapid would leave no room for what counts.
                for [_, low, high] in rapids.iter_mut().flatten() {
                    [*low, *high] = [*low, *high].map(|lag| lag.clamp(-largest, largest));
                }
            }
            Panel {
                y: axis.label(),
                logarithmic: false,
                height: 120.0,
                series: vec![
                    bands("at rapid, cut off where it is larger than in cuts", rapids, "#b0b0b0"),
                    bands("in cuts", cuts, "#000000"),
                ],
            }
        });
        Panels {
            title: "Following error of the axes: commanded minus actual position".to_owned(),
            note: note.to_owned(),
            x: "time, s".to_owned(),
            logarithmic: false,
            panels: panels.collect(),
        }
    }

    /// How fast the tip goes in cuts, and how fast it is asked to.
    fn feed(&self, note: &str) -> Panels {
        let series = vec![
            bands("true, lowest to highest at each time", self.feeds.runs(0, 1.0), "#8c8c8c"),
            bands("programmed", self.feeds.runs(1, 1.0), "#000000"),
        ];
        Panels {
            title: "Feed of the tip against the part in cuts".to_owned(),
            note: note.to_owned(),
            x: "time, s".to_owned(),
            logarithmic: false,
            panels: vec![Panel {
                y: "feed, mm/min".to_owned(),
                logarithmic: false,
                height: 330.0,
                series,
            }],
        }
    }

    /// The contour error along the path.
    fn along(&self, found: &Prediction, note: &str) -> Panels {
        let panel = |y: &str, series: Vec<Series>| Panel {
            y: y.to_owned(),
            logarithmic: false,
            height: 240.0,
            series,
        };
        let most = |level: f64| {
            let ends = [0.0, self.trail.way.max(1e-6)];
            vec![[ends[0], level * MICRO], [ends[1], level * MICRO]]
        };
        let tip = &found.contour.tip_mm;
        let mut panels = vec![panel(
            "tip, µm",
            vec![
                bands("lowest to highest at each place", self.contour.runs(0, MICRO), "#6b6b6b"),
                Series::line("95 % of the set-points stay below", most(tip.p95), DASHED),
                Series::line("root of the mean square", most(tip.rms), DOTTED),
            ],
        )];
        if found.contour.axis_deg.largest > 0.0 {
            let degrees = 1f64.to_degrees() * MICRO;
            panels.push(panel(
                "tool axis, 0.001°",
                vec![bands("", self.contour.runs(1, degrees), "#6b6b6b")],
            ));
        }
        Panels {
            title: match &found.against {
                Some(file) => format!("Contour error along the path of {}", file_name(file)),
                None => "Contour error along the commanded path".to_owned(),
            },
            note: note.to_owned(),
            x: "way of the tip in cuts, mm".to_owned(),
            logarithmic: false,
            panels,
        }
    }

    /// Which frequencies the errors of the axes have.
    fn spectrum(&self, note: &str) -> Option<Panels> {
        let panels = self.axes.iter().zip(&self.spectra).map(|(axis, spectrum)| {
            let mut amplitudes = spectrum.amplitudes(self.period, axis.unit());
            amplitudes.retain(|[frequency, _]| *frequency >= LOWEST);
            (axis, amplitudes)
        });
        let panels: Vec<Panel> = panels
            .filter(|(_, amplitudes)| amplitudes.iter().any(|[_, size]| *size > 0.0))
            .map(|(axis, amplitudes)| Panel {
                y: axis.label(),
                logarithmic: true,
                height: 130.0,
                series: vec![Series::line("", amplitudes, LOOKS[0])],
            })
            .collect();
        if panels.is_empty() {
            return None;
        }
        Some(Panels {
            title: "Spectrum of the axis errors in cuts: amplitude by frequency".to_owned(),
            note: note.to_owned(),
            x: "frequency, Hz".to_owned(),
            logarithmic: true,
            panels,
        })
    }
}

/// A path without its folder.
pub fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

fn bands(name: &str, runs: Vec<Vec<[f64; 3]>>, grey: &'static str) -> Series {
    Series { name: name.to_owned(), draw: Draw::Bands(runs, grey) }
}
