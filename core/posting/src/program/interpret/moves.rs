//! Points become motions: axis, feed and frame in force at each.

use nalgebra::Vector3;
use post_grammar::{Delta, GotoRun, Record};
use post_machine::kinematics::batch::{
    LANES, Lanes, VectorColumn, groups, largest, least, set_vector, vector, widely,
};

use super::readiness::EndAxis;
use super::{ClInterpreter, ModalFeed, StepSink, UnfinishedCurve};
use crate::program::limits::{MOST_COORDINATE, direction, is_near};
use crate::program::{Command, MoveFeed, ProgramStep, StraightMove};

impl ClInterpreter {
    /// A `GOTO` that neither ends a curve nor stands in a cycle: nearly all of a file.
    #[inline]
    pub(super) fn plain_goto(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
        emit: &mut impl FnMut(ProgramStep),
    ) {
        if !self.set_axis(record, axis) {
            return;
        }
        if self.due {
            self.before_move(record, emit);
        }
        let Some(tip) = self.point(record, point) else {
            return;
        };
        if let Some(pace) = self.pace(record) {
            self.arrive(tip);
            emit(ProgramStep::Move(self.motion(tip, pace)));
        }
    }

    /// The pace of moves by plain `GOTO`s, where nothing but the modal words of moves is to be settled: no curve or cycle
    /// is open, and nothing is due before the next move.
    pub(crate) fn plain_pace(&self) -> Option<MoveFeed> {
        let plain = self.pending.is_none()
            && self.cycles.in_force.is_none()
            && !self.cycles.lost
            && !self.finished
            && !self.due
            && !self.rapid
            && !self.rapid_feed
            && self.spindle.may_cut;
        match self.feed {
            Some(ModalFeed::Pace(pace)) if plain => Some(pace),
            _ => None,
        }
    }

    /// The move of a plain `GOTO` at [`Self::plain_pace`]; none, and nothing taken, if something is wrong with it.
    #[inline]
    pub(crate) fn plain_move(
        &mut self,
        values: &[f64; 6],
        has_axis: bool,
        pace: MoveFeed,
    ) -> Option<StraightMove> {
        let [x, y, z, i, j, k] = *values;
        let point = Vector3::new(x, y, z) * self.scale;
        if !is_near(point) {
            return None;
        }
        if has_axis {
            self.axis = unit_axis(Vector3::new(i, j, k))?;
        }
        self.arrive(point);
        Some(self.motion(point, pace))
    }

    /// Fills in where plain `GOTO`s at [`Self::plain_pace`] lead: [`Self::plain_move`] of each, none of which is taken.
    /// False if that is in doubt of one.
    pub(crate) fn plain_columns(
        &self,
        run: &GotoRun,
        tips: &mut VectorColumn,
        axes: &mut VectorColumn,
    ) -> bool {
        let count = run.count();
        if self.edge != Vector3::zeros() {
            return false;
        }
        let [x, y, z, i, j, k] = run.columns();
        let near = widely(
            #[inline(always)]
            || {
                let far = scaled([x, y, z], self.scale, count, tips);
                far <= MOST_COORDINATE && (!run.has_axis() || unit_axes([i, j, k], count, axes))
            },
        );
        if !near {
            return false;
        }
        if !run.has_axis() {
            for (axes, part) in axes.iter_mut().zip(&self.axis) {
                axes[1..].fill(*part);
            }
        }
        if !self.frame.is_of_part() {
            for place in 1..=count {
                let (tip, axis) = self.frame.to_part(vector(tips, place), vector(axes, place));
                set_vector(tips, place, tip);
                set_vector(axes, place, axis);
            }
        }
        true
    }

