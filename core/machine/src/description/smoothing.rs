//! By how much the control may leave the path: `[program.smoothing]`.

use super::build::Builder;
use super::program_file::SmoothingFile;
use super::quantity::KeyedNumber;
use crate::diagnostic::Short;

/// Tolerances within which the control may leave the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// Tolerance of the tip, mm.
    pub tolerance: f64,
    /// Tolerance of the tool axis, degrees; none where it does not turn or the file does not say.
    pub axis_tolerance: Option<f64>,
}

/// What holds in which operation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SmoothingRules {
    /// Tolerances in operations that have no rule; none: the control keeps the path as it does by default.
    pub default: Option<Smoothing>,
    /// Tolerances by patterns of the operations' names, in capitals.
    operations: Vec<(String, Smoothing)>,
}

impl SmoothingRules {
    /// Something is smoothed.
    pub fn any(&self) -> bool {
        self.default.is_some() || !self.operations.is_empty()
    }

    /// The largest tolerances that one of them has; none where nothing is smoothed.
    pub fn largest(&self) -> Option<Smoothing> {
        let operations = self.operations.iter().map(|(_, smoothing)| *smoothing);
        operations.chain(self.default).reduce(|most, next| Smoothing {
            tolerance: most.tolerance.max(next.tolerance),
            axis_tolerance: most
                .axis_tolerance
                .into_iter()
                .chain(next.axis_tolerance)
                .reduce(f64::max),
        })
    }

    /// Tolerances in the operation of this name.
    pub fn of(&self, name: &str) -> Option<Smoothing> {
        let name = name.to_uppercase();
        self.operations
            .iter()
            .filter(|(pattern, _)| fits(pattern, &name))
            .max_by_key(|(pattern, _)| pattern.len())
            .map_or(self.default, |(_, smoothing)| Some(*smoothing))
    }
}

/// A text of a pattern in which each `*` stands for any text, or none.
pub fn fits(pattern: &str, text: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else {
        return pattern == text;
    };
    let Some(text) = text.strip_prefix(start) else {
        return false;
    };
    let (middle, end) = rest.rsplit_once('*').unwrap_or(("", rest));
    let Some(mut text) = text.strip_suffix(end) else {
        return false;
    };
    // What stands between two stars is taken where it is met first: that leaves most for those behind it.
    middle.split('*').all(|piece| match text.find(piece) {
        Some(at) => {
            text = &text[at + piece.len()..];
            true
        }
        None => false,
    })
}

impl Builder<'_> {
    pub(super) fn smoothing(&mut self, file: &SmoothingFile) -> SmoothingRules {
        let axis_tolerance = self.checked(&file.axis_tolerance);
        let rule = |tolerance: f64| Smoothing { tolerance, axis_tolerance };
        SmoothingRules {
            default: self.checked(&file.tolerance).map(rule),
            operations: file
                .operations
                .iter()
                .map(|(name, said)| {
                    let tolerance = self.above_zero(name.get_ref(), said);
                    (name.get_ref().to_uppercase(), rule(tolerance))
                })
                .collect(),
        }
    }

    fn above_zero(&mut self, name: &str, quantity: &KeyedNumber) -> f64 {
        let value = self.number(quantity);
        if value <= 0.0 {
            let message = format!("[program.smoothing] {name} is {}", Short(value));
            let help = "a tolerance lies above zero; an operation without smoothing has no rule";
            self.fault("machine-program", quantity.span(), message, help);
        }
        value
    }
}
