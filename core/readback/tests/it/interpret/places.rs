//! Where words lead: axis values, tip and tool axis.

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_plugin::Language;
use post_readback::{Curve, Interpolation, Offsets, WorkOffset};
use post_testkit::randomised;
use post_testmachines::Reference;

use super::{LETTERS, NAMES, letters, machine, ran, ran_in};

/// mm, and radians of the tool axis.
const SAME: f64 = 1e-9;

/// The chain with a tool of `length`, multiplied by isometries.
fn reference(machine: &Machine, length: f64) -> Reference {
    Reference {
        joints: machine.axes.iter().map(|axis| axis.joint).collect(),
        mount: machine.mount,
        tip: machine.gauge - machine.tool_axis * length,
        axis: machine.tool_axis,
    }
}

fn place(machine: &Machine, name: &str) -> usize {
    machine.axes.iter().position(|axis| axis.name == name).unwrap()
}

/// Five-axis machines of all kinds: tables, heads, both, nutating, one whose zeros are shifted.
const MACHINES: &[&str] = &[
    "ac-trunnion",
    "bc-trunnion",
    "dmu50",
    "duoblock",
    "head-head",
    "head-table-bc",
    "nutating-head",
    "nutating-table",
    "xyzbc-trt",
    "linuxcnc-5axis",
];

#[test]
fn machine_coordinates_are_what_the_axes_show() {
    for name in MACHINES {
        let machine = machine(name);
        let (rounds, mut rng) = randomised(20, 11);
        for _ in rounds {
            let mut joints = Joints::default();
            let mut words = "G0 G53".to_owned();
            for (joint, axis) in joints.iter_mut().zip(&machine.axes) {
                let [least, most] = axis.travel.unwrap_or([-3.0, 3.0]);
                // What can be written with six decimals.
                let shown = (axis.reading(rng.range(least, most)) * 1e6).round() / 1e6;
                *joint = shown * axis.unit() - axis.zero;
                words.push_str(&format!(" {}{shown:.6}", axis.name));
            }
            let done = letters(&machine, &words).whole();
            let motion = done.last();
            let (tip, axis) = reference(&machine, 0.0).forward(&joints[..machine.axes.len()]);
            assert!((motion.to.pose.tip - tip).norm() < 1e-6, "{name}: {words}");
            assert!((motion.to.pose.axis - axis).norm() < 1e-9, "{name}: {words}");
            assert!(motion.machine);
        }
    }
}

#[test]
fn words_of_axes_count_from_where_the_tip_stands_on_the_part() {
    for name in MACHINES {
        let machine = machine(name);
        let offsets = Offsets { lengths: vec![(3, 87.5)], ..Offsets::default() };
        let text = "T3 M6\nG43 H3\nG0 X0 Y0 Z0\n";
        let rotary: String = machine
            .axes
            .iter()
            .filter(|axis| axis.joint.rotary)
            .map(|axis| format!(" {}0", axis.name))
            .collect();
        let done = ran(&machine, LETTERS, &offsets, &format!("{text}G0{rotary}\n")).whole();
        let pose = done.last().to.pose;
        assert!(pose.tip.norm() < SAME, "{name}: {}", pose.tip);
        // From there on every axis goes by what its word says.
        let turned = format!("{text}G0{rotary}\nG1 F100 X12.5 Y-7.25 Z30");
        let done = ran(&machine, LETTERS, &offsets, &turned).whole();
        let [from, to] = [done.motions[done.motions.len() - 2].to.joints, done.last().to.joints];
        for (axis, way) in [("X", 12.5), ("Y", -7.25), ("Z", 30.0)] {
            let place = place(&machine, axis);
            assert!((to[place] - from[place] - way).abs() < SAME, "{name} {axis}");
        }
    }
}

