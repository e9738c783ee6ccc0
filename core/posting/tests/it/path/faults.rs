//! What cannot be made is said; no numbers make it stumble.

use super::*;

/// A refusal names the axis, its value, its limit and the CL line; other faults of the run are told beside it.
#[test]
fn faults_say_where_what_and_how_much() {
    let model = model("head", false, [-100.0, 100.0], &["axis.X.travel=[-90, 90]"]);
    let text = "UNITS/MM\nFEDRAT/100\nGOTO/0,0,0,0,0,1\nGOTO/85,0,0\nGOTO/1,0,0,0,-0.5,-0.8660254\nGOTO/2,0,0,0,0,0\n";
    let run = model.run(text);
    assert!(run.report.is_none());
    // X stands at 10 with the tip on the part origin.
    let told: Vec<(u64, &str, &str)> = run
        .findings
        .iter()
        .filter(|finding| finding.severity == Severity::Error)
        .map(|finding| {
            let place = finding.place.as_ref().unwrap();
            (place.line, finding.code, &place.text[place.span.clone()])
        })
        .collect();
    assert_eq!(
        told,
        [
            (4, "over-travel", "GOTO/85,0,0"),
            (5, "over-travel", "GOTO/1,0,0,0,-0.5,-0.8660254"),
            (6, "axis", "GOTO/2,0,0,0,0,0"),
        ]
    );
    for (finding, words) in
        run.findings.iter().zip([["X", "95.000 mm", "90.000 mm"], ["A", "150.000°", "100.000°"]])
    {
        for word in words {
            assert!(finding.message.contains(word), "{word}: {}", finding.message);
        }
        assert!(finding.help.is_some());
    }

    // B of the nutating head lays the tool flat and no further.
    let nutating = self::model("nutating", false, WIDE, &[]);
    let run = nutating.run("UNITS/MM\nGOTO/0,0,0,0,0,-1\n");
    assert_eq!(run.findings[0].code, "out-of-reach");
    assert!(run.findings[0].message.contains("90.0000°"), "{}", run.findings[0].message);

    let run = nutating.run("UNITS/MM\nGOTO/0,0,0,0,0,1\nGOTO/1,0,0\n");
    assert_eq!(
        (run.findings[0].code, run.findings[0].place.as_ref().unwrap().line),
        ("no-feed", 3)
    );
}

/// Whatever the numbers, a run ends with a report or with errors, and no word or feed is ever not finite
/// (the recorder looks at each).
#[test]
fn no_numbers_make_it_stumble() {
    let (rounds, mut rng) = randomised(150, 9);
    // The further on, the worse.
    let odd = [0.0, 1.0, -1.0, 0.5, 1e-7, -0.0, 1e-12, 1e3, 1e9, 1e30, 1e300];
    let (mut good, mut bad) = (0, 0);
    for kind in ["trunnion", "head", "nutating"] {
        for tcp in [false, true] {
            let model = model(kind, tcp, WIDE, &[]);
            for _ in rounds.clone() {
                let mut text = "UNITS/MM\nMULTAX/ON\n".to_owned();
                let most = [4, 5, 7, odd.len()][rng.pick(4)];
                for _ in 0..8 {
                    let mut numbers: Vec<String> =
                        (0..6).map(|_| odd[rng.pick(most)].to_string()).collect();
                    if rng.pick(3) > 0 {
                        numbers[5] = "1".to_owned();
                    }
                    text += [
                        "RAPID\n",
                        "FEDRAT/1E-9\n",
                        "FEDRAT/100\n",
                        "FEDRAT/1E12,MMPM\n",
                        "FEDRAT/1\n",
                    ][rng.pick(5)];
                    if rng.pick(30) == 0 {
                        text += &format!("CIRCLE/{},0,0,1\n", numbers[..3].join(","));
                    }
                    text += &format!("GOTO/{}\n", numbers.join(","));
                }
                let run = model.run(&text);
                let errors = run
                    .findings
                    .iter()
                    .filter(|finding| finding.severity == Severity::Error)
                    .count();
                assert_eq!(run.report.is_none(), errors > 0, "{text}");
                assert!(errors <= MOST_FAULTS);
                if errors > 0 { bad += 1 } else { good += 1 }
            }
        }
    }
    println!("{good} good runs, {bad} refused");
    // Fifteen of three hundred are good: none is one in a million runs.
    assert!(good > 0 && bad > at_least(100));
}

/// A file full of lines that cannot be read does not hide what is wrong before them: a batch is posted before the
/// next fault of reading is told.
#[test]
fn the_first_fault_of_a_file_is_told_first() {
    let model = model("trunnion", false, WIDE, &[]);
    let mut text = "UNITS/MM\nFEDRAT/500\nGOTO/0,0,0\nGOTO/100000,0,0\n".to_owned();
    // Sentences that differ in more than a number: each is told.
    for count in 0..2 * MOST_FAULTS {
        let letters = "x".repeat(count + 1);
        text += &format!("GOTO/1,2,{letters}\n");
    }
    let run = model.run(&text);
    let errors: Vec<_> =
        run.findings.iter().filter(|finding| finding.severity == Severity::Error).collect();
    assert_eq!(errors.len(), MOST_FAULTS);
    assert_eq!(errors[0].code, "over-travel", "{}", run.told());
    let lines = errors.iter().map(|finding| finding.place.as_ref().map(|place| place.line));
    assert!(lines.is_sorted());
}
