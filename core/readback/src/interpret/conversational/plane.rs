//! Tilted planes by PLANE and cycle 19, the tip that is kept, and the way out along the tool.

use nalgebra::{Matrix3, Vector3};
use post_machine::tilted_plane::rotation;

use super::items::BlockItems;
use super::{Answer, feed_unit};
use crate::MotionKind;
use crate::interpret::block_words::{BlockWords, bit};
use crate::interpret::frame::CoordinateFrame;
use crate::interpret::planes::{self, PlaneTurn, SolutionChoice};
use crate::interpret::state::{ControlState, OrientationMode};
use crate::interpret::variables::VariableValue;

/// `PLANE SPATIAL SPA+30 SPB+0 SPC+0 TURN FMAX SEQ-`, and the other forms.
pub(super) fn plane(
    control: &mut ControlState,
    name: &str,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    // How rotary axes that turn without the tool count, and how far the tip is from where they turn about.
    said.pass(&["COORD ROT", "TABLE ROT"]);
    said.pass_named(control, &["DIST", "ABST"])?;
    if !control.frames.inner.is_default() {
        return Err(control
            .refuse("nc-plane", "a shift or turn inside of the tilted plane must end before it"));
    }
    let kind = match (said.has("FMAX"), words.take(b'F')) {
        (_, Some(feed)) => {
            control.modal.feed = Some(feed * feed_unit(control));
            MotionKind::Feed
        }
        _ => MotionKind::Rapid,
    };
    if said.has("MB MAX") || said.named(control, "MB")?.is_some_and(|way| way != 0.0) {
        retract(control, kind, said)?;
    }
    planes::end(control)?;
    let how = match ["TURN", "MOVE", "STAY"].map(|name| said.has(name)) {
        [true, false, false] => PlaneTurn::Alone,
        [false, true, false] => PlaneTurn::Move,
        [false, false, _] => PlaneTurn::Stay,
        _ => {
            let message = "two of TURN, MOVE and STAY: how the axes turn is not plain";
            return Err(control.refuse("nc-plane", message));
        }
    };
    if name == "PLANE RESET" {
        return reset(control, how);
    }
    let frame = match name {
        "PLANE SPATIAL" => spatial(control, said, ["SPA", "SPB", "SPC"])?,
        "PLANE EULER" => {
            let angles = angles(control, said, ["EULPR", "EULNU", "EULROT"])?;
            CoordinateFrame::new(rotation([2, 0, 2], angles), Vector3::zeros())
        }
        "PLANE VECTOR" => vectors(control, said)?,
        _ => {
            stands_as_said(control, words)?;
            planes::as_it_stands(control)?
        }
    };
    planes::lay(control, frame)?;
    let pick = match ["SEQ+", "SYM+", "SEQ-", "SYM-"].map(|name| said.has(name)) {
        [false, false, false, false] => SolutionChoice::Nearest,
        [_, _, false, false] => SolutionChoice::Plus,
        [false, false, _, _] => SolutionChoice::Minus,
        _ => {
            let message = "SEQ or SYM of both signs: which solution is meant is not plain";
            return Err(control.refuse("nc-plane", message));
        }
    };
    turned(control, how, pick, kind)
}

/// The axes turn, or their angles are told: Q120 to Q122.
fn turned(
    control: &mut ControlState,
    how: PlaneTurn,
    pick: SolutionChoice,
    kind: MotionKind,
) -> Answer<()> {
    let to = planes::turn_to(control, how, pick, kind);
    if how != PlaneTurn::Stay {
        to?;
        return Ok(());
    }
    // Where it is not plain they stay unknown: a program that reads them is refused.
    if let Ok(to) = to {
        for (name, angle) in ["Q120", "Q121", "Q122"].into_iter().zip(planes::angles(control, &to))
        {
            let put = control.variables.put(name, VariableValue::Number(angle));
            put.map_err(|finding| control.placed(*finding).boxed())?;
        }
    }
    Ok(())
}

fn reset(control: &mut ControlState, how: PlaneTurn) -> Answer<()> {
    let upright =
        (control.at.pose.axis - control.to_part.out_direction(Vector3::z())).norm() < 1e-4;
    if how != PlaneTurn::Stay && !upright {
        return Err(control.refuse("nc-plane", "PLANE RESET turns the axes back: where to is not plain; turn them by words in front of it"));
    }
    Ok(())
}

fn angles(control: &ControlState, said: &BlockItems<'_>, names: [&str; 3]) -> Answer<[f64; 3]> {
    let mut angles = [0.0; 3];
    for (angle, name) in angles.iter_mut().zip(names) {
        let Some(value) = said.named(control, name)? else {
            return Err(control.refuse("nc-plane", format!("{name} is not given")));
        };
        *angle = value.to_radians();
    }
    Ok(angles)
}

/// Turns about the fixed axes A, then B, then C.
fn spatial(
    control: &ControlState,
    said: &BlockItems<'_>,
    names: [&str; 3],
) -> Answer<CoordinateFrame> {
    let [a, b, c] = angles(control, said, names)?;
    Ok(CoordinateFrame::new(rotation([2, 1, 0], [c, b, a]), Vector3::zeros()))
}

