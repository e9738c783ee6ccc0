//! Records become items: what is modal is settled.

use std::collections::{BTreeSet, VecDeque};
use std::ops::Range;

use nalgebra::Vector3;
use post_grammar::{
    Argument, CoolantWord, Cutcom, CutterSide, Delay, Delta, FeedRate, FeedUnit, Record, Rotate,
    Statement, Units,
};
use post_machine::description::{Insert, Print};
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::Pose;

use super::curves::OpenCurve;
use super::feed::FeedWord;
use super::frame::Frames;
use super::hole::ClHole;
use super::settings::ClSettings;
use super::strange::StrangeWords;
use super::tools::ClTools;
use super::turned::ArcTurnRule;
use crate::course::{CourseItem, CoursePiece, Curve, ReachedPose};
use crate::{Coolants, MotionKind, ProgramEvent, SpindleState};

/// No machine reaches a coordinate beyond this: ten kilometres, mm.
pub(super) const FARTHEST: f64 = 1e7;

/// Lengths of what has a direction.
pub(super) const DIRECTIONS: Range<f64> = 1e-6..1e9;

/// Lines of the user's own that are known by their text: a file may come from a stranger.
const OWN_LINES: usize = 10_000;

/// What a record means, or what is wrong with it.
pub(super) type RecordResult = Result<(), Box<Diagnostic>>;

/// Items that a record means, in order.
pub(super) type CourseItems = VecDeque<CourseItem>;

/// A cycle that acts at each point, and its feed; none follows from what the file says.
#[derive(Clone, Copy, Debug)]
pub(super) struct ActiveCycle {
    pub(super) hole: ClHole,
    pub(super) feed: Option<FeedWord>,
}

/// How the tool goes: at rapid, at feed or as a thread, and its feed, mm/min, as far as that is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionFeed {
    pub(super) kind: MotionKind,
    pub(super) feed: Option<f64>,
}

impl MotionFeed {
    pub(super) const RAPID: Self = Self { kind: MotionKind::Rapid, feed: None };
}

/// What is modal in a CL file.
#[derive(Debug)]
pub(super) struct ClModal {
    pub(super) settings: ClSettings,
    /// Texts of the file that are lines of the program, each once.
    pub(super) own_lines: BTreeSet<String>,
    /// As they were told, for the files behind the first.
    told: ClSettings,
    /// Files behind the first that are begun.
    files_begun: usize,
    /// Lines before the next of them.
    next_file: Option<u64>,
    /// Units that the file names.
    pub(super) units: Option<Units>,
    /// mm in one unit of the file.
    pub(super) scale: f64,
    /// A number that the units gave its meaning was read.
    pub(super) measured: bool,
    pub(super) frames: Frames,
    /// Tool axis, frame of the file.
    pub(super) axis: Vector3<f64>,
    /// Leading edge, frame of the file; zero until the file gives one.
    pub(super) edge: Vector3<f64>,
    /// `TLAXIS`, part frame.
    told_axis: Option<Vector3<f64>>,
    /// An index move came since the last point.
    pub(super) indexed: bool,
    /// Where the tool stands, part frame; none if nobody knows.
    pub(super) stands: Option<Pose>,
    /// It was said to stand there (`FROM`), and has not come there by the file's own points.
    pub(super) only_said: bool,
    /// `RAPID`: the next point.
    pub(super) rapid: bool,
    /// `FEDRAT/RAPID`: all points until the next feed.
    pub(super) rapid_feed: bool,
    pub(super) feed: Option<FeedWord>,
    pub(super) pending: Option<OpenCurve>,
    pub(super) cycle: Option<ActiveCycle>,
    pub(super) last_cycle: Option<ActiveCycle>,
    pub(super) tools: ClTools,
    coolant: Coolants,
    side: Option<CutterSide>,
    register: Option<u32>,
    pub(super) compensated: bool,
    offset: Option<u32>,
    /// `INDIRV`, frame of the file.
    pub(super) set_out: Option<Vector3<f64>>,
    /// Normal of the plane that the tip stays in along a curve, frame of the file.
    pub(super) surface: Option<Vector3<f64>>,
    pub(super) arc_rule: ArcTurnRule,
    pub(super) strange: StrangeWords,
    pub(super) finished: bool,
}

