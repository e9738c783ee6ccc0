//! The machine files that `post new` writes: for each class its chain and its rotary axes, and one way to write
//! them down. What they mean is the loader's business.

use std::fmt::Write as _;

use clap::ValueEnum;
use post_machine::description::{OutputUnits, Tcp};

use post_job::machine_files;

use super::{AxisSetting, Choices, of_library};

/// How the rotary axes stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Class {
    /// No rotary axis.
    ThreeAxis,
    /// A rotary table or dividing head along X.
    FourAxisA,
    /// A rotary table (pallet) along Y.
    FourAxisB,
    /// C on an A trunnion or swivel.
    TableTableAc,
    /// C on a B swivel.
    TableTableBc,
    /// C on a B that lies 45° between Y and Z.
    TableTableNutating,
    /// A fork head: C carries A.
    HeadHeadAc,
    /// A fork head: C carries B.
    HeadHeadBc,
    /// A B head over a C table.
    HeadTableBc,
    /// A B head over an A table.
    HeadTableBa,
    /// A 45° nutating B head over a C table.
    NutatingHead,
    /// A lathe with driven tools: X, Z and the work spindle C.
    LatheXzc,
    /// A lathe with a milling head: X, Y, Z, the work spindle C and B.
    MillTurn,
    /// A lathe of two axes, X and Z, that turns.
    LatheXz,
    /// A knife or saw that C turns along its cut, over a flat bed.
    TangentialKnife,
    /// A robot's arm with parallel shoulder and spherical wrist: A B C U V W are its axes 1 to 6.
    Robot,
    /// Such an arm on a rail, Y.
    RobotOnRail,
    /// An arm that turns about two upright lines, A and B, with an upright Z.
    Scara,
    /// A delta: three carriages on upright rails, and rods to a platform that stays upright.
    LinearDelta,
    /// Six struts between a frame and a platform; its words are X, Y, Z and the angles of the tool A and B.
    Hexapod,
    /// Three struts that lead a tube in a universal joint, with a wrist of two axes on it.
    Tricept,
    /// A platform on three legs, two of which turn in one plane, with a wrist of two axes below it.
    Exechon,
}

/// The seven lengths of an arm, as they are published for it, mm: their names and what they are, the arm stretched straight up.
pub const ARM_LENGTHS: [(&str, &str); 7] = [
    ("a1", "line of the second axis out from that of the first"),
    ("a2", "line of the fourth axis out from that of the third; behind it negative"),
    ("b", "wrist to the left of the plane of the shoulder"),
    ("c1", "line of the second axis over the foot"),
    ("c2", "line of the third axis over that of the second"),
    ("c3", "middle of the wrist over the line of the third axis"),
    ("c4", "flange over the middle of the wrist"),
];

/// An arm of two metres, published for an ABB IRB 2600, mm.
pub const USUAL_ARM: [f64; 7] = [150.0, -115.0, 0.0, 445.0, 700.0, 795.0, 85.0];

/// A rotary axis of a class.
struct Rotary {
    name: &'static str,
    direction: &'static str,
    /// Parameters may stand in it.
    point: &'static str,
    /// Degrees; none turns without end.
    travel: Option<[f64; 2]>,
    measure: &'static str,
}

const TABLE_C: Rotary = Rotary {
    name: "C",
    direction: "[0, 0, 1]",
    point: "[0, 0, 0]",
    travel: None,
    measure: "middle of the table: indicate its bore; X and Y of the axis line",
};

/// From the line of the work spindle to the gauge point, X at zero, mm.
const LATHE_X: f64 = 400.0;

const WORK_SPINDLE: Rotary = Rotary {
    name: "C",
    direction: "[0, 0, 1]",
    point: "[0, 0, 0]",
    travel: None,
    measure: "line of the work spindle: indicate a turned diameter; X and Y of the line",
};

const MILLING_HEAD: Rotary = Rotary {
    name: "B",
    direction: "[0, 1, 0]",
    point: "[\"400 + pivot\", 0, \"gauge\"]",
    travel: Some([-30.0, 210.0]),
    measure: "any point on its line",
};

