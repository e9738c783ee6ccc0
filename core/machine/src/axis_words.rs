//! From axis values to the words of the program and back: work offset, units, decimals, order.

mod coordinates;
mod lanes;

pub use lanes::WordLanes;
use nalgebra::Vector3;
use post_plugin::{Format, Language};

use crate::description::{Machine, OutputUnits, TIP_WORDS, Tcp};
use crate::kinematics::{Joints, MAX_AXES, Solver};
use crate::tilted_plane::TiltedPlane;
use crate::word_map::WordMap;

/// Values of the words of a block, in the order in which they are written.
pub type WordValues = [f64; MAX_AXES];

/// How axis values are written.
#[derive(Clone, Debug)]
pub struct AxisWords {
    tcp: Tcp,
    /// Words of rotary axes, in the order of writing.
    rotary: Vec<Word>,
    /// Words of linear axes, in the order of writing; where the control keeps the tip those of the tip.
    linear: Vec<Word>,
    /// Words of linear axes that stand beside the tip's, where the control keeps it, in the order of writing.
    standing: Vec<Word>,
    /// Axis values with the tip on the part origin and every rotary axis at zero.
    zero: Joints,
    /// Axis positions hold errors, so that the control's own frames are not theirs.
    erring: bool,
    /// The linear words are X, Y and Z, one each.
    cartesian: bool,
    /// The tilted plane whose coordinates the linear words are.
    plane: Option<TiltedPlane>,
    /// What rotary words make of the values of several axes; none where each is that of one.
    coupled: Option<Box<WordMap>>,
    /// Linear words are what the control shows of their axes, wherever the part is.
    shown: bool,
}

/// One word.
#[derive(Clone, Copy, Debug)]
struct Word {
    /// Place among the words of a block.
    place: usize,
    /// Place in the chain.
    joint: usize,
    /// What the control shows where the drawing has the axis at zero, mm or radians.
    reading: f64,
    /// The control shows the axis within one turn from here, degrees.
    turn_from: Option<f64>,
    /// Coordinate of the part frame, for a linear word when the control keeps the tip.
    coordinate: usize,
    /// Axis units (mm, radians) in one unit of the word (mm or inch, degrees; of a diameter half of it).
    unit: f64,
    /// One over `unit`.
    per_unit: f64,
    /// Ten to the number of decimals.
    scale: f64,
    /// One over `scale`: one printed number is always the same `f64`, so `==` compares what is printed.
    per_scale: f64,
}

/// The unit of rotary words that hold several axes, radians.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The order in which addresses stand in a block.
const ORDER: &str = "XYZUVWABC";

/// Places in the chain, in the order in which their words are written.
pub fn order(machine: &Machine) -> Vec<usize> {
    let mut places: Vec<usize> = (0..machine.axes.len()).collect();
    places.sort_by_key(|place| {
        let word = machine.axes[*place].word();
        let letter = word.chars().next().and_then(|letter| ORDER.find(letter));
        (letter.unwrap_or(ORDER.len()), word.to_owned())
    });
    places
}

/// The axis moves along the tool with all axes at zero: it moves last when the tool comes near. That is one of
/// the linear axes, and any quill beside it.
pub fn is_depth(machine: &Machine, place: usize) -> bool {
    let Some(depth) = depth(machine) else {
        return false;
    };
    let joint = |place: usize| &machine.axes[place].joint;
    let along = joint(place).direction.dot(&joint(depth).direction);
    place == depth || (!joint(place).rotary && libm::fabs(along) > 1.0 - 1e-6)
}

/// The linear axis along the tool with all axes at zero; a quill only if there is no other.
pub fn depth(machine: &Machine) -> Option<usize> {
    let along = |place: &usize| {
        let joint = &machine.axes[*place].joint;
        libm::fabs(joint.direction.dot(&machine.tool_axis))
    };
    (0..machine.axes.len()).filter(|place| !machine.axes[*place].joint.rotary).max_by(|a, b| {
        let main = |place: &usize| {
            let axis = &machine.axes[*place];
            axis.second.is_none() && axis.indexed.is_none()
        };
        let nearer = along(a) - along(b);
        if libm::fabs(nearer) < 1e-6 { main(a).cmp(&main(b)) } else { nearer.total_cmp(&0.0) }
    })
}

/// The coordinate of the part frame that a linear word means where the control keeps the tip.
pub fn coordinate(word: &str) -> usize {
    match word {
        "X" => 0,
        "Y" => 1,
        _ => 2,
    }
}

/// The word of the axis at `place` is a diameter: twice its position.
pub fn is_diameter(machine: &Machine, place: usize) -> bool {
    let twice = libm::fabs(libm::fabs(own_factor(machine, place)) - 2.0) < 1e-9;
    twice && !machine.axes[place].joint.rotary
}

