//! A column of integers as bytes: its differences, their signs folded in, byte plane by byte plane.
//!
//! A column is one byte for the order of the differences (0, 1 or 2), one for the number of planes, and the planes, the
//! least bytes first, each as long as the column. Before the first value there are zeros. Where the order has 16 more,
//! all values are a first one and multiples of a step besides (words that are printed with fewer decimals than the
//! column has): after the number of planes stand the first one as a float of 64 bits and the step as an integer of 32,
//! least byte first, and the planes are those of the multiples.

/// Flag in the byte of the order: values are multiples of a step.
const STEPS: u8 = 16;

/// Adds `values` to `out` by the differences that are smallest. Values and their second differences keep within 2^53.
pub fn encode(values: &[i64], out: &mut Vec<u8>) {
    let first = values.first().copied().unwrap_or(0);
    let step = step(values, first);
    if step <= 1 {
        return planes(values, 0, &[], out);
    }
    let multiples: Vec<i64> = values.iter().map(|value| (value - first) / step).collect();
    let mut head = Vec::with_capacity(12);
    head.extend((first as f64).to_le_bytes());
    head.extend((step as u32).to_le_bytes());
    planes(&multiples, STEPS, &head, out);
}

/// What all distances from `first` are multiples of; 0 where there are none.
fn step(values: &[i64], first: i64) -> i64 {
    let mut step = 0;
    for value in values {
        let mut rest = (value - first).abs();
        while rest != 0 {
            (step, rest) = (rest, step % rest);
        }
        if step == 1 {
            break;
        }
    }
    if step > i64::from(u32::MAX) { 1 } else { step }
}

fn planes(values: &[i64], form: u8, head: &[u8], out: &mut Vec<u8>) {
    let (order, all) = best_order(values);
    let planes = (8 - all.leading_zeros() / 8) as usize;
    out.push(form | order);
    out.push(planes as u8);
    out.extend_from_slice(head);
    let start = out.len();
    let rows = values.len();
    out.resize(start + planes * rows, 0);
    let places = &mut out[start..];
    let mut last = LastStep::default();
    let mut folded = [0u64; BLOCK];
    for (block, begin) in values.chunks(BLOCK).zip((0..).step_by(BLOCK)) {
        last.fold(block, order, &mut folded);
        for plane in 0..planes {
            let row = plane * rows + begin;
            for (place, folded) in places[row..row + block.len()].iter_mut().zip(&folded) {
                *place = (folded >> (8 * plane)) as u8;
            }
        }
    }
}

/// Values whose differences are laid together: few enough for the innermost store.
const BLOCK: usize = 256;

/// The value before a block and its difference from the one before that.
#[derive(Default)]
struct LastStep {
    value: i64,
    step: i64,
}

impl LastStep {
    /// Folds the differences of a block.
    fn fold(&mut self, block: &[i64], order: u8, folded: &mut [u64; BLOCK]) {
        let places = folded.iter_mut().zip(block);
        match order {
            0 => places.for_each(|(folded, value)| *folded = fold(*value)),
            1 => {
                for (folded, value) in places {
                    *folded = fold(value.wrapping_sub(self.value));
                    self.value = *value;
                }
            }
            _ => {
                for (folded, value) in places {
                    let step = value.wrapping_sub(self.value);
                    *folded = fold(step.wrapping_sub(self.step));
                    (self.value, self.step) = (*value, step);
                }
            }
        }
    }
}

/// 0, -1, 1, -2, … become 0, 1, 2, 3, …
#[inline]
fn fold(value: i64) -> u64 {
    ((value << 1) ^ (value >> 63)) as u64
}

/// The order whose differences have the fewest digits, and all bits that one of these has, folded.
fn best_order(values: &[i64]) -> (u8, u64) {
    let mut digits = [0u64; 3];
    let mut all = [0u64; 3];
    let (mut last, mut slope) = (0i64, 0i64);
    for value in values {
        let step = value.wrapping_sub(last);
        let folded = [fold(*value), fold(step), fold(step.wrapping_sub(slope))];
        for order in 0..3 {
            // Of a number that is not zero this is one instruction; none reaches the last bit.
            digits[order] += u64::from(63 - (folded[order] << 1 | 1).leading_zeros());
            all[order] |= folded[order];
        }
        (last, slope) = (*value, step);
    }
    // Of equal ones the lowest: `min_by_key` takes the first.
    let order = (0..3usize).min_by_key(|order| digits[*order]).unwrap_or(0);
    (order as u8, all[order])
}

/// The column of `rows` rows that stands at `at`, which moves past it; none if the bytes end before.
pub fn decode(bytes: &[u8], rows: usize, at: &mut usize) -> Option<Vec<i64>> {
    let [order, planes] = *bytes.get(*at..*at + 2)? else {
        return None;
    };
    let planes = usize::from(planes);
    *at += 2;
    let (mut base, mut step) = (0, 1);
    if order & STEPS != 0 {
        let first = bytes.get(*at..*at + 8)?.try_into().ok()?;
        let size = bytes.get(*at + 8..*at + 12)?.try_into().ok()?;
        base = f64::from_le_bytes(first) as i64;
        step = i64::from(u32::from_le_bytes(size));
        *at += 12;
    }
    let places = bytes.get(*at..*at + planes * rows)?;
    *at += planes * rows;
    let mut folded = vec![0u64; rows];
    for (plane, places) in places.chunks_exact(rows.max(1)).enumerate().take(8) {
        for (folded, place) in folded.iter_mut().zip(places) {
            *folded |= u64::from(*place) << (8 * plane);
        }
    }
    let (mut last, mut slope) = (0i64, 0i64);
    let values = folded.into_iter().map(|folded| {
        let difference = (folded >> 1) as i64 ^ -((folded & 1) as i64);
        let multiple = match order & !STEPS {
            0 => difference,
            1 => {
                last = last.wrapping_add(difference);
                last
            }
            _ => {
                slope = slope.wrapping_add(difference);
                last = last.wrapping_add(slope);
                last
            }
        };
        base + step * multiple
    });
    Some(values.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_come_back() {
        let wild: Vec<i64> = (0..1000i64).map(|i| (i * i * 7919) % 100_003 - 50_000).collect();
        let far = vec![1 << 50, -(1 << 50), 0, 3, -1, 255, 256, -256, -257];
        let even: Vec<i64> = (0..500).map(|i| 10 * i + 10).collect();
        for values in [wild, far, even.clone(), vec![7; 100], vec![0; 9], Vec::new()] {
            let mut bytes = Vec::new();
            encode(&values, &mut bytes);
            let mut at = 0;
            assert_eq!(decode(&bytes, values.len(), &mut at), Some(values));
            assert_eq!(at, bytes.len());
        }
        let mut bytes = Vec::new();
        encode(&even, &mut bytes);
        assert_eq!(bytes[0], STEPS | 2, "steps of ten, evenly");
        assert_eq!(bytes[1], 1);
    }
}