const fn tilting(name: &'static str, direction: &'static str, travel: [f64; 2]) -> Rotary {
    Rotary {
        name,
        direction,
        point: "[0, 0, \"tilt\"]",
        travel: Some(travel),
        measure: "any point on its line; where it misses the line of C, say by how much",
    }
}

const fn swivel(name: &'static str, direction: &'static str, travel: [f64; 2]) -> Rotary {
    Rotary {
        name,
        direction,
        point: "[0, 0, \"gauge + pivot\"]",
        travel: Some(travel),
        measure: "any point on its line; where it misses the spindle, say by how much",
    }
}

const fn table(name: &'static str, direction: &'static str) -> Rotary {
    Rotary {
        name,
        direction,
        point: "[0, 0, 0]",
        travel: None,
        measure: "any point on its line; the part origin sits on it here",
    }
}

const FORK_C: Rotary = Rotary {
    name: "C",
    direction: "[0, 0, 1]",
    point: "[0, 0, 0]",
    travel: Some([-360.0, 360.0]),
    measure: "any point on its line, X and Y: where it misses the spindle, say by how much",
};

const fn arm_joint(
    name: &'static str,
    direction: &'static str,
    point: &'static str,
    travel: [f64; 2],
) -> Rotary {
    Rotary {
        name,
        direction,
        point,
        travel: Some(travel),
        measure: "any point on its line, the arm stretched straight up",
    }
}

/// Travels that are common among arms.
const ARM: [Rotary; 6] = [
    arm_joint("A", "[0, 0, 1]", "[0, 0, 0]", [-180.0, 180.0]),
    arm_joint("B", "[0, 1, 0]", "[\"a1\", 0, \"c1\"]", [-95.0, 155.0]),
    arm_joint("C", "[0, 1, 0]", "[\"a1\", 0, \"c1 + c2\"]", [-90.0, 165.0]),
    arm_joint("U", "[0, 0, 1]", "[\"a1 + a2\", \"b\", \"c1 + c2 + c3\"]", [-400.0, 400.0]),
    arm_joint("V", "[0, 1, 0]", "[\"a1 + a2\", \"b\", \"c1 + c2 + c3\"]", [-120.0, 120.0]),
    arm_joint("W", "[0, 0, 1]", "[\"a1 + a2\", \"b\", \"c1 + c2 + c3\"]", [-400.0, 400.0]),
];

const fn scara_joint(name: &'static str, point: &'static str, travel: [f64; 2]) -> Rotary {
    Rotary {
        name,
        direction: "[0, 0, 1]",
        point,
        travel: Some(travel),
        measure: "any point on its line, the arm stretched along X",
    }
}

const fn platform_angle(name: &'static str, direction: &'static str, end: f64) -> Rotary {
    Rotary {
        name,
        direction,
        point: "[0, 0, \"gauge + joint\"]",
        travel: Some([-end, end]),
        measure: "the middle of the joints on the platform",
    }
}

