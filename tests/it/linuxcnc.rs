//! Programs in the real LinuxCNC: where its joints go between the cuts, from a cold start and from one with TCP still on.
//!
//! The tip is computed from the joints by the laws of LinuxCNC's kinematics modules, not by the product.

mod arcs;
mod flow;
mod offset;
mod read;
mod set_points;

use std::fs;
use std::path::Path;
use std::process::Command;

use nalgebra::{Rotation3, Vector3};
use post_testkit::{drawn, shared};

use crate::common::{command, read_json, run};

/// Two tools, the first approached upright, the second leaning; cuts that turn, a stop, rapids on the way out.
const TWO_TOOLS: &str = "UNITS/MM
LOADTL/1
SPINDL/RPM,3000,CLW
COOLNT/FLOOD
RAPID
GOTO/ 20.0, 10.0, 30.0, 0.0, 0.0, 1.0
FEDRAT/3000,MMPM
GOTO/ 20.0, 10.0, 15.0, 0.0, 0.0, 1.0
GOTO/ 30.0, 10.0, 15.0, 0.0, 0.5, 0.8660254
GOTO/ 30.0, 20.0, 15.0, 0.3, 0.4, 0.8660254
RAPID
GOTO/ 30.0, 20.0, 35.0, 0.3, 0.4, 0.8660254
LOADTL/2
SPINDL/RPM,2000,CLW
RAPID
GOTO/ -20.0, 10.0, 30.0, 0.0, 0.5, 0.8660254
FEDRAT/3000,MMPM
GOTO/ -20.0, 10.0, 15.0, 0.0, 0.5, 0.8660254
GOTO/ -30.0, 15.0, 15.0, -0.3, 0.4, 0.8660254
STOP
GOTO/ -30.0, -15.0, 15.0, -0.3, 0.4, 0.8660254
RAPID
GOTO/ -30.0, -15.0, 45.0, -0.3, 0.4, 0.8660254
END
FINI
";

/// mm/min and degrees a minute: ten times those of the demonstration machines, so that a run takes seconds.
const LINEAR: f64 = 12_000.0;
const ROTARY: f64 = 18_000.0;

/// Lengths of the two tools, mm.
const TOOLS: [f64; 2] = [40.0, 25.0];

/// Of a rapid, mm.
const RAPID_TOLERANCE: f64 = 0.5;

/// So far below its end the depth axis comes over a first position at most, mm.
const ACROSS: f64 = 50.0;

/// So far out on its own line a tool that leans comes over its first position at most, mm.
const COMES_IN: f64 = 400.0;

/// What is the same but for the interpolation's last digits, mm or degrees.
const SAME: f64 = 0.002;

/// Tip and tool axis in the part frame.
type Stand = (Vector3<f64>, Vector3<f64>);

/// Where the tool stands, from joints X Y Z, tilting axis and C (radians), and the length in force.
type Law = fn(Vector3<f64>, f64, f64, f64) -> Stand;

/// A machine of LinuxCNC's.
struct Machine {
    /// Ours.
    file: &'static str,
    /// Theirs.
    name: &'static str,
    tilting: char,
    /// Upper end of Z, mm.
    top: f64,
    /// Where the part origin stands, mm along Z.
    part: f64,
    law: Law,
}

fn table(
    joints: Vector3<f64>,
    offset: Vector3<f64>,
    tilt: Rotation3<f64>,
    c: f64,
    length: f64,
) -> Stand {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), -c);
    let carriage = joints - Vector3::z() * length;
    (turn * (offset + tilt * (carriage - offset)), turn * tilt * Vector3::z())
}

const MACHINES: [Machine; 3] = [
    Machine {
        file: "xyzac-trt",
        name: "xyzac-trt",
        tilting: 'A',
        top: 120.0,
        part: 0.0,
        law: |joints, a, c, length| {
            let tilt = Rotation3::from_axis_angle(&Vector3::x_axis(), -a);
            table(joints, Vector3::new(0.0, 20.0, 10.0), tilt, c, length)
        },
    },
    Machine {
        file: "xyzbc-trt",
        name: "xyzbc-trt",
        tilting: 'B',
        top: 120.0,
        part: 0.0,
        law: |joints, b, c, length| {
            let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), -b);
            table(joints, Vector3::new(-20.0, 0.0, -15.0), tilt, c, length)
        },
    },
    Machine {
        file: "linuxcnc-5axis",
        name: "5axis",
        tilting: 'B',
        top: 100.0,
        part: -200.0,
        law: |joints, b, c, length| {
            let pivot = 250.0;
            let axis = Rotation3::from_axis_angle(&Vector3::z_axis(), c)
                * Rotation3::from_axis_angle(&Vector3::y_axis(), -b)
                * Vector3::z();
            let tip = joints + Vector3::z() * pivot - axis * (pivot + length);
            (tip, axis)
        },
    },
];

