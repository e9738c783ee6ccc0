//! Whole runs, from CL text to the events a dialect is asked to write, judged by nothing of the crate: the printed
//! words are taken apart again, put through the isometries of `common` and sampled densely.

use nalgebra::{Rotation3, Vector3};
use post_grammar::{ReadError, Reader};
use post_machine::description::{Machine, Setting, Source, load};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_machine::kinematics::{Joint, Joints};
use post_plugin::{
    Batch, Curve, Deviation, DialectSession, Event, Feed, Format, ModelSession, Tolerance,
    WriteFault,
};
use post_posting::program::Reading;
use post_posting::report::Report;
use post_posting::{Job, MOST_FAULTS, Output, Post};
use post_testkit::{Reference, Rng, angle, between, distance, slerp};

/// What a dialect was asked for.
#[derive(Clone, Debug, PartialEq)]
struct Asked {
    /// Line of the CL file.
    line: u64,
    /// Kind of the event.
    kind: &'static str,
    words: Vec<f64>,
    feed: Option<Feed>,
    /// Any other number it has.
    value: f64,
}

/// Writes nothing down but the events themselves.
struct Recorder {
    format: Format,
    asked: Vec<Asked>,
}

impl DialectSession for Recorder {
    fn format(&self) -> &Format {
        &self.format
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut Vec<u8>,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        for (index, event) in batch.iter().enumerate() {
            let (words, feed, value) = match event {
                Event::Position { words, feed } => (words, feed, 0.0),
                Event::Rapid { words } => (words, None, 0.0),
                Event::Linear { words, feed } => (words, Some(feed), 0.0),
                Event::Dwell { seconds } => (&[][..], None, seconds),
                Event::ToolChange { number, .. } => (&[][..], None, f64::from(number)),
                _ => (&[][..], None, 0.0),
            };
            for word in words {
                assert!(
                    word.is_finite() && (*word != 0.0 || word.is_sign_positive()),
                    "a word is {word}"
                );
            }
            if let Some(
                Feed::PerMinute(feed) | Feed::InverseTime(feed) | Feed::PerRevolution(feed),
            ) = feed
            {
                assert!(feed.is_finite() && feed > 0.0, "a feed is {feed}");
            }
            self.asked.push(Asked {
                line: batch.line(index),
                kind: event.name(),
                words: words.to_vec(),
                feed,
                value,
            });
            out.extend_from_slice(b"block\n");
            ends.push(out.len());
        }
        Ok(())
    }
}

/// An error model that looks at 33 places and has no opinion.
struct Samples;

impl ModelSession for Samples {
    fn fit(
        &mut self,
        _: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let places: [f64; 33] = std::array::from_fn(|step| step as f64 / 32.0);
        let mut out = [Deviation::default(); 33];
        deviation(&places, &mut out);
        let length = |vector: [f64; 3]| Vector3::from(vector).norm();
        let peak = |part: fn(&Deviation) -> [f64; 3]| {
            out.iter()
                .map(|place| length(part(place)))
                .fold(0.0, f64::max)
        };
        Ok(Curve {
            tip_peak: peak(|place| place.tip),
            tip_at: 0.5,
            axis_peak: peak(|place| place.axis),
            axis_at: 0.5,
            terms: [0.0; 60],
        })
    }

    fn value(&self, _: &Curve, _: f64) -> Deviation {
        Deviation::default()
    }
}

struct Nowhere;

