//! What a library does beside its work: too much text, letters that no line has, tables that are none, another
//! rounding, another folder, another file in its place.

#![cfg(unix)]
// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use crate::common::{compile, library, setup};

use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};

use post_host::{Finder, LinkedPlugin, OpenedDialect, Plugin, PluginFault, Reason};
use post_plugin::{
    Batch, Deviation, DialectSession, Event, Meaning, ModelSession, Tolerance, VocabularyWord,
    WriteFault,
};

/// `hostile.c` with a fault, in a folder of its own: a library that is open already would be handed out again.
fn hostile(folder: &Path, flag: &str) -> PathBuf {
    let own = folder.join(flag);
    fs::create_dir(&own).unwrap();
    compile(&own, "hostile.c", "hostile", &[&format!("-DFAULT_{flag}")])
}

fn session(folder: &Path, flag: &str) -> OpenedDialect {
    let plugin = Plugin::open(&hostile(folder, flag)).unwrap();
    plugin.dialect(&setup(&["X"])).unwrap()
}

fn written(session: &mut OpenedDialect) -> Result<String, WriteFault> {
    let mut batch = Batch::default();
    batch.push(1, Event::rapid(&[1.0]));
    batch.push(2, Event::rapid(&[1.0]));
    let mut out = String::new();
    session.write_batch(&batch, &mut out, &mut Vec::new())?;
    Ok(out)
}

#[test]
fn no_letter_that_ends_or_hides_a_line_reaches_a_program() {
    let folder = tempfile::tempdir().unwrap();
    for (flag, message) in [
        ("CR", "its line `(x)\\rG0 Z-50` holds the character U+000D"),
        ("CR_CR", "its line `G0 X1\\r\\r` holds the character U+000D"),
        ("NEL", "its line `(x)\\u{85}G0 Z-50` holds the character U+0085"),
        ("SEPARATOR", "its line `(x)\\u{2028}G0 Z-50` holds the character U+2028"),
        ("FEED", "its line `(x)\\u{c}G0 Z-50` holds the character U+000C"),
        ("BACKWARD", "its line `(\\u{202e})G0 Z-50` holds the character U+202E"),
        ("NUL", "its line `G0\\u{0}X1` holds the character U+0000"),
    ] {
        let fault = written(&mut session(folder.path(), flag)).unwrap_err();
        assert_eq!(fault.index, 0, "{flag}");
        let message = format!("dialect `hostile`, event Rapid: {message}: ");
        assert!(fault.message.starts_with(&message), "{}", fault.message);
    }
    let fault = written(&mut session(folder.path(), "LONGER_LINE")).unwrap_err();
    assert!(fault.message.ends_with(" has 16385 bytes: a line of a program has at most 16384"));
    assert_eq!(written(&mut session(folder.path(), "LONG_LINE")).unwrap().len(), 2 * 16385);
    // What controls do read: tabs, and lines that end with CR and LF.
    let text = written(&mut session(folder.path(), "CRLF")).unwrap();
    assert_eq!(text, "G0\tX1\r\nG0\tX1\r\n");
}

#[test]
fn what_a_library_writes_in_one_call_is_bounded() {
    let folder = tempfile::tempdir().unwrap();
    for (flag, message) in [
        // A hundred gigabytes, of which no more than the bound is kept.
        ("FLOOD", "it wrote more than 16777216 bytes in one call"),
        ("HUGE_TEXT", "it handed over 4611686018427387903 bytes of text at once"),
        ("NULL_TEXT", "it handed over 100 bytes of text at a null pointer"),
    ] {
        let fault = written(&mut session(folder.path(), flag)).unwrap_err();
        assert_eq!(fault.message, format!("dialect `hostile`, event Rapid: {message}"));
    }
}

