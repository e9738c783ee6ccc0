//! How controls are told a tilted plane.

use crate::field::{Codes, codes};

codes! {
    /// The angles that give a tilted plane's frame: three turns in this order, each about an axis of the frame that the
    /// turns before it have made (intrinsic). Turns about fixed axes are the same with the order reversed: `PLANE
    /// SPATIAL` turns about the machine's A, then B, then C, which is [`PlaneAngles::Zyx`] with SPC, SPB, SPA.
    #[derive(Default)]
    PlaneAngles "PLANE" {
        /// No angles: the plane is where the rotary words have turned it (G254).
        #[default]
        Rotary = 0 "ROTARY",
        /// Euler angles: Z, then X, then Z (G68.2 I J K).
        Zxz = 1 "ZXZ",
        /// X, then Y, then Z (CYCLE800 with mode 57).
        Xyz = 2 "XYZ",
        /// X, then Z, then Y (CYCLE800 with mode 45).
        Xzy = 3 "XZY",
        /// Y, then X, then Z (CYCLE800 with mode 54).
        Yxz = 4 "YXZ",
        /// Y, then Z, then X (CYCLE800 with mode 30).
        Yzx = 5 "YZX",
        /// Z, then X, then Y (CYCLE800 with mode 39).
        Zxy = 6 "ZXY",
        /// Z, then Y, then X (CYCLE800 with mode 27).
        Zyx = 7 "ZYX",
    }
}

impl PlaneAngles {
    /// The axes of the turns in their order, X is 0; none for [`PlaneAngles::Rotary`].
    pub const fn order(self) -> Option<[usize; 3]> {
        Some(match self {
            Self::Rotary => return None,
            Self::Zxz => [2, 0, 2],
            Self::Xyz => [0, 1, 2],
            Self::Xzy => [0, 2, 1],
            Self::Yxz => [1, 0, 2],
            Self::Yzx => [1, 2, 0],
            Self::Zxy => [2, 0, 1],
            Self::Zyx => [2, 1, 0],
        })
    }
}
