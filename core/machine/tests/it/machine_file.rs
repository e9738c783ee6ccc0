//! Machine files: those of the workspace load, and every slip is refused with its line, the text underlined
//! and, where something can be done about it, a remedy.

use std::fs;

use post_machine::description::{
    BlendRule, CornerRule, LimitsActOn, Machine, RapidRule, Setting, SolutionCriterion, Tcp, load,
};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_testkit::repository;

use crate::source;

/// A good machine; every refusal changes some of its text.
const GOOD: &str = r#"name = "trunnion"
chain = "[w C' A' b Y X Z (S) t]"

[parameters]
Zc = 50.5
half = "Zc / 2"

[workpiece]
mount = [0, 0, "half"]

[tool]
gauge = [0, 0, 400]
axis = [0, 0, 1]

[tools]
1 = 120.5

[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
max_feed = 9000

[axis.A]
rotary = [1, 0, 0]
point = [0, 0.012, "Zc"]
travel = [-120, 30]

[axis.X]
linear = [1, 0, 0]
travel = [-300, 300]

[axis.Y]
linear = [0, 1, 0]
travel = [-300, 300]

[axis.Z]
linear = [0, 0, 1]
travel = [-450, 200]

[control]
dialect = "fanuc"
tcp = "post"

[control.fanuc]
program = 7

[accuracy]
tolerance = 0.005
"#;

/// Loads `text` with `settings`; the machine `good` can be extended, and `circle` extends itself.
fn try_load(text: &str, settings: &[&str]) -> Result<Machine, Vec<Diagnostic>> {
    let settings: Vec<Setting> =
        settings.iter().map(|&setting| Setting::Written(setting.to_owned())).collect();
    load(source("m.toml", text), &settings, &mut |name| match name {
        "good" => Ok(source("good.toml", GOOD)),
        "circle" => Ok(source("circle.toml", "extends = \"circle\"\n")),
        other => Err(format!("no machine {other}")),
    })
}

/// What is underlined, behind its line.
fn underlined(finding: &Diagnostic) -> String {
    let place = finding.place.as_ref().unwrap_or_else(|| panic!("no place: {finding:?}"));
    format!("{} {}", place.line, &place.text[place.span.clone()])
}

#[test]
fn every_machine_of_the_workspace_loads() {
    let folder = repository().join("machines");
    let read =
        |name: &str| fs::read_to_string(folder.join(name)).map_err(|error| error.to_string());
    let mut count = 0;
    for entry in fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if !name.ends_with(".toml") {
            continue;
        }
        let mut find = |parent: &str| {
            let file = format!("{parent}.toml");
            Ok(source(&file, &read(&file)?))
        };
        let loaded = load(source(&name, &read(&name).unwrap()), &[], &mut find);
        let machine = loaded.unwrap_or_else(|faults| panic!("{name}: {faults:#?}"));
        assert!(machine.solver(100.0).is_ok(), "{name}");
        count += 1;
    }
    assert!(count >= 20, "{count} machines");
}

#[test]
fn a_good_file_means_what_it_says() {
    let machine = try_load(GOOD, &[]).unwrap();
    let names: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["C", "A", "Y", "X", "Z"]);
    assert_eq!(machine.mount.z, 25.25);
    assert_eq!(machine.axes[1].joint.point.z, 50.5);
    assert_eq!(machine.axes[1].travel, Some([-120.0f64, 30.0].map(f64::to_radians)));
    assert_eq!(machine.axes[0].travel, None);
    assert_eq!(machine.axes[0].max_feed, 9000f64.to_radians());
    assert_eq!(machine.tools, [(1, 120.5)]);
    assert_eq!(machine.control.tcp, Tcp::Post);
    assert_eq!(machine.control.options.len(), 1);
    assert_eq!(machine.accuracy.axis_tolerance, 0.05f64.to_radians());
}

/// One slip: what is replaced by what, the line and what is underlined of it, part of the message, and whether a
/// remedy is given.
type Slip = (&'static str, &'static str, &'static str, &'static str, bool);

const CHAIN: &str = "2 \"[w C' A' b Y X Z (S) t]\"";

