//! Programs that crash or spoil: posted, changed as a hand or another post would, and held against their CL file. Each
//! unchanged one is right; of each changed one the fault is named.

use std::fs;

use crate::common::post;

/// Taps between drilling and reaming, at 600/min.
const HOLES: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,600,CLW
RAPID
GOTO/0,0,60,0,0,1
CYCLE/TAP,RAPTO,3,FEDTO,-12,MMPR,1.25,RTRCTO,20
GOTO/0,70,0
GOTO/20,70,0
CYCLE/OFF
CYCLE/REAM,RAPTO,3,FEDTO,-12,MMPM,120
GOTO/0,80,0
GOTO/20,80,0
CYCLE/OFF
CYCLE/DRILL,RAPTO,3,FEDTO,-12,MMPM,120,RTRCTO,25,DWELL,0.5
GOTO/0,90,0
GOTO/40,90,0
CYCLE/OFF
RAPID
GOTO/0,0,60
END-OF-PATH
FINI
";

/// A contour with cutter compensation, the register that of the tool.
const CONTOUR: &str = "\
TOOL PATH/A,TOOL,T5
LOAD/TOOL,5,ADJUST,5
SPINDL/RPM,3000,CLW
RAPID
GOTO/-20,-20,60,0,0,1
RAPID
GOTO/-20,-20,2
FEDRAT/MMPM,600
GOTO/-20,-20,-5
CUTCOM/LEFT
GOTO/0,0,-5
GOTO/0,40,-5
GOTO/40,40,-5
CUTCOM/OFF
GOTO/60,60,-5
RAPID
GOTO/60,60,60
END-OF-PATH
FINI
";

/// The same tool turns the other way and faster in the second operation.
const REVERSED: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,3000,CCLW
RAPID
GOTO/0,0,60,0,0,1
FEDRAT/MMPM,600
GOTO/0,0,20
GOTO/10,0,20
RAPID
GOTO/10,0,60
END-OF-PATH
TOOL PATH/B,TOOL,T1
SPINDL/RPM,7500,CLW
RAPID
GOTO/0,0,60
FEDRAT/MMPM,600
GOTO/0,0,20
GOTO/10,5,20
RAPID
GOTO/10,0,60
END-OF-PATH
FINI
";

/// What changes in a program: every occurrence of the first text becomes the second.
type Change<'a> = (&'a str, &'a str);

/// A job on a machine of the library in one of its dialects.
struct Posted {
    folder: tempfile::TempDir,
    machine: &'static str,
    dialect: &'static str,
    text: String,
}

impl Posted {
    /// On the `vmc`.
    fn new(cl: &str, dialect: &'static str) -> Self {
        Self::on("vmc", cl, dialect)
    }

    fn on(machine: &'static str, cl: &str, dialect: &'static str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let posted = Self { folder, machine, dialect, text: String::new() };
        fs::write(posted.path("part.cls"), cl).unwrap();
        let (cl, nc) = (posted.path("part.cls"), posted.path("part.nc"));
        let job = posted.job();
        let run = post(&[&["-q", "--verify", "-o", &nc, &cl][..], &job].concat());
        assert_eq!(run.code, 0, "{dialect}: {}", run.err);
        let text = fs::read_to_string(&nc).unwrap();
        Self { text, ..posted }
    }

    fn job(&self) -> [&'static str; 6] {
        // The router has 80 mm of Z.
        let length = if self.machine == "grbl-router" { "20" } else { "100" };
        ["-m", self.machine, "--tool-length", length, "--dialect", self.dialect]
    }

    fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().to_owned()
    }

    fn verify(&self, text: &str, more: &[&str]) -> crate::common::Run {
        let (cl, nc) = (self.path("part.cls"), self.path("changed.nc"));
        fs::write(&nc, text).unwrap();
        let job = self.job();
        post(&[&["verify", "-q", &nc, "--against", &cl][..], &job, more].concat())
    }

    /// The unchanged program is right; with the change the message is told, as an error or as a warning.
    fn told(&self, (from, to): Change<'_>, message: &str) {
        let right = self.verify(&self.text, &[]);
        assert_eq!(right.code, 0, "{}: {}", self.dialect, right.err);
        assert!(!right.err.contains(message), "{}", right.err);
        assert!(self.text.contains(from), "{from} in\n{}", self.text);
        let changed = self.verify(&self.text.replace(from, to), &[]);
        assert!(
            changed.err.contains(message),
            "{} {from} -> {to}: {}\n{}",
            self.dialect,
            changed.err,
            self.text
        );
        let error = message.starts_with("error");
        assert_eq!(changed.code, i32::from(error), "{from} -> {to}");
    }
}

/// Behind M29 and G84 the spindle stands until S and M3: without them the reamer is pushed in as it stands.
#[test]
fn the_spindle_stands_behind_a_rigid_tap() {
    let fanuc = Posted::new(HOLES, "fanuc");
    let (tap, rest) = fanuc.text.split_once("M29 S600\n").unwrap();
    let again = rest.replacen("S600 M3\n", "", 1);
    assert_ne!(again, rest);
    let changed = fanuc.verify(&format!("{tap}M29 S600\n{again}"), &[]);
    assert!(changed.err.contains("error[spindle]: the spindle stands in a cut"), "{}", changed.err);
    // By a chuck that gives way the control turns it again itself.
    let floating = again.replace("M3 S600", "");
    let changed = fanuc.verify(&format!("{tap}{floating}"), &[]);
    assert_eq!(changed.code, 0, "{}", changed.err);
}

