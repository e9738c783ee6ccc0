//! Numbers and times as people are shown them.

use post_plugin::fixed;

/// A number with so many decimals.
pub fn number(value: f64, decimals: u8) -> String {
    let mut text = String::new();
    fixed(&mut text, value, decimals);
    text
}

/// A bound, not negative, with so many decimals: rounded up, but for a thousandth of the last of them.
pub fn at_most(value: f64, decimals: u8) -> String {
    let scale = libm::pow(10.0, f64::from(decimals));
    number(libm::ceil(value * scale - 1e-3) / scale, decimals)
}

/// A bound from below, not negative, with so many decimals: rounded down, but for a thousandth of the last of them.
pub fn at_least(value: f64, decimals: u8) -> String {
    let scale = libm::pow(10.0, f64::from(decimals));
    number(libm::floor(value * scale + 1e-3) / scale, decimals)
}

/// A time as one says it.
pub fn clock(seconds: f64) -> String {
    let whole = seconds as u64;
    let (hours, minutes) = (whole / 3600, whole / 60 % 60);
    if hours > 0 {
        format!("{hours} h {minutes:02} min")
    } else if minutes > 0 {
        format!("{minutes} min {:02} s", whole % 60)
    } else {
        format!("{seconds:.1} s")
    }
}