const SLIPS: &[Slip] = &[
    // Keys and syntax.
    ("mount =", "mout =", "9 mout", "there is no key `mout`", true),
    ("tolerance =", "tolerence =", "49 tolerence", "there is no key `tolerence`", true),
    ("max_feed = 9000", "max_fed = 9000", "22 max_fed", "there is no key `max_fed`", true),
    ("half = \"Zc / 2\"", "Zc = 2", "6 Zc", "duplicate key", false),
    ("[axis.A]\n", "[axis.C]\n", "24 C", "duplicate key", false),
    ("[0, 0, 400]", "[0, 0, 400", "13 ", "expected `,`", false),
    ("[0, 0, 400]", "[0, 400]", "12 [0, 400]", "array of length 3", false),
    (
        "[control]\ndialect = \"fanuc\"",
        "[control]",
        "41 [control]",
        "missing field `dialect`",
        false,
    ),
    ("tcp = \"post\"", "tcp = \"posts\"", "43 \"posts\"", "there is no value `posts`", true),
    ("tcp = \"post\"", "tcp = true", "43 true", "`true` does not say who keeps the tip", true),
    (
        "rotary = [0, 0, 1]",
        "rotary = \"Z\"",
        "19 \"Z\"",
        "expected three numbers, such as [1, 0, 0] for X",
        false,
    ),
    // Limits and words.
    (
        "[control]\ndialect",
        "[[limit]]\nkeep = \"Z > -100 + 2 * abs(B)\"\n\n[control]\ndialect",
        "42 \"Z > -100 + 2 * abs(B)\"",
        "B is neither an axis nor a parameter; its axes are C, A, Y, X, Z",
        false,
    ),
    (
        "[control]\ndialect",
        "[[limit]]\nkeep = \"half > 3\"\n\n[control]\ndialect",
        "42 \"half > 3\"",
        "`half > 3` names no axis",
        true,
    ),
    (
        "[control]\ndialect",
        "[word.X]\nis = \"2 * X + Y\"\n\n[control]\ndialect",
        "42 \"2 * X + Y\"",
        "X and Y do not both turn",
        false,
    ),
    (
        "[control]\ndialect",
        "[word.X]\nis = \"2 * X\"\ntravel = [3, 2]\n\n[control]\ndialect",
        "43 [3, 2]",
        "the first must be the smaller",
        true,
    ),
    (
        "program = 7",
        "program = [7]",
        "46 program",
        "a flag, a number, a text or an array of lines",
        false,
    ),
    ("1 = 120.5", "one = 120.5", "16 120.5", "no tool number", true),
    // Geometry.
    (
        "[axis.A]\nrotary = [1, 0, 0]",
        "[axis.A]\nrotary = [0, 0, 0.0]",
        "25 0, 0, 0.0",
        "direction of A is null",
        true,
    ),
    ("axis = [0, 0, 1]", "axis = [0, 0, 0]", "13 0, 0, 0", "tool axis is null", true),
    ("[-120, 30]", "[30, -120]", "27 [30, -120]", "from 30 to -120", true),
    ("[-120, 30]", "[30, 30]", "27 [30, 30]", "from 30 to 30", true),
    (
        "cyclic = true",
        "cyclic = true\ntravel = [-1, 1]",
        "22 [-1, 1]",
        "cyclic (endless) and has travel",
        true,
    ),
    ("cyclic = true\n", "", "18 [axis.C]", "C has no travel", true),
    (
        "linear = [1, 0, 0]\ntravel = [-300, 300]",
        "linear = [1, 0, 0]",
        "29 [axis.X]",
        "X has no travel",
        true,
    ),
    (
        "linear = [1, 0, 0]",
        "linear = [1, 0, 0]\nrotary = [1, 0, 0]",
        "29 [axis.X]",
        "one of the two",
        true,
    ),
    (
        "linear = [1, 0, 0]",
        "linear = [1, 0, 0]\npoint = [1, 0, 0]",
        "31 1",
        "a point means nothing",
        true,
    ),
    ("linear = [1, 0, 0]", "linear = [0, 1, 1]", CHAIN, "span no volume", true),
    ("point = [0, 0.012, \"Zc\"]\n", "", "24 [axis.A]", "where its axis line runs", true),
    ("rotary = [1, 0, 0]", "rotary = [0, 0, -2]", CHAIN, "C and A turn about parallel axes", true),
    (
        "b Y X Z (S) t]\"",
        "b Y X Z U t]\"\naxis.U = { linear = [0, 0, 1], travel = [0, 1] }",
        "2 \"[w C' A' b Y X Z U t]\"",
        "4 linear axes",
        true,
    ),
    (
        "travel = [-120, 30]",
        "travel = [-120, 30]\nindexed = 31",
        "28 31",
        "outside its travel",
        false,
    ),
    ("max_feed = 9000", "max_feed = 0", "22 0", "above zero", false),
    ("tolerance = 0.005", "tolerance = -0.005", "49 -0.005", "above zero", false),
    ("tcp = \"post\"\n", "", "41 [control]", "who keeps the tip", true),
    (
        "b Y X Z (S) t]\"",
        "b Y X S t]\"\naxis.S = { linear = [0, 0, 1], travel = [0, 1] }",
        "2 S",
        "an axis cannot be called S: in the program of every control S is the speed of the spindle",
        true,
    ),
    ("b Y X Z (S) t]\"", "b Y X Z H2 t]\"", "2 H2", "an axis cannot be called H2", true),
    // The chain.
    ("b Y X Z", "b Y Z", "29 [axis.X]", "does not stand in the chain", true),
    ("b Y X Z", "b Y X Z U", "2 U", "no [axis.U]", true),
    ("C' A' b", "C' A b", "2 A", "write A'", true),
    ("b Y X", "b Y X'", "2 X'", "X' is primed", true),
    ("b Y X", "b Y Y X", "2 Y", "Y stands twice", false),
    ("(S) t]", "(S)]", "2 ", "`t`, the tool, is missing", true),
    // Expressions.
    ("\"Zc\"", "\"Zd\"", "26 \"Zd\"", "`Zd` is not known", true),
    ("\"Zc\"", "\"Zc +\"", "26 \"Zc +\"", "is missing at the end", true),
    ("\"Zc\"", "\"Zc / (half - 25.25)\"", "26 \"Zc / (half - 25.25)\"", "division by zero", true),
    ("\"Zc\"", "\"sqrt(-Zc)\"", "26 \"sqrt(-Zc)\"", "no finite value", true),
    ("Zc = 50.5", "Zc = \"half * 2\"", "5 \"half * 2\"", "in a circle", true),
    ("[0, 0, 400]", "[0, 0, nan]", "12 nan", "no finite number", false),
    // How the control makes motion.
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\nperiod = 15",
        "52 15",
        "period is 15 s; from 0.00001 to 1 s is possible",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\nperiod = 0",
        "52 0",
        "period is 0 s; from 0.00001 to 1 s is possible",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\nblock_time = -1",
        "52 -1",
        "it must be 0 to 3600 s",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\nlook_ahead = 0",
        "52 0",
        "it must be 1 to 100000 blocks",
        false,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\ntip_accel = 0",
        "52 0",
        "tip_accel is 0; it must be above zero",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\ncorner = \"round\"",
        "52 \"round\"",
        "there is no value `round`",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\ncorner_tolerance = -0.01",
        "52 -0.01",
        "corner_tolerance is -0.01",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\nspindle = 1e6",
        "52 1e6",
        "spindle is 1000000 s",
        true,
    ),
    (
        "tolerance = 0.005",
        "tolerance = 0.005\n\n[motion]\njerk = 5",
        "52 jerk",
        "there is no key `jerk`",
        true,
    ),
];

