//! Offset memories as programs of G10: L10 and L11 are geometry and wear of H, L12 and L13 of D, P the register, R the
//! value (memory C of Fanuc; Haas).

use std::fmt::Write as _;

use post_machine::description::ToolData;

use super::reading::ToolReading;
use super::written::{TableUnits, plain_name};

pub(super) fn looks(text: &str) -> bool {
    let mut lines = text.lines();
    lines.any(|line| {
        let words = words(line).unwrap_or_default();
        let has = |letter, value| words.iter().any(|word| word.letter == letter && word.is(value));
        has('G', 10.0) && [10.0, 11.0, 12.0, 13.0].into_iter().any(|kind| has('L', kind))
    })
}

/// A word of a block.
#[derive(Clone, Copy)]
struct BlockWord<'t> {
    letter: char,
    text: &'t str,
}

impl BlockWord<'_> {
    fn is(&self, value: f64) -> bool {
        self.text.parse() == Ok(value)
    }
}

/// The words of a block without its remarks; none where something is no word.
fn words(block: &str) -> Option<Vec<BlockWord<'_>>> {
    let mut words = Vec::new();
    let mut rest = block;
    loop {
        rest = rest.trim_start_matches(|sign: char| sign.is_whitespace() || sign == '/');
        if let Some(remark) = rest.strip_prefix('(') {
            rest = remark.split_once(')').map_or("", |(_, behind)| behind);
            continue;
        }
        let Some(letter) = rest.chars().next().filter(|sign| !";%:".contains(*sign)) else {
            return Some(words);
        };
        let behind = &rest[letter.len_utf8()..];
        let end = behind.find(|sign: char| !"0123456789.+-".contains(sign)).unwrap_or(behind.len());
        if !letter.is_ascii_alphabetic() || end == 0 {
            return None;
        }
        words.push(BlockWord { letter: letter.to_ascii_uppercase(), text: &behind[..end] });
        rest = &behind[end..];
    }
}

/// The first remark of a block.
fn remark(block: &str) -> &str {
    let behind = block.split_once('(').map_or("", |(_, behind)| behind);
    behind.split_once(')').map_or("", |(remark, _)| remark).trim()
}

/// What the values of D are.
#[derive(Clone, Copy)]
enum CutterValue {
    Radius,
    Diameter,
}

impl CutterValue {
    /// How often the radius it is.
    fn radii(self) -> f64 {
        match self {
            Self::Radius => 1.0,
            Self::Diameter => 2.0,
        }
    }
}

pub(super) fn read_radii(reading: &mut ToolReading<'_>) {
    read(reading, CutterValue::Radius);
}

pub(super) fn read_diameters(reading: &mut ToolReading<'_>) {
    read(reading, CutterValue::Diameter);
}

/// What holds until another word is said.
#[derive(Clone, Copy)]
struct ModalState {
    /// mm a unit.
    unit: f64,
    /// G91: values are added to what the memory holds.
    adds: bool,
}

fn read(reading: &mut ToolReading<'_>, cutter: CutterValue) {
    let mut modal = ModalState { unit: reading.unit, adds: false };
    for (line, block) in reading.lines() {
        let Some(words) = words(block) else {
            let message = "the block cannot be read".to_owned();
            reading.fault(line, message, "a block is G10 L10 P1 R120.5; remarks stand in brackets");
            continue;
        };
        for word in words.iter().filter(|word| word.letter == 'G') {
            match word.text.parse::<f64>() {
                Ok(20.0) => modal.unit = 25.4,
                Ok(21.0) => modal.unit = 1.0,
                Ok(90.0) => modal.adds = false,
                Ok(91.0) => modal.adds = true,
                _ => {}
            }
        }
        if words.iter().any(|word| word.letter == 'G' && word.is(10.0)) {
            entry(reading, (line, block), &words, (modal, cutter));
        }
    }
}

/// What a G10 writes into the memory.
fn entry(
    reading: &mut ToolReading<'_>,
    (line, block): (u64, &str),
    words: &[BlockWord<'_>],
    (modal, cutter): (ModalState, CutterValue),
) {
    let of = |letter| words.iter().find(|word| word.letter == letter).map(|word| word.text);
    let kind = of('L').and_then(|kind| kind.parse::<u32>().ok());
    // L2 and L20 are work offsets, L3 the life of tools.
    let Some(kind @ (1 | 10..=13)) = kind else { return };
    let (Some(register), Some(value)) = (of('P'), of('R')) else {
        let message = format!("G10 L{kind} without P or R");
        reading.fault(line, message, "P is the register, R its value");
        return;
    };
    if modal.adds {
        let message = "G10 under G91 adds to what the memory holds, which is not known".to_owned();
        reading.fault(line, message, "let the control write its offsets under G90");
        return;
    }
    let Some(register) = reading.tool_number(line, register) else { return };
    let Some(number) = reading.number(line, "R", value) else { return };
    if number != 0.0 && !value.contains('.') {
        let message =
            format!("R{value} has no decimal point: what it counts is a parameter of the control");
        reading.fault(line, message, "write it with its point");
        return;
    }
    let size = number * modal.unit;
    let Some(tool) = reading.gathered(register, line) else {
        return;
    };
    if tool.name.is_empty() {
        remark(block).clone_into(&mut tool.name);
    }
    match kind {
        10 => tool.length = Some(size),
        12 => tool.radius = Some(size / cutter.radii()),
        13 => tool.radius_wear = size / cutter.radii(),
        _ => tool.length_wear = size,
    }
}

pub(super) fn write_radii(tools: &[ToolData], units: TableUnits) -> String {
    write(tools, units, CutterValue::Radius)
}

pub(super) fn write_diameters(tools: &[ToolData], units: TableUnits) -> String {
    write(tools, units, CutterValue::Diameter)
}

fn write(tools: &[ToolData], units: TableUnits, cutter: CutterValue) -> String {
    let unit = if units.inch { "G20" } else { "G21" };
    let mut text = format!("%\nO1000 (TOOL OFFSETS)\n{unit} G90\n");
    for tool in tools {
        let name = plain_name(&tool.name, "()");
        let name = if name.is_empty() { name } else { format!(" ({name})") };
        let length = tool.length.unwrap_or(0.0);
        let radius = tool.radius.unwrap_or(0.0) * cutter.radii();
        let wear = tool.radius_wear * cutter.radii();
        let number = tool.number;
        let _ = writeln!(text, "G10 L10 P{number} R{}{name}", units.length(length));
        for (kind, size) in [(11, tool.length_wear), (12, radius), (13, wear)] {
            let _ = writeln!(text, "G10 L{kind} P{number} R{}", units.length(size));
        }
    }
    text.push_str("M30\n%\n");
    text
}
