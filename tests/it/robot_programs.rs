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
    let [t1, t2, t3, ..] = degrees.map(f64::to_radians);
    let (psi, k) = (libm::atan2(a2, c3), libm::hypot(a2, c3));
    let out = c2 * libm::sin(t2) + k * libm::sin(t2 + t3 + psi) + a1;
    let up = c2 * libm::cos(t2) + k * libm::cos(t2 + t3 + psi) + c1;
    let wrist = about_z(t1) * Vector3::new(out, b, up);
    let along = flange(degrees) * Vector3::z();
    (wrist + along * (c4 + TOOL), -along)
}

fn about_z(angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), angle)
}

/// How the flange is turned, by the same law: its Z from the spindle to the tip, its X along X at zero.
fn flange(degrees: [f64; 6]) -> Rotation3<f64> {
    let about_y = |angle| Rotation3::from_axis_angle(&Vector3::y_axis(), angle);
    let [t1, t2, t3, t4, t5, t6] = degrees.map(f64::to_radians);
    about_z(t1) * about_y(t2 + t3) * about_z(t4) * about_y(t5) * about_z(t6)
}

/// Six numbers, those behind `d2r(`, in the first list of a line or in braces.
fn joints(line: &str) -> Option<[f64; 6]> {
    let line = line.trim();
    let list = if let Some(list) = line.strip_prefix("MoveAbsJ [[") {
        list.split(']').next()?.to_owned()
    } else if let Some(list) = line.strip_prefix("PTP {") {
        let values = list.trim_end_matches('}').split(',');
        values.filter_map(|value| value.split(' ').nth(1)).collect::<Vec<_>>().join(",")
    } else {
        let list = line.strip_prefix("movej([")?.split(']').next()?;
        list.replace("d2r(", "").replace(')', "")
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
            // What axes beside the arm are written as that it has not, and what a straight move does not look at.
            let (old, said, moved) = match dialect {
                "krl" => ("}", ",S 6,T 27,E1 0,E2 0}", ",E1 5}"),
                "rapid" => ("[9E9,", "[0,", "[5,"),
                _ => ("", "", ""),
            };
            if !old.is_empty() {
                assert!(program.contains(old), "{program}");
                for (said, code) in [(said, 0), (moved, 1)] {
                    let lines = program.lines().map(|line| {
                        match line.trim_start().starts_with(['L', 'M']) {
                            true => line.replace(old, said) + "\n",
                            false => line.to_owned() + "\n",
                        }
                    });
                    fs::write(path.join("other.txt"), lines.collect::<String>()).unwrap();
                    let read = verify("other.txt");
                    assert_eq!(read.code, code, "{dialect} {said}: {}", read.err);
                }
            }
            if dialect == "krl" {
                for (command, code) in [("#ACC_ORI,50", 0), ("#OTHER,50", 1)] {
                    let other = program.replacen("LIN ", &format!("BAS ({command})\nLIN "), 1);
                    fs::write(path.join("other.txt"), other).unwrap();
                    let read = verify("other.txt");
                    assert_eq!(read.code, code, "{command}: {}", read.err);
                }
            }
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

/// A program of straight moves in a language, posted in a folder.
fn straight(dialect: &str, file: &str) -> (TempDir, Vec<&'static str>, String) {
    let folder = folder(&ARMS[0], dialect);
    let mut with = WITH.to_vec();
    with.extend(["--set", "control.moves=\"straight\""]);
    if dialect == "rapid" {
        with.extend(["--set", "control.rapid.tool=\"spindle\""]);
    }
    let posted = post(folder.path(), &[&["part.cls", "-o", file][..], &with[..]].concat());
    assert_eq!(posted.code, 0, "{dialect}: {}", posted.err);
    let program = fs::read_to_string(folder.path().join(file)).unwrap();
    (folder, with, program)
}

/// Poses are those of the machine file only with its tool, in its frame: another one is found at the first move that goes by
/// it, whenever the program sets it, and what it leaves to the control is told.
#[test]
fn tool_and_frame_of_straight_moves_are_those_of_the_machine_file() {
    let tool = "error[nc-modes]: the frame of the tool is";
    let base = "error[nc-modes]: the frame of poses is";
    let unset_tool = "the program does not set the frame of the tool (";
    let unset_base = "the program does not set the frame of poses (";
    // What is written in place of what; a line ahead of the last straight move where that is nothing.
    let cases: [(&str, &str, &str, &str); 20] = [
        ("rapid", "fine,spindle;", "fine,other;", tool),
        ("rapid", "fine,spindle;", "fine,tool0;", tool),
        ("rapid", "fine,spindle;", "fine,spindle\\WObj:=fixture;", base),
        ("rapid", "fine,spindle;", "fine,spindle\\WObj:=wobj0;", ""),
        ("rapid", "fine,spindle;", "fine,spindle\\Corr;", "a switch behind the tool of MOVEL"),
        ("krl", "$TOOL=TOOL_DATA[1]", "$TOOL=TOOL_DATA[7]", tool),
        ("krl", "$BASE=$NULLFRAME", "$BASE=BASE_DATA[2]", base),
        ("krl", "$TOOL=TOOL_DATA[1]", "BAS(#TOOL,1)", ""),
        ("krl", "$BASE=$NULLFRAME", "BAS(#BASE,0)", ""),
        ("krl", "$TOOL=TOOL_DATA[1]\n", "", unset_tool),
        ("krl", "$BASE=$NULLFRAME\n", "", unset_base),
        ("krl", "", "$TOOL=TOOL_DATA[7]", tool),
        ("krl", "", "$TOOL=$NULLFRAME", tool),
        ("krl", "", "BAS(#TOOL,3)", tool),
        ("krl", "", "BAS(#BASE,1)", base),
        ("krl", "", "$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}", base),
        ("krl", "", "BAS(#INITMOV,0)", unset_tool),
        ("krl", "", "BAS(#VEL_PTP,50)", ""),
        ("krl", "BAS(#INITMOV,0)", "BAS(#VEL_CP,2)", "BAS(#VEL_CP) sets speeds"),
        ("urscript", "", "  set_tcp(p[0,0,0.1,0,0,0])", tool),
    ];
    for (dialect, file, begins) in [
        ("rapid", "part.mod", "MoveL "),
        ("urscript", "part.script", "  movel("),
        ("krl", "part.src", "LIN "),
    ] {
        let (folder, with, program) = straight(dialect, file);
        let path = folder.path();
        let last = program.rfind(begins).unwrap();
        let (ahead, behind) = program.split_at(last);
        let verify = |text: &str| {
            fs::write(path.join("other.txt"), text).unwrap();
            let against = ["verify", "other.txt", "--against", "part.cls", "--posted"];
            post(path, &[&against[..], &with[..]].concat())
        };
        for (_, from, to, says) in cases.iter().filter(|case| case.0 == dialect) {
            // Of RAPID the moves say it, of others what stands ahead of them.
            let other = match (from.is_empty(), dialect) {
                (true, _) => format!("{ahead}{to}\n{behind}"),
                (false, "rapid") => format!("{ahead}{}", behind.replacen(from, to, 1)),
                (false, _) => program.replacen(from, to, 1),
            };
            assert_ne!(other, program, "{from}");
            let read = verify(&other);
            let code = i32::from(!says.is_empty());
            let told = read.code == code && read.err.contains(says);
            assert!(told, "{dialect} {from} {to}: {} {}", read.code, read.err);
            if says.is_empty() {
                assert_eq!(read.err, "", "{from} {to}");
            } else if from.is_empty() || dialect == "rapid" {
                // At the line of the move that goes by it.
                let line = other[..other.rfind(begins).unwrap()].lines().count() + 1;
                assert!(read.err.contains(&format!("other.txt:{line}")), "{to}: {}", read.err);
            }
        }
        if dialect == "rapid" {
            // Watched, as after each start, the arm stops where a pose says another configuration.
            let free = "ConfL \\Off;";
            let unset = verify(&program.replacen(free, "", 1));
            let says =
                "the program does not set any configuration for straight moves (ConfL \\Off)";
            assert!(unset.code == 1 && unset.err.contains(says), "{}", unset.err);
            let watched = verify(&program.replacen(free, "ConfL \\On;", 1));
            let says = "CONFL is not run";
            assert!(watched.code == 1 && watched.err.contains(says), "{}", watched.err);
            // A quaternion of twice the length.
            let list = behind.split(['[', ']']).nth(4).unwrap();
            let parts = list.split(',').map(|part| 2.0 * part.parse::<f64>().unwrap());
            let twice: Vec<String> = parts.map(|part| part.to_string()).collect();
            let read = verify(&format!("{ahead}{}", behind.replacen(list, &twice.join(","), 1)));
            let says = "the quaternion of MOVEL is 2.0000 long";
            assert!(read.code == 1 && read.err.contains(says), "{}", read.err);
        }
    }
}

/// A tool that is led straight turns evenly about one direction, and where it turns about itself too its axis leaves the
/// great circle between two points: a program without the points that hold it there is found, by as much as it strays.
#[test]
fn a_tool_axis_that_strays_between_poses_is_found() {
    let leaning = |degrees: f64, about: f64| {
        let (lean, to) = (degrees.to_radians(), about.to_radians());
        [libm::sin(lean) * libm::cos(to), libm::sin(lean) * libm::sin(to), libm::cos(lean)]
    };
    let [first, last] = [leaning(25.0, 200.0), leaning(25.0, 290.0)];
    let goto = |x: f64, [i, j, k]: [f64; 3]| format!("GOTO/{x},0,0,{i:.9},{j:.9},{k:.9}\n");
    let cl = format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/-20,0,40,0,0,1\nRAPID\n{}FEDRAT/800,MMPM\n{}SPINDL/OFF\nFINI\n",
        goto(-20.0, first),
        goto(20.0, last),
    );
    for (dialect, file, begins) in [
        ("rapid", "part.mod", "MoveL "),
        ("urscript", "part.script", "movel("),
        ("krl", "part.src", "LIN "),
    ] {
        let folder = folder(&ARMS[0], dialect);
        let path = folder.path();
        fs::write(path.join("part.cls"), &cl).unwrap();
        let mut with = WITH.to_vec();
        with.extend([
            "--set",
            "control.moves=\"straight\"",
            "--set",
            "accuracy.axis_tolerance=0.05",
        ]);
        if dialect == "rapid" {
            with.extend(["--set", "control.rapid.tool=\"spindle\""]);
        }
        let posted = post(path, &[&["part.cls", "-o", file][..], &with[..]].concat());
        assert_eq!(posted.code, 0, "{dialect}: {}", posted.err);
        let program = fs::read_to_string(path.join(file)).unwrap();
        let verify = |name: &str| {
            let against =
                [&["verify", name, "--against", "part.cls", "--summary", "-"][..], &with[..]];
            let read = post(path, &against.concat());
            let told: serde_json::Value = serde_json::from_str(&read.out).unwrap();
            (read.code, told["axis"]["value"].as_f64().unwrap(), told)
        };
        let (code, kept, _) = verify(file);
        assert!(code == 0 && kept <= 0.05, "{dialect}: {code} {kept}");
        // The last pose alone.
        let cuts = program.lines().filter(|line| line.trim().starts_with(begins)).count();
        assert!(cuts > 2, "{program}");
        let mut left = cuts;
        let sparse = program.lines().filter(|line| {
            let cut = line.trim().starts_with(begins);
            left -= usize::from(cut);
            !cut || left == 0
        });
        let sparse: String = sparse.map(|line| format!("{line}\n")).collect();
        fs::write(path.join("sparse.txt"), sparse).unwrap();
        // From the frame where the cut begins, which the joints before it tell.
        let at = program[..program.find(begins).unwrap()]
            .lines()
            .filter_map(joints)
            .next_back()
            .unwrap();
        let from = *flange(at).matrix();
        let (_, to) = *poses(&program).last().unwrap();
        let whole = Rotation3::from_matrix_unchecked(to * from.transpose());
        let circle = Vector3::from(first).cross(&Vector3::from(last)).normalize();
        let strays = (1..100).map(|share| {
            let axis = -(whole.powf(f64::from(share) / 100.0) * from.column(2));
            libm::asin(axis.dot(&circle).abs()).to_degrees()
        });
        let strays = strays.fold(0.0, f64::max);
        assert!(strays > 0.2, "{dialect}: {strays}");
        let (code, found, told) = verify("sparse.txt");
        assert_eq!(code, 1, "{dialect}: {told}");
        assert!((found - strays).abs() < 0.05 * strays, "{dialect}: {found} and {strays}");
    }
}

/// A rail goes evenly beside an arm that leads its tool straight: poses stay those of the machine, the rail stands where the
/// arm reaches them, and a rail that stays behind is found.
#[test]
fn a_rail_goes_along_in_straight_moves() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/0,-2400,40,0,0,1\nFEDRAT/6000,MMPM\nGOTO/0,-2400,0,0,0,1\nGOTO/0,0,0,0.1,0,0.99\nGOTO/0,2400,0,0,0,1\nRAPID\nGOTO/0,2400,40,0,0,1\nSPINDL/OFF\nFINI\n";
    for (dialect, file, begins) in [("rapid", "part.mod", "MoveL "), ("krl", "part.src", "LIN ")] {
        let folder = folder(&ARMS[0], dialect);
        let path = folder.path();
        fs::write(path.join("part.cls"), cl).unwrap();
        let mut with = vec!["-q", "-m", "irb4600-rail", "--plugins", ".", "--tool-length", "80"];
        with.extend(["--dialect", dialect, "--set", "control.moves=\"straight\""]);
        if dialect == "rapid" {
            with.extend(["--set", "control.rapid.tool=\"spindle\""]);
        }
        let posted = post(path, &[&["part.cls", "-o", file][..], &with].concat());
        assert_eq!(posted.code, 0, "{dialect}: {}", posted.err);
        let program = fs::read_to_string(path.join(file)).unwrap();
        let cuts: Vec<&str> = program.lines().filter(|line| line.starts_with(begins)).collect();
        // Y of the machine is the second axis beside the arm.
        let rail = |line: &str| -> f64 {
            let value = match line.split_once("E2 ") {
                Some((_, behind)) => behind.split(['}', ',']).next().unwrap(),
                None => line.split("9E9,").nth(1).unwrap().split(',').next().unwrap(),
            };
            value.parse().unwrap()
        };
        let rails: Vec<f64> = cuts.iter().map(|line| rail(line)).collect();
        let spread = rails
            .iter()
            .fold([f64::MAX, f64::MIN], |[least, most], rail| [least.min(*rail), most.max(*rail)]);
        assert!(spread[1] - spread[0] > 1000.0, "{dialect}: {spread:?}");
        // 4.8 m are led along, and the arm reaches 2.05 m and its spindle.
        for ((tip, _), rail) in poses(&program).into_iter().zip(&rails) {
            assert!(libm::hypot(tip.y - rail, tip.x) < 2300.0, "{dialect}: {tip:?} from {rail}");
        }
        let verify = |name: &str| {
            let against = ["verify", name, "--against", "part.cls", "--posted"];
            post(path, &[&against[..], &with].concat())
        };
        let read = verify(file);
        assert_eq!(read.code, 0, "{dialect}: {}{}", read.out, read.err);
        let last = *cuts.last().unwrap();
        let behind = match dialect {
            "krl" => last.replace(&format!("E2 {:.3}", rail(last)), "E2 -3000.000"),
            _ => last.replace(&format!("9E9,{:.3}", rail(last)), "9E9,-3000.000"),
        };
        assert_ne!(behind, last);
        fs::write(path.join("other.txt"), program.replace(last, &behind)).unwrap();
        let read = verify("other.txt");
        let all = format!("{}{}", read.out, read.err);
        assert!(read.code == 1 && all.contains("do not reach the pose"), "{dialect}: {all}");
    }
}

