//! Numbers as they stand in messages.

use std::fmt;

/// Digits that count.
const DIGITS: i32 = 7;

/// A number in a message: seven digits that count, no zeros after the last of them; very large and very small ones with
/// an exponent. What radians or a file leave in the last bits says nothing to a reader.
#[derive(Clone, Copy, Debug)]
pub struct Short(pub f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = libm::fabs(self.0);
        if size == 0.0 || !size.is_finite() {
            // Without the sign of zero.
            return write!(f, "{}", if size == 0.0 { 0.0 } else { self.0 });
        }
        if !(1e-7..1e9).contains(&size) {
            let text = format!("{:.*e}", DIGITS as usize - 1, self.0);
            let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            return write!(f, "{}e{exponent}", without_zeros(digits));
        }
        let whole = libm::floor(libm::log10(size)) as i32 + 1;
        let decimals = usize::try_from(DIGITS - whole).unwrap_or(0);
        f.write_str(without_zeros(&format!("{:.decimals$}", self.0)))
    }
}

/// `1.500` is `1.5`, `2.000` is `2`.
fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}