/// What the word of the axis at `joint` multiplies it by.
fn own_factor(machine: &Machine, joint: usize) -> f64 {
    machine.word_map.as_ref().map_or(1.0, |map| map.factor(joint))
}

/// mm in one unit of the program.
pub fn unit_length(units: OutputUnits) -> f64 {
    match units {
        OutputUnits::Mm => 1.0,
        OutputUnits::Inch => 25.4,
    }
}

/// Where the axes stand when the tip of a solver's tool is on the part origin and every axis that does not bring it there
/// shows zero: rotary ones, and linear ones that move off the part alone. `axes` has the places of all axes in the chain, and
/// what each shows where the drawing has it at zero.
fn work_zero(solver: &Solver, axes: impl Iterator<Item = (usize, f64)>) -> Option<Joints> {
    let mut zero = [0.0; MAX_AXES];
    for (joint, reading) in axes {
        zero[joint] = -reading;
    }
    let turns = solver.chain().turns(&zero);
    solver.place_zero(&mut zero, &turns).ok()?;
    Some(zero)
}

/// The work offset of the mount: what the control shows of each linear axis, mm, where the gauge point without a tool is
/// on the part origin and every rotary axis shows zero. None where the linear axes cannot bring it there.
pub fn work_offset(machine: &Machine) -> Option<Vec<(&str, f64)>> {
    let solver = machine.solver_at(0.0, &[0.0; MAX_AXES]).ok()?;
    let axes = machine.axes.iter().enumerate();
    let zero = work_zero(&solver, axes.map(|(joint, axis)| (joint, axis.zero)))?;
    let shown = |joint: usize| {
        let shown = zero[joint] + machine.axes[joint].zero;
        (machine.axes[joint].word(), shown * own_factor(machine, joint))
    };
    let linear = order(machine).into_iter().filter(|joint| !machine.axes[*joint].joint.rotary);
    Some(linear.map(shown).collect())
}

impl AxisWords {
    /// Words of a machine as a dialect's `format` prints them.
    pub fn new(machine: &Machine, format: &Format) -> Self {
        let length = unit_length(machine.control.units);
        let words = order(machine).into_iter().zip(&format.words).enumerate().map(
            |(place, (joint, decimals))| {
                let axis = &machine.axes[joint];
                let scale = (0..*decimals).fold(1.0, |scale, _| scale * 10.0);
                let unit = if axis.joint.rotary { 1f64.to_radians() } else { length };
                let unit = unit / own_factor(machine, joint);
                Word {
                    place,
                    joint,
                    reading: axis.zero,
                    turn_from: axis.range.map(|[least, _]| least / unit),
                    coordinate: coordinate(axis.word()),
                    unit,
                    per_unit: 1.0 / unit,
                    scale,
                    per_scale: 1.0 / scale,
                }
            },
        );
        let (rotary, linear): (Vec<Word>, Vec<Word>) =
            words.partition(|word| machine.axes[word.joint].joint.rotary);
        let name = |word: &Word| machine.axes[word.joint].word();
        let kept = machine.control.tcp == Tcp::Control;
        let (linear, standing): (Vec<Word>, Vec<Word>) =
            linear.into_iter().partition(|word| !kept || TIP_WORDS.contains(&name(word)));
        let scaled = linear.iter().any(|word| own_factor(machine, word.joint) != 1.0);
        let coupled = machine.word_map.as_ref().filter(|map| map.couples());
        Self {
            tcp: machine.control.tcp,
            cartesian: linear.iter().map(name).eq(["X", "Y", "Z"])
                && !scaled
                && machine.errors.is_empty(),
            erring: !machine.errors.is_empty(),
            rotary,
            linear,
            standing,
            zero: [0.0; MAX_AXES],
            plane: None,
            coupled: coupled.cloned().map(Box::new),
            shown: format.language == Language::Joints,
        }
    }

    /// The words inside a tilted plane: the linear ones are the tip in its frame, whoever keeps the tip outside. None
    /// where they are not just X, Y and Z.
    pub fn in_plane(&self, plane: TiltedPlane) -> Option<Self> {
        let coordinate = |wanted: usize| {
            let mut words = self.linear.iter();
            words.any(|word| word.coordinate == wanted)
        };
        let unscaled = self.linear.windows(2).all(|pair| pair[0].unit == pair[1].unit);
        let whole = !self.erring && self.linear.len() == 3 && (0..3).all(coordinate) && unscaled;
        whole.then(|| Self { plane: Some(plane), ..self.clone() })
    }

    /// Number of words.
    pub fn len(&self) -> usize {
        self.rotary.len() + self.linear.len() + self.standing.len()
    }

    fn words(&self) -> impl Iterator<Item = &Word> {
        self.rotary.iter().chain(&self.linear).chain(&self.standing)
    }

