//! Programs that a dialect writes, read back by its own vocabulary and held against their CL files.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use post_host::{GivenValue, Plugin};
use post_job::library::{
    LoadedMachine, MachineSelection, NamedOption, Refusal, SettingValue, StopSignal,
};
use post_kit::conformance::Case;
use post_machine::diagnostic::Severity;

/// A program that every control of its kind can run.
struct Trial {
    /// What it shows.
    name: &'static str,
    /// A machine that is built in.
    machine: &'static str,
    /// The CL file.
    file: &'static str,
    /// What is set over the machine's file.
    set: &'static [&'static str],
}

/// Two tools, cuts in all octants, an arc, holes, a wait: nothing that a plain control has no words for, and nothing that
/// looks the same with X and Y exchanged.
const UPRIGHT: &str = "PARTNO/TRIAL\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nCOOLNT/ON\nRAPID\nGOTO/-31,8,50\n\
    RAPID\nGOTO/-31,8,5\nFEDRAT/200,MMPM\nGOTO/-31,8,-1.5\nFEDRAT/600,MMPM\nGOTO/27.25,-14.125,-1.5\nGOTO/27.25,11,-2\n\
    INDIRV/0,1,0\nTLON,GOFWD/(CIRCLE/17.25,11,-2,10),ON,(LINE/17.25,11,-2,17.25,21,-2)\nDELAY/0.5\nRAPID\nGOTO/17.25,21,50\n\
    LOADTL/2\nSPINDL/RPM,1500,CLW\nRAPID\nGOTO/5,40,50\nCYCLE/DRILL,DEPTH,7,CLEAR,2,MMPM,150\nGOTO/5,40,0\nGOTO/-12,33,0\n\
    CYCLE/OFF\nRAPID\nGOTO/-12,33,50\nEND\nFINI\n";

const BLADE: &str = include_str!("../../../tests/samples/blade.cls");
const WEDGE: &str = include_str!("../../../tests/samples/wedge.ncl");

const TRIALS: &[Trial] = &[
    Trial { name: "read: 3 axes", machine: "vmc", file: UPRIGHT, set: &[] },
    Trial {
        name: "read: inches",
        machine: "vmc",
        file: UPRIGHT,
        set: &["control.units=\"inch\"", "accuracy.tolerance=0.05"],
    },
    Trial {
        name: "read: positions",
        machine: "ac-trunnion",
        file: BLADE,
        set: &["control.tcp=\"post\""],
    },
    Trial {
        name: "read: TCP",
        machine: "ac-trunnion",
        file: BLADE,
        set: &["control.tcp=\"control\""],
    },
    Trial {
        name: "read: planes",
        machine: "ac-trunnion",
        file: WEDGE,
        set: &["control.tcp=\"post\"", "control.planes=true"],
    },
];

/// Posts short programs in a dialect and verifies each, as `post --verify` does. What it does not post is only said: a
/// control need not have everything.
pub(super) fn cases(plugin: &Plugin, options: &[(String, GivenValue)]) -> Vec<Case> {
    TRIALS.iter().map(|trial| case(trial, plugin, options)).collect()
}

fn case(trial: &Trial, plugin: &Plugin, options: &[(String, GivenValue)]) -> Case {
    let mut case = Case {
        name: trial.name,
        figures: None,
        wrong: Vec::new(),
        notes: Vec::new(),
        facts: Vec::new(),
    };
    match held(trial, plugin, options) {
        Ok(Held::Good { lines }) => case.facts.push(format!("{lines} lines held against their CL file")),
        Ok(Held::NotPosted(why)) => case.notes.push(format!("nothing to read back: {why}")),
        Ok(Held::Wrong(why)) => case.wrong.push(format!(
            "a program for `{}`, read back by the vocabulary of the dialect, does not do what its CL file asks for: {why}",
            trial.machine
        )),
        Err(fault) => case.notes.push(format!("nothing to read back: {fault}")),
    }
    case
}

/// What came of a trial.
enum Held {
    /// The program does what was asked for.
    Good { lines: usize },
    /// There is no program.
    NotPosted(String),
    /// It does something else, or cannot be read.
    Wrong(String),
}

/// The first error of a refusal.
fn first(refusal: &Refusal) -> String {
    let error = refusal.iter().find(|finding| finding.severity == Severity::Error);
    error.or(refusal.first()).map_or(String::new(), |finding| {
        let place = finding.place.as_ref();
        let line = place.map_or(String::new(), |place| format!("line {}: ", place.line));
        format!("{line}{}", finding.message)
    })
}

fn held(
    trial: &Trial,
    plugin: &Plugin,
    options: &[(String, GivenValue)],
) -> Result<Held, std::io::Error> {
    let folder = tempfile::tempdir()?;
    let input = folder.path().join("trial.cls");
    // A tool that is made ready is no word of every control.
    let lines = trial.file.split_inclusive('\n').filter(|line| !line.starts_with("SELECT/"));
    fs::write(&input, lines.collect::<String>())?;
    let never: StopSignal = Arc::new(|| false);
    let selection =
        MachineSelection { name: trial.machine.to_owned(), ..MachineSelection::default() };
    let told = told(trial, plugin, options);
    let made = LoadedMachine::load(&never, selection)
        .and_then(|machine| machine.post(&never, &input, None, &told, false));
    Ok(match made {
        Err(refusal) => Held::NotPosted(first(&refusal)),
        Ok(made) => match made.verify(&never) {
            Ok(_) => Held::Good { lines: made.text().split(|byte| *byte == b'\n').count() - 1 },
            Err(refusal) => Held::Wrong(first(&refusal)),
        },
    })
}

/// The options of the command that the trial is posted with.
fn told(trial: &Trial, plugin: &Plugin, options: &[(String, GivenValue)]) -> Vec<NamedOption> {
    let name = plugin.name();
    let own = options.iter().map(|(key, value)| {
        let value = match value {
            GivenValue::Flag(flag) => flag.to_string(),
            GivenValue::Integer(number) => number.to_string(),
            GivenValue::Number(number) => format!("{number:?}"),
            GivenValue::Text(text) => format!("{text:?}"),
        };
        format!("control.{name}.{key}={value}")
    });
    let set = trial.set.iter().map(|set| (*set).to_owned()).chain(own);
    let set = set.map(SettingValue::Text).collect();
    let mut told = vec![
        ("dialect".to_owned(), SettingValue::from(name)),
        ("tool_length".to_owned(), SettingValue::Number(100.0)),
        ("set".to_owned(), SettingValue::List(set)),
    ];
    let folder = plugin.path().and_then(|library| Some(library.parent()?.to_owned()));
    if let Some(folder) = folder {
        let here = PathBuf::from(".");
        let folder = if folder.as_os_str().is_empty() { here } else { folder };
        told.push(("plugins".to_owned(), SettingValue::List(vec![SettingValue::Path(folder)])));
    }
    told
}
