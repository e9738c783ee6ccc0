//! Controls on ISG's kernel (Beckhoff TF5200; Felder, Holz-Her and others): tools by D, machine coordinates between
//! `#MCS ON` and `#MCS OFF`, the tip by `#TRAFO`, tilted planes by `#CS`.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, Dwell, Engine, Iso, Leave, Length, MotionCodes, Offset, Plane, Table, Tcp,
    iso_options, no_range, offset_of_six, options,
};
use post_plugin::{
    Compensation, Event, Language, Meaning, OptionSpec, PlaneAngles, Setup, Units, export_dialect,
};

#[derive(Default)]
struct Isg {
    /// The number behind D; none before a tool is loaded.
    data: Option<u32>,
}

impl Control for Isg {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        language: Language::Instructions,
        percent: false,
        title: Some(("%", 1)),
        codes: MotionCodes {
            units: ["G71", "G70"],
            // F of its G93 is a time in seconds.
            feed: ["G94", "", "G95"],
            radius: "",
            ..MotionCodes::ISO
        },
        // G80 would call a subprogram. G161 may have made centres positions.
        safe: "G17 G40 G90 G94 G162",
        offset: Offset {
            known: |text| {
                (1..=MOST_OFFSETS).any(|number| work_offset(number).as_deref() == Some(text))
            },
            range: "G54 to G59 or G159=7 to G159=96",
            word: work_offset,
            at_start: false,
        },
        length: Length { on: "D", register: "", by_itself: false, across_plane: true, off: "" },
        relies: RELIES,
        tcp: Tcp::Blocks { on: TRAFO, off: "#TRAFO OFF", length_first: true },
        machine: "#MCS ON",
        machine_off: "#MCS OFF",
        leave: &[Leave::Tcp, Leave::Retract],
        dwell: Dwell::Seconds("X", 3),
        // G80 to G89 are subprograms of the builder's.
        cycles: &[],
        cycles_in_plane: true,
        // P-CHAN-00439 = 0.
        smoothing_in_mm: true,
        plane: Plane::Turns {
            on: "{tcp_on}\n#CS ON [{x}, {y}, {z}, {third}, {second}, {first}]",
            off: "#CS OFF\n{tcp_off}",
            angles: PlaneAngles::Zyx,
        },
        words: &[OWN],
        ..Table::ISO
    };

    fn table(setup: &Setup<'_>) -> &'static Table {
        match setup.has_diameters() {
            true => DIAMETERS,
            false if setup.turns_part => RADII,
            false => Self::TABLE,
        }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        no_range(setup, "a sign in front of such a word is the direction in which it turns")?;
        if setup.units == Units::Inch && !setup.flag("inch_feeds") {
            return Err(
                "whether F counts inches under G70 is not settled: the option `inch_feeds` says that it does on yours, \
                 [control] units = \"mm\" does without"
                    .to_owned(),
            );
        }
        Ok(Isg::default())
    }

    fn write(&mut self, event: &Event<'_>, _: &mut Engine, _: &mut String) -> Result<bool, String> {
        match *event {
            Event::ToolChange { register, .. } => self.data = Some(register),
            Event::Offsets { length, radius } => {
                self.data = length.or(self.data);
                if let Some(radius) = radius.filter(|radius| Some(*radius) != self.data) {
                    return Err(apart(radius));
                }
            }
            Event::Compensate(
                Compensation::Left { register } | Compensation::Right { register },
            ) if self.data.is_some_and(|data| data != register) => {
                return Err(apart(register));
            }
            _ => {}
        }
        Ok(false)
    }
}

/// The sentence that refuses a radius from another register than the length's.
fn apart(register: u32) -> String {
    format!(
        "the radius of register {register} is asked for, and D names length and radius together"
    )
}

/// Of a machine whose words of X are diameters.
const DIAMETERS: &Table = &Table { safe: "G17 G40 G51 G90 G94 G162", ..*<Isg as Control>::TABLE };

/// Of a lathe whose words of X are radii.
const RADII: &Table = &Table { safe: "G17 G40 G52 G90 G94 G162", ..*<Isg as Control>::TABLE };

