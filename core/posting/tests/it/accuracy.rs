//! Error control over whole programs: every block, taken apart from its printed words and put through a forward
//! product that shares nothing with the crate, stays within what is certified, whatever the placement, with CL points
//! left out or not, compensated or linearised; and nothing of the path is cut off.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_machine::kinematics::Joints;
use post_plugin::Feed;
use post_testkit::posted::{Bench, Run};
use post_testkit::walk::{Shape, Stop, Walk, blocks, from_program, leaned, stop, text, wanted};
use post_testkit::{Rng, across, angle, between, randomised, slerp};

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
        along: if pointed & 1 == 1 {
            rng.range(-40.0, 80.0)
        } else {
            0.0
        },
        radius: if pointed & 2 == 2 {
            rng.range(1.0, 40.0)
        } else {
            0.0
        },
        decimals,
        tolerance: rng.order(if decimals == 3 { -2.0 } else { -2.5 }, -1.0),
        axis_tolerance: rng.order(-1.2, 0.0),
        pole: ["exact", "blend"][rng.pick(2)],
        corner,
    }
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
    let list = |v: V| format!("[{}, {}, {}]", v.x, v.y, v.z);
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
        let point = rng.point(300.0);
        writeln!(
            out,
            "[axis.{name}]\nrotary = {}\npoint = {}\ncyclic = true\nmax_feed = 1e7",
            list(direction),
            list(point)
        )
        .unwrap();
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

