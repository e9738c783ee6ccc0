//! The stock while the program cuts it: cutter, shank and holder against what is left.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use post_clearance::beside::Beside;
use post_clearance::piece::Way;
use post_clearance::placement::Placement;
use post_clearance::proof::{Body, BodyKind, Fault, Proof, Verdict};
use post_clearance::shape::Shape;
use post_machine::check::number as decimals;
use post_machine::description::{GivenBody, GivenShape, Machine, TurnedProfile};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joint;
use post_readback::{Motion, SpindleState};
use post_removal::along::{self, Found, Mounted, Place, Seat, Watched};
use post_removal::been::{Been, Turn};
use post_removal::chip::Chip;
use post_removal::compare::surface_of;
use post_removal::field::{Cutter, Field, Volume};
use post_removal::mesh::Triangle;
use post_removal::profile::{ToolPose, between};

use super::bodies::{ToolShape, closed_mesh, placed, unusable};
use super::pair_row::PairRow;
use super::stock_left::StockLeft;
use super::tool_cut::ToolCut;

/// What cannot be told from a distance that is too short by less than this counts as one, mm.
const WITHIN: f64 = 0.01;

/// A mesh in the frame of a field with its low corner at `low`.
fn shifted(mut triangles: Vec<Triangle>, low: Vector3<f64>) -> Vec<Triangle> {
    for corner in triangles.iter_mut().flatten() {
        *corner -= low;
    }
    triangles
}

/// A body of more pieces is held against the stock before the first cut.
const MOST_PIECES: usize = 64;

/// The stock, and the tool that cuts it.
pub(super) struct CutStock {
    name: String,
    axes: Vec<Joint>,
    field: Field,
    /// Where the field is on the machine, and its low corner in the frame of the shape, mm.
    seat: Seat,
    low: Vector3<f64>,
    placed: Placement,
    /// The part that is to become of it, in the frame of the field, and its surface.
    part: Option<(Field, Shape)>,
    before: Volume,
    been: Been,
    tool: Option<CuttingTool>,
    /// Bodies besides the tool that move against it.
    others: Vec<Held>,
    cuts: BTreeMap<u32, ToolCut>,
    /// What the tool in the spindle has cut, and what was left before.
    chips: Volume,
    began: Volume,
    rows: Vec<PairRow>,
    distances: u64,
    /// On the motion that was taken last nothing that is held against what is left came nearer to it, mm.
    clear_by: f64,
}

/// The tool in the spindle.
struct CuttingTool {
    number: u32,
    /// What it removes, and where that is; where no more than its radius is known, nothing for certain. None where not even
    /// that is known.
    cutter: Option<(Cutter, Mounted)>,
    /// How far its edges go up from the tip, mm.
    edge: f64,
    parts: Vec<Part>,
    /// Nothing is left where it stands: it came there cutting, or clear of all.
    free: bool,
}

/// A body that is held against what is left.
struct Held {
    /// Place of its pair with the stock.
    row: usize,
    watched: Watched,
    /// What it keeps from the stock at feed and at rapid, mm.
    keep: [f64; 2],
    /// It does not, at rapid, where the motion leaves a cut or comes to one.
    yields: bool,
    /// Before the motion, and behind it.
    beside: [Beside; 2],
}

/// A part of a tool.
struct Part {
    kind: PartKind,
    held: Held,
    /// All of it, as what may remove where it touches.
    body: Cutter,
    mounted: Mounted,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PartKind {
    Holder,
    Cutter,
    Shank,
}

/// How a motion goes against the stock.
pub(super) struct Against<'a> {
    pub motion: &'a Motion,
    /// The ways that it may go.
    pub ways: &'a [Way<'a>],
    /// At rapid traverse.
    pub rapid: bool,
    /// The spindle certainly turns.
    pub spins: bool,
    /// How near anything comes is told, of what is spared too.
    pub told: bool,
}

/// What a motion does to the stock.
pub(super) enum Taken {
    /// It cuts nothing.
    Nothing,
    /// It takes this of it.
    Cut(Chip),
    /// Its cutter is fed into it while the spindle stands.
    Stands,
}

/// What of a profile lies between two heights, mm.
fn cut_off(profile: &TurnedProfile, heights: [f64; 2]) -> TurnedProfile {
    let TurnedProfile { points, outer, inner } = profile;
    let [points, outer, inner] = [points, outer, inner].map(|points| between(points, heights));
    TurnedProfile { points, outer, inner }
}

