//! What a machine file says of single axes, seen in the program: zero, sense, range, positions, clamps, axes that
//! exclude one another, a sixth axis, an edge, heads, quills, and the choice between solutions.
//!
//! Expected numbers are worked out by hand, or read back by the tests' own kinematics.

mod approach;
mod choice;
mod edge;
mod erring;
mod exclusive;
mod few;
mod heads;
mod indexed;
mod leave;
mod limits;
mod quill;
mod words;
mod zero;

use crate::common;

use std::fmt::Write as _;
use std::fs;

use common::{Run, check_numbers, post, root};
use post_testruns::read_back::{Block, Model, Pose, V, angle, blocks, overlay, table};
use toml::{Table, Value};

/// Words that are rounded move the tip by so much, mm.
const ROUNDING: f64 = 0.003;

/// A machine of the library with some keys changed.
struct Setup {
    machine: &'static str,
    /// A machine file that extends it.
    file: Option<String>,
    set: Vec<(String, String)>,
    length: f64,
    /// Ending of the CL file, which says its dialect.
    ending: &'static str,
}

/// `machine` with a tool of 100 mm.
fn on(machine: &'static str) -> Setup {
    // What reads the programs knows no plane but that of the part.
    let set = vec![("control.planes".to_owned(), "false".to_owned())];
    Setup { machine, file: None, set, length: 100.0, ending: "ncl" }
}

impl Setup {
    /// With `key` at `value`, as `--set` takes it.
    fn with(mut self, key: &str, value: &str) -> Self {
        self.set.push((key.to_owned(), value.to_owned()));
        self
    }

    /// With the keys of a machine file laid over it.
    fn file(mut self, text: impl Into<String>) -> Self {
        self.file = Some(text.into());
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
        let mut machine = self.machine.to_owned();
        if let Some(text) = &self.file {
            let path = folder.path().join("machine.toml");
            fs::write(&path, format!("extends = {:?}\n{text}", self.machine)).unwrap();
            machine = path.to_str().unwrap().to_owned();
        }
        let mut arguments = vec!["-q".to_owned(), "-m".to_owned(), machine];
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
        if let Some(text) = &self.file {
            overlay(&mut table, text.parse().unwrap());
        }
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

fn near(a: f64, b: f64, within: f64) -> bool {
    (a - b).abs() <= within
}

// ---------------------------------------------------------------------------------------------------------------
// Zero and sense
// ---------------------------------------------------------------------------------------------------------------

/// A few cuts that turn A and C of the trunnion.
fn turning_cuts() -> String {
    turning_cuts_from(V::z())
}

/// The same, the first position with another tool axis.
fn turning_cuts_from(axis: V) -> String {
    let mut cl = cl().rapid(V::new(0.0, 0.0, 60.0), axis);
    cl = cl.rapid(V::new(10.0, 5.0, 40.0), lean(10.0, 90.0));
    for step in 0..5 {
        let step = f64::from(step);
        let tip = V::new(10.0 + 4.0 * step, 5.0 - step, 20.0);
        cl = cl.cut(tip, lean(10.0 + 3.0 * step, 90.0 + 8.0 * step));
    }
    cl.rapid(V::new(20.0, 5.0, 60.0), lean(20.0, 130.0)).end()
}

/// Clamps hold what stands in a cut, also an axis that turns in other operations: they are let go before its next word.
/// The option of the dialect and the keys of the axes say the same.
#[test]
fn clamps_hold_axes_that_are_not_indexed() {
    let sample = crate::common::sample("wedge.ncl");
    let wedge = |with: &[&str]| {
        let mut all =
            vec!["-q", "-m", "ac-trunnion", "--tool-length", "100", "-o", "-", "--verify"];
        all.extend(with);
        all.push(sample.to_str().unwrap());
        let done = crate::common::post(&all);
        assert_eq!(done.code, 0, "{}", done.err);
        done.out
    };
    let own = wedge(&["--set", "control.fanuc.clamps=[\"A M20 M21\", \"C M10 M11\"]"]);
    let keys = wedge(&[
        "--set",
        "axis.A.clamp=\"M20\"",
        "--set",
        "axis.A.unclamp=\"M21\"",
        "--set",
        "axis.C.clamp=\"M10\"",
        "--set",
        "axis.C.unclamp=\"M11\"",
    ]);
    assert_eq!(own, keys);
    let (mut clamped, mut held) = (None, 0);
    for line in own.lines() {
        match line {
            "M10" => clamped = Some(true),
            "M11" => clamped = Some(false),
            _ if line.split_whitespace().any(|word| word.starts_with('C')) => {
                assert_eq!(clamped, Some(false), "{line}\n{own}");
            }
            _ if line.contains(" F") && line.contains('X') => {
                held += u32::from(clamped == Some(true))
            }
            _ => {}
        }
    }
    assert!(held > 0, "{own}");
}
