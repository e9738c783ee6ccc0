//! Random texts of a pattern.

use std::iter::Peekable;
use std::str::Chars;

use crate::Rng;

impl Rng {
    /// A text of this pattern: characters, `[a-z_]`, `(one|other)`, and behind any of them `?`, `{n}` or `{from,to}`. A `\`
    /// stands before a character that would mean something.
    ///
    /// # Panics
    /// If the pattern is none.
    pub fn text(&mut self, pattern: &str) -> String {
        let mut rest = pattern.chars().peekable();
        let choice = Choice::read(&mut rest);
        assert!(rest.next().is_none(), "a bracket too many: {pattern}");
        let mut text = String::new();
        choice.write(self, &mut text);
        text
    }

    /// One of these.
    pub fn choose<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.pick(all.len())]
    }

    /// `from` to `to` of what `make` makes, `to` left out.
    pub fn some<T>(
        &mut self,
        [from, to]: [usize; 2],
        mut make: impl FnMut(&mut Self) -> T,
    ) -> Vec<T> {
        let count = from + self.pick(to - from);
        (0..count).map(|_| make(self)).collect()
    }

    /// Any bytes, fewer than `most`.
    pub fn bytes(&mut self, most: usize) -> Vec<u8> {
        self.some([0, most], |rng| rng.next() as u8)
    }
}

/// Sequences of which one is taken.
struct Choice(Vec<Vec<Piece>>);

/// A part of a sequence, and how often it stands there.
struct Piece {
    what: What,
    least: usize,
    most: usize,
}

enum What {
    /// One of these characters, each range with both ends.
    Characters(Vec<(char, char)>),
    Group(Choice),
}

impl Choice {
    fn read(rest: &mut Peekable<Chars<'_>>) -> Self {
        let mut all = vec![Vec::new()];
        while let Some(&next) = rest.peek() {
            match next {
                ')' => break,
                '|' => {
                    rest.next();
                    all.push(Vec::new());
                }
                _ => {
                    let piece = Piece::read(rest);
                    all.last_mut().unwrap().push(piece);
                }
            }
        }
        Self(all)
    }

    fn write(&self, rng: &mut Rng, text: &mut String) {
        for piece in rng.choose(&self.0) {
            for _ in 0..piece.least + rng.pick(piece.most - piece.least + 1) {
                match &piece.what {
                    What::Group(group) => group.write(rng, text),
                    What::Characters(ranges) => text.push(character(ranges, rng)),
                }
            }
        }
    }
}

/// Each character of the ranges as often as any other.
fn character(ranges: &[(char, char)], rng: &mut Rng) -> char {
    let size = |(first, last): &(char, char)| (*last as u32 - *first as u32 + 1) as usize;
    let mut place = rng.pick(ranges.iter().map(size).sum());
    for range in ranges {
        if place < size(range) {
            return char::from_u32(range.0 as u32 + place as u32).unwrap();
        }
        place -= size(range);
    }
    unreachable!("below the sum of all")
}

impl Piece {
    fn read(rest: &mut Peekable<Chars<'_>>) -> Self {
        let what = match rest.next().unwrap() {
            '(' => {
                let group = Choice::read(rest);
                assert_eq!(rest.next(), Some(')'));
                What::Group(group)
            }
            '[' => What::Characters(ranges(rest)),
            '\\' => one(rest.next().unwrap()),
            character => one(character),
        };
        let [least, most] = match rest.peek() {
            Some('?') => {
                rest.next();
                [0, 1]
            }
            Some('{') => {
                let inner: String = rest.skip(1).take_while(|next| *next != '}').collect();
                let (least, most) = inner.split_once(',').unwrap_or((&inner, &inner));
                [least, most].map(|number| number.parse().unwrap())
            }
            _ => [1, 1],
        };
        Self { what, least, most }
    }
}

fn one(character: char) -> What {
    What::Characters(vec![(character, character)])
}

/// What stands behind `[`, up to its end.
fn ranges(rest: &mut Peekable<Chars<'_>>) -> Vec<(char, char)> {
    let mut all = Vec::new();
    loop {
        let first = match rest.next().unwrap() {
            ']' => return all,
            '\\' => rest.next().unwrap(),
            first => first,
        };
        let mut ahead = rest.clone();
        let last = match (ahead.next(), ahead.next()) {
            (Some('-'), Some(last)) if last != ']' => {
                *rest = ahead;
                match last {
                    '\\' => rest.next().unwrap(),
                    last => last,
                }
            }
            _ => first,
        };
        all.push((first, last));
    }
}
