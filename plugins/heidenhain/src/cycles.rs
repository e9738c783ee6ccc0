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

/// A parameter of a definition.
#[derive(Clone, Copy)]
pub(crate) struct CycleParameter {
    /// The number after Q.
    number: u32,
    /// Program units, degrees or seconds, as the control counts it there.
    value: f64,
    /// The remark beside it.
    label: &'static str,
}

impl CycleParameter {
    pub(crate) const fn new(number: u32, value: f64, label: &'static str) -> Self {
        Self { number, value, label }
    }
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
        let hole = HoleParameters::new(drilling, top + raised, rpm);
        let HoleDefinition { number, english, german, parameters } = match drilling.cycle {
            Cycle::Drill | Cycle::Deep => self.drill(&hole)?,
            Cycle::BreakChip => self.break_chips(&hole)?,
            Cycle::Ream => self.ream(&hole)?,
            Cycle::Bore | Cycle::BoreFine => self.bore(&hole)?,
            Cycle::Tap | Cycle::TapLeft => self.tap(&hole)?,
            Cycle::BoreBack => {
                return Err("back boring needs more than the CL file tells".to_owned());
            }
        };
        let name = if self.german { german } else { english };
        Ok(block(&format!("CYCL DEF {number} {name}"), &parameters))
    }

    fn drill(&self, hole: &HoleParameters) -> Result<HoleDefinition, String> {
        let &HoleParameters { clear, depth, step, surface, away, wait, .. } = hole;
        let feed = plunge(self.feed(hole)?);
        let mut parameters = vec![clear, depth, feed, step, WAIT_ABOVE, surface, away, wait];
        parameters.extend(self.reference());
        Ok(HoleDefinition { number: 200, english: "DRILLING", german: "BOHREN", parameters })
    }

    fn break_chips(&self, hole: &HoleParameters) -> Result<HoleDefinition, String> {
        let &HoleParameters { clear, depth, step, surface, away, wait, .. } = hole;
        let feed = plunge(self.feed(hole)?);
        let breaks = (hole.drilling.depth / hole.drilling.step).ceil();
        let mut parameters = vec![clear, depth, feed, step, WAIT_ABOVE, surface, away];
        parameters.extend([
            CycleParameter::new(212, 0.0, "DECREMENT"),
            CycleParameter::new(213, breaks, "NR OF BREAKS"),
            CycleParameter::new(205, 0.0, "MIN. PLUNGING DEPTH"),
            wait,
            out(RAPID),
            CycleParameter::new(256, self.chip, "DIST FOR CHIP BRKNG"),
        ]);
        parameters.extend(self.reference());
        let (english, german) = ("UNIVERSAL DRILLING", "UNIVERSAL-BOHREN");
        Ok(HoleDefinition { number: 203, english, german, parameters })
    }

    fn ream(&self, hole: &HoleParameters) -> Result<HoleDefinition, String> {
        let &HoleParameters { clear, depth, surface, away, wait, .. } = hole;
        let feed = self.feed(hole)?;
        let parameters = vec![clear, depth, plunge(feed), wait, out(feed), surface, away];
        Ok(HoleDefinition { number: 201, english: "REAMING", german: "REIBEN", parameters })
    }

    fn bore(&self, hole: &HoleParameters) -> Result<HoleDefinition, String> {
        let &HoleParameters { clear, depth, surface, away, wait, .. } = hole;
        let lift = if hole.drilling.cycle == Cycle::Bore { 0 } else { self.lift };
        let lift = CycleParameter::new(214, lift as f64, "DISENGAGING DIRECTN");
        let angle = CycleParameter::new(336, self.angle, "ANGLE OF SPINDLE");
        let feed = plunge(self.feed(hole)?);
        let parameters = vec![clear, depth, feed, wait, out(RAPID), surface, away, lift, angle];
        Ok(HoleDefinition { number: 202, english: "BORING", german: "AUSDREHEN", parameters })
    }

    fn tap(&self, hole: &HoleParameters) -> Result<HoleDefinition, String> {
        let &HoleParameters { drilling, rpm, clear, depth, surface, away, wait, .. } = hole;
        if self.floating {
            let speed = rpm.ok_or(NO_SPEED)?;
            let feed = plunge(drilling.thread(rpm).ok_or(NO_SPEED)? * speed * self.feeds);
            let parameters = vec![clear, depth, feed, wait, surface, away];
            let (english, german) = ("TAPPING", "GEWINDEBOHREN");
            return Ok(HoleDefinition { number: 206, english, german, parameters });
        }
        let pitch = drilling.thread(rpm).ok_or(NO_SPEED)?;
        let pitch = if drilling.cycle == Cycle::Tap { pitch } else { -pitch };
        let pitch = CycleParameter::new(239, pitch, "THREAD PITCH");
        let parameters = vec![clear, depth, pitch, surface, away];
        let (english, german) = ("RIGID TAPPING", "GEW.-BOHREN GS");
        Ok(HoleDefinition { number: 207, english, german, parameters })
    }

    /// The feed of a hole as the parameters count it.
    fn feed(&self, hole: &HoleParameters) -> Result<f64, String> {
        Ok(hole.drilling.feed_per_minute(hole.rpm).ok_or(NO_SPEED)? * self.feeds)
    }

    /// What the depth is that of: newer controls ask for it.
    fn reference(&self) -> Option<CycleParameter> {
        self.newer.then_some(CycleParameter::new(395, 0.0, "DEPTH REFERENCE"))
    }
}