/// SDAC, the seventh argument of CYCLE84: 3 clockwise, 4 counter-clockwise, 5 stands.
#[test]
fn behind_a_thread_the_spindle_does_what_its_cycle_says() {
    let siemens = Posted::new(HOLES, "siemens");
    let of = |sdac: &str| format!("CYCLE84(20,0,3,-12,,0,{sdac},");
    let turns = "error[spindle]: the spindle turns counter-clockwise at 600/min in a cut";
    siemens.told((&of("3"), &of("4")), turns);
    let stands = "error[spindle]: the spindle stands in a cut";
    siemens.told((&of("3"), &of("5")), stands);
    siemens.told((&of("3"), &of("")), stands);
}

#[test]
fn the_feed_out_of_a_reamed_hole_is_that_of_the_cl_file() {
    let fast = "error[feed]: the feed is above that of the CL file, 120 mm/min: 1200.0 mm/min";
    let siemens = Posted::new(HOLES, "siemens");
    siemens.told((",0,120,120)", ",0,120,1200)"), fast);
    let heidenhain = Posted::new(HOLES, "heidenhain");
    heidenhain.told(("Q208=+120 ", "Q208=+1200 "), fast);
}

#[test]
fn a_hole_is_made_once() {
    let fanuc = Posted::new(HOLES, "fanuc");
    let once = "error[hole]: a hole is made once more";
    fanuc.told(("\nX40.000\n", "\nX40.000\nX40.000\n"), once);
    let siemens = Posted::new(HOLES, "siemens");
    let second = siemens.text.rmatches("X20.000 Y80.000\n").next().unwrap();
    siemens.told((second, &second.repeat(2)), once);
}

/// P beside G81 says nothing: the hole has no wait at its bottom.
#[test]
fn a_drilling_cycle_without_a_wait_does_not_wait() {
    let fanuc = Posted::new(HOLES, "fanuc");
    fanuc.told(
        ("G82 ", "G81 "),
        "error[event]: a dwell of 0.5 s at the bottom of a hole is left out",
    );
}

#[test]
fn a_contour_has_its_radius_register() {
    let fanuc = Posted::new(CONTOUR, "fanuc");
    let none = "error[register]: cuts with radius compensation and no radius register, and the CL file asks for 5";
    fanuc.told(("G41 D5", "G41"), none);
    // LinuxCNC takes the radius of the tool in the spindle.
    let linuxcnc = Posted::new(CONTOUR, "linuxcnc");
    let changed = linuxcnc.verify(&linuxcnc.text.replace("G41 D5", "G41"), &[]);
    assert_eq!(changed.code, 0, "{}", changed.err);
}

/// Where the CL file names no work offset, that of the machine file's dialect is meant.
#[test]
fn the_work_offset_is_that_of_the_machine_file() {
    let wrong = |name: &str, meant: &str| {
        format!(
            "error[work-offset]: cuts in {name}: the CL file names no work offset, and that of the machine file is {meant}"
        )
    };
    let changes = [
        ("fanuc", "G54\n", "G55\n", "G55", "G54"),
        ("haas", "G54\n", "G154 P5\n", "G154 P5", "G54"),
        ("siemens", "G54\n", "G500\n", "G500", "G54"),
        ("heidenhain", "Q339=+1 ", "Q339=+2 ", "CYCL DEF 247 Q339=2", "CYCL DEF 247 Q339=1"),
    ];
    for (dialect, from, to, name, meant) in changes {
        let posted = Posted::new(CONTOUR, dialect);
        posted.told((from, to), &wrong(name, meant));
        let changed = posted.text.replace(from, to);
        let ignored = posted.verify(&changed, &["--ignore", "work-offset"]);
        assert_eq!(ignored.code, 0, "{dialect}: {}", ignored.err);
    }
    let fanuc = Posted::new(CONTOUR, "fanuc");
    fanuc.told(("G54\n", ""), "error[work-offset]: cuts in no work offset that the program names");
    let of_option = fanuc
        .verify(&fanuc.text.replace("G54\n", "G55\n"), &["--set", "control.fanuc.work_offset=G55"]);
    assert_eq!(of_option.code, 0, "{}", of_option.err);
}

/// A CL file that names its work offsets is kept to, by all names that a control has for them.
#[test]
fn the_work_offset_that_the_cl_file_names_is_kept_to() {
    let named = CONTOUR.replace("RAPID\nGOTO/-20,-20,60", "SET/OFSETL,2\nRAPID\nGOTO/-20,-20,60");
    for (dialect, from, to) in [("fanuc", "G55\n", "G54.1 P2\n"), ("siemens", "G55\n", "G500\n")] {
        let posted = Posted::new(&named, dialect);
        posted.told((from, to), "error[work-offset]: cuts in");
    }
}

