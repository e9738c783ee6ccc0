//! Arcs that stay arcs: what a control makes of the printed words, worked out by quaternions, is held against the arc of
//! the CL file on random machines, in every plane, with the tables turned, as circles and helices, in mm and inch.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nalgebra::{Unit, UnitQuaternion, Vector3};
use post_machine::kinematics::Joints;
use post_plugin::{Capabilities, Feed};
use post_posting::{Block, Flow, Job, MotionKind, Observer};
use post_testkit::posted::{Asked, AskedArc, Bench, Recorder, Run, Samples, watched};
use post_testkit::{Rng, randomised};

type V = Vector3<f64>;

const ALL: Capabilities = Capabilities::ARC_XY
    .and(Capabilities::ARC_ZX)
    .and(Capabilities::ARC_YZ)
    .and(Capabilities::HELIX)
    .and(Capabilities::ARC_TCP)
    .and(Capabilities::ARC_RADIUS);

/// Keeps the blocks that are printed.
#[derive(Default)]
struct Printed(Vec<Block>);

impl Observer for Printed {
    fn blocks(&mut self, blocks: &[Flow<Block>]) {
        for next in blocks {
            if let Flow::Point(block) = next
                && !block.still
            {
                self.0.push(*block);
            }
        }
    }
}

/// Posts with a recorder that declares so much.
fn posted(bench: &Bench, decimals: u8, writes: Capabilities, cl: &str) -> (Run, Vec<Block>) {
    let mut dialect = Recorder::new(&bench.machine, decimals);
    dialect.capabilities = writes;
    let mut printed = Printed::default();
    let job = Job {
        tool_length: Some(LENGTH),
        ..Job::default()
    };
    let run = watched(
        &bench.machine,
        dialect,
        cl,
        job,
        &mut Samples,
        &mut [&mut printed],
    );
    (run, printed.0)
}

const LENGTH: f64 = 60.0;

/// How a control goes along an arc from the words `from` to those of `to`, in program units.
struct Controlled {
    centre: V,
    normal: Unit<V>,
    arm: V,
    angle: f64,
    radii: [f64; 2],
    from: Vec<f64>,
    to: Vec<f64>,
}

fn point(words: &[f64]) -> V {
    V::new(words[0], words[1], words[2])
}

impl Controlled {
    fn new(from: &[f64], to: &[f64], arc: &AskedArc) -> Self {
        let normal = Unit::new_normalize(V::from(arc.normal));
        let flat = |v: V| v - normal.into_inner() * normal.dot(&v);
        let (start, end) = (point(from), point(to));
        let clockwise = arc.turn < 0.0;
        let centre = match arc.radius {
            None => V::from(arc.centre),
            Some(radius) => {
                // The centre lies to the left of the way for a counter-clockwise arc of less than half a turn.
                let chord = flat(end - start);
                let left = normal.cross(&chord).normalize();
                let depth = (radius * radius - chord.norm_squared() / 4.0).sqrt();
                start + chord / 2.0 + left * if clockwise { -depth } else { depth }
            }
        };
        let (arm, last) = (flat(start - centre), flat(end - centre));
        let mut angle = normal.dot(&arm.cross(&last)).atan2(arm.dot(&last));
        if clockwise && angle >= 0.0 {
            angle -= TAU;
        } else if !clockwise && angle <= 0.0 {
            angle += TAU;
        }
        assert!(
            (angle.to_degrees() - arc.turn).abs() < 1e-6,
            "{angle} {}",
            arc.turn
        );
        Self {
            centre: start - arm,
            normal,
            arm: arm.normalize(),
            angle,
            radii: [arm.norm(), last.norm()],
            from: from.to_vec(),
            to: to.to_vec(),
        }
    }

