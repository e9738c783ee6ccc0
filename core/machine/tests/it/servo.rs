//! `[servo.X]`: what it may say, what is refused and where, and that the equations are those of the papers.

use post_machine::description::{Machine, load};
use post_machine::diagnostic::Diagnostic;
use post_machine::servo::{Drive, Feedback, ServoModel, StateSpace};

use crate::source;

/// A machine without servos.
const BARE: &str = r#"name = "two axes"
chain = "[w C' b X Y Z t]"
[parameters]
heavy = 450
[tool]
gauge = [0, 0, 400]
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
[axis.X]
linear = [1, 0, 0]
travel = [-300, 300]
[axis.Y]
linear = [0, 1, 0]
travel = [-300, 300]
[axis.Z]
linear = [0, 0, 1]
travel = [-300, 300]
[control]
dialect = "fanuc"
tcp = "post"
"#;

/// A lead screw and a gear.
const LOOPS: &str = r#"
[servo.X.loops]
kv = 50
velocity_feed_forward = 1
acceleration_feed_forward = 0.9
velocity_gain = 2.5
velocity_time = 0.02
current_gain = 20
current_time = 0.005
resistance = 0.6
inductance = 5
torque_constant = 1.2
back_emf = 0.8
motor_inertia = 0.008
motor_damping = 0.003
[servo.X.loops.screw]
lead = 16
screw_damping = 0.01
axial_stiffness = 180
torsional_stiffness = 8000
axial_damping = 8000
table_mass = "heavy"
table_damping = 3000

[servo.C]
backlash = 0.002
[servo.C.friction]
coulomb = 15
[servo.C.loops]
feedback = "motor"
kv = 35
velocity_gain = 2.5
motor_inertia = 0.006
[servo.C.loops.gear]
ratio = 90
gear_stiffness = 1.5e6
gear_damping = 1500
table_inertia = 12
"#;

/// The bare machine with `servos`; it can extend "parent", which has those of [`LOOPS`].
fn try_load(servos: &str) -> Result<Machine, Vec<Diagnostic>> {
    let text = format!("{BARE}{servos}");
    load_text(text)
}

fn load_text(text: String) -> Result<Machine, Vec<Diagnostic>> {
    load(source("m.toml", &text), &[], &mut |name| {
        assert_eq!(name, "parent");
        Ok(source("parent.toml", &format!("{BARE}{LOOPS}")))
    })
}

fn axis<'a>(machine: &'a Machine, name: &str) -> &'a post_machine::description::Axis {
    machine.axes.iter().find(|axis| axis.name == name).unwrap()
}

#[test]
fn what_the_file_says_arrives() {
    let machine = try_load(LOOPS).unwrap();
    assert!(axis(&machine, "Y").servo.is_none());
    let servo = axis(&machine, "X").servo.as_deref().unwrap();
    assert_eq!(servo.place.as_ref().unwrap().line, 24);
    let ServoModel::Loops(loops) = &servo.model else { panic!("{servo:?}") };
    assert_eq!(loops.feedback, Feedback::Scale);
    assert_eq!((loops.kv, loops.velocity_time), (50.0, Some(0.02)));
    assert_eq!(loops.acceleration_feed_forward, 0.9);
    let current = loops.current.unwrap();
    assert_eq!((current.inductance, current.back_emf), (5.0, 0.8));
    let Drive::Screw { lead, table_mass, .. } = loops.drive else { panic!("{loops:?}") };
    assert_eq!((lead, table_mass), (16.0, 450.0));

    let servo = axis(&machine, "C").servo.as_deref().unwrap();
    assert!(servo.rotary && servo.play_inside());
    assert_eq!((servo.backlash, servo.friction.unwrap().coulomb), (0.002, 15.0));
    let ServoModel::Loops(loops) = &servo.model else { panic!("{servo:?}") };
    assert_eq!(loops.feedback, Feedback::Motor);
    assert!(loops.current.is_none() && loops.velocity_time.is_none());
}

/// Eq. 9 of the prediction paper, and eq. 10's frequency: numbers by hand.
#[test]
fn stiffnesses_stand_in_a_row() {
    let machine = try_load(LOOPS).unwrap();
    let servo = axis(&machine, "X").servo.as_deref().unwrap();
    let ServoModel::Loops(loops) = &servo.model else { panic!("{servo:?}") };
    let mechanics = loops.drive.mechanics();
    // 1/180e6 + 0.016²/(4π²·8000) = 5.555556e-9 + 8.105695e-10 m/N.
    let stiffness = mechanics.stiffness.unwrap();
    assert!((stiffness / 1.570_814_3e8 - 1.0).abs() < 1e-7, "{stiffness}");
    // sqrt(1.5708143e8/450) = 590.821 rad/s.
    let frequency = mechanics.natural_frequency().unwrap();
    assert!((frequency - 590.821).abs() < 1e-3, "{frequency}");
}

