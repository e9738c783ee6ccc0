//! The G-code family: what its dialects share is an engine, and where they differ they fill in a [`Table`].
//!
//! A dialect is a type that implements [`Control`], most of it the table, and the line
//! `export_dialect!(name, Iso<MyControl>)`. It is a crate beside `post-plugin`, not a part of it: the contract has no
//! opinion on any control, and this may change without it.

mod block_style;
mod cycles;
mod engine;
mod lines;
mod motion;
pub mod options;
mod planes;
mod printer;
mod settings;
mod splines;
mod table;
mod vocabulary;
pub mod words;

use post_plugin::{
    Capabilities, CutRun, Dialect, Event, Format, OptionSpec, Setup, Units, VocabularyWord,
};

pub use engine::Engine;
pub use motion::{ArcWords, FeedDecimals, MotionWriter};
pub use printer::Printer;
pub use splines::SplineWords;
pub use table::{
    CYCLES, CycleAddresses, CycleCode, CycleReturn, Dwell, Leave, Length, MotionCodes, Offset,
    Plane, Rigid, SplineForm, Stops, Subprogram, SurfaceSpeed, Table, Tcp, is_offset_beyond_six,
    offset_beyond_six, offset_of_six,
};

/// Refuses a program in other units than those that the control is said to have by the option `unit_system`, where no word
/// of a program chooses them; `called` is how that option calls mm and inch, `why` says what decides.
///
/// # Errors
/// The sentence for the user.
pub fn check_unit_system(setup: &Setup<'_>, called: [&str; 2], why: &str) -> Result<(), String> {
    let wanted = called[usize::from(setup.units == Units::Inch)];
    match setup.text("unit_system") {
        named if named == wanted => Ok(()),
        "" => Err(format!(
            "{why}: say which unit system it has by the option `unit_system`, \"{}\" for a program in mm, \"{}\" for one in inches",
            called[0], called[1]
        )),
        other => Err(format!(
            "the numbers of this program count in units of {wanted}, and the unit system of the control is {other}: it \
             would read them otherwise; [control] units chooses the program's, `unit_system` says the control's"
        )),
    }
}

/// Refuses words that lie within one turn, where the control would not go the shorter way between them; `why` says what
/// it does.
///
/// # Errors
/// The sentence for the user, about the first axis with such words.
pub fn no_range(setup: &Setup<'_>, why: &str) -> Result<(), String> {
    match setup.words.iter().find(|word| word.wrapped) {
        Some(word) => Err(format!(
            "axis {}: it has a range, but {why}: leave the range out, its words are endless",
            word.name
        )),
        None => Ok(()),
    }
}

