//! Haas NGC: Fanuc's words, G234 for the tool centre point, G254 for the dynamic work offset.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, CycleCode, Iso, Offset, Plane, Subprogram, Table, Tcp, is_offset_beyond_six,
    iso_options, offset_beyond_six, options, words,
};
use post_plugin::{Cycle, Meaning, OptionSpec, Setup, export_dialect};

struct Haas;

impl Control for Haas {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        title: Some(("O", 5)),
        offset: Offset {
            known: |text| is_offset_beyond_six(text, "G154 P", 99),
            range: "G54 to G59 or G154 P1 to P99",
            word: |number| offset_beyond_six(number, "G154 P", 99),
            ..Table::ISO.offset
        },
        relies: RELIES,
        tcp: Tcp::Length("G234"),
        tcp_at_rapid: true,
        plane: Plane::Turned { on: "G254", off: "G255" },
        cycles: CYCLES,
        cycles_in_plane: true,
        smoothing: SMOOTHING,
        smoothing_anywhere: true,
        probe: "G31",
        subprogram: Subprogram::M98,
        words: &[words::SHIFTS, words::STOPS, words::SUBPROGRAM_END, OWN],
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Haas)
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    options::program_number(99_999),
    options::SPACES,
    options::inverse_time_decimals(3),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G154 Pn."),
    options::BORE_SHIFT,
    options::smoothing(SMOOTHING[0]),
    options::smoothing_off(SMOOTHING[1]),
];

/// Its boring from below is G77 (staging-diy.haascnc.com, G77, group 09): G87 bores and waits for a hand.
const CYCLES: &[CycleCode] = &[
    CycleCode::new(Cycle::Drill, "G81", "G82"),
    CycleCode::new(Cycle::Deep, "G83", ""),
    CycleCode::new(Cycle::BreakChip, "G73", ""),
    CycleCode::new(Cycle::Tap, "G84", "G84"),
    CycleCode::new(Cycle::TapLeft, "G74", "G74"),
    CycleCode::new(Cycle::Ream, "G85", "G89"),
    CycleCode::new(Cycle::Bore, "G86", ""),
    CycleCode::new(Cycle::BoreFine, "G76", "G76"),
    CycleCode::new(Cycle::BoreBack, "G77", ""),
];

const RELIES: &[&str] = &[
    "the options TCPC and DWO for G234 and G254; the rotary zero (MRZP) is set",
    "B of the work offset is zero under G254",
    "settings 34 and 79 are the diameters of the rotary axes: without TCPC a feed a minute counts with them",
    "setting 9 has the units of the program; rapids that turn an axis may leave the straight line",
];

/// G187 P: 1 rough, 2 medium, 3 finish; E is the largest deviation of a corner. Alone it gives back the settings.
const SMOOTHING: [&str; 2] = ["0 G187 P3 E{}\n0.02 G187 P2 E{}\n0.1 G187 P1 E{}", "G187"];

/// Words that it reads and that are not written here. G87 and G88 bore and wait for a hand, and G69 ends no plane.
const OWN: &[(&str, Meaning)] = &[
    ("G28", Meaning::ReferenceReturn),
    ("G187 E", Meaning::Smoothing),
    ("G44", Meaning::LengthNegative),
    ("G68", Meaning::Rotation),
    ("G69", Meaning::RotationOff),
    ("G51", Meaning::Scale),
    ("G50", Meaning::ScaleOff),
    ("G101", Meaning::Mirror),
    ("G100", Meaning::MirrorOff),
    ("G100", Meaning::OwnAxisWords),
    ("G107", Meaning::CylinderTransformation),
    ("G107 R", Meaning::CylinderTransformation),
    ("G107 Q", Meaning::CylinderTransformation),
    ("G107 X", Meaning::CylinderTransformation),
    ("G107 Y", Meaning::CylinderTransformation),
    ("G107 Z", Meaning::CylinderTransformation),
    ("G112", Meaning::FaceTransformation),
    ("G112 Y", Meaning::FaceTransformation),
    ("G113", Meaning::FaceTransformationOff),
    ("G12", Meaning::CycleOther),
    ("G13", Meaning::CycleOther),
    ("G150", Meaning::CycleOther),
    ("G76", Meaning::CycleBoreFine),
    ("G77", Meaning::CycleBoreBack),
    ("G87", Meaning::CycleOther),
    ("G88", Meaning::CycleOther),
    ("M88", Meaning::CoolantOn),
    ("M89", Meaning::CoolantOff),
    ("M10", Meaning::Clamp),
    ("M12", Meaning::Clamp),
    ("M11", Meaning::Unclamp),
    ("M13", Meaning::Unclamp),
    ("M97", Meaning::LocalSubprogram),
    ("G65", Meaning::Macro),
];

export_dialect!(haas, Iso<Haas>);
