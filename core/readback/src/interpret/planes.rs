//! Tilted planes: which frame the words are in, and the axes that turn to it.
//!
//! A plane is a frame of the part; under it the linear words are the tip in that frame. The axes turn to it by words of
//! the program in front of it, or by the control: then it must be plain where to, else it is refused.

use nalgebra::{Matrix3, Vector3};
use post_grammar::nc::NcValue;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, Pose, Trace};
use post_machine::tilted_plane::rotation;
use post_machine::vector_choice::nearest_turn;
use post_plugin::{Language, Meaning};

use super::block_words::BlockWords;
use super::frame::CoordinateFrame;
use super::state::ControlState;
use crate::MotionKind;
use crate::g_code::GCode;

/// The tool stands upright on a plane if its axis misses the normal by no more, radians: words have few decimals.
const UPRIGHT: f64 = 1e-4;

/// Angles nearer than this are one, radians.
const SAME: f64 = 1e-7;

/// Which of two solutions is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum SolutionChoice {
    /// The program does not say.
    #[default]
    Any,
    /// The axis that tilts stands on its positive side: `SEQ+`.
    Plus,
    /// The axis that tilts stands on its negative side: `SEQ-`.
    Minus,
    /// The one next to where the axes stand, if no other is nearer in any of them; of two that are as near the
    /// positive.
    Nearest,
}

/// How the axes turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum PlaneTurn {
    /// The axes stay.
    #[default]
    Stay,
    /// The rotary axes turn alone.
    Alone,
    /// The linear axes keep the tip on its place.
    Move,
}

/// A G code of a tilted plane (`G68.2 X Y Z I J K`, `G254`).
pub(super) fn begin(
    control: &mut ControlState,
    code: GCode,
    words: &mut BlockWords,
) -> Result<(), Box<Diagnostic>> {
    if control.frames.plane.is_some() {
        return Err(control
            .refuse("nc-plane", "a tilted plane begins inside of another, which must end before"));
    }
    match code.parts() {
        (254, 0) => {
            let frame = as_it_stands(control)?;
            lay(control, frame)
        }
        (68, 2) => {
            if words.take(b'P').is_some_and(|form| form != 0.0) {
                return Err(control
                    .refuse("nc-plane", "G68.2 with P: only Euler angles (P0, or no P) are run"));
            }
            if control.modal.incremental {
                return Err(control.refuse(
                    "nc-plane",
                    "G68.2 under G91: whether its origin is a way is not settled",
                ));
            }
            let mut number = |letter: u8| words.take(letter).unwrap_or(0.0);
            let origin =
                Vector3::new(number(b'X'), number(b'Y'), number(b'Z')) * control.modal.unit;
            let angles = [b'I', b'J', b'K'].map(|letter| number(letter).to_radians());
            lay(control, CoordinateFrame::new(rotation([2, 0, 2], angles), origin))
        }
        _ => Err(control
            .refuse("nc-plane", format!("{code} is a form of a tilted plane that is not run"))),
    }
}

/// The axes turn to the plane in force: `G53.1`.
pub(super) fn turn(
    control: &mut ControlState,
    code: GCode,
    words: &mut BlockWords,
) -> Result<(), Box<Diagnostic>> {
    if control.frames.plane.is_none() {
        return Err(control.refuse(
            "nc-plane",
            format!("{code} turns the axes to a tilted plane, and none is in force"),
        ));
    }
    let pick = match words.take(b'P') {
        Some(1.0) => SolutionChoice::Plus,
        Some(2.0) => SolutionChoice::Minus,
        _ => SolutionChoice::Any,
    };
    turn_to(control, PlaneTurn::Alone, pick, MotionKind::Rapid).map(|_| ())
}

/// Ends the tilted plane: `G69`, `G255`, `CYCLE800()`.
pub(super) fn end(control: &mut ControlState) -> Result<(), Box<Diagnostic>> {
    control.sets_group(Meaning::TiltedPlaneOff);
    // G69 ends a turn in the plane too.
    let letters = matches!(control.lexicon.language(), Language::Macro | Language::Rs274);
    let turned = letters && !control.frames.inner.is_default();
    if turned {
        control.frames.inner = CoordinateFrame::default();
    }
    if control.frames.plane.take().is_some() || turned {
        control.frames_changed();
    }
    Ok(())
}

/// The words are in `frame` from here on, which is given in the coordinates of the program outside of any plane.
pub(super) fn lay(
    control: &mut ControlState,
    frame: CoordinateFrame,
) -> Result<(), Box<Diagnostic>> {
    control.frames.plane = Some(frame);
    control.frames_changed();
    Ok(())
}