#[test]
fn a_file_that_extends_another_says_what_differs() {
    let child = |text: &str| load_text(format!("extends = \"parent\"\n{text}"));
    let machine = child("[servo.X.loops]\nkv = 40\n").unwrap();
    let ServoModel::Loops(loops) = &axis(&machine, "X").servo.as_ref().unwrap().model else {
        panic!()
    };
    assert_eq!((loops.kv, loops.velocity_gain), (40.0, 2.5));

    let machine = child("[servo.X.transfer]\nnumerator = [50]\ndenominator = [1, 50]\n").unwrap();
    let servo = axis(&machine, "X").servo.as_ref().unwrap();
    assert!(matches!(servo.model, ServoModel::Transfer(_)));

    let machine = child("[servo.C]\nbacklash = 0\n[servo.C.loops.direct]\nload = 2\n[servo.C.loops]\nvelocity_gain = 100\n").unwrap();
    let ServoModel::Loops(loops) = &axis(&machine, "C").servo.as_ref().unwrap().model else {
        panic!()
    };
    assert_eq!(loops.drive, Drive::Direct { load: 2.0, load_damping: 0.0 });
}

/// Parameters are names of the user's own: none stands in another's place.
#[test]
fn a_parameter_takes_no_other_away() {
    let parent =
        format!("{BARE}{LOOPS}").replace("heavy = 450", "heavy = 450\ndirect = 2\nplane = 1");
    let text = "extends = \"parent\"\n[parameters]\ngear = 3\ndistance = 4\n[servo.X.loops.screw]\ntable_mass = \"direct * plane + gear + distance\"\n";
    let machine =
        load(source("m.toml", text), &[], &mut |_| Ok(source("parent.toml", &parent))).unwrap();
    let mut servo = axis(&machine, "X").servo.clone().unwrap();
    assert_eq!(servo.parameter("table_mass").copied(), Some(9.0));
}

/// Numbers of any size are loaded or refused, and the run comes to an end.
#[test]
fn numbers_of_any_size_come_to_an_end() {
    let mut seed = 7_u64;
    let mut next = |most: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % most
    };
    let mut loaded = 0;
    for round in 0..2000 {
        let odd = |line: &str, exponent: i64| match line.split_once(" = ") {
            Some((key, _)) if !key.ends_with("feed_forward") && key != "feedback" => {
                format!("{key} = 1e{exponent}")
            }
            _ => line.to_owned(),
        };
        let lines: Vec<String> = LOOPS
            .lines()
            .map(|line| match (round % 3, next(8)) {
                // All, or some here and there, over all sizes or those that are left after others were refused.
                (0, _) | (_, 0) => odd(
                    line,
                    next(if round % 2 == 0 { 620 } else { 24 }) as i64
                        - if round % 2 == 0 { 320 } else { 12 },
                ),
                _ => line.to_owned(),
            })
            .collect();
        match try_load(&lines.join("\n")) {
            Ok(_) => loaded += 1,
            Err(faults) => assert!(faults.iter().all(|fault| fault.place.is_some())),
        }
    }
    assert!(loaded > 30, "{loaded}");
}

/// A change of [`LOOPS`] (or what stands in its place), the line of the fault, and words of what is said.
const REFUSED: &[(&str, &str, &str, &[&str])] = &[
    ("kv = 50", "kv = 0", "", &["kv is 0; it must be above zero"]),
    ("kv = 50", "kw = 50", "", &["there is no key `kw`", "did you mean `kv`"]),
    ("kv = 50", "", "[servo.X.loops]", &["[servo.X.loops] lacks kv"]),
    (
        "velocity_feed_forward = 1",
        "velocity_feed_forward = 3",
        "",
        &["velocity_feed_forward is 3; it must be from 0 to 2"],
    ),
    (
        "resistance = 0.6\n",
        "",
        "[servo.X.loops]",
        &["the current loop of [servo.X.loops] lacks resistance"],
    ),
    ("lead = 16", "lead = -16", "", &["lead is -16"]),
    ("table_mass = \"heavy\"", "", "[servo.X.loops.screw]", &["lacks table_mass"]),
    ("[servo.X.loops.screw]", "[servo.X.loops.gear]", "axial_damping = 8000", &["there is no key"]),
    (
        "[servo.C.loops.gear]\nratio = 90\ngear_stiffness = 1.5e6\ngear_damping = 1500\ntable_inertia = 12\n",
        "",
        "[servo.C.loops]",
        &["what drives C, a rotary axis?", "gear and direct"],
    ),
    ("gear_stiffness = 1.5e6\n", "", "gear_damping = 1500", &["gear_damping", "rigid"]),
    ("coulomb = 15", "width = 1", "[servo.C.friction]", &["[servo.C.friction] lacks coulomb"]),
    ("backlash = 0.002", "backlash = -1", "", &["backlash is -1"]),
    ("kv = 50", "kv = 800", "[servo.X.loops]", &["not stable", "j", "a smaller kv"]),
    (
        "axial_stiffness = 180\ntorsional_stiffness = 8000",
        "axial_stiffness = 1e10",
        "[servo.X.loops]",
        &["rad/s", "N/µm"],
    ),
    (
        "inductance = 5",
        "inductance = 1e-6",
        "[servo.X.loops]",
        &["pole of", "10000000 are possible", "mH"],
    ),
    ("[servo.X.loops]", "[servo.W.loops]", "", &["no axis W", "its axes are"]),
];

