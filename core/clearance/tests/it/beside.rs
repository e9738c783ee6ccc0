//! Rapids near the stock: several of them may no more than one.

use nalgebra::Vector3;
use post_clearance::convex::Convex;
use post_clearance::piece::Way;
use post_clearance::proof::{Body, BodyKind, Look, Move, Proof, Rules};
use post_clearance::shape::Shape;
use post_machine::kinematics::{Chain, Joint, Joints, Solver};
use post_motion::path::{Interpolation, Stance};
use post_testkit::randomised;

/// A cutter, 10 mm wide, over a stock whose top is at zero, on three axes; 2 mm are kept at rapid.
struct Mill {
    solver: Solver,
    proof: Proof,
    at: Joints,
    /// What it goes is another way of the motion before.
    instead: bool,
}

impl Mill {
    fn new() -> Self {
        let axis = |direction| Joint { rotary: false, direction, point: Vector3::zeros() };
        let joints = vec![axis(Vector3::x()), axis(Vector3::y()), axis(Vector3::z())];
        let chain = Chain::new(joints.clone(), Vector3::zeros(), Vector3::zeros(), Vector3::z());
        let block = |low: [f64; 3], high: [f64; 3]| {
            Shape::new(vec![Convex::block(low.into(), high.into())]).unwrap()
        };
        let body = |kind, link, shape| Body { name: String::new(), kind, link, shape };
        let bodies = vec![
            body(BodyKind::Stock, 0, block([-100.0, -100.0, -50.0], [100.0, 100.0, 0.0])),
            body(BodyKind::Cutter, 3, block([-5.0, -5.0, 0.0], [5.0, 5.0, 50.0])),
        ];
        let rules = Rules { rapid: 2.0, ..Rules::default() };
        let proof = Proof::new(&joints, bodies, rules, |_, _| true);
        let solver = Solver::new(chain, &[], Joints::default()).unwrap();
        Self { solver, proof, at: Joints::default(), instead: false }
    }

    /// Goes to a place; whether that is not clear. At feed the cutter is not held against the stock.
    fn go(&mut self, to: [f64; 3], rapid: bool) -> bool {
        self.look(to, rapid, if rapid { Look::Prove } else { Look::LeaveOut })
    }

    /// Goes to a place at rapid where it has been; `back` along its cut.
    fn spare(&mut self, to: [f64; 3], back: bool) {
        assert!(!self.look(to, true, Look::Spare { back }));
    }

    fn look(&mut self, to: [f64; 3], rapid: bool, look: Look) -> bool {
        let mut joints = Joints::default();
        joints[..3].copy_from_slice(&to);
        let stances = [self.at, joints]
            .map(|joints| Stance { joints, pose: self.solver.chain().forward(&joints) });
        let way = Way {
            solver: &self.solver,
            interpolation: &Interpolation::Axes,
            ends: [&stances[0], &stances[1]],
            independent: false,
        };
        let faults = |proof: &Proof| proof.results().next().unwrap().faults;
        let before = faults(&self.proof);
        let motion = Move { way, rapid, line: 1, beyond: None, instead: self.instead };
        self.proof.take(&motion, |_, _| look);
        self.at = joints;
        faults(&self.proof) > before
    }

    /// A mill that has come near by a rapid, `over` the stock, from higher up.
    fn come(over: f64) -> Self {
        let mut mill = Self::new();
        mill.at[2] = 60.0;
        assert!(!mill.go([0.0, 0.0, 20.0], true));
        assert!(!mill.go([0.0, 0.0, over], true));
        mill
    }
}

#[test]
fn down_by_a_little_and_across_is_not_clear() {
    for (high, low) in [(2.2, 1.9), (20.0, 0.5)] {
        let mut mill = Mill::come(high);
        assert!(!mill.go([0.0, 0.0, low], true));
        assert!(mill.go([50.0, 0.0, low], true), "{high} {low}");
    }
    // However small the steps, and if it goes up a little before.
    let mut mill = Mill::come(1.5);
    let walks = (1..50).filter(|step| mill.go([f64::from(*step) * 0.1, 0.0, 1.5], true)).count();
    assert_eq!(walks, 49);
    let mut mill = Mill::come(1.5);
    assert!(!mill.go([0.0, 0.0, 1.8], true));
    assert!(mill.go([20.0, 0.0, 1.8], true));
}

#[test]
fn what_leaves_a_cut_or_comes_to_one_is_clear() {
    // Straight down in pieces, back up, and down again to a cut.
    let mut mill = Mill::come(1.9);
    assert!(!mill.go([0.0, 0.0, 0.7], true));
    assert!(!mill.go([0.0, 0.0, 0.2], true));
    assert!(!mill.go([0.0, 0.0, 10.0], true));
    assert!(!mill.go([0.0, 0.0, 0.2], true));
    assert!(!mill.go([30.0, 0.0, 0.1], false));
    // Out of the cut in pieces, away, and near again.
    assert!(!mill.go([30.0, 0.0, 0.3], true));
    assert!(!mill.go([30.1, 0.0, 0.6], true));
    assert!(!mill.go([30.1, 0.0, 1.9], true));
    assert!(!mill.go([31.0, 0.0, 30.0], true));
    assert!(!mill.go([40.0, 0.0, 1.0], true));
    assert!(mill.go([50.0, 0.0, 1.0], true));
    // To touch it is not clear anyhow.
    let mut mill = Mill::come(1.0);
    assert!(mill.go([0.0, 0.0, -0.1], true));
}

