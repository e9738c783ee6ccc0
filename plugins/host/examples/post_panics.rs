//! A dialect that panics: the host must live, and say who it was.

use post_plugin::{Dialect, Event, Format, Setup, export_dialect};

struct Panics(usize);

impl Dialect for Panics {
    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        assert_ne!(setup.program, "open", "no such program");
        Ok(Panics(setup.words.len()))
    }

    fn format(&self) -> Format {
        Format {
            words: vec![3; self.0],
            feed: 0,
            inverse_time: None,
            feed_per_revolution: 0,
            ..Format::default()
        }
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        out.push_str("half a line");
        match event {
            Event::Park { .. } => panic!("the sky fell on {}", "Park"),
            Event::End => std::panic::panic_any(4711),
            _ => out.push('\n'),
        }
        Ok(())
    }
}

export_dialect!(panics, Panics);