#[test]
fn smoothing_beyond_the_tolerance_is_told() {
    let siemens = Posted::new(CONTOUR, "siemens");
    let more =
        "warning[smoothing]: the control may leave the path by 1 mm, and the tolerance is 0.005 mm";
    siemens.told(("G54\n", "G54\nCYCLE832(1,3,1)\n"), more);
    let linuxcnc = Posted::new(CONTOUR, "linuxcnc");
    let text = linuxcnc.text.replacen("G61\n", "G64 P1\n", 1);
    assert_ne!(text, linuxcnc.text);
    let changed = linuxcnc.verify(&text, &[]);
    assert!(changed.err.contains(more), "{}", changed.err);
    let any = "warning[smoothing]: the control may leave the path by any distance, and the tolerance is 0.005 mm";
    // There P0 is no tolerance, and Q merges points by as much as it says.
    linuxcnc.told(("G61\n", "G64\n"), any);
    linuxcnc.told(("G61\n", "G64 P0\n"), any);
    linuxcnc.told(("G61\n", "G64 P0.001 Q1\n"), more);
    for words in ["G641 ADIS=1", "G641\nADIS=1", "G642 CTOL=1", "G645 CTOL=1"] {
        siemens.told(("G54\n", &format!("G54\n{words}\n")), more);
    }
    // Nothing is rounded within no distance, and ADIS says nothing of G642, which goes by data of the axes then.
    let none = siemens.verify(&siemens.text.replacen("G54\n", "G54\nG641\n", 1), &[]);
    assert!(!none.err.contains("smoothing"), "{}", none.err);
    let own = "warning[smoothing]: the control may leave the path by as much as its parameters say, and the tolerance is 0.005 mm";
    siemens.told(("G54\n", "G54\nG642 ADIS=1\n"), own);
    // OTOL is degrees of the tool axis, under what goes by tolerances.
    let turned = "the control may turn the tool axis off by 5°, and the tolerance is 0.05°";
    let five = Posted::on("ac-trunnion-840d", CORNER, "siemens");
    for words in [
        "G642 OTOL=5",
        "COMPCAD CTOL=0.001\nOTOL=5",
        "CYCLE832(0.001,11,5)",
        "CYCLE832(0.001,_ORI_FINISH,5)",
    ] {
        five.told(("G54\n", &format!("G54\n{words}\n")), turned);
    }
    for words in ["OTOL=5", "G641 OTOL=5", "COMPCAD OTOL=5\nCOMPOF", "CYCLE832(0.001,1,5)"] {
        let text = five.text.replacen("G54\n", &format!("G54\n{words}\n"), 1);
        let changed = five.verify(&text, &[]);
        assert!(!changed.err.contains("smoothing"), "{words}: {}", changed.err);
    }
    let heidenhain = Posted::on("dmu50", CORNER, "heidenhain");
    let cycle =
        "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.001\nCYCL DEF 32.2 HSC-MODE:0 TA5\nM127\n";
    heidenhain.told((" M127\n", &format!(" {cycle}")), turned);
    let fagor = Posted::new(CONTOUR, "fagor");
    fagor.told(("G54\n", "G54\n#HSC ON [CONTERROR 1]\n"), more);
    let haas = Posted::new(CONTOUR, "haas");
    haas.told(("G54\n", "G54\nG187 E1.\n"), more);
}

/// Between two cuts the tool goes up, and across there.
const UP_AND_ACROSS: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,0,60,0,0,1
RAPID
GOTO/0,0,5
FEDRAT/MMPM,600
GOTO/0,0,-2
GOTO/20,0,-2
RAPID
GOTO/20,0,55
RAPID
GOTO/-20,-20,55
GOTO/-20,-20,0
RAPID
GOTO/-20,-20,60
END-OF-PATH
FINI
";

/// The retract's Z belongs to another code of the block, and the tool stays down.
#[test]
fn words_of_axes_that_a_code_has_for_itself_move_nothing() {
    let own = [
        ("fanuc", "G50.1"),
        ("fanuc", "G22"),
        ("fanuc", "G5.1 Q1"),
        ("mazak", "G50.1"),
        ("mitsubishi", "G22"),
        ("syntec", "G50.1"),
        ("haas", "G100"),
    ];
    for (dialect, code) in own {
        let posted = Posted::new(UP_AND_ACROSS, dialect);
        posted.told(("G0 Z55.000", &format!("G0 {code} Z55.000")), "error[rapid]");
        // Where they stand for what they are, nothing is wrong.
        let text = posted.text.replacen("G0 Z55.000", &format!("{code} Z0.\nG0 Z55.000"), 1);
        let right = posted.verify(&text, &[]);
        assert_eq!(right.code, 0, "{dialect} {code}: {}", right.err);
    }
    let fanuc = Posted::new(UP_AND_ACROSS, "fanuc");
    for code in ["G23", "G50", "G13.1", "G8 P1", "G92 S3000"] {
        let text = fanuc.text.replacen("G0 Z55.000", &format!("G0 {code} Z55.000"), 1);
        let refused = fanuc.verify(&text, &[]);
        assert!(refused.err.contains("error[nc-word]"), "{code}: {}", refused.err);
    }
    let text = fanuc.text.replacen("G0 Z55.000", "G28 G50.1 Z55.000", 1);
    let refused = fanuc.verify(&text, &[]);
    assert!(refused.err.contains("have the words of axes for themselves"), "{}", refused.err);
    let area = "G22 X500. Y500. Z500. I-500. J-500. K-500.\nG23\nG54";
    let right = fanuc.verify(&fanuc.text.replacen("G54", area, 1), &[]);
    assert_eq!(right.code, 0, "{}", right.err);
}

