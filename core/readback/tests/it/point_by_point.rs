//! Programs that go point by point with their course: what is found does not hang on whether each line is told.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;
use post_readback::course::{Course, CourseItem, CoursePiece, Curve, ReachedPose};
use post_readback::verify::{Verification, Verifier, VerifyRules};
use post_readback::{
    BlockEffect, Coolants, Corners, Interpolation, MachineState, Motion, MotionKind, SpindleState,
    Stance,
};
use post_testkit::{Rng, randomised};

use crate::interpret::machine;

type V = Vector3<f64>;

/// Items in order.
struct Written(std::vec::IntoIter<CourseItem>);

impl Course for Written {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        Ok(self.0.next())
    }
}

/// How a path is drawn.
struct Draw {
    /// Ways from point to point, mm.
    step: f64,
    /// Share of the points at which the path turns anywhere.
    corners: usize,
    /// How far blocks end off their points, mm.
    off: f64,
    /// By how much the tool axis turns from point to point.
    turn: f64,
}

/// Poses of a path.
fn path(rng: &mut Rng, draw: &Draw) -> Vec<Pose> {
    let (mut tip, mut axis, mut way) = (V::zeros(), V::z(), rng.direction());
    (0..60 + rng.pick(200))
        .map(|_| {
            if rng.pick(draw.corners) == 0 {
                way = rng.direction();
            }
            way = (way + rng.direction() * 0.05).normalize();
            tip += way * draw.step * rng.range(0.5, 1.5);
            axis = (axis + rng.direction() * draw.turn).normalize();
            Pose { tip, axis, edge: V::zeros() }
        })
        .collect()
}

/// What a program does that follows a path, most of its blocks off their points by little.
fn program(
    rng: &mut Rng,
    draw: &Draw,
    path: &[Pose],
    state: &Arc<MachineState>,
) -> Vec<BlockEffect> {
    let mut places = Vec::new();
    for (index, pose) in path.iter().enumerate() {
        let far = match rng.pick(60) {
            0 => 0.012,
            1 => 0.04,
            2..5 => 0.008,
            _ => draw.off,
        };
        let off = rng.direction() * rng.range(0.0, far);
        let turned = rng.direction() * rng.range(0.0, if draw.turn > 0.0 { 1e-5 } else { 0.0 });
        let place =
            Pose { tip: pose.tip + off, axis: (pose.axis + turned).normalize(), edge: V::zeros() };
        // Now and then a point is left out, or one is put in.
        match rng.pick(40) {
            0 if index > 0 => {}
            1 if index > 0 => {
                let tip = (path[index - 1].tip + place.tip) * 0.5;
                places.extend([Pose { tip, ..place }, place]);
            }
            _ => places.push(place),
        }
    }
    let stance = |pose: Pose| Stance { joints: Default::default(), pose };
    let ends = places.windows(2).enumerate();
    let done = ends.map(|(index, ends)| {
        BlockEffect::Motion(Motion {
            line: index as u64 + 1,
            number: None,
            kind: MotionKind::Feed,
            way: Interpolation::TipAndAxis,
            from: stance(ends[0]),
            to: stance(ends[1]),
            feed: 500.0,
            minutes: (ends[1].tip - ends[0].tip).norm() / 500.0,
            minutes_at_fastest: (ends[1].tip - ends[0].tip).norm() / 500.0,
            by_time: false,
            stops: false,
            hole: false,
            machine: false,
            led: u32::MAX,
            fast: false,
            along: None,
            rapid_feed: 0.0,
            state: Arc::clone(state),
        })
    });
    done.collect()
}

fn course(path: &[Pose]) -> Written {
    let reach = ReachedPose {
        line: 1,
        kind: MotionKind::Feed,
        to: path[0],
        feed: Some(500.0),
        hole: false,
    };
    let pieces = path.windows(2).enumerate().map(|(index, ends)| {
        CourseItem::Piece(CoursePiece {
            line: index as u64 + 2,
            kind: MotionKind::Feed,
            curve: Curve::Straight,
            from: ends[0],
            to: ends[1],
            feed: Some(500.0),
            turned_feed: None,
            hole: false,
        })
    });
    Written([CourseItem::Reach(reach)].into_iter().chain(pieces).collect::<Vec<_>>().into_iter())
}

#[test]
fn what_is_found_does_not_hang_on_whether_each_line_is_told() {
    let machine = machine("ac-trunnion");
    let state = Arc::new(MachineState {
        solver: Arc::new(machine.solver(0.0).unwrap()),
        length: 0.0,
        tool: None,
        length_register: Some(1),
        length_of_spindle: false,
        radius_register: None,
        compensation: 0,
        tcp: true,
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
    });
    let (rounds, mut rng) = randomised(300, 284);
    for _ in rounds {
        let draw = Draw {
            step: *rng.choose(&[0.004, 0.02, 0.1, 1.0, 8.0]),
            corners: *rng.choose(&[4, 30, 1000]),
            off: *rng.choose(&[0.0, 1e-9, 0.0005, 0.002]),
            turn: *rng.choose(&[0.0, 0.0, 1e-4, 1e-3]),
        };
        let path = path(&mut rng, &draw);
        let done = program(&mut rng, &draw, &path, &state);
        let found = |rows: bool| -> Verification {
            let rules = VerifyRules { rows, most_faults: 500, ..VerifyRules::of(&machine) };
            let mut verifier = Verifier::new(&machine, rules, course(&path));
            for done in &done {
                verifier.take(done, &mut |_| {});
            }
            verifier.finish(&mut |_| {})
        };
        assert_eq!(found(true), found(false));
    }
}