/// The frame of the machine's own directions as the axes stand now, with the origin of the program: G254, CYCLE800 with
/// the rotary axes themselves.
pub(super) fn as_it_stands(control: &ControlState) -> Result<CoordinateFrame, Box<Diagnostic>> {
    let [Some(x), Some(y), Some(z)] = control.axes.cartesian else {
        return Err(control.refuse("nc-plane", "a tilted plane needs the axes X, Y and Z"));
    };
    let chain = control.state.solver.chain();
    let ways = [x, y, z].map(|place| chain.way_of(place, &control.at.joints));
    let axes = Matrix3::from_columns(&ways);
    let across =
        (axes.transpose() * axes - Matrix3::identity()).norm() < 1e-9 && axes.determinant() > 0.0;
    if !across {
        return Err(control.refuse("nc-plane", "X, Y and Z of this machine do not stand across one another as X, Y and Z of a frame do"));
    }
    Ok(CoordinateFrame::new(control.to_part.axes.transpose() * axes, Vector3::zeros()))
}

/// The normal of the plane in force, unit vector, part frame.
fn normal(control: &ControlState) -> Vector3<f64> {
    control.to_part.out_direction(Vector3::z())
}

/// The tool stands upright on the plane in force.
pub(super) fn upright(control: &ControlState) -> bool {
    let (axis, normal) = (control.at.pose.axis, normal(control));
    axis.dot(&normal) > 0.0 && axis.cross(&normal).norm() <= UPRIGHT
}

/// Turns the axes to the plane in force; where they go is answered too.
///
/// # Errors
/// The plane is out of reach, or it is not plain which solution the control takes.
pub(super) fn turn_to(
    control: &mut ControlState,
    how: PlaneTurn,
    pick: SolutionChoice,
    kind: MotionKind,
) -> Result<Joints, Box<Diagnostic>> {
    let to = solution(control, pick)?;
    let stands = (0..control.machine.axes.len()).all(|place| to[place] == control.at.joints[place]);
    if how != PlaneTurn::Stay {
        say_pointing(control, &to);
    }
    match how {
        _ if stands => {}
        PlaneTurn::Stay => {}
        PlaneTurn::Alone => control.go_joints(kind, &to),
        PlaneTurn::Move => control.turn_about_tip(kind, &to)?,
    }
    Ok(to)
}

/// Where the axes stand upright on the plane in force, the linear ones as they are.
fn solution(control: &ControlState, pick: SolutionChoice) -> Result<Joints, Box<Diagnostic>> {
    let last = control.at.joints;
    let sided = matches!(pick, SolutionChoice::Plus | SolutionChoice::Minus);
    let tilts = tilting(control);
    let on_side = |joints: &Joints| match (pick, tilts) {
        (SolutionChoice::Plus, Some(place)) => shown(control, place, joints) >= -SAME,
        (SolutionChoice::Minus, Some(place)) => shown(control, place, joints) <= SAME,
        _ => true,
    };
    if upright(control) && (!sided || on_side(&last)) {
        return Ok(last);
    }
    let found = reachable(control)?;
    let mut inside: Vec<Joints> = found.into_iter().filter(|joints| on_side(joints)).collect();
    if inside.is_empty() {
        return Err(control.refuse(
            "nc-plane",
            "no solution of the tilted plane lies within the travel of the rotary axes",
        ));
    }
    if inside.len() > 1 && pick == SolutionChoice::Nearest {
        let way = |joints: &Joints, place: usize| libm::fabs(joints[place] - last[place]);
        let rotary: Vec<usize> = rotary(control).collect();
        let nearer = |one: &Joints, other: &Joints| {
            rotary.iter().all(|&place| way(one, place) <= way(other, place) + SAME)
        };
        let best = inside.iter().position(|one| {
            inside.iter().all(|other| {
                let positive = tilts.is_some_and(|place| one[place] >= other[place]);
                nearer(one, other) && (!nearer(other, one) || positive)
            })
        });
        if let Some(best) = best {
            return Ok(inside[best]);
        }
    }
    match (inside.pop(), inside.is_empty()) {
        (Some(only), true) => Ok(only),
        _ => Err(control
            .placed(
                Diagnostic::error("nc-plane", "the rotary axes can turn to this plane in several ways, and which of them the control takes is not said")
                    .help("turn them by words of their own in a block in front of it"),
            )
            .boxed()),
    }
}

