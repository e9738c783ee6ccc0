//! Points moved by what the model says.

use super::*;

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
    let points = post_testmachines::blade()?;
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
            let of: Vec<_> = made.iter().filter(|block| block.lines[1] == lines[index]).collect();
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
    for (shape, expected, slack) in
        [(Shape::Sine, 0.26, 0.006), (Shape::Parabola, 0.006, 0.002), (Shape::Fine, 0.0, 0.001)]
    {
        let bench = dual_table("post", 1e-5, "method = \"compensate\"\npoints = 199");
        let run = bench.run_with(&cl, &mut { shape }, true).good("compensated");
        let after = most(&run, &bench);
        println!("{shape:?}: {worst} to {after} µm");
        assert!((after - expected).abs() < slack, "{shape:?}: {after}");
    }
    // Eq. 3.4 word for word: a point stands where the straight line of the axes leads, less the model's curve.
    let bench = dual_table("post", 0.0035, "method = \"compensate\"\npoints = 4");
    let run = bench.run_with(&cl, &mut Shape::Sine, true).good("compensated");
    let made = blocks(&bench, &run);
    let mut touched = 0;
    for (index, old) in blocks(&plain, &before).iter().enumerate() {
        let of: Vec<_> = made.iter().filter(|block| block.lines[1] == lines[index + 1]).collect();
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
                let run = bench.run_with(&cl, &mut { shape }, false).good("compensated");
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
