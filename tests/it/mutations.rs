//! What verification sees: thousands of programs with one thing changed at random, and whether that was caught.
//!
//! Whether the machine does something else is judged apart from the verification: both programs are run, what they have in
//! common before and behind the change is left out, and the rest is sampled densely and compared point by point.

use crate::common::{post, root, sample};
use crate::dialects::DIALECTS;
use crate::vocabularies;

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;

use nalgebra::Vector3;
use post_machine::description::{Machine, Rapid, Setting, Source, Tcp, load};
use post_machine::kinematics::Chain;
use post_plugin::Capabilities;
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::course::{Course as _, CourseItem, Curve};
use post_readback::interpret::{Interpreter, Limits, ModalGroup};
use post_readback::lexicon::Lexicon;
use post_readback::verify::{CutBounds, CutPath, Verifier, VerifyRules};
use post_readback::{BlockEffect, Motion, MotionKind, Offsets, ProgramEvent};
use post_testkit::{Rng, drawn, seeded};

/// A program, and all that is needed to run it and to hold it against its CL file.
struct Job {
    name: String,
    machine: Machine,
    lexicon: Lexicon,
    cl: Vec<u8>,
    cl_name: String,
    lines: Vec<String>,
    length: f64,
    done: Vec<BlockEffect>,
    /// The machine with the tool as long as it is.
    chain: Chain,
    /// Places where the program cuts, about a millimetre apart.
    cuts: Vec<Vector3<f64>>,
}

fn machine(name: &str, settings: &[Setting]) -> Machine {
    let find = |name: &str| {
        let path = root().join("machines").join(format!("{name}.toml"));
        fs::read_to_string(&path).map(|text| Source { name: name.to_owned(), text })
    };
    let source = find(name).unwrap();
    load(source, settings, &mut |name| find(name).map_err(|error| error.to_string())).unwrap()
}

impl Job {
    fn new(dialect: &str, name: &str, file: &str, tcp: &str) -> Option<Self> {
        let length = 100.0;
        let path = sample(file);
        let mut arguments =
            vec!["-q", "-m", name, "--dialect", dialect, "--tool-length", "100", "-o", "-"];
        let mut settings = vec![Setting::Dialect(dialect.to_owned())];
        if !tcp.is_empty() {
            arguments.extend(["--tcp", tcp]);
            settings.push(Setting::Tcp(match tcp {
                "control" => Tcp::Control,
                _ => Tcp::Post,
            }));
        }
        arguments.push(path.to_str().unwrap());
        let run = post(&arguments);
        if run.code != 0 {
            return None;
        }
        let mut machine = machine(name, &settings);
        // As its dialect declares it.
        let passes = vocabularies::capabilities(dialect).has(Capabilities::TCP_RAPIDS_PASS);
        machine.control.rapid = Some(machine.rapid(passes));
        let mut job = Self {
            name: format!("{dialect} {name} {file} {tcp}"),
            lexicon: vocabularies::lexicon(dialect),
            cl: fs::read(root().join(&path)).unwrap(),
            cl_name: file.to_owned(),
            lines: run.out.lines().map(str::to_owned).collect(),
            length,
            chain: machine.solver(length).unwrap().chain().clone(),
            machine,
            done: Vec::new(),
            cuts: Vec::new(),
        };
        let (done, faults) = job.run(&job.lines, length);
        assert_eq!(faults, Vec::new(), "{}", job.name);
        job.done = done;
        for (tip, _) in dense(&motions_of(&job.done), None) {
            let last = job.cuts.last();
            if last.is_none_or(|last| (tip - last).norm() > 1.0) {
                job.cuts.push(tip);
            }
        }
        Some(job)
    }

    fn course(&self) -> ClCourse<Cursor<Vec<u8>>> {
        let settings = ClSettings::of(&self.machine, &self.cl_name);
        ClCourse::new(settings, Cursor::new(self.cl.clone()))
    }

    /// All that is cut lies within the tolerance of what the CL file asks for, and that of it: another program may be
    /// right too.
    fn keeps_the_path(&self, done: &[BlockEffect]) -> bool {
        let mut course = self.course();
        let mut asked: Vec<At> = Vec::new();
        while let Ok(Some(item)) = course.next() {
            if let CourseItem::Piece(piece) = item
                && piece.kind != MotionKind::Rapid
            {
                // A chord of a tenth of a millimetre strays from no arc of these by a hundredth of the tolerance.
                let step = if piece.curve == Curve::Straight { 0.5 } else { 0.1 };
                let count = (2.0 + piece.length() / step).min(20_000.0) as u32;
                asked.extend((0..=count).map(|step| {
                    let pose = piece.at(f64::from(step) / f64::from(count), 0.0);
                    (pose.tip, pose.axis)
                }));
            }
        }
        let accuracy = &self.machine.accuracy;
        let tolerances = [accuracy.tolerance, accuracy.axis_tolerance];
        apart(&dense(&motions_of(done), None), &asked, tolerances) <= 1.02
    }

    /// Where the machine makes rapids at feed, one as fast as its axes go from end to end is a rapid.
    fn is_rapid(&self, motion: &Motion) -> bool {
        let machine = &self.machine;
        let axes = machine.axes.iter().enumerate();
        let least = axes
            .map(|(place, axis)| {
                (motion.to.joints[place] - motion.from.joints[place]).abs() / axis.max_feed
            })
            .fold(0.0, f64::max);
        machine.control.rapid == Some(Rapid::Linear) && motion.minutes <= 1.1 * least + 1e-4
    }

