//! `--offsets FILE`: what stands in the control's tables, as TOML.

use std::ops::Range;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace, nearest};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Offsets, Reference, WorkOffset};

/// Longest file, bytes.
const MOST_BYTES: usize = 1 << 20;

/// The tables of the file.
const TABLES: [&str; 5] = ["work", "length", "radius", "tool", "reference"];

/// What no length or position of a machine exceeds, mm or degrees.
const MOST: f64 = 1e7;

/// A file that is read.
struct OffsetFile<'a> {
    name: &'a str,
    text: &'a str,
    machine: &'a Machine,
    faults: Vec<Diagnostic>,
}

impl Offsets {
    /// From the text of a file, which messages call `name`, for a machine.
    ///
    /// # Errors
    /// All that is wrong with it, each with its place.
    pub fn parse(text: &str, name: &str, machine: &Machine) -> Result<Self, Vec<Diagnostic>> {
        let mut file = OffsetFile { name, text, machine, faults: Vec::new() };
        if text.len() > MOST_BYTES {
            let message =
                format!("{name} is longer than {MOST_BYTES} bytes, which no table of offsets is");
            return Err(vec![Diagnostic::error("offsets", message)]);
        }
        let table = match DeTable::parse(text) {
            Ok(table) => table.into_inner(),
            Err(fault) => {
                file.fault(fault.span().unwrap_or(0..0), fault.message(), None);
                return Err(file.faults);
            }
        };
        let mut offsets = Self::default();
        for (key, value) in &table {
            let Some(inside) = file.table(key.get_ref(), value) else {
                continue;
            };
            match key.get_ref().as_ref() {
                "work" => {
                    for (name, value) in inside {
                        if let Some(axes) = file.table(name.get_ref(), value) {
                            offsets.work.push(file.work(name.get_ref(), axes));
                        }
                    }
                }
                "reference" => {
                    for (which, value) in inside {
                        file.references(which, value, &mut offsets.references);
                    }
                }
                "length" => offsets.lengths = file.numbers(inside, "register"),
                "radius" => offsets.radii = file.numbers(inside, "register"),
                "tool" => offsets.tools = file.numbers(inside, "tool"),
                other => {
                    let meant = nearest(other, TABLES);
                    let help = match meant {
                        Some(meant) => format!("did you mean [{meant}]?"),
                        None => {
                            "[work.G54], [length], [radius], [tool] and [reference.1] are known"
                                .to_owned()
                        }
                    };
                    file.fault(
                        key.span(),
                        &format!("[{other}] is no table of offsets"),
                        Some(&help),
                    );
                }
            }
        }
        if file.faults.is_empty() { Ok(offsets) } else { Err(file.faults) }
    }
}

impl OffsetFile<'_> {
    fn fault(&mut self, span: Range<usize>, message: &str, help: Option<&str>) {
        let at = span.start.min(self.text.len());
        let begin = self.text[..at].rfind('\n').map_or(0, |end| end + 1);
        let line = self.text[begin..].lines().next().unwrap_or_default();
        let number = self.text[..begin].matches('\n').count() as u64 + 1;
        let from = (at - begin).min(line.len());
        let to = span.end.saturating_sub(begin).clamp(from, line.len());
        let place = SourcePlace::new(self.name, number, line, from..to);
        let mut fault = Diagnostic::error("offsets", message).at(Some(place));
        fault.help = help.map(str::to_owned);
        self.faults.push(fault);
    }

    fn table<'t>(
        &mut self,
        name: &str,
        value: &'t Spanned<DeValue<'t>>,
    ) -> Option<&'t DeTable<'t>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            let message = format!("{name} is a table, such as [work.G54] or [length]");
            self.fault(value.span(), &message, None);
        }
        table
    }

    fn number(&mut self, value: &Spanned<DeValue<'_>>, what: &str) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Integer(number) => {
                i64::from_str_radix(&number.as_str().replace('_', ""), number.radix())
                    .ok()
                    .map(|number| number as f64)
            }
            DeValue::Float(number) => number.as_str().replace('_', "").parse().ok(),
            _ => None,
        };
        let number = number.filter(|number| libm::fabs(*number) <= MOST);
        if number.is_none() {
            let message = format!("{what} is a number of no more than {MOST:e}");
            self.fault(value.span(), &message, None);
        }
        number
    }

    /// The axis of a key: its place in the chain.
    fn axis(&mut self, key: &Spanned<std::borrow::Cow<'_, str>>) -> Option<usize> {
        let name = key.get_ref().as_ref();
        let place = self.machine.axes.iter().position(|axis| axis.name == name);
        if place.is_none() {
            let axes: Vec<&str> = self.machine.axes.iter().map(|axis| axis.name.as_str()).collect();
            let message =
                format!("{name} is no axis of {}, which has {}", self.machine.name, axes.join(" "));
            self.fault(key.span(), &message, None);
        }
        place
    }

    fn work(&mut self, name: &str, axes: &DeTable<'_>) -> WorkOffset {
        let mut work = WorkOffset {
            name: name.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase(),
            ..WorkOffset::default()
        };
        for (key, value) in axes {
            let place = self.axis(key);
            let number = self.number(value, key.get_ref());
            if let (Some(place), Some(number)) = (place, number) {
                work.shift[place] = number * self.machine.axes[place].unit();
            }
        }
        work
    }

    fn references(
        &mut self,
        which: &Spanned<std::borrow::Cow<'_, str>>,
        value: &Spanned<DeValue<'_>>,
        references: &mut Vec<Reference>,
    ) {
        let number = match which.get_ref().as_ref() {
            "1" => 1,
            "2" => 2,
            other => {
                let message = format!(
                    "[reference.{other}] is neither [reference.1] (G28) nor [reference.2] (G30)"
                );
                return self.fault(which.span(), &message, None);
            }
        };
        let Some(axes) = self.table("reference", value) else {
            return;
        };
        for (key, value) in axes {
            let place = self.axis(key);
            let position = self.number(value, key.get_ref());
            if let (Some(place), Some(position)) = (place, position) {
                references.push(Reference {
                    which: number,
                    axis: key.get_ref().to_string(),
                    value: position * self.machine.axes[place].unit(),
                });
            }
        }
    }

    fn numbers(&mut self, table: &DeTable<'_>, what: &str) -> Vec<(u32, f64)> {
        let mut numbers = Vec::new();
        for (key, value) in table {
            let number = self.number(value, key.get_ref());
            match (key.get_ref().parse(), number) {
                (Ok(of), Some(number)) => numbers.push((of, number)),
                (Err(_), _) => {
                    let message = format!("{} is no number of a {what}", key.get_ref());
                    self.fault(key.span(), &message, None);
                }
                (Ok(_), None) => {}
            }
        }
        numbers
    }
}
