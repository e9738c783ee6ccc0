//! Which word of a control switches what: what its dialect hands over, and behind that what all controls of the
//! language that it declares have in common.
//!
//! The dialect goes first. What it does not name is looked for among the words that every control of the language
//! reads the same way (`lexicon/common.rs`); what stands there neither is not known.

mod common;

use std::collections::BTreeMap;

use post_grammar::nc::{NcSyntax, Notation};
use post_machine::description::FeedLength;
use post_plugin::{AxisWords, Capabilities, Language, Lengths, Meaning, VocabularyWord};

use crate::g_code::GCode;
use crate::interpret::ModalGroup;

/// What a word does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WordMeaning {
    /// Nobody knows.
    Unknown,
    /// What the dialect says, or all controls of the language.
    Means(Meaning),
    /// It makes something else of the words behind it than we do: it is refused.
    Refused,
}

/// A code, and what it means with certain words beside it.
#[derive(Clone, Debug)]
struct CodeChoice {
    code: GCode,
    /// Letters that stand beside it, and their values where they are said.
    beside: Vec<(u8, Option<f64>)>,
    meaning: Meaning,
}

/// Codes that a table holds: `G0` to `G999.9`.
const G_CODES: usize = 10_000;

/// `M0` to `M999`.
const M_CODES: usize = 1000;

/// The words of a control, ready to be looked up.
#[derive(Clone, Debug)]
pub struct Lexicon {
    syntax: NcSyntax,
    language: Language,
    /// By [`GCode::index`].
    g: Vec<u8>,
    /// By the number behind M.
    m: Vec<u8>,
    /// What the places in `g` and `m` stand for; the first is [`WordMeaning::Unknown`].
    senses: Vec<WordMeaning>,
    letters: [Option<Meaning>; 26],
    names: BTreeMap<String, WordMeaning>,
    /// Names that mean this beside a code alone.
    names_beside: Vec<(GCode, String, Meaning)>,
    /// Names that mean this where nothing stands between their parentheses.
    empty: BTreeMap<String, Meaning>,
    choices: Vec<CodeChoice>,
    /// Codes of which it is said what words of axes are to them, beside what they mean.
    axis_words: Vec<(GCode, AxisWords)>,
    writes: Capabilities,
    /// A word changes the tool; else T does.
    changes_by_word: bool,
    /// The dialect itself knows G64, so that G61 is one of several modes.
    path_modes: bool,
    /// A feed a minute counts along all axes together where no tip is kept.
    all_axes: bool,
    /// Bits of the modes that the dialect has words for.
    modes: u16,
    /// A cycle returns to a level that the program names.
    return_levels: bool,
    /// The word that ends cycles stops the spindle too, and a rapid ends them as well.
    rapids_end_cycles: bool,
    /// A constant cutting speed is a kind of the feed, and every other kind ends it.
    speed_goes_with_feed: bool,
}

impl Lexicon {
    /// From what a dialect declares and hands over.
    pub fn new(language: Language, writes: Capabilities, words: &[VocabularyWord]) -> Self {
        let mut lexicon = Self {
            language,
            writes,
            g: vec![0; G_CODES],
            m: vec![0; M_CODES],
            senses: vec![WordMeaning::Unknown],
            syntax: syntax(words, language, writes),
            all_axes: words.iter().any(|word| word.meaning == Meaning::FeedPerMinuteAllAxes),
            return_levels: words.iter().any(|word| word.meaning == Meaning::ReturnLevel),
            rapids_end_cycles: words.iter().any(|word| word.meaning == Meaning::CycleOffSpindleOff),
            speed_goes_with_feed: language == Language::Names,
            path_modes: words.iter().any(|word| word.word == "G64"),
            changes_by_word: words.iter().any(|word| word.meaning == Meaning::ToolChange),
            letters: [None; 26],
            names: BTreeMap::new(),
            names_beside: Vec::new(),
            empty: BTreeMap::new(),
            choices: Vec::new(),
            axis_words: Vec::new(),
            modes: match language {
                // They count in their own units, and have none of the other modes.
                Language::Joints => ModalGroup::of_robots(words),
                // Its head names the units, I the ways and R0 the path; the plane is that of the tool call.
                Language::Conversational => {
                    ModalGroup::named(words) & ModalGroup::TiltedPlane.bit()
                }
                _ => ModalGroup::named(words),
            },
        };
        if !lexicon.commands_a_line() {
            for (word, sense) in common::words(language) {
                lexicon.add_sense(word, sense);
            }
        }
        for VocabularyWord { word, meaning } in words {
            match language {
                // Statements are read in capitals, however the language writes them.
                Language::Joints => lexicon.add(&word.trim().to_ascii_uppercase(), *meaning),
                _ => lexicon.add(word.trim(), *meaning),
            }
        }
        lexicon
    }

