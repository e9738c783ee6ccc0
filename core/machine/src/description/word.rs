//! `[word.X]`: words of the program that are no axis values.

use std::collections::BTreeMap;

use post_grammar::text::excerpt;
use post_grammar::{parse_expression, parse_inequality};
use toml::Spanned;

use super::Axis;
use super::build::Builder;
use super::file::MachineFile;
use super::keys::axes_are;
use super::quantity::KeyedNumber;
use super::table::keys;
use crate::along_word::AlongWord;
use crate::axis_formula::FormulaNames;
use crate::dependent_limit::{DependentLimit, Named, SHOWN};
use crate::kinematics::{Joints, MAX_AXES};
use crate::word_map::WordMap;

keys! {
    /// A word of the program that is no axis value.
    WordFile {
        /// What it is: a sum of multiples of axes, each as the control would show it without this, such as `"2 * X"` (a
        /// diameter) or `"J3 - J2"` (the angle of an arm against the horizontal). Of a linear axis a multiple of itself. Of a
        /// letter that no axis has a multiple of `s`, the way of the tip in cuts: `"0.0333 * s"`, for an extruder E.
        is: Spanned<String>,
        /// Least and largest value of the word, mm or degrees, in coordinates of the machine; the travel of its axis holds
        /// besides.
        travel: Option<Spanned<[KeyedNumber; 2]>>,
    }
}

/// The way of the tip in cuts, in `is`.
const WAY: &str = "s";

/// Letters of words that may go with it.
const ALONG: [&str; 7] = ["A", "B", "C", "E", "U", "V", "W"];

