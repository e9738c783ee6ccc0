//! `post tools`: files of tools read, checked, converted and written.

use std::collections::BTreeMap;

use clap::Args;
use clap::error::ErrorKind;
use post_machine::description::{OutputUnits, ToolData};

use crate::flag_words::UnitsWord;
use post_cli::arguments::flag_values::{file, finite, word};
use post_cli::failure::CommandFault;
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::session::Session;
use post_job::text::number;
use post_job::text_table::{TextTable, or_dash};
use post_job::tools::{FORMATS, ListedTools, ToolsRequest, list};

/// Reads a file of tools, checks it, and writes it in another format.
///
/// The file is a control's tool table, its offsets as a program, a CAM system's library or a presetter's table; or a CL
/// file, whose tools are those that it calls. Its format is what its text looks like; --from names another. `post --tools
/// FILE`, or `[tools] file` in the machine file, posts with its lengths.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post tools tool.tbl
  post tools TOOL.T --against part.cls
  post tools offsets.nc --from haas --units inch -o tool.tbl
  post tools presetter.csv --column number=T --column length=Z -o TOOL.T
  post tools part.cls
  post tools --formats

Exit codes: 0 the tools are good, and written if that was asked for; 1 refused, the messages say why;
2 the command line is wrong.")]
pub struct ToolsArguments {
    /// The file of tools, or a CL file.
    #[arg(value_name = "FILE", value_parser = file(), required_unless_present = "formats")]
    input: Option<PathArg>,

    /// Lists the formats, and what is taken of each.
    #[arg(long, exclusive = true)]
    formats: bool,

    /// Format of the file, if its text does not say it; `cl` is a CL file.
    #[arg(long, value_name = "FORMAT")]
    from: Option<String>,

    /// Units of its lengths, where its format does not say them. [default: mm]
    #[arg(long, value_name = "UNITS", value_parser = word::<UnitsWord, OutputUnits>())]
    units: Option<OutputUnits>,

    /// Length of the tool that its lengths count from, mm, where they were touched off against a tool of known length.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = finite)]
    reference: Option<f64>,

    /// Head of a column of a CSV table: number=T, length=Z, diameter, name and others. Repeatable.
    #[arg(long, value_name = "WHAT=HEAD", value_parser = column)]
    column: Vec<(String, String)>,

    /// Holds the tools against those that this CL file calls: each must be there, with the cutter that it says.
    #[arg(long, value_name = "CL-FILE", value_parser = file())]
    against: Option<PathArg>,

    /// Writes the tools, in the format of --to or of the file's ending; `-` is standard output.
    #[arg(short, long, value_name = "FILE", value_parser = file())]
    output: Option<PathArg>,

    /// Format of what is written.
    #[arg(long, value_name = "FORMAT", requires = "output")]
    to: Option<String>,

    /// Units of what is written. [default: mm]
    #[arg(long, value_name = "UNITS", requires = "output", value_parser = word::<UnitsWord, OutputUnits>())]
    to_units: Option<OutputUnits>,
}

/// `number=T`.
fn column(text: &str) -> Result<(String, String), String> {
    let (what, head) = text.split_once('=').ok_or("WHAT=HEAD is meant, as in number=T")?;
    Ok((what.trim().to_owned(), head.trim().to_owned()))
}

/// Lists, checks and writes as the arguments say.
pub fn run(session: &Session, arguments: &ToolsArguments) -> Result<(), CommandFault> {
    if arguments.formats {
        formats(session);
        return Ok(());
    }
    if arguments.input.as_ref().is_some_and(|input| input.path().is_none()) {
        let message = "a file of tools is named: its format follows from its name and text\n";
        return Err(CommandFault::Usage(clap::Error::raw(ErrorKind::InvalidValue, message)));
    }
    let listed = list(session, &request(arguments)).map_err(CommandFault::from)?;
    if !listed.printed {
        terminal::print(session, &text(&listed));
    }
    if listed.is_wrong() {
        return Err(Failure::Refused(listed.findings).into());
    }
    session.findings(&listed.findings);
    Ok(())
}

