//! `CYCL DEF`: those of the 200 series wait for their call, those with small numbers take effect at once.

use nalgebra::{Matrix3, Vector3};
use post_grammar::nc::NcNumber;

use super::items::BlockItems;
use super::{Answer, afterwards, functions, plane, worth};
use crate::ProgramEvent;
use crate::interpret::block::BlockRequest;
use crate::interpret::block_words::{BlockWords, bit};
use crate::interpret::cycles::{self, DefinedCycle};
use crate::interpret::frame::CoordinateFrame;
use crate::interpret::spindle_request::SpindleRequest;
use crate::interpret::state::ControlState;
use crate::interpret::variables::VariableValue;

/// `CYCL DEF n …` and the lines `CYCL DEF n.m` of one.
pub(super) fn define(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    let Some(NcNumber { value, .. }) = said.number() else {
        return Err(control.refuse("nc-cycle", "CYCL DEF without a number"));
    };
    let cycle = libm::floor(value + 1e-9) as u32;
    let line = libm::rint((value - f64::from(cycle)) * 10.0) as u32;
    if line == 0 {
        // The title, in the language of the dialogue.
        let _ = said.text();
    }
    match (cycle, line) {
        // The head of one whose values stand in lines of their own.
        (7..=11 | 13 | 19 | 26 | 32, 0) => Ok(()),
        (7, _) => {
            // `7.1 #5`: a row of a table in the control.
            if words.present & control.axes.mask == 0 {
                let message = "CYCL DEF 7 without an axis: a table of the control, or no shift";
                return Err(control.refuse("nc-frame", message));
            }
            let by = shifts(control, words)?;
            shift(control, by)
        }
        // `8.1 X Y`: axes by their names. Without one it ends.
        (8, _) => match said.next_name().is_some() || words.present & control.axes.mask != 0 {
            true => Err(control.refuse("nc-cycle", "CYCL DEF 8: a mirror image is not run")),
            false => Ok(()),
        },
        (9, _) => {
            // `CYCL DEF 9.1 DWELL 0.5`, in the language of the dialogue.
            let named = said.next_named().map(|(_, value)| worth(control, value)).transpose()?;
            let Some(time) = named.or_else(|| said.number().map(|number| number.value)) else {
                return Err(control.refuse("nc-cycle", "CYCL DEF 9 does not say how long"));
            };
            control.tell(ProgramEvent::Dwell { time, revolutions: false });
            Ok(())
        }
        (10, _) => turn(control, said),
        (11, _) => match said.named(control, "SCL")? {
            Some(1.0) => Ok(()),
            _ => Err(control.refuse("nc-cycle", "CYCL DEF 11: a scale is not run")),
        },
        (13, _) => {
            // The angle, in the language of the dialogue.
            let _ = said.next_named();
            control.turn_spindle(SpindleRequest::Oriented);
            Ok(())
        }
        (19, _) => plane::cycle_19(control, said, words),
        (32, 1) => {
            let tolerance = words.take(b'T').map(|tolerance| tolerance * control.modal.unit);
            let tolerance = tolerance.filter(|tolerance| *tolerance > 0.0);
            control.leaves_corners(None, tolerance, None);
            Ok(())
        }
        (32, _) => {
            if let Some(angle) = said.named(control, "TA")? {
                control.leaves_axis(angle);
            }
            // Roughing or finishing: what the control makes of it is told by its parameters.
            let _ = said.named(control, "HSC-MODE")?;
            Ok(())
        }
        (247, _) => {
            let Some(row) = said.named(control, "Q339")? else {
                return Err(control.refuse("nc-cycle", "CYCL DEF 247 without Q339"));
            };
            control.use_work_offset(&format!("CYCL DEF 247 Q339={row}"))
        }
        (220 | 221 | 14 | 20..=28 | 270..=279, _) | (0..=199, _) => Err(control.refuse(
            "nc-cycle",
            format!("CYCL DEF {cycle} is not run: what it moves or changes is not known here"),
        )),
        _ => remember(control, cycle, said),
    }
}

