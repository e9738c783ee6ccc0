//! Several stocks, each in the frame that it hangs in: each is cut, held against and written by itself.

use std::fs;

use post_testkit::assert_contains;
use tempfile::TempDir;

use crate::common::post_in;

/// Two blocks beside one another, 35 mm long and 30 mm high, their tops at the part's Z0: one in the part frame, the other where
/// it is in the machine frame with the part on 0, 0, -300.
const BOTH: &str = "extends = \"vmc\"\nname = \"mine\"\n\
    [stock.left]\nblock = [[-40, -30, -30], [-5, 30, 0]]\nresolution = 0.5\ncut = true\n\
    [stock.right]\non = \"w\"\nblock = [[15, -30, -330], [50, 30, -300]]\nresolution = 0.5\ncut = true\n\
    [tools.1]\nlength = 100\nholder = [[0, 25], [60, 25]]\ncutter = [[0, 5], [40, 5]]\nedge = 22\n";

/// A program with these lines behind the tool's approach.
fn program(lines: &str) -> String {
    format!(
        "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X-60. Y0.\nG43 H1 Z5.\n{lines}\n\
         G0 Z5.\nG53 G0 Z20.\nM30\n%\n"
    )
}

/// A slot through both, 10 mm wide and 6 mm deep.
const SLOT: &str = "G0 Z-6.\nG1 X60. F500.";

/// What is said, and whether the program is clear.
fn proven(machine: &str, lines: &str, more: &[&str]) -> (TempDir, String, bool) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.nc"), program(lines)).unwrap();
    let words = ["clearance", "part.nc", "-m", "mine.toml", "--mount", "0,0,-300"];
    let run = post_in(folder.path(), &[&words[..], more].concat());
    assert!(run.code < 2, "{}", run.err);
    (folder, format!("{}{}", run.out, run.err), run.code == 0)
}

/// The bounds of what is cut of each stock, mm³, in the order of the table.
fn cut(said: &str) -> Vec<[f64; 2]> {
    let rows = said.lines().filter_map(|line| line.strip_prefix("cut of it, mm³"));
    let bounds = |row: &str| {
        let mut ends = row.split(" to ").map(|end| end.trim().parse().unwrap());
        [ends.next().unwrap(), ends.next().unwrap()]
    };
    rows.map(bounds).collect()
}

