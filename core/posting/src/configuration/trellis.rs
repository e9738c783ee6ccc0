//! The trellis of a path: at each point every way to stand there, and between neighbouring points every way to
//! go on. What has cost least so far is kept for each state (Viterbi), so that the cheapest path through all of
//! them is known at every point.

use super::cost::PathCost;
use super::cycle_time::{DriveLimits, PathClock};
use super::lattice::MOST_OF_LATTICE;
use super::metric::TravelMeasure;
use super::solution::{AxisSolution, ChoiceAxes, SolutionSummary};
use super::surplus::{ALONG, HEADING};
use crate::accuracy::{PathNode, Placer};
use crate::program::{MoveFeed, StraightMove};
use post_machine::description::{Machine, Pole, SHARE_AT_POLES};
use post_machine::kinematics::orientation::{Branches, angle};
use post_machine::kinematics::{Joints, Pose, Unreachable};

/// One point of the path with the ways to stand there.
#[derive(Clone, Debug)]
pub(crate) struct TrellisLayer {
    /// Line of the CL file.
    pub line: u64,
    /// The move that ends here.
    pub motion: StraightMove,
    pub kind: ArrivalKind,
    /// Which placer solves it.
    pub setting: usize,
    /// First of its states.
    pub first: usize,
    pub count: usize,
    /// Sine and cosine of the angle between the tool axis and the pole.
    pub latitude: (f64, f64),
}

/// How the tool arrives at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ArrivalKind {
    /// Arrival from nowhere: the first position after a start or a tool change.
    First,
    Rapid,
    Cut,
}

/// One way to stand at a point, and the cheapest way to have come there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrellisState {
    pub cost: PathCost,
    pub joints: Joints,
    /// Which state of the point before.
    pub from: usize,
    /// Which state of the marked point this one comes from.
    pub root: usize,
    pub branch: u8,
    /// The tool arrives at the point with the values of this state of the trellis's `rewound`; there the tool is drawn
    /// back, turned to the values here, and brought back.
    pub rewind: Option<usize>,
}

/// The branch of states whose pole joint stands where it stood.
pub(crate) const HELD: u8 = u8::MAX;

/// More states than this at one point are not followed: the cheapest of them are.
const MOST_STATES: usize = 64;

/// A pole joint is eased where the tolerance leaves it more than this, radians (2°): elsewhere little would be
/// gained, and the points stay exact.
const WORTH: f64 = 0.034_906_585_039_886_59;

/// What the states at a point can go on to.
struct TransitionRange {
    /// Branches that have a state.
    alive: [bool; 2],
    /// Latitude of the point before.
    latitude: (f64, f64),
    /// Angles that the tool axis goes, and can get on the way, radians.
    arc: f64,
    reach: f64,
}

/// What is known of a cut before its states go on.
struct CutPassage {
    /// Whether it leads past where the branches meet.
    meet: bool,
    /// Angle that the tool axis goes, radians.
    arc: f64,
}

impl TransitionRange {
    /// Does the way lead past where the branches meet? Only if both its ends are close enough to there. Else each
    /// branch goes on by itself; there it has to be tried.
    #[inline]
    fn meet(&self, axes: &ChoiceAxes, latitude: (f64, f64)) -> bool {
        !axes.far(self.latitude, self.reach)
            && !axes.far(latitude, self.reach)
            && axes.margin(self.latitude) + axes.margin(latitude) <= self.reach
    }

    /// Branches that are worth being worked out.
    #[inline]
    fn going(&self, axes: &ChoiceAxes, branches: &Branches) -> [bool; 2] {
        if self.alive == [true; 2] || branches.count() == 1 || self.meet(axes, branches.latitude())
        {
            [true; 2]
        } else {
            self.alive
        }
    }
}

/// An end of a cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CutEnd<'a> {
    /// Where the tool is to be.
    pub pose: &'a Pose,
    /// Where the axes stand.
    pub joints: &'a Joints,
}

impl CutEnd<'_> {
    /// It as a node at share `t` of the cut; none if it cannot be placed there.
    pub(super) fn node(&self, placer: &Placer, t: f64) -> Option<PathNode> {
        placer.settled(*self.pose, t, self.joints).ok()
    }
}

