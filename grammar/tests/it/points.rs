//! Lists of points: CSV and JSON become the records of a CL file, and what is wrong is told by line and column.

use std::io::{self, Read};

use post_grammar::{ClReader, NEXT_FILE, ReadError, parse_record};

/// Hands out so many bytes at a time.
struct Slow<'t>(&'t [u8], usize);

impl Read for Slow<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.1.min(into.len()).min(self.0.len());
        into[..count].copy_from_slice(&self.0[..count]);
        self.0 = &self.0[count..];
        Ok(count)
    }
}

/// Line and statement of each record, or line, column and message of a fault.
fn read(text: &[u8], size: usize) -> Vec<String> {
    let mut reader = ClReader::new(Slow(text, size));
    let mut told = Vec::new();
    loop {
        match reader.next_record() {
            Ok(Some(record)) => told.push(format!("{} {:?}", record.line, record.statement)),
            Ok(None) => return told,
            Err(ReadError::Syntax(fault)) => {
                assert!(fault.text.get(fault.span.clone()).is_some(), "{fault:?}");
                let part = &fault.text[fault.span.clone()];
                told.push(format!(
                    "{}:{} {} `{part}`",
                    fault.line,
                    fault.span.start + 1,
                    fault.message
                ));
            }
            Err(ReadError::Io(error)) => panic!("{error}"),
        }
    }
}

fn both(text: &str) -> Vec<String> {
    let all = read(text.as_bytes(), usize::MAX);
    assert_eq!(read(text.as_bytes(), 1), all, "byte by byte: {text}");
    all
}

/// A list gives the records of a CL file, on the lines of the list.
fn same(list: &str, cl: &[(u64, &str)]) {
    let expected: Vec<String> = cl
        .iter()
        .map(|(line, record)| format!("{line} {:?}", parse_record(record).expect("a record")))
        .collect();
    assert_eq!(both(list), expected, "{list}");
}

#[test]
fn a_header_and_rows_are_a_cl_file() {
    same(
        "x,y,z\n0,0,5\n1,2,-3.5\n",
        &[(1, "UNITS/MM"), (2, "RAPID"), (2, "GOTO/0,0,5"), (3, "GOTO/1,2,-3.5"), (3, "FINI")],
    );
    let list = "\u{FEFF}units,inch\ntool,3,,\nspindle,6000\ncoolant,flood\nname,blade\nfeed,8\nX,\"Y\",z,I,j,K,feed,rapid\n\
                0,0,5,0,0,1,,\n# an arc it is not\n1,0,0,0.1,0,1,,0\n2,0,0,0,0,1,4,false\n3,0,0,0,0,1,8,\n\
                \n3,0,9,0,0,1,4,TRUE\n\n";
    let records = [
        (5, "PARTNO blade"),
        (1, "UNITS/INCH"),
        (2, "LOADTL/3"),
        (3, "SPINDL/RPM,6000,CLW"),
        (4, "COOLNT/FLOOD"),
        (8, "RAPID"),
        (8, "GOTO/0,0,5,0,0,1"),
        (10, "FEDRAT/8,PERMIN"),
        (10, "GOTO/1,0,0,0.1,0,1"),
        (11, "FEDRAT/4,PERMIN"),
        (11, "GOTO/2,0,0,0,0,1"),
        (12, "FEDRAT/8,PERMIN"),
        (12, "GOTO/3,0,0,0,0,1"),
        (14, "FEDRAT/4,PERMIN"),
        (14, "RAPID"),
        (14, "GOTO/3,0,9,0,0,1"),
        (14, "FINI"),
    ];
    same(list, &records);
    for separator in [";", "\t"] {
        same(&list.replace(',', separator), &records);
    }
    same(&list.replace('\n', "\r\n"), &records);
}

