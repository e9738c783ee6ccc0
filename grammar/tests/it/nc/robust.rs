//! Whatever the bytes: no panic, time in proportion to them, and a bound on memory.

use super::{conversational, hash, names, read};
use post_grammar::nc::{NcBlock, NcReader, NcSyntax, parse_block};
use post_testkit::{randomised, shared};
use std::fs;
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::time::{Duration, Instant};

fn families() -> [NcSyntax; 3] {
    [hash(), names(), conversational()]
}

/// Time that a megabyte may take at the most, on the slowest machine: it takes a hundredth of that.
const PATIENCE: Duration = Duration::from_secs(30);

#[test]
fn texts_made_to_be_slow_are_not() {
    let patterns = [
        "[",
        "(",
        "#[",
        "ATAN[",
        "X[1+",
        "SIN(",
        "1+",
        "#1=",
        "-",
        "NOT ",
        "R1=R[",
        "A[",
        "A(",
        "IF ",
        "IF[1]",
        "N1",
        "\"",
        "O<",
        "#",
        "<",
        ",",
        "X=AC(",
        "CYCLE81(1,",
        "DEF REAL ",
        "DEF REAL X[1,",
        "FOR R1=1",
        "1**",
        "REPEAT A ",
        "CYCL DEF 200 Q1=",
        "CYCL DEF 200 Q",
        "SIN ",
        "Q1=-",
        "Q1=SIN ",
        "FN 0: ",
        "TOOL CALL ",
        "X+",
        "~\n",
        "A-",
        "A.",
        "1 CYCL DEF 200 A\nQ1=1\n",
        "%\n",
        "%\nX:\n",
        "O1\n%\n",
        "X 1 1\n",
        "\r",
        "\r\n",
        "\0",
        "9",
        ".",
        "\u{FF}",
    ];
    for syntax in families() {
        for pattern in patterns {
            let begin = Instant::now();
            read(pattern.repeat(100_000 / pattern.len()).as_bytes(), &syntax);
            // Short enough to be given to the grammar.
            let line = pattern.repeat(4_000 / pattern.len());
            for _ in 0..10 {
                let _ = parse_block(&line, &syntax);
            }
            assert!(begin.elapsed() < PATIENCE, "{pattern}: {:?}", begin.elapsed());
        }
    }
}

#[test]
fn what_is_too_much_is_refused() {
    let digits = "9".repeat(10_000);
    let nested = format!("#1={}1{}", "[".repeat(40), "]".repeat(40));
    let sum = format!("#1={}1", "1+".repeat(400));
    let remark = format!("({})", "A".repeat(20_000));
    for (line, message) in [
        (format!("X{digits}"), "a number of 10000 characters, at most 40 are read"),
        (format!("N{digits}"), "a number of 10000 characters, at most 40 are read"),
        (
            "N99999999999999999999 X1".to_owned(),
            "99999999999999999999 is too large for a number of a block",
        ),
        (nested, "more than 32 brackets are open"),
        (sum, "an expression of more than 256 operators"),
        (remark, "a block of more than 16384 bytes"),
        (format!("##########{}", "1=1"), "more than 8 `#` in a row"),
    ] {
        let (blocks, faults) = read(format!("{line}\nX1\n").as_bytes(), &hash());
        assert_eq!((blocks.len(), faults.len()), (1, 1), "{message}");
        assert_eq!(faults[0].message, message);
        assert!(faults[0].text.len() < 500);
        assert!(faults[0].text.get(faults[0].span.clone()).is_some());
    }
}

/// As many bytes as wanted of one line without an end.
struct Endless {
    at: u64,
    length: u64,
    most_asked: usize,
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let left = usize::try_from(self.length - self.at).unwrap_or(usize::MAX);
        let count = buffer.len().min(left);
        buffer[..count].fill(b'X');
        self.at += count as u64;
        self.most_asked = self.most_asked.max(buffer.len());
        Ok(count)
    }
}

impl Seek for Endless {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        if let SeekFrom::Start(at) = place {
            self.at = at;
        }
        Ok(self.at)
    }
}

