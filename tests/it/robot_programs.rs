//! Programs of robots: what they lead the joints to, by the law that is published for such arms, and read back.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, Rotation3, Vector3};
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
    let file = folder.path().join("arm.toml");
    let text = fs::read_to_string(&file).unwrap();
    let own = text.replace("dialect = \"fanuc\"", &format!("dialect = \"{dialect}\""));
    assert_ne!(own, text);
    fs::write(file, own).unwrap();
    folder
}

/// What every command is told of the machine.
const WITH: [&str; 7] = ["-q", "-m", "arm.toml", "--plugins", ".", "--tool-length", "80"];

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
            let posted = post(path, &[&["part.cls", "-o", file][..], &WITH].concat());
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
                let against = [&["verify", name, "--against", "part.cls"][..], &WITH];
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
    let posted = post(path, &[&["part.cls", "-o", "part.mod"][..], &WITH].concat());
    assert_eq!(posted.code, 0, "{}", posted.err);
    let program = fs::read_to_string(path.join("part.mod")).unwrap();
    let target = "[[8000,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    let cases = [
        (format!("MoveL {target},vmax,fine,tool0;"), "MOVEL does not say how fast"),
        (format!("MoveL {target},v100,fine,tool0;"), "the joints do not reach the pose of MOVEL"),
        (format!("MoveC {target},{target},v100,fine,tool0;"), "no straight move"),
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
        let read = post(path, &[&verify[..], &WITH].concat());
        let all = format!("{}{}", read.out, read.err);
        assert_eq!(read.code, 1, "{line}: {all}");
        assert!(all.contains(said), "{line}: {all}");
    }
}

/// What a program of straight moves says: where the tip is led to (mm, from the foot of the arm), and how the frame of the
/// tool is turned there.
fn poses(program: &str) -> Vec<(Vector3<f64>, Matrix3<f64>)> {
    let list = |text: &str| -> Vec<f64> {
        text.split([',', '[', ']', ' ', '{', '}', 'p', '('])
            .filter_map(|part| {
                part.trim_start_matches(|c: char| c.is_ascii_uppercase()).parse().ok()
            })
            .collect()
    };
    let about = |axis: Vector3<f64>, angle: f64| {
        let k = axis.cross_matrix();
        Matrix3::identity() + k * libm::sin(angle) + k * k * (1.0 - libm::cos(angle))
    };
    let mut found = Vec::new();
    for line in program.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix("MoveL [[") {
            let all = list(rest.split(",v1000").next().unwrap());
            let (w, v) = (all[3], Vector3::new(all[4], all[5], all[6]));
            let k = v.cross_matrix();
            let turn = Matrix3::identity() + k * (2.0 * w) + k * k * 2.0;
            found.push((Vector3::new(all[0], all[1], all[2]), turn));
        } else if let Some(rest) = line.strip_prefix("movel(p[") {
            let all = list(rest.split(']').next().unwrap());
            let turn = Vector3::new(all[3], all[4], all[5]);
            let turned = about(turn.normalize(), turn.norm());
            found.push((Vector3::new(all[0], all[1], all[2]) * 1000.0, turned));
        } else if let Some(rest) = line.strip_prefix("LIN {") {
            let value = |name: &str| {
                let part = rest.split([',', '}']).find_map(|part| part.strip_prefix(name)).unwrap();
                part.trim().parse::<f64>().unwrap()
            };
            let [a, b, c] = ["A", "B", "C"].map(|name| value(name).to_radians());
            let turn = about(Vector3::z(), a) * about(Vector3::y(), b) * about(Vector3::x(), c);
            found.push((Vector3::new(value("X "), value("Y "), value("Z ")), turn));
        }
    }
    found
}

