//! What is left along the prisms of a grid in one direction.

use nalgebra::Vector3;

/// A grid of cells along X, Y and Z, its low corner at the origin.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Edges of a cell, mm.
    pub cell: Vector3<f64>,
    /// Cells along each axis.
    pub counts: [usize; 3],
}

impl Grid {
    /// A stretch of a prism along Z, from corner to corner, mm.
    pub(crate) fn block(
        &self,
        [column, row]: [usize; 2],
        [low, high]: Stretch,
    ) -> [Vector3<f64>; 2] {
        let low = Vector3::new(column as f64 * self.cell.x, row as f64 * self.cell.y, low);
        [low, Vector3::new(low.x + self.cell.x, low.y + self.cell.y, high)]
    }
}

/// Which of the two bounds on what is left numbers are of: they are rounded so that it stays one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// All that may be left: what is taken away is gone for certain.
    Upper,
    /// What is left for certain.
    Lower,
}

/// A part of a prism that is left, from its low end to its high one, mm.
pub type Span = [f32; 2];

/// A stretch along a line, mm.
pub type Stretch = [f64; 2];

/// Spans that a prism has at most, so that memory is bounded by the field and not by the program.
const MOST_SPANS: usize = 32;

/// Numbers are rounded by less than this, mm.
const SLIVER: f64 = 1e-4;

fn rounded_down(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) > value { near.next_down() } else { near }
}

fn rounded_up(value: f64) -> f32 {
    -rounded_down(-value)
}

impl Bound {
    /// The span of a stretch of which this is a bound.
    pub fn span(self, [low, high]: Stretch) -> Span {
        match self {
            Self::Upper => [rounded_down(low), rounded_up(high)],
            Self::Lower => [rounded_up(low), rounded_down(high)],
        }
    }

    /// Takes a stretch away from what is left; how much of it was left, mm.
    fn take(self, spans: &mut Vec<Span>, cut: Stretch) -> f64 {
        let before = length(spans);
        let touched = |span: &Span| f64::from(span[1]) > cut[0] && f64::from(span[0]) < cut[1];
        // What is kept below the cut ends at its low end.
        let [to, from] = match self {
            Self::Upper => [rounded_up(cut[0]), rounded_down(cut[1])],
            Self::Lower => [rounded_down(cut[0]), rounded_up(cut[1])],
        };
        let Some(first) = spans.iter().position(touched) else { return 0.0 };
        let count = spans[first..].iter().take_while(|span| touched(span)).count();
        let [low, high] = [spans[first][0], spans[first + count - 1][1]];
        let kept = [[low, to.min(high)], [from.max(low), high]];
        let kept = kept.into_iter().filter(|[low, high]| low < high);
        match (self, kept.clone().collect::<Vec<_>>().as_slice()) {
            // Rounded towards one another they may have met.
            (Self::Upper, [one, other]) if one[1] >= other[0] => {}
            _ => drop(spans.splice(first..first + count, kept)),
        }
        self.hold_down(spans);
        (before - length(spans)).max(0.0)
    }

    /// Keeps to [`MOST_SPANS`]: the narrowest gap counts as left, or the shortest span as gone.
    fn hold_down(self, spans: &mut Vec<Span>) {
        while spans.len() > MOST_SPANS {
            let shortest = |sizes: &mut dyn Iterator<Item = f32>| {
                let least = sizes.enumerate().min_by(|one, other| one.1.total_cmp(&other.1));
                least.map_or(0, |(place, _)| place)
            };
            match self {
                Self::Upper => {
                    let mut gaps = spans.windows(2).map(|pair| pair[1][0] - pair[0][1]);
                    let place = shortest(&mut gaps);
                    spans[place][1] = spans[place + 1][1];
                    spans.remove(place + 1);
                }
                Self::Lower => {
                    let place = shortest(&mut spans.iter().map(|[low, high]| high - low));
                    spans.remove(place);
                }
            }
        }
    }
}

