//! The words of one block, by letter: gathered anew for each, and nothing allocated for plain ones.

use nalgebra::Vector3;
use post_grammar::nc::{Across, Approach, NcBlock, NcItem, NcValue};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;

use super::state::ControlState;
use crate::g_code::GCode;

/// Most G or M words in one block.
const CODES: usize = 24;

/// The words of a block.
#[derive(Clone, Debug)]
pub(super) struct BlockWords {
    /// Bits of the letters that stand in the block.
    pub present: u32,
    /// Values of the letters, program units.
    pub values: [f64; 26],
    /// Bits of letters that are ways from where the tool stands.
    pub incremental: u32,
    /// Bits of letters that are positions whatever is modal.
    pub absolute: u32,
    /// Bits of letters whose axis turns in a way of its own; which, stands in `approaches`.
    pub approached: u32,
    /// Approaches by letter.
    pub approaches: [Option<Approach>; 26],
    /// Bits of letters that a word of the block has made use of.
    pub used: u32,
    /// The G codes, in order.
    pub g: CodeList<GCode>,
    /// The numbers after M.
    pub m: CodeList<u16>,
    /// Bits of letters whose number has a decimal point.
    pub pointed: u32,
    /// Bits of letters whose number has none and is not zero.
    pub pointless: u32,
    /// Whether the block has more than letters with values.
    pub more: bool,
    /// The tool axis by `A3=` and so on, program coordinates.
    pub vector: Option<Vector3<f64>>,
    /// Distance from the origin of X and Y, and angle from X, degrees: `@` and `^` of LinuxCNC.
    pub polar: [Option<f64>; 2],
    /// Radius of an arc by a name, mm.
    pub radius: Option<f64>,
    /// Full turns of an arc beside its own: `TURN=`.
    pub turns: Option<f64>,
    /// Bits of the places in the chain of axes with longer names.
    pub named_axes: u32,
    /// Values of the named axes: mm and radians from the drawing's zeros.
    pub named_values: Joints,
}

/// Codes of a letter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CodeList<C> {
    list: [C; CODES],
    count: usize,
}

impl<C: Copy + PartialEq> CodeList<C> {
    /// The codes.
    #[inline]
    pub fn list(&self) -> &[C] {
        &self.list[..self.count.min(CODES)]
    }

    /// Whether `code` is among them.
    pub fn has(&self, code: C) -> bool {
        self.list().contains(&code)
    }
}

impl Default for BlockWords {
    fn default() -> Self {
        Self {
            present: 0,
            values: [0.0; 26],
            incremental: 0,
            absolute: 0,
            approached: 0,
            approaches: [None; 26],
            used: 0,
            g: CodeList::default(),
            m: CodeList::default(),
            pointed: 0,
            pointless: 0,
            more: false,
            vector: None,
            polar: [None; 2],
            radius: None,
            turns: None,
            named_axes: 0,
            named_values: Joints::default(),
        }
    }
}

/// The bit of a letter.
#[inline]
pub(super) const fn bit(letter: u8) -> u32 {
    1 << (letter.wrapping_sub(b'A') & 31)
}

impl BlockWords {
    /// The value of a letter, program units; none if it does not stand in the block.
    #[inline]
    pub fn get(&self, letter: u8) -> Option<f64> {
        (self.present & bit(letter) != 0)
            .then(|| self.values[usize::from(letter.wrapping_sub(b'A')) % 26])
    }

    /// [`BlockWords::get`], and the word is made use of.
    #[inline]
    pub fn take(&mut self, letter: u8) -> Option<f64> {
        self.used |= bit(letter);
        self.get(letter)
    }

    /// A number after `letter` that says which: a register, a tool, a count.
    pub fn take_number(
        &mut self,
        letter: u8,
        control: &ControlState,
    ) -> Result<Option<u32>, Box<Diagnostic>> {
        match self.take(letter) {
            None => Ok(None),
            Some(value) => which(letter, value, control).map(Some),
        }
    }

    /// [`BlockWords::take_number`] of a letter that may stand there for something else: it is not made use of.
    pub fn present_number(
        &self,
        letter: u8,
        control: &ControlState,
    ) -> Result<Option<u32>, Box<Diagnostic>> {
        self.get(letter).map(|value| which(letter, value, control)).transpose()
    }

    fn clear(&mut self) {
        self.present = 0;
        self.incremental = 0;
        self.absolute = 0;
        self.approached = 0;
        self.used = 0;
        self.g.count = 0;
        self.m.count = 0;
        self.pointed = 0;
        self.pointless = 0;
        if self.more {
            self.more = false;
            self.vector = None;
            self.polar = [None; 2];
            self.radius = None;
            self.turns = None;
            self.named_axes = 0;
        }
    }
}

impl ControlState {
    /// Takes the words of a block.
    #[inline]
    pub(super) fn gather(
        &self,
        block: &NcBlock,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        words.clear();
        for item in &block.items {
            let NcItem::Word(word) = item else {
                words.more = true;
                continue;
            };
            let value = match &word.value {
                NcValue::Number(number) => {
                    if word.letter.is_ascii_uppercase() {
                        if number.point {
                            words.pointed |= bit(word.letter);
                        } else if number.value != 0.0 {
                            words.pointless |= bit(word.letter);
                        }
                    }
                    number.value
                }
                other => self.valued(word.letter, other, words)?,
            };
            self.add_word(word.letter, value, words)?;
            if word.incremental {
                words.incremental |= bit(word.letter);
            }
        }
        Ok(())
    }