impl Output for Nowhere {
    fn write(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

/// What came of a run.
struct Run {
    asked: Vec<Asked>,
    report: Option<Report>,
    findings: Vec<Diagnostic>,
}

impl Run {
    /// The words of all motions, in order.
    fn motions(&self) -> Vec<(&'static str, Vec<f64>)> {
        let motion = |asked: &&Asked| !asked.words.is_empty();
        self.asked
            .iter()
            .filter(motion)
            .map(|asked| (asked.kind, asked.words.clone()))
            .collect()
    }

    fn good(self) -> Self {
        assert!(self.report.is_some(), "{:#?}", self.findings);
        self
    }
}

fn run(machine: &Machine, cl: &str, job: Job) -> Run {
    let mut dialect = Recorder {
        format: Format {
            words: machine.axes.iter().map(|_| 3).collect(),
            feed: 1,
            inverse_time: Some(4),
            feed_per_revolution: 4,
            extension: "nc".to_owned(),
        },
        asked: Vec::new(),
    };
    let (mut model, mut output) = (Samples, Nowhere);
    let mut post = Post::new(machine, job, &mut dialect, &mut model, &mut output)
        .expect("machine and dialect agree");
    let mut reader = Reader::new(cl.as_bytes());
    while !post.gave_up() {
        match reader.next_record() {
            Ok(Some(record)) => post.record(&record),
            Ok(None) => break,
            Err(ReadError::Syntax(fault)) => post.unreadable(&fault),
            Err(other) => panic!("{other}"),
        }
    }
    let (report, mut findings) = post.finish();
    // Programs this short do not care for the spindle.
    findings.retain(|finding| finding.code != "spindle");
    Run {
        asked: dialect.asked,
        report,
        findings,
    }
}

/// A machine file, and the same numbers once more for the isometries.
struct Model {
    machine: Machine,
    reference: Reference,
    /// Places in the chain, in the order of the words.
    order: Vec<usize>,
    /// Linear positions with the tip on the part origin and every rotary axis at zero.
    zero: Vector3<f64>,
    tcp: bool,
    length: f64,
}

const LINEAR: &str = "
[axis.X]
linear = [1, 0, 0]
travel = [-5000, 5000]
max_feed = 20000
[axis.Y]
linear = [0, 1, 0]
travel = [-5000, 5000]
max_feed = 20000
[axis.Z]
linear = [0, 0, 1]
travel = [-5000, 5000]
max_feed = 15000
[accuracy]
tolerance = 0.005
axis_tolerance = 0.05
rapid_tolerance = 0.5
";

const MOUNT: [f64; 3] = [10.0, -20.0, 30.0];

/// Trunnion, head or nutating head; `tilt` is the travel of the axis nearer the tool, degrees.
fn model(kind: &str, tcp: bool, tilt: [f64; 2], settings: &[&str]) -> Model {
    let turn = |direction: [f64; 3], point: [f64; 3]| Joint {
        rotary: true,
        direction: Vector3::from(direction).normalize(),
        point: Vector3::from(point),
    };
    let slide = |direction: Vector3<f64>| Joint {
        rotary: false,
        direction,
        point: Vector3::zeros(),
    };
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(slide);
    // Chain, the two rotary axes, gauge, tool length; then the same for the reference.
    let (chain, second, direction, point, gauge, length, joints, order): (
        _,
        _,
        _,
        _,
        _,
        _,
        _,
        &[usize],
    ) = match kind {
        "trunnion" => (
            "[w C' A' b Y X Z t]",
            "A",
            [1.0, 0.0, 0.0],
            [0.0, 0.012, 50.004],
            400.0,
            0.0,
            vec![
                turn([0.0, 0.0, 1.0], [0.0; 3]),
                turn([1.0, 0.0, 0.0], [0.0, 0.012, 50.004]),
                y,
                x,
                z,
            ],
            &[3, 2, 4, 1, 0],
        ),
        "head" => (
            "[w b X Y Z C A t]",
            "A",
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 250.0],
            0.0,
            120.0,
            vec![
                x,
                y,
                z,
                turn([0.0, 0.0, 1.0], [0.0; 3]),
                turn([1.0, 0.0, 0.0], [0.0, 0.0, 250.0]),
            ],
            &[0, 1, 2, 4, 3],
        ),
        "nutating" => (
            "[w C' b X Y Z B t]",
            "B",
            [0.0, 1.0, 1.0],
            [0.0, 0.0, 680.0],
            500.0,
            0.0,
            vec![
                turn([0.0, 0.0, 1.0], [0.0; 3]),
                x,
                y,
                z,
                turn([0.0, 1.0, 1.0], [0.0, 0.0, 680.0]),
            ],
            &[1, 2, 3, 4, 0],
        ),
        other => panic!("{other}"),
    };
    let text = format!(
        r#"
name = "{kind}"
chain = "{chain}"
[workpiece]
mount = {MOUNT:?}
[tool]
gauge = [0, 0, {gauge}]
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
max_feed = 9000
[axis.{second}]
rotary = {direction:?}
point = {point:?}
travel = {tilt:?}
max_feed = 5400
[control]
dialect = "recorder"
tcp = "{}"
{LINEAR}"#,
        if tcp { "control" } else { "post" }
    );
    let settings: Vec<Setting> = settings
        .iter()
        .map(|&setting| Setting::Written(setting.to_owned()))
        .collect();
    let machine = load(
        Source {
            name: kind.to_owned(),
            text,
        },
        &settings,
        &mut |_| Err(String::new()),
    )
    .unwrap_or_else(|faults| panic!("{faults:#?}"));
    let tip = Vector3::new(0.0, 0.0, gauge - length);
    let mount = Vector3::from(MOUNT);
    Model {
        machine,
        reference: Reference {
            joints,
            mount,
            tip,
            axis: Vector3::z(),
        },
        order: order.to_vec(),
        zero: mount - tip,
        tcp,
        length,
    }
}

impl Model {
    fn run(&self, cl: &str) -> Run {
        run(
            &self.machine,
            cl,
            Job {
                tool_length: Some(self.length),
                ..Job::default()
            },
        )
    }

    /// The place of an axis in the chain, by the order of the words.
    fn place(&self, name: &str) -> usize {
        self.order["XYZ".find(name).unwrap_or(if name == "C" { 4 } else { 3 })]
    }

    /// Axis values of printed words; the linear ones only if the words are axis positions.
    fn joints(&self, words: &[f64]) -> Joints {
        let mut joints = Joints::default();
        for (index, (place, word)) in self.order.iter().zip(words).enumerate() {
            joints[*place] = match index {
                0..3 if self.tcp => 0.0,
                0..3 => word + self.zero[index],
                _ => word.to_radians(),
            };
        }
        joints
    }

    /// Where tip and tool axis are at `t` of a block.
    fn at(&self, from: &[f64], to: &[f64], t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let joints = between(&self.joints(from), &self.joints(to), t);
        let (mut tip, axis) = self.reference.forward(&joints);
        if self.tcp {
            tip = Vector3::from_fn(|row, _| from[row] * (1.0 - t) + to[row] * t);
        }
        (tip, axis)
    }

