//! Programs with fewer points than their files, and arcs, held against the path.

use super::*;

/// The distance of a point from a piece of a straight line.
fn beside(point: V, from: V, to: V) -> f64 {
    let along = to - from;
    let square = along.norm_squared();
    let t = if square > 0.0 { ((point - from).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (point - from - along * t).norm()
}

/// Where on a leg of the CL path, not before the share `least`, a pose is first within `bound` mm and `turn` degrees.
fn first_within(pose: &Pose, from: &Pose, to: &Pose, least: f64, bound: [f64; 2]) -> Option<f64> {
    let (chord, off) = (to.tip - from.tip, pose.tip - from.tip);
    let square = chord.norm_squared();
    let (low, high) = if square > 1e-12 {
        let middle = off.dot(&chord) / square;
        let across = (off - chord * middle).norm_squared();
        let half = (bound[0] * bound[0] - across) / square;
        if half < 0.0 {
            return None;
        }
        let half = libm::sqrt(half);
        ((middle - half).max(least), (middle + half).min(1.0))
    } else if off.norm() <= bound[0] {
        (least, 1.0)
    } else {
        return None;
    };
    if low > high {
        return None;
    }
    let normal = from.axis.cross(&to.axis);
    let normal = normal.try_normalize(1e-12).unwrap_or_else(V::z);
    let whole = angle(from.axis, to.axis).to_radians();
    let apart = |t: f64| angle(pose.axis, Rotation3::new(normal * (whole * t)) * from.axis);
    const LOOKS: u32 = 40;
    (0..=LOOKS)
        .map(|look| low + (high - low) * f64::from(look) / f64::from(LOOKS))
        .find(|t| apart(*t) <= bound[1])
}

/// A program that leaves CL points out, walked along the CL path: every place of it is within what is certified of a
/// place of the path that is not before the last, every CL point is near the program, and corners are met.
fn read_loosely(file: &Path, check: &Check) {
    const SAMPLES: u32 = 20;
    let name = format!("{} on {} {}", check.name, check.machine, check.with);
    let (done, summary) = post(file, check.machine, check.with);
    assert_eq!(done.code, 0, "{name}:\n{}", done.err);
    let summary = summary.unwrap();
    let text = fs::read_to_string(file).unwrap();
    let points = cl_points(&text, check.scale, check.with.contains("--msys apply"));
    let blocks = nc_blocks(&done.out, check.letters);
    let (mount, tool) = (V::from(check.mount), check.tool);
    let value = |key: &str| summary[key]["value"].as_f64().unwrap();
    let (tip, turn) = (value("tip_deviation_mm"), value("axis_deviation_deg"));
    assert!(tip <= summary["tolerance_mm"].as_f64().unwrap(), "{name}");
    let rapid = [value("rapid_deviation_mm") + 1e-6, f64::INFINITY];
    // The words' last decimal, and what is taken for the axis between two looks.
    let cut = [tip + 1e-6, turn + 1e-3];
    let mut tips = Vec::new();
    let mut ends = Vec::new();
    let (mut leg, mut least) = (0, 0.0);
    let mut last = blocks[0];
    let mut worst: f64 = 0.0;
    let nearby = |point: V, tips: &[V], window: usize| {
        let first = tips.len().saturating_sub(window);
        tips[first..]
            .windows(2)
            .map(|pair| beside(point, pair[0], pair[1]))
            .fold(f64::INFINITY, f64::min)
    };
    let mut passed = Vec::new();
    for (number, block) in blocks.iter().enumerate() {
        for sample in 0..=SAMPLES {
            let t = f64::from(sample) / f64::from(SAMPLES);
            let words = std::array::from_fn(|word| {
                last.words[word] + (block.words[word] - last.words[word]) * t
            });
            let pose = (check.forward)(words, mount, tool);
            tips.push(pose.tip);
            let bound = if block.rapid { rapid } else { cut };
            let found = (leg..(leg + 400).min(points.len() - 1)).find_map(|at| {
                let least = if at == leg { least } else { 0.0 };
                let t = first_within(&pose, &points[at], &points[at + 1], least, bound)?;
                Some((at, t))
            });
            let Some((at, t)) = found else {
                // Ahead of a retract a head that leans draws the tool back along its own axis.
                let stood = (check.forward)(last.words, mount, tool);
                if block.rapid && beside(pose.tip, stood.tip, stood.tip + stood.axis * 101.0) < 0.5
                {
                    break;
                }
                panic!("{name}: block {number} at {t} is off the path behind point {leg}");
            };
            passed.extend((leg..at).map(|index| (index + 1, tips.len())));
            (leg, least) = (at, t);
        }
        ends.push((block.words, tips.len()));
        last = *block;
    }
    assert!(leg + 2 >= points.len(), "{name}: {leg} of {}", points.len());
    // The chords of the samples stray from the blocks by a four hundredth of what those bow.
    for (index, at) in passed {
        let until = (at + 4).min(tips.len());
        let off = nearby(points[index].tip, &tips[..until], 40 * SAMPLES as usize);
        worst = worst.max(off);
        // A rapid ends beside its point by the words' rounding, which is not in what is certified of cuts.
        assert!(off <= (tip * 1.02).max(0.0009) + 1e-4, "{name}: point {index} is missed by {off}");
        let Some(next) = points.get(index + 1) else {
            continue;
        };
        let ways = [points[index].tip - points[index - 1].tip, next.tip - points[index].tip];
        if ways.iter().any(|way| way.norm() < 0.01) || angle(ways[0], ways[1]) < 10.5 {
            continue;
        }
        let met = ends
            .iter()
            .skip(ends.partition_point(|(_, end)| end + 40 * (SAMPLES as usize) < at))
            .take_while(|(_, end)| *end <= at + 3 * SAMPLES as usize)
            .map(|(words, _)| ((check.forward)(*words, mount, tool).tip - points[index].tip).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(met < 0.0012, "{name}: corner {index} is missed by {met}");
    }
    eprintln!(
        "{name}: {} points, {} blocks, certified {tip}, CL points within {worst}",
        points.len(),
        blocks.len()
    );
}

#[test]
fn reduced_programs_are_read_back() {
    let mut files = vec![(
        root().join(sample("blade.cls")),
        Check {
            mount: [3.0, -4.0, 5.0],
            ..check("blade.cls", "ac-trunnion", "--tcp post --mount 3,-4,5", "XYZAC", ac_trunnion)
        },
    )];
    if let Some(data) = shared("data/cl") {
        const CREO: &str = "creo5x_4r19415_finition.ncl";
        files.push((
            data.join(CREO),
            Check {
                mount: [-140.0, 21.0, -40.0],
                ..check(
                    CREO,
                    "ac-trunnion",
                    "--tcp post --units mm --mount -140,21,-40",
                    "XYZAC",
                    ac_trunnion,
                )
            },
        ));
        files.push((
            data.join(CREO),
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
        ));
        files.push((
            data.join("own_ncl_form.as"),
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
        ));
        files.push((
            data.join("nx_HumMan_ust_a2.cls"),
            check(
                "nx_HumMan_ust_a2.cls",
                "head-head-360",
                "--tcp post --set control.retract.Z=9000",
                "XYZAC",
                head_head,
            ),
        ));
    }
    for (file, case) in files {
        for placement in ["placement=bisect", "placement=fewest", "method=compensate"] {
            let with: &'static str =
                format!("{} --set accuracy.reduce=true --set accuracy.{placement}", case.with)
                    .leak();
            read_loosely(&file, &Check { with, ..case });
        }
    }
}

/// Arcs of NX go clockwise about their axis. Made the other way round they would be the outer three quarters of
/// their circles, and the axes would travel beyond the points of the file by up to a diameter.
#[test]
fn arcs_of_nx_stay_among_the_points_of_the_file() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    for (file, machine, arguments) in [
        ("nx_HumMan_cutcom.clsf", "vmc", "--set control.compensation_on_centre=wear"),
        ("nx_HumMan__3_PAZ_125_N2.cls", "head-head", "--tool 1"),
    ] {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        let points: Vec<Vec<f64>> = text
            .lines()
            .filter_map(|line| line.trim().strip_prefix("GOTO/"))
            .map(|rest| {
                rest.split(',').take(2).map(|number| number.trim().parse().unwrap()).collect()
            })
            .collect();
        let (done, summary) = post(&folder.join(file), machine, arguments);
        let summary = summary.unwrap_or_else(|| panic!("{file}: {}", done.err));
        for (coordinate, name) in ["X", "Y"].into_iter().enumerate() {
            let axis = summary["axes"]
                .as_array()
                .unwrap()
                .iter()
                .find(|axis| axis["name"] == name)
                .unwrap();
            let span = axis["max"].as_f64().unwrap() - axis["min"].as_f64().unwrap();
            let values = points.iter().map(|point| point[coordinate]);
            let least = values.clone().fold(f64::INFINITY, f64::min);
            let most = values.fold(f64::NEG_INFINITY, f64::max);
            // A quarter of an arc may bulge beyond the points by a little.
            assert!(
                span < (most - least) * 1.02 + 1.0,
                "{file} {name}: {span} for {}",
                most - least
            );
        }
    }
}
