//! Numbers of a block, by the standard library; the scanner reads short ones by itself.

use super::block::NcNumber;
use super::fault::Unreadable;

/// Characters of a number: no control keeps more digits, and a longer one is a fault of whatever wrote it.
const LONGEST: usize = 40;

/// A number without a sign, `.5`, `10.`, `1EX-3`.
pub(super) fn number(text: &str) -> Result<NcNumber, Unreadable> {
    Ok(NcNumber { value: value(text)?, point: text.contains('.') })
}

/// Value of a number as written.
pub(super) fn value(text: &str) -> Result<f64, Unreadable> {
    check(text)?;
    let parsed = match text.split_once("EX") {
        Some((mantissa, exponent)) => format!("{mantissa}e{exponent}").parse::<f64>(),
        None => text.parse::<f64>(),
    };
    match parsed {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(Unreadable::new(format!("{text} is beyond any number a control can hold"))),
    }
}

/// A whole number: of a block, of a program, of a label.
pub(super) fn whole(text: &str) -> Result<u64, Unreadable> {
    check(text)?;
    text.parse::<u64>()
        .map_err(|_| Unreadable::new(format!("{text} is too large for a number of a block")))
}

fn check(text: &str) -> Result<(), Unreadable> {
    if text.len() > LONGEST {
        let message = format!("a number of {} characters, at most {LONGEST} are read", text.len());
        return Err(Unreadable::new(message));
    }
    Ok(())
}

impl NcNumber {
    /// The number, with a minus in front where `negative`.
    pub(super) fn signed(self, negative: bool) -> Self {
        let value = if negative { -self.value } else { self.value };
        Self { value, ..self }
    }
}
