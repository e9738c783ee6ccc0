//! What is said of a point that cannot be reached and of a move that cannot be made.

use crate::accuracy::{LineariseError, PlacementError};
use crate::preview::wants_planes;
use crate::program::{MoveFeed, StraightMove};
use post_machine::axis_words;
use post_machine::axis_words::AxisWords;
use post_machine::dependent_limit::DependentLimit;
use post_machine::description::{
    Axis, LengthAxis, Machine, Method, Moves, Positions, Tcp, TextPlace,
};
use post_machine::diagnostic::{Diagnostic, LimitExcess, Short};
use post_machine::kinematics::travel::OverTravel;
use post_machine::kinematics::travel::passed;
use post_machine::kinematics::{Joints, Second, Unreachable};
use post_plugin::{Capabilities, Format};

/// Where the words are axis positions, the control adds the tool's length to those of the depth axis: away from the part
/// if they count that way.
pub(crate) fn depth_counts_down(machine: &Machine) -> Option<Diagnostic> {
    let axis = &machine.axes[axis_words::depth(machine)?];
    // One that stands across the tool has no say in its length.
    let towards = axis.joint.direction.dot(&machine.tool_axis) < -0.5;
    let adds = machine.control.tcp == Tcp::Post && machine.length_axis != LengthAxis::None;
    (adds && towards).then(|| {
        Diagnostic::error(
            "machine-depth",
            format!(
                "{} of {} counts towards the part: the control's length compensation would take a longer tool deeper into it",
                axis.name, machine.name
            ),
        )
        .help("ISO 841 has it count away from the part, on whichever side it moves: so its direction, or `reversed`, would have to say. An axis that does count towards the part (Z before a second spindle): [tool] length_axis = \"none\", where the control adds no length and the work offset is measured with the tool")
    })
}

/// `[control] planes` asks for planes that the dialect does not write.
pub(crate) fn no_planes(machine: &Machine) -> Diagnostic {
    let dialect = &machine.control.dialect;
    Diagnostic::warning(
        "planes",
        format!("[control] planes = true, and dialect `{dialect}` writes no tilted planes here: the rotary words are those of index axes"),
    )
    .help(format!("`post plugin show {dialect}` lists its options, which may switch them on"))
}

/// A control works out a tilted plane, and the feed in it, for slides that stand still.
pub(crate) fn plane_of_turned_slide(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let slide = machine.turned_slide().filter(|_| wants_planes(machine, writes))?;
    let message = format!(
        "[control] planes = true, and a rotary axis of {} turns {}: a tilted plane of the control is one for slides that stand still",
        machine.name, slide.name
    );
    Some(Diagnostic::error("planes", message).help("[control] planes = false"))
}

/// Retracts go along linear axes. Without one nothing leads the tool off the part before a tool change and at the end,
/// unless the machine file says where every axis stands then.
pub(crate) fn no_way_off(machine: &Machine) -> Option<Diagnostic> {
    let frame = &machine.frame;
    // What `change` does not say is what `park` says.
    let said = [&frame.park, &frame.change].iter().all(|positions| {
        let placed = |place: usize| positions.iter().any(|(joint, _)| *joint == place);
        (0..machine.axes.len()).all(placed)
    });
    let turns_alone = machine.axes.iter().all(|axis| axis.joint.rotary);
    (turns_alone && !said && frame.leave.is_none()).then(|| {
        Diagnostic::error(
            "retract",
            format!(
                "{} has no linear axis to lead the tool off the part with",
                machine.name
            ),
        )
        .help("[control] leave = { along = \"tool\", distance = 30 } leads the tool back along its own axis by so many mm, and `then = { A = 0 }` in it says where axes go from there; [control] park with a position for every axis leaves the way there to you")
    })
}

/// A control whose zero of the machine is the builder's, or a switch, gets from the machine file where to retract.
pub(crate) fn retract_not_said(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let lacks = writes.has(Capabilities::RETRACT_SAID) && !machine.frame.retract_said;
    let (joint, end) = machine.frame.retract.first().filter(|_| lacks)?;
    let axis = &machine.axes[*joint];
    Some(
        Diagnostic::error(
            "retract",
            format!(
                "no retract is said, and on this control {} at {:.3} mm, the end of its travel in the machine file, need not be where it stands clear: its zero of the machine is the builder's own, or a switch",
                axis.name,
                axis.reading(*end)
            ),
        )
        .help(format!(
            "[control] retract = {{ {} = … }} with the position as the control shows it (Okuma: from the zero of G16 H0; GRBL: minus the pull-off, or lower), {{}} where nothing is to retract (Klipper, Marlin: they have no machine coordinates), or [control.{}] retract with a block of its own",
            axis.name, machine.control.dialect
        )),
    )
}

