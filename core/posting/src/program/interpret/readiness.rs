//! What must be in order before the tool moves: axis, tool, cutter.

use post_grammar::Record;

use super::Interpreter;
use crate::program::Step;

impl Interpreter {
    /// What is to be seen to before a move: the axis after an index move, the tool that the user names, a
    /// cutter without a tool.
    #[cold]
    pub(super) fn before_move(&mut self, record: &Record<'_>, emit: &mut impl FnMut(Step)) {
        if std::mem::take(&mut self.check_axis)
            && let (Some(turned), Some(told)) = (self.frame.turned(), self.told_axis)
            && (turned * self.axis - told).norm() > 1e-3
        {
            self.fault(
                record,
                "rotabl",
                "the index angles (ROTABL) do not turn the tool to the axis that TLAXIS names"
                    .to_owned(),
                "one of the two is wrong: check the operation's set-up in the CAM system",
            );
        }
        if self.loaded.is_none() {
            self.load_told(record, emit);
        }
        if self.cutter_changed && !self.told_cutter {
            self.told_cutter = true;
            self.warn(
                record,
                "cutter",
                "another cutter was described (CUTTER, TLDATA), but no tool was loaded for it: this is cut with the tool before".to_owned(),
            );
        }
    }
}