    /// How far a place is from what is cut, mm.
    fn clearance(&self, tip: Vector3<f64>) -> f64 {
        let far = self.cuts.iter().map(|cut| (cut - tip).norm());
        far.fold(f64::INFINITY, f64::min)
    }

    /// What the program of these lines does, and what is wrong with it, with its line.
    fn run(&self, lines: &[String], length: f64) -> (Vec<BlockEffect>, Vec<(Option<u64>, String)>) {
        let text = lines.join("\n") + "\n";
        let offsets = Offsets { length: Some(length), ..Offsets::default() };
        let along = self.machine.control_point.along;
        let (near, _) = CutPath::of(&mut self.course(), along);
        let rules = VerifyRules {
            length_from: self.lexicon.lengths(),
            lengths: Some(Offsets { length: Some(self.length), ..Offsets::default() }),
            own: true,
            ..VerifyRules::of(&self.machine)
        };
        let mut verifier = Verifier::new(&self.machine, rules.clone(), self.course()).near(near);
        // What is found hangs neither on whether each line is told with its deviations, nor on when it is looked up where the
        // course cuts.
        let without = VerifyRules { rows: false, ..rules };
        let (bounds, _) = CutBounds::of(&mut self.course(), along);
        let near = CutPath::when_asked(bounds, Box::new(self.course()), along);
        let mut quick = Verifier::new(&self.machine, without, self.course()).near(near);
        let program = Interpreter::new(
            &self.machine,
            &self.lexicon,
            &offsets,
            Limits { blocks: 100_000, ..Limits::default() },
            "mutant.nc",
            Cursor::new(text.into_bytes()),
        );
        let mut program = program.unwrap();
        let (mut all, mut faults) = (Vec::new(), Vec::new());
        let mut done = Vec::new();
        loop {
            done.clear();
            match program.next(&mut done) {
                Ok(true) => {}
                Ok(false) => break,
                Err(fault) => {
                    let line = fault.place.as_ref().map(|place| place.line);
                    faults.push((line, fault.message));
                    if faults.len() > 20 {
                        break;
                    }
                }
            }
            for done in &done {
                verifier.take(done, &mut |_| {});
                quick.take(done, &mut |_| {});
            }
            for done in &mut done {
                if let BlockEffect::Motion(motion) = done
                    && self.is_rapid(motion)
                {
                    motion.kind = MotionKind::Rapid;
                }
            }
            all.append(&mut done);
        }
        let report = program.report();
        // Not every dialect ends a plane ahead of its programs.
        let ends_planes = ["G69", "PLANE RESET STAY"]
            .iter()
            .any(|end| self.lines.iter().take(12).any(|line| line.ends_with(end)));
        let relied = report.relied.iter();
        let relied = relied.filter(|(_, group)| *group != ModalGroup::TiltedPlane || ends_planes);
        faults
            .extend(relied.map(|(line, group)| (Some(*line), format!("{} not set", group.name()))));
        let unsaid = [&report.unsaid, &report.unturned, &report.blind];
        faults.extend(
            unsaid
                .into_iter()
                .flatten()
                .map(|(line, axes)| (Some(*line), format!("{axes} unsaid"))),
        );
        let cut_off = report.cycle_cut_off;
        faults.extend(cut_off.map(|line| (Some(line), "the cycle is cut off".to_owned())));
        match &report.end {
            Some(end) if end.modes.is_empty() => {}
            end => faults.push((None, format!("ends with {end:?}"))),
        }
        let unretracted = report.unretracted.iter();
        faults
            .extend(unretracted.map(|(line, axes)| (Some(*line), format!("{axes} not retracted"))));
        let found = verifier.finish(&mut |_| {});
        assert_eq!(found, quick.finish(&mut |_| {}));
        faults.extend(found.faults.into_iter().map(|fault| {
            let text = format!("{}: {} (CL line {:?})", fault.code, fault.message, fault.cl_line);
            (fault.nc_line, text)
        }));
        (all, faults)
    }
}

/// What is changed.
const KINDS: &[&str] = &[
    "digit",
    "sign",
    "left out",
    "swapped",
    "doubled",
    "register",
    "length",
    "tcp late",
    "arc",
    "feed",
    "speed",
    "tool",
    "coolant",
    "spindle",
    "rapid",
    "dwell",
    "second feed",
    "malformed",
    "rapid at feed",
    "retract",
    "no retract",
    "wait",
    "peck",
    "plane",
    "plane word",
    "mode",
    "offset",
    "word out",
    "stop out",
    "mode out",
    "end out",
];

/// What no control reads as it was meant, or reads by what ran before: whatever a reader makes of it, it is to be told.
const MALFORMED: &[&str] = &["second feed", "malformed", "mode out", "end out"];

/// Words of lines that lead off the part in positions of the machine.
const RETRACTS: &[&str] = &["G53", "G28", "G30", "SUPA", "M91", "M140", "VPSLZ", "G16 H0"];

/// Words of cycles that peck.
const PECKS: &[&str] = &["G83", "G73", "Q202", "CYCLE83"];

/// Words of tilted planes.
const PLANES: &[&str] = &["G68", "PLANE", "CYCLE800"];

