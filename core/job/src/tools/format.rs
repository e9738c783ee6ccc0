//! The formats of files of tools, one row each, and which of them a file has.

use post_machine::description::{ToolData, ToolTable};
use post_machine::diagnostic::{Diagnostic, meant};

use super::reading::ToolReading;
use super::written::TableUnits;
use super::{
    csv_table, freecad, fusion, heidenhain, linuxcnc, machine_toml, offset_program, siemens,
};

/// A format of files of tools.
#[derive(Debug)]
pub struct ToolFormat {
    /// Name that `--from`, `--to` and `[tools] format` have for it.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// What its lengths are, and what is taken of it besides.
    pub has: &'static str,
    /// Endings of its files, by which a text that is written gets its format.
    pub endings: &'static [&'static str],
    /// Its numbers are those of registers, not of tools.
    pub by_register: bool,
    /// Whether a text looks like it.
    looks: fn(&str) -> bool,
    /// Reads a text.
    pub(super) read: fn(&mut ToolReading<'_>),
    /// Writes tools; none: it is read alone.
    pub write: Option<fn(&[ToolData], TableUnits) -> String>,
}

/// All of them; where a text looks like several, the first is meant.
pub static FORMATS: &[ToolFormat] = &[
    ToolFormat {
        name: "heidenhain",
        about: "tool table TOOL.T of a TNC",
        has: "L with DL, R with DR, R2, NMAX, NAME; units of its first line",
        endings: &["t"],
        by_register: false,
        looks: heidenhain::looks,
        read: heidenhain::read,
        write: Some(heidenhain::write),
    },
    ToolFormat {
        name: "siemens",
        about: "tool offsets of a SINUMERIK, $TC_DP…[T,1]=…",
        has: "length 1 with wear and base, radius with wear, corner, largest speed, name; first cutting edges",
        endings: &["ini", "toa", "spf", "mpf", "arc"],
        by_register: false,
        looks: siemens::looks,
        read: siemens::read,
        write: Some(siemens::write),
    },
    ToolFormat {
        name: "fanuc",
        about: "offset memory C as a program, G10 L10 to L13, D holds radii",
        has: "H geometry and wear, D geometry and wear; units of G20 and G21",
        endings: &["nc", "tap", "cnc", "eia"],
        by_register: true,
        looks: offset_program::looks,
        read: offset_program::read_radii,
        write: Some(offset_program::write_radii),
    },
    ToolFormat {
        name: "haas",
        about: "the same, D holds diameters (setting 40)",
        has: "as fanuc, D halved",
        endings: &[],
        by_register: true,
        looks: |_| false,
        read: offset_program::read_diameters,
        write: Some(offset_program::write_diameters),
    },
    ToolFormat {
        name: "fusion",
        about: "tool library of Fusion and HSM, exported as JSON",
        has: "gauge length of the assembly, diameter, corner, stick-out, holder, number; units of each tool",
        endings: &["json"],
        by_register: false,
        looks: fusion::looks,
        read: fusion::read,
        write: None,
    },
    ToolFormat {
        name: "freecad",
        about: "tool library of FreeCAD, .fctl with its .fctb files",
        has: "number, name, diameter; it has no length from the gauge point",
        endings: &["fctl", "fctb"],
        by_register: false,
        looks: freecad::looks,
        read: freecad::read,
        write: None,
    },
    ToolFormat {
        name: "linuxcnc",
        about: "tool table tool.tbl of LinuxCNC",
        has: "Z, D (a diameter), P, remark; units of the machine",
        endings: &["tbl"],
        by_register: false,
        looks: linuxcnc::looks,
        read: linuxcnc::read,
        write: Some(linuxcnc::write),
    },
    ToolFormat {
        name: "csv",
        about: "table with a row of heads, of a presetter or a spreadsheet",
        has: "what its columns have ([tools] columns)",
        endings: &["csv", "txt", "tls"],
        by_register: false,
        looks: |_| false,
        read: csv_table::read,
        write: Some(csv_table::write),
    },
    ToolFormat {
        name: "machine",
        about: "[tools] of a machine file",
        has: "lengths with wear, mm",
        endings: &["toml"],
        by_register: false,
        looks: machine_toml::looks,
        read: machine_toml::read,
        write: Some(machine_toml::write),
    },
];

/// The format of this name.
///
/// # Errors
/// There is none.
pub fn format_named(name: &str) -> Result<&'static ToolFormat, Box<Diagnostic>> {
    FORMATS.iter().find(|format| format.name == name).ok_or_else(|| {
        let names: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
        let message = format!("there is no format `{name}` of files of tools");
        Diagnostic::error("tools", message).help(meant(name, "there are", &names)).boxed()
    })
}

/// The format of files that end so.
pub(super) fn by_ending(ending: &str) -> Option<&'static ToolFormat> {
    FORMATS.iter().find(|format| format.endings.iter().any(|own| ending.eq_ignore_ascii_case(own)))
}

/// The format of a file: the one that is named, else the one that its text looks like, else that of its ending.
pub(super) fn of(table: &ToolTable, text: &str) -> Result<&'static ToolFormat, Box<Diagnostic>> {
    if let Some(name) = &table.format {
        return format_named(name).map_err(|fault| fault.at(table.place.clone()).boxed());
    }
    if let Some(format) = FORMATS.iter().find(|format| (format.looks)(text)) {
        return Ok(format);
    }
    let ending = table.file.extension().unwrap_or_default().to_string_lossy().into_owned();
    by_ending(&ending).ok_or_else(|| {
        let message =
            format!("{}: neither its name nor its text says what format it has", table.name());
        Diagnostic::error("tools", message)
            .help("name it: --set tools.format=NAME; `post tools --formats` has the names")
            .at(table.place.clone())
            .boxed()
    })
}
