//! Arcs of programs on a chain whose axes do not stand exactly across one another: the control interpolates in its words,
//! and the tip goes where the axes take it.

use std::fs;

use tempfile::TempDir;

use crate::common::post_in;

/// A full circle of 20 mm about the origin at Z0, and half a turn of a helix out of it.
const CIRCLE: &str = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X20. Y0.\nG43 H1 Z5.\n\
    G1 Z0. F500.\nG3 X20. Y0. I-20. J0.\nG3 X-20. Y0. Z4. I-20. J0.\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n";

/// A mill whose X leans towards Y by so much, with an end mill of 5 mm, and a rail from `y` on.
fn folder(lean: f64, y: f64) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let machine = format!(
        "extends = \"vmc\"\nname = \"leans\"\n[axis.X]\nlinear = [1, {lean}, 0]\n\
         [tools.1]\nlength = 100\ncutter = [[0, 5], [40, 5]]\n\
         [fixture.rail]\nblock = [[-60, {y}, -310], [60, {}, -290]]\n",
        y + 10.0
    );
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.nc"), CIRCLE).unwrap();
    folder
}

const WORDS: [&str; 6] = ["part.nc", "-m", "mine.toml", "--mount", "0,0,-300", "--set"];

/// How far the tip comes in Y with X along (1, lean): the largest of lean·x + y on the circle.
fn reach(lean: f64) -> f64 {
    let length = libm::hypot(1.0, lean);
    20.0 * libm::hypot(lean / length, 1.0)
}

#[test]
fn a_circle_becomes_what_the_axes_make_of_it() {
    for lean in [0.00002, 0.001, 0.1] {
        for (off, clear) in [(0.03, true), (-0.03, false)] {
            let folder = folder(lean, reach(lean) + 5.0 + off);
            let words = [&["clearance"], &WORDS[..5]].concat();
            let run = post_in(folder.path(), &words);
            assert!(!run.err.contains("nc-arc"), "{}", run.err);
            assert_eq!(run.code == 0, clear, "{lean} {off}: {}{}", run.out, run.err);
        }
    }
    // Where the axes stand across one another the rail is met as late: the circle reaches 20 mm.
    assert!((reach(0.0) - 20.0).abs() < 1e-12 && reach(0.1) > 20.09);
}

#[test]
fn other_posts_arcs_are_read_and_held_against_the_cl_file() {
    let cl = "PARTNO/A\nUNITS/MM\nCUTTER/10\nLOADTL/1\nSPINDL/3000,CLW\nRAPID\nGOTO/20,0,5\nFEDRAT/500,MMPM\nGOTO/20,0,0\n\
              CIRCLE/0,0,0,0,0,1,20\nGOTO/20,0,0\nRAPID\nGOTO/20,0,5\nFINI\n";
    let program = CIRCLE.replace("G3 X-20. Y0. Z4. I-20. J0.\n", "");
    for (lean, holds) in [(0.00002, true), (0.002, false)] {
        let folder = folder(lean, 100.0);
        fs::write(folder.path().join("part.nc"), &program).unwrap();
        fs::write(folder.path().join("part.cls"), cl).unwrap();
        let words =
            ["verify", "part.nc", "-m", "mine.toml", "--mount", "0,0,0", "--against", "part.cls"];
        let run = post_in(folder.path(), &words);
        let said = format!("{}{}", run.out, run.err);
        assert!(!said.contains("nc-arc"), "{said}");
        // 20 mm times two thousandths: 40 µm, beyond the tolerance of 5.
        assert_eq!(said.contains("error[deviation]"), !holds, "{lean}: {said}");
    }
    let folder = folder(0.001, 100.0);
    let words = ["read", "part.nc", "-m", "mine.toml", "--mount", "0,0,0", "--cl", "back.cls"];
    let run = post_in(folder.path(), &words);
    assert_eq!(run.code, 0, "{}", run.err);
    let back = fs::read_to_string(folder.path().join("back.cls")).unwrap();
    // The words of all points are on the circle.
    let points = back.lines().filter_map(|line| line.strip_prefix("GOTO/")?.strip_suffix(",0"));
    let radii = points.map(|point| {
        let [x, y] =
            [0, 1].map(|place| point.split(',').nth(place).unwrap().parse::<f64>().unwrap());
        libm::hypot(x * libm::hypot(1.0, 0.001), y - 0.001 * x)
    });
    let radii: Vec<f64> = radii.collect();
    assert!(
        radii.len() > 20 && radii.iter().all(|radius| (radius - 20.0).abs() < 1e-4),
        "{radii:?}"
    );
}