impl Builder<'_> {
    /// What words make of the values of `axes`; none where each is its own. Limits of words are put to `limits`.
    pub(super) fn word_map(
        &mut self,
        file: &BTreeMap<Spanned<String>, Spanned<WordFile>>,
        axes: &[Axis],
        limits: &mut Vec<DependentLimit>,
    ) -> Option<WordMap> {
        let mut rows = [Joints::default(); MAX_AXES];
        for (place, row) in rows.iter_mut().enumerate() {
            row[place] = 1.0;
        }
        let first = file.keys().next()?;
        for (name, word) in file {
            if self.way_of_the_tip(&word.get_ref().is).is_some() {
                continue;
            }
            let Some(place) = axes.iter().position(|axis| axis.name == *name.get_ref()) else {
                let name_text = excerpt(name.get_ref(), SHOWN);
                let message =
                    format!("[word.{name_text}] is the word of no axis; {}", axes_are(axes));
                let help = "a word has the name of the axis that it moves";
                self.fault("machine-axis-word", name.span(), message, help);
                continue;
            };
            if axes[place].signed {
                let message = format!("the sign of the word of {} is its way", axes[place].name);
                self.fault("machine-axis-word", name.span(), message, "leave its [word] out");
            }
            if let Some(row) = self.word_row(place, &word.get_ref().is, axes) {
                rows[place] = row;
                self.word_travel(word.get_ref(), axes, limits);
            }
        }
        let map = WordMap::new(rows);
        if map.is_none() {
            let message = "the words of [word] do not tell where the axes stand".to_owned();
            let help =
                "each word is a sum in which its own axis stands, and no word follows from others";
            self.fault("machine-axis-word", first.span(), message, help);
        }
        map.filter(|map| (0..axes.len()).any(|place| !map.is_plain(place)))
    }

    /// The word of no axis that goes with the way of the tip.
    pub(super) fn along(&mut self, file: &MachineFile, axes: &[Axis]) -> Option<AlongWord> {
        let mut found = None;
        for (name, word) in &file.word {
            let Some(per_way) = self.way_of_the_tip(&word.get_ref().is) else {
                continue;
            };
            let letter = name.get_ref();
            let drawn_back =
                file.rewind.as_ref().is_some_and(|rewind| rewind.get_ref().retract_feed.is_some());
            let lack = if axes.iter().any(|axis| axis.name == *letter) {
                Some("it is the word of an axis")
            } else if !ALONG.contains(&letter.as_str()) {
                Some("E, U, V, W, A, B or C can be such a word")
            } else if word.get_ref().travel.is_some() {
                Some("it has no travel")
            } else if found.is_some() {
                Some("one word alone can go with the way of the tip")
            } else if axes.len() >= MAX_AXES {
                Some("there are as many axes as a block has words")
            } else if drawn_back {
                Some("[rewind] retract_feed would push out on the way back: leave it to rapid")
            } else {
                None
            };
            if let Some(lack) = lack {
                let text = excerpt(letter, SHOWN);
                let message = format!("[word.{text}] cannot go with the way of the tip: {lack}");
                self.fault("machine-axis-word", name.span(), message, "");
                continue;
            }
            found = Some(AlongWord { name: letter.clone(), per_way });
        }
        found
    }

    /// What `is` multiplies the way of the tip by, if it is a multiple of that.
    fn way_of_the_tip(&self, is: &Spanned<String>) -> Option<f64> {
        let expression = parse_expression(is.get_ref()).ok()?;
        let form = expression.linear_form(&|name| self.values.get(name).copied())?;
        let [(name, per_way)] = form.terms.as_slice() else {
            return None;
        };
        let plain = name == WAY && form.constant == 0.0 && *per_way > 0.0;
        plain.then_some(*per_way)
    }

    /// What each axis is multiplied by in the word of the axis at `place`.
    fn word_row(&mut self, place: usize, is: &Spanned<String>, axes: &[Axis]) -> Option<Joints> {
        let text = excerpt(is.get_ref(), SHOWN);
        let own = &axes[place];
        let expression = match parse_expression(is.get_ref()) {
            Ok(expression) => expression,
            Err(fault) => {
                let message = format!("`{text}`: {}", fault.message);
                self.fault("machine-axis-word", is.span(), message, "");
                return None;
            }
        };
        let Some(form) = expression.linear_form(&|name| self.values.get(name).copied()) else {
            let message = format!("`{text}` is no sum of multiples of axes");
            let help = "2 * X, J3 - J2, 0.5 * A + B";
            self.fault("machine-axis-word", is.span(), message, help);
            return None;
        };
        let mut row = Joints::default();
        let mut fault = None;
        for (name, multiple) in &form.terms {
            match axes.iter().position(|axis| axis.name == *name) {
                None => {
                    fault = Some(format!(
                        "{name} is neither an axis nor a parameter; {}",
                        axes_are(axes)
                    ));
                }
                Some(other)
                    if other != place && !(own.joint.rotary && axes[other].joint.rotary) =>
                {
                    fault = Some(format!(
                        "{} and {name} do not both turn; a word of a linear axis is a multiple of it alone",
                        own.name
                    ));
                }
                Some(other) => row[other] = *multiple,
            }
        }
        if form.constant != 0.0 {
            fault = Some(format!(
                "{} is added; [axis.{}] zero says what it shows at the drawing's zero",
                form.constant, own.name
            ));
        }
        if row[place] == 0.0 {
            fault.get_or_insert(format!("{} does not stand in its own word", own.name));
        }
        if form.terms.len() == 1 && row[place] < 0.0 {
            let name = &own.name;
            fault.get_or_insert(format!(
                "{name} counts the other way; [axis.{name}] reversed = true says so"
            ));
        }
        let shows = |joint: usize| row[joint] != 0.0 && axes[joint].range.is_some();
        let plain = row[place] == 1.0 && form.terms.len() == 1;
        if !plain && (0..axes.len()).any(shows) {
            fault.get_or_insert(
                "an axis that shows one turn (range) has a word of its own".to_owned(),
            );
        }
        match fault {
            Some(fault) => {
                self.fault("machine-axis-word", is.span(), format!("`{text}`: {fault}"), "");
                None
            }
            None => Some(row),
        }
    }

    /// Travel of a word, as limits that depend on its axes.
    fn word_travel(&mut self, word: &WordFile, axes: &[Axis], limits: &mut Vec<DependentLimit>) {
        let Some(travel) = &word.travel else {
            return;
        };
        let is = word.is.get_ref();
        let [least, most] = [0, 1].map(|end| self.number(&travel.get_ref()[end]));
        if least >= most {
            let message =
                format!("the travel goes from {least} to {most}: the first must be the smaller");
            self.fault("machine-travel", travel.span(), message, "travel = [least, most]");
        }
        for keep in [format!("{is} >= {least}"), format!("{is} <= {most}")] {
            let Ok(inequality) = parse_inequality(&keep) else {
                continue;
            };
            let names = inequality.references().into_iter().filter_map(|(_, name)| {
                let axis = axes.iter().position(|axis| axis.name == name);
                let named = match axis {
                    Some(joint) => Named::of(joint, &axes[joint]),
                    None => Named::Parameter(self.values.get(name).copied()?),
                };
                Some((name.to_owned(), named))
            });
            let names = FormulaNames { named: names.collect(), formulas: Vec::new() };
            limits.push(DependentLimit::new(&keep, inequality, names));
        }
    }
}
