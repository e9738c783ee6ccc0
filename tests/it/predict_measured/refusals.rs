//! What is no log, or none of this program: by file, line, value and remedy.

use super::*;
use crate::common::assert_contains;

const HEAD: &str = "time,X,Y,X_act,Y_act\n";

/// Rows of a path of its own, with one line replaced.
fn with(place: usize, line: &str) -> String {
    let mut text = HEAD.to_owned();
    for row in 0..40 {
        let x = 0.1 * f64::from(row);
        text += &match usize::try_from(row) == Ok(place) {
            true => format!("{line}\n"),
            false => format!("{:.3},{x:.3},0.5,{x:.3},0.5\n", 0.001 * f64::from(row)),
        };
    }
    text
}

/// Refused, and nothing is written.
#[track_caller]
fn refused(log: &str, more: &[&str], said: &[&str]) {
    let shop = Shop::new(MILL, log);
    let run = shop.run(more);
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    assert_contains(&run.err, said);
    assert_contains(&run.err, &["help:", "nothing was written"]);
    assert!(!shop.path("found.json").exists());
}

#[test]
fn a_row_that_is_none_is_named_by_its_line_and_column() {
    let cases: [(&str, &[&str]); 8] = [
        (
            "0.004,nan,0.5,1,0.5",
            &[
                "log.csv:6:7",
                "`nan` in column 2 (X commanded) is no finite number",
                "leave such rows out",
            ],
        ),
        (
            "0.004,0.4,0.5,inf,0.5",
            &["log.csv:6:15", "`inf` in column 4 (X actual) is no finite number"],
        ),
        (
            "0.004,0.4,here,0.4,0.5",
            &["log.csv:6:11", "`here` in column 3 (Y commanded) is no number"],
        ),
        ("0.004,0.4,,0.4,0.5", &["log.csv:6", "column 3 (Y commanded) is empty"]),
        (
            "0.004,0.4,0.5,0.4",
            &[
                "log.csv:6",
                "the row has 4 columns, the first row (line 2) has 5",
                "written to its end",
            ],
        ),
        (
            "0.004,0.4,0.5,0.4,0.5,7",
            &["log.csv:6", "the row has 6 columns, the first row (line 2) has 5"],
        ),
        (
            "0.003,0.4,0.5,0.4,0.5",
            &["log.csv:6", "the time does not increase: 0.003 s behind 0.003 s"],
        ),
        (
            "0.001,0.4,0.5,0.4,0.5",
            &[
                "log.csv:6",
                "the time does not increase: 0.001 s behind 0.003 s",
                "second recording",
            ],
        ),
    ];
    for (line, said) in cases {
        refused(&with(4, line), &[], said);
    }
    // The first row too: it is not taken for a line of the head.
    refused(&with(0, "0,nan,nan,nan,nan"), &[], &["log.csv:2", "`nan` in column 2"]);
    // What stands below the last row is no remark.
    refused(&(with(99, "") + "end of recording\n"), &[], &["log.csv:42", "the row has 1 columns"]);
}

#[test]
fn a_gap_an_empty_log_and_what_is_no_table() {
    let late = with(99, "").replace("\n0.02", "\n0.12").replace("\n0.03", "\n0.13");
    refused(
        &late,
        &[],
        &[
            "log.csv:22",
            "a gap in the log: 0.12 s behind 0.019 s in line 21, 101 times the usual 0.001",
            "part before it or behind it",
        ],
    );
    refused("", &[], &["log.csv", "the log is empty: there is no row of numbers"]);
    refused(HEAD, &[], &["the log is empty"]);
    let short: String = with(99, "").lines().take(6).map(|line| line.to_owned() + "\n").collect();
    refused(&short, &[], &["the log has 5 rows, at least 8 are needed"]);
    refused("\u{1f}\u{8b}\u{0}\u{0}", &[], &["log.csv:1", "this is no text", "unpacked"]);
    let words = "a word and another\n".repeat(200);
    refused(&words, &[], &["log.csv:101", "there is no row of numbers in the first 100 lines"]);
}

