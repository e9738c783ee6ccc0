//! What is said between the moves, as the dialect is asked for it: which events, and in which order.

use std::fs;

use post_machine::description::{Machine, Source, load};
use post_plugin::Capabilities;
use post_posting::{JobFacts, PostingRequest, ProgramPreview};
use post_testkit::repository;
use post_testruns::posted::{Recorder, Run, Samples, watched};

/// The machine `name` of the library, refined by `more`.
fn machine(name: &str, more: &str) -> Machine {
    let source =
        Source { name: "mine.toml".to_owned(), text: format!("extends = {name:?}\n{more}") };
    load(source, &[], &mut library).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn library(name: &str) -> Result<Source, String> {
    let path = repository().join(format!("machines/{name}.toml"));
    Ok(Source { text: fs::read_to_string(&path).unwrap(), name: path.display().to_string() })
}

/// Posts for a dialect that declares `writes`. `;` ends a line.
fn posted(machine: &Machine, writes: Capabilities, cl: &str) -> Run {
    posted_as(machine, writes, cl, JobFacts::default())
}

fn posted_as(machine: &Machine, writes: Capabilities, cl: &str, facts: JobFacts) -> Run {
    let mut dialect = Recorder::new(machine, 3);
    dialect.capabilities = writes;
    let job = PostingRequest { tool_length: Some(100.0), facts, ..PostingRequest::default() };
    let cl = format!("UNITS/MM;{cl};FINI;").replace(';', "\n");
    watched(machine, dialect, &cl, job, &mut Samples, &mut [])
}

/// The kinds of all events behind the first retract but the moves, in order.
fn kinds(run: &Run) -> String {
    let asked = run.asked.iter().skip(2);
    let kinds: Vec<&str> =
        asked.map(|asked| asked.kind).filter(|kind| !matches!(*kind, "Linear" | "Rapid")).collect();
    kinds.join(" ")
}

/// The event of a kind, as it prints.
#[track_caller]
fn event<'r>(run: &'r Run, kind: &str) -> &'r str {
    let asked = run.asked.iter().find(|asked| asked.kind == kind);
    &asked.unwrap_or_else(|| panic!("no {kind}: {} / {}", kinds(run), run.told())).event
}

const CUT: &str = "SPINDL/3000,RPM,CLW;RAPID;GOTO/0,0,50;FEDRAT/100,MMPM;GOTO/0,0,10;GOTO/9,0,10";

/// Counted from the offset before, the way down leads somewhere else.
#[test]
fn a_work_offset_comes_with_the_tool_retracted() {
    let vmc = machine("vmc", "");
    let cl = format!(
        "LOADTL/1;SET/OFSETL,1;{CUT};OFSETL/2;RAPID;GOTO/0,0,50;FEDRAT/90,MMPM;GOTO/0,0,9;OFSETL/2;GOTO/9,0,9"
    );
    let run = posted(&vmc, Capabilities::WORK_OFFSET, &cl).good("two offsets");
    assert_eq!(
        kinds(&run),
        "ToolChange WorkOffset Spindle Position Retract WorkOffset Position Retract Spindle End"
    );
    assert!(event(&run, "WorkOffset").contains("number: 1"));
    assert!(run.told().contains("travel was checked with the part where"), "{}", run.told());

    // A control that has no such words gets none, and nobody is left in doubt.
    let run = posted(&vmc, Capabilities::NONE, &cl);
    assert!(run.report.is_none());
    assert_eq!(run.findings[0].code, "refused-word");
    assert_eq!(run.findings[0].place.as_ref().unwrap().line, 3);
    // Is 55 the second offset, or the fifty-fifth?
    for (word, why) in [("OFSETL/0", "counted from 1"), ("SET/OFSETL,55", "it may be G55")] {
        let run = posted(&vmc, Capabilities::WORK_OFFSET, &format!("LOADTL/1;{word};{CUT}"));
        assert!(run.report.is_none() && run.told().contains(why), "{}", run.told());
    }
}

