//! `fewest`: the longest blocks that the certificate allows.
//!
//! A block between two points on the path bows to one side of it. Put off the path to the other side, its ends
//! balance it: a block may then bow by twice the tolerance, and be 1.4 times as long. Blocks need not end on CL
//! points; the ends of the run are kept as they are, and so are, where CL points are not to be dropped, all of them.

use nalgebra::Vector3;
use post_plugin::ModelSession;

use super::bisect::put_in;
use super::bound::DeviationBound;
use super::linearise::{LineariseError, Lineariser};
use super::node::PathNode;
use super::run::{NodeRun, RunPosition, distance};

/// Lengths tried for one block.
const TRIES: u32 = 12;

/// A block is long enough if it cannot be made longer by more than this share.
const ENOUGH: f64 = 0.03;

/// What a length that should just do is taken down by.
const SAFE: f64 = 0.99;

/// A block shorter than this share of its leg does not come of its bow: the axes jump there.
const SHORTEST: f64 = 1.0 / 4096.0;

/// A block that was tried.
struct TriedBlock {
    to: PathNode,
    end: RunPosition,
    /// Bound on the block's deviation, if it is within tolerance.
    bound: Option<DeviationBound>,
    /// How long it should be, as a share of what it is.
    better: f64,
}

/// CL points that blocks go along, from one of them to another.
#[derive(Clone, Copy)]
struct RunSection<'a> {
    run: &'a NodeRun<'a>,
    way: &'a [f64],
    /// Last CL point of the section.
    end: usize,
}

impl Lineariser {
    /// Cuts what lies between two CL points of a run into as few blocks as it finds.
    ///
    /// # Errors
    /// Why it cannot be done, and in which leg.
    pub(super) fn stride(
        &mut self,
        run: &NodeRun<'_>,
        first: usize,
        end: usize,
        model: &mut dyn ModelSession,
    ) -> Result<(), (usize, LineariseError)> {
        let way = std::mem::take(&mut self.way);
        let done = self.stride_along(RunSection { run, way: &way, end }, first, model);
        self.way = way;
        done
    }

    fn stride_along(
        &mut self,
        stretch: RunSection<'_>,
        first: usize,
        model: &mut dyn ModelSession,
    ) -> Result<(), (usize, LineariseError)> {
        let RunSection { run, way, end } = stretch;
        let mut from = run.start(first);
        let mut start = RunPosition { leg: first, t: 0.0 };
        let mut step = way[end] - way[first];
        while start.t < 1.0 || start.leg + 1 < end {
            if start.t >= 1.0 {
                start = RunPosition { leg: start.leg + 1, t: 0.0 };
                from.t = 0.0;
            }
            match stretch.longest((&from, start), step) {
                Some((tried, bound)) => {
                    step = distance(way, tried.end) - distance(way, start);
                    self.enter(tried.end.leg);
                    self.keep(tried.to, bound);
                    from = tried.to;
                    start = tried.end;
                }
                // Not to any place between CL points, but to one of them perhaps.
                None if start.t == 0.0
                    && let Some((reach, bound)) = run.farthest(start.leg, end, way) =>
                {
                    self.enter(reach - 1);
                    from = run.end(reach);
                    self.keep(from, bound);
                    start = RunPosition { leg: reach - 1, t: 1.0 };
                }
                None => {
                    // The axes jump here: the rest of the leg is bisected, which knows what to do close to a pole.
                    self.enter(start.leg);
                    self.halve(&run.leg(&from, start.leg), model)
                        .map_err(|stuck| (start.leg, stuck))?;
                    from = run.end(start.leg + 1);
                    start.t = 1.0;
                }
            }
        }
        Ok(())
    }
}

