//! What each motion of a program lacks, or asks for and should not.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use post_machine::check::number;
use post_machine::description::LengthAxis;
use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};
use post_plugin::Lengths;
use post_readback::{
    BlockEffect, Coolants, Curve, Leeway, Motion, MotionKind, ProgramEvent, SpindleState,
};

use super::depths::{CutDepths, DeepRapid};
use crate::nc_program::NcControl;

/// Ends of an arc that are so near to one another, mm, are one point or two as rounding has it; nearer than the second of
/// them they are one for certain.
const SAME: [f64; 2] = [0.01, 1e-6];

/// A move that is shorter has no direction, mm.
const SHORT: f64 = 1e-6;

/// What is looked for at each motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    NoFeed,
    SpindleStands,
    SpindleSpeed,
    SpindleStopped,
    Coolant,
    NoLength,
    OtherLength,
    Register,
    FullCircle,
    Rapid,
    Smoothing,
}

/// How a rule is told.
struct RuleText {
    severity: Severity,
    code: &'static str,
    help: &'static str,
}

impl Rule {
    fn told(self) -> RuleText {
        use Severity::{Error, Warning};
        let (severity, code, help) = match self {
            Self::NoFeed => (Error, "feed", "F above zero in the block, or before it"),
            Self::SpindleStands => {
                (Error, "spindle", "S and M3 or M4 ahead of the cut, behind the tool change")
            }
            Self::SpindleSpeed => (Error, "spindle-speed", "another S, or another machine file"),
            Self::SpindleStopped => (Warning, "spindle", "M3 or M4 once more behind it"),
            Self::Coolant => (Warning, "coolant", "the coolant on once more, if it is wanted"),
            Self::NoLength => (
                Error,
                "length",
                "call the length behind the tool change: G43 H…, D… or as the control has it",
            ),
            Self::OtherLength => {
                (Error, "length", "call the length behind the tool change: G43 H…")
            }
            Self::Register => (Warning, "register", "H as the tool has it"),
            Self::FullCircle => (
                Warning,
                "full-circle",
                "a straight move, or a full circle whose end is its beginning",
            ),
            Self::Rapid => (
                Warning,
                "rapid",
                "come down at feed, or see that nothing is in the way; [stock] of the machine file tells",
            ),
            Self::Smoothing => (
                Warning,
                "smoothing",
                "less of it, or [accuracy] and [program.smoothing] of the machine file as large as what is meant",
            ),
        };
        RuleText { severity, code, help }
    }
}

/// A rule that a program breaks: once for all places.
#[derive(Clone, Debug)]
struct Broken {
    rule: Rule,
    line: u64,
    message: String,
    count: u64,
}

/// A tool, the register of its length, and the line at which it cuts so first.
#[derive(Clone, Copy, Debug)]
struct RegisterUse {
    tool: u32,
    register: u32,
    /// It is that of the tool before.
    stale: bool,
    line: u64,
}

/// What is looked at along a program.
pub(super) struct LintWatch<'m> {
    control: &'m NcControl,
    depths: Option<CutDepths>,
    broken: Vec<Broken>,
    /// Tools before the one in the spindle, and it.
    tools: [Option<u32>; 2],
    /// The length of the tool was not looked at since it was changed.
    new_tool: bool,
    /// How far the control may leave the path, mm.
    leeway: Leeway,
    /// The length of the tool in the spindle was in force since it was changed.
    had_length: bool,
    /// Place in the chain of the axis that the length counts along; none where nobody knows.
    depth: Option<usize>,
    /// Some tool has a length in force somewhere.
    has_lengths: bool,
    /// The spindle turns somewhere.
    turns: bool,
    /// The tool in the spindle was cooled in a cut.
    cooled: bool,
    registers: Vec<RegisterUse>,
    /// Speeds that the spindle was asked for, by their digits.
    speeds: BTreeMap<u64, bool>,
    /// Some block was not understood: it may have said a feed.
    missed: bool,
    /// The deepest rapid, and how many there are.
    deepest: Option<(DeepRapid, u64)>,
}

