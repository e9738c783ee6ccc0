//! Statements of robots' languages that lead the joints of an arm to positions or its tool straight to a pose, and what
//! stands between them.
//!
//! The dialect's vocabulary says what a name does (`MoveAbsJ`, `PTP`, `movej` are [`Meaning::JointMove`]); where the
//! positions, the time and the speed stand in a statement is told by how it is written. All else might move the arm, and is
//! refused.

use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};
use post_grammar::nc::{NcBlock, NcItem, NcTerm};
use post_machine::description::InverseTime;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;
use post_plugin::{ARM_AXES, ARM_JOINTS, Meaning, arm_axis};

use super::go::MotionTarget;
use super::relied::ModalGroup;
use super::spindle_request::SpindleRequest;
use super::state::{ControlState, FeedMeaning};
use crate::lexicon::WordMeaning;
use crate::{Curve, Interpolation, MotionKind, ProgramEvent};

type Answer<T> = Result<T, Box<Diagnostic>>;

/// From this on a position of an axis beside the arm says that there is none.
const NO_AXIS: f64 = 8.9e9;

/// A pose that the joints miss by more than this is not reached, mm, its frame on the arm of the search.
const STANDS: f64 = 1e-6;

/// A quaternion is as much longer or shorter than 1 by its printed places; RAPID wants it to be 1 (RAPID reference manual,
/// orient: "the orientation must be normalised").
const NORMAL: f64 = 1e-3;

/// A variable that was filled with where the joints stand, and what was set of it since.
#[derive(Clone, Debug, Default)]
pub(super) struct JointVariable {
    name: String,
    said: Vec<JointPosition>,
}

/// Where an axis of a robot's control is to go.
#[derive(Clone, Copy, Debug)]
struct JointPosition {
    /// Which, from 0; those beside the arm from [`ARM_JOINTS`] on.
    place: usize,
    /// Degrees, or mm of one that slides.
    value: f64,
}

/// Positions that a statement leads to.
#[derive(Clone, Debug)]
struct JointTarget {
    positions: Vec<JointPosition>,
    /// The others stand where they stand.
    some: bool,
}

/// How fast a statement leads.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pace {
    /// As fast as the axes go.
    Rapid,
    /// So many minutes.
    Minutes(f64),
    /// The tip at so many mm/min.
    Tip(f64),
}

/// Runs the statement of a line.
pub(super) fn run(control: &mut ControlState, block: &NcBlock) -> Answer<()> {
    for remark in &block.remarks {
        control.remark(remark);
    }
    for item in &block.items {
        if let NcItem::Statement(terms) = item {
            statement(control, terms)?;
        }
    }
    Ok(())
}

fn statement(control: &mut ControlState, terms: &[NcTerm]) -> Answer<()> {
    let terms = match terms.split_last() {
        Some((NcTerm::Sign(b';'), rest)) => rest,
        _ => terms,
    };
    if terms.contains(&NcTerm::Sign(b';')) {
        return Err(control.refuse("nc-statement", "more than one statement stands in this line"));
    }
    let name = match terms.first() {
        // What a file of KUKA's begins with.
        None | Some(NcTerm::Sign(b'&')) => return Ok(()),
        Some(NcTerm::Name(name)) => name,
        Some(_) => return Err(control.refuse("nc-statement", "no statement begins so")),
    };
    if let Some((left, right)) = assignment(terms) {
        return assign(control, left, right);
    }
    let with_switch = match terms {
        [_, NcTerm::Sign(b'\\'), NcTerm::Name(switch), ..] => {
            control.lexicon.name(&format!("{name} \\{switch}"))
        }
        _ => WordMeaning::Unknown,
    };
    let sense = match with_switch {
        WordMeaning::Unknown => control.lexicon.name(name),
        known => known,
    };
    let WordMeaning::Means(meaning) = sense else {
        let message = format!("{name} is no statement that is known here, and might move the arm");
        return Err(control.refuse("nc-statement", message));
    };
    obey(control, name, meaning, &terms[1..])
}

