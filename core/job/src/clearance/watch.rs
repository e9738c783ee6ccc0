//! A program that runs, and the proof beside it: the tool in the spindle changes, and with it the bodies.

use std::collections::BTreeMap;

use post_clearance::piece::Way;
use post_clearance::proof::{Body, BodyKind, Look, Move, Proof};
use post_machine::check::number as decimals;
use post_machine::description::RapidAxes;
use post_machine::diagnostic::{Diagnostic, Short, SourcePlace};
use post_readback::{
    BlockEffect, CycleKind, Interpolation, Motion, MotionKind, ProgramEvent, SpindleState, Stance,
    Standstill,
};
use post_removal::been::{Been, Turn, goes_alone};
use post_removal::chip::Chip;
use post_removal::profile::ToolPose;

use super::bodies::{ToolShape, of_tool};
use super::left::{Against, CutStock, Taken};
use super::pair_row::PairRow;
use super::spared::{Spared, parts};
use super::start::{Known, Start};
use super::told::{help, told};
use super::{ClearanceFound, Cuts, proof};
use crate::nc_program::NcControl;

/// Half of the last place of a feed without decimals, mm/min.
const FEED_PLACE: f64 = 0.5;

/// A length in force may differ by so much from that of the tool, mm: wear, and what a measurement leaves.
const WEAR: f64 = 0.5;

/// What is told of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Heard {
    /// The line of the program.
    pub line: u64,
    /// No two bodies are nearer on it, mm, as far as that is known.
    pub clear_by: Option<f64>,
    /// What it takes of a stock that is cut.
    pub chip: Option<Chip>,
}

/// Hears of motions.
pub type Hearer<'h> = dyn FnMut(&Heard) + 'h;

