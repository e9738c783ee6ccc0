//! `post clearance`: what hits is found, with its pair and line, whether it was put in or grew; nothing is found where
//! nothing is.

use std::fs;

use post_testkit::{assert_contains, randomised};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{post_in, root, sample};

/// What the machine has besides its own file: a stock that the approach stays above, a holder, a cutter.
const BODIES: &str = "extends = \"ac-trunnion\"
name = \"with bodies\"
[stock]
block = [[-50, -30, 0], [50, 30, 28]]
[tools.3]
length = 100
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 5], [40, 5]]
";

/// A folder with the program of the blade, and the machine with `more` bodies.
fn folder(more: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    describe(&folder, more);
    let blade = root().join(sample("blade.cls"));
    let words = ["-m", "bodies.toml", blade.to_str().unwrap(), "-o", "blade.nc", "-q"];
    let made = post_in(folder.path(), &words);
    assert_eq!(made.code, 0, "{}", made.err);
    folder
}

fn describe(folder: &TempDir, more: &str) {
    fs::write(folder.path().join("bodies.toml"), format!("{BODIES}{more}")).unwrap();
}

/// What is said of the program, and whether it is clear.
fn proven(folder: &TempDir, more: &[&str]) -> (String, bool) {
    let mut words = vec!["clearance", "blade.nc", "-m", "bodies.toml"];
    words.extend(more);
    let run = post_in(folder.path(), &words);
    assert!(run.code < 2, "{}", run.err);
    (format!("{}{}", run.out, run.err), run.code == 0)
}

#[test]
fn what_is_clear_is_proven_and_what_grows_into_another_is_not() {
    let folder = folder("[fixture.post]\nblock = [[60, -60, 0], [90, 60, 40]]\n");
    let (said, clear) = proven(&folder, &[]);
    assert!(clear, "{said}");
    assert_contains(&said, &["post   cutter T3", "stock  holder T3", "without a body"]);
    // The same a little nearer than is kept.
    let (said, clear) = proven(&folder, &["--set", "clearance.keep=10"]);
    assert!(!clear);
    assert_contains(&said, &["post comes within", "of holder T3; 10 mm are to be kept"]);
    // The approach dives into a stock that is higher.
    describe(&folder, "[fixture.post]\nblock = [[60, -60, 0], [90, 60, 40]]\n");
    let higher = BODIES.replace("[50, 30, 28]", "[50, 30, 36]");
    fs::write(folder.path().join("bodies.toml"), higher).unwrap();
    let (said, clear) = proven(&folder, &["--set", "clearance.rapid_axes=together"]);
    assert!(!clear);
    assert_contains(&said, &["stock hits cutter T3", "blade.nc:18"]);
    // A holder that is as long as its tool touches what is cut.
    let longer = BODIES.replace("[60, 18]", "[98, 18]");
    fs::write(folder.path().join("bodies.toml"), longer).unwrap();
    let (said, clear) = proven(&folder, &[]);
    assert!(!clear);
    assert_contains(&said, &["stock hits holder T3"]);
}

/// A machine with a stock of 40 × 40 × 30 mm below Z0, an end mill, a thicker one and one for T-slots.
const MILL: &str = "extends = \"vmc\"\nname = \"mine\"\n[stock]\nblock = [[-20, -20, -30], [20, 20, 0]]\n\
                    [tools.1]\nlength = 100\ncutter = [[0, 5], [60, 5]]\n\
                    [tools.2]\nlength = 100\ncutter = [[0, 30], [60, 30]]\n\
                    [tools.3]\nlength = 100\ncutter = [[0, 10], [8, 10], [8, 4], [60, 4]]\n";

/// What is said of a program that brings `tool` over the stock, and whether it is clear.
fn milled(machine: &str, tool: u32, program: &str, more: &[&str]) -> (String, bool) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    let program = format!(
        "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT{tool} M6\nS1000 M3\nG54\nG0 X-100. Y0.\nG43 H{tool} Z50.\n\
         {program}G0 Z50.\nG0 X-100.\nG53 G0 Z20.\nM30\n%\n"
    );
    fs::write(folder.path().join("part.nc"), program).unwrap();
    let cl = "PARTNO/A\nUNITS/MM\nCUTTER/10\nLOADTL/1\nFEDRAT/24000,MMPM\nGOTO/0,0,50\nGOTO/0,0,-20\nFINI\n";
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let mut words = vec!["clearance", "part.nc", "-m", "mine.toml", "--mount", "0,0,-300"];
    words.extend(more);
    let run = post_in(folder.path(), &words);
    assert!(run.code < 2, "{}", run.err);
    (format!("{}{}", run.out, run.err), run.code == 0)
}

