//! The options of `[control.heidenhain]`.

use post_plugin::{OptionKind, OptionSpec, Value};

/// Help of an option for a coolant with an end of its own.
const END: &str = "M codes that end it; empty: those of coolant_off.";

const fn choice(
    key: &'static str,
    choices: &'static [&'static str],
    default: &'static str,
    help: &'static str,
) -> OptionSpec {
    OptionSpec { key, kind: OptionKind::Choice(choices), default: Value::Text(default), help }
}

pub(crate) const OPTIONS: &[OptionSpec] = &[
    OptionSpec::integer("decimals", (1, 4), 3, "Of linear words, mm."),
    OptionSpec::integer("decimals_inch", (1, 4), 4, "Of linear words, inch."),
    OptionSpec::integer("rotary_decimals", (1, 4), 3, "Of rotary words, degrees."),
    OptionSpec::integer("feed_decimals", (0, 3), 0, "Of F, mm or degrees a minute."),
    OptionSpec::integer(
        "feed_decimals_inch",
        (0, 3),
        2,
        "Of F in tenths of an inch a minute: an inch program.",
    ),
    OptionSpec::integer(
        "preset",
        (-1, 99_999),
        1,
        "Datum number of CYCL DEF 247; -1: the preset that the operator activated.",
    ),
    choice(
        "rotary_way",
        &["M127", "M126"],
        "M127",
        "M127: the way that is programmed; M126: the shortest, for a display below 360.",
    ),
    OptionSpec::flag(
        "reset",
        true,
        "M129, PLANE RESET and the cycles 7, 8, 10, 11 at the start cancel what was in force before.",
    ),
    OptionSpec::lines(
        "retract",
        "",
        "Block that takes the place of the retract in machine coordinates (M140 MB MAX): nobody proves where it leads.",
    ),
    OptionSpec::lines("tcp_on", "M128", "Block that switches TCP on."),
    OptionSpec::lines("tcp_off", "M129", "Block that switches TCP off."),
    choice(
        "tcp_form",
        &["M128", "TCPM"],
        "M128",
        "TCPM: FUNCTION TCPM and FUNCTION RESET TCPM, where tcp_on and tcp_off are left alone.",
    ),
    OptionSpec::flag(
        "tool_vectors",
        false,
        "LN with TX TY TZ in the place of rotary words under TCP: the control finds their values by itself.",
    ),
    choice("control", &["TNC640", "iTNC530", "TNC7"], "TNC640", "iTNC530: cycles without Q395."),
    choice("language", &["English", "German"], "English", "Dialogue language: names of cycles."),
    choice(
        "tapping",
        &["rigid", "floating"],
        "rigid",
        "Cycle 207, or 206 with a compensating chuck.",
    ),
    OptionSpec::number(
        "chip_break",
        (0.1, 99.0),
        0.2,
        "Q256: how far cycle 203 draws back to break the chip, mm.",
    ),
    OptionSpec::integer(
        "bore_direction",
        (0, 4),
        0,
        "Q214: fine boring lifts off along 1 X-, 2 Y-, 3 X+, 4 Y+; 0: it is not written as a cycle.",
    ),
    OptionSpec::number(
        "bore_angle",
        (0.0, 360.0),
        0.0,
        "Q336 of cycle 202: where the spindle stops, degrees.",
    ),
    OptionSpec::text(
        "plane",
        "TURN FMAX",
        "Behind the angles of PLANE SPATIAL: STAY, TURN FMAX, MOVE DIST50 FMAX, with SEQ+, SEQ-, TABLE ROT.",
    ),
    choice(
        "datum_shift",
        &["cycle 7", "TRANS DATUM"],
        "cycle 7",
        "How a plane's origin is written.",
    ),
    OptionSpec::flag(
        "tool_names",
        false,
        "TOOL CALL \"NAME\" for a tool that has a name, in the place of its number; `_` for what its names cannot have.",
    ),
    OptionSpec::flag(
        "blk_form",
        false,
        "BLK FORM at the start: where the tool goes, for the control's graphics.",
    ),
    OptionSpec::text("coolant_mist", "", "M codes of mist."),
    OptionSpec::text("coolant_through", "", "M codes of coolant through the tool."),
    OptionSpec::text("coolant_air", "", "M codes of air."),
    OptionSpec::text("coolant_mist_off", "", END),
    OptionSpec::text("coolant_through_off", "", END),
    OptionSpec::text("coolant_air_off", "", END),
    OptionSpec::text("coolant_off", "M9", "M codes that end all coolant."),
];
