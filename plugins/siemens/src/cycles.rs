//! Drilling cycles: modal by `MCALL`, with planes that are absolute.

use post_plugin::{Cycle, Drilling, Setup, SpindleSense, Units};

use crate::text::{call, trimmed};

/// The spindle as it turns: revolutions a minute, and its sense.
pub(crate) type SpindleTurning = (f64, SpindleSense);

/// What the options say of cycles.
pub(crate) struct CycleCalls {
    floating: bool,
    /// How far fine boring lifts off in X and Y, and where the spindle stops, degrees.
    lift: [f64; 3],
    /// Pitches are those of metric programs: their unit in others is not settled.
    taps: bool,
}

impl CycleCalls {
    pub(crate) fn new(setup: &Setup<'_>) -> Self {
        CycleCalls {
            floating: setup.text("tapping") == "floating",
            lift: ["bore_lift_x", "bore_lift_y", "bore_angle"].map(|key| setup.number(key)),
            taps: setup.units == Units::Millimetre,
        }
    }

    pub(crate) fn taps(&self) -> bool {
        self.taps
    }

    /// Off the wall without a way would scratch it.
    pub(crate) fn fine(&self) -> bool {
        self.lift[..2] != [0.0; 2]
    }

    /// The call for a hole whose top is at `top`, as CYCLE81 to CYCLE840 of the manuals of 2008 and 4.92 have it.
    pub(crate) fn call(
        &self,
        drilling: &Drilling,
        top: f64,
        spindle: Option<SpindleTurning>,
    ) -> Result<String, String> {
        // Which way is down is told by the depth against the surface.
        let (drilling, raised) = drilling.below_its_point();
        let top = top + raised;
        let Drilling { cycle, feed, dwell, .. } = drilling;
        let planes = [
            // Never below where the feed begins.
            top + drilling.retract.max(drilling.clearance),
            top,
            drilling.clearance,
            top - drilling.depth,
        ];
        // After the depth comes the same depth relative to the plane: given twice it would be left to a parameter.
        let mut arguments: Vec<String> = planes.into_iter().map(trimmed).collect();
        arguments.push(String::new());
        let mut more = |values: &[f64]| arguments.extend(values.iter().copied().map(trimmed));
        let name = match cycle {
            Cycle::Drill if dwell == 0.0 => {
                arguments.truncate(4);
                "CYCLE81"
            }
            Cycle::Drill => {
                more(&[dwell]);
                "CYCLE82"
            }
            Cycle::Deep | Cycle::BreakChip => {
                let out = f64::from(u8::from(cycle == Cycle::Deep));
                arguments.push(String::new());
                // First depth, no degression, dwells below and above, the whole feed, out of the hole or not.
                let steps = [drilling.step, 0.0, dwell, 0.0, 1.0, out];
                arguments.extend(steps.map(trimmed));
                "CYCLE83"
            }
            Cycle::Ream => {
                more(&[dwell, feed.value(), feed.value()]);
                "CYCLE85"
            }
            Cycle::Bore | Cycle::BoreFine => {
                let (_, sense) = turning(spindle)?;
                let [x, y, angle] = match cycle {
                    Cycle::BoreFine => self.lift,
                    _ => [0.0, 0.0, self.lift[2]],
                };
                more(&[dwell, m_code(sense), x, y, 0.0, angle]);
                "CYCLE86"
            }
            Cycle::Tap | Cycle::TapLeft => {
                let (rpm, sense) = turning(spindle)?;
                let pitch = drilling.thread(Some(rpm));
                let pitch = pitch.ok_or_else(|| format!("no thread has a feed of {feed}"))?;
                let pitch = if cycle == Cycle::Tap { pitch } else { -pitch };
                if self.floating {
                    // Out by itself, with an encoder, no size of a thread but its pitch.
                    more(&[dwell, 0.0, m_code(sense), 0.0]);
                    arguments.extend([String::new(), trimmed(pitch)]);
                    "CYCLE840"
                } else {
                    more(&[dwell, m_code(sense)]);
                    arguments.extend([String::new(), trimmed(pitch)]);
                    arguments.extend([0.0, rpm, rpm].map(trimmed));
                    "CYCLE84"
                }
            }
            Cycle::BoreBack => return Err("this control has no cycle from below".to_owned()),
        };
        Ok(format!("MCALL {}", call(name, &arguments)))
    }
}

/// SDIR and SDAC: 3 for M3, 4 for M4.
fn m_code(sense: SpindleSense) -> f64 {
    match sense {
        SpindleSense::Clockwise => 3.0,
        SpindleSense::CounterClockwise => 4.0,
    }
}

fn turning(spindle: Option<SpindleTurning>) -> Result<SpindleTurning, String> {
    spindle.ok_or_else(|| {
        "this cycle is told the spindle's speed and sense, and no spindle turns: switch it on before the cycle"
            .to_owned()
    })
}
