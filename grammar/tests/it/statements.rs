//! Every form of every word, and what it says.

use post_grammar::*;

fn read(text: &str) -> Statement {
    parse_record(text).unwrap_or_else(|fault| panic!("{text}: {fault}"))
}

fn same(expected: Statement, texts: &[&str]) {
    for text in texts {
        assert_eq!(read(text), expected, "{text}");
    }
}

fn number(value: f64) -> Argument {
    Argument::Number(value)
}

fn word(text: &str) -> Argument {
    Argument::Word(text.to_owned())
}

fn other(word: &str, arguments: &[Argument], directive: bool) -> Statement {
    Statement::Other { word: word.to_owned().into(), arguments: arguments.to_vec(), directive }
}

#[test]
fn moves() {
    let point = [1.0, -0.5, 3.0];
    same(
        Statement::Goto { point, axis: None },
        &[
            "GOTO/1,-.5,3",
            "GOTO / 1.0, -0.5, 3.",
            "  goto  /  +1.,-.5, 3.0 ",
            "GOTO/1,-.5,3,",
            "GOTO/1,-5E-1,.3e+1 $$ end",
            "GOTO/ 1 , -.5 ,\t3",
        ],
    );
    same(Statement::Goto { point, axis: Some([0.0, 0.6, 0.8]) }, &["GOTO/1,-.5,3,0,.6,.8"]);
    same(Statement::From { point, axis: None }, &["FROM/1,-.5,3"]);
    same(Statement::From { point, axis: Some([0.0, 0.0, 1.0]) }, &["FROM/1,-.5,3,0,0,1"]);
    same(Statement::Gohome(None), &["GOHOME", "GOHOME/", "gohome /"]);
    same(Statement::Gohome(Some((point, None))), &["GOHOME/1,-.5,3"]);
    same(Statement::Godlta(Delta::AlongAxis(-2.0)), &["GODLTA/-2"]);
    same(Statement::Godlta(Delta::Step(point)), &["GODLTA/1,-.5,3"]);
    same(Statement::Rapid, &["RAPID", "RAPID ", "RAPID/", "RAPID/ ", "RAPID $$ up"]);
    same(Statement::ToolAxis([0.0, -1.0, 0.0]), &["TLAXIS/ 0.000000,-1.000000,0.000000 "]);
    same(other("TLAXIS", &[word("SAME")], false), &["TLAXIS/SAME"]);
    same(Statement::Multax(true), &["MULTAX", "MULTAX/ON", "MULTAX / ON"]);
    same(Statement::Multax(false), &["MULTAX/OFF"]);
}

#[test]
fn arcs_and_splines() {
    let arc = CircleRecord {
        centre: [1.0, 2.0, 3.0],
        axis: [0.0, 0.0, -1.0],
        radius: Some(56.25),
        sense: None,
        turns: None,
    };
    same(Statement::Circle(arc.clone()), &["CIRCLE / 1, 2, 3, 0, 0, -1, 56.25"]);
    let nx = CircleRecord { sense: Some(Sense::Clockwise), ..arc.clone() };
    same(Statement::Circle(nx.clone()), &["CIRCLE/1,2,3,0,0,-1,56.25,0.06,0.5,125.0,1.0"]);
    same(
        Statement::Circle(CircleRecord { turns: Some(2), ..nx }),
        &["CIRCLE/1,2,3,0,0,-1,56.25,0.06,0.5,125.0,1.0,TIMES,2"],
    );
    same(
        Statement::Circle(CircleRecord { sense: Some(Sense::CounterClockwise), ..arc.clone() }),
        &["CIRCLE/ 1,2,3,0,0,-1,56.25,COUNTERCLOCKWISE ", "CIRCLE/1,2,3,0,0,-1,56.25,CCLW"],
    );
    same(Statement::Circle(CircleRecord { radius: None, ..arc }), &["CIRCLE/1,2,3,0,0,-1."]);
    same(Statement::Nurbs, &["NURBS/", "NURBS"]);
    same(Statement::Knot(vec![0.25, 1.0]), &["KNOT/0.25,1.0000000"]);
    same(Statement::Control { point: [1.0, 2.0, 3.0], axis: None }, &["CNTRL/1,2,3"]);
    same(
        Statement::Control { point: [1.0, 2.0, 3.0], axis: Some([0.0, 0.0, 1.0]) },
        &["CNTRL/1,2,3,0,0,1"],
    );
}

