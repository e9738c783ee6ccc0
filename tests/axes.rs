//! What a machine file says of single axes, seen in the program: zero, sense, range, positions, clamps, axes that
//! exclude one another, a sixth axis, an edge, heads, quills, and the choice between solutions.
//!
//! Expected numbers are worked out by hand, or read back by the tests' own kinematics.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

mod common;

use std::fmt::Write as _;
use std::fs;

use common::read_back::{Block, Model, Pose, V, angle, blocks, table};
use common::{Run, check_numbers, post, root};
use toml::{Table, Value};

/// Words that are rounded move the tip by so much, mm.
const ROUNDING: f64 = 0.003;

/// A machine of the library with some keys changed.
struct Setup {
    machine: &'static str,
    set: Vec<(String, String)>,
    length: f64,
    /// Ending of the CL file, which says its dialect.
    ending: &'static str,
}

/// `machine` with a tool of 100 mm.
fn on(machine: &'static str) -> Setup {
    Setup {
        machine,
        set: Vec::new(),
        length: 100.0,
        ending: "ncl",
    }
}

impl Setup {
    /// With `key` at `value`, as `--set` takes it.
    fn with(mut self, key: &str, value: &str) -> Self {
        self.set.push((key.to_owned(), value.to_owned()));
        self
    }

    fn long(mut self, length: f64) -> Self {
        self.length = length;
        self
    }

    fn run(&self, text: &str) -> Run {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(format!("part.{}", self.ending));
        fs::write(&file, text).unwrap();
        let mut arguments = vec!["-q".to_owned(), "-m".to_owned(), self.machine.to_owned()];
        arguments.extend(["--tool-length".to_owned(), self.length.to_string()]);
        for (key, value) in &self.set {
            arguments.extend(["--set".to_owned(), format!("{key}={value}")]);
        }
        arguments.extend(["-o".to_owned(), "-".to_owned()]);
        arguments.push(file.to_str().unwrap().to_owned());
        post(&arguments)
    }

    /// The program; it must be made.
    fn made(&self, text: &str) -> Made {
        let run = self.run(text);
        assert_eq!(run.code, 0, "{}:\n{}", self.machine, run.err);
        check_numbers(&run.out);
        let model = self.model(None);
        let names: Vec<String> = model.axes.iter().map(|axis| axis.name.clone()).collect();
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        Made {
            blocks: blocks(&run.out, &known, &[]),
            text: run.out,
            names,
            model,
            length: self.length,
        }
    }

    /// What is said where it must be refused.
    fn refused(&self, text: &str) -> String {
        let run = self.run(text);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
        run.err
    }

    fn model(&self, head: Option<&str>) -> Model {
        let mut table = table(self.machine);
        for (key, value) in &self.set {
            let value: Value = format!("v = {value}")
                .parse::<Table>()
                .map_or_else(|_| Value::String(value.clone()), |table| table["v"].clone());
            let mut place = &mut table;
            let (path, last) = key.rsplit_once('.').unwrap_or(("", key));
            for part in path.split('.').filter(|part| !part.is_empty()) {
                let entry = place.entry(part).or_insert(Value::Table(Table::new()));
                place = entry.as_table_mut().unwrap();
            }
            place.insert(last.to_owned(), value);
        }
        Model::from_table(table, head)
    }
}

/// A program that was made.
struct Made {
    text: String,
    blocks: Vec<Block>,
    names: Vec<String>,
    model: Model,
    length: f64,
}

impl Made {
    fn place(&self, name: &str) -> usize {
        self.names.iter().position(|known| known == name).unwrap()
    }

    /// The words of one axis.
    fn words(&self, name: &str) -> Vec<f64> {
        let place = self.place(name);
        self.blocks.iter().map(|block| block.words[place]).collect()
    }

    fn poses(&self) -> Vec<Pose> {
        let pose = |block: &Block| self.model.pose(&block.words, self.length);
        self.blocks.iter().map(pose).collect()
    }

    /// Block by block, the words of `other` minus these, by axis.
    fn differences(&self, other: &Self) -> Vec<Vec<f64>> {
        assert_eq!(self.blocks.len(), other.blocks.len());
        let pairs = self.blocks.iter().zip(&other.blocks);
        let of = |(a, b): (&Block, &Block)| {
            assert_eq!(a.rapid, b.rapid);
            let words = b.words.iter().zip(&a.words);
            words.map(|(b, a)| b - a).collect()
        };
        pairs.map(of).collect()
    }