impl CutStock {
    /// The stocks of a machine whose file says that they are cut.
    pub fn all(machine: &Machine, findings: &mut Vec<Diagnostic>) -> Vec<Self> {
        machine.stocks.iter().filter_map(|given| Self::new(machine, given, findings)).collect()
    }

    fn new(machine: &Machine, given: &GivenBody, findings: &mut Vec<Diagnostic>) -> Option<Self> {
        let cut = given.cut.as_ref()?;
        let triangles = match &given.shape {
            GivenShape::File(file) => {
                Some(closed_mesh(file, (&given.place, &given.name), findings)?)
            }
            _ => None,
        };
        let [low, high] = match &triangles {
            Some(triangles) => {
                let corners = triangles.iter().flatten();
                let infinite = Vector3::repeat(f64::INFINITY);
                corners.fold([infinite, -infinite], |[low, high], corner| {
                    [low.inf(corner), high.sup(corner)]
                })
            }
            None => given.extents()?.map(Vector3::from),
        };
        let size = high - low;
        let resolution = cut.resolution.unwrap_or_else(|| Field::resolution(size));
        let finest = Field::finest(size);
        if resolution < finest {
            let why = format!(
                "resolution {resolution} mm is finer than there is room for with a stock of its size"
            );
            let fits = libm::ceil(finest * 1e3) / 1e3;
            let help = format!("resolution = {} or more, mm", decimals(fits, 3));
            findings.push(unusable(&given.name, (&why, &help), &given.place));
            return None;
        }
        let field = match (&given.shape, triangles) {
            (GivenShape::Cylinder { ends, radius }, _) => {
                Field::cylinder(size, ends.map(|end| end - low), *radius, resolution)
            }
            (_, Some(triangles)) => Field::mesh(size, &shifted(triangles, low), resolution),
            _ => Field::block(size, resolution),
        };
        let part = cut.part.as_ref().and_then(|file| {
            let triangles = closed_mesh(file, (&given.place, "the part"), findings)?;
            let triangles = shifted(triangles, low);
            let surface = surface_of(&triangles)?;
            Some((Field::mesh(size, &triangles, resolution), surface))
        });
        let placed = placed(machine, given);
        let frame = Placement { shift: placed.point(low), ..placed };
        let seat = Seat { link: given.link, frame };
        let axes = machine.axes.iter().map(|axis| axis.joint).collect();
        let (before, been) = (field.volume(), Been::new(&[]));
        let (tool, others) = (None, Vec::new());
        let (cuts, rows, distances) = (BTreeMap::new(), Vec::new(), 0);
        Some(Self {
            name: given.name.clone(),
            axes,
            field,
            seat,
            low,
            placed,
            part,
            before,
            been,
            tool,
            others,
            cuts,
            chips: Volume::default(),
            began: before,
            rows,
            distances,
            clear_by: f64::INFINITY,
        })
    }

    /// A body is held against what is left of a stock, and not by the proof against all of it.
    pub fn holds_left(body: &Body) -> bool {
        let tool = matches!(body.kind, BodyKind::Holder | BodyKind::Cutter);
        tool || body.kind != BodyKind::Stock && body.shape.pieces() <= MOST_PIECES
    }

    /// A body of the proof is this stock as it is before the first cut.
    pub fn is(&self, body: &Body) -> bool {
        body.kind == BodyKind::Stock && body.name == self.name
    }

    /// Takes the bodies of a proof besides those of the tool that it holds against the stock.
    pub fn hold(&mut self, proof: &Proof) {
        let bodies = proof.bodies().iter().enumerate();
        let Some((stock, _)) = bodies.clone().find(|(_, body)| self.is(body)) else {
            return;
        };
        for (place, body) in bodies.filter(|(_, body)| Self::holds_left(body)) {
            let pair = [stock.min(place), stock.max(place)];
            let Some(rules) = proof.rules_between(pair) else { continue };
            let sphere = body.shape.sphere();
            let mounted = Mounted::on_link((&self.axes, body.link), &self.seat, sphere);
            let row = self.row(body.name.clone());
            let watched = Watched::of_pieces(mounted, body.shape.convex().to_vec());
            let keep = [rules.keep, rules.rapid];
            let beside = [Beside::default(); 2];
            self.others.push(Held { row, watched, keep, yields: false, beside });
        }
    }