/// What of spans lies within a stretch, but for what rounding leaves.
pub(crate) fn within(spans: &[Span], [from, to]: Stretch) -> impl Iterator<Item = Stretch> {
    let cut = move |span: &Span| {
        let [low, high] = span.map(f64::from);
        [low.max(from), high.min(to)]
    };
    spans.iter().map(cut).filter(|[low, high]| high - low > SLIVER)
}

/// Length of what two rows of spans have in common within a stretch, mm.
pub(crate) fn common(one: &[Span], other: &[Span], [from, to]: Stretch) -> f64 {
    let pairs = one.iter().flat_map(|one| other.iter().map(move |other| [one, other]));
    let common = pairs.map(|[one, other]| {
        let low = f64::from(one[0].max(other[0])).max(from);
        (f64::from(one[1].min(other[1])).min(to) - low).max(0.0)
    });
    common.sum()
}

/// Length of spans, mm.
fn length(spans: &[Span]) -> f64 {
    spans.iter().map(|[low, high]| f64::from(*high) - f64::from(*low)).sum()
}

/// What is left in each of the prisms of a grid along one of its axes.
#[derive(Clone, Debug)]
pub struct Rays {
    axis: usize,
    /// Cells along the two axes of the section.
    counts: [usize; 2],
    cell: [f64; 2],
    /// Of all prisms, in rows along the first axis of the section.
    prisms: Vec<Prism>,
    /// What is left of a prism that nothing was taken of.
    whole: [Span; 1],
    bound: Bound,
}

/// What is left in a prism.
#[derive(Clone, Debug)]
enum Prism {
    /// All of it: most of a stock is never touched, and takes no memory of its own.
    Whole,
    /// Spans from low to high.
    Spans(Vec<Span>),
}

/// Who is told of what is taken: the place of a prism, what is left there before, and the stretch.
pub type Taken<'a> = &'a mut dyn FnMut([usize; 2], &[Span], Stretch);

/// A line inside of a body, for the corner of a section: none where it misses it.
type Corner = Option<Stretch>;

impl Rays {
    /// Prisms along `axis` that nothing is left in.
    pub fn new(axis: usize, grid: &Grid, bound: Bound) -> Self {
        let section = [(axis + 1) % 3, (axis + 2) % 3];
        let counts = section.map(|axis| grid.counts[axis]);
        let cell = section.map(|axis| grid.cell[axis]);
        let prisms = vec![Prism::Spans(Vec::new()); counts[0] * counts[1]];
        Self { axis, counts, cell, prisms, whole: [[0.0; 2]], bound }
    }

