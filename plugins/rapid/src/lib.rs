//! RAPID of ABB's robots: `MoveAbsJ`, which leads all axes evenly in time to their values, and `MoveL`, which leads the
//! tool straight to a pose.
//!
//! What it assumes about the control stands in `docs/src/machine-builder/robots.md`.

use post_plugin::{
    ARM_AXES, ARM_JOINTS, ArmWords, Capabilities, Coolant, Dialect, Event, Feed, Format, Language,
    Meaning, OptionSpec, Setup, Spindle, SpindleSense, Units, VocabularyWord, ascii,
    export_dialect, fixed, identifier,
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
    decimals: Vec<u8>,
    depth: Vec<bool>,
    rotary: Vec<bool>,
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
    OptionSpec::integer(
        "decimals",
        (0, 6),
        4,
        "Decimals of the values of axes that turn, degrees.",
    ),
    OptionSpec::integer("linear_decimals", (0, 6), 3, "Decimals of those that slide, mm."),
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
    OptionSpec::lines("optional_stop", "OptionalStop;", "Lines of an optional stop."),
];

/// What the names of its programs mean.
const WORDS: &[(&str, Meaning)] = &[
    ("!", Meaning::Remark),
    ("MODULE", Meaning::Nothing),
    ("VAR", Meaning::Nothing),
    ("PROC", Meaning::Nothing),
    ("ENDPROC", Meaning::End),
    ("MoveAbsJ", Meaning::JointMove),
    ("MoveJ", Meaning::PoseMove),
    ("MoveL", Meaning::PoseMove),
    ("MoveC", Meaning::PoseMove),
    ("CJointT", Meaning::JointsNow),
    ("ConfJ", Meaning::Nothing),
    ("ConfL", Meaning::Nothing),
    ("TPWrite", Meaning::Nothing),
    ("WaitTime", Meaning::Dwell),
    ("Stop", Meaning::Stop),
    ("ChangeTool", Meaning::ToolChange),
    ("SpindleCw", Meaning::SpindleClockwise),
    ("SpindleCcw", Meaning::SpindleCounterClockwise),
    ("SpindleOff", Meaning::SpindleOff),
    ("SpindleOrient", Meaning::SpindleOrient),
    ("CoolantOn", Meaning::CoolantOn),
    ("CoolantOff", Meaning::CoolantOff),
];

impl Dialect for Rapid {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        if setup.tcp {
            return Err(
                "it writes the values of the axes (MoveAbsJ), not MoveL: tcp = \"post\"".to_owned()
            );
        }
        if setup.units != Units::Millimetre {
            return Err("RAPID counts in millimetres: units = \"mm\"".to_owned());
        }
        let decimals =
            |rotary: bool| setup.integer(if rotary { "decimals" } else { "linear_decimals" }) as u8;
        Ok(Rapid {
            axes: ArmWords::new(setup)?,
            decimals: setup.words.iter().map(|word| decimals(word.rotary)).collect(),
            depth: setup.words.iter().map(|word| word.depth).collect(),
            rotary: setup.words.iter().map(|word| word.rotary).collect(),
            program: identifier(setup.program, NAME),
            zone: setup.text("zone").to_owned(),
            tool: setup.text("tool").to_owned(),
            optional_stop: setup.text("optional_stop").to_owned(),
            pose: None,
            follows: false,
        })
    }

    fn format(&self) -> Format {
        Format {
            words: self.decimals.clone(),
            feed: 2,
            inverse_time: Some(3),
            feed_per_revolution: 3,
            extension: "mod".to_owned(),
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
        let mut relies = vec![
            "where MoveL is written it leads the tool straight and turns it evenly about one direction; the frame of the tool has its origin in the tip, its Z from the spindle to the tip, its X along that of the machine file's frame where all axes are at zero; wobj0 is the machine file's frame".to_owned(),
            "MoveAbsJ leads all axes of the arm and beside it evenly in time, so that they arrive together, whatever tool and work object are".to_owned(),
            "the procedures SpindleCw, SpindleCcw, SpindleOrient, SpindleOff, CoolantOn, CoolantOff, OptionalStop and ChangeTool are on the control, where the program calls them".to_owned(),
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
        match *event {
            Event::Start => {
                line(&format!("MODULE M{}", self.program), out);
                line("VAR jointtarget here;", out);
                line(&format!("PROC {}()", self.program), out);
            }
            Event::Comment { text } => line(&format!("! {}", ascii(text)), out),
            Event::Literal { text } | Event::Word { text } => line(text, out),
            Event::ToolChange { number, .. } => line(&format!("ChangeTool {number};"), out),
            Event::Spindle(spindle) => self.turn(spindle, out),
            Event::Coolant(Coolant::Off) => line("CoolantOff;", out),
            Event::Coolant(coolant) => line(&format!("CoolantOn \"{coolant:?}\";"), out),
            Event::Turn { words } => self.some(words, |rapid, word| rapid.rotary[word], out),
            Event::Retract { axes, words } | Event::Park { axes, words } => {
                self.some(words, |_, word| axes & (1 << word) != 0, out);
            }
            Event::Position { words, feed, plane_first, .. } => {
                if plane_first && self.depth.contains(&true) {
                    self.some(words, |rapid, word| !rapid.depth[word], out);
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
    out.push_str(text);
    out.push('\n');
}

fn number(value: f64, decimals: u8) -> String {
    let mut text = String::new();
    fixed(&mut text, value, decimals);
    text
}

impl Rapid {
    fn turn(&self, spindle: Spindle, out: &mut String) {
        let text = match spindle {
            Spindle::Off => "SpindleOff;".to_owned(),
            Spindle::On { rpm, sense: SpindleSense::Clockwise } => {
                format!("SpindleCw {};", number(rpm, 0))
            }
            Spindle::On { rpm, sense: SpindleSense::CounterClockwise } => {
                format!("SpindleCcw {};", number(rpm, 0))
            }
            Spindle::Orient => "SpindleOrient;".to_owned(),
        };
        line(&text, out);
    }

    /// Leads some axes to their words at the largest velocity; the others stay where they are.
    fn some(&self, words: &[f64], which: impl Fn(&Self, usize) -> bool, out: &mut String) {
        line("here:=CJointT();", out);
        for (word, value) in words.iter().enumerate().filter(|(word, _)| which(self, *word)) {
            let value = number(*value, self.decimals[word]);
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
            Some(word) => number(words.get(word).copied().unwrap_or(0.0), self.decimals[word]),
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
