//! A table as a JSON list, written as it comes.

use serde::Serialize;

use super::{AtomicFile, FileFault, json_line};

/// A JSON list, a row a line.
#[derive(Default)]
pub struct JsonRows {
    rows: u64,
    /// The first fault of writing it.
    fault: Option<FileFault>,
}

impl JsonRows {
    /// Adds a row; a fault is told at the end.
    pub fn row(&mut self, row: &impl Serialize, file: &mut AtomicFile) {
        let lead = match self.rows {
            0 => "[\n",
            _ => ",\n",
        };
        self.rows += 1;
        let text = format!("{lead}{}", json_line(row));
        if self.fault.is_none() {
            self.fault = file.write_bytes(text.as_bytes()).err();
        }
    }

    /// The list ends.
    ///
    /// # Errors
    /// It could not be written.
    pub fn end(self, file: &mut AtomicFile) -> Result<(), FileFault> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        let end: &[u8] = match self.rows {
            0 => b"[]\n",
            _ => b"\n]\n",
        };
        file.write_bytes(end)
    }
}
