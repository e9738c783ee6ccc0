//! What verification does not refuse: programs of random jobs (machines of the library, dialects, options, CL files) that
//! were written as they should be.
//!
//! What posting refuses is no program and is not counted. A program that is refused by verification is one of the two:
//! posting errs, or verification does; each is looked at once, and the table says of what kind they are.

mod cl;

use std::collections::BTreeMap;
use std::fs;
use std::sync::Arc;

use nalgebra::Vector3;
use post_job::library::{
    LoadedMachine, MachineSelection, MachineSettings, NamedOption, SettingValue, StopSignal,
};
use post_machine::description::Setting;
use post_testkit::Rng;

use crate::common::root;
use crate::dialects::DIALECTS;
use cl::{Cl, Leans};

/// Machines that need nothing but a tool axis, and how they lean the tool.
const MACHINES: &[(&str, char)] = &[
    ("ab-trunnion", '*'),
    ("ac-cantilever", '*'),
    ("ac-trunnion-840d", '*'),
    ("ac-trunnion", '*'),
    ("bc-fork", '*'),
    ("bc-trunnion", '*'),
    ("boring-mill", 'Y'),
    ("dmu50", '*'),
    ("duoblock", '*'),
    ("gantry", '*'),
    ("grbl-router", '-'),
    ("head-head-360", '*'),
    ("head-head", '*'),
    ("head-table-ba", '*'),
    ("head-table-bc", '*'),
    ("head-table-sr", '*'),
    ("hmc-b-pallet", 'Y'),
    ("linuxcnc-5axis", '*'),
    ("m800-trunnion", '*'),
    ("mill-turn", '*'),
    ("nutating-head-45", '*'),
    ("nutating-head-50", '*'),
    ("nutating-head", '*'),
    ("nutating-table", '*'),
    ("osp-mill", '-'),
    ("pocketnc", '*'),
    ("quill-mill", '-'),
    ("router", '-'),
    ("umc-750", '*'),
    ("variaxis", '*'),
    ("vmc-a", 'X'),
    ("vmc-b", 'Y'),
    ("vmc", '-'),
    ("xyzac-trt", '*'),
    ("xyzbc-trt", '*'),
];

/// What is asked for.
struct RightJob {
    machine: &'static str,
    set: Vec<(String, String)>,
    length: f64,
    options: Vec<NamedOption>,
    cl: Cl,
}

/// What became of a job.
enum Outcome {
    /// No program: why.
    Refused(String),
    Good,
    /// The program, and what verification says of it: code and message.
    Wrong(String, Vec<(String, String)>),
}

impl RightJob {
    fn random(seed: u64) -> Self {
        let mut random = Rng::new(seed);
        let (machine, leans) = MACHINES[random.pick(MACHINES.len())];
        let leans = match leans {
            '*' => Leans::AnyWay,
            'X' => Leans::About(Vector3::x()),
            'Y' => Leans::About(Vector3::y()),
            _ => Leans::Never,
        };
        // A tool that can lean need not.
        let leans = match random.pick(5) {
            0 => Leans::Never,
            _ => leans,
        };
        let mut set = Vec::new();
        let mut asks = |random: &mut Rng, of: usize, key: &str, value: &str| {
            if random.pick(of) == 0 {
                set.push((key.to_owned(), value.to_owned()));
            }
        };
        asks(&mut random, 3, "control.rapid", "linear");
        asks(&mut random, 6, "control.cycles", "moves");
        asks(&mut random, 4, "control.planes", "false");
        asks(&mut random, 5, "control.units", "inch");
        asks(&mut random, 6, "accuracy.reduce", "true");
        asks(&mut random, 8, "accuracy.placement", "fewest");
        asks(&mut random, 8, "accuracy.tolerance", "0.05");
        asks(&mut random, 8, "accuracy.axis_tolerance", "0.5");
        asks(&mut random, 8, "control.arcs.fit", "true");
        asks(&mut random, 8, "control.feed", "inverse-time");
        let mut options = Vec::new();
        if random.pick(2) == 0 {
            let dialect = &DIALECTS[random.pick(DIALECTS.len())];
            options.push(("dialect".to_owned(), SettingValue::Text(dialect.clone())));
        }
        match random.pick(3) {
            0 => options.push(("tcp".to_owned(), "control".into())),
            1 => options.push(("tcp".to_owned(), "post".into())),
            _ => {}
        }
        let length = (random.range(40.0, 160.0) * 100.0).round() / 100.0;
        let cl = Cl::random(random.next(), leans);
        Self { machine, set, length, options, cl }
    }

    /// The command line that does the same, for whoever looks at one that went wrong.
    fn command(&self, file: &str) -> String {
        let mut line = format!("post -m {} --tool-length {}", self.machine, self.length);
        for (key, value) in &self.set {
            line.push_str(&format!(" --set {key}={value}"));
        }
        for (key, value) in &self.options {
            line.push_str(&format!(" --{key} {}", value));
        }
        line + " " + file
    }

