//! Feed and travel of whole programs, by the printed words alone: a control that takes each block for what is printed
//! drives the axes, between the words too, and no axis leaves its travel or passes its largest feed.
//!
//! Where the control keeps the tip, it goes straight and evenly while the rotary axes turn evenly, and the linear ones
//! follow; where the post does, all axes go evenly. A feed a minute is that of the length which the control looks at.

mod cases;

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_machine::description::{InverseTime, Tcp};
use post_machine::kinematics::{Joints, MAX_AXES};
use post_plugin::Feed;
use post_testkit::{Rng, at_least, randomised};
use post_testmachines::between;
use post_testruns::posted::{Asked, Bench, Run};
use post_testruns::walk::{Stop, stop, text};

type V = Vector3<f64>;

/// What the control does with one printed block.
struct Driven {
    line: u64,
    /// Written as a rapid, which the control times by itself.
    rapid: bool,
    /// As the control understands it, minutes; of a rapid, none.
    minutes: f64,
    /// The axes on the way, from the words before to its own.
    places: Vec<Joints>,
    /// Way of the tip, mm.
    tip: f64,
}

/// The length that the control divides by a feed a minute, mm or degrees.
fn length(bench: &Bench, kind: &str, from: &Joints, to: &Joints, tip: f64) -> f64 {
    let ways: Vec<(bool, f64)> = (0..bench.reference.joints.len())
        .map(|place| {
            let way = (to[place] - from[place]).abs();
            let rotary = bench.reference.joints[place].rotary;
            let diameter = bench.machine.axes[place].feed_diameter;
            let turn = match (diameter, bench.machine.control.tcp) {
                // Along its circle.
                (Some(diameter), tcp) if tcp == Tcp::Post || kind == "combined" => {
                    way * diameter / 2.0
                }
                _ => way.to_degrees(),
            };
            (rotary, if rotary { turn } else { way })
        })
        .collect();
    let of = |rotary: bool| ways.iter().filter(move |way| way.0 == rotary).map(|way| way.1);
    let root = |ways: &mut dyn Iterator<Item = f64>| ways.map(|way| way * way).sum::<f64>().sqrt();
    if bench.machine.control.tcp == Tcp::Control && kind == "combined" {
        return root(&mut of(true).chain([tip]));
    }
    if bench.machine.control.tcp == Tcp::Control {
        return if tip > 1e-9 { tip } else { of(true).fold(0.0, f64::max) };
    }
    let linear = root(&mut of(false));
    match kind {
        "combined" => root(&mut of(false).chain(of(true))),
        "longest" => of(false).chain(of(true)).fold(0.0, f64::max),
        _ if linear > 1e-9 => linear,
        _ => root(&mut of(true)),
    }
}

/// Every block of a program; `kind` is the machine's `feed_length`.
fn drive(bench: &Bench, run: &Run, kind: &str, count: u32) -> Vec<Driven> {
    let keeps = bench.machine.control.tcp == Tcp::Control;
    let tip_of = |asked: &Asked| V::new(asked.words[0], asked.words[1], asked.words[2]);
    let mut driven = Vec::new();
    let motions = run.motions();
    for pair in motions.windows(2) {
        let (before, asked) = (pair[0], pair[1]);
        if asked.kind == "Position" {
            continue;
        }
        let (from, to) = (bench.joints(&before.words), bench.joints(&asked.words));
        let tip = if keeps {
            (tip_of(asked) - tip_of(before)).norm()
        } else {
            (bench.reference.forward(&to).0 - bench.reference.forward(&from).0).norm()
        };
        let places = (0..=count).map(|step| {
            let t = f64::from(step) / f64::from(count);
            let joints = between(&from, &to, t);
            if keeps {
                bench.put(tip_of(before) * (1.0 - t) + tip_of(asked) * t, joints)
            } else {
                joints
            }
        });
        driven.push(Driven {
            line: asked.line,
            rapid: asked.feed.is_none(),
            minutes: match asked.feed {
                Some(Feed::InverseTime(feed)) => match bench.machine.control.inverse_time {
                    InverseTime::Minutes => 1.0 / feed,
                    InverseTime::Seconds => 1.0 / feed / 60.0,
                },
                Some(Feed::PerMinute(feed)) => length(bench, kind, &from, &to, tip) / feed,
                Some(other) => panic!("{other:?}"),
                None => 0.0,
            },
            places: places.collect(),
            tip,
        });
    }
    driven
}