impl ClModal {
    pub(super) fn new(settings: ClSettings) -> Self {
        Self {
            own_lines: BTreeSet::new(),
            scale: settings.units.map_or(1.0, millimetres),
            frames: Frames::new(settings.turn),
            files_begun: 0,
            next_file: settings.further.first().map(|file| file.before),
            told: settings.clone(),
            settings,
            units: None,
            measured: false,
            axis: Vector3::z(),
            edge: Vector3::zeros(),
            told_axis: None,
            indexed: false,
            stands: None,
            only_said: false,
            rapid: false,
            rapid_feed: false,
            feed: None,
            pending: None,
            cycle: None,
            last_cycle: None,
            tools: ClTools::default(),
            coolant: Coolants::default(),
            side: None,
            register: None,
            compensated: false,
            offset: None,
            set_out: None,
            surface: None,
            arc_rule: ArcTurnRule::default(),
            strange: StrangeWords::default(),
            finished: false,
        }
    }

    pub(super) fn file(&self) -> &str {
        &self.settings.file
    }

    pub(super) fn tools(&self) -> &[super::ClTool] {
        self.tools.all()
    }

    /// What is left open at the end of the file.
    pub(super) fn finish(&mut self) -> RecordResult {
        if let Some(fault) = self.strange.left_over() {
            return Err(fault);
        }
        match self.pending.take() {
            None => Ok(()),
            Some(pending) => {
                let what = match pending {
                    OpenCurve::Arc(_) | OpenCurve::Turned(_) => {
                        "a CIRCLE or MOVARC that no GOTO ends"
                    }
                    OpenCurve::Spline { .. } => "a NURBS that nothing ends",
                };
                Err(Diagnostic::error("course", format!("the file ends in {what}")).boxed())
            }
        }
    }

    /// The file behind the one that is read begins: nothing modal of that holds, and spindle and coolant rest.
    fn begin_file(&mut self, record: &Record<'_>, out: &mut CourseItems) -> RecordResult {
        let ended = self.finish();
        let begun = self.files_begun + 1;
        let next = Self::new(self.told.clone());
        let before = std::mem::replace(self, next);
        self.files_begun = begun;
        self.next_file = self.told.further.get(begun).map(|file| file.before);
        self.tools = before.tools.of_next_file();
        out.push_back(CourseItem::Away { line: record.line });
        self.tell(record, ProgramEvent::Spindle(SpindleState::Off), out);
        self.tell(record, ProgramEvent::Coolant(Coolants::default()), out);
        if before.compensated {
            self.tell(record, ProgramEvent::Compensation { side: 0, register: None }, out);
        }
        ended
    }

    /// What one record means.
    pub(super) fn record(&mut self, record: &Record<'_>, out: &mut CourseItems) -> RecordResult {
        if self.next_file.is_some_and(|before| record.line >= before) {
            self.begin_file(record, out)?;
        }
        if self.finished {
            return Ok(());
        }
        match &record.statement {
            Statement::Goto { point, axis } => self.goto(record, *point, *axis, out),
            Statement::GotoEdge { point, axis, edge } => {
                self.edge = self.unit(record, *edge, "the leading edge")?;
                self.goto(record, *point, Some(*axis), out)
            }
            Statement::Godlta(delta) => self.godlta(record, *delta, out),
            Statement::From { point, axis } => self.from(record, *point, *axis),
            Statement::Gohome(home) => self.gohome(record, *home, out),
            Statement::Rapid => {
                self.rapid = true;
                Ok(())
            }
            Statement::Feed(feed) => self.set_feed(record, *feed),
            Statement::Units(units) => self.set_units(record, *units),
            Statement::Multax(on) => {
                if !on {
                    self.axis = Vector3::z();
                }
                Ok(())
            }
            Statement::Msys { origin, x, y } => self.msys(record, *origin, [*x, *y]),
            Statement::Mcs { axes, origin } => self.mcs(record, axes, origin),
            Statement::SetOut(ahead) => {
                self.set_out = Some(self.unit(record, *ahead, "INDIRV")?);
                Ok(())
            }
            Statement::PartSurface(normal) => {
                let normal = normal.unwrap_or([0.0, 0.0, 1.0]);
                self.surface = Some(self.unit(record, normal, "the plane")?);
                Ok(())
            }
            Statement::AlongArc(along) => self.along_arc(record, along, out),
            Statement::Milling => {
                self.strange.mills = true;
                Ok(())
            }
            Statement::Turning => {
                self.strange.mills = false;
                Ok(())
            }
            Statement::Circle(_)
            | Statement::ArcMove(_)
            | Statement::Nurbs
            | Statement::Knot(_)
            | Statement::Control { .. } => self.curve_word(record, out),
            Statement::Cycle(cycle) => self.cycle_word(record, cycle),
            Statement::Rotate(rotate) => self.rotate(record, rotate),
            Statement::ToolAxis(axis) => self.tool_axis(record, *axis),
            Statement::EndOfPath => self.end_spline(record, out),
            Statement::Fini => {
                self.finished = true;
                self.end_spline(record, out)
            }
            Statement::Other { word, arguments, .. } => self.other(record, word, arguments),
            // Points stay where they are written: the tool's centre, or the contour.
            Statement::CutcomOnCentre(_) => Ok(()),
            Statement::Insert(text) => {
                if self.settings.insert == Insert::Literal {
                    self.own_line(text);
                }
                Ok(())
            }
            Statement::Csys(_) => Ok(()),
            // What it means for functions and operator: a match without `_` has all statements.
            _ => self.function(record, out),
        }
    }

