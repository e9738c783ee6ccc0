//! Arcs by their words: centre, radius, turns.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::block_words::{BlockWords, bit};
use super::go::MotionTarget;
use super::state::ControlState;
use crate::Curve;
use crate::g_code::GCode;

/// Start and end lie on one circle if their radii differ by no more than this, mm, and by this share of the radius: the
/// decimals of an inch program, and the rounding of a centre far away.
const OFF: [f64; 2] = [0.02, 0.001];

/// Start and end nearer to each other than this are one point, mm: no word is so fine, and in a tilted plane the start
/// comes out of a computation.
const SAME: f64 = 1e-6;

/// Most turns of a helix.
pub(super) const MOST_TURNS: f64 = 10_000.0;

/// Letters of an arc's centre or radius.
const SHAPE: u32 = bit(b'I') | bit(b'J') | bit(b'K') | bit(b'R');

impl ControlState {
    /// The arc that the words of a block ask for.
    pub(super) fn arc_words(
        &mut self,
        clockwise: bool,
        words: &mut BlockWords,
        target: &mut MotionTarget,
    ) -> Result<Curve, Box<Diagnostic>> {
        let [first, second, third] = self.modal.plane.coordinates();
        if words.pointless & SHAPE != 0 {
            self.least_increments(words, SHAPE)?;
        }
        let from = self.point();
        let to = Vector3::from_fn(|row, _| target.point[row].unwrap_or(from[row]));
        // The rest of the words counts from one point, also where the end says nothing.
        target.point = [Some(to.x), Some(to.y), Some(to.z)];
        let radius = match self.lexicon.letter(b'R') {
            Some(Meaning::Radius) => words.take(b'R').map(|radius| radius * self.modal.unit),
            _ => None,
        }
        .or(words.radius);
        let unit = self.modal.unit;
        let absolute = self.modal.centres_absolute;
        let mut centre = from;
        let mut told = false;
        for (row, letter) in [b'I', b'J', b'K'].into_iter().enumerate() {
            let Some(value) = words.take(letter) else {
                continue;
            };
            if row == third {
                if value == 0.0 {
                    continue;
                }
                let message = format!("{} lies across the plane of the arc", char::from(letter));
                return Err(self.refuse("nc-arc", message));
            }
            told = true;
            let own = words.absolute & bit(letter) != 0;
            centre[row] = if absolute || own { value * unit } else { from[row] + value * unit };
        }
        let flat = |point: Vector3<f64>| [point[first], point[second]];
        let full_turns = self.further_turns(clockwise, words)?;
        if let (Some(radius), false) = (radius, told) {
            let [cx, cy] = self.centre_by_radius(flat(from), flat(to), radius, clockwise)?;
            centre[first] = cx;
            centre[second] = cy;
        } else if !told {
            return Err(self.refuse("nc-arc", "the arc has neither a centre nor a radius"));
        } else if radius.is_some() {
            return Err(self.refuse("nc-arc", "the arc has both a centre and a radius"));
        }
        let mut sweep = self.sweep([flat(from), flat(to), flat(centre)], clockwise)?;
        sweep += if clockwise { -full_turns * TAU } else { full_turns * TAU };
        centre[third] = from[third];
        Ok(Curve::Arc { centre, normal: self.modal.plane.normal(), sweep })
    }

    /// Full turns beside the arc's own: `TURN=2`, or P of RS-274/NGC, which counts the last part of a turn too.
    fn further_turns(
        &self,
        clockwise: bool,
        words: &mut BlockWords,
    ) -> Result<f64, Box<Diagnostic>> {
        let code = GCode::whole(if clockwise { 2 } else { 3 });
        let counted = self.lexicon.letter_beside(code, b'P') == Some(Meaning::Turns);
        let turns = match words.turns {
            Some(turns) => turns,
            None if counted => words.take(b'P').map_or(0.0, |turns| turns - 1.0),
            None => 0.0,
        };
        if !(0.0..=MOST_TURNS).contains(&turns) || turns != libm::floor(turns) {
            return Err(self.refuse("nc-arc", format!("{turns} is no number of full turns")));
        }
        Ok(turns)
    }

    /// The turn from a start to an end about a centre, radians, counter-clockwise positive; a full one where they are
    /// the same.
    pub(super) fn sweep(
        &self,
        [[x0, y0], [x1, y1], [x, y]]: [[f64; 2]; 3],
        clockwise: bool,
    ) -> Result<f64, Box<Diagnostic>> {
        let (ax, ay) = (x0 - x, y0 - y);
        let (bx, by) = (x1 - x, y1 - y);
        let (start, end) = (libm::hypot(ax, ay), libm::hypot(bx, by));
        if libm::fabs(start - end) > OFF[0] + OFF[1] * start || start == 0.0 {
            let message = format!(
                "the arc begins {start:.4} mm from its centre and ends {end:.4} mm from it"
            );
            return Err(self.refuse("nc-arc", message));
        }
        let turn = libm::atan2(ax * by - ay * bx, ax * bx + ay * by);
        let same = libm::hypot(x1 - x0, y1 - y0) < SAME;
        Ok(if same {
            if clockwise { -TAU } else { TAU }
        } else if clockwise {
            if turn >= 0.0 { turn - TAU } else { turn }
        } else if turn <= 0.0 {
            turn + TAU
        } else {
            turn
        })
    }

    /// The centre of the arc of this radius; of the two the one whose arc is shorter than half a turn, or longer if the
    /// radius is negative.
    pub(super) fn centre_by_radius(
        &self,
        [x0, y0]: [f64; 2],
        [x1, y1]: [f64; 2],
        radius: f64,
        clockwise: bool,
    ) -> Result<[f64; 2], Box<Diagnostic>> {
        let (dx, dy) = (x1 - x0, y1 - y0);
        let chord = libm::hypot(dx, dy);
        if chord < 1e-9 {
            return Err(
                self.refuse("nc-arc", "an arc by its radius ends where it begins: it might be any")
            );
        }
        let half = 0.5 * chord;
        let size = libm::fabs(radius);
        if half > size + OFF[0] + OFF[1] * size {
            let message = format!(
                "the radius {size:.4} mm does not reach from the start of the arc to its end, {chord:.4} mm away"
            );
            return Err(self.refuse("nc-arc", message));
        }
        let height = (size * size - half * half).max(0.0).sqrt();
        // The centre of a short counter-clockwise arc lies to the left of its chord.
        let side = if clockwise == (radius < 0.0) { 1.0 } else { -1.0 };
        let (nx, ny) = (-dy / chord, dx / chord);
        Ok([0.5 * (x0 + x1) + side * height * nx, 0.5 * (y0 + y1) + side * height * ny])
    }
}
