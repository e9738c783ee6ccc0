//! A program held against a course: does the machine do what was asked?
//!
//! Both are chains of short straight pieces (`chop`) in the space of tip and tool axis. A program keeps to a course if
//! one can go along both, never back, and never be farther apart than the tolerance: their Fréchet distance. That is
//! decided block by block (`sweep`): what is kept is where on the course one can stand now. It empties at the first
//! block that strays, that has no place on the course, or that comes out of turn. This proves more than a comparison of
//! end points or of nearest distances: neither sees that a path is cut twice, backwards, or not at all.
//!
//! Rapids are free but for what matters of them (`rapid`, `near`, `fed_rapid`, `next_cut`): they lead from where a cut
//! ends to where the next begins, past the points that the course asks for, in their order. A cut may be left for a
//! while, if it goes on where it was left. In a hole the control pecks as it likes (`hole`), but in no larger pecks
//! than asked for: the bottom is reached at feed, and no rapid goes where nothing was cut.
//!
//! Memory does not grow with the program: of the course only what the program may stand at is kept.

mod axes;
mod chop;
mod cut_bounds;
mod cut_path;
mod detour;
mod edge;
mod fed_rapid;
mod feed;
mod feed_sum;
mod hole;
mod left_on;
mod limits;
mod near;
mod next_cut;
mod octree;
mod offset_use;
mod place;
mod quick;
mod rapid;
mod report;
mod retract;
mod state;
mod sweep;
mod track;

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::{Machine, Rapid};
use post_machine::diagnostic::{Severity, SourceFiles};
use post_machine::kinematics::Joints;
use post_plugin::Lengths;

use crate::course::Course;
use crate::{
    BlockEffect, CycleKind, Leeway, MOST_FAULTS, MachineState, Motion, MotionKind, Offsets,
    ProgramEvent, SpindleState,
};
pub use axes::{AxisFault, AxisLimitCheck};
pub use cut_bounds::CutBounds;
pub use cut_path::CutPath;
use detour::Detour;
use hole::{DrilledHole, HoleRun};
use left_on::RunningFunctions;
pub use limits::{LimitCheck, PassedLimit};
use offset_use::OffsetUse;
use place::{PlaceBound, PlaceDistance, ShareSpan, ToolPlace};
use quick::QuickStand;
use report::BlockPlace;
pub use report::{BlockReport, Fault, LeftOn, Verification, WorstDeviation};
use sweep::StrayStretch;
use track::{CourseTrack, CutState, ElementKind};

/// What a program is held to.
#[derive(Clone, Debug, PartialEq)]
pub struct VerifyRules {
    /// Largest deviation of the tip in a cut, mm.
    pub tolerance: f64,
    /// Largest deviation of the tool axis in a cut, radians.
    pub axis_tolerance: f64,
    /// Largest distance at which a rapid passes a point that it is to pass, mm.
    pub rapid_tolerance: f64,
    /// Where the length of the tool comes from, which must be in force in a cut.
    pub length_from: Lengths,
    /// Length register that belongs to a tool where it is not the tool's number.
    pub tool_registers: Vec<(u32, u32)>,
    /// Where each work offset lies is stated: motions tell whether the right one is in force.
    pub work_offsets: bool,
    /// A contour is compensated by the radius in a register, D.
    pub radius_registers: bool,
    /// The work offset of a program whose CL file names none; none: it is the program's own business.
    pub work_offset: Option<String>,
    /// Number of the row of Heidenhain's presets that is the first work offset.
    pub first_preset: u32,
    /// How long the tools are; none where lengths lie in the work offset.
    pub lengths: Option<Offsets>,
    /// A feed by time cannot be so large that a block takes less than this, minutes.
    pub least_minutes: f64,
    /// A rapid may be made at the highest feed that its axes hold ([`Machine::rapid`]).
    pub linear_rapids: bool,
    /// F of every rapid, mm/min, where G0 goes at F; none elsewhere.
    pub rapid_feed: Option<f64>,
    /// The last place of a printed feed, mm/min: it is rounded down.
    pub feed_place: f64,
    /// The last place of a printed F by time, 1/min.
    pub time_place: f64,
    /// The feed was planned: it may be below that of the CL file, whatever for.
    pub planned: bool,
    /// Coolants are compared; else which of them flows is the program's own business.
    pub coolants: bool,
    /// The program was posted for this machine file, and is held to what posting promises of rapids besides: what that
    /// is says `retract` and `detour`. A program of another hand leads the tool off the part as it likes.
    pub own: bool,
    /// Stops and waits that lines of the user's own write, in the machine file and letter for letter in the CL file: they
    /// come where the user has them.
    pub own_stops: OwnStops,
    /// Each line of the program is told with the solution that it ends in.
    pub solutions: bool,
    /// Each line of the program is told with its deviations; else some are told without.
    pub rows: bool,
    /// The files of the course: what messages call its lines.
    pub files: SourceFiles,
    /// Most faults that are told apart; then the check is given up.
    pub most_faults: usize,
}