    /// G0 goes at F.
    pub fn rapids_at_feed(&self) -> bool {
        self.writes.has(Capabilities::RAPIDS_AT_FEED)
    }

    /// A line is one command and its parameters.
    pub(crate) fn commands_a_line(&self) -> bool {
        self.writes.has(Capabilities::COMMAND_A_LINE)
    }

    /// It has no words for positions of the machine.
    pub(crate) fn has_no_positions(&self) -> bool {
        self.writes.has(Capabilities::NO_PARK)
    }

    /// What the reader of its programs must know.
    pub fn syntax(&self) -> &NcSyntax {
        &self.syntax
    }

    /// Its language.
    pub fn language(&self) -> Language {
        self.language
    }

    /// A stop (M0, M1) stops the spindle and the coolant too: on Heidenhain and Haas in any case, on other controls of
    /// letters as their builders have it. Siemens, LinuxCNC and GRBL leave both on.
    pub fn stops_spindle(&self) -> bool {
        !matches!(self.language, Language::Names | Language::Rs274)
    }

    /// Tolerances of smoothing are in mm in inch programs too.
    pub(crate) fn smooths_in_mm(&self) -> bool {
        self.writes.has(Capabilities::SMOOTHING_IN_MM)
    }

    /// Where a transformation begins or ends, the work offset may end too: MD 10602 of Siemens says so.
    pub(crate) fn transformations_drop_frames(&self) -> bool {
        self.language == Language::Names
    }

    /// The tool's length goes along the axis across the plane in force, whichever was when it was put on.
    pub(crate) fn lengths_go_across(&self) -> bool {
        self.writes.has(Capabilities::LENGTH_ACROSS_PLANE)
    }

    /// Whether positions of the machine are without the tool's length is for the builder to say: MD 10760 of Siemens.
    pub(crate) fn machine_lengths_vary(&self) -> bool {
        self.language == Language::Names
    }

    /// Where the control has the length of the tool from.
    pub fn lengths(&self) -> Lengths {
        self.writes.lengths()
    }

    /// D switches the length of the tool on, and D0 off.
    pub fn tools_have_edges(&self) -> bool {
        self.writes.has(Capabilities::TOOL_EDGES)
    }

    /// D names the register of length and radius, and puts both in force.
    pub(crate) fn names_lengths_by_d(&self) -> bool {
        self.letter(b'D') == Some(Meaning::LengthRegister)
    }

    /// A contour is compensated by the radius in a register, D.
    pub fn has_radius_registers(&self) -> bool {
        !self.writes.has(Capabilities::TOOL_TABLE)
    }

    /// Some word turns a spindle.
    pub fn has_spindle(&self) -> bool {
        self.senses.contains(&WordMeaning::Means(Meaning::SpindleClockwise))
            || self.language == Language::Joints
    }

    /// A word changes the tool, M6 or another; else T does.
    pub(crate) fn changes_by_word(&self) -> bool {
        self.changes_by_word
    }

    /// The length that a feed a minute counts along where no tip is kept and the machine file says nothing else.
    pub(crate) fn feed_length(&self) -> FeedLength {
        match self.writes {
            _ if self.all_axes => FeedLength::Combined,
            writes if writes.has(Capabilities::FEED_LONGEST_TURN) => FeedLength::LinearOrLongest,
            _ => FeedLength::Linear,
        }
    }

    /// Bits of the modes that a program must set itself, as the dialect names them ([`ModalGroup`]).
    pub(crate) fn modes(&self) -> u16 {
        self.modes
    }

