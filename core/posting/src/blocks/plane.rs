//! Tilted planes of the control: while the rotary axes stand, the words are those of a plane that is turned with them.

use std::rc::Rc;

use nalgebra::{Matrix3, Vector3};
use post_machine::axis_words::{self, WordValues};
use post_machine::description::Tcp;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_machine::kinematics::batch::vector;
use post_machine::kinematics::orientation::angle;
use post_machine::tilted_plane::TiltedPlane;
use post_plugin::Format;

use super::{BlockNote, BlockSink, BlockStage, TURN};
use crate::accuracy::{PathNode, Placer, RunColumns};
use crate::configuration::{ChosenPoint, pose};
use crate::program::MoveFeed;

/// A place so near to the middle between two printed values may stand at either, in last decimals.
const BETWEEN: f64 = 0.1;

/// A step of more last decimals is none that [`BlockStage::steady`] undoes.
const LITTLE: f64 = 1.5;

/// The plane in force.
#[derive(Debug)]
pub(super) struct ActivePlane {
    format: Format,
    /// What solves points outside.
    outside: Option<Rc<Placer>>,
    /// Origin of the planes that are wanted here, mm, part frame.
    wanted: Option<Vector3<f64>>,
    /// Where the rotary axes stand in the present one, or where none is needed, as printed.
    stands: Option<Joints>,
    /// Axes of the plane that was printed, as columns, part frame, while one is in force.
    axes: Option<Matrix3<f64>>,
}

impl ActivePlane {
    pub(super) fn new(format: &Format) -> Self {
        Self { format: format.clone(), outside: None, wanted: None, stands: None, axes: None }
    }

    /// No plane is in force, and none is wanted.
    pub(super) fn are_off(&self) -> bool {
        self.wanted.is_none() && self.stands.is_none() && self.axes.is_none()
    }

    /// The rotary values of a point: in a plane those of the plane. What the choice held or turned early close to a pole
    /// does not count there, for the tool stands upright on the plane.
    #[inline]
    pub(super) fn standing<'j>(&'j self, chosen: &'j ChosenPoint) -> &'j Joints {
        match &self.stands {
            Some(stands) if self.stays(stands, chosen) => stands,
            _ => &chosen.joints,
        }
    }

    /// The rotary values of a point behind [`BlockStage::enter_plane`]: upright on its plane, also where it is the first
    /// one and what the choice held leans.
    #[inline]
    pub(super) fn entered<'j>(&'j self, chosen: &'j ChosenPoint) -> &'j Joints {
        self.stands.as_ref().unwrap_or(&chosen.joints)
    }

    /// Another branch or another full turn of the axes is another plane. A cut goes on in the one that it began in, in which
    /// the tool points as well, wherever the choice would go over to a branch that is near.
    #[inline]
    fn stays(&self, stands: &Joints, chosen: &ChosenPoint) -> bool {
        let alike = |placer: &Rc<Placer>| {
            let joints = placer.solver().chain().joints().iter().enumerate();
            joints
                .filter(|(_, joint)| joint.rotary)
                .all(|(place, _)| (stands[place] - chosen.joints[place]).abs() <= TURN)
        };
        let cuts = chosen.motion.pace != MoveFeed::Rapid;
        !chosen.changed || cuts || self.outside.as_ref().is_some_and(alike)
    }
}