    /// The positions of the axes that put the tip of a block's end where it is, whoever keeps the tip.
    fn positions(&self, words: &[f64]) -> Joints {
        let mut joints = self.joints(words);
        if self.tcp {
            let off =
                Vector3::new(words[0], words[1], words[2]) - self.reference.forward(&joints).0;
            // All three machines have their linear axes along X, Y, Z, some of them behind the table's turns.
            let first = *self.reference.linear().first().expect("linear axes");
            let before = self.reference.rotation(&joints[..first]).inverse() * off;
            for (row, place) in self.order[..3].iter().enumerate() {
                joints[*place] += before[row];
            }
            let tip = self.reference.forward(&joints).0;
            assert!((tip - Vector3::new(words[0], words[1], words[2])).norm() < 1e-9);
        }
        joints
    }
}

/// One point of a CL file, its numbers as they are written.
#[derive(Clone, Copy, Debug)]
struct Point {
    tip: Vector3<f64>,
    axis: Vector3<f64>,
    rapid: bool,
}

/// A point whose numbers are those that a CL file with so many decimals holds.
fn point(tip: Vector3<f64>, axis: Vector3<f64>, rapid: bool) -> Point {
    let rounded =
        |vector: Vector3<f64>, scale: f64| vector.map(|value| libm::rint(value * scale) / scale);
    Point {
        tip: rounded(tip, 1e4),
        axis: rounded(axis, 1e7),
        rapid,
    }
}

/// A CL file with two lines a point, its pace and its numbers.
fn cl(points: &[Point], feed: f64) -> String {
    let mut text = "UNITS/MM\nMULTAX/ON\nSPINDL/3000,RPM,CLW\n".to_owned();
    for Point { tip, axis, rapid } in points {
        text += &if *rapid {
            "RAPID\n".to_owned()
        } else {
            format!("FEDRAT/{feed},MMPM\n")
        };
        text += &format!(
            "GOTO/{:.4},{:.4},{:.4},{:.7},{:.7},{:.7}\n",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        );
    }
    text + "FINI\n"
}

/// Line of the CL file of point `index`.
fn line(index: usize) -> u64 {
    3 + 2 * (index as u64 + 1)
}

/// Largest deviations of a run: tip and tool axis (degrees) in cuts, tip in rapids.
#[derive(Debug, Default)]
struct Worst {
    tip: f64,
    axis: f64,
    rapid: f64,
    blocks: usize,
}

/// Samples every block of a run against the straight lines and great circles of its CL file.
fn judge(model: &Model, points: &[Point], run: &Run) -> Worst {
    let mut worst = Worst::default();
    let mut last: Option<&[f64]> = None;
    for (index, target) in points.iter().enumerate() {
        let blocks: Vec<&Asked> = run
            .asked
            .iter()
            .filter(|asked| asked.line == line(index) && !asked.words.is_empty())
            .collect();
        let Some(start) = (index > 0).then(|| &points[index - 1]) else {
            last = blocks.last().map(|block| &block.words[..]);
            continue;
        };
        let (from_axis, to_axis) = (start.axis.normalize(), target.axis.normalize());
        let along = target.tip - start.tip;
        let length = along.norm();
        let place =
            |tip: Vector3<f64>| ((tip - start.tip).dot(&along) / (length * length)).clamp(0.0, 1.0);
        // The place of a block's end on the line is known to the rounding of the words only.
        let blur = (angle(from_axis, to_axis) * 0.001 / length).to_degrees() + 1e-9;
        for block in &blocks {
            let from = last.expect("a first position");
            let ends = [
                place(model.at(from, &block.words, 0.0).0),
                place(model.at(from, &block.words, 1.0).0),
            ];
            for step in 0..=40 {
                let t = f64::from(step) / 40.0;
                let (tip, axis) = model.at(from, &block.words, t);
                let off = distance(tip, start.tip, target.tip);
                if target.rapid {
                    assert_eq!(block.kind, "Rapid");
                    worst.rapid = worst.rapid.max(off);
                    continue;
                }
                assert_eq!(block.kind, "Linear");
                worst.tip = worst.tip.max(off);
                let wanted = slerp(from_axis, to_axis, ends[0] * (1.0 - t) + ends[1] * t);
                worst.axis = worst.axis.max(angle(axis, wanted).to_degrees() - blur);
            }
            last = Some(&block.words);
            worst.blocks += 1;
        }
        // It arrives, or the line moved nothing.
        let end = last.expect("a position");
        let (tip, axis) = model.at(end, end, 0.0);
        assert!(
            (tip - target.tip).norm() < 0.0015,
            "line {} ends {:?} off",
            line(index),
            tip - target.tip
        );
        assert!(
            angle(axis, to_axis).to_degrees() < 0.05,
            "line {}",
            line(index)
        );
    }
    worst
}

/// Runs a path and holds what came out against the tolerances and against what the report certifies.
fn check(what: &str, model: &Model, points: &[Point]) -> Worst {
    let run = model.run(&cl(points, 1000.0));
    let Some(report) = &run.report else {
        panic!("{what}: {:#?}", run.findings);
    };
    let worst = judge(model, points, &run);
    for (mark, kind) in [
        (report.tip_deviation_mm, "Linear"),
        (report.rapid_deviation_mm, "Rapid"),
    ] {
        // The recorder writes one line an event.
        if mark.block > 0 {
            let block = &run.asked[mark.block as usize - 1];
            assert_eq!((block.kind, block.line), (kind, mark.line), "{what}");
        }
    }
    for range in &report.axes {
        let place = model.place(&range.name);
        let unit = if model.reference.joints[place].rotary {
            1f64.to_degrees()
        } else {
            1.0
        };
        let motions = run.asked.iter().filter(|asked| !asked.words.is_empty());
        let values: Vec<f64> = motions
            .map(|asked| model.positions(&asked.words)[place] * unit)
            .collect();
        let (least, most) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(*x), b.max(*x))
            });
        // Under TCP the control brings the axes to where the rounded tip wants them.
        let rounding = if model.tcp { 2e-3 } else { 1e-6 };
        assert!(
            (range.min - least).abs() < rounding && (range.max - most).abs() < rounding,
            "{what}: {range:?} {least} {most}"
        );
    }
    assert!(worst.tip <= 0.005 + 1e-9, "{what}: {worst:?}");
    assert!(worst.axis <= 0.05 + 1e-9, "{what}: {worst:?}");
    assert!(worst.rapid <= 0.5 + 1e-9, "{what}: {worst:?}");
    assert!(
        report.tip_deviation_mm.value <= 0.005 && report.rapid_deviation_mm.value <= 0.5,
        "{what}: {report:?}"
    );
    assert!(
        report.axis_deviation_deg.value <= 0.05,
        "{what}: {report:?}"
    );
    assert!(
        worst.tip <= report.tip_deviation_mm.value + 1e-9,
        "{what}: {worst:?} {:?}",
        report.tip_deviation_mm
    );
    assert!(
        worst.axis <= report.axis_deviation_deg.value + 1e-9,
        "{what}: {worst:?} {:?}",
        report.axis_deviation_deg
    );
    assert!(
        worst.rapid <= report.rapid_deviation_mm.value + 1e-9,
        "{what}: {worst:?} {:?}",
        report.rapid_deviation_mm
    );
    worst
}

