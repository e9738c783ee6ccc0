//! How many blocks it takes, against each other and against theory.

use super::*;

/// A move cut up by `fewest` has no more blocks than cut up by `bisect`, and by `even` no more than its peak asks for
/// where that falls with the square of the length: of these examples. It is as few as are found, each as long as it can be
/// behind the one before, and nothing bounds them.
#[test]
fn fewest_needs_no_more_blocks_than_bisect() {
    let (rounds, mut rng) = (0..rounds(150_usize), Rng::new(43));
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
        let whole = Given { tolerance: 100.0, ..given.clone() };
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
            assert!(even >= asked, "round {round}: {even} pieces, {asked} asked for");
        }
    }
    println!("bisect, even, fewest: {sums:?}; even more than asked, as asked: {exact:?}");
    assert!(sums[2] * 10 < sums[0] * 8, "{sums:?}");
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
            println!("{config}, {tolerance}: {} blocks, theory {theory}", made.len());
            assert!((made.len() as f64) < theory * 1.12 + 24.0, "{}", made.len());
            // The number of points adds up.
            assert_eq!(report.moves + report.points_added - report.points_dropped, report.blocks);
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
        let certified = run.report.as_ref().map(|report| report.tip_deviation_mm.value);
        let certified = certified.unwrap_or_default();
        assert!((1.99 * radius..=0.1).contains(&certified), "{placement}: {certified}");
    }
}
