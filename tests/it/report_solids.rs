//! Shapes of the machine in a report: what `[solids]` names stands where the chain brings it.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::browser::Browser;
use crate::common::{post, post_in, root, sample};

/// A wedge as a text: a corner at `at`, and one along each axis by `size`.
fn wedge(at: [f64; 3], size: f64) -> String {
    let corner = |along: usize| {
        let mut place = at;
        if let Some(value) = place.get_mut(along) {
            *value += size;
        }
        place.map(|value| value.to_string()).join(" ")
    };
    let mut text = "solid wedge\n".to_owned();
    for [a, b, c] in [[3, 1, 0], [3, 2, 1], [3, 0, 2], [0, 1, 2]] {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for place in [a, b, c] {
            writeln!(text, "vertex {}", corner(place)).unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid\n"
}

/// A wavy plate of 2 n² triangles, binary.
fn plate(n: usize) -> Vec<u8> {
    let mut file = [0; 80].to_vec();
    file.extend(u32::try_from(2 * n * n).unwrap().to_le_bytes());
    for i in 0..n {
        for j in 0..n {
            let corner = |i: usize, j: usize| {
                let (x, y) = (i as f32 / n as f32, j as f32 / n as f32);
                [x * 400.0 - 200.0, y * 400.0 - 200.0, x * y * 40.0 - 80.0]
            };
            let [a, b, c, d] =
                [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                file.extend([0; 12]);
                for value in triangle.iter().flatten() {
                    file.extend(value.to_le_bytes());
                }
                file.extend([0; 2]);
            }
        }
    }
    file
}

/// A folder with `shaped.toml`, which refines `ac-trunnion` by `solids`, and the files for it.
fn shaped(solids: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("cad")).unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join("cad").join(name), bytes);
    write("cradle.stl", wedge([10.0, 20.0, -30.0], 60.0).as_bytes()).unwrap();
    write("slide.STL", wedge([-40.0, 0.0, 500.0], 80.0).as_bytes()).unwrap();
    write("plate.stl", &plate(150)).unwrap();
    write("cut.stl", &plate(3)[..500]).unwrap();
    let text = format!("extends = \"ac-trunnion\"\n\n[solids]\n{solids}");
    fs::write(folder.path().join("shaped.toml"), text).unwrap();
    fs::copy(sample("blade.cls"), folder.path().join("blade.cls")).unwrap();
    folder
}

fn reported(folder: &Path, machine: &str, name: &str) -> String {
    let machines = root().join("machines");
    let done = post_in(
        folder,
        &[
            "-m",
            machine,
            "--machines",
            machines.to_str().unwrap(),
            "blade.cls",
            "--tool-length",
            "100",
            "-q",
            "-o",
            &format!("{name}.nc"),
            "--report",
            &format!("{name}.html"),
        ],
    );
    assert_eq!(done.code, 0, "{}", done.err);
    done.err
}

#[test]
fn shapes_stand_where_the_chain_brings_them() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let folder = shaped(
        "A = \"cad/cradle.stl\"\nZ = \"cad/slide.STL\"\nt = \"cad/slide.STL\"\nb = \"cad/plate.stl\"\n",
    );
    let err = reported(folder.path(), "shaped.toml", "part");
    assert_eq!(err, "");
    let other = shaped("");
    reported(other.path(), "ac-trunnion", "part");
    let [part, plain] =
        [&folder, &other].map(|folder| fs::read(folder.path().join("part.nc")).unwrap());
    assert!(part == plain, "a picture changes a program");
    browser.open(&folder.path().join("part.html"));
    // C and A carry the part: the part is body 0, what A moves 1, the bed 2; X, Y and Z follow.
    assert_eq!(browser.ask("P.m.meta.machine.solid"), json!([1, 5, 2]));
    let faces = |browser: &mut Browser, body: u32| {
        let ask = format!(
            "(() => {{ const f = P.parts.made.faces, out = [];
               for (let at = 0; at < f.length; at += 8) if (f[at + 6] === {body}) out.push([f[at], f[at + 1], f[at + 2], f[at + 7]]);
               return out; }})()"
        );
        browser.ask(&ask).as_array().unwrap().clone()
    };
    // The wedge alone, corner by corner, in place of cheeks and bearings.
    let cradle = faces(&mut browser, 1);
    assert_eq!(cradle.len(), 12);
    // What carries the part has its colour, by 30 more than its tone; what holds the tool 20, the tool 10.
    assert_eq!(cradle[0], json!([10, 20, -30, 31]));
    assert_eq!(cradle[1], json!([10, 80, -30, 31]));
    // Behind the tool, which stays, the slide, once for Z and once for the holder.
    let tool = faces(&mut browser, 5);
    let (tones, solid): (Vec<&Value>, Vec<&Value>) =
        tool.iter().partition(|corner| corner[3] != 21);
    assert_eq!(solid.len(), 24);
    assert!(!tones.is_empty() && tones.iter().all(|corner| corner[3] == 11.25));
    // A large plate became small, and keeps its corners.
    let bed = faces(&mut browser, 2);
    assert!((1_000..=2_850).contains(&bed.len()), "{}", bed.len());
    let least = bed.iter().map(|corner| corner[0].as_f64().unwrap()).fold(0.0, f64::min);
    assert_eq!(least, -200.0);
    // What a frame draws stays small.
    browser.press("m");
    browser.ask("P.path.draw(true)");
    let drawn = browser.ask("P.path.drawn");
    assert!(drawn["vertices"].as_u64().unwrap() <= 60_000, "{drawn}");
    // The cradle goes with A and the bed stands: in the machine frame, as the axes of a block say.
    let moved = browser.ask(
        "(() => { const row = P.m.rows >> 1, values = P.chain.values(row, 1), bodies = P.chain.bodies(P.m.meta.machine, values, 'machine');
           return { a: P.m.at('q.A', row), cradle: P.chain.apply(bodies[1], [70, 20, -30]), bed: P.chain.apply(bodies[2], [1, 2, 3]) }; })()",
    );
    assert_eq!(moved["bed"], json!([1, 2, 3]));
    // A table goes the other way than the tool as seen from the part: by -A about X through 0.012, 50.004.
    let (sine, cosine) = libm::sincos(-moved["a"].as_f64().unwrap().to_radians());
    let (y, z) = (20.0 - 0.012, -30.0 - 50.004);
    let wanted = [70.0, y * cosine - z * sine + 0.012, y * sine + z * cosine + 50.004];
    for (at, wanted) in wanted.iter().enumerate() {
        let got = moved["cradle"][at].as_f64().unwrap();
        assert!((got - wanted).abs() < 1e-9, "{got} {wanted}");
    }
    browser.assert_quiet();
}

