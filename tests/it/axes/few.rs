//! Machines of one and two axes: they post what lies in their reach, and say by how much they miss the rest.

use super::*;

/// A drilling unit of a transfer machine: Z alone, and a table that is set between the holes.
const UNIT: &str = "name = \"drilling unit\"\nchain = \"[w B' b Z (S) t]\"\n\
    [tool]\ngauge = [0, 0, 200]\n\
    [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-150, 0]\nmax_feed = 10000\n\
    [axis.B]\nrotary = [0, 1, 0]\npoint = [0, 0, -400]\ncyclic = true\nindexed = 0\nstep = 30\nmax_feed = 3600\n\
    [control]\ndialect = \"fanuc\"\ntcp = \"post\"\n[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.05\n";

/// A winder: the mandrel A turns, X leads the wire along it, 30 mm off its line.
const WINDER: &str = "name = \"winder\"\nchain = \"[w A' b X t]\"\n\
    [tool]\ngauge = [0, 0, 30]\nlength_axis = \"none\"\n\
    [axis.X]\nlinear = [1, 0, 0]\ntravel = [-100, 100]\nmax_feed = 10000\n\
    [axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, 0]\ncyclic = true\nmax_feed = 36000\n\
    [control]\ndialect = \"linuxcnc\"\ntcp = \"post\"\n[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.05\n";

/// The run of a machine file of its own, with a tool of `length` mm.
fn run(machine: &str, text: &str, length: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let [file, part] = ["m.toml", "part.ncl"].map(|name| folder.path().join(name));
    fs::write(&file, machine).unwrap();
    fs::write(&part, text).unwrap();
    let [file, part] = [&file, &part].map(|path| path.to_str().unwrap().to_owned());
    post(&["-q", "--verify", "-m", &file, "--tool-length", length, "-o", "-", &part])
}

/// Where the blocks of a program of `machine` bring the tip.
fn tips(machine: &str, program: &str, names: &[&str], length: f64) -> Vec<Pose> {
    let model = Model::from_table(machine.parse().unwrap(), None);
    let blocks = blocks(program, names, &[]);
    blocks.iter().map(|block| model.pose(&block.words, length)).collect()
}

#[test]
fn a_drilling_unit_drills_what_stands_before_it() {
    let (azimuths, depths) = ([0.0f64, 60.0, -90.0], [3.0, -12.0]);
    // B turns the part about a line 400 mm below: holes round it, 400 mm from that line.
    let mut text = cl();
    let point = |azimuth: f64, depth: f64| {
        let (sine, cosine) = libm::sincos(azimuth.to_radians());
        (
            V::new(sine, 0.0, cosine) * (400.0 + depth) - V::new(0.0, 0.0, 400.0),
            V::new(sine, 0.0, cosine),
        )
    };
    for azimuth in azimuths {
        let [above, into] = [20.0, depths[1]].map(|depth| point(azimuth, depth));
        text = text.rapid(above.0, above.1).cut(into.0, into.1).rapid(above.0, above.1);
    }
    let made = run(UNIT, &text.end(), "120");
    assert_eq!(made.code, 0, "{}", made.err);
    let reached = tips(UNIT, &made.out, &["B", "Z"], 120.0);
    for azimuth in azimuths {
        let (tip, axis) = point(azimuth, depths[1]);
        let hit = |pose: &Pose| (pose.tip - tip).norm() < 0.001 && angle(pose.axis, axis) < 1e-4;
        assert!(reached.iter().any(hit), "{azimuth}\n{}", made.out);
    }
    // A hole beside the line of the spindle.
    let beside =
        cl().rapid(V::new(0.0, 0.0, 20.0), V::z()).cut(V::new(5.0, 0.0, -3.0), V::z()).end();
    let said = run(UNIT, &beside, "120");
    assert!(said.code == 1 && said.err.contains("the nearest pose misses it by"), "{}", said.err);
    // On no position of the table.
    let (tip, axis) = point(45.0, 3.0);
    let between = cl().rapid(tip, axis).cut(point(45.0, -3.0).0, axis).end();
    let said = run(UNIT, &between, "120");
    assert_eq!(said.code, 1, "{}", said.out);
}

#[test]
fn a_winder_reaches_its_mandrel_and_no_chord_of_it() {
    let at = |turn: f64| {
        let (sine, cosine) = libm::sincos(turn);
        (V::new(2.0 * turn, 30.0 * sine, 30.0 * cosine), V::new(0.0, sine, cosine))
    };
    // Chords of 3 degrees stay within a hundredth of a mm of the mandrel.
    let wind = |degrees: f64| {
        let mut text = cl();
        for step in 0..60 {
            let (tip, axis) = at((f64::from(step) * degrees).to_radians());
            text = text.cut(tip, axis);
        }
        text.end()
    };
    // All of it is reached; only the way off the mandrel is missing, which no axis leads.
    let said = run(WINDER, &wind(2.0), "0");
    assert!(said.code == 1 && said.err.contains("error[retract]"), "{}", said.err);
    assert!(!said.err.contains("out-of-reach"), "{}", said.err);
    // A chord of 30 degrees cuts a mm deep into the mandrel, and the wire cannot go there.
    let said = run(WINDER, &wind(30.0), "0");
    assert!(said.code == 1 && said.err.contains("misses it by 1.02"), "{}", said.err);
}