/// Which stops and waits lines of the user's own write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OwnStops {
    /// A stop: M0.
    pub stop: bool,
    /// An optional stop: M1.
    pub optional: bool,
    /// A wait: G4.
    pub dwell: bool,
}

impl OwnStops {
    /// Whether `event` may come from such a line.
    fn may_be(self, event: &ProgramEvent) -> bool {
        match event {
            ProgramEvent::Stop => self.stop,
            ProgramEvent::OptionalStop => self.optional,
            ProgramEvent::Dwell { .. } => self.dwell,
            _ => false,
        }
    }
}

impl VerifyRules {
    /// Rules of a machine file.
    pub fn of(machine: &Machine) -> Self {
        Self {
            tolerance: machine.accuracy.tolerance,
            axis_tolerance: machine.accuracy.axis_tolerance,
            rapid_tolerance: machine.accuracy.rapid_tolerance,
            length_from: Lengths::Tools,
            tool_registers: Vec::new(),
            work_offsets: false,
            radius_registers: false,
            work_offset: None,
            first_preset: 1,
            lengths: None,
            least_minutes: 0.0,
            linear_rapids: machine.rapid(false) == Rapid::Linear,
            rapid_feed: None,
            feed_place: 0.0,
            time_place: 0.0,
            planned: false,
            files: SourceFiles::default(),
            coolants: true,
            own: false,
            own_stops: OwnStops::default(),
            solutions: false,
            rows: true,
            most_faults: MOST_FAULTS,
        }
    }
}

/// Ways are cut into pieces that stray by no more than this share of the tolerance from straight ones.
const SAG: f64 = 1.0 / 64.0;

/// Numbers of two programs come out of different computations: mm and radians.
const COMPUTED: f64 = 1e-6;

/// Angle by which the tool axis may be off where a rapid passes a point of the course, radians.
const RAPID_TURN: f64 = 1.0 / 180.0 * PI;

/// A command of the spindle.
#[derive(Clone, Copy, Debug)]
struct SpindleCommand {
    spindle: SpindleState,
    /// Line of the program.
    line: u64,
    /// The next came before anything moved: S and M3 in blocks of their own are one command.
    passing: bool,
}

