//! `post batch`: a row for each job, whatever comes of it, and the same bytes however the work is shared out.

use crate::common;

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use common::{GOOD, Run, assert_contains, command, post, run, sample};
use serde_json::Value;
use tempfile::TempDir;

/// Two files, three machines of which one cannot point the tool, two placements, two tool lengths: 24 jobs.
const GRID: &[&str] = &[
    "--machine",
    "ac-trunnion",
    "--machine",
    "dmu50",
    "--machine",
    "vmc",
    "--set",
    "accuracy.placement=bisect,fewest",
    "--tool-length",
    "0,120",
];

fn batch(folder: &Path, output: &str, more: &[&str]) -> Run {
    let output = folder.join(output);
    let files = [sample("blade.cls"), sample("plate.ncl")];
    let mut words = vec!["batch", "-o", output.to_str().unwrap()];
    words.extend(files.iter().map(|file| file.to_str().unwrap()));
    words.extend(more);
    let done = post(&words);
    assert_eq!(done.code, 0, "{words:?}:\n{}", done.err);
    done
}

fn grid(folder: &Path, output: &str, more: &[&str]) -> Run {
    batch(folder, output, &[GRID, more].concat())
}

fn rows(folder: &Path, output: &str) -> Vec<Value> {
    let text = fs::read_to_string(folder.join(output)).unwrap();
    let lines = text.lines();
    lines.map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// A folder with lines of jobs in `jobs.jsonl`.
fn listed(lines: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("jobs.jsonl"), lines.join("\n")).unwrap();
    folder
}

#[test]
fn every_job_of_the_grid_is_a_row_as_the_command_would_make_it() {
    let folder = tempfile::tempdir().unwrap();
    let done = grid(folder.path(), "r.jsonl", &["--verify", "--predict", "--jobs", "2"]);
    let rows = rows(folder.path(), "r.jsonl");
    assert_eq!(rows.len(), 24);
    assert_contains(&done.out, &["24 jobs: 18 written, 6 refused", "out-of-reach 4"]);
    let mut written = 0;
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(row["job"], number);
        let machine = ["ac-trunnion", "dmu50", "vmc"][number / 4 % 3];
        let placement = ["bisect", "fewest"][number / 2 % 2];
        let length = ["0", "120"][number % 2];
        let file = ["blade.cls", "plate.ncl"][number / 12];
        assert_eq!(row["machine"], machine);
        assert_eq!(row["accuracy.placement"], placement);
        assert_eq!(row["tool_length_mm"], length.parse::<f64>().unwrap());
        // A program is called after its file, as the row's is after the CL file.
        let out = folder.path().join(file).with_extension("nc");
        let json = folder.path().join("one.json");
        let setting = format!("accuracy.placement={placement}");
        let one = run(
            command()
                .args(["-m", machine, "--tool-length", length, "--set", &setting])
                .args(["--verify", "--predict", "-o"])
                .arg(&out)
                .arg("--summary")
                .arg(&json)
                .arg(sample(file)),
            b"",
        );
        if row["state"] == "refused" {
            assert_eq!(one.code, 1, "{row}");
            let codes = row["codes"].as_str().unwrap();
            assert!(!codes.is_empty());
            for code in codes.split(' ') {
                assert_contains(&one.err, &[&format!("error[{code}]")]);
            }
            let message = row["message"].as_str().unwrap();
            assert_contains(&one.err, &[&message[..40]]);
            continue;
        }
        written += 1;
        assert_eq!(one.code, 0, "{row}\n{}", one.err);
        let summary = common::read_json(&json);
        let text = fs::read(&out).unwrap();
        assert_eq!(row["nc_hash"], blake3_of(&text), "{row}");
        assert_eq!(row["nc_bytes"], text.len());
        let same = [
            ("cycle_time_s", &summary["time_s"]),
            ("blocks", &summary["blocks"]),
            ("tip_deviation_mm", &summary["tip_deviation_mm"]["value"]),
            ("axis_deviation_deg", &summary["axis_deviation_deg"]["value"]),
            ("predicted_cycle_time_s", &summary["prediction"]["time"]["cycle_s"]),
            ("contour_error_mm", &summary["prediction"]["contour"]["tip_mm"]["largest"]),
            ("verified_tip_deviation_mm", &summary["verification"]["tip"]["value"]),
        ];
        for (column, value) in same {
            assert_eq!(row[column], *value, "{column}");
        }
        for axis in summary["axes"].as_array().unwrap() {
            let name = axis["name"].as_str().unwrap();
            let unit = if "ABC".contains(name) { "deg" } else { "mm" };
            assert_eq!(row[format!("{name}_least_{unit}")], axis["min"]);
            assert_eq!(row[format!("{name}_largest_{unit}")], axis["max"]);
        }
    }
    assert_eq!(written, 18);
}

