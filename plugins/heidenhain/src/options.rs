//! The options of `[control.heidenhain]`.

use post_plugin::{OptionKind, OptionSpec, Value};

/// Of a coolant with an end of its own.
const END: &str = "M codes that end it; empty: those of coolant_off.";

pub(crate) const OPTIONS: &[OptionSpec] = &[
    OptionSpec::integer("decimals", (1, 4), 3, "Of linear words, mm."),
    OptionSpec::integer("decimals_inch", (1, 4), 4, "Of linear words, inch."),
    OptionSpec::integer("rotary_decimals", (1, 4), 3, "Of rotary words, degrees."),
    OptionSpec::integer("feed_decimals", (0, 3), 0, "Of F."),
    OptionSpec::integer(
        "preset",
        (-1, 99_999),
        1,
        "Datum number of CYCL DEF 247; -1: the preset that the operator activated.",
    ),
    OptionSpec {
        key: "rotary_way",
        kind: OptionKind::Choice(&["M127", "M126"]),
        default: Value::Text("M127"),
        help: "M127: the way that is programmed; M126: the shortest, for a display below 360.",
    },
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
    OptionSpec::text("coolant_mist", "", "M codes of mist."),
    OptionSpec::text(
        "coolant_through",
        "",
        "M codes of coolant through the tool.",
    ),
    OptionSpec::text("coolant_air", "", "M codes of air."),
    OptionSpec::text("coolant_mist_off", "", END),
    OptionSpec::text("coolant_through_off", "", END),
    OptionSpec::text("coolant_air_off", "", END),
    OptionSpec::text("coolant_off", "M9", "M codes that end all coolant."),
];
