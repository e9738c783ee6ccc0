//! Dialects on a short five-axis program. What a control should say is its author's; that every event becomes
//! whole lines of finite numbers, the same however the program is cut into batches, and that nothing of it is left
//! out, is the kit's.

use post_plugin::{
    Batch, Coolant, DialectSession, Event, Feed, Format, Lengths, Meaning, Spindle, Units, quantise,
};

use super::Case;
use super::commands::commands;
use super::declared::declared;
use super::options::options_of;
use super::pen::{Pen, TURNING};
use super::print::{edges, moves};
use super::sessions::{after_a_refusal, two_at_once, two_threads};
use super::texts::remarks;
use post_host::{GivenValue, Plugin, PluginFault, ProgramSetup, ProgramWord};

/// A kind of event that no version of the contract has.
const UNKNOWN: u32 = 60_000;

/// The last kind that every dialect is sent; those behind it must be declared.
pub const LAST: u32 = Event::Word { text: "" }.kind();

/// Cuts in the program.
pub const CUTS: usize = 40;

/// A program's text; or which event was refused, and why.
type Written = Result<String, (usize, String)>;

pub(super) fn test(
    plugin: &Plugin,
    options: &[(String, GivenValue)],
    most: usize,
) -> Result<Vec<Case>, PluginFault> {
    let mut setup = ProgramSetup {
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
    };
    let format = plugin.dialect(&setup)?.format().clone();
    let mut cases = Vec::new();

    let mut case = Case::named("program");
    let mut left_out = Vec::new();
    let text = program(plugin, &setup, &format, &mut left_out, &mut case)?;
    cases.push(case);
    let Some(text) = text else {
        return Ok(cases);
    };

    let positions = positions(&format);
    let run = |batch: usize| write(plugin, &setup, &events(&positions, &left_out), batch);
    cases.push(same("again", &text, run(usize::MAX)?));
    cases.push(same("one by one", &text, run(1)?));
    cases.push(same("by sevens", &text, run(7)?));

    let pen = Pen { plugin, setup: &setup, left_out: &left_out };
    let mut case = Case::named("words and feeds");
    moves(&pen, &mut case)?;
    cases.push(case);
    let mut case = Case::named("rounding edges");
    edges(&pen, &mut case)?;
    cases.push(case);
    let mut case = Case::named("commands");
    commands(&pen, &mut case)?;
    cases.push(case);
    let mut case = Case::named("remarks");
    if !left_out.contains(&"Comment") {
        remarks(&pen, &mut case)?;
    }
    cases.push(case);
    let mut case = Case::named("declared");
    declared(&pen, &mut case)?;
    cases.push(case);
    cases.push(axis_names(&pen)?);
    let plain = begin(&pen)?;

    let mut case = Case::named("unknown event");
    let events = [Event::Start, Event::Unknown { kind: UNKNOWN }];
    if let Ok(text) = write(plugin, &setup, &events, usize::MAX)? {
        let lines = text.lines().count();
        case.wrong(format!(
            "an event of kind {UNKNOWN} is taken for granted ({lines} lines): it must be refused"
        ));
    }
    cases.push(case);

    cases.push(every_event(plugin, &setup)?);
    cases.push(vocabulary(plugin, &setup)?);
    cases.push(options_of(&pen)?);
    cases.push(after_a_refusal(plugin, &setup, UNKNOWN)?);
    cases.push(two_at_once(plugin, &setup)?);
    cases.push(two_threads(plugin, &setup, most)?);

    for (name, tcp, units) in
        [("with TCP", true, Units::Millimetre), ("in inches", false, Units::Inch)]
    {
        setup.tcp = tcp;
        setup.units = units;
        let mut case = Case::named(name);
        match plugin.dialect(&setup) {
            Ok(opened) => {
                let format = opened.format().clone();
                drop(opened);
                let mut left_out = left_out.clone();
                if program(plugin, &setup, &format, &mut left_out, &mut case)?.is_some() {
                    let pen = Pen { plugin, setup: &setup, left_out: &left_out };
                    if begin(&pen)? == plain {
                        case.wrong(format!(
                            "the program begins as it does without: it must say so to the control, or refuse to open ({})",
                            if tcp { "tcp" } else { "units" }
                        ));
                    }
                    moves(&pen, &mut case)?;
                    commands(&pen, &mut case)?;
                    declared(&pen, &mut case)?;
                    let told =
                        |sentence: &String| cases.iter().any(|case| case.wrong.contains(sentence));
                    case.wrong.retain(|sentence| !told(sentence));
                }
            }
            Err(fault) => case.note(format!("it refuses to open: {}", fault)),
        }
        cases.push(case);
    }
    Ok(cases)
}

