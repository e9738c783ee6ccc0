//! KRL of KUKA's robots: `LIN`, which leads the tool straight to a pose, and `PTP`, which leads the joints to their values
//! off the part. A joint move has no time: cuts are led straight.
//!
//! What it assumes about the control stands in `docs/src/machine-builder/robots.md`.

use post_plugin::{
    ARM_JOINTS, ArmWords, Capabilities, Coolant, Dialect, Event, Feed, Format, Language, Meaning,
    OptionSpec, Setup, Spindle, SpindleSense, ToolPose, Units, VocabularyWord, ascii,
    export_dialect, fixed, identifier,
};

/// Characters of a name.
const NAME: usize = 24;

struct Krl {
    axes: ArmWords,
    decimals: Vec<u8>,
    rotary: Vec<bool>,
    program: String,
    tool: i64,
    optional_stop: String,
    /// Where the tool is led straight next, mm and degrees.
    pose: Option<String>,
    /// Where the tip stands, mm; none where nobody knows.
    tip: Option<[f64; 3]>,
    /// The velocity of the tip that is in force, as printed.
    velocity: String,
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::integer(
        "decimals",
        (0, 6),
        4,
        "Decimals of the values of axes that turn, degrees.",
    ),
    OptionSpec::integer("linear_decimals", (0, 6), 3, "Decimals of those that slide, mm."),
    OptionSpec::integer("tool", (1, 128), 1, "Number of the tool's frame, of `TOOL_DATA[ ]`."),
    OptionSpec::lines("optional_stop", "OPTIONAL_STOP()", "Lines of an optional stop."),
];

/// What the names of its programs mean.
const WORDS: &[(&str, Meaning)] = &[
    (";", Meaning::Remark),
    ("DEF", Meaning::Nothing),
    ("END", Meaning::End),
    ("BAS", Meaning::Nothing),
    ("$BASE", Meaning::WorkOffset),
    ("$NULLFRAME", Meaning::WorkOffsetOff),
    ("$TOOL", Meaning::Nothing),
    ("$VEL.CP", Meaning::Feed),
    ("$ACC.CP", Meaning::Nothing),
    ("$ADVANCE", Meaning::Nothing),
    ("PTP", Meaning::JointMove),
    ("LIN", Meaning::PoseMove),
    ("CIRC", Meaning::PoseMove),
    ("WAIT", Meaning::Dwell),
    ("HALT", Meaning::Stop),
    ("CHANGE_TOOL", Meaning::ToolChange),
    ("SPINDLE_CW", Meaning::SpindleClockwise),
    ("SPINDLE_CCW", Meaning::SpindleCounterClockwise),
    ("SPINDLE_OFF", Meaning::SpindleOff),
    ("SPINDLE_ORIENT", Meaning::SpindleOrient),
    ("COOLANT_ON", Meaning::CoolantOn),
    ("COOLANT_OFF", Meaning::CoolantOff),
];

impl Dialect for Krl {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        if setup.tcp {
            return Err(
                "poses of its tool come from the values of the axes: tcp = \"post\"".to_owned()
            );
        }
        if setup.units != Units::Millimetre {
            return Err("KRL counts in millimetres: units = \"mm\"".to_owned());
        }
        let decimals =
            |rotary: bool| setup.integer(if rotary { "decimals" } else { "linear_decimals" }) as u8;
        Ok(Krl {
            axes: ArmWords::new(setup)?,
            decimals: setup.words.iter().map(|word| decimals(word.rotary)).collect(),
            rotary: setup.words.iter().map(|word| word.rotary).collect(),
            program: identifier(setup.program, NAME),
            tool: setup.integer("tool"),
            optional_stop: setup.text("optional_stop").to_owned(),
            pose: None,
            tip: None,
            velocity: String::new(),
        })
    }

    fn format(&self) -> Format {
        Format {
            words: self.decimals.clone(),
            feed: 2,
            inverse_time: Some(6),
            feed_per_revolution: 3,
            extension: "src".to_owned(),
            language: Language::Joints,
            ..Format::default()
        }
    }

    /// No length is compensated by the control: values of axes are those with the tool that the program is for.
    fn capabilities(&self) -> Capabilities {
        Capabilities::TOOL_TABLE | Capabilities::LENGTH_IN_OFFSET | Capabilities::POSES
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        let known = WORDS.iter().map(|(word, meaning)| VocabularyWord::new(word, *meaning));
        known.chain(VocabularyWord::first_of(&self.optional_stop, Meaning::OptionalStop)).collect()
    }

    fn relies_on(&self) -> Vec<String> {
        let tool = self.tool;
        vec![
            format!("TOOL_DATA[{tool}] has its origin in the tip, its Z from the spindle to the tip, its X along that of the machine file's frame where all axes are at zero; that frame is the robot's ($NULLFRAME)"),
            "LIN leads the tool straight and turns it evenly about one direction, PTP leads all axes so that they arrive together".to_owned(),
            "the programs SPINDLE_CW, SPINDLE_CCW, SPINDLE_ORIENT, SPINDLE_OFF, COOLANT_ON, COOLANT_OFF, OPTIONAL_STOP and CHANGE_TOOL are on the control, where the program calls them".to_owned(),
        ]
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match *event {
            Event::Start => self.begin(out),
            Event::Comment { text } => line(&format!("; {}", ascii(text)), out),
            Event::Literal { text } | Event::Word { text } => line(text, out),
            Event::ToolChange { number, .. } => line(&format!("CHANGE_TOOL({number})"), out),
            Event::Spindle(spindle) => turn(spindle, out),
            Event::Coolant(Coolant::Off) => line("COOLANT_OFF()", out),
            Event::Coolant(coolant) => line(&format!("COOLANT_ON(\"{coolant:?}\")"), out),
            Event::Turn { words } => self.joints(words, |krl, word| krl.rotary[word], None, out),
            Event::Retract { axes, words } | Event::Park { axes, words } => {
                self.joints(words, |_, word| axes & (1 << word) != 0, None, out);
            }
            Event::Position { words, feed: None, tool, .. } | Event::Rapid { words, tool } => {
                self.joints(words, |_, _| true, tool, out);
            }
            Event::Pose { origin, angles, .. } => {
                let [x, y, z] = origin.map(|value| number(value, 4));
                let [a, b, c] = angles.map(|value| number(value, 6));
                self.pose = Some(format!("{{X {x},Y {y},Z {z},A {a},B {b},C {c}}}"));
            }
            Event::Linear { feed, tool, .. } => self.straight(feed, tool, out)?,
            Event::Position { .. } => return Err(NO_TIME.to_owned()),
            Event::Dwell { seconds } => line(&format!("WAIT SEC {}", number(seconds, 3)), out),
            Event::Stop => line("HALT", out),
            Event::OptionalStop => line(&self.optional_stop, out),
            Event::End => line("END", out),
            other => return Err(other.refusal()),
        }
        Ok(())
    }
}