/// A control without machine coordinates is sent to no position of theirs.
pub(crate) fn no_park(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let frame = &machine.frame;
    let keys = [("change", &frame.change), ("park", &frame.park), ("retract", &frame.aside)];
    let (key, _) = keys.iter().find(|(_, stands)| !stands.is_empty())?;
    writes.has(Capabilities::NO_PARK).then(|| {
        let dialect = &machine.control.dialect;
        let message = format!(
            "[control] {key}: the dialect {dialect} has no words for positions in machine coordinates"
        );
        Diagnostic::error("dialect", message).help(format!(
            "{key} = {{}}, and a move there by a line of the machine file's own ([control.{dialect}] retract, [program])"
        ))
    })
}

/// Why a point has no axis values.
pub(crate) fn refused(machine: &Machine, refused: &PlacementError) -> Diagnostic {
    match *refused {
        PlacementError::Unreachable(Unreachable::Axis { miss }) => Diagnostic::error(
            "out-of-reach",
            format!(
                "{} cannot point the tool this way: the nearest orientation misses by {:.4}°, {:.4}° is allowed",
                machine.name,
                miss.to_degrees(),
                machine.accuracy.axis_tolerance.to_degrees()
            ),
        )
        .extreme(LimitExcess {
            key: u64::MAX,
            by: miss,
            value: format!("{:.4}° off", miss.to_degrees()),
            remedy: String::new(),
        })
        .help(match machine.pointing().is_empty() && machine.tool_axis.z < 1.0 - 1e-6 {
            true => "the tool of this machine is drawn across Z ([tool] axis), and nothing turns it: a point without an axis of its own asks for Z; draw the tool along Z, or let the CAM system write the axis with each point (MULTAX/ON)",
            false => "another machine, another set-up, or --msys apply if the axes are written in another frame",
        }),
        PlacementError::Unreachable(Unreachable::Linear) => Diagnostic::error(
            "out-of-reach",
            format!("the linear axes of {} cannot bring the tip here at these angles", machine.name),
        ),
        PlacementError::Unreachable(Unreachable::Numeric { miss }) => Diagnostic::error(
            "out-of-reach",
            format!(
                "no axis values of {} were found for this point: the nearest pose misses it by {miss:.4} mm",
                machine.name
            ),
        )
        .help(match machine.solver(0.0).is_ok_and(|solver| solver.has_arm()) {
            true => "no stand of the arm was found that brings the tip here and points the tool so: does the part lie in its reach (--mount; lengths are mm), and does [tool] axis lead from the tip to the holder?",
            false => "this machine is solved numerically, from the point before: where the part sits (--mount), or a point between may help",
        }),
        PlacementError::Unreachable(Unreachable::Plane { miss }) => Diagnostic::error(
            "out-of-reach",
            format!(
                "the two linear axes of {} bring the tip no nearer than {miss:.4} mm to this point, or to the straight way there, with the tool pointing so; {} mm is allowed",
                machine.name,
                Short(machine.accuracy.tolerance)
            ),
        )
        .extreme(LimitExcess {
            key: u64::MAX - 1,
            by: miss,
            value: format!("{miss:.4} mm off"),
            remedy: String::new(),
        })
        .help("it takes a third linear axis across these two, or a tool that points to the line of the rotary axis here; is the part on that line (--mount, --msys)?"),
        PlacementError::OverTravel { over, .. } if no_position(machine, over) => {
            let axis = &machine.axes[over.joint];
            Diagnostic::error(
                "out-of-reach",
                format!(
                    "{} would have to stand at {:.3}°, and the nearest of its positions is {:.3}°",
                    axis.name,
                    axis.reading(over.value),
                    axis.reading(over.limit)
                ),
            )
            .help("an index axis stands at its positions alone: another set-up of the part")
        }
        PlacementError::OverTravel { over, tried } => {
            let axis = &machine.axes[over.joint];
            let diagnostic = Diagnostic::error(
                "over-travel",
                format!(
                    "{} would be {}; {}",
                    axis.name,
                    beyond(machine, &over),
                    match tried {
                        0 => "no way around it was found for the other axes".to_owned(),
                        1 => "there is no other solution".to_owned(),
                        tried => format!("none of the {tried} solutions stays inside travel"),
                    }
                ),
            );
            let diagnostic = diagnostic.extreme(extreme(machine, &over));
            if axis.joint.rotary {
                diagnostic.help("another set-up of the part, or a machine that tilts so far")
            } else {
                diagnostic.help(format!(
                    "{FINDS_A_MOUNT}; or give the tool's length, or say --units if the file's units are wrong"
                ))
            }
        }
        PlacementError::Unverified { tip, axis } => Diagnostic::error(
            "kinematics",
            format!(
                "the solution found misses the point by {tip:.6} mm and {:.6}° when it is put through the chain",
                axis.to_degrees()
            ),
        )
        .help("this is a fault of post: please report it with the machine file and this line"),
    }
}

