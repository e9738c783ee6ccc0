//! The options of `[control.siemens]`.

use post_iso::options;
use post_plugin::{OptionKind, OptionSpec, Value};

const fn choice(
    key: &'static str,
    choices: &'static [&'static str],
    default: &'static str,
    help: &'static str,
) -> OptionSpec {
    OptionSpec { key, kind: OptionKind::Choice(choices), default: Value::Text(default), help }
}

/// What is in force before the first block, and moves nothing when it is cancelled.
pub(crate) const CANCEL: &str = "TRAFOOF\nTRANS";

pub(crate) const OPTIONS: &[OptionSpec] = &[
    choice(
        "software",
        &["4", "2"],
        "4",
        "4: CYCLE800 with 16 arguments, CYCLE832 with three; 2: the software of 2008, with 15 and two.",
    ),
    OptionSpec::flag(
        "transfer_header",
        false,
        "%_N_NAME_MPF in front of the program, for a transfer by cable.",
    ),
    choice(
        "block_numbers",
        &["none", "all", "tools"],
        "all",
        "N in front of every block, of those that change the tool, or of none.",
    ),
    options::BLOCK_STEP,
    options::decimals(3),
    options::decimals_inch(4),
    options::rotary_decimals(3),
    choice(
        "endless",
        &["modulo", "counted"],
        "modulo",
        "A rotary axis without travel or range: modulo, it is shown from 0 to 359.999 (another value is alarm 16830) and \
         written as DC(), ACP() or ACN(); counted: its words count turns.",
    ),
    options::TRAILING_ZEROS,
    options::feed_decimals(1),
    options::inverse_time_decimals(3),
    OptionSpec::text("work_offset", "G54", "G54 to G57, or G505 to G599."),
    OptionSpec::lines(
        "cancel",
        CANCEL,
        "Blocks at the start that cancel transformation and programmable frames.",
    ),
    options::RETRACT,
    options::PARAMETERS,
    OptionSpec::flag(
        "tool_names",
        false,
        "T=\"NAME\" for a tool that has a name, in the place of its number.",
    ),
    OptionSpec::integer("edge", (1, 12), 1, "D: the cutting edge of every tool."),
    OptionSpec::lines(
        "tcp_on",
        "",
        "Blocks that switch TCP on; empty: TRAORI, and ORIMKS ORIAXES, with tool_vectors ORIWKS ORIAXES.",
    ),
    OptionSpec::lines("tcp_off", "TRAFOOF", "Block that switches TCP off."),
    OptionSpec::flag(
        "tool_vectors",
        false,
        "A3= B3= C3= in the place of rotary words under TCP: the control finds their values by itself.",
    ),
    OptionSpec::flag(
        "arcs_off_xy",
        false,
        "Arcs in G18 and G19: setting data 42940 = 17 must keep the length along Z.",
    ),
    OptionSpec::flag(
        "swivel",
        false,
        "CYCLE800 is set up: cancelled at the start, and tilted planes are written with it.",
    ),
    choice(
        "swivel_mode",
        &["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "direct"],
        "XYZ",
        "Turns of CYCLE800 in their order (57, 45, 54, 30, 39, 27); direct: rotary words (192).",
    ),
    OptionSpec::text("swivel_record", "", "_TC: name of the swivel data record."),
    OptionSpec::integer("swivel_retract", (0, 8), 0, "_FR: 0, the tool is away already."),
    OptionSpec::integer("swivel_status", (0, 999_999), 0, "_ST: 0, a new plane."),
    OptionSpec::integer(
        "swivel_direction",
        (-1, 1),
        -1,
        "_DIR where no axis gives its sign: -1, the lower value of the reference axis.",
    ),
    OptionSpec::text(
        "swivel_reference",
        "",
        "Reference axis of the record, whose sign _DIR takes, so that the control finds the same solution; empty: A, else B.",
    ),
    OptionSpec::text(
        "swivel_axes",
        "",
        "Rotary axes 1 and 2 of the record, `A C`: swivel_mode = \"direct\" needs them.",
    ),
    choice(
        "smoothing_by",
        &["CYCLE832", "COMPCAD", "COMPSURF", "COMPCURV"],
        "CYCLE832",
        "What smoothing is written with; a compressor comes with CTOL= and OTOL=.",
    ),
    choice(
        "smoothing_mode",
        &["tolerance", "finish", "semifinish", "rough", "precision"],
        "tolerance",
        "Kind of CYCLE832; tolerance: rough from 0.05 mm on, semifinish from 0.02 mm on, else finish.",
    ),
    OptionSpec::integer(
        "smoothing_code",
        (0, 999_999_999),
        0,
        "Second argument of CYCLE832 in software 2, which packs digits; 0: such a control is sent no smoothing.",
    ),
    choice("tapping", &["rigid", "floating"], "rigid", "CYCLE84, or CYCLE840 with an encoder."),
    OptionSpec::number(
        "bore_lift_x",
        (-100.0, 100.0),
        0.0,
        "RPA of CYCLE86: how far fine boring lifts off along X, program units.",
    ),
    OptionSpec::number("bore_lift_y", (-100.0, 100.0), 0.0, "RPO: along Y."),
    OptionSpec::number(
        "bore_angle",
        (0.0, 360.0),
        0.0,
        "POSS of CYCLE86: where the spindle stops, degrees.",
    ),
    OptionSpec::flag("messages", false, "MSG(\"…\") with each operation's name."),
    options::COOLANT_OFF,
    options::COOLANT_THROUGH,
    options::COOLANT_THROUGH_OFF,
    options::COOLANT_AIR,
    options::COOLANT_AIR_OFF,
];
