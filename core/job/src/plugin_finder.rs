//! The plugins that are part of the command, and those that the user's folders hold.

use std::env::consts::DLL_SUFFIX;
use std::path::{Path, PathBuf};

use post_host::{
    Finder, LinkedPlugin, OpenedDialect, OpenedModel, Plugin, PluginFault, ProgramAhead,
    ProgramSetup, ProgramTool, ProgramWord, Reason, of_the_source,
};
use post_machine::axis_words;
use post_machine::description::{GivenOption, Machine, OutputUnits, Tcp};
use post_machine::diagnostic::{self, Diagnostic, SourcePlace, nearest};
use post_plugin::{
    Accuracy, Capabilities, DialectSession as _, Meaning, Tolerance, Units, Value, VocabularyWord,
};
use post_posting::ProgramPreview;
use post_posting::report::PluginUse;

use super::{given_values::given, mode_words, orientation, plugin_folders};
use crate::files::{PathArg, standard};
use crate::session::Session;

/// The finder for a run, with the folders that the user `named`. Once a library may be opened, results are kept apart
/// from what it prints.
pub fn finder(session: &Session, named: &[PathBuf]) -> Result<Finder, Vec<Diagnostic>> {
    let folders = plugin_folders::named(session, named)?;
    for folder in &folders {
        session.read_files().note_libraries(folder);
    }
    // Inside another program standard output is not ours to keep.
    if !folders.is_empty() && session.owns_output() {
        standard::keep_apart();
    }
    let linked = post_stock::plugins().iter().copied().map(LinkedPlugin::from);
    Ok(Finder { folders, linked: linked.collect(), isolation: session.isolation() })
}

/// The plugin that is called so, or the library at this path.
pub fn by_name_or_file(
    session: &Session,
    plugin: &Path,
    named: &[PathBuf],
) -> Result<Plugin, Vec<Diagnostic>> {
    let text = plugin.to_string_lossy();
    let is_file = plugin.components().count() > 1 || text.ends_with(DLL_SUFFIX);
    let found = if is_file {
        standard::keep_apart();
        Plugin::open_in(plugin, session.isolation().as_ref())
    } else {
        finder(session, named)?.find(&text)
    };
    found.map_err(|fault| vec![diagnostic(&fault, &[], None)])
}

/// The number of the program, of a dialect whose programs have one.
pub fn program_number(finder: &Finder, machine: &Machine) -> Option<i64> {
    integer(finder, machine, "program_number")
}

/// An option of the dialect that is a whole number, as the machine file has it or as it is by default.
pub fn integer(finder: &Finder, machine: &Machine, key: &str) -> Option<i64> {
    option(finder, machine, key, |value| match value {
        Value::Integer(number) => Some(number),
        _ => None,
    })
}

/// An option of the dialect that is yes or no, likewise.
pub fn flag(finder: &Finder, machine: &Machine, key: &str) -> Option<bool> {
    option(finder, machine, key, |value| match value {
        Value::Flag(flag) => Some(flag),
        _ => None,
    })
}

/// An option of the dialect that is text, likewise.
pub fn text(finder: &Finder, machine: &Machine, key: &str) -> Option<String> {
    option(finder, machine, key, |value| match value {
        Value::Text(text) => Some(text.to_owned()),
        _ => None,
    })
}

