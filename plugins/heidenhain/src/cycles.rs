//! Drilling cycles of the 200 series: a definition of numbered parameters, called at each point.

use post_plugin::{Cycle, Drilling, NumberStyle, Setup, Units};

/// What the options say of cycles.
pub(crate) struct CycleParameters {
    german: bool,
    /// Parameters that came with the software 34059x-04 of the TNC 640.
    newer: bool,
    floating: bool,
    /// Way off the wall: 1 X-, 2 Y-, 3 X+, 4 Y+; 0: none.
    lift: i64,
    /// Where the spindle stops, degrees.
    angle: f64,
    /// How far the drill is drawn back to break the chip.
    chip: f64,
    /// What feeds count in the parameters: tenths of an inch a minute in an inch program, as every F there.
    feeds: f64,
}

/// Out at rapid: the largest feed that the parameter takes.
const RAPID: f64 = 99_999.0;

impl CycleParameters {
    pub(crate) fn new(setup: &Setup<'_>) -> Self {
        CycleParameters {
            german: setup.text("language") == "German",
            newer: setup.text("control") != "iTNC530",
            floating: setup.text("tapping") == "floating",
            lift: setup.integer("bore_direction"),
            angle: setup.number("bore_angle"),
            chip: match setup.units {
                Units::Millimetre => setup.number("chip_break"),
                Units::Inch => setup.number("chip_break") / 25.4,
            },
            feeds: match setup.units {
                Units::Millimetre => 1.0,
                Units::Inch => 10.0,
            },
        }
    }

    pub(crate) fn fine(&self) -> bool {
        self.lift != 0
    }

    /// The definition for a hole whose top is at `top`: its first line, and one for each parameter.
    pub(crate) fn definition(
        &self,
        drilling: &Drilling,
        top: f64,
        rpm: Option<f64>,
    ) -> Result<String, String> {
        // Of the depth 0 the control would leave the hole out, and of one above the surface cut upwards.
        let (drilling, raised) = drilling.below_its_point();
        let top = top + raised;
        let Drilling { dwell, clearance, .. } = drilling;
        let down = || {
            let feed = drilling.feed_per_minute(rpm).ok_or(NO_SPEED)?;
            Ok::<f64, &str>(feed * self.feeds)
        };
        let cycle = drilling.cycle;
        let depth = if matches!(cycle, Cycle::Tap | Cycle::TapLeft) {
            (201, -drilling.depth, "DEPTH OF THREAD")
        } else {
            (201, -drilling.depth, "DEPTH")
        };
        let clear = (200, clearance, "SET-UP CLEARANCE");
        let plunge = |feed| (206, feed, "FEED RATE FOR PLNGNG");
        let surface = (203, top, "SURFACE COORDINATE");
        // The control goes to the higher of the two.
        let away = (204, drilling.retract.max(clearance), "2ND SET-UP CLEARANCE");
        let wait = (211, dwell, "DWELL TIME AT DEPTH");
        let step = (202, drilling.step, "PLUNGING DEPTH");
        let above = (210, 0.0, "DWELL TIME AT TOP");
        let reference = self.newer.then_some((395, 0.0, "DEPTH REFERENCE"));
        let out = |feed| (208, feed, "RETRACTION FEED RATE");
        let (header, parameters) = match cycle {
            Cycle::Drill | Cycle::Deep => {
                let feed = plunge(down()?);
                let mut parameters = vec![clear, depth, feed, step, above, surface, away, wait];
                parameters.extend(reference);
                ((200, "DRILLING", "BOHREN"), parameters)
            }
            Cycle::BreakChip => {
                let breaks = (drilling.depth / drilling.step).ceil();
                let feed = plunge(down()?);
                let mut parameters = vec![clear, depth, feed, step, above, surface, away];
                parameters.extend([
                    (212, 0.0, "DECREMENT"),
                    (213, breaks, "NR OF BREAKS"),
                    (205, 0.0, "MIN. PLUNGING DEPTH"),
                    wait,
                    out(RAPID),
                    (256, self.chip, "DIST FOR CHIP BRKNG"),
                ]);
                parameters.extend(reference);
                ((203, "UNIVERSAL DRILLING", "UNIVERSAL-BOHREN"), parameters)
            }
            Cycle::Ream => {
                let feed = down()?;
                let parameters = vec![clear, depth, plunge(feed), wait, out(feed), surface, away];
                ((201, "REAMING", "REIBEN"), parameters)
            }
            Cycle::Bore | Cycle::BoreFine => {
                let lift = if cycle == Cycle::Bore { 0 } else { self.lift };
                let feed = plunge(down()?);
                let mut parameters = vec![clear, depth, feed, wait, out(RAPID), surface, away];
                parameters.push((214, lift as f64, "DISENGAGING DIRECTN"));
                parameters.push((336, self.angle, "ANGLE OF SPINDLE"));
                ((202, "BORING", "AUSDREHEN"), parameters)
            }
            Cycle::Tap | Cycle::TapLeft if self.floating => {
                let speed = rpm.ok_or(NO_SPEED)?;
                let feed = plunge(drilling.thread(rpm).ok_or(NO_SPEED)? * speed * self.feeds);
                let parameters = vec![clear, depth, feed, wait, surface, away];
                ((206, "TAPPING", "GEWINDEBOHREN"), parameters)
            }
            Cycle::Tap | Cycle::TapLeft => {
                let pitch = drilling.thread(rpm).ok_or(NO_SPEED)?;
                let pitch = if cycle == Cycle::Tap { pitch } else { -pitch };
                let pitch = (239, pitch, "THREAD PITCH");
                ((207, "RIGID TAPPING", "GEW.-BOHREN GS"), vec![clear, depth, pitch, surface, away])
            }
            Cycle::BoreBack => {
                return Err("back boring needs more than the CL file tells".to_owned());
            }
        };
        let (number, english, german) = header;
        let name = if self.german { german } else { english };
        Ok(block(&format!("CYCL DEF {number} {name}"), &parameters))
    }
}

/// A definition whose parameters go on after tildes, without numbers of their own.
pub(crate) fn block(header: &str, parameters: &[(u32, f64, &str)]) -> String {
    let style = NumberStyle { plus: true, trim: true, point: false };
    let mut text = header.to_owned();
    for (number, value, label) in parameters {
        text.push_str(&format!(" ~\n    Q{number}="));
        style.write(&mut text, *value, 5);
        text.push_str(&format!(" ;{label}"));
    }
    text
}

const NO_SPEED: &str = "this cycle is told by the spindle's speed, and no spindle turns: switch it on before the cycle";
