//! `post calibrate`: lines that were moved are found again from readings that rotations of nalgebra make; what readings do
//! not determine is refused by name.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use nalgebra::{Rotation3, Unit, Vector3};
use post_testkit::{Rng, assert_contains, seeded};

use crate::common::post_in;

/// A table-table or a head-head machine as its drawing has it, with room for what differs.
const TABLE: &str = r#"name = "drawing"
chain = "[w C' A' b Y X Z (S) t]"
[tool]
gauge = [0, 0, 400]
axis = [0, 0, 1]
[axis]
C = { rotary = [0, 0, 1], point = [0, 0, 0], cyclic = true }
A = { rotary = [1, 0, 0], point = [0, 0, 50], travel = [-120, 120] }
X = { linear = [1, 0, 0], travel = [-900, 900] }
Y = { linear = [0, 1, 0], travel = [-900, 900] }
Z = { linear = [0, 0, 1], travel = [-900, 900] }
[control]
dialect = "linuxcnc"
tcp = "post"
"#;

/// A line: any point of it, and its direction.
#[derive(Clone, Copy)]
struct Line {
    point: Vector3<f64>,
    direction: Vector3<f64>,
}

impl Line {
    fn turned(&self, point: Vector3<f64>, degrees: f64) -> Vector3<f64> {
        let axis = Unit::new_normalize(self.direction);
        self.point + Rotation3::from_axis_angle(&axis, degrees.to_radians()) * (point - self.point)
    }

    fn key(&self, axis: &str) -> String {
        let [p, d] = [self.point, self.direction];
        format!(
            "axis.{axis}.point = [{}, {}, {}]\naxis.{axis}.rotary = [{}, {}, {}]\n",
            p.x, p.y, p.z, d.x, d.y, d.z
        )
    }
}

/// Lines off those of the drawing by some hundredths of a millimetre and some tenths of a milliradian.
fn moved(rng: &mut Rng) -> (Line, Line) {
    let mut near = |point: [f64; 3], direction: [f64; 3]| Line {
        point: Vector3::from(point) + rng.point(0.05),
        direction: Vector3::from(direction) + rng.point(4e-4),
    };
    (near([0.0; 3], [0.0, 0.0, 1.0]), near([0.0, 0.0, 50.0], [1.0, 0.0, 0.0]))
}

/// Tables as a probe gives them: the linear axes with which a tool of 100 mm finds a ball on the turned table. With
/// `off`, the axes stand somewhere near it, and the table says how far.
fn readings(rng: &mut Rng, lines: (Line, Line), noise: f64, off: bool) -> String {
    let ball = Vector3::new(110.0, -30.0, 70.0) + rng.point(10.0);
    let mut text = String::from("C;A;X;Y;Z;dX;dY;dZ\n");
    for step in 0..40 {
        let (c, a) = (f64::from(step) * 27.0 - 180.0, rng.range(-90.0, 90.0));
        // The tool seen from the part turns by +a: the part turns the other way.
        let there = lines.1.turned(lines.0.turned(ball, -c), -a);
        let words = there - Vector3::new(0.0, 0.0, 300.0);
        let d = if off { rng.point(0.3) } else { Vector3::zeros() };
        let error = Vector3::new(rng.normal(), rng.normal(), rng.normal()) * noise;
        let at = words - d + error;
        let _ = writeln!(text, "{c};{a};{};{};{};{};{};{}", at.x, at.y, at.z, d.x, d.y, d.z);
    }
    text
}

/// The largest deviations of `found.toml` from `truth.toml`: mm and degrees.
fn apart(folder: &Path) -> [f64; 2] {
    let done = post_in(
        folder,
        &["check", "found.toml", "--nominal", "truth.toml", "--tool-length", "100"],
    );
    assert_eq!(done.code, 0, "{}", done.err);
    ["tip deviation", "axis deviation"].map(|name| {
        let line = done.out.lines().find(|line| line.starts_with(name)).unwrap();
        line.split_whitespace().nth(4).unwrap().trim_end_matches('°').parse().unwrap()
    })
}

