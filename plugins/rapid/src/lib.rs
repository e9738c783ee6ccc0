//! RAPID of ABB's robots: `MoveAbsJ`, which leads all axes evenly in time to their values, and `MoveL`, which leads the
//! tool straight to a pose.
//!
//! What it assumes about the control stands in `docs/src/machine-builder/robots.md`.

use post_plugin::{
    ARM_AXES, ARM_JOINTS, ArmLanguage, ArmWords, Capabilities, Dialect, Event, Feed, Format,
    Meaning, OptionSpec, Setup, VocabularyWord, export_dialect, fixed_text as number, identifier,
};

/// Components of a `jointtarget`, in that order.
const COMPONENTS: [&str; ARM_AXES] = [
    "robax.rax_1",
    "robax.rax_2",
    "robax.rax_3",
    "robax.rax_4",
    "robax.rax_5",
    "robax.rax_6",
    "extax.eax_a",
    "extax.eax_b",
    "extax.eax_c",
    "extax.eax_d",
    "extax.eax_e",
    "extax.eax_f",
];

/// Decimals of a time in seconds, and of a velocity in mm/s: enough that feeds which differ differ.
const TIME_DECIMALS: u8 = 11;
const VELOCITY_DECIMALS: u8 = 5;

/// Characters of an identifier.
const NAME: usize = 24;

struct Rapid {
    axes: ArmWords,
    /// The words of depth axes, a bit each.
    depth: u32,
    program: String,
    zone: String,
    tool: String,
    optional_stop: String,
    /// Where the tool is led straight next, as a `robtarget` has it.
    pose: Option<String>,
    /// The control has been told to go on by whichever solution is nearest.
    follows: bool,
}

const OPTIONS: &[OptionSpec] = &[
    ArmWords::DECIMALS,
    ArmWords::LINEAR_DECIMALS,
    // Any other zone leaves the path, and no certificate would hold.
    OptionSpec::text(
        "zone",
        "fine",
        "Zone of every cut; what another than `fine` leaves of the path is not certified.",
    ),
    OptionSpec::text(
        "tool",
        "tool0",
        "Tool of every move (tooldata): `MoveAbsJ` takes load and velocity from it, `MoveL` its frame too.",
    ),
    ArmWords::orientation(&["quaternion"]),
    OptionSpec::lines("optional_stop", "OptionalStop;", "Lines of an optional stop."),
];

/// What the names of its programs mean.
const WORDS: &[(&str, Meaning)] = &[
    ("MODULE", Meaning::Nothing),
    ("VAR", Meaning::Nothing),
    ("PROC", Meaning::Nothing),
    ("ENDPROC", Meaning::End),
    ("MoveAbsJ", Meaning::JointMove),
    ("MoveJ", Meaning::PoseMove),
    ("MoveL", Meaning::StraightMove),
    ("MoveC", Meaning::PoseMove),
    ("CJointT", Meaning::JointsNow),
    ("ConfJ", Meaning::Nothing),
    // Watched, as after each start, the arm stops where it has another configuration than the pose says.
    ("ConfL", Meaning::NotFollowed),
    ("ConfL \\Off", Meaning::AnyConfiguration),
    ("TPWrite", Meaning::Nothing),
    ("WaitTime", Meaning::Dwell),
    ("wobj0", Meaning::WorkOffsetOff),
    ("Stop", Meaning::Stop),
];

/// How its programs write what stands between moves.
const LANGUAGE: ArmLanguage = ArmLanguage {
    indent: "",
    remark: "!",
    call: [" ", ";", ";"],
    kind: "procedures",
    spindle_on: ["SpindleCw", "SpindleCcw"],
    spindle_orient: "SpindleOrient",
    spindle_off: "SpindleOff",
    coolant_on: "CoolantOn",
    coolant_off: "CoolantOff",
    optional_stop: "OptionalStop",
    tool_change: "ChangeTool",
};

