//! What stays in force from record to record, by what it is about.

use post_grammar::CutterSide;
use post_plugin::SpindleSense;

use super::{CutterDescription, ModalFeed};
use crate::program::DrillCycle;

/// The cycle that the file has in force.
#[derive(Debug, Default)]
pub(super) struct FileCycles {
    pub in_force: Option<(DrillCycle, ModalFeed)>,
    /// The last that was in force, for `CYCLE/ON`.
    pub last: Option<(DrillCycle, ModalFeed)>,
    /// A cycle was refused: the points that it acts at are no moves.
    pub lost: bool,
}

/// What the file says of tools and cutters.
#[derive(Debug, Default)]
pub(super) struct FileTools {
    /// Number, register and length (as written) of the tool in the spindle.
    pub loaded: Option<(u32, u32, Option<f64>)>,
    /// The file loads tools itself.
    pub file_loads: bool,
    /// Some move was read since the last tool was loaded.
    pub moved: bool,
    pub name: String,
    pub diameter: Option<f64>,
    /// The cutters described so far, in the order of the numbers of their tools, and the tool that is to be loaded for the
    /// last; for files whose tools are numbered here.
    pub cutters: Vec<CutterDescription>,
    pub due: Option<u32>,
    /// The cutter described last.
    pub described: Option<CutterDescription>,
    /// A further cutter was described, and no tool was loaded for it.
    pub cutter_changed: bool,
    /// Diameter and corner radius of the cutter described since the last tool was loaded, mm.
    pub cutter: [Option<f64>; 2],
    pub cutter_length: Option<f64>,
    /// The cutter described last is one for threads (`TLDATA/THREAD`).
    pub threads: bool,
}

/// What the file says of the spindle.
#[derive(Debug)]
pub(super) struct FileSpindle {
    pub rpm: Option<f64>,
    /// The constant cutting speed, m/min, and the revolutions a minute that it must not exceed.
    pub surface_speed: Option<(f64, Option<f64>)>,
    pub sense: SpindleSense,
    /// The spindle turns, need not turn, or that it does not was said.
    pub may_cut: bool,
    /// The file said what the spindle does since the tool came.
    pub said: bool,
}

/// What the file says of cutter compensation.
#[derive(Debug, Default)]
pub(super) struct FileCompensation {
    pub side: Option<CutterSide>,
    /// It is in force, and its register.
    pub on: bool,
    pub register: Option<u32>,
    /// Whether it was reported what becomes of `CUTCOM` on points of the tool's centre.
    pub told_on_centre: bool,
}
