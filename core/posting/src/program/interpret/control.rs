//! What the control does by itself: work offsets, subprograms, constant cutting speeds, smoothing.

use post_grammar::{Argument, Record, SpindleUnit, SyncMark};
use post_machine::description::Smoothing;
use post_machine::diagnostic::Short;
use post_machine::wait_rule::{WaitLack, WaitRule};

use super::{ClInterpreter, StepSink};
use crate::program::{Command, ProgramStep, SyncWait};

/// Numbers that a file gives a work offset which may be meant as G codes: the first offset is G54.
const CODES: std::ops::RangeInclusive<u32> = 54..=59;

impl ClInterpreter {
    /// A work offset by its number.
    pub(super) fn work_offset(
        &mut self,
        record: &Record<'_>,
        number: u32,
        set: bool,
        emit: &mut StepSink<'_>,
    ) {
        let word = record.statement.word();
        let value = Argument::Number(number.into());
        let arguments = match set {
            true => vec![Argument::Word("OFSETL".to_owned()), value],
            false => vec![value],
        };
        if self.by_rule(record, word, &arguments, emit) || self.left_out(word, record) {
            return;
        }
        if number == 0 || CODES.contains(&number) {
            let why = match number {
                0 => "offsets are counted from 1".to_owned(),
                code => format!("it may be G{code} or the {code}th offset"),
            };
            self.fault(
                record,
                "work-offset",
                format!("{word} asks for work offset {number}: {why}"),
                "1 is G54, 2 is G55; what the CAM system means by its numbers says [cl.words] in the machine file, such as \"SET/OFSETL\" = \"G{n}\"",
            );
            return;
        }
        // CAM systems repeat it in every operation.
        if self.offset.replace(number) != Some(number) {
            self.tip = None;
            emit(ProgramStep::Command(Command::WorkOffset(number)));
        }
    }

    /// A subprogram of the control by its number.
    pub(super) fn subprogram(&mut self, record: &Record<'_>, number: u32, emit: &mut StepSink<'_>) {
        let word = record.statement.word();
        let arguments = [Argument::Number(number.into())];
        if self.by_rule(record, word, &arguments, emit) || self.left_out(word, record) {
            return;
        }
        self.load_told(record, emit);
        self.tip = None;
        emit(ProgramStep::Command(Command::Subprogram(number)));
    }

    /// A mark at which channels wait for one another.
    pub(super) fn sync(&mut self, record: &Record<'_>, mark: &SyncMark, emit: &mut StepSink<'_>) {
        if self.left_out("SYNC", record) {
            return;
        }
        let inside = [
            (self.pending.is_some(), "a curve"),
            (self.cycles.in_force.is_some(), "a cycle"),
            (self.compensation.on, "cutter compensation"),
        ];
        if let Some((_, what)) = inside.into_iter().find(|(on, _)| *on) {
            let message = format!("mark {} of SYNC stands inside {what}", mark.number);
            self.fault(record, "wait", message, "let the CAM system put it before or behind");
            return;
        }
        let none = WaitRule::default();
        match self.reading.wait.as_ref().unwrap_or(&none).line(mark) {
            Ok(line) => {
                let wait = SyncWait { mark: mark.number, line };
                emit(ProgramStep::Command(Command::Sync(wait)));
            }
            Err(WaitLack { message, help }) => self.fault(record, "wait", message, help),
        }
    }

    /// The user takes it upon himself that the word has no effect.
    fn left_out(&mut self, word: &str, record: &Record<'_>) -> bool {
        let allowed = self.reading.allows(word);
        if allowed {
            self.allow(word, "is left out", record);
        }
        allowed
    }

    /// A cutting speed that the control is to keep: a fault if it is not above zero.
    pub(super) fn surface_speed(
        &mut self,
        record: &Record<'_>,
        (speed, unit, most): (f64, SpindleUnit, Option<f64>),
        emit: &mut StepSink<'_>,
    ) {
        let metres = match unit {
            SpindleUnit::SurfaceInch => speed * 0.3048,
            _ => speed,
        };
        let wrong = [Some(metres), most].into_iter().flatten().find(|value| *value <= 0.0);
        if let Some(wrong) = wrong {
            let message =
                format!("a constant cutting speed with {}: it must be above zero", Short(wrong));
            self.fault(record, "spindle", message, "SPINDL/SMM,speed,MAXRPM,limit");
            return;
        }
        if !self.writer.milling {
            self.turned_to_positions(record);
        }
        let most = most.or(self.spindle.surface_speed.and_then(|(_, most)| most));
        self.spindle.rpm = None;
        self.spindle.surface_speed = Some((metres, most));
        emit(ProgramStep::Command(Command::SurfaceSpeed {
            speed: metres,
            most,
            sense: self.spindle.sense,
        }));
    }

    /// `MODE/TURN`: a fault where no spindle turns the part.
    pub(super) fn turning(&mut self, record: &Record<'_>) {
        self.writer.milling = false;
        if !self.reading.surface_speed {
            self.fault(
                record,
                "mode-turn",
                "MODE/TURN, and the spindle of this machine does not turn the part".to_owned(),
                "[spindle] surface_speed = true in the machine file says that it does",
            );
        } else {
            self.turned_to_positions(record);
        }
    }

    /// A fault where the part is to be turned by a spindle, and an axis of the chain leads it to positions: they would be
    /// written while it turns.
    fn turned_to_positions(&mut self, record: &Record<'_>) {
        if let Some(name) = self.reading.turned_by.clone() {
            let message = format!(
                "the part is to be turned, and {name} of the chain leads it to positions: words of {name} would be written while its spindle turns it"
            );
            let help = "turn it by a machine file of its own, whose chain has the slides alone ([w b Z X t]), in the same job";
            self.fault(record, "mode-turn", message, help);
        }
    }

    /// The spindle turns the part: feeds a revolution are the control's.
    pub(super) fn turns_part(&self) -> bool {
        self.reading.surface_speed && !self.reading.plans && !self.writer.milling
    }

    /// Other tolerances of the control from here on; none: it keeps the path as it does by default.
    pub(super) fn smooth(&mut self, wanted: Option<Smoothing>, emit: &mut StepSink<'_>) {
        if wanted == self.smoothing {
            return;
        }
        self.smoothing = wanted;
        self.tip = None;
        emit(ProgramStep::Command(Command::Smoothing(wanted)));
    }
}
