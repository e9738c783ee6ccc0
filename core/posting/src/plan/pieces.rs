//! Where the feed of a block changes: the plan along it, cut into pieces of one feed each.

/// Slower than this share of the fastest place of a piece, the tool counts as standing: there it comes from rest, or
/// comes to rest, by the control's own acceleration.
pub(super) const STANDING: f64 = 0.02;

/// No piece is slower than this share of its mean speed by the plan.
const SLOWEST: f64 = 0.3;

/// A plan is evaluated wherever its speed has changed by this share.
const STEP: f64 = 0.05;

/// Places between two samples at most.
const MOST: f64 = 64.0;

/// Number of places beside those where the speed changes that may be ends of pieces.
const AROUND: usize = 5;

/// Places at which a block may be cut, at most.
const MOST_ENDS: usize = 96;

/// How blocks are cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutThresholds {
    /// A cut saves at least this time, s.
    pub saving: f64,
    /// No piece takes less, s.
    pub shortest: f64,
}

/// A piece of a block with one feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FeedPiece {
    /// Where it ends, as a share of the block.
    pub end: f64,
    /// Speed of the tip, mm/s, or of the parameter, per second.
    pub speed: f64,
}

/// The plan at a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanSample {
    /// Parameter from the start of the block.
    pub at: f64,
    /// Squared speed of the parameter.
    pub q: f64,
    /// Speed of the tip for that of the parameter.
    pub stretch: f64,
    /// Time from the sample before, s.
    pub seconds: f64,
}

/// The plan along a block.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockProfile {
    samples: Vec<PlanSample>,
    /// The speed is that of the tip, which the curve passes the block with; else that of the parameter.
    by_tip: bool,
    /// Samples and places between them, closer where the speed changes: place and speed.
    places: Vec<(f64, f64)>,
    /// What the plan takes up to each of them, s.
    clock: Vec<f64>,
    /// The way as speeds count for that of the parameter.
    scale: f64,
    /// Time that the tool may be left to the control when it comes from rest, or to it, s.
    leaving: f64,
    /// Places where pieces may end, and the cheapest way to each: its cost, and the end before.
    ends: Vec<usize>,
    ways: Vec<(f64, usize)>,
}