/// Straight moves lead the tool from point to point of the CL file, and turned evenly between two poses it is within
/// tolerance of what the CL file asks for halfway; `verify` reads them, and finds a tenth of a millimetre.
#[test]
fn tools_are_led_straight_and_read_back() {
    for arm in ARMS {
        let languages = [("rapid", "part.mod"), ("urscript", "part.script"), ("krl", "part.src")];
        for (dialect, file) in languages {
            let folder = folder(&arm, dialect);
            let path = folder.path();
            let mut with = WITH.to_vec();
            with.extend(["--set", "control.moves=\"straight\""]);
            if dialect == "rapid" {
                with.extend(["--set", "control.rapid.tool=\"spindle\""]);
            }
            let posted = post(path, &[&["part.cls", "-o", file][..], &with[..]].concat());
            assert_eq!(posted.code, 0, "{dialect}: {}", posted.err);
            let program = fs::read_to_string(path.join(file)).unwrap();
            let mount = mount(path);
            let poses = poses(&program);
            assert!(poses.len() >= POINTS.len(), "{program}");
            let mut at = 0;
            for [x, y, z, i, j, k] in POINTS.into_iter().skip(1) {
                let (tip, axis) = (Vector3::new(x, y, z), Vector3::new(i, j, k).normalize());
                let near = |(t, turn): &(Vector3<f64>, Matrix3<f64>)| {
                    (t - mount - tip).norm() < 0.01 && (turn.column(2) + axis).norm() < 1e-4
                };
                let found = poses[at..].iter().position(near);
                at += found.unwrap_or_else(|| panic!("{dialect}: {tip:?} in\n{program}"));
            }
            // From point to point in all: so the poses between lie on the straight ways.
            let path_of = |t: Vector3<f64>| {
                let ways = POINTS.windows(2).map(|pair| {
                    let [from, to] = [0, 1].map(|end| Vector3::from_column_slice(&pair[end][..3]));
                    let share =
                        ((t - from).dot(&(to - from)) / (to - from).norm_squared()).clamp(0.0, 1.0);
                    let [a, b] =
                        [0, 1].map(|end| Vector3::from_column_slice(&pair[end][3..]).normalize());
                    let sweep = libm::acos(a.dot(&b).clamp(-1.0, 1.0));
                    let axis = match sweep < 1e-6 {
                        true => a,
                        false => {
                            (a * libm::sin((1.0 - share) * sweep) + b * libm::sin(share * sweep))
                                / libm::sin(sweep)
                        }
                    };
                    ((t - from - (to - from) * share).norm(), axis)
                });
                ways.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
            };
            for pair in poses.windows(2) {
                let [(from, first), (to, last)] = [pair[0], pair[1]];
                let turn = Rotation3::from_matrix_unchecked(last * first.transpose());
                let half = turn.powf(0.5) * first;
                let (off, axis) = path_of((from + to) / 2.0 - mount);
                // Tolerances of the file: 0.05 mm, and a tenth of a degree or less.
                assert!(off < 0.051, "{dialect}: {off}");
                assert!(
                    (half.column(2) + axis).norm() < 0.1f64.to_radians(),
                    "{dialect}: {axis:?}"
                );
            }
            let verify = |name: &str| {
                let against = [&["verify", name, "--against", "part.cls"][..], &with[..]];
                post(path, &against.concat())
            };
            let read = verify(file);
            assert_eq!((read.code, read.err.as_str()), (0, ""), "{dialect}: {}", read.out);
            // A tenth of a millimetre and more across one cut.
            let (tip, _) = poses[poses.len() / 2];
            let (old, new) = match dialect {
                "urscript" => {
                    (format!("{:.7}", tip.z / 1000.0), format!("{:.7}", tip.z / 1000.0 + 0.0002))
                }
                _ => (format!("{:.4}", tip.z), format!("{:.4}", tip.z + 0.2)),
            };
            let other = program.replacen(&old, &new, 1);
            assert_ne!(other, program);
            fs::write(path.join("other.txt"), &other).unwrap();
            assert_eq!(verify("other.txt").code, 1, "{dialect}");
        }
    }
}

/// Where a language, a machine or a tool cannot be led straight, it is said.
#[test]
fn what_cannot_be_led_straight_is_refused() {
    let straight = ["--set", "control.moves=\"straight\""];
    let folder = folder(&ARMS[0], "rapid");
    let refused = |arguments: &[&str], said: &str| {
        let run =
            post(folder.path(), &[&["part.cls", "-o", "-"][..], arguments, &straight].concat());
        assert_eq!(run.code, 1, "{said}");
        assert!(run.err.contains(said), "{}", run.err);
    };
    let fanuc = [&WITH[..], &["--dialect", "fanuc"]].concat();
    refused(&fanuc, "the dialect fanuc has no poses");
    refused(&WITH, "tool0 is none");
    let rail =
        ["-m", "irb4600-rail", "--plugins", ".", "--dialect", "rapid", "--tool-length", "80"];
    refused(&rail, "an arm of six axes alone");
}