/// Off a wall and out along the tool axis; a cut's other end is one of its ends.
#[test]
fn what_leaves_a_cut_aside_goes_out_along_the_tool() {
    let mut mill = Mill::come(1.0);
    assert!(!mill.go([0.0, 0.0, 0.1], false));
    assert!(!mill.go([1.0, 0.0, 0.1], true));
    assert!(!mill.go([1.0, 0.0, 1.5], true));
    assert!(mill.go([2.0, 0.0, 1.5], true));
    assert!(!mill.go([2.0, 0.0, 30.0], true));
    // Back along the cut, and aside to where the next one begins.
    let mut mill = Mill::come(1.0);
    assert!(!mill.go([40.0, 0.0, 0.1], false));
    mill.spare([0.0, 0.0, 0.1], true);
    assert!(!mill.go([0.0, 9.0, 0.1], true));
    assert!(!mill.go([40.0, 9.0, 0.1], false));
    // But from above it it has left.
    mill.spare([40.0, 9.0, 0.3], false);
    assert!(mill.go([40.0, 12.0, 0.3], true));
}

/// Behind a cut several rapids may no more than from outside, and what was drawn out along its cut was away.
#[test]
fn no_run_walks_along_the_stock_behind_a_cut() {
    let cut = || {
        let mut mill = Mill::come(1.0);
        assert!(!mill.go([0.0, 0.0, -1.0], false));
        mill
    };
    let walks = |mill: &mut Mill| {
        let [x, z] = [mill.at[0], mill.at[2]];
        let steps = (1..=6).map(|step| mill.go([x + 5.0, f64::from(step % 2), z], true));
        steps.filter(|told| *told).count()
    };
    // Where it has been, out and near again, or out by a little.
    let mut mill = cut();
    mill.spare([0.0, 0.0, 10.0], false);
    mill.spare([0.0, 0.0, 0.3], false);
    assert_eq!(walks(&mut mill), 6);
    let mut mill = cut();
    mill.spare([0.0, 0.0, 0.3], false);
    assert_eq!(walks(&mut mill), 6);
    // Right behind the cut the first one leaves it.
    let mut mill = Mill::come(1.0);
    assert!(!mill.go([0.0, 0.0, 0.3], false));
    assert!(!mill.go([5.0, 0.0, 0.3], true));
    assert!(mill.go([5.0, 5.0, 0.3], true));
    assert!(mill.go([0.0, 5.0, 0.3], true));
    // A saw down by a slope and straight up again, the same way back, or another one.
    let mut mill = Mill::come(1.8);
    assert!(!mill.go([0.5, 0.0, 0.8], true));
    assert!(!mill.go([0.0, 0.0, 1.8], true));
    assert!(!mill.go([0.5, 0.0, 0.8], true));
    assert!(!mill.go([0.5, 0.0, 1.8], true));
    assert!(mill.go([1.0, 0.0, 0.8], true));
}

/// A motion that may go either of two ways is one rapid.
#[test]
fn another_way_of_a_rapid_is_no_other_rapid() {
    let mut mill = Mill::come(1.0);
    assert!(!mill.go([0.0, 0.0, 0.3], false));
    for (to, told) in [([5.0, 0.0, 0.3], false), ([5.0, 5.0, 0.3], true)] {
        let from = mill.at;
        assert_eq!(mill.go(to, true), told);
        mill.at = from;
        mill.instead = true;
        assert_eq!(mill.go(to, true), told);
        mill.instead = false;
    }
}

/// Random rapids between cuts: once it was farther away, a run that stays near leads on within 30° of the way that came near,
/// or is not clear.
#[test]
fn no_run_of_rapids_walks_along_the_stock() {
    let (rounds, mut rng) = randomised(300, 320);
    let (mut walks, mut comes) = (0, 0);
    for _ in rounds {
        let mut mill = Mill::come(rng.range(0.1, 1.9));
        let mut clear = true;
        let mut way = 0.0;
        for _ in 0..6 {
            let [x, y, z] = [0, 1, 2].map(|axis: usize| mill.at[axis]);
            let to = [
                x + rng.range(-4.0, 4.0),
                y + rng.range(-4.0, 4.0),
                rng.range(0.1, 1.9).min(z + 1.0),
            ];
            way += libm::hypot(to[0] - x, to[1] - y);
            clear &= !mill.go(to, true);
        }
        // Down and up again 30° lead no farther aside than by the height.
        walks += u32::from(clear && way > 2.1);
        comes += u32::from(clear);
    }
    assert_eq!(walks, 0, "{comes}");
}
