//! Files of tools: read, checked, converted, and posted with.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use post_job::session::Session;
use post_job::tools::{FORMATS, ReadTools, TableUnits, ToolFormat, read};
use post_machine::description::{ToolData, ToolTable};
use post_testkit::{Rng, randomised};

use crate::common::{Run, command, run};

const TBL: &str = "; tools of the mill\nT1 P1 Z+120.5 D10 ;END MILL 10\nT2 P7 D6.0 Z98.25 ; DRILL\nT0 P0 ;no tool\nT9 P3 ;\n";

const TNC: &str = "\
BEGIN TOOL .T MM
T    NAME            L           R        R2      DL      DR      DR2   NMAX   TL
0                    +0          +0       +0      +0      +0      +0    -
1    END MILL 10     +120.5      +5       +0.5    -0.1    +0.02   +0    12000
2    BOHRER D6       +98.25      +3       +0      +0      +0      +0    -      L
2.1  STUFE           +90         +4       +0      +0      +0      +0    -
[END]
";

const FANUC: &str = "\
%
O1000 (TOOL OFFSETS)
G21 G90
G10 L2 P1 X-300. Y-200. Z0
G10 L10 P1 R120.5 (END MILL 10)
G10 L11 P1 R-.1
G10 L12 P1 R5.
N5 G10 L13 P1 R0.02
G10L10P2R98.25
G10 L12 P2 R3.
G10 L10 P3 R0
M30
%
";

const SIEMENS: &str = "\
; tools
$TC_TP1[1]=1
$TC_TP2[1]=\"END MILL; 10\"
$TC_TP_MAX_VELO[1]=12000
$TC_DP1[1,1]=120
$TC_DP3[1,1]=100.5
$TC_DP21[1,1]=20
$TC_DP6[1,1]=5
$TC_DP12[1,1]=-0.1
$TC_DP15[1,1]=0.02 ; worn
$TC_DP3[1,2]=55
N10 $TC_DP3[ 2 , 1 ] = 98.25
$TC_DP6[2,1]=3
M17
";

const FUSION: &str = r#"{
 "data": [
  {"description": "END MILL 10", "type": "flat end mill", "unit": "millimeters",
   "geometry": {"DC": 10, "RE": 0.5, "LB": 40, "OAL": 72, "assemblyGaugeLength": 120.5},
   "holder": {"description": "ER32", "gaugeLength": 80.5},
   "post-process": {"number": 1}},
  {"description": "BALL", "type": "ball end mill", "unit": "inches",
   "geometry": {"DC": 0.25, "LB": 1.0},
   "holder": {"description": "ER16", "unit": "millimeters", "gaugeLength": 72.85},
   "post-process": {"number": 2}},
  {"description": "BARE", "type": "drill", "unit": "millimeters",
   "geometry": {"DC": 3, "assemblyGaugeLength": 60}, "post-process": {"number": 3}},
  {"type": "holder", "unit": "millimeters", "segments": []}
 ], "version": 2
}
"#;

const CSV: &str = "\u{feff}Nr.;Bezeichnung;L (mm);D (mm)\nT1;\"FR\u{c4}SER; 10\";120,5;10\n\nT2;BOHRER;98,25;6\n;;;\n";

/// Runs `post tools` in a folder.
fn tools(folder: &Path, arguments: &[&str]) -> Run {
    let mut tools = command();
    run(tools.current_dir(folder).arg("tools").args(arguments), b"")
}

/// What is listed of a good file: its lines, blanks between cells told once.
#[track_caller]
fn listed(name: &str, text: &str, arguments: &[&str]) -> (Vec<String>, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    let run = tools(folder.path(), &[&[name], arguments].concat());
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let lines = run.out.lines().skip(2);
    let plain = |cell: &str| match cell.parse::<f64>() {
        Ok(_) if cell.contains('.') => cell.trim_end_matches('0').trim_end_matches('.').to_owned(),
        _ => cell.to_owned(),
    };
    let lines = lines.map(|line| line.split_whitespace().map(plain).collect::<Vec<_>>().join(" "));
    (lines.collect(), run.err)
}