/// With axis positions for words, a part on another place of a table that turns needs other words.
#[test]
fn another_offset_is_another_mount_where_the_table_turns() {
    let cl = format!("LOADTL/1;OFSETL/1;{CUT};OFSETL/2;RAPID;GOTO/0,0,50");
    for (tcp, good) in [("post", false), ("control", true)] {
        let machine = machine("ac-trunnion", &format!("[control]\ntcp = {tcp:?}\n"));
        let run = posted(&machine, Capabilities::WORK_OFFSET, &cl);
        assert_eq!(run.report.is_some(), good, "{tcp}: {}", run.told());
    }
}

/// Smoothing and the keeping of the tip end before a tool change and begin behind it, the tip last.
#[test]
fn what_the_control_keeps_ends_before_a_tool_change() {
    let more = "[control]\ntcp = \"control\"\n[program.smoothing]\ntolerance = 0.01\naxis_tolerance = 0.05\n";
    let machine = machine("ac-trunnion", more);
    let writes = Capabilities::SMOOTHING | Capabilities::TCP_SWITCH;
    let cl = format!("LOADTL/1;{CUT};LOADTL/2;{CUT};GOHOME;{CUT}");
    let run = posted(&machine, writes, &cl).good("two tools");
    let near = "Turn Smoothing Tcp Position";
    let away = "Tcp Retract SmoothingOff";
    let of = kinds(&run);
    assert_eq!(of.matches(near).count(), 3, "{of}");
    assert_eq!(of.matches(away).count(), 3, "{of}");
    assert!(of.contains("Tcp Retract SmoothingOff Spindle ToolChange"), "{of}");
    assert_eq!(
        event(&run, "Smoothing"),
        "Smoothing { tolerance: 0.01, axis_tolerance: Some(0.05) }"
    );
    let switched: Vec<bool> = run
        .asked
        .iter()
        .filter(|asked| asked.kind == "Tcp")
        .map(|asked| asked.event.contains("true"))
        .collect();
    assert!(switched.chunks(2).all(|pair| matches!(pair, [false, true] | [false])), "{switched:?}");
}

/// An operation that must be kept closer begins anew with its own tolerance, the tool retracted.
#[test]
fn smoothing_goes_by_the_operation() {
    let more = "[program.smoothing]\noperations = { \"ROUGH*\" = 0.05, \"ROUGH_FINE\" = 0.02 }\n";
    let vmc = machine("vmc", more);
    let of = |name: &str| format!("TOOL PATH/{name},TOOL,T;{CUT};END-OF-PATH");
    let names = ["rough_1", "ROUGH_2", "ROUGH_FINE", "FINISH"].map(of).join(";");
    let run =
        posted(&vmc, Capabilities::SMOOTHING, &format!("LOADTL/1;{names}")).good("rough and fine");
    let told: Vec<&str> = run
        .asked
        .iter()
        .filter(|asked| asked.kind.starts_with("Smooth"))
        .map(|asked| asked.event.as_str())
        .collect();
    assert_eq!(
        told,
        [
            "Smoothing { tolerance: 0.05, axis_tolerance: None }",
            "SmoothingOff",
            "Smoothing { tolerance: 0.02, axis_tolerance: None }",
            "SmoothingOff",
        ]
    );
    assert!(kinds(&run).contains("Retract SmoothingOff"), "{}", kinds(&run));
}

#[test]
#[should_panic(expected = "has no words for smoothing")]
fn smoothing_that_the_dialect_lacks_is_refused() {
    let vmc = machine("vmc", "[program.smoothing]\ntolerance = 0.01\n");
    posted(&vmc, Capabilities::NONE, CUT);
}

