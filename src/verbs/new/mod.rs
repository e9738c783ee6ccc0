//! `post new`: writes a machine file to start from.

mod of_library;
mod questions;
mod template;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use post_host::{Finder, OpenedDialect};
use post_machine::description::{self, Machine, OutputUnits, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Capabilities, DialectSession as _, OptionKind};

use crate::flag_words::{TcpWord, UnitsWord};
use post_cli::arguments::flag_values::{self, finite, word};
use post_cli::terminal;
use post_job::disk;
use post_job::failure::Failure;
use post_job::files::{self, Role};
use post_job::session::Session;
use post_job::{self as job, plugin_finder};
use template::{ARM_LENGTHS, Class, USUAL_ARM};

const MACHINE: Role = Role { what: "machine file", remedy: "give it another name" };

/// Writes a machine file that `post check` accepts, with a remark on each value that says what to measure.
///
/// With --class, everything else has a default or a flag; without it, a few questions are asked, on the terminal or
/// through a pipe.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post new my-mill
  post new my-mill --class table-table-ac --dialect linuxcnc --travel X=-200:200 --travel A=-100:20 --tilt -35
  post new gantry --class head-head-ac --pivot 312.4 --max-feed A=3600

Exit codes: 0 the file is written; 1 refused, the messages say why; 2 the command line is wrong.")]
pub struct NewArguments {
    /// Name of the machine, with a folder if it is not to be written here: writes NAME.toml.
    #[arg(value_name = "NAME")]
    name: PathBuf,

    /// Arrangement of the rotary axes; with it no question is asked.
    #[arg(long, value_enum, value_name = "CLASS")]
    class: Option<Class>,

    /// The dialect of its control: fanuc, haas, heidenhain, linuxcnc and others (`post plugin list`). [default: fanuc]
    #[arg(long, value_name = "NAME", value_parser = dialect)]
    dialect: Option<String>,

    /// Who keeps the tip on its path while rotary axes turn, the control by RTCP (TCP, TCPM) or the post. [default: post]
    #[arg(long, value_parser = word::<TcpWord, Tcp>(), value_name = "WHO")]
    tcp: Option<Tcp>,

    /// Units of the NC program. [default: mm]
    #[arg(long, value_parser = word::<UnitsWord, OutputUnits>(), value_name = "UNITS")]
    units: Option<OutputUnits>,

    /// What the machine is called in the file. [default: NAME]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,

    /// Travel of an axis, mm or degrees: X=-300:300.
    #[arg(long, value_name = "AXIS=LEAST:MOST", allow_hyphen_values = true, value_parser = travel)]
    travel: Vec<AxisSetting<[f64; 2]>>,

    /// A rotary axis that turns without end.
    #[arg(long, value_name = "AXIS")]
    cyclic: Vec<String>,

    /// An axis that counts against ISO 841.
    #[arg(long, value_name = "AXIS")]
    reversed: Vec<String>,

    /// Largest feed of an axis, mm/min or deg/min: C=7200.
    #[arg(long, value_name = "AXIS=FEED", value_parser = feed)]
    max_feed: Vec<AxisSetting<f64>>,

    /// A point of a rotary axis' line, machine frame, all axes at zero, mm: A=0,0.012,50.
    #[arg(long, value_name = "AXIS=X,Y,Z", value_parser = point)]
    point: Vec<AxisSetting<[f64; 3]>>,

    /// Height of the gauge line over the table's face with all axes at zero, mm. [default: 500]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = finite)]
    gauge: Option<f64>,

    /// From the swivel axis of the head to the gauge line, mm; for classes with a swivel head alone. [default: 250]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = finite)]
    pivot: Option<f64>,

    /// Height of the tilting axis of the table over its face, below is negative, mm; for classes with a tilting table
    /// alone. [default: 50]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = finite)]
    tilt: Option<f64>,

    /// Lengths of a robot's arm, mm: a1,a2,b,c1,c2,c3,c4 as they are published for arms with a parallel shoulder and a
    /// spherical wrist (OPW). [default: 150,-115,0,445,700,795,85]
    #[arg(long, value_name = "A1,A2,B,C1,C2,C3,C4", allow_hyphen_values = true, value_parser = arm)]
    arm: Option<ArmLengths>,