#[test]
fn where_the_control_keeps_the_tip_words_are_the_tip() {
    for name in MACHINES {
        let machine = machine(name);
        let offsets = Offsets { lengths: vec![(3, 87.5)], ..Offsets::default() };
        let (rounds, mut rng) = randomised(20, 12);
        for _ in rounds {
            let tip = Vector3::from_fn(|_, _| (rng.range(-40.0, 40.0) * 1e3_f64).round() / 1e3);
            let mut words = format!("X{:.3} Y{:.3} Z{:.3}", tip.x, tip.y, tip.z);
            let mut turns = Vec::new();
            for (place, axis) in
                machine.axes.iter().enumerate().filter(|(_, axis)| axis.joint.rotary)
            {
                let [least, most] = axis.travel.unwrap_or([-3.0, 3.0]);
                let shown = axis.reading(rng.range(least, most)).round();
                words.push_str(&format!(" {}{shown}.", axis.name));
                turns.push((place, shown * axis.unit() - axis.zero));
            }
            let text = format!("T3 M6\nG43.4 H3\nG1 F500 X0 Y0 Z0\n{words}\n");
            let done = ran(&machine, LETTERS, &offsets, &text).whole();
            let motion = done.last();
            assert_eq!(motion.way, Interpolation::Tip(Curve::Straight), "{name}");
            for (place, value) in turns {
                assert!((motion.to.joints[place] - value).abs() < 1e-12, "{name}: {words}");
            }
            // The axes that it leads to bring the tip there.
            let joints = &motion.to.joints[..machine.axes.len()];
            let (reached, axis) = reference(&machine, 87.5).forward(joints);
            assert!((reached - tip).norm() < 1e-8, "{name}: {words}: {reached}");
            assert!((motion.to.pose.tip - tip).norm() < 1e-12);
            assert!((motion.to.pose.axis - axis).norm() < SAME);
            // The feed is the tip's.
            let way = (motion.to.pose.tip - motion.from.pose.tip).norm();
            assert!((motion.minutes - way / 500.0).abs() < 1e-12);
        }
    }
}

#[test]
fn a_vector_points_the_tool_and_the_axes_go_the_shorter_way() {
    let machine = machine("ac-trunnion");
    let text = "TRAFOOF\nG1 F500 X0 Y0 Z50 A0 C0\nTRAORI\nORIVECT\nX10 Y5 Z3 A3=0 B3=0.6 C3=0.8\n";
    let offsets = Offsets { length: Some(100.0), ..Offsets::default() };
    let done = ran_in(Language::Names, &machine, NAMES, &offsets, text).whole();
    let pose = done.last().to.pose;
    assert!((pose.axis - Vector3::new(0.0, 0.6, 0.8)).norm() < SAME);
    assert!((pose.tip - Vector3::new(10.0, 5.0, 3.0)).norm() < SAME);
    assert_eq!(done.last().way, Interpolation::TipAndAxis);
    // I J K where a word of letters says so.
    let text = "G43.5 H1\nG1 F500 X10. Y5. Z3. I0 J0.6 K0.8\n";
    let done = ran(&machine, LETTERS, &offsets, text).whole();
    assert!((done.last().to.pose.axis - Vector3::new(0.0, 0.6, 0.8)).norm() < SAME);
}

#[test]
fn work_offsets_shift_and_turn_the_program() {
    let machine = machine("ac-trunnion");
    let (x, c) = (place(&machine, "X"), place(&machine, "C"));
    let mut work = WorkOffset { name: "G55".to_owned(), ..WorkOffset::default() };
    work.shift[x] = 10.0;
    work.shift[c] = 90f64.to_radians();
    let offsets = Offsets { work: vec![work], length: Some(100.0), ..Offsets::default() };
    // Axis positions: the plain zero, and all of it on top.
    let text = "G54 G43 H1\nG0 X0 Y0 Z0 A0 C0\nX5\nG55\nX5 C0\n";
    let done = ran(&machine, LETTERS, &offsets, text).whole();
    let [plain, shifted] = [1, 2].map(|at| done.motions[at].to.joints);
    assert!((shifted[x] - plain[x] - 10.0).abs() < SAME);
    assert!((shifted[c] - 90f64.to_radians()).abs() < SAME);
    // Under tool centre point control the program's directions are those of the machine with the axis there.
    let text = "G55 G43.4 H1\nG0 X5. Y0 Z0 A0 C0\n";
    let done = ran(&machine, LETTERS, &offsets, text).whole();
    let joints = done.last().to.joints;
    let (tip, _) = reference(&machine, 100.0).forward(&joints[..machine.axes.len()]);
    assert!(
        (joints[x] - shifted[x]).abs() < 1e-9,
        "both ways to the same place: {} {}",
        joints[x],
        shifted[x]
    );
    assert!((tip - done.last().to.pose.tip).norm() < SAME);
}

