//! One set-point, with all that came of it.

use post_motion::ProgramPlace;
use post_motion::contour::ContourPoint;

/// A set-point, and where the machine is at its time.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// What is carried out: line of the program, and whether the tool cuts.
    pub at: ProgramPlace,
    /// Commanded feed of the tip against the part since the set-point before, mm/min; zero where that was no cut.
    pub feed: f64,
    /// Feed that the program states, mm/min; zero for rapids and waits.
    pub programmed: f64,
    /// Where axes and tool are commanded and where they are, and how far the tool is off its path.
    pub point: ContourPoint,
}

impl Sample {
    /// The tool is nearest to a cut: its error counts.
    pub fn counts(&self) -> bool {
        self.point.at.cuts
    }

    /// Actual tip minus the nearest point of the path that is asked for, mm, part frame: that of the CL file where one is
    /// given, else the commanded one.
    pub fn error(&self) -> [f64; 3] {
        let asked = self.point.asked.map(|asked| asked.error);
        asked.unwrap_or(self.point.error).into()
    }

    /// Length of [`Sample::error`], mm.
    pub fn size(&self) -> f64 {
        let asked = self.point.asked.map(|asked| asked.distance);
        asked.unwrap_or(self.point.distance)
    }

    /// Angle of the tool axis against that path, radians.
    pub fn axis(&self) -> f64 {
        let asked = self.point.asked.map(|asked| asked.axis);
        asked.unwrap_or(self.point.axis)
    }

    /// Line of the CL file whose path is nearest, where one is given.
    pub fn cl_line(&self) -> Option<u64> {
        self.point.asked.map(|asked| asked.at.line)
    }
}
