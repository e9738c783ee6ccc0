//! A stock along the ways of a machine: what a cutter removes of it, and what stays clear of what is left.

use nalgebra::Vector3;
use post_clearance::ALLOWANCE;
use post_clearance::convex::Convex;
use post_clearance::distance::Apart;
use post_clearance::pair::View;
use post_clearance::piece::{Piece, Way};
use post_clearance::placement::Placement;
use post_machine::kinematics::{Joint, Joints};
use post_motion::path::{Curve, turns};

use crate::been::{goes_alone, lean};
use crate::chip::Chip;
use crate::field::{Around, Cutter, Field, Strays};
use crate::profile::{ToolPose, swept_ahead};

/// Pieces of a way that a body is looked at on; what is not proven then is not.
const MOST_PIECES: u64 = 1 << 11;

/// Pieces of a cut; of what is longer nothing is known any more for certain.
const MOST_STEPS: u64 = 1 << 17;

/// The same where each axis goes for itself, as at rapid, and a box of axis values is gone through.
const MOST_STEPS_APART: u64 = 1 << 11;

/// What a body sweeps is looked at at once on ways no longer than so many times its radius.
const LONGEST: f64 = 4.0;

/// The nearest approach is known to this share of it: on a line, and in a box that axes span which go for themselves.
const CLOSE: [f64; 2] = [0.8, 0.5];

/// Where a field is on a machine.
#[derive(Clone, Copy, Debug)]
pub struct Seat {
    /// The link that it hangs on: 0 carries the part, n is what follows the nth axis of the chain.
    pub link: usize,
    /// From its frame to that of the machine, all axes at zero.
    pub frame: Placement,
}

/// A body on one link of a machine, and a field on another.
#[derive(Clone, Debug)]
pub struct Mounted {
    /// The frame of the field on its link.
    field: Placement,
    /// The field hangs on the part: poses of the part frame go as they do in its own.
    on_part: bool,
    view: View,
    /// Where it begins, mm, and along which unit vector it goes on, machine frame, all axes at zero.
    at_zero: ToolPose,
}

impl Mounted {
    /// A body on a link of its own, all of it within `radius` of `centre`, mm, machine frame, all axes at zero.
    pub fn on_link(
        (axes, link): (&[Joint], usize),
        field: &Seat,
        (centre, radius): (Vector3<f64>, f64),
    ) -> Self {
        let view = View::new(axes, field.link, link, centre, radius);
        let at_zero = ToolPose { tip: centre, axis: Vector3::z() };
        Self { field: field.frame, on_part: field.link == 0, view, at_zero }
    }

    /// A body of revolution on the last link that begins at `at_zero`, all of it within `radius` of `centre`, mm, machine
    /// frame, all axes at zero.
    pub fn new(
        axes: &[Joint],
        field: &Seat,
        at_zero: ToolPose,
        sphere: (Vector3<f64>, f64),
    ) -> Self {
        Self { at_zero, ..Self::on_link((axes, axes.len()), field, sphere) }
    }

    /// Where its link stands in the frame of the field.
    fn placement(&self, joints: &Joints) -> Placement {
        let at = self.view.placement(joints);
        Placement {
            rotation: self.field.rotation.transpose() * at.rotation,
            shift: self.field.back(at.shift),
        }
    }

    /// Where it stands, frame of the field.
    pub fn pose(&self, joints: &Joints) -> ToolPose {
        let at = self.placement(joints);
        ToolPose { tip: at.point(self.at_zero.tip), axis: at.direction(self.at_zero.axis) }
    }

    /// Both ends of a way that is straight and on which it does not turn.
    pub fn straight(&self, way: &Way<'_>) -> Option<[ToolPose; 2]> {
        let ends = way.ends.map(|stance| stance.joints);
        let bends = turns(way.solver.chain(), way.ends) || way.interpolation.is_curved();
        let strays = bends || (way.independent && !goes_alone(&ends[0], &ends[1]));
        (!strays).then(|| ends.each_ref().map(|joints| self.pose(joints)))
    }

