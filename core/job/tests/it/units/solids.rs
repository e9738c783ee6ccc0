//! How what may be drawn is shared out among solids.

use post_job::internals::share;

#[test]
fn who_needs_less_leaves_it_to_the_others() {
    for (needs, all, each) in [
        (vec![], 10, 10),
        (vec![3, 4], 10, 10),
        (vec![20, 2], 10, 8),
        (vec![20, 20, 2], 10, 4),
        (vec![9, 9, 9], 10, 3),
    ] {
        assert_eq!(share(needs.clone().into_iter(), all), each, "{needs:?}");
    }
}
