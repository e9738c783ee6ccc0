//! Programs and courses made by hand: what is held against what, and what is told.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::{Machine, Setting, Source, load};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;
use post_plugin::Lengths;
use post_readback::course::{Course, CourseItem, CoursePiece, Curve, ReachedPose};
use post_readback::verify::{BlockReport, CutBounds, CutPath, Verification, Verifier, VerifyRules};
use post_readback::{
    BlockEffect, Coolants, Corners, CycleCall, CycleKind, Interpolation, MachineState, Motion,
    MotionKind, ProgramEvent, SpindleState, Stance,
};
use post_testkit::seeded;
use post_testmachines::frechet::frechet;

type V = Vector3<f64>;

/// Items that were written down.
struct Written(VecDeque<CourseItem>);

impl Course for Written {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        Ok(self.0.pop_front())
    }
}

/// A course that breaks off ahead of its last item, or does not.
struct Broken(Written, bool);

impl Course for Broken {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        if self.1 && self.0.0.len() == 1 {
            self.0.0.clear();
            return Err(Diagnostic::error("read", "the disk").boxed());
        }
        self.0.next()
    }
}

fn machine() -> Machine {
    let text = include_str!("../../../../machines/vmc.toml");
    let source = Source { name: "vmc".to_owned(), text: text.to_owned() };
    // Where the part sits is said: travel is checked.
    let mount = Setting::Mount([0.0; 3]);
    load(source, &[mount], &mut |_| Err(String::new())).unwrap()
}

fn pose(tip: V) -> Pose {
    Pose { tip, axis: V::z(), edge: V::zeros() }
}

fn v(x: f64, y: f64, z: f64) -> V {
    V::new(x, y, z)
}

/// A course, written point by point.
#[derive(Default)]
struct Asks {
    items: VecDeque<CourseItem>,
    at: Option<V>,
    line: u64,
    hole: bool,
}

impl Asks {
    fn go(mut self, kind: MotionKind, to: V) -> Self {
        self.line += 1;
        let feed = (kind != MotionKind::Rapid).then_some(500.0);
        let item = match self.at {
            None => CourseItem::Reach(ReachedPose {
                line: self.line,
                kind,
                to: pose(to),
                feed,
                hole: self.hole,
            }),
            Some(from) => CourseItem::Piece(CoursePiece {
                line: self.line,
                kind,
                curve: Curve::Straight,
                from: pose(from),
                to: pose(to),
                feed,
                turned_feed: None,
                hole: self.hole,
            }),
        };
        self.items.push_back(item);
        self.at = Some(to);
        self
    }

    fn rapid(self, x: f64, y: f64, z: f64) -> Self {
        self.go(MotionKind::Rapid, v(x, y, z))
    }

    fn cut(self, x: f64, y: f64, z: f64) -> Self {
        self.go(MotionKind::Feed, v(x, y, z))
    }

    fn tell(mut self, told: ProgramEvent) -> Self {
        self.line += 1;
        self.items.push_back(CourseItem::Event { line: self.line, event: told });
        self
    }

    fn hole(self, depth: f64) -> Self {
        self.pecked(depth, CycleKind::Deep, [0.0; 2])
    }

    /// A hole whose feed begins 2 mm above its point, in pecks.
    fn pecked(mut self, depth: f64, kind: CycleKind, [peck, later_peck]: [f64; 2]) -> Self {
        let top = self.at.unwrap();
        self = self.tell(ProgramEvent::Cycle(CycleCall {
            kind,
            clearance: 2.0,
            peck,
            later_peck,
            ..CycleCall::default()
        }));
        self.hole = true;
        self = self.cut(top.x, top.y, top.z - depth);
        self = self.rapid(top.x, top.y, top.z);
        self.hole = false;
        self.tell(ProgramEvent::CycleEnd)
    }
}

/// A program, written motion by motion.
struct Does {
    done: Vec<BlockEffect>,
    state: Arc<MachineState>,
    at: V,
    line: u64,
}

impl Does {
    fn at(x: f64, y: f64, z: f64) -> Self {
        let machine = machine();
        let state = MachineState {
            solver: Arc::new(machine.solver(0.0).unwrap()),
            length: 0.0,
            tool: None,
            length_register: Some(1),
            length_of_spindle: false,
            radius_register: None,
            compensation: 0,
            tcp: false,
            plane: None,
            face: None,
            wrap: None,
            work_offset: None,
            offset_assumed: false,
            spindle: SpindleState::Off,
            coolants: Coolants::default(),
            standstill: Default::default(),
            operation: None,
            smoothing: None,
            smoothing_turn: 0.0,
            corners: Corners::Unsaid,
        };
        Self { done: Vec::new(), state: Arc::new(state), at: v(x, y, z), line: 0 }
    }

