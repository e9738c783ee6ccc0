//! Messages as the user sees them.

use std::io::{IsTerminal, Write};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use post_machine::diagnostic::{Diagnostic, Place, Severity};

use crate::files::outcome;

/// Longest line shown whole; of a longer one the part around the fault is shown.
const WIDEST: usize = 200;

/// Writes findings to standard error, warnings first, and how many errors there were.
pub fn findings(findings: &[Diagnostic]) {
    let mut stderr = std::io::stderr().lock();
    let renderer = if stderr.is_terminal() {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let mut sorted: Vec<&Diagnostic> = findings.iter().collect();
    sorted.sort_by_key(|finding| finding.severity);
    for finding in &sorted {
        // A closed standard error leaves nobody to tell.
        let _ = writeln!(stderr, "{}\n", render(finding, &renderer));
    }
    let errors = sorted
        .iter()
        .filter(|finding| finding.severity == Severity::Error)
        .count();
    if errors > 0 {
        let plural = if errors == 1 { "" } else { "s" };
        let more = if errors >= post_posting::MOST_FAULTS {
            " (and perhaps more: reading stopped here)"
        } else {
            ""
        };
        let outcome =
            outcome::sentence().map_or_else(String::new, |outcome| format!("; {outcome}"));
        let _ = writeln!(stderr, "{errors} error{plural}{more}{outcome}");
    }
}

fn render(finding: &Diagnostic, renderer: &Renderer) -> String {
    let level = match finding.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level
        .primary_title(finding.message.as_str())
        .id(finding.code);
    let place = finding.place.as_ref().map(shortened);
    let mut group = match &place {
        Some(place) if !place.text.is_empty() => {
            let line = usize::try_from(place.line).unwrap_or(usize::MAX);
            title.element(
                Snippet::source(place.text.as_str())
                    .line_start(line)
                    .path(place.file.as_str())
                    .annotation(AnnotationKind::Primary.span(place.span.clone())),
            )
        }
        Some(place) => Group::with_title(title).element(
            annotate_snippets::Origin::path(place.file.as_str())
                .line(usize::try_from(place.line).unwrap_or(usize::MAX)),
        ),
        None => Group::with_title(title),
    };
    if let Some(help) = &finding.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    renderer.render(&[group])
}

/// A very long line cut down to what surrounds the fault, at character borders.
fn shortened(place: &Place) -> Place {
    let mut place = place.clone();
    let border = |text: &str, mut at: usize| {
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let end = border(&place.text, place.span.end.min(place.text.len()));
    let start = border(&place.text, place.span.start.min(end));
    place.span = start..end;
    if place.text.len() > WIDEST {
        let from = border(&place.text, start.saturating_sub(WIDEST / 4));
        let to = border(&place.text, (from + WIDEST).min(place.text.len()));
        place.text = place.text[from..to].to_owned();
        place.span = start - from..end.min(to) - from;
    }
    place
}