fn obey(control: &mut ControlState, name: &str, meaning: Meaning, terms: &[NcTerm]) -> Answer<()> {
    let number = || terms.iter().find_map(first_number);
    let due = |control: &ControlState| {
        let message = format!("{name} does not say its number");
        number().ok_or_else(|| control.refuse("nc-statement", message))
    };
    match meaning {
        Meaning::Nothing => {}
        Meaning::AnyConfiguration => control.sets_group(meaning),
        Meaning::ToolFrame => control.set_robot_frame(ModalGroup::ToolFrame, terms),
        Meaning::ToolAndFrame => return control.set_robot_frames(terms),
        Meaning::JointMove => return joint_move(control, name, terms),
        Meaning::StraightMove => return straight_move(control, name, terms),
        Meaning::PoseMove => {
            let message =
                format!("{name} is no straight move, and how it comes to its pose is not followed");
            return Err(control.refuse("nc-statement", message));
        }
        Meaning::Dwell => {
            let event = ProgramEvent::Dwell { time: due(control)?, revolutions: false };
            control.tell(event);
        }
        Meaning::Stop => return control.stop(ProgramEvent::Stop),
        Meaning::OptionalStop => return control.stop(ProgramEvent::OptionalStop),
        Meaning::End => control.end(),
        Meaning::ToolChange => {
            let number = due(control)?;
            let number = super::block_words::which(b'T', number, control)?;
            return control.change_tool(Some(number), None);
        }
        Meaning::SpindleClockwise | Meaning::SpindleCounterClockwise => {
            control.modal.speed = due(control)?;
            control.turn_spindle(match meaning {
                Meaning::SpindleClockwise => SpindleRequest::Clockwise,
                _ => SpindleRequest::CounterClockwise,
            });
        }
        Meaning::SpindleOff => control.turn_spindle(SpindleRequest::Off),
        Meaning::SpindleOrient => control.turn_spindle(SpindleRequest::Oriented),
        Meaning::CoolantOn => control.coolant(match terms.iter().find_map(first_text) {
            Some("Flood") => 8,
            Some("Mist") => 7,
            _ => 0,
        }),
        Meaning::CoolantOff => control.coolant_off(),
        _ => {
            let message = format!("{name} is not run: what the arm does then is not followed");
            return Err(control.refuse("nc-statement", message));
        }
    }
    Ok(())
}

/// What stands on both sides of `=` or `:=`, if the statement sets a variable.
fn assignment(terms: &[NcTerm]) -> Option<(&[NcTerm], &[NcTerm])> {
    let at = terms.iter().position(|term| *term == NcTerm::Sign(b'='))?;
    let (left, right) = (&terms[..at], &terms[at + 1..]);
    let left = match left.split_last() {
        Some((NcTerm::Sign(b':'), rest)) => rest,
        _ => left,
    };
    matches!(left, [NcTerm::Name(_)] | [NcTerm::Name(_), NcTerm::Group(b'[', _)])
        .then_some((left, right))
}

/// A variable gets a value: that of joint positions, one of its components, or one that moves nothing.
fn assign(control: &mut ControlState, left: &[NcTerm], right: &[NcTerm]) -> Answer<()> {
    let Some(NcTerm::Name(name)) = left.first() else {
        return Ok(());
    };
    if let Some(NcTerm::Name(asked)) = right.first()
        && control.lexicon.name(asked) == WordMeaning::Means(Meaning::JointsNow)
        && left.len() == 1
    {
        control.joint_variable = JointVariable { name: name.clone(), said: Vec::new() };
        return Ok(());
    }
    let (whole, component) = name.split_once('.').unwrap_or((name, ""));
    if !control.joint_variable.name.is_empty() && control.joint_variable.name == whole {
        let set = match left.get(1) {
            None => component_place(component).zip(angle(right, false)),
            Some(NcTerm::Group(_, index)) => index_of(index).zip(angle(right, true)),
            Some(_) => None,
        };
        let Some((place, value)) = set else {
            let message = format!("what {name} becomes is not understood");
            return Err(control.refuse("nc-statement", message));
        };
        control.joint_variable.said.push(JointPosition { place, value });
        return Ok(());
    }
    match control.lexicon.name(name) {
        WordMeaning::Means(Meaning::Nothing) => Ok(()),
        // `$VEL.CP`, m/s.
        WordMeaning::Means(Meaning::Feed) => {
            control.path_velocity = angle(right, false).filter(|velocity| *velocity > 0.0);
            Ok(())
        }
        WordMeaning::Means(Meaning::ToolFrame) => {
            control.set_robot_frame(ModalGroup::ToolFrame, right);
            Ok(())
        }
        WordMeaning::Means(Meaning::WorkOffset) => {
            control.set_robot_frame(ModalGroup::BaseFrame, right);
            Ok(())
        }
        _ => {
            let message = format!("{name} is set here, and might change how the arm moves");
            Err(control.refuse("nc-statement", message))
        }
    }
}