const WIDE: [f64; 2] = [-175.0, 175.0];

/// A walk of tip and axis, tilted by at most `most` radians.
fn walk(rng: &mut Rng, count: usize, most: f64) -> Vec<Point> {
    let mut tip = rng.point(50.0);
    let mut axis = Vector3::z();
    (0..count)
        .map(|index| {
            tip += rng.direction() * rng.order(0.3, 1.5);
            let step = rng.direction() * rng.order(-3.0, -0.7);
            let next = (axis + step).normalize();
            if angle(next, Vector3::z()) < most {
                axis = next;
            }
            point(tip, axis, index % 9 == 0)
        })
        .collect()
}

#[test]
fn every_block_of_random_paths_is_within_tolerance() {
    for kind in ["trunnion", "head", "nutating"] {
        for tcp in [false, true] {
            let model = model(kind, tcp, WIDE, &[]);
            let mut worst = Worst::default();
            for seed in 0..8 {
                let points = walk(&mut Rng(100 + seed), 60, 1.0);
                let one = check(&format!("{kind} {tcp} {seed}"), &model, &points);
                worst.tip = worst.tip.max(one.tip);
                worst.axis = worst.axis.max(one.axis);
                worst.rapid = worst.rapid.max(one.rapid);
                worst.blocks += one.blocks;
            }
            println!("{kind}, tcp {tcp}: {worst:?}");
            assert!(worst.rapid > 0.1 || tcp, "rapids are cut as finely as cuts");
        }
    }
}

/// A held axis keeps its angle, and the one that is left does the same as on a four-axis machine.
#[test]
fn a_held_axis_leaves_a_four_axis_machine() {
    for held in [0.0f64, 30.0] {
        for tcp in [false, true] {
            let model = model("trunnion", tcp, WIDE, &[&format!("axis.C.indexed={held}")]);
            let frame = Rotation3::from_axis_angle(&Vector3::z_axis(), held.to_radians());
            let points: Vec<Point> = walk(&mut Rng(55), 60, 1.0)
                .into_iter()
                .map(|old| {
                    point(
                        old.tip,
                        frame * Vector3::new(0.0, old.axis.y, old.axis.z).normalize(),
                        old.rapid,
                    )
                })
                .collect();
            let worst = check(&format!("held {held}, {tcp}"), &model, &points);
            assert!(worst.blocks >= 59, "{worst:?}");
            let run = model.run(&cl(&points, 1000.0));
            assert!(run.motions().iter().all(|(_, words)| words[4] == held));
        }
    }
}

/// Points along a great circle that passes the pole at `beside` degrees, from 5° before to 5° behind it.
fn pass(beside: f64, count: usize, turned: f64) -> Vec<Point> {
    (0..=count)
        .map(|index| {
            let s = -1.0 + 2.0 * index as f64 / count as f64;
            let axis = Vector3::new(
                libm::tan((5.0 * s).to_radians()),
                libm::tan(beside.to_radians()),
                1.0,
            );
            let axis = Rotation3::from_axis_angle(&Vector3::z_axis(), turned) * axis;
            point(
                Vector3::new(40.0 * s, 10.0, 5.0 * s * s),
                axis.normalize(),
                false,
            )
        })
        .collect()
}

/// Over the pole, and beside it at every distance, in one long cut and in short ones, whether or not the tilting
/// axis may swing through.
#[test]
fn cuts_over_and_beside_the_pole_are_within_tolerance() {
    const BESIDE: [f64; 6] = [0.0, 1e-3, 0.01, 0.1, 1.0, 1e-5];
    for kind in ["trunnion", "head", "nutating"] {
        for tcp in [false, true] {
            // A hair beside the pole with a tilt that ends at zero is the next test's.
            for (tilt, beside) in [(WIDE, 6), ([-120.0, 0.0], 6), ([0.0, 120.0], 5)] {
                let model = model(kind, tcp, tilt, &[]);
                for beside in &BESIDE[..beside] {
                    for (count, turned) in [
                        (1, 0.0),
                        (1, 0.7),
                        (4, 0.0),
                        (5, 0.7),
                        (200, 0.0),
                        (200, 0.7),
                    ] {
                        let what = format!(
                            "{kind}, tcp {tcp}, tilt {tilt:?}, {beside}° beside, {count} cuts, turned {turned}"
                        );
                        check(&what, &model, &pass(*beside, count, turned));
                    }
                }
            }
        }
    }
}

/// A tilt that ends at zero can point the tool 1e-7 rad (the last decimal of a CL file) off the pole: the mirrored
/// solution, or none at all, is well within tolerance.
#[test]
fn a_hair_beside_the_pole_is_not_over_travel() {
    for kind in ["trunnion", "head", "nutating"] {
        for tilt in [[-120.0, 0.0], [0.0, 120.0]] {
            let model = model(kind, false, tilt, &[]);
            for axis in [
                "0.0000002,0,1",
                "-0.0000002,0,1",
                "0,0.0000002,1",
                "0,-0.0000002,1",
            ] {
                let run = model.run(&format!("UNITS/MM\nGOTO/1,2,3,{axis}\n"));
                assert!(
                    run.report.is_some(),
                    "{kind} {tilt:?} {axis}: {}",
                    run.findings[0].message
                );
            }
        }
    }
}

/// The words of all motions of a CL text.
fn words(model: &Model, cl: &str) -> Vec<Vec<f64>> {
    model
        .run(cl)
        .good()
        .motions()
        .into_iter()
        .map(|(_, words)| words)
        .collect()
}

