//! The limits of a curve file, and the machine that they make.

use std::fmt::Write as _;

use post_machine::description::{self, Machine, Source};
use post_machine::diagnostic::{Diagnostic, nearest};
use serde_json::Value;

use super::json_text::{JsonText, Raw};

/// Axes whose limits a curve file can have, the linear ones first.
const AXES: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

/// Largest velocity, acceleration or jerk, in mm or degrees: beyond it lies what a slip of the unit makes.
const MOST: f64 = 1e12;

/// Other keys than those of axes.
const KEYS: [&str; 5] = ["tip", "chord_error_um", "contour_error_um", "interp_period_s", "servo"];

/// Largest velocity, acceleration and jerk, in mm or degrees and s; none where nothing is said.
pub type DerivativeLimits = [Option<f64>; 3];

/// What a curve file says of limits.
#[derive(Clone, Debug, Default)]
pub struct FileLimits {
    /// Of axes.
    pub axes: Vec<(char, DerivativeLimits)>,
    /// Of the tip: feed, acceleration and jerk.
    pub tip: DerivativeLimits,
    /// mm.
    pub chord_error: Option<f64>,
    /// mm.
    pub contour_error: Option<f64>,
    /// s.
    pub period: Option<f64>,
    /// Tables `[servo.X]` of a machine file, as TOML.
    servos: String,
}

impl FileLimits {
    /// Takes a key of `limits`.
    ///
    /// # Errors
    /// It is not known, or its value makes no sense.
    pub fn take<'a>(
        &mut self,
        json: &JsonText<'a>,
        key: &str,
        raw: Raw<'a>,
    ) -> Result<(), Box<Diagnostic>> {
        match key {
            "tip" => self.tip = most(json, raw, false)?,
            "chord_error_um" => self.chord_error = Some(1e-3 * json.positive(raw, key)?),
            "contour_error_um" => self.contour_error = Some(1e-3 * json.positive(raw, key)?),
            "interp_period_s" => self.period = Some(period(json, raw)?),
            "servo" => {
                for (axis, value) in json.entries(raw)? {
                    let model: Value = json.value(value)?;
                    // Writing to a String cannot fail.
                    let _ = writeln!(self.servos, "[servo.{}]", quoted(&axis));
                    for (key, value) in model.as_object().into_iter().flatten() {
                        let _ = writeln!(self.servos, "{} = {}", quoted(key), toml(value));
                    }
                }
            }
            axes if !axes.is_empty() && axes.chars().all(|axis| AXES.contains(&axis)) => {
                for axis in axes.chars() {
                    if self.axes.iter().any(|(other, _)| *other == axis) {
                        let message = format!("limits of {axis} are said twice");
                        return Err(json.fault(raw, message, ""));
                    }
                    self.axes.push((axis, most(json, raw, is_rotary(axis))?));
                }
            }
            other => {
                let help = match nearest(other, KEYS) {
                    Some(meant) => format!("did you mean {meant}?"),
                    None => {
                        format!("axes by their names (X, XYZ, A), {} are known", KEYS.join(", "))
                    }
                };
                let message = format!("limits of {other} are not known");
                return Err(json.fault(raw, message, &help));
            }
        }
        Ok(())
    }

    /// Rotary axes that have limits.
    fn rotary(&self) -> Vec<char> {
        let axes = self.axes.iter().map(|(axis, _)| *axis);
        axes.filter(|axis| is_rotary(*axis)).collect()
    }

    /// The machine whose axes have these limits: X, Y, Z alone, or under a table of A and C or B and C that carries the
    /// part and whose axes meet in its origin. `rotary` are axes that the path names.
    ///
    /// # Errors
    /// There is no such machine, or a servo of the file is refused.
    pub fn machine(&self, file: &str, rotary: &[String]) -> Result<Machine, Vec<Diagnostic>> {
        let mut turning = self.rotary();
        turning.extend(rotary.iter().filter_map(|name| name.chars().next()));
        turning.sort_unstable();
        turning.dedup();
        let first = match turning[..] {
            [] => None,
            ['A' | 'C'] | ['A', 'C'] => Some('A'),
            ['B'] | ['B', 'C'] => Some('B'),
            _ => {
                let names: Vec<String> = turning.iter().map(char::to_string).collect();
                let message = format!(
                    "{file}: rotary axes {} make no machine that is known without its file",
                    names.join(" and ")
                );
                let help = "A and C, or B and C, of a table are; --machine names any other";
                return Err(vec![Diagnostic::error("curve", message).help(help)]);
            }
        };
        let text = self.toml(first);
        let source = Source { name: file.to_owned(), text };
        let mut none = |name: &str| Err(format!("there is no machine {name}"));
        description::load(source, &[], &mut none).map_err(|faults| {
            // Their places are those of a text that the user never sees.
            let faults = faults.into_iter().map(|fault| Diagnostic {
                message: format!("{file}, limits: {}", fault.message),
                ..fault.at(None)
            });
            faults.collect()
        })
    }

    fn toml(&self, first: Option<char>) -> String {
        let chain = match first {
            Some(first) => format!("[w C' {first}' b X Y Z t]"),
            None => "[w b X Y Z t]".to_owned(),
        };
        let mut text = format!(
            "name = \"axes of the curve file\"\nchain = \"{chain}\"\n[tool]\ngauge = [0, 0, 0]\n[control]\ndialect = \"linuxcnc\"\ntcp = \"post\"\n"
        );
        let turning = first.into_iter().chain(first.map(|_| 'C'));
        for axis in AXES[..3].iter().copied().chain(turning) {
            let (kind, direction) = match axis {
                'X' => ("linear", "[1, 0, 0]"),
                'Y' => ("linear", "[0, 1, 0]"),
                'Z' => ("linear", "[0, 0, 1]"),
                'A' => ("rotary", "[1, 0, 0]"),
                'B' => ("rotary", "[0, 1, 0]"),
                _ => ("rotary", "[0, 0, 1]"),
            };
            let _ = writeln!(text, "[axis.{axis}]\n{kind} = {direction}");
            let _ = match kind {
                // The table turns the part by what the axis shows.
                "rotary" => writeln!(text, "point = [0, 0, 0]\ncyclic = true\nreversed = true"),
                _ => writeln!(text, "travel = [-1e7, 1e7]"),
            };
            let said = self.axes.iter().find(|(name, _)| *name == axis);
            let limits = said.map_or([None; 3], |(_, most)| *most);
            let keys = [("max_feed", 60.0), ("max_accel", 1.0), ("max_jerk", 1.0)];
            for ((key, unit), limit) in keys.into_iter().zip(limits) {
                if let Some(limit) = limit {
                    let _ = writeln!(text, "{key} = {:?}", limit * unit);
                }
            }
        }
        text.push_str("[motion]\n");
        let [_, accel, jerk] = self.tip;
        for (key, value) in [("period", self.period), ("tip_accel", accel), ("tip_jerk", jerk)] {
            if let Some(value) = value {
                let _ = writeln!(text, "{key} = {value:?}");
            }
        }
        text.push_str("[plan]\n");
        for (key, value) in
            [("contour_error", self.contour_error), ("chord_error", self.chord_error)]
        {
            if let Some(value) = value {
                let _ = writeln!(text, "{key} = {value:?}");
            }
        }
        text.push_str(&self.servos);
        text
    }
}