/// What is said of a broken file.
#[track_caller]
fn broken(name: &str, text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    let run = tools(folder.path(), &[name]);
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert!(run.err.contains("help: "), "{}", run.err);
    run.err
}

#[test]
fn each_format_is_read() {
    let (lines, said) = listed("tool.tbl", TBL, &[]);
    assert_eq!(
        lines[..3],
        ["tool name length diameter pocket", "1 END MILL 10 120.5 10 1", "2 DRILL 98.25 6 7"]
    );
    assert_eq!((lines.len(), said.as_str()), (3, ""));
    let (lines, said) = listed("TOOL.T", TNC, &[]);
    assert_eq!(lines[0], "tool name length wear diameter radius wear corner most rpm");
    assert_eq!(lines[1], "1 END MILL 10 120.5 -0.1 10 0.02 0.5 12000");
    assert_eq!(lines[2], "2 BOHRER D6 98.25 - 6 - - -");
    assert!(said.contains("TOOL.T:6") && said.contains("2.1 is left out"), "{said}");
    let (lines, _) = listed("offsets.nc", FANUC, &[]);
    assert_eq!(lines[0], "register name length wear diameter radius wear");
    assert_eq!(lines[1..], ["1 END MILL 10 120.5 -0.1 10 0.02", "2 - 98.25 - 6 -"]);
    let (lines, _) = listed("offsets.nc", FANUC, &["--from", "haas"]);
    assert_eq!(lines[1], "1 END MILL 10 120.5 -0.1 5 0.01");
    let (lines, said) = listed("tools.ini", SIEMENS, &[]);
    assert_eq!(lines[1], "1 END MILL; 10 120.5 -0.1 10 0.02 12000");
    assert!(said.contains("tools.ini:11") && said.contains("cutting edges beyond"), "{said}");
    let (lines, _) = listed("library.json", FUSION, &[]);
    assert_eq!(lines[0], "tool name holder length diameter corner stick-out");
    assert_eq!(
        lines[1..],
        [
            "1 END MILL 10 ER32 120.5 10 0.5 40",
            "2 BALL ER16 98.25 6.35 3.175 25.4",
            "3 BARE - - 3 - -"
        ]
    );
    let columns = [
        "--column",
        "number=Nr.",
        "--column",
        "name=Bezeichnung",
        "--column",
        "length=L (mm)",
        "--column",
        "diameter=D (mm)",
    ];
    let (lines, _) = listed("presetter.csv", CSV, &columns);
    assert_eq!(lines[1..], ["1 FR\u{c4}SER; 10 120.5 10", "2 BOHRER 98.25 6"]);
}