/// A control of the family: its table, and what does not fit into one.
pub trait Control: Sized + Send + 'static {
    /// How it differs from the others.
    const TABLE: &'static Table;

    /// The table of one program, where the options choose between several.
    fn table(_setup: &Setup<'_>) -> &'static Table {
        Self::TABLE
    }

    /// Called once a program, with the setup that the engine has found good.
    ///
    /// # Errors
    /// A sentence for the user, if machine or options cannot be served.
    fn open(setup: &Setup<'_>) -> Result<Self, String>;

    /// Lines after the one that puts the control into a safe state.
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

    /// [`Control::write`] leaves every cut to the engine and keeps nothing of it, so that runs of cuts go straight
    /// there.
    const LEAVES_CUTS: bool = false;

    /// What it writes beyond what table and options say.
    fn capabilities(&self) -> Capabilities {
        Capabilities::NONE
    }

    /// How it writes numbers, where that is not what the engine does.
    fn format(&self, engine: Format) -> Format {
        engine
    }

    /// Words of the control and what they mean, where they are others than the table's.
    fn vocabulary(&self, engine: Vec<VocabularyWord>) -> Vec<VocabularyWord> {
        engine
    }
}

/// A dialect of the family.
#[derive(Debug)]
pub struct Iso<C> {
    control: C,
    engine: Engine,
    /// Lines of the user's own that take the place of those of the next event.
    instead: Option<String>,
}

impl<C: Control> Iso<C> {
    #[inline]
    fn write_plain(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let Iso { control, engine, .. } = self;
        engine.resume(event, out)?;
        if control.write(event, engine, out)? {
            return Ok(());
        }
        if let Event::Start = event {
            engine.start(out);
            control.begin(engine, out);
            return Ok(());
        }
        engine.write(event, out)
    }

    /// Cuts one by one, until nothing but words and feeds is left to be written.
    fn write_cuts(&mut self, run: &CutRun<'_>, out: &mut String) -> Result<(), String> {
        let straight = self.engine.motion.axes.takes_cuts(run);
        let mut words = Vec::new();
        for place in 0..run.len() {
            // The first may have to switch on what a stop has switched off.
            if straight && place > 0 && self.engine.carries_on(run) {
                self.engine.motion.carry_on(run, place, out);
                return Ok(());
            }
            self.write(&run.linear(place, &mut words), out)?;
        }
        Ok(())
    }

    /// Lines of the user's own, and the event that they stand for: what it writes is dropped, what it puts in force is
    /// in force. For a retract they stand for the way alone: what the control must cancel is cancelled around them, in
    /// its order; for the end in the place of M30 alone.
    fn write_instead(
        &mut self,
        lines: String,
        event: &Event<'_>,
        out: &mut String,
    ) -> Result<(), String> {
        if let Event::Retract { .. } = event {
            let own = self.engine.retract_by(lines);
            let written = self.write_plain(event, out);
            self.engine.retract_by(own);
            return written;
        }
        if let Event::End = event {
            self.engine.end_by(lines)?;
            return self.write_plain(event, out);
        }
        self.engine.own_lines(&lines, out)?;
        let block = self.engine.motion.block.clone();
        self.write_plain(event, &mut String::new())?;
        self.engine.motion.block = block;
        self.engine.motion.forget();
        Ok(())
    }
}

/// What taps rely on where the spindle is not bound to the feed.
const FLOATING: &str = "taps are for a holder that gives way (tapping = \"floating\"): a rigid one breaks them unless a \
                        parameter binds spindle and feed";

impl<C: Control> Dialect for Iso<C> {
    fn options() -> &'static [OptionSpec] {
        C::TABLE.options
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let engine = Engine::new(C::table(setup), setup)?;
        let control = C::open(setup)?;
        Ok(Iso { control, engine, instead: None })
    }

    fn format(&self) -> Format {
        self.control.format(self.engine.format())
    }

    fn capabilities(&self) -> Capabilities {
        let writes = self.engine.capabilities() | self.control.capabilities();
        match C::LEAVES_CUTS && self.engine.takes_runs() {
            true => writes | Capabilities::CUTS,
            false => writes,
        }
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        self.control.vocabulary(self.engine.vocabulary())
    }

    fn relies_on(&self) -> Vec<String> {
        let floating = self.engine.cycles.floats().then_some(FLOATING);
        let relies = self.engine.table.relies.iter().copied().chain(floating);
        relies.map(str::to_owned).collect()
    }

    #[inline]
    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        if let Event::Cuts { feed, columns } = *event
            && C::LEAVES_CUTS
        {
            let run = CutRun::new(feed, columns, self.engine.motion.words())?;
            return self.write_cuts(&run, out);
        }
        let start = out.len();
        if let Event::Instead { text } = *event {
            self.instead = Some(text.to_owned());
            return Ok(());
        }
        if let Some(lines) = self.instead.take() {
            return self.write_instead(lines, event, out);
        }
        if let Event::Linear { words, .. } | Event::Arc { words, .. } = *event
            && C::TABLE.sign_is_way
            && let Some(axis) = self.engine.motion.axes.turns_round(words)
        {
            return Err(format!(
                "{axis} turns by a whole turn or more in one block, which a word whose sign is its way cannot say"
            ));
        }
        self.write_plain(event, out)?;
        let own = matches!(event, Event::Literal { .. } | Event::Word { .. });
        if !self.engine.style.is_plain() && !own {
            self.engine.style.apply(out, start);
        }
        Ok(())
    }
}
