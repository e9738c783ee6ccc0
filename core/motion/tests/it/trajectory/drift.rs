//! Ten million set-points: times and positions stay exact.

use post_machine::kinematics::Joints;
use post_motion::path::Interpolation;
use post_motion::trajectory::{FillOutcome, Planner};
use post_motion::{CornerMode, Move, MovePace, SetPoints, Task};
use std::sync::Arc;

use super::build::{Program, trunnion};

/// Way of a move, mm; its feed, mm/s; acceleration, mm/s²: 0.96 s and a fraction of a period each.
const WAY: f64 = 57.3;
const FEED: f64 = 64.0;
const ACCELERATION: f64 = 800.0;

/// How long a move takes from rest to rest, s.
const SECONDS: f64 = WAY / FEED + FEED / ACCELERATION;

/// So many moves are more than ten million set-points.
const MOVES: u64 = 10_300;

/// How far a move has got after `t` seconds, mm.
fn covered(t: f64) -> f64 {
    let ramp = FEED / ACCELERATION;
    let t = t.clamp(0.0, SECONDS);
    let left = SECONDS - t;
    if t < ramp {
        0.5 * ACCELERATION * t * t
    } else if left < ramp {
        WAY - 0.5 * ACCELERATION * left * left
    } else {
        FEED * (t - 0.5 * ramp)
    }
}

/// To and fro along X, standing still at each end: every set-point against the trapezoid, every move against its time.
#[test]
fn times_and_positions_do_not_drift() {
    let linear = format!("max_feed = 30000, max_accel = {ACCELERATION}");
    let machine = trunnion(&linear, "max_feed = 5400, max_accel = 600", "");
    let start = Program::new(&machine, [0.0; 3]);
    let ends = [0.0, WAY].map(|x| start.stance([x, 0.0, 0.0], &Joints::default()));
    let mut planner = Planner::new(&machine);
    let period = machine.motion.period;
    let mut batch = SetPoints::new(Arc::clone(&start.solver), period);
    let mut times = Vec::new();
    let (mut count, mut timed) = (0u64, 0u64);
    let (mut worst, mut late) = (0.0_f64, 0.0_f64);
    let mut last = f64::NAN;
    for number in 0..=MOVES {
        if number < MOVES {
            let turned = (number % 2) as usize;
            let task = Task::Move(Move {
                line: number + 1,
                way: Interpolation::Axes,
                from: ends[turned],
                to: ends[1 - turned],
                solver: Arc::clone(&start.solver),
                keeps_tip: false,
                pace: MovePace::Minutes(WAY / FEED / 60.0),
                corner: CornerMode::Stop,
            });
            planner.push(task).unwrap();
        } else {
            planner.end();
        }
        loop {
            let filled = planner.fill(&mut batch, 256, &mut times).unwrap();
            for (place, joints) in batch.joints.iter().enumerate() {
                let time = batch.time(place);
                let begun = (time / SECONDS).floor().min((MOVES - 1) as f64);
                let way = covered(time - begun * SECONDS);
                let x = if begun % 2.0 == 0.0 { way } else { WAY - way };
                worst = worst.max((joints[2] - x).abs());
                last = joints[2];
            }
            count += batch.len() as u64;
            batch.clear();
            for time in times.drain(..) {
                late = late.max((time.begins - time.task as f64 * SECONDS).abs());
                late = late.max((time.seconds - SECONDS).abs());
                timed += 1;
            }
            if filled != FillOutcome::Full {
                break;
            }
        }
    }
    assert!(count > 10_000_000 && timed == MOVES, "{count} {timed}");
    // Clocks are added up: thirty thousand roundings of up to 1e-12 s, and what the feed makes of them.
    assert!(late < 1e-8, "{late} s");
    assert!(worst < 1e-6, "{worst} mm");
    let end = if MOVES.is_multiple_of(2) { 0.0 } else { WAY };
    assert_eq!(last, end);
}