/// A robot on a rail before a positioner of two axes: nine, of which the program leads each, and which are read back.
#[test]
fn a_robot_a_rail_and_a_positioner_are_nine_axes() {
    let folder = folder(&ARMS[0], "rapid");
    let cell = "extends = \"kr6-r700\"\nname = \"cell\"\nchain = \"[w E2' E1' b E3 A B C U V W (S) t]\"\n[workpiece]\nmount = [600, 0, 300]\n[axis.E1]\nrotary = [0, 1, 0]\npoint = [600, 0, 250]\ntravel = [-90, 90]\nmax_feed = 3600\n[axis.E2]\nrotary = [0, 0, 1]\npoint = [600, 0, 250]\ntravel = [-360, 360]\nmax_feed = 7200\n[axis.E3]\nlinear = [0, 1, 0]\ntravel = [-1000, 1000]\nmax_feed = 60000\n[control]\ndialect = \"rapid\"\n";
    let path = folder.path();
    fs::write(path.join("cell.toml"), cell).unwrap();
    let with = ["-q", "-m", "cell.toml", "--plugins", ".", "--tool-length", "60"];
    let posted = post(path, &[&["part.cls", "-o", "part.mod"][..], &with].concat());
    assert_eq!(posted.code, 0, "{}", posted.err);
    let program = fs::read_to_string(path.join("part.mod")).unwrap();
    let beside = |line: &str| line.split("],[").nth(1).map(|list| list.matches("9E9").count());
    let cuts: Vec<&str> = program.lines().filter(|line| line.contains("\\T:=")).collect();
    assert!(!cuts.is_empty() && cuts.iter().all(|line| beside(line) == Some(3)), "{program}");
    let read = |name: &str| {
        let against = ["verify", name, "--against", "part.cls", "--posted", "--summary", "-"];
        post(path, &[&against[..], &with].concat())
    };
    // Tolerance of the file 0.05 mm.
    let right = read("part.mod");
    let told: serde_json::Value = serde_json::from_str(&right.out).unwrap();
    let tip = told["tip"]["value"].as_f64().unwrap();
    assert!(tip > 0.0 && tip <= 0.05, "{tip}: {}", right.err);
    assert_eq!((right.code, right.err.as_str()), (0, ""));
    // The first rapid of all axes turns one of the wrist elsewhere, and the next leads it back.
    let first = |line: &&str| line.starts_with("MoveAbsJ [[") && line.contains(",vmax,");
    let turned = program.lines().find(first).unwrap();
    let wrist = turned.split("[[").nth(1).and_then(|joints| joints.split(',').nth(4)).unwrap();
    let value: f64 = wrist.parse().unwrap();
    let other = turned.replace(&format!(",{wrist},"), &format!(",{:.4},", value + 25.0));
    assert_ne!(other, turned);
    fs::write(path.join("other.mod"), program.replacen(turned, &other, 1)).unwrap();
    let wrong = read("other.mod");
    let found = wrong.code == 1 && wrong.err.contains("a rapid takes the tip");
    assert!(found, "{}", wrong.err);
}

