//! Ways between passes that are as bodies leave them: proven clear, verified, and lower or shorter where they can be.

use std::fs;

use post_testkit::{assert_contains, randomised};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{post_in, root, sample};

/// What every machine here has: a table, a vise, a head, a stock and two tools.
const BODIES: &str = "[fixture.vise]
block = [[-50, -40, 0], [50, 40, 60]]
[fixture.head]
cylinder = [[0, 0, 502], [0, 0, 620]]
radius = 60
on = \"t\"
[stock]
block = [[-30, -30, 0], [30, 30, 40]]
[tools.2]
length = 120
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 6], [50, 6]]
[tools.6]
length = 120
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 2.5], [55, 2.5]]
[clearance]
keep = 1
";

/// The sample with four facets and a drill, on a machine with `more` bodies.
fn folder(machine: &str, more: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let head = format!(
        "extends = \"{machine}\"\nname = \"with bodies\"\n[workpiece]\nmount = [0, 0, 60]\n"
    );
    fs::write(folder.path().join("m.toml"), format!("{head}{BODIES}{more}")).unwrap();
    folder
}

const LOW: [&str; 2] = ["--set", "clearance.low_retracts=true"];
const LINK: [&str; 2] = ["--set", "clearance.link=true"];

/// The program that is made of `cl`, and its summary; it is proven and held against its CL file once more.
fn made(folder: &TempDir, cl: &str, more: &[&str]) -> (String, Value) {
    let words = ["-m", "m.toml", cl, "-o", "f.nc", "-q", "--summary", "s.json"];
    let run = post_in(folder.path(), &[&words, more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let proof = post_in(folder.path(), &["clearance", "f.nc", "-m", "m.toml", "--cl", cl]);
    assert_eq!(proof.code, 0, "{}{}", proof.out, proof.err);
    let words = ["verify", "f.nc", "-m", "m.toml", "--against", cl, "--posted"];
    let held = post_in(folder.path(), &[&words, more].concat());
    assert_eq!(held.code, 0, "{}", held.err);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    (read("f.nc"), serde_json::from_str(&read("s.json")).unwrap())
}

/// Where the depth axis is retracted to, in the order of the program.
fn retracts(program: &str) -> Vec<f64> {
    let lines = program
        .lines()
        .filter(|line| ["M91", "G53 G0 Z", "SUPA"].iter().any(|word| line.contains(word)));
    let words = lines.filter_map(|line| {
        let mut words = line.split_whitespace();
        words.find_map(|word| word.strip_prefix('Z')?.trim_start_matches('=').parse().ok())
    });
    words.collect()
}

#[test]
fn the_tool_is_retracted_as_high_as_bodies_ask_for() {
    let facets = root().join(sample("facets.apt"));
    let facets = facets.to_str().unwrap();
    for machine in ["dmu50", "ac-trunnion", "ac-trunnion-840d", "head-table-bc", "head-head"] {
        let folder = folder(machine, "rapid_axes = \"together\"\n");
        let (ever, summary) = made(&folder, facets, &[]);
        assert_eq!(summary.get("ways_across"), None);
        let (low, summary) = made(&folder, facets, &LOW);
        let [ever, low] = [retracts(&ever), retracts(&low)];
        assert_eq!(ever.len(), low.len(), "{machine}");
        assert!(ever.iter().zip(&low).all(|(ever, low)| low <= ever), "{machine}");
        let lower = ever.iter().zip(&low).filter(|(ever, low)| low < ever).count();
        let ways = &summary["ways_across"];
        assert_eq!((&ways["low"], lower), (&3.into(), 3), "{machine}: {low:?}");
        let saved = ways["saved_s"].as_f64().unwrap();
        assert!(saved > 0.5, "{machine}: {ways}");
        // Past bodies it is quicker still, where axes may stand anywhere.
        let (_, summary) = made(&folder, facets, &LINK);
        let past = &summary["ways_across"];
        let anywhere = machine != "head-table-bc";
        assert_eq!(past["past"] == 3, anywhere, "{machine}: {past}");
        assert!(past["saved_s"].as_f64().unwrap() >= saved, "{machine}: {past}");
    }
}

/// Limits between axes do not stand in the way: the program is refused where one is passed on a way.
#[test]
fn ways_across_keep_limits_between_axes() {
    let facets = root().join(sample("facets.apt"));
    let facets = facets.to_str().unwrap();
    let limit = "[[limit]]\nkeep = \"Z > -320 + 4 * abs(A)\"\n";
    let folder = folder("ac-trunnion", &format!("rapid_axes = \"together\"\n{limit}"));
    for (option, key) in [(LOW, "low"), (LINK, "past")] {
        let (program, summary) = made(&folder, facets, &option);
        assert_eq!(summary["ways_across"][key], 3, "{summary}\n{program}");
    }
}

/// Two facets that lean to either side, apart in X.
fn two_sides() -> String {
    let (sine, cosine) = libm::sincos(30f64.to_radians());
    let mut moves = "TLDATA/MILL,10,0,100,0,0\nLOAD/TOOL,3\nSPINDL/RPM,6000,CLW\n".to_owned();
    for (sign, from, to) in [(1.0, -150.0, -90.0), (-1.0, 90.0, 150.0)] {
        let at = |x: f64, out: f64| {
            let (y, z) = (sign * (20.0 + out * sine), 52.0 + out * cosine);
            format!("GOTO/{x:.4},{y:.4},{z:.4},0,{:.7},{cosine:.7}\n", sign * sine)
        };
        let [over, begin, end, away] = [at(from, 60.0), at(from, 0.0), at(to, 0.0), at(to, 60.0)];
        moves += &format!("RAPID\n{over}RAPID\n{begin}FEDRAT/MMPM,800\n{end}RAPID\n{away}");
    }
    moves + "FINI\n"
}

/// A plate that turns with the table, and a wall between two facets on it.
fn walled(wall: [[f64; 3]; 2]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let machine = format!(
        "extends = \"ac-trunnion\"
name = \"with a wall\"
[fixture.plate]
block = [[-170, -60, 0], [170, 60, 20]]
[stock]
block = [[-150, -20, 0], [150, 20, 30]]
[fixture.wall]
block = {wall:?}
on = \"b\"
[fixture.head]
cylinder = [[0, 0, 402], [0, 0, 520]]
radius = 60
on = \"t\"
[tools.3]
length = 100
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 5], [40, 5]]
[clearance]
keep = 1
rapid_axes = \"together\"
"
    );
    fs::write(folder.path().join("m.toml"), machine).unwrap();
    fs::write(folder.path().join("sides.cls"), two_sides()).unwrap();
    folder
}

