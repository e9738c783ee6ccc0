//! One CL file, or some of its lines, on one machine: one program.

use std::ops::Range;
use std::sync::Arc;

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_posting::plan::PlanWatch;
use post_posting::report::PostingReport;
use post_posting::{
    JobFacts, Observer, PathShift, Post, PostingRequest, ProgramPreview, TextSink, Tightening,
};

use super::plugin_finder;
use crate::failure::Failure;
use crate::files::{ClSource, PathArg};
use crate::session::Session;
use crate::settings::JobSettings;

/// What one program is made of.
#[derive(Clone)]
pub struct OneProgram<'a> {
    /// The run.
    pub session: &'a Session,
    /// What the job is.
    pub arguments: &'a JobSettings,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// Its plugins.
    pub finder: &'a Finder,
    /// Where it will stand.
    pub target: &'a PathArg,
    /// Lines of the CL file that it is made of; none: all.
    pub lines: Option<Range<u64>>,
    /// The error model's word is taken.
    pub trust_model: bool,
    /// Its feed is planned.
    pub plans: bool,
    /// Where that plan may use less than the limit of the contour error.
    pub tightening: Option<Arc<Tightening>>,
}

/// Who takes part while a program is written.
#[derive(Default)]
pub struct Beside<'s, 'w, 'o> {
    /// Moves the points of its path.
    pub shift: Option<&'s mut dyn PathShift>,
    /// Sees its plan.
    pub watch: Option<&'w mut dyn PlanWatch>,
    /// Sees its blocks.
    pub observer: Option<&'o mut dyn Observer>,
}

impl OneProgram<'_> {
    /// Writes it to `file`: its report, if all is good, and every finding. `ahead` is what a first pass over the whole CL
    /// file has found, where the machine's texts ask for it.
    pub fn write(
        self,
        ahead: Option<&ProgramPreview>,
        source: &mut ClSource,
        file: &mut dyn TextSink,
        beside: Beside<'_, '_, '_>,
    ) -> Result<(Option<PostingReport>, Vec<Diagnostic>), Failure> {
        let Self {
            session,
            arguments,
            machine,
            finder,
            target,
            lines,
            trust_model,
            plans,
            tightening,
        } = self;
        let cl_file = &arguments.input;
        let program = super::program_name(cl_file, Some(target));
        // Of a part of the file other tools and extents are known than of the whole.
        let part_ahead = match &lines {
            Some(lines) if machine.program.looks_ahead => {
                let lines = Some(lines.clone());
                Some(super::look_ahead(session, arguments, machine, finder, source, lines)?)
            }
            _ => None,
        };
        let ahead = match lines {
            None => ahead,
            Some(_) => part_ahead.as_ref(),
        };
        let (mut dialect, dialect_use) =
            plugin_finder::dialect_knowing(finder, machine, &program, Some(cl_file), ahead)?;
        let (mut model, model_use) = plugin_finder::model(finder, machine)?;
        let planes = super::ahead(arguments, source, machine, &dialect)?;
        let input = source.open()?;
        let job = PostingRequest {
            ahead: planes,
            trust_model,
            plans,
            tightening,
            facts: JobFacts {
                program,
                cl_file: plugin_finder::cl_name(cl_file),
                ahead: ahead.cloned(),
            },
            lines,
            ..super::posting(arguments, &input.name)
        };
        let mut post =
            Post::new(machine, job, &mut dialect, &mut model, file).map_err(|finding| *finding)?;
        if let Some(shift) = beside.shift {
            post.shift(shift);
        }
        if let Some(watch) = beside.watch {
            post.watch_plan(watch);
        }
        if let Some(observer) = beside.observer {
            post.watch(observer);
        }
        super::read(session, input, &mut post)?;
        let (mut report, findings) = post.finish();
        if let Some(report) = &mut report {
            report.plugins = vec![dialect_use, model_use];
        }
        Ok((report, findings))
    }
}
