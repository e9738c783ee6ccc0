//! Path functions: straight lines, arcs about a pole, by radius, tangential; polar coordinates.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::items::BlockItems;
use super::{Answer, afterwards, functions, modes, not_thicker, plane};
use crate::interpret::arcs::MOST_TURNS;
use crate::interpret::block::BlockRequest;
use crate::interpret::block_words::{BlockWords, bit};
use crate::interpret::cycles;
use crate::interpret::go::MotionTarget;
use crate::interpret::state::{ArcPlane, ControlState};
use crate::{Curve, MotionKind};

/// Points nearer than this share a coordinate, mm.
const SHARED: f64 = 1e-6;

/// `L`: straight to the words of the block.
pub(super) fn line(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    let kind = modes(control, said, words)?;
    straight(control, kind, said, words, None)
}

/// Words without the name of a path function: M functions, feed, compensation; `M140 MB MAX`.
pub(super) fn alone(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    if words.present & control.axes.mask != 0 && !words.m.has(94) {
        return Err(control
            .refuse("nc-conversational", "words of axes without the name of a path function"));
    }
    let kind = modes(control, said, words)?;
    straight(control, kind, said, words, None)
}

/// `LN`: the surface's normal is for the compensation of the tool's radius, T is the tool axis.
pub(super) fn line_with_normal(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    // The surface's normal: along it the control moves the tool by what it is thicker.
    for name in ["NX", "NY", "NZ"] {
        if said.named(control, name)?.is_some() {
            not_thicker(control)?;
        }
    }
    let mut vector = Vector3::zeros();
    let mut any = false;
    for (row, name) in ["TX", "TY", "TZ"].into_iter().enumerate() {
        if let Some(part) = said.named(control, name)? {
            vector[row] = part;
            any = true;
        }
    }
    let kind = modes(control, said, words)?;
    straight(control, kind, said, words, any.then_some(vector))
}

fn straight(
    control: &mut ControlState,
    kind: MotionKind,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
    vector: Option<Vector3<f64>>,
) -> Answer<()> {
    let mut asked = BlockRequest::default();
    let functions = functions(control, words, &mut asked)?;
    let moving = words.present & control.axes.mask != 0 || vector.is_some();
    if functions.retract {
        if moving {
            return Err(control.refuse(
                "nc-conversational",
                "M140 beside words of axes: which goes first is not settled",
            ));
        }
        plane::retract(control, kind, said)?;
    } else if functions.machine {
        let rapid = kind == MotionKind::Rapid;
        control.machine_move(words, rapid)?;
        control.path.heading = None;
    } else if moving && !functions.within_a_turn {
        let mut target = control.target(words)?;
        target.vector = vector;
        travel(control, kind, &Curve::Straight, &target)?;
    }
    afterwards(control, functions, &asked)
}

/// Goes to a target, keeps which way it came, and calls the cycle that is called at each point.
fn travel(
    control: &mut ControlState,
    kind: MotionKind,
    path: &Curve,
    target: &MotionTarget,
) -> Answer<()> {
    control.begins();
    control.relies_on_nothing_left();
    let from = control.point();
    control.go(kind, path, target)?;
    let to = control.point();
    control.path.heading = match path {
        Curve::Straight => (to - from).try_normalize(SHARED),
        Curve::Arc { centre, normal, sweep } => {
            let tangent = normal.cross(&(to - centre)) * if *sweep < 0.0 { -1.0 } else { 1.0 };
            tangent.try_normalize(SHARED)
        }
        Curve::Spline(_) => None,
    };
    cycles::at_point(control)
}

/// `CC X+10 Y+5`: the pole; without words where the tool stands.
pub(super) fn pole(control: &mut ControlState, words: &mut BlockWords) -> Answer<()> {
    let here = control.point();
    let mut any = false;
    for (row, letter) in [b'X', b'Y', b'Z'].into_iter().enumerate() {
        if let Some(value) = words.take(letter) {
            let from = if words.incremental & bit(letter) != 0 { here[row] } else { 0.0 };
            control.path.pole[row] = Some(from + value * control.modal.unit);
            any = true;
        }
    }
    if !any {
        control.path.pole = [Some(here.x), Some(here.y), None];
    }
    Ok(())
}

/// `C`, `CR`, `CT`, `CP`, `LP`.
pub(super) fn curve(
    control: &mut ControlState,
    name: &str,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    let kind = modes(control, said, words)?;
    let mut asked = BlockRequest::default();
    let functions = functions(control, words, &mut asked)?;
    if functions.machine || functions.retract {
        return Err(control.refuse("nc-conversational", format!("M91 or M140 beside {name}")));
    }
    let clockwise = match (said.has("DR-"), said.has("DR+")) {
        (true, false) => Some(true),
        (false, true) => Some(false),
        _ => None,
    };
    let radius = words.take(b'R').map(|radius| radius * control.modal.unit);
    if words.present & control.axes.mask & !(bit(b'X') | bit(b'Y') | bit(b'Z')) != 0 {
        return Err(
            control.refuse("nc-arc", "a rotary axis turns along this curve, which is not followed")
        );
    }
    let from = control.point();
    let mut target = control.target(words)?;
    let mut end = Vector3::from_fn(|row, _| target.point[row].unwrap_or(from[row]));
    let turn =
        || clockwise.ok_or_else(|| control.refuse("nc-arc", format!("{name} without DR+ or DR-")));
    let path = match name {
        "C" => about_pole(control, from, end, turn()?)?,
        "CR" => {
            let radius = radius.ok_or_else(|| control.refuse("nc-arc", "CR without R"))?;
            let clockwise = turn()?;
            let [x, y] =
                control.centre_by_radius([from.x, from.y], [end.x, end.y], radius, clockwise)?;
            arc(control, ArcPlane::Xy, from, end, Vector3::new(x, y, from.z), clockwise)?
        }
        "CT" => tangential(control, from, end)?,
        _ => {
            let polar = polar(control, said, from)?;
            (end.x, end.y) = (polar.end.x, polar.end.y);
            match (name, clockwise) {
                ("LP", _) => Curve::Straight,
                (_, Some(clockwise)) => polar.arc(control, from, clockwise)?,
                (_, None) => return Err(control.refuse("nc-arc", "CP without DR+ or DR-")),
            }
        }
    };
    target.point = [Some(end.x), Some(end.y), Some(end.z)];
    travel(control, kind, &path, &target)?;
    afterwards(control, functions, &asked)
}