#[test]
fn a_wall_that_is_higher_than_the_retract_is_gone_round() {
    let folder = walled([[-10.0, -60.0, 65.0], [10.0, 60.0, 330.0]]);
    let words = ["-m", "m.toml", "sides.cls", "-o", "f.nc", "-q"];
    for more in [&["--clearance"][..], &LOW] {
        let run = post_in(folder.path(), &[&words, more].concat());
        assert_eq!(run.code, 1, "{}", run.err);
        assert_contains(&run.err, &["wall hits cutter T3"]);
    }
    let run = post_in(folder.path(), &[&words[..], &LOW].concat());
    let said = ["no way to here is found on which wall stays clear of cutter T3", "sides.cls:13"];
    assert_contains(&run.err, &[&said[..], &["[clearance] link = true"]].concat());
    assert!(!folder.path().join("f.nc").exists());
    let (program, summary) = made(&folder, "sides.cls", &LINK);
    assert_eq!(summary["ways_across"]["past"], 1, "{program}");
    assert_contains(&program, &["for the part at X0 Y0 Z0 alone".to_uppercase().as_str()]);
    let (again, _) = made(&folder, "sides.cls", &LINK);
    assert_eq!(program, again);
    // Deeper than both facets it goes nowhere: what stands there nobody may have drawn.
    let past = program.lines().find(|line| line.starts_with("G53 G0 X")).unwrap();
    let at = past.find('Z').unwrap();
    let end = at + past[at..].find(' ').unwrap();
    let deep = program.replace(past, &format!("{}Z-300.000{}", &past[..at], &past[end..]));
    fs::write(folder.path().join("deep.nc"), deep).unwrap();
    let words = ["verify", "deep.nc", "-m", "m.toml", "--against", "sides.cls", "--posted"];
    let held = post_in(folder.path(), &[&words, &LINK[..]].concat());
    assert_eq!(held.code, 1, "{}", held.out);
    assert_contains(&held.err, &["a rapid takes Z"]);
}

