//! What a broken or hostile file can ask of the command: memory and work that end, no line that nobody wrote, nothing shown
//! of what is not meant. Linux alone: memory is limited by `ulimit`, by far below what each file took before.

use crate::common::{Run, command_as, run};

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Address space of a run, kB: what the command needs for a usual file, and a little more.
const SPACE: &str = "220000";

/// Seconds of processor time after which a run is killed; none here takes one.
const SECONDS: &str = "20";

/// Runs the command within its limits.
fn bounded(arguments: &[&str], input: &[u8]) -> Run {
    let mut shell = command_as("sh");
    shell
        .args(["-c", r#"ulimit -v "$1" && ulimit -t "$2" && shift 2 && exec "$@""#, "sh"])
        .args([SPACE, SECONDS, env!("CARGO_BIN_EXE_post")])
        .args(arguments);
    run(&mut shell, input)
}

/// Posts a text for `machine` to standard output.
fn posted(machine: &str, text: &str) -> Run {
    let with = ["-q", "-m", machine, "--tool-length", "100", "-o", "-", "-"];
    bounded(&with, text.as_bytes())
}

/// A file for `vmc` with these lines in it.
fn file(lines: &str) -> String {
    format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,50\n{lines}\nFINI\n"
    )
}

#[track_caller]
fn refused(run: &Run, parts: &[&str]) {
    assert_eq!(run.code, 1, "{}", run.err);
    assert_eq!(run.out, "");
    for part in parts {
        assert!(run.err.contains(part), "`{part}` is not in:\n{}", run.err);
    }
    assert!(run.err.len() < 60_000, "{} bytes of messages", run.err.len());
}

#[test]
fn curves_without_end_are_refused() {
    let spline = |knots: &str, points: &str| {
        file(&format!("NURBS/\nKNOT/{knots}\n{points}CNTRL/1,1,1\nGOTO/1,1,1"))
    };
    for (text, parts) in [
        (
            spline("1", "CNTRL/1e12,0,0\nCNTRL/0,1e12,0\n"),
            ["error[coordinate]", "1.000e12 mm", "1e7 mm", "CNTRL/1e12,0,0"],
        ),
        (
            spline("1e-300,1", "CNTRL/10,0,0\nCNTRL/0,10,0\nCNTRL/2,1,1\n"),
            ["error[spline]", "countless chords", "1000000 are possible", "GOTO/1,1,1"],
        ),
        (
            file("CIRCLE/1e11,0,0,0,0,1,1e11\nGOTO/0,0,50"),
            ["error[coordinate]", "1.000e11 mm", "1e7 mm", "GOTO/0,0,50"],
        ),
        (
            file("GOTO/0,10,0\nCIRCLE/0,0,0,0,0,1,10,TIMES,4000000000\nGOTO/10,0,-10"),
            ["error[arc]", "chords to stay within", "1000000 are possible", "GOTO/10,0,-10"],
        ),
        (
            file("CYCLE/DEEP,FEDTO,100,MMPM,200,RAPTO,3,STEP,1e-300\nGOTO/1,1,1"),
            ["error[cycle]", "10000 pecks", "CYCLE/DEEP", "moves"],
        ),
    ] {
        let run = posted("vmc", &text);
        refused(&run, &parts);
    }
}

#[test]
fn numbers_that_no_machine_has_are_refused_with_their_limit() {
    for (lines, parts) in [
        ("LOADTL/2,LENGTH,1e300", ["error[tool]", "1e300 mm", "1e7 mm"]),
        ("CUTTER/1e300", ["error[cutter]", "1e300", "1e7 mm"]),
        ("DELAY/1e300", ["error[dwell]", "1e300 s", "86400 s"]),
        ("DELAY/-1", ["error[dwell]", "-1 s", "86400 s"]),
        ("DELAY/1e300,REV", ["error[dwell]", "e298 s", "86400 s"]),
        ("SPINDL/RPM,1e300,CLW", ["error[spindle-speed]", "rpm", "SPINDL/RPM,1e300"]),
        ("FEDRAT/MMPM,1e300", ["error[feed]", "1e300 mm/min", "1000000 mm/min"]),
        ("FEDRAT/MMPR,1e6", ["error[feed]", "mm a revolution", "10000"]),
        ("FEDRAT/INVERS,1e300", ["error[feed]", "moves a minute", "1e9"]),
        ("GOTO/1e308,0,0", ["error[coordinate]", "1.000e308 mm", "1e7 mm"]),
        ("GODLTA/1e308", ["error[coordinate]", "1.000e308 mm", "1e7 mm"]),
        ("FROM/0,-1e9,0", ["error[coordinate]", "1.000e9 mm", "1e7 mm"]),
        ("GOTO/1,2,3,1e308,1e308,1", ["error[axis]", "no length", "direction"]),
        ("TLAXIS/1e308,1e308,1", ["error[axis]", "tool axis", "TLAXIS"]),
        ("ROTABL/AAXIS,1e300", ["error[rotabl]", "hundred turns", "ROTABL"]),
        ("MSYS/0,0,0,1e308,0,0,0,1e308,0", ["error[msys]", "unit vectors", "MSYS"]),
        (
            "CYCLE/DRILL,FEDTO,5,MMPM,100,RAPTO,3,DWELL,1e300\nGOTO/1,1,1",
            ["error[cycle]", "dwell of 1e300 s", "86400 s"],
        ),
        (
            "CYCLE/DRILL,FEDTO,1e300,MMPM,100,RAPTO,3\nGOTO/1,1,1",
            ["error[cycle]", "height of 1e300 mm", "1e7 mm"],
        ),
    ] {
        refused(&posted("vmc", &file(lines)), &parts);
    }
}

#[test]
fn flags_have_the_limits_of_the_file() {
    for (flag, value, part) in [
        ("--tool-length", "1e300", "1e7 mm"),
        ("--feed", "1e300", "1e6 mm/min"),
        ("--feed", "inf", "no number"),
        ("--tolerance", "nan", "no number"),
    ] {
        let run = bounded(&["-m", "vmc", flag, value, "-"], b"");
        assert_eq!(run.code, 2, "{}", run.err);
        assert!(run.err.contains(part), "{}", run.err);
    }
    let mount = bounded(&["-m", "vmc", "--mount", "1e308,0,0", "-"], b"");
    refused(&mount, &["none is larger than 1e12", "--set"]);
}

#[test]
fn words_and_findings_are_counted_to_an_end() {
    let letters = |number: usize| -> String {
        let digits = number.to_string();
        digits.bytes().map(|digit| char::from(digit - b'0' + b'A')).collect()
    };
    let mut words = String::new();
    for number in 0..200_000 {
        let _ = writeln!(words, "W{}/1", letters(number));
    }
    let run = posted("vmc", &file(&words));
    refused(&run, &["error[words]", "more than 1000 different words"]);
    let run = bounded(&["words", "-"], file(&words).as_bytes());
    refused(&run, &["more than 1000 different words"]);

    // A point that is searched for takes long where there is none.
    let mut far = String::new();
    for number in 0..5_000 {
        let _ = writeln!(far, "GOTO/{},9000,0", number % 1000);
    }
    let run = posted("tests/chains/scara.toml", &file(&far));
    refused(&run, &["no axis values of SCARA", "reading stopped there"]);

    // Sentences that differ in more than a number.
    let mut warnings = String::new();
    for number in 0..20_000 {
        let _ = writeln!(warnings, "INSERT M8 on for {}", letters(number));
    }
    let run = posted("vmc", &file(&warnings));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("… and 19900 more warnings"), "{}", run.err);
    assert!(run.err.len() < 100_000);

    let long = "X".repeat(900_000);
    refused(&posted("vmc", &file(&long)), &["a word of 900000 characters", "64"]);
    let run = posted("vmc", &file(&format!("FEDRAT/{long}")));
    refused(&run, &["error[syntax]", "…"]);
    let run = posted("vmc", &file(&format!("INSERT M8 {long}")));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.len() < 5_000);

    let mut tools = String::new();
    for number in 1..3_000 {
        let _ = writeln!(tools, "LOADTL/{number}\nSPINDL/RPM,1000,CLW\nGOTO/1,1,1");
    }
    let run = posted("vmc", &file(&tools));
    refused(&run, &["error[tool]", "more than 1000 different tools"]);
}