    /// No words.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Takes the work offset from a solver: where the axes stand when the tip of its tool is on the part
    /// origin and every other axis shows zero. None if the linear axes cannot bring it there. A robot has none.
    pub fn set_zero(&mut self, solver: &Solver) -> Option<()> {
        let words = self.words().map(|word| (word.joint, word.reading));
        if self.shown {
            let mut zero = [0.0; MAX_AXES];
            words.for_each(|(joint, reading)| zero[joint] = -reading);
            self.zero = zero;
            return Some(());
        }
        self.zero = work_zero(solver, words)?;
        Some(())
    }

    /// Puts the rotary values on printed numbers and writes them to `values`.
    #[inline]
    pub fn print_rotary(&self, joints: &mut Joints, values: &mut WordValues) {
        if let Some(map) = &self.coupled {
            return self.print_coupled(map, joints, values);
        }
        for word in &self.rotary {
            let asked = joints[word.joint] + word.reading;
            let value = word.printed(asked * word.per_unit);
            joints[word.joint] = value * word.unit - word.reading;
            values[word.place] = match word.turn_from {
                None => value,
                Some(from) => word.within_turn(value, from),
            };
        }
    }

    /// [`AxisWords::print_rotary`] where words hold several axes.
    #[cold]
    fn print_coupled(&self, map: &WordMap, joints: &mut Joints, values: &mut WordValues) {
        let mut words = self.words_of(map, joints);
        for word in &self.rotary {
            let value = word.printed(words[word.joint] / DEGREE);
            values[word.place] = value;
            words[word.joint] = value * DEGREE;
        }
        let shown = map.values(&words);
        for word in &self.rotary {
            joints[word.joint] = shown[word.joint] - word.reading;
        }
    }

    /// Rotary words of axis values, radians, by the places of their axes in the chain.
    fn words_of(&self, map: &WordMap, joints: &Joints) -> Joints {
        let mut shown = Joints::default();
        for word in &self.rotary {
            shown[word.joint] = joints[word.joint] + word.reading;
        }
        map.words(&shown)
    }

    /// Some word holds several axes.
    pub fn is_coupled(&self) -> bool {
        self.coupled.is_some()
    }

    /// What is printed, with its place among the words, so that the axis at `joint` comes to its value in `to`, the others
    /// of words that hold it to theirs: words that hold several axes.
    pub fn coupled_words(&self, joint: usize, to: &Joints) -> Vec<(usize, f64)> {
        let Some(map) = self.coupled.as_ref().filter(|map| map.is_coupled(joint)) else {
            return Vec::new();
        };
        let words = self.words_of(map, to);
        let moved: Vec<usize> = map.moved_by(joint).collect();
        let rotary = self.rotary.iter().filter(|word| moved.contains(&word.joint));
        rotary.map(|word| (word.place, word.printed(words[word.joint] / DEGREE))).collect()
    }

    /// Where the control keeps the tip, and in a tilted plane: writes `tip` (mm, part frame) to `values` and gives the
    /// printed tip, which is where the control brings it. None where the words are axis positions:
    /// [`AxisWords::print_linear`].
    #[inline]
    pub fn print_tip(&self, tip: Vector3<f64>, values: &mut WordValues) -> Option<Vector3<f64>> {
        match &self.plane {
            Some(plane) => Some(plane.into_part(self.print_point(plane.into_plane(tip), values))),
            None if self.tcp == Tcp::Post => None,
            None => Some(self.print_point(tip, values)),
        }
    }

    /// Writes a point to `values`; gives the printed one.
    #[inline]
    fn print_point(&self, tip: Vector3<f64>, values: &mut WordValues) -> Vector3<f64> {
        let mut printed = tip;
        for word in &self.linear {
            let value = word.printed(tip[word.coordinate] * word.per_unit);
            values[word.place] = value;
            printed[word.coordinate] = value * word.unit;
        }
        printed
    }

    /// Puts the linear axes on printed numbers and writes them to `values`.
    #[inline]
    pub fn print_linear(&self, joints: &mut Joints, values: &mut WordValues) {
        self.linear.iter().for_each(|word| self.print_slide(word, joints, values));
    }

    /// Puts the linear axes that stand beside a tip that the control keeps on printed numbers and writes them to `values`;
    /// false if there are none.
    #[inline]
    pub fn print_standing(&self, joints: &mut Joints, values: &mut WordValues) -> bool {
        self.standing.iter().for_each(|word| self.print_slide(word, joints, values));
        !self.standing.is_empty()
    }

    #[inline(always)]
    fn print_slide(&self, word: &Word, joints: &mut Joints, values: &mut WordValues) {
        let zero = self.zero[word.joint];
        let value = word.printed((joints[word.joint] - zero) * word.per_unit);
        values[word.place] = value;
        joints[word.joint] = value * word.unit + zero;
    }

