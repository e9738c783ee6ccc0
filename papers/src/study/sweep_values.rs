//! `--sweep NAME=FROM:TO:STEP`: the values that a number of the machine takes.

use post_cli::arguments::flag_values::finite;

/// More values than this are a slip.
const MOST: f64 = 200.0;

/// A name and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// A parameter of the machine, or any key.
    pub name: String,
    /// Its values, rising.
    pub values: Vec<f64>,
}

/// `NAME=FROM:TO:STEP`.
pub fn parse(text: &str) -> Result<Sweep, String> {
    let form = || "it has the form NAME=FROM:TO:STEP, as in Lm=100:400:50".to_owned();
    let (name, range) = text.split_once('=').ok_or_else(form)?;
    let numbers: Vec<f64> =
        range.split(':').map(|number| finite(number.trim())).collect::<Result<_, _>>()?;
    let [from, to, step] = numbers[..] else {
        return Err(form());
    };
    if name.trim().is_empty() {
        return Err(form());
    }
    if step <= 0.0 || to <= from {
        return Err("the step must be above zero, and TO above FROM".to_owned());
    }
    let count = libm::floor((to - from) / step + 1e-9) + 1.0;
    if count > MOST {
        return Err(format!("{count} values are too many; {MOST} at most"));
    }
    Ok(Sweep {
        name: name.trim().to_owned(),
        values: (0..count as u32).map(|index| short(from + f64::from(index) * step)).collect(),
    })
}

/// A number without the last digits, in which sums are not what one would write.
fn short(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_has_both_ends() {
        let sweep = parse("Lm=100:400:50").unwrap();
        assert_eq!(sweep.name, "Lm");
        assert_eq!(sweep.values, [100.0, 150.0, 200.0, 250.0, 300.0, 350.0, 400.0]);
        let tenths = parse("a.b=0:1:0.1").unwrap().values;
        assert_eq!(tenths.len(), 11);
        assert_eq!(tenths[3], 0.3);
    }

    #[test]
    fn a_bad_sweep_is_refused() {
        for text in [
            "Lm",
            "Lm=1:2",
            "=1:2:1",
            "Lm=1:2:0",
            "Lm=2:1:1",
            "Lm=a:2:1",
            "Lm=0:1:1e-9",
            "Lm=1:inf:1",
        ] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
