//! Text of one's own in programs, several programs of one CL file, the setup sheet.

use std::fs;
use std::path::Path;

use crate::common::{Run, command, run};

const CL: &str = "UNITS/MM
TOOL PATH/ROUGH,TOOL,MILL10
TLDATA/MILL,10.0,0.0,75.0,0.0,0.0
LOAD/TOOL,1
SPINDL/RPM,3000,CLW
COOLNT/FLOOD
RAPID
GOTO/0,0,50
FEDRAT/600,MMPM
GOTO/0,0,15
END-OF-PATH
TOOL PATH/FINISH,TOOL,MILL6
TLDATA/MILL,6.0,0.0,75.0,0.0,0.0
LOAD/TOOL,2
SPINDL/RPM,5000,CLW
RAPID
GOTO/0,0,50
FEDRAT/300,MMPM
GOTO/20,0,14
END-OF-PATH
TOOL PATH/CHAMFER,TOOL,MILL6
RAPID
GOTO/0,0,50
FEDRAT/200,MMPM
GOTO/20,0,13
END-OF-PATH
";

const TEXT: &str = r#"extends = "vmc"
[program]
header = ["({{ program.name }})", "{% for tool in program.tools %}", "(T{{ tool.number }} {{ tool.name }} D{{ tool.diameter|fixed(1) }})", "{% endfor %}"]
between_tools = "M1"
preselect = true
extension = "eia"
"#;

fn post(folder: &Path, machine: &str, arguments: &[&str], input: &str) -> Run {
    let file = folder.join("mine.toml");
    fs::write(&file, machine).unwrap();
    let mut all = vec!["-q", "-m", "mine.toml", "--tool-length", "100"];
    all.extend(arguments);
    run(command().current_dir(folder).args(all), input.as_bytes())
}

#[track_caller]
fn good(done: Run) -> String {
    assert_eq!(done.code, 0, "{}", done.err);
    done.out
}

/// What is known ahead is known of standard input too.
#[test]
fn a_header_lists_the_tools_of_a_file_and_of_standard_input() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), CL).unwrap();
    good(post(folder.path(), TEXT, &["part.cls"], ""));
    let written = fs::read_to_string(folder.path().join("part.eia")).unwrap();
    let piped = good(post(folder.path(), TEXT, &["-o", "-", "-"], CL));
    for (program, name) in [(&written, "part"), (&piped, "PROGRAM")] {
        let tools = format!("({name})\n(T1 MILL10 D10.0)\n(T2 MILL6 D6.0)\n");
        assert!(program.contains(&tools), "{program}");
        assert_eq!(program.matches("\nM1\n").count(), 1, "{program}");
        assert!(program.contains("T1 M6\nT2\n") && program.contains("T2 M6\nS5000"), "{program}");
    }
}

/// Each program has a frame and the state of its own: tool, spindle and coolant as the lines before it left them.
#[test]
fn operations_and_tools_become_programs_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), CL).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let machine = "extends = \"vmc\"\n";
    let with = [
        "part.cls",
        "-o",
        "a.nc",
        "--split",
        "operations",
        "--number",
        "100",
        "--summary",
        "a.json",
    ];
    good(post(folder.path(), machine, &with, ""));
    let programs = ["a-1.nc", "a-2.nc", "a-3.nc"].map(read);
    for (program, [number, name, tool, spindle]) in programs.iter().zip([
        ["O0100", "(ROUGH)", "T1 M6", "S3000 M3"],
        ["O0101", "(FINISH)", "T2 M6", "S5000 M3"],
        ["O0102", "(CHAMFER)", "T2 M6", "S5000 M3"],
    ]) {
        for word in [number, name, tool, spindle, "M8", "G54", "M30"] {
            assert!(program.contains(word), "{word}\n{program}");
        }
        assert_eq!(program.matches(" M6").count(), 1, "{program}");
        assert_eq!(program.matches("G43").count(), 1, "{program}");
    }
    let summary: serde_json::Value = serde_json::from_str(&read("a.json")).unwrap();
    assert_eq!(summary.as_array().unwrap().len(), 3);

    good(post(folder.path(), TEXT, &["part.cls", "-o", "b.nc", "--split", "tools"], ""));
    let [first, second] = ["b-1.nc", "b-2.nc"].map(read);
    assert!(first.contains("(T1 MILL10") && !first.contains("T2"), "{first}");
    assert!(second.contains("(T2 MILL6") && !second.contains("T1 "), "{second}");
    assert!(second.contains("FINISH") && second.contains("CHAMFER"), "{second}");
    assert!(!folder.path().join("b-3.nc").exists());

    let none = post(folder.path(), machine, &["-o", "-", "part.cls", "--split", "tools"], "");
    assert!(none.code == 1 && none.err.contains("standard output takes one"), "{}", none.err);
}

