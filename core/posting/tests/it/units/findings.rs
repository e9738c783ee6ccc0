use post_posting::internals::without_numbers;

#[test]
fn sentences_that_differ_in_numbers_are_of_one_kind() {
    for (one, other, same) in [
        ("the ends lie 0.0012 mm apart", "the ends lie 12 mm apart", true),
        ("A would be -3.5°", "A would be 140°", true),
        ("A would be 1°", "C would be 1°", false),
        ("5 numbers are given", "1 number is given", false),
    ] {
        assert_eq!(without_numbers(one) == without_numbers(other), same, "{one}");
    }
}
