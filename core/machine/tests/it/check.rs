//! The comparison of two machine files against isometries: no random setting of the axes finds a larger
//! deviation than the one told, some come near to it, and the parts add up to the whole.

use nalgebra::{Matrix3, Vector3};
use post_machine::check::{Check, compare};
use post_machine::description::{Machine, Source, load};
use post_testkit::{Rng, randomised, rounds};
use post_testmachines::{Reference, angle};

/// Tool length, mm.
const LENGTH: f64 = 90.0;

const CHAINS: [(&str, [&str; 2]); 4] = [
    ("[w C' A' b Y X Z (S) t]", ["C", "A"]),
    ("[w b X Y Z C A (S) t]", ["C", "A"]),
    ("[w C' b X Y Z A (S) t]", ["C", "A"]),
    ("[w A' X' b Y C Z (S) t]", ["A", "C"]),
];

/// A machine whose lines are off by about `tilt` radians and `shift` mm.
fn machine(chain: &str, rng: &mut Rng, tilt: f64, shift: f64) -> Machine {
    let mut off = |size: f64| rng.range(-size, size);
    let mut axes = String::new();
    for (name, [x, y, z]) in
        [("X", [1.0, 0.0, 0.0]), ("Y", [0.0, 1.0, 0.0]), ("Z", [0.0, 0.0, 1.0])]
    {
        axes.push_str(&format!(
            "[axis.{name}]\nlinear = [{:?}, {:?}, {:?}]\ntravel = [-300, 250]\n",
            x + off(tilt),
            y + off(tilt),
            z + off(tilt)
        ));
    }
    for (name, [x, y, z], travel) in [
        ("C", [0.0, 0.0, 1.0], "travel = [-200, 200]"),
        ("A", [1.0, 0.0, 0.0], "travel = [-100, 40]"),
    ] {
        axes.push_str(&format!(
            "[axis.{name}]\nrotary = [{:?}, {:?}, {:?}]\npoint = [{:?}, {:?}, {:?}]\n{travel}\n",
            x + off(tilt),
            y + off(tilt),
            z + off(tilt),
            off(shift),
            off(shift),
            60.0 + off(shift)
        ));
    }
    let text = format!(
        "name = \"x\"\nchain = \"{chain}\"\n[tool]\ngauge = [0, 0, 300]\n[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n{axes}"
    );
    let source = Source { name: "x.toml".to_owned(), text };
    load(source, &[], &mut |name| Err(name.to_owned())).unwrap()
}

fn reference(machine: &Machine) -> Reference {
    Reference {
        joints: machine.axes.iter().map(|axis| axis.joint).collect(),
        mount: machine.mount,
        tip: machine.gauge - machine.tool_axis * LENGTH,
        axis: machine.tool_axis,
    }
}

/// Axis values with the tip on the part origin and every rotary axis at zero.
fn zero(reference: &Reference) -> Vec<f64> {
    let linear = reference.linear();
    let columns: Vec<Vector3<f64>> =
        linear.iter().map(|place| reference.joints[*place].direction).collect();
    let values =
        Matrix3::from_columns(&columns).try_inverse().unwrap() * (reference.mount - reference.tip);
    let mut zero = vec![0.0; reference.joints.len()];
    for (place, value) in linear.iter().zip(values.iter()) {
        zero[*place] = *value;
    }
    zero
}

/// Of these examples: the search goes along one axis at a time, and may stop short on a ridge that lies across them, by some
/// hundred-thousandths of the deviation.
#[test]
fn no_setting_of_the_axes_is_worse_than_the_one_told() {
    let (rounds, mut rng) = (0..rounds(3), Rng::new(3));
    for (chain, _) in CHAINS {
        for _ in rounds.clone() {
            let drawn = machine(chain, &mut rng, 0.0, 0.0);
            let real = machine(chain, &mut rng, 2e-4, 0.05);
            let told = compare(&real, &drawn, LENGTH).unwrap();
            let (a, b) = (reference(&real), reference(&drawn));
            let (zero_a, zero_b) = (zero(&a), zero(&b));
            let (mut tip, mut axis) = (0f64, 0f64);
            for _ in 0..20_000 {
                let q: Vec<f64> = real
                    .axes
                    .iter()
                    .map(|axis| {
                        let [least, most] = axis.travel.unwrap();
                        if axis.joint.rotary {
                            rng.range(least, most)
                        } else {
                            [least, most, rng.range(least, most)][rng.pick(3)]
                        }
                    })
                    .collect();
                let other: Vec<f64> = q
                    .iter()
                    .zip(zero_a.iter().zip(&zero_b))
                    .map(|(value, (a, b))| value - a + b)
                    .collect();
                let ((tip_a, axis_a), (tip_b, axis_b)) = (a.forward(&q), b.forward(&other));
                tip = tip.max((tip_a - tip_b).norm());
                axis = axis.max(angle(axis_a, axis_b).to_degrees());
            }
            assert!(tip <= told.tip_mm + 1e-9, "{chain}: {tip} over {}", told.tip_mm);
            assert!(tip > 0.9 * told.tip_mm, "{chain}: {tip} under {}", told.tip_mm);
            assert!(axis <= told.axis_deg + 1e-9, "{chain}: {axis} over {}", told.axis_deg);
            assert!(axis > 0.9 * told.axis_deg, "{chain}: {axis} under {}", told.axis_deg);
        }
    }
}

/// Errors are small, so what each makes alone adds up as vectors, but for products of two of them.
#[test]
fn the_parts_add_up_to_the_whole() {
    let (rounds, mut rng) = randomised(1, 5);
    for (chain, _) in rounds.flat_map(|_| CHAINS) {
        let drawn = machine(chain, &mut rng, 0.0, 0.0);
        let real = machine(chain, &mut rng, 1e-4, 0.02);
        let told = compare(&real, &drawn, LENGTH).unwrap();
        let sum = told
            .tip_shares
            .iter()
            .fold(Vector3::zeros(), |sum, share| sum + Vector3::from(share.vector));
        let missing = (sum - Vector3::from(told.tip)).norm();
        assert!(missing < 0.01 * told.tip_mm, "{chain}: {missing} of {}", told.tip_mm);
    }
}

/// The same file gives the same check, and forward and inverse agree for lines in any place.
#[test]
fn measured_machines_of_every_chain_pass_the_round_trip() {
    let (rounds, mut rng) = randomised(1, 7);
    for (chain, _) in rounds.flat_map(|_| CHAINS) {
        let real = machine(chain, &mut rng, 2e-3, 0.5);
        let check = Check::of(&real, LENGTH).unwrap();
        assert_eq!(check.round_trip.not_found, 0, "{chain}");
        assert!(check.round_trip.tip_mm < 1e-9, "{chain}: {:?}", check.round_trip);
        assert!(check.round_trip.axis_rad < 1e-9, "{chain}: {:?}", check.round_trip);
        let again = Check::of(&real, LENGTH).unwrap();
        assert_eq!(format!("{check:?}"), format!("{again:?}"));
    }
}