#[test]
fn a_message_is_one_line_of_plain_letters() {
    let folder = tempfile::tempdir().unwrap();
    let fault = written(&mut session(folder.path(), "MESSAGE")).unwrap_err();
    let message = fault.message;
    let begin = "dialect `hostile`, event Rapid: \\u{1b}[2J\\u{1b}]0;owned\\u{7} all  is well";
    assert!(message.starts_with(begin), "{message}");
    assert!(message.ends_with('…') && message.len() < 1200, "{message}");
}

#[test]
fn what_a_library_declares_is_bounded_and_stands_where_it_can() {
    let folder = tempfile::tempdir().unwrap();
    for (flag, message) in [
        ("TABLE_HUGE", "its PostDialect has 4000000000 bytes, it can have at most 65576"),
        ("ALIGN", "its `dialect` is at an address that no table can have"),
        ("VERSION", "its version `1.0\\u{1b}[2J` holds a character that no line has"),
        ("LONG_VERSION", "its version has 9223372036854775812 bytes, at most 200 are taken"),
        ("MANY", "it declares more than 1000 options"),
        ("TWICE", "it declares the option `speed` twice"),
        (
            "CHOICES",
            "an option it declares has a choice that is one of 2305843009213693951 (`speed`)",
        ),
        (
            "NO_CHOICES",
            "an option it declares has a choice that is at a null pointer, or one that is not aligned (`speed`)",
        ),
        ("KEY", "an option it declares has the key `a\\nb`, which is no name"),
        (
            "LONG",
            "an option it declares has a key that has 9223372036854775812 bytes, at most 200 are taken",
        ),
        ("HELP", "an option it declares has a help that is null (`speed`)"),
        ("UNALIGNED", "an option it declares is not aligned"),
        ("NOTHING", "an option it declares is null"),
    ] {
        let path = hostile(folder.path(), flag);
        let fault: PluginFault = Plugin::open(&path).unwrap_err();
        let text = fault.to_string();
        assert_eq!(text.split_once("): ").unwrap().1, message, "{flag}");
        assert!(!fault.help().is_empty());
    }
}

#[test]
fn a_library_of_the_first_days_of_this_contract_is_taken() {
    let folder = tempfile::tempdir().unwrap();
    let plugin = Plugin::open(&hostile(folder.path(), "EARLIER")).unwrap();
    assert_eq!(plugin.about(), "");
    let mut session = plugin.dialect(&setup(&["X"])).unwrap();
    assert_eq!(session.vocabulary(), Ok(Vec::new()));
    assert_eq!(session.relies_on(), Ok(Vec::new()));
    assert_eq!(written(&mut session).unwrap(), "G0 X1\nG0 X1\n");
    let plugin = Plugin::open(&hostile(folder.path(), "NONE")).unwrap();
    assert_eq!(plugin.about(), "It means no good.");
}

#[test]
fn a_vocabulary_is_bounded_and_of_known_meaning() {
    let folder = tempfile::tempdir().unwrap();
    let mut good = session(folder.path(), "GOOD");
    assert_eq!(good.vocabulary().unwrap(), [VocabularyWord::new("G0", Meaning::Rapid)]);
    for (flag, message) in [
        ("MEANING", "its vocabulary has `G1` mean 99999, which this version does not know"),
        ("NO_WORD", "a word of its vocabulary is null"),
        ("LONG_WORD", "bytes, at most 200 are taken"),
        ("MANY_WORDS", "its vocabulary has more than 1000 words"),
        ("NO_VOCABULARY", "it gives no reason"),
    ] {
        let fault = session(folder.path(), flag).vocabulary().unwrap_err();
        assert!(fault.starts_with("dialect `hostile`: "), "{fault}");
        assert!(fault.contains(message), "{flag}: {fault}");
    }
}

