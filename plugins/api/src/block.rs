//! Blocks and the axis words in them: what most dialects have in common.
//!
//! Nothing here is needed to write a dialect; it saves an author the usual hundred lines.

mod cut_lines;

use crate::number::{Front, NumberForm};
use crate::{AxisWord, Setup, fixed, quantise};

pub use cut_lines::CutLine;

/// How numbers look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NumberStyle {
    /// `+1.000`: a sign also on what is not negative.
    pub plus: bool,
    /// `F200.`: a point also where there are no decimals.
    pub point: bool,
    /// `10.5` for `10.500`: no zeros at the end.
    pub trim: bool,
}

impl NumberStyle {
    /// Appends `value` with at most `decimals` decimals.
    pub fn write(self, out: &mut String, value: f64, decimals: u8) {
        if !self.look().append(out, Front::NONE, value, decimals) {
            // A number that no machine reaches: as it is.
            fixed(out, value, decimals);
        }
    }

    const fn look(self) -> NumberForm {
        NumberForm { plus: self.plus, trim: self.trim, point: self.point }
    }
}

/// One block under construction, and the numbering of all of them.
#[derive(Clone, Debug)]
pub struct Block {
    words: String,
    prefix: &'static str,
    number: u32,
    step: u32,
    limit: u32,
}

impl Block {
    /// Blocks without numbers.
    pub fn plain() -> Self {
        Block::numbered("", 0, 0, 0)
    }

    /// Blocks with numbers: `prefix` and `first`, then `step` more each. Past `limit` they begin anew
    /// at `step`.
    pub fn numbered(prefix: &'static str, first: u32, step: u32, limit: u32) -> Self {
        Block { words: String::new(), prefix, number: first, step, limit }
    }

    /// Adds a word as it is.
    pub fn word(&mut self, word: &str) -> &mut Self {
        self.words.push(' ');
        self.words.push_str(word);
        self
    }

    /// Adds a word with a whole number: `T1`.
    pub fn integer(&mut self, address: &str, value: u32) -> &mut Self {
        self.number(address, value.into(), 0, NumberStyle::default())
    }

    /// Adds a word with a number: `X12.500`.
    pub fn number(
        &mut self,
        address: &str,
        value: f64,
        decimals: u8,
        style: NumberStyle,
    ) -> &mut Self {
        self.number_behind(Front::blank(address), address, value, decimals, style);
        self
    }

    /// Writes the number after `front`, the address with its blank, if that is short enough.
    fn number_behind(
        &mut self,
        front: Option<Front>,
        address: &str,
        value: f64,
        decimals: u8,
        style: NumberStyle,
    ) {
        let look = style.look();
        let written =
            front.is_some_and(|front| look.append(&mut self.words, front, value, decimals));
        if !written {
            self.word(address);
            style.write(&mut self.words, value, decimals);
        }
    }

    /// Appends the block as a line to `out` and begins the next one. An empty block is not a line.
    pub fn end(&mut self, out: &mut String) {
        if self.words.is_empty() {
            return;
        }
        self.begin(out);
        // Every word has its blank in front; the first needs none.
        out.push_str(&self.words[1..]);
        out.push('\n');
        self.words.clear();
    }

    /// Appends the number of a line.
    #[inline]
    fn begin(&mut self, out: &mut String) {
        if self.step != 0 {
            out.push_str(self.prefix);
            fixed(out, self.number.into(), 0);
            out.push(' ');
            self.number += self.step;
            if self.number > self.limit {
                self.number = self.step;
            }
        }
    }

    /// A block of one word, or of several given as one.
    pub fn line(&mut self, words: &str, out: &mut String) {
        self.word(words).end(out);
    }
}

/// A value that holds until it is changed: `G1`, `F200.`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modal<T>(Option<T>);

impl<T> Default for Modal<T> {
    fn default() -> Self {
        Modal(None)
    }
}

impl<T: PartialEq + Copy> Modal<T> {
    /// Notes `value`; says whether it must be written, since something else, or nothing known, was in force.
    pub fn set(&mut self, value: T) -> bool {
        let changed = self.0 != Some(value);
        self.0 = Some(value);
        changed
    }

    /// `value` is known to be in force.
    pub fn is(&self, value: T) -> bool {
        self.0 == Some(value)
    }

    /// What is in force is not known any more.
    pub fn forget(&mut self) {
        self.0 = None;
    }
}

/// The axis words of a program: their decimals, and which of them a move has to write.
#[derive(Clone, Debug)]
pub struct Axes {
    axes: Vec<AxisState>,
    style: NumberStyle,
    /// Units of the last decimal in the words of a run of cuts, column by column.
    counts: Vec<u32>,
}