/// The same tool by another register is not changed, but its length is another.
#[test]
fn another_register_is_no_tool_change_where_the_dialect_knows_registers() {
    let vmc = machine("vmc", "");
    let cl =
        format!("LOADTL/1;{CUT};LOADTL/1,ADJUST,21;RAPID;GOTO/0,0,50;FEDRAT/9,MMPM;GOTO/0,0,9");
    let run = posted(&vmc, Capabilities::OFFSETS, &cl).good("two registers");
    assert!(kinds(&run).contains("Position Retract Offsets Position"), "{}", kinds(&run));
    assert_eq!(event(&run, "Offsets"), "Offsets { length: Some(21), radius: None }");
    let run = posted(&vmc, Capabilities::NONE, &cl).good("two registers");
    assert_eq!(kinds(&run).matches("ToolChange").count(), 2);
}

/// Behind a subprogram nothing is known: the tool is retracted, and spindle and coolant are said again.
#[test]
fn behind_a_subprogram_all_is_said_again() {
    let vmc = machine("vmc", "");
    let cl = format!(
        "LOADTL/1;COOLNT/MIST;{CUT};CALSUB/1000;RAPID;GOTO/0,0,50;FEDRAT/9,MMPM;GOTO/0,0,9"
    );
    let run = posted(&vmc, Capabilities::SUBPROGRAM, &cl).good("a subprogram");
    assert!(
        kinds(&run).contains("Position Subprogram Retract Spindle Coolant Position"),
        "{}",
        kinds(&run)
    );
    assert!(event(&run, "Subprogram").contains("number: Some(1000), times: 1"));
    assert_eq!(run.findings.len(), 1, "{}", run.told());
    assert!(run.told().contains("what subprogram 1000 does is not checked"));
    assert!(posted(&vmc, Capabilities::NONE, &cl).told().contains("no words for a subprogram"));
}

/// On a mill SFM is that of the cutter's diameter; a spindle that turns the part keeps it, never without a limit.
#[test]
fn a_cutting_speed_is_kept_where_the_spindle_turns_the_part() {
    let mill = machine("vmc", "");
    let cut = "RAPID;GOTO/0,0,50;FEDRAT/100,MMPM;GOTO/0,0,10";
    let cl = |words: &str| format!("CUTTER/10;LOADTL/1;SPINDL/{words};{cut}");
    let run = posted(&mill, Capabilities::SURFACE_SPEED, &cl("SMM,100,CLW")).good("a mill");
    assert!(event(&run, "Spindle").contains("rpm: 3183.09"), "{}", event(&run, "Spindle"));
    let run =
        posted(&mill, Capabilities::SURFACE_SPEED, &cl("SMM,100,MAXRPM,2000,CLW")).good("a mill");
    assert!(event(&run, "Spindle").contains("rpm: 2000.0"), "{}", event(&run, "Spindle"));

    let more = "[spindle]\nsurface_speed = true\nmax_speed = 4000\n";
    let lathe = machine("vmc", more);
    for (words, told) in [
        ("SMM,100,CLW", "speed: 100.0, most: Some(4000.0), sense: Clockwise"),
        ("SFM,500,CCLW,MAXRPM,2500", "speed: 152.4, most: Some(2500.0), sense: CounterClockwise"),
    ] {
        let run = posted(&lathe, Capabilities::SURFACE_SPEED, &cl(words)).good(words);
        assert!(event(&run, "SurfaceSpeed").contains(told), "{}", event(&run, "SurfaceSpeed"));
        // Off for the tool change, and on again as it was.
        assert!(!kinds(&run).contains("Spindle ToolChange"));
    }
    for (machine, words, writes, why) in [
        (&lathe, "SMM,100", Capabilities::NONE, "no words for a constant cutting speed"),
        (&lathe, "SMM,100,MAXRPM,5000", Capabilities::SURFACE_SPEED, "its largest speed is 4000"),
        (&lathe, "SMM,-1", Capabilities::SURFACE_SPEED, "above zero"),
    ] {
        let run = posted(machine, writes, &cl(words));
        assert!(run.report.is_none() && run.told().contains(why), "{words}: {}", run.told());
    }
    let endless = self::machine("router", "[spindle]\nsurface_speed = true\n");
    if endless.spindle.max.is_infinite() {
        let run = posted(&endless, Capabilities::SURFACE_SPEED, &cl("SMM,100"));
        assert!(run.told().contains("without a limit"), "{}", run.told());
    }
}

