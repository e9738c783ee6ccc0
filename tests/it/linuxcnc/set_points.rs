//! Set-points that are predicted, against where the real LinuxCNC commands its joints, a row a millisecond.
//!
//! Both begin where the first axis moves. Under G61 the line of the program changes at a standstill in both, so that
//! durations of blocks can be compared; under G64 LinuxCNC names the next line somewhere in the overlap, and cycle and path
//! are compared. Feeds are a minute and inverse times; G95 waits for a spindle, which is not simulated.

use super::*;

/// Cycle times differ by no more than this share, and where we know of more by no more than that: the two are the corner
/// between a line and an arc at different feeds, and how fast a move begins on which rotary axes alone turn where a tolerance
/// bounds the overlap.
const CYCLE: f64 = 0.02;
const APART: [(&str, &str, f64); 2] =
    [("lines and arcs", "G93 G64", 0.10), ("kept tip", "G94 G64 P0.05", 0.03)];

/// Durations of blocks, s.
const BLOCK: f64 = 0.010;

/// A row of either table: time, axes X Y Z A C (mm, degrees), line of the program.
#[derive(Clone, Copy, Debug)]
struct Point {
    time: f64,
    axes: [f64; 5],
    line: u64,
}

/// What a program is run on.
struct Rig {
    /// Of the recorder, besides the limits.
    theirs: &'static [&'static str],
    /// The machine file, besides the limits.
    ours: &'static str,
}

/// Five axes without kinematics.
const PLAIN: Rig = Rig {
    theirs: &["--machine", "trivkins", "--axes", "XYZAC"],
    ours: r#"name = "plain"
chain = "[w C' A' X' Y' b Z (S) t]"
[tool]
gauge = [0, 0, 0]
[control]
dialect = "linuxcnc"
tcp = "post"
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
travel = [-360, 360]
[axis.A]
rotary = [1, 0, 0]
point = [0, 0, 0]
travel = [-360, 360]
[axis.X]
linear = [1, 0, 0]
[axis.Y]
linear = [0, 1, 0]
[axis.Z]
linear = [0, 0, 1]
"#,
};

/// A trunnion table whose tip is kept, the tip of a tool of 40 mm on the table's centre at 20 mm.
const TRUNNION: Rig = Rig {
    theirs: &["--machine", "xyzac-trt", "--tool", "1=40", "--start", "Z=60"],
    ours: r#"extends = "xyzac-trt"
[tools]
1 = 40
[solution]
start = { Z = 60 }
"#,
};

impl Rig {
    /// The machine file.
    fn machine(&self) -> String {
        let mut table: toml::Table = self.ours.parse().unwrap();
        let axes = table.entry("axis").or_insert(toml::Table::new().into());
        for name in ["X", "Y", "Z", "A", "C"] {
            let limits = match name {
                "A" | "C" => "max_feed = 3600\nmax_accel = 300",
                _ => "max_feed = 12000\nmax_accel = 1000\ntravel = [-300, 300]",
            };
            let limits: toml::Table = limits.parse().unwrap();
            let axis = axes.as_table_mut().unwrap();
            let axis = axis.entry(name).or_insert(toml::Table::new().into());
            axis.as_table_mut().unwrap().extend(limits);
        }
        let motion = "limits = \"programmed\"\nrapids = \"among-rapids\"\nblend = \"overlap\"";
        table.insert("motion".to_owned(), motion.parse::<toml::Table>().unwrap().into());
        table.to_string()
    }

    /// What LinuxCNC does; none where it is not.
    fn recorded(&self, program: &Path) -> Option<Result<Vec<Point>, String>> {
        let out = program.with_extension("csv");
        let mut linuxcnc = Command::new(shared("linuxcnc/run")?);
        linuxcnc.arg(program).args(self.theirs);
        linuxcnc.args(["--max-feed", "X=12000", "Y=12000", "Z=12000", "A=3600", "C=3600"]);
        linuxcnc.args(["--max-accel", "X=1000", "Y=1000", "Z=1000", "A=300", "C=300"]);
        linuxcnc.args(["--limits", "X=-300:300", "Y=-300:300", "Z=-300:300"]);
        let done = linuxcnc.arg("-o").arg(&out).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        if done.status.code() == Some(3) {
            eprintln!("skipped: {said}");
            return None;
        }
        // Beside other load the recorder may lose some.
        if !done.status.success() || said.contains("samples lost") {
            return Some(Err(format!("{}: {said}", program.display())));
        }
        Some(Ok(points(&fs::read_to_string(&out).unwrap(), "t_s")))
    }
}