/// What `take` makes of an option of the dialect.
fn option<T>(
    finder: &Finder,
    machine: &Machine,
    key: &str,
    take: impl FnOnce(Value<'_>) -> Option<T>,
) -> Option<T> {
    let plugin = finder.find(&machine.control.dialect).ok()?;
    let declared = plugin.options().iter().find(|spec| spec.key == key)?;
    let options = orientation::options(&plugin, &machine.control).ok()?;
    let given = options.iter().find(|(given, _)| given == key);
    take(given.map_or(declared.default, |(_, value)| value.as_value()))
}

/// What programs of a machine rely on at its control, a sentence each, as its dialect tells it.
///
/// # Errors
/// The dialect cannot be opened, or fails to tell.
pub fn relies_on(finder: &Finder, machine: &Machine) -> Result<Vec<String>, Vec<Diagnostic>> {
    let (mut opened, _) = dialect(finder, machine, "SHEET", None)?;
    opened.relies_on().map_err(|fault| vec![Diagnostic::error("plugin", fault)])
}

/// The work offset that a program of this machine is in where the CL file names none, by the option of its dialect: as a word,
/// or a row of Heidenhain's preset table. None where the operator chooses it.
pub fn work_offset(finder: &Finder, machine: &Machine) -> Option<String> {
    match integer(finder, machine, "preset") {
        Some(row) => (row >= 0).then(|| format!("CYCL DEF 247 Q339={row}")),
        None => text(finder, machine, "work_offset").filter(|word| !word.is_empty()),
    }
}

/// Opens the dialect of a machine for the program `program`, made from the CL file `cl_file`.
pub fn dialect(
    finder: &Finder,
    machine: &Machine,
    program: &str,
    cl_file: Option<&PathArg>,
) -> Result<(OpenedDialect, PluginUse), Vec<Diagnostic>> {
    dialect_knowing(finder, machine, program, cl_file, None)
}

/// Some word of the control turns a spindle, as far as its dialect tells: one whose line is a command names all of them.
pub fn has_spindle(dialect: &mut OpenedDialect) -> bool {
    if !dialect.capabilities().has(Capabilities::COMMAND_A_LINE) {
        return true;
    }
    let words = dialect.vocabulary().unwrap_or_default();
    let turns = |word: &VocabularyWord| word.meaning == Meaning::SpindleClockwise;
    words.is_empty() || words.iter().any(turns)
}

/// [`dialect`] with what a first pass over the CL file found.
pub fn dialect_knowing(
    finder: &Finder,
    machine: &Machine,
    program: &str,
    cl_file: Option<&PathArg>,
    ahead: Option<&ProgramPreview>,
) -> Result<(OpenedDialect, PluginUse), Vec<Diagnostic>> {
    let control = &machine.control;
    let fault = |fault: PluginFault| {
        let place = refused_axis(machine, &fault).or_else(|| control.dialect_place.clone());
        vec![diagnostic(&fault, &control.options, place)]
    };
    let plugin = finder.find(&control.dialect).map_err(fault)?;
    let options = orientation::options(&plugin, control).map_err(|fault| vec![*fault])?;
    let setup = ProgramSetup {
        program: program.to_owned(),
        // Without a CL file there is no part: the axes move one by one.
        machine: match cl_file {
            Some(_) => called(machine),
            None => machine.name.clone(),
        },
        units: match control.units {
            OutputUnits::Mm => Units::Millimetre,
            OutputUnits::Inch => Units::Inch,
        },
        tcp: control.tcp == Tcp::Control,
        turns_part: machine.spindle.surface_speed,
        words: axis_words::order(machine)
            .into_iter()
            .map(|place| {
                let axis = &machine.axes[place];
                ProgramWord {
                    name: axis.word().to_owned(),
                    rotary: axis.joint.rotary,
                    wrapped: axis.range.is_some(),
                    signed: axis.signed,
                    depth: axis_words::is_depth(machine, place),
                    carries_part: axis.carries_part,
                    diameter: axis_words::is_diameter(machine, place),
                    travel: axis.travel.map(|travel| travel.map(|end| axis.reading(end))),
                }
            })
            .chain(machine.along.iter().map(|word| ProgramWord {
                name: word.name.clone(),
                rotary: false,
                wrapped: false,
                signed: false,
                depth: false,
                carries_part: false,
                diameter: false,
                travel: None,
            }))
            .collect(),
        options,
        cl_file: cl_file.map(cl_name).unwrap_or_default(),
        accuracy: Some(Accuracy {
            cut: Tolerance {
                tip: machine.accuracy.tolerance,
                axis: machine.accuracy.axis_tolerance.to_degrees(),
            },
            rapid: machine.accuracy.rapid_tolerance,
        }),
        ahead: ahead.map(|ahead| ProgramAhead {
            tools: ahead
                .tools()
                .into_iter()
                .map(|tool| ProgramTool {
                    number: tool.number,
                    name: tool.name.clone(),
                    length: tool.length,
                    diameter: tool.diameter,
                    corner_radius: tool.corner_radius,
                })
                .collect(),
            // Where the tool goes stands for a raw part that nobody has described.
            extents: machine.stock_extents().or(ahead.extents),
            time: ahead.time_s,
        }),
    };
    let mut opened = plugin.dialect(&setup).map_err(fault)?;
    match mode_words::unknown(machine, &mut opened) {
        Some(unknown) => Err(vec![unknown]),
        None => Ok((opened, used(&plugin))),
    }
}

/// The CL file's name without its folder; empty for standard input.
pub fn cl_name(cl_file: &PathArg) -> String {
    cl_file
        .path()
        .and_then(Path::file_name)
        .map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Opens the error model of a machine.
pub fn model(
    finder: &Finder,
    machine: &Machine,
) -> Result<(OpenedModel, PluginUse), Vec<Diagnostic>> {
    let accuracy = &machine.accuracy;
    let fault = |fault: PluginFault| {
        vec![diagnostic(&fault, &accuracy.options, accuracy.model_place.clone())]
    };
    let plugin = finder.find(&accuracy.model).map_err(fault)?;
    let opened = plugin.error_model(&given(&accuracy.options)).map_err(fault)?;
    Ok((opened, used(&plugin)))
}

/// Opens the error model `name` with its options as they are by default.
pub fn plain_model(finder: &Finder, name: &str) -> Result<OpenedModel, Vec<Diagnostic>> {
    finder
        .find(name)
        .and_then(|plugin| plugin.error_model(&[]))
        .map_err(|fault| vec![diagnostic(&fault, &[], None)])
}

/// Where the axis is described about which the dialect complains: its sentence begins with `axis C:`.
fn refused_axis(machine: &Machine, fault: &PluginFault) -> Option<SourcePlace> {
    let Reason::Refused { message } = &fault.reason else {
        return None;
    };
    let (name, _) = message.strip_prefix("axis ")?.split_once(':')?;
    let axis = machine.axes.iter().find(|axis| axis.word() == name)?;
    axis.place.clone()
}

fn used(plugin: &Plugin) -> PluginUse {
    PluginUse {
        name: plugin.name().to_owned(),
        version: plugin.version().to_owned(),
        path: plugin.path().map(|path| path.display().to_string()),
        hash: plugin.hash().map(str::to_owned),
    }
}

/// Names of the error models, or of the dialects, that are part of the command.
pub fn built_in(models: bool) -> Vec<&'static str> {
    let stock = post_stock::plugins().iter();
    let of_kind = stock.filter(|plugin| plugin.is_model() == models);
    of_kind.map(|plugin| plugin.name()).collect()
}

/// A warning that a dialect is no part of the command, with the one that was perhaps meant.
pub fn not_built_in(dialect: &str) -> Option<Diagnostic> {
    let names = built_in(false);
    if names.contains(&dialect) {
        return None;
    }
    let message = format!(
        "the dialect {dialect} is not built in: name the folder of its plugin with --plugins"
    );
    let help = of_the_source(dialect)
        .unwrap_or_else(|| diagnostic::meant(dialect, "built in are", &names));
    Some(Diagnostic::warning("plugin", message).help(help))
}

/// A plugin's fault at the line of the machine file that asked for it.
pub fn diagnostic(
    fault: &PluginFault,
    options: &[GivenOption],
    place: Option<SourcePlace>,
) -> Diagnostic {
    let place = match &fault.reason {
        Reason::Option(option) => options
            .iter()
            .find(|given| given.key == option.key)
            .and_then(|given| given.place.clone())
            .or(place),
        _ => place,
    };
    let diagnostic = Diagnostic::error("plugin", fault.to_string()).at(place);
    let help = match (meant(fault), fault.help()) {
        (None, help) => help,
        (Some(meant), help) => format!("did you mean `{meant}`? {help}"),
    };
    if help.is_empty() { diagnostic } else { diagnostic.help(help) }
}

/// What was misspelt, most likely.
fn meant(fault: &PluginFault) -> Option<&str> {
    let (written, known) = match &fault.reason {
        Reason::NotFound { known, .. } => (&fault.plugin, known),
        Reason::Option(option) => (&option.written, &option.allowed),
        _ => return None,
    };
    nearest(written, known.iter().map(String::as_str))
}

/// The machine's name for the program's head, and on which place of the part it depends, if it does.
fn called(machine: &Machine) -> String {
    if !machine.holds_on_mount_alone() {
        return machine.name.clone();
    }
    let [x, y, z] = [machine.mount.x, machine.mount.y, machine.mount.z]
        .map(|value| libm::rint(value * 1e3) / 1e3 + 0.0);
    format!("{}, for the part at X{x} Y{y} Z{z} alone", machine.name)
}
