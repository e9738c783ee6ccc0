//! Channels of a job: their waits are written and read again, meet or are refused, and how long each waits is worked out
//! here by going through the marks in the order in which they were drawn up.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use post_testkit::{Rng, randomised};

use crate::common::{assert_contains, post_in, read_json};
use crate::job_file::{good, refused};

/// A CL file: a cut of one second above each `SYNC`, and so many seconds of dwell.
struct Channel {
    /// Dwell before each mark, s, and the record of the mark.
    waits: Vec<(f64, String)>,
}

impl Channel {
    fn cl(&self) -> String {
        let mut text =
            "LOADTL/1\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,5\nFEDRAT/600,MMPM\n".to_owned();
        for (index, (dwell, record)) in self.waits.iter().enumerate() {
            let x = if index % 2 == 0 { 10 } else { 0 };
            writeln!(text, "GOTO/{x},0,5\nDELAY/{dwell:.2}\n{record}").unwrap();
        }
        text + "RAPID\nGOTO/0,0,50\nFINI\n"
    }
}

/// A folder with a job of these channels; each has a machine file of its own with these lines in `[wait]`.
fn shop(channels: &[Channel], wait: &str, dialect: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut job = "tool_length = 100\nverify = true\n".to_owned();
    for (index, channel) in channels.iter().enumerate() {
        let number = index + 1;
        let machine = format!(
            "extends = \"vmc\"\nname = \"channel {number}\"\n[control]\ndialect = \"{dialect}\"\n[wait]\n{wait}\n"
        );
        fs::write(folder.path().join(format!("m{number}.toml")), machine).unwrap();
        fs::write(folder.path().join(format!("c{number}.apt")), channel.cl()).unwrap();
        write!(
            job,
            "[[channel]]\nmachine = \"m{number}.toml\"\ncl = \"c{number}.apt\"\noutput = \"c{number}.nc\"\nsummary = \"c{number}.json\"\n"
        )
        .unwrap();
    }
    fs::write(folder.path().join("both.job.toml"), job).unwrap();
    folder
}

fn pair(first: &[&str], second: &[&str]) -> [Channel; 2] {
    [first, second].map(|records| Channel {
        waits: records.iter().map(|record| (1.0, (*record).to_owned())).collect(),
    })
}