/// From the start to the first position: where units and tool centre point control are switched.
fn begin(pen: &Pen<'_>) -> Result<Option<String>, PluginFault> {
    let words = [0.0; 5];
    let text = pen.write(&|program| {
        program.begin();
        program.push(Event::position(&words, None));
    })?;
    // Decimals apart, which an inch program may have more of.
    Ok(text.ok().map(|(text, _)| text.replace(['0', '.'], "")))
}

/// A name with a number, as `X1`: refused, or told from the value behind it.
fn axis_names(pen: &Pen<'_>) -> Result<Case, PluginFault> {
    let mut case = Case::named("axis names");
    let mut setup = pen.setup.clone();
    setup.words[0].name = "X1".to_owned();
    let pen = Pen { setup: &setup, ..*pen };
    if pen.plugin.dialect(&setup).is_err() {
        return Ok(case);
    }
    let words = [450.0, -12.0, 7.0, 30.0, 40.0];
    let text = pen.write(&|program| {
        program.begin();
        program.push(Event::position(&words, None));
    })?;
    if let Ok((text, _)) = text
        && let Some(at) = text.find("X1")
        && let Some(word) = text[at..].split_whitespace().next()
        && word[2..].starts_with(|next: char| next.is_ascii_digit() || "+-.".contains(next))
    {
        case.wrong(format!(
            "an axis called X1 is written `{word}`, which is a value of X: it must refuse the axis"
        ));
    }
    Ok(case)
}

/// The words that it tells hold together, and with what it declares of its registers; none are told by many.
fn vocabulary(plugin: &Plugin, setup: &ProgramSetup) -> Result<Case, PluginFault> {
    let mut case = Case::named("vocabulary");
    let mut opened = plugin.dialect(setup)?;
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
    Ok(case)
}

/// Each kind of event by itself, behind the start: written or refused in words, never passed over.
fn every_event(plugin: &Plugin, setup: &ProgramSetup) -> Result<Case, PluginFault> {
    let mut case = Case::named("every event");
    let declares = plugin.dialect(setup)?.capabilities();
    let start = match write(plugin, setup, &[Event::Start], usize::MAX)? {
        Ok(text) => text.len(),
        Err((_, fault)) => {
            case.wrong(fault);
            return Ok(case);
        }
    };
    for event in Event::samples() {
        let name = event.name();
        match write(plugin, setup, &[Event::Start, event], usize::MAX)? {
            Err((_, fault)) if fault.contains("the plugin panicked") => case.wrong(fault),
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
    Ok(case)
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
    loop {
        let events = events(&positions, left_out);
        let (index, fault) = match write(plugin, setup, &events, usize::MAX)? {
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
            let mut words = [
                step * 1.37 - 20.0,
                -step * 0.731,
                50.0 - step / 7.0,
                step * 0.9 - 10.0,
                370.0 - step * 2.2,
            ];
            for (word, decimals) in words.iter_mut().zip(&format.words) {
                *word = quantise(*word, *decimals);
            }
            words
        })
        .collect()
}

/// A program with all kinds of events that every dialect is sent.
pub fn events<'a>(positions: &'a [[f64; 5]], left_out: &[&str]) -> Vec<Event<'a>> {
    let words = |index: usize| positions.get(index).map_or(&[] as &[f64], |it| it.as_slice());
    let last = positions.len().saturating_sub(1);
    let cut = |index: usize| {
        let feed = if index.is_multiple_of(5) { 900.0 } else { 400.0 };
        Event::linear(words(index), Feed::PerMinute(feed))
    };
    let mut events = vec![
        Event::Start,
        Event::Retract { axes: 0b100, words: words(0) },
        Event::Comment { text: "naïve (µ); % ~" },
        Event::tool_change(1, 1, "ball 6"),
        TURNING,
        Event::Coolant(Coolant::Flood),
        Event::Turn { words: words(0) },
        Event::position(words(0), None),
        Event::Preselect { number: 2 },
    ];
    events.extend((1..last).map(cut));
    events.extend([
        Event::Dwell { seconds: 0.5 },
        Event::rapid(words(last)),
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

/// Writes `events`, given in batches of so many.
fn write(
    plugin: &Plugin,
    setup: &ProgramSetup,
    events: &[Event<'_>],
    batch: usize,
) -> Result<Written, PluginFault> {
    let mut session = plugin.dialect(setup)?;
    let (mut out, mut ends) = (String::new(), Vec::new());
    let mut done = 0;
    for chunk in events.chunks(batch.min(events.len()).max(1)) {
        let mut batch = Batch::default();
        for (event, line) in chunk.iter().zip(1..) {
            batch.push(line, *event);
        }
        if let Err(fault) = session.write_batch(&batch, &mut out, &mut ends) {
            return Ok(Err((done + fault.index, fault.message)));
        }
        done += chunk.len();
    }
    Ok(Ok(out))
}

/// A second run must write the same.
fn same(name: &'static str, text: &str, other: Written) -> Case {
    let mut case = Case::named(name);
    match other {
        Err((_, fault)) => case.wrong(fault),
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