impl Class {
    fn chain(self) -> &'static str {
        match self {
            Self::ThreeAxis => "[w Y' X' b Z (S) t]",
            Self::FourAxisA => "[w A' X' Y' b Z (S) t]",
            Self::FourAxisB => "[w B' b X Y Z (S) t]",
            Self::TableTableAc => "[w C' A' b Y X Z (S) t]",
            Self::TableTableBc | Self::TableTableNutating => "[w C' B' b Y X Z (S) t]",
            Self::HeadHeadAc => "[w b X Y Z C A (S) t]",
            Self::HeadHeadBc => "[w b X Y Z C B (S) t]",
            Self::HeadTableBc | Self::NutatingHead => "[w C' b X Y Z B (S) t]",
            Self::HeadTableBa => "[w A' b X Y Z B (S) t]",
            Self::LatheXzc => "[w C' b Z X (S) t]",
            Self::MillTurn => "[w C' b Z X Y B (S) t]",
            Self::LatheXz => "[w b Z X t]",
            Self::TangentialKnife => "[w b X Y Z C t]",
            Self::Robot => "[w b A B C U V W (S) t]",
            Self::RobotOnRail => "[w b Y A B C U V W (S) t]",
            Self::Scara => "[w b A B Z (S) t]",
            Self::Hexapod => "[w b X Y Z C B A (S) t]",
            Self::Tricept | Self::Exechon => "[w b X Y Z C A (S) t]",
            Self::LinearDelta => "[w b X Y Z (S) t]",
        }
    }

    /// X goes from the line of the work spindle to one side, and its words are diameters.
    fn is_lathe(self) -> bool {
        matches!(self, Self::LatheXz | Self::LatheXzc | Self::MillTurn)
    }

    fn linear(self) -> &'static [&'static str] {
        match self {
            Self::LatheXz | Self::LatheXzc => &["X", "Z"],
            Self::Robot => &[],
            Self::RobotOnRail => &["Y"],
            Self::Scara => &["Z"],
            _ => &["X", "Y", "Z"],
        }
    }

    /// Where the gauge point stands with every axis at zero; parameters may stand in it.
    fn gauge_point(self) -> String {
        match self {
            _ if self.is_lathe() => format!("[{LATHE_X}, 0, \"gauge\"]"),
            Self::Scara => "[\"upper + fore\", 0, \"gauge\"]".to_owned(),
            Self::Robot | Self::RobotOnRail => {
                "[\"a1 + a2\", \"b\", \"c1 + c2 + c3 + c4\"]".to_owned()
            }
            _ => "[0, 0, \"gauge\"]".to_owned(),
        }
    }

    /// The direction from the tip to the holder, and what is to be said of it.
    fn tool_axis(self) -> [&'static str; 2] {
        match self {
            Self::LatheXzc => {
                ["[0, 0, 1]", "along the work spindle; across it [1, 0, 0] and length_axis = \"X\""]
            }
            Self::MillTurn => ["[1, 0, 0]", "from the tip to the holder, B as it shows 90"],
            Self::Robot | Self::RobotOnRail => [
                "[0, 0, -1]",
                "from the tip to the holder: here the spindle goes on along the flange",
            ],
            _ => ["[0, 0, 1]", "from the tip to the holder"],
        }
    }

    /// What the control shows of an axis that the drawing has at zero, degrees.
    fn shown_at_zero(self, axis: &str) -> Option<f64> {
        (self == Self::MillTurn && axis == "B").then_some(90.0)
    }

    fn rotary(self) -> Vec<Rotary> {
        match self {
            Self::ThreeAxis | Self::LatheXz | Self::LinearDelta => vec![],
            Self::FourAxisA => vec![table("A", "[1, 0, 0]")],
            Self::FourAxisB => vec![table("B", "[0, 1, 0]")],
            Self::TableTableAc => vec![TABLE_C, tilting("A", "[1, 0, 0]", [-120.0, 30.0])],
            Self::TableTableBc => vec![TABLE_C, tilting("B", "[0, 1, 0]", [-30.0, 110.0])],
            Self::TableTableNutating => vec![TABLE_C, tilting("B", "[0, 1, 1]", [0.0, 180.0])],
            Self::HeadHeadAc => vec![FORK_C, swivel("A", "[1, 0, 0]", [-110.0, 110.0])],
            Self::HeadHeadBc => vec![FORK_C, swivel("B", "[0, 1, 0]", [-110.0, 110.0])],
            Self::HeadTableBc => vec![TABLE_C, swivel("B", "[0, 1, 0]", [-100.0, 100.0])],
            Self::HeadTableBa => {
                vec![table("A", "[1, 0, 0]"), swivel("B", "[0, 1, 0]", [-100.0, 100.0])]
            }
            Self::NutatingHead => vec![TABLE_C, swivel("B", "[0, 1, 1]", [0.0, 180.0])],
            Self::LatheXzc => vec![WORK_SPINDLE],
            Self::MillTurn => vec![WORK_SPINDLE, MILLING_HEAD],
            Self::TangentialKnife => vec![Rotary {
                measure: "line about which the knife turns: its edge, or the middle of it, belongs there",
                ..TABLE_C
            }],
            Self::Robot | Self::RobotOnRail => ARM.into(),
            Self::Scara => vec![
                scara_joint("A", "[0, 0, 0]", [-130.0, 130.0]),
                scara_joint("B", "[\"upper\", 0, 0]", [-145.0, 145.0]),
            ],
            Self::Hexapod => vec![
                platform_angle("C", "[0, 0, 1]", 10.0),
                platform_angle("B", "[0, 1, 0]", 20.0),
                platform_angle("A", "[1, 0, 0]", 20.0),
            ],
            Self::Tricept | Self::Exechon => vec![
                platform_angle("C", "[0, 0, 1]", 360.0),
                platform_angle("A", "[1, 0, 0]", 100.0),
            ],
        }
    }

    /// The addresses of its axes, linear ones first.
    pub fn axes(self) -> Vec<&'static str> {
        let rotary = self.rotary();
        let mut axes = self.linear().to_vec();
        axes.extend(rotary.iter().map(|axis| axis.name));
        axes
    }

    /// It has any rotary axis.
    pub fn turns(self) -> bool {
        !matches!(self, Self::ThreeAxis | Self::LatheXz | Self::LinearDelta)
    }

    /// Its control may keep the tip, which takes words X, Y and Z.
    pub fn keeps_tips(self) -> bool {
        let keeps_none = matches!(self, Self::LatheXzc | Self::TangentialKnife | Self::Scara);
        self.turns() && !keeps_none && !self.has_arm()
    }

    /// Who keeps the tip, if nobody says so. The tool of a mill-turn is drawn across the part, and its length is put along Z;
    /// struts are no axes whose positions a program could say.
    pub fn usual_tcp(self) -> Tcp {
        let keeps = matches!(self, Self::MillTurn | Self::Hexapod) || self.library().is_some();
        if keeps { Tcp::Control } else { Tcp::Post }
    }

    /// The lengths of an arm stand in its file.
    pub fn has_arm(self) -> bool {
        matches!(self, Self::Robot | Self::RobotOnRail)
    }

    /// The height `gauge` stands in its file.
    pub fn has_gauge(self) -> bool {
        !self.has_arm() && self.library().is_none()
    }

    /// The machine of the library from whose file its own is made.
    pub fn library(self) -> Option<&'static str> {
        match self {
            Self::Tricept => Some("tricept"),
            Self::Exechon => Some("exechon"),
            _ => None,
        }
    }

    /// mm, the tip in cuts, if nobody says another.
    pub fn usual_tolerance(self) -> f64 {
        match self {
            Self::Robot | Self::RobotOnRail => 0.05,
            Self::Scara | Self::TangentialKnife | Self::Tricept | Self::Exechon => 0.02,
            _ => 0.005,
        }
    }

    /// The distance `gauge + pivot` stands in its file.
    pub fn has_pivot(self) -> bool {
        self.axis_at("pivot").is_some()
    }

    /// The height `tilt` stands in its file.
    pub fn has_tilt(self) -> bool {
        self.axis_at("tilt").is_some()
    }

    /// The axis whose point is given by this parameter.
    pub fn axis_at(self, parameter: &str) -> Option<&'static str> {
        let mut rotary = self.rotary().into_iter();
        let axis = rotary.find(|axis| axis.point.contains(parameter))?;
        Some(axis.name)
    }

    /// Travel of an axis if nobody says another: mm or degrees; none turns without end.
    pub fn usual_travel(self, axis: &str, gauge: f64) -> Option<[f64; 2]> {
        match axis {
            // To a little beyond the line of the work spindle.
            "X" if self == Self::MillTurn => Some([-LATHE_X - 280.0, 20.0]),
            "X" if self.is_lathe() => Some([-LATHE_X - 20.0, 20.0]),
            "Y" if self.is_lathe() => Some([-100.0, 100.0]),
            "X" | "Y" if self == Self::LinearDelta => Some([-150.0, 150.0]),
            "X" | "Y" if self == Self::Hexapod => Some([-200.0, 200.0]),
            "Y" if self == Self::RobotOnRail => Some([-2000.0, 2000.0]),
            "X" | "Y" => Some([-300.0, 300.0]),
            // From the upper end down to the table's face.
            "Z" => Some([-gauge.abs().max(1.0), 0.0]),
            _ => self
                .rotary()
                .iter()
                .find(|rotary| rotary.name == axis)
                .and_then(|rotary| rotary.travel),
        }
    }
}

