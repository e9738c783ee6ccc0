//! The sheet for whoever sets the machine up: Markdown, or HTML.

mod picture;

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_grammar::text::as_remark;
use post_machine::axis_words;
use post_machine::description::{LengthAxis, Machine, OptionValue, OutputUnits, ToolData};
use post_posting::program::ToolChange;
use post_posting::report::{LengthSource, PostingReport};
use post_posting::{OperationWork, ProgramPreview};
use post_report::document::escaped;

use post_job::files::PathArg;
use post_job::text::{clock, number};

/// A table of the sheet.
struct SheetTable {
    title: String,
    head: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

/// What a sheet is of.
pub struct SheetJob<'a> {
    /// The machine, as it is set up.
    pub machine: &'a Machine,
    /// The CL files, in their order.
    pub cl_files: Vec<&'a PathArg>,
    /// What a program of chosen operations says of the others.
    pub left_out: Option<String>,
    /// The work offset that the programs are in where the CL file names none; none where the operator chooses it.
    pub work_offset: Option<String>,
    /// What the programs rely on at the control, a sentence each.
    pub relies_on: Vec<String>,
    /// What a first pass found out.
    pub ahead: &'a ProgramPreview,
}

impl SheetJob<'_> {
    /// The names of the CL files.
    fn names(&self) -> Vec<String> {
        let names = self.cl_files.iter().filter_map(|file| file.path()?.file_name());
        names.map(|name| name.to_string_lossy().into_owned()).collect()
    }
}

/// The sheet of programs that were made of CL files.
pub fn text(
    sheet: &PathArg,
    job: &SheetJob<'_>,
    programs: &[(&PathArg, &PostingReport)],
) -> String {
    let SheetJob { machine, ahead, .. } = *job;
    let names = job.names().join(", ");
    let title = match names.is_empty() {
        true => "Setup".to_owned(),
        false => format!("Setup: {names}"),
    };
    let sections = [
        the_machine(job, programs),
        the_programs(programs),
        the_tools(machine, ahead, programs),
        the_operations(job),
        for_the_operator(job),
        the_axes(programs),
        what_holds_at_the_control(job),
        the_options(machine),
    ];
    let html = sheet.path().and_then(|path| path.extension());
    let html = html.is_some_and(|ending| ending == "html" || ending == "htm");
    match html {
        true => as_html(&title, &sections, &picture::svg(ahead)),
        false => as_markdown(&title, &sections),
    }
}

