//! Dialects on a short five-axis program. What a control should say is its author's; that every event becomes
//! whole lines of finite numbers, the same however the program is cut into batches, is the kit's.

use post_plugin::{
    Batch, Capabilities, Coolant, DialectSession, Event, Feed, Format, Spindle, SpindleSense,
    Units, quantise,
};

use super::Case;
use crate::{GivenValue, Plugin, PluginFault, ProgramSetup, ProgramWord};

/// A kind of event that no version of the contract has.
const UNKNOWN: u32 = 60_000;

/// The last kind that every dialect is sent; those behind it must be declared.
const LAST: u32 = Event::Word { text: "" }.kind();

/// Cuts in the program.
const CUTS: usize = 40;

/// A program's text; or which event was refused, and why.
type Written = Result<String, (usize, String)>;

pub(super) fn test(
    plugin: &Plugin,
    options: &[(String, GivenValue)],
) -> Result<Vec<Case>, PluginFault> {
    let mut setup = ProgramSetup {
        program: "kit".to_owned(),
        machine: "five axes".to_owned(),
        words: ["X", "Y", "Z", "A", "C"]
            .map(|name| ProgramWord {
                name: name.to_owned(),
                rotary: name == "A" || name == "C",
                depth: name == "Z",
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

    let run = |batch: usize, shift: f64| {
        let positions = positions(&format, shift);
        write(plugin, &setup, &events(&positions, &left_out), batch)
    };
    cases.push(same("again", &text, run(usize::MAX, 0.0)?));
    cases.push(same("one by one", &text, run(1, 0.0)?));
    cases.push(same("by sevens", &text, run(7, 0.0)?));

    let mut case = Case::named("words");
    if run(usize::MAX, 1.0)?.is_ok_and(|other| other == text) {
        case.wrong(format!(
            "cut {} goes 1 mm further in X, and the program is the same",
            CUTS / 2
        ));
    }
    cases.push(case);

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

    for (name, tcp, units) in [
        ("with TCP", true, Units::Millimetre),
        ("in inches", false, Units::Inch),
    ] {
        setup.tcp = tcp;
        setup.units = units;
        let mut case = Case::named(name);
        match plugin.dialect(&setup) {
            Ok(opened) => {
                let format = opened.format().clone();
                drop(opened);
                program(plugin, &setup, &format, &mut left_out.clone(), &mut case)?;
            }
            Err(fault) => case.note(format!("it refuses to open: {}", fault)),
        }
        cases.push(case);
    }
    Ok(cases)
}

/// Each kind of event by itself, behind the start: written or refused in words, never passed over.
fn every_event(plugin: &Plugin, setup: &ProgramSetup) -> Result<Case, PluginFault> {
    let mut case = Case::named("every event");
    let declares = plugin.dialect(setup)?.capabilities() != Capabilities::NONE;
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
            Ok(text) if !declares && event.kind() > LAST && text.len() == start => {
                case.wrong(format!(
                    "it takes {name} and writes nothing, without having declared it: it must refuse it"
                ));
            }
            Ok(_) => {}
        }
    }
    Ok(case)
}

/// The program's text, if what it cannot do without is written. Other events that are refused are left out
/// and noted.
fn program(
    plugin: &Plugin,
    setup: &ProgramSetup,
    format: &Format,
    left_out: &mut Vec<&'static str>,
    case: &mut Case,
) -> Result<Option<String>, PluginFault> {
    let positions = positions(format, 0.0);
    loop {
        let events = events(&positions, left_out);
        let (index, fault) = match write(plugin, setup, &events, usize::MAX)? {
            Ok(text) => return Ok(Some(text)),
            Err(fault) => fault,
        };
        let refused = events
            .get(index)
            .map(|event| (event.name(), optional(event)));
        match refused {
            Some((name, true)) if !fault.contains("the plugin panicked") => {
                case.note(format!("it refuses {name}: {fault}"));
                left_out.push(name);
            }
            _ => {
                case.wrong(fault);
                return Ok(None);
            }
        }
    }
}

/// A control may do without it.
fn optional(event: &Event<'_>) -> bool {
    matches!(
        event,
        Event::Comment { .. }
            | Event::Coolant(_)
            | Event::Dwell { .. }
            | Event::Stop
            | Event::OptionalStop
            | Event::Retract { .. }
            | Event::Park { .. }
            | Event::Spindle(_)
            | Event::ToolChange { .. }
    )
}

/// The words of every motion, rounded to what the dialect prints; cut `CUTS / 2` goes `shift` further in X.
fn positions(format: &Format, shift: f64) -> Vec<[f64; 5]> {
    (0..CUTS)
        .map(|cut| {
            let step = cut as f64;
            let further = if cut == CUTS / 2 { shift } else { 0.0 };
            let words = [
                step * 1.37 - 20.0 + further,
                -step * 0.731,
                50.0 - step / 7.0,
                step * 0.9 - 10.0,
                370.0 - step * 2.2,
            ];
            let mut rounded = words;
            for (word, decimals) in rounded.iter_mut().zip(&format.words) {
                *word = quantise(*word, *decimals);
            }
            rounded
        })
        .collect()
}

fn events<'a>(positions: &'a [[f64; 5]], left_out: &[&str]) -> Vec<Event<'a>> {
    let words = |index: usize| {
        positions
            .get(index)
            .map_or(&[] as &[f64], |it| it.as_slice())
    };
    let mut events = vec![
        Event::Start,
        Event::Retract {
            axes: 0b100,
            words: words(0),
        },
        Event::Comment {
            text: "naïve (µ); % ~",
        },
        Event::tool_change(1, 1, "ball 6"),
        Event::Spindle(Spindle::On {
            rpm: 3000.0,
            sense: SpindleSense::Clockwise,
        }),
        Event::Coolant(Coolant::Flood),
        Event::Turn { words: words(0) },
        Event::position(words(0), None),
    ];
    events.extend((1..positions.len() - 1).map(|cut| {
        Event::linear(
            words(cut),
            Feed::PerMinute(if cut % 5 == 0 { 900.0 } else { 400.0 }),
        )
    }));
    events.extend([
        Event::Dwell { seconds: 0.5 },
        Event::rapid(words(positions.len() - 1)),
        Event::Stop,
        Event::OptionalStop,
        Event::Coolant(Coolant::Off),
        Event::Spindle(Spindle::Off),
        Event::Retract {
            axes: 0b100,
            words: words(0),
        },
        Event::Park {
            axes: 0b11,
            words: words(0),
        },
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