/// Keys of [`LimitExcess`] beyond those of the ends of axes: the limits of a machine that depend on other axes.
const LIMITS: u64 = 1 << 32;

/// What to do about a linear axis that leaves its travel.
pub(crate) const FINDS_A_MOUNT: &str =
    "`post place CL-FILE --machine MACHINE` finds the --mount that fits, or says why there is none";

/// A limit that depends on other axes is passed at `joints`; `behind` says when.
pub(crate) fn beyond_limit(
    machine: &Machine,
    limit: &DependentLimit,
    joints: &Joints,
    behind: &str,
) -> Diagnostic {
    let told = limit.told(machine, joints);
    let place = machine.limits.iter().position(|other| other == limit).unwrap_or_default();
    let fault = Diagnostic::error("over-travel", format!("{told}{behind}"));
    let fault = match limit.passed_at(machine, joints) {
        Some((above, value)) => fault.extreme(LimitExcess {
            key: LIMITS + place as u64 * 2 + u64::from(above),
            by: limit.excess(joints),
            value,
            remedy: String::new(),
        }),
        None => fault,
    };
    fault.help(match limit.leg() {
            Some(_) => "another set-up of the part (--mount); where the tool is retracted or parked, [control] retract = { … }, leave or park that the drives reach",
            None => "another set-up of the part (--mount), another side ([solution] prefer), or a retract before the axes turn",
        })
}

/// `312.400 mm, its limit is 300.000 mm, passed by 12.400 mm`.
pub(crate) fn beyond(machine: &Machine, over: &OverTravel) -> String {
    let axis = &machine.axes[over.joint];
    let sign = sign(axis);
    format!(
        "{:.3}{sign}, its limit is {:.3}{sign}, passed by {:.3}{sign}",
        axis.reading(over.value),
        axis.reading(over.limit),
        by(axis, over)
    )
}

/// How far an axis leaves its travel, of all points at which it does on that side.
pub(crate) fn extreme(machine: &Machine, over: &OverTravel) -> LimitExcess {
    let axis = &machine.axes[over.joint];
    let sign = sign(axis);
    LimitExcess {
        key: over.joint as u64 * 2 + u64::from(over.value > over.limit),
        by: by(axis, over),
        value: format!(
            "{} {:.3}{sign}, passed by {:.3}{sign},",
            axis.name,
            axis.reading(over.value),
            by(axis, over)
        ),
        remedy: mount_inside(machine, over).unwrap_or_default(),
    }
}

/// What the readings of an axis are in.
fn sign(axis: &Axis) -> &'static str {
    if axis.joint.rotary { "°" } else { " mm" }
}

/// How far beyond the limit, mm or degrees.
fn by(axis: &Axis, over: &OverTravel) -> f64 {
    libm::fabs(over.value - over.limit) / axis.unit()
}

/// The mount that brings a linear axis to its limit and moves no other; none where a rotary axis turns the part under it,
/// so that a mount moves it otherwise at every angle.
fn mount_inside(machine: &Machine, over: &OverTravel) -> Option<String> {
    let axis = &machine.axes[over.joint];
    let mut between = machine.axes[..over.joint].iter();
    // Of two axes that go the same way the machine settles which goes how far.
    let with = |other: &Axis| match other.second {
        Some(Second::Share { of, .. } | Second::Reserve { of }) => of == over.joint,
        None => false,
    };
    let shared = axis.second.is_some() || machine.axes.iter().any(with);
    // A rail does not place the tip alone.
    let alone = || machine.solver(0.0).is_ok_and(|solver| solver.surplus().is_empty());
    if axis.joint.rotary || shared || between.any(|axis| axis.joint.rotary) || !alone() {
        return None;
    }
    // A little farther than the limit, so that no rounding passes it.
    let by = (over.value - over.limit).signum() * (libm::ceil(by(axis, over) * 1e3) / 1e3);
    let mount = machine.mount - axis.joint.direction * by;
    let [x, y, z] = [mount.x, mount.y, mount.z].map(|value| libm::rint(value * 1e3) / 1e3 + 0.0);
    Some(format!("--mount {x},{y},{z} brings {} to this limit", axis.name))
}

