//! Errors that depend on position: the forward product against bodies that are moved by matrices, the inverse against the
//! forward product, and what is told of the way between two places against many places of it.

use nalgebra::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use post_machine::description::{Machine, load};
use post_machine::kinematics::{Joints, Pose};
use post_testkit::{Rng, randomised};
use post_testmachines::{angle, between};

use crate::source;

type V = Vector3<f64>;
type Frame = Isometry3<f64>;

const LENGTH: f64 = 80.0;

const CHAINS: [&str; 4] = [
    "[w X' Y' b Z (S) t]",
    "[w C' A' b Y X Z (S) t]",
    "[w b X Y Z C A (S) t]",
    "[w C' Y' b X Z A (S) t]",
];

/// What was measured of an axis: its values, mm or degrees, and the six errors, mm and mm/m.
struct Measured {
    places: Vec<f64>,
    errors: Vec<[f64; 6]>,
}

struct Erring {
    machine: Machine,
    /// None where the axis has no errors.
    measured: Vec<Option<Measured>>,
    points: Vec<V>,
}

impl Measured {
    fn at(&self, value: f64) -> [f64; 6] {
        let last = self.places.len() - 1;
        let value = value.clamp(self.places[0], self.places[last]);
        let after = (1..last).find(|place| value < self.places[*place]).unwrap_or(last);
        let [from, to] = [after - 1, after];
        let share = (value - self.places[from]) / (self.places[to] - self.places[from]);
        std::array::from_fn(|part| {
            self.errors[from][part] + share * (self.errors[to][part] - self.errors[from][part])
        })
    }
}

impl Erring {
    fn new(rng: &mut Rng) -> Self {
        let chain = CHAINS[rng.pick(CHAINS.len())];
        let mut text = format!(
            "name = \"erring\"\nchain = {chain:?}\n[tool]\ngauge = [3, -4, 400]\n[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n"
        );
        let mut tables = Vec::new();
        for name in ["X", "Y", "Z", "A", "C"].into_iter().filter(|name| chain.contains(name)) {
            let rotary = matches!(name, "A" | "C");
            text += &match name {
                "X" => "[axis.X]\nlinear = [1, 0.001, 0]\ntravel = [-400, 400]\n".to_owned(),
                "Y" => "[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-400, 400]\n".to_owned(),
                "Z" => "[axis.Z]\nlinear = [0, 0, 1]\ntravel = [-400, 400]\n".to_owned(),
                "A" => "[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 8, 170]\ntravel = [-120, 120]\n"
                    .to_owned(),
                _ => "[axis.C]\nrotary = [0, 0, 1]\npoint = [5, 6, 0]\ntravel = [-120, 120]\n"
                    .to_owned(),
            };
            if rng.pick(4) == 0 {
                continue;
            }
            let count = 2 + rng.pick(6);
            let half = if rotary { 125.0 } else { 420.0 };
            // None so near to the next that what changes between them is none of a machine.
            let gap = 2.0 * half / count as f64;
            let place = |place| gap * (f64::from(place) + rng.range(0.1, 0.9)) - half;
            let places: Vec<f64> = (0..count as u32).map(place).collect();
            let errors: Vec<[f64; 6]> = places
                .iter()
                .map(|_| std::array::from_fn(|_| rng.range(-0.02, 0.02) * 2.0))
                .collect();
            let point = (rng.pick(2) == 0).then(|| rng.point(200.0));
            let columns = ["X", "Y", "Z", "A", "B", "C"].map(|part| format!("\"E{part}{name}\""));
            text += &format!(
                "[error.{name}]\ncolumns = [\"{name}\", {}]\nrows = [",
                columns.join(", ")
            );
            for (place, errors) in places.iter().zip(&errors) {
                let errors = errors.map(|error| error.to_string());
                text += &format!("[{place}, {}],", errors.join(", "));
            }
            text += "]\n";
            if let Some(point) = point {
                text += &format!("point = [{}, {}, {}]\n", point.x, point.y, point.z);
            }
            tables.push((name, Measured { places, errors }, point));
        }
        let machine = load(source("erring.toml", &text), &[], &mut |_| Err(String::new())).unwrap();
        let mut measured: Vec<Option<Measured>> = machine.axes.iter().map(|_| None).collect();
        let mut points = vec![V::zeros(); measured.len()];
        for (name, table, point) in tables {
            let place = machine.axes.iter().position(|axis| axis.name == name).unwrap();
            let axis = &machine.axes[place];
            let usual = if axis.joint.rotary { axis.joint.point } else { machine.gauge };
            points[place] = point.unwrap_or(usual);
            measured[place] = Some(table);
        }
        Self { machine, measured, points }
    }