#[test]
fn moved_lines_are_found_again() {
    let mut rng = seeded(71);
    for (noise, off, most) in [(0.0, false, 2e-5), (0.0, true, 2e-5), (0.001, true, 0.04)] {
        let folder = tempfile::tempdir().unwrap();
        let lines = moved(&mut rng);
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("drawing.toml", TABLE);
        let truth = lines.0.key("C") + &lines.1.key("A");
        write("truth.toml", &format!("extends = \"drawing.toml\"\n{truth}"));
        write("ball.csv", &readings(&mut rng, lines, noise, off));
        let words = ["calibrate", "ball.csv", "-m", "drawing.toml", "--tool-length", "100"];
        let done = post_in(folder.path(), &words);
        assert_eq!(done.code, 0, "{}", done.err);
        let at = done.out.find("extends").unwrap();
        write("found.toml", &done.out[at..]);
        let [tip, axis] = apart(folder.path());
        assert!(tip <= most, "{tip} mm with noise {noise}:\n{}", done.out);
        assert!(axis <= 1e-3 * (1.0 + 1e3 * noise), "{axis} degrees:\n{}", done.out);
        if noise > 0.0 {
            standard_errors(&done.out, lines);
        }
    }
}

/// What was found is no farther from the truth than five standard errors, and these are of the size of the noise.
fn standard_errors(out: &str, (c, a): (Line, Line)) {
    let slope = |line: Line, along: usize| line.direction / line.direction[along];
    // The point of a line where its own coordinate is that of the drawing.
    let foot = |line: Line, along: usize, at: f64| {
        line.point + slope(line, along) * (at - line.point[along])
    };
    let truth = [
        ("C.point X", foot(c, 2, 0.0).x),
        ("C.point Y", foot(c, 2, 0.0).y),
        ("C.rotary X", slope(c, 2).x),
        ("C.rotary Y", slope(c, 2).y),
        ("A.point Y", foot(a, 0, 0.0).y),
        ("A.point Z", foot(a, 0, 0.0).z),
        ("A.rotary Y", slope(a, 0).y),
        ("A.rotary Z", slope(a, 0).z),
    ];
    for (name, wanted) in truth {
        let row = out.lines().find(|line| line.starts_with(name)).unwrap();
        let cells: Vec<f64> =
            row[name.len()..].split_whitespace().map(|cell| cell.parse().unwrap()).collect();
        let [_, found, deviation] = cells[..] else { panic!("{row}") };
        assert!((1e-7..2e-3).contains(&deviation), "{row}");
        assert!((found - wanted).abs() <= 5.0 * deviation + 1e-6, "{row}, truth {wanted}");
    }
}

#[test]
fn what_is_not_determined_is_refused_and_a_bad_reading_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = seeded(72);
    let lines = moved(&mut rng);
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("drawing.toml", TABLE);
    let words = ["calibrate", "ball.csv", "-m", "drawing.toml", "--tool-length", "100"];
    let good = readings(&mut rng, lines, 1e-4, true);
    // A turns nowhere.
    let level: Vec<String> = good
        .lines()
        .enumerate()
        .map(|(row, line)| {
            let mut cells: Vec<&str> = line.split(';').collect();
            if row > 0 {
                cells[1] = "0";
            }
            cells.join(";")
        })
        .collect();
    write("ball.csv", &level.join("\n"));
    let done = post_in(folder.path(), &words);
    assert_eq!(done.code, 1, "{}", done.out);
    assert_contains(&done.err, &["do not determine A.", "--fit names"]);
    // Three readings for eight numbers and a ball.
    write("ball.csv", &good.lines().take(4).collect::<Vec<_>>().join("\n"));
    let done = post_in(folder.path(), &words);
    assert_contains(&done.err, &["9 measured coordinates, and 11 numbers"]);
    // One reading is off by half a millimetre.
    let mut rows: Vec<String> = good.lines().map(str::to_owned).collect();
    let cells: Vec<&str> = rows[20].split(';').collect();
    let off: f64 = cells[2].parse().unwrap();
    rows[20] = rows[20].replacen(cells[2], &(off + 0.5).to_string(), 1);
    write("ball.csv", &rows.join("\n"));
    let done = post_in(folder.path(), &words);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_contains(
        &done.err,
        &["ball.csv, line 21: this reading is 0.", " sigma", "measure it again"],
    );
    for (table, said) in [
        ("", "has no row"),
        ("X,Y,Z,A\n", "there is no column C"),
        ("X,Y,Z,A,C,V\n", "no column is called \"V\""),
        ("X,Y,Z,A,C\n1,2,3,4\n", "4 cells, and 5 columns"),
        ("X,Y,Z,A,C\n1,2,3,4,nan\n", "\"nan\" is no number"),
    ] {
        write("ball.csv", table);
        let done = post_in(folder.path(), &words);
        assert_eq!(done.code, 1, "{table}");
        assert_contains(&done.err, &[said]);
    }
    write("ball.csv", &good);
    let runs = "[error.C]\ncolumns = [\"C\", \"EXC\"]\nrows = [[0, 0.01], [360, 0.01]]\n";
    write("erring.toml", &format!("extends = \"drawing.toml\"\n{runs}"));
    let with_errors = words.map(|word| if word == "drawing.toml" { "erring.toml" } else { word });
    let done = post_in(folder.path(), &with_errors);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_contains(
        &done.err,
        &["warning[calibrate]", "[error] tables of the machine file are not counted"],
    );
    let done = post_in(folder.path(), &[&words[..], &["--fit", "C.pont"]].concat());
    assert_contains(&done.err, &["--fit C.pont", "did you mean `C.point`?"]);
}

