//! The leading edge of a knife.

use super::*;

// ---------------------------------------------------------------------------------------------------------------
// An edge that leads
// ---------------------------------------------------------------------------------------------------------------

fn knife() -> Setup {
    on("ultrasonic-knife").long(50.0)
}

/// Cuts along points at one height, the knife leaning 20° towards Y, plunged and drawn back along its axis.
fn drawn(points: &[[f64; 2]]) -> String {
    let axis = lean(20.0, 90.0);
    let tip = |point: &[f64; 2]| V::new(point[0], point[1], 20.0);
    let mut cl = cl().rapid(tip(&points[0]) + axis * 40.0, axis);
    for point in points {
        cl = cl.cut(tip(point), axis);
    }
    cl.rapid(tip(points.last().unwrap()) + axis * 40.0, axis).end()
}

/// The part of a direction across the tool axis.
fn across(direction: V, axis: V) -> V {
    (direction - axis * axis.dot(&direction)).normalize()
}

#[test]
fn the_edge_follows_the_tangent_of_a_circle() {
    let mut cl = cl();
    let at = |step: u32| f64::from(step) * 5.0;
    let foot = |azimuth: f64| {
        let (sine, cosine) = libm::sincos(azimuth.to_radians());
        V::new(100.0 * cosine, 100.0 * sine, 20.0)
    };
    cl = cl.rapid(foot(0.0) + lean(20.0, 0.0) * 40.0, lean(20.0, 0.0));
    for step in 0..=60 {
        cl = cl.cut(foot(at(step)), lean(20.0, at(step)));
    }
    let cl = cl.rapid(foot(300.0) + lean(20.0, 300.0) * 40.0, lean(20.0, 300.0)).end();
    let made = knife().made(&cl);
    let poses = made.poses();
    for step in 1..60 {
        let (sine, cosine) = libm::sincos(at(step).to_radians());
        // The tool leans along the radius, so the tangent lies across it.
        let tangent = V::new(-sine, cosine, 0.0);
        let here: Vec<&Pose> =
            poses.iter().filter(|pose| (pose.tip - foot(at(step))).norm() < ROUNDING).collect();
        assert!(!here.is_empty(), "{}", at(step));
        for pose in here {
            assert!(angle(pose.edge, tangent) < 0.2, "{}: {}", at(step), angle(pose.edge, tangent));
            assert!(angle(pose.axis, lean(20.0, at(step))) < 0.2);
        }
    }
    // Between two points it lies between the tangents there.
    for pose in &poses {
        let azimuth = libm::atan2(pose.tip.y, pose.tip.x).to_degrees();
        if pose.tip.z < 20.01 && (3.0..297.0).contains(&azimuth.rem_euclid(360.0)) {
            let (sine, cosine) = libm::sincos(azimuth.to_radians());
            assert!(angle(pose.edge, V::new(-sine, cosine, 0.0)) < 0.5, "{azimuth}");
        }
    }
}

#[test]
fn the_edge_follows_an_arc() {
    let axis = lean(20.0, 90.0);
    let text = cl()
        .rapid(V::new(-50.0, -60.0, 20.0) + axis * 40.0, axis)
        .cut(V::new(-50.0, -60.0, 20.0), axis)
        .cut(V::new(0.0, -60.0, 20.0), axis)
        .line("CIRCLE / 0, 0, 20, 0, 0, 1, 60")
        .line("GOTO / 60, 0, 20")
        .line("GOTO / 60, 50, 20")
        .end();
    let made = knife().made(&text);
    let mut met = 0;
    for pose in made.poses() {
        let radius = V::new(pose.tip.x, pose.tip.y, 0.0);
        if pose.tip.z > 20.01 {
            continue;
        }
        // Lines go on into the arc and out of it: not even beside its ends does the edge turn off them.
        if pose.tip.x < -1.0 && pose.tip.x > -49.0 {
            let off = angle(pose.edge, across(V::x(), axis));
            assert!(off < 0.2, "{}: {off}", pose.tip);
        }
        if pose.tip.x > 0.0 && pose.tip.y < 0.0 {
            assert!(near(radius.norm(), 60.0, 0.05 + ROUNDING));
            let tangent = across(V::z().cross(&radius), axis);
            assert!(angle(pose.edge, tangent) < 0.2, "{}", angle(pose.edge, tangent));
            met += 1;
        }
    }
    assert!(met > 10, "{}", made.text);
}

