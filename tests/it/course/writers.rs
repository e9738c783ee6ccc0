//! Files in the forms of Autodesk's APT posts, CATIA and SolidWorks CAM: their arcs held against the circle, their holes
//! against the heights that they state.

use super::*;

/// Both readings of a file that nobody refuses, which agree.
fn both(text: &str, how: &How) -> Vec<Beat> {
    let (theirs, refused) = posted(text.as_bytes(), how);
    let (ours, faults) = course(text.as_bytes(), how);
    assert_eq!((refused, faults), (vec![], vec![]), "{text}");
    assert_eq!(difference(&ours, &theirs), None, "{text}");
    theirs
}

/// What both readings refuse it for.
fn refused(text: &str, how: &How) -> [String; 2] {
    [posted(text.as_bytes(), how).1, course(text.as_bytes(), how).1].map(|faults| {
        assert!(!faults.is_empty(), "{text}");
        faults.join("; ")
    })
}

/// Places on the way to the point that ends on `line`.
fn through(beats: &[Beat], line: u64) -> Vec<Vector3<f64>> {
    let end = beats
        .iter()
        .position(|beat| matches!(beat, Beat::To { line: at, .. } if *at == line))
        .unwrap();
    match &beats[end - 1] {
        Beat::Through(points) => points.clone(),
        other => panic!("line {line}: {other:?}"),
    }
}

/// The points lie on a circle about `centre` across `axis`, and the one in the middle at `middle`.
fn on_circle(
    points: &[Vector3<f64>],
    centre: [f64; 3],
    axis: usize,
    radius: f64,
    middle: [f64; 3],
) {
    for point in points {
        let mut arm = point - Vector3::from(centre);
        arm[axis] = 0.0;
        assert!((arm.norm() - radius).abs() < 1e-9, "{point} {centre:?}");
    }
    let found = points[points.len() / 2];
    assert!((found - Vector3::from(middle)).norm() < 1e-9, "{found} {middle:?}");
}

fn sample(name: &str) -> String {
    fs::read_to_string(repository().join("tests/samples").join(name)).unwrap()
}

/// The line, counted from 1, of the first record after the one that begins so.
fn behind(text: &str, record: &str) -> u64 {
    text.lines().position(|line| line.starts_with(record)).unwrap() as u64 + 2
}

const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn autodesks_arcs_are_circles() {
    let text = sample("lever.apt");
    let beats = both(&text, &How::default());
    for (record, centre, radius, middle) in [
        ("MOVARC/0, 0, 0,", [0.0, 0.0, 0.0], 20.0, [20.0 * HALF, 20.0 * HALF, 0.0]),
        ("MOVARC/-30,", [-30.0, 30.0, 0.0], 10.0, [-30.0 - 10.0 * HALF, 30.0 - 10.0 * HALF, 0.0]),
        // A half turn: an arc before it has shown that axes are turned over.
        ("MOVARC/-50,", [-50.0, 30.0, 0.0], 10.0, [-50.0, 40.0, 0.0]),
        // A helix over three quarters.
        (
            "MOVARC/-60,",
            [-60.0, -15.0, 0.0],
            15.0,
            [-60.0 - 15.0 * HALF, -15.0 - 15.0 * HALF, -1.5],
        ),
    ] {
        on_circle(&through(&beats, behind(&text, record)), centre, 2, radius, middle);
    }
    // ON stops the spindle.
    let said: Vec<&str> = beats
        .iter()
        .filter_map(|beat| match beat {
            Beat::Said(said) if said.starts_with("spindle") || said.starts_with("tool") => {
                Some(said.as_str())
            }
            _ => None,
        })
        .collect();
    assert_eq!(
        said,
        [
            "tool 1 \"\"",
            "spindle 6000.000000 left false",
            "spindle off",
            "tool 2 \"\"",
            "spindle 2500.000000 left false",
            "spindle off"
        ]
    );
}