const PROFILES: [Profile; 9] = [
    Profile::Smooth,
    Profile::Corners,
    Profile::Dense,
    Profile::Uneven,
    Profile::Kinks,
    Profile::Turns,
    Profile::Pole,
    Profile::Across,
    Profile::Mixed,
];

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
    let beside = [
        rng.order(-6.0, -1.5),
        rng.order(-2.0, -0.5),
        rng.range(-3.0, 3.0),
    ];
    for index in 0..count {
        let mut joints = Joints::default();
        joints[c] = angles[0];
        joints[a] = angles[1];
        let mut axis = bench.reference.forward(&joints).1;
        if profile == Profile::Across {
            // Past the pole of a machine whose C is upright, close by.
            let share = index as f64 / (count - 1) as f64 - 0.5;
            axis = leaned(
                V::new(beside[0], beside[1] * share, 1.0).normalize(),
                V::z(),
                beside[2],
            );
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
    let swung = if given.tcp == "control" {
        given.along.abs() * turn
    } else {
        0.0
    };
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
    let (tip, axis) = (
        report.tip_deviation_mm.value,
        report.axis_deviation_deg.value.to_radians(),
    );
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
            && blocks
                .get(number + 1)
                .is_none_or(|next| next.lines[1] != block.lines[1])
            && !reduces
        {
            walk.leave((last + 1).min(path.len() - 2));
        }
        if given.radius > 0.0 && !block.rapid {
            let legs = [leg(block.lines[0]), last];
            edges_go_straight(bench, given, block, &path[legs[0]..=legs[1] + 1], tip)
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
    Ok(Found {
        blocks: blocks.len(),
        time: report.cutting_time_s,
        missed,
    })
}

/// Eqs. 9 and 10 of the parabolic paper, by sampling: how far a point of the cutting edge strays beyond the control
/// point is how far its direction strays from the chord between the places where the block passes CL points.
fn edges_go_straight(
    bench: &Bench,
    given: &Given,
    block: &post_testkit::walk::Block,
    path: &[(V, V)],
    certified: f64,
) -> Result<(), String> {
    const STEPS: u32 = 40;
    let even = |step: u32| f64::from(step) / f64::from(STEPS);
    // Where the block passes CL points.
    let mut passed = vec![0.0];
    for (point, _) in &path[1..path.len() - 1] {
        let off = |t: f64| (block.at(bench, t).0 - point).norm();
        let nearest = (0..=STEPS)
            .map(even)
            .min_by(|a, b| off(*a).total_cmp(&off(*b)));
        let (mut low, mut high) = nearest.map_or((0.0, 1.0), |t| (t - 0.025, t + 0.025));
        for _ in 0..40 {
            let third = (high - low) / 3.0;
            if off(low + third) < off(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        let t = (low + high) / 2.0;
        if t > passed[passed.len() - 1] && t < 1.0 {
            passed.push(t);
        }
    }
    passed.push(1.0);
    let axis = bench.reference.axis;
    let flat = if axis.x.abs() < 0.8 { V::x() } else { V::y() };
    let side = axis.cross(&flat).normalize();
    let other = axis.cross(&side);
    for pair in passed.windows(2) {
        for around in 0..4 {
            let (sine, cosine) = libm::sincos(f64::from(around) * std::f64::consts::FRAC_PI_4);
            let arm = (side * cosine + other * sine) * given.radius;
            let at = |t: f64| block.rotation(bench, t) * arm;
            let ends = [at(pair[0]), at(pair[1])];
            for step in 1..8 {
                let share = f64::from(step) / 8.0;
                let t = pair[0] * (1.0 - share) + pair[1] * share;
                let bow = (at(t) - (ends[0] * (1.0 - share) + ends[1] * share)).norm();
                let point = block.at(bench, t).0;
                let legs = path.windows(2);
                let off = legs
                    .map(|leg| post_testkit::distance(point, leg[0].0, leg[1].0))
                    .fold(f64::INFINITY, f64::min);
                if off + bow > certified * (1.0 + 1e-3) + 1e-7 {
                    return Err(format!("{off} and {bow}, certified {certified}"));
                }
            }
        }
    }
    Ok(())
}

/// Random machines, random paths, every way of error control.
#[test]
fn every_block_stays_within_what_is_certified() {
    let (rounds, mut rng) = randomised(160, 1);
    let mut faults: Vec<String> = Vec::new();
    let (mut programs, mut skipped) = (0, 0);
    let mut sums = [0usize; CONFIGS.len()];
    let mut missed = 0.0f64;
    for round in rounds.clone() {
        let profile = PROFILES[round % PROFILES.len()];
        let given = given(&mut rng);
        let given = Given {
            usual: given.usual || profile == Profile::Across,
            ..given
        };
        let machine = machine(&mut rng, &given);
        let samples = if round % 40 == 0 { 10_000 } else { 60 };
        let count = if samples > 100 { 5 } else { 24 };
        let bench = bench_of(&machine, &given, CONFIGS[0]);
        let stops = path(&mut rng, &bench, profile, count);
        let (cl, lines) = text(&stops);
        let mut made: [Option<Found>; CONFIGS.len()] = Default::default();
        for (which, config) in CONFIGS.iter().enumerate() {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false);
            let what = format!("round {round}, {profile:?}, {}, {config:?}", given.tcp);
            if run.report.is_none() {
                if which == 0 {
                    skipped += 1;
                    break;
                }
                faults.push(format!("{what}: refused: {}", run.told()));
                continue;
            }
            programs += 1;
            match hold(&bench, &given, &stops, &lines, &run, samples, config) {
                Ok(found) => {
                    made[which] = Some(found);
                    sums[which] += found.blocks;
                    missed = missed.max(found.missed / given.tolerance);
                }
                Err(fault) => faults.push(format!("{what}: {fault}; {given:?}")),
            }
        }
        // Left out or not, the program takes the same time.
        let times: Vec<f64> = made.iter().flatten().map(|found| found.time).collect();
        for time in &times {
            let apart = (time / times[0] - 1.0).abs();
            let turns = profile == Profile::Turns && given.along != 0.0;
            if apart > 0.02 && !turns {
                faults.push(format!("round {round}, {profile:?}: s {times:?}"));
                break;
            }
        }
    }
    println!("{programs} programs, {skipped} refused from the start");
    for (config, sum) in CONFIGS.iter().zip(sums) {
        println!("{config:?}: {sum} blocks");
    }
    println!("missed {missed} of the tolerance");
    assert!(
        faults.is_empty(),
        "{} faults\n{}",
        faults.len(),
        faults.join("\n")
    );
    assert!(skipped * 5 < rounds.end, "{skipped}");
}

/// The largest deviation of the control point (mm) and the tool axis (radians) from a single leg at the same share.
fn strays(bench: &Bench, block: &post_testkit::walk::Block, path: &[(V, V)]) -> [f64; 2] {
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

/// On small moves what is certified is hardly more than what is sampled.
#[test]
fn the_certificate_is_close() {
    let (rounds, mut rng) = randomised(150, 41);
    let mut worst = [0.0f64; 2];
    let mut counted = 0;
    for round in rounds {
        let given = Given {
            radius: 0.0,
            tcp: "post",
            decimals: 7,
            tolerance: 5.0,
            axis_tolerance: 5.0,
            pole: "exact",
            ..given(&mut rng)
        };
        let machine = machine(&mut rng, &given);
        let bench = bench_of(&machine, &given, CONFIGS[round % 8]);
        let profile = [Profile::Smooth, Profile::Uneven, Profile::Kinks][round % 3];
        // Two points: nothing can be left out.
        let stops = path(&mut rng, &bench, profile, 2);
        let (cl, _) = text(&stops);
        let run = bench.run_with(&cl, &mut Shape::Fine, false).good("a move");
        let report = run.report.as_ref().unwrap();
        let path = wanted(&stops, given.along);
        let blocks = blocks(&bench, &run);
        assert_eq!(blocks.len(), 1);
        let [tip, axis] = strays(&bench, &blocks[0], &path);
        let certified = [
            report.tip_deviation_mm.value,
            report.axis_deviation_deg.value.to_radians(),
        ];
        assert!(tip <= certified[0] + 1e-8, "{tip} over {certified:?}");
        assert!(axis <= certified[1] + 1e-9, "{axis} over {certified:?}");
        let turns = (0..bench.reference.joints.len())
            .filter(|joint| bench.reference.joints[*joint].rotary)
            .map(|joint| (blocks[0].to[joint] - blocks[0].from[joint]).abs());
        if turns.fold(0.0, f64::max) < 0.03 {
            counted += 1;
            if tip > 1e-4 {
                worst[0] = worst[0].max(certified[0] / tip);
            }
            if axis > 1e-5 {
                worst[1] = worst[1].max(certified[1] / axis);
            }
        }
    }
    println!("certified at most {worst:?} of the sampled, {counted} small moves");
    assert!(
        worst[0] < 1.05 && worst[1] < 1.05 && counted > 50,
        "{worst:?}"
    );
}

/// A move cut up by `fewest` has no more blocks than cut up by `bisect`, and by `even` no more than its peak asks for
/// where that falls with the square of the length.
#[test]
fn fewest_needs_no_more_blocks_than_bisect() {
    let (rounds, mut rng) = randomised(150, 43);
    let mut sums = [0usize; 3];
    let mut exact = [0usize; 2];
    for round in rounds {
        let given = Given {
            radius: 0.0,
            along: 0.0,
            tcp: "post",
            decimals: 6,
            tolerance: 0.0005,
            axis_tolerance: 5.0,
            pole: "exact",
            ..given(&mut rng)
        };
        let machine = machine(&mut rng, &given);
        let plain = bench_of(&machine, &given, CONFIGS[0]);
        let mut stops = path(&mut rng, &plain, Profile::Smooth, 2);
        stops.truncate(2);
        let (cl, _) = text(&stops);
        let path = wanted(&stops, 0.0);
        let whole = Given {
            tolerance: 100.0,
            ..given.clone()
        };
        let loose = machine.replace("tolerance = 0.0005\n", "tolerance = 100\n");
        let loose = bench_of(&loose, &whole, CONFIGS[0]);
        let whole = loose.run_with(&cl, &mut Shape::Fine, false).good("whole");
        let [peak, _] = strays(&loose, &blocks(&loose, &whole)[0], &path);
        let mut counts = [0; 3];
        for (count, config) in counts.iter_mut().zip(CONFIGS) {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(config);
            *count = blocks(&bench, &run).len();
        }
        for (sum, count) in sums.iter_mut().zip(counts) {
            *sum += count;
        }
        let [bisect, even, fewest] = counts;
        assert!(fewest <= bisect, "round {round}: {counts:?}, peak {peak}");
        let asked = libm::sqrt(peak / 0.0005);
        if (asked - libm::rint(asked)).abs() > 0.05 && asked > 1.0 {
            let asked = (libm::ceil(asked) as usize).max(2);
            exact[usize::from(even == asked)] += 1;
            assert!(
                even >= asked,
                "round {round}: {even} pieces, {asked} asked for"
            );
        }
    }
    println!("bisect, even, fewest: {sums:?}; even more than asked, as asked: {exact:?}");
    assert!(sums[2] * 10 < sums[0] * 8, "{sums:?}");
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
    let chain = if head {
        "[w b X Y Z C A t]"
    } else {
        "[w C' A' b X Y Z t]"
    };
    format!(
        "name = \"usual\"\nchain = \"{chain}\"\n[tool]\ngauge = [0, 0, 0]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\n{c}\nmax_feed = 1e7\n[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, 200]\ncyclic = true\nmax_feed = 1e7\n{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\n{more}"
    )
}

/// A head that swings evenly bows the same everywhere: blocks are as long as the theory of balanced pieces says.
/// A piece may bow by twice the tolerance, so its length is `sqrt(16·tolerance/|second derivative|)`; the first and
/// the last, one end of which stands on the path, may bow by 1.457 times it.
#[test]
fn balanced_blocks_are_as_long_as_theory_says() {
    for (swing, length) in [(20.0f64, 200.0f64), (40.0, 300.0), (10.0, 600.0)] {
        for tolerance in [0.001, 0.005] {
            let more = format!(
                "[accuracy]\ntolerance = {tolerance}\naxis_tolerance = 5\nplacement = \"fewest\""
            );
            let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 6, length);
            // From A's line to the tip.
            let arm = 200.0 + length;
            let lean = |degrees: f64| {
                let (sine, cosine) = libm::sincos(degrees.to_radians());
                V::new(0.0, -sine, cosine)
            };
            let stops = [
                stop(V::zeros(), lean(10.0), None),
                stop(V::new(100.0, 20.0, 0.0), lean(10.0 + swing), Some(1000.0)),
            ];
            let run = bench.run_with(&text(&stops).0, &mut Shape::Fine, false);
            let count = blocks(&bench, &run.good("a swing")).len();
            let bend = arm * swing.to_radians() * swing.to_radians();
            let piece = libm::sqrt(16.0 * tolerance / bend);
            let end = piece * libm::sqrt(1.457 / 2.0);
            let theory = 2.0 + (1.0 - 2.0 * end) / piece;
            println!("swing {swing}, arm {arm}, {tolerance}: {count} blocks, theory {theory}");
            assert!((count as f64) < theory * 1.1 + 1.0, "{count} for {theory}");
            assert!(count as f64 > theory * 0.99 - 1.0, "{count} for {theory}");
        }
    }
}

/// Dense points of a circle, no axis turning: left out, they leave the blocks that the sagitta allows.
#[test]
fn points_of_a_circle_are_reduced_to_what_the_sagitta_allows() {
    const RADIUS: f64 = 50.0;
    for (config, bow) in [("fewest", 2.0), ("bisect", 1.0), ("even", 1.0)] {
        for tolerance in [0.005, 0.02] {
            let more = format!(
                "[accuracy]\ntolerance = {tolerance}\naxis_tolerance = 0.1\nreduce = true\nplacement = \"{config}\""
            );
            let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 5, 100.0);
            let stops: Vec<Stop> = (0..=6000)
                .map(|index| {
                    let (sine, cosine) = libm::sincos(f64::from(index) * 1e-3);
                    let tip = V::new(RADIUS * cosine, RADIUS * sine, 0.0);
                    stop(tip, V::z(), (index > 0).then_some(1000.0))
                })
                .collect();
            let (cl, lines) = text(&stops);
            let run = bench.run(&cl).good("a circle");
            let report = run.report.clone().unwrap();
            let made = blocks(&bench, &run);
            let theory = 6.0 * RADIUS / libm::sqrt(8.0 * bow * tolerance * RADIUS);
            println!(
                "{config}, {tolerance}: {} blocks, theory {theory}",
                made.len()
            );
            assert!((made.len() as f64) < theory * 1.12 + 24.0, "{}", made.len());
            // The number of points adds up.
            assert_eq!(
                report.moves + report.points_added - report.points_dropped,
                report.blocks
            );
            let given = Given {
                tables: 0,
                usual: true,
                tcp: "post",
                along: 0.0,
                radius: 0.0,
                decimals: 5,
                tolerance,
                axis_tolerance: 0.1,
                pole: "blend",
                corner: 10.0,
            };
            hold(&bench, &given, &stops, &lines, &run, 20, &more).unwrap();
            // And against the circle itself, whose points are rounded and stand 0.05 mm apart.
            for block in &made {
                for step in 0..=20 {
                    let (tip, _) = block.at(&bench, f64::from(step) / 20.0);
                    let off = (tip.norm() - RADIUS).abs();
                    assert!(off < tolerance + 2e-4, "{off}");
                }
            }
        }
    }
}

/// The machine of the harmonic paper: Table 3.2 with the rotary centre 200 mm below the part origin.
fn dual_table(tcp: &str, tolerance: f64, more: &str) -> Bench {
    let more = format!(
        "[accuracy]\ntolerance = {tolerance}\naxis_tolerance = 1\nrapid_tolerance = 1\n{more}"
    );
    let text = usual(false, tcp, "cyclic = true", &more).replace("[0, 0, 200]", "[0, 0, -200]");
    Bench::new(&text, 7, 0.0)
}

/// The blade of Table 3.2 as a CL file: the first point is gone to, the others are cut.
fn blade_stops() -> Option<Vec<Stop>> {
    let points = post_testkit::blade()?;
    let stops = points
        .iter()
        .enumerate()
        .map(|(index, pose)| stop(pose.tip, pose.axis, (index > 0).then_some(1000.0)));
    Some(stops.collect())
}

/// The largest deviation at the same share of each move, mm; the blocks of a move are equal shares of it.
fn same_share(bench: &Bench, run: &Run, path: &[(V, V)], lines: &[u64]) -> Vec<f64> {
    let made = blocks(bench, run);
    (1..path.len())
        .map(|index| {
            let of: Vec<_> = made
                .iter()
                .filter(|block| block.lines[1] == lines[index])
                .collect();
            let mut most = 0.0f64;
            for (place, block) in of.iter().enumerate() {
                for step in 0..=20 {
                    let t = f64::from(step) / 20.0;
                    let share = (place as f64 + t) / of.len() as f64;
                    let chord = path[index - 1].0 * (1.0 - share) + path[index].0 * share;
                    most = most.max((block.at(bench, t).0 - chord).norm());
                }
            }
            most
        })
        .collect()
}

/// Table 3.2, compensated with many points: from 4.62 µm to what the model misses. The sine of the paper leaves
/// 0.26 µm, a parabola 0.006, the true curve hardly anything.
#[test]
fn compensation_leaves_what_the_model_misses() {
    let Some(stops) = blade_stops() else {
        return;
    };
    let (cl, lines) = text(&stops);
    let path = wanted(&stops, 0.0);
    let most = |run: &Run, bench: &Bench| {
        let each = same_share(bench, run, &path, &lines);
        1000.0 * each.iter().copied().fold(0.0, f64::max)
    };
    let plain = dual_table("post", 1.0, "");
    let before = plain.run(&cl).good("the blade");
    let peaks = same_share(&plain, &before, &path, &lines);
    let worst = most(&before, &plain);
    assert!((worst - 4.62).abs() < 0.005, "{worst}");
    for (shape, expected, slack) in [
        (Shape::Sine, 0.26, 0.006),
        (Shape::Parabola, 0.006, 0.002),
        (Shape::Fine, 0.0, 0.001),
    ] {
        let bench = dual_table("post", 1e-5, "method = \"compensate\"\npoints = 199");
        let run = bench
            .run_with(&cl, &mut { shape }, true)
            .good("compensated");
        let after = most(&run, &bench);
        println!("{shape:?}: {worst} to {after} µm");
        assert!((after - expected).abs() < slack, "{shape:?}: {after}");
    }
    // Eq. 3.4 word for word: a point stands where the straight line of the axes leads, less the model's curve.
    let bench = dual_table("post", 0.0035, "method = \"compensate\"\npoints = 4");
    let run = bench
        .run_with(&cl, &mut Shape::Sine, true)
        .good("compensated");
    let made = blocks(&bench, &run);
    let mut touched = 0;
    for (index, old) in blocks(&plain, &before).iter().enumerate() {
        let of: Vec<_> = made
            .iter()
            .filter(|block| block.lines[1] == lines[index + 1])
            .collect();
        let middle = old.at(&plain, 0.5).0 - (path[index].0 + path[index + 1].0) / 2.0;
        if middle.norm() <= 0.0035 - 1e-6 {
            // Within tolerance, and left as it is.
            assert_eq!(of.len(), 1, "move {index}: {} mm", peaks[index]);
            assert_eq!((of[0].from, of[0].to), (old.from, old.to), "move {index}");
            continue;
        }
        assert_eq!(of.len(), 5, "move {index}: {} mm", middle.norm());
        touched += 1;
        for (place, block) in of.iter().enumerate() {
            let share = (place as f64 + 1.0) / 5.0;
            let straight = between(&old.from, &old.to, share);
            for joint in bench.rotary() {
                assert!((straight[joint] - block.to[joint]).abs() < 2e-9);
            }
            let sine = libm::sin(std::f64::consts::PI * share);
            let expected = old.at(&plain, share).0 - middle * sine;
            let off = (block.at(&bench, 1.0).0 - expected).norm();
            assert!(off < 1e-6, "move {index}, {share}: {off}");
        }
    }
    assert!(touched > 3 && touched < 19, "{touched}");
}

/// What the model misses is certified too: where that is over tolerance the move is linearised, and moves that are
/// within tolerance keep their words in any case.
#[test]
fn a_compensated_program_is_certified_and_untouched_moves_stay() {
    let Some(stops) = blade_stops() else {
        return;
    };
    let (cl, lines) = text(&stops);
    let path = wanted(&stops, 0.0);
    let plain = dual_table("post", 1.0, "");
    let before = plain.run(&cl).good("the blade");
    let peaks = same_share(&plain, &before, &path, &lines);
    for tolerance in [0.0001, 0.0003, 0.001, 0.003] {
        for shape in [Shape::Sine, Shape::Parabola, Shape::Fine] {
            for points in [1, 3, 9, 50] {
                let more = format!("method = \"compensate\"\npoints = {points}");
                let bench = dual_table("post", tolerance, &more);
                let run = bench
                    .run_with(&cl, &mut { shape }, false)
                    .good("compensated");
                let certified = run.report.as_ref().unwrap().tip_deviation_mm.value;
                assert!(certified <= tolerance);
                let given = Given {
                    tables: 2,
                    usual: true,
                    tcp: "post",
                    along: 0.0,
                    radius: 0.0,
                    decimals: 7,
                    tolerance,
                    axis_tolerance: 1.0,
                    pole: "blend",
                    corner: 10.0,
                };
                hold(&bench, &given, &stops, &lines, &run, 20, &more).unwrap();
                for (index, peak) in peaks.iter().enumerate() {
                    let words = |run: &Run| -> Vec<Vec<f64>> {
                        run.motions()
                            .iter()
                            .filter(|asked| asked.line == lines[index + 1])
                            .map(|asked| asked.words.clone())
                            .collect()
                    };
                    if *peak < tolerance * 0.99 {
                        assert_eq!(words(&run), words(&before), "move {index}");
                    } else if *peak > tolerance * 1.01 {
                        assert!(words(&run).len() > 1, "move {index}");
                    }
                }
            }
        }
    }
}

/// A pass round a cone: C turns on and on.
fn cone(turns: f64, count: u32, step: f64) -> Vec<Stop> {
    (0..=count)
        .map(|index| {
            let share = f64::from(index) / f64::from(count);
            let (sine, cosine) = libm::sincos(share * turns * std::f64::consts::TAU);
            let tip = V::new(5.0 * cosine, 5.0 * sine, step * share);
            let axis = V::new(0.6 * cosine, 0.6 * sine, 1.0).normalize();
            stop(tip, axis, (index > 0).then_some(1000.0))
        })
        .collect()
}

/// An axis that is shown over one turn takes the shorter way in every block: with points left out and coarse
/// tolerances too, that is the way that the CL file means.
#[test]
fn a_wrapped_axis_goes_the_way_that_is_meant() {
    for tcp in ["post", "control"] {
        for range in ["[0, 360]", "[-180, 180]"] {
            for tolerance in [0.005, 0.5, 20.0] {
                for config in &CONFIGS {
                    for count in [24, 90, 700] {
                        let c = format!("cyclic = true\nrange = {range}");
                        let more = format!(
                            "[accuracy]\ntolerance = {tolerance}\naxis_tolerance = 10\nrapid_tolerance = 100\ncorner = 90\n{config}\n[solution]\npole = \"exact\""
                        );
                        let bench = Bench::new(&usual(false, tcp, &c, &more), 4, 0.0);
                        let stops = cone(3.0, count, 10.0);
                        let (cl, lines) = text(&stops);
                        let run = bench.run_with(&cl, &mut Shape::Fine, false).good("a cone");
                        let what = format!("{tcp}, {range}, {tolerance}, {config:?}, {count}");
                        let mut total = 0.0;
                        let c = bench.place("C");
                        for block in blocks(&bench, &run) {
                            let way: f64 = block.to[c] - block.from[c];
                            assert!(way.abs() < 3.0, "{what}: {way}");
                            total += way;
                        }
                        let turns = total.abs() / std::f64::consts::TAU;
                        assert!((turns - 3.0).abs() < 0.01, "{what}: {turns} turns");
                        let given = Given {
                            tables: 2,
                            usual: true,
                            tcp,
                            along: 0.0,
                            radius: 0.0,
                            decimals: 4,
                            tolerance,
                            axis_tolerance: 10.0,
                            pole: "blend",
                            corner: 10.0,
                        };
                        if tolerance < 0.1 {
                            hold(&bench, &given, &stops, &lines, &run, 20, config)
                                .unwrap_or_else(|fault| panic!("{what}: {fault}"));
                        }
                    }
                }
            }
        }
    }
}

/// Where the tip stands still the feed is taken along the axes, whatever blocks the turn is made of. (Put off the
/// path, the ends of balanced blocks made the tip seem to move, and the axes turn in no time.)
#[test]
fn a_turn_on_the_spot_keeps_its_pace() {
    let lean = |degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        V::new(0.0, -sine, cosine)
    };
    let stops = [
        stop(V::zeros(), lean(10.0), None),
        stop(V::zeros(), lean(14.0), Some(100.0)),
        stop(V::new(5.0, 0.0, 0.0), lean(14.0), Some(100.0)),
    ];
    let mut times = Vec::new();
    for config in CONFIGS {
        let more = format!("[accuracy]\ntolerance = 0.02\naxis_tolerance = 5\n{config}");
        let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 4, 100.0);
        let run = bench
            .run_with(&text(&stops).0, &mut Shape::Fine, false)
            .good(config);
        let a = bench.place("A");
        for block in &blocks(&bench, &run) {
            let turn = (block.to[a] - block.from[a]).abs().to_degrees();
            if let (Some(Feed::InverseTime(feed)), true) = (block.feed, turn > 0.0) {
                assert!(
                    turn * feed <= 100.0,
                    "{config}: {} degrees a minute",
                    turn * feed
                );
            }
        }
        times.push(run.report.unwrap().cutting_time_s);
    }
    for time in &times {
        assert!((time / times[0] - 1.0).abs() < 0.01, "{times:?}");
    }
}

