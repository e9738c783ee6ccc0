//! The motions of a program that is run, row by row, and what is found out about its lines meanwhile.

use std::collections::VecDeque;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_motion::path::{Curve, Interpolation, arc_chords};
use post_readback::{BlockEffect, Motion, MotionKind, ProgramEvent};
use post_report::meta::{AxisUsed, Meta};

use super::block_rows::{decimals, packed};
use super::branch::{self, Branch};
use super::cl_points::Points;
use super::cl_window::ClWindow;
use super::derived::{Derived, PackedValues};
use super::marks::{Marks, cutter};
use super::old_path::OldPath;
use super::page_table::PageTable;
use super::parts::Parts;
use super::path_rows::PathRows;
use super::predicted_rows;
use crate::axes::{self, AxisColumn};
use crate::columns::Column;
use crate::failure::Failure;
use crate::posted::numbered;

/// Places on a curve at most.
const MOST_PLACES: f64 = 512.0;

/// What is known of a line of the program besides what it does.
#[derive(Clone, Debug, Default)]
pub struct LineFacts {
    /// Line of the CL file; zero where there is none.
    pub cl: u64,
    /// Of the tip, mm, and of the tool axis, degrees.
    pub deviation: [f64; 2],
    /// When it begins and ends, s, as predicted.
    pub times: Option<[f64; 2]>,
    /// What limits it.
    pub limit: Option<String>,
    /// Largest velocity and acceleration of each axis, units of the axis: /s, /s².
    pub peaks: [Joints; 2],
    /// Largest contour error, mm.
    pub contour: f64,
}

/// What rows tell besides.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExtraColumns {
    /// The program is held against a CL file.
    pub deviations: bool,
    /// It is predicted.
    pub predicted: bool,
    /// It is held against another program.
    pub other: bool,
}

/// A row of the page.
struct MotionRow {
    /// Line of the program.
    nc: u64,
    /// When the motion begins and ends, s; as they are packed, once what is known of its line is.
    times: [f64; 2],
    /// Among the kinds of posted blocks.
    kind: u8,
    left: PackedValues,
    /// Feed of the tip, mm/min.
    feed: f64,
    /// By how much the tip stands before the gauge point, mm.
    tool_length: f64,
    heard: LineFacts,
    /// A place in the names of limits, or -1.
    limit: i64,
    /// Of the tip, mm.
    tolerance: f64,
    /// Line of the other program; zero where there is none.
    other: u64,
}

/// The columns of the page.
fn columns(
    machine: &Machine,
    axes: &[AxisColumn],
    derived: &Derived<'_>,
    besides: ExtraColumns,
) -> Vec<Column<MotionRow>> {
    type C = Column<MotionRow>;
    let accuracy = &machine.accuracy;
    let [tip, turn] = [accuracy.tolerance, accuracy.axis_tolerance.to_degrees()].map(decimals);
    let mut columns = vec![
        C::new("nc", "", 0, |row| row.nc),
        C::new("t0", "s", 4, |row| row.times[0]).from("t1"),
        C::new("t1", "s", 4, |row| row.times[1]),
        C::new("kind", "", 0, |row| row.kind),
    ];
    columns.extend(derived.columns(axes, |row: &MotionRow| &row.left));
    columns.extend([
        C::new("feed", "mm/min", 1, |row| row.feed),
        C::new("tool_length", "mm", 4, |row| row.tool_length),
        C::new("cl", "", 0, |row| row.heard.cl),
        C::new("limit", "", 0, |row| row.limit),
    ]);
    if besides.deviations {
        columns.extend([
            C::new("deviation", "mm", tip, |row| row.heard.deviation[0]),
            C::new("axis_deviation", "deg", turn, |row| row.heard.deviation[1]),
            C::new("tolerance", "mm", 6, |row| row.tolerance),
        ]);
    }
    if besides.predicted {
        columns.extend(predicted_rows::columns(machine, |row: &MotionRow| &row.heard));
    }
    if besides.other {
        columns.push(C::new("nc2", "", 0, |row| row.other));
    }
    columns
}