/// Holds a program against a course, motion by motion.
#[derive(Debug)]
pub struct Verifier<'m, C> {
    machine: &'m Machine,
    /// Two linear axes place the tip, with a rotary one.
    planar: bool,
    /// Rotary axes that carry the tool place the tip.
    arm: bool,
    rules: VerifyRules,
    /// How far the guided point stands above the tip, mm.
    along: f64,
    sag: PlaceBound,
    rapid_sag: PlaceBound,
    bound: PlaceBound,
    rapid_bound: PlaceBound,
    track: CourseTrack<C>,
    /// Places on each element of the track where the program may stand.
    reach: Vec<ShareSpan>,
    quick: QuickStand,
    /// The element that a rapid may come to next; all before it were passed.
    next: Option<usize>,
    /// The tool has moved at rapid since the last cut, or not cut yet.
    apart: bool,
    stray: Option<StrayStretch>,
    /// How often a motion went farther off than the stretch before it.
    widened: u32,
    hole: Option<HoleRun>,
    made: Option<DrilledHole>,
    /// The cycle of the program that is on.
    cycle: Option<CycleKind>,
    /// Where the course cuts.
    cut_path: CutPath,
    /// Where the last cut ended, as long as the tool was drawn back from there alone.
    cut_end: Option<ToolPlace>,
    /// The tool has come to a point of the course.
    placed: bool,
    /// The course's own rapids that the motion at hand has passed: from where to where, mm.
    passed: Vec<[Vector3<f64>; 2]>,
    /// Ends of the pieces of the motion at hand, its beginning first.
    places: Vec<ToolPlace>,
    last_end: chop::LastEnd,
    spare: Vec<ShareSpan>,
    /// The last two ways of the course in two directions that were left behind, where an edge is headed along them.
    ways_behind: [Option<edge::TravelWay>; 2],
    /// Where the program could stand as the cut at hand began.
    begun: Vec<ShareSpan>,
    /// What the spindle was told since the tool came or since it was compared.
    turned: Vec<SpindleCommand>,
    /// Whether the program has moved since the last command of the spindle.
    moved: bool,
    /// How far the control may leave the path, as it was looked at last.
    smoothing: Leeway,
    /// The work offsets that were cut in, each by the number that the course asks for.
    worked: Vec<(Option<u32>, String)>,
    /// Work offsets that the program moves in.
    offset_use: OffsetUse,
    detour: Detour,
    running: RunningFunctions,
    /// What held and what was asked in the last cut that was compared, if nothing was wrong with it.
    agreed: Option<(Arc<MachineState>, Arc<CutState>)>,
    /// Faults that were told, those that are counted alone among them.
    told: u64,
    /// Where the axes stand; none: nothing has moved.
    stands: Option<Joints>,
    axes: AxisLimitCheck,
    /// Times of short blocks since the cut began.
    feeds: feed_sum::FeedSum,
    limits: LimitCheck,
    block: BlockReport,
    found: Verification,
}

impl<'m, C: Course> Verifier<'m, C> {
    /// A program of `machine` against `course`.
    pub fn new(machine: &'m Machine, rules: VerifyRules, course: C) -> Self {
        let along = machine.control_point.along;
        let sag = PlaceBound::new(rules.tolerance * SAG, rules.axis_tolerance * SAG);
        let widened = |mm: f64, angle: f64| {
            let bound = PlaceBound::new(mm + COMPUTED, angle + COMPUTED);
            // Both sides are cut into pieces.
            PlaceBound { point: bound.point + 2.0 * sag.point, axis: bound.axis + 2.0 * sag.axis }
        };
        Self {
            machine,
            planar: machine.solver(0.0).is_ok_and(|solver| solver.planar()),
            arm: machine.is_arm(),
            along,
            sag,
            rapid_sag: PlaceBound::new(
                rules.rapid_tolerance.max(rules.tolerance) * SAG,
                RAPID_TURN * SAG,
            ),
            bound: widened(rules.tolerance, rules.axis_tolerance),
            rapid_bound: widened(
                rules.rapid_tolerance.max(rules.tolerance),
                RAPID_TURN.max(rules.axis_tolerance),
            ),
            track: CourseTrack::new(course, along, sag),
            reach: Vec::new(),
            quick: QuickStand::default(),
            next: Some(0),
            apart: true,
            stray: None,
            widened: 0,
            hole: None,
            made: None,
            cycle: None,
            cut_path: CutPath::new(along),
            cut_end: None,
            placed: false,
            passed: Vec::new(),
            places: Vec::new(),
            last_end: chop::LastEnd::default(),
            spare: Vec::new(),
            ways_behind: [None; 2],
            begun: Vec::new(),
            worked: Vec::new(),
            offset_use: OffsetUse::default(),
            turned: Vec::new(),
            moved: false,
            smoothing: Leeway::default(),
            detour: Detour::default(),
            running: RunningFunctions::default(),
            agreed: None,
            told: 0,
            stands: None,
            axes: AxisLimitCheck::new(machine),
            feeds: feed_sum::FeedSum::default(),
            limits: LimitCheck::default(),
            block: BlockReport::default(),
            found: Verification::default(),
            rules,
        }
    }

