//! Error control over whole programs: every block, taken apart from its printed words and put through a forward
//! product that shares nothing with the crate, stays within what is certified, whatever the placement, with CL points
//! left out or not, compensated or linearised; and nothing of the path is cut off.

mod certified;
mod commands;
mod compensation;
mod lead;
mod order;
mod placement;
mod turns;

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_machine::kinematics::Joints;
use post_plugin::Feed;
use post_testkit::{Rng, at_least, randomised, rounds};
use post_testmachines::{across, angle, between, slerp};
use post_testruns::posted::{Bench, Run};
use post_testruns::walk::{Shape, Stop, Walk, blocks, from_program, leaned, stop, text, wanted};

type V = Vector3<f64>;

/// What a random machine is given.
#[derive(Clone, Debug)]
struct Given {
    /// Rotary axes that carry the part: 2, 1 or 0.
    tables: usize,
    /// C upright and the other level or at 45°, rather than anything.
    usual: bool,
    tcp: &'static str,
    along: f64,
    radius: f64,
    decimals: u8,
    tolerance: f64,
    axis_tolerance: f64,
    pole: &'static str,
    corner: f64,
}

const CONFIGS: [&str; 8] = [
    "placement = \"bisect\"",
    "placement = \"even\"",
    "placement = \"fewest\"",
    "method = \"compensate\"",
    "placement = \"bisect\"\nreduce = true",
    "placement = \"even\"\nreduce = true",
    "placement = \"fewest\"\nreduce = true",
    "method = \"compensate\"\nreduce = true",
];

fn given(rng: &mut Rng) -> Given {
    let decimals = 3 + rng.pick(3) as u8;
    let corner = [10.0, 10.0, 0.0, 60.0, 180.0][rng.pick(5)];
    let pointed = rng.pick(4);
    Given {
        tables: rng.pick(3),
        usual: rng.pick(2) == 0,
        tcp: ["post", "control"][rng.pick(2)],
        along: if pointed & 1 == 1 { rng.range(-40.0, 80.0) } else { 0.0 },
        radius: if pointed & 2 == 2 { rng.range(1.0, 40.0) } else { 0.0 },
        decimals,
        tolerance: rng.order(if decimals == 3 { -2.0 } else { -2.5 }, -1.0),
        axis_tolerance: rng.order(-1.2, 0.0),
        pole: ["exact", "blend"][rng.pick(2)],
        corner,
    }
}

/// A vector as a machine file has it.
fn list(v: V) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

/// The table of an endless rotary axis.
fn endless(name: &str, direction: V, point: V) -> String {
    format!(
        "[axis.{name}]\nrotary = {}\npoint = {}\ncyclic = true\nmax_feed = 1e7\n",
        list(direction),
        list(point)
    )
}

/// A machine file of no particular machine; what stands for `{more}` is a configuration.
fn machine(rng: &mut Rng, given: &Given) -> String {
    let (mut first, mut second) = (rng.direction(), rng.direction());
    while first.cross(&second).norm() < 0.3 || second.z.abs() > 0.9 {
        (first, second) = (rng.direction(), rng.direction());
    }
    if given.usual {
        first = V::z();
        second = [V::x(), V::y(), V::new(0.0, 1.0, 1.0)][rng.pick(3)];
    }
    let chain = match given.tables {
        2 => "[w C' A' b Y X Z t]",
        1 => "[w C' b X Y Z A t]",
        _ => "[w b X Y Z C A t]",
    };
    let lean = if rng.pick(2) == 0 { 0.0 } else { 0.05 };
    let mut out = format!("name = \"random\"\nchain = \"{chain}\"\n");
    writeln!(out, "[workpiece]\nmount = {}", list(rng.point(100.0))).unwrap();
    writeln!(
        out,
        "[tool]\ngauge = {}\ncontrol_point = {{ along = {}, radius = {} }}",
        list(rng.point(200.0)),
        given.along,
        given.radius
    )
    .unwrap();
    for (name, direction) in [("C", first), ("A", second)] {
        out += &endless(name, direction, rng.point(300.0));
    }
    for (name, direction) in [("X", V::x()), ("Y", V::y()), ("Z", V::z())] {
        let direction = direction + rng.point(lean);
        writeln!(
            out,
            "[axis.{name}]\nlinear = {}\ntravel = [-20000, 20000]\nmax_feed = 1e7",
            list(direction)
        )
        .unwrap();
    }
    writeln!(
        out,
        "[control]\ndialect = \"recorder\"\ntcp = \"{}\"\n[solution]\npole = \"{}\"",
        given.tcp, given.pole
    )
    .unwrap();
    writeln!(
        out,
        "[accuracy]\ntolerance = {}\naxis_tolerance = {}\nrapid_tolerance = 0.5\ncorner = {}\n{{more}}",
        given.tolerance, given.axis_tolerance, given.corner
    )
    .unwrap();
    out
}