/// A vertical lathe with a head that swivels and no Y.
const SWIVEL: &str = "name = \"vertical lathe\"\nchain = \"[w C' b X Z B (S) t]\"\n\
    [tool]\ngauge = [0, 0, 800]\n\
    [axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ncyclic = true\nmax_feed = 7200\n\
    [axis.X]\nlinear = [1, 0, 0]\ntravel = [-1500, 1500]\nmax_feed = 20000\n\
    [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-1500, 1500]\nmax_feed = 20000\n\
    [axis.B]\nrotary = [0, 1, 0]\npoint = [0, 0, 1050]\ntravel = [-100, 20]\nmax_feed = 7200\n\
    [control]\ndialect = \"fanuc\"\ntcp = \"post\"\nleave = { distance = 50, then = { Z = \"max\" } }\n\
    [accuracy]\ntolerance = 0.01\naxis_tolerance = 0.05\n";

/// Points that the machine's own axes reach, C by a degree from one to the next: between them the tip is brought into the
/// plane of X and Z, and the tool axis leans by as much.
#[test]
fn points_of_a_vertical_lathes_own_axes_are_posted() {
    let model = Model::from_table(SWIVEL.parse().unwrap(), None);
    let (rounds, mut rng) = post_testkit::randomised(6, 31);
    for _ in rounds {
        let [tilt, drift] = [rng.range(20.0, 70.0), rng.range(-0.4, 0.4)];
        let sense = if rng.range(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 };
        let (radius, away) = (rng.range(60.0, 250.0), rng.range(-1.5, 1.5));
        let start = rng.range(-180.0, 180.0);
        let points: Vec<Pose> = (0..60)
            .map(|step| {
                let step = f64::from(step);
                let b = -(tilt + drift * step);
                // The tip of a tool of 150 mm swings about a line 400 mm above it.
                let x = radius + away * step + 400.0 * libm::sin(b.to_radians());
                model.reach(&[start + sense * step, x, -300.0 + 0.5 * step, b], 150.0)
            })
            .collect();
        let first = &points[0];
        let mut text = cl().rapid(first.tip + first.axis * 30.0, first.axis);
        for point in &points {
            text = text.cut(point.tip, point.axis);
        }
        let made = run(SWIVEL, &text.end(), "150");
        assert_eq!(made.code, 0, "{}", made.err);
        let reached = tips(SWIVEL, &made.out, &["C", "X", "Z", "B"], 150.0);
        for (place, point) in points.iter().enumerate() {
            let hit = |pose: &Pose| {
                (pose.tip - point.tip).norm() < 0.011 && angle(pose.axis, point.axis) < 0.051
            };
            assert!(reached.iter().any(hit), "{place}\n{}", made.out);
        }
    }
}

/// A turning centre without Y, whose head B swings the tool: drawn along X, across the part. X goes to `least` mm.
fn swinging(least: f64) -> String {
    format!(
        "name = \"turning centre\"\nchain = \"[w C' b Z X B (S) t]\"\n\
         [tool]\ngauge = [400, 0, 300]\naxis = [1, 0, 0]\nlength_axis = \"X\"\n\
         [axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ncyclic = true\nmax_feed = 36000\n\
         [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-600, 900]\nmax_feed = 40000\n\
         [axis.X]\nlinear = [1, 0, 0]\ntravel = [{least}, 300]\nmax_feed = 40000\n\
         [axis.B]\nrotary = [0, 1, 0]\npoint = [600, 0, 300]\ntravel = [-120, 120]\nmax_feed = 10800\n\
         [control]\ndialect = \"fanuc\"\ntcp = \"post\"\nleave = {{ distance = 40, then = {{ Z = \"max\" }} }}\n\
         [accuracy]\ntolerance = 0.005\naxis_tolerance = 0.05\n"
    )
}

/// A cut over a dome of 60 mm, or through a bowl, across the line of C: from one point to the next `step` mm, the tool along
/// its normal, so that B swings through upright there.
fn across_the_pole(step: f64, first: f64, azimuth: f64, bowl: bool) -> Vec<Pose> {
    let (sine, cosine) = libm::sincos(azimuth.to_radians());
    let side = if bowl { -1.0 } else { 1.0 };
    let count = (2.0 * first / step).round() as i32;
    let at = |place: i32| {
        let x = first - step * f64::from(place);
        let (lean, up) = (side * x / 60.0, libm::sqrt(3600.0 - x * x) / 60.0);
        let tip = V::new(cosine * x, sine * x, 100.0 + side * 60.0 * (up - 1.0));
        Pose { tip, axis: V::new(cosine * lean, sine * lean, up), edge: V::zeros() }
    };
    (0..=count).map(at).collect()
}

