//! Cycles to be tried, each of two points.

use post_plugin::{Capabilities, Cycle, Event, Feed, Spindle, SpindleSense};

use super::declared::{CapabilityTrial, Events};

/// Those of every kind, with what must make a difference.
pub(super) fn cycles(declares: Capabilities) -> Vec<CapabilityTrial> {
    const KINDS: [(&str, Cycle); 9] = [
        ("a drilling cycle", Cycle::Drill),
        ("a deep drilling cycle", Cycle::Deep),
        ("a chip breaking cycle", Cycle::BreakChip),
        ("a tapping cycle", Cycle::Tap),
        ("a left-hand tapping cycle", Cycle::TapLeft),
        ("a reaming cycle", Cycle::Ream),
        ("a boring cycle", Cycle::Bore),
        ("a fine boring cycle", Cycle::BoreFine),
        ("a back boring cycle", Cycle::BoreBack),
    ];
    KINDS
        .into_iter()
        .map(|(what, cycle)| {
            let plain = TriedCycle::of(cycle);
            let holes = |hole: TriedCycle| hole.events(FIRST, SECOND);
            let mut trial = CapabilityTrial::new(cycle.capability(), what, holes(plain))
                .but("another depth", holes(TriedCycle { depth: 12.5, ..plain }))
                .but("another clearance", holes(TriedCycle { clearance: 3.0, ..plain }))
                .but("another point", plain.events(FIRST, THIRD))
                .but("a point less", plain.events(FIRST, FIRST));
            trial.under_tcp = Capabilities::CYCLE_TCP;
            if plain.pitch.is_none() {
                trial = trial.but("another feed", holes(TriedCycle { feed: 310.0, ..plain }));
            } else {
                // As many turns a minute.
                let coarse = TriedCycle { feed: 6000.0, pitch: Some(2.0), ..plain };
                trial = trial.but("another pitch", holes(coarse));
            }
            if plain.step.is_some() {
                trial = trial.but("another step", holes(TriedCycle { step: Some(4.0), ..plain }));
            }
            if cycle == Cycle::Drill && !declares.has(Capabilities::CYCLE_NO_DWELL) {
                let dwell = TriedCycle { dwell: Some(2.0), ..plain };
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
struct TriedCycle {
    cycle: Cycle,
    feed: f64,
    depth: f64,
    clearance: f64,
    step: Option<f64>,
    dwell: Option<f64>,
    pitch: Option<f64>,
}

impl TriedCycle {
    fn of(cycle: Cycle) -> Self {
        let tap = matches!(cycle, Cycle::Tap | Cycle::TapLeft);
        TriedCycle {
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
        let TriedCycle { cycle, feed, depth, clearance, step, dwell, pitch } = self;
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