/// The whole file.
pub fn write(choices: &Choices) -> String {
    if let Some(name) = choices.class.library() {
        let text = machine_files::of_library(name).unwrap_or_default();
        return of_library::write(name, text, choices);
    }
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut line = |said: &str, remark: &str| {
        let _ = match remark {
            "" => writeln!(text, "{said}"),
            remark => writeln!(text, "{said:<39} # {remark}"),
        };
    };
    head(&mut line, choices);
    parameters(&mut line, choices);
    linear_axes(&mut line, choices);
    rotary_axes(&mut line, choices);
    match choices.class {
        Class::LinearDelta => carriages(&mut line),
        Class::Hexapod => struts(&mut line),
        Class::LatheXz => work_spindle(&mut line),
        _ => {}
    }
    control(&mut line, choices);
    if choices.class != Class::LatheXz {
        line("", "");
        line("# [spindle]", "");
        line(
            "# max_speed = 12000",
            "rpm: what the spindle can do; a CL file that asks for more is refused",
        );
    }
    line("", "");
    line("[accuracy]", "");
    line(&format!("tolerance = {}", choices.tolerance), "mm, the tip in cuts");
    if choices.class == Class::TangentialKnife {
        line("axis_tolerance = 0.5", "degrees, the edge against its way");
    }
    let solution = match choices.class {
        _ if choices.class.has_arm() => {
            ("start = { C = 90, V = 90 }", "where it begins: the forearm level, the tool down")
        }
        Class::Scara => ("start = { B = 90 }", "where it begins: on which side the elbow is bent"),
        Class::TangentialKnife => ("edge = \"travel\"", "the edge leads along the cut"),
        _ => return text,
    };
    line("", "");
    line("[solution]", "");
    line(solution.0, solution.1);
    text
}