#[derive(Clone, Debug)]
struct AxisState {
    name: String,
    /// A blank and the name, if it is short enough.
    front: Option<Front>,
    group: Group,
    decimals: u8,
    /// Whether the words of the axis lie within one turn.
    wrapped: bool,
    /// Rotary, without ends, and its words count turns.
    endless: bool,
    /// How a word says the place within one turn, and the way there; none: as it is.
    modulo: Option<Box<Modulo>>,
    /// Text after the number.
    behind: &'static str,
    /// The word is a coordinate for now, and stands as it is.
    coordinate: bool,
    last: Modal<f64>,
}

/// A word of a control that knows the places of one turn alone.
#[derive(Clone, Debug)]
struct Modulo {
    /// Text in front of the number: by the shorter way, the positive, the negative.
    ways: [String; 3],
    /// The value written last, whole turns counted.
    at: Option<f64>,
    /// The way there is always said, by a sign.
    signed: bool,
}

/// Turns below this are the shorter way, degrees; at half a turn none is.
const SHORTER: f64 = 179.9;

/// Which axis words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The rotary ones.
    Rotary,
    /// The linear ones but the depth.
    Plane,
    /// The linear one along the spindle.
    Depth,
}

impl Axes {
    /// The words of `setup`, with these decimals for linear and rotary ones. A name of more than a letter gets an
    /// equals sign (`X1=450.`); whether the control reads that, [`AxisNames`](crate::AxisNames) says.
    pub fn new(setup: &Setup<'_>, linear: u8, rotary: u8, style: NumberStyle) -> Self {
        let address = |word: &AxisWord<'_>| match word.name.len() {
            0 | 1 => word.name.to_owned(),
            _ => format!("{}=", word.name),
        };
        let axes = setup.words.iter().map(|word| (word, address(word)));
        let axes = axes.map(|(word, name)| {
            let mut axis = AxisState {
                front: Front::blank(&name),
                name,
                group: match (word.rotary, word.depth) {
                    (true, _) => Group::Rotary,
                    (false, true) => Group::Depth,
                    (false, false) => Group::Plane,
                },
                decimals: if word.rotary { rotary } else { linear },
                wrapped: word.wrapped,
                endless: word.rotary && !word.wrapped && !word.signed && word.travel.is_none(),
                modulo: None,
                behind: "",
                coordinate: false,
                last: Modal::default(),
            };
            axis.signs(word.signed);
            axis
        });
        Axes { axes: axes.collect(), style, counts: Vec::new() }
    }

    /// Words of wrapped axes say that the control takes the shorter way, and the place from 0 to below 360, whatever
    /// the machine shows: `C=DC(260.000)` for -100 with `=DC(` and `)`.
    pub fn shorter_way(&mut self, open: &str, close: &'static str) {
        for axis in self.axes.iter_mut().filter(|axis| axis.wrapped) {
            axis.within_turn([open; 3], close);
        }
    }

    /// Words of endless axes say the place within one turn and the way there: `C=DC(280.000)`, or where that is no
    /// shorter `C=ACP(280.000)` and `C=ACN(280.000)`, with these in front of the number and `close` after it.
    pub fn modulo(&mut self, ways: [&str; 3], close: &'static str) {
        for axis in self.axes.iter_mut().filter(|axis| axis.endless) {
            axis.within_turn(ways, close);
        }
    }

    /// A move to `words` turns an axis by so much that [`Axes::modulo`] cannot say it: its name.
    pub fn turns_round(&self, words: &[f64]) -> Option<&str> {
        let far = |(axis, word): &(&AxisState, &f64)| {
            let modulo = axis.modulo.as_ref();
            let before = modulo.and_then(|modulo| modulo.at);
            before.is_some_and(|before| (*word - before).abs() > 360.0 - 1e-9)
        };
        let found = self.axes.iter().zip(words).find(far);
        found.map(|(axis, _)| axis.name.trim_end_matches('='))
    }

    /// Decimals of each word, for [`Format::words`](crate::Format::words).
    pub fn decimals(&self) -> Vec<u8> {
        self.axes.iter().map(|axis| axis.decimals).collect()
    }

    /// Name of the word along the spindle; `Z` if there is none.
    pub fn depth(&self) -> &str {
        self.axes
            .iter()
            .find(|axis| axis.group == Group::Depth)
            .map_or("Z", |axis| axis.name.as_str())
    }

    /// Names of all words along the spindle (a quill beside the main axis).
    pub fn depths(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().filter(|axis| axis.group == Group::Depth).map(|axis| axis.name.as_str())
    }

    /// The word of this place is a linear one, and not that of the depth.
    pub fn is_plane(&self, place: usize) -> bool {
        let axis = self.axes.get(place);
        axis.is_some_and(|axis| axis.group == Group::Plane)
    }

    /// Where the axes stand is not known any more: the next move writes all its words.
    pub fn forget(&mut self) {
        for axis in &mut self.axes {
            axis.last.forget();
        }
    }

    /// Where these axes stand is not known any more: word n where bit n of `axes` is set.
    pub fn forget_some(&mut self, axes: u32) {
        for (place, axis) in self.axes.iter_mut().enumerate() {
            if axes >> place & 1 == 1 {
                axis.last.forget();
            }
        }
    }

    /// Sets the decimals of the word of this name; false if there is none.
    pub fn set_decimals(&mut self, name: &str, decimals: u8) -> bool {
        let named = |axis: &&mut AxisState| axis.name.trim_end_matches('=') == name;
        match self.axes.iter_mut().find(named) {
            Some(axis) => {
                axis.decimals = decimals;
                true
            }
            None => false,
        }
    }

    /// The word of this place stands behind `letter` from here on, as a `coordinate` or as the axis itself; no axis is known
    /// to stand where it did.
    pub fn rename(&mut self, place: usize, letter: &str, coordinate: bool) {
        self.forget();
        if let Some(axis) = self.axes.get_mut(place) {
            letter.clone_into(&mut axis.name);
            axis.front = Front::blank(letter);
            axis.coordinate = coordinate;
        }
    }

    /// A move to `words` has something to write.
    pub fn moved(&self, words: &[f64]) -> bool {
        self.axes.iter().zip(words).any(|(axis, word)| !axis.last.is(*word))
    }

    /// A move to `words` has something to write in this group.
    pub fn moved_group(&self, words: &[f64], group: Group) -> bool {
        self.axes.iter().zip(words).any(|(axis, word)| axis.group == group && !axis.last.is(*word))
    }

    /// Adds all words that have changed.
    pub fn write(&mut self, block: &mut Block, words: &[f64]) {
        for (axis, word) in self.axes.iter_mut().zip(words) {
            axis.write(block, *word, self.style);
        }
    }

    /// Adds positions in machine coordinates: word n where bit n of `axes` is set. Where those axes stand in the
    /// program's coordinates is not known afterwards.
    pub fn write_machine(&mut self, block: &mut Block, axes: u32, words: &[f64]) {
        for (place, (axis, word)) in self.axes.iter_mut().zip(words).enumerate() {
            if axes >> place & 1 == 1 {
                axis.last.forget();
                axis.write(block, *word, self.style);
                axis.last.forget();
            }
        }
    }

    /// Adds the words of one group that have changed.
    pub fn write_group(&mut self, block: &mut Block, words: &[f64], group: Group) {
        for (axis, word) in self.axes.iter_mut().zip(words) {
            if axis.group == group {
                axis.write(block, *word, self.style);
            }
        }
    }
}