/// The points of a cycle are bottoms: 12 mm deep from Z0, the feed begins at Z3, and between the holes the tool is at Z15.
#[test]
fn autodesks_cycles_count_from_the_bottom() {
    let text = sample("lever.apt");
    let beats = both(&text, &How::default());
    let line = behind(&text, "CYCLE/DEEP") + 1;
    let heights: Vec<(bool, f64)> = beats
        .iter()
        .filter_map(|beat| match beat {
            Beat::To { line: at, rapid, tip, .. } if *at == line => Some((*rapid, tip.z)),
            _ => None,
        })
        .collect();
    assert_eq!(heights, [(true, 15.0), (true, 3.0), (false, -12.0), (true, 15.0)]);
    // A plane below the stock, a leaning tool.
    for wrong in [
        text.replace("150, 15, RAPTO, 12", "150, -1, RAPTO, 12"),
        text.replace("150, 15, RAPTO, 12", "150, 15, RAPTO, 16"),
        text.replace("GOTO/10, 10, -12", "GOTO/10, 10, -12, 0, 0.6, 0.8"),
    ] {
        refused(&wrong, &How::default());
    }
}

#[test]
fn catias_arcs_are_circles() {
    let text = sample("link.aptsource");
    let beats = both(&text, &How::default());
    let ends: Vec<u64> = text
        .lines()
        .zip(1..)
        .filter(|(line, _)| line.starts_with("TLON"))
        .map(|(_, at)| at)
        .collect();
    let of = |place: usize| through(&beats, ends[place]);
    // Three quarters against the clock, a half turn with it, and one across Y.
    on_circle(&of(0), [0.0; 3], 2, 20.0, [-20.0 * HALF, 20.0 * HALF, 0.0]);
    on_circle(&of(1), [-10.0, -40.0, 0.0], 2, 10.0, [-10.0, -50.0, 0.0]);
    on_circle(&of(2), [-30.0, -40.0, 10.0], 1, 10.0, [-30.0, -40.0, 20.0]);
    // TOOLNO describes, LOADTL loads: one tool, by the name of TPRINT.
    let tools = beats
        .iter()
        .filter(|beat| matches!(beat, Beat::Said(said) if said == "tool 1 \"T1 End Mill D 10\""));
    assert_eq!(tools.count(), 1);
    for (from, to, why) in [
        (
            "INDIRV/    0.00000,    1.00000,    0.00000",
            "INDIRV/    1.00000,    0.00000,    0.00000",
            "INDIRV",
        ),
        ("INDIRV/    0.00000,    1.00000,    0.00000", "RAPID", "sets out"),
        (
            "\n    0.00000,  -20.00000,    0.00000)",
            "\n    0.00000,  -21.00000,    0.00000)",
            "radius",
        ),
        ("),ON,(LINE/", "),ON,2,INTOF,(LINE/", "TLON"),
        ("TLON,GOFWD", "TLON,GOLFT", "TLON"),
        (
            "(VECTOR/    0.00000,    1.00000,    0.00000))\n",
            "(VECTOR/    0.00000,    0.00000,    1.00000))\n",
            "plane",
        ),
        ("12.0000,MMPM,  200.0000,    3.0000", "12.0000,  200.0000,    3.0000", "height"),
    ] {
        let wrong = text.replacen(from, to, 1);
        assert_ne!(wrong, text, "{from}");
        for told in refused(&wrong, &How::default()) {
            assert!(told.contains(why), "{to}: {told}");
        }
    }
}

/// A file with one arc from X10 to `end` about the origin.
fn arc(before: &str, arc: &str, end: &str) -> String {
    format!("UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nGOTO/10,0,0\n{before}{arc}\nGOTO/{end}\nFINI\n")
}

