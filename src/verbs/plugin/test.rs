//! `post plugin test`: the conformance kit on a plugin.

use std::path::PathBuf;

use clap::Args;
use post_host::{GivenValue, PluginKind};
use post_kit::conformance;
use post_machine::diagnostic::Diagnostic;

use super::{read_back, title};
use post_cli::terminal::print;
use post_job::failure::Failure;
use post_job::plugin_finder::{by_name_or_file, diagnostic};
use post_job::session::Session;

/// Runs a plugin on cases whose answer is known, and says what it gets wrong.
///
/// An error model is fitted to deviations of known peak (bows, waves, skewed ones, jumps, tiny and huge, no
/// numbers), and its answers must hold together: peaks and curve, one move after another, in a turned frame.
/// What a model may miss is said and not held against it: the certificate finds it. A dialect writes short
/// five-axis programs, whole, in batches of every size, and with one number changed at a time: the text must show each,
/// to the last decimal that the dialect declares. So it is with every option at its ends, with all that it declares to
/// write (arcs, cycles, planes), with remarks of any length and language; what it does not declare or know it must
/// refuse. A long program is written by two threads in turn, beside the same by one. At last, programs of its own are read
/// back by its vocabulary, and must do what their CL files ask for: on three axes, in inches, with axis positions, with
/// tool centre point control, in tilted planes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post plugin test target/release/libpost_mine.so
  post plugin test harmonic --option order=3

Exit codes: 0 nothing is wrong; 1 something is, the messages say what; 2 the command line is wrong.")]
pub struct TestArguments {
    /// The library, or the name of a plugin in a folder of --plugins or built in. Opening a library runs its
    /// code.
    #[arg(value_name = "PLUGIN")]
    plugin: PathBuf,

    /// Sets an option of the plugin, as its table in a machine file would.
    #[arg(long, value_name = "KEY=VALUE", value_parser = option)]
    option: Vec<(String, GivenValue)>,

    /// Events of a dialect's longest program, which two threads write in turn.
    #[arg(long, value_name = "COUNT", default_value_t = 1_000_000)]
    events: usize,

    /// A folder of plugin libraries; POST_PLUGINS adds more.
    #[arg(long, value_name = "FOLDER")]
    plugins: Vec<PathBuf>,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &TestArguments) -> Result<(), Failure> {
    let plugin = by_name_or_file(session, &arguments.plugin, &arguments.plugins)?;
    let mut report = conformance::test_long(&plugin, &arguments.option, arguments.events)
        .map_err(|fault| diagnostic(&fault, &[], None))?;
    if plugin.kind() == PluginKind::Dialect {
        report.cases.extend(read_back::cases(&plugin, &arguments.option));
    }
    print(session, &format!("{}\n\n{}", title(&plugin), report.table()));
    if report.is_good() {
        let cases = report.cases.len();
        print(session, &format!("\nNothing is wrong in {cases} cases.\n"));
        return Ok(());
    }
    let wrong = report.wrong();
    let findings: Vec<Diagnostic> =
        wrong.map(|sentence| Diagnostic::error("plugin-test", sentence)).collect();
    Err(findings.into())
}

/// `order=3`; text may stand in quotes, as in a machine file.
fn option(text: &str) -> Result<(String, GivenValue), String> {
    let Some((key, value)) = text.split_once('=') else {
        return Err("an option is KEY=VALUE".to_owned());
    };
    let (key, value) = (key.trim(), value.trim());
    let value = if let Ok(flag) = value.parse() {
        GivenValue::Flag(flag)
    } else if let Ok(integer) = value.parse() {
        GivenValue::Integer(integer)
    } else if let Ok(number) = value.parse() {
        GivenValue::Number(number)
    } else {
        GivenValue::Text(value.trim_matches('"').to_owned())
    };
    Ok((key.to_owned(), value))
}
