//! Loops and branches: what begins one, what ends it, and how one that does not hold is passed over.

use std::io::{Read, Seek};

use post_grammar::nc::{NcExpression, NcFlow, NcItem, NcMark};
use post_machine::diagnostic::Diagnostic;

use super::super::astray::{FlowResult, fault};
use super::super::expression::whole;
use super::super::variables::{VariableValue, Variables};
use super::{OpenConstruct, ProgramFlow};

impl<R: Read + Seek> ProgramFlow<R> {
    pub(super) fn looped(&mut self, flow: NcFlow, variables: &mut Variables) -> FlowResult<bool> {
        let head = self.here;
        match flow {
            NcFlow::While { name, condition } => {
                // The end of a `do`.
                if let Some(body) = self.close_do(name.as_deref()) {
                    if variables.holds(&condition)? {
                        self.go_to(body)?;
                    } else {
                        self.running.pop();
                    }
                    return Ok(false);
                }
                self.forget(head);
                if variables.holds(&condition)? {
                    self.ends_later(name.as_deref(), Some(LoopKind::While))?;
                    self.push(OpenConstruct::While { name, head })?;
                } else {
                    self.skip_loop(name.as_deref(), LoopKind::While)?;
                }
            }
            NcFlow::For { variable, from, to } => {
                self.forget(head);
                let name = variables.named(&variable)?;
                let (from, to) = (variables.number(&from)?, variables.number(&to)?);
                variables.set(&name, VariableValue::Number(from))?;
                if from > to {
                    self.skip_loop(None, LoopKind::For)?;
                } else {
                    self.ends_later(None, Some(LoopKind::For))?;
                    let body = self.reader.mark();
                    self.push(OpenConstruct::For { head, body, variable: name, to })?;
                }
            }
            NcFlow::Loop => {
                self.forget(head);
                self.ends_later(None, Some(LoopKind::Loop))?;
                let body = self.reader.mark();
                self.push(OpenConstruct::Loop { head, body })?;
            }
            NcFlow::Do(name) => {
                self.forget(head);
                self.ends_later(name.as_deref(), Some(LoopKind::Do))?;
                let body = self.reader.mark();
                self.push(OpenConstruct::Do { name, head, body })?;
            }
            NcFlow::Repeat { name, times } => {
                self.forget(head);
                let left = whole(variables.number(&times)?, "a count of repeats")?;
                if left > 0 {
                    self.ends_later(name.as_deref(), Some(LoopKind::Times))?;
                    let body = self.reader.mark();
                    self.push(OpenConstruct::Times { name, head, body, left })?;
                } else {
                    self.skip_loop(name.as_deref(), LoopKind::Times)?;
                }
            }
            other => self.end_loop(other, variables)?,
        }
        Ok(false)
    }

    /// Runs what ends a loop, breaks out of it or goes on with its next turn.
    fn end_loop(&mut self, flow: NcFlow, variables: &mut Variables) -> FlowResult<()> {
        match flow {
            NcFlow::EndWhile(name) => {
                let head = self.unwind(|running| match running {
                    OpenConstruct::While { name: own, head } if *own == name => Some(*head),
                    _ => None,
                });
                let head = head.ok_or_else(|| fault("a loop ends here that has not begun"))?;
                self.running.pop();
                self.go_to(head)?;
            }
            NcFlow::EndFor => {
                let found = self.unwind(|running| match running {
                    OpenConstruct::For { body, variable, to, .. } => {
                        Some((*body, variable.clone(), *to))
                    }
                    _ => None,
                });
                let (body, name, to) =
                    found.ok_or_else(|| fault("a loop ends here that has not begun"))?;
                let next = variables.number(&NcExpression::Variable(name.clone()))? + 1.0;
                if next > to {
                    self.running.pop();
                } else {
                    variables.set(&name, VariableValue::Number(next))?;
                    self.go_to(body)?;
                }
            }
            NcFlow::EndLoop => {
                let body = self.unwind(|running| match running {
                    OpenConstruct::Loop { body, .. } => Some(*body),
                    _ => None,
                });
                self.go_to(body.ok_or_else(|| fault("a loop ends here that has not begun"))?)?;
            }
            NcFlow::Until(condition) => {
                let body = self.close_do(None);
                let body = body.ok_or_else(|| fault("a loop ends here that has not begun"))?;
                if variables.holds(&condition)? {
                    self.running.pop();
                } else {
                    self.go_to(body)?;
                }
            }
            NcFlow::EndRepeat(name) => self.again(name.as_deref())?,
            NcFlow::Break(name) => {
                let kind = self.innermost(name.as_deref())?;
                self.running.pop();
                self.skip_loop(name.as_deref(), kind)?;
            }
            NcFlow::Continue(name) => match self.innermost(name.as_deref())? {
                LoopKind::Times => self.again(name.as_deref())?,
                LoopKind::While => {
                    if let Some(OpenConstruct::While { head, .. }) = self.running.pop() {
                        self.go_to(head)?;
                    }
                }
                _ => return Err(fault("`continue` of this loop is not run")),
            },
            _ => {}
        }
        Ok(())
    }