/// Without a changer the operator changes at M0, beside T or in the block behind it.
#[test]
fn the_stop_behind_t_changes_the_tool() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [cl, nc] = ["part.cls", "part.nc"].map(path);
    let text = UP_AND_ACROSS.replace("END-OF-PATH\nFINI\n", "");
    fs::write(
        &cl,
        text.clone()
            + "END-OF-PATH\n"
            + &text.replace("T1", "T2").replace("TOOL,1,ADJUST,1", "TOOL,2,ADJUST,2")
            + "END-OF-PATH\nFINI\n",
    )
    .unwrap();
    let job = ["-m", "grbl-router", "--tool-length", "50"];
    let run = post(&[&["-q", "--verify", "-o", &nc, &cl][..], &job].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = fs::read_to_string(&nc).unwrap();
    let verify = |text: String| {
        fs::write(&nc, text).unwrap();
        post(&[&["verify", "-q", &nc, "--against", &cl][..], &job].concat())
    };
    assert!(text.contains("T2 M0\n"), "{text}");
    let behind = verify(text.replace("T2 M0\n", "T2\nM0\n"));
    assert_eq!(behind.code, 0, "{}", behind.err);
    let other = verify(text.replace("T2 M0\n", "T1\nM0\n"));
    assert!(other.err.contains("error[tool]"), "{}", other.err);
    let stop = verify(text.replacen("G0 Z55.000\n", "G0 Z55.000\nM0\n", 1));
    assert!(stop.err.contains("error[event]: a stop"), "{}", stop.err);
}

/// The tip goes slowly while the table swings, so that F by time is a small number, but no rounded one.
#[test]
fn a_wrong_feed_by_time_is_no_rounded_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [cl, nc] = ["part.cls", "part.nc"].map(path);
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,4000,CLW\nRAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,0.5\nGOTO/0,0,5\n\
        GOTO/0,4,5,0,0.5,0.8660254\nGOTO/0,8,5,0,0.7071068,0.7071068\nRAPID\nGOTO/0,40,60\nFINI\n";
    fs::write(&cl, text).unwrap();
    let job = ["-m", "ac-trunnion", "--tool-length", "100", "--set", "control.tcp=post"];
    let run = post(&[&["-q", "--verify", "-o", &nc, &cl][..], &job].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = fs::read_to_string(&nc).unwrap();
    for factor in [0.1, 0.5, 1.5, 1.9] {
        let changed = with_times(&text, factor);
        assert_ne!(changed, text);
        fs::write(&nc, &changed).unwrap();
        let run = post(&[&["verify", "-q", &nc, "--against", &cl][..], &job].concat());
        assert!(run.code == 1 && run.err.contains("error[feed]"), "{factor}: {}", run.err);
    }
}

/// The blocks of a program whose feeds are times, as many times as fast.
fn with_times(text: &str, factor: f64) -> String {
    let mut by_time = false;
    text.lines()
        .map(|line| {
            by_time = (by_time || line.contains("G93")) && !line.contains("G94");
            match line.rsplit_once('F').filter(|_| by_time) {
                Some((words, feed)) => {
                    let feed: f64 = feed.parse().unwrap();
                    format!("{words}F{:.3}\n", factor * feed)
                }
                None => format!("{line}\n"),
            }
        })
        .collect()
}

/// Rounded words make up to a seventh of the way of a block of 0.02 mm, and nothing of that of a thousand; where axes turn
/// each may be slower by the tolerance besides.
#[test]
fn feeds_of_short_blocks_are_compared_together() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [cl, nc] = ["part.cls", "part.nc"].map(path);
    let mut text = "LOADTL/1\nSPINDL/4000\nRAPID\nGOTO/20,0,50,0,0,1\nFEDRAT/80,MMPM\n".to_owned();
    for point in 0..3000 {
        let turn = 0.001 * f64::from(point);
        let [sine, cosine] = [libm::sin(turn), libm::cos(turn)];
        let lean = 0.35 + 0.05 * libm::sin(0.7 * turn);
        let aside = libm::sin(lean);
        let axis = [aside * cosine, aside * sine, libm::cos(lean)];
        let tip = [20.0 * cosine, 20.0 * sine, 0.3 * turn];
        let words = tip.iter().chain(&axis).map(|value| format!("{value:.7}"));
        text.push_str(&format!("GOTO/{}\n", words.collect::<Vec<_>>().join(",")));
    }
    fs::write(&cl, text + "FINI\n").unwrap();
    let job = ["-m", "ac-trunnion", "--tool-length", "100", "--set", "control.tcp=post"];
    let run = post(&[&["-q", "--verify", "-o", &nc, &cl][..], &job].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = fs::read_to_string(&nc).unwrap();
    for factor in [1.0, 0.6, 1.05, 1.3] {
        let changed = with_times(&text, factor);
        fs::write(&nc, &changed).unwrap();
        let run = post(&[&["verify", "-q", &nc, "--against", &cl][..], &job].concat());
        let told = run.err.contains("taken together");
        assert_eq!(told, factor != 1.0, "{factor}: {}", run.err);
    }
}

/// `S7500` turns the spindle as it turned before until the block behind it says how: nothing has moved in between.
#[test]
fn a_spindle_that_is_reversed_at_another_speed_is_right() {
    for dialect in ["fanuc", "siemens", "heidenhain"] {
        let posted = Posted::new(REVERSED, dialect);
        let right = posted.verify(&posted.text, &[]);
        assert_eq!(right.code, 0, "{dialect}: {}", right.err);
    }
    let fanuc = Posted::new(REVERSED, "fanuc");
    let burst = fanuc.text.replace("S7500 M3", "S30000 M3\nS7500 M3");
    assert_ne!(burst, fanuc.text);
    let changed = fanuc.verify(&burst, &[]);
    assert!(changed.err.contains("at 30000/min with this tool"), "{}", changed.err);
}

