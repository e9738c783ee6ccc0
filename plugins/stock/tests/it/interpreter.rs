//! What LinuxCNC's own interpreter makes of arcs, helices, cycles and splines.

use std::path::Path;
use std::process::Command;

use post_kit::{Bench, jobs};
use post_plugin::{Event, Value};

fn bench() -> Bench {
    Bench::of(post_linuxcnc::plugin())
}

/// The canonical commands of a program, of one kind, with their numbers; none where LinuxCNC is not.
fn commands(program: &str, kind: &str) -> Option<Vec<Vec<f64>>> {
    let interpret =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/linuxcnc/interpret");
    if !interpret.is_file() {
        eprintln!("skipped: there is no {}", interpret.display());
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.ngc");
    std::fs::write(&file, program).unwrap();
    let mut command = Command::new(interpret);
    command.arg(file).arg("--metric");
    for tool in ["1=40,10", "2=30,5", "3=30,5", "21=40,10"] {
        command.args(["--tool", tool]);
    }
    let mut done = command.output().unwrap();
    if String::from_utf8_lossy(&done.stderr).contains("ended with -") {
        // A signal ended it: other LinuxCNC tests share its memory, and begin and end beside this one.
        done = command.output().unwrap();
    }
    let said = String::from_utf8_lossy(&done.stderr);
    if done.status.code() == Some(3) {
        eprintln!("skipped: {said}");
        return None;
    }
    assert!(done.status.success(), "{said}\n{program}");
    let text = String::from_utf8_lossy(&done.stdout);
    let found = text.lines().filter_map(|line| {
        let (_, rest) = line.split_once(&format!("{kind}("))?;
        let numbers = rest.trim_end_matches(')').split(',');
        Some(numbers.filter_map(|number| number.trim().parse().ok()).collect())
    });
    Some(found.collect())
}

#[test]
fn arcs_end_where_they_should_and_turn_the_right_way() {
    let program = bench().write_declared(&jobs::three_axes()).unwrap();
    let Some(arcs) = commands(&program, "ARC_FEED") else {
        return;
    };
    // First and second end, first and second of the centre, the sense, the end across: of X Y, then Z X, then Y Z.
    let wanted = [
        [20.0, -10.0, 10.0, -10.0, 1.0, -2.0],
        [10.0, -20.0, 10.0, -10.0, -1.0, -2.0],
        [0.0, -10.0, 10.0, -10.0, 1.0, -2.0],
        [0.0, -10.0, 5.0, -10.0, -1.0, -2.0],
        [0.0, -10.0, 5.0, -10.0, 1.0, -5.0],
        [-5.0, 10.0, -5.0, 5.0, 1.0, -10.0],
        [10.0, -5.0, 0.0, -5.0, -1.0, 10.0],
    ];
    for (arc, wanted) in arcs.iter().zip(wanted) {
        let off = arc.iter().zip(wanted).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-4, "{arc:?}, not {wanted:?}");
    }
    // The last one is led by the compensation: its radius is the tool's less.
    assert_eq!(arcs.len(), wanted.len() + 1);
    assert_eq!(arcs[7][..5], [25.0, 20.0, 20.0, 20.0, 1.0]);
}

#[test]
fn cycles_go_to_the_bottom_and_return_to_their_level() {
    let program = bench().write_declared(&jobs::three_axes()).unwrap();
    let (Some(cuts), Some(ways), Some(taps)) = (
        commands(&program, "STRAIGHT_FEED"),
        commands(&program, "STRAIGHT_TRAVERSE"),
        commands(&program, "RIGID_TAP"),
    ) else {
        return;
    };
    // Two holes of five kinds at 14.5, two of them with steps.
    let at_bottom = cuts.iter().filter(|cut| cut[2] == -14.5);
    assert_eq!(at_bottom.count(), 2 * 5);
    assert_eq!(taps, [[0.0, 0.0, -14.5], [25.0, 0.0, -14.5]]);
    let steps: Vec<f64> = cuts.iter().map(|cut| cut[2]).collect();
    let pecked = [-3.25, -6.5, -9.75, -13.0, -14.5];
    assert_eq!(steps.windows(5).filter(|five| *five == pecked).count(), 4);
    // The deepest hole of all, and every way to the next one at the level that was asked for.
    assert!(cuts.iter().any(|cut| cut[..3] == [25.0, 30.0, -17.0]));
    let level = |way: &Vec<f64>| way[0] == 25.0 && way[1] == 0.0 && way[2] == 8.0;
    assert!(ways.iter().filter(|way| level(way)).count() >= 10);
    let below = ways.iter().find(|way| way[2] < -13.0);
    assert_eq!(below, None, "no rapid goes to the bottom");
}

#[test]
fn splines_and_what_stands_between_cuts_are_read() {
    let bench = bench().with("splines", Value::Flag(true));
    let spline = bench.write_declared(&jobs::spline()).unwrap();
    let Some(curves) = commands(&spline, "NURBS_FEED") else {
        return;
    };
    assert_eq!(curves.len(), 1);
    let mut tools = jobs::tools();
    // Subprograms are files, which nobody has written.
    tools.retain(|event| !matches!(event, Event::Subprogram { .. }));
    let offsets = commands(&bench.write_declared(&tools).unwrap(), "SELECT_TOOL").unwrap();
    assert_eq!(offsets.len(), 4);
    let floating = bench.with("tapping", Value::Text("floating"));
    let program = floating.write_declared(&jobs::three_axes()).unwrap();
    assert!(program.contains("G98 G84 X0.0000"), "{program}");
    assert!(commands(&program, "RIGID_TAP").unwrap().is_empty());
}