fn the_machine(job: &SheetJob<'_>, programs: &[(&PathArg, &PostingReport)]) -> SheetTable {
    let SheetJob { machine, ahead, .. } = *job;
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push(vec![name.to_owned(), value]);
    row("Machine", machine.name.clone());
    if let Some(left_out) = &job.left_out {
        row("The program", left_out.clone());
    }
    row(
        "Control",
        format!("{}, {} keeps the tip", machine.control.dialect, machine.control.tcp.name()),
    );
    let units = match machine.control.units {
        OutputUnits::Mm => "mm",
        OutputUnits::Inch => "inch",
    };
    row("Units of the program", units.to_owned());
    let [x, y, z] =
        [machine.mount.x, machine.mount.y, machine.mount.z].map(|value| number(value, 3));
    row("Part origin, all axes at zero", format!("X {x}, Y {y}, Z {z} mm in the machine frame"));
    let named = job.work_offset.clone();
    row("Work offset of the program", named.unwrap_or("the one that is in force".to_owned()));
    if let Some(offset) = axis_words::work_offset(machine) {
        let axes: Vec<String> =
            offset.iter().map(|(name, value)| format!("{name} {}", number(*value, 3))).collect();
        row("Its values for that part origin", format!("{} mm, without a tool", axes.join(", ")));
    }
    row(
        "The program holds",
        match machine.holds_on_mount_alone() {
            true if machine.clearance.shortens_ways() => "for the part origin there alone: ways between passes are those that bodies leave",
            true if machine.errs() => "for the part origin there alone: errors that depend on position are taken out of the words",
            true => "for the part origin there alone: a table turns the part, and the words are axis positions",
            false => "wherever the work offset is measured; travel was checked with the part origin there",
        }
        .to_owned(),
    );
    if machine.holds_on_length_alone() {
        let why = match (machine.words_hold_on_length_alone(), machine.errs()) {
            (false, _) => "ways between passes are those that bodies leave",
            (true, true) => "errors that depend on position are taken out of the words",
            (true, false) => "a head turns the tool, and the words are axis positions",
        };
        let words = format!(
            "of the lengths below alone: {why}; a tool that is measured otherwise is posted again"
        );
        row("The program holds for tools", words);
    }
    if machine.length_axis == LengthAxis::None {
        row("Length registers", NO_LENGTH.to_owned());
    }
    for head in machine.named_heads() {
        if head.machine.length_axis == LengthAxis::None && machine.length_axis != LengthAxis::None {
            row(&format!("Length registers with head {}", head.name), NO_LENGTH.to_owned());
        }
        if let Some(offset) = head.offset {
            let name = format!("Work offset of head {}", head.name);
            row(&name, format!("number {offset} (1 is G54), measured with it"));
        }
    }
    if machine.turn != 0.0 {
        row("Part turned about its Z", format!("{}°", number(machine.turn.to_degrees(), 3)));
    }
    if let Some([least, most]) = ahead.extents {
        let range =
            |axis: usize| format!("{} to {}", number(least[axis], 3), number(most[axis], 3));
        row("Tip in the part frame", format!("X {}, Y {}, Z {} mm", range(0), range(1), range(2)));
    }
    if let Some(time) = ahead.time_s {
        row("Time without tool changes", clock(time));
    }
    if let Some((_, report)) = programs.first() {
        row(
            "Certified",
            format!(
                "tip within {} mm, tool axis within {}° of the CL file",
                report.tolerance_mm,
                number(report.axis_tolerance_deg, 4)
            ),
        );
        for plugin in &report.plugins {
            let origin = match &plugin.hash {
                Some(hash) => format!(", {hash}"),
                None => String::new(),
            };
            row("Plugin", format!("{} {}{origin}", plugin.name, plugin.version));
        }
    }
    SheetTable { title: "Machine and part".to_owned(), head: vec!["", ""], rows }
}

fn the_programs(programs: &[(&PathArg, &PostingReport)]) -> SheetTable {
    let rows = programs.iter().map(|(target, report)| {
        let name = target.path().and_then(|path| path.file_name());
        let tools: Vec<String> =
            report.tools.iter().filter_map(|tool| Some(tool.number?.to_string())).collect();
        vec![
            name.map_or("standard output".to_owned(), |name| name.to_string_lossy().into_owned()),
            report.nc_lines.to_string(),
            tools.join(", "),
            clock(report.time_s),
            clock(report.cutting_time_s),
        ]
    });
    SheetTable {
        title: "Programs".to_owned(),
        head: vec!["File", "Lines", "Tools", "Time", "Cutting"],
        rows: rows.collect(),
    }
}

/// What stands in the registers where the control must not put a length along an axis that the tool does not lie along.
const NO_LENGTH: &str = "0, not the length below: the work offset was measured with the tool in it";