/// How a state of a layer is come to.
#[derive(Clone, Copy)]
struct Arrival<'n> {
    /// The state before; none: from nowhere.
    from: Option<usize>,
    kind: ArrivalKind,
    /// Where the axes stand if it is from nowhere.
    near: &'n Joints,
}

/// A cut from one of two states to another: does the machine come through, within tolerance?
pub(crate) trait CutChecker {
    fn passes(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        from: CutEnd<'_>,
        to: CutEnd<'_>,
    ) -> bool;

    /// What the way from `from` to `to` adds to the ways on which bodies hit one another; 0 where they are not weighed. The
    /// first position is come to from where the tool is retracted.
    fn hits(&mut self, placer: &Placer, kind: ArrivalKind, from: &Joints, to: &Joints) -> u32;
}

/// Time that the program asks for a move over `way` mm, minutes; a rapid has none.
pub(super) fn minutes(motion: &StraightMove, way: f64) -> f64 {
    match motion.pace {
        MoveFeed::PerMinute(feed) => way / feed,
        MoveFeed::InverseTime(feed) => 1.0 / feed,
        MoveFeed::Rapid | MoveFeed::PerRevolution(_) => 0.0,
    }
}

/// The points that are not settled yet; the first of them is, if `anchored`.
#[derive(Debug)]
pub(crate) struct Trellis {
    pub measure: TravelMeasure,
    pub axes: ChoiceAxes,
    pub layers: Vec<TrellisLayer>,
    pub states: Vec<TrellisState>,
    stands: Vec<AxisSolution>,
    /// Without a closed form: where searches at the newest point began, and what they found.
    searched: Vec<(Joints, Option<Joints>)>,
    /// Tool axes closer to the pole than this (sine) leave the pole joint free.
    pub cone: f64,
    /// What a pole joint may be off by, as an angle of the tool axis, radians.
    pub freedom: f64,
    /// Time under the rule `cycle-time` that the program asks for the cut to the newest layer and for the one that is
    /// being pushed, s.
    asked: [f64; 2],
    /// The pass is looked for on a lattice of all turns about the tool: see [`super::lattice`].
    pub(super) wide: bool,
}

/// Where a point is wanted.
pub(crate) fn pose(motion: &StraightMove) -> Pose {
    Pose { tip: motion.tip, axis: motion.axis, edge: motion.edge }
}

impl Trellis {
    pub(crate) fn new(machine: &Machine, placer: &Placer) -> Self {
        Self::close_to_poles(machine, placer, machine.solution.pole)
    }

    /// Makes a trellis that meets poles in this way, whatever the machine file says.
    pub(crate) fn close_to_poles(machine: &Machine, placer: &Placer, pole: Pole) -> Self {
        let freedom = match pole {
            Pole::Blend => {
                SHARE_AT_POLES * machine.accuracy.axis_tolerance - placer.axis_rounding()
            }
            Pole::Exact => 0.0,
        }
        .max(0.0);
        Self {
            measure: TravelMeasure::new(machine, placer.solver().surplus()),
            axes: ChoiceAxes::new(machine, placer.solver(), freedom, |joint, travel| {
                placer.printed_travel(joint, travel)
            }),
            layers: Vec::new(),
            states: Vec::new(),
            stands: Vec::new(),
            searched: Vec::new(),
            cone: libm::sin(freedom).max(post_machine::kinematics::POLE),
            freedom,
            asked: [0.0; 2],
            wide: false,
        }
    }

    /// The states of a layer.
    pub(crate) fn states_of(&self, layer: usize) -> &[TrellisState] {
        let layer = &self.layers[layer];
        &self.states[layer.first..layer.first + layer.count]
    }

    /// How the tool arrives at a further point.
    fn arrival(&self, motion: &StraightMove) -> ArrivalKind {
        match (self.layers.is_empty(), motion.pace) {
            (true, _) => ArrivalKind::First,
            (false, MoveFeed::Rapid) => ArrivalKind::Rapid,
            (false, _) => ArrivalKind::Cut,
        }
    }

