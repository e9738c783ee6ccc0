//! Programs of robots: what they lead the joints to, by the law that is published for such arms, and read back.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use tempfile::TempDir;

use crate::common::{Run, command, run};
use crate::plugins::built;

/// Lengths a1, a2, b, c1, c2, c3, c4 of a Stäubli TX40 beside those of no maker: all of them count.
const ARMS: [[f64; 7]; 2] = [
    [150.0, -115.0, 20.0, 445.0, 700.0, 795.0, 85.0],
    [0.0, 30.0, 35.0, 320.0, 525.0, 525.0, 65.0],
];

const TOOL: f64 = 80.0;

/// Points beside one another, the tool leaning to all sides.
const POINTS: [[f64; 6]; 5] = [
    [-60.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    [-20.0, 15.0, 5.0, 0.2, 0.1, 0.97],
    [0.0, 20.0, 0.0, -0.15, 0.2, 0.96],
    [30.0, 10.0, -5.0, 0.1, -0.25, 0.95],
    [60.0, 0.0, 0.0, 0.0, 0.0, 1.0],
];

fn cl() -> String {
    let goto = |[x, y, z, i, j, k]: [f64; 6]| format!("GOTO/{x},{y},{z},{i},{j},{k}\n");
    let cuts: String = POINTS.into_iter().map(goto).collect();
    format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nCOOLNT/FLOOD\nRAPID\nGOTO/-60,0,40,0,0,1\nFEDRAT/800,MMPM\n{cuts}DELAY/1.5\nSTOP\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/60,0,40,0,0,1\nSPINDL/OFF\nFINI\n"
    )
}

fn post(folder: &Path, arguments: &[&str]) -> Run {
    run(command().current_dir(folder).args(arguments), b"")
}

/// A folder with the machine file of an arm, a CL file, and the plugin of a language.
fn folder(arm: &[f64; 7], dialect: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let library = format!("{DLL_PREFIX}post_{dialect}{DLL_SUFFIX}");
    fs::copy(built(dialect), folder.path().join(library)).unwrap();
    fs::write(folder.path().join("part.cls"), cl()).unwrap();
    let lengths = arm.map(|length| length.to_string()).join(",");
    let new = post(folder.path(), &["new", "arm", "--class", "robot", "--arm", &lengths]);
    assert_eq!((new.code, new.err.as_str()), (0, ""));
    folder
}

/// What every command is told of the language.
fn with(dialect: &str) -> Vec<&str> {
    let tool = "80";
    vec!["-q", "-m", "arm.toml", "--plugins", ".", "--dialect", dialect, "--tool-length", tool]
}

/// Tip (mm, from the foot of the arm) and direction to the holder, by the law of arms with a parallel shoulder and a
/// spherical wrist; joints in degrees.
fn opw([a1, a2, b, c1, c2, c3, c4]: [f64; 7], degrees: [f64; 6]) -> (Vector3<f64>, Vector3<f64>) {
    let [t1, t2, t3, t4, t5, t6] = degrees.map(f64::to_radians);
    let (psi, k) = (libm::atan2(a2, c3), libm::hypot(a2, c3));
    let out = c2 * libm::sin(t2) + k * libm::sin(t2 + t3 + psi) + a1;
    let up = c2 * libm::cos(t2) + k * libm::cos(t2 + t3 + psi) + c1;
    let about_z = |angle| Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    let about_y = |angle| Rotation3::from_axis_angle(&Vector3::y_axis(), angle);
    let wrist = about_z(t1) * Vector3::new(out, b, up);
    let turn = about_z(t1) * about_y(t2 + t3) * about_z(t4) * about_y(t5) * about_z(t6);
    let along = turn * Vector3::z();
    (wrist + along * (c4 + TOOL), -along)
}

/// Six numbers, those behind `d2r(` or in the first list of a line.
fn joints(line: &str) -> Option<[f64; 6]> {
    let list = match line.trim().strip_prefix("MoveAbsJ [[") {
        Some(list) => list.split(']').next()?.to_owned(),
        None => {
            let list = line.trim().strip_prefix("movej([")?.split(']').next()?;
            list.replace("d2r(", "").replace(')', "")
        }
    };
    let numbers: Vec<f64> = list.split(',').map(|part| part.trim().parse().unwrap()).collect();
    numbers.try_into().ok()
}

/// Where the part stands, by the machine file.
fn mount(folder: &Path) -> Vector3<f64> {
    let text = fs::read_to_string(folder.join("arm.toml")).unwrap();
    let line = text.lines().find(|line| line.starts_with("mount = [")).unwrap();
    let inside = line.split(['[', ']']).nth(1).unwrap();
    let numbers: Vec<f64> = inside.split(',').map(|part| part.trim().parse().unwrap()).collect();
    Vector3::from_column_slice(&numbers)
}