impl RunSection<'_> {
    /// The longest block from `start` that is within tolerance; the first try is `step` mm long.
    fn longest(
        &self,
        (from, start): (&PathNode, RunPosition),
        step: f64,
    ) -> Option<(TriedBlock, DeviationBound)> {
        let way = self.way;
        let begin = distance(way, start);
        let rest = way[self.end] - begin;
        let leg = way[start.leg + 1] - way[start.leg];
        let mut best: Option<(f64, TriedBlock, DeviationBound)> = None;
        // What is known to be too long.
        let mut over = f64::INFINITY;
        let mut length = step.min(rest);
        for _ in 0..TRIES {
            let Some(tried) = self.reach((from, start), length) else {
                if best.is_some() {
                    break;
                }
                over = length;
                length /= 2.0;
                if length < SHORTEST * leg {
                    return None;
                }
                continue;
            };
            let better = tried.better;
            match tried.bound {
                Some(bound) => {
                    let enough = length >= rest || better < 1.0 + ENOUGH;
                    best = Some((length, tried, bound));
                    if enough {
                        break;
                    }
                }
                None => over = length,
            }
            let good = best.as_ref().map_or(0.0, |(length, ..)| *length);
            let foreseen = length * better;
            length = if foreseen > good * (1.0 + ENOUGH) && foreseen < over * (1.0 - ENOUGH) {
                foreseen.min(8.0 * length)
            } else if over.is_finite() {
                // The bow did not foretell it: between what holds and what does not.
                (good + over) / 2.0
            } else {
                break;
            };
            length = length.min(rest);
            if good > 0.0 && (length < good * (1.0 + ENOUGH) || over < good * (1.0 + 2.0 * ENOUGH))
            {
                break;
            }
            if length < SHORTEST * leg {
                return None;
            }
        }
        best.map(|(_, tried, bound)| (tried, bound))
    }

    /// Tries a block of `length` mm; none if there is no way to stand at its end.
    fn reach(&self, (from, start): (&PathNode, RunPosition), length: f64) -> Option<TriedBlock> {
        let RunSection { run, way, end: last } = *self;
        let begin = distance(way, start);
        let to_end = begin + length >= way[last] * (1.0 - 1e-12);
        let end = if to_end {
            RunPosition { leg: last - 1, t: 1.0 }
        } else {
            run.spot(way, begin + length)
        };
        let mut to = if to_end {
            run.end(last)
        } else {
            let point = run.start(end.leg);
            let leg = run.leg(&point, end.leg);
            if eased(run, &point) || eased(run, leg.to) {
                return None;
            }
            put_in(&leg, end.t, || leg.measured().axis <= run.tolerances.axis).ok()?
        };
        // How the block bows: off the path in the middle, beside the line between its ends.
        let middle = run.spot(way, begin + length / 2.0);
        let passed = run.passed(from, &to, 0.5, run.target(middle));
        let bow = passed.off() - (from.off() + to.off()) / 2.0;
        let size = bow.norm();
        let tolerance = run.tolerances.tip;
        let aside = bow.try_normalize(1e-12).unwrap_or_else(Vector3::zeros);
        let rounding = run.placer.tip_rounding();
        let room = if !to_end && run.balances && tolerance.is_finite() {
            tolerance - rounding
        } else {
            0.0
        };
        let mut shift = (size / 2.0).min(room);
        if shift > rounding {
            let (target, rotary) = (to.target, to.trace.joints);
            let place = target.tip - aside * shift;
            run.placer.settle_at(&mut to, target, place, end.t, &rotary).ok()?;
        } else {
            shift = 0.0;
        }
        let bound = run.along((from, start), (&to, end), way);
        let ahead = -from.off().dot(&aside);
        let allowed = SAFE * tolerance + (ahead + shift) / 2.0;
        let by_tip = if size > 0.0 { allowed / size } else { f64::INFINITY };
        // The tool axis bows with the square of the length too.
        let axis = passed.axis_error;
        let by_axis = if axis > 0.0 { SAFE * run.tolerances.axis / axis } else { f64::INFINITY };
        Some(TriedBlock { to, end, bound, better: libm::sqrt(by_tip.min(by_axis).max(0.0)) })
    }
}

/// The axes do not stand where the point alone would put them: close to a pole they are turned evenly, and a point put
/// in on the exact solution would leave the turn for the end of the leg.
fn eased(run: &NodeRun<'_>, node: &PathNode) -> bool {
    node.axis_error > run.placer.axis_rounding()
}
