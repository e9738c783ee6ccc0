//! Which machine posts which file, which it refuses, and how far the axes travel.

use super::*;

/// File, machine, further arguments: these are posted.
const GOOD: &[(&str, &str, &str)] = &[
    ("creo3x_MichaHofft_bohren_1.ncl", "vmc", ""),
    ("creo3x_MichaHofft_bohren_1.ncl", "dmu50", "--mount 0,0,20"),
    ("creo3x_MichaHofft_profilfraesen_2.ncl", "vmc", ""),
    ("creo3x_MichaHofft_profilfraesen_2.ncl", "ac-trunnion", ""),
    ("creo3x_MichaHofft_schruppen_1.ncl", "vmc", ""),
    ("creo3x_MichaHofft_schruppen_1.ncl", "nutating-head", ""),
    // In inches, as it says, the blade is 5 m long.
    ("creo5x_4r19415_finition.ncl", "head-head", "--tcp post"),
    ("creo5x_4r19415_finition.ncl", "ac-trunnion", "--tcp post --units mm --mount -140,21,-40"),
    ("creo5x_4r19415_finition.ncl", "ac-trunnion", "--tcp control --units mm"),
    (
        "creo5x_4r19415_finition.ncl",
        "dmu50",
        "--tcp post --units mm --mount -140,21,0 --tool-length 120",
    ),
    ("nx_HumMan_ust_a2.cls", "head-head-360", "--tcp post --set control.retract.Z=9000"),
    ("nx_HumMan_ust_a2.cls", "head-head", "--tcp post --msys apply"),
    ("nx_HumMan_ust_a.cls", "head-head-360", "--set control.retract.Z=9000"),
    ("nx_HumMan_ust_a.cls", "head-head", "--msys apply --tool-length 150"),
    // Its points are the tool's centre, as those of SolidWorks CAM and CAMWorks.
    ("nx_HumMan_cutcom.clsf", "vmc", "--set control.compensation_on_centre=wear"),
    // Cutter compensation on an indexed table: the tool stands upright in the machine.
    (
        "camworks_neMoguta_UniSource.clt",
        "ac-trunnion",
        "--tool-from-cutter --tool-length 150 --set control.compensation_on_centre=wear",
    ),
    (
        "swcam_aamorim_Interface-glue.clt",
        "ac-trunnion",
        "--tool-from-cutter --tool-length 150 --set control.compensation_on_centre=wear",
    ),
    (
        "swcam_aamorim_Teste-Metrologia.apt",
        "ac-trunnion",
        "--tool-length 80 --set control.compensation_on_centre=wear",
    ),
    ("nx_HumMan_nurbs.clsf", "head-head", "--tool 1"),
    ("nx_HumMan_nurbs.clsf", "disc-cutter", "--tool 1"),
    // It goes in pecks and says none.
    ("nx_HumMan_deep_drill.clsf", "vmc", "--tool 1 --allow DEEP"),
    ("nx_HumMan_standart_drill.clsf", "vmc", "--tool 1"),
    ("nx_HumMan__3_PAZ_125_N2.cls", "head-head", "--tool 1"),
    ("nx_HumMan__10_KONTUR_125_N2_162.cls", "head-head", "--tool 1"),
    ("nx_HumMan__8_SVERL_63_N2.cls", "head-head", "--tool 1"),
    ("nx_HumMan__8_SVERL_63_N2.cls", "disc-cutter", "--tool 1"),
    (
        "swcam_aamorim_basemach.apt",
        "vmc",
        "--mount -170,-75,0 --set control.compensation_on_centre=wear",
    ),
    (
        "swcam_aamorim_basemach.apt",
        "nutating-head",
        "--tcp post --tool-length 100 --set control.compensation_on_centre=wear",
    ),
    // It has no word for its units; it is in inches.
    ("own_ncl_form.as", "ac-trunnion", "--units inch"),
    ("own_ncl_form.as", "dmu50", "--units inch"),
    ("own_ncl_form.as", "nutating-head", "--units inch --tcp post --tool-length 100"),
];

