//! Logical lines: ends, continuations, comments, chunks, faults between good records.

use post_grammar::{ClBatch, ClPiece, ClReader, GotoRun, ReadError, Record, Statement};
use post_testkit::{Rng, randomised};
use std::io::{self, Cursor, Read};

/// Hands out at most so many bytes at a time, in turn.
struct Trickle<'a> {
    bytes: &'a [u8],
    sizes: std::iter::Cycle<std::vec::IntoIter<usize>>,
}

impl Read for Trickle<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let size = self.sizes.next().unwrap_or(1).min(buffer.len()).min(self.bytes.len());
        let (now, later) = self.bytes.split_at(size);
        buffer[..size].copy_from_slice(now);
        self.bytes = later;
        Ok(size)
    }
}

fn told(record: &Record<'_>) -> String {
    format!("{} {} {:?}", record.line, record.text(), record.statement)
}

/// Every record and fault, as text that tells them apart.
fn all(input: impl Read) -> Vec<String> {
    all_by(input, false)
}

/// Every record and fault; `runs` if records of one layout are to be taken together.
fn all_by(input: impl Read, runs: bool) -> Vec<String> {
    let mut reader = ClReader::new(input);
    let mut run = GotoRun::default();
    let mut found = Vec::new();
    loop {
        if runs {
            let text = reader.next_gotos(&mut run);
            found.extend((0..run.count()).map(|place| told(&run.record(place, text))));
        }
        match reader.next_record() {
            Ok(None) => return found,
            Ok(Some(record)) => found.push(told(&record)),
            Err(ReadError::Syntax(fault)) => {
                assert!(fault.text.get(fault.span.clone()).is_some(), "{fault:?}");
                found.push(format!("{fault:?}"));
            }
            Err(ReadError::Io(error)) => panic!("{error}"),
        }
    }
}

/// Every record and fault, read in batches before any of them is taken.
fn all_ahead(input: impl Read) -> Vec<String> {
    let mut reader = ClReader::new(input);
    let (mut reads, mut takes) = (GotoRun::default(), GotoRun::default());
    let mut found = Vec::new();
    let mut batch = ClBatch::default();
    loop {
        let goes_on = batch.fill(&mut reader, &mut reads);
        while let Some(piece) = batch.next_piece(&mut takes) {
            match piece {
                ClPiece::Gotos(text) => {
                    found.extend((0..takes.count()).map(|at| told(&takes.record(at, text))));
                }
                ClPiece::Record(record) => found.push(told(&record)),
                ClPiece::Unreadable(fault) => found.push(format!("{fault:?}")),
                ClPiece::Failed(error) => panic!("{error}"),
                ClPiece::End => assert!(!goes_on),
            }
        }
        assert!(batch.is_taken());
        assert_eq!(batch.position(), reader.bytes_read());
        assert_eq!(batch.ends_within_a_line(), reader.ends_within_a_line());
        if !goes_on {
            return found;
        }
    }
}

/// Line and text of each record; of a fault its message.
fn lines(text: impl AsRef<[u8]>) -> Vec<(u64, String)> {
    let mut reader = ClReader::new(text.as_ref());
    let mut found = Vec::new();
    loop {
        match reader.next_record() {
            Ok(None) => break,
            Ok(Some(record)) => found.push((record.line, record.text().into_owned())),
            Err(ReadError::Syntax(fault)) => {
                found.push((fault.line, format!("! {}", fault.message)))
            }
            Err(ReadError::Io(error)) => panic!("{error}"),
        }
    }
    assert_eq!(reader.bytes_read(), text.as_ref().len() as u64);
    found
}

fn expect(text: impl AsRef<[u8]>, expected: &[(u64, &str)]) {
    let found = lines(&text);
    let found: Vec<(u64, &str)> = found.iter().map(|(line, text)| (*line, text.as_str())).collect();
    assert_eq!(found, expected, "{:?}", String::from_utf8_lossy(text.as_ref()));
}

