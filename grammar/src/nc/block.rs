//! What a block of an NC program says.
//!
//! Nothing is interpreted here: numbers keep the program's units, modal words are not carried on, and which word means
//! what is for readers that know the control. A block is filled anew again and again, so that reading allocates nothing
//! for blocks of plain words.

use std::borrow::Cow;

use super::expression::NcExpression;

/// How a program is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Notation {
    /// Words after letters: ISO 6983 and what the controls have added to it.
    #[default]
    Words,
    /// Heidenhain's conversational form.
    Conversational,
    /// Statements of robots' languages, one a line.
    Statements,
}

/// What a reader must know of a control before it can tell words from remarks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NcSyntax {
    /// How its programs are written.
    pub notation: Notation,
    /// What begins a remark that ends with the line: `;`.
    pub line_remarks: Vec<String>,
    /// `;` ends a block (Fanuc and its like): behind it stands the next one, and prose is taken for a remark.
    pub semicolon_ends: bool,
    /// What begins and ends a remark within a line: `(` and `)`.
    pub enclosed_remarks: Option<(char, char)>,
    /// Variables are `#1`, `#<name>` (Fanuc, LinuxCNC), not names or `R1` (Siemens).
    pub hash_variables: bool,
    /// `#` begins an instruction (`#RTCP ON`), and `%` stands in front of a program's name: Fagor, ISG.
    pub instructions: bool,
}

/// One block (continuations joined).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NcBlock {
    /// Line of the file on which the block begins, counted from 1.
    pub line: u64,
    /// `/` stands in front: left out where the operator's switch says so.
    pub skipped: bool,
    /// Number of the block: `N812`, or the number in front of a conversational block.
    pub number: Option<u64>,
    /// What it says, in the order written.
    pub items: Vec<NcItem>,
    /// Remarks, without what begins and ends them.
    pub remarks: Vec<String>,
}

impl NcBlock {
    /// Takes out all that was read, and keeps the room.
    pub fn clear(&mut self) {
        self.skipped = false;
        self.number = None;
        // Most own nothing: to find that out here is cheaper than to have each dropped.
        while let Some(item) = self.items.pop() {
            match &item {
                NcItem::Word(word) if matches!(word.value, NcValue::Number(_)) => {
                    std::mem::forget(item);
                }
                _ => drop(item),
            }
        }
        self.remarks.clear();
    }
}

/// One thing that a block says.
#[derive(Clone, Debug, PartialEq)]
pub enum NcItem {
    /// A letter and its value: `X10.`, `G43.4`, `M6`, `F=R1`, `X=DC(10)`, `IY-5` (conversational, incremental).
    Word(NcWord),
    /// A longer name and its value: `A3=0.5`, `CR=5`, `T1="D10"` is not (that is a word), `SPA+30`, `DIST50`, `Q200=2`
    /// within a cycle's definition.
    Named {
        /// Name in capitals.
        name: Cow<'static, str>,
        /// Value that is set.
        value: NcValue,
    },
    /// A variable gets a value: `#1=5`, `R1=R2+1`, `_Z_HOME=610.`, `Q1 = +5`, `FN 0: Q1 = +5`.
    Assign {
        /// The variable, and of an array its index: in capitals, `#1` as `#1`, `R1` as `R1`.
        variable: Box<NcExpression>,
        /// Value that is set.
        value: Box<NcExpression>,
    },
    /// A call with parentheses: `CYCLE81(50,0,2,-10)`, `MSG("TEXT")`; `MCALL` in front of one is a [`NcItem::Name`] of
    /// its own. An instruction with brackets: `#CS ON [0, 0, 10, 30, 0, 0]`.
    Call {
        /// Name in capitals.
        name: String,
        /// Arguments; none where a place between commas is empty.
        arguments: Vec<Option<NcValue>>,
    },
    /// A name alone: `TRAORI`, `MCALL`, `ROT`, `#RTCP ON`, `FMAX`, `R0`, `DR-`, `L`, `CC`, `TOOL CALL`, `CYCL DEF`, `PLANE SPATIAL`
    /// (conversational keywords of several words are one name, with one blank between them).
    Name(Cow<'static, str>),
    /// A number alone: the tool of `TOOL CALL 5`, the cycle of `CYCL DEF 7.1`.
    Number(NcNumber),
    /// A text alone: `TOOL CALL "D10"`, the dialogue text of `CYCL DEF 200 DRILLING`.
    Text(String),
    /// What leads the program elsewhere.
    Flow(Box<NcFlow>),
    /// A statement of a robot's language.
    Statement(Vec<NcTerm>),
}

/// A part of a statement.
#[derive(Clone, Debug, PartialEq)]
pub enum NcTerm {
    /// A name in capitals, with the names of components behind points: `MOVEABSJ`, `$VEL.CP`, `HERE.ROBAX.RAX_1`.
    Name(String),
    /// A number with its sign.
    Number(NcNumber),
    /// A text in quotation marks, without them, as written.
    Text(String),
    /// What stands between brackets; the one that opens them.
    Group(u8, Vec<NcTerm>),
    /// Any other sign, its first byte: `,`, `;`, `=`; `:=` is two.
    Sign(u8),
}

/// A letter and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct NcWord {
    /// The letter, a capital; `@` and `^` of polar coordinates.
    pub letter: u8,
    /// Whether the value is a way from where the tool stands: `IX` (conversational), `X=IC(5)` (Siemens).
    pub incremental: bool,
    /// Value of the word.
    pub value: NcValue,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum NcValue {
    /// A number as written.
    Number(NcNumber),
    /// An expression: `[#1+2]`, `R1*2`, `+Q120`.
    Expression(Box<NcExpression>),
    /// A text in quotation marks, without them.
    Text(String),
    /// A position approached in a way of its own: `DC(10)`, `ACP(10)`, `ACN(10)`, `AC(10)`, `IC(5)`.
    Approached(Approach, Box<NcValue>),
}

/// How a position is approached, or what it counts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Approach {
    /// `AC`: absolute in this word.
    Absolute,
    /// `IC`: incremental in this word.
    Incremental,
    /// `DC`: the shorter way.
    Shortest,
    /// `ACP`: turning to the positive side.
    Positive,
    /// `ACN`: turning to the negative side.
    Negative,
    /// `DAC`, `DIC`, `RAC`, `RIC`: a diameter or a radius, whatever the words of the axis are.
    Across(Across),
}