fn bench_of(machine: &str, given: &Given, config: &str) -> Bench {
    let length = if given.tables < 2 { 120.0 } else { 0.0 };
    Bench::new(&machine.replace("{more}", config), given.decimals, length)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Profile {
    Smooth,
    Corners,
    Dense,
    Uneven,
    Kinks,
    Turns,
    Pole,
    Across,
    Mixed,
}

/// A path that the machine can go: the rotary axes go somehow, the tip goes as it likes.
fn path(rng: &mut Rng, bench: &Bench, profile: Profile, count: usize) -> Vec<Stop> {
    let (c, a) = (bench.place("C"), bench.place("A"));
    let mut tip = rng.point(60.0);
    let mut way = rng.direction();
    let mut about = across(rng, way);
    let bend = rng.range(0.0, 3.0).to_radians();
    let mut angles = [rng.range(-3.0, 3.0), rng.range(0.3, 1.2)];
    if profile == Profile::Pole {
        angles[1] = rng.range(-0.02, 0.02);
    }
    let lean = rng.order(-1.5, 0.3).to_radians();
    let mut rates = [rng.range(-lean, lean), rng.range(-lean, lean)];
    let mut feed = Some(1000.0);
    let mut stops: Vec<Stop> = Vec::new();
    let even = rng.range(0.5, 4.0);
    let beside = [rng.order(-6.0, -1.5), rng.order(-2.0, -0.5), rng.range(-3.0, 3.0)];
    for index in 0..count {
        let mut joints = Joints::default();
        joints[c] = angles[0];
        joints[a] = angles[1];
        let mut axis = bench.reference.forward(&joints).1;
        if profile == Profile::Across {
            // Past the pole of a machine whose C is upright, close by.
            let share = index as f64 / (count - 1) as f64 - 0.5;
            axis = leaned(V::new(beside[0], beside[1] * share, 1.0).normalize(), V::z(), beside[2]);
        }
        let mut next = stop(tip, axis, feed);
        if index == 0 {
            next.feed = None;
        }
        if profile == Profile::Mixed && index > 0 {
            match rng.pick(14) {
                0 => next.before = "COOLNT/ON\n".to_owned(),
                1 => next.before = "PPRINT/SOMETHING\n".to_owned(),
                2 => next.before = format!("SPINDL/{},RPM,CLW\n", 1000 + index),
                3 => next.before = "DELAY/1\n".to_owned(),
                4 => next.feed = None,
                5 => feed = Some(rng.range(200.0, 2000.0).round()),
                _ => {}
            }
            if next.feed.is_some() {
                next.feed = feed;
            }
        }
        stops.push(next);
        let length = match profile {
            Profile::Dense => rng.range(0.01, 0.1),
            Profile::Uneven | Profile::Mixed => rng.order(-2.0, 0.8),
            Profile::Turns if rng.pick(4) == 0 => 0.0,
            _ => even,
        };
        let share = match profile {
            Profile::Turns => 1.0,
            _ => length / 2.0,
        };
        tip += way * length;
        for (value, rate) in angles.iter_mut().zip(rates) {
            *value += rate * share;
        }
        way = leaned(way, about, bend * share);
        let corners = matches!(profile, Profile::Corners | Profile::Mixed);
        if corners && rng.pick(5) == 0 {
            let by = rng.range(2.0, 175.0).to_radians();
            about = across(rng, way);
            way = leaned(way, about, by);
            about = across(rng, way);
        }
        let kinks = matches!(profile, Profile::Kinks | Profile::Mixed | Profile::Turns);
        if kinks && rng.pick(3) == 0 {
            rates = [rng.range(-lean, lean), rng.range(-lean, lean)];
        } else {
            for rate in &mut rates {
                *rate += rng.range(-0.05, 0.05) * lean;
            }
        }
    }
    stops
}

/// The largest error of the tip and the tool axis (radians) that the decimals of the words make.
fn rounding(given: &Given) -> [f64; 2] {
    let half = 0.5 * libm::pow(10.0, -f64::from(given.decimals));
    let turn = 2.0 * half.to_radians() + 2e-8;
    let swung = if given.tcp == "control" { given.along.abs() * turn } else { 0.0 };
    [3.0 * half + 2e-6 + swung, turn]
}

/// CL points that must be met.
fn kept(stops: &[Stop], path: &[(V, V)], corner: f64) -> Vec<bool> {
    (0..stops.len())
        .map(|index| {
            let Some(next) = stops.get(index + 1) else {
                return true;
            };
            if index == 0 || !next.before.is_empty() {
                return true;
            }
            let (here, there) = (&stops[index], next);
            if here.feed != there.feed || here.feed.is_none() {
                return true;
            }
            let first = path[index].0 - path[index - 1].0;
            let second = path[index + 1].0 - path[index].0;
            first.norm() < 1e-6
                || second.norm() < 1e-6
                || angle(first.normalize(), second.normalize()) > corner + 1e-6
        })
        .collect()
}

/// What a program was found to be.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    blocks: usize,
    time: f64,
    missed: f64,
}

