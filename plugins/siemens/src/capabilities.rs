//! What the dialect writes beyond straight moves, by the machine and its options.

use post_plugin::Capabilities;

use crate::Siemens;

impl Siemens {
    /// Capabilities of the control with these options. Arcs and cycles lie across Z.
    pub(crate) fn declared(&self) -> Capabilities {
        use Capabilities as C;
        let upright = self.linear.is_some();
        let commands = C::MESSAGE.and(C::SUBPROGRAM).and(C::PROBE);
        // Under TRAORI there are G2 and G3 too (6FC5398-2BP20, 06/2009, p. 361).
        let arcs = C::ARC_XY.and(C::ARC_TCP).and(C::ARC_RADIUS).and(C::HELIX);
        let drills = C::CYCLE_DRILL.and(C::CYCLE_DEEP).and(C::CYCLE_BREAK_CHIP);
        let cycles = drills.and(C::CYCLE_REAM).and(C::CYCLE_BORE).and(C::CYCLE_IN_PLANE);
        [
            (true, C::TCP_STILL.and(C::TOOL_TABLE).and(C::TOOL_EDGES).and(commands)),
            (true, C::LENGTH_ALONG_DEPTH),
            (upright, arcs.and(cycles)),
            (upright && self.cycles.fine(), C::CYCLE_BORE_FINE),
            (upright && self.cycles.taps(), C::CYCLE_TAP.and(C::CYCLE_TAP_LEFT)),
            (upright && self.arcs_off_xy, C::ARC_ZX.and(C::ARC_YZ)),
            (self.swivels, C::PLANE),
            (self.smoothing.known(), C::SMOOTHING),
            (self.vectors, C::TOOL_VECTOR),
        ]
        .into_iter()
        .filter(|(has, _)| *has)
        .fold(C::NONE, |all, (_, set)| all | set)
    }
}
