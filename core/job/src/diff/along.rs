//! What is drawn of two paths, in a room that does not grow with them.

use post_readback::diff::PathPair;

/// Points of a path that are kept.
const MOST_POINTS: usize = 40_000;

/// Shares of the way that are told apart.
const MOST_BINS: usize = 1200;

/// Both paths, and how they differ along the way.
pub struct PathComparison {
    /// The old path and the new one.
    pub paths: [Path; 2],
    /// Along the way of the old one.
    pub bins: Vec<Bin>,
    /// Way of a share, mm.
    pub width: f64,
    way: f64,
    /// Where operations begin, mm along the way.
    pub begins: Vec<f64>,
    operation: usize,
}

/// Pieces of a path, each with whether it is cut.
pub struct Path {
    /// Points of a piece, mm.
    pub pieces: Vec<(bool, Vec<[f64; 3]>)>,
    points: usize,
    /// Points nearer than this to the one before are left out, mm.
    apart: f64,
    last: Option<[f64; 3]>,
}

/// What is largest on a share of the way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Bin {
    /// Distance of the tips, mm.
    pub tip: f64,
    /// Angle between the tool axes, degrees.
    pub axis: f64,
    /// Feeds of both, mm/min.
    pub feeds: [f64; 2],
}

impl PathComparison {
    /// Of nothing yet; points nearer than `apart`, mm, are left out.
    pub fn new(apart: f64) -> Self {
        let path = || Path { pieces: Vec::new(), points: 0, apart, last: None };
        Self {
            paths: [path(), path()],
            bins: Vec::new(),
            width: 0.01,
            way: 0.0,
            begins: Vec::new(),
            operation: 0,
        }
    }

    /// A pair of places.
    pub fn take(&mut self, sample: &PathPair) {
        if sample.operation != self.operation {
            self.operation = sample.operation;
            self.begins.push(self.way);
        }
        for ((path, tip), feed) in self.paths.iter_mut().zip(sample.tips).zip(sample.feeds) {
            if let Some(tip) = tip {
                path.take(tip, feed > 0.0);
            }
        }
        self.way += sample.way;
        let mut place = (self.way / self.width) as usize;
        while place >= MOST_BINS {
            self.halve();
            place = (self.way / self.width) as usize;
        }
        if self.bins.len() <= place {
            self.bins.resize(place + 1, Bin::default());
        }
        self.bins[place] =
            self.bins[place].with(Bin { tip: sample.tip, axis: sample.axis, feeds: sample.feeds });
    }

    fn halve(&mut self) {
        let pairs = self.bins.chunks(2);
        self.bins =
            pairs.map(|pair| pair.iter().fold(Bin::default(), |all, bin| all.with(*bin))).collect();
        self.width *= 2.0;
    }
}

impl Bin {
    fn with(self, other: Bin) -> Bin {
        Bin {
            tip: self.tip.max(other.tip),
            axis: self.axis.max(other.axis),
            feeds: [0, 1].map(|side| self.feeds[side].max(other.feeds[side])),
        }
    }
}

impl Path {
    fn take(&mut self, tip: [f64; 3], cut: bool) {
        let same = self.pieces.last().is_some_and(|(known, _)| *known == cut);
        let apart = self.last.is_none_or(|last| distance(last, tip) >= self.apart);
        if same && !apart {
            return;
        }
        if !same {
            let from = self.last;
            self.pieces.push((cut, from.into_iter().collect()));
        }
        if let Some((_, points)) = self.pieces.last_mut() {
            points.push(tip);
        }
        self.last = Some(tip);
        self.points += 1;
        if self.points > MOST_POINTS {
            self.thin();
        }
    }

    /// Leaves out every other point within the pieces.
    fn thin(&mut self) {
        self.apart *= 2.0;
        for (_, points) in &mut self.pieces {
            let last = points.len().saturating_sub(1);
            let mut place = 0;
            points.retain(|_| {
                place += 1;
                place == 1 || place == last + 1 || place % 2 == 1
            });
        }
        self.points = self.pieces.iter().map(|(_, points)| points.len()).sum();
        if self.points > MOST_POINTS {
            // Pieces of two points each: of so many, every other is seen.
            let mut place = 0;
            self.pieces.retain(|_| {
                place += 1;
                place % 2 == 1
            });
            self.points = self.pieces.iter().map(|(_, points)| points.len()).sum();
        }
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    libm::sqrt(squares.sum())
}
