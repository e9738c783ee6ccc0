//! Places that a program jumps to, looked for line by line without reading the blocks.

use std::collections::HashMap;
use std::io::{Read, Seek};

use super::block::{JumpDirection, NcSyntax, Notation};
use super::lines::NcMark;
use super::reader::NcReader;
use crate::fault::ReadError;

/// Jumps that are remembered.
const MOST_FOUND: usize = 1024;

/// What a jump looks for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum NcTarget {
    /// The block of this number: `N100`, conversational `100`.
    Number(u64),
    /// `MARK1:`, conversational `LBL 5` and `LBL "NAME"`; in capitals, without quotation marks.
    Label(String),
    /// The head of a program or subprogram: `O1000` (also written `O01000` and `:1000`), `O<NAME>`, `<NAME>`; in
    /// capitals.
    Program(String),
    /// `o100 sub` and `o<name> sub` by `100` and `<NAME>`; `PROC NAME` by its name; in capitals.
    Subprogram(String),
}

/// What was found, by target, direction and place of the jump.
#[derive(Debug, Default)]
pub(super) struct JumpCache {
    marks: HashMap<(NcTarget, JumpDirection, u64), Option<NcMark>>,
    /// What is known of a target, wherever the jump stands.
    known: HashMap<NcTarget, TargetPlaces>,
    /// Lines looked at.
    searched: u64,
}

/// What is known of where a target stands.
#[derive(Clone, Copy, Debug, Default)]
struct TargetPlaces {
    /// A place, and the first that stands from there on.
    next: Option<(u64, NcMark)>,
    /// From here on there is none.
    none_from: Option<u64>,
    /// The first of the file.
    first: Option<NcMark>,
}

impl TargetPlaces {
    /// The first from `here` on, if that is known: there may be none.
    fn ahead(&self, here: u64) -> Option<Option<NcMark>> {
        match (self.next, self.none_from) {
            (Some((from, mark)), _) if (from..=mark.offset()).contains(&here) => Some(Some(mark)),
            (_, Some(from)) if here >= from => Some(None),
            _ => None,
        }
    }
}

impl<R: Read + Seek> NcReader<R> {
    /// The block that a jump from in front of the next block leads to; none if there is none. Reading goes on where it
    /// was, until [`go_to`](Self::go_to).
    ///
    /// Forwards the first one is found, backwards the last one above.
    ///
    /// # Errors
    /// The input fails.
    pub fn find(
        &mut self,
        target: &NcTarget,
        direction: JumpDirection,
    ) -> Result<Option<NcMark>, ReadError> {
        let here = self.mark();
        let key = (target.clone(), direction, here.offset());
        if let Some(found) = self.found.marks.get(&key) {
            return Ok(*found);
        }
        let found = self.look(target, direction, here);
        self.go_to(here)?;
        let found = found?;
        if self.found.marks.len() >= MOST_FOUND {
            self.found.marks.clear();
            self.found.known.clear();
        }
        self.found.marks.insert(key, found);
        Ok(found)
    }

    /// Lines that were looked at in all by [`find`](Self::find): callers that bound the time count them.
    pub fn lines_searched(&self) -> u64 {
        self.found.searched
    }

    fn look(
        &mut self,
        target: &NcTarget,
        direction: JumpDirection,
        here: NcMark,
    ) -> Result<Option<NcMark>, ReadError> {
        if direction == JumpDirection::Back {
            return self.look_from(NcMark::START, here.offset(), target, true);
        }
        let mut known = self.found.known.get(target).copied().unwrap_or_default();
        let ahead = match known.ahead(here.offset()) {
            Some(ahead) => ahead,
            None => {
                let ahead = self.look_from(here, u64::MAX, target, false)?;
                match ahead {
                    Some(mark) => known.next = Some((here.offset(), mark)),
                    None => known.none_from = Some(here.offset()),
                }
                ahead
            }
        };
        let mut found = ahead;
        if ahead.is_none() && direction == JumpDirection::Anywhere {
            found = match known.first.filter(|first| first.offset() < here.offset()) {
                Some(first) => Some(first),
                None => self.look_from(NcMark::START, here.offset(), target, false)?,
            };
            known.first = found;
        }
        self.found.known.insert(target.clone(), known);
        Ok(found)
    }

    /// The first line between two places that `target` means; the last one where `last`.
    fn look_from(
        &mut self,
        from: NcMark,
        until: u64,
        target: &NcTarget,
        last: bool,
    ) -> Result<Option<NcMark>, ReadError> {
        self.lines.go_to(from)?;
        let mut found = None;
        loop {
            let mark = self.lines.mark();
            if mark.offset() >= until {
                return Ok(found);
            }
            let Some(physical) = self.lines.physical()? else {
                return Ok(found);
            };
            self.found.searched += 1;
            let line = LineRest(self.lines.text(&physical).trim_ascii_start());
            if line.is(target, &self.syntax) {
                found = Some(mark);
                if !last {
                    return Ok(found);
                }
            }
            self.lines.consume(&physical)?;
        }
    }
}

