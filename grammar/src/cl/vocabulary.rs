//! The table of major words: how each is spelt, what reads it, and what becomes of it.
//!
//! A word is added by a row here, a reader in `statements/` and, where it has an effect, a [`Statement`] and its
//! meaning in the interpreter of `core/posting`. A word that has no row may be misspelt, and is reported as such.

use std::borrow::Cow;
use std::sync::LazyLock;

use super::record::{Argument, Statement};
use super::statements::along::{psis, tlon};
use super::statements::drilling::cycle;
use super::statements::geometry::{
    autops, circle, cntrl, csys, from, godlta, gohome, goto, head, indirv, knot, mcs, movarc, msys,
    multax, nurbs, rotate, tlaxis,
};
use super::statements::technology::{
    coolnt, delay, end_of_path, fedrat, fini, mode, opstop, rapid, spindl, stop, subprogram, sync,
    units, work_offset,
};
use super::statements::tooling::{
    cutcom, cutcom_on_centre, cutter, load_tool, select_tool, tldata,
};
use super::statements::{ReadGeometry, ReadItems, ReadTextStatement};

/// What `post` does with a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WordUsage {
    /// The word has its effect on the program.
    Used,
    /// The word's text goes into the program.
    Passed,
    /// The word says nothing that an NC program could hold (display, names of features, the CAM system's own data).
    Ignored,
    /// The word changes where or whether metal is cut, and `post` does not know how: the file is refused, unless the
    /// user takes it upon himself.
    Refused,
    /// An unknown word, or one that a program can do without: `post` does nothing with it, and says so; a file with an
    /// unknown word is refused unless the user lets it pass.
    Unknown,
}

impl WordUsage {
    /// The name that tables show.
    pub fn name(self) -> &'static str {
        match self {
            Self::Used => "used",
            Self::Passed => "passed on",
            Self::Ignored => "ignored",
            Self::Refused => "refused",
            Self::Unknown => "unknown",
        }
    }
}

/// What stands behind the word, and what takes it.
#[derive(Clone, Copy, Debug)]
pub(super) enum ArgumentForm {
    /// Items between commas, for a statement of its own.
    Items(ReadItems),
    /// Any text.
    Text(ReadTextStatement),
    /// Geometry in parentheses.
    Geometry(ReadGeometry),
    /// The whole line has a form of its own, which `line.pest` takes apart.
    Line,
    /// Items, kept as they stand in [`Statement::Other`].
    Kept,
}

/// A major word.
#[derive(Clone, Copy, Debug)]
pub struct MajorWord {
    /// All spellings, in capitals; the first is the word's name.
    pub spellings: &'static [&'static str],
    /// What becomes of it, in a form that is known.
    pub usage: WordUsage,
    /// A record that it stands in; empty for a word without a statement of its own.
    pub example: &'static str,
    /// What it means to `post`, or why nothing.
    pub meaning: &'static str,
    pub(super) behind: ArgumentForm,
    /// What becomes of it in a form that is not known: refused where the tool would end up in the wrong place.
    otherwise: WordUsage,
    /// Whether the word moves the tool, or says which records do: whatever its form, it is never left out.
    pub moves: bool,
    /// Lines that a machine file has for it go before its meaning, which not every control has words for.
    pub by_rule: bool,
}

impl MajorWord {
    /// Every word, by name.
    pub fn all() -> &'static [Self] {
        WORDS
    }

    /// The word that is spelt so; `None` if no row has that spelling. Capitals or not.
    pub fn find(spelling: &str) -> Option<&'static Self> {
        find(spelling).map(|(_, word)| word)
    }

    /// The spelling that messages and tables use.
    pub fn name(&self) -> &'static str {
        self.spellings[0]
    }

    const fn else_refused(mut self) -> Self {
        self.otherwise = WordUsage::Refused;
        self
    }

    const fn moves(mut self) -> Self {
        self.moves = true;
        self
    }

    const fn by_rule(mut self) -> Self {
        self.by_rule = true;
        self
    }
}

