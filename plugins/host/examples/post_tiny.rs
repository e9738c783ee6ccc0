//! The smallest dialect that is of use: absolute moves, nothing modal.

use post_plugin::{Block, Dialect, Event, Feed, Format, NumberStyle, Setup, export_dialect};

struct Tiny {
    words: Vec<String>,
}

impl Dialect for Tiny {
    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let words = setup.words.iter().map(|word| word.name.to_owned());
        Ok(Tiny {
            words: words.collect(),
        })
    }

    fn format(&self) -> Format {
        Format {
            words: vec![3; self.words.len()],
            feed: 1,
            inverse_time: None,
            feed_per_revolution: 3,
            extension: "nc".to_owned(),
            ..Format::default()
        }
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let (motion, words, feed) = match *event {
            Event::Start => {
                out.push_str("G21 G90 G94\n");
                return Ok(());
            }
            Event::End => {
                out.push_str("M30\n");
                return Ok(());
            }
            Event::Position {
                words, feed: None, ..
            }
            | Event::Rapid { words, .. } => ("G0", words, None),
            Event::Linear {
                words,
                feed: Feed::PerMinute(feed),
                ..
            } => ("G1", words, Some(feed)),
            other => return Err(other.refusal()),
        };
        let mut block = Block::plain();
        block.word(motion);
        for (name, value) in self.words.iter().zip(words) {
            block.number(name, *value, 3, NumberStyle::default());
        }
        if let Some(feed) = feed {
            block.number("F", feed, 1, NumberStyle::default());
        }
        block.end(out);
        Ok(())
    }
}

export_dialect!(tiny, Tiny);
