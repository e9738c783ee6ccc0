//! Messages as the user sees them.

use std::io::{IsTerminal, Write};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use post_grammar::text::escaped;
use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};

use post_job::files::TextOutcomes;

/// Findings of one severity that are told; of the others how many there are.
const MOST_TOLD: usize = 120;

/// Writes findings to standard error, warnings first, and how many errors there were.
pub fn findings(findings: &[Diagnostic], texts: &TextOutcomes) {
    let mut stderr = std::io::stderr().lock();
    let renderer = if stderr.is_terminal() { Renderer::styled() } else { Renderer::plain() };
    let of = |severity| findings.iter().filter(move |finding| finding.severity == severity);
    for severity in [Severity::Warning, Severity::Error] {
        for finding in of(severity).take(MOST_TOLD) {
            // A closed standard error leaves nobody to tell.
            let _ = writeln!(stderr, "{}\n", render(finding, &renderer));
        }
        let more = of(severity).count().saturating_sub(MOST_TOLD);
        if more > 0 {
            let _ = writeln!(stderr, "… and {more} more\n");
        }
    }
    let errors = of(Severity::Error).count();
    if errors > 0 {
        let plural = if errors == 1 { "" } else { "s" };
        let more = if errors >= post_posting::MOST_FAULTS {
            " (and perhaps more: reading stopped here)"
        } else {
            ""
        };
        let outcome = texts.sentence().map_or_else(String::new, |outcome| format!("; {outcome}"));
        let _ = writeln!(stderr, "{errors} error{plural}{more}{outcome}");
    }
}

fn render(finding: &Diagnostic, renderer: &Renderer) -> String {
    let level = match finding.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    // A message is one line: the name of a file must not pretend to be the next.
    let message = escaped(&finding.message, &[]);
    let title = level.primary_title(message.as_ref()).id(finding.code);
    let place = finding.place.as_ref().map(legible);
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
    let help = finding.help.as_deref().map(|help| escaped(help, &[]));
    if let Some(help) = &help {
        group = group.element(Level::HELP.message(help.as_ref()));
    }
    renderer.render(&[group])
}

/// The place with what a terminal would obey written as escapes; tabs are blanks to the renderer.
fn legible(place: &SourcePlace) -> SourcePlace {
    let plain = |text: &str| escaped(text, &['\t']).into_owned();
    let span = &place.span;
    let start = plain(&place.text[..span.start]).len();
    SourcePlace {
        file: plain(&place.file),
        line: place.line,
        text: plain(&place.text),
        offset: place.offset,
        span: start..start + plain(&place.text[span.clone()]).len(),
    }
}

/// A finding without colours.
pub fn plain(finding: &Diagnostic) -> String {
    render(finding, &Renderer::plain())
}
