//! What a posted program says once and stands on: each such word left out, and found by `verify --posted`.

use std::fs;

use crate::common::{Run, post, post_in};

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
    job: Vec<&'static str>,
    text: String,
}

impl PostedJob {
    fn new(machine: &'static str, dialect: &'static str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut job = vec!["-m", machine, "--tool-length", "100", "--dialect", dialect];
        if machine != "vmc" {
            job.extend(["--tcp", "control"]);
        }
        let posted = Self { folder, job: job.clone(), text: String::new() };
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
        let end = if words.starts_with(' ') && words.ends_with('\n') { "\n" } else { "" };
        let changed = format!("{}{end}{}", &self.text[..at], &self.text[at + words.len()..]);
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
        ("ac-trunnion", "heidenhain", " L A+0.000 C+0.000 R0 FMAX\n", "C"),
        ("umc-750", "haas", "G0 B0.000 C0.000\n", "B, C"),
        ("umc-750", "haas", " C0.000", "C"),
    ] {
        let posted = PostedJob::new(machine, dialect);
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
        ("vmc", "siemens", " G0 X0.000 Y0.000\n"),
        ("ac-trunnion", "fanuc", "G0 X0.000 Y0.000\n"),
        ("ac-trunnion", "heidenhain", " L X+0.000 Y+0.000 R0 FMAX\n"),
    ] {
        PostedJob::new(machine, dialect).left_out(words, 1, down);
    }
    // A hole where nobody knows is no hole of the CL file.
    let posted = PostedJob::new("vmc", "fanuc");
    let bare = posted.text.replacen("G0 X0.000 Y0.000\n", "G0 X0.000\n", 1);
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
        ("vmc", "heidenhain", " M3\n", " M8\n"),
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
    siemens.left_out(" M30\n", 1, endless);
    let heidenhain = PostedJob::new("ac-trunnion", "heidenhain");
    heidenhain.left_out(" PLANE RESET STAY\n", 1, &format!("{unset} tilted planes off"));
    heidenhain.left_out(" PLANE RESET STAY\n", 2, in_force);
    // One of another hand may have it said elsewhere.
    let other = fanuc.verify(&fanuc.text.replacen(" G40", "", 1), &[]);
    assert_eq!((other.code, other.err.contains("nc-modes")), (0, false), "{}", other.err);
}

/// The stop between two tools that the machine file writes is no fault of the program, and one of another kind is.
#[test]
fn stops_of_the_users_own_lines_may_come_besides() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [cl, machine, nc] = ["part.cls", "own.toml", "part.nc"].map(path);
    let other = JOB.replace("T1", "T2").replace("TOOL,1,ADJUST,1", "TOOL,2,ADJUST,2");
    fs::write(&cl, JOB.replace("FINI\n", "") + &other).unwrap();
    fs::write(&machine, "extends = \"vmc\"\n[program]\nbetween_tools = \"M1\"\n").unwrap();
    let job = ["-m", &machine, "--tool-length", "100"];
    let run = post(&[&["-q", "--verify", "-o", &nc, &cl][..], &job].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = fs::read_to_string(&nc).unwrap();
    assert!(text.contains("\nM1\n"), "{text}");
    fs::write(&nc, text.replace("\nM1\n", "\nM0\n")).unwrap();
    let run = post(&[&["verify", "-q", &nc, "--against", &cl][..], &job].concat());
    assert!(run.code == 1 && run.err.contains("a stop that the CL file"), "{}", run.err);
}

/// A program that was renamed and moved to where the machine reads it still finds its job, and in it the program that it is.
#[test]
fn a_program_that_was_moved_and_renamed_finds_its_job() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("one.cls"), JOB).unwrap();
    fs::write(path("two.cls"), JOB.replace("GOTO/10,40,20", "GOTO/12,40,20")).unwrap();
    let job = "machine = \"vmc\"\ntool_length = 100\n[[program]]\ncl = \"one.cls\"\n[[program]]\ncl = \"two.cls\"\n";
    fs::write(path("part.job.toml"), job).unwrap();
    assert_eq!(post_in(folder.path(), &["-q", "part.job.toml"]).code, 0);
    fs::create_dir_all(path("send/today")).unwrap();
    fs::rename(path("two.nc"), path("send/today/O4711.nc")).unwrap();
    let from = |folder: &std::path::Path, program: &str| {
        let run = post_in(folder, &["verify", "-q", program]);
        assert_eq!(run.code, 0, "{}", run.err);
    };
    from(folder.path(), "send/today/O4711.nc");
    from(&path("send/today"), "O4711.nc");
    // Elsewhere, with the job in the working directory.
    let other = tempfile::tempdir().unwrap();
    let away = other.path().join("O4711.nc");
    fs::rename(path("send/today/O4711.nc"), &away).unwrap();
    from(folder.path(), away.to_str().unwrap());
    let run = post_in(other.path(), &["verify", "-q", "O4711.nc"]);
    assert!(run.code == 1 && run.err.contains("error[job-file]"), "{}", run.err);
}