#[test]
fn line_ends() {
    for end in ["\n", "\r\n", "\r"] {
        let text = ["RAPID", "", "  \t", "GOTO/1,2,3", "FINI"].join(end);
        let expected = [(1, "RAPID"), (4, "GOTO/1,2,3"), (5, "FINI")];
        expect(&text, &expected);
        expect(format!("{text}{end}"), &expected);
        expect(format!("\u{FEFF}{text}"), &expected);
    }
    expect("", &[]);
    expect("\u{FEFF}", &[]);
    expect("\r\n\n\r", &[]);
    expect("FINI\r\n\x1A", &[(1, "FINI")]);
}

#[test]
fn a_dollar_continues() {
    expect("GOTO / 1, 2,  $\n  3\nFINI", &[(1, "GOTO / 1, 2, 3"), (3, "FINI")]);
    expect("GOTO/1,$ \r\n2,$\r\n3\r\nFINI", &[(1, "GOTO/1, 2, 3"), (4, "FINI")]);
    expect(
        "CYCLE / DEEP, DEPTH, 3.5, CLEAR,$\n 1.0\n",
        &[(1, "CYCLE / DEEP, DEPTH, 3.5, CLEAR, 1.0")],
    );
    expect("GOTO/1,2, $ $$ to be continued\n3\n", &[(1, "GOTO/1,2, 3")]);
    expect("\u{FEFF}GOTO/1,2, $\n3\n", &[(1, "GOTO/1,2, 3")]);
    expect(
        "$$-> CSYS / 1, 0, 0, 0, $\n 0, 1, 0, 0, $\n 0, 0, 1, 0\n",
        &[(1, "$$-> CSYS / 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0")],
    );
    expect("GOTO/1,2,3 $\n", &[(1, "! the file ends where this record should go on")]);
    expect("GOTO/1,2,3 $", &[(1, "! the file ends where this record should go on")]);
    // A blank line is the last piece of a record.
    expect("GOTO/1,2,3 $\n\nRAPID\n", &[(1, "GOTO/1,2,3 "), (3, "RAPID")]);
}

#[test]
fn a_comment_does_not_continue() {
    expect("RAPID $$ costs 5 $\nFINI\n", &[(1, "RAPID $$ costs 5 $"), (2, "FINI")]);
    expect("GOTO/1,2,3 $$\nFINI\n", &[(1, "GOTO/1,2,3 $$"), (2, "FINI")]);
    expect("$$ costs 5 $\nRAPID\n", &[(1, "$$ costs 5 $"), (2, "RAPID")]);
    expect(
        "PPRINT costs 5 $\nINSERT/A $\nRAPID\n",
        &[(1, "PPRINT costs 5 $"), (2, "INSERT/A $"), (3, "RAPID")],
    );
    expect("TOOL PATH/A$,TOOL,B$\nRAPID\n", &[(1, "TOOL PATH/A$,TOOL,B$"), (2, "RAPID")]);
}

#[test]
fn reading_goes_on_after_a_fault() {
    let text = "GOTO/1,2\nGOTO/1,2,3\n,,,\nFEDRAT/MMPM\nFINI\n";
    expect(
        text,
        &[
            (1, "! GOTO takes 3, 6 or 9 numbers, 2 are given"),
            (2, "GOTO/1,2,3"),
            (3, "! a record begins with a word"),
            (4, "! FEDRAT needs a number"),
            (5, "FINI"),
        ],
    );
    expect(
        b"RAPID\nGO\0TO/1,2,3\n\xFF\xFE\nFINI\n",
        &[
            (1, "RAPID"),
            (2, "! byte 0x00 is not text"),
            (3, "! a record begins with a word"),
            (4, "FINI"),
        ],
    );
}

#[test]
fn text_that_is_not_utf8_is_taken_for_latin1() {
    let mut reader = ClReader::new(&b"INSERT/Fr\xE4sen\nPPRINT Fr\xC3\xA4sen\n"[..]);
    let insert = reader.next_record().unwrap().unwrap().statement;
    assert_eq!(insert, Statement::Insert("Fräsen".to_owned()));
    let print = reader.next_record().unwrap().unwrap().statement;
    assert_eq!(print, Statement::Print("Fräsen".to_owned()));
}