    /// How far it goes aside and along its axis on a way on which it does not turn, mm, no less than all of it.
    fn goes(&self, way: &Way<'_>) -> Option<[f64; 2]> {
        if let Some([from, to]) = self.straight(way) {
            let gone = to.tip - from.tip;
            let along = libm::fabs(gone.dot(&from.axis));
            let stray = if way.independent { lean(gone.norm()) } else { 0.0 };
            return Some([(gone - from.axis * gone.dot(&from.axis)).norm() + stray, along + stray]);
        }
        if !self.slides(way) {
            return None;
        }
        let tips = way.ends.map(|stance| stance.pose.tip);
        let axis = way.ends[0].pose.axis;
        // Of a spline it is known to a thousandth.
        let length = 1.002 * way.interpolation.curve().length(tips);
        let rise = libm::fabs((tips[1] - tips[0]).dot(&axis));
        Some([length, if self.is_level(way) { rise } else { length }])
    }

    /// All of it goes as its tip does in the part frame.
    fn slides(&self, way: &Way<'_>) -> bool {
        self.on_part && !way.independent && !turns(way.solver.chain(), way.ends)
    }

    /// It goes so, and on an arc about its own axis.
    fn is_level(&self, way: &Way<'_>) -> bool {
        let axis = way.ends[0].pose.axis;
        let about = |normal: &Vector3<f64>| normal.cross(&axis).norm() < 1e-9;
        let curve = way.interpolation.curve();
        self.slides(way) && matches!(curve, Curve::Arc { normal, .. } if about(normal))
    }

    /// No point of it is farther from where it is at the `middle` of a piece, mm, anywhere on the piece.
    fn reach(&self, middle: &Joints, piece: &Piece) -> f64 {
        let by_levers = || self.view.reach_by_levers(middle, &self.view.levers(middle), piece);
        match piece.independent {
            true => by_levers(),
            false => self.view.reach(middle, piece).min(by_levers()),
        }
    }
}

/// What a cutter removes of a field along a way, at feed: how much, and how far it goes into it. Where it is not known how
/// the axes go nothing is removed for certain but at the ends, and nothing is left for certain. `free`: there is nothing left
/// in the cutter where the way begins, as where it has come cutting.
pub fn cut(field: &mut Field, tool: &Mounted, cutter: &Cutter, way: &Way<'_>, free: bool) -> Chip {
    let mut taken = cut_along(field, tool, cutter, way);
    if let Some(goes) = tool.goes(way).filter(|_| free) {
        let depth = taken.engagement.map_or(f64::INFINITY, |engagement| engagement.depth.at_most);
        taken.no_more_than(swept_ahead(&cutter.outer, depth, goes));
    }
    taken
}

fn cut_along(field: &mut Field, tool: &Mounted, cutter: &Cutter, way: &Way<'_>) -> Chip {
    if let Some(poses) = tool.straight(way) {
        let stray = if way.independent { lean((poses[1].tip - poses[0].tip).norm()) } else { 0.0 };
        return field.cut_straight(cutter, poses, stray);
    }
    let pose = |joints: &Joints| tool.pose(joints);
    let mut taken = Chip::default();
    field.in_pieces(true);
    let ends = way.ends.map(|stance| pose(&stance.joints));
    for end in &ends {
        // Between the ends of a curve leads no way that anything could be across.
        let goes = if way.interpolation.is_curved() { [*end; 2] } else { ends };
        taken += field.cut_standing(cutter, goes, end, None);
    }
    // On an arc about the tool axis the tip goes evenly from the height of one end to that of the other.
    let level = tool.is_level(way);
    let highest = level.then(|| {
        let [from, to] = ends.map(|end| ends[0].axis.dot(&end.tip));
        from.max(to)
    });
    let step = field.cell().max();
    let most = if way.independent { MOST_STEPS_APART } else { MOST_STEPS };
    let mut waiting: Vec<Piece> = way.whole().into_iter().collect();
    let mut lost = waiting.is_empty();
    let (mut count, mut before) = (0, None);
    while let Some(piece) = waiting.pop() {
        count += 1;
        let Some(at) = way.middle(&piece) else {
            lost = true;
            continue;
        };
        let reach = tool.reach(&at, &piece);
        let fine = reach <= step;
        let halves = match fine || count > most {
            true => None,
            false => piece.halves(way, &at, tool.view.widest(&piece).map_or(0, |(axis, _)| axis)),
        };
        if let Some([first, last]) = halves {
            waiting.extend([last, first]);
            continue;
        }
        let (ends, middle) = (piece.ends.each_ref().map(pose), pose(&at));
        let around = Around { pose: middle, by: reach, up: 0.0 };
        let turning = piece.independent || tool.view.turns(&piece);
        // Without a turn what strays from the line between its ends is told.
        let heights = match turning {
            true => [middle.axis.dot(&middle.tip); 2],
            false => ends.map(|end| middle.axis.dot(&end.tip)),
        };
        let aside = if turning { reach } else { piece.stray };
        let tips = [heights[0].min(heights[1]) - aside, heights[0].max(heights[1]) + aside];
        let strays = fine.then_some(Strays { around, before, tips, aside, highest });
        taken += field.cut_standing(cutter, ends, &middle, strays);
        (lost, before) = (lost || !fine, Some(around).filter(|_| fine));
    }
    field.in_pieces(false);
    if lost {
        taken.volume.at_most = taken.volume.at_most.max(field.volume().at_most);
        taken.engagement = None;
        field.doubt_all();
    }
    taken
}