fn the_tools(
    machine: &Machine,
    ahead: &ProgramPreview,
    programs: &[(&PathArg, &PostingReport)],
) -> SheetTable {
    let size = |value: Option<f64>| value.map_or("?".to_owned(), |value| number(value, 3));
    let used = |tool: &ToolChange| {
        let tools = programs.iter().flat_map(|(_, report)| &report.tools);
        tools.into_iter().find(|used| used.number == Some(tool.number))
    };
    let rows = ahead.tools().into_iter().map(|tool| {
        let length = match used(tool) {
            Some(used) if used.source != LengthSource::Unknown => number(used.length_mm, 3),
            _ => "?".to_owned(),
        };
        let table = machine.tool_table.as_ref();
        let listed = table.and_then(|table| table.entry(tool.number, tool.register));
        let own = |text: fn(&ToolData) -> &str| listed.map_or("", text).to_owned();
        let work: Vec<&OperationWork> =
            ahead.work.iter().filter(|work| work.tool == Some(tool.number)).collect();
        let radius = work.iter().find_map(|work| work.radius_register);
        vec![
            tool.number.to_string(),
            tool.register.to_string(),
            radius.map_or(String::new(), |register| register.to_string()),
            if tool.name.is_empty() { own(|tool| &tool.name) } else { tool.name.clone() },
            own(|tool| &tool.holder),
            length,
            listed.and_then(|tool| tool.stick_out).map_or(String::new(), |out| number(out, 3)),
            size(tool.diameter.or_else(|| listed?.diameter())),
            size(tool.corner_radius.or_else(|| listed?.corner_radius)),
            lowest(&work),
            clock(work.iter().map(|work| work.time_s).sum()),
        ]
    });
    SheetTable {
        title: "Tools".to_owned(),
        head: vec![
            "T",
            "H",
            "D",
            "Name",
            "Holder",
            "Length, mm",
            "Stick-out, mm",
            "Diameter, mm",
            "Corner, mm",
            "Lowest Z, mm",
            "Time",
        ],
        rows: rows.collect(),
    }
}

/// The lowest place of the tip in cuts, in the part frame.
fn lowest(work: &[&OperationWork]) -> String {
    let lowest = work.iter().filter_map(|work| work.lowest).reduce(f64::min);
    lowest.map_or(String::new(), |lowest| number(lowest, 3))
}

/// A tool axis in words.
fn direction(axis: &Vector3<f64>) -> String {
    let [i, j, k] = [axis.x, axis.y, axis.z].map(|part| number(part, 6));
    if axis.z > 1.0 - 1e-12 { "upright".to_owned() } else { format!("{i}, {j}, {k}") }
}

fn the_operations(job: &SheetJob<'_>) -> SheetTable {
    let optional = |value: Option<u32>| value.map_or(String::new(), |value| value.to_string());
    let offset = |work: &OperationWork| match work.work_offset {
        Some(number) => format!("number {number} (1 is G54)"),
        None => job.work_offset.clone().unwrap_or_default(),
    };
    let rows = job.ahead.work.iter().zip(1..).map(|(work, place): (_, u32)| {
        vec![
            place.to_string(),
            work.name.clone(),
            optional(work.tool),
            optional(work.radius_register),
            offset(work),
            work.spindle.map_or(String::new(), |rpm| number(rpm, 0)),
            match work.turns {
                true => "turns".to_owned(),
                false => work.axes.iter().map(direction).collect::<Vec<_>>().join("; "),
            },
            lowest(&[work]),
            clock(work.time_s),
        ]
    });
    SheetTable {
        title: "Operations".to_owned(),
        head: vec![
            "",
            "Operation",
            "T",
            "D",
            "Work offset",
            "Spindle, 1/min",
            "Tool axis (I, J, K)",
            "Lowest Z, mm",
            "Time",
        ],
        rows: rows.collect(),
    }
}

/// What the CL file tells the operator.
fn for_the_operator(job: &SheetJob<'_>) -> SheetTable {
    // Where files are joined their names stand between them.
    let joins: Vec<String> = job.names().into_iter().skip(1).map(as_remark).collect();
    let of = |(work, place): (&OperationWork, u32)| {
        let row = move |note: &String| vec![place.to_string(), note.clone()];
        let notes = work.notes.iter().filter(|note| !joins.contains(note));
        notes.map(row).collect::<Vec<_>>()
    };
    SheetTable {
        title: "For the operator".to_owned(),
        head: vec!["Operation", "What the CL file says"],
        rows: job.ahead.work.iter().zip(1..).flat_map(of).collect(),
    }
}

