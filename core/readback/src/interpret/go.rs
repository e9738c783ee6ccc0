//! Motions: from where words lead to axis values, and to the tip and tool axis that they bring about.

use nalgebra::Vector3;
use post_machine::axis_words::is_depth;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, MAX_AXES, Pose};
use post_machine::vector_choice::{AIMED, VectorChoice};
use post_motion::path::BSpline;
use post_plugin::Language;
use std::f64::consts::TAU;

use super::feed::MotionTime;
use super::state::{AxisLetters, ControlState, FeedMeaning, OrientationMode};
use crate::{BlockEffect, Curve, Interpolation, Motion, MotionKind, Stance};

/// A tip that the axes miss by more than this is not reached, mm.
pub(super) const REACHED: f64 = 1e-6;

/// Most turns of an arc by axes that do not stand across one another: it is followed as a spline.
const MOST_LEANING: f64 = 1_000.0;

/// Where a motion goes, as words say it; what is not said stays.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MotionTarget {
    /// Coordinates X, Y, Z of the program, mm.
    pub point: [Option<f64>; 3],
    /// Values of further axes: mm and radians counted from the drawing's zeros, by place in the chain.
    pub joints: Joints,
    /// Bits of the places of `joints` that are said.
    pub said: u32,
    /// Bits of the places of axes whose words are ways from where they stood (G91).
    pub ways: u32,
    /// The tool axis, in the coordinates of the program; need not be a unit vector.
    pub vector: Option<Vector3<f64>>,
}

impl MotionTarget {
    /// A point of the program, all three coordinates, mm.
    pub fn point(point: Vector3<f64>) -> Self {
        Self { point: [Some(point.x), Some(point.y), Some(point.z)], ..Self::default() }
    }

    /// Says the value of an axis.
    #[inline]
    pub fn say(&mut self, place: usize, value: f64) {
        self.joints[place] = value;
        self.said |= 1 << place;
    }
}

/// The tip straight, as the control keeps it.
const STRAIGHT: Interpolation = Interpolation::Tip(Curve::Straight);

impl ControlState {
    /// Where the tool stands in the coordinates of the program: what the control shows for X, Y, Z, mm. Of a machine
    /// that lacks one of those axes, zero for it.
    #[inline]
    pub fn point(&self) -> Vector3<f64> {
        if self.tip_words() {
            return self.to_part.inside(self.at.pose.tip);
        }
        let axes = self.axes.cartesian;
        let point = Vector3::from_fn(|row, _| {
            axes[row].map_or(0.0, |place| self.at.joints[place] - self.zero[place])
        });
        self.to_work.inside(point)
    }

    /// Goes straight to a point of the program, mm; rotary axes stay. It says of no axis where it stands.
    pub fn straight(
        &mut self,
        kind: MotionKind,
        point: Vector3<f64>,
    ) -> Result<(), Box<Diagnostic>> {
        self.lead(kind, &Curve::Straight, &MotionTarget::point(point))
    }

    /// Goes to `target`, which the words of the program say.
    #[inline]
    pub fn go(
        &mut self,
        kind: MotionKind,
        path: &Curve,
        target: &MotionTarget,
    ) -> Result<(), Box<Diagnostic>> {
        self.says(target);
        self.lead(kind, path, target)
    }

    /// Goes to `target`.
    #[inline]
    fn lead(
        &mut self,
        kind: MotionKind,
        path: &Curve,
        target: &MotionTarget,
    ) -> Result<(), Box<Diagnostic>> {
        if self.face.is_some() {
            return self.lead_on_face(kind, path, target);
        }
        if self.state.wrap.is_some() {
            self.straight_on_mantle(kind, path, target)?;
        }
        let from = self.at;
        let tips = self.tip_words();
        if let Some(vector) = target.vector {
            self.aim(target, vector)?;
        } else if tips {
            self.reach_tip(target)?;
        } else {
            self.reach_axes(target);
        }
        let way = match path {
            Curve::Straight if target.vector.is_some() => match self.modal.orientation {
                OrientationMode::Axes => STRAIGHT,
                OrientationMode::Usual | OrientationMode::Circle => Interpolation::TipAndAxis,
            },
            Curve::Straight => self.straight_way(),
            Curve::Arc { centre, normal, sweep } => {
                Interpolation::Tip(self.arc(&from, *centre, *normal, *sweep)?)
            }
            Curve::Spline(way) => Interpolation::Tip(self.spline_way(&from, way)),
        };
        self.moved(kind, way, from);
        Ok(())
    }

