//! The options that the engine knows, for a dialect to declare those that it offers.

use post_plugin::{OptionKind, OptionSpec, Setup, Value};

/// The options that most controls of the family have, after those of the dialect's own.
#[macro_export]
macro_rules! iso_options {
    ($($own:expr,)*) => {
        &[
            $($own,)*
            $crate::options::BLOCK_NUMBERS,
            $crate::options::BLOCK_STEP,
            $crate::options::LEADING_ZEROS,
            $crate::options::decimals(3),
            $crate::options::decimals_inch(4),
            $crate::options::rotary_decimals(3),
            $crate::options::WORD_DECIMALS,
            $crate::options::TRAILING_ZEROS,
            $crate::options::feed_decimals(1),
            $crate::options::RETRACT,
            $crate::options::RESTART,
            $crate::options::PARAMETERS,
            $crate::options::LENGTH_REGISTER,
            $crate::options::CLAMPS,
            $crate::options::COOLANT_OFF,
            $crate::options::COOLANT_THROUGH,
            $crate::options::COOLANT_THROUGH_OFF,
            $crate::options::COOLANT_AIR,
            $crate::options::COOLANT_AIR_OFF,
        ]
    };
}

/// N numbers.
pub const BLOCK_NUMBERS: OptionSpec = OptionSpec {
    key: "block_numbers",
    kind: OptionKind::Choice(&["none", "all", "tools"]),
    default: Value::Text("none"),
    help: "N in front of every block, of those that change the tool, or of none.",
};
/// The step between them.
pub const BLOCK_STEP: OptionSpec =
    OptionSpec::integer("block_step", (1, 1000), 10, "From one N to the next.");
/// Zeros at the end of axis words.
pub const TRAILING_ZEROS: OptionSpec =
    OptionSpec::flag("trailing_zeros", true, "X10.000 instead of X10.");
/// Coolant through the tool.
pub const COOLANT_THROUGH: OptionSpec =
    OptionSpec::text("coolant_through", "", "M codes of coolant through the tool.");
/// Air.
pub const COOLANT_AIR: OptionSpec = OptionSpec::text("coolant_air", "", "M codes of air.");
/// The end of coolant through the tool.
pub const COOLANT_THROUGH_OFF: OptionSpec = OptionSpec::text(
    "coolant_through_off",
    "",
    "M codes that end it; empty: those of coolant_off.",
);
/// The end of air.
pub const COOLANT_AIR_OFF: OptionSpec =
    OptionSpec::text("coolant_air_off", "", "M codes that end it; empty: those of coolant_off.");
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

/// Decimals of single words.
pub const WORD_DECIMALS: OptionSpec = OptionSpec::text(
    "word_decimals",
    "",
    "Decimals of single axis words, in the place of the above: \"A=4 X=2\".",
);
/// Blanks between words.
pub const SPACES: OptionSpec = OptionSpec::flag(
    "spaces",
    true,
    "Blanks between the words of a block; lines of your own stay as they are.",
);
/// G01.
pub const LEADING_ZEROS: OptionSpec =
    OptionSpec::flag("leading_zeros", false, "G01 and M06 instead of G1 and M6.");
/// A safe state after each tool change.
pub const RESTART: OptionSpec = OptionSpec::flag(
    "restart",
    false,
    "Everything modal is stated again behind each tool change, so that a program can be started there.",
);
/// Smoothing.
pub const fn smoothing(default: &'static str) -> OptionSpec {
    OptionSpec::lines(
        "smoothing",
        default,
        "Levels of smoothing, one a line: a tolerance in mm and its words, {} for the tolerance that is asked for. The \
         level with the largest tolerance up to that is written; empty: none is.",
    )
}
/// The end of smoothing.
pub const fn smoothing_off(default: &'static str) -> OptionSpec {
    OptionSpec::lines("smoothing_off", default, "What ends smoothing.")
}
/// Clamps.
pub const CLAMPS: OptionSpec = OptionSpec::lines(
    "clamps",
    "",
    "Clamps of rotary axes, one a line: the axis, what clamps it, what lets it go, as `C M10 M11`; empty: those of the \
     axes in the machine file.",
);
/// Tapping.
pub const fn tapping(default: &'static str) -> OptionSpec {
    OptionSpec {
        key: "tapping",
        kind: OptionKind::Choice(&["rigid", "floating"]),
        default: Value::Text(default),
        help: "The spindle turns with the feed axis, or the tap is held by a compensating chuck.",
    }
}
/// Tapping on a control where nothing may be taken for granted.
pub const TAPPING_NAMED: OptionSpec = OptionSpec {
    key: "tapping",
    kind: OptionKind::Choice(&["", "rigid", "floating"]),
    default: Value::Text(""),
    help: "The spindle turns with the feed axis, or the tap is held by a compensating chuck: must be named where the program \
           taps, since the control's parameters decide what a bare G84 does.",
};
/// The shift of fine boring.
pub const BORE_SHIFT: OptionSpec = OptionSpec::number(
    "bore_shift",
    (0.0, 10.0),
    0.0,
    "Q of the cycles that draw the tool off the wall, mm, in the direction that the control's parameters say; 0: these \
     cycles are not written.",
);
/// Cycles and arcs in a tilted plane.
pub const fn cycles_in_plane(default: bool) -> OptionSpec {
    OptionSpec::flag(
        "cycles_in_plane",
        default,
        "The control takes cycles, arcs and cutter compensation in a tilted plane.",
    )
}
/// Tilted planes, where they are not beyond doubt.
pub const PLANES: OptionSpec = OptionSpec::flag(
    "planes",
    false,
    "The control has tilted planes by these words; else none are written.",
);
/// Inverse time, where it is not beyond doubt.
pub const INVERSE_TIME: OptionSpec = OptionSpec::flag(
    "inverse_time",
    false,
    "The control has inverse time (G93); else feeds are written a minute.",
);
/// Tool vectors.
pub const TOOL_VECTOR: OptionSpec = OptionSpec::flag(
    "tool_vector",
    false,
    "Under tool centre point control I J K of the tool in the place of rotary words: the control chooses where its \
     axes stand.",
);
/// Splines.
pub const SPLINES: OptionSpec = OptionSpec::flag(
    "splines",
    false,
    "The control has splines: those of the CL file are written as such.",
);
/// The O number.
pub const fn program_number(most: i64) -> OptionSpec {
    OptionSpec::integer("program_number", (1, most), 1000, "The O number.")
}
/// H of a program that loads no tool.
pub const LENGTH_REGISTER: OptionSpec = OptionSpec::integer(
    "length_register",
    (0, 999),
    0,
    "H of a program that loads no tool; 0: such a program is refused.",
);

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
    OptionSpec::integer("rotary_decimals", (1, 6), default, "Of rotary words, degrees.")
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