    fn run(&self, folder: &std::path::Path) -> Outcome {
        let path = folder.join("job.cls");
        fs::write(&path, &self.cl.text).unwrap();
        let set = self.set.iter();
        let told = MachineSelection {
            name: self.machine.to_owned(),
            over: MachineSettings {
                set: set.map(|(key, value)| Setting::Written(format!("{key}={value}"))).collect(),
                tool_length: Some(self.length),
                machines: vec![root().join("machines")],
                ..MachineSettings::default()
            },
        };
        let refused = |findings: Vec<post_machine::diagnostic::Diagnostic>| {
            let errors = findings.iter();
            let error = errors
                .rev()
                .find(|finding| finding.severity == post_machine::diagnostic::Severity::Error);
            error.map_or(String::new(), |error| format!("{}: {}", error.code, error.message))
        };
        let stop: StopSignal = Arc::new(|| false);
        let machine = match LoadedMachine::load(&stop, told) {
            Ok(machine) => machine,
            Err(findings) => return Outcome::Refused(refused(findings)),
        };
        let made = match machine.post(&stop, &path, None, &self.options, false) {
            Ok(made) => made,
            Err(findings) => return Outcome::Refused(refused(findings)),
        };
        match made.verify(&stop) {
            Ok(_) => Outcome::Good,
            Err(findings) => {
                let errors = findings.iter().filter(|finding| {
                    finding.severity == post_machine::diagnostic::Severity::Error
                });
                let told = errors.map(|error| (error.code.to_string(), error.message.clone()));
                let text = String::from_utf8_lossy(made.text()).into_owned();
                Outcome::Wrong(text, told.collect())
            }
        }
    }
}

/// A message without its numbers and names: what kind of message it is.
fn kind(message: &str) -> String {
    let mut kind = String::new();
    for word in message.split_whitespace() {
        let bare: String = word
            .chars()
            .filter(|letter| !letter.is_ascii_digit() && !"-+.,°()".contains(*letter))
            .collect();
        let numeric = word.chars().any(|letter| letter.is_ascii_digit());
        kind.push_str(if numeric { "#" } else { &bare });
        kind.push(' ');
    }
    kind.truncate(70);
    kind
}

/// Jobs of `seeds` until so many programs were made.
fn study(first: u64, programs: usize, most: usize) -> (usize, Vec<String>, String) {
    let folder = tempfile::tempdir().unwrap();
    let keep = std::env::var("POST_KEEP").ok();
    let (mut made, mut tried) = (0, 0);
    let mut wrong = Vec::new();
    let mut by: BTreeMap<String, (usize, u64)> = BTreeMap::new();
    let mut why: BTreeMap<String, usize> = BTreeMap::new();
    let mut features: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    while made < programs && tried < most {
        let seed = first + tried as u64;
        tried += 1;
        let job = RightJob::random(seed);
        let outcome = job.run(folder.path());
        let mut row = |bad: bool| {
            let mut names: Vec<String> = job.cl.has.iter().map(|has| (*has).to_owned()).collect();
            names.extend(job.set.iter().map(|(key, value)| format!("{key}={value}")));
            names.extend(job.options.iter().map(|(_, value)| value.to_string()));
            for name in names {
                let row = features.entry(name).or_default();
                row[usize::from(bad)] += 1;
            }
        };
        match outcome {
            Outcome::Refused(message) => {
                *why.entry(kind(&message)).or_default() += 1;
            }
            Outcome::Good => {
                made += 1;
                row(false);
            }
            Outcome::Wrong(text, told) => {
                made += 1;
                row(true);
                let first = told
                    .first()
                    .map_or(String::new(), |(code, message)| format!("{code}: {message}"));
                by.entry(kind(&first)).or_insert((0, seed)).0 += 1;
                wrong.push(format!("{seed}: {} [{first}]", job.command(&format!("{seed}.cls"))));
                if let Some(keep) = &keep {
                    let keep = std::path::Path::new(keep);
                    fs::create_dir_all(keep).unwrap();
                    fs::write(keep.join(format!("{seed}.cls")), &job.cl.text).unwrap();
                    fs::write(keep.join(format!("{seed}.nc")), &text).unwrap();
                    let told: Vec<String> =
                        told.iter().map(|(code, message)| format!("{code}: {message}")).collect();
                    fs::write(
                        keep.join(format!("{seed}.txt")),
                        format!("{}\n{}\n", job.command(&format!("{seed}.cls")), told.join("\n")),
                    )
                    .unwrap();
                }
            }
        }
    }
    let mut table =
        format!("{tried} jobs, {made} programs, {} of them refused by verification\n", wrong.len());
    let mut kinds: Vec<_> = by.into_iter().collect();
    kinds.sort_by_key(|(_, (count, _))| std::cmp::Reverse(*count));
    for (kind, (count, seed)) in kinds {
        table.push_str(&format!("{count:>6}  {kind} (first: {seed})\n"));
    }
    table.push_str("\nprograms with   right refused\n");
    for (name, [good, bad]) in features {
        table.push_str(&format!("{name:<28} {:>6} {bad:>6}\n", good + bad));
    }
    table.push_str("\nno program because\n");
    let mut why: Vec<_> = why.into_iter().collect();
    why.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    for (kind, count) in why.into_iter().take(40) {
        table.push_str(&format!("{count:>6}  {kind}\n"));
    }
    (made, wrong, table)
}

#[test]
fn right_programs_are_not_refused() {
    let (made, wrong, table) = study(1, 60, 400);
    assert!(made >= 40 && wrong.is_empty(), "{table}\n{}", wrong.join("\n"));
}

/// The study: `cargo test --test it right_jobs -- --ignored --nocapture`; POST_JOBS is how many programs it is made of,
/// POST_FIRST the seed of the first, and POST_KEEP a folder for those that are refused.
#[test]
#[ignore = "thousands of programs: minutes"]
fn thousands_of_right_programs() {
    let number = |name: &str, otherwise: u64| {
        std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
    };
    let programs = number("POST_JOBS", 5000) as usize;
    let (made, wrong, table) = study(number("POST_FIRST", 1000), programs, 4 * programs);
    println!("{table}");
    for wrong in &wrong {
        println!("{wrong}");
    }
    assert!(wrong.len() * 1000 <= made, "{} of {made} right programs are refused", wrong.len());
}