    /// How the control goes straight by words of axes.
    #[inline]
    pub(super) fn straight_way(&self) -> Interpolation {
        match self.modal.orientation {
            OrientationMode::Circle if self.state.tcp => Interpolation::TipAndAxis,
            _ if self.state.tcp => STRAIGHT,
            _ => Interpolation::Axes,
        }
    }

    /// Remembers which axes the program has led somewhere: a way from where nobody knows leads nowhere that is known.
    fn says(&mut self, target: &MotionTarget) {
        let mut said = target.said;
        for (row, place) in self.axes.cartesian.iter().enumerate() {
            if let (Some(_), Some(place)) = (target.point[row], place) {
                said |= 1 << place;
            }
        }
        if target.vector.is_some() {
            said |= self.axes.rotary;
        }
        self.said |= said & !target.ways;
    }

    /// The depth of a cycle says where the axis stands that the tool is fed along.
    pub fn says_depth(&mut self, row: usize) {
        if let Some(place) = self.axes.cartesian[row] {
            self.said |= 1 << place;
        }
    }

    /// Names of the axes, rotary or linear ones, that were led nowhere; empty if there is none.
    fn unsaid_axes(&self, rotary: bool) -> String {
        let axes = self.machine.axes.iter().enumerate();
        let unsaid = axes
            .filter(|(place, axis)| axis.joint.rotary == rotary && self.said & (1 << place) == 0);
        let mut names: Vec<&str> = unsaid.map(|(_, axis)| axis.name.as_str()).collect();
        names.sort_unstable();
        names.join(", ")
    }

    /// A rapid ahead of the first motion at feed: does the depth move while the tool is nobody knows where over the part?
    #[cold]
    fn look_where_it_comes_down(&mut self, from: &Stance) {
        let deeper = |place: usize| {
            self.at.joints[place] != from.joints[place] && is_depth(&self.machine, place)
        };
        if self.in_machine || !(0..self.machine.axes.len()).any(deeper) {
            return;
        }
        let unsaid = [false, true].map(|rotary| self.unsaid_axes(rotary));
        let unsaid: Vec<&str> = unsaid.iter().map(String::as_str).collect();
        let unsaid: Vec<&str> = unsaid.into_iter().filter(|names| !names.is_empty()).collect();
        if !unsaid.is_empty() {
            self.report.blind.get_or_insert((self.line, unsaid.join(", ")));
        }
    }

    /// The first motion at feed: have all axes been led somewhere?
    #[cold]
    fn look_where_it_begins(&mut self) {
        self.fed = true;
        let (linear, rotary) = (self.unsaid_axes(false), self.unsaid_axes(true));
        let line = self.line;
        if !linear.is_empty() {
            self.report.unsaid.get_or_insert((line, linear));
        }
        if !rotary.is_empty() {
            self.report.unturned.get_or_insert((line, rotary));
        }
    }

    /// Brings the axes to `joints` (mm and radians from the drawing's zeros), all linearly: the turn to a tilted plane.
    pub fn go_joints(&mut self, kind: MotionKind, joints: &Joints) {
        let from = self.at;
        self.stand(joints);
        self.moved(kind, Interpolation::Axes, from);
    }

    /// Turns the rotary axes to `joints` while the tip stays on its place: `PLANE … MOVE`.
    pub fn turn_about_tip(
        &mut self,
        kind: MotionKind,
        joints: &Joints,
    ) -> Result<(), Box<Diagnostic>> {
        let from = self.at;
        let tip = self.at.pose.tip;
        for (place, joint) in joints.iter().enumerate() {
            if self.axes.rotary & (1 << place) != 0 {
                self.at.joints[place] = *joint;
            }
        }
        self.place(tip, self.axes.rotary)?;
        self.moved(kind, STRAIGHT, from);
        Ok(())
    }

    /// Axis positions: words count from the work offset, axis by axis.
    #[inline]
    fn reach_axes(&mut self, target: &MotionTarget) {
        let axes = self.axes.cartesian;
        let told = target.point.iter().any(Option::is_some);
        if self.to_work.upright() {
            let origin = self.to_work.origin;
            for row in 0..3 {
                if let (Some(value), Some(place)) = (target.point[row], axes[row]) {
                    self.at.joints[place] = self.zero[place] + (origin[row] + value);
                }
            }
        } else if told {
            let point = self.to_work.out(told_over(self.point(), &target.point));
            for (value, place) in point.iter().zip(axes) {
                if let Some(place) = place {
                    self.at.joints[place] = self.zero[place] + value;
                }
            }
        }
        let turned = self.take_said(target) | self.turned_by_length();
        self.follow(turned);
    }

