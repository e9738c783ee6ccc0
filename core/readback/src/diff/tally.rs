//! What was found on the way, by operation.

use std::collections::BTreeMap;

use serde::Serialize;

use super::events::{EventDifference, events};
use super::outline::OperationOutline;
use super::steps::{PathPosition, PathStep, StepEvent};
use super::{DiffRules, WhichProgram};
use crate::{MachineState, MotionKind, SpindleState};

/// Stretches and states that are told apart in one operation; of further ones the number alone.
const MOST: usize = 100;

/// Steps of one side with fewer in common between them are one stretch.
const SHORT: f64 = 1e-6;

/// What two programs do differently.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Difference {
    /// They do the same.
    pub same: bool,
    /// Operation by operation, in the order of the old program.
    pub operations: Vec<OperationDifference>,
    /// Sums of the old program and of the new one.
    pub sides: [ProgramSums; 2],
    /// Differences of anything but cuts that are not told, where these alone are.
    pub beside_cuts: u64,
    /// Words of either that are not understood: what they do is not compared.
    pub unknown: [Vec<String>; 2],
}

/// One program, or its part in an operation.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct ProgramSums {
    /// Its first and last line.
    pub lines: [u64; 2],
    /// Motions.
    pub motions: u64,
    /// Way of the tip at feed, mm; of a curve that of its steps.
    pub cut_mm: f64,
    /// Time at the feeds as stated, waits included, seconds.
    pub seconds: f64,
}

/// An operation of both, or of one of them.
#[derive(Clone, Debug, Default, Serialize)]
pub struct OperationDifference {
    /// Its name, if the programs say one.
    pub name: Option<String>,
    /// Number of its tool.
    pub tool: Option<u32>,
    /// Nothing is different.
    pub same: bool,
    /// In the old program, and in the new one.
    pub sides: [Option<ProgramSums>; 2],
    /// The largest distance of the tips, mm.
    pub tip: WorstDifference,
    /// The largest angle between the tool axes, degrees.
    pub axis: WorstDifference,
    /// The largest difference of feeds, as a share of the larger.
    pub feed: WorstFeedDifference,
    /// Of the rotary axes of one machine the largest difference each, degrees.
    pub rotary: Vec<(String, WorstDifference)>,
    /// What holds while the tool moves, and is another.
    pub states: Vec<StateDifference>,
    /// Waits, stops and tool changes that have no counterpart.
    pub events: Vec<EventDifference>,
    /// Ways of both between places where they part and meet again: of the old program, and of the new one.
    pub other_ways: Vec<[LoneWay; 2]>,
    /// Ways of the old program alone.
    pub left_out: Vec<LoneWay>,
    /// Ways of the new program alone.
    pub added: Vec<LoneWay>,
    /// Differences of anything but cuts, where these alone are told.
    pub beside_cuts: u64,
}

/// The largest of a kind, and where.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct WorstDifference {
    /// How large.
    pub value: f64,
    /// Line of the old program, and of the new one.
    pub lines: [u64; 2],
    /// The tip of the old program there, mm.
    pub at: [f64; 3],
    /// On how much of the old program's way it is a difference, mm.
    pub on_mm: f64,
}

/// Feeds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct WorstFeedDifference {
    /// The largest difference, and where.
    pub worst: WorstDifference,
    /// mm/min there, in the old program and in the new one.
    pub feeds: [f64; 2],
}

/// Something that holds, and is another.
#[derive(Clone, Debug, Serialize)]
pub struct StateDifference {
    /// What: `spindle`, `coolant`, `tool` ….
    pub what: &'static str,
    /// In the old program, and in the new one.
    pub values: [String; 2],
    /// Lines where it is first so.
    pub lines: [u64; 2],
    /// On how much of the old program's way, mm.
    pub on_mm: f64,
}

/// A way that one program goes alone.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LoneWay {
    /// Its first and last line.
    pub lines: [u64; 2],
    /// How long, mm.
    pub mm: f64,
    /// How much of it at feed, mm.
    pub cut_mm: f64,
    /// Where it begins, mm.
    pub at: [f64; 3],
}

