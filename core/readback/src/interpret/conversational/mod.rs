//! Blocks of Heidenhain's conversational form: the first name of a block says what it is.
//!
//! | file | runs |
//! |---|---|
//! | `path` | L, LN, CC, C, CR, CT, CP, LP |
//! | `tool` | TOOL CALL, TOOL DEF |
//! | `cycle` | CYCL DEF, CYCL CALL |
//! | `plane` | PLANE, cycle 19, M128 and its like |

mod cycle;
mod path;
mod plane;
mod tool;

use nalgebra::Vector3;
use post_grammar::nc::{NcBlock, NcItem, NcNumber, NcValue};
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::block::BlockRequest;
use super::block_words::BlockWords;
use super::spindle_request::SpindleRequest;
use super::state::{ControlState, MotionMode};
use crate::{MotionKind, ProgramEvent};

type Answer<T> = Result<T, Box<Diagnostic>>;

/// What the path functions remember; lengths in mm, coordinates of the program.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathMemory {
    /// The pole: `CC`.
    pole: [Option<f64>; 3],
    /// Which way the tool went at the end of the last motion: for CT.
    heading: Option<Vector3<f64>>,
}

/// Runs a block.
pub(super) fn run(
    control: &mut ControlState,
    block: &NcBlock,
    words: &mut BlockWords,
) -> Answer<()> {
    for remark in &block.remarks {
        control.remark(remark);
    }
    if block.items.is_empty() {
        return Ok(());
    }
    control.gather(block, words)?;
    // Words of axes are positions, or ways by a letter of their own; L and its like name the motion.
    control.modal.motion = MotionMode::Linear;
    let said = BlockNames { block };
    if let Some(code) = words.g.list().first() {
        let message = format!("G{code} in a program of the dialogue: it is no word there");
        return Err(control.refuse("nc-conversational", message));
    }
    let first = match block.items.first() {
        Some(NcItem::Name(first)) => first,
        // `CHF 2`, `RND 2`, `FOO 5`: what the block is called, and its value.
        Some(NcItem::Named { name, .. }) => return Err(not_run(control, name)),
        _ => return path::alone(control, &said, words),
    };
    match &**first {
        "L" => path::line(control, &said, words),
        "LN" => path::line_with_normal(control, &said, words),
        "CC" => path::pole(control, &said, words),
        "C" | "CR" | "CT" | "CP" | "LP" => path::curve(control, first, &said, words),
        "TOOL CALL" => tool::call(control, &said, words),
        "TOOL DEF" => tool::prepare(control, &said),
        "CYCL DEF" => cycle::define(control, &said, words),
        "CYCL CALL" => cycle::call(control, &said, words),
        "PLANE SPATIAL" | "PLANE EULER" | "PLANE VECTOR" | "PLANE AXIAL" | "PLANE RESET" => {
            plane::plane(control, first, &said, words)
        }
        "TRANS DATUM" => cycle::datum(control, &said, words),
        "FUNCTION TCPM" => plane::keep_tip(control, &said),
        "FUNCTION RESET TCPM" => {
            control.set_tcp(false, None, false);
            Ok(())
        }
        "FUNCTION MODE" => said.only(control, &["MILL"], &[]),
        "BEGIN PGM" => begin(control, &said),
        "END PGM" => {
            control.end();
            Ok(())
        }
        "BLK FORM" => Ok(()),
        "STOP" => {
            control.stop(ProgramEvent::Stop)?;
            path::alone(control, &said, words)
        }
        // Words of modes alone: `R0 FMAX`, `FMAX M3`.
        "R0" | "RL" | "RR" | "FMAX" => path::alone(control, &said, words),
        other => Err(not_run(control, other)),
    }
}

fn not_run(control: &ControlState, name: &str) -> Box<Diagnostic> {
    let message = format!("`{name}` is not run: what the machine does then is not followed");
    control.refuse("nc-conversational", message)
}

/// mm/min in a unit of F: in a program in inches it counts tenths of an inch a minute.
pub(super) fn feed_unit(control: &ControlState) -> f64 {
    if control.modal.unit == 1.0 { 1.0 } else { 0.1 * control.modal.unit }
}

fn begin(control: &mut ControlState, said: &BlockNames<'_>) -> Answer<()> {
    let inches = said.has("INCH") || said.has("IN");
    control.modal.unit = if inches { 25.4 } else { 1.0 };
    control.tools.by_tool = true;
    control.tools.length_on = true;
    Ok(())
}

/// What a block says besides letters with values.
struct BlockNames<'b> {
    block: &'b NcBlock,
}

impl BlockNames<'_> {
    /// The name stands in the block.
    fn has(&self, wanted: &str) -> bool {
        self.names().any(|name| name == wanted)
    }

    /// Names in the block but the first item.
    fn names(&self) -> impl Iterator<Item = &str> {
        self.block.items.iter().filter_map(|item| match item {
            NcItem::Name(name) => Some(&**name),
            _ => None,
        })
    }

    /// The value after a longer name: `SPA+30`.
    fn named(&self, control: &ControlState, wanted: &str) -> Answer<Option<f64>> {
        for item in &self.block.items {
            if let NcItem::Named { name, value } = item
                && &**name == wanted
            {
                return worth(control, value).map(Some);
            }
        }
        Ok(None)
    }

    /// The number alone, of a cycle or a tool.
    fn number(&self) -> Option<NcNumber> {
        self.block.items.iter().find_map(|item| match item {
            NcItem::Number(number) => Some(*number),
            _ => None,
        })
    }

    /// Refuses a number without a letter: `X+77..105` is X+77. and something that is not meant.
    fn no_number(&self, control: &ControlState) -> Answer<()> {
        match self.number() {
            Some(number) => {
                let message = format!("the number {} belongs to no word", number.value);
                Err(control.refuse("nc-conversational", message))
            }
            None => Ok(()),
        }
    }

    /// The text alone.
    fn text(&self) -> Option<&str> {
        self.block.items.iter().find_map(|item| match item {
            NcItem::Text(text) => Some(text.as_str()),
            _ => None,
        })
    }

    /// Refuses names and named values that are not in these lists: each may change what the block does.
    fn only(&self, control: &ControlState, names: &[&str], named: &[&str]) -> Answer<()> {
        for item in self.block.items.iter().skip(1) {
            let other = match item {
                NcItem::Name(name) if !names.contains(&&**name) => name,
                NcItem::Named { name, .. } if !named.contains(&&**name) => name,
                _ => continue,
            };
            let message =
                format!("`{other}` is not known in this block, and might change what it does");
            return Err(control.refuse("nc-conversational", message));
        }
        Ok(())
    }
}