    /// The words at a share of the way.
    fn words(&self, t: f64) -> Vec<f64> {
        let turn = UnitQuaternion::from_axis_angle(&self.normal, self.angle * t);
        let radius = self.radii[0] * (1.0 - t) + self.radii[1] * t;
        let rise = self.normal.dot(&(point(&self.to) - point(&self.from)));
        let place = self.centre + turn * self.arm * radius + self.normal.into_inner() * rise * t;
        let mut words = self.from.clone();
        words[..3].copy_from_slice(place.as_slice());
        words
    }
}

/// An arc of a CL file, by its own numbers.
#[derive(Clone, Debug)]
struct Wanted {
    centre: V,
    normal: V,
    start: V,
    end: V,
    turns: u32,
    axis: V,
}

impl Wanted {
    fn split(&self, p: V) -> (V, f64) {
        let height = self.normal.dot(&(p - self.centre));
        (p - self.centre - self.normal * height, height)
    }

    fn sweep(&self) -> f64 {
        let ((from, _), (to, _)) = (self.split(self.start), self.split(self.end));
        let angle = self.normal.dot(&from.cross(&to)).atan2(from.dot(&to));
        let first = if (from - to).norm() < 1e-3 {
            TAU
        } else if angle <= 0.0 {
            angle + TAU
        } else {
            angle
        };
        first + TAU * f64::from(self.turns - 1)
    }

    fn at(&self, t: f64) -> V {
        let ((from, low), (to, high)) = (self.split(self.start), self.split(self.end));
        let normal = Unit::new_normalize(self.normal);
        let turn = UnitQuaternion::from_axis_angle(&normal, self.sweep() * t);
        let radius = from.norm() * (1.0 - t) + to.norm() * t;
        self.centre + turn * from.normalize() * radius + self.normal * (low * (1.0 - t) + high * t)
    }

    /// How far a place is from the arc, close to a share of it.
    fn nearest(&self, place: V, share: f64) -> f64 {
        let off = |t: f64| (place - self.at(t)).norm();
        let (mut low, mut high) = (share - 0.02, share + 0.02);
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            match off(low + third) < off(high - third) {
                true => high -= third,
                false => low += third,
            }
        }
        off(low.midpoint(high))
    }

    fn cl(&self) -> String {
        let six = |p: V, q: V| {
            format!(
                "{:.6},{:.6},{:.6},{:.9},{:.9},{:.9}",
                p.x, p.y, p.z, q.x, q.y, q.z
            )
        };
        let radius = self.split(self.start).0.norm();
        let mut text = "UNITS/MM\nMULTAX/ON\nSPINDL/3000,RPM,CLW\nRAPID\n".to_owned();
        writeln!(
            text,
            "GOTO/{}",
            six(self.start + self.axis * 10.0, self.axis)
        )
        .unwrap();
        writeln!(text, "FEDRAT/600,MMPM\nGOTO/{}", six(self.start, self.axis)).unwrap();
        write!(text, "CIRCLE/{},{radius:.6}", six(self.centre, self.normal)).unwrap();
        if self.turns > 1 {
            write!(text, ",TIMES,{}", self.turns).unwrap();
        }
        writeln!(text, "\nGOTO/{}\nFINI", six(self.end, self.axis)).unwrap();
        text
    }

    /// With the numbers that its text has.
    fn written(mut self) -> Self {
        let tip = |v: V| v.map(|x| (x * 1e6).round() / 1e6);
        let way = |v: V| v.map(|x| (x * 1e9).round() / 1e9);
        (self.centre, self.start, self.end) = (tip(self.centre), tip(self.start), tip(self.end));
        (self.normal, self.axis) = (way(self.normal).normalize(), way(self.axis).normalize());
        self
    }
}

const CHAINS: [&str; 3] = [
    "[w C' A' b Y X Z t]",
    "[w C' b X Y Z A t]",
    "[w b X Y Z C A t]",
];

fn list(v: V) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