/// Where the joints stand at one millisecond.
#[derive(Clone, Copy)]
struct Row {
    linear: Vector3<f64>,
    /// The tilting axis and C, degrees.
    rotary: [f64; 2],
    feed: bool,
    arc: bool,
    length: f64,
    /// Of the program, of the motion in progress.
    line: usize,
}

/// A program is run so often before what is wrong with its runs is believed.
const TRIES: u32 = 3;

/// How LinuxCNC begins to run a program.
struct Begin {
    /// The joints.
    start: String,
    /// TCP is still on.
    tcp_on: bool,
    /// Where G54 stands against where the machine file takes it to be, mm.
    moved: Vector3<f64>,
    /// What the program before has left in force.
    left: Vec<&'static str>,
}

impl Begin {
    /// At a place where nothing stands at zero.
    fn aside(machine: &Machine) -> Self {
        Self { start: format!("Z=-5,{}=-30,C=90", machine.tilting), ..Self::at("") }
    }

    fn at(start: &str) -> Self {
        Self { start: start.to_owned(), tcp_on: false, moved: Vector3::zeros(), left: Vec::new() }
    }
}

/// Tries those cases of a test that a run takes, all at once: LinuxCNC runs in real time, and asks for a tenth of a
/// processor.
fn at_once<T: Send>(cases: Vec<T>, attempt: impl Fn(T) + Sync) {
    let cases = drawn(cases, 1);
    std::thread::scope(|scope| {
        for case in cases {
            scope.spawn(|| attempt(case));
        }
    });
}

/// Runs something in LinuxCNC until nothing is wrong with it; none where LinuxCNC is not.
///
/// Nothing here runs in real time: beside other work samples are lost and moves wait for the block behind them. What is
/// wrong with a program is wrong in every run of it.
fn until_good(mut once: impl FnMut() -> Option<Result<(), String>>) -> Option<()> {
    for tries in 1.. {
        let Err(fault) = once()? else { break };
        assert!(tries < TRIES, "{fault}");
        eprintln!("LinuxCNC once more: {fault}");
    }
    Some(())
}

/// Runs a program until `judge` has nothing to say of where its joints went; none where LinuxCNC is not.
fn run_until_good(
    machine: &Machine,
    program: &Path,
    begin: &Begin,
    judge: impl Fn(&[Row]) -> Result<(), String>,
) -> Option<()> {
    until_good(|| {
        let run = joints(machine, program, begin)?;
        Some(run.and_then(|rows| judge(&rows)))
    })
}

/// Runs a program; none where LinuxCNC is not, and what it says where it does not come to the end or the recording is not
/// whole.
fn joints(machine: &Machine, program: &Path, begin: &Begin) -> Option<Result<Vec<Row>, String>> {
    let folder = program.parent().unwrap();
    let recorded = folder.join("joints.csv");
    let tilting = machine.tilting;
    let mut linuxcnc = Command::new(shared("linuxcnc/run")?);
    linuxcnc.arg(program).args(["--machine", machine.name]);
    linuxcnc.args(["--tool", "1=40,10", "--tool", "2=25,10"]);
    linuxcnc.args(["--start", &begin.start]);
    let part = begin.moved + Vector3::z() * machine.part;
    let part = format!("G10 L2 P1 X{} Y{} Z{}", part.x, part.y, part.z);
    linuxcnc.args(["--before", &part]);
    for axis in ['X', 'Y', 'Z'] {
        linuxcnc.args(["--max-feed", &format!("{axis}={LINEAR}")]);
    }
    for axis in [tilting, 'C'] {
        linuxcnc.args(["--max-feed", &format!("{axis}={ROTARY}")]);
    }
    if begin.tcp_on {
        linuxcnc.args(["--before", "T1 M6", "--before", "G43 H1", "--tcp-on-at-start"]);
    }
    for left in &begin.left {
        linuxcnc.args(["--before", left]);
    }
    linuxcnc.arg("-o").arg(&recorded);
    let done = linuxcnc.output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    if done.status.code() == Some(3) {
        eprintln!("skipped: {said}");
        return None;
    }
    if !done.status.success() || said.contains("samples lost") {
        let (program, machine) = (program.display(), machine.name);
        return Some(Err(format!(
            "{program} does not run to its end on {machine}, or is not recorded whole: {said}"
        )));
    }
    let text = fs::read_to_string(&recorded).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).unwrap();
    let places = ["X", "Y", "Z"].map(column);
    let turning = [column(&tilting.to_string()), column("C")];
    let (motion, length, block) = (column("motion"), column("tool_z"), column("line"));
    let rows = lines.map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |place: usize| fields[place].parse::<f64>().unwrap();
        Row {
            linear: Vector3::from(places.map(number)),
            rotary: turning.map(number),
            feed: fields[motion] == "feed",
            arc: fields[motion] == "arc",
            length: number(length),
            line: number(block) as usize,
        }
    });
    Some(Ok(rows.collect()))
}