impl Driven {
    /// The largest share that each axis has of its largest feed.
    fn shares(&self, bench: &Bench) -> [f64; MAX_AXES] {
        let mut shares = [0.0f64; MAX_AXES];
        let minutes = self.minutes / (self.places.len() - 1) as f64;
        for pair in self.places.windows(2) {
            for (place, axis) in bench.machine.axes.iter().enumerate() {
                let speed = (pair[1][place] - pair[0][place]).abs() / minutes;
                shares[place] = shares[place].max(speed / axis.max_feed);
            }
        }
        shares
    }
}

/// A machine of no particular sort.
struct Made {
    text: String,
    kind: &'static str,
    along: f64,
}

fn made(rng: &mut Rng) -> Made {
    let usual = rng.pick(2) == 0;
    let (mut first, mut second) = (V::z(), [V::x(), V::y(), V::new(0.0, 1.0, 1.0)][rng.pick(3)]);
    if !usual {
        (first, second) = (rng.direction(), rng.direction());
        while first.cross(&second).norm() < 0.5 {
            second = rng.direction();
        }
    }
    let chain =
        ["[w C' A' b Y X Z t]", "[w C' b X Y Z A t]", "[w b X Y Z C A t]", "[w b X C Y Z A t]"]
            [rng.pick(if usual { 3 } else { 4 })];
    let lean = [0.0, 0.0, 0.05][rng.pick(3)];
    let along = if rng.pick(2) == 0 { 0.0 } else { rng.range(-40.0, 80.0) };
    let (tcp, kind) = [
        ("control", "linear"),
        ("control", "combined"),
        ("post", "linear"),
        ("post", "combined"),
        ("post", "longest"),
    ][rng.pick(5)];
    let counts = match (tcp, kind) {
        ("control", "combined") => "tcp_feed_length",
        _ => "feed_length",
    };
    let feed = ["auto", "per-minute", "inverse-time"][rng.pick(3)];
    let rapid = ["rapid", "linear"][rng.pick(2)];
    let time = ["minutes", "minutes", "seconds"][rng.pick(3)];
    let circle = ["", "", "feed_diameter = 80\n"][rng.pick(3)];
    let reduce = rng.pick(2) == 0;
    let list = |v: V| format!("[{}, {}, {}]", v.x, v.y, v.z);
    let mut text = format!(
        "name = \"made\"\nchain = \"{chain}\"\n[workpiece]\nmount = {}\n[tool]\ngauge = {}\n\
         control_point = {{ along = {along} }}\n",
        list(rng.point(100.0)),
        list(rng.point(200.0))
    );
    for (name, direction) in [("C", first), ("A", second)] {
        let (point, most) = (list(rng.point(300.0)), rng.order(3.2, 4.2));
        let direction = list(direction);
        writeln!(
            text,
            "[axis.{name}]\nrotary = {direction}\npoint = {point}\ncyclic = true\nmax_feed = {most}\n{circle}"
        )
        .unwrap();
    }
    for (name, direction) in [("X", V::x()), ("Y", V::y()), ("Z", V::z())] {
        let (direction, most) = (list(direction + rng.point(lean)), rng.order(3.0, 4.2));
        writeln!(
            text,
            "[axis.{name}]\nlinear = {direction}\ntravel = [-20000, 20000]\nmax_feed = {most}"
        )
        .unwrap();
    }
    writeln!(
        text,
        "[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\nfeed = \"{feed}\"\n{counts} = \"{kind}\"\ninverse_time = \"{time}\"\nrapid = \"{rapid}\"\n\
         [accuracy]\ntolerance = 0.02\naxis_tolerance = 2.0\nrapid_tolerance = 1000\nreduce = {reduce}"
    )
    .unwrap();
    Made { text, kind, along }
}

