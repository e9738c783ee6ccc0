//! Which names of axes a control's language can write.

use crate::setup::Setup;

/// Names that a control has for axes. Any other letter means something else to it, and a number after the letter
/// runs together with the value: `X1450.` is X at 1450.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisNames {
    /// The letters that are axes.
    pub letters: &'static str,
    /// A letter with a number (`X1`) is an axis too: [`Axes`](crate::Axes) writes `X1=450.`
    pub numbered: bool,
}

impl AxisNames {
    /// X Y Z, the axes that slide beside them and the three that turn: the letters of ISO 841 that every control has.
    pub const ISO: AxisNames = AxisNames { letters: "XYZABCUVW", numbered: false };

    /// Those of a printer's firmware, whose E is what its extruder pushes out.
    pub const PRINTER: AxisNames = AxisNames { letters: "XYZABCUVWE", numbered: false };

    /// Can the control write every axis of the program?
    ///
    /// # Errors
    /// The sentence for the user, about the first axis that it cannot write. It begins with `axis NAME:`, by which
    /// the host finds the axis in the machine file.
    pub fn check(&self, setup: &Setup<'_>) -> Result<(), String> {
        for word in setup.words {
            let mut rest = word.name.chars();
            let Some(first) = rest.next() else {
                continue;
            };
            let known = self.letters.contains(first);
            let number = rest.as_str();
            if known && (number.is_empty() || self.numbered) {
                continue;
            }
            let name = word.name;
            let why = match known {
                true => format!("it would read {name}450. as {first} at {number}450."),
                false => format!("{name} means something else to it"),
            };
            let letters: Vec<String> = self.letters.chars().map(String::from).collect();
            return Err(format!(
                "axis {name}: this control has the axes {} alone, and {why}: rename the axis, in the chain too",
                letters.join(" ")
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::AxisWord;

    fn check(names: AxisNames, axes: &[&str]) -> Result<(), String> {
        let words: Vec<AxisWord<'_>> =
            axes.iter().map(|name| AxisWord { name, ..AxisWord::default() }).collect();
        names.check(&Setup { words: &words, ..Setup::default() })
    }

    #[test]
    fn a_number_behind_a_letter_needs_the_equals_sign() {
        assert_eq!(check(AxisNames::ISO, &["X", "Y", "Z", "W", "C"]), Ok(()));
        assert_eq!(
            check(AxisNames::ISO, &["X", "X1"]).unwrap_err(),
            "axis X1: this control has the axes X Y Z A B C U V W alone, and it would read X1450. as X at 1450.: \
             rename the axis, in the chain too"
        );
        let numbered = AxisNames { numbered: true, ..AxisNames::ISO };
        assert_eq!(check(numbered, &["X", "X1"]), Ok(()));
        let refused = check(numbered, &["Q1"]).unwrap_err();
        assert!(refused.contains("Q1 means something else to it"), "{refused}");
    }
}
