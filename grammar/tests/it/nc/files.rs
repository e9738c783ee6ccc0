//! Programs as posts of others wrote them, and our own of ten dialects, read without a fault.

use super::{conversational, hash, instructions, names, read};
use post_grammar::nc::{NcBlock, NcReader, NcSyntax, parse_block};
use post_testkit::{repository, shared};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// File, its family, its blocks (lines that are neither blank, `%`, part of a listing nor of the block before them),
/// lines of listings in front and behind: counted by `grep`.
fn programs() -> [(&'static str, NcSyntax, usize, u64, u64); 7] {
    [
        ("haas_umc750_dhanush_FinalToolPath.nc", hash(), 16_082, 5, 1),
        ("linuxcnc_boat-xyzac.ngc", hash(), 1_866, 0, 0),
        ("linuxcnc_xyzac_switchkins_test_3.ngc", hash(), 15, 0, 0),
        ("nxpost_dmc100_millplus_mm.ptp", conversational(), 4_072, 0, 0),
        ("nxpost_dmu70evo_840d_in.ptp", names(), 1_198, 0, 0),
        ("nxpost_mori_nmv5000_out.txt", hash(), 925, 6, 0),
        ("siemens_ElMoe_keychain.mpf", names(), 644, 0, 0),
    ]
}

#[test]
fn every_program_of_others_is_read() {
    let Some(folder) = shared("data/nc") else {
        return;
    };
    let programs = programs();
    for (name, syntax, blocks, header, trailer) in &programs {
        let mut reader = NcReader::new(File::open(folder.join(name)).unwrap(), syntax.clone());
        let mut block = NcBlock::default();
        let mut count = 0;
        while reader.next_block(&mut block).unwrap_or_else(|fault| panic!("{name}: {fault}")) {
            count += 1;
        }
        let found = (count, reader.header_lines(), reader.trailer_lines());
        assert_eq!(found, (*blocks, *header, *trailer), "{name}");
    }
    let files = fs::read_dir(&folder).unwrap().count();
    assert_eq!(files, programs.len(), "a file that was added must be read, too");
}

#[test]
fn the_scanner_makes_of_the_programs_of_others_what_the_grammar_makes() {
    let Some(folder) = shared("data/nc") else {
        return;
    };
    for (name, syntax, ..) in programs() {
        assert_scanned_as_parsed(&fs::read(folder.join(name)).unwrap(), &syntax, name);
    }
}

#[test]
fn our_own_programs_are_read_and_scanned_as_parsed() {
    let mut programs = 0;
    for folder in ["tests/snapshots", "plugins"] {
        for path in snapshots(&repository().join(folder)) {
            let text = fs::read_to_string(&path).unwrap();
            let Some((program, syntax)) = program(&path, &text) else {
                continue;
            };
            let (blocks, faults) = read(program.as_bytes(), &syntax);
            assert!(faults.is_empty(), "{}: {faults:?}", path.display());
            assert!(blocks.len() > 10, "{}", path.display());
            assert_scanned_as_parsed(program.as_bytes(), &syntax, &path.display().to_string());
            programs += 1;
        }
    }
    assert!(programs > 100, "{programs}");
}

/// Every line that is a block of its own, by the reader and by the grammar.
fn assert_scanned_as_parsed(text: &[u8], syntax: &NcSyntax, name: &str) {
    for (at, line) in text.split(|&byte| byte == b'\n').enumerate() {
        let Ok(line) = std::str::from_utf8(line) else {
            continue;
        };
        let Ok(mut parsed) = parse_block(line, syntax) else {
            continue;
        };
        if parsed.items.is_empty() {
            continue;
        }
        // What stands behind a line must not matter to it.
        let text = format!("{line}\n\n\n                \n");
        let (blocks, faults) = read(text.as_bytes(), syntax);
        assert!(faults.is_empty(), "{name}:{at}: {faults:?}");
        if line.trim_end().ends_with('~') {
            // The grammar takes the continuation for part of a text.
            continue;
        }
        parsed.line = blocks[0].line;
        assert_eq!(blocks, [parsed], "{name}:{at}");
    }
}

/// Snapshots of programs, in all folders below.
fn snapshots(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("the entry is there").path();
        if path.is_dir() {
            found.extend(snapshots(&path));
        } else if path.extension().is_some_and(|extension| extension == "snap") {
            found.push(path);
        }
    }
    found
}

/// The program in a snapshot, without what is said about it, and its family; none if it holds no program.
fn program<'t>(path: &Path, text: &'t str) -> Option<(&'t str, NcSyntax)> {
    let body = text.strip_prefix("---\n")?.split_once("\n---\n")?.1;
    let begin = |mark: &str| {
        body.match_indices(mark)
            .map(|(at, _)| at)
            .find(|at| *at == 0 || body[..*at].ends_with('\n'))
    };
    let told = path.to_string_lossy();
    if told.contains("heidenhain") || begin("0 BEGIN PGM").is_some() {
        return Some((&body[begin("0 BEGIN PGM")?..], conversational()));
    }
    if body.lines().any(|line| line.contains("TRAFOOF") || line.contains("CYCLE800")) {
        let from = begin(";").or(begin("N10 ")).or(begin("%_N_"))?;
        return Some((&body[from..], names()));
    }
    let from = [begin("%"), begin("O1000"), begin("("), begin("G21")];
    let from = from.into_iter().flatten().min()?;
    let with_instructions = ["_fagor", "_isg"].iter().any(|name| told.contains(name));
    Some((&body[from..], if with_instructions { instructions() } else { hash() }))
}