    /// `o1 endrepeat`.
    pub(super) fn again(&mut self, name: Option<&str>) -> FlowResult<()> {
        let body = self.unwind(|running| match running {
            OpenConstruct::Times { name: own, body, .. } if own.as_deref() == name => Some(*body),
            _ => None,
        });
        let body = body.ok_or_else(|| fault("a loop ends here that has not begun"))?;
        if let Some(OpenConstruct::Times { left, .. }) = self.running.last_mut() {
            *left -= 1;
            if *left > 0 {
                return self.go_to(body);
            }
        }
        self.running.pop();
        Ok(())
    }

    /// The kind of the innermost loop of this name, which is innermost of all afterwards.
    pub(super) fn innermost(&mut self, name: Option<&str>) -> FlowResult<LoopKind> {
        let kind = self.unwind(|running| match running {
            OpenConstruct::While { name: own, .. } if own.as_deref() == name => {
                Some(LoopKind::While)
            }
            OpenConstruct::Do { name: own, .. } if own.as_deref() == name => Some(LoopKind::Do),
            OpenConstruct::Times { name: own, .. } if own.as_deref() == name => {
                Some(LoopKind::Times)
            }
            OpenConstruct::For { .. } if name.is_none() => Some(LoopKind::For),
            OpenConstruct::Loop { .. } if name.is_none() => Some(LoopKind::Loop),
            _ => None,
        });
        kind.ok_or_else(|| fault("no such loop is running here"))
    }

    /// Drops what runs inside of the innermost one that `wanted` knows, up to the subprogram.
    pub(super) fn unwind<T>(&mut self, wanted: impl Fn(&OpenConstruct) -> Option<T>) -> Option<T> {
        for place in (0..self.running.len()).rev() {
            if matches!(self.running[place], OpenConstruct::Call { .. }) {
                return None;
            }
            if let Some(found) = wanted(&self.running[place]) {
                self.running.truncate(place + 1);
                return Some(found);
            }
        }
        None
    }

    fn close_do(&mut self, name: Option<&str>) -> Option<NcMark> {
        self.unwind(|running| match running {
            OpenConstruct::Do { name: own, body, .. } if own.as_deref() == name => Some(*body),
            _ => None,
        })
    }

    /// A loop that was left by a jump begins anew.
    fn forget(&mut self, begins: NcMark) {
        let known = self.unwind(|running| match running {
            OpenConstruct::While { head, .. }
            | OpenConstruct::For { head, .. }
            | OpenConstruct::Loop { head, .. }
            | OpenConstruct::Do { head, .. }
            | OpenConstruct::Times { head, .. }
                if *head == begins =>
            {
                Some(())
            }
            _ => None,
        });
        if known.is_some() {
            self.running.pop();
        }
    }

    pub(super) fn push(&mut self, running: OpenConstruct) -> FlowResult<()> {
        if self.running.len() >= self.limits.depth {
            return Err(Diagnostic::error(
                "nc-limit",
                format!(
                    "subprograms and loops stand inside one another more than {} deep",
                    self.limits.depth
                ),
            )
            .boxed());
        }
        self.running.push(running);
        Ok(())
    }

    /// What begins in the block in hand, a loop of that kind or a branch, ends further down: a control that meets the end
    /// of the program within it stops there. Looked for once, and read again afterwards.
    pub(super) fn ends_later(
        &mut self,
        name: Option<&str>,
        kind: Option<LoopKind>,
    ) -> FlowResult<()> {
        let line = self.here.line();
        if line <= self.closed {
            return Ok(());
        }
        self.closed = line;
        let body = self.reader.mark();
        match kind {
            Some(kind) => self.skip_loop(name, kind)?,
            None => self.skip_branch(name)?,
        }
        self.go_to(body)
    }

