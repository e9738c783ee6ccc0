//! What a control reads: its language, and where it has the lengths of tools from.

use crate::capabilities::Capabilities;
use crate::field::{Codes, codes};

codes! {
    /// The language of a control's programs: what stands around the words that its vocabulary names, how expressions,
    /// loops and calls are written, and which words all controls of the language share.
    #[derive(Default)]
    Language "LANGUAGE" {
        /// Letters, `#1`, `IF [#1 EQ 2] GOTO 3`: Fanuc and what is like it. Dialects that declare no language have it.
        #[default]
        Macro = 0 "MACRO",
        /// Letters, `#1`, `#<name>`, `o1 while [..]`: RS-274/NGC.
        Rs274 = 1 "RS274",
        /// Names with `=`, calls with parentheses, `R1`: SINUMERIK.
        Names = 2 "NAMES",
        /// `L X+1 R0 FMAX`, `Q1`: Heidenhain.
        Conversational = 3 "CONVERSATIONAL",
        /// Letters, `#RTCP ON`, `P1`: Fagor from the 8070 on, and ISG's kernel, whose instructions it shares.
        Instructions = 4 "INSTRUCTIONS",
        /// `MoveAbsJ [[..],[..]],..;`, `PTP {A1 ..}`, `movej([..])`: statements of robots, which lead their joints. Words of
        /// all axes, sliding ones too, are positions as the control shows them; there is no work offset.
        Joints = 5 "JOINTS",
    }
}

impl Language {
    /// Its name in the contract, behind `POST_LANGUAGE_`.
    pub fn name(self) -> &'static str {
        let mut names = Self::CODES.codes.iter();
        names.find(|(_, code)| *code == self.code()).map_or("", |(name, _)| *name)
    }
}

/// Where a control has the length of the tool from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lengths {
    /// From a register, H, which a program names.
    Registers,
    /// From an edge of the tool, D1, which a program names: [`Capabilities::TOOL_EDGES`].
    Edges,
    /// From its own table, by the tool in the spindle: [`Capabilities::TOOL_TABLE`].
    Tools,
    /// From nowhere: the work offset is set with the tool in the spindle: [`Capabilities::LENGTH_IN_OFFSET`].
    WorkOffset,
}

impl Lengths {
    /// A program names where the length stands, and must, ahead of a cut.
    pub fn are_named(self) -> bool {
        matches!(self, Self::Registers | Self::Edges)
    }
}

impl Capabilities {
    /// Where a dialect that declares these has the length of the tool from.
    pub const fn lengths(self) -> Lengths {
        if self.has(Self::LENGTH_IN_OFFSET) {
            Lengths::WorkOffset
        } else if self.has(Self::TOOL_EDGES) {
            Lengths::Edges
        } else if self.has(Self::TOOL_TABLE) {
            Lengths::Tools
        } else {
            Lengths::Registers
        }
    }
}