#[test]
fn feeds() {
    let feed = |value, unit| Statement::Feed(FeedRate { value, unit });
    same(feed(Some(20.0), None), &["FEDRAT/   20.0000"]);
    same(
        feed(Some(400.0), Some(FeedUnit::MillimetresPerMinute)),
        &["FEDRAT / 400.000000,  MMPM", "FEDRAT/ MMPM,400", "fedrat/mmpm,400."],
    );
    same(
        feed(Some(50.0), Some(FeedUnit::InchesPerMinute)),
        &["FEDRAT/IPM,50", "FEDRAT/IPM,50,MAXIPM,100"],
    );
    same(feed(Some(0.1), Some(FeedUnit::MillimetresPerRevolution)), &["FEDRAT/MMPR,.1"]);
    same(feed(Some(0.1), Some(FeedUnit::InchesPerRevolution)), &["FEDRAT/.1,IPR"]);
    same(feed(Some(0.1), Some(FeedUnit::PerRevolution)), &["FEDRAT/.1,PERREV", "FEDRAT/FPR,.1"]);
    same(feed(Some(5.0), Some(FeedUnit::PerMinute)), &["FEDRAT/5,PERMIN", "FEDRAT/FPM,5"]);
    same(
        feed(Some(5.0), Some(FeedUnit::InverseTime)),
        &["FEDRAT/5,INVERS", "FEDRAT/INVERSE,5", "FEDRAT/FRN,5"],
    );
    same(feed(None, Some(FeedUnit::Rapid)), &["FEDRAT/RAPID"]);
}

#[test]
fn spindle_and_coolant() {
    let on =
        |speed, unit, sense| Statement::Spindle(SpindleWord::On { speed, unit, sense, most: None });
    let clockwise = Some(Sense::Clockwise);
    same(
        on(Some(9000.0), SpindleUnit::Rpm, clockwise),
        &[
            "SPINDL / RPM, 9000.000000,  CLW",
            "SPINDL/9000,RPM,CLW",
            "SPINDL/  9000.,CLW",
            "SPINDL/ON,RPM,9000,CLW",
            "SPINDL/9000,CLW,RANGE,2",
        ],
    );
    same(on(Some(9000.0), SpindleUnit::Rpm, None), &["SPINDL/9000"]);
    same(
        on(Some(120.0), SpindleUnit::SurfaceInch, Some(Sense::CounterClockwise)),
        &["SPINDL/SFM,120,CCLW"],
    );
    same(on(Some(120.0), SpindleUnit::SurfaceMetric, None), &["SPINDL/SMM,120"]);
    same(on(None, SpindleUnit::Rpm, None), &["SPINDL/ON"]);
    same(on(None, SpindleUnit::Rpm, clockwise), &["SPINDL/CLW"]);
    same(Statement::Spindle(SpindleWord::Off), &["SPINDL/OFF"]);
    same(Statement::Spindle(SpindleWord::Orient), &["SPINDL/ORIENT", "SPINDL/LOCK"]);
    for (text, coolant) in [
        ("OFF", CoolantWord::Off),
        ("ON", CoolantWord::On),
        ("FLOOD", CoolantWord::Flood),
        ("MIST", CoolantWord::Mist),
        ("THRU", CoolantWord::Through),
        ("through", CoolantWord::Through),
        ("AIR", CoolantWord::Air),
    ] {
        same(Statement::Coolant(coolant), &[&format!("COOLNT/{text}")]);
    }
    same(other("COOLNT", &[word("TAPKUL")], false), &["COOLNT/TAPKUL"]);
}

#[test]
fn tools() {
    let tool = |number, register, length, rest: &[Argument]| {
        Statement::LoadTool(LoadTool {
            number,
            register,
            length,
            described: false,
            rest: rest.to_vec(),
        })
    };
    assert!(matches!(
        read("TOOLNO/2.0"),
        Statement::LoadTool(LoadTool { number: 2, described: true, .. })
    ));
    same(tool(2, None, None, &[]), &["LOADTL / 2", "LOADTL/         2", "LOAD/TOOL,2", "TURRET/2"]);
    same(
        tool(2, Some(3), None, &[]),
        &["LOAD/TOOL,2,ADJUST,3 ", "LOADTL/2,OSETNO,3", "LOADTL/2,OFSTNO,3"],
    );
    same(tool(2, Some(3), Some(80.5), &[]), &["LOADTL/2,LENGTH,80.5,OSETNO,3"]);
    same(tool(2, None, None, &[word("MANUAL"), number(7.0)]), &["LOADTL/2,MANUAL,7"]);
    same(other("LOAD", &[word("WIRE"), number(1.0)], false), &["LOAD/WIRE,1"]);
    same(Statement::SelectTool(13), &["SELECT/TOOL,13", "SELCTL/13"]);
    same(other("SELECT", &[word("HEAD"), number(1.0)], false), &["SELECT/HEAD,1"]);
    same(
        Statement::ToolData {
            kinds: vec!["DRILL".to_owned(), "MILL".to_owned()],
            numbers: vec![63.0, 0.0, 239.0],
        },
        &["TLDATA/DRILL,MILL,63.0000,0.0000,239.0"],
    );
    same(
        Statement::Cutter(vec![10.0, 0.0, 5.0, 3.004303, 31.0, 0.0, 130.0]),
        &["CUTTER/ 10.000000,0.000000,5.000000,3.004303,31.000000,0.000000,130.000000,"],
    );
    same(
        Statement::Cutter(vec![3.0]),
        &["$$-> CUTTER / 3.000000", "REMARK -> CUTTER / 3.0", "CUTTER/3"],
    );
}

