//! `post predict` on programs whose times, following errors and contour errors are worked out by hand, or from the closed
//! form of the servo.

use std::fmt::Write as _;
use std::fs;

use post_testkit::shared;
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Run, assert_contains, post, post_in, read_json, with_file};

/// The PID servos of Chen, Ren, Sun (2016), Table 1: kp, ki, kd, ka·kt·rg, J, B.
const PID_X: [f64; 6] = [10.0, 50.0, 0.3, 6.5723 * 0.4769 * 1.5915, 7.0028e-3, 0.023569];
const PID_Y: [f64; 6] = [12.344, 61.718, 0.367, 6.2274 * 0.4769 * 1.5915, 8.1904e-3, 0.043009];

fn pid([kp, ki, kd, gain, inertia, damping]: [f64; 6]) -> String {
    format!(
        "pid]\nkp = {kp}\nki = {ki}\nkd = {kd}\ngain = {gain}\ninertia = {inertia}\ndamping = {damping}\n"
    )
}

/// |G(jω)| and its phase (eq. 2 there): gain and phase at `omega` rad/s.
fn response([kp, ki, kd, gain, inertia, damping]: [f64; 6], omega: f64) -> [f64; 2] {
    let square = omega * omega;
    let above = [gain * (ki - kd * square), gain * kp * omega];
    let below =
        [gain * ki - (damping + gain * kd) * square, gain * kp * omega - inertia * square * omega];
    let size = |[real, imaginary]: [f64; 2]| libm::hypot(real, imaginary);
    let angle = |[real, imaginary]: [f64; 2]| libm::atan2(imaginary, real);
    [size(above) / size(below), angle(above) - angle(below)]
}

/// A mill of three axes without limits of jerk, its axes at `accel` mm/s²; servos of X and Y.
fn mill(accel: f64, servos: [&str; 2]) -> TempDir {
    let mut machine = String::from(
        "name = \"mill\"\nchain = \"[w b X Y Z (S) t]\"\n[tool]\ngauge = [0, 0, 0]\naxis = [0, 0, 1]\n",
    );
    for (name, direction) in [("X", "1, 0, 0"), ("Y", "0, 1, 0"), ("Z", "0, 0, 1")] {
        let _ = write!(
            machine,
            "[axis.{name}]\nlinear = [{direction}]\ntravel = [-500, 500]\nmax_feed = 60000\nmax_accel = {accel}\n"
        );
    }
    machine.push_str("[control]\ndialect = \"linuxcnc\"\ntcp = \"post\"\n");
    for (name, servo) in ["X", "Y"].into_iter().zip(servos) {
        if !servo.is_empty() {
            let _ = write!(machine, "[servo.{name}.{servo}");
        }
    }
    with_file("mill.toml", &machine)
}

/// A set-point with what the axes do then.
#[derive(Clone, Copy)]
struct Row {
    time: f64,
    commanded: [f64; 2],
    actual: [f64; 2],
    error: f64,
}

/// Predicts a program; must succeed. What it found, and its set-points.
fn predict(folder: &TempDir, program: &str, more: &[&str]) -> (Value, Vec<Row>, Run) {
    let folder = folder.path();
    fs::write(folder.join("part.ngc"), program).unwrap();
    let job = ["predict", "part.ngc", "-m", "./mill.toml", "--tool-length", "0"];
    let files = ["--summary", "found.json", "--csv", "points.csv"];
    let run = post_in(folder, &[&job[..], &files, more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let text = fs::read_to_string(folder.join("points.csv")).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |name: &str| head.iter().position(|head| *head == name).unwrap();
    let places = ["time", "X", "Y", "X_actual", "Y_actual", "error"].map(place);
    let rows = lines.map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let [time, x, y, x_actual, y_actual, error] =
            places.map(|place| fields[place].parse().unwrap());
        Row { time, commanded: [x, y], actual: [x_actual, y_actual], error }
    });
    (read_json(&folder.join("found.json")), rows.collect(), run)
}

#[track_caller]
fn close(found: &Value, path: &str, wanted: f64, within: f64) {
    let value = found.pointer(path).unwrap().as_f64().unwrap();
    assert!((value - wanted).abs() <= within, "{path}: {value} is not {wanted}");
}

const HEAD: &str = "G21 G90 G94 G61.1\nG0 X0 Y0 Z0\n";

