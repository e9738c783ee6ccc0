//! Random mistakes in programs of ours, and how many of each kind are seen without the CL file.

use std::collections::BTreeMap;
use std::fs;

use post_testkit::{Rng, rounds, seeded};
use serde_json::Value;

use crate::common::{post_in, root, sample};

/// Machines, samples and further words of the programs that are spoilt.
const PROGRAMS: [(&str, &str, &[&str]); 6] = [
    ("vmc", "plate.ncl", &[]),
    ("vmc", "lever.apt", &[]),
    ("ac-trunnion", "blade.cls", &[]),
    ("ac-trunnion", "facets.apt", &[]),
    ("dmu50", "facets.apt", &[]),
    ("nutating-head", "blade.cls", &["--tcp", "control"]),
];

/// Mistakes in all rounds.
const MISTAKES: u32 = 1000;

/// A kind of mistake.
struct Kind {
    name: &'static str,
    /// Of a hundred so many are seen at least, far fewer than were measured; of digits and signs of positions it may be none.
    floor: u32,
    /// The line spoilt, where it can be; numbers are drawn.
    spoil: fn(&str, &mut Rng) -> Option<String>,
}

const KINDS: [Kind; 12] = [
    Kind { name: "a digit of a position", floor: 0, spoil: |line, rng| digit(line, "XYZ", rng) },
    Kind { name: "a sign of a position", floor: 0, spoil: sign },
    Kind { name: "a decimal point left out", floor: 45, spoil: pointless },
    Kind {
        name: "the spindle not turned on",
        floor: 95,
        spoil: |line, _| without(line, &["M3", "M4"]),
    },
    Kind { name: "a rapid in the place of a cut", floor: 70, spoil: hasty },
    Kind {
        name: "the length not called",
        floor: 95,
        spoil: |line, _| without(line, &["G43", "G43.4"]),
    },
    Kind { name: "a feed of 0", floor: 95, spoil: |line, _| feed(line, |_| "0".to_owned()) },
    Kind {
        name: "a feed with two more digits",
        floor: 60,
        spoil: |line, _| feed(line, |feed| (100.0 * feed.parse::<f64>().unwrap()).to_string()),
    },
    Kind {
        name: "a digit of an arc's centre",
        floor: 25,
        spoil: |line, rng| digit(line, "IJ", rng),
    },
    Kind { name: "coolant off in a cut", floor: 60, spoil: dry },
    Kind { name: "the length of another tool", floor: 95, spoil: other_length },
    Kind { name: "the end left out", floor: 50, spoil: |line, _| without(line, &["M30", "M2"]) },
];

/// The words of a block: where each begins and ends.
fn words(line: &str) -> Vec<(usize, usize)> {
    let mut words = Vec::new();
    let mut at = 0;
    for word in line.split(' ') {
        words.push((at, at + word.len()));
        at += word.len() + 1;
    }
    words
}

/// A word with one of these letters and a number behind it.
fn number(line: &str, letters: &str, rng: &mut Rng) -> Option<(usize, usize)> {
    let is_block = !line.starts_with(['(', ';', '%', 'O']);
    let numbered = |&(from, to): &(usize, usize)| {
        let word = &line[from..to];
        let mut rest = word.chars();
        rest.next().is_some_and(|letter| letters.contains(letter))
            && word.len() > 1
            && rest.all(|sign| sign.is_ascii_digit() || "+-.".contains(sign))
    };
    let found: Vec<_> = words(line).into_iter().filter(numbered).collect();
    (is_block && !found.is_empty()).then(|| found[rng.pick(found.len())])
}

fn replaced(line: &str, (from, to): (usize, usize), by: &str) -> String {
    format!("{}{by}{}", &line[..from], &line[to..])
}

fn digit(line: &str, letters: &str, rng: &mut Rng) -> Option<String> {
    let (from, to) = number(line, letters, rng)?;
    let digits: Vec<usize> =
        (from..to).filter(|at| line.as_bytes()[*at].is_ascii_digit()).collect();
    let at = digits[rng.pick(digits.len())];
    let old = line.as_bytes()[at] - b'0';
    let new = (usize::from(old) + 1 + rng.pick(9)) % 10;
    Some(replaced(line, (at, at + 1), &new.to_string()))
}

fn sign(line: &str, rng: &mut Rng) -> Option<String> {
    let (from, to) = number(line, "XYZ", rng)?;
    let value = &line[from + 1..to];
    let by = match value.strip_prefix('-') {
        Some(value) => value.to_owned(),
        None => format!("-{}", value.trim_start_matches('+')),
    };
    Some(replaced(line, (from + 1, to), &by))
}

fn pointless(line: &str, rng: &mut Rng) -> Option<String> {
    let (from, to) = number(line, "XYZ", rng)?;
    let word = &line[from..to];
    let fraction = word.split_once('.')?.1;
    (!fraction.is_empty()).then(|| replaced(line, (from, to), &word.replace('.', "")))
}

fn without(line: &str, left_out: &[&str]) -> Option<String> {
    let kept: Vec<&str> = line.split(' ').filter(|word| !left_out.contains(word)).collect();
    let kept = kept.join(" ");
    (kept != line && !line.starts_with('(')).then_some(kept)
}

/// At rapid: G0 in the place of G1, FMAX in that of the feed.
fn hasty(line: &str, _: &mut Rng) -> Option<String> {
    let cuts = line.split(' ').any(|word| word == "G1");
    if cuts {
        return Some(line.replacen("G1 ", "G0 ", 1));
    }
    let fed = line.contains(" L ") && !line.contains("FMAX");
    fed.then(|| feed(line, |_| "MAX".to_owned())).flatten()
}

