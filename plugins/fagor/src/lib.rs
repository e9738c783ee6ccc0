//! Fagor 8060, 8065 and 8070: tools with offsets by D, machine coordinates by `#MCS`, the tip by `#RTCP`, tilted planes
//! by `#CS`.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, CycleAddresses, CycleCode, Dwell, Engine, Iso, Leave, Length, MotionCodes, Offset,
    Plane, Rigid, Table, Tcp, iso_options, no_range, options,
};
use post_plugin::{
    Capabilities, Cycle, Event, Language, Meaning, OptionSpec, PlaneAngles, Setup, ascii,
    export_dialect,
};

struct Fagor {
    /// The offset of each tool, D.
    edge: i64,
    /// Something turns: a plane may be left over from another program.
    turns: bool,
}

impl Control for Fagor {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        language: Language::Instructions,
        percent: false,
        remark: |text| format!("; {}", ascii(text).trim()).trim_end().to_owned(),
        codes: MotionCodes {
            units: ["G71", "G70"],
            // F of its G93 is a time in seconds.
            feed: ["G94", "", "G95"],
            radius: "",
            ..MotionCodes::ISO
        },
        offset: Offset {
            known: |text| (1..=20).any(|number| work_offset(number).as_deref() == Some(text)),
            range: "G54 to G57 or G159=5 to G159=20",
            word: work_offset,
            at_start: false,
        },
        // D stands in the block of the tool.
        length: Length { on: "", register: "D", by_itself: true, across_plane: true, off: "" },
        relies: RELIES,
        tcp: Tcp::Blocks { on: RTCP, off: "#RTCP OFF", length_first: true },
        machine: "#MCS G0",
        leave: &[Leave::Tcp, Leave::Retract],
        dwell: Dwell::Seconds("K", 3),
        cycles: CYCLES,
        cycle_addresses: CycleAddresses {
            clearance: "Z",
            bottom: "I",
            step: "B",
            // Out of the hole after each.
            beside_step: "J1",
            dwell: "K",
        },
        cycles_in_plane: true,
        rigid: Rigid::Beside("R1"),
        plane: Plane::Turns {
            on: "{tcp_on}\n#CS ON [1] [MODE 1, {x}, {y}, {z}, {first}, {second}, {third}]",
            off: "#CS OFF\n{tcp_off}",
            angles: PlaneAngles::Xyz,
        },
        // M7 is coolant through the tool, or the builder's.
        coolant: ["M9", "M8", "", "", ""],
        words: &[OWN],
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        no_range(setup, "the sign of such a word may be its direction, by the axis' parameters")?;
        Ok(Fagor { edge: setup.integer("edge"), turns: setup.words.iter().any(|word| word.rotary) })
    }

    fn capabilities(&self) -> Capabilities {
        Capabilities::TOOL_TABLE | Capabilities::TOOL_EDGES
    }

    fn begin(&self, engine: &mut Engine, out: &mut String) {
        if self.turns {
            engine.line("#CS OFF", out);
        }
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        let &Event::ToolChange { number, register, name, .. } = event else {
            return Ok(false);
        };
        engine.must_leave_plane("a tool change")?;
        // D puts the length across the plane (CNC 8070, programming manual, tool length).
        if let Some(word) = engine.motion.leave_other_plane() {
            engine.line(word, out);
        }
        engine.change(number, &format!("T{number} D{}", self.edge), register, name, out);
        Ok(true)
    }
}

/// Tool centre point control on.
const RTCP: &str = "#RTCP ON";

/// G54 to G57; what G58 and G59 do differs from one post to the other.
fn work_offset(number: u32) -> Option<String> {
    match number {
        1..=4 => Some(format!("G{}", 53 + number)),
        5..=20 => Some(format!("G159={number}")),
        _ => None,
    }
}

/// Its G82 drills in pecks, and G87 and G88 are pockets.
const CYCLES: &[CycleCode] = &[
    CycleCode::new(Cycle::Drill, "G81", "G81"),
    CycleCode::new(Cycle::Deep, "G82", "G82"),
    CycleCode::new(Cycle::Tap, "G84", "G84"),
    CycleCode::new(Cycle::Ream, "G85", "G85"),
    CycleCode::new(Cycle::Bore, "G86", "G86"),
];

const OPTIONS: &[OptionSpec] = iso_options![
    OptionSpec::text("work_offset", "G54", "G54 to G57, or G159=5 to G159=20."),
    OptionSpec::integer("edge", (1, 8), 1, "D of every tool: which of its offsets."),
    OptionSpec::lines(
        "tcp_on",
        RTCP,
        "Lines that switch tool centre point control on: [\"#KIN ID [1]\", \"#RTCP ON\"] where the control has several \
         kinematics.",
    ),
    OptionSpec::lines(
        "tcp_off",
        "",
        "Line that switches it off; empty: #RTCP OFF under tcp = \"control\" and behind planes, else nothing is written \
         about it.",
    ),
    OptionSpec::flag(
        "arcs_off_xy",
        false,
        "Arcs in G18 and G19: the machine parameter LCOMPTYP must keep the length along Z.",
    ),
    options::cycles_in_plane(true),
    options::tapping("rigid"),
    OptionSpec::text("coolant_mist", "", "M codes of mist."),
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "G0 is interpolated: all axes go together, on a straight line",
    "corners are kept: the machine parameter that G5, G7 and G50 take the place of says G7",
    "LCOMPTYP keeps the length along Z where arcs are written in G18 or G19",
    "under #RTCP and #CS coordinates stay with the part",
    "rotary axes count whole turns: they are not of the module type",
    "positions of #MCS are those of the axes, without offsets and length",
];

/// Words that it reads and that are not written here, or that mean something else than those of other controls.
const OWN: &[(&str, Meaning)] = &[
    (";", Meaning::Remark),
    ("R", Meaning::Radius),
    ("D", Meaning::LengthOn),
    ("D0", Meaning::LengthOff),
    ("G5", Meaning::Smoothing),
    ("G7", Meaning::SmoothingOff),
    ("G50", Meaning::Smoothing),
    ("G60", Meaning::ExactStop),
    ("G61", Meaning::Smoothing),
    ("G500", Meaning::SmoothingOff),
    ("#HSC ON", Meaning::Smoothing),
    ("#HSC OFF", Meaning::SmoothingOff),
    ("#KIN ID", Meaning::Nothing),
    ("#DGWZ", Meaning::Nothing),
    ("#MCS ON", Meaning::MachineCoordinatesOn),
    ("#MCS OFF", Meaning::MachineCoordinatesOff),
    // Posts do not agree whether they shift what is in force.
    ("G58", Meaning::LocalOffsetAdded),
    ("G59", Meaning::LocalOffsetAdded),
    ("G83", Meaning::CycleDeep),
    ("M10", Meaning::CoolantOn),
    ("M11", Meaning::CoolantOn),
    ("M17", Meaning::SubprogramEnd),
    ("M29", Meaning::SubprogramEnd),
];

export_dialect!(fagor, Iso<Fagor>);