    /// Largest deviation of the tip in a cut, mm. [default: 0.005, of a robot 0.05]
    #[arg(long, value_name = "MM", value_parser = finite)]
    tolerance: Option<f64>,

    /// Replaces an existing file.
    #[arg(long)]
    force: bool,
}

/// An arm whose longest length is less than this was told in metres, mm.
const SHORTEST_ARM: f64 = 10.0;

/// Lengths of a robot's arm, mm.
#[derive(Clone, Copy, Debug)]
pub struct ArmLengths([f64; ARM_LENGTHS.len()]);

/// A value for one axis.
#[derive(Clone, Debug)]
pub struct AxisSetting<T> {
    /// Address of the axis.
    pub axis: String,
    /// Its value.
    pub value: T,
}

/// What a machine file is made from.
#[derive(Debug)]
pub struct Choices {
    /// What the machine is called.
    pub title: String,
    pub class: Class,
    pub dialect: String,
    pub tcp: Tcp,
    pub units: OutputUnits,
    pub travel: Vec<AxisSetting<[f64; 2]>>,
    pub cyclic: Vec<String>,
    pub reversed: Vec<String>,
    pub max_feed: Vec<AxisSetting<f64>>,
    pub point: Vec<AxisSetting<[f64; 3]>>,
    /// mm; see [`NewArguments`].
    pub gauge: f64,
    pub pivot: f64,
    pub tilt: f64,
    /// [`ARM_LENGTHS`], mm.
    pub arm: [f64; ARM_LENGTHS.len()],
    pub tolerance: f64,
    pub control: ControlFacts,
}

/// What the dialect tells of its control.
#[derive(Debug, Default)]
pub struct ControlFacts {
    /// It has no words for positions in machine coordinates.
    pub no_positions: bool,
    /// The option under which it has words for a spindle, where it has none without.
    pub spindle_by: Option<String>,
}

/// A machine file, and the machine that it describes.
struct Written {
    text: String,
    machine: Machine,
}

/// Writes the file.
pub fn run(session: &Session, arguments: &NewArguments) -> Result<(), Failure> {
    let path = file(&arguments.name)?;
    refuse_existing(arguments, &path)?;
    let mut choices = choices(arguments, &path)?;
    let mut faults = unknown_axes(&choices);
    faults.extend(useless_flags(arguments, choices.class));
    if !faults.is_empty() {
        return Err(faults.into());
    }
    let finder = plugin_finder::finder(session, &[])?;
    let stranger = plugin_finder::not_built_in(&choices.dialect);
    if stranger.is_none() {
        ask_the_dialect(&mut choices, &path, &finder)?;
    }
    let Written { text, machine } = written(&choices, &path)?;
    let checked = job::derive(&machine, 0.0)?;
    if stranger.is_none() {
        // Nor what `post check` would refuse.
        job::try_opening(&machine, &finder, 0.0)?;
    }
    // Answers take their time.
    refuse_existing(arguments, &path)?;
    files::write(session, &[(MACHINE, &path.clone().into(), &text)])?;
    session.findings(&checked.findings());
    session.findings(stranger.as_slice());
    terminal::print(
        session,
        &format!(
            "{}: {}\nMeasure what its remarks ask for, then: post check {}\n",
            path.display(),
            checked.class.name,
            path.display()
        ),
    );
    Ok(())
}

/// The file that the choices make: nothing that the loader would refuse.
fn written(choices: &Choices, path: &Path) -> Result<Written, Failure> {
    let text = template::write(choices);
    let source = description::Source { name: path.display().to_string(), text: text.clone() };
    let machine =
        description::load(source, &[], &mut |parent| Err(format!("there is no machine {parent}")))?;
    Ok(Written { text, machine })
}

/// Has the dialect tell what its control lacks, and by which of its flags it has a spindle. One that does not open says why
/// when the machine is tried.
fn ask_the_dialect(choices: &mut Choices, path: &Path, finder: &Finder) -> Result<(), Failure> {
    let open = |choices: &Choices| -> Result<Option<OpenedDialect>, Failure> {
        let machine = written(choices, path)?.machine;
        Ok(plugin_finder::dialect(finder, &machine, "NEW", None).ok().map(|(opened, _)| opened))
    };
    let Some(mut opened) = open(choices)? else {
        return Ok(());
    };
    choices.control.no_positions = opened.capabilities().has(Capabilities::NO_PARK);
    if plugin_finder::has_spindle(&mut opened) {
        return Ok(());
    }
    let Ok(plugin) = finder.find(&choices.dialect) else {
        return Ok(());
    };
    for spec in plugin.options().iter().filter(|spec| matches!(spec.kind, OptionKind::Flag)) {
        choices.control.spindle_by = Some(spec.key.to_owned());
        if open(choices)?.is_some_and(|mut opened| plugin_finder::has_spindle(&mut opened)) {
            return Ok(());
        }
    }
    choices.control.spindle_by = None;
    Ok(())
}