/// All full turns of all rotary axes are weighed with one another, so that there must not be too many.
#[test]
fn rotary_axes_that_wind_up_together_are_refused() {
    let wide = ["axis.A.travel=[-18000, 18000]", "axis.C.travel=[-18000, 18000]"];
    let wide = [wide[0], wide[1], "axis.C.cyclic=false"];
    let found = try_load(GOOD, &wide).unwrap_err();
    let said = "hold 10000 ways to set them on other full turns; 1000 are possible";
    assert!(found[0].message.contains(said), "{found:?}");
    // One alone may.
    assert!(try_load(GOOD, &wide[..1]).is_ok());
}

#[test]
fn every_slip_is_refused_where_it_stands() {
    for (good, bad, place, message, help) in SLIPS {
        assert!(GOOD.contains(good), "{good} is not in the good file");
        let Err(found) = try_load(&GOOD.replacen(good, bad, 1), &[]) else {
            panic!("{bad} was loaded");
        };
        let first = &found[0];
        assert_eq!(underlined(first), *place, "{bad}: {first:?}");
        assert!(first.message.contains(message), "{bad}: {}", first.message);
        assert_eq!(first.help.is_some(), *help, "{bad}: {:?}", first.help);
        assert_eq!(first.severity, Severity::Error);
        assert_eq!(first.place.as_ref().map(|place| place.file.as_str()), Some("m.toml"));
    }
}