fn the_axes(programs: &[(&PathArg, &PostingReport)]) -> SheetTable {
    let mut rows: Vec<(String, f64, f64, Option<[f64; 2]>)> = Vec::new();
    for axis in programs.iter().flat_map(|(_, report)| &report.axes) {
        if axis.min > axis.max {
            continue;
        }
        match rows.iter_mut().find(|(name, ..)| *name == axis.name) {
            Some((_, min, max, _)) => (*min, *max) = (min.min(axis.min), max.max(axis.max)),
            None => rows.push((axis.name.clone(), axis.min, axis.max, axis.travel)),
        }
    }
    let rows = rows.into_iter().map(|(name, min, max, travel)| {
        let travel = match travel {
            Some([min, max]) => format!("{} to {}", number(min, 3), number(max, 3)),
            None => "endless".to_owned(),
        };
        vec![name, format!("{} to {}", number(min, 3), number(max, 3)), travel]
    });
    SheetTable {
        title: "Axes, in machine coordinates".to_owned(),
        head: vec!["Axis", "Used", "Travel"],
        rows: rows.collect(),
    }
}

/// Parameters and options of the control that the programs rely on, as their dialect tells them.
fn what_holds_at_the_control(job: &SheetJob<'_>) -> SheetTable {
    SheetTable {
        title: "The program relies on".to_owned(),
        head: vec![""],
        rows: job.relies_on.iter().map(|sentence| vec![sentence.clone()]).collect(),
    }
}

fn the_options(machine: &Machine) -> SheetTable {
    let rows = machine.control.options.iter().map(|option| {
        let value = match &option.value {
            OptionValue::Flag(flag) => flag.to_string(),
            OptionValue::Integer(number) => number.to_string(),
            OptionValue::Number(number) => number.to_string(),
            OptionValue::Text(text) => text.replace('\n', " / "),
        };
        vec![option.key.clone(), value]
    });
    SheetTable {
        title: format!("What the machine file says of its control ({})", machine.control.dialect),
        head: vec!["Option", "Value"],
        rows: rows.collect(),
    }
}

/// Pipes would end a cell.
fn as_markdown(title: &str, sections: &[SheetTable]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let plain = |text: &str| text.replace('|', "\\|").replace('<', "&lt;");
    let mut text = format!("# {}\n", plain(title));
    for section in sections.iter().filter(|section| !section.rows.is_empty()) {
        // Writing to a String cannot fail.
        let _ = write!(text, "\n## {}\n\n", plain(&section.title));
        text += &line(section.head.iter().map(|cell| (*cell).to_owned()).collect());
        text += &line(section.head.iter().map(|_| "---".to_owned()).collect());
        for row in &section.rows {
            text += &line(row.iter().map(|cell| plain(cell)).collect());
        }
    }
    text
}

/// How it looks, on a screen and on two pages of paper.
const STYLE: &str = "@page { size: A4; margin: 12mm } body { font: 11pt sans-serif; max-width: 60em; margin: 1em auto; padding: 0 1em } \
     table { border-collapse: collapse } td, th { border: 1px solid #999; padding: .2em .6em; text-align: left } \
     tr, svg { break-inside: avoid } h2 { break-after: avoid; font-size: 1.15em; margin: 1em 0 .3em } svg { max-width: 100%; height: auto } \
     @media print { body { font-size: 8.5pt; margin: 0; padding: 0; max-width: none } td, th { padding: .1em .4em } }";

fn as_html(title: &str, sections: &[SheetTable], picture: &str) -> String {
    let row = |cells: &mut dyn Iterator<Item = &str>, kind: &str| {
        let cells: String =
            cells.map(|cell| format!("<{kind}>{}</{kind}>", escaped(cell))).collect();
        format!("<tr>{cells}</tr>\n")
    };
    let title = escaped(title);
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{title}</title>\n<style>{STYLE}</style>\n\
         <h1>{title}</h1>\n{picture}"
    );
    for section in sections.iter().filter(|section| !section.rows.is_empty()) {
        // Writing to a String cannot fail.
        let _ = write!(text, "<h2>{}</h2>\n<table>\n", escaped(&section.title));
        if section.head.iter().any(|cell| !cell.is_empty()) {
            text += &row(&mut section.head.iter().copied(), "th");
        }
        for cells in &section.rows {
            text += &row(&mut cells.iter().map(String::as_str), "td");
        }
        text += "</table>\n";
    }
    text
}