/// A file that is there stays, unless the user says otherwise.
fn refuse_existing(arguments: &NewArguments, path: &Path) -> Result<(), Failure> {
    if arguments.force || !disk::exists(path) {
        return Ok(());
    }
    let message = format!("{} is there already", path.display());
    let finding = Diagnostic::error("new", message);
    Err(finding.help("--force replaces it").into())
}

/// `NAME.toml`.
fn file(name: &Path) -> Result<PathBuf, Failure> {
    let path = match name.extension() {
        Some(ending) if ending == "toml" => name.to_owned(),
        _ => {
            let mut whole = name.as_os_str().to_owned();
            whole.push(".toml");
            PathBuf::from(whole)
        }
    };
    match path.file_stem() {
        Some(stem) if !stem.is_empty() && stem != ".toml" => {}
        _ => {
            let message = format!("{} is no name", name.display());
            return Err(Diagnostic::error("new", message).into());
        }
    }
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty())
        && !disk::is_dir(folder)
    {
        let message = format!("there is no folder {}", folder.display());
        return Err(Diagnostic::error("new", message).into());
    }
    Ok(path)
}

fn choices(arguments: &NewArguments, path: &Path) -> Result<Choices, Failure> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut choices = Choices {
        title: arguments.title.clone().unwrap_or(stem.into_owned()),
        class: arguments.class.unwrap_or(Class::ThreeAxis),
        dialect: arguments.dialect.clone().unwrap_or("fanuc".to_owned()),
        tcp: arguments.tcp.unwrap_or(arguments.class.map_or(Tcp::Post, Class::usual_tcp)),
        units: arguments.units.unwrap_or_default(),
        travel: arguments.travel.clone(),
        cyclic: arguments.cyclic.clone(),
        reversed: arguments.reversed.clone(),
        max_feed: arguments.max_feed.clone(),
        point: arguments.point.clone(),
        gauge: arguments.gauge.unwrap_or(500.0),
        pivot: arguments.pivot.unwrap_or(250.0),
        tilt: arguments.tilt.unwrap_or(50.0),
        arm: arguments.arm.map_or(USUAL_ARM, |ArmLengths(arm)| arm),
        tolerance: 0.0,
        control: ControlFacts::default(),
    };
    if arguments.class.is_none() {
        questions::ask(arguments, &mut choices)?;
    }
    choices.tolerance = arguments.tolerance.unwrap_or(choices.class.usual_tolerance());
    Ok(choices)
}

/// Flags that nothing in the file of the class stands on.
fn useless_flags(arguments: &NewArguments, class: Class) -> Vec<Diagnostic> {
    type FlagTest = fn(Class) -> bool;
    let flags: [(&str, bool, FlagTest, &str, Option<&str>); 5] = [
        (
            "--pivot",
            arguments.pivot.is_some(),
            Class::has_pivot,
            "swivel head",
            class.axis_at("pivot"),
        ),
        (
            "--tilt",
            arguments.tilt.is_some(),
            Class::has_tilt,
            "tilting table",
            class.axis_at("tilt"),
        ),
        ("--tcp", arguments.tcp.is_some(), Class::keeps_tips, "control that keeps the tip", None),
        ("--arm", arguments.arm.is_some(), Class::has_arm, "arm of a robot", None),
        ("--gauge", arguments.gauge.is_some(), Class::has_gauge, "gauge line over a table", None),
    ];
    let mut faults = Vec::new();
    for (flag, _, has, part, axis) in flags.into_iter().filter(|(_, given, ..)| *given) {
        if !has(class) {
            let classes: Vec<String> = Class::value_variants()
                .iter()
                .filter(|class| has(**class))
                .map(|class| class.name())
                .collect();
            faults.push(
                Diagnostic::error(
                    "new",
                    format!(
                        "{flag}: {} has no {part}, so that nothing would come of it",
                        class.name()
                    ),
                )
                .help(format!("leave it out; it is for {}", classes.join(", "))),
            );
        } else if let Some(axis) = axis
            && arguments.point.iter().any(|given| given.axis == axis)
        {
            faults.push(
                Diagnostic::error(
                    "new",
                    format!("{flag} and --point {axis} both say where the line of {axis} runs"),
                )
                .help("keep one of them"),
            );
        }
    }
    faults
}

