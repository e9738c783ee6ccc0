//! Scripts and styles without what is for readers of the sources alone: comments, indentation, blanks between words and
//! signs, semicolons before braces, and that a name never changes. Strings, templates and patterns stay letter for
//! letter, and so does the end of a line where it may end a statement.
//!
//! A part of the build script, and of the crate for its tests.

/// Words after which a slash begins a pattern and divides nothing.
const BEFORE_PATTERNS: [&str; 10] =
    ["return", "typeof", "case", "in", "of", "delete", "void", "throw", "new", "else"];

/// A script squeezed.
///
/// # Panics
/// A string, a template, a pattern or a comment does not end.
pub fn script(text: &str) -> String {
    let mut script =
        Script { rest: text, out: String::with_capacity(text.len()), token: String::new() };
    script.statements(false);
    script.out
}

struct Script<'a> {
    rest: &'a str,
    out: String,
    /// The last word or sign.
    token: String,
}

impl Script<'_> {
    /// Goes to the end of the text, or past the brace that ends what stands in a template.
    fn statements(&mut self, inner: bool) {
        let mut depth = 0;
        while let Some(first) = self.rest.chars().next() {
            let length = match first {
                _ if first.is_whitespace() || self.is_comment() => {
                    self.gap();
                    continue;
                }
                '"' | '\'' => self.quoted(first),
                '`' => {
                    self.template();
                    continue;
                }
                '/' if self.begins_pattern() => self.pattern(),
                _ if is_word(first) => {
                    let end = self.rest.find(|letter| !is_word(letter));
                    end.unwrap_or(self.rest.len())
                }
                _ => first.len_utf8(),
            };
            let token = &self.rest[..length];
            match token {
                "{" => depth += 1,
                "}" if inner && depth == 0 => return self.take(length),
                "}" => {
                    depth -= 1;
                    // A brace ends a statement too. (No loop of the page has an empty one for its body.)
                    if self.out.ends_with(';') {
                        self.out.pop();
                    }
                }
                _ => {}
            }
            // What never changes is a matter for readers.
            if token == "const" {
                self.out.push_str("let");
                self.rest = &self.rest[length..];
                "let".clone_into(&mut self.token);
                continue;
            }
            self.take(length);
        }
        assert!(!inner, "a template of a script does not end");
    }

    fn is_comment(&self) -> bool {
        self.rest.starts_with("//") || self.rest.starts_with("/*")
    }

    /// Passes over blanks and comments; what is needed of them stays.
    fn gap(&mut self) {
        let mut line = false;
        loop {
            let length = match self.rest.chars().next() {
                Some(first) if first.is_whitespace() => {
                    line |= first == '\n';
                    first.len_utf8()
                }
                Some('/') if self.rest.starts_with("//") => {
                    self.rest.find('\n').unwrap_or(self.rest.len())
                }
                Some('/') if self.rest.starts_with("/*") => {
                    let end = self.rest.find("*/").expect("a comment of a script ends");
                    line |= self.rest[..end].contains('\n');
                    end + 2
                }
                _ => break,
            };
            self.rest = &self.rest[length..];
        }
        let (Some(before), Some(after)) = (self.out.chars().last(), self.rest.chars().next())
        else {
            return;
        };
        let apart = is_word(before) && (is_word(after) || after == '.')
            || before == after && matches!(after, '+' | '-')
            || before == '/'
            || after == '/';
        let inside =
            matches!(before, '{' | '(' | '[' | ',' | ';') || matches!(after, '}' | ')' | ']');
        if line && inside {
            // There no statement ends, or one does with or without it.
        } else if line {
            self.out.push('\n');
        } else if apart {
            self.out.push(' ');
        }
    }

    /// Takes `length` bytes as they are.
    fn take(&mut self, length: usize) {
        let (token, rest) = self.rest.split_at(length);
        self.out.push_str(token);
        self.token.clear();
        self.token.push_str(token);
        self.rest = rest;
    }

    /// A slash stands where a value is wanted.
    fn begins_pattern(&self) -> bool {
        match self.token.chars().last() {
            None => true,
            Some(last) if is_word(last) => BEFORE_PATTERNS.contains(&self.token.as_str()),
            Some(last) => !matches!(last, ')' | ']' | '}' | '"' | '\'' | '`'),
        }
    }

    /// Where a string ends that begins here.
    fn quoted(&self, quote: char) -> usize {
        self.ends(|letter, _| letter == quote)
    }

    /// Where a pattern ends that begins here, without its flags, which are a word.
    fn pattern(&self) -> usize {
        self.ends(|letter, in_class| letter == '/' && !in_class)
    }

    fn ends(&self, is_end: impl Fn(char, bool) -> bool) -> usize {
        let (mut escaped, mut in_class) = (false, false);
        for (at, letter) in self.rest.char_indices().skip(1) {
            assert!(letter != '\n', "a string or pattern of a script ends: {}", self.rest);
            match letter {
                _ if escaped => escaped = false,
                '\\' => escaped = true,
                _ if is_end(letter, in_class) => return at + 1,
                '[' => in_class = true,
                ']' => in_class = false,
                _ => {}
            }
        }
        panic!("a string or pattern of a script ends");
    }

    /// A template, with the values in it squeezed.
    fn template(&mut self) {
        let mut from = 1;
        loop {
            let found = self.rest[from..].find(['`', '\\', '$']);
            let at = from + found.expect("a template of a script ends");
            if self.rest[at..].starts_with("${") {
                self.take(at + 2);
                self.statements(true);
                from = 0;
            } else if self.rest[at..].starts_with('`') {
                return self.take(at + 1);
            } else {
                let escaped = usize::from(self.rest[at..].starts_with('\\'));
                from = at + 1 + escaped;
            }
        }
    }
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || matches!(letter, '_' | '$')
}