/// Points so close that the tip stands still between them, while the axes turn: left out or not, that takes its time.
#[test]
fn a_turn_in_tiny_steps_keeps_its_pace() {
    let lean = |degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        V::new(0.0, -sine, cosine)
    };
    let mut stops = vec![stop(V::zeros(), lean(10.0), None)];
    for index in 1..=20 {
        let tip = V::new(0.0015 * f64::from(index), 0.0, 0.0);
        stops.push(stop(tip, lean(10.0 + f64::from(index)), Some(100.0)));
    }
    for tcp in ["post", "control"] {
        let mut times = Vec::new();
        for config in CONFIGS {
            let more = format!("[accuracy]\ntolerance = 0.2\naxis_tolerance = 5\n{config}");
            let bench = Bench::new(&usual(true, tcp, "cyclic = true", &more), 4, 100.0);
            let run = bench
                .run_with(&text(&stops).0, &mut Shape::Fine, false)
                .good(config);
            times.push(run.report.unwrap().cutting_time_s);
        }
        for time in &times {
            assert!((time / times[0] - 1.0).abs() < 0.01, "{tcp}: {times:?}");
        }
    }
}

/// Where the control keeps the tip, the point above it swings with the tool axis, which may bend more than any
/// direction across it that the cutting edge has.
#[test]
fn a_point_above_a_tip_that_the_control_keeps_is_bounded() {
    let (rounds, mut rng) = randomised(200, 47);
    let mut most = 0.0f64;
    for _ in rounds {
        let along = rng.range(50.0, 100.0);
        let text_of = usual(
            true,
            "control",
            "cyclic = true",
            "[accuracy]\ntolerance = 5\naxis_tolerance = 20\n[solution]\npole = \"exact\"",
        )
        .replace(
            "gauge = [0, 0, 0]",
            &format!("gauge = [0, 0, 0]\ncontrol_point = {{ along = {along}, radius = 0.001 }}"),
        );
        let bench = Bench::new(&text_of, 6, 100.0);
        let lean = |a: f64, c: f64| {
            let mut joints = Joints::default();
            joints[bench.place("A")] = a;
            joints[bench.place("C")] = c;
            bench.reference.forward(&joints).1
        };
        let (a, c) = (rng.range(0.05, 0.4), rng.range(-2.0, 2.0));
        let turns = [rng.range(0.0, 0.1), rng.range(0.0, 0.1)];
        let stops = [
            stop(V::zeros(), lean(a, c), None),
            stop(
                V::new(3.0, 1.0, 0.0),
                lean(a + turns[0], c + turns[1]),
                Some(100.0),
            ),
        ];
        let run = bench.run(&text(&stops).0).good("a lean");
        let certified = run.report.as_ref().unwrap().tip_deviation_mm.value;
        let path = wanted(&stops, along);
        let made = blocks(&bench, &run);
        let [sampled, _] = strays(&bench, &made[0], &path);
        most = most.max(sampled / certified);
    }
    println!("a point above the tip: sampled at most {most} of the certified");
    assert!(most <= 1.0, "{most}");
}

