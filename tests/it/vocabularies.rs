//! What each dialect says the words of its control mean, beside a second vocabulary that was written from the facts
//! alone (`tests/vocabularies`): a program that is read back by the words of the plugin that wrote it cannot show that
//! one of them is wrong.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Cursor;

use post_grammar::nc::{NcBlock, NcItem, NcReader, NcValue};
use post_host::{GivenValue, OpenedDialect, Plugin, ProgramSetup, ProgramWord};
use post_plugin::{Capabilities, DialectSession as _, Meaning, VocabularyWord};
use post_readback::lexicon::Lexicon;

use crate::common::root;

/// A word and all that it means.
type Words = BTreeMap<String, BTreeSet<&'static str>>;

/// The second vocabulary of a control.
struct Second {
    words: Words,
    /// Words that one side alone has, and why.
    apart: BTreeMap<String, String>,
}

/// `tests/vocabularies/NAME.txt`: a word (`G505..G599`: as many), what it means and where that is said, two blanks
/// between them; behind `~` words that one side alone has, a colon, and why.
fn second(dialect: &str) -> Second {
    let path = root().join(format!("tests/vocabularies/{dialect}.txt"));
    let text = fs::read_to_string(&path).unwrap();
    let mut second = Second { words: Words::new(), apart: BTreeMap::new() };
    for line in text.lines().filter(|line| !line.is_empty()) {
        if line.starts_with("# ") || line == "#" {
            continue;
        }
        if let Some(apart) = line.strip_prefix("~ ") {
            let (words, reason) = apart.split_once(": ").unwrap();
            for word in words.split(", ") {
                second.apart.insert(word.to_owned(), reason.to_owned());
            }
            continue;
        }
        let mut columns = line.split("  ").map(str::trim).filter(|column| !column.is_empty());
        let (Some(word), Some(meaning), Some(_)) = (columns.next(), columns.next(), columns.next())
        else {
            panic!("{dialect}: `{line}` is no word with its meaning and source");
        };
        let known = meaning_called(meaning);
        let known = known.unwrap_or_else(|| panic!("{dialect}: nothing means {meaning}"));
        if let Some((first, last)) = word.split_once("..") {
            let number = |word: &str| word[1..].parse::<u16>().unwrap();
            for number in number(first)..=number(last) {
                let word = format!("{}{number}", &word[..1]);
                second.words.entry(word).or_default().insert(known);
            }
            continue;
        }
        let fresh = second.words.entry(word.to_owned()).or_default().insert(known);
        assert!(fresh, "{dialect}: `{word}` means {meaning} twice");
    }
    second
}

/// The meaning of this name, as C has it.
fn meaning_called(name: &str) -> Option<&'static str> {
    let mut all = (0..1000).filter_map(Meaning::from_number).map(Meaning::name);
    all.find(|known| *known == name)
}

/// What the plugin hands over, as it does.
pub fn vocabulary(dialect: &str) -> Vec<VocabularyWord> {
    of_dialect(dialect, |dialect| dialect.vocabulary().unwrap())
}

/// Its words as its programs are read back by them.
pub fn lexicon(dialect: &str) -> Lexicon {
    of_dialect(dialect, |dialect| {
        let words = dialect.vocabulary().unwrap();
        Lexicon::new(dialect.format().language, dialect.capabilities(), &words)
    })
}

/// What the plugin declares.
pub fn capabilities(dialect: &str) -> Capabilities {
    of_dialect(dialect, |dialect| dialect.capabilities())
}

fn of_dialect<T>(dialect: &str, told: impl FnOnce(&mut OpenedDialect) -> T) -> T {
    let plugin = Plugin::linked(post_stock::plugin(dialect).unwrap()).unwrap();
    let word = |name: &str| ProgramWord {
        name: name.to_owned(),
        rotary: matches!(name, "A" | "C"),
        depth: name == "Z",
        carries_part: matches!(name, "A" | "C"),
        ..ProgramWord::default()
    };
    let text = |text: &str| GivenValue::Text(text.to_owned());
    let options: &[(&str, GivenValue)] = match dialect {
        "grbl" => &[("hal", GivenValue::Flag(true))],
        "klipper" | "rrf" | "marlin" => &[("mill", GivenValue::Flag(true))],
        "okuma" => &[
            ("unit_system", text("1 mm")),
            ("tcp_on", text("G169 HL={h}")),
            ("tcp_off", text("G170")),
        ],
        "brother" => &[("unit_system", text("mm")), ("tcp_on", text("G43.4 H{h}"))],
        "mitsubishi" => &[("tapping", text("rigid"))],
        "hurco" => &[("tcp_on", text("M128")), ("tcp_off", text("M129"))],
        _ => &[],
    };
    let setup = ProgramSetup {
        words: ["X", "Y", "Z", "A", "C"].map(word).to_vec(),
        options: options.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect(),
        tcp: !matches!(dialect, "grbl" | "klipper" | "rrf" | "marlin"),
        ..ProgramSetup::default()
    };
    told(&mut plugin.dialect(&setup).unwrap())
}

