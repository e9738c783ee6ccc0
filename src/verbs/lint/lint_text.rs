//! The table of what was looked over.

use post_job::lint::LintedProgram;
use post_job::text::clock;
use post_job::text_table::NamedValues;
use post_machine::description::Machine;
use post_machine::diagnostic::Severity;

/// What was found of the program `name`, as lines.
pub fn text(machine: &Machine, name: &str, linted: &LintedProgram<'_>) -> String {
    let mut rows = NamedValues::default();
    rows.row("program", format_args!("{name}, {} blocks", linted.report.blocks));
    rows.row("machine", format_args!("{} ({})", machine.name, machine.control.dialect));
    let [rapids, feeds, threads] = linted.survey.motions;
    rows.row("motions", format_args!("{rapids} rapid, {} at feed", feeds + threads));
    rows.row("time at the stated feeds", clock(linted.seconds()));
    if let Some(predicted) = linted.predicted {
        rows.row("time as predicted", clock(predicted));
    }
    let count = |severity| {
        let findings = linted.findings.iter();
        findings.filter(|finding| finding.severity == severity).count()
    };
    rows.row("errors", count(Severity::Error));
    rows.row("warnings", count(Severity::Warning));
    if !linted.ignored.is_empty() {
        let ignored = linted.ignored.iter().map(|(code, count)| format!("{count} {code}"));
        rows.row("not told", ignored.collect::<Vec<_>>().join(", "));
    }
    rows.table()
}

/// Files that are no programs, as a line.
pub fn left_out(headers: &[String]) -> String {
    let mut rows = NamedValues::default();
    rows.row(
        "no programs",
        format_args!("{}: no block of Klartext stands there", headers.join(", ")),
    );
    rows.table()
}