    /// Another tool is in the spindle; pairs that `proof` leaves out are left out here.
    pub fn change_tool(&mut self, machine: &Machine, tool: Option<&ToolShape<'_>>, proof: &Proof) {
        self.been.clear();
        self.put_down();
        let cutting = tool.map(|tool| self.cutting(machine, tool, proof));
        self.tool = cutting;
    }

    fn cutting(&mut self, machine: &Machine, tool: &ToolShape<'_>, proof: &Proof) -> CuttingTool {
        let ToolShape { number, length, outline, .. } = *tool;
        let up = machine.tool_axis;
        let at_tip = ToolPose { tip: machine.gauge - up * length, axis: up };
        let at_gauge = ToolPose { tip: machine.gauge, axis: -up };
        let profile = tool.cutter().unwrap_or_default();
        let edge = outline.and_then(|outline| outline.edge).unwrap_or(f64::INFINITY);
        let edges = cut_off(&profile, [f64::NEG_INFINITY, edge]);
        let holder = outline.map_or_else(TurnedProfile::default, |outline| outline.holder.clone());
        let shank = cut_off(&profile, [edge, f64::INFINITY]);
        let bodies = [
            (PartKind::Holder, "holder", BodyKind::Holder, at_gauge, holder),
            (PartKind::Cutter, "cutter", BodyKind::Cutter, at_tip, edges.clone()),
            (PartKind::Shank, "shank", BodyKind::Cutter, at_tip, shank),
        ];
        let mut parts = Vec::new();
        for (kind, what, counted, at_zero, profile) in bodies {
            let TurnedProfile { inner, outer, .. } = profile;
            let shape = Shape::turned(&outer, at_zero.tip, at_zero.axis);
            let rules = proof.rules_of(|one, other| self.is(one) && other.kind == counted);
            let (Some(rules), Some(shape)) = (rules, shape) else { continue };
            let yields = kind != PartKind::Holder;
            let keep = [if yields { 0.0 } else { rules.keep }, rules.rapid];
            let mounted = Mounted::new(&self.axes, &self.seat, at_zero, shape.sphere());
            let row = self.row(format!("{what} T{number}"));
            let body = Cutter::vague(&outer);
            let watched = Watched::new(mounted.clone(), inner, &outer);
            let held = Held { row, watched, keep, yields, beside: [Beside::default(); 2] };
            parts.push(Part { kind, held, body, mounted });
        }
        let TurnedProfile { inner, outer, .. } = &edges;
        let cutter = Shape::turned(outer, at_tip.tip, up).map(|shape| {
            let mounted = Mounted::new(&self.axes, &self.seat, at_tip, shape.sphere());
            let cutter = match tool.is_drawn() {
                true => Cutter::between(inner, outer),
                false => Cutter::vague(outer),
            };
            (cutter, mounted)
        });
        self.been = Been::new(&profile.points);
        CuttingTool { number, cutter, edge, parts, free: false }
    }

    /// Puts down what the tool in the spindle has cut.
    fn put_down(&mut self) {
        let after = self.field.volume();
        let own = self.tool.as_ref().and_then(|tool| self.cuts.get_mut(&tool.number));
        if let Some(own) = own {
            own.add(self.chips, [self.began, after]);
        }
        (self.chips, self.began) = (Volume::default(), after);
    }

    fn row(&mut self, other: String) -> usize {
        let names = [self.name.clone(), other];
        if let Some(place) = self.rows.iter().position(|row| row.names == names) {
            return place;
        }
        self.rows.push(PairRow::new(names));
        self.rows.len() - 1
    }

    /// Nothing is known of what the machine does now.
    pub fn forget(&mut self) {
        self.field.doubt_all();
        self.been.clear();
        self.tool.iter_mut().for_each(|tool| tool.free = false);
    }

