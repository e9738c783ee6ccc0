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
    let order = best_order(values);
    out.push(form | order);
    let mark = out.len();
    out.push(0);
    let mut all = 0;
    differences(values, order, |difference| all |= fold(difference));
    let planes = (8 - all.leading_zeros() / 8) as usize;
    out[mark] = planes as u8;
    out.extend_from_slice(head);
    let start = out.len();
    let rows = values.len();
    out.resize(start + planes * rows, 0);
    let places = &mut out[start..];
    match planes {
        0 => {}
        1 => {
            let mut row = 0;
            differences(values, order, |difference| {
                places[row] = fold(difference) as u8;
                row += 1;
            });
        }
        _ => {
            let mut row = 0;
            differences(values, order, |difference| {
                let mut folded = fold(difference);
                for plane in 0..planes {
                    places[plane * rows + row] = folded as u8;
                    folded >>= 8;
                }
                row += 1;
            });
        }
    }
}

/// 0, -1, 1, -2, … become 0, 1, 2, 3, …
#[inline]
fn fold(value: i64) -> u64 {
    ((value << 1) ^ (value >> 63)) as u64
}

#[inline]
fn differences(values: &[i64], order: u8, mut take: impl FnMut(i64)) {
    let (mut last, mut slope) = (0i64, 0i64);
    for value in values {
        match order {
            0 => take(*value),
            1 => {
                take(value.wrapping_sub(last));
                last = *value;
            }
            _ => {
                let step = value.wrapping_sub(last);
                take(step.wrapping_sub(slope));
                (last, slope) = (*value, step);
            }
        }
    }
}

/// The order whose differences have the fewest digits.
fn best_order(values: &[i64]) -> u8 {
    let mut digits = [0u64; 3];
    let (mut last, mut slope) = (0i64, 0i64);
    let bits = |value: i64| u64::from(64 - fold(value).leading_zeros());
    for value in values {
        let step = value.wrapping_sub(last);
        digits[0] += bits(*value);
        digits[1] += bits(step);
        digits[2] += bits(step.wrapping_sub(slope));
        (last, slope) = (*value, step);
    }
    // Of equal ones the lowest: `min_by_key` takes the first.
    let order = (0..3usize).min_by_key(|order| digits[*order]);
    order.unwrap_or(0) as u8
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
    let (mut last, mut slope) = (0i64, 0i64);
    let values = (0..rows).map(|row| {
        let folded = (0..planes)
            .rev()
            .fold(0u64, |folded, plane| folded << 8 | u64::from(places[plane * rows + row]));
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
