//! Items of a course become records of a CL file.

use std::fmt::Write;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;
use post_motion::path::{chords, piece_ends};

use super::number::{self, DIRECTION, LENGTH};
use super::records::{definition, is_nurbs, offset_number, spindle_record};
use super::text;
use crate::BSpline;
use crate::course::{CourseItem, CoursePiece, Curve, ReachedPose};
use crate::{Coolants, CycleCall, MotionKind, ProgramEvent};

/// Unit vectors nearer than this are one.
const SAME_DIRECTION: f64 = 1e-12;

/// Points nearer than this are one, mm.
const SAME_POINT: f64 = 1e-9;

/// Ends of an arc may differ by so much in their distance from its axis: readers take it as a spiral, up to 0.1 mm.
const SPIRAL: f64 = 0.09;

/// A change of the feed that is smaller is none: its share.
const SAME_FEED: f64 = 1e-9;

/// Shares of a spline or of an arc that turns the tool, tried at most for chords that are near enough.
const MOST_CHORDS: u64 = 1 << 20;

/// The tool in the spindle, as the control counts it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MountedTool {
    /// Register of its length.
    pub register: Option<u32>,
    /// Its length, mm.
    pub length: Option<f64>,
}

/// Writes a CL file.
///
/// The text grows in `out` of the methods; whoever calls them takes it away as he likes, so that memory does not grow with
/// the program.
#[derive(Debug)]
pub struct ClWriter {
    /// How far chords may stray where no record has the curve, mm.
    chord: f64,
    /// What waits for the next motion: the tool's length is known only then.
    waiting: Vec<(u64, ProgramEvent)>,
    /// A tool change waits.
    changes: bool,
    /// The tool left the part.
    away: bool,
    /// Some point was written.
    moved: bool,
    /// Tool axis as a reader has it.
    axis: Vector3<f64>,
    edge: bool,
    feed: Option<f64>,
    /// Where the last point written stands.
    stands: Option<Pose>,
    /// A cycle's hole: its call, the deepest point so far, and whether the tool was above it before.
    hole: Option<(CycleCall, Option<Pose>)>,
    /// The definition in force.
    cycle: Option<String>,
    /// An operation is open.
    operation: bool,
    /// The operation that begins with the next record, which may name its tool.
    begins: Option<String>,
    work_offset: Option<String>,
    /// Numbers of tools that have names alone, by the order in which they came.
    names: Vec<String>,
    last_tool: Option<(u32, MountedTool)>,
    notes: Vec<Diagnostic>,
    ended: bool,
}

impl ClWriter {
    /// Nothing written. Chords stay within `chord` mm where no record has the curve.
    pub fn new(chord: f64) -> Self {
        Self {
            chord,
            waiting: Vec::new(),
            changes: false,
            away: false,
            moved: false,
            axis: Vector3::z(),
            edge: false,
            feed: None,
            stands: None,
            hole: None,
            cycle: None,
            operation: false,
            begins: None,
            work_offset: None,
            names: Vec::new(),
            last_tool: None,
            notes: Vec::new(),
            ended: false,
        }
    }

    /// What was taken for granted or could not be kept.
    pub fn notes(&self) -> &[Diagnostic] {
        &self.notes
    }

    /// The first records.
    pub fn begin(&self, part: &str, out: &mut String) {
        let _ = writeln!(out, "PARTNO {}\nUNITS/MM\nMULTAX/ON", text::free(part));
    }

    /// The last records.
    pub fn end(&mut self, out: &mut String) {
        for (_, event) in std::mem::take(&mut self.waiting) {
            match event {
                // A tool that does nothing is not loaded.
                ProgramEvent::ToolChange { .. } | ProgramEvent::Preselect(_) => {}
                event => self.write_event(event, MountedTool::default(), out),
            }
        }
        self.end_cycle(out);
        self.end_operation(out);
        out.push_str("FINI\n");
    }

