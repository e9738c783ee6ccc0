//! Values of flags that are laid over jobs.

use post_job::batch::{Grid, JobLine, values};

fn texts(text: &str) -> Vec<String> {
    let values = values(text).unwrap().into_iter();
    values.map(|value| value.0).collect()
}

#[test]
fn values_are_parted_by_commas_outside_brackets() {
    assert_eq!(texts("200, 250"), ["200", "250"]);
    assert_eq!(texts("[1,2,3],[4,5,6]"), ["[1,2,3]", "[4,5,6]"]);
    assert_eq!(texts("\"a,b\",c"), ["\"a,b\"", "c"]);
    assert_eq!(texts("max(1,2),3"), ["max(1,2)", "3"]);
    assert!(values("1,,2").is_err());
}

#[test]
fn a_range_has_the_digits_of_its_ends_and_both_of_them() {
    assert_eq!(texts("0:0.3:0.1"), ["0.0", "0.1", "0.2", "0.3"]);
    assert_eq!(texts("-100:100:100"), ["-100", "0", "100"]);
    assert_eq!(texts("5:1:-2"), ["5", "3", "1"]);
    assert!(values("0:1:0").is_err());
    assert!(values("0:1:-1").is_err());
    assert_eq!(texts("a:b:c"), ["a:b:c"]);
}

#[test]
fn what_a_job_says_itself_is_not_varied() {
    let grid = Grid {
        machines: vec!["vmc".to_owned(), "dmu50".to_owned()],
        settings: vec![(
            "turn",
            values("0,90").unwrap().into_iter().map(|turn| vec![turn]).collect(),
        )],
        ..Grid::default()
    };
    let own = JobLine { machine: Some("vmc-a".to_owned()), ..JobLine::of_file("b.cls".to_owned()) };
    let jobs = grid.jobs(vec![JobLine::of_file("a.cls".to_owned()), own]).unwrap();
    let told: Vec<String> = jobs
        .iter()
        .map(|job| {
            format!(
                "{} {} {}",
                job.file,
                job.machine.as_deref().unwrap(),
                job.settings[&JobLine::place("turn").unwrap()][0].0
            )
        })
        .collect();
    assert_eq!(
        told,
        [
            "a.cls vmc 0",
            "a.cls vmc 90",
            "a.cls dmu50 0",
            "a.cls dmu50 90",
            "b.cls vmc-a 0",
            "b.cls vmc-a 90",
        ]
    );
}
