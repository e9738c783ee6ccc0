//! Lists of points in the place of a CL file: CSV with a header, or JSON.
//!
//! Both become rows of the same columns, and a row becomes the records that a CL file would have for it, in one place:
//! whatever reads CL files reads lists too. Positions are those of the tip in the part frame, in the list's units;
//! directions point from the tip to the holder.

mod csv;
mod json;
mod row;
mod setting;

use std::collections::VecDeque;
use std::sync::Arc;

use crate::cl::{
    CircleRecord, CoolantWord, FeedRate, FeedUnit, LoadTool, Sense, SpindleUnit, SpindleWord,
    Statement, Units,
};
use crate::fault::SyntaxFault;

pub(crate) use csv::CsvList;
pub(crate) use json::{JsonList, MOST_JSON};
use row::{Row, RowColumns};
use setting::{Setting, Settings};

/// What is shown of a name, and of a line on either side of a fault, bytes.
const SHOWN: usize = 60;

/// A list, by how it is written.
#[derive(Debug)]
pub(crate) enum PointList {
    /// Line by line.
    Csv(Box<CsvList>),
    /// In one piece, which stands here as it was read.
    Json {
        /// The text.
        text: String,
        /// How far it is taken.
        list: Box<JsonList>,
    },
}

/// What a file is that begins so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ListForm {
    Csv,
    Json,
}

impl ListForm {
    /// None: the file is no list of points.
    pub(crate) fn of(head: &[u8]) -> Option<Self> {
        let head = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head);
        match head.trim_ascii_start().first()? {
            b'{' | b'[' => Some(Self::Json),
            _ => csv::begins(head).then_some(Self::Csv),
        }
    }
}

/// A text is a list of points for certain: a line of its beginning names the columns x, y and z, or it is JSON that has points
/// or these columns. A file that is to be posted need not be one for certain ([`ListForm`]); one that is open in an editor may
/// be any other table.
pub fn is_point_list(text: &str) -> bool {
    const SURE: usize = 4096;
    let mut end = SURE.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let head = &text[..end];
    match ListForm::of(head.as_bytes()) {
        None => false,
        Some(ListForm::Csv) => csv::heads(head),
        Some(ListForm::Json) => {
            let keys = |keys: &[&str]| keys.iter().all(|key| head.contains(&format!("\"{key}\"")));
            keys(&["points"]) || keys(&["x", "y", "z"])
        }
    }
}

/// Where a record stands that is none of the row that was taken last: its line and the text of that.
#[derive(Debug)]
pub(crate) struct RecordPlace {
    pub(crate) line: u64,
    pub(crate) text: String,
}

/// A record of a row, and where it stands if that is elsewhere.
pub(crate) type PlacedRecord = (Statement, Option<Arc<RecordPlace>>);

/// Rows to records: what they say that is modal is said where it changes.
#[derive(Debug, Default)]
pub(crate) struct RowRecords {
    queue: VecDeque<PlacedRecord>,
    /// The end was told.
    ended: bool,
    /// The feed that is in force, units a minute.
    feed: Option<f64>,
    /// A row was taken.
    begun: bool,
}

impl RowRecords {
    /// The next record of what was taken last.
    pub(crate) fn next(&mut self) -> Option<PlacedRecord> {
        self.queue.pop_front()
    }

    /// There is one.
    pub(crate) fn waits(&self) -> bool {
        !self.queue.is_empty()
    }

    /// What stands ahead of the points: each record where its setting stands.
    fn settings(&mut self, settings: &Settings) {
        let Settings { units, tool, spindle, coolant, name, .. } = settings;
        let units = Statement::Units(units.unwrap_or(Units::Millimetre));
        let load = |number| Statement::LoadTool(LoadTool { number, ..LoadTool::default() });
        let turn = |speed| {
            Statement::Spindle(SpindleWord::On {
                speed: Some(speed),
                unit: SpindleUnit::Rpm,
                sense: Some(Sense::Clockwise),
                most: None,
            })
        };
        let said = [
            (name.clone().map(Statement::PartName), Setting::Name),
            (Some(units), Setting::Units),
            (tool.map(load), Setting::Tool),
            (spindle.map(turn), Setting::Spindle),
            (coolant.map(Statement::Coolant), Setting::Coolant),
        ];
        let placed = said.into_iter();
        let placed = placed.filter_map(|(said, setting)| Some((said?, settings.place(setting))));
        self.queue.extend(placed);
    }

    /// A point: it is come to cutting, unless it is the first or says otherwise.
    fn row(&mut self, row: Row, settings: &Settings) {
        let cuts = row.cuts.unwrap_or(self.begun || row.arc.is_some());
        self.begun = true;
        let feed = row.feed.or(settings.feed.filter(|_| cuts));
        if let Some(value) = feed.filter(|feed| self.feed != Some(*feed)) {
            let unit = Some(FeedUnit::PerMinute);
            let feed = Statement::Feed(FeedRate { value: Some(value), unit });
            self.queue.push_back((feed, None));
            self.feed = Some(value);
        }
        if !cuts {
            self.queue.push_back((Statement::Rapid, None));
        }
        let circle = row.arc.map(|arc| {
            Statement::Circle(CircleRecord {
                centre: arc.centre,
                axis: arc.axis,
                radius: None,
                sense: Some(Sense::CounterClockwise),
                turns: None,
            })
        });
        self.queue.extend(circle.map(|circle| (circle, None)));
        self.queue.push_back((Statement::Goto { point: row.point, axis: row.axis }, None));
    }

    /// The list is over; true if that was told before.
    fn end(&mut self) -> bool {
        if !self.ended {
            self.queue.push_back((Statement::Fini, None));
        }
        std::mem::replace(&mut self.ended, true)
    }
}

/// A value of a list, whichever way it is written.
#[derive(Clone, Debug, PartialEq)]
enum Cell {
    Empty,
    Number(f64),
    Flag(bool),
    Text(String),
}

/// What is wrong with a row or a setting, and with which of its cells, counted from 0; none: with the row as a whole.
#[derive(Debug)]
struct CellFault {
    cell: Option<usize>,
    message: String,
    help: String,
}

impl CellFault {
    fn at(cell: usize, message: String, help: impl Into<String>) -> Self {
        Self { cell: Some(cell), message, help: help.into() }
    }

    fn whole(message: String, help: impl Into<String>) -> Self {
        Self { cell: None, message, help: help.into() }
    }

    /// In its text, of which `span` gives the place of a cell.
    fn told(self, text: &str, span: impl FnOnce(usize) -> std::ops::Range<usize>) -> SyntaxFault {
        let span = self.cell.map_or(0..text.len(), span);
        SyntaxFault::new(text, span, self.message).help(self.help)
    }
}
