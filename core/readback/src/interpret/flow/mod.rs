//! The order in which blocks are run: jumps, loops, parts that are repeated, subprograms of the same file.
//!
//! Blocks are read where they stand and nothing of them is kept, so that memory does not grow with the program: a jump
//! looks for its place in the file and goes on there. Every block that is read is counted, and every line that is
//! looked through: a loop that never ends is refused when the count is passed.

mod loops;

use std::borrow::Cow;
use std::io::{Read, Seek};

use post_grammar::ReadError;
use post_grammar::nc::{
    JumpDirection, NcBlock, NcExpression, NcFlow, NcItem, NcMark, NcReader, NcRun, NcRunRule,
    NcTarget,
};
use post_machine::diagnostic::{Diagnostic, SourcePlace, unreadable};
use post_plugin::Language;

use super::astray::{FlowResult, elsewhere, fault, no_target};
use super::calls::{self, BlockTransfer};
use super::expression::whole;
use super::variables::{VariableValue, Variables};
use super::{Limits, assigned};

/// Lines looked through for a label that take the time of one block that is run.
const SEARCHED: u64 = 64;

/// What is running.
#[derive(Clone, Debug)]
enum OpenConstruct {
    /// A subprogram.
    Call {
        /// First block of the subprogram.
        start: NcMark,
        /// Block after the call.
        back: NcMark,
        /// Times that it runs again.
        left: i64,
        /// Whether it has variables of its own.
        own: bool,
    },
    /// A part between a label and here, or another label.
    Part {
        start: NcMark,
        /// The block that repeats it.
        by: NcMark,
        /// The block after that one.
        back: NcMark,
        /// The label with which it ends.
        until: Option<String>,
        left: i64,
    },
    /// `WHILE`: its head is read again each time.
    While { name: Option<String>, head: NcMark },
    /// `FOR`.
    For { head: NcMark, body: NcMark, variable: String, to: f64 },
    /// `LOOP`.
    Loop { head: NcMark, body: NcMark },
    /// `REPEAT` or `do`.
    Do { name: Option<String>, head: NcMark, body: NcMark },
    /// `o1 repeat [n]`.
    Times { name: Option<String>, head: NcMark, body: NcMark, left: i64 },
}

/// Blocks in the order in which they are run.
#[derive(Debug)]
pub(super) struct ProgramFlow<R> {
    reader: NcReader<R>,
    /// The file, as messages call it.
    file: String,
    language: Language,
    limits: Limits,
    /// Blocks read again so far, lines looked through among them.
    again: u64,
    /// Line of the block that stands furthest down of those that were read.
    furthest: u64,
    /// Too many were read, and that was said.
    over: bool,
    /// Where the block stands that was handed out last.
    here: NcMark,
    running: Vec<OpenConstruct>,
    /// Branches whose end is still to come.
    branches: u32,
    /// Something led to where no end of a branch need have its beginning.
    jumped: bool,
    /// Line up to which each loop and branch that begins was seen to end.
    closed: u64,
    /// A block was handed out.
    begun: bool,
    /// What the block that was handed out last leads to, once it is run.
    pending: Option<BlockTransfer>,
    /// What that block sets, once it is run.
    set: Vec<(String, VariableValue)>,
    /// Room for a block that is looked through.
    passed: NcBlock,
}

impl<R: Read + Seek> ProgramFlow<R> {
    /// A flow from the first block on.
    pub fn new(reader: NcReader<R>, language: Language, limits: Limits, file: &str) -> Self {
        let here = reader.mark();
        Self {
            reader,
            file: file.to_owned(),
            language,
            limits,
            again: 0,
            furthest: 0,
            over: false,
            here,
            running: Vec::new(),
            branches: 0,
            jumped: false,
            closed: 0,
            begun: false,
            pending: None,
            set: Vec::new(),
            passed: NcBlock::default(),
        }
    }

    /// Where the blocks come from.
    pub fn reader(&self) -> &NcReader<R> {
        &self.reader
    }