/// A machine file in a folder of its own, and the machine that it makes of `vmc`.
fn on(text: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::write(&path, text).unwrap();
    posted(path.to_str().unwrap(), &file("GOTO/1,1,1"))
}

#[test]
fn what_a_machine_file_holds_has_an_end() {
    let vmc = "extends = \"vmc\"\n";
    let mut chained = format!("{vmc}[parameters]\np0 = 1\np1 = 1\n");
    for number in 2..900 {
        let _ = writeln!(chained, "p{number} = \"(p{} + p{}) / 2\"", number - 1, number - 2);
    }
    let run = on(&chained);
    assert_eq!(run.code, 0, "{}", run.err);

    let entries = |table: &str, entry: &dyn Fn(usize) -> String, count: usize| {
        let entries: String = (0..count).map(|number| entry(number) + "\n").collect();
        format!("{vmc}[{table}]\n{entries}")
    };
    for (text, part) in [
        (entries("parameters", &|n| format!("p{n} = 1"), 1_001), "[parameters] has 1001 entries"),
        (entries("tools", &|n| format!("{n} = 1"), 50_000), "[tools] has 50000 entries"),
        (entries("cl.words", &|n| format!("W{n} = \"M1\""), 40_000), "[cl.words] has 40000"),
        (entries("control.fanuc", &|n| format!("o{n} = 1"), 60_000), "60000 options; at most 200"),
        (entries("head", &|n| format!("h{n} = {{}}"), 33), "33 heads; at most 32"),
        (entries("axis", &|n| format!("A{n}.cyclic = true"), 20_000), "axis.A1"),
        (format!("{vmc}chain = \"[w {} t]\"\n", "A1' ".repeat(100_000)), "1024 bytes"),
        (format!("{vmc}name = \"{}\"\n", "x".repeat(2_000_000)), "1048576 bytes"),
        (format!("{vmc}parameters.a = {}1{}\n", "[".repeat(9_999), "]".repeat(9_999)), "recursion"),
        (format!("{vmc}axis.X.travel = [-1e308, 1e308]\n"), "none is larger than 1e12"),
        (format!("{vmc}spindle.max_speed = 1e300\n"), "none is larger than 1e12"),
    ] {
        refused(&on(&text), &[part, "error"]);
    }
    refused(&posted("/dev/zero", &file("")), &["/dev/zero", "no regular file"]);
    refused(&posted("./machines", &file("")), &["./machines is a folder, no machine file"]);
}

