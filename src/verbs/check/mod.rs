//! `post check`: what a machine file means, to be compared with the machine.

mod bodies_picture;
mod check_text;
mod reach_picture;

use std::path::PathBuf;

use clap::Args;
use post_machine::check::{Differing, compare};
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::{Diagnostic, Severity, Short};
use post_machine::face_mode::FaceMode;
use post_machine::wrap_mode::WrapMode;

use post_cli::arguments::flag_values;
use post_cli::arguments::flag_values::file;
use post_cli::terminal::print;
use post_job::clearance;
use post_job::commission_program::{self, Commissioned};
use post_job::failure::Failure;
use post_job::files::{self, PathArg, Role};
use post_job::session::Session;
use post_job::{
    self as job, JobMachine, machine_files, other_dialect, plugin_finder, report, unused_options,
};

/// Prints what was derived from a machine file: chain, class, signs, reach, travel, solutions.
///
/// What posting would refuse of the file is refused here too: its plugins are opened and given their options.
/// Go through the sign table beside the machine, axis by axis, before the file moves it: a wrong sign breaks a
/// spindle. --commission writes a short program for that, --nominal compares the file with another one.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post check ac-trunnion
  post check my-mill.toml --svg reach.svg --json check.json
  post check my-mill.toml --bodies bodies.svg
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
    #[arg(short, long, value_name = "FILE", requires = "commission", value_parser = file())]
    output: Option<PathArg>,

    /// Draws the reachable directions of the tool: tilt and azimuth, seen from the part.
    #[arg(long, value_name = "FILE", value_parser = file())]
    svg: Option<PathArg>,

    /// Draws all bodies with their names, every axis at zero: `[solids]`, fixtures, the stock, outlines of tools.
    #[arg(long, value_name = "FILE", value_parser = file(), conflicts_with_all = ["nominal", "commission"])]
    bodies: Option<PathArg>,

    /// Writes the same as JSON, with all digits; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    json: Option<PathArg>,

    /// Checks the machine with this head, one of those that the program can swap in (`[head.NAME]`).
    #[arg(long, value_name = "NAME")]
    head: Option<String>,

    /// Length of the tool from the gauge point to the tip, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_hyphen_values = true, value_parser = flag_values::not_negative)]
    tool_length: f64,

    /// Where the part origin sits, all axes at zero, machine frame, mm; in both machines of --nominal.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = flag_values::point)]
    mount: Option<[f64; 3]>,

    /// Sets a parameter of the machine (`Lm=312`) or any key; in MACHINE alone, not in the other of --nominal.
    #[arg(long, value_name = "NAME=VALUE", value_parser = flag_values::setting)]
    set: Vec<Setting>,

    /// Checks the machine with another dialect than its file names; short for --set control.dialect=…
    #[arg(long, value_name = "NAME")]
    dialect: Option<String>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,

    /// A folder of plugin libraries, for the dialect and the error model of the machine; POST_PLUGINS adds more.
    #[arg(long, value_name = "FOLDER")]
    plugins: Vec<PathBuf>,
}

/// Checks as the arguments say.
pub fn run(session: &Session, arguments: &CheckArguments) -> Result<(), Failure> {
    let machine = machine(session, arguments)?;
    let finder = plugin_finder::finder(session, &arguments.plugins)?;
    unused_options::warn(session, &machine, &finder);
    let opened = JobMachine { machine, finder };
    if arguments.commission {
        return commission(session, arguments, &opened);
    }
    let JobMachine { machine, finder } = &opened;
    job::try_opening(machine, finder, arguments.tool_length)?;
    match &arguments.nominal {
        Some(nominal) => with_nominal(session, arguments, machine, nominal),
        None => {
            let told = unused_options::found(machine, finder);
            alone(session, arguments, machine, &told)
        }
    }
}

/// Writes a program that moves one axis after the other.
fn commission(
    session: &Session,
    arguments: &CheckArguments,
    opened: &JobMachine,
) -> Result<(), Failure> {
    let output = arguments.output.as_ref();
    let length = arguments.tool_length;
    let Commissioned { target, moves, printed } =
        commission_program::write(session, opened, length, output)?;
    if let Some(path) = target.path().filter(|_| !printed) {
        print(
            session,
            &format!(
                "{}: {moves} moves, one axis each. Run it without a part, with a hand on the feed override.\n",
                path.display()
            ),
        );
    }
    Ok(())
}

