//! Why a pose cannot be reached, or a chain not be solved.

/// Where the wanted axis lies closer to k1 than this, k1 turns the tool axis by nothing that a CL file
/// with seven decimals could mean, and its angle is free: radians.
pub const POLE: f64 = 1e-6;

/// Why a pose cannot be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreachable {
    /// No rotary angles give the tool axis; the nearest orientation misses by this angle.
    Axis {
        /// Radians.
        miss: f64,
    },
    /// The linear axes span no volume at these angles.
    Linear,
    /// Two linear axes move the tip in a plane, and the plane passes by the point.
    Plane {
        /// Distance, mm.
        miss: f64,
    },
    /// A numeric search found nothing; the nearest pose misses the tip by this.
    Numeric {
        /// mm, an error of the tool axis counted on an arm of 300 mm.
        miss: f64,
    },
}

/// What a chain lacks for being solved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoClosedForm {
    /// More linear axes move at once than the three that a tip needs.
    ManyLinearAxes {
        /// Places of the axes in the chain.
        joints: Vec<usize>,
    },
    /// Fewer than three linear axes, and rotary ones do not make up for them.
    FewAxes {
        /// Linear axes that move by themselves.
        linear: usize,
        /// Rotary axes that are solved for.
        rotary: usize,
        /// Others move along with them.
        quills: bool,
    },
    /// Fewer than three linear axes, and all that moves takes the tip along fewer than three directions.
    FlatTip {
        /// How many: 1 along a curve, 2 over a surface.
        ways: usize,
    },
    /// The three linear directions lie in one plane.
    FlatLinearAxes,
    /// Rotary axes that no formula knows, beside a quill.
    RotaryAxes {
        /// Places of the axes in the chain.
        joints: Vec<usize>,
    },
    /// Two free rotary axes are parallel.
    Parallel {
        /// Places of the axes in the chain.
        joints: [usize; 2],
    },
}

impl NoClosedForm {
    /// What is wrong, and what would help; `name` gives the address of the axis at a place in the chain.
    pub fn told<'n>(&self, name: impl Fn(usize) -> &'n str) -> (String, &'static str) {
        let names = |joints: &[usize]| {
            let names: Vec<&str> = joints.iter().map(|joint| name(*joint)).collect();
            names.join(", ")
        };
        match self {
            Self::ManyLinearAxes { joints } => (
                format!(
                    "{} linear axes move at once ({}); the tip is placed by three",
                    joints.len(),
                    names(joints)
                ),
                match ["U", "V"]
                    .iter()
                    .all(|guide| joints.iter().any(|joint| name(*joint) == *guide))
                {
                    true => {
                        "indexed = 0 holds U and V during cuts: that a wire leans as they lead its other end is not said by a chain, and its tapers are not posted"
                    }
                    false => {
                        "share = 0.5 or reserve = true moves a quill along with the axis beside it, indexed = 0 holds an axis during cuts"
                    }
                },
            ),
            Self::FewAxes { linear, rotary, quills } => (
                format!(
                    "{linear} linear and {rotary} rotary axes move by themselves{}: they cannot place the tip",
                    match quills {
                        true => ", others along with them",
                        false => "",
                    }
                ),
                match quills {
                    true => "share and reserve are for a quill beside three linear axes",
                    false => {
                        "three axes at least must move the tip: with fewer than three linear ones, rotary axes that are not indexed make up for them"
                    }
                },
            ),
            Self::FlatTip { ways } => (
                format!(
                    "all axes together move the tip {} alone: they do not span the space",
                    match ways {
                        2 => "over a surface",
                        1 => "along a curve",
                        _ => "nowhere, in one point",
                    }
                ),
                "check directions and points: a rotary axis through the tip, or parallel to the others, adds nothing",
            ),
            Self::FlatLinearAxes => (
                "the three linear axes lie in one plane: they span no volume".to_owned(),
                "check their directions",
            ),
            Self::RotaryAxes { joints } => (
                format!(
                    "the rotary axes {} are solved by a search, and that knows no quill (share, reserve)",
                    names(joints)
                ),
                "indexed = 0 holds an axis during cuts: the quill, or rotary axes until two are left",
            ),
            Self::Parallel { joints: [first, second] } => (
                format!(
                    "{} and {} turn about parallel axes: they cannot point the tool",
                    name(*first),
                    name(*second)
                ),
                "check their directions, or hold one with indexed = 0",
            ),
        }
    }
}
