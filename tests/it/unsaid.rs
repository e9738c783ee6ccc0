//! What a posted program says once and stands on: each such word left out, and found by `verify --posted`.

use std::fs;

use crate::common::{Run, post};

/// A hole at the origin, a stop, and a contour with cutter compensation.
const JOB: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,600,CLW
COOLNT/FLOOD
RAPID
GOTO/0,0,60,0,0,1
CYCLE/DRILL,RAPTO,3,FEDTO,-12,MMPM,120,RTRCTO,20
GOTO/0,0,0
GOTO/20,70,0
CYCLE/OFF
RAPID
GOTO/0,0,60
STOP
FEDRAT/MMPM,600
GOTO/0,0,20
GOTO/0,30,20
CUTCOM/LEFT
GOTO/0,40,20
GOTO/10,40,20
CUTCOM/OFF
GOTO/60,60,20
RAPID
GOTO/0,0,60
END-OF-PATH
FINI
";

/// A job that is posted on a machine in a dialect, its tool 100 mm long.
struct PostedJob {
    folder: tempfile::TempDir,
    job: [&'static str; 6],
    text: String,
}

impl PostedJob {
    fn new(machine: &'static str, dialect: &'static str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let job = ["-m", machine, "--tool-length", "100", "--dialect", dialect];
        let posted = Self { folder, job, text: String::new() };
        let (cl, nc) = (posted.path("part.cls"), posted.path("part.nc"));
        fs::write(&cl, JOB).unwrap();
        let run = post(&[&["-q", "--verify", "-o", &nc, &cl][..], &job].concat());
        assert_eq!(run.code, 0, "{machine} {dialect}: {}", run.err);
        Self { text: fs::read_to_string(&nc).unwrap(), ..posted }
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().to_owned()
    }

    fn verify(&self, text: &str, more: &[&str]) -> Run {
        let (cl, nc) = (self.path("part.cls"), self.path("changed.nc"));
        fs::write(&nc, text).unwrap();
        post(&[&["verify", "-q", &nc, "--against", &cl][..], &self.job, more].concat())
    }