#[test]
fn units_and_frames() {
    same(Statement::Units(Units::Millimetre), &["UNITS/ MM ", "UNITS / MM", "UNIT/MM"]);
    same(Statement::Units(Units::Inch), &["UNITS/INCH", "UNITS / INCHES", "UNIT/IN"]);
    same(Statement::Units(Units::Centimetre), &["UNITS/CM"]);
    same(Statement::Units(Units::Metre), &["UNITS/M"]);
    same(Statement::Units(Units::Foot), &["UNITS/FEET", "UNITS/FT"]);
    same(
        Statement::Msys { origin: [1.0, 2.0, 3.0], x: [0.0, 1.0, 0.0], y: [1.0, 0.0, 0.0] },
        &["MSYS/1.0000,2.0000,3.0000,0.0000000,1.0000000,0.0000000,1.0000000,0.0000000,0.0000000"],
    );
    same(
        Statement::Csys([1.0, 0.0, 0.0, 4.0, 0.0, 1.0, 0.0, 5.0, 0.0, 0.0, 1.0, 6.0]),
        &[
            "CSYS/1.,0,0,4,0,1.,0,5,0,0,1.,6",
            "$$-> CSYS / 1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6",
            "$$->CSYS/1,0,0,4,0,1,0,5,0,0,1,6 $$ x",
        ],
    );
}

#[test]
fn cycles() {
    let kinds = |kinds: &[&str]| kinds.iter().map(|kind| (*kind).to_owned()).collect::<Vec<_>>();
    let define = |cycle| Statement::Cycle(Cycle::Define(Box::new(cycle)));
    let feed =
        |value| Some(FeedRate { value: Some(value), unit: Some(FeedUnit::MillimetresPerMinute) });
    same(Statement::Cycle(Cycle::Off), &["CYCLE/OFF", "CYCLE / OFF", "CYCLE/NOMORE"]);
    same(Statement::Cycle(Cycle::On), &["CYCLE/ ON ", "CYCLE/INIT"]);
    same(
        define(CycleDefinition {
            kinds: kinds(&["DRILL", "DEEP"]),
            depth: Some(0.0),
            clearance: Some(3.0),
            feed: feed(250.0),
            rapid_to: Some(3.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE/DRILL,DEEP,RAPTO,3.0000,FEDTO,0.0000,MMPM,250.0000"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["DEEP"]),
            depth: Some(3.5),
            clearance: Some(1.0),
            feed: feed(50.0),
            step: Some(1.0),
            rapid_to: Some(1.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE / DEEP, DEPTH, 3.500000, STEP, 1.000000, MMPM, 50.000000, CLEAR, 1.000000"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["DRILL"]),
            depth: Some(10.0),
            clearance: Some(3.0),
            retract: Some(25.0),
            feed: feed(275.59),
            dwell: Some(0.0),
            rapid_to: Some(3.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE/DRILL,FEDTO,10.,MMPM,275.59,RAPTO,3.,RTRCTO,25.,DWELL,0"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["DRILL"]),
            depth: Some(12.3733),
            clearance: Some(3.0),
            retract: Some(46.927686),
            feed: feed(187.165839),
            dwell: Some(0.0),
            step: Some(5.0),
            later_step: Some(2.0),
            rest: vec![word("G98"), number(46.927686)],
            bare: vec![12.3733, 3.0, 46.927686, 46.927686],
            bare_before_feed: 1,
            ..CycleDefinition::default()
        }),
        &[
            "CYCLE/ DRILL,G98,12.373300,PECKING,5.000000,2.000000,MMPM,187.165839,3.000000,46.927686 46.927686 DWELL,0.000000 ",
        ],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["TAP"]),
            depth: Some(10.0),
            clearance: Some(3.0),
            pitch: Some(-1.5),
            rapid_to: Some(3.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE/TAP,DEPTH,10,CLEAR,3,PITCH,-1.5"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["TAP"]),
            depth: Some(10.0),
            clearance: Some(3.0),
            turns_per_inch: Some(20.0),
            rapid_to: Some(3.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE/TAP,DEPTH,10,CLEAR,3,TPI,20"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["CSINK"]),
            clearance: Some(3.0),
            diameter: Some(8.0),
            angle: Some(90.0),
            rapid_to: Some(3.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE/CSINK,DIAMET,8,ANGLE,90,CLEAR,3"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["BORE", "NODRAG"]),
            depth: Some(5.0),
            clearance: Some(3.0),
            break_through: Some(2.0),
            shift: Some(0.2),
            rapid_to: Some(3.0),
            ..CycleDefinition::default()
        }),
        &["CYCLE/BORE,NODRAG,0.2,DEPTH,5,THRU,2,CLEAR,3"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["THRU"]),
            depth: Some(5.0),
            clearance: Some(3.0),
            bare: vec![5.0, 3.0],
            ..CycleDefinition::default()
        }),
        &["CYCLE/THRU,5,3"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["TAP"]),
            depth: Some(10.0),
            clearance: Some(2.0),
            feed: Some(FeedRate { value: Some(30.0), unit: Some(FeedUnit::InchesPerMinute) }),
            bare: vec![10.0, 2.0],
            bare_before_feed: 1,
            ..CycleDefinition::default()
        }),
        &["CYCLE/TAP,10,IPM,30,2"],
    );
    same(
        define(CycleDefinition {
            kinds: kinds(&["BORE"]),
            depth: Some(-5.0),
            rest: vec![
                word("RTRCTO"),
                word("AUTO"),
                word("DWELL"),
                word("REV"),
                number(2.0),
                word("DRAG"),
            ],
            ..CycleDefinition::default()
        }),
        &["CYCLE/BORE,FEDTO,-5,RTRCTO,AUTO,DWELL,REV,2,DRAG"],
    );
    // The number behind an option is no clearance.
    same(
        define(CycleDefinition {
            kinds: kinds(&["DEEP2"]),
            depth: Some(5.0),
            step: Some(1.0),
            rest: vec![word("DECR"), number(0.2)],
            ..CycleDefinition::default()
        }),
        &["CYCLE/DEEP2,FEDTO,5,STEP,1,DECR,0.2"],
    );
}

