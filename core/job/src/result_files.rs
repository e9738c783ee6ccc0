//! What is written of a program that was looked at: a table of its rows, what was found, and a page.

use crate::failure::Failure;
use crate::files::{AtomicFile, PathArg, Role};
use crate::session::Session;
use crate::settings::ReportSettings;

/// The files, opened before the work begins.
pub struct ResultFiles {
    /// The table.
    pub table: Option<AtomicFile>,
    /// What was found, as JSON.
    pub summary: Option<AtomicFile>,
    /// The page.
    pub page: Option<AtomicFile>,
}

impl ResultFiles {
    /// Opens those that are wanted.
    ///
    /// # Errors
    /// One of them cannot be written to.
    pub fn create(
        session: &Session,
        table: Option<(Role, &PathArg)>,
        summary: Option<&PathArg>,
        report: &ReportSettings,
    ) -> Result<Self, Failure> {
        let page = report.report.as_ref();
        let mut targets: Vec<(Role, &PathArg)> = Vec::new();
        targets.extend(table);
        targets.extend(summary.map(|summary| (Role::SUMMARY, summary)));
        targets.extend(page.map(|page| (Role::REPORT, page)));
        let mut files = AtomicFile::create(session, &targets)?.into_iter();
        let mut next = |wanted: bool| files.by_ref().take(usize::from(wanted)).next();
        Ok(Self {
            table: next(table.is_some()),
            summary: next(summary.is_some()),
            page: next(page.is_some()),
        })
    }

    /// All of them, in the order in which they were opened.
    pub fn all(self) -> Vec<AtomicFile> {
        [self.table, self.summary, self.page].into_iter().flatten().collect()
    }
}
