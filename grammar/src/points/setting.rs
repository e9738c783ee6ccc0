//! What a list says besides its points.

use std::sync::Arc;

use super::{Cell, CellFault, CoolantWord, RecordPlace, SHOWN, Units};
use crate::text::excerpt;

/// What holds for all points of a list.
#[derive(Clone, Debug, Default)]
pub(super) struct Settings {
    pub(super) units: Option<Units>,
    pub(super) tool: Option<u32>,
    /// Revolutions a minute, clockwise.
    pub(super) spindle: Option<f64>,
    pub(super) coolant: Option<CoolantWord>,
    /// Of points that have none, units a minute.
    pub(super) feed: Option<f64>,
    /// Name of the part.
    pub(super) name: Option<String>,
    /// Where each of them stands.
    places: [Option<Arc<RecordPlace>>; SETTINGS.len()],
}

/// One that has a record of its own ahead of the points: its place in [`SETTINGS`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Setting {
    Units = 0,
    Tool = 1,
    Spindle = 2,
    Coolant = 3,
    Name = 5,
}

/// Their names.
const SETTINGS: [&str; 6] = ["units", "tool", "spindle", "coolant", "feed", "name"];

/// `word` is the name of one of them.
pub(super) fn is_setting(word: &str) -> bool {
    SETTINGS.iter().any(|name| name.eq_ignore_ascii_case(word))
}

impl Settings {
    /// The setting `name` stands there.
    pub(super) fn put(&mut self, name: &str, place: RecordPlace) {
        let known = SETTINGS.iter().position(|known| known.eq_ignore_ascii_case(name));
        if let Some(known) = known {
            self.places[known] = Some(Arc::new(place));
        }
    }

    /// Where it stands, if it was said.
    pub(super) fn place(&self, setting: Setting) -> Option<Arc<RecordPlace>> {
        self.places[setting as usize].clone()
    }

    /// Takes one; the value is the cell 1 of a fault, the name the cell 0.
    pub(super) fn take(&mut self, name: &str, value: &Cell) -> Result<(), CellFault> {
        let wrong =
            |help: &str| Err(CellFault::at(1, format!("`{name}` cannot be this"), help.to_owned()));
        let word = match value {
            Cell::Text(text) => text.trim().to_ascii_lowercase(),
            _ => String::new(),
        };
        let positive = match value {
            Cell::Number(number) => Some(*number).filter(|number| *number > 0.0),
            _ => None,
        };
        let given = match name.to_ascii_lowercase().as_str() {
            "units" => {
                let units = match word.as_str() {
                    "mm" => Units::Millimetre,
                    "inch" | "in" => Units::Inch,
                    _ => return wrong("mm or inch"),
                };
                self.units.replace(units).is_some()
            }
            "tool" => {
                let number = positive.filter(|number| number.fract() == 0.0 && *number < 1e9);
                let Some(number) = number else {
                    return wrong("a tool is a whole number above 0");
                };
                self.tool.replace(number as u32).is_some()
            }
            "spindle" => match positive {
                Some(speed) => self.spindle.replace(speed).is_some(),
                None => return wrong("revolutions a minute, above 0, clockwise"),
            },
            "feed" => match positive {
                Some(feed) => self.feed.replace(feed).is_some(),
                None => return wrong("units a minute, above 0"),
            },
            "coolant" => {
                let coolant = match (word.as_str(), value) {
                    ("off", _) | (_, Cell::Flag(false)) => CoolantWord::Off,
                    ("on", _) | (_, Cell::Flag(true)) => CoolantWord::On,
                    ("flood", _) => CoolantWord::Flood,
                    ("mist", _) => CoolantWord::Mist,
                    ("through", _) => CoolantWord::Through,
                    ("air", _) => CoolantWord::Air,
                    _ => return wrong("on, off, flood, mist, through or air"),
                };
                self.coolant.replace(coolant).is_some()
            }
            "name" => match value {
                Cell::Text(text) => self.name.replace(text.trim().to_owned()).is_some(),
                Cell::Number(number) => self.name.replace(number.to_string()).is_some(),
                _ => return wrong("a text"),
            },
            _ => {
                let message = format!("a list of points has no setting `{}`", excerpt(name, SHOWN));
                return Err(CellFault::at(
                    0,
                    message,
                    format!("expected one of {}", SETTINGS.join(", ")),
                ));
            }
        };
        match given {
            true => Err(CellFault::at(0, format!("`{name}` stands here twice"), "once is enough")),
            false => Ok(()),
        }
    }
}