/// Every file once, on a machine that makes it.
pub fn one_each() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let mut files = BTreeSet::new();
    let rows = GOOD.iter().copied();
    rows.filter(move |(file, ..)| files.insert(*file))
}

/// File, machine, further arguments, code of the fault: these are refused.
const REFUSED: &[(&str, &str, &str, &str)] = &[
    ("creo5x_4r19415_finition.ncl", "vmc", "", "out-of-reach"),
    ("creo5x_4r19415_finition.ncl", "ac-trunnion", "", "over-travel"),
    ("nx_HumMan_ust_a2.cls", "vmc", "", "out-of-reach"),
    // It works from below, and these heads do not swing so far.
    ("nx_HumMan_ust_a2.cls", "head-head", "", "over-travel"),
    ("nx_HumMan_ust_a2.cls", "ac-trunnion", "", "over-travel"),
    ("nx_HumMan_ust_a.cls", "dmu50", "", "over-travel"),
    ("nx_HumMan_ust_a.cls", "nutating-head", "", "out-of-reach"),
    ("nx_HumMan__3_PAZ_125_N2.cls", "vmc", "--tool 1 --mount 0,0,0", "over-travel"),
    ("nx_HumMan__10_KONTUR_125_N2_162.cls", "ac-trunnion", "--tool 1", "over-travel"),
    // A dialect with G43 H must know the tool.
    ("nx_HumMan_deep_drill.clsf", "vmc", "--allow DEEP", "dialect"),
    // It goes in pecks and says none.
    ("nx_HumMan_deep_drill.clsf", "vmc", "--tool 1", "cycle"),
    // Points of the tool's centre, and the radius in the register.
    ("nx_HumMan_cutcom.clsf", "vmc", "", "compensation"),
    ("swcam_aamorim_basemach.apt", "vmc", "--mount -170,-75,0", "compensation"),
    ("own_ncl_form.as", "vmc", "", "out-of-reach"),
    ("camworks_neMoguta_UniSource.clt", "vmc", "--tool-from-cutter", "out-of-reach"),
    ("swcam_aamorim_Interface-glue.clt", "vmc", "--tool-from-cutter", "out-of-reach"),
    ("swcam_aamorim_Teste-Metrologia.apt", "vmc", "", "out-of-reach"),
    // Radius compensation on a tilted plane: a head or TCP would offset in the wrong plane.
    ("camworks_neMoguta_UniSource.clt", "head-head", "--tool-from-cutter", "compensation"),
    ("swcam_aamorim_Interface-glue.clt", "head-head-360", "--tool-from-cutter", "compensation"),
    ("swcam_aamorim_Teste-Metrologia.apt", "head-head", "", "compensation"),
];

#[test]
fn files_are_posted_within_tolerance() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    let mut failed = Vec::new();
    for (file, machine, with) in GOOD {
        let (done, summary) = post(&data.join(file), machine, with);
        let name = format!("{file} on {machine} {with}");
        if done.code != 0 {
            failed.push(format!("{name}:\n{}", done.err));
            continue;
        }
        let summary = summary.unwrap();
        check_numbers(&done.out);
        let tolerance = if *machine == "nutating-head" { 0.010 } else { 0.005 };
        assert_eq!(summary["tolerance_mm"], tolerance, "{name}");
        for (key, limit) in [("tip_deviation_mm", tolerance), ("axis_deviation_deg", 0.05)] {
            let value = summary[key]["value"].as_f64().unwrap();
            assert!(value <= limit, "{name}: {key} {value}");
        }
        assert!(summary["nc_lines"] == done.out.lines().count(), "{name}");
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn files_are_refused_for_a_reason() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    for (file, machine, with, code) in REFUSED {
        let (done, summary) = post(&data.join(file), machine, with);
        let name = format!("{file} on {machine} {with}");
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{name}");
        assert!(summary.is_none(), "{name}");
        let code = format!("error[{code}]");
        assert!(done.err.contains(&code), "{name}:\n{}", done.err);
        // The file and the line are told.
        assert!(done.err.contains(&format!("{file}:")), "{name}:\n{}", done.err);
    }
}

