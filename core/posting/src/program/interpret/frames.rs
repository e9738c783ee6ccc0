//! Units and frames that points and axes of the file are in.

use nalgebra::Vector3;
use post_grammar::{Record, Rotate, Units};

use super::{ClInterpreter, StepSink};
use crate::program::limits::direction;
use crate::program::{Command, PlaneStep, ProgramStep};

impl ClInterpreter {
    pub(super) fn set_units(&mut self, record: &Record<'_>, units: Units) {
        let scale = millimetres(self.reading.units.unwrap_or(units));
        if scale != self.scale && self.measured {
            self.fault(
                record,
                "units",
                "UNITS comes after points or feeds that were read in other units".to_owned(),
                "put it before them, or say --units",
            );
        }
        self.units = Some(units);
        self.scale = scale;
    }

    /// The frame of an operation: only that of the part is understood.
    pub(super) fn mcs(&mut self, record: &Record<'_>, axes: &[[f64; 3]; 3], origin: &[f64; 3]) {
        let own = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        if *axes != own || *origin != [0.0; 3] {
            self.fault(
                record,
                "mcs",
                "MCS is a frame of its own: whether the points behind it are meant in it, nobody here knows".to_owned(),
                "let the CAM system write the tool axis with each point (MULTAX/ON), in the frame of the part",
            );
        }
    }

    /// Takes points and axes into the frame with this origin; `axes` are its X and Y.
    pub(super) fn msys(&mut self, record: &Record<'_>, origin: [f64; 3], axes: [[f64; 3]; 2]) {
        let Some(origin) = self.point(record, origin) else {
            return;
        };
        let [x, y] = axes.map(Vector3::from);
        if let Err(message) = self.frame.set_msys(origin, x, y) {
            self.fault(record, "msys", message.to_owned(), "");
        }
    }

    /// Turns the part about an index axis: a new frame begins.
    pub(super) fn rotate(&mut self, record: &Record<'_>, rotate: &Rotate, emit: &mut StepSink<'_>) {
        if self.frame.sits_turned() {
            self.fault(
                record,
                "rotabl",
                "the angles of this index move are those of a part that is not turned, and here it sits turned about its Z"
                    .to_owned(),
                "leave out --turn and [workpiece] turn for this file",
            );
            return;
        }
        let (axis, angle) = match self.frame.rotate(rotate) {
            Ok(turned) => turned,
            Err(message) => {
                let help = "write ROTABL/AAXIS,…, BAXIS or CAXIS";
                self.fault(record, "rotabl", message.to_owned(), help);
                return;
            }
        };
        emit(ProgramStep::Command(Command::Index { axis, angle }));
        let turned = self.frame.turned();
        let plane = turned.map(|turned| {
            Box::new(PlaneStep { axes: [0, 1, 2].map(|axis| turned.column(axis).into_owned()) })
        });
        self.axis = match (turned, self.told_axis) {
            (None, Some(axis)) => axis,
            _ => Vector3::z(),
        };
        self.check_axis = turned.is_some();
        self.due = true;
        // Where the tool stands is not known in the frame that begins here.
        self.tip = None;
        emit(ProgramStep::Plane(plane));
    }

    /// Takes the tool axis of `TLAXIS`, in the part frame: an index move makes it that of its own frame.
    pub(super) fn tool_axis(&mut self, record: &Record<'_>, axis: [f64; 3]) {
        let Some(axis) = direction(Vector3::from(axis)) else {
            self.fault(record, "axis", "the tool axis is null".to_owned(), "");
            return;
        };
        self.told_axis = Some(axis);
        if self.frame.turned().is_none() {
            self.axis = axis;
        }
    }
}

/// Millimetres in one unit.
pub(super) fn millimetres(units: Units) -> f64 {
    match units {
        Units::Millimetre => 1.0,
        Units::Inch => 25.4,
        Units::Centimetre => 10.0,
        Units::Metre => 1000.0,
        Units::Foot => 304.8,
    }
}
