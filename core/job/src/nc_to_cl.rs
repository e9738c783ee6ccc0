//! What an NC program did, written as a CL file.

use post_machine::diagnostic::Diagnostic;
use post_motion::CornerMode;
use post_readback::convert::{ClWriter, MountedTool};
use post_readback::course::Course;
use post_readback::course::program::ProgramCourse;
use post_readback::{BlockRunner, Corners, MOST_FAULTS};

use super::nc_program;
use crate::files::FileFault;

/// So many bytes are written at once.
const BUFFER: usize = 1 << 16;

/// What came of it.
#[derive(Debug, Default)]
pub struct ConversionFindings {
    /// Blocks that are refused, and what no CL file can ask for: there is a fault in it, and the text is worth nothing.
    pub faults: Vec<Diagnostic>,
    /// What was not carried over, and what was taken for granted.
    pub notes: Vec<Diagnostic>,
}

/// What a program does not say of its tools.
#[derive(Clone, Copy, Debug)]
pub struct Tools {
    /// Length of those whose length the program does not compensate, mm.
    pub length: Option<f64>,
    /// Its control counts edges of a tool (D1), not registers: these are no registers of another control.
    pub edges: bool,
}

/// Writes the path of a program as a CL file of the part `part` to `sink`. Chords of curves that no record has stay within
/// `chord` mm.
///
/// # Errors
/// The text cannot be written.
pub fn write<P: BlockRunner>(
    course: &mut ProgramCourse<P>,
    part: &str,
    chord: f64,
    tools: Tools,
    sink: &mut dyn FnMut(&[u8]) -> Result<(), FileFault>,
) -> Result<ConversionFindings, FileFault> {
    let mut writer = ClWriter::new(chord);
    let mut written = ConversionFindings::default();
    let mut text = String::with_capacity(2 * BUFFER);
    let mut smooths = false;
    writer.begin(part, &mut text);
    loop {
        let done = match course.next() {
            Ok(None) => break,
            Ok(Some(item)) => {
                let state = course.state();
                smooths |= state.is_some_and(|state| leaves_the_path(state.corners));
                let compensated = state.map(|state| state.length).filter(|length| *length != 0.0);
                let tool = MountedTool {
                    register: state
                        .and_then(|state| state.length_register)
                        .filter(|_| !tools.edges),
                    length: compensated.or(tools.length),
                };
                writer.item(&item, tool, &mut text)
            }
            Err(fault) => Err(fault),
        };
        if let Err(fault) = done {
            written.faults.push(*fault);
            if written.faults.len() == MOST_FAULTS {
                written.faults.push(nc_program::given_up());
                break;
            }
        }
        if text.len() > BUFFER {
            sink(text.as_bytes())?;
            text.clear();
        }
    }
    writer.end(&mut text);
    sink(text.as_bytes())?;
    written.notes.extend(writer.notes().iter().cloned());
    if smooths {
        let message = "the program lets the control leave the path (CYCLE832, G187, CYCL DEF 32, G64 P, G5.1): a CL file has no word for that, and it is not carried over";
        written.notes.push(Diagnostic::warning("convert", message));
    }
    Ok(written)
}

/// Motions at feed that may be rapids, of which the first stands on a line, are cuts in the CL file.
pub fn fed(left: Option<(u64, u64)>) -> Option<Diagnostic> {
    let (count, line) = left?;
    let message = format!(
        "line {line}{} at feed and as fast as the axes go: a rapid or a cut, and it is carried over as a cut",
        match count {
            1 => " is".to_owned(),
            _ => format!(" and {} more are", count - 1),
        }
    );
    let help =
        "where the control's own rapids are meant, [control] rapid = \"rapid\" writes them so";
    Some(Diagnostic::warning("convert", message).help(help))
}

/// The control was told to smooth the path, or by how much.
fn leaves_the_path(corners: Corners) -> bool {
    match corners {
        Corners::Own => true,
        Corners::Said(CornerMode::Blend { tolerance }) => tolerance.is_some(),
        Corners::Said(CornerMode::Within { .. }) => true,
        _ => false,
    }
}