#[test]
fn at_a_corner_the_edge_is_turned_on_the_spot() {
    let cl = drawn(&[[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0]]);
    let made = knife().made(&cl);
    let poses = made.poses();
    let axis = lean(20.0, 90.0);
    let corner = V::new(50.0, -50.0, 20.0);
    let there: Vec<usize> =
        (0..poses.len()).filter(|at| (poses[*at].tip - corner).norm() < ROUNDING).collect();
    assert_eq!(there.len(), 2, "{}", made.text);
    let (come, go) = (there[0], there[1]);
    assert_eq!(go, come + 1);
    assert!(angle(poses[come].edge, across(V::x(), axis)) < 0.2);
    assert!(angle(poses[go].edge, across(V::y(), axis)) < 0.2);
    for (name, (a, b)) in
        made.names.iter().zip(made.blocks[come].words.iter().zip(&made.blocks[go].words))
    {
        assert_eq!(a == b, name != "A", "{name} {a} {b}");
    }
    assert!(!made.blocks[go].rapid);
}

#[test]
fn below_the_corner_the_edge_turns_along() {
    // Bends of 12°, less than the 15° of the machine file, and of 18°.
    for (bend, spots) in [(12.0, 0), (18.0, 2)] {
        let mut points = vec![[-40.0, -40.0]];
        let mut heading = 0.0f64;
        for _ in 0..3 {
            let [x, y] = *points.last().unwrap();
            let (sine, cosine) = libm::sincos(heading.to_radians());
            points.push([x + 40.0 * cosine, y + 40.0 * sine]);
            heading += bend;
        }
        let made = knife().made(&drawn(&points));
        let [x, y] = [made.place("X"), made.place("Y")];
        let on_the_spot = made
            .blocks
            .windows(2)
            .filter(|pair| !pair[1].rapid)
            .filter(|pair| [x, y].iter().all(|at| pair[0].words[*at] == pair[1].words[*at]))
            .count();
        assert_eq!(on_the_spot, spots, "{bend}:\n{}", made.text);
        if spots == 0 {
            // In the corners the edge halves the bend.
            let axis = lean(20.0, 90.0);
            for (place, point) in points.iter().enumerate().take(3).skip(1) {
                let tip = V::new(point[0], point[1], 20.0);
                let way = |from: [f64; 2], to: [f64; 2]| {
                    across(V::new(to[0] - from[0], to[1] - from[1], 0.0), axis)
                };
                let halved = way(points[place - 1], *point) + way(*point, points[place + 1]);
                let pose = made.poses().into_iter().find(|pose| (pose.tip - tip).norm() < ROUNDING);
                assert!(angle(pose.unwrap().edge, halved.normalize()) < 0.2);
            }
        }
    }
}

/// The lines of a corner that the knife is drawn out of, 20 mm.
fn rewound() -> (Made, usize) {
    let cl = drawn(&[[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0]]);
    let made = knife()
        .with("rewind.distance", "20")
        .with("rewind.retract_feed", "3000")
        .with("rewind.turn_feed", "720")
        .with("rewind.plunge_feed", "400")
        .made(&cl);
    let corner = V::new(50.0, -50.0, 20.0);
    let poses = made.poses();
    let come = poses.iter().position(|pose| (pose.tip - corner).norm() < ROUNDING);
    (made, come.unwrap())
}

