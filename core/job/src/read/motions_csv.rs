//! Motions as rows.
//!
//! Plain text and not Parquet: whatever reads tables reads CSV, and the crate that writes Parquet brings Arrow and some
//! dozen crates of compression with it, for one output of one verb.

use post_machine::description::Machine;
use post_readback::{
    BlockEffect, Curve, Interpolation, Motion, MotionKind, ProgramEvent, SpindleState,
};

use crate::axes::{self, AxisColumn};
use crate::columns::{Column, CsvTable};
use crate::files::{AtomicFile, FileFault};

/// A motion, and where its axes stand behind it.
struct MotionReadings {
    motion: Motion,
    /// By columns, as the control shows them.
    readings: Vec<Option<f64>>,
}

/// The columns of the table.
fn columns(axes: &[AxisColumn]) -> Vec<Column<MotionReadings>> {
    type C = Column<MotionReadings>;
    let mut columns = vec![
        C::new("line", "", 0, |row| row.motion.line),
        C::new("block", "", 0, |row| row.motion.number),
        C::new("kind", "", 0, |row| match row.motion.kind {
            MotionKind::Rapid => "rapid",
            MotionKind::Feed => "feed",
            MotionKind::Thread => "thread",
        }),
        C::new("way", "", 0, |row| match &row.motion.way {
            Interpolation::Axes => "axes",
            Interpolation::Tip(Curve::Straight) => "tip",
            Interpolation::TipAndAxis => "tip and axis",
            Interpolation::TipAndFrame(_) => "tip and frame",
            Interpolation::Tip(Curve::Arc { .. }) => "arc",
            Interpolation::Tip(Curve::Spline(_)) => "spline",
        }),
    ];
    for (column, axis) in axes.iter().enumerate() {
        let unit = if axis.rotary { "deg" } else { "mm" };
        columns.push(C::new(axis.name.clone(), unit, 6, move |row| row.readings[column]));
    }
    columns.extend([
        C::new("tip_x", "mm", 6, |row| row.motion.to.pose.tip.x),
        C::new("tip_y", "mm", 6, |row| row.motion.to.pose.tip.y),
        C::new("tip_z", "mm", 6, |row| row.motion.to.pose.tip.z),
        C::new("axis_i", "", 9, |row| row.motion.to.pose.axis.x),
        C::new("axis_j", "", 9, |row| row.motion.to.pose.axis.y),
        C::new("axis_k", "", 9, |row| row.motion.to.pose.axis.z),
        C::new("feed", "mm/min", 3, |row| row.motion.feed),
        C::new("minutes", "min", 9, |row| row.motion.minutes),
        C::new("tool", "", 0, |row| row.motion.state.tool),
        C::new("spindle", "1/min", 0, |row| speed(row.motion.state.spindle).to_string()),
        C::new("tcp", "", 0, |row| row.motion.state.tcp),
    ]);
    columns
}

/// Clockwise above zero, 1/min.
fn speed(spindle: SpindleState) -> f64 {
    match spindle {
        SpindleState::Clockwise(speed) => speed,
        SpindleState::CounterClockwise(speed) => -speed,
        SpindleState::Surface { speed, clockwise: true, .. } => speed,
        SpindleState::Surface { speed, .. } => -speed,
        SpindleState::Off | SpindleState::Oriented => 0.0,
    }
}

/// The table, as it is written.
pub struct MotionsCsv<'a, 'f> {
    base: &'a Machine,
    /// The machine with the head that it has now.
    machine: &'a Machine,
    axes: Vec<AxisColumn>,
    table: CsvTable<'f, MotionReadings>,
}

impl<'a, 'f> MotionsCsv<'a, 'f> {
    /// Of a machine, into `file`.
    pub fn new(machine: &'a Machine, file: &'f mut AtomicFile) -> Self {
        let axes = axes::by_words(machine);
        Self { base: machine, machine, table: CsvTable::new(columns(&axes), file), axes }
    }

    /// Takes what was done.
    pub fn take(&mut self, done: &BlockEffect) -> Result<(), FileFault> {
        match done {
            BlockEffect::Motion(motion) => {
                let readings = axes::readings(self.machine, &motion.to.joints);
                let readings = axes::in_columns(&self.axes, self.machine, &readings);
                self.table.row(&MotionReadings { motion: motion.clone(), readings })
            }
            BlockEffect::Event { event: ProgramEvent::Head(name), .. } => {
                (self.machine, _) = axes::with_head(self.base, name);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Writes what is left.
    pub fn finish(self) -> Result<(), FileFault> {
        self.table.finish()
    }
}