#[test]
fn a_record_may_be_long_but_not_endless() {
    let long = format!("PPRINT {}\nFINI\n", "x".repeat(1024 * 1024 - 7));
    assert_eq!(all(Cursor::new(&long)).len(), 2);
    let message = "! a record of more than 1048576 bytes";
    expect(
        format!("RAPID\nPPRINT {}\r\nFINI\n", "x".repeat(1024 * 1024 - 6)),
        &[(1, "RAPID"), (2, message), (3, "FINI")],
    );
    expect(format!("PPRINT {}", "x".repeat(5_000_000)), &[(1, message)]);
    expect(format!("GOTO/1,2,{}3\nFINI\n", " ".repeat(2_000_000)), &[(1, message), (2, "FINI")]);
    // Of a record that is too long because it goes on and on, the rest are records of their own.
    let continued = lines(format!("KNOT/{}1\nFINI\n", "1,$\n".repeat(300_000)));
    assert_eq!(continued[0], (1, message.to_owned()));
    assert_eq!(continued.last(), Some(&(300_002, "FINI".to_owned())));
}

#[test]
fn a_long_record_takes_time_in_proportion() {
    for filler in [" ", ",", ", ", "1,", "1 ", "$$", "A,", ",TOOL", "/", "é"] {
        for head in ["NOSUCH/", "TOOL PATH/", "$$-> X/", "REMARK -> ", "CYCLE/DRILL,", "KNOT/", ""]
        {
            let text = format!("{head}{}", filler.repeat(100_000 / filler.len()));
            all(text.as_bytes());
        }
    }
}

#[test]
fn a_failing_input_is_passed_on() {
    struct Failing;
    impl Read for Failing {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("the disk is gone"))
        }
    }
    let input = Cursor::new("RAPID\nFINI").chain(Failing);
    let mut reader = ClReader::new(input);
    assert!(matches!(reader.next_record(), Ok(Some(_))));
    let error = reader.next_record().expect_err("FINI may not be all of the line");
    assert!(matches!(&error, ReadError::Io(error) if error.to_string() == "the disk is gone"));
}

const SAMPLE: &str = "\u{FEFF}PARTNO blade\r\nUNITS / MM\r\n\r\n$$-> CSYS / 1, 0, 0, 0, $\r\n 0, 1, 0, 0, $\r\n 0, 0, 1, 0\r\n\
    GOTO / 1, 2, 3, $\n0, 0, 1\nGOTO/1,2\rRAPID\rGOTO/4.5,-.5,1.E-3\n\rCIRCLE/0,0,0,0,0,1 $$ c $\nFINI";

#[test]
fn chunks_of_points_do_not_matter() {
    let (rounds, mut rng) = randomised(256, 1);
    for _ in rounds {
        let text = rng.text(
            "(( ?GOTO/|GOTO / |GOTO/|GOTO/|GOTO/|RAPID|\\$\\$ |FEDRAT/)(-?[0-9]{1,3}(\\.[0-9]{0,11})?,?){0,7}( ?\\$| \\$\\$ x|x|)(\n|\n|\r\n|\r|\n\n)){0,11}",
        );
        let sizes = rng.some([1, 6], |rng| 1 + rng.pick(199));
        let trickle = Trickle { bytes: text.as_bytes(), sizes: sizes.into_iter().cycle() };
        assert_eq!(all(trickle), all(text.as_bytes()), "{text:?}");
    }
}

/// A way to write a `GOTO`: what stands around its numbers, and how many digits they have.
struct Form {
    /// In front of each number and after the last, with `GOTO` and line ends.
    between: Vec<String>,
    digits: Vec<[usize; 2]>,
}

impl Form {
    fn random(rng: &mut Rng) -> Self {
        let count = *rng.choose(&[3, 6, 6, 6, 9]);
        let end = rng.text("(\n|\n|\r\n|\r)");
        let comma = rng.text("( ?,[ \t]{0,2})");
        let mut between = vec![rng.text("(GOTO/|GOTO/ | GOTO  / )")];
        for _ in 1..count {
            let parted = rng.pick(5) == 0;
            between.push(if parted { format!("{comma}$ {end} ") } else { comma.clone() });
        }
        between.push(rng.text("[ \t]{0,2}") + &end);
        let digits = (0..count).map(|_| [rng.pick(5), rng.pick(12)]).collect();
        Self { between, digits }
    }

