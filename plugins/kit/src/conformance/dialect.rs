//! Dialects on a short five-axis program. What a control should say is its author's; that every event becomes
//! whole lines of finite numbers, the same however the program is cut into batches, and that nothing of it is left
//! out, is the kit's.

use post_host::{GivenValue, Plugin, PluginFault, ProgramSetup, ProgramWord};
use post_plugin::{
    Coolant, DialectSession as _, Event, Format, Lengths, Meaning, Spindle, Units, WriteFault,
};

use super::Case;
use super::commands::commands;
use super::declared::declared;
use super::options::{options_of, switches_of};
use super::pen::{BEGIN, Pen, rounded, wordless};
use super::print::{edges, moves};
use super::runs::runs;
use super::sessions::{after_a_refusal, two_at_once, two_threads};
use super::texts::remarks;
use crate::{at, cut, rapid, turn, turning};

/// A kind of event that no version of the contract has.
pub(super) const UNKNOWN: Event<'static> = Event::Unknown { kind: 60_000 };

/// The last kind that every dialect is sent; those behind it must be declared.
pub const LAST: u32 = Event::Word { text: "" }.kind();

/// Cuts in the program.
pub const CUTS: usize = 40;

/// What runs a case and notes what it finds.
type CaseRun = fn(&Pen<'_>, &mut Case) -> Result<(), PluginFault>;

/// The cases in the order in which they are run, behind those of the whole program.
const CASES: &[(&str, CaseRun)] = &[
    ("words and feeds", moves),
    ("rounding edges", edges),
    ("commands", commands),
    ("remarks", remarks),
    ("declared", declared),
    ("runs of cuts", runs),
    ("axis names", axis_names),
    ("unknown event", unknown_event),
    ("every event", every_event),
    ("vocabulary", vocabulary),
    ("options", options_of),
    ("no tool pose", no_tool_pose),
    ("after a refusal", after_a_refusal),
    ("two at once", two_at_once),
];

/// Runs all cases; the longest program has so many events.
pub(super) fn test(
    plugin: &Plugin,
    options: &[(String, GivenValue)],
    most: usize,
) -> Result<Vec<Case>, PluginFault> {
    let mut setup = five_axes(options);
    let mut case = Case::named("program");
    if let Err(fault) = plugin.dialect(&setup) {
        // A control that always keeps the tip, or a dialect for nothing else.
        setup.tcp = true;
        if plugin.dialect(&setup).is_err() {
            return Err(fault);
        }
        case.note(format!("all cases are under TCP, since it refuses to open without: {fault}"));
    }
    let format = plugin.dialect(&setup)?.format().clone();
    let mut left_out = Vec::new();
    let text = program(plugin, &setup, &format, &mut left_out, &mut case)?;
    let mut cases = vec![case];
    let Some(text) = text else {
        return Ok(cases);
    };

    let pen = Pen { plugin, setup: &setup, left_out: &left_out };
    let positions = positions(&format);
    let events = events(&positions, &left_out);
    for (name, batch) in [("again", usize::MAX), ("one by one", 1), ("by sevens", 7)] {
        cases.push(same(name, &text, pen.write_batches(&events, batch)?));
    }
    for (name, run) in CASES {
        let mut case = Case::named(name);
        run(&pen, &mut case)?;
        cases.push(case);
    }
    let mut case = Case::named("two threads");
    two_threads(&pen, &mut case, most)?;
    cases.push(case);

    for (name, what, tcp, units) in [
        ("with TCP", "tcp", true, Units::Millimetre),
        ("in inches", "units", setup.tcp, Units::Inch),
    ] {
        if (tcp, units) == (setup.tcp, setup.units) {
            continue;
        }
        let mut case = Case::named(name);
        let setup = ProgramSetup { tcp, units, ..setup.clone() };
        let other = Pen { setup: &setup, ..pen };
        otherwise(&other, &pen, what, &mut case)?;
        let told = |sentence: &String| cases.iter().any(|case| case.wrong.contains(sentence));
        case.wrong.retain(|sentence| !told(sentence));
        cases.push(case);
    }
    Ok(cases)
}

/// A machine that turns the part, in millimetres, the axes positioned without tool centre point control.
fn five_axes(options: &[(String, GivenValue)]) -> ProgramSetup {
    ProgramSetup {
        program: "kit".to_owned(),
        machine: "five axes".to_owned(),
        words: ["X", "Y", "Z", "A", "C"]
            .map(|name| ProgramWord {
                name: name.to_owned(),
                rotary: name == "A" || name == "C",
                depth: name == "Z",
                carries_part: name == "A" || name == "C",
                // Words of axes without ends may say less than how many turns they have made.
                travel: Some([-1e6, 1e6]),
                ..ProgramWord::default()
            })
            .to_vec(),
        options: options.to_owned(),
        ..ProgramSetup::default()
    }
}

/// Under another setting than the `plain` program's, if it opens there: the program says so to the control, and what is
/// written holds there too.
fn otherwise(
    pen: &Pen<'_>,
    plain: &Pen<'_>,
    what: &str,
    case: &mut Case,
) -> Result<(), PluginFault> {
    let format = match pen.open() {
        Ok(opened) => opened.format().clone(),
        Err(fault) => {
            case.note(format!("it refuses to open: {fault}"));
            return Ok(());
        }
    };
    let mut left_out = pen.left_out.to_vec();
    if program(pen.plugin, pen.setup, &format, &mut left_out, case)?.is_none() {
        return Ok(());
    }
    let pen = Pen { left_out: &left_out, ..*pen };
    if begin(&pen)? == begin(plain)? {
        case.wrong(format!(
            "the program begins as it does without: it must say so to the control, or refuse to open ({what})"
        ));
    }
    moves(&pen, case)?;
    commands(&pen, case)?;
    if pen.setup.tcp != plain.setup.tcp {
        let mut own = Case::named("");
        no_tool_pose(&pen, case)?;
        switches_of(&pen, &mut own)?;
        // What an option changes without it was said there.
        case.wrong.append(&mut own.wrong);
    }
    declared(&pen, case)
}

/// From the start to the first position: where units and tool centre point control are switched.
fn begin(pen: &Pen<'_>) -> Result<Option<String>, PluginFault> {
    let written = pen.write(&[BEGIN, &[at(&[0.0; 5])]])?;
    // Decimals apart, which an inch program may have more of.
    Ok(written.ok().map(|written| written.text.replace(['0', '.'], "")))
}

/// A name with a number, as `X1`: refused, or told from the value behind it.
fn axis_names(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let mut setup = pen.setup.clone();
    setup.words[0].name = "X1".to_owned();
    let pen = Pen { setup: &setup, ..*pen };
    if pen.open().is_err() {
        return Ok(());
    }
    if let Ok(written) = pen.write(&[BEGIN, &[at(&[450.0, -12.0, 7.0, 30.0, 40.0])]])?
        && let Some(at) = written.text.find("X1")
        && let Some(word) = written.text[at..].split_whitespace().next()
        && word[2..].starts_with(|next: char| next.is_ascii_digit() || "+-.".contains(next))
    {
        case.wrong(format!(
            "an axis called X1 is written `{word}`, which is a value of X: it must refuse the axis"
        ));
    }
    Ok(())
}

/// Where nobody knows how the tool stands: written by the words, or refused.
fn no_tool_pose(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let moves = [turn(&[0.0; 5]), at(&[0.0; 5]), cut(&[1.0; 5], 500.0)];
    if let Err(fault) = pen.write_unposed(&[BEGIN, &moves])? {
        case.note(format!("where nobody knows how the tool stands: {fault}"));
    }
    Ok(())
}

/// An event of a kind that nobody knows is refused.
fn unknown_event(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    if let Ok(text) = pen.write_batches(&[Event::Start, UNKNOWN], usize::MAX)? {
        let lines = text.lines().count();
        let kind = UNKNOWN.kind();
        case.wrong(format!(
            "an event of kind {kind} is taken for granted ({lines} lines): it must be refused"
        ));
    }
    Ok(())
}

/// The words that it tells hold together, and with what it declares of its registers; none are told by many.
fn vocabulary(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let mut opened = pen.open()?;
    let (language, lengths) = (opened.format().language, opened.capabilities().lengths());
    match opened.vocabulary() {
        Ok(words) if words.is_empty() => {
            case.note("it tells none: its programs cannot be read back".to_owned());
        }
        Ok(words) => {
            case.facts.push(format!("{} words of {}", words.len(), language.name()));
            let has = |letter: &str, meaning| {
                let mut words = words.iter();
                words.any(|word| word.word == letter && word.meaning == meaning)
            };
            let edges = has("D", Meaning::LengthOn) && !has("H", Meaning::LengthRegister);
            if edges != (lengths == Lengths::Edges) {
                case.wrong(match edges {
                    true => "D puts a length on, and TOOL_EDGES is not declared: its programs are held to registers of lengths".to_owned(),
                    false => "TOOL_EDGES is declared, and no D puts a length on: no program can name an edge".to_owned(),
                });
            }
        }
        Err(fault) => case.wrong(fault),
    }
    Ok(())
}

/// Each kind of event by itself, behind the start: written or refused in words, never passed over.
fn every_event(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let declares = pen.open()?.capabilities();
    let start = match pen.write_batches(&[Event::Start], usize::MAX)? {
        Ok(text) => text.len(),
        Err(fault) => {
            case.wrong(fault.message);
            return Ok(());
        }
    };
    for event in Event::samples() {
        let name = event.name();
        match pen.write_batches(&[Event::Start, event], usize::MAX)? {
            Err(fault) if fault.message.contains("the plugin panicked") => {
                case.wrong(fault.message)
            }
            Err(_) => {}
            Ok(text)
                if declares.bits() & event.sent_under().bits() == 0
                    && event.kind() > LAST
                    && text.len() == start =>
            {
                case.wrong(format!(
                    "it takes {name} and writes nothing, without having declared it: it must refuse it"
                ));
            }
            Ok(_) => {}
        }
    }
    Ok(())
}

/// The program's text, if its moves are written. Other events that are refused are left out: it is wrong where
/// programs need them, else noted.
fn program(
    plugin: &Plugin,
    setup: &ProgramSetup,
    format: &Format,
    left_out: &mut Vec<&'static str>,
    case: &mut Case,
) -> Result<Option<String>, PluginFault> {
    let positions = positions(format);
    let opened = Pen { plugin, setup, left_out: &[] };
    left_out.extend(wordless(&mut opened.open()?));
    loop {
        let events = events(&positions, left_out);
        let pen = Pen { plugin, setup, left_out };
        let WriteFault { index, message: fault } = match pen.write_batches(&events, usize::MAX)? {
            Ok(text) => return Ok(Some(text)),
            Err(fault) => fault,
        };
        let Some(event) = events.get(index).filter(|event| can_do_without(event)) else {
            case.wrong(fault);
            return Ok(None);
        };
        let name = event.name();
        match event {
            Event::Preselect { .. } | Event::Compensate(_) => {
                case.note(format!("it refuses {name}: {fault}"));
            }
            _ => case.wrong(format!("it refuses {name}, which programs need: {fault}")),
        }
        left_out.push(name);
    }
}

/// The rest of the program can be looked at without it.
fn can_do_without(event: &Event<'_>) -> bool {
    !event.moves() && !matches!(event, Event::Start | Event::End)
}

/// The words of every motion, rounded to what the dialect prints.
fn positions(format: &Format) -> Vec<[f64; 5]> {
    (0..CUTS)
        .map(|cut| {
            let step = cut as f64;
            let words = [
                step * 1.37 - 20.0,
                -step * 0.731,
                50.0 - step / 7.0,
                step * 0.9 - 10.0,
                370.0 - step * 2.2,
            ];
            rounded(words, format)
        })
        .collect()
}

/// A program with all kinds of events that every dialect is sent.
pub fn events<'a>(positions: &'a [[f64; 5]], left_out: &[&str]) -> Vec<Event<'a>> {
    let words = |index: usize| positions.get(index).map_or(&[] as &[f64], |it| it.as_slice());
    let last = positions.len().saturating_sub(1);
    let cut = |index: usize| {
        let feed = if index.is_multiple_of(5) { 900.0 } else { 400.0 };
        self::cut(words(index), feed)
    };
    let mut events = vec![
        Event::Start,
        Event::Retract { axes: 0b100, words: words(0) },
        Event::Comment { text: "naïve (µ); % ~" },
        Event::tool_change(1, 1, "ball 6"),
        turning(3000.0),
        Event::Coolant(Coolant::Flood),
        turn(words(0)),
        at(words(0)),
        Event::Preselect { number: 2 },
    ];
    events.extend((1..last).map(cut));
    events.extend([
        Event::Dwell { seconds: 0.5 },
        rapid(words(last)),
        Event::Stop,
        Event::OptionalStop,
        Event::Word { text: "M77" },
        Event::Literal { text: "M78" },
        Event::Coolant(Coolant::Off),
        Event::Spindle(Spindle::Off),
        Event::Retract { axes: 0b100, words: words(0) },
        Event::Park { axes: 0b11, words: words(0) },
        Event::End,
    ]);
    events.retain(|event| !left_out.contains(&event.name()));
    events
}

/// A second run must write the same.
fn same(name: &'static str, text: &str, other: Result<String, WriteFault>) -> Case {
    let mut case = Case::named(name);
    match other {
        Err(fault) => case.wrong(fault.message),
        Ok(other) if other != text => {
            let differing = text.lines().zip(other.lines()).zip(1..);
            let first = differing.into_iter().find(|((a, b), _)| a != b);
            case.wrong(match first {
                Some(((a, b), line)) => {
                    format!("line {line} of the program is `{b}`, at first it was `{a}`")
                }
                None => format!(
                    "the program has {} lines, at first it had {}",
                    other.lines().count(),
                    text.lines().count()
                ),
            });
        }
        Ok(_) => {}
    }
    case
}