fn near(words: &[f64], expected: &[f64]) -> bool {
    words.len() == expected.len()
        && words
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 5.1e-4)
}

/// With tcp = "post" a word is the axis position minus that with the tip of the tool on the part origin.
#[test]
fn words_are_positions_from_the_part_origin() {
    let text = "UNITS/MM\nRAPID\nGOTO/0,0,0,0,0,1\nFEDRAT/100\nGOTO/10,20,30\n";
    for kind in ["trunnion", "head", "nutating"] {
        let words = words(&model(kind, false, WIDE, &[]), text);
        assert!(near(&words[0], &[0.0; 5]), "{kind}: {words:?}");
        assert!(
            near(&words[1], &[10.0, 20.0, 30.0, 0.0, 0.0]),
            "{kind}: {words:?}"
        );
    }
    // The pivot lies 250 mm and the tool 120 mm over the tip; A 30 leans the tool to -Y.
    let found = words(
        &model("head", false, WIDE, &[]),
        "UNITS/MM\nGOTO/10,20,30,0,-0.5,0.8660254\n",
    );
    assert!(
        near(
            &found[0],
            &[
                10.0,
                20.0 - 185.0,
                30.0 + 370.0 * (0.8660254 - 1.0),
                30.0,
                0.0
            ]
        ),
        "{found:?}"
    );
    // The part origin, (10, -20, 30) in the machine, turns by 30° about the A axis at Y 0.012, Z 50.004.
    let found = words(
        &model("trunnion", false, WIDE, &[]),
        "UNITS/MM\nGOTO/0,0,0,0,0.5,0.8660254\n",
    );
    let (y, z) = (-20.0 - 0.012, 30.0 - 50.004);
    let turned = [
        0.8660254 * y - 0.5 * z + 0.012 + 20.0,
        0.5 * y + 0.8660254 * z + 50.004 - 30.0,
    ];
    assert!(
        near(&found[0], &[0.0, turned[0], turned[1], -30.0, 0.0]),
        "{found:?} {turned:?}"
    );
    // With tcp = "control" the linear words are the tip, whatever the machine.
    for kind in ["trunnion", "head", "nutating"] {
        let found = words(
            &model(kind, true, WIDE, &[]),
            "UNITS/MM\nGOTO/10,20,30,0.1,-0.5,0.8602325\n",
        );
        assert!(
            near(&found[0][..3], &[10.0, 20.0, 30.0]),
            "{kind}: {found:?}"
        );
    }
}

/// Under TCP a linear word is a coordinate of the tip: an axis by another letter is refused, or has its own coordinate;
/// no coordinate may be lost without a word.
#[test]
fn no_coordinate_is_lost_under_tcp() {
    let text = r#"
name = "V for Y"
chain = "[w C' A' b V X Z t]"
tool = { gauge = [0, 0, 400] }
control = { dialect = "recorder", tcp = "control" }
[axis]
C = { rotary = [0, 0, 1], point = [0, 0, 0], cyclic = true }
A = { rotary = [1, 0, 0], point = [0, 0, 0], travel = [-120, 120] }
X = { linear = [1, 0, 0], travel = [-500, 500] }
V = { linear = [0, 1, 0], travel = [-500, 500] }
Z = { linear = [0, 0, 1], travel = [-500, 500] }
"#;
    let source = Source {
        name: "v.toml".to_owned(),
        text: text.to_owned(),
    };
    let Ok(machine) = load(source, &[], &mut |_| Err(String::new())) else {
        return;
    };
    let run = run(&machine, "UNITS/MM\nGOTO/1,2,3,0,0,1\n", Job::default());
    if run.report.is_some() {
        let mut linear = run.motions()[0].1[..3].to_vec();
        linear.sort_by(f64::total_cmp);
        assert_eq!(linear, [1.0, 2.0, 3.0]);
    }
}

/// The time of a block as its control understands the feed, minutes.
fn minutes(model: &Model, from: &[f64], block: &Asked) -> f64 {
    let travel =
        |range: std::ops::Range<usize>| range.map(|index| block.words[index] - from[index]);
    match block.feed {
        Some(Feed::InverseTime(feed)) => 1.0 / feed,
        Some(Feed::PerMinute(feed)) => {
            let linear = travel(0..3).map(|step| step * step).sum::<f64>().sqrt();
            let rotary = travel(3..5).fold(0.0, |most: f64, step| most.max(step.abs()));
            if !model.tcp {
                assert_eq!(rotary, 0.0, "a feed a minute while an axis turns");
            }
            (if linear > 1e-9 { linear } else { rotary }) / feed
        }
        _ => panic!("{block:?}"),
    }
}