    fn write(&self, rng: &mut Rng, out: &mut String) {
        for (before, &[whole, decimals]) in self.between.iter().zip(&self.digits) {
            *out += before;
            *out += &rng.text(["-?", "", ""][whole % 3]);
            *out += &rng.text(&format!("[0-9]{{{whole}}}"));
            if decimals > 0 || whole == 0 {
                *out += &rng.text(&format!("\\.[0-9]{{{decimals}}}"));
            }
        }
        *out += &self.between[self.digits.len()];
    }
}

/// A reader that gets a byte at a time never has a whole record with something before it, so that none is read by its
/// layout.
#[test]
fn records_of_one_layout_are_read_as_each_by_itself() {
    let (rounds, mut rng) = randomised(512, 5);
    for _ in rounds {
        let forms = rng.some([1, 3], Form::random);
        let mut text = String::new();
        for _ in 0..rng.pick(30) {
            let form = rng.choose(&forms);
            for _ in 0..rng.pick(6) {
                form.write(&mut rng, &mut text);
            }
            text += &rng.text("(||RAPID\n|\n|FEDRAT/MMPM,1\r\n|GOTO/1,2,3)");
        }
        let mut bytes = text.into_bytes();
        for _ in 0..rng.pick(4) {
            if !bytes.is_empty() {
                let at = rng.pick(bytes.len());
                bytes[at] = *rng.choose(b"$,. -+0E:/\r\n\x80x");
            }
        }
        let alone = Trickle { bytes: &bytes, sizes: vec![1].into_iter().cycle() };
        let expected = all(alone);
        let shown = String::from_utf8_lossy(&bytes);
        assert_eq!(all(bytes.as_slice()), expected, "{shown:?}");
        assert_eq!(all_by(bytes.as_slice(), true), expected, "{shown:?}");
        assert_eq!(all_ahead(bytes.as_slice()), expected, "{shown:?}");
        let sizes = rng.some([1, 6], |rng| 1 + rng.pick(300));
        let trickle = Trickle { bytes: &bytes, sizes: sizes.into_iter().cycle() };
        assert_eq!(all_by(trickle, rng.pick(2) == 0), expected, "{shown:?}");
    }
}

/// Long enough for many chunks of the input, each of which ends somewhere within a record.
#[test]
fn a_long_file_of_one_layout_is_read_like_its_records() {
    let (_, mut rng) = randomised(1, 6);
    let form = Form {
        between: ["GOTO / ", ", ", ", $\n ", ", ", ", ", ", ", " \n"].map(String::from).to_vec(),
        digits: vec![[4, 10], [2, 10], [1, 4], [1, 10], [1, 10], [1, 10]],
    };
    let mut text = String::new();
    for _ in 0..12_000 {
        form.write(&mut rng, &mut text);
    }
    let mut reader = ClReader::new(text.as_bytes());
    let mut lines = text.lines();
    for index in 0..12_000 {
        let record = reader.next_record().unwrap().unwrap();
        let pieces = [(); 2].map(|()| lines.next().unwrap());
        let joined = pieces[0].strip_suffix('$').unwrap().trim_end().to_owned() + pieces[1];
        assert_eq!((record.line, record.text()), (1 + 2 * index, joined.as_str().into()));
        let expected = post_grammar::parse_record(&joined).unwrap();
        assert_eq!(format!("{:?}", record.statement), format!("{expected:?}"), "{joined}");
    }
    assert!(reader.next_record().unwrap().is_none());
}

#[test]
fn chunks_do_not_matter() {
    let (rounds, mut rng) = randomised(256, 2);
    for _ in rounds {
        let sizes = rng.some([1, 6], |rng| 1 + rng.pick(39));
        let trickle = Trickle { bytes: SAMPLE.as_bytes(), sizes: sizes.into_iter().cycle() };
        assert_eq!(all(trickle), all(SAMPLE.as_bytes()));
    }
}