/// A nutating head whose second axis ends just past the pole can go through only by turning C half round there.
/// Whatever the placement, what bisection makes is made.
#[test]
fn a_pass_through_a_pole_is_made_by_every_placement() {
    let mut refused = Vec::new();
    for tcp in ["post", "control"] {
        for beside in [0.0f64, 0.001, 0.01, 0.1] {
            for count in [1, 5, 60] {
                let stops: Vec<Stop> = (0..=count)
                    .map(|index| {
                        let s = -1.0 + 2.0 * f64::from(index) / f64::from(count);
                        let axis = V::new(
                            libm::tan((5.0 * s).to_radians()),
                            libm::tan(beside.to_radians()),
                            1.0,
                        );
                        let axis = leaned(axis.normalize(), V::z(), 0.7);
                        let tip = V::new(40.0 * s, 10.0, 5.0 * s * s);
                        stop(tip, axis, (index > 0).then_some(1000.0))
                    })
                    .collect();
                let (cl, lines) = text(&stops);
                for pole in ["exact", "blend"] {
                    let mut made = Vec::new();
                    for config in CONFIGS {
                        let machine = format!(
                            "name = \"nutating\"\nchain = \"[w C' b X Y Z A t]\"\n[tool]\ngauge = [0, 0, 500]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ncyclic = true\nmax_feed = 9000\n[axis.A]\nrotary = [0, 1, 1]\npoint = [0, 0, 680]\ntravel = [-120, 0.2]\nmax_feed = 5400\n{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\n[solution]\npole = \"{pole}\"\n[accuracy]\ntolerance = 0.005\naxis_tolerance = 0.05\n{config}"
                        );
                        let bench = Bench::new(&machine, 3, 0.0);
                        let run = bench.run_with(&cl, &mut Shape::Fine, false);
                        made.push(run.report.is_some());
                        if run.report.is_none() {
                            refused.push(format!(
                                "{tcp}, {pole}, {beside}, {count}, {config:?}: {}",
                                run.told()
                            ));
                            continue;
                        }
                        let given = Given {
                            tables: 1,
                            usual: true,
                            tcp: ["post", "control"][usize::from(tcp == "control")],
                            along: 0.0,
                            radius: 0.0,
                            decimals: 3,
                            tolerance: 0.005,
                            axis_tolerance: 0.05,
                            pole: "blend",
                            corner: 10.0,
                        };
                        hold(&bench, &given, &stops, &lines, &run, 12, config).unwrap_or_else(
                            |fault| panic!("{tcp}, {pole}, {beside}, {count}, {config:?}: {fault}"),
                        );
                    }
                    assert!(made[0], "{tcp}, {pole}, {beside}, {count}");
                }
            }
        }
    }
    assert!(
        refused.is_empty(),
        "{} refused\n{}",
        refused.len(),
        refused.join("\n")
    );
}

