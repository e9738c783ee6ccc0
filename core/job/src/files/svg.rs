//! What all pictures share.

use std::fmt::Write as _;

use post_grammar::text::escaped;

/// The beginning of a picture on white; `</svg>` is its end.
pub fn open(width: f64, height: f64) -> String {
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" font-size=\"13\">"
    );
    let _ = writeln!(svg, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
    svg
}

/// A line of text; the anchor is `start`, `middle` or `end`.
pub fn label(svg: &mut String, [x, y]: [f64; 2], anchor: &str, text: &str) {
    let text = safe(text);
    let _ = writeln!(svg, "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\">{text}</text>");
}

/// A line of text that runs upwards about its middle.
pub fn upright(svg: &mut String, [x, y]: [f64; 2], text: &str) {
    let text = safe(text);
    let _ = writeln!(
        svg,
        "<text transform=\"translate({x:.2} {y:.2}) rotate(-90)\" text-anchor=\"middle\">{text}</text>"
    );
}

/// A straight line.
pub fn line(svg: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], grey: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"{grey}\" stroke-width=\"{width}\"/>"
    );
}

/// XML has no form for most control characters: they are written as escapes.
fn safe(text: &str) -> String {
    escaped(text, &[])
        .replace(['\u{FFFE}', '\u{FFFF}'], "?")
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_holds_nothing_that_xml_has_no_form_for() {
        let mut svg = String::new();
        label(&mut svg, [0.0, 0.0], "start", "a<b>&\u{1B}\u{0}\u{FFFF}\n");
        assert_eq!(
            svg,
            "<text x=\"0.00\" y=\"0.00\" text-anchor=\"start\">a&lt;b&gt;&amp;\\u{1b}\\u{0}?\\u{a}</text>\n"
        );
    }
}
