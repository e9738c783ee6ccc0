//! Where the tool is on motions and pieces, and what of a program becomes a course.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Chain, Freedom, Joint, Joints, Pose, Solver};
use post_readback::course::program::{Chords, ProgramCourse};
use post_readback::course::{Course, CourseItem, CoursePiece, Curve};
use post_readback::{
    BSpline, BlockEffect, BlockRunner, Coolants, Corners, Interpolation, MachineState, Motion,
    MotionKind, ProgramEvent, SpindleState, Stance,
};
use post_testkit::{randomised, seeded};
use post_testmachines::Random;

type V = Vector3<f64>;

fn solver(joints: Vec<Joint>, mount: V, tip: V, axis: V) -> Arc<Solver> {
    let rotary = (0..joints.len()).filter(|place| joints[*place].rotary).collect();
    let chain = Chain::new(joints, mount, tip, axis);
    let freedom =
        Freedom { rotary, still: Vec::new(), held: Joints::default(), seconds: Vec::new() };
    Arc::new(Solver::with(chain, &freedom).unwrap())
}

fn state(solver: &Arc<Solver>) -> Arc<MachineState> {
    Arc::new(MachineState {
        solver: Arc::clone(solver),
        length: 0.0,
        tool: Some(1),
        length_register: None,
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
    })
}

fn motion(state: &Arc<MachineState>, way: Interpolation, from: Joints, to: Joints) -> Motion {
    let stance = |joints: Joints| Stance { joints, pose: state.solver.chain().forward(&joints) };
    Motion {
        line: 1,
        number: None,
        kind: MotionKind::Feed,
        way,
        from: stance(from),
        to: stance(to),
        feed: 1000.0,
        minutes: 0.1,
        minutes_at_fastest: 0.1,
        by_time: false,
        stops: false,
        hole: false,
        machine: false,
        led: u32::MAX,
        fast: false,
        along: None,
        rapid_feed: 0.0,
        state: Arc::clone(state),
    }
}

/// How far the pose at `t` in one of `count` pieces is from the straight line and the great circle of its ends.
fn strays(motion: &Motion, count: u64, piece: u64, t: f64) -> (f64, f64) {
    let at = |t: f64| motion.at(t);
    let [low, high] = [piece, piece + 1].map(|place| place as f64 / count as f64);
    let straight = CoursePiece {
        line: 1,
        kind: MotionKind::Feed,
        curve: Curve::Straight,
        from: at(low),
        to: at(high),
        feed: None,
        turned_feed: None,
        hole: false,
    };
    let [wanted, found] = [straight.at(t, 0.0), at(low + (high - low) * t)];
    let across = wanted.axis.cross(&found.axis).norm();
    let angle = libm::atan2(across, wanted.axis.dot(&found.axis));
    ((wanted.tip - found.tip).norm(), angle)
}

#[test]
fn random_machines_go_where_matrices_say_and_chords_stay_near() {
    let (rounds, mut rng) = randomised(200_u32, 71);
    let mut closest: f64 = 0.0;
    for _ in rounds {
        let random = Random::new(&mut rng, 2, 0);
        let reference = &random.reference;
        let joints = reference.joints.clone();
        let Ok(solver) = std::panic::catch_unwind(|| {
            solver(joints, reference.mount, reference.tip, reference.axis)
        }) else {
            continue;
        };
        let state = state(&solver);
        let (from, mut to) = (random.values(&mut rng), random.values(&mut rng));
        let share = rng.order(-3.0, 0.0);
        for (from, to) in from.iter().zip(&mut to) {
            *to = from + (*to - from) * share;
        }
        let motion = motion(&state, Interpolation::Axes, from, to);
        for step in 0..=8 {
            let t = f64::from(step) / 8.0;
            let between: Vec<f64> =
                (0..from.len()).map(|place| from[place] + (to[place] - from[place]) * t).collect();
            let (tip, axis) = reference.forward(&between);
            let pose = motion.at(t);
            assert!((pose.tip - tip).norm() < 1e-9 * 1e3);
            assert!((pose.axis - axis).norm() < 1e-9);
        }
        let (chord, angle) = (rng.order(-3.0, 0.0), rng.order(-4.0, -1.0));
        let count = motion.pieces(chord, angle);
        if count > 20_000 {
            continue;
        }
        for _ in 0..40 {
            let piece = rng.pick(count as usize) as u64;
            let t = rng.range(0.0, 1.0);
            let (tip, turn) = strays(&motion, count, piece, t);
            assert!(tip <= chord * 1.000_001, "{tip} mm of {chord} in {count} pieces");
            assert!(turn <= angle * 1.000_001, "{turn} of {angle} in {count} pieces");
            closest = closest.max(tip / chord);
        }
    }
    // The bound is a bound, and not one that asks for points without need.
    assert!(closest > 0.05, "{closest}");
}

