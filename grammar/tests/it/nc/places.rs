//! Going back, and looking for the places that a program jumps to.

use super::{conversational, hash, names, read};
use post_grammar::nc::{JumpDirection, NcBlock, NcItem, NcMark, NcReader, NcSyntax, NcTarget};
use std::io::Cursor;

fn reader(text: &str, syntax: &NcSyntax) -> NcReader<Cursor<String>> {
    NcReader::new(Cursor::new(text.to_owned()), syntax.clone())
}

/// Reads the next block, and gives its line.
fn next<R: std::io::Read + std::io::Seek>(reader: &mut NcReader<R>) -> Option<u64> {
    let mut block = NcBlock::default();
    let read = reader.next_block(&mut block).expect("the block reads");
    read.then_some(block.line)
}

fn line(found: Option<NcMark>) -> Option<u64> {
    found.map(|mark| mark.line())
}

#[test]
fn a_mark_leads_back_however_far() {
    // Longer than any buffer.
    let text: String = (0..40_000).map(|at| format!("N{at} G1 X{at}. Y{at}.5\r\n")).collect();
    let mut reader = reader(&text, &hash());
    let mut block = NcBlock::default();
    let mut marks = Vec::new();
    loop {
        let mark = reader.mark();
        if !reader.next_block(&mut block).unwrap() {
            break;
        }
        marks.push((mark, block.clone()));
    }
    assert_eq!(marks.len(), 40_000);
    for at in (0..marks.len()).rev().step_by(37).chain([0, 39_999, 20_000, 20_001, 1]) {
        let (mark, expected) = &marks[at];
        reader.go_to(*mark).unwrap();
        assert!(reader.next_block(&mut block).unwrap());
        assert_eq!(&block, expected);
        assert_eq!(mark.line(), at as u64 + 1);
    }
}

#[test]
fn what_is_in_front_of_the_reader_is_not_the_programs() {
    let mut input = Cursor::new("rubbish\nN1 X1\nN2 X2\n".to_owned());
    input.set_position(8);
    let mut reader = NcReader::new(input, hash());
    let start = reader.mark();
    assert_eq!((next(&mut reader), next(&mut reader)), (Some(1), Some(2)));
    reader.go_to(start).unwrap();
    assert_eq!(next(&mut reader), Some(1));
}

#[test]
fn numbers_are_found_forwards_backwards_and_around() {
    let mut reader = reader("N10 X1\n/N020 X2\nX3 N30\nn 30 X4\nN10 X5\nN1000 X6\n", &hash());
    let target = NcTarget::Number;
    assert_eq!(next(&mut reader), Some(1));
    for (number, direction, expected) in [
        (10, JumpDirection::Forward, Some(5)),
        (10, JumpDirection::Back, Some(1)),
        (10, JumpDirection::Anywhere, Some(5)),
        (20, JumpDirection::Forward, Some(2)),
        (30, JumpDirection::Anywhere, Some(4)),
        (100, JumpDirection::Anywhere, None),
        (1000, JumpDirection::Anywhere, Some(6)),
    ] {
        let found = reader.find(&target(number), direction).unwrap();
        assert_eq!(line(found), expected, "N{number} {direction:?}");
    }
    // Looking moves nothing, and what was found once is not looked for again.
    let searched = reader.lines_searched();
    assert_eq!(line(reader.find(&target(20), JumpDirection::Forward).unwrap()), Some(2));
    assert_eq!(reader.lines_searched(), searched);
    assert_eq!(next(&mut reader), Some(2));
    let back = reader.find(&target(10), JumpDirection::Anywhere).unwrap().unwrap();
    reader.go_to(back).unwrap();
    assert_eq!(next(&mut reader), Some(5));
    assert_eq!(line(reader.find(&target(10), JumpDirection::Back).unwrap()), Some(5));
    assert_eq!(line(reader.find(&target(10), JumpDirection::Anywhere).unwrap()), Some(1));
}