/// The sheet is written with the program, or not at all.
#[test]
fn a_setup_sheet_says_what_is_to_be_set_up() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let cl = CL.replace("MILL6", "MILL<6>");
    fs::write(folder.path().join("part.cls"), &cl).unwrap();
    for sheet in ["sheet.md", "sheet.html"] {
        good(post(folder.path(), TEXT, &["part.cls", "--setup-sheet", sheet], ""));
    }
    let markdown = read("sheet.md");
    for part in [
        "# Setup: part.cls",
        "| 2 | 2 |  | MILL&lt;6> |  | 100.000 |  | 6.000 |",
        "| upright | 13.000 |",
        "X 0.000, Y 0.000, Z -600.000 mm, without a tool",
        "| X | 0.000 to 20.000 |",
        "Z 13.000 to 50.000 mm",
    ] {
        assert!(markdown.contains(part), "{part}\n{markdown}");
    }
    let html = read("sheet.html");
    // Seen from a side on which the axes of the part are right-handed: from X to Y against the clock.
    let axis = |colour: &str| {
        let line = html.lines().find(|line| line.contains(colour)).unwrap();
        let numbers = line.split('"').nth(1).unwrap().trim_start_matches('M').split(' ');
        let ends: Vec<f64> = numbers.map(|number| number.parse().unwrap()).collect();
        [ends[2] - ends[0], ends[1] - ends[3]]
    };
    let [[x, up_of_x], [y, up_of_y], [aside, up]] = ["#b00", "#080", "#00b"].map(axis);
    assert!(x * up_of_y - up_of_x * y > 0.0 && up > 0.0 && aside.abs() < 0.1, "{html}");
    assert!(html.contains("<td>MILL&lt;6&gt;</td>") && html.contains(">T1 T2</text>"), "{html}");

    fs::write(folder.path().join("bad.cls"), CL.replace("GOTO/20,0,14", "GOTO/20000,0,14"))
        .unwrap();
    let bad = post(folder.path(), TEXT, &["bad.cls", "--setup-sheet", "bad.md"], "");
    assert_eq!(bad.code, 1, "{}", bad.err);
    assert!(!folder.path().join("bad.md").exists() && !folder.path().join("bad.eia").exists());
}

/// A slip in a template is underlined where it stands, and nothing is posted.
#[test]
fn a_template_with_a_slip_shows_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\n[program]\nfooter = [\"(END)\", \"({{ program.nmae }})\"]\n";
    let done = post(folder.path(), machine, &["-o", "-", "-"], CL);
    assert_eq!(done.code, 1);
    for part in ["error[program-text]", "mine.toml:3", "program.nmae", "undefined"] {
        assert!(done.err.contains(part), "{part}\n{}", done.err);
    }
    assert_eq!(done.out, "");
}