    /// The tip: linear words are its coordinates, the linear axes follow.
    #[inline]
    fn reach_tip(&mut self, target: &MotionTarget) -> Result<(), Box<Diagnostic>> {
        let told = target.point.iter().any(Option::is_some);
        if !told && !self.state.tcp {
            // In a tilted plane alone nothing keeps the tip while a rotary axis turns.
            let turned = self.take_said(target);
            self.follow(turned);
            return Ok(());
        }
        let tip = if told {
            self.to_part.out(told_over(self.point(), &target.point))
        } else {
            self.at.pose.tip
        };
        let turned = self.take_said(target);
        self.place(tip, turned)?;
        if !self.state.tcp && !super::planes::upright(self) {
            let message = "the tool does not stand upright on the tilted plane in force: where words of the plane lead then hangs on the control";
            let finding = Diagnostic::error("nc-plane", message);
            let help = "turn the axes to the plane first, by G53.1, TURN, or their words";
            return Err(self.placed(finding.help(help)).boxed());
        }
        Ok(())
    }

    /// Takes the axes that `target` says; the places of the rotary ones among them, as bits.
    #[inline]
    fn take_said(&mut self, target: &MotionTarget) -> u32 {
        if self.axes.coupled.is_some() {
            let mut joints = self.at.joints;
            let said = |place: &usize| target.said >> place & 1 == 1;
            (0..MAX_AXES).filter(said).for_each(|place| joints[place] = target.joints[place]);
            self.uncouple(&mut joints, target.said);
            self.at.joints = joints;
            return self.axes.rotary;
        }
        let mut said = target.said;
        while said != 0 {
            let place = (said.trailing_zeros() as usize).min(MAX_AXES - 1);
            self.at.joints[place] = target.joints[place];
            said &= said - 1;
        }
        target.said & self.axes.rotary
    }

    /// The word of an axis where it stands, counted from the drawing's zero, mm or radians: its value, but of words that
    /// hold several axes.
    pub(super) fn word_at(&self, place: usize) -> f64 {
        match &self.axes.coupled {
            Some(map) => map.words(&self.shown_joints())[place] - self.machine.axes[place].zero,
            None => self.at.joints[place],
        }
    }

    /// What the control would show of each axis, mm and radians, if its word were its value.
    fn shown_joints(&self) -> Joints {
        let mut shown = self.at.joints;
        for (shown, axis) in shown.iter_mut().zip(&self.machine.axes) {
            *shown += axis.zero;
        }
        shown
    }

    /// Makes axis values of words that hold several axes: `joints` has the words that are `said`, counted from the
    /// drawing's zero, and the other words stay.
    pub(super) fn uncouple(&self, joints: &mut Joints, said: u32) {
        let Some(map) = &self.axes.coupled else {
            return;
        };
        let mut words = map.words(&self.shown_joints());
        for (place, axis) in self.machine.axes.iter().enumerate() {
            if said >> place & 1 == 1 && map.is_coupled(place) {
                words[place] = joints[place] + axis.zero;
            }
        }
        let shown = map.values(&words);
        for (place, axis) in self.machine.axes.iter().enumerate() {
            if map.is_coupled(place) {
                joints[place] = shown[place] - axis.zero;
            }
        }
    }

    /// Where the tool is with the joints as they are; those at the bits of `turned` have turned.
    #[inline]
    fn follow(&mut self, turned: u32) {
        let Stance { joints, pose } = &mut self.at;
        let chain = self.state.solver.chain();
        chain.turn_anew(joints, turned, &mut self.turns);
        *pose = chain.pose(joints, &self.turns);
    }

    /// Brings the tip onto `tip` (mm, part frame) with the rotary axes where they are; those at the bits of `turned`
    /// have turned.
    #[inline]
    fn place(&mut self, tip: Vector3<f64>, turned: u32) -> Result<(), Box<Diagnostic>> {
        let solver = &self.state.solver;
        let (joints, turns) = (&mut self.at.joints, &mut self.turns);
        solver.chain().turn_anew(joints, turned, turns);
        if solver.place(tip, joints, turns).is_err() {
            return Err(self.refuse(
                "nc-reach",
                "the linear axes cannot bring the tip there with the rotary axes so",
            ));
        }
        self.at.pose = solver.chain().pose(joints, turns);
        if (self.at.pose.tip - tip).norm() > REACHED {
            return Err(self.refuse(
                "nc-reach",
                format!("the axes miss the point by {:.4} mm", (self.at.pose.tip - tip).norm()),
            ));
        }
        // The word is what the control keeps: nothing adds up over blocks that do not say a coordinate.
        self.at.pose.tip = tip;
        Ok(())
    }