#[test]
fn with_a_rewind_the_edge_is_turned_outside_the_part() {
    let (made, come) = rewound();
    let axis = lean(20.0, 90.0);
    let corner = V::new(50.0, -50.0, 20.0);
    let poses = made.poses();
    let [out, turned, back] = [come + 1, come + 2, come + 3];
    for (at, tip, edge) in [
        (come, corner, V::x()),
        (out, corner + axis * 20.0, V::x()),
        (turned, corner + axis * 20.0, V::y()),
        (back, corner, V::y()),
    ] {
        assert!((poses[at].tip - tip).norm() < ROUNDING, "{at}:\n{}", made.text);
        assert!(angle(poses[at].edge, across(edge, axis)) < 0.2, "{at}:\n{}", made.text);
    }
    let feed = |at: usize| {
        let line = made.line(&made.blocks[at]);
        line.split(' ').find(|word| word.starts_with('F')).map(str::to_owned)
    };
    assert_eq!(feed(out).as_deref(), Some("F3000."), "{}", made.text);
    assert_eq!(feed(back).as_deref(), Some("F400."), "{}", made.text);
    // The cut goes on with its own feed.
    assert_eq!(feed(back + 1).as_deref(), Some("F500."), "{}", made.text);
}

/// 90° at 720°/min take an eighth of a minute.
#[test]
fn with_a_rewind_the_edge_is_turned_at_its_feed() {
    let (made, come) = rewound();
    assert!(!made.blocks[come + 2].rapid, "{}", made.text);
    let line = made.line(&made.blocks[come + 2]);
    assert!(line.contains("F8.") || line.contains("F720."), "{line}");
}

/// Three times round: C ends at 360° on both sides, so the knife is drawn out on the way.
fn three_rounds() -> String {
    let foot = |step: u32| lean(90.0, 5.0 * f64::from(step)) * 100.0 + V::z() * 20.0;
    let axis = |step: u32| lean(20.0, 5.0 * f64::from(step));
    let mut cl = cl().rapid(foot(0) + axis(0) * 40.0, axis(0));
    for step in 0..=216 {
        cl = cl.cut(foot(step), axis(step));
    }
    cl.rapid(foot(216) + axis(216) * 40.0, axis(216)).end()
}

#[test]
fn a_knife_that_goes_round_and_round_is_drawn_out_where_an_axis_ends() {
    let text = three_rounds();
    let said = knife().refused(&text);
    for word in ["error[jump]", "takes C to 365.000° (travel -360.000° to 360.000°)"] {
        assert!(said.contains(word), "{said}");
    }
    let made = knife().with("rewind.distance", "20").made(&text);
    let poses = made.poses();
    for block in &made.blocks {
        let over = made.model.over_travel(&block.words, made.length);
        assert!(over.is_none(), "line {}: {over:?}", block.line);
    }
    let mut at = 0;
    let points = post_testruns::read_back::points(&text);
    for point in &points[2..points.len() - 2] {
        let tangent = V::z().cross(&V::new(point.tip.x, point.tip.y, 0.0)).normalize();
        let met = (at..poses.len()).find(|at| {
            (poses[*at].tip - point.tip).norm() < ROUNDING
                && angle(poses[*at].axis, point.axis) < 0.2
                && angle(poses[*at].edge, tangent) < 0.2
        });
        at = met.unwrap_or_else(|| panic!("CL line {}", point.line));
    }
    // In the part the edge never leaves the tangent; so it was turned outside.
    let mut outside = 0;
    for (block, pose) in made.blocks.iter().zip(&poses).skip(4) {
        let radius = V::new(pose.tip.x, pose.tip.y, 0.0);
        if pose.tip.z < 20.1 && !block.rapid {
            let tangent = V::z().cross(&radius).normalize();
            assert!(angle(pose.edge, tangent) < 3.0, "line {}", block.line);
        } else {
            outside += 1;
        }
    }
    assert!(outside > 4);
}