    /// One item. `tool` is what the control counts the tool in the spindle as while it lasts.
    ///
    /// # Errors
    /// What no record can ask for.
    pub fn item(
        &mut self,
        item: &CourseItem,
        tool: MountedTool,
        out: &mut String,
    ) -> Result<(), Box<Diagnostic>> {
        if self.ended {
            return Ok(());
        }
        match item {
            CourseItem::Away { .. } => {
                self.away = self.moved;
                Ok(())
            }
            CourseItem::Event { line, event } => self.take_event(*line, event, tool, out),
            CourseItem::Reach(reach) => {
                self.settle(tool, out);
                self.reach(reach, out);
                Ok(())
            }
            CourseItem::Piece(piece) => {
                self.settle(tool, out);
                self.piece(piece, out)
            }
        }
    }

    fn take_event(
        &mut self,
        line: u64,
        event: &ProgramEvent,
        tool: MountedTool,
        out: &mut String,
    ) -> Result<(), Box<Diagnostic>> {
        match event {
            ProgramEvent::Cycle(call) => {
                self.settle(tool, out);
                self.hole = Some((*call, None));
                return Ok(());
            }
            ProgramEvent::CycleEnd => return self.end_hole(line, out),
            ProgramEvent::Dwell { .. } if self.hole.is_some() => return Ok(()),
            ProgramEvent::ToolChange { .. } => {
                // The frame of the other machine goes round a tool change by itself.
                self.away = false;
                self.changes = true;
            }
            ProgramEvent::End => {
                self.ended = true;
                return Ok(());
            }
            ProgramEvent::Sync(mark) if !mark.channels.is_empty() => {
                let message = format!("{mark}: SYNC/{} waits for all channels", mark.number);
                self.notes.push(Diagnostic::warning("convert", message));
            }
            ProgramEvent::Unknown(word) => {
                let message = format!("{word} is not carried over: nobody knows what it does");
                self.notes.push(Diagnostic::warning("convert", message));
                return Ok(());
            }
            _ => {}
        }
        if self.changes {
            self.waiting.push((line, event.clone()));
        } else {
            self.write_event(event.clone(), tool, out);
        }
        Ok(())
    }

    /// A motion follows: what waited for it is written, the tool change first.
    fn settle(&mut self, tool: MountedTool, out: &mut String) {
        let waiting = std::mem::take(&mut self.waiting);
        // The last tool that came into the spindle cuts.
        let change =
            waiting.iter().rposition(|(_, event)| matches!(event, ProgramEvent::ToolChange { .. }));
        for (place, (_, event)) in waiting.into_iter().enumerate() {
            match event {
                ProgramEvent::ToolChange { .. } if Some(place) != change => {}
                event => self.write_event(event, tool, out),
            }
        }
        self.changes = false;
        self.open_operation(None, out);
        if std::mem::take(&mut self.away) {
            self.end_cycle(out);
            out.push_str("GOHOME\n");
            self.stands = None;
        }
    }