    fn go(mut self, kind: MotionKind, to: V) -> Self {
        self.line += 1;
        let stance = |tip: V| {
            let mut joints = Default::default();
            let solver = &self.state.solver;
            let turns = solver.chain().turns(&joints);
            solver.place(tip, &mut joints, &turns).unwrap();
            Stance { joints, pose: solver.chain().forward(&joints) }
        };
        let minutes = match kind {
            MotionKind::Rapid => 0.0,
            _ => (to - self.at).norm() / 500.0,
        };
        self.done.push(BlockEffect::Motion(Motion {
            line: self.line,
            number: None,
            kind,
            way: Interpolation::Axes,
            from: stance(self.at),
            to: stance(to),
            feed: 500.0,
            minutes,
            minutes_at_fastest: minutes,
            by_time: false,
            stops: false,
            hole: false,
            machine: false,
            led: u32::MAX,
            fast: false,
            along: None,
            rapid_feed: 0.0,
            state: Arc::clone(&self.state),
        }));
        self.at = to;
        self
    }

    fn rapid(self, x: f64, y: f64, z: f64) -> Self {
        self.go(MotionKind::Rapid, v(x, y, z))
    }

    fn cut(self, x: f64, y: f64, z: f64) -> Self {
        self.go(MotionKind::Feed, v(x, y, z))
    }

    fn tell(mut self, told: ProgramEvent) -> Self {
        self.line += 1;
        self.done.push(BlockEffect::Event { line: self.line, event: told });
        self
    }

    fn with(mut self, change: impl FnOnce(&mut MachineState)) -> Self {
        change(Arc::make_mut(&mut self.state));
        self
    }
}

fn verify(does: &Does, asks: Asks) -> (Verification, Vec<BlockReport>) {
    let machine = machine();
    let rules = VerifyRules { length_from: Lengths::Registers, ..VerifyRules::of(&machine) };
    let mut verifier = {
        let mut path = CutPath::new(0.0);
        asks.items.iter().for_each(|item| path.take(item));
        Verifier::new(&machine, rules, Written(asks.items)).near(path)
    };
    let mut rows = Vec::new();
    for done in &does.done {
        verifier.take(done, &mut |row| rows.push(row.clone()));
    }
    let found = verifier.finish(&mut |row| rows.push(row.clone()));
    (found, rows)
}

/// The codes of the faults with their lines of program and course.
fn codes(does: &Does, asks: Asks) -> Vec<(&'static str, u64, u64)> {
    let (found, _) = verify(does, asks);
    let row = |fault: &post_readback::verify::Fault| {
        (fault.code, fault.nc_line.unwrap_or(0), fault.cl_line.unwrap_or(0))
    };
    found.faults.iter().map(row).collect()
}

fn square() -> Asks {
    Asks::default()
        .rapid(0.0, 0.0, 10.0)
        .rapid(0.0, 0.0, 1.0)
        .cut(0.0, 0.0, -2.0)
        .cut(20.0, 0.0, -2.0)
        .cut(20.0, 20.0, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0)
}

fn begin() -> Does {
    Does::at(100.0, 100.0, 15.0)
        .rapid(0.0, 0.0, 15.0)
        .rapid(0.0, 0.0, 10.0)
        .rapid(0.0, 0.0, 1.0)
        .cut(0.0, 0.0, -2.0)
}

#[test]
fn what_of_a_course_cannot_be_read_in_any_pass_is_told_once() {
    let does = begin().cut(20.0, 0.0, -2.0).rapid(0.0, 0.0, 10.0);
    let machine = machine();
    for [first, again] in [[false, true], [true, false], [true, true], [false, false]] {
        let course = |breaks| Broken(Written(square().items), breaks);
        let (bounds, _) = CutBounds::of(&mut course(false), 0.0);
        let path = CutPath::when_asked(bounds, Box::new(course(again)), 0.0);
        let mut verifier =
            Verifier::new(&machine, VerifyRules::of(&machine), course(first)).near(path);
        does.done.iter().for_each(|done| verifier.take(done, &mut |_| {}));
        let found = verifier.finish(&mut |_| {});
        let told: Vec<&str> = found.course_faults.iter().map(|fault| fault.code).collect();
        assert_eq!(told, vec!["read"; usize::from(first || again)], "{first} {again}");
    }
}