/// Ahead of the block in which the control begins to keep the tip X and Y would be words of slides, and those lean.
#[test]
fn the_tip_comes_to_its_first_point_where_a_slide_leans_and_the_control_keeps_it() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "name = \"leans\"\nchain = \"[w b X Z Y B (S) t]\"\ntool.gauge = [0, 0, 400]\n\
                   control = { dialect = \"mazak\", tcp = \"control\" }\n\
                   [axis.X]\nlinear = [1, 0, 0]\ntravel = [-1000, 1000]\n\
                   [axis.Y]\nlinear = [-0.009, 1, 0]\ntravel = [-1000, 1000]\n\
                   [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-1000, 1000]\n\
                   [axis.B]\nrotary = [0, 1, 0]\npoint = [0, 0, 550]\ntravel = [-90, 90]\n";
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/16,-30,50,0,0,1\nFEDRAT/500,MMPM\n\
              GOTO/16,-30,40,0,0,1\nGOTO/30,-20,40,0,0,1\nRAPID\nGOTO/30,-20,60,0,0,1\nFINI\n";
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let words =
        ["-m", "mine.toml", "part.cls", "-o", "part.nc", "--tool-length", "100", "--verify"];
    let run = post_in(folder.path(), &words);
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert!(program.contains("G43.4 H1 X16.000 Y-30.000 Z"), "{program}");
}

