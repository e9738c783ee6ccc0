//! The options that the engine knows, for a dialect to declare those that it offers.

use post_plugin::{OptionSpec, Setup, Value};

/// N numbers.
pub const BLOCK_NUMBERS: OptionSpec =
    OptionSpec::flag("block_numbers", false, "N in front of every block.");
/// The step between them.
pub const BLOCK_STEP: OptionSpec =
    OptionSpec::integer("block_step", (1, 1000), 10, "From one N to the next.");
/// Zeros at the end of axis words.
pub const TRAILING_ZEROS: OptionSpec =
    OptionSpec::flag("trailing_zeros", true, "X10.000 instead of X10.");
/// Coolant through the tool.
pub const COOLANT_THROUGH: OptionSpec = OptionSpec::text(
    "coolant_through",
    "",
    "M codes of coolant through the tool.",
);
/// Air.
pub const COOLANT_AIR: OptionSpec = OptionSpec::text("coolant_air", "", "M codes of air.");
/// The end of coolant through the tool.
pub const COOLANT_THROUGH_OFF: OptionSpec = OptionSpec::text(
    "coolant_through_off",
    "",
    "M codes that end it; empty: those of coolant_off.",
);
/// The end of air.
pub const COOLANT_AIR_OFF: OptionSpec = OptionSpec::text(
    "coolant_air_off",
    "",
    "M codes that end it; empty: those of coolant_off.",
);
/// What the program relies on.
pub const PARAMETERS: OptionSpec = OptionSpec::flag(
    "parameters",
    false,
    "Remarks at the start that name the parameters of the control on which the program relies.",
);
/// The way out in the user's own words.
pub const RETRACT: OptionSpec = OptionSpec::lines(
    "retract",
    "",
    "Block that takes the place of the retract in machine coordinates: nobody proves where it leads.",
);
/// The end of all coolant.
pub const COOLANT_OFF: OptionSpec =
    OptionSpec::text("coolant_off", "M9", "M codes that end all coolant.");

/// Decimals of linear words, mm.
pub const fn decimals(default: i64) -> OptionSpec {
    OptionSpec::integer("decimals", (1, 6), default, "Of linear words, mm.")
}

/// Decimals of linear words, inch.
pub const fn decimals_inch(default: i64) -> OptionSpec {
    OptionSpec::integer("decimals_inch", (1, 6), default, "Of linear words, inch.")
}

/// Decimals of rotary words.
pub const fn rotary_decimals(default: i64) -> OptionSpec {
    OptionSpec::integer(
        "rotary_decimals",
        (1, 6),
        default,
        "Of rotary words, degrees.",
    )
}

/// Decimals of a feed a minute.
pub const fn feed_decimals(default: i64) -> OptionSpec {
    OptionSpec::integer("feed_decimals", (0, 4), default, "Of F under G94.")
}

/// Decimals of an inverse-time feed.
pub const fn inverse_time_decimals(default: i64) -> OptionSpec {
    OptionSpec::integer("inverse_time_decimals", (0, 6), default, "Of F under G93.")
}

/// The largest inverse-time feed.
pub const fn most_inverse_time(default: f64) -> OptionSpec {
    OptionSpec::number(
        "most_inverse_time",
        (0.0, 1e9),
        default,
        "The largest F under G93, 1/min; a block that would need more is slowed down. 0: the control has no end.",
    )
}

/// A whole number, or the table's where the dialect does not offer it.
pub(crate) fn integer(setup: &Setup<'_>, key: &str, table: i64) -> i64 {
    match setup.option(key) {
        Some(Value::Integer(integer)) => integer,
        _ => table,
    }
}

/// A flag, or the table's.
pub(crate) fn flag(setup: &Setup<'_>, key: &str, table: bool) -> bool {
    match setup.option(key) {
        Some(Value::Flag(flag)) => flag,
        _ => table,
    }
}

/// A text, or the table's.
pub(crate) fn text(setup: &Setup<'_>, key: &str, table: &str) -> String {
    match setup.option(key) {
        Some(Value::Text(text)) => text.to_owned(),
        _ => table.to_owned(),
    }
}