/// Lines that stop the program or have it wait.
const STOPS: &[&str] = &["M0", "M1", "M00", "M01", "STOP"];

/// Words of modes that stand once, in the head.
const HEAD_MODES: &[&str] = &["G21", "G20", "G71", "G710", "G90"];

/// Words that end a mode or the program. M30 of Heidenhain stands ahead of END PGM, which ends it too.
const ENDS: &[&str] = &["G40", "G80", "G69", "G255", "M30", "M2", "PLANE RESET STAY"];

/// Words of dwells.
const WAITS: &[&str] = &["G4 ", "G04 ", "CYCL DEF 9", "Q211", "G82", "G89"];

/// Places of numbers behind one of `letters`, outside remarks: line, first byte, byte behind the last.
fn numbers(lines: &[String], letters: &str) -> Vec<(usize, usize, usize)> {
    let mut places = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let bytes = line.as_bytes();
        let (mut at, mut remark) = (0, false);
        while at < bytes.len() {
            match bytes[at] {
                b'(' => remark = true,
                b')' => remark = false,
                b';' => break,
                letter if !remark && letters.as_bytes().contains(&letter) => {
                    let alone = at == 0 || !bytes[at - 1].is_ascii_alphabetic();
                    let mut end = at + 1;
                    if end < bytes.len() && matches!(bytes[end], b'+' | b'-') {
                        end += 1;
                    }
                    let digits = end;
                    while end < bytes.len() && (bytes[end].is_ascii_digit() || bytes[end] == b'.') {
                        end += 1;
                    }
                    if alone && end > digits {
                        places.push((index, at + 1, end));
                    }
                }
                _ => {}
            }
            at += 1;
        }
    }
    places
}

/// Another digit in one of the numbers behind these letters.
fn change_digit(random: &mut Rng, lines: &mut [String], letters: &str) -> Option<()> {
    change_digit_in(random, lines, letters, &[])
}

/// Another digit in one of the numbers behind these letters, in a line that has one of `words`; in any, if there are none.
fn change_digit_in(
    random: &mut Rng,
    lines: &mut [String],
    letters: &str,
    words: &[&str],
) -> Option<()> {
    let mut places = numbers(lines, letters);
    places.retain(|(line, ..)| {
        words.is_empty() || words.iter().any(|word| lines[*line].contains(word))
    });
    if places.is_empty() {
        return None;
    }
    let (line, from, to) = places[random.pick(places.len())];
    let digits: Vec<usize> =
        (from..to).filter(|at| lines[line].as_bytes()[*at].is_ascii_digit()).collect();
    let at = digits[random.pick(digits.len())];
    let old = lines[line].as_bytes()[at] - b'0';
    let new = (old + 1 + random.pick(9) as u8) % 10;
    lines[line].replace_range(at..=at, &new.to_string());
    Some(())
}

/// One of the lines in which a word stands, the word replaced.
fn replace_word(random: &mut Rng, lines: &mut [String], pairs: &[(&str, &str)]) -> Option<()> {
    let mut places = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        for (old, new) in pairs {
            for (at, _) in line.match_indices(old) {
                let end = at + old.len();
                let bytes = line.as_bytes();
                let ends = end == bytes.len() || !matches!(bytes[end], b'0'..=b'9' | b'.');
                let begins = at == 0 || !bytes[at - 1].is_ascii_alphanumeric();
                if ends && begins && !line.starts_with('(') && !line.contains(';') {
                    places.push((index, at, end, *new));
                }
            }
        }
    }
    if places.is_empty() {
        return None;
    }
    let (line, from, to, new) = places[random.pick(places.len())];
    lines[line].replace_range(from..to, new);
    Some(())
}

