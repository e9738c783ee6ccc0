//! From the frame that a CL file is written in to that of the part.

use nalgebra::{Matrix3, Rotation3, Vector3};
use post_grammar::{Rotate, Sense};

/// Angles written with six decimals of a radian miss a right angle or half of one by less: radians.
const DECIMALS: f64 = 2e-6;

/// An index move turns by no more: a hundred turns, radians.
const MOST_TURN: f64 = 100.0 * std::f64::consts::TAU;

/// Frames in force: points are turned by the index axes, taken into `MSYS`, and turned as the part sits.
#[derive(Clone, Debug)]
pub(super) struct Frames {
    /// Angles of the index axes A, B and C, radians.
    index: [f64; 3],
    /// What they turn points by.
    turned: Option<Matrix3<f64>>,
    /// Origin, mm, and from the file's directions to those of the frame.
    msys: Option<(Vector3<f64>, Matrix3<f64>)>,
    /// How the part sits.
    sits: Option<Matrix3<f64>>,
    /// From the point of the tool that the file names to that which the control counts by, mm, part frame.
    nose: Vector3<f64>,
}

impl Frames {
    pub(super) fn new(turn: f64) -> Self {
        let about_z = || *Rotation3::from_axis_angle(&Vector3::z_axis(), turn).matrix();
        Self {
            index: [0.0; 3],
            turned: None,
            msys: None,
            sits: (turn != 0.0).then(about_z),
            nose: Vector3::zeros(),
        }
    }

    /// The part sits turned about its Z.
    pub(super) fn sits_turned(&self) -> bool {
        self.sits.is_some()
    }

    /// An index axis is turned: what by.
    pub(super) fn turned(&self) -> Option<Matrix3<f64>> {
        self.turned
    }

    /// Takes points into the frame with this origin (mm), X and Y.
    ///
    /// # Errors
    /// They are no frame.
    pub(super) fn set_msys(
        &mut self,
        origin: Vector3<f64>,
        [x, y]: [Vector3<f64>; 2],
    ) -> Result<(), &'static str> {
        let off = |length: f64| libm::fabs(length - 1.0) > 1e-3;
        let normal = x.cross(&y);
        if off(x.norm()) || off(y.norm()) || off(normal.norm()) {
            return Err("its X and Y are no unit vectors at a right angle");
        }
        // Decimals leave them a little askew: Z is kept across both, X as it stands.
        let (x, z) = (x.normalize(), normal.normalize());
        let y = z.cross(&x);
        let into = Matrix3::from_columns(&[x, y, z]).transpose();
        self.msys = Some((origin, into));
        Ok(())
    }

    /// Turns an index axis (`ROTABL`): points behind it are written in the frame of the turned part, in which the machine
    /// stands; A about X, B about Y, C about Z of the part, A on the outside.
    ///
    /// # Errors
    /// No axis is named, or the angle is none.
    pub(super) fn rotate(&mut self, rotate: &Rotate) -> Result<(), &'static str> {
        let place = match rotate.axis {
            Some('A') => 0,
            Some('B') => 1,
            Some('C') => 2,
            _ => return Err("this index move names no axis"),
        };
        let mut angle = match rotate.radians {
            true => rotate.angle,
            false => rotate.angle.to_radians(),
        };
        if rotate.sense == Some(Sense::Clockwise) {
            angle = -angle;
        }
        if rotate.incremental {
            angle += self.index[place];
        }
        if libm::fabs(angle) > MOST_TURN {
            return Err("this index move turns by more than a hundred turns");
        }
        let step = std::f64::consts::FRAC_PI_4;
        let even = libm::rint(angle / step) * step;
        if libm::fabs(angle - even) < DECIMALS {
            angle = even;
        }
        self.index[place] = angle;
        let [a, b, c] = self.index;
        let turned = Rotation3::from_axis_angle(&Vector3::x_axis(), a)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), b)
            * Rotation3::from_axis_angle(&Vector3::z_axis(), c);
        self.turned = (self.index != [0.0; 3]).then(|| *turned.matrix());
        Ok(())
    }

    /// The points of the file are those of another point of the tool, which the control counts by that far off.
    pub(super) fn count_by(&mut self, nose: Vector3<f64>) {
        self.nose = nose;
    }

    /// The frame of the file is that of the part.
    pub(super) fn is_of_part(&self) -> bool {
        let turned = [self.turned.as_ref(), self.sits.as_ref()].iter().any(Option::is_some);
        !turned && self.msys.is_none() && self.nose == Vector3::zeros()
    }

    /// A point of the file, mm, in the part frame.
    pub(super) fn point(&self, mut point: Vector3<f64>) -> Vector3<f64> {
        if let Some(turned) = &self.turned {
            point = turned * point;
        }
        if let Some((origin, into)) = &self.msys {
            point = into * (point - origin);
        }
        let point = match &self.sits {
            Some(sits) => sits * point,
            None => point,
        };
        point + self.nose
    }

    /// A direction of the file in the part frame.
    pub(super) fn direction(&self, mut direction: Vector3<f64>) -> Vector3<f64> {
        let msys = self.msys.as_ref().map(|(_, into)| into);
        for turn in [self.turned.as_ref(), msys, self.sits.as_ref()].into_iter().flatten() {
            direction = turn * direction;
        }
        direction
    }
}