    /// What a record means for the functions of the machine and for the operator: tools, spindle, coolant, offsets, waits,
    /// remarks.
    fn function(&mut self, record: &Record<'_>, out: &mut CourseItems) -> RecordResult {
        match &record.statement {
            Statement::Spindle(spindle) => return self.spindle(record, *spindle, out),
            // Autodesk names the kind in the record behind it.
            Statement::Coolant(CoolantWord::On) if self.strange.autodesk => {}
            Statement::Coolant(word) => return self.coolant(record, *word, out),
            Statement::LoadTool(tool) => return self.load_read(record, tool, out),
            Statement::SelectTool(number) if self.tools.loaded() != Some(*number) => {
                self.tell(record, ProgramEvent::Preselect(*number), out);
            }
            Statement::ToolData { kinds, numbers } => return self.tool_data(kinds, numbers),
            Statement::Cutter(numbers) => return self.apt_cutter(numbers),
            Statement::WorkOffset { number, set } => {
                return self.work_offset(record, *number, *set, out);
            }
            Statement::Subprogram(number)
                if !self.does_nothing("CALSUB", &[Argument::Number((*number).into())]) =>
            {
                self.lost();
                self.tell(record, ProgramEvent::Subprogram(*number), out);
            }
            Statement::Cutcom(cutcom) => return self.cutcom(record, *cutcom, out),
            Statement::Delay(delay) => self.delay(record, *delay, out),
            Statement::Stop => self.tell(record, ProgramEvent::Stop, out),
            Statement::OptionalStop => self.tell(record, ProgramEvent::OptionalStop, out),
            Statement::Sync(_) if self.settings.allows("SYNC") => {}
            Statement::Sync(mark) => {
                let wait = self.settings.wait.as_ref();
                let mark = wait.map_or_else(|| mark.clone(), |wait| wait.written(mark));
                self.tell(record, ProgramEvent::Sync(mark), out);
            }
            Statement::Head(name) => self.head(record, name, out),
            Statement::ToolPath { name, tool } => {
                self.end_spline(record, out)?;
                self.axis = Vector3::z();
                self.tools.name(tool.as_deref());
                self.tell(record, ProgramEvent::Operation(name.clone()), out);
            }
            Statement::Print(text) if self.settings.print == Print::Message => {
                self.tell(record, ProgramEvent::Message(text.clone()), out);
            }
            Statement::Print(text) if self.settings.print == Print::Literal => self.own_line(text),
            Statement::PartName(text) | Statement::Print(text) => {
                self.tell(record, ProgramEvent::Remark(text.clone()), out);
            }
            Statement::ToolName(name) => self.tools.name(Some(name)),
            Statement::Remark(text) => {
                self.strange.catia |=
                    text.trim() == "*CATIA0" || text.trim().starts_with("CATIA APT VERSION");
            }
            // A tool that is loaded already, and a subprogram that does nothing.
            Statement::SelectTool(_) | Statement::Subprogram(_) => {}
            // `record` has done these itself.
            Statement::Goto { .. }
            | Statement::GotoEdge { .. }
            | Statement::Godlta(_)
            | Statement::From { .. }
            | Statement::Gohome(_)
            | Statement::Rapid
            | Statement::Feed(_)
            | Statement::Units(_)
            | Statement::Multax(_)
            | Statement::Msys { .. }
            | Statement::Mcs { .. }
            | Statement::SetOut(_)
            | Statement::PartSurface(_)
            | Statement::AlongArc(_)
            | Statement::Milling
            | Statement::Turning
            | Statement::Circle(_)
            | Statement::ArcMove(_)
            | Statement::Nurbs
            | Statement::Knot(_)
            | Statement::Control { .. }
            | Statement::Cycle(_)
            | Statement::Rotate(_)
            | Statement::ToolAxis(_)
            | Statement::EndOfPath
            | Statement::Fini
            | Statement::Other { .. }
            | Statement::CutcomOnCentre(_)
            | Statement::Insert(_)
            | Statement::Csys(_) => {}
        }
        Ok(())
    }