#[test]
fn an_arc_goes_about_its_axis_by_the_right_hand() {
    let mut cl = [
        (1, "UNITS/MM"),
        (2, "RAPID"),
        (2, "GOTO/0,0,0"),
        (3, "FEDRAT/500,PERMIN"),
        (3, "CIRCLE/0,10,0,0,0,1,CCLW"),
        (3, "GOTO/10,10,0"),
        (4, "GOTO/20,10,0"),
        (4, "FINI"),
    ];
    same(
        "x,y,z,feed,arc_x,arc_y,arc_z,arc_i,arc_j,arc_k\n0,0,0,,,,,,,\n10,10,0,500,0,10,0,0,0,1\n\
         20,10,0,,,,,,,\n",
        &cl,
    );
    let json = "{\"feed\": 500,\n\"points\": [[0,0,0],\n{\"arc\": {\"to\": [10,10,0], \"centre\": [0,10,0], \"axis\": \
                [0,0,1]}},\n{\"to\": [20,10,0]}\n]}\n";
    // What is said ahead of the points is told with the first, the end with the bracket.
    (cl[0].0, cl[7].0) = (2, 5);
    same(json, &cl);
}

#[test]
fn json_says_the_same() {
    let cl = [
        (2, "UNITS/MM"),
        (2, "RAPID"),
        (2, "GOTO/0,0,5"),
        (2, "FEDRAT/8,PERMIN"),
        (2, "GOTO/1,2,3,0,0.5,1"),
        (3, "RAPID"),
        (3, "GOTO/1,2,9"),
        (3, "FINI"),
    ];
    same(
        "{ \"feed\": 8,\n \"points\": [[0, 0, 5], {\"to\": [1, 2, 3], \"tool_axis\": [0, 5e-1, 1]},\n\
         {\"x\": 1, \"y\": 2, \"z\": 9, \"i\": null, \"j\": null, \"k\": null, \"cut\": false}]}",
        &cl,
    );
    // Settings behind the points, and columns of one's own.
    same(
        "{\"columns\": [\"x\", \"y\", \"z\", \"i\", \"j\", \"k\", \"rapid\"],\n\"points\": [[0,0,5,null,null,null,1], \
         [1,2,3,0,0.5,1,0],\n[1,2,9,null,null,null,true]], \"feed\": 8 }",
        &cl,
    );
    same("[]", &[(1, "UNITS/MM"), (1, "FINI")]);
}

