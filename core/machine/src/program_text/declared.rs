//! Lines that a machine file has of its own, told apart in a program that is read back.

use std::collections::BTreeSet;

use super::TextTemplate;

/// A pattern with fewer letters and digits of its own would be that of any line.
const LEAST: usize = 2;

/// Pieces between the tags of a line that are looked at with and without each of them.
const MOST_CHOICES: usize = 6;

/// The lines that the templates and rules of a machine file can write, as patterns. Blanks and block numbers do not count.
#[derive(Clone, Debug, Default)]
pub struct DeclaredLines {
    /// The texts of each line, [`plain`]; none stands for a fact or a number.
    lines: BTreeSet<Vec<Option<String>>>,
    words: BTreeSet<String>,
    /// The lines among them that end a program.
    ends: BTreeSet<Vec<Option<String>>>,
}

/// A piece of a template's line between two tags.
#[derive(Default)]
struct LinePiece<'t> {
    /// Its texts in their order; none stands for a fact.
    texts: Vec<Option<&'t str>>,
    /// It may be left out.
    optional: bool,
}

impl DeclaredLines {
    /// Adds the lines of a template, with and without what stands beside a condition.
    pub(crate) fn template(&mut self, template: &TextTemplate) {
        // A line that ends in `~` is one block with those after it.
        let joined = template.source().replace("~\n", "");
        for line in joined.lines() {
            let pieces = pieces(line);
            let optional: Vec<usize> =
                (0..pieces.len()).filter(|piece| pieces[*piece].optional).collect();
            if optional.len() > MOST_CHOICES {
                continue;
            }
            for choice in 0..1_usize << optional.len() {
                let left_out = |piece: &usize| {
                    let bit = optional.iter().position(|other| other == piece);
                    bit.is_some_and(|bit| choice >> bit & 1 == 0)
                };
                let kept = (0..pieces.len()).filter(|piece| !left_out(piece));
                self.line(kept.flat_map(|piece| pieces[piece].texts.iter().copied()).collect());
            }
        }
    }

    /// Adds the lines of a template that end a program.
    pub(crate) fn end(&mut self, template: &TextTemplate) {
        let mut ends = Self::default();
        ends.template(template);
        self.ends.extend(ends.lines.iter().cloned());
        self.lines.extend(ends.lines);
        self.words.extend(ends.words);
    }

    /// Adds lines by their texts in their order; none stands for any number. One that ends in `~` is one block with the
    /// next.
    pub(crate) fn rule<'t>(&mut self, lines: impl Iterator<Item = Vec<Option<&'t str>>>) {
        let mut block = Vec::new();
        for line in lines {
            let goes_on = line.last().copied().flatten().is_some_and(|text| text.ends_with('~'));
            block.extend(line);
            if !goes_on {
                self.line(std::mem::take(&mut block));
            }
        }
        self.line(block);
    }

    /// Adds a line by its texts in their order; none stands for any number.
    fn line(&mut self, texts: Vec<Option<&str>>) {
        let words = texts.iter().flatten().flat_map(|text| text.split_whitespace());
        self.words.extend(words.map(str::to_ascii_uppercase));
        let letters = texts.iter().flatten().flat_map(|text| text.bytes());
        if letters.filter(u8::is_ascii_alphanumeric).count() >= LEAST {
            self.lines.insert(texts.into_iter().map(|text| text.map(plain)).collect());
        }
    }

    /// Adds a line as it is: one of the CL file that goes into the program letter for letter.
    pub fn add(&mut self, line: &str) {
        self.line(vec![Some(line)]);
    }

    /// A word of a line of them, in which no fact stands.
    pub fn has_word(&self, word: &str) -> bool {
        self.words.contains(word)
    }

    /// The line of a program is one of them.
    pub fn has_line(&self, line: &str) -> bool {
        some_fits(&self.lines, line)
    }

    /// The line is one that ends a program, a subprogram among them.
    pub fn has_end(&self, line: &str) -> bool {
        some_fits(&self.ends, line)
    }
}

/// Whether some pattern makes the line, with or without its number.
fn some_fits(patterns: &BTreeSet<Vec<Option<String>>>, line: &str) -> bool {
    let line = plain(line);
    let unnumbered = unnumbered(&line);
    patterns.iter().any(|texts| fits(texts, &line) || fits(texts, unnumbered))
}

/// The pieces of a template's line.
fn pieces<'t>(line: &'t str) -> Vec<LinePiece<'t>> {
    let mut pieces = vec![LinePiece::default()];
    let mut depth = 0_usize;
    let mut rest = line;
    let add = |pieces: &mut [LinePiece<'t>], text: Option<&'t str>| {
        pieces.last_mut().into_iter().for_each(|piece| piece.texts.push(text));
    };
    while let Some(at) = rest.find('{') {
        let (text, tag) = rest.split_at(at);
        let close = match tag.as_bytes().get(1) {
            Some(b'{') => "}}",
            Some(b'%') => "%}",
            Some(b'#') => "#}",
            _ => break,
        };
        add(&mut pieces, Some(text));
        let (inner, behind) = tag[2..].split_once(close).unwrap_or_default();
        rest = behind;
        let word = inner.trim_matches(['-', '+', ' ']);
        match close {
            "}}" => add(&mut pieces, None),
            "%}" => {
                if word.starts_with("end") {
                    if depth == 0 {
                        // It began in a line before: all so far may be left out.
                        pieces.iter_mut().for_each(|piece| piece.optional = true);
                    }
                    depth = depth.saturating_sub(1);
                } else if word.starts_with("if") || word.starts_with("for") {
                    depth += 1;
                }
                pieces.push(LinePiece { texts: Vec::new(), optional: depth > 0 });
            }
            _ => {}
        }
    }
    add(&mut pieces, Some(rest));
    pieces
}

/// In capitals, without blanks and signs that a block goes on.
pub(crate) fn plain(text: &str) -> String {
    let letters = text.chars().filter(|letter| !letter.is_whitespace() && *letter != '~');
    letters.flat_map(char::to_uppercase).collect()
}

/// A [`plain`] line without its number.
pub(crate) fn unnumbered(line: &str) -> &str {
    let digits = line.strip_prefix('N').unwrap_or(line);
    let number = digits.trim_start_matches(|letter: char| letter.is_ascii_digit());
    if number.len() < digits.len() { number } else { line }
}

/// Whether the texts make the line, one behind the other.
fn fits(texts: &[Option<String>], line: &str) -> bool {
    // Bytes behind which the texts so far may end.
    let mut ends = BTreeSet::from([0]);
    for text in texts {
        ends = match text {
            Some(text) => {
                let starts = ends.iter().filter(|at| line[**at..].starts_with(text.as_str()));
                starts.map(|at| at + text.len()).collect()
            }
            None => {
                let Some(first) = ends.first().copied() else { return false };
                let places = line.char_indices().map(|(at, _)| at).chain([line.len()]);
                places.filter(|at| *at >= first).collect()
            }
        };
    }
    ends.contains(&line.len())
}