/// The program leads the joints so that the arm of the published law stands on each CL point; what lies between is within
/// tolerance of the straight way; and `verify` finds nothing wrong.
#[test]
fn joints_are_led_as_the_published_law_has_them_and_read_back() {
    for arm in ARMS {
        for (dialect, file) in [("rapid", "part.mod"), ("urscript", "part.script")] {
            let folder = folder(&arm, dialect);
            let path = folder.path();
            let posted = post(path, &[&["part.cls", "-o", file], &with(dialect)[..]].concat());
            assert_eq!(posted.code, 0, "{dialect}: {}", posted.err);
            let program = fs::read_to_string(path.join(file)).unwrap();
            let mount = mount(path);
            let stands: Vec<(Vector3<f64>, Vector3<f64>)> = program
                .lines()
                .filter_map(joints)
                .map(|joints| opw(arm, joints))
                .map(|(tip, axis)| (tip - mount, axis))
                .collect();
            assert!(stands.len() > POINTS.len(), "{program}");
            for [x, y, z, i, j, k] in POINTS {
                let (tip, axis) = (Vector3::new(x, y, z), Vector3::new(i, j, k).normalize());
                let near = |(t, a): &(Vector3<f64>, Vector3<f64>)| {
                    (t - tip).norm() < 0.01 && (a - axis).norm() < 1e-4
                };
                assert!(stands.iter().any(near), "{dialect}: {tip:?} in\n{program}");
            }
            let verify = |name: &str| {
                let against = [&["verify", name, "--against", "part.cls"], &with(dialect)[..]];
                post(path, &against.concat())
            };
            let read = verify(file);
            assert_eq!((read.code, read.err.as_str()), (0, ""), "{dialect}: {}", read.out);
            // A tenth of a degree in one joint of one cut.
            let lines: Vec<&str> = program.lines().collect();
            let cut =
                lines.iter().rposition(|line| line.contains("\\T:=") || line.contains(", t="));
            let cut = cut.unwrap();
            let first = joints(lines[cut]).unwrap()[0];
            let mut other: Vec<String> = lines.iter().map(ToString::to_string).collect();
            other[cut] =
                lines[cut].replacen(&format!("{first:.4}"), &format!("{:.4}", first + 0.1), 1);
            assert_ne!(other[cut], lines[cut]);
            let other = other.join("\n") + "\n";
            fs::write(path.join("other.txt"), &other).unwrap();
            assert_eq!(verify("other.txt").code, 1, "{dialect}");
        }
    }
}

/// Statements that might move the arm, or leave the joints elsewhere, are told by their line.
#[test]
fn what_is_not_read_is_refused() {
    let folder = folder(&ARMS[0], "rapid");
    let path = folder.path();
    let posted = post(path, &[&["part.cls", "-o", "part.mod"], &with("rapid")[..]].concat());
    assert_eq!(posted.code, 0, "{}", posted.err);
    let program = fs::read_to_string(path.join("part.mod")).unwrap();
    let target = "[[800,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let cases = [
        (format!("MoveL {target},v100,fine,tool0;"), "MOVEL goes to a pose"),
        ("Grip 5;".to_owned(), "GRIP is no statement that is known here"),
        ("MoveAbsJ home,vmax,fine,tool0;".to_owned(), "positions of MOVEABSJ"),
        (
            "MoveAbsJ [[0,0,0,0,30,0],[1500,9E9,9E9,9E9,9E9,9E9]],vmax,fine,tool0;".to_owned(),
            "no axis 7",
        ),
        (
            "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],fast,fine,tool0;".to_owned(),
            "FAST of MOVEABSJ",
        ),
        ("MoveAbsJ [[0,0,0,0,30,0],[9E9".to_owned(), "not closed in its line"),
        ("Stop; Stop;".to_owned(), "more than one statement"),
    ];
    for (line, said) in cases {
        let at = program.find("SpindleCw").unwrap();
        let other = format!("{}{line}\n{}", &program[..at], &program[at..]);
        fs::write(path.join("other.mod"), other).unwrap();
        let verify = ["verify", "other.mod", "--against", "part.cls"];
        let read = post(path, &[&verify, &with("rapid")[..]].concat());
        let all = format!("{}{}", read.out, read.err);
        assert_eq!(read.code, 1, "{line}: {all}");
        assert!(all.contains(said), "{line}: {all}");
    }
}
