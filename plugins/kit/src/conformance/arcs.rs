//! Arcs to be tried: half a turn, a full one, the way by a radius, a helix.

use post_plugin::{Capabilities, Event, Feed};

use super::declared::{CapabilityTrial, DEEPER, DOWN, FAST};
use super::pen::{HERE, SLOW};

/// Where arcs end, in X Y and Z X, and in Y Z.
const ALONG_X: &[f64] = &[30.0, 20.0, 30.0, 5.0, 6.0];
const ALONG_Y: &[f64] = &[10.0, 40.0, 30.0, 5.0, 6.0];

/// An arc from [`HERE`].
#[derive(Clone, Copy)]
struct TriedArc {
    feed: Feed,
    centre: [f64; 3],
    normal: [f64; 3],
    turn: f64,
    radius: Option<f64>,
    words: &'static [f64],
}

impl TriedArc {
    /// Half a turn about the point midway to the end.
    fn half(normal: [f64; 3], words: &'static [f64]) -> Self {
        let centre = [0, 1, 2].map(|place| match normal[place] {
            0.0 => HERE[place].midpoint(words[place]),
            _ => HERE[place],
        });
        TriedArc { feed: SLOW, centre, normal, turn: 180.0, radius: None, words }
    }

    fn event(self) -> [Event<'static>; 1] {
        let TriedArc { feed, centre, normal, turn, radius, words } = self;
        [Event::Arc { tool: None, feed, centre, normal, turn, radius, words }]
    }
}

/// Those of every plane, with what must make a difference.
pub(super) fn arcs() -> Vec<CapabilityTrial> {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut trials = Vec::new();
    for (needs, what, normal, words) in [
        (Capabilities::ARC_XY, "an arc in X Y", z, ALONG_X),
        (Capabilities::ARC_ZX, "an arc in Z X", y, ALONG_X),
        (Capabilities::ARC_YZ, "an arc in Y Z", x, ALONG_Y),
    ] {
        let half = TriedArc::half(normal, words);
        let back = TriedArc { turn: -180.0, ..half };
        let straight = Event::linear(words, SLOW);
        trials.push(
            CapabilityTrial::new(needs, what, half.event())
                .but("the other sense", back.event())
                .but("another feed", TriedArc { feed: FAST, ..half }.event())
                .but("a straight cut in its place", [straight]),
        );
        let full = TriedArc { turn: 360.0, words: HERE, ..half };
        let mut larger = full;
        larger.centre[usize::from(normal == x)] += 0.5;
        let back = TriedArc { turn: -360.0, ..full };
        trials.push(
            CapabilityTrial::new(needs, "a full circle", full.event())
                .but("the other sense", back.event())
                .but("a larger circle", larger.event()),
        );
        let by_radius = |radius: f64| {
            let turn = if radius < 0.0 { 240.0 } else { 120.0 };
            let radius = Some(radius);
            TriedArc { turn, radius, ..half }.event()
        };
        let needs = needs.and(Capabilities::ARC_RADIUS);
        trials.push(
            CapabilityTrial::new(needs, "an arc by its radius", by_radius(12.5))
                .but("another radius", by_radius(12.6))
                .but("a radius below zero, the long way,", by_radius(-12.5)),
        );
    }
    let needs = Capabilities::HELIX.and(Capabilities::ARC_XY);
    trials.push(
        CapabilityTrial::new(needs, "a helix", TriedArc::half(z, DOWN).event())
            .but("another depth of its end", TriedArc::half(z, DEEPER).event()),
    );
    for trial in &mut trials {
        trial.under_tcp = Capabilities::ARC_TCP;
    }
    trials
}
