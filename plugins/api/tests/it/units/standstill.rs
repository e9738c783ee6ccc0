use post_plugin::{Coolant, Event, Feed, Spindle, Standstill};

const CUT: Event<'static> = Event::Linear { tool: None, feed: Feed::PerMinute(100.0), words: &[] };
const RAPID: Event<'static> = Event::Rapid { tool: None, words: &[] };

/// What is switched on ahead of each event behind the stop.
fn behind<const N: usize>(before: Event<'_>, events: [Event<'_>; N]) -> [[bool; 2]; N] {
    let mut still = Standstill::default();
    still.before(&before);
    still.stop(true, true);
    events.map(|event| still.before(&event))
}

#[test]
fn nothing_turns_before_the_next_cut() {
    let (off, on) = ([false; 2], [true; 2]);
    assert_eq!(behind(RAPID, [RAPID, CUT, CUT]), [off, on, off]);
    let change = Event::ToolChange {
        number: 2,
        register: 2,
        length: None,
        diameter: None,
        corner_radius: None,
        name: "",
    };
    assert_eq!(behind(RAPID, [change, RAPID, CUT]), [off; 3]);
    let reversed = [Event::Spindle(Spindle::Off), Event::Coolant(Coolant::Off), CUT];
    assert_eq!(behind(RAPID, reversed), [off; 3]);
}

#[test]
fn the_spindle_does_not_stand_on_the_way_out_of_the_part() {
    let (off, on) = ([false; 2], [true; 2]);
    assert_eq!(behind(CUT, [RAPID, CUT]), [on, off]);
}