#[test]
fn what_is_wrong_is_told_by_line_and_column() {
    for (list, told) in [
        ("x,y\n1,2\n", "1:1 the column `z` is missing `x,y`"),
        ("x,y,q\n", "1:5 a list of points has no column `q` `q`"),
        ("x,y,z,nx,ny,nz\n", "1:7 a list of points has no column `nx` `nx`"),
        ("x,y,z,e\n", "1:7 amounts of an extruder are not read from a list `e`"),
        ("x,y,z,x\n", "1:7 the column `x` stands here twice `x`"),
        ("x,y,z,i,j\n", "1:1 the column `k` is missing `x,y,z,i,j`"),
        ("x,y,z,rapid,cut\n", "1:1 `rapid` and `cut` say the same `x,y,z,rapid,cut`"),
        (
            "x,y,z,arc_x,arc_y,arc_z\n",
            "1:1 the column `arc_i` is missing `x,y,z,arc_x,arc_y,arc_z`",
        ),
        ("1,2,3\n4,5,6\n", "1:1 rows of points without a header `1,2,3`"),
        ("units,feet\n", "1:7 `units` cannot be this `feet`"),
        ("units,mm\nunits,mm\n", "2:1 `units` stands here twice `units`"),
        ("tool,1.5\n", "1:6 `tool` cannot be this `1.5`"),
        ("material,steel\n", "1:1 a list of points has no setting `material` `material`"),
        ("tool,1\nspeed,6\n", "2:1 a list of points has no setting `speed` `speed`"),
        ("spindle,6,000\n", "1:1 `spindle` has 2 values `spindle`"),
    ] {
        let all = both(list);
        assert_eq!(all.first().map(String::as_str), Some(told), "{all:?}");
        // Nothing else is read of a list without a good header.
        assert!(all.len() < 3, "{all:?}");
    }
    for (row, told) in [
        ("1,2,nan,0,0,1,", "2:5 `z` is no number `nan`"),
        ("1,2,inf,0,0,1,", "2:5 `z` is no number `inf`"),
        ("1,2,1e999,0,0,1,", "2:5 `z` is no number `1e999`"),
        ("1,2,3 mm,0,0,1,", "2:5 `z` is no number `3 mm`"),
        (",,,,,,", "2:1 a row without a position `,,,,,,`"),
        (",,", "2:1 3 values in a row, and there are 7 columns `,,`"),
        ("1,2", "2:1 2 values in a row, and there are 7 columns `1,2`"),
        ("1,2,3,0,0,1,,", "2:1 8 values in a row, and there are 7 columns `1,2,3,0,0,1,,`"),
        ("1,,3,0,0,1,", "2:3 `y` is empty ``"),
        ("1,2,3,0,0,0,", "2:7 a direction of no length `0`"),
        ("1,2,3,0,,1,", "2:9 `j` is empty ``"),
        ("1,2,3,0,0,1,-5", "2:13 a feed of -5 `-5`"),
        ("1,2,3,0,0,1,0", "2:13 a feed of 0 `0`"),
    ] {
        let all = both(&format!("x,y,z,i,j,k,feed\n{row}\n1,2,3,0,0,1,\n"));
        assert_eq!(all[1], told, "{all:?}");
        assert!(all.last().unwrap().ends_with("Fini"), "{all:?}");
        assert!(all[2..].iter().any(|told| told.contains("Goto")), "{all:?}");
    }
    let comma = both("x;y;z\n1;2;3,5\n");
    assert_eq!(comma[1], "2:5 `z` has a comma: a decimal comma is not read `3,5`");
    for (list, told) in [
        ("{\"points\": [[0,0,NaN]]}", "1:18 NaN is no number that a machine goes to `NaN`"),
        (
            "{\"points\":\n [[0,0,1],\n  [0,0]]}",
            "3:3 2 values in a row, and there are 3 columns `[0,0]`",
        ),
        ("{\"points\": [[0,0,1]]", "1:21 the file ends where a comma or `}` is expected ``"),
        ("{\"points\": [[0,0,1]", "1:20 the file ends where a bracket is still open ``"),
        ("{\"unit\": 3, \"points\": []}", "1:2 a list of points has no setting `unit` `\"unit\"`"),
        ("{\"tool\": 3}", "1:1 the list has no `points` `{`"),
        ("[[0,0,1]] 5", "1:11 something stands behind the list `5`"),
        ("[5]", "1:2 this is no point `5`"),
        ("[{\"x\":1,\"z\":2}]", "1:2 the column `y` is missing `{\"x\":1,\"z\":2}`"),
        ("[{\"x\":1,\"y\":\"a\",\"z\":2}]", "1:13 `y` is no number `\"a\"`"),
        ("[{\"to\":[1,2]}]", "1:8 `to` is no list of three numbers `[1,2]`"),
        (
            "[{\"arc\":{\"to\":[1,2,3],\"center\":[0,0,0]}}]",
            "1:2 the column `arc_i` is missing `{\"arc\":{\"to\":[1,2,3],\"center\":[0,0,0]}}`",
        ),
        ("[[0,0,1],]", "1:10 a value is expected `]`"),
        (
            "{\"columns\":[\"x\",\"y\",\"z\"],\"columns\":[\"y\",\"x\",\"z\"],\"points\":[]}",
            "1:26 `columns` stands here twice `\"columns\"`",
        ),
        ("{\"name\":\"\\x\",\"points\":[]}", "1:9 this is no text of JSON `\"\\x\"`"),
        ("[[1,2,[3]]]", "1:7 a list where a value is expected `[3]`"),
    ] {
        let all = both(list);
        assert!(all.iter().any(|found| found == told), "{told}\n{all:?}");
    }
}

/// A setting is told where it stands, and not where the points begin.
#[test]
fn a_setting_has_its_own_line() {
    let mut reader =
        ClReader::new(&b"# a pocket\ntool,3\nunits,inch\n\nspindle,6000\nx,y,z\n0,0,5\n"[..]);
    let mut found = Vec::new();
    while let Some(record) = reader.next_record().unwrap() {
        found.push((record.line, record.text().into_owned()));
    }
    let lines = [(3, "units,inch"), (2, "tool,3"), (5, "spindle,6000"), (7, "0,0,5")];
    assert_eq!(found[..4], lines.map(|(line, text)| (line, text.to_owned())), "{found:?}");
    let json = "{\n \"points\": [[0, 0, 1]],\n \"tool\": 3\n}\n";
    let all = both(json);
    assert!(all.iter().any(|told| told.starts_with("3 LoadTool")), "{all:?}");
    assert!(all.iter().any(|told| told.starts_with("2 Units")), "{all:?}");
}

