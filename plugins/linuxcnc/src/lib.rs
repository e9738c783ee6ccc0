//! LinuxCNC: G-code with modal words, remarks in parentheses.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, CycleCode, Dwell, Engine, Iso, Leave, Length, Offset, Rigid, SplineForm, Stops,
    Subprogram, SurfaceSpeed, Table, Tcp, no_range, offset_of_six, options, words,
};
use post_plugin::{
    Capabilities, Cycle, Language, Meaning, NumberStyle, OptionSpec, Setup, export_dialect, remark,
};

struct LinuxCnc {
    /// P of G64, program units; 0: exact path.
    blend: f64,
}

impl Control for LinuxCnc {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        language: Language::Rs274,
        extension: "ngc",
        percent: false,
        remark: passive,
        // LINELEN, and what it reads of it: a line of 253 stops the interpreter.
        remark_length: 252,
        line_length: Some(252),
        offset: Offset {
            known: |text| {
                (Table::ISO.offset.known)(text) || matches!(text, "G59.1" | "G59.2" | "G59.3")
            },
            range: "G54 to G59 or G59.1 to G59.3",
            word: |number| match number {
                7..=9 => Some(format!("G59.{}", number - 6)),
                _ => offset_of_six(number),
            },
            at_start: true,
        },
        // Without a register G43 takes that of the tool in the spindle.
        length: Length { by_itself: true, ..Table::ISO.length },
        // G90.1, G7 and G8 stay in force over M2.
        safe: "G8 G17 G40 G80 G90 G91.1 G94 G97",
        // An offset of G92 shifts everything; G92.2 keeps its numbers.
        cancel: "G92.2",
        // G43 ahead of the switch, else the joints jump by the length.
        tcp: Tcp::Blocks { on: "M428", off: "M429", length_first: true },
        // G53 means the kinematics in force: under TCP it turns with the table.
        leave: &[Leave::Tcp, Leave::Retract, Leave::Length],
        // M0 and M1 leave both as they are.
        stops: Stops { spindle: false, coolant: false },
        dwell: Dwell::Seconds("P", 3),
        cycles: CYCLES,
        rigid: Rigid::Move("G33.1"),
        splines: SplineForm::Even { code: "G5.2", end: "G5.3" },
        smoothing: SMOOTHING,
        smoothing_anywhere: true,
        surface: Some(SurfaceSpeed { codes: ["G96", "G97"], per_minute: None, most: "D" }),
        message: "MSG, ",
        units_inside: true,
        probe: "G38.2",
        subprogram: Subprogram { number: "O{} CALL", name: "O<{}> CALL", times: "" },
        end: "M2",
        // G12.1 chooses kinematics.
        interpolates: false,
        words: &[words::RETURNS, words::SHIFTS, words::SUBPROGRAM_END, OWN],
        ..Table::ISO
    };

    fn table(setup: &Setup<'_>) -> &'static Table {
        if setup.has_diameters() { DIAMETERS } else { Self::TABLE }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        no_range(setup, "LinuxCNC takes the sign of a wrapped rotary word for its direction")?;
        let blend = setup.number("blend");
        Ok(LinuxCnc { blend })
    }

    /// Its interpreter makes arcs and cycles, and offsets the programmed path, ahead of whatever kinematics is switched on;
    /// its trajectory planner knows the axes of the program, and not the joints behind them.
    fn capabilities(&self) -> Capabilities {
        Capabilities::COMPENSATE_TCP
            | Capabilities::ARC_TCP
            | Capabilities::CYCLE_TCP
            | Capabilities::TCP_RAPIDS_PASS
    }

    fn begin(&self, engine: &mut Engine, out: &mut String) {
        if self.blend > 0.0 {
            let style = NumberStyle { trim: true, ..NumberStyle::default() };
            let block = engine.motion.block.word("G64");
            block.number("P", self.blend, 6, style).end(out);
        } else {
            engine.line("G61", out);
        }
    }
}

/// Of a lathe whose words of X are diameters: G8 would take them for radii.
const DIAMETERS: &Table =
    &Table { safe: "G7 G17 G40 G80 G90 G91.1 G94 G97", ..*<LinuxCnc as Control>::TABLE };