    fn write_event(&mut self, event: ProgramEvent, tool: MountedTool, out: &mut String) {
        if !matches!(event, ProgramEvent::Operation(_) | ProgramEvent::ToolChange { .. }) {
            self.open_operation(None, out);
        }
        match event {
            ProgramEvent::ToolChange { number, name } => self.load(number, name, tool, out),
            ProgramEvent::Preselect(number) => {
                let _ = writeln!(out, "SELECT/TOOL,{number}");
            }
            ProgramEvent::Spindle(spindle) => spindle_record(spindle, out),
            ProgramEvent::Coolant(coolants) => {
                let Coolants { flood, mist, other } = coolants;
                out.push_str(match (flood, mist, other) {
                    (false, false, false) => "COOLNT/OFF\n",
                    (true, ..) => "COOLNT/FLOOD\n",
                    (_, true, _) => "COOLNT/MIST\n",
                    (_, _, true) => "COOLNT/THRU\n",
                });
            }
            ProgramEvent::Dwell { time, revolutions } => {
                out.push_str("DELAY/");
                number::write(out, time, LENGTH);
                out.push_str(if revolutions { ",REV\n" } else { "\n" });
            }
            ProgramEvent::Stop => out.push_str("STOP\n"),
            ProgramEvent::Sync(mark) => {
                let _ = writeln!(out, "SYNC/{}", mark.number);
            }
            ProgramEvent::OptionalStop => out.push_str("OPSTOP\n"),
            ProgramEvent::Operation(name) => self.begins = Some(name),
            ProgramEvent::Remark(remark) | ProgramEvent::Message(remark) => {
                let remark = text::free(&remark);
                if !remark.is_empty() {
                    let _ = writeln!(out, "PPRINT {remark}");
                }
            }
            ProgramEvent::Compensation { side, register } => {
                let side = match side {
                    0 => "OFF",
                    ..0 => "LEFT",
                    _ => "RIGHT",
                };
                let _ = match register.filter(|_| side != "OFF") {
                    Some(register) => writeln!(out, "CUTCOM/{side},XYPLAN,{register}"),
                    None => writeln!(out, "CUTCOM/{side}"),
                };
            }
            ProgramEvent::WorkOffset(name) => self.offset(name, out),
            ProgramEvent::Head(name) => {
                let _ = writeln!(out, "HEAD/{}", text::name(&name));
                self.stands = None;
            }
            ProgramEvent::Subprogram(number) => {
                let _ = writeln!(out, "CALSUB/{number}");
                self.stands = None;
            }
            // Taken apart before.
            ProgramEvent::Cycle(_)
            | ProgramEvent::CycleEnd
            | ProgramEvent::Unknown(_)
            | ProgramEvent::End => {}
        }
    }

    /// Begins the operation that waits, with the name of its tool; where none waits, that name alone.
    fn open_operation(&mut self, tool: Option<&str>, out: &mut String) {
        let Some(name) = self.begins.take() else {
            if let Some(tool) = tool {
                self.end_cycle(out);
                let _ = writeln!(out, "TPRINT/{}", text::name(tool));
            }
            return;
        };
        self.end_cycle(out);
        self.end_operation(out);
        let _ = write!(out, "TOOL PATH/{}", text::name(&name));
        if let Some(tool) = tool {
            let _ = write!(out, ",TOOL,{}", text::name(tool));
        }
        out.push('\n');
        self.operation = true;
        self.axis = Vector3::z();
    }

    fn load(
        &mut self,
        number: Option<u32>,
        name: Option<String>,
        tool: MountedTool,
        out: &mut String,
    ) {
        let number = number.unwrap_or_else(|| {
            let name = name.clone().unwrap_or_default();
            let known = self.names.iter().position(|known| *known == name);
            let place = known.unwrap_or(self.names.len());
            if known.is_none() {
                let message = format!("tool {name:?} has no number and becomes tool {}", place + 1);
                self.notes.push(Diagnostic::warning("convert", message));
                self.names.push(name);
            }
            place as u32 + 1
        });
        if number == 0 {
            let message = "tool 0 is no tool: what is cut behind it is cut with the one before";
            self.notes.push(Diagnostic::warning("convert", message));
            return;
        }
        if self.last_tool.replace((number, tool)) == Some((number, tool)) {
            return;
        }
        self.open_operation(name.as_deref().filter(|name| !name.is_empty()), out);
        self.end_cycle(out);
        let _ = write!(out, "LOADTL/{number}");
        if let Some(register) =
            tool.register.filter(|register| *register != number && *register > 0)
        {
            let _ = write!(out, ",ADJUST,{register}");
        }
        if let Some(length) = tool.length {
            out.push_str(",LENGTH,");
            number::write(out, length, LENGTH);
        }
        out.push('\n');
        self.stands = None;
    }

    /// A work offset. The first of a program is the one that the other machine begins with.
    fn offset(&mut self, name: String, out: &mut String) {
        let before = self.work_offset.replace(name.clone());
        if before.as_ref() == Some(&name) || (before.is_none() && !self.moved) {
            return;
        }
        match offset_number(&name) {
            Some(number) => {
                let _ = writeln!(out, "OFSETL/{number}");
                self.stands = None;
            }
            None => {
                let message =
                    format!("{name} is not carried over: it has no number among work offsets");
                self.notes.push(Diagnostic::warning("convert", message));
            }
        }
    }