/// As far as nothing but height helps, the tool goes as much higher as the wall is, and keeps what is to be kept.
#[test]
fn the_retract_is_as_high_as_the_wall() {
    let height = |wall: f64, rapid: &str| {
        let folder = walled([[-10.0, -290.0, 65.0], [10.0, 290.0, wall]]);
        let more = ["--set", &format!("clearance.rapid={rapid}")];
        retracts(&made(&folder, "sides.cls", &[&LOW[..], &more].concat()).0)[1]
    };
    let [low, high, kept] = [height(180.0, "1"), height(230.0, "1"), height(180.0, "9")];
    assert!(
        libm::fabs(high - low - 50.0) <= 2.0 && libm::fabs(kept - low - 8.0) <= 2.0,
        "{low} {high} {kept}"
    );
    // The tip stands 300 mm over the zero of Z.
    assert!((181.0..184.0).contains(&(300.0 + low)), "{low}");
}

/// Wherever a wall stands: what is written is proven, and what is not is refused for it.
#[test]
fn walls_anywhere_are_kept_clear_of_or_refused() {
    let (rounds, mut rng) = randomised(24, 83);
    let mut past = 0;
    for _ in rounds {
        let x = rng.range(-30.0, 30.0);
        let (wide, from, to) =
            (rng.range(4.0, 20.0), rng.range(-150.0, 0.0), rng.range(10.0, 150.0));
        let wall = [[x, from, 65.0], [x + wide, to, rng.range(120.0, 340.0)]];
        let folder = walled(wall);
        let words = ["-m", "m.toml", "sides.cls", "-o", "f.nc", "-q"];
        let run = post_in(folder.path(), &[&words[..], &LINK].concat());
        if run.code != 0 {
            assert_contains(&run.err, &["error[clearance]", "wall"]);
            continue;
        }
        let (_, summary) = made(&folder, "sides.cls", &LINK);
        past += summary["ways_across"]["past"].as_u64().unwrap();
    }
    assert!(past > 0);
}

/// Ways that are chosen here keep half a millimetre more than they have to, from the part too, wherever they begin and end.
#[test]
fn ways_of_its_own_keep_off_the_part() {
    let (rounds, mut rng) = randomised(9, 89);
    for _ in rounds {
        // The part stands between the facets, and the wall out of all ways.
        let folder = walled([[-299.0, -299.0, 65.0], [-290.0, -290.0, 70.0]]);
        let (high, keep) = (rng.range(60.0, 140.0), rng.range(0.0, 6.0));
        let file = folder.path().join("m.toml");
        let machine = fs::read_to_string(&file).unwrap();
        let part = format!("[[-20, -60, 0], [20, 60, {high:.1}]]");
        let machine = machine.replace("[[-150, -20, 0], [150, 20, 30]]", &part);
        assert!(machine.contains(&part));
        fs::write(file, machine.replace("keep = 1", &format!("rapid = {keep:.2}"))).unwrap();
        for option in [LOW, LINK] {
            let (_, summary) = made(&folder, "sides.cls", &option);
            assert_eq!(summary["ways_across"]["as_ever"], 0, "{summary}");
            let rapid = format!("clearance.rapid={:.2}", keep + 0.48);
            let words = ["clearance", "f.nc", "-m", "m.toml", "--set", &rapid];
            let proof = post_in(folder.path(), &words);
            assert_eq!(proof.code, 0, "{keep} {high} {}{}", proof.out, proof.err);
        }
    }
}