/// A dense circle arc from `from` on, `count` points 0.05 mm apart.
fn arc(from: usize, count: usize) -> Vec<Stop> {
    (from..from + count)
        .map(|index| {
            let (sine, cosine) = libm::sincos(index as f64 * 1e-3);
            stop(
                V::new(50.0 * cosine, 50.0 * sine, 0.0),
                V::z(),
                Some(1000.0),
            )
        })
        .collect()
}

/// The control offsets the points that it is given: under cutter radius compensation each of them is one of the CL
/// file, and none is missing; before and behind it they are left out.
#[test]
fn under_cutter_compensation_every_point_stays() {
    for config in CONFIGS {
        let more = format!("[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.1\n{config}");
        let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 4, 100.0);
        let mut stops = arc(0, 300);
        stops[0].feed = None;
        stops[0].before = "LOADTL/1\nSPINDL/3000,RPM,CLW\n".to_owned();
        stops[100].before = "CUTCOM/LEFT,11\n".to_owned();
        stops[200].before = "CUTCOM/OFF\n".to_owned();
        let (cl, lines) = text(&stops);
        let run = bench
            .run_with(&cl, &mut Shape::Fine, false)
            .good("compensated");
        for index in 99..200 {
            let of: Vec<_> = run
                .motions()
                .into_iter()
                .filter(|asked| asked.line == lines[index])
                .cloned()
                .collect();
            assert_eq!(of.len(), 1, "{config}: point {index}");
            let tip = V::new(of[0].words[0], of[0].words[1], of[0].words[2]);
            assert!(
                (tip - stops[index].tip).norm() < 2e-4,
                "{config}: point {index}"
            );
        }
        // The words that switch it stand between the same points as in the CL file.
        let places: Vec<usize> = (0..run.asked.len())
            .filter(|place| run.asked[*place].kind == "Compensate")
            .collect();
        assert_eq!(places.len(), 2);
        for (place, index) in places.iter().zip([100, 200]) {
            assert_eq!(run.asked[place - 1].line, lines[index - 1], "{config}");
            assert!(run.asked[place + 1].line >= lines[index], "{config}");
        }
        let report = run.report.unwrap();
        assert_eq!(report.points_dropped > 0, config.contains("reduce"));
    }
}