    fn line(&self, block: &Block) -> &str {
        self.text.lines().nth(block.line - 1).unwrap()
    }
}

/// A CL file of five-axis points: rapids and cuts.
#[derive(Default)]
struct Cl {
    text: String,
}

fn cl() -> Cl {
    Cl {
        text:
            "PARTNO / PART\nUNITS / MM\nLOADTL / 1\nSPINDL / RPM, 6000, CLW\nFEDRAT / 500, MMPM\n"
                .to_owned(),
    }
}

impl Cl {
    fn line(mut self, line: &str) -> Self {
        writeln!(self.text, "{line}").unwrap();
        self
    }

    fn cut(self, tip: V, axis: V) -> Self {
        self.line(&format!(
            "GOTO / {:.6}, {:.6}, {:.6}, {:.9}, {:.9}, {:.9}",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        ))
    }

    fn edge(self, tip: V, axis: V, edge: V) -> Self {
        self.line(&format!(
            "GOTO / {:.6}, {:.6}, {:.6}, {:.9}, {:.9}, {:.9}, {:.9}, {:.9}, {:.9}",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z, edge.x, edge.y, edge.z
        ))
    }

    fn rapid(self, tip: V, axis: V) -> Self {
        self.line("RAPID").cut(tip, axis)
    }

    fn end(self) -> String {
        self.line("FINI").text
    }
}

/// A tool axis that leans by `tilt` towards `azimuth`, degrees.
fn lean(tilt: f64, azimuth: f64) -> V {
    let (sine, cosine) = libm::sincos(tilt.to_radians());
    let (sa, ca) = libm::sincos(azimuth.to_radians());
    V::new(sine * ca, sine * sa, cosine)
}

/// `angle` on the turn nearest to `last`: where a control that takes the shorter way turns to.
fn shorter(angle: f64, last: f64) -> f64 {
    angle + 360.0 * libm::round((last - angle) / 360.0)
}

fn near(a: f64, b: f64, within: f64) -> bool {
    (a - b).abs() <= within
}

// ---------------------------------------------------------------------------------------------------------------
// Zero and sense
// ---------------------------------------------------------------------------------------------------------------

/// A few cuts that turn A and C of the trunnion.
fn turning_cuts() -> String {
    let mut cl = cl().rapid(V::new(0.0, 0.0, 60.0), V::z());
    cl = cl.rapid(V::new(10.0, 5.0, 40.0), lean(10.0, 90.0));
    for step in 0..5 {
        let step = f64::from(step);
        let tip = V::new(10.0 + 4.0 * step, 5.0 - step, 20.0);
        cl = cl.cut(tip, lean(10.0 + 3.0 * step, 90.0 + 8.0 * step));
    }
    cl.rapid(V::new(20.0, 5.0, 60.0), lean(20.0, 130.0)).end()
}

#[test]
fn a_shifted_rotary_zero_shifts_the_words_of_its_axis_alone() {
    let cl = turning_cuts();
    for (axis, travel) in [("C", None), ("A", Some("[-30, 120]"))] {
        let base = on("ac-trunnion").with("control.tcp", "control");
        let base = base.made(&cl);
        let mut shifted = on("ac-trunnion")
            .with("control.tcp", "control")
            .with(&format!("axis.{axis}.zero"), "90");
        if let Some(travel) = travel {
            shifted = shifted.with(&format!("axis.{axis}.travel"), travel);
        }
        let shifted = shifted.made(&cl);
        let place = base.place(axis);
        for words in base.differences(&shifted) {
            for (other, by) in words.iter().enumerate() {
                let wanted = if other == place { 90.0 } else { 0.0 };
                assert!(near(*by, wanted, 1e-9), "{axis}: {words:?}");
            }
        }
    }
}