/// C turns back by 360° at least, which takes half a minute and more at 720°/min.
#[test]
fn a_rewind_turns_at_its_feed() {
    let made =
        knife().with("rewind.distance", "20").with("rewind.turn_feed", "720").made(&three_rounds());
    let c = made.words("C");
    let (mut turned, mut minutes, mut feed) = (0.0, 0.0, 0.0);
    for (at, pose) in made.poses().iter().enumerate().skip(1) {
        let line = made.line(&made.blocks[at]);
        let word = line.split(' ').find_map(|word| word.strip_prefix('F')?.parse::<f64>().ok());
        feed = word.unwrap_or(feed);
        // Drawn out, in G93.
        if !made.blocks[at].rapid && pose.tip.z > 30.0 && c[at] != c[at - 1] {
            turned += (c[at] - c[at - 1]).abs();
            minutes += 1.0 / feed;
        }
    }
    assert!(turned > 359.0, "{turned}");
    assert!(minutes > 0.98 * turned / 720.0, "{turned}° in {minutes} min");
}

/// The tip stands still in the part and the tool leans over by 20°, at 500: the feed is along the axes, so no
/// block is faster than 500°/min.
#[test]
fn a_tool_that_turns_on_the_spot_does_not_race() {
    let tip = V::new(10.0, 7.0, 20.0);
    let text =
        cl().rapid(tip + V::z() * 40.0, V::z()).cut(tip, V::z()).cut(tip, lean(20.0, -90.0)).end();
    let made = on("ac-trunnion").with("control.tcp", "post").made(&text);
    let a = made.words("A");
    let mut feed = 0.0;
    for at in 1..made.blocks.len() {
        let line = made.line(&made.blocks[at]);
        let word = line.split(' ').find_map(|word| word.strip_prefix('F')?.parse::<f64>().ok());
        feed = word.unwrap_or(feed);
        if !made.blocks[at].rapid && a[at] != a[at - 1] {
            let speed = (a[at] - a[at - 1]).abs() * feed;
            assert!(speed < 510.0, "{speed}°/min: {line}");
        }
    }
}

/// Before it goes into the part the knife is turned to where it will cut.
#[test]
fn the_edge_is_turned_before_the_plunge() {
    let made = knife().made(&drawn(&[[-50.0, -50.0], [-50.0, 50.0]]));
    let plunged = made.blocks.iter().position(|block| !block.rapid).unwrap();
    let a = made.place("A");
    let words = [&made.blocks[plunged - 1], &made.blocks[plunged]].map(|block| block.words[a]);
    assert_eq!(words[0], words[1], "{}", made.text);
}

#[test]
fn a_second_vector_of_the_points_is_the_edge() {
    let axis = lean(20.0, 90.0);
    let tip = |step: f64| V::new(30.0 * step, 10.0 * step, 20.0);
    let edge = |step: f64| {
        let (sine, cosine) = libm::sincos(f64::to_radians(25.0 * step - 40.0));
        V::new(cosine, sine, 0.0)
    };
    let mut cl = cl().line("RAPID").edge(tip(0.0) + axis * 40.0, axis, edge(0.0));
    for step in 0..6 {
        cl = cl.edge(tip(step.into()), axis, edge(step.into()));
    }
    let text = cl.end();
    let made = knife().with("solution.edge", "cl").made(&text);
    let poses = made.poses();
    for step in 0..6 {
        let step = f64::from(step);
        let there = poses.iter().filter(|pose| (pose.tip - tip(step)).norm() < ROUNDING);
        let off: Vec<f64> = there.map(|pose| angle(pose.edge, across(edge(step), axis))).collect();
        assert!(!off.is_empty() && off.iter().all(|off| *off < 0.01), "{step}: {off:?}");
    }
    // By the direction of travel the second vector counts for nothing.
    let travel = knife().made(&text);
    let along = across(V::new(3.0, 1.0, 0.0), axis);
    let pose = travel.poses().into_iter().find(|pose| (pose.tip - tip(2.0)).norm() < ROUNDING);
    assert!(angle(pose.unwrap().edge, along) < 0.2);
    // A machine without an edge takes the points and leaves the edge.
    let six: Vec<String> = text
        .lines()
        .map(|line| match line.starts_with("GOTO") {
            true => line.split(',').take(6).collect::<Vec<_>>().join(","),
            false => line.to_owned(),
        })
        .collect();
    assert_eq!(on("ac-trunnion").made(&text).text, on("ac-trunnion").made(&six.join("\n")).text);
}

