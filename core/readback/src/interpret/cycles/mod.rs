//! Cycles become the motions that the control makes of them.
//!
//! | file | knows |
//! |---|---|
//! | `hole` | a hole by its levels, and its strokes |
//! | `iso` | G73 to G89 |
//! | `names` | CYCLE81 to CYCLE89, CYCLE840 |
//! | `conversational` | CYCL DEF 200 to 209, 240 |

pub(super) mod conversational;
mod hole;
mod iso;
mod names;

use nalgebra::Vector3;
use post_grammar::nc::NcValue;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::ModalGroup;
use super::block_words::BlockWords;
use super::state::{ControlState, FeedMeaning};
use crate::g_code::GCode;
use crate::{MotionKind, ProgramEvent};
use hole::{CycleHole, HoleStroke};

/// The cycle in force.
#[derive(Clone, Debug, Default)]
pub(super) struct CycleState {
    /// G73 to G89.
    iso: Option<iso::IsoCycle>,
    /// `MCALL CYCLE8x`: by name and arguments.
    modal: Option<(String, Vec<Option<f64>>)>,
    /// `CYCL DEF`, called by M99, M89 and CYCL CALL.
    pub defined: Option<DefinedCycle>,
    /// Called at every point: M89.
    pub at_each: bool,
    /// A word of motion in this block has ended G73 to G89.
    pub cut_off: bool,
}

/// A cycle that `CYCL DEF` has defined.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DefinedCycle {
    /// Number of the cycle.
    pub cycle: u32,
    /// Numbers of its parameters and their values.
    pub values: Vec<(u32, f64)>,
}

impl CycleState {
    /// Words of axes alone ask for a hole.
    #[inline]
    pub fn in_force(&self) -> bool {
        self.iso.is_some()
    }

    /// No motion ends in a hole.
    #[inline]
    pub fn are_off(&self) -> bool {
        self.iso.is_none() && self.modal.is_none() && !self.at_each
    }
}

/// A block that begins a cycle (`meaning`, by its G code or by a name), or says a further hole of the one in force (no meaning): `words` are those of the block. Marks the words that it uses in
/// `words.used`.
pub(super) fn hole(
    control: &mut ControlState,
    code: Option<GCode>,
    meaning: Option<Meaning>,
    words: &mut BlockWords,
) -> Result<(), Box<Diagnostic>> {
    iso::hole(control, code, meaning, words)
}

/// No cycle any more: G80, MCALL alone, or a motion word.
pub(super) fn end(control: &mut ControlState) {
    control.cycles.iso = None;
    control.cycles.modal = None;
}

/// A cycle of this name is made here.
pub(super) fn known(name: &str) -> bool {
    names::known(name)
}

/// `CYCLE81(…)`: called where the tool stands, or in force after each motion where `modal` (MCALL).
pub(super) fn call(
    control: &mut ControlState,
    name: &str,
    _meaning: Meaning,
    arguments: &[Option<NcValue>],
    modal: bool,
) -> Result<(), Box<Diagnostic>> {
    let mut values = Vec::with_capacity(arguments.len());
    for argument in arguments {
        values.push(match argument {
            Some(value) => Some(
                control
                    .variables
                    .worth(value)
                    .map_err(|finding| control.placed(*finding).boxed())?,
            ),
            None => None,
        });
    }
    if !known(name) {
        return Err(control.refuse(
            "nc-cycle",
            format!("{name} is no drilling cycle that is known here: what it moves is not known"),
        ));
    }
    if modal {
        // What is wrong with it is said where it stands.
        names_hole(control, name, &values)?;
        control.cycles.modal = Some((name.to_owned(), values));
        return Ok(());
    }
    let hole = names_hole(control, name, &values)?;
    drill(control, &hole)
}

fn names_hole(
    control: &ControlState,
    name: &str,
    values: &[Option<f64>],
) -> Result<CycleHole, Box<Diagnostic>> {
    let around = names::CycleContext {
        unit: control.modal.unit,
        feed: feed_a_minute(control),
        speed: control.modal.speed,
    };
    names::hole(name, values, &around).map_err(|finding| control.placed(*finding).boxed())
}

/// A motion block has come to its end: a cycle that is called at each point (MCALL, M89) is run there.
#[inline]
pub(super) fn at_point(control: &mut ControlState) -> Result<(), Box<Diagnostic>> {
    if control.cycles.modal.is_none() && !control.cycles.at_each {
        return Ok(());
    }
    if let Some((name, values)) = control.cycles.modal.clone() {
        let hole = names_hole(control, &name, &values)?;
        return drill(control, &hole);
    }
    if control.cycles.at_each {
        return defined(control);
    }
    Ok(())
}