    /// `FROM`: the tool stands there.
    fn from(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
    ) -> RecordResult {
        self.set_axis(record, axis)?;
        self.stands = Some(self.pose(record, point)?);
        self.only_said = true;
        Ok(())
    }

    fn set_feed(&mut self, record: &Record<'_>, feed: FeedRate) -> RecordResult {
        self.rapid_feed = feed.unit == Some(FeedUnit::Rapid);
        if !self.rapid_feed {
            self.feed = self.feed_word(record, feed)?.or(self.feed);
        }
        Ok(())
    }

    fn msys(
        &mut self,
        record: &Record<'_>,
        origin: [f64; 3],
        directions: [[f64; 3]; 2],
    ) -> RecordResult {
        let origin = self.file_point(record, origin)?;
        if !self.settings.apply_msys {
            return Ok(());
        }
        let set = self.frames.set_msys(origin, directions.map(Vector3::from));
        set.map_err(|why| self.fault(record, format!("this MSYS is no frame: {why}")))
    }

    /// `MCS` says a frame, and only the file's own is known here.
    fn mcs(&self, record: &Record<'_>, axes: &[[f64; 3]; 3], origin: &[f64; 3]) -> RecordResult {
        let turned = axes
            .iter()
            .flatten()
            .zip([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])
            .any(|(value, own)| *value != own);
        match turned || origin.iter().any(|value| *value != 0.0) {
            true => Err(self.fault(record, "MCS is a frame of its own".to_owned())),
            false => Ok(()),
        }
    }

    fn cutcom(
        &mut self,
        record: &Record<'_>,
        cutcom: Cutcom,
        out: &mut CourseItems,
    ) -> RecordResult {
        self.load_due(record, out)?;
        // ON repeats the side before, through an OFF.
        if let Some(side @ (CutterSide::Left | CutterSide::Right)) = cutcom.side {
            self.side = Some(side);
        }
        let side = match (cutcom.side, self.side) {
            (Some(CutterSide::Off), _) => 0,
            (_, Some(CutterSide::Left)) => -1,
            (_, Some(CutterSide::Right)) => 1,
            // CAMWorks says ON first, and its first side in the next record.
            _ => return Ok(()),
        };
        self.register = cutcom.register.or(self.register);
        let register = (side != 0).then(|| self.register.or(self.tools.loaded()).unwrap_or(1));
        self.compensated = side != 0;
        self.tell(record, ProgramEvent::Compensation { side, register }, out);
        Ok(())
    }

    fn tool_axis(&mut self, record: &Record<'_>, axis: [f64; 3]) -> RecordResult {
        let axis = self.unit(record, axis, "the tool axis")?;
        self.told_axis = Some(axis);
        if self.frames.turned().is_none() {
            self.axis = axis;
        }
        Ok(())
    }

    fn delay(&self, record: &Record<'_>, delay: Delay, out: &mut CourseItems) {
        let (time, revolutions) = match (delay, self.tools.rpm()) {
            (Delay::Seconds(seconds), _) => (seconds, false),
            (Delay::Revolutions(turns), Some(rpm)) => (turns * 60.0 / rpm, false),
            (Delay::Revolutions(turns), None) => (turns, true),
        };
        self.tell(record, ProgramEvent::Dwell { time, revolutions }, out);
    }