#[test]
fn cutter_compensation() {
    let cutcom = |side, plane, register| Statement::Cutcom(Cutcom { side, plane, register });
    same(cutcom(Some(CutterSide::Left), Some(2), None), &["CUTCOM/LEFT,XYPLAN"]);
    same(
        cutcom(Some(CutterSide::Right), Some(0), Some(5)),
        &["CUTCOM/RIGHT,YZPLAN,5", "CUTCOM/RIGHT,OSETNO,5,YZPLAN"],
    );
    same(cutcom(Some(CutterSide::Left), None, None), &["CUTCOM/ LEFT "]);
    same(cutcom(None, None, None), &["CUTCOM/ ON "]);
    same(cutcom(Some(CutterSide::Off), None, None), &["CUTCOM/OFF"]);
    same(other("CUTCOM", &[word("LENGTH"), number(3.0)], false), &["CUTCOM/LENGTH,3"]);
}

#[test]
fn index_moves() {
    let degrees =
        Rotate { axis: None, angle: 90.0, radians: false, incremental: false, sense: None };
    let table = Rotate { axis: Some('A'), ..degrees.clone() };
    same(
        Statement::Rotate(table.clone()),
        &["ROTABL/AAXIS,90.0", "ROTATE/AAXIS,ABSOL,90", "ROTATE/TABLE,AAXIS,ATANGL,90"],
    );
    same(
        Statement::Rotate(Rotate { sense: Some(Sense::Clockwise), ..degrees.clone() }),
        &["ROTABL/ATANGL,90,CLW"],
    );
    same(
        Statement::Rotate(Rotate {
            incremental: true,
            sense: Some(Sense::CounterClockwise),
            ..degrees
        }),
        &["ROTABL/INCR,90,CCLW"],
    );
    same(
        Statement::Rotate(Rotate {
            angle: 0.250000,
            radians: true,
            incremental: false,
            sense: Some(Sense::CounterClockwise),
            ..table
        }),
        &["ROTABL/ 0.250000,AAXIS,TABLE,CCLW "],
    );
    same(other("ROTABL", &[word("ORIGIN"), number(1.0)], false), &["ROTABL/ORIGIN,1"]);
}

#[test]
fn program() {
    same(Statement::Delay(Delay::Seconds(2.5)), &["DELAY/2.5", "DWELL/2.5"]);
    same(Statement::Delay(Delay::Revolutions(3.0)), &["DELAY/3,REV"]);
    same(Statement::Stop, &["STOP", "STOP/"]);
    same(Statement::OptionalStop, &["OPSTOP", "OPSTOP/"]);
    same(Statement::EndOfPath, &["END-OF-PATH"]);
    same(Statement::Fini, &["FINI", "FINI ", "END", "END /"]);
    same(
        Statement::ToolPath { name: "11_PAZ".to_owned(), tool: Some("FACE_MILL".to_owned()) },
        &["TOOL PATH/11_PAZ,TOOL,FACE_MILL", "tool  path / 11_PAZ , TOOL , FACE_MILL"],
    );
    same(
        Statement::ToolPath { name: "a, b $$ c".to_owned(), tool: None },
        &["TOOL PATH/a, b $$ c"],
    );
}