/// A cycle time cannot be told without accelerations; with them the rule is as good as any.
#[test]
fn the_rule_of_the_cycle_time_asks_for_accelerations() {
    let ruled =
        |text: &str| text.replace("[control]", "[solution]\nrule = \"cycle-time\"\n\n[control]");
    let found = try_load(&ruled(GOOD), &[]).unwrap_err();
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(underlined(&found[0]), "42 \"cycle-time\"");
    assert!(found[0].message.contains("max_accel of C, A, Y, X, Z"), "{}", found[0].message);
    assert!(found[0].help.is_some());
    let driven = GOOD.replace("rotary =", "max_accel = 300\nrotary =");
    let found = try_load(&ruled(&driven), &[]).unwrap_err();
    assert!(found[0].message.ends_with("max_accel of Y, X, Z"), "{}", found[0].message);
    let driven = driven.replace("linear =", "max_accel = 4000\nlinear =");
    let machine = try_load(&ruled(&driven), &[]).unwrap();
    assert_eq!(machine.solution.rule, SolutionCriterion::CycleTime);
}

#[test]
fn faults_that_do_not_hide_one_another_are_told_together() {
    let text = GOOD
        .replace("[-120, 30]", "[30, -120]")
        .replace("max_feed = 9000", "max_feed = -1")
        .replace("[0, 0, 400]", "[0, 0, \"gauge\"]")
        .replace("tcp = \"post\"\n", "");
    let found = try_load(&text, &[]).unwrap_err();
    let places: Vec<String> = found.iter().map(underlined).collect();
    assert_eq!(places, ["22 -1", "27 [30, -120]", "12 \"gauge\"", "41 [control]"]);
}

/// One missing bracket is one slip.
#[test]
fn a_syntax_error_is_told_once() {
    let found = try_load(&GOOD.replace("[0, 0, 400]", "[0, 0, 400"), &[]).unwrap_err();
    assert!(found.len() <= 5, "{} findings", found.len());
}

/// A parameter that has no value is a slip, whether or not anything uses it.
#[test]
fn parameters_that_nothing_uses_are_checked_too() {
    for (value, message) in [
        ("\"1 / 0\"", "division by zero"),
        ("\"Zd\"", "not known"),
        ("\"unused + 1\"", "in a circle"),
    ] {
        let text = GOOD.replace("Zc = 50.5", &format!("Zc = 50.5\nunused = {value}"));
        let Err(found) = try_load(&text, &[]) else {
            panic!("unused = {value} was loaded");
        };
        assert_eq!(underlined(&found[0]), format!("6 {value}"));
        assert!(found[0].message.contains(message), "{found:?}");
    }
}

#[test]
fn a_machine_extends_another_key_by_key() {
    let machine =
        try_load("extends = \"good\"\nname = \"other\"\naxis.A.travel = [-90, 90]\n", &[]).unwrap();
    assert_eq!(machine.name, "other");
    assert_eq!(machine.axes[1].travel, Some([-90.0f64, 90.0].map(f64::to_radians)));
    assert_eq!(machine.axes[1].joint.point.z, 50.5);

    let found = try_load("name = \"x\"\nextends = \"nowhere\"\n", &[]).unwrap_err();
    assert_eq!(underlined(&found[0]), "2 \"nowhere\"");
    assert!(found[0].message.contains("nowhere"), "{found:?}");

    let found = try_load("extends = \"circle\"\n", &[]).unwrap_err();
    assert_eq!(underlined(&found[0]), "1 \"circle\"");
    assert!(found[0].message.contains("circle"), "{found:?}");

    // A fault is told in the file that it stands in.
    let found = try_load(
        "extends = \"good\"\nparameters.Zc = 0\naxis.X.linear = [0, 0, 0]\nmount = 1\n",
        &[],
    )
    .unwrap_err();
    assert_eq!(underlined(&found[0]), "4 mount");
    let found = try_load("extends = \"good\"\naxis.A.max_feed = \"Zc - 60\"\n", &[]).unwrap_err();
    assert_eq!(underlined(&found[0]), "2 \"Zc - 60\"");

    // Of two keys that stand in one another's place the later takes the earlier away.
    let endless = try_load("extends = \"good\"\naxis.A.cyclic = true\n", &[]).unwrap();
    assert_eq!(endless.axes[1].travel, None);
    let limited = try_load("extends = \"good\"\naxis.C.travel = [0, 90]\n", &[]);
    assert!(limited.unwrap().axes[0].travel.is_some());
    let kept = try_load("extends = \"good\"\naxis.A.cyclic = false\n", &[]).unwrap();
    assert!(kept.axes[1].travel.is_some());
}

