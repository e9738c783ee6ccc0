//! The G-code family: what its dialects share is an engine, and where they differ they fill in a [`Table`].
//!
//! A dialect is a type that implements [`Control`], most of it the table, and the line
//! `export_dialect!(name, Iso<MyControl>)`. It is a crate beside `post-plugin`, not a part of it: the contract has no
//! opinion on any control, and this may change without it.

mod engine;
mod lines;
mod motion;
pub mod options;
mod table;

use post_plugin::{Capabilities, Dialect, Event, Format, OptionSpec, Setup, VocabularyWord};

pub use engine::Engine;
pub use motion::{FeedDecimals, Motion};
pub use table::{Codes, Dwell, Leave, Length, Offset, Stops, Table, Tcp};

/// A control of the family: its table, and what does not fit into one.
pub trait Control: Sized + Send + 'static {
    /// How it differs from the others.
    const TABLE: &'static Table;

    /// Called once a program, with the setup that the engine has found good.
    ///
    /// # Errors
    /// A sentence for the user, if machine or options cannot be served.
    fn open(setup: &Setup<'_>) -> Result<Self, String>;

    /// The line in front of the machine's name: by default the program's name as a remark.
    fn title(&self, program: &str) -> String {
        match program {
            "" => String::new(),
            name => (Self::TABLE.remark)(name),
        }
    }

    /// Lines behind the one that puts the control into a safe state.
    fn begin(&self, _engine: &mut Engine, _out: &mut String) {}

    /// Looks at an event before the engine does: true if it has written it, so that the engine need not.
    ///
    /// # Errors
    /// A sentence for the user, if it cannot be written.
    fn write(
        &mut self,
        _event: &Event<'_>,
        _engine: &mut Engine,
        _out: &mut String,
    ) -> Result<bool, String> {
        Ok(false)
    }

    /// What it writes beyond straight moves.
    fn capabilities(&self) -> Capabilities {
        Capabilities::NONE
    }

    /// How it writes numbers, where that is not what the engine does.
    fn format(&self, engine: Format) -> Format {
        engine
    }

    /// Its words and what they mean.
    fn vocabulary(&self) -> Vec<VocabularyWord> {
        Vec::new()
    }
}

/// A dialect of the family.
#[derive(Debug)]
pub struct Iso<C> {
    control: C,
    engine: Engine,
}

impl<C: Control> Dialect for Iso<C> {
    fn options() -> &'static [OptionSpec] {
        C::TABLE.options
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let engine = Engine::new(C::TABLE, setup)?;
        let control = C::open(setup)?;
        Ok(Iso { control, engine })
    }

    fn format(&self) -> Format {
        self.control.format(self.engine.format())
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        self.control.vocabulary()
    }

    fn capabilities(&self) -> Capabilities {
        self.control.capabilities()
    }

    #[inline]
    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let Iso { control, engine } = self;
        if control.write(event, engine, out)? {
            return Ok(());
        }
        if let Event::Start = event {
            engine.start(&control.title(engine.program()), out);
            control.begin(engine, out);
            return Ok(());
        }
        engine.write(event, out)
    }
}