/// A remark that LinuxCNC does not act on, as it does on `(MSG, …)`, `(PROBEOPEN …)` and their like.
fn passive(text: &str) -> String {
    const ACTIVE: &[&str] = &["MSG", "DEBUG", "PRINT", "LOG", "PROBE", "PY", "ABORT"];
    let remark = remark(text);
    let inner = remark[1..].trim_start();
    match ACTIVE.iter().any(|word| inner.starts_with(word)) {
        true => format!("(- {inner}"),
        false => remark,
    }
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::flag("percent", false, "% before and after the program."),
    options::BLOCK_NUMBERS,
    options::BLOCK_STEP,
    options::SPACES,
    options::LEADING_ZEROS,
    options::decimals(4),
    options::decimals_inch(5),
    options::rotary_decimals(4),
    options::WORD_DECIMALS,
    options::feed_decimals(1),
    options::inverse_time_decimals(4),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G59.1 to G59.3."),
    // G64 leaves the path by up to P, and P speaks of X Y Z alone, so no certificate could hold.
    OptionSpec::number(
        "blend",
        (0.0, 10.0),
        0.0,
        "P of G64, program units: the control leaves the path by up to as much; 0: G61, exact path.",
    ),
    options::RETRACT,
    options::RESTART,
    OptionSpec::lines("tcp_on", "M428", "Remap that switches to the TCP kinematics."),
    OptionSpec::lines(
        "tcp_off",
        "",
        "Remap that switches back; empty: M429 under tcp = \"control\", else nothing is written about it.",
    ),
    options::tapping("rigid"),
    options::SPLINES,
    options::smoothing(SMOOTHING[0]),
    options::smoothing_off(SMOOTHING[1]),
    options::CLAMPS,
    options::COOLANT_THROUGH,
    options::COOLANT_AIR,
];

/// G86 asks for a P; G76 is a thread here, and there is no G87.
const CYCLES: &[CycleCode] = &[
    CycleCode::new(Cycle::Drill, "G81", "G82"),
    CycleCode::new(Cycle::Deep, "G83", ""),
    CycleCode::new(Cycle::BreakChip, "G73", ""),
    CycleCode::new(Cycle::Tap, "G84", "G84"),
    CycleCode::new(Cycle::TapLeft, "G74", "G74"),
    CycleCode::new(Cycle::Ream, "G85", "G89"),
    CycleCode::new(Cycle::Bore, "G86 P0", "G86"),
];

/// G64 P is the tolerance, program units.
const SMOOTHING: [&str; 2] = ["0 G64 P{}", "G61"];

/// Words that its interpreter reads and that are not written here. G76 is a thread in passes.
const OWN: &[(&str, Meaning)] = &[
    (";", Meaning::Remark),
    ("G28.1", Meaning::TableData),
    ("G30.1", Meaning::TableData),
    ("G38.3", Meaning::Probe),
    ("G38.4", Meaning::Probe),
    ("G38.5", Meaning::Probe),
    ("G33", Meaning::Thread),
    ("G33.1", Meaning::ThreadAndBack),
    ("G5", Meaning::Spline),
    ("G5.1", Meaning::Spline),
    ("G5.2", Meaning::Spline),
    ("G5.3", Meaning::Nothing),
    ("G90.1", Meaning::CentreAbsolute),
    ("G91.1", Meaning::CentreIncremental),
    ("G2 P", Meaning::Turns),
    ("G3 P", Meaning::Turns),
    ("G7", Meaning::Diameter),
    ("G8", Meaning::DiameterOff),
    ("G41.1", Meaning::CompensationLeft),
    ("G42.1", Meaning::CompensationRight),
    ("G43.1", Meaning::LengthStated),
    ("G43.2", Meaning::LengthAdded),
    ("G92.1", Meaning::SetPositionOff),
    ("G92.2", Meaning::SetPositionOff),
    ("G92.3", Meaning::SetPositionAgain),
    ("G64", Meaning::Smoothing),
    ("G61", Meaning::SmoothingOff),
    ("G61.1", Meaning::SmoothingOff),
    ("G76", Meaning::CycleOther),
    ("G84", Meaning::CycleTap),
    ("G74", Meaning::CycleTapLeft),
    ("M60", Meaning::Stop),
    ("M48", Meaning::Nothing),
    ("M49", Meaning::Nothing),
    ("M50", Meaning::Nothing),
    ("M51", Meaning::Nothing),
    ("M52", Meaning::Nothing),
    ("M53", Meaning::Nothing),
    ("M62", Meaning::Nothing),
    ("M63", Meaning::Nothing),
    ("M64", Meaning::Nothing),
    ("M65", Meaning::Nothing),
    ("M66", Meaning::Nothing),
    ("M67", Meaning::Nothing),
    ("M68", Meaning::Nothing),
    ("M98", Meaning::Subprogram),
];

export_dialect!(linuxcnc, Iso<LinuxCnc>);