/// The numbers of an arc agree, or it is refused; a half turn and a whole one go right-handed about their axis only where an
/// arc before them has shown that axes are turned over, or the user says so.
#[test]
fn an_arc_by_its_angle_says_its_way_or_is_refused() {
    let how = How::default();
    let allowed = How { allowed: vec!["MOVARC".to_owned()], ..How::default() };
    for (axis, degrees, end, middle) in [
        ("0,0,1", "90", "0,10,0", [10.0 * HALF, 10.0 * HALF, 0.0]),
        ("0,0,-1", "270", "0,10,0", [-10.0 * HALF, -10.0 * HALF, 0.0]),
        // The axis of the plane, in older posts: the angle tells.
        ("0,0,1", "270", "0,10,0", [-10.0 * HALF, -10.0 * HALF, 0.0]),
        ("0,0,1", "450", "0,10,0", [-10.0 * HALF, -10.0 * HALF, 0.0]),
        (
            "0,0,1",
            "179",
            "-9.99848,0.17452,0",
            [10.0 * libm::cos(89.5_f64.to_radians()), 10.0 * libm::sin(89.5_f64.to_radians()), 0.0],
        ),
    ] {
        let text = arc("", &format!("MOVARC/0,0,0,{axis},10,ANGLE,{degrees}"), end);
        let points = through(&both(&text, &how), 6);
        let found = points[points.len() / 2];
        assert!((found - Vector3::from(middle)).norm() < 1e-3, "{axis} {degrees}: {found}");
    }
    let over = "MOVARC/0,0,0,0,0,-1,10,ANGLE,90\nGOTO/0,-10,0\nMOVARC/0,0,0,0,0,1,10,ANGLE,90\nGOTO/10,0,0\n";
    for (degrees, end) in [("180", "-10,0,0"), ("360", "10,0,0")] {
        let round = format!("MOVARC/0,0,0,0,0,1,10,ANGLE,{degrees}");
        for told in refused(&arc("", &round, end), &how) {
            assert!(told.contains("either way") || told.contains("both ways"), "{told}");
        }
        both(&arc("", &round, end), &allowed);
        both(&arc(over, &round, end), &how);
        // One that goes against its axis shows the contrary.
        let older = over.replacen("0,0,-1", "0,0,1", 1);
        refused(&arc(&older, &round, end), &how);
    }
    for (round, end) in [
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,80", "0,10,0"),
        ("MOVARC/0,0,0,0,0,1,9,ANGLE,90", "0,10,0"),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,90", "0,11,0"),
        ("MOVARC/1,0,0,0,0,1,10,ANGLE,90", "0,10,0"),
        ("MOVARC/0,0,0,0,0,0,10,ANGLE,90", "0,10,0"),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,-90", "0,10,0"),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,0", "10,0,0"),
    ] {
        refused(&arc("", round, end), &how);
    }
}

/// Pecks in every form, and a cycle that goes in pecks and says none.
#[test]
fn pecks_are_read_or_the_cycle_is_refused() {
    let file = |cycle: &str| {
        format!(
            "UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nGOTO/0,0,50\nCYCLE/{cycle}\nGOTO/0,0,0\nCYCLE/OFF\nFINI\n"
        )
    };
    let pecks = |text: &str| {
        let mut interpreter = ClInterpreter::new(ReadingOptions {
            spindle: DefaultSpindle::Still,
            ..ReadingOptions::default()
        });
        let mut reader = ClReader::new(text.as_bytes());
        let mut down = Vec::new();
        while let Ok(Some(record)) = reader.next_record() {
            interpreter.record(&record, &mut |step| {
                if let ProgramStep::Cycle(step) = step {
                    step.cycle.legs(&mut |leg| {
                        if let CycleLeg::Feed(height) = leg {
                            down.push(height);
                        }
                    });
                }
            });
        }
        down
    };
    for form in [
        "DEEP2,FEDTO,12,1STPECK,5,SUBPECK,4,MMPM,100,RAPTO,2",
        "DEEP,DEPTH,12,STEP,5,4,MMPM,100,CLEAR,2",
        "DRILL,G98,12,PECKING,5,4,MMPM,100,2",
        "CHIP,FEDTO,12,MMPM,100,RAPTO,2,SUBPECK,4,1STPECK,5",
    ] {
        let text = file(form);
        both(&text, &How::default());
        assert_eq!(pecks(&text), [-5.0, -9.0, -12.0], "{form}");
    }
    assert_eq!(pecks(&file("DEEP,12,INCR,5,MMPM,100,2")), [-5.0, -10.0, -12.0]);
    for kind in ["DEEP", "DEEP2", "DEEPHL", "BRKCHP", "CHIP"] {
        let text = file(&format!("DRILL,{kind},FEDTO,12,MMPM,100,RAPTO,2"));
        for told in refused(&text, &How::default()) {
            assert!(told.contains("without a peck"), "{told}");
        }
        let how = How { allowed: vec![kind.to_owned()], ..How::default() };
        both(&text, &how);
    }
    // Creo's form by position: no number says which it is.
    for told in refused(&file("DRILL,-12,100,MMPM,2"), &How::default()) {
        assert!(told.contains("height"), "{told}");
    }
}
