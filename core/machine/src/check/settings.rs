//! Where the index axes that are not solved for can stand: posting tries their positions off the part, so what can be
//! reached is what one of them reaches.

use crate::description::{Machine, Positions};
use crate::kinematics::travel::{AT_END, passed};
use crate::kinematics::{Joints, NoClosedForm, Solver};

/// Settings that are asked, spread over all that there are.
pub(super) const MOST: usize = 8;

/// The same of a chain that is searched.
const MOST_SEARCHED: usize = 3;

/// The solvers of `machine` with a tool of `length` mm: the first with the index axes where they start, then one for
/// each other position of one of them.
///
/// # Errors
/// What the chain lacks where they start.
pub(super) fn solvers(machine: &Machine, length: f64) -> Result<Vec<Solver>, NoClosedForm> {
    let start = machine.solution.start;
    let first = machine.solver(length)?;
    let most = if first.closed_form() { MOST } else { MOST_SEARCHED };
    let mut others: Vec<Joints> = Vec::new();
    for place in machine.redundant() {
        for value in positions(machine, place) {
            if libm::fabs(value - start[place]) > 1e-9 {
                let mut held = start;
                held[place] = value;
                others.push(held);
            }
        }
    }
    let mut solvers = vec![first];
    let asked = others.len().min(most - 1);
    for index in 0..asked {
        // A position at which the chain has no solution adds none.
        let held = &others[index * others.len() / asked];
        solvers.extend(machine.solver_at(length, held));
    }
    Ok(solvers)
}

/// Most positions of an axis in steps that are looked at.
const MOST_STEPS: f64 = 720.0;

/// Where an index axis can stand inside its travel; of an endless one within a turn. Empty if anywhere.
pub(super) fn positions(machine: &Machine, place: usize) -> Vec<f64> {
    let axis = &machine.axes[place];
    let Some(indexed) = &axis.indexed else {
        return Vec::new();
    };
    let inside = |value: &f64| passed(axis.travel, *value, AT_END).is_none();
    match &indexed.positions {
        Positions::Any => Vec::new(),
        Positions::List(values) => values.iter().copied().filter(inside).collect(),
        Positions::Step { first, step } => {
            let half = std::f64::consts::PI;
            let [least, most] = axis.travel.unwrap_or([-half, half]);
            let count = libm::floor((most - least) / step + AT_END).min(MOST_STEPS) as u32;
            let from = first + libm::ceil((least - first) / step - AT_END) * step;
            // A whole turn of an endless axis is where it began.
            let whole = |value: &f64| axis.travel.is_none() && value - from > 2.0 * half - AT_END;
            (0..=count)
                .map(|number| from + f64::from(number) * step)
                .filter(|value| inside(value) && !whole(value))
                .collect()
        }
    }
}