/// Tool centre point control on.
const TRAFO: &str = "#TRAFO ON";

/// The last one that `G159` names.
const MOST_OFFSETS: u32 = 96;

fn work_offset(number: u32) -> Option<String> {
    match number {
        7..=MOST_OFFSETS => Some(format!("G159={number}")),
        _ => offset_of_six(number),
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    OptionSpec::integer(
        "program_number",
        (1, 99_999_999),
        1000,
        "Number of the program, behind %."
    ),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G159=7 to G159=96."),
    OptionSpec::lines(
        "tcp_on",
        TRAFO,
        "Lines that switch tool centre point control on: [\"#KIN ID [91]\", \"#TRAFO ON\"] where the control has several \
         kinematics, #RTCP ON on older ones.",
    ),
    OptionSpec::lines(
        "tcp_off",
        "",
        "Line that switches it off; empty: #TRAFO OFF under tcp = \"control\" and behind planes, else nothing is written \
         about it.",
    ),
    OptionSpec::flag(
        "inch_feeds",
        false,
        "F counts inches under G70: must be said for an inch program."
    ),
    OptionSpec::flag(
        "arcs_off_xy",
        false,
        "Arcs in G18 and G19: P-CHAN-00420 must keep the length along Z, or a line of your own with #TLAX [Z+].",
    ),
    options::cycles_in_plane(true),
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "P-CHAN-00108 feedrate_factor = 100: F counts mm a minute",
    "P-CHAN-00011, P-CHAN-00096: F counts along X, Y and Z",
    "P-CHAN-00439 = 0: tolerances of smoothing are in mm in an inch program too",
    "P-CHAN-00014 einrechnen_mit_t = 0: T alone does not change the length",
    "P-CHAN-00394 rotation_sequence = ZYX: angles of #CS",
    "P-CHAN-00420 or #TLAX [Z+] where arcs are written in G18 or G19: the length stays along Z",
    "#MCS, #CS and #TRAFO are parts of the option Transformations",
    "under #TRAFO and #CS coordinates stay with the part",
    "rotary axes count whole turns: they are no modulo axes",
];

/// Words that it reads and that are not written here, or that mean something else than those of other controls.
const OWN: &[(&str, Meaning)] = &[
    (";", Meaning::Remark),
    ("G161", Meaning::CentreAbsolute),
    ("G162", Meaning::CentreIncremental),
    ("G4 S", Meaning::DwellTurns),
    ("G8", Meaning::Nothing),
    ("G9", Meaning::ExactStop),
    ("G20", Meaning::MirrorOff),
    ("G21", Meaning::Mirror),
    ("G22", Meaning::Mirror),
    ("G23", Meaning::Mirror),
    ("G51", Meaning::Diameter),
    ("G52", Meaning::DiameterOff),
    ("G60", Meaning::ExactStop),
    ("G61", Meaning::Smoothing),
    ("G80", Meaning::Subprogram),
    ("G81", Meaning::Subprogram),
    ("G82", Meaning::Subprogram),
    ("G83", Meaning::Subprogram),
    ("G84", Meaning::Subprogram),
    ("G85", Meaning::Subprogram),
    ("G86", Meaning::Subprogram),
    ("G87", Meaning::Subprogram),
    ("G88", Meaning::Subprogram),
    ("G89", Meaning::Subprogram),
    ("#RTCP ON", Meaning::TcpOn),
    ("#RTCP OFF", Meaning::TcpOff),
    ("#TRAFO ON", Meaning::TcpOn),
    ("#TRAFO OFF", Meaning::TcpOff),
    ("#CS ON", Meaning::TiltedPlane),
    ("#CS OFF", Meaning::TiltedPlaneOff),
    ("#HSC ON", Meaning::Smoothing),
    ("#HSC OFF", Meaning::SmoothingOff),
    ("#KIN ID", Meaning::Nothing),
    ("M17", Meaning::SubprogramEnd),
    ("M29", Meaning::SubprogramEnd),
];

export_dialect!(isg, Iso<Isg>);
