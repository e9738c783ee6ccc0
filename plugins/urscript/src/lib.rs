//! URScript of Universal Robots: `movej`, which leads all joints evenly in time to their values, and `movel`, which leads
//! the tool straight to a pose.
//!
//! What it assumes about the control stands in `docs/src/machine-builder/robots.md`.

use post_plugin::{
    ARM_JOINTS, ArmLanguage, ArmWords, Capabilities, Dialect, Event, Feed, Format, Meaning,
    OptionSpec, Setup, VocabularyWord, export_dialect, fixed_text as number, identifier,
};

/// Decimals of a time in seconds: enough that feeds which differ differ.
const TIME_DECIMALS: u8 = 9;

/// Characters of a name.
const NAME: usize = 30;

struct UrScript {
    axes: ArmWords,
    acceleration: f64,
    velocity: f64,
    blend: f64,
    program: String,
    optional_stop: String,
    /// Where the tool is led straight next, m and radians.
    pose: Option<String>,
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::integer("decimals", (0, 6), 4, "Decimals of the values of joints, degrees."),
    OptionSpec::number(
        "acceleration",
        (0.01, 100.0),
        1.4,
        "Acceleration of the leading joint at rapid, rad/s².",
    ),
    OptionSpec::number(
        "velocity",
        (0.001, 100.0),
        1.05,
        "Velocity of the leading joint at rapid, rad/s.",
    ),
    // Any other radius leaves the path, and no certificate would hold.
    OptionSpec::number(
        "blend",
        (0.0, 1.0),
        0.0,
        "Blend radius of every cut, m; what another than 0 leaves of the path is not certified.",
    ),
    ArmWords::orientation(&["rotation-vector"]),
    OptionSpec::lines("optional_stop", "optional_stop()", "Lines of an optional stop."),
];

/// What the names of its programs mean.
const WORDS: &[(&str, Meaning)] = &[
    ("def", Meaning::Nothing),
    ("end", Meaning::End),
    ("movej", Meaning::JointMove),
    ("movel", Meaning::StraightMove),
    ("movep", Meaning::PoseMove),
    ("movec", Meaning::PoseMove),
    ("get_actual_joint_positions", Meaning::JointsNow),
    ("textmsg", Meaning::Nothing),
    ("set_payload", Meaning::Nothing),
    ("set_tcp", Meaning::ToolFrame),
    ("sleep", Meaning::Dwell),
    ("popup", Meaning::Stop),
];

/// How its programs write what stands between moves.
const LANGUAGE: ArmLanguage = ArmLanguage {
    indent: "  ",
    remark: "#",
    call: ["(", ")", "()"],
    kind: "functions",
    spindle_on: ["spindle_cw", "spindle_ccw"],
    spindle_orient: "spindle_orient",
    spindle_off: "spindle_off",
    coolant_on: "coolant_on",
    coolant_off: "coolant_off",
    optional_stop: "optional_stop",
    tool_change: "change_tool",
};