/// A pair of places along the paths.
#[derive(Clone, Copy, Debug)]
pub struct PathPair {
    /// Number of the operation.
    pub operation: usize,
    /// The tips of the old program and of the new one, mm; none where one goes alone.
    pub tips: [Option<[f64; 3]>; 2],
    /// Way since the last sample, mm.
    pub way: f64,
    /// Distance of the tips, mm.
    pub tip: f64,
    /// Angle between the tool axes, degrees.
    pub axis: f64,
    /// Feeds, mm/min; 0 at rapid.
    pub feeds: [f64; 2],
}

/// Where a step of one path was gone to, and the way there, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepEnd {
    pub spot: PathPosition,
    pub way: f64,
}

/// Finds what is different in an operation.
pub(super) struct OperationTally<'t> {
    rules: &'t DiffRules,
    listen: &'t mut dyn FnMut(&PathPair),
    index: usize,
    found: OperationDifference,
    /// The same of what is no cut, where cuts alone are told.
    beside: OperationDifference,
    /// By whether it is beside cuts, what and both values, the place among the states.
    states: BTreeMap<(bool, &'static str, String, String), usize>,
    /// The states that were compared last, the kinds of motion, and whether beside cuts.
    compared: Option<([*const MachineState; 2], [MotionKind; 2], bool)>,
    /// Those of the states that hold.
    hold: Vec<usize>,
    /// The stretch at hand of either side.
    open: [Option<LoneWay>; 2],
    /// The stretch at hand of either side that is no cut, where cuts alone are told.
    open_beside: [Option<LoneWay>; 2],
    /// Both are on different ways.
    parted: bool,
    ways: [f64; 2],
    cuts: [f64; 2],
}

fn point(spot: &PathPosition) -> [f64; 3] {
    spot.pose.tip.into()
}

impl WorstDifference {
    fn take(&mut self, value: f64, limit: f64, lines: [u64; 2], at: &PathPosition, way: f64) {
        if value > self.value {
            (self.value, self.lines, self.at) = (value, lines, point(at));
        }
        if value > limit {
            self.on_mm += way;
        }
    }
}

impl<'t> OperationTally<'t> {
    pub fn new(
        rules: &'t DiffRules,
        index: usize,
        parts: [Option<&OperationOutline>; 2],
        listen: &'t mut dyn FnMut(&PathPair),
    ) -> Self {
        let named = parts[1].or(parts[0]);
        let rotary = rules.rotary.iter().enumerate();
        let rotary = rotary.filter(|(_, rotary)| **rotary && rules.one_machine);
        let found = OperationDifference {
            name: named.and_then(|part| part.name.clone()),
            tool: named.and_then(|part| part.tool),
            sides: parts.map(|part| {
                part.map(|part| ProgramSums {
                    lines: part.lines,
                    motions: part.motions,
                    ..ProgramSums::default()
                })
            }),
            rotary: rotary
                .map(|(place, _)| (rules.axes[place].clone(), WorstDifference::default()))
                .collect(),
            ..OperationDifference::default()
        };
        Self {
            rules,
            listen,
            index,
            beside: found.clone(),
            found,
            states: BTreeMap::new(),
            compared: None,
            hold: Vec::new(),
            open: [None, None],
            open_beside: [None, None],
            parted: false,
            ways: [0.0; 2],
            cuts: [0.0; 2],
        }
    }

