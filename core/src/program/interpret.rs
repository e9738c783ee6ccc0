//! Settles what is modal in a CL file: units, axis, feed, frames, cycles; arcs and splines become chords.

use nalgebra::Vector3;
use post_grammar::{
    Circle, Coolant as CoolantWord, Cutcom, Cycle, CycleDefinition, Delay, Delta, FeedRate,
    FeedUnit, LoadTool, Record, Sense, Side, Spindle as SpindleWord, SpindleUnit, Statement, Units,
};
use post_plugin::{Compensation, Coolant, Spindle, SpindleSense};

use super::arc::Arc;
use super::cycle::{Drill, Leg};
use super::frame::Frame;
use super::met::{Unknown, WordsMet};
use super::motion::{Motion, Pace, Step, Tool};
use super::spline::Spline;
use super::words::{Usage, usage};
use crate::diagnostic::{Diagnostic, Place};
use crate::machine::{Insert, ToolLength};

/// How a file is to be read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The file's name in messages.
    pub file: String,
    /// Units of the numbers, whatever the file says.
    pub units: Option<Units>,
    /// The tool that a file without `LOADTL` works with.
    pub tool: Option<u32>,
    /// Take points and axes into the frame of `MSYS`.
    pub apply_msys: bool,
    /// What to do with unknown words.
    pub unknown: Unknown,
    /// What becomes of `INSERT`.
    pub insert: Insert,
    /// Which tool length counts.
    pub tool_length: ToolLength,
    /// How far chords may stray from arcs and splines, mm.
    pub chord_tolerance: f64,
}

/// Turns records into steps.
#[derive(Debug)]
pub struct Interpreter {
    reading: Reading,
    /// Units that the file names.
    units: Option<Units>,
    /// mm in one unit of the file.
    scale: f64,
    /// Some feed word names a metric or an inch unit.
    feed_units: Option<Units>,
    /// Modal tool axis, frame of the file.
    axis: Vector3<f64>,
    /// `TLAXIS`, part frame.
    told_axis: Option<Vector3<f64>>,
    /// An index move came since the last move: see whether it agrees with `TLAXIS`.
    check_axis: bool,
    /// Last point, mm, frame of the file.
    tip: Option<Vector3<f64>>,
    rapid: bool,
    /// `FEDRAT/RAPID` is in force.
    rapid_feed: bool,
    feed: Option<FeedWord>,
    frame: Frame,
    pending: Option<Pending>,
    cycle: Option<(Drill, FeedWord)>,
    last_cycle: Option<(Drill, FeedWord)>,
    rpm: Option<f64>,
    sense: SpindleSense,
    coolant: Coolant,
    side: Option<Side>,
    /// Number, register and length (as written) of the tool in the spindle.
    loaded: Option<(u32, u32, Option<f64>)>,
    /// A further cutter was described, and no tool was loaded for it.
    cutter_changed: bool,
    /// Some move was read since the last tool was loaded.
    cut_any: bool,
    told_cutter: bool,
    /// Cutter compensation is in force, and its register.
    compensated: bool,
    register: Option<u32>,
    tool_name: String,
    diameter: Option<f64>,
    cutter_length: Option<f64>,
    finished: bool,
    findings: Vec<Diagnostic>,
    met: WordsMet,
}

/// A feed as the file has it; one a revolution waits for the speed of the spindle at the move.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FeedWord {
    Pace(Pace),
    /// mm.
    PerRevolution(f64),
}

/// A curve that is not yet complete.
#[derive(Clone, Debug)]
enum Pending {
    Arc(Circle),
    Spline {
        knots: Vec<f64>,
        points: Vec<Vector3<f64>>,
    },
}

/// Knots or control points of one spline; a longer one would not stream.
const MOST_SPLINE_NUMBERS: usize = 1_000_000;

/// Chords of one arc; more is a slip of the decimal point.
const MOST_CHORDS: u64 = 10_000_000;

/// Ends of an arc whose distances from its centre differ by more are no arc: mm.
const ARC_MISMATCH: f64 = 0.1;