/// What is left of a line.
#[derive(Clone, Copy)]
struct LineRest<'t>(&'t [u8]);

impl<'t> LineRest<'t> {
    /// Whether the line begins the block, label or program that `target` means.
    fn is(self, target: &NcTarget, syntax: &NcSyntax) -> bool {
        let conversational = syntax.notation == Notation::Conversational;
        let line = self.after_skip();
        match target {
            NcTarget::Number(number) => {
                let behind = if conversational {
                    Some(line)
                } else {
                    line.after(b"N").or(if syntax.hash_variables { None } else { line.after(b":") })
                };
                behind.and_then(LineRest::whole).is_some_and(|(found, _)| found == *number)
            }
            NcTarget::Label(name) if conversational => {
                line.after_number(b"").after(b"LBL").is_some_and(|line| line.is_label(name))
            }
            NcTarget::Label(name) => line
                .after_number(b"N")
                .after(name.as_bytes())
                .and_then(|line| line.after(b":"))
                .is_some(),
            NcTarget::Program(name) => line.is_program(name),
            NcTarget::Subprogram(name) => line.after_number(b"N").is_subprogram(name),
        }
    }

    /// What follows the name `name`, blanks within angle brackets aside.
    fn after_name(self, name: &str) -> Option<Self> {
        let (first, angled) = name.split_at(name.find('<').unwrap_or(name.len()));
        let mut line = self.after(first.as_bytes())?;
        for byte in angled.as_bytes() {
            line = line.after(std::slice::from_ref(byte))?;
        }
        Some(line)
    }

    /// What follows `prefix`, in capitals, and blanks.
    fn after(self, prefix: &[u8]) -> Option<Self> {
        let (head, rest) = self.0.split_at_checked(prefix.len())?;
        head.eq_ignore_ascii_case(prefix).then(|| LineRest(rest.trim_ascii_start()))
    }

    fn after_skip(self) -> Self {
        match self.0 {
            [b'/', b'0'..=b'9', rest @ ..] | [b'/', rest @ ..] => LineRest(rest.trim_ascii_start()),
            _ => self,
        }
    }

    /// The text after the number of the block, if it has one.
    fn after_number(self, letter: &[u8]) -> Self {
        let behind = self.after(letter).and_then(LineRest::whole);
        behind.map_or(self, |(_, rest)| rest)
    }

    /// A whole number, and what follows it.
    fn whole(self) -> Option<(u64, Self)> {
        let digits = self.0.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let number = std::str::from_utf8(&self.0[..digits]).ok()?.parse().ok()?;
        let rest = &self.0[digits..];
        (rest.first() != Some(&b'.')).then(|| (number, LineRest(rest.trim_ascii_start())))
    }

    /// `5`, `"NAME"`
    fn is_label(self, name: &str) -> bool {
        match (self.whole(), name.parse::<u64>()) {
            (Some((found, _)), Ok(number)) => found == number,
            (None, _) => self
                .after(b"\"")
                .and_then(|line| line.after(name.as_bytes()))
                .is_some_and(|line| line.0.first() == Some(&b'"')),
            _ => false,
        }
    }

    /// `O1000`, and no `o` word of LinuxCNC.
    fn is_program(self, name: &str) -> bool {
        if let Some(number) = name.strip_prefix('O').and_then(|name| name.parse::<u64>().ok()) {
            let found = self.after(b"O").or(self.after(b":")).and_then(LineRest::whole);
            return found.is_some_and(|(found, rest)| found == number && !rest.is_o_word());
        }
        self.after_name(name).is_some_and(|rest| {
            let ends = name.ends_with('>') || rest.0.is_empty() || rest.0[0] == b'(';
            ends && !rest.is_o_word()
        })
    }

    /// A word of LinuxCNC after an `o` name.
    fn is_o_word(self) -> bool {
        const WORDS: [&[u8]; 10] = [
            b"SUB",
            b"ENDSUB",
            b"CALL",
            b"IF",
            b"ELSE",
            b"ENDIF",
            b"WHILE",
            b"ENDWHILE",
            b"DO",
            b"RE",
        ];
        WORDS.iter().any(|word| self.after(word).is_some())
    }

    fn is_subprogram(self, name: &str) -> bool {
        if let Some(line) = self.after(b"PROC") {
            let behind = line.after(name.as_bytes());
            return behind.is_some_and(|rest| {
                rest.0.first().is_none_or(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_')
            });
        }
        let Some(line) = self.after(b"O") else {
            return false;
        };
        let behind = match (line.whole(), name.parse::<u64>()) {
            (Some((found, rest)), Ok(number)) if found == number => Some(rest),
            (None, Err(_)) => line.after_name(name),
            _ => None,
        };
        behind.is_some_and(|rest| rest.after(b"SUB").is_some())
    }
}
