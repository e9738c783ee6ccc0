//! Words of slides where the control keeps the tip: X, Y and Z are the tip's, whatever the machine file calls the slides.

use super::{Axis, TIP_WORDS};

/// Orders of the words over three slides; of such as fit alike the first.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// Gives the words X, Y and Z to three moving slides that have other names: each slide the word of the coordinate that it
/// moves along, as far as three slides that lean can be told apart so. Slides that have those names keep them, and where not
/// three move nothing is given.
pub(super) fn give(axes: &mut [Axis]) {
    let moves = |axis: &Axis| !axis.joint.rotary && axis.indexed.is_none();
    let slides: Vec<usize> = (0..axes.len()).filter(|place| moves(&axes[*place])).collect();
    let taken = |axis: &Axis| TIP_WORDS.contains(&axis.name.as_str()) && !moves(axis);
    let &[one, two, three] = slides.as_slice() else {
        return;
    };
    let slides = [one, two, three];
    if axes.iter().any(taken)
        || slides.iter().all(|place| TIP_WORDS.contains(&axes[*place].name.as_str()))
    {
        return;
    }
    let named = |order: &&[usize; 3]| {
        slides.iter().zip(*order).all(|(place, word)| {
            let name = axes[*place].name.as_str();
            !TIP_WORDS.contains(&name) || name == TIP_WORDS[*word]
        })
    };
    let along = |order: &[usize; 3]| {
        let each = slides.iter().zip(order);
        each.map(|(place, word)| libm::fabs(axes[*place].joint.direction[*word])).sum::<f64>()
    };
    // Rounding of a direction is no reason.
    let better = |one: &[usize; 3], other: &[usize; 3]| along(one) > along(other) + 1e-9;
    let fits = ORDERS.iter().filter(named);
    let best = fits.reduce(|best, order| if better(order, best) { order } else { best });
    for (place, word) in slides.into_iter().zip(best.into_iter().flatten()) {
        let word = TIP_WORDS[*word];
        if axes[place].name != word {
            axes[place].tip_word = Some(word);
        }
    }
}
