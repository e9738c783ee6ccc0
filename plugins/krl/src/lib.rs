//! KRL of KUKA's robots: `LIN`, which leads the tool straight to a pose, and `PTP`, which leads the joints to their values
//! off the part. A joint move has no time: cuts are led straight.
//!
//! What it assumes about the control stands in `docs/src/machine-builder/robots.md`.

use post_plugin::{
    ARM_JOINTS, ArmLanguage, ArmWords, Capabilities, Dialect, Event, Feed, Format, Meaning,
    OptionKind, OptionSpec, Setup, ToolPose, Value, VocabularyWord, export_dialect,
    fixed_text as number, identifier,
};

/// Characters of a name.
const NAME: usize = 24;

struct Krl {
    axes: ArmWords,
    program: String,
    tool: i64,
    optional_stop: String,
    /// What stands behind a straight move that does not come to its end.
    approximate: String,
    /// Where the tool is led straight next, mm and degrees.
    pose: Option<String>,
    /// Where the tool stands; none where nobody knows.
    at: Option<ToolPose>,
    /// The velocity of the tip that is in force, as printed.
    velocity: String,
}

const OPTIONS: &[OptionSpec] = &[
    ArmWords::DECIMALS,
    ArmWords::LINEAR_DECIMALS,
    OptionSpec::integer("tool", (1, 128), 1, "Number of the tool's frame, of `TOOL_DATA[ ]`."),
    ArmWords::orientation(&["abc-zyx"]),
    // Any other leaves the path, and no certificate would hold.
    OptionSpec {
        key: "approximate",
        kind: OptionKind::Choice(&["", "C_DIS", "C_VEL", "C_ORI"]),
        default: Value::Text(""),
        help: "By what every cut goes over into the next ($APO); what another than none leaves of the path is not certified.",
    },
    OptionSpec::lines("optional_stop", "OPTIONAL_STOP()", "Lines of an optional stop."),
];

/// What the names of its programs mean.
const WORDS: &[(&str, Meaning)] = &[
    ("DEF", Meaning::Nothing),
    ("END", Meaning::End),
    ("BAS", Meaning::ToolAndFrame),
    ("$BASE", Meaning::WorkOffset),
    ("$NULLFRAME", Meaning::WorkOffsetOff),
    ("$TOOL", Meaning::ToolFrame),
    ("$VEL.CP", Meaning::Feed),
    ("$ACC.CP", Meaning::Nothing),
    ("$ADVANCE", Meaning::Nothing),
    ("PTP", Meaning::JointMove),
    ("LIN", Meaning::StraightMove),
    ("CIRC", Meaning::PoseMove),
    ("WAIT", Meaning::Dwell),
    ("HALT", Meaning::Stop),
];

/// How its programs write what stands between moves.
const LANGUAGE: ArmLanguage = ArmLanguage {
    indent: "",
    remark: ";",
    call: ["(", ")", "()"],
    kind: "programs",
    spindle_on: ["SPINDLE_CW", "SPINDLE_CCW"],
    spindle_orient: "SPINDLE_ORIENT",
    spindle_off: "SPINDLE_OFF",
    coolant_on: "COOLANT_ON",
    coolant_off: "COOLANT_OFF",
    optional_stop: "OPTIONAL_STOP",
    tool_change: "CHANGE_TOOL",
};

