use post_kit::internals::ends_early;

#[test]
fn a_remark_that_ends_early_is_seen_in_brackets_alone() {
    for line in ["(a) b", "N10 (a) G0 Z0 (b)", "(a)(b)"] {
        assert!(ends_early(line), "{line}");
    }
    for line in ["(a)", "N10 (a (b)", "; a) b", "10 ; (a) b", "(a", ""] {
        assert!(!ends_early(line), "{line}");
    }
}