/// The rows of a table, from just before the first motion to the end of the last.
fn points(text: &str, time: &str) -> Vec<Point> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).unwrap();
    let axes = ["X", "Y", "Z", "A", "C"].map(column);
    let (time, line) = (column(time), column("line"));
    let rows = lines.map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        let number = |place: usize| fields[place].parse::<f64>().unwrap();
        Point { time: number(time), axes: axes.map(number), line: number(line) as u64 }
    });
    let rows: Vec<Point> = rows.collect();
    let apart = |a: &Point, b: &Point| {
        let axes = a.axes.iter().zip(&b.axes);
        axes.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) > 2e-6
    };
    let first = rows.iter().position(|row| apart(row, &rows[0])).unwrap() - 1;
    let end = rows.len() - 1;
    let last = (0..=end).rev().find(|at| apart(&rows[*at], &rows[end])).unwrap() + 1;
    let start = rows[first].time;
    let rows = rows[first..=last].iter().copied();
    rows.map(|row| Point { time: row.time - start, ..row }).collect()
}

/// The largest distance of a recorded row from the predicted path, mm and degrees alike.
fn off_path(theirs: &[Point], ours: &[Point]) -> f64 {
    let distance = |point: &[f64; 5], from: &[f64; 5], to: &[f64; 5]| {
        let way: [f64; 5] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let arm: [f64; 5] = std::array::from_fn(|axis| point[axis] - from[axis]);
        let dot = |a: &[f64; 5], b: &[f64; 5]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let share = match dot(&way, &way) {
            0.0 => 0.0,
            square => (dot(&arm, &way) / square).clamp(0.0, 1.0),
        };
        let off: [f64; 5] = std::array::from_fn(|axis| arm[axis] - way[axis] * share);
        dot(&off, &off).sqrt()
    };
    let (mut at, mut worst) = (1_usize, 0.0f64);
    for row in theirs {
        let near = at.saturating_sub(60).max(1)..(at + 300).min(ours.len());
        let nearest = near
            .map(|place| (distance(&row.axes, &ours[place - 1].axes, &ours[place].axes), place))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let (off, place) = nearest.unwrap();
        (at, worst) = (place, worst.max(off));
    }
    worst
}

/// How long each line is named, s.
fn durations(rows: &[Point]) -> Vec<(u64, f64)> {
    let mut lines: Vec<(u64, f64)> = Vec::new();
    for row in rows.iter().filter(|row| row.line > 0) {
        if lines.last().is_none_or(|(line, _)| *line != row.line) {
            lines.push((row.line, row.time));
        }
    }
    let end = rows.last().unwrap().time;
    let ends: Vec<f64> = lines.iter().skip(1).map(|line| line.1).chain([end]).collect();
    // The first row stands before the first line.
    let begin = |place: usize, time: f64| if place == 0 { 0.0 } else { time };
    let each = lines.iter().zip(ends).enumerate();
    each.map(|(place, ((line, time), ends))| (*line, ends - begin(place, *time))).collect()
}

/// Runs a program under `mode` in both; the path may differ by `path` µm. Blocks are compared under G61.
fn agrees(rig: &Rig, name: &str, mode: &str, path: f64, program: &str) {
    if shared("linuxcnc/run").is_none() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.ngc");
    fs::write(&file, format!("G21 G90 {mode}\n{program}M2\n")).unwrap();
    fs::write(folder.path().join("own.toml"), rig.machine()).unwrap();
    let arguments = ["predict", "part.ngc", "-m", "own.toml", "--csv", "ours.csv", "-q"];
    let done = run(command().current_dir(folder.path()).args(arguments), b"");
    assert_eq!(done.code, 0, "{name} {mode}: {}", done.err);
    let text = fs::read_to_string(folder.path().join("ours.csv")).unwrap();
    let ours = points(&text, "time");
    until_good(|| {
        let theirs = rig.recorded(&file)?;
        Some(theirs.and_then(|theirs| judge_points(name, mode, path, &theirs, &ours)))
    });
}

/// What is wrong with ours; how both compare is written to stderr.
fn judge_points(
    name: &str,
    mode: &str,
    path: f64,
    theirs: &[Point],
    ours: &[Point],
) -> Result<(), String> {
    let [own, other] = [ours, theirs].map(|rows| rows.last().unwrap().time);
    let off = 1000.0 * off_path(theirs, ours);
    let pairs = theirs.iter().zip(ours);
    let at_once = pairs.map(|(a, b)| {
        let axes = a.axes.iter().zip(&b.axes);
        axes.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    });
    let at_once = at_once.fold(0.0, f64::max);
    let mut blocks = String::new();
    let mut worst: f64 = 0.0;
    if mode.contains("G61") {
        let (a, b) = (durations(theirs), durations(ours));
        let lines = |durations: &[(u64, f64)]| -> Vec<u64> {
            durations.iter().map(|line| line.0).collect()
        };
        if lines(&a) != lines(&b) {
            return Err(format!("{name} {mode}: {a:?} {b:?}"));
        }
        for (theirs, ours) in a.iter().zip(&b) {
            worst = worst.max((theirs.1 - ours.1).abs());
        }
        blocks = format!("blocks within {:.0} ms, ", 1000.0 * worst);
    }
    let all = format!(
        "{name} {mode}: LinuxCNC {other:.3} s, ours {own:.3} s ({:+.2} %), {blocks}path within {off:.2} µm, {at_once:.3} mm at \
         equal times",
        100.0 * (own / other - 1.0),
    );
    eprintln!("{all}");
    let known = APART.iter().find(|known| (known.0, known.1) == (name, mode));
    let cycle = known.map_or(CYCLE, |known| known.2);
    match (own / other - 1.0).abs() <= cycle && off <= path && worst <= BLOCK {
        true => Ok(()),
        false => Err(all),
    }
}

