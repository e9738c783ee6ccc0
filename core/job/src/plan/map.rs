//! `post --plan --map`: which limit holds the planned feed where.
//!
//! What is kept of the program is one row: neighbours with the same line of the CL file and the same limit are one.

use std::fmt::Write as _;

use post_plugin::fixed;
use post_posting::plan::{PlannedPoint, axis_name};
use serde::Serialize;

use super::interval::{Interval, Intervals};

/// A stretch of the planned path on which a limit holds the feed.
#[derive(Clone, Debug, Serialize)]
pub struct MapRow {
    /// Line of the CL file.
    pub cl_line: u64,
    /// Way of the tip from the beginning of the first planned cut, planned cuts alone, mm: where the row begins.
    pub way_from_mm: f64,
    /// Where it ends, mm.
    pub way_to_mm: f64,
    /// Time of planned cuts by the plan, s: when it begins.
    pub time_from_s: f64,
    /// When it ends, s.
    pub time_to_s: f64,
    /// The limit that is used most.
    pub limit: &'static str,
    /// The axis that it is of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<String>,
    /// Planned feed of the tip at the samples of the path, the ends of the row among them, and halfway between: the least.
    pub feed_least_mm_min: f64,
    /// The largest of them.
    pub feed_most_mm_min: f64,
}

impl MapRow {
    fn of(interval: &Interval<'_>, way: [f64; 2], time: [f64; 2]) -> Self {
        let feeds = interval.feeds().map(|feed| 60.0 * feed);
        let axis = interval.axis.map(|axis| axis_name(interval.machine, axis));
        Self {
            cl_line: interval.line,
            way_from_mm: way[0],
            way_to_mm: way[1],
            time_from_s: time[0],
            time_to_s: time[1],
            limit: interval.limit,
            axis: axis.map(str::to_owned),
            feed_least_mm_min: feeds.into_iter().fold(f64::INFINITY, f64::min),
            feed_most_mm_min: feeds.into_iter().fold(0.0, f64::max),
        }
    }

    fn holds(&self, interval: &Interval<'_>) -> bool {
        let axis = interval.axis.map(|axis| axis_name(interval.machine, axis));
        self.cl_line == interval.line
            && self.limit == interval.limit
            && self.axis.as_deref() == axis
    }

    /// The names of the columns, as the first line of a CSV file.
    pub const HEAD: &'static str = "cl_line,way_from_mm,way_to_mm,time_from_s,time_to_s,limit,axis,feed_least_mm_min,feed_most_mm_min\n";

    /// As a line of a CSV file.
    pub fn csv(&self) -> String {
        let mut text = self.cl_line.to_string();
        let column = |text: &mut String, value: f64, decimals: u8| {
            text.push(',');
            fixed(text, value, decimals);
        };
        column(&mut text, self.way_from_mm, 6);
        column(&mut text, self.way_to_mm, 6);
        column(&mut text, self.time_from_s, 9);
        column(&mut text, self.time_to_s, 9);
        let axis = self.axis.as_deref().unwrap_or_default();
        // Writing to a String cannot fail.
        let _ = write!(text, ",{},{axis}", self.limit);
        column(&mut text, self.feed_least_mm_min, 3);
        column(&mut text, self.feed_most_mm_min, 3);
        text.push('\n');
        text
    }
}

/// Makes the rows.
#[derive(Debug, Default)]
pub struct LimitMap {
    intervals: Intervals,
    way: f64,
    time: f64,
    row: Option<MapRow>,
}

impl LimitMap {
    /// Takes the next place of the plan: a row, if that shows that it is complete.
    pub fn take(&mut self, point: &PlannedPoint<'_>) -> Option<MapRow> {
        let interval = self.intervals.take(point)?;
        let from = [self.way, self.time];
        self.way += interval.way();
        self.time += interval.seconds;
        let next = MapRow::of(&interval, [from[0], self.way], [from[1], self.time]);
        match &mut self.row {
            Some(row) if row.holds(&interval) => {
                (row.way_to_mm, row.time_to_s) = (next.way_to_mm, next.time_to_s);
                row.feed_least_mm_min = row.feed_least_mm_min.min(next.feed_least_mm_min);
                row.feed_most_mm_min = row.feed_most_mm_min.max(next.feed_most_mm_min);
                None
            }
            row => row.replace(next),
        }
    }

    /// The last row.
    pub fn finish(self) -> Option<MapRow> {
        self.row
    }
}