    /// A head is swapped in, and the work offset that belongs to it.
    fn head(&mut self, record: &Record<'_>, name: &str, out: &mut CourseItems) {
        self.lost();
        self.tell(record, ProgramEvent::Head(name.to_owned()), out);
        let mut offsets = self.settings.head_offsets.iter();
        if let Some((_, number)) = offsets.find(|(head, _)| head == name) {
            let number = *number;
            self.offset = Some(number);
            self.tell(record, ProgramEvent::WorkOffset(number.to_string()), out);
        }
    }

    /// The machine file has lines for the word, or the user takes it upon himself.
    fn does_nothing(&self, word: &str, arguments: &[Argument]) -> bool {
        self.has_lines(word, arguments) || self.settings.allows(word)
    }

    /// The machine file has lines for the word.
    pub(super) fn has_lines(&self, word: &str, arguments: &[Argument]) -> bool {
        let rules = &self.settings.rules;
        rules.iter().any(|rule| rule.fits(word, arguments).is_some())
    }

    /// A line of the user's own goes into the program letter for letter: it moves nothing that is known here.
    fn own_line(&mut self, text: &str) {
        if self.own_lines.len() < OWN_LINES {
            self.own_lines.insert(text.to_owned());
        }
    }

    /// Nobody knows where the tool stands from here on.
    pub(super) fn lost(&mut self) {
        self.stands = None;
        self.only_said = false;
    }

    fn goto(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
        out: &mut CourseItems,
    ) -> RecordResult {
        if self.pending.is_some() {
            self.end_spline(record, out)?;
        }
        self.set_axis(record, axis)?;
        let to = self.pose(record, point)?;
        self.arrive(record, to, out)
    }

    /// The tool goes to a pose of the part frame: along the curve that waits, into a hole, or straight.
    fn arrive(&mut self, record: &Record<'_>, to: Pose, out: &mut CourseItems) -> RecordResult {
        self.before_move(record, out)?;
        match self.pending.take() {
            Some(OpenCurve::Arc(circle)) => return self.arc(record, &circle, to, out),
            Some(OpenCurve::Turned(arc)) => {
                let circle = self.turned(record, &arc, to)?;
                return self.arc(record, &circle, to, out);
            }
            _ => {}
        }
        if let Some(cycle) = self.cycle {
            self.rapid = false;
            return self.drill(record, cycle, to, out);
        }
        let pace = self.pace(&Curve::Straight, to);
        self.go(record.line, pace, Curve::Straight, to, false, out);
        Ok(())
    }

    /// How fast the tool goes next, and its feed.
    pub(super) fn pace(&mut self, curve: &Curve, to: Pose) -> MotionFeed {
        if std::mem::take(&mut self.rapid) || self.rapid_feed {
            return MotionFeed::RAPID;
        }
        if self.feed.is_none() && self.settings.feed.is_none() && self.stands.is_none() {
            return MotionFeed::RAPID;
        }
        let feed = match self.feed {
            Some(word) => self.per_minute(word, || self.way(curve, to)),
            None => self.settings.feed,
        };
        MotionFeed { kind: MotionKind::Feed, feed }
    }

    /// [`ClModal::pace`] of a curve that ended before the record that a `RAPID` in front of it is meant for.
    pub(super) fn pace_behind(&mut self, curve: &Curve, to: Pose) -> MotionFeed {
        let rapid = std::mem::take(&mut self.rapid);
        let pace = self.pace(curve, to);
        self.rapid = rapid;
        pace
    }

    /// Compensation begins anew with each tool.
    pub(super) fn forget_register(&mut self) {
        self.register = None;
    }

    /// The register of the radius that a tool change names.
    pub(super) fn use_register(&mut self, register: Option<u32>) {
        self.register = register.or(self.register);
    }

    /// The way to a pose, mm; of the first point of all none.
    fn way(&self, curve: &Curve, to: Pose) -> Option<f64> {
        let from = self.stands?;
        let piece = CoursePiece {
            line: 0,
            kind: MotionKind::Feed,
            curve: curve.clone(),
            from,
            to,
            feed: None,
            turned_feed: None,
            hole: false,
        };
        Some(piece.length())
    }