impl Interpreter {
    /// Nothing read yet.
    pub fn new(reading: Reading) -> Self {
        let scale = reading.units.map_or(1.0, millimetres);
        let frame = Frame::new(reading.apply_msys);
        Self {
            reading,
            units: None,
            scale,
            feed_units: None,
            axis: Vector3::z(),
            told_axis: None,
            check_axis: false,
            tip: None,
            rapid: false,
            rapid_feed: false,
            feed: None,
            frame,
            pending: None,
            cycle: None,
            last_cycle: None,
            rpm: None,
            sense: SpindleSense::Clockwise,
            coolant: Coolant::Flood,
            side: None,
            loaded: None,
            cutter_changed: false,
            cut_any: false,
            told_cutter: false,
            compensated: false,
            register: None,
            tool_name: String::new(),
            diameter: None,
            cutter_length: None,
            finished: false,
            findings: Vec::new(),
            met: WordsMet::default(),
        }
    }

    /// A tool was loaded.
    pub fn has_tool(&self) -> bool {
        self.loaded.is_some()
    }

    /// Findings since the last call.
    pub fn take_findings(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.findings)
    }

    /// There are findings.
    #[inline]
    pub fn has_findings(&self) -> bool {
        !self.findings.is_empty()
    }

    /// Words that were ignored, and how often.
    pub fn ignored(&self) -> impl Iterator<Item = (&str, u64)> {
        self.met.ignored()
    }

    /// Takes one record and gives the steps it means to `emit`, in order.
    #[inline]
    pub fn record(&mut self, record: &Record<'_>, emit: &mut impl FnMut(Step)) {
        if let Statement::Goto { point, axis } = &record.statement
            && self.pending.is_none()
            && self.cycle.is_none()
            && !self.finished
        {
            self.goto(record, *point, *axis, emit);
            return;
        }
        self.other(record, emit);
    }

    /// What is left open at the end of the file.
    pub fn finish(&mut self) {
        match self.pending.take() {
            None => {}
            Some(Pending::Arc(_)) => self.findings.push(Diagnostic::error(
                "arc",
                "the file ends with a CIRCLE that no GOTO ends",
            )),
            Some(Pending::Spline { .. }) => self.findings.push(Diagnostic::error(
                "spline",
                "the file ends within a NURBS: no GOTO, END-OF-PATH or FINI follows it",
            )),
        }
        if self.tip.is_some() && self.units.is_none() && self.reading.units.is_none() {
            match self.feed_units {
                Some(Units::Inch) => self.findings.push(
                    Diagnostic::warning(
                        "units",
                        "the file has no UNITS; its points were taken as mm, but its feeds are in inches",
                    )
                    .help("say --units inch or --units mm"),
                ),
                Some(_) => {}
                None => self.findings.push(
                    Diagnostic::warning("units", "the file has no UNITS; its numbers were taken as mm")
                        .help("say --units inch or --units mm"),
                ),
            }
        }
        self.findings.extend(self.met.unknown(self.reading.unknown));
    }

    fn other(&mut self, record: &Record<'_>, emit: &mut impl FnMut(Step)) {
        if self.finished {
            if !matches!(record.statement, Statement::Remark(_) | Statement::Fini) {
                self.count("FINI", record, Usage::Used);
                if self.met.times("FINI") == 2 {
                    self.warn(
                        record,
                        "after-fini",
                        "records behind FINI are left out".to_owned(),
                    );
                }
            }
            return;
        }
        match &record.statement {
            Statement::Goto { point, axis } => self.goto(record, *point, *axis, emit),
            Statement::Godlta(delta) => {
                let Some(tip) = self.tip else {
                    self.fault(
                        record,
                        "godlta",
                        "GODLTA steps from the last point, and there is none".to_owned(),
                        "put a FROM or GOTO before it",
                    );
                    return;
                };
                let step = match delta {
                    Delta::Step(step) => Vector3::from(*step),
                    Delta::AlongAxis(length) => self.axis * *length,
                };
                let point = tip / self.scale + step;
                self.goto(record, point.into(), None, emit);
            }
            Statement::From { point, axis } => {
                let tip = self.point(*point);
                if !self.set_axis(record, *axis) {
                    return;
                }
                self.tip = Some(tip);
                let (tip, axis) = self.frame.to_part(tip, self.axis);
                emit(Step::From { tip, axis });
            }
            Statement::Gohome(None) => {
                self.rapid = false;
                self.tip = None;
                emit(Step::Home);
            }
            Statement::Gohome(Some((point, axis))) => {
                self.rapid = true;
                self.goto(record, *point, *axis, emit);
            }
            Statement::Rapid => self.rapid = true,
            Statement::Feed(feed) => self.set_feed(record, *feed),
            Statement::Spindle(spindle) => {
                self.load_told(record, emit);
                self.spindle(record, *spindle, emit);
            }
            Statement::Coolant(word) => {
                let coolant = match word {
                    CoolantWord::Off => Coolant::Off,
                    CoolantWord::On => self.coolant,
                    CoolantWord::Flood => Coolant::Flood,
                    CoolantWord::Mist => Coolant::Mist,
                    CoolantWord::Through => Coolant::Through,
                    CoolantWord::Air => Coolant::Air,
                };
                if coolant != Coolant::Off {
                    self.coolant = coolant;
                }
                self.load_told(record, emit);
                emit(Step::Coolant(coolant));
            }
            Statement::LoadTool(tool) => self.load(record, tool, emit),
            Statement::SelectTool(number) => {
                if self.loaded.map(|(loaded, ..)| loaded) != Some(*number) {
                    emit(Step::Preselect(*number));
                }
            }
            Statement::ToolData { numbers, .. } => self.cutter(numbers, 2),
            Statement::Cutter(numbers) => self.cutter(numbers, 6),
            Statement::Units(units) => {
                let scale = millimetres(self.reading.units.unwrap_or(*units));
                if scale != self.scale && (self.tip.is_some() || self.feed.is_some()) {
                    self.fault(
                        record,
                        "units",
                        "UNITS comes after points or feeds that were read in other units"
                            .to_owned(),
                        "put it before them, or say --units",
                    );
                }
                self.units = Some(*units);
                self.scale = scale;
            }
            Statement::Multax(on) => {
                if !on {
                    self.axis = Vector3::z();
                }
            }
            Statement::Msys { origin, x, y } => {
                let origin = self.point(*origin);
                let done = self
                    .frame
                    .set_msys(origin, Vector3::from(*x), Vector3::from(*y));
                if let Err(message) = done {
                    self.fault(record, "msys", message.to_owned(), "");
                }
            }
            Statement::Circle(circle) => {
                if self.pending.is_some() {
                    self.fault(
                        record,
                        "arc",
                        "the curve before this CIRCLE is not ended by a GOTO".to_owned(),
                        "",
                    );
                }
                self.pending = Some(Pending::Arc(circle.clone()));
            }
            Statement::Nurbs => {
                self.end_spline(record, emit);
                match self.tip {
                    Some(tip) => {
                        self.pending = Some(Pending::Spline {
                            knots: Vec::new(),
                            points: vec![tip],
                        });
                    }
                    None => self.fault(
                        record,
                        "spline",
                        "NURBS begins at the last point, and there is none".to_owned(),
                        "put a GOTO before it",
                    ),
                }
            }
            Statement::Knot(_) | Statement::Control { .. } => self.spline_data(record),
            Statement::Cycle(cycle) => self.cycle(record, cycle),
            Statement::Cutcom(cutcom) => self.cutcom(*cutcom, emit),
            Statement::Rotate(rotate) => match self.frame.rotate(rotate) {
                Ok(()) => {
                    self.axis = match (self.frame.turned(), self.told_axis) {
                        (None, Some(axis)) => axis,
                        _ => Vector3::z(),
                    };
                    self.check_axis = self.frame.turned().is_some();
                }
                Err(message) => self.fault(
                    record,
                    "rotabl",
                    message.to_owned(),
                    "write ROTABL/AAXIS,…, BAXIS or CAXIS",
                ),
            },
            Statement::ToolAxis(axis) => match Vector3::from(*axis).try_normalize(1e-9) {
                Some(axis) => {
                    self.told_axis = Some(axis);
                    if self.frame.turned().is_none() {
                        self.axis = axis;
                    }
                }
                None => self.fault(record, "axis", "the tool axis is null".to_owned(), ""),
            },
            Statement::Delay(Delay::Seconds(seconds)) => emit(Step::Dwell(*seconds)),
            Statement::Delay(Delay::Revolutions(turns)) => match self.rpm {
                Some(rpm) if rpm > 0.0 => emit(Step::Dwell(turns * 60.0 / rpm)),
                _ => self.fault(
                    record,
                    "dwell",
                    "a dwell in revolutions needs a spindle speed".to_owned(),
                    "put a SPINDL before it",
                ),
            },
            Statement::Stop => emit(Step::Stop),
            Statement::OptionalStop => emit(Step::OptionalStop),
            Statement::ToolPath { name, tool } => {
                self.end_spline(record, emit);
                // Every path of NX stands by itself: its first GOTO gives the axis if it is not Z.
                self.axis = Vector3::z();
                self.tool_name = tool.clone().unwrap_or_default();
                emit(Step::Comment(name.clone()));
            }
            Statement::EndOfPath => self.end_spline(record, emit),
            Statement::PartName(text) | Statement::Print(text) => emit(Step::Comment(text.clone())),
            Statement::Insert(text) => match self.reading.insert {
                Insert::Comment => emit(Step::Comment(text.clone())),
                Insert::Literal => emit(Step::Literal(text.clone())),
            },
            Statement::Csys(_) | Statement::Remark(_) => {
                self.count(record.statement.word(), record, Usage::Ignored);
            }
            Statement::Fini => {
                self.end_spline(record, emit);
                self.finished = true;
                self.count("FINI", record, Usage::Used);
            }
            Statement::Other {
                word, directive, ..
            } => {
                let usage = match usage(word) {
                    // A directive is a remark to all but the program it is meant for.
                    Usage::Unknown if *directive => Usage::Ignored,
                    usage => usage,
                };
                self.count(word, record, usage);
                if usage == Usage::Refused {
                    self.fault(
                        record,
                        "refused-word",
                        format!("{word} changes where the tool goes, and post does not know how"),
                        "let the CAM system write the result instead",
                    );
                }
                if usage == Usage::Unknown && self.reading.unknown == Unknown::Pass {
                    emit(Step::Comment(record.text().into_owned()));
                }
            }
        }
    }

    #[inline]
    fn goto(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
        emit: &mut impl FnMut(Step),
    ) {
        let start_axis = self.axis;
        if !self.set_axis(record, axis) {
            return;
        }
        if self.loaded.is_none() {
            self.load_told(record, emit);
        }
        if self.cutter_changed && !self.told_cutter {
            self.told_cutter = true;
            self.warn(
                record,
                "cutter",
                "another cutter was described (CUTTER, TLDATA), but no tool was loaded for it: this is cut with the tool before".to_owned(),
            );
        }
        if std::mem::take(&mut self.check_axis)
            && let (Some(turned), Some(told)) = (self.frame.turned(), self.told_axis)
            && (turned * self.axis - told).norm() > 1e-3
        {
            self.fault(
                record,
                "rotabl",
                "the index angles (ROTABL) do not turn the tool to the axis that TLAXIS names"
                    .to_owned(),
                "one of the two is wrong: check the operation's set-up in the CAM system",
            );
        }
        let tip = self.point(point);
        match self.pending.take() {
            None => {}
            Some(Pending::Arc(circle)) => {
                self.arc(record, &circle, tip, start_axis, emit);
                return;
            }
            Some(spline) => {
                self.pending = Some(spline);
                self.end_spline(record, emit);
            }
        }
        if let Some((drill, feed)) = self.cycle {
            if let Some(pace) = self.resolved(record, feed) {
                self.drill(drill, pace, tip, emit);
            }
            return;
        }
        if let Some(pace) = self.pace(record) {
            self.advance(tip, pace, 0.0, emit);
        }
    }

    /// Takes the axis of a six-number point; false if it is none.
    #[inline]
    fn set_axis(&mut self, record: &Record<'_>, axis: Option<[f64; 3]>) -> bool {
        let Some(axis) = axis else {
            return true;
        };
        let axis = Vector3::from(axis);
        let square = axis.norm_squared();
        if square < 1e-12 {
            self.fault(
                record,
                "axis",
                "the tool axis is null".to_owned(),
                "i, j, k are a direction, from the tip to the holder",
            );
            return false;
        }
        self.axis = axis * (1.0 / square.sqrt());
        true
    }

    #[inline]
    fn point(&self, point: [f64; 3]) -> Vector3<f64> {
        Vector3::from(point) * self.scale
    }

    /// How fast the next move goes; a fault if nothing says so.
    #[inline]
    fn pace(&mut self, record: &Record<'_>) -> Option<Pace> {
        if std::mem::take(&mut self.rapid) || self.rapid_feed {
            return Some(Pace::Rapid);
        }
        let Some(feed) = self.feed else {
            if self.tip.is_none() {
                // The first approach of a file that names no feed yet comes from the tool change.
                return Some(Pace::Rapid);
            }
            self.fault(
                record,
                "no-feed",
                "this move has no feed: no FEDRAT before it, and no RAPID".to_owned(),
                "the CAM system must write a FEDRAT",
            );
            return None;
        };
        self.resolved(record, feed)
    }

    /// A feed word as the spindle turns now.
    #[inline]
    fn resolved(&mut self, record: &Record<'_>, feed: FeedWord) -> Option<Pace> {
        match (feed, self.rpm) {
            (FeedWord::Pace(pace), _) => Some(pace),
            (FeedWord::PerRevolution(feed), Some(rpm)) if rpm > 0.0 => {
                Some(Pace::PerMinute(feed * rpm))
            }
            (FeedWord::PerRevolution(_), _) => {
                self.fault(
                    record,
                    "feed",
                    "a feed per revolution needs a spindle speed".to_owned(),
                    "put a SPINDL before it",
                );
                None
            }
        }
    }

    /// Emits one straight move and keeps its end.
    #[inline]
    fn advance(&mut self, tip: Vector3<f64>, pace: Pace, chord: f64, emit: &mut impl FnMut(Step)) {
        self.tip = Some(tip);
        self.cut_any = true;
        let (tip, axis) = self.frame.to_part(tip, self.axis);
        emit(Step::Move(Motion {
            tip,
            axis,
            pace,
            chord,
        }));
    }

    fn arc(
        &mut self,
        record: &Record<'_>,
        circle: &Circle,
        end: Vector3<f64>,
        start_axis: Vector3<f64>,
        emit: &mut impl FnMut(Step),
    ) {
        let Some(start) = self.tip else {
            self.fault(
                record,
                "arc",
                "the arc begins at the last point, and there is none".to_owned(),
                "put a GOTO before the CIRCLE",
            );
            return;
        };
        let Some(pace) = self.pace(record) else {
            return;
        };
        // The axis and its right hand give the sense; a word (CAMWorks) is seen from the tip of the axis.
        let axis = match circle.sense {
            Some(Sense::Clockwise) => -Vector3::from(circle.axis),
            _ => Vector3::from(circle.axis),
        };
        let centre = self.point(circle.centre);
        let arc = match Arc::new(start, end, centre, axis, circle.turns.unwrap_or(1)) {
            Ok(arc) => arc,
            Err(message) => {
                self.fault(record, "arc", format!("no arc: {message}"), "");
                self.tip = Some(end);
                return;
            }
        };
        if self.cycle.is_some() {
            self.fault(
                record,
                "arc",
                "an arc while a cycle is on".to_owned(),
                "put a CYCLE/OFF before it",
            );
        }
        if let Some(gap) = arc.doubtful() {
            self.warn(
                record,
                "arc",
                format!("the ends of this arc lie {gap:.4} mm apart: it is made as that short arc, not as a whole turn"),
            );
        }
        if arc.mismatch() > self.reading.chord_tolerance && arc.mismatch() <= ARC_MISMATCH {
            self.warn(
                record,
                "arc",
                format!(
                    "the ends of this arc lie {:.4} mm apart in their distance from its centre; it is made as a spiral",
                    arc.mismatch()
                ),
            );
        }
        if arc.mismatch() > ARC_MISMATCH {
            self.fault(
                record,
                "arc",
                format!(
                    "the ends of this arc lie {:.4} mm apart in their distance from its centre; {ARC_MISMATCH} mm is allowed",
                    arc.mismatch()
                ),
                "check the CIRCLE before it",
            );
        }
        if let Some(radius) = circle.radius
            && libm::fabs(arc.radius() - radius * self.scale) > ARC_MISMATCH
        {
            self.warn(
                record,
                "arc",
                format!(
                    "the CIRCLE before this point says radius {radius}, its points lie at {:.4}",
                    arc.radius() / self.scale
                ),
            );
        }
        let (count, stray) = arc.chords(self.reading.chord_tolerance);
        if count > MOST_CHORDS {
            self.fault(
                record,
                "arc",
                format!(
                    "this arc needs {count} chords to stay within {} mm",
                    self.reading.chord_tolerance
                ),
                "widen the tolerance",
            );
            return;
        }
        let end_axis = self.axis;
        let pace = match pace {
            // The time is that of the whole arc.
            Pace::InverseTime(feed) => Pace::InverseTime(feed * count as f64),
            pace => pace,
        };
        for piece in 1..=count {
            let t = piece as f64 / count as f64;
            let point = if piece == count { end } else { arc.at(t) };
            self.axis = if start_axis == end_axis {
                end_axis
            } else {
                (start_axis * (1.0 - t) + end_axis * t)
                    .try_normalize(1e-9)
                    .unwrap_or(end_axis)
            };
            self.advance(point, pace, stray, emit);
        }
        self.axis = end_axis;
    }

    fn spline_data(&mut self, record: &Record<'_>) {
        let scale = self.scale;
        let Some(Pending::Spline { knots, points }) = &mut self.pending else {
            self.fault(
                record,
                "spline",
                "there is no NURBS before it".to_owned(),
                "",
            );
            return;
        };
        if knots.len().max(points.len()) > MOST_SPLINE_NUMBERS {
            self.pending = None;
            self.fault(
                record,
                "spline",
                format!("a spline of more than {MOST_SPLINE_NUMBERS} points"),
                "",
            );
            return;
        }
        match &record.statement {
            Statement::Knot(numbers) => knots.extend_from_slice(numbers),
            Statement::Control { point, axis: None } => points.push(Vector3::from(*point) * scale),
            _ => self.fault(
                record,
                "spline",
                "splines with tool axes are not supported".to_owned(),
                "let the CAM system write GOTOs",
            ),
        }
    }

    fn end_spline(&mut self, record: &Record<'_>, emit: &mut impl FnMut(Step)) {
        if !matches!(self.pending, Some(Pending::Spline { .. })) {
            return;
        }
        let Some(Pending::Spline { knots, points }) = self.pending.take() else {
            return;
        };
        // The RAPID that may stand behind the spline is meant for the record that ends it.
        let rapid = std::mem::take(&mut self.rapid);
        let pace = self.pace(record);
        self.rapid = rapid;
        let Some(pace) = pace else {
            return;
        };
        match Spline::new(&knots, points) {
            Ok(spline) => {
                let tolerance = self.reading.chord_tolerance;
                spline.flatten(tolerance, &mut |point, stray| {
                    self.advance(point, pace, stray, emit);
                });
            }
            Err(message) => self.fault(
                record,
                "spline",
                format!("the NURBS before this: {message}"),
                "",
            ),
        }
    }

    fn drill(
        &mut self,
        drill: Drill,
        feed: Pace,
        point: Vector3<f64>,
        emit: &mut impl FnMut(Step),
    ) {
        self.rapid = false;
        let axis = self.axis;
        // Between holes the tool goes up before it goes aside, and aside before it goes down.
        if let Some(tip) = self.tip {
            let height = axis.dot(&(tip - point));
            let aside = tip - point - axis * height;
            if aside.norm() > 1e-6 {
                let level = height.max(drill.retract());
                if height < level {
                    self.advance(point + aside + axis * level, Pace::Rapid, 0.0, emit);
                } else if height > drill.retract() {
                    self.advance(point + axis * level, Pace::Rapid, 0.0, emit);
                }
            }
        }
        drill.legs(&mut |leg| match leg {
            Leg::Rapid(height) => self.advance(point + axis * height, Pace::Rapid, 0.0, emit),
            Leg::Feed(height) => self.advance(point + axis * height, feed, 0.0, emit),
            Leg::Dwell(seconds) => emit(Step::Dwell(seconds)),
        });
    }

    fn cycle(&mut self, record: &Record<'_>, cycle: &Cycle) {
        match cycle {
            Cycle::Off => self.cycle = None,
            Cycle::On => self.cycle = self.last_cycle,
            Cycle::Define(definition) => self.define_cycle(record, definition),
        }
    }

    fn define_cycle(&mut self, record: &Record<'_>, definition: &CycleDefinition) {
        let drill = match Drill::new(definition, self.scale) {
            Ok(drill) => drill,
            Err(message) => {
                self.fault(
                    record,
                    "cycle",
                    message,
                    "let the CAM system write it as moves",
                );
                return;
            }
        };
        let feed = match definition.feed {
            Some(feed) => self.feed_word(record, feed),
            None => self.feed,
        };
        let left: Vec<String> = Drill::left_out(definition).collect();
        if !left.is_empty() {
            self.warn(
                record,
                "cycle",
                format!("of this cycle is left out: {}", left.join(", ")),
            );
        }
        let Some(feed) = feed.filter(|feed| *feed != FeedWord::Pace(Pace::Rapid)) else {
            self.fault(record, "no-feed", "the cycle has no feed".to_owned(), "");
            return;
        };
        self.cycle = Some((drill, feed));
        self.last_cycle = self.cycle;
    }

    fn set_feed(&mut self, record: &Record<'_>, feed: FeedRate) {
        self.rapid_feed = feed.unit == Some(FeedUnit::Rapid);
        if self.rapid_feed {
            return;
        }
        if let Some(pace) = self.feed_word(record, feed) {
            self.feed = Some(pace);
        }
    }

    /// A feed in mm.
    fn feed_word(&mut self, record: &Record<'_>, feed: FeedRate) -> Option<FeedWord> {
        let value = feed.value.unwrap_or(0.0);
        if value <= 0.0 {
            self.fault(
                record,
                "feed",
                format!("a feed of {value}: it must be above zero"),
                "",
            );
            return None;
        }
        // Where the units are overridden, a word of the units that the file declares goes with its lengths.
        let length = |this: &Self, units: Units| match (this.reading.units, this.units) {
            (Some(told), Some(declared)) if is_inch(declared) == is_inch(units) => {
                millimetres(told)
            }
            _ => millimetres(units),
        };
        let (per_revolution, scale) = match feed.unit {
            None | Some(FeedUnit::PerMinute) => (false, self.scale),
            Some(FeedUnit::MillimetresPerMinute) => {
                self.feed_units = Some(Units::Millimetre);
                (false, length(self, Units::Millimetre))
            }
            Some(FeedUnit::InchesPerMinute) => {
                self.feed_units = Some(Units::Inch);
                (false, length(self, Units::Inch))
            }
            Some(FeedUnit::PerRevolution) => (true, self.scale),
            Some(FeedUnit::MillimetresPerRevolution) => (true, length(self, Units::Millimetre)),
            Some(FeedUnit::InchesPerRevolution) => (true, length(self, Units::Inch)),
            Some(FeedUnit::InverseTime) => {
                return Some(FeedWord::Pace(Pace::InverseTime(value)));
            }
            Some(FeedUnit::Rapid) => return Some(FeedWord::Pace(Pace::Rapid)),
        };
        Some(if per_revolution {
            FeedWord::PerRevolution(value * scale)
        } else {
            FeedWord::Pace(Pace::PerMinute(value * scale))
        })
    }

    fn spindle(&mut self, record: &Record<'_>, spindle: SpindleWord, emit: &mut impl FnMut(Step)) {
        let step = match spindle {
            SpindleWord::Off => Spindle::Off,
            SpindleWord::Orient => Spindle::Orient,
            SpindleWord::On { speed, unit, sense } => {
                if let Some(speed) = speed {
                    let per_minute = match unit {
                        SpindleUnit::Rpm => None,
                        SpindleUnit::SurfaceMetric => Some(speed * 1000.0),
                        SpindleUnit::SurfaceInch => Some(speed * 304.8),
                    };
                    self.rpm = match (per_minute, self.diameter) {
                        (None, _) => Some(speed),
                        (Some(surface), Some(diameter)) if diameter > 0.0 => {
                            Some(surface / (std::f64::consts::PI * diameter))
                        }
                        _ => {
                            self.fault(
                                record,
                                "spindle",
                                "a surface speed needs the cutter's diameter".to_owned(),
                                "put a CUTTER or TLDATA before it",
                            );
                            return;
                        }
                    };
                }
                if let Some(sense) = sense {
                    self.sense = match sense {
                        Sense::Clockwise => SpindleSense::Clockwise,
                        Sense::CounterClockwise => SpindleSense::CounterClockwise,
                    };
                }
                let Some(rpm) = self.rpm else {
                    self.fault(
                        record,
                        "spindle",
                        "the spindle is switched on, and no speed was given".to_owned(),
                        "",
                    );
                    return;
                };
                Spindle::On {
                    rpm,
                    sense: self.sense,
                }
            }
        };
        emit(Step::Spindle(step));
    }

    fn load(&mut self, record: &Record<'_>, tool: &LoadTool, emit: &mut impl FnMut(Step)) {
        let register = tool.register.unwrap_or(tool.number);
        if tool.number == 0 || register == 0 {
            self.fault(
                record,
                "tool",
                "tool 0 and length register 0 mean none: the tool's length would not be known"
                    .to_owned(),
                "let the CAM system number its tools from 1",
            );
            return;
        }
        let cutter = match self.reading.tool_length {
            ToolLength::Cl => self.cutter_length,
            ToolLength::Assembly => None,
        };
        let length = tool.length.map(|length| length * self.scale).or(cutter);
        // NX repeats LOAD in every operation; the same tool stays in the spindle.
        let loaded = Some((tool.number, register, tool.length));
        if self.loaded == loaded {
            return;
        }
        self.loaded = loaded;
        self.cutter_changed = false;
        self.cut_any = false;
        if self.compensated {
            self.compensated = false;
            emit(Step::Compensate(Compensation::Off));
            self.warn(
                record,
                "compensation",
                "the tool is changed with cutter compensation in force; it is switched off"
                    .to_owned(),
            );
        }
        // The tool comes from the changer: no arc begins where the last one stood.
        self.tip = None;
        emit(Step::Tool(Tool {
            number: tool.number,
            register,
            length,
            name: self.tool_name.clone(),
        }));
    }

    /// Loads the tool that the user names, before the first record that needs one.
    fn load_told(&mut self, record: &Record<'_>, emit: &mut impl FnMut(Step)) {
        if self.loaded.is_none()
            && let Some(number) = self.reading.tool.take()
        {
            let tool = LoadTool {
                number,
                ..LoadTool::default()
            };
            self.load(record, &tool, emit);
        }
    }

    /// A cutter's description; `length` is where its length stands.
    fn cutter(&mut self, numbers: &[f64], length: usize) {
        let diameter = numbers.first().map(|diameter| diameter * self.scale);
        // Files that load their tools describe the cutter just before or after that.
        self.cutter_changed |= self.diameter.is_some() && self.diameter != diameter && self.cut_any;
        self.diameter = diameter;
        self.cutter_length = numbers.get(length).map(|length| length * self.scale);
    }

    fn cutcom(&mut self, cutcom: Cutcom, emit: &mut impl FnMut(Step)) {
        let side = match cutcom.side {
            Some(Side::Off) => {
                self.compensated = false;
                emit(Step::Compensate(Compensation::Off));
                return;
            }
            Some(side) => {
                self.side = Some(side);
                Some(side)
            }
            None => self.side,
        };
        self.register = cutcom.register.or(self.register);
        let tool = self.loaded.map(|(number, ..)| number);
        let register = self.register.or(tool).unwrap_or(1);
        self.compensated |= matches!(side, Some(Side::Left | Side::Right));
        match side {
            Some(Side::Left) => emit(Step::Compensate(Compensation::Left { register })),
            Some(Side::Right) => emit(Step::Compensate(Compensation::Right { register })),
            // CAMWorks switches it ON first and names the side in the next record.
            Some(Side::Off) | None => {}
        }
    }

    fn count(&mut self, word: &str, record: &Record<'_>, usage: Usage) {
        self.met
            .count(word, usage, || record_place(&self.reading.file, record));
    }

    fn place(&self, record: &Record<'_>) -> Option<Place> {
        Some(record_place(&self.reading.file, record))
    }

    #[cold]
    fn fault(&mut self, record: &Record<'_>, code: &'static str, message: String, help: &str) {
        let mut diagnostic = Diagnostic::error(code, message).at(self.place(record));
        if !help.is_empty() {
            diagnostic = diagnostic.help(help);
        }
        self.findings.push(diagnostic);
    }

    #[cold]
    fn warn(&mut self, record: &Record<'_>, code: &'static str, message: String) {
        let place = self.place(record);
        self.findings
            .push(Diagnostic::warning(code, message).at(place));
    }
}

/// Where a record stands.
pub(crate) fn record_place(file: &str, record: &Record<'_>) -> Place {
    let text = record.text().into_owned();
    Place {
        file: file.to_owned(),
        line: record.line,
        span: 0..text.len(),
        text,
    }
}

/// mm in one unit.
fn millimetres(units: Units) -> f64 {
    match units {
        Units::Millimetre => 1.0,
        Units::Inch => 25.4,
        Units::Centimetre => 10.0,
        Units::Metre => 1000.0,
        Units::Foot => 304.8,
    }
}

fn is_inch(units: Units) -> bool {
    matches!(units, Units::Inch | Units::Foot)
}
