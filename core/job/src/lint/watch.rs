//! What each motion of a program lacks, or asks for and should not.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use post_machine::check::number;
use post_machine::description::LengthAxis;
use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};
use post_plugin::Lengths;
use post_readback::interpret::ReadReport;
use post_readback::{
    BlockEffect, Coolants, Curve, Leeway, Motion, MotionKind, ProgramEvent, SpindleState,
};

use super::depths::{CutDepths, DeepRapid, Depth};
use super::stray::{StrayPoint, StrayPoints};
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
    NotChanged,
    StrayPoint,
    Idle,
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
            Self::Idle => (Warning, "rapid", "G1 and F where it cuts"),
            Self::StrayPoint => (
                Warning,
                "stray-point",
                "look at its digits and signs; --ignore stray-point where the tool goes out and back",
            ),
            Self::NotChanged => (
                Error,
                "tool",
                "M6 beside T or behind it; --ignore tool where tools are made ready for the next program",
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

/// A tool that is made ready.
#[derive(Clone, Copy, Debug)]
struct ReadyTool {
    number: u32,
    line: u64,
    /// Something is cut behind it.
    cuts: bool,
    /// Something is cut behind it with the length in the register of its number, which was not in force before.
    has_length: bool,
}

/// A tool that moves so often at rapid with the spindle on is to cut.
const IDLE: u64 = 4;

/// What a tool has done since it was changed in.
#[derive(Clone, Copy, Debug, Default)]
struct ToolWork {
    cuts: bool,
    /// Line of its first rapid on the part with the spindle on, and how many there are.
    rapids: Option<(u64, u64)>,
}

/// What is looked at along a program.
pub(super) struct LintWatch<'m> {
    control: &'m NcControl,
    depths: Option<CutDepths>,
    broken: Vec<Broken>,
    /// Tools before the one in the spindle, and it.
    tools: [Option<u32>; 2],
    /// A tool that is made ready and was not brought so far.
    ready: Option<ReadyTool>,
    /// The tool that was changed in first.
    first_tool: Option<u32>,
    /// What the tool in the spindle has done.
    work: ToolWork,
    /// Tools that come down without a length, each with the work offset that it goes by.
    bare: Vec<(Option<u32>, Option<String>)>,
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
    /// The first line on which it cuts dry; none where a block was not understood since it came.
    dry: Option<u64>,
    /// The last tool that was cooled, as long as none before it has cut dry.
    wet_tool: Option<u32>,
    /// Some tool has cut dry all along, or nobody knows: dry ones are meant.
    dry_tools: bool,
    registers: Vec<RegisterUse>,
    /// Speeds that the spindle was asked for, by their digits.
    speeds: BTreeMap<u64, bool>,
    /// Some block was not understood since a feed was known: it may have said another.
    missed: bool,
    /// The first cut without a feed behind such a block, and how many there are.
    unfed: Option<(u64, u64)>,
    stray: StrayPoints,
    /// The deepest rapid, or the first, of each kind, and how many there are.
    rapids: Vec<(DeepRapid, u64)>,
}

/// What is told of a cut without a feed.
const NO_FEED: &str = "cuts without a feed: F is missing, or 0";