#[test]
fn free_texts() {
    same(
        Statement::PartName("MFG0004".to_owned()),
        &["PARTNO / MFG0004", "PARTNO MFG0004     ", "partno/MFG0004"],
    );
    same(Statement::PartName(String::new()), &["PARTNO", "PARTNO/"]);
    same(
        Statement::Print("a / b, $$ c $".to_owned()),
        &["PPRINT a / b, $$ c $", "PPRINT/a / b, $$ c $"],
    );
    same(Statement::Insert("STOP  change fixture".to_owned()), &["INSERT/STOP  change fixture"]);
    same(Statement::Insert("\"'()[]{}#%&ü".to_owned()), &["INSERT \"'()[]{}#%&ü"]);
    same(
        Statement::Remark("MACHID=MACHIN / UNCX01, 1".to_owned()),
        &["REMARK MACHID=MACHIN / UNCX01, 1", "REMARK/MACHID=MACHIN / UNCX01, 1"],
    );
    same(
        Statement::Remark("centerline data".to_owned()),
        &["$$ centerline data", "  $$centerline data"],
    );
    same(
        Statement::Remark("*  Pro/CLfile".to_owned()),
        &["$$*  Pro/CLfile", "REMARK *  Pro/CLfile"],
    );
    same(Statement::Remark(String::new()), &["$$", "REMARK"]);
    same(
        other("OPFEATSTART", &[word("Drill1-Hole Group1 [Drill], $$")], false),
        &["OPFEATSTART/Drill1-Hole Group1 [Drill], $$"],
    );
}

#[test]
fn directives() {
    same(
        other("FEATNO", &[number(32.0)], true),
        &["$$-> FEATNO / 32", "REMARK -> FEATNO / 32", "remark->FEATNO/32"],
    );
    same(other("END", &[], true), &["$$-> END / ", "REMARK -> END /"]);
    same(other("FEDRAT", &[number(1.0), number(2.0)], true), &["$$-> FEDRAT / 1, 2"]);
    same(other("CUTTER", &[word("DISPLY"), number(1.0)], true), &["$$-> CUTTER / DISPLY, 1"]);
    // What cannot be read is a remark.
    same(Statement::Remark("-> CUTTER / 1, thick".to_owned()), &["$$-> CUTTER / 1, thick"]);
    same(
        Statement::Remark("-> CSYS / 1, 2".to_owned()),
        &["$$-> CSYS / 1, 2", "REMARK -> CSYS / 1, 2"],
    );
    same(Statement::Remark("-> 5 (!)".to_owned()), &["$$-> 5 (!)", "REMARK -> 5 (!)"]);
}

#[test]
fn words_without_a_statement() {
    same(other("PPWORD", &[word("3DCOMP"), number(3155.0)], false), &["PPWORD/3DCOMP,3155"]);
    same(other("PAINT", &[word("TOOL"), word("NOMORE")], false), &["PAINT/TOOL,NOMORE"]);
    same(
        other("MACHIN", &[word("UNCX01"), number(1.0)], false),
        &["MACHIN / UNCX01, 1", "machin/ UNCX01 1"],
    );
    same(other("CSI_SET_FLUTE_LENGTH", &[number(54.0)], false), &["CSI_SET_FLUTE_LENGTH/54."]);
    same(
        other("MOVE_ATTRIB", &[word("LEADIN"), word("END_ATTRIB")], false),
        &["MOVE_ATTRIB/ LEADIN,END_ATTRIB "],
    );
    same(
        other("NOSUCH", &[word("a=b/c"), word(""), word("1x"), number(1.0)], false),
        &["NOSUCH/a=b/c,,1x,1"],
    );
    same(other("NOSUCH", &[], false), &["NOSUCH", "NOSUCH/", "NOSUCH $$ x"]);
    same(other("NOSUCH", &[word("A"), number(2.0)], false), &["NOSUCH A 2", "NOSUCH A,2"]);
}

#[test]
fn each_word_has_one_row_and_each_statement_the_name_of_its_row() {
    let words = MajorWord::all();
    assert!(words.is_sorted_by_key(|word| word.name()));
    let mut spellings: Vec<&str> = words.iter().flat_map(|word| word.spellings).copied().collect();
    spellings.sort_unstable();
    assert!(spellings.windows(2).all(|pair| pair[0] != pair[1]));
    for word in words {
        assert!(!word.meaning.is_empty(), "{word:?}");
        for spelling in word.spellings {
            let found = MajorWord::find(&spelling.to_lowercase()).unwrap();
            assert_eq!(found.name(), word.name());
        }
        if word.example.is_empty() {
            // Without a statement of its own, the record comes as it stands.
            let kept = read(&format!("{}/1,A", word.name()));
            assert_eq!(kept, other(word.name(), &[number(1.0), self::word("A")], false));
            assert_eq!(kept.usage(), word.usage);
            assert!(!matches!(word.usage, WordUsage::Used | WordUsage::Passed), "{word:?}");
        } else {
            let statement = read(word.example);
            assert_eq!((statement.word(), statement.usage()), (word.name(), word.usage));
        }
    }
    // What an editor offers behind a word is read there, and has the effect of the word.
    let mut offered = 0;
    for word in words {
        for record in word.records() {
            let statement = read(record);
            assert_eq!(
                (statement.word(), statement.usage()),
                (word.name(), word.usage),
                "{record}"
            );
        }
        offered += word.minor_words().len();
    }
    assert!(offered > 60, "{offered}");
    let feeds = MajorWord::find("FEDRAT").unwrap().minor_words();
    assert_eq!(feeds, ["MMPM", "IPM", "PERMIN", "MMPR", "IPR", "PERREV", "INVERS", "RAPID"]);
    assert!(MajorWord::find("NOSUCH").is_none());
    assert_eq!(read("nosuch/1").word(), "NOSUCH");
}