/// The cycle that `CYCL DEF` has defined, where the tool stands.
pub(super) fn defined(control: &mut ControlState) -> Result<(), Box<Diagnostic>> {
    let Some(DefinedCycle { cycle, values }) = control.cycles.defined.clone() else {
        return Err(control.refuse("nc-cycle", "a cycle is called, and none is defined"));
    };
    if control.modal.feed_mode == FeedMeaning::PerRevolution {
        let message = "a cycle under M136: how fast it drills is not known";
        return Err(control.refuse("nc-cycle", message));
    }
    let parameters = conversational::Parameters {
        cycle,
        values: &values,
        unit: control.modal.unit,
        feed_unit: super::conversational::feed_unit(control),
        speed: control.modal.speed,
    };
    let hole =
        conversational::hole(&parameters).map_err(|finding| control.placed(*finding).boxed())?;
    match hole {
        Some(hole) => drill(control, &hole),
        None => Ok(()),
    }
}

/// The feed in force, mm/min; zero where the program states none.
fn feed_a_minute(control: &ControlState) -> f64 {
    let feed = control.modal.feed.unwrap_or(0.0);
    match control.modal.feed_mode {
        FeedMeaning::PerRevolution => feed * control.modal.speed,
        FeedMeaning::PerMinute | FeedMeaning::Inverse => feed,
    }
}

/// Makes a hole where the tool stands.
fn drill(control: &mut ControlState, hole: &CycleHole) -> Result<(), Box<Diagnostic>> {
    if control.modal.feed_mode == FeedMeaning::Inverse && !hole.own_feed {
        return Err(control.refuse(
            "nc-cycle",
            "a cycle under inverse-time feed: how fast it drills is not known",
        ));
    }
    if control.state.compensation != 0 {
        return Err(control.refuse("nc-cycle", "a cycle under radius compensation"));
    }
    control.relies_on(ModalGroup::Plane);
    control.relies_on(ModalGroup::Feed);
    let axis = control.modal.plane.coordinates()[2];
    control.says_depth(axis);
    let from = control.point();
    let strokes = hole.strokes(from[axis]).map_err(|finding| control.placed(*finding).boxed())?;
    let [in_it, behind] = hole.turning.map_or([None; 2], |turning| turning.map(Some));
    if let Some(turning) = in_it {
        control.turn_spindle(turning);
    }
    control.tell(ProgramEvent::Cycle(hole.call()));
    let before = (control.modal.feed, control.modal.feed_mode, control.hole);
    control.modal.feed_mode = FeedMeaning::PerMinute;
    control.hole = true;
    let made = strokes.iter().try_for_each(|stroke| made(control, stroke));
    (control.modal.feed, control.modal.feed_mode, control.hole) = before;
    control.tell(ProgramEvent::CycleEnd);
    if let Some(turning) = behind {
        control.turn_spindle(turning);
    }
    made
}

fn made(control: &mut ControlState, stroke: &HoleStroke) -> Result<(), Box<Diagnostic>> {
    let [first, second, axis] = control.modal.plane.coordinates();
    let mut to: Vector3<f64> = control.point();
    let kind = match *stroke {
        HoleStroke::Rapid(level) => {
            to[axis] = level;
            MotionKind::Rapid
        }
        HoleStroke::Feed(level, feed) => {
            to[axis] = level;
            control.modal.feed = (feed > 0.0).then_some(feed);
            MotionKind::Feed
        }
        HoleStroke::Thread(level, feed) => {
            to[axis] = level;
            // Of a thread the feed is its pitch.
            let speed = control.modal.speed;
            control.modal.feed = (feed > 0.0 && speed > 0.0).then(|| feed / speed);
            MotionKind::Thread
        }
        HoleStroke::Aside([x, y, z]) => {
            to[first] += x;
            to[second] += y;
            to[axis] += z;
            MotionKind::Rapid
        }
        HoleStroke::Wait(wait) => {
            control.tell(ProgramEvent::Dwell { time: wait.time, revolutions: wait.revolutions });
            return Ok(());
        }
        HoleStroke::Stop => {
            control.tell(ProgramEvent::Stop);
            return Ok(());
        }
    };
    control.straight(kind, to)
}