    /// Adds a point; `near` is where the axes stand if it is the first. Gives what was found at the point; the
    /// layer has no state if the path cannot go on to it.
    ///
    /// # Errors
    /// The point has no solution at all, and is not added.
    pub(crate) fn push(
        &mut self,
        line: u64,
        motion: &StraightMove,
        setting: usize,
        placer: &Placer,
        near: &Joints,
        judge: &mut dyn CutChecker,
    ) -> Result<SolutionSummary, Unreachable> {
        let kind = self.arrival(motion);
        let target = pose(motion);
        let before = self.layers.last().map(|layer| layer.first..layer.first + layer.count);
        if self.measure.drives().is_some() {
            self.asked =
                [self.asked_for(self.layers.len().saturating_sub(1)), self.asked_next(motion)];
        }
        let mut stands = std::mem::take(&mut self.stands);
        stands.clear();
        let last = before
            .clone()
            .and_then(|range| self.states.get(range.start))
            .map_or(*near, |state| state.joints);
        let first = self.states.len();
        let ways = self.ways(&target, kind);
        if kind == ArrivalKind::Cut && !placer.solver().closed_form() {
            self.search_cut(placer, motion, before.clone().unwrap_or(0..0), judge);
        }
        let found = if self.states.len() > first {
            // What other solutions there are is nothing to a cut, and costly to find out.
            Ok(SolutionSummary::by_search(1))
        } else {
            let going = |branches: &Branches| ways.going(&self.axes, branches);
            self.axes.stands(placer.solver(), &target, &last, &going, &mut stands)
        };
        let found = match found {
            Ok(found) => found,
            Err(unreachable) => {
                self.stands = stands;
                return Err(unreachable);
            }
        };
        if self.wide && kind != ArrivalKind::Cut {
            self.axes.lattice(placer.solver(), &target, &last, &mut stands);
        }
        let on_pole = found.latitude.0 <= self.cone && placer.solver().pole_joint().is_some();
        if kind != ArrivalKind::Cut {
            // A tie goes to the larger value of the axis nearest to the tool.
            let joint = placer.solver().last_rotary();
            stands.sort_by(|a, b| b.joints[joint].total_cmp(&a.joints[joint]));
        }
        let range = before.unwrap_or(0..0);
        if kind == ArrivalKind::Rapid && !placer.solver().surplus().is_empty() {
            self.rapids_on(placer, &target, range.clone(), &mut stands);
        }
        if on_pole {
            let arrival = Arrival { from: None, kind, near };
            self.hold(placer, &target, range.clone(), arrival, judge);
        }
        if self.states.len() == first {
            match kind {
                ArrivalKind::First => {
                    for stand in &stands {
                        self.reach(placer, stand, None, near, judge);
                    }
                }
                ArrivalKind::Rapid => self.turn(placer, &stands, range, judge),
                ArrivalKind::Cut if placer.solver().closed_form() => {
                    let meet = ways.meet(&self.axes, found.latitude);
                    let passage = CutPassage { meet, arc: ways.arc };
                    self.go_on(placer, motion, &stands, &passage, range, judge);
                }
                ArrivalKind::Cut => {}
            }
        }
        self.stands = stands;
        self.drop_beyond_limits(first);
        self.thin(first);
        self.layers.push(TrellisLayer {
            line,
            motion: *motion,
            kind,
            setting,
            first,
            count: self.states.len() - first,
            latitude: found.latitude,
        });
        Ok(found)
    }

    /// The step of a path of which one state lives, in a cut on its branch: what [`Trellis::push`] and settling the
    /// only state would give, without a trellis. None, and nothing changed, on any doubt.
    #[inline]
    pub(crate) fn step(
        &mut self,
        line: u64,
        motion: &StraightMove,
        setting: usize,
        placer: &Placer,
    ) -> Option<Joints> {
        let ([_], [state]) = (self.layers.as_slice(), self.states.as_slice()) else {
            return None;
        };
        let solver = placer.solver();
        if motion.pace == MoveFeed::Rapid || state.branch == HELD || !solver.closed_form() {
            return None;
        }
        let target = pose(motion);
        let ways = self.ways(&target, ArrivalKind::Cut);
        let branches = solver.orient(&target, self.axes.axis_tolerance).ok()?;
        let latitude = branches.latitude();
        // Of axes that have two solutions elsewhere: the edge of their reach, or a pole.
        let edge = branches.count() == 1 && solver.pole_joint().is_some();
        if edge || self.eased(latitude.0) || ways.meet(&self.axes, latitude) {
            return None;
        }
        let at = (&branches, state.branch);
        let way = 2.0 * ways.arc;
        let joints = self.axes.carried_on(solver, &target, at, &state.joints, way)?;
        self.states[0].joints = joints;
        let layer = &mut self.layers[0];
        layer.line = line;
        layer.motion = *motion;
        layer.kind = ArrivalKind::Cut;
        layer.setting = setting;
        layer.latitude = latitude;
        Some(joints)
    }

