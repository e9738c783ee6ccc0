//! What a program says of how the control passes from one motion to the next.

use post_motion::CornerMode;

/// What the program has said of corners, from block to block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Corners {
    /// Nothing: what the control is set to holds.
    #[default]
    Unsaid,
    /// A word whose rule is the control's own, by parameters that no program names: G5.1 Q1, G8 P1, COMPCAD.
    Own,
    /// This.
    Said(CornerMode),
}