    /// A cycle returns to a level that the program names, and not to where it began if nothing is said.
    pub(crate) fn returns_to_levels(&self) -> bool {
        self.return_levels
    }

    /// A rapid ends a cycle as well as the word for that, which stops the spindle.
    pub(crate) fn rapids_end_cycles(&self) -> bool {
        self.rapids_end_cycles
    }

    /// A number without a decimal point may count in the least increment of the control.
    pub(crate) fn counts_by_point(&self) -> bool {
        self.language == Language::Macro && !self.writes.has(Capabilities::UNIT_SYSTEM)
    }

    /// G61 is one of several modes, and not just the name of the only one.
    pub(crate) fn has_path_modes(&self) -> bool {
        self.path_modes
    }

    /// The sense of a G code; words beside it may change it: [`Lexicon::g_beside`].
    #[inline]
    pub(crate) fn g(&self, code: GCode) -> WordMeaning {
        let sense = self.g.get(code.index()).copied().unwrap_or(0);
        self.senses[usize::from(sense)]
    }

    /// The sense of a G code where `beside` tells which letters stand in the block and their values.
    pub(crate) fn g_beside(&self, code: GCode, beside: impl Fn(u8) -> Option<f64>) -> WordMeaning {
        let holds = |choice: &&CodeChoice| {
            let mut letters = choice.beside.iter();
            choice.code == code
                && letters.all(|(letter, value)| match (beside(*letter), value) {
                    (Some(found), Some(wanted)) => libm::fabs(found - wanted) < 1e-9,
                    (found, None) => found.is_some(),
                    (None, Some(_)) => false,
                })
        };
        let choices = self.choices.iter().filter(holds);
        let best = choices.max_by_key(|choice| choice.beside.len());
        best.map_or_else(|| self.g(code), |choice| WordMeaning::Means(choice.meaning))
    }

    /// What words of axes are to a G code, which means `meaning` beside the words of its block.
    pub(crate) fn axis_words(&self, code: GCode, meaning: Meaning) -> AxisWords {
        let mut said = self.axis_words.iter();
        if let Some((_, said)) = said.find(|(known, _)| *known == code) {
            return *said;
        }
        let alone = match self.g(code) {
            WordMeaning::Means(alone) => alone.axis_words(),
            WordMeaning::Unknown | WordMeaning::Refused => AxisWords::Lead,
        };
        match (alone, meaning.axis_words()) {
            // Another word gives it another sense: whose they are then is not said.
            (AxisWords::Own, AxisWords::Lead) => AxisWords::None,
            (AxisWords::None, AxisWords::Lead) => AxisWords::None,
            (_, own) => own,
        }
    }

    /// A constant cutting speed is a kind of the feed, and every other kind ends it: G94, G95, G96, G961 of Siemens are of
    /// one group.
    pub(crate) fn speed_goes_with_feed(&self) -> bool {
        self.speed_goes_with_feed
    }

    /// The letter beside a code behind which a value of it stands: the tolerance of `G64 P`, the limit of `G96 D`.
    pub(crate) fn value_letter(&self, code: GCode) -> Option<u8> {
        let mut choices = self.choices.iter().filter(|choice| choice.code == code);
        choices.find_map(|choice| {
            let open = choice.beside.iter().find(|(_, value)| value.is_none());
            open.map(|(letter, _)| *letter)
        })
    }

    /// What a letter beside a G code means, if the dialect says so: P of `G4 P`, of `G2 P`.
    pub(crate) fn letter_beside(&self, code: GCode, letter: u8) -> Option<Meaning> {
        let wanted =
            |choice: &&CodeChoice| choice.code == code && choice.beside == [(letter, None)];
        self.choices.iter().find(wanted).map(|choice| choice.meaning)
    }

    /// The sense of M and a number.
    #[inline]
    pub(crate) fn m(&self, code: u16) -> WordMeaning {
        let sense = self.m.get(usize::from(code)).copied().unwrap_or(0);
        self.senses[usize::from(sense)]
    }