fn request(arguments: &ToolsArguments) -> ToolsRequest {
    let columns: BTreeMap<String, String> = arguments.column.iter().cloned().collect();
    ToolsRequest {
        input: arguments.input.clone(),
        from: arguments.from.clone(),
        inch: arguments.units == Some(OutputUnits::Inch),
        reference: arguments.reference.unwrap_or(0.0),
        columns,
        against: arguments.against.clone(),
        output: arguments.output.clone(),
        to: arguments.to.clone(),
        to_inch: arguments.to_units == Some(OutputUnits::Inch),
    }
}

fn formats(session: &Session) {
    let mut table =
        TextTable::headed(5, ["format", "written", "endings", "what it is", "what is taken"]);
    for format in FORMATS {
        let written = if format.write.is_some() { "yes" } else { "no" };
        let endings = or_dash((!format.endings.is_empty()).then(|| format.endings.join(" ")));
        table.row([format.name, written, &endings, format.about, format.has].map(str::to_owned));
    }
    terminal::print(session, &table.text());
}

/// A column of the table that is printed: its head, and its cell of a tool.
type ListColumn = (&'static str, fn(&ToolData) -> Option<String>);

/// Columns of texts stand in front.
const COLUMNS: [ListColumn; 10] = [
    ("name", |tool| some(&tool.name)),
    ("holder", |tool| some(&tool.holder)),
    ("length", |tool| tool.length.map(|length| number(length, 4))),
    ("wear", |tool| worn(tool.length_wear)),
    ("diameter", |tool| tool.radius.map(|radius| number(2.0 * radius, 4))),
    ("radius wear", |tool| worn(tool.radius_wear)),
    ("corner", |tool| {
        tool.corner_radius.filter(|corner| *corner != 0.0).map(|corner| number(corner, 4))
    }),
    ("stick-out", |tool| tool.stick_out.map(|length| number(length, 4))),
    ("most rpm", |tool| tool.most_rpm.map(|most| number(most, 0))),
    ("pocket", |tool| tool.pocket.map(|pocket| pocket.to_string())),
];

fn some(text: &str) -> Option<String> {
    Some(text.to_owned()).filter(|text| !text.is_empty())
}

fn worn(wear: f64) -> Option<String> {
    (wear != 0.0).then(|| number(wear, 4))
}

/// The tools, a row each, with the columns that something stands in; and what was written.
fn text(listed: &ListedTools) -> String {
    let tools = &listed.tools;
    let columns: Vec<&ListColumn> =
        COLUMNS.iter().filter(|(_, cell)| tools.iter().any(|tool| cell(tool).is_some())).collect();
    let texts = columns.iter().filter(|(head, _)| ["name", "holder"].contains(head)).count();
    let by_register = listed.format.is_some_and(|format| format.by_register);
    let first = if by_register { "register" } else { "tool" };
    let mut table = TextTable::new(1 + texts);
    let heads = columns.iter().map(|(head, _)| (*head).to_owned());
    table.row(std::iter::once(first.to_owned()).chain(heads).collect::<Vec<_>>());
    for tool in tools {
        let cells = columns.iter().map(|(_, cell)| or_dash(cell(tool)));
        table.row(std::iter::once(tool.number.to_string()).chain(cells).collect::<Vec<_>>());
    }
    let format = listed.format.map_or("tools that the CL file calls", |format| format.about);
    let count = tools.len();
    let count = format!("{count} tool{}", if count == 1 { "" } else { "s" });
    let mut text = format!("{}: {count}, mm; {format}\n\n{}", listed.name, table.text());
    if let Some(written) = listed.written {
        text.push_str(&format!("\nwritten: {}\n", written.about));
    }
    text
}
