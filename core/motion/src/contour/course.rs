//! A path that is asked for, as far as it is needed, and how far the tool has come on it.
//!
//! A place on it is carried on with the way that was gone meanwhile, and the nearest point is looked for from there by
//! the rule of `path.rs`, but nowhere before where the tool has been. What does not cut is left out: the end of one cut
//! and the beginning of the next are neighbours, as far apart as they are, so that the tool finds the next cut when it
//! cuts again. A place further along counts only where it is nearer by more than a tenth of a micrometre: a contour
//! that is cut twice is gone along in order.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::leg::ContourLeg;
use super::path::{CommandedPath, Foot, REACH};
use crate::ProgramPlace;

/// Knots ahead of the tool that are kept; a way between two cuts is followed that far.
const AHEAD: usize = 20_000;

/// Least distance to which what lies ahead is known, mm.
const LEAST: f64 = 1.0;

/// The nearest point of a path that is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestAsked {
    pub at: ProgramPlace,
    pub tip: Vector3<f64>,
    pub distance: f64,
    foot: Foot,
    /// How far the place has gone on along the path, mm.
    pub way: f64,
}

/// How far a path that is asked for has been followed.
#[derive(Clone, Debug, Default)]
pub(super) struct FollowedPath {
    path: CommandedPath,
    /// The tool is on it.
    on: bool,
}

impl FollowedPath {
    /// A leg after those that are known.
    pub fn push(&mut self, leg: &ContourLeg) {
        if !leg.at.cuts {
            return;
        }
        let mut first = true;
        leg.knots(&mut |knot| {
            match first {
                true => self.path.join(knot),
                false => self.path.push(knot),
            }
            first = false;
        });
    }

    /// The place nearest to a tool that goes along it, and has gone `way` mm since it was asked last; `more` hands out
    /// further legs.
    pub fn follow(
        &mut self,
        tool: &Pose,
        way: f64,
        more: &mut dyn FnMut() -> Option<ContourLeg>,
    ) -> Option<NearestAsked> {
        let way = self.on.then_some(way);
        self.on = true;
        if self.path.is_empty() {
            self.push(&next_cut(more)?);
        }
        let mut start = self.path.after(self.path.foot(), way.unwrap_or(0.0));
        let first = (self.path.point(start) - tool.tip).norm();
        let wanted = LEAST.max(way.unwrap_or(0.0) + REACH * first);
        let mut known = true;
        while let (knots, length) = self.path.ahead()
            && knots < AHEAD
            && length < wanted
            && let Some(leg) = next_cut(more)
        {
            self.push(&leg);
            known = false;
        }
        let foot = match way {
            None => self.path.seek_anew(tool),
            Some(way) => {
                if !known {
                    start = self.path.after(self.path.foot(), way);
                }
                self.path.seek(tool, start, way)
            }
        };
        let last = self.path.length(self.path.foot());
        let mut asked = self.asked(foot, tool);
        asked.way = (self.path.length(foot) - last).max(0.0);
        self.path.stand(foot);
        asked.foot = self.path.foot();
        Some(asked)
    }

    /// The tool leaves it: at rapid it goes elsewhere.
    pub fn leave(&mut self) {
        self.on = false;
    }

    /// The place nearest to another one of the tool, close to where the first is.
    pub fn beside(&self, tool: &Pose) -> Option<NearestAsked> {
        if self.path.is_empty() {
            return None;
        }
        let foot = self.path.seek(tool, self.path.foot(), f64::INFINITY);
        Some(self.asked(foot, tool))
    }

    /// The tool axis that is asked for where the tool was found to be nearest.
    pub fn axis(&self, tool: &Pose, asked: &NearestAsked) -> Vector3<f64> {
        self.path.axis_beside(tool, asked.foot)
    }

    fn asked(&self, foot: Foot, tool: &Pose) -> NearestAsked {
        let tip = self.path.point(foot);
        NearestAsked {
            at: self.path.at(foot),
            tip,
            distance: (tip - tool.tip).norm(),
            foot,
            way: 0.0,
        }
    }
}

fn next_cut(more: &mut dyn FnMut() -> Option<ContourLeg>) -> Option<ContourLeg> {
    loop {
        let leg = more()?;
        if leg.at.cuts {
            return Some(leg);
        }
    }
}