/// A program of a thousand calls is not read a thousand times: neither to a place ahead nor to one behind.
#[test]
fn a_place_is_looked_for_once_wherever_it_is_gone_to_from() {
    let calls = "X1\n".repeat(1000);
    let text = format!("N7 X0\nN9 X0\n{calls}N8 X2\nN9 X0\n");
    for (number, expected) in [(8, [1003; 2]), (7, [1; 2]), (9, [1004; 2]), (5, [0; 2])] {
        let mut reader = reader(&text, &hash());
        let target = NcTarget::Number(number);
        next(&mut reader);
        next(&mut reader);
        let mut found = Vec::new();
        for _ in 0..1000 {
            found.push(line(reader.find(&target, JumpDirection::Anywhere).unwrap()).unwrap_or(0));
            assert!(reader.next_block(&mut NcBlock::default()).unwrap());
        }
        assert_eq!([found[0], found[999]], expected, "N{number}");
        let most = if number == 5 { 1000 * 1004 } else { 3000 };
        assert!(reader.lines_searched() < most, "N{number}: {}", reader.lines_searched());
    }
}

#[test]
fn labels_programs_and_subprograms_are_found() {
    let text = "G0 X1\nN5 MARK1: G1\nMARK12: X1\n mark2 :\n;MARK3:\nPROC LAP\nPROC LAP2(INT A)\n";
    let mut reader = reader(text, &names());
    for (name, expected) in
        [("MARK1", Some(2)), ("MARK12", Some(3)), ("MARK2", Some(4)), ("MARK3", None)]
    {
        let found =
            reader.find(&NcTarget::Label(name.to_owned()), JumpDirection::Anywhere).unwrap();
        assert_eq!(line(found), expected, "{name}");
    }
    for (name, expected) in [("LAP", Some(6)), ("LAP2", Some(7)), ("LA", None)] {
        let found =
            reader.find(&NcTarget::Subprogram(name.to_owned()), JumpDirection::Anywhere).unwrap();
        assert_eq!(line(found), expected, "{name}");
    }

    let text = "o100 call [1]\no100 sub\no100 endsub\no<lap 1> sub\nO0100 (SUB)\n:200\nO<PART>\nO3000 G1\n<PART 2>\n";
    let mut reader = self::reader(text, &hash());
    for (target, expected) in [
        (NcTarget::Subprogram("100".to_owned()), Some(2)),
        (NcTarget::Subprogram("<LAP1>".to_owned()), Some(4)),
        (NcTarget::Program("O100".to_owned()), Some(5)),
        (NcTarget::Program("O200".to_owned()), Some(6)),
        (NcTarget::Program("O<PART>".to_owned()), Some(7)),
        (NcTarget::Program("O3000".to_owned()), Some(8)),
        (NcTarget::Program("<PART2>".to_owned()), Some(9)),
        (NcTarget::Program("O300".to_owned()), None),
    ] {
        let found = reader.find(&target, JumpDirection::Anywhere).unwrap();
        assert_eq!(line(found), expected, "{target:?}");
    }

    let text =
        "0 BEGIN PGM A MM\n1 LBL 5\n2 L X+5\n3 LBL 0\n4 lbl \"Bohren\"\n5 LBL 50\n6 CALL LBL 5\n";
    let mut reader = self::reader(text, &conversational());
    for (name, expected) in
        [("5", Some(2)), ("50", Some(6)), ("BOHREN", Some(5)), ("BOHR", None), ("6", None)]
    {
        let found =
            reader.find(&NcTarget::Label(name.to_owned()), JumpDirection::Anywhere).unwrap();
        assert_eq!(line(found), expected, "{name}");
    }
    assert_eq!(line(reader.find(&NcTarget::Number(3), JumpDirection::Forward).unwrap()), Some(4));
}

