//! What polar and cylinder interpolation of the control have in common: the word of the turning axis is another one, and what
//! may not be in force as they begin.

use post_machine::diagnostic::Diagnostic;

use super::state::{AxisLetters, ControlState};

impl AxisLetters {
    /// The words in a mode, in which that of the axis at the place `turning` stands behind another letter than its own; it is a
    /// length there, or an angle.
    pub(super) fn in_mode(
        &self,
        turning: usize,
        [own, letter]: [&str; 2],
        length: bool,
    ) -> Option<Self> {
        let index = |letter: &str| letter.bytes().next().map(|letter| usize::from(letter - b'A'));
        let [before, behind] = [index(own)?, index(letter)?];
        let mut letters = self.clone();
        letters.letters[before] = Self::NONE;
        letters.mask &= !(1 << before);
        letters.letters[behind] = u8::try_from(turning).unwrap_or(Self::NONE);
        letters.mask |= 1 << behind;
        if length {
            letters.rotary &= !(1 << turning);
            if let Some(row) = ["X", "Y", "Z"].iter().position(|name| *name == letter) {
                letters.cartesian[row] = Some(turning);
            }
        }
        Some(letters)
    }
}

/// The number of the data set in a line that begins a transformation, if it has one: the last of what stands between the
/// parentheses, alone (TRANSMIT) or behind the diameter (TRACYL).
fn data_set(line: &str) -> Option<f64> {
    let (name, behind) = line.split_once('(')?;
    let inside = behind.split_once(')')?.0;
    let mut values = inside.split(',').map(str::trim);
    let name = name.split_whitespace().next_back().unwrap_or_default();
    let alone = name.eq_ignore_ascii_case("TRANSMIT");
    let value = if alone { values.next() } else { values.nth(1) };
    value?.parse().ok()
}

/// Why a data set is not the one that the machine file names; the first, if it names none.
fn unlike(number: f64, known: Option<f64>) -> Option<String> {
    let known = known.unwrap_or(1.0);
    (number != known).then(|| {
        format!("this is data set {number} of the control, and the machine file tells of data set {known} alone")
    })
}

impl ControlState {
    /// Why no mode can begin here.
    pub(super) fn holds_off_modes(&self) -> Option<String> {
        let lack = if self.wrap_outside.is_some() || self.face.is_some() {
            "polar or cylinder interpolation is in force already"
        } else if self.tip_words() || !self.to_work.upright() {
            "a plane, tool centre point control or a turned frame is in force"
        } else if self.state.compensation != 0 || self.cycles.in_force() {
            "cutter compensation or a cycle is in force"
        } else if !self.counts_as_described() {
            "a word has made diameters or radii of the words of X, against the machine file: what they are in the mode is not told"
        } else {
            return None;
        };
        Some(lack.to_owned())
    }

    /// Why the data set of that number is not the one of `on`, the lines that begin the mode in the machine file: `TRANSMIT(2)`,
    /// `TRACYL(50, 2)`, the first without a number.
    pub(super) fn other_data_set(&self, number: f64, on: &[String]) -> Option<String> {
        unlike(number, on.iter().find_map(|line| data_set(line)))
    }

    /// Refuses tool centre point control by another data set than the one that `tcp_on` of the machine file names, the
    /// first without a number, and with another direction of the tool: `TRAORI(2)`, `TRAORI(1,0,1,0)`.
    pub(super) fn is_own_transformation(
        &self,
        name: &str,
        values: &[Option<f64>],
    ) -> Result<(), Box<Diagnostic>> {
        let known = self.lexicon.values_of_call(name);
        let number = values.first().copied().flatten().unwrap_or(1.0);
        let lack = unlike(number, known.first().copied());
        let others = || values.iter().skip(1).map(|value| value.unwrap_or(0.0));
        let turned = others().count() > 0 && !others().eq(known.iter().skip(1).copied());
        let turned = turned
            .then(|| "the direction of the tool in its parentheses is not followed".to_owned());
        match lack.or(turned) {
            Some(lack) => Err(self.refuse("nc-mode", format!("{name} begins, and {lack}"))),
            None => Ok(()),
        }
    }

    /// Refuses a move in a frame that was turned since the mode of that name began.
    pub(super) fn is_unturned_in(&self, mode: &str) -> Result<(), Box<Diagnostic>> {
        if self.to_work.upright() {
            return Ok(());
        }
        let lack = "and what the words are then is not followed";
        Err(self.refuse("nc-mode", format!("the frame is turned in {mode} interpolation, {lack}")))
    }

    /// `word` begins a mode that the machine file says nothing of; its table is `key`.
    pub(super) fn unknown_mode(&self, word: &str, key: &str) -> Box<Diagnostic> {
        let message = format!("{word}, and this is not run");
        let help = format!("[{key}] of the machine file says what its words are then");
        self.placed(Diagnostic::error("nc-word", message).help(help)).boxed()
    }
}