#[test]
fn what_has_no_end_is_no_input() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("part.nc"), "G0 X1\nM30\n").unwrap();
    std::os::unix::fs::symlink("/dev/zero", at("list.jsonl")).unwrap();
    let (program, list, rows) = (at("part.nc"), at("list.jsonl"), at("rows.csv"));
    for (device, words) in [
        ("/dev/zero", &["-m", "vmc", "/dev/zero", "-o", "-"][..]),
        ("/dev/urandom", &["-m", "vmc", "/dev/urandom", "-o", "-"]),
        ("/dev/zero", &["words", "/dev/zero"]),
        ("/dev/zero", &["read", "/dev/zero", "-m", "vmc"]),
        ("/dev/urandom", &["lint", "/dev/urandom", "-m", "vmc"]),
        ("/dev/zero", &["verify", &program, "-m", "vmc", "--against", "/dev/zero"]),
        ("/dev/zero", &["predict", &program, "-m", "vmc", "--measured", "/dev/zero"]),
        ("/dev/zero", &["calibrate", "/dev/zero", "-m", "ac-trunnion"]),
        ("list.jsonl", &["batch", &list, "-m", "vmc", "-o", &rows]),
    ] {
        let done = bounded(words, b"");
        // `lint` ends with 1 where it has found something.
        let code = if words[0] == "lint" { 2 } else { 1 };
        assert_eq!(done.code, code, "{words:?}: {}", done.err);
        for part in [device, "no regular file"] {
            assert!(done.err.contains(part), "{words:?}: {}", done.err);
        }
    }
    // A CL file that cannot be read is a row of a batch.
    let done = bounded(&["batch", "/dev/zero", "-m", "vmc", "-o", &rows], b"");
    let row = fs::read_to_string(&rows).unwrap_or_default();
    assert!(format!("{row}{}", done.err).contains("no regular file"), "{row}{}", done.err);
}

