//! The choice for a path that is given as points, with no program around it.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::Format;

use super::route::{DroppedPoint, Route};
use crate::program::StraightMove;

/// The axis values of each point of `path`, chosen over the whole of it as for a program whose words are written as
/// `format` says, with a tool of `length` mm. The machine does not draw its tool back: where a cut cannot go on, that is
/// a fault. `is_stopped` says that nobody wants it any more.
///
/// # Errors
/// What the machine lacks, every point that it cannot reach, by its place in `path` counted from 0, or that it was stopped.
pub fn whole_pass(
    machine: &Machine,
    format: &Format,
    length: f64,
    path: &[StraightMove],
    is_stopped: &dyn Fn() -> bool,
) -> Result<Vec<Joints>, Vec<Diagnostic>> {
    let machine = Machine { rewind: None, ..machine.clone() };
    let along = machine.control_point.along;
    let mut route = Route::new(&machine, format, length).map_err(|fault| vec![*fault])?;
    let mut faults = Vec::new();
    let mut found = vec![Joints::default(); path.len()];
    let mut chosen = Vec::new();
    for (index, motion) in path.iter().enumerate() {
        if is_stopped() {
            return Err(vec![Diagnostic::error("input", format!("interrupted at point {index}"))]);
        }
        let guided = StraightMove { tip: motion.tip + motion.axis * along, ..*motion };
        if let Err(lost) = route.add(index as u64, &guided) {
            let (DroppedPoint::Point(fault) | DroppedPoint::Path(fault)) = lost;
            let message = format!("point {index}: {}", fault.message);
            faults.push(Diagnostic { message, ..*fault });
            if faults.len() >= crate::MOST_FAULTS {
                break;
            }
        }
        if index + 1 == path.len() {
            route.settle_all();
        }
        if !route.has_chosen() {
            continue;
        }
        route.take_chosen(&mut chosen);
        for next in &chosen {
            let solver = route.placer(next.setting).solver();
            let mut joints = next.joints;
            let turns = solver.chain().turns(&joints);
            if solver.place(next.motion.tip, &mut joints, &turns).is_err() {
                let message = format!("point {}: the linear axes span no volume there", next.line);
                faults.push(Diagnostic::error("unreachable", message));
            }
            found[next.line as usize] = joints;
        }
    }
    match faults.is_empty() {
        true => Ok(found),
        false => Err(faults),
    }
}
