//! Limits of axes that depend on other axes: `Z > -300 + 2 * abs(B)`.
//!
//! A limit is held at every point of a way. Between two points it is proven by bounds on the values of the axes: a piece
//! whose bounds do not prove it is halved, until a place is found where it does not hold, or a piece is so short that
//! it counts as one.

use post_grammar::Inequality;
use post_grammar::text::excerpt;

use crate::axis_formula::FormulaNames;
use crate::description::{Axis, Machine};
use crate::kinematics::{Drive, Joints, Leg, Solver, TcpBlock};

/// What rounding of the words may take a limit beyond its end, in its own units (mm, degrees).
pub const ROUNDED: f64 = 1.5e-3;

/// Longest piece of it that a message shows, bytes.
pub(crate) const SHOWN: usize = 120;

/// Halvings of a way, and of a box, before what is not proven counts as passed.
const DEEPEST: u32 = 18;

/// A limit that names more than one axis, or one axis in other words than its travel.
#[derive(Clone, Debug, PartialEq)]
pub struct DependentLimit {
    text: String,
    rule: Rule,
}

/// What must hold.
#[derive(Clone, Debug, PartialEq)]
enum Rule {
    /// An inequality, and what its names stand for.
    Formula(Inequality, FormulaNames),
    /// A leg reaches its platform, and its drive keeps to its travel.
    Reach(Leg),
}

/// What a name in a limit stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Named {
    /// The value that the control shows of the axis at this place in the chain: `value / unit + zero`.
    Axis {
        joint: usize,
        /// Axis units (mm, radians) in one unit of the value.
        unit: f64,
        /// What the control shows where the drawing has the axis at zero, in units of the value.
        zero: f64,
    },
    /// A number of the machine file.
    Parameter(f64),
}

impl Named {
    /// The value that the control shows of `axis`, at place `joint` in the chain.
    pub(crate) fn of(joint: usize, axis: &Axis) -> Self {
        let unit = axis.unit();
        Self::Axis { joint, unit, zero: axis.zero / unit }
    }

    /// Its value at `joints`.
    pub(crate) fn value(self, joints: &Joints) -> f64 {
        match self {
            Self::Axis { joint, unit, zero } => joints[joint] / unit + zero,
            Self::Parameter(value) => value,
        }
    }
}

impl DependentLimit {
    /// The limit `text` says, each name of which is among `names`.
    pub(crate) fn new(text: &str, inequality: Inequality, names: FormulaNames) -> Self {
        Self { text: excerpt(text, SHOWN).to_string(), rule: Rule::Formula(inequality, names) }
    }

    /// The limit of a leg: it reaches, and its drive keeps to its travel.
    pub(crate) fn of_leg(leg: Leg) -> Self {
        Self { text: leg.name.clone(), rule: Rule::Reach(leg) }
    }

    /// The leg whose limit it is.
    pub fn leg(&self) -> Option<&Leg> {
        match &self.rule {
            Rule::Reach(leg) => Some(leg),
            Rule::Formula(..) => None,
        }
    }

    /// As the machine file has it, as far as messages show it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Places in the chain of the axes that it names, in the order written.
    pub fn joints(&self) -> impl Iterator<Item = usize> {
        let (names, leg) = match &self.rule {
            Rule::Formula(_, names) => (Some(names.axes().map(|(joint, _)| joint)), None),
            Rule::Reach(leg) => (None, Some(leg.places())),
        };
        names.into_iter().flatten().chain(leg.into_iter().flatten())
    }

    /// By how much it holds at `joints`, mm or degrees; below zero where it does not, no number where it has no value.
    pub fn margin(&self, joints: &Joints) -> f64 {
        match &self.rule {
            Rule::Formula(inequality, names) => {
                let known = names.at(joints);
                let sides = inequality.sides(&|name| known.of(name));
                sides.map_or(f64::NAN, |sides| inequality.margin(sides))
            }
            Rule::Reach(leg) => {
                leg.value(joints).map_or(f64::NAN, |value| drive_margin(leg, [value; 2]))
            }
        }
    }

    /// It holds at `joints`, but for rounding of the words.
    pub fn holds(&self, joints: &Joints) -> bool {
        self.margin(joints) >= -ROUNDED
    }

    /// A lower bound on the margin while each axis stays between its value in `least` and that in `most`.
    pub fn least_margin(&self, [least, most]: [&Joints; 2]) -> f64 {
        match &self.rule {
            Rule::Formula(inequality, names) => {
                let known = names.between([least, most]);
                inequality.least_margin(&|name| known.of(name))
            }
            Rule::Reach(leg) => {
                leg.range([least, most]).map_or(f64::NEG_INFINITY, |range| drive_margin(leg, range))
            }
        }
    }

    /// Nowhere does it hold while each axis stays between its value in `least` and that in `most`.
    pub(crate) fn is_out(&self, [least, most]: [&Joints; 2]) -> bool {
        match &self.rule {
            Rule::Formula(inequality, names) => {
                let known = names.between([least, most]);
                inequality.most_margin(&|name| known.of(name)) < 0.0
            }
            Rule::Reach(leg) => leg.is_out([least, most]),
        }
    }

