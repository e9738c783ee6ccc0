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

use crate::cl::{
    CircleRecord, CoolantWord, FeedRate, FeedUnit, LoadTool, Sense, SpindleUnit, SpindleWord,
    Statement, Units,
};
use crate::fault::SyntaxFault;

pub(crate) use csv::CsvList;
pub(crate) use json::{JsonList, MOST_JSON};
use row::{Row, RowColumns};
use setting::Settings;

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

/// Rows to records: what they say that is modal is said where it changes.
#[derive(Debug, Default)]
pub(crate) struct RowRecords {
    queue: VecDeque<Statement>,
    /// The end was told.
    ended: bool,
    /// The feed that is in force, units a minute.
    feed: Option<f64>,
    /// A row was taken.
    begun: bool,
}

impl RowRecords {
    /// The next record of what was taken last.
    pub(crate) fn next(&mut self) -> Option<Statement> {
        self.queue.pop_front()
    }

    /// There is one.
    pub(crate) fn waits(&self) -> bool {
        !self.queue.is_empty()
    }

    /// What stands ahead of the points.
    fn settings(&mut self, settings: &Settings) {
        let Settings { units, tool, spindle, coolant, name, .. } = settings;
        self.queue.extend(name.clone().map(Statement::PartName));
        self.queue.push_back(Statement::Units(units.unwrap_or(Units::Millimetre)));
        let load = |number| Statement::LoadTool(LoadTool { number, ..LoadTool::default() });
        self.queue.extend(tool.map(load));
        self.queue.extend(spindle.map(|speed| {
            Statement::Spindle(SpindleWord::On {
                speed: Some(speed),
                unit: SpindleUnit::Rpm,
                sense: Some(Sense::Clockwise),
                most: None,
            })
        }));
        self.queue.extend(coolant.map(Statement::Coolant));
    }

    /// A point: it is come to cutting, unless it is the first or says otherwise.
    fn row(&mut self, row: Row, settings: &Settings) {
        let cuts = row.cuts.unwrap_or(self.begun || row.arc.is_some());
        self.begun = true;
        let feed = row.feed.or(settings.feed.filter(|_| cuts));
        if let Some(value) = feed.filter(|feed| self.feed != Some(*feed)) {
            let unit = Some(FeedUnit::PerMinute);
            self.queue.push_back(Statement::Feed(FeedRate { value: Some(value), unit }));
            self.feed = Some(value);
        }
        if !cuts {
            self.queue.push_back(Statement::Rapid);
        }
        self.queue.extend(row.arc.map(|arc| {
            Statement::Circle(CircleRecord {
                centre: arc.centre,
                axis: arc.axis,
                radius: None,
                sense: Some(Sense::CounterClockwise),
                turns: None,
            })
        }));
        self.queue.push_back(Statement::Goto { point: row.point, axis: row.axis });
    }

    /// The list is over; true if that was told before.
    fn end(&mut self) -> bool {
        if !self.ended {
            self.queue.push_back(Statement::Fini);
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
