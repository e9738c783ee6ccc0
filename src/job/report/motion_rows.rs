//! The motions of a program that is read back, row by row, and what others have found out about its lines.

use std::collections::VecDeque;
use std::fs::File;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_motion::path::Way;
use post_readback::interpret::Interpreter;
use post_readback::{Done, Motion, MotionKind, Told};
use post_report::meta::{AxisUsed, Event, Meta};
use post_report::table::{Column, TableWriter};

use super::block_rows::{MOST_EVENTS, decimals, packed, pose_columns};
use super::cl_window::ClWindow;
use super::derived::{DECIMALS, Derived};
use super::parts::{Parts, fault};
use super::path_rows::PathRows;
use crate::failure::Failure;
use crate::files::Scratch;

/// A line that somebody tells of is looked for so many motions ahead.
const AHEAD: usize = 4096;

/// So many blocks that cannot be read are passed over: whoever reads the program for its own sake tells of them.
const MOST_FAULTS: u32 = 100;

/// Places on a curve at most.
const MOST_PLACES: f64 = 512.0;

/// What is known of a line of the program besides what it does.
#[derive(Clone, Debug, Default)]
pub struct Heard {
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
pub struct Besides {
    /// The program is held against a CL file.
    pub deviations: bool,
    /// It is predicted.
    pub predicted: bool,
}

/// A row that waits for what is known of its line.
struct Waiting {
    nc: u64,
    kind: MotionKind,
    values: Vec<f64>,
    /// The tip at the end, and as it is packed.
    tips: [Vector3<f64>; 2],
    places: Vec<Vector3<f64>>,
}

/// Reads a program and packs a row of each motion.
pub struct MotionRows<'m> {
    machine: &'m Machine,
    program: Interpreter<File>,
    besides: Besides,
    table: TableWriter<Scratch>,
    path: PathRows,
    derived: Derived<'m>,
    /// End of the row before, s.
    end: f64,
    cl: Option<ClWindow>,
    /// Line of the CL file of the row before.
    last_cl: u64,
    waiting: VecDeque<Waiting>,
    done: Vec<Done>,
    came: u64,
    time: f64,
    operation: String,
    tool: Option<u32>,
    length: Option<f64>,
    limits: Vec<String>,
    events: Vec<Event>,
    left_out: u64,
    /// First row of each line that is largest in something, and what: tip, axis, contour error.
    largest: [(f64, u64, u64); 3],
    faults: u32,
    ended: bool,
    fault: Option<Failure>,
    used: Vec<AxisUsed>,
}

impl<'m> MotionRows<'m> {
    /// Of a program at its beginning; `cl` is the path that it is held against.
    ///
    /// # Errors
    /// There is no place for the rows.
    pub fn new(
        machine: &'m Machine,
        program: Interpreter<File>,
        cl: Option<ClWindow>,
        besides: Besides,
    ) -> Result<Self, Failure> {
        let accuracy = &machine.accuracy;
        let mut columns = vec![
            Column::new("nc", "", 0),
            Column::new("t0", "s", 4).from("t1"),
            Column::new("t1", "s", 4),
            Column::new("kind", "", 0),
        ];
        for axis in &machine.axes {
            let (unit, decimals) = match axis.joint.rotary {
                true => ("deg", DECIMALS[1]),
                false => ("mm", DECIMALS[0]),
            };
            columns.push(Column::new(format!("q.{}", axis.name), unit, decimals));
        }
        let derived = Derived::new(machine);
        columns.extend(pose_columns(derived.is_known()));
        columns.extend([
            Column::new("feed", "mm/min", 1),
            Column::new("tool_length", "mm", 4),
            Column::new("cl", "", 0),
            Column::new("limit", "", 0),
        ]);
        if besides.deviations {
            let turn = accuracy.axis_tolerance.to_degrees();
            columns.extend([
                Column::new("deviation", "mm", decimals(accuracy.tolerance)),
                Column::new("axis_deviation", "deg", decimals(turn)),
                Column::new("tolerance", "mm", 6),
            ]);
        }
        if besides.predicted {
            columns.push(Column::new("contour", "mm", decimals(accuracy.tolerance)));
            for (letter, units) in [("v", ["mm/s", "deg/s"]), ("a", ["mm/s²", "deg/s²"])] {
                for axis in &machine.axes {
                    let unit = units[usize::from(axis.joint.rotary)];
                    columns.push(Column::new(format!("{letter}.{}", axis.name), unit, 3));
                }
            }
        }
        Ok(Self {
            machine,
            program,
            besides,
            table: TableWriter::new("blocks", columns, Parts::scratch()?),
            path: PathRows::new(machine)?,
            derived,
            end: 0.0,
            cl,
            last_cl: 0,
            waiting: VecDeque::new(),
            done: Vec::new(),
            came: 0,
            time: 0.0,
            operation: String::new(),
            tool: None,
            length: None,
            limits: Vec::new(),
            events: Vec::new(),
            left_out: 0,
            largest: [(0.0, 0, 0); 3],
            faults: 0,
            ended: false,
            fault: None,
            used: Vec::new(),
        })
    }

