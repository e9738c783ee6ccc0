//! Where a program begins: of axes that it has led nowhere it is not known where they stand.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_readback::{Motion, MotionKind};

/// What is known of a motion.
pub(super) enum Known {
    /// All of it.
    Way,
    /// Where it ends.
    End,
    /// Not even that.
    Nothing,
}

/// Where a program begins. It is taken to begin clear, and to have axes at zero of which it says nothing until it cuts, or
/// nothing at all.
#[derive(Clone, Debug, Default)]
pub(super) struct Start {
    /// Axes of which it is known where they stand, a bit by place.
    led: u32,
    cuts: bool,
    /// The motions that began in a place that is not known: the axes of these, the lines of the first and of the last.
    passed: Option<(u32, [u64; 2])>,
}

impl Start {
    /// What is known of the program's next motion: its linear axes stand where it has led them, and so do rotary ones that
    /// it turns.
    pub fn knows(&mut self, machine: &Machine, motion: &Motion) -> Known {
        self.cuts |= motion.kind != MotionKind::Rapid;
        if self.cuts {
            return Known::Way;
        }
        let axes = machine.axes.iter().enumerate();
        let bits = |of: &dyn Fn(usize, bool) -> bool| -> u32 {
            let axes = axes.clone().filter(|(place, axis)| of(*place, axis.joint.rotary));
            axes.map(|(place, _)| 1 << place).sum()
        };
        let moves = |place: usize| motion.from.joints[place] != motion.to.joints[place];
        let moved = bits(&|place, _| moves(place));
        let linear = bits(&|_, rotary| !rotary);
        let known = self.led | motion.led;
        let missing = (linear | moved) & !known;
        self.led = known | moved;
        if missing == 0 {
            return Known::Way;
        }
        let (axes, lines) = self.passed.get_or_insert((0, [motion.line; 2]));
        *axes |= missing;
        lines[1] = motion.line;
        if linear & !self.led == 0 { Known::End } else { Known::Nothing }
    }

    /// What was not looked at, and its first line.
    pub fn told(&self, machine: &Machine) -> Option<(u64, Diagnostic)> {
        let (missing, [first, last]) = self.passed?;
        let axes = machine.axes.iter().enumerate();
        let axes = axes.filter(|(place, _)| missing & (1 << place) != 0);
        let names = axes.map(|(_, axis)| axis.name.as_str()).collect::<Vec<_>>().join(", ");
        let message = format!(
            "the program does not say where it begins in {names}: it is taken to begin clear, and the way to line {last} is not looked at, only where it ends"
        );
        let help = "lead all linear axes to a position of the machine (G53, G28, M91) at the head of the program";
        Some((first, Diagnostic::warning("clearance", message).help(help)))
    }
}
