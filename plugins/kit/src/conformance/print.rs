//! The certificate speaks of the printed text: whatever a move says, to its last declared decimal, must be in it.
//!
//! A short program is written twice, with one number changed; where the text of the move stays the same, the dialect
//! does not print it.

use post_plugin::{Capabilities, DialectSession as _, Event, Feed, Format, quantise};

use super::Case;
use super::pen::{BEGIN, ELSEWHERE, END, Pen, rounded};
use crate::{at, cut};
use post_host::{PluginFault, ProgramWord};

/// Where the tool stands, but for the word that is looked at.
const PLACE: [f64; 5] = [11.0, -21.5, 31.25, -17.0, 41.0];

/// mm or inch.
const LINEAR: [f64; 5] = [0.0, 12.345_678, -12.345_678, 123.456_789, 2_345.678_9];
/// Degrees, past a turn too.
const ROTARY: [f64; 5] = [0.0, 12.345_678, -179.999_999, 359.999_999, -1_234.567_89];
/// A feed that every control has, a minute.
const USUAL_FEED: f64 = 500.0;
/// Lengths a minute, or 1/min.
const FEEDS: [f64; 4] = [0.0, 1.25, 123.456_78, 5000.0];

/// A kind of move that every program has.
#[derive(Clone, Copy, PartialEq)]
enum MoveKind {
    Retract,
    Park,
    Turn,
    Position,
    PositionAtFeed,
    Rapid,
    Cut,
    CutInInverseTime,
}

use MoveKind::{Cut, CutInInverseTime, Park, Position, PositionAtFeed, Rapid, Retract, Turn};

impl MoveKind {
    fn all(format: &Format) -> Vec<MoveKind> {
        let mut kinds = vec![Retract, Park, Turn, Position, PositionAtFeed, Rapid, Cut];
        kinds.extend(format.inverse_time.map(|_| CutInInverseTime));
        kinds
    }

    fn name(self) -> &'static str {
        match self {
            Retract => "a retract",
            Park => "a position of the machine",
            Turn => "a turn of the rotary axes",
            Position => "a first position",
            PositionAtFeed => "a first position at a feed",
            Rapid => "a rapid",
            Cut => "a cut",
            CutInInverseTime => "a cut in inverse time",
        }
    }

    fn comes_first(self) -> bool {
        matches!(self, Retract | Park | Turn | Position | PositionAtFeed)
    }

    /// It has this word: a retract that of the depth, a turn those of rotary axes, a first position the others.
    fn has(self, word: &ProgramWord) -> bool {
        match self {
            Retract => word.depth,
            Turn => word.rotary,
            Position | PositionAtFeed => !word.rotary,
            Park | Rapid | Cut | CutInInverseTime => true,
        }
    }

    /// Decimals of its feed.
    fn feed_decimals(self, format: &Format) -> Option<u8> {
        match self {
            Retract | Park | Turn | Position | Rapid => None,
            PositionAtFeed | Cut => Some(format.feed),
            CutInInverseTime => format.inverse_time,
        }
    }

    fn event(self, words: &[f64], feed: f64) -> Event<'_> {
        match self {
            Retract => Event::Retract { axes: 0b100, words },
            Park => Event::Park { axes: 0b1_1111, words },
            Turn => Event::Turn { words },
            Position => Event::position(words, None),
            PositionAtFeed => Event::position(words, Some(Feed::PerMinute(feed))),
            Rapid => Event::rapid(words),
            Cut => Event::linear(words, Feed::PerMinute(feed)),
            CutInInverseTime => Event::linear(words, Feed::InverseTime(feed)),
        }
    }
}

/// A move with its numbers.
#[derive(Clone, Copy)]
struct TriedMove {
    kind: MoveKind,
    words: [f64; 5],
    feed: f64,
}

impl TriedMove {
    fn event(&self) -> Event<'_> {
        self.kind.event(&self.words, self.feed)
    }
}

/// Degrees by which a rotary word is changed at least where the tool's direction stands in its place: that of a vector
/// with six decimals.
const DIRECTION: f64 = 0.01;