    /// What a word as it is written means on its own: `M01`, `STOP`.
    pub fn meaning_of(&self, word: &str) -> Option<Meaning> {
        let sense = match VocabularyCode::of(word) {
            Some(VocabularyCode::G(code)) => self.g(code),
            Some(VocabularyCode::M(number)) => self.m(number),
            None => self.name(word),
        };
        match sense {
            WordMeaning::Means(meaning) => Some(meaning),
            WordMeaning::Unknown | WordMeaning::Refused => None,
        }
    }

    /// What a letter in front of a value means, where it is no axis.
    #[inline]
    pub(crate) fn letter(&self, letter: u8) -> Option<Meaning> {
        self.letters.get(usize::from(letter.wrapping_sub(b'A'))).copied().flatten()
    }

    /// What a name means.
    pub(crate) fn name(&self, name: &str) -> WordMeaning {
        self.names.get(name).copied().unwrap_or(WordMeaning::Unknown)
    }

    /// What a name means in a block with these codes.
    pub(crate) fn name_beside(&self, name: &str, codes: &[GCode]) -> WordMeaning {
        let mut beside = self.names_beside.iter();
        let found = beside.find(|(code, known, _)| known == name && codes.contains(code));
        found.map_or_else(|| self.name(name), |(_, _, meaning)| WordMeaning::Means(*meaning))
    }

    /// The values of a call that the dialect names with some: 2 of `TRAORI(2)`, 91 of `#KIN ID [91]`; the first, if it names
    /// none.
    pub(crate) fn values_of_call(&self, name: &str) -> Vec<f64> {
        let values = |known: &String| -> Option<Vec<f64>> {
            let behind = known.get(known.find(name)? + name.len()..)?.trim_start();
            let inside = behind.strip_prefix(['(', '['])?.split([')', ']']).next()?;
            inside.split(',').map(|value| value.trim().parse().ok()).collect()
        };
        self.names.keys().find_map(values).unwrap_or_else(|| vec![1.0])
    }

    /// A name that means this, the first of the alphabet.
    pub(crate) fn name_of(&self, meaning: Meaning) -> Option<&str> {
        let mut names = self.names.iter();
        let found = names.find(|(_, sense)| **sense == WordMeaning::Means(meaning));
        found.map(|(name, _)| name.as_str())
    }

    /// What a name with nothing between its parentheses means.
    pub(crate) fn empty_call(&self, name: &str) -> WordMeaning {
        self.empty.get(name).map_or_else(|| self.name(name), |meaning| WordMeaning::Means(*meaning))
    }

    /// A word of the dialect.
    fn add(&mut self, word: &str, meaning: Meaning) {
        if matches!(meaning, Meaning::Remark | Meaning::RemarkOpen | Meaning::RemarkClose) {
            return;
        }
        if let [letter @ b'A'..=b'Z'] | [letter @ b'A'..=b'Z', b'='] = word.as_bytes() {
            self.letters[usize::from(letter - b'A')] = Some(meaning);
            return;
        }
        if let Some(name) = word.strip_suffix("()") {
            self.empty.insert(name.to_owned(), meaning);
            return;
        }
        // `G5` of `G505` to `G599`.
        if self.language == Language::Names && word == "G5" && meaning == Meaning::WorkOffset {
            for number in 505..=599 {
                self.add_sense(&format!("G{number}"), WordMeaning::Means(meaning));
            }
            return;
        }
        self.add_sense(word, WordMeaning::Means(meaning));
    }