/// Changes one thing; none if the program has none such.
fn mutate(kind: &str, random: &mut Rng, lines: &mut Vec<String>, length: &mut f64) -> Option<()> {
    match kind {
        "digit" => change_digit(random, lines, "XYZABCIJKR"),
        "sign" => {
            let places = numbers(lines, "XYZABCIJK");
            let (line, from, _) = *places.get(random.pick(places.len().max(1)))?;
            match lines[line].as_bytes()[from] {
                b'-' => lines[line].replace_range(from..=from, "+"),
                b'+' => lines[line].replace_range(from..=from, "-"),
                _ => lines[line].insert(from, '-'),
            }
            Some(())
        }
        "left out" => {
            let at = random.pick(lines.len());
            lines.remove(at);
            Some(())
        }
        "swapped" => {
            let at = random.pick(lines.len() - 1);
            lines.swap(at, at + 1);
            Some(())
        }
        "doubled" => {
            let at = random.pick(lines.len());
            let line = lines[at].clone();
            let to = random.pick(lines.len());
            lines.insert(to, line);
            Some(())
        }
        "register" => change_digit(random, lines, "HD"),
        "length" => {
            *length += random.range(-2.0, 2.0);
            Some(())
        }
        "tcp late" => {
            const WORDS: &[&str] = &["G43.4", "G43.5", "TRAORI", "M128", "G234", "G169", "M200"];
            let has = |line: &String| WORDS.iter().any(|word| line.contains(word));
            let at = lines.iter().position(has)?;
            let next = (at + 1).min(lines.len() - 1);
            lines.swap(at, next);
            Some(())
        }
        "arc" => replace_word(
            random,
            lines,
            &[("G2", "G3"), ("G3", "G2"), ("DR+", "DR-"), ("DR-", "DR+")],
        ),
        "feed" => change_digit(random, lines, "F"),
        "speed" => change_digit(random, lines, "S"),
        "tool" => change_digit(random, lines, "T"),
        "coolant" => replace_word(random, lines, &[("M8", "M9"), ("M7", "M9"), ("M9", "M8")]),
        "spindle" => replace_word(random, lines, &[("M3", "M4"), ("M5", "M3"), ("M3", "M5")]),
        "rapid" => replace_word(random, lines, &[("G0", "G1"), ("G1", "G0"), (" FMAX", " F500")]),
        "second feed" => {
            let places = numbers(lines, "F");
            let (line, from, to) = *places.get(random.pick(places.len().max(1)))?;
            let feed = format!(" F{}", 50 + random.pick(3000));
            let at = if random.pick(2) == 0 { to } else { from - 1 };
            if lines[line][at..].starts_with('F') {
                lines[line].insert_str(at, &format!("{} ", feed.trim()));
            } else {
                lines[line].insert_str(at, &feed);
            }
            Some(())
        }
        "malformed" => {
            let places = numbers(lines, "XYZABC");
            let (line, from, to) = *places.get(random.pick(places.len().max(1)))?;
            let text = lines[line][from..to].to_owned();
            let point = text.find('.');
            let new = match (random.pick(4), point) {
                (0, Some(point)) => format!("{}.{}", &text[..point], &text[point..]),
                (1, _) => format!("+-{}", text.trim_start_matches(['+', '-'])),
                (2, Some(_)) => format!("{text}.5"),
                _ => format!("{}O{}", &text[..text.len() - 1], &text[text.len() - 1..]),
            };
            lines[line].replace_range(from..to, &new);
            Some(())
        }
        "rapid at feed" => {
            let rapids: Vec<usize> = (0..lines.len())
                .filter(|line| {
                    let text = &lines[*line];
                    (text.contains("G0 ") || text.contains("G00 ") || text.contains(" FMAX"))
                        && !text.starts_with('(')
                })
                .collect();
            let line = *rapids.get(random.pick(rapids.len().max(1)))?;
            let feed = 20 + random.pick(3000);
            if lines[line].contains(" FMAX") {
                lines[line] = lines[line].replacen(" FMAX", &format!(" F{feed}"), 1);
                return Some(());
            }
            lines[line] = lines[line].replacen("G00 ", "G01 ", 1).replacen("G0 ", "G1 ", 1);
            lines[line].push_str(&format!(" F{feed}."));
            // Those behind it stay as they are.
            if let Some(next) = lines.get_mut(line + 1)
                && next
                    .trim_start_matches(|letter: char| letter != ' ')
                    .trim_start()
                    .starts_with(['X', 'Y', 'Z'])
            {
                let at = next.find(' ').map_or(0, |at| at + 1);
                next.insert_str(at, "G0 ");
            }
            Some(())
        }
        "retract" => change_digit_in(random, lines, "XYZABC", RETRACTS),
        "no retract" => {
            let places: Vec<usize> = (0..lines.len())
                .filter(|line| RETRACTS.iter().any(|word| lines[*line].contains(word)))
                .collect();
            let line = *places.get(random.pick(places.len().max(1)))?;
            lines.remove(line);
            Some(())
        }
        "stop out" => {
            let stops = |line: &String| {
                let mut words = line.split(' ');
                words.next_back().is_some_and(|word| STOPS.contains(&word)) || line.contains("G4 ")
            };
            let places: Vec<usize> = (0..lines.len()).filter(|at| stops(&lines[*at])).collect();
            lines.remove(*places.get(random.pick(places.len().max(1)))?);
            Some(())
        }
        "mode out" => {
            let is = |word: &&str| word.split(' ').any(|word| HEAD_MODES.contains(&word));
            let heads: Vec<usize> = (0..lines.len()).filter(|at| is(&&*lines[*at])).collect();
            let at = *heads.get(random.pick(heads.len().max(1)))?;
            let words = lines[at].split(' ').filter(|word| !HEAD_MODES.contains(word));
            lines[at] = words.collect::<Vec<_>>().join(" ");
            Some(())
        }
        "end out" => {
            let conversational = lines.last().is_some_and(|line| line.contains("END PGM"));
            let mut places = Vec::new();
            for (at, line) in lines.iter().enumerate() {
                for word in ENDS.iter().filter(|word| !(conversational && **word == "M30")) {
                    let alone = |from: &usize| {
                        let bytes = line.as_bytes();
                        (*from == 0 || bytes[from - 1] == b' ')
                            && bytes.get(from + word.len()).is_none_or(|next| *next == b' ')
                    };
                    let found = line.match_indices(word).map(|(from, _)| from).filter(alone);
                    places.extend(found.map(|from| (at, from..from + word.len())));
                }
            }
            // A plane that another one takes the place of need not be ended before, but at the head.
            let replaced = |at: usize| {
                let mut planes = lines[at + 1..].iter().filter(|line| line.contains("PLANE "));
                let opened = lines[..at].iter().any(|line| line.contains("PLANE SPATIAL"));
                opened && planes.next().is_some_and(|line| line.contains("PLANE SPATIAL"))
            };
            places
                .retain(|(at, word)| !lines[*at][word.clone()].contains("PLANE") || !replaced(*at));
            let (at, word) = places.get(random.pick(places.len().max(1)))?.clone();
            lines[at].replace_range(word, "");
            Some(())
        }
        "wait" => change_digit_in(random, lines, "PXFUQ", WAITS),
        "peck" => change_digit_in(random, lines, "Q", PECKS),
        "plane" => change_digit_in(random, lines, "XYZABCIJKQR", PLANES),
        "plane word" => replace_word(
            random,
            lines,
            &[("G17", "G18"), ("G18", "G19"), ("G19", "G17"), ("G18", "G17")],
        ),
        "mode" => replace_word(
            random,
            lines,
            &[
                ("G90", "G91"),
                ("G91", "G90"),
                ("G94", "G93"),
                ("G94", "G95"),
                ("G93", "G94"),
                ("G21", "G20"),
                ("G20", "G21"),
                ("G98", "G99"),
                ("G99", "G98"),
            ],
        ),
        "offset" => replace_word(random, lines, &[("G54", "G55"), ("G54", "G57")]),
        "word out" => {
            let places = numbers(lines, "GMXYZABCIJKRFSHDQP");
            let (line, from, to) = *places.get(random.pick(places.len().max(1)))?;
            lines[line].replace_range(from - 1..to, "");
            Some(())
        }
        _ => change_digit(random, lines, "P"),
    }
}