/// One work offset holds before a length is called and behind it: X and Y ahead of G43 count from what those in its block do.
/// The slide of the depth leans by a thousandth, a tool of 300 mm by 0.3 mm.
#[test]
fn words_ahead_of_the_length_count_from_the_offset_that_words_behind_it_do() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\nname = \"leans\"\n[axis.Z]\nlinear = [0.001, 0, 1]\n[tools.1]\nlength = 300\n";
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/16,-30,50\nFEDRAT/500,MMPM\n\
              GOTO/16,-30,40\nGOTO/16,-20,40\nRAPID\nGOTO/16,-20,60\nFINI\n";
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let run = post_in(folder.path(), &["-m", "mine.toml", "part.cls", "-o", "part.nc"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    let verify = ["verify", "part.nc", "-m", "mine.toml", "--against", "part.cls"];
    let run = post_in(folder.path(), &verify);
    assert_eq!(run.code, 0, "{program}{}", run.err);
    // And each word of X that is off by what the lean makes is told, ahead of the length and behind it.
    let lines: Vec<&str> = program.lines().collect();
    let words: Vec<(usize, f64)> = lines
        .iter()
        .enumerate()
        .filter_map(|(at, line)| {
            let word = line.split(' ').find_map(|word| word.strip_prefix('X'))?;
            Some((at, word.parse().ok()?))
        })
        .collect();
    let length = lines.iter().position(|line| line.contains("G43")).unwrap();
    assert!(words.iter().any(|(at, _)| *at < length), "{program}");
    assert!(words.iter().any(|(at, _)| *at > length), "{program}");
    // The last retract may end where it likes, within the tolerance of rapids.
    let led = |at: usize| at < length || !lines[at].starts_with("G0");
    for (at, x) in words.into_iter().filter(|(at, _)| led(*at)) {
        let mut off = lines.iter().map(ToString::to_string).collect::<Vec<_>>();
        let word = lines[at].split(' ').find(|word| word.starts_with('X')).unwrap();
        off[at] = off[at].replacen(word, &format!("X{:.3}", x + 0.3), 1);
        fs::write(folder.path().join("part.nc"), off.join("\n") + "\n").unwrap();
        let run = post_in(folder.path(), &verify);
        assert_eq!(run.code, 1, "{}\n{}", off[at], run.err);
    }
}

/// A control works out a plane for slides that stand square and still: on a table that turns one, or where one leans, an
/// operation whose tool axis stays is written by its own axes.
#[test]
fn no_plane_is_written_by_itself_where_a_table_turns_a_slide_or_one_leans() {
    let cl = "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/10,-30,60,0.3,0,0.953939201\nFEDRAT/500,MMPM\n\
              GOTO/10,-30,40,0.3,0,0.953939201\nGOTO/10,20,40,0.3,0,0.953939201\nRAPID\nGOTO/10,20,80,0.3,0,0.953939201\nFINI\n";
    for (chain, x, planes) in [
        ("[w C' B' X' b Y Z (S) t]", "[1, 0, 0]", true),
        ("[w X' C' B' b Y Z (S) t]", "[1, 0, 0]", false),
        ("[w C' B' X' b Y Z (S) t]", "[1, 0.003, 0]", false),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let machine = format!(
            "name = \"slides\"\nchain = \"{chain}\"\ntool.gauge = [0, 0, 400]\n\
             control = {{ dialect = \"haas\", tcp = \"post\" }}\n[tools.1]\nlength = 100\n\
             [axis.X]\nlinear = {x}\ntravel = [-2000, 2000]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-2000, 2000]\n\
             [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-2000, 2000]\n\
             [axis.B]\nrotary = [0, 1, 0]\npoint = [0, 0, 0]\ntravel = [-400, 400]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ntravel = [-400, 400]\n"
        );
        fs::write(folder.path().join("mine.toml"), machine).unwrap();
        fs::write(folder.path().join("part.cls"), cl).unwrap();
        let words = ["-m", "mine.toml", "part.cls", "-o", "part.nc", "--verify"];
        let run = post_in(folder.path(), &words);
        assert_eq!(run.code, 0, "{chain} {x}: {}", run.err);
        let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        assert_eq!(program.contains("G254"), planes, "{chain} {x}: {program}");
        // Its feed in such a plane is another, too: who asks for one all the same is told.
        let forced = [&words[..], &["--set", "control.planes=true"]].concat();
        let run = post_in(folder.path(), &forced);
        let turned = chain.contains("X' C'");
        assert_eq!(run.err.contains("error[planes]"), turned, "{chain} {x}: {}", run.err);
    }
}

/// Beside a pole the tip bows aside by more than it goes: a time of what it goes along would be faster than the CL file asks.
#[test]
fn beside_a_pole_no_feed_by_time_is_that_of_a_way_that_bows_aside_by_more() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "name = \"bows\"\nchain = \"[w C' B' Y' b X Z (S) t]\"\n\
                   workpiece.mount = [-17.743, -11.578, 9.963]\ntool.gauge = [-1.309, -1.998, 344.229]\n\
                   control = { dialect = \"haas\", tcp = \"post\" }\naccuracy.tolerance = 0.005\n\
                   [axis.C]\nrotary = [0, 0, 1]\npoint = [-16.685974, 32.148456, -9.722254]\ntravel = [-400, 400]\nreversed = true\n\
                   [axis.B]\nrotary = [0, 1, 0]\npoint = [-11.065595, 12.911432, 23.615994]\ntravel = [-400, 400]\nreversed = true\n\
                   [axis.Y]\nlinear = [0, 1, 0]\ntravel = [-2000, 2000]\n\
                   [axis.X]\nlinear = [1, 0, 0]\ntravel = [-2000, 2000]\n\
                   [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-2000, 2000]\n[tools.2]\nlength = 76.955\n";
    let cl = "UNITS/MM\nMULTAX/ON\nLOADTL/2\nSPINDL/RPM,5471,CLW\nRAPID\n\
              GOTO/-38.974117,-34.194080,64.078092,-0.0221652732,-0.0794714351,0.9965906841\nFEDRAT/2894,MMPM\n\
              GOTO/-38.531281,-32.606335,44.167391,-0.0221652732,-0.0794714351,0.9965906841\n\
              GOTO/-28.177279,-28.557686,51.369505,-0.4005472217,-0.1985053530,0.8945152587\n\
              GOTO/-23.446484,-40.538578,55.444988,0.0015360365,0.0021404903,0.9999965294\nRAPID\n\
              GOTO/-23.408083,-40.485066,80.444901,0.0015360365,0.0021404903,0.9999965294\nFINI\n";
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let run = post_in(folder.path(), &["-m", "mine.toml", "part.cls", "-o", "part.nc", "--verify"]);
    assert_eq!(run.code, 0, "{}", run.err);
}