/// With the post keeping the tip, the work offset is taken where the rotary axes read zero. C turns about the
/// part origin, so nothing else changes. A reading 0 is the drawing's -90: the part is turned by +90° about the
/// line through (y 0.012, z 50.004), which brings its origin from (0, 0) to (0.012 + 50.004, 50.004 - 0.012).
#[test]
fn the_work_offset_is_taken_where_the_rotary_axes_read_zero() {
    let cl = turning_cuts();
    let base = on("ac-trunnion").with("control.tcp", "post").made(&cl);
    for (axis, travel, y, z) in [
        ("C", None, 0.0, 0.0),
        ("A", Some("[-30, 120]"), -50.016, -49.992),
    ] {
        let mut shifted = on("ac-trunnion")
            .with("control.tcp", "post")
            .with(&format!("axis.{axis}.zero"), "90");
        if let Some(travel) = travel {
            shifted = shifted.with(&format!("axis.{axis}.travel"), travel);
        }
        let shifted = shifted.made(&cl);
        // Before all axes are told, the first words still hold the old values.
        for words in base.differences(&shifted) {
            for (name, by) in base.names.iter().zip(&words) {
                let wanted = match name.as_str() {
                    "Y" => y,
                    "Z" => z,
                    name if name == axis => 90.0,
                    _ => 0.0,
                };
                assert!(near(*by, wanted, 0.0011), "{axis}: {name} {by} {wanted}");
            }
        }
    }
}

#[test]
fn travel_is_given_in_what_the_control_shows() {
    let far = cl().line("GOTO / 250, 0, 60").end();
    let vmc = || on("vmc").with("axis.X.travel", "[-300, 300]");
    vmc().made(&far);
    let said = vmc().with("axis.X.zero", "90").refused(&far);
    assert!(
        said.contains("error[over-travel]: X would be 340.000 mm, its limit is 300.000 mm"),
        "{said}"
    );
    // The drawing's travel, as the control shows it: the same program, for linear words count from the offset.
    let cl = turning_cuts();
    let base = on("ac-trunnion").with("control.tcp", "post").made(&cl);
    let shifted = on("ac-trunnion")
        .with("control.tcp", "post")
        .with("axis.X.zero", "90")
        .with("axis.X.travel", "[-210, 390]");
    assert_eq!(shifted.made(&cl).text, base.text);
    let tilted = turning_cuts();
    let said = on("ac-trunnion").with("axis.A.zero", "90").refused(&tilted);
    assert!(said.contains("its limit is 30.000°"), "{said}");
}

#[test]
fn a_reversed_axis_has_the_opposite_words() {
    let cl = turning_cuts();
    for (axis, travel) in [("C", None), ("A", Some("[-30, 120]"))] {
        for tcp in ["control", "post"] {
            let base = on("ac-trunnion").with("control.tcp", tcp).made(&cl);
            let mut other = on("ac-trunnion")
                .with("control.tcp", tcp)
                .with(&format!("axis.{axis}.reversed"), "true");
            if let Some(travel) = travel {
                other = other.with(&format!("axis.{axis}.travel"), travel);
            }
            let other = other.made(&cl);
            assert!(base.words(axis).iter().any(|word| word.abs() > 10.0));
            assert_eq!(base.blocks.len(), other.blocks.len());
            for (a, b) in base.blocks.iter().zip(&other.blocks) {
                for (name, (a, b)) in base.names.iter().zip(a.words.iter().zip(&b.words)) {
                    let wanted = if name == axis { -*a } else { *a };
                    assert!(near(*b, wanted, 1e-9), "{tcp} {axis}: {name} {a} {b}");
                }
            }
        }
    }
    // A linear axis: its words are axis positions.
    let base = on("ac-trunnion").with("control.tcp", "post").made(&cl);
    let other = on("ac-trunnion")
        .with("control.tcp", "post")
        .with("axis.Y.reversed", "true")
        .made(&cl);
    for (a, b) in base.words("Y").iter().zip(other.words("Y")) {
        assert!(near(*a, -b, 1e-9), "{a} {b}");
    }
}

// ---------------------------------------------------------------------------------------------------------------
// Range of a cyclic axis
// ---------------------------------------------------------------------------------------------------------------