/// Every kind of command stands behind the point that it stands behind in the CL file, and that point is met.
#[test]
fn commands_stay_between_their_points() {
    for command in [
        "COOLNT/ON",
        "COOLNT/OFF",
        "SPINDL/2000,RPM,CLW",
        "SPINDL/OFF",
        "PPRINT/HERE",
        "INSERT HERE",
        "DELAY/2",
        "STOP",
        "OPSTOP",
        "LOADTL/2",
        "GOHOME",
    ] {
        for config in CONFIGS {
            let more = format!("[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.1\n{config}");
            let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 4, 100.0);
            let mut stops = arc(0, 200);
            stops[0].feed = None;
            stops[77].before = format!("{command}\n");
            let (cl, lines) = text(&stops);
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(command);
            let place = (0..run.asked.len())
                .rfind(|place| {
                    let asked = &run.asked[*place];
                    asked.words.is_empty() && asked.line == lines[77] - 1
                })
                .unwrap_or_else(|| panic!("{command} is not carried out"));
            let before = run.asked[..place]
                .iter()
                .rfind(|asked| !asked.words.is_empty());
            let before = before.expect("a motion");
            assert_eq!(before.line, lines[76], "{command}, {config}");
            let tip = V::new(before.words[0], before.words[1], before.words[2]);
            assert!(
                (tip - stops[76].tip).norm() < 2e-4,
                "{command}, {config}: {tip}"
            );
            assert!(
                run.asked[place..]
                    .iter()
                    .filter(|asked| !asked.words.is_empty())
                    .all(|asked| asked.line >= lines[77]),
                "{command}, {config}"
            );
        }
    }
}