impl<'m> LintWatch<'m> {
    pub fn new(control: &'m NcControl, depths: Option<CutDepths>) -> Self {
        Self {
            control,
            depths,
            broken: Vec::new(),
            tools: [None; 2],
            new_tool: true,
            leeway: Leeway::default(),
            had_length: false,
            depth: match control.machine.length_axis {
                LengthAxis::Said(place) => Some(place),
                _ => control.machine.lies_along().map(|(place, _)| place),
            },
            has_lengths: false,
            turns: false,
            cooled: false,
            registers: Vec::new(),
            speeds: BTreeMap::new(),
            missed: false,
            deepest: None,
        }
    }

    /// Notes that a rule is broken.
    fn tell(&mut self, rule: Rule, line: u64, message: impl Into<String>) {
        let message = message.into();
        let same = |known: &&mut Broken| known.rule == rule && known.message == message;
        match self.broken.iter_mut().find(same) {
            Some(known) => known.count += 1,
            None => self.broken.push(Broken { rule, line, message, count: 1 }),
        }
    }

    /// A block was not understood: of what it would have changed nothing is told.
    pub fn miss(&mut self) {
        self.missed = true;
        (self.new_tool, self.had_length) = (false, false);
        self.depths.iter_mut().for_each(CutDepths::miss);
    }

    /// Takes what the program did next.
    pub fn take(&mut self, done: &BlockEffect) {
        match done {
            BlockEffect::Motion(motion) => self.motion(motion),
            BlockEffect::Event { event: ProgramEvent::ToolChange { number, .. }, .. } => {
                if *number != self.tools[1] || number.is_none() {
                    self.tools = [self.tools[1], *number];
                    self.cooled = false;
                }
                self.new_tool = true;
                self.had_length = false;
            }
            BlockEffect::Event { event: ProgramEvent::Coolant(flows), .. } => {
                self.cooled |= *flows != Coolants::default();
            }
            _ => {}
        }
    }

    fn motion(&mut self, motion: &Motion) {
        let deep =
            self.depths.as_mut().and_then(|depths| depths.take(&self.control.machine, motion));
        self.deep_rapid(deep);
        if motion.machine {
            return;
        }
        self.length(motion);
        // As fast as a rapid may be one.
        if motion.kind == MotionKind::Rapid || motion.fast {
            return;
        }
        if motion.kind == MotionKind::Feed
            && motion.minutes <= 0.0
            && !self.missed
            && motion.from.joints != motion.to.joints
        {
            self.tell(Rule::NoFeed, motion.line, "cuts without a feed: F is missing, or 0");
        }
        self.arc(motion);
        self.smoothing(motion);
        // Up and away it cuts no more than before.
        let way = motion.to.pose.tip - motion.from.pose.tip;
        if way.dot(&motion.to.pose.axis) <= SHORT {
            self.spindle(motion);
            self.coolant(motion);
        }
    }

    fn deep_rapid(&mut self, deep: Option<DeepRapid>) {
        let Some(deep) = deep else {
            return;
        };
        let (known, count) = self.deepest.get_or_insert((deep, 0));
        *count += 1;
        if deep.below > known.below {
            *known = deep;
        }
    }

    fn tell_rapids(&mut self) {
        let Some((DeepRapid { line, below }, count)) = self.deepest else {
            return;
        };
        let message = match below > 0.0 {
            true => format!(
                "a rapid goes {} mm below where cuts come down at feed, and nothing was cut there before",
                number(below, 3)
            ),
            false => {
                "a rapid goes to the depth of the cut that follows, where nothing was cut before"
                    .to_owned()
            }
        };
        self.broken.push(Broken { rule: Rule::Rapid, line, message, count });
    }

