//! Real shared libraries: the stock plugins, plugins in Rust and in C, and hostile ones.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use crate::common::{compile, deps, example, library, needed, setup, stock};

use std::path::Path;

use post_host::{Finder, GivenValue, Plugin, PluginFault, PluginKind, ProgramSetup, Reason};
use post_plugin::{
    Batch, Capabilities, Coolant, Deviation, DialectSession, Event, Feed, Meaning, ModelSession,
    Spindle, SpindleSense, Tolerance, VocabularyWord,
};

fn five_axes() -> ProgramSetup {
    setup(&["X", "Y", "Z", "A", "C"])
}

/// Five axes, and the options without which this dialect does not open.
fn setup_of(plugin: &Plugin) -> ProgramSetup {
    ProgramSetup { options: needed(plugin.name()), ..five_axes() }
}

/// A small program, which parks the machine in the end where the control has words for that.
fn job(parks: bool) -> Batch {
    let mut batch = Batch::default();
    let mut line = 0;
    let mut push = |event: Event<'_>| {
        line += 1;
        batch.push(line, event);
    };
    push(Event::Start);
    push(Event::Comment { text: "naïve (µ)" });
    push(Event::tool_change(1, 2, "ball"));
    push(Event::Spindle(Spindle::On { rpm: 3000.0, sense: SpindleSense::CounterClockwise }));
    push(Event::Coolant(Coolant::Flood));
    push(Event::position(&[0.0, 0.0, 100.0, 0.0, 0.0], None));
    for step in 0..200 {
        let x = f64::from(step) / 8.0;
        push(Event::linear(&[x, -x, 3.0, x / 2.0, 10.0], Feed::PerMinute(500.0)));
    }
    push(Event::Dwell { seconds: 0.25 });
    push(Event::Retract { axes: 0b100, words: &[0.0, 0.0, 500.0, 0.0, 0.0] });
    if parks {
        push(Event::Park { axes: 0b11, words: &[-250.0, 200.0, 0.0, 0.0, 0.0] });
    }
    push(Event::End);
    batch
}

fn write(plugin: &Plugin, batch: &Batch) -> (String, Vec<usize>) {
    let mut session = plugin.dialect(&setup_of(plugin)).unwrap();
    let (mut out, mut ends) = (String::new(), Vec::new());
    session.write_batch(batch, &mut out, &mut ends).unwrap();
    (out, ends)
}

#[test]
fn a_stock_dialect_writes_the_same_from_a_file_and_linked_in() {
    let all = post_stock::plugins().iter();
    let all = all.map(|linked| Plugin::linked(*linked).unwrap());
    for linked in all.filter(|plugin| plugin.kind() == PluginKind::Dialect) {
        assert_eq!((linked.path(), linked.hash()), (None, None));
        let opened = Plugin::open(&library(&deps(), linked.name())).unwrap();
        assert_eq!(opened.name(), linked.name());
        assert_eq!(opened.version(), linked.version());
        assert_eq!(opened.kind(), PluginKind::Dialect);
        assert_eq!(opened.hash().unwrap().len(), 64);
        let keys = |plugin: &Plugin| -> Vec<&str> {
            plugin.options().iter().map(|spec| spec.key).collect()
        };
        assert_eq!(keys(&opened), keys(&linked));
        let capabilities = linked.dialect(&setup_of(&linked)).unwrap().capabilities();
        let batch = job(!capabilities.has(Capabilities::NO_PARK));
        let (text, ends) = write(&opened, &batch);
        assert_eq!((text.clone(), ends.clone()), write(&linked, &batch));
        assert_eq!(ends.len(), batch.len());
        assert_eq!(ends.last(), Some(&text.len()));
        assert!(text.lines().count() > 200);
        // Each kind of event by itself: the same text, or the same refusal.
        for event in Event::samples() {
            let mut batch = Batch::default();
            batch.push(1, Event::Start);
            batch.push(2, event);
            let [by_contract, straight] = [&opened, &linked].map(|plugin| {
                let mut session = plugin.dialect(&setup_of(plugin)).unwrap();
                let (mut out, mut ends) = (String::new(), Vec::new());
                let written = session.write_batch(&batch, &mut out, &mut ends);
                let words = session.vocabulary();
                (written, out, ends, session.capabilities(), words)
            });
            assert_eq!(by_contract, straight, "{}", event.name());
        }
        // Cut into single events it is the same program.
        let mut session = opened.dialect(&setup_of(&opened)).unwrap();
        let mut out = String::new();
        for event in batch.iter() {
            let mut single = Batch::default();
            single.push(1, event);
            session.write_batch(&single, &mut out, &mut Vec::new()).unwrap();
        }
        assert_eq!(out, text);
    }
}