#[test]
fn channels_that_wait_by_other_lines_never_meet() {
    let wait = "word = \"M{n+99}\"\nmarks = [1, 100]";
    let folder = shop(&pair(&["SYNC/1,1,2"], &["SYNC/1,2,1"]), wait, "fanuc");
    good(folder.path(), &["both.job.toml"]);
    let other = read(folder.path(), "m2.toml").replace("M{n+99}", "M{n+199}");
    fs::write(folder.path().join("m2.toml"), other).unwrap();
    for program in ["c1.nc", "c2.nc"] {
        fs::remove_file(folder.path().join(program)).unwrap();
    }
    let lines = "channels 1 and 2 wait by other lines, M{n+99} and M{n+199}";
    refused(folder.path(), &["both.job.toml"], &["error[wait]", lines]);
    assert!(!folder.path().join("c1.nc").exists());
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

fn none_is_written(folder: &Path) {
    for name in ["c1.nc", "c2.nc", "c1.json", "c2.json"] {
        assert!(!folder.join(name).exists(), "{name}");
    }
}

const PLAIN: &str = "word = \"M{n+99}\"\nmarks = [1, 100]";

#[test]
fn each_control_is_told_by_its_own_line_and_the_reader_knows_it() {
    let words = [
        ("fanuc", "M{n+99} P{digits}", ["M101 P12", "M101 P12"]),
        ("fanuc", "M{n+99} P{sum}", ["M101 P3", "M101 P3"]),
        ("fanuc", "!{others}L{n}", ["!2L2", "!1L2"]),
        ("siemens", "WAITM({n},{channels})", ["WAITM(2,1,2)", "WAITM(2,1,2)"]),
    ];
    for (dialect, word, lines) in words {
        let wait = format!("word = \"{word}\"\nmarks = [1, 9]");
        let folder = shop(&pair(&["SYNC/2,1,2,"], &["SYNC/2"]), &wait, dialect);
        let folder = folder.path();
        good(folder, &["both.job.toml", "-q"]);
        for (name, line) in ["c1.nc", "c2.nc"].into_iter().zip(lines) {
            let program = read(folder, name);
            let found = program.lines().filter(|text| text.ends_with(line)).count();
            assert_eq!(found, 1, "{line}\n{program}");
            // A program without its wait, or with another, is not what the CL file asks for.
            let other = [("M101", "M104"), ("L2", "L5"), ("(2,", "(5,")];
            let other =
                other.iter().fold(line.to_owned(), |line, (from, to)| line.replace(from, to));
            for (instead, says) in [("", "left out"), (&other, "in place of")] {
                fs::write(folder.join(name), program.replace(line, instead)).unwrap();
                let run = post_in(folder, &["verify", name, "-m", "both.job.toml"]);
                assert_eq!(run.code, 1, "{instead}\n{}{}", run.out, run.err);
                assert_contains(&run.err, &[says]);
            }
            fs::write(folder.join(name), &program).unwrap();
            good(folder, &["verify", name, "-m", "both.job.toml"]);
        }
    }
}

/// How long each channel waits at each of its marks, s.
fn worked_out(order: &[Vec<usize>], dwells: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut clock = vec![0.0; dwells.len()];
    let mut waited = vec![Vec::new(); dwells.len()];
    for those in order {
        for channel in those {
            let count = waited[*channel].len();
            // Each cut but the first, which goes there from its own start, takes a second.
            clock[*channel] += dwells[*channel][count] + 1.0;
        }
        let last = those.iter().map(|channel| clock[*channel]).fold(0.0, f64::max);
        for channel in those {
            waited[*channel].push(last - clock[*channel]);
            clock[*channel] = last;
        }
    }
    waited
}

/// Marks in the order in which the channels meet: those that wait at each, and how long each dwells before.
fn drawn(rng: &mut Rng) -> (Vec<Vec<usize>>, Vec<Vec<f64>>) {
    let count = 2 + rng.pick(3);
    let mut order = Vec::new();
    for _ in 0..3 + rng.pick(6) {
        let mut those: Vec<usize> = (0..count).filter(|_| rng.pick(2) == 0).collect();
        if those.len() < 2 {
            those = vec![0, 1 + rng.pick(count - 1)];
        }
        order.push(those);
    }
    let marks = |channel: usize| order.iter().filter(|those| those.contains(&channel)).count();
    let dwells = (0..count)
        .map(|channel| (0..marks(channel)).map(|_| rng.range(1.0, 60.0)).collect())
        .collect();
    (order, dwells)
}

fn records(order: &[Vec<usize>], dwells: &[Vec<f64>]) -> Vec<Channel> {
    let of = |channel: usize| {
        let marks = order.iter().enumerate().filter(|(_, those)| those.contains(&channel));
        let records = marks.map(|(mark, those)| {
            let others: Vec<String> = those
                .iter()
                .filter(|other| **other != channel)
                .map(|other| (other + 1).to_string())
                .collect();
            format!("SYNC/{},{},{}", mark + 1, channel + 1, others.join(","))
        });
        Channel { waits: dwells[channel].iter().copied().zip(records).collect() }
    };
    (0..dwells.len()).map(of).collect()
}

#[test]
fn channels_wait_as_long_as_the_last_of_them_takes() {
    let (rounds, mut rng) = randomised(6, 12);
    for round in rounds {
        let (order, dwells) = drawn(&mut rng);
        let channels = records(&order, &dwells);
        let folder = shop(&channels, PLAIN, "fanuc");
        let folder = folder.path();
        let run = good(folder, &["both.job.toml"]);
        assert_contains(&run.out, &[&format!("the channels meet {} times", order.len())]);
        for (channel, waited) in worked_out(&order, &dwells).iter().enumerate() {
            if waited.is_empty() {
                continue;
            }
            let told = read_json(&folder.join(format!("c{}.json", channel + 1)));
            let told = told["waits"].as_array().unwrap();
            assert_eq!(told.len(), waited.len(), "round {round}");
            let mut late = 0.0;
            for (told, waited) in told.iter().zip(waited) {
                let seconds = told["waits_s"].as_f64().unwrap();
                late += waited - seconds;
                assert!(late.abs() < 0.6, "round {round}, channel {channel}: {told} {waited}");
            }
        }
    }
}

#[test]
fn marks_that_cross_are_refused_and_nothing_is_written() {
    let (rounds, mut rng) = randomised(6, 12);
    for _ in rounds {
        let (mut order, mut dwells) = drawn(&mut rng);
        // Two marks of channels 1 and 2 at the end, which cross.
        order.extend([vec![0, 1], vec![0, 1]]);
        for channel in [0, 1] {
            dwells[channel].extend([1.0, 1.0]);
        }
        let mut channels = records(&order, &dwells);
        let last = channels[1].waits.len() - 1;
        channels[1].waits.swap(last, last - 1);
        let folder = shop(&channels, PLAIN, "fanuc");
        let marks = [order.len() - 1, order.len()];
        let says = marks.map(|mark| format!("waits at mark {mark} for"));
        let says: Vec<&str> = says.iter().map(String::as_str).collect();
        refused(folder.path(), &["both.job.toml"], &["error[wait]", "for ever", says[0], says[1]]);
        none_is_written(folder.path());
    }
}

/// Records of both channels, `[wait]`, and what is said.
type WrongWaits = ([&'static [&'static str]; 2], &'static str, &'static [&'static str]);

#[test]
fn a_wait_that_cannot_be_is_refused_by_its_line() {
    let cases: [WrongWaits; 8] = [
        (
            [&["SYNC/1"], &[]],
            PLAIN,
            &["waits at mark 1 for 2 (c1.apt line 8)", "channel 2 comes to its end"],
        ),
        (
            [&["SYNC/1,1,2"], &["SYNC/1,2,3"]],
            PLAIN,
            &["is for channel 3, and there are 2", "c2.apt:8"],
        ),
        (
            [&["SYNC/1,2,1"], &["SYNC/1,2,1"]],
            PLAIN,
            &["is that of channel 2, and this is channel 1"],
        ),
        ([&["SYNC/101"], &["SYNC/101"]], PLAIN, &["go from 1 to 100", "c1.apt:8"]),
        ([&["SYNC/1,1"], &["SYNC/1,2"]], PLAIN, &["no channel but its own"]),
        ([&["SYNC/1"], &["SYNC/1"]], "", &["no line at which a channel waits"]),
        ([&["CUTCOM/LEFT,1\nSYNC/1"], &["SYNC/1"]], PLAIN, &["inside cutter compensation"]),
        ([&["SYNC/1,1,1"], &["SYNC/1"]], PLAIN, &["each is named once"]),
    ];
    for ([first, second], wait, says) in cases {
        let folder = shop(&pair(first, second), wait, "fanuc");
        refused(folder.path(), &["both.job.toml"], says);
        none_is_written(folder.path());
    }
}

#[test]
fn what_is_shared_is_in_one_program_alone() {
    let marks = pair(&["SYNC/1"], &["SYNC/1"]);
    for (more, says) in
        [("shared = [\"X\"]", "both have X"), ("shared_spindle = true", "both have the spindle")]
    {
        let folder = shop(&marks, &format!("{PLAIN}\n{more}"), "fanuc");
        refused(
            folder.path(),
            &["both.job.toml"],
            &["error[channel-shared]", "channels 1 and 2", says],
        );
        none_is_written(folder.path());
    }
    // One machine file is one machine: its axes are those of both.
    let folder = shop(&marks, PLAIN, "fanuc");
    let folder = folder.path();
    let job = read(folder, "both.job.toml").replace("m2.toml", "m1.toml");
    fs::write(folder.join("same.job.toml"), job).unwrap();
    refused(folder, &["same.job.toml"], &["both have X", "both have Z"]);
    none_is_written(folder);
    // Made one by one, nobody would look at their marks.
    refused(folder, &["batch", "both.job.toml", "-o", "all.csv"], &["made together"]);
    let one = read(folder, "both.job.toml");
    let one = one.rsplit_once("[[channel]]").unwrap().0;
    fs::write(folder.join("one.job.toml"), one).unwrap();
    refused(folder, &["one.job.toml"], &["1 channels: from 2 to 4"]);
}

#[test]
fn predicted_times_join_the_channels_where_they_are_asked_for() {
    let channels = [(5.0, "SYNC/1"), (25.0, "SYNC/1")]
        .map(|(dwell, record)| Channel { waits: vec![(dwell, record.to_owned())] });
    let folder = shop(&channels, PLAIN, "fanuc");
    let folder = folder.path();
    let run = good(folder, &["both.job.toml", "--predict"]);
    assert_contains(&run.out, &["together", "predicted; the channels meet once"]);
    let waits = ["c1.json", "c2.json"].map(|name| {
        let told = read_json(&folder.join(name));
        assert_eq!(told["prediction"]["time"]["channel_waits_s"].as_array().unwrap().len(), 1);
        told["waits"][0]["waits_s"].as_f64().unwrap()
    });
    assert!((waits[0] - 20.0).abs() < 1e-6 && waits[1] == 0.0, "{waits:?}");
}

/// Of three channels two may wait for one another: a line that names the third is another wait.
#[test]
fn the_reader_knows_who_waits() {
    let [first, second] = pair(&["SYNC/1,1,2"], &["SYNC/1,2,1"]);
    let third = Channel { waits: Vec::new() };
    let folder =
        shop(&[first, second, third], "word = \"M{n+99} P{digits}\"\nmarks = [1, 9]", "fanuc");
    let folder = folder.path();
    good(folder, &["both.job.toml", "-q"]);
    let program = read(folder, "c1.nc");
    assert!(program.contains("M100 P12\n"), "{program}");
    for other in ["M100 P13", "M100 P123"] {
        fs::write(folder.join("c1.nc"), program.replace("M100 P12", other)).unwrap();
        let says = [
            "mark 1 of channels 1, ",
            "in place of a wait for other channels at mark 1 of channels 1, 2",
        ];
        refused(folder, &["verify", "c1.nc", "-m", "both.job.toml"], &says);
    }
}

#[test]
fn a_builder_sees_what_a_mark_becomes() {
    let folder = shop(&pair(&["SYNC/1"], &["SYNC/1"]), PLAIN, "fanuc");
    let run = good(folder.path(), &["check", "m1.toml"]);
    assert_contains(&run.out, &["SYNC/1 is M100, SYNC/100 is M199"]);
    let cases = [
        ("word = \"M{n}\"", "[wait] has no marks"),
        ("word = \"M100\"\nmarks = [1, 2]", "has {n}"),
        ("word = \"M{n}\"\nmarks = [9, 2]", "marks from 9 to 2"),
        ("word = \"M{n}\"\nmarks = [1, 199]", "M1 is no wait"),
        ("word = \"M{n}\"\nmarks = [1, 5]\nshared = [\"Q\"]", "shared has Q"),
        ("word = \"M{n}\"\nmarks = [1, 5]\nchannel = 3\nchannels = 2", "channel 3 of 2 channels"),
        ("word = \"M{n\"\nmarks = [1, 5]", "`}` is missing"),
    ];
    for (wait, says) in cases {
        let folder = shop(&pair(&["SYNC/1"], &["SYNC/1"]), wait, "fanuc");
        refused(folder.path(), &["check", "m1.toml"], &["error[machine-wait]", says]);
    }
}