#[test]
fn columns_and_units_that_are_not_there() {
    let log = with(99, "");
    let cases: [(&str, &[&str]); 6] = [
        (
            "t=time,B=X",
            &[
                "log.csv:1",
                "`B` is neither the time nor an axis of the machine, which has C, X, Y, Z",
            ],
        ),
        (
            "t=time,X=speed",
            &[
                "log.csv:1",
                "the log has no column `speed`; it has 5",
                "the log has time, X, Y, X_act, Y_act",
            ],
        ),
        ("t=time,X=9", &["the log has no column `9`"]),
        ("t=time,X=2,X=4", &["two columns of the log, X and X_act, hold X commanded"]),
        ("X=2,X'=4", &["no column of the log is known to hold the time", "--log-period SECONDS"]),
        ("t=1", &["no column of the log is known to hold an axis of the machine"]),
    ];
    for (columns, said) in cases {
        refused(&log, &["--columns", columns], said);
    }
    refused(
        &log,
        &["--columns", "t=1,X=2", "--log-period", "0.001"],
        &["--columns names the time, and --log-period", "keep one of both"],
    );
    refused(
        &log.replacen("X,Y,X_act", "q1,q2,q3", 1).replacen("Y_act", "q4", 1),
        &[],
        &["no column of the log is known to hold an axis", "the log has time, q1, q2, q3, q4"],
    );
    refused(
        &log.replacen("X_act", "X", 1),
        &["--columns", "t=time,X=X"],
        &["columns 2 and 4 are both called X; name it by its number"],
    );
    refused(
        &log.replacen(HEAD, "", 1),
        &[],
        &["log.csv:1", "the columns of the log have no names"],
    );
    refused(
        &log.replacen(HEAD, "time,X,Y,X_act\n", 1),
        &[],
        &["line 1 names 4 columns, the rows have 5"],
    );
    refused(
        &log.replacen("X,", "X [counts],", 1),
        &[],
        &[
            "log.csv:1",
            "column X [counts] holds X commanded, and `counts` is not a unit of length",
            "--log-units",
        ],
    );
    refused(
        &log.replacen("time,", "time [deg],", 1),
        &[],
        &["`deg` is not a unit of time (s, ms, us)"],
    );
    refused(&log, &["--log-zeros", "B=1"], &["--log-zeros: the machine has no axis B"]);
}

#[test]
fn a_command_line_that_is_none() {
    let shop = Shop::new(MILL, &with(99, ""));
    for (flag, value, said) in [
        ("--columns", "time", "`time` is not of the form CONTENT=COLUMN"),
        ("--log-units", "ms,s", "`s` is a second unit of its kind"),
        ("--log-units", "furlong", "`furlong` is no unit of a log"),
        ("--log-zeros", "X", "`X` is not of the form AXIS=VALUE"),
    ] {
        let run = shop.run(&[flag, value]);
        assert_eq!(run.code, 2, "{}", run.err);
        assert_contains(&run.err, &[said]);
    }
}

#[test]
fn a_log_of_another_program_is_not_laid_over() {
    // A spiral.
    let mut log = HEAD.to_owned();
    for row in 0..6000 {
        let time = 0.002 * f64::from(row);
        let [x, y] = [libm::cos(9.0 * time), libm::sin(9.0 * time)].map(|part| 4.0 * time * part);
        log += &format!("{time:.4},{x:.5},{y:.5},{x:.5},{y:.5}\n");
    }
    refused(
        &log,
        &[],
        &[
            "the log does not look like this program: at best they are alike by 0.",
            "(1 is the same), X ",
            "of the rows are elsewhere",
            "--tool-length, --mount",
        ],
    );
    // Nothing that moves.
    let still = with(99, "").replace(",0.5", ",0.50");
    let still: String = still
        .lines()
        .map(|line| {
            let mut fields: Vec<&str> = line.split(',').collect();
            if fields[0] != "time" {
                fields[1] = "1.0";
                fields[3] = "1.0";
            }
            fields.join(",") + "\n"
        })
        .collect();
    refused(&still, &[], &["no axis moves both in the program and in the log"]);
}

#[test]
fn what_may_be_wrong_is_named() {
    let (_, inches) = recorded(|recorder| recorder.units[1] = 1.0 / 25.4);
    refused(&inches, &[], &["as if the log counted in inch: --log-units inch"]);
    let (_, radians) = recorded(|recorder| {
        recorder.units[2] = 1f64.to_radians();
        recorder.axes = vec![3];
        recorder.head = "time,C,C_act\n".to_owned();
    });
    refused(&radians, &[], &["as if the log counted in rad: --log-units rad"]);
    let (_, log) = recorded(|_| {});
    let other_way: String = log
        .lines()
        .map(|line| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            for place in [4, 8] {
                if let Ok(value) = fields[place].parse::<f64>() {
                    fields[place] = format!("{:.7}", -value);
                }
            }
            fields.join(",") + "\n"
        })
        .collect();
    refused(
        &other_way,
        &[],
        &[
            "alike by 0.50 (1 is the same), C -1.00, X 1.00",
            "the log counts C the other way: `reversed` of [axis.C]",
        ],
    );
}

#[test]
fn a_log_is_not_written_over_and_standard_input_is_one_file() {
    let (_, log) = recorded(|recorder| recorder.period = 0.01);
    let shop = Shop::new(MILL, &log);
    let run = shop.run(&["--csv", "log.csv"]);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["the log", "log.csv", "--csv"]);
    assert_eq!(fs::read_to_string(shop.path("log.csv")).unwrap(), log);
    let arguments = ["predict", "-", "-m", "mill.toml", "--measured", "-"];
    let run = post_in(shop.0.path(), &arguments);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["the log and another input cannot both be standard input"]);
}