    /// A place at which it is passed, or not proven to hold, while each axis goes for itself between its value in `least`
    /// and that in `most`.
    pub fn passed_between(&self, ends: [&Joints; 2]) -> Option<Joints> {
        self.passed_in_box(ends, DEEPEST)
    }

    fn passed_in_box(&self, [least, most]: [&Joints; 2], halvings: u32) -> Option<Joints> {
        if self.least_margin([least, most]) >= -ROUNDED {
            return None;
        }
        let corner = self.worst_corner([least, most]);
        let widest = self.joints().max_by(|a, b| {
            let width = |joint: usize| self.shown_way(joint, [least, most]);
            width(*a).total_cmp(&width(*b))
        });
        let Some(widest) = widest.filter(|_| halvings > 0 && self.holds(&corner)) else {
            return Some(corner);
        };
        let middle = 0.5 * (least[widest] + most[widest]);
        let (mut below, mut above) = (*most, *least);
        below[widest] = middle;
        above[widest] = middle;
        self.passed_in_box([least, &below], halvings - 1)
            .or_else(|| self.passed_in_box([&above, most], halvings - 1))
    }

    /// The corner of a box at which it holds least; other axes as in `least`.
    fn worst_corner(&self, [least, most]: [&Joints; 2]) -> Joints {
        let mut worst = *least;
        for joint in self.joints() {
            let mut other = worst;
            other[joint] = most[joint];
            // What has no value holds least of all.
            let [own, margin] = [&worst, &other].map(|place| self.margin(place));
            if margin < own || margin.is_nan() {
                worst = other;
            }
        }
        worst
    }

    /// Way of an axis, mm or degrees.
    fn shown_way(&self, joint: usize, [least, most]: [&Joints; 2]) -> f64 {
        let unit = match &self.rule {
            Rule::Formula(_, names) => {
                let mut axes = names.axes();
                axes.find(|(at, _)| *at == joint).map(|(_, unit)| unit)
            }
            Rule::Reach(leg) => Some(leg.unit_of(joint)),
        };
        (most[joint] - least[joint]) / unit.unwrap_or(1.0)
    }

    /// A place at which it is passed, or not proven to hold, on the way between `ends`: `between` gives the axis values at
    /// a share of it, and `bends` bounds their second derivatives by the share, mm or radians.
    pub fn passed_on(
        &self,
        ends: [&Joints; 2],
        between: &dyn Fn(f64) -> Option<Joints>,
        bends: &Joints,
    ) -> Option<Joints> {
        match ends.into_iter().find(|end| !self.holds(end)) {
            Some(end) => Some(*end),
            None => self.passed_on_piece(between, bends, ([0.0, 1.0], ends), DEEPEST),
        }
    }

    fn passed_on_piece(
        &self,
        between: &dyn Fn(f64) -> Option<Joints>,
        bends: &Joints,
        ([from, to], [first, last]): ([f64; 2], [&Joints; 2]),
        halvings: u32,
    ) -> Option<Joints> {
        // From the line between its ends an axis strays by an eighth of its second derivative.
        let eighth = (to - from) * (to - from) / 8.0;
        let bow = |joint: usize| bends[joint] * eighth;
        let least = std::array::from_fn(|joint| first[joint].min(last[joint]) - bow(joint));
        let most = std::array::from_fn(|joint| first[joint].max(last[joint]) + bow(joint));
        if self.least_margin([&least, &most]) >= -ROUNDED {
            return None;
        }
        let share = 0.5 * (from + to);
        let Some(middle) = between(share) else {
            return Some(*first);
        };
        if halvings == 0 || !self.holds(&middle) {
            return Some(middle);
        }
        self.passed_on_piece(between, bends, ([from, share], [first, &middle]), halvings - 1)
            .or_else(|| {
                self.passed_on_piece(between, bends, ([share, to], [&middle, last]), halvings - 1)
            })
    }

    /// [`DependentLimit::passed_on`] a straight line of the axes.
    pub fn passed_straight(&self, ends: [&Joints; 2]) -> Option<Joints> {
        let [from, to] = ends;
        let between = |share: f64| {
            Some(std::array::from_fn(|joint| from[joint] + share * (to[joint] - from[joint])))
        };
        self.passed_on(ends, &between, &Joints::default())
    }

    /// [`DependentLimit::passed_on`] a way on which the rotary axes go linearly and the control keeps the tip, `along` mm
    /// below the point of `solver`, on a straight line.
    pub fn passed_keeping_tip(
        &self,
        solver: &Solver,
        along: f64,
        ends: [&Joints; 2],
    ) -> Option<Joints> {
        let chain = solver.chain();
        let [from, to] = ends.map(|joints| chain.traced(joints));
        let Some(kept) = TcpBlock::new(solver, along, &from, &to) else {
            return self.passed_by_each(ends);
        };
        let bend = kept.quick();
        let mut bends = Joints::default();
        if bend.is_finite() {
            kept.sliding().into_iter().for_each(|joint| bends[joint] = bend);
            return self.passed_on(ends, &|share| kept.joints_at(solver, share), &bends);
        }
        let Some(slides) = kept.slides(&Joints::default(), f64::INFINITY) else {
            return Some(*ends[1]);
        };
        let [mut least, mut most] = hull(ends);
        for joint in kept.sliding() {
            least[joint] = least[joint].min(slides.least[joint]);
            most[joint] = most[joint].max(slides.most[joint]);
        }
        self.passed_between([&least, &most])
    }

