//! Clamps of axes: the words by which the machine file has them go on and off, and an axis that turns in its clamp.

use post_machine::description::{Clamp, Machine};
use post_machine::kinematics::Joints;

use super::block::m_number;
use super::state::ControlState;

/// An axis that goes no farther than this, mm or rad, stands: a turn away its angle is another number.
const STILL: f64 = 1e-9;

/// Which axes are clamped, as bits of their places in the machine file.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ClampState {
    /// Those that were when the block began, and that it has not let go.
    held: u32,
    /// Those that it clamps, which counts from the next one on.
    clamped: u32,
}

impl ClampState {
    /// Whether M and `code` is a word of `machine` that clamps an axis or lets it go, which is then noted.
    pub fn take(&mut self, machine: &Machine, code: u16) -> bool {
        let axes = |word: fn(&Clamp) -> &str| {
            let clamps = machine.axes.iter().enumerate();
            let clamps = clamps.filter_map(|(place, axis)| Some((place, axis.clamp.as_ref()?)));
            let own = clamps.filter(|(_, clamp)| m_number(word(clamp)) == Some(code));
            own.fold(0, |axes, (place, _)| axes | 1 << place)
        };
        let (on, off) = (axes(|clamp| &clamp.on), axes(|clamp| &clamp.off));
        self.clamped = (self.clamped | on) & !off;
        self.held &= !off;
        on | off != 0
    }

    /// No axis is clamped.
    pub fn are_off(self) -> bool {
        self.held | self.clamped == 0
    }
}

impl ControlState {
    /// Looks, at the end of a block that began at `before`, whether it moved an axis that was clamped.
    #[cold]
    pub(super) fn end_clamped_block(&mut self, before: &Joints) {
        let ClampState { held, clamped } = self.clamps;
        self.clamps = ClampState { held: held | clamped, clamped: 0 };
        let moved = |place: &usize| {
            held >> place & 1 == 1 && libm::fabs(self.at.joints[*place] - before[*place]) > STILL
        };
        let Some(place) = (0..self.machine.axes.len()).find(moved) else { return };
        let name = &self.machine.axes[place].name;
        self.report.moved_clamped.get_or_insert_with(|| (self.line, name.clone()));
    }
}