fn blake3_of(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

#[test]
fn bytes_are_the_same_for_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    for ending in ["parquet", "csv", "jsonl"] {
        let (one, two) = (format!("one.{ending}"), format!("two.{ending}"));
        grid(folder.path(), &one, &["--jobs", "1"]);
        grid(folder.path(), &two, &["--jobs", "2"]);
        let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
        assert!(read(&one) == read(&two), "{ending}");
        assert!(!read(&one).is_empty());
    }
}

#[test]
fn the_parts_of_a_study_are_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    grid(folder.path(), "whole.csv", &[]);
    let lines = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        text.lines().map(str::to_owned).collect()
    };
    let whole = lines("whole.csv");
    let mut parts = Vec::new();
    for index in 1..=5 {
        let name = format!("part-{index}.csv");
        grid(folder.path(), &name, &["--shard", &format!("{index}/5")]);
        let part = lines(&name);
        assert_eq!(part[0], whole[0], "the columns are those of the whole");
        assert!((5..=6).contains(&part.len()));
        parts.extend_from_slice(&part[1..]);
    }
    let number = |line: &String| line.split(',').next().unwrap().parse::<u32>().unwrap();
    parts.sort_by_key(number);
    assert_eq!(parts, whole[1..]);
}

#[test]
fn a_second_run_does_no_job_and_a_change_of_anything_does_its_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::write(&file, GOOD).unwrap();
    let machine = folder.path().join("mine.toml");
    fs::write(&machine, "extends = \"parent.toml\"\nname = \"mine\"\n").unwrap();
    let parent = folder.path().join("parent.toml");
    fs::write(&parent, "extends = \"ac-trunnion\"\n").unwrap();
    let table = folder.path().join("r.parquet");
    let go = |more: &[&str]| {
        let mut words = vec!["batch", "--resume", "--tool-length", "100", "--tolerance"];
        words.extend(["0.01,0.02", "-m", machine.to_str().unwrap(), "-o"]);
        words.push(table.to_str().unwrap());
        words.push(file.to_str().unwrap());
        words.extend(more);
        let done = post(&words);
        assert_eq!(done.code, 0, "{}", done.err);
        assert_contains(&done.out, &["2 jobs: 2 written"]);
        let known = done.out.contains("; 2 taken from the journal");
        (known, fs::read(&table).unwrap())
    };
    let (known, first) = go(&[]);
    assert!(!known);
    let (known, second) = go(&[]);
    assert!(known && first == second);
    // What computing took comes from the journal too: it is that of the run that did it.
    let (known, timed) = go(&["--timings"]);
    assert!(known && timed.len() > first.len());
    assert!(!go(&["--verify"]).0, "an option");
    fs::write(&file, GOOD.replace("20,0,10", "21,0,10")).unwrap();
    assert!(!go(&[]).0, "the CL file");
    fs::write(&parent, "extends = \"ac-trunnion\"\n[accuracy]\nplacement = \"even\"\n").unwrap();
    assert!(!go(&[]).0, "what the machine extends");
    let (known, _) = go(&[]);
    assert!(known);
}

