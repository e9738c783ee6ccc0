//! The path of the tip in cuts with its contour error, in a room that does not grow with it.

use crate::predict::Sample;

/// Spots that are kept.
const MOST_SPOTS: usize = 4000;

/// Where the error is largest on a share of the way.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// Which cut it belongs to: between two of them the tool goes at rapid.
    pub cut: u64,
    /// The place of the path that the tool is nearest to, mm, part frame.
    pub tip: [f64; 3],
    /// How far it is off, mm, part frame.
    pub error: [f64; 3],
    /// How far that is, mm.
    pub size: f64,
}

/// The path.
#[derive(Clone, Debug)]
pub struct Trail {
    /// One on each share of the way at most; none where no set-point falls into it.
    shares: Vec<Option<Spot>>,
    /// Way of a share, mm.
    width: f64,
    /// Way of the tip in cuts, mm.
    pub way: f64,
    cut: u64,
    last: Option<[f64; 3]>,
}

impl Trail {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self { shares: Vec::new(), width: 1e-3, way: 0.0, cut: 0, last: None }
    }

    /// Takes the next set-point.
    pub fn take(&mut self, sample: &Sample) {
        if !sample.counts() {
            if self.last.take().is_some() {
                self.cut += 1;
            }
            return;
        }
        let tip: [f64; 3] = sample.point.commanded.tip.into();
        if let Some(last) = self.last.replace(tip) {
            let squares = last.iter().zip(tip).map(|(a, b)| (b - a) * (b - a));
            self.way += libm::sqrt(squares.sum());
        }
        let mut place = (self.way / self.width) as usize;
        while place >= MOST_SPOTS {
            let pairs = self.shares.chunks(2);
            self.shares =
                pairs.map(|pair| pair.iter().fold(None, |all, spot| worse(all, *spot))).collect();
            self.width *= 2.0;
            place = (self.way / self.width) as usize;
        }
        if self.shares.len() <= place {
            self.shares.resize(place + 1, None);
        }
        let (actual, error) = (sample.point.actual.tip, sample.error());
        let spot = Spot {
            cut: self.cut,
            tip: std::array::from_fn(|axis| actual[axis] - error[axis]),
            error,
            size: sample.size(),
        };
        self.shares[place] = worse(self.shares[place], Some(spot));
    }

    /// All spots in the order of the path, cut by cut.
    pub fn cuts(&self) -> Vec<Vec<Spot>> {
        let mut cuts: Vec<Vec<Spot>> = Vec::new();
        for spot in self.shares.iter().flatten() {
            match cuts.last_mut() {
                Some(cut) if cut[0].cut == spot.cut => cut.push(*spot),
                _ => cuts.push(vec![*spot]),
            }
        }
        cuts
    }
}

/// The one with the larger error, the first of equals.
fn worse(a: Option<Spot>, b: Option<Spot>) -> Option<Spot> {
    match (a, b) {
        (Some(first), Some(second)) if second.size > first.size => Some(second),
        (Some(first), _) => Some(first),
        (None, second) => second,
    }
}