/// From rest to rest, at 1000 mm/s²: way over velocity, and velocity over acceleration once more; where the velocity is not
/// reached, twice the root of way over acceleration. Within a set-point at the end of each move.
#[test]
fn times_that_are_worked_out_by_hand() {
    let folder = mill(1000.0, ["", ""]);
    for (program, cutting, rapid, waiting, at_feed) in [
        // 100 mm at 100 mm/s, and 0.1 s: there and back.
        ("G1 X100 F6000\nX0\n", 2.2, 0.0, 0.0, 2.0),
        // 4 mm is too short for 100 mm/s: 63 mm/s after 63 ms.
        ("G1 X4 F6000\n", 2.0 * 0.004_f64.sqrt(), 0.0, 0.0, 0.04),
        // X and Y take 1000 each along a diagonal, which so takes 1414.
        ("G1 X30 Y40 F6000\n", 0.5 + 0.1 / 1.25, 0.0, 0.0, 0.5),
        // Half a minute, whatever the way; the ramps take 2 ms more.
        ("G93 G1 X60 F2\n", 30.002, 0.0, 0.0, 30.0),
        // 0.5 mm a turn at 1000 turns a minute.
        ("S1000 M3\nG95 G1 X50 F0.5\n", 6.0 + 0.5 / 60.0, 0.0, 0.0, 6.0),
        // A rapid at the 1000 mm/s of the axis: 500 mm are just too short for it.
        ("G0 X500\n", 0.0, 2.0 * 0.5_f64.sqrt(), 0.0, 0.0),
        // A dwell between two cuts of 50 mm at 50 mm/s.
        ("G1 X50 F3000\nG4 P1.5\nX0\n", 2.1, 0.0, 1.5, 2.0),
    ] {
        for period in ["0.001", "0.015"] {
            let text = format!("{HEAD}{program}M2\n");
            let (found, _, _) = predict(&folder, &text, &["--period", period]);
            let wanted = [
                ("/time/cutting_s", cutting),
                ("/time/rapid_s", rapid),
                ("/time/waiting_s", waiting),
            ];
            for (path, wanted) in wanted {
                close(&found, path, wanted, 0.004);
            }
            close(&found, "/time/cycle_s", cutting + rapid + waiting, 0.004);
            close(&found, "/time/cutting_at_feed_s", at_feed, 1e-6);
        }
    }
}

/// A loop of the first order follows a ramp v/Kv behind, whatever the period; along a straight line that is no contour error
/// where both axes follow alike, and where they do not, the tool is off by the difference across.
#[test]
fn a_ramp_is_followed_by_its_velocity_over_the_gain() {
    let loops = |gain: u32| format!("transfer]\nnumerator = [{gain}]\ndenominator = [1, {gain}]\n");
    for period in ["0.001", "0.015"] {
        let program = format!("{HEAD}G1 X180 Y240 F6000\nM2\n");
        for gains in [[50, 50], [50, 40]] {
            let [x, y] = gains.map(loops);
            let folder = mill(5000.0, [&x, &y]);
            let (found, rows, _) = predict(&folder, &program, &["--period", period]);
            // 60 and 80 mm/s.
            let lags = [60.0 / f64::from(gains[0]), 80.0 / f64::from(gains[1])];
            let middle = rows.iter().find(|row| row.commanded[0] > 120.0).unwrap();
            for (axis, lag) in lags.into_iter().enumerate() {
                let behind = middle.commanded[axis] - middle.actual[axis];
                assert!((behind - lag).abs() < 2e-3, "{behind} is not {lag}");
                close(&found, &format!("/axes/{axis}/following/value"), lag, 2e-3);
            }
            // Across the direction (0.6, 0.8).
            let across = (0.6 * lags[1] - 0.8 * lags[0]).abs();
            close(&found, "/contour/tip_mm/largest", across, 2e-3);
            assert!((middle.error - across).abs() < 2e-3, "{} {across}", middle.error);
        }
    }
}

/// How far the tool is off a circle of `radius` about the origin, mm, outside positive: once the start has died away, and
/// before the end.
fn on_circle(servos: [[f64; 6]; 2], radius: f64, omega: f64, turns: usize) -> Vec<[f64; 2]> {
    let [x, y] = servos.map(pid);
    let folder = mill(50_000.0, [&x, &y]);
    let feed = 60.0 * omega * radius;
    let mut program = format!("{HEAD}G0 X{radius}\nG17 G64 F{feed:.6}\n");
    program.push_str(&format!("G3 X{radius} Y0 I-{radius} J0\n").repeat(turns));
    program.push_str("M2\n");
    let (_, rows, _) = predict(&folder, &program, &[]);
    let whole = rows.last().unwrap().time;
    // The slowest pole is at -6.1 1/s.
    let steady = rows.iter().filter(|row| row.time > 2.5 && row.time < whole - 0.3);
    let off = steady.map(|row| [libm::hypot(row.actual[0], row.actual[1]) - radius, row.error]);
    let off: Vec<_> = off.collect();
    assert!(off.len() > 500);
    off
}