/// Flags for axes that the class does not have.
fn unknown_axes(choices: &Choices) -> Vec<Diagnostic> {
    let known = choices.class.axes();
    let all = [
        ("--travel", choices.travel.iter().map(|given| &given.axis).collect::<Vec<_>>()),
        ("--cyclic", choices.cyclic.iter().collect()),
        ("--reversed", choices.reversed.iter().collect()),
        ("--max-feed", choices.max_feed.iter().map(|given| &given.axis).collect()),
        ("--point", choices.point.iter().map(|given| &given.axis).collect()),
    ];
    all.iter()
        .flat_map(|(flag, axes)| axes.iter().map(move |axis| (flag, axis)))
        .filter(|(_, axis)| !known.contains(&axis.as_str()))
        .map(|(flag, axis)| {
            Diagnostic::error(
                "new",
                format!("{flag} {axis}: {} has no such axis", choices.class.name()),
            )
            .help(format!("its axes are {}", known.join(", ")))
        })
        .collect()
}

/// `X=…`, the axis in capitals.
fn split(text: &str) -> Result<(String, &str), String> {
    match text.split_once('=') {
        Some((axis, value)) if !axis.trim().is_empty() => {
            Ok((axis.trim().to_ascii_uppercase(), value))
        }
        _ => Err("AXIS=… is needed".to_owned()),
    }
}

fn travel(text: &str) -> Result<AxisSetting<[f64; 2]>, String> {
    let (axis, value) = split(text)?;
    Ok(AxisSetting { axis, value: range(value)? })
}

/// `-300:300`.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let (least, most) =
        text.split_once(':').ok_or_else(|| format!("`{text}` is no travel: -300:300"))?;
    let range = [finite(least.trim())?, finite(most.trim())?];
    if range[0] >= range[1] {
        return Err(format!("`{text}`: the first must be the smaller"));
    }
    Ok(range)
}

/// The name of a dialect, which stands in the file as it is.
pub fn dialect(text: &str) -> Result<String, String> {
    let allowed = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    if text.is_empty() || !text.chars().all(allowed) {
        return Err("the name of a dialect has letters and digits alone".to_owned());
    }
    Ok(text.to_ascii_lowercase())
}

/// `150,-115,0,445,700,795,85`.
fn arm(text: &str) -> Result<ArmLengths, String> {
    let lengths: Vec<f64> =
        text.split(',').map(|length| finite(length.trim())).collect::<Result<_, _>>()?;
    let count = lengths.len();
    let names = ARM_LENGTHS.map(|(name, _)| name).join(",");
    let longest = lengths.iter().fold(0.0, |longest: f64, length| longest.max(length.abs()));
    let wrong = format!("{count} lengths, and {names} are needed");
    let lengths: [f64; ARM_LENGTHS.len()] = lengths.try_into().map_err(|_| wrong)?;
    if longest < SHORTEST_ARM {
        let inside =
            lengths.map(|length| (length * 1e6).round() / 1e3 + 0.0).map(|mm| mm.to_string());
        return Err(format!(
            "the longest of these lengths is {longest} mm, and no arm is so short: data sheets and DH tables are often in metres, and here they are in millimetres, {}",
            inside.join(",")
        ));
    }
    Ok(ArmLengths(lengths))
}

fn feed(text: &str) -> Result<AxisSetting<f64>, String> {
    let (axis, value) = split(text)?;
    Ok(AxisSetting { axis, value: flag_values::positive(value.trim())? })
}

fn point(text: &str) -> Result<AxisSetting<[f64; 3]>, String> {
    let (axis, value) = split(text)?;
    Ok(AxisSetting { axis, value: flag_values::point(value)? })
}

impl Class {
    /// As it is written on the command line.
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}