/// The proof along a program.
pub(super) struct ClearanceWatch<'a, 'h> {
    control: &'a NcControl,
    fixed: Vec<Body>,
    cuts: Cuts,
    proof: Proof,
    /// Stocks that get less by what is cut.
    stocks: Vec<CutStock>,
    /// The tool whose bodies are looked at, and its length, mm.
    tool: Option<(u32, Option<f64>)>,
    /// Where the tool has been at feed since it was changed: another one would have been there before.
    been: Been,
    /// Where the program begins.
    start: Start,
    /// It was said that the spindle turns the part.
    turns_part: bool,
    /// The tool of which it was said that another length leads it.
    misled: Option<u32>,
    /// The radius register of which it was said that the control goes beside the path by it.
    beside: Option<Option<u32>>,
    rows: BTreeMap<[String; 2], PairRow>,
    /// Who hears how near the nearest two bodies come on each line, mm, and how that is found.
    told: Option<(&'a mut Hearer<'h>, Proof)>,
    found: ClearanceFound,
    /// Tools of whose cutter no more than the radius is known, by the line from which they cut a stock that gets less.
    undrawn: Vec<(u64, u32)>,
    /// What is wrong by line.
    faults: Vec<(u64, String, &'static str)>,
}

impl<'a, 'h> ClearanceWatch<'a, 'h> {
    pub fn new(
        control: &'a NcControl,
        fixed: Vec<Body>,
        cuts: Cuts,
        hear: Option<&'a mut Hearer<'h>>,
        mut stocks: Vec<CutStock>,
    ) -> Self {
        let found = ClearanceFound {
            pairs: Vec::new(),
            lacks: Vec::new(),
            motions: 0,
            distances: 0,
            findings: Vec::new(),
            left: Vec::new(),
        };
        let proof = proof(&control.machine, fixed.clone());
        stocks.iter_mut().for_each(|stock| stock.hold(&proof));
        Self {
            told: hear.map(|hear| (hear, proof.clone())),
            proof,
            control,
            fixed,
            cuts,
            stocks,
            tool: None,
            been: Been::new(&[]),
            start: Start::default(),
            turns_part: false,
            misled: None,
            beside: None,
            rows: BTreeMap::new(),
            found,
            undrawn: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// Takes what the program did next.
    pub fn take(&mut self, done: &BlockEffect) {
        match done {
            BlockEffect::Motion(motion) => self.motion(motion),
            BlockEffect::Event { line, event: ProgramEvent::Head(name) } => {
                let message =
                    format!("head {name} is swapped in: nothing is proven of what follows");
                self.faults.push((*line, message, "prove the program of each head with --head"));
            }
            BlockEffect::Event { line, event: ProgramEvent::Subprogram(number) } => {
                let message = format!(
                    "subprogram {number} of the control runs: where it leads is not known, and not proven"
                );
                self.faults.push((*line, message, "put its blocks into the program"));
                self.proof.forget();
                self.stocks.iter_mut().for_each(CutStock::forget);
            }
            BlockEffect::Event { line, event: ProgramEvent::Cycle(call) }
                if matches!(call.kind, CycleKind::BoreFine | CycleKind::BoreBack) =>
            {
                let message = "a cycle that draws the tool aside in the hole: to which side, and how far, is the control's: nothing is proven of it";
                let help = "bore it by a cycle that draws the tool out as it stands, or by moves";
                self.faults.push((*line, message.to_owned(), help));
            }
            BlockEffect::Event { .. } | BlockEffect::State(_) => {}
        }
    }

    /// Says once where the control goes beside the path of the program by a radius.
    fn hold_beside(&mut self, motion: &Motion) {
        let state = &motion.state;
        let register = state.radius_register;
        if state.compensation == 0 || self.beside == Some(register) {
            return;
        }
        let radii = self.control.offsets.radii.iter();
        let radius = register.and_then(|register| {
            let mut own = radii.filter(|(known, _)| *known == register);
            own.next().map(|(_, radius)| *radius)
        });
        if radius == Some(0.0) {
            return;
        }
        self.beside = Some(register);
        let by = match (radius, register) {
            (Some(radius), _) => format!("by {} mm", decimals(radius, 3)),
            (None, Some(register)) => format!("by what register {register} holds"),
            (None, None) => "by the tool's radius".to_owned(),
        };
        let message = format!(
            "radius compensation: the control goes beside this path {by}, and nothing is proven of that"
        );
        let help = "of the path of the tool's centre --offsets says [radius] 1 = 0 of the register; or post without CUTCOM";
        self.faults.push((motion.line, message, help));
    }

    /// Between the words of polar interpolation the axes go in curves, which are not followed.
    fn leave_face_out(&mut self, motion: &Motion) {
        let message = "polar interpolation of the control: nothing is proven of the ways in it";
        if self.faults.iter().all(|fault| fault.1 != message) {
            let help = "prove the program that is posted without [mode.face]";
            self.faults.push((motion.line, message.to_owned(), help));
        }
        self.proof.forget();
        self.stocks.iter_mut().for_each(CutStock::forget);
    }

    fn motion(&mut self, motion: &Motion) {
        self.change_tool(motion);
        self.found.motions += 1;
        let machine = &self.control.machine;
        // Without a rotary axis there is no other spindle than that of the part.
        let lathe =
            machine.spindle.surface_speed && machine.axes.iter().all(|axis| !axis.joint.rotary);
        let spindle = motion.state.spindle;
        let kept = matches!(spindle, SpindleState::Surface { .. });
        if !self.turns_part && (kept || lathe && spindle.rpm().is_some()) {
            self.turns_part = true;
            let message = "the spindle turns the part: what is clamped is looked at as it stands, and nothing is proven of how it turns".to_owned();
            self.faults.push((motion.line, message, "programs that turn are looked at by eye; mill what turns with a machine file of its own"));
        }
        if motion.state.face.is_some() {
            return self.leave_face_out(motion);
        }
        self.hold_lengths(motion);
        self.hold_beside(motion);
        let at_rapid = motion.kind == MotionKind::Rapid;
        // As fast as a rapid may be a cut that an axis holds up: it is, if the CL file cuts as fast.
        let rapid = at_rapid || motion.fast && motion.feed > self.cuts.fastest + FEED_PLACE;
        let together = self.control.machine.clearance.rapid_axes == RapidAxes::Together;
        let way = Way {
            solver: &motion.state.solver,
            interpolation: &motion.way,
            ends: [&motion.from, &motion.to],
            independent: at_rapid && !together,
        };
        let poses = goes(motion, way.independent);
        let spared = if rapid { Spared::of(&self.been, poses, &way) } else { None };
        let spins = spins(motion);
        // What does not turn cuts nothing: its cutter is held against the stock as any other body.
        let stocks = &self.stocks;
        let looks = |one: &Body, other: &Body, spared: Option<Spared>| {
            let (stock, beside) = match one.kind {
                BodyKind::Stock => (one, other),
                _ => (other, one),
            };
            if stock.kind != BodyKind::Stock {
                return Look::Prove;
            }
            let lessens = || stocks.iter().any(|cut| cut.is(stock));
            let cutter = beside.kind == BodyKind::Cutter;
            if cutter && !rapid && spins || CutStock::holds_left(beside) && lessens() {
                return Look::LeaveOut;
            }
            match spared.filter(|spared| cutter && spared.holds(stock)) {
                Some(Spared { back, .. }) => Look::Spare { back },
                None => Look::Prove,
            }
        };
        let known = self.start.knows(&self.control.machine, motion);
        let legs = match (&known, poses) {
            (Known::Way, Some(poses)) if rapid && spared.is_none() => self.been.shares(poses),
            _ => [0.0, 1.0],
        };
        match poses {
            _ if rapid || self.control.machine.stocks.is_empty() => {}
            Some(poses) => self.been.add(poses),
            None => {
                self.been.add([at(&motion.to); 2]);
                Turn::of(&way).into_iter().for_each(|turn| self.been.add_turn(turn));
            }
        }
        let way = match known {
            Known::Way => way,
            Known::End => {
                let ends = [&motion.to; 2];
                Way { interpolation: &Interpolation::Axes, ends, independent: false, ..way }
            }
            Known::Nothing => return,
        };
        // Where the control keeps the tip it may do so at rapid as well, or not: the axes go another way then.
        let interpolation = if way.independent { way.interpolation } else { &Interpolation::Axes };
        let other = Way { independent: false, interpolation, ..way };
        let twice = at_rapid && motion.turns() && *way.interpolation != Interpolation::Axes;
        let ways = &[way, other][..1 + usize::from(twice)];
        let line = motion.line;
        let mut nearest = None;
        let mut stands = false;
        let hits = self.cutter_faults();
        for (place, way) in ways.iter().enumerate() {
            let spared = if place > 0 { Spared::of(&self.been, None, way) } else { spared };
            for (ends, spared) in parts(way, legs, spared) {
                let way = Way { ends: ends.each_ref(), ..*way };
                let motion = Move { way, rapid, line, beyond: None, instead: place > 0 };
                let looks = |one: &Body, other: &Body| looks(one, other, spared);
                self.proof.take(&motion, looks);
                if let Some((_, proof)) = &mut self.told {
                    let distance = proof.closest(&motion, looks);
                    nearest = distance.into_iter().chain(nearest).reduce(f64::min);
                }
            }
        }
        stands |= !rapid && !spins && self.cutter_faults() > hits;
        let told = self.told.is_some();
        let against = Against { motion, ways, rapid, spins, told };
        let mut chip: Option<Chip> = None;
        for stock in &mut self.stocks {
            match stock.motion(&against) {
                Taken::Cut(taken) => *chip.get_or_insert_default() += taken,
                Taken::Nothing => {}
                Taken::Stands => stands = true,
            }
        }
        if let Some((hear, _)) = &mut self.told {
            let left = self.stocks.iter().filter_map(CutStock::clear_by);
            let clear_by = left.chain(nearest).reduce(f64::min);
            hear(&Heard { line, clear_by, chip });
        }
        if stands {
            self.tell_standstill(line);
        }
    }

    /// Says once that the spindle stands in a cut: all that follows is the same.
    fn tell_standstill(&mut self, line: u64) {
        let message = "a cutter is fed into the stock while the spindle stands, or may stand: nothing is cut for certain";
        let help =
            "start the spindle before the cut, behind the tool change and any stop: S and M3 or M4";
        if self.faults.iter().all(|fault| fault.1 != message) {
            self.faults.push((line, message.to_owned(), help));
        }
    }

    /// Motions on which a cutter and the stock as it is before the first cut are not clear.
    fn cutter_faults(&self) -> u64 {
        let kind = |place: usize| self.proof.bodies()[place].kind;
        let pairs = self.proof.results().filter(|pair| {
            let kinds = pair.bodies.map(kind);
            kinds.contains(&BodyKind::Cutter) && kinds.contains(&BodyKind::Stock)
        });
        pairs.map(|pair| pair.faults).sum()
    }

    /// Says where a cut is led by another length than the tool has.
    fn hold_lengths(&mut self, motion: &Motion) {
        let stated = motion.state.length;
        if let Some((number, Some(length))) = self.tool
            && motion.kind != MotionKind::Rapid
            && stated > 0.0
            && libm::fabs(length - stated) > WEAR
            && self.misled != Some(number)
        {
            self.misled = Some(number);
            let message = format!(
                "tool {number} is {} mm long, and the length in force is {} mm: the control leads another tool",
                decimals(length, 3),
                decimals(stated, 3)
            );
            let help =
                "call the length register of this tool (H, D), or correct [tools] and --offsets";
            self.faults.push((motion.line, message, help));
        }
    }

    /// Another tool, or another length of it: what is known of the pairs is put down, and the proof begins again with its
    /// bodies.
    fn change_tool(&mut self, motion: &Motion) {
        let Some(number) = motion.state.tool else {
            if self.tool.is_none() && self.found.motions == 0 {
                self.found
                    .lacks
                    .push(format!("the tool, until one is called behind line {}", motion.line));
            }
            return;
        };
        // A register says where the control leads the tool, not how long it is.
        let stated = Some(motion.state.length).filter(|length| *length > 0.0);
        let same = self.tool.filter(|(known, _)| *known == number);
        let length = self.length_of(number).or(stated);
        let length = length.or_else(|| same.and_then(|(_, length)| length));
        if same.is_some_and(|(_, known)| known == length) {
            return;
        }
        self.tool = Some((number, length));
        self.put_down();
        let machine = &self.control.machine;
        let mut bodies = self.fixed.clone();
        let Some(length) = length else {
            self.been = Been::new(&[]);
            let message =
                format!("how long tool {number} is is not known: nothing is proven of it");
            let help = "[tools] of the machine file, --offsets or --tool-length";
            self.faults.push((motion.line, message, help));
            self.begin(bodies, None, motion.line);
            return;
        };
        let outline = machine.outline(number);
        let tool = ToolShape { number, length, outline, size: self.size_of(number) };
        let mut lacks = Vec::new();
        bodies.extend(of_tool(machine, &tool, &mut lacks));
        for name in lacks {
            if !self.found.lacks.contains(&name) {
                self.found.lacks.push(name);
            }
        }
        let profile = outline.map_or(&[][..], |outline| &outline.cutter.points);
        self.been = Been::new(profile);
        self.begin(bodies, Some(&tool), motion.line);
    }

    /// The proof begins again with these bodies, those of `tool` among them, which is called in `line`.
    fn begin(&mut self, bodies: Vec<Body>, tool: Option<&ToolShape<'_>>, line: u64) {
        let machine = &self.control.machine;
        self.proof = proof(machine, bodies);
        if let Some((_, told)) = &mut self.told {
            *told = self.proof.clone();
        }
        for stock in &mut self.stocks {
            stock.change_tool(machine, tool, &self.proof);
        }
        if let Some(tool) = tool.filter(|tool| !tool.is_drawn())
            && !self.stocks.is_empty()
            && !self.undrawn.iter().any(|(_, known)| *known == tool.number)
        {
            self.undrawn.push((line, tool.number));
        }
    }

    fn length_of(&self, number: u32) -> Option<f64> {
        let NcControl { machine, offsets, .. } = self.control;
        let of = |known: &[(u32, f64)]| {
            known.iter().find(|(tool, _)| *tool == number).map(|(_, length)| *length)
        };
        let table = || machine.tool_table.as_ref()?.entry(number, number)?.total_length();
        of(&offsets.tools).or_else(|| of(&machine.tools)).or_else(table).or(offsets.length)
    }

    /// Radius and corner radius of a tool, mm.
    fn size_of(&self, number: u32) -> Option<[f64; 2]> {
        let table = self.control.machine.tool_table.as_ref();
        let listed = table.and_then(|table| {
            let tool = table.entry(number, number)?;
            Some([tool.diameter()?, tool.corner_radius.unwrap_or(0.0)])
        });
        let cl = || self.cuts.sizes.iter().find(|(tool, _)| *tool == number).map(|(_, size)| *size);
        let size = listed.or_else(cl).filter(|[size, _]| *size > 0.0);
        size.map(|[diameter, corner]| [0.5 * diameter, corner])
    }

    /// Puts down what is known of the pairs.
    fn put_down(&mut self) {
        self.found.distances += self.proof.distances();
        for result in self.proof.results() {
            let names = result.bodies.map(|place| self.proof.bodies()[place].name.clone());
            let row = self.rows.entry(names.clone()).or_insert_with(|| PairRow::new(names));
            row.clear_by = row.clear_by.min(result.clear_by);
            if result.nearest.0 < row.nearest.0 {
                row.nearest = result.nearest;
            }
            row.faults += result.faults;
            for fault in [&result.fault, &result.worst].into_iter().flatten() {
                fault.clone().note([&mut row.fault, &mut row.worst]);
            }
        }
    }

    /// What came of the program `name`.
    pub fn finish(mut self, name: &str) -> ClearanceFound {
        self.put_down();
        for stock in std::mem::take(&mut self.stocks) {
            let (rows, distances, left) = stock.finish();
            for row in rows {
                self.rows.insert(row.names.clone(), row);
            }
            self.found.distances += distances;
            if let Some(part) = &left.part
                && part.deepest.at_least > 0.0
            {
                let [x, y, z] = part.deepest.point.into();
                let which = match left.name.strip_prefix("stock ") {
                    Some(name) => format!(" in stock {name}"),
                    None => String::new(),
                };
                let message = format!(
                    "the part{which} is cut into, {} mm deep or more at [{x:.3}, {y:.3}, {z:.3}]",
                    Short(part.deepest.at_least)
                );
                let help = "the path, the tool or [stock] part is another one";
                self.found.findings.push(Diagnostic::error("clearance", message).help(help));
            }
            self.found.left.push(left);
        }
        let at = |line| Some(SourcePlace::new(name, line, "", 0..0));
        let mut found = self.found;
        let began = self.start.told(&self.control.machine);
        found.findings.extend(began.map(|(line, warning)| warning.at(at(line))));
        for (line, message, help) in self.faults {
            found.findings.push(Diagnostic::error("clearance", message).at(at(line)).help(help));
        }
        for (line, number) in self.undrawn {
            let message = format!(
                "what tool {number} cuts is not taken from the stock: of its cutter no more than a radius is known"
            );
            let help = "cutter = [[z, r], …] under [tools.N] of the machine file draws it";
            let warning = Diagnostic::warning("clearance-body", message).at(at(line)).help(help);
            found.findings.push(warning);
        }
        for row in self.rows.values() {
            if let Some(fault) = &row.fault {
                let message = told(&self.control.machine, row, fault);
                let by_cells = found.left.iter().any(|left| left.name == row.names[0]);
                let help = help(row, fault, by_cells);
                found
                    .findings
                    .push(Diagnostic::error("clearance", message).at(at(fault.line)).help(help));
            }
        }
        found.pairs = self.rows.into_values().collect();
        if found.pairs.is_empty() {
            let by = match self.control.machine.clearance.shortens_ways() {
                true => ", and [clearance] low_retracts or link asks for it",
                false => "",
            };
            let message = format!("no two bodies move against one another: nothing is proven{by}");
            let help =
                "[solids], [fixture.NAME], [stock] and [tools.N] of the machine file have bodies";
            found.findings.push(Diagnostic::error("clearance-body", message).help(help));
        }
        found
    }
}

/// The spindle certainly turns.
fn spins(motion: &Motion) -> bool {
    let Standstill { spindle, change, .. } = motion.state.standstill;
    let turns = match motion.state.spindle {
        SpindleState::Clockwise(speed) | SpindleState::CounterClockwise(speed) => speed > 0.0,
        SpindleState::Surface { .. } => true,
        SpindleState::Off | SpindleState::Oriented => false,
    };
    turns && spindle.or(change).is_none()
}

/// Where a tool stands, part frame.
fn at(stance: &Stance) -> ToolPose {
    ToolPose { tip: stance.pose.tip, axis: stance.pose.axis }
}

/// Both ends of a motion that goes straight and does not turn; of axes that need not arrive together one goes alone.
fn goes(motion: &Motion, independent: bool) -> Option<[ToolPose; 2]> {
    let [from, to] = [&motion.from, &motion.to];
    let bends = motion.turns() || motion.way.is_curved();
    let strays = bends || independent && !goes_alone(&from.joints, &to.joints);
    (!strays).then(|| [at(from), at(to)])
}