/// A control on which the length of the tool before stays on until the next one is called: the work offset is that of the
/// tool which is in the spindle, 145 mm longer, and 0.22 mm aside.
#[test]
fn words_behind_a_tool_change_count_from_the_offset_of_the_tool_that_came() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\nname = \"leans\"\ncontrol.dialect = \"isg\"\n[axis.Z]\nlinear = [0, -0.0015, 1]\n\
                   [tools.1]\nlength = 185\n[tools.2]\nlength = 40\n";
    let cl = "UNITS/MM\nLOADTL/2\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/-20,30,20\nFEDRAT/500,MMPM\nGOTO/-20,30,0\nRAPID\n\
              GOTO/-20,30,50\nLOADTL/1\nSPINDL/RPM,4000,CLW\nRAPID\nGOTO/30,10,20\nFEDRAT/500,MMPM\nGOTO/30,10,0\nRAPID\n\
              GOTO/30,10,50\nFINI\n";
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let words = ["-m", "mine.toml", "part.cls", "-o", "part.nc", "--mount", "0,0,-40", "--verify"];
    let run = post_in(folder.path(), &words);
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert!(program.contains("G0 X30.000 Y10.030\nD1 Z20.000\n"), "{program}");
}

/// The angles of a plane have three decimals: across it Z goes by some micrometres, and that is no motion of Z ahead of the
/// length.
#[test]
fn a_plane_of_rounded_angles_moves_no_depth_that_its_length_would_be_missed_for() {
    let folder = tempfile::tempdir().unwrap();
    for axis in ["0.139068146,-0.349383576,0.926603943", "-0.198732340,-0.468988249,0.860559838"] {
        let cl = format!(
            "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/150,120,100,{axis}\n\
             CYCLE/DRILL,FEDTO,-10,MMPM,300,RAPTO,3\nGOTO/150,120,60,{axis}\nGOTO/-100,-80,60,{axis}\n\
             CYCLE/OFF\nRAPID\nGOTO/-100,-80,150,{axis}\nFINI\n"
        );
        fs::write(folder.path().join("part.cls"), cl).unwrap();
        let words = [
            &["-m", "nutating-table", "part.cls", "-o", "part.nc", "--tool-length", "100"][..],
            &["--dialect", "mazak", "--set", "control.planes=true", "--verify"],
        ];
        let run = post_in(folder.path(), &words.concat());
        assert_eq!(run.code, 0, "{}", run.err);
        let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        assert!(program.contains("\nG53.1\nG0 X"), "{program}");
    }
}