impl Dialect for UrScript {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let axes = ArmWords::new(setup)?;
        for (word, axis) in setup.words.iter().enumerate() {
            if axes.place(word) >= ARM_JOINTS {
                let name = axis.name;
                return Err(format!("axis {name}: movej leads the six joints of the arm alone"));
            }
        }
        if let Some(missing) = axes.words()[..ARM_JOINTS].iter().position(Option::is_none) {
            let joint = missing + 1;
            return Err(format!(
                "movej leads all six joints, and the machine has none of the name of joint {joint}"
            ));
        }
        Ok(UrScript {
            axes,
            acceleration: setup.number("acceleration"),
            velocity: setup.number("velocity"),
            blend: setup.number("blend"),
            program: identifier(setup.program, NAME),
            optional_stop: setup.text("optional_stop").to_owned(),
            pose: None,
        })
    }

    fn format(&self) -> Format {
        self.axes.format(3, "script")
    }

    fn capabilities(&self) -> Capabilities {
        ArmWords::CAPABILITIES
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        LANGUAGE.vocabulary(WORDS, &self.optional_stop)
    }

    fn relies_on(&self) -> Vec<String> {
        let mut relies = vec![
            "where movel is written it leads the tool straight and turns it evenly about one direction; the tool centre point of the installation is the tip, its Z from the spindle to the tip, its X along that of the machine file's frame where all joints are at zero; the base is the machine file's frame".to_owned(),
            "movej leads all joints evenly in time, so that they arrive together, and t is the time of the whole move".to_owned(),
            LANGUAGE.relies_on(),
        ];
        if self.blend != 0.0 {
            relies.push(format!(
                "what the blend radius of {} m leaves of the path is allowed: it is not certified",
                self.blend
            ));
        }
        relies
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        if LANGUAGE.write(event, out) {
            return Ok(());
        }
        if let Some((words, axes)) = self.axes.some_of(event) {
            self.some(words, axes, out);
            return Ok(());
        }
        match *event {
            Event::Start => {
                out.push_str(&format!("def {}():\n", self.program));
                return Ok(());
            }
            Event::End => {
                out.push_str("end\n");
                return Ok(());
            }
            Event::Position { words, feed: None, .. } | Event::Rapid { words, .. } => {
                self.all(words, &self.fast(), 0.0, out);
            }
            Event::Position { words, feed: Some(feed), .. } => {
                self.all(words, &time(feed)?, 0.0, out);
            }
            Event::Pose { origin, rotation, .. } => {
                let metres = origin.map(|value| number(value / 1000.0, 7));
                let radians = rotation.map(|value| number(value, 8));
                self.pose = Some(format!("p[{}, {}]", metres.join(", "), radians.join(", ")));
            }
            Event::Linear { words, feed, .. } => match self.pose.take() {
                Some(pose) => {
                    let line_of = format!("movel({pose}, {}, r={})", time(feed)?, self.blended());
                    line(&line_of, out);
                }
                None => self.all(words, &time(feed)?, self.blend, out),
            },
            Event::Dwell { seconds } => line(&format!("sleep({})", number(seconds, 3)), out),
            Event::Stop => line("popup(\"Program stop\", blocking=True)", out),
            Event::OptionalStop => {
                self.optional_stop.lines().for_each(|stop| line(stop, out));
            }
            other => return Err(other.refusal()),
        }
        Ok(())
    }
}

/// A line inside the function.
fn line(text: &str, out: &mut String) {
    LANGUAGE.line(text, out);
}

/// The time of a whole move, s.
fn time(feed: Feed) -> Result<String, String> {
    match feed {
        Feed::InverseTime(feed) => Ok(format!("t={}", number(60.0 / feed, TIME_DECIMALS))),
        other => Err(format!("movej has the time of a move, and no feed like {other}")),
    }
}

impl UrScript {
    fn fast(&self) -> String {
        format!("a={}, v={}", number(self.acceleration, 3), number(self.velocity, 3))
    }

    fn blended(&self) -> String {
        if self.blend == 0.0 { "0".to_owned() } else { number(self.blend, 4) }
    }

    /// Leads `axes`, a bit by word, to their words at rapid; the others stay where they are.
    fn some(&self, words: &[f64], axes: u32, out: &mut String) {
        line("here = get_actual_joint_positions()", out);
        for word in (0..words.len()).filter(|word| axes >> word & 1 == 1) {
            let (place, value) = (self.axes.place(word), self.axes.value(word, words));
            line(&format!("here[{place}] = d2r({value})"), out);
        }
        line(&format!("movej(here, {}, r=0)", self.fast()), out);
    }

    /// Leads all joints to their words.
    fn all(&self, words: &[f64], pace: &str, blend: f64, out: &mut String) {
        let own = self.axes.words();
        let joints = own.iter().flatten();
        let joints = joints.map(|word| format!("d2r({})", self.axes.value(*word, words)));
        let joints: Vec<String> = joints.collect();
        let blend = if blend == 0.0 { "0".to_owned() } else { number(blend, 4) };
        line(&format!("movej([{}], {pace}, r={blend})", joints.join(", ")), out);
    }
}

export_dialect!(urscript, UrScript);
