//! `papers plan`: feeds along curves, against numbers that are known apart from them, and what is refused.

use std::fs;
use std::path::Path;

use post_testkit::shared;
use serde_json::{Value, json};

use crate::common::{self, Run, assert_contains, names, papers, read_json, with_file};

/// Plans, and reads what was written as JSON; must succeed.
fn planned(curve: &Path, with: &[&str]) -> (Run, Value) {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("plan.json");
    let mut arguments = vec!["plan", curve.to_str().unwrap(), "-o", target.to_str().unwrap()];
    arguments.extend(with);
    let run = papers(&arguments);
    assert_eq!(run.code, 0, "{}", run.err);
    (run, read_json(&target))
}

fn curve(name: &str) -> std::path::PathBuf {
    common::root().join("papers/samples").join(name)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn limit<'a>(found: &'a Value, name: &str) -> &'a Value {
    let limits = found["limits"].as_array().unwrap();
    limits.iter().find(|limit| limit["limit"] == name).unwrap()
}

/// No limit that the solver keeps is passed anywhere between samples.
fn check_kept(found: &Value) {
    for limit in found["limits"].as_array().unwrap() {
        if limit["kept"] == true {
            let share = number(&limit["largest_share"]);
            assert!(share <= 1.0 + 1e-9, "{limit}");
        }
    }
}

const PAPER: [&str; 4] = ["-m", "papers/samples/feedrate.toml", "--feed", "3000"];

/// The case set of the paper on the published butterfly: about 10.8 s and 41 µm without its contour limit, 11.7 s and 20
/// µm with it.
#[test]
fn the_butterfly_keeps_the_papers_limits_with_and_without_its_contour_error() {
    let Some(butterfly) = shared("data/geometry/butterfly_nurbs.json") else {
        return;
    };
    let mut with = PAPER.to_vec();
    let (_, kept) = planned(&butterfly, &with);
    with.extend(["--contour-error", "off"]);
    let (_, free) = planned(&butterfly, &with);
    for found in [&kept, &free] {
        check_kept(found);
        assert!((number(&found["length_mm"]) - 382.859_558).abs() < 1e-3);
        assert!(number(&found["spline_slower"]) < 1e-3, "{}", found["spline_slower"]);
    }
    let error = |found: &Value| number(&limit(found, "contour error")["largest"]);
    assert!((number(&free["seconds"]) - 10.81).abs() < 0.02, "{}", free["seconds"]);
    assert!((error(&free) - 40.6).abs() < 0.3, "{}", error(&free));
    assert!((number(&kept["seconds"]) - 11.7).abs() < 0.02, "{}", kept["seconds"]);
    assert!((error(&kept) - 20.0).abs() < 0.05, "{}", error(&kept));
}

/// As its file stands: velocity and acceleration alone have the published lower bound, jerk takes longer.
#[test]
fn the_published_five_axis_path_is_read_as_it_stands() {
    let Some(dual) = shared("data/geometry/dual_bspline_jcde2022.json") else {
        return;
    };
    let (run, fast) = planned(&dual, &["--chord-error", "off", "--samples", "2000"]);
    assert!((number(&fast["seconds"]) - 7.126).abs() < 0.01, "{}", fast["seconds"]);
    assert_eq!(fast["axes"], json!(["X", "Y", "Z", "A", "C"]));
    assert_contains(&run.out, &["not kept by this solver"]);
    let (_, slow) = planned(&dual, &["--solver", "jerk", "--samples", "2000"]);
    assert!((number(&slow["seconds"]) - 8.075).abs() < 0.01, "{}", slow["seconds"]);
    assert_eq!(limit(&slow, "jerk of C")["kept"], true);
    for found in [&fast, &slow] {
        check_kept(found);
        assert!((number(&found["length_mm"]) - 98.1682).abs() < 1e-3);
    }
}