/// Styles squeezed.
///
/// # Panics
/// A comment or a string does not end.
pub fn style(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let mut length = first.len_utf8();
        if rest.starts_with("/*") {
            length = rest.find("*/").expect("a comment of the styles ends") + 2;
        } else if first.is_whitespace() {
            // What follows a comment or blank is looked at when it comes.
            if !out.ends_with(['{', '}', ';', ',', ':', ' ']) {
                out.push(' ');
            }
        } else if first == '"' {
            let end = rest[1..].find('"').expect("a string of the styles ends");
            length = end + 2;
            out.push_str(&rest[..length]);
        } else {
            if matches!(first, '{' | '}' | ';' | ',') && out.ends_with(' ') {
                out.pop();
            }
            if first == '}' && out.ends_with(';') {
                out.pop();
            }
            out.push(first);
        }
        rest = &rest[length..];
    }
    out.trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::{script, style};

    #[test]
    fn what_is_for_readers_goes() {
        for (text, squeezed) in [
            ("// one\n\nconst a = 1; // two\n  let b;\n", "let a=1;let b;\n"),
            ("a = b /* no\n line */ + c", "a=b\n+c"),
            ("a - -b + +c; a-- - b", "a- -b+ +c;a-- -b"),
            ("return a\n  (b)", "return a\n(b)"),
            ("in of instanceof x", "in of instanceof x"),
            ("f(\n  a,\n  [\n1\n]\n)\n{\n  b;\n  c;\n}\nd", "f(a,[1])\n{b;c}\nd"),
            ("5 .toFixed ( 2 )", "5 .toFixed(2)"),
        ] {
            assert_eq!(script(text).trim_end(), squeezed.trim_end(), "{text}");
        }
    }

    #[test]
    fn strings_templates_and_patterns_stay() {
        for text in [
            "f(\"a  // b 'c' \\\" d\",'  /* e */ \\'')",
            "g(`  // one\n\n   two \\` ${a+`  ${b}  `}  $ {  } ${{c:1}.c}  `)",
            "x=/[/ \"']  \\/ \\] (/gi.exec(y)",
            "return /  '/",
            "a.replace(/\\/  /, \"\")".replace(", ", ",").leak(),
            "#version 300",
        ] {
            assert_eq!(script(text), text);
        }
        assert_eq!(script("a / b / c; (d) / 'e / f'"), "a / b / c;(d) / 'e / f'");
        assert_eq!(script("`${ a  +  b } c  d`"), "`${a+b} c  d`");
    }

    #[test]
    fn every_script_of_the_page_is_squeezed_once() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
        let mut seen = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let text = std::fs::read_to_string(&path).unwrap();
            let squeezed = match path.extension().unwrap().to_str().unwrap() {
                "js" => script(&text),
                "css" => style(&text),
                _ => continue,
            };
            let again = match path.extension().unwrap().to_str().unwrap() {
                "js" => script(&squeezed),
                _ => style(&squeezed),
            };
            assert_eq!(squeezed, again, "{}", path.display());
            assert!(squeezed.len() < text.len() * 9 / 10, "{}", path.display());
            seen += 1;
        }
        assert!(seen > 20);
    }

    #[test]
    fn styles_mean_the_same() {
        assert_eq!(
            style(
                "/* a */\na:hover , b > c { width : calc(1px - 2px) ; d: \"x  { y\" 1fr / 2fr !important; }\n@media (e: f) { g { } }\n"
            ),
            "a:hover,b > c{width :calc(1px - 2px);d:\"x  { y\" 1fr / 2fr !important}@media (e:f){g{}}"
        );
    }
}