    /// Both have gone on.
    pub fn both(&mut self, steps: [&PathStep; 2], places: [StepEnd; 2]) {
        let [old, new] = steps;
        let lines = [old.line, new.line];
        let [spot, other] = [&places[0].spot, &places[1].spot];
        let way = places[0].way;
        for side in 0..2 {
            if self.parted {
                let StepEnd { spot, way } = places[side];
                self.stretch(side, steps[side], &spot, way);
            } else if places[side].way > SHORT {
                self.close(side);
            }
            self.go(side, steps[side], places[side].way);
        }
        let [tip, axis] = spot.apart(other);
        let beside = self.is_beside(steps);
        let found = if beside { &mut self.beside } else { &mut self.found };
        found.tip.take(tip, self.rules.tip, lines, spot, way);
        let angle = axis.to_degrees();
        let limit = self.rules.axis.to_degrees();
        found.axis.take(angle, limit, lines, spot, way);
        let rotary = self.rules.rotary.iter().enumerate();
        let rotary = rotary.filter(|(_, rotary)| **rotary);
        for ((_, worst), (place, _)) in found.rotary.iter_mut().zip(rotary) {
            let apart = libm::fabs(spot.joints[place] - other.joints[place]).to_degrees();
            worst.take(apart, limit, lines, spot, way);
        }
        let cutting =
            |step: &PathStep| step.kind != MotionKind::Rapid && !step.hole && !self.parted;
        if cutting(old) && cutting(new) && places[0].way > 0.0 {
            let larger = old.feed.max(new.feed);
            let apart = match larger > 0.0 {
                true => libm::fabs(old.feed - new.feed) / larger,
                false => 0.0,
            };
            if apart > self.found.feed.worst.value {
                self.found.feed.feeds = [old.feed, new.feed];
            }
            let worst = &mut self.found.feed.worst;
            worst.take(apart, self.rules.feed, lines, spot, way);
        }
        if way > 0.0 && !self.parted {
            self.compare_states(steps, lines, way, beside);
        }
        let feeds = [old, new].map(|step| match step.kind {
            MotionKind::Rapid => 0.0,
            _ => step.feed,
        });
        (self.listen)(&PathPair {
            operation: self.index,
            tips: [Some(point(spot)), Some(point(other))],
            way,
            tip,
            axis: angle,
            feeds,
        });
    }

    /// One has gone on alone, from `share` of a step to its end.
    pub fn alone(&mut self, of: WhichProgram, step: &PathStep, share: f64) {
        let side = usize::from(of == WhichProgram::New);
        let way = step.length * (1.0 - share);
        self.stretch(side, step, &step.from.towards(&step.to, share), way);
        self.go(side, step, way);
        let mut tips = [None, None];
        tips[side] = Some(point(&step.to));
        let mut feeds = [0.0; 2];
        if step.kind != MotionKind::Rapid {
            feeds[side] = step.feed;
        }
        (self.listen)(&PathPair {
            operation: self.index,
            tips,
            way: if side == 0 { way } else { 0.0 },
            tip: 0.0,
            axis: 0.0,
            feeds,
        });
    }

    /// From here on both are on different ways, until [`OperationTally::met`].
    pub fn part(&mut self) {
        self.close(0);
        self.close(1);
        self.parted = true;
    }

    /// They are together again.
    pub fn met(&mut self) {
        self.parted = false;
        match self.open.each_mut().map(Option::take) {
            [Some(old), Some(new)] => {
                if self.found.other_ways.len() < MOST {
                    self.found.other_ways.push([old, new]);
                }
            }
            open => {
                self.open = open;
                self.close(0);
                self.close(1);
            }
        }
    }

    /// Cuts alone are told, and this is none: neither cuts, or both are on different ways and not both cut.
    fn is_beside(&self, steps: [&PathStep; 2]) -> bool {
        let cuts = steps.map(PathStep::cuts);
        let counts = if self.parted { cuts[0] && cuts[1] } else { cuts[0] || cuts[1] };
        self.rules.cuts && !counts
    }

    fn go(&mut self, side: usize, step: &PathStep, way: f64) {
        self.ways[side] += way;
        if step.kind != MotionKind::Rapid {
            self.cuts[side] += way;
        }
    }

