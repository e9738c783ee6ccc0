//! The rule `cycle-time`: what it chooses, by hand, and that tolerances and travel are kept whatever it takes.

use super::choice::{angles, close, inclined};
use super::pole::{outcome, over};
use super::*;

/// PostWorks' example of the four measures, by the cycle time: the rotary axes may move by (50, 90) or by (110, 0) degrees. With
/// equal feeds `time`, a sum, takes the set of one long way, whatever the axes are
/// accelerated with; by hand, each from rest to rest at 166.7°/s, the sets take
/// - 50° or 110° of C at 600°/s²: 0.578 s and 0.938 s; 90° of B at 300°/s²: 1.095 s. The long way of C is faster;
/// - at 100°/s² those of C: 1.414 s and 2.098 s. Both axes at once are faster.
#[test]
fn the_cycle_time_chooses_by_the_slowest_axis_and_its_acceleration() {
    let direction = inclined();
    let class = Class { direction: &direction, ..CLASSES[3] };
    for (rule, of_c, expected) in [
        ("cycle-time", 600.0, [-110.0, 0.0]),
        ("cycle-time", 100.0, [50.0, 90.0]),
        ("time", 600.0, [-110.0, 0.0]),
        ("time", 100.0, [-110.0, 0.0]),
    ] {
        let given = Given {
            feeds: [10_000.0; 5],
            accelerations: Some([5000.0, 5000.0, 5000.0, 300.0, of_c]),
            more: format!("[solution]\nrule = \"{rule}\"\nstart = {{ C = 20, B = -45 }}"),
            ..Given::default()
        };
        let bench = bench(&class, &given);
        let mut joints = Joints::default();
        joints[bench.place("C")] = 70f64.to_radians();
        joints[bench.place("B")] = 45f64.to_radians();
        let axis = bench.reference.forward(&joints).1;
        let run = bench.run(&cl(&[point(Vector3::zeros(), axis, true)], 1000.0));
        let stands = angles(&bench, &run.good(rule), line(0));
        let moves = [stands[0] - 20.0, stands[1] + 45.0];
        assert!(close(moves, expected), "{rule}, {of_c}: moves by {moves:?}");
    }
}

/// Close to poles, where it tries ways of its own, tolerances and travel are kept, and nothing is refused that is posted with
/// every point met exactly.
#[test]
fn the_fastest_way_over_a_pole_keeps_tolerance_and_travel() {
    let (rounds, mut rng) = randomised(600, 97);
    let (mut posted, mut eased, mut faults) = (0, 0, Vec::new());
    let mut round = 0;
    // Few are eased: rounds go on until some are.
    while round < rounds.end || eased < 2 && round < 20 * rounds.end {
        round += 1;
        let class = &CLASSES[rng.pick(CLASSES.len())];
        let tcp = ["post", "control"][rng.pick(2)];
        let second = [[-175.0, 175.0], [-120.0, 30.0], [-2.0, 110.0]][rng.pick(3)];
        let points = over(&mut rng);
        let [fastest, exact] = ["rule = \"cycle-time\"", "pole = \"exact\""]
            .map(|solution| outcome(class, tcp, second, solution, &points));
        let name = format!("round {round}, {} {tcp} {second:?}", class.name);
        match (fastest, exact) {
            (Err(told), Ok(_)) => faults.push(format!("{name}: {told}")),
            (Ok(found), _) => {
                posted += 1;
                eased += u32::from(found.eased > 0);
                if found.axis > 0.05 + 1e-6 || tcp == "post" && found.tip > 0.005 + 1e-6 {
                    faults.push(format!("{name}: tip {} axis {}", found.tip, found.axis));
                }
                if found.over.0 > 1e-6 {
                    faults.push(format!("{name}: over travel by {:?}", found.over));
                }
            }
            (Err(_), Err(_)) => {}
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(posted > at_least(300) && eased >= 2, "{posted} posted, {eased} eased");
}