/// An index axis that has no position there, inside its travel.
fn no_position(machine: &Machine, over: OverTravel) -> bool {
    let axis = &machine.axes[over.joint];
    passed(axis.travel, over.value, 0.0).is_none()
        && axis.indexed.as_ref().is_some_and(|indexed| indexed.positions != Positions::Any)
}

/// Inside its travel, on the side of zero that the machine file forbids.
fn forbidden(machine: &Machine, over: &OverTravel) -> bool {
    let travel = machine.axes[over.joint].travel;
    let require = &machine.solution.require;
    passed(travel, over.value, 0.0).is_none()
        && require.iter().any(|(joint, _)| *joint == over.joint)
}

/// An indexed axis that stands differently.
fn indexes<'m>(machine: &'m Machine, from: &Joints, to: &Joints) -> Option<&'m Axis> {
    let moves = |(joint, axis): &(usize, &Axis)| {
        axis.indexed.is_some() && libm::fabs(from[*joint] - to[*joint]) > 1e-6
    };
    let mut axes = machine.axes.iter().enumerate();
    axes.find(moves).map(|(_, axis)| axis)
}

/// Where the rotary axes stand: `C 12.500° A -30.000°`.
fn rotary_values(machine: &Machine, joints: &Joints) -> String {
    let rotary = machine.axes.iter().zip(joints).filter(|(axis, _)| axis.joint.rotary);
    let each = rotary.map(|(axis, value)| format!("{} {:.3}°", axis.name, axis.reading(*value)));
    each.collect::<Vec<_>>().join(" ")
}

/// Why a cut cannot go on: what each solution asks of the axes, whether it is on the branch that the cut is
/// on, and where the axes stand before.
pub(crate) fn no_way(
    machine: &Machine,
    from: &Joints,
    tried: &[(Result<Joints, OverTravel>, bool, Joints)],
) -> Diagnostic {
    let rotary = |joints: &Joints| rotary_values(machine, joints);
    let reasons: Vec<String> = tried
        .iter()
        .map(|(carried, same, joints)| match carried {
            Err(over) if forbidden(machine, over) => {
                let axis = &machine.axes[over.joint];
                format!(
                    "going on to {} takes {} to {:.3}°, on the side of zero that [solution] require forbids",
                    rotary(joints),
                    axis.name,
                    axis.reading(over.value)
                )
            }
            Err(over) => {
                let axis = &machine.axes[over.joint];
                let travel = axis.travel.map_or(String::new(), |[least, most]| {
                    format!(
                        " (travel {:.3}° to {:.3}°)",
                        axis.reading(least),
                        axis.reading(most)
                    )
                });
                format!(
                    "going on to {} takes {} to {:.3}°{travel}",
                    rotary(joints),
                    axis.name,
                    axis.reading(over.value)
                )
            }
            Ok(joints) if let Some(axis) = indexes(machine, from, joints) => format!(
                "{} would turn in the cut, and it moves off the part alone (indexed): {}",
                axis.name,
                rotary(joints)
            ),
            Ok(joints)
                if let Some(limit) = machine.limits.iter().find(|limit| !limit.holds(joints)) =>
            {
                format!("going on to {}: {}", rotary(joints), limit.told(machine, joints))
            }
            Ok(joints) if *same => format!(
                "{} lies on the same branch, but no path of the axes keeps the tolerance",
                rotary(joints)
            ),
            Ok(joints) => format!(
                "{} lies on the other branch, and within a cut the axes go on in one",
                rotary(joints)
            ),
        })
        .collect();
    let help = if machine.rewind.is_some() {
        "[rewind] finds no way either: drawn back, the tool would leave the travel, or its plane lies below the tip"
    } else {
        "retract before this line, give the machine a [rewind], or let it start elsewhere: [solution] start, prefer"
    };
    Diagnostic::error(
        "jump",
        format!("this cut cannot go on from {}: {}", rotary(from), reasons.join("; ")),
    )
    .help(help)
}