    /// The stretch at hand goes on by a way of a step, from `at`.
    fn stretch(&mut self, side: usize, step: &PathStep, at: &PathPosition, way: f64) {
        let open = match self.rules.cuts && !step.cuts() {
            true => &mut self.open_beside,
            false => &mut self.open,
        };
        let stretch = open[side].get_or_insert(LoneWay {
            lines: [step.line; 2],
            mm: 0.0,
            cut_mm: 0.0,
            at: point(at),
        });
        stretch.lines[1] = step.line;
        stretch.mm += way;
        if step.kind != MotionKind::Rapid {
            stretch.cut_mm += way;
        }
    }

    /// The stretch at hand of a side is over. What is shorter than differences of positions are is none.
    fn close(&mut self, side: usize) {
        if let Some(stretch) = self.open_beside[side].take() {
            self.beside.beside_cuts += u64::from(stretch.mm > self.rules.tip);
        }
        let Some(stretch) = self.open[side].take() else {
            return;
        };
        let list = match side {
            0 => &mut self.found.left_out,
            _ => &mut self.found.added,
        };
        if stretch.mm > self.rules.tip && list.len() < MOST {
            list.push(stretch);
        }
    }

    fn compare_states(&mut self, steps: [&PathStep; 2], lines: [u64; 2], way: f64, beside: bool) {
        let states = steps.map(|step| std::sync::Arc::as_ptr(&step.state));
        let kinds = match steps[0].is_like(steps[1]) {
            true => [steps[0].kind; 2],
            false => steps.map(|step| step.kind),
        };
        let found = if beside { &mut self.beside } else { &mut self.found };
        if self.compared != Some((states, kinds, beside)) {
            self.compared = Some((states, kinds, beside));
            self.hold.clear();
            let [old, new] =
                [0, 1].map(|side| facts(steps[side], kinds[side], self.rules.one_control));
            for ((what, old), (_, new)) in old.into_iter().zip(new) {
                if old == new || !self.rules.compares(what) {
                    continue;
                }
                let key = (beside, what, old, new);
                let count = found.states.len();
                let place = match self.states.get(&key) {
                    Some(place) => *place,
                    None if count < MOST => {
                        found.states.push(StateDifference {
                            what,
                            values: [key.2.clone(), key.3.clone()],
                            lines,
                            on_mm: 0.0,
                        });
                        self.states.insert(key, count);
                        count
                    }
                    None => continue,
                };
                self.hold.push(place);
            }
        }
        for place in &self.hold {
            found.states[*place].on_mm += way;
        }
    }

    /// What was found, with the minutes and the events of each side.
    pub fn finish(mut self, sides: [(f64, Vec<StepEvent>); 2]) -> OperationDifference {
        self.close(0);
        self.close(1);
        let [(old, old_events), (new, new_events)] = sides;
        for (side, minutes) in [old, new].into_iter().enumerate() {
            if let Some(part) = &mut self.found.sides[side] {
                part.cut_mm = self.cuts[side];
                part.seconds = minutes * 60.0;
            }
        }
        let slack = 10.0 * self.found.tip.value + self.rules.apart;
        self.found.events = events(&old_events, &new_events, slack, self.rules.tools);
        let rules = self.rules;
        let found = &mut self.found;
        for found in [&mut *found, &mut self.beside] {
            // Where one path is a last digit longer than the other, what follows stands beside what was before.
            found.states.retain(|state| match state.what {
                "motion" => state.on_mm > 1.5 * rules.apart,
                _ => state.on_mm > rules.tip,
            });
        }
        if found.feed.worst.on_mm <= rules.tip {
            found.feed = WorstFeedDifference::default();
        }
        let [old, new] = found.sides.map(|side| side.map(|side| side.seconds));
        let seconds = match (old, new) {
            (Some(old), Some(new)) => {
                libm::fabs(old - new) <= (rules.feed * old.max(new)).max(LEAST_SECONDS)
            }
            _ => false,
        };
        if rules.cuts {
            let events = std::mem::take(&mut found.events);
            found.beside_cuts =
                self.beside.apart(rules) + self.beside.beside_cuts + events.len() as u64;
        }
        found.same = (seconds || rules.cuts)
            && found.apart(rules) == 0
            && found.feed.worst.value <= rules.feed
            && found.events.is_empty()
            && found.other_ways.is_empty()
            && found.left_out.is_empty()
            && found.added.is_empty();
        self.found
    }
}