#[test]
fn rotary_words_turn_as_they_are_told() {
    let machine = machine("bc-trunnion");
    let c = place(&machine, "C");
    let offsets = Offsets { length: Some(0.0), ..Offsets::default() };
    let turns = |text: &str| {
        let done = ran_in(Language::Names, &machine, NAMES, &offsets, text).whole();
        let [from, to] = [done.last().from.joints[c], done.last().to.joints[c]];
        ((to - from).to_degrees() * 1e9).round() / 1e9
    };
    // Its display goes round from 0 to 360: the shorter way.
    assert!(machine.axes[c].range.is_some());
    assert_eq!(turns("G0 C350\nC10\n"), 20.0);
    assert_eq!(turns("G0 C10\nC350\n"), -20.0);
    assert_eq!(turns("G0 C350\nC=ACN(10)\n"), -340.0);
    assert_eq!(turns("G0 C10\nC=ACP(350)\n"), 340.0);
    assert_eq!(turns("G0 C10\nC=DC(350)\n"), -20.0);
    assert_eq!(turns("G0 C10\nC=IC(350)\n"), 350.0);
    assert_eq!(turns("G0 C10\nG91 C-15\n"), -15.0);
}

#[test]
fn a_head_that_is_swapped_in_is_the_chain_from_there_on() {
    let machine = machine("head-change");
    let done = letters(&machine, "M61\nG0 G53 X0 Y0 Z-100. C0\nM62\nG53 X10. C90.\n").whole();
    let angle = &machine.head("ANGLE").unwrap().machine;
    let motion = done.last();
    let (tip, axis) = reference(angle, 0.0).forward(&motion.to.joints[..angle.axes.len()]);
    assert!((motion.to.pose.tip - tip).norm() < SAME);
    assert!((motion.to.pose.axis - axis).norm() < SAME);
    assert!(done.report.unknown.is_empty(), "{:?}", done.report.unknown);
}

#[test]
fn arcs_of_axis_positions_lie_as_the_axes_do_on_the_part() {
    let machine = machine("xyzac-trt");
    for plane in
        ["G17 G3 X20. Y10. I10. J0", "G18 G2 X20. Z10. I10. K0", "G19 G3 Y20. Z10. J10. K0"]
    {
        let text = format!(
            "G0 X0 Y0 Z0 A-25. C40.\nX10. Y10. Z10.\nG1 F100 X0 Y0 Z0\nG0 X0 Y10. Z10.\nG0 {}\n{plane}\n",
            if plane.starts_with("G19") { "Y0" } else { "Y10." }
        );
        let done = letters(&machine, &text).whole();
        let motion = done.last();
        assert!(matches!(motion.way, Interpolation::Tip(Curve::Arc { .. })));
        // Along the arc the tip is where the axes, going round in their own plane, bring it.
        let Interpolation::Tip(Curve::Arc { sweep, .. }) = motion.way else { unreachable!() };
        let names = match &plane[..3] {
            "G17" => ["X", "Y"],
            "G18" => ["X", "Z"],
            _ => ["Y", "Z"],
        };
        let [first, second] = names.map(|name| place(&machine, name));
        let centre = {
            let mut centre = motion.from.joints;
            centre[first] += 10.0;
            centre
        };
        for step in 0..=8 {
            let t = f64::from(step) / 8.0;
            let mut joints = motion.from.joints;
            // Of Z and X the turn is right-handed from Z to X.
            let sense = if plane.starts_with("G18") { -1.0 } else { 1.0 };
            let (sine, cosine) = libm::sincos(sense * sweep * t);
            joints[first] = centre[first] - 10.0 * cosine;
            joints[second] = centre[second] - 10.0 * sine;
            let (tip, _) = reference(&machine, 0.0).forward(&joints[..machine.axes.len()]);
            let at = motion.at(t).tip;
            assert!((at - tip).norm() < 1e-9, "{plane} at {t}: {at} {tip}");
        }
    }
}

/// K0 and L0 keep the data of a cycle and make no hole; where they lead the tool is not agreed upon.
#[test]
fn a_cycle_of_no_holes_makes_none() {
    let mill = machine("vmc");
    let run = |cycle: &str| {
        letters(&mill, &format!("G90 G94\nG0 X5. Y0 Z30. F300\n{cycle}\nX20.\nG80\nG0 Z30.\n"))
    };
    for count in ["K0", "L0"] {
        for place in ["", "X5. ", "X5. Y0. "] {
            let done = run(&format!("G98 G81 {place}Z-8. R2. {count}")).whole();
            let deep = done.motions.iter().filter(|motion| motion.to.pose.tip.z < -7.0);
            let deep: Vec<f64> = deep.map(|motion| motion.to.pose.tip.x).collect();
            assert!(
                !deep.is_empty() && deep.iter().all(|x| (x - 20.0).abs() < SAME),
                "{place}{count}"
            );
        }
        let done = run(&format!("G98 G81 X9. Z-8. R2. {count}"));
        let says = format!("{:?}", done.refused);
        assert!(says.contains("names a place"), "{says}");
    }
}