    /// Whether a point is so close to the pole that its joint has room.
    pub(super) fn eased(&self, sine: f64) -> bool {
        sine * WORTH < self.freedom || sine <= self.cone
    }

    /// What the states of the newest layer can go on to.
    #[inline]
    fn ways(&self, target: &Pose, kind: ArrivalKind) -> TransitionRange {
        let mut ways = TransitionRange {
            alive: [true; 2],
            latitude: (0.0, 0.0),
            arc: 0.0,
            reach: f64::INFINITY,
        };
        let Some(last) = self.layers.last().filter(|_| kind == ArrivalKind::Cut) else {
            return ways;
        };
        ways.alive = [false; 2];
        for state in &self.states[last.first..last.first + last.count] {
            match ways.alive.get_mut(usize::from(state.branch)) {
                Some(alive) => *alive = true,
                // From a held joint every branch can be reached.
                None => ways.alive = [true; 2],
            }
        }
        ways.latitude = last.latitude;
        let chord = (last.motion.axis - target.axis).norm();
        ways.arc = if chord < 0.5 {
            // Never less than the arc, and cheaper.
            1.02 * chord
        } else {
            1.01 * angle(last.motion.axis, target.axis)
        };
        ways.reach = ways.arc + 2.0 * self.freedom;
        ways
    }

    /// A state, unless there is one like it that is no dearer: see [`ChoiceAxes::alike`].
    ///
    /// Of two like states the dearer can never win. The ways on from a state depend on its joints and its branch
    /// alone. Stands are carried to the turn nearest to it, what a move costs is made of differences, and an endless
    /// axis has neither an end of travel nor a side of zero that counts. So each way on from the dearer state, put
    /// back by the turns between the two, is a way on from the cheaper one, each of its moves costs the same, and
    /// the whole stays cheaper by what the states differ by here.
    ///
    /// If only states with the same turns were compared, a path that comes and goes at a pole would
    /// add a turn to either side each time, until there are [`MOST_STATES`] at every point.
    pub(super) fn keep(&mut self, first: usize, state: TrellisState) {
        let axes = &self.axes;
        let like = |known: &&mut TrellisState| {
            axes.alike((known.branch, &known.joints), (state.branch, &state.joints))
        };
        match self.states[first..].iter_mut().find(like) {
            Some(known) if state.cost.less(&known.cost) => *known = state,
            Some(_) => {}
            None => self.states.push(state),
        }
    }

    /// Holds the pole joint on the pole where it stood. Where the tip cannot be reached so, it is turned by
    /// quarter turns.
    fn hold(
        &mut self,
        placer: &Placer,
        target: &Pose,
        before: std::ops::Range<usize>,
        nowhere: Arrival<'_>,
        judge: &mut dyn CutChecker,
    ) {
        let first = self.states.len();
        for quarter in [0.0, 1.0, -1.0, 2.0] {
            if nowhere.kind == ArrivalKind::First {
                self.hold_from(placer, target, nowhere, quarter, first, judge);
            }
            for index in before.clone() {
                if self.states[index].cost.is_way() {
                    let arrival = Arrival { from: Some(index), ..nowhere };
                    self.hold_from(placer, target, arrival, quarter, first, judge);
                }
            }
            if self.states.len() > first {
                return;
            }
        }
    }

