//! What becomes of each major word.

use post_grammar::Statement;

/// What `post` does with a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Usage {
    /// It has its effect on the program.
    Used,
    /// Its text goes into the program.
    Passed,
    /// It says nothing that an NC program could hold (display, names of features, the CAM system's own data).
    Ignored,
    /// It changes where the tool goes, and `post` does not know how: the file is refused.
    Refused,
    /// `post` does nothing with it, and says so.
    Unknown,
}

/// Words that have their effect.
const USED: &[&str] = &[
    "CIRCLE",
    "CNTRL",
    "COOLNT",
    "CUTCOM",
    "CUTTER",
    "CYCLE",
    "DELAY",
    "DWELL",
    "END",
    "END-OF-PATH",
    "FEDRAT",
    "FINI",
    "FROM",
    "GODLTA",
    "GOHOME",
    "GOTO",
    "HEAD",
    "KNOT",
    "LOAD",
    "LOADTL",
    "MSYS",
    "MULTAX",
    "NURBS",
    "OPSTOP",
    "RAPID",
    "ROTABL",
    "ROTATE",
    "SELCTL",
    "SELECT",
    "SPINDL",
    "STOP",
    "TLAXIS",
    "TLDATA",
    "TOOLNO",
    "TURRET",
    "UNIT",
    "UNITS",
];

/// Words whose text goes into the program.
const PASSED: &[&str] = &["INSERT", "PARTNO", "PPRINT", "TOOL PATH"];

/// Words that an NC program has no place for.
const IGNORED: &[&str] = &[
    "BOX",
    "CAMERA",
    "CSI_SET_EXTENSION_LENGTH",
    "CSI_SET_FLUTE_LENGTH",
    "CSYS",
    "CUTCOM_GEOMETRY_TYPE",
    "DISPLY",
    "DRAFT",
    "FEATNO",
    "LEADER",
    "LINTOL",
    "MACHIN",
    "MCHTOL",
    "MFGNO",
    "MOVE_ATTRIB",
    "OPFEATEND",
    "OPFEATSTART",
    "PAINT",
    "PPTOL",
    "PPWORD",
    "REMARK",
    "REWIND",
    "SAFETY",
    "SEQNO",
    "TMARK",
    "TRNTYP",
];

/// Words that change where the tool goes.
const REFUSED: &[&str] = &[
    "CALL", "CLEARP", "CLRSRF", "COPY", "COUPLE", "GOFWD", "INDEX", "INDIRV", "MACRO", "MODE",
    "ORIGIN", "PIVOTZ", "PLUNGE", "POSITN", "POSTN", "PSIS", "READ", "RETRCT", "ROTHED", "TERMAC",
    "THREAD", "TLON", "TRACUT", "TRANS",
];

/// Words that, in a form that is not known, would leave the tool in the wrong place.
const PLACES_THE_TOOL: [&str; 10] = [
    "CIRCLE", "CUTCOM", "CYCLE", "HEAD", "LOAD", "LOADTL", "MSYS", "ROTABL", "ROTATE", "TLAXIS",
];

/// What becomes of a record.
pub fn usage(statement: &Statement) -> Usage {
    let listed = listed(statement.word());
    let Statement::Other {
        word, directive, ..
    } = statement
    else {
        return listed;
    };
    match listed {
        // A directive is a remark to all but the program it is meant for.
        Usage::Unknown | Usage::Used | Usage::Passed if *directive => Usage::Ignored,
        // A known word in a form that has no statement.
        Usage::Used | Usage::Passed if PLACES_THE_TOOL.contains(&word.as_str()) => Usage::Refused,
        Usage::Used | Usage::Passed => Usage::Unknown,
        usage => usage,
    }
}

/// What becomes of `word` (in capitals), in a form that is known.
fn listed(word: &str) -> Usage {
    [
        (USED, Usage::Used),
        (PASSED, Usage::Passed),
        (IGNORED, Usage::Ignored),
        (REFUSED, Usage::Refused),
    ]
    .into_iter()
    .find(|(words, _)| words.contains(&word))
    .map_or(Usage::Unknown, |(_, usage)| usage)
}