/// About the pole in the plane across the tool axis. Where the pole was given with Z too, all three coordinates count,
/// and the plane is that of two axes which start, end and pole share.
fn about_pole(
    control: &ControlState,
    from: Vector3<f64>,
    to: Vector3<f64>,
    clockwise: bool,
) -> Answer<Curve> {
    let [Some(x), Some(y), z] = control.path.pole else {
        return Err(control.refuse("nc-arc", "C without CC in front of it"));
    };
    let centre = Vector3::new(x, y, z.unwrap_or(from.z));
    let shares = |row: usize| {
        libm::fabs(from[row] - centre[row]) < SHARED && libm::fabs(to[row] - centre[row]) < SHARED
    };
    let plane = match z {
        Some(_) if !shares(2) && shares(0) => ArcPlane::Yz,
        Some(_) if !shares(2) && shares(1) => ArcPlane::Zx,
        _ => ArcPlane::Xy,
    };
    arc(control, plane, from, to, centre, clockwise)
}

fn arc(
    control: &ControlState,
    plane: ArcPlane,
    from: Vector3<f64>,
    to: Vector3<f64>,
    mut centre: Vector3<f64>,
    clockwise: bool,
) -> Answer<Curve> {
    if control.tools.across != ArcPlane::Xy {
        let message = "an arc with the tool along X or Y (TOOL CALL) is not run";
        return Err(control.refuse("nc-arc", message));
    }
    let [first, second, third] = plane.coordinates();
    let flat = |point: Vector3<f64>| [point[first], point[second]];
    let sweep = control.sweep([flat(from), flat(to), flat(centre)], clockwise)?;
    centre[third] = from[third];
    Ok(Curve::Arc { centre, normal: plane.normal(), sweep })
}

/// An arc that goes on from where the last motion led, without a corner.
fn tangential(control: &ControlState, from: Vector3<f64>, to: Vector3<f64>) -> Answer<Curve> {
    let heading = control.path.heading.map(|heading| [heading.x, heading.y]);
    let Some([hx, hy]) = heading.filter(|[x, y]| libm::hypot(*x, *y) > SHARED) else {
        return Err(control.refuse(
            "nc-arc",
            "CT goes on from the motion in front of it, and none in its plane is known",
        ));
    };
    let length = libm::hypot(hx, hy);
    let (hx, hy) = (hx / length, hy / length);
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    // To the left of the heading the arc turns counter-clockwise.
    let across = hx * dy - hy * dx;
    let chord = dx * dx + dy * dy;
    if libm::fabs(across) <= 1e-9 * chord.sqrt() || chord == 0.0 {
        return Ok(Curve::Straight);
    }
    let radius = chord / (2.0 * across);
    let centre = Vector3::new(from.x - hy * radius, from.y + hx * radius, from.z);
    arc(control, ArcPlane::Xy, from, to, centre, across < 0.0)
}

/// An end in polar coordinates.
struct PolarEnd {
    centre: Vector3<f64>,
    end: Vector3<f64>,
    /// The turn that is said, radians: `IPA`.
    by: Option<f64>,
}

fn polar(control: &ControlState, said: &BlockItems<'_>, from: Vector3<f64>) -> Answer<PolarEnd> {
    let [Some(x), Some(y), _] = control.path.pole else {
        return Err(control.refuse("nc-arc", "polar coordinates without CC in front of them"));
    };
    let (ox, oy) = (from.x - x, from.y - y);
    let unit = control.modal.unit;
    let radius = match (said.named(control, "PR")?, said.named(control, "IPR")?) {
        (Some(radius), _) => radius * unit,
        (None, Some(more)) => libm::hypot(ox, oy) + more * unit,
        (None, None) => libm::hypot(ox, oy),
    };
    let now = libm::atan2(oy, ox);
    let by = said.named(control, "IPA")?.map(f64::to_radians);
    let angle = match (said.named(control, "PA")?, by) {
        (Some(angle), _) => angle.to_radians(),
        (None, Some(by)) => now + by,
        (None, None) => now,
    };
    let (sine, cosine) = libm::sincos(angle);
    Ok(PolarEnd {
        centre: Vector3::new(x, y, from.z),
        end: Vector3::new(x + radius * cosine, y + radius * sine, from.z),
        by,
    })
}

impl PolarEnd {
    /// `CP`: more than a turn where `IPA` says so.
    fn arc(&self, control: &ControlState, from: Vector3<f64>, clockwise: bool) -> Answer<Curve> {
        if let Some(by) = self.by {
            if by != 0.0 && (by < 0.0) != clockwise {
                return Err(control.refuse("nc-arc", "CP turns the other way than DR says"));
            }
            if libm::fabs(by) > (MOST_TURNS + 1.0) * TAU {
                let message = format!("CP by {} turns", libm::fabs(by) / TAU);
                return Err(control.refuse("nc-arc", message));
            }
            return Ok(Curve::Arc { centre: self.centre, normal: Vector3::z(), sweep: by });
        }
        arc(control, ArcPlane::Xy, from, self.end, self.centre, clockwise)
    }
}