/// A hole, and the parameters that definitions have in common.
struct HoleParameters {
    drilling: Drilling,
    rpm: Option<f64>,
    clear: CycleParameter,
    depth: CycleParameter,
    step: CycleParameter,
    surface: CycleParameter,
    away: CycleParameter,
    wait: CycleParameter,
}

impl HoleParameters {
    fn new(drilling: Drilling, top: f64, rpm: Option<f64>) -> Self {
        let thread = matches!(drilling.cycle, Cycle::Tap | Cycle::TapLeft);
        let depth = if thread { "DEPTH OF THREAD" } else { "DEPTH" };
        // The control goes to the higher of the two.
        let away = drilling.retract.max(drilling.clearance);
        Self {
            drilling,
            rpm,
            clear: CycleParameter::new(200, drilling.clearance, "SET-UP CLEARANCE"),
            depth: CycleParameter::new(201, -drilling.depth, depth),
            step: CycleParameter::new(202, drilling.step, "PLUNGING DEPTH"),
            surface: CycleParameter::new(203, top, "SURFACE COORDINATE"),
            away: CycleParameter::new(204, away, "2ND SET-UP CLEARANCE"),
            wait: CycleParameter::new(211, drilling.dwell, "DWELL TIME AT DEPTH"),
        }
    }
}

/// A definition: number and name of the cycle, in the languages of the control, and its parameters.
struct HoleDefinition {
    number: u32,
    english: &'static str,
    german: &'static str,
    parameters: Vec<CycleParameter>,
}

/// No wait above the hole.
const WAIT_ABOVE: CycleParameter = CycleParameter::new(210, 0.0, "DWELL TIME AT TOP");

/// The feed into the hole.
const fn plunge(feed: f64) -> CycleParameter {
    CycleParameter::new(206, feed, "FEED RATE FOR PLNGNG")
}

/// The feed out of it.
const fn out(feed: f64) -> CycleParameter {
    CycleParameter::new(208, feed, "RETRACTION FEED RATE")
}

/// A definition whose parameters go on after tildes, without numbers of their own.
pub(crate) fn block(header: &str, parameters: &[CycleParameter]) -> String {
    let style = NumberStyle { plus: true, trim: true, point: false };
    let mut text = header.to_owned();
    for CycleParameter { number, value, label } in parameters {
        text.push_str(&format!(" ~\n    Q{number}="));
        style.write(&mut text, *value, 5);
        text.push_str(&format!(" ;{label}"));
    }
    text
}

const NO_SPEED: &str = "this cycle is told by the spindle's speed, and no spindle turns: switch it on before the cycle";