/// The forms of Autodesk's stock APT posts and of CATIA.
#[test]
fn forms_of_autodesk_and_catia() {
    same(
        Statement::ArcMove(ArcMove {
            centre: [1.0, 2.0, 3.0],
            axis: [0.0, 0.0, -1.0],
            radius: 10.0,
            degrees: 45.5,
        }),
        &["MOVARC/1,2,3,0,0,-1,10,ANGLE,45.5", "movarc / 1., 2., 3., 0, 0, -1, 10, angle, 45.5"],
    );
    for wrong in [
        "MOVARC/1,2,3,0,0,-1,10",
        "MOVARC/1,2,3,0,0,-1,ANGLE,45",
        "MOVARC/1,2,3,0,0,-1,10,45",
        "MOVARC/1,2,3,0,0,-1,10,ANGLE,45,1",
        "MOVARC/1,2,3,0,0,-1,10,ANGLE",
        "INDIRV/1,2",
        "MCS/1,0,0",
    ] {
        assert!(parse_record(wrong).is_err(), "{wrong}");
    }
    same(Statement::Milling, &["MODE/MILL", "MODE / mill"]);
    assert_eq!(read("MODE/TURN").usage(), WordUsage::Used);
    same(Statement::SetOut([0.0, 1.0, 0.0]), &["INDIRV/0,1,0", "INDIRV/ 0.,1.,0."]);
    assert_eq!(read("INDIRV/V1").usage(), WordUsage::Refused);
    same(Statement::PartSurface(None), &["AUTOPS", "AUTOPS/"]);
    same(
        Statement::PartSurface(Some([0.0, 1.0, 0.0])),
        &[
            "PSIS/(PLANE/(POINT/1,2,3),PERPTO,(VECTOR/0,1,0))",
            "PSIS / (PLANE/ (POINT/ 1, 2,3) , PERPTO,(VECTOR/0,1,0))",
        ],
    );
    assert_eq!(read("PSIS/S1").usage(), WordUsage::Refused);
    same(
        Statement::ToolName("T1 End Mill".to_owned()),
        &["TPRINT/T1 End Mill", "TPRINT T1 End Mill"],
    );
    same(Statement::PartName("1001".to_owned()), &["PARTNO/'1001'", "PARTNO 1001"]);
    same(Statement::Print("it's so".to_owned()), &["PPRINT it's so"]);
    let Statement::LoadTool(tool) = read("LOADTL/4, 0, 60.5, 14") else {
        panic!();
    };
    assert_eq!((tool.number, tool.of_autodesk(), tool.of_catia()), (4, Some((14, 60.5)), None));
    let Statement::LoadTool(tool) = read("LOADTL/4,5,6") else {
        panic!();
    };
    assert_eq!((tool.of_autodesk(), tool.of_catia()), (None, Some([5, 6])));
    let Statement::Cycle(Cycle::Define(cycle)) =
        read("CYCLE/DEEP2,FEDTO,12,1STPECK,5,SUBPECK,2,MMPM,100,RAPTO,2")
    else {
        panic!();
    };
    assert_eq!((cycle.step, cycle.later_step), (Some(5.0), Some(2.0)));
    let Statement::Cycle(Cycle::Define(cycle)) =
        read("CYCLE/DEEP, 12, INCR, 4, MMPM, 150, 15, RAPTO, 12")
    else {
        panic!();
    };
    assert_eq!(
        (cycle.step, cycle.bare.as_slice(), cycle.bare_before_feed, cycle.rapid_to),
        (Some(4.0), &[12.0, 15.0][..], 1, Some(12.0))
    );
}

/// What may be a move that nobody here knows.
#[test]
fn unknown_paths_are_told_from_other_words() {
    for (text, path) in [
        ("NOSUCH/1,2,3", Some(UnknownPath::Numbers)),
        ("NOSUCH/A,1,B,2,3", Some(UnknownPath::Numbers)),
        ("NOSUCH/1,2", None),
        ("NOSUCH", None),
        ("GOFWD/L1", Some(UnknownPath::Word)),
        ("TLLFT,GOLFT/L1,PAST,L2", Some(UnknownPath::Word)),
        ("TLON,GOFWD/C1,ON,L1", Some(UnknownPath::Word)),
        ("INDIRV/V1", Some(UnknownPath::Word)),
        ("TRACUT/1,0,0,0,0,1,0,0,0,0,1,0", None),
        ("$$-> NOSUCH / 1,2,3", None),
        ("$$ GOFWD", None),
        ("PAINT/1,2,3", None),
    ] {
        assert_eq!(read(text).unknown_path(), path, "{text}");
    }
}