impl Dialect for Krl {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        Ok(Krl {
            axes: ArmWords::new(setup)?,
            program: identifier(setup.program, NAME),
            tool: setup.integer("tool"),
            optional_stop: setup.text("optional_stop").to_owned(),
            approximate: setup.text("approximate").to_owned(),
            pose: None,
            at: None,
            velocity: String::new(),
        })
    }

    fn format(&self) -> Format {
        self.axes.format(6, "src")
    }

    fn capabilities(&self) -> Capabilities {
        ArmWords::CAPABILITIES
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        let tool = format!("TOOL_DATA[{}]", self.tool).into();
        let tool = VocabularyWord { word: tool, meaning: Meaning::OwnToolFrame };
        let mut words = LANGUAGE.vocabulary(WORDS, &self.optional_stop);
        words.push(tool);
        words
    }

    fn relies_on(&self) -> Vec<String> {
        let tool = self.tool;
        let mut relies = vec![
            format!("TOOL_DATA[{tool}] has its origin in the tip, its Z from the spindle to the tip, its X along that of the machine file's frame where all axes are at zero (along its Y where the tool lies along X there); that frame is the robot's ($NULLFRAME)"),
            "LIN leads the tool straight and turns it evenly about one direction, PTP leads all axes so that they arrive together".to_owned(),
            LANGUAGE.relies_on(),
        ];
        if !self.approximate.is_empty() {
            relies.push(format!(
                "what {} leaves of the path is allowed: it is not certified",
                self.approximate
            ));
        }
        relies
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        if LANGUAGE.write(event, out) {
            return Ok(());
        }
        if let Some((words, axes)) = self.axes.some_of(event) {
            self.joints(words, axes, None, out);
            return Ok(());
        }
        match *event {
            Event::Start => self.begin(out),
            Event::Position { words, feed: None, tool, .. } | Event::Rapid { words, tool } => {
                self.joints(words, u32::MAX, tool, out);
            }
            Event::Pose { origin, angles, .. } => {
                let [x, y, z] = origin.map(|value| number(value, 4));
                let [a, b, c] = angles.map(|value| number(value, 6));
                self.pose = Some(format!("X {x},Y {y},Z {z},A {a},B {b},C {c}"));
            }
            Event::Linear { words, feed, tool, .. } => self.straight(words, feed, tool, out)?,
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

/// A way of the tip, mm, that may be made of the rounded values of the joints alone: no velocity comes of it.
const STANDING: f64 = 1e-2;

/// Where a point so far up the tool, mm, goes farther than the tip, the tool turns about its tip.
const LEVER: f64 = 10.0;

const NO_TIME: &str = "KRL has no feed of a joint move: [control] moves = \"straight\" leads cuts by LIN, and rapid = \"rapid\" all others by PTP";

fn line(text: &str, out: &mut String) {
    LANGUAGE.line(text, out);
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

    /// Leads `axes`, a bit by word, to their words; the others stay where they are.
    fn joints(&mut self, words: &[f64], axes: u32, tool: Option<ToolPose>, out: &mut String) {
        let own = self.axes.words();
        let values = own.iter().enumerate().filter_map(|(place, word)| {
            let word = word.filter(|word| axes >> word & 1 == 1 && *word < words.len())?;
            Some(format!("{} {}", axis(place), self.axes.value(word, words)))
        });
        let values: Vec<String> = values.collect();
        if values.is_empty() {
            return;
        }
        line(&format!("PTP {{{}}}", values.join(",")), out);
        self.at = tool;
    }

    /// Leads the tool straight to its pose, and evenly what stands beside the arm.
    fn straight(
        &mut self,
        words: &[f64],
        feed: Feed,
        tool: Option<ToolPose>,
        out: &mut String,
    ) -> Result<(), String> {
        let pose = self.pose.take().ok_or(NO_TIME)?;
        let (Some(to), Some(from)) = (tool, self.at) else {
            return Err(
                "where the tool stands is not known, and LIN asks for its velocity".to_owned()
            );
        };
        let apart = |to: [f64; 3], from: [f64; 3]| {
            let square: f64 = to.iter().zip(from).map(|(to, from)| (to - from) * (to - from)).sum();
            square.sqrt()
        };
        let way = apart(to.tip, from.tip);
        let velocity = match feed {
            // m/s of the tip, mm/min divided by 60,000.
            Feed::PerMinute(feed) => feed / 60_000.0,
            Feed::InverseTime(feed) => way * feed / 60_000.0,
            other => return Err(format!("a robot has no feed like {other}")),
        };
        let velocity = number(velocity, 6);
        let none = velocity.bytes().all(|digit| matches!(digit, b'0' | b'.'));
        let turns = way < STANDING && LEVER * apart(to.axis, from.axis) > way;
        if none || turns && matches!(feed, Feed::InverseTime(_)) {
            return Err("the tool turns about its tip, which the velocity of a tip does not tell: the CL file needs a way of the tip there".to_owned());
        }
        if velocity != self.velocity {
            line(&format!("$VEL.CP={velocity}"), out);
            self.velocity = velocity;
        }
        let own = self.axes.words().into_iter().enumerate().skip(ARM_JOINTS);
        let beside = own.filter_map(|(place, word)| Some((place, word?)));
        let beside: String = beside
            .map(|(place, word)| format!(",{} {}", axis(place), self.axes.value(word, words)))
            .collect();
        let leaves = if self.approximate.is_empty() { "" } else { " " };
        line(&format!("LIN {{{pose}{beside}}}{leaves}{}", self.approximate), out);
        self.at = Some(to);
        Ok(())
    }
}

export_dialect!(krl, Krl);