    /// Looks how near rapids come to where all of the course cuts, which a pass of its own has found.
    pub fn near(self, cut_path: CutPath) -> Self {
        Self { cut_path, ..self }
    }

    /// Takes what the program did next. `listen` hears of each line of the program once it is done.
    pub fn take(&mut self, done: &BlockEffect, listen: &mut dyn FnMut(&BlockReport)) {
        if self.found.gave_up {
            return;
        }
        match done {
            BlockEffect::Motion(motion) => {
                if self.block.nc_line != motion.line {
                    self.end_block(listen);
                    self.block.nc_line = motion.line;
                    self.block.block = motion.number;
                }
                if self.motion(motion) {
                    return;
                }
            }
            BlockEffect::Event { line, event } => {
                self.settle();
                self.runs(*line, event);
                self.take_event(*line, event);
            }
            BlockEffect::State(_) => {}
        }
        self.drop_behind();
        if let BlockEffect::Motion(Motion { kind: MotionKind::Feed, .. }) = done {
            let places = std::mem::take(&mut self.places);
            self.look_for_points(&places);
            self.places = places;
        }
    }

    fn take_event(&mut self, line: u64, event: &ProgramEvent) {
        match event {
            ProgramEvent::Dwell { .. }
            | ProgramEvent::Stop
            | ProgramEvent::OptionalStop
            | ProgramEvent::Sync(_) => self.event(line, event),
            ProgramEvent::Cycle(call) => {
                self.cycle = Some(call.kind);
                if let Some(made) = &mut self.made {
                    made.again = true;
                }
            }
            ProgramEvent::CycleEnd => self.cycle = None,
            ProgramEvent::ToolChange { .. } => {
                self.look_for_a_cut(line);
                self.turned.clear();
                self.cut_end = None;
                // What was drilled is a hole of the tool before.
                self.made = None;
                if self.arm && !self.rules.own {
                    // Wherever another hand has the arm go for it.
                    self.detour = Detour::default();
                }
            }
            ProgramEvent::End => self.look_for_retract(line, "where the program ends"),
            ProgramEvent::Spindle(spindle) if self.turned.len() < track::MOST_SPEEDS => {
                if !std::mem::take(&mut self.moved)
                    && let Some(last) = self.turned.last_mut()
                {
                    last.passing = true;
                }
                self.turned.push(SpindleCommand { spindle: *spindle, line, passing: false });
            }
            _ => {}
        }
    }

    /// A tool is not changed while it cuts, be it for itself.
    fn look_for_a_cut(&mut self, line: u64) {
        self.leave_cut();
        let in_a_cut = !self.apart && self.next.is_none() && !self.changes_behind_the_cut();
        if self.hole.is_some() || in_a_cut {
            let message = "the tool is changed in the midst of a cut".to_owned();
            self.fault_at("tool", message, Some(BlockPlace::of_line(line)), None, None);
        }
    }

    /// Whether the next cut of the course, right behind the one that the program may have ended, has another tool.
    fn changes_behind_the_cut(&mut self) -> bool {
        let Some(last) = self.reach.iter().rposition(|span| !span.is_empty() && span.to >= 1.0)
        else {
            return false;
        };
        let tool = self.track.get(last).and_then(|element| element.asked.tool);
        let next = self.behind_events(last + 1);
        let next = next.and_then(|index| self.track.get(index));
        next.is_some_and(|next| next.asked.tool != tool)
    }