/// B-spline of degree 2 by the recursion of Cox and de Boor, as anyone would write it.
fn basis(knots: &[f64], index: usize, degree: usize, at: f64) -> f64 {
    if degree == 0 {
        let inside = knots[index] <= at && at < knots[index + 1];
        return if inside { 1.0 } else { 0.0 };
    }
    let share = |low: f64, high: f64| {
        if high > low { (at - low) / (high - low) } else { 0.0 }
    };
    let left = share(knots[index], knots[index + degree]);
    let width = knots[index + degree + 1] - knots[index + 1];
    let right = if width > 0.0 { (knots[index + degree + 1] - at) / width } else { 0.0 };
    left * basis(knots, index, degree - 1, at) + right * basis(knots, index + 1, degree - 1, at)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// The coefficients that are written give the feeds of the rows, and keep every limit on a line whose derivatives need no
/// code of ours.
#[test]
fn the_feed_spline_is_what_its_coefficients_say_and_keeps_the_limits() {
    let line = json!({
        "degree": 1, "knots": [0, 0, 1, 1], "control_points_mm": [[0, 0, 0], [60, 80, 0]],
        "limits": { "tip": { "v": 90 }, "XY": { "v": 100, "a": 400, "j": 4000 } }
    });
    let folder = with_file("line.json", &line.to_string());
    for solver in ["reach", "interior", "jerk"] {
        let with = ["--solver", solver, "--samples", "400"];
        let (_, found) = planned(&folder.path().join("line.json"), &with);
        check_kept(&found);
        let spline = &found["feed_splines"][0];
        let (knots, coefficients) = (numbers(&spline["knots"]), numbers(&spline["coefficients"]));
        assert_eq!(knots.len(), coefficients.len() + 3);
        let q = |at: f64| -> f64 {
            let each = coefficients.iter().enumerate();
            each.map(|(index, value)| value * basis(&knots, index, 2, at)).sum()
        };
        let jerk = solver == "jerk";
        let [first, last] = match jerk {
            true => [knots[3], knots[knots.len() - 4]],
            false => [0.0, 1.0],
        };
        let rows = found["rows"].as_array().unwrap();
        for row in rows {
            let at = number(&row["parameter"]);
            if at > first && at < last {
                // 100 mm a unit of the parameter.
                let feed = 6000.0 * q(at).sqrt();
                assert!((feed - number(&row["feed_mm_min"])).abs() < 1e-3, "{solver} {at}: {feed}");
            }
        }
        // Y goes 80 mm a unit: a dense check of velocity, acceleration and jerk by differences of the coefficients' q.
        let h = 1e-5;
        for step in 1..4000 {
            let at = first + (last - first) * f64::from(step) / 4000.0;
            if at - h <= first || at + h >= last {
                continue;
            }
            let (here, slope) = (q(at), (q(at + h) - q(at - h)) / (2.0 * h));
            assert!(100.0 * here.sqrt() <= 90.0 * (1.0 + 1e-9), "{solver} {at}");
            assert!((80.0 * 0.5 * slope).abs() <= 400.0 * (1.0 + 1e-5), "{solver} {at}");
            if jerk {
                let bend = (q(at + h) - 2.0 * here + q(at - h)) / (h * h);
                let value = 80.0 * 0.5 * bend * here.sqrt();
                assert!(value.abs() <= 4000.0 * 1.001, "{at}: {value}");
            }
        }
    }
    // Constant acceleration of 500 mm/s² along the line to 90 mm/s and back: 100 mm.
    let (_, found) = planned(&folder.path().join("line.json"), &[]);
    let seconds = 0.18 + 100.0 / 90.0;
    assert!((number(&found["seconds"]) / seconds - 1.0).abs() < 1e-3, "{}", found["seconds"]);
}

/// Along a line every limit is monotone: both solvers agree in every feed. On a curve the largest Σ f² is told.
#[test]
fn solvers_are_held_against_one_another() {
    let line = json!({
        "degree": 1, "knots": [0, 0, 1, 1], "control_points_mm": [[0, 0], [60, 80]],
        "limits": { "tip": { "v": 90 }, "XY": { "v": 100, "a": 400 } }
    });
    let folder = with_file("line.json", &line.to_string());
    let (run, found) =
        planned(&folder.path().join("line.json"), &["--solver", "interior", "--samples", "300"]);
    assert_eq!(found["monotone"], true);
    assert_contains(
        &run.out,
        &["Every limit is monotone, and both agree in every feed within 1e-6"],
    );
    let (run, found) =
        planned(&curve("wings.json"), &["--solver", "interior", "--samples", "1500"]);
    assert_eq!(found["monotone"], false);
    assert_contains(&run.out, &["interior", "reach", "Not every limit is monotone"]);
    let solvers = found["solvers"].as_array().unwrap();
    let sum = |place: usize| number(&solvers[place]["sum_of_squared_feeds"]);
    assert!(sum(1) <= sum(0) * (1.0 + 1e-9));
    let gap = number(&solvers[0]["proven_gap"]);
    assert!(gap.abs() < 1e-6, "{gap}");
}

/// Of a polyline whose control needs 50 ms for each block: no more than 20 blocks a second, and the limit is told.
#[test]
fn the_time_of_the_control_for_a_block_is_kept() {
    let points: Vec<[f64; 3]> = (0..=200).map(|index| [0.5 * f64::from(index), 0.0, 0.0]).collect();
    let curve = json!({ "points_mm": points });
    let folder = with_file("line.json", &curve.to_string());
    let curve = folder.path().join("line.json");
    let with = ["-m", "papers/samples/feedrate.toml", "--feed", "3000", "--contour-error", "off"];
    let (_, free) = planned(&curve, &with);
    assert!((number(&limit(&free, "feed")["largest"]) - 3000.0).abs() < 1.0);
    let block_time = ["--set", "motion.block_time=0.05"];
    let (_, kept) = planned(&curve, &[&with[..], &block_time].concat());
    check_kept(&kept);
    // Half a millimetre in 50 ms.
    assert!((number(&limit(&kept, "feed")["largest"]) - 600.0).abs() < 1.0);
    assert!((number(&limit(&kept, "blocks")["largest_share"]) - 1.0).abs() < 1e-3);
}

#[test]
fn our_curves_keep_their_contour_error_in_the_formula_and_the_simulation_is_told_beside() {
    for (name, length) in [("wings.json", 248.63), ("bird.json", 793.0)] {
        let (_, free) = planned(&curve(name), &["--contour-error", "off"]);
        assert!(number(&limit(&free, "contour error")["largest"]) > 40.0);
        let (run, kept) = planned(&curve(name), &["--simulate"]);
        check_kept(&kept);
        assert!((number(&kept["length_mm"]) - length).abs() < 0.5, "{}", kept["length_mm"]);
        assert!(number(&limit(&kept, "contour error")["largest"]) > 19.9);
        let simulated = &kept["simulated"];
        let (real, formula) =
            (number(&simulated["largest"]), number(&simulated["formula_largest"]));
        assert!(real > 0.9 * formula && real < 2.0 * formula, "{name}: {real} {formula}");
        assert_contains(
            &run.out,
            &["above the formula at", "the formula is one of the steady state"],
        );
    }
}

#[test]
fn points_are_planned_along_a_smooth_curve_that_stops_at_corners() {
    let (run, found) = planned(&curve("points.json"), &[]);
    check_kept(&found);
    assert_contains(&run.out, &["stops", "where direction or curvature jumps"]);
    assert_eq!(found["stops"].as_array().unwrap().len(), 1);
    assert_eq!(found["feed_splines"].as_array().unwrap().len(), 2);
}

#[test]
fn a_plan_is_told_in_tables() {
    let run = papers(&["plan", "papers/samples/wings.json", "--simulate"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    insta::with_settings!({ snapshot_path => "../snapshots/plan" }, {
        insta::assert_snapshot!("wings", run.out);
    });
}

#[test]
fn pictures_and_plan_lie_in_their_folder_and_the_table_has_all_columns() {
    let folder = tempfile::tempdir().unwrap();
    let pictures = folder.path().join("pictures");
    let table = folder.path().join("plan.csv");
    let run = papers(&[
        "plan",
        "papers/samples/wings.json",
        "--samples",
        "2000",
        "--pictures",
        pictures.to_str().unwrap(),
        "-o",
        table.to_str().unwrap(),
        "-q",
    ]);
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    assert_eq!(
        names(&pictures),
        [
            "axis-acceleration.svg",
            "axis-jerk.svg",
            "axis-velocity.svg",
            "chord-error.svg",
            "contour-error.svg",
            "feed.svg",
            "plan.json"
        ]
    );
    let picture = fs::read_to_string(pictures.join("contour-error.svg")).unwrap();
    assert_contains(&picture, &["µm", "limit", "wings"]);
    let table = fs::read_to_string(table).unwrap();
    let mut lines = table.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(
        head[..9],
        ["parameter", "way_mm", "time_s", "tip_x", "tip_y", "tip_z", "feed_mm_min", "X", "Y"]
    );
    assert!(lines.all(|line| line.split(',').count() == head.len()));
    assert!(table.lines().count() > 2000);
}

#[test]
fn what_is_wrong_with_a_curve_file_is_told_with_its_line() {
    let good = "{\n \"degree\": 1,\n \"knots\": [0, 0, 1, 1],\n \"control_points_mm\": [[0, 0], [60, 80]],\n \"limits\": {\n  \"XY\": {\"v\": 100, \"a\": 400}\n }\n}\n";
    assert_eq!(planned_text(good, &[]).code, 0, "{}", planned_text(good, &[]).err);
    for (old, new, line, parts) in [
        ("\"degree\"", "\"degre\"", 2, &["unknown field `degre`"][..]),
        ("[0, 0, 1, 1]", "[0, 0, 1]", 3, &["there are 3 knots", "need 4"]),
        ("[0, 0, 1, 1]", "[0, 1, 0, 1]", 3, &["knot 2 does not follow", "never fall"]),
        ("[60, 80]", "[60, 8e9]", 4, &["8000000000", "the unit is mm"]),
        ("[60, 80]", "[60, 80, 1]", 4, &["a point of 3 coordinates", "all of them two"]),
        ("\"v\": 100", "\"v\": -1", 6, &["v is -1", "above zero"]),
        ("\"v\": 100", "\"v\": 100, \"q\": 1", 6, &["q is no limit", "v, a and j"]),
        ("\"XY\"", "\"XQ\"", 6, &["limits of XQ are not known", "axes by their names"]),
        (
            "{\"v\": 100, \"a\": 400}",
            "{\"v\": 100, \"unit\": \"deg\"}",
            6,
            &["deg is no unit", "linear axes have mm"],
        ),
        ("[0, 0], [60", "[0, 0] [60", 4, &["expected"]),
    ] {
        assert!(good.contains(old), "{old}");
        let done = planned_text(&good.replace(old, new), &[]);
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{new}\n{}", done.err);
        assert_contains(&done.err, parts);
        assert_contains(&done.err, &[&format!("standard input:{line}"), "help: "][..1]);
    }
    for (with, parts) in [
        (&["--contour-error", "0.02"][..], &["has a servo", "--contour-error off"][..]),
        (&["--solver", "jerk"], &["no jerk is limited", "help: "]),
        (&["--simulate"], &["no servo to simulate", "help: "]),
        (
            &["--start-feed", "60000"],
            &[
                "the start is too fast",
                "axis velocity of Y",
                "at parameter 0",
                "X 0 Y 0 Z 0",
                "--start-feed",
            ],
        ),
        (&["--end-feed", "8000"], &["the end is too fast", "--end-feed"]),
    ] {
        let done = planned_text(good, with);
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{with:?}\n{}", done.err);
        assert_contains(&done.err, parts);
    }
    let free = good.replace("{\"v\": 100, \"a\": 400}", "{}");
    let done = planned_text(&free, &[]);
    assert_eq!(done.code, 1);
    assert_contains(&done.err, &["no limit bounds the feed", "--feed"]);
}

fn planned_text(text: &str, with: &[&str]) -> Run {
    let mut arguments = vec!["plan", "-"];
    arguments.extend(with);
    common::run(common::command().args(&arguments), text.as_bytes())
}
