use post_kit::internals::{CUTS, LAST, events};
use post_plugin::Event;

/// Compensation apart, which is tried where the control has it.
#[test]
fn the_program_has_every_kind_that_every_dialect_is_sent() {
    let positions = [[0.0; 5]; CUTS];
    let events = events(&positions, &[]);
    for sample in Event::samples() {
        let tried = matches!(sample, Event::Compensate(_));
        let found = events.iter().any(|event| event.kind() == sample.kind());
        assert_eq!(found || tried, sample.kind() <= LAST, "{}", sample.name());
    }
}
