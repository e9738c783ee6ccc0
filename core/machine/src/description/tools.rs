//! `[tools]`: lengths by tool number, and the file of the control, the presetter or the CAM system that has the tools.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::build::Builder;
use super::file::OutputUnits;
use super::outline::{ToolOutline, ToolOutlineFile};
use super::quantity::KeyedNumber;
use super::table::{
    DeTable, DeValue, EntryError, Key, KeyType, Schemas, Spanned, Value, entries, keys,
};
use crate::diagnostic::{Diagnostic, Short, SourcePlace};

/// Endings of files of tools. A machine file may be a stranger's: what it names is not any file of the user's.
pub const TOOL_FILE_ENDINGS: &[&str] = &[
    "tbl", "t", "nc", "tap", "cnc", "ngc", "eia", "txt", "ini", "toa", "spf", "mpf", "arc", "json",
    "fctl", "fctb", "csv", "tls",
];

/// A tool as a tool table, an offset memory, a library or a CL file has it: the same whoever gives it. Lengths in mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolData {
    /// Number that the program calls it by.
    pub number: u32,
    /// Name or remark, one line; empty if it has none.
    pub name: String,
    /// From the gauge point to the tip, without wear, as measured; counted from another tool's tip where the file says
    /// so. None where the file has no such length.
    pub length: Option<f64>,
    /// What is added to the length, for wear and resharpening.
    pub length_wear: f64,
    /// Radius of the cutter, without wear.
    pub radius: Option<f64>,
    /// What is added to the radius.
    pub radius_wear: f64,
    /// Radius of the cutter's corner: its radius for a ball, 0 for a flat end.
    pub corner_radius: Option<f64>,
    /// From the holder's face to the tip.
    pub stick_out: Option<f64>,
    /// What holds it; empty if that is not known.
    pub holder: String,
    /// Most revolutions a minute that it may turn.
    pub most_rpm: Option<f64>,
    /// Place in the magazine.
    pub pocket: Option<u32>,
    /// Line of the file that has it, from 1.
    pub line: u64,
}

/// How far the diameter of a cutter in the CL file may be from that of the tool, mm: another tool is farther off.
const SAME_DIAMETER: f64 = 0.05;

impl ToolData {
    /// From the gauge point to the tip as the control counts, wear with it, mm.
    pub fn total_length(&self) -> Option<f64> {
        self.length.map(|length| length + self.length_wear)
    }

    /// Diameter of the cutter as the control counts, wear with it, mm.
    pub fn diameter(&self) -> Option<f64> {
        self.radius.map(|radius| 2.0 * (radius + self.radius_wear))
    }

    /// What is wrong where a CL file calls tool `number` by its own cutter's diameter, mm, and this one, of `file`, is
    /// another: the finding has no place yet.
    pub fn other_cutter(
        &self,
        number: u32,
        diameter: Option<f64>,
        file: &str,
    ) -> Option<Diagnostic> {
        let made_for = diameter.filter(|diameter| *diameter > 0.0)?;
        let has = self.radius.filter(|radius| *radius > 0.0)? * 2.0;
        if libm::fabs(made_for - has) <= SAME_DIAMETER {
            return None;
        }
        let message = format!(
            "tool {number} is {} mm in diameter in the CL file, {} mm in {file}:{}",
            Short(made_for),
            Short(has),
            self.line
        );
        let help = "is another tool in its place, or are the units of that file others?";
        Some(Diagnostic::warning("tool-differs", message).help(help))
    }

    /// What is wrong with a spindle speed, rpm: the finding has no place yet.
    pub fn refuse_speed(&self, rpm: f64, file: &str) -> Option<Diagnostic> {
        let most = self.most_rpm.filter(|most| rpm > *most)?;
        let Self { number, line, .. } = self;
        let message = format!(
            "tool {number} would turn at {} rpm, {file}:{line} allows it {} rpm",
            Short(rpm),
            Short(most)
        );
        let help =
            "another speed in the CAM system, or the limit of the right tool in the file of tools";
        Some(Diagnostic::error("tool-speed", message).help(help))
    }
}