/// The turn to a plane says where the axes stand that point the tool: one that turns about the tool stays where it was.
fn say_pointing(control: &mut ControlState, to: &Joints) {
    let chain = control.state.solver.chain();
    let mut trace = Trace { joints: *to, turns: chain.turns(to), ..Trace::default() };
    chain.trace(&mut trace);
    let points = |place: &usize| {
        let direction = chain.joints()[*place].direction;
        direction.cross(&trace.axes[*place]).norm() > UPRIGHT
    };
    let said = rotary(control).filter(points).fold(0, |said, place| said | 1 << place);
    control.said |= said;
}

/// All ways in which the rotary axes stand upright on the plane in force, next to where they stand and within travel.
fn reachable(control: &ControlState) -> Result<Vec<Joints>, Box<Diagnostic>> {
    let last = control.at.joints;
    let pose = Pose { tip: control.at.pose.tip, axis: normal(control), edge: Vector3::zeros() };
    let cannot = |_| control.refuse("nc-plane", "the rotary axes cannot turn to this plane");
    let found = control.state.solver.inverse(&pose, &last, UPRIGHT).map_err(cannot)?;
    let mut inside: Vec<Joints> = Vec::new();
    for solution in &found {
        let mut joints = last;
        let mut fits = true;
        for place in rotary(control) {
            let travel = control.machine.axes[place].travel;
            joints[place] = nearest_turn(solution[place], last[place], travel);
            if let Some([least, most]) = travel {
                fits &= joints[place] >= least - 1e-9 && joints[place] <= most + 1e-9;
            }
        }
        let same = |known: &Joints| {
            rotary(control).all(|place| libm::fabs(known[place] - joints[place]) < SAME)
        };
        if fits && !inside.iter().any(same) {
            inside.push(joints);
        }
    }
    Ok(inside)
}

fn rotary(control: &ControlState) -> impl Iterator<Item = usize> + '_ {
    (0..control.machine.axes.len()).filter(|place| control.axes.rotary & (1 << place) != 0)
}

/// What an axis shows there, radians.
fn shown(control: &ControlState, place: usize, joints: &Joints) -> f64 {
    joints[place] + control.machine.axes[place].zero
}

/// The rotary axis that tilts: the first one seen from the tool.
fn tilting(control: &ControlState) -> Option<usize> {
    rotary(control).last()
}

/// What each of A, B, C shows where the axes stand upright on the plane, degrees: Q120 to Q122.
pub(super) fn angles(control: &ControlState, joints: &Joints) -> [f64; 3] {
    [b'A', b'B', b'C'].map(|letter| {
        control.axis_of(letter).map_or(0.0, |place| shown(control, place, joints).to_degrees())
    })
}

/// `#CS ON [0, 0, 10, 30, 0, 0]` of ISG: origin, and turns about X, Y and Z, made about Z first, then about the Y and X
/// that it leaves. `#CS ON [1] [MODE 1, 0, 0, 10, 30, 0, 0]` of Fagor: the turns are made about X first. Brackets of
/// their own in front say under which number the control keeps it.
fn coordinate_system(
    control: &mut ControlState,
    arguments: &[Option<NcValue>],
) -> Result<(), Box<Diagnostic>> {
    let words = arguments.iter().take_while(|value| matches!(value, Some(NcValue::Text(_))));
    let (words, values) = arguments.split_at(words.count());
    let mode = words.iter().flatten().find_map(|word| match word {
        NcValue::Text(text) => text.strip_prefix("MODE").map(|mode| mode.trim().to_owned()),
        _ => None,
    });
    let mut numbers = [0.0; 6];
    let known = matches!(mode.as_deref(), None | Some("1")) && matches!(values.len(), 3..=6);
    if !known {
        return Err(control.refuse(
            "nc-plane",
            "#CS ON in a form that is not run: an origin and angles are, of Fagor in MODE 1",
        ));
    }
    for (number, value) in numbers.iter_mut().zip(values) {
        if let Some(value) = value {
            let worth = control.variables.worth(value);
            *number = worth.map_err(|finding| control.placed(*finding).boxed())?;
        }
    }
    let [x, y, z, ..] = numbers;
    let [about_x, about_y, about_z] = [numbers[3], numbers[4], numbers[5]].map(f64::to_radians);
    let turned = match mode {
        Some(_) => rotation([0, 1, 2], [about_x, about_y, about_z]),
        None => rotation([2, 1, 0], [about_z, about_y, about_x]),
    };
    if control.frames.plane.is_some() {
        return Err(control
            .refuse("nc-plane", "a tilted plane begins inside of another, which must end before"));
    }
    let origin = Vector3::new(x, y, z) * control.modal.unit;
    lay(control, CoordinateFrame::new(turned, origin))
}

