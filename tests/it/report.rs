//! `--report` and `post view`: what is packed comes back, letter for letter and number for number, by a decoder of the
//! tests' own.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use miniz_oxide::inflate::decompress_to_vec;
use serde_json::Value;

use crate::common::{assert_contains, command, post, post_in, root, run};
use crate::generate;

/// A sample by its whole path: the command runs in a folder of its own.
fn sample_file(name: &str) -> PathBuf {
    root().join("tests/samples").join(name)
}

/// A report, unpacked.
struct Page {
    html: String,
    meta: Value,
    parts: BTreeMap<String, Vec<Vec<u8>>>,
}

fn of_base64(text: &str) -> Vec<u8> {
    let letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let places: BTreeMap<u8, u32> = letters.bytes().zip(0..).collect();
    let (mut bytes, mut bits, mut count) = (Vec::new(), 0u32, 0);
    for letter in text.bytes().filter(|letter| *letter != b'=') {
        bits = bits << 6 | places[&letter];
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    bytes
}

fn word(bytes: &[u8], at: &mut usize) -> usize {
    *at += 4;
    u32::from_le_bytes(bytes[*at - 4..*at].try_into().unwrap()) as usize
}

/// A column of integers.
fn integers(bytes: &[u8], rows: usize, at: &mut usize) -> Vec<i64> {
    let (form, planes) = (bytes[*at], bytes[*at + 1] as usize);
    *at += 2;
    let (mut first, mut step) = (0, 1);
    if form >= 16 {
        first = f64::from_le_bytes(bytes[*at..*at + 8].try_into().unwrap()) as i64;
        *at += 8;
        step = word(bytes, at) as i64;
    }
    let start = *at;
    *at += planes * rows;
    let (mut last, mut slope) = (0, 0);
    let value = |row: usize| {
        let plane = |plane: usize| (bytes[start + plane * rows + row] as i64) << (8 * plane);
        let folded: i64 = (0..planes).map(plane).sum();
        let difference = if folded % 2 == 0 { folded / 2 } else { -(folded + 1) / 2 };
        let slopes = [0, difference, slope + difference];
        slope = slopes[2];
        last = match form % 16 {
            0 => difference,
            1 => last + difference,
            _ => last + slope,
        };
        first + step * last
    };
    (0..rows).map(value).collect()
}

impl Page {
    fn read(path: &Path) -> Self {
        let html = fs::read_to_string(path).unwrap();
        let mut parts: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
        let marker = "<script type=\"text/plain\" class=\"part\" data-name=\"";
        for part in html.split(marker).skip(1) {
            let (name, rest) = part.split_once("\">").unwrap();
            let (letters, _) = rest.split_once("</script>").unwrap();
            let bytes = decompress_to_vec(&of_base64(letters)).unwrap();
            parts.entry(name.to_owned()).or_default().push(bytes);
        }
        let meta = serde_json::from_slice(&parts["meta"][0]).unwrap();
        Self { html, meta, parts }
    }

    fn table(&self, name: &str) -> &Value {
        let tables = self.meta["tables"].as_array().unwrap();
        let table = tables.iter().find(|table| table["name"] == name);
        table.unwrap_or_else(|| panic!("no table {name}"))
    }

    /// The page derives a part of the column from others.
    fn is_derived(&self, table: &str, wanted: &str) -> bool {
        let columns = self.table(table)["columns"].as_array().unwrap();
        let column = columns.iter().find(|column| column["name"] == wanted);
        column.unwrap().get("from").is_some()
    }

    /// The values of a column as they are packed.
    fn column(&self, table: &str, wanted: &str) -> Vec<f64> {
        let meta = self.table(table);
        let columns = meta["columns"].as_array().unwrap();
        let mut values = Vec::new();
        for chunk in &self.parts[table] {
            let mut at = 0;
            let rows = word(chunk, &mut at);
            for column in columns {
                let read = integers(chunk, rows, &mut at);
                if column["name"] == wanted {
                    let decimals = column["decimals"].as_u64().unwrap();
                    let scale = (0..decimals).fold(1.0, |scale, _| 10.0 * scale);
                    values.extend(read.iter().map(|value| *value as f64 / scale));
                }
            }
            assert_eq!(at, chunk.len(), "{table}");
        }
        assert_eq!(values.len() as u64, meta["rows"].as_u64().unwrap(), "{table}.{wanted}");
        values
    }

    /// A text, letter for letter.
    fn text(&self, name: &str) -> Vec<u8> {
        let mut text = Vec::new();
        for chunk in &self.parts[&format!("text.{name}")] {
            match chunk[4] {
                0 => text.extend_from_slice(&chunk[5..]),
                _ => of_templates(chunk, &mut text),
            }
        }
        text
    }
}

/// The lines of a chunk that was packed as templates.
fn of_templates(chunk: &[u8], text: &mut Vec<u8>) {
    let mut at = 0;
    let lines = word(chunk, &mut at);
    at += 1;
    let count = word(chunk, &mut at);
    let mut templates = Vec::new();
    for _ in 0..count {
        let length = word(chunk, &mut at);
        templates.push(&chunk[at..at + length]);
        at += length;
    }
    let columns = word(chunk, &mut at);
    let slots: Vec<Vec<usize>> = templates
        .iter()
        .map(|template| {
            let numbers = template.iter().filter(|byte| **byte == 0).count();
            (0..numbers).map(|_| word(chunk, &mut at)).collect()
        })
        .collect();
    let order = integers(chunk, lines, &mut at);
    let mut read = Vec::new();
    for _ in 0..columns {
        let rows = word(chunk, &mut at);
        let form = usize::from(chunk[at]);
        at += 1;
        let digits = integers(chunk, rows, &mut at);
        let own = match form >= 64 {
            true => integers(chunk, rows, &mut at),
            false => vec![(form % 32) as i64; rows],
        };
        let numbers: Vec<String> = digits
            .iter()
            .zip(own)
            .map(|(digits, own)| {
                let most = form % 32;
                let all = format!("{:0width$}", digits.abs(), width = most + 1);
                let (whole, behind) = all.split_at(all.len() - most);
                let behind = match form / 32 {
                    1 => behind.trim_end_matches('0'),
                    _ => &behind[..own as usize],
                };
                let sign = if *digits < 0 { "-" } else { "" };
                let point = if behind.is_empty() { "" } else { "." };
                format!("{sign}{whole}{point}{behind}")
            })
            .collect();
        read.push(numbers.into_iter());
    }
    assert_eq!(at, chunk.len());
    for place in order {
        let mut slots = slots[place as usize].iter();
        for byte in templates[place as usize] {
            match byte {
                0 => {
                    let number = read[*slots.next().unwrap()].next().unwrap();
                    text.extend_from_slice(number.as_bytes());
                }
                byte => text.push(*byte),
            }
        }
    }
}

/// A sample posted on `ac-trunnion` (or so) with a report, in a folder of its own.
fn posted(file: &str, machine: &str, more: &[&str]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let cl = sample_file(file).display().to_string();
    let job = [
        &cl,
        "-m",
        machine,
        "--tool-length",
        "100",
        "-q",
        "-o",
        "part.nc",
        "--report",
        "part.html",
    ];
    let done = post_in(folder.path(), &[&job, more].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let page = folder.path().join("part.html");
    (folder, page)
}

#[test]
fn texts_come_back_letter_for_letter() {
    for (file, machine) in [
        ("blade.cls", "ac-trunnion"),
        ("s-piece.cls", "ac-trunnion"),
        ("flange.ncl", "vmc"),
        ("wedge.ncl", "dmu50"),
    ] {
        let (folder, page) = posted(file, machine, &[]);
        let page = Page::read(&page);
        assert_eq!(page.text("nc"), fs::read(folder.path().join("part.nc")).unwrap(), "{file}");
        assert_eq!(page.text("cl"), fs::read(sample_file(file)).unwrap(), "{file}");
    }
}

#[test]
fn rows_are_the_blocks_of_the_program() {
    let (folder, page) = posted("blade.cls", "ac-trunnion", &["--summary", "s.json"]);
    let page = Page::read(&page);
    let summary = fs::read_to_string(folder.path().join("s.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let rows = page.table("blocks")["rows"].as_u64().unwrap();
    assert_eq!(rows, summary["blocks"].as_u64().unwrap());
    // The words of each block stand on the line that its row names.
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    let lines: Vec<&str> = program.lines().collect();
    let [nc, a, c] = ["nc", "q.A", "q.C"].map(|name| page.column("blocks", name));
    for (values, letter) in [(a, 'A'), (c, 'C')] {
        let mut shown = 0;
        for (line, value) in nc.iter().zip(values) {
            let line = lines[*line as usize - 1];
            if let Some(word) = line.split(' ').find(|word| word.starts_with(letter)) {
                let printed: f64 = word[1..].parse().unwrap();
                assert!((printed - value).abs() < 1e-5, "{line}: {value}");
                shown += 1;
            }
        }
        assert!(shown > 100, "{letter}: {shown}");
    }
    // The worst block is that of the summary.
    let tip = &page.meta["maxima"][0];
    assert_eq!(tip["nc"], summary["tip_deviation_mm"]["block"]);
    let row = tip["row"].as_u64().unwrap() as usize;
    assert_eq!(nc[row] as u64, tip["nc"].as_u64().unwrap());
    let deviation = page.column("blocks", "deviation");
    let largest = deviation.iter().copied().fold(0.0, f64::max);
    assert_eq!(deviation[row], largest);
    assert!(largest >= tip["value"].as_f64().unwrap() - 1e-6);
    // Poses with all their digits: axis values as they are packed.
    let checks = page.meta["checks"].as_array().unwrap();
    assert!(checks.len() > 5);
    for check in checks {
        let row = check["row"].as_u64().unwrap() as usize;
        let axes = page.meta["machine"]["axes"].as_array().unwrap();
        for (axis, value) in axes.iter().zip(check["joints"].as_array().unwrap()) {
            let name = format!("q.{}", axis["name"].as_str().unwrap());
            // Where the control keeps the tip, the linear axes are told against it.
            if page.is_derived("blocks", &name) {
                continue;
            }
            let packed = page.column("blocks", &name)[row];
            assert!((packed - value.as_f64().unwrap()).abs() < 6e-5, "{name} of {row}");
        }
    }
}

#[test]
fn the_same_job_gives_the_same_bytes_wherever_it_lies() {
    let first = posted("blade.cls", "ac-trunnion", &[]);
    let second = posted("blade.cls", "ac-trunnion", &[]);
    let [first, second] = [first, second].map(|(_folder, page)| fs::read(page).unwrap());
    assert!(first == second);
    let text = String::from_utf8(first).unwrap();
    assert!(!text.contains(env!("CARGO_MANIFEST_DIR")));
}

#[test]
fn hostile_texts_stay_texts() {
    let hostile = "</script><img src=x onerror=alert(1)>";
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(sample_file("blade.cls")).unwrap();
    let text = format!("PPRINT/{hostile}\n{text}");
    let file = folder.path().join("part.cls");
    fs::write(&file, &text).unwrap();
    let job =
        ["part.cls", "-m", "ac-trunnion", "--tool-length", "100", "-q", "--report", "part.html"];
    let done = post_in(folder.path(), &job);
    assert_eq!(done.code, 0, "{}", done.err);
    let page = Page::read(&folder.path().join("part.html"));
    assert_eq!(page.text("cl"), text.as_bytes());
    assert!(!page.html.contains("onerror=alert"));
    let count = |what: &str| page.html.matches(what).count();
    assert_eq!(count("<script type") + count("<script>"), count("</script>"));
    assert_contains(&page.html, &["default-src 'none'; script-src 'sha256-"]);
}

#[test]
fn texts_go_first_above_the_largest_size() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = Vec::new();
    generate::write_file(&mut text, 350_000).unwrap();
    fs::write(folder.path().join("wave.cls"), text).unwrap();
    let job = ["wave.cls", "-m", "ac-trunnion", "--tcp", "control", "-q", "--report", "wave.html"];
    let whole = post_in(folder.path(), &job);
    assert_eq!(whole.code, 0, "{}", whole.err);
    let page = folder.path().join("wave.html");
    let all = Page::read(&page);
    assert_eq!(all.meta["parts_left_out"], serde_json::json!([]));
    let size = fs::metadata(&page).unwrap().len();
    assert!(size > 1_000_000, "{size}");
    let done = post_in(folder.path(), &[&job[..], &["--report-max", "1"]].concat());
    assert_eq!(done.code, 0, "{}", done.err);
    let less = Page::read(&page);
    assert_eq!(less.meta["parts_left_out"][0], "texts");
    assert!(less.html.len() < all.html.len());
    assert!(
        less.html.len() < 1_000_000 || less.meta["parts_left_out"].as_array().unwrap().len() == 3
    );
    assert!(!less.parts.contains_key("text.cl"));
    assert_eq!(
        less.meta["tables"].as_array().unwrap().last(),
        all.meta["tables"].as_array().unwrap().last()
    );
}

#[test]
fn every_job_has_its_report() {
    let (folder, _) = posted("blade.cls", "ac-trunnion", &[]);
    let cl = sample_file("blade.cls").display().to_string();
    let nc = folder.path().join("part.nc");
    let other = fs::read_to_string(&nc).unwrap().replacen("X1", "X2", 1);
    fs::write(folder.path().join("other.nc"), other).unwrap();
    let length = ["--tool-length", "100"];
    let ours = ["-m", "ac-trunnion"];
    for (job, arguments, code, kind, series) in [
        ("verify", vec!["part.nc", "--against", &cl, "-q"], 0, "good", false),
        ("verify", vec!["other.nc", "--against", &cl, "-q"], 1, "bad", false),
        ("predict", vec!["part.nc", "--against", &cl, "-q"], 0, "", true),
        ("diff", vec!["part.nc", "other.nc"], 1, "warn", false),
    ] {
        let more = [&length[..], &ours[..], &["--report", "r.html"]].concat();
        let line = [&[job], &arguments[..], &more[..]].concat();
        let done = post_in(folder.path(), &line);
        assert_eq!(done.code, code, "{line:?}: {}", done.err);
        let page = Page::read(&folder.path().join("r.html"));
        fs::remove_file(folder.path().join("r.html")).unwrap();
        assert_eq!(page.meta["job"], job);
        if !kind.is_empty() {
            assert_eq!(page.meta["verdict"]["kind"], kind, "{line:?}");
        }
        assert_eq!(page.parts.contains_key("series"), series, "{job}");
        let shown = folder.path().join(if job == "diff" { arguments[1] } else { arguments[0] });
        assert_eq!(page.text("nc"), fs::read(shown).unwrap());
        // A row of each motion, whose times go on.
        let ends = page.column("blocks", "t1");
        assert!(ends.len() > 200 && ends.is_sorted(), "{job}");
        assert!(page.column("cl", "line").len() > 50);
        if job == "verify" && code == 0 {
            let tip = &page.meta["maxima"][0];
            let row = tip["row"].as_u64().unwrap() as usize;
            assert_eq!(page.column("blocks", "nc")[row] as u64, tip["nc"].as_u64().unwrap());
            let worst = page.column("blocks", "deviation")[row];
            assert!((worst - tip["value"].as_f64().unwrap()).abs() < 1e-4);
        }
        if job == "predict" {
            let largest = |table: &str| {
                let column = page.column(table, "contour");
                column.into_iter().fold(0.0, f64::max)
            };
            assert_eq!(largest("blocks"), largest("series"));
            let told = page.meta["maxima"][0]["value"].as_f64().unwrap();
            assert!((largest("series") - told).abs() < 1e-4);
        }
    }
    let convert = [
        "convert",
        "part.nc",
        "--from",
        "ac-trunnion",
        "--tool-length",
        "100",
        "--to",
        "dmu50",
        "-o",
        "c.h",
        "-q",
        "--report",
        "c.html",
    ];
    let done = post_in(folder.path(), &convert);
    assert_eq!(done.code, 0, "{}", done.err);
    let page = Page::read(&folder.path().join("c.html"));
    assert_eq!(page.meta["job"], "convert");
    assert_eq!(page.text("nc"), fs::read(folder.path().join("c.h")).unwrap());
}

#[test]
fn nothing_is_written_of_a_refused_run_and_no_file_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let cl = sample_file("blade.cls").display().to_string();
    let refused = post_in(
        folder.path(),
        &[
            &cl,
            "-m",
            "ac-trunnion",
            "--tool-length",
            "2000",
            "-q",
            "-o",
            "p.nc",
            "--report",
            "p.html",
        ],
    );
    assert_eq!(refused.code, 1);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    let over = post_in(
        folder.path(),
        &[&cl, "-m", "ac-trunnion", "--tool-length", "100", "-q", "-o", "p.nc", "--report", &cl],
    );
    assert_eq!(over.code, 1);
    assert_contains(&over.err, &["name another file with --report"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    let alone = post(&[&cl, "-m", "ac-trunnion", "--report-max", "3"]);
    assert_eq!(alone.code, 2);
}

#[test]
fn view_names_a_report_of_any_job() {
    let folder = tempfile::tempdir().unwrap();
    let cl = sample_file("blade.cls").display().to_string();
    let viewed = |line: &[&str]| {
        let mut command = command();
        let job = ["view", "--no-open"];
        command.args([&job, line].concat());
        command.env("TMPDIR", folder.path()).current_dir(folder.path());
        run(&mut command, b"")
    };
    let done = viewed(&[&cl, "-m", "ac-trunnion", "--tool-length", "100", "-q"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let page = done.err.trim();
    assert!(page.ends_with("report.html"), "{page}");
    assert_eq!(Page::read(Path::new(page)).meta["job"], "post");
    let refused = viewed(&[&cl, "-m", "ac-trunnion", "--tool-length", "2000", "-q"]);
    assert_eq!(refused.code, 1);
    assert!(!refused.err.contains("report.html"), "{}", refused.err);
}

/// Names of the columns of a table.
fn names(page: &Page, table: &str) -> BTreeSet<String> {
    let columns = page.table(table)["columns"].as_array().unwrap().iter();
    columns.map(|column| column["name"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn what_is_predicted_stands_beside_the_blocks() {
    let (folder, page) = posted("blade.cls", "ac-trunnion", &["--predict=s.json"]);
    let made = Page::read(&page);
    let cl = sample_file("blade.cls").display().to_string();
    let job = [
        "predict",
        "part.nc",
        "--against",
        &cl,
        "-q",
        "-m",
        "ac-trunnion",
        "--tool-length",
        "100",
        "--report",
        "p.html",
    ];
    let done = post_in(folder.path(), &job);
    assert_eq!(done.code, 0, "{}", done.err);
    let alone = Page::read(&folder.path().join("p.html"));
    let told = names(&made, "predicted");
    assert!(told.contains("contour") && told.contains("v.C") && told.contains("a.X"));
    assert!(told.is_subset(&names(&alone, "blocks")), "{told:?}");
    let rows = |page: &Page, table: &str| page.table(table)["rows"].as_u64().unwrap();
    assert_eq!(rows(&made, "predicted"), rows(&made, "blocks"));
    // Line by line it is the same; approach and retract are no blocks of the path.
    let [here, there] = [&made, &alone].map(|page| page.column("blocks", "nc"));
    for name in told.iter().filter(|name| !name.starts_with('t')) {
        let known: BTreeMap<u64, f64> =
            there.iter().map(|line| *line as u64).zip(alone.column("blocks", name)).collect();
        let mut seen = 0;
        for (line, value) in here.iter().zip(made.column("predicted", name)) {
            if let Some(known) = known.get(&(*line as u64)).filter(|_| value > 0.0) {
                assert!((known - value).abs() < 1e-9, "{name} line {line}: {value} {known}");
                seen += 1;
            }
        }
        assert!(seen > 100, "{name}: {seen}");
    }
    let ends = made.column("predicted", "t1");
    assert!(ends.is_sorted());
    let summary = fs::read_to_string(folder.path().join("s.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let cycle = summary["time"]["cycle_s"].as_f64().unwrap();
    let last = *ends.last().unwrap();
    assert!(last <= cycle + 0.1 && last > 0.8 * cycle, "{last} of {cycle}");
}

#[test]
fn changes_of_the_solution_are_events() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::from(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,-40,80,0,-0.19866933,0.98006658\nFEDRAT/500,MMPM\n",
    );
    // Through the pole and on: the tool leans to the one side, and then to the other.
    for step in -20..=20 {
        let angle = 0.01 * f64::from(step);
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        text.push_str(&format!("GOTO/0,{},30,0,{sine:.8},{cosine:.8}\n", 2 * step));
    }
    text.push_str("FINI\n");
    fs::write(folder.path().join("pole.cls"), text).unwrap();
    let job = [
        "pole.cls",
        "-m",
        "ac-trunnion",
        "--tool-length",
        "100",
        "-q",
        "-o",
        "pole.nc",
        "--report",
        "pole.html",
    ];
    let done = post_in(folder.path(), &job);
    assert_eq!(done.code, 0, "{}", done.err);
    let page = Page::read(&folder.path().join("pole.html"));
    let a = page.column("blocks", "q.A");
    let sides = |row: usize| a[row].signum() * f64::from(u8::from(a[row] != 0.0));
    let mut asked = Vec::new();
    let mut side = 0.0;
    for row in 0..a.len() {
        if sides(row) != 0.0 && side != 0.0 && sides(row) != side {
            asked.push(row as u64);
        }
        if sides(row) != 0.0 {
            side = sides(row);
        }
    }
    let events = page.meta["events"].as_array().unwrap().iter();
    let told: Vec<u64> = events
        .filter(|event| event["kind"] == "branch")
        .map(|event| event["row"].as_u64().unwrap())
        .collect();
    assert!(!asked.is_empty(), "the pole is not passed: {a:?}");
    assert_eq!(told, asked);
}
