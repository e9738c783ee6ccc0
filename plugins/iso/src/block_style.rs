//! How blocks look: blanks between words, zeros after G and M.

/// How blocks look. It changes no value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockStyle {
    /// Blanks between the words.
    pub(crate) spaces: bool,
    /// `G01`, `M06`.
    pub(crate) leading_zeros: bool,
}

impl BlockStyle {
    /// Blocks are written as the engine puts them together.
    pub(crate) fn is_plain(self) -> bool {
        self.spaces && !self.leading_zeros
    }

    /// Changes the lines of `out` from `start` on. Remarks stay as they are.
    pub(crate) fn apply(self, out: &mut String, start: usize) {
        let written = out.split_off(start);
        let mut remark = false;
        let mut letters = written.chars().peekable();
        let mut before = '\n';
        while let Some(letter) = letters.next() {
            match letter {
                '(' => remark = true,
                ')' | '\n' => remark = false,
                ' ' if !remark && !self.spaces => continue,
                _ => {}
            }
            out.push(letter);
            let address = matches!(letter, 'G' | 'M') && !before.is_ascii_alphabetic() && !remark;
            before = letter;
            if !address || !self.leading_zeros {
                continue;
            }
            let Some(digit) = letters.next_if(char::is_ascii_digit) else {
                continue;
            };
            if !letters.peek().is_some_and(char::is_ascii_digit) {
                out.push('0');
            }
            out.push(digit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looks(spaces: bool, leading_zeros: bool, text: &str) -> String {
        let mut out = String::from("G0 (A B)\n");
        let start = out.len();
        out.push_str(text);
        let look = BlockStyle { spaces, leading_zeros };
        look.apply(&mut out, start);
        assert!(out.starts_with("G0 (A B)\n"));
        out.split_off(start)
    }

    #[test]
    fn remarks_and_numbers_stay() {
        let block = "N10 G1 X1. M3 (G1 OF M6)\nG54.1 P2\nG5.1 Q1\nG17\nG43.4 H1\n";
        assert_eq!(
            looks(true, true, block),
            "N10 G01 X1. M03 (G1 OF M6)\nG54.1 P2\nG05.1 Q1\nG17\nG43.4 H1\n"
        );
        assert_eq!(
            looks(false, false, block),
            "N10G1X1.M3(G1 OF M6)\nG54.1P2\nG5.1Q1\nG17\nG43.4H1\n"
        );
        assert_eq!(looks(false, true, "G0 A1.\nM30\n"), "G00A1.\nM30\n");
    }
}