/// `CYCLE800(_FR, _TC, _ST, _MODE, _X0, _Y0, _Z0, _A, _B, _C, _X1, _Y1, _Z1, _DIR, _FR_I, _DMODE)`.
pub(super) fn call(
    control: &mut ControlState,
    name: &str,
    arguments: &[Option<NcValue>],
) -> Result<(), Box<Diagnostic>> {
    if name == "#CS ON" {
        return coordinate_system(control, arguments);
    }
    if name != "CYCLE800" {
        return Err(control
            .refuse("nc-plane", format!("{name} is a form of a tilted plane that is not run")));
    }
    if let Some(Some(NcValue::Text(record))) = arguments.get(1)
        && record.trim() == "0"
    {
        return end(control);
    }
    let number = |place: usize| -> Result<f64, Box<Diagnostic>> {
        match arguments.get(place) {
            Some(Some(value)) => {
                control.variables.worth(value).map_err(|finding| control.placed(*finding).boxed())
            }
            _ => Ok(0.0),
        }
    };
    let refuse = |what: String| Err(control.refuse("nc-plane", format!("CYCLE800: {what}")));
    if number(0)? != 0.0 {
        return refuse(format!(
            "_FR = {} draws the tool back to a place that stands in the control",
            number(0)?
        ));
    }
    let status = number(2)?;
    if libm::fmod(libm::fabs(status), 10.0) >= 1.0 && control.frames.plane.is_some() {
        return refuse(format!("_ST = {status} adds to the plane in force, which is not run"));
    }
    let mode = number(3)?;
    let numbers = |from: usize| -> Result<[f64; 3], Box<Diagnostic>> {
        Ok([number(from)?, number(from + 1)?, number(from + 2)?])
    };
    let unit = control.modal.unit;
    let (before, turns, behind) =
        (Vector3::from(numbers(4)?) * unit, numbers(7)?, Vector3::from(numbers(10)?) * unit);
    let direction = number(13)?;
    // A plane that is in force is replaced.
    end(control)?;
    let turned = if mode == 192.0 {
        stand_at(control, turns)?;
        as_it_stands(control)?
    } else {
        let Some(order) = turns_of(mode) else {
            return Err(control.refuse(
                "nc-plane",
                format!("CYCLE800: _MODE = {mode} is no sequence of turns about axes"),
            ));
        };
        CoordinateFrame::new(rotation(order, turns.map(f64::to_radians)), Vector3::zeros())
    };
    let frame =
        CoordinateFrame::shifted(before).around(&turned).around(&CoordinateFrame::shifted(behind));
    lay(control, frame)?;
    if direction != 0.0 && mode != 192.0 {
        // The axis whose sign it speaks of is told in the control's record of the head.
        turn_to(control, PlaneTurn::Alone, SolutionChoice::Any, MotionKind::Rapid)?;
    }
    Ok(())
}

/// The axes of three turns, each about the frame that those before it have made: two bits of `mode` each, the lowest
/// first, 1 for X, 2 for Y, 3 for Z; none if it is no such sequence.
pub fn turns_of(mode: f64) -> Option<[usize; 3]> {
    if !(0.0..64.0).contains(&mode) || libm::trunc(mode) != mode {
        return None;
    }
    let bits = mode as usize;
    let order = [bits & 3, bits >> 2 & 3, bits >> 4 & 3];
    order.iter().all(|axis| *axis > 0).then(|| order.map(|axis| axis - 1))
}

/// The rotary axes must stand where CYCLE800 names them: the first and second of the control's record, whose order the
/// program does not say.
fn stand_at(control: &ControlState, turns: [f64; 3]) -> Result<(), Box<Diagnostic>> {
    let mut left: Vec<f64> = rotary(control)
        .map(|place| shown(control, place, &control.at.joints).to_degrees())
        .collect();
    for turn in &turns[..left.len().min(2)] {
        let found =
            left.iter().position(|angle| libm::fabs(libm::remainder(angle - turn, 360.0)) < 0.01);
        let Some(found) = found else {
            let message = format!(
                "CYCLE800 turns a rotary axis to {turn}, where none stands: which is meant stands in the control's record of the head"
            );
            return Err(control
                .placed(
                    Diagnostic::error("nc-plane", message)
                        .help("turn the axes by words of their own in a block in front of it"),
                )
                .boxed());
        };
        left.remove(found);
    }
    Ok(())
}