    /// Rows of all motions to the end of `line` get what was heard of it; those before it that nobody told of stay as they
    /// are.
    pub fn hear(&mut self, line: u64, heard: &Heard) {
        let at = |waiting: &VecDeque<Waiting>| waiting.iter().position(|row| row.nc == line);
        let mut place = at(&self.waiting);
        while place.is_none() && !self.ended && self.waiting.len() < AHEAD {
            self.read();
            place = at(&self.waiting);
        }
        let Some(place) = place else {
            return;
        };
        for _ in 0..place {
            self.write(None);
        }
        // All motions of the line: a hole has many.
        loop {
            while self.waiting.len() < 2 && !self.ended {
                self.read();
            }
            match self.waiting.front() {
                Some(first) if first.nc == line => self.write(Some(heard)),
                _ => return,
            }
        }
    }

    /// Reads the rest; the tables go to `parts`, and what was seen to `meta`, whose maxima learn their rows.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn finish(mut self, parts: &mut Parts, meta: &mut Meta) -> Result<(), Failure> {
        loop {
            while self.waiting.is_empty() && !self.ended {
                self.read();
            }
            if self.waiting.is_empty() {
                break;
            }
            self.write(None);
        }
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        if let Some(cl) = self.cl {
            cl.finish(parts)?;
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
        meta.events = self.events;
        meta.events_left_out = self.left_out;
        meta.tool_length = self.length.unwrap_or(0.0);
        parts.table(self.table)
    }

    fn read(&mut self) {
        let mut done = std::mem::take(&mut self.done);
        done.clear();
        match self.program.next(&mut done) {
            Ok(true) => {}
            Ok(false) => self.ended = true,
            Err(_) => {
                self.faults += 1;
                self.ended = self.faults > MOST_FAULTS;
            }
        }
        for next in &done {
            match next {
                Done::Motion(motion) => self.motion(motion),
                Done::Told { told, .. } => self.told(told),
                Done::State(state) => {
                    let operation = state.operation.as_deref().unwrap_or_default();
                    if operation != self.operation {
                        self.operation = operation.to_owned();
                        self.event("operation", operation.to_owned());
                    }
                }
            }
        }
        self.done = done;
    }