    fn hold_from(
        &mut self,
        placer: &Placer,
        target: &Pose,
        arrival: Arrival<'_>,
        quarter: f64,
        first: usize,
        judge: &mut dyn CutChecker,
    ) {
        let Arrival { from, kind, near } = arrival;
        let before = from.map(|index| self.states[index]);
        let mut last = before.map_or(*near, |state| state.joints);
        if let Some(pole) = placer.solver().pole_joint() {
            last[pole] += quarter * std::f64::consts::FRAC_PI_2;
        }
        let turned = quarter * std::f64::consts::FRAC_PI_2;
        let held = self.axes.held(placer.solver(), target, &last, turned);
        let Some(mut stand) = held else {
            return;
        };
        if kind == ArrivalKind::Cut && !self.axes.stand_still(&last, &mut stand.joints) {
            return;
        }
        let (cost, way) = match &before {
            Some(state) if kind == ArrivalKind::Cut => {
                (state.cost, self.way_on(state, &stand.joints))
            }
            Some(state) => (
                state.cost,
                self.measure.off_part(placer.solver().chain(), &state.joints, &stand.joints),
            ),
            None => (PathCost::NONE, self.measure.approach(near, &stand.joints)),
        };
        let stands = before.as_ref().map_or(near, |state| &state.joints);
        let hits = judge.hits(placer, kind, stands, &stand.joints);
        self.keep(
            first,
            TrellisState {
                cost: cost.and(way, self.measure.against(&stand.joints)).and_hits(hits),
                joints: stand.joints,
                from: from.unwrap_or(0),
                root: before.map_or(0, |state| state.root),
                branch: HELD,
                rewind: None,
            },
        );
    }

    /// Adds every set of turns of a solution, reached from one state or from nowhere.
    fn reach(
        &mut self,
        placer: &Placer,
        stand: &AxisSolution,
        from: Option<usize>,
        near: &Joints,
        judge: &mut dyn CutChecker,
    ) {
        let chain = placer.solver().chain();
        let Self { axes, measure, states, .. } = self;
        let arm = measure.has_surplus();
        let before = from.map(|index| states[index]);
        let last = before.map_or(*near, |state| state.joints);
        axes.turned(stand, &last, &mut |joints| {
            let (cost, way) = match &before {
                Some(state) => {
                    let way = measure.off_part(chain, &state.joints, joints);
                    // On the way from one branch of an arm to another the tip would leave its way.
                    let changes = arm && stand.branch != state.branch & !(ALONG | HEADING);
                    (if changes { state.cost.and_rewind(0.0) } else { state.cost }, way)
                }
                None => (PathCost::NONE, measure.approach(near, joints)),
            };
            let hits = match &before {
                Some(state) => judge.hits(placer, ArrivalKind::Rapid, &state.joints, joints),
                None => judge.hits(placer, ArrivalKind::First, near, joints),
            };
            states.push(TrellisState {
                cost: cost.and(way, measure.against(joints)).and_hits(hits),
                joints: *joints,
                from: from.unwrap_or(0),
                root: before.map_or(0, |state| state.root),
                branch: stand.branch,
                rewind: None,
            });
        });
    }

    /// Connects every state with every other, off the part.
    fn turn(
        &mut self,
        placer: &Placer,
        stands: &[AxisSolution],
        before: std::ops::Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        let first = self.states.len();
        let mut begun = false;
        for index in before {
            if !self.states[index].cost.is_way() {
                continue;
            }
            let near = self.states[index].joints;
            let from = self.states.len();
            for stand in stands {
                self.reach(placer, stand, Some(index), &near, judge);
            }
            if !begun {
                begun = true;
                continue;
            }
            // The same turns in the same order: the cheaper of each two stays.
            let count = self.states.len() - from;
            for place in 0..count {
                let new = self.states[from + place];
                let known = &mut self.states[first + place];
                if new.cost.less(&known.cost) {
                    *known = new;
                }
            }
            self.states.truncate(from);
        }
    }

    /// Continues each state in a cut without a closed form.
    fn search_cut(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        before: std::ops::Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        if placer.solver().planar() {
            self.go_on_in_plane(placer, motion, before, judge);
        } else if self.wide {
            self.lattice_on(placer, motion, before, judge);
        } else if placer.solver().surplus().is_empty() {
            self.search_on(placer, &pose(motion), before, judge);
        } else {
            self.surplus_on(placer, motion, before, judge);
        }
    }