    pub(super) fn goto(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
        emit: &mut StepSink<'_>,
    ) {
        let pending = match self.pending.take() {
            Some(arc @ (UnfinishedCurve::Arc(_) | UnfinishedCurve::Turned(_))) => Some(arc),
            Some(spline) => {
                self.pending = Some(spline);
                self.end_spline(record, emit);
                None
            }
            None => None,
        };
        if self.cycles.lost {
            self.lost_hole(record, point, axis);
            return;
        }
        if pending.is_none() && self.cycles.in_force.is_none() {
            return self.plain_goto(record, point, axis, &mut |step| emit(step));
        }
        let start_axis = self.axis;
        if !self.set_axis(record, axis) {
            return;
        }
        let begins = self.due;
        self.before_move(record, emit);
        let Some(tip) = self.point(record, point) else {
            return;
        };
        if let Some(pending) = pending {
            let circle = match pending {
                UnfinishedCurve::Arc(circle) => Some(circle),
                UnfinishedCurve::Turned(arc) => self.turned(record, &arc, tip),
                UnfinishedCurve::Spline { .. } => None,
            };
            match circle {
                Some(circle) => self.arc(record, &circle, tip, start_axis, emit),
                None => self.tip = Some(tip),
            }
        } else if let Some((drill, feed)) = self.cycles.in_force
            && let Some(pace) = self.resolved(record, feed)
        {
            if !begins {
                let axis = self.frame.direction_to_part(start_axis);
                self.turn_over(EndAxis { axis, positions: false }, emit);
            }
            self.drill(record, drill, pace, tip, emit);
        }
    }

    pub(super) fn goto_edge(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: [f64; 3],
        edge: [f64; 3],
        emit: &mut StepSink<'_>,
    ) {
        match direction(Vector3::from(edge)) {
            Some(edge) => {
                self.edge = edge;
                self.goto(record, point, Some(axis), emit);
            }
            None => self.fault(
                record,
                "axis",
                "the direction of the leading edge is null".to_owned(),
                "the last three of nine numbers say where the edge points",
            ),
        }
    }

    /// Steps on from the last point.
    pub(super) fn godlta(&mut self, record: &Record<'_>, delta: &Delta, emit: &mut StepSink<'_>) {
        let Some(tip) = self.tip else {
            self.fault(
                record,
                "godlta",
                "GODLTA steps from the last point, and there is none".to_owned(),
                "put a FROM or GOTO before it",
            );
            return;
        };
        if self.cycles.in_force.is_some() {
            self.fault(
                record,
                "godlta",
                "GODLTA while a cycle is on: from which of its heights?".to_owned(),
                "put a CYCLE/OFF before it, or write GOTO",
            );
            return;
        }
        let step = match delta {
            Delta::Step(step) => Vector3::from(*step),
            Delta::AlongAxis(length) => self.axis * *length,
        };
        let point = tip / self.scale + step;
        self.goto(record, point.into(), None, emit);
    }

    /// Takes where the tool stands at the beginning (`FROM`).
    pub(super) fn starting_point(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
        emit: &mut StepSink<'_>,
    ) {
        let Some(tip) = self.point(record, point) else {
            return;
        };
        if !self.set_axis(record, axis) {
            return;
        }
        self.measured = true;
        self.tip = Some(tip);
        let (tip, axis) = self.frame.to_part(tip, self.axis);
        emit(ProgramStep::Command(Command::From { tip, axis }));
    }

    /// Goes home: to the machine's own place, or to a point of the file.
    pub(super) fn gohome(
        &mut self,
        record: &Record<'_>,
        home: Option<([f64; 3], Option<[f64; 3]>)>,
        emit: &mut StepSink<'_>,
    ) {
        self.rapid = home.is_some();
        let Some((point, axis)) = home else {
            self.tip = None;
            emit(ProgramStep::Command(Command::Home));
            return;
        };
        // A cycle does not act at home.
        let cycle = self.cycles.in_force.take();
        self.goto(record, point, axis, emit);
        self.cycles.in_force = cycle;
    }

    /// Takes the axis of a six-number point; false if it is not an axis.
    #[inline]
    pub(super) fn set_axis(&mut self, record: &Record<'_>, axis: Option<[f64; 3]>) -> bool {
        let Some(axis) = axis else {
            return true;
        };
        let axis = Vector3::from(axis);
        let Some(unit) = unit_axis(axis) else {
            let message = match axis.norm_squared() < 1e-12 {
                true => "the tool axis is null",
                false => "the tool axis has no length that a direction could have",
            };
            self.fault(
                record,
                "axis",
                message.to_owned(),
                "i, j, k are a direction, from the tip to the holder",
            );
            return false;
        };
        self.axis = unit;
        true
    }