#[test]
fn a_program_that_does_what_is_asked_has_no_fault() {
    let does = begin()
        .cut(10.0, 0.002, -2.0)
        .cut(20.0, 0.0, -2.0)
        .cut(20.0, 20.0, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0);
    let (found, rows) = verify(&does, square());
    assert_eq!(found.faults, []);
    assert_eq!((found.motions, found.cuts, found.rapids), (10, 6, 4));
    assert!((found.tip.value - 0.002).abs() < 1e-9, "{:?}", found.tip);
    assert_eq!((found.tip.nc_line, found.tip.cl_line), (5, 4));
    assert_eq!(rows.len(), 10);
    assert_eq!((rows[4].kind, rows[4].cl_line), ("cut", Some(4)));
}

#[test]
fn what_is_off_is_told_once_with_both_places() {
    let does = begin()
        .cut(20.0, 0.0, -2.0)
        .cut(20.0, 20.3, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0);
    let (found, _) = verify(&does, square());
    assert_eq!(found.faults.len(), 1, "{:#?}", found.faults);
    let fault = &found.faults[0];
    assert_eq!((fault.code, fault.nc_line, fault.cl_line), ("deviation", Some(6), Some(5)));
    let by = fault.by.unwrap();
    assert!((0.25..0.31).contains(&by), "{by}");
}

#[test]
fn points_left_out_swapped_and_doubled_are_found() {
    let left_out =
        begin().cut(20.0, 0.0, -2.0).cut(0.0, 20.0, -2.0).cut(0.0, 0.0, -2.0).rapid(0.0, 0.0, 10.0);
    assert_eq!(codes(&left_out, square()), [("deviation", 6, 5)]);
    let swapped = begin()
        .cut(20.0, 20.0, -2.0)
        .cut(20.0, 0.0, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0);
    assert_eq!(codes(&swapped, square())[0].0, "deviation");
    // The same path, gone along to and fro.
    let doubled = begin()
        .cut(20.0, 0.0, -2.0)
        .cut(10.0, 0.0, -2.0)
        .cut(20.0, 0.0, -2.0)
        .cut(20.0, 20.0, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0);
    assert_eq!(codes(&doubled, square())[0].0, "deviation");
    let short = begin().cut(20.0, 0.0, -2.0).cut(20.0, 20.0, -2.0);
    assert_eq!(codes(&short, square()).last().unwrap().0, "missing");
}

#[test]
fn a_rapid_in_place_of_a_cut_is_found() {
    let does = begin()
        .cut(20.0, 0.0, -2.0)
        .rapid(20.0, 20.0, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0);
    let found = codes(&does, square());
    assert_eq!(found, [("missing", 7, 5)]);
}

#[test]
fn a_cut_may_be_left_and_gone_on_with() {
    let does = begin()
        .cut(20.0, 0.0, -2.0)
        .cut(20.0, 10.0, -2.0)
        .rapid(20.0, 10.0, 50.0)
        .rapid(70.0, 10.0, 50.0)
        .rapid(20.0, 10.0, 50.0)
        .rapid(20.0, 10.0, -2.0)
        .cut(20.0, 20.0, -2.0)
        // At feed along its own axis.
        .cut(20.0, 20.0, 30.0)
        .rapid(0.0, 70.0, 30.0)
        .rapid(20.0, 20.0, 30.0)
        .cut(20.0, 20.0, -2.0)
        .cut(0.0, 20.0, -2.0)
        .cut(0.0, 0.0, -2.0)
        .rapid(0.0, 0.0, 10.0);
    let (found, _) = verify(&does, square());
    assert_eq!(found.faults, []);
    assert_eq!(found.excursions, 2);
}

fn holes() -> Asks {
    Asks::default()
        .rapid(0.0, 0.0, 2.0)
        .hole(12.0)
        .rapid(10.0, 0.0, 2.0)
        .hole(12.0)
        .rapid(10.0, 0.0, 50.0)
}

#[test]
fn holes_are_pecked_as_the_control_likes() {
    let does = Does::at(0.0, 0.0, 50.0)
        .rapid(0.0, 0.0, 2.0)
        .cut(0.0, 0.0, -5.0)
        .rapid(0.0, 0.0, 2.0)
        .rapid(0.0, 0.0, -4.5)
        .cut(0.0, 0.0, -10.0)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 2.0)
        .cut(10.0, 0.0, -10.0)
        .rapid(10.0, 0.0, 50.0);
    let (found, _) = verify(&does, holes());
    assert_eq!(found.faults, []);
    assert_eq!(found.holes, 2);
}