/// The word that is spelt so, with that spelling in capitals.
pub(super) fn find(spelling: &str) -> Option<(&'static str, &'static MajorWord)> {
    static SPELLINGS: LazyLock<Vec<(u64, &str, &MajorWord)>> = LazyLock::new(|| {
        let mut spellings = Vec::new();
        for word in WORDS {
            spellings.extend(word.spellings.iter().map(|name| (key(name), *name, word)));
        }
        spellings.sort_by_key(|(key, ..)| *key);
        spellings
    });
    let wanted = key(spelling);
    let from = SPELLINGS.partition_point(|(key, ..)| *key < wanted);
    SPELLINGS[from..]
        .iter()
        .take_while(|(key, ..)| *key == wanted)
        .find(|(_, name, _)| {
            let (name, wanted) = (name.as_bytes(), spelling.as_bytes());
            name.len() == wanted.len()
                && name[HEAD.min(name.len())..]
                    .eq_ignore_ascii_case(&wanted[HEAD.min(name.len())..])
        })
        .map(|&(_, name, word)| (name, word))
}

/// Characters of a spelling that its key holds.
const HEAD: usize = 8;

/// The first characters, in capitals: enough to tell nearly all words apart.
fn key(spelling: &str) -> u64 {
    let mut bytes = [0; HEAD];
    for (byte, character) in bytes.iter_mut().zip(spelling.bytes()) {
        *byte = character.to_ascii_uppercase();
    }
    u64::from_be_bytes(bytes)
}

impl Statement {
    /// What becomes of it.
    pub fn usage(&self) -> WordUsage {
        let word = MajorWord::find(self.word());
        let listed = word.map_or(WordUsage::Unknown, |word| word.usage);
        let Self::Other { directive, .. } = self else {
            return listed;
        };
        match listed {
            // A directive is a remark to all but the program it is meant for.
            WordUsage::Unknown | WordUsage::Used | WordUsage::Passed if *directive => {
                WordUsage::Ignored
            }
            // A known word in a form that has no statement.
            WordUsage::Used | WordUsage::Passed => {
                word.map_or(WordUsage::Unknown, |word| word.otherwise)
            }
            usage => usage,
        }
    }

    /// How it may carry a path that is not known here; none if it carries none, or its meaning is known.
    pub fn unknown_path(&self) -> Option<UnknownPath> {
        let Self::Other { word, arguments, directive: false } = self else {
            return None;
        };
        let numbers = arguments.iter().filter(|argument| matches!(argument, Argument::Number(_)));
        match MajorWord::find(word) {
            Some(row) if row.moves => Some(UnknownPath::Word),
            None if numbers.count() >= POINT => Some(UnknownPath::Numbers),
            _ => None,
        }
    }

    /// The word has no row: it may be misspelt.
    pub fn is_strange(&self) -> bool {
        matches!(self, Self::Other { word, directive: false, .. } if MajorWord::find(word).is_none())
    }
}

/// Numbers that may be a point.
const POINT: usize = 3;

/// Why a record that has no meaning here may carry a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnknownPath {
    /// The word is one of those that move the tool.
    Word,
    /// The word is not known, and has numbers enough for a point.
    Numbers,
}

const fn row(
    spellings: &'static [&'static str],
    usage: WordUsage,
    behind: ArgumentForm,
    [example, meaning]: [&'static str; 2],
) -> MajorWord {
    MajorWord {
        spellings,
        usage,
        example,
        meaning,
        behind,
        otherwise: WordUsage::Unknown,
        moves: false,
        by_rule: false,
    }
}

const fn used(
    spellings: &'static [&'static str],
    read: ReadItems,
    told: [&'static str; 2],
) -> MajorWord {
    row(spellings, WordUsage::Used, ArgumentForm::Items(read), told)
}

const fn passed(
    spellings: &'static [&'static str],
    behind: ArgumentForm,
    told: [&'static str; 2],
) -> MajorWord {
    row(spellings, WordUsage::Passed, behind, told)
}

const fn ignored(spellings: &'static [&'static str], why: &'static str) -> MajorWord {
    row(spellings, WordUsage::Ignored, ArgumentForm::Kept, ["", why])
}

/// Row of a word that is ignored, though its record is read.
const fn ignored_as(
    spellings: &'static [&'static str],
    behind: ArgumentForm,
    told: [&'static str; 2],
) -> MajorWord {
    row(spellings, WordUsage::Ignored, behind, told)
}

const fn refused(spellings: &'static [&'static str], why: &'static str) -> MajorWord {
    row(spellings, WordUsage::Refused, ArgumentForm::Kept, ["", why])
}

/// Moves the tool, or says which records do, in a way that `post` does not know.
const fn motion(spellings: &'static [&'static str], why: &'static str) -> MajorWord {
    refused(spellings, why).moves()
}

/// Known by name, and left out with a warning.
const fn unsupported(spellings: &'static [&'static str], meaning: &'static str) -> MajorWord {
    row(spellings, WordUsage::Unknown, ArgumentForm::Kept, ["", meaning])
}