/// Rapids between two cuts of one orientation go no higher than the part asks for; the program is the same but for them.
#[test]
fn rapids_of_one_orientation_are_as_low_as_the_part_lets_them() {
    let sample = root().join(sample("s-piece.cls"));
    let sample = sample.to_str().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let machine = |high: f64| {
        let text = format!(
            "extends = \"ac-trunnion\"\nname = \"with a part\"\n[stock]\nblock = [[-60, -20, 0], [60, 20, {high}]]\n\
             [tools.1]\nlength = 100\nholder = [[0, 30], [40, 20]]\ncutter = [[0, 5], [50, 5]]\n\
             [clearance]\nrapid_axes = \"together\"\nrapid = 2\n"
        );
        fs::write(folder.path().join("m.toml"), text).unwrap();
    };
    let mut before = f64::INFINITY;
    for high in [10.0, 20.0] {
        machine(high);
        let (ever, _) = made(&folder, sample, &[]);
        let (low, summary) = made(&folder, sample, &LINK);
        let ways = &summary["ways_across"];
        assert_eq!((&ways["rapids"], &ways["past"]), (&1.into(), &0.into()), "{ways}");
        let saved = ways["saved_s"].as_f64().unwrap();
        assert!(saved > 0.0 && saved < before, "{high}: {ways}");
        before = saved;
        let cuts = |program: &str| -> Vec<String> {
            let lines = program.lines().filter(|line| line.contains('X') && !line.contains("G0"));
            lines.map(str::to_owned).collect()
        };
        assert_eq!(cuts(&ever).len(), cuts(&low).len());
        let (ever, low) = (ever.lines().count(), low.lines().count());
        // One line more says of which length the tool must be.
        assert!(low <= ever + 1, "{low} {ever}");
    }
}

/// Two cuts of an upright tool, with these records between, on a machine that is `extends` of the library.
fn upright(extends: &str, between: &str, more: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let machine = format!(
        "extends = \"{extends}\"\nname = \"upright\"\n[workpiece]\nmount = [0, 0, 60]\n\
         [stock]\nblock = [[-60, -30, 0], [60, 30, 20]]\n\
         [tools.1]\nlength = 120\nholder = [[0, 32], [20, 32], [20, 20], [60, 18]]\ncutter = [[0, 5], [50, 5]]\n\
         {more}[clearance]\nkeep = 1\n"
    );
    fs::write(folder.path().join("m.toml"), machine).unwrap();
    let program = format!(
        "TLDATA/MILL,10,0,120,0,0\nLOAD/TOOL,1\nSPINDL/RPM,6000,CLW\nRAPID\nGOTO/-40,0,80\nRAPID\nGOTO/-40,0,24\n\
         FEDRAT/MMPM,800\nGOTO/-40,0,21\nGOTO/-20,0,21\n{between}RAPID\nGOTO/20,0,24\nFEDRAT/MMPM,800\n\
         GOTO/20,0,21\nGOTO/40,0,21\nRAPID\nGOTO/40,0,80\nFINI\n"
    );
    fs::write(folder.path().join("p.cls"), program).unwrap();
    folder
}

/// The rapids of a CL file between two cuts, and what may stand among them.
const PLAIN: &str = "RAPID\nGOTO/-20,0,80\nRAPID\nGOTO/20,0,80\n";

/// Records that move nothing, and a stop at a plane on the way up and down, stand in no link's way, on three axes as on five;
/// the records come in their order, where the tool is off the part.
#[test]
fn records_and_planes_between_rapids_stand_in_no_way() {
    let records =
        "RAPID\nGOTO/-20,0,80\nCOOLNT/OFF\nPPRINT/NEXT ONE\nRAPID\nGOTO/20,0,80\nCOOLNT/FLOOD\n";
    let planes =
        "RAPID\nGOTO/-20,0,26\nRAPID\nGOTO/-20,0,80\nRAPID\nGOTO/20,0,80\nRAPID\nGOTO/20,0,50\n";
    for machine in ["vmc", "ac-trunnion"] {
        for between in [PLAIN, records, planes] {
            let folder = upright(machine, between, "");
            let (program, summary) = made(&folder, "p.cls", &LINK);
            let ways = &summary["ways_across"];
            assert_eq!((&ways["rapids"], &ways["as_ever"]), (&1.into(), &0.into()), "{program}");
            // Neither cut is as high as the plane that the CL file crosses at: over the part or in axis positions.
            let cuts: Vec<&str> =
                program.lines().skip_while(|line| !line.contains("G1 ")).collect();
            let between = cuts[1..].iter().take_while(|line| !line.contains("G1 "));
            let high = between.filter(|line| line.contains("Z80") || line.contains("Z-180"));
            assert_eq!(high.count(), 0, "{program}");
            if program.contains("NEXT ONE") {
                let at = |what: &str| program.lines().position(|line| line.contains(what)).unwrap();
                let across = at("X20.000");
                assert!(at("NEXT ONE") < across, "{program}");
            }
        }
    }
}