/// A hole of 12 mm from Z2 down, each of `down` cut in one go; behind each but the last the tool goes up to `up`.
fn strokes(down: &[f64], up: f64) -> Does {
    let mut does = Does::at(0.0, 0.0, 50.0).rapid(0.0, 0.0, 2.0);
    let mut cut = 2.0;
    for &to in down {
        if cut < 2.0 {
            does = does.rapid(0.0, 0.0, up.max(cut)).rapid(0.0, 0.0, cut + 0.5);
        }
        does = does.cut(0.0, 0.0, to);
        cut = to;
    }
    does.rapid(0.0, 0.0, 50.0)
}

#[test]
fn pecks_are_no_larger_than_asked_for() {
    let asks = |kind, pecks| {
        Asks::default().rapid(0.0, 0.0, 2.0).pecked(12.0, kind, pecks).rapid(0.0, 0.0, 50.0)
    };
    let told = |does: &Does, kind, pecks| {
        let (found, _) = verify(does, asks(kind, pecks));
        found.faults.iter().map(|fault| fault.code).collect::<Vec<_>>()
    };
    let none: [&str; 0] = [];
    use CycleKind::{BreakChip, Deep};
    for pecks in [[4.0, 0.0], [4.0, 3.0]] {
        // Counted from the point or from where the feed begins, by rounding and by smaller ones.
        for down in [
            &[-4.0, -7.0, -10.0][..],
            &[-2.0, -5.0, -8.0, -10.0],
            &[-4.0005, -7.0, -10.0],
            &[0.0, -2.0, -4.0, -6.0, -8.0, -10.0],
        ] {
            assert_eq!(told(&strokes(down, 2.0), Deep, pecks), none, "{down:?}");
            assert_eq!(told(&strokes(down, 2.0), BreakChip, pecks), none, "{down:?}");
            assert_eq!(told(&strokes(down, -1.0), Deep, pecks), ["hole"], "{down:?}");
        }
        for down in [&[-10.0][..], &[-5.0, -8.0, -10.0], &[-2.0, -6.5, -10.0], &[-4.0, -10.0]] {
            assert_eq!(told(&strokes(down, 2.0), Deep, pecks), ["hole"], "{down:?}");
        }
    }
    assert_eq!(told(&strokes(&[-4.0, -8.0, -10.0], 2.0), Deep, [4.0, 4.0]), none);
    assert_eq!(told(&strokes(&[-4.0, -8.0, -10.0], 2.0), Deep, [4.0, 3.0]), ["hole"]);
    // Nobody asked for pecks.
    assert_eq!(told(&strokes(&[-10.0], 2.0), Deep, [0.0, 0.0]), none);
}

#[test]
fn holes_that_are_not_made_so_are_told() {
    let shallow = Does::at(0.0, 0.0, 50.0)
        .rapid(0.0, 0.0, 2.0)
        .cut(0.0, 0.0, -9.0)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 2.0)
        .cut(10.0, 0.0, -10.0)
        .rapid(10.0, 0.0, 50.0);
    assert_eq!(codes(&shallow, holes()), [("hole", 4, 3)]);
    let deep = Does::at(0.0, 0.0, 50.0)
        .rapid(0.0, 0.0, 2.0)
        .cut(0.0, 0.0, -10.1)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 2.0)
        .cut(10.0, 0.0, -10.0)
        .rapid(10.0, 0.0, 50.0);
    assert_eq!(codes(&deep, holes()), [("hole", 2, 3)]);
    let rapid_into = Does::at(0.0, 0.0, 50.0)
        .rapid(0.0, 0.0, 2.0)
        .cut(0.0, 0.0, -5.0)
        .rapid(0.0, 0.0, 2.0)
        .rapid(0.0, 0.0, -7.0)
        .cut(0.0, 0.0, -10.0)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 2.0)
        .cut(10.0, 0.0, -10.0)
        .rapid(10.0, 0.0, 50.0);
    assert_eq!(codes(&rapid_into, holes()), [("hole", 4, 3)]);
    let one = Does::at(0.0, 0.0, 50.0)
        .rapid(0.0, 0.0, 2.0)
        .cut(0.0, 0.0, -10.0)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 2.0)
        .rapid(10.0, 0.0, 50.0);
    assert_eq!(codes(&one, holes())[0].0, "missing");
    let elsewhere = Does::at(0.0, 0.0, 50.0)
        .rapid(0.0, 0.0, 2.0)
        .cut(0.0, 0.0, -10.0)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.3, 2.0)
        .cut(10.0, 0.3, -10.0)
        .rapid(10.0, 0.3, 50.0);
    assert_eq!(codes(&elsewhere, holes()), [("deviation", 5, 8)]);
}

