//! Programs that are read back, in the real LinuxCNC: where its joints are commanded to, and where reading says that they
//! go.

use super::*;

/// What LinuxCNC's interpolation leaves between two of its milliseconds, mm or degrees.
const NEAR: f64 = 0.01;

/// How far its tip is off the way that reading tells, mm: between ends it follows lines and arcs by their chords.
const OFF: f64 = 0.02;

/// So many rows long a motion is named before its joints alone are meant.
const LAG: usize = 5;

/// Words of every kind that this control and reading have in common, without and with the tip kept.
const WORDS: &str = "G21 G17 G40 G49 G80 G90 G94 G61.1
M429
G54
T1 M6
G0 X0 Y0 Z80 A0 C0
G43 H1
G0 X10 Y5 Z60
G1 Z40 F6000
G91 X5 Y-3
X2 Z-1
G90
G2 X27 Y2 I5 J0
G3 X17 Y2 R5
G2 X27 Y2 R-5.5
G18 G2 X17 Z39 I-5 K0
G19 G3 Y12 Z39 J5 K0
G17 G3 X17 Y12 Z35 I5 J0 P2
G90.1 G2 X27 Y12 I22 J12
G91.1
G20 G1 X1 Y0.5 F200
G21
G93 G1 X10 Y10 Z30 A-10 C20 F60
X12 F120
G94 F6000
G2 X22 Y10 I5 J0
G28 Z60
G53 G0 Z90
M428
G0 X20 Y10 Z50
G1 X25 Y12 Z45 A-20 C60 F6000
G2 X35 Y12 I5 J0
G91 G3 X-10 I-5 J0
G1 X3 A-5
G90
G53 G0 Z90
M429
G0 X0 Y0
G49
G0 Z100
M2
";

/// A motion as the command prints it.
struct Told {
    line: usize,
    /// The axes in the order of the recording: X Y Z, the tilting axis and C.
    axes: [f64; 5],
    tip: Vector3<f64>,
    arc: bool,
    rapid: bool,
    kept: bool,
}

/// What `post read` says of a program.
fn told(machine: &Machine, folder: &Path, program: &str) -> Vec<Told> {
    let done = run(
        command().current_dir(folder).args(["read", "-m", "fast.toml", program, "--csv", "-"]),
        b"",
    );
    assert_eq!(done.code, 0, "{}", done.err);
    let mut lines = done.out.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).unwrap();
    let axes = ["X", "Y", "Z", &machine.tilting.to_string(), "C"].map(column);
    let tip = ["tip_x", "tip_y", "tip_z"].map(column);
    let [line, kind, way, tcp] = ["line", "kind", "way", "tcp"].map(column);
    lines
        .map(|row| {
            let fields: Vec<&str> = row.split(',').collect();
            let number = |place: usize| fields[place].parse::<f64>().unwrap();
            Told {
                line: fields[line].parse().unwrap(),
                axes: axes.map(number),
                tip: Vector3::from(tip.map(number)),
                arc: fields[way] == "arc",
                rapid: fields[kind] == "rapid",
                kept: fields[tcp] == "1",
            }
        })
        .collect()
}

/// How far a place of the joints is off the straight piece between two recorded ones.
fn from_piece(place: &[f64; 5], from: &Row, to: &Row) -> f64 {
    let values = |row: &Row| {
        let [x, y, z]: [f64; 3] = row.linear.into();
        [x, y, z, row.rotary[0], row.rotary[1]]
    };
    let (from, to) = (values(from), values(to));
    let dot = |a: &[f64; 5], b: &[f64; 5]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let way: [f64; 5] = std::array::from_fn(|index| to[index] - from[index]);
    let arm: [f64; 5] = std::array::from_fn(|index| place[index] - from[index]);
    let square = dot(&way, &way);
    let share = if square > 0.0 { (dot(&arm, &way) / square).clamp(0.0, 1.0) } else { 0.0 };
    let off: [f64; 5] = std::array::from_fn(|index| arm[index] - way[index] * share);
    dot(&off, &off).sqrt()
}

/// Every end that reading tells is come to, in order.
fn ends_are_met(machine: &Machine, told: &[Told], rows: &[Row]) -> Result<(), String> {
    let mut at = 1;
    for motion in told {
        let met =
            (at..rows.len()).find(|at| from_piece(&motion.axes, &rows[at - 1], &rows[*at]) < NEAR);
        let Some(met) = met else {
            return Err(format!(
                "{}: LinuxCNC never comes to {:?} of line {}",
                machine.file, motion.axes, motion.line
            ));
        };
        at = met;
    }
    Ok(())
}