#[test]
fn each_stock_is_cut_by_itself() {
    let (folder, said, clear) = proven(BOTH, SLOT, &["--stock-stl", "left.stl"]);
    assert!(clear, "{said}");
    assert_contains(
        &said,
        &[
            "stock left left, mm³",
            "stock right  holder T1",
            "stock left   shank T1",
            "tool 1, stock right",
        ],
    );
    let cut = cut(&said);
    assert_eq!(cut.len(), 2, "{said}");
    for [least, most] in cut {
        let truth = 35.0 * 10.0 * 6.0;
        assert!(least <= truth && truth <= most && most - least < 0.5 * truth, "{said}");
    }
    // Each in the frame of its shape.
    for (name, low, high) in [("left", [-40.0, -30.0], 0.0), ("right", [15.0, -330.0], -300.0)] {
        let stl = fs::read(folder.path().join(format!("left-{name}.stl"))).unwrap();
        let corners = stl[84..].chunks_exact(50).flat_map(|facet| {
            facet[12..48].chunks_exact(12).map(|corner| {
                [0, 4, 8].map(|at| f32::from_le_bytes(corner[at..at + 4].try_into().unwrap()))
            })
        });
        let corners: Vec<[f32; 3]> = corners.collect();
        let ends = |axis: usize| {
            let values = corners.iter().map(|corner| f64::from(corner[axis]));
            (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
        };
        assert!((ends(0).0 - low[0]).abs() < 0.5 && (ends(2).0 - low[1]).abs() < 0.5, "{name}");
        assert!((ends(2).1 - high).abs() < 0.5, "{name}");
    }
    let (_, said, clear) = proven(BOTH, SLOT, &["--stock-stl", "-"]);
    assert!(!clear);
    assert_contains(&said, &["standard output takes what is left of one"]);
}

#[test]
fn what_is_hit_is_told_by_its_name() {
    // Across the right one at rapid, above the left one.
    let through = "G0 X5.\nG0 Z-20.\nG0 X25.";
    let (_, said, clear) = proven(BOTH, through, &[]);
    assert!(!clear);
    assert_contains(&said, &["stock right hits cutter T1", "stock left   cutter T1"]);
    assert!(!said.contains("stock left hits"), "{said}");
    // The same of a stock that counts as it is before the first cut.
    let whole = BOTH.replace("cut = true\n[tools", "[tools");
    let (_, said, clear) = proven(&whole, through, &[]);
    assert!(!clear && said.contains("stock right hits cutter T1"), "{said}");
    // A pair may leave out one of them, or all.
    for (name, clear) in [("stock right", true), ("stock", true), ("stock left", false)] {
        let ignored = format!("{BOTH}[clearance]\nignore = [[\"{name}\", \"cutter\"]]\n");
        let ignored = ignored.replace("edge = 22\n", "");
        assert_eq!(proven(&ignored, through, &[]).2, clear, "{name}");
    }
}

/// A stock on the bed stays where it is while the table goes.
#[test]
fn a_stock_hangs_on_what_carries_it() {
    let on_bed = BOTH.replace(
        "on = \"w\"\nblock = [[15, -30, -330], [50, 30, -300]]",
        "on = \"b\"\nblock = [[-20, -20, -330], [20, 20, -300]]",
    );
    let on_bed = on_bed + "[clearance]\nignore = [[\"stock left\", \"stock right\"]]\n";
    let plunge = "G0 X0. Y80.\nG1 Z-6. F300.\nX60.\nY90.";
    let (_, said, clear) = proven(&on_bed, plunge, &["--csv", "lines.csv"]);
    assert!(clear, "{said}");
    let hole = std::f64::consts::PI * 25.0 * 6.0;
    let [left, right] = cut(&said)[..] else { panic!("{said}") };
    assert!(left[1] == 0.0, "{said}");
    assert!(right[0] <= hole && hole <= right[1] && right[0] > 0.6 * hole, "{said}");
    // Where the tool has been in the part says nothing of what stands on the bed: there it is a rapid into the material.
    let again = "G0 X0. Y80.\nG1 Z-2. F300.\nG0 Z5.\nG0 Z-2.";
    assert!(proven(&on_bed, again, &[]).2);
    let whole = on_bed.replace("cut = true\n[tools", "[tools");
    let (_, said, clear) = proven(&whole, again, &[]);
    assert!(!clear && said.contains("stock right hits cutter T1"), "{said}");
}

#[test]
fn what_cannot_be_is_refused_and_a_stock_can_be_taken_away() {
    let mill = "extends = \"vmc\"\nname = \"mine\"\n";
    let block = "block = [[0, 0, -330], [9, 9, -300]]\n";
    for (text, says) in [
        (format!("[stock.a]\non = \"t\"\n{block}"), "stock a hangs on the tool's side"),
        (format!("[stock.a]\non = \"Q\"\n{block}"), "stock a hangs on nothing of the machine"),
        (
            format!("[stock]\n{block}[stock.a]\n{block}"),
            "[stock] is a body, and there are others by names",
        ),
        (format!("[stock.\"a/b\"]\n{block}"), "a stock cannot be called `a/b`"),
        (format!("[stock.a]\n{block}part = \"a.stl\"\n"), "stock a has a part, and is not cut"),
        ("[stock.a]\n".to_owned(), "stock a has no shape, or more than one"),
        ("[stock]\n".to_owned(), "stock has no shape, or more than one"),
        (format!("[stock]\nblok = 1\n{block}"), "there is no key `blok` here"),
        (format!("[stock.a]\nblok = 1\n{block}"), "there is no key `blok` here"),
        (
            format!("[stock.a]\n{block}[clearance]\nignore = [[\"stock b\", \"holder\"]]\n"),
            "[clearance] names stock b",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mine.toml"), format!("{mill}{text}")).unwrap();
        let run = post_in(folder.path(), &["check", "mine.toml"]);
        assert_eq!(run.code, 1, "{text}: {}", run.err);
        assert_contains(&run.err, &[says]);
    }
    let taken = |text: &str| {
        let (_, said, clear) =
            proven(&format!("{BOTH}{text}"), SLOT, &["--set", "stock.right.file=\"\""]);
        assert!(clear, "{said}");
        assert!(!said.contains("stock right  "), "{said}");
        said
    };
    taken("");
    let said = taken("[clearance]\nignore = [[\"stock right\", \"holder\"]]\n");
    assert_contains(&said, &["stock right is taken away"]);
}