fn machine(rng: &mut Rng, chain: &str, tcp: &str, units: &str, more: &str) -> String {
    let mut text = format!(
        "name = \"random\"\nchain = \"{chain}\"\n[workpiece]\nmount = {}\n[tool]\ngauge = {}\n",
        list(rng.point(100.0)),
        list(rng.point(200.0))
    );
    for (name, direction) in [("C", V::z()), ("A", V::x())] {
        let point = list(rng.point(300.0));
        let direction = list(direction);
        writeln!(
            text,
            "[axis.{name}]\nrotary = {direction}\npoint = {point}\ncyclic = true\nmax_feed = 3600"
        )
        .unwrap();
    }
    for (name, direction) in [("X", V::x()), ("Y", V::y()), ("Z", V::z())] {
        let direction = list(direction);
        writeln!(
            text,
            "[axis.{name}]\nlinear = {direction}\ntravel = [-5000, 5000]\nmax_feed = 700"
        )
        .unwrap();
    }
    writeln!(
        text,
        "[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\nunits = \"{units}\"\n{more}\n\
         [accuracy]\ntolerance = 0.006\naxis_tolerance = 0.05"
    )
    .unwrap();
    text
}

/// An arc across an axis of the words, the tool standing as some random angles have it.
fn wanted(rng: &mut Rng, bench: &Bench, tcp: &str) -> Wanted {
    let mut q = Joints::default();
    q[bench.place("C")] = [0.0, rng.range(-3.0, 3.0)][rng.pick(2)];
    q[bench.place("A")] = [0.0, rng.range(-1.7, 1.7)][rng.pick(2)];
    let (_, axis) = bench.reference.forward(&q);
    let words = ["X", "Y", "Z"].map(|name| match tcp {
        "post" => bench.reference.direction(&q, bench.place(name)),
        _ => V::from_fn(|row, _| f64::from(u8::from("XYZ".find(name) == Some(row)))),
    });
    let place = rng.pick(3);
    let normal = words[place] * [1.0, -1.0][rng.pick(2)];
    let aside = words[(place + 1) % 3];
    let radius = rng.order(0.0, 2.3);
    let turn = |angle: f64| {
        UnitQuaternion::from_axis_angle(&Unit::new_normalize(normal), angle) * aside * radius
    };
    let (from, sweep) = (rng.range(-3.0, 3.0), rng.range(0.2, 6.2));
    let sweep = [sweep, sweep, TAU, TAU / 2.0][rng.pick(4)];
    let turns = 1 + u32::from(rng.pick(6) == 0) * rng.pick(3) as u32;
    let rise = [0.0, 0.0, rng.range(-0.2, 0.2) * radius * sweep][rng.pick(3)];
    let centre = rng.point(100.0);
    Wanted {
        centre,
        normal,
        start: centre + turn(from),
        end: centre + turn(from + sweep) + normal * rise,
        turns,
        axis,
    }
    .written()
}

/// Words in mm and degrees.
fn in_mm(words: &[f64], unit: f64) -> Vec<f64> {
    let mut words = words.to_vec();
    words[..3].iter_mut().for_each(|word| *word *= unit);
    words
}