/// The file that has the tools of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolTable {
    /// The file, as seen from the folder that the command works in.
    pub file: PathBuf,
    /// Name of its format; none: as its name and text say.
    pub format: Option<String>,
    /// Its lengths are in inches where its format does not say in what; none: as the control's programs are.
    pub inch: Option<bool>,
    /// Length of the tool that its lengths count from, mm: 0 where they count from the gauge point.
    pub reference: f64,
    /// Columns of a table whose heads are not those of the format, by what stands in them.
    pub columns: BTreeMap<String, String>,
    /// Where the machine file names it; none for one of the command line.
    pub place: Option<SourcePlace>,
    /// It is a memory of offsets: its numbers are those of registers (H and D), not of tools.
    pub by_register: bool,
    /// Its tools; none before it is read.
    pub tools: Option<Vec<ToolData>>,
    /// What is to be said of it, once a run; none of it is an error.
    pub findings: Vec<Diagnostic>,
}

impl ToolTable {
    /// What messages call it.
    pub fn name(&self) -> String {
        self.file.display().to_string()
    }

    /// What it has of the tool of this number, whose length stands in this register; none before it is read.
    pub fn entry(&self, number: u32, register: u32) -> Option<&ToolData> {
        let wanted = if self.by_register { register } else { number };
        self.tools.iter().flatten().find(|tool| tool.number == wanted)
    }
}

keys! {
    /// Lengths of tools by number, mm from the gauge point to the tip, and the file of tools.
    ToolFileKeys {
        /// A file of tools: the control's tool table (LinuxCNC `tool.tbl`, Heidenhain `TOOL.T`), its offsets as a program
        /// (Fanuc and Haas G10, Siemens TOA), a CAM system's library (FreeCAD, Fusion and HSM), or a table of a presetter
        /// (CSV). A path is that from this file; an empty one takes away what an extended machine names. `--tools FILE` for
        /// one job.
        file: Option<Spanned<String>>,
        /// Format of that file, if name and text do not say it: see `post tools --formats`.
        format: Option<String>,
        /// Units of its lengths where its format does not say it; those of the control's programs if not said.
        units: Option<OutputUnits>,
        /// Length of the tool that its lengths count from, mm: for a table whose lengths were touched off against a tool of
        /// known length; 0 if not said, they count from the gauge point.
        reference: Option<KeyedNumber>,
        /// Heads of the columns of a CSV table by what stands in them: `number = "T"`, `length = "Z"`, `radius`,
        /// `diameter`, `length_wear`, `radius_wear`, `corner_radius`, `name`, `holder`, `stick_out`, `most_rpm`, `pocket`.
        columns: BTreeMap<String, String>,
    }
}

/// `[tools]` as it stands in a machine file.
#[derive(Debug)]
pub(crate) struct ToolsFile {
    /// What is said of the file of tools.
    pub keys: ToolFileKeys,
    /// Lengths by what stands for a number.
    pub lengths: BTreeMap<String, KeyedNumber>,
    /// Outlines, likewise.
    pub outlines: Vec<(String, Spanned<ToolOutlineFile>)>,
}

