//! What was found, for people: the mount, the way to it, and what is left of each axis.

use std::ffi::OsString;
use std::fmt::Write as _;

use post_posting::report::AxisRange;

use super::PlaceArguments;
use post_job::clearance::ClearanceSummary;
use post_job::place::{Least, MountSearchResult, Trial, mount_text};
use post_job::text::{clock, number};
use post_job::text_table::{NamedValues, TextTable};

/// Flags of this verb, which posting does not take, those that the answer takes the place of, and those that change nothing
/// of the program: each with whether its value may stand in a word of its own.
const OWN: [(&str, bool); 9] = [
    ("--least", true),
    ("--margin", true),
    ("--search-turn", false),
    ("--runs", true),
    ("--svg", true),
    ("--mount", true),
    ("--turn", true),
    ("--jobs", true),
    ("-j", true),
];

/// The text.
pub fn text(arguments: &PlaceArguments, found: &MountSearchResult) -> String {
    let mut rows = NamedValues::default();
    let best = &found.best;
    rows.row("file", format_args!("{}, {} moves", found.file, best.report.moves));
    rows.row(
        "machine",
        format_args!("{}, the {} keeps the tip", best.report.machine, best.report.tcp),
    );
    rows.row("seat", seat_text(arguments, found, best));
    rows.row("why", why(arguments, found));
    let before =
        found.present.as_ref().filter(|present| present.seat != best.seat).map(|present| {
            format!("; {} with {}", cost(arguments, present), seat_text(arguments, found, present))
        });
    rows.row(
        match arguments.least {
            Least::Time => "time",
            Least::Rotary => "turns",
        },
        format_args!("{}{}", cost(arguments, best), before.unwrap_or_default()),
    );
    rows.row_if("clearance", best.clearance.as_ref().map(ClearanceSummary::fact));
    let mut text = rows.lines(10);
    table(&best.report.axes).below(&mut text);
    // Writing to a String cannot fail.
    let _ =
        writeln!(text, "\n{}", command(&seat_text(arguments, found, best), std::env::args_os()));
    text
}

/// `--mount X,Y,Z --turn DEG`; without a turn only where nobody has spoken of one.
fn seat_text(arguments: &PlaceArguments, found: &MountSearchResult, trial: &Trial) -> String {
    let mount = format!("--mount {}", mount_text(&trial.seat.mount));
    let turn = trial.seat.turn;
    if turn == 0.0 && found.machine.turn == 0.0 && arguments.job.settings().over.turn.is_none() {
        mount
    } else {
        format!("{mount} --turn {turn}")
    }
}

fn cost(arguments: &PlaceArguments, trial: &Trial) -> String {
    match arguments.least {
        Least::Time => clock(trial.cost),
        Least::Rotary => format!("{}° of all rotary axes", number(trial.cost, 1)),
    }
}

fn why(arguments: &PlaceArguments, found: &MountSearchResult) -> String {
    let stays = found.present.as_ref().map(|present| present.seat) == Some(found.best.seat);
    let fits = match (stays, &found.present) {
        (true, _) => "where the part sits now nothing leaves its travel, and",
        (false, Some(_)) => "there every axis stays inside travel, and",
        (false, None) if found.hits_here => {
            "where the part sits now it is not proven that nothing hits anything; there it is, and"
        }
        (false, None) => "where the part sits now an axis leaves its travel; there none does, and",
    };
    let least = match arguments.least {
        Least::Time if found.evenly && arguments.search_turn.is_none() => {
            "time is the same wherever the part sits".to_owned()
        }
        Least::Time => "no mount that was tried takes less time".to_owned(),
        Least::Rotary => "nothing that was tried turns the axes less".to_owned(),
    };
    let spent = if found.spent { "; --runs ended the search" } else { "" };
    format!(
        "{fits} {least} ({} dry runs, linear axes {} mm from their ends{spent})",
        found.runs, arguments.margin
    )
}

/// What of each axis is used and left.
fn table(axes: &[AxisRange]) -> TextTable {
    let mut table = TextTable::headed(1, ["axis", "travel", "used", "left below", "left above"]);
    for axis in axes.iter().filter(|axis| axis.min <= axis.max) {
        let short = |value: f64| number(value, 3);
        let span = |[from, to]: [f64; 2]| format!("{} to {}", short(from), short(to));
        let [below, above] = match axis.travel {
            Some([least, most]) => [short(axis.min - least), short(most - axis.max)],
            None => [String::new(), String::new()],
        };
        table.row([
            axis.name.clone(),
            axis.travel.map_or("endless".to_owned(), span),
            span([axis.min, axis.max]),
            below,
            above,
        ]);
    }
    table
}

/// The command that posts the file there: that of this run without what is this verb's own.
fn command(seat: &str, arguments: impl Iterator<Item = OsString>) -> String {
    let mut words: Vec<String> = Vec::new();
    // What stands behind `--` is a file, whatever it begins with.
    let mut files: Vec<String> = Vec::new();
    let mut skip = false;
    let mut verb = false;
    for word in arguments.skip(1) {
        let word = word.to_string_lossy().into_owned();
        if std::mem::take(&mut skip) {
            continue;
        }
        if word == "--" || !files.is_empty() {
            files.push(quoted(&word));
            continue;
        }
        if !verb && word == "place" {
            verb = true;
            continue;
        }
        // A value may stand behind a short flag.
        let flag = match word.starts_with("-j") {
            true => "-j",
            false => word.split('=').next().unwrap_or_default(),
        };
        match OWN.iter().find(|(own, _)| *own == flag) {
            Some((_, value)) => skip = *value && word == flag,
            None => words.push(quoted(&word)),
        }
    }
    words.push(seat.to_owned());
    words.append(&mut files);
    format!("post {}", words.join(" "))
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |sign: char| sign.is_ascii_alphanumeric() || "-_./=,:+@%".contains(sign);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