#[test]
fn every_file_is_among_them() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    let listed: BTreeSet<String> = GOOD
        .iter()
        .map(|row| row.0)
        .chain(REFUSED.iter().map(|row| row.0))
        .map(str::to_owned)
        .collect();
    let there: BTreeSet<String> = fs::read_dir(data)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(listed, there);
}

#[test]
fn the_words_of_every_file_are_listed() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    for entry in fs::read_dir(data).unwrap() {
        let path = entry.unwrap().path();
        let done = run(command().arg("words").arg(&path), b"");
        assert_eq!((done.code, done.err.as_str()), (0, ""), "{}", path.display());
        let row = done.out.lines().find(|line| line.starts_with("GOTO "));
        assert!(row.unwrap().contains("used"), "{}", path.display());
        assert!(!done.out.contains("refused"), "{}\n{}", path.display(), done.out);
    }
}

/// Files whose tool axis moves.
const FIVE_AXES: [&str; 4] = [
    "creo5x_4r19415_finition.ncl",
    "nx_HumMan_ust_a.cls",
    "own_ncl_form.as",
    "swcam_aamorim_Teste-Metrologia.apt",
];

/// Rotary travel and changes of solution against the greedy choice (the nearest solution at each point, every
/// point met exactly): never more travel, whatever machine of the library reaches the file. Prints the table.
#[test]
fn the_choice_travels_no_farther_than_the_greedy_one() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    const GREEDY: &str = " --set solution.look_ahead=1 --set solution.pole=exact";
    let machines: Vec<String> = fs::read_dir(root().join("machines"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let mut compared = 0;
    println!("file, machine: rotary travel in degrees (changes, rewinds), greedy: the same");
    for (own, file) in (5..).zip(FIVE_AXES) {
        let with = match file {
            "creo5x_4r19415_finition.ncl" => "--units mm --mount -140,21,-40",
            "nx_HumMan_ust_a.cls" => "--msys apply",
            "own_ncl_form.as" => "--units inch",
            _ => "",
        };
        for machine in &drawn(machines.clone(), own) {
            let with = format!("--tool-length 150 --tcp post {with}");
            let travel = |more: &str| {
                let (run, summary) = post(&folder.join(file), machine, &format!("{with}{more}"));
                let told = |key: &str, summary: &Value| summary[key].as_u64().unwrap();
                summary.filter(|_| run.code == 0).map(|summary| {
                    let axes = summary["axes"].as_array().unwrap().iter();
                    let rotary = axes.filter(|axis| "ABC".contains(axis["name"].as_str().unwrap()));
                    (
                        rotary.map(|axis| axis["way"].as_f64().unwrap()).sum::<f64>(),
                        told("branch_changes", &summary),
                        told("rewinds", &summary),
                    )
                })
            };
            let (chosen, greedy) = (travel(""), travel(GREEDY));
            if let Some((way, changes, rewinds)) = chosen {
                let greedy_told = match greedy {
                    Some((way, changes, rewinds)) => format!("{way:.1} ({changes}, {rewinds})"),
                    None => "refused".to_owned(),
                };
                println!("{file}, {machine}: {way:.1} ({changes}, {rewinds}), {greedy_told}");
                compared += 1;
            }
            match (chosen, greedy) {
                (Some((way, ..)), Some((greedy, ..))) => {
                    assert!(way <= greedy + 0.1, "{file} on {machine}: {way} {greedy}");
                }
                (None, Some(_)) => panic!("{file} on {machine}: the greedy choice finds a way"),
                _ => {}
            }
        }
    }
    assert!(compared > 25 || !all_drawn(), "{compared}");
}