/// `ROBAX.RAX_1`, `EXTAX.EAX_A`.
fn component_place(component: &str) -> Option<usize> {
    if let Some(number) = component.strip_prefix("ROBAX.RAX_") {
        return number.parse::<usize>().ok()?.checked_sub(1).filter(|place| *place < ARM_JOINTS);
    }
    let letter = component.strip_prefix("EXTAX.EAX_")?;
    let place = "ABCDEF".find(letter).filter(|_| letter.len() == 1)?;
    Some(ARM_JOINTS + place)
}

/// `[0]`: the first joint.
fn index_of(terms: &[NcTerm]) -> Option<usize> {
    match terms {
        [NcTerm::Number(number)] => (0..ARM_AXES).find(|place| *place as f64 == number.value),
        _ => None,
    }
}

/// Degrees (or mm): a number, `D2R(30)`; a number alone is of `radians` where its language has them.
fn angle(terms: &[NcTerm], radians: bool) -> Option<f64> {
    match terms {
        [NcTerm::Number(number)] if radians => Some(number.value.to_degrees()),
        [NcTerm::Number(number)] => Some(number.value),
        [NcTerm::Name(name), NcTerm::Group(b'(', inside)] if radians && name == "D2R" => {
            angle(inside, false)
        }
        _ => None,
    }
}

/// Parts between commas.
fn parts(terms: &[NcTerm]) -> Vec<&[NcTerm]> {
    terms.split(|term| *term == NcTerm::Sign(b',')).collect()
}

/// The first number of a term.
fn first_number(term: &NcTerm) -> Option<f64> {
    match term {
        NcTerm::Number(number) => Some(number.value),
        NcTerm::Group(_, inside) => inside.iter().find_map(first_number),
        _ => None,
    }
}

/// The first text of a term.
fn first_text(term: &NcTerm) -> Option<&str> {
    match term {
        NcTerm::Text(text) => Some(text),
        NcTerm::Group(_, inside) => inside.iter().find_map(first_text),
        _ => None,
    }
}

/// Leads the joints to where the statement says.
fn joint_move(control: &mut ControlState, name: &str, terms: &[NcTerm]) -> Answer<()> {
    let arguments = match terms {
        [NcTerm::Group(b'(', inside)] => parts(inside),
        _ => parts(terms),
    };
    let not_read = |control: &ControlState| {
        let message = format!("the positions of {name} are not written as they are read here");
        control.refuse("nc-statement", message)
    };
    let Some((first, rest)) = arguments.split_first() else {
        return Err(not_read(control));
    };
    let target = match first.first() {
        Some(NcTerm::Name(variable)) if *variable == control.joint_variable.name => {
            Some(JointTarget { positions: control.joint_variable.said.clone(), some: true })
        }
        Some(NcTerm::Group(b'[', inside)) => listed(inside),
        Some(NcTerm::Group(b'{', inside)) => named(inside),
        _ => None,
    };
    let target = target.ok_or_else(|| not_read(control))?;
    let pace = pace(control, name, &first[1..], rest)?;
    go(control, &target, pace)
}

/// `[[0,0,0,0,30,0],[9E9,1500,..]]` in degrees, or `[d2r(0),-1.57,..]` in radians.
fn listed(inside: &[NcTerm]) -> Option<JointTarget> {
    let mut positions = Vec::new();
    let lists = parts(inside);
    let whole = match lists.as_slice() {
        [[NcTerm::Group(b'[', arm)], [NcTerm::Group(b'[', beside)]] => {
            let lists = [(0, parts(arm)), (ARM_JOINTS, parts(beside))];
            for (offset, list) in lists {
                for (place, part) in list.into_iter().enumerate() {
                    let value = angle(part, false)?;
                    if offset == 0 || value < NO_AXIS {
                        positions.push(JointPosition { place: offset + place, value });
                    }
                }
            }
            true
        }
        flat => {
            for (place, part) in flat.iter().enumerate() {
                positions.push(JointPosition { place, value: angle(part, true)? });
            }
            flat.len() == ARM_JOINTS
        }
    };
    whole.then_some(JointTarget { positions, some: false })
}