    /// The tool goes along `curve` to a pose; from nowhere it reaches it.
    pub(super) fn go(
        &mut self,
        line: u64,
        pace: MotionFeed,
        curve: Curve,
        to: Pose,
        hole: bool,
        out: &mut CourseItems,
    ) {
        let MotionFeed { kind, feed } = pace;
        let turned_feed = match (kind, self.feed) {
            (MotionKind::Feed, Some(FeedWord::PerRevolution(turned))) if !hole => {
                Some(turned).filter(|_| self.tools.rpm().is_none())
            }
            _ => None,
        };
        self.measured = true;
        self.strange.moved = true;
        let known = !(self.only_said && curve == Curve::Straight);
        let item = match self.stands.filter(|_| known) {
            Some(from) => {
                let piece = CoursePiece { line, kind, curve, from, to, feed, turned_feed, hole };
                CourseItem::Piece(piece)
            }
            None => CourseItem::Reach(ReachedPose { line, kind, to, feed, hole }),
        };
        self.stands = Some(to);
        self.only_said = false;
        out.push_back(item);
    }

    /// What is seen to before a point: index moves that disagree, a tool that is named outside the file.
    pub(super) fn before_move(
        &mut self,
        record: &Record<'_>,
        out: &mut CourseItems,
    ) -> RecordResult {
        if let Some(fault) = self.strange.between_moves() {
            return Err(fault);
        }
        if self.set_out.take().is_some() {
            let message = "INDIRV sets out along a curve, and no TLON follows it";
            return Err(self.fault(record, message.to_owned()));
        }
        if std::mem::take(&mut self.indexed)
            && let (Some(turned), Some(told)) = (self.frames.turned(), self.told_axis)
            && (turned * self.axis - told).norm() > 1e-3
        {
            return Err(self.fault(
                record,
                "ROTABL does not turn the tool to the axis that TLAXIS names".to_owned(),
            ));
        }
        self.load_due(record, out)?;
        self.spindle_due(record, out);
        Ok(())
    }

    fn godlta(&mut self, record: &Record<'_>, delta: Delta, out: &mut CourseItems) -> RecordResult {
        let Some(from) = self.stands else {
            let message = "GODLTA steps from the last point, and there is none";
            return Err(self.fault(record, message.to_owned()));
        };
        if self.cycle.is_some() {
            let message = "GODLTA while a cycle is on: from which of its heights?";
            return Err(self.fault(record, message.to_owned()));
        }
        self.end_spline(record, out)?;
        let axis = self.frames.direction(self.axis);
        let step = match delta {
            Delta::Step(step) => self.frames.direction(Vector3::from(step)),
            Delta::AlongAxis(length) => axis * length,
        };
        let tip = from.tip + step * self.scale;
        self.near(record, tip)?;
        let edge = self.frames.direction(self.edge);
        self.arrive(record, Pose { tip, axis, edge }, out)
    }

    fn gohome(
        &mut self,
        record: &Record<'_>,
        home: Option<([f64; 3], Option<[f64; 3]>)>,
        out: &mut CourseItems,
    ) -> RecordResult {
        self.end_spline(record, out)?;
        let Some((point, axis)) = home else {
            self.rapid = false;
            self.lost();
            out.push_back(CourseItem::Away { line: record.line });
            return Ok(());
        };
        self.rapid = true;
        // A cycle does not act at home.
        let cycle = self.cycle.take();
        let done = self.goto(record, point, axis, out);
        self.cycle = cycle;
        done
    }

    fn rotate(&mut self, record: &Record<'_>, rotate: &Rotate) -> RecordResult {
        if self.frames.sits_turned() {
            let message = "the angles of this index move are those of a part that is not turned, and here it sits turned about its Z";
            return Err(self.fault(record, message.to_owned()));
        }
        let done = self.frames.rotate(rotate);
        done.map_err(|why| self.fault(record, why.to_owned()))?;
        self.axis = match (self.frames.turned(), self.told_axis) {
            (None, Some(axis)) => axis,
            _ => Vector3::z(),
        };
        self.indexed = self.frames.turned().is_some();
        self.lost();
        Ok(())
    }