    /// A word and its sense; it takes the place of what was said of it before.
    fn add_sense(&mut self, word: &str, sense: WordMeaning) {
        let mut parts = word.split_whitespace();
        let first = parts.next().unwrap_or_default();
        let second = word.get(first.len()..).unwrap_or_default().trim_start();
        if let (Some(VocabularyCode::G(code)), true, WordMeaning::Means(meaning)) =
            (VocabularyCode::of(first), second.starts_with(','), sense)
        {
            self.names_beside.push((code, second.to_owned(), meaning));
            return;
        }
        let Some(code) = VocabularyCode::of(first) else {
            // `MCALL CYCLE81` is known by the name of its cycle.
            let name = word.strip_prefix("MCALL ").unwrap_or(word);
            self.names.insert(name.trim_end_matches('=').to_owned(), sense);
            return;
        };
        if let (
            WordMeaning::Means(said @ (Meaning::OwnAxisWords | Meaning::NoAxisWords)),
            VocabularyCode::G(code),
        ) = (sense, code)
        {
            self.axis_words.retain(|(known, _)| *known != code);
            self.axis_words.push((code, said.axis_words()));
            if self.g(code) != WordMeaning::Unknown {
                return;
            }
        }
        let beside: Vec<(u8, Option<f64>)> = parts.filter_map(beside).collect();
        let place = self.place(sense);
        let entry = match code {
            VocabularyCode::G(code) => self.g.get_mut(code.index()),
            VocabularyCode::M(number) => self.m.get_mut(usize::from(number)),
        };
        // What other words stand beside takes the plain word's place only where that has no sense.
        if let Some(entry) = entry
            && (*entry == 0 || beside.is_empty() || matches!(code, VocabularyCode::M(_)))
        {
            // What the language says of a code does not hold where the dialect's means something else.
            if let VocabularyCode::G(code) = code
                && *entry != 0
                && *entry != place
            {
                self.axis_words.retain(|(known, _)| *known != code);
            }
            *entry = place;
        }
        if let (VocabularyCode::G(code), WordMeaning::Means(meaning), false) =
            (code, sense, beside.is_empty())
        {
            self.choices.push(CodeChoice { code, beside, meaning });
        }
    }

    /// Place of a sense in the table of senses.
    fn place(&mut self, sense: WordMeaning) -> u8 {
        let found = self.senses.iter().position(|known| *known == sense);
        let place = found.unwrap_or(self.senses.len());
        if found.is_none() {
            self.senses.push(sense);
        }
        // There are fewer senses than meanings and a dozen more.
        u8::try_from(place).unwrap_or(0)
    }
}

/// A code that a vocabulary names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum VocabularyCode {
    G(GCode),
    M(u16),
}

impl VocabularyCode {
    /// `G43.4`, `M6`; none of any other word.
    fn of(word: &str) -> Option<Self> {
        let (letter, number) = (word.as_bytes().first()?, word.get(1..)?);
        if !matches!(letter, b'G' | b'M') || !number.starts_with(|c: char| c.is_ascii_digit()) {
            return None;
        }
        let code = GCode::nearest(number.parse().ok()?)?;
        Some(if *letter == b'G' { Self::G(code) } else { Self::M(code.parts().0) })
    }
}

/// `Q1` as Q and 1, `P` as P alone; none for what is no word.
fn beside(word: &str) -> Option<(u8, Option<f64>)> {
    let letter = *word.as_bytes().first()?;
    let value = word.get(1..)?;
    letter.is_ascii_uppercase().then_some(())?;
    if value.is_empty() {
        return Some((letter, None));
    }
    Some((letter, Some(value.parse().ok()?)))
}

/// What a reader must know.
fn syntax(words: &[VocabularyWord], language: Language, writes: Capabilities) -> NcSyntax {
    let first = |meaning: Meaning| {
        let mut words = words.iter().filter(|word| word.meaning == meaning);
        words.next().and_then(|word| word.word.chars().next())
    };
    let remarks = words.iter().filter(|word| word.meaning == Meaning::Remark);
    let mut line_remarks: Vec<String> = remarks.map(|word| word.word.to_string()).collect();
    // It ends a block of the letters' controls, and begins a remark of all others but robots.
    let said = line_remarks.iter().any(|remark| remark == ";");
    if language != Language::Joints && !said {
        line_remarks.push(";".to_owned());
    }
    NcSyntax {
        notation: match language {
            Language::Conversational => Notation::Conversational,
            Language::Joints => Notation::Statements,
            _ => Notation::Words,
        },
        line_remarks,
        semicolon_ends: language == Language::Macro && !said,
        enclosed_remarks: first(Meaning::RemarkOpen).zip(first(Meaning::RemarkClose)),
        hash_variables: matches!(language, Language::Macro | Language::Rs274)
            && !writes.has(Capabilities::COMMAND_A_LINE),
        instructions: language == Language::Instructions,
    }
}