/// The same cuts at inverse times, of which each is another.
fn inverse_time(program: &str) -> String {
    let times = [150, 220, 90, 300].iter().cycle();
    let mut times = times.map(|time| format!(" F{time}"));
    let line = |line: &str| {
        let cuts = ["G1 ", "G2 ", "G3 "].iter().any(|word| line.starts_with(word));
        let words = line.split(' ').filter(|word| !word.starts_with('F'));
        let words: Vec<&str> = words.collect();
        let time = if cuts { times.next().unwrap() } else { String::new() };
        words.join(" ") + &time + "\n"
    };
    program.lines().map(line).collect()
}

/// Every way to pass corners, with feeds a minute and inverse times; what the path may differ by where it is left, µm.
fn agrees_in_all_modes(rig: &Rig, name: &str, left: [f64; 2], program: &str) {
    let inverse = inverse_time(program);
    let [freely, within] = left;
    let modes = vec![
        ("G94 G61", 5.0, program),
        ("G94 G61.1", 5.0, program),
        ("G94 G64", freely, program),
        ("G94 G64 P0.05", within, program),
        ("G93 G61", 5.0, &*inverse),
        ("G93 G64", freely, &*inverse),
    ];
    at_once(modes, |(mode, path, program)| agrees(rig, name, mode, path, program));
}

/// Rotary axes turn with linear ones, alone, and not at all.
const TURNS: &str = "G1 X10 Y5 A10 C5 F3000
G1 X20 Y0 A20 C20
G1 X30 Y10 A15 C40
G1 X30 Y10 A0 C60
G1 X50 Y10
G1 X50 Y30 C50
G0 X0 Y0 A0 C0
";

/// Lines and arcs, tangential and not, some of them short.
const FLAT: &str = "G1 X20 F3000
G1 X40
G1 Y20
G3 X30 Y30 I-10 J0
G1 X10
G2 X10 Y50 I0 J10
G1 X20 Y55
G1 X40 Y50 Z5
G1 X41 Y50.4 Z5
G1 X42 Y51.2
G1 X60 Y60
G0 X0 Y0 Z0
";

/// The tip kept while the table turns.
const KEPT: &str = "G43 H1
M428
G1 X10 Y5 Z20 F3000
G1 X20 Y10 Z15 A-10 C20
G1 X25 Y0 Z15 A-20 C30
G1 X25 Y0 Z15 A-25 C45
G1 X30 Y-10 Z18 A-15 C40
G1 X30 Y-20 Z18
";

/// Half a turn about the table's centre in blocks of 0.5 mm.
fn short_blocks() -> String {
    let mut program = "G43 H1\nM428\nG1 X10 Y0 Z20 F2400\n".to_owned();
    for block in 1..=40 {
        let w = f64::from(block) / 60.0 * std::f64::consts::PI;
        let turned = [-20.0 * libm::sin(w / 2.0), 30.0 * w / std::f64::consts::PI];
        let tip = [10.0 * libm::cos(w), 10.0 * libm::sin(w), 20.0 + 2.0 * libm::sin(2.0 * w)];
        program += &format!(
            "G1 X{:.4} Y{:.4} Z{:.4} A{:.4} C{:.4}\n",
            tip[0], tip[1], tip[2], turned[0], turned[1]
        );
    }
    program
}

/// Lines alone, with corners of all sizes, long and short.
const LINES: &str = "G1 X20 F3000
G1 X35 Y15
G1 X35 Y40
G1 X10 Y40 Z4
G1 X12 Y42
G1 X12 Y30
G1 X20 Y28
G1 X50 Y28.2
G1 X51 Y27
G1 X51 Y20 Z0
G1 X30 Y10
G1 X52 Y9
G0 X0 Y0 Z0
";

#[test]
fn rotary_axes_without_kinematics_go_as_those_of_linuxcnc() {
    agrees_in_all_modes(&PLAIN, "turns", [50.0, 50.0], TURNS);
}

/// Arcs of circles stand in the corners of lines.
#[test]
fn lines_go_as_those_of_linuxcnc() {
    agrees_in_all_modes(&PLAIN, "lines", [50.0, 5.0], LINES);
}

#[test]
fn lines_and_arcs_go_as_those_of_linuxcnc() {
    agrees_in_all_modes(&PLAIN, "lines and arcs", [400.0, 10.0], FLAT);
}

#[test]
fn a_kept_tip_goes_as_that_of_linuxcnc() {
    agrees_in_all_modes(&TRUNNION, "kept tip", [50.0, 100.0], KEPT);
}

#[test]
fn short_blocks_of_a_kept_tip_go_as_those_of_linuxcnc() {
    agrees_in_all_modes(&TRUNNION, "short blocks", [50.0, 50.0], &short_blocks());
}