#[test]
fn a_library_of_freecad_reads_its_bits() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("Library")).unwrap();
    fs::create_dir_all(at("Bit")).unwrap();
    fs::write(at("Bit/a.fctb"), r#"{"version": 2, "name": "5mm", "shape": "endmill.fcstd", "parameter": {"Diameter": "5.0000 mm", "Length": "50.0000 mm"}}"#).unwrap();
    fs::write(at("Library/b.fctb"), r#"{"version": 2, "name": "quarter", "shape": "endmill.fcstd", "parameter": {"Diameter": "0.2500 in"}}"#).unwrap();
    let library = |second: &str| {
        format!(
            "{{\"version\": 1, \"tools\": [\n{{\"nr\": 1, \"path\": \"a.fctb\"}},\n{{\"nr\": 2, \"path\": \"{second}\"}}\n]}}"
        )
    };
    fs::write(at("Library/shop.fctl"), library("b.fctb")).unwrap();
    let good = tools(folder.path(), &["Library/shop.fctl"]);
    assert!(
        good.out.contains("1     5mm        5.0000")
            && good.out.contains("2     quarter    6.3500"),
        "{}{}",
        good.out,
        good.err
    );
    assert!(good.err.contains("no lengths from the gauge point"), "{}", good.err);
    for (bad, said) in
        [("c.fctb", "cannot be read"), ("../Bit/a.fctb", "is no bit"), ("/etc/passwd", "is no bit")]
    {
        fs::write(at("Library/shop.fctl"), library(bad)).unwrap();
        let run = tools(folder.path(), &["Library/shop.fctl"]);
        assert!(run.code == 1 && run.err.contains(said), "{}", run.err);
        assert!(run.err.contains("shop.fctl:3"), "{}", run.err);
    }
}

/// Each line that is broken is told with its file, its line and a remedy.
#[test]
fn broken_files_are_refused_by_their_lines() {
    let cases: [(&str, String, &str, &str); 16] = [
        ("tool.tbl", TBL.replace("Z+120.5", "Z+12O.5"), ":2", "is no number"),
        ("tool.tbl", TBL.replace("Z+120.5", "H120.5"), ":2", "no word of a tool table"),
        (
            "tool.tbl",
            TBL.replace("T2 P7", "T1 P7"),
            ":3",
            "tool 1 stands there twice, in lines 2 and 3",
        ),
        ("tool.tbl", TBL.replace("T2 P7 ", "P7 "), ":3", "the line has no T"),
        ("tool.tbl", TBL.replace("98.25", "982500"), ":3", "tool 2 has a size of 982500 mm"),
        ("tool.tbl", TBL.replace("D6.0", "D-6.0"), ":3", "below zero"),
        ("TOOL.T", TNC.replace("[END]\n", ""), ":6", "ends without [END]"),
        ("TOOL.T", TNC.replace(".T MM", ".T"), ":1", "does not begin as one"),
        ("TOOL.T", TNC.replace("NAME            L ", "NAME            LL"), ":2", "no column L"),
        ("TOOL.T", TNC.replace("+98.25 ", "+98.25x"), ":5", "L: "),
        ("o.nc", FANUC.replace("G21 G90", "G21 G91"), ":5", "adds to what the memory holds"),
        ("o.nc", FANUC.replace("R98.25", "R98250"), ":9", "no decimal point"),
        ("o.nc", FANUC.replace("P2R98.25", "R98.25"), ":9", "without P or R"),
        ("t.ini", SIEMENS.replace("$TC_DP6[2,1]=3", "$TC_DP6[2,1"), ":13", "cannot be read"),
        ("l.json", FUSION.replace("\"unit\": \"inches\",", ""), ":7", "millimeters or inches"),
        ("p.csv", "number,length\n1,120.5,7\n".to_owned(), ":2", "has 3 cells"),
    ];
    for (name, text, line, message) in cases {
        let said = broken(name, &text);
        assert!(said.contains(&format!("{name}{line}")) && said.contains(message), "{said}");
    }
    assert!(
        broken("old.tbl", "TOOLNO POCKET LENGTH DIAMETER\n1 1 2.5 0.5\n")
            .contains("columns below heads")
    );
    assert!(broken("x.bin", "what is this").contains("neither its name nor its text"));
    assert!(broken("l.json", "PK\u{3}\u{4}zip").contains("packed archive"));
    assert!(broken("p.csv", "T,L\n1,2\n").contains("no column number"));
    for nothing in ["", "; tools of the mill\n", "T0 P0 ;no tool\n"] {
        let said = broken("tool.tbl", nothing);
        assert!(said.contains("error[tools]: tool.tbl has no tools"), "{said}");
    }
}

/// What ends a line is LF, CR and LF, or CR alone.
#[test]
fn a_table_has_the_same_tools_whatever_ends_its_lines() {
    let (plain, _) = listed("tool.tbl", TBL, &[]);
    assert!(plain.len() >= 2, "{plain:?}");
    for end in ["\r\n", "\r"] {
        assert_eq!(listed("tool.tbl", &TBL.replace('\n', end), &[]).0, plain, "{end:?}");
    }
    assert!(
        broken("tool.tbl", &TBL.replace("98.25", "x").replace('\n', "\r")).contains("tool.tbl:3")
    );
}

/// What is written in a format is read as it was: wear for itself or in the length, as the format has it.
#[test]
fn what_is_written_is_read_again() {
    let columns = ["tool", "length", "wear", "diameter", "radius wear"];
    let wear = ["1", "120.5", "-0.1", "10", "0.02"];
    let whole = ["1", "120.4", "", "10.04", ""];
    let length = ["1", "120.4", "", "", ""];
    for (format, ending, wanted) in [
        ("heidenhain", "t", wear),
        ("fanuc", "nc", wear),
        ("haas", "nc", wear),
        ("siemens", "ini", wear),
        ("csv", "csv", wear),
        ("linuxcnc", "tbl", whole),
        ("machine", "toml", length),
    ] {
        for units in ["mm", "inch"] {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("TOOL.T"), TNC).unwrap();
            let name = format!("out.{ending}");
            let made =
                tools(folder.path(), &["TOOL.T", "-o", &name, "--to", format, "--to-units", units]);
            assert_eq!(made.code, 0, "{}", made.err);
            let again = tools(
                folder.path(),
                &[&name, "--from", format, "--units", units, "-o", "-", "--to", "csv"],
            );
            assert_eq!(again.code, 0, "{}", again.err);
            let mut lines = again.out.lines();
            assert_eq!(
                lines.next(),
                Some(
                    "number,name,length,length_wear,radius,radius_wear,corner_radius,stick_out,holder,most_rpm,pocket"
                )
            );
            let first: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!(first[..2], ["1", "END MILL 10"], "{format}");
            let close = |cell: &str, wanted: &str, factor: f64, what: &str| {
                let wanted: f64 = wanted.parse().unwrap_or(0.0);
                let cell: f64 = cell.parse().unwrap_or(0.0);
                assert!(
                    (cell * factor - wanted).abs() < 2e-5,
                    "{format} {units} {what}: {cell}, not {wanted}"
                );
            };
            for (cell, place, factor) in [(2, 1, 1.0), (3, 2, 1.0), (4, 3, 2.0), (5, 4, 1.0)] {
                close(first[cell], wanted[place], factor, columns[place]);
            }
            assert_eq!(lines.count(), 1, "{format}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("tool.tbl"), TBL).unwrap();
    let none = tools(folder.path(), &["tool.tbl", "-o", "out.fctl"]);
    assert!(none.code == 1 && none.err.contains("is read, not written"), "{}", none.err);
    let twice = tools(folder.path(), &["tool.tbl", "-o", "tool.tbl"]);
    assert!(twice.code == 1 && twice.err.contains("would overwrite"), "{}", twice.err);
}

/// Two tools, the second in another register.
const CL: &str = "UNITS/MM\nMULTAX/ON\nTPRINT/END MILL 10\nCUTTER/10\nLOADTL/1\nCSI_SET_EXTENSION_LENGTH/45.\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,10,50,0,0,1\n\
    FEDRAT/600,MMPM\nGOTO/20,10,15\nRAPID\nGOTO/20,10,50\nTPRINT/DRILL\nCUTTER/6\nLOADTL/2,ADJUST,12\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,10,50\n\
    FEDRAT/600,MMPM\nGOTO/20,10,15\nRAPID\nGOTO/20,10,50\nEND\nFINI\n";

const MILL: &str = "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n";

/// Posts the two tools.
fn post(folder: &Path, machine: &str, arguments: &[&str]) -> Run {
    fs::write(folder.join("m.toml"), machine).unwrap();
    fs::write(folder.join("part.cls"), CL).unwrap();
    let mut post = command();
    post.current_dir(folder).args(["-m", "m.toml", "-o", "part.nc", "part.cls"]).args(arguments);
    run(&mut post, b"")
}

#[test]
fn a_job_takes_its_lengths_from_a_file_and_calls_no_tool_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("tool.tbl"), TBL).unwrap();
    let by_flag = post(folder.path(), MILL, &["--tools", "tool.tbl"]);
    assert_eq!(by_flag.code, 0, "{}", by_flag.err);
    for length in ["120.5 mm long, by the file of tools", "98.25 mm long, by the file of tools"] {
        assert!(by_flag.out.contains(length), "{}", by_flag.out);
    }
    // The machine file names it from where it stands; the flag of all tools goes before both.
    fs::create_dir_all(at("shop")).unwrap();
    fs::write(at("shop/tool.tbl"), TBL.replace("120.5", "130.5")).unwrap();
    fs::write(
        at("shop/mill.toml"),
        format!("{MILL}[tools]\nfile = \"tool.tbl\"\n1 = 99\n7 = 80\n"),
    )
    .unwrap();
    let by_machine = post(folder.path(), "extends = \"shop/mill.toml\"\n", &[]);
    assert!(
        by_machine.out.contains("130.5 mm long, by the file of tools"),
        "{}{}",
        by_machine.out,
        by_machine.err
    );
    assert!(
        by_machine.err.contains(
            "99 mm long in [tools] of the machine file, 130.5 mm in shop/tool.tbl:2, which is taken"
        ),
        "{}",
        by_machine.err
    );
    let mut place = command();
    place.current_dir(folder.path()).args(["place", "part.cls", "-m", "m.toml"]);
    let placed = run(&mut place, b"");
    assert_eq!(placed.err.matches("which is taken").count(), 1, "{}", placed.err);
    let both = post(folder.path(), "extends = \"shop/mill.toml\"\n", &["--tools", "tool.tbl"]);
    assert!(both.out.contains("120.5 mm long, by the file of tools"), "{}", both.out);
    let all = post(folder.path(), MILL, &["--tools", "tool.tbl", "--tool-length", "100"]);
    assert!(all.out.contains("100 mm long, by --tool-length"), "{}", all.out);
    // A tool that is not there, another cutter, and a speed that it cannot turn at.
    fs::write(at("one.tbl"), "T1 P1 Z120.5 D10\nT3 P3 Z90 D6\n").unwrap();
    let missing = post(folder.path(), MILL, &["--tools", "one.tbl"]);
    assert_eq!(missing.code, 1, "{}", missing.err);
    assert!(
        missing
            .err
            .contains("error[tool-missing]: tool 2 (DRILL) is called, and is not in one.tbl"),
        "{}",
        missing.err
    );
    assert!(
        missing.err.contains("part.cls:19") && missing.err.contains("it has 1, 3"),
        "{}",
        missing.err
    );
    fs::write(at("other.tbl"), TBL.replace("D6.0", "D8.0")).unwrap();
    let other = post(folder.path(), MILL, &["--tools", "other.tbl"]);
    assert!(
        other.err.contains(
            "warning[tool-differs]: tool 2 is 6 mm in diameter in the CL file, 8 mm in other.tbl:3"
        ),
        "{}",
        other.err
    );
    fs::write(at("TOOL.T"), TNC.replace("12000", "2500 ")).unwrap();
    let fast = post(folder.path(), MILL, &["--tools", "TOOL.T"]);
    assert!(
        fast.code == 1
            && fast.err.contains(
                "error[tool-speed]: tool 1 would turn at 3000 rpm, TOOL.T:4 allows it 2500 rpm"
            ),
        "{}",
        fast.err
    );
    assert_eq!(fast.err.matches("tool-speed").count(), 1, "{}", fast.err);
}

#[test]
fn offsets_are_those_of_the_register_that_the_file_calls() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("offsets.nc"), FANUC.replace("P2", "P12")).unwrap();
    let made = post(folder.path(), MILL, &["--tools", "offsets.nc"]);
    assert_eq!(made.code, 0, "{}", made.err);
    assert!(
        made.out.contains("120.4 mm long") && made.out.contains("98.25 mm long"),
        "{}",
        made.out
    );
    let mut verify = command();
    verify.current_dir(folder.path()).args([
        "verify",
        "part.nc",
        "--machine",
        "m.toml",
        "--against",
        "part.cls",
        "--tools",
        "offsets.nc",
    ]);
    let held = run(&mut verify, b"");
    assert_eq!(held.code, 0, "{}", held.err);
    fs::write(at("offsets.nc"), FANUC).unwrap();
    let missing = post(folder.path(), MILL, &["--tools", "offsets.nc"]);
    assert!(missing.err.contains("register 12 of tool 2 (DRILL) is called"), "{}", missing.err);
}

