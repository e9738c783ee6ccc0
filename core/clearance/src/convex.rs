//! One convex piece of a body.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::cloud::Cloud;
use crate::placement::Placement;

/// What a search for the nearest points asks of a set, whose hull is meant.
pub(crate) trait Support {
    /// The point farthest along `along`, which need not be a unit vector.
    fn support(&self, along: Vector3<f64>) -> Vector3<f64>;

    /// A point in it.
    fn centre(&self) -> Vector3<f64>;

    /// All that is so near belongs to it too, mm.
    fn round(&self) -> f64 {
        0.0
    }
}

/// A convex piece, mm: its core, and all that is within `round` of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Convex {
    /// What is inside.
    pub core: Core,
    /// How far it goes beyond its core on all sides.
    pub round: f64,
}

/// The core of a convex piece, mm.
#[derive(Clone, Debug, PartialEq)]
pub enum Core {
    /// What two discs about the same axis span: cylinder, cone, frustum, disc, line or point.
    Frustum {
        /// Centres of the discs.
        ends: [Vector3<f64>; 2],
        /// Axis, unit vector.
        axis: Vector3<f64>,
        /// Radii of the discs.
        radii: [f64; 2],
    },
    /// A box of any direction.
    Block {
        /// Its middle.
        centre: Vector3<f64>,
        /// From the middle to three of its faces, square to one another.
        half: [Vector3<f64>; 3],
    },
    /// A triangle.
    Triangle([Vector3<f64>; 3]),
    /// The hull of many points.
    Hull(Box<Hull>),
    /// What another core sweeps that goes along these vectors, in turn or at once.
    Swept {
        /// Where it begins.
        of: Box<Core>,
        /// How far it goes.
        ways: Vec<Vector3<f64>>,
    },
}

/// The hull of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// The points.
    pub(crate) cloud: Arc<Cloud>,
    /// Where they are.
    pub(crate) at: Placement,
}

impl Core {
    /// The point farthest along `along`, which need not be a unit vector.
    pub fn support(&self, along: Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Frustum { ends, axis, radii } => {
                let across = |vector: Vector3<f64>| vector - axis * axis.dot(&vector);
                // What rounding leaves of a direction along the axis points anywhere, and the disc is across the axis.
                let out = across(along).try_normalize(0.0).map(across);
                let out = out.and_then(|out| out.try_normalize(0.5));
                let out = out.unwrap_or_else(Vector3::zeros);
                let [first, last] = [0, 1].map(|end| ends[end] + out * radii[end]);
                if along.dot(&first) > along.dot(&last) { first } else { last }
            }
            Self::Block { centre, half } => half.iter().fold(*centre, |point, half| {
                if along.dot(half) > 0.0 { point + half } else { point - half }
            }),
            Self::Triangle([a, b, c]) => {
                let [x, y, z] = [a, b, c].map(|corner| along.dot(corner));
                match (x >= y && x >= z, y >= z) {
                    (true, _) => *a,
                    (false, true) => *b,
                    (false, false) => *c,
                }
            }
            Self::Hull(hull) => hull.at.point(hull.cloud.farthest(hull.at.rotation.tr_mul(&along))),
            Self::Swept { of, ways } => {
                let farther = ways.iter().filter(|way| along.dot(way) > 0.0);
                of.support(along) + farther.sum::<Vector3<f64>>()
            }
        }
    }

    /// A point in it.
    pub fn centre(&self) -> Vector3<f64> {
        match self {
            Self::Frustum { ends: [first, last], .. } => (first + last) * 0.5,
            Self::Block { centre, .. } => *centre,
            Self::Triangle([a, b, c]) => (a + b + c) / 3.0,
            Self::Hull(hull) => hull.at.point(hull.cloud.mean()),
            Self::Swept { of, ways } => of.centre() + ways.iter().sum::<Vector3<f64>>() * 0.5,
        }
    }

    /// A point in it that is near to `point`, of some cores the nearest: where to look, not how far it is.
    pub fn towards(&self, point: Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Frustum { ends, axis, radii } => {
                let arm = point - ends[0];
                let (height, rise) = (axis.dot(&(ends[1] - ends[0])), axis.dot(&arm));
                let share = if height == 0.0 { 0.0 } else { (rise / height).clamp(0.0, 1.0) };
                let radius = radii[0] + (radii[1] - radii[0]) * share;
                let out = arm - axis * rise;
                let far = out.norm();
                let out = if far > radius { out * (radius / far) } else { out };
                ends[0] + (ends[1] - ends[0]) * share + out
            }
            Self::Block { centre, half } => half.iter().fold(*centre, |at, half| {
                let share = half.dot(&(point - centre)) / half.norm_squared();
                // Of a flat one a half is zero.
                if share.is_finite() { at + half * share.clamp(-1.0, 1.0) } else { at }
            }),
            Self::Triangle(_) | Self::Hull(_) | Self::Swept { .. } => self.centre(),
        }
    }

    /// Points whose hull, with the discs' radii around them, holds it: each with that radius.
    fn corners(&self) -> Vec<(Vector3<f64>, f64)> {
        match self {
            Self::Frustum { ends, radii, .. } => {
                ends.iter().copied().zip(radii.iter().copied()).collect()
            }
            Self::Block { centre, half: [x, y, z] } => {
                let sides = [-1.0, 1.0];
                let corner = |i: f64, j: f64, k: f64| (centre + x * i + y * j + z * k, 0.0);
                let edge = |i, j| sides.map(|k| corner(i, j, k));
                let faces = sides.map(|i| sides.map(|j| edge(i, j)));
                faces.into_iter().flatten().flatten().collect()
            }
            Self::Triangle(corners) => corners.map(|corner| (corner, 0.0)).to_vec(),
            Self::Hull(hull) => {
                let (centre, radius) = hull.cloud.sphere();
                vec![(hull.at.point(centre), radius)]
            }
            Self::Swept { of, ways } => {
                let half = ways.iter().sum::<Vector3<f64>>() * 0.5;
                let far = 0.5 * ways.iter().map(Vector3::norm).sum::<f64>();
                let corners = of.corners().into_iter();
                corners.map(|(corner, radius)| (corner + half, radius + far)).collect()
            }
        }
    }

    fn placed(&self, at: &Placement) -> Self {
        match self {
            Self::Frustum { ends, axis, radii } => Self::Frustum {
                ends: ends.map(|end| at.point(end)),
                axis: at.direction(*axis),
                radii: *radii,
            },
            Self::Block { centre, half } => {
                Self::Block { centre: at.point(*centre), half: half.map(|half| at.direction(half)) }
            }
            Self::Triangle(corners) => Self::Triangle(corners.map(|corner| at.point(corner))),
            Self::Hull(hull) => {
                let shift = at.point(hull.at.shift);
                let at = Placement { rotation: at.rotation * hull.at.rotation, shift };
                Self::Hull(Box::new(Hull { cloud: hull.cloud.clone(), at }))
            }
            Self::Swept { of, ways } => Self::Swept {
                of: Box::new(of.placed(at)),
                ways: ways.iter().map(|way| at.direction(*way)).collect(),
            },
        }
    }
}

