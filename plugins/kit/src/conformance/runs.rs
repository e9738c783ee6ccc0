//! Runs of cuts are written as their cuts would be one by one.

use post_host::PluginFault;
use post_plugin::{
    Capabilities, Columns, Compensation, Coolant, DialectSession as _, Event, Feed, Format,
};

use super::Case;
use super::pen::{BEGIN, ELSEWHERE, END, HERE, Pen, SLOW, rounded};
use crate::{at, rapid};

/// Cuts of the longest run.
const MOST: usize = 70;

/// What comes in front of a run, by what it is called.
const BEFORE: &[(&str, &[Event<'static>])] = &[
    ("a run of cuts", &[]),
    ("a run of cuts behind a rapid", &[rapid(&ELSEWHERE)]),
    ("a run of cuts behind a cut", &[Event::linear(&ELSEWHERE, SLOW)]),
    ("a run of cuts behind a stop", &[Event::Coolant(Coolant::Flood), Event::Stop]),
    ("a run of cuts behind an optional stop", &[Event::linear(HERE, SLOW), Event::OptionalStop]),
    ("a run of cuts behind a line of the user's own", &[Event::Literal { text: "M78" }]),
    ("a run of cuts under compensation", &[Event::Compensate(Compensation::Left { register: 1 })]),
];

/// Tries it with feeds of every kind, with words that change and that do not, and with large ones.
pub(super) fn runs(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let opened = pen.open()?;
    if !opened.capabilities().has(Capabilities::CUTS) {
        return Ok(());
    }
    let format = opened.format();
    let mut kinds: Vec<fn(f64) -> Feed> = vec![Feed::PerMinute, Feed::PerRevolution];
    if format.inverse_time.is_some() {
        kinds.push(Feed::InverseTime);
    }
    for (what, before) in BEFORE {
        for kind in &kinds {
            for (size, count) in [(1.0, 1), (1.0, 2), (0.01, MOST), (1.0, MOST), (60.0, MOST)] {
                let points = points(size, count, format);
                let [single, run] = written(pen, before, *kind, &points)?;
                if single != run {
                    let name = kind(1.0);
                    case.wrong(format!(
                        "{what}, {count} of them at {name}: other text than that of the cuts one by one"
                    ));
                    return Ok(());
                }
            }
        }
    }
    Ok(())
}

/// Points that wander by so much, where some words stand for a while.
fn points(size: f64, count: usize, format: &Format) -> Vec<[f64; 5]> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut words = [10.0, 20.0, 0.0, 5.0, 6.0];
    let step = |words: &mut [f64; 5], next: &mut dyn FnMut() -> f64| {
        for word in words {
            *word += if next() < 0.3 { 0.0 } else { (next() - 0.5) * size };
        }
    };
    (0..count)
        .map(|_| {
            // A cut that changes nothing is in it now and then.
            if next() > 0.1 {
                step(&mut words, &mut next);
            }
            rounded(words, format)
        })
        .collect()
}

/// The program with cuts one by one, and with all in one event; none where it is refused.
fn written(
    pen: &Pen<'_>,
    before: &[Event<'_>],
    kind: fn(f64) -> Feed,
    points: &[[f64; 5]],
) -> Result<[Option<String>; 2], PluginFault> {
    // Now and then another one, of as many decimals as any control has.
    let feed = |place: usize| [400.0, 450.0, 7.0, 1250.0][place / 3 % 4];
    let singles: Vec<Event<'_>> =
        (0..).zip(points).map(|(place, words)| Event::linear(words, kind(feed(place)))).collect();
    let mut columns: Vec<f64> = (0..points.len()).map(feed).collect();
    for word in 0..5 {
        columns.extend(points.iter().map(|words| words[word]));
    }
    let run = [Event::Cuts { feed: kind(feed(0)), columns: Columns(&columns) }];
    let came = [at(&ELSEWHERE)];
    let goes_on = [
        Event::linear(HERE, SLOW),
        Event::Compensate(Compensation::Off),
        Event::linear(&ELSEWHERE, SLOW),
    ];
    let mut texts = [None, None];
    for (text, cuts) in texts.iter_mut().zip([singles.as_slice(), &run]) {
        // A run does not tell how the tool stands.
        let program = pen.write_unposed(&[BEGIN, &came, before, cuts, &goes_on, END])?;
        *text = program.ok().map(|program| program.text);
    }
    Ok(texts)
}
