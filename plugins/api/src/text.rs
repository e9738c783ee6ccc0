//! Text that any control can read.

/// `text` in printable ASCII: letters with marks lose them (`ä` becomes `ae`), what has no counterpart
/// becomes `?`, tabs and other controls become blanks.
pub fn ascii(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            ' '..='~' => plain.push(letter),
            _ if letter.is_control() || letter.is_whitespace() => plain.push(' '),
            _ => plain.push_str(counterpart(letter)),
        }
    }
    plain
}

fn counterpart(letter: char) -> &'static str {
    match letter {
        'ä' | 'æ' => "ae",
        'ö' | 'œ' => "oe",
        'ü' => "ue",
        'Ä' | 'Æ' => "AE",
        'Ö' | 'Œ' => "OE",
        'Ü' => "UE",
        'ß' => "ss",
        'à' | 'á' | 'â' | 'ã' | 'å' => "a",
        'À' | 'Á' | 'Â' | 'Ã' | 'Å' => "A",
        'ç' | 'č' | 'ć' => "c",
        'Ç' | 'Č' | 'Ć' => "C",
        'è' | 'é' | 'ê' | 'ë' | 'ě' => "e",
        'È' | 'É' | 'Ê' | 'Ë' | 'Ě' => "E",
        'ì' | 'í' | 'î' | 'ï' => "i",
        'Ì' | 'Í' | 'Î' | 'Ï' => "I",
        'ñ' => "n",
        'Ñ' => "N",
        'ò' | 'ó' | 'ô' | 'õ' => "o",
        'ø' | 'Ø' => "D",
        'Ò' | 'Ó' | 'Ô' | 'Õ' => "O",
        'ù' | 'ú' | 'û' => "u",
        'Ù' | 'Ú' | 'Û' => "U",
        'š' => "s",
        'Š' => "S",
        'ž' => "z",
        'Ž' => "Z",
        'µ' | 'μ' => "u",
        '°' => "DEG",
        '–' | '—' => "-",
        '‘' | '’' => "'",
        '“' | '”' => "\"",
        '×' => "x",
        _ => "?",
    }
}

/// `text` as a remark in parentheses: capitals, one level, since controls do not nest them.
pub fn remark(text: &str) -> String {
    let inner: String = ascii(text)
        .trim()
        .chars()
        .map(|letter| match letter {
            '(' => '[',
            ')' => ']',
            // A percent sign would end the program where it stands in a transfer.
            '%' => ' ',
            other => other.to_ascii_uppercase(),
        })
        .collect();
    format!("({inner})")
}

/// `text` in pieces of at most `most` bytes, parted at blanks where it has some: a remark that is longer than the
/// control's lines. One piece, the text as it is, if it is short enough.
pub fn wrapped(text: &str, most: usize) -> Vec<String> {
    if text.len() <= most {
        return vec![text.to_owned()];
    }
    let mut pieces = vec![String::new()];
    for word in text.split_whitespace() {
        for part in parts(word, most.max(4)) {
            match pieces.last_mut() {
                Some(last) if last.is_empty() => last.push_str(part),
                Some(last) if last.len() + 1 + part.len() <= most => {
                    last.push(' ');
                    last.push_str(part);
                }
                _ => pieces.push(part.to_owned()),
            }
        }
    }
    pieces
}

/// A word in pieces of at most `most` bytes.
fn parts(mut word: &str, most: usize) -> Vec<&str> {
    let mut parts = Vec::new();
    while word.len() > most {
        let end = (0..=most).rev().find(|end| word.is_char_boundary(*end));
        let (part, rest) = word.split_at(end.unwrap_or(word.len()));
        parts.push(part);
        word = rest;
    }
    parts.push(word);
    parts
}