impl BlockStage<'_> {
    /// Another placer comes; the tool leaves a plane with the one that it is in it with.
    pub(super) fn take_placer(&mut self, line: u64, placer: &Rc<Placer>, out: &mut BlockSink<'_>) {
        self.planes.outside = Some(Rc::clone(placer));
        if self.planes.axes.is_none() {
            self.use_placer(line, Rc::clone(placer), out);
        }
        self.planes.stands = None;
    }

    /// The tool axis stays from here on, or does not any more. It is reported where its plane begins.
    pub(super) fn fix_axis(
        &mut self,
        line: u64,
        wanted: Option<Vector3<f64>>,
        out: &mut BlockSink<'_>,
    ) {
        self.depart(line, out);
        self.leave_plane(line, out);
        self.planes.wanted = wanted;
    }

    /// No plane is in force any more; the tool has left the part.
    fn leave_plane(&mut self, line: u64, out: &mut BlockSink<'_>) {
        self.planes.stands = None;
        if let Some(outside) = self.planes.outside.clone() {
            self.use_placer(line, outside, out);
        }
        if self.planes.axes.take().is_some() {
            out.note(line, BlockNote::Plane(None));
        }
    }

    /// The plane that a point lies in, if planes are wanted: the present one, or the tool leaves the part and comes back in
    /// another.
    #[inline]
    pub(super) fn enter_plane(&mut self, chosen: &ChosenPoint, out: &mut BlockSink<'_>) {
        if let Some(origin) = self.planes.wanted {
            let planes = &self.planes;
            let stays = self.last.is_some()
                && (planes.stands.as_ref()).is_some_and(|stands| planes.stays(stands, chosen));
            if !stays {
                self.placed.forget();
                self.change_plane(chosen, origin, out);
            }
            if chosen.rewind.is_some() {
                self.findings.at(chosen.line, turns_in_plane());
            }
        }
    }

    fn change_plane(
        &mut self,
        chosen: &ChosenPoint,
        origin: Vector3<f64>,
        out: &mut BlockSink<'_>,
    ) {
        let line = chosen.line;
        self.end_run(out);
        self.depart(line, out);
        self.leave_plane(line, out);
        let Some(outside) = self.planes.outside.clone() else {
            return;
        };
        // Upright, whatever the choice held close to a pole.
        let Ok(node) = outside.place(pose(&chosen.motion), 1.0, &chosen.joints) else {
            return;
        };
        let stands = node.trace.joints;
        self.planes.stands = Some(stands);
        let machine = self.machine;
        let turned = machine
            .axes
            .iter()
            .zip(&stands)
            .any(|(axis, value)| axis.joint.rotary && axis.reading(*value).abs() > 1e-9);
        let order = axis_words::order(machine);
        let x = order.into_iter().find(|joint| machine.axes[*joint].word() == "X");
        // Upright under tool centre point control there is a plane too: a control has its cycles and its radius
        // compensation there.
        let told = turned || machine.control.tcp == Tcp::Control;
        let (Some(x), true) = (x, told) else {
            return;
        };
        let chain = outside.solver().chain();
        let plane = TiltedPlane::of(chain, &stands, x, origin, &self.planes.format);
        // Angles with few decimals would lean the tool.
        if angle(plane.normal(), chosen.motion.axis) > machine.accuracy.axis_tolerance {
            return;
        }
        let Some(inside) = outside.in_plane(plane) else {
            return;
        };
        self.use_placer(line, Rc::new(inside), out);
        self.planes.axes = Some(plane.axes);
        out.note(line, BlockNote::Plane(Some(Box::new(plane))));
    }

    /// A coordinate that is constant in the plane is turned into it with the noise of the CL file's digits: where the place of
    /// `node` is about between two printed values, it stays at that of `last`. What that puts it off is certified as all
    /// rounding is.
    pub(super) fn steady(&self, placer: &Placer, last: &PathNode, node: &mut PathNode) {
        let Some(axes) = self.planes.axes else {
            return;
        };
        let Some(shift) = steadying(placer, &axes, [&last.words, &node.words], node.off()) else {
            return;
        };
        let mut steadied = *node;
        if placer.resettle(&mut steadied, node.tip + axes * shift).is_ok() {
            *node = steadied;
        }
    }

    /// Rotary values of a run are those of the plane that it lies in: [`ActivePlane::standing`] of each point. False where
    /// the tool does not stand in the plane that is wanted.
    pub(super) fn stands_in_plane(&self, run: &mut RunColumns, placer: &Placer) -> bool {
        let Some(stands) = &self.planes.stands else {
            return self.planes.are_off();
        };
        for (place, joint) in placer.solver().chain().joints().iter().enumerate() {
            if joint.rotary {
                run.at.joints[place].fill(stands[place]);
            }
        }
        true
    }

    /// [`Self::steady`] of each point of a run.
    pub(super) fn steady_run(&self, run: &mut RunColumns, placer: &Placer) {
        let Some(axes) = self.planes.axes else {
            return;
        };
        for lane in 0..run.count {
            if !placer.creeps(&run.words, lane, LITTLE * placer.last_decimal()) {
                continue;
            }
            let words = [&run.words_before(lane), &run.words_at(lane)];
            let off = vector(&run.reached_tip, lane + 1) - vector(&run.tip, lane + 1);
            let Some(shift) = steadying(placer, &axes, words, off) else {
                continue;
            };
            let mut node = run.node(placer, lane + 1);
            let place = node.tip + axes * shift;
            if placer.resettle(&mut node, place).is_ok() {
                run.replace(lane, &node);
            }
        }
    }

    /// The words are those of a tilted plane.
    pub(super) fn in_plane(&self) -> bool {
        self.planes.axes.is_some()
    }

    /// Normal of the plane of the words, unit vector, part frame; none outside a plane.
    pub(super) fn plane_normal(&self) -> Option<Vector3<f64>> {
        self.planes.axes.map(|axes| axes.column(2).into_owned())
    }
}

/// How a place is moved in the plane of `axes` so that coordinates stay at the printed values before it; `words` are those
/// before and its own, `off` is how far it is off its target, mm, part frame. None if it stays where it is.
fn steadying(
    placer: &Placer,
    axes: &Matrix3<f64>,
    words: [&WordValues; 2],
    off: Vector3<f64>,
) -> Option<Vector3<f64>> {
    let [before, printed] = words.map(|words| placer.printed_words(words));
    let step = before? - printed?;
    let off = axes.transpose() * off;
    let largest = placer.last_decimal() * (1.0 + BETWEEN);
    let mut shift = Vector3::zeros();
    for axis in 0..3 {
        let far = libm::fabs(step[axis]);
        let kept = libm::fabs(step[axis] + off[axis]);
        if far > 0.0 && far <= largest && kept <= (0.5 + BETWEEN) * far {
            shift[axis] = step[axis];
        }
    }
    (shift != Vector3::zeros()).then_some(shift)
}

/// A rewind in a plane: its turn would take the plane with it.
fn turns_in_plane() -> Diagnostic {
    Diagnostic::error(
        "plane",
        "in a tilted plane the axes would have to be turned to another solution within a cut",
    )
    .help("[control] planes = false, or --mount")
}
