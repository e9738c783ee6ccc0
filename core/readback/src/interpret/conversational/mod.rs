//! Blocks of Heidenhain's conversational form: the first name of a block says what it is.
//!
//! | file | runs |
//! |---|---|
//! | `path` | L, LN, CC, C, CR, CT, CP, LP |
//! | `tool` | TOOL CALL, TOOL DEF |
//! | `items` | names, named values, numbers and texts of a block, and which of them have been read |
//! | `cycle` | CYCL DEF, CYCL CALL |
//! | `plane` | PLANE, cycle 19, M128 and its like |

mod cycle;
mod items;
mod path;
mod plane;
mod tool;

use std::mem;

use nalgebra::Vector3;
use post_grammar::nc::{NcBlock, NcItem, NcValue};
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::block::BlockRequest;
use super::block_words::BlockWords;
use super::spindle_request::SpindleRequest;
use super::state::{ControlState, MotionMode};
use crate::{MotionKind, ProgramEvent};
use items::BlockItems;

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
    if let Some(code) = words.g.list().first() {
        let message = format!("G{code} in a program of the dialogue: it is no word there");
        return Err(control.refuse("nc-conversational", message));
    }
    let said = BlockItems::new(control, block)?;
    match block.items.first() {
        Some(NcItem::Name(first)) => by_name(control, first, &said, words)?,
        // `CHF 2`, `RND 2`, `FOO 5`: what the block is called, and its value.
        Some(NcItem::Named { name, .. }) => return Err(not_run(control, name)),
        _ => path::alone(control, &said, words)?,
    }
    // Each word is accounted for: what no function has read might change what the block does.
    said.all_read(control)?;
    if let Some(code) = words.m.list().first() {
        let message = format!("M{code} is not run in this block");
        return Err(control.refuse("nc-conversational", message));
    }
    control.left_over(words)
}

/// Runs the block that begins with the name `first`.
fn by_name(
    control: &mut ControlState,
    first: &str,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    match first {
        "L" => path::line(control, said, words),
        "LN" => path::line_with_normal(control, said, words),
        "CC" => path::pole(control, words),
        "C" | "CR" | "CT" | "CP" | "LP" => path::curve(control, first, said, words),
        "TOOL CALL" => tool::call(control, said, words),
        "TOOL DEF" => tool::prepare(control, said, words),
        "CYCL DEF" => cycle::define(control, said, words),
        "CYCL CALL" => cycle::call(control, said, words),
        "PLANE SPATIAL" | "PLANE EULER" | "PLANE VECTOR" | "PLANE AXIAL" | "PLANE RESET" => {
            plane::plane(control, first, said, words)
        }
        "TRANS DATUM" => cycle::datum(control, said, words),
        "FUNCTION TCPM" => {
            plane::keep_tip(control, said);
            Ok(())
        }
        "FUNCTION RESET TCPM" => {
            control.set_tcp(false, None, false);
            Ok(())
        }
        "FUNCTION MODE" => {
            said.pass(&["MILL"]);
            Ok(())
        }
        "BEGIN PGM" => {
            begin(control, said);
            Ok(())
        }
        "END PGM" => {
            said.pass_all();
            control.end();
            Ok(())
        }
        // The blank, for the picture on the screen.
        "BLK FORM" => {
            said.pass_all();
            words.used |= words.present;
            Ok(())
        }
        "STOP" => {
            control.stop(ProgramEvent::Stop)?;
            path::alone(control, said, words)
        }
        // Words of modes alone: `R0 FMAX`, `FMAX M3`.
        "R0" | "RL" | "RR" | "FMAX" => path::alone(control, said, words),
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

fn begin(control: &mut ControlState, said: &BlockItems<'_>) {
    let inches = said.has("INCH") || said.has("IN");
    control.modal.unit = if inches { 25.4 } else { 1.0 };
    control.tools.by_tool = true;
    control.tools.length_on = true;
    said.pass_all();
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
    /// M94.
    within_a_turn: bool,
}

/// Takes the M functions of a block: what they switch on holds while it moves; `asked` keeps what ends with it.
fn functions(
    control: &mut ControlState,
    words: &mut BlockWords,
    asked: &mut BlockRequest,
) -> Answer<MiscFunctions> {
    let mut functions = MiscFunctions::default();
    for &code in mem::take(&mut words.m).list() {
        match code {
            89 => control.cycles.at_each = true,
            91 => functions.machine = true,
            92 => {
                return Err(control
                    .refuse("nc-machine", "M92 counts from a point that stands in the control"));
            }
            // The display of a rotary axis is brought within a turn: the axis stands where it stood.
            94 => {
                plane::within_a_turn(control, words)?;
                functions.within_a_turn = true;
            }
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
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<MotionKind> {
    let kind = if said.has("FMAX") { MotionKind::Rapid } else { MotionKind::Feed };
    if said.has("FAUTO") {
        return Err(control.refuse("nc-feed", "FAUTO: the feed of the tool call is not kept"));
    }
    if said.has("R0") {
        control.compensate(0, words)?;
    }
    for (name, side) in [("RL", -1), ("RR", 1)] {
        if said.has(name) {
            not_thicker(control)?;
            control.compensate(side, words)?;
        }
    }
    if let Some(feed) = words.take(b'F') {
        control.modal.feed = Some(feed * feed_unit(control));
    }
    Ok(kind)
}