/// A text without a statement of its own.
fn feature(word: &'static str, text: String) -> Statement {
    let argument = (!text.is_empty()).then_some(Argument::Word(text));
    Statement::Other {
        word: Cow::Borrowed(word),
        arguments: argument.into_iter().collect(),
        directive: false,
    }
}

/// A text as Autodesk's posts write it, `'..'`, without the marks.
fn unquoted(text: String) -> String {
    let inside = text.strip_prefix('\'').and_then(|text| text.strip_suffix('\''));
    match inside {
        Some(inside) if !inside.contains('\'') => inside.to_owned(),
        _ => text,
    }
}

/// The words that have a statement of their own, those of ISO 4343 and PostWorks that have none, and those that
/// CAM systems add; in alphabetical order.
#[rustfmt::skip]
static WORDS: &[MajorWord] = &[
    motion(&["ARC", "ARCMOV", "CIRMOV"], "an arc in a form that nobody here knows"),
    refused(&["ARCSLP"], "slope of a helix"),
    used(&["AUTOPS"], autops, ["AUTOPS", "the tip stays in its plane of X and Y (CATIA)"]).else_refused().moves(),
    refused(&["AUXFUN"], "an M function by its number"),
    ignored(&["BOX"], "the blank"),
    unsupported(&["BREAK"], "a break in the tape"),
    motion(&["CALL"], "runs a macro"),
    used(&["CALSUB"], subprogram, ["CALSUB/100", "runs a subprogram by its number, if the dialect calls any"]).else_refused().by_rule(),
    ignored(&["CAMERA"], "display"),
    unsupported(&["CHECK"], "limits of the axes to be watched; post watches those of the machine file"),
    used(&["CIRCLE"], circle, ["CIRCLE/0,0,0,0,0,1,10", "arc to the next GOTO: centre, axis, radius"]).else_refused(),
    refused(&["CLAMP"], "clamps an axis or a part"),
    refused(&["CLEARP"], "clearance plane, to which RETRCT goes"),
    refused(&["CLRSRF"], "clearance plane, to which RETRCT goes"),
    used(&["CNTRL"], cntrl, ["CNTRL/1,2,3", "control point of a spline"]),
    motion(&["CONTUR", "PROFIL", "POCKET", "REGION", "WATERL", "FMILL", "RMILL", "SCRUB"], "moves that only the APT processor can compute"),
    used(&["COOLNT"], coolnt, ["COOLNT/FLOOD", "coolant"]),
    motion(&["COPY"], "repeats moves"),
    refused(&["COUPLE"], "couples the spindle with an axis"),
    ignored(&["CSI_SET_EXTENSION_LENGTH"], "the tool in the CAM system's library"),
    ignored(&["CSI_SET_FLUTE_LENGTH"], "the tool in the CAM system's library"),
    ignored_as(&["CSYS"], ArgumentForm::Items(csys), ["CSYS/1,0,0,0,0,1,0,0,0,0,1,0", "the CAM system's frame; points are meant in the part's"]),
    motion(&["CUT"], "moves from here on are made again"),
    used(&["CUTCOM"], cutcom, ["CUTCOM/LEFT,XYPLAN", "cutter radius compensation"]).else_refused(),
    used(&["CUTCOM_GEOMETRY_TYPE"], cutcom_on_centre, ["CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER", "the points are the tool's centre, or the contour that CUTCOM offsets (Creo)"]),
    used(&["CUTTER"], cutter, ["CUTTER/10,1", "the cutter: diameter, corner radius"]),
    used(&["CYCLE"], cycle, ["CYCLE/DRILL,FEDTO,-10,MMPM,200,RAPTO,3", "cycle at the points that follow"]).else_refused(),
    motion(&["DEFSUB"], "defines a subprogram"),
    used(&["DELAY", "DWELL"], delay, ["DELAY/2", "waits: seconds, or turns with REV"]),
    ignored(&["DISPLY"], "display"),
    motion(&["DNTCUT"], "moves up to CUT are not made"),
    motion(&["DO"], "repeats what follows"),
    ignored(&["DRAFT"], "plotter"),
    used(&["END-OF-PATH"], end_of_path, ["END-OF-PATH", "end of an operation (NX)"]),
    motion(&["ENDSUB"], "ends a subprogram"),
    ignored(&["FEATNO"], "number of a feature"),
    used(&["FEDRAT"], fedrat, ["FEDRAT/MMPM,250", "feed of the cuts that follow"]),
    used(&["FINI", "END"], fini, ["FINI", "end of the file"]),
    used(&["FROM"], from, ["FROM/0,0,100", "where the tool stands; no move"]),
    motion(&["GO", "GOFWD", "GOBACK", "GOLFT", "GORGT", "GOUP", "GODOWN"], "a move to or along a surface, which only the APT processor can compute"),
    motion(&["GOCLER"], "a move to a clearance"),
    used(&["GODLTA"], godlta, ["GODLTA/0,0,5", "move by a step, or along the tool axis"]),
    used(&["GOHOME"], gohome, ["GOHOME", "to the reference, or to a point at rapid"]),
    used(&["GOTO"], goto, ["GOTO/1,2,3,0,0,1", "move to a point, with tool axis and edge as given"]),
    used(&["HEAD"], head, ["HEAD/V1", "the head that works from here on"]).else_refused(),
    motion(&["HELIX", "SPIRAL"], "a curve in a form that nobody here knows"),
    motion(&["IF"], "goes on at another line of the APT program"),
    motion(&["INCLUD", "INCLUDE"], "goes on in another file"),
    motion(&["INDEX"], "repeats moves"),
    motion(&["INDIRP"], "a direction by a point for the APT processor's moves along surfaces"),
    used(&["INDIRV"], indirv, ["INDIRV/1,0,0", "where the tool sets out along the next curve (CATIA)"]).else_refused().moves(),
    passed(&["INSERT"], ArgumentForm::Text(|_, text| Statement::Insert(text)), ["INSERT M8", "a line of the program, or a comment ([control] insert)"]),
    motion(&["JUMPTO"], "goes on at another line of the APT program"),
    used(&["KNOT"], knot, ["KNOT/0,1", "knots of a spline"]),
    motion(&["LATHE"], "turns a contour that other words set"),
    ignored(&["LEADER"], "blank tape"),
    ignored(&["LINTOL"], "tolerance; the machine file states ours"),
    used(&["LOADTL", "LOAD", "TURRET", "TOOLNO"], load_tool, ["LOADTL/3,LENGTH,120", "tool change; LOAD with TOOL"]).else_refused(),
    motion(&["LOOPST", "LOOPND"], "repeats what stands between them"),
    ignored(&["MACHIN"], "the machine that the CAM system was told; ours is --machine"),
    motion(&["MACRO"], "defines a macro"),
    ignored(&["MCHTOL"], "tolerance; the machine file states ours"),
    used(&["MCS"], mcs, ["MCS/1,0,0,0,1,0,0,0,1,0,0,0", "frame of an operation (CAMplete); another than the part's is refused"]).else_refused(),
    ignored(&["MFGNO"], "number of an operation"),
    refused(&["MIRROR"], "mirrors the points"),
    used(&["MODE"], mode, ["MODE/MILL", "the tool turns (Autodesk), MODE/TURN the part; other modes are refused"]).else_refused(),
    used(&["MOVARC"], movarc, ["MOVARC/0,0,0,0,0,1,10,ANGLE,90", "arc to the next GOTO: centre, axis, radius, angle (Autodesk)"]).else_refused().moves(),
    motion(&["MOVE", "MOVETO", "LINMOV"], "a move in a form that nobody here knows"),
    ignored(&["MOVE_ATTRIB"], "lead in, link, lead out"),
    used(&["MSYS"], msys, ["MSYS/0,0,0,1,0,0,0,1,0", "frame of the operation (--msys)"]).else_refused(),
    used(&["MULTAX"], multax, ["MULTAX/ON", "tool axis with the points; OFF: Z"]),
    used(&["NURBS"], nurbs, ["NURBS/", "a spline begins"]),
    used(&["OFSETL"], work_offset, ["OFSETL/2", "a work offset by its number, if the dialect has several"]).else_refused().by_rule(),
    ignored_as(&["OPFEATEND"], ArgumentForm::Text(feature), ["OPFEATEND/Hole1", "name of a feature"]),
    ignored_as(&["OPFEATSTART"], ArgumentForm::Text(feature), ["OPFEATSTART/Hole1", "name of a feature"]),
    refused(&["OPSKIP"], "blocks that the operator may skip"),
    used(&["OPSTOP"], opstop, ["OPSTOP", "optional stop"]),
    refused(&["ORIGIN"], "moves the origin"),
    ignored(&["PAINT"], "display"),
    passed(&["PARTNO"], ArgumentForm::Text(|_, text| Statement::PartName(unquoted(text))), ["PARTNO blade", "name of the part, as a comment"]),
    motion(&["PITCH"], "cuts a thread"),
    refused(&["PIVOTZ"], "how far the head's pivot is; the machine file says it"),
    motion(&["PLUNGE"], "a move that the control computes"),
    motion(&["POSITN"], "a move in machine coordinates"),
    refused(&["POSTN"], "moves the origin"),
    passed(&["PPRINT"], ArgumentForm::Text(|_, text| Statement::Print(unquoted(text))), ["PPRINT check clamps", "a remark for the operator"]),
    ignored(&["PPTOL"], "tolerance; the machine file states ours"),
    ignored(&["PPWORD"], "a word of another post-processor"),
    refused(&["PREFUN"], "a G function by its number"),
    motion(&["PROBE"], "probing"),
    row(&["PSIS"], WordUsage::Used, ArgumentForm::Geometry(psis), ["PSIS/(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,1,0))", "the plane that the tip stays in along the next curve (CATIA)"]).else_refused().moves(),
    used(&["RAPID"], rapid, ["RAPID", "the next move is at rapid"]),
    motion(&["READ"], "goes on in another file"),
    refused(&["REFSYS"], "a frame for the points that follow"),
    ignored_as(&["REMARK"], ArgumentForm::Text(|_, text| Statement::Remark(text)), ["REMARK roughing", "a remark"]),
    motion(&["RETRACT"], "a retract in a form that nobody here knows"),
    motion(&["RETRCT"], "retracts to a plane that other words set"),
    ignored(&["REWIND"], "winds the tape back"),
    used(&["ROTABL", "ROTATE"], rotate, ["ROTABL/BAXIS,90,CLW", "turns an index axis"]).else_refused(),
    refused(&["ROTHED"], "turns the head by an angle"),
    ignored(&["SAFETY"], "how the CAM system kept clear"),
    motion(&["SCURV", "SPLINE", "POLY"], "a curve in a form that nobody here knows"),
    used(&["SELECT", "SELCTL"], select_tool, ["SELECT/TOOL,4", "makes the next tool ready; SELECT with TOOL"]),
    ignored(&["SEQNO"], "block numbers; the machine file states ours"),
    used(&["SET"], work_offset, ["SET/OFSETL,2", "a work offset by its number, if the dialect has several"]).else_refused().by_rule(),
    unsupported(&["SLOWDN"], "slows down before corners"),
    used(&["SPINDL"], spindl, ["SPINDL/RPM,9000,CLW", "spindle"]),
    used(&["STOP"], stop, ["STOP", "stop"]),
    refused(&["SWITCH"], "another point of the insert for the points that follow (CATIA)"),
    refused(&["SYN"], "gives words of the APT program other names"),
    used(&["SYNC"], sync, ["SYNC/1,1,2", "the channels wait for one another at this mark: [wait]"]).else_refused(),
    motion(&["TERMAC"], "ends a macro"),
    motion(&["THREAD"], "cuts a thread"),
    used(&["TLAXIS"], tlaxis, ["TLAXIS/0,0,1", "tool axis of the moves that follow"]).else_refused(),
    used(&["TLDATA"], tldata, ["TLDATA/MILL,10,1,75,0,0", "the cutter (NX)"]),
    motion(&["TLLFT", "TLRGT", "TLONPS", "TLOFPS", "TLNDON"], "how the tool stands to a curve, which only the APT processor can follow"),
    row(&["TLON"], WordUsage::Used, ArgumentForm::Geometry(tlon), ["TLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,10,0,0)", "along an arc to its end (CATIA)"]).else_refused().moves(),
    ignored(&["TMARK"], "mark on the tape"),
    passed(&["TOOL PATH"], ArgumentForm::Line, ["TOOL PATH/ROUGH,TOOL,MILL_10", "an operation begins (NX); its name, as a comment"]),
    passed(&["TPRINT"], ArgumentForm::Text(|_, text| Statement::ToolName(text)), ["TPRINT/T1 End Mill D 10", "name of the tool that is loaded next (CATIA)"]),
    refused(&["TRACUT"], "moves the points by a matrix"),
    refused(&["TRANS"], "moves the points by a step"),
    ignored(&["TRNTYP"], "how the CAM system moved the points"),
    used(&["UNITS", "UNIT"], units, ["UNITS/MM", "units of the lengths"]),
    refused(&["UNLOAD"], "puts the tool away"),
    refused(&["ZERO"], "moves the origin"),
    refused(&["ZSURF"], "the height of points that give none"),
];