/// Every cut takes the time that its feed asks for, or longer where an axis would be too fast. Gives the largest
/// share that any axis has of its largest feed, as the control understands the printed words.
fn fastest(tcp: bool) -> f64 {
    let mut fastest: f64 = 0.0;
    for kind in ["trunnion", "head", "nutating"] {
        {
            let model = model(kind, tcp, WIDE, &[]);
            let most: Vec<f64> = model
                .machine
                .axes
                .iter()
                .map(|axis| match axis.name.as_str() {
                    "C" => 9000f64.to_radians(),
                    "A" | "B" => 5400f64.to_radians(),
                    "Z" => 15_000.0,
                    _ => 20_000.0,
                })
                .collect();
            for feed in [300.0, 6000.0] {
                let points = walk(&mut Rng(7), 80, 1.0);
                let run = model.run(&cl(&points, feed)).good();
                let (mut at_feed, mut limited) = (0, 0);
                let mut last: Option<&Asked> = None;
                for (index, point) in points.iter().enumerate() {
                    let (mut time, mut slowest): (f64, f64) = (0.0, 0.0);
                    for block in run
                        .asked
                        .iter()
                        .filter(|asked| asked.line == line(index) && !asked.words.is_empty())
                    {
                        if let Some(last) = last
                            && block.kind == "Linear"
                        {
                            let (from, to) =
                                (model.positions(&last.words), model.positions(&block.words));
                            let minutes = minutes(&model, &last.words, block);
                            for (place, most) in most.iter().enumerate() {
                                let share = (to[place] - from[place]).abs() / minutes / most;
                                slowest = slowest.max(share);
                                fastest = fastest.max(share);
                            }
                            time += minutes;
                        }
                        last = Some(block);
                    }
                    if index == 0 || point.rapid {
                        continue;
                    }
                    let asked = (point.tip - points[index - 1].tip).norm() / feed;
                    if slowest > 0.99 {
                        limited += 1;
                        assert!(time > asked * 0.99);
                    } else {
                        at_feed += 1;
                        assert!(
                            (time / asked - 1.0).abs() < 0.01,
                            "{kind} {tcp} line {}: {time} for {asked}",
                            line(index)
                        );
                    }
                }
                eprintln!("{kind}, tcp {tcp}, F{feed}: {at_feed} moves at feed, {limited} limited");
                assert!(at_feed > 10);
            }
        }
    }
    fastest
}

#[test]
fn feeds_are_those_of_the_tip_and_no_axis_is_too_fast() {
    let fastest = fastest(false);
    assert!(
        fastest <= 1.0 + 1e-6,
        "an axis at {fastest} of its largest feed"
    );
}

/// The same where the control keeps the tip: it divides the way between the printed tips by F.
#[test]
fn feeds_are_those_of_the_tip_and_no_axis_is_too_fast_under_tcp() {
    let fastest = fastest(true);
    assert!(
        fastest <= 1.0 + 1e-6,
        "an axis at {fastest} of its largest feed"
    );
}

#[test]
fn inches_in_and_inches_out() {
    let mm = model("head", false, WIDE, &[]);
    let run = mm
        .run("UNITS/INCHES\nFEDRAT/10,IPM\nGOTO/0,0,0\nGOTO/1,-2,0\n")
        .good();
    let last = run
        .asked
        .iter()
        .rfind(|asked| asked.kind == "Linear")
        .unwrap();
    assert!(near(&last.words, &[25.4, -50.8, 0.0, 0.0, 0.0]), "{last:?}");
    assert_eq!(last.feed, Some(Feed::PerMinute(254.0)));

    let inch = model("head", false, WIDE, &["control.units=inch"]);
    let run = inch.run("UNITS/MM\nFEDRAT/254,MMPM\nGOTO/0,0,0\nGOTO/25.4,-50.8,0\nGOTO/25.4,-50.8,0,0,-0.5,0.8660254\n");
    let last = run
        .asked
        .iter()
        .find(|asked| asked.kind == "Linear")
        .unwrap();
    assert!(near(&last.words, &[1.0, -2.0, 0.0, 0.0, 0.0]), "{last:?}");
    assert_eq!(last.feed, Some(Feed::PerMinute(10.0)));
    // Thousandths of an inch are too coarse for five micrometres, and that is said.
    assert_eq!(run.findings[0].code, "rounding", "{:?}", run.findings);
    assert_eq!(run.findings[0].place.as_ref().unwrap().line, 5);
}

#[test]
fn frames_are_applied_as_asked() {
    let model = model("trunnion", true, WIDE, &[]);
    // X of the frame is Y of the file, its Y is -X.
    let text = "UNITS/MM\nMSYS/10,20,30,0,1,0,-1,0,0\nGOTO/11,22,33,0.6,0,0.8\n";
    for (apply, tip, axis) in [
        (false, [11.0, 22.0, 33.0], [0.6, 0.0, 0.8]),
        (true, [2.0, -1.0, 3.0], [0.0, -0.6, 0.8]),
    ] {
        let reading = Reading {
            apply_msys: apply,
            ..Reading::default()
        };
        let run = run(
            &model.machine,
            text,
            Job {
                reading,
                ..Job::default()
            },
        )
        .good();
        let (_, words) = &run.motions()[0];
        let reached = model.at(words, words, 0.0);
        assert!((reached.0 - Vector3::from(tip)).norm() < 1e-3, "{words:?}");
        assert!(angle(reached.1, Vector3::from(axis)) < 2e-5, "{words:?}");
    }
    // An index angle in radians turns the frame of the file: Rx(-90°) takes Z to Y.
    let found = words(
        &model,
        "UNITS/MM\nROTABL/ -1.570796,AAXIS,TABLE,CCLW\nGOTO/1,2,3\nROTABL/ 0.000000,AAXIS,TABLE,CCLW\nRAPID\nGOTO/1,2,3\n",
    );
    let reached = model.at(&found[0], &found[0], 0.0);
    assert!(
        (reached.0 - Vector3::new(1.0, 3.0, -2.0)).norm() < 1e-3,
        "{reached:?}"
    );
    assert!(angle(reached.1, Vector3::y()) < 2e-5, "{reached:?}");
    assert!(
        near(found.last().unwrap(), &[1.0, 2.0, 3.0, 0.0, 0.0]),
        "{found:?}"
    );
}

/// Points of all blocks from the first cut on, finely.
fn trace(model: &Model, run: &Run) -> Vec<Vector3<f64>> {
    let motions = run.motions();
    let mut points = Vec::new();
    for pair in motions.windows(2) {
        if pair[1].0 == "Linear" {
            points.extend(
                (0..=16).map(|step| model.at(&pair[0].1, &pair[1].1, f64::from(step) / 16.0).0),
            );
        }
    }
    points
}