/// A path of some points, with feeds of every size and now and then a rapid; here and there the tip stands still.
fn path(rng: &mut Rng, along: f64) -> Vec<Stop> {
    let (mut tip, mut axis) = (rng.point(60.0), (V::z() + rng.point(0.3)).normalize());
    let size = rng.order(-1.0, 1.3);
    let turn = rng.order(-2.5, -0.3);
    let mut feed = rng.order(2.0, 4.3);
    (0..25)
        .map(|index| {
            let next = (axis + rng.direction() * turn).normalize();
            match rng.pick(6) {
                // The tip stands, or the point above it does.
                0 => {}
                1 => tip += (axis - next) * along,
                _ => tip += rng.direction() * size,
            }
            axis = next;
            if rng.pick(6) == 0 {
                feed = libm::rint(rng.order(2.0, 4.3));
            }
            stop(tip, axis, (index > 0 && rng.pick(7) > 0).then_some(feed))
        })
        .collect()
}

/// The feed that is in force at each line of a CL file, and whether the line is a rapid.
fn asked_feeds(stops: &[Stop], lines: &[u64]) -> impl Fn(u64) -> Option<f64> {
    let feeds: Vec<(u64, Option<f64>)> =
        lines.iter().copied().zip(stops.iter().map(|stop| stop.feed)).collect();
    move |line| feeds.iter().find(|(at, _)| *at == line).and_then(|(_, feed)| *feed)
}

#[test]
fn no_axis_passes_its_largest_feed_between_the_words() {
    let (rounds, mut rng) = randomised(240, 191);
    let count = rounds.end;
    let (mut refused, mut blocks, mut close, mut fed, mut left) = (0, 0, 0, 0, 0);
    let mut fastest: f64 = 0.0;
    for round in rounds {
        let made = made(&mut rng);
        let bench = Bench::new(&made.text, 4, 80.0);
        let stops = path(&mut rng, made.along);
        let (cl, lines) = text(&stops);
        let run = bench.run(&cl);
        let Some(report) = &run.report else {
            // What cannot be shown is refused, and what cannot be printed slowly enough.
            let told = run.told();
            let known =
                ["out-of-reach", "over-travel", "low-feed", "jump", "rounding", "kinematics"];
            let kinds: Vec<&str> =
                told.lines().map(|line| line.split(':').next().unwrap()).collect();
            assert!(
                kinds
                    .iter()
                    .all(|kind| known.contains(kind) || ["spindle", "unwinding"].contains(kind)),
                "round {round}: {told}"
            );
            refused += 1;
            continue;
        };
        let feed_at = asked_feeds(&stops, &lines);
        let linear = made.text.contains("rapid = \"linear\"");
        let mut minutes = 0.0;
        let (mut least, mut most, mut way) =
            ([f64::INFINITY; MAX_AXES], [f64::NEG_INFINITY; MAX_AXES], [0.0; MAX_AXES]);
        for block in drive(&bench, &run, made.kind, 200) {
            for pair in block.places.windows(2) {
                for place in 0..MAX_AXES {
                    way[place] += (pair[1][place] - pair[0][place]).abs();
                }
            }
            for joints in &block.places {
                for place in 0..MAX_AXES {
                    least[place] = least[place].min(joints[place]);
                    most[place] = most[place].max(joints[place]);
                }
            }
            let turns = bench
                .rotary()
                .iter()
                .any(|place| block.places[0][*place] != block.places[200][*place]);
            if block.rapid {
                assert!(
                    !linear || !turns,
                    "round {round}, line {}: a rapid that turns",
                    block.line
                );
                left += 1;
                continue;
            }
            blocks += 1;
            let share = block.shares(&bench).into_iter().fold(0.0, f64::max);
            fastest = fastest.max(share);
            assert!(
                share <= 1.0 + 1e-6,
                "round {round}, line {}: {share}\n{}",
                block.line,
                made.text
            );
            match feed_at(block.line) {
                Some(feed) => {
                    minutes += block.minutes;
                    // Never faster than the CL file asks for: that is the feed of the tip.
                    if block.tip > 0.05 {
                        let ran = block.tip / block.minutes;
                        assert!(
                            ran <= feed * (1.0 + 1e-3),
                            "round {round}, line {}: {ran} for {feed}\n{}",
                            block.line,
                            made.text
                        );
                        close += u32::from(share > 0.98 || ran > 0.99 * feed);
                    }
                }
                // A rapid that is written as a feed move is as fast as the axes allow, but for the rounding of F.
                None if linear => {
                    let rounded = block.minutes < 2e-3 || block.tip / block.minutes < 10.0;
                    assert!(share > 0.98 || rounded, "round {round}, line {}: {share}", block.line);
                    fed += 1;
                }
                None => {}
            }
        }
        assert!(
            (minutes * 60.0 - report.cutting_time_s).abs() <= 1e-6 * report.cutting_time_s + 1e-9,
            "round {round}: {} {}\n{}",
            minutes * 60.0,
            report.cutting_time_s,
            made.text
        );
        for range in &report.axes {
            let place = bench.place(&range.name);
            let axis = &bench.machine.axes[place];
            let (low, high, all) =
                (axis.reading(least[place]), axis.reading(most[place]), way[place] / axis.unit());
            // The first position is no block, and samples miss what lies between them.
            let slack = 2e-3 + 1e-4 * all;
            assert!(
                range.min <= low + slack && range.min >= low - slack,
                "round {round}: {range:?} {low}\n{}",
                made.text
            );
            assert!(
                range.max <= high + slack && range.max >= high - slack,
                "round {round}: {range:?} {high}\n{}",
                made.text
            );
            assert!(
                (range.way - all).abs() <= 0.05 + 2e-3 * all,
                "round {round}: {range:?} {all}\n{}",
                made.text
            );
        }
    }
    println!(
        "{blocks} blocks, {close} at their limit; {fed} rapids fed, {left} left; {refused} refused; {fastest}"
    );
    assert!(
        blocks > at_least(2000) && close > blocks / 4 && fed > at_least(50) && refused < count / 2
    );
}