    /// The axis along which they go.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// The axes of their section.
    pub fn section(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// How far any point of a section is from its middle, mm.
    pub fn half_diagonal(&self) -> f64 {
        0.5 * libm::hypot(self.cell[0], self.cell[1])
    }

    /// What is left in the prism at a place of the section.
    pub fn at(&self, place: [usize; 2]) -> &[Span] {
        match &self.prisms[place[1] * self.counts[0] + place[0]] {
            Prism::Whole => &self.whole,
            Prism::Spans(spans) => spans,
        }
    }

    /// Takes a stretch away in a prism; how much of it was left, mm.
    fn take(&mut self, place: [usize; 2], stretch: Stretch) -> f64 {
        let prism = &mut self.prisms[place[1] * self.counts[0] + place[0]];
        match prism {
            Prism::Spans(spans) => self.bound.take(spans, stretch),
            Prism::Whole => {
                let mut spans = self.whole.to_vec();
                let taken = self.bound.take(&mut spans, stretch);
                *prism = Prism::Spans(spans);
                taken
            }
        }
    }

    /// Sets what is left there, stretches from low to high.
    pub fn set(&mut self, place: [usize; 2], stretches: &[Stretch]) {
        let bound = self.bound;
        let spans = stretches.iter().map(|stretch| bound.span(*stretch));
        let spans = spans.filter(|[low, high]| low < high);
        self.prisms[place[1] * self.counts[0] + place[0]] = Prism::Spans(spans.collect());
    }

    /// Of all prisms the same stretch is left.
    pub fn fill_all(&mut self, stretch: Stretch) {
        self.whole = [self.bound.span(stretch)];
        self.prisms.fill(Prism::Whole);
    }

    /// Volume of what is left, mm³.
    pub fn volume(&self) -> f64 {
        let lengths = self.prisms.iter().map(|prism| match prism {
            Prism::Whole => length(&self.whole),
            Prism::Spans(spans) => length(spans),
        });
        lengths.sum::<f64>() * self.area()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let beside = self.prisms.iter().map(|prism| match prism {
            Prism::Whole => 0,
            Prism::Spans(spans) => spans.capacity() * size_of::<Span>(),
        });
        size_of::<Prism>() * self.prisms.capacity() + beside.sum::<usize>()
    }

    /// A point on the line through a place of the section, in cells.
    fn point(&self, place: [f64; 2]) -> Vector3<f64> {
        let mut point = Vector3::zeros();
        for (axis, (place, cell)) in self.section().into_iter().zip(place.iter().zip(self.cell)) {
            point[axis] = place * cell;
        }
        point
    }

    /// A point on the line through the middle of a section.
    pub fn middle(&self, place: [usize; 2]) -> Vector3<f64> {
        self.point(place.map(|cells| cells as f64 + 0.5))
    }

    /// Takes away what is inside of a convex body for certain: of each prism the stretch on which the lines through all four
    /// corners of its section are inside. `line` tells of a point at zero of the axis where the line through it is inside,
    /// `extents` are those of the body; `taken` is told of each place, of what is left there
    /// and of the stretch, before it is taken. The volume that was
    /// left of it, mm³.
    pub fn carve(
        &mut self,
        extents: &[Vector3<f64>; 2],
        line: &dyn Fn(Vector3<f64>) -> Corner,
        taken: Taken<'_>,
    ) -> f64 {
        let Some([columns, rows]) = self.places(extents, 0.0) else { return 0.0 };
        let mut removed = 0.0;
        let along = [extents[0][self.axis], extents[1][self.axis]];
        let width = columns[1] - columns[0] + 1;
        // Corners of the row below and above the prisms: what is not known yet is asked for when a prism wants it.
        let mut corners: [Vec<Option<Corner>>; 2] = [vec![None; width], vec![None; width]];
        for row in rows[0]..rows[1] {
            for column in columns[0]..columns[1] {
                let place = [column, row];
                let left =
                    |[low, high]: &Span| f64::from(*high) > along[0] && f64::from(*low) < along[1];
                if !self.at(place).iter().any(left) {
                    continue;
                }
                let mut stretch = [f64::NEG_INFINITY, f64::INFINITY];
                for (above, aside) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
                    let at = [column + aside, row + above].map(|cells| cells as f64);
                    let known = &mut corners[above][column + aside - columns[0]];
                    let inside = *known.get_or_insert_with(|| line(self.point(at)));
                    // An empty stretch ends the search.
                    let [low, high] = inside.unwrap_or([1.0, -1.0]);
                    stretch = match inside {
                        Some(_) => [stretch[0].max(low), stretch[1].min(high)],
                        None => [low, high],
                    };
                    if stretch[0] >= stretch[1] {
                        break;
                    }
                }
                if stretch[0] < stretch[1] {
                    taken(place, self.at(place), stretch);
                    removed += self.take(place, stretch);
                }
            }
            corners.swap(0, 1);
            corners[1].fill(None);
        }
        removed * self.area()
    }

    /// Takes away what a body may touch: of each prism the stretch on which the line through its middle is inside of it,
    /// grown by what the section is wide. `extents` are those of the grown body; prisms in which neither these nor those of
    /// `other` have anything left within them are passed over.
    pub fn touch(
        &mut self,
        extents: &[Vector3<f64>; 2],
        other: Option<&Self>,
        line: &dyn Fn(Vector3<f64>) -> Corner,
        taken: Taken<'_>,
    ) {
        let Some([columns, rows]) = self.places(extents, 1.0) else { return };
        let along = [extents[0][self.axis], extents[1][self.axis]];
        for row in rows[0]..rows[1] {
            for column in columns[0]..columns[1] {
                let place = [column, row];
                let empty = |rays: &Self| rays.hull(place, along).is_none();
                if other.is_some_and(empty) && empty(self) {
                    continue;
                }
                if let Some(stretch) = line(self.middle(place)) {
                    taken(place, self.at(place), stretch);
                    self.take(place, stretch);
                }
            }
        }
    }

