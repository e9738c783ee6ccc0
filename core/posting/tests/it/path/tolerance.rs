//! Random paths and passes of the pole stay within tolerance.

use super::*;

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
        assert!(angle(axis, to_axis).to_degrees() < 0.05, "line {}", line(index));
    }
    worst
}

/// The words of all motions; where the control keeps the tip, those that the axes pass between them too.
fn passed(model: &Model, run: &Run) -> Vec<Vec<f64>> {
    let mut passed: Vec<Vec<f64>> = Vec::new();
    for asked in run.motions() {
        let from = passed.last().filter(|_| model.tcp).cloned();
        let turns = |from: &[f64]| {
            let pairs = from[3..].iter().zip(&asked.words[3..]);
            pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
        };
        if let Some(from) = from
            && asked.kind != "Position"
        {
            let count = 1.0 + (4.0 * turns(&from)).ceil();
            for step in 1..count as u32 {
                let t = f64::from(step) / count;
                let pairs = from.iter().zip(&asked.words);
                passed.push(pairs.map(|(a, b)| a * (1.0 - t) + b * t).collect());
            }
        }
        passed.push(asked.words.clone());
    }
    passed
}

/// Runs a path and holds what came out against the tolerances and against what the report certifies.
fn check(what: &str, model: &Model, points: &[Point]) -> Worst {
    let run = model.run(&cl(points, 1000.0));
    let Some(report) = &run.report else {
        panic!("{what}: {:#?}", run.findings);
    };
    let worst = judge(model, points, &run);
    for (mark, kind) in [(report.tip_deviation_mm, "Linear"), (report.rapid_deviation_mm, "Rapid")]
    {
        // The recorder writes one line an event.
        if mark.block > 0 {
            let block = &run.asked[mark.block as usize - 1];
            assert_eq!((block.kind, block.line), (kind, mark.line), "{what}");
        }
    }
    for range in &report.axes {
        let place = model.place(&range.name);
        let unit = if model.reference.joints[place].rotary { 1f64.to_degrees() } else { 1.0 };
        let values: Vec<f64> =
            passed(model, &run).iter().map(|words| model.positions(words)[place] * unit).collect();
        let (least, most) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
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
    assert!(report.axis_deviation_deg.value <= 0.05, "{what}: {report:?}");
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

#[test]
fn every_block_of_random_paths_is_within_tolerance() {
    for kind in ["trunnion", "head", "nutating"] {
        for tcp in [false, true] {
            let model = model(kind, tcp, WIDE, &[]);
            let mut worst = Worst::default();
            for seed in 0..rounds(8_u64) {
                let points = walk(&mut seeded(100 + seed), 60, 1.0);
                let one = check(&format!("{kind} {tcp} {seed}"), &model, &points);
                worst.tip = worst.tip.max(one.tip);
                worst.axis = worst.axis.max(one.axis);
                worst.rapid = worst.rapid.max(one.rapid);
                worst.blocks += one.blocks;
            }
            println!("{kind}, tcp {tcp}: {worst:?}");
            // A cut may be 0.005 mm off, a rapid 0.5 mm.
            assert!(worst.rapid > 0.005 || tcp, "rapids are cut as finely as cuts");
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
            let points: Vec<Point> = walk(&mut seeded(55), 60, 1.0)
                .into_iter()
                .map(|old| {
                    let mut lean = libm::atan2(old.axis.y, old.axis.z);
                    // Between cuts the axis is where the file asks for it. The seven decimals of a tool axis say so to half a
                    // thousandth of a degree from 5e-8/8.7e-6 = 0.006 off the pole on.
                    if old.rapid && lean.abs() < 0.02 {
                        lean = 0.02;
                    }
                    let (sine, cosine) = libm::sincos(lean);
                    point(old.tip, frame * Vector3::new(0.0, sine, cosine), old.rapid)
                })
                .collect();
            let worst = check(&format!("held {held}, {tcp}"), &model, &points);
            assert!(worst.blocks >= 59, "{worst:?}");
            let run = model.run(&cl(&points, 1000.0));
            assert!(run.motions().iter().all(|asked| asked.words[4] == held));
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
            point(Vector3::new(40.0 * s, 10.0, 5.0 * s * s), axis.normalize(), false)
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
                    for (count, turned) in
                        [(1, 0.0), (1, 0.7), (4, 0.0), (5, 0.7), (200, 0.0), (200, 0.7)]
                    {
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
            for axis in ["0.0000002,0,1", "-0.0000002,0,1", "0,0.0000002,1", "0,-0.0000002,1"] {
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