/// A head that swings to and fro in one plane, whichever solution is taken. The travel of its depth axis ends between
/// what it does at the words and what it does between them, or a little beyond: it is refused, or it is not.
#[test]
fn travel_is_kept_between_the_words() {
    let (rounds, mut rng) = randomised(40, 193);
    let mut refused = 0;
    for round in rounds {
        let mut angle: f64 = rng.range(-60.0, 60.0);
        let mut tip = V::new(0.0, 0.0, -300.0);
        let stops: Vec<Stop> = (0..12)
            .map(|index| {
                let (sine, cosine) = libm::sincos(angle.to_radians());
                let feed = (index > 0 && rng.pick(4) > 0).then_some(3000.0);
                let stop = stop(tip, V::new(sine, 0.0, cosine), feed);
                angle = rng.range(-60.0, 60.0);
                tip += V::new(rng.range(-20.0, 20.0), 0.0, rng.range(-20.0, 20.0));
                stop
            })
            .collect();
        let (cl, _) = text(&stops);
        let with = |most: f64| {
            let text = cases::fork("control", "").replace("-950, 50]", &format!("-950, {most}]"));
            let text = text.replace("axis_tolerance = 0.5", "axis_tolerance = 30");
            let bench = Bench::new(&text, 4, 0.0);
            let run = bench.run(&cl);
            (bench, run)
        };
        let (bench, run) = with(2000.0);
        let run = run.good("a head with room");
        let z = bench.place("Z");
        let words = run.motions().into_iter();
        let at_words = words.map(|asked| bench.joints(&asked.words)[z]);
        let at_words = at_words.fold(f64::NEG_INFINITY, f64::max);
        let driven = drive(&bench, &run, "linear", 2000);
        let values = driven.iter().flat_map(|block| &block.places);
        let most = values.fold(f64::NEG_INFINITY, |most: f64, at| most.max(at[z]));
        if most - at_words > 0.01 {
            let (_, run) = with(0.5 * (most + at_words));
            let told = run.told();
            assert!(
                told.contains("over-travel: between the words of this block Z"),
                "round {round}: {at_words} {most} {told}"
            );
            refused += 1;
        }
        let (_, run) = with(most + 2e-4 + 1e-6 * (most - at_words));
        assert!(run.report.is_some(), "round {round}: {most} {}", run.told());
    }
    println!("{refused} refused");
    assert!(refused > at_least(10));
}