#[test]
fn what_holds_in_a_cut_is_compared() {
    let asks = || {
        let told = Asks::default()
            .tell(ProgramEvent::ToolChange { number: Some(3), name: None })
            .tell(ProgramEvent::Spindle(SpindleState::Clockwise(8000.0)))
            .tell(ProgramEvent::Coolant(Coolants { flood: true, ..Coolants::default() }));
        let mut square = square();
        for item in &mut square.items {
            match item {
                CourseItem::Piece(piece) => piece.line += told.line,
                CourseItem::Reach(reach) => reach.line += told.line,
                _ => {}
            }
        }
        Asks { items: told.items.into_iter().chain(square.items).collect(), ..square }
    };
    let does = |change: fn(&mut MachineState)| {
        let set = |state: &mut MachineState| {
            state.tool = Some(3);
            state.length_register = Some(3);
            state.spindle = SpindleState::Clockwise(8000.0);
            state.coolants.flood = true;
        };
        Does::at(0.0, 0.0, 15.0)
            .with(set)
            .rapid(0.0, 0.0, 10.0)
            .rapid(0.0, 0.0, 1.0)
            .cut(0.0, 0.0, -2.0)
            .cut(20.0, 0.0, -2.0)
            .with(change)
            .cut(20.0, 20.0, -2.0)
            .cut(0.0, 20.0, -2.0)
            .cut(0.0, 0.0, -2.0)
            .with(set)
            .rapid(0.0, 0.0, 10.0)
    };
    assert_eq!(codes(&does(|_| {}), asks()), []);
    for (change, code) in [
        ((|state| state.tool = Some(4)) as fn(&mut MachineState), "tool"),
        (|state| state.length_register = Some(4), "register"),
        (|state| state.spindle = SpindleState::Off, "spindle"),
        (|state| state.spindle = SpindleState::Clockwise(7000.0), "spindle"),
        (|state| state.spindle = SpindleState::CounterClockwise(8000.0), "spindle"),
        (|state| state.coolants.flood = false, "coolant"),
        (|state| state.compensation = -1, "compensation"),
    ] {
        let found = codes(&does(change), asks());
        assert_eq!(found[0], (code, 5, 8), "{found:?}");
    }
}

/// A tool change with the spindle and the coolant as they are.
fn changed(number: u32) -> ProgramEvent {
    ProgramEvent::ToolChange { number: Some(number), name: None }
}

#[test]
fn nothing_runs_on_behind_the_end_of_a_program() {
    let flood = Coolants { flood: true, ..Coolants::default() };
    let on = [ProgramEvent::Spindle(SpindleState::Clockwise(8000.0)), ProgramEvent::Coolant(flood)];
    let asks = || {
        let asks = Asks::default().tell(on[0].clone()).tell(on[1].clone());
        asks.rapid(0.0, 0.0, 10.0).cut(0.0, 0.0, -2.0).rapid(0.0, 0.0, 10.0)
    };
    let found = |ends: &[ProgramEvent]| {
        let mut does = Does::at(0.0, 0.0, 15.0).with(|state| {
            state.spindle = SpindleState::Clockwise(8000.0);
            state.coolants = flood;
        });
        does = does.tell(on[0].clone()).tell(on[1].clone());
        does = does.rapid(0.0, 0.0, 10.0).cut(0.0, 0.0, -2.0);
        does = does.rapid(0.0, 0.0, 10.0);
        for told in ends {
            does = does.tell(told.clone());
        }
        codes(&does, asks())
    };
    let off = ProgramEvent::Spindle(SpindleState::Off);
    let dry = ProgramEvent::Coolant(Coolants::default());
    // M30 stops both, and so do M5 and M9.
    assert_eq!(found(&[ProgramEvent::End]), []);
    assert_eq!(found(&[off.clone(), dry.clone()]), []);
    assert_eq!(found(&[dry]), [("spindle", 1, 0)]);
    assert_eq!(found(&[off]), [("coolant", 2, 0)]);
}