/// Why a cut of a chain with joints beyond what a pose needs (`surplus`) cannot go on, and the solution nearest to where the
/// axes stand before.
pub(crate) fn no_way_of_arm(
    machine: &Machine,
    surplus: &[usize],
    from: &Joints,
    nearest: Option<Joints>,
) -> Diagnostic {
    let names: Vec<&str> = surplus.iter().map(|joint| machine.axes[*joint].name.as_str()).collect();
    let nearest = nearest.map_or(String::new(), |joints| {
        format!("; the nearest solution there is {}", rotary_values(machine, &joints))
    });
    Diagnostic::error(
        "jump",
        format!(
            "this cut cannot go on from {}: whether {} {} or gives way, the other axes do not come to its end inside their travel{nearest}",
            rotary_values(machine, from),
            names.join(", "),
            if surplus.len() == 1 { "stands still" } else { "stand still" },
        ),
    )
    .help("retract before this line, set the part elsewhere (--mount), or let the axes start elsewhere: [solution] start")
}

/// The machine file has text in the place of an event's, and the dialect cannot leave out what it writes for it.
pub(crate) fn no_instead(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let mut texts = machine.program.texts.iter();
    let text = texts.find(|text| text.at.replaces())?;
    (!writes.has(Capabilities::INSTEAD)).then(|| {
        let message = format!(
            "[program] {} of {}: the dialect {} cannot write other lines in the place of its own",
            text.at.key(),
            machine.name,
            machine.control.dialect
        );
        Diagnostic::error("dialect", message)
            .help("between_tools, after_tool_change and the others add lines, in every dialect")
    })
}

/// The machine file has a mode of the control in which a word is another coordinate, and the dialect cannot write that.
pub(crate) fn no_word_letter(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let lacks = machine.has_modes() && !writes.has(Capabilities::WORD_LETTER);
    lacks.then(|| {
        let message = format!(
            "[mode] of {}: the dialect {} has no polar interpolation, and none on a cylinder",
            machine.name, machine.control.dialect
        );
        Diagnostic::error("dialect", message)
            .help("leave [mode] out: faces and mantles are written in words of the axes then")
    })
}

/// The sign of a rotary word is its way, and the dialect cannot say that.
pub(crate) fn no_signed_way(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let signed = |machine: &Machine| machine.axes.iter().any(|axis| axis.signed);
    (signed(machine) && !writes.has(Capabilities::SIGN_IS_WAY)).then(|| {
        let message = format!(
            "way = \"sign\" of {}: the dialect {} has no words whose sign is the way",
            machine.name, machine.control.dialect
        );
        Diagnostic::error("dialect", message)
            .help("way = \"counted\", or \"shorter\" where the control takes the shorter way")
    })
}

/// Cuts are to be led straight, and the dialect has no words for that or the machine is none whose tool a control would turn
/// evenly.
pub(crate) fn no_poses(machine: &Machine, writes: Capabilities, plans: bool) -> Option<Diagnostic> {
    if machine.control.moves != Moves::Straight {
        return None;
    }
    let name = &machine.name;
    let arm = machine.solver(0.0).is_ok_and(|solver| solver.spins());
    let message = if !writes.has(Capabilities::POSES) {
        let dialect = &machine.control.dialect;
        format!("[control] moves of {name}: the dialect {dialect} has no poses of a tool")
    } else if !arm || machine.axes.iter().any(|axis| axis.carries_part) {
        format!(
            "[control] moves of {name}: an arm of six axes is led straight, by itself or on a rail, whose tool turns about itself freely; axes that carry the part lead joints alone"
        )
    } else if machine.word_map.is_some() || machine.in_face().is_some() {
        format!("[control] moves of {name}: words that are no axis values do not go with poses")
    } else if plans || machine.accuracy.method == Method::Compensate {
        format!(
            "[control] moves of {name}: a planned feed and [accuracy] method = \"compensate\" know how axes go, and not how a control leads a tool"
        )
    } else {
        return None;
    };
    Some(Diagnostic::error("dialect", message).help("moves = \"joints\" leads all joints evenly"))
}

/// The machine file asks the control to smooth, and the dialect has no words for it.
pub(crate) fn no_smoothing(machine: &Machine, writes: Capabilities) -> Option<Diagnostic> {
    let own = machine.program.text(TextPlace::SmoothingOn).is_some();
    (machine.smoothing.any() && !own && !writes.has(Capabilities::SMOOTHING)).then(|| {
        let message = format!(
            "[program.smoothing] of {}: the dialect {} has no words for smoothing",
            machine.name, machine.control.dialect
        );
        Diagnostic::error("dialect", message)
            .help("leave the table out, or give the lines of your own: smoothing_on and smoothing_off of [program]")
    })
}

