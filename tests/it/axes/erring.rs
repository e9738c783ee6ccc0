//! `[error.X]` on chains whose rotary axes place the tip too, or that have fewer freedoms than the pose: programs are read back
//! with the errors, by a chain of isometries, at the words and between them.

use post_testruns::read_back::points;

use super::*;

/// Places between two words at which the tip is looked at.
const SHARES: u32 = 8;

/// Errors of X: it strays along all three directions, rolls, pitches and yaws.
const OF_X: &str = "[error.X]\ncolumns = [\"X\", \"EXX\", \"EYX\", \"EZX\", \"EBX\", \"ECX\"]\n\
    rows = [[-450, 0.05, -0.03, 0.02, 0.1, -0.05], [-395, -0.02, 0.01, 0.03, 0.05, 0.04], [-300, 0.04, 0.03, -0.03, -0.1, 0.1], [20, 0, 0, 0, 0, 0]]\n";

/// Errors of a turning axis along and about all directions.
fn of_c(name: &str) -> String {
    let columns = ["EX", "EY", "EZ", "EA", "EB"].map(|part| format!("\"{part}{name}\"")).join(", ");
    format!(
        "[error.{name}]\ncolumns = [\"{name}\", {columns}]\nrows = [[-170, 0.03, -0.02, 0.02, 0.05, 0.04], [-60, -0.02, 0.02, 0.01, -0.06, 0], [40, 0.03, 0.01, -0.02, 0.04, 0.05], [180, 0.03, -0.02, 0.02, 0.05, 0.04]]\n"
    )
}

/// How far a point lies from the ways between `tips`.
fn off(point: V, tips: &[V]) -> f64 {
    let from_way = |pair: &[V]| {
        let way = pair[1] - pair[0];
        let share =
            if way.norm() > 0.0 { (point - pair[0]).dot(&way) / way.norm_squared() } else { 0.0 };
        (pair[0] + way * share.clamp(0.0, 1.0) - point).norm()
    };
    tips.windows(2).map(from_way).fold(f64::INFINITY, f64::min)
}

/// The largest distance from the cuts of `text`, by a model: at words of cuts and between them.
fn largest(made: &Made, model: &Model, text: &str) -> f64 {
    let wanted = points(text);
    let tips: Vec<V> = wanted.iter().map(|point| point.tip).collect();
    let mut worst: f64 = 0.0;
    for pair in made.blocks.windows(2).filter(|pair| !pair[1].rapid) {
        for share in 0..=SHARES {
            let share = f64::from(share) / f64::from(SHARES);
            let ends = pair[0].words.iter().zip(&pair[1].words);
            let words: Vec<f64> = ends.map(|(from, to)| from + (to - from) * share).collect();
            worst = worst.max(off(model.pose(&words, made.length).tip, &tips));
        }
    }
    worst
}

/// The program keeps the tolerance of the machine with its errors, which are none of a small kind: read without them it is off.
fn keeps_to_its_cuts(setup: Setup, errors: &str, text: &str) {
    let setup = setup.file(errors);
    let (name, made) = (setup.machine, setup.made(text));
    let tolerance = made.model.tolerance;
    let kept = largest(&made, &made.model, text);
    assert!(kept <= tolerance + ROUNDING, "{name}: {kept} mm\n{}", made.text);
    let nominal = on(name).long(made.length).model(None);
    let without = largest(&made, &nominal, text);
    assert!(without > 1.5 * tolerance, "{name}: errors do nothing, {without} mm");
}

/// Holes, and a groove along and around the mantle of a part.
fn groove() -> String {
    let at = |angle: f64, radius: f64, z: f64| {
        let (sine, cosine) = libm::sincos(angle.to_radians());
        (V::new(radius * cosine, radius * sine, z), V::new(cosine, sine, 0.0))
    };
    let (above, into) = (at(20.0, 50.0, -10.0), at(20.0, 30.0, -10.0));
    let mut text = cl().rapid(above.0, above.1).cut(into.0, into.1);
    for step in 0..40 {
        let step = f64::from(step);
        let (tip, axis) = at(20.0 + 2.0 * step, 30.0 - 0.1 * step, -10.0 - 0.5 * step);
        text = text.cut(tip, axis);
    }
    text.rapid(at(100.0, 60.0, -30.0).0, at(100.0, 60.0, -30.0).1).end()
}