impl Dialect for Rapid {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let depth = setup.words.iter().enumerate();
        Ok(Rapid {
            axes: ArmWords::new(setup)?,
            depth: depth.fold(0, |mask, (word, axis)| mask | u32::from(axis.depth) << word),
            program: identifier(setup.program, NAME),
            zone: setup.text("zone").to_owned(),
            tool: setup.text("tool").to_owned(),
            optional_stop: setup.text("optional_stop").to_owned(),
            pose: None,
            follows: false,
        })
    }

    fn format(&self) -> Format {
        self.axes.format(3, "mod")
    }

    fn capabilities(&self) -> Capabilities {
        ArmWords::CAPABILITIES
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        let mut words = LANGUAGE.vocabulary(WORDS, &self.optional_stop);
        // `tool0` is the flange.
        if self.tool != "tool0" {
            words.push(VocabularyWord {
                word: self.tool.clone().into(),
                meaning: Meaning::OwnToolFrame,
            });
        }
        words
    }

    fn relies_on(&self) -> Vec<String> {
        let mut relies = vec![
            "where MoveL is written it leads the tool straight and turns it evenly about one direction; the frame of the tool has its origin in the tip, its Z from the spindle to the tip, its X along that of the machine file's frame where all axes are at zero (along its Y where the tool lies along X there); wobj0 is the machine file's frame".to_owned(),
            "MoveAbsJ leads all axes of the arm and beside it evenly in time, so that they arrive together, whatever tool and work object are".to_owned(),
            LANGUAGE.relies_on(),
        ];
        if self.zone != "fine" {
            relies.push(format!(
                "what the zone {} leaves of the path is allowed: it is not certified",
                self.zone
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
                line(&format!("MODULE M{}", self.program), out);
                line("VAR jointtarget here;", out);
                line(&format!("PROC {}()", self.program), out);
            }
            Event::Position { words, feed, plane_first, .. } => {
                if plane_first && self.depth != 0 {
                    self.some(words, !self.depth, out);
                }
                self.all(words, feed, "fine", out)?;
            }
            Event::Rapid { words, .. } => self.all(words, None, "fine", out)?,
            Event::Pose { origin, quaternion, .. } => self.lead(origin, quaternion, out)?,
            Event::Linear { words, feed, .. } => match self.pose.take() {
                Some(pose) => {
                    let target = format!("[{pose},[0,0,0,0],[{}]]", self.targets(words)[1]);
                    self.go("MoveL", &target, Some(feed), &self.zone, out)?;
                }
                None => self.all(words, Some(feed), &self.zone, out)?,
            },
            Event::Dwell { seconds } => line(&format!("WaitTime {};", number(seconds, 3)), out),
            Event::Stop => line("Stop;", out),
            Event::OptionalStop => line(&self.optional_stop, out),
            Event::End => {
                line("ENDPROC", out);
                line("ENDMODULE", out);
            }
            other => return Err(other.refusal()),
        }
        Ok(())
    }
}

fn line(text: &str, out: &mut String) {
    LANGUAGE.line(text, out);
}

impl Rapid {
    /// Leads `axes`, a bit by word, to their words at the largest velocity; the others stay where they are.
    fn some(&self, words: &[f64], axes: u32, out: &mut String) {
        line("here:=CJointT();", out);
        for word in (0..words.len()).filter(|word| axes >> word & 1 == 1) {
            let value = self.axes.value(word, words);
            line(&format!("here.{}:={value};", COMPONENTS[self.axes.place(word)]), out);
        }
        line(&format!("MoveAbsJ here,vmax,fine,{};", self.tool), out);
    }

    /// The tool is led straight by the next move.
    fn lead(
        &mut self,
        origin: [f64; 3],
        quaternion: [f64; 4],
        out: &mut String,
    ) -> Result<(), String> {
        if self.tool == "tool0" {
            return Err("MoveL leads the frame of a tool, and tool0 is none: name its tooldata, [control.rapid] tool".to_owned());
        }
        if !self.follows {
            // Whichever solution is nearest: the points stand close enough.
            line("ConfL \\Off;", out);
            self.follows = true;
        }
        let list = |numbers: &[f64], decimals| {
            let numbers: Vec<String> =
                numbers.iter().map(|value| number(*value, decimals)).collect();
            numbers.join(",")
        };
        self.pose = Some(format!("[{}],[{}]", list(&origin, 4), list(&quaternion, 8)));
        Ok(())
    }

    /// Values of the axes of the arm, and of those beside it.
    fn targets(&self, words: &[f64]) -> [String; 2] {
        let own = self.axes.words();
        let values: [String; ARM_AXES] = std::array::from_fn(|place| match own[place] {
            Some(word) => self.axes.value(word, words),
            None if place < ARM_JOINTS => "0".to_owned(),
            // An axis that is not there.
            None => "9E9".to_owned(),
        });
        let (arm, beside) = values.split_at(ARM_JOINTS);
        [arm.join(","), beside.join(",")]
    }

    /// Leads all axes to their words.
    fn all(
        &self,
        words: &[f64],
        feed: Option<Feed>,
        zone: &str,
        out: &mut String,
    ) -> Result<(), String> {
        let [arm, beside] = self.targets(words);
        self.go("MoveAbsJ", &format!("[[{arm}],[{beside}]]"), feed, zone, out)
    }

    /// A move to a target.
    fn go(
        &self,
        name: &str,
        target: &str,
        feed: Option<Feed>,
        zone: &str,
        out: &mut String,
    ) -> Result<(), String> {
        let pace = match feed {
            None => "vmax".to_owned(),
            // The velocity of the tool's point, mm/s.
            Some(Feed::PerMinute(feed)) => {
                format!("v1000\\V:={}", number(feed / 60.0, VELOCITY_DECIMALS))
            }
            // The time of the whole move, s.
            Some(Feed::InverseTime(feed)) => {
                format!("v1000\\T:={}", number(60.0 / feed, TIME_DECIMALS))
            }
            Some(other) => return Err(format!("a robot has no feed like {other}")),
        };
        line(&format!("{name} {target},{pace},{zone},{};", self.tool), out);
        Ok(())
    }
}

export_dialect!(rapid, Rapid);
