//! Rapids beside the part, by whole programs: how near the cutter is to what it does not cut, where it has cut, and which
//! of several motions that are not clear is named.

use std::fs;

use post_testkit::assert_contains;

use crate::common::post_in;

/// A stock of 40 × 40 × 30 mm below Z0 that a cutter keeps 2 mm from at rapid, and two end mills, of which one is a
/// micrometre thinner above its edges.
const MILL: &str = "extends = \"vmc\"\nname = \"mine\"\n[stock]\nblock = [[-20, -20, -30], [20, 20, 0]]\n\
                    [tools.1]\nlength = 100\ncutter = [[0, 5], [60, 5]]\n\
                    [tools.2]\nlength = 100\ncutter = [[0, 5], [20, 5], [20, 4.999], [60, 4.999]]\n\
                    [clearance]\nrapid_axes = \"together\"\n";

const KEEPS: &str = "pairs = [{ between = [\"cutter\", \"stock\"], rapid = 2 }]\n";

/// What is said of a program.
struct Told {
    text: String,
    clear: bool,
    /// Lines of the program and how near bodies come on them, mm.
    clear_by: Vec<(u64, f64)>,
}

impl Told {
    fn of(machine: &str, program: &str, more: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mine.toml"), machine).unwrap();
        fs::write(folder.path().join("part.nc"), program).unwrap();
        let words = ["clearance", "part.nc", "-m", "mine.toml", "--csv", "lines.csv"];
        let run = post_in(folder.path(), &[&words, more].concat());
        assert!(run.code < 2, "{}", run.err);
        let lines = fs::read_to_string(folder.path().join("lines.csv")).unwrap();
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            Some((cells[0].parse().unwrap(), cells[2].parse().ok()?))
        };
        let clear_by = lines.lines().skip(1).filter_map(row).collect();
        Self { text: format!("{}{}", run.out, run.err), clear: run.code == 0, clear_by }
    }

    /// Of a tool over the middle of the stock, 50 mm above it; the first of `blocks` is line 10.
    fn milled(machine: &str, tool: u32, blocks: &str, more: &[&str]) -> Self {
        let program = format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT{tool} M6\nS1000 M3\nG54\nG0 X-100. Y0.\n\
             G43 H{tool} Z50.\n{blocks}\nG0 Z60.\nG0 X-100.\nG53 G0 Z20.\nM30\n%\n"
        );
        Self::of(machine, &program, &[&["--mount", "0,0,-300"], more].concat())
    }

    fn clear_by(&self, line: u64) -> f64 {
        self.clear_by.iter().find(|(known, _)| *known == line).unwrap().1
    }
}

/// Cut, out, and near again on the same line; then along a part that was not cut.
const OVER: &str = "G0 X0. Y0.\nG0 Z1.\nG1 Z-1. F500.\nG1 X5.\nG0 Z10.\nG0 Z0.3\n\
                    G0 X15.\nG0 X5.\nG0 Y5.\nG0 X0.\nG0 Y0.\nG0 X10.";

/// Six rapids 0.3 mm over the part are told each, whether the one that came near went where the cutter had been or not, of a
/// stock that is cut too.
#[test]
fn rapids_along_a_part_that_was_not_cut_are_told_behind_one_that_is_spared() {
    let machine = format!("{MILL}{KEEPS}");
    for more in [&[][..], &["--set", "stock.cut=true"]] {
        let told = Told::milled(&machine, 1, OVER, more);
        assert!(!told.clear);
        assert_contains(&told.text, &["part.nc:16", "not clear in 6 motions", "within 30°"]);
        // What was spared is as near as it is, 0.3 mm above the part, in the table of pairs too; in its cut that is nothing
        // to tell.
        assert!(told.clear_by.iter().all(|(line, by)| *line != 14 || *by == 0.0));
        if more.is_empty() {
            let mut rows = told.text.lines().map(|row| row.split_whitespace().collect::<Vec<_>>());
            let row = rows.find(|row| row.starts_with(&["stock", "cutter", "T1"])).unwrap();
            assert!(row[3].parse::<f64>().unwrap() <= 0.3, "{row:?}");
        }
        let near = told.clear_by(15);
        assert!((0.29..=0.3).contains(&near), "{near}");
        // Right behind a cut that is 0.3 mm above the part one rapid leaves it, and no more.
        let behind = "G0 X0. Y0.\nG0 Z1.\nG1 Z0.3 F500.\nG0 X5.\nG0 Y5.\nG0 X0.\nG0 Y0.";
        let told = Told::milled(&machine, 1, behind, more);
        assert_contains(&told.text, &["part.nc:14", "not clear in 3 motions"]);
        assert!(Told::milled(MILL, 1, OVER, more).clear);
    }
}

/// Back along the cut and aside to the next one, and out of a cut aside and up.
#[test]
fn rapids_between_cuts_are_clear() {
    let machine = format!("{MILL}{KEEPS}");
    for blocks in [
        "G0 X-40. Y10.\nG0 Z-1.\nG1 X26. F500.\nG0 X-26.\nG0 Y0.\nG1 X26.\nG0 X26.5\nG0 Z50.",
        "G0 X-40. Y10.\nG0 Z-1.\nG1 X10. F500.\nG0 Z0.3\nG0 Z-0.9\nG0 Z20.\nG0 Z-1.\nG1 X20.\nG0 Z5.",
        "G0 X0. Y0.\nG99 G83 Z-20. R2. Q5. F200.\nG80\nG0 Z20.\nG0 X8.\nG99 G83 Z-20. R2. Q5. F200.\nG80",
    ] {
        for more in [&[][..], &["--set", "stock.cut=true"]] {
            let told = Told::milled(&machine, 1, blocks, more);
            assert!(told.clear, "{blocks} {}", told.text);
        }
    }
}

