//! What each dialect says the words of its control mean, beside a second vocabulary that was written from the facts
//! alone (`tests/vocabularies`): a program that is read back by the words of the plugin that wrote it cannot show that
//! one of them is wrong.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use post_host::{GivenValue, Plugin, ProgramSetup, ProgramWord};
use post_plugin::{Meaning, VocabularyWord};

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
    let mut second = Second {
        words: Words::new(),
        apart: BTreeMap::new(),
    };
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
        let mut columns = line
            .split("  ")
            .map(str::trim)
            .filter(|column| !column.is_empty());
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
        let fresh = second
            .words
            .entry(word.to_owned())
            .or_default()
            .insert(known);
        assert!(fresh, "{dialect}: `{word}` means {meaning} twice");
    }
    second
}

/// The meaning of this name, as C has it.
fn meaning_called(name: &str) -> Option<&'static str> {
    let mut all = (0..1000)
        .filter_map(Meaning::from_number)
        .map(Meaning::name);
    all.find(|known| *known == name)
}

/// What the plugin hands over, as it does.
pub fn vocabulary(dialect: &str) -> Vec<VocabularyWord> {
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
        "okuma" => &[
            ("unit_system", text("1 mm")),
            ("tcp_on", text("G169 HL={h}")),
            ("tcp_off", text("G170")),
        ],
        _ => &[],
    };
    let setup = ProgramSetup {
        words: ["X", "Y", "Z", "A", "C"].map(word).to_vec(),
        options: options
            .iter()
            .map(|(key, value)| ((*key).to_owned(), value.clone()))
            .collect(),
        tcp: dialect != "grbl",
        ..ProgramSetup::default()
    };
    plugin.dialect(&setup).unwrap().vocabulary().unwrap()
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