/// What is known of a body and a field on a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// It stays clear of what may be left by no less than this, mm.
    Clear(f64),
    /// It is in what is left for certain.
    Hits(Place),
    /// It comes nearer to what may be left than is to be kept, or that is not known.
    Unproven(Place),
}

/// Where a body stands that is not clear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Axis values, mm and radians.
    pub joints: Joints,
    /// It is no farther from what may be left, mm; infinite where that is not known.
    pub at_most: f64,
    /// The place in what may be left, mm, frame of the field.
    pub point: Vector3<f64>,
}

/// A body that is to stay clear of what is left.
#[derive(Clone, Debug)]
pub struct Watched {
    mounted: Mounted,
    /// Of a body of revolution: what certainly belongs to it.
    profile: Option<Vec<[f64; 2]>>,
    /// Its pieces, machine frame, all axes at zero.
    pieces: Vec<Convex>,
    known: Option<Known>,
    /// The nearest that was found of what may be left, mm.
    nearest: f64,
    distances: u64,
}

/// A distance at a pose. What is left gets less, so that it holds for all that follows.
#[derive(Clone, Copy, Debug)]
struct Known {
    joints: Joints,
    levers: Joints,
    at_least: f64,
}

impl Watched {
    /// A body of revolution between an inner and an outer outline, points [z, r] in mm, z from where it begins.
    pub fn new(mounted: Mounted, inner: Vec<[f64; 2]>, outer: &[[f64; 2]]) -> Self {
        let ToolPose { tip, axis } = mounted.at_zero;
        let pieces = post_clearance::shape::turned_pieces(outer, tip, axis);
        Self { profile: Some(inner), ..Self::of_pieces(mounted, pieces) }
    }

    /// A body of convex pieces, machine frame, all axes at zero.
    pub fn of_pieces(mounted: Mounted, pieces: Vec<Convex>) -> Self {
        let profile = None;
        Self { mounted, profile, pieces, known: None, nearest: f64::INFINITY, distances: 0 }
    }

    /// The nearest that was found of what may be left, mm.
    pub fn nearest(&self) -> f64 {
        self.nearest
    }

    /// Distances that were computed.
    pub fn distances(&self) -> u64 {
        self.distances
    }

    /// It is not known how it comes to where the next way begins.
    pub fn forget(&mut self) {
        self.known = None;
    }

    /// Whether it is nearer to what is left than `keep`, mm, where a way begins and where it ends; what cannot be told from that
    /// by `within` counts as nearer.
    pub fn near_ends(
        &mut self,
        field: &mut Field,
        way: &Way<'_>,
        keep: f64,
        within: f64,
    ) -> [bool; 2] {
        let far = keep + within;
        if way.whole().is_some_and(|whole| self.left(&whole, far, within).is_some()) {
            return [false; 2];
        }
        let ends = way.ends.map(|stance| self.mounted.placement(&stance.joints));
        ends.map(|at| self.apart(field, &at, &[]).at_least < far)
    }

