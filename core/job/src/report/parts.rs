//! Tables and texts of a report, and the file that they become.

use std::io::{self, Read};
use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::path::Path;
use std::thread;

use post_machine::description::Machine;
use post_report::document;
use post_report::meta::{Meta, TableMeta, TextMeta};
use post_report::table::TableWriter;
use post_report::text::TextWriter;

use super::solids;
use crate::clearance::{ClearanceSummary, StockLeft};
use crate::disk;
use crate::failure::Failure;
use crate::files::{AtomicFile, FileFault, Scratch};
use crate::session::Session;

/// What messages call a scratch file.
const NAME: &str = "the report";

/// Longest page without its parts, bytes, with room for what the meta tells: it is not known before what is left out is.
const PAGE: u64 = 400_000;

const TEXTS: &str = "texts";

/// What is left out first, and how the page calls it.
const ORDER: [(&str, &str); 7] = [
    ("nc2", TEXTS),
    ("nc", TEXTS),
    ("cl", TEXTS),
    ("series", "series over time"),
    ("solids", "solids of the machine"),
    ("path", "interpolated path"),
    ("cl", "CL path"),
];

/// A text of a report, from its start.
pub struct PartText<'t> {
    /// What the page calls it.
    pub name: &'static str,
    /// Its file, as messages call it.
    pub file: &'t str,
    /// What it is read from.
    pub text: &'t mut (dyn Read + Send),
}

impl PartText<'_> {
    fn packed(self) -> Result<(TextMeta, Scratch), Failure> {
        let mut writer = TextWriter::new(self.name, Parts::scratch()?);
        let mut buffer = vec![0; 1 << 16];
        loop {
            let length = self
                .text
                .read(&mut buffer)
                .map_err(|error| FileFault::Read { name: self.file.to_owned(), error })?;
            if length == 0 {
                return writer.finish().map_err(fault);
            }
            writer.write(&buffer[..length]).map_err(fault)?;
        }
    }
}

/// Packed tables and texts.
#[derive(Default)]
pub struct Parts {
    tables: Vec<(TableMeta, Scratch)>,
    texts: Vec<(TextMeta, Scratch)>,
}

impl Parts {
    /// The parts of a report about `machine`: its solids, to begin with. What cannot be shown of them is said, here and on the
    /// page.
    ///
    /// # Errors
    /// They cannot be kept.
    pub fn of(session: &Session, machine: &Machine, meta: &mut Meta) -> Result<Self, Failure> {
        Self::with_left(session, machine, meta, &[])
    }

    /// The same with what is `left` of stocks.
    ///
    /// # Errors
    /// They cannot be kept.
    pub fn with_left(
        session: &Session,
        machine: &Machine,
        meta: &mut Meta,
        left: &[StockLeft],
    ) -> Result<Self, Failure> {
        let mut parts = Self::default();
        let faults = solids::add(machine, left, meta, &mut parts)?;
        session.findings(&faults);
        // Their places are lines of the machine file, which the page does not show.
        let told = faults.into_iter().map(|fault| fault.at(None));
        let told = super::warnings(&told.collect::<Vec<_>>(), "");
        // The same job gives the same page wherever its files lie.
        let heads = machine.heads.iter().map(|head| &head.machine);
        let solids = std::iter::once(machine).chain(heads);
        let solids: Vec<&Path> = solids
            .flat_map(|machine| machine.solids.iter().map(|solid| solid.file.as_path()))
            .collect();
        meta.warnings.extend(told.into_iter().map(|mut warning| {
            for solid in &solids {
                warning.text = super::without_folder(&warning.text, Some(solid));
            }
            warning
        }));
        Ok(parts)
    }

    /// An empty place for a part.
    ///
    /// # Errors
    /// There is no place for it.
    pub fn scratch() -> Result<Scratch, FileFault> {
        Scratch::new(NAME)
    }