#[test]
fn listings_around_programs_are_skipped_and_counted() {
    for (text, syntax, lines, header, trailer) in [
        ("(OURS)\n%\nO1\nX1\nM30\n%\n", hash(), vec![3, 4, 5], 1, 0),
        ("(OURS)\nX1\nM30\n%\nO2\nX2\n%\n", hash(), vec![1, 2, 3, 4, 5, 6], 0, 0),
        ("Listing of: me\n\n%\nO1\nX1\nM30\n%\nEnd of listing: 5\n\n", hash(), vec![4, 5, 6], 2, 2),
        ("\u{FEFF}Listing: me\n%\nX1\n", hash(), vec![3], 1, 0),
        // A program that lacks its first `%` is no listing, nor is one with a fault in its second line.
        ("O1\nX1\nM30\n%\n", hash(), vec![1, 2, 3], 0, 0),
        ("=====\nX1\n%\n", hash(), vec![2], 0, 0),
        ("Part: one\nN1 G0\n%\n\n\n", hash(), vec![2], 0, 0),
        // Two programs of one tape.
        ("%\nO1\nM30\n%\nO2\nM30\n%\n", hash(), vec![2, 3, 4, 5, 6], 0, 0),
        ("%\nO1\nM30\n%\nnext: tape\n%\nO2\n%", hash(), vec![2, 3, 4, 7], 0, 1),
        ("Listing of: me\n%_N_A_MPF\n;$PATH=/_N_MPF_DIR\nX1\n", names(), vec![2, 3, 4], 1, 0),
        ("Listing: me\n0 BEGIN PGM A MM\n1 L X+1\n", conversational(), vec![2, 3], 1, 0),
        ("%\nOFinal ToolPath\nOther text\nX1\n%", hash(), vec![2, 3, 4], 0, 0),
        ("%\n\0\0\n  \t\nX1\n\x1A", hash(), vec![4], 0, 0),
    ] {
        let mut reader = reader(text, &syntax);
        let mut block = NcBlock::default();
        let mut found = Vec::new();
        loop {
            match reader.next_block(&mut block) {
                Ok(false) => break,
                Ok(true) => found.push(block.line),
                Err(_) => {}
            }
        }
        assert_eq!(found, lines, "{text:?}");
        assert_eq!((reader.header_lines(), reader.trailer_lines()), (header, trailer), "{text:?}");
    }
}

#[test]
fn continued_blocks_are_one() {
    let text = "1 CYCL DEF 200 BOHREN ~\r\n    Q200=+2 ;SICHERHEITS-ABST. ~\r\n    Q201=-10 ;TIEFE\r\n2 L X+1\r\n3 CYCL DEF 207 GEW\n    Q239=+1 ;STEIGUNG\n    Q203=+0\n4 Q1=+5\n5 ; rough ~\n6 L Y+1 ~\n Z+5\n";
    let (blocks, faults) = read(text.as_bytes(), &conversational());
    assert_eq!(faults, []);
    let lines: Vec<_> = blocks.iter().map(|block| block.line).collect();
    assert_eq!(lines, [1, 4, 5, 8, 9, 10]);
    assert_eq!(blocks[0].remarks, ["SICHERHEITS-ABST.", "TIEFE"]);
    assert_eq!(blocks[0].items[2], NcItem::Text("BOHREN".to_owned()));
    assert_eq!(blocks[0].items.len(), 5);
    assert_eq!(blocks[2].items.len(), 5);
    assert_eq!(blocks[4].remarks, ["rough ~"]);
    assert_eq!(blocks[5].items.len(), 3);
}

#[test]
fn a_fault_leaves_the_reader_ready_for_the_next_block() {
    let (blocks, faults) = read(b"X1\nX1 1\nX2\r(\rX3\n\"\nY=\nX4", &hash());
    let lines: Vec<_> = blocks.iter().map(|block| block.line).collect();
    assert_eq!(lines, [1, 3, 5, 8]);
    let lines: Vec<_> = faults.iter().map(|fault| fault.line).collect();
    assert_eq!(lines, [2, 4, 6, 7]);
}

#[test]
fn a_fault_in_a_line_that_is_continued_is_that_blocks() {
    let text = b"1 L X+1 ~\n~\x00\x80 ~\n Z+1\n4 L X+2\n";
    let (blocks, faults) = read(text, &conversational());
    let lines: Vec<_> = blocks.iter().map(|block| block.line).collect();
    assert_eq!((lines, faults.len()), (vec![4], 1));
}