/// Lines for operations of a file that names none are not lost in silence.
#[test]
fn texts_for_operations_want_operations() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\n[program]\nbefore_operation = \"M1\"\n";
    let plain: String = CL
        .lines()
        .filter(|line| !line.starts_with("TOOL PATH") && !line.starts_with("END-OF"))
        .map(|line| format!("{line}\n"))
        .collect();
    let done = post(folder.path(), machine, &["-o", "-", "-"], &plain);
    assert_eq!(done.code, 0, "{}", done.err);
    let told = "before_operation is written nowhere: the CL file names no operation";
    assert!(done.err.contains(told), "{}", done.err);
    let done = post(folder.path(), machine, &["-o", "-", "-"], CL);
    assert!(!done.err.contains("written nowhere"), "{}", done.err);
}

/// A program that ends as a subprogram does, with lines that no word of the control explains: `verify` reads it, passes
/// what the machine file declares, and says so.
#[test]
fn a_program_with_lines_of_one_s_own_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"
[cl.words]
TOUCH = "G65 P9811 Z{n*unit:.3}"
[program]
first_lines = "(FOR {{ program.name }})"
last_lines = "(LAST)"
end = "M99"
tool_change = "T{{ tool.number }} M6 (S{{ tool.speed|fixed(0) }})"
after_tool_change = ["{% if tool.number == 2 %}", "M551", "{% endif %}"]
before_operation = "({{ operation.name }} F{{ operation.feed|fixed(0) }} {% if spindle is none %}STANDS{% endif %})"
"#;
    let machine = format!("extends = \"vmc\"\n{text}");
    let cl = CL.replacen("END-OF-PATH", "TOUCH/-5.2\nEND-OF-PATH", 1);
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    good(post(folder.path(), &machine, &["part.cls", "-o", "a.nc"], ""));
    let program = fs::read_to_string(folder.path().join("a.nc")).unwrap();
    assert!(program.starts_with("(FOR a)\n%\nO1000 (A)\n"), "{program}");
    assert!(program.ends_with("\nM99\n%\n(LAST)\n") && !program.contains("M30"), "{program}");
    for line in [
        "(ROUGH F600 STANDS)",
        "(FINISH F300 )",
        "T2 M6 (S5000)\nM551\nS5000 M3",
        "G65 P9811 Z-5.200",
    ] {
        assert!(program.contains(&format!("{line}\n")), "{line}\n{program}");
    }
    let verify = |program: &str| {
        fs::write(folder.path().join("a.nc"), program).unwrap();
        let verb = ["verify", "-q", "-m", "mine.toml", "--tool-length", "100"];
        let files = ["--against", "part.cls", "a.nc"];
        run(command().current_dir(folder.path()).args(verb).args(files), b"")
    };
    let read = verify(&program);
    assert_eq!(read.code, 0, "{}", read.err);
    assert!(read.err.contains("nc-own-line") && !read.err.contains("M551"), "{}", read.err);
    // A macro that the machine file does not declare, and a word that no line of it has.
    for (other, told) in [("G65 P9812 Z-5.200", "`O9812` is called"), ("M552", "M552 is not known")]
    {
        let own = if other.starts_with('G') { "G65 P9811 Z-5.200" } else { "M551" };
        let read = verify(&program.replace(own, other));
        assert!(read.err.contains(told), "{told}: {}", read.err);
    }
    // What a motion lacks is refused, whatever the machine file declares.
    let wrong = program.replace("G65 P9811 Z-5.200", "G1 X500. Z-5.200");
    assert_eq!(verify(&wrong).code, 1);
}

