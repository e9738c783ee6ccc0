//! The options of `[control.linuxcnc]`.

use post_plugin::OptionSpec;

pub(crate) const OPTIONS: &[OptionSpec] = &[
    OptionSpec::flag("percent", false, "% before and after the program."),
    OptionSpec::flag("block_numbers", false, "N in front of every block."),
    OptionSpec::integer("block_step", (1, 1000), 10, "From one N to the next."),
    OptionSpec::integer("decimals", (1, 6), 4, "Of linear words, mm."),
    OptionSpec::integer("decimals_inch", (1, 6), 5, "Of linear words, inch."),
    OptionSpec::integer("rotary_decimals", (1, 6), 4, "Of rotary words, degrees."),
    OptionSpec::integer("feed_decimals", (0, 4), 1, "Of F under G94."),
    OptionSpec::integer("inverse_time_decimals", (0, 6), 4, "Of F under G93."),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G59.1 to G59.3."),
    // G64 leaves the path by up to P, and P speaks of X Y Z alone, so no certificate could hold.
    OptionSpec::number(
        "blend",
        (0.0, 10.0),
        0.0,
        "P of G64, program units: the control leaves the path by up to as much; 0: G61, exact path.",
    ),
    OptionSpec::text(
        "retract",
        "",
        "Block that clears the depth axis; empty: G53 G0 with its word at 0.",
    ),
    OptionSpec::text(
        "home",
        "",
        "Block after the retract at the end and at GOHOME.",
    ),
    OptionSpec::text(
        "tcp_on",
        "M428",
        "Remap that switches to the TCP kinematics.",
    ),
    OptionSpec::text("tcp_off", "M429", "Remap that switches back."),
    OptionSpec::text(
        "coolant_through",
        "",
        "M codes of coolant through the tool.",
    ),
    OptionSpec::text("coolant_air", "", "M codes of air."),
];
