//! How long a program takes, and nothing else of it.

use std::io::BufReader;

use super::trajectory::{Trajectory, TrajectoryNews};
use crate::beside::Maker as _;
use crate::failure::Failure;
use crate::nc_program::{NcControl, ProgramText};

/// News that are made together.
const TOGETHER: usize = 64;

/// How long the program `name` in `text` takes, s; none where the machine file does not say how fast its axes get up to
/// speed.
///
/// # Errors
/// The machine cannot be solved, the axes cannot follow, or how a block is carried out is not known.
pub fn cycle_time(
    control: &NcControl,
    name: &str,
    text: ProgramText<'_>,
) -> Result<Option<f64>, Failure> {
    let machine = &control.machine;
    if machine.axes.iter().any(|axis| axis.max_feed.is_infinite() || axis.max_accel.is_infinite()) {
        return Ok(None);
    }
    let run = control.run(name, BufReader::new(text)).map_err(|fault| *fault)?;
    let trajectory = Trajectory::new(name, run, machine, machine.motion.period, false);
    let mut trajectory = trajectory.timed();
    let (mut seconds, mut batch) = (0.0_f64, Vec::new());
    while trajectory.make(&mut batch, TOGETHER) {
        for news in &batch {
            match news {
                TrajectoryNews::Times(times) => {
                    let ends = times.iter().map(|time| time.begins + time.seconds);
                    seconds = ends.fold(seconds, f64::max);
                }
                TrajectoryNews::Failed(why) => return Err(why.clone().into()),
                _ => {}
            }
        }
    }
    let faults = trajectory.end().0.into_faults();
    if faults.is_empty() { Ok(Some(seconds)) } else { Err(faults.into()) }
}
