//! `post check`: what a machine file means, to be compared with the machine.

mod check_text;
mod commission_program;
mod reach_picture;

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clap::Args;
use post_machine::check::{Check, Comparison, Differing, compare};
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::Diagnostic;
use post_posting::Output as _;

use crate::arguments::flag_values::{self as values, Point};
use crate::files::atomic_file::Target;
use crate::files::cl_input::{one, standard};
use crate::job::machine_files as machines;
use crate::terminal::findings as render;
use crate::verbs::post as posting;

/// Prints what was derived from a machine file: chain, class, signs, reach, travel, solutions.
///
/// Go through the sign table beside the machine, axis by axis, before the file moves it: a wrong sign breaks a
/// spindle. --commission writes a short program for that, --nominal compares the file with another one.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post check ac-trunnion
  post check my-mill.toml --svg reach.svg --json check.json
  post check measured.toml --nominal ac-trunnion --tool-length 100
  post check my-mill.toml --commission -o commission.nc

Exit codes: 0 checked (warnings are on standard error); 1 the file is refused; 2 the command line is wrong.")]
pub struct CheckArguments {
    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(value_name = "MACHINE")]
    machine: String,

    /// Compares it with this machine at equal words of a program: the largest deviation of tip and tool axis
    /// over the travels, where, and what each difference between the files contributes.
    #[arg(long, value_name = "OTHER", conflicts_with_all = ["svg", "commission"])]
    nominal: Option<String>,

    /// Writes a short program in the machine's own dialect instead, which moves one axis after the other and
    /// says what must be seen. It is run without a part and with a hand on the feed override.
    #[arg(long, conflicts_with_all = ["svg", "json"])]
    commission: bool,

    /// Where the program of --commission goes, `-` for standard output. [default: `commission`, with the
    /// dialect's ending]
    #[arg(short, long, value_name = "FILE", requires = "commission")]
    output: Option<PathBuf>,

    /// Draws the reachable directions of the tool: tilt and azimuth, seen from the part.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,

    /// Writes what is printed as JSON, with all digits; `-` is standard output, alone there.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Checks the machine with this head, one of those that the program can swap in (`[head.NAME]`).
    #[arg(long, value_name = "NAME")]
    head: Option<String>,

    /// Length of the tool from the gauge point to the tip, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_hyphen_values = true, value_parser = values::not_negative)]
    tool_length: f64,

    /// Where the part origin sits, all axes at zero, machine frame, mm; in both machines of --nominal.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::point)]
    mount: Option<Point>,

    /// Sets a parameter of the machine (`Lm=312`) or any key; in MACHINE alone, not in the other of --nominal.
    #[arg(long, value_name = "NAME=VALUE", value_parser = values::setting)]
    set: Vec<Setting>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,

    /// A folder of plugin libraries, for the dialect of --commission; POST_PLUGINS adds more.
    #[arg(long, value_name = "FOLDER")]
    plugins: Vec<PathBuf>,
}

/// Checks as the arguments say.
pub fn run(arguments: &CheckArguments) -> Result<(), Vec<Diagnostic>> {
    if arguments.svg.is_some() && arguments.svg == arguments.json {
        return Err(one(
            "output",
            "picture and JSON cannot go to one place".to_owned(),
        ));
    }
    let mount = arguments.mount.map(Setting::Mount);
    let mut settings = arguments.set.clone();
    settings.extend(mount.clone());
    let machine = machines::load(&arguments.machine, &arguments.machines, &settings)?;
    let machine = match &arguments.head {
        Some(name) => with_head(machine, name)?,
        None => machine,
    };
    if arguments.commission {
        return commission_program::write(arguments, &machine);
    }
    if let Some(nominal) = &arguments.nominal {
        let mount: Vec<Setting> = mount.into_iter().collect();
        let nominal = machines::load(nominal, &arguments.machines, &mount)?;
        let compared = compare(&machine, &nominal, arguments.tool_length)
            .map_err(|fault| differing(&fault))?;
        return print_comparison(arguments, &compared);
    }
    let check = derive(&machine, arguments.tool_length)?;
    if let Some(path) = &arguments.svg {
        write(arguments, path, &reach_picture::draw(&check))?;
    }
    render::findings(&check.findings());
    if let Some(path) = &arguments.json {
        write(arguments, path, &json(&check))?;
    }
    if taken(arguments) {
        return Ok(());
    }
    print(&check_text::check(&check));
    if !machine.heads.is_empty() {
        let heads = machine.heads.iter().map(|head| head.name.as_str());
        let heads: Vec<&str> = heads.collect();
        print(&format!(
            "further heads, see --head: {}\n",
            heads.join(", ")
        ));
    }
    Ok(())
}

