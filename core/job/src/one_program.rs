//! One CL file, or some of its lines, on one machine: one program.

use std::num::NonZeroUsize;
use std::sync::Arc;

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_posting::report::PostingReport;
use post_posting::{JobFacts, PostingRequest, ProgramPreview, TextSink, Tightening};

use super::plugin_finder;
use super::posting_pass::{self, OpenedPlugins, PostingExtras, PostingPass, ProgramHead};
use crate::failure::Failure;
use crate::files::{ClSource, PathArg};
use crate::job_file::JobMark;
use crate::operations::ProgramLines;
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
    pub lines: Option<ProgramLines>,
    /// The error model's word is taken.
    pub trust_model: bool,
    /// Its feed is planned.
    pub plans: bool,
    /// Threads that it is made on at most.
    pub threads: NonZeroUsize,
    /// Where that plan may use less than the limit of the contour error.
    pub tightening: Option<Arc<Tightening>>,
    /// Solutions are chosen with which bodies stay clear, whatever the machine file says.
    pub keeps_clear: bool,
}

impl OneProgram<'_> {
    /// Writes it to `file`: its report, if all is good, and every finding. `ahead` is what a first pass over the whole CL
    /// file has found, where the machine's texts ask for it.
    pub fn write(
        self,
        ahead: Option<&ProgramPreview>,
        source: &mut ClSource,
        file: &mut dyn TextSink,
        beside: PostingExtras<'_, '_, '_>,
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
            threads,
            tightening,
            keeps_clear,
        } = self;
        let cl_file = &arguments.input;
        let program = super::program_name(cl_file, Some(target));
        // Of a part of the file other tools and extents are known than of the whole.
        let part_ahead = match &lines {
            Some(lines) if machine.program.looks_ahead => {
                let lines = Some(lines.ranges.clone());
                Some(super::look_ahead(session, arguments, machine, finder, source, lines)?)
            }
            _ => None,
        };
        let ahead = match lines {
            None => ahead,
            Some(_) => part_ahead.as_ref(),
        };
        let mut remarks: Vec<String> = arguments.mark.iter().map(JobMark::remark).collect();
        remarks.extend(lines.as_ref().and_then(ProgramLines::remark));
        let left_out = lines.as_ref().map(|lines| lines.left_out.clone()).unwrap_or_default();
        let head = ProgramHead { name: &program, cl_file: Some(cl_file), preview: ahead };
        let OpenedPlugins { mut dialect, mut model, uses } =
            OpenedPlugins::open(finder, machine, head)?;
        let planes = posting_pass::file_preview(arguments, source, machine, &dialect)?;
        let input = source.open()?;
        let request = PostingRequest {
            ahead: planes,
            trust_model,
            plans,
            tightening,
            facts: JobFacts {
                program,
                cl_file: plugin_finder::cl_name(cl_file),
                ahead: ahead.cloned(),
                remarks,
            },
            lines: lines.map(|lines| lines.ranges),
            ..posting_pass::posting_request_to(arguments, &input, &mut dialect)
        };
        let (dialect, model) = (&mut dialect, &mut model);
        let pass = PostingPass { machine, request, threads, dialect, model, keeps_clear };
        let (mut report, findings) = pass.write(session, input, file, beside)?;
        if let Some(report) = &mut report {
            report.plugins = uses.to_vec();
            report.left_out = left_out;
        }
        Ok((report, findings))
    }
}
