//! Readings that do not go with the others: each is held against what the others alone say (studentised residuals).
//!
//! Without reading `i` the sum of squares is less by `D = eᵢᵀ (I − Hᵢ)⁻¹ eᵢ`, where `eᵢ` is what is left over of it and `Hᵢ`
//! its own share in that (leverage), the place of its ball among it. Against the variance `s²` of the others, `D / 3 s²` goes
//! by F(3, ν) if the reading is as good as they are. Two bad readings hide one another, so the worst is set aside again and
//! again, and the readings up to the last one that chance does not explain are told (Rosner, 1983).

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::SMALLEST;

/// That chance makes the worst of good readings so bad is no likelier than this.
const CHANCE: f64 = 0.001;
/// Readings set aside in search of bad ones, at most, and their share of all.
const MOST: usize = 20;
const SHARE: usize = 4;
/// Readings are not taken to be better than this, mm: what is below is rounding of the table.
const FINEST: f64 = 1e-5;
/// The others say nothing of a coordinate of which less than this is left over.
const UNTESTED: f64 = 1e-6;

/// A reading that does not go with the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Its place among the readings, from 0.
    pub reading: usize,
    /// How far it is from where the others say that the ball is, mm.
    pub off: f64,
    /// The same in standard deviations of that distance.
    pub sigma: f64,
}

/// Readings and what is left over of them near the best numbers: three rows each.
pub(super) struct Residuals<'a> {
    /// How what is left over changes with each number.
    pub(super) derivatives: &'a DMatrix<f64>,
    /// What is left over, mm.
    pub(super) off: &'a DVector<f64>,
    /// The ball of each reading.
    pub(super) balls: &'a [usize],
}

/// A reading beside the others.
struct Judged {
    outlier: Outlier,
    /// How likely chance makes it so bad, were it as good as the others.
    chance: f64,
}

impl Residuals<'_> {
    /// The readings that chance does not explain, worst first.
    pub(super) fn outliers(&self) -> Vec<Outlier> {
        let mut kept: Vec<usize> = (0..self.balls.len()).collect();
        let most = MOST.min(kept.len() / SHARE);
        let mut aside = Vec::new();
        let mut bad = 0;
        while aside.len() < most {
            let Some(worst) = self.worst(&kept) else {
                break;
            };
            aside.push(worst.outlier);
            if worst.chance * (kept.len() as f64) < CHANCE {
                bad = aside.len();
            }
            kept.retain(|reading| *reading != worst.outlier.reading);
        }
        aside.truncate(bad);
        aside
    }

    /// The reading among `kept` that goes least with the others of them.
    fn worst(&self, kept: &[usize]) -> Option<Judged> {
        let (derivatives, off, shares) = self.centred(kept);
        let lengths: Vec<f64> = derivatives.column_iter().map(|column| column.norm()).collect();
        let mut scaled = derivatives;
        for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
            column /= length.max(f64::MIN_POSITIVE);
        }
        let decomposed = scaled.svd(true, false);
        let values = &decomposed.singular_values;
        if values.min() < SMALLEST * values.max() {
            return None;
        }
        let span = decomposed.u?;
        let left = &off - &span * span.tr_mul(&off);
        let balls = shares.iter().map(|(_, share)| *share).sum::<f64>();
        let free = (3 * kept.len()) as f64 - span.ncols() as f64 - 3.0 * libm::round(balls) - 3.0;
        if free < 1.0 {
            return None;
        }
        let judged = shares.iter().enumerate().filter_map(|(place, (reading, share))| {
            let own = span.rows(3 * place, 3);
            let spanned = Matrix3::from_fn(|row, column| own.row(row).dot(&own.row(column)));
            let leverage = Matrix3::identity() * *share + spanned;
            let room = (Matrix3::identity() - leverage).symmetric_eigenvalues().min();
            let inverse = (Matrix3::identity() - leverage).try_inverse();
            let inverse = inverse.filter(|_| room > UNTESTED)?;
            let rest = Vector3::from(left.fixed_rows::<3>(3 * place));
            let less = rest.dot(&(inverse * rest));
            let variance = (left.norm_squared() - less).max(0.0) / free;
            let squared = less / variance.max(FINEST * FINEST);
            let off = (inverse * rest).norm();
            let outlier = Outlier { reading: *reading, off, sigma: libm::sqrt(squared) };
            Some(Judged { outlier, chance: chance_of(squared, free) })
        });
        judged.min_by(|one, other| {
            let larger = other.outlier.sigma.total_cmp(&one.outlier.sigma);
            one.chance.total_cmp(&other.chance).then(larger)
        })
    }

    /// Derivatives and what is left over of `kept`, each ball about the mean of its own; each reading with its share in
    /// that mean.
    fn centred(&self, kept: &[usize]) -> (DMatrix<f64>, DVector<f64>, Vec<(usize, f64)>) {
        let rows: Vec<usize> =
            kept.iter().flat_map(|reading| 3 * reading..3 * reading + 3).collect();
        let mut derivatives = self.derivatives.select_rows(&rows);
        let mut off = self.off.select_rows(&rows);
        let balls = self.balls.iter().max().map_or(0, |last| last + 1);
        let mut counts = vec![0.0; balls];
        kept.iter().for_each(|reading| counts[self.balls[*reading]] += 1.0);
        let about_means = |column: &mut [f64]| {
            let mut sums = vec![Vector3::zeros(); balls];
            for (reading, own) in kept.iter().zip(column.chunks(3)) {
                sums[self.balls[*reading]] += Vector3::from_column_slice(own);
            }
            for (reading, own) in kept.iter().zip(column.chunks_mut(3)) {
                let ball = self.balls[*reading];
                let mean = sums[ball] / counts[ball];
                own.iter_mut().zip(mean.iter()).for_each(|(value, mean)| *value -= mean);
            }
        };
        about_means(off.as_mut_slice());
        let height = rows.len().max(1);
        derivatives.as_mut_slice().chunks_mut(height).for_each(about_means);
        let share = |reading: &usize| (*reading, 1.0 / counts[self.balls[*reading]]);
        (derivatives, off, kept.iter().map(share).collect())
    }
}

/// How likely three coordinates together are so many variances off, or more, where the variance is known from `free` numbers:
/// the upper tail of F(3, free), which is the incomplete beta function `I_x(free / 2, 3 / 2)`.
fn chance_of(squared: f64, free: f64) -> f64 {
    let (x, a, b) = (free / (free + squared), free / 2.0, 1.5);
    let front = libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b)
        + a * libm::log(x)
        + b * libm::log1p(-x);
    let front = libm::exp(front);
    if x < (a + 1.0) / (a + b + 2.0) {
        front * continued(x, a, b) / a
    } else {
        1.0 - front * continued(1.0 - x, b, a) / b
    }
}

/// The continued fraction of the incomplete beta function (Abramowitz and Stegun 26.5.8), by Lentz.
fn continued(x: f64, a: f64, b: f64) -> f64 {
    let tiny = |value: f64| if libm::fabs(value) < 1e-300 { 1e-300 } else { value };
    let mut above = 1.0;
    let mut below = 1.0 / tiny(1.0 - (a + b) * x / (a + 1.0));
    let mut value = below;
    for step in 1..10_000 {
        let m = f64::from(step);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        below = 1.0 / tiny(1.0 + even * below);
        above = tiny(1.0 + even / above);
        value *= below * above;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        below = 1.0 / tiny(1.0 + odd * below);
        above = tiny(1.0 + odd / above);
        value *= below * above;
        if libm::fabs(below * above - 1.0) < 1e-12 {
            break;
        }
    }
    value
}