    /// A condition does not hold: on to what does, or after the end; true where a branch begins.
    pub(super) fn otherwise(
        &mut self,
        name: Option<&str>,
        variables: &Variables,
    ) -> FlowResult<bool> {
        loop {
            let flow = self.skip(
                name,
                |flow| matches!(flow, NcFlow::If { .. }),
                |flow| matches!(flow, NcFlow::ElseIf { .. } | NcFlow::Else(_) | NcFlow::EndIf(_)),
                |flow| matches!(flow, NcFlow::EndIf(_)),
            )?;
            match flow {
                NcFlow::ElseIf { condition, .. } if !variables.holds(&condition)? => {}
                flow => return Ok(!matches!(flow, NcFlow::EndIf(_))),
            }
        }
    }

    /// On to what stands behind the end of a branch.
    pub(super) fn skip_branch(&mut self, name: Option<&str>) -> FlowResult<()> {
        let ends: LoopTest = |flow| matches!(flow, NcFlow::EndIf(_));
        self.skip(name, |flow| matches!(flow, NcFlow::If { .. }), ends, ends).map(|_| ())
    }

    fn skip_loop(&mut self, name: Option<&str>, kind: LoopKind) -> FlowResult<()> {
        let (opens, closes): (LoopTest, LoopTest) = match kind {
            LoopKind::While => (
                |flow| matches!(flow, NcFlow::While { .. }),
                |flow| matches!(flow, NcFlow::EndWhile(_)),
            ),
            LoopKind::For => {
                (|flow| matches!(flow, NcFlow::For { .. }), |flow| matches!(flow, NcFlow::EndFor))
            }
            LoopKind::Loop => {
                (|flow| matches!(flow, NcFlow::Loop), |flow| matches!(flow, NcFlow::EndLoop))
            }
            LoopKind::Do => (
                |flow| matches!(flow, NcFlow::Do(_)),
                |flow| matches!(flow, NcFlow::Until(_) | NcFlow::While { .. }),
            ),
            LoopKind::Times => (
                |flow| matches!(flow, NcFlow::Repeat { .. }),
                |flow| matches!(flow, NcFlow::EndRepeat(_)),
            ),
        };
        self.skip(name, opens, closes, closes).map(|_| ())
    }

    /// Reads on, running nothing, up to the word that closes what begins here: the next of this name, or without names
    /// the next that is not inside another that opens and ends on the way.
    pub(super) fn skip(
        &mut self,
        name: Option<&str>,
        opens: fn(&NcFlow) -> bool,
        closes: fn(&NcFlow) -> bool,
        ends: fn(&NcFlow) -> bool,
    ) -> FlowResult<NcFlow> {
        let mut block = std::mem::take(&mut self.passed);
        let mut inside = 0_u32;
        let found = loop {
            match self.take(&mut block) {
                Ok(true) => {}
                Ok(false) => break None,
                Err(fault) if fault.code == "nc-limit" => return Err(fault),
                Err(_) => continue,
            }
            let mut here = None;
            for item in &block.items {
                let NcItem::Flow(flow) = item else {
                    continue;
                };
                let named = name.is_some();
                if named && closes(flow) && named_as(flow) == name {
                    here = Some((**flow).clone());
                } else if !named && opens(flow) {
                    inside += 1;
                } else if !named && inside == 0 && closes(flow) {
                    here = Some((**flow).clone());
                } else if !named && ends(flow) {
                    inside = inside.saturating_sub(1);
                }
            }
            if here.is_some() {
                break here;
            }
        };
        self.passed = block;
        found.ok_or_else(|| fault("what begins here does not end in this file"))
    }
}

/// Whether a word of flow is one of those that are looked for.
type LoopTest = fn(&NcFlow) -> bool;

/// Kinds of loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LoopKind {
    While,
    For,
    Loop,
    Do,
    Times,
}

/// The name that ties the words of a loop or a branch together.
fn named_as(flow: &NcFlow) -> Option<&str> {
    match flow {
        NcFlow::If { name, .. }
        | NcFlow::ElseIf { name, .. }
        | NcFlow::Else(name)
        | NcFlow::EndIf(name)
        | NcFlow::While { name, .. }
        | NcFlow::EndWhile(name)
        | NcFlow::Do(name)
        | NcFlow::Repeat { name, .. }
        | NcFlow::EndRepeat(name)
        | NcFlow::SubEnd(name) => name.as_deref(),
        NcFlow::SubBegin(name) => Some(name),
        _ => None,
    }
}
