//! Motions as rows.
//!
//! Plain text and not Parquet: whatever reads tables reads CSV, and the crate that writes Parquet brings Arrow and some
//! dozen crates of compression with it, for one output of one verb.

use std::fmt::Write as _;

use post_machine::axis_words;
use post_machine::description::Machine;
use post_plugin::fixed;
use post_readback::{Done, Motion, MotionKind, Spindle, Told, Way};

use post_job::files::{AtomicFile, FileFault};

/// So many bytes of rows are written at once.
const BUFFER: usize = 1 << 16;

/// The table, as it is written.
pub struct MotionsCsv<'a, 'f> {
    base: &'a Machine,
    /// The machine with the head that it has now.
    machine: &'a Machine,
    file: &'f mut AtomicFile,
    /// Names of the axes, a column each: those of the machine, and then those that a head adds.
    columns: Vec<String>,
    text: String,
}

impl<'a, 'f> MotionsCsv<'a, 'f> {
    pub fn new(machine: &'a Machine, file: &'f mut AtomicFile) -> Self {
        let mut columns: Vec<String> = Vec::new();
        let heads = machine.heads.iter().map(|head| &head.machine);
        for machine in [machine].into_iter().chain(heads) {
            for place in axis_words::order(machine) {
                let name = &machine.axes[place].name;
                if !columns.contains(name) {
                    columns.push(name.clone());
                }
            }
        }
        let mut text = String::with_capacity(2 * BUFFER);
        text.push_str("line,block,kind,way");
        for name in &columns {
            let _ = write!(text, ",{name}");
        }
        text.push_str(",tip_x,tip_y,tip_z,axis_i,axis_j,axis_k,feed,minutes,tool,spindle,tcp\n");
        Self { base: machine, machine, file, columns, text }
    }

    /// Takes what was done.
    pub fn take(&mut self, done: &Done) -> Result<(), FileFault> {
        match done {
            Done::Motion(motion) => self.row(motion),
            Done::Told { told: Told::Head(name), .. } => {
                self.machine = self.base.head(name).map_or(self.base, |head| &head.machine);
            }
            _ => {}
        }
        if self.text.len() > BUFFER {
            self.file.write_bytes(self.text.as_bytes())?;
            self.text.clear();
        }
        Ok(())
    }

    fn row(&mut self, motion: &Motion) {
        let text = &mut self.text;
        let block = motion.number.map_or_else(String::new, |number| number.to_string());
        let kind = match motion.kind {
            MotionKind::Rapid => "rapid",
            MotionKind::Feed => "feed",
            MotionKind::Thread => "thread",
        };
        let way = match &motion.way {
            Way::Axes => "axes",
            Way::Tip => "tip",
            Way::TipAndAxis => "tip and axis",
            Way::Arc { .. } => "arc",
            Way::Spline(_) => "spline",
        };
        // Writing to a String cannot fail.
        let _ = write!(text, "{},{block},{kind},{way}", motion.line);
        for name in &self.columns {
            text.push(',');
            let place = self.machine.axes.iter().position(|axis| axis.name == *name);
            if let Some(place) = place {
                fixed(text, self.machine.axes[place].reading(motion.to.joints[place]), 6);
            }
        }
        let pose = &motion.to.pose;
        for (value, decimals) in
            pose.tip.iter().map(|value| (value, 6)).chain(pose.axis.iter().map(|value| (value, 9)))
        {
            text.push(',');
            fixed(text, *value, decimals);
        }
        let (feed, minutes) = (motion.feed, motion.minutes);
        let tool = motion.state.tool.map_or_else(String::new, |tool| tool.to_string());
        let spindle = match motion.state.spindle {
            Spindle::Clockwise(speed) => speed,
            Spindle::CounterClockwise(speed) => -speed,
            Spindle::Surface { speed, clockwise, .. } => {
                if clockwise {
                    speed
                } else {
                    -speed
                }
            }
            Spindle::Off | Spindle::Oriented => 0.0,
        };
        let _ = writeln!(
            text,
            ",{feed:.3},{minutes:.9},{tool},{spindle},{}",
            u8::from(motion.state.tcp)
        );
    }

    /// Writes what is left.
    pub fn finish(self) -> Result<(), FileFault> {
        self.file.write_bytes(self.text.as_bytes())
    }
}