/// A table turned about Z, and three axes that carry the tool.
fn turntable() -> Arc<MachineState> {
    let linear = |direction: V| Joint { rotary: false, direction, point: V::zeros() };
    let c = Joint { rotary: true, direction: V::z(), point: V::zeros() };
    let joints = vec![c, linear(V::x()), linear(V::y()), linear(V::z())];
    state(&solver(joints, V::zeros(), V::zeros(), V::z()))
}

fn at(c: f64, x: f64, y: f64, z: f64) -> Joints {
    let mut joints = Joints::default();
    joints[..4].copy_from_slice(&[c, x, y, z]);
    joints
}

#[test]
fn a_table_that_turns_under_a_standing_tool_draws_a_circle() {
    let state = turntable();
    let whole =
        motion(&state, Interpolation::Axes, at(0.0, 30.0, 0.0, 5.0), at(TAU, 30.0, 0.0, 5.0));
    for step in 0..=16 {
        let t = f64::from(step) / 16.0;
        let tip = whole.at(t).tip;
        assert!((tip.xy().norm() - 30.0).abs() < 1e-12 && tip.z == 5.0);
    }
    // The sagitta of a chord over a turn of a: r(1 - cos(a/2)).
    let count = whole.pieces(0.01, 1e-3);
    let sagitta = |count: f64| 30.0 * (1.0 - libm::cos(TAU / count / 2.0));
    assert!(sagitta(count as f64) <= 0.01);
    assert!(sagitta(count as f64 * 0.9) > 0.01, "{count}");
    // The tool points where it did: its axis asks for no pieces.
    assert_eq!(
        motion(
            &state,
            Interpolation::Tip(Curve::Straight),
            at(0.0, 30.0, 0.0, 5.0),
            at(TAU, 30.0, 0.0, 5.0)
        )
        .pieces(0.01, 1e-3),
        1
    );
}

