//! Lines of a program with places for the numbers of a record.

use post_grammar::Template;

#[test]
fn a_template_is_filled_with_whole_numbers() {
    for (template, numbers, line) in [
        ("G{n+53}", &[1.0][..], Ok("G54")),
        ("G{ n + 53 }", &[2.0], Ok("G55")),
        ("M{1}", &[8.0], Ok("M8")),
        ("G{2} P{1}", &[7.0, 65.0], Ok("G65 P7")),
        ("G54.1 P{n1} Q{n2*10}", &[7.0, 0.3], Ok("G54.1 P7 Q3")),
        ("M{n}", &[0.0], Ok("M0")),
        ("M{n}", &[8.0, 9.0], Ok("M8")),
        ("TRAORI", &[], Ok("TRAORI")),
        ("M{n}", &[], Err("no number 1")),
        ("M{n3}", &[1.0, 2.0], Err("no number 3")),
        ("M{n}", &[8.5], Err("is 8.5")),
        ("M{n-9}", &[8.0], Err("is -1")),
        ("M{1/n}", &[0.0], Err("has no value")),
        ("M{n*1e8}", &[1e8], Err("go from 0")),
        ("Z{n:.3}", &[-5.2], Ok("Z-5.200")),
        ("Z{n:3}", &[-5.2], Ok("Z-5.2")),
        ("G{n:1}", &[54.0], Ok("G54")),
        ("G{n:1}", &[100.0], Ok("G100")),
        ("Z{n*unit:.2}", &[1.5], Ok("Z1.50")),
        ("Z{ 2 : .0 }", &[1.0, 2.5], Ok("Z2")),
        ("Z{n:.2}", &[-0.001], Ok("Z0.00")),
        ("Z{n:.2}", &[1e12], Err("no control reads")),
    ] {
        let filled = Template::parse(template).unwrap().fill(numbers, 1.0);
        match (filled, line) {
            (Ok(filled), Ok(line)) => assert_eq!(filled, line, "{template} {numbers:?}"),
            (Err(fault), Err(part)) => {
                assert!(fault.to_string().contains(part), "{template}: {fault}");
            }
            (filled, _) => panic!("{template} {numbers:?}: {filled:?}"),
        }
    }
}

#[test]
fn a_template_that_means_nothing_is_refused() {
    for (template, part) in [
        ("", "empty"),
        ("  ", "empty"),
        ("M8\nM9", "line end"),
        ("M{n", "a `}` is missing"),
        ("M}8{", "closes nothing"),
        ("M{}", "is missing at the end"),
        ("M{8+1}", "no number of the record"),
        ("M{pi}", "no number of the record"),
        ("M{m}", "m is no number"),
        ("M{n0}", "n0 is no number"),
        ("M{0}", "n0 is no number"),
        ("M{n101}", "n101 is no number"),
        ("M{n+}", "is missing at the end"),
        ("M{unit}", "no number of the record"),
        ("M{n:}", "behind the colon stand decimals"),
        ("M{n:.12}", "behind the colon stand decimals"),
        ("M{n:+1}", "behind the colon stand decimals"),
    ] {
        let fault = Template::parse(template).unwrap_err();
        assert!(fault.contains(part), "{template}: {fault}");
    }
}

/// A length of an inch file in a program in mm: only a place that says so counts in the program's units.
#[test]
fn decimals_say_which_unit_they_are_of() {
    let length = Template::parse("Z{n*unit:.3}").unwrap();
    assert_eq!(length.fill(&[-0.2], 25.4).unwrap(), "Z-5.080");
    assert_eq!(length.without_unit(), None);
    assert_eq!(Template::parse("M{n}").unwrap().without_unit(), None);
    assert_eq!(Template::parse("P{n} Z{n2:.3}").unwrap().without_unit(), Some("n2:.3"));
}