impl AxisState {
    /// Has the words say the place within a turn, after one of `ways`.
    fn within_turn(&mut self, ways: [&str; 3], close: &'static str) {
        let name = self.name.trim_end_matches('=');
        let ways = ways.map(|way| format!("{name}{way}"));
        self.modulo = Some(Box::new(Modulo { ways, at: None, signed: false }));
        self.behind = close;
    }

    /// Has the words say the place within a turn, and by a sign the way there, if they do so.
    fn signs(&mut self, signed: bool) {
        if signed {
            self.within_turn(["", "", "-"], "");
        }
        if let Some(modulo) = self.modulo.as_mut() {
            modulo.signed = signed;
        }
    }

    #[inline(always)]
    fn write(&mut self, block: &mut Block, value: f64, style: NumberStyle) {
        if !self.last.set(value) {
            return;
        }
        let written = match self.front {
            Some(front) if self.coordinate || self.modulo.is_none() && self.behind.is_empty() => {
                style.look().append(&mut block.words, front, value, self.decimals)
            }
            _ => false,
        };
        if !written {
            self.write_unusual(block, value, style);
        }
    }

    /// A word that says more than letter and number, or a number that is beyond the usual way.
    #[inline(never)]
    fn write_unusual(&mut self, block: &mut Block, value: f64, style: NumberStyle) {
        match self.modulo.as_mut().filter(|_| !self.coordinate) {
            None => block.number_behind(self.front, &self.name, value, self.decimals, style),
            Some(modulo) => {
                let far = modulo.at.replace(value).map_or(0.0, |at| value - at);
                let way = match far.abs() {
                    ..SHORTER | 360.0.. if !modulo.signed => 0,
                    _ if far >= 0.0 => 1,
                    _ => 2,
                };
                let mut place = within_turn(value, self.decimals);
                // Zero has no sign.
                if modulo.signed && way == 2 && place == 0.0 {
                    place = 360.0;
                }
                block.number_behind(None, &modulo.ways[way], place, self.decimals, style);
            }
        }
        if !self.coordinate {
            block.words.push_str(self.behind);
        }
    }
}

/// An angle from 0 to below 360 degrees, as it is printed.
fn within_turn(value: f64, decimals: u8) -> f64 {
    let printed = |value: f64| quantise(value - 360.0 * (value / 360.0).floor(), decimals);
    let place = printed(value);
    if place < 360.0 { place } else { 0.0 }
}