/// Process substitution hands over a pipe by a name.
#[test]
fn a_pipe_with_a_name_is_an_input_and_a_table_in_it_is_bounded() {
    let piped = |script: &str| {
        let mut shell = command_as("bash");
        shell.args(["-c", script, env!("CARGO_BIN_EXE_post")]);
        run(&mut shell, file("GOTO/1,2,3").as_bytes())
    };
    let flags = "-q -m vmc --tool-length 100 -o -";
    let direct = piped(&format!("\"$0\" {flags} -"));
    assert_eq!(direct.code, 0, "{}", direct.err);
    for script in [format!("\"$0\" {flags} <(cat)"), format!("\"$0\" {flags} /dev/stdin")] {
        let done = piped(&format!("exec 3<&0; {}", script.replace("<(cat)", "<(cat <&3)")));
        // The program is called after its input.
        let body = |out: &str| out.lines().skip(2).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!((done.code, body(&done.out)), (0, body(&direct.out)), "{script}: {}", done.err);
    }
    let done = piped("ulimit -f 200000; \"$0\" calibrate <(yes 1,2,3,4,5,6,7,8) -m ac-trunnion");
    assert_eq!(done.code, 1, "{}", done.err);
    assert!(done.err.contains("it is larger than 64 MiB"), "{}", done.err);
}

#[test]
fn what_is_extended_is_a_machine_file_and_nothing_else_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(at("token.toml"), "token = \"SECRET\"\n").unwrap();
    fs::write(at("lines.toml"), "root:SECRET:1:2\n").unwrap();
    fs::write(at("latin.toml"), b"name = \"SECRET\xFF\"\n").unwrap();
    std::os::unix::fs::symlink("/etc/passwd", at("link.toml")).unwrap();
    fs::create_dir(at("folder.toml")).unwrap();
    let made = std::process::Command::new("mkfifo").arg(at("pipe.toml")).status();
    assert!(made.unwrap().success());
    std::os::unix::fs::symlink("/dev/zero", at("zero.toml")).unwrap();
    for (name, part) in [
        (at("token.toml"), "is no machine file"),
        (at("lines.toml"), "is no machine file"),
        (at("link.toml"), "is no machine file"),
        (at("latin.toml"), "UTF-8"),
        (at("folder.toml"), "is no regular file"),
        (at("pipe.toml"), "is no regular file"),
        (at("zero.toml"), "is no regular file"),
        ("/etc/passwd".to_owned(), "ends in .toml"),
        ("/dev/zero".to_owned(), "ends in .toml"),
    ] {
        let run = on(&format!("extends = {name:?}\nname = \"mine\"\n"));
        refused(&run, &["error[machine-extends]", part, "mine.toml:1"]);
        for secret in ["SECRET", "root:"] {
            assert!(!run.err.contains(secret), "{}", run.err);
        }
    }
}