    /// Adds a table that is whole.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn table(&mut self, table: TableWriter<Scratch>) -> Result<(), Failure> {
        self.tables.push(table.finish().map_err(fault)?);
        Ok(())
    }

    /// Adds a text.
    ///
    /// # Errors
    /// It cannot be read, or not be written.
    pub fn text(&mut self, text: PartText<'_>) -> Result<(), Failure> {
        self.texts.push(text.packed()?);
        Ok(())
    }

    /// Adds two texts, packed side by side if there are `threads` for both.
    ///
    /// # Errors
    /// One cannot be read, or not be written.
    pub fn two_texts(
        &mut self,
        texts: [PartText<'_>; 2],
        threads: NonZeroUsize,
    ) -> Result<(), Failure> {
        if threads == NonZeroUsize::MIN {
            return texts.into_iter().try_for_each(|text| self.text(text));
        }
        let [first, second] = texts;
        let [first, second] = thread::scope(|scope| {
            let beside = scope.spawn(|| second.packed());
            let first = first.packed();
            [first, beside.join().unwrap_or_else(|payload| resume_unwind(payload))]
        });
        self.texts.extend([first?, second?]);
        Ok(())
    }

    /// Writes the report; above `most` bytes parts are left out, the texts first, and the page says so.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(
        mut self,
        mut meta: Meta,
        most: u64,
        file: &mut AtomicFile,
    ) -> Result<(), Failure> {
        let mut size = PAGE + self.bytes();
        for (name, called) in ORDER {
            if size <= most {
                break;
            }
            let before = self.tables.len() + self.texts.len();
            if called == TEXTS {
                self.texts.retain(|(text, _)| text.name != name);
            } else {
                self.tables.retain(|(table, _)| table.name != name);
            }
            size = PAGE + self.bytes();
            let left = before > self.tables.len() + self.texts.len();
            if left && meta.parts_left_out.iter().all(|known| known != called) {
                meta.parts_left_out.push(called.to_owned());
            }
        }
        let mut files = Vec::new();
        for (table, scratch) in self.tables {
            meta.tables.push(table);
            files.push(scratch.reread()?);
        }
        for (text, scratch) in self.texts {
            meta.texts.push(text);
            files.push(scratch.reread()?);
        }
        for file in &mut files {
            io::Seek::rewind(file).map_err(fault)?;
        }
        let mut readers: Vec<&mut dyn Read> =
            files.iter_mut().map(|file| file as &mut dyn Read).collect();
        let written = document::write(&meta, &mut readers, file);
        written.map_err(|error| FileFault::write_named(file.name(), error).into())
    }

    fn bytes(&self) -> u64 {
        let tables = self.tables.iter().map(|(table, _)| table.bytes);
        let texts = self.texts.iter().map(|(text, _)| text.bytes);
        tables.chain(texts).sum()
    }
}

/// What is packed cannot be kept.
pub fn fault(error: io::Error) -> Failure {
    FileFault::NoWaiting { name: NAME.to_owned(), folder: disk::temp_dir(), error }.into()
}

/// What "certified" leaves out; of bodies what has none, where clearance was `proven`.
pub fn excludes(proven: Option<&ClearanceSummary>) -> Vec<String> {
    let bodies = match proven {
        None => {
            "Collisions: it was not asked whether anything hits anything (--clearance).".to_owned()
        }
        Some(proven) => {
            let mut lacks = proven.without_body.clone();
            lacks.extend(["hoses", "chips", "the way of a tool change"].map(str::to_owned));
            format!(
                "Collisions with what has no body: {}. Of the stock nothing is taken away.",
                lacks.join(", ")
            )
        }
    };
    let mut excludes = [
        "What a record of the CL file is taken to mean: the book says how it is read (CL files).",
        "What the control does between blocks: smoothing, look-ahead, servo lag. A prediction (--predict, post predict) tells of them.",
        "The machine's own errors, as far as its file does not describe them.",
    ]
    .map(str::to_owned)
    .to_vec();
    excludes.push(bodies);
    excludes
}
