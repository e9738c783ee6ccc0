//! `post clearance` with a stock that is cut: a pocket that was cut may be dived into, what is left of the stock is hit.

use std::fs;

use post_testkit::assert_contains;
use tempfile::TempDir;

use crate::common::post_in;

/// A mill with a block and two tools: an end mill with a neck, and a drill.
fn machine(stock: &str, first: &str) -> String {
    format!(
        "extends = \"vmc\"\nname = \"mine\"\n[stock]\nblock = [[-40, -30, -30], [40, 30, 0]]\n{stock}\n\
         [tools.1]\nlength = 100\n{first}\n\
         [tools.2]\nlength = 100\ncutter = [[0, 0], [1.5, 2.5], [60, 2.5]]\n"
    )
}

/// Edges 22 mm long, a neck above them, a holder 40 mm above the tip.
const END_MILL: &str =
    "holder = [[0, 25], [60, 25]]\ncutter = [[0, 5], [22, 5], [22, 4.5], [40, 4.5]]\nedge = 22";

/// A pocket in steps of 6 mm down to 24 mm, then `more`.
fn program(more: &str) -> String {
    let mut text = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z5.\n".to_owned();
    for step in 1..=4 {
        text.push_str(&format!("G0 X-20. Y-13.\nG1 Z-{}. F300.\n", 6 * step));
        for row in 0..5 {
            let (y, x) = (-13.0 + 6.5 * f64::from(row), if row % 2 == 0 { 20 } else { -20 });
            text.push_str(&format!("G1 Y{y:.3}\nX{x}. F800.\n"));
        }
        text.push_str("G0 Z5.\n");
    }
    format!("{text}{more}\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n")
}

/// What is said, and whether the program is clear.
fn proven(machine: &str, program: &str, more: &[&str]) -> (TempDir, String, bool) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.nc"), program).unwrap();
    let words = ["clearance", "part.nc", "-m", "mine.toml", "--mount", "0,0,-300"];
    let run = post_in(folder.path(), &[&words[..], more].concat());
    assert!(run.code < 2, "{}", run.err);
    (folder, format!("{}{}", run.out, run.err), run.code == 0)
}

/// Down into the pocket at rapid, and a hole by pecks, whose rapids go back down to where it was.
const DIVES: &str = "G0 X0. Y0.\nG0 Z-23.\nG1 X5. F800.\nG0 X0.\nG0 Z5.\nG53 G0 Z20.\nT2 M6\nS3000 M3\nG54\nG0 X30. Y22.\n\
                     G43 H2 Z5.\nG98 G83 Z-20. R2. Q5. F200.\nG80";