/// A slot, then holes behind it.
const SLOT: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,0,60,0,0,1
RAPID
GOTO/0,0,2
FEDRAT/MMPM,600
GOTO/0,0,-5
GOTO/40,0,-5
CYCLE/DRILL,RAPTO,3,FEDTO,-8,MMPM,200
GOTO/0,50,0
GOTO/20,50,0
CYCLE/OFF
RAPID
GOTO/0,0,70
END-OF-PATH
FINI
";

/// Up first, then across: neither from a slot to the first hole at its depth, nor from hole to hole below the level of
/// return, where clamps are.
#[test]
fn no_rapid_goes_across_to_a_hole_lower_than_the_cl_file() {
    let low = |by: &str| {
        format!("error[rapid]: a rapid goes to the next hole {by} mm lower than the CL file's")
    };
    let slot = Posted::new(SLOT, "fanuc");
    slot.told(("G0 Z3.000\nX0.000", "G0 X0.000"), &low("8.000"));
    let clamped = SLOT.replace("MMPM,200", "MMPM,200,RTRCTO,30");
    let fanuc = Posted::new(&clamped, "fanuc");
    fanuc.told(("G98 ", "G99 "), &low("27.000"));
    let siemens = Posted::new(&clamped, "siemens");
    siemens.told(("CYCLE81(30,", "CYCLE81(3,"), &low("27.000"));
    let heidenhain = Posted::new(&clamped, "heidenhain");
    heidenhain.told(("Q204=+30 ", "Q204=+3 "), &low("27.000"));
}

/// Where the machine has its axes before the program says it is not known: without its first X and Y it cuts anywhere.
#[test]
fn the_place_at_the_start_is_not_known() {
    let unsaid = "error[missing]: the program cuts before it says where X, Y stands";
    for (dialect, first) in [("fanuc", "G0 X0.000 Y0.000\nG43"), ("haas", "G0 X0.000 Y0.000\nG43")]
    {
        let slot = Posted::new(SLOT, dialect);
        slot.told((first, "G43"), unsaid);
    }
    let heidenhain = Posted::new(SLOT, "heidenhain");
    heidenhain.told(("L X+0.000 Y+0.000 R0 FMAX\n", "L R0 FMAX\n"), unsaid);
}