/// Every place of the arc that the control makes is as near to the arc of the CL file as certified, the blocks follow one
/// another along it, and no axis leaves the range of the report or passes its largest feed.
#[test]
fn printed_arcs_are_as_near_as_certified() {
    let (rounds, mut rng) = randomised(400, 12);
    let (mut kept, mut whole, mut tightest) = (0, 0, f64::INFINITY);
    let mut all = 0;
    for round in rounds {
        let tcp = ["post", "control"][rng.pick(2)];
        let (units, unit, decimals) = [("mm", 1.0, 3), ("inch", 25.4, 5)][rng.pick(2)];
        let form = ["centre", "radius"][rng.pick(2)];
        let split = ["full", "half", "quadrant"][rng.pick(3)];
        let more = format!("arcs = {{ form = \"{form}\", split = \"{split}\" }}");
        let chain = CHAINS[rng.pick(3)];
        let bench = Bench::new(
            &machine(&mut rng, chain, tcp, units, &more),
            decimals,
            LENGTH,
        );
        let wanted = wanted(&mut rng, &bench, tcp);
        let cl = wanted.cl();
        let (run, blocks) = posted(&bench, decimals, ALL, &cl);
        let what = format!("round {round}: {tcp} {units} {form} {split} {chain}\n{cl}");
        let run = run.good(&what);
        let report = run.report.as_ref().unwrap();
        let motions = run.motions();
        assert_eq!(motions.len(), blocks.len(), "{what}");
        let (mut turned, mut time) = (0.0, 0.0);
        let sweep = wanted.sweep();
        all += 1;
        let arcs = motions.iter().filter(|asked| asked.arc.is_some()).count();
        kept += usize::from(arcs > 0);
        whole += usize::from(arcs == 1);
        for (pair, block) in motions.windows(2).zip(&blocks[1..]) {
            let [from, to]: [&Asked; 2] = [pair[0], pair[1]];
            let Some(arc) = &to.arc else {
                assert_ne!(block.kind, MotionKind::Arc);
                continue;
            };
            let controlled = Controlled::new(&from.words, &to.words, arc);
            let share = match arcs {
                1 => 1.0,
                _ => arc.turn.abs().to_radians() / sweep,
            };
            if split != "full" {
                let rounded = 0.002 / controlled.radii[0];
                assert!(arc.turn.abs().to_radians() < TAU / 2.0 + rounded, "{what}");
            }
            let (mut worst, mut before): (f64, Option<Joints>) = (0.0, None);
            let minutes = match to.feed {
                Some(Feed::PerMinute(feed)) => {
                    let rise = (point(&to.words) - point(&from.words)).dot(&V::from(arc.normal));
                    let length =
                        (controlled.radii[0] + controlled.radii[1]) / 2.0 * controlled.angle.abs();
                    assert!(
                        (length.hypot(rise) / feed - block.time.minutes).abs() < 1e-5,
                        "{what}"
                    );
                    // A control may divide F by the way in the plane.
                    length / feed
                }
                other => panic!("{other:?} {what}"),
            };
            for step in 0..=720 {
                let t = f64::from(step) / 720.0;
                let words = in_mm(&controlled.words(t), unit);
                let joints = bench.joints(&words);
                let (tip, axis) = bench.reference.forward(&joints);
                // Shares by the printed angle are off by what the ends are rounded.
                let off = match arcs {
                    1 => (tip - wanted.at(t)).norm(),
                    _ => wanted.nearest(tip, turned + share * t),
                };
                worst = worst.max(off);
                let lean = (axis - wanted.axis).norm();
                assert!(lean <= block.deviation.axis + 1e-9, "{what}");
                for range in &report.axes {
                    let place = bench.place(&range.name);
                    let axis = &bench.machine.axes[place];
                    let shown = axis.reading(joints[place]);
                    // Rotary axes may be shown on another turn.
                    let inside = (range.min - 2e-4..=range.max + 2e-4).contains(&shown);
                    assert!(inside, "{}: {shown} {range:?}\n{what}", range.name);
                    if let (Some(before), false) = (&before, axis.joint.rotary) {
                        let speed = (joints[place] - before[place]).abs() * 720.0 / minutes;
                        assert!(speed <= 700.0 * 1.0001, "{}: {speed}\n{what}", range.name);
                    }
                }
                before = Some(joints);
            }
            turned += share;
            time += minutes;
            assert!(
                worst <= block.deviation.tip + 1e-8,
                "{worst} above {}\n{what}",
                block.deviation.tip
            );
            assert!(block.deviation.tip <= 0.006);
            if arcs == 1 {
                tightest = tightest.min(worst / block.deviation.tip);
            }
        }
        if arcs > 0 {
            assert!((turned - 1.0).abs() < 1e-2, "{turned} {what}");
            assert!(time > 0.0);
        }
    }
    println!(
        "{kept} of {all} kept, {whole} in one block; bounds at most {:.2} times too large",
        1.0 / tightest
    );
    assert!(kept * 10 > all * 9, "{kept} of {all}");
}