#[test]
fn inches_are_those_of_the_machine_and_offsets_from_a_touch_off_are_no_lengths() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let inch = format!("{MILL}[control]\nunits = \"inch\"\n");
    fs::write(at("tool.tbl"), "T1 Z5 D0.39370079\nT2 Z4 D0.23622047\n").unwrap();
    let made = post(folder.path(), &inch, &["--tools", "tool.tbl"]);
    assert!(made.code == 0 && made.out.contains("127 mm long"), "{}{}", made.out, made.err);
    let told = post(folder.path(), MILL, &["--tools", "tool.tbl", "--set", "tools.units=inch"]);
    assert!(told.code == 0 && told.out.contains("127 mm long"), "{}{}", told.out, told.err);
    let short = post(folder.path(), MILL, &["--tools", "tool.tbl"]);
    let least = "tool 1 is 5 mm long from the gauge point to the tip, and 15 mm are the least";
    assert!(short.err.contains(least), "{}", short.err);
    fs::write(at("tool.tbl"), "T1 Z-30 D10\nT2 Z-20.5 D6\n").unwrap();
    let below = post(folder.path(), MILL, &["--tools", "tool.tbl"]);
    assert!(
        below.code == 1 && below.err.contains("tool.tbl:1") && below.err.contains("touched off"),
        "{}",
        below.err
    );
    let from = post(folder.path(), MILL, &["--tools", "tool.tbl", "--set", "tools.reference=150"]);
    assert!(from.code == 0 && from.out.contains("129.5 mm long"), "{}{}", from.out, from.err);
}