    fn stance(&self, rng: &mut Rng) -> Joints {
        let mut joints = Joints::default();
        for (value, axis) in joints.iter_mut().zip(&self.machine.axes) {
            let [least, most] = axis.travel.unwrap();
            *value = rng.range(least, most);
        }
        joints
    }

    /// How the body that an axis moves stands to the one that carries it, by how the tool would be seen to move.
    fn motion(&self, place: usize, value: f64) -> Frame {
        let axis = &self.machine.axes[place];
        let line = axis.joint.direction;
        let exact = match axis.joint.rotary {
            false => {
                Frame::from_parts(Translation3::from(line * value), UnitQuaternion::identity())
            }
            true => {
                let turn = UnitQuaternion::from_scaled_axis(line * value);
                let point = Point3::from(axis.joint.point);
                Frame::from_parts(Translation3::from(point - turn * point), turn)
            }
        };
        let Some(measured) = &self.measured[place] else {
            return exact;
        };
        let [x, y, z, a, b, c] = measured.at(axis.reading(value));
        let turn: UnitQuaternion<f64> = Rotation3::new(V::new(a, b, c) * 1e-3).into();
        let point = Point3::from(self.points[place]);
        let error =
            Frame::from_parts(Translation3::from(point + V::new(x, y, z) - turn * point), turn);
        // A slide's errors stand in what it moves, those of a shaft in what carries it. Of a part the tool is seen from what
        // is moved, so that the two change places.
        match (axis.joint.rotary, axis.carries_part) {
            (false, false) | (true, true) => exact * error,
            _ => error * exact,
        }
    }

    fn forward(&self, joints: &Joints) -> Pose {
        // The part stands to the bed as the axes that carry it have moved it, the tool likewise.
        let (mut part, mut tool) = (Frame::identity(), Frame::identity());
        for (place, axis) in self.machine.axes.iter().enumerate() {
            let motion = self.motion(place, joints[place]);
            match axis.carries_part {
                true => part = motion.inverse() * part,
                false => tool *= motion,
            }
        }
        let tip = self.machine.gauge - self.machine.tool_axis * LENGTH;
        let seen = part.inverse() * tool;
        Pose {
            tip: (seen * Point3::from(tip)).coords - self.machine.mount,
            axis: seen * self.machine.tool_axis,
            ..Pose::default()
        }
    }
}

#[test]
fn bodies_stand_where_their_errors_put_them() {
    let (rounds, mut rng) = randomised(400, 0xe77);
    for _ in rounds {
        let erring = Erring::new(&mut rng);
        let solver = erring.machine.solver(LENGTH).unwrap();
        for _ in 0..10 {
            let joints = erring.stance(&mut rng);
            let (own, expected) = (solver.chain().forward(&joints), erring.forward(&joints));
            assert!((own.tip - expected.tip).norm() < 1e-6, "{own:?} {expected:?}");
            assert!(angle(own.axis, expected.axis) < 1e-9);
            // The inverse: rotary axes as drawn, the linear ones where the tip stands.
            let mut found = joints;
            let turns = solver.chain().turns(&found);
            solver.place(expected.tip + V::new(0.3, -0.2, 0.1), &mut found, &turns).unwrap();
            let back = erring.forward(&found).tip - expected.tip - V::new(0.3, -0.2, 0.1);
            assert!(back.norm() < 1e-6, "{back}");
            let own = solver.chain().forward(&found).tip - expected.tip - V::new(0.3, -0.2, 0.1);
            assert!(own.norm() < 1e-8, "{own}");
        }
    }
}

#[test]
fn errors_bow_no_more_than_is_told() {
    let (rounds, mut rng) = randomised(400, 0xb0);
    let (mut told, mut seen) = (0.0, 0.0);
    for _ in rounds {
        let erring = Erring::new(&mut rng);
        let exact = Erring {
            measured: erring.measured.iter().map(|_| None).collect(),
            points: erring.points.clone(),
            machine: erring.machine.clone(),
        };
        let solver = erring.machine.solver(LENGTH).unwrap();
        let from = erring.stance(&mut rng);
        let size = [0.01, 0.1, 0.5][rng.pick(3)];
        let other = erring.stance(&mut rng);
        let to = between(&from, &other, size);
        let off = |share: f64| {
            let joints = between(&from, &to, share);
            erring.forward(&joints).tip - exact.forward(&joints).tip
        };
        let ends = [off(0.0), off(1.0)];
        let [bow, _] = solver.chain().error_bow([&from, &to], 3000.0);
        for step in 1..60 {
            let share = f64::from(step) / 60.0;
            let apart = (off(share) - ends[0].lerp(&ends[1], share)).norm();
            assert!(apart <= bow + 1e-9, "{apart} is seen, {bow} is told");
            seen = f64::max(seen, apart);
        }
        told += bow;
    }
    assert!(seen > 0.005 && told > 0.0, "{seen}");
}