    /// The program is at its end: what was found.
    pub fn finish(mut self, listen: &mut dyn FnMut(&BlockReport)) -> Verification {
        self.end_block(listen);
        self.settle();
        if !self.found.gave_up {
            self.flush_stray();
            self.look_at_the_rest();
            self.tell_change(None);
            self.tell_end();
            self.tell_offset_use();
        }
        match self.axes.part_place(self.machine) {
            Some((line, told)) if told.severity == Severity::Error => {
                self.fault_at(told.code, told.message, Some(BlockPlace::of_line(line)), None, None);
            }
            told => self.found.part_place = told.map(|(_, told)| told),
        }
        let mut faults = self.track.faults;
        for fault in self.cut_path.into_faults() {
            if !faults.contains(&fault) {
                faults.push(fault);
            }
        }
        self.found.course_faults = faults;
        self.found
    }

    /// What was found so far.
    pub fn found(&self) -> &Verification {
        &self.found
    }

    fn end_block(&mut self, listen: &mut dyn FnMut(&BlockReport)) {
        if self.block.nc_line != 0 {
            listen(&self.block);
            self.block = BlockReport::default();
        }
    }

    /// Takes a motion; true if nothing of it has to be looked at further.
    fn motion(&mut self, motion: &Motion) -> bool {
        self.moved = true;
        self.found.motions += 1;
        self.found.time_s += motion.minutes * 60.0;
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        places.push(ToolPlace::new(&motion.from.pose, self.along));
        let sag = match motion.kind {
            MotionKind::Rapid => self.rapid_sag,
            _ => self.sag,
        };
        chop::motion(motion, self.along, &sag, &mut self.last_end, &mut places);
        let bend = axes::bend_between_words(motion);
        if let Some(fault) = self.axes.over_travel(self.machine, motion, bend) {
            self.axis_fault(motion, fault);
        }
        if let Some(PassedLimit { message, by, limit }) = self.limits.passed(self.machine, motion) {
            let key = format!("[[limit]] {limit}");
            self.limit_fault("over-travel", key, message, motion, 0, by);
        }
        self.look_for_length(motion);
        self.offset_use.moves(motion);
        let mut goes_on = false;
        match motion.kind {
            MotionKind::Rapid => {
                self.settle();
                self.found.rapids += 1;
                self.set_kind("rapid");
                self.look_at_rapid_feed(motion);
                self.rapid(motion, &places);
            }
            MotionKind::Feed | MotionKind::Thread => {
                if let Some(fault) = self.axes.too_fast(self.machine, motion, bend) {
                    self.axis_fault(motion, fault);
                }
                goes_on = self.goes_on(motion, &places);
                if goes_on {
                    self.cut_end = places.last().copied();
                } else {
                    self.settle();
                    self.feed(motion, &places);
                }
            }
        }
        self.places = places;
        self.stands = Some(motion.to.joints);
        if self.rules.solutions {
            self.block.solution = axes::solution(self.machine, motion);
        }
        goes_on
    }

    /// A line of the program that cuts is told as a cut.
    fn set_kind(&mut self, kind: &'static str) {
        if self.block.kind.is_empty() || kind != "rapid" {
            self.block.kind = kind;
        }
    }

    fn axis_fault(&mut self, motion: &Motion, fault: AxisFault) {
        let AxisFault { code, message, by } = fault;
        let key = message.split(" would ").next().unwrap_or_default().to_owned();
        self.limit_fault(code, key, message, motion, 0, by);
    }

