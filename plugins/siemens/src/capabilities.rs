//! What it writes beyond straight moves, by the machine and its options.

use post_plugin::Capabilities;

use crate::Siemens;

impl Siemens {
    /// All of them.
    pub(crate) fn declared(&self) -> Capabilities {
        use Capabilities as C;
        let always = [
            C::TCP_STILL,
            C::TOOL_TABLE,
            C::OPERATION,
            C::MESSAGE,
            C::WORK_OFFSET,
        ];
        let always = always
            .into_iter()
            .chain([C::SURFACE_SPEED, C::SUBPROGRAM, C::PROBE]);
        let linear = [
            C::ARC_XY,
            // Under TRAORI there are G2 and G3 too (6FC5398-2BP20, 06/2009, p. 361).
            C::ARC_TCP,
            C::HELIX,
            C::ARC_RADIUS,
            C::CYCLE_IN_PLANE,
            C::CYCLE_DRILL,
        ];
        let linear = linear
            .into_iter()
            .chain([C::CYCLE_DEEP, C::CYCLE_BREAK_CHIP, C::CYCLE_REAM]);
        let some = |yes: bool, set: Capabilities| if yes { set } else { C::NONE };
        let linear = linear.chain([
            C::CYCLE_BORE,
            some(self.cycles.fine(), C::CYCLE_BORE_FINE),
            some(self.cycles.taps(), C::CYCLE_TAP.and(C::CYCLE_TAP_LEFT)),
            some(self.arcs_off_xy, C::ARC_ZX.and(C::ARC_YZ)),
        ]);
        let all = always
            .chain(linear.filter(|_| self.linear.is_some()))
            .chain([
                some(self.swivels, C::PLANE),
                some(self.smoothing.known(), C::SMOOTHING),
                some(self.vectors, C::TOOL_VECTOR),
            ]);
        all.fold(C::NONE, |all, one| all | one)
    }
}
