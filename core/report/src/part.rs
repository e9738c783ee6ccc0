//! A part of the document: packed bytes in an element that runs nothing.

use std::io::{self, Write};

use crate::base64;

/// Writes a part. It may come in several elements of one name, which are meant one after the other.
pub fn write(out: &mut dyn Write, name: &str, packed: &[u8]) -> io::Result<u64> {
    let mut text = Vec::with_capacity(packed.len() / 3 * 4 + 96);
    text.extend_from_slice(b"<script type=\"text/plain\" class=\"part\" data-name=\"");
    text.extend_from_slice(name.as_bytes());
    text.extend_from_slice(b"\">");
    base64::encode(packed, &mut text);
    text.extend_from_slice(b"</script>\n");
    out.write_all(&text)?;
    Ok(text.len() as u64)
}