/// The first motion that is not clear is named, and the worst beside it.
#[test]
fn the_first_motion_that_is_not_clear_is_named_and_the_worst() {
    let machine = format!("{MILL}{KEEPS}");
    let blocks = "G0 X-40. Y0.\nG0 Z1.5\nG0 X40.\nG0 Z0.7\nG0 X-40.\nG0 Z-2.\nG0 X40.\nG0 X-40.";
    let told = Told::milled(&machine, 1, blocks, &[]);
    let said = "stock comes within 1.5 mm of cutter T1; 2 mm are to be kept at";
    assert_contains(&told.text, &[said, "part.nc:12"]);
    let worst = "; not clear in 4 motions, the worst in line 16: stock hits cutter T1 at";
    assert_contains(&told.text, &[worst]);
    // One alone is its own worst.
    let told = Told::milled(&machine, 1, "G0 X-40. Y0.\nG0 Z1.5\nG0 X40.", &[]);
    assert!(!told.text.contains("worst"), "{}", told.text);
}

/// A cutter that is a micrometre thinner above is drawn out of what it has plunged into, and goes in again as far; not where it
/// came from aside, which leaves a micrometre.
#[test]
fn a_cutter_that_is_thinner_above_goes_out_as_it_came() {
    for (blocks, clear) in [
        ("G0 X0. Y0.\nG0 Z2.\nG1 Z-20. F500.\nG0 Z60.\nG0 Z-19.\nG1 Z-21.\nG0 Z50.", true),
        ("G0 X0. Y0.\nG0 Z2.\nG1 Z-10. F500.\nG0 Z-5.\nG0 Z-10.\nG1 Z-25.\nG0 Z60.", true),
        ("G0 X0. Y0.\nG0 Z2.\nG1 Z-10. F500.\nG0 Z60.\nG0 Z-10.5", false),
        ("G0 X0. Y0.\nG0 Z2.\nG1 Z-20. F500.\nG0 X0.1 Z60.", false),
        ("G0 X-40. Y0.\nG0 Z-25.\nG1 X0. F500.\nG0 Z60.", false),
    ] {
        let told = Told::milled(MILL, 2, blocks, &[]);
        assert_eq!(told.clear, clear, "{blocks} {}", told.text);
        if !clear {
            assert_contains(&told.text, &["out on the line on which it came", "cut = true"]);
        }
    }
}

const HEAD_AND_TABLE: &str = "extends = \"head-table-bc\"\nname = \"mine\"\n\
                              [tools.1]\nlength = 100\ncutter = [[0, 5], [60, 5]]\n\
                              [clearance]\nrapid_axes = \"together\"\n";

fn turned(blocks: &str) -> String {
    format!(
        "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nG53 G0 X0. Y0.\nT1 M6\nS1000 M3\nG54\nG0 B0. C0.\n\
         {blocks}\nG0 Z300.\nG49\nG53 G0 Z0.\nM30\n%\n"
    )
}

/// A cut that turns B along a slot is gone back at rapid, exactly as it was, by axes that go together; by any other way it is
/// not.
#[test]
fn a_cut_that_turns_is_gone_back_at_rapid() {
    let machine = format!("{HEAD_AND_TABLE}[stock]\nblock = [[-40, -20, -30], [40, 20, 0]]\n");
    let cut = "G43 H1 X0. Y0. Z300.\nZ50.\nG1 Z-5. F500.\nG1 X20. B10.";
    let apart: &[&str] = &["--set", "clearance.rapid_axes=independent"];
    for (back, more, clear) in [
        ("G0 X0. B0.", &[][..], true),
        ("G0 X0. B0.\nG0 X20. B10.\nG0 X0. B0.", &[], true),
        ("G0 X0. B0.5", &[], false),
        ("G0 X0. B0.", apart, false),
    ] {
        let program = turned(&format!("{cut}\n{back}"));
        for cells in [&[][..], &["--set", "stock.cut=true"]] {
            let told = Told::of(&machine, &program, &[more, cells].concat());
            // The cells of a slot that is cut may tell as much of a way near it.
            assert!(told.clear == clear || told.clear && !cells.is_empty(), "{back} {}", told.text);
        }
    }
}

/// A control that keeps the tip may lead it on its line at rapid, or the axes on theirs: both are proven, whatever `rapid_axes`
/// says.
///
/// The tip stands 300 mm from C, 300 mm below B. Kept, it is 50 mm high all along, and its cutter's upper end goes out by
/// 2.3 mm, as 300 cos c + 55 sin b does with c = 34.9/23.7 b; led by the axes, it is down to 300 (cos 23.7° + 1) / 2 -
/// 300 cos 11.85° = -6.3 mm below that, and goes in alone.
#[test]
fn a_rapid_with_the_tip_kept_is_proven_by_the_axes_line_and_by_the_tips() {
    let program = turned("G43.4 H1 X300. Y0. Z300.\nZ50.\nG0 C34.9 B23.7");
    let told = |block: &str| {
        let machine = format!("{HEAD_AND_TABLE}[stock.post]\non = \"b\"\nblock = {block}\n");
        Told::of(&machine, &program, &[])
    };
    for (block, clear) in [
        // Below the tip as it is kept, and beside the cutter's end as the axes lead it.
        ("[[270, -1, 40], [273, 1, 47]]", false),
        ("[[306.2, -1, 102], [308, 1, 104]]", false),
        ("[[270, -1, 30], [273, 1, 40]]", true),
        ("[[307.7, -1, 102], [309, 1, 104]]", true),
    ] {
        let told = told(block);
        assert_eq!(told.clear, clear, "{block} {}", told.text);
        if !clear {
            assert_contains(&told.text, &["stock post hits cutter T1", "part.nc:12"]);
        }
    }
}