/// A machine file may be a stranger's.
#[test]
fn a_machine_file_names_no_file_that_is_none_of_tools_and_shows_nothing_of_one() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let named = |file: &str| format!("{MILL}[tools]\nfile = \"{file}\"\n");
    fs::write(at("secret"), "T1 SECRET\n").unwrap();
    let refused = post(folder.path(), &named("secret"), &[]);
    assert!(
        refused.code == 1 && refused.err.contains("is no name of a file of tools"),
        "{}",
        refused.err
    );
    for name in ["s.tbl", "s.csv"] {
        fs::write(at(name), "T1 SECRET\n1,SECRET,3,SECRET\n").unwrap();
        let refused = post(folder.path(), &named(name), &[]);
        assert!(refused.code == 1 && !refused.err.contains("SECRET"), "{}", refused.err);
    }
    let shown = post(folder.path(), MILL, &["--tools", "s.tbl"]);
    assert!(shown.code == 1 && shown.err.contains("SECRET"), "{}", shown.err);
    let none = post(folder.path(), &named("none.tbl"), &[]);
    assert!(none.code == 1 && none.err.contains("none.tbl"), "{}", none.err);
    let slip = post(
        folder.path(),
        &format!("{MILL}[tools]\nfile = \"s.tbl\"\nformat = \"heidenhein\"\n"),
        &[],
    );
    assert!(slip.err.contains("did you mean `heidenhain`?"), "{}", slip.err);
}

