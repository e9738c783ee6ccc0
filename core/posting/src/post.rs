//! One run: records in, text and a report out.

use post_grammar::{Record, SyntaxFault};
use post_plugin::{DialectSession, ModelSession};

use crate::path::{Output, Path, Watch};
use crate::program::{Interpreter, Reading, record_place};
use crate::recent::Recent;
use crate::report::{AxisRange, Deviation, Report};
use post_machine::axis_words;
use post_machine::description::{Machine, Tcp};
use post_machine::diagnostic::{Diagnostic, Extreme, Place, Severity, unreadable};

/// Faults of one run that are told; what comes after is most likely more of the same.
pub const MOST_FAULTS: usize = 20;

/// How one CL file is to be posted.
#[derive(Clone, Debug, Default)]
pub struct Job {
    /// How it is read.
    pub reading: Reading,
    /// Length of every tool, mm, over what machine and CL file say.
    pub tool_length: Option<f64>,
    /// Take the model's word over the certificate's.
    pub trust_model: bool,
}

/// Posts one CL file, record by record.
pub struct Post<'a> {
    machine: &'a Machine,
    interpreter: Interpreter,
    path: Path<'a>,
    file: String,
    records: u64,
    last_line: u64,
    findings: Vec<Diagnostic>,
    repeats: Vec<Repeat>,
    faults: usize,
    recent: Recent,
}

/// A limit that is passed again and again.
#[derive(Debug)]
struct Repeat {
    /// Its first finding.
    finding: usize,
    count: u64,
    extreme: Extreme,
    /// Where it is passed farthest.
    line: u64,
}

impl<'a> Post<'a> {
    /// Opens a run; the header goes out with the first records.
    ///
    /// # Errors
    /// What machine and dialect cannot do together.
    pub fn new(
        machine: &'a Machine,
        mut job: Job,
        dialect: &'a mut dyn DialectSession,
        model: &'a mut dyn ModelSession,
        output: &'a mut dyn Output,
    ) -> Result<Self, Box<Diagnostic>> {
        // Half of the tolerance goes to chords of arcs and splines, half is left for the axes.
        job.reading.chord_tolerance = machine.accuracy.tolerance / 2.0;
        job.reading.insert = machine.control.insert;
        job.reading.tool_length = machine.control.tool_length;
        let file = job.reading.file.clone();
        let mut path = Path::new(
            machine,
            dialect,
            model,
            output,
            job.tool_length,
            job.trust_model,
        )?;
        path.start();
        Ok(Self {
            machine,
            interpreter: Interpreter::new(job.reading),
            path,
            file,
            records: 0,
            last_line: 0,
            findings: Vec::new(),
            repeats: Vec::new(),
            faults: 0,
            recent: Recent::default(),
        })
    }

    /// Shows every cut to `watch` from here on.
    pub fn watch(&mut self, watch: &'a mut dyn Watch) {
        self.path.watch(watch);
    }

    /// Takes a record.
    #[inline]
    pub fn record(&mut self, record: &Record<'_>) {
        self.records += 1;
        self.last_line = record.line;
        let path = &mut self.path;
        self.recent
            .keep(record.line, record.raw, || path.settled_line());
        self.interpreter
            .record(record, &mut |step| path.step(record.line, step));
        if self.path.has_findings() || self.interpreter.has_findings() {
            let place = record_place(&self.file, record);
            self.gather(Some(&place));
        }
    }

    /// Takes a line that could not be read.
    pub fn unreadable(&mut self, fault: &SyntaxFault) {
        self.keep(unreadable(&self.file, fault));
    }

    /// So many faults that reading on would only repeat them.
    #[inline]
    pub fn gave_up(&self) -> bool {
        self.faults >= MOST_FAULTS
    }

    /// Ends the run: the report, if all is good, and every finding.
    pub fn finish(mut self) -> (Option<Report>, Vec<Diagnostic>) {
        if !self.gave_up() {
            self.interpreter.finish();
            self.gather(None);
            self.path.end(self.last_line);
            self.gather(None);
        }
        if self.faults == 0 && self.path.tally().moves == 0 {
            self.keep(
                Diagnostic::error("empty", format!("{} has no move", self.file))
                    .help("is it a cutter-location file (APT, CLSF, NCL)?"),
            );
        }
        if self.faults == 0 && self.path.length_unknown() {
            self.keep(
                Diagnostic::warning(
                    "tool-length",
                    "no length of the tool is known; it was taken as 0, and on this machine the axis positions depend on it",
                )
                .help("give --tool-length, or [tools] in the machine file"),
            );
        }
        self.tell_repeats();
        let report = (self.faults == 0).then(|| self.report());
        (report, self.findings)
    }

