//! Cycles, expressions, loops and subprograms: the ends of motions as LinuxCNC's interpreter makes them, and as reading
//! says.

use post_testkit::seeded;

use super::*;

/// The canonical commands have four decimals.
const PRINTED: f64 = 1e-4;

/// An end: tip, and whether it is come to at rapid.
type End = ([f64; 3], bool);

/// Every language construct that both have in common.
const WORDS: &str = "G21 G17 G90 G94 G80 G40
o100 sub
  #<depth> = [#2 / 2]
  G0 X#1 Y[#1 * -1]
  o110 if [#<depth> gt 3]
    G99 G81 X#1 Y0 Z[0 - #<depth>] R2 F200
  o110 elseif [#<depth> gt 1]
    G98 G82 X#1 Y0 Z[0 - #<depth>] R2 P0.1 F200
  o110 else
    G99 G83 X#1 Y0 Z[0 - #<depth>] R2 Q0.4 F200
  o110 endif
  G80
o100 endsub
S500 M3
G0 X0 Y0 Z30
#3=15
#3=20 G1 X#3 F500
X[#3 + 1]
#5 = 0
o200 while [#5 lt 4]
  o100 call [#5 * 10 + 5] [#5 + 4]
  #5 = [#5 + 1]
  o210 if [#5 eq 3]
    o200 continue
  o210 endif
  G0 Z[30 + #5]
o200 endwhile
o300 repeat [3]
  G91 G0 X1 Y[sin[30]] Z[atan[1]/[1] / 45]
o300 endrepeat
G90
o400 do
  #5 = [#5 - 1]
  G0 X[2 ** #5] Y[#5 mod 2 + fix[-1.5] + fup[1.2] + round[2.5] + abs[-3] + sqrt[9] + exp[0] + ln[1]]
  o410 if [#5 lt 2]
    o400 break
  o410 endif
o400 while [#5 gt 0]
G0 X[acos[0.5] + asin[0.5]] Y[cos[60] * tan[45]]
G0 X[1 and 0] Y[[1 or 0] + [1 xor 1] + [3 ge 3] + [2 le 1] + [2 ne 2.00001]]
M2
";

/// A random program of cycles.
fn cycles(seed: u64) -> String {
    let mut random = seeded(seed);
    let mut program = String::from("G21 G17 G90 G94\nS800 M3\nG0 X0 Y0 Z40\n");
    for _ in 0..12 {
        let code = ["G73", "G81", "G82", "G83", "G84", "G85", "G86", "G89"][random.pick(8)];
        let back = ["G98", "G99"][random.pick(2)];
        let clear = random.range(1.0, 6.0);
        let bottom = random.range(-30.0, -1.0);
        let more = match code {
            "G73" | "G83" => format!(" Q{:.3}", random.range(1.5, 9.0)),
            "G82" | "G86" | "G89" => " P0.2".to_owned(),
            _ => String::new(),
        };
        let [x, y] = [(); 2].map(|()| random.range(-40.0, 40.0));
        program.push_str(&format!(
            "{back} {code} X{x:.3} Y{y:.3} Z{bottom:.3} R{clear:.3}{more} F150\n"
        ));
        for _ in 0..random.pick(3) {
            program.push_str(&format!("X{:.3}\n", random.range(-40.0, 40.0)));
        }
        if random.pick(3) == 0 {
            program.push_str("G80\n");
            // From below the level R too.
            program.push_str(&format!("G0 Z{:.3}\n", random.range(1.0, 50.0)));
        }
        if random.pick(4) == 0 {
            program.push_str("G80\n");
            let depth = random.range(1.0, 20.0);
            program.push_str(&format!(
                "G91 G81 X{:.3} Y1.5 Z-{depth:.3} R-0.5 L3 F90\nG80\nG90\n",
                random.range(1.0, 5.0)
            ));
        }
    }
    program.push_str("G80\nM2\n");
    program
}

/// What LinuxCNC's interpreter asks for; none where it is not there.
fn theirs(file: &Path) -> Option<Vec<End>> {
    let done = Command::new(shared("linuxcnc/interpret")?)
        .arg(file)
        .args(["--metric", "--tool", "1=40"])
        .output();
    let done = done.ok()?;
    if done.status.code() == Some(3) {
        eprintln!("skipped: {}", String::from_utf8_lossy(&done.stderr));
        return None;
    }
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    let ends = text.lines().filter_map(|line| {
        let (word, values) = line.split_once('(')?;
        let rapid = word.ends_with("STRAIGHT_TRAVERSE");
        if !rapid && !word.ends_with("STRAIGHT_FEED") {
            return None;
        }
        let mut values = values.split(',').map(|value| value.trim().parse::<f64>().unwrap());
        Some((std::array::from_fn(|_| values.next().unwrap()), rapid))
    });
    Some(ends.collect())
}

fn ours(file: &Path) -> Vec<End> {
    let done = run(
        command()
            .args(["read", "-m", "vmc", "--dialect", "linuxcnc", "--csv", "-"])
            // On the table itself there is no depth to drill: the part stands on a fixture.
            .args(["--mount", "0,0,100"])
            .arg(file),
        b"",
    );
    assert_eq!(done.code, 0, "{}\n{}", done.err, fs::read_to_string(file).unwrap());
    let mut lines = done.out.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).unwrap();
    let (tip, kind) = (["tip_x", "tip_y", "tip_z"].map(column), column("kind"));
    let ends = lines.map(|row| {
        let fields: Vec<&str> = row.split(',').collect();
        (tip.map(|place| fields[place].parse().unwrap()), fields[kind] == "rapid")
    });
    ends.collect()
}

/// Motions that go nowhere are nobody's.
fn moving(ends: Vec<End>) -> Vec<End> {
    let mut at = [f64::NAN; 3];
    let mut kept = Vec::new();
    for (end, rapid) in ends {
        let moves =
            end.iter().zip(&at).any(|(to, from)| from.is_nan() || (to - from).abs() > PRINTED);
        if moves {
            kept.push((end, rapid));
        }
        at = end;
    }
    kept
}

fn agree(name: &str, program: &str) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    fs::write(&file, program).unwrap();
    let Some(theirs) = theirs(&file) else {
        return false;
    };
    let (theirs, ours) = (moving(theirs), moving(ours(&file)));
    for (place, (their, our)) in theirs.iter().zip(&ours).enumerate() {
        let near = their.0.iter().zip(&our.0).all(|(a, b)| (a - b).abs() <= PRINTED);
        assert!(
            near && their.1 == our.1,
            "motion {place}: {their:?} there, {our:?} here\n{program}"
        );
    }
    assert_eq!(theirs.len(), ours.len(), "{program}");
    assert!(theirs.len() > 20);
    true
}

#[test]
fn expressions_loops_and_subprograms_are_run_as_linuxcnc_runs_them() {
    agree("words.ngc", WORDS);
}

#[test]
fn cycles_make_the_motions_that_linuxcnc_makes() {
    for seed in 0..25 {
        if !agree("cycles.ngc", &cycles(seed)) {
            return;
        }
    }
}
