//! What a study came to, for people.

use std::fmt::Write as _;

use post_job::batch::{FAILED, REFUSED, StudyTable, StudyValues, WRITTEN};
use post_job::files::PathArg;
use post_job::text::clock;

/// So many codes are told.
const MOST_CODES: usize = 6;

/// How many jobs there were, what became of them, and the fastest.
pub fn text(table: &StudyTable, known: usize, output: &PathArg) -> String {
    let count =
        |state: &str| (0..table.rows).filter(|row| cell(table, "state", *row) == state).count();
    let mut text = format!("{} jobs: {} written", table.rows, count(WRITTEN));
    for state in [REFUSED, FAILED] {
        let rows = count(state);
        if rows > 0 {
            // Writing to a String cannot fail.
            let _ = write!(text, ", {rows} {state} ({})", codes(table, state));
        }
    }
    if known > 0 {
        let _ = write!(text, "; {known} taken from the journal");
    }
    text.push('\n');
    if let Some(failed) = (0..table.rows).find(|row| cell(table, "state", *row) != WRITTEN) {
        let _ = writeln!(
            text,
            "first refused: {}: {}",
            job(table, failed),
            cell(table, "message", failed)
        );
    }
    let time = ["predicted_cycle_time_s", "cycle_time_s"]
        .into_iter()
        .find_map(|name| Some((name, table.column(name)?)));
    if let Some((name, times)) = time {
        let rows = (0..table.rows).filter(|row| cell(table, "state", *row) == WRITTEN);
        let times = rows.filter_map(|row| Some((times.number(row)?, row)));
        // Of several that take as long the first.
        if let Some((time, row)) = times.min_by(|one, other| one.0.total_cmp(&other.0)) {
            let least = clock(time);
            let _ = writeln!(text, "least {name}: {least}, {}", job(table, row));
        }
    }
    if let Some(path) = output.path() {
        let _ = writeln!(text, "results: {}", path.display());
    }
    text
}

/// File, machine and parameters of a row: what stands before its state.
fn job(table: &StudyTable, row: usize) -> String {
    let columns = table.columns.iter().skip(1);
    let columns = columns.take_while(|column| column.name != "state");
    let told = columns.filter_map(|column| {
        let text = column.values.text(row);
        match column.name.as_str() {
            _ if text.is_empty() => None,
            "file" => Some(text),
            "machine" => Some(format!("on {text}")),
            name => Some(format!("{name} {text}")),
        }
    });
    told.collect::<Vec<_>>().join(", ")
}

fn cell(table: &StudyTable, name: &str, row: usize) -> String {
    table.column(name).map(|values: &StudyValues| values.text(row)).unwrap_or_default()
}

/// The codes of the rows in a state, each with how often.
fn codes(table: &StudyTable, state: &str) -> String {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for row in 0..table.rows {
        if cell(table, "state", row) != state {
            continue;
        }
        for code in cell(table, "codes", row).split(' ') {
            match counts.iter_mut().find(|(known, _)| known == code) {
                Some((_, count)) => *count += 1,
                None => counts.push((code.to_owned(), 1)),
            }
        }
    }
    counts.sort_by(|one, other| other.1.cmp(&one.1).then_with(|| one.0.cmp(&other.0)));
    let told = counts.iter().take(MOST_CODES);
    let mut told: Vec<String> = told.map(|(code, count)| format!("{code} {count}")).collect();
    if counts.len() > MOST_CODES {
        told.push("…".to_owned());
    }
    told.join(", ")
}
