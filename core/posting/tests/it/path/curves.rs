//! Arcs, splines and cycles.

use super::*;

/// Points of all blocks from the first cut on, finely.
fn trace(model: &Model, run: &Run) -> Vec<Vector3<f64>> {
    let motions = run.motions();
    let mut points = Vec::new();
    for pair in motions.windows(2) {
        if pair[1].kind == "Linear" {
            points
                .extend((0..=16).map(|step| {
                    model.at(&pair[0].words, &pair[1].words, f64::from(step) / 16.0).0
                }));
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
                let points = trace(&model, &model.run(&text).good("a path"));
                let mut turned = 0.0;
                for pair in points.windows(2) {
                    let at = |point: &Vector3<f64>| libm::atan2(point.y, point.x);
                    turned += post_testmachines::turned(at(&pair[0]), at(&pair[1])).to_degrees();
                }
                for point in &points {
                    let off =
                        (libm::hypot(point.x, point.y) - 60.0).abs().max((point.z - 5.0).abs());
                    assert!(off <= 0.005 + 1e-9, "{kind} {tcp} {sense} {end_axis}: {off}");
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
        .fold(Vector3::zeros(), |sum, (index, point)| sum + point * basis(knots, index, 3, u))
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
    let traced = trace(&model, &model.run(&text).good("a path"));
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
    assert!(there <= 0.005 + 1e-5 && back <= 0.005 + 1e-5, "{there} {back}");
}

/// A cycle becomes moves along the tool axis, in the order in which it drills.
#[test]
fn cycles_are_drilled_in_order() {
    let model = model("trunnion", true, WIDE, &[]);
    let heights = |run: &Run| -> Vec<(&'static str, f64)> {
        run.asked
            .iter()
            .filter(|asked| ["Rapid", "Linear", "Dwell"].contains(&asked.kind))
            .map(|asked| (asked.kind, asked.words.get(2).copied().unwrap_or(asked.value)))
            .collect()
    };
    let text = "UNITS/MM\nRAPID\nGOTO/0,0,50\nCYCLE/DEEP,DEPTH,3.5,STEP,2.0,MMPM,50,CLEAR,1\nGOTO/10,20,0\nGOTO/30,20,0\nCYCLE/OFF\nRAPID\nGOTO/30,20,50\n";
    let run_deep = model.run(text).good("a path");
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
    let feeds: Vec<_> = run_deep.asked.iter().filter_map(|asked| asked.feed).collect();
    assert_eq!(feeds, [Feed::PerMinute(50.0); 4]);

    let text = "UNITS/MM\nRAPID\nGOTO/0,0,50\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,25,MMPM,250,DWELL,0.5\nGOTO/10,20,0\nCYCLE/OFF\n";
    let run_drill = model.run(text).good("a path");
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
    let tips = words(&model, text);
    for (words, height) in tips[1..].iter().zip([5.0, -10.0, 5.0]) {
        assert!(near(&words[..3], &[0.0, 0.6 * height, 0.8 * height]), "{tips:?}");
    }
    assert_eq!(tips.len(), 4);
}
