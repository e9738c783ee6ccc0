//! A first pass over a CL file: which tools come when, how far the tip goes, and how long it takes.

use std::ops::Range;

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_posting::{Post, PostingRequest, ProgramPreview};

use super::plugin_finder;
use crate::failure::Failure;
use crate::files::{ClSource, NullSink};
use crate::session::Session;
use crate::settings::JobSettings;

/// Posts the file, or these lines of it, once without text of one's own, and throws the program away. What is refused then would be refused
/// again.
pub fn look_ahead(
    session: &Session,
    arguments: &JobSettings,
    machine: &Machine,
    finder: &Finder,
    source: &mut ClSource,
    lines: Option<Range<u64>>,
) -> Result<ProgramPreview, Failure> {
    let plain = machine.without_text();
    let program = super::program_name(&arguments.input, None);
    let (mut dialect, _) =
        plugin_finder::dialect(finder, &plain, &program, Some(&arguments.input))?;
    let (mut model, _) = plugin_finder::model(finder, &plain)?;
    let mut ahead = ProgramPreview::default();
    let planes = super::ahead(arguments, source, &plain, &dialect)?;
    let input = source.open()?;
    let job = PostingRequest { ahead: planes, lines, ..super::posting(arguments, &input.name) };
    let mut sink = NullSink;
    let mut post = Post::new(&plain, job, &mut dialect, &mut model, &mut sink)
        .map_err(|finding: Box<Diagnostic>| *finding)?;
    post.watch(&mut ahead);
    super::read(session, input, &mut post)?;
    let time = match post.finish() {
        (Some(report), _) => report.time_s,
        (None, findings) => return Err(findings.into()),
    };
    ahead.time_s = Some(time);
    Ok(ahead)
}