/// What a changed program does otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Difference {
    /// Nothing beyond the tolerances.
    None,
    /// Rapids alone, and these come nowhere nearer to what is cut, nowhere lower along the tool, and have it as far drawn
    /// back where tools change and at the end.
    Clear,
    /// Rapids alone.
    Rapids,
    /// What is cut, or how.
    Cut,
}

/// A point of a way: tip and tool axis.
type At = (Vector3<f64>, Vector3<f64>);

fn motions_of(done: &[BlockEffect]) -> Vec<&Motion> {
    let motions = done.iter().filter_map(|done| match done {
        BlockEffect::Motion(motion) => Some(motion),
        _ => None,
    });
    motions.collect()
}

/// Points of cuts, close together; of rapids, if the chain is given: where its tool is, whatever length is compensated.
fn dense(motions: &[&Motion], rapids: Option<&Chain>) -> Vec<At> {
    let mut points = Vec::new();
    for motion in motions {
        // Out along its axis a tool does no harm at whatever feed.
        let way = motion.to.pose.tip - motion.from.pose.tip;
        let out = way.dot(&motion.from.pose.axis) > 0.999_999 * way.norm()
            && motion.from.pose.axis == motion.to.pose.axis;
        if (motion.kind == MotionKind::Rapid || out) != rapids.is_some() {
            continue;
        }
        let way = (motion.to.pose.tip - motion.from.pose.tip).norm();
        let turn = (0..8)
            .map(|joint| (motion.to.joints[joint] - motion.from.joints[joint]).abs())
            .fold(0.0, f64::max);
        let bent = !matches!(
            motion.way,
            post_readback::Interpolation::Axes | post_readback::Interpolation::Tip(Curve::Straight)
        );
        // A whole circle ends where it begins: of 60 mm its chords stray by a hundredth of a tolerance then.
        let count = 2.0 + way / 0.5 + if bent { 1500.0 } else { 0.0 } + turn.min(10.0) * 10.0;
        let count = (count as u32).min(2000);
        for step in 0..=count {
            let share = f64::from(step) / f64::from(count);
            let ends = [&motion.from, &motion.to];
            let joints = rapids.and_then(|chain| {
                let solver = &motion.state.solver;
                let joints = motion.way.joints_at(solver, ends, share, &motion.from.joints);
                Some((chain, joints.ok()?))
            });
            let pose = match joints {
                Some((chain, joints)) => chain.forward(&joints),
                None => motion.at(share),
            };
            points.push((pose.tip, pose.axis));
        }
    }
    points
}

/// Where the depth axes stand where a tool is changed, and at the end, mm away from the part.
fn drawn_back(job: &Job, done: &[BlockEffect]) -> Vec<f64> {
    let machine = &job.machine;
    let axes = machine.frame.retract.iter().map(|(place, _)| {
        let away = machine.axes[*place].joint.direction.dot(&machine.tool_axis);
        (*place, away.signum())
    });
    let axes: Vec<(usize, f64)> = axes.collect();
    let mut stands = Vec::new();
    let mut last: Option<&Motion> = None;
    for done in done {
        match done {
            BlockEffect::Motion(motion) => last = Some(motion),
            BlockEffect::Event {
                event: ProgramEvent::ToolChange { .. } | ProgramEvent::End,
                ..
            } => {
                if let Some(last) = last {
                    let away = axes.iter().map(|(place, away)| away * last.to.joints[*place]);
                    stands.extend(away);
                }
            }
            _ => {}
        }
    }
    stands
}

/// Rapids that differ come nowhere nearer to what is cut than those in their place, and nowhere lower along the tool.
fn stay_clear(job: &Job, old: &[At], new: &[At], tolerances: [f64; 2]) -> bool {
    let near = |point: &At| {
        let mut near = old.iter();
        let first = near.next()?;
        let nearer =
            |best: At, other: &At| match (other.0 - point.0).norm() < (best.0 - point.0).norm() {
                true => *other,
                false => best,
            };
        Some(near.fold(*first, nearer))
    };
    let strays = new.iter().filter(|point| off(point, old, tolerances) > 1.0);
    let mut strays = strays.map(|point| (point, near(point)));
    strays.all(|(point, near)| {
        near.is_some_and(|near| {
            let least = job.clearance(near.0) - tolerances[0];
            let higher = (point.0 - near.0).dot(&point.1) >= -tolerances[0];
            higher && job.clearance(point.0) >= least
        })
    })
}