#[test]
fn what_becomes_of_a_record_depends_on_its_form() {
    for (text, usage) in [
        ("NOSUCH/1", WordUsage::Unknown),
        ("COOLNT/SUPER", WordUsage::Unknown),
        ("SELECT/WIRE,1", WordUsage::Unknown),
        ("LOAD/WIRE,1", WordUsage::Refused),
        ("CUTCOM/MAYBE", WordUsage::Refused),
        ("TLAXIS/NORMAL", WordUsage::Refused),
        ("$$-> NOSUCH / 1", WordUsage::Ignored),
        ("$$-> GOTO / 1", WordUsage::Ignored),
        ("$$-> TRACUT / 1", WordUsage::Refused),
        ("$$-> CUTTER / 1", WordUsage::Used),
        ("$$ any remark", WordUsage::Ignored),
    ] {
        assert_eq!(read(text).usage(), usage, "{text}");
    }
}

/// The words of the classic lists for post-processors (APT360, PostWorks, VERICUT): each is judged, and what a program
/// can do without is a short list.
#[test]
fn the_classic_words_are_judged() {
    let words = "PARTNO MACHIN UNITS MULTAX FROM GOTO GODLTA CIRCLE CUTTER TLDATA LOADTL SELCTL SELECT UNLOAD TURRET \
                 TOOLNO SPINDL COOLNT FEDRAT RAPID CYCLE CUTCOM ROTABL ROTHED ROTATE CLAMP ORIGIN TRANS TRACUT COUPLE \
                 MODE LINTOL PPTOL MCHTOL ARCSLP CLRSRF CLEARP RETRCT PLUNGE GOHOME POSITN POSTN CHECK SAFETY SEQNO \
                 TMARK OPSKIP OPSTOP STOP DELAY DWELL AUXFUN PREFUN INSERT PPRINT DISPLY LEADER REWIND BREAK SLOWDN \
                 THREAD DRAFT PAINT MSYS END-OF-PATH HEAD PIVOTZ PROBE REMARK READ MACRO TERMAC CALL INDIRV TLON GOFWD \
                 PSIS END FINI SET OFSETL MIRROR CALSUB ZERO";
    let of = |usage: WordUsage| -> Vec<&str> {
        let becomes = |word: &&str| MajorWord::find(word).map(|row| row.usage) == Some(usage);
        words.split_whitespace().filter(becomes).collect()
    };
    let missing: Vec<&str> =
        words.split_whitespace().filter(|word| MajorWord::find(word).is_none()).collect();
    assert_eq!(missing, [""; 0]);
    assert_eq!(of(WordUsage::Unknown), ["CHECK", "BREAK", "SLOWDN"]);
    let without_effect = [
        "MACHIN", "LINTOL", "PPTOL", "MCHTOL", "SAFETY", "SEQNO", "TMARK", "DISPLY", "LEADER",
        "REWIND", "DRAFT", "PAINT", "REMARK",
    ];
    assert_eq!(of(WordUsage::Ignored), without_effect);
}

/// The book lists the words by what becomes of them.
#[test]
fn the_book_lists_the_words_of_the_table() {
    let page = include_str!("../../../docs/src/nc-programmer/cl-files.md");
    for usage in [
        WordUsage::Used,
        WordUsage::Passed,
        WordUsage::Ignored,
        WordUsage::Refused,
        WordUsage::Unknown,
    ] {
        let spellings = MajorWord::all().iter().filter(|word| word.usage == usage);
        let listed: Vec<String> =
            spellings.map(|word| format!("`{}`", word.spellings.join("` = `"))).collect();
        let row = format!("| {} | {} |", usage.name(), listed.join(", "));
        assert!(page.contains(&row), "the page lacks this line:\n{row}");
    }
}

/// The part of the text that is marked, and the message.
fn refused(text: &str) -> (String, String) {
    let fault = parse_record(text).expect_err(text);
    assert_eq!((fault.line, fault.text.as_str()), (1, text));
    (text[fault.span].to_owned(), fault.message)
}