/// At rapid a cutter goes where it has been: out of the cut, down again to where it was, back along the cut; and nowhere else.
/// What a tool has cut another has not been in.
#[test]
fn a_rapid_goes_through_the_stock_where_the_tool_has_been() {
    let cut = "G0 X0. Y0.\nG1 Z-20. F500.\n";
    for (tool, program, clear) in [
        (1, format!("{cut}G0 Z50.\n"), true),
        (1, format!("{cut}T2 M6\nG43 H2\nG0 Z50.\n"), false),
        // Words that are rounded lean by as much.
        (1, format!("{cut}G0 X0.001 Z50.\n"), true),
        (1, format!("{cut}G0 X0.02 Z50.\n"), false),
        (1, "G0 X0. Y0.\nG99 G83 Z-20. R2. Q5. F200.\nG80\n".to_owned(), true),
        (1, format!("{cut}G0 Z2.\nG0 Z-19.\nG1 Z-25.\n"), true),
        (1, format!("{cut}G0 Z2.\nG0 Z-21.\n"), false),
        (1, format!("{cut}G0 Z2.\nG0 X1.\nG0 Z-19.\n"), false),
        // A cutter for T-slots goes out as it came, and not up.
        (3, "G0 Z-20.\nG1 X0. F500.\nG0 X-100.\n".to_owned(), true),
        (3, "G0 Z-20.\nG1 X0. F500.\nG0 Z50.\n".to_owned(), false),
        (3, "G0 Z-20.\nG1 X0. F500.\nG0 X100.\n".to_owned(), false),
    ] {
        let (said, found) = milled(MILL, tool, &program, &[]);
        assert_eq!(found, clear, "{program}: {said}");
    }
}

/// A rapid that begins and ends off the part keeps off it on the way as far as is to be kept at rapid; one that leaves it or
/// comes to it only touches nothing. The same of a stock that is cut.
#[test]
fn a_rapid_keeps_off_the_part_where_it_begins_and_ends_farther() {
    let past = |height: f64| format!("G0 X-100. Y0.\nG0 Z{height}\nG0 X100.\nG0 Z50.\n");
    let near = |height: f64| format!("G0 X0. Y0.\nG0 Z{height}\nG0 Z50.\n");
    let pair = "[clearance]\nrapid_axes = \"together\"\npairs = [{ between = [\"cutter\", \"stock\"], rapid = 3 }]\n";
    let all = "[clearance]\nrapid_axes = \"together\"\nkeep = 3\n";
    for cut in ["", "[stock]\ncut = true\n"] {
        let mill = match cut.is_empty() {
            true => MILL.to_owned(),
            false => MILL.replace("[stock]\n", cut),
        };
        for rules in [pair, all] {
            let machine = format!("{mill}{rules}");
            for (program, clear) in [
                (past(2.9), false),
                (past(3.1), true),
                (near(0.5), true),
                (near(-0.5), false),
                // From near to the part on along it, no nearer: no two rapids may what one may not.
                ("G0 X0. Y0.\nG0 Z1.\nG0 X10.\nG0 Z50.\n".to_owned(), false),
                ("G0 X0. Y0.\nG0 Z2.\nG0 Z1.\nG0 Z50.\n".to_owned(), true),
                // From a cut it leaves.
                ("G0 X0. Y0.\nG0 Z1.\nG1 Z0.5 F500.\nG0 X10.\nG0 Z50.\n".to_owned(), true),
            ] {
                let (said, found) = milled(&machine, 1, &program, &[]);
                assert_eq!(found, clear, "{cut}{rules}{program}: {said}");
                if program == past(2.9) {
                    assert_contains(&said, &["3 mm are to be kept"]);
                }
            }
        }
        assert!(milled(&mill, 1, &past(0.1), &[]).1);
    }
}