#[test]
fn how_a_control_makes_motion_is_merged_key_by_key() {
    let rules = try_load(GOOD, &[]).unwrap().motion;
    assert_eq!((rules.period, rules.block_time, rules.look_ahead), (0.001, 0.0, 200));
    assert_eq!((rules.corner, rules.corner_tolerance), (CornerRule::Blend, None));
    assert_eq!(
        (rules.limits, rules.blend, rules.rapids),
        (LimitsActOn::Axes, BlendRule::Round, RapidRule::Stop)
    );
    assert!(rules.tip_accel.is_infinite() && rules.tip_jerk.is_infinite());
    assert_eq!((rules.tool_change, rules.spindle), (0.0, 0.0));

    let own = "extends = \"good\"\n[motion]\nperiod = \"Zc / 12625\"\nlimits = \"programmed\"\ncorner = \"path\"\n\
               corner_tolerance = 0.02\nblend = \"overlap\"\nrapids = \"among-rapids\"\ntip_accel = 900\ntip_jerk = 8000\n";
    let settings = ["motion.period=0.008", "motion.look_ahead=20", "motion.block_time=0.002"];
    let plain = try_load(own, &[]).unwrap().motion;
    assert_eq!((plain.period, plain.look_ahead), (0.004, 200));
    let rules = try_load(own, &settings).unwrap().motion;
    assert_eq!((rules.period, rules.block_time, rules.look_ahead), (0.008, 0.002, 20));
    assert_eq!((rules.corner, rules.corner_tolerance), (CornerRule::Path, Some(0.02)));
    assert_eq!((rules.limits, rules.blend), (LimitsActOn::Programmed, BlendRule::Overlap));
    assert_eq!(
        (rules.tip_accel, rules.tip_jerk, rules.rapids),
        (900.0, 8000.0, RapidRule::AmongRapids)
    );
}

#[test]
fn jumps_of_velocity_are_those_of_the_file_that_says_them_last() {
    let of = |text: &str, settings: &[&str]| {
        let machine = try_load(text, settings).unwrap();
        let axis = |name: &str| {
            let found = machine.axes.iter().find(|axis| axis.name == name);
            found.unwrap().max_jump
        };
        (axis("X"), axis("A"), machine.motion.tip_jump)
    };
    assert_eq!(of(GOOD, &[]), (None, None, None));
    let own = "extends = \"good\"\n[axis.X]\nmax_jump = \"Zc * 4\"\n[axis.A]\nmax_jump = 180\n[motion]\ntip_jump = 300\n";
    let turn = Some(std::f64::consts::PI);
    assert_eq!(of(own, &[]), (Some(202.0), turn, Some(300.0)));
    assert_eq!(of(own, &["axis.X.max_jump=60"]), (Some(60.0), turn, Some(300.0)));
    for (own, shown) in [
        ("extends = \"good\"\n[axis.X]\nmax_jump = 0\n", "3 0"),
        ("extends = \"good\"\n[motion]\ntip_jump = -5\n", "3 -5"),
    ] {
        let found = try_load(own, &[]).unwrap_err();
        assert_eq!(underlined(&found[0]), shown, "{found:?}");
        assert!(found[0].message.contains("above zero"), "{found:?}");
    }
}

#[test]
fn a_part_sits_turned_whatever_head_is_in() {
    let machine = try_load(GOOD, &["workpiece.turn=\"30 + half / 25.25\""]).unwrap();
    assert!((machine.turn - 31f64.to_radians()).abs() < 1e-15);
    assert_eq!(try_load(GOOD, &[]).unwrap().turn, 0.0);
    let head = format!("{GOOD}\n[head.other]\nword = \"M6\"\ntool.gauge = [0, 0, 350]\n");
    assert_eq!(try_load(&head, &[]).unwrap().heads.len(), 1);
    let turns = format!("{head}workpiece.turn = 90\n");
    let found = try_load(&turns, &[]).unwrap_err();
    assert!(found[0].message.contains("turns the part"), "{found:?}");
}