/// Tolerances below what the words round off, reported before anything is made: pieces without end would go in, and none
/// of them help.
pub(crate) fn too_fine(machine: &Machine, format: &Format) -> Option<Diagnostic> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    heads.chain([machine]).find_map(|machine| {
        let accuracy = &machine.accuracy;
        let [linear, rotary] = AxisWords::new(machine, format).half_decimal();
        let turns = rotary.to_degrees();
        [
            ("tolerance", accuracy.tolerance, linear, " mm"),
            ("rapid_tolerance", accuracy.rapid_tolerance, linear, " mm"),
            ("axis_tolerance", accuracy.axis_tolerance.to_degrees(), turns, "°"),
        ]
        .into_iter()
        // Degrees come from radians, whose last bits do not count.
        .find(|(_, tolerance, half, _)| *tolerance < half * (1.0 - 1e-12))
        .map(|(key, tolerance, half, unit)| {
            Diagnostic::error(
                "tolerance",
                format!(
                    "[accuracy] {key} is {}{unit}, and the words of {} are rounded by up to {}{unit}: no program could keep it",
                    Short(tolerance),
                    machine.name,
                    Short(half)
                ),
            )
            .help(format!("widen {key}, or have the words written with more decimals, if the control takes them"))
        })
    })
}

/// Why a move cannot be brought within tolerance.
pub(crate) fn stuck(
    machine: &Machine,
    stuck: &LineariseError,
    motion: &StraightMove,
) -> Diagnostic {
    match stuck {
        LineariseError::Refused(refused) => {
            let mut diagnostic = self::refused(machine, refused);
            diagnostic.message = format!("on the way to this point: {}", diagnostic.message);
            diagnostic
        }
        LineariseError::Rounding { tip, axis, allowed } => Diagnostic::error(
            "rounding",
            format!(
                "the decimals of the dialect alone move the tip by {tip:.6} mm and the tool axis by {:.6}°; allowed are {:.6} mm and {:.6}°",
                axis.to_degrees(),
                finite(allowed.tip, machine.accuracy.tolerance - motion.chord),
                finite(allowed.axis, machine.accuracy.axis_tolerance).to_degrees()
            ),
        )
        .help("more decimals in [control] or a wider tolerance in [accuracy]"),
        LineariseError::Jump { joint, from, to } => Diagnostic::error(
            "jump",
            format!(
                "{} must jump from {:.3}° to {:.3}° {}: no path of the axes keeps the tolerance",
                machine.axes[*joint].name,
                machine.axes[*joint].reading(*from),
                machine.axes[*joint].reading(*to),
                match motion.pace {
                    MoveFeed::Rapid => "on this way off the part",
                    _ => "within this cut",
                }
            ),
        )
        .help(match machine.axes[*joint].travel {
            Some(travel) if ends_near(travel, *from) || ends_near(travel, *to) => "its travel ends here and the other solution lies far away: retract before this line, or set the part differently",
            _ => "the other solution lies far away: retract before this line, or set the part differently",
        }),
        LineariseError::Model(message) => Diagnostic::error(
            "model",
            format!("the error model {} cannot answer: {message}", machine.accuracy.model),
        ),
    }
}

/// What is allowed, or what the machine file says where nothing is held.
fn finite(allowed: f64, said: f64) -> f64 {
    if allowed.is_finite() { allowed } else { said }
}

/// An end of the travel is no farther than a degree.
fn ends_near([least, most]: [f64; 2], value: f64) -> bool {
    (value - least).min(most - value) < 1f64.to_radians()
}

/// A cut from a point that nothing of the program leads to.
pub(crate) fn cut_from_outside() -> Diagnostic {
    Diagnostic::error(
        "operation",
        "this cut begins where a move ends that is not part of the program: the tool would come to its end at rapid",
    )
    .help("choose the operation before it too, or let the CAM system begin this one with a rapid")
}

/// Another solution is taken where the program has the tool's vector alone: the control would go on with the nearest one.
pub(crate) fn no_vector_says_it(machine: &Machine, joints: &Joints) -> Diagnostic {
    let message = format!(
        "here the rotary axes are turned to another solution, {}, and the program has the tool's vector in their place: \
         the control would go on with the nearest solution",
        rotary_values(machine, joints)
    );
    Diagnostic::error("jump", message).help(
        "write rotary words: leave out orientation = \"vector\" ([control]) or the dialect's option tool_vector, tool_vectors; or keep to one solution: [solution] require, start, prefer, a smaller part of the travel",
    )
}