    /// Places of the section within extents, from and to in each direction: those wholly inside, and with `more` as many
    /// cells on each side.
    fn places(&self, extents: &[Vector3<f64>; 2], more: f64) -> Option<[[usize; 2]; 2]> {
        let range = |index: usize| {
            let axis = self.section()[index];
            let [low, high] =
                [extents[0][axis], extents[1][axis]].map(|end| end / self.cell[index]);
            let most = self.counts[index] as f64;
            let from = (libm::ceil(low) - more).clamp(0.0, most);
            let to = (libm::floor(high) + more).clamp(0.0, most);
            (from < to).then_some([from as usize, to as usize])
        };
        Some([range(0)?, range(1)?])
    }

    /// How much of a stretch is left in a prism, mm.
    pub fn left(&self, place: [usize; 2], [from, to]: Stretch) -> f64 {
        common(self.at(place), &[[f32::NEG_INFINITY, f32::INFINITY]], [from, to])
    }

    /// From the lowest to the highest of what is left of a stretch in a prism.
    pub fn hull(&self, place: [usize; 2], [from, to]: Stretch) -> Option<Stretch> {
        let spans = self.at(place).iter().map(|span| span.map(f64::from));
        let mut within = spans.filter(|[low, high]| *low < to && *high > from);
        let [first, end] = within.next()?;
        let high = within.next_back().map_or(end, |[_, high]| high);
        Some([first.max(from), high.min(to)])
    }

    /// Only these stretches are left, one of a prism; `most`: none goes farther along the axis, mm.
    pub fn fill(&mut self, stretches: &[([usize; 2], Stretch)], most: f64) {
        self.clear();
        for (place, [low, high]) in stretches {
            self.set(*place, &[[low.max(0.0), high.min(most)]]);
        }
    }

    /// The prism that a point is in.
    fn place(&self, point: Vector3<f64>) -> Option<[usize; 2]> {
        let [u, v] = [0, 1].map(|index| point[self.section()[index]] / self.cell[index]);
        let [columns, rows] = self.counts.map(|count| count as f64);
        let inside = (0.0..columns).contains(&u) && (0.0..rows).contains(&v);
        inside.then_some([u as usize, v as usize])
    }

    /// Whether a point is left.
    pub fn holds(&self, point: Vector3<f64>) -> bool {
        let at = point[self.axis];
        let place = self.place(point);
        let holds = |[low, high]: &Span| (f64::from(*low)..=f64::from(*high)).contains(&at);
        place.is_some_and(|place| self.at(place).iter().any(holds))
    }

    /// A point that is left on one of the lines through the middles of sections, where these are inside of a body.
    pub fn meets(
        &self,
        extents: &[Vector3<f64>; 2],
        line: &dyn Fn(Vector3<f64>) -> Corner,
    ) -> Option<Vector3<f64>> {
        let [columns, rows] = self.places(extents, 1.0)?;
        let places = (rows[0]..rows[1])
            .flat_map(|row| (columns[0]..columns[1]).map(move |column| [column, row]));
        let mut left = places.filter(|place| !self.at(*place).is_empty());
        left.find_map(|place| {
            let mut point = self.middle(place);
            let [low, high] = self.hull(place, line(point)?)?;
            // Between two spans there is nothing: an end is of one of them.
            let end = [low, high].into_iter().find(|end| low < high && end.is_finite())?;
            point[self.axis] = end;
            Some(point)
        })
    }

    /// Nothing is left any more.
    pub fn clear(&mut self) {
        self.prisms.fill(Prism::Spans(Vec::new()));
    }

    /// Places of the section.
    pub fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// Edges of a section, mm.
    pub fn cells(&self) -> [f64; 2] {
        self.cell
    }

    /// Area of a section, mm².
    pub fn area(&self) -> f64 {
        self.cell[0] * self.cell[1]
    }
}