/// `{A1 0,A2 -90,E1 1500}` in degrees and mm.
fn named(inside: &[NcTerm]) -> Option<JointTarget> {
    let mut positions = Vec::new();
    for part in parts(inside) {
        let [NcTerm::Name(name), NcTerm::Number(number)] = part else {
            return None;
        };
        let place = arm_axis(name).filter(|_| name.len() == 2)?;
        positions.push(JointPosition { place, value: number.value });
    }
    Some(JointTarget { positions, some: true })
}

/// How fast a joint move goes: `v1000\T:=0.5` and the zone behind it; `t=0.5`; what stands behind the positions themselves
/// (`C_PTP`) leaves them.
fn pace(
    control: &mut ControlState,
    name: &str,
    behind: &[NcTerm],
    arguments: &[&[NcTerm]],
) -> Answer<Pace> {
    let mut pace = Pace::Rapid;
    let mut leaves = !behind.is_empty();
    for (place, argument) in arguments.iter().enumerate() {
        match argument {
            [NcTerm::Name(key), NcTerm::Sign(b'='), NcTerm::Number(number)] => match key.as_str() {
                "T" if number.value > 0.0 => pace = Pace::Minutes(number.value / 60.0),
                "R" => leaves |= number.value != 0.0,
                "A" | "V" | "T" => {}
                _ => return Err(not_known(control, name, key)),
            },
            [NcTerm::Name(speed), switches @ ..] if place == 0 => {
                pace = speed_of(speed, switches).ok_or_else(|| not_known(control, name, speed))?;
            }
            [NcTerm::Name(zone)] if place == 1 => leaves |= zone != "FINE",
            // The tool, and the work object: joints do not ask for them, straight moves look at them elsewhere.
            [NcTerm::Name(_), ..] if place == 2 => {}
            _ => return Err(not_known(control, name, "an argument")),
        }
    }
    if leaves {
        let message = format!(
            "{name} does not come to its positions: how far it leaves them is not followed"
        );
        control.note(Diagnostic::warning("nc-zone", message));
    }
    Ok(pace)
}

fn not_known(control: &ControlState, name: &str, what: &str) -> Box<Diagnostic> {
    control.refuse("nc-statement", format!("{what} of {name} is not understood"))
}

/// `VMAX`, `V100`, `V1000\T:=0.5`, `V1000\V:=10`.
fn speed_of(speed: &str, switches: &[NcTerm]) -> Option<Pace> {
    match switches {
        [] if speed == "VMAX" => Some(Pace::Rapid),
        [] => {
            let speed: f64 = speed.strip_prefix('V')?.parse().ok()?;
            Some(Pace::Tip(60.0 * speed))
        }
        [
            NcTerm::Sign(b'\\'),
            NcTerm::Name(switch),
            NcTerm::Sign(b':'),
            NcTerm::Sign(b'='),
            NcTerm::Number(number),
        ] if number.value > 0.0 => match switch.as_str() {
            "T" => Some(Pace::Minutes(number.value / 60.0)),
            "V" => Some(Pace::Tip(60.0 * number.value)),
            _ => None,
        },
        _ => None,
    }
}