/// KRL has the velocity of the tip, and a turn about a tip that stands none: in one block, however small, or in several.
#[test]
fn a_turn_about_a_standing_tip_has_no_velocity_of_the_tip() {
    let folder = folder(&ARMS[0], "krl");
    let path = folder.path();
    let begin = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/-20,0,40,0,0,1\nFEDRAT/800,MMPM\nGOTO/-20,0,0,0,0,1\n";
    let posted = |turn: &str| {
        let cl = format!("{begin}{turn}GOTO/20,0,0,0.2,0,1\nSPINDL/OFF\nFINI\n");
        fs::write(path.join("turn.cls"), cl).unwrap();
        let straight = ["--set", "control.moves=\"straight\""];
        post(path, &[&["turn.cls", "-o", "-"][..], &straight, &WITH].concat())
    };
    let at = |lean: f64| format!("GOTO/0,0,0,{lean},0,1\n");
    let leans: [&[f64]; 5] =
        [&[0.0, 0.002], &[0.0, 0.02], &[0.0, 0.2], &[0.0, 0.1, 0.2], &[0.0, 0.01, 0.02, 0.03]];
    for leans in leans {
        let turn: String = leans.iter().map(|lean| at(*lean)).collect();
        let refused = posted(&turn);
        let says = "the tool turns about its tip, which the velocity of a tip does not tell";
        assert!(refused.code == 1 && refused.err.contains(says), "{leans:?}: {}", refused.err);
        assert_eq!(refused.out, "");
    }
    // On its way it may turn as it likes, in steps as small as those of any CL file.
    let steps = (1..=40).map(|step| f64::from(step) * 0.02);
    let turn: String = steps.map(|x| format!("GOTO/{x:.3},0,0,{:.5},0,1\n", x / 100.0)).collect();
    let right = posted(&turn);
    assert_eq!(right.code, 0, "{}", right.err);
}