/// Controls of other languages end a subprogram by words of theirs; the frame of the file stays.
#[test]
fn the_end_of_a_program_is_the_machine_file_s_in_each_language() {
    let folder = tempfile::tempdir().unwrap();
    for (machine, end, last) in [
        ("ac-trunnion-840d", "M17", " M17\n; LAST\n"),
        ("dmu50", "LBL 0", " END PGM A MM\n; LAST\n"),
    ] {
        let text = format!(
            "extends = \"{machine}\"\n[program]\nend = \"{end}\"\nlast_lines = \"; LAST\"\n"
        );
        fs::write(folder.path().join("part.cls"), CL).unwrap();
        good(post(folder.path(), &text, &["part.cls", "-o", "a.nc"], ""));
        let program = fs::read_to_string(folder.path().join("a.nc")).unwrap();
        assert!(program.ends_with(last), "{program}");
        assert!(program.contains(&format!(" {end}\n")), "{program}");
        assert!(!program.contains("M30"), "{program}");
        let verb = ["verify", "-q", "-m", "mine.toml", "--tool-length", "100"];
        let files = ["--against", "part.cls", "a.nc"];
        let read = run(command().current_dir(folder.path()).args(verb).args(files), b"");
        assert_eq!(read.code, 0, "{}", read.err);
    }
}

/// Operations are programs that end as subprograms do, and one calls them in their order.
#[test]
fn a_program_calls_those_of_the_operations() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), CL).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let called = ["part.cls", "-o", "a.nc", "--split", "operations", "--caller", "--verify"];
    let numbered = [&called[..], &["--number", "100"]].concat();
    good(post(folder.path(), "extends = \"vmc\"\n", &numbered, ""));
    let main = read("a.nc");
    for line in
        ["O0100 (A)", "(ROUGH)\nM98 P101", "(FINISH)\nM98 P102", "(CHAMFER)\nM98 P103\nM5\nM9\nM30"]
    {
        assert!(main.contains(&format!("{line}\n")), "{line}\n{main}");
    }
    for (name, number) in [("a-1.nc", "O0101"), ("a-2.nc", "O0102"), ("a-3.nc", "O0103")] {
        let program = read(name);
        assert!(program.contains(number) && program.ends_with("\nM99\n%\n"), "{program}");
        assert!(!program.contains("M30"), "{program}");
    }
    // All in one file they are one program of the control, and that does what the CL file asks for.
    let tapes = ["a-1.nc", "a-2.nc", "a-3.nc"].map(|name| read(name).replacen("%\n", "", 1));
    let whole = [&main, &tapes[0], &tapes[1], &tapes[2]].map(|tape| tape.trim_end_matches("%\n"));
    fs::write(folder.path().join("all.nc"), whole.concat() + "%\n").unwrap();
    let verb = ["verify", "-q", "-m", "mine.toml", "--tool-length", "100"];
    let held = run(
        command().current_dir(folder.path()).args(verb).args(["--against", "part.cls", "all.nc"]),
        b"",
    );
    assert_eq!(held.code, 0, "{}", held.err);

    good(post(folder.path(), "extends = \"ac-trunnion-840d\"\n", &called, ""));
    let main = read("a.nc");
    assert!(
        main.contains(" a_1\n") && main.contains(" a_3\n") && main.ends_with("M30\n"),
        "{main}"
    );
    assert!(read("a_2.nc").ends_with(" M17\n"));
    // A control whose programs end otherwise, one program, and a machine file that says how.
    for (machine, arguments, why) in [
        ("dmu50", &called[..], "says no word that ends a program"),
        ("vmc", &["part.cls", "-o", "a.nc", "--caller"], "--caller calls several programs"),
    ] {
        let done = post(folder.path(), &format!("extends = \"{machine}\"\n"), arguments, "");
        assert!(done.code == 1 && done.err.contains(why), "{}", done.err);
    }
    let text = "extends = \"dmu50\"\n[program]\nend = \"; CALLED\"\n";
    good(post(folder.path(), text, &called, ""));
    let main = read("a.nc");
    assert!(main.contains("CALL PGM a_1") || main.contains("CALL PGM A_1"), "{main}");
    assert!(main.contains(" M30\n") && !read("a_1.nc").contains("M30"), "{main}");
}