impl BlockProfile {
    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.samples.clear();
    }

    /// Forgets the block before, at whose end the next one begins.
    pub(super) fn begin(&mut self) {
        let last = self.samples.last().copied();
        self.samples.clear();
        self.samples.extend(last.map(|last| PlanSample { at: 0.0, seconds: 0.0, ..last }));
    }

    /// The plan goes on.
    pub(super) fn push(&mut self, sample: PlanSample) {
        self.samples.push(sample);
    }

    /// Halfway from the last sample to a place and stretch the plan has this squared speed, after so long.
    pub(super) fn halfway(&mut self, at: f64, q: f64, stretch: f64, seconds: f64) {
        if let Some(last) = self.samples.last() {
            let middle = PlanSample {
                at: last.at.midpoint(at),
                q,
                stretch: last.stretch.midpoint(stretch),
                seconds,
            };
            self.samples.push(middle);
        }
    }

    /// The last sample.
    pub(super) fn last(&self) -> Option<PlanSample> {
        self.samples.last().copied()
    }

    /// The ends of the last way of the plan, which has a place halfway, or none.
    pub(super) fn ends_of_way(&self, halfway: bool) -> Option<[PlanSample; 2]> {
        let back = if halfway { 3 } else { 2 };
        let from = self.samples.len().checked_sub(back)?;
        Some([self.samples[from], *self.samples.last()?])
    }

    /// Speeds are those of the tip, or those of the parameter.
    pub(super) fn measure(&mut self, by_tip: bool) {
        self.by_tip = by_tip;
    }

    /// The length of the block, in units of the parameter.
    pub(super) fn length(&self) -> f64 {
        self.samples.last().map_or(0.0, |sample| sample.at)
    }

    /// What the plan takes, s.
    pub(super) fn seconds(&self) -> f64 {
        self.samples.iter().map(|sample| sample.seconds).sum()
    }

    /// The whole of it at one speed, which the plan has nowhere less of, but for where the tool comes from rest or to it.
    pub(super) fn whole(&mut self, length: f64) -> Option<FeedPiece> {
        self.leaving = f64::INFINITY;
        self.refine(STEP);
        self.tell_time(length);
        let last = self.places.len().checked_sub(1)?;
        Some(self.piece(0, last))
    }

    /// Cuts the block wherever that saves enough time, as far as no piece gets too short: of all ways to cut it the one
    /// that takes least. `length` is the way of the block as its speed counts; `can_end` says whether a piece can end at a
    /// share of the block.
    pub(super) fn pieces(
        &mut self,
        cutting: &CutThresholds,
        length: f64,
        can_end: &dyn Fn(f64) -> bool,
        out: &mut Vec<FeedPiece>,
    ) {
        out.clear();
        self.leaving = cutting.shortest;
        self.refine(STEP);
        let Some(last) = self.places.len().checked_sub(1).filter(|last| *last > 0) else {
            return;
        };
        self.tell_time(length);
        let scale = self.scale;
        let whole = scale * self.length() / self.speed(0, last);
        if whole.max(self.clock[last]) - self.clock[last] < cutting.saving {
            out.push(self.piece(0, last));
            return;
        }
        self.thin(last, can_end);
        self.cheapest(cutting, scale);
        let mut to = self.ends.len() - 1;
        while to > 0 {
            let from = self.ways[to].1;
            out.push(self.piece(self.ends[from], self.ends[to]));
            to = from;
        }
        out.reverse();
    }

    /// What the plan takes up to each place, of a way of this length.
    fn tell_time(&mut self, length: f64) {
        self.scale = length / self.length();
        self.clock.clear();
        self.clock.push(0.0);
        for pair in self.places.windows(2) {
            let seconds = 2.0 * self.scale * (pair[1].0 - pair[0].0) / (pair[0].1 + pair[1].1);
            let so_far = self.clock.last().copied().unwrap_or_default();
            self.clock.push(so_far + seconds);
        }
    }

    /// Where pieces may end: not in the midst of an even stretch, and not at so many places that looking at each pair
    /// takes long.
    fn thin(&mut self, last: usize, can_end: &dyn Fn(f64) -> bool) {
        let places = &self.places;
        let changes = |at: usize| {
            let around = [places[at - 1].1, places[at + 1].1];
            around.iter().any(|speed| (speed - places[at].1).abs() > 0.1 * STEP * places[at].1)
        };
        // A slow end may be shorter than the shortest piece, which then goes on into what is even.
        let near = |at: &usize| {
            let around = at.saturating_sub(AROUND).max(1)..(at + AROUND + 1).min(last);
            around.into_iter().any(changes)
        };
        let count = (1..last).filter(near).count();
        let every = count.div_ceil(MOST_ENDS).max(1);
        self.ends.clear();
        self.ends.push(0);
        let length = self.length();
        let possible = (1..last).filter(near).step_by(every);
        let possible = possible.filter(|at| can_end(places[*at].0 / length));
        self.ends.extend(possible);
        self.ends.push(last);
    }

    /// The cheapest way to each place where a piece may end: what its pieces take, and what cuts must save.
    fn cheapest(&mut self, cutting: &CutThresholds, scale: f64) {
        self.ways.clear();
        self.ways.push((0.0, 0));
        let last = self.ends.len() - 1;
        for to in 1..=last {
            let mut best = (f64::INFINITY, 0);
            for from in (0..to).rev() {
                let [start, end] = [self.ends[from], self.ends[to]];
                let whole = from == 0 && to == last;
                let way = self.places[end].0 - self.places[start].0;
                let seconds = scale * way / self.speed(start, end);
                if !whole && seconds < cutting.shortest {
                    continue;
                }
                // From rest and to it the control takes what the plan does.
                let seconds = seconds.max(self.clock[end] - self.clock[start]);
                let cost = self.ways[from].0 + seconds + cutting.saving;
                if cost < best.0 {
                    best = (cost, from);
                }
            }
            self.ways.push(best);
        }
    }

    /// Puts places between samples, so close that the speed changes by a part of `step`; from rest and to it evenly.
    fn refine(&mut self, step: f64) {
        self.places.clear();
        let speed = |speed: f64, stretch: f64| if self.by_tip { speed * stretch } else { speed };
        let mut last: Option<PlanSample> = None;
        for sample in &self.samples {
            let root = sample.q.sqrt();
            let here = speed(root, sample.stretch);
            if let Some(from) = last.replace(*sample) {
                let start = from.q.sqrt();
                let before = speed(start, from.stretch);
                let [slow, fast] = [before.min(here), before.max(here)];
                let ratio = fast / slow.max(STANDING * fast).max(f64::MIN_POSITIVE);
                let count = libm::log(ratio) / libm::log1p(step);
                let count = libm::ceil(count).clamp(1.0, MOST);
                for place in 1..count as u32 {
                    // The speeds are even, so that no place is far faster than the one before; their squares are linear.
                    let share = f64::from(place) / count;
                    let middle = start + (root - start) * share;
                    let part = (start + middle) * share / (start + root);
                    let stretch = from.stretch + (sample.stretch - from.stretch) * part;
                    let at = from.at + (sample.at - from.at) * part;
                    self.places.push((at, speed(middle, stretch)));
                }
            }
            self.places.push((sample.at, here));
        }
    }

    fn piece(&self, from: usize, to: usize) -> FeedPiece {
        FeedPiece { end: self.places[to].0 / self.length(), speed: self.speed(from, to) }
    }

    /// The speed of a piece: the least between its ends, but for places where the tool nearly stands, which are left to
    /// the control's own acceleration: no piece takes far longer than it is planned.
    fn speed(&self, from: usize, to: usize) -> f64 {
        let planned = self.clock[to] - self.clock[from];
        let way = (self.places[to].0 - self.places[from].0) * self.scale;
        self.least(from, to).max(SLOWEST * way / planned)
    }

    /// The least speed between two places, but for the way from rest up to the first height and down from the last one.
    fn least(&self, from: usize, to: usize) -> f64 {
        let places = &self.places[from..=to];
        let speed = |place: usize| places[place].1;
        let clock = |place: usize| self.clock[from + place];
        let most = places.iter().fold(0.0, |most: f64, place| most.max(place.1));
        let standing = |place: usize| speed(place) <= STANDING * most;
        let last = places.len() - 1;
        let (mut first, mut behind) = (0, last);
        if standing(0) {
            while first < last
                && speed(first + 1) >= speed(first)
                && clock(first) - clock(0) < self.leaving
            {
                first += 1;
            }
        }
        if standing(last) {
            while behind > 0
                && speed(behind - 1) >= speed(behind)
                && clock(last) - clock(behind) < self.leaving
            {
                behind -= 1;
            }
        }
        let between = places[first.min(behind)..=first.max(behind)].iter();
        between.fold(f64::INFINITY, |least, place| least.min(place.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUTTING: CutThresholds = CutThresholds { saving: 0.001, shortest: 0.005 };

    fn profile(samples: &[(f64, f64)]) -> BlockProfile {
        let mut profile = BlockProfile::default();
        let mut before: Option<(f64, f64)> = None;
        for &(at, speed) in samples {
            let from = before.replace((at, speed));
            profile.push(PlanSample {
                at,
                q: speed * speed,
                stretch: 1.0,
                seconds: from.map_or(0.0, |from| 2.0 * (at - from.0) / (from.1 + speed)),
            });
        }
        profile
    }

    fn pieces(profile: &mut BlockProfile) -> Vec<FeedPiece> {
        let mut out = Vec::new();
        let length = profile.length();
        profile.pieces(&CUTTING, length, &|_| true, &mut out);
        out
    }

    #[test]
    fn an_even_plan_is_one_piece() {
        let mut plan = profile(&[(0.0, 20.0), (4.0, 20.0), (10.0, 20.0)]);
        let piece = FeedPiece { end: 1.0, speed: 20.0 };
        assert_eq!(pieces(&mut plan), [piece]);
        assert_eq!(plan.whole(10.0), Some(piece));
    }

    /// 1000 mm/s² from rest to 100 mm/s, and down again.
    #[test]
    fn no_piece_is_faster_than_the_plan_but_where_the_tool_comes_from_rest() {
        let mut plan = profile(&[(0.0, 0.0), (5.0, 100.0), (45.0, 100.0), (50.0, 0.0)]);
        let found = pieces(&mut plan);
        assert!(found.len() > 6, "{found:?}");
        let planned = |at: f64| (2000.0 * at.min(50.0 - at)).sqrt().min(100.0);
        let mut start = 0.0;
        for (index, piece) in found.iter().enumerate() {
            let end = 50.0 * piece.end;
            let ends = [start, end].map(planned);
            let slower = ends[0].min(ends[1]);
            let at_rest = index == 0 || index + 1 == found.len();
            let most = if at_rest { ends[0].max(ends[1]) } else { slower };
            assert!(piece.speed <= most + 1e-9, "{piece:?} {ends:?}");
            assert!(ends[0].max(ends[1]) <= 2.0 * piece.speed, "{piece:?} {ends:?}");
            start = end;
        }
        assert_eq!(start, 50.0);
        // What it costs: some per cent of the ways on which the speed changes.
        let mut from = 0.0;
        let mut seconds = 0.0;
        for piece in &found {
            seconds += 50.0 * (piece.end - from) / piece.speed;
            from = piece.end;
        }
        assert!(seconds < 1.05 * plan.seconds(), "{seconds} {}", plan.seconds());
    }

    #[test]
    fn a_short_block_from_rest_to_rest_has_the_feed_of_its_height() {
        let mut plan = profile(&[(0.0, 0.0), (0.01, 10.0), (0.02, 0.0)]);
        assert_eq!(pieces(&mut plan), [FeedPiece { end: 1.0, speed: 10.0 }]);
        assert!((plan.seconds() - 0.004).abs() < 1e-12);
    }

    #[test]
    fn a_dip_in_the_middle_is_kept() {
        let mut plan = profile(&[(0.0, 50.0), (5.0, 10.0), (10.0, 50.0)]);
        let least = plan.whole(10.0).map(|piece| piece.speed);
        assert_eq!(least, Some(10.0));
        let found = pieces(&mut plan);
        let slowest = found.iter().fold(f64::INFINITY, |least, piece| least.min(piece.speed));
        assert!((slowest - 10.0).abs() < 1e-9 && found.len() >= 7, "{found:?}");
    }
}