impl OperationDifference {
    /// How many of these differ: position, tool axis, each rotary axis, each state.
    fn apart(&self, rules: &DiffRules) -> u64 {
        let limit = rules.axis.to_degrees();
        let turned = self.rotary.iter().filter(|(_, worst)| worst.value > limit).count();
        let apart = [self.tip.value > rules.tip, self.axis.value > limit];
        (turned + self.states.len()) as u64 + apart.map(u64::from).iter().sum::<u64>()
    }
}

/// Times that differ by less are the same, seconds.
const LEAST_SECONDS: f64 = 0.1;

/// What holds during a step, in words.
fn facts(step: &PathStep, kind: MotionKind, one_control: bool) -> Vec<(&'static str, String)> {
    let state = &step.state;
    let number = |number: Option<u32>| number.map_or_else(|| "none".to_owned(), |n| n.to_string());
    let spindle = match state.spindle {
        SpindleState::Off => "off".to_owned(),
        SpindleState::Clockwise(speed) => format!("clockwise {speed}"),
        SpindleState::CounterClockwise(speed) => format!("counter-clockwise {speed}"),
        SpindleState::Surface { speed, clockwise, .. } => {
            let sense = if clockwise { "clockwise" } else { "counter-clockwise" };
            format!("{sense} {speed} m/min")
        }
        SpindleState::Oriented => "oriented".to_owned(),
    };
    let flows = [
        (state.coolants.flood, "flood"),
        (state.coolants.mist, "mist"),
        (state.coolants.other, "other"),
    ];
    let flows: Vec<&str> = flows.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
    let coolant = match flows.is_empty() {
        true => "off".to_owned(),
        false => flows.join(", "),
    };
    let compensation = match state.compensation {
        0 => "off",
        side if side < 0 => "left",
        _ => "right",
    };
    let motion = match kind {
        MotionKind::Rapid => "rapid",
        MotionKind::Feed => "feed",
        MotionKind::Thread => "thread",
    };
    let mut facts = vec![
        ("motion", motion.to_owned()),
        ("tool", number(state.tool)),
        ("spindle", spindle),
        ("coolant", coolant),
        ("compensation", compensation.to_owned()),
    ];
    if one_control {
        let register = match state.compensation {
            0 => None,
            _ => state.radius_register,
        };
        facts.push(("radius register", number(register)));
        facts.push(("length register", number(state.length_register)));
        let offset = state.work_offset.clone();
        facts.push(("work offset", offset.unwrap_or_else(|| "none".to_owned())));
    }
    facts
}

impl Difference {
    pub(super) fn new(unknown: [Vec<String>; 2]) -> Self {
        Self { unknown, ..Self::default() }
    }

    /// Sums over the operations, and whether anything is different.
    pub(super) fn sum_up(&mut self, rules: &DiffRules) {
        // An operation in which nothing moves is none, unless something happens there.
        self.operations.retain(|operation| {
            let moves = operation.sides.iter().flatten().any(|side| side.motions > 0);
            moves || !operation.events.is_empty()
        });
        self.beside_cuts = self.operations.iter().map(|operation| operation.beside_cuts).sum();
        for side in 0..2 {
            let parts = self.operations.iter().filter_map(|operation| operation.sides[side]);
            let mut sum = ProgramSums::default();
            for part in parts {
                sum.lines[0] = match sum.lines[0] {
                    0 => part.lines[0],
                    first => first.min(part.lines[0]),
                };
                sum.lines[1] = sum.lines[1].max(part.lines[1]);
                sum.motions += part.motions;
                sum.cut_mm += part.cut_mm;
                sum.seconds += part.seconds;
            }
            self.sides[side] = sum;
        }
        let words = !rules.one_control || self.unknown[0] == self.unknown[1];
        self.same = words && self.operations.iter().all(|operation| operation.same);
    }
}