/// Every block lies within the tolerance of the true arc, goes its way round, and ends at its end, also while the
/// tool axis turns.
#[test]
fn arcs_are_within_tolerance() {
    let tilts = ["", ",0,-0.3,0.9539392"];
    for (kind, tcp) in [("head", false), ("trunnion", false), ("head", true)] {
        let model = model(kind, tcp, WIDE, &[]);
        for (sense, sweep) in [("1", 90.0), ("-1", -270.0)] {
            for end_axis in tilts {
                let text = format!(
                    "UNITS/MM\nFEDRAT/500,MMPM\nGOTO/60,0,5,0,0,1\nCIRCLE/0,0,5,0,0,{sense},60\nGOTO/0,60,5{end_axis}\n"
                );
                let points = trace(&model, &model.run(&text).good());
                let mut turned = 0.0;
                for pair in points.windows(2) {
                    let at = |point: &Vector3<f64>| libm::atan2(point.y, point.x);
                    turned += post_testkit::turned(at(&pair[0]), at(&pair[1])).to_degrees();
                }
                for point in &points {
                    let off = (libm::hypot(point.x, point.y) - 60.0)
                        .abs()
                        .max((point.z - 5.0).abs());
                    assert!(
                        off <= 0.005 + 1e-9,
                        "{kind} {tcp} {sense} {end_axis}: {off}"
                    );
                }
                assert!((turned - sweep).abs() < 0.01, "{kind}: {turned}");
                assert!((points[points.len() - 1] - Vector3::new(0.0, 60.0, 5.0)).norm() < 0.0015);
            }
        }
    }
}

/// The cubic B-spline of clamped `knots` at `u`, by the recursion of Cox and de Boor.
fn spline(knots: &[f64], points: &[Vector3<f64>], u: f64) -> Vector3<f64> {
    fn basis(knots: &[f64], index: usize, degree: usize, u: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[index] <= u && u < knots[index + 1]));
        }
        let share = |from: usize, to: usize, over: f64| {
            let width = knots[to] - knots[from];
            if width > 0.0 { over / width } else { 0.0 }
        };
        share(index, index + degree, u - knots[index]) * basis(knots, index, degree - 1, u)
            + share(index + 1, index + degree + 1, knots[index + degree + 1] - u)
                * basis(knots, index + 1, degree - 1, u)
    }
    points
        .iter()
        .enumerate()
        .fold(Vector3::zeros(), |sum, (index, point)| {
            sum + point * basis(knots, index, 3, u)
        })
}

#[test]
fn splines_are_within_tolerance() {
    let points = [
        [0.0, 0.0, 0.0],
        [10.0, 30.0, 2.0],
        [25.0, -20.0, 4.0],
        [40.0, 25.0, 1.0],
        [60.0, 10.0, 3.0],
        [70.0, 0.0, 0.0],
    ]
    .map(Vector3::from);
    let knots = [0.0, 0.0, 0.0, 0.0, 0.3, 0.55, 1.0, 1.0, 1.0, 1.0];
    let mut text = "UNITS/MM\nFEDRAT/500,MMPM\nGOTO/0,0,0\nNURBS/\nKNOT/0.3,0.55,1.0\n".to_owned();
    for point in &points[1..] {
        text += &format!("CNTRL/{},{},{}\n", point.x, point.y, point.z);
    }
    text += "END-OF-PATH\n";
    let model = model("head", false, WIDE, &[]);
    let traced = trace(&model, &model.run(&text).good());
    let curve: Vec<Vector3<f64>> = (0..4000)
        .map(|step| spline(&knots, &points, f64::from(step) / 4000.0))
        .chain([points[5]])
        .collect();
    let far = |from: &[Vector3<f64>], to: &[Vector3<f64>]| {
        from.iter()
            .map(|point| {
                to.windows(2)
                    .map(|pair| distance(*point, pair[0], pair[1]))
                    .fold(f64::INFINITY, f64::min)
            })
            .fold(0.0, f64::max)
    };
    let (there, back) = (far(&traced, &curve), far(&curve, &traced));
    println!("spline: {there} mm from the curve, the curve {back} mm from it");
    assert!(
        there <= 0.005 + 1e-5 && back <= 0.005 + 1e-5,
        "{there} {back}"
    );
}

/// A cycle becomes moves along the tool axis, in the order in which it drills.
#[test]
fn cycles_are_drilled_in_order() {
    let model = model("trunnion", true, WIDE, &[]);
    let heights = |run: &Run| -> Vec<(&'static str, f64)> {
        run.asked
            .iter()
            .filter(|asked| ["Rapid", "Linear", "Dwell"].contains(&asked.kind))
            .map(|asked| {
                (
                    asked.kind,
                    asked.words.get(2).copied().unwrap_or(asked.value),
                )
            })
            .collect()
    };
    let text = "UNITS/MM\nRAPID\nGOTO/0,0,50\nCYCLE/DEEP,DEPTH,3.5,STEP,2.0,MMPM,50,CLEAR,1\nGOTO/10,20,0\nGOTO/30,20,0\nCYCLE/OFF\nRAPID\nGOTO/30,20,50\n";
    let run_deep = model.run(text).good();
    let hole = [
        ("Rapid", 1.0),
        ("Linear", -2.0),
        ("Rapid", 1.0),
        ("Rapid", -1.5),
        ("Linear", -3.5),
        ("Rapid", 1.0),
    ];
    // Aside at the height where the tool stands, and only then down.
    let expected: Vec<_> = [&[("Rapid", 50.0)], &hole[..], &hole[..], &[("Rapid", 50.0)]].concat();
    assert_eq!(heights(&run_deep), expected);
    let feeds: Vec<_> = run_deep
        .asked
        .iter()
        .filter_map(|asked| asked.feed)
        .collect();
    assert_eq!(feeds, [Feed::PerMinute(50.0); 4]);

    let text = "UNITS/MM\nRAPID\nGOTO/0,0,50\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,25,MMPM,250,DWELL,0.5\nGOTO/10,20,0\nCYCLE/OFF\n";
    let run_drill = model.run(text).good();
    assert_eq!(
        heights(&run_drill),
        [
            ("Rapid", 50.0),
            ("Rapid", 25.0),
            ("Rapid", 3.0),
            ("Linear", -10.0),
            ("Dwell", 0.5),
            ("Rapid", 25.0)
        ]
    );

    // Along a tilted tool.
    let text = "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,30,40,0,0.6,0.8\nCYCLE/DRILL,RAPTO,5,FEDTO,-10,MMPM,250\nGOTO/0,0,0\nCYCLE/OFF\n";
    let tips: Vec<_> = model
        .run(text)
        .good()
        .motions()
        .into_iter()
        .map(|(_, words)| words)
        .collect();
    for (words, height) in tips[1..].iter().zip([5.0, -10.0, 5.0]) {
        assert!(
            near(&words[..3], &[0.0, 0.6 * height, 0.8 * height]),
            "{tips:?}"
        );
    }
    assert_eq!(tips.len(), 4);
}