    /// A letter and its value.
    #[inline]
    pub(super) fn add_word(
        &self,
        letter: u8,
        value: f64,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        match letter {
            b'G' => {
                let code = GCode::of(value).ok_or_else(|| self.no_code(b'G', value))?;
                self.add_code(b'G', code, &mut words.g)?;
            }
            b'M' => {
                let code = m_number(value).ok_or_else(|| self.no_code(b'M', value))?;
                self.add_code(b'M', code, &mut words.m)?;
            }
            b'A'..=b'Z' => {
                let bit = bit(letter);
                if words.present & bit != 0 {
                    return Err(self.twice(letter));
                }
                words.present |= bit;
                words.values[usize::from(letter - b'A')] = value;
            }
            _ => words.more = true,
        }
        Ok(())
    }

    #[cold]
    fn twice(&self, letter: u8) -> Box<Diagnostic> {
        let message = format!("{} stands twice in one block", char::from(letter));
        self.refuse("nc-word", message)
    }

    /// A value that is more than a number.
    #[cold]
    fn valued(
        &self,
        letter: u8,
        value: &NcValue,
        words: &mut BlockWords,
    ) -> Result<f64, Box<Diagnostic>> {
        if let (NcValue::Approached(approach, inner), b'A'..=b'Z') = (value, letter) {
            match approach {
                Approach::Incremental => words.incremental |= bit(letter),
                Approach::Absolute => words.absolute |= bit(letter),
                Approach::Across(across) => {
                    let value = self.variables.worth(inner);
                    let value = value.map_err(|finding| self.placed(*finding).boxed())?;
                    match across.incremental {
                        true => words.incremental |= bit(letter),
                        false => words.absolute |= bit(letter),
                    }
                    // An axis that the machine has not is refused elsewhere.
                    let counted = match self.axis_of(letter) {
                        Some(place) => self.across(place, *across)?,
                        None => 1.0,
                    };
                    return Ok(value * counted);
                }
                Approach::Shortest | Approach::Positive | Approach::Negative => {
                    words.absolute |= bit(letter);
                    words.approached |= bit(letter);
                    words.approaches[usize::from(letter - b'A')] = Some(*approach);
                }
            }
        }
        if let (NcValue::Text(_), b'T') = (value, letter) {
            // A tool by its name: `names` looks for it.
            words.more = true;
            return Ok(f64::NAN);
        }
        let value = self.variables.worth(value);
        value.map_err(|finding| self.placed(*finding).boxed())
    }

    /// Units of the word of a linear axis, as it counts at present, in one unit of a diameter or radius.
    pub(super) fn across(&self, place: usize, across: Across) -> Result<f64, Box<Diagnostic>> {
        let scale = libm::fabs(self.axes.scale[place]);
        let coupled = self.machine.word_map.as_ref().is_some_and(|map| map.is_coupled(place));
        let known = [1.0, 0.5].iter().any(|known| libm::fabs(scale - known) < 1e-9);
        let rotary = self.axes.rotary & (1 << place) != 0;
        if self.face.is_some() || self.wrap_outside.is_some() || coupled || !known || rotary {
            let message = format!(
                "{} is said as a diameter or radius, and what its words are here is told by the machine file alone",
                self.machine.axes[place].name
            );
            return Err(self.refuse("nc-word", message));
        }
        // Ways of DIAM90 count twice.
        let doubled = across.incremental
            && self.axes.cartesian[0] == Some(place)
            && self.modal.ways_are_radii;
        let unit = if across.diameter { 0.5 } else { 1.0 };
        Ok(unit / scale / if doubled { 2.0 } else { 1.0 })
    }

    #[cold]
    fn no_code(&self, letter: u8, value: f64) -> Box<Diagnostic> {
        self.refuse("nc-word", format!("there is no {}{value}", char::from(letter)))
    }

    #[inline]
    fn add_code<C>(
        &self,
        letter: u8,
        code: C,
        codes: &mut CodeList<C>,
    ) -> Result<(), Box<Diagnostic>> {
        if codes.count == CODES {
            return Err(self.refuse(
                "nc-word",
                format!("more than {CODES} {} in one block", char::from(letter)),
            ));
        }
        codes.list[codes.count] = code;
        codes.count += 1;
        Ok(())
    }
}

/// The number of an M code.
#[inline]
fn m_number(value: f64) -> Option<u16> {
    let whole = libm::rint(value);
    let exact = (0.0..65_535.0).contains(&whole) && libm::fabs(value - whole) <= 1e-6;
    exact.then_some(whole as u16)
}

/// A whole number from 0 on, of a register or a tool.
pub(super) fn which(
    letter: u8,
    value: f64,
    control: &ControlState,
) -> Result<u32, Box<Diagnostic>> {
    let whole = libm::rint(value);
    if (0.0..1e9).contains(&whole) && libm::fabs(value - whole) < 1e-6 {
        return Ok(whole as u32);
    }
    Err(control.refuse(
        "nc-word",
        format!("{}{value} is no number of a register or tool", char::from(letter)),
    ))
}