/// Two turns and a half of a tool that leans outwards, then rapids to all sides.
fn spiral() -> String {
    let mut cl = cl().rapid(V::new(90.0, 0.0, 90.0), lean(20.0, 0.0));
    for step in 0..=90 {
        let azimuth = 10.0 * f64::from(step);
        let (sine, cosine) = libm::sincos(azimuth.to_radians());
        let tip = V::new(60.0 * cosine, 60.0 * sine, 40.0 - 0.1 * f64::from(step));
        cl = cl.cut(tip, lean(20.0, azimuth));
    }
    for azimuth in [180.0, 30.0, 209.9, 0.0, 270.0, 90.0, 359.99997, 179.99997] {
        let (sine, cosine) = libm::sincos(f64::to_radians(azimuth));
        let high = V::new(90.0 * cosine, 90.0 * sine, 90.0);
        cl = cl.rapid(high, lean(20.0, azimuth));
        let tip = V::new(60.0 * cosine, 60.0 * sine, 40.0);
        cl = cl.cut(tip, lean(20.0, azimuth));
    }
    cl.rapid(V::new(90.0, 0.0, 90.0), lean(20.0, 180.0)).end()
}

#[test]
fn words_stay_in_the_range_that_the_control_shows() {
    // A leans one way only, so that C has to turn by half a turn.
    let narrow = || on("ac-trunnion").with("axis.A.travel", "[-120, 5]");
    let cl = spiral();
    for tcp in ["control", "post"] {
        let endless = narrow().with("control.tcp", tcp).made(&cl);
        let words = endless.words("C");
        assert!(words.iter().any(|word| word.abs() > 720.0), "{words:?}");
        for (range, least) in [("[0, 360]", 0.0), ("[-180, 180]", -180.0)] {
            let made = narrow()
                .with("control.tcp", tcp)
                .with("axis.C.range", range)
                .made(&cl);
            let words = made.words("C");
            for word in &words {
                assert!((least..least + 360.0).contains(word), "{range}: C{word}");
            }
            // The control takes the shorter way: it must be the way that is meant, so never nearly half a turn.
            let mut stands = words[0];
            let mut ways = vec![stands];
            for word in &words[1..] {
                let next = shorter(*word, stands);
                assert!((next - stands).abs() < 179.0, "{range}: {stands} to {word}");
                stands = next;
                ways.push(stands);
            }
            // Each point of the path is met, in order, on the turn on which the endless axis stands there.
            let turns = ways[0] - endless.words("C")[0];
            let place = made.place("C");
            let mut at = 0;
            for block in &endless.blocks {
                let met = (at..made.blocks.len()).find(|at| {
                    let mut words = made.blocks[*at].words.clone();
                    words[place] = ways[*at] - turns;
                    let pairs = words.iter().zip(&block.words);
                    pairs.fold(true, |met, (a, b)| met && near(*a, *b, 2e-3))
                });
                at = met.unwrap_or_else(|| {
                    panic!("{tcp} {range}: line {}: {:?}", block.line, block.words)
                });
            }
            // Blocks that were put in stand on the way too: the tip stays on it as well as in the other program.
            assert!(made.blocks.len() >= endless.blocks.len());
        }
    }
}

/// A rapid that turns C by half a turn exactly is made in two pieces: the control could take either way.
#[test]
fn half_a_turn_is_made_in_pieces() {
    let cl = cl()
        .rapid(V::new(60.0, 0.0, 90.0), lean(60.0, 0.0))
        .rapid(V::new(-60.0, 0.0, 90.0), lean(60.0, 180.0))
        .end();
    let setup = || on("ac-trunnion").with("control.tcp", "control");
    let endless = setup().made(&cl).words("C");
    assert_eq!((endless[1] - endless[0]).abs(), 180.0, "{endless:?}");
    let shown = setup().with("axis.C.range", "[0, 360]").made(&cl);
    let words = shown.words("C");
    let last = words.len() - 1;
    assert_eq!(shorter(words[last], endless[1]), endless[1], "{words:?}");
    assert!(words.len() > 2, "{words:?}");
}

// ---------------------------------------------------------------------------------------------------------------
// Axes of which one at most moves
// ---------------------------------------------------------------------------------------------------------------

const EXCLUSIVE: &str = r#"[["A", "C"]]"#;

