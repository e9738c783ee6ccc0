//! RAPID of ABB's robots: `MoveAbsJ`, which leads all axes evenly in time to their values.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_plugin::{
    Capabilities, Coolant, Dialect, Event, Feed, Format, OptionSpec, Setup, Spindle, SpindleSense,
    Units, ascii, export_dialect, fixed,
};

/// Axes of the arm, and of what stands beside it.
const AXES: usize = 6;

/// Where the value of an axis word stands in a `jointtarget`.
type Place = usize;

/// Names of axes, by their places: those of the arm, then those beside it.
const NAMES: [&str; 9] = ["A", "B", "C", "U", "V", "W", "X", "Y", "Z"];

/// Components of a `jointtarget`, in that order.
const COMPONENTS: [&str; 2 * AXES] = [
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
    places: Vec<Place>,
    decimals: Vec<u8>,
    depth: Vec<bool>,
    rotary: Vec<bool>,
    program: String,
    zone: String,
    tool: String,
    optional_stop: String,
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
        "Tool of every move: the control takes load and velocity from it, and no position.",
    ),
    OptionSpec::lines("optional_stop", "OptionalStop;", "Lines of an optional stop."),
];

/// A name that RAPID takes: letters, digits and underlines, a letter first.
fn identifier(name: &str) -> String {
    let taken = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = ascii(name).chars().map(taken).take(NAME).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("p{name}") }
}

/// Where an axis stands in a `jointtarget`.
fn place(name: &str) -> Option<Place> {
    NAMES.iter().position(|known| *known == name)
}

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
        let mut places = Vec::new();
        for word in setup.words {
            let name = word.name;
            places.push(place(name).ok_or_else(|| {
                format!("axis {name}: A B C U V W are the axes 1 to 6 of a robot, X Y Z those beside it (eax_a to eax_c): rename the axis, in the chain too")
            })?);
            if word.wrapped {
                return Err(format!(
                    "axis {name}: MoveAbsJ leads an axis to the value that is written, whichever turn: leave `range` out"
                ));
            }
        }
        let decimals =
            |rotary: bool| setup.integer(if rotary { "decimals" } else { "linear_decimals" }) as u8;
        Ok(Rapid {
            places,
            decimals: setup.words.iter().map(|word| decimals(word.rotary)).collect(),
            depth: setup.words.iter().map(|word| word.depth).collect(),
            rotary: setup.words.iter().map(|word| word.rotary).collect(),
            program: identifier(setup.program),
            zone: setup.text("zone").to_owned(),
            tool: setup.text("tool").to_owned(),
            optional_stop: setup.text("optional_stop").to_owned(),
        })
    }

    fn format(&self) -> Format {
        Format {
            words: self.decimals.clone(),
            feed: 2,
            inverse_time: Some(3),
            feed_per_revolution: 3,
            extension: "mod".to_owned(),
            ..Format::default()
        }
    }

    /// No length is compensated by the control: values of axes are those with the tool that the program is for.
    fn capabilities(&self) -> Capabilities {
        Capabilities::TOOL_TABLE | Capabilities::LENGTH_IN_OFFSET
    }

    fn relies_on(&self) -> Vec<String> {
        let mut relies = vec![
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
            Event::Linear { words, feed, .. } => self.all(words, Some(feed), &self.zone, out)?,
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
            line(&format!("here.{}:={value};", COMPONENTS[self.places[word]]), out);
        }
        line(&format!("MoveAbsJ here,vmax,fine,{};", self.tool), out);
    }

    /// Leads all axes to their words.
    fn all(
        &self,
        words: &[f64],
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
        let mut values: [String; 2 * AXES] = std::array::from_fn(|place| match place {
            0..AXES => "0".to_owned(),
            // An axis that is not there.
            _ => "9E9".to_owned(),
        });
        for (word, value) in words.iter().enumerate() {
            values[self.places[word]] = number(*value, self.decimals[word]);
        }
        let (arm, beside) = values.split_at(AXES);
        let target = format!("[[{}],[{}]]", arm.join(","), beside.join(","));
        line(&format!("MoveAbsJ {target},{pace},{zone},{};", self.tool), out);
        Ok(())
    }
}

export_dialect!(rapid, Rapid);
