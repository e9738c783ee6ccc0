//! Helices that a control is told by their turn alone (`CP IPA`): it stays at the distance from the centre at which it
//! begins, so it ends beside the words, and the next block begins there.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use post_plugin::Capabilities;
use post_testkit::{at_least, randomised};
use post_testruns::posted::{Asked, AskedArc, Bench};

use super::arcs::{ALL, CHAINS, LENGTH, Wanted, in_mm, machine, point, posted, wanted};

type V = Vector3<f64>;

/// How the control goes from where it stands, in program units.
struct Turned {
    centre: V,
    normal: Unit<V>,
    arm: V,
    angle: f64,
    /// What it gains from its centre, and along the normal.
    wider: f64,
    rise: f64,
}

impl Turned {
    fn new(stands: V, [from, to]: [V; 2], arc: &AskedArc) -> Self {
        let normal = Unit::new_normalize(V::from(arc.normal));
        let rise = normal.dot(&(to - from));
        let flat = |v: V| v - normal.into_inner() * normal.dot(&v);
        let centre = match arc.radius {
            None => V::from(arc.centre),
            Some(radius) => {
                // To the left of the way for a counter-clockwise arc of less than half a turn.
                let chord = flat(to - stands);
                let left = normal.cross(&chord).normalize() * 1f64.copysign(arc.turn);
                stands + chord / 2.0 + left * (radius * radius - chord.norm_squared() / 4.0).sqrt()
            }
        };
        let (arm, last) = (flat(stands - centre), flat(to - centre));
        let (angle, wider) = if rise == 0.0 {
            let angle = libm::atan2(normal.dot(&arm.cross(&last)), arm.dot(&last));
            let whole = std::f64::consts::TAU.copysign(arc.turn);
            // Ends that are one but for what sums of doubles leave are a whole turn apart.
            let angle = if angle * whole.signum() > 1e-9 { angle } else { angle + whole };
            (angle, last.norm() - arm.norm())
        } else {
            ((arc.turn * 1e5).round() * 1e-5 * std::f64::consts::PI / 180.0, 0.0)
        };
        Self { centre: stands - arm, normal, arm, angle, wider, rise }
    }

    fn at(&self, t: f64) -> V {
        let turn = UnitQuaternion::from_axis_angle(&self.normal, self.angle * t);
        let longer = 1.0 + self.wider * t / self.arm.norm();
        self.centre + turn * self.arm * longer + self.normal.into_inner() * self.rise * t
    }
}

/// A helix, a whole circle where it ends, and a straight way on: each is as near to the CL file as its block certifies.
#[test]
fn told_by_their_turn_they_are_as_near_as_certified() {
    let (rounds, mut rng) = randomised(60, 26);
    let (mut helices, mut beside, mut circles): (u32, f64, u32) = (0, 0.0, 0);
    for round in rounds {
        let tcp = ["post", "control"][rng.pick(2)];
        let (units, unit, decimals) = [("mm", 1.0, 3), ("inch", 25.4, 4)][rng.pick(2)];
        let form = ["centre", "radius"][rng.pick(2)];
        let split = ["full", "half", "quadrant"][rng.pick(3)];
        let more = format!("arcs = {{ form = \"{form}\", split = \"{split}\" }}");
        let chain = CHAINS[rng.pick(3)];
        let text = machine(&mut rng, chain, tcp, units, &more);
        let bench = Bench::new(&text, decimals, LENGTH);
        let helix = std::iter::repeat_with(|| wanted(&mut rng, &bench, tcp))
            .find(|arc| arc.normal.dot(&(arc.end - arc.start)).abs() > 0.05)
            .unwrap();
        let middle = helix.normal * helix.normal.dot(&(helix.end - helix.centre)) + helix.centre;
        let circle =
            Wanted { centre: middle, start: helix.end, turns: 1, ..helix.clone() }.written();
        let away = circle.end + (circle.end - middle) * 0.3;
        let round_it = circle.cl();
        let (_, round_it) = round_it.split_once("CIRCLE/").unwrap();
        let cl = format!(
            "{}CIRCLE/{}GOTO/{},{},{}\nFINI\n",
            helix.cl().replace("FINI", ""),
            round_it.replace("FINI", ""),
            away.x,
            away.y,
            away.z
        );
        let (run, blocks) = posted(&bench, decimals, ALL | Capabilities::HELIX_BY_TURN, &cl);
        let what = format!("round {round}: {tcp} {units} {form} {split}\n{cl}");
        let run = run.good(&what);
        let motions = run.motions();
        let mut stands = point(&motions[0].words);
        for (pair, block) in motions.windows(2).zip(&blocks[1..]) {
            let [from, to]: [&Asked; 2] = [pair[0], pair[1]];
            let ends = [point(&from.words), point(&to.words)];
            let turned = to.arc.as_ref().map(|arc| Turned::new(stands, ends, arc));
            let helical = turned.as_ref().is_some_and(|turned| turned.rise != 0.0);
            let begins = stands;
            let place = |t: f64| match &turned {
                Some(turned) => turned.at(t),
                None => begins * (1.0 - t) + ends[1] * t,
            };
            let mut worst: f64 = 0.0;
            for step in 0..=50 {
                let mut words = to.words.clone();
                words[..3].copy_from_slice(place(f64::from(step) / 50.0).as_slice());
                let (tip, _) = bench.reference.forward(&bench.joints(&in_mm(&words, unit)));
                worst = worst.max(off(tip, &helix, &circle, away));
            }
            let bound = block.deviation.tip;
            if block.kind != post_posting::BlockKind::Rapid {
                assert!(
                    worst <= bound + 1e-6,
                    "{worst} above {bound}, line {}\n{what}",
                    block.line
                );
            }
            let last = place(1.0);
            if let (Some(turned), Some(arc), false) = (&turned, &to.arc, helical) {
                circles += 1;
                // Where it were one of nothing, or a turn more.
                let extra = turned.angle.to_degrees() - arc.turn;
                assert!(extra.abs() < 1.0, "{extra}° more\n{what}");
            }
            stands = if helical { last } else { ends[1] };
            helices += u32::from(helical);
            beside = beside.max((stands - ends[1]).norm() * unit);
        }
    }
    println!(
        "{helices} helices, {circles} arcs in a plane; ends up to {beside:.6} mm beside their words"
    );
    assert!(helices > at_least(20) && circles > at_least(60) && beside > 1e-4);
}

/// How far a place is from the whole way.
fn off(place: V, helix: &Wanted, circle: &Wanted, away: V) -> f64 {
    let along = |arc: &Wanted| {
        let looks = 64 * arc.turns;
        let shares = (0..=looks).map(|look| f64::from(look) / f64::from(looks));
        let mut near: Vec<(f64, f64)> =
            shares.map(|share| ((arc.at(share) - place).norm(), share)).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A place of the next turn may be nearer than those looked at on its own.
        let nearest = near.iter().take(6);
        let nearest = nearest.map(|(_, share)| arc.nearest(place, *share));
        nearest.fold(f64::INFINITY, f64::min)
    };
    let line = |from: V, to: V| {
        let way = to - from;
        let share = ((place - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        (from + way * share - place).norm()
    };
    let down = line(helix.start + helix.axis * 10.0, helix.start);
    along(helix).min(along(circle)).min(line(circle.end, away)).min(down)
}