const NO_TIME: &str = "KRL has no feed of a joint move: [control] moves = \"straight\" leads cuts by LIN, and rapid = \"rapid\" all others by PTP";

fn line(text: &str, out: &mut String) {
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
        Spindle::Off => "SPINDLE_OFF()".to_owned(),
        Spindle::On { rpm, sense: SpindleSense::Clockwise } => {
            format!("SPINDLE_CW({})", number(rpm, 0))
        }
        Spindle::On { rpm, sense: SpindleSense::CounterClockwise } => {
            format!("SPINDLE_CCW({})", number(rpm, 0))
        }
        Spindle::Orient => "SPINDLE_ORIENT()".to_owned(),
    };
    line(&text, out);
}

/// The name of an axis of the control.
fn axis(place: usize) -> String {
    match place.checked_sub(ARM_JOINTS) {
        None => format!("A{}", place + 1),
        Some(beside) => format!("E{}", beside + 1),
    }
}

impl Krl {
    fn begin(&self, out: &mut String) {
        line("&ACCESS RVP", out);
        line("&REL 1", out);
        line(&format!("DEF {}()", self.program), out);
        line("BAS(#INITMOV,0)", out);
        line("$BASE=$NULLFRAME", out);
        line(&format!("$TOOL=TOOL_DATA[{}]", self.tool), out);
    }

    /// Leads some axes to their words; the others stay where they are.
    fn joints(
        &mut self,
        words: &[f64],
        which: impl Fn(&Self, usize) -> bool,
        tool: Option<ToolPose>,
        out: &mut String,
    ) {
        let own = self.axes.words();
        let values = own.iter().enumerate().filter_map(|(place, word)| {
            let word = word.filter(|word| which(self, *word))?;
            let value = number(*words.get(word)?, self.decimals[word]);
            Some(format!("{} {value}", axis(place)))
        });
        let values: Vec<String> = values.collect();
        if values.is_empty() {
            return;
        }
        line(&format!("PTP {{{}}}", values.join(",")), out);
        self.tip = tool.map(|tool| tool.tip);
    }

    /// Leads the tool straight to its pose.
    fn straight(
        &mut self,
        feed: Feed,
        tool: Option<ToolPose>,
        out: &mut String,
    ) -> Result<(), String> {
        let pose = self.pose.take().ok_or(NO_TIME)?;
        let (Some(to), Some(from)) = (tool.map(|tool| tool.tip), self.tip) else {
            return Err(
                "where the tool stands is not known, and LIN asks for its velocity".to_owned()
            );
        };
        let square: f64 = to.iter().zip(from).map(|(to, from)| (to - from) * (to - from)).sum();
        let velocity = match feed {
            // m/s of the tip, mm/min divided by 60,000.
            Feed::PerMinute(feed) => feed / 60_000.0,
            Feed::InverseTime(feed) => square.sqrt() * feed / 60_000.0,
            other => return Err(format!("a robot has no feed like {other}")),
        };
        let velocity = number(velocity, 6);
        if velocity.bytes().all(|digit| matches!(digit, b'0' | b'.')) {
            return Err("the tool turns about its tip, which the velocity of a tip does not tell: the CL file needs a way of the tip there".to_owned());
        }
        if velocity != self.velocity {
            line(&format!("$VEL.CP={velocity}"), out);
            self.velocity = velocity;
        }
        line(&format!("LIN {pose}"), out);
        self.tip = Some(to);
        Ok(())
    }
}

export_dialect!(krl, Krl);