/// What one machine file means; some warnings are `told` already.
fn alone(
    session: &Session,
    arguments: &CheckArguments,
    machine: &Machine,
    told: &[Diagnostic],
) -> Result<(), Failure> {
    let mut check = job::derive(machine, arguments.tool_length)?;
    let mut findings = check.findings();
    let mut solids = report::solids::faults(machine);
    solids.extend(clearance::of_machine(machine));
    let warnings = solids.iter().filter(|fault| fault.severity == Severity::Warning);
    let warnings = told.iter().chain(warnings);
    check.warnings.extend(warnings.map(|fault| fault.message.clone()));
    findings.extend(solids);
    let picture = arguments.svg.as_ref().map(|_| reach_picture::draw(&check));
    let bodies = arguments.bodies.as_ref().map(|_| bodies_picture::draw(machine));
    let json = arguments.json.as_ref().map(|_| files::json(&check));
    let taken = write(session, arguments, [picture, bodies], json)?;
    // What a proof would be refused for refuses the file.
    let (errors, warnings): (Vec<_>, Vec<_>) =
        findings.into_iter().partition(|finding| finding.severity == Severity::Error);
    session.findings(&warnings);
    let refused = || if errors.is_empty() { Ok(()) } else { Err(errors.into()) };
    if taken {
        return refused();
    }
    print(session, &check_text::check(&check));
    if let Some(mode) = machine.in_face().and_then(|(_, face)| face.face.as_ref()) {
        print(session, &polar(machine, mode));
    }
    if let Some(mode) = machine.in_wrap().and_then(|(_, wrap)| wrap.wrap.as_ref()) {
        print(session, &mantle(machine, mode));
    }
    let heads: Vec<&str> = machine.named_heads().map(|head| head.name.as_str()).collect();
    if !heads.is_empty() {
        print(session, &format!("further heads, see --head: {}\n", heads.join(", ")));
    }
    refused()
}

/// What is written in polar interpolation of the control.
fn polar(machine: &Machine, mode: &FaceMode) -> String {
    let name = |joint: usize| machine.axes[joint].name.as_str();
    let (across, turning) = (name(mode.across), name(mode.turning));
    format!(
        "polar            {} to {}: {across} and {} are coordinates on the face, {turning} at zero where it begins, no nearer to its line than {} mm\n",
        mode.on.join(", "),
        mode.off.join(", "),
        mode.letter,
        mode.pole
    )
}

/// What is written in cylinder interpolation of the control.
fn mantle(machine: &Machine, mode: &WrapMode) -> String {
    let of = match mode.lengths {
        true => "a length along the cylinder",
        false => "an angle",
    };
    format!(
        "mantle           {} to {}: {} is {of} of radius {} mm, {} at zero where it begins\n",
        mode.on.join(", "),
        mode.off.join(", "),
        mode.letter,
        Short(mode.radius),
        machine.axes[mode.turning].name
    )
}

/// How far two machine files are apart.
fn with_nominal(
    session: &Session,
    arguments: &CheckArguments,
    machine: &Machine,
    nominal: &str,
) -> Result<(), Failure> {
    let mount: Vec<Setting> = arguments.mount.map(Setting::Mount).into_iter().collect();
    let nominal = machine_files::load(session, nominal, &arguments.machines, &mount)?;
    let compared =
        compare(machine, &nominal, arguments.tool_length).map_err(|fault| differing(&fault))?;
    let json = arguments.json.as_ref().map(|_| files::json(&compared));
    if !write(session, arguments, [None, None], json)? {
        print(session, &check_text::comparison(&compared));
    }
    Ok(())
}

/// The machine that is checked, with its settings and the head that is asked for.
fn machine(session: &Session, arguments: &CheckArguments) -> Result<Machine, Failure> {
    let mut settings = arguments.set.clone();
    settings.extend(arguments.mount.map(Setting::Mount));
    settings.extend(arguments.dialect.clone().map(Setting::Dialect));
    let machine = machine_files::load(session, &arguments.machine, &arguments.machines, &settings)?;
    let dialect = arguments.dialect.as_deref();
    other_dialect::say_what_is_left(
        session,
        dialect,
        &arguments.machine,
        &arguments.machines,
        &settings,
    );
    match &arguments.head {
        Some(name) => with_head(machine, name),
        None => Ok(machine),
    }
}

/// The machine with a head that the program can swap in.
fn with_head(machine: Machine, name: &str) -> Result<Machine, Failure> {
    if let Some(head) = machine.named_heads().find(|head| head.name == name) {
        return Ok(head.machine.clone());
    }
    let known: Vec<&str> = machine.named_heads().map(|head| head.name.as_str()).collect();
    let help = match known.as_slice() {
        [] => "its file has no [head.NAME]".to_owned(),
        known => format!("its heads are {}", known.join(", ")),
    };
    let message = format!("{} has no head {name}", machine.name);
    Err(Diagnostic::error("check", message).help(help).into())
}

fn differing(fault: &Differing) -> Diagnostic {
    match fault {
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
    }
}

/// Writes pictures (of reach, of bodies) and JSON, those that are asked for: all or none. True if standard output is taken by
/// one of them, so that nothing else is printed there.
fn write(
    session: &Session,
    arguments: &CheckArguments,
    [reach, bodies]: [Option<String>; 2],
    json: Option<String>,
) -> Result<bool, Failure> {
    let of = |role, target: &'_ Option<PathArg>, text: Option<String>| {
        target.clone().zip(text).map(|(target, text)| (role, target, text))
    };
    let texts = [
        of(Role::PICTURE, &arguments.svg, reach),
        of(Role::PICTURE, &arguments.bodies, bodies),
        of(Role::JSON, &arguments.json, json),
    ];
    let texts = texts.iter().flatten();
    let texts: Vec<_> = texts.map(|(role, target, text)| (*role, target, text.as_str())).collect();
    Ok(files::write(session, &texts)?)
}