#[test]
fn a_run_that_is_killed_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    grid(folder.path(), "whole.csv", &[]);
    let output = folder.path().join("r.csv");
    let journal = folder.path().join("r.csv.journal");
    let mut child = command()
        .args(["batch", "--jobs", "1", "-o"])
        .arg(&output)
        .args(GRID)
        .args([sample("blade.cls"), sample("plate.ncl")])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let lines = || {
        let text = fs::read(&journal).unwrap_or_default();
        text.iter().filter(|byte| **byte == b'\n').count()
    };
    let begun = Instant::now();
    while lines() < 3 {
        assert!(begun.elapsed() < Duration::from_secs(60), "no job is done");
        std::thread::sleep(Duration::from_millis(1));
    }
    // On Unix this is SIGKILL: nobody is asked.
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!output.exists(), "a table is written whole");
    let kept = lines();
    assert!(kept < 24, "it was not killed in time");
    // As a write that was cut off leaves it.
    let mut text = fs::read(&journal).unwrap();
    let torn = text[..text.iter().position(|byte| *byte == b'\n').unwrap()].to_vec();
    text.extend_from_slice(b"\xFFno line\n{\"key\":\"0\"}\n");
    text.extend_from_slice(&torn[..torn.len() / 2]);
    fs::write(&journal, text).unwrap();
    let done = grid(folder.path(), "r.csv", &["--resume"]);
    assert_contains(&done.out, &[&format!("; {kept} taken from the journal")]);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(read("r.csv"), read("whole.csv"));
    // The line after the torn one is whole.
    let done = grid(folder.path(), "r.csv", &["--resume"]);
    assert_contains(&done.out, &["; 24 taken from the journal"]);
}

#[test]
fn what_cannot_be_done_at_all_is_a_row_too() {
    let good = sample("blade.cls");
    let good = good.to_str().unwrap();
    let line = |rest: &str| format!("{{\"file\": \"{good}\", {rest}}}");
    let lines = [
        "{\"file\": \"no-such.cls\", \"machine\": \"vmc\"}".to_owned(),
        line("\"machine\": \"ac-trunion\""),
        line("\"set\": {\"Zc\": \"no number\"}"),
        line("\"set\": {\"accuracy.model\": \"nobody\"}"),
        line("\"set\": {\"accuracy.placement\": \"even\"}, \"mount\": [0, 0.5, -1e1]"),
    ];
    let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
    let folder = listed(&lines);
    let list = folder.path().join("jobs.jsonl");
    let table = folder.path().join("r.jsonl");
    let words = ["batch", "-m", "ac-trunnion", "--tool-length", "0", "-o"];
    let mut words = words.to_vec();
    words.extend([table.to_str().unwrap(), list.to_str().unwrap()]);
    let done = post(&words);
    assert_eq!(done.code, 0, "{}", done.err);
    let rows = rows(folder.path(), "r.jsonl");
    let told: Vec<(&str, &str)> = rows
        .iter()
        .map(|row| (row["state"].as_str().unwrap(), row["codes"].as_str().unwrap()))
        .collect();
    assert_eq!(told[0], ("refused", "input"));
    assert_eq!(told[1], ("refused", "machine"));
    assert_eq!(told[2].0, "refused");
    assert_eq!(told[3], ("refused", "plugin"));
    assert_eq!(told[4], ("written", ""));
    assert_contains(rows[0]["message"].as_str().unwrap(), &["no-such.cls"]);
    assert_eq!(rows[4]["mount_z_mm"], -10.0);
    // A column is of numbers only if all its values are.
    assert_eq!(rows[2]["Zc"], "no number");
}

#[test]
fn a_plugin_that_refuses_is_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let library = crate::plugins::built("faulty");
    let name =
        format!("{}post_faulty{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    fs::copy(library, folder.path().join(name)).unwrap();
    let more = ["-m", "ac-trunnion", "--tool-length", "0", "--set"];
    let mut more = more.to_vec();
    more.extend(["accuracy.model=sampled,faulty", "--set", "accuracy.faulty.fault=none-of-them"]);
    more.extend(["--plugins", folder.path().to_str().unwrap()]);
    batch(folder.path(), "r.jsonl", &more);
    let rows = rows(folder.path(), "r.jsonl");
    assert_eq!(rows.len(), 4);
    assert_eq!(rows[0]["state"], "written");
    assert_eq!(rows[1]["state"], "refused", "{}", rows[1]);
    assert_eq!(rows[1]["codes"], "plugin", "{}", rows[1]);
    assert_contains(rows[1]["message"].as_str().unwrap(), &["faulty"]);
}