/// At feed LinuxCNC's tip is nowhere but on the ways that reading tells. Arcs are left to their ends.
fn cuts_are_told(machine: &Machine, told: &[Told], rows: &[Row]) -> Result<(), String> {
    let mut cuts: Vec<[Vector3<f64>; 2]> = Vec::new();
    for pair in told.windows(2) {
        if !pair[1].rapid && !pair[1].arc {
            cuts.push([pair[0].tip, pair[1].tip]);
        }
    }
    let mut first = 0;
    // The table has ends alone: with the length and M428 the tip of the next motion begins elsewhere than the last ended.
    let switched: Vec<usize> = (told.windows(2))
        .filter(|pair| pair[0].kept != pair[1].kept)
        .map(|pair| pair[1].line)
        .collect();
    // The joints come some milliseconds behind the motion that LinuxCNC names.
    for stretch in rows
        .windows(LAG)
        .filter(|rows| rows.iter().all(|row| row.feed && !switched.contains(&row.line)))
    {
        let row = &stretch[LAG - 1];
        let [tilt, c] = row.rotary.map(f64::to_radians);
        let (tip, _) = (machine.law)(row.linear, tilt, c, row.length);
        let tip = tip - Vector3::z() * machine.part;
        let Some(near) = (first..cuts.len()).find(|at| off(&tip, &cuts[*at]) < OFF) else {
            return Err(format!(
                "{}: LinuxCNC's tip at {tip} is on no way that is told",
                machine.file
            ));
        };
        // It never goes back by more than the piece that it leaves.
        first = first.max(near.saturating_sub(1));
    }
    Ok(())
}

/// Posts a CL file with the tip kept by whom `tcp` says.
fn posted(folder: &Path, tcp: &str) {
    let done = run(
        command().current_dir(folder).args([
            "-m",
            "fast.toml",
            "--tcp",
            tcp,
            "two.cls",
            "-o",
            "two.ngc",
        ]),
        b"",
    );
    assert_eq!(done.code, 0, "{}", done.err);
}

#[test]
fn programs_of_ours_are_read_as_they_are_run() {
    if shared("linuxcnc/run").is_none() {
        return;
    }
    let cases = MACHINES.iter().flat_map(|machine| ["control", "post"].map(|tcp| (machine, tcp)));
    at_once(cases.collect(), |(machine, tcp)| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("fast.toml"), fast(machine)).unwrap();
        fs::write(folder.path().join("two.cls"), TWO_TOOLS).unwrap();
        posted(folder.path(), tcp);
        let told = told(machine, folder.path(), "two.ngc");
        assert!(told.len() > 20, "{} motions", told.len());
        // Reading knows of no place before the first words: it begins at the zeros of the drawing.
        let program = folder.path().join("two.ngc");
        run_until_good(machine, &program, &Begin::at("Z=-5"), |rows| {
            ends_are_met(machine, &told, rows)?;
            cuts_are_told(machine, &told, rows)
        });
    });
}

#[test]
fn words_of_every_kind_are_read_as_they_are_run() {
    if shared("linuxcnc/run").is_none() {
        return;
    }
    at_once(MACHINES[..2].iter().collect(), |machine| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("fast.toml"), fast(machine)).unwrap();
        let words = WORDS.replace(" A", &format!(" {}", machine.tilting));
        fs::write(folder.path().join("words.ngc"), words).unwrap();
        let told = told(machine, folder.path(), "words.ngc");
        let program = folder.path().join("words.ngc");
        let begin = Begin::at("Z=-5");
        run_until_good(machine, &program, &begin, |rows| ends_are_met(machine, &told, rows));
    });
}

#[test]
#[ignore = "takes minutes, and a machine that does nothing else: LinuxCNC's joints are not recorded whole beside other work"]
fn programs_of_others_are_read_as_they_are_run() {
    let Some(data) = shared("data/nc").filter(|_| shared("linuxcnc/run").is_some()) else {
        return;
    };
    let machine = &MACHINES[0];
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("fast.toml"), fast(machine)).unwrap();
    for name in ["linuxcnc_xyzac_switchkins_test_3.ngc", "linuxcnc_boat-xyzac.ngc"] {
        // The feed has nothing to do with where it goes, and a run takes the program's own time; on exact paths every
        // end is come to.
        let text = fs::read_to_string(data.join(name)).unwrap();
        let words = text.lines().map(|line| {
            let words = line.split_whitespace().map(|word| match word.strip_prefix('F') {
                Some(feed) if feed.parse::<f64>().is_ok() => "F12000",
                _ => word,
            });
            words.collect::<Vec<_>>().join(" ")
        });
        let mut lines: Vec<String> = words.collect();
        let first = usize::from(lines[0].starts_with('%'));
        lines[first] = format!("G61.1 {}", lines[first]);
        fs::write(folder.path().join(name), lines.join("\n") + "\n").unwrap();
        let told = told(machine, folder.path(), name);
        // Its first block says one axis alone.
        let boat = name.contains("boat");
        assert!(!boat || told.len() > 1800, "{} motions", told.len());
        let program = folder.path().join(name);
        let good = run_until_good(machine, &program, &Begin::at("Z=100"), |rows| {
            ends_are_met(machine, &told, rows)?;
            match boat {
                true => cuts_are_told(machine, &told, rows),
                false => Ok(()),
            }
        });
        if good.is_none() {
            return;
        }
    }
}
