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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_stay_in_one_pair_of_parentheses() {
        assert_eq!(remark("Fräser (neu) Ø10\t100%"), "(FRAESER [NEU] D10 100 )");
        assert_eq!(remark("漢\r\n"), "(?)");
        assert_eq!(remark(""), "()");
    }
}