    /// Takes the findings of the stages; those without a place stand at `place`.
    #[cold]
    fn gather(&mut self, place: Option<&Place>) {
        let mut new = self.interpreter.take_findings();
        for mut finding in self.path.take_findings() {
            match &mut finding.place {
                None => finding.place = place.cloned(),
                Some(known) => {
                    known.file.clone_from(&self.file);
                    if let Some(text) = self.recent.text(known.line) {
                        known.span = 0..text.len();
                        known.text = text;
                    }
                }
            }
            if finding.code == "dialect" && finding.help.is_none() && !self.interpreter.has_tool() {
                finding.help =
                    Some("the CL file loads no tool: --tool N says which it is".to_owned());
            }
            new.push(finding);
        }
        for finding in new {
            self.keep(finding);
        }
    }

    fn keep(&mut self, finding: Diagnostic) {
        if finding.severity == Severity::Error {
            self.path.fail();
            if self.repeated(&finding) {
                return;
            }
            self.faults += 1;
        }
        self.findings.push(finding);
    }

    /// A limit that was passed before: counted, and its largest value kept.
    fn repeated(&mut self, finding: &Diagnostic) -> bool {
        let Some(extreme) = &finding.extreme else {
            return false;
        };
        let line = finding.place.as_ref().map_or(0, |place| place.line);
        let known = self.repeats.iter_mut().find(|repeat| {
            let first = &self.findings[repeat.finding];
            first.code == finding.code
                && first.extreme.as_ref().map(|extreme| extreme.key) == Some(extreme.key)
        });
        if let Some(repeat) = known {
            repeat.count += 1;
            if extreme.by > repeat.extreme.by {
                repeat.extreme = extreme.clone();
                repeat.line = line;
            }
            return true;
        }
        self.repeats.push(Repeat {
            finding: self.findings.len(),
            count: 1,
            extreme: extreme.clone(),
            line,
        });
        false
    }

    /// Adds to the first finding of a limit how often and how far it was passed.
    fn tell_repeats(&mut self) {
        for repeat in &self.repeats {
            if repeat.count > 1 {
                let finding = &mut self.findings[repeat.finding];
                finding.message.push_str(&format!(
                    "; {} points pass it, the farthest with {} on line {}",
                    repeat.count, repeat.extreme.value, repeat.line
                ));
            }
        }
    }

    fn report(&self) -> Report {
        let machine = self.machine;
        let tally = self.path.tally();
        let [tip, axis, rapid] = tally.deviations;
        let axes = axis_words::order(machine)
            .into_iter()
            .map(|index| {
                let axis = &machine.axes[index];
                AxisRange {
                    name: axis.name.clone(),
                    min: axis.reading(tally.least[index]),
                    max: axis.reading(tally.most[index]),
                    travel: axis
                        .travel
                        .map(|travel| travel.map(|end| axis.reading(end))),
                    way: tally.travel[index] / axis.unit(),
                }
            })
            .collect();
        Report {
            machine: machine.name.clone(),
            dialect: machine.control.dialect.clone(),
            tcp: match machine.control.tcp {
                Tcp::Control => "control",
                Tcp::Post => "post",
            }
            .to_owned(),
            model: machine.accuracy.model.clone(),
            records: self.records,
            moves: tally.moves,
            blocks: tally.blocks,
            nc_lines: tally.lines,
            points_added: tally.points_added,
            points_dropped: tally.points_dropped,
            model_overruled: self.path.overruled(),
            tip_deviation_mm: tip,
            axis_deviation_deg: Deviation {
                value: axis.value.to_degrees(),
                ..axis
            },
            rapid_deviation_mm: rapid,
            control_point: machine.control_point,
            tolerance_mm: machine.accuracy.tolerance,
            axis_tolerance_deg: machine.accuracy.axis_tolerance.to_degrees(),
            axes,
            branch_changes: tally.branch_changes,
            rewinds: tally.rewinds,
            points_eased: tally.eased,
            time_s: (tally.cutting + tally.other) * 60.0,
            cutting_time_s: tally.cutting * 60.0,
            blocks_limited: tally.limited,
            ignored_words: self
                .interpreter
                .ignored()
                .map(|(word, count)| (word.to_owned(), count))
                .collect(),
            plugins: Vec::new(),
            warnings: self
                .findings
                .iter()
                .filter(|finding| finding.severity == Severity::Warning)
                .map(|finding| match &finding.place {
                    Some(place) => format!("line {}: {}", place.line, finding.message),
                    None => finding.message.clone(),
                })
                .collect(),
        }
    }
}