/// Through the centre X goes below zero; where it ends C turns by 180° on the spot, B swinging the tool upright there. Points
/// 5 mm apart are posted as dense ones are, whether one of them is the centre or none.
#[test]
fn a_head_that_swings_goes_through_the_centre() {
    // Upright the head has X at -600 mm on the line of C.
    for (least, turns) in [(-900.0, false), (-602.0, true)] {
        let machine = swinging(least);
        for (step, first) in [(5.0, 20.0), (5.0, 22.5), (7.0, 24.0), (0.5, 20.0)] {
            for bowl in [false, true] {
                let points = across_the_pole(step, first, 37.0, bowl);
                let mut text = cl().rapid(points[0].tip + points[0].axis * 30.0, points[0].axis);
                for point in &points {
                    text = text.cut(point.tip, point.axis);
                }
                let last = points.last().unwrap();
                let text = text.rapid(last.tip + last.axis * 30.0, last.axis);
                let made = run(&machine, &text.end(), "80");
                assert_eq!(made.code, 0, "{least} {step} {first} {bowl}: {}", made.err);
                let model = Model::from_table(machine.parse().unwrap(), None);
                let all = blocks(&made.out, &["C", "Z", "X", "B"], &[]);
                let reached: Vec<Pose> =
                    all.iter().map(|block| model.pose(&block.words, 80.0)).collect();
                let mut next = 0;
                for point in &points {
                    let hit = |pose: &Pose| {
                        (pose.tip - point.tip).norm() < 0.006
                            && angle(pose.axis, point.axis) < 0.051
                    };
                    let found = reached[next..].iter().position(hit);
                    next += found.unwrap_or_else(|| panic!("{point:?}\n{}", made.out));
                }
                let angles = || all.iter().map(|block| block.words[0]);
                let way = angles().fold(f64::MIN, f64::max) - angles().fold(f64::MAX, f64::min);
                assert_eq!(way > 90.0, turns, "{least}: C goes {way}");
            }
        }
    }
}

/// A control that turns C the shorter way is led through points of the turn on the spot: half a turn has no shorter way.
#[test]
fn half_a_turn_in_the_centre_has_points_where_c_goes_the_shorter_way() {
    let face = "extends = \"lathe-xzc-face\"\n[axis.C]\nrange = [0, 360]\n";
    let mut text = cl();
    let up = V::z();
    // From the far end of one side to that of the other, beginning on the line of C, and ending there.
    for [from, to] in [[30.0, -30.0], [0.0, -30.0], [-30.0, 0.0], [25.0, -40.0]] {
        text = text.rapid(V::new(from, 0.0, 20.0), up).cut(V::new(from, 0.0, -2.0), up);
        text = text.cut(V::new(to, 0.0, -2.0), up).rapid(V::new(to, 0.0, 20.0), up);
    }
    let made = run(face, &text.end(), "60");
    assert_eq!(made.code, 0, "{}", made.err);
    let all = blocks(&made.out, &["C", "Z", "X"], &[]);
    let cuts = all.windows(2).filter(|pair| !pair[1].rapid);
    let turns = cuts.map(|pair| pair[1].words[0] - pair[0].words[0]);
    let longest = turns.map(|turn| ((turn + 540.0).rem_euclid(360.0) - 180.0).abs());
    assert!(longest.fold(0.0, f64::max) < 179.0, "{}", made.out);
    assert!(made.out.contains("C90.") || made.out.contains("C270."), "{}", made.out);
}

/// A tool that leans on the centre line cannot have C turned there: where X ends, the cut is refused.
#[test]
fn no_tool_that_leans_is_turned_on_the_centre_line() {
    let lean = V::new(libm::sin(0.35), 0.0, libm::cos(0.35));
    let mut text = cl();
    for x in [20.0, 10.0, 0.0, -10.0, -20.0] {
        text = text.cut(V::new(x, 0.0, 100.0), lean);
    }
    let text = text.rapid(V::new(-20.0, 0.0, 100.0) + lean * 30.0, lean).end();
    // With the tool leaning X stands by 280 mm times a sine before where it stands with it upright.
    let at_centre = -600.0 + 280.0 * libm::sin(0.35);
    let said = run(&swinging(at_centre - 5.0), &text, "80");
    assert!(said.code == 1 && said.err.contains("over-travel"), "{}", said.err);
    let made = run(&swinging(-900.0), &text, "80");
    assert_eq!(made.code, 0, "{}", made.err);
}