#[test]
fn slips_are_refused_by_their_line() {
    for (text, instead, line, said) in REFUSED {
        assert!(LOOPS.contains(text), "{text}");
        let faults = try_load(&LOOPS.replacen(text, instead, 1)).unwrap_err();
        let fault = &faults[0];
        let told = format!("{} | {}", fault.message, fault.help.as_deref().unwrap_or(""));
        let line = if line.is_empty() { instead } else { line };
        assert_eq!(fault.place.as_ref().unwrap().text, *line, "{instead}: {told}");
        for words in *said {
            assert!(told.contains(words), "{instead}: {told}");
        }
    }
}

/// A servo of X, and words of the refusal.
const OTHERS: &[(&str, &str)] = &[
    ("[servo.X]\nbacklash = 1", "does not say how the servo behaves"),
    (
        "[servo.X.transfer]\nnumerator = [1]\ndenominator = [1, 1]\n[servo.X.pid]\nkp = 1",
        "more than one way",
    ),
    ("[servo.X.transfer]\nnumerator = [1]", "lacks denominator"),
    (
        "[servo.X.transfer]\nnumerator = [49]\ndenominator = [1, 50]",
        "at 0.98 of where it is commanded",
    ),
    ("[servo.X.transfer]\nnumerator = [1, 2, 1]\ndenominator = [0, 1, 1]", "higher order"),
    ("[servo.X.transfer]\nnumerator = [1]\ndenominator = [1]", "order 0"),
    (
        "[servo.X.transfer]\nnumerator = [1]\ndenominator = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]",
        "order 13",
    ),
    // s² + 4 has its poles on the imaginary axis.
    (
        "[servo.X.transfer]\nnumerator = [4]\ndenominator = [1, 0, 4]",
        "not stable: of its poles, 0 + 2j, 0 - 2j 1/s",
    ),
    ("[servo.X.transfer]\nnumerator = [0]\ndenominator = [1, 0]", "not stable"),
    ("[servo.X.pid]\nkp = 1\nki = 1000\ngain = 1\ninertia = 1", "not stable"),
    (
        "[servo.X.transfer]\nnumerator = [1]\ndenominator = [1, 1]\n[servo.X.friction]\ncoulomb = 5",
        "no table is known",
    ),
    (
        "[servo.X]\nbacklash = 0.01\n[servo.X.loops]\nkv = 10\nvelocity_gain = 1\nmotor_inertia = 0.01\n[servo.X.loops.direct]\nload = 1",
        "backlash of X",
    ),
    (
        "[servo.X]\nbacklash = 0.01\n[servo.X.loops]\nkv = 10\nvelocity_gain = 1\nmotor_inertia = 0.01\n[servo.X.loops.screw]\nlead = 10\ntable_mass = 1",
        "no stiffness",
    ),
];

#[test]
fn servos_that_cannot_be_are_refused() {
    for (text, said) in OTHERS {
        let faults = try_load(text).unwrap_err();
        assert!(faults[0].message.contains(said), "{text}: {faults:?}");
        assert!(faults[0].place.is_some(), "{text}");
    }
}

/// The X axis of the feedrate paper (Tables 1 and 2; the printed A3 = 0.007 is A4), both ways.
#[test]
fn the_feedrate_papers_servo_has_its_poles() {
    let pid = "[servo.X.pid]\nkp = 10\nki = 50\nkd = 0.3\ngain = \"6.5723 * 0.4769 * 1.5915\"\ninertia = 7.0028e-3\ndamping = 0.023569";
    let table = "[servo.X.transfer]\nnumerator = [1.4965, 49.883, 249.415]\ndenominator = [7.0028e-3, 1.5200, 49.883, 249.415]";
    for text in [pid, table] {
        let machine = try_load(text).unwrap();
        let servo = axis(&machine, "X").servo.as_ref().unwrap();
        let poles = StateSpace::of(servo).poles().unwrap();
        let expected = [-6.103, -32.75, -178.2];
        assert_eq!(poles.len(), 3);
        for (pole, expected) in poles.iter().zip(expected) {
            assert!((pole.real / expected - 1.0).abs() < 5e-4, "{poles:?}");
            assert_eq!(pole.imaginary, 0.0);
        }
    }
}

/// Every number of the file can be had by its key.
#[test]
fn numbers_have_their_keys() {
    let mut machine = try_load(LOOPS).unwrap();
    let axis = machine.axes.iter_mut().find(|axis| axis.name == "X");
    let servo = axis.unwrap().servo.as_mut().unwrap();
    for line in LOOPS.lines().take_while(|line| !line.contains("servo.C")) {
        let Some((key, value)) = line.split_once(" = ") else {
            continue;
        };
        let value: f64 = value.parse().unwrap_or(450.0);
        assert_eq!(servo.parameter(key).copied(), Some(value), "{key}");
    }
    assert!(servo.parameter("ratio").is_none());
}