fn worth(control: &ControlState, value: &NcValue) -> Answer<f64> {
    control.variables.worth(value).map_err(|finding| control.placed(*finding).boxed())
}

/// What the M functions of a block ask for beyond what all controls have.
#[derive(Clone, Copy, Debug, Default)]
struct MiscFunctions {
    /// M91.
    machine: bool,
    /// M99: the cycle at the end of the block.
    cycle: bool,
    /// M140.
    retract: bool,
    /// M129.
    tcp_off: bool,
}

/// Takes the M functions of a block: what they switch on holds while it moves; `asked` keeps what ends with it.
fn functions(
    control: &mut ControlState,
    words: &BlockWords,
    asked: &mut BlockRequest,
) -> Answer<MiscFunctions> {
    let mut functions = MiscFunctions::default();
    for &code in words.m.list() {
        match code {
            89 => control.cycles.at_each = true,
            91 => functions.machine = true,
            92 => {
                return Err(control
                    .refuse("nc-machine", "M92 counts from a point that stands in the control"));
            }
            // The display of a rotary axis is brought within a turn: the axis stands where it stood.
            94 => plane::within_a_turn(control, words)?,
            97 | 98 | 101 | 120 | 138 | 144 => {
                return Err(control.refuse(
                    "nc-conversational",
                    format!("M{code} is not run: it changes where the machine goes"),
                ));
            }
            // A share of the feed on the way down.
            103 if words.get(b'F').is_some() => {
                let message = "M103 F is not run: it changes the feed of each way down";
                return Err(control.refuse("nc-feed", message));
            }
            // The last of those that M89 calls.
            99 => {
                control.cycles.at_each = false;
                functions.cycle = true;
            }
            126 => control.modal.shortest = Some(true),
            127 => control.modal.shortest = Some(false),
            128 => control.set_tcp(true, None, false),
            129 => functions.tcp_off = true,
            140 => functions.retract = true,
            // Feeds at corners and of rotary axes; oversize of vectors; lead-ins by the handwheel.
            103 | 107..=111 | 116..=118 | 137 | 141 | 143 | 145 | 148 | 149 => {}
            _ => control.m_code(code, asked)?,
        }
    }
    if let Some(turning) = asked.spindle.filter(|turning| *turning != SpindleRequest::Off) {
        control.turn_spindle(turning);
    }
    if let Some(code) = asked.coolant {
        control.coolant(code);
    }
    if asked.tcp_on {
        control.set_tcp(true, asked.tcp_code, false);
    }
    if functions.machine {
        asked.machine = true;
    }
    Ok(functions)
}

/// What a block does once it has moved.
fn afterwards(
    control: &mut ControlState,
    functions: MiscFunctions,
    asked: &BlockRequest,
) -> Answer<()> {
    if functions.cycle {
        super::cycles::defined(control)?;
    }
    if functions.tcp_off || asked.tcp_off {
        control.set_tcp(false, None, false);
    }
    if asked.spindle == Some(SpindleRequest::Off) {
        control.turn_spindle(SpindleRequest::Off);
    }
    if asked.coolant_off {
        control.coolant_off();
    }
    match asked.stop {
        Some(Meaning::Stop) => control.stop(ProgramEvent::Stop)?,
        Some(Meaning::OptionalStop) => control.stop(ProgramEvent::OptionalStop)?,
        Some(_) => control.end(),
        None => {}
    }
    Ok(())
}

/// A tool whose radius is not that of its table moves what is compensated.
fn not_thicker(control: &ControlState) -> Answer<()> {
    if control.tools.thicker == [0.0; 2] {
        return Ok(());
    }
    let message =
        "DR or DR2 of the tool call moves what is compensated by the radius, and is not followed";
    Err(control.refuse("nc-tool", message))
}

/// Feed, and whether the block goes at rapid; radius compensation.
fn modes(
    control: &mut ControlState,
    said: &BlockNames<'_>,
    words: &mut BlockWords,
) -> Answer<MotionKind> {
    let mut kind = MotionKind::Feed;
    for name in said.names() {
        match name {
            "FMAX" => kind = MotionKind::Rapid,
            "FAUTO" => {
                return Err(
                    control.refuse("nc-feed", "FAUTO: the feed of the tool call is not kept")
                );
            }
            "R0" => control.compensate(0, words)?,
            "RL" | "RR" => {
                not_thicker(control)?;
                control.compensate(if name == "RL" { -1 } else { 1 }, words)?;
            }
            _ => {}
        }
    }
    if let Some(feed) = words.take(b'F') {
        control.modal.feed = Some(feed * feed_unit(control));
    }
    Ok(kind)
}