#[test]
fn the_stock_error_model_answers_the_same_from_a_file_and_linked_in() {
    let linked = Plugin::linked(stock("sampled")).unwrap();
    let opened = Plugin::open(&library(&deps(), "sampled")).unwrap();
    let answers = [linked, opened].map(|plugin| {
        assert_eq!(plugin.kind(), PluginKind::ErrorModel);
        assert!(plugin.dialect(&five_axes()).is_err());
        let options = [("accuracy".to_owned(), GivenValue::Number(0.001))];
        let mut session = plugin.error_model(&options).unwrap();
        let tolerance = Tolerance { tip: 0.005, axis: 0.05 };
        let curve = session.fit(&tolerance, &mut |ts, out| {
            for (t, out) in ts.iter().zip(out) {
                out.tip[0] = t * (1.0 - t);
            }
        });
        let curve = curve.unwrap();
        assert!((curve.tip_peak - 0.25).abs() < 0.001);
        assert!((session.value(&curve, 0.3).tip[0] - 0.21).abs() < 1e-12);
        assert_eq!(session.fault(), None);
        let broken = session.fit(&tolerance, &mut |_, out| out[0].tip[0] = f64::INFINITY);
        assert!(broken.unwrap_err().starts_with("error model `sampled`: "));
        curve
    });
    assert_eq!(answers[0], answers[1]);
}

#[test]
fn a_panic_of_the_host_passes_through_a_model_unharmed() {
    let plugin = Plugin::open(&library(&deps(), "sampled")).unwrap();
    let mut session = plugin.error_model(&[]).unwrap();
    let tolerance = Tolerance { tip: 0.005, axis: 0.05 };
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        session.fit(&tolerance, &mut |_: &[f64], _: &mut [Deviation]| std::panic::panic_any("mine"))
    }));
    assert_eq!(caught.unwrap_err().downcast_ref::<&str>(), Some(&"mine"));
    assert!(session.fit(&tolerance, &mut |_, _| ()).is_ok());
}

#[test]
fn a_small_dialect_of_rust() {
    let plugin = Plugin::open(&example("tiny")).unwrap();
    let mut session = plugin.dialect(&setup(&["X", "Z", "C"])).unwrap();
    let words = session.vocabulary().unwrap();
    assert!(words.contains(&VocabularyWord::new("G53", Meaning::MachineCoordinates)));
    let mut batch = Batch::default();
    batch.push(1, Event::tool_change(1, 11, ""));
    batch.push(2, Event::position(&[1.5, 50.0, 90.0], None));
    batch.push(3, Event::linear(&[-2.0, 50.0, 90.0], Feed::PerMinute(250.0)));
    batch.push(4, Event::Spindle(Spindle::Orient));
    let (mut out, mut ends) = (String::new(), Vec::new());
    let fault = session.write_batch(&batch, &mut out, &mut ends).unwrap_err();
    assert_eq!(
        out,
        "T1 M6\nG0 X1.5000\nG0 G43 H11 Z50.0000\nG1 X-2.0000 Z50.0000 C90.000 F250.0\n"
    );
    assert_eq!((ends.len(), fault.index), (3, 3));
    assert_eq!(
        fault.message,
        "dialect `tiny`, event Spindle: this dialect has no words for a spindle command"
    );
}

