//! How the control differs from the rest of the family.

use post_iso::{Dwell, Leave, Length, MotionCodes, Offset, Subprogram, SurfaceSpeed, Table, Tcp};
use post_plugin::{AxisNames, Language, ascii};

use crate::options::{CANCEL, OPTIONS};

pub(crate) const TABLE: Table = Table {
    options: OPTIONS,
    axes: AxisNames { numbered: true, ..AxisNames::ISO },
    language: Language::Names,
    extension: "mpf",
    percent: false,
    remark: |text| format!("; {}", ascii(text).trim()).trim_end().to_owned(),
    line_length: Some(512),
    largest_number: 999_999_999,
    codes: MotionCodes {
        // G71 and G70 leave feeds in the units of the control.
        units: ["G710", "G700"],
        radius: "",
        // Those of the dialect's own, with their words for radius and turns.
        arc: ["", ""],
        ..MotionCodes::ISO
    },
    safe: "G17 G40 G64 G90 G94",
    relies: RELIES,
    cancel: CANCEL,
    offset: Offset {
        known: is_work_offset,
        range: "G54 to G57 or G505 to G599",
        word: |number| match number {
            1..=4 => Some(format!("G{}", 53 + number)),
            5..=99 => Some(format!("G5{number:02}")),
            _ => None,
        },
        at_start: false,
    },
    length: Length { on: "", register: "D", by_itself: true, across_plane: true, off: "" },
    tcp: Tcp::Blocks { on: "TRAORI", off: "TRAFOOF", length_first: true },
    // SUPA leaves the length in force (MD $MN_G53_TOOLCORR = 0), so D0 goes with it.
    machine: "G0 SUPA D0",
    leave: &[Leave::Retract],
    cycles: &[],
    surface: Some(SurfaceSpeed {
        codes: ["G96", "G97"],
        per_minute: Some(["G961", "G971"]),
        most: "LIMS=",
    }),
    subprogram: Subprogram { number: "L{}", name: "{}", times: " P" },
    dwell: Dwell::Seconds("F", 3),
    ..Table::ISO
};

/// Of a lathe of X and Z. The lengths of a turning tool act in X and Z under G18, in Y and X under G17 (NC programming,
/// 6FC5398-2EP40-0BA0, 12/2019, p. 750).
pub(crate) const TURNING: Table =
    Table { safe: "G18 G40 G64 G90 G94 DIAMOF", relies: RELIES_TURNING, ..TABLE };

/// The same with diameters.
pub(crate) const TURNING_DIAMETERS: Table = Table { safe: "G18 G40 G64 G90 G94 DIAMON", ..TURNING };

/// Of another lathe, whose tools lie otherwise.
pub(crate) const RADII: Table = Table { safe: "G17 G40 G64 G90 G94 DIAMOF", ..TABLE };

/// The same with diameters.
pub(crate) const DIAMETERS: Table = Table { safe: "G17 G40 G64 G90 G94 DIAMON", ..TABLE };

/// The setting data that turning relies on.
const RELIES_TURNING: &[&str] = &[
    "MD 10760 G53_TOOLCORR: either; SUPA comes with D0",
    "SD 42940 TOOL_LENGTH_CONST = 0 or 18: lengths of turning tools act in X and Z",
    "MD 20100 DIAMETER_AX_DEF names X",
    "SUPA counts from the machine's zero",
];

/// The parameters and setting data that the program relies on.
const RELIES: &[&str] = &[
    "MD 10760 G53_TOOLCORR: either; SUPA comes with D0",
    "MD 21104 ORI_IPO_WITH_G_CODE: either with ORIMKS ORIAXES; 1 with ORIWKS ORIAXES",
    "SD 42940 TOOL_LENGTH_CONST = 17 where arcs are written in G18 or G19",
    "SUPA counts from the machine's zero",
];

/// G54 to G57, G505 to G599.
pub(crate) fn is_work_offset(text: &str) -> bool {
    let number = text.strip_prefix('G').and_then(|digits| digits.parse().ok());
    matches!(number, Some(54..=57 | 505..=599))
}