/// What the file is, the machine's name and its chain.
fn head(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    let title = choices.title.replace('\\', "\\\\").replace('"', "\\\"");
    let title: String = title.chars().filter(|letter| !letter.is_control()).collect();
    line(
        "# Written by `post new`: every number is an example until it was measured on the machine.",
        "",
    );
    line("#", "");
    if choices.class.has_arm() {
        line(
            "# Positions are in mm in the machine frame, with the arm stretched straight up; here its origin is the foot of the",
            "",
        );
        line(
            "# arm, on the line of the first axis. `zero` says what the control shows of an axis that stands so, `reversed` that",
            "",
        );
        line(
            "# it counts the other way. `post check` prints what each sign means, `post check --commission` tries them.",
            "",
        );
    } else {
        frame_of_a_table(line, choices);
    }
    line("", "");
    line(&format!("name  = \"{title}\""), "");
    line(
        &format!("chain = \"{}\"", choices.class.chain()),
        "from the workpiece w over the bed b to the tool t; ' carries the part",
    );
    line("", "");
}

/// What positions and directions in the file of a machine with a table are.
fn frame_of_a_table(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    line(
        "# Positions are in mm in the machine frame, with every axis at zero; here its origin is the middle of the",
        "",
    );
    let face = if choices.class.is_lathe() { "chuck" } else { "table" };
    line(
        &format!(
            "# {face}'s face. Directions are those of the tool as seen from the part (ISO 841): where the {face} moves,"
        ),
        "",
    );
    line(
        "# it moves the other way. `post check` prints what each sign means, `post check --commission` tries them.",
        "",
    );
}