    /// The number nearest to `value` that has the decimals of the word at `place`; none if there is no such word.
    pub fn printed(&self, place: usize, value: f64) -> Option<f64> {
        let word = self.words().find(|word| word.place == place)?;
        Some(word.printed(value))
    }

    /// What is printed for a joint at `value` in machine coordinates, as near to it as its `travel` allows, in program
    /// units, and its place among the words.
    pub fn machine_word(
        &self,
        joint: usize,
        value: f64,
        travel: Option<[f64; 2]>,
    ) -> Option<(usize, f64)> {
        let word = self.words().find(|word| word.joint == joint)?;
        let shown = |value: f64| (value + word.reading) * word.per_unit;
        let mut printed = word.printed(shown(value));
        if let Some([least, most]) = travel {
            // A limit that is a printed number but for its last bits is that number.
            let bits = 1e-6 * word.per_scale;
            if printed > shown(most) + bits {
                printed = word.printed(printed - word.per_scale);
            } else if printed < shown(least) - bits {
                printed = word.printed(printed + word.per_scale);
            }
        }
        Some((word.place, printed))
    }

    /// Values of a joint that are printed inside its travel: those between the outermost printed numbers in
    /// it, and so far beyond them as is still printed as they are. mm or radians.
    pub fn printed_travel(&self, joint: usize, [least, most]: [f64; 2]) -> [f64; 2] {
        let mut words = self.words();
        let coupled = self.coupled.as_ref().is_some_and(|map| map.is_coupled(joint));
        let Some(word) = words.find(|word| word.joint == joint).filter(|_| !coupled) else {
            return [least, most];
        };
        let steps = |value: f64| (value + word.reading) * word.per_unit * word.scale;
        let value = |steps: f64| steps * word.per_scale * word.unit - word.reading;
        // A limit that is a printed number but for its last bits is that number.
        let first = libm::ceil(steps(least) - 1e-6) - 0.499;
        let last = libm::floor(steps(most) + 1e-6) + 0.499;
        [value(first), value(last)]
    }

    /// The outermost values of a linear joint inside its travel that words can say, mm.
    pub fn printed_ends(&self, joint: usize, [least, most]: [f64; 2]) -> [f64; 2] {
        let Some(word) = self.linear.iter().find(|word| word.joint == joint) else {
            return [least, most];
        };
        let zero = self.zero[joint];
        let steps = |value: f64| (value - zero) * word.per_unit * word.scale;
        let value = |steps: f64| steps * word.per_scale * word.unit + zero;
        // A limit that is a printed number but for its last bits is that number.
        [value(libm::ceil(steps(least) - 1e-6)), value(libm::floor(steps(most) + 1e-6))]
    }

    /// Half of the last decimal of the coarsest linear word, mm, and of the coarsest rotary one, radians; zero if
    /// there is none.
    pub fn half_decimal(&self) -> [f64; 2] {
        [&self.linear, &self.rotary].map(|words| {
            let halves = words.iter().map(|word| 0.5 * libm::fabs(word.unit) / word.scale);
            halves.fold(0.0, f64::max)
        })
    }

    /// The largest error of the tip that rounding the linear words can make, mm.
    pub fn rounding(&self) -> f64 {
        self.linear.iter().map(|word| 0.5 * word.unit / word.scale).sum()
    }

    /// The largest error of the tool axis that rounding the rotary words can make, radians.
    pub fn axis_rounding(&self) -> f64 {
        let half = |word: &Word| 0.5 * DEGREE / word.scale;
        let Some(map) = &self.coupled else {
            return self.rotary.iter().map(|word| 0.5 * word.unit / word.scale).sum();
        };
        let mut halves = Joints::default();
        self.rotary.iter().for_each(|word| halves[word.joint] = half(word));
        self.rotary.iter().map(|word| map.rounded(word.joint, &halves)).sum()
    }
}

/// Added and taken away, it rounds to an integer, ties to even, for all that a machine can reach; the functions of the
/// library cost a call each.
const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

impl Word {
    /// A printed angle as the control shows it over one turn that begins at `from`, degrees.
    #[inline(always)]
    fn within_turn(&self, value: f64, from: f64) -> f64 {
        let turns = (value - from) / 360.0;
        let nearest = turns + ROUND - ROUND;
        let whole = if nearest > turns { nearest - 1.0 } else { nearest };
        self.printed(value - 360.0 * whole)
    }

    /// The number nearest to `value` that has its decimals, never -0.
    #[inline(always)]
    fn printed(&self, value: f64) -> f64 {
        (value * self.scale + ROUND - ROUND) * self.per_scale + 0.0
    }
}