/// The machine with a head that the program can swap in.
fn with_head(machine: Machine, name: &str) -> Result<Machine, Vec<Diagnostic>> {
    let heads = &machine.heads;
    if let Some(head) = heads.iter().find(|head| head.name == name) {
        return Ok(head.machine.clone());
    }
    let known: Vec<&str> = heads.iter().map(|head| head.name.as_str()).collect();
    Err(vec![
        Diagnostic::error("check", format!("{} has no head {name}", machine.name)).help(
            match known.as_slice() {
                [] => "its file has no [head.NAME]".to_owned(),
                known => format!("its heads are {}", known.join(", ")),
            },
        ),
    ])
}

/// What can be derived; a chain that cannot be solved was refused when the file was loaded.
pub fn derive(machine: &Machine, length: f64) -> Result<Check, Vec<Diagnostic>> {
    Check::of(machine, length).map_err(|lack| {
        vec![Diagnostic::error(
            "check",
            format!("{} cannot be solved: {lack:?}", machine.name),
        )]
    })
}

fn print_comparison(
    arguments: &CheckArguments,
    compared: &Comparison,
) -> Result<(), Vec<Diagnostic>> {
    if let Some(path) = &arguments.json {
        write(arguments, path, &json(compared))?;
    }
    if taken(arguments) {
        return Ok(());
    }
    print(&check_text::comparison(compared));
    Ok(())
}

fn differing(fault: &Differing) -> Vec<Diagnostic> {
    vec![match fault {
        Differing::Axes { machine, nominal } => Diagnostic::error(
            "check-nominal",
            format!(
                "the two machines have different axes: {}; the other {}",
                machine.join(", "),
                nominal.join(", ")
            ),
        )
        .help("machines are compared at equal words, so both must have the same axes in the same order"),
        Differing::NoZero { machine } => Diagnostic::error(
            "check-nominal",
            format!("{machine} cannot be brought to the part origin with its rotary axes at zero"),
        ),
    }]
}

fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).unwrap_or_default();
    text.push('\n');
    text
}

/// Standard output is for a picture or for JSON, so nothing else is printed there.
fn taken(arguments: &CheckArguments) -> bool {
    let to = |path: &Option<PathBuf>| path.as_deref() == Some(standard());
    to(&arguments.svg) || to(&arguments.json)
}

/// Writes a text whole, or not at all; never over the machine file.
fn write(arguments: &CheckArguments, path: &Path, text: &str) -> Result<(), Vec<Diagnostic>> {
    spare(arguments, path)?;
    let mut file = posting::create(path)?;
    file.write(text.as_bytes())
        .map_err(io::Error::other)
        .and_then(|()| file.finish())
        .map_err(|error| posting::fault_at(path, &error))
}

/// Prints to standard output; a reader that has seen enough closes the pipe.
pub fn print(text: &str) {
    let _ = io::stdout().lock().write_all(text.as_bytes());
}

/// Where the program of `--commission` goes.
fn program_path(arguments: &CheckArguments, extension: &str) -> Result<PathBuf, Vec<Diagnostic>> {
    let path = match &arguments.output {
        Some(path) => path.clone(),
        None => Path::new("commission").with_extension(extension),
    };
    spare(arguments, &path)?;
    Ok(path)
}

/// Refuses to write over a machine file that is read.
fn spare(arguments: &CheckArguments, path: &Path) -> Result<(), Vec<Diagnostic>> {
    let read = [Some(&arguments.machine), arguments.nominal.as_ref()];
    let target = Target::of(path);
    if read
        .into_iter()
        .flatten()
        .any(|name| target.is(Path::new(name)))
    {
        return Err(one(
            "output",
            format!("{} is the machine file that is checked", path.display()),
        ));
    }
    Ok(())
}