/// B is the direction of X, which lies in the plane once its part along N, the normal, is taken off.
fn vectors(control: &ControlState, said: &BlockItems<'_>) -> Answer<CoordinateFrame> {
    let vector = |names: [&str; 3]| -> Answer<Vector3<f64>> {
        let mut vector = Vector3::zeros();
        for (row, name) in names.into_iter().enumerate() {
            vector[row] = said.named(control, name)?.unwrap_or(0.0);
        }
        Ok(vector)
    };
    let (base, normal) = (vector(["BX", "BY", "BZ"])?, vector(["NX", "NY", "NZ"])?);
    let z = normal.try_normalize(1e-9);
    let x = z.and_then(|z| (base - z * z.dot(&base)).try_normalize(1e-9));
    match (x, z) {
        (Some(x), Some(z)) => {
            Ok(CoordinateFrame::new(Matrix3::from_columns(&[x, z.cross(&x), z]), Vector3::zeros()))
        }
        _ => Err(control.refuse("nc-plane", "the vectors of the plane do not span it")),
    }
}

/// PLANE AXIAL names the rotary axes themselves, which must stand there.
fn stands_as_said(control: &mut ControlState, words: &mut BlockWords) -> Answer<()> {
    for letter in [b'A', b'B', b'C'] {
        let (Some(value), Some(place)) = (words.take(letter), control.axis_of(letter)) else {
            continue;
        };
        let shown = (control.at.joints[place] - control.zero[place]).to_degrees();
        if libm::fabs(libm::remainder(shown - value, 360.0)) > 0.01 {
            let message = format!(
                "{} is to stand at {value} and stands at {shown:.3}: turn it by words in front of the plane",
                char::from(letter)
            );
            return Err(control.refuse("nc-plane", message));
        }
    }
    Ok(())
}

/// `CYCL DEF 19.1 A+30 B+0 C+0`: the same angles; without any, or with zeros, it ends. The axes are turned by other
/// blocks.
pub(super) fn cycle_19(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    said.pass(&["FMAX"]);
    said.pass_named(control, &["DIST", "ABST"])?;
    planes::end(control)?;
    let angles = [b'A', b'B', b'C'].map(|letter| words.take(letter).unwrap_or(0.0).to_radians());
    words.used |= bit(b'F');
    if angles == [0.0; 3] {
        return Ok(());
    }
    let [a, b, c] = angles;
    planes::lay(control, CoordinateFrame::new(rotation([2, 1, 0], [c, b, a]), Vector3::zeros()))?;
    turned(control, PlaneTurn::Stay, SolutionChoice::Nearest, MotionKind::Rapid)
}

/// `FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS`.
pub(super) fn keep_tip(control: &mut ControlState, said: &BlockItems<'_>) {
    said.pass(&["F TCP", "F CONT", "AXIS POS", "PATHCTRL AXIS", "REFPNT TIP-TIP"]);
    control.set_tcp(true, None, false);
    control.modal.orientation = match said.has("PATHCTRL VECTOR") {
        true => OrientationMode::Circle,
        false => OrientationMode::Usual,
    };
}

/// `M140 MB MAX`, `M140 MB50`: back along the tool, to the end of the travel or by a way.
pub(super) fn retract(
    control: &mut ControlState,
    kind: MotionKind,
    said: &BlockItems<'_>,
) -> Answer<()> {
    let far = said.has("MB MAX") || said.has("MAX");
    let way = said.named(control, "MB")?.map(|way| way * control.modal.unit);
    let way = match (way, far) {
        (Some(way), false) => way,
        _ => farthest(control)?,
    };
    let axis = control.at.pose.axis;
    let tip = control.at.pose.tip + axis * way;
    let mut joints = control.at.joints;
    let turns = control.turns;
    if control.state.solver.place(tip, &mut joints, &turns).is_err() {
        return Err(
            control.refuse("nc-reach", "the linear axes cannot draw the tool back along its axis")
        );
    }
    // What the rapid at F99999 is for.
    let kind = if far { MotionKind::Rapid } else { kind };
    control.go_joints(kind, &joints);
    Ok(())
}

/// How far the tool can be drawn back along its axis before a linear axis comes to its end, mm.
fn farthest(control: &ControlState) -> Answer<f64> {
    let solver = &control.state.solver;
    let turns = control.turns;
    let (mut here, mut there) = (control.at.joints, control.at.joints);
    let tip = control.at.pose.tip;
    let placed = solver.place(tip, &mut here, &turns).is_ok()
        && solver.place(tip + control.at.pose.axis, &mut there, &turns).is_ok();
    let mut most = f64::INFINITY;
    for (place, axis) in control.machine.axes.iter().enumerate() {
        let rate = there[place] - here[place];
        if axis.joint.rotary || libm::fabs(rate) < 1e-9 {
            continue;
        }
        if let Some([low, high]) = axis.travel {
            let end = if rate > 0.0 { high } else { low };
            most = libm::fmin(most, (end - here[place]) / rate);
        }
    }
    if !placed || !most.is_finite() {
        return Err(control.refuse(
            "nc-reach",
            "M140 MB MAX goes to the end of the travel, which the machine file does not state",
        ));
    }
    Ok(libm::fmax(most, 0.0))
}

/// M94: a rotary axis shows its value within a turn; nothing moves.
pub(super) fn within_a_turn(control: &ControlState, words: &BlockWords) -> Answer<()> {
    for letter in [b'A', b'B', b'C'] {
        let named = words.present & (bit(b'A') | bit(b'B') | bit(b'C'));
        let Some(place) = control.axis_of(letter) else {
            continue;
        };
        let shown = (control.at.joints[place] - control.zero[place]).to_degrees();
        if (named == 0 || named & bit(letter) != 0) && !(-360.0..=360.0).contains(&shown) {
            let message = format!(
                "M94 brings the display of {} within a turn, from {shown:.3}: which words it counts from then is not followed",
                char::from(letter)
            );
            return Err(control.refuse("nc-conversational", message));
        }
    }
    Ok(())
}
