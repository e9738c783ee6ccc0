//! Fanuc's lathes: their three systems of G codes, of which a control has the one that parameter 3401 (#6 GSB, #7 GSC) says.
//!
//! In A the letter says whether a word is a position (X) or a way (U), and G90, G92 and G94 are cycles; B and C have G90 and
//! G91, and differ in the codes of those cycles and of the units. All call a tool with its offsets: `T0101`.

use post_iso::{Leave, Length, MotionCodes, Subprogram, SurfaceSpeed, Table, words};
use post_plugin::Meaning;

use crate::OPTIONS;

pub(crate) const A: Table = Table {
    options: OPTIONS,
    title: Some(("O", 4)),
    largest_number: 99_999,
    codes: MotionCodes {
        feed: ["G98", "", "G99"],
        // In the plane of X and Z it is that of a nose with its quadrant, which is not written.
        compensation: ["G40", "", ""],
        ..MotionCodes::ISO
    },
    safe: "G18 G40 G80 G98",
    relies: RELIES,
    feed_all_axes: true,
    sign_is_way: true,
    // T puts the offsets of the tool in force.
    length: Length { on: "", register: "", by_itself: true, across_plane: false, off: "" },
    leave: &[Leave::Retract],
    change: "",
    // They go along Z or X by their codes, and R counts from where they begin.
    cycles: &[],
    surface: Some(SurfaceSpeed { codes: ["G96", "G97"], per_minute: None, most: "G50 S" }),
    subprogram: Subprogram::M98,
    words: &[words::RETURNS, words::POLAR, words::STOPS, words::SUBPROGRAM_END, OWN, OWN_A],
    ..Table::ISO
};

pub(crate) const B: Table = Table {
    codes: MotionCodes { feed: MotionCodes::ISO.feed, ..A.codes },
    safe: "G18 G40 G80 G90 G94",
    surface: Some(SurfaceSpeed { codes: ["G96", "G97"], per_minute: None, most: "G92 S" }),
    words: &[words::RETURNS, words::POLAR, words::STOPS, words::SUBPROGRAM_END, OWN, OWN_B],
    ..A
};

pub(crate) const C: Table = Table {
    codes: MotionCodes { units: ["G71", "G70"], ..B.codes },
    words: &[words::RETURNS, words::POLAR, words::STOPS, words::SUBPROGRAM_END, OWN, OWN_C],
    ..B
};

/// Parameters of the 0i-T and 30i-T.
const RELIES: &[&str] = &[
    "3401#6 GSB, #7 GSC: the system of G codes, 0 and 0 A, 1 and 0 B, 0 and 1 C",
    "5002#0 LD1 = 0: the last two digits of T are the number of the offset",
    "1006#3 DIA: X is a diameter where the machine file has it so",
    "1401#1 LRP = 1: rapids go straight; with 0 the axes arrive one after the other",
    "one M code a block is enough, G53 counts from the machine's zero",
];

use Meaning as M;

/// What is a cycle of lathes, or looks at the nose of the tool, is not followed: Fanuc's names of milling mean something else.
const OWN: &[(&str, Meaning)] = &[
    ("T", M::ToolAndOffset),
    ("G4 X", M::DwellSeconds),
    ("G4 U", M::DwellSeconds),
    ("G10", M::TableData),
    ("G52", M::LocalOffset),
    ("G34", M::NotFollowed),
    ("G36", M::NotFollowed),
    ("G37", M::NotFollowed),
    ("G41", M::NotFollowed),
    ("G42", M::NotFollowed),
    ("G43", M::NotFollowed),
    ("G51.2", M::NotFollowed),
    ("G68", M::NotFollowed),
    ("G72", M::NotFollowed),
    ("G73", M::NotFollowed),
    ("G74", M::NotFollowed),
    ("G75", M::NotFollowed),
    ("G76", M::NotFollowed),
    ("G81", M::NotFollowed),
    ("G82", M::NotFollowed),
    ("G83", M::NotFollowed),
    ("G84", M::NotFollowed),
    ("G85", M::NotFollowed),
    ("G86", M::NotFollowed),
    ("G87", M::NotFollowed),
    ("G88", M::NotFollowed),
    ("G89", M::NotFollowed),
    ("G93", M::NotFollowed),
    ("G65", M::Macro),
    ("G66", M::MacroModal),
    ("G67", M::MacroOff),
];

/// Words of system A alone. It has no G91 and no G95.
const OWN_A: &[(&str, Meaning)] = &[
    ("G32", M::Thread),
    ("G33", M::NotFollowed),
    ("G50", M::SetPosition),
    ("G70", M::NotFollowed),
    ("G71", M::NotFollowed),
    ("G90", M::NotFollowed),
    ("G91", M::NotFollowed),
    ("G92", M::NotFollowed),
    ("G92 S", M::NotFollowed),
    ("G94", M::NotFollowed),
    ("G95", M::NotFollowed),
];

/// Words of system B alone.
const OWN_B: &[(&str, Meaning)] = &[
    ("G33", M::Thread),
    ("G50 S", M::NotFollowed),
    ("G70", M::NotFollowed),
    ("G71", M::NotFollowed),
    ("G77", M::NotFollowed),
    ("G78", M::NotFollowed),
    ("G79", M::NotFollowed),
    ("G92", M::SetPosition),
];

/// Words of system C alone.
const OWN_C: &[(&str, Meaning)] = &[
    ("G20", M::NotFollowed),
    ("G21", M::NotFollowed),
    ("G24", M::NotFollowed),
    ("G33", M::Thread),
    ("G50 S", M::NotFollowed),
    ("G77", M::NotFollowed),
    ("G78", M::NotFollowed),
    ("G92", M::SetPosition),
];
