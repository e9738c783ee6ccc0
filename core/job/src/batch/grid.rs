//! Values of flags, every one with every other.

use post_machine::diagnostic::Diagnostic;

use super::job_line::{JobLine, ValueText};
use crate::settings::values::{SettingValue, finite};

/// More jobs than this are a slip.
/// More are a slip.
pub const MOST_JOBS: usize = 10_000_000;

/// So many steps of one range.
const MOST_STEPS: f64 = 1e6;

/// What is laid over jobs that do not say it themselves.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// Machines, as `--machine` names them.
    pub machines: Vec<String>,
    /// Keys of the machine file, each with its values.
    pub set: Vec<(String, Vec<ValueText>)>,
    /// Values of settings that jobs may have, by name: in the order of [`JobLine::rows`].
    pub settings: Vec<(&'static str, Vec<Vec<ValueText>>)>,
}

impl Grid {
    /// The jobs of the grid: file by file, in it machine by machine, the last flag of [`Grid`]'s order fastest.
    ///
    /// # Errors
    /// A job without a machine, or there are too many.
    pub fn jobs(&self, seeds: Vec<JobLine>) -> Result<Vec<JobLine>, Box<Diagnostic>> {
        let mut jobs = seeds;
        jobs = multiplied(jobs, &self.machines, |job, machine| {
            let free = job.machine.is_none();
            job.machine.get_or_insert_with(|| machine.clone());
            free
        })?;
        if let Some(job) = jobs.iter().find(|job| job.machine.is_none()) {
            let message = format!("no machine is named for {}", job.file);
            return Err(Diagnostic::error("machine", message)
                .help("--machine names one for all jobs, \"machine\" in a list that of one job")
                .boxed());
        }
        for (index, (key, values)) in self.set.iter().enumerate() {
            if self.set[..index].iter().any(|(before, _)| before == key) {
                let message = format!("--set has {key} twice");
                return Err(Diagnostic::error("batch", message)
                    .help(format!("one flag has all values: --set {key}=200,250"))
                    .boxed());
            }
            jobs = multiplied(jobs, values, |job, value| {
                if job.set.contains_key(key) {
                    return false;
                }
                job.set.insert(key.clone(), value.clone());
                true
            })?;
        }
        for (name, values) in &self.settings {
            let Some(row) = JobLine::place(name) else { continue };
            jobs = multiplied(jobs, values, |job, value| {
                if job.settings.contains_key(&row) {
                    return false;
                }
                job.settings.insert(row, value.clone());
                true
            })?;
        }
        Ok(jobs)
    }
}

/// Each job once for each value, or as it is where `put` says that the value has no place in it.
fn multiplied<T>(
    jobs: Vec<JobLine>,
    values: &[T],
    put: impl Fn(&mut JobLine, &T) -> bool,
) -> Result<Vec<JobLine>, Box<Diagnostic>> {
    if values.is_empty() {
        return Ok(jobs);
    }
    let mut all = Vec::new();
    for job in jobs {
        for value in values {
            let mut next = job.clone();
            let told = put(&mut next, value);
            all.push(next);
            if !told {
                break;
            }
        }
        if all.len() > MOST_JOBS {
            let message = format!("these are more than {MOST_JOBS} jobs");
            return Err(Diagnostic::error("batch", message)
                .help("fewer values, or several runs, each with a part of the files")
                .boxed());
        }
    }
    Ok(all)
}

/// The values of a flag: parted by commas outside brackets and quotes; `FROM:TO:STEP` is all numbers of a range.
///
/// # Errors
/// A value is empty, or a range that goes nowhere.
pub fn values(text: &str) -> Result<Vec<ValueText>, String> {
    let mut values = Vec::new();
    for part in parts(text) {
        let part = part.trim();
        if part.is_empty() {
            return Err(format!("`{text}` has an empty value"));
        }
        match range(part)? {
            Some(numbers) => values.extend(numbers),
            None => values.push(ValueText(part.to_owned())),
        }
    }
    Ok(values)
}

/// What stands between the commas, but for those within brackets and quotes.
fn parts(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut depth, mut quote, mut begin) = (0_u32, None, 0);
    for (at, letter) in text.char_indices() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{' | '(') => depth += 1,
            (None, ']' | '}' | ')') => depth = depth.saturating_sub(1),
            (None, ',') if depth == 0 => {
                parts.push(&text[begin..at]);
                begin = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[begin..]);
    parts
}

/// The numbers of `FROM:TO:STEP`, both ends among them if the steps meet the last; none if it is no range.
fn range(text: &str) -> Result<Option<Vec<ValueText>>, String> {
    let ends: Vec<&str> = text.split(':').collect();
    let numbers = ends.iter().map(|end| finite(&SettingValue::from(end.trim())));
    let Ok(numbers) = numbers.collect::<Result<Vec<f64>, _>>() else {
        return Ok(None);
    };
    let [from, to, step] = numbers[..] else {
        return Ok(None);
    };
    // The last may be missed by what sums round off.
    let steps = libm::floor((to - from) / step + 1e-9);
    if !(0.0..=MOST_STEPS).contains(&steps) {
        return Err(format!("{text}: a range is FROM:TO:STEP, and this step does not lead there"));
    }
    let decimals = ends.iter().map(|end| decimals(end.trim()));
    let decimals = decimals.collect::<Option<Vec<usize>>>();
    let decimals = decimals.and_then(|all| all.into_iter().max());
    let number = |index: u32| {
        let value = from + f64::from(index) * step;
        let text = match decimals {
            Some(decimals) => format!("{value:.decimals$}"),
            None => format!("{value}"),
        };
        match (text.parse::<f64>(), text.strip_prefix('-')) {
            (Ok(0.0), Some(zero)) => zero.to_owned(),
            _ => text,
        }
    };
    let numbers = (0..=steps as u32).map(|index| ValueText(number(index)));
    Ok(Some(numbers.collect()))
}

/// Digits behind the point; none of a number with an exponent.
fn decimals(number: &str) -> Option<usize> {
    if number.contains(['e', 'E']) {
        return None;
    }
    Some(number.split_once('.').map_or(0, |(_, digits)| digits.len()))
}