/// Leads the tool straight to the pose that the statement says, in the frame of the machine.
fn straight_move(control: &mut ControlState, name: &str, terms: &[NcTerm]) -> Answer<()> {
    let arguments = match terms {
        [NcTerm::Group(b'(', inside)] => parts(inside),
        _ => parts(terms),
    };
    let not_read = |control: &ControlState| {
        let message = format!("the pose of {name} is not written as it is read here");
        control.refuse("nc-statement", message)
    };
    let Some((first, rest)) = arguments.split_first() else {
        return Err(not_read(control));
    };
    let (target, behind) = match first {
        [NcTerm::Group(b'[', inside), behind @ ..] => (target_pose(inside), behind),
        [NcTerm::Group(b'{', inside), behind @ ..] => (named_pose(inside), behind),
        [NcTerm::Name(p), NcTerm::Group(b'[', inside), behind @ ..] if p == "P" => {
            (rotated_pose(inside), behind)
        }
        _ => (None, &first[..0]),
    };
    let Some(PoseTarget { pose, beside }) = target else {
        return Err(not_read(control));
    };
    control.relies_on(ModalGroup::Configuration);
    if let [NcTerm::Group(b'[', inside), ..] = first {
        let length = quaternion_length(inside);
        if length.is_some_and(|length| libm::fabs(length - 1.0) > NORMAL) {
            let message = format!(
                "the quaternion of {name} is {:.4} long, and the control takes none that is not 1 long",
                length.unwrap_or_default()
            );
            return Err(control.refuse("nc-statement", message));
        }
        control.move_names_frames(name, rest.get(2))?;
    }
    control.relies_on_robot_frames();
    let pace = match (pace(control, name, behind, rest)?, control.path_velocity) {
        (Pace::Rapid, Some(velocity)) => Pace::Tip(60.0 * 1000.0 * velocity),
        (said, _) => said,
    };
    if pace == Pace::Rapid {
        let message = format!("{name} does not say how fast it leads the tool");
        return Err(control.refuse("nc-statement", message));
    }
    let frame = pose.rotation * Vector3::z();
    let wanted = Pose {
        tip: pose.translation.vector - control.machine.mount,
        axis: -frame,
        edge: pose.rotation * Vector3::x(),
    };
    let mut start = control.at.joints;
    for position in &beside {
        if let Some(axis) = axis_of(control, position)? {
            start[axis] = control.shown(axis, position.value);
        }
    }
    let joints = control.state.solver.search_stand(&wanted, &start, STANDS);
    let Some(joints) = joints else {
        let message = format!("the joints do not reach the pose of {name} from where they stand");
        return Err(control.refuse("nc-reach", message));
    };
    control.begins();
    control.relies_on_nothing_left();
    set_pace(control, pace, &joints);
    let from = control.at;
    let solver = &control.state.solver;
    let stands = solver.stand(&from.joints).zip(solver.stand(&joints));
    let way = stands
        .map_or(Interpolation::TipAndAxis, |(from, to)| Interpolation::led_straight(from, to));
    control.said |= (1 << control.machine.axes.len()) - 1;
    control.stand(&joints);
    control.moved(MotionKind::Feed, way, from);
    Ok(())
}

/// Where a statement leads the tool.
#[derive(Clone, Debug)]
struct PoseTarget {
    /// The frame of the tool in that of the machine, mm.
    pose: Isometry3<f64>,
    /// Where axes beside the arm go meanwhile; those that are not said stand.
    beside: Vec<JointPosition>,
}

/// The axis of the machine that a robot's control leads to a position; none of one beside the arm that the machine has not,
/// and that stands at zero: some programs write all six.
fn axis_of(control: &ControlState, position: &JointPosition) -> Answer<Option<usize>> {
    let JointPosition { place, value } = *position;
    let axis = control.machine.axes.iter().position(|axis| arm_axis(&axis.name) == Some(place));
    if axis.is_none() && value == 0.0 && place >= ARM_JOINTS {
        return Ok(None);
    }
    axis.map(Some).ok_or_else(|| {
        let message = format!(
            "{} has no axis {} of a robot, and the program leads it to {value}",
            control.machine.name,
            place + 1
        );
        control.refuse("nc-axis", message)
    })
}

/// Numbers of a list, `count` of them.
fn numbers<const N: usize>(terms: &[NcTerm]) -> Option<[f64; N]> {
    let list: Option<Vec<f64>> = parts(terms).into_iter().map(|part| angle(part, false)).collect();
    list?.try_into().ok()
}

/// `[[800,0,700],[0,0,1,0],[0,0,0,0],[9E9,..]]`: mm, and a quaternion with its scalar first.
fn target_pose(inside: &[NcTerm]) -> Option<PoseTarget> {
    let lists = parts(inside);
    let [
        [NcTerm::Group(b'[', place)],
        [NcTerm::Group(b'[', turn)],
        _,
        [NcTerm::Group(b'[', beside)],
    ] = lists.as_slice()
    else {
        return None;
    };
    let [w, i, j, k] = numbers(turn)?;
    let turn = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 0.5)?;
    let beside = numbers::<ARM_JOINTS>(beside)?.into_iter().enumerate();
    let beside = beside.filter(|(_, value)| *value < NO_AXIS);
    Some(PoseTarget {
        pose: Isometry3::from_parts(Vector3::from(numbers::<3>(place)?).into(), turn),
        beside: beside
            .map(|(place, value)| JointPosition { place: ARM_JOINTS + place, value })
            .collect(),
    })
}

