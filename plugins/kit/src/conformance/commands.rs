//! What a dialect makes of everything but moves: each command must be in the text, and what it says too.

use post_host::PluginFault;
use post_plugin::{
    Capabilities, Compensation, Coolant, DialectSession as _, Event, Spindle, SpindleSense,
};

use super::Case;
use super::pen::{BEGIN, ELSEWHERE, END, Pen};
use crate::{at, turning};

/// A command in two forms between which the text must differ.
struct CommandPair {
    /// What differs.
    what: &'static str,
    one: Event<'static>,
    /// None: the command is not given at all.
    other: Option<Event<'static>>,
    /// The tool is away from the part, and comes to it again afterwards.
    away: bool,
    /// Without it most programs cannot be made; else the control may lack it.
    needed: bool,
}

const fn pair(what: &'static str, one: Event<'static>, other: Event<'static>) -> CommandPair {
    CommandPair { what, one, other: Some(other), away: false, needed: true }
}

const fn given(what: &'static str, one: Event<'static>) -> CommandPair {
    CommandPair { what, one, other: None, away: false, needed: true }
}

const fn away(pair: CommandPair) -> CommandPair {
    CommandPair { away: true, ..pair }
}

const fn lacking(pair: CommandPair) -> CommandPair {
    CommandPair { needed: false, ..pair }
}

const BACKWARD: Event<'static> =
    Event::Spindle(Spindle::On { rpm: 3000.0, sense: SpindleSense::CounterClockwise });

const fn left(register: u32) -> Event<'static> {
    Event::Compensate(Compensation::Left { register })
}

/// Letter for letter.
const LINE: &str = "M77 P1 b";

const COMMANDS: &[CommandPair] = &[
    given("a remark", Event::Comment { text: "ALPHA" }),
    pair(
        "the text of a remark",
        Event::Comment { text: "ALPHA" },
        Event::Comment { text: "OMEGA" },
    ),
    given("a line of the user's own", Event::Literal { text: LINE }),
    given("a line of the machine's own", Event::Word { text: LINE }),
    away(given("a tool change", Event::tool_change(2, 1, ""))),
    away(pair("the number of a tool", Event::tool_change(2, 1, ""), Event::tool_change(3, 1, ""))),
    away(lacking(pair(
        "the tool that is made ready",
        Event::Preselect { number: 3 },
        Event::Preselect { number: 4 },
    ))),
    pair("the speed of the spindle, 3001 for 3000,", turning(3000.0), turning(3001.0)),
    pair("the sense of the spindle", turning(3000.0), BACKWARD),
    given("the stop of the spindle", Event::Spindle(Spindle::Off)),
    lacking(given("an oriented stop", Event::Spindle(Spindle::Orient))),
    given("coolant", Event::Coolant(Coolant::Flood)),
    pair("the end of coolant", Event::Coolant(Coolant::Flood), Event::Coolant(Coolant::Off)),
    lacking(pair(
        "the kind of coolant, mist for flood,",
        Event::Coolant(Coolant::Mist),
        Event::Coolant(Coolant::Flood),
    )),
    lacking(pair(
        "the kind of coolant, through the tool for flood,",
        Event::Coolant(Coolant::Through),
        Event::Coolant(Coolant::Flood),
    )),
    lacking(pair(
        "the kind of coolant, air for flood,",
        Event::Coolant(Coolant::Air),
        Event::Coolant(Coolant::Flood),
    )),
    given("a dwell", Event::Dwell { seconds: 1.0 }),
    pair(
        "the time of a dwell, 2 s for 1 s,",
        Event::Dwell { seconds: 1.0 },
        Event::Dwell { seconds: 2.0 },
    ),
    given("a stop", Event::Stop),
    given("an optional stop", Event::OptionalStop),
    pair("an optional stop for a stop", Event::Stop, Event::OptionalStop),
    away(given(
        "a position of the machine",
        Event::Park { axes: 0b11, words: &[-200.0, 150.0, 0.0, 0.0, 0.0] },
    )),
];

/// Where the control has compensation.
const COMPENSATION: &[CommandPair] = &[
    lacking(given("cutter compensation", left(5))),
    lacking(pair(
        "the side of cutter compensation",
        left(5),
        Event::Compensate(Compensation::Right { register: 5 }),
    )),
    lacking(pair("the end of cutter compensation", left(5), Event::Compensate(Compensation::Off))),
];

/// Of those that are not in the control's own table.
const REGISTERS: &[CommandPair] = &[
    away(pair(
        "the register of a tool's length, 6 for 5,",
        Event::tool_change(2, 5, ""),
        Event::tool_change(2, 6, ""),
    )),
    lacking(pair("the register of a tool's radius, 6 for 5,", left(5), left(6))),
];

/// Runs all commands.
pub(super) fn commands(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let writes = pen.open()?.capabilities();
    let compensates = !pen.setup.tcp || writes.has(Capabilities::COMPENSATE_TCP);
    let registers = !writes.has(Capabilities::TOOL_TABLE);
    let pairs = COMMANDS.iter().chain(COMPENSATION).chain(if registers { REGISTERS } else { &[] });
    for pair in pairs {
        let compensation = matches!(pair.one, Event::Compensate(_));
        let without = pair.other.as_ref().is_some_and(|other| pen.leaves_out(other));
        if without || pen.leaves_out(&pair.one) || compensation && !compensates {
            continue;
        }
        let write = |command: &Option<Event<'_>>| pen.write_around(command.as_slice(), pair.away);
        match (write(&Some(pair.one))?, write(&pair.other)?) {
            (Ok(one), Ok(other)) if one == other => {
                case.wrong(format!("{} makes no difference to the text", pair.what));
            }
            (Ok(text), Ok(_)) => {
                let letter_for_letter =
                    matches!(pair.one, Event::Literal { .. } | Event::Word { .. });
                if letter_for_letter && !text.contains(LINE) {
                    case.wrong(format!("{} is not written letter for letter", pair.what));
                }
            }
            (Err(fault), _) | (_, Err(fault)) if pair.needed => {
                case.wrong(format!("{} is refused: {fault}", pair.what));
            }
            (Err(fault), _) if pair.other.is_none() => {
                case.note(format!("{} is refused: {fault}", pair.what));
            }
            (Err(_), _) | (_, Err(_)) => {}
        }
    }
    short_dwell(pen, case)
}

/// Controls differ in how finely they wait.
fn short_dwell(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let dwell = |seconds| Event::Dwell { seconds };
    let text = |seconds| pen.write(&[BEGIN, &[at(&ELSEWHERE), dwell(seconds)], END]);
    if let (Ok(one), Ok(other)) = (text(0.5)?, text(0.6)?)
        && one.text == other.text
        && !pen.leaves_out(&dwell(0.5))
    {
        case.note("dwells of 0.5 s and 0.6 s are written alike".to_owned());
    }
    Ok(())
}
