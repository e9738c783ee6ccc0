//! Remarks are taken out of a line before its grammar sees it.

use super::block::NcSyntax;
use super::fault::Unreadable;

/// Puts `line` after `code`, in capitals and with blanks in the place of remarks, byte for byte as long; the remarks go
/// to `remarks`. What stands in quotation marks stays as it is.
pub(super) fn take_out(
    line: &str,
    syntax: &NcSyntax,
    code: &mut String,
    remarks: &mut Vec<String>,
) -> Result<(), Unreadable> {
    let offset = code.len();
    let mut rest = line;
    while let Some(next) = rest.chars().next() {
        let at = line.len() - rest.len();
        let length = next.len_utf8();
        if let Some(mark) = begins_line_remark(rest, syntax) {
            if syntax.semicolon_ends && next == ';' && begins_with_word(&rest[mark..]) {
                let fault =
                    Unreadable::new("`;` ends a block, and what stands behind it is the next one");
                let at = offset + at..offset + at + length;
                return Err(fault.at(at).help("a line of its own, or a remark in parentheses"));
            }
            keep(&rest[mark..], remarks);
            blank(code, rest.len());
            return Ok(());
        }
        if let Some((open, close)) = syntax.enclosed_remarks
            && next == open
        {
            let inside = &rest[length..];
            let Some(end) = inside.find(close) else {
                let fault =
                    Unreadable::new(format!("a remark begins with this `{open}` and has no end"));
                let at = offset + at..offset + at + length;
                return Err(fault.at(at).help(format!("`{close}` behind it")));
            };
            if let Some(second) = inside[..end].find(open) {
                let at = offset + at + length + second;
                let fault = Unreadable::new("a remark within a remark");
                return Err(fault
                    .at(at..at + length)
                    .help("controls do not agree where such a remark ends: `[` in its place"));
            }
            keep(&inside[..end], remarks);
            let whole = length + end + close.len_utf8();
            blank(code, whole);
            rest = &rest[whole..];
            continue;
        }
        if next == '"'
            && let Some(end) = rest[1..].find('"')
        {
            let quoted = end + 2;
            code.push_str(&rest[..quoted]);
            rest = &rest[quoted..];
            continue;
        }
        if next.is_control() && next != '\t' {
            let fault =
                Unreadable::new(format!("byte {:#04x} belongs to no program", u32::from(next)));
            return Err(fault.at(offset + at..offset + at + length));
        }
        code.push(next.to_ascii_uppercase());
        rest = &rest[length..];
    }
    Ok(())
}

/// How long the mark is that begins a remark here, if one does.
fn begins_line_remark(rest: &str, syntax: &NcSyntax) -> Option<usize> {
    let mut marks = syntax.line_remarks.iter();
    marks.find(|mark| !mark.is_empty() && rest.starts_with(mark.as_str())).map(String::len)
}

/// A letter and its value stand there, or a block that is skipped: `G91`, `X-5.`, `/M8`, `#1=2`.
fn begins_with_word(text: &str) -> bool {
    let mut letters = text.trim_start().trim_start_matches('/').chars();
    match letters.next() {
        Some('#') => true,
        Some(letter) if letter.is_ascii_alphabetic() => {
            matches!(letters.next(), Some('0'..='9' | '+' | '-' | '.' | '#' | '['))
        }
        _ => false,
    }
}

fn keep(remark: &str, remarks: &mut Vec<String>) {
    remarks.push(remark.trim().to_owned());
}

fn blank(code: &mut String, length: usize) {
    code.extend(std::iter::repeat_n(' ', length));
}