fn feed(line: &str, change: impl Fn(&str) -> String) -> Option<String> {
    let fed = |&(from, to): &(usize, usize)| {
        let value = line[from..to].strip_prefix('F');
        value.is_some_and(|value| value.parse::<f64>().is_ok())
    };
    let (from, to) = words(line).into_iter().find(fed)?;
    (!line.starts_with('(')).then(|| replaced(line, (from + 1, to), &change(&line[from + 1..to])))
}

fn dry(line: &str, rng: &mut Rng) -> Option<String> {
    let rapid = ["G53", "G0 ", "G43", "FMAX", "R0"].iter().any(|word| line.contains(word));
    number(line, "XYZ", rng).filter(|_| !rapid).map(|_| format!("{line} M9"))
}

fn other_length(line: &str, _: &mut Rng) -> Option<String> {
    let named = |&(from, to): &(usize, usize)| {
        line[from..to].strip_prefix('H').is_some_and(|register| register.parse::<u32>().is_ok())
    };
    let place = words(line).into_iter().find(named)?;
    Some(replaced(line, place, "H77"))
}

/// A program, and where its spoilt copies and what is found of them stand.
struct Spoilt {
    machine: &'static str,
    lines: Vec<String>,
    ending: &'static str,
}

impl Spoilt {
    fn new(machine: &'static str, file: &str, more: &[&str]) -> Self {
        let path = root().join(sample(file));
        let mut words =
            vec![path.to_str().unwrap(), "-m", machine, "-q", "-o", "-", "--tool-length", "100"];
        words.extend(more);
        let run = post_in(root(), &words);
        assert_eq!(run.code, 0, "{}", run.err);
        let lines = run.out.lines().map(str::to_owned).collect();
        Self { machine, lines, ending: if machine == "dmu50" { "h" } else { "nc" } }
    }

    /// Copies with one mistake of a kind each, as many as there are kinds that can be made here.
    fn copies(&self, count: u32, rng: &mut Rng) -> Vec<(usize, String)> {
        let mut copies = Vec::new();
        for round in 0..count as usize {
            let kind = round % KINDS.len();
            let begin = rng.pick(self.lines.len());
            let places = (0..self.lines.len()).map(|at| (begin + at) % self.lines.len());
            let mut spoilt = places
                .filter_map(|at| (KINDS[kind].spoil)(&self.lines[at], rng).map(|line| (at, line)));
            if let Some((at, line)) = spoilt.next() {
                let mut lines: Vec<&str> = self.lines.iter().map(String::as_str).collect();
                lines[at] = &line;
                copies.push((kind, lines.join("\n") + "\n"));
            }
        }
        copies
    }

    /// What is found of the programs, code and text of each finding.
    fn found(&self, programs: &[&str]) -> Vec<Vec<String>> {
        let folder = tempfile::tempdir().unwrap();
        let names: Vec<String> =
            (0..programs.len()).map(|place| format!("{place}.{}", self.ending)).collect();
        for (name, program) in names.iter().zip(programs) {
            fs::write(folder.path().join(name), program).unwrap();
        }
        let mut words =
            vec!["lint", "-m", self.machine, "--json", "found.json", "--tool-length", "100"];
        words.extend(names.iter().map(String::as_str));
        let run = post_in(folder.path(), &words);
        assert!(run.code < 2, "{}", run.err);
        let text = fs::read_to_string(folder.path().join("found.json"));
        let text = text.unwrap_or_else(|_| panic!("{}", run.err));
        let found: Value = serde_json::from_str(&text).unwrap();
        let told = |one: &Value| {
            let findings = one["findings"].as_array().unwrap().iter();
            findings.map(|one| format!("{} {}", one["code"], one["message"])).collect()
        };
        found.as_array().unwrap().iter().map(told).collect()
    }
}

#[test]
fn of_random_mistakes_as_many_are_seen_as_the_book_says() {
    let mut rng = seeded(71);
    let each = rounds(MISTAKES) / PROGRAMS.len() as u32;
    let mut rates: BTreeMap<usize, [u32; 2]> = BTreeMap::new();
    for (machine, file, more) in PROGRAMS {
        let spoilt = Spoilt::new(machine, file, more);
        let whole = spoilt.lines.join("\n") + "\n";
        let copies = spoilt.copies(each, &mut rng);
        let mut programs = vec![whole.as_str(), whole.as_str()];
        programs.extend(copies.iter().map(|(_, program)| program.as_str()));
        let found = spoilt.found(&programs);
        assert_eq!(found[0], Vec::<String>::new(), "{machine} {file} is right");
        for ((kind, _), found) in copies.iter().zip(&found[2..]) {
            let rate = rates.entry(*kind).or_default();
            rate[0] += u32::from(!found.is_empty());
            rate[1] += 1;
        }
    }
    let all = rates.values().fold([0, 0], |all, rate| [all[0] + rate[0], all[1] + rate[1]]);
    println!("all: {} of {}", all[0], all[1]);
    assert!(all[1] > 250 && 100 * all[0] > 55 * all[1], "{} of {} are seen", all[0], all[1]);
    for (kind, [seen, made]) in rates {
        let Kind { name, floor, .. } = KINDS[kind];
        println!("{name}: {seen} of {made}");
        assert!(100 * seen >= floor * made, "{name}: {seen} of {made} are seen, {floor} % should");
    }
}