    /// Whether it keeps a distance from what is left all along a way, mm. What cannot be told from one that is too short by
    /// less than `within` counts as one.
    pub fn along(&mut self, field: &mut Field, way: &Way<'_>, keep: f64, within: f64) -> Found {
        let keep = keep.max(ALLOWANCE);
        let Some(whole) = way.whole() else {
            let joints = way.ends[0].joints;
            return self.refuse(Place { joints, at_most: f64::INFINITY, point: Vector3::zeros() });
        };
        let mut waiting = vec![whole];
        let mut clear_by = f64::INFINITY;
        let mut computed = 0;
        while let Some(piece) = waiting.pop() {
            if let Some(left) = self.left(&piece, keep, within) {
                clear_by = clear_by.min(left);
                continue;
            }
            computed += 1;
            let Some(joints) = way.middle(&piece) else {
                let [joints, _] = piece.ends;
                let point = Vector3::zeros();
                return self.refuse(Place { joints, at_most: f64::INFINITY, point });
            };
            if let Some(left) = self.swept(field, &piece, keep) {
                clear_by = clear_by.min(left);
                continue;
            }
            let at = self.mounted.placement(&joints);
            let apart = self.apart(field, &at, &[]);
            let place = Place { joints, at_most: apart.at_most, point: apart.points[1] };
            if apart.at_most < keep {
                // Whether axes that go for themselves come by there hangs on how fast each of them is.
                let common = (!piece.independent).then(|| match &self.profile {
                    Some(profile) => field.common(profile, &self.mounted.pose(&joints)),
                    None => {
                        let pieces: Vec<_> =
                            self.pieces.iter().map(|piece| piece.placed(&at)).collect();
                        field.common_of(&pieces)
                    }
                });
                return match common.flatten() {
                    Some(point) => {
                        self.known = None;
                        Found::Hits(Place { at_most: 0.0, point, ..place })
                    }
                    None => self.refuse(place),
                };
            }
            let view = &self.mounted.view;
            self.known =
                Some(Known { joints, levers: view.levers(&joints), at_least: apart.at_least });
            if let Some(left) = self.left(&piece, keep, within) {
                clear_by = clear_by.min(left);
                continue;
            }
            let reach = self.mounted.reach(&joints, &piece);
            let widest = view.widest(&piece).map_or(0, |(axis, _)| axis);
            let halves = match reach <= within || computed > MOST_PIECES {
                true => None,
                false => piece.halves(way, &joints, widest),
            };
            match halves {
                Some([first, last]) => waiting.extend([last, first]),
                None if apart.at_least - reach >= keep => {
                    clear_by = clear_by.min(apart.at_least - reach);
                }
                None => return self.refuse(place),
            }
        }
        Found::Clear(clear_by)
    }

    /// How far it is from what may be left where it stands, or all along `ways` from there, mm, frame of the field.
    fn apart(&mut self, field: &mut Field, at: &Placement, ways: &[Vector3<f64>]) -> Apart {
        self.distances += 1;
        let placed = self.pieces.iter().map(|piece| match ways.is_empty() {
            true => piece.placed(at),
            false => piece.placed(at).swept(ways),
        });
        let apart = field.apart(&placed.collect::<Vec<_>>());
        self.nearest = self.nearest.min(apart.at_most);
        apart
    }

    /// How far it is from what may be left on all of a piece on which it goes straight and does not turn, mm, if that is no less
    /// than is to be kept: by all that it sweeps. What is long is not looked at at once.
    fn swept(&mut self, field: &mut Field, piece: &Piece, keep: f64) -> Option<f64> {
        let view = &self.mounted.view;
        if piece.stray > 0.0 || view.turns(piece) {
            return None;
        }
        let [from, to] = piece.ends;
        let at = self.mounted.placement(&from);
        let ways: Vec<Vector3<f64>> = match piece.independent {
            true => {
                view.slides(piece).map(|way| self.mounted.field.rotation.tr_mul(&way)).collect()
            }
            false => vec![self.mounted.placement(&to).shift - at.shift],
        };
        if ways.iter().map(Vector3::norm).sum::<f64>() > LONGEST * view.radius() {
            return None;
        }
        let left = self.apart(field, &at, &ways).at_least;
        (left >= keep).then(|| {
            let levers = self.mounted.view.levers(&to);
            self.known = Some(Known { joints: to, levers, at_least: left });
            left
        })
    }

    fn refuse(&mut self, place: Place) -> Found {
        self.known = None;
        Found::Unproven(place)
    }

    /// What is left of the distance that is known, mm, if it is enough.
    fn left(&self, piece: &Piece, keep: f64, within: f64) -> Option<f64> {
        let known = self.known.as_ref()?;
        let view = &self.mounted.view;
        let close = CLOSE[usize::from(piece.independent)];
        let least = keep.max(close * self.nearest - within);
        let mut reach = view.reach_by_levers(&known.joints, &known.levers, piece);
        if known.at_least - reach < least && !piece.independent {
            reach = reach.min(view.reach(&known.joints, piece));
        }
        let left = known.at_least - reach;
        (left >= least).then_some(left)
    }
}