/// Lines that the CL file has letter for letter are lines of the user's own too.
#[test]
fn lines_of_the_cl_file_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let cl = CL.replacen("END-OF-PATH", "INSERT G65 P9811 Z-5.2\nPPRINT/G65 P9833\nEND-OF-PATH", 1);
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let machine = |print| {
        format!("extends = \"vmc\"\n[control]\ninsert = \"literal\"\nprint = \"{print}\"\n")
    };
    good(post(folder.path(), &machine("literal"), &["part.cls", "-o", "a.nc", "--verify"], ""));
    let program = fs::read_to_string(folder.path().join("a.nc")).unwrap();
    assert!(program.contains("\nG65 P9811 Z-5.2\nG65 P9833\n"), "{program}");
    let other = program.replace("P9833", "P9834");
    fs::write(folder.path().join("a.nc"), other).unwrap();
    let verb = ["verify", "-q", "-m", "mine.toml", "--tool-length", "100"];
    let files = ["--against", "part.cls", "a.nc"];
    let read = run(command().current_dir(folder.path()).args(verb).args(files), b"");
    assert!(read.code == 1 && read.err.contains("`O9834` is called"), "{}", read.err);
    assert!(read.err.contains("`G65 P9811 Z-5.2` is a line of the user's own"), "{}", read.err);
    good(post(folder.path(), &machine("comment"), &["part.cls", "-o", "a.nc"], ""));
    let program = fs::read_to_string(folder.path().join("a.nc")).unwrap();
    assert!(program.contains("\n(G65 P9833)\n"), "{program}");
}

/// A block of several lines of a conversational control has one number, and is read back as one.
#[test]
fn a_probing_cycle_of_several_lines_is_one_block() {
    let folder = tempfile::tempdir().unwrap();
    let cl = CL.replacen("END-OF-PATH", "TOUCH/-1,2.5,-5.2\nEND-OF-PATH", 1);
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let machine = r#"extends = "dmu50"
[cl.words]
TOUCH = ["TCH PROBE 427 MEASURE COORDINATE ~", "Q263={n*unit:.3} ;1ST POINT ~", "Q264={n2*unit:.3} ;2ND POINT ~", "Q261={n3*unit:.3} ;HEIGHT"]
"#;
    let done = post(folder.path(), machine, &["part.cls", "-o", "a.h", "--verify"], "");
    assert_eq!(done.code, 0, "{}", done.err);
    let program = fs::read_to_string(folder.path().join("a.h")).unwrap();
    let block = " TCH PROBE 427 MEASURE COORDINATE ~\nQ263=-1.000 ;1ST POINT ~\nQ264=2.500 ;2ND POINT ~\nQ261=-5.200 ;HEIGHT\n";
    assert!(program.contains(block), "{program}");
}

/// The raw part is told to the control by its dialect, or by lines of the machine file.
#[test]
fn the_stock_stands_in_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let stock = "[stock]\nblock = [[-5, -5, -10], [35, 5, 20.5]]\n";
    let form = "extends = \"dmu50\"\n[control.heidenhain]\nblk_form = true\n";
    let lines = |machine: &str| good(post(folder.path(), machine, &["-o", "-", "-"], CL));
    let written = lines(&format!("{form}{stock}"));
    let told =
        " BLK FORM 0.1 Z X-5.000 Y-5.000 Z-10.000\n2 BLK FORM 0.2 X+35.000 Y+5.000 Z+20.500\n";
    assert!(written.contains(told), "{written}");
    let text =
        "extends = \"vmc\"\n[program]\nheader = \"(FROM {{ program.stock.min[2]|fixed(1) }})\"\n";
    assert!(lines(&format!("{text}{stock}")).contains("(FROM -10.0)"));
    let flat = stock.replace("35, 5,", "35, -5,");
    let done = post(folder.path(), &format!("{form}{flat}"), &["-o", "-", "-"], CL);
    assert!(done.code == 1 && done.err.contains("machine-body"), "{}", done.err);
}
