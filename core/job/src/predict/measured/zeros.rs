//! From which zeros the axes of a log count: `--log-zeros`.

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, meant};
use post_machine::kinematics::MAX_AXES;

/// What is said of a log's zeros.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LogZeros {
    /// They are found.
    #[default]
    Found,
    /// The log counts as the machine file does.
    None,
    /// What the log counts more, mm or degrees, by axis; of the others it is found.
    Told(Vec<(String, f64)>),
}

/// `none`, or `X=250,C=-90`.
pub fn log_zeros(text: &str) -> Result<LogZeros, String> {
    if text.trim() == "none" {
        return Ok(LogZeros::None);
    }
    let mut zeros = Vec::new();
    for part in text.split(',').map(str::trim) {
        let told = part.split_once('=');
        let told = told.and_then(|(axis, value)| {
            let value: f64 = value.trim().parse().ok()?;
            value.is_finite().then(|| (axis.trim().to_owned(), value))
        });
        zeros.push(told.ok_or_else(|| {
            format!("`{part}` is not of the form AXIS=VALUE; `none` takes nothing off")
        })?);
    }
    Ok(LogZeros::Told(zeros))
}

impl LogZeros {
    /// By axis, mm or radians; none: it is found.
    ///
    /// # Errors
    /// An axis that the machine does not have, or that is named twice.
    pub fn by_axis(&self, machine: &Machine) -> Result<[Option<f64>; MAX_AXES], Box<Diagnostic>> {
        let mut zeros = [None; MAX_AXES];
        let told = match self {
            Self::Found => return Ok(zeros),
            Self::None => return Ok([Some(0.0); MAX_AXES]),
            Self::Told(told) => told,
        };
        for (name, value) in told {
            let names: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
            let fault = |message: String| {
                let help = meant(name, "the machine has", &names);
                Err(Diagnostic::error("log-zeros", message).help(help).boxed())
            };
            let Some(place) = names.iter().position(|known| known == name) else {
                return fault(format!("--log-zeros: the machine has no axis {name}"));
            };
            if zeros[place].is_some() {
                return fault(format!("--log-zeros names {name} twice"));
            }
            zeros[place] = Some(value * machine.axes[place].unit());
        }
        Ok(zeros)
    }
}
