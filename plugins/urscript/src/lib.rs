//! URScript of Universal Robots: `movej`, which leads all joints evenly in time to their values, and `movel`, which leads
//! the tool straight to a pose.
//!
//! What it assumes about the control stands in `docs/src/machine-builder/robots.md`.

use post_plugin::{
    ARM_JOINTS, ArmWords, Capabilities, Coolant, Dialect, Event, Feed, Format, Language, Meaning,
    OptionSpec, Setup, Spindle, SpindleSense, Units, VocabularyWord, ascii, export_dialect, fixed,
    identifier,
};

/// Decimals of a time in seconds: enough that feeds which differ differ.
const TIME_DECIMALS: u8 = 9;

/// Characters of a name.
const NAME: usize = 30;

struct UrScript {
    axes: ArmWords,
    decimals: u8,
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
    OptionSpec::lines("optional_stop", "optional_stop()", "Lines of an optional stop."),
];

/// What the names of its programs mean.
const WORDS: &[(&str, Meaning)] = &[
    ("#", Meaning::Remark),
    ("def", Meaning::Nothing),
    ("end", Meaning::End),
    ("movej", Meaning::JointMove),
    ("movel", Meaning::PoseMove),
    ("movep", Meaning::PoseMove),
    ("movec", Meaning::PoseMove),
    ("get_actual_joint_positions", Meaning::JointsNow),
    ("textmsg", Meaning::Nothing),
    ("set_payload", Meaning::Nothing),
    ("set_tcp", Meaning::Nothing),
    ("sleep", Meaning::Dwell),
    ("popup", Meaning::Stop),
    ("change_tool", Meaning::ToolChange),
    ("spindle_cw", Meaning::SpindleClockwise),
    ("spindle_ccw", Meaning::SpindleCounterClockwise),
    ("spindle_off", Meaning::SpindleOff),
    ("spindle_orient", Meaning::SpindleOrient),
    ("coolant_on", Meaning::CoolantOn),
    ("coolant_off", Meaning::CoolantOff),
];

impl Dialect for UrScript {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        if setup.tcp {
            return Err(
                "it writes the values of the joints (movej), not movel: tcp = \"post\"".to_owned()
            );
        }
        if setup.units != Units::Millimetre {
            return Err("URScript counts in metres and radians: units = \"mm\"".to_owned());
        }
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
            decimals: setup.integer("decimals") as u8,
            acceleration: setup.number("acceleration"),
            velocity: setup.number("velocity"),
            blend: setup.number("blend"),
            program: identifier(setup.program, NAME),
            optional_stop: setup.text("optional_stop").to_owned(),
            pose: None,
        })
    }

    fn format(&self) -> Format {
        Format {
            words: vec![self.decimals; ARM_JOINTS],
            feed: 2,
            inverse_time: Some(3),
            feed_per_revolution: 3,
            extension: "script".to_owned(),
            language: Language::Joints,
            ..Format::default()
        }
    }

    /// No length is compensated by the control: values of joints are those with the tool that the program is for.
    fn capabilities(&self) -> Capabilities {
        Capabilities::TOOL_TABLE | Capabilities::LENGTH_IN_OFFSET | Capabilities::POSES
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        let known = WORDS.iter().map(|(word, meaning)| VocabularyWord::new(word, *meaning));
        known.chain(VocabularyWord::first_of(&self.optional_stop, Meaning::OptionalStop)).collect()
    }

    fn relies_on(&self) -> Vec<String> {
        let mut relies = vec![
            "where movel is written it leads the tool straight and turns it evenly about one direction; the tool centre point of the installation is the tip, its Z from the spindle to the tip, its X along that of the machine file's frame where all joints are at zero; the base is the machine file's frame".to_owned(),
            "movej leads all joints evenly in time, so that they arrive together, and t is the time of the whole move".to_owned(),
            "the functions spindle_cw, spindle_ccw, spindle_orient, spindle_off, coolant_on, coolant_off, optional_stop and change_tool are on the control, where the program calls them".to_owned(),
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
        match *event {
            Event::Start => {
                out.push_str(&format!("def {}():\n", self.program));
                return Ok(());
            }
            Event::End => {
                out.push_str("end\n");
                return Ok(());
            }
            Event::Comment { text } => line(&format!("# {}", ascii(text)), out),
            Event::Literal { text } | Event::Word { text } => line(text, out),
            Event::ToolChange { number, .. } => line(&format!("change_tool({number})"), out),
            Event::Spindle(spindle) => turn(spindle, out),
            Event::Coolant(Coolant::Off) => line("coolant_off()", out),
            Event::Coolant(coolant) => line(&format!("coolant_on(\"{coolant:?}\")"), out),
            Event::Turn { words } => self.some(words, |_| true, out),
            Event::Retract { axes, words } | Event::Park { axes, words } => {
                self.some(words, |word| axes & (1 << word) != 0, out);
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
    out.push_str("  ");
    out.push_str(text);
    out.push('\n');
}

fn number(value: f64, decimals: u8) -> String {
    let mut text = String::new();
    fixed(&mut text, value, decimals);
    text
}

fn turn(spindle: Spindle, out: &mut String) {
    let text = match spindle {
        Spindle::Off => "spindle_off()".to_owned(),
        Spindle::On { rpm, sense: SpindleSense::Clockwise } => {
            format!("spindle_cw({})", number(rpm, 0))
        }
        Spindle::On { rpm, sense: SpindleSense::CounterClockwise } => {
            format!("spindle_ccw({})", number(rpm, 0))
        }
        Spindle::Orient => "spindle_orient()".to_owned(),
    };
    line(&text, out);
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

    fn degrees(&self, value: f64) -> String {
        format!("d2r({})", number(value, self.decimals))
    }

    /// Leads some joints to their words at rapid; the others stay where they are.
    fn some(&self, words: &[f64], which: impl Fn(usize) -> bool, out: &mut String) {
        line("here = get_actual_joint_positions()", out);
        for (word, value) in words.iter().enumerate().filter(|(word, _)| which(*word)) {
            line(&format!("here[{}] = {}", self.axes.place(word), self.degrees(*value)), out);
        }
        line(&format!("movej(here, {}, r=0)", self.fast()), out);
    }

    /// Leads all joints to their words.
    fn all(&self, words: &[f64], pace: &str, blend: f64, out: &mut String) {
        let own = self.axes.words();
        let joints = own.iter().flatten().filter_map(|word| words.get(*word));
        let joints: Vec<String> = joints.map(|value| self.degrees(*value)).collect();
        let blend = if blend == 0.0 { "0".to_owned() } else { number(blend, 4) };
        line(&format!("movej([{}], {pace}, r={blend})", joints.join(", ")), out);
    }
}

export_dialect!(urscript, UrScript);