/// Distances of the machine, where the part sits, and the tool.
fn parameters(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    if choices.class.has_arm() {
        return arm(line, choices);
    }
    line("[parameters]", "");
    line(
        &format!("gauge = {}", choices.gauge),
        match choices.class.is_lathe() {
            true => "gauge point before the chuck's face, all axes at zero",
            false => "gauge line over the table's face, all axes at zero",
        },
    );
    // An axis whose point is given asks for no distance.
    let asked = |parameter: &str| {
        let axis = choices.class.axis_at(parameter);
        axis.is_some_and(|axis| given(&choices.point, axis).is_none())
    };
    if choices.class == Class::LinearDelta {
        line("rail  = 200", "from the middle to the joints on the carriages, square to the rails");
        line("hub   = 40", "from there to the joints on the platform");
        line("rod   = 420", "between both joints");
    }
    if choices.class == Class::Hexapod {
        line("frame = 670", "from the middle to the joints of the frame, square to Z");
        line("hub   = 290", "from the middle to the joints of the platform");
        line("joint = 50", "these over the gauge line");
        line("rise  = 800", "those over these, all axes at zero");
    }
    if choices.class == Class::Scara {
        line("upper = 350", "line of A to line of B");
        line("fore  = 300", "line of B to the spindle");
    }
    if asked("pivot") {
        line(
            &format!("pivot = {}", choices.pivot),
            "swivel axis to gauge line: swing to 90° and compare with 0°",
        );
    }
    if asked("tilt") {
        line(
            &format!("tilt  = {}", choices.tilt),
            "tilting axis over the table's face; below it is negative",
        );
    }
    line("", "");
    line("[workpiece]", "");
    let middle = match choices.class.is_lathe() {
        true => "part origin: here the middle of the chuck's face; --mount for one job",
        false => "part origin: here the middle of the table; --mount for one job",
    };
    match choices.class {
        Class::Scara => {
            let before = "part origin: here before the arm; --mount for one job";
            line("mount = [\"0.7 * (upper + fore)\", 0, 0]", before);
        }
        _ => line("mount = [0, 0, 0]", middle),
    }
    line("", "");
    line("[tool]", "");
    line(&format!("gauge = {}", choices.class.gauge_point()), "");
    let [axis, remark] = choices.class.tool_axis();
    line(&format!("axis  = {axis}"), remark);
    match choices.class {
        Class::TangentialKnife => {
            line("edge  = [1, 0, 0]", "where the knife cuts towards, C at zero");
        }
        Class::LatheXz => {
            line("length_axis = \"none\"", "the tool's offsets hold its X and Z: no G43");
        }
        _ => {}
    }
}

/// Lengths of an arm, a part within its reach, and the tool.
fn arm(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    line("[parameters]", "");
    for ((name, remark), length) in ARM_LENGTHS.iter().zip(choices.arm) {
        line(&format!("{name:<2} = {length}"), remark);
    }
    let [a1, _, _, c1, c2, c3, _] = choices.arm;
    let out = libm::round(libm::fabs(a1) + 0.5 * (libm::fabs(c2) + libm::fabs(c3)));
    line("", "");
    line("[workpiece]", "");
    line(
        &format!("mount = [{out}, 0, {}]", libm::round(0.5 * c1)),
        "part origin: here before the arm; --mount for one job",
    );
    line("", "");
    line("[tool]", "");
    line(&format!("gauge = {}", choices.class.gauge_point()), "spindle nose: here on the flange");
    let [axis, remark] = choices.class.tool_axis();
    line(&format!("axis  = {axis}"), remark);
    line("length_axis = \"none\"", "words are values of the axes, with the tool");
}

fn linear_axes(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    for (name, direction, lean) in [
        ("X", "[1, 0, 0]", "20 µm/m towards Y: [1, 20e-6, 0]"),
        ("Y", "[0, 1, 0]", "20 µm/m towards X: [20e-6, 1, 0]"),
        ("Z", "[0, 0, 1]", "20 µm/m towards X: [20e-6, 0, 1]"),
    ] {
        if !choices.class.linear().contains(&name) {
            continue;
        }
        line("", "");
        line(&format!("[axis.{name}]"), "");
        line(&format!("linear   = {direction}"), &format!("as measured; a lean of {lean}"));
        travel(line, choices, name);
        reversed(line, choices, name);
        line(&format!("max_feed = {}", feed(choices, name, 20_000.0)), "mm/min");
    }
    if choices.class.is_lathe() {
        line("", "");
        line("[word.X]", "");
        line("is = \"2 * X\"", "the program has diameters; all of this file is in radii");
    }
}

