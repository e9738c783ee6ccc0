//! What a program did, in numbers.

use post_machine::description::Machine;
use post_machine::kinematics::MAX_AXES;
use post_readback::{BlockEffect, Motion, MotionKind, ProgramEvent};

/// What a program did.
pub struct ProgramSurvey<'a> {
    base: &'a Machine,
    /// The machine with the head that it has now.
    machine: &'a Machine,
    /// Motions at rapid, at feed, and tied to the spindle.
    pub motions: [u64; 3],
    /// Motions in positions of the machine.
    pub in_machine: u64,
    /// Motions along which the control keeps the tip.
    pub kept: u64,
    /// Minutes at rapid and at feed.
    pub minutes: [f64; 2],
    /// Seconds of waits.
    pub waits: f64,
    /// What each axis shows least and most, by name, mm or degrees.
    pub axes: Vec<(String, [f64; 2])>,
    /// Least and largest value of each axis that was looked at, mm or radians, by its place on the machine that it has now.
    seen: [[f64; 2]; MAX_AXES],
    /// Least and largest coordinate of the tip at feed, mm.
    pub tip: Option<[[f64; 3]; 2]>,
    /// Tools in the order in which they come.
    pub tools: Vec<ToolUse>,
    /// Largest feed of the tip that is stated, mm/min.
    pub feed: f64,
}

/// No value was looked at.
const UNSEEN: [[f64; 2]; MAX_AXES] = [[f64::INFINITY, f64::NEG_INFINITY]; MAX_AXES];

/// What a tool did.
pub struct ToolUse {
    /// Its number or name; none before the first change.
    pub name: Option<String>,
    /// Length that is compensated, mm.
    pub length: f64,
    /// Motions at feed.
    pub cuts: u64,
    /// Minutes at feed.
    pub minutes: f64,
}

impl<'a> ProgramSurvey<'a> {
    /// Of nothing yet.
    pub fn new(machine: &'a Machine) -> Self {
        Self {
            base: machine,
            machine,
            motions: [0; 3],
            in_machine: 0,
            kept: 0,
            minutes: [0.0; 2],
            waits: 0.0,
            axes: Vec::new(),
            seen: UNSEEN,
            tip: None,
            tools: Vec::new(),
            feed: 0.0,
        }
    }

    /// Takes what was done.
    pub fn take(&mut self, done: &BlockEffect) {
        match done {
            BlockEffect::Motion(motion) => self.motion(motion),
            BlockEffect::Event { event: told, .. } => match told {
                ProgramEvent::ToolChange { number, name } => {
                    let name = name.clone().or_else(|| number.map(|number| number.to_string()));
                    self.tool(name);
                }
                ProgramEvent::Dwell { time, revolutions: false } => self.waits += time,
                ProgramEvent::Head(name) => {
                    self.seen = UNSEEN;
                    self.machine = self.base.head(name).map_or(self.base, |head| &head.machine);
                }
                _ => {}
            },
            BlockEffect::State(_) => {}
        }
    }

    fn tool(&mut self, name: Option<String>) {
        self.tools.push(ToolUse { name, length: 0.0, cuts: 0, minutes: 0.0 });
    }

    fn motion(&mut self, motion: &Motion) {
        let kind = match motion.kind {
            MotionKind::Rapid => 0,
            MotionKind::Feed => 1,
            MotionKind::Thread => 2,
        };
        self.motions[kind] += 1;
        self.minutes[kind.min(1)] += motion.minutes;
        self.in_machine += u64::from(motion.machine);
        self.kept += u64::from(motion.state.tcp);
        for (place, axis) in self.machine.axes.iter().enumerate().take(MAX_AXES) {
            let value = motion.to.joints[place];
            let [least, most] = &mut self.seen[place];
            // What it shows lies between those of the values on both sides.
            if value > *least && value < *most {
                continue;
            }
            (*least, *most) = (least.min(value), most.max(value));
            let shown = axis.reading(value);
            // Two machines may have their axes in different places.
            let known = match self.axes.get_mut(place) {
                Some(known) if known.0 == axis.name => Some(known),
                _ => self.axes.iter_mut().find(|(name, _)| *name == axis.name),
            };
            match known {
                Some((_, [least, most])) => {
                    *least = least.min(shown);
                    *most = most.max(shown);
                }
                None => self.axes.push((axis.name.clone(), [shown, shown])),
            }
        }
        if kind == 0 {
            return;
        }
        if motion.feed > self.feed {
            self.feed = motion.feed;
        }
        for tip in [motion.from.pose.tip, motion.to.pose.tip] {
            let tip: [f64; 3] = tip.into();
            let [least, most] = self.tip.get_or_insert([tip, tip]);
            for row in 0..3 {
                least[row] = least[row].min(tip[row]);
                most[row] = most[row].max(tip[row]);
            }
        }
        if self.tools.is_empty() {
            self.tool(None);
        }
        if let Some(tool) = self.tools.last_mut() {
            tool.cuts += 1;
            tool.minutes += motion.minutes;
            if motion.state.length != 0.0 {
                tool.length = motion.state.length;
            }
        }
    }
}