/// What is not linked is told with its reason.
#[test]
fn ways_that_are_as_ever_are_told_by_their_reasons() {
    let reason = |between: &str, more: &str| {
        let folder = upright("vmc", between, more);
        let (_, summary) = made(&folder, "p.cls", &LINK);
        let ways = summary["ways_across"].clone();
        assert_eq!(ways["rapids"], 0, "{ways}");
        ways["why"].clone()
    };
    let stop = "RAPID\nGOTO/-20,0,80\nDELAY/2\nRAPID\nGOTO/20,0,80\n";
    assert_eq!(reason(stop, ""), serde_json::json!({ "stops": 1 }));
    let level = "RAPID\nGOTO/-20,0,24\nRAPID\nGOTO/20,0,24.5\n";
    assert_eq!(reason(level, ""), serde_json::json!({ "low": 1 }));
    let wall = "[fixture.wall]\nblock = [[-4, -30, 60], [4, 30, 138]]\n";
    assert_eq!(reason(PLAIN, wall), serde_json::json!({ "not_quicker": 1 }));
    let folder = upright("vmc", PLAIN, wall);
    let run =
        post_in(folder.path(), &[&["-m", "m.toml", "p.cls", "-o", "p.nc"], &LINK[..]].concat());
    assert_contains(&(run.out + &run.err), &["1 as ever (1: no quicker one is proven clear)"]);
}

/// A machine whose accelerations are not known has ways that are quicker by its feeds.
#[test]
fn without_accelerations_feeds_tell_which_way_is_quicker() {
    let folder = upright("vmc", PLAIN, "");
    let file = folder.path().join("m.toml");
    let library = fs::read_to_string(root().join("machines/vmc.toml")).unwrap();
    let bare: String = library
        .lines()
        .filter(|line| !line.starts_with("max_accel"))
        .fold(String::new(), |text, line| text + line + "\n");
    fs::write(folder.path().join("bare.toml"), bare).unwrap();
    let machine = fs::read_to_string(&file).unwrap().replace("\"vmc\"", "\"bare.toml\"");
    fs::write(&file, machine).unwrap();
    let (_, summary) = made(&folder, "p.cls", &LINK);
    assert_eq!(summary["ways_across"]["rapids"], 1, "{summary}");
}

/// A linked program that is verified without the option is told from one that goes astray.
#[test]
fn verifying_tells_a_linked_program_where_the_machine_file_links_nothing() {
    let folder = walled([[-10.0, -60.0, 65.0], [10.0, 60.0, 330.0]]);
    made(&folder, "sides.cls", &LINK);
    let words = ["verify", "f.nc", "-m", "m.toml", "--against", "sides.cls", "--posted"];
    let held = post_in(folder.path(), &words);
    assert_eq!(held.code, 1, "{}", held.out);
    assert_contains(
        &held.err,
        &["a rapid takes", "posted with [clearance] low_retracts or link is verified with it"],
    );
}

/// Ways past bodies would go through a part that nobody has drawn.
#[test]
fn without_a_stock_no_way_is_shortened() {
    let folder = tempfile::tempdir().unwrap();
    let cl = root().join("tests/samples/facets.apt");
    let cl = cl.to_str().unwrap();
    for option in ["clearance.low_retracts=true", "clearance.link=true"] {
        let words = ["-m", "dmu50", cl, "--tool-length", "100", "--set", option, "-o", "part.nc"];
        let run = post_in(folder.path(), &words);
        assert_eq!(run.code, 1, "{}", run.err);
        assert_contains(&run.err, &["no [stock] is drawn"]);
        assert!(!folder.path().join("part.nc").exists());
    }
}