    fn motion(&mut self, motion: &Motion) {
        let from = self.time;
        self.time += motion.minutes * 60.0;
        let kind = match (motion.hole, motion.kind, &motion.way) {
            (true, ..) => 6,
            (_, MotionKind::Rapid, _) => 2,
            (_, _, Way::Arc { .. }) => 4,
            (_, _, Way::Spline(_)) => 5,
            _ => 3,
        };
        let mut values = vec![motion.line as f64, from, self.time, f64::from(kind)];
        let axes = self.machine.axes.iter().zip(&motion.to.joints);
        values.extend(axes.map(|(axis, value)| axis.reading(*value)));
        // The chain has the tool in it: where the gauge point is, is the same with every tool.
        let tip = motion.state.solver.chain().tip();
        let length = (self.machine.gauge - tip).dot(&self.machine.tool_axis);
        self.length.get_or_insert(length);
        let pose = motion.to.pose;
        let derived = self.derived.pose(&motion.to.joints, length);
        let [left, axis] = match derived {
            Some([tip, axis]) => [pose.tip - tip, pose.axis - axis],
            None => [pose.tip, pose.axis],
        };
        let end = derived.map_or_else(Vector3::zeros, |[tip, _]| tip) + left.map(packed);
        self.derived.check(self.came, &motion.to.joints, length);
        values.extend(left.iter());
        values.extend(axis.iter());
        values.extend([motion.feed, length]);
        self.waiting.push_back(Waiting {
            nc: motion.line,
            kind: motion.kind,
            values,
            tips: [pose.tip, end],
            places: self.places(motion),
        });
        self.came += 1;
        self.cover(motion);
    }