    /// A point of the file in mm; a fault if no machine could reach it.
    #[inline]
    pub(super) fn point(&mut self, record: &Record<'_>, point: [f64; 3]) -> Option<Vector3<f64>> {
        let point = Vector3::from(point) * self.scale;
        if is_near(point) {
            return Some(point);
        }
        self.far(record, point);
        None
    }

    /// A point that no machine could reach.
    #[cold]
    fn far(&mut self, record: &Record<'_>, point: Vector3<f64>) {
        self.fault(
            record,
            "coordinate",
            format!(
                "a coordinate of {:.3e} mm: none is larger than {MOST_COORDINATE:e} mm",
                point.amax()
            ),
            "is a decimal point missing, or are the units wrong (--units)?",
        );
    }

    /// How fast the next move goes; a fault if nothing says so.
    #[inline]
    pub(super) fn pace(&mut self, record: &Record<'_>) -> Option<MoveFeed> {
        if std::mem::take(&mut self.rapid) || self.rapid_feed {
            return Some(MoveFeed::Rapid);
        }
        if self.feed.is_none() && self.tip.is_none() {
            // The first approach of a file that names no feed yet comes from the tool change.
            return Some(MoveFeed::Rapid);
        }
        let Some(feed) = self.feed.or_else(|| self.told_feed()) else {
            self.fault(
                record,
                "no-feed",
                "this move has no feed: no FEDRAT before it, and no RAPID".to_owned(),
                "the CAM system must write a FEDRAT, a list of points has the setting or the column `feed`; --feed MM_A_MINUTE is for cuts without one",
            );
            return None;
        };
        match feed {
            ModalFeed::PerRevolution(feed) if self.turns_part() => self.turned_feed(record, feed),
            feed => self.resolved(record, feed),
        }
    }

    /// Takes `tip` as where the tool stands.
    #[inline]
    pub(super) fn arrive(&mut self, tip: Vector3<f64>) {
        self.tip = Some(tip);
        self.measured = true;
        self.moved = true;
        self.tools.moved = true;
    }

    /// The motion to `tip` (frame of the file) with axis and edge in force.
    #[inline]
    pub(super) fn motion(&self, tip: Vector3<f64>, pace: MoveFeed) -> StraightMove {
        let (tip, axis) = self.frame.to_part(tip, self.axis);
        let edge = if self.edge == Vector3::zeros() {
            self.edge
        } else {
            self.frame.direction_to_part(self.edge)
        };
        StraightMove { tip, axis, edge, pace, chord: 0.0 }
    }
}

/// Scales points to mm, which are put after the first place; gives the largest coordinate, mm.
#[inline(always)]
fn scaled(points: [&Lanes; 3], scale: f64, count: usize, tips: &mut VectorColumn) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let [x, y, z] = points;
    let mut sizes = [0.0; LANES];
    for lane in 0..groups(count) {
        let tip = Vector3::new(x[lane], y[lane], z[lane]) * scale;
        sizes[lane] = larger(larger(tip.x.abs(), tip.y.abs()), tip.z.abs());
        set_vector(tips, lane + 1, tip);
    }
    largest(&sizes[..count])
}

/// [`unit_axis`] of each direction, put after the first place; false if one has none.
#[inline(always)]
fn unit_axes(directions: [&Lanes; 3], count: usize, axes: &mut VectorColumn) -> bool {
    let [i, j, k] = directions;
    let mut squares = [0.0; LANES];
    for lane in 0..groups(count) {
        let axis = Vector3::new(i[lane], j[lane], k[lane]);
        let square = axis.norm_squared();
        squares[lane] = square;
        set_vector(axes, lane + 1, unit_of(axis, square));
    }
    is_length(least(&squares[..count])) && is_length(largest(&squares[..count]))
}

/// The square of the length of a direction is not lost.
#[inline(always)]
fn is_length(square: f64) -> bool {
    (1e-12..1e18).contains(&square)
}

/// The unit vector along `axis`, the square of whose length this is.
#[inline(always)]
fn unit_of(axis: Vector3<f64>, square: f64) -> Vector3<f64> {
    axis * (1.0 / square.sqrt())
}

/// The direction of a tool axis, of any length but one whose square is lost.
#[inline]
fn unit_axis(axis: Vector3<f64>) -> Option<Vector3<f64>> {
    let square = axis.norm_squared();
    is_length(square).then(|| unit_of(axis, square))
}