#[test]
fn a_pocket_that_was_cut_may_be_dived_into() {
    let program = program(DIVES);
    let (_, said, clear) = proven(&machine("cut = true", END_MILL), &program, &[]);
    assert!(clear, "{said}");
    assert_contains(&said, &["stock  holder T1", "stock  shank T1", "stock left, mm³"]);
    // Without it the rapid down hits.
    let (_, said, clear) = proven(&machine("", END_MILL), &program, &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits cutter T1"]);
}

#[test]
fn what_is_left_is_hit_at_rapid_by_holders_and_by_shanks() {
    let mine = machine("cut = true", END_MILL);
    // Beside the pocket there is material: the wall is met on the way, certainly.
    let through = program("G0 X0. Y0.\nG0 Z-20.\nG0 X34.");
    let (_, said, clear) = proven(&mine, &through, &[]);
    assert!(!clear);
    let line = through.lines().position(|line| line == "G0 X34.").unwrap() + 1;
    assert_contains(&said, &["stock hits cutter T1", &format!("part.nc:{line}\n")]);
    // A rapid onto the floor is no clear one: it touches.
    let (_, said, clear) = proven(&mine, &program("G0 X0. Y2.\nG0 Z-24."), &[]);
    assert!(!clear);
    assert_contains(&said, &["that stock stays clear of cutter T1 is not proven"]);
    // A holder that comes down to 10 mm above the tip meets the rim of the pocket.
    let low = END_MILL.replace("[60, 25]", "[88, 25]");
    let (_, said, clear) = proven(&machine("cut = true", &low), &program(""), &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits holder T1"]);
    // Edges that are shorter than the step: the shank cuts.
    let short = "cutter = [[0, 5], [40, 5]]\nedge = 3";
    let (_, said, clear) = proven(&machine("cut = true", short), &program(""), &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits shank T1"]);
    // A cut with the spindle standing is none.
    let stands = program("").replace("S3000 M3\n", "");
    let (_, said, clear) = proven(&mine, &stands, &[]);
    assert!(!clear);
    assert_contains(&said, &["while the spindle stands", "stock hits cutter T1"]);
}

/// A slot of 12 mm, cut along two lines, and a rapid between these along its middle: the walls come no nearer on the way, and
/// the whole of it is looked at in few steps, however fine the cells are.
#[test]
fn a_rapid_in_a_narrow_slot_is_proven_in_few_steps() {
    let slot = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X-50. Y-1.\nG43 H1 Z5.\n\
                G0 Z-6.\nG1 X50. F800.\nY1.\nX-50.\nG0 X-50. Y0.2\nG0 Z-5.5\nG0 X50.\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n";
    let mine = machine("cut = true\nresolution = 0.15", END_MILL);
    let (_, said, clear) = proven(&mine, slot, &[]);
    assert!(clear, "{said}");
    let computed = said.lines().find_map(|line| line.strip_prefix("distances computed")).unwrap();
    assert!(computed.trim().parse::<u32>().unwrap() < 100, "{said}");
    // Into a wall of it: where it does is found in few steps too.
    let (_, said, clear) = proven(&mine, &slot.replace("G0 X50.", "G0 X50. Y6."), &[]);
    assert!(!clear);
    let computed = said.lines().find_map(|line| line.strip_prefix("distances computed")).unwrap();
    assert!(computed.trim().parse::<u32>().unwrap() < 120, "{said}");
}

/// A hole along a tool axis that leans, with the control keeping the tip: the words of the way out lead beside its line by what
/// they are printed to, and no farther.
#[test]
fn a_tool_is_drawn_out_along_an_axis_that_leans() {
    let mine = "extends = \"ac-trunnion\"\nname = \"mine\"\n[control]\ntcp = \"control\"\n\
                [clearance]\nrapid_axes = \"together\"\n\
                [stock]\nblock = [[-50, -30, 0], [50, 30, 28]]\ncut = true\n\
                [tools.3]\nlength = 100\ncutter = [[0, 5], [60, 5]]\n";
    let drill = "%\nO1\nG21\nG17 G40 G80 G90 G94\nG53 G0 Z0.\nT3 M6\nS3000 M3\nG54\nG0 A21.716 C18.925\n\
                 G43.4 H3 X31.211 Y-86.028 Z228.831\nX8.017 Y-18.381 Z49.274\n\
                 G94 G1 X5.617 Y-11.381 Z30.694 F500.\nX3.217 Y-4.381 Z12.113\nG0 X6.277 Y-13.306 Z35.803\n\
                 X10.417 Y-25.381 Z67.855\nG53 G0 Z0.\nG49\nM30\n%\n";
    for mine in [mine.to_owned(), mine.replace("cut = true\n", "")] {
        let run = |program: &str| {
            let folder = tempfile::tempdir().unwrap();
            fs::write(folder.path().join("mine.toml"), &mine).unwrap();
            fs::write(folder.path().join("part.nc"), program).unwrap();
            post_in(folder.path(), &["clearance", "part.nc", "-m", "mine.toml"])
        };
        let out = run(drill);
        assert_eq!(out.code, 0, "{}{}", out.out, out.err);
        let beside = run(&drill.replace("G0 X6.277", "G0 X6.317"));
        assert_eq!(beside.code, 1, "{}{}", beside.out, beside.err);
        assert_contains(&beside.err, &["cutter T3"]);
    }
}

/// Layers are cut along the same lines: a shank no thicker than the edges goes where these have been.
#[test]
fn a_shank_may_be_where_edges_were_on_the_same_line() {
    let straight = "cutter = [[0, 5], [40, 5]]\nedge = 7";
    let (_, said, clear) = proven(&machine("cut = true", straight), &program(""), &[]);
    assert!(clear, "{said}");
    let thick = "cutter = [[0, 5], [7, 5], [7, 5.2], [40, 5.2]]\nedge = 7";
    let (_, said, clear) = proven(&machine("cut = true", thick), &program(""), &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits shank T1"]);
}

/// One plunge deeper than the edges are long, in one block as in two: the shank comes where these have cut before it.
#[test]
fn a_shank_follows_the_edges_down_a_hole() {
    let plunge = |more: &str| {
        program("").split("G0 X-20.").next().unwrap().to_owned()
            + more
            + "\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n"
    };
    let cutter = |points: &str, edge: u32| format!("cutter = {points}\nedge = {edge}");
    let straight = "[[0, 5], [40, 5]]";
    for (points, edge, down, clear) in [
        (straight, 7, "G1 Z-25. F300.", true),
        (straight, 7, "G1 Z-12. F300.\nG1 Z-25.", true),
        (straight, 7, "G1 Z-3. F300.\nG1 Z-25.", true),
        ("[[0, 0], [5, 5, { arc = 5 }], [40, 5]]", 7, "G1 Z-25. F300.", true),
        // A drill whose edges end below where it is as thick as it gets.
        ("[[0, 0], [3, 5], [40, 5]]", 2, "G1 Z-25. F300.", false),
        ("[[0, 5], [7, 5], [7, 4.5], [40, 4.5]]", 7, "G1 Z-25. F300.", true),
        ("[[0, 5], [7, 5], [7, 5.2], [40, 5.2]]", 7, "G1 Z-25. F300.", false),
        // A collar that stays above the hole, and one that does not.
        ("[[0, 5], [26, 5], [26, 8], [40, 8]]", 7, "G1 Z-25. F300.", true),
        ("[[0, 5], [24, 5], [24, 8], [40, 8]]", 7, "G1 Z-25. F300.", false),
        // Sideways in the depth the shank meets what no edge has cut.
        (straight, 7, "G1 Z-25. F300.\nX3.\nG0 X0.", false),
        // While the spindle turns back nothing is cut for certain.
        (straight, 7, "M4\nG1 Z-25. F300.", false),
    ] {
        let mine = machine("cut = true", &cutter(points, edge));
        let (_, said, found) = proven(&mine, &plunge(down), &[]);
        assert_eq!(found, clear, "{points} {down}: {said}");
    }
}

/// A ring about the nose of the spindle, 10 mm above the tip of the second tool.
#[test]
fn other_bodies_are_held_against_what_is_left() {
    let ring = "[fixture.ring]\non = \"t\"\ncylinder = [[0, 0, 530], [0, 0, 600]]\nradius = 8\n";
    let with = |stock: &str| {
        let mine = machine(stock, END_MILL).replace("[tools.1]", &format!("{ring}[tools.1]"));
        mine.replace("[tools.2]\nlength = 100", "[tools.2]\nlength = 80")
    };
    let dive = |more: &str| {
        program(&format!(
            "G53 G0 Z20.\nT2 M6\nS3000 M3\nG54\nG0 X0. Y0.\nG43 H2 Z5.\nG0 Z-20.\n{more}"
        ))
    };
    let (_, said, clear) = proven(&with("cut = true"), &dive(""), &[]);
    assert!(clear, "{said}");
    assert_contains(&said, &["stock  ring"]);
    let (_, said, clear) = proven(&with("cut = true"), &dive("G0 X26.\n"), &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits ring"]);
    let (_, said, clear) = proven(&with(""), &dive(""), &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits ring"]);
}

/// What a tool of no more than a radius cuts is not known, and is said.
#[test]
fn a_tool_that_is_not_drawn_removes_nothing() {
    let mine = machine("cut = true", "").replace("[tools.1]\nlength = 100\n", "[tools]\n1 = 100\n");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), mine).unwrap();
    fs::write(folder.path().join("part.nc"), program("G0 X0. Y2.\nG0 Z-23.")).unwrap();
    fs::write(folder.path().join("part.cls"), "CUTTER/10.\nLOADTL/1\nGOTO/0,0,0\n").unwrap();
    let words =
        ["clearance", "part.nc", "-m", "mine.toml", "--mount", "0,0,-300", "--cl", "part.cls"];
    let run = post_in(folder.path(), &words);
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert_contains(
        &run.err,
        &["what tool 1 cuts is not taken from the stock", "that stock stays clear of cutter T1"],
    );
}

#[test]
fn what_is_left_is_written_as_stl() {
    let (folder, said, clear) =
        proven(&machine("cut = true", END_MILL), &program(""), &["--stock-stl", "left.stl"]);
    assert!(clear, "{said}");
    let stl = fs::read(folder.path().join("left.stl")).unwrap();
    let count = u32::from_le_bytes(stl[80..84].try_into().unwrap()) as usize;
    assert_eq!(stl.len(), 84 + 50 * count);
    let number = |at: usize| f64::from(f32::from_le_bytes(stl[at..at + 4].try_into().unwrap()));
    // Six times the volume: the sum of the triple products of all corners.
    let six: f64 = (0..count)
        .map(|triangle| {
            let corner = |place: usize| {
                let at = 84 + 50 * triangle + 12 * (place + 1);
                [number(at), number(at + 4), number(at + 8)]
            };
            let [a, b, c] = [corner(0), corner(1), corner(2)];
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        })
        .sum();
    // The block less a pocket of 50 by 36 with corners of 5 mm.
    let pocket = 24.0 * (50.0 * 36.0 - (4.0 - std::f64::consts::PI) * 25.0);
    let truth = 80.0 * 60.0 * 30.0 - pocket;
    assert!((six / 6.0 - truth).abs() < 0.02 * truth, "{} of {truth}", six / 6.0);
    // Without a stock that is cut there is none.
    let (_, said, clear) =
        proven(&machine("", END_MILL), &program(""), &["--stock-stl", "left.stl"]);
    assert!(!clear);
    assert_contains(&said, &["no STL file is written"]);
}

/// Each line that cuts has its bounds: those of all of them hold what is cut, and steps of 6 mm are 6 mm deep.
#[test]
fn each_line_is_told_by_what_it_cuts() {
    let (folder, said, clear) =
        proven(&machine("cut = true", END_MILL), &program(""), &["--csv", "lines.csv"]);
    assert!(clear, "{said}");
    let text = fs::read_to_string(folder.path().join("lines.csv")).unwrap();
    let mut lines = text.lines();
    let head = "line,passes,clear_by,cut_at_least,cut_at_most,depth_at_least,depth_at_most,width_at_least,width_at_most";
    assert_eq!(lines.next(), Some(head));
    let (mut sums, mut deepest) = ([0.0; 2], [0.0f64; 2]);
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|word| word.parse().unwrap_or(0.0)).collect();
        assert!(row[1] == 1.0);
        assert!(row[3] <= row[4] && row[5] <= row[6] && row[7] <= row[8] && row[8] <= 10.0);
        sums = [sums[0] + row[3], sums[1] + row[4]];
        // But for plunges, which have no width.
        if row[8] > 0.0 {
            deepest = [deepest[0].max(row[5]), deepest[1].max(row[6])];
        }
    }
    // A pocket of 50 by 36 with corners of 5 mm.
    let truth = 24.0 * (50.0 * 36.0 - (4.0 - std::f64::consts::PI) * 25.0);
    assert!(sums[0] < truth && sums[1] > truth, "{sums:?} {truth}");
    assert!(deepest[0] > 5.5 && deepest[0] < 6.001 && deepest[1] > 5.999, "{deepest:?}");
}

/// A slot by a ball: half a circle, however its arc is held by lines; and a holder whose rounding clears what its corner would
/// not.
#[test]
fn arcs_of_cutters_and_holders_are_true_to_size() {
    let slot = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X-50. Y0.\nG43 H1 Z5.\n\
                G0 Z-5.\nG1 X50. F800.\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n";
    let ball = "cutter = [[0, 0], [5, 5, { arc = 5 }], [60, 5]]";
    let (_, said, clear) = proven(&machine("cut = true\nresolution = 0.1", ball), slot, &[]);
    assert!(clear, "{said}");
    let cut = said.lines().find_map(|line| line.strip_prefix("cut of it, mm³")).unwrap();
    let bounds: Vec<f64> = cut.split(" to ").map(|end| end.trim().parse().unwrap()).collect();
    let truth = 80.0 * std::f64::consts::PI * 25.0 / 2.0;
    assert!(bounds[0] <= truth && truth <= bounds[1], "{cut} {truth}");
    assert!(bounds[1] - bounds[0] < 0.1 * truth, "{cut}");
    // The nose of the holder is 12 mm above the tip and goes by the edge of the block, 11 mm from the middle, 1 mm above it: the
    // corner at r = 14 hits what the rounding by 8 does not.
    let wall = |holder: &str| {
        let first = format!("holder = {holder}\ncutter = [[0, 5], [12, 5]]");
        let mine = machine("", &first).replace("-30], [40, 30, 0]]", "-30], [40, -11, 13]]");
        let along = slot.replace("G0 Z-5.\nG1", "G0 Z0.\nG1");
        proven(&mine, &along, &[])
    };
    let (_, said, clear) = wall("[[0, 14], [88, 14]]");
    assert!(!clear && said.contains("stock hits holder T1"), "{said}");
    let (_, said, clear) = wall("[[0, 14], [80, 14], [88, 6, { arc = 8 }]]");
    assert!(clear, "{said}");
    // The same rounding hollow leaves still less.
    assert!(wall("[[0, 14], [80, 14], [88, 6, { arc = -8 }]]").2);
}

/// The corner of an end mill that the CL file describes: what goes by below it is not hit.
#[test]
fn a_corner_radius_of_the_cl_file_counts() {
    let mine = machine("", "").replace("[tools.1]\nlength = 100\n", "[tools]\n1 = 100\n");
    let mine = mine.replace(
        "[40, 30, 0]]",
        "[40, 30, -20]]\n[fixture.rail]\nblock = [[-40, 9.5, -330], [40, 30, -299]]",
    );
    let program = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X-60. Y0.\nG43 H1 Z5.\n\
                   G0 Z0.\nG1 X60. F800.\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n";
    for (cutter, clear) in [
        ("CUTTER/20", false),
        ("CUTTER/20,0", false),
        ("CUTTER/20,4", true),
        ("CUTTER/20,4,6,4,0,0,60", true),
        // Its corner lies elsewhere, or its side leans.
        ("CUTTER/20,4,5,4,0,0,60", false),
        ("CUTTER/20,4,6,4,0,5,60", false),
        ("TLDATA/MILL,20,4,60,0,0", true),
        ("TLDATA/MILL,20,4,60,3,0", false),
        ("TLDATA/DRILL,20,4,60,0,0", false),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mine.toml"), &mine).unwrap();
        fs::write(folder.path().join("part.nc"), program).unwrap();
        fs::write(folder.path().join("part.cls"), format!("{cutter}\nLOADTL/1\nGOTO/0,0,0\n"))
            .unwrap();
        let words =
            ["clearance", "part.nc", "-m", "mine.toml", "--mount", "0,0,-300", "--cl", "part.cls"];
        let run = post_in(folder.path(), &words);
        assert_eq!(run.code == 0, clear, "{cutter}: {}{}", run.out, run.err);
    }
}

/// A line that hits what is left is told as no clear one, and one that goes above it by how far.
#[test]
fn each_line_is_told_by_how_near_it_comes_to_what_is_left() {
    let program = program("G0 X0. Y0.\nG0 Z-20.\nG0 X34.\nG0 Z5.");
    let (folder, said, clear) =
        proven(&machine("cut = true", END_MILL), &program, &["--csv", "lines.csv"]);
    assert!(!clear, "{said}");
    let text = fs::read_to_string(folder.path().join("lines.csv")).unwrap();
    let clear_by = |wanted: &str| -> f64 {
        let line = program.lines().position(|line| line == wanted).unwrap() + 1;
        let row = text.lines().find(|row| row.starts_with(&format!("{line},"))).unwrap();
        row.split(',').nth(2).unwrap().parse().unwrap()
    };
    assert_eq!(clear_by("G0 X34."), 0.0, "{text}");
    // The tip 5 mm above the block, before anything is cut.
    let above = clear_by("G0 X-20. Y-13.");
    assert!(above > 4.7 && above < 5.001, "{above}");
}

/// A slot in tenths of a millimetre and a circle: what each line may take is what the tool sweeps at most, not what the cells
/// about it cannot tell.
#[test]
fn short_blocks_and_arcs_are_told_closely() {
    let mine = machine("cut = true\nresolution = 0.4", "cutter = [[0, 5], [30, 5]]");
    let begin = program("").split("G0 X-20.").next().unwrap().to_owned();
    let rows = |lines: &str| -> Vec<Vec<f64>> {
        let program = format!("{begin}{lines}\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n");
        let (folder, said, clear) = proven(&mine, &program, &["--csv", "lines.csv"]);
        assert!(clear, "{said}");
        let text = fs::read_to_string(folder.path().join("lines.csv")).unwrap();
        let row = |line: &str| line.split(',').map(|word| word.parse().unwrap_or(0.0)).collect();
        text.lines().skip(1).map(row).collect()
    };
    let blocks: Vec<String> =
        (1..=200).map(|step| format!("X{:.1}", -10.0 + 0.1 * f64::from(step))).collect();
    let slot = rows(&format!("G0 X-10. Y0.\nG1 Z-3. F300.\nG1 {} F800.", blocks.join("\n")));
    let cuts = slot.iter().filter(|row| row[8] > 0.0);
    let most: f64 = cuts.clone().map(|row| row[4]).sum();
    assert_eq!(cuts.count(), 200);
    let truth = 20.0 * 10.0 * 3.0;
    assert!(most >= truth && most < 1.05 * truth, "{most} {truth}");
    let circle = rows("G0 X15. Y0.\nG1 Z-3. F300.\nG3 X15. Y0. I-15. J0. F800.");
    let arc = circle
        .iter()
        .filter(|row| row[8] > 0.0)
        .max_by(|one, other| one[4].total_cmp(&other[4]))
        .unwrap();
    let truth = std::f64::consts::PI * (400.0 - 100.0) * 3.0 - std::f64::consts::PI * 75.0;
    assert!(
        arc[3] <= truth && truth <= arc[4] && arc[4] < 1.15 * truth && arc[3] > 0.8 * truth,
        "{arc:?} {truth}"
    );
    assert!(arc[5] > 2.9 && arc[5] <= 3.0 && arc[6] >= 3.0 && arc[6] < 3.05, "{arc:?}");
    assert!(arc[7] <= 10.0 && arc[8] >= 10.0 && arc[8] < 10.1, "{arc:?}");
}

/// Lines of a subprogram have one row, with how often they are run: of all passes what they cut, and the deepest.
#[test]
fn a_line_that_is_run_again_has_one_row() {
    let mine = machine("cut = true", "cutter = [[0, 5], [30, 5]]");
    let begin = program("").split("G0 X-20.").next().unwrap().to_owned();
    let program = format!(
        "{begin}G0 X-50. Y0.\nZ-2.\nM98 P5\nG0 Z-4.\nM98 P5\nG0 Z-6.\nM98 P5\nG0 Z5.\nG53 G0 Z20.\nM30\nO5\nG1 X50. F800.\nG0 X-50.\nM99\n%\n"
    );
    let (folder, said, clear) = proven(&mine, &program, &["--csv", "lines.csv"]);
    assert!(clear, "{said}");
    let text = fs::read_to_string(folder.path().join("lines.csv")).unwrap();
    let line = program.lines().position(|line| line == "G1 X50. F800.").unwrap() + 1;
    let rows: Vec<&str> = text.lines().filter(|row| row.starts_with(&format!("{line},"))).collect();
    let [row] = rows[..] else { panic!("{text}") };
    let row: Vec<f64> = row.split(',').map(|word| word.parse().unwrap_or(0.0)).collect();
    let truth = 80.0 * 10.0 * 6.0;
    assert!(row[1] == 3.0 && row[3] <= truth && truth <= row[4], "{row:?}");
    let lines: Vec<u64> =
        text.lines().skip(1).map(|row| row.split(',').next().unwrap().parse().unwrap()).collect();
    assert!(lines.windows(2).all(|pair| pair[0] < pair[1]), "{text}");
}

/// A cutter that stands cuts nothing, whether what it cuts would be taken from the stock or not.
#[test]
fn a_cutter_that_stands_is_told_in_any_stock() {
    let program = program("").replace("S3000 M3\n", "M5\n");
    for stock in ["", "cut = true"] {
        let (_, said, clear) = proven(&machine(stock, END_MILL), &program, &[]);
        assert!(!clear);
        assert_contains(&said, &["fed into the stock while the spindle stands", "part.nc:11"]);
    }
}

/// Five thousandths a peck: without a point Q counts so, which is told.
#[test]
fn pecks_in_least_increments_are_told() {
    let hole = |peck: &str| program(&format!("G0 X30. Y22.\nG98 G83 Z-5. R2. {peck} F200.\nG80"));
    let stock = machine("", END_MILL);
    let (_, said, _) = proven(&stock, &hole("Q5"), &[]);
    assert_contains(&said, &["warning[nc-peck]", "pecks of 0.0050 mm"]);
    for peck in ["Q5.", "Q5000"] {
        let (_, said, _) = proven(&stock, &hole(peck), &[]);
        assert!(!said.contains("nc-peck"), "{said}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    for (text, says) in [
        ("cut = true\nresolution = 0", "resolution"),
        ("cut = true\nresolution = 0.001", "finer than there is room for"),
        (
            "cut = true\n[fixture.vise]\ncut = true\nblock = [[90, 0, 0], [95, 5, 5]]",
            "only a stock gets less",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mine.toml"), machine(text, END_MILL)).unwrap();
        fs::write(folder.path().join("part.nc"), program("")).unwrap();
        let run = post_in(folder.path(), &["clearance", "part.nc", "-m", "mine.toml"]);
        assert_ne!(run.code, 0);
        assert_contains(&run.err, &[says]);
    }
}

/// What of a tool does not fit together, and a stock that stays whole, is told before a program runs.
#[test]
fn check_tells_of_tools_that_do_not_fit_together() {
    let told = |stock: &str, first: &str| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mine.toml"), machine(stock, first)).unwrap();
        let run = post_in(folder.path(), &["check", "mine.toml"]);
        format!("{}{}", run.out, run.err)
    };
    let whole = "the stock counts as it is before the first cut";
    assert_contains(&told("", END_MILL), &[whole]);
    let fits = told("cut = true", END_MILL);
    for message in
        [whole, "holder of tool 1", "edge of tool 1", "between cutter and holder of tool 1"]
    {
        assert!(!fits.contains(message), "{fits}");
    }
    let long = END_MILL.replace("[60, 25]", "[110, 25]");
    assert_contains(
        &told("cut = true", &long),
        &["the holder of tool 1 goes 110 mm down, and the tool is 100 mm long"],
    );
    let high = END_MILL.replace("edge = 22", "edge = 45");
    assert_contains(
        &told("cut = true", &high),
        &["edge of tool 1 is 45 mm above its tip, and its cutter ends at 40 mm"],
    );
    let apart = END_MILL.replace("[60, 25]", "[50, 25]");
    assert_contains(
        &told("cut = true", &apart),
        &["between cutter and holder of tool 1 nothing is drawn on 10 mm"],
    );
}