#[test]
fn a_tool_is_not_changed_while_something_runs_that_should_stand() {
    let flood = Coolants { flood: true, ..Coolants::default() };
    let on = ProgramEvent::Spindle(SpindleState::Clockwise(8000.0));
    let asks = |before: &[ProgramEvent]| {
        let mut asks = Asks::default().tell(changed(3)).tell(on.clone());
        asks = asks.tell(ProgramEvent::Coolant(flood));
        asks = asks.rapid(0.0, 0.0, 10.0).cut(0.0, 0.0, -2.0);
        asks = asks.rapid(0.0, 0.0, 10.0);
        for told in before {
            asks = asks.tell(told.clone());
        }
        asks = asks.tell(changed(4)).tell(on.clone());
        asks = asks.tell(ProgramEvent::Coolant(flood));
        asks.cut(0.0, 0.0, -2.0).rapid(0.0, 0.0, 10.0)
    };
    let does = |first: &[ProgramEvent], between: &[ProgramEvent]| {
        let with = |does: Does, tool: u32| {
            does.with(|state| {
                state.tool = Some(tool);
                state.length_register = Some(tool);
                state.spindle = SpindleState::Clockwise(8000.0);
                state.coolants = flood;
            })
        };
        let mut does = Does::at(0.0, 0.0, 15.0);
        for told in first {
            does = does.tell(told.clone());
        }
        does = with(does.tell(changed(3)), 3).tell(on.clone());
        does = does.tell(ProgramEvent::Coolant(flood));
        does = does.rapid(0.0, 0.0, 10.0).cut(0.0, 0.0, -2.0);
        does = does.rapid(0.0, 0.0, 10.0);
        for told in between {
            does = does.tell(told.clone());
        }
        does = with(does.tell(changed(4)), 4).tell(on.clone());
        does = does.tell(ProgramEvent::Coolant(flood));
        does = does.cut(0.0, 0.0, -2.0).rapid(0.0, 0.0, 10.0);
        does.tell(ProgramEvent::End)
    };
    let off =
        [ProgramEvent::Spindle(SpindleState::Off), ProgramEvent::Coolant(Coolants::default())];
    let found = |does: &Does, asks: Asks| {
        let (found, _) = verify(does, asks);
        let faults: Vec<&str> = found.faults.iter().map(|fault| fault.code).collect();
        let told: Vec<&str> = found.left_on.iter().map(|left| left.code).collect();
        (faults, told)
    };
    let none = (vec![], vec![]);
    assert_eq!(found(&does(&[], &off), asks(&off)), none);
    assert_eq!(found(&does(&[], &off), asks(&[])), none);
    // The CL file has them off: a fault. It says nothing: the control may stop them by itself.
    let both = vec!["spindle", "coolant"];
    assert_eq!(found(&does(&[], &[]), asks(&off)), (both.clone(), vec![]));
    assert_eq!(found(&does(&[], &[]), asks(&[])), (vec![], both));
    // Before the first tool nothing is on.
    let started = does(std::slice::from_ref(&on), &off);
    assert_eq!(found(&started, asks(&[])), (vec!["spindle"], vec![]));
}

#[test]
fn stops_and_dwells_stand_where_they_are_asked_for() {
    let asks = || {
        Asks::default()
            .rapid(0.0, 0.0, 0.0)
            .cut(10.0, 0.0, 0.0)
            .tell(ProgramEvent::Dwell { time: 2.0, revolutions: false })
            .cut(20.0, 0.0, 0.0)
            .rapid(20.0, 0.0, 10.0)
            .tell(ProgramEvent::Stop)
            .rapid(20.0, 0.0, 0.0)
            .cut(30.0, 0.0, 0.0)
    };
    let wait = |time: f64| ProgramEvent::Dwell { time, revolutions: false };
    let good = Does::at(0.0, 0.0, 10.0)
        .rapid(0.0, 0.0, 0.0)
        .cut(10.0, 0.0, 0.0)
        .tell(wait(2.0))
        .cut(20.0, 0.0, 0.0)
        .rapid(20.0, 0.0, 10.0)
        .tell(ProgramEvent::Stop)
        .rapid(20.0, 0.0, 0.0)
        .cut(30.0, 0.0, 0.0);
    assert_eq!(codes(&good, asks()), []);
    let none = Does::at(0.0, 0.0, 10.0)
        .rapid(0.0, 0.0, 0.0)
        .cut(10.0, 0.0, 0.0)
        .cut(20.0, 0.0, 0.0)
        .rapid(20.0, 0.0, 10.0)
        .rapid(20.0, 0.0, 0.0)
        .cut(30.0, 0.0, 0.0);
    assert_eq!(codes(&none, asks()), [("event", 3, 3), ("event", 6, 6)]);
    let elsewhere = Does::at(0.0, 0.0, 10.0)
        .rapid(0.0, 0.0, 0.0)
        .cut(5.0, 0.0, 0.0)
        .tell(wait(2.0))
        .cut(20.0, 0.0, 0.0)
        .rapid(20.0, 0.0, 10.0)
        .tell(ProgramEvent::Stop)
        .tell(ProgramEvent::OptionalStop)
        .rapid(20.0, 0.0, 0.0)
        .cut(30.0, 0.0, 0.0);
    assert_eq!(codes(&elsewhere, asks()), [("event", 3, 3), ("event", 7, 0)]);
}

