//! Okuma OSP, machining centres: work offsets by G15 H, length by G56 H, positions of the machine by G16 H0.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, CycleCode, CycleReturn, Dwell, Iso, Leave, Length, MotionCodes, Offset, Rigid,
    Subprogram, Table, Tcp, check_unit_system, iso_options, options,
};
use post_plugin::{
    Capabilities, Cycle, Meaning, OptionKind, OptionSpec, Setup, Value, export_dialect,
};

struct Okuma {
    /// A block of the machine file's own retracts the tool.
    retracts: bool,
}

impl Control for Okuma {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        extension: "MIN",
        percent: false,
        title: Some(("O", 4)),
        line_length: Some(158),
        // The control's parameters choose the units, and its formula for inverse time is the machine's own.
        codes: MotionCodes { units: ["", ""], feed: ["G94", "", "G95"], ..MotionCodes::ISO },
        offset: Offset {
            known: |text| number(text).is_some_and(|number| (1..=200).contains(&number)),
            range: "G15 H1 to H200",
            word: |number| (1..=200).contains(&number).then(|| format!("G15 H{number}")),
            at_start: false,
        },
        // Where the tool is retracted: positions of the machine count without it either way.
        length: Length { on: "G56", off: "G53", ..Table::ISO.length },
        relies: RELIES,
        feed_all_axes: true,
        tcp: Tcp::Blocks { on: "", off: "", length_first: false },
        machine: "G16 H0 G0",
        leave: &[Leave::Tcp, Leave::Retract, Leave::Length],
        cycles: CYCLES,
        cycle_return: CycleReturn::Level { block: "G71", word: "M53" },
        // Without its option a control stops at these codes.
        rigid: Rigid::Codes { codes: ["G284", "G274"], pitch: "" },
        dwell: Dwell::Seconds("F", 2),
        subprogram: Subprogram { number: "CALL O{}", name: "CALL {}", times: "" },
        end: "M2",
        words: &[OWN],
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        check_unit_system(
            setup,
            ["1 mm", "1 inch"],
            "what a number means is a parameter of this control, and a point does not override it",
        )?;
        Ok(Okuma { retracts: !setup.text("retract").is_empty() })
    }

    /// G16 H0 counts from a zero of the builder's own, which is the top of Z on hardly any machine.
    fn capabilities(&self) -> Capabilities {
        // In what unit P waits, posts do not agree.
        let always = Capabilities::CYCLE_NO_DWELL | Capabilities::UNIT_SYSTEM;
        match self.retracts {
            true => always,
            false => always | Capabilities::RETRACT_SAID,
        }
    }
}

/// Fine boring and boring from below go off the wall by words that posts do not agree on.
const CYCLES: &[CycleCode] = &[
    CycleCode::new(Cycle::Drill, "G81", ""),
    CycleCode::new(Cycle::Deep, "G83", ""),
    CycleCode::new(Cycle::BreakChip, "G73", ""),
    CycleCode::new(Cycle::Tap, "G84", ""),
    CycleCode::new(Cycle::TapLeft, "G74", ""),
    CycleCode::new(Cycle::Ream, "G85", ""),
    CycleCode::new(Cycle::Bore, "G86", ""),
];

/// The number of `G15 H7`.
fn number(text: &str) -> Option<u32> {
    text.strip_prefix("G15 H")?.parse().ok()
}

const OPTIONS: &[OptionSpec] = iso_options![
    OptionSpec {
        key: "unit_system",
        kind: OptionKind::Choice(&["", "1 mm", "1 inch", "10 um", "1 um"]),
        default: Value::Text(""),
        help: "The unit system of the control's parameters: must be named, and be 1 mm, or 1 inch for an inch program.",
    },
    options::program_number(9999),
    OptionSpec::text("work_offset", "G15 H1", "G15 H1 to H200."),
    OptionSpec::lines(
        "tcp_on",
        "",
        "Block that switches tool centre point control on, {h} for the register of the length: `G169 HL={h}`.",
    ),
    OptionSpec::lines("tcp_off", "", "Block that switches it off: `G170`."),
    options::tapping("rigid"),
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "the unit system is 1 mm, or 1 inch: the units of the program are those of the parameters",
    "G16 H0: the positions of this block count from the machine's zero, without the length",
    "G4 F is in seconds: confirm at the machine",
];

