//! A record whose word nobody knows: the file is refused, or the tool goes the same way all the same. In posting and in the
//! reading that `verify` does for itself.

use super::*;

/// Nobody's word.
const STRANGE: &str = "ZZYZX";

/// The samples, and of each machine what it makes.
fn samples() -> Vec<PathBuf> {
    let folders = ["tests/samples", "tests/machines"];
    let mut files: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| fs::read_dir(repository().join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| !path.to_string_lossy().contains(".refused."))
        .collect();
    files.sort();
    files
}

/// All places where the tool goes.
fn path(beats: &[Beat]) -> Vec<Vector3<f64>> {
    let mut path = Vec::new();
    for beat in beats {
        match beat {
            Beat::To { tip, .. } => path.push(*tip),
            Beat::Through(points) => path.extend(points),
            Beat::Said(_) => {}
        }
    }
    path
}

/// The lines with another word for the record that begins in one of them; none if no word begins there.
fn renamed(lines: &[&str], place: usize) -> Option<String> {
    let line = lines[place].trim_start();
    let end = match line.get(..9) {
        Some("TOOL PATH") => 9,
        _ => line
            .find(|letter: char| !(letter.is_ascii_alphanumeric() || "_-.".contains(letter)))
            .unwrap_or(line.len()),
    };
    if !line.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
        return None;
    }
    let mut lines = lines.to_vec();
    let strange = format!("{STRANGE}{}", &line[end..]);
    lines[place] = &strange;
    Some(lines.join("\n") + "\n")
}

/// The lines in which records begin.
fn records(text: &[u8]) -> Vec<usize> {
    let mut reader = ClReader::new(text);
    let mut lines = Vec::new();
    while let Ok(Some(record)) = reader.next_record() {
        lines.push(record.line as usize - 1);
    }
    lines
}

#[test]
fn a_record_that_nobody_knows_never_changes_the_path() {
    let how = How::default();
    let (mut renamings, mut refusals, mut sound) = (0, 0, 0);
    let mut wrong = Vec::new();
    for file in samples() {
        let text = String::from_utf8_lossy(&fs::read(&file).unwrap()).into_owned();
        let lines: Vec<&str> = text.lines().collect();
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let (whole, faults) = posted(text.as_bytes(), &how);
        let expected = [path(&whole), path(&course(text.as_bytes(), &how).0)];
        sound += usize::from(faults.is_empty());
        for place in records(text.as_bytes()) {
            let Some(text) = renamed(&lines, place) else {
                continue;
            };
            renamings += 1;
            let readings = [posted(text.as_bytes(), &how), course(text.as_bytes(), &how)];
            let ways = ["posted", "read again"].iter().zip(&expected);
            for ((reading, expected), (beats, faults)) in ways.zip(readings) {
                refusals += usize::from(!faults.is_empty());
                let found = path(&beats);
                let same = found.len() == expected.len()
                    && found.iter().zip(expected).all(|(a, b)| (a - b).norm() < SAME);
                if faults.is_empty() && !same {
                    wrong.push(format!("{name}:{} {reading}: {}", place + 1, lines[place]));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(renamings > 2_500 && sound > 30, "{renamings} {refusals} {sound}");
}

/// What the two readings find wrong where the user lets the word pass.
fn with_allowed(text: &str, word: &str) -> [Vec<String>; 2] {
    let how = How { allowed: vec![word.to_owned()], ..How::default() };
    [posted(text.as_bytes(), &how).1, course(text.as_bytes(), &how).1]
}

#[test]
fn what_may_be_a_move_cannot_be_allowed() {
    let file = |record: &str| {
        format!("UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nGOTO/0,0,0\n{record}\nGOTO/10,0,0\nFINI\n")
    };
    let moves = [
        "ZZYZX/1,2,3",
        "ZZYZX/1,2,3,A,4",
        "ARC/1",
        "GOFWD/L1",
        "TLLFT,GOLFT/L1,PAST,L2",
        "TLON,GOFWD/C1,ON,L1",
        "INDIRV/V1",
        "PSIS/S1",
        "HELIX/1",
        "COPY/1",
        "CALL/M1",
        "RETRCT",
        "THREAD/1",
        "PLUNGE/1",
    ];
    for record in moves {
        let word: String = record.chars().take_while(char::is_ascii_alphanumeric).collect();
        for faults in with_allowed(&file(record), &word) {
            assert!(!faults.is_empty(), "{record}");
        }
    }
    // Numbers too few for a point, and numbers before the first move or behind the last.
    let head = file("").replace("LOADTL/1", "ZZYZX/1,2,3\nLOADTL/1");
    let tail = file("").replace("FINI", "ZZYZX/1,2,3\nFINI");
    for text in [file("ZZYZX/1,2"), head, tail] {
        assert_eq!(with_allowed(&text, "ZZYZX"), [const { Vec::<String>::new() }; 2], "{text}");
        for faults in with_allowed(&text, "OTHER") {
            assert!(!faults.is_empty(), "{text}");
        }
    }
}