#[test]
fn what_programs_rely_on_is_text_a_sentence_a_line_and_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let told = session(folder.path(), "GOOD").relies_on().unwrap();
    assert_eq!(told, ["option 1", "\\u{1b}[2Joption 2"]);
    assert_eq!(session(folder.path(), "MANY_SENTENCES").relies_on().unwrap().len(), 100);
    for (flag, message) in [("NO_TEXT", "is not UTF-8"), ("RELIES", "it gives no reason")] {
        let fault = session(folder.path(), flag).relies_on().unwrap_err();
        assert!(fault.starts_with("dialect `hostile`: "), "{fault}");
        assert!(fault.contains(message), "{flag}: {fault}");
    }
}

/// Rounded to nearest it is below a third.
fn third() -> f64 {
    black_box(1.0) / black_box(3.0)
}

const NEAREST: f64 = 1.0 / 3.0;

/// The folder is that of the whole process, in which other tests open libraries at the same time: this one is run in a
/// process of its own.
#[test]
fn rounding_and_folder_are_what_they_were() {
    let done = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "strangers::in_a_process_of_its_own", "--ignored"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&done.stdout);
    assert!(text.contains("1 passed"), "{text}");
}

#[test]
#[ignore = "run by the test above"]
fn in_a_process_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let here = std::env::current_dir().unwrap();
    let path = hostile(folder.path(), "DISTURB");
    let check = |when: &str| {
        assert_eq!(third(), NEAREST, "{when}");
        assert_eq!(std::env::current_dir().unwrap(), here, "{when}");
    };
    let plugin = Plugin::open(&path).unwrap();
    check("loaded");
    let mut session = plugin.dialect(&setup(&["X"])).unwrap();
    written(&mut session).unwrap();
    check("written");
}

#[test]
fn a_model_is_answered_with_the_rounding_of_the_host() {
    let folder = tempfile::tempdir().unwrap();
    let flags = ["-DFAULT_ROUND"];
    let path = compile(folder.path(), "hostile_model.c", "hostile_model", &flags);
    let mut model = Plugin::open(&path).unwrap().error_model(&[]).unwrap();
    let tolerance = Tolerance { tip: 0.005, axis: 0.05 };
    let mut asked = f64::NAN;
    let curve = model.fit(&tolerance, &mut |_: &[f64], out: &mut [Deviation]| {
        asked = third();
        out[0].tip[0] = asked;
    });
    assert_eq!((asked, third()), (NEAREST, NEAREST));
    let curve = curve.unwrap();
    assert_eq!(curve.tip_peak, NEAREST);
    model.value(&curve, 0.5);
    assert_eq!(third(), NEAREST);
}

