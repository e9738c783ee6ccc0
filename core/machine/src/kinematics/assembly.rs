//! Where the platform of a parallel machine stands when its drives are told, and that it can stand there in one way.
//!
//! The way back from the drives to the axes of the chain is Newton's, and ends in the assembly that it began in as long as
//! the matrix `J` of the drives' rates keeps its rank. That is proven over a box of axis values: with `A·J(m) = 1` in its
//! middle, `A·J(q)` is regular as far as the changes of the rows of `J` add up to less than one, and these are bounded by
//! the second derivatives of the drives. A box that is not proven so is halved.

use nalgebra::{DMatrix, SMatrix, SVector};

use super::chain::{Joints, MAX_AXES};
use super::leg::{AxisRegion, Leg};

/// The most legs that are looked at together.
const MOST: usize = 12;

/// Newton's steps from one start.
const STEPS: usize = 50;

/// Residuals of drives below this are taken as none, mm or radians.
const SOLVED: f64 = 1e-10;

/// Boxes before what is left of the travel is told as not proven.
const MOST_BOXES: usize = 60_000;

/// Half-width that an axis is measured by which stands still, mm or radians.
const STANDING: f64 = 0.1;

type Rates = SMatrix<f64, MOST, MAX_AXES>;
type Inverse = SMatrix<f64, MAX_AXES, MOST>;

/// What is proven of the assemblies of a parallel machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AssemblyProof {
    /// Nowhere in its travel, all legs within theirs, can it come from one assembly into another.
    One {
        /// Boxes that it took.
        boxes: usize,
    },
    /// Beside these axis values it is not proven, mm and radians.
    Open {
        /// Axis values.
        beside: Joints,
    },
    /// The legs are fewer than the axes that move them.
    Few,
}

/// The legs of a machine, and the axes that they tell.
#[derive(Clone, Debug)]
pub struct Assembly<'a> {
    legs: Vec<&'a Leg>,
    /// Places in the chain of the axes that move a leg, in its order.
    places: Vec<usize>,
}

impl<'a> Assembly<'a> {
    /// The assembly of at most twelve legs.
    pub fn new(legs: impl Iterator<Item = &'a Leg>) -> Self {
        let legs: Vec<&Leg> = legs.take(MOST).collect();
        let mut places: Vec<usize> = legs.iter().flat_map(|leg| leg.places()).collect();
        places.sort_unstable();
        places.dedup();
        Self { legs, places }
    }

    /// The drives at axis values, mm and radians; none where a leg does not reach.
    pub fn drives(&self, joints: &Joints) -> Option<Vec<f64>> {
        self.legs.iter().map(|leg| leg.value(joints)).collect()
    }

    /// Axis values near `start` at which the drives stand as `drives` says (mm and radians, in the order of the legs); those
    /// that no leg tells as in `start`.
    pub fn forward(&self, drives: &[f64], start: &Joints) -> Option<Joints> {
        let mut joints = *start;
        let mut size = self.miss(drives, &joints)?.norm();
        for _ in 0..STEPS {
            if size < SOLVED {
                return Some(joints);
            }
            let step = self.inverse(&joints, &[1.0; MAX_AXES])? * self.miss(drives, &joints)?;
            let mut share = 1.0;
            loop {
                let mut next = joints;
                for (column, place) in self.places.iter().enumerate() {
                    next[*place] -= share * step[column];
                }
                match self.miss(drives, &next).map(|miss| miss.norm()) {
                    Some(less) if less < size => {
                        (joints, size) = (next, less);
                        break;
                    }
                    // At the end of what numbers hold a step does no good any more.
                    _ if share < 1e-3 => return (size < 1e3 * SOLVED).then_some(joints),
                    _ => share *= 0.5,
                }
            }
        }
        None
    }