impl<'m> LintWatch<'m> {
    pub fn new(control: &'m NcControl, depths: Option<CutDepths>) -> Self {
        Self {
            control,
            depths,
            broken: Vec::new(),
            tools: [None; 2],
            ready: None,
            first_tool: None,
            work: ToolWork::default(),
            bare: Vec::new(),
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
            dry: None,
            wet_tool: None,
            dry_tools: false,
            registers: Vec::new(),
            speeds: BTreeMap::new(),
            missed: false,
            unfed: None,
            stray: StrayPoints::default(),
            rapids: Vec::new(),
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
        (self.new_tool, self.had_length, self.work.cuts) = (false, false, true);
        self.dry_tools |= !self.cooled;
        self.depths.iter_mut().for_each(CutDepths::miss);
        self.stray.miss();
    }

    /// The first cut without a feed behind a block that was not understood.
    pub fn unfed(&self) -> Option<u64> {
        self.unfed.map(|(line, _)| line)
    }

    /// None of the blocks that were not understood ahead of that cut says a feed.
    pub fn tell_unfed(&mut self) {
        if let Some((line, count)) = self.unfed.take() {
            let message = NO_FEED.to_owned();
            self.broken.push(Broken { rule: Rule::NoFeed, line, message, count });
        }
    }

    /// Takes what the program did next.
    pub fn take(&mut self, done: &BlockEffect) {
        match done {
            BlockEffect::Motion(motion) => self.motion(motion),
            BlockEffect::Event { event: ProgramEvent::ToolChange { number, .. }, .. } => {
                self.left_ready(*number);
                self.left_idle();
                self.first_tool = self.first_tool.or(*number);
                if *number != self.tools[1] || number.is_none() {
                    self.left_dry();
                    self.tools = [self.tools[1], *number];
                    self.cooled = false;
                }
                self.new_tool = true;
                self.had_length = false;
            }
            BlockEffect::Event { event: ProgramEvent::Preselect(number), line } => {
                self.left_ready(Some(*number));
                let new = *number != 0 && self.tools[1] != Some(*number);
                let (number, line) = (*number, *line);
                self.ready =
                    new.then_some(ReadyTool { number, line, cuts: false, has_length: false });
            }
            BlockEffect::Event { event: ProgramEvent::Coolant(flows), .. } => {
                self.cooled |= *flows != Coolants::default();
            }
            _ => {}
        }
    }

    /// The tool `next` comes, or is made ready, or none behind the end: the one that was made ready before it should have
    /// been brought, if something was cut since. At the end of a program the first tool of the next run, or of another
    /// program, is made ready as well.
    fn left_ready(&mut self, next: Option<u32>) {
        let Some(ready) = self.ready.take().filter(|ready| ready.cuts) else {
            return;
        };
        let ReadyTool { number, line, has_length, .. } = ready;
        let is_next = match next {
            Some(_) => next == Some(number),
            None => self.first_tool == Some(number) && !has_length,
        };
        if !is_next {
            let with = match self.tools[1] {
                Some(tool) => format!("tool {tool} cuts on"),
                None => "what is in the spindle cuts".to_owned(),
            };
            let message = format!("tool {number} is made ready, and no word changes it in: {with}");
            self.tell(Rule::NotChanged, line, message);
        }
    }

    /// The tool goes: did it cut?
    fn left_idle(&mut self) {
        let ToolWork { cuts, rapids } = std::mem::take(&mut self.work);
        if let (false, Some((line, count))) = (cuts, rapids)
            && count >= IDLE
        {
            let tool = self.tool();
            let message = format!("{tool} moves at rapid alone and cuts nothing, its spindle on");
            self.tell(Rule::Idle, line, message);
        }
    }

    /// The tool goes: did it cut dry, where all before it had coolant?
    fn left_dry(&mut self) {
        match (self.dry.take().filter(|_| !self.cooled), self.wet_tool) {
            (Some(line), Some(wet)) if !self.dry_tools => {
                let tool = self.tool();
                let message =
                    format!("{tool} cuts without coolant, and tool {wet} before it had it");
                self.tell(Rule::Coolant, line, message);
                self.dry_tools = true;
            }
            (Some(_), _) => self.dry_tools = true,
            (None, _) if self.cooled => self.wet_tool = self.tools[1],
            (None, _) => {}
        }
    }

    /// What messages call the tool in the spindle.
    fn tool(&self) -> String {
        self.tools[1].map_or_else(|| "the tool".to_owned(), |tool| format!("tool {tool}"))
    }

    /// Counts what the tool does.
    fn work(&mut self, motion: &Motion) {
        let turns = !matches!(motion.state.spindle, SpindleState::Off | SpindleState::Oriented);
        if motion.kind != MotionKind::Rapid {
            self.work.cuts = true;
        } else if turns && !motion.machine {
            self.work.rapids.get_or_insert((motion.line, 0)).1 += 1;
        }
    }

    fn motion(&mut self, motion: &Motion) {
        self.work(motion);
        if let Some(depths) = &mut self.depths {
            let rapids = &mut self.rapids;
            depths.take(&self.control.machine, motion, |rapid| note_rapid(rapids, rapid));
        }
        self.stray.take(motion);
        if motion.machine {
            return;
        }
        self.length(motion);
        // As fast as a rapid may be one.
        if motion.kind == MotionKind::Rapid || motion.fast {
            return;
        }
        if motion.kind == MotionKind::Feed && motion.from.joints != motion.to.joints {
            match motion.minutes > 0.0 {
                true => self.missed = false,
                false if self.missed => self.unfed.get_or_insert((motion.line, 0)).1 += 1,
                false => self.tell(Rule::NoFeed, motion.line, NO_FEED),
            }
        }
        if let Some(ready) = &mut self.ready {
            ready.cuts = true;
            ready.has_length |= motion.state.length_register == Some(ready.number);
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

    fn tell_rapids(&mut self) {
        if let Some(depths) = &mut self.depths {
            let rapids = &mut self.rapids;
            depths.finish(|rapid| note_rapid(rapids, rapid));
        }
        for (DeepRapid { line, why }, count) in std::mem::take(&mut self.rapids) {
            let message = match why {
                Depth::Below(below) => format!(
                    "a rapid goes {} mm below where cuts come down at feed, and nothing was cut there before",
                    number(below, 3)
                ),
                Depth::Level => {
                    "a rapid goes to the depth of the cut that follows, where nothing was cut before"
                        .to_owned()
                }
                Depth::Contour => {
                    "a rapid goes to the depth of the contour that follows, on the contour itself, where nothing was cut before"
                        .to_owned()
                }
                Depth::Down => {
                    "a rapid goes to the depth of the cut that follows, where others come down at feed: it may only beside the part"
                        .to_owned()
                }
                Depth::Across => {
                    "a rapid goes from cut to cut at their depth, where nothing was cut before: it may only beside the part"
                        .to_owned()
                }
                Depth::Staged => {
                    "a rapid goes on from close above to where a cut begins, and nothing was cut there before: is it to come down at feed?"
                        .to_owned()
                }
                Depth::Stock => {
                    "a rapid ends inside the raw part ([stock]), where nothing was cut before".to_owned()
                }
                Depth::Path => {
                    "a rapid goes on as the cuts before and behind it do: is it one of them?".to_owned()
                }
            };
            self.broken.push(Broken { rule: Rule::Rapid, line, message, count });
        }
    }

    /// Whether the control may leave the path by more than the tolerance of the machine file.
    fn smoothing(&mut self, motion: &Motion) {
        let leeway = motion.state.leeway();
        if leeway != std::mem::replace(&mut self.leeway, leeway) {
            let accuracy = &self.control.machine.accuracy;
            let tolerances = (accuracy.tolerance, accuracy.axis_tolerance);
            let beyond = leeway.beyond(&self.control.machine, tolerances.0, tolerances.1);
            if let Some(message) = beyond {
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
            self.bare.push((state.tool, state.work_offset.clone()));
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
        } else if let Some(change) = motion.state.standstill.dry_change {
            let message = format!(
                "cuts behind the tool change on line {change}, for which many controls stop the coolant, and no word turns it on again"
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
        let turns = !matches!(motion.state.spindle, SpindleState::Off | SpindleState::Oriented);
        if turns && !flows {
            self.dry.get_or_insert(motion.line);
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

    /// Two tools go by one work offset without a length: it can be measured with one of them alone.
    fn shares_an_offset(&self) -> bool {
        self.bare.iter().any(|(tool, offset)| {
            let mut others = self.bare.iter();
            tool.is_some()
                && others.any(|(other, known)| other.is_some() && other != tool && known == offset)
        })
    }

    /// What is wrong with the program `name`, of which `report` tells the rest.
    pub fn finish(mut self, name: &str, report: &ReadReport) -> Vec<Diagnostic> {
        self.left_ready(None);
        self.left_idle();
        self.left_dry();
        self.tell_rapids();
        self.tell_registers();
        if let Some((StrayPoint { line, aside }, count)) = self.stray.finish() {
            let message = format!(
                "a point stands {} mm beside the points before and behind it, which are near to one another",
                number(aside, 3)
            );
            self.broken.push(Broken { rule: Rule::StrayPoint, line, message, count });
        }
        // H alone, without the word that it belongs to.
        let names_length = report.unknown.iter().any(|(word, ..)| word == "H");
        let told = self.broken.iter().map(|Broken { rule, line, message, count }| {
            let message = match count {
                1 => message.clone(),
                count => format!("{message}; so in {count} motions"),
            };
            let told = rule.told();
            // Of a program that has no word of it anywhere somebody else may see to it: a spindle switched on by hand, a
            // work offset measured with the one tool, which is in the spindle already.
            let never = match rule {
                Rule::SpindleStands => {
                    !self.turns && report.speed.is_none() && self.first_tool.is_none()
                }
                Rule::NoLength => !self.has_lengths && !names_length && !self.shares_an_offset(),
                Rule::NotChanged => self.first_tool.is_none(),
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

/// Counts a rapid among those of its kind, of which the deepest is kept, or the first.
fn note_rapid(rapids: &mut Vec<(DeepRapid, u64)>, rapid: DeepRapid) {
    use std::mem::discriminant;
    let same =
        |(known, _): &&mut (DeepRapid, u64)| discriminant(&known.why) == discriminant(&rapid.why);
    match rapids.iter_mut().find(same) {
        None => rapids.push((rapid, 1)),
        Some((known, count)) => {
            *count += 1;
            if let (Depth::Below(deeper), Depth::Below(known_below)) = (rapid.why, known.why)
                && deeper > known_below
            {
                *known = rapid;
            }
        }
    }
}