#[cfg(unix)]
#[test]
fn a_dialect_in_c() {
    let folder = tempfile::tempdir().unwrap();
    let plugin = Plugin::open(&compile(folder.path(), "minimal.c", "minimal", &[])).unwrap();
    assert_eq!((plugin.name(), plugin.version()), ("minimal", "1.0"));
    let mut setup = setup(&["X", "C"]);
    setup.options = vec![("decimals".to_owned(), GivenValue::Integer(2))];
    let mut session = plugin.dialect(&setup).unwrap();
    assert_eq!(session.format().words, [2, 2]);
    assert_eq!(session.format().inverse_time, None);
    assert_eq!(session.format().extension, "nc");
    let words = session.vocabulary().unwrap();
    assert!(words.contains(&VocabularyWord::new("G53", Meaning::MachineCoordinates)));
    let mut batch = Batch::default();
    batch.push(1, Event::Stop);
    batch.push(2, Event::rapid(&[1.5, 90.0]));
    batch.push(3, Event::Unknown { kind: 4711 });
    let mut out = "before\n".to_owned();
    let mut ends = Vec::new();
    let fault = session.write_batch(&batch, &mut out, &mut ends).unwrap_err();
    assert_eq!(out, "before\nM0\nG0 X1.50 C90.00\n");
    assert_eq!(ends, [10, 26]);
    assert_eq!(fault.message, "dialect `minimal`, event Unknown: it has no words for kind 4711");
    // It is good by the kit, which is asked through the contract.
    let report = post_kit::conformance::test(&plugin, &[]).unwrap();
    assert!(report.is_good(), "{report}");
    setup.tcp = true;
    let refused = plugin.dialect(&setup).unwrap_err();
    assert!(refused.to_string().ends_with("this control has no TCP"));
    setup.options = vec![("decimals".to_owned(), GivenValue::Integer(7))];
    let refused = plugin.dialect(&setup).unwrap_err();
    assert!(refused.to_string().contains("7 is not between 1 and 6"));
}

/// The kit runs on libraries as on what is linked in.
#[test]
fn the_examples_are_good_by_the_kit() {
    let report = |name: &str| {
        let plugin = Plugin::open(&example(name)).unwrap();
        post_kit::conformance::test(&plugin, &[]).unwrap()
    };
    let tiny = report("tiny");
    assert_eq!(tiny.kind, PluginKind::Dialect);
    assert!(tiny.is_good(), "{tiny}");
    // What not every control has.
    assert!(tiny.table().contains("program: it refuses Preselect: dialect `tiny`"));

    let gcode = report("gcode");
    assert!(gcode.is_good(), "{gcode}");

    let panics = report("panics");
    let wrong: Vec<String> = panics.wrong().collect();
    assert!(wrong.iter().any(|wrong| wrong.contains("the plugin panicked")), "{panics}");
}

#[cfg(unix)]
#[test]
fn a_library_that_is_no_plugin_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refusal = |flag: &str| -> String {
        // Its own folder each: a library that is open already would be handed out again.
        let own = folder.path().join(flag);
        std::fs::create_dir(&own).unwrap();
        let path = compile(&own, "hostile.c", "hostile", &[&format!("-DFAULT_{flag}")]);
        let fault: PluginFault = Plugin::open(&path).unwrap_err();
        assert_eq!(fault.path.as_deref(), Some(path.as_path()));
        assert!(!fault.help().is_empty());
        let text = fault.to_string();
        text.split_once("): ").unwrap().1.to_owned()
    };
    assert_eq!(refusal("MAGIC"), "what it exports is not a plugin of post");
    assert_eq!(
        refusal("ABI"),
        "it was built for version 10 of the plugin contract, this is version 2"
    );
    assert!(refusal("LAYOUT").starts_with("it was built against other structs"));
    assert_eq!(refusal("SIZE"), "its PostPlugin has 4000000000 bytes, it can have at most 65632");
    assert_eq!(refusal("TABLE_SIZE"), "its PostDialect has 32 bytes, it must have at least 40");
    assert_eq!(refusal("NULL_WRITE"), "its `write` is null");
    assert_eq!(refusal("NULL_TABLE"), "its `dialect` is null");
    assert_eq!(refusal("NULL_NAME"), "its `name` is null");
    assert_eq!(refusal("NAME"), "it calls itself `friendly`");
    assert_eq!(refusal("KIND"), "its kind 77 is neither a dialect nor an error model");
    assert_eq!(refusal("SYMBOL"), "it does not export `post_plugin_hostile`");
    assert!(refusal("DEFAULT").contains("7 is not between 0 and 1"));
}

