//! The cheapest way through the trellis, walked back from its end.

use post_machine::kinematics::Joints;

use super::trellis::Trellis;

/// The way that was walked back.
#[derive(Debug, Default)]
pub(super) struct Backtrace {
    /// States that it goes through, one a layer.
    pub(super) states: Vec<usize>,
    /// Layers where the axes are eased, in order, and where they stand there.
    pub(super) eased: Vec<(usize, Joints)>,
}

impl Backtrace {
    /// Where the axes stand at a layer.
    pub(super) fn joints(&self, trellis: &Trellis, layer: usize) -> Joints {
        match self.eased.binary_search_by_key(&layer, |(layer, _)| *layer) {
            Ok(place) => self.eased[place].1,
            Err(_) => trellis.states[self.states[layer]].joints,
        }
    }
}
