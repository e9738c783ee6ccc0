//! Findings of the core as the protocol has them.

use std::ops::Range;

use gen_lsp_types::{Code, Diagnostic as LspDiagnostic, DiagnosticSeverity, Range as LspRange};
use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};

use super::document::Snapshot;

/// Findings of one file that are told; of more an editor is no longer read.
const MOST: usize = 500;

/// What is told of the findings on a text. One that stands in another file (a machine that this one extends) is told
/// above the first line, with its place.
pub fn told(findings: &[Diagnostic], of: &Snapshot) -> Vec<LspDiagnostic> {
    let findings = findings.iter().take(MOST);
    findings.map(|finding| one(finding, of)).collect()
}

fn one(finding: &Diagnostic, of: &Snapshot) -> LspDiagnostic {
    let mut message = finding.message.clone();
    let here = finding.place.as_ref().filter(|place| place.file == of.name);
    let range = match (here, &finding.place) {
        (Some(place), _) => range(place, of),
        (None, Some(place)) => {
            message = format!("{}:{}: {message}", place.file, place.line);
            LspRange::default()
        }
        (None, None) => LspRange::default(),
    };
    if let Some(help) = &finding.help {
        message = format!("{message}\nhelp: {help}");
    }
    LspDiagnostic {
        range,
        severity: Some(match finding.severity {
            Severity::Error => DiagnosticSeverity::Error,
            Severity::Warning => DiagnosticSeverity::Warning,
        }),
        code: Some(Code::String(finding.code.to_owned())),
        source: Some("post".to_owned()),
        message: message.into(),
        ..LspDiagnostic::default()
    }
}

/// What a finding underlines.
fn range(place: &SourcePlace, of: &Snapshot) -> LspRange {
    match span(place, of) {
        Some(span) => of.lines.range(&of.text, span),
        None => of.lines.whole(&of.text, place.line),
    }
}

/// The bytes that a finding underlines; none where the text has changed since, or the record goes over several lines.
pub fn span(place: &SourcePlace, of: &Snapshot) -> Option<Range<usize>> {
    let line = usize::try_from(place.line).ok()?.checked_sub(1)?;
    let whole = of.lines.span(&of.text, line);
    let text = &of.text[whole.clone()];
    let start = place.offset + place.span.start;
    let end = place.offset + place.span.end;
    let same = text.get(start..end)? == place.text.get(place.span.clone())?;
    same.then(|| whole.start + start..whole.start + end)
}