/// The tool dives through the part while the table turns beneath it.
#[test]
fn a_rapid_that_turns_an_axis_goes_no_deeper_than_the_cl_file() {
    let cl = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,8000,CLW
RAPID
GOTO/0,0,70,0,0,1
RAPID
GOTO/0,0,30,0,0,1
FEDRAT/MMPM,800
GOTO/5,0,25,0.1,0,0.994987
GOTO/15,5,25,0.3,0.1,0.948683
RAPID
GOTO/30,8,60,0.3,0.1,0.948683
END-OF-PATH
FINI
";
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (cl_file, nc) = (path("part.cls"), path("part.nc"));
    fs::write(&cl_file, cl).unwrap();
    let job = ["-m", "ac-trunnion", "--tool-length", "100", "--set", "control.tcp=control"];
    let run = post(&[&["-q", "-o", &nc, &cl_file][..], &job].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = fs::read_to_string(&nc).unwrap();
    let verify = |text: &str| {
        fs::write(&nc, text).unwrap();
        post(&[&["verify", "-q", &nc, "--against", &cl_file][..], &job].concat())
    };
    let right = verify(&text);
    assert_eq!(right.code, 0, "{}", right.err);
    let lines: Vec<&str> = text.lines().collect();
    let first_cut = lines.iter().position(|line| line.contains("G1 ")).unwrap();
    let mut dives = lines.clone();
    dives.splice(first_cut..first_cut, ["X-8. Y-8. Z-30. C270.", "X0. Y0. Z30. C0."]);
    let wrong = verify(&(dives.join("\n") + "\n"));
    assert!(wrong.err.contains("error[rapid]"), "{}\n{}", wrong.err, dives.join("\n"));
}

/// A slot, a stop, a tool change and a tap, then a wait with the part done.
const STOPPED: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,500
GOTO/0,0,5
GOTO/50,0,5
RAPID
GOTO/50,0,50
STOP
LOAD/TOOL,2,ADJUST,2
SPINDL/RPM,500,CLW
RAPID
GOTO/0,50,50
OPSTOP
CYCLE/TAP,RAPTO,5,FEDTO,-15,MMPM,500
GOTO/0,50,0
CYCLE/OFF
DELAY/2
RAPID
GOTO/0,0,70
END-OF-PATH
FINI
";

/// The chips are to be blown out before the tap goes in, and the operator is not there any more: no cut follows a stop
/// before a hole, nor a wait at the end.
#[test]
fn a_stop_before_a_hole_and_a_wait_at_the_end_are_not_left_out() {
    let words = [
        ("fanuc", "\nM0\n", "\nM1\n", "\nG4 P2000\n"),
        ("siemens", " M0\n", " M1\n", " G4 F2.000\n"),
        ("heidenhain", " M0\n", " M1\n", "CYCL DEF 9.0 DWELL TIME\n38 CYCL DEF 9.1 DWELL 2.000\n"),
    ];
    for (dialect, stop, optional, wait) in words {
        let posted = Posted::new(STOPPED, dialect);
        // Across on the level of the retract: nothing comes near.
        let right = posted.verify(&posted.text, &["--posted"]);
        assert!(!right.err.contains("warning[rapid]"), "{dialect}: {}", right.err);
        posted.told((stop, "\n"), "error[event]: a stop is left out");
        posted.told((optional, "\n"), "error[event]: an optional stop is left out");
        posted.told((wait, "\n"), "error[event]: a dwell of 2 s is left out");
    }
}

/// Nothing is known of what ran before: modes that the program does not set, and a tool that stands in the part.
#[test]
fn a_program_says_what_it_stands_on() {
    let not_set = |what: &str| format!("[nc-modes]: the program does not set {what}");
    let cases = [
        ("fanuc", "G21\n", "units (G21, G20)"),
        ("fanuc", " G90", "absolute or incremental (G90, G91)"),
        ("fanuc", "G17 ", "plane (G17, G18, G19)"),
        ("siemens", " G710\n", "units"),
        ("siemens", " G90", "absolute or incremental (G90, G91)"),
    ];
    for (dialect, word, what) in cases {
        let posted = Posted::new(STOPPED, dialect);
        let end = if word.ends_with('\n') { "\n" } else { "" };
        posted.told((word, end), &format!("warning{}", not_set(what)));
        let own = posted.verify(&posted.text.replace(word, end), &["--posted"]);
        assert!(own.err.contains(&format!("error{}", not_set(what))), "{}", own.err);
        assert_eq!(own.code, 1);
    }
    for (dialect, retract) in [("fanuc", "G53 G0 Z20.000\n"), ("haas", "G53 G0 Z20.000\n")] {
        let posted = Posted::new(STOPPED, dialect);
        let changed = posted.text.replacen(retract, "", 1);
        assert_ne!(changed, posted.text);
        let own = posted.verify(&changed, &["--posted"]);
        let missing = "error[rapid]: Z is not retracted before the first tool change";
        assert!(own.err.contains(missing), "{dialect}: {}", own.err);
        let other = posted.verify(&changed, &[]);
        assert_eq!(other.code, 0, "a program of another hand: {}", other.err);
    }
}

/// A tap in a rigid holder, and the spindle not bound to the feed.
#[test]
fn a_rigid_tap_has_its_word() {
    let fanuc = Posted::new(STOPPED, "fanuc");
    let without = "[hole]: a hole is tapped without M29 ahead of the cycle";
    fanuc.told(("M29 S500\n", ""), &format!("warning{without}"));
    let changed = fanuc.text.replace("M29 S500\n", "");
    let own = fanuc.verify(&changed, &["--posted"]);
    assert!(own.code == 1 && own.err.contains(&format!("error{without}")), "{}", own.err);
    let floating = fanuc.verify(&changed, &["--posted", "--set", "control.fanuc.tapping=floating"]);
    assert_eq!(floating.code, 0, "{}", floating.err);
}

/// A later tool change without a retract, in a program that names the job that it was posted from.
#[test]
fn a_program_of_a_job_is_held_to_its_retracts() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [cl, job, nc] = ["part.cls", "part.job.toml", "part.nc"].map(path);
    fs::write(&cl, STOPPED).unwrap();
    fs::write(
        &job,
        "machine = \"vmc\"\ncl = \"part.cls\"\noutput = \"part.nc\"\ntool_length = 100\n",
    )
    .unwrap();
    assert_eq!(post(&["-q", &job]).code, 0);
    assert_eq!(post(&["verify", "-q", &nc]).code, 0);
    let text = fs::read_to_string(&nc).unwrap();
    let changed = text.replace("M0\nG53 G0 Z20.000\n", "M0\n");
    assert_ne!(changed, text);
    fs::write(&nc, changed).unwrap();
    let run = post(&["verify", "-q", &nc]);
    assert!(run.err.contains("short of its retract where the tool is changed"), "{}", run.err);
}

/// Another control's program is told once, and a name that was mistyped before what is missing besides.
#[test]
fn another_language_is_told_once() {
    let machines = [("fanuc", "heidenhain"), ("heidenhain", "fanuc"), ("fanuc", "siemens")];
    for (written, read) in
        machines.into_iter().chain([("siemens", "fanuc"), ("siemens", "heidenhain")])
    {
        let posted = Posted::new(STOPPED, written);
        let nc = posted.path("part.nc");
        let cl = posted.path("part.cls");
        for verb in [&["read", &nc][..], &["predict", &nc], &["verify", &nc, "--against", &cl]] {
            let run = post(&[verb, &["-m", "vmc", "--dialect", read]].concat());
            assert_eq!(run.code, 1, "{written} as {read}: {}", run.err);
            assert_eq!(run.err.matches("error[").count(), 1, "{written} as {read}: {}", run.err);
            assert!(run.err.contains("error[nc-language]: "), "{}", run.err);
        }
    }
    let run = post(&["verify", "nosuch.nc"]);
    assert!(run.code == 1 && run.err.contains("nosuch.nc"), "{}", run.err);
}