/// A message of the operator's where the control has a screen for it.
#[test]
fn pprint_is_a_message_where_the_machine_file_says_so() {
    for (more, writes, kind) in [
        ("", Capabilities::MESSAGE, "Comment"),
        ("[control]\nprint = \"message\"\n", Capabilities::MESSAGE, "Message"),
        ("[control]\nprint = \"message\"\n", Capabilities::NONE, "Comment"),
    ] {
        let run =
            posted(&machine("vmc", more), writes, &format!("LOADTL/1;PPRINT TURN THE PART;{CUT}"));
        assert_eq!(event(&run, kind), format!("{kind} {{ text: \"TURN THE PART\" }}"));
    }
}

/// Text of one's own: before and behind what it names, filled with what is known there.
#[test]
fn texts_of_the_machine_file_stand_where_they_belong() {
    let more = r#"[program]
header = ["({{ program.name }} FOR {{ program.cl_file }})", "{% for tool in program.tools %}", "(T{{ tool.number }})", "{% endfor %}"]
footer = "(END)"
between_tools = "M1"
tool_change = "T{{ tool.number }} M16"
after_tool_change = "(BEHIND {% if last_tool is none %}NONE{% else %}{{ last_tool.number }}{% endif %})"
before_operation = "(OP {{ operation.number }} {{ operation.name }})"
after_operation = "(/OP {{ operation.name }})"
retract = ["G91 G28 Z0", "G90"]
smoothing_on = "G187 E{{ tolerance|fixed(3) }}"
smoothing_off = "G187"
preselect = true
[program.smoothing]
tolerance = 0.02
"#;
    let vmc = machine("vmc", more);
    let tool = |number| post_posting::program::ToolChange {
        number,
        register: number,
        ..Default::default()
    };
    let facts = JobFacts {
        program: "PART".to_owned(),
        cl_file: "part.cls".to_owned(),
        ahead: Some(ProgramPreview {
            changes: vec![tool(3), tool(5)],
            ..ProgramPreview::default()
        }),
        remarks: Vec::new(),
    };
    let of = |name: &str| format!("TOOL PATH/{name},TOOL,T;{CUT};END-OF-PATH");
    let cl = format!("LOADTL/3;{};SELECT/TOOL,9;LOADTL/5;{}", of("A"), of("B) M30 ("));
    let run = posted_as(&vmc, Capabilities::INSTEAD, &cl, facts).good("texts");
    let told: Vec<String> = run
        .asked
        .iter()
        .filter(|asked| !matches!(asked.kind, "Linear" | "Rapid" | "Spindle"))
        .map(|asked| match asked.kind {
            "Word" | "Instead" => asked.event.split('"').nth(1).unwrap().to_owned(),
            kind => kind.to_owned(),
        })
        .collect();
    assert_eq!(
        told.join("; "),
        "Start; (PART FOR part.cls); (T3); (T5); G91 G28 Z0\\nG90; Retract; \
         T3 M16; ToolChange; (BEHIND NONE); Preselect; Comment; (OP 1 A); \
         G91 G28 Z0\\nG90; Retract; G187 E0.020; Position; (/OP A); \
         G91 G28 Z0\\nG90; Retract; G187; M1; T5 M16; ToolChange; (BEHIND 3); Comment; (OP 2 B  M30  ); \
         G91 G28 Z0\\nG90; Retract; G187 E0.020; Position; (/OP B  M30  ); \
         G91 G28 Z0\\nG90; Retract; G187; (END); End"
    );
    assert_eq!(event(&run, "Preselect"), "Preselect { number: 5 }");
}

