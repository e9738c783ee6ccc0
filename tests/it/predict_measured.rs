//! `post predict --measured`: logs that no line of the code under test has made, laid over predictions; and `--fit`.
//!
//! Where the axes are commanded is a closed form (`course`), where they are comes from Runge and Kutta (`plant`), and the
//! logs are written as recorders write them (`recorder`).

mod course;
mod fit;
mod logs;
mod plant;
mod recorder;
mod refusals;

use std::fs;
use std::path::PathBuf;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Run, post_in, read_json};
use course::{Course, program};
use recorder::Recorder;

/// The machine of the program; its axes begin where the program does.
const MILL: &str = r#"name = "shop mill"
chain = "[w C' b X Y Z (S) t]"
[tool]
gauge = [0, 0, 500]
axis = [0, 0, 1]
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
max_feed = 6000
max_accel = 400
[axis.X]
linear = [1, 0, 0]
travel = [-400, 400]
max_feed = 20000
max_accel = 2000
[axis.Y]
linear = [0, 1, 0]
travel = [-400, 400]
max_feed = 20000
max_accel = 1500
[axis.Z]
linear = [0, 0, 1]
travel = [-600, 100]
max_feed = 15000
max_accel = 1200
[control]
dialect = "fanuc"
tcp = "post"
[solution]
start = { Z = -480 }
[motion]
corner = "stop"
[servo.X.loops]
kv = 40
velocity_feed_forward = 0.5
velocity_gain = 2.0
velocity_time = 0.02
motor_inertia = 0.006
[servo.X.loops.screw]
lead = 10
axial_stiffness = 150
axial_damping = 6000
table_mass = 300
table_damping = 2000
[servo.Y.pid]
kp = 30
ki = 120
kd = 0.9
gain = 1.6
inertia = 0.007
damping = 0.02
[servo.Z.transfer]
numerator = [900]
denominator = [1, 42, 900]
[servo.C.loops]
kv = 30
velocity_gain = 300
velocity_time = 0.03
motor_inertia = 0.9
[servo.C.loops.direct]
load = 1.5
load_damping = 1
"#;

/// A folder with machine, program and a log.
struct Shop(TempDir);

impl Shop {
    fn new(machine: &str, log: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mill.toml"), machine).unwrap();
        fs::write(folder.path().join("part.nc"), program()).unwrap();
        fs::write(folder.path().join("log.csv"), log).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Predicts with the log and more arguments.
    fn run(&self, more: &[&str]) -> Run {
        let arguments = [
            "predict",
            "part.nc",
            "-m",
            "mill.toml",
            "--measured",
            "log.csv",
            "--summary",
            "found.json",
        ];
        post_in(self.0.path(), &[&arguments, more].concat())
    }

    /// The same; it must succeed. What was said, and the summary.
    #[track_caller]
    fn found(&self, more: &[&str]) -> (Run, Value) {
        let run = self.run(more);
        assert_eq!(run.code, 0, "{}", run.err);
        let found = read_json(&self.path("found.json"));
        (run, found)
    }
}

/// A log of the machine as its file has it.
fn recorded(change: impl Fn(&mut Recorder)) -> (Recorder, String) {
    let course = Course::new();
    let run = plant::Run::of(&course, plant::AS_FILED);
    let mut recorder = Recorder::plain(course.seconds);
    change(&mut recorder);
    let log = recorder.log(&run);
    (recorder, log)
}

/// Of an axis in the summary.
#[track_caller]
fn axis<'v>(found: &'v Value, name: &str) -> &'v Value {
    let mut axes = found["measured"]["axes"].as_array().unwrap().iter();
    axes.find(|axis| axis["name"] == name).unwrap()
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[track_caller]
fn close(value: &Value, wanted: f64, within: f64) {
    let value = number(value);
    assert!((value - wanted).abs() <= within, "{value} is not {wanted} ± {within}");
}