/// The ways down in holes: how far each goes below what was cut of its hole, mm.
fn strokes(motions: &[&Motion]) -> Vec<f64> {
    let mut strokes: Vec<f64> = Vec::new();
    let mut goes_on = false;
    for motion in motions {
        let down = motion.hole && motion.kind != MotionKind::Rapid;
        if down {
            let way = (motion.to.pose.tip - motion.from.pose.tip).norm();
            match strokes.last_mut().filter(|_| goes_on) {
                Some(last) => *last += way,
                None => strokes.push(way),
            }
        }
        goes_on = down;
    }
    strokes
}

/// How far a point is from a way, in tolerances.
fn off(point: &At, way: &[At], tolerances: [f64; 2]) -> f64 {
    let mut best = f64::INFINITY;
    for ends in way.windows(2) {
        let ((a, axis_a), (b, axis_b)) = (ends[0], ends[1]);
        let line = b - a;
        let square = line.norm_squared();
        let share =
            if square > 0.0 { ((point.0 - a).dot(&line) / square).clamp(0.0, 1.0) } else { 0.0 };
        let tip = (point.0 - a - line * share).norm() / tolerances[0];
        if tip >= best {
            continue;
        }
        let axis = axis_a + (axis_b - axis_a) * share;
        let angle = (point.1 - axis).norm() / tolerances[1];
        best = best.min(tip.max(angle));
    }
    best
}

/// The larger of the two one-sided distances of two ways, in tolerances.
fn apart(one: &[At], other: &[At], tolerances: [f64; 2]) -> f64 {
    match (one.is_empty(), other.is_empty()) {
        (true, true) => return 0.0,
        (false, false) => {}
        // Nothing, or a point: no metal.
        _ => {
            let way = if one.is_empty() { other } else { one };
            return length(way) / tolerances[0];
        }
    }
    let side = |from: &[At], to: &[At]| {
        from.iter().map(|point| off(point, to, tolerances)).fold(0.0, f64::max)
    };
    side(one, other).max(side(other, one))
}

fn length(way: &[At]) -> f64 {
    way.windows(2).map(|ends| (ends[1].0 - ends[0].0).norm()).sum()
}

/// What holds in a cut, as text.
fn state(motion: &Motion) -> String {
    let state = &motion.state;
    format!(
        "{:?} {:?} {:?} {:?} {:?} {:?}",
        state.tool,
        state.length_register,
        state.spindle,
        state.coolants,
        state.compensation,
        (state.compensation != 0).then_some(state.radius_register)
    )
}

fn same_step(one: &BlockEffect, other: &BlockEffect) -> bool {
    match (one, other) {
        (BlockEffect::Motion(a), BlockEffect::Motion(b)) => {
            let near = |a: &post_readback::Stance, b: &post_readback::Stance| {
                (0..8).all(|joint| (a.joints[joint] - b.joints[joint]).abs() < 1e-9)
            };
            a.kind == b.kind
                && near(&a.from, &b.from)
                && near(&a.to, &b.to)
                && a.way == b.way
                && (a.minutes - b.minutes).abs() < 1e-9
                && state(a) == state(b)
                && (a.state.length - b.state.length).abs() < 1e-9
        }
        (BlockEffect::Event { event: a, .. }, BlockEffect::Event { event: b, .. }) => a == b,
        (BlockEffect::State(_), BlockEffect::State(_)) => true,
        _ => false,
    }
}