/// What the lines of a table say that are left when some are taken out.
fn without(text: &str, lines: &[usize]) -> String {
    let kept = (1..).zip(text.lines()).filter(|(line, _)| !lines.contains(line));
    kept.map(|(_, text)| format!("{text}\n")).collect()
}

/// The cells of a row of numbers.
fn row(out: &str, name: &str) -> Vec<f64> {
    let row = out.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{out}"));
    row[name.len()..].split_whitespace().map(|cell| cell.parse().unwrap()).collect()
}

/// The line numbers that are told as outliers.
fn outliers(err: &str) -> Vec<usize> {
    let told = err.lines().filter(|line| line.contains("from where the others say the ball is"));
    let line = |told: &str| told.split("line ").nth(1)?.split(':').next()?.parse().ok();
    told.map(|told| line(told).unwrap_or_else(|| panic!("{told}"))).collect()
}

#[test]
fn readings_that_do_not_go_with_the_others_are_told_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut rng = seeded(73);
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("drawing.toml", TABLE);
    let words = ["calibrate", "ball.csv", "-m", "drawing.toml", "--tool-length", "100"];
    let run = |table: &str| {
        write("ball.csv", table);
        let done = post_in(folder.path(), &words);
        assert_eq!(done.code, 0, "{}", done.err);
        done
    };
    // Good readings are not told: the worst of forty is no outlier.
    let mut told = 0;
    for _ in 0..20 {
        let lines = moved(&mut rng);
        let good = run(&readings(&mut rng, lines, 0.002, true));
        told += outliers(&good.err).len();
        assert!(told > 0 || !good.out.contains("without"), "{}", good.out);
    }
    assert!(told <= 1, "{told} of 800");
    // Two that are off by ten sigma on the same side hide one another, and draw all numbers.
    let lines = moved(&mut rng);
    let good = readings(&mut rng, lines, 0.002, true);
    let spoil = |text: &str, lines: &[usize], by: f64| -> String {
        let rows = (1..).zip(text.lines()).map(|(line, row)| {
            let mut cells: Vec<String> = row.split(';').map(str::to_owned).collect();
            if lines.contains(&line) {
                cells[3] = (cells[3].parse::<f64>().unwrap() + by).to_string();
            }
            cells.join(";") + "\n"
        });
        rows.collect()
    };
    let bad = spoil(&good, &[9, 31], 0.04);
    let spoilt = run(&bad);
    let mut found = outliers(&spoilt.err);
    found.sort_unstable();
    assert_eq!(found, [9, 31], "{}", spoilt.err);
    assert_contains(&spoilt.out, &["without", "lines "]);
    // The numbers of the column are those of the table without them; the lines to paste are of all.
    let left = run(&without(&bad, &[9, 31]));
    for name in ["C.point X", "C.point Y", "A.point Y", "A.rotary Z"] {
        let all = row(&spoilt.out, name);
        assert_eq!(all.len(), 5, "{}", spoilt.out);
        assert_eq!(all[3..], row(&left.out, name)[1..], "{}", spoilt.out);
    }
    let lines_of = |out: &str| out[out.find("extends").unwrap()..].to_owned();
    assert_ne!(lines_of(&spoilt.out), lines_of(&left.out));
    // How far off, in mm and sigma: 0.04 mm, the others known to 0.002 mm a coordinate.
    for told in spoilt.err.lines().filter(|line| line.contains("sigma")) {
        let number = |ahead: &str, behind: &str| -> f64 {
            let text = told.split(ahead).nth(1).unwrap().split(behind).next().unwrap();
            text.trim().parse().unwrap()
        };
        let (off, sigma) = (number("this reading is", "mm"), number("the ball is,", "sigma"));
        assert!((0.03..0.05).contains(&off) && (8.0..35.0).contains(&sigma), "{told}");
    }
}