/// Words that it reads, many of which mean something else on other controls: 4203-E, tables of command codes.
const OWN: &[(&str, Meaning)] = &[
    ("%", Meaning::Nothing),
    ("$", Meaning::Nothing),
    ("G30", Meaning::OtherReferenceReturn),
    ("G31", Meaning::Probe),
    ("G9", Meaning::ExactStop),
    ("G16 H0", Meaning::MachineCoordinates),
    ("G16", Meaning::WorkOffsetBlock),
    ("G53", Meaning::LengthOff),
    // The length along X, Y and the axes beyond Z: not the work offsets of others.
    ("G54", Meaning::NotFollowed),
    ("G55", Meaning::NotFollowed),
    ("G57", Meaning::NotFollowed),
    ("G58", Meaning::NotFollowed),
    ("G59", Meaning::NotFollowed),
    ("HA", Meaning::LengthRegister),
    ("HL", Meaning::LengthRegister),
    ("G92", Meaning::SetPosition),
    ("G11", Meaning::Rotation),
    ("G10", Meaning::RotationOff),
    ("CALL OO88", Meaning::TiltedPlane),
    ("G51", Meaning::Scale),
    ("G50", Meaning::ScaleOff),
    ("G62", Meaning::Mirror),
    ("G136", Meaning::FaceTransformationOff),
    ("G137", Meaning::FaceTransformation),
    ("G175", Meaning::CylinderTransformation),
    ("G131", Meaning::Smoothing),
    ("G187", Meaning::Smoothing),
    ("G64", Meaning::Smoothing),
    ("G130", Meaning::SmoothingOff),
    ("G186", Meaning::SmoothingOff),
    ("G61", Meaning::SmoothingOff),
    ("G71", Meaning::ReturnLevel),
    // As high as the axis goes.
    ("M52", Meaning::Retract),
    ("M53", Meaning::ReturnLevel),
    ("M54", Meaning::ReturnClearance),
    // Goes there and makes no hole.
    ("NCYL", Meaning::CycleOther),
    ("G80", Meaning::CycleOffSpindleOff),
    ("G73", Meaning::CycleBreakChip),
    ("G74", Meaning::CycleTapLeft),
    ("G274", Meaning::CycleTapLeft),
    ("G76", Meaning::CycleBoreFine),
    ("G81", Meaning::CycleDrill),
    ("G82", Meaning::CycleDrill),
    ("G83", Meaning::CycleDeep),
    ("G84", Meaning::CycleTap),
    ("G284", Meaning::CycleTap),
    ("G85", Meaning::CycleReam),
    ("G89", Meaning::CycleReam),
    ("G86", Meaning::CycleBore),
    ("G87", Meaning::CycleBoreBack),
    ("M50", Meaning::CoolantOn),
    ("M51", Meaning::CoolantOn),
    ("M12", Meaning::CoolantOn),
    ("M59", Meaning::CoolantOn),
    ("M10", Meaning::Clamp),
    ("M20", Meaning::Clamp),
    ("M26", Meaning::Clamp),
    ("M11", Meaning::Unclamp),
    ("M21", Meaning::Unclamp),
    ("M27", Meaning::Unclamp),
    // The way in which a rotary axis turns.
    ("M15", Meaning::NotFollowed),
    ("M16", Meaning::NotFollowed),
    ("M510", Meaning::Nothing),
    ("M511", Meaning::Nothing),
    ("RTS", Meaning::SubprogramEnd),
];

export_dialect!(okuma, Iso<Okuma>);