    /// Whether the control may leave the path by more than the tolerance of the machine file.
    fn smoothing(&mut self, motion: &Motion) {
        let leeway = motion.state.leeway();
        if leeway != std::mem::replace(&mut self.leeway, leeway) {
            let accuracy = &self.control.machine.accuracy;
            let tolerances = (accuracy.tolerance, accuracy.axis_tolerance);
            let beyond = leeway.beyond(&self.control.machine, tolerances.0, tolerances.1);
            for message in beyond.collect::<Vec<_>>() {
                self.tell(Rule::Smoothing, motion.line, message);
            }
        }
    }

    /// Whether the length of the tool is in force as it comes down, and whose it is as it cuts.
    fn length(&mut self, motion: &Motion) {
        let (machine, state) = (&self.control.machine, &motion.state);
        let lengths = self.control.lexicon.lengths();
        let register = state.length_register.filter(|register| *register != 0);
        let stated = register.is_some() || state.length != 0.0;
        self.has_lengths |= stated;
        self.had_length |= stated;
        if !lengths.are_named() || machine.length_axis == LengthAxis::None {
            return;
        }
        let cuts = motion.kind != MotionKind::Rapid && !motion.fast;
        let way = motion.to.pose.tip - motion.from.pose.tip;
        let [from, to] = [&motion.from, &motion.to].map(|end| &end.joints);
        // A tool that leans goes down along itself where the axes across the depth move alone, as high up as ever.
        let lowers = self.depth.is_none_or(|place| from[place] != to[place]);
        // Where the tool turns its tip goes along, whatever its length is taken to be.
        if !cuts && (motion.turns() || !lowers || way.dot(&motion.to.pose.axis) > -SHORT) {
            return;
        }
        if std::mem::take(&mut self.new_tool) && !stated {
            let message = match state.tool {
                Some(tool) => format!("tool {tool} comes down, and no length of it is in force"),
                None => "the tool comes down, and no length of it is in force".to_owned(),
            };
            self.tell(Rule::NoLength, motion.line, message);
        }
        if cuts && !stated && std::mem::take(&mut self.had_length) {
            let tool =
                state.tool.map_or_else(|| "the tool".to_owned(), |tool| format!("tool {tool}"));
            let message =
                format!("{tool} cuts, and its length, which was in force, was taken away");
            self.tell(Rule::NoLength, motion.line, message);
        }
        let ([before, _], line) = (self.tools, motion.line);
        if let (true, Lengths::Registers, Some(tool), Some(register)) =
            (cuts, lengths, state.tool, register)
        {
            let known = self.registers.iter();
            let mut same = known.filter(|known| known.tool == tool && known.register == register);
            if same.next().is_none() {
                let stale = before == Some(register) && tool != register;
                self.registers.push(RegisterUse { tool, register, stale, line });
            }
        }
    }

    fn spindle(&mut self, motion: &Motion) {
        let machine = &self.control.machine;
        let state = &motion.state;
        let turns = self.control.lexicon.has_spindle();
        if !turns || machine.along.is_some() || state.solver.chain().edge().is_some() {
            return;
        }
        let line = motion.line;
        match state.spindle {
            // In a hole the control turns it as the cycle wants.
            SpindleState::Off | SpindleState::Oriented
                if motion.kind == MotionKind::Thread
                    || motion.hole && state.spindle == SpindleState::Oriented => {}
            SpindleState::Off | SpindleState::Oriented => {
                self.tell(Rule::SpindleStands, line, "cuts while the spindle stands");
            }
            SpindleState::Clockwise(rpm) | SpindleState::CounterClockwise(rpm) => {
                self.turns = true;
                if *self.speeds.entry(rpm.to_bits()).or_insert(true)
                    && let Some(finding) = machine.spindle.refuse(rpm)
                {
                    self.speeds.insert(rpm.to_bits(), false);
                    self.tell(Rule::SpindleSpeed, line, finding.message);
                }
            }
            SpindleState::Surface { .. } => self.turns = true,
        }
        let standstill = state.standstill;
        if let Some(stop) = standstill.spindle {
            let message = format!(
                "cuts behind the stop on line {stop}, which stops the spindle, and no word turns it on again"
            );
            self.tell(Rule::SpindleStopped, line, message);
        } else if let Some(change) = standstill.change
            && state.spindle != SpindleState::Off
        {
            let message = format!(
                "cuts behind the tool change on line {change}, for which most controls stop the spindle, and no word turns it on again"
            );
            self.tell(Rule::SpindleStopped, line, message);
        }
    }

