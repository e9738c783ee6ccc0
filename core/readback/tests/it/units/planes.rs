//! How control and words turn to a plane.

use post_readback::internals::turns_of;

#[test]
fn the_modes_of_the_manual_are_sequences_of_axes() {
    for (mode, order) in [
        (57.0, [0, 1, 2]),
        (45.0, [0, 2, 1]),
        (54.0, [1, 0, 2]),
        (30.0, [1, 2, 0]),
        (39.0, [2, 0, 1]),
        (27.0, [2, 1, 0]),
    ] {
        assert_eq!(turns_of(mode), Some(order), "{mode}");
    }
    for mode in [0.0, 1.0, 64.0, 192.0, 57.5, -1.0] {
        assert_eq!(turns_of(mode), None, "{mode}");
    }
}