#[test]
fn limits_of_the_axes_are_told_and_feeds_compared() {
    let asks = || Asks::default().rapid(0.0, 0.0, 0.0).cut(600.0, 0.0, 0.0).rapid(0.0, 0.0, 0.0);
    let does =
        Does::at(0.0, 0.0, 10.0).rapid(0.0, 0.0, 0.0).cut(600.0, 0.0, 0.0).rapid(0.0, 0.0, 0.0);
    assert_eq!(codes(&does, asks()), [("over-travel", 2, 0)]);
    for (minutes, code) in [(0.5, "feed"), (2.0, "feed"), (0.02, "max-feed")] {
        let mut does =
            Does::at(0.0, 0.0, 10.0).rapid(0.0, 0.0, 0.0).cut(600.0, 0.0, 0.0).rapid(0.0, 0.0, 0.0);
        if let BlockEffect::Motion(motion) = &mut does.done[1] {
            motion.minutes = minutes;
            motion.minutes_at_fastest = minutes;
        }
        let found = codes(&does, asks());
        assert!(found.iter().any(|found| found.0 == code), "{found:?}");
    }
}

/// Against the free-space diagram of the tests: what it lets through has no fault, what it does not has one, and the
/// distance told is the Fréchet distance.
#[test]
fn strays_are_those_of_the_frechet_distance() {
    let mut random = seeded(13);
    let (mut off, mut on) = (0, 0);
    for _ in 0..3000 {
        let count = 2 + random.pick(5);
        let path: Vec<V> =
            (0..=count).map(|_| v(random.range(-1.0, 1.0), random.range(-1.0, 1.0), 0.0)).collect();
        let size = 0.01 * libm::pow(10.0, random.range(-1.0, 0.5));
        let mut curve: Vec<V> = Vec::new();
        for (index, point) in path.iter().enumerate() {
            if index > 0 && random.pick(3) == 0 {
                curve.push((path[index - 1] + point) * 0.5);
            }
            if random.pick(12) > 0 {
                curve.push(*point);
            }
        }
        if curve.len() < 2 {
            continue;
        }
        for point in &mut curve {
            *point += v(random.range(-size, size), random.range(-size, size), 0.0);
        }
        let truth = frechet(&curve, &path, 8.0);
        let mut asks = Asks::default().rapid(path[0].x, path[0].y, 0.0);
        for point in &path[1..] {
            asks = asks.cut(point.x, point.y, 0.0);
        }
        let mut does = Does::at(0.0, 0.0, 10.0).rapid(curve[0].x, curve[0].y, 0.0);
        for point in &curve[1..] {
            does = does.cut(point.x, point.y, 0.0);
        }
        let (found, _) = verify(&does, asks);
        // The way to the beginning and times are no matter here.
        let faults: Vec<_> = found
            .faults
            .iter()
            .filter(|fault| ["deviation", "missing", "added"].contains(&fault.code))
            .collect();
        if truth < 0.005 {
            on += 1;
            assert!(faults.is_empty(), "{truth} {faults:#?}");
            assert!(found.tip.value <= truth + 1e-6, "{truth} {:?}", found.tip);
        } else if truth > 0.005 * 1.05 {
            off += 1;
            assert!(!faults.is_empty(), "{truth} {path:?} {curve:?} {:?}", found);
        }
    }
    assert!(on > 300 && off > 300, "{on} {off}");
}