    /// [`DependentLimit::passed_between`] two places, each axis by itself.
    pub fn passed_by_each(&self, ends: [&Joints; 2]) -> Option<Joints> {
        let [least, most] = hull(ends);
        self.passed_between([&least, &most])
    }

    /// Where the axes that it names stand: `Z -260.000 mm, B 30.000°`.
    pub fn stance(&self, machine: &Machine, joints: &Joints) -> String {
        let mut told = Vec::new();
        for joint in self.joints() {
            let axis = &machine.axes[joint];
            let sign = if axis.joint.rotary { "°" } else { " mm" };
            let text = format!("{} {:.3}{sign}", axis.name, axis.reading(joints[joint]) + 0.0);
            if !told.contains(&text) {
                told.push(text);
            }
        }
        told.join(", ")
    }

    /// What is wrong at `joints`: the limit, where the axes stand, both of its sides, and by how much it is passed.
    pub fn told(&self, machine: &Machine, joints: &Joints) -> String {
        let stands = self.stance(machine, joints);
        let (inequality, names) = match &self.rule {
            Rule::Formula(inequality, names) => (inequality, names),
            Rule::Reach(leg) => return leg_told(leg, joints, &stands),
        };
        let known = names.at(joints);
        let Ok([left, right]) = inequality.sides(&|name| known.of(name)) else {
            return format!("[[limit]] `{}` has no value at {stands}", self.text);
        };
        let margin = inequality.margin([left, right]);
        if margin >= -ROUNDED {
            return format!(
                "[[limit]] `{}` is not proven to hold beside {stands}, where {margin:.3} is left",
                self.text
            );
        }
        format!(
            "[[limit]] `{}` does not hold at {stands}: {left:.3} must be {} {right:.3}, passed by {:.3}",
            self.text,
            inequality.sign(),
            -margin
        )
    }

    /// What passes it at `joints`, as a list of such places has it, and on which side: a drive that leaves its travel at one
    /// end is another fault than at the other. None where it is only not proven to hold.
    ///
    /// `J1 at 144.900 mm (X 87.000 mm, Y 82.000 mm), passed by 5.100 mm,`
    pub fn passed_at(&self, machine: &Machine, joints: &Joints) -> Option<(bool, String)> {
        let by = self.excess(joints);
        if by <= ROUNDED {
            return None;
        }
        let stands = self.stance(machine, joints);
        let Rule::Reach(leg) = &self.rule else {
            return Some((false, format!("{stands}, passed by {by:.3},")));
        };
        let value = leg.value(joints)?;
        let sign = if leg.turns() { "°" } else { " mm" };
        let above = leg.travel.is_some_and(|[_, last]| value > last);
        let (name, shown) = (&leg.name, leg.reading(value));
        Some((above, format!("{name} at {shown:.3}{sign} ({stands}), passed by {by:.3}{sign},")))
    }

    /// By how much it is passed at `joints`, mm or degrees; zero where that is not known.
    pub fn excess(&self, joints: &Joints) -> f64 {
        (-self.margin(joints)).max(0.0)
    }
}

/// By how much a drive that stands somewhere in a range keeps to its travel, mm or degrees.
fn drive_margin(leg: &Leg, [least, most]: [f64; 2]) -> f64 {
    let margin = leg.travel.map_or(f64::INFINITY, |[first, last]| (least - first).min(last - most));
    margin / leg.unit()
}

/// What is wrong with a leg where the axes stand as `stands` says.
fn leg_told(leg: &Leg, joints: &Joints, stands: &str) -> String {
    let name = &leg.name;
    let (table, lack) = match leg.drive {
        Drive::Formula { .. } => ("drive", "has no value"),
        _ => ("leg", "does not reach the platform"),
    };
    let Some(value) = leg.value(joints) else {
        return format!("[[{table}]] {name} {lack} at {stands}");
    };
    let sign = if leg.turns() { "°" } else { " mm" };
    let shown = leg.reading(value);
    let [least, most] = leg.travel.unwrap_or([value; 2]).map(|end| leg.reading(end));
    let margin = drive_margin(leg, [value; 2]);
    if margin >= -ROUNDED {
        return format!(
            "[[{table}]] {name} is not proven to keep its travel beside {stands}, where it stands at {shown:.3}{sign}"
        );
    }
    format!(
        "[[{table}]] {name} would stand at {shown:.3}{sign} at {stands}, its travel is {least:.3} to {most:.3}{sign}, passed by {:.3}{sign}",
        -margin
    )
}

/// Least and largest values of each axis at two places.
fn hull([one, other]: [&Joints; 2]) -> [Joints; 2] {
    [
        std::array::from_fn(|joint| one[joint].min(other[joint])),
        std::array::from_fn(|joint| one[joint].max(other[joint])),
    ]
}