    /// Takes a motion: what does not cut is held against what is left, and what cuts takes its part of it.
    pub fn motion(&mut self, against: &Against<'_>) -> Taken {
        self.clear_by = f64::INFINITY;
        let spindle = &against.motion.state.spindle;
        if matches!(spindle, SpindleState::Surface { .. }) {
            // A part that turns may be anywhere.
            self.forget();
            return Taken::Nothing;
        }
        let mut others = std::mem::take(&mut self.others);
        for other in &mut others {
            for way in against.ways {
                if !self.stays_clear(other, against, way) {
                    // What it hits may give way.
                    self.field.doubt_all();
                }
            }
        }
        self.others = others;
        let Some(mut tool) = self.tool.take() else {
            // So may a tool of which nothing is known: at rapid one hits nothing that is said to be clear.
            if !against.rapid {
                self.forget();
            }
            return Taken::Nothing;
        };
        // Nothing says which tools are left-handed: one that turns the other way takes nothing away for certain.
        let cuts = !against.rapid && against.spins && matches!(spindle, SpindleState::Clockwise(_));
        for part in &mut tool.parts {
            let [before, behind] = &mut part.held.beside;
            *behind = if against.rapid { *behind } else { Beside::default() };
            *before = *behind;
        }
        let (mut clear, mut chip) = (true, None);
        for way in against.ways {
            clear &= self.way(&mut tool, against, way, cuts, &mut chip);
        }
        if let Some(chip) = &chip {
            let own = self.cuts.entry(tool.number).or_insert_with(|| ToolCut::new(tool.number));
            own.take(chip, against.motion.line);
        }
        self.tool = Some(tool);
        match chip {
            _ if !clear && !against.rapid && !against.spins => Taken::Stands,
            Some(chip) => Taken::Cut(chip),
            None => Taken::Nothing,
        }
    }

    /// Takes a way of a motion, what it takes of the stock as a chip; whether all parts stay clear that do not cut.
    fn way(
        &mut self,
        tool: &mut CuttingTool,
        against: &Against<'_>,
        way: &Way<'_>,
        cuts: bool,
        chip: &mut Option<Chip>,
    ) -> bool {
        let mounted = tool.cutter.as_ref().map(|(_, mounted)| mounted);
        let straight = mounted.and_then(|mounted| mounted.straight(way));
        // A shank no thicker than the edges goes where they have been on the same line, higher up.
        let shank = cuts && tool.parts.iter().any(|part| part.kind == PartKind::Shank);
        let turn = if straight.is_none() { Turn::of(way) } else { None };
        let again = !cuts && turn.is_some_and(|turn| self.been.covers_turn(&turn));
        // What it goes along again, or above, it has been in before.
        let been = again
            || straight
                .filter(|_| !cuts || shank)
                .is_some_and(|poses| self.been.covers(Some(&mut self.field), poses));
        let above = straight
            .filter(|_| shank)
            .is_some_and(|poses| self.been.covers_above(tool.edge, poses));
        // Straight down it comes where they have cut on the same way.
        let led = straight
            .filter(|_| shank)
            .is_some_and(|poses| self.been.leads(&mut self.field, tool.edge, poses));
        // Behind edges that go down or sideways a shank comes into what they have cut.
        let sinks = straight.is_some_and(|[from, to]| (to.tip - from.tip).dot(&from.axis) <= 0.0);
        let follows = |part: &Part| cuts && sinks && part.kind == PartKind::Shank;
        let spared = |part: &Part| match part.kind {
            PartKind::Holder => false,
            PartKind::Cutter => cuts || been,
            PartKind::Shank => been || above || led,
        };
        if against.rapid && been {
            let back = again || straight.is_some_and(|poses| self.been.is_along(poses));
            for part in tool.parts.iter_mut().filter(|part| spared(part)) {
                self.spare(&mut part.held, against, way, back);
            }
        }
        let (behind, ahead): (Vec<_>, Vec<_>) =
            tool.parts.iter_mut().filter(|part| !spared(part)).partition(|part| follows(part));
        let mut clear = true;
        let mut taken = Chip::default();
        for part in ahead {
            clear &= self.holds(part, against, way, &mut taken);
        }
        let cutter = tool.cutter.as_ref();
        match cutter.filter(|_| cuts) {
            Some((cutter, mounted)) => {
                taken += along::cut(&mut self.field, mounted, cutter, way, tool.free);
            }
            None if cuts => self.field.doubt_all(),
            None => {}
        }
        for part in behind {
            clear &= self.holds(part, against, way, &mut taken);
        }
        if cuts && cutter.is_some() {
            self.chips += taken.volume;
            *chip.get_or_insert_default() += taken;
        }
        tool.free = cuts || clear;
        // However much of it is known, the tool was there, and what was in its way is gone.
        if let Some((_, mounted)) = &tool.cutter
            && (cuts || clear && !against.rapid)
        {
            match straight {
                Some(poses) => self.been.add(poses),
                None => {
                    let ends = way.ends.map(|stance| mounted.pose(&stance.joints));
                    ends.into_iter().for_each(|pose| self.been.add([pose; 2]));
                }
            }
            if let Some(turn) = turn.filter(|_| cuts) {
                self.been.add_turn(turn);
            }
        }
        clear
    }