#[test]
fn a_cl_file_tells_the_tools_that_it_calls_and_a_table_is_held_against_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("part.cls"), CL).unwrap();
    fs::write(at("tool.tbl"), TBL).unwrap();
    let called = tools(folder.path(), &["part.cls"]);
    assert_eq!(called.code, 0, "{}", called.err);
    fs::copy(at("part.cls"), at("part.data")).unwrap();
    let named = tools(folder.path(), &["part.data", "--from", "cl"]);
    assert_eq!(named.out.replace("part.data", "part.cls"), called.out, "{}", named.err);
    assert!(
        called.out.contains(
            "1     END MILL 10   10.0000    45.0000\n2     DRILL          6.0000          -"
        ),
        "{}",
        called.out
    );
    let good = tools(folder.path(), &["tool.tbl", "--against", "part.cls"]);
    assert_eq!(good.code, 0, "{}", good.err);
    fs::write(at("tool.tbl"), "T1 Z5 D8\n").unwrap();
    let bad = tools(folder.path(), &["tool.tbl", "--against", "part.cls"]);
    assert_eq!(bad.code, 1, "{}", bad.err);
    assert!(
        bad.err.contains("part.cls:16")
            && bad.err.contains("tool 2 is called, and is not in tool.tbl"),
        "{}",
        bad.err
    );
    assert!(bad.err.contains("warning[tool-differs]"), "{}", bad.err);
}