/// What stands in quotation marks is one value, whatever is in it.
#[test]
fn quotation_marks_hold_separators() {
    let all = both("name,\"Bracket, \"\"left\"\" (2)\"\nx,y,z\n\"0\", \"1\" ,5\n");
    assert!(all[0].contains("PartName(\"Bracket, \\\"left\\\" (2)\")"), "{all:?}");
    assert!(all.iter().any(|told| told.contains("point: [0.0, 1.0, 5.0]")), "{all:?}");
    // A comma in a name does not make it the separator of a list with semicolons.
    let all = both("\"name\";\"a;b\"\nx;y;z\n1;2;3\n");
    assert!(all[0].contains("PartName(\"a;b\")"), "{all:?}");
    for (row, told) in [
        ("\"1,5\",2,3", "2:1 `x` has a comma: a decimal comma is not read `\"1,5\"`"),
        ("1,2,\"3", "2:5 a quotation mark is still open `\"3`"),
        ("1,\"2,3", "2:3 a quotation mark is still open `\"2,3`"),
    ] {
        let all = both(&format!("x,y,z\n{row}\n"));
        assert_eq!(all[1], told, "{all:?}");
    }
}

#[test]
fn json_may_have_its_columns_one_by_one() {
    let cl = [
        (2, "UNITS/MM"),
        (2, "RAPID"),
        (2, "GOTO/0,0,5"),
        (3, "FEDRAT/8,PERMIN"),
        (3, "GOTO/1,2,3"),
        (5, "FINI"),
    ];
    let list = "{\"x\": [\n0,\n1], \"feed\": [null, 8],\n \"y\": [0, 2], \"z\": [5, 3]\n}";
    same(list, &cl);
    same("{\"x\": [], \"y\": [], \"z\": []}", &[(1, "UNITS/MM"), (1, "FINI")]);
    for (list, told) in [
        (
            "{\"x\": [1, 2], \"y\": [1], \"z\": [1, 2]}",
            "1:22 this column ends before others do `]`",
        ),
        ("{\"x\": [1, 2,], \"y\": [1, 2], \"z\": [1, 2]}", "1:13 a value is expected `]`"),
        ("{\"x\": [1], \"z\": [2]}", "1:2 the column `y` is missing `\"x\"`"),
        (
            "{\"x\": [1], \"points\": []}",
            "1:2 the list has `points`, or `columns`, and columns one by one as well `\"x\"`",
        ),
        ("{\"x\": [1], \"y\": [\"a\"], \"z\": [2]}", "1:18 `y` is no number `\"a\"`"),
    ] {
        let all = both(list);
        assert!(all.iter().any(|found| found == told), "{told}\n{all:?}");
    }
}

/// In an editor a table of something else is none, and so is other JSON.
#[test]
fn a_list_is_told_from_other_files() {
    for (text, is) in [
        ("tool,1\nx,y,z\n0,0,5\n", true),
        ("X;Y;Z;feed\n", true),
        ("id,name,price\n1,a,2\n", false),
        ("{\"points\": [[0,0,1]]}", true),
        ("{\"x\": [1], \"y\": [1], \"z\": [1]}", true),
        ("[{\"x\": 1, \"y\": 1, \"z\": 1}]", true),
        ("{\"name\": \"post\", \"version\": \"1\"}", false),
        ("GOTO/1,2,3\n", false),
    ] {
        assert_eq!(post_grammar::is_point_list(text), is, "{text}");
    }
}

/// A list that was cut off is no shorter list.
#[test]
fn a_list_that_was_cut_off_is_told() {
    let all = both("x,y,z\n1,2,3\n1,2,3");
    assert!(
        all.iter().any(|told| told.starts_with("3:6 the list ends within this line")),
        "{all:?}"
    );
    assert!(!both("x,y,z\n1,2,3\n1,2,3\n\u{1a}").iter().any(|told| told.contains("ends")));
}