/// A GOTO of three numbers keeps the tool axis.
#[test]
fn the_axis_is_modal() {
    let found = words(
        &model("trunnion", true, WIDE, &[]),
        "UNITS/MM\nMULTAX/ON\nFEDRAT/100\nGOTO/0,0,0,0,-0.5,0.8660254\nGOTO/10,0,0\nGOTO/20,0,0,0,0,1\n",
    );
    assert!(near(&found[1], &[10.0, 0.0, 0.0, 30.0, 0.0]), "{found:?}");
    assert!(
        near(found.last().unwrap(), &[20.0, 0.0, 0.0, 0.0, 0.0]),
        "{found:?}"
    );
}

/// A refusal names the axis, its value, its limit and the CL line; other faults of the run are told beside it.
#[test]
fn faults_say_where_what_and_how_much() {
    let model = model("head", false, [-100.0, 100.0], &["axis.X.travel=[-90, 90]"]);
    let text = "UNITS/MM\nFEDRAT/100\nGOTO/0,0,0,0,0,1\nGOTO/85,0,0\nGOTO/1,0,0,0,-0.5,-0.8660254\nGOTO/2,0,0,0,0,0\n";
    let run = model.run(text);
    assert!(run.report.is_none());
    // X stands at 10 with the tip on the part origin.
    let told: Vec<(u64, &str, &str)> = run
        .findings
        .iter()
        .filter(|finding| finding.severity == Severity::Error)
        .map(|finding| {
            let place = finding.place.as_ref().unwrap();
            (place.line, finding.code, &place.text[place.span.clone()])
        })
        .collect();
    assert_eq!(
        told,
        [
            (4, "over-travel", "GOTO/85,0,0"),
            (5, "over-travel", "GOTO/1,0,0,0,-0.5,-0.8660254"),
            (6, "axis", "GOTO/2,0,0,0,0,0"),
        ]
    );
    for (finding, words) in run.findings.iter().zip([
        ["X", "95.000 mm", "90.000 mm"],
        ["A", "150.000°", "100.000°"],
    ]) {
        for word in words {
            assert!(
                finding.message.contains(word),
                "{word}: {}",
                finding.message
            );
        }
        assert!(finding.help.is_some());
    }

    // B of the nutating head lays the tool flat and no further.
    let nutating = self::model("nutating", false, WIDE, &[]);
    let run = nutating.run("UNITS/MM\nGOTO/0,0,0,0,0,-1\n");
    assert_eq!(run.findings[0].code, "out-of-reach");
    assert!(
        run.findings[0].message.contains("90.0000°"),
        "{}",
        run.findings[0].message
    );

    let run = nutating.run("UNITS/MM\nGOTO/0,0,0,0,0,1\nGOTO/1,0,0\n");
    assert_eq!(
        (
            run.findings[0].code,
            run.findings[0].place.as_ref().unwrap().line
        ),
        ("no-feed", 3)
    );
}

/// Whatever the numbers, a run ends with a report or with errors, and no word or feed is ever not finite
/// (the recorder looks at each).
#[test]
fn no_numbers_make_it_stumble() {
    let mut rng = Rng(9);
    // The further on, the worse.
    let odd = [
        0.0, 1.0, -1.0, 0.5, 1e-7, -0.0, 1e-12, 1e3, 1e9, 1e30, 1e300,
    ];
    let (mut good, mut bad) = (0, 0);
    for kind in ["trunnion", "head", "nutating"] {
        for tcp in [false, true] {
            let model = model(kind, tcp, WIDE, &[]);
            for _ in 0..150 {
                let mut text = "UNITS/MM\nMULTAX/ON\n".to_owned();
                let most = [4, 5, 7, odd.len()][rng.pick(4)];
                for _ in 0..8 {
                    let mut numbers: Vec<String> =
                        (0..6).map(|_| odd[rng.pick(most)].to_string()).collect();
                    if rng.pick(3) > 0 {
                        numbers[5] = "1".to_owned();
                    }
                    text += [
                        "RAPID\n",
                        "FEDRAT/1E-9\n",
                        "FEDRAT/100\n",
                        "FEDRAT/1E12,MMPM\n",
                        "FEDRAT/1\n",
                    ][rng.pick(5)];
                    if rng.pick(30) == 0 {
                        text += &format!("CIRCLE/{},0,0,1\n", numbers[..3].join(","));
                    }
                    text += &format!("GOTO/{}\n", numbers.join(","));
                }
                let run = model.run(&text);
                let errors = run
                    .findings
                    .iter()
                    .filter(|finding| finding.severity == Severity::Error)
                    .count();
                assert_eq!(run.report.is_none(), errors > 0, "{text}");
                assert!(errors <= MOST_FAULTS + 8);
                if errors > 0 { bad += 1 } else { good += 1 }
            }
        }
    }
    println!("{good} good runs, {bad} refused");
    assert!(good > 20 && bad > 100);
}