#[test]
fn no_text_of_a_machine_file_becomes_a_second_line() {
    for text in [
        "name = \"V\\nM30\"",
        "control.dialect = \"fanuc\\r\"",
        "head.2.word = \"M62\\u2028M30\"",
        "head.\"2\\nM30\".word = \"M62\"",
        "axis.X.indexed = 0\naxis.X.clamp = \"M10\\nM30\"\naxis.X.unclamp = \"M11\"",
        "control.fanuc.retract = [\"G91 G28 Z0\\nM30\"]",
        "cl.words.OFSETL = [\"G54\", \"G55\\u001B\"]",
        "cl.words.\"X\\u0085\" = \"G54\"",
        "parameters.\"a\\u202E\" = 1",
    ] {
        let run = on(&format!("extends = \"vmc\"\n{text}\n"));
        refused(&run, &["error[machine-text]", "this text holds U+", "mine.toml:"]);
        assert!(!run.err.contains('\u{1B}') && !run.err.contains('\u{202E}'));
    }
    let set = ["-q", "-m", "vmc", "--set", "name=a\nM30", "-o", "-", "-"];
    refused(&bounded(&set, file("").as_bytes()), &["error[setting]", "--set name=a\\u{a}M30"]);
}

#[test]
fn texts_of_a_cl_file_stay_in_their_line() {
    let lines = "TOOL PATH/A\u{2028}M30,TOOL,T\u{2029}M30\nPPRINT a\u{2028}M30\nPPRINT b\u{85}M31\nPPRINT c\u{202E}M32\nPPRINT d\u{9B}31m\nEND-OF-PATH";
    let run = posted("vmc", &file(lines));
    assert_eq!(run.code, 0, "{}", run.err);
    let odd = |letter: char| letter != '\n' && post_grammar::text::is_unprintable(letter);
    assert!(!run.out.contains(odd), "{}", run.out);
    assert!(run.out.contains("(A M30)") && run.out.contains("(B M31)"), "{}", run.out);
    for line in run.out.lines() {
        assert!(!line.starts_with("M31") && !line.starts_with("M32"), "{line}");
    }
    let with = ["-q", "-m", "vmc", "--set", "control.insert=literal", "-o", "-", "-"];
    let text = file("INSERT G4 X1\u{2028}M30");
    refused(&bounded(&with, text.as_bytes()), &["error[insert]", "U+2028", "G4 X1\\u{2028}M30"]);
}

#[test]
fn what_a_terminal_would_obey_is_escaped_wherever_it_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a\u{1B}[31m\nM30.cls");
    fs::write(&path, file("NOSUCH\u{9B}1m/1\nGOTO/1,1,1")).unwrap();
    let program = folder.path().join("b\u{1B}[2J.nc");
    let path = path.to_str().unwrap();
    let program = program.to_str().unwrap();
    let mut runs = vec![
        bounded(&["-m", "vmc", "--tool-length", "9", path, "-o", program], b""),
        bounded(&["-m", "no\u{1B}such", path], b""),
        bounded(&["words", "no\u{1B}such"], b""),
        bounded(&["--no\u{1B}such", path], b""),
    ];
    fs::write(path, file("GOTO/1,1,1")).unwrap();
    runs.push(bounded(&["-m", "vmc", "--tool-length", "9", path, "-o", program], b""));
    assert_eq!(runs[4].code, 0, "{}", runs[4].err);
    for run in &runs {
        let odd = |letter: char| letter != '\n' && letter.is_control();
        assert!(!run.err.contains(odd), "{:?}", run.err);
        assert!(!run.out.contains(odd), "{:?}", run.out);
    }
    // The program is named after its file, in one line.
    let without = bounded(&["-q", "-m", "vmc", "--tool-length", "9", "-o", "-", path], b"");
    assert_eq!(without.code, 0, "{}", without.err);
    assert!(!without.out.contains('\u{1B}') && !without.out.lines().any(|line| line == "M30.CLS"));
    assert!(Path::new(program).exists());
}
