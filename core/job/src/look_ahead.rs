//! A first pass over a CL file: which tools come when, how far the tip goes, and how long it takes.

use std::num::NonZeroUsize;
use std::ops::Range;

use post_host::Finder;
use post_machine::description::{Machine, OutputUnits};
use post_posting::{PostingRequest, ProgramPreview};

use super::posting_pass::{self, OpenedPlugins, PostingPass, ProgramHead};
use crate::failure::Failure;
use crate::files::ClSource;
use crate::session::Session;
use crate::settings::JobSettings;

/// Posts the file, or these lines of it, once without text of one's own, and throws the program away. What is refused then
/// would be refused again.
pub fn look_ahead(
    session: &Session,
    arguments: &JobSettings,
    machine: &Machine,
    finder: &Finder,
    source: &mut ClSource,
    lines: Option<Vec<Range<u64>>>,
) -> Result<ProgramPreview, Failure> {
    let plain = machine.without_text();
    let program = super::program_name(&arguments.input, None);
    let head = ProgramHead { name: &program, cl_file: Some(&arguments.input), preview: None };
    let OpenedPlugins { mut dialect, mut model, .. } = OpenedPlugins::open(finder, &plain, head)?;
    let planes = posting_pass::file_preview(arguments, source, &plain, &dialect)?;
    let input = source.open()?;
    let request = PostingRequest {
        ahead: planes,
        lines,
        ..posting_pass::posting_request_to(arguments, &input, &mut dialect)
    };
    let inch = machine.control.units == OutputUnits::Inch;
    let mut ahead = ProgramPreview { inch, ..ProgramPreview::default() };
    let pass = PostingPass {
        machine: &plain,
        request,
        threads: NonZeroUsize::MIN,
        dialect: &mut dialect,
        model: &mut model,
        keeps_clear: false,
    };
    let time = match pass.run_dry(session, input, Some(&mut ahead))? {
        (Some(report), _) => report.time_s,
        (None, findings) => return Err(findings.into()),
    };
    ahead.time_s = Some(time);
    Ok(ahead)
}
