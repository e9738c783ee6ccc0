//! Logs of all forms, and what is left between them and the prediction.

use std::path::Path;

use super::*;
use crate::common::{assert_contains, command, root, run};

/// What the closed forms and Runge and Kutta leave of the code under test, mm and degrees.
const EXACT: f64 = 4e-4;

/// Axes at the same time, and following errors, as measured and as predicted.
#[track_caller]
fn agrees(found: &Value, axes: &[&str], within: f64) {
    for name in axes {
        let axis = axis(found, name);
        for which in ["commanded", "actual", "following"] {
            if let Some(left) = axis[which].as_object() {
                let most = number(&left["most"]).abs();
                assert!(most <= within, "{name} {which}: {most}\n{axis}");
            }
        }
    }
    let contour = &found["measured"]["contour"];
    let most = number(&contour["difference"]["most"]).abs();
    assert!(most <= 1.5 * within, "{contour}");
    assert!(number(&contour["measured"]["most"]) > 0.3, "{contour}");
}

#[test]
fn a_log_of_another_simulation_is_what_is_predicted() {
    let (_, log) = recorded(|_| {});
    let shop = Shop::new(MILL, &log);
    let (run, found) = shop.found(&[]);
    assert!(run.err.is_empty() || !run.err.contains("[log]"), "{}", run.err);
    let measured = &found["measured"];
    close(&measured["shift_s"], 3.21, 2e-6);
    assert!(measured["rival_shift_s"].is_null(), "{measured}");
    close(&measured["far_off"], 0.0, 0.001);
    agrees(&found, &["X", "Y", "Z", "C"], EXACT);
    // In a cut at 6000 mm/min X lags by (1 - 0.5)·v/Kv, and not by nothing.
    let lag = number(&axis(&found, "X")["following_measured"]["most"]).abs();
    assert!((lag - 0.5 * 100.0 / 40.0).abs() < 0.02, "{lag}");
    close(&axis(&found, "Z")["zero"], 500.0, 1e-6);
    assert_contains(
        &run.out,
        &[
            "columns        time = time (s), X = X commanded (mm)",
            "C_act = C actual (deg)",
            "the program begins at 3.2100",
            "taken off      Z 500.0000 mm, by which the log counts more (--log-zeros)",
            "following error",
            "contour error",
        ],
    );
}

#[test]
fn semicolons_decimal_commas_other_names_and_units() {
    let (recorder, log) = recorded(|recorder| {
        recorder.separator = ";";
        recorder.decimal = ",";
        recorder.period = 0.004;
        recorder.noise = 2e-4;
        recorder.shift = 103.21;
        recorder.units = [1e3, 1e3, 1f64.to_radians()];
        recorder.head = "Aufzeichnung 7;;;;;;;;\n\
            Zeit [ms];Soll X [µm];Soll Y [µm];Soll Z [µm];Soll C [rad];Ist X [µm];Ist Y [µm];Ist Z [µm];Ist C [rad]\n"
            .to_owned();
    });
    let shop = Shop::new(MILL, &log);
    let columns = "t=Zeit,X=Soll X,Y=soll y,Z=Soll Z [µm],C=5,X'=Ist X,Y'=Ist Y,Z'=8,C'=Ist C";
    let (run, found) = shop.found(&["--columns", columns]);
    close(&found["measured"]["shift_s"], recorder.shift, 2e-5);
    agrees(&found, &["X", "Y", "Z", "C"], 0.004);
    for name in ["X", "Y", "Z", "C"] {
        close(&axis(&found, name)["actual"]["rms"], recorder.noise, 1e-4);
    }
    assert_contains(&run.out, &["Soll C [rad] = C commanded (rad)", "Zeit [ms] = time (ms)"]);
}

