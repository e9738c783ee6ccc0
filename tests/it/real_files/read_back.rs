//! Programs read back by a reader and a kinematics of these tests' own.

use super::*;

/// What a program does to its CL points.
#[derive(Debug, Default)]
struct Found {
    /// Largest distance from the CL path in cuts and rapids, mm.
    cut: f64,
    rapid: f64,
    /// Largest angle to the CL axis in cuts, degrees.
    axis: f64,
}

/// Looks at 20 places of every block: how far each lies from the CL path's present piece; and every CL point
/// must be passed, to rounding, in order.
fn follow(points: &[Pose], blocks: &[Block], forward: impl Fn([f64; 6]) -> Pose) -> Found {
    const SAMPLES: u32 = 20;
    const TOLERANCE: f64 = 0.005;
    // Three words of three decimals, and rotary words that turn the tool axis a little.
    let reached = |pose: &Pose, point: &Pose| {
        (pose.tip - point.tip).norm() < 0.0012 && angle(pose.axis, point.axis) < 0.002
    };
    let mut found = Found::default();
    let mut at: Option<usize> = None;
    let mut last = blocks[0];
    for block in blocks {
        let end = forward(block.words);
        if let Some(index) = at
            && let Some(next) = points.get(index + 1)
        {
            let from = &points[index];
            let normal = from.axis.cross(&next.axis);
            let about_axis = normal.try_normalize(1e-12).unwrap_or_else(V::z);
            let whole = angle(from.axis, next.axis).to_radians();
            for sample in 1..=SAMPLES {
                let t = f64::from(sample) / f64::from(SAMPLES);
                let words = std::array::from_fn(|word| {
                    last.words[word] + (block.words[word] - last.words[word]) * t
                });
                let pose = forward(words);
                let chord = next.tip - from.tip;
                let along = if chord.norm() > 1e-6 {
                    (chord.dot(&(pose.tip - from.tip)) / chord.norm_squared()).clamp(0.0, 1.0)
                } else {
                    t
                };
                let off = (pose.tip - from.tip - chord * along).norm();
                if block.rapid {
                    found.rapid = found.rapid.max(off);
                    continue;
                }
                found.cut = found.cut.max(off);
                // A tip that is off by the tolerance says no better than this how far along the block is.
                let slack = TOLERANCE / chord.norm().max(TOLERANCE);
                let apart = |along: f64| {
                    // The tool axis turns evenly from one point to the next.
                    let axis = about_axis * (whole * along);
                    angle(pose.axis, Rotation3::new(axis) * from.axis)
                };
                let mut off = apart(along);
                if off > found.axis {
                    off = least(apart, along - slack, along + slack);
                }
                found.axis = found.axis.max(off);
            }
        }
        let mut next = at.map_or(0, |index| index + 1);
        // A point that prints like the one before has no block of its own.
        while next < points.len() && reached(&end, &points[next]) {
            at = Some(next);
            next += 1;
        }
        last = *block;
    }
    assert_eq!(at, Some(points.len() - 1), "the points after this one are not reached");
    found
}

fn read_back(file: &Path, check: &Check) {
    let (done, summary) = post(file, check.machine, check.with);
    assert_eq!(done.code, 0, "{} on {}:\n{}", check.name, check.machine, done.err);
    let summary = summary.unwrap();
    let text = fs::read_to_string(file).unwrap();
    let mut points = cl_points(&text, check.scale, check.with.contains("--msys apply"));
    // Where the part sits turned, its points are those of a frame that does not.
    for point in &mut points {
        point.tip = turn(Z, check.turned) * point.tip;
        point.axis = turn(Z, check.turned) * point.axis;
    }
    assert_eq!(points.len() as u64, summary["moves"].as_u64().unwrap());
    let blocks = nc_blocks(&done.out, check.letters);
    let (forward, mount, tool) = (check.forward, V::from(check.mount), check.tool);
    let found = follow(&points, &blocks, |words| forward(words, mount, tool));
    let value = |key: &str| summary[key]["value"].as_f64().unwrap();
    let name = format!("{} on {}: {found:?}", check.name, check.machine);
    eprintln!("{name}");
    // What is certified is a bound of what is found; the words are printed numbers on both sides.
    assert!(found.cut <= value("tip_deviation_mm") + 1e-6, "{name}");
    assert!(found.cut <= summary["tolerance_mm"].as_f64().unwrap(), "{name}");
    assert!(found.rapid <= 0.5, "{name}");
    assert!(found.axis <= 0.05 + 1e-6, "{name}");
    // The check can see: a program of points alone would not do.
    if summary["points_added"].as_u64().unwrap() > 50 {
        assert!(found.cut > 0.001, "{name}");
    }
}

#[test]
fn samples_are_read_back_on_every_arrangement() {
    for case in [
        check("blade.cls", "ac-trunnion", "--mount 3,-4,5", "XYZAC", ac_trunnion),
        check("blade.cls", "dmu50", "--mount 3,-4,5 --tcp post", "XYZBC", dmu50),
        check("blade.cls", "head-head", "--mount 3,-4,5 --tool-length 90", "XYZAC", head_head),
        check(
            "blade.cls",
            "nutating-head",
            "--mount 3,-4,5 --tcp post --tool-length 90",
            "XYZBC",
            nutating_head,
        ),
        check("blade.cls", "disc-cutter", "--mount 3,-4,5 --tool-length 90", "XYZABC", disc_cutter),
        check("knife.ncl", "disc-cutter", "--mount 3,-4,5 --tool-length 90", "XYZABC", disc_cutter),
        Check {
            turned: 33.0,
            ..check("blade.cls", "dmu50", "--mount 3,-4,5 --tcp post --turn 33", "XYZBC", dmu50)
        },
        Check {
            turned: -120.5,
            ..check(
                "blade.cls",
                "head-head",
                "--mount 3,-4,5 --tool-length 90 --turn=-120.5",
                "XYZAC",
                head_head,
            )
        },
        check("knife.ncl", "head-head", "--mount 3,-4,5 --tool-length 90", "XYZAC", head_head),
    ] {
        let tool = if case.with.contains("length") { 90.0 } else { 0.0 };
        let case = Check { mount: [3.0, -4.0, 5.0], tool, ..case };
        read_back(&root().join(sample(case.name)), &case);
    }
}

#[test]
fn real_files_are_read_back() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    const CREO: &str = "creo5x_4r19415_finition.ncl";
    for case in [
        Check { scale: 25.4, ..check(CREO, "head-head", "", "XYZAC", head_head) },
        Check {
            mount: [-140.0, 21.0, -40.0],
            ..check(CREO, "ac-trunnion", "--units mm --mount -140,21,-40", "XYZAC", ac_trunnion)
        },
        Check {
            mount: [-140.0, 21.0, 0.0],
            tool: 120.0,
            ..check(
                CREO,
                "dmu50",
                "--tcp post --units mm --mount -140,21,0 --tool-length 120",
                "XYZBC",
                dmu50,
            )
        },
        check(
            "nx_HumMan_ust_a2.cls",
            "head-head-360",
            "--set control.retract.Z=9000",
            "XYZAC",
            head_head,
        ),
        check("nx_HumMan_ust_a2.cls", "head-head", "--msys apply", "XYZAC", head_head),
        Check {
            scale: 25.4,
            tool: 100.0,
            ..check(
                "own_ncl_form.as",
                "nutating-head",
                "--units inch --tcp post --tool-length 100",
                "XYZBC",
                nutating_head,
            )
        },
    ] {
        read_back(&data.join(case.name), &case);
    }
}