/// A cycle that is called later; its parameters are variables too.
fn remember(control: &mut ControlState, cycle: u32, said: &BlockItems<'_>) -> Answer<()> {
    let mut values = Vec::new();
    while let Some((name, value)) = said.next_named() {
        let Some(number) = name.strip_prefix('Q').and_then(|digits| digits.parse().ok()) else {
            let message = format!("`{name}` is no parameter of a cycle");
            return Err(control.refuse("nc-cycle", message));
        };
        let value = match value {
            // `Q208=MAX` and its like are no numbers.
            post_grammar::nc::NcValue::Text(text) => {
                return Err(control.refuse("nc-cycle", format!("{name}=\"{text}\" is no number")));
            }
            value => worth(control, value)?,
        };
        values.push((number, value));
        control
            .variables
            .put(name, VariableValue::Number(value))
            .map_err(|finding| control.placed(*finding).boxed())?;
    }
    control.cycles.at_each = false;
    control.cycles.defined = Some(DefinedCycle { cycle, values });
    Ok(())
}

/// `CYCL CALL`: where the tool stands.
pub(super) fn call(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    said.pass(&["FMAX"]);
    let mut asked = BlockRequest::default();
    let functions = functions(control, words, &mut asked)?;
    if words.present & control.axes.mask != 0 || functions.machine {
        return Err(control.refuse("nc-cycle", "CYCL CALL with a position is not run"));
    }
    if let Some(feed) = words.take(b'F') {
        control.modal.feed = Some(feed * super::feed_unit(control));
    }
    cycles::defined(control)?;
    afterwards(control, functions, &asked)
}

/// Words of a shift: absolute, or by a way; mm.
type Shift = [Option<(f64, bool)>; 3];

fn shifts(control: &ControlState, words: &mut BlockWords) -> Answer<Shift> {
    let others = words.present & control.axes.mask & !(bit(b'X') | bit(b'Y') | bit(b'Z'));
    words.used |= others;
    for letter in b'A'..=b'Z' {
        if others & bit(letter) != 0 && words.get(letter) != Some(0.0) {
            return Err(control.refuse(
                "nc-frame",
                format!("a datum shift of {} is not run", char::from(letter)),
            ));
        }
    }
    let unit = control.modal.unit;
    Ok([b'X', b'Y', b'Z'].map(|letter| {
        let way = words.incremental & bit(letter) != 0;
        words.take(letter).map(|value| (value * unit, way))
    }))
}

fn shift(control: &mut ControlState, by: Shift) -> Answer<()> {
    let inside = control.frames.plane.is_some();
    if inside && !control.frames.outer.is_default() {
        return Err(control.refuse("nc-frame", "a datum shift inside a tilted plane and one outside of it: how they add up is not settled"));
    }
    let frame = if inside { &mut control.frames.inner } else { &mut control.frames.outer };
    let mut origin = frame.origin;
    for (own, said) in origin.iter_mut().zip(by) {
        match said {
            Some((way, true)) => *own += way,
            Some((value, false)) => *own = value,
            None => {}
        }
    }
    *frame = CoordinateFrame::new(frame.axes, origin);
    control.frames_changed();
    Ok(())
}

/// `TRANS DATUM AXIS X+10`, `TRANS DATUM RESET`.
pub(super) fn datum(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    said.pass(&["AXIS"]);
    let by = match said.has("RESET") {
        true => [Some((0.0, false)); 3],
        false => shifts(control, words)?,
    };
    shift(control, by)
}

/// `CYCL DEF 10.1 ROT+30`: the coordinates are turned about the tool axis.
fn turn(control: &mut ControlState, said: &BlockItems<'_>) -> Answer<()> {
    let Some(angle) = said.named(control, "ROT")? else {
        return Err(control.refuse("nc-cycle", "CYCL DEF 10 without ROT, or by a way"));
    };
    let inside = control.frames.plane.is_some();
    let frame = if inside { &mut control.frames.inner } else { &mut control.frames.outer };
    let (sine, cosine) = libm::sincos(angle.to_radians());
    let axes = match angle == 0.0 {
        true => Matrix3::identity(),
        false => Matrix3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0),
    };
    let origin: Vector3<f64> = frame.origin;
    *frame = CoordinateFrame::new(axes, origin);
    control.frames_changed();
    Ok(())
}