#[test]
fn slips_are_told_before_any_work() {
    let folder = listed(&[
        "{\"file\": \"a.cls\", \"machine\": \"vmc\", \"mont\": 1}",
        "",
        "{\"file\": \"a.cls\", \"tool_length\": \"long\"}",
        "{\"file\": \"a.cls\", \"set\": {\"Lm\": null}}",
    ]);
    let endless = fs::File::create(folder.path().join("endless")).unwrap();
    endless.set_len(65 << 20).unwrap();
    let cases: [(&[&str], i32, &[&str]); 11] = [
        (
            &["jobs.jsonl", "-o", "r.csv"],
            1,
            &["jobs.jsonl, line 1", "mont", "line 3", "line 4", "tool_length"],
        ),
        (&["a.cls", "-o", "r.csv"], 1, &["no machine is named for a.cls"]),
        (&["a.cls", "-m", "vmc", "-o", "r.xls"], 1, &[".parquet, .csv or .jsonl"]),
        (&["a.cls", "-m", "vmc", "-o", "r.csv", "--shard", "3/2"], 2, &["is no part"]),
        (&["a.cls", "-m", "vmc", "-o", "r.csv", "--turn", "0:90:-1"], 2, &["range"]),
        (&["a.cls", "-m", "vmc", "-o", "r.csv", "--turn", "north"], 1, &["turn: `north`"]),
        (
            &["a.cls", "-m", "vmc", "-o", "r.csv", "--svg", "m.svg", "--x", "file", "--y", "sate"],
            1,
            &["there is no column sate", "state"],
        ),
        (
            &["a.cls", "-m", "vmc", "-o", "r.csv", "--resume=a.cls"],
            1,
            &["the journal would overwrite the CL file a.cls"],
        ),
        (
            &["a.cls", "-m", "vmc", "-o", "r.csv", "--resume=jobs.jsonl"],
            1,
            &["jobs.jsonl", "this is no journal of post batch"],
        ),
        (
            &["a.cls", "-m", "vmc", "-o", "r.csv", "--resume=endless"],
            1,
            &["endless", "this is no journal of post batch"],
        ),
        (
            &["a.cls", "-m", "vmc", "-o", "r.csv", "--set", "Lm=1", "--set", "Lm=2"],
            1,
            &["--set has Lm twice", "--set Lm=200,250"],
        ),
    ];
    for (words, code, parts) in cases {
        let done = common::post_in(folder.path(), &[&["batch"], words].concat());
        assert_eq!(done.code, code, "{words:?}: {}", done.err);
        assert_contains(&done.err, parts);
    }
}

#[test]
fn the_map_shows_every_cell_once() {
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("map.svg");
    let more = ["--svg", svg.to_str().unwrap(), "--x", "tool_length_mm", "--y"];
    grid(folder.path(), "r.csv", &[&more[..], &["accuracy.placement"]].concat());
    let picture = fs::read_to_string(&svg).unwrap();
    // Four cells of six maps, and the white ground.
    assert_eq!(picture.matches("<rect ").count(), 24 + 1);
    // Six of them are refused, each two lines; two ticks to each side of each map.
    assert_eq!(picture.matches("<line ").count(), 6 * 2 + 6 * 4);
    assert_contains(&picture, &["blade.cls on vmc", "tool_length_mm", "cycle_time_s"]);
}

#[test]
fn a_table_can_go_to_standard_output() {
    let file = sample("blade.cls");
    let words = ["batch", "-m", "ac-trunnion", "--tool-length", "0,1", "-o", "-"];
    let done = post(&[&words[..], &[file.to_str().unwrap()]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(done.out.lines().count(), 3);
    assert!(done.out.starts_with("job,file,machine,tool_length_mm,state,"));
    assert_contains(&done.err, &["2 jobs: 2 written"]);
}
