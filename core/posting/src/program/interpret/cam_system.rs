//! What a file shows of the system that wrote it, where the same word means something else in another.

/// Signs of the system that wrote a file.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CamSystem {
    /// `$$*CATIA0`, `$$ CATIA APT VERSION`: CATIA's aptsource.
    pub(super) catia: bool,
    /// `MODE/MILL`.
    pub(super) milling: bool,
    /// `LOADTL` with four numbers after `MODE/MILL`: a stock APT post of Autodesk.
    pub(super) autodesk: bool,
    /// Whether it was reported what it means by `SPINDL/ON`.
    pub(super) told_spindle: bool,
    /// Whether it was reported what it means by the heights of cycles.
    pub(super) told_heights: bool,
    camworks: bool,
    /// What the file says of its points: those of the tool's centre, or of the contour.
    points: Option<bool>,
}

/// What the points are under `CUTCOM`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CompensatedPoints {
    /// Points of the contour, or nothing says otherwise.
    Contour,
    /// The tool's centre; the file says so in the words of this text.
    Centre(&'static str),
    /// The tool's centre, as all files of this system that are known: the file itself says nothing.
    Presumed(&'static str),
}

impl CamSystem {
    pub(super) fn remark(&mut self, text: &str) {
        let text = text.trim();
        if text.eq_ignore_ascii_case("centerline data") {
            self.points = Some(true);
        }
        self.catia |= text == "*CATIA0" || text.starts_with("CATIA APT VERSION");
    }

    /// `CUTCOM_GEOMETRY_TYPE`.
    pub(super) fn says_points(&mut self, centre: bool) {
        self.points = Some(centre);
    }

    /// A word without a meaning of its own.
    pub(super) fn word(&mut self, word: &str) {
        // Found only in the files of CAMWorks and SolidWorks CAM.
        self.camworks |=
            matches!(word, "BOX" | "MOVE_ATTRIB" | "OPFEATSTART" | "OPFEATEND" | "TRNTYP")
                || word.starts_with("CSI_");
    }

    /// Whether it is CAMWorks or SolidWorks CAM.
    pub(super) fn is_camworks(&self) -> bool {
        self.camworks
    }

    /// What the points are under `CUTCOM`.
    pub(super) fn points(&self) -> CompensatedPoints {
        match self.points {
            Some(true) => CompensatedPoints::Centre(
                "by the file itself: CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER, centerline data",
            ),
            None if self.camworks => CompensatedPoints::Presumed(
                "as in every known file of SolidWorks CAM and CAMWorks, which do not say",
            ),
            _ => CompensatedPoints::Contour,
        }
    }
}
