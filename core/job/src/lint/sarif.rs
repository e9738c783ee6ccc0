//! Findings as SARIF 2.1.0, the form in which code hosts and editors take what checkers find.

use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};
use serde_json::{Value, json};

use crate::files;

/// What is said of a code.
#[derive(Clone, Copy, Debug)]
pub struct CodeText {
    /// What is found.
    pub meaning: &'static str,
    /// What helps.
    pub remedy: &'static str,
}

/// The log of a run of this `version` with these findings, as JSON; `unread` says why programs were not looked over,
/// `describe` knows the codes.
pub fn sarif(
    findings: &[Diagnostic],
    unread: &[Diagnostic],
    version: &str,
    describe: &dyn Fn(&str) -> Option<CodeText>,
) -> String {
    let mut rules: Vec<&'static str> = findings.iter().map(|finding| finding.code).collect();
    rules.sort_unstable();
    rules.dedup();
    let results: Vec<Value> = findings.iter().map(|finding| result(finding, &rules)).collect();
    let descriptors = rules.iter().map(|rule| match describe(rule) {
        Some(CodeText { meaning, remedy }) => json!({
            "id": rule,
            "shortDescription": { "text": meaning },
            "help": { "text": remedy },
        }),
        None => json!({ "id": rule }),
    });
    let descriptors: Vec<Value> = descriptors.collect();
    let notes =
        unread.iter().map(|why| json!({ "level": "error", "message": { "text": text(why) } }));
    files::json(&json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "post",
                "version": version,
                "rules": descriptors,
            } },
            "columnKind": "utf16CodeUnits",
            "invocations": [{
                "executionSuccessful": unread.is_empty(),
                "toolExecutionNotifications": notes.collect::<Vec<Value>>(),
            }],
            "results": results,
        }],
    }))
}

/// What is found, and what helps.
fn text(finding: &Diagnostic) -> String {
    match &finding.help {
        Some(help) => format!("{}\nhelp: {help}", finding.message),
        None => finding.message.clone(),
    }
}

fn result(finding: &Diagnostic, rules: &[&str]) -> Value {
    let level = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let mut result = json!({
        "ruleId": finding.code,
        "ruleIndex": rules.binary_search(&finding.code).unwrap_or_default(),
        "level": level,
        "message": { "text": text(finding) },
    });
    if let Some(place) = &finding.place {
        result["locations"] = json!([{ "physicalLocation": {
            "artifactLocation": { "uri": uri(&place.file) },
            "region": region(place),
        } }]);
    }
    result
}

/// The line, and what of it is underlined.
fn region(place: &SourcePlace) -> Value {
    let units = |bytes: usize| place.text.get(..bytes).unwrap_or_default().encode_utf16().count();
    match place.text.is_empty() || place.offset > 0 {
        true => json!({ "startLine": place.line }),
        false => json!({
            "startLine": place.line,
            "startColumn": units(place.span.start) + 1,
            "endColumn": units(place.span.end) + 1,
        }),
    }
}

/// A name of a file as a relative or absolute reference.
fn uri(file: &str) -> String {
    let mut uri = String::with_capacity(file.len());
    for byte in file.bytes() {
        match byte {
            b'\\' => uri.push('/'),
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                uri.push(char::from(byte));
            }
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}