/// A move that has a time of its own takes it, in however many blocks, and is put together with none.
#[test]
fn moves_with_a_time_of_their_own_keep_it() {
    let (rounds, mut rng) = randomised(20, 53);
    let given = Given {
        tables: 2,
        usual: true,
        tcp: "post",
        along: 0.0,
        radius: 0.0,
        decimals: 4,
        tolerance: 0.005,
        axis_tolerance: 1.0,
        pole: "exact",
        corner: 10.0,
    };
    for _ in rounds {
        let machine = machine(&mut rng, &given);
        let stops = path(
            &mut rng,
            &bench_of(&machine, &given, ""),
            Profile::Smooth,
            12,
        );
        let (cl, lines) = text(&stops);
        let cl = cl.replace("FEDRAT/1000,MMPM", "FEDRAT/INVERS,4");
        for config in CONFIGS {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(config);
            for line in &lines[1..] {
                let time: f64 = run
                    .asked
                    .iter()
                    .filter(|asked| asked.line == *line)
                    .filter_map(|asked| match asked.feed {
                        Some(Feed::InverseTime(feed)) => Some(1.0 / feed),
                        _ => None,
                    })
                    .sum();
                assert!((time * 4.0 - 1.0).abs() < 1e-4, "{config}: {time}");
            }
        }
    }
}

/// Where one of two axes at most moves in a block, no block that is made of several legs or balanced about one moves
/// both.
#[test]
fn axes_that_exclude_one_another_never_move_together() {
    for tcp in ["post", "control"] {
        for config in CONFIGS {
            let more = format!(
                "[solution]\nexclusive = [[\"A\", \"C\"]]\npole = \"exact\"\n[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.5\n{config}"
            );
            let bench = Bench::new(&usual(false, tcp, "cyclic = true", &more), 4, 0.0);
            let (a, c) = (bench.place("A"), bench.place("C"));
            // By turns A and C, the tip going on evenly.
            let mut angles = [0.5f64, 0.3];
            let stops: Vec<Stop> = (0..60)
                .map(|index| {
                    if index > 0 {
                        angles[index / 4 % 2] += 0.01;
                    }
                    let mut joints = Joints::default();
                    (joints[a], joints[c]) = (angles[0], angles[1]);
                    // As printed, so that the other axis does not move by a rounding error.
                    for joint in [a, c] {
                        joints[joint] =
                            (libm::rint(joints[joint].to_degrees() * 10.0) / 10.0).to_radians();
                    }
                    let axis = bench.reference.forward(&joints).1;
                    let tip = V::new(index as f64, 0.1 * index as f64, 0.0);
                    stop(tip, axis, (index > 0).then_some(1000.0))
                })
                .collect();
            let run = bench.run_with(&text(&stops).0, &mut Shape::Fine, false);
            let run = run.good(config);
            for block in blocks(&bench, &run) {
                let moves = |joint: usize| (block.to[joint] - block.from[joint]).abs() > 1e-9;
                assert!(!(moves(a) && moves(c)), "{config}: {block:?}");
            }
        }
    }
}

/// Runs longer than what waits at a time are held like short ones.
#[test]
fn long_runs_are_held() {
    let (rounds, mut rng) = randomised(6, 59);
    for round in rounds {
        let given = Given {
            decimals: 4,
            tolerance: 0.01,
            axis_tolerance: 0.2,
            pole: "exact",
            corner: 10.0,
            ..given(&mut rng)
        };
        let machine = machine(&mut rng, &given);
        let first = bench_of(&machine, &given, CONFIGS[0]);
        let profile = [Profile::Smooth, Profile::Dense, Profile::Mixed][round % 3];
        let stops = path(&mut rng, &first, profile, 900);
        let (cl, lines) = text(&stops);
        for config in [CONFIGS[0], CONFIGS[4], CONFIGS[6]] {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false);
            if run.report.is_none() && config == CONFIGS[0] {
                break;
            }
            let run = run.good(config);
            let found = hold(&bench, &given, &stops, &lines, &run, 12, config)
                .unwrap_or_else(|fault| panic!("{profile:?}, {config:?}: {fault}, {given:?}"));
            println!("{profile:?}, {config:?}: {} blocks", found.blocks);
        }
    }
}

/// A knife whose edge leads along a curve: with points left out, axis and edge both stay within what is certified of
/// what the CL file asks for thereabouts.
#[test]
fn a_leading_edge_stays_within_what_is_certified() {
    let axes = [("C", V::z(), 0.0), ("B", V::y(), 160.0), ("A", V::z(), 0.0)];
    for config in CONFIGS {
        for (tcp, bend) in [("post", 0.02f64), ("post", 0.002), ("control", 0.01)] {
            let mut machine =
                "name = \"knife\"\nchain = \"[w b X Y Z C B A t]\"\n[tool]\ngauge = [0, 0, 0]\nedge = [1, 0, 0]\n"
                    .to_owned();
            for (name, direction, height) in axes {
                writeln!(
                    machine,
                    "[axis.{name}]\nrotary = [{}, {}, {}]\npoint = [0, 0, {height}]\ntravel = [-700, 700]\nmax_feed = 1e6",
                    direction.x, direction.y, direction.z
                )
                .unwrap();
            }
            write!(
                machine,
                "{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\n[solution]\nedge = \"cl\"\n[accuracy]\ntolerance = 0.02\naxis_tolerance = 0.2\n{config}"
            )
            .unwrap();
            let bench = Bench::new(&machine, 4, 50.0);
            let mut cl = "UNITS/MM\nMULTAX/ON\nFEDRAT/1000,MMPM\n".to_owned();
            let (mut path, mut edges) = (Vec::new(), Vec::new());
            let mut tip = V::zeros();
            for index in 0..120 {
                let turn = bend * f64::from(index);
                let (sine, cosine) = libm::sincos(turn);
                let way = V::new(cosine, sine, 0.0);
                let axis = leaned(V::z(), way, 0.35 + 0.1 * sine);
                let edge = (way - axis * axis.dot(&way)).normalize();
                writeln!(
                    cl,
                    "GOTO/{:.6},{:.6},{:.6},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9}",
                    tip.x, tip.y, tip.z, axis.x, axis.y, axis.z, edge.x, edge.y, edge.z
                )
                .unwrap();
                path.push((tip, axis));
                edges.push(edge);
                tip += way * 0.7;
            }
            cl += "FINI\n";
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(config);
            let report = run.report.as_ref().unwrap();
            if config.contains("reduce") && bend < 0.02 {
                assert!(
                    report.points_dropped > 20,
                    "{config}: {}",
                    report.points_dropped
                );
            }
            let (bound, turn) = (
                report.tip_deviation_mm.value + 1e-5,
                report.axis_deviation_deg.value.to_radians() + 1e-7,
            );
            let mut walk = Walk::new(&path);
            for block in blocks(&bench, &run) {
                for step in 0..=40 {
                    let t = f64::from(step) / 40.0;
                    let last = block.lines[1] as usize - 5;
                    walk.reach(block.at(&bench, t), last, bound, turn)
                        .unwrap_or_else(|off| panic!("{config}: {off:?} in {block:?}"));
                    let edge = block.rotation(&bench, t) * V::x();
                    // The tip says where it is to its tolerance, and no better.
                    let (leg, at) = walk.at();
                    let apart = (0..=20)
                        .map(|look| at + 2.0 * bound / 0.7 * f64::from(look) / 20.0)
                        .map(|at| {
                            let (leg, at) = if at > 1.0 && leg + 2 < path.len() {
                                (leg + 1, at - 1.0)
                            } else {
                                (leg, at.min(1.0))
                            };
                            angle(edge, slerp(edges[leg], edges[leg + 1], at))
                        })
                        .fold(f64::INFINITY, f64::min);
                    assert!(
                        apart <= turn + 1e-6,
                        "{config}, {tcp}, {bend}: the edge is off by {}°, certified {}°",
                        apart.to_degrees(),
                        turn.to_degrees()
                    );
                }
            }
            assert!(walk.at().0 + 2 == path.len(), "{config}");
        }
    }
}

