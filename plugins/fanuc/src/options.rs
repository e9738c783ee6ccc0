//! The options of `[control.fanuc]`.

use post_plugin::OptionSpec;

pub(crate) const OPTIONS: &[OptionSpec] = &[
    OptionSpec::integer("program_number", (1, 9999), 1000, "The O number."),
    OptionSpec::flag("block_numbers", false, "N in front of every block."),
    OptionSpec::integer("block_step", (1, 1000), 10, "From one N to the next."),
    OptionSpec::integer("decimals", (1, 6), 3, "Of linear words, mm."),
    OptionSpec::integer("decimals_inch", (1, 6), 4, "Of linear words, inch."),
    OptionSpec::integer("rotary_decimals", (1, 6), 3, "Of rotary words, degrees."),
    OptionSpec::flag("trailing_zeros", true, "X10.000 instead of X10."),
    OptionSpec::integer("feed_decimals", (0, 4), 1, "Of F under G94."),
    OptionSpec::integer("inverse_time_decimals", (0, 6), 3, "Of F under G93."),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    OptionSpec::text(
        "retract",
        "",
        "Block that clears the depth axis; empty: G91 G28 with its word. G90 follows.",
    ),
    OptionSpec::text(
        "home",
        "",
        "Block after the retract at the end and at GOHOME: G91 G28 X0. Y0. G90 follows.",
    ),
    OptionSpec::integer(
        "length_register",
        (0, 999),
        0,
        "H of a program that loads no tool; 0: such a program is refused.",
    ),
    OptionSpec::text("coolant_off", "M9", "M codes that end all coolant."),
    OptionSpec::text(
        "coolant_through",
        "",
        "M codes of coolant through the tool.",
    ),
    OptionSpec::text("coolant_air", "", "M codes of air."),
];
