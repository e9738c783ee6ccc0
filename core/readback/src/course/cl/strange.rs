//! What is not known by its name, or means something else by who wrote the file.

use post_grammar::{Argument, Record, UnknownPath, WordUsage};
use post_machine::diagnostic::Diagnostic;

use super::modal::{ClModal, RecordResult};

/// Of the file.
#[derive(Debug, Default)]
pub(super) struct StrangeWords {
    /// CATIA wrote it.
    pub(super) catia: bool,
    /// `MODE/MILL`.
    pub(super) mills: bool,
    /// A stock APT post of Autodesk wrote it.
    pub(super) autodesk: bool,
    /// The tool has moved.
    pub(super) moved: bool,
    /// A record behind a move that may be one, and whether it may pass where none follows.
    suspect: Option<(Box<Diagnostic>, bool)>,
}

impl StrangeWords {
    /// Nothing that may be a move came since the last one.
    pub(super) fn is_quiet(&self) -> bool {
        self.suspect.is_none()
    }

    /// A move follows: what may be a move stands between moves.
    pub(super) fn between_moves(&mut self) -> Option<Box<Diagnostic>> {
        self.suspect.take().map(|(fault, _)| fault)
    }

    /// No move follows.
    pub(super) fn left_over(&mut self) -> Option<Box<Diagnostic>> {
        let (fault, passes) = self.suspect.take()?;
        (!passes).then_some(fault)
    }
}

impl ClModal {
    /// A record without a meaning here.
    pub(super) fn other(
        &mut self,
        record: &Record<'_>,
        word: &str,
        arguments: &[Argument],
    ) -> RecordResult {
        if self.has_lines(word, arguments) {
            return Ok(());
        }
        let strange = record.statement.is_strange();
        let passes = self.settings.allows(word) || strange && self.settings.unknown_left_out;
        match record.statement.unknown_path() {
            Some(UnknownPath::Word) => {
                let message = format!("{word} moves the tool, and this form of it is not known");
                return Err(self.fault(record, message));
            }
            Some(UnknownPath::Numbers) if self.strange.moved => {
                let message = format!("{word} is not known, and with its numbers it may be a move");
                let fault = self.fault(record, message);
                self.strange.suspect.get_or_insert((fault, passes));
                return Ok(());
            }
            _ if passes => return Ok(()),
            _ => {}
        }
        if strange {
            return Err(self.fault(record, format!("{word} is not known")));
        }
        if record.statement.usage() != WordUsage::Refused {
            return Ok(());
        }
        let message =
            format!("{word} changes where or whether metal is cut, and its meaning is not known");
        Err(self.fault(record, message))
    }
}
