//! Cost of a path through the trellis: first what should not be at all, then how far the axes travel.

/// Costs are compared place by place: ways that hit something, rewinds, points on a side that is not preferred, travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PathCost {
    hits: u32,
    rewinds: u32,
    against: u32,
    /// Travel as [`super::metric::TravelMeasure`] counts it; infinite where there is no way.
    travel: f64,
}

/// A tie is decided by order: travels differ if they differ by more than this share.
const EQUAL: f64 = 1e-9;

impl PathCost {
    pub(crate) const NONE: Self = Self { hits: 0, rewinds: 0, against: 0, travel: 0.0 };
    pub(crate) const NO_WAY: Self = Self { travel: f64::INFINITY, ..Self::NONE };

    /// Whether there is a way.
    #[inline]
    pub(crate) fn is_way(&self) -> bool {
        self.travel < f64::INFINITY
    }

    /// Adds `travel`, and the number of axes on a side that is not preferred.
    #[inline]
    pub(crate) fn and(self, travel: f64, against: u32) -> Self {
        Self { against: self.against + against, travel: self.travel + travel, ..self }
    }

    /// Adds ways on which bodies are not clear of one another.
    #[inline]
    pub(crate) fn and_hits(self, hits: u32) -> Self {
        Self { hits: self.hits + hits, ..self }
    }

    /// Ways that hit something.
    pub(crate) fn hits(&self) -> u32 {
        self.hits
    }

    /// Goes on by a rewind.
    pub(crate) fn and_rewind(self, travel: f64) -> Self {
        Self { rewinds: self.rewinds + 1, ..self.and(travel, 0) }
    }

    /// What is left of it when every way has cost `base` so far.
    pub(crate) fn beyond(self, base: &Self) -> Self {
        Self {
            hits: self.hits.saturating_sub(base.hits),
            rewinds: self.rewinds.saturating_sub(base.rewinds),
            against: self.against.saturating_sub(base.against),
            travel: self.travel - base.travel,
        }
    }

    /// Whether it is less than `other`, and not by rounding alone.
    #[inline]
    pub(crate) fn less(&self, other: &Self) -> bool {
        if !self.is_way() || !other.is_way() {
            return self.is_way();
        }
        let penalty = (self.hits, self.rewinds, self.against);
        let other_penalty = (other.hits, other.rewinds, other.against);
        if penalty != other_penalty {
            return penalty < other_penalty;
        }
        self.travel + EQUAL * (1.0 + self.travel.abs()) < other.travel
    }

    /// Order for sorting.
    pub(crate) fn order(&self, other: &Self) -> std::cmp::Ordering {
        let key = |cost: &Self| (!cost.is_way(), cost.hits, cost.rewinds, cost.against);
        key(self).cmp(&key(other)).then(self.travel.total_cmp(&other.travel))
    }
}
