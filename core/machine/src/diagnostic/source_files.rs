//! Files that are read one behind the other as one text: which line of it is a line of which.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use super::{Diagnostic, SourcePlace};

/// A file behind the first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FurtherFile {
    /// As the user named it.
    pub name: String,
    /// Lines of the whole text before its first line; the last of them is a remark with its name, that stands in no file.
    #[serde(rename = "lines_before")]
    pub before: u64,
    /// The file before it ends in a line end.
    #[serde(skip)]
    pub behind_line_end: bool,
}

/// The files of one text, in their order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceFiles {
    first: Arc<str>,
    further: Arc<[FurtherFile]>,
}

impl SourceFiles {
    /// The first, as the user named it, and those behind it.
    pub fn new(first: &str, further: Arc<[FurtherFile]>) -> Self {
        Self { first: first.into(), further }
    }

    /// The first, which messages of the whole text name.
    pub fn first(&self) -> &str {
        &self.first
    }

    /// There is no more than one.
    pub fn is_one(&self) -> bool {
        self.further.is_empty()
    }

    /// There is more than one.
    pub fn is_joined(&self) -> bool {
        !self.further.is_empty()
    }

    /// The file that a line of the whole text stands in, and its line there.
    pub fn locate(&self, line: u64) -> (&str, u64) {
        match self.further.iter().rfind(|file| file.before < line) {
            Some(file) => (&file.name, line - file.before),
            None => (&self.first, line),
        }
    }

    /// A line of the whole text as a sentence has it: its number, with its file where there are several.
    pub fn line(&self, line: u64) -> String {
        match (self.is_joined(), self.locate(line)) {
            (true, (name, line)) => format!("{line} of {name}"),
            (false, (_, line)) => line.to_string(),
        }
    }

    /// Puts a finding, whose line is one of the whole text, at the line of its file.
    pub fn place(&self, finding: &mut Diagnostic) {
        if let Some(SourcePlace { file, line, .. }) = &mut finding.place
            && self.is_joined()
            && file.as_str() == &*self.first
        {
            let (name, own) = self.locate(*line);
            *line = own;
            *file = name.to_owned();
        }
    }
}

impl Serialize for SourceFiles {
    /// As a list of names, each with the lines of the whole text before it.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let first = FurtherFile { name: self.first().to_owned(), before: 0, behind_line_end: true };
        serializer.collect_seq(std::iter::once(&first).chain(self.further.iter()))
    }
}