#[test]
fn a_lathe_without_y_takes_errors_out_by_x_z_and_c() {
    let face = cl()
        .rapid(V::new(35.0, -20.0, 20.0), V::z())
        .cut(V::new(35.0, -20.0, -1.0), V::z())
        .cut(V::new(22.0, 30.0, -1.5), V::z())
        .cut(V::new(-28.0, 24.0, -2.0), V::z())
        .cut(V::new(-30.0, -26.0, -1.0), V::z())
        .rapid(V::new(-30.0, -26.0, 30.0), V::z())
        .end();
    let errors = format!("{OF_X}{}", of_c("C"));
    keeps_to_its_cuts(on("lathe-xzc-face"), &errors, &face);
    // The tool lies across: what C turns it by to bring the tip to its place, the tool leans.
    let wide = format!("[accuracy]\ntolerance = 0.02\naxis_tolerance = 0.2\n{errors}");
    keeps_to_its_cuts(on("lathe-xzc-radial").long(80.0), &wide, &groove());
}

#[test]
fn what_no_axis_takes_out_is_refused_by_what_it_misses() {
    // The tip stands 0.03 mm beside the plane of two axes, and nothing goes there.
    let text = cl()
        .rapid(V::new(30.0, 0.0, 5.0), V::z())
        .cut(V::new(30.0, 0.0, -5.0), V::z())
        .cut(V::new(25.0, 0.0, -20.0), V::z())
        .rapid(V::new(60.0, 0.0, -20.0), V::z())
        .end()
        .replace("6000", "3000");
    let plain = "[error.Z]\ncolumns = [\"Z\", \"EXZ\", \"EYZ\"]\nrows = [[-900, 0.04, 0.0], [900, -0.04, 0.0]]\n";
    let beside = "[error.Z]\ncolumns = [\"Z\", \"EXZ\", \"EYZ\"]\nrows = [[-900, 0.04, 0.03], [900, -0.04, 0.03]]\n";
    let machine = || on("lathe-xz").with("spindle.surface_speed", "true").long(0.0);
    let made = machine().file(plain).run(&text);
    assert_eq!(made.code, 0, "{}", made.err);
    let said = machine().file(beside).refused(&text);
    assert!(said.contains("misses it by 0.03") || said.contains("0.0300 mm"), "{said}");
}

#[test]
fn a_knife_and_an_arm_take_errors_out_by_a_search() {
    let mut pass =
        cl().rapid(V::new(-60.0, 20.0, 20.0), V::z()).cut(V::new(-60.0, 20.0, 0.0), V::z());
    for step in 1..30 {
        let x = -60.0 + 4.0 * f64::from(step);
        pass = pass.cut(V::new(x, 20.0 + 15.0 * libm::sin(x / 25.0), 0.0), V::z());
    }
    let knife = pass.rapid(V::new(56.0, 32.0, 25.0), V::z()).end();
    let straying = "[error.Y]\ncolumns = [\"Y\", \"EXY\", \"EZY\", \"ECY\"]\nrows = [[-650, 0.2, 0.1, 0.2], [30, -0.1, 0.05, 0.1], [650, 0.1, 0, -0.2]]\n";
    keeps_to_its_cuts(
        on("tangential-knife").long(30.0),
        &format!("{straying}{}", of_c("C")),
        &knife,
    );
    let sample = fs::read_to_string(root().join("tests/machines/kr6-r700.cls")).unwrap();
    let errors = format!("{}{}", of_c("A"), of_c("C").replace("[-170, ", "[-120, "));
    let arm = Setup { ending: "cls", ..on("kr6-r700").with("accuracy.tolerance", "0.01") };
    keeps_to_its_cuts(arm, &errors, &sample);
}

#[test]
fn errors_and_what_the_control_interpolates_by_itself_do_not_go_together() {
    let said =
        on("lathe-xzc-polar").file(OF_X).refused(&cl().cut(V::new(30.0, 0.0, 0.0), V::z()).end());
    assert!(
        said.contains("does not reach what the control interpolates by itself in [mode.face]"),
        "{said}"
    );
}