/// Holds a program against its CL file; an error says what is wrong.
fn hold(
    bench: &Bench,
    given: &Given,
    stops: &[Stop],
    lines: &[u64],
    run: &Run,
    samples: u32,
    config: &str,
) -> Result<Found, String> {
    let reduces = config.contains("reduce = true");
    let report = run.report.as_ref().expect("a program");
    let path = wanted(stops, given.along);
    let blocks = blocks(bench, run);
    let (tip, axis) = (report.tip_deviation_mm.value, report.axis_deviation_deg.value.to_radians());
    if tip > given.tolerance + 1e-9 {
        return Err(format!("certified {tip}, tolerance {}", given.tolerance));
    }
    if axis.to_degrees() > given.axis_tolerance + 1e-9 {
        return Err(format!("certified axis {}", axis.to_degrees()));
    }
    let [tip_rounding, axis_rounding] = rounding(given);
    // The leg that ends in the CL point of a line.
    let leg = |line: u64| lines.partition_point(|known| *known < line).max(1) - 1;
    let mut walk = Walk::new(&path);
    for (number, block) in blocks.iter().enumerate() {
        let last = leg(block.lines[1]);
        let (bound, axis_bound) = if block.rapid {
            (report.rapid_deviation_mm.value + 1e-7, f64::INFINITY)
        } else {
            (tip + 1e-7, axis + 1e-8)
        };
        if walk.at().0 + 1 < leg(block.lines[0]) && !reduces {
            return Err(format!("block {number} leaves legs out"));
        }
        for step in 0..=samples {
            let t = f64::from(step) / f64::from(samples);
            let place = block.at(bench, t);
            if let Err([off, apart]) = walk.reach(place, last, bound, axis_bound) {
                return Err(format!(
                    "block {number} of lines {:?} at {t}: {off} mm, {}°, certified {tip} mm, {}°; walked to {:?} of leg {last}",
                    block.lines,
                    apart.to_degrees(),
                    axis.to_degrees(),
                    walk.at()
                ));
            }
        }
        // A block that ends in a CL point that must be met leaves its legs behind.
        if lines.contains(&block.lines[1])
            && blocks.get(number + 1).is_none_or(|next| next.lines[1] != block.lines[1])
            && !reduces
        {
            walk.leave((last + 1).min(path.len() - 2));
        }
        if given.radius > 0.0 && !block.rapid {
            let legs = [leg(block.lines[0]), last];
            edge_stays_near(bench, given, block, &path[legs[0]..=legs[1] + 1], tip)
                .map_err(|fault| format!("edge of block {number}: {fault}"))?;
        }
    }
    // Nothing is cut off: every CL point and what lies between is near the program.
    let cl = blocks.iter().map(|block| block.lines.map(leg));
    let ranges: Vec<[usize; 2]> = cl.collect();
    let mut missed = 0.0f64;
    for (index, pair) in path.windows(2).enumerate() {
        if stops[index + 1].feed.is_none() {
            continue;
        }
        // Blocks that may have to do with this leg.
        let first = ranges.partition_point(|[_, to]| *to < index);
        let last = ranges.partition_point(|[from, _]| *from <= index);
        if first >= last {
            // Nothing was written: the leg is shorter than the words' decimals.
            continue;
        }
        for step in 0..=4 {
            let t = f64::from(step) / 4.0;
            let point = pair[0].0 * (1.0 - t) + pair[1].0 * t;
            let off = from_program(bench, &blocks, first..last, 24, point);
            missed = missed.max(off);
            if off > tip * 1.001 + 1e-6 {
                return Err(format!(
                    "leg {index} at {t} is {off} from the program, certified {tip}"
                ));
            }
        }
    }
    // Points that are to be met are met.
    let must = kept(stops, &path, bench.machine.accuracy.corner);
    for (index, stop) in stops.iter().enumerate() {
        if reduces && !must[index] {
            continue;
        }
        let words = run.arrival(lines[index]).expect("a block");
        let joints = bench.joints(words);
        let (mut reached, axis) = bench.reference.forward(&joints);
        if given.tcp == "control" {
            reached = V::new(words[0], words[1], words[2]);
        }
        let reached = reached + axis * given.along;
        let (off, apart) = ((reached - path[index].0).norm(), angle(axis, path[index].1));
        // Close to a pole a point may be eased.
        let eased = given.pole == "blend";
        let allowed = if eased && given.tcp == "control" {
            tip_rounding + given.along.abs() * given.axis_tolerance.to_radians()
        } else {
            tip_rounding
        };
        if off > allowed || (apart > axis_rounding && !eased) {
            return Err(format!(
                "CL point {index} (line {}, {:?}) is missed by {off} mm, {}°",
                lines[index],
                stop.feed,
                apart.to_degrees()
            ));
        }
    }
    // No block goes faster than was asked for.
    for block in blocks.iter().filter(|block| !block.rapid) {
        let asked = stops[leg(block.lines[1]) + 1].feed.unwrap_or(f64::INFINITY);
        let [(from, first), (to, last)] = [block.at(bench, 0.0), block.at(bench, 1.0)];
        let length = (to - from).norm();
        // Degrees a minute, where the control sees a tip that stands still: in a piece of a move that is too short for
        // the words, or under a control point that moves.
        let tip = (to - from - (last - first) * given.along).norm();
        let degrees = tip < 3e-3;
        match block.feed {
            Some(Feed::PerMinute(feed))
                if given.tcp == "control" && !degrees && feed > asked + 1e-6 =>
            {
                return Err(format!("a feed of {feed}, asked {asked}"));
            }
            Some(Feed::InverseTime(feed))
                if length > 0.01 && given.along == 0.0 && feed * length > asked * (1.0 + 1e-6) =>
            {
                return Err(format!("{} mm/min, asked {asked}", feed * length));
            }
            _ => {}
        }
    }
    Ok(Found { blocks: blocks.len(), time: report.cutting_time_s, missed })
}