/// The radius of a circle comes out |G(jω)| times as large (eq. 7 there): up to its peak at 49.66 rad/s and where it falls
/// through 1 again, at 113.2. What the servos are given are chords between set-points of a millisecond: they take (ωT)²/12
/// of it off.
#[test]
fn a_circle_is_too_large_by_the_gain_of_the_servo() {
    for (omega, radius, turns, gain) in [
        (10.0, 10.0, 8, 1.01462),
        (20.0, 5.0, 16, 1.04902),
        (49.66, 2.0, 40, 1.0996),
        (113.2, 1.0, 80, 1.0000),
    ] {
        let [of_formula, _] = response(PID_X, omega);
        assert!((of_formula - gain).abs() < 1e-4, "{of_formula} at {omega} rad/s");
        for [off, error] in on_circle([PID_X, PID_X], radius, omega, turns) {
            let chords = 1.0 - libm::pow(omega * 0.001, 2.0) / 12.0;
            let wanted = radius * (of_formula * chords - 1.0);
            assert!((off - wanted).abs() < 2e-4, "{omega} rad/s: {off} is not {wanted}");
            assert!((error - wanted.abs()).abs() < 2e-4, "{omega} rad/s: {error} is not {wanted}");
        }
    }
}

/// X and Y of Table 1 are not matched: at 5 rad/s and 200 mm/s² the circle of 8 mm strays 32.4 µm, where the worse axis alone
/// says 31.0.
#[test]
fn axes_that_are_not_matched_make_an_oval_of_a_circle() {
    let [x, y] = [PID_X, PID_Y].map(|axis| response(axis, 5.0));
    let worse = 8.0 * (x[0].max(y[0]) - 1.0);
    assert!((worse - 0.0310).abs() < 5e-5, "{worse}");
    let off = on_circle([PID_X, PID_Y], 8.0, 5.0, 6);
    let largest = off.iter().map(|[_, error]| *error).fold(0.0, f64::max);
    assert!((largest - 0.0324).abs() < 5e-5, "{largest}");
    let bound = worse + 4.0 * (x[1] - y[1]).abs();
    assert!(largest <= bound && bound < largest * 1.06, "{largest} {bound}");
}

/// A program in which nothing moves is told of: it may be the wrong file.
#[test]
fn a_program_in_which_nothing_moves_is_warned_of() {
    let folder = mill(1000.0, ["", ""]);
    for program in ["", "G21 G90\nM30\n", "(a remark)\nG4 P2\nM2\n"] {
        let (found, rows, run) = predict(&folder, program, &[]);
        assert!(rows.is_empty());
        assert_eq!(found["set_points"], 0);
        assert_contains(&run.err, &["warning[no-motion]", "part.ngc"]);
    }
}

/// Programs of others are predicted in seconds, and those that cannot be read are refused by their lines.
#[test]
fn programs_of_others_end_in_bounded_time() {
    let began = std::time::Instant::now();
    for (program, machine, seconds) in [
        ("linuxcnc_boat-xyzac.ngc", "xyzac-trt", Some(574.0)),
        ("linuxcnc_xyzac_switchkins_test_3.ngc", "xyzac-trt", Some(3.6)),
        ("siemens_ElMoe_keychain.mpf", "ac-trunnion-840d", None),
        ("nxpost_mori_nmv5000_out.txt", "umc-750", None),
        ("nxpost_dmu70evo_840d_in.ptp", "ac-trunnion-840d", None),
    ] {
        let Some(path) = shared(&format!("data/nc/{program}")) else {
            return;
        };
        let path = path.to_str().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let found = folder.path().join("found.json");
        let more = ["--tool-length", "100", "-q", "--summary", found.to_str().unwrap()];
        let run = post(&[&["predict", path, "-m", machine], &more[..]].concat());
        match seconds {
            Some(seconds) => {
                assert_eq!(run.code, 0, "{}", run.err);
                let found = read_json(&found);
                close(&found, "/time/cycle_s", seconds, 0.05 * seconds);
                // No axis of that machine has a servo.
                close(&found, "/contour/parts/0/tip_mm/largest", 0.0, 1e-6);
            }
            None => {
                assert_eq!((run.code, found.exists()), (1, false), "{program}");
                assert_contains(&run.err, &[&format!("{program}:"), "nothing was written"]);
            }
        }
    }
    assert!(began.elapsed().as_secs() < 120, "{:?}", began.elapsed());
}