/// A plane that leans by 0.06° from the slide of the depth: words across it move that too, by 0.3 mm here, which ended past
/// its travel and ahead of the tool's length. The tool comes from above.
#[test]
fn words_across_a_plane_that_leans_a_little_do_not_come_first() {
    let folder = tempfile::tempdir().unwrap();
    for (axis, first) in [("0,0,1", "G0 X"), ("0.001,0,0.9999995", "G0 G43 H2 X")] {
        let cl = format!(
            "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/-150,120,100,0.3,0.2,0.932737905\n\
             FEDRAT/500,MMPM\nGOTO/-150,120,60,0.3,0.2,0.932737905\nRAPID\nGOTO/-150,120,160,0.3,0.2,0.932737905\n\
             LOADTL/2\nSPINDL/RPM,2000,CLW\nRAPID\nGOTO/150,-80,100,{axis}\nFEDRAT/500,MMPM\nGOTO/150,-80,60,{axis}\n\
             RAPID\nGOTO/150,-80,150,{axis}\nFINI\n"
        );
        fs::write(folder.path().join("part.cls"), cl).unwrap();
        let words = [
            &["-m", "head-table-bc", "part.cls", "-o", "part.nc", "--tool-length", "100"][..],
            &["--set", "accuracy.axis_tolerance=0.01", "--verify"],
        ];
        let run = post_in(folder.path(), &words.concat());
        assert_eq!(run.code, 0, "{axis}: {}", run.err);
        let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        assert!(program.contains(&format!("\nG53.1\n{first}")), "{axis}: {program}");
    }
}

/// What the choice holds beside a pole does not stand upright on the plane of a measured table: the first point of a plane
/// stands as its plane does, and no axis turns in the cut behind it.
#[test]
fn the_first_point_of_a_plane_stands_upright_on_it() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "name = \"measured\"\nchain = \"[w C' B' Y' X' b Z (S) t]\"\n[workpiece]\nmount = [-10.578, -11.245, -2.495]\n\
                   [tool]\ngauge = [-3.762, -0.125, 347.163]\n[axis.C]\nrotary = [-0.003311, 0.005453, 1.000596]\n\
                   point = [0.961386, -0.770897, 0.70359]\ntravel = [-400, 400]\n[axis.B]\nrotary = [0, 1, 0]\n\
                   point = [-16.88225, -21.62152, -28.102143]\ntravel = [-400, 400]\n[axis.Y]\nlinear = [0, 1, 0]\n\
                   travel = [-600, 600]\n[axis.X]\nlinear = [1, 0, 0]\ntravel = [-600, 600]\n[axis.Z]\nlinear = [0, 0, 1]\n\
                   travel = [-600, 600]\n[control]\ntcp = \"control\"\n[accuracy]\ntolerance = 0.005\n[tools.1]\nlength = 199.84\n";
    let cl = "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3310,CLW\nRAPID\nGOTO/-47.426,-32.496,-16.634,0,0,1\nFEDRAT/1016,MMPM\n\
              GOTO/-47.426,-32.496,-43.998,0,0,1\nMOVARC/-76.0687,-30.5823,-43.998,0,0,-1,28.7064,ANGLE,163.4879\n\
              GOTO/-104.0738503,-36.8885074,-43.998,0,0,1\nGOTO/-45.274,-43.139,-32.642,0,0,1\nRAPID\nGOTO/-45.274,-43.139,-7.642,0,0,1\n\
              SPINDL/RPM,8949,CLW\nRAPID\nGOTO/48.004,-36.573,27.893,0,0,1\nFEDRAT/2444,MMPM\nGOTO/48.004,-36.573,3.537,0,0,1\n\
              RAPID\nGOTO/48.004,-36.573,28.537,0,0,1\nFINI\n";
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    for dialect in ["haas", "fanuc", "siemens", "heidenhain"] {
        let words =
            ["-m", "mine.toml", "part.cls", "-o", "part.nc", "--dialect", dialect, "--verify"];
        let run = post_in(folder.path(), &words);
        assert_eq!(run.code, 0, "{dialect}: {}", run.err);
        let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        let cuts =
            program.lines().filter(|block| block.starts_with("G1 ") || block.starts_with("L "));
        for cut in cuts.filter(|cut| cut.contains('F')) {
            assert!(!cut.contains(" B") && !cut.contains(" C"), "{dialect}: {cut}");
        }
    }
}