#[test]
fn no_names_blanks_late_rows_and_missing_ones() {
    let (recorder, log) = recorded(|recorder| {
        recorder.separator = "  ";
        recorder.head = "# recorder 2.1, started by hand\n\n".to_owned();
        recorder.axes = vec![0, 1, 3];
        recorder.period = 0.0025;
        recorder.jitter = 3e-4;
        recorder.missing = 20;
        recorder.noise = 2e-4;
        recorder.shift = -7.5;
    });
    let shop = Shop::new(MILL, &log);
    let columns = "t=1,X=2,Y=3,C=4,X'=5,Y'=6,C'=7";
    let (run, found) = shop.found(&["--columns", columns]);
    let measured = &found["measured"];
    close(&measured["period_s"], 0.0025, 1e-6);
    close(&measured["shift_s"], recorder.shift, 2e-5);
    close(&measured["jitter_s"], 3e-4 / 3f64.sqrt(), 2e-5);
    let missing = number(&measured["missing_rows"]);
    assert!((60.0..160.0).contains(&missing), "{missing}");
    agrees(&found, &["X", "Y", "C"], 0.006);
    assert_contains(&run.out, &["rows, interpolated", "beside even distances by 0.17"]);
}

#[test]
fn only_actual_positions_of_a_part_of_the_program() {
    let (recorder, log) = recorded(|recorder| {
        recorder.separator = "\t";
        recorder.head = "t_s\tX_actual\tY_fb\tfeedback C\tZ'\n".to_owned();
        recorder.axes = vec![0, 1, 3, 2];
        recorder.commanded = false;
        recorder.window = [2.0, 11.5];
        recorder.period = 0.002;
        recorder.noise = 1e-4;
    });
    let shop = Shop::new(MILL, &log);
    let (_, found) = shop.found(&[]);
    close(&found["measured"]["shift_s"], recorder.shift, 1e-5);
    agrees(&found, &["X", "Y", "Z", "C"], 0.001);
    assert!(axis(&found, "X")["commanded"].is_null());
}

#[test]
fn a_longer_log_in_other_units_from_other_zeros_with_more_columns() {
    let (recorder, log) = recorded(|recorder| {
        recorder.window = [-6.0, 20.0];
        recorder.head =
            "time,X,Y,Z,C,X_act,Y_act,Z_act,C_act,load,state\nms,inch,inch,inch,deg,inch,inch,inch,deg,%,-\n"
                .to_owned();
        recorder.units = [1e3, 1.0 / 25.4, 1.0];
        recorder.zeros = [250.0, -3.125, -500.0, 90.0];
        recorder.tail = ",12.5,cutting";
        recorder.noise = 1e-3;
    });
    // A per cent is no unit of ours: the line is no line of units, and is told so.
    let shop = Shop::new(MILL, &log);
    let refused = shop.run(&[]);
    assert_eq!(refused.code, 1);
    let log = log.replacen(",%,-", ",,-", 1);
    let shop = Shop::new(MILL, &log);
    let (run, found) = shop.found(&[]);
    close(&found["measured"]["shift_s"], recorder.shift, 1e-5);
    agrees(&found, &["X", "Y", "Z", "C"], 0.006);
    for (name, zero) in [("X", 250.0), ("Y", -3.125), ("Z", 0.0), ("C", 90.0)] {
        close(&axis(&found, name)["zero"], zero, 1e-4);
    }
    assert_contains(
        &run.out,
        &[
            "not read       load, state",
            "taken off      X 250.0000 mm, Y -3.1250 mm, C 90.0000 deg",
        ],
    );
    // Zeros that are said are taken, and nothing is taken off where the log is said to count alike.
    let (_, found) = shop.found(&["--log-zeros", "X=250.5,Z=0"]);
    close(&axis(&found, "X")["zero"], 250.5, 0.0);
    close(&axis(&found, "X")["commanded"]["mean"], 0.5, 1e-3);
    close(&axis(&found, "Y")["zero"], -3.125, 1e-3);
    let (_, found) = shop.found(&["--log-zeros", "none"]);
    close(&axis(&found, "Y")["commanded"]["mean"], 3.125, 1e-3);
}