    /// Shows the text of the line that a finding about the block in hand speaks of.
    #[cold]
    pub fn show(&self, mut finding: Box<Diagnostic>) -> Box<Diagnostic> {
        if let Some(place) = &mut finding.place
            && place.text.is_empty()
            && let Some(text) = self.text(place.line)
        {
            let from = text.len() - text.trim_start().len();
            *place = SourcePlace::new(&self.file, place.line, &text, from..text.trim_end().len());
        }
        finding
    }

    /// The text of a line of the block in hand; none if it is no longer at hand.
    pub fn text(&self, line: u64) -> Option<Cow<'_, str>> {
        self.reader.text(self.here, line)
    }

    /// The next block that is run, without what leads elsewhere; false at the end.
    ///
    /// # Errors
    /// It cannot be read, leads nowhere or elsewhere than this file, or too many were run.
    #[inline]
    pub fn next(&mut self, variables: &mut Variables, block: &mut NcBlock) -> FlowResult<bool> {
        for (name, value) in self.set.drain(..) {
            variables.set(&name, value)?;
        }
        if let Some(pending) = self.pending.take() {
            self.lead(pending, block.line, variables)?;
        }
        loop {
            self.here = self.reader.mark();
            if !self.take(block)? || is_tape_end(block) {
                return self.ended();
            }
            if !calls::leads(block, self.language, variables) || self.follow(block, variables)? {
                self.begun |= !block.items.is_empty();
                return Ok(true);
            }
        }
    }

    /// Takes plain blocks that follow one another and that are read for the first time, none of which leads elsewhere.
    pub fn next_run(&mut self, rule: &NcRunRule, run: &mut NcRun) {
        let waits = self.pending.is_some() || !self.set.is_empty() || self.over;
        match waits || self.reader.mark().line() <= self.furthest {
            true => run.clear(),
            false => self.reader.next_run(rule, run),
        }
    }

    /// Goes back to the block behind the first `count` of a run that was just taken.
    pub fn shorten(&mut self, run: &mut NcRun, count: usize) {
        self.reader.shorten(run, count);
        if let Some(last) = count.checked_sub(1) {
            self.furthest = run.line(last);
        }
    }

    /// Reads a block, and counts it if it was read before.
    #[inline]
    fn take(&mut self, block: &mut NcBlock) -> FlowResult<bool> {
        let read = self.reader.next_block(block);
        // What is read for the first time comes to an end with the file.
        if block.line > self.furthest {
            self.furthest = block.line;
        } else {
            self.again += 1;
        }
        if self.again > self.limits.blocks {
            return self.too_many();
        }
        read.map_err(|error| self.failed(error))
    }

    /// The count is passed: said once, and then the program is at its end.
    #[cold]
    fn too_many(&mut self) -> FlowResult<bool> {
        self.running.clear();
        if std::mem::replace(&mut self.over, true) {
            return Ok(false);
        }
        let count = self.limits.blocks;
        let message = format!(
            "{count} blocks were read once more, and the program has not come to its end: a loop may never end"
        );
        Err(Diagnostic::error("nc-limit", message)
            .help("a higher count is set by --most-blocks")
            .boxed())
    }

    fn go_to(&mut self, mark: NcMark) -> FlowResult<()> {
        let gone = self.reader.go_to(mark);
        gone.map_err(|error| self.failed(error))
    }

    /// The reader's error in the words of the interpreter.
    #[cold]
    fn failed(&self, error: ReadError) -> Box<Diagnostic> {
        match error {
            ReadError::Syntax(fault) => unreadable(&self.file, &fault).boxed(),
            ReadError::Io(error) => {
                Diagnostic::error("nc-file", format!("{} cannot be read: {error}", self.file))
                    .boxed()
            }
        }
    }

    fn ended(&mut self) -> FlowResult<bool> {
        let inside =
            self.running.iter().any(|running| matches!(running, OpenConstruct::Call { .. }));
        self.running.clear();
        match inside {
            true => Err(fault("the program ends inside a subprogram: nothing leads back from it")),
            false => Ok(false),
        }
    }

    /// Takes what leads elsewhere out of a block and follows it; true if something is left to run.
    fn follow(&mut self, block: &mut NcBlock, variables: &mut Variables) -> FlowResult<bool> {
        self.pending = calls::take(block, self.language, variables)?;
        let mut flows = Vec::new();
        let mut set = Vec::new();
        assigned::take(block, self.language, variables, &mut set)?;
        block.items.retain(|item| match item {
            NcItem::Flow(flow) => {
                flows.push((**flow).clone());
                false
            }
            _ => true,
        });
        // `IF [..] THEN` with nothing behind it holds up to its `ENDIF`.
        if let [NcFlow::Then(condition)] = flows.as_slice()
            && block.items.is_empty()
            && set.is_empty()
            && self.pending.is_none()
        {
            flows = vec![NcFlow::If { name: None, condition: condition.clone() }];
        }
        // A condition in front of them decides whether they are set.
        let (conditions, flows): (Vec<_>, Vec<_>) =
            flows.into_iter().partition(|flow| matches!(flow, NcFlow::Then(_)));
        for condition in conditions {
            if !self.step(condition, variables)? {
                block.items.clear();
                self.pending = None;
                return Ok(false);
            }
        }
        // With `#` the words of a block are read before what it sets.
        if matches!(self.language, Language::Macro | Language::Rs274) && !block.items.is_empty() {
            self.set = set;
        } else {
            for (name, value) in set {
                variables.set(&name, value)?;
            }
        }
        for flow in flows {
            if !self.step(flow, variables)? {
                block.items.clear();
                self.pending = None;
                return Ok(false);
            }
        }
        if block.items.is_empty() && block.remarks.is_empty() {
            if let Some(pending) = self.pending.take() {
                self.lead(pending, block.line, variables)?;
            }
            return Ok(false);
        }
        Ok(true)
    }

    /// One word of flow; false if the rest of its block is not run.
    fn step(&mut self, flow: NcFlow, variables: &mut Variables) -> FlowResult<bool> {
        match flow {
            NcFlow::Label(name) => self.label(&name),
            NcFlow::LabelEnd => {
                // Without a call a label's end is passed.
                if self.called() {
                    self.back(variables)?;
                }
                Ok(false)
            }
            NcFlow::Goto { target, direction, condition } => {
                if let Some(condition) = condition
                    && !variables.holds(&condition)?
                {
                    return Ok(true);
                }
                let wanted = wanted(&target, variables)?;
                self.jump(&wanted, direction)?;
                Ok(false)
            }
            NcFlow::Then(condition) => variables.holds(&condition),
            NcFlow::If { name, condition } => {
                let begins = match variables.holds(&condition)? {
                    true => {
                        self.ends_later(name.as_deref(), None)?;
                        true
                    }
                    false => self.otherwise(name.as_deref(), variables)?,
                };
                self.branches += u32::from(begins);
                Ok(true)
            }
            NcFlow::ElseIf { name, .. } | NcFlow::Else(name) => {
                self.skip_branch(name.as_deref())?;
                self.branches = self.branches.saturating_sub(1);
                Ok(false)
            }
            NcFlow::EndIf(_) => match self.branches.checked_sub(1) {
                None if !self.jumped => Err(fault("a branch ends here, and none has begun")),
                left => {
                    self.branches = left.unwrap_or(0);
                    Ok(true)
                }
            },
            NcFlow::SubBegin(name) => {
                if self.language == Language::Rs274 {
                    self.skip(
                        Some(&name),
                        |_| false,
                        |flow| matches!(flow, NcFlow::SubEnd(_)),
                        |flow| matches!(flow, NcFlow::SubEnd(_)),
                    )?;
                    return Ok(false);
                }
                Ok(true)
            }
            NcFlow::SubEnd(_) | NcFlow::Return(_) => {
                if !self.called() {
                    return Err(fault("a subprogram ends here, and none was called"));
                }
                self.back(variables)?;
                Ok(false)
            }
            NcFlow::Call { target, repeat, arguments } => {
                self.call(&target, repeat.as_ref(), &arguments, variables)?;
                Ok(false)
            }
            NcFlow::CallProgram(name) => Err(elsewhere(&name)),
            NcFlow::RepeatFrom { label, until, times } => {
                let times = match times {
                    Some(times) => whole(variables.number(&times)?, "a count of repeats")?,
                    None => 1,
                };
                self.part(label, until, times)?;
                Ok(false)
            }
            looping => self.looped(looping, variables),
        }
    }

    /// A label is passed.
    fn label(&mut self, name: &str) -> FlowResult<bool> {
        if let Some(OpenConstruct::Part { until: Some(until), .. }) = self.running.last()
            && until == name
        {
            self.pending = Some(BlockTransfer::PartEnd);
        }
        // `O2000`: a program of its own, which something calls, or the one in front of it has no end.
        let names_program = self.language == Language::Macro
            && name.strip_prefix('O').is_some_and(|number| number.parse::<u64>().is_ok());
        if names_program && self.begun && !self.called() {
            return Err(fault(&format!(
                "{name} begins another program here, and the one in front of it has no end"
            )));
        }
        Ok(true)
    }

    /// Where a block's words lead once it is run.
    fn lead(
        &mut self,
        pending: BlockTransfer,
        line: u64,
        variables: &mut Variables,
    ) -> FlowResult<()> {
        match pending {
            BlockTransfer::Subprogram { number, times, own } => {
                let wanted = NcTarget::Program(format!("O{number}"));
                let start = self.find(&wanted, JumpDirection::Anywhere)?;
                let start = start.ok_or_else(|| elsewhere(&format!("O{number}")))?;
                self.enter(start, times, own, variables)
            }
            BlockTransfer::Local { number, times } => {
                let start = self.find(&NcTarget::Number(number), JumpDirection::Anywhere)?;
                let start = start.ok_or_else(|| no_target(&format!("N{number}")))?;
                self.enter(start, times, None, variables)
            }
            BlockTransfer::Return { to } => {
                if !self.called() {
                    return Err(fault(&format!(
                        "line {line} begins the program again, without end: no subprogram is running"
                    )));
                }
                if to.is_some() {
                    // No further run of it.
                    for running in self.running.iter_mut().rev() {
                        if let OpenConstruct::Call { left, .. } = running {
                            *left = 0;
                            break;
                        }
                    }
                }
                self.back(variables)?;
                match to {
                    Some(number) => self.jump(&NcTarget::Number(number), JumpDirection::Anywhere),
                    None => Ok(()),
                }
            }
            BlockTransfer::PartEnd => self.part_ends(),
        }
    }

    fn call(
        &mut self,
        target: &str,
        repeat: Option<&NcExpression>,
        arguments: &[NcExpression],
        variables: &mut Variables,
    ) -> FlowResult<()> {
        if let Some(repeat) = repeat {
            let times = whole(variables.number(repeat)?, "a count of repeats")?;
            return self.part(target.to_owned(), None, times);
        }
        let wanted = match self.language {
            Language::Rs274 => NcTarget::Subprogram(target.to_owned()),
            Language::Macro => NcTarget::Program(target.to_owned()),
            Language::Names
            | Language::Conversational
            | Language::Instructions
            | Language::Joints => NcTarget::Label(target.to_owned()),
        };
        let start = self.find(&wanted, JumpDirection::Anywhere)?;
        let Some(start) = start else {
            return Err(match self.language {
                Language::Conversational => no_target(&format!("LBL {target}")),
                _ => elsewhere(target),
            });
        };
        let mut own = Vec::with_capacity(30);
        if self.language == Language::Rs274 {
            // Those that are not given are zero.
            own.extend((1..=30).map(|number| (format!("#{number}"), 0.0)));
            for (slot, argument) in own.iter_mut().zip(arguments) {
                slot.1 = variables.number(argument)?;
            }
        }
        let own = (self.language == Language::Rs274).then_some(own);
        self.enter(start, 1, own, variables)
    }

    /// Goes into a subprogram.
    fn enter(
        &mut self,
        start: NcMark,
        times: i64,
        own: Option<Vec<(String, f64)>>,
        variables: &mut Variables,
    ) -> FlowResult<()> {
        if times < 1 {
            return Ok(());
        }
        let back = self.reader.mark();
        let has_own = own.is_some();
        self.push(OpenConstruct::Call { start, back, left: times - 1, own: has_own })?;
        if let Some(own) = own {
            variables.enter(own);
        }
        self.begin(start)
    }

    /// Reads on at the start of a subprogram; of an `o1 sub` after it.
    fn begin(&mut self, start: NcMark) -> FlowResult<()> {
        self.go_to(start)?;
        if self.language == Language::Rs274 {
            let mut head = std::mem::take(&mut self.passed);
            let read = self.take(&mut head);
            self.passed = head;
            read?;
        }
        Ok(())
    }

    fn called(&self) -> bool {
        self.running.iter().any(|running| matches!(running, OpenConstruct::Call { .. }))
    }

    /// The innermost subprogram ends.
    fn back(&mut self, variables: &mut Variables) -> FlowResult<()> {
        while let Some(running) = self.running.pop() {
            let OpenConstruct::Call { start, back, left, own } = running else {
                continue;
            };
            if left > 0 {
                self.running.push(OpenConstruct::Call { start, back, left: left - 1, own });
                return self.begin(start);
            }
            if own {
                variables.leave();
            }
            return self.go_to(back);
        }
        Ok(())
    }

    /// The part from a label to this block, or to another label, `times` more.
    fn part(&mut self, label: String, until: Option<String>, times: i64) -> FlowResult<()> {
        let here = self.here;
        let runs = self.unwind(|running| match running {
            OpenConstruct::Part { by, .. } if *by == here => Some(()),
            _ => None,
        });
        if runs.is_some() {
            return self.part_ends();
        }
        if times < 1 {
            return Ok(());
        }
        self.jumped = true;
        let back = self.reader.mark();
        let start = self.find(&NcTarget::Label(label.clone()), JumpDirection::Anywhere)?;
        let start = start.ok_or_else(|| no_target(&label))?;
        self.push(OpenConstruct::Part { start, by: here, back, until, left: times - 1 })?;
        self.go_to(start)
    }

    /// The innermost part was run once.
    fn part_ends(&mut self) -> FlowResult<()> {
        let Some(OpenConstruct::Part { start, back, left, .. }) = self.running.last_mut() else {
            return Ok(());
        };
        if *left > 0 {
            *left -= 1;
            let start = *start;
            return self.go_to(start);
        }
        let back = *back;
        self.running.pop();
        self.go_to(back)
    }

    fn jump(&mut self, wanted: &NcTarget, direction: JumpDirection) -> FlowResult<()> {
        let found = self.find(wanted, direction)?;
        self.jumped = true;
        let found = found.ok_or_else(|| match wanted {
            NcTarget::Label(name) | NcTarget::Subprogram(name) | NcTarget::Program(name) => {
                no_target(name)
            }
            NcTarget::Number(number) => no_target(&format!("N{number}")),
        })?;
        self.go_to(found)
    }

    /// Where something stands. Afterwards the next block is the same as before.
    fn find(&mut self, target: &NcTarget, direction: JumpDirection) -> FlowResult<Option<NcMark>> {
        let before = self.reader.lines_searched();
        let found = self.reader.find(target, direction);
        let searched = self.reader.lines_searched() - before;
        self.again = self.again.saturating_add(searched / SEARCHED);
        found.map_err(|error| self.failed(error))
    }
}

/// `%` between two programs: the one that runs ends there.
#[inline]
fn is_tape_end(block: &NcBlock) -> bool {
    matches!(block.items.as_slice(), [NcItem::Name(name)] if name == "%")
}

/// What a jump's target means: a label by name, or the number of a block.
fn wanted(target: &NcExpression, variables: &Variables) -> FlowResult<NcTarget> {
    match target {
        NcExpression::Text(name) => Ok(match calls::block_number(name) {
            Some(number) => NcTarget::Number(number),
            None => NcTarget::Label(name.clone()),
        }),
        other => {
            let number = whole(variables.number(other)?, "the number of a block")?;
            let number = u64::try_from(number);
            number.map(NcTarget::Number).map_err(|_| fault("the number of a block is negative"))
        }
    }
}

#[cfg(test)]
mod tests;
