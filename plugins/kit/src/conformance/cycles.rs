//! Cycles to be tried, each of two points.

use post_plugin::{Capabilities, Cycle, Event, Feed, Spindle, SpindleSense};

use super::declared::{Events, Trial};

/// Those of every kind, with what must make a difference.
pub(super) fn cycles() -> Vec<Trial> {
    const KINDS: [(Capabilities, &str, Cycle); 9] = [
        (Capabilities::CYCLE_DRILL, "a drilling cycle", Cycle::Drill),
        (Capabilities::CYCLE_DEEP, "a deep drilling cycle", Cycle::Deep),
        (Capabilities::CYCLE_BREAK_CHIP, "a chip breaking cycle", Cycle::BreakChip),
        (Capabilities::CYCLE_TAP, "a tapping cycle", Cycle::Tap),
        (Capabilities::CYCLE_TAP_LEFT, "a left-hand tapping cycle", Cycle::TapLeft),
        (Capabilities::CYCLE_REAM, "a reaming cycle", Cycle::Ream),
        (Capabilities::CYCLE_BORE, "a boring cycle", Cycle::Bore),
        (Capabilities::CYCLE_BORE_FINE, "a fine boring cycle", Cycle::BoreFine),
        (Capabilities::CYCLE_BORE_BACK, "a back boring cycle", Cycle::BoreBack),
    ];
    KINDS
        .into_iter()
        .map(|(needs, what, cycle)| {
            let plain = Hole::of(cycle);
            let holes = |hole: Hole| hole.events(FIRST, SECOND);
            let mut trial = Trial::new(needs, what, holes(plain))
                .but("another depth", holes(Hole { depth: 12.5, ..plain }))
                .but("another clearance", holes(Hole { clearance: 3.0, ..plain }))
                .but("another point", plain.events(FIRST, THIRD))
                .but("a point less", plain.events(FIRST, FIRST));
            trial.under_tcp = Capabilities::CYCLE_TCP;
            if plain.pitch.is_none() {
                trial = trial.but("another feed", holes(Hole { feed: 310.0, ..plain }));
            } else {
                // As many turns a minute.
                let coarse = Hole { feed: 6000.0, pitch: Some(2.0), ..plain };
                trial = trial.but("another pitch", holes(coarse));
            }
            if plain.step.is_some() {
                trial = trial.but("another step", holes(Hole { step: Some(4.0), ..plain }));
            }
            if cycle == Cycle::Drill {
                let dwell = Hole { dwell: Some(2.0), ..plain };
                trial = trial.but("a dwell", holes(dwell));
            }
            trial
        })
        .collect()
}

/// Points of holes; the tool comes to the first one's retract level.
const FIRST: &[f64] = &[10.0, 20.0, 30.0, 5.0, 6.0];
const SECOND: &[f64] = &[40.0, 25.0, 30.0, 5.0, 6.0];
const THIRD: &[f64] = &[41.0, 25.0, 30.0, 5.0, 6.0];
const ABOVE: &[f64] = &[10.0, 20.0, 80.0, 5.0, 6.0];

/// Lengths in mm.
#[derive(Clone, Copy)]
struct Hole {
    cycle: Cycle,
    feed: f64,
    depth: f64,
    clearance: f64,
    step: Option<f64>,
    dwell: Option<f64>,
    pitch: Option<f64>,
}

impl Hole {
    fn of(cycle: Cycle) -> Self {
        let tap = matches!(cycle, Cycle::Tap | Cycle::TapLeft);
        Hole {
            cycle,
            // 3000 turns a minute.
            feed: if tap { 4500.0 } else { 300.0 },
            depth: 12.0,
            clearance: 2.0,
            step: matches!(cycle, Cycle::Deep | Cycle::BreakChip).then_some(3.0),
            dwell: None,
            pitch: tap.then_some(1.5),
        }
    }

    /// Two points, one if they are the same.
    fn events(self, first: &'static [f64], second: &'static [f64]) -> Events {
        let Hole { cycle, feed, depth, clearance, step, dwell, pitch } = self;
        let point = |words| Event::CyclePoint { tool: None, words };
        let mut events = vec![Event::rapid(ABOVE)];
        if cycle == Cycle::TapLeft {
            let sense = SpindleSense::CounterClockwise;
            events.push(Event::Spindle(Spindle::On { rpm: 3000.0, sense }));
        }
        events.extend([
            Event::Cycle {
                cycle,
                feed: Feed::PerMinute(feed),
                depth,
                clearance,
                retract: 50.0,
                step,
                dwell,
                pitch,
            },
            point(first),
        ]);
        if second != first {
            events.push(point(second));
        }
        events.push(Event::CycleOff);
        events
    }
}
