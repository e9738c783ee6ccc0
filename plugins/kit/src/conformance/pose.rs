//! Where the tool stands at the end of a move, as the host tells it beside the words: told to dialects that write its
//! direction, so that of all others the words alone are tried.

use post_plugin::{Event, ToolPose, Units};

/// mm in an inch.
const INCH: f64 = 25.4;

/// The event with the pose that its words bring the tool to, where it has room for one and says none.
pub(super) fn posed(event: Event<'_>, units: Units) -> Event<'_> {
    let mut event = event;
    match &mut event {
        Event::Position { tool, words, .. }
        | Event::Rapid { tool, words }
        | Event::Linear { tool, words, .. }
        | Event::Arc { tool, words, .. }
        | Event::CyclePoint { tool, words }
        | Event::Surface { tool, words, .. }
        | Event::Probe { tool, words, .. } => *tool = tool.or_else(|| pose(words, units)),
        _ => {}
    }
    event
}

/// X, Y and Z are the tip's; A tilts the part, and C, which A carries, turns it.
fn pose(words: &[f64], units: Units) -> Option<ToolPose> {
    let &[x, y, z, a, c] = words else {
        return None;
    };
    let scale = if units == Units::Inch { INCH } else { 1.0 };
    let ((sin_a, cos_a), (sin_c, cos_c)) = (sin_cos(a), sin_cos(c));
    Some(ToolPose {
        tip: [x, y, z].map(|word| word * scale),
        axis: [sin_a * sin_c, sin_a * cos_c, cos_a],
    })
}

/// Of an angle in degrees.
fn sin_cos(degrees: f64) -> (f64, f64) {
    libm::sincos(degrees.to_radians())
}
