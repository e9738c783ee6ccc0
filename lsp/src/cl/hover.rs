//! What is said of a line of a CL file.

use post_grammar::{ClReader, MajorWord};

use super::{Posted, posted};
use crate::document::Snapshot;
use crate::readings;
use post_job::text::{at_most, number};

/// Lines over which a record may be parted that is looked at.
const MOST_PARTS: usize = 50;

/// The record that a line belongs to: its first line, counted from 0, and its text.
pub(super) fn record(of: &Snapshot, line: usize) -> (usize, &str) {
    let text = |line: usize| &of.text[of.lines.span(&of.text, line)];
    let goes_on = |line: usize| {
        let text = text(line).trim_ascii_end();
        text.ends_with('$') && !text.contains("$$")
    };
    let mut first = line;
    while first > 0 && line - first < MOST_PARTS && goes_on(first - 1) {
        first -= 1;
    }
    let mut last = line;
    while last + 1 < of.lines.count() && last - line < MOST_PARTS && goes_on(last) {
        last += 1;
    }
    let start = of.lines.span(&of.text, first).start;
    let end = of.lines.span(&of.text, last).end;
    (first, &of.text[start..end])
}

/// What is said of a line, counted from 0, in Markdown. `machine` says why nothing is known of the axes yet.
pub fn text(
    of: &Snapshot,
    line: usize,
    posted: Option<&Posted>,
    machine: Option<&str>,
) -> Option<String> {
    let (first, text) = record(of, line);
    let mut reader = ClReader::new(text.as_bytes());
    let record = reader.next_record().ok()??;
    let word = record.statement.word().to_owned();
    let mut said = format!("**{word}**");
    if let Some(known) = MajorWord::find(&word) {
        said.push_str(&format!(" ({}): {}", record.statement.usage().name(), known.meaning));
        if known.spellings.len() > 1 {
            said.push_str(&format!("\n\nalso spelt {}", known.spellings[1..].join(", ")));
        }
    }
    let Some(posted) = posted else {
        said.push_str(&match machine {
            Some(machine) => format!("\n\nOn {machine}: not posted yet."),
            None => {
                "\n\nThe setting `post.machine` names the machine whose axis values are shown here."
                    .to_owned()
            }
        });
        return Some(said);
    };
    if let Some(line) = posted.line(first as u64 + 1) {
        said.push_str(&format!("\n\n{}", on_machine(posted, line)));
    }
    said.push_str(refused(posted));
    Some(said)
}

/// What is said of a line of a list of points, counted from 0; none where no point is.
pub fn of_point(line: usize, posted: &Posted) -> Option<String> {
    let point = posted.line(line as u64 + 1)?;
    Some(format!("{}{}", on_machine(posted, point), refused(posted)))
}

fn refused(posted: &Posted) -> &'static str {
    match posted.refused {
        true => "\n\nThe program is refused, see the messages.",
        false => "",
    }
}

fn on_machine(posted: &Posted, line: &posted::PostedLine) -> String {
    let [tip, axis] = line.deviation;
    let blocks = match line.blocks {
        1 => "1 block".to_owned(),
        count => format!("{count} blocks"),
    };
    let mut text = format!(
        "On {}: `{}`\n\n{blocks}, {} s; certified: tip {} mm, tool axis {}°",
        posted.machine.name,
        readings::text(&posted.machine, &line.joints),
        number(line.minutes * 60.0, 3),
        at_most(tip, 6),
        at_most(axis.to_degrees(), 5),
    );
    if let Some(limit) = line.limit {
        text.push_str(&format!("; slower than asked for: {limit}"));
    }
    text
}
