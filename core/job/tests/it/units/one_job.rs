//! Whatever comes of a job is a row.

use std::panic::catch_unwind;

use post_job::batch::FAILED;
use post_job::files::json_line;
use post_job::internals::told;

#[test]
fn a_panic_is_a_row_that_is_tried_again() {
    let did = told(catch_unwind(|| panic!("line {}", 7)));
    assert_eq!(did.outcome.state(), FAILED);
    assert_eq!(did.outcome.key, None);
    let row = json_line(&did.outcome);
    assert!(row.contains("post itself failed: line 7"), "{row}");
    assert!(row.contains("\"codes\":\"panic\""), "{row}");
}