#[test]
fn exclusive_axes_move_one_after_the_other() {
    let (from, to) = (V::new(30.0, 0.0, 60.0), V::new(-10.0, 25.0, 70.0));
    let cl = cl()
        .rapid(from, V::z())
        .rapid(from, lean(15.0, -90.0))
        .rapid(to, lean(40.0, 10.0))
        .cut(to - V::z() * 20.0, lean(40.0, 10.0))
        .rapid(to, lean(40.0, 10.0))
        .end();
    for tcp in ["control", "post"] {
        let free = on("ac-trunnion").with("control.tcp", tcp).made(&cl);
        let (a, c) = (free.place("A"), free.place("C"));
        let both = |pair: &[Block]| {
            let moves = |place: usize| pair[0].words[place] != pair[1].words[place];
            moves(a) && moves(c)
        };
        assert!(free.blocks.windows(2).any(both), "{}", free.text);
        let made = on("ac-trunnion")
            .with("control.tcp", tcp)
            .with("solution.exclusive", EXCLUSIVE)
            .made(&cl);
        assert!(!made.blocks.windows(2).any(both), "{}", made.text);
        // The end is the same.
        let last = |made: &Made| made.blocks.last().unwrap().words.clone();
        assert_eq!(last(&made), last(&free));
        // One of them turns first, and then the tip is still where it was.
        let poses = made.poses();
        let here = |at: &usize| {
            (poses[*at].tip - from).norm() < ROUNDING
                && angle(poses[*at].axis, lean(15.0, -90.0)) < 0.01
        };
        let start = (0..poses.len()).rfind(here).unwrap();
        let goal = lean(40.0, 10.0);
        let turned: Vec<f64> = (start + 1..poses.len())
            .take_while(|at| (poses[*at].tip - from).norm() < ROUNDING)
            .map(|at| angle(poses[at].axis, goal))
            .collect();
        assert!(!turned.is_empty(), "{}", made.text);
        // Between its blocks it strays by no more than the tolerance of rapids: half way, by the words.
        for at in start..start + turned.len() {
            let pair = made.blocks[at].words.iter().zip(&made.blocks[at + 1].words);
            let middle: Vec<f64> = pair.map(|(a, b)| (a + b) / 2.0).collect();
            let off = (made.model.pose(&middle, made.length).tip - from).norm();
            assert!(off <= 0.5 + ROUNDING, "{off}");
        }
    }
}

#[test]
fn a_cut_that_moves_exclusive_axes_is_refused() {
    let cl = turning_cuts();
    on("ac-trunnion").made(&cl);
    let said = on("ac-trunnion")
        .with("solution.exclusive", EXCLUSIVE)
        .refused(&cl);
    for word in ["error[exclusive]", "A and C", "GOTO / 14.000000"] {
        let word = if word == "A and C" && said.contains("C and A") {
            "C and A"
        } else {
            word
        };
        assert!(said.contains(word), "{said}");
    }
    // A cut that turns one of them is made.
    let one = cl_of_c();
    let free = on("ac-trunnion").made(&one);
    let made = on("ac-trunnion")
        .with("solution.exclusive", EXCLUSIVE)
        .made(&one);
    assert_eq!(made.text, free.text);
}

/// Cuts that turn C alone.
fn cl_of_c() -> String {
    let mut cl = cl().rapid(V::new(30.0, 0.0, 60.0), V::z());
    for step in 0..5 {
        let azimuth = 5.0 * f64::from(step);
        let (sine, cosine) = libm::sincos(azimuth.to_radians());
        // Upright: the turn is that of the fourth point on, about a tool that leans the same way all along.
        cl = cl.cut(V::new(30.0 * cosine, 30.0 * sine, 20.0), V::z());
    }
    cl.end()
}

/// The first position comes from anywhere: both axes may have to move.
#[test]
#[ignore = "the first position is one block of all rotary words"]
fn exclusive_axes_are_not_brought_to_the_first_position_together() {
    let tip = V::new(30.0, 0.0, 60.0);
    let cl = cl().rapid(tip, lean(15.0, 30.0)).end();
    let made = on("ac-trunnion")
        .with("solution.exclusive", EXCLUSIVE)
        .made(&cl);
    for line in made.text.lines() {
        let has = |name: char| line.split(' ').any(|word| word.starts_with(name));
        assert!(!(has('A') && has('C')), "{line}");
    }
}