#[cfg(unix)]
#[test]
fn what_a_plugin_says_is_not_believed() {
    let folder = tempfile::tempdir().unwrap();
    let open = |flag: &str| {
        let own = folder.path().join(flag);
        std::fs::create_dir(&own).unwrap();
        let path = compile(&own, "hostile.c", "hostile", &[&format!("-DFAULT_{flag}")]);
        Plugin::open(&path).unwrap().dialect(&setup(&["X"]))
    };
    for (flag, message) in [
        ("OPEN", "it gives no reason"),
        ("WORDS", "has 4000000000 axis words, the program has 1"),
        ("DECIMALS", "asks for 200 decimals"),
        ("EXTENSION", "its file extension is not letters and digits"),
    ] {
        let fault = open(flag).unwrap_err().to_string();
        assert!(fault.contains(message), "{flag}: {fault}");
    }
    for (flag, message) in [
        ("NAN", "no number: G0 X-nan"),
        ("UTF8", "not UTF-8"),
        ("CONTROL", "holds the character U+001B"),
        ("LINE", "does not end with a line feed"),
        ("ENDS", "not where it says"),
        ("BACK", "not where it says"),
        ("NO_ENDS", "belongs to no event"),
        ("COUNT", "it wrote 3 events of 2"),
    ] {
        let mut batch = Batch::default();
        batch.push(1, Event::rapid(&[1.0]));
        batch.push(2, Event::rapid(&[1.0]));
        let mut out = "x".to_owned();
        let written = open(flag).unwrap().write_batch(&batch, &mut out, &mut Vec::new());
        let fault = written.unwrap_err().message;
        assert!(fault.starts_with("dialect `hostile`, event Rapid: "), "{fault}");
        assert!(fault.contains(message), "{flag}: {fault}");
    }
}

#[test]
fn a_plugin_that_panics_does_not_take_the_host_with_it() {
    let plugin = Plugin::open(&example("panics")).unwrap();
    let mut setup = setup(&["X"]);
    let mut session = plugin.dialect(&setup).unwrap();
    let mut batch = Batch::default();
    batch.push(1, Event::Start);
    let (axes, words) = (1, &[0.0][..]);
    batch.push(2, Event::Park { axes, words });
    let (mut out, mut ends) = (String::new(), Vec::new());
    let fault = session.write_batch(&batch, &mut out, &mut ends).unwrap_err();
    assert_eq!(fault.index, 1);
    let message = &fault.message;
    assert!(
        message.starts_with(
            "dialect `panics`, event Park: the plugin panicked: the sky fell on Park ("
        ) && message.contains("post_panics.rs:"),
        "{message}"
    );
    assert_eq!(out, "half a line\n");
    // It is not asked again, and says why.
    let again = session.write_batch(&batch, &mut out, &mut ends).unwrap_err();
    assert!(again.message.contains("the sky fell"), "{}", again.message);

    let mut batch = Batch::default();
    batch.push(1, Event::End);
    let mut session = plugin.dialect(&setup).unwrap();
    let fault = session.write_batch(&batch, &mut out, &mut ends).unwrap_err();
    assert!(fault.message.contains("without a message"));

    setup.program = "open".to_owned();
    let fault = plugin.dialect(&setup).unwrap_err();
    assert!(fault.to_string().contains("no such program"), "{fault}");
}