    /// Continues each state by itself, in a cut; to the other branch only where the two meet.
    #[inline]
    fn go_on(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        stands: &[AxisSolution],
        passage: &CutPassage,
        before: std::ops::Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        let first = self.states.len();
        let Some(last) = self.layers.last() else {
            return;
        };
        let from_pose = pose(&last.motion);
        let target = pose(motion);
        for index in before {
            let state = self.states[index];
            if !state.cost.is_way() {
                continue;
            }
            for stand in stands {
                if state.branch == HELD {
                    self.leave_pole(placer, stand, index, first, judge);
                    continue;
                }
                let same = stand.branch == state.branch;
                if !same && !passage.meet {
                    continue;
                }
                let carried = self.axes.carried(stand, &state.joints);
                let sure = same
                    && !passage.meet
                    && carried.as_ref().is_ok_and(|joints| {
                        // Between two points an axis can go farther than at both of them.
                        !self.axes.near_end(&state.joints, joints, 2.0 * passage.arc)
                    });
                if sure && let Ok(mut joints) = carried {
                    if self.axes.stand_still(&state.joints, &mut joints) {
                        let hits = judge.hits(placer, ArrivalKind::Cut, &state.joints, &joints);
                        self.states.push(self.after(index, joints, stand.branch, hits));
                    }
                    continue;
                }
                // Of the turns that the axes can reach, the nearest that they do reach.
                let mut tried: Vec<Joints> = carried.into_iter().collect();
                self.axes.other_turns(stand, &state.joints, &mut |joints| tried.push(*joints));
                let from = CutEnd { pose: &from_pose, joints: &state.joints };
                let found = tried.into_iter().find_map(|mut joints| {
                    (self.axes.stand_still(&state.joints, &mut joints)
                        && judge.passes(
                            placer,
                            motion,
                            from,
                            CutEnd { pose: &target, joints: &joints },
                        ))
                    .then_some(joints)
                });
                if let Some(joints) = found {
                    let hits = judge.hits(placer, ArrivalKind::Cut, &state.joints, &joints);
                    let new = self.after(index, joints, stand.branch, hits);
                    self.keep(first, new);
                }
            }
        }
    }

    /// What it costs to go on in a cut from a state of the newest layer.
    #[inline]
    fn way_on(&self, state: &TrellisState, joints: &Joints) -> f64 {
        let travel = self.measure.between(&state.joints, joints);
        match self.measure.drives() {
            Some(drives) => travel + self.seconds_on(drives, state, joints),
            None => travel,
        }
    }

    /// How long that takes, with what is lost where the velocities change. (How a state was reached counts as it is cheapest
    /// so far; a dearer way that would have gone on more smoothly is not known any more. And how the tool came to the first
    /// layer is not known at all.)
    #[cold]
    fn seconds_on(&self, drives: &DriveLimits, state: &TrellisState, joints: &Joints) -> f64 {
        let newest = self.layers.len() - 1;
        let before = self.states[state.from].joints;
        let cut = self.layers[newest].kind == ArrivalKind::Cut && state.rewind.is_none();
        let mut clock = PathClock::new(drives, if cut { before } else { state.joints });
        match (cut, newest) {
            (false, _) => clock.rests(),
            (true, 0) => clock = PathClock::new(drives, state.joints),
            (true, _) => clock.cuts(&state.joints, self.asked[0]),
        }
        let known = clock.seconds;
        clock.cuts(joints, self.asked[1]);
        clock.seconds - known
    }

    /// What the program asks for the cut to a layer, s; 0 for a rapid, and where it is not known how far that goes.
    pub(super) fn asked_for(&self, layer: usize) -> f64 {
        match layer.checked_sub(1) {
            Some(before) => {
                let [before, at] = [before, layer].map(|layer| &self.layers[layer].motion);
                60.0 * minutes(at, (at.tip - before.tip).norm())
            }
            None => 0.0,
        }
    }

    /// Time that is asked for a move to a point after the newest layer.
    fn asked_next(&self, motion: &StraightMove) -> f64 {
        self.layers
            .last()
            .map_or(0.0, |last| 60.0 * minutes(motion, (motion.tip - last.motion.tip).norm()))
    }

    /// The state that stands at `joints` and comes from another by a cut that adds `hits`.
    #[inline]
    pub(super) fn after(&self, from: usize, joints: Joints, branch: u8, hits: u32) -> TrellisState {
        let state = &self.states[from];
        let cost = state.cost.and(self.way_on(state, &joints), self.measure.against(&joints));
        TrellisState {
            cost: cost.and_hits(hits),
            joints,
            from,
            root: state.root,
            branch,
            rewind: None,
        }
    }

    /// Connects a held pole joint with every solution: that joint is turned while it turns nothing, the others
    /// go on from where they are.
    fn leave_pole(
        &mut self,
        placer: &Placer,
        stand: &AxisSolution,
        from: usize,
        first: usize,
        judge: &mut dyn CutChecker,
    ) {
        let state = self.states[from];
        let mut reached = Vec::new();
        self.axes.unheld(stand, &state.joints, &mut |joints| reached.push(*joints));
        for mut joints in reached {
            if !self.axes.stand_still(&state.joints, &mut joints) {
                continue;
            }
            let hits = judge.hits(placer, ArrivalKind::Cut, &state.joints, &joints);
            let new = self.after(from, joints, stand.branch, hits);
            self.keep(first, new);
        }
    }

