//! Shifts and turns of the program's coordinates.

use nalgebra::{Matrix3, Vector3};
use post_machine::diagnostic::Diagnostic;
use post_machine::tilted_plane::rotation;
use post_plugin::{Language, Meaning};

use super::block_words::{BlockWords, bit};
use super::frame::CoordinateFrame;
use super::planes;
use super::state::ControlState;
use crate::g_code::GCode;

/// `G52`, `G92`, `G92.1`, `G10`, `G68`, `G69` (two-dimensional turns).
pub(super) fn code(
    control: &mut ControlState,
    code: GCode,
    meaning: Meaning,
    words: &mut BlockWords,
) -> Result<(), Box<Diagnostic>> {
    match meaning {
        Meaning::LocalOffset => local_zero(control, words),
        Meaning::SetPosition => preset(control, words),
        Meaning::SetPositionOff => {
            // `G92.1 X0`: the words say of which axes.
            words.used |= control.axes.mask;
            control.frames.outer = CoordinateFrame::default();
            control.frames_changed();
            Ok(())
        }
        Meaning::TableData => table(control, words),
        Meaning::Rotation => turned(control, words),
        Meaning::RotationOff => planes::end(control),
        _ => Err(control.refuse(
            "nc-frame",
            format!("{code} is not run: what the words count from then is not followed"),
        )),
    }
}

/// The linear words of a block, program units in mm; they are no motion. Those of other axes must be zero.
fn taken(
    control: &ControlState,
    words: &mut BlockWords,
    what: &str,
) -> Result<[Option<f64>; 3], Box<Diagnostic>> {
    let others = words.present & control.axes.mask & !(bit(b'X') | bit(b'Y') | bit(b'Z'));
    words.used |= others;
    for letter in b'A'..=b'Z' {
        if others & bit(letter) != 0 && words.get(letter) != Some(0.0) {
            return Err(
                control.refuse("nc-frame", format!("{what} of {} is not run", char::from(letter)))
            );
        }
    }
    for letter in [b'X', b'Y', b'Z'] {
        let place = control.axis_of(letter).filter(|place| control.axes.scale[*place] != 1.0);
        if place.is_some() && words.present & bit(letter) != 0 {
            let name = char::from(letter);
            let message =
                format!("{what} of {name} is not run, whose word is no axis value ([word.{name}])");
            return Err(control.refuse("nc-frame", message));
        }
    }
    let unit = control.modal.unit;
    let found = [b'X', b'Y', b'Z'].map(|letter| words.take(letter).map(|value| value * unit));
    // They move nothing.
    words.present &= !control.axes.mask;
    Ok(found)
}

fn local_zero(control: &mut ControlState, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
    if control.frames.plane.is_some() || !control.frames.outer.upright() {
        return Err(control.refuse("nc-frame", "G52 under a tilted plane or a turn is not run"));
    }
    if control.frames.preset && control.lexicon.language() != Language::Rs274 {
        return Err(control.refuse("nc-frame", "G52 after G92: how they add up is not settled"));
    }
    let shift = taken(control, words, "G52")?;
    let mut origin = control.frames.outer.origin;
    for (own, said) in origin.iter_mut().zip(shift) {
        *own = said.unwrap_or(*own);
    }
    control.frames.outer = CoordinateFrame::shifted(origin);
    control.frames_changed();
    Ok(())
}

/// G92: where the tool stands has these coordinates.
fn preset(control: &mut ControlState, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
    if control.frames.plane.is_some() || !control.to_work.upright() {
        return Err(control.refuse("nc-frame", "G92 under a tilted plane or a turn is not run"));
    }
    let along = control.set_along(words);
    let said = taken(control, words, "G92")?;
    if said.iter().all(Option::is_none) {
        if along {
            return Ok(());
        }
        return Err(control.refuse("nc-frame", "G92 without X, Y or Z"));
    }
    let unled: Vec<&str> = (0..3)
        .filter(|row| said[*row].is_some())
        .filter_map(|row| control.axes.cartesian[row])
        .filter(|place| control.said & (1 << place) == 0)
        .map(|place| control.machine.axes[place].name.as_str())
        .collect();
    if !unled.is_empty() {
        let message = format!(
            "G92 says what {} shows before the program has led it anywhere: the part lies where the machine happens to stand",
            unled.join(", ")
        );
        control.report.unplaced.get_or_insert((control.line, unled.join(", ")));
        control.note(Diagnostic::warning("nc-frame", message));
    }
    let point = control.point();
    let mut origin = control.frames.outer.origin;
    for row in 0..3 {
        if let Some(value) = said[row] {
            origin[row] += point[row] - value;
        }
    }
    control.frames.outer = CoordinateFrame::shifted(origin);
    control.frames.preset = true;
    control.frames_changed();
    Ok(())
}