    fn coolant(
        &mut self,
        record: &Record<'_>,
        word: CoolantWord,
        out: &mut CourseItems,
    ) -> RecordResult {
        self.load_due(record, out)?;
        let none = Coolants::default();
        let flood = Coolants { flood: true, ..none };
        let coolants = match word {
            CoolantWord::Off => none,
            CoolantWord::On if self.coolant == none => flood,
            CoolantWord::On => self.coolant,
            CoolantWord::Flood => flood,
            CoolantWord::Mist => Coolants { mist: true, ..none },
            CoolantWord::Through | CoolantWord::Air => Coolants { other: true, ..none },
        };
        // ON means the kind before, through an OFF.
        if coolants != none {
            self.coolant = coolants;
        }
        self.tell(record, ProgramEvent::Coolant(coolants), out);
        Ok(())
    }

    fn set_units(&mut self, record: &Record<'_>, units: Units) -> RecordResult {
        let scale = millimetres(self.settings.units.unwrap_or(units));
        self.units = Some(units);
        if scale != self.scale && self.measured {
            self.scale = scale;
            let message = "UNITS comes after points or feeds that were read in other units";
            return Err(self.fault(record, message.to_owned()));
        }
        self.scale = scale;
        Ok(())
    }

    fn work_offset(
        &mut self,
        record: &Record<'_>,
        number: u32,
        set: bool,
        out: &mut CourseItems,
    ) -> RecordResult {
        let value = Argument::Number(number.into());
        let nothing = match set {
            true => {
                let arguments = [Argument::Word("OFSETL".to_owned()), value];
                self.does_nothing("SET", &arguments)
            }
            false => self.does_nothing("OFSETL", &[value]),
        };
        if !nothing && self.offset.replace(number) != Some(number) {
            self.lost();
            self.tell(record, ProgramEvent::WorkOffset(number.to_string()), out);
        }
        Ok(())
    }

    /// Takes the axis of a point of six numbers.
    fn set_axis(&mut self, record: &Record<'_>, axis: Option<[f64; 3]>) -> RecordResult {
        if let Some(axis) = axis {
            self.axis = self.unit(record, axis, "the tool axis")?;
        }
        Ok(())
    }

    /// A direction of the file, made one long.
    fn unit(
        &self,
        record: &Record<'_>,
        direction: [f64; 3],
        what: &str,
    ) -> Result<Vector3<f64>, Box<Diagnostic>> {
        let direction = Vector3::from(direction);
        let length = direction.norm();
        match DIRECTIONS.contains(&length) {
            true => Ok(direction / length),
            false => Err(self.fault(record, format!("{what} has no direction"))),
        }
    }

    /// A point of the file, mm.
    pub(super) fn file_point(
        &self,
        record: &Record<'_>,
        point: [f64; 3],
    ) -> Result<Vector3<f64>, Box<Diagnostic>> {
        let point = Vector3::from(point) * self.scale;
        self.near(record, point)?;
        Ok(point)
    }

    fn near(&self, record: &Record<'_>, point: Vector3<f64>) -> RecordResult {
        if point.amax() <= FARTHEST {
            return Ok(());
        }
        let message = format!("a coordinate of {:e} mm, which no machine reaches", point.amax());
        Err(self.fault(record, message))
    }

    /// A point with the axis and edge in force, part frame.
    pub(super) fn pose(
        &self,
        record: &Record<'_>,
        point: [f64; 3],
    ) -> Result<Pose, Box<Diagnostic>> {
        let point = self.file_point(record, point)?;
        Ok(Pose {
            tip: self.frames.point(point),
            axis: self.frames.direction(self.axis),
            edge: self.frames.direction(self.edge),
        })
    }

    pub(super) fn tell(&self, record: &Record<'_>, event: ProgramEvent, out: &mut CourseItems) {
        let line = record.line;
        out.push_back(CourseItem::Event { line, event });
    }

    #[cold]
    pub(super) fn fault(&self, record: &Record<'_>, message: String) -> Box<Diagnostic> {
        let text = record.text();
        let place = SourcePlace::new(&self.settings.file, record.line, &text, 0..text.len());
        Diagnostic::error("course", message).at(Some(place)).boxed()
    }
}

/// mm in one unit.
pub(super) fn millimetres(units: Units) -> f64 {
    match units {
        Units::Millimetre => 1.0,
        Units::Centimetre => 10.0,
        Units::Inch => 25.4,
        Units::Foot => 304.8,
        Units::Metre => 1000.0,
    }
}