/// What nobody writes takes no memory to be refused.
#[test]
fn a_hostile_list_is_refused() {
    let wide = format!("x,y,z\n{}\n1,2,3\n", "1,".repeat(600_000));
    let all = read(wide.as_bytes(), usize::MAX);
    assert!(all[1].starts_with("2:1 a row of more than 1048576 bytes"), "{}", all[1]);
    assert!(all.iter().any(|told| told.contains("Goto")), "{}", all.len());
    for (list, told) in [
        (format!("[[{}0]]", "0,".repeat(1_000_000)), "more than 64 values in one"),
        (format!("[{}", "[".repeat(100_000)), "a bracket is still open"),
        (format!("[{}{}]", "[".repeat(1000), "]".repeat(1000)), "lists within lists"),
        (format!("[[0,0,0],{{\"a{}\":1}}]", "b".repeat(100_000)), "a list of points has no column"),
    ] {
        let all = read(list.as_bytes(), usize::MAX);
        let found = all.iter().find(|found| found.contains(told));
        assert!(found.is_some_and(|found| found.len() < 1000), "{told}");
    }
}

/// What joins files adds the line end that the first has not, and says so.
#[test]
fn a_list_that_was_cut_off_is_told_ahead_of_another_file() {
    let mark = char::from(NEXT_FILE);
    let all = both(&format!("x,y,z\n4,5,6\n4,5,-1\n$$ b.cls{mark}{mark}\nGOTO/1,1,1\nFINI\n"));
    assert!(
        all.iter().any(|told| told.starts_with("3:7 the list ends within this line")),
        "{all:?}"
    );
    assert!(all.iter().any(|told| told.contains("Goto { point: [1.0")), "{all:?}");
    // A file behind a list in JSON may be written as it likes.
    let mut bytes = format!("[[7,8,9],\n[7,8,10]]\n$$ d.cls{mark}\nPARTNO ").into_bytes();
    bytes.extend(b"Geh\xE4use\nGOTO/1,1,1\nFINI\n");
    for size in [1, 7, usize::MAX] {
        let all = read(&bytes, size);
        assert!(all.iter().any(|told| told.contains("Goto { point: [1.0")), "{all:?}");
        assert!(!all.iter().any(|told| told.contains("UTF-8")), "{all:?}");
    }
}

/// Files that are read one behind the other need not be of one form.
#[test]
fn lists_and_cl_files_follow_one_another() {
    let mark = char::from(NEXT_FILE);
    let text = format!(
        "FEDRAT/100\nGOTO/1,2,3\nGOTO/2,2,3\n$$ b.csv{mark}\nx,y,z\n4,5,6\n$$ c.json{mark}\n[[7,8,9],\n[7,8,10]]\n\
         $$ d.cls{mark}\nGOTO/1,1,1\nFINI\n"
    );
    let all = both(&text);
    let moves: Vec<&str> = all
        .iter()
        .filter(|told| told.contains("Goto"))
        .map(|told| told.split(' ').next().unwrap())
        .collect();
    assert_eq!(moves, ["2", "3", "6", "8", "9", "11"], "{all:?}");
    assert_eq!(all.iter().filter(|told| told.contains("Remark")).count(), 3, "{all:?}");
    assert!(!all.iter().any(|told| told.contains(mark)), "{all:?}");
}

/// Lines of a CL file are no header.
#[test]
fn a_cl_file_is_no_list() {
    for text in [
        "PARTNO a, b, c\nGOTO/1,2,3\n",
        "PPRINT/x,y,z\nGOTO/1,2,3\n",
        "TLON,GOFWD/(CIRCLE/0,0,0,10),ON,(LINE/0,0,0,10,0,0)\n",
        "$$ x, y, z\nGOTO/1,2,3\n",
        "UNITS/MM\n",
        "REMARK x,y,z\nGOTO/1,2,3\n",
    ] {
        let all = both(text);
        assert!(
            !all.iter().any(|told| told.contains("column") || told.contains("Fini")),
            "{all:?}"
        );
    }
}
