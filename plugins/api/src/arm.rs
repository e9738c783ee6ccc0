//! Axes of a robot's arm, and of what stands beside it, by the names that a machine file has for them.

use crate::setup::Setup;
use crate::text::ascii;

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
}

impl ArmWords {
    /// Finds the axes of the words of a program.
    ///
    /// # Errors
    /// The sentence for the user, about the first axis that is none of a robot.
    pub fn new(setup: &Setup<'_>) -> Result<Self, String> {
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
        Ok(Self { places })
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