/// Runs all kinds of moves, with every word and feed.
pub(super) fn moves(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let opened = pen.open()?;
    let format = opened.format().clone();
    // Lines of the user's own retract there, wherever that is.
    let own_retract = opened.capabilities().has(Capabilities::NO_PARK);
    drop(opened);
    for kind in MoveKind::all(&format) {
        if pen.leaves_out(&kind.event(&[], 0.0)) {
            continue;
        }
        if let Err(fault) = alone(pen, &format, kind, USUAL_FEED)? {
            case.wrong(format!("{} is refused: {fault}", kind.name()));
            continue;
        }
        for word in 0..format.words.len() {
            if !kind.has(&pen.setup.words[word]) || own_retract && kind == Retract {
                continue;
            }
            if let Some(fault) = word_fault(pen, &format, kind, word)? {
                case.wrong(format!("{}: {fault}", kind.name()));
            }
        }
        if let Some(fault) = feed_fault(pen, &format, kind)? {
            case.wrong(format!("{}: {fault}", kind.name()));
        }
    }
    Ok(())
}

/// Whether a move of this kind is written at a feed.
fn alone(
    pen: &Pen<'_>,
    format: &Format,
    kind: MoveKind,
    feed: f64,
) -> Result<Result<(), String>, PluginFault> {
    let alone = TriedMove { kind, words: rounded(PLACE, format), feed };
    let before: &[Event<'_>] = if kind.comes_first() { &[] } else { &[at(&ELSEWHERE)] };
    Ok(pen.write(&[BEGIN, before, &[alone.event()]])?.map(drop))
}

/// Cuts and rapids alone, for a second look under another option.
pub(super) fn plain_moves(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let format = pen.open()?.format().clone();
    for kind in [Rapid, Cut] {
        for word in 0..format.words.len() {
            if let Some(fault) = word_fault(pen, &format, kind, word)? {
                case.wrong(format!("{}: {fault}", kind.name()));
            }
        }
        if let Some(fault) = feed_fault(pen, &format, kind)? {
            case.wrong(format!("{}: {fault}", kind.name()));
        }
    }
    Ok(())
}

/// Words where a digit more begins, where a rounding carries over, about zero and at the ends of what axes reach: each
/// differs from both of its neighbours in the last declared decimal.
pub(super) fn edges(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    const EDGES: [f64; 12] =
        [0.0, 0.1, 0.3, 0.5, 1.0, 9.5, 10.0, 99.5, 100.0, 1000.0, 8191.75, 99_999.5];
    let format = pen.open()?.format().clone();
    let text = |word: usize, value: f64| {
        let mut words = rounded(PLACE, &format);
        if let Some(own) = words.get_mut(word) {
            *own = value;
        }
        let cut = [cut(&words, 500.0)];
        let written = pen.write(&[BEGIN, &[at(&ELSEWHERE)], &cut])?;
        Ok(written.map(|written| written.part(2).to_owned()))
    };
    let vectors = pen.writes_vectors()?;
    for (word, decimals) in format.words.iter().enumerate() {
        if vectors && pen.setup.words[word].rotary {
            continue;
        }
        let (name, unit) = (&pen.setup.words[word].name, unit(*decimals));
        for edge in EDGES.into_iter().flat_map(|edge| [edge, -edge]) {
            let values = [edge - unit, edge, edge + unit].map(|value| quantise(value, *decimals));
            let mut texts = Vec::with_capacity(values.len());
            for value in values {
                match text(word, value)? {
                    Ok(text) => texts.push(text),
                    Err(fault) => case.wrong(format!("{name} {value} is refused: {fault}")),
                }
            }
            for (pair, values) in texts.windows(2).zip(values.windows(2)) {
                if pair[0] == pair[1] {
                    case.wrong(format!(
                        "{name} {} and {} are written alike: `{}`",
                        values[0],
                        values[1],
                        pair[0].trim_end()
                    ));
                }
            }
        }
    }
    Ok(())
}

/// What is wrong with a word of a kind of move.
fn word_fault(
    pen: &Pen<'_>,
    format: &Format,
    kind: MoveKind,
    word: usize,
) -> Result<Option<String>, PluginFault> {
    let (name, rotary) = (&pen.setup.words[word].name, pen.setup.words[word].rotary);
    let decimals = format.words[word];
    let vector =
        rotary && matches!(kind, Rapid | Cut | CutInInverseTime) && pen.writes_vectors()?;
    let unit = if vector { unit(decimals).max(DIRECTION) } else { unit(decimals) };
    for value in if rotary { ROTARY } else { LINEAR } {
        let value = quantise(value, decimals);
        let mut base = TriedMove { kind, words: rounded(PLACE, format), feed: 500.0 };
        base.words[word] = value;
        let mut changes = vec![(value + unit, LAST_DECIMAL), (value - unit, LAST_DECIMAL)];
        if value != 0.0 {
            changes.push((-value, "the other sign"));
        }
        if rotary {
            changes.push((value + 360.0, "a turn"));
        }
        // A whole turn leaves the direction as it is.
        changes.retain(|(changed, _)| {
            let turns = (changed - value) / 360.0;
            !vector || (turns - turns.round()).abs() * 360.0 > DIRECTION / 2.0
        });
        for before in befores(format, &base) {
            for (changed, what) in &changes {
                let changed = quantise(*changed, decimals);
                let mut other = base;
                other.words[word] = changed;
                if let Some(fault) = same_text(pen, before, &base, &other)? {
                    return Ok(Some(format!(
                        "with {name} {changed} instead of {value} ({what}) {fault}"
                    )));
                }
            }
        }
    }
    Ok(None)
}

const LAST_DECIMAL: &str = "the last declared decimal";

/// What is wrong with the feed of a kind of move.
fn feed_fault(
    pen: &Pen<'_>,
    format: &Format,
    kind: MoveKind,
) -> Result<Option<String>, PluginFault> {
    let Some(decimals) = kind.feed_decimals(format) else {
        return Ok(None);
    };
    let unit = unit(decimals);
    for value in FEEDS {
        let value = quantise(value, decimals).max(unit);
        // A control may have a least feed: what is slower is refused in words then.
        if value < USUAL_FEED && alone(pen, format, kind, value)?.is_err() {
            continue;
        }
        let base = TriedMove { kind, words: rounded(PLACE, format), feed: value };
        for before in befores(format, &base) {
            for changed in [value + unit, value - unit] {
                let feed = quantise(changed, decimals);
                let other = TriedMove { feed, ..base };
                // A move to where the tool stands already needs no feed.
                let still = before.is_some_and(|before| before.words == base.words);
                if feed <= 0.0 || still {
                    continue;
                }
                if let Some(fault) = same_text(pen, before, &base, &other)? {
                    return Ok(Some(format!(
                        "with the feed {feed} instead of {value} ({LAST_DECIMAL}) {fault}"
                    )));
                }
            }
        }
    }
    Ok(None)
}

/// What may come before a move: none before a first position; else each kind, from elsewhere, and from where the move
/// itself ends, so that a word of it is written alone.
fn befores(format: &Format, base: &TriedMove) -> Vec<Option<TriedMove>> {
    if base.kind.comes_first() {
        return vec![None];
    }
    let kinds = MoveKind::all(format);
    let kinds = kinds.into_iter().filter(|kind| !kind.comes_first());
    kinds
        .flat_map(|kind| {
            let from = |words| Some(TriedMove { kind, words, ..*base });
            [from(base.words), from(rounded(ELSEWHERE, format))]
        })
        .collect()
}

/// Both moves have the same text, or are not written: what to say of it.
fn same_text(
    pen: &Pen<'_>,
    before: Option<TriedMove>,
    one: &TriedMove,
    other: &TriedMove,
) -> Result<Option<String>, PluginFault> {
    let came: Vec<Event<'_>> = match &before {
        Some(before) => vec![at(&[9.0; 5]), before.event()],
        None => Vec::new(),
    };
    let write = |looked_at: &TriedMove| pen.write(&[BEGIN, &came, &[looked_at.event()], END]);
    Ok(match (write(one)?, write(other)?) {
        (Ok(one), Ok(other)) if one.part(2) == other.part(2) => {
            Some(format!("its text is the same: `{}`", one.part(2).trim_end()))
        }
        (Ok(_), Ok(_)) => None,
        (Err(fault), _) | (_, Err(fault)) => Some(format!("it is refused: {fault}")),
    })
}

/// One in the last of so many decimals.
fn unit(decimals: u8) -> f64 {
    let unit = (0..decimals).fold(1.0, |unit, _| unit / 10.0);
    quantise(unit, decimals)
}