/// Right ones that were refused: a plan that comes to rest at the end of a cut by ways shorter than a rounding, and a first
/// retract that comes from where nobody knows.
#[test]
fn a_plan_that_comes_to_rest_and_a_first_retract_are_right() {
    let folder = tempfile::tempdir().unwrap();
    let nc = folder.path().join("part.nc");
    let nc = nc.to_str().unwrap();
    for job in [
        &[
            "-m",
            "xyzbc-trt",
            "--plan",
            "--tool-length",
            "60",
            "tests/it/wrong_programs/planned.cls",
        ][..],
        &["-m", "head-head", "--tool-length", "100", "tests/it/wrong_programs/heads.cls"],
    ] {
        let run = post(&[&["-q", "--verify", "-o", nc][..], job].concat());
        assert_eq!(run.code, 0, "{job:?}: {}", run.err);
    }
}

/// The cut that is made next is made at feed, though the rapid into it is taken back before.
#[test]
fn no_rapid_goes_along_a_cut_that_was_not_made() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/10,10,50\nRAPID\nGOTO/10,10,5\nFEDRAT/200,MMPM\n\
              GOTO/10,10,-3\nGOTO/40,30,-3\nRAPID\nGOTO/40,30,50\nRAPID\nGOTO/-20,30,50\nRAPID\nGOTO/-20,30,5\n\
              GOTO/-20,30,-3\nGOTO/-20,-30,-3\nRAPID\nGOTO/-20,-30,50\nFINI\n";
    let posted = Posted::new(&cl.replace("30,5\nGOTO", "30,5\nFEDRAT/200,MMPM\nGOTO"), "fanuc");
    posted.told(
        ("X-20.000\nZ5.000\n", "X-20.000\nZ5.000\nG0 Z-2.9\nZ5.000\n"),
        "error[rapid]: a rapid goes 7.9 mm along a cut that was not made yet",
    );
}

/// A rapid goes down aside of all places that are asked for, to where the last cut ended, and comes back.
#[test]
fn no_rapid_plunges_where_nothing_is_asked_for() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,0,50\nRAPID\nGOTO/20,0,5\nFEDRAT/200,MMPM\n\
              GOTO/20,0,-2\nGOTO/20,30,-2\nGOTO/-20,30,-2\nRAPID\nGOTO/-20,30,5\nRAPID\nGOTO/60,30,5\n\
              FEDRAT/200,MMPM\nGOTO/60,30,-2\nGOTO/80,30,-2\nRAPID\nGOTO/80,30,50\nFINI\n";
    let posted = Posted::new(cl, "fanuc");
    posted.told(
        ("G0 Z5.000\n", "G0 Z5.000\nX40.\nZ-2.\nZ5.\nX-20.\n"),
        "error[rapid]: a rapid takes Z 7.000 mm from all where the CL file and the machine file send it",
    );
}

/// A slot about a corner.
const CORNER: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,0,50\nFEDRAT/200,MMPM\nGOTO/20,0,-2\n\
                      GOTO/20,30,-2\nGOTO/-20,30,-2\nRAPID\nGOTO/-20,30,50\nFINI\n";

/// The tool that is in the spindle already is called and changed while it cuts.
#[test]
fn no_tool_is_changed_in_the_midst_of_a_cut() {
    let midst = "error[tool]: the tool is changed in the midst of a cut";
    let letters =
        ["fanuc", "haas", "hurco", "isg", "linuxcnc", "mazak", "mitsubishi", "siemens", "syntec"];
    let mut posted: Vec<(Posted, &[&str])> =
        letters.map(|dialect| (Posted::new(CORNER, dialect), &["T1 M6"][..])).into();
    posted
        .push((Posted::new(CORNER, "heidenhain"), &["TOOL CALL 1 Z S3000", "TOOL CALL 2 Z S3000"]));
    // The operator changes it at M0.
    posted.push((Posted::on("grbl-router", CORNER, "grbl"), &["T1\nM0", "T2\nM0", "T1 M0"]));
    posted.push((Posted::on("osp-mill", CORNER, "okuma"), &["T1 M6", "T1\nM6"]));
    for (posted, changes) in posted {
        let line =
            posted.text.lines().find(|line| line.replace('+', "").contains("Y30.000")).unwrap();
        for change in changes {
            posted.told((&format!("{line}\n"), &format!("{change}\n{line}\n")), midst);
        }
    }
}

/// What G53 leads to is a position of the machine, and Fanuc goes there at rapid.
#[test]
fn no_cut_goes_to_positions_of_the_machine() {
    let posted = Posted::new(CORNER, "fanuc");
    posted
        .told(("Y30.000\n", "G53 Y30.\n"), "error[work-offset]: cuts in positions of the machine");
}

/// A Siemens may name the spindle, and say a diameter or a radius in a word.
#[test]
fn spindles_by_number_and_diameters_in_a_word_are_read() {
    let posted = Posted::new(CORNER, "siemens");
    for (from, to) in [
        ("S3000 M3\n", "S1=3000 M1=3\n"),
        ("S3000 M3\n", "SETMS(1)\nS[1]=3000 M[1]=3\n"),
        ("M5\n", "M1=5\n"),
        ("M6\n", "M6\nLIMS[1]=5000\n"),
        ("X20.000 ", "X=DAC(40) "),
        ("X20.000 ", "X=RAC(20) "),
        (" X-20.000\n", " X=RIC(-40)\n"),
        (" X-20.000\n", " X=DIC(-80)\n"),
    ] {
        let text = posted.text.replace(from, to);
        assert_ne!(text, posted.text, "{from}");
        let right = posted.verify(&text, &[]);
        assert_eq!(right.code, 0, "{to}: {}", right.err);
    }
    posted.told(("S3000 M3\n", "S1=2000 M1=3\n"), "error[spindle]: ");
    posted.told(("S3000 M3\n", "S2=3000 M2=3\n"), "error[nc-word]: S2= speaks to spindle 2");
    posted.told((" X-20.000\n", " X=DIC(-40)\n"), "error[");
    posted.told(("X20.000 ", "X=DAC(20) "), "error[");
}

