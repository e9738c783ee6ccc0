//! Turns the frame that a CL file is written in into that of the part: index moves, `MSYS`, and how the part sits.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use post_grammar::{Rotate, Sense};

use super::limits::MOST_DEGREES;

/// The frame in force.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClFrame {
    /// Take points and axes into the frame of `MSYS`.
    apply_msys: bool,
    /// Origin in mm, and the frame's axes as rows.
    msys: Option<(Vector3<f64>, Matrix3<f64>)>,
    /// Angles of the index axes A, B, C, radians.
    index: [f64; 3],
    /// The turned part's frame seen from the part; none if no index axis is turned.
    turned: Option<Matrix3<f64>>,
    /// How the part is turned about its Z where it sits; none if it is not.
    clamped: Option<Matrix3<f64>>,
    /// What leads to the point of the tool that the control counts by, mm, part frame.
    shift: Option<Vector3<f64>>,
}

/// Angles with six decimals of a radian do not quite reach a right angle: so far they are taken as one.
const NEAR: f64 = 2e-6;

impl ClFrame {
    /// The frame of a part that sits turned about its Z by `turn`, radians, right-handed.
    pub(crate) fn new(apply_msys: bool, turn: f64) -> Self {
        let rotation = || Rotation3::from_axis_angle(&Vector3::z_axis(), turn).into_inner();
        Self { apply_msys, clamped: (turn != 0.0).then(rotation), ..Self::default() }
    }

    /// Points are taken on by `shift`, mm, part frame.
    pub(crate) fn take_on(&mut self, shift: Vector3<f64>) {
        self.shift = Some(shift).filter(|shift| *shift != Vector3::zeros());
    }

    /// The part sits turned about its Z.
    pub(crate) fn sits_turned(&self) -> bool {
        self.clamped.is_some()
    }

    /// Takes an `MSYS`; `origin` in mm.
    ///
    /// # Errors
    /// If X and Y are not two unit vectors at a right angle.
    pub(crate) fn set_msys(
        &mut self,
        origin: Vector3<f64>,
        x: Vector3<f64>,
        y: Vector3<f64>,
    ) -> Result<(), &'static str> {
        let z = x.cross(&y);
        let is_one = |length: f64| (length - 1.0).abs() <= 1e-3;
        if ![x, y, z].iter().all(|vector| is_one(vector.norm())) {
            return Err("X and Y of this MSYS are not two unit vectors at a right angle");
        }
        // Seven decimals leave the axes a little off: make them a rotation.
        let z = z.normalize();
        let x = x.normalize();
        let rows = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
        self.msys = Some((origin, rows));
        Ok(())
    }

    /// Takes an index move (`ROTABL`): the points that follow are written in the turned part's frame. Gives the
    /// axis (`A`, `B`, `C`) and where it stands, radians.
    ///
    /// # Errors
    /// Fails if no axis is named, or the angle is not one.
    pub(crate) fn rotate(&mut self, rotate: &Rotate) -> Result<(char, f64), &'static str> {
        let place =
            rotate.axis.and_then(|axis| "ABC".find(axis)).ok_or("this index move names no axis")?;
        let angle = if rotate.radians { rotate.angle } else { rotate.angle.to_radians() };
        let angle = match rotate.sense {
            Some(Sense::Clockwise) => -angle,
            _ => angle,
        };
        let angle = if rotate.incremental { self.index[place] + angle } else { angle };
        if angle.abs() > MOST_DEGREES.to_radians() {
            return Err("this index move turns by more than a hundred turns");
        }
        let eighth = std::f64::consts::FRAC_PI_4;
        let near = (angle / eighth).round() * eighth;
        self.index[place] = if (angle - near).abs() < NEAR { near } else { angle };
        let turn = |k: Vector3<f64>, angle: f64| {
            Rotation3::from_axis_angle(&Unit::new_unchecked(k), angle)
        };
        let [a, b, c] = self.index;
        let rotation = turn(Vector3::x(), a) * turn(Vector3::y(), b) * turn(Vector3::z(), c);
        self.turned = (self.index != [0.0; 3]).then(|| rotation.into_inner());
        Ok((['A', 'B', 'C'][place], self.index[place]))
    }

    /// The turned part's frame seen from the part, if an index axis is turned.
    pub(crate) fn turned(&self) -> Option<&Matrix3<f64>> {
        self.turned.as_ref()
    }

    /// Points are written in the frame of the part.
    #[inline]
    pub(crate) fn is_of_part(&self) -> bool {
        self.turned.is_none()
            && self.clamped.is_none()
            && self.shift.is_none()
            && (self.msys.is_none() || !self.apply_msys)
    }

    /// A direction, taken to the frame of the part.
    pub(crate) fn direction_to_part(&self, direction: Vector3<f64>) -> Vector3<f64> {
        self.to_part(Vector3::zeros(), direction).1
    }

    /// A point (mm) and an axis, taken to the frame of the part.
    #[inline]
    pub(crate) fn to_part(
        &self,
        mut tip: Vector3<f64>,
        mut axis: Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        if let Some(turned) = &self.turned {
            tip = turned * tip;
            axis = turned * axis;
        }
        if self.apply_msys
            && let Some((origin, rows)) = &self.msys
        {
            tip = rows * (tip - origin);
            axis = rows * axis;
        }
        if let Some(clamped) = &self.clamped {
            tip = clamped * tip;
            axis = clamped * axis;
        }
        if let Some(shift) = &self.shift {
            tip += shift;
        }
        (tip, axis)
    }
}
