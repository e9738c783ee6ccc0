//! Fanuc 30i, 31i: G-code with modal words, a point in every number, remarks in capitals.
//!
//! What it assumes about the control stands in `plugins/README.md`.

use post_iso::{Control, Iso, Offset, Table, Tcp, options};
use post_plugin::{OptionSpec, Setup, export_dialect, remark};

struct Fanuc {
    /// The O number.
    number: i64,
}

impl Control for Fanuc {
    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        largest_number: 99_999_999,
        offset: Offset {
            known: is_work_offset,
            range: "G54 to G59 or G54.1 P1 to P300",
            ..Table::ISO.offset
        },
        relies: RELIES,
        cancel: CANCEL,
        tcp: Tcp::Length("G43.4"),
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let number = setup.integer("program_number");
        Ok(Fanuc { number })
    }

    fn title(&self, program: &str) -> String {
        format!("O{:04} {}", self.number, remark(program))
    }
}

fn is_work_offset(text: &str) -> bool {
    let number = |digits: &str| digits.parse().unwrap_or(0);
    match text.strip_prefix("G54.1 P") {
        Some(digits) => (1..=300).contains(&number(digits)),
        None => text
            .strip_prefix('G')
            .is_some_and(|digits| (54..=59).contains(&number(digits))),
    }
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::integer("program_number", (1, 9999), 1000, "The O number."),
    options::BLOCK_NUMBERS,
    options::BLOCK_STEP,
    options::decimals(3),
    options::decimals_inch(4),
    options::rotary_decimals(3),
    options::TRAILING_ZEROS,
    options::feed_decimals(1),
    options::inverse_time_decimals(3),
    options::most_inverse_time(9999.999),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    OptionSpec::lines(
        "cancel",
        CANCEL,
        "Block at the start that cancels scaling, mirror and rotation; less on a control without one of them.",
    ),
    options::RETRACT,
    options::PARAMETERS,
    OptionSpec::integer(
        "length_register",
        (0, 999),
        0,
        "H of a program that loads no tool; 0: such a program is refused.",
    ),
    options::COOLANT_OFF,
    options::COOLANT_THROUGH,
    options::COOLANT_THROUGH_OFF,
    options::COOLANT_AIR,
    options::COOLANT_AIR_OFF,
];

/// Numbers of parameters are those of the 30i, 31i, 32i (B-63950EN, B-64490EN).
const RELIES: &[&str] = &[
    "1008#0 ROA, #1 RAB: a rotary word is where the axis stands, whole turns counted; roll-over off",
    "1401#1 LRP = 1: rapids go straight; with 0 the axes arrive one after the other",
    "5006#6 TOS: either; G53 has taken the length off before G49 cancels it",
    "19696#5 WKP = 0: under G43.4 coordinates stay with the table",
    "one M code a block is enough, G53 counts from the machine's zero",
];

/// Scaling, programmable mirror image, rotation and tilted plane off.
const CANCEL: &str = "G50 G50.1 G69";

export_dialect!(fanuc, Iso<Fanuc>);

#[cfg(test)]
mod tests;
