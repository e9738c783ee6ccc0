//! A control of the G-code family: most of it is a table.

use post_iso::{Control, Dwell, Iso, Table, Tcp, options};
use post_plugin::{Setup, export_dialect};

struct Writer;

impl Control for Writer {
    const TABLE: &'static Table = &Table {
        options: &[options::BLOCK_NUMBERS, options::BLOCK_STEP, options::decimals(3)],
        // In the place of G43: G234 H1 X Y Z.
        tcp: Tcp::Length("G234"),
        dwell: Dwell::Seconds("P", 3),
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Writer)
    }
}

export_dialect!(gcode, Iso<Writer>);