/// How straight moves tell where the tool points is asked for by name, and means them.
#[test]
fn the_form_of_an_orientation_is_asked_for_by_name() {
    let forms = [("rapid", "quaternion"), ("krl", "abc-zyx"), ("urscript", "rotation-vector")];
    for (dialect, form) in forms {
        let folder = folder(&ARMS[0], dialect);
        let written = |set: &str| {
            let tool = "control.rapid.tool=\"spindle\"";
            let tool = if dialect == "rapid" { &["--set", tool][..] } else { &[] };
            let set = ["part.cls", "-o", "-", "--set", set];
            post(folder.path(), &[&set[..], tool, &WITH].concat())
        };
        let straight = written("control.moves=\"straight\"");
        assert_eq!(straight.code, 0, "{dialect}: {}", straight.err);
        for (_, other) in forms {
            let named = written(&format!("control.orientation=\"{other}\""));
            if other == form {
                assert_eq!(
                    (named.code, &named.out),
                    (0, &straight.out),
                    "{dialect}: {}",
                    named.err
                );
            } else {
                assert_eq!(named.code, 1, "{dialect} {other}");
                let has = format!("it has \"axes\", \"{form}\"");
                assert!(named.err.contains(&has), "{}", named.err);
            }
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
    let positioner = "extends = \"kr6-r700\"\nchain = \"[w E1' b A B C U V W (S) t]\"\n[axis.E1]\nrotary = [0, 0, 1]\npoint = [420, 0, 0]\ntravel = [-180, 180]\n";
    fs::write(folder.path().join("positioner.toml"), positioner).unwrap();
    let arguments = ["-m", "positioner.toml", "--plugins", ".", "--dialect", "rapid"];
    refused(
        &[&arguments[..], &["--tool-length", "80"]].concat(),
        "axes that carry the part lead joints alone",
    );
}

/// A program of a robot that never takes its only tool is told, if it was posted: another hand may begin with it.
#[test]
fn a_tool_that_is_never_taken_is_told() {
    for (dialect, file, call) in [
        ("rapid", "part.mod", "ChangeTool"),
        ("krl", "part.src", "CHANGE_TOOL"),
        ("urscript", "part.script", "change_tool"),
    ] {
        let (folder, with, program) = straight(dialect, file);
        let calls = |line: &&str| line.to_lowercase().contains(&call.to_lowercase());
        assert_eq!(program.lines().filter(calls).count(), 1, "{program}");
        let without: Vec<&str> = program.lines().filter(|line| !calls(line)).collect();
        fs::write(folder.path().join("without"), without.join("\n") + "\n").unwrap();
        let verify = |name: &str, more: &[&str]| {
            let against = ["verify", name, "--against", "part.cls"];
            post(folder.path(), &[&against[..], more, &with].concat())
        };
        assert_eq!(verify(file, &["--posted"]).code, 0, "{dialect}");
        assert_eq!(verify("without", &[]).code, 0, "{dialect}");
        let told = verify("without", &["--posted"]);
        let says = "cuts with no tool changed in, and the CL file asks for 1";
        assert!(told.code == 1 && told.err.contains(says), "{dialect}: {}", told.err);
    }
}