/// Led by the register of another tool the tool is as long as it is, and that is said.
#[test]
fn a_tool_is_as_long_as_it_is_whatever_register_leads_it() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\nname = \"v\"\n[workpiece]\nmount = [0, 0, -100]\n\
        [fixture.f]\nblock = [[-100, -100, -150], [100, 100, -110]]\n\
        [tools.1]\nlength = 100\ncutter = [[0, 5], [60, 5]]\n\
        [tools.2]\nlength = 150\ncutter = [[0, 5], [60, 5]]\n";
    fs::write(folder.path().join("v.toml"), machine).unwrap();
    for (register, said) in [
        ("H2", None),
        (
            "H1",
            Some(["f hits cutter T2", "tool 2 is 150 mm long, and the length in force is 100 mm"]),
        ),
    ] {
        let program = format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT2 M6\nS1000 M3\nG54\nG0 X0. Y0.\nG43 {register} Z50.\n\
             G1 Z10. F500.\nG0 Z80.\nG49\nG53 G0 Z20.\nM30\n%\n"
        );
        fs::write(folder.path().join("p.nc"), program).unwrap();
        let run = post_in(folder.path(), &["clearance", "p.nc", "-m", "v.toml"]);
        match said {
            None => assert_eq!(run.code, 0, "{}", run.err),
            Some(said) => assert_contains(&run.err, &said),
        }
    }
}

/// What a control makes of the program besides its words is proven, or said not to be.
#[test]
fn where_the_control_goes_beside_the_path_nothing_is_clear() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\nname = \"v\"\n[workpiece]\nmount = [0, 0, -100]\n\
        [fixture.wall]\nblock = [[40, 8, -130], [80, 40, -85]]\n\
        [tools.1]\nlength = 100\ncutter = [[0, 5], [60, 5]]\n";
    fs::write(folder.path().join("v.toml"), machine).unwrap();
    fs::write(folder.path().join("zero.toml"), "[radius]\n1 = 0\n").unwrap();
    fs::write(folder.path().join("five.toml"), "[radius]\n1 = 5\n").unwrap();
    let compensated = "G1 Z-20. F500.\nG41 D1 G1 X20.\nX100.\nG40 X120.\n";
    for (blocks, offsets, said) in [
        ("G1 Z-20. F500.\nX100.\n", None, None),
        (compensated, Some("zero.toml"), None),
        (compensated, Some("five.toml"), Some("goes beside this path by 5 mm")),
        (compensated, None, Some("by what register 1 holds")),
        ("G98 G76 X60. Y0. Z-20. R2. Q10. F100.\nG80\n", None, Some("draws the tool aside")),
        ("G1 Z-20. F500.\n/G0 Z50.\nG0 X0. Y-60.\n", None, Some("blocks behind / are run here")),
    ] {
        let program = format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nG53 G0 X0. Y0.\nT1 M6\nS1000 M3\nG54\nG0 X0. Y-10.\nG43 H1 Z50.\n\
             {blocks}G0 Z80.\nG49\nG53 G0 Z0.\nM30\n%\n"
        );
        fs::write(folder.path().join("p.nc"), program).unwrap();
        let mut words = vec!["clearance", "p.nc", "-m", "v.toml"];
        words.extend(offsets.iter().flat_map(|offsets| ["--offsets", *offsets]));
        let run = post_in(folder.path(), &words);
        assert_eq!(run.code, i32::from(said.is_some()), "{blocks}: {}", run.err);
        said.iter().for_each(|said| assert_contains(&run.err, &[*said]));
    }
}

/// What is as fast as a rapid is one where rapids stand at feed, but where the CL file cuts as fast.
#[test]
fn a_cut_as_fast_as_the_axes_is_one_by_the_cl_file() {
    let machine = format!("{MILL}[control]\nrapid = \"linear\"\n");
    let program = "G1 X0. F24000.\nG1 Z-20. F24000.\nG1 X10.\nG1 Z50.\n";
    assert!(!milled(&machine, 1, program, &[]).1);
    let (said, clear) = milled(&machine, 1, program, &["--cl", "part.cls"]);
    assert!(clear, "{said}");
}