/// A row that waits for what is known of its line.
struct PendingRow {
    row: MotionRow,
    rapid: bool,
    /// The tip at the end.
    tip: Vector3<f64>,
    places: Vec<Vector3<f64>>,
    /// The middle of its way, as the page will have it.
    middle: Option<Vector3<f64>>,
}

/// Takes what a program does, and packs a row of each motion.
pub struct MotionRows<'m> {
    /// The machine with the head in use.
    machine: &'m Machine,
    base: &'m Machine,
    /// Axes of all heads, in the order of their columns.
    axes: Vec<AxisColumn>,
    /// Somebody tells of lines: rows wait for that.
    told_of: bool,
    table: PageTable<MotionRow>,
    path: PathRows,
    derived: Derived<'m>,
    /// End of the row before, s.
    end: f64,
    branch: Branch,
    cl: Option<ClWindow>,
    /// The path of the program that it is held against.
    old: Option<OldPath>,
    /// Where the rows end, for the path of the CL file.
    ends: Points,
    /// Line of the CL file of the row before.
    last_cl: u64,
    waiting: VecDeque<PendingRow>,
    came: u64,
    time: f64,
    operation: String,
    tool: Option<u32>,
    length: Option<f64>,
    limits: Vec<String>,
    marks: Marks,
    /// First row of each line that is largest in something, and what: tip, axis, contour error.
    largest: [(f64, u64, u64); 3],
    used: Vec<AxisUsed>,
}

impl<'m> MotionRows<'m> {
    /// For a program; `cl` is the path that it is held against.
    ///
    /// # Errors
    /// There is no place for the rows.
    pub fn new(
        machine: &'m Machine,
        cl: Option<ClWindow>,
        besides: ExtraColumns,
    ) -> Result<Self, Failure> {
        let axes = axes::of_all_heads(machine);
        let derived = Derived::new(machine);
        let columns = columns(machine, &axes, &derived, besides);
        Ok(Self {
            machine,
            base: machine,
            axes,
            told_of: besides.deviations || besides.predicted,
            table: PageTable::new("blocks", columns)?,
            path: PathRows::new(machine)?,
            derived,
            end: 0.0,
            branch: Branch::new(machine),
            cl,
            old: None,
            ends: Points::new()?,
            last_cl: 0,
            waiting: VecDeque::new(),
            came: 0,
            time: 0.0,
            operation: String::new(),
            tool: None,
            length: None,
            limits: Vec::new(),
            marks: Marks::default(),
            largest: [(0.0, 0, 0); 3],
            used: Vec::new(),
        })
    }

    /// The same, held against the path of another program.
    pub fn against(self, old: OldPath) -> Self {
        Self { old: Some(old), ..self }
    }

