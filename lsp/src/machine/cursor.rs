//! What could be written at a place of a machine file, told from the text before it: while a key is written, the text is
//! no TOML.

use super::tree::Tree;

/// What could be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cursor {
    /// The name of a table, behind those that are written already.
    Table(Vec<String>),
    /// A key of a table.
    Key(Vec<String>),
    /// The value at these keys, between quotes or not.
    Value(Vec<String>, bool),
    /// A remark, or nothing that is known.
    Nothing,
}

impl Cursor {
    /// At a byte of a text.
    pub fn at(text: &str, byte: usize, tree: &Tree) -> Self {
        let begin = text[..byte].rfind('\n').map_or(0, |at| at + 1);
        let before = &text[begin..byte];
        let mut quotes = Quotes::default();
        let equals = before
            .char_indices()
            .filter(|(_, letter)| quotes.outside(*letter) && *letter == '=')
            .map(|(at, _)| at)
            .next();
        if Quotes::in_remark(before) {
            return Self::Nothing;
        }
        let start = before.trim_ascii_start();
        if equals.is_none() {
            // An item of a list that goes over several lines.
            let inside = tree.entries.iter().filter(|entry| {
                entry.value.start < begin
                    && begin <= entry.value.end
                    && text[entry.value.clone()].starts_with('[')
                    && entry.key.as_ref().is_some_and(|key| key.end <= entry.value.start)
                    && text[entry.key.clone().map_or(0, |key| key.end)..entry.value.start]
                        .contains('=')
            });
            if let Some(entry) = inside.min_by_key(|entry| entry.value.len()) {
                let quoted = Quotes::open_at_end(before);
                return Self::Value([entry.path.as_slice(), &["[0]".to_owned()]].concat(), quoted);
            }
            if let Some(name) = start.strip_prefix('[') {
                if name.contains(']') {
                    return Self::Nothing;
                }
                let mut keys = keys(name.trim_start_matches('['));
                keys.pop();
                return Self::Table(keys);
            }
        }
        let mut table = header_before(&text[..begin]);
        let Some(equals) = equals else {
            let mut keys = keys(before);
            keys.pop();
            table.extend(keys);
            return Self::Key(table);
        };
        table.extend(keys(&before[..equals]));
        inside(table, &before[equals + 1..])
    }
}

/// What could be written behind `=` and `before`, in the value at `path`.
fn inside(mut path: Vec<String>, before: &str) -> Cursor {
    let mut quotes = Quotes::default();
    let mut open: Vec<(char, usize)> = Vec::new();
    let mut items = 0_usize;
    for (at, letter) in before.char_indices() {
        if !quotes.outside(letter) {
            continue;
        }
        match letter {
            '{' | '[' => {
                open.push((letter, at + 1));
                items = 0;
            }
            '}' | ']' => drop(open.pop()),
            ',' => {
                items += 1;
                if let Some((_, from)) = open.last_mut() {
                    *from = at + 1;
                }
            }
            _ => {}
        }
    }
    match open.last() {
        Some(('{', from)) => {
            let part = &before[*from..];
            match part.split_once('=') {
                None => Cursor::Key(path),
                Some((key, value)) => {
                    path.extend(keys(key));
                    Cursor::Value(path, Quotes::open_at_end(value))
                }
            }
        }
        Some((_, from)) => {
            path.push(format!("[{items}]"));
            Cursor::Value(path, Quotes::open_at_end(&before[*from..]))
        }
        None => Cursor::Value(path, Quotes::open_at_end(before)),
    }
}

/// The keys of the last table that begins before.
fn header_before(text: &str) -> Vec<String> {
    let headers = text.lines().rev().filter_map(|line| {
        let name = line.trim_ascii().strip_prefix('[')?;
        let (name, rest) = name.trim_start_matches('[').split_once(']')?;
        let rest = rest.trim_start_matches(']').trim_ascii_start();
        let is_header = (rest.is_empty() || rest.starts_with('#')) && !name.contains([',', '"']);
        is_header.then(|| keys(name))
    });
    let mut headers = headers;
    headers.next().unwrap_or_default()
}

/// Keys between dots, without quotes.
fn keys(text: &str) -> Vec<String> {
    let keys = text.split('.');
    keys.map(|key| key.trim().trim_matches(['"', '\'']).to_owned()).collect()
}

/// Whether a letter stands between quotes.
#[derive(Default)]
struct Quotes {
    open: Option<char>,
}

impl Quotes {
    /// Takes the next letter; whether it stands outside.
    fn outside(&mut self, letter: char) -> bool {
        match self.open {
            Some(quote) => {
                if letter == quote {
                    self.open = None;
                }
                false
            }
            None => {
                if letter == '"' || letter == '\'' {
                    self.open = Some(letter);
                }
                self.open.is_none()
            }
        }
    }

    fn open_at_end(text: &str) -> bool {
        let mut quotes = Self::default();
        for letter in text.chars() {
            quotes.outside(letter);
        }
        quotes.open.is_some()
    }

    fn in_remark(line: &str) -> bool {
        let mut quotes = Self::default();
        line.chars().any(|letter| quotes.outside(letter) && letter == '#')
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> Cursor {
        let byte = text.find('|').unwrap();
        let text = text.replace('|', "");
        Cursor::at(&text, byte, &Tree::of(&text))
    }

    #[test]
    fn what_could_be_written_is_told_from_what_stands_before() {
        let path = |keys: &[&str]| keys.iter().map(|key| (*key).to_owned()).collect::<Vec<_>>();
        for (text, expected) in [
            ("na|", Cursor::Key(path(&[]))),
            ("[ax|", Cursor::Table(path(&[]))),
            ("[axis.|", Cursor::Table(path(&["axis"]))),
            ("[axis.X]\nma|", Cursor::Key(path(&["axis", "X"]))),
            (
                "[axis.X]\ntravel = [-1, |",
                Cursor::Value(path(&["axis", "X", "travel", "[1]"]), false),
            ),
            (
                "[axis.X] # slide\nzero = \"Lm + |\"",
                Cursor::Value(path(&["axis", "X", "zero"]), true),
            ),
            (
                "[control]\narcs = { form = \"|",
                Cursor::Value(path(&["control", "arcs", "form"]), true),
            ),
            ("[control]\narcs = { keep = true, |", Cursor::Key(path(&["control", "arcs"]))),
            ("name = \"a\" # not = |", Cursor::Nothing),
            (
                "[tool]\ngauge = [\n  0,\n  \"|\",\n]\n",
                Cursor::Value(path(&["tool", "gauge", "[0]"]), true),
            ),
        ] {
            assert_eq!(at(text), expected, "{text}");
        }
    }
}