impl KeyType for ToolsFile {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let mut named = DeTable::new();
        let mut lengths = BTreeMap::new();
        let mut outlines = Vec::new();
        for (name, value) in entries(value, "a map")? {
            let text = name.get_ref().as_ref();
            if ToolFileKeys::KEYS.iter().any(|key| key.name == text) {
                named.insert(name.clone(), value.clone());
            } else if matches!(value.get_ref(), DeValue::Table(_)) {
                let mut outline = ToolOutlineFile::read(value, key)?;
                lengths.extend(outline.length.take().map(|length| (text.to_owned(), length)));
                outlines.push((text.to_owned(), Spanned::new(name.span(), outline)));
            } else {
                lengths.insert(text.to_owned(), KeyedNumber::read(value, key)?);
            }
        }
        Ok(Self { keys: ToolFileKeys::of(&named, value.span())?, lengths, outlines })
    }

    fn absent() -> Option<Self> {
        Some(Self { keys: ToolFileKeys::absent()?, lengths: BTreeMap::new(), outlines: Vec::new() })
    }

    fn schema(named: &mut Schemas) -> Value {
        ToolFileKeys::schema(named);
        let mut schema = named.remove("ToolFileKeys").unwrap_or_default();
        let tool = [KeyedNumber::schema(named), ToolOutlineFile::schema(named)];
        schema["patternProperties"] = json!({ "^[0-9]+$": { "anyOf": tool } });
        named.insert("ToolsFile".to_owned(), schema);
        json!({ "$ref": "#/definitions/ToolsFile" })
    }
}

impl Builder<'_> {
    /// Lengths by number.
    pub(super) fn tool_lengths(&mut self, file: &ToolsFile) -> Vec<(u32, f64)> {
        let mut tools = Vec::new();
        for (number, length) in &file.lengths {
            match number.parse() {
                Ok(number) => {
                    let value = self.number(length);
                    if value < 0.0 {
                        let message =
                            format!("tool {number} has the length {}, below zero", Short(value));
                        let help = "lengths go from the gauge point to the tip";
                        self.fault("machine-tools", length.span(), message, help);
                    }
                    tools.push((number, value));
                }
                Err(_) => self.fault(
                    "machine-tools",
                    length.span(),
                    format!("[tools] has {number}, which is no tool number"),
                    "1 = 120.5 gives tool 1 the length 120.5 mm; file = \"tool.tbl\" names a file of tools",
                ),
            }
        }
        tools
    }

    /// How far tools reach from their axes, by number.
    pub(super) fn tool_outlines(&mut self, file: &ToolsFile) -> Vec<ToolOutline> {
        let mut outlines = Vec::new();
        for (number, outline) in &file.outlines {
            let ToolOutlineFile { holder, cutter, edge, .. } = outline.get_ref();
            let edge = self.checked(edge);
            let holder = self.holder(&format!("the holder of tool {number}"), holder);
            let cutter = self.cutter(&format!("the cutter of tool {number}"), cutter);
            match number.parse() {
                Ok(number) => outlines.push(ToolOutline { number, holder, cutter, edge }),
                Err(_) => {
                    let message = format!("[tools] has {number}, which is no tool number");
                    let help = "[tools.1] describes tool 1";
                    self.fault("machine-tools", outline.span(), message, help);
                }
            }
        }
        outlines
    }

    /// The file of tools, if one is named.
    pub(super) fn tool_table(&mut self, file: &ToolFileKeys) -> Option<ToolTable> {
        let reference = file.reference.as_ref().map_or(0.0, |reference| self.number(reference));
        let named = file.file.as_ref().filter(|named| !named.get_ref().is_empty())?;
        let path = Path::new(named.get_ref());
        let place = self.sources.place(named.span());
        let told = place.as_ref().is_some_and(|at| at.file == super::layers::SETTING);
        let ending = path.extension().unwrap_or_default();
        if !told && !TOOL_FILE_ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)) {
            let message = format!("`{}` is no name of a file of tools", named.get_ref());
            let help = format!("it ends in one of .{}", TOOL_FILE_ENDINGS.join(", ."));
            self.fault("machine-tools", named.span(), message, &help);
            return None;
        }
        let folder = place.as_ref().filter(|_| !told).and_then(|at| Path::new(&at.file).parent());
        Some(ToolTable {
            file: folder.unwrap_or_else(|| Path::new("")).join(path),
            format: file.format.clone().filter(|format| !format.is_empty()),
            inch: file.units.map(|units| units == OutputUnits::Inch),
            reference,
            columns: file.columns.clone(),
            place: place.filter(|_| !told),
            by_register: false,
            tools: None,
            findings: Vec::new(),
        })
    }
}