#[test]
fn faults_say_where_and_what() {
    for (text, marked, message) in [
        ("GOTO/1,2,3,4", "1,2,3,4", "GOTO takes 3, 6 or 9 numbers, 4 are given"),
        ("GOTO/1", "1", "GOTO takes 3, 6 or 9 numbers, 1 is given"),
        ("GOTO/", "", "GOTO needs numbers"),
        ("GOTO", "", "GOTO needs numbers"),
        ("GOTO/1,2,x3", "x3", "a number is expected, not `x3`"),
        ("GOTO/1,,3", "", "a number is expected, nothing stands between the commas"),
        ("GOTO/1,2,1e400", "1e400", "1e400 is beyond any number a program can hold"),
        ("GOTO/1,2,inf", "inf", "a number is expected, not `inf`"),
        ("GOTO/1,2,NaN", "NaN", "a number is expected, not `NaN`"),
        ("GOTO/1,2,0x10", "0x10", "a number is expected, not `0x10`"),
        ("GOTO/1,2 3", "", "a comma is missing here"),
        ("GOTO 1,2,3", " ", "a `/` must stand between GOTO and what follows it"),
        ("GOTO(1,2,3)", "(", "a `/` or the end of the line must follow the word"),
        ("A=POINT/1,2,3", "=", "a `/` or the end of the line must follow the word"),
        (",,,", ",", "a record begins with a word"),
        (" 12.5, 3", "1", "a record begins with a word"),
        ("/", "/", "a record begins with a word"),
        ("é", "é", "a record begins with a word"),
        ("GO\u{0}TO", "\u{0}", "byte 0x00 is not text"),
        ("GODLTA/1,2", "1,2", "GODLTA takes 1 or 3 numbers, 2 are given"),
        ("FEDRAT/MMPM", "", "FEDRAT needs a number"),
        ("FEDRAT", "", "FEDRAT needs a number"),
        ("FEDRAT/DPM,5", "DPM", "a feed is one number and one unit, not `DPM`"),
        ("FEDRAT/1,2", "2", "a feed is one number and one unit, not `2`"),
        ("SPINDL", "", "SPINDL needs a speed or a word"),
        ("SPINDL/RPM", "", "SPINDL needs a number with its unit"),
        (
            "SPINDL/100,FAST",
            "FAST",
            "a spindle speed is one number, one unit and one sense, not `FAST`",
        ),
        ("COOLNT/", "", "COOLNT needs a word"),
        ("LOADTL/-1", "-1", "-1 is no whole number from 0 up"),
        ("LOADTL/1.5", "1.5", "1.5 is no whole number from 0 up"),
        ("LOAD/TOOL", "", "a number must follow LOAD"),
        ("LOADTL/1,ADJUST,ON", "ON", "a number must follow ADJUST, not `ON`"),
        ("SELECT/TOOL,1,2", "2", "one tool number is expected, not `2`"),
        ("TLDATA/1", "", "TLDATA needs the kind of tool"),
        ("UNITS/", "", "UNITS takes one word"),
        ("UNITS/FURLONG", "FURLONG", "a unit of length is expected, not `FURLONG`"),
        ("MULTAX/MAYBE", "MAYBE", "MULTAX is on or off"),
        ("MSYS/1,2,3", "1,2,3", "MSYS takes 9 numbers, 3 are given"),
        ("CSYS/1,2,3", "1,2,3", "CSYS takes 12 numbers, 3 are given"),
        ("CIRCLE/1,2,3,4,5", "1,2,3,4,5", "CIRCLE takes 6, 7 or 11 numbers, 5 are given"),
        ("CIRCLE/1,2,3,4,5,CLW", "1,2,3,4,5", "CIRCLE takes 6, 7 or 11 numbers, 5 are given"),
        ("CIRCLE/CLW", "CLW", "CIRCLE needs numbers"),
        ("CIRCLE/0,0,0,0,0,1,TIMES", "", "a number must follow TIMES"),
        ("CIRCLE/0,0,0,0,0,1,5,UP", "UP", "a sense or TIMES is expected, not `UP`"),
        ("NURBS/3", "3", "nothing is expected behind NURBS"),
        ("KNOT/", "", "KNOT needs numbers"),
        ("CYCLE/DRILL,FEDTO,RAPTO,3", "RAPTO", "a number must follow FEDTO, not `RAPTO`"),
        ("CYCLE/5", "5", "CYCLE needs the kind of cycle"),
        ("CYCLE/DRILL,,5", "", "a word or a number is expected, nothing stands between the commas"),
        ("CUTCOM/5", "5", "CUTCOM needs a side"),
        ("CUTCOM/LEFT,UVPLAN", "UVPLAN", "a plane or a register is expected, not `UVPLAN`"),
        ("ROTABL/AAXIS", "", "ROTABL needs an angle"),
        (
            "ROTABL/90,CLW",
            "90,CLW",
            "this may be degrees or radians: with the angle first, the axis and TABLE must follow",
        ),
        (
            "ROTABL/AAXIS,BAXIS,90",
            "BAXIS",
            "an index move is one axis, one angle and one sense, not `BAXIS`",
        ),
        ("TLAXIS/0,1", "0,1", "TLAXIS takes 3 numbers, 2 are given"),
        ("DELAY/ON", "ON", "a number must follow DELAY, not `ON`"),
        ("DELAY/2,HOURS", "HOURS", "REV or nothing is expected, not `HOURS`"),
        ("STOP/5", "5", "nothing is expected behind STOP"),
        ("NOSUCH/1e400", "1e400", "1e400 is beyond any number a program can hold"),
    ] {
        assert_eq!(refused(text), (marked.to_owned(), message.to_owned()), "{text}");
    }
    let fault = parse_record("GOTO/1,2").unwrap_err();
    assert_eq!(
        fault.to_string(),
        "line 1: GOTO takes 3, 6 or 9 numbers, 2 are given (expected GOTO/x,y,z, GOTO/x,y,z,i,j,k or, with the direction of an edge, GOTO/x,y,z,i,j,k,u,v,w)"
    );
}