/// A tool with sizes that every format can have.
fn any_tool(random: &mut Rng, number: u32) -> ToolData {
    let wear = |random: &mut Rng| *random.choose(&[0.0, -0.05, 0.02]);
    let text = |random: &mut Rng| {
        random.choose(&["", "END MILL 10", "DRILL #3", "A;B", "R2,5"]).to_string()
    };
    let size = |random: &mut Rng, most: f64| (random.range(0.1, most) * 1e3).round() / 1e3;
    ToolData {
        number,
        name: text(random),
        length: Some(size(random, 400.0)),
        length_wear: wear(random),
        radius: Some(size(random, 60.0)),
        radius_wear: wear(random),
        ..ToolData::default()
    }
}

/// What a format wrote of tools, read again.
fn again(folder: &Path, format: &ToolFormat, text: &str, inch: bool) -> ReadTools {
    let file = folder.join("tools.txt");
    fs::write(&file, text).unwrap();
    let table = ToolTable {
        file,
        format: Some(format.name.to_owned()),
        inch: Some(inch),
        reference: 0.0,
        columns: BTreeMap::new(),
        place: None,
        by_register: false,
        tools: None,
        findings: Vec::new(),
    };
    read(&Session::quiet(), &table, inch).unwrap()
}

#[test]
fn whatever_tools_are_written_are_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let (seeds, mut random) = randomised(60_u32, 29_003);
    for _ in seeds {
        let count = 1 + random.pick(12) as u32;
        let tools: Vec<ToolData> =
            (0..count).map(|place| any_tool(&mut random, 1 + 3 * place)).collect();
        let inch = random.pick(2) == 1;
        for format in FORMATS.iter().filter(|format| format.write.is_some()) {
            let text = format.write.unwrap()(&tools, TableUnits { inch });
            let found = again(folder.path(), format, &text, inch);
            assert!(!found.is_wrong(), "{}: {text}\n{:?}", format.name, found.findings);
            assert_eq!(found.tools.len(), tools.len(), "{}: {text}", format.name);
            for (was, is) in tools.iter().zip(&found.tools) {
                assert_eq!(was.number, is.number, "{}: {text}", format.name);
                // Radius and wear are rounded to a millionth of an inch each, and doubled.
                let most = 4.0 * 0.5e-6 * 25.4 + 1e-9;
                let close = |was: Option<f64>, is: Option<f64>| {
                    (was.unwrap_or(0.0) - is.unwrap_or(0.0)).abs() < most
                };
                assert!(close(was.total_length(), is.total_length()), "{}: {text}", format.name);
                if format.name != "machine" {
                    assert!(close(was.diameter(), is.diameter()), "{}: {text}", format.name);
                }
            }
        }
    }
}

/// Broken texts are told, and nothing falls over them.
#[test]
fn no_text_ends_a_reader() {
    let folder = tempfile::tempdir().unwrap();
    let (seeds, mut random) = randomised(120_u32, 29_004);
    for _ in seeds {
        let samples = [TBL, TNC, FANUC, SIEMENS, FUSION, CSV];
        let mut text: Vec<char> = random.choose(&samples).chars().collect();
        for _ in 0..=random.pick(6) {
            let at = random.pick(text.len());
            match random.pick(3) {
                0 => text[at] = *random.choose(&['\n', '"', '[', '9', '-', ';', 'é', '\t', '.']),
                1 => text.truncate(at.max(1)),
                _ => text.insert(at, *random.choose(&['(', ']', '=', '0', ' ', '\u{feff}', 'G'])),
            }
        }
        let text: String = text.into_iter().collect();
        for format in FORMATS {
            let found = again(folder.path(), format, &text, false);
            assert!(found.tools.iter().all(|tool| tool.number != 0));
        }
    }
}