/// Nothing of an edge that the CL file gives waits for the way ahead: neither do spindle, coolant and dwells.
#[test]
fn commands_stand_where_they_stood_whatever_leads_the_edge() {
    let axis = lean(20.0, 90.0);
    let tip = |x: f64| V::new(x, 0.0, 20.0);
    let text = cl()
        .rapid(tip(0.0) + axis * 40.0, axis)
        .edge(tip(0.0), axis, V::x())
        .line("COOLNT / ON")
        .edge(tip(10.0), axis, V::x())
        .line("DELAY / 2")
        .edge(tip(20.0), axis, V::x())
        .line("COOLNT / OFF")
        .edge(tip(30.0), axis, V::x())
        .end();
    let expected = ["M3", "M8", "X10.0000", "G4", "X20.0000", "M9", "X30.0000"];
    for edge in ["cl", "travel"] {
        let made = knife().with("solution.edge", edge).made(&text);
        let words = made.text.split_whitespace().filter(|word| expected.contains(word));
        assert_eq!(words.collect::<Vec<_>>(), expected, "{edge}");
    }
}

#[test]
fn an_edge_without_direction_is_refused() {
    let axis = lean(20.0, 90.0);
    let text = cl().edge(V::new(0.0, 0.0, 20.0), axis, V::zeros()).end();
    let said = knife().with("solution.edge", "cl").refused(&text);
    assert!(said.contains("error[axis]: the direction of the leading edge is null"), "{said}");
}

#[test]
fn verifying_sees_an_edge_that_does_not_go_along_the_travel() {
    let folder = crate::common::with_file("part.cls", SQUARE);
    let machine = ["-m", "tangential-knife", "--tool-length", "20", "-q"];
    let run =
        |arguments: &[&str]| crate::common::post_in(folder.path(), &[arguments, &machine].concat());
    assert_eq!(run(&["part.cls", "-o", "right.ngc", "--verify"]).code, 0);
    let right = std::fs::read_to_string(folder.path().join("right.ngc")).unwrap();
    let turns = |line: &&str| line.starts_with("G93 C");
    assert!(right.lines().filter(turns).count() >= 4, "{right}");
    let kept = right.lines().filter(|line| !turns(line)).collect::<Vec<_>>().join("\n");
    for (wrong, off) in [(kept, "90.000°"), (right.replace("C90.0000", "C84.0000"), "6.000°")] {
        std::fs::write(folder.path().join("wrong.ngc"), wrong + "\n").unwrap();
        let found = run(&["verify", "wrong.ngc", "--against", "part.cls"]);
        let message = format!("the leading edge points {off} off the direction of travel");
        assert!(found.code == 1 && found.err.contains(&message), "{}", found.err);
    }
    // A corner where the tip moves within the tolerance while the edge turns is one all the same.
    let moved = right.replacen("G93 C", "G93 X100.0030 C", 1);
    assert!(moved != right && right.contains("X100.0000"), "{right}");
    std::fs::write(folder.path().join("right.ngc"), moved).unwrap();
    let found = run(&["verify", "right.ngc", "--against", "part.cls"]);
    assert_eq!(found.code, 0, "{}", found.err);
}

/// Around a square, a corner of it cut off.
const SQUARE: &str = "UNITS/MM\nLOADTL/1\nRAPID\nGOTO/0,0,30,0,0,1\nFEDRAT/3000,MMPM\nGOTO/0,0,-1\nGOTO/100,0,-1\nGOTO/100,60,-1\nGOTO/85,85,-1\nGOTO/0,90,-1\nGOTO/0,0,-1\nRAPID\nGOTO/0,0,30\nFINI\n";