/// Where the control keeps the tip it measures the tip's words, not the way of the point above it: on the spot the
/// feed is that of the rotary axes, and the block takes the time that the summary says.
#[test]
fn a_turn_on_the_spot_is_told_in_what_the_control_measures() {
    for along in [0.0, 0.2, 30.0] {
        let machine = usual(
            true,
            "control",
            "cyclic = true",
            "[accuracy]\ntolerance = 1\naxis_tolerance = 5",
        );
        let machine = machine.replace(
            "gauge = [0, 0, 0]",
            &format!("gauge = [0, 0, 0]\ncontrol_point = {{ along = {along} }}"),
        );
        let bench = Bench::new(&machine, 4, 100.0);
        let lean = |degrees: f64| {
            let (sine, cosine) = libm::sincos(degrees.to_radians());
            V::new(0.0, -sine, cosine)
        };
        let stops = [
            stop(V::zeros(), lean(10.0), None),
            stop(V::zeros(), lean(10.3), Some(100.0)),
        ];
        let run = bench.run(&text(&stops).0).good("a turn");
        let made = blocks(&bench, &run);
        let turn: f64 = made[0].to[bench.place("A")] - made[0].from[bench.place("A")];
        let Some(Feed::PerMinute(feed)) = made[0].feed else {
            panic!("{:?}", made[0].feed);
        };
        let seconds = turn.abs().to_degrees() / feed * 60.0;
        let told = run.report.unwrap().cutting_time_s;
        assert!(
            (seconds / told - 1.0).abs() < 0.05,
            "{along}: F{feed}, {seconds} s, told {told} s"
        );
    }
}

/// A loop that is smaller than the tolerance comes back to where it began: no block is written for it, and the
/// certificate says how far the tool stays away from it.
#[test]
fn what_is_left_out_whole_is_certified() {
    let radius = 0.045;
    let mut cl = String::from(
        "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,CLW\nRAPID\nGOTO/0,0,10,0,0,1\nFEDRAT/500,MMPM\n",
    );
    for step in 0..=72 {
        let around = f64::from(step) * std::f64::consts::PI / 36.0;
        writeln!(
            cl,
            "GOTO/{:.6},{:.6},0",
            radius * libm::cos(around) - radius,
            radius * libm::sin(around)
        )
        .unwrap();
    }
    let machine = "name = \"mill\"\nchain = \"[w b X Y Z t]\"\n[tool]\ngauge = [0, 0, 300]\n\
        [axis.X]\nlinear = [1, 0, 0]\ntravel = [-500, 500]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-500, 500]\n\
        [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-500, 500]\n[control]\ndialect = \"own\"\n\
        [accuracy]\ntolerance = 0.1\nreduce = true\n";
    for placement in ["bisect", "fewest"] {
        let text = format!("{machine}placement = \"{placement}\"\n");
        let run = Bench::new(&text, 4, 100.0).run(&cl).good(placement);
        let certified = run
            .report
            .as_ref()
            .map(|report| report.tip_deviation_mm.value);
        let certified = certified.unwrap_or_default();
        assert!(
            (1.99 * radius..=0.1).contains(&certified),
            "{placement}: {certified}"
        );
    }
}

/// Pieces shorter than the words' decimals have no pace of their own: a move of 20 µm that turns by 6° takes the same
/// time however many pieces it is cut into.
#[test]
fn pieces_of_a_short_move_are_paced_as_the_move_is() {
    let cl = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,CLW\nRAPID\nGOTO/0,0,50,0.3,0,0.9539392\nFEDRAT/250,MMPM\n\
        GOTO/0,0,0,0.3,0,0.9539392\nGOTO/0.02,0,0,0.3984011,0,0.9172114\nGOTO/10,0,0,0.3984011,0,0.9172114\n";
    let machine = "name = \"head\"\nchain = \"[w b X Y Z C A t]\"\n[tool]\ngauge = [0, 0, 0]\n\
        [axis.X]\nlinear = [1, 0, 0]\ntravel = [-900, 900]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-900, 900]\n\
        [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-900, 900]\n\
        [axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ntravel = [-360, 360]\nmax_feed = 7200\n\
        [axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, 150]\ntravel = [-110, 110]\nmax_feed = 7200\n\
        [control]\ndialect = \"own\"\ntcp = \"post\"\n[accuracy]\n";
    let mut times = Vec::new();
    for config in [
        "tolerance = 5",
        "placement = \"bisect\"",
        "placement = \"even\"",
        "placement = \"fewest\"",
        "method = \"compensate\"",
    ] {
        let run = Bench::new(&format!("{machine}{config}\n"), 3, 100.0)
            .run(cl)
            .good(config);
        times.push(
            run.report
                .as_ref()
                .map_or(0.0, |report| report.cutting_time_s),
        );
    }
    for time in &times {
        assert!((time - times[0]).abs() < 0.05, "{times:?}");
    }
}
