//! What the words count from: the part origin, units, frames, the axis in force.

use super::*;

/// With tcp = "post" a word is the axis position minus that with the tip of the tool on the part origin.
#[test]
fn words_are_positions_from_the_part_origin() {
    let text = "UNITS/MM\nRAPID\nGOTO/0,0,0,0,0,1\nFEDRAT/100\nGOTO/10,20,30\n";
    for kind in ["trunnion", "head", "nutating"] {
        let words = words(&model(kind, false, WIDE, &[]), text);
        assert!(near(&words[0], &[0.0; 5]), "{kind}: {words:?}");
        assert!(near(&words[1], &[10.0, 20.0, 30.0, 0.0, 0.0]), "{kind}: {words:?}");
    }
    // The pivot lies 250 mm and the tool 120 mm over the tip; A 30 leans the tool to -Y.
    let found =
        words(&model("head", false, WIDE, &[]), "UNITS/MM\nGOTO/10,20,30,0,-0.5,0.8660254\n");
    assert!(
        near(&found[0], &[10.0, 20.0 - 185.0, 30.0 + 370.0 * (0.8660254 - 1.0), 30.0, 0.0]),
        "{found:?}"
    );
    // The part origin, (10, -20, 30) in the machine, turns by 30° about the A axis at Y 0.012, Z 50.004.
    let found =
        words(&model("trunnion", false, WIDE, &[]), "UNITS/MM\nGOTO/0,0,0,0,0.5,0.8660254\n");
    let (y, z) = (-20.0 - 0.012, 30.0 - 50.004);
    let turned = [0.8660254 * y - 0.5 * z + 0.012 + 20.0, 0.5 * y + 0.8660254 * z + 50.004 - 30.0];
    assert!(near(&found[0], &[0.0, turned[0], turned[1], -30.0, 0.0]), "{found:?} {turned:?}");
    // With tcp = "control" the linear words are the tip, whatever the machine.
    for kind in ["trunnion", "head", "nutating"] {
        let found =
            words(&model(kind, true, WIDE, &[]), "UNITS/MM\nGOTO/10,20,30,0.1,-0.5,0.8602325\n");
        assert!(near(&found[0][..3], &[10.0, 20.0, 30.0]), "{kind}: {found:?}");
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
    let source = Source { name: "v.toml".to_owned(), text: text.to_owned() };
    let Ok(machine) = load(source, &[], &mut |_| Err(String::new())) else {
        return;
    };
    let run = run(&machine, "UNITS/MM\nGOTO/1,2,3,0,0,1\n", PostingRequest::default());
    if run.report.is_some() {
        let mut linear = run.motions()[0].words[..3].to_vec();
        linear.sort_by(f64::total_cmp);
        assert_eq!(linear, [1.0, 2.0, 3.0]);
    }
}

#[test]
fn inches_in_and_inches_out() {
    let mm = model("head", false, WIDE, &[]);
    let run = mm.run("UNITS/INCHES\nFEDRAT/10,IPM\nGOTO/0,0,0\nGOTO/1,-2,0\n").good("a path");
    let last = run.asked.iter().rfind(|asked| asked.kind == "Linear").unwrap();
    assert!(near(&last.words, &[25.4, -50.8, 0.0, 0.0, 0.0]), "{last:?}");
    assert_eq!(last.feed, Some(Feed::PerMinute(254.0)));

    let inch = model("head", false, WIDE, &["control.units=inch", "accuracy.tolerance=0.05"]);
    let run = inch.run("UNITS/MM\nFEDRAT/254,MMPM\nGOTO/0,0,0\nGOTO/25.4,-50.8,0\n");
    let last = run.asked.iter().find(|asked| asked.kind == "Linear").unwrap();
    assert!(near(&last.words, &[1.0, -2.0, 0.0, 0.0, 0.0]), "{last:?}");
    assert_eq!(last.feed, Some(Feed::PerMinute(10.0)));
}

/// What no printed word can keep is refused before a record is read; half of the last decimal is what a word keeps.
#[test]
fn a_tolerance_below_the_decimals_is_refused_at_once() {
    let opened = |settings: &[&str]| {
        let machine = model("trunnion", false, WIDE, settings).machine;
        let mut dialect = posted::Recorder::new(&machine, 3);
        let (mut model, mut output) = (Samples, posted::Nowhere);
        let opened =
            Post::new(&machine, PostingRequest::default(), &mut dialect, &mut model, &mut output);
        opened.err().map(|fault| (fault.code, fault.message))
    };
    assert_eq!(opened(&["accuracy.tolerance=0.00051"]), None);
    for (settings, said) in [
        // Thousandths of an inch are too coarse for five micrometres.
        (vec!["control.units=inch"], "is 0.005 mm"),
        (vec!["accuracy.tolerance=1e-12"], "rounded by up to 0.0005 mm"),
        (vec!["accuracy.tolerance=0.00049"], "rounded by up to 0.0005 mm"),
        (vec!["accuracy.axis_tolerance=1e-6"], "axis_tolerance is 0.000001°"),
    ] {
        let (code, message) = opened(&settings).expect("a refusal");
        assert_eq!(code, "tolerance");
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn frames_are_applied_as_asked() {
    let model = model("trunnion", true, WIDE, &[]);
    // X of the frame is Y of the file, its Y is -X.
    let text = "UNITS/MM\nMSYS/10,20,30,0,1,0,-1,0,0\nGOTO/11,22,33,0.6,0,0.8\n";
    for (apply, tip, axis) in
        [(false, [11.0, 22.0, 33.0], [0.6, 0.0, 0.8]), (true, [2.0, -1.0, 3.0], [0.0, -0.6, 0.8])]
    {
        let reading = ReadingOptions { apply_msys: apply, ..ReadingOptions::default() };
        let run =
            run(&model.machine, text, PostingRequest { reading, ..PostingRequest::default() })
                .good("a path");
        let words = &run.motions()[0].words;
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
    assert!((reached.0 - Vector3::new(1.0, 3.0, -2.0)).norm() < 1e-3, "{reached:?}");
    assert!(angle(reached.1, Vector3::y()) < 2e-5, "{reached:?}");
    assert!(near(found.last().unwrap(), &[1.0, 2.0, 3.0, 0.0, 0.0]), "{found:?}");
}

/// A GOTO of three numbers keeps the tool axis.
#[test]
fn the_axis_is_modal() {
    let found = words(
        &model("trunnion", true, WIDE, &[]),
        "UNITS/MM\nMULTAX/ON\nFEDRAT/100\nGOTO/0,0,0,0,-0.5,0.8660254\nGOTO/10,0,0\nGOTO/20,0,0,0,0,1\n",
    );
    assert!(near(&found[1], &[10.0, 0.0, 0.0, 30.0, 0.0]), "{found:?}");
    assert!(near(found.last().unwrap(), &[20.0, 0.0, 0.0, 0.0, 0.0]), "{found:?}");
}