#[test]
fn arcs_splines_and_kept_tips_go_as_they_say() {
    let state = turntable();
    let way = Interpolation::Tip(Curve::Arc {
        centre: V::new(0.0, 0.0, 9.0),
        normal: -V::z(),
        sweep: 0.75 * TAU,
    });
    let mut arc = motion(&state, way, at(0.0, 10.0, 0.0, 0.0), at(0.0, 0.0, 10.0, 3.0));
    assert!((arc.at(1.0 / 3.0).tip - V::new(0.0, -10.0, 1.0)).norm() < 1e-12);
    assert!((arc.at(2.0 / 3.0).tip - V::new(-10.0, 0.0, 2.0)).norm() < 1e-12);
    assert!((arc.at(1.0).tip - arc.to.pose.tip).norm() < 1e-12);
    // A cubic from the corners of a square is Bernstein's sum.
    let corners = [V::zeros(), V::x() * 6.0, V::new(6.0, 6.0, 0.0), V::y() * 6.0];
    let way = Arc::new(BSpline {
        degree: 3,
        knots: vec![0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0],
        poles: corners.iter().map(|corner| (*corner, 1.0)).collect(),
    });
    assert!(way.is_sound());
    arc.way = Interpolation::Tip(Curve::Spline(Arc::clone(&way)));
    for step in 0..=10 {
        let t = f64::from(step) / 10.0;
        let s = 1.0 - t;
        let wanted = corners[1] * (3.0 * s * s * t)
            + corners[2] * (3.0 * s * t * t)
            + corners[3] * (t * t * t);
        assert!((arc.at(t).tip - wanted).norm() < 1e-12);
    }
    // Weights make a quarter of a circle of a parabola.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let circle = BSpline {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        poles: vec![(V::x(), 1.0), (V::new(1.0, 1.0, 0.0), half), (V::y(), 1.0)],
    };
    for step in 0..=10 {
        let point = circle.at(f64::from(step) / 10.0);
        assert!((point.norm() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_control_point_above_the_tip_goes_straight() {
    let pose = |tip: V, axis: V| Pose { tip, axis: axis.normalize(), edge: V::zeros() };
    let piece = CoursePiece {
        line: 1,
        kind: MotionKind::Feed,
        curve: Curve::Straight,
        from: pose(V::zeros(), V::z()),
        to: pose(V::x() * 10.0, V::new(1.0, 0.0, 1.0)),
        feed: None,
        turned_feed: None,
        hole: false,
    };
    let guided = |t: f64| {
        let pose = piece.at(t, 4.0);
        pose.tip + pose.axis * 4.0
    };
    let middle = guided(0.5) - (guided(0.0) + guided(1.0)) / 2.0;
    assert!(middle.norm() < 1e-12);
    // Halfway on the great circle: 22.5° from either end.
    let axis = piece.at(0.5, 0.0).axis;
    assert!((axis.dot(&V::z()) - libm::cos(TAU / 16.0)).abs() < 1e-12);
}

/// What was done, block by block.
struct Blocks(Vec<Vec<BlockEffect>>);

impl BlockRunner for Blocks {
    fn next(&mut self, done: &mut Vec<BlockEffect>) -> Result<bool, Box<Diagnostic>> {
        if self.0.is_empty() {
            return Ok(false);
        }
        done.extend(self.0.remove(0));
        Ok(true)
    }
}

fn course(blocks: Vec<Vec<BlockEffect>>) -> Vec<CourseItem> {
    let chords = Chords { tip: 0.001, axis: 1e-3, rapid: 0.5, rapid_axis: 0.1 };
    let mut course = ProgramCourse::new(Blocks(blocks), chords);
    std::iter::from_fn(|| course.next().unwrap()).collect()
}

fn rapid(state: &Arc<MachineState>, from: Joints, to: Joints, machine: bool) -> Vec<BlockEffect> {
    vec![BlockEffect::Motion(Motion {
        kind: MotionKind::Rapid,
        machine,
        ..motion(state, Interpolation::Axes, from, to)
    })]
}

#[test]
fn what_only_the_first_machine_does_is_no_path_of_the_part() {
    let state = turntable();
    let told = |told: ProgramEvent| vec![BlockEffect::Event { line: 1, event: told }];
    let change = || told(ProgramEvent::ToolChange { number: Some(1), name: None });
    let zero = at(0.0, 0.0, 0.0, 0.0);
    let up = at(0.0, 0.0, 0.0, 400.0);
    let items = course(vec![
        // To the tool changer, the table turned, across, and down: one approach.
        rapid(&state, zero, up, true),
        change(),
        rapid(&state, up, at(1.0, 0.0, 0.0, 400.0), false),
        rapid(&state, at(1.0, 0.0, 0.0, 400.0), at(1.0, 50.0, 20.0, 400.0), false),
        rapid(&state, at(1.0, 50.0, 20.0, 400.0), at(1.0, 50.0, 20.0, 10.0), false),
        rapid(&state, at(1.0, 50.0, 20.0, 10.0), at(1.0, 50.0, 20.0, 2.0), false),
        vec![BlockEffect::Motion(motion(
            &state,
            Interpolation::Axes,
            at(1.0, 50.0, 20.0, 2.0),
            at(1.0, 60.0, 20.0, 2.0),
        ))],
        // Away, and nothing more.
        rapid(&state, at(1.0, 60.0, 20.0, 2.0), at(1.0, 60.0, 20.0, 400.0), true),
        rapid(&state, at(1.0, 60.0, 20.0, 400.0), at(0.0, 0.0, 0.0, 400.0), false),
    ]);
    let kinds: Vec<&str> = items
        .iter()
        .map(|item| match item {
            CourseItem::Event { .. } => "told",
            CourseItem::Reach(_) => "reach",
            CourseItem::Piece(piece) if piece.kind == MotionKind::Rapid => "rapid",
            CourseItem::Piece(_) => "cut",
            CourseItem::Away { .. } => "away",
        })
        .collect();
    assert_eq!(kinds, ["told", "reach", "rapid", "cut", "away"]);
    let CourseItem::Reach(reach) = &items[1] else {
        panic!("{items:?}");
    };
    assert_eq!(reach.to.tip.z, 10.0);
    let CourseItem::Piece(cut) = &items[3] else {
        panic!("{items:?}");
    };
    assert_eq!((cut.from.tip.z, cut.feed), (2.0, Some(1000.0)));
}

#[test]
fn a_swing_of_the_table_at_feed_is_cut_into_chords_of_its_own_speed() {
    let state = turntable();
    let swing =
        motion(&state, Interpolation::Axes, at(0.0, 30.0, 0.0, 5.0), at(1.0, 60.0, 0.0, 5.0));
    let items = course(vec![vec![BlockEffect::Motion(swing.clone())]]);
    let pieces: Vec<&CoursePiece> = items
        .iter()
        .filter_map(|item| match item {
            CourseItem::Piece(piece) => Some(piece),
            _ => None,
        })
        .collect();
    assert!(pieces.len() > 20);
    // All of them together take as long as the block.
    let minutes: f64 = pieces.iter().map(|piece| piece.length() / piece.feed.unwrap()).sum();
    assert!((minutes - swing.minutes).abs() < 1e-12);
    // Farther out the part passes faster.
    assert!(pieces[pieces.len() - 1].feed > pieces[0].feed);
    let mut rng = seeded(5);
    for _ in 0..100 {
        let t = rng.range(0.0, 1.0);
        let near = pieces
            .iter()
            .map(|piece| {
                let way = piece.to.tip - piece.from.tip;
                let offset = swing.at(t).tip - piece.from.tip;
                let share = (offset.dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                (offset - way * share).norm()
            })
            .fold(f64::INFINITY, f64::min);
        assert!(near <= 0.001, "{near}");
    }
}
