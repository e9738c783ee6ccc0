//! `tool.tbl` of LinuxCNC: a line a tool, words of a letter and a number in any order, a remark behind `;`.

use std::fmt::Write as _;

use post_machine::description::ToolData;

use super::reading::ToolReading;
use super::written::{TableUnits, plain_name};

/// Offsets along and about the other axes: G43 applies them too.
const OTHER_AXES: &str = "XYABCUVW";

/// Angles and the orientation of turning tools.
const TURNING: &str = "IJQ";

/// What the line of heads begins with that tables of an old form have.
const OLD_HEAD: &str = "TOOLNO";

/// Its first line that says something begins with the number of a tool.
pub(super) fn looks(text: &str) -> bool {
    let mut lines =
        text.lines().map(str::trim_start).filter(|line| !line.is_empty() && !line.starts_with(';'));
    let Some(first) = lines.next() else { return false };
    let mut bytes = first.bytes();
    let begins = bytes.next().is_some_and(|letter| letter.eq_ignore_ascii_case(&b'T'));
    begins && bytes.next().is_some_and(|digit| digit.is_ascii_digit())
}

pub(super) fn read(reading: &mut ToolReading<'_>) {
    for (line, text) in reading.lines() {
        let (words, remark) = text.split_once(';').unwrap_or((text, ""));
        if words.trim().is_empty() {
            continue;
        }
        if words.trim_start().starts_with(OLD_HEAD) {
            let message = "the table has columns below heads, as LinuxCNC had them long ago";
            let help = "let LinuxCNC write it anew; a line is T1 P1 Z120.5 D10 ;remark";
            reading.fault(line, message.to_owned(), help);
            return;
        }
        if let Some(tool) = tool(reading, line, words) {
            reading.tool(ToolData { name: remark.to_owned(), ..tool });
        }
    }
}

/// The words of a line.
fn tool(reading: &mut ToolReading<'_>, line: u64, words: &str) -> Option<ToolData> {
    let unit = reading.unit;
    let mut tool = ToolData { line, ..ToolData::default() };
    let mut met = String::new();
    for word in words.split_whitespace() {
        let mut signs = word.chars();
        let letter = signs.next()?.to_ascii_uppercase();
        let value = signs.as_str();
        if !"TPZD".contains(letter) && !OTHER_AXES.contains(letter) && !TURNING.contains(letter) {
            let message = format!("{} is no word of a tool table", reading.quoted(word));
            let help = "words are T, P, X Y Z A B C U V W, D, I J Q with their numbers; a remark stands behind `;`";
            reading.fault(line, message, help);
            return None;
        }
        if met.contains(letter) {
            reading.fault(line, format!("{letter} stands there twice"), "each word once");
            return None;
        }
        met.push(letter);
        match letter {
            'T' => tool.number = reading.tool_number(line, value)?,
            'P' => tool.pocket = Some(reading.tool_number(line, value)?),
            'Z' => tool.length = Some(reading.number(line, "Z", value)? * unit),
            'D' => tool.radius = Some(reading.number(line, "D", value)? * unit / 2.0),
            _ => {
                let number = reading.number(line, &letter.to_string(), value)?;
                if number != 0.0 && OTHER_AXES.contains(letter) {
                    let message = format!(
                        "{letter}{value} is left out: the tool has an offset beside its length"
                    );
                    let help = "G43 applies it on the machine too; a program for the mill counts with Z alone";
                    reading.warn(line, message, help);
                }
            }
        }
    }
    if met.contains('T') {
        return Some(tool);
    }
    let help = "a line is T1 P1 Z120.5 D10 ;remark";
    reading.fault(line, "the line has no T".to_owned(), help);
    None
}

pub(super) fn write(tools: &[ToolData], units: TableUnits) -> String {
    let mut text = String::new();
    for tool in tools {
        let number = tool.number;
        let _ = write!(text, "T{number} P{}", tool.pocket.unwrap_or(number));
        if let Some(length) = tool.total_length() {
            let _ = write!(text, " Z{}", units.signed(length));
        }
        if let Some(diameter) = tool.diameter() {
            let _ = write!(text, " D{}", units.signed(diameter));
        }
        let _ = writeln!(text, " ;{}", plain_name(&tool.name, ";"));
    }
    text
}
