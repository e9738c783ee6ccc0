//! Cutter-location files as CAM systems wrote them, read without a fault.

use post_grammar::{ClReader, Cycle, MajorWord, Statement, parse_record};
use post_testkit::shared;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;

/// File, records, three-number GOTOs, six-number GOTOs, CIRCLEs: counted by another program.
const COUNTS: [(&str, usize, usize, usize, usize); 18] = [
    ("camworks_neMoguta_UniSource.clt", 718, 360, 0, 72),
    ("creo3x_MichaHofft_bohren_1.ncl", 22, 4, 0, 0),
    ("creo3x_MichaHofft_profilfraesen_2.ncl", 90, 52, 0, 20),
    ("creo3x_MichaHofft_schruppen_1.ncl", 7074, 5590, 0, 419),
    ("creo5x_4r19415_finition.ncl", 35522, 0, 35418, 0),
    ("nx_HumMan__10_KONTUR_125_N2_162.cls", 38, 10, 0, 6),
    ("nx_HumMan__3_PAZ_125_N2.cls", 1130, 640, 0, 300),
    ("nx_HumMan__8_SVERL_63_N2.cls", 25, 5, 0, 0),
    ("nx_HumMan_cutcom.clsf", 1219, 565, 1, 140),
    ("nx_HumMan_deep_drill.clsf", 14, 1, 1, 0),
    ("nx_HumMan_nurbs.clsf", 1766, 77, 1, 0),
    ("nx_HumMan_standart_drill.clsf", 14, 1, 1, 0),
    ("nx_HumMan_ust_a.cls", 662, 426, 120, 0),
    ("nx_HumMan_ust_a2.cls", 22242, 15397, 4660, 0),
    ("own_ncl_form.as", 19, 0, 6, 0),
    ("swcam_aamorim_Interface-glue.clt", 2201, 2036, 0, 30),
    ("swcam_aamorim_Teste-Metrologia.apt", 780, 128, 326, 65),
    ("swcam_aamorim_basemach.apt", 3351, 2090, 0, 369),
];

/// How often each word comes, and how many numbers the GOTOs have.
fn count(path: &Path) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    let mut reader = ClReader::new(File::open(path).expect("the file opens"));
    let mut last = 0;
    while let Some(record) =
        reader.next_record().unwrap_or_else(|fault| panic!("{}: {fault}", path.display()))
    {
        assert!(record.line > last);
        last = record.line;
        // The scanner and pest agree on every record.
        assert_eq!(parse_record(&record.text()).as_ref(), Ok(&record.statement));
        let word = match &record.statement {
            Statement::Goto { axis: None, .. } => "GOTO 3",
            Statement::Goto { .. } => "GOTO 6",
            statement => statement.word(),
        };
        *counts.entry(word.to_owned()).or_default() += 1;
    }
    assert_eq!(reader.bytes_read(), fs::metadata(path).expect("the file is there").len());
    counts
}

#[test]
fn every_file_reads_with_the_counts_that_are_known() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    for (name, records, three, six, circles) in COUNTS {
        let counts = count(&folder.join(name));
        let of = |word: &str| counts.get(word).copied().unwrap_or(0);
        let found = (counts.values().sum::<usize>(), of("GOTO 3"), of("GOTO 6"), of("CIRCLE"));
        assert_eq!(found, (records, three, six, circles), "{name}: {counts:?}");
        for word in counts.keys().filter(|word| !word.starts_with("GOTO ")) {
            assert!(MajorWord::find(word).is_some(), "{name}: {word}");
        }
    }
    // A file that was added must read, too.
    for entry in fs::read_dir(folder).unwrap() {
        count(&entry.unwrap().path());
    }
}

#[test]
fn words_that_are_counted_in_the_description() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    for (name, word, expected) in [
        ("nx_HumMan_ust_a2.cls", "PAINT", 1718),
        ("nx_HumMan_ust_a2.cls", "RAPID", 459),
        ("nx_HumMan_cutcom.clsf", "CUTCOM", 140),
        ("nx_HumMan_nurbs.clsf", "NURBS", 70),
        ("swcam_aamorim_Interface-glue.clt", "ROTABL", 21),
        ("swcam_aamorim_Interface-glue.clt", "TLAXIS", 4),
        ("own_ncl_form.as", "RAPID", 3),
    ] {
        assert_eq!(count(&folder.join(name)).get(word), Some(&expected), "{name}: {word}");
    }
}

#[test]
fn every_cycle_has_its_depth_feed_and_clearance() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    let mut cycles = 0;
    for (name, ..) in COUNTS {
        let mut reader = ClReader::new(File::open(folder.join(name)).unwrap());
        while let Some(record) = reader.next_record().unwrap() {
            if let Statement::Cycle(Cycle::Define(cycle)) = record.statement {
                assert!(
                    cycle.depth.is_some() && cycle.feed.is_some() && cycle.clearance.is_some(),
                    "{name}: {cycle:?}"
                );
                cycles += 1;
            }
        }
    }
    assert_eq!(cycles, 7);
}
