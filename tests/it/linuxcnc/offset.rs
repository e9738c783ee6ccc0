//! Programs in the real LinuxCNC on a part that is not where the machine file takes it to be, and behind programs that left
//! things in force.

use super::*;

/// A leaning tool comes to its first point, and cuts an arc where its axis stays.
const LEANING: &str = "UNITS/MM
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/ 20.0, 10.0, 30.0, 0.0, 0.5, 0.8660254
FEDRAT/3000,MMPM
GOTO/ 20.0, 10.0, 15.0, 0.0, 0.5, 0.8660254
GOTO/ 30.0, 15.0, 15.0, -0.3, 0.4, 0.8660254
RAPID
GOTO/ 30.0, 15.0, 45.0, -0.3, 0.4, 0.8660254
LOADTL/2
SPINDL/RPM,3000,CLW
RAPID
GOTO/ 30.0, 0.0, 30.0, 0.0, 0.0, 1.0
FEDRAT/3000,MMPM
GOTO/ 30.0, 0.0, 15.0, 0.0, 0.0, 1.0
CIRCLE/ 0.0, 0.0, 15.0, 0.0, 0.0, 1.0, 30.0
GOTO/ 0.0, 30.0, 15.0, 0.0, 0.0, 1.0
RAPID
GOTO/ 0.0, 30.0, 45.0, 0.0, 0.0, 1.0
END
FINI
";

/// Off the tool's line on the way in, mm: what interpolation and rounding make.
const SIDEWAYS: f64 = 0.01;

/// So near to its first point the tip is on the way down to it, mm.
const NEARLY: f64 = 1.0;

fn posted(machine: &Machine, folder: &Path) -> std::path::PathBuf {
    fs::write(folder.join("fast.toml"), fast(machine)).unwrap();
    fs::write(folder.join("leaning.cls"), LEANING).unwrap();
    let mut with = command();
    with.current_dir(folder);
    with.args(["-q", "-m", "fast.toml", "leaning.cls", "-o", "leaning.ngc"]);
    let done = run(&mut with, b"");
    assert_eq!(done.code, 0, "{}", done.err);
    folder.join("leaning.ngc")
}

/// How far the tip goes in to the first point, and how far it strays from the tool's own line through it, mm.
fn descent(machine: &Machine, rows: &[Row], moved: Vector3<f64>) -> [f64; 2] {
    let stands = |row: &Row| {
        let [tilt, c] = row.rotary.map(f64::to_radians);
        let (tip, _) = (machine.law)(row.linear, tilt, c, row.length);
        tip - moved - Vector3::z() * machine.part
    };
    // On a table and under a head alike.
    let way = Vector3::new(0.0, 0.5, 0.866_025_4);
    let point = Vector3::new(20.0, 10.0, 30.0);
    // The block that comes to the point, at rapid or at feed, is the one in force shortly before.
    let near = |row: &&Row| (stands(row) - point).norm() < NEARLY;
    let line = rows.iter().find(near).unwrap().line;
    let down: Vec<Vector3<f64>> =
        (rows.iter()).filter(|row| row.line == line).map(stands).collect();
    let last = down[down.len() - 1];
    let aside = |tip: &Vector3<f64>| (tip - point).cross(&way).norm();
    assert!((last - point).norm() < SIDEWAYS, "{last}");
    [(down[0] - last).norm(), down.iter().map(aside).fold(0.0, f64::max)]
}

#[test]
fn the_tip_comes_in_along_the_tool_wherever_the_part_is() {
    if shared("linuxcnc/run").is_none() {
        return;
    }
    let places = [Vector3::zeros(), Vector3::new(40.0, 20.0, -15.0)];
    let cases = MACHINES.iter().flat_map(|machine| places.map(|moved| (machine, moved)));
    at_once(cases.collect(), |(machine, moved)| {
        let folder = tempfile::tempdir().unwrap();
        let program = posted(machine, folder.path());
        let begin = Begin { moved, ..Begin::aside(machine) };
        run_until_good(machine, &program, &begin, |rows| {
            let [way, aside] = descent(machine, rows, moved);
            println!("{}: {aside:.3} mm aside on {way:.3} mm down", machine.file);
            match aside < SIDEWAYS && way > 10.0 {
                true => Ok(()),
                false => Err(format!("{}: {aside} mm aside on {way} mm", machine.file)),
            }
        });
    });
}

/// A line of the program; where it ends, and the least and largest values on it.
type LineEnd = (usize, [f64; 15]);

/// Where each line of the program ends in its cuts, and how far they reach: joints in mm and degrees.
fn course(rows: &[Row]) -> Vec<LineEnd> {
    let mut course: Vec<LineEnd> = Vec::new();
    for row in rows.iter().filter(|row| row.feed || row.arc) {
        let at = [row.linear.x, row.linear.y, row.linear.z, row.rotary[0], row.rotary[1]];
        if course.last().is_none_or(|(line, _)| *line != row.line) {
            let [x, y, z, tilt, c] = at;
            course.push((row.line, [x, y, z, tilt, c, x, y, z, tilt, c, x, y, z, tilt, c]));
        }
        if let Some((_, seen)) = course.last_mut() {
            for (place, value) in at.into_iter().enumerate() {
                seen[place] = value;
                seen[5 + place] = seen[5 + place].min(value);
                seen[10 + place] = seen[10 + place].max(value);
            }
        }
    }
    course
}

#[test]
fn what_the_program_before_left_in_force_changes_nothing() {
    let machine = &MACHINES[0];
    if shared("linuxcnc/run").is_none() {
        return;
    }
    let moved = Vector3::new(40.0, 20.0, -15.0);
    // Where it goes behind what is left in force, once `judge` has nothing to say of it.
    let ran = |left: &[&'static str], tcp_on, judge: &dyn Fn(&[LineEnd]) -> Result<(), String>| {
        let folder = tempfile::tempdir().unwrap();
        let program = posted(machine, folder.path());
        let begin = Begin { tcp_on, moved, left: left.to_vec(), ..Begin::aside(machine) };
        let found = std::cell::RefCell::new(Vec::new());
        run_until_good(machine, &program, &begin, |rows| {
            found.replace(course(rows));
            judge(&found.borrow())
        })?;
        Some(found.into_inner())
    };
    let Some(clean) = ran(&[], false, &|_| Ok(())) else {
        return;
    };
    assert!(clean.len() > 5);
    let cases = vec![
        (&["G90.1"][..], false),
        (&["G91"], false),
        (&["G20"], false),
        (&["G93"], false),
        (&["G92 X7 Y-3 Z5"], false),
        (&["G90.1", "G20", "G92 X1", "G18", "G91"], true),
    ];
    at_once(cases, |(left, tcp_on)| {
        ran(left, tcp_on, &|course| {
            let off = |(one, other): (&LineEnd, &LineEnd)| {
                let apart = one.1.iter().zip(&other.1).map(|(a, b)| (a - b).abs());
                if one.0 == other.0 { apart.fold(0.0, f64::max) } else { f64::INFINITY }
            };
            let most = clean.iter().zip(course).map(off).fold(0.0, f64::max);
            match clean.len() == course.len() && most < 0.2 {
                true => Ok(()),
                false => {
                    Err(format!("behind {left:?}: {most} mm or ° off, {} lines", course.len()))
                }
            }
        });
    });
}