fn rotary_axes(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    for rotary in choices.class.rotary() {
        let name = rotary.name;
        line("", "");
        line(&format!("[axis.{name}]"), "");
        line(&format!("rotary   = {}", rotary.direction), "any length; as measured");
        let point = match given(&choices.point, name) {
            Some([x, y, z]) => format!("[{x}, {y}, {z}]"),
            None => rotary.point.to_owned(),
        };
        line(&format!("point    = {point}"), rotary.measure);
        if choices.class.has_arm() {
            line("zero     = 0", "what the control shows of it, the arm stretched straight up");
        }
        if let Some(shown) = choices.class.shown_at_zero(name) {
            line(&format!("zero     = {shown}"), "shown where it stands as drawn");
        }
        travel(line, choices, name);
        if (choices.class, name) == (Class::Hexapod, "C") {
            line("indexed  = 0", "a tool that turns needs no yaw");
        }
        reversed(line, choices, name);
        line(&format!("max_feed = {}", feed(choices, name, 3600.0)), "deg/min");
    }
}

/// What drives the platform of a delta.
fn carriages(line: &mut impl FnMut(&str, &str)) {
    for (leg, angle) in [90, 210, 330].into_iter().enumerate() {
        let joint = |radius: &str| {
            format!("[\"{radius} * cos({angle})\", \"{radius} * sin({angle})\", \"gauge + 100\"]")
        };
        line("", "");
        line("[[leg]]", "");
        line(&format!("name     = \"J{leg}\""), "its drive, as the control calls it");
        line(&format!("from     = {}", joint("rail")), "its joint on the carriage, that at zero");
        line("slide    = [0, 0, 1]", "the rail: the way in which the drive counts plus");
        line("rod      = \"rod\"", "measured joint to joint");
        line("at       = \"Z\"", "the platform");
        line(&format!("to       = {}", joint("hub")), "its joint there, all axes at zero");
        line("travel   = [\"-gauge\", \"rod\"]", "mm");
        line("max_feed = 20000", "mm/min");
    }
}

/// What drives the platform of a hexapod: each joint of the frame leads to two of the platform, 5° beside the gap between
/// them.
fn struts(line: &mut impl FnMut(&str, &str)) {
    let angles = [(150, 95), (30, 85), (30, -25), (-90, -35), (-90, -145), (150, -155)];
    for (leg, (frame, hub)) in angles.into_iter().enumerate() {
        let joint = |radius: &str, angle: i32, height: &str| {
            format!("[\"{radius} * cos({angle})\", \"{radius} * sin({angle})\", \"{height}\"]")
        };
        line("", "");
        line("[[leg]]", "");
        line(&format!("name     = \"J{leg}\""), "its drive, as the control calls it");
        let from = joint("frame", frame, "gauge + joint + rise");
        line(&format!("from     = {from}"), "its joint in the frame");
        line("at       = \"A\"", "the platform");
        let to = joint("hub", hub, "gauge + joint");
        line(&format!("to       = {to}"), "its joint there, all axes at zero");
        line("travel   = [\"rise - 50\", \"rise + 900\"]", "its length, joint to joint, mm");
        line("max_feed = 15000", "mm/min");
    }
}

/// The spindle of a lathe that turns.
fn work_spindle(line: &mut impl FnMut(&str, &str)) {
    line("", "");
    line("[spindle]", "");
    line("max_speed     = 4000", "rpm: what the spindle can do");
    line("surface_speed = true", "it turns the part: SPINDL/SMM is G96, FEDRAT/MMPR is G95");
}