#[test]
fn an_approach_from_elsewhere_moves_neither_clock_nor_zeros() {
    // Without a start the machine comes from 480 mm above the part; the log begins where the program cuts.
    let machine = MILL.replace("[solution]\nstart = { Z = -480 }\n", "");
    let (recorder, log) = recorded(|recorder| recorder.period = 0.002);
    let shop = Shop::new(&machine, &log);
    let (run, found) = shop.found(&[]);
    // Rapid: 480 mm at 250 mm/s and 1200 mm/s².
    let approach = 480.0 / 250.0 + 250.0 / 1200.0;
    close(&found["measured"]["shift_s"], recorder.shift - approach, 1e-4);
    close(&axis(&found, "Z")["zero"], 500.0, 1e-3);
    agrees(&found, &["X", "Y", "C"], EXACT);
    assert_contains(
        &run.err,
        &["warning[log]: in ", "% of the rows an axis is far from where it is predicted"],
    );
}

#[test]
fn rows_of_one_period_without_times_and_rounded_times() {
    let (_, log) = recorded(|recorder| recorder.period = 0.0025);
    let without: String =
        log.lines().map(|line| line.split_once(',').unwrap().1.to_owned() + "\n").collect();
    let shop = Shop::new(MILL, &without);
    let (_, found) = shop.found(&["--log-period", "0.0025"]);
    close(&found["measured"]["shift_s"], super::plant::REST, 1e-5);
    agrees(&found, &["X", "Y", "Z", "C"], EXACT);
    // Milliseconds without decimals: every second row is half a millisecond late.
    let rounded: String = log
        .lines()
        .enumerate()
        .map(|(place, line)| {
            let (time, rest) = line.split_once(',').unwrap();
            let time = match time.parse::<f64>() {
                Ok(time) => format!("{time:.3}"),
                Err(_) => time.to_owned(),
            };
            assert!(place < 2 || time.len() < 8);
            format!("{time},{rest}\n")
        })
        .collect();
    let shop = Shop::new(MILL, &rounded);
    let (run, found) = shop.found(&[]);
    assert_eq!(found["measured"]["rounded_times"], true);
    close(&found["measured"]["shift_s"], 3.21, 6e-4);
    agrees(&found, &["X", "Y", "Z", "C"], EXACT);
    assert_contains(&run.out, &["rounded; rows are taken to lie at even distances"]);
}

#[test]
fn a_count_that_starts_again_after_a_turn_goes_on() {
    // C shows 0 to 360: its way from 40 back to -25 passes zero, and the noise makes it jump to and fro at rest.
    let (_, log) = recorded(|recorder| {
        recorder.noise = 1e-4;
        recorder.period = 0.002;
    });
    let wrapped: String = log
        .lines()
        .map(|line| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            for place in [4, 8] {
                if let Ok(value) = fields[place].parse::<f64>() {
                    fields[place] = format!("{:.8}", value.rem_euclid(360.0));
                }
            }
            fields.join(",") + "\n"
        })
        .collect();
    let shop = Shop::new(MILL, &wrapped);
    let (_, found) = shop.found(&[]);
    assert!(number(&found["measured"]["turns"]) > 100.0);
    agrees(&found, &["X", "Y", "Z", "C"], 0.001);
}

#[test]
fn the_picture_has_both_and_their_difference() {
    let (_, log) = recorded(|recorder| {
        recorder.noise = 1e-3;
        recorder.axes = vec![0, 1, 3];
        recorder.head = "time,X,Y,C,X_act,Y_act,C_act\n".to_owned();
    });
    let shop = Shop::new(MILL, &log);
    shop.found(&["--pictures", "seen", "-q"]);
    let picture = fs::read_to_string(shop.path("seen/measured.svg")).unwrap();
    assert_contains(
        &picture,
        &[
            "Measured and predicted: following errors of the axes, contour error in cuts",
            "part.nc on shop mill; log log.csv, a row every 1.000 ms",
            ">X, µm<",
            ">C, 0.001°<",
            ">contour, µm<",
            ">diff., µm<",
            ">measured<",
            ">predicted<",
            "predicted minus measured",
            "time from the beginning of the program, s",
        ],
    );
    assert!(!picture.contains(">Z, µm<") && !picture.contains("NaN"));
    assert!(picture.len() < 400_000, "{}", picture.len());
    // Drawn once more without a log, none stays behind.
    let again = post_in(
        shop.0.path(),
        &["predict", "part.nc", "-m", "mill.toml", "--pictures", "seen", "-q"],
    );
    assert_eq!(again.code, 0, "{}", again.err);
    assert!(!shop.path("seen/measured.svg").exists());
}