#[test]
fn random_bytes_are_read_or_refused() {
    let (rounds, mut rng) = randomised(256, 3);
    for _ in rounds {
        let bytes = rng.bytes(400);
        let sizes = rng.some([1, 4], |rng| 1 + rng.pick(39));
        let trickle = Trickle { bytes: &bytes, sizes: sizes.into_iter().cycle() };
        assert_eq!(all(trickle), all(bytes.as_slice()), "{bytes:?}");
    }
}

#[test]
fn random_text_is_read_or_refused() {
    let (rounds, mut rng) = randomised(256, 4);
    for _ in rounds {
        let text = rng.text(
            "((GOTO|CYCLE|FEDRAT|ROTABL|CUTCOM|SPINDL|LOAD|TLDATA|CIRCLE|REMARK|\\$\\$->|TOOL PATH|KNOT|DELAY|[A-Z]{1,6})?[ /]{0,2}([A-Z0-9.,+$ -]|CLW|TOOL,|INCR,|DRILL,|AAXIS,|\\$\n|\n|é){0,12}\n){0,20}",
        );
        all(text.as_bytes());
    }
}

/// Whether a line end stands behind the last line, whatever the chunks and the blanks at the end.
#[test]
fn a_file_that_ends_within_a_line_is_told() {
    for (text, within) in [
        ("", false),
        ("GOTO/1,2,3", true),
        ("GOTO/1,2,3\n", false),
        ("GOTO/1,2,3\r", false),
        ("GOTO/1,2,3\r\n", false),
        ("GOTO/1,2,3\n \t\x1A", false),
        ("GOTO/1,2,3  ", true),
        ("FINI", true),
    ] {
        for chunk in [1, 2, 7, 100] {
            let mut reader = ClReader::new(Trickle {
                bytes: text.as_bytes(),
                sizes: vec![chunk].into_iter().cycle(),
            });
            while reader.next_record().unwrap().is_some() {}
            assert_eq!(reader.ends_within_a_line(), within, "{text:?} by {chunk}");
        }
    }
}

/// What is passed over are points alone, and of each row of them the last is read: with its line, and in its words.
#[test]
fn points_that_nobody_wants_are_passed_over() {
    let (rounds, mut rng) = randomised(200u32, 31);
    let mut passed = 0;
    for _ in rounds {
        let end = *rng.choose(&["\n", "\r\n", "\r"]);
        let mut text = String::new();
        for _ in 0..rng.pick(60) {
            let [x, y] = [rng.range(-99.0, 99.0), rng.range(-9.0, 9.0)];
            text += &match rng.pick(12) {
                0 => "RAPID".to_owned(),
                1 => "$$ GOTO/1,2,3".to_owned(),
                2 => format!("GOTO/{x:.3},{y:.3},1 $$ a remark"),
                3 | 4 => format!("GOTO / {x:.4}, {y:.4}, 5.0000, ${end}0.0, 0.0, 1.0"),
                5 => String::new(),
                _ => format!("GOTO/{x:.3},{y:.3},20.000,0.0,0.6,0.8"),
            };
            text += end;
        }
        let sizes = vec![rng.pick(90) + 1, rng.pick(400) + 1].into_iter().cycle();
        let expected = all(text.as_bytes());
        let mut reader = ClReader::new(Trickle { bytes: text.as_bytes(), sizes });
        let mut found = Vec::new();
        loop {
            reader.skip_gotos();
            match reader.next_record() {
                Ok(None) => break,
                Ok(Some(record)) => found.push(told(&record)),
                Err(fault) => panic!("{fault} {text}"),
            }
        }
        passed += expected.len() - found.len();
        let is_point = |told: &String| told.contains("Goto");
        let mut found = found.into_iter().peekable();
        for (place, record) in expected.iter().enumerate() {
            if found.next_if_eq(record).is_some() {
                continue;
            }
            let next = expected.get(place + 1).is_some_and(is_point);
            assert!(is_point(record) && next, "{record}\n{text}");
        }
        assert_eq!(found.next(), None, "{text}");
    }
    assert!(passed > 0);
}