/// How long the quaternion of a target is.
fn quaternion_length(inside: &[NcTerm]) -> Option<f64> {
    match parts(inside).get(1)? {
        [NcTerm::Group(b'[', turn)] => {
            let [w, i, j, k] = numbers(turn)?;
            Some(Quaternion::new(w, i, j, k).norm())
        }
        _ => None,
    }
}

/// `{X 800,Y 0,Z 700,A 0,B 90,C 0,E1 1500}`: mm, and degrees about Z, then about the new Y, then about the new X.
fn named_pose(inside: &[NcTerm]) -> Option<PoseTarget> {
    let mut said = [None; 6];
    let mut beside = Vec::new();
    for part in parts(inside) {
        let [NcTerm::Name(name), NcTerm::Number(number)] = part else {
            return None;
        };
        if name.len() == 2 {
            let place = arm_axis(name).filter(|place| *place >= ARM_JOINTS)?;
            beside.push(JointPosition { place, value: number.value });
            continue;
        }
        // Status and turn choose among the stances of an arm, and a straight move keeps its own.
        if matches!(name.as_str(), "S" | "T") {
            continue;
        }
        let place = "XYZABC".find(name.as_str()).filter(|_| name.len() == 1)?;
        said[place] = Some(number.value);
    }
    let [x, y, z, a, b, c] = said;
    let [a, b, c] = [a?, b?, c?].map(f64::to_radians);
    let turn = UnitQuaternion::from_euler_angles(c, b, a);
    Some(PoseTarget { pose: Isometry3::from_parts(Vector3::new(x?, y?, z?).into(), turn), beside })
}

/// `p[0.8,0,0.7,0,3.14,0]`: metres, and a turn about its own direction, radians.
fn rotated_pose(inside: &[NcTerm]) -> Option<PoseTarget> {
    let [x, y, z, i, j, k] = numbers(inside)?;
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(i, j, k));
    let pose = Isometry3::from_parts((Vector3::new(x, y, z) * 1000.0).into(), turn);
    Some(PoseTarget { pose, beside: Vec::new() })
}

/// Leads the axes of the machine to the positions.
fn go(control: &mut ControlState, target: &JointTarget, pace: Pace) -> Answer<()> {
    let mut joints = control.at.joints;
    let mut said = 0;
    for position in &target.positions {
        let axis = match axis_of(control, position) {
            // A list has all joints of an arm, whether the machine file has them or not.
            Err(_) if position.value == 0.0 && !target.some => continue,
            axis => axis?,
        };
        let Some(axis) = axis else { continue };
        joints[axis] = control.shown(axis, position.value);
        said |= 1 << axis;
    }
    // Some axes alone go to positions of the machine; all of them to a point of the program.
    if target.some && said != (1 << control.machine.axes.len()) - 1 {
        control.uncouple(&mut joints, said);
        let kind = if pace == Pace::Rapid { MotionKind::Rapid } else { MotionKind::Feed };
        set_pace(control, pace, &joints);
        return control.go_machine(kind, &joints, said);
    }
    control.begins();
    control.relies_on_nothing_left();
    let kind = if pace == Pace::Rapid { MotionKind::Rapid } else { MotionKind::Feed };
    set_pace(control, pace, &joints);
    let words = MotionTarget { joints, said, ..MotionTarget::default() };
    control.go(kind, &Curve::Straight, &words)
}

/// The time of the move to `joints` as the feed that is in force.
fn set_pace(control: &mut ControlState, pace: Pace, joints: &post_machine::kinematics::Joints) {
    let minutes = match pace {
        Pace::Rapid => return,
        Pace::Minutes(minutes) => minutes,
        Pace::Tip(feed) => {
            let tip = control.state.solver.chain().forward(joints).tip;
            (tip - control.at.pose.tip).norm() / feed
        }
    };
    control.modal.feed_mode = FeedMeaning::Inverse;
    control.modal.feed = (minutes > 0.0).then(|| match control.machine.control.inverse_time {
        InverseTime::Minutes => 1.0 / minutes,
        InverseTime::Seconds => 1.0 / (60.0 * minutes),
    });
}
