//! Okuma OSP, machining centres: work offsets by G15 H, length by G56 H, positions of the machine by G16 H0.
//!
//! What it assumes about the control stands in `plugins/README.md`.

use post_iso::{
    Codes, Control, Dwell, Iso, Leave, Length, Offset, Subprogram, Table, Tcp, iso_options, options,
};
use post_plugin::{OptionKind, OptionSpec, Setup, Units, Value, export_dialect};

struct Okuma;

impl Control for Okuma {
    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        extension: "MIN",
        percent: false,
        title: Some(("O", 4)),
        line_length: Some(158),
        // The control's parameters choose the units, and its formula for inverse time is the machine's own.
        codes: Codes {
            units: ["", ""],
            feed: ["G94", "", "G95"],
            ..Codes::ISO
        },
        offset: Offset {
            known: |text| number(text).is_some_and(|number| (1..=200).contains(&number)),
            range: "G15 H1 to H200",
            word: |number| {
                (1..=200)
                    .contains(&number)
                    .then(|| format!("G15 H{number}"))
            },
            at_start: false,
        },
        // No word that ends it is beyond doubt: positions of the machine count without it, the next tool has its own.
        length: Length {
            on: "G56",
            off: "",
            ..Table::ISO.length
        },
        relies: RELIES,
        tcp: Tcp::Blocks {
            on: "",
            off: "",
            length_first: false,
        },
        machine: "G16 H0 G0",
        leave: &[Leave::Tcp, Leave::Retract, Leave::Length],
        cycles: &[],
        dwell: Dwell::Seconds("F", 2),
        subprogram: Subprogram {
            number: "CALL O{}",
            name: "CALL {}",
            times: "",
        },
        end: "M2",
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let wanted = match setup.units {
            Units::Millimetre => "1 mm",
            Units::Inch => "1 inch",
        };
        match setup.text("unit_system") {
            named if named == wanted => Ok(Okuma),
            "" => Err(
                "what a number means is a parameter of this control, and a point does not override it: say which unit \
                 system it has by the option `unit_system`"
                    .to_owned(),
            ),
            other => Err(format!(
                "the numbers of this program count in units of {wanted}, and the unit system of the control is {other}: \
                 it would read them otherwise"
            )),
        }
    }
}

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
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "the unit system is 1 mm, or 1 inch: the units of the program are those of the parameters",
    "G16 H0: the positions of this block count from the machine's zero, without the length",
    "G4 F is in seconds: confirm at the machine",
];

export_dialect!(okuma, Iso<Okuma>);

#[cfg(test)]
mod tests;