    /// Continues each state to the solution next to it, in a cut without a closed form. From states that differ by
    /// full turns that is the same but for these turns.
    fn search_on(
        &mut self,
        placer: &Placer,
        target: &Pose,
        before: std::ops::Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        let first = self.states.len();
        let mut searched = std::mem::take(&mut self.searched);
        searched.clear();
        for index in before {
            let state = self.states[index];
            if !state.cost.is_way() {
                continue;
            }
            let known = searched
                .iter()
                .find_map(|(from, to)| Some((self.axes.whole_turns(from, &state.joints)?, *to)));
            let next = match known {
                Some((turns, to)) => {
                    to.map(|to| std::array::from_fn(|joint| to[joint] + turns[joint]))
                }
                None => {
                    let next = self.axes.next(placer.solver(), target, &state.joints);
                    searched.push((state.joints, next));
                    next
                }
            };
            let Some(mut joints) = next.filter(|joints| self.axes.reaches(joints)) else {
                continue;
            };
            if !self.axes.stand_still(&state.joints, &mut joints) {
                continue;
            }
            let hits = judge.hits(placer, ArrivalKind::Cut, &state.joints, &joints);
            let new = self.after(index, joints, state.branch, hits);
            self.keep(first, new);
        }
        self.searched = searched;
    }

    /// Continues each state in a cut of two linear axes, one of which may go through the centre line or a rotary axis be
    /// turned on it.
    fn go_on_in_plane(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        before: std::ops::Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        let first = self.states.len();
        let Some(from_pose) = self.layers.last().map(|last| pose(&last.motion)) else {
            return;
        };
        let target = pose(motion);
        for index in before {
            let state = self.states[index];
            if !state.cost.is_way() {
                continue;
            }
            let tolerance = self.axes.axis_tolerance;
            let poses = [&from_pose, &target];
            let next = placer.solver().next(poses, &state.joints, tolerance).unwrap_or_default();
            for next in next {
                let mut joints = next.joints;
                let from = CutEnd { pose: &from_pose, joints: &state.joints };
                if self.axes.reaches(&joints)
                    && self.axes.stand_still(&state.joints, &mut joints)
                    && (next.sure
                        || judge.passes(
                            placer,
                            motion,
                            from,
                            CutEnd { pose: &target, joints: &joints },
                        ))
                {
                    let hits = judge.hits(placer, ArrivalKind::Cut, &state.joints, &joints);
                    let new = self.after(index, joints, next.branch, hits);
                    self.keep(first, new);
                }
            }
        }
    }

    /// Leaves those states of the newest layer at which what must hold between the axes holds.
    fn drop_beyond_limits(&mut self, first: usize) {
        if !self.axes.has_limits() {
            return;
        }
        let mut kept = first;
        for index in first..self.states.len() {
            if self.axes.within_limits(&self.states[index].joints) {
                self.states.swap(kept, index);
                kept += 1;
            }
        }
        self.states.truncate(kept);
    }

    /// Keeps the cheapest states of the newest layer, if there are too many.
    fn thin(&mut self, first: usize) {
        let most = if self.wide { MOST_OF_LATTICE } else { MOST_STATES };
        if self.states.len() - first > most {
            self.states[first..].sort_by(|a, b| a.cost.order(&b.cost));
            self.states.truncate(first + most);
        }
    }

    /// The newest layer's cheapest state.
    pub(crate) fn best(&self) -> Option<usize> {
        let layer = self.layers.last()?;
        let mut best: Option<usize> = None;
        for index in layer.first..layer.first + layer.count {
            let cost = self.states[index].cost;
            if cost.is_way() && best.is_none_or(|best: usize| cost.less(&self.states[best].cost)) {
                best = Some(index);
            }
        }
        best
    }

    /// Takes the newest layer back.
    pub(crate) fn pop(&mut self) -> Option<TrellisLayer> {
        let layer = self.layers.pop()?;
        self.states.truncate(layer.first);
        Some(layer)
    }
}