impl Convex {
    /// A ball, mm.
    pub fn ball(centre: Vector3<f64>, radius: f64) -> Self {
        let core = Core::Frustum { ends: [centre; 2], axis: Vector3::z(), radii: [0.0; 2] };
        Self { core, round: radius }
    }

    /// A box between two corners, along the frame's axes, mm.
    pub fn block(low: Vector3<f64>, high: Vector3<f64>) -> Self {
        let half = (high - low) * 0.5;
        let half = [0, 1, 2].map(|axis| Vector3::ith(axis, half[axis]));
        Self { core: Core::Block { centre: (low + high) * 0.5, half }, round: 0.0 }
    }

    /// A cylinder or a frustum between two points, mm.
    pub fn frustum(ends: [Vector3<f64>; 2], axis: Vector3<f64>, radii: [f64; 2]) -> Self {
        Self { core: Core::Frustum { ends, axis, radii }, round: 0.0 }
    }

    /// A triangle, mm.
    pub fn triangle(corners: [Vector3<f64>; 3]) -> Self {
        Self { core: Core::Triangle(corners), round: 0.0 }
    }

    /// The piece elsewhere.
    pub fn placed(&self, at: &Placement) -> Self {
        Self { core: self.core.placed(at), round: self.round }
    }

    /// What it sweeps that goes straight along these vectors, mm, in turn or at once.
    pub fn swept(self, ways: &[Vector3<f64>]) -> Self {
        let core = Core::Swept { of: Box::new(self.core), ways: ways.to_vec() };
        Self { core, round: self.round }
    }

    /// The hull of points.
    pub(crate) fn hull(cloud: Arc<Cloud>) -> Self {
        Self { core: Core::Hull(Box::new(Hull { cloud, at: Placement::identity() })), round: 0.0 }
    }

    /// A sphere that holds it: centre and radius, mm.
    pub fn sphere(&self) -> (Vector3<f64>, f64) {
        let centre = self.core.centre();
        let corners = self.core.corners();
        let far = corners.iter().map(|(corner, radius)| match self.core {
            // The rim is square to the axis, the centre on it.
            Core::Frustum { .. } => libm::hypot((corner - centre).norm(), *radius),
            _ => (corner - centre).norm() + radius,
        });
        (centre, far.fold(0.0, f64::max) + self.round)
    }

    /// Its least and largest coordinates, mm.
    pub fn extents(&self) -> [Vector3<f64>; 2] {
        [-1.0, 1.0].map(|sense| {
            let reach = |axis| self.core.support(Vector3::ith(axis, sense))[axis];
            Vector3::from_fn(|axis, _| reach(axis) + sense * self.round)
        })
    }

    /// All numbers of it are finite and closer than [`crate::FARTHEST`].
    pub fn is_near(&self) -> bool {
        let (centre, radius) = self.sphere();
        centre.iter().all(|value| libm::fabs(*value) + radius <= crate::FARTHEST)
    }
}

impl Support for Convex {
    fn support(&self, along: Vector3<f64>) -> Vector3<f64> {
        self.core.support(along)
    }

    fn centre(&self) -> Vector3<f64> {
        self.core.centre()
    }

    fn round(&self) -> f64 {
        self.round
    }
}