    /// Points the tool along `vector` and brings the tip onto the target: of the ways to do so the one next to where
    /// the axes stand.
    fn aim(&mut self, target: &MotionTarget, vector: Vector3<f64>) -> Result<(), Box<Diagnostic>> {
        let axis = self.to_part.out_direction(vector).try_normalize(1e-9);
        let Some(axis) = axis else {
            return Err(self.refuse("nc-vector", "the vector of the tool axis has no length"));
        };
        let tip = self.to_part.out(told_over(self.point(), &target.point));
        self.take_said(target);
        let pose = Pose { tip, axis, edge: Vector3::zeros() };
        let last = self.at.joints;
        let cannot = || {
            let [x, y, z] = [vector.x, vector.y, vector.z];
            self.refuse(
                "nc-vector",
                format!("the axes cannot point the tool along ({x}, {y}, {z})"),
            )
        };
        let found = self.state.solver.inverse(&pose, &last, AIMED).map_err(|_| cannot())?;
        let taken = VectorChoice::of(&self.machine).taken(&found, &last);
        let Some(joints) = taken else {
            return Err(cannot());
        };
        if found.len() > 1 {
            self.say_nearest();
        }
        self.at.joints = joints;
        self.place(tip, self.axes.rotary)?;
        if self.at.pose.axis.cross(&axis).norm() > 2.0 * AIMED || self.at.pose.axis.dot(&axis) < 0.0
        {
            return Err(self.refuse(
                "nc-vector",
                "an axis that is not solved for stands so that the tool cannot be pointed",
            ));
        }
        Ok(())
    }

    /// A vector leaves the control the choice.
    #[cold]
    fn say_nearest(&mut self) {
        let message = "where the axes can stand in several ways along a vector, the control is taken to choose the nearest";
        self.note(Diagnostic::warning("nc-vector", message));
    }

    /// An arc of the program's coordinates as one of the part frame.
    fn arc(
        &self,
        from: &Stance,
        centre: Vector3<f64>,
        normal: Vector3<f64>,
        sweep: f64,
    ) -> Result<Curve, Box<Diagnostic>> {
        if self.tip_words() {
            return Ok(Curve::Arc {
                centre: self.to_part.out(centre),
                normal: self.to_part.out_direction(normal),
                sweep,
            });
        }
        // Axis positions lie as the axes do: seen from the part they are turned by the rotary axes, which stand still.
        let [Some(x), Some(y), Some(z)] = self.axes.cartesian else {
            return Err(self.refuse("nc-arc", "an arc needs the axes X, Y and Z"));
        };
        let turned = (0..self.machine.axes.len()).any(|place| {
            self.axes.rotary & (1 << place) != 0 && self.at.joints[place] != from.joints[place]
        });
        if turned {
            return Err(self.refuse(
                "nc-arc",
                "a rotary axis turns along an arc of axis positions: the tip then goes on no arc, and this is not followed",
            ));
        }
        let chain = self.state.solver.chain();
        let ways = [x, y, z].map(|place| chain.way_of(place, &from.joints));
        let across = [(0, 1), (1, 2), (2, 0)]
            .iter()
            .all(|(a, b)| libm::fabs(ways[*a].dot(&ways[*b])) < 1e-9);
        if !across {
            if libm::fabs(sweep) > MOST_LEANING * TAU {
                let message = format!(
                    "X, Y and Z of this machine do not stand across one another, and the arc has more than {MOST_LEANING} turns"
                );
                return Err(self.refuse("nc-arc", message));
            }
            // The control keeps to the circle in its words, and the tip to what the axes make of it.
            let ends = [from, &self.at].map(|stance| self.program_point_of(&stance.joints));
            return Ok(self.spline_way(from, &BSpline::of_arc(ends, centre, normal, sweep)));
        }
        let direction =
            |vector: Vector3<f64>| ways[0] * vector.x + ways[1] * vector.y + ways[2] * vector.z;
        let start = self.program_point_of(&from.joints);
        let [first, second, third] = [0, 1, 2].map(|row| ways[row]);
        // Where the three axes make a left-handed frame, a turn is seen from behind.
        let handed = if first.cross(&second).dot(&third) < 0.0 { -1.0 } else { 1.0 };
        Ok(Curve::Arc {
            centre: from.pose.tip + direction(self.to_work.out_direction(centre - start)),
            normal: direction(self.to_work.out_direction(normal)),
            sweep: sweep * handed,
        })
    }