/// A cycle of Heidenhain has parameters of its own, each of them once.
#[test]
fn a_cycle_has_all_its_parameters_and_no_others() {
    let posted = Posted::new(HOLES, "heidenhain");
    let depth = "    Q201=-12 ;DEPTH ~\n";
    assert!(posted.text.contains(depth), "{}", posted.text);
    for (from, to, message) in [
        (
            "Q202=+12 ;",
            "Q208=+12 ;",
            "error[nc-cycle]: CYCL DEF 200: Q208 is no parameter of this cycle",
        ),
        (
            "Q210=+0 ;",
            "Q1201=+0 ;",
            "error[nc-cycle]: CYCL DEF 200: Q1201 is no parameter of this cycle",
        ),
        ("Q204=+25 ;", "Q200=+25 ;", "error[nc-cycle]: CYCL DEF 200: Q200 is given twice"),
        (
            "    Q210=+0 ;DWELL TIME AT TOP ~\n",
            "",
            "error[nc-cycle]: CYCL DEF 200: Q210 is not given",
        ),
    ] {
        posted.told((from, to), message);
    }
    // Older software has not this one.
    let older = posted.text.replace(" ~\n    Q395=+0 ;DEPTH REFERENCE\n", "\n");
    assert_ne!(older, posted.text);
    let right = posted.verify(&older, &[]);
    assert_eq!(right.code, 0, "{}", right.err);
}

/// An arm leaves what it has cut along the line of its tool: its rapid turns the base by a wrong sign, and comes back.
#[test]
fn an_arm_does_not_leave_a_cut_aside() {
    let posted = Posted::on("kr6-r700", CORNER, "siemens");
    let (_, cuts) = posted.text.split_once("G93 G1 ").unwrap();
    let line = cuts.lines().find(|line| line.contains(" G0 ") && line.contains(" A-")).unwrap();
    posted.told((line, &line.replace(" A-", " A")), "error[rapid]: a rapid leaves what is cut ");
}

/// Behind the last cut the tool goes back into it at feed, and its spindle stands.
#[test]
fn no_tool_comes_back_to_a_cut_while_its_spindle_stands() {
    let posted = Posted::new(CORNER, "fanuc");
    posted.told(
        ("G0 Z50.000\n", "G0 Z50.000\nM5\nG1 Z-2. F200.\nG0 Z50.\n"),
        "error[spindle]: the spindle stands where the tool comes back to a cut",
    );
}

const TWO_HOLES: &str = "\
PARTNO/TWO
UNITS/MM
LOADTL/1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50
CYCLE/DRILL,DEPTH,10,MMPM,200,CLEAR,2
GOTO/0,0,0
GOTO/40,0,0
CYCLE/OFF
RAPID
GOTO/40,0,50
FINI
";

/// A feed upwards at the mouth of a hole, or none at all, drills nothing.
#[test]
fn a_hole_is_drilled_by_what_goes_down_it_alone() {
    let holes = Posted::new(TWO_HOLES, "fanuc");
    let last =
        "error[missing]: the program ends, and what lines 9 to 9 of the CL file ask for is not cut";
    let behind = "X40.000\nG80\nG0 Z50.000\n";
    for up in
        ["G1 Z50.000 F5000.\n", "G1 Z2.100 F200.\nG0 Z50.000\n", "G1 Z2.000 F200.\nG0 Z50.000\n"]
    {
        holes.told((behind, &format!("G80\nG0 X40.000\n{up}")), last);
    }
    holes.told(
        (
            "G94 G99 G81 X0.000 Y0.000 Z-10.000 R2.000 F200.\nX40.000\n",
            "G94 G1 Z3.000 F200.\nG0 X40.000 Z2.000\nG99 G81 X40.000 Y0.000 Z-10.000 R2.000 F200.\n",
        ),
        "error[missing]: line 8 of the CL file is not cut",
    );
}

const TAPPED: &str = "\
PARTNO/TAPPED
UNITS/MM
LOADTL/1
SPINDL/1000,CLW
RAPID
GOTO/40,40,20
CYCLE/DRILL,DEPTH,25,MMPM,200,CLEAR,2
GOTO/40,40,0
CYCLE/OFF
RAPID
GOTO/40,40,50
LOADTL/2
SPINDL/500,CLW
RAPID
GOTO/40,40,20
CYCLE/TAP,DEPTH,15,MMPM,500,CLEAR,2
GOTO/40,40,0
CYCLE/OFF
RAPID
GOTO/40,40,50
FINI
";

/// The hole is there, and the tap is larger.
#[test]
fn no_rapid_goes_into_a_hole_that_its_tool_has_still_to_make() {
    let tapped = Posted::new(TAPPED, "fanuc");
    for (to, by) in [("1", "1"), ("0", "2"), ("-14", "16"), ("-24", "26")] {
        let message = format!(
            "error[hole]: a rapid goes into a hole that this tool has still to make, {by}.000 mm below where its feed begins"
        );
        tapped.told(("H2 Z20.000\n", &format!("H2 Z{to}.000\n")), &message);
    }
}