    fn coolant(&mut self, motion: &Motion) {
        let flows = motion.state.coolants != Coolants::default();
        if let Some(stop) = motion.state.standstill.coolant {
            let message = format!(
                "cuts behind the stop on line {stop}, which stops the coolant, and no word turns it on again"
            );
            self.tell(Rule::Coolant, motion.line, message);
        } else if self.cooled && !flows {
            let tool = match motion.state.tool {
                Some(tool) => format!("tool {tool}"),
                None => "the tool".to_owned(),
            };
            let message = format!("{tool} goes on cutting without coolant, and began with it");
            self.tell(Rule::Coolant, motion.line, message);
        }
        self.cooled |= flows;
    }

    /// Whether it is left to rounding that an arc is a full circle.
    fn arc(&mut self, motion: &Motion) {
        let Curve::Arc { sweep, .. } = motion.way.curve() else {
            return;
        };
        let apart = (motion.to.pose.tip - motion.from.pose.tip).norm();
        if libm::fabs(*sweep) > PI && apart < SAME[0] && apart > SAME[1] {
            let message = format!(
                "an arc goes nearly all around to end {} mm from where it begins: rounded otherwise it does not move",
                number(apart, 6)
            );
            self.tell(Rule::FullCircle, motion.line, message);
        }
    }

    /// What of the registers of lengths is strange: that of another tool, unless all are as far from their tools.
    fn tell_registers(&mut self) {
        let registers = std::mem::take(&mut self.registers);
        let apart = |used: &RegisterUse| i64::from(used.register) - i64::from(used.tool);
        let alike =
            registers.len() > 1 && registers.iter().all(|used| apart(used) == apart(&registers[0]));
        let mut others = registers.iter().filter(|used| apart(used) != 0);
        while let Some(RegisterUse { tool, register, stale, line }) =
            others.next().filter(|_| !alike)
        {
            match stale {
                true => {
                    let message = format!(
                        "tool {tool} cuts with the length in register {register}, which was that of the tool before it"
                    );
                    self.tell(Rule::OtherLength, *line, message);
                }
                false => {
                    let message =
                        format!("tool {tool} cuts with the length in register {register}");
                    self.tell(Rule::Register, *line, message);
                }
            }
        }
    }

    /// What is wrong with the program `name`.
    pub fn finish(mut self, name: &str) -> Vec<Diagnostic> {
        let deep = self.depths.as_mut().and_then(CutDepths::finish);
        self.deep_rapid(deep);
        self.tell_rapids();
        self.tell_registers();
        let told = self.broken.iter().map(|Broken { rule, line, message, count }| {
            let message = match count {
                1 => message.clone(),
                count => format!("{message}; so in {count} motions"),
            };
            let told = rule.told();
            // Of a program that never says it, somebody else does.
            let never = match rule {
                Rule::SpindleStands => !self.turns,
                Rule::NoLength => !self.has_lengths,
                _ => false,
            };
            let severity = if never { Severity::Warning } else { told.severity };
            let place = SourcePlace::new(name, *line, "", 0..0);
            let finding = Diagnostic::error(told.code, message).help(told.help).at(Some(place));
            Diagnostic { severity, ..finding }
        });
        told.collect()
    }
}