    /// Holds a part of the tool against what is left on a way; whether it stays clear. What a shank may take goes to `taken`: its
    /// cut is as deep as it is in the stock.
    fn holds(
        &mut self,
        part: &mut Part,
        against: &Against<'_>,
        way: &Way<'_>,
        taken: &mut Chip,
    ) -> bool {
        let clear = self.stays_clear(&mut part.held, against, way);
        if !clear {
            // What it hits may give way.
            let chip = along::cut(&mut self.field, &part.mounted, &part.body, way, false);
            if part.kind == PartKind::Shank {
                *taken += chip;
            }
        }
        clear
    }

    /// Takes a rapid on which a part of the tool goes where it has been: whether it is near behind it.
    fn spare(&mut self, held: &mut Held, against: &Against<'_>, way: &Way<'_>, back: bool) {
        let Held { watched, keep: [_, keep], yields, beside: [before, behind], .. } = held;
        let minds = *yields && *keep > 0.0;
        if !minds && !against.told {
            return;
        }
        // The nearest of the table is that of what is proven.
        let mut watched = watched.clone();
        let distances = watched.distances();
        if minds {
            *behind = *before;
            let near = watched.near_ends(&mut self.field, way, *keep, WITHIN);
            behind.rapid(near, way.ends, back);
        }
        if against.told {
            let by = match watched.along(&mut self.field, way, 0.0, WITHIN) {
                Found::Clear(by) => by,
                Found::Hits(_) | Found::Unproven(_) => 0.0,
            };
            self.clear_by = self.clear_by.min(by);
        }
        self.distances += watched.distances() - distances;
    }

    /// Holds a body against what is left on a way; whether it stays clear.
    fn stays_clear(&mut self, held: &mut Held, against: &Against<'_>, way: &Way<'_>) -> bool {
        let Held { row, watched, keep, yields, beside: [before, behind] } = held;
        let mut keep = keep[usize::from(against.rapid)];
        let (nearest, distances) = (watched.nearest(), watched.distances());
        if *yields && keep > 0.0 {
            *behind = *before;
            let near = watched.near_ends(&mut self.field, way, keep, WITHIN);
            if behind.rapid(near, way.ends, false) {
                keep = 0.0;
            }
        }
        let found = watched.along(&mut self.field, way, keep, WITHIN);
        self.distances += watched.distances() - distances;
        let row = &mut self.rows[*row];
        if watched.nearest() < nearest.min(row.nearest.0) {
            row.nearest = (watched.nearest(), against.motion.line);
        }
        let (verdict, place) = match found {
            Found::Clear(by) => {
                row.clear_by = row.clear_by.min(by);
                self.clear_by = self.clear_by.min(by);
                return true;
            }
            Found::Hits(place) => (Verdict::Hits, place),
            Found::Unproven(place) => (Verdict::Unproven, place),
        };
        let Place { joints, at_most, point } = place;
        row.faults += 1;
        self.clear_by = 0.0;
        let (point, line) = (self.seat.frame.point(point), against.motion.line);
        let fault = Fault { verdict, line, joints, at_most, keep, point };
        fault.note([&mut row.fault, &mut row.worst]);
        false
    }

    /// No body that is held against what is left came nearer to it on the last motion, mm; none where nothing was held.
    pub fn clear_by(&self) -> Option<f64> {
        Some(self.clear_by).filter(|by| by.is_finite())
    }

    /// What came of it: rows of the pairs, distances that were computed, what is left.
    pub fn finish(mut self) -> (Vec<PairRow>, u64, StockLeft) {
        self.put_down();
        let part = self.part.as_ref().map(|(part, surface)| {
            let mut compared = self.field.compare(part, surface);
            compared.deepest.point += self.low;
            compared.thickest.point += self.low;
            compared
        });
        let left = StockLeft {
            name: self.name,
            link: self.seat.link,
            placed: self.placed,
            part,
            before: self.before,
            left: self.field.volume(),
            cell: self.field.cell(),
            cuts: self.cuts.into_values().collect(),
            field: self.field,
            wanted: self.part,
            low: self.low,
        };
        (self.rows, self.distances, left)
    }
}