#[test]
fn settings_win_over_the_file() {
    let machine = try_load(
        GOOD,
        &["Zc=60", "accuracy.tolerance=0.001", "control.dialect=own", "axis.A.travel=[-90, 20]"],
    )
    .unwrap();
    assert_eq!(machine.mount.z, 30.0);
    assert_eq!(machine.accuracy.tolerance, 0.001);
    assert_eq!(machine.control.dialect, "own");
    assert_eq!(machine.axes[1].travel, Some([-90.0f64, 20.0].map(f64::to_radians)));
    // The last one wins, and an expression is one here too.
    assert_eq!(
        try_load(GOOD, &["Zc=1", "Zc=\"half0 * 2\"", "parameters.half0=7"])
            .map(|machine| machine.mount.z)
            .ok(),
        None
    );
    assert_eq!(try_load(GOOD, &["Zc=1", "Zc=\"3 * 4\""]).unwrap().mount.z, 6.0);

    let found = try_load(GOOD, &["Zd=60"]).unwrap_err();
    assert!(found[0].message.contains("no parameter of that name"), "{found:?}");
    assert!(found[0].help.as_ref().unwrap().contains("Zc, half"), "{found:?}");
    let found = try_load(GOOD, &["Zc"]).unwrap_err();
    assert!(found[0].message.contains("no value") && found[0].help.is_some(), "{found:?}");
    let found = try_load(GOOD, &["accuracy.tolerence=1"]).unwrap_err();
    assert_eq!(underlined(&found[0]), "1 tolerence");
    let found = try_load(GOOD, &["accuracy.tolerance=-1"]).unwrap_err();
    let place = found[0].place.as_ref().unwrap();
    assert_eq!((place.file.as_str(), underlined(&found[0]).as_str()), ("--set", "1 -1"));
}

/// Whatever is done to a file, it loads or is refused with places that can be shown.
#[test]
fn no_text_makes_it_stumble() {
    let mut refused = 0;
    for at in 0..GOOD.len() {
        for piece in ["", "\"", "[", "=", "\n", "ß", "-", "9e999"] {
            let text =
                format!("{}{piece}{}", &GOOD[..at], &GOOD[at + usize::from(piece.is_empty())..]);
            if let Err(found) = try_load(&text, &[]) {
                refused += 1;
                for finding in found.iter().filter(|finding| finding.place.is_some()) {
                    underlined(finding);
                }
            }
        }
    }
    assert!(refused > 1_000, "{refused}");
}

/// Several slips in one text: each is told where it stands, and nothing repeats another.
#[track_caller]
fn assert_all(slips: &[(&str, &str)], told: &[&str]) {
    let mut text = GOOD.to_owned();
    for (from, to) in slips {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let found = try_load(&text, &[]).unwrap_err();
    let mut places: Vec<String> = found.iter().map(underlined).collect();
    places.sort();
    let mut told: Vec<String> = told.iter().map(|&place| place.to_owned()).collect();
    told.sort();
    assert_eq!(places, told, "{found:#?}");
}

#[test]
fn no_independent_fault_hides_another() {
    // A misspelt key, a misspelt word, a null direction, an unknown parameter, a travel the wrong way round in the table of
    // the misspelt key, a limit below zero.
    assert_all(
        &[
            ("max_feed = 9000", "max_fed = 9000"),
            ("tcp = \"post\"", "tcp = \"pots\""),
            ("axis = [0, 0, 1]", "axis = [0, 0, 0]"),
            ("mount = [0, 0, \"half\"]", "mount = [0, 0, \"hlf\"]"),
            ("point = [0, 0, 0]\ncyclic = true", "point = [0, 0, 0]\ntravel = [9, -9]"),
            ("tolerance = 0.005", "tolerance = -1"),
        ],
        &["22 max_fed", "43 \"pots\"", "13 0, 0, 0", "9 \"hlf\"", "21 [9, -9]", "49 -1"],
    );
    // Lines that are no TOML, apart from one another, and what else is wrong.
    assert_all(
        &[
            ("half = \"Zc / 2\"", "half = = 2"),
            ("axis = [0, 0, 1]", "axis = (0, 0, 1)"),
            ("tolerance = 0.005", "tolerance = -1"),
        ],
        &["6 =", "13 ", "49 -1"],
    );
    // A parameter without a value is told once, whatever uses it, and hides nothing.
    assert_all(
        &[("Zc = 50.5", "Zc = \"1 / 0\""), ("travel = [-450, 200]", "travel = [200, -450]")],
        &["5 \"1 / 0\"", "39 [200, -450]"],
    );
    // A table that is missing, and a value of another kind.
    assert_all(
        &[("gauge = [0, 0, 400]", "gauge = true"), ("dialect = \"fanuc\"\n", "")],
        &["12 true", "41 [control]"],
    );
}