    /// The axes come to both ends of a motion.
    fn cover(&mut self, motion: &Motion) {
        if self.used.is_empty() {
            let axes = self.machine.axes.iter();
            let used = axes.map(|axis| AxisUsed {
                name: axis.name.clone(),
                unit: axis.unit_name(),
                min: f64::INFINITY,
                max: f64::NEG_INFINITY,
                travel: axis
                    .travel
                    .map(|travel| travel.map(|end| axis.reading(end))),
                way: Some(0.0),
            });
            self.used = used.collect();
        }
        let ends = motion.from.joints.iter().zip(&motion.to.joints);
        let axes = self.used.iter_mut().zip(&self.machine.axes);
        for ((used, axis), (from, to)) in axes.zip(ends) {
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
    fn places(&self, motion: &Motion) -> Vec<Vector3<f64>> {
        let tolerance = self.machine.accuracy.tolerance;
        let [from, to] = [motion.from.pose.tip, motion.to.pose.tip];
        let count = match &motion.way {
            Way::Axes => {
                let bow = (motion.at(0.5).tip - 0.5 * (from + to)).norm();
                if bow > tolerance / 50.0 { 2 } else { 1 }
            }
            Way::Tip | Way::TipAndAxis => 1,
            Way::Arc { centre, sweep, .. } => {
                let radius = (from - centre).norm().max(tolerance);
                let step = libm::sqrt(8.0 * tolerance / radius);
                libm::ceil(libm::fabs(*sweep) / step).clamp(2.0, MOST_PLACES) as u32
            }
            Way::Spline(way) => (16 * way.spans().count() as u32).min(MOST_PLACES as u32),
        };
        (1..count)
            .map(|place| motion.at(f64::from(place) / f64::from(count)).tip)
            .collect()
    }

    /// Packs the first row that waits.
    fn write(&mut self, heard: Option<&Heard>) {
        let Some(Waiting {
            nc,
            kind,
            mut values,
            tips: [tip, end],
            places,
        }) = self.waiting.pop_front()
        else {
            return;
        };
        let none = Heard::default();
        let heard = heard.unwrap_or(&none);
        let row = self.table.rows();
        if let Some([from, to]) = heard.times {
            (values[1], values[2]) = (from, to);
        }
        let from = packed(values[1]) - packed(self.end);
        self.end = values[2];
        values[1] = from;
        let limit = heard.limit.as_deref();
        let limit = limit.map_or(-1.0, |limit| self.limit(limit));
        values.extend([heard.cl as f64, limit]);
        let accuracy = &self.machine.accuracy;
        if self.besides.deviations {
            values.extend(heard.deviation);
            values.push(match kind {
                MotionKind::Rapid => accuracy.rapid_tolerance,
                _ => accuracy.tolerance,
            });
        }
        if self.besides.predicted {
            values.push(heard.contour);
            for peaks in &heard.peaks {
                let axes = self.machine.axes.iter().zip(peaks);
                values.extend(axes.map(|(axis, peak)| peak / axis.unit()));
            }
        }
        let off = |cl: &Option<ClWindow>, tip| match heard.cl {
            0 => None,
            _ => cl.as_ref().and_then(|cl| cl.off(tip)),
        };
        if let (Some(cl), true) = (&mut self.cl, heard.cl > 0) {
            cl.advance(heard.cl);
            cl.forget(self.last_cl.min(heard.cl));
            self.last_cl = heard.cl;
        }
        let places: Vec<_> = places
            .into_iter()
            .chain([tip])
            .map(|place| (place, off(&self.cl, place)))
            .collect();
        self.path.block(row, end, &places);
        if kind != MotionKind::Rapid {
            let [tip, axis] = heard.deviation;
            for (largest, value) in self.largest.iter_mut().zip([tip, axis, heard.contour]) {
                if value > largest.0 {
                    *largest = (value, row, nc);
                }
            }
        }
        if let Err(error) = self.table.row(&values) {
            self.fault.get_or_insert(fault(error));
        }
    }

    fn limit(&mut self, name: &str) -> f64 {
        let known = self.limits.iter().position(|limit| limit == name);
        let place = known.unwrap_or_else(|| {
            self.limits.push(name.to_owned());
            self.limits.len() - 1
        });
        place as f64
    }

    fn told(&mut self, told: &Told) {
        match told {
            Told::ToolChange { number, name } => {
                if *number != self.tool || number.is_none() {
                    let number = number.map_or(String::new(), |number| format!(" {number}"));
                    let name = name
                        .as_ref()
                        .map_or(String::new(), |name| format!(" {name}"));
                    self.event("tool", format!("tool{number}{name}"));
                }
                self.tool = *number;
            }
            Told::Dwell {
                time,
                revolutions: false,
            } => {
                self.time += time;
                self.event("dwell", format!("{time} s"));
            }
            Told::Stop => self.event("stop", "stop".to_owned()),
            Told::OptionalStop => self.event("stop", "optional stop".to_owned()),
            Told::Head(name) => self.event("head", format!("head {name}")),
            Told::Cycle(_) => self.event("cycle", "hole".to_owned()),
            _ => {}
        }
    }

    fn event(&mut self, kind: &'static str, text: String) {
        let row = self.came;
        if self.events.len() < MOST_EVENTS {
            self.events.push(Event { row, kind, text });
        } else {
            self.left_out += 1;
        }
    }
}

/// The path of a program as the table that else has the path of a CL file, for who compares two programs.
///
/// # Errors
/// It could not be kept.
pub fn path_table(mut program: Interpreter<File>, parts: &mut Parts) -> Result<(), Failure> {
    let mut table = TableWriter::new("cl", ClWindow::columns(), Parts::scratch()?);
    let mut done = Vec::new();
    let mut faults = 0;
    let mut last: Option<Vector3<f64>> = None;
    while faults <= MOST_FAULTS {
        done.clear();
        match program.next(&mut done) {
            Ok(true) => {}
            Ok(false) => break,
            Err(_) => faults += 1,
        }
        for next in &done {
            let Done::Motion(motion) = next else {
                continue;
            };
            let line = motion.line as f64;
            let mut point = |tip: Vector3<f64>, rapid: f64| {
                table
                    .row(&[line, tip.x, tip.y, tip.z, rapid])
                    .map_err(fault)
            };
            let from = motion.from.pose.tip;
            if last.is_none_or(|last| (last - from).norm() > 1e-6) {
                point(from, 2.0)?;
            }
            let rapid = match motion.kind {
                MotionKind::Rapid => 1.0,
                _ => 0.0,
            };
            let chords = match &motion.way {
                Way::Arc { .. } | Way::Spline(_) => 64,
                _ => motion.pieces(CHORD, 1.0).min(64),
            };
            for chord in 1..chords {
                point(motion.at(chord as f64 / chords as f64).tip, rapid)?;
            }
            point(motion.to.pose.tip, rapid)?;
            last = Some(motion.to.pose.tip);
        }
    }
    parts.table(table)
}

/// How far chords of a path may stray that is only looked at, mm.
const CHORD: f64 = 0.001;
