//! The servos of a machine.

use post_machine::description::{Machine, Source, load};
use post_machine::kinematics::{Joints, MAX_AXES};
use post_machine::servo::{ServoModel, StateSpace, stable};
use post_motion::servo::fit::named;
use post_motion::servo::{Follower, Servos};

fn machine() -> Machine {
    let text = r#"name = "two servos"
chain = "[w C' b X Y Z t]"
tool = { gauge = [0, 0, 400] }
control = { dialect = "fanuc", tcp = "post" }
[axis]
C = { rotary = [0, 0, 1], point = [0, 0, 0], cyclic = true }
X = { linear = [1, 0, 0], travel = [-300, 300] }
Y = { linear = [0, 1, 0], travel = [-300, 300] }
Z = { linear = [0, 0, 1], travel = [-300, 300] }
[servo.C.transfer]
numerator = [30]
denominator = [1, 30]
[servo.Y.transfer]
numerator = [50]
denominator = [1, 50]
"#;
    let source = Source { name: "m.toml".to_owned(), text: text.to_owned() };
    load(source, &[], &mut |name| Err(name.to_owned())).unwrap()
}

/// Each axis is that of its own servo, one without is where it is commanded, and how the set-points are cut into batches
/// changes nothing.
#[test]
fn each_axis_has_its_own() {
    let machine = machine();
    let mut start = Joints::default();
    start[..4].copy_from_slice(&[1.0, 2.0, 3.0, 4.0]);
    let command: Vec<Joints> = (0..500)
        .map(|k| {
            let way = libm::sin(f64::from(k) * 0.02);
            std::array::from_fn(|place| start[place] * (1.0 + way))
        })
        .collect();
    let mut servos = Servos::new(&machine, 1e-3).unwrap();
    assert_eq!(servos.places().collect::<Vec<_>>(), [0, 2]);
    servos.settle(&start);
    let mut whole = vec![[9.0; MAX_AXES]];
    servos.follow(&command, &mut whole);
    assert_eq!(whole.len(), 500);

    servos.settle(&start);
    let (mut batch, mut pieces) = (Vec::new(), Vec::new());
    for piece in [&command[..1], &command[1..130], &[], &command[130..]] {
        servos.follow(piece, &mut batch);
        pieces.extend_from_slice(&batch);
    }
    assert_eq!(pieces, whole);

    for place in 0..4 {
        let servo = machine.axes[place].servo.as_deref();
        let mut follower = servo.map(|servo| Follower::new(servo, 1e-3).unwrap());
        if let Some(follower) = &mut follower {
            follower.settle(start[place]);
        }
        for (commanded, actual) in command.iter().zip(&whole) {
            let expected = match &mut follower {
                Some(follower) => follower.next(commanded[place]),
                None => commanded[place],
            };
            assert_eq!(actual[place], expected);
        }
    }
}

#[test]
fn periods_are_above_zero_and_up_to_a_second() {
    for period in [0.0, -1.0, 1.5, f64::NAN, f64::INFINITY] {
        let fault = Servos::new(&machine(), period).unwrap_err();
        assert!(fault.message.contains("up to 1 s"), "{}", fault.message);
    }
    assert!(Servos::new(&machine(), 1.0).is_ok());
}

/// No command makes it panic: what is no number goes through as none.
#[test]
fn what_is_no_number_does_not_end_the_run() {
    let mut servos = Servos::new(&machine(), 1e-3).unwrap();
    let mut actual = Vec::new();
    servos.follow(&[[f64::NAN; MAX_AXES], [f64::INFINITY; MAX_AXES], [0.0; MAX_AXES]], &mut actual);
    assert!(actual[2][0].is_nan());
    servos.settle(&[1.0; MAX_AXES]);
    servos.follow(&[[1.0; MAX_AXES]], &mut actual);
    assert!((actual[0][0] - 1.0).abs() < 1e-12);
}

#[test]
fn numbers_are_named_by_axis_and_key() {
    let machine = machine();
    assert_eq!(named(&machine, "Y.kv").unwrap(), (2, "kv"));
    for (name, said) in [
        ("kv", "such as X.kv"),
        ("X.kv", "servos are known of C, Y"),
        ("W.kv", "servos are known of C, Y"),
    ] {
        let fault = named(&machine, name).unwrap_err();
        assert!(fault.help.as_ref().unwrap().contains(said), "{fault:?}");
    }
}

/// Numbers of any size: what is stable can be followed, and no step of it is anything but a number.
#[test]
fn whatever_is_stable_can_be_followed() {
    let mut seed = 3_u64;
    let mut factor = |most: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        libm::pow(10.0, most * ((seed >> 33) as f64 / (1_u64 << 30) as f64 - 1.0))
    };
    let mut followed = 0;
    for round in 0..180 {
        let most = [0.5, 2.0, 12.0][round % 3];
        for loops in super::all_loops() {
            let mut servo = super::of_loops(loops);
            for number in servo.parameters() {
                if !number.name.ends_with("feed_forward") {
                    *number.value *= factor(most);
                }
            }
            let poles = StateSpace::of(&servo).poles().unwrap_or_default();
            let fast = poles.iter().any(|pole| pole.size() > 1e7);
            if fast || poles.is_empty() || !stable(&poles) {
                continue;
            }
            let period = [1e-3, 15e-3, 1.0][round / 3 % 3];
            if round % 5 == 0 && period < 1e-2 {
                servo = super::with_friction(servo, factor(most), 0.0);
                servo.backlash = factor(1.0);
            }
            let swing = match &servo.model {
                ServoModel::Loops(loops) => loops.drive.mechanics().natural_frequency(),
                _ => None,
            };
            if swing.is_some_and(|swing| swing > 1e4) {
                continue;
            }
            let mut follower = Follower::new(&servo, period).unwrap();
            follower.settle(100.0);
            for k in 0..20 {
                let found = follower.next(100.0 + f64::from(k));
                assert!(found.is_finite(), "{servo:?}");
            }
            followed += 1;
        }
    }
    assert!(followed > 100, "{followed}");
}