fn is_rotary(axis: char) -> bool {
    AXES[3..].contains(&axis)
}

/// `{ "v": …, "a": …, "j": …, "unit": … }`, in mm or degrees.
fn most<'a>(
    json: &JsonText<'a>,
    raw: Raw<'a>,
    rotary: bool,
) -> Result<DerivativeLimits, Box<Diagnostic>> {
    let mut found = DerivativeLimits::default();
    let mut unit = if rotary { "rad" } else { "mm" }.to_owned();
    let entries = json.entries(raw)?;
    for (key, value) in &entries {
        let place = match key.as_str() {
            "v" => 0,
            "a" => 1,
            "j" => 2,
            "unit" => {
                unit = json.value(value)?;
                continue;
            }
            other => {
                let message = format!("{other} is no limit");
                let help = "v, a and j are velocity, acceleration and jerk, and unit their unit";
                return Err(json.fault(value, message, help));
            }
        };
        found[place] = Some(json.positive(value, key)?);
    }
    let scale = match (unit.as_str(), rotary) {
        ("mm", false) | ("deg", true) => 1.0,
        ("rad", true) => 1f64.to_degrees(),
        _ => {
            let value = entries.iter().find(|(key, _)| key == "unit");
            let message = format!("{unit} is no unit of such an axis");
            let help = "linear axes have mm, rotary ones rad or deg";
            return Err(json.fault(value.map_or(raw, |(_, value)| value), message, help));
        }
    };
    for (value, (key, raw)) in found.iter_mut().zip(["v", "a", "j"].map(|name| {
        let entry = entries.iter().find(|(key, _)| key == name);
        (name, entry.map(|(_, raw)| *raw))
    })) {
        let (Some(value), Some(raw)) = (value, raw) else {
            continue;
        };
        *value *= scale;
        if *value > MOST {
            let message = format!("{key} is {value:e}; the largest is {MOST:e}");
            return Err(json.fault(raw, message, "leave it out where there is no limit"));
        }
    }
    Ok(found)
}

fn period<'a>(json: &JsonText<'a>, raw: Raw<'a>) -> Result<f64, Box<Diagnostic>> {
    let seconds = json.positive(raw, "interp_period_s")?;
    if (1e-5..=1.0).contains(&seconds) {
        return Ok(seconds);
    }
    let message = format!("interp_period_s is {seconds} s; from 0.00001 to 1 s is possible");
    Err(json.fault(raw, message, "controls have 0.0005 to 0.02 s"))
}

/// A key or a text as TOML: its basic strings escape as those of JSON do.
fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

/// A value of the servo's table as TOML.
fn toml(value: &Value) -> String {
    match value {
        Value::Object(keys) => {
            let keys = keys.iter().map(|(key, value)| format!("{} = {}", quoted(key), toml(value)));
            format!("{{ {} }}", keys.collect::<Vec<_>>().join(", "))
        }
        Value::Array(values) => {
            let values = values.iter().map(toml);
            format!("[{}]", values.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}
