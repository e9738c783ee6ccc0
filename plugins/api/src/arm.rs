//! Axes of a robot's arm, and of what stands beside it, by the names that a machine file has for them.

mod language;

use crate::capabilities::Capabilities;
use crate::dialect::Format;
use crate::event::Event;
use crate::language::Language;
use crate::number::fixed_text;
use crate::setup::{OptionKind, OptionSpec, Setup, Units, Value};
use crate::text::ascii;

pub use language::ArmLanguage;

/// Joints of an arm.
pub const ARM_JOINTS: usize = 6;

/// Axes that a robot's control leads: those of the arm, then as many beside it.
pub const ARM_AXES: usize = 2 * ARM_JOINTS;

/// Letters of the joints of an arm, then of axes beside it.
const LETTERS: &str = "ABCUVWXYZ";

/// Which axis of a robot's control has this name, from 0: `A B C U V W` or `A1` to `A6` are the joints of the arm, `X Y Z`
/// or `E1` to `E6` the axes beside it, from [`ARM_JOINTS`] on. None of any other name.
pub fn arm_axis(name: &str) -> Option<usize> {
    let mut rest = name.chars();
    let letter = rest.next()?;
    let number = match rest.as_str() {
        "" => return LETTERS.find(letter),
        number => {
            number.parse::<usize>().ok()?.checked_sub(1).filter(|place| *place < ARM_JOINTS)?
        }
    };
    match letter {
        'A' => Some(number),
        'E' => Some(ARM_JOINTS + number),
        _ => None,
    }
}

/// The axis words of a program as a robot's control has them.
#[derive(Clone, Debug)]
pub struct ArmWords {
    /// Axis of the control of each word.
    places: Vec<usize>,
    decimals: Vec<u8>,
    rotary: Vec<bool>,
}

impl ArmWords {
    /// The option of a dialect that its words of axes that turn are written by.
    pub const DECIMALS: OptionSpec = OptionSpec::integer(
        "decimals",
        (0, 6),
        4,
        "Decimals of the values of axes that turn, degrees.",
    );

    /// That of a language which leads axes that slide as well.
    pub const LINEAR_DECIMALS: OptionSpec =
        OptionSpec::integer("linear_decimals", (0, 6), 3, "Decimals of those that slide, mm.");

    /// The option of a dialect of robots by which `[control] orientation` asks for the form in which straight moves tell how
    /// the tool stands; the first of them is what it writes by itself.
    pub const fn orientation(forms: &'static [&'static str]) -> OptionSpec {
        OptionSpec {
            key: "orientation",
            kind: OptionKind::Choice(forms),
            default: Value::Text(forms[0]),
            help: "How straight moves tell how the tool stands; [control] orientation says the same.",
        }
    }

    /// What a robot's control is told: values of its axes, or poses of the tool that the program is for. No length is
    /// compensated by it.
    pub const CAPABILITIES: Capabilities =
        Capabilities::TOOL_TABLE.and(Capabilities::LENGTH_IN_OFFSET).and(Capabilities::POSES);

    /// Finds the axes of the words of a program of a dialect with the option [`ArmWords::DECIMALS`], and
    /// [`ArmWords::LINEAR_DECIMALS`] if it leads axes that slide.
    ///
    /// # Errors
    /// The sentence for the user, about the first axis that is none of a robot, units and `tcp`.
    pub fn new(setup: &Setup<'_>) -> Result<Self, String> {
        if setup.tcp {
            return Err(
                "poses of the tool come from the values of the axes: tcp = \"post\"".to_owned()
            );
        }
        if setup.units != Units::Millimetre {
            return Err(
                "a robot's axes are told in degrees and millimetres: units = \"mm\"".to_owned()
            );
        }
        let mut places = Vec::new();
        for word in setup.words {
            let name = word.name;
            let place = arm_axis(name).ok_or_else(|| {
                format!("axis {name}: A B C U V W or A1 to A6 are the axes 1 to 6 of a robot, X Y Z or E1 to E6 those beside it: rename the axis, in the chain too")
            })?;
            if places.contains(&place) {
                return Err(format!(
                    "axis {name}: another axis of the machine is the same one of the robot: rename the axis, in the chain too"
                ));
            }
            if word.wrapped {
                return Err(format!(
                    "axis {name}: a robot leads an axis to the value that is written, whichever turn: leave `range` out"
                ));
            }
            if place < ARM_JOINTS && !word.rotary {
                return Err(format!(
                    "axis {name}: the joints of an arm turn: X Y Z or E1 to E6 slide, rename the axis, in the chain too"
                ));
            }
            places.push(place);
        }
        let decimals = |rotary: bool| match setup.option(Self::LINEAR_DECIMALS.key) {
            Some(Value::Integer(decimals)) if !rotary => decimals as u8,
            _ => setup.integer(Self::DECIMALS.key) as u8,
        };
        Ok(Self {
            places,
            decimals: setup.words.iter().map(|word| decimals(word.rotary)).collect(),
            rotary: setup.words.iter().map(|word| word.rotary).collect(),
        })
    }

    /// How numbers of the program are written; a feed by time with so many decimals.
    pub fn format(&self, inverse_time: u8, extension: &str) -> Format {
        Format {
            words: self.decimals.clone(),
            feed: 2,
            inverse_time: Some(inverse_time),
            feed_per_revolution: 3,
            extension: extension.to_owned(),
            language: Language::Joints,
            ..Format::default()
        }
    }

    /// The values that some axes alone are led to at rapid, and which those are, a bit by word: those that turn, or what
    /// retracts and parks. None of any other event.
    pub fn some_of<'e>(&self, event: &Event<'e>) -> Option<(&'e [f64], u32)> {
        match *event {
            Event::Turn { words } => {
                let rotary = self.rotary.iter().enumerate();
                Some((
                    words,
                    rotary.fold(0, |mask, (word, rotary)| mask | u32::from(*rotary) << word),
                ))
            }
            Event::Retract { axes, words } | Event::Park { axes, words } => Some((words, axes)),
            _ => None,
        }
    }

    /// The value of a word as it is printed; 0 of one that is not there.
    pub fn value(&self, word: usize, words: &[f64]) -> String {
        fixed_text(words.get(word).copied().unwrap_or(0.0), self.decimals[word])
    }

    /// Axis of the control of a word of the program, from 0.
    pub fn place(&self, word: usize) -> usize {
        self.places[word]
    }

    /// Which word of the program each axis of the control has; none of an axis that is not there.
    pub fn words(&self) -> [Option<usize>; ARM_AXES] {
        std::array::from_fn(|place| self.places.iter().position(|known| *known == place))
    }
}

/// A name that robots' languages take: letters, digits and underlines, a letter first, at most `longest` of them.
pub fn identifier(name: &str, longest: usize) -> String {
    let taken = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = ascii(name).chars().map(taken).collect();
    let name =
        if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("p{name}") };
    name.chars().take(longest).collect()
}