    /// The coordinates of the program at `joints`, where the words are axis positions.
    fn program_point_of(&self, joints: &Joints) -> Vector3<f64> {
        let axes = self.axes.cartesian;
        let point = Vector3::from_fn(|row, _| {
            axes[row].map_or(0.0, |place| joints[place] - self.zero[place])
        });
        self.to_work.inside(point)
    }

    /// Hands on the motion from `from` to where the machine stands now; none if it is the same place.
    #[inline]
    pub fn moved(&mut self, kind: MotionKind, way: Interpolation, from: Stance) {
        if from.joints == self.at.joints && !way.is_curved() {
            return;
        }
        if !self.fed {
            match kind {
                MotionKind::Rapid => self.look_where_it_comes_down(&from),
                MotionKind::Feed | MotionKind::Thread => self.look_where_it_begins(),
            }
        }
        let MotionTime { feed, minutes, at_fastest } = self.timed(kind, &way, &from, &self.at);
        let state = self.hand_on_state();
        self.done.push(BlockEffect::Motion(Motion {
            line: self.line,
            number: self.number,
            kind,
            way,
            from,
            to: self.at,
            feed,
            rapid_feed: match self.modal.feed {
                Some(feed) if kind == MotionKind::Rapid && self.lexicon.rapids_at_feed() => feed,
                _ => 0.0,
            },
            minutes,
            minutes_at_fastest: at_fastest,
            by_time: kind == MotionKind::Feed
                && self.modal.feed_mode == FeedMeaning::Inverse
                && self.lexicon.language() != Language::Joints,
            stops: self.exact_stop,
            hole: self.hole,
            machine: self.in_machine,
            led: self.led,
            fast: false,
            along: None,
            state,
        }));
    }

    /// The value to which the axis at `place` goes for a word, and the way it takes.
    ///
    /// `value` is counted from the drawing's zero, mm or radians. An axis whose display goes round turns the shorter
    /// way.
    #[inline]
    pub fn turned(&self, place: usize, value: f64) -> f64 {
        self.turned_from(place, value, self.word_at(place))
    }

    /// [`ControlState::turned`] of an axis that stands at `last`.
    #[inline]
    pub fn turned_from(&self, place: usize, value: f64, last: f64) -> f64 {
        self.turned_counting(place, value, last, self.zero[place])
    }

    /// [`ControlState::turned_from`] where the word counts from `zero`, mm or radians.
    #[inline]
    pub fn turned_counting(&self, place: usize, value: f64, last: f64, zero: f64) -> f64 {
        let axis = &self.machine.axes[place];
        if !axis.joint.rotary {
            return value;
        }
        if axis.signed && self.modal.shortest.is_none() {
            return zero + by_sign(value - zero, last - zero);
        }
        let shortest = self.modal.shortest.unwrap_or(axis.range.is_some());
        if !shortest {
            return value;
        }
        shorter(value, last)
    }

    /// The letter's axis, if it is one.
    #[inline]
    pub fn axis_of(&self, letter: u8) -> Option<usize> {
        let place = self.axes.letters[usize::from(letter.wrapping_sub(b'A')) % 26];
        (place != AxisLetters::NONE).then_some(usize::from(place))
    }
}

/// `point` with the coordinates that are said.
#[inline]
pub(super) fn told_over(point: Vector3<f64>, said: &[Option<f64>; 3]) -> Vector3<f64> {
    Vector3::from_fn(|row, _| said[row].unwrap_or(point[row]))
}

/// The place of `value` on the circle that is the shorter way from `last`, radians; half a turn goes up.
pub(super) fn shorter(value: f64, last: f64) -> f64 {
    let way = value - last;
    if libm::fabs(way) < 3.0 {
        // As below with no turn; of a zero it takes the sign.
        return value + 0.0;
    }
    let turns = libm::ceil(way / TAU - 0.5 - 1e-12);
    value - turns * TAU
}

/// The place of `value` on the circle, its sign being the way there from `last`: radians; none where it is there already.
fn by_sign(value: f64, last: f64) -> f64 {
    let place = libm::fabs(value);
    let turns = (last - place) / TAU;
    // A place that is left and come back to is the same but for the last bits.
    let near = libm::rint(turns);
    if libm::fabs(turns - near) < 1e-9 {
        return place + near * TAU;
    }
    let turns = if value.is_sign_negative() { libm::floor(turns) } else { libm::ceil(turns) };
    place + turns * TAU
}