/// The points of the rapids of a CL file, by the tool that is in use; each path begins where a cut ends.
fn rapid_paths(text: &str) -> Vec<Vec<[Vector3<f64>; 2]>> {
    let mut paths: Vec<Vec<[Vector3<f64>; 2]>> = vec![Vec::new()];
    let mut last = None;
    let mut rapid = false;
    for line in text.lines() {
        if line.starts_with("LOADTL") {
            paths.push(Vec::new());
            last = None;
        } else if line.starts_with("RAPID") {
            rapid = true;
        } else if let Some(numbers) = line.strip_prefix("GOTO/") {
            let numbers: Vec<f64> =
                numbers.split(',').map(|it| it.trim().parse().unwrap()).collect();
            let tip = Vector3::new(numbers[0], numbers[1], numbers[2]);
            if std::mem::take(&mut rapid) {
                paths.last_mut().unwrap().push([last.unwrap_or(tip), tip]);
            }
            last = Some(tip);
        }
    }
    paths
}

/// How far a point is off a straight piece.
fn off(point: &Vector3<f64>, [from, to]: &[Vector3<f64>; 2]) -> f64 {
    let way = to - from;
    let share = match way.norm_squared() {
        0.0 => 0.0,
        square => ((point - from).dot(&way) / square).clamp(0.0, 1.0),
    };
    (point - from - way * share).norm()
}

/// Judges one run; says what is wrong. Rapids hold the largest feeds too, or nothing jumps in them.
fn judge(machine: &Machine, rows: &[Row], rapids_hold: bool) -> Vec<String> {
    let mut wrong = Vec::new();
    let paths = rapid_paths(TWO_TOOLS);
    // Where it turns; standing, it goes across somewhat lower too, to the point above the first one.
    let at_top = |row: &Row| (row.linear.z - machine.top).abs() < 2.0 * SAME;
    let across = |row: &Row, end: Option<&Row>| {
        row.linear.z > machine.top - ACROSS && end.is_some_and(|end| turned(row, end) < SAME)
    };
    let beside = |row: &Row, other: &Row| {
        (row.linear.xy() - other.linear.xy()).norm() < SAME && turned(row, other) < SAME
    };
    // Between the cuts.
    let mut start = 0;
    while start < rows.len() {
        let feed = rows[start].feed;
        let end = (start..rows.len()).find(|at| rows[*at].feed != feed).unwrap_or(rows.len());
        let segment = &rows[start..end];
        // At a stop it stands where the cut has ended.
        let cut_end = start.checked_sub(1).map(|at| rows[at]);
        start = end;
        if feed {
            continue;
        }
        // Turning points at the top, under which the tool may go up and down.
        let mut tops: Vec<&Row> = Vec::new();
        let end = segment.last();
        for row in segment.iter().filter(|row| at_top(row) || across(row, end)) {
            if tops.last().is_none_or(|last| !beside(row, last)) {
                tops.push(row);
            }
        }
        // A head that leans leaves along the tool axis, from the end of the rapid.
        for row in segment {
            let [tilt, c] = row.rotary.map(f64::to_radians);
            let stands = |row: &Row| {
                // The tool is there also while its length is not in force.
                let lengths =
                    if row.length == 0.0 { &TOOLS[..] } else { std::slice::from_ref(&row.length) };
                lengths
                    .iter()
                    .map(|length| (machine.law)(row.linear, tilt, c, *length))
                    .map(|(tip, axis)| (tip - Vector3::z() * machine.part, axis))
                    .collect::<Vec<_>>()
            };
            let on_way = stands(row).iter().any(|(tip, axis)| {
                let along = |from: Vector3<f64>, far: f64| {
                    off(tip, &[from, from + axis * far]) < RAPID_TOLERANCE
                };
                let mut first = paths.iter().filter_map(|path| path.first());
                let comes_in = first.any(|piece| along(piece[1], COMES_IN));
                comes_in
                    || paths
                        .iter()
                        .flatten()
                        .any(|piece| off(tip, piece) < RAPID_TOLERANCE || along(piece[1], 101.0))
            });
            let stays = cut_end
                .is_some_and(|cut| beside(row, &cut) && (row.linear.z - cut.linear.z).abs() < SAME);
            let on_retract =
                stays || at_top(row) || across(row, end) || tops.iter().any(|top| beside(row, top));
            if !on_way && !on_retract {
                wrong.push(format!(
                    "between the cuts at X {:.3} Y {:.3} Z {:.3} {:.3}° C {:.3}°",
                    row.linear.x, row.linear.y, row.linear.z, row.rotary[0], row.rotary[1]
                ));
                break;
            }
        }
    }
    // From one millisecond to the next.
    for pair in rows.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let way = (to.linear - from.linear).amax();
        let turn = turned(&from, &to);
        let (way_a_minute, turn_a_minute) = (way * 60_000.0, turn * 60_000.0);
        // In feed no joint passes its largest; elsewhere nothing jumps.
        let allowed = match (from.feed && to.feed) || rapids_hold {
            true => 1.01,
            false => 4.0,
        };
        if way_a_minute > LINEAR * allowed || turn_a_minute > ROTARY * allowed {
            wrong.push(format!(
                "{way_a_minute:.0} mm/min, {turn_a_minute:.0}°/min {} at X {:.3} Y {:.3} Z {:.3}",
                if to.feed { "in feed" } else { "between the cuts" },
                to.linear.x,
                to.linear.y,
                to.linear.z
            ));
            break;
        }
    }
    wrong
}