#[test]
fn an_endless_axis_goes_on_from_its_last_place_to_its_first() {
    let text = "name = \"table\"\nchain = \"[w C' b X Y Z (S) t]\"\ntool.gauge = [0, 0, 0]\n[axis.X]\nlinear = [1, 0, 0]\ntravel = [-900, 900]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-900, 900]\n[axis.Z]\nlinear = [0, 0, 1]\ntravel = [-900, 900]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ncyclic = true\n[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n[error.C]\ncolumns = [\"C\", \"EZC\"]\nrows = [[0, 0], [180, 0.01], [270, 0.02]]\n";
    let machine = load(source("table.toml", text), &[], &mut |_| Err(String::new())).unwrap();
    let chain = machine.solver(0.0).unwrap().chain().clone();
    let c = machine.axes.iter().position(|axis| axis.name == "C").unwrap();
    for (degrees, height) in
        [(0.0, 0.0), (90.0, 0.005), (315.0, 0.01), (360.0, 0.0), (-45.0, 0.01), (810.0, 0.005)]
    {
        let mut joints = Joints::default();
        joints[c] = f64::to_radians(degrees);
        let own = chain.forward(&joints).tip.z;
        assert!((own - height).abs() < 1e-9, "{degrees}: {own}");
    }
    let [from, to] = [300.0, 420.0].map(|degrees: f64| {
        let mut joints = Joints::default();
        joints[c] = degrees.to_radians();
        joints
    });
    // Halfway, at 360 degrees, it is 0 and not the mean of both ends.
    let [bow, _] = chain.error_bow([&from, &to], 1.0);
    assert!(bow >= (0.02 / 3.0 * 2.0 + 0.01 / 3.0) / 2.0, "{bow}");
}

/// A mill with what stands behind `[error.X]`.
fn mill(rows: &str) -> Result<Machine, String> {
    let text = format!(
        "name = \"mill\"\nchain = \"[w b X Y Z (S) t]\"\ntool.gauge = [0, 0, 0]\n[axis.X]\nlinear = [1, 0, 0]\ntravel = [0, 500]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [0, 500]\n[axis.Z]\nlinear = [0, 0, 1]\ntravel = [0, 500]\n[control]\ndialect = \"fanuc\"\n[error.X]\n{rows}\n"
    );
    let machine = load(source("mill.toml", &text), &[], &mut |_| Err(String::new()));
    machine.map_err(|faults| faults[0].message.clone())
}

#[test]
fn a_table_from_a_file_is_the_table_in_the_machine_file() {
    let inline = mill("columns = [\"X\", \"EYX\", \"ECX\"]\nrows = [[0, 0, 1], [250, -4, 2.5], [500, 7, 0]]\nunits = \"um\"").unwrap();
    let mut filed = mill("file = \"x.csv\"\nunits = \"um\"").unwrap();
    assert!(filed.errors.is_empty());
    let table = filed.error_tables.pop().unwrap();
    filed
        .take_errors(&table, "\u{feff}# run of May\n\nX;EYX;ECX\n0;0;1\n250;-4;2.5\n500;7;0\n")
        .unwrap();
    assert_eq!(filed.errors, inline.errors);
    for (text, told) in [
        ("", "no rows"),
        ("X,EYX\n", "no rows"),
        ("X,EYX\n0,1\n0,2000\n", "two readings of X at 0 are 1.999 mm or mm/m apart"),
        ("X,EYX\n0,secret\n", "does not consist of numbers"),
        ("X,EYX\n0,1,2\n", "3 numbers, and there are 2 columns"),
        ("X,EYX\n0,9000\n", "9.000 mm"),
        ("X,EYY\n0,1\n", "`EYY` is no column"),
    ] {
        let fault = filed.take_errors(&table, text).unwrap_err();
        assert!(fault.message.contains(told), "{text:?}: {}", fault.message);
        assert!(!fault.message.contains("secret"));
    }
}

