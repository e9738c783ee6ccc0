//! The document: the page with its parts.

use std::io::{self, Read, Write};

use crate::deflate::Deflate;
use crate::meta::Meta;
use crate::{page, part};

/// Writes the document: `parts` are what tables and texts have handed to their sinks, in any order.
///
/// # Errors
/// A part cannot be read, or the document cannot be written.
pub fn write(meta: &Meta, parts: &mut [&mut dyn Read], out: &mut dyn Write) -> io::Result<()> {
    let script = page::SCRIPT;
    // Whatever comes in by a text can load nothing and run nothing, even if the page had a fault.
    write!(
        out,
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src {}; style-src {}; img-src data:; base-uri 'none'; form-action 'none'\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta name=\"generator\" content=\"{}\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
        page::source(script),
        page::source(page::STYLE),
        escaped(&meta.by),
        escaped(&meta.title),
        page::STYLE
    )?;
    out.write_all(page::BODY.as_bytes())?;
    let mut deflate = Deflate::of_texts();
    let mut packed = Vec::new();
    let json = serde_json::to_vec(meta).map_err(io::Error::other)?;
    deflate.piece(&json);
    deflate.take(&mut packed);
    part::write(out, "meta", &packed)?;
    for part in parts {
        io::copy(part, out)?;
    }
    write!(out, "<script>{script}</script>\n</body>\n</html>\n")
}

/// A text that stands between tags or in quotes.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            letter => escaped.push(letter),
        }
    }
    escaped
}
