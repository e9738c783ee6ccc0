//! Short programs, each written by a dialect that was opened for it alone.

use post_plugin::{Batch, Capabilities, DialectSession, Event, Format, Spindle, SpindleSense};

use post_host::{Plugin, PluginFault, ProgramSetup};

/// The spindle as every program of the kit has it.
pub(super) const TURNING: Event<'static> =
    Event::Spindle(Spindle::On { rpm: 3000.0, sense: SpindleSense::Clockwise });

/// The depth axis to its end.
pub(super) const RETRACT: Event<'static> =
    Event::Retract { axes: 0b100, words: &[0.0, 0.0, 500.0, 0.0, 0.0] };

/// Whatever writes the programs of the kit.
pub(super) struct Pen<'a> {
    pub plugin: &'a Plugin,
    pub setup: &'a ProgramSetup,
    /// Names of the events that it refuses: programs do without them.
    pub left_out: &'a [&'static str],
}

/// A program under construction.
pub(super) struct Program<'a> {
    left_out: &'a [&'static str],
    batch: Batch,
    looked_at: Option<usize>,
}

/// A program's text, and that of the event that is looked at; or why an event was refused.
pub(super) type Text = Result<(String, String), String>;

impl Pen<'_> {
    /// The text of the program that `fill` makes.
    pub fn write(&self, fill: &dyn Fn(&mut Program<'_>)) -> Result<Text, PluginFault> {
        let mut program =
            Program { left_out: self.left_out, batch: Batch::default(), looked_at: None };
        fill(&mut program);
        let mut session = self.plugin.dialect(self.setup)?;
        let (mut out, mut ends) = (String::new(), Vec::new());
        if let Err(fault) = session.write_batch(&program.batch, &mut out, &mut ends) {
            return Ok(Err(fault.message));
        }
        let end = |index: usize| ends.get(index).copied().unwrap_or(0);
        let own = program.looked_at.map_or("", |at| {
            let from = at.checked_sub(1).map_or(0, end);
            out.get(from..end(at)).unwrap_or("")
        });
        let own = own.to_owned();
        Ok(Ok((out, own)))
    }

    pub fn format(&self) -> Result<Format, PluginFault> {
        Ok(self.plugin.dialect(self.setup)?.format().clone())
    }

    pub fn capabilities(&self) -> Result<Capabilities, PluginFault> {
        Ok(self.plugin.dialect(self.setup)?.capabilities())
    }
}

impl Program<'_> {
    pub fn push(&mut self, event: Event<'_>) {
        if !self.left_out.contains(&event.name()) {
            self.batch.push(self.batch.len() as u64 + 1, event);
        }
    }

    /// Pushes the event of which the text is wanted.
    pub fn look_at(&mut self, event: Event<'_>) {
        self.looked_at = Some(self.batch.len());
        self.push(event);
    }

    /// The start, a tool and all that turns.
    pub fn begin(&mut self) {
        self.push(Event::Start);
        self.push(RETRACT);
        self.push(Event::tool_change(1, 1, "ball 6"));
        self.push(TURNING);
    }

    pub fn end(&mut self) {
        self.push(RETRACT);
        self.push(Event::Spindle(Spindle::Off));
        self.push(Event::End);
    }
}
