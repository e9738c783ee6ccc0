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
    length: Length { on: "", register: "D", by_itself: true, off: "" },
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