    /// Notes that a limit is passed: of those with the same key the farthest is told.
    fn limit_fault(
        &mut self,
        code: &'static str,
        key: String,
        message: String,
        motion: &Motion,
        cl_line: u64,
        by: f64,
    ) {
        let cl_line = (cl_line > 0).then_some(cl_line);
        let same = |fault: &&mut Fault| fault.code == code && fault.key == key;
        if let Some(known) = self.found.faults.iter_mut().find(same) {
            known.count += 1;
            if known.by.is_none_or(|most| by > most) {
                (known.message, known.by) = (message, Some(by));
                (known.nc_line, known.block) = (Some(motion.line), motion.number);
                known.cl_line = cl_line;
            }
            return;
        }
        let place = Some(BlockPlace::of(motion));
        self.fault_at(code, message, place, cl_line, Some(by));
        if let Some(fault) = self.found.faults.last_mut() {
            fault.key = key;
        }
    }

    /// Notes what is wrong. The same at other places is counted.
    fn fault(
        &mut self,
        code: &'static str,
        message: String,
        motion: Option<&Motion>,
        cl_line: Option<u64>,
        by: Option<f64>,
    ) {
        let place = motion.map(BlockPlace::of);
        self.fault_at(code, message, place, cl_line, by);
    }

    fn fault_at(
        &mut self,
        code: &'static str,
        message: String,
        place: Option<BlockPlace>,
        cl_line: Option<u64>,
        by: Option<f64>,
    ) {
        self.told += 1;
        let same = |fault: &&mut Fault| fault.code == code && fault.message == message;
        if let Some(known) = self.found.faults.iter_mut().find(same) {
            known.count += 1;
            return;
        }
        if self.found.faults.len() >= self.rules.most_faults {
            self.found.gave_up = true;
            return;
        }
        self.found.faults.push(Fault {
            code,
            key: message.clone(),
            message,
            nc_line: place.map(|place| place.line),
            block: place.and_then(|place| place.number),
            cl_line,
            count: 1,
            by,
        });
    }

    /// Notes how far the motion at hand is off, within the tolerance.
    fn note_deviation(&mut self, apart: PlaceDistance, nc_line: u64, cl_line: u64) {
        let angle = apart.axis.to_degrees();
        self.found.tip.take(apart.point, nc_line, cl_line);
        self.found.axis.take(angle, nc_line, cl_line);
        self.block.tip_deviation_mm = self.block.tip_deviation_mm.max(apart.point);
        self.block.axis_deviation_deg = self.block.axis_deviation_deg.max(angle);
    }

    /// Drops elements that the program can no longer stand at.
    fn drop_behind(&mut self) {
        let reached = self.reach.iter().position(|span| !span.is_empty());
        let behind = match (reached, self.next) {
            (Some(reached), Some(next)) => reached.min(next),
            (Some(reached), None) => reached,
            (None, Some(next)) => next,
            (None, None) => 0,
        };
        // Where nothing is cut it is not late yet for what was not met.
        let waits = self.track.kept().iter().take(behind);
        let waits = waits.enumerate().find(|(_, element)| {
            self.apart && matches!(element.what, ElementKind::Event(_, false))
        });
        let behind = waits.map_or(behind, |(index, _)| index);
        for _ in 0..behind {
            let Some(element) = self.track.pop() else {
                break;
            };
            if self.machine.heads_edge() && !matches!(element.what, ElementKind::Event(..)) {
                self.leave_way(&element);
            }
            if let ElementKind::Event(event, false) = &element.what {
                let message = format!("{} is left out", state::event_name(event));
                let place = BlockPlace { line: self.block.nc_line, number: self.block.block };
                let place = Some(place).filter(|place| place.line > 0);
                self.fault_at("event", message, place, Some(element.line), None);
            }
            if element.is_cut() && element.near.point.is_finite() && self.stray.is_none() {
                self.note_deviation(element.near, self.block.nc_line, element.line);
            }
        }
        self.reach.drain(..behind.min(self.reach.len()));
        if let Some(next) = &mut self.next {
            *next -= behind;
        }
        if let Some(hole) = &mut self.hole {
            hole.index -= behind;
        }
    }
}