    fn reach(&mut self, reach: &ReachedPose, out: &mut String) {
        // A hole's approach is the cycle's own.
        if self.hole.is_some() {
            return;
        }
        self.end_cycle(out);
        self.point(MotionKind::Rapid, None, &reach.to, out);
    }

    fn piece(&mut self, piece: &CoursePiece, out: &mut String) -> Result<(), Box<Diagnostic>> {
        if let Some((_, deepest)) = &mut self.hole {
            for pose in [&piece.from, &piece.to] {
                let lower = |deepest: &Pose| pose.axis.dot(&(pose.tip - deepest.tip)) < 0.0;
                if deepest.as_ref().is_none_or(lower) {
                    *deepest = Some(*pose);
                }
            }
            self.stands = Some(piece.to);
            return Ok(());
        }
        self.end_cycle(out);
        if piece.kind == MotionKind::Thread {
            let message =
                "a thread that is no cycle's: no record of a CL file ties a feed to the spindle";
            return Err(Diagnostic::error("convert", message).boxed());
        }
        let feed = piece.feed;
        let stays = (piece.from.axis - piece.to.axis).norm() < SAME_DIRECTION;
        match &piece.curve {
            Curve::Straight => self.point(piece.kind, feed, &piece.to, out),
            Curve::Arc { centre, normal, sweep }
                if stays && self.arc_fits(piece, *centre, *normal) =>
            {
                self.feed(piece.kind, feed, out);
                self.arc(piece, *centre, *normal, *sweep, out);
            }
            Curve::Spline(way) if stays && is_nurbs(way) && self.at(&piece.from) => {
                self.feed(piece.kind, feed, out);
                self.spline(way, out);
                self.stands = Some(piece.to);
            }
            Curve::Arc { .. } | Curve::Spline(_) => self.chords(piece, out),
        }
        Ok(())
    }

    /// A reader knows that the tool stands here.
    fn at(&self, pose: &Pose) -> bool {
        self.stands.is_some_and(|stands| (stands.tip - pose.tip).norm() < SAME_POINT)
    }

    /// A `CIRCLE` says this arc: it starts where the tool stands, and both ends are equally far from its axis, or nearly.
    fn arc_fits(&self, piece: &CoursePiece, centre: Vector3<f64>, normal: Vector3<f64>) -> bool {
        let radius = |tip: Vector3<f64>| normal.cross(&(tip - centre)).norm();
        let (from, to) = (radius(piece.from.tip), radius(piece.to.tip));
        self.at(&piece.from) && libm::fabs(from - to) <= SPIRAL && from > SAME_POINT
    }

    fn arc(
        &mut self,
        piece: &CoursePiece,
        centre: Vector3<f64>,
        normal: Vector3<f64>,
        sweep: f64,
        out: &mut String,
    ) {
        // A reader takes ends that nearly meet for a whole turn, and less than a turn else.
        let turns = libm::ceil(sweep / std::f64::consts::TAU - 1e-6).max(1.0);
        let radius = normal.cross(&(piece.from.tip - centre)).norm();
        out.push_str("CIRCLE/");
        number::write_all(out, centre.iter(), LENGTH);
        out.push(',');
        number::write_all(out, normal.iter(), DIRECTION);
        out.push(',');
        number::write(out, radius, LENGTH);
        if turns > 1.0 {
            let _ = write!(out, ",TIMES,{turns}");
        }
        out.push('\n');
        self.goto(&piece.to, out);
    }