#[test]
fn a_shape_that_cannot_be_shown_costs_no_program() {
    let folder = shaped("C = \"cad/none.stl\"\nX = \"cad/cut.stl\"\nY = \"cad\"\n");
    let text = fs::read_to_string(folder.path().join("shaped.toml")).unwrap();
    let done = post_in(folder.path(), &["check", "shaped.toml"]);
    assert_eq!(done.code, 1, "{}", done.err);
    assert!(
        done.err.contains("error[machine-solid]: `cad` is no name of an STL file"),
        "{}",
        done.err
    );
    fs::create_dir(folder.path().join("cad/folder.stl")).unwrap();
    fs::write(folder.path().join("shaped.toml"), text.replace("\"cad\"", "\"cad/folder.stl\""))
        .unwrap();
    let done = post_in(folder.path(), &["check", "shaped.toml"]);
    assert_eq!(done.code, 0, "{}", done.err);
    for told in [done.err, reported(folder.path(), "shaped.toml", "part")] {
        assert_eq!(told.matches("warning[solid]").count(), 3, "{told}");
        assert!(told.contains("shaped.toml:4"), "{told}");
        assert!(
            told.contains("cad/cut.stl is not shown: it is no STL file: it has 500 bytes"),
            "{told}"
        );
        assert!(told.contains("folder.stl is not shown: it is no regular file"), "{told}");
    }
    let Some(mut browser) = Browser::start() else {
        return;
    };
    browser.open(&folder.path().join("part.html"));
    // What follows from the chain stands there, and the page says why.
    assert_eq!(browser.ask("P.m.meta.machine.solid"), json!([]));
    let warnings = browser.ask("P.m.meta.warnings.map(({ code, cl, nc }) => [code, cl, nc])");
    assert_eq!(
        warnings,
        json!([["solid", null, null], ["solid", null, null], ["solid", null, null]])
    );
    browser.assert_quiet();
}

#[test]
fn who_extends_a_machine_has_its_shapes() {
    let folder = shaped("A = \"cad/cradle.stl\"\nZ = \"cad/slide.STL\"\n");
    fs::create_dir(folder.path().join("other")).unwrap();
    let text = "extends = \"../shaped.toml\"\n[solids]\nZ = \"\"\nC = \"../cad/none.stl\"\n";
    fs::write(folder.path().join("other/mine.toml"), text).unwrap();
    let err = reported(folder.path(), "other/mine.toml", "part");
    assert_eq!(err.matches("warning[solid]").count(), 1, "{err}");
    assert!(err.contains("none.stl is not shown: there is no such file"), "{err}");
    let done = post_in(folder.path(), &["check", "other/mine.toml", "--json", "check.json"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let check: Value =
        serde_json::from_slice(&fs::read(folder.path().join("check.json")).unwrap()).unwrap();
    assert!(check["warnings"][0].as_str().unwrap().contains("none.stl"), "{check}");
    let Some(mut browser) = Browser::start() else {
        return;
    };
    browser.open(&folder.path().join("part.html"));
    assert_eq!(browser.ask("P.m.meta.machine.solid"), json!([1]));
    // No folder of the user's stands in the page.
    let told = browser.ask("P.m.meta.warnings[0].text");
    assert!(told.as_str().unwrap().starts_with("the solid none.stl is not shown"), "{told}");
    browser.assert_quiet();
}

#[test]
fn a_shape_is_read_and_never_written() {
    let folder = shaped("A = \"cad/cradle.stl\"\n");
    let shape = folder.path().join("cad/cradle.stl");
    let before = fs::read(&shape).unwrap();
    let done = post_in(
        folder.path(),
        &[
            "-m",
            "shaped.toml",
            "blade.cls",
            "--tool-length",
            "100",
            "-o",
            "part.nc",
            "--report",
            "cad/cradle.stl",
        ],
    );
    assert_eq!(done.code, 1, "{}", done.err);
    assert!(done.err.contains("the solid"), "{}", done.err);
    assert_eq!(fs::read(&shape).unwrap(), before);
}

#[test]
fn a_link_that_the_machine_lacks_is_named() {
    let folder = shaped("B = \"cad/cradle.stl\"\nw = \"part.step\"\n");
    let done = post_in(folder.path(), &["check", "shaped.toml"]);
    assert_eq!(done.code, 1, "{}", done.err);
    for wanted in [
        "the machine has no `B` that could have a shape",
        "its axes are C, A, Y, X, Z; w, b and t are part, bed and tool",
        "`part.step` is no name of an STL file",
    ] {
        assert!(done.err.contains(wanted), "{}", done.err);
    }
    let schema: Value = serde_json::from_str(&post(&["schema"]).out).unwrap();
    assert!(schema["properties"]["solids"]["description"].is_string());
}