/// Files as instruments write them: a head about the run, units, commas for points, falling places, both directions.
#[test]
fn a_measuring_run_is_read_as_its_instrument_writes_it() {
    let inline = mill("columns = [\"X\", \"EXX\", \"EBX\"]\nrows = [[0, 0.001, 0], [250, -0.004, 0.01], [500, 0.007, 0.02]]").unwrap();
    let same = |text: &str| {
        let mut filed = mill("file = \"x.csv\"").unwrap();
        let table = filed.error_tables.pop().unwrap();
        filed.take_errors(&table, text).map_err(|fault| fault.message)?;
        let [own, wanted] = [&filed.errors[0], &inline.errors[0]];
        assert_eq!(own.places, wanted.places, "{text}");
        for (own, wanted) in own.motions.iter().zip(&wanted.motions) {
            let off =
                (own.displacement - wanted.displacement).norm() + (own.turn - wanted.turn).norm();
            assert!(off < 1e-12, "{text}: {own:?}, {wanted:?}");
        }
        Ok::<(), String>(())
    };
    for text in [
        "X,EXX,EBX\n500,0.007,0.02\n250,-0.004,0.01\n0,0.001,0\n",
        "Laser run;12.05.2026\nOperator;N. N.\n\nX [mm];EXX [µm];EBX [µm/m]\n0,000;1,0;0\n250,000;-4,0;10,0\n500,000;7,0;20;\n",
        "X\tEXX (μm)\tEBX (µrad)\n0\t1\t0\n250\t-4\t10\n500\t7\t20\n",
        "X in m,EXX/um,EBX/mrad\n0,1,0\n0.25,-4,0.01\n0.5,7,0.02\n",
        // Up and down: the mean; the places of the way down in any order of runs, and one place a little beside.
        "X,EXX,EBX\n0,0.000,0\n250,-0.006,0.01\n500,0.006,0.02\n500,0.008,0.02\n250.0004,-0.002,0.01\n0,0.002,0\n",
        // Two runs up and one down: what was found from either side counts alike.
        "X,EXX,EBX\n0,0,0\n250,-0.006,0.01\n500,0.006,0.02\n0,0,0\n250,-0.006,0.01\n500,0.006,0.02\n500,0.008,0.02\n250,-0.002,0.01\n0,0.002,0\n",
    ] {
        same(text).unwrap_or_else(|fault| panic!("{text}: {fault}"));
    }
    let arcsec = "X,EXX,EBX [arcsec]\n0,0.001,0\n250,-0.004,2.0626480624709636\n500,0.007,4.125296124941927\n";
    same(arcsec).unwrap();
    for (text, told) in [
        ("X,EXX [arcsec],EBX\n0,1,0\n", "behind EXX is no unit of it"),
        ("X,EXX,EBX [µm]\n0,1,0\n", "behind EBX is no unit of it"),
        ("X [deg],EXX,EBX\n0,1,0\n", "behind X is no unit of it"),
        ("X,EXX,EBX\n0,0,0\n250,0,0\n500,0,0\n250,0,0\n0,0,0\n", "to 500 from one alone"),
        // 30 for 300.
        ("X,EXX,EBX\n0,0,0\n250,0,0\n30,0,0\n500,0,0\n", "from one alone"),
        ("run;of May\n1;2\n", "`run` is no column"),
        // A semicolon keeps cells apart: a comma is the point of one number.
        ("X;EXX\n0;1,000,0\n", "does not consist of numbers"),
    ] {
        let fault = same(text).unwrap_err();
        assert!(fault.contains(told), "{text}: {fault}");
    }
}

#[test]
fn what_cannot_be_a_table_of_errors_is_refused() {
    for (rows, told) in [
        ("columns = [\"X\", \"EXX\", \"EXX\"]\nrows = [[0, 0, 0]]", "`EXX` is no column"),
        ("columns = [\"Y\", \"EXX\"]\nrows = [[0, 0]]", "`Y` is no column"),
        ("columns = [\"X\", \"EAX\"]\nrows = [[0, 21]]", "21.000 mm/m"),
        (
            "columns = [\"X\", \"EXX\"]\nrows = [[0, 0], [0.5, 0.011]]",
            "change by 0.0110 mm between 0 and 0.5",
        ),
        (
            "columns = [\"X\", \"EBX\"]\nrows = [[0, 0], [0.5, 0.011]]",
            "change by 0.0110 mm between 0 and 0.5",
        ),
        ("file = \"passwd\"", "no name of a file of errors"),
        ("file = \"x.csv\"\ncolumns = [\"X\"]", "stand here and in a file"),
        ("uncertainty = 1", "no rows"),
        (
            "columns = [\"X\", \"EXX\"]\nrows = [[0, 0]]\nuncertainty = 1",
            "uncertainties come to 1 mm",
        ),
        ("columns = [\"X\", \"EXX\"]\nrows = [[0, 0]]\n[error.A]", "that of no axis"),
    ] {
        let fault = mill(rows).unwrap_err();
        assert!(fault.contains(told), "{rows}: {fault}");
    }
}

#[test]
fn a_head_that_stands_too_far_is_put_back() {
    let machine = mill("columns = [\"X\", \"EYX\"]\nrows = [[0, 0], [200, 0.02]]").unwrap();
    let solver = machine.solver(0.0).unwrap();
    let mut joints = Joints::default();
    let turns = solver.chain().turns(&joints);
    solver.place(V::new(100.0, 50.0, 10.0), &mut joints, &turns).unwrap();
    // At X 100 the head stands 0.01 mm too far to +Y, and is led there by as much less.
    assert!((joints[1] - 49.99).abs() < 1e-9 && (joints[0] - 100.0).abs() < 1e-9, "{joints:?}");
}