/// G10: tables of the control. Lengths of registers are plain (L10 P R); the rest counts from the machine's zeros.
fn table(control: &mut ControlState, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
    let list = words.take(b'L');
    let register = words.take_number(b'P', control)?;
    match (list, register, words.take(b'R')) {
        (Some(10.0), Some(register), Some(length))
            if !control.modal.incremental && control.lexicon.language() == Language::Macro =>
        {
            let length = length * control.modal.unit;
            control.offsets.lengths.retain(|(known, _)| *known != register);
            control.offsets.lengths.push((register, length));
            match control.tools.length_on {
                true => control.length_changed(),
                false => Ok(()),
            }
        }
        _ => {
            let message = "G10 writes a table of the control: what that changes is not followed";
            let finding = Diagnostic::error("nc-frame", message);
            let help = "leave the block out of what is read, and state the work offset or length by --offsets";
            Err(control.placed(finding.help(help)).boxed())
        }
    }
}

/// `G68 X Y R`: the coordinates are turned in the plane about a point.
fn turned(control: &mut ControlState, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
    if words.present & (bit(b'I') | bit(b'J') | bit(b'K')) != 0 {
        return Err(control.refuse(
            "nc-frame",
            "G68 with I J K turns in space (a direction, not angles), which is not run",
        ));
    }
    if control.modal.incremental {
        return Err(control.refuse("nc-frame", "G68 under G91 is not run"));
    }
    let Some(angle) = words.take(b'R') else {
        return Err(control.refuse("nc-frame", "G68 without R: the angle stands in the control"));
    };
    let [first, second, third] = control.modal.plane.coordinates();
    control.frames.inner = CoordinateFrame::default();
    control.frames_changed();
    let said = taken(control, words, "G68")?;
    let here = control.point();
    let mut centre = Vector3::from_fn(|row, _| said[row].unwrap_or(here[row]));
    centre[third] = 0.0;
    let (sine, cosine) = libm::sincos(angle.to_radians());
    let mut axes = Matrix3::identity();
    axes[(first, first)] = cosine;
    axes[(first, second)] = -sine;
    axes[(second, first)] = sine;
    axes[(second, second)] = cosine;
    control.frames.inner = CoordinateFrame::new(axes, centre - axes * centre);
    control.frames_changed();
    Ok(())
}

/// `TRANS X10`, `ATRANS`, `ROT`, `AROT`, `SCALE`, `MIRROR`: the words after it. False if it is none of these.
pub(super) fn name(
    control: &mut ControlState,
    name: &str,
    words: &mut BlockWords,
) -> Result<bool, Box<Diagnostic>> {
    let said = words.present & control.axes.mask != 0;
    let frame = match name {
        // Without words each takes back all that the program has shifted and turned.
        "TRANS" | "ROT" | "SCALE" | "MIRROR" if !said => CoordinateFrame::default(),
        "TRANS" => shift(control, words)?,
        "ATRANS" => control.frames.inner.around(&shift(control, words)?),
        "ROT" => turn(control, words)?,
        "AROT" => control.frames.inner.around(&turn(control, words)?),
        "SCALE" | "ASCALE" | "MIRROR" | "AMIRROR" | "ROTS" | "AROTS" | "CROTS" => {
            return Err(control.refuse("nc-frame", format!("{name} is not run")));
        }
        _ => return Ok(false),
    };
    control.frames.inner = frame;
    control.frames_changed();
    Ok(true)
}

fn shift(
    control: &ControlState,
    words: &mut BlockWords,
) -> Result<CoordinateFrame, Box<Diagnostic>> {
    let by = taken(control, words, "a shift")?;
    Ok(CoordinateFrame::shifted(Vector3::from(by.map(Option::unwrap_or_default))))
}

fn turn(
    control: &ControlState,
    words: &mut BlockWords,
) -> Result<CoordinateFrame, Box<Diagnostic>> {
    let unit = control.modal.unit;
    let angles = taken(control, words, "a turn")?.map(|angle| angle.unwrap_or_default() / unit);
    if angles.iter().filter(|angle| **angle != 0.0).count() > 1 {
        return Err(control.refuse(
            "nc-frame",
            "ROT about several axes: their order is a parameter of the control",
        ));
    }
    Ok(CoordinateFrame::new(rotation([0, 1, 2], angles.map(f64::to_radians)), Vector3::zeros()))
}