    /// The `place`-th occurrence of `words`, from 1, left out: the message is told of the program that was posted.
    fn left_out(&self, words: &str, place: usize, message: &str) -> Run {
        let found = self.text.match_indices(words).nth(place - 1);
        let (at, _) = found.unwrap_or_else(|| panic!("{words} in\n{}", self.text));
        let changed = format!("{}{}", &self.text[..at], &self.text[at + words.len()..]);
        let own = self.verify(&changed, &["--posted"]);
        let told = own.code == 1 && own.err.contains(message);
        assert!(told, "{:?} without {words}: {}\n{changed}", self.job, own.err);
        self.verify(&changed, &[])
    }
}

/// Nobody knows where a rotary axis stands that no word turns: in a program of ours an error, in that of others a warning.
#[test]
fn rotary_axes_that_no_word_turns_stand_where_nobody_knows() {
    let missing = "[missing]: the program cuts before it says where";
    for (machine, dialect, words, axes) in [
        ("ac-trunnion", "fanuc", "G0 A0.000 C0.000\n", "C"),
        ("ac-trunnion", "siemens", " A=DC(0.000) C=DC(0.000)", "A, C"),
        ("ac-trunnion", "heidenhain", "L A+0.000 C+0.000 R0 FMAX\n", "C"),
        ("umc-750", "haas", "G0 B0.000 C0.000\n", "B, C"),
        ("umc-750", "haas", " C0.000", "C"),
    ] {
        let posted = PostedJob::new(machine, dialect);
        let words = match posted.text.contains(words) {
            true => words,
            false => "G0 A0.000 C0.000\n",
        };
        let other = posted.left_out(words, 1, &format!("error{missing} {axes} stands"));
        assert!(other.err.contains(&format!("warning{missing}")), "{}", other.err);
    }
}

/// The hole is at X0 Y0, and so is what stands there when nothing was said.
#[test]
fn the_tool_comes_down_where_the_program_has_said() {
    let down = "error[missing]: the tool comes down before the program says where X, Y stands";
    for (machine, dialect, words) in [
        ("vmc", "fanuc", "G0 X0.000 Y0.000\n"),
        ("vmc", "siemens", "G0 X0.000 Y0.000\n"),
        ("ac-trunnion", "fanuc", "G0 X0.000 Y0.000\n"),
        ("ac-trunnion", "heidenhain", "L X+0.000 Y+0.000 R0 FMAX\n"),
    ] {
        PostedJob::new(machine, dialect).left_out(words, 1, down);
    }
    // A hole where nobody knows is no hole of the CL file.
    let posted = PostedJob::new("vmc", "fanuc");
    let bare = posted.text.replacen("G0 X0.000 Y0.000\n", "G0\n", 1);
    let bare = bare.replacen("G81 X0.000 Y0.000 ", "G81 X0.000 ", 1);
    let run = posted.verify(&bare, &[]);
    assert!(run.err.contains("the program cuts before it says where Y stands"), "{}", run.err);
}

/// A stop switches spindle and coolant off on these controls, and both must be on again before the next cut.
#[test]
fn a_cut_behind_a_stop_has_its_spindle_and_coolant_on_again() {
    for (machine, dialect, spindle, coolant) in [
        ("vmc", "fanuc", "S600 M3\n", "M8\n"),
        ("vmc", "haas", "S600 M3\n", "M8\n"),
        ("vmc", "heidenhain", "M3\n", "M8\n"),
    ] {
        let posted = PostedJob::new(machine, dialect);
        for (words, code, what) in
            [(spindle, "spindle", "the spindle"), (coolant, "coolant", "the coolant")]
        {
            let told = format!("which switches {what} off, and no word switches it on again");
            let other = posted.left_out(words, 2, &format!("error[{code}]: cuts behind the stop"));
            assert!(other.code == 0 && other.err.contains(&told), "{}", other.err);
        }
    }
    // M0 of these leaves both on.
    for dialect in ["siemens", "linuxcnc"] {
        let posted = PostedJob::new("vmc", dialect);
        let own = posted.verify(&posted.text, &["--posted"]);
        assert!(own.code == 0 && !own.err.contains("behind the stop"), "{}", own.err);
    }
}

/// What ends a mode, and what ends the program.
#[test]
fn what_ends_modes_and_the_program_is_not_left_out() {
    let unset = "error[nc-modes]: the program does not set";
    let in_force = "error[nc-modes]: the program ends with a tilted plane in force";
    let endless = "error[missing]: no word of the program ends it";
    let cycle = "error[nc-modes]: a word of motion alone ends the cycle";
    let fanuc = PostedJob::new("ac-trunnion", "fanuc");
    fanuc.left_out(" G40", 1, &format!("{unset} radius compensation off (G40)"));
    fanuc.left_out(" G80", 1, &format!("{unset} cycles off (G80)"));
    fanuc.left_out("G69\n", 1, &format!("{unset} tilted planes off (G69)"));
    fanuc.left_out("G69\n", 2, in_force);
    fanuc.left_out("G80\n", 1, cycle);
    fanuc.left_out("M30\n", 1, endless);
    let haas = PostedJob::new("umc-750", "haas");
    haas.left_out("G255\n", 1, in_force);
    haas.left_out("M30\n", 1, endless);
    let siemens = PostedJob::new("vmc", "siemens");
    siemens.left_out(" G40", 1, &format!("{unset} radius compensation off (G40)"));
    siemens.left_out("M30", 1, endless);
    let heidenhain = PostedJob::new("ac-trunnion", "heidenhain");
    heidenhain.left_out("PLANE RESET STAY\n", 1, &format!("{unset} tilted planes off"));
    heidenhain.left_out("PLANE RESET STAY\n", 2, in_force);
    // One of another hand may have it said elsewhere.
    let other = fanuc.verify(&fanuc.text.replacen(" G40", "", 1), &[]);
    assert_eq!((other.code, other.err.contains("nc-modes")), (0, false), "{}", other.err);
}