    /// Places in the chain of the axes that move a leg, in its order.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// The determinant of the drives' rates at axis values, whose sign the platform cannot change within one assembly; none
    /// where there are more drives than axes, or one of them has no rates.
    pub fn determinant(&self, joints: &Joints) -> Option<f64> {
        let count = self.places.len();
        if self.legs.len() != count {
            return None;
        }
        let mut matrix = DMatrix::zeros(count, count);
        for (row, leg) in self.legs.iter().enumerate() {
            let rates = leg.rates(joints)?;
            for (column, place) in self.places.iter().enumerate() {
                matrix[(row, column)] = rates[*place];
            }
        }
        Some(matrix.determinant())
    }

    /// By how much the drives are off, a row a leg.
    fn miss(&self, drives: &[f64], joints: &Joints) -> Option<SVector<f64, MOST>> {
        let mut miss = SVector::zeros();
        for (row, (leg, wanted)) in self.legs.iter().zip(drives).enumerate() {
            miss[row] = leg.value(joints)? - wanted;
        }
        Some(miss)
    }

    /// What brings the rates of the drives to one, each axis counted by its `scales`; none where they lose their rank.
    fn inverse(&self, joints: &Joints, scales: &Joints) -> Option<Inverse> {
        let mut rates = Rates::zeros();
        for (row, leg) in self.legs.iter().enumerate() {
            let of_leg = leg.rates(joints)?;
            for (column, place) in self.places.iter().enumerate() {
                rates[(row, column)] = of_leg[*place] * scales[*place];
            }
        }
        let mut normal = rates.transpose() * rates;
        for column in self.places.len()..MAX_AXES {
            normal[(column, column)] = 1.0;
        }
        Some(normal.cholesky()?.inverse() * rates.transpose())
    }

    /// What is proven while each axis stays between its values in `ends`, mm and radians.
    pub fn prove(&self, [least, most]: [&Joints; 2]) -> AssemblyProof {
        if self.legs.len() < self.places.len() {
            return AssemblyProof::Few;
        }
        let mut left = vec![(*least, *most)];
        let mut boxes = 0;
        while let Some((least, most)) = left.pop() {
            boxes += 1;
            let ends = [&least, &most];
            if self.legs.iter().any(|leg| leg.is_out(ends)) || self.is_regular(ends) {
                continue;
            }
            let middle: Joints = std::array::from_fn(|place| 0.5 * (least[place] + most[place]));
            let reach = self.reach(&middle);
            let moves = |place: &usize| (most[*place] - least[*place]) * reach[*place];
            let widest = self.places.iter().max_by(|a, b| moves(a).total_cmp(&moves(b)));
            let Some(widest) = widest.copied().filter(|_| boxes < MOST_BOXES) else {
                return AssemblyProof::Open { beside: middle };
            };
            let (mut below, mut above) = (most, least);
            below[widest] = middle[widest];
            above[widest] = middle[widest];
            left.push((least, below));
            left.push((above, most));
        }
        AssemblyProof::One { boxes }
    }

    /// How far each axis moves any drive at most, a unit of it, at axis values.
    fn reach(&self, joints: &Joints) -> Joints {
        let rates = self.legs.iter().filter_map(|leg| leg.rates(joints));
        rates.fold([f64::MIN_POSITIVE; MAX_AXES], |reach, rates| {
            std::array::from_fn(|place| reach[place].max(libm::fabs(rates[place])))
        })
    }

    /// The rates of the drives keep their rank all over a box.
    fn is_regular(&self, [least, most]: [&Joints; 2]) -> bool {
        let middle: Joints = std::array::from_fn(|place| 0.5 * (least[place] + most[place]));
        let half: Joints = std::array::from_fn(|place| 0.5 * (most[place] - least[place]));
        let scales = half.map(|half| if half > 0.0 { half } else { STANDING });
        let Some(inverse) = self.inverse(&middle, &scales) else {
            return false;
        };
        let region = AxisRegion { middle, half, speeds: scales, bends: Joints::default() };
        let moving = self.places.iter().filter(|place| half[**place] > 0.0).count();
        let changes = self
            .legs
            .iter()
            .enumerate()
            .map(|(row, leg)| inverse.column(row).norm() * leg.rates_stray(&region, moving));
        changes.sum::<f64>() < 1.0
    }
}