/// What the plugin hands over.
fn handed_over(dialect: &str) -> Words {
    let mut words = Words::new();
    for told in vocabulary(dialect) {
        let meanings = words.entry(told.word.into_owned()).or_default();
        meanings.insert(told.meaning.name());
    }
    words
}

/// It neither moves an axis nor changes where or when one moves.
fn moves_nothing(meaning: &str) -> bool {
    const STILL: &[Meaning] = &[
        Meaning::Remark,
        Meaning::RemarkOpen,
        Meaning::RemarkClose,
        Meaning::BlockNumber,
        Meaning::Nothing,
        Meaning::Smoothing,
        Meaning::SmoothingOff,
        Meaning::CoolantOn,
        Meaning::CoolantOff,
        Meaning::Clamp,
        Meaning::Unclamp,
        Meaning::SpeedLimit,
    ];
    STILL.iter().any(|still| still.name() == meaning)
}

#[test]
fn the_words_of_each_dialect_mean_what_the_facts_say() {
    let mut wrong = Vec::new();
    let mut named = BTreeSet::new();
    for dialect in crate::dialects::dialects() {
        let Second { words, apart } = second(&dialect);
        let told = handed_over(&dialect);
        for word in words.keys().chain(told.keys()).collect::<BTreeSet<_>>() {
            let [facts, plugin] = [words.get(word), told.get(word)];
            let reason = apart.get(word);
            match (facts, plugin) {
                (Some(facts), Some(plugin)) if facts != plugin => {
                    wrong.push(format!(
                        "{dialect}: `{word}` means {facts:?} by the facts, {plugin:?} by the plugin"
                    ));
                }
                (Some(_), Some(_)) if reason.is_some() => {
                    wrong.push(format!(
                        "{dialect}: `{word}` stands on both sides, and is listed as one side's"
                    ));
                }
                (Some(_), Some(_)) => {}
                (one, other) => {
                    let meanings = one.or(other).unwrap();
                    let still = meanings.iter().all(|meaning| moves_nothing(meaning));
                    if !still && reason.is_none() {
                        let side = if one.is_some() { "facts" } else { "plugin" };
                        wrong.push(format!(
                            "{dialect}: the {side} alone know `{word}`, {meanings:?}"
                        ));
                    }
                }
            }
        }
        for word in apart.keys() {
            if !words.contains_key(word) && !told.contains_key(word) {
                wrong.push(format!(
                    "{dialect}: `{word}` is listed as one side's, and neither has it"
                ));
            }
        }
        named.insert(format!("{dialect}.txt"));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let found: BTreeSet<String> = fs::read_dir(root().join("tests/vocabularies"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(found, named);
}

/// Programs under review: dialect, name and text.
fn programs() -> Vec<(String, String, String)> {
    let mut programs = Vec::new();
    let mut take = |folder: &str, dialect: &dyn Fn(&str) -> String| {
        for entry in fs::read_dir(root().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let Some(name) = path.file_name().unwrap().to_str().unwrap().strip_suffix(".snap")
            else {
                continue;
            };
            let text = fs::read_to_string(&path).unwrap();
            let body = text.splitn(3, "---\n").nth(2).unwrap();
            if body.contains("nothing was written") {
                continue;
            }
            // What was told on the way stands in front of the program.
            let told = |line: &&str| {
                let first = ["post ", "warning", "error", " ", "|"];
                line.is_empty()
                    || first.iter().any(|first| line.starts_with(first))
                    || line.contains(" records, ")
            };
            let lines: Vec<&str> = body.lines().skip_while(told).collect();
            programs.push((dialect(name), name.to_owned(), lines.join("\n") + "\n"));
        }
    };
    take("tests/snapshots/dialects", &|name| name.split_once('_').unwrap().1.to_owned());
    take("tests/snapshots", &|name| {
        let cases = crate::common::CASES.iter();
        let case = cases.into_iter().find(|case| case.name() == name).unwrap();
        let file = root().join(format!("machines/{}.toml", case.machine));
        dialect_of(&fs::read_to_string(file).unwrap())
    });
    programs
}

/// The dialect that a machine file names, or the machine that it extends.
fn dialect_of(machine: &str) -> String {
    let value = |key: &str| {
        let mut lines = machine.lines();
        let line = lines.find_map(|line| line.split('#').next()?.trim().strip_prefix(key));
        line.and_then(|line| line.trim().strip_prefix('='))
            .map(|text| text.trim().trim_matches('"').to_owned())
    };
    value("dialect").unwrap_or_else(|| {
        let base = root().join(format!("machines/{}.toml", value("extends").unwrap()));
        dialect_of(&fs::read_to_string(base).unwrap())
    })
}

/// Addresses of axes, and those that belong to the word beside them: of cycles, waits, calls and planes.
const BESIDE: &[&str] =
    &["A", "B", "C", "E", "L", "P", "Q", "U", "V", "W", "X", "Y", "Z", "R", "I", "J", "K"];

/// Words of conversational blocks that belong to the one that opens them.
const BESIDE_OPENER: &[&str] = &[
    "SPA",
    "SPB",
    "SPC",
    "STAY",
    "SEQ",
    "SEQ+",
    "SEQ-",
    "TABLE ROT",
    "COORD ROT",
    "DIST",
    "MB",
    "PA",
    "IPA",
    "IPR",
    "PR",
    "ROT",
    "SCL",
    "T",
    "TA",
    "HSC-MODE",
    "DL",
    "DR",
    "DR2",
    "H",
];

#[test]
fn every_word_of_every_program_is_in_the_vocabulary_of_its_dialect() {
    let mut lacking = BTreeSet::new();
    let mut read = 0;
    for (dialect, name, text) in programs() {
        let words = vocabulary(&dialect);
        let known: BTreeSet<&str> =
            words.iter().filter_map(|word| word.word.split(' ').next()).collect();
        let whole: BTreeSet<&str> = words.iter().map(|word| &*word.word).collect();
        let syntax = lexicon(&dialect).syntax().clone();
        let mut reader = NcReader::new(Cursor::new(text), syntax);
        let mut block = NcBlock::default();
        while reader.next_block(&mut block).unwrap_or_else(|fault| panic!("{name}: {fault:?}")) {
            read += 1;
            for (place, item) in block.items.iter().enumerate() {
                let number = match block.items.get(place + 1) {
                    Some(NcItem::Number(number)) => format!(" {}", libm::trunc(number.value)),
                    _ => String::new(),
                };
                let word = match item {
                    NcItem::Word(word) => {
                        let letter = char::from(word.letter);
                        match &word.value {
                            NcValue::Number(number) if matches!(letter, 'G' | 'M') => {
                                format!("{letter}{}", number.value)
                            }
                            _ => letter.to_string(),
                        }
                    }
                    NcItem::Named { name, .. } => name.to_string(),
                    NcItem::Call { name, .. } => name.clone(),
                    NcItem::Name(name) => name.to_string(),
                    _ => continue,
                };
                let beside = BESIDE.contains(&word.as_str());
                let opened = whole.contains("BEGIN PGM")
                    && (BESIDE_OPENER.contains(&word.as_str()) || word.starts_with('Q'));
                let told = whole.contains(word.as_str())
                    || known.contains(word.as_str()) && !word.contains(' ')
                    || whole.contains(format!("{word}{number}").as_str());
                if !beside && !opened && !told {
                    lacking.insert(format!(
                        "{dialect}: `{word}{number}` ({name}, line {})",
                        block.line
                    ));
                }
            }
        }
    }
    assert!(read > 2000, "{read} blocks");
    let lacking: Vec<String> = lacking.into_iter().collect();
    assert!(lacking.is_empty(), "{}", lacking.join("\n"));
}