/// A machine stands at zero in no program that does not say so.
#[test]
fn where_axes_stand_before_a_program_leads_them_is_no_place() {
    let post = |x: i32| {
        format!("{MILL}[fixture.post]\nblock = [[{}, -10, -60], [{}, 10, -40]]\n", x - 10, x + 10)
    };
    let (said, clear) = milled(&post(0), 1, "", &[]);
    assert!(clear, "{said}");
    assert_contains(&said, &["does not say where it begins in Y, X, Z", "to line 8"]);
    assert!(!milled(&post(-100), 1, "", &[]).1);
}

#[test]
fn pairs_that_are_left_out_are_left_out_and_names_must_be_of_something() {
    let fixture = "[fixture.post]\nblock = [[-10, -10, 0], [10, 10, 60]]\n[clearance]\n";
    let folder = folder(fixture);
    assert!(!proven(&folder, &[]).1);
    describe(
        &folder,
        &format!("{fixture}ignore = [[\"post\", \"cutter\"], [\"holder\", \"post\"]]\n"),
    );
    let (said, clear) = proven(&folder, &[]);
    assert!(clear, "{said}");
    describe(&folder, &format!("{fixture}ignore = [[\"pots\", \"cutter\"]]\n"));
    let (said, clear) = proven(&folder, &[]);
    assert!(!clear);
    assert_contains(
        &said,
        &["[clearance] names pots", "--> bodies.toml:", "known are post, w, b, t, stock, holder"],
    );
}

#[test]
fn a_pair_keeps_a_distance_of_its_own() {
    let fixture = "[fixture.post]\nblock = [[60, -60, 0], [90, 60, 40]]\n[clearance]\n";
    let folder = folder(fixture);
    // They come as near as 4.4 mm at feed.
    for (pairs, is_clear) in [
        ("{ between = [\"holder\", \"post\"], keep = 5 }", false),
        ("{ between = [\"post\", \"holder T3\"], keep = 5 }", false),
        ("{ between = [\"holder\", \"stock\"], keep = 5 }", true),
        ("{ between = [\"holder\", \"post\"], keep = 0, rapid = 5 }", true),
        // The last holds.
        (
            "{ between = [\"t\", \"w\"], keep = 5 }, { between = [\"holder\", \"post\"], keep = 1 }",
            true,
        ),
    ] {
        describe(&folder, &format!("{fixture}pairs = [{pairs}]\n"));
        let (said, clear) = proven(&folder, &[]);
        assert_eq!(clear, is_clear, "{pairs}: {said}");
        assert!(clear || said.contains("of holder T3; 5 mm are to be kept"), "{said}");
    }
    // Others keep what is kept by all.
    describe(
        &folder,
        &format!(
            "{fixture}keep = 20\npairs = [{{ between = [\"holder\", \"post\"], keep = 1 }}]\n"
        ),
    );
    let (said, clear) = proven(&folder, &[]);
    assert!(!clear);
    assert_contains(&said, &["of cutter T3; 20 mm are to be kept"]);
    assert!(!said.contains("of holder T3"), "{said}");
    describe(
        &folder,
        "[clearance]\npairs = [{ between = [\"cutter T3\", \"stock\"], keep = 1 }]\n",
    );
    let said = proven(&folder, &[]).0;
    assert_contains(&said, &["cutter and stock keep no distance at feed", "--> bodies.toml:"]);
}

/// A fixture that a pair names may be taken away for one job.
#[test]
fn a_pair_of_a_fixture_that_is_taken_away_is_without_effect() {
    let post = "[fixture.post]\nfile = \"post.stl\"\n";
    let folder = folder(&format!(
        "{post}[clearance]\nkeep = 0\npairs = [{{ between = [\"holder\", \"post\"], keep = 1 }}]\n"
    ));
    assert_contains(&proven(&folder, &[]).0, &["post.stl: there is no such regular file"]);
    let (said, clear) = proven(&folder, &["--set", "fixture.post.file=\"\""]);
    assert!(clear, "{said}");
    let told = "warning[clearance-body]: post is taken away: what [clearance] says of the pair";
    assert_contains(&said, &[told]);
}