/// Lines around turns, planes and tool centre point control, with the facts of their place; the very first and last lines
/// are seen by no dialect.
#[test]
fn texts_stand_around_turns_planes_and_tool_centre_point_control() {
    let more = r#"
[program]
first_lines = "(FIRST {{ program.name }})"
last_lines = "(LAST)"
end = "M99"
before_turn = "(TO B{{ rotary.B|fixed(1) }} C{{ rotary.C|fixed(1) }})"
after_turn = "(TURNED)"
before_plane = "(PLANE {{ plane.angles[1]|fixed(1) }})"
after_plane = "(NO PLANE)"
before_tcp = "(TCP {{ spindle.speed|fixed(0) }} {{ spindle.direction }} {{ coolant }})"
after_tcp = "(NO TCP)"
"#;
    let dmu = machine("dmu50", more);
    let facts = JobFacts { program: "PART".to_owned(), ..JobFacts::default() };
    let leans = "RAPID;GOTO/0,0,50,0,0.5,0.8660254;FEDRAT/100,MMPM;GOTO/0,0,10,0,0.5,0.8660254";
    let cl =
        format!("LOADTL/1;SPINDL/3000,RPM,CCLW;COOLNT/MIST;{leans};GOTO/5,0,10,0,0.4,0.9165151");
    let run = posted_as(&dmu, Capabilities::INSTEAD, &cl, facts).good("texts");
    let told: Vec<&str> = run
        .asked
        .iter()
        .filter_map(|asked| match asked.kind {
            "Word" | "Instead" => asked.event.split('"').nth(1),
            kind => ["Turn", "Position", "Retract", "End"].into_iter().find(|known| *known == kind),
        })
        .collect();
    assert_eq!(
        told.join("; "),
        "Retract; (TO B30.0 C90.0); Turn; (TURNED); (TCP 3000 ccw mist); Position; \
         Retract; (NO TCP); M99; End"
    );
}

/// What a template asks for and nobody knows is told with its place in the machine file, and there is no program.
#[test]
fn a_fact_that_nobody_knows_is_an_error() {
    let vmc = machine("vmc", "[program]\nafter_tool_change = \"G43 Z{{ tool.diameter }}\"\n");
    let run = posted(&vmc, Capabilities::NONE, &format!("LOADTL/3;{CUT}"));
    assert!(run.report.is_none());
    let fault = &run.findings[0];
    assert_eq!(fault.code, "program-text");
    assert_eq!(fault.place.as_ref().unwrap().file, "mine.toml");
    assert!(fault.message.contains("after_tool_change"), "{}", fault.message);
}

#[test]
#[should_panic(expected = "cannot write other lines in the place of its own")]
fn lines_in_the_place_of_an_event_s_need_a_dialect_that_leaves_its_own_out() {
    let vmc = machine("vmc", "[program]\nretract = \"G28\"\n");
    posted(&vmc, Capabilities::NONE, CUT);
}

/// A template is read, and filled once, when the machine is loaded.
#[test]
fn a_slip_in_a_template_is_shown_at_its_place() {
    for (line, at, why) in [
        ("header = \"({{ program.nme }})\"", 14..25, "undefined"),
        ("header = \"({{ tool.number }})\"", 14..25, "undefined"),
        ("footer = [\"(A)\", \"{{ program.name \"]", 18..36, "syntax error"),
        ("between_tools = \"{% set x = 1 %}\"", 19..30, "there is no `set` here"),
        ("smoothing_on = \"G187\"", 15..21, "no smoothing_off"),
    ] {
        let source = Source {
            name: "mine.toml".to_owned(),
            text: format!("extends = \"vmc\"\n[program]\n{line}\n"),
        };
        let faults = load(source, &[], &mut library).unwrap_err();
        let place = faults[0].place.clone().unwrap();
        assert!(faults[0].message.contains(why), "{line}: {}", faults[0].message);
        assert_eq!((place.line, place.file.as_str()), (3, "mine.toml"), "{line}");
        let told = &place.span;
        assert!(told.start >= at.start && told.end <= at.end, "{line}: {told:?}");
    }
}
