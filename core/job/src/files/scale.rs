//! An axis of a chart: what is seen of it, and round numbers for its ticks.

/// One axis: what is seen of it, and where its ticks stand.
pub struct Scale {
    low: f64,
    high: f64,
    /// From tick to tick; none if the axis is logarithmic.
    step: Option<f64>,
}

impl Scale {
    /// For values, about `count` ticks; an axis that goes `up` begins at zero if nothing is below, and ends on a tick.
    pub fn new(values: impl Iterator<Item = f64>, count: f64, up: bool) -> Self {
        let (mut low, mut high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if up && low >= 0.0 {
            low = 0.0;
        }
        if high - low < 1e-9 {
            high = low + if low == 0.0 { 1e-3 } else { libm::fabs(low) };
        }
        let step = step((high - low) / count);
        if up {
            // A curve does not run along the frame.
            low = if low < 0.0 { libm::floor(low / step - 0.1) * step } else { 0.0 };
            high = libm::ceil(high / step + 0.1) * step;
        }
        Self { low, high, step: Some(step) }
    }

    /// From one value to a larger one, neither of which need be a tick, about `count` ticks.
    pub fn over([low, high]: [f64; 2], count: f64) -> Self {
        Self { low, high, step: Some(step((high - low) / count)) }
    }

    /// A logarithmic axis from a power of ten to another, at most six of them.
    pub fn decades(values: impl Iterator<Item = f64>) -> Self {
        let (least, most) = values
            .filter(|value| value.is_finite() && *value > 0.0)
            .fold((f64::INFINITY, f64::MIN_POSITIVE), |(least, most), value| {
                (least.min(value), most.max(value))
            });
        let high = libm::ceil(libm::log10(most));
        let low = libm::floor(libm::log10(least)).clamp(high - 6.0, high - 1.0);
        Self { low: libm::exp10(low), high: libm::exp10(high), step: None }
    }

    /// Where a value stands: 0 at the low end, 1 at the high one.
    pub fn share(&self, value: f64) -> f64 {
        match self.step {
            Some(_) => (value - self.low) / (self.high - self.low),
            // What is too small to be seen runs along the foot.
            None => libm::log(value.max(self.low) / self.low) / libm::log(self.high / self.low),
        }
    }

    /// Values of the ticks, and how they are written.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let Some(step) = self.step else {
            let first = libm::rint(libm::log10(self.low)) as i32;
            let last = libm::rint(libm::log10(self.high)) as i32;
            return (first..=last)
                .map(|power| {
                    let value = libm::exp10(f64::from(power));
                    let text = match usize::try_from(-power).unwrap_or(0) {
                        decimals @ 0..4 => format!("{value:.decimals$}"),
                        many => format!("10⁻{}", raised(many)),
                    };
                    (value, text)
                })
                .collect();
        };
        let decimals = (-libm::floor(libm::log10(step) + 1e-9)).max(0.0) as usize;
        let first = libm::ceil(self.low / step - 1e-9);
        let count = libm::floor((self.high - first * step) / step + 1e-9).max(0.0) as u32;
        (0..=count)
            .map(|index| {
                // Adding zero turns -0 into 0.
                let value = (first + f64::from(index)) * step + 0.0;
                (value, format!("{value:.decimals$}"))
            })
            .collect()
    }
}

/// A number as an exponent.
fn raised(number: usize) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let text = number.to_string();
    let places = text.bytes().map(|digit| usize::from(digit - b'0'));
    places.map(|place| digits[place]).collect()
}

/// The smallest of 1, 2 and 5 times a power of ten that is not below `least`.
pub fn step(least: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_or_five() {
        for (least, wanted) in [(0.9, 1.0), (1.0, 1.0), (1.1, 2.0), (3.0, 5.0), (0.06, 0.1)] {
            assert!((step(least) - wanted).abs() < 1e-12, "{least}");
        }
    }

    #[test]
    fn ticks_are_round_numbers_without_minus_zero() {
        let texts = |scale: &Scale| -> Vec<String> {
            scale.ticks().into_iter().map(|(_, text)| text).collect()
        };
        let up = Scale::new([0.0, 17.2].into_iter(), 8.0, true);
        assert_eq!(texts(&up), ["0", "5", "10", "15", "20"]);
        let across = Scale::new([-0.21, 0.2].into_iter(), 4.0, false);
        assert_eq!(texts(&across), ["-0.2", "0.0", "0.2"]);
        let small = Scale::decades([3e-5, 0.4].into_iter());
        assert_eq!(texts(&small), ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1"]);
        let decades = Scale::decades([0.0, 0.03, 70.4].into_iter());
        assert_eq!(texts(&decades), ["0.01", "0.1", "1", "10", "100"]);
        assert_eq!(decades.share(0.0), 0.0);
        assert!((decades.share(1.0) - 0.5).abs() < 1e-12);
    }
}
