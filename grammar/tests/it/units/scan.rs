use std::collections::BTreeMap;
use std::fmt::Write;

use post_grammar::internals::{plain_goto, record};
use post_grammar::{ClReader, MajorWord, Statement, parse_record};
use post_testkit::{Rng, randomised};

#[test]
fn unsure_lines_are_left_to_pest() {
    for line in [
        "GOTO/1,2",
        "GOTO/1,2,3,4",
        "GOTO/1,2,3,4,5,6,7",
        "GOTO/1 2 3",
        "GOTO/1,2,1e400",
        "GOTO/1,2,3x",
        "GOTO/1,2,3,4,5,6x",
        "GOTO 1,2,3",
        "GOTO/1,2,3$",
        "GOTO/1,2,3 $ $$ x",
        "GOTO/1,2,\u{A0}3",
        "GOTO/1,2,3\n",
        "PPRINT \x07",
        "RAPID,1",
        "FEDRAT/MMPM",
        "NOSUCH/\u{E4}",
        "TOOL PATH/x",
        "TOOL/1",
        "$$-> FEATNO / 1",
        "REMARK -> FEATNO / 1",
        "1,2,3",
        "",
    ] {
        assert_eq!(record(line.as_bytes()), None, "{line}");
    }
    let plain =
        |text: &[u8]| plain_goto(text).map(|plain| (plain.values, plain.has_axis, plain.end));
    assert_eq!(plain(b" GOTO  /  1. ,-.5,+3 "), Some(([1.0, -0.5, 3.0, 0.0, 0.0, 0.0], false, 21)));
    assert_eq!(
        plain(b"GOTO/1,2,3,4,5,6\r\nGOTO/1"),
        Some(([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], true, 16))
    );
    for line in ["goto/1,2,3", "GOTO/1,2,3 $$ x", "GOTO/1,2\n,3", "GOTOX/1,2,3", "GODLTA/1,2,3"] {
        assert_eq!(plain_goto(line.as_bytes()), None, "{line}");
    }
}

/// Bit for bit: `-0.0` is not `0.0`.
fn told(statement: &Statement) -> String {
    let mut told = String::new();
    write!(told, "{statement:?}").expect("a string");
    told
}

#[test]
fn the_scanner_takes_nearly_every_record_of_the_real_files() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/cl");
    let Ok(files) = std::fs::read_dir(folder) else {
        assert!(std::env::var_os("CI").is_none(), "{folder} is missing");
        eprintln!("skipped: {folder} is missing");
        return;
    };
    let mut left = BTreeMap::new();
    let (mut points, mut others) = (0, 0);
    for file in files {
        let mut reader = ClReader::new(std::fs::File::open(file.unwrap().path()).unwrap());
        while let Some(read) = reader.next_record().unwrap() {
            let word = read.statement.word().to_owned();
            match record(read.raw) {
                Some(scanned) => {
                    let expected = parse_record(&read.text()).unwrap();
                    assert_eq!(told(&scanned), told(&expected), "{}", read.text());
                    *(if word == "GOTO" { &mut points } else { &mut others }) += 1;
                }
                None => *left.entry(word).or_insert(0) += 1,
            }
        }
    }
    assert!(points >= 67_916 && others >= 8_000, "{points}, {others}");
    // Directives and operations' names.
    assert!(!left.contains_key("GOTO") && left.values().sum::<i32>() < 40, "{left:?}");
}

const NUMBER: &str = "[+-]?([0-9]{1,4}|[0-9]{1,4}\\.[0-9]{0,10}|\\.[0-9]{1,18}|[0-9]{10,24}\\.?|[0-9]\\.[0-9]{1,6}[eE][+-]?[0-9]{1,3})";
const BLANKS: &str = "[ \t]{0,2}";

/// Words of the table in any letters, words with something behind them, and words that nobody knows.
fn word(rng: &mut Rng) -> String {
    let words = MajorWord::all();
    let word = rng.choose(words);
    let known = *rng.choose(word.spellings);
    match rng.pick(11) {
        0..6 => known.to_owned(),
        6 => known.to_lowercase(),
        7 => known.to_owned() + &rng.text("[A-Z._-]"),
        8 => rng.text("[A-Za-z$][A-Z0-9_.-]{0,9}"),
        9 => "$$".to_owned(),
        _ => "REMARK ->FEATNO".to_owned(),
    }
}

/// Words behind the slash.
const NAMES: [&str; 44] = [
    "MMPM", "IPM", "MMPR", "INVERS", "RAPID", "rpm", "RPM", "SFM", "CLW", "CCLW", "ON", "OFF",
    "on", "FLOOD", "MIST", "TOOL", "ADJUST", "LENGTH", "LEFT", "RIGHT", "XYPLAN", "ZXPLAN",
    "AAXIS", "TABLE", "INCR", "ATANGL", "TIMES", "DRILL", "DEEP", "TAP", "FEDTO", "RAPTO",
    "RTRCTO", "STEP", "DWELL", "REV", "MM", "INCH", "MILL", "COLOR", "a/b", "1x", "-", "1e",
];

fn item(rng: &mut Rng) -> String {
    match rng.pick(17) {
        0..8 => rng.text(NUMBER),
        8..14 => (*rng.choose(&NAMES)).to_owned(),
        14 => rng.text("[ -~]{0,3}"),
        15 => rng.text("[\u{1}-\u{FF}]"),
        _ => String::new(),
    }
}

/// Whatever the scanner takes, pest reads the same; what it leaves is for pest alone to say.
#[test]
fn scanner_and_pest_agree() {
    let (rounds, mut rng) = randomised(2048, 3);
    for _ in rounds {
        let mut line = rng.text(BLANKS) + &word(&mut rng) + &rng.text(BLANKS);
        line += &rng.text("(/|/|/|/|)");
        let count = rng.pick(12);
        for index in 0..count {
            line += &rng.text(BLANKS);
            line += &item(&mut rng);
            line += &rng.text(BLANKS);
            if index + 1 < count {
                line += &rng.text("(,|,|,|,|,| )");
            }
        }
        line += &rng.text("(|||,| ,| \\$\\$ x|\\$\\$|\\$|x)");
        if let Some(scanned) = record(line.as_bytes()) {
            let expected = parse_record(&line).map(|statement| told(&statement));
            assert_eq!(Ok(told(&scanned)), expected, "{line}");
        }
    }
}

#[test]
fn points_are_taken_whatever_blanks_and_numbers() {
    let (rounds, mut rng) = randomised(2048, 4);
    for _ in rounds {
        let numbers =
            rng.some([1, 8], |rng| rng.text(BLANKS) + &rng.text(NUMBER) + &rng.text(BLANKS));
        let [before, between] = [(); 2].map(|()| rng.text(BLANKS));
        let tail = rng.text("(|,| ,| \\$\\$ x|x|,A)");
        let line = format!("{before}GOTO{between}/{}{tail}", numbers.join(","));
        let expected = parse_record(&line);
        match record(line.as_bytes()) {
            Some(scanned) => {
                let expected = expected.map(|found| told(&found));
                assert_eq!(Ok(told(&scanned)), expected, "{line}");
            }
            None => assert!(!matches!(expected, Ok(Statement::Goto { .. })), "{line}"),
        }
    }
}