#[test]
fn a_model_that_asks_for_what_cannot_be_is_refused() {
    let tolerance = Tolerance { tip: 0.005, axis: 0.05 };
    for (flag, message) in [
        ("COUNT", "it asks for 2305843009213693951 deviations at once"),
        ("NULL", "it asks for deviations by a null pointer"),
        ("ALIGN", "it asks for deviations by a pointer that is not aligned"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let flag = format!("-DFAULT_{flag}");
        let path = compile(folder.path(), "hostile_model.c", "hostile_model", &[&flag]);
        let mut model = Plugin::open(&path).unwrap().error_model(&[]).unwrap();
        let fault = model.fit(&tolerance, &mut |_, _| ()).unwrap_err();
        assert_eq!(fault, format!("error model `hostile_model`: {message}"));
    }
}

fn open_fault(path: &Path) -> String {
    match Plugin::open(path).unwrap_err().reason {
        Reason::Open { message } => message,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_hash_is_that_of_what_was_loaded() {
    let folder = tempfile::tempdir().unwrap();
    let path = hostile(folder.path(), "NONE");
    let bytes = fs::read(&path).unwrap();
    let plugin = Plugin::open(&path).unwrap();
    assert_eq!(plugin.hash(), Some(blake3(&bytes).as_str()));
    // Another library takes the name: the system would hand out the one that is open.
    let other = hostile(folder.path(), "CR");
    fs::rename(&other, &path).unwrap();
    assert_eq!(open_fault(&path), "it is open already, and its file was changed since");
    fs::write(&path, &bytes).unwrap();
    assert_eq!(Plugin::open(&path).unwrap().hash(), plugin.hash());
}

/// As `b3sum` has it, by the crate that the host uses: the bytes are the point here.
fn blake3(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

#[test]
fn a_library_whose_symbol_is_in_another_one_is_refused_before_it_runs() {
    let folder = tempfile::tempdir().unwrap();
    let inner = hostile(folder.path(), "EXIT_LOAD");
    let shell = folder.path().join("shell");
    fs::create_dir(&shell).unwrap();
    let shell = library(&shell, "hostile");
    let done = std::process::Command::new("cc")
        .args(["-shared", "-Wl,--no-as-needed", "-o"])
        .args([&shell, &inner])
        .arg(format!("-Wl,-rpath,{}", inner.parent().unwrap().display()))
        .status();
    assert!(done.unwrap().success());
    assert_eq!(
        Plugin::open(&shell).unwrap_err().reason,
        Reason::NoSymbol { symbol: "post_plugin_hostile".to_owned() }
    );
}

#[test]
fn a_library_for_another_processor_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = hostile(folder.path(), "NONE");
    let mut bytes = fs::read(&path).unwrap();
    if bytes[..4] != *b"\x7fELF" {
        return;
    }
    // e_machine: SPARC V9.
    bytes[18] = 43;
    fs::write(&path, bytes).unwrap();
    let fault = open_fault(&path);
    assert!(fault.starts_with("it is built for another processor ("), "{fault}");
}

#[test]
fn what_stands_in_a_named_folder_is_never_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let linked = post_stock::plugin("fanuc").unwrap();
    let finder = |place: &Path| Finder {
        folders: vec![place.to_owned()],
        linked: vec![linked.into()],
        ..Finder::default()
    };
    let place = |name: &str| {
        let place = folder.path().join(name);
        fs::create_dir(&place).unwrap();
        place
    };
    let link = std::os::unix::fs::symlink::<PathBuf, PathBuf>;

    let dangling = place("dangling");
    link(PathBuf::from("nowhere"), library(&dangling, "fanuc")).unwrap();
    let round = place("round");
    link(library(&round, "fanuc"), library(&round, "fanuc")).unwrap();
    let inside = place("inside");
    fs::create_dir(library(&inside, "fanuc")).unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let turning = folder.path().join("turning");
    link(turning.clone(), turning.clone()).unwrap();
    for (place, message) in [
        (&dangling, "No such file"),
        (&round, "ymbolic link"),
        (&inside, "it is no file"),
        (&file, "Not a directory"),
        (&turning, "ymbolic link"),
    ] {
        let fault = finder(place).find("fanuc").unwrap_err();
        let text = fault.to_string();
        assert!(text.contains(message), "{}: {text}", place.display());
        assert_eq!(fault.path, Some(library(place, "fanuc")));
    }
    assert_eq!(finder(&place("empty")).find("fanuc").unwrap().path(), None);
}

#[test]
fn all_plugins_are_listed_without_being_opened() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["fanuc", "mine"] {
        fs::write(library(folder.path(), name), "no library").unwrap();
    }
    fs::write(folder.path().join("notes.txt"), "").unwrap();
    let linked = ["fanuc", "sampled"].map(|name| post_stock::plugin(name).unwrap());
    let finder = Finder {
        folders: vec![folder.path().to_owned()],
        linked: linked.map(LinkedPlugin::from).to_vec(),
        ..Finder::default()
    };
    let listed = finder.list().unwrap();
    let rows: Vec<(&str, bool, bool)> =
        listed.iter().map(|row| (row.name.as_str(), row.path.is_some(), row.hidden)).collect();
    assert_eq!(
        rows,
        [
            ("fanuc", true, false),
            ("mine", true, false),
            ("fanuc", false, true),
            ("sampled", false, false)
        ]
    );
}