/// The joints of the real LinuxCNC, recorded every millisecond (`../shared/data/motion`): with its kinematics on, as it was
/// when the log was made, and off, as the program by itself leaves it.
#[test]
fn a_log_of_linuxcnc_lies_over_its_prediction() {
    let data = Path::new(root()).join("../shared/data/motion");
    let packed = data.join("linuxcnc_t1_xyzac_1ms.txt.gz");
    if !packed.exists() {
        assert!(std::env::var_os("CI").is_none(), "{} is missing", packed.display());
        eprintln!("skipped: {} is not there", packed.display());
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let log = run(std::process::Command::new("gzip").arg("-dc").arg(&packed), b"");
    fs::write(folder.path().join("t1.txt"), &log.out).unwrap();
    let program = fs::read_to_string(data.join("t1.ngc")).unwrap();
    fs::write(folder.path().join("off.ngc"), &program).unwrap();
    fs::write(folder.path().join("on.ngc"), format!("M428\n{program}")).unwrap();
    let limits = [
        ("X", 30000, 2000),
        ("Y", 30000, 2000),
        ("Z", 30000, 2000),
        ("A", 7200, 600),
        ("C", 7200, 600),
    ];
    let limits: Vec<String> = limits
        .iter()
        .flat_map(|(axis, feed, accel)| {
            [
                "--set".to_owned(),
                format!("axis.{axis}.max_feed={feed}"),
                "--set".to_owned(),
                format!("axis.{axis}.max_accel={accel}"),
            ]
        })
        .collect();
    let laid = |program: &str, more: &[&str]| {
        let mut command = command();
        command.current_dir(folder.path());
        command.args(["predict", program, "-m", "xyzac-trt", "--measured", "t1.txt"]);
        command.args(["--log-period", "0.001", "--columns", "X=1,Y=2,Z=3,A=4,C=5"]);
        command.args(["--summary", "found.json", "-q"]).args(&limits).args(more);
        let done = run(&mut command, b"");
        (done, folder.path().join("found.json"))
    };
    let (done, found) = laid("on.ngc", &["--tool-length", "50"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let found = read_json(&found);
    // The first row in which a joint has moved is 2.767 s behind the first.
    close(&found["measured"]["shift_s"], 2.766, 0.012);
    close(&axis(&found, "Z")["zero"], 0.0, 0.0);
    for name in ["X", "Y", "Z", "A", "C"] {
        let rms = number(&axis(&found, name)["commanded"]["rms"]);
        assert!(rms < 0.4, "{name}: {rms}");
    }
    // Without M428 the words are those of the joints, and Y goes another way altogether.
    let (done, _) = laid("off.ngc", &["--tool-length", "50"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_contains(
        &done.err,
        &["hardly look alike in some axes: Y -0.", "was tool centre point control on"],
    );
}

#[test]
fn what_rows_that_are_far_apart_leave_open_is_said() {
    let (_, log) = recorded(|recorder| recorder.period = 0.01);
    let shop = Shop::new(MILL, &log);
    let (run, found) = shop.found(&[]);
    assert_contains(
        &run.err,
        &[
            "rows of log.csv are 10.00 ms apart, set-points of the control 1.00 ms",
            "is beside them by up to about X 0.0",
        ],
    );
    // Acceleration jumps by up to 4000 mm/s² from block to block; a ramp of 25 ms is short between such rows, so that
    // what two jumps leave comes together: up to twice 0.035 of it times the square of the rows' distance.
    let told = number(&axis(&found, "X")["between_rows"]["most"]).abs();
    assert!((0.007..0.028).contains(&told), "{told}");
    // It is what is left, but for what the servo smooths.
    let left = number(&axis(&found, "X")["following"]["most"]).abs();
    assert!((0.05 * told..1.5 * told).contains(&left), "{left} {told}");
    // Between set-points nothing is open.
    let (_, log) = recorded(|_| {});
    let (_, found) = Shop::new(MILL, &log).found(&[]);
    assert!(axis(&found, "X")["between_rows"].is_null());
}