#[test]
fn a_line_without_end_is_not_kept() {
    for syntax in families() {
        let mut input = Endless { at: 0, length: 200_000_000, most_asked: 0 };
        let mut reader = NcReader::new(&mut input, syntax);
        let mut block = NcBlock::default();
        let fault = reader.next_block(&mut block).expect_err("this is no block").to_string();
        assert!(fault.contains("a block of more than 16384 bytes"), "{fault}");
        assert!(!reader.next_block(&mut block).unwrap());
        drop(reader);
        assert!(input.most_asked <= 64 * 1024, "{}", input.most_asked);
    }
}

/// Lines of real programs, for mutation.
fn real_lines() -> Vec<(Vec<u8>, NcSyntax)> {
    let Some(folder) = shared("data/nc") else {
        return Vec::new();
    };
    [
        ("linuxcnc_boat-xyzac.ngc", hash()),
        ("siemens_ElMoe_keychain.mpf", names()),
        ("nxpost_dmc100_millplus_mm.ptp", conversational()),
        ("nxpost_dmu70evo_840d_in.ptp", names()),
    ]
    .map(|(name, syntax)| (fs::read(folder.join(name)).expect("the file is there"), syntax))
    .into()
}

#[test]
fn any_bytes_are_read_to_their_end() {
    let (rounds, mut rng) = randomised(256, 1);
    for _ in rounds {
        let bytes = rng.bytes(2000);
        for syntax in families() {
            read(&bytes, &syntax);
        }
    }
}

#[test]
fn any_text_of_a_program_is_read_to_its_end() {
    let (rounds, mut rng) = randomised(256, 2);
    for _ in rounds {
        let text = rng.text(
            "([A-Z#]{1,3}[0-9=+.\\-]{0,3}|[\\[\\]()\"%~;:/<>$*,_]|\n|IF|GOTO|WHILE|CYCL DEF|LBL|SIN|AND| ){0,200}",
        );
        for syntax in families() {
            read(text.as_bytes(), &syntax);
        }
    }
}

#[test]
fn real_programs_with_bytes_changed_are_read_to_their_end() {
    let programs = real_lines();
    let (rounds, mut rng) = randomised(256, 3);
    for _ in rounds {
        let Some((program, syntax)) = programs.get(rng.pick(4)) else {
            continue;
        };
        let from = rng.pick(program.len());
        let mut text = program[from..program.len().min(from + 3000)].to_vec();
        for _ in 0..1 + rng.pick(19) {
            if text.is_empty() {
                break;
            }
            let (at, byte) = (rng.pick(text.len()), rng.next() as u8);
            match rng.pick(3) {
                0 => text[at] = byte,
                1 => text.insert(at, byte),
                _ => {
                    text.remove(at);
                }
            }
        }
        let (blocks, faults) = read(&text, syntax);
        let lines = text.split(|&byte| byte == b'\n' || byte == b'\r').count();
        assert!(blocks.len() + faults.len() <= lines, "{text:?}");
    }
}

/// However the input hands over its bytes, the blocks are the same.
#[test]
fn small_helpings_change_nothing() {
    let programs = real_lines();
    for (program, syntax) in programs.iter() {
        let program = &program[..program.len().min(6000)];
        let whole = read(program, syntax);
        for helping in 1..40 {
            let input = Helpings { input: Cursor::new(program), helping };
            let mut reader = NcReader::new(input, syntax.clone());
            let mut block = NcBlock::default();
            let mut blocks = Vec::new();
            let mut faults = 0;
            loop {
                match reader.next_block(&mut block) {
                    Ok(false) => break,
                    Ok(true) => blocks.push(block.clone()),
                    Err(_) => faults += 1,
                }
            }
            assert_eq!((&blocks, faults), (&whole.0, whole.1.len()), "{helping}");
        }
    }
}

/// An input that hands over few bytes at a time.
struct Helpings<'t> {
    input: Cursor<&'t [u8]>,
    helping: usize,
}

impl Read for Helpings<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(self.helping);
        self.input.read(&mut buffer[..count])
    }
}

impl Seek for Helpings<'_> {
    fn seek(&mut self, place: SeekFrom) -> std::io::Result<u64> {
        self.input.seek(place)
    }
}