    /// All has come: the tables go to `parts`, and what was seen to `meta`, whose maxima learn their rows.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn finish(mut self, parts: &mut Parts, meta: &mut Meta) -> Result<(), Failure> {
        self.alone();
        if let Some(cl) = self.cl {
            cl.finish(self.base, self.ends, parts)?;
        }
        if let Some(old) = self.old {
            old.finish(parts)?;
        }
        self.path.finish(parts)?;
        for maximum in &mut meta.maxima {
            let mut known = self.largest.iter();
            let known = known.find(|(value, _, nc)| *value > 0.0 && maximum.nc == Some(*nc));
            maximum.row = known.map(|(_, row, _)| *row);
        }
        meta.checks = self.derived.checks();
        meta.axes_used = self.used;
        meta.limits = self.limits;
        self.marks.finish(meta);
        meta.tool_length = self.length.unwrap_or(0.0);
        self.table.finish(parts)
    }

    /// What the program does next.
    pub fn take(&mut self, done: &BlockEffect) {
        match done {
            BlockEffect::Motion(motion) => {
                self.motion(motion);
                if !self.told_of {
                    self.write(None);
                }
            }
            BlockEffect::Event { event: told, .. } => self.told(told),
            BlockEffect::State(state) => {
                let operation = state.operation.as_deref().unwrap_or_default();
                if operation != self.operation {
                    self.operation = operation.to_owned();
                    self.marks.event(self.came, "operation", operation);
                }
            }
        }
    }

    /// All that is done on `line` gets what was heard of it; what came before, and nobody told of, stays as it is.
    pub fn hear(&mut self, line: u64, heard: &LineFacts) {
        let Some(place) = self.waiting.iter().position(|waiting| waiting.row.nc == line) else {
            return;
        };
        for _ in 0..place {
            self.write(None);
        }
        // A hole has many motions on its line.
        while self.waiting.front().is_some_and(|waiting| waiting.row.nc == line) {
            self.write(Some(heard));
        }
    }

    /// From here on nobody tells of lines.
    pub fn alone(&mut self) {
        self.told_of = false;
        while !self.waiting.is_empty() {
            self.write(None);
        }
    }

    fn motion(&mut self, motion: &Motion) {
        let from = self.time;
        self.time += motion.minutes * 60.0;
        let kind = match (motion.hole, motion.kind, motion.way.curve()) {
            (true, ..) => 6,
            (_, MotionKind::Rapid, _) => 2,
            (_, _, Curve::Arc { .. }) => 4,
            (_, _, Curve::Spline(_)) => 5,
            _ => 3,
        };
        // The chain has the tool in it: where the gauge point is, is the same with every tool.
        let tip = motion.state.solver.chain().tip();
        let length = (self.machine.gauge - tip).dot(&self.machine.tool_axis);
        self.length.get_or_insert(length);
        if self.branch.changes(&motion.to.joints) {
            self.marks.event(self.came, "branch", branch::CHANGED);
        }
        let pose = motion.to.pose;
        let joints = &motion.to.joints;
        let pose = [pose.tip, pose.axis];
        let shown = axes::readings(self.machine, joints);
        let shown = axes::in_columns(&self.axes, self.machine, &shown);
        let left = self.derived.left(self.machine, &self.axes, shown, joints, pose, length);
        self.derived.check(self.came, joints, length);
        let places = self.on_the_way(motion);
        let middle = (self.came > 0 && places.len() == 1)
            .then(|| self.derived.middle(&motion.from.joints, joints, length));
        let accuracy = &self.machine.accuracy;
        let rapid = motion.kind == MotionKind::Rapid;
        self.waiting.push_back(PendingRow {
            row: MotionRow {
                nc: motion.line,
                times: [from, self.time],
                kind,
                left,
                feed: motion.feed,
                tool_length: length,
                heard: LineFacts::default(),
                limit: -1,
                tolerance: if rapid { accuracy.rapid_tolerance } else { accuracy.tolerance },
                other: 0,
            },
            rapid,
            tip: motion.to.pose.tip,
            places,
            middle: middle.flatten(),
        });
        self.came += 1;
        self.cover(motion);
    }

    /// The axes come to both ends of a motion.
    fn cover(&mut self, motion: &Motion) {
        let ends = motion.from.joints.iter().zip(&motion.to.joints);
        for (axis, (from, to)) in self.machine.axes.iter().zip(ends) {
            let known = self.used.iter().position(|used| used.name == axis.name);
            let place = known.unwrap_or_else(|| {
                self.used.push(AxisUsed {
                    name: axis.name.clone(),
                    unit: axis.unit_name(),
                    min: f64::INFINITY,
                    max: f64::NEG_INFINITY,
                    travel: axis.travel.map(|travel| travel.map(|end| axis.reading(end))),
                    way: Some(0.0),
                });
                self.used.len() - 1
            });
            let used = &mut self.used[place];
            for end in [from, to] {
                let reading = axis.reading(*end);
                used.min = used.min.min(reading);
                used.max = used.max.max(reading);
            }
            if let Some(way) = &mut used.way {
                *way += libm::fabs(to - from) / axis.unit();
            }
        }
    }

    /// Where the tip goes between the ends of a motion, where that is no straight line.
    fn on_the_way(&self, motion: &Motion) -> Vec<Vector3<f64>> {
        let tolerance = self.machine.accuracy.tolerance;
        let [from, to] = [motion.from.pose.tip, motion.to.pose.tip];
        let count = match &motion.way {
            Interpolation::Axes => {
                let bow = (motion.at(0.5).tip - 0.5 * (from + to)).norm();
                if bow > tolerance / 50.0 { 2 } else { 1 }
            }
            Interpolation::Tip(Curve::Straight)
            | Interpolation::TipAndAxis
            | Interpolation::TipAndFrame(_) => 1,
            Interpolation::Tip(Curve::Arc { centre, sweep, .. }) => {
                let chords = arc_chords((from - centre).norm(), *sweep, tolerance);
                chords.clamp(2.0, MOST_PLACES) as u32
            }
            Interpolation::Tip(Curve::Spline(way)) => {
                (16 * way.spans().count() as u32).min(MOST_PLACES as u32)
            }
        };
        (1..count).map(|place| motion.at(f64::from(place) / f64::from(count)).tip).collect()
    }

    /// Packs the first row that waits.
    fn write(&mut self, heard: Option<&LineFacts>) {
        let Some(PendingRow { mut row, rapid, tip, places, middle }) = self.waiting.pop_front()
        else {
            return;
        };
        if let Some(heard) = heard {
            row.heard.clone_from(heard);
        }
        let heard = &row.heard;
        let place = self.table.rows();
        let [from, to] = heard.times.unwrap_or(row.times);
        row.times = [packed(from) - packed(self.end), to];
        self.end = to;
        if let Some(limit) = &heard.limit {
            row.limit = numbered(&mut self.limits, limit);
        }
        row.other = self.old.as_mut().and_then(|old| old.advance(tip)).unwrap_or(0);
        let old = self.old.as_ref();
        let off = |cl: &Option<ClWindow>, tip| match heard.cl {
            0 => old.and_then(|old| old.off(tip)),
            _ => cl.as_ref().and_then(|cl| cl.off(tip)),
        };
        if let (Some(cl), true) = (&mut self.cl, heard.cl > 0) {
            cl.advance(heard.cl);
            cl.forget(self.last_cl.min(heard.cl));
            self.last_cl = heard.cl;
        }
        let places: Vec<_> =
            places.into_iter().chain([tip]).map(|place| (place, off(&self.cl, place))).collect();
        let end = row.left.tip;
        self.path.block(place, end, middle, &places);
        if self.cl.is_some() {
            self.ends.push(heard.cl, end, 0.0);
        }
        if !rapid {
            let [tip, axis] = heard.deviation;
            for (largest, value) in self.largest.iter_mut().zip([tip, axis, heard.contour]) {
                if value > largest.0 {
                    *largest = (value, place, row.nc);
                }
            }
        }
        self.table.row(&row);
    }

    fn told(&mut self, told: &ProgramEvent) {
        match told {
            ProgramEvent::ToolChange { number, name } => {
                let told_number = *number;
                if told_number != self.tool || number.is_none() {
                    let number = number.map_or(String::new(), |number| format!(" {number}"));
                    let name = name.as_ref().map_or(String::new(), |name| format!(" {name}"));
                    // A memory of offsets knows registers, and which of them is the tool's is told later.
                    let table = self.machine.tool_table.as_ref().filter(|table| !table.by_register);
                    let listed = told_number.and_then(|told| table?.entry(told, told));
                    let size = cutter([None, None], listed);
                    let outline = told_number.and_then(|told| self.base.outline(told));
                    self.marks.tool(self.came, format!("tool{number}{name}"), size, outline);
                }
                self.tool = *number;
            }
            ProgramEvent::Dwell { time, revolutions: false } => {
                self.time += time;
                self.marks.event(self.came, "dwell", format!("{time} s"));
            }
            ProgramEvent::Stop => self.marks.event(self.came, "stop", "stop"),
            ProgramEvent::Sync(mark) => {
                let text = format!("waits for channels at {mark}");
                self.marks.event(self.came, "stop", text);
            }
            ProgramEvent::OptionalStop => self.marks.event(self.came, "stop", "optional stop"),
            ProgramEvent::Head(name) => {
                let (machine, number) = axes::with_head(self.base, name);
                self.machine = machine;
                self.branch = Branch::new(machine);
                self.marks.head(self.came, name, number);
            }
            ProgramEvent::Cycle(_) => self.marks.event(self.came, "cycle", "hole"),
            _ => {}
        }
    }
}