/// Whether two programs differ in what the machine does.
fn difference(job: &Job, kind: &str, one: &[BlockEffect], other: &[BlockEffect]) -> Difference {
    let counts = |done: &&BlockEffect| match done {
        BlockEffect::Motion(_) => true,
        BlockEffect::Event { event: told, .. } => {
            matches!(
                told,
                ProgramEvent::Stop | ProgramEvent::OptionalStop | ProgramEvent::Dwell { .. }
            )
        }
        BlockEffect::State(_) => false,
    };
    let (whole, new_whole) = (one, other);
    let one: Vec<&BlockEffect> = one.iter().filter(counts).collect();
    let other: Vec<&BlockEffect> = other.iter().filter(counts).collect();
    let before = one.iter().zip(&other).take_while(|(a, b)| same_step(a, b)).count();
    let behind = one[before..]
        .iter()
        .rev()
        .zip(other[before..].iter().rev())
        .take_while(|(a, b)| same_step(a, b))
        .count();
    let one = &one[before..one.len() - behind];
    let other = &other[before..other.len() - behind];
    let motions = |done: &[&BlockEffect]| -> Vec<Motion> {
        let motions = done.iter().filter_map(|done| match done {
            BlockEffect::Motion(motion) => Some(motion.clone()),
            _ => None,
        });
        motions.collect()
    };
    let [stands, new_stands] = [whole, new_whole].map(|done| drawn_back(job, done));
    let told = |done: &[&BlockEffect]| -> Vec<String> {
        let told = done.iter().filter_map(|done| match done {
            // Hundredths of a second are rounded.
            BlockEffect::Event { event: ProgramEvent::Dwell { time, .. }, .. } => {
                Some(format!("dwell {:.0}", time * 50.0))
            }
            BlockEffect::Event { event: told, .. } => Some(format!("{told:?}")),
            _ => None,
        });
        told.collect()
    };
    if told(one) != told(other) {
        return Difference::Cut;
    }
    let (one, other) = (motions(one), motions(other));
    let (one, other): (Vec<&Motion>, Vec<&Motion>) = (one.iter().collect(), other.iter().collect());
    let accuracy = &job.machine.accuracy;
    let tolerances = [accuracy.tolerance, accuracy.axis_tolerance];
    let [cut, new] = [&one, &other].map(|motions| dense(motions, None));
    if apart(&cut, &new, tolerances) > 1.0 {
        return Difference::Cut;
    }
    // A hole may be made in smaller pecks than the CL file asks for: the same metal goes, in shorter chips, and the tool
    // comes out once more for each. Larger ones may break it.
    let most = |motions: &[&Motion]| strokes(motions).into_iter().fold(0.0, f64::max);
    let holes = |motions: &[&Motion]| {
        let mut cuts = motions.iter().filter(|motion| motion.kind != MotionKind::Rapid);
        strokes(motions).len() > 1 && cuts.all(|motion| motion.hole)
    };
    if kind == "peck" && holes(&other) && most(&other) <= most(&one) + tolerances[0] {
        return Difference::None;
    }
    // To and fro lies on the same line. Of ways whose ends are rounded the lengths differ a little.
    let [long, new_long] = [&cut, &new].map(|way| length(way));
    if (long - new_long).abs() > 0.02 + 0.002 * long {
        return Difference::Cut;
    }
    let by_state = |motions: &[&Motion]| {
        let mut lengths: BTreeMap<String, (f64, f64)> = BTreeMap::new();
        for motion in motions {
            if motion.kind != MotionKind::Rapid {
                let way = length(&dense(&[motion], None));
                if way == 0.0 {
                    continue;
                }
                let sum = lengths.entry(state(motion)).or_default();
                sum.0 += way;
                sum.1 += motion.minutes;
            }
        }
        lengths
    };
    let (old_states, new_states) = (by_state(&one), by_state(&other));
    let keys: std::collections::BTreeSet<&String> =
        old_states.keys().chain(new_states.keys()).collect();
    for key in keys {
        let (a, b) = (
            old_states.get(key).copied().unwrap_or_default(),
            new_states.get(key).copied().unwrap_or_default(),
        );
        if (a.0 - b.0).abs() > 0.02 + 0.002 * a.0.max(b.0) {
            return Difference::Cut;
        }
        // Feeds are compared to half a per cent and half a millimetre a minute, and short ways are rounded.
        let slack = 0.02 * a.1 + 0.01 / 200.0;
        if (a.1 - b.1).abs() > slack {
            return Difference::Cut;
        }
    }
    let [rapid, new_rapid] = [&one, &other].map(|motions| dense(motions, Some(&job.chain)));
    let tolerances = [accuracy.rapid_tolerance, 1f64.to_radians()];
    let mut stands = stands.iter().zip(&new_stands);
    if stands.any(|(old, new)| *new < old - tolerances[0]) {
        return Difference::Rapids;
    }
    if apart(&rapid, &new_rapid, tolerances) > 1.0 {
        return match stay_clear(job, &rapid, &new_rapid, tolerances) {
            true => Difference::Clear,
            false => Difference::Rapids,
        };
    }
    Difference::None
}

/// Of each kind: how many, and of each difference caught and not.
#[derive(Default)]
struct Tally {
    by: BTreeMap<&'static str, BTreeMap<(Difference, bool), u64>>,
    missed: Vec<String>,
    let_pass: Vec<String>,
}

fn study(jobs: &[Job], each: u64, own: u64) -> Tally {
    let mut tally = Tally::default();
    for (index, job) in jobs.iter().enumerate() {
        let mut random = seeded(own + index as u64);
        for kind in KINDS {
            for _ in 0..each {
                let mut lines = job.lines.clone();
                let mut length = job.length;
                if mutate(kind, &mut random, &mut lines, &mut length).is_none() {
                    break;
                }
                let (done, faults) = job.run(&lines, length);
                let differs = match MALFORMED.contains(kind) {
                    true => Difference::Cut,
                    false => difference(job, kind, &job.done, &done),
                };
                let caught = !faults.is_empty();
                let shaped = ["digit", "sign", "arc"].contains(kind);
                let differs = match differs {
                    Difference::Cut if !caught && shaped && job.keeps_the_path(&done) => {
                        Difference::None
                    }
                    differs => differs,
                };
                let row = tally.by.entry(kind).or_default();
                *row.entry((differs, caught)).or_default() += 1;
                if differs == Difference::Rapids && !caught {
                    let changed = job.lines.iter().zip(&lines).find(|(old, new)| old != new);
                    tally.let_pass.push(format!("{}: {kind}: {changed:?} {length}", job.name));
                }
                if differs == Difference::Cut && !caught {
                    let changed = job.lines.iter().zip(&lines).find(|(old, new)| old != new);
                    tally.missed.push(format!("{}: {kind}: {changed:?} {length}", job.name));
                }
            }
        }
    }
    tally
}

