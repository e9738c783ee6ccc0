//! Rows as columns, and files of them.

use super::JobStudy;
use super::columns::OF_JOB;
use super::outcome::JobOutcome;
use crate::columns::{CellValue, ColumnKind};
use crate::files::parquet;

/// The results of a study, a row a job.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyTable {
    /// How many rows it has.
    pub rows: usize,
    /// Its columns, in their order.
    pub columns: Vec<StudyColumn>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyColumn {
    /// Its name, which carries the unit.
    pub name: String,
    /// A value for each row.
    pub values: StudyValues,
}

/// The values of a column; none where a row has none.
#[derive(Clone, Debug, PartialEq)]
pub enum StudyValues {
    /// In the unit of the column's name.
    Numbers(Vec<Option<f64>>),
    /// How often, or a place.
    Counts(Vec<Option<i64>>),
    /// Words and sentences.
    Texts(Vec<Option<String>>),
}

impl StudyValues {
    fn of(kind: ColumnKind, values: impl Iterator<Item = Option<CellValue>>) -> Self {
        match kind {
            ColumnKind::Number => Self::Numbers(
                values
                    .map(|value| match value? {
                        CellValue::Number(number) => Some(number),
                        CellValue::Count(count) => Some(count as f64),
                        CellValue::Text(text) => text.parse().ok().map(|number: f64| number + 0.0),
                    })
                    .collect(),
            ),
            ColumnKind::Count | ColumnKind::Choice | ColumnKind::Flag => Self::Counts(
                values
                    .map(|value| match value? {
                        CellValue::Count(count) => Some(count),
                        _ => None,
                    })
                    .collect(),
            ),
            ColumnKind::Text => Self::Texts(
                values
                    .map(|value| match value? {
                        CellValue::Text(text) => Some(text.into_owned()),
                        CellValue::Number(number) => Some(format!("{number:?}")),
                        CellValue::Count(count) => Some(count.to_string()),
                    })
                    .collect(),
            ),
        }
    }

    /// A value as CSV and pictures have it: empty where there is none.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Numbers(numbers) => numbers[row].map(|number| format!("{number}")),
            Self::Counts(counts) => counts[row].map(|count| count.to_string()),
            Self::Texts(texts) => texts[row].clone(),
        }
        .unwrap_or_default()
    }

    /// A value as a number, where it is one.
    pub fn number(&self, row: usize) -> Option<f64> {
        match self {
            Self::Numbers(numbers) => numbers[row],
            Self::Counts(counts) => counts[row].map(|count| count as f64),
            Self::Texts(_) => None,
        }
    }

    fn json(&self, row: usize) -> Option<serde_json::Value> {
        match self {
            Self::Numbers(numbers) => numbers[row].map(serde_json::Value::from),
            Self::Counts(counts) => counts[row].map(serde_json::Value::from),
            Self::Texts(texts) => texts[row].clone().map(serde_json::Value::from),
        }
    }
}

impl StudyTable {
    /// Of what came of the jobs with these numbers.
    pub fn new(study: &JobStudy, numbers: &[usize], outcomes: &[JobOutcome]) -> Self {
        let columns = study.columns.iter().map(|head| {
            let rows = numbers.iter().zip(outcomes);
            let values = rows.map(|(number, outcome)| {
                let job = &study.jobs[*number];
                let text = |text: &str| Some(CellValue::Text(text.to_owned().into()));
                if let Some(parameter) = &head.parameter {
                    let told = job.parameters().into_iter();
                    let mut told = told.filter(|(name, _)| name == parameter);
                    return told.next().and_then(|(_, value)| text(&value.0));
                }
                let of_job = OF_JOB.iter().position(|(name, _)| head.name == *name);
                match of_job {
                    Some(0) => i64::try_from(*number).ok().map(CellValue::Count),
                    Some(1) => text(&job.file),
                    Some(_) => text(job.machine.as_deref().unwrap_or_default()),
                    None => outcome.values.get(&head.name).cloned(),
                }
            });
            StudyColumn { name: head.name.clone(), values: StudyValues::of(head.kind, values) }
        });
        Self { rows: numbers.len(), columns: columns.collect() }
    }

    /// The column of that name.
    pub fn column(&self, name: &str) -> Option<&StudyValues> {
        let mut columns = self.columns.iter();
        let column = columns.find(|column| column.name == name)?;
        Some(&column.values)
    }

    /// A file of it whose name ends so: `parquet`, `csv`, or `jsonl` (`json` and `ndjson` are the same); none of another
    /// ending.
    pub fn bytes(&self, ending: &str) -> Option<Vec<u8>> {
        match ending.to_ascii_lowercase().as_str() {
            "parquet" => Some(self.parquet()),
            "csv" => Some(self.csv().into_bytes()),
            "jsonl" | "ndjson" | "json" => Some(self.json_lines().into_bytes()),
            _ => None,
        }
    }

    fn parquet(&self) -> Vec<u8> {
        let columns = self.columns.iter().map(|column| parquet::ParquetColumn {
            name: &column.name,
            values: match &column.values {
                StudyValues::Numbers(numbers) => parquet::ParquetValues::Numbers(numbers),
                StudyValues::Counts(counts) => parquet::ParquetValues::Integers(counts),
                StudyValues::Texts(texts) => parquet::ParquetValues::Texts(texts),
            },
        });
        parquet::bytes(self.rows, &columns.collect::<Vec<_>>())
    }

    fn csv(&self) -> String {
        let mut text = String::new();
        let heads = self.columns.iter().map(|column| quoted(&column.name));
        text.push_str(&heads.collect::<Vec<_>>().join(","));
        text.push('\n');
        for row in 0..self.rows {
            let cells = self.columns.iter();
            let cells = cells.map(|column| quoted(&column.values.text(row)));
            text.push_str(&cells.collect::<Vec<_>>().join(","));
            text.push('\n');
        }
        text
    }

    fn json_lines(&self) -> String {
        let mut text = String::new();
        for row in 0..self.rows {
            let mut lead = '{';
            for column in &self.columns {
                if let Some(value) = column.values.json(row) {
                    text.push(lead);
                    text.push_str(&crate::files::json_line(&column.name));
                    text.push(':');
                    text.push_str(&crate::files::json_line(&value));
                    lead = ',';
                }
            }
            text.push_str("}\n");
        }
        text
    }
}

/// A cell of CSV, in quotes where it must be.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        return format!("\"{}\"", cell.replace('"', "\"\""));
    }
    cell.to_owned()
}
