//! Logs as recorders write them.

use post_testkit::Rng;

use super::course::AXES;
use super::plant::{REST, Run};

/// How a log is recorded and written.
#[derive(Clone)]
pub struct Recorder {
    /// Time of the log at which the program begins, s.
    pub shift: f64,
    /// Time from row to row, s.
    pub period: f64,
    /// From when to when of the program, s.
    pub window: [f64; 2],
    /// Standard deviation of the actual positions' errors, mm or degrees.
    pub noise: f64,
    /// Rows lie beside even distances by up to so much, s.
    pub jitter: f64,
    /// Of 1000 rows so many are missing.
    pub missing: u64,
    pub seed: u64,
    /// Axes that it has.
    pub axes: Vec<usize>,
    /// It has the commanded positions.
    pub commanded: bool,
    /// What it counts more, mm or degrees, by axis.
    pub zeros: [f64; 4],
    /// Its units of a second, mm and degree.
    pub units: [f64; 3],
    pub separator: &'static str,
    pub decimal: &'static str,
    /// Lines before the rows.
    pub head: String,
    /// What stands behind each row.
    pub tail: &'static str,
}

impl Recorder {
    /// Every millisecond, all axes, names as this project has them.
    pub fn plain(seconds: f64) -> Self {
        Self {
            shift: 3.21,
            period: 1e-3,
            window: [-REST, seconds + REST - 0.01],
            noise: 0.0,
            jitter: 0.0,
            missing: 0,
            seed: 1,
            axes: vec![0, 1, 2, 3],
            commanded: true,
            zeros: [0.0; 4],
            units: [1.0; 3],
            separator: ",",
            decimal: ".",
            head: "time,X,Y,Z,C,X_act,Y_act,Z_act,C_act\n".to_owned(),
            tail: "",
        }
    }

    pub fn log(&self, run: &Run) -> String {
        let mut random = Rng::new(self.seed);
        let mut text = self.head.clone();
        let rows = ((self.window[1] - self.window[0]) / self.period) as u64;
        for row in 0..=rows {
            let late = random.range(-self.jitter, self.jitter);
            let time = self.window[0] + row as f64 * self.period + late;
            if random.range(0.0, 1000.0) < self.missing as f64 {
                continue;
            }
            let mut numbers = vec![format!("{:.7}", (time + self.shift) * self.units[0])];
            let [commanded, actual] = run.at(time);
            for (which, values) in [commanded, actual].into_iter().enumerate() {
                for axis in &self.axes {
                    let error = if which == 1 { self.noise * random.normal() } else { 0.0 };
                    let unit = self.units[if AXES[*axis] == "C" { 2 } else { 1 }];
                    let value = (values[*axis] + self.zeros[*axis] + error) * unit;
                    if which == 1 || self.commanded {
                        numbers.push(format!("{value:.8}"));
                    }
                }
            }
            let numbers: Vec<String> =
                numbers.iter().map(|number| number.replace('.', self.decimal)).collect();
            text += &numbers.join(self.separator);
            text += self.tail;
            text.push('\n');
        }
        text
    }
}