    fn spline(&mut self, way: &BSpline, out: &mut String) {
        out.push_str("NURBS\nKNOT/");
        let [first, last] = way.range();
        let inner = way.knots[way.degree + 1..way.poles.len()].iter();
        let knots: Vec<f64> =
            inner.map(|knot| (knot - first) / (last - first)).chain([1.0]).collect();
        // A knot has no unit: all of its digits are written.
        for (place, knot) in knots.iter().enumerate() {
            let _ = write!(out, "{}{knot}", if place > 0 { "," } else { "" });
        }
        out.push('\n');
        for (pole, _) in &way.poles[1..] {
            out.push_str("CNTRL/");
            number::write_all(out, pole.iter(), LENGTH);
            out.push('\n');
        }
    }

    /// Points on a curve that no record has, so many that chords stay near enough as far as points between tell.
    fn chords(&mut self, piece: &CoursePiece, out: &mut String) {
        let first = match &piece.curve {
            Curve::Spline(way) => (2 * way.poles.len() as u64).min(MOST_CHORDS),
            _ => 4,
        };
        let count = chords(first, MOST_CHORDS, self.chord, |t| piece.at(t, 0.0).tip);
        for to in piece_ends(count, piece.to, |t| piece.at(t, 0.0)) {
            self.point(piece.kind, piece.feed, &to, out);
        }
    }

    /// A straight way to a point; nothing if the tool stands there.
    fn point(&mut self, kind: MotionKind, feed: Option<f64>, to: &Pose, out: &mut String) {
        let turns =
            self.stands.is_some_and(|stands| (stands.axis - to.axis).norm() >= SAME_DIRECTION);
        if self.at(to) && !turns {
            return;
        }
        self.feed(kind, feed, out);
        self.goto(to, out);
    }

    fn feed(&mut self, kind: MotionKind, feed: Option<f64>, out: &mut String) {
        if kind == MotionKind::Rapid {
            out.push_str("RAPID\n");
            return;
        }
        let Some(feed) = feed else { return };
        let same = |before: f64| libm::fabs(before - feed) <= SAME_FEED * feed;
        if !self.feed.is_some_and(same) {
            out.push_str("FEDRAT/MMPM,");
            number::write(out, feed, LENGTH);
            out.push('\n');
            self.feed = Some(feed);
        }
    }

    fn goto(&mut self, to: &Pose, out: &mut String) {
        out.push_str("GOTO/");
        number::write_all(out, to.tip.iter(), LENGTH);
        let edge = to.edge != Vector3::zeros();
        if edge || self.edge || (to.axis - self.axis).amax() >= SAME_DIRECTION {
            out.push(',');
            number::write_all(out, to.axis.iter(), DIRECTION);
            self.axis = to.axis;
        }
        if edge {
            out.push(',');
            number::write_all(out, to.edge.iter(), DIRECTION);
            self.edge = true;
        }
        out.push('\n');
        self.stands = Some(*to);
        self.moved = true;
    }

    /// The hole's moves are done: the cycle that asks for them.
    fn end_hole(&mut self, line: u64, out: &mut String) -> Result<(), Box<Diagnostic>> {
        let (Some((call, Some(bottom))), Some(up)) = (self.hole.take(), self.stands) else {
            return Ok(());
        };
        let height = |pose: &Pose| bottom.axis.dot(&(pose.tip - bottom.tip));
        let clearance = call.clearance.max(0.0);
        let depth = call.depth - clearance;
        let level = (height(&up) - depth).max(clearance);
        let definition = definition(&call, depth, clearance, level).map_err(|message| {
            Diagnostic::error("convert", format!("line {line}: {message}")).boxed()
        })?;
        if self.cycle.as_ref() != Some(&definition) {
            out.push_str(&definition);
            self.cycle = Some(definition);
        }
        let point = Pose { tip: bottom.tip + bottom.axis * depth, ..bottom };
        self.goto(&point, out);
        self.stands = Some(up);
        Ok(())
    }

    fn end_cycle(&mut self, out: &mut String) {
        if self.cycle.take().is_some() {
            out.push_str("CYCLE/OFF\n");
        }
    }

    fn end_operation(&mut self, out: &mut String) {
        if std::mem::take(&mut self.operation) {
            out.push_str("END-OF-PATH\n");
        }
    }
}