/// The program is proven before it gets its name, and what is said names the line of the CL file.
#[test]
fn a_program_that_is_not_clear_is_not_written() {
    let folder = folder("");
    let blade = root().join(sample("blade.cls"));
    let blade = blade.to_str().unwrap();
    let post = |more: &[&str]| {
        let words =
            ["-m", "bodies.toml", blade, "-o", "new.nc", "--summary", "new.json", "--clearance"];
        post_in(folder.path(), &[&words[..], more].concat())
    };
    let high =
        ["--set", "stock.block=[[-50,-30,0],[50,30,36]]", "--set", "clearance.rapid_axes=together"];
    let run = post(&high);
    assert_eq!(run.code, 1, "{}", run.out);
    assert_contains(
        &run.err,
        &["stock hits cutter T3", "blade.cls, line 16)", "new.nc:18", "nothing was written"],
    );
    assert!(!folder.path().join("new.nc").exists() && !folder.path().join("new.json").exists());
    // `post clearance` says the same of the program that is written without.
    let (said, _) = proven(&folder, &high);
    let first = |said: &str| {
        said.lines().find_map(|line| Some(line.split_once("error[clearance]: ")?.1.to_owned()))
    };
    let told = first(&run.err).unwrap();
    assert_eq!(told.strip_suffix(&format!(" ({blade}, line 16)")), first(&said).as_deref());
    // One that is clear is the same as without.
    let run = post(&[]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_contains(&run.out, &["clearance", "2 pairs of bodies proven to stay apart by"]);
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(text("new.nc").replace("NEW", "BLADE"), text("blade.nc"));
    let summary: Value = serde_json::from_str(&text("new.json")).unwrap();
    let (table, _) = proven(&folder, &[]);
    let pairs = summary["clearance"]["pairs"].as_array().unwrap();
    assert_eq!(pairs.len(), 2);
    for pair in pairs {
        let nearest = format!("{:.3}", pair["nearest_mm"].as_f64().unwrap());
        assert!(pair["clear_by_mm"].as_f64() <= pair["nearest_mm"].as_f64());
        assert_contains(&table, &[&nearest]);
    }
}

#[test]
fn verify_batches_and_job_files_prove_as_posting_does() {
    let folder = folder("");
    let blade = root().join(sample("blade.cls"));
    let blade = blade.to_str().unwrap();
    let verify = |more: &[&str]| {
        let words = ["verify", "blade.nc", "-m", "bodies.toml", "--against", blade, "--clearance"];
        post_in(folder.path(), &[&words[..], more].concat())
    };
    let run = verify(&["--summary", "v.json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_contains(&run.out, &["pairs of bodies", "stock  holder T3"]);
    let text = fs::read_to_string(folder.path().join("v.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["clearance"]["pairs"].as_array().unwrap().len(), 2);
    let run = verify(&["--set", "clearance.keep=30"]);
    assert_eq!(run.code, 1, "{}", run.out);
    assert_contains(&run.err, &["stock comes within", "30 mm are to be kept", "blade.cls, line "]);
    // A batch has columns of it, and refuses.
    let job = |keep: u32| {
        format!(
            "{{\"file\": {blade:?}, \"machine\": \"bodies.toml\", \"set\": {{\"clearance.keep\": {keep}}}}}\n"
        )
    };
    fs::write(folder.path().join("jobs.jsonl"), job(0) + &job(30)).unwrap();
    let run = post_in(folder.path(), &["batch", "jobs.jsonl", "--clearance", "-o", "rows.jsonl"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = fs::read_to_string(folder.path().join("rows.jsonl")).unwrap();
    let rows: Vec<Value> = rows.lines().map(|row| serde_json::from_str(row).unwrap()).collect();
    assert_eq!(rows[0]["nearest_approach_bodies"], "stock / cutter T3");
    assert_eq!(rows[0]["clear_by_mm"], summary["clearance"]["pairs"][0]["clear_by_mm"]);
    assert_eq!((&rows[0]["state"], &rows[1]["state"]), (&"written".into(), &"refused".into()));
    assert_eq!(rows[1]["codes"], "clearance");
    // What a job sets stands in the place of what the machine file has, whatever its shape, or takes it away.
    let round = ["--set", "stock.cylinder=[[0,0,0],[0,0,60]]", "--set", "stock.radius=20"];
    let run = verify(&[&round[..], &["--set", "clearance.keep=5"]].concat());
    assert_eq!(run.code, 1, "{}", run.out);
    assert_contains(&run.err, &["stock", "of holder T3"]);
    let run =
        verify(&["--set", "stock.file=\"\"", "--set", "fixture.far.block=[[300,0,0],[310,9,9]]"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(!run.out.contains("stock  "), "{}", run.out);
    // A job file asks for it, and brings a stock of its own.
    let job = format!(
        "machine = \"bodies.toml\"\ncl = {blade:?}\noutput = \"job.nc\"\nclearance = true\n\
         set = {{ \"fixture.clamp.block\" = [[-10, -10, 0], [10, 10, 60]] }}\n"
    );
    fs::write(folder.path().join("part.job.toml"), job).unwrap();
    let run = post_in(folder.path(), &["part.job.toml"]);
    assert_eq!(run.code, 1, "{}", run.out);
    assert_contains(&run.err, &["clamp hits cutter T3"]);
}

#[test]
fn check_tells_what_touches_and_what_has_no_body() {
    let folder = folder(
        "[fixture.post]\nblock = [[-10, -10, 300], [10, 10, 460]]\n[fixture.head]\non = \"t\"\nblock = [[-9, -9, 400], [9, 9, 500]]\n",
    );
    let run = post_in(folder.path(), &["check", "bodies.toml"]);
    assert_contains(
        &run.err,
        &[
            "nothing is proven of what has no body: A, b, Y, X",
            "head and post touch where the axes stand at zero",
        ],
    );
}

/// What `post clearance` refuses of a machine file, or leaves out, is told by `post check` in the same words.
#[test]
fn check_tells_all_that_clearance_refuses() {
    let folder = tempfile::tempdir().unwrap();
    let block = "block = [[0, 0, -40], [100, 100, 0]]\n";
    fs::write(folder.path().join("part.nc"), "%\nO1\nG21 G90\nM30\n%\n").unwrap();
    let sheet = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid a\n";
    fs::write(folder.path().join("open.stl"), sheet).unwrap();
    for (stock, says) in [
        (
            format!("{block}cut = true\npart = \"none.stl\""),
            ["the part cannot be used", "the path is that from the machine file"],
        ),
        (
            format!("{block}cut = true\nresolution = 0.001"),
            ["finer than there is room for", "help: resolution = 0."],
        ),
        ("file = \"open.stl\"\ncut = true".to_owned(), ["closed surfaces alone", "as a solid"]),
    ] {
        let text = format!("extends = \"vmc\"\nname = \"a\"\n[stock]\n{stock}\n");
        fs::write(folder.path().join("m.toml"), text).unwrap();
        for words in [&["check", "m.toml"][..], &["clearance", "part.nc", "-m", "m.toml"]] {
            let run = post_in(folder.path(), words);
            assert_contains(&run.err, &["error[clearance-body]", says[0], says[1]]);
            assert_eq!(run.code, 1, "{}", run.err);
        }
    }
    // What may be right for one job and wrong for another is a warning.
    for (more, says) in [
        ("length = 90\ncutter = [[0, 5], [50, 5]]", "no shank is held against the stock"),
        ("length = 90\nedge = 10", "edge of tool 1 has no effect: its cutter is not drawn"),
        ("holder = [[0, 5], [50, 5]]", "how long tool 1 is the machine file does not say"),
    ] {
        let text = format!(
            "extends = \"vmc\"\nname = \"a\"\n[stock]\n{block}cut = true\n[tools.1]\n{more}\n"
        );
        fs::write(folder.path().join("m.toml"), text).unwrap();
        let run = post_in(folder.path(), &["check", "m.toml"]);
        assert_contains(&run.err, &["warning[clearance-body]", says]);
        assert_eq!(run.code, 0, "{}", run.err);
    }
    let text =
        format!("extends = \"vmc\"\nname = \"a\"\n[stock]\n{block}cut = true\nresolution = 99\n");
    fs::write(folder.path().join("m.toml"), text).unwrap();
    let run = post_in(folder.path(), &["check", "m.toml"]);
    assert_contains(&run.err, &["resolution of stock is 99 mm, and it is 40 mm thick"]);
    // And that ways would go through a part that is not drawn.
    fs::write(
        folder.path().join("m.toml"),
        "extends = \"vmc\"\nname = \"a\"\n[clearance]\nlink = true\n",
    )
    .unwrap();
    let run = post_in(folder.path(), &["check", "m.toml"]);
    assert_contains(&run.err, &["no [stock] is drawn: they would go through the part"]);
}

#[test]
fn check_draws_all_bodies_with_their_names() {
    let folder = folder("[fixture.post]\nblock = [[60, -60, 0], [90, 60, 40]]\n");
    let run = post_in(folder.path(), &["check", "bodies.toml", "--bodies", "bodies.svg"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let drawn = fs::read_to_string(folder.path().join("bodies.svg")).unwrap();
    for name in ["post", "stock", "holder T3", "cutter T3"] {
        assert_eq!(drawn.matches(&format!(">{name}</text>")).count(), 3, "{name}");
    }
    // The stock stands where the part sits, the tool at the gauge point.
    assert_contains(&drawn, &["post: X 60.0 to 90.0, Y -60.0 to 60.0, Z 0.0 to 40.0 mm"]);
}

#[test]
fn bodies_that_cannot_be_are_refused_by_their_line() {
    let folder = folder("");
    for (more, says) in [
        ("[fixture.a]\n", "a has no shape, or more than one"),
        (
            "[fixture.a]\non = \"Q\"\nfile = \"a.stl\"\n",
            "fixture a hangs on nothing of the machine",
        ),
        ("[fixture.a]\nfile = \"a.step\"\n", "no name of an STL file"),
        ("[fixture.a]\nfile = \"a.stl\"\n", "there is no such regular file"),
        ("[clearance]\nkeep = -1\n", "[clearance] keep is -1 mm"),
        ("[fixture.stock]\nblock = [[0, 0, 0], [9, 9, 9]]\n", "a fixture cannot be called stock"),
        ("[fixture.A]\nblock = [[0, 0, 0], [9, 9, 9]]\n", "a fixture cannot be called A"),
        (
            "[fixture.\"cutter T1\"]\nblock = [[0, 0, 0], [9, 9, 9]]\n",
            "a fixture cannot be called cutter T1",
        ),
        (
            "[fixture.a]\ncylinder = [[0, 0, 5], [0, 0, 5]]\nradius = 3\n",
            "a has no length between the ends of its cylinder",
        ),
        (
            "[clearance]\nignore = [[\"holder T9\", \"b\"]]\n",
            "[clearance] names holder T9, and no holder of tool 9 is drawn",
        ),
        (
            "[clearance]\nignore = [[\"cutter T9\", \"b\"]]\n",
            "[clearance] names cutter T9, and nothing describes tool 9",
        ),
        ("[tools.4]\nholder = [[0, -5], [3, 5]]\n", "the holder of tool 4 has the radius -5 mm"),
        (
            "[tools.4]\ncutter = [[10, 5], [30, 5]]\n",
            "the cutter of tool 4 begins 10 mm above its tip",
        ),
        (
            "[tools.4]\ncutter = [[-1, 5], [30, 5]]\n",
            "the cutter of tool 4 begins 1 mm below its tip",
        ),
        (
            "[tools.4]\ncutter = [[0, 5], [50, 5], [20, 5]]\n",
            "the cutter of tool 4 goes back, from z = 50 to 20 mm",
        ),
        (
            "[tools.4]\ncutter = [[0, 0], [5, 9, { arc = 5 }]]\n",
            "an arc of 5 mm of the cutter of tool 4 does not reach from one point to the next, 10.29",
        ),
        (
            "[tools.4]\ncutter = [[0, 0], [0, 5, { arc = 5 }]]\n",
            "an arc of 5 mm of the cutter of tool 4 goes back in z on its way",
        ),
        (
            "[tools.4]\nholder = [[0, 1], [8, 1, { arc = -5 }]]\n",
            "an arc of -5 mm of the holder of tool 4 comes to r = -1 mm, beyond the axis",
        ),
        (
            "[tools.4]\ncutter = [[0, 0, { arc = 5 }], [5, 5]]\n",
            "the cutter of tool 4 begins with an arc, and no point is before it",
        ),
        ("[tools.4]\ncutter = [[0, 0], [5, 5, { radius = 5 }]]\n", "there is no key `radius` here"),
        ("[tools.4]\ncutter = [[0, 0], [5]]\n", "a point of 1 things, expected [z, r]"),
        (
            "[tools.4]\nholder = [[-30, 20], [0, 20]]\n",
            "the holder of tool 4 ends at z = 0 mm: no part of it is below the gauge point",
        ),
    ] {
        describe(&folder, more);
        let (said, clear) = proven(&folder, &[]);
        assert!(!clear && said.contains(says), "{more}: {said}");
    }
}

/// Where the tool stands behind each motion: line, tip and tool axis, part frame, as the table of motions has them.
fn stands(folder: &TempDir) -> Vec<(u64, [f64; 3], [f64; 3])> {
    let run = post_in(folder.path(), &["read", "blade.nc", "-m", "bodies.toml", "--csv", "-"]);
    let mut rows = run.out.lines();
    let heads: Vec<&str> = rows.next().unwrap().split(',').collect();
    let column = |name: &str| heads.iter().position(|head| *head == name).unwrap();
    let tip = ["tip_x", "tip_y", "tip_z"].map(column);
    let axis = ["axis_i", "axis_j", "axis_k"].map(column);
    rows.map(|row| {
        let cells: Vec<&str> = row.split(',').collect();
        let of = |columns: [usize; 3]| columns.map(|column| cells[column].parse().unwrap());
        (cells[0].parse().unwrap(), of(tip), of(axis))
    })
    .collect()
}

/// How far the cutter (a cylinder of radius 5, 40 mm long) is from a block at most: balls inside of it.
fn farthest(tip: [f64; 3], axis: [f64; 3], [low, high]: [[f64; 3]; 2]) -> f64 {
    let balls = (5..=35).map(|along| {
        let off = [0, 1, 2].map(|place: usize| {
            let at = tip[place] + axis[place] * f64::from(along);
            (low[place] - at).max(at - high[place]).max(0.0)
        });
        off.iter().map(|off| off * off).sum::<f64>().sqrt() - 5.0
    });
    balls.fold(f64::INFINITY, f64::min)
}

#[test]
fn fixtures_that_were_put_in_the_way_are_all_found() {
    let (rounds, mut rng) = randomised(60, 321);
    let folder = folder("");
    // Before that line it is not known where the machine stands, and on it no length is in force: what is told as its tip is
    // the gauge point.
    let (said, _) = proven(&folder, &[]);
    let known = said.split("the way to line ").nth(1).unwrap().split(' ').next().unwrap();
    let known: u64 = known.parse().unwrap();
    let mut stands = stands(&folder);
    stands.retain(|(line, ..)| *line > known);
    let (mut hits, mut clear_ones) = (0, 0);
    for round in rounds {
        // Of every two one is put farther away, where it mostly stays clear.
        let spread = if round % 2 == 0 { 30.0 } else { 120.0 };
        let (_, tip, axis) = stands[rng.pick(stands.len())];
        let along = rng.range(0.0, 60.0);
        let size = [0; 3].map(|_| rng.range(1.0, 15.0));
        let middle =
            [0, 1, 2].map(|place| tip[place] + axis[place] * along + rng.range(-spread, spread));
        let block =
            [-1.0, 1.0].map(|side| [0, 1, 2].map(|place| middle[place] + side * size[place]));
        let first = stands.iter().find(|(_, tip, axis)| farthest(*tip, *axis, block) <= 0.0);
        describe(
            &folder,
            &format!(
                "[fixture.planted]\nblock = {block:?}\n[clearance]\nignore = [[\"holder\", \"planted\"]]\n"
            ),
        );
        let (said, clear) = proven(&folder, &[]);
        let apart = stands.iter().map(|(_, tip, axis)| farthest(*tip, *axis, block));
        let apart = apart.fold(f64::INFINITY, f64::min);
        let Some((line, ..)) = first else {
            clear_ones += u32::from(clear);
            // Between the ends of motions it may come nearer: then a place is told at which it hits.
            let hit = said.contains("planted hits cutter T3 at");
            assert!(clear || hit || apart < 8.0, "{apart} {block:?} {said}");
            continue;
        };
        hits += 1;
        assert!(!clear, "{block:?} {said}");
        let found = said.lines().find_map(|line| line.trim().strip_prefix("--> blade.nc:"));
        let found: u64 = found.unwrap().split(':').next().unwrap().parse().unwrap();
        assert!(
            said.contains("planted hits cutter T3")
                || said.contains("planted stays clear of cutter T3")
        );
        // Where a motion ends in the block the next one begins in it, and either is told.
        assert!(found <= line + 1, "{found} {line} {said}");
    }
    // By chance either may be few.
    assert!(hits > 0 && clear_ones > 0, "{hits} {clear_ones}");
}