/// The control: its dialect, and what that must be told.
fn control(line: &mut impl FnMut(&str, &str), choices: &Choices) {
    line("", "");
    line("[control]", "");
    line(&format!("dialect = \"{}\"", choices.dialect), "");
    if choices.class.has_arm() {
        line(
            "tcp     = \"post\"",
            "axis positions: an arm has no X, Y and Z that a control could keep",
        );
        line("leave   = { along = \"tool\", distance = 30 }", "how the tool leaves the part");
    } else if choices.class.turns() {
        line(
            &format!("tcp     = \"{}\"", choices.tcp.name()),
            "\"post\": axis positions; \"control\": the tip (G43.4, M128, …)",
        );
    }
    let no_positions = choices.control.no_positions;
    if choices.class == Class::LatheXzc && !no_positions {
        line("park    = { C = 0 }", "turned back off the part, at the end");
    }
    if choices.units == OutputUnits::Inch {
        line("units   = \"inch\"", "of the NC program; this file stays in mm");
    }
    if choices.class.linear().contains(&"Z")
        && let Some((below, remark)) = stands_clear(choices)
        && let Some([_, top]) = z_travel(choices)
    {
        line(&format!("retract = {{ Z = {} }}", top - below), remark);
    }
    if no_positions {
        line("retract = {}", "nothing retracts: there are no machine coordinates");
        line("change  = {}", "and nothing goes to where a tool is changed");
    }
    let options = options(choices);
    let spindle_by = choices.control.spindle_by.as_ref();
    if !options.is_empty() || spindle_by.is_some() {
        line("", "");
        line(&format!("[control.{}]", choices.dialect), "");
        if let Some(option) = spindle_by {
            let remark = "the spindle's words are those of the build, or macros: compare";
            line(&format!("{option} = true"), remark);
        }
        for (said, remark) in options {
            line(said, remark);
        }
    }
}

/// What a dialect must be told of its control, and why: without it no program is written.
fn options(choices: &Choices) -> Vec<(&'static str, &'static str)> {
    match choices.dialect.as_str() {
        "okuma" => {
            let units = match choices.units {
                OutputUnits::Mm => "unit_system = \"1 mm\"",
                OutputUnits::Inch => "unit_system = \"1 inch\"",
            };
            vec![(units, "a parameter of the control: compare, a point does not override it")]
        }
        "brother" => {
            let units = match choices.units {
                OutputUnits::Mm => "unit_system = \"mm\"",
                OutputUnits::Inch => "unit_system = \"inch\"",
            };
            vec![(units, "a setting of the control: compare, no word of a program chooses it")]
        }
        "isg" if choices.units == OutputUnits::Inch => {
            vec![("inch_feeds = true", "compare at the machine: F counts inches under G70")]
        }
        "grbl" if choices.class.turns() => {
            vec![("hal = true", "grblHAL: GRBL 1.1 has X, Y and Z alone")]
        }
        _ => Vec::new(),
    }
}

/// How far below the end of its travel Z is taken to stand clear, mm, on a control whose machine coordinates do not end where
/// the axis does; and why it must be looked at.
fn stands_clear(choices: &Choices) -> Option<(f64, &'static str)> {
    match choices.dialect.as_str() {
        "okuma" => {
            Some((0.0, "where Z stands clear, from the zero of G16 H0: read it off the machine"))
        }
        "grbl" => {
            Some((2.0, "Z at its end is on the homing switch: minus the pull-off ($27), or lower"))
        }
        _ => None,
    }
}

fn z_travel(choices: &Choices) -> Option<[f64; 2]> {
    given(&choices.travel, "Z").or_else(|| choices.class.usual_travel("Z", choices.gauge))
}

fn travel(line: &mut impl FnMut(&str, &str), choices: &Choices, axis: &str) {
    let endless = choices.cyclic.iter().any(|name| name == axis);
    let travel = match given(&choices.travel, axis) {
        Some(travel) => Some(travel),
        None if endless => None,
        None => choices.class.usual_travel(axis, choices.gauge),
    };
    if let Some([least, most]) = travel {
        let shown = match choices.class.is_lathe() && axis == "X" {
            true => "between the limit switches; half of the diameters that the control shows",
            false => "between the limit switches, as the control shows it",
        };
        line(&format!("travel   = [{least}, {most}]"), shown);
    }
    if travel.is_none() || endless {
        line("cyclic   = true", "turns without end; else travel = [-360, 360]");
    }
}

fn reversed(line: &mut impl FnMut(&str, &str), choices: &Choices, axis: &str) {
    if choices.reversed.iter().any(|name| name == axis) {
        line("reversed = true", "counts against ISO 841");
    }
}

fn feed(choices: &Choices, axis: &str, usual: f64) -> f64 {
    given(&choices.max_feed, axis).unwrap_or(usual)
}

/// The last that was given.
pub(super) fn given<T: Copy>(all: &[AxisSetting<T>], axis: &str) -> Option<T> {
    all.iter().rev().find(|given| given.axis == axis).map(|given| given.value)
}
