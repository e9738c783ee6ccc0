//! `[control] orientation`: which option of a dialect has it tell where the tool points so.

use post_host::{GivenValue, Plugin};
use post_machine::description::{ControlRules, Orientation};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{OptionKind, OptionSpec};

use super::given_values::given;

/// Options by which dialects write the direction of the tool in the place of the words of rotary axes.
const VECTORS: [&str; 2] = ["tool_vector", "tool_vectors"];

/// The option of a dialect that tells how the tool as a whole stands: it allows the forms that its language has.
const WHOLE: &str = "orientation";

/// The options of a machine's dialect, with what `orientation` asks for among them.
///
/// # Errors
/// The dialect does not tell it so, or its own option says otherwise.
pub fn options(
    plugin: &Plugin,
    control: &ControlRules,
) -> Result<Vec<(String, GivenValue)>, Box<Diagnostic>> {
    let mut options = given(&control.options);
    let Some(asked) = control.orientation else {
        return Ok(options);
    };
    let refused = |message: String, help: String| {
        let place = control.dialect_place.clone();
        Err(Box::new(Diagnostic::error("dialect", message).help(help).at(place)))
    };
    let Some((key, value)) = told(plugin.options(), asked) else {
        if asked == Orientation::Axes {
            return Ok(options);
        }
        let has = Orientation::ALL
            .iter()
            .filter(|one| **one == Orientation::Axes || told(plugin.options(), **one).is_some());
        let has: Vec<String> = has.map(|one| format!("\"{}\"", one.name())).collect();
        return refused(
            format!(
                "[control] orientation = \"{}\": the dialect {} does not tell where the tool points so",
                asked.name(),
                plugin.name()
            ),
            format!("it has {}", has.join(", ")),
        );
    };
    match options.iter().find(|(given, _)| *given == key) {
        None => options.push((key, value)),
        Some((_, given)) if *given == value => {}
        Some(_) => {
            return refused(
                format!(
                    "[control] orientation = \"{}\", and [control.{}] {key} says otherwise",
                    asked.name(),
                    plugin.name()
                ),
                format!("leave {key} out: orientation says the same for every dialect"),
            );
        }
    }
    Ok(options)
}

/// The option among those `declared` that tells it so, and its value.
fn told(declared: &[OptionSpec], asked: Orientation) -> Option<(String, GivenValue)> {
    let vector = declared.iter().find(|spec| VECTORS.contains(&spec.key));
    match asked {
        Orientation::Axes => vector.map(|spec| (spec.key.to_owned(), GivenValue::Flag(false))),
        Orientation::Vector => vector.map(|spec| (spec.key.to_owned(), GivenValue::Flag(true))),
        whole => {
            let spec = declared.iter().find(|spec| spec.key == WHOLE)?;
            let OptionKind::Choice(forms) = spec.kind else {
                return None;
            };
            let allowed = forms.contains(&whole.name());
            allowed.then(|| (WHOLE.to_owned(), GivenValue::Text(whole.name().to_owned())))
        }
    }
}
