//! Job files: what was typed comes back, every verb takes them, and a program finds its own.

use std::fs;
use std::path::Path;

use post_job::files::PathArg;
use post_job::job_file::{self, JobKeys, SavedJob};
use post_job::plugin_finder;
use post_job::session::Session;
use post_job::settings::{About, SettingForm, SettingValue};
use post_testkit::{Rng, randomised};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Run, assert_contains, names, post_in, read_json, root};

/// A folder with copies of samples in `cl`.
fn shop() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("cl")).unwrap();
    for sample in ["blade.cls", "plate.ncl"] {
        let from = root().join("tests/samples").join(sample);
        fs::copy(from, folder.path().join("cl").join(sample)).unwrap();
    }
    folder
}

#[track_caller]
pub fn good(folder: &Path, arguments: &[&str]) -> Run {
    let run = post_in(folder, arguments);
    assert_eq!(run.code, 0, "{arguments:?}\n{}{}", run.out, run.err);
    run
}

#[track_caller]
pub fn refused(folder: &Path, arguments: &[&str], parts: &[&str]) {
    let run = post_in(folder, arguments);
    assert_eq!(run.code, 1, "{arguments:?}\n{}{}", run.out, run.err);
    assert_contains(&run.err, parts);
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// The program without the line that names its job.
fn without_mark(program: &str) -> String {
    let lines = program.lines().filter(|line| !line.contains("JOB "));
    lines.map(|line| format!("{line}\n")).collect()
}

const TYPED: [&str; 15] = [
    "-m",
    "ac-trunnion",
    "cl/blade.cls",
    "--mount",
    "0,0,20",
    "--turn=-90",
    "--tool-length=120.50",
    "--tolerance",
    "0.008",
    "--set",
    "accuracy.placement=fewest",
    "--set",
    "workpiece.mount=[0, 0, 1]",
    "--allow=INSERT",
    "--allow=OFSETL",
];

#[test]
fn a_saved_job_posts_the_program_that_was_typed() {
    let folder = shop();
    let folder = folder.path();
    fs::create_dir(folder.join("jobs")).unwrap();
    let more = ["-o", "jobs/typed.nc", "--summary=jobs/s.json", "--save-job", "jobs/a.job.toml"];
    good(folder, &[&TYPED[..], &more].concat());
    let job = read(folder, "jobs/a.job.toml");
    assert_eq!(
        job,
        "machine = \"ac-trunnion\"\ncl = \"../cl/blade.cls\"\noutput = \"typed.nc\"\n\
         summary = \"s.json\"\nallow = [\"INSERT\", \"OFSETL\"]\nmount = [0, 0, 20]\nturn = -90\n\
         tool_length = 120.50\ntolerance = 0.008\n\n[set]\n\"accuracy.placement\" = \"fewest\"\n\
         \"workpiece.mount\" = [0, 0, 1]\n"
    );
    let (typed, summary) = (read(folder, "jobs/typed.nc"), read(folder, "jobs/s.json"));
    assert!(!typed.contains("JOB "), "{typed}");
    good(folder, &["jobs/a.job.toml", "-q"]);
    let posted = read(folder, "jobs/typed.nc");
    assert_eq!(without_mark(&posted), typed);
    assert_eq!(posted.lines().count(), typed.lines().count() + 1);
    // From another folder, and by its whole path.
    let inside = folder.join("jobs");
    good(&inside, &["a.job.toml", "-q"]);
    assert_eq!(read(folder, "jobs/typed.nc"), posted);
    // A flag goes before the file, and the program is not that of the file any more.
    good(folder, &["jobs/a.job.toml", "-q", "--tolerance=0.02", "-o", "x.nc"]);
    let mut other = TYPED.to_vec();
    other[8] = "0.02";
    other.extend(["-q", "-o", "y.nc"]);
    good(folder, &other);
    assert_eq!(read(folder, "x.nc").replace("(X)", "(Y)"), read(folder, "y.nc"));
    // Where it goes, and what is said of it, makes no other program of it.
    good(folder, &["-q", "jobs/a.job.toml", "-o", "typed.nc", "--jobs=1", "--summary=t.json"]);
    assert_eq!(read(folder, "typed.nc"), posted);
    let with = |text: &str| text.replace(&format!("\"nc_lines\": {}", posted.lines().count()), "");
    assert_ne!(with(&read(folder, "t.json")), read(folder, "t.json"));
    assert_eq!(summary.lines().count(), read(folder, "t.json").lines().count());
    // A saved job of a job is that job.
    good(folder, &["jobs/a.job.toml", "-q", "--save-job=jobs/b.job.toml"]);
    assert_eq!(read(folder, "jobs/b.job.toml"), job);
}

#[test]
fn every_verb_takes_it_in_place_of_machine_and_cl_file() {
    let folder = shop();
    let folder = folder.path();
    let text = "machine = \"dmu50\"\ncl = \"cl/blade.cls\"\noutput = \"blade.h\"\n\
                mount = [0, 0, 120]\ntool_length = 120\nunits = \"mm\"\nsummary = \"s.json\"\n\
                [set]\naccuracy.tolerance = 0.01\n";
    fs::write(folder.join("part.job.toml"), text).unwrap();
    good(folder, &["part.job.toml", "-q"]);
    let settings =
        ["--mount=0,0,120", "--tool-length=120", "--set=accuracy.tolerance=0.01", "-mdmu50"];
    let cl = [&settings[..], &["--against=cl/blade.cls"]].concat();
    let same = |job: &[&str], typed: Vec<&str>| {
        assert_eq!(good(folder, job), good(folder, &typed), "{job:?}");
    };
    for verb in ["verify", "predict"] {
        let typed = [&[verb, "blade.h"], &cl[..]].concat();
        same(&[verb, "part.job.toml"], typed.clone());
        // By the hash in its head.
        same(&[verb, "blade.h"], typed.clone());
        same(&[verb, "blade.h", "--machine=part.job.toml"], typed);
    }
    same(&["read", "part.job.toml"], [&["read", "blade.h"], &settings[..]].concat());
    let diff = [&["diff", "blade.h", "blade.h"], &settings[..]].concat();
    same(&["diff", "blade.h", "part.job.toml"], diff.clone());
    same(&["diff", "blade.h", "blade.h"], diff);
    // The last line is the command that posts the part there.
    let place = good(folder, &["place", "part.job.toml"]).out;
    let typed = good(folder, &[&["place", "cl/blade.cls"], &settings[..]].concat()).out;
    let [(facts, command), (typed, _)] =
        [&place, &typed].map(|text| text.trim_end().rsplit_once('\n').unwrap());
    assert_eq!(facts, typed);
    assert!(command.starts_with("post part.job.toml --mount "), "{command}");
    same(&["words", "part.job.toml"], vec!["words", "cl/blade.cls"]);
    let convert = ["--from-mount=0,0,120", "--tool-length=120", "--from=dmu50", "-ox.nc"];
    let convert = [&["convert", "blade.h", "--to=ac-trunnion"], &convert[..]].concat();
    same(&["convert", "part.job.toml", "--to=ac-trunnion", "-ox.nc"], convert);
    // The outputs of posting are those of posting alone.
    let posted = fs::read(folder.join("s.json")).unwrap();
    good(folder, &["verify", "part.job.toml", "-q"]);
    assert_eq!(fs::read(folder.join("s.json")).unwrap(), posted);
    let view = good(folder, &["view", "--no-open", "verify", "part.job.toml", "-q"]);
    assert_contains(&view.err, &["report.html"]);
    let page = Path::new(view.err.trim());
    fs::remove_dir_all(page.parent().unwrap()).unwrap();
}

#[test]
fn a_program_finds_the_job_that_it_was_posted_from_and_no_other() {
    let folder = shop();
    let folder = folder.path();
    let text = "machine = \"ac-trunnion\"\ncl = \"cl/blade.cls\"\noutput = \"blade.nc\"\n";
    fs::write(folder.join("part.job.toml"), text).unwrap();
    good(folder, &["part.job.toml", "-q", "--tool-length=120"]);
    // What was made in another way does not name it.
    let verify = ["verify", "blade.nc", "-q"];
    let run = post_in(folder, &verify);
    assert_eq!(run.code, 2, "{}", run.err);
    fs::write(folder.join("part.job.toml"), format!("{text}tool_length = 120\n")).unwrap();
    good(folder, &["part.job.toml", "-q"]);
    good(folder, &verify);
    // Under another name it is the same job.
    fs::rename(folder.join("part.job.toml"), folder.join("old.job.toml")).unwrap();
    good(folder, &verify);
    // Changed, it is another.
    fs::write(folder.join("old.job.toml"), format!("{text}tool_length = 121\n")).unwrap();
    refused(folder, &verify, &["posted from the job file with the hash", "none in its folder"]);
    // Who names the machine needs no job.
    let typed = ["-mac-trunnion", "--against=cl/blade.cls", "--tool-length=120"];
    good(folder, &[&verify[..], &typed].concat());
}

#[test]
fn each_dialect_names_the_job_so_that_it_is_found() {
    let folder = shop();
    let folder = folder.path();
    let name = format!("{}.job.toml", "a-part-with-a-very-long-name".repeat(4));
    // Without an option that says so, GRBL has no rotary axes; these two have no retract that is proven.
    let dialects = plugin_finder::built_in(false).into_iter();
    let dialects = dialects.filter(|name| !matches!(*name, "grbl" | "klipper" | "marlin"));
    for dialect in dialects {
        let option = match dialect {
            "okuma" => "set.control.okuma.unit_system = \"1 mm\"\nset.control.retract.Z = 0\n",
            "brother" => "set.control.brother.unit_system = \"mm\"\n",
            "rrf" => "set.control.rrf.mill = true\n",
            _ => "",
        };
        let text = format!(
            "machine = \"ac-trunnion\"\ncl = \"cl/blade.cls\"\noutput = \"a.nc\"\n\
             tool_length = 120\ndialect = \"{dialect}\"\n{option}"
        );
        fs::write(folder.join(&name), text).unwrap();
        good(folder, &[&name, "-q"]);
        good(folder, &["verify", "a.nc", "-q"]);
        fs::remove_file(folder.join("a.nc")).unwrap();
    }
}

#[test]
fn no_text_of_a_job_file_is_too_odd_to_be_refused() {
    let (rounds, mut rng) = randomised(1500, 5);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.job.toml");
    let sample = fs::read(root().join("tests/jobs/blade.job.toml")).unwrap();
    let odd = [
        "\"", "[[", "]", "=", "\n", "\r", "\u{e9}", "\u{2028}", "set", "program", "{", "-", ".",
        "1e999",
    ];
    for _ in rounds {
        let mut text = String::from_utf8(sample.clone()).unwrap();
        for _ in 0..1 + rng.pick(4) {
            let mut at = rng.pick(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            match rng.pick(2) {
                0 => text.insert_str(at, odd[rng.pick(odd.len())]),
                _ => text.truncate(at),
            }
            if text.is_empty() {
                break;
            }
        }
        fs::write(&path, &text).unwrap();
        if let Err(fault) = job_file::read(&Session::quiet(), &path) {
            assert!(!fault.findings().is_empty(), "{text}");
        }
    }
}

#[test]
fn several_programs_are_made_in_their_order() {
    let folder = shop();
    let folder = folder.path();
    let text = "machine = \"ac-trunnion\"\ntool_length = 120\nset.accuracy.tolerance = 0.01\n\
                [[program]]\ncl = \"cl/blade.cls\"\noutput = \"a.nc\"\nverify = true\n\
                [[program]]\ncl = \"cl/plate.ncl\"\noutput = \"b.nc\"\nmachine = \"vmc\"\n\
                tool_length = 80\nset.accuracy.tolerance = 0.02\n";
    fs::write(folder.join("two.job.toml"), text).unwrap();
    let run = good(folder, &["two.job.toml"]);
    assert_contains(&run.out, &["a.nc, from cl/blade.cls", "tolerance 0.01 mm", "read back"]);
    assert_contains(&run.out, &["b.nc, from cl/plate.ncl", "tolerance 0.02 mm", "80 mm long"]);
    let run = good(folder, &["verify", "two.job.toml"]);
    assert_contains(&run.out, &["a.nc, ", "b.nc, "]);
    let run = good(folder, &["verify", "b.nc"]);
    assert_contains(&run.out, &["b.nc, "]);
    assert!(!run.out.contains("a.nc, "), "{}", run.out);
    for arguments in [&["two.job.toml", "-o", "x.nc"][..], &["two.job.toml", "--summary=x.json"]] {
        refused(folder, arguments, &["2 programs", "takes one"]);
    }
    refused(folder, &["diff", "a.nc", "two.job.toml"], &["2 programs"]);
    refused(folder, &["verify", "-m", "two.job.toml", "c.nc"], &["none of them is called"]);
    assert_eq!(names(folder), ["a.nc", "b.nc", "cl", "two.job.toml"]);
}

#[test]
fn what_is_wrong_is_told_by_its_line() {
    let folder = shop();
    let folder = folder.path();
    let cases = [
        ("mont = [0, 0, 1]", "no key `mont`", "did you mean `mount`?"),
        ("tool_length = \"long\"", "`long` is no number", "--tool-length"),
        ("mount = [0, 0]", "three numbers are needed", "--mount"),
        ("verify = 1", "verify is true or false", "Verifies each program"),
        ("tcp = \"contrl\"", "`contrl` is neither control nor post", "--tcp"),
        ("plan_rounds = 3", "plan_rounds needs plan", "--plan-rounds"),
        ("tool = 3\ntool_from_cutter = true", "cannot go with tool", "--tool-from-cutter"),
        ("tools = 3", "tools is a file or a folder", "tool table"),
        ("plugins = \".\"", "names no folder of plugins", "--plugins on the command line"),
        ("output = \"../x.nc\"", "stands in its folder or below", "--output on the command line"),
        ("report = \"/tmp/x.html\"", "stands in its folder or below", "--report"),
        ("output = \"-\"", "stands in its folder or below", "--output"),
        ("set = 3", "set is a table", "[set] has parameters"),
        ("set.tools.file = \"x\"", "the file of tools is a key of its own", "tools = "),
        ("dialect = \"a\\u001bb\"", "one line of text is meant", "part.job.toml:3"),
        (
            "[[program]]\noutput = \"a\"\n[[program]]\noutput = \"a\"",
            "another program of this job",
            "",
        ),
        ("x = = 1", "part.job.toml:3", ""),
    ];
    for (wrong, message, help) in cases {
        let text = format!("machine = \"vmc\"\ncl = \"cl/plate.ncl\"\n{wrong}\n");
        fs::write(folder.join("part.job.toml"), text).unwrap();
        refused(folder, &["part.job.toml"], &[message, help, "nothing was written"]);
        assert_eq!(names(folder), ["cl", "part.job.toml"], "{wrong}");
    }
    for (text, message) in [
        ("cl = \"cl/plate.ncl\"", "names no machine"),
        ("machine = \"vmc\"", "names no CL file"),
        ("machine = \"vmc\"\nprogram = 3", "programs are tables"),
        ("machine = \"vmc\"\nprogram = []", "there is no program"),
    ] {
        fs::write(folder.join("part.job.toml"), text).unwrap();
        refused(folder, &["part.job.toml"], &[message]);
    }
}

#[test]
fn a_strangers_job_file_has_an_end_and_overwrites_nothing_that_is_read() {
    let folder = shop();
    let folder = folder.path();
    let job = folder.join("part.job.toml");
    let head = "machine = \"vmc\"\ntool_length = 80\ncl = \"cl/plate.ncl\"\n";
    for output in ["cl/plate.ncl", "part.job.toml", "./cl/../cl/plate.ncl"] {
        fs::write(&job, format!("{head}output = \"{output}\"\n")).unwrap();
        let run = post_in(folder, &["part.job.toml", "-q"]);
        assert_eq!(run.code, 1, "{output}: {}", run.err);
    }
    assert_eq!(read(folder, "part.job.toml").lines().next(), Some("machine = \"vmc\""));
    fs::write(&job, format!("{head}# {}\n", "x".repeat(1 << 20))).unwrap();
    refused(folder, &["part.job.toml"], &["longer than"]);
    fs::write(&job, b"machine = \"\xff\"").unwrap();
    refused(folder, &["part.job.toml"], &["UTF-8"]);
    fs::remove_file(&job).unwrap();
    fs::create_dir(&job).unwrap();
    refused(folder, &["part.job.toml"], &["no regular file"]);
    refused(folder, &["none.job.toml"], &["none.job.toml"]);
    refused(folder, &["a.job.toml", "b.job.toml"], &["two job files"]);
    // A link that came with it leads nowhere else either.
    #[cfg(unix)]
    {
        let elsewhere = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(elsewhere.path(), folder.join("out")).unwrap();
        fs::remove_dir(&job).unwrap();
        fs::write(&job, format!("{head}output = \"out/plate.nc\"\n")).unwrap();
        refused(folder, &["part.job.toml"], &["stands in its folder or below"]);
        assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 0);
        fs::remove_file(folder.join("out")).unwrap();
        fs::remove_file(&job).unwrap();
    }
    // What leads out of the folder, or would run code, stays on the command line.
    fs::create_dir_all(folder.join("jobs/plugins")).unwrap();
    let typed = ["-mvmc", "cl/plate.ncl", "--tool-length=80", "-oplate.nc", "-q"];
    let more = ["--plugins=jobs/plugins", "--save-job=jobs/part.job.toml"];
    good(folder, &[&typed[..], &more].concat());
    let saved = read(folder, "jobs/part.job.toml");
    assert_contains(&saved, &["# --output stays on the command line", "# --plugins stays on"]);
    for (name, message) in [("part.toml", "ends in .job.toml"), (".job.toml", "ends in")] {
        refused(folder, &[&typed[..], &["--save-job", name]].concat(), &[message]);
    }
}

#[test]
fn an_old_runs_settings_are_taken_from_its_summary() {
    let folder = shop();
    let folder = folder.path();
    let typed = ["-mac-trunnion", "cl/blade.cls", "--tool-length=120", "--tolerance=0.02", "-q"];
    let seat = ["--mount=1.5,-2,40", "--turn=30"];
    let more = ["--tcp=control", "--dialect=siemens", "--set=accuracy.axis_tolerance=0.1"];
    let outputs = ["-oold.mpf", "--summary=old.json"];
    good(folder, &[&typed[..], &seat, &more, &outputs].concat());
    let like = ["-mac-trunnion", "cl/blade.cls", "--like=old.json", "-q"];
    good(folder, &[&like[..], &["-onew.mpf", "--summary=new.json"]].concat());
    // What is told of the job, apart from the program's own name and text.
    let told = |name: &str| {
        let mut told = read_json(&folder.join(name));
        told.as_object_mut().unwrap().remove("program").unwrap();
        told
    };
    assert_eq!(told("new.json"), told("old.json"));
    assert_eq!(read(folder, "new.mpf").replace("; new", "; old"), read(folder, "old.mpf"));
    // What is said goes before it; over a job file it goes before that.
    good(folder, &[&like[..], &["-onew.mpf", "--tolerance=0.01", "--summary=new.json"]].concat());
    assert_eq!(read_json(&folder.join("new.json"))["tolerance_mm"], 0.01);
    let job =
        "machine = \"ac-trunnion\"\ncl = \"cl/blade.cls\"\noutput = \"a.mpf\"\ntolerance = 0.5\n";
    fs::write(folder.join("a.job.toml"), job).unwrap();
    good(folder, &["a.job.toml", "--like", "old.json", "-q", "--summary=a.json"]);
    assert_eq!(told("a.json"), told("old.json"));
    let other = ["-mdmu50", "cl/blade.cls", "--like=old.json", "-q", "-ox.mpf", "--mount=0,0,120"];
    let run = good(folder, &other);
    assert_contains(&run.err, &["tells of a program for AC trunnion"]);
    fs::write(folder.join("old.json"), "{}").unwrap();
    refused(folder, &like, &["no summary of a run"]);
}

#[test]
fn a_batch_takes_the_programs_of_job_files() {
    let folder = shop();
    let folder = folder.path();
    let job = "machine = \"ac-trunnion\"\ntool_length = 120\n[[program]]\ncl = \"cl/blade.cls\"\n\
               mount = [0, 0, 20]\n[[program]]\ncl = \"cl/plate.ncl\"\nmachine = \"vmc\"\n\
               set.accuracy.placement = \"fewest\"\ntolerance = 0.02\nverify = true\n";
    fs::write(folder.join("a.job.toml"), job).unwrap();
    let lines = r#"{"file": "cl/blade.cls", "machine": "ac-trunnion", "tool_length": 120, "mount": [0, 0, 20]}
{"file": "cl/plate.ncl", "machine": "vmc", "tool_length": 120, "set": {"accuracy.placement": "\"fewest\""}, "tolerance": 0.02}
"#;
    fs::write(folder.join("a.jsonl"), lines).unwrap();
    good(folder, &["batch", "a.job.toml", "-o", "a.csv", "-q"]);
    good(folder, &["batch", "a.jsonl", "-o", "b.csv", "-q"]);
    assert_eq!(read(folder, "a.csv"), read(folder, "b.csv"));
    assert_eq!(read(folder, "a.csv").lines().count(), 3);
    fs::write(folder.join("a.job.toml"), format!("units = \"inch\"\n{job}")).unwrap();
    refused(folder, &["batch", "a.job.toml", "-o", "a.csv"], &["units", "a.job.toml:1", "--units"]);
    good(folder, &["batch", "a.job.toml", "-o", "a.csv", "-q", "--units=inch"]);
}

#[test]
fn the_schema_has_every_key_and_no_other() {
    let schema = good(root(), &["schema", "--job"]).out;
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let keys = |of: &Value| -> Vec<String> {
        let mut keys: Vec<String> = of["properties"].as_object().unwrap().keys().cloned().collect();
        keys.sort();
        keys
    };
    let mut known: Vec<String> = JobKeys::about().map(|about| about.name.to_owned()).collect();
    known.retain(|name| !["plugins", "then"].contains(&name.as_str()));
    known.extend(["machine", "cl"].map(str::to_owned));
    known.sort();
    for table in ["program", "channel"] {
        assert_eq!(keys(&schema["properties"][table]["items"]), known);
    }
    known.extend(["program", "channel"].map(str::to_owned));
    known.sort();
    assert_eq!(keys(&schema), known);
    // Every key that is in the schema is read, as the sample of the book is.
    let sample = root().join("tests/jobs/blade.job.toml");
    let job = job_file::read(&Session::quiet(), &sample).unwrap();
    assert_eq!(job.programs.len(), 2);
}

/// A value of a setting as a command line says it; none of what no job file has.
fn value(about: &About, rng: &mut Rng) -> Option<SettingValue> {
    let number = |rng: &mut Rng| format!("{:?}", (rng.range(0.1, 50.0) * 1e4).round() / 1e4);
    let text = |rng: &mut Rng| match (about.name, about.value) {
        ("set", _) => ["Lm=312", "accuracy.tolerance = 0.01", "control.tcp=post", "a.b=[1, 2]"]
            [rng.pick(4)]
        .to_owned(),
        ("allow", _) => ["INSERT", "OFSETL"][rng.pick(2)].to_owned(),
        ("dialect", _) => "a \"b\" \\ c".to_owned(),
        ("mount", _) => format!("{},-{},0", number(rng), number(rng)),
        _ => number(rng),
    };
    let one = |rng: &mut Rng| match about.form {
        SettingForm::Flag => SettingValue::Yes(true),
        SettingForm::Text => SettingValue::Text(text(rng)),
        SettingForm::Words(words) => SettingValue::from(words()[rng.pick(words().len())]),
        SettingForm::Whole { least, most } => {
            SettingValue::Whole(rng.range(least as f64, most.min(1000) as f64) as i64)
        }
        SettingForm::PathIfAny if rng.pick(2) == 0 => SettingValue::Yes(true),
        SettingForm::Path | SettingForm::PathIfAny => SettingValue::Path("out/a \"b\".x".into()),
    };
    let alone = ["plugins", "tool_from_cutter", "plan_rounds", "report_max"];
    (!alone.contains(&about.name)).then(|| match about.many {
        true => SettingValue::List((0..1 + rng.pick(2)).map(|_| one(rng)).collect()),
        false => one(rng),
    })
}

#[test]
fn whatever_is_saved_is_read_back() {
    let (rounds, mut rng) = randomised(300, 4);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.job.toml");
    for _ in rounds {
        let mut said = Vec::new();
        for about in JobKeys::about() {
            if rng.pick(3) == 0 {
                said.extend(value(about, &mut rng).map(|value| (about, value)));
            }
        }
        let plans = |(about, value): &(&About, SettingValue)| {
            about.name == "plan" && *value == SettingValue::Yes(true)
        };
        let plans = said.iter().any(plans);
        said.retain(|(about, _)| plans || about.requires != Some("plan"));
        // Places to write lie below the job file.
        for (_, value) in &mut said {
            if let SettingValue::Path(path) = value {
                *path = folder.path().join(&*path);
            }
            if let SettingValue::List(values) = value {
                for value in values {
                    if let SettingValue::Path(path) = value {
                        *path = folder.path().join(&*path);
                    }
                }
            }
        }
        let cl = PathArg::from(folder.path().join("cl/../part.cls"));
        let saved = SavedJob { machine: "dmu50", cl: &cl, said: &said };
        let text = job_file::text(&saved, &PathArg::from(path.clone())).unwrap();
        fs::write(&path, &text).unwrap();
        let job = job_file::read(&Session::quiet(), &path);
        let job = job.unwrap_or_else(|fault| panic!("{:?}\n{text}", fault.findings()));
        let read = job.programs[0].keys().unwrap();
        let mut typed = JobKeys::default();
        for (about, value) in &said {
            let put = typed.groups().into_iter().find_map(|group| group.put(about.name, value));
            put.unwrap().unwrap();
        }
        // A table has a key of the machine file once.
        let plain = |mut keys: JobKeys| {
            let set = std::mem::take(&mut keys.over.set);
            let mut last: Vec<String> = Vec::new();
            for setting in set {
                let text = format!("{setting:?}").replace([' ', '\\', '"'], "");
                let name = text.split('=').next().unwrap().to_owned();
                last.retain(|known| known.split('=').next() != Some(&name));
                last.push(text);
            }
            format!("{keys:?} {last:?}")
        };
        assert_eq!(plain(read), plain(typed), "{text}");
    }
}
