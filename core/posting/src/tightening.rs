//! Where a plan may use less than its limit of the contour error: what a prediction of an earlier program has found.
//!
//! The formula that plans go by is that of the steady state; where curvature comes and goes faster than servos settle, they
//! stray by more. Such a place is known by the line of the CL file and by where the tip is there: the same line may be
//! passed often (a copied operation), and a long one may be wrong at one end alone.
//!
//! Memory: 32 bytes a place, some places a mm of path that is tightened, none where nothing is.

use nalgebra::Vector3;
use post_motion::path::nearest_share;

/// A piece of the path that may use no more than a share of the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TightPlace {
    /// Line of the CL file.
    pub line: u64,
    /// Middle of the piece: the tip, mm, part frame.
    pub tip: [f32; 3],
    /// Reach of the piece around its middle, mm.
    pub reach: f32,
    /// Share of the limit, above 0 and up to 1.
    pub share: f32,
}

impl TightPlace {
    /// Whether it meets the straight way between two places of the tip.
    fn reaches(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> bool {
        let middle = Vector3::from(self.tip.map(f64::from));
        distance(&middle, from, to) <= f64::from(self.reach)
    }
}

/// The places that are to have less contour error than the limit allows.
///
/// What several rounds have found multiplies; where places of one round overlap, the smallest share counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tightening {
    /// Round by round, sorted by line.
    rounds: Vec<Vec<TightPlace>>,
}

impl Tightening {
    /// Takes what one more round has found.
    pub fn push(&mut self, mut places: Vec<TightPlace>) {
        // A stable order: the same on every machine.
        places.sort_by_key(|place| place.line);
        if !places.is_empty() {
            self.rounds.push(places);
        }
    }

    /// Nothing is tightened.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rounds.is_empty()
    }

    /// Places, all rounds together.
    #[must_use]
    pub fn places(&self) -> usize {
        self.rounds.iter().map(Vec::len).sum()
    }

    /// Whether any place lies on a line.
    #[must_use]
    pub fn concerns(&self, line: u64) -> bool {
        self.rounds.iter().any(|places| !on(places, line).is_empty())
    }

    /// The share of the limit that may be used where the tip stands at `tip` (mm, part frame) and carries out a line of
    /// the CL file; 1 where nothing is tightened.
    #[must_use]
    pub fn share(&self, line: u64, tip: &Vector3<f64>) -> f64 {
        self.least(line, tip, tip)
    }

    /// How many rounds have tightened the path where the tip stands at `tip` and carries out a line of the CL file.
    #[must_use]
    pub fn rounds_at(&self, line: u64, tip: &Vector3<f64>) -> usize {
        let near = |place: &TightPlace| place.reaches(tip, tip);
        let tightened = |places: &&Vec<TightPlace>| on(places, line).iter().any(near);
        self.rounds.iter().filter(tightened).count()
    }

    /// The smallest share anywhere on the straight way of the tip from `from` to `to` while it carries out a line.
    #[must_use]
    pub fn least(&self, line: u64, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
        self.rounds
            .iter()
            .map(|places| {
                let near = on(places, line).iter().filter(|place| place.reaches(from, to));
                near.fold(1.0, |least: f64, place| least.min(f64::from(place.share)))
            })
            .product()
    }
}

/// Places on a line of the CL file, of places sorted by line.
fn on(places: &[TightPlace], line: u64) -> &[TightPlace] {
    let first = places.partition_point(|place| place.line < line);
    let count = places[first..].partition_point(|place| place.line == line);
    &places[first..first + count]
}

/// Distance of a point from the straight way between two others, mm.
fn distance(point: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    (point - from - (to - from) * nearest_share([from, to], point)).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(line: u64, x: f32, share: f32) -> TightPlace {
        TightPlace { line, tip: [x, 0.0, 0.0], reach: 1.0, share }
    }

    fn at(x: f64) -> Vector3<f64> {
        Vector3::new(x, 0.0, 0.0)
    }

    #[test]
    fn a_place_counts_on_its_line_and_as_far_as_it_reaches() {
        let mut tightening = Tightening::default();
        assert!(tightening.is_empty());
        assert_eq!(tightening.share(7, &at(0.0)), 1.0);
        tightening.push(vec![place(9, 5.0, 0.25), place(7, 0.0, 0.5), place(7, 1.5, 0.75)]);
        assert_eq!(tightening.share(7, &at(-0.5)), 0.5);
        assert_eq!(tightening.share(7, &at(1.0)), 0.5);
        assert_eq!(tightening.share(7, &at(2.0)), 0.75);
        assert_eq!(tightening.share(7, &at(2.6)), 1.0);
        assert_eq!(tightening.share(8, &at(0.0)), 1.0);
        assert!(tightening.concerns(9) && !tightening.concerns(8));
        // A later round counts on top of it.
        tightening.push(vec![place(7, 0.0, 0.5)]);
        assert_eq!(tightening.share(7, &at(0.0)), 0.25);
        assert_eq!(tightening.share(9, &at(5.0)), 0.25);
        let rounds = [0.0, 2.0, 5.0].map(|x| tightening.rounds_at(7, &at(x)));
        assert_eq!(rounds, [2, 1, 0]);
        assert_eq!(tightening.places(), 4);
        // A round that has found nothing is not kept.
        tightening.push(Vec::new());
        assert_eq!(tightening.share(7, &at(0.0)), 0.25);
    }

    #[test]
    fn on_a_way_the_smallest_share_counts() {
        let mut tightening = Tightening::default();
        tightening.push(vec![place(7, 0.0, 0.5), place(7, 10.0, 0.25)]);
        assert_eq!(tightening.least(7, &at(-50.0), &at(50.0)), 0.25);
        assert_eq!(tightening.least(7, &at(-50.0), &at(5.0)), 0.5);
        assert_eq!(tightening.least(7, &at(3.0), &at(5.0)), 1.0);
        assert_eq!(tightening.least(7, &at(0.5), &at(0.5)), 0.5);
    }
}