/// The circle of a cutting edge is near the circle that is wanted somewhere along the legs: none of its points is
/// farther from that than their middles, and the radius times the difference of their axes.
fn edge_stays_near(
    bench: &Bench,
    given: &Given,
    block: &post_testruns::walk::Block,
    path: &[(V, V)],
    certified: f64,
) -> Result<(), String> {
    for step in 0..=20 {
        let (point, axis) = block.at(bench, f64::from(step) / 20.0);
        let mut nearest = f64::INFINITY;
        for leg in path.windows(2) {
            let off = |t: f64| {
                let middle = leg[0].0 * (1.0 - t) + leg[1].0 * t;
                let wanted = slerp(leg[0].1, leg[1].1, t);
                (point - middle).norm() + given.radius * (axis - wanted).norm()
            };
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..60 {
                let third = (high - low) / 3.0;
                if off(low + third) < off(high - third) {
                    high -= third;
                } else {
                    low += third;
                }
            }
            nearest = nearest.min(off((low + high) / 2.0));
        }
        if nearest > certified * (1.0 + 1e-6) + 1e-7 {
            return Err(format!("{nearest} mm, certified {certified}"));
        }
    }
    Ok(())
}

/// The largest deviation of the control point (mm) and the tool axis (radians) from a single leg at the same share.
fn strays(bench: &Bench, block: &post_testruns::walk::Block, path: &[(V, V)]) -> [f64; 2] {
    let mut most = [0.0f64; 2];
    for step in 0..=400 {
        let t = f64::from(step) / 400.0;
        let (tip, axis) = block.at(bench, t);
        let chord = path[0].0 * (1.0 - t) + path[1].0 * t;
        most[0] = most[0].max((tip - chord).norm());
        most[1] = most[1].max(angle(axis, slerp(path[0].1, path[1].1, t)));
    }
    most
}

const LINEAR: &str = "
[axis.X]
linear = [1, 0, 0]
travel = [-20000, 20000]
max_feed = 1e7
[axis.Y]
linear = [0, 1, 0]
travel = [-20000, 20000]
max_feed = 1e7
[axis.Z]
linear = [0, 0, 1]
travel = [-20000, 20000]
max_feed = 1e7
";

/// Head or trunnion with C upright and A level.
fn usual(head: bool, tcp: &str, c: &str, more: &str) -> String {
    let chain = if head { "[w b X Y Z C A t]" } else { "[w C' A' b X Y Z t]" };
    format!(
        "name = \"usual\"\nchain = \"{chain}\"\n[tool]\ngauge = [0, 0, 0]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\n{c}\nmax_feed = 1e7\n[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, 200]\ncyclic = true\nmax_feed = 1e7\n{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\n{more}"
    )
}