fn table(tally: &Tally) -> String {
    let mut text = format!(
        "{:<14} {:>6} | {:>7} {:>6} | {:>7} {:>8} | {:>6} {:>6} | {:>5} {:>6}\n{:<14} {:>6} | {:^14} | {:^16} | {:^13} | {:^12}\n",
        "",
        "",
        "caught",
        "missed",
        "caught",
        "let pass",
        "caught",
        "passed",
        "caught",
        "passed",
        "change",
        "count",
        "cut differs",
        "rapids differ",
        "rapids clear",
        "no difference"
    );
    let mut sums = [0; 9];
    for (kind, row) in &tally.by {
        let of = |differs, caught| row.get(&(differs, caught)).copied().unwrap_or(0);
        let cells = [
            row.values().sum::<u64>(),
            of(Difference::Cut, true),
            of(Difference::Cut, false),
            of(Difference::Rapids, true),
            of(Difference::Rapids, false),
            of(Difference::Clear, true),
            of(Difference::Clear, false),
            of(Difference::None, true),
            of(Difference::None, false),
        ];
        for (sum, cell) in sums.iter_mut().zip(cells) {
            *sum += cell;
        }
        text.push_str(&line(kind, &cells));
    }
    text.push_str(&line("all", &sums));
    text
}

fn line(name: &str, cells: &[u64; 9]) -> String {
    let [count, a, b, c, d, e, f, g, h] = cells;
    format!(
        "{name:<14} {count:>6} | {a:>7} {b:>6} | {c:>7} {d:>8} | {e:>6} {f:>6} | {g:>5} {h:>6}\n"
    )
}

/// Machine, sample, who keeps the tip.
const JOBS: &[(&str, &str, &str)] = &[
    ("vmc", "flange.ncl", ""),
    ("ac-trunnion", "facets.apt", "control"),
    ("ac-trunnion", "facets.apt", "post"),
    ("ac-trunnion", "blade.cls", "control"),
    ("head-head", "blade.cls", "post"),
    ("head-head", "facets.apt", "post"),
];

fn jobs(dialects: &[&str], rows: &[(&str, &str, &str)]) -> Vec<Job> {
    let rows = dialects.iter().flat_map(|dialect| rows.iter().map(move |row| (*dialect, *row)));
    rows.filter_map(|(dialect, (machine, file, tcp))| Job::new(dialect, machine, file, tcp))
        .collect()
}

#[test]
fn what_differs_is_caught() {
    assert!(Path::new("tests/samples").exists());
    let jobs = drawn(jobs(&["fanuc", "heidenhain"], &JOBS[..3]), 2);
    let tally = study(&jobs, 1, 1);
    println!("{}", table(&tally));
    assert!(tally.missed.is_empty(), "{}\n{}", table(&tally), tally.missed.join("\n"));
}

/// An arc that turns the other way, or about another centre, is told where it stands, not on the block behind it.
#[test]
fn a_wrong_arc_is_told_on_its_own_block() {
    let jobs = jobs(&["fanuc", "haas", "mazak"], &JOBS[..1]);
    let mut looked = 0;
    for job in &jobs {
        for place in 0..job.lines.len() {
            let words: Vec<&str> = job.lines[place].split(' ').collect();
            let Some(code) = words.iter().position(|word| ["G2", "G3"].contains(word)) else {
                continue;
            };
            let mut lines = job.lines.clone();
            let mut words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
            let turned = if words[code] == "G2" { "G3" } else { "G2" };
            words[code] = turned.to_owned();
            lines[place] = words.join(" ");
            let (_, faults) = job.run(&lines, job.length);
            let off: Vec<_> =
                faults.iter().filter(|(_, told)| told.starts_with("deviation")).collect();
            let first = off.first().and_then(|(line, _)| *line);
            let own = place as u64 + 1;
            assert_eq!(first, Some(own), "{}: {}\n{faults:#?}", job.name, lines[place]);
            looked += 1;
        }
    }
    assert!(looked >= 12, "{looked}");
}

/// The study: `cargo test --test it mutations -- --ignored --nocapture`; POST_MUTATIONS is how often each change is made to
/// each program.
#[test]
#[ignore = "thousands of programs: minutes"]
fn thousands_of_changes() {
    let dialects: Vec<&str> = DIALECTS.iter().map(String::as_str).collect();
    let jobs = jobs(&dialects, JOBS);
    let each = std::env::var("POST_MUTATIONS").map_or(25, |each| each.parse().unwrap());
    let tally = study(&jobs, each, 1000);
    println!("{} programs\n{}", jobs.len(), table(&tally));
    for missed in &tally.missed {
        println!("missed: {missed}");
    }
    for passed in &tally.let_pass {
        println!("rapid let pass: {passed}");
    }
    assert!(tally.missed.is_empty());
    // Of rapids that come nearer to what is cut, lower, or less far back than they should, nineteen in twenty are found: an
    // order of two that both lead to the first point of a tool is not looked at.
    let worse = |caught: bool| -> u64 {
        let rows = tally.by.values();
        rows.filter_map(|row| row.get(&(Difference::Rapids, caught))).sum()
    };
    let [found, passed] = [true, false].map(worse);
    assert!(passed * 20 <= found + passed, "{passed} pass, {found} are found");
}