fn turned(from: &Row, to: &Row) -> f64 {
    let axes = from.rotary.iter().zip(&to.rotary);
    axes.map(|(from, to)| (to - from).abs()).fold(0.0, f64::max)
}

/// The machine file, with the two tools and feeds by which a run takes seconds.
fn fast(machine: &Machine) -> String {
    let mut text = format!("extends = {:?}\n", machine.file);
    text += &format!(
        "[workpiece]\nmount = [0, 0, {}]\n[tools]\n1 = {}\n2 = {}\n",
        machine.part, TOOLS[0], TOOLS[1]
    );
    for axis in ['X', 'Y', 'Z'] {
        text += &format!("[axis.{axis}]\nmax_feed = {LINEAR}\n");
    }
    for axis in [machine.tilting, 'C'] {
        text += &format!("[axis.{axis}]\nmax_feed = {ROTARY}\n");
    }
    text
}

/// Posts [`TWO_TOOLS`], and judges runs of it; whether TCP is still on at the start has nothing to do with how rapids are
/// written.
fn two_tools_on(machine: &Machine) {
    if shared("linuxcnc/run").is_none() {
        return;
    }
    let cases = vec![
        ("control", "rapid", false),
        ("control", "rapid", true),
        ("control", "linear", false),
        ("post", "rapid", false),
        ("post", "rapid", true),
    ];
    at_once(cases, |(tcp, rapid, tcp_on)| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("fast.toml"), fast(machine)).unwrap();
        fs::write(folder.path().join("two.cls"), TWO_TOOLS).unwrap();
        let rapids = format!("control.rapid={rapid:?}");
        let arguments = ["-m", "fast.toml", "--tcp", tcp, "--set", &rapids, "two.cls"];
        let texts = ["-o", "two.ngc", "--summary", "two.json"];
        let done = run(command().current_dir(folder.path()).args(arguments).args(texts), b"");
        assert_eq!(done.code, 0, "{}", done.err);
        let summary = read_json(&folder.path().join("two.json"));
        let told = summary["fast_rapids"]["count"].as_u64().unwrap();
        assert!(told == 0 || rapid == "rapid");
        let begin = Begin { tcp_on, ..Begin::aside(machine) };
        let program = folder.path().join("two.ngc");
        run_until_good(machine, &program, &begin, |rows| {
            if rows.iter().filter(|row| row.feed).count() <= 500 {
                return Err("it hardly cuts".to_owned());
            }
            // What the summary does not name holds in rapids as in feeds.
            let wrong = judge(machine, rows, told == 0);
            let start = if tcp_on { "TCP still on" } else { "a cold start" };
            match wrong.is_empty() {
                true => Ok(()),
                false => Err(format!(
                    "{}, tcp = {tcp}, rapids {rapid}, {told} told of, from {start}: {wrong:#?}",
                    machine.file
                )),
            }
        });
    });
}

#[test]
fn two_tools_on_a_table_that_tilts_about_x() {
    two_tools_on(&MACHINES[0]);
}

#[test]
fn two_tools_on_a_table_that_tilts_about_y() {
    two_tools_on(&MACHINES[1]);
}

#[test]
fn two_tools_on_a_fork_head() {
    two_tools_on(&MACHINES[2]);
}