/// A word of a diameter or a radius, in its block alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Across {
    /// A diameter, else a radius.
    pub diameter: bool,
    /// A way, else a position.
    pub incremental: bool,
}

/// A number as written.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NcNumber {
    /// Value as a number.
    pub value: f64,
    /// Whether a decimal point is written: without one, some controls count in their least increment.
    pub point: bool,
}

/// What leads the program elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub enum NcFlow {
    /// A place to go to: `MARK1:` (Siemens), `LBL 500` (conversational), `O1001` at the head of a subprogram is one
    /// too.
    Label(String),
    /// `LBL 0`, `M99` is a word; a subprogram's end that is no word.
    LabelEnd,
    /// `GOTO 100`, `GOTOF MARK1`, `GOTOB N10`; with a condition `IF [#1 EQ 2] GOTO 100`, `IF R1>5 GOTOF MARK`,
    /// `FN 9: IF +Q1 EQU +5 GOTO LBL 3`.
    Goto {
        /// The label, or the number of the block.
        target: NcExpression,
        /// Direction in which the target is looked for.
        direction: JumpDirection,
        /// Condition that must hold for the jump.
        condition: Option<NcExpression>,
    },
    /// `IF [..] THEN` of one block: what follows in this block holds only if this does.
    Then(NcExpression),
    /// `IF cond`, `o1 if [..]`: up to its `Else` or `EndIf`. `name` is that of LinuxCNC's `o` words.
    If {
        /// The name.
        name: Option<String>,
        /// Condition of the branch.
        condition: NcExpression,
    },
    /// `o1 elseif [..]`.
    ElseIf {
        /// The name.
        name: Option<String>,
        /// Condition of the loop.
        condition: NcExpression,
    },
    /// `ELSE`.
    Else(Option<String>),
    /// `ENDIF`.
    EndIf(Option<String>),
    /// `WHILE cond`, `WHILE [..] DO1`, `o1 while [..]`.
    While {
        /// The name: `1` of `DO1`.
        name: Option<String>,
        /// Condition of the loop.
        condition: NcExpression,
    },
    /// `ENDWHILE`, `END1`, `o1 endwhile`.
    EndWhile(Option<String>),
    /// `FOR R1 = 1 TO 5`.
    For {
        /// The variable.
        variable: NcExpression,
        /// First value of the counter.
        from: NcExpression,
        /// Last value of the counter.
        to: NcExpression,
    },
    /// `ENDFOR`.
    EndFor,
    /// `LOOP`: without end, so refused once its count is passed.
    Loop,
    /// `ENDLOOP`.
    EndLoop,
    /// `REPEAT` (Siemens, up to `UNTIL`), `o1 do` (up to its `while`).
    Do(Option<String>),
    /// `UNTIL cond`: ends when it holds.
    Until(NcExpression),
    /// `o1 repeat [n]`.
    Repeat {
        /// The name.
        name: Option<String>,
        /// How often.
        times: NcExpression,
    },
    /// `o1 endrepeat`.
    EndRepeat(Option<String>),
    /// `REPEAT MARK1 P=3`, `REPEATB`: from the label to here once more.
    RepeatFrom {
        /// The label.
        label: String,
        /// The label that ends the part, if there is one.
        until: Option<String>,
        /// How often more.
        times: Option<NcExpression>,
    },
    /// `o1 sub`, `PROC name`.
    SubBegin(String),
    /// `o1 endsub`, `RET`, `M17` is a word.
    SubEnd(Option<String>),
    /// `CALL LBL 5 REP 2`, `o1 call [1] [2]`, a name in parentheses is a [`NcItem::Call`].
    Call {
        /// The label or the name.
        target: String,
        /// How often: `REP 2` means twice more.
        repeat: Option<NcExpression>,
        /// Arguments of the call.
        arguments: Vec<NcExpression>,
    },
    /// `CALL PGM name`, `o<name> call` of another file: not here.
    CallProgram(String),
    /// `o1 return`.
    Return(Option<String>),
    /// `o1 break`.
    Break(Option<String>),
    /// `o1 continue`.
    Continue(Option<String>),
}

/// Where a jump looks for its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JumpDirection {
    /// Searches from here to the end, then from the beginning.
    Anywhere,
    /// Searches from here to the end (`GOTOF`).
    Forward,
    /// Searches from here to the beginning (`GOTOB`).
    Back,
}