#[test]
fn files_that_are_no_libraries_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text = library(folder.path(), "text");
    std::fs::write(&text, "G0 X0\n").unwrap();
    let reason = |path: &Path| Plugin::open(path).unwrap_err().reason;
    assert!(matches!(reason(&text), Reason::Open { .. }));
    let missing = library(folder.path(), "missing");
    assert!(matches!(reason(&missing), Reason::Open { .. }));
    assert!(matches!(reason(Path::new("/lib/libm.so.6")), Reason::FileName { .. }));
    assert!(matches!(reason(&folder.path().join("../post_x")), Reason::FileName { .. }));
}

#[cfg(target_os = "linux")]
#[test]
fn a_system_library_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let candidates = ["/lib/x86_64-linux-gnu", "/lib/aarch64-linux-gnu", "/lib64", "/lib"];
    let libm = candidates
        .iter()
        .map(|place| Path::new(place).join("libm.so.6"))
        .find(|path| path.exists());
    let Some(libm) = libm else { return };
    let copy = library(folder.path(), "m");
    std::fs::copy(libm, &copy).unwrap();
    assert_eq!(
        Plugin::open(&copy).unwrap_err().reason,
        Reason::NoSymbol { symbol: "post_plugin_m".to_owned() }
    );
}

#[test]
fn a_name_is_looked_for_in_the_folders_and_then_among_the_linked_in() {
    let linked = vec![stock("fanuc").into()];
    let mut finder = Finder { linked, ..Finder::default() };
    assert_eq!(finder.find("fanuc").unwrap().path(), None);
    let fault = finder.find("fanuk").unwrap_err();
    assert_eq!(fault.to_string(), "plugin `fanuk`: there is no such plugin");
    assert!(fault.help().starts_with("there are fanuc"), "{}", fault.help());
    assert!(finder.find("../fanuc").is_err());

    let empty = tempfile::tempdir().unwrap();
    finder.folders = vec![empty.path().to_owned(), deps()];
    let found = finder.find("fanuc").unwrap();
    assert_eq!(found.path(), Some(library(&deps(), "fanuc").as_path()));
    // A broken file in a named folder is not passed over.
    std::fs::write(library(empty.path(), "fanuc"), "").unwrap();
    assert!(finder.find("fanuc").is_err());
}

#[test]
fn promises_to_plugins_are_kept() {
    let plugin = Plugin::linked(stock("heidenhain")).unwrap();
    let bad: &[(Event<'_>, &str)] = &[
        (Event::rapid(&[f64::NAN, 0.0]), "an axis word is NaN"),
        (Event::rapid(&[0.0]), "1 axis words instead of 2"),
        (Event::Dwell { seconds: -1.0 }, "its number is -1"),
        (Event::linear(&[0.0, 0.0], Feed::PerMinute(0.0)), "the feed is 0"),
        (Event::linear(&[0.0, 0.0], Feed::InverseTime(1.0)), "no inverse-time feed"),
    ];
    for (event, message) in bad {
        let mut session = plugin.dialect(&setup(&["X", "C"])).unwrap();
        let mut batch = Batch::default();
        batch.push(1, Event::Stop);
        batch.push(2, *event);
        let (mut out, mut ends) = (String::new(), Vec::new());
        let fault = session.write_batch(&batch, &mut out, &mut ends).unwrap_err();
        assert_eq!((fault.index, out.as_str()), (1, "0 M0\n"));
        assert!(fault.message.contains(message), "{}", fault.message);
    }
}

#[test]
fn sessions_go_to_the_threads_that_use_them() {
    let plugin = Plugin::open(&library(&deps(), "fanuc")).unwrap();
    let batch = job(true);
    let texts: Vec<String> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| write(&plugin, &batch).0)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(texts.windows(2).all(|pair| pair[0] == pair[1]));
}