#[test]
fn a_rapid_that_comes_near_what_is_cut_is_told() {
    let asks = || {
        Asks::default()
            .rapid(0.0, 0.0, 0.0)
            .cut(10.0, 0.0, 0.0)
            .rapid(10.0, 0.0, 50.0)
            .rapid(100.0, 0.0, 50.0)
            .rapid(100.0, 0.0, 0.0)
            .cut(110.0, 0.0, 0.0)
            .rapid(110.0, 0.0, 50.0)
    };
    let does = |through: bool| {
        let does = Does::at(0.0, 0.0, 60.0)
            .rapid(0.0, 0.0, 0.0)
            .cut(10.0, 0.0, 0.0)
            .rapid(10.0, 0.0, 50.0);
        let does = match through {
            // Below the first cut and out again.
            true => does.rapid(50.0, 0.0, 50.0).rapid(-20.0, 0.0, -30.0).rapid(40.0, 0.0, 50.0),
            false => does,
        };
        does.rapid(100.0, 0.0, 50.0)
            .rapid(100.0, 0.0, 0.0)
            .cut(110.0, 0.0, 0.0)
            .rapid(110.0, 0.0, 50.0)
    };
    assert!(codes(&does(false), asks()).iter().all(|found| found.0 == "over-travel"));
    let found = codes(&does(true), asks());
    assert!(found.contains(&("rapid", 5, 0)), "{found:?}");
}

#[test]
fn work_offsets_are_those_that_are_asked_for() {
    let none = |_: &mut MachineState| {};
    let of =
        |name: &'static str| move |state: &mut MachineState| state.work_offset = Some(name.into());
    let program = |first: &'static str, second: &'static str| {
        begin()
            .with(of(first))
            .cut(20.0, 0.0, -2.0)
            .cut(20.0, 20.0, -2.0)
            .with(of(second))
            .cut(0.0, 20.0, -2.0)
            .with(none)
            .cut(0.0, 0.0, -2.0)
            .rapid(0.0, 0.0, 10.0)
    };
    let asked = |number: u32| {
        let mut asks = square();
        let told = ProgramEvent::WorkOffset(number.to_string());
        asks.items.insert(0, CourseItem::Event { line: 0, event: told });
        asks
    };
    let faults = |does: Does, asks: Asks| codes(&does, asks).len();
    assert_eq!(faults(program("G54", "G54"), square()), 0);
    // Which one a job hangs on that names none nobody knows; but one it is.
    assert_eq!(faults(program("G55", "G55"), square()), 0);
    let changed = codes(&program("G54", "G55"), square());
    assert_eq!(changed.len(), 1);
    assert_eq!(changed[0].0, "work-offset");
    assert_eq!(faults(program("G55", "G55"), asked(2)), 0);
    assert_eq!(faults(program("G54", "G54"), asked(2)), 1);
    assert_eq!(faults(program("G15 H2", "G15 H2"), asked(2)), 0);
}

#[test]
fn rapids_that_swing_out_of_where_they_are_asked_for_are_found() {
    let asks = || {
        Asks::default()
            .rapid(0.0, 0.0, 10.0)
            .rapid(0.0, 0.0, 1.0)
            .cut(0.0, 0.0, -2.0)
            .cut(20.0, 0.0, -2.0)
            .rapid(20.0, 0.0, 10.0)
            .rapid(40.0, 10.0, 10.0)
            .cut(40.0, 10.0, -2.0)
            .cut(60.0, 10.0, -2.0)
    };
    let program = |swing: [f64; 3]| {
        begin()
            .cut(20.0, 0.0, -2.0)
            .rapid(20.0, 0.0, 10.0)
            .rapid(20.0, 0.0, 90.0)
            .rapid(swing[0], swing[1], swing[2])
            .rapid(40.0, 10.0, 90.0)
            .rapid(40.0, 10.0, 10.0)
            .cut(40.0, 10.0, -2.0)
            .cut(60.0, 10.0, -2.0)
    };
    let found = |swing: [f64; 3]| codes(&program(swing), asks());
    assert_eq!(found([30.0, 5.0, 90.0]), []);
    assert_eq!(found([20.0, 10.0, 300.0]), []);
    let out = found([20.0, 40.0, 90.0]);
    assert_eq!(out.len(), 1, "{out:?}");
    assert_eq!(out[0].0, "rapid");
    let below = found([70.0, 5.0, 90.0]);
    assert_eq!(below.len(), 1, "{below:?}");
}
