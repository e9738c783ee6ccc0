//! Every option that a dialect declares, at every value that is worth a look: it writes with it, or says why not.

use post_plugin::{Event, OptionKind, OptionSpec};

use super::Case;
use super::pen::{BEGIN, ELSEWHERE, END, Pen};
use super::print::plain_moves;
use crate::{at, cut, rapid, turn};
use post_host::{GivenValue, PluginFault};

/// Runs them.
pub(super) fn options_of(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    values_of(pen, case, |_| true)
}

/// Flags and choices alone, for a second look: numbers and texts change the same everywhere.
pub(super) fn switches_of(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    values_of(pen, case, |kind| matches!(kind, OptionKind::Flag | OptionKind::Choice(_)))
}

fn values_of(
    pen: &Pen<'_>,
    case: &mut Case,
    wanted: fn(&OptionKind) -> bool,
) -> Result<(), PluginFault> {
    let mut tried = 0;
    for spec in pen.plugin.options().iter().filter(|spec| wanted(&spec.kind)) {
        if spec.help.is_empty() {
            case.note(format!("`{}` says nothing about itself", spec.key));
        }
        for value in values(spec) {
            tried += 1;
            let shown = format!("`{} = {}`", spec.key, shown(&value));
            let mut setup = pen.setup.clone();
            setup.options.retain(|(key, _)| key != spec.key);
            setup.options.push((spec.key.to_owned(), value));
            // A text has a meaning, which the kit cannot know; what is refused, is.
            let of_text = matches!(spec.kind, OptionKind::Text | OptionKind::Lines);
            let left_out = match pen.left_out_under(&setup) {
                Ok(names) => names,
                Err(fault) if of_text && !fault.to_string().contains("panicked") => continue,
                Err(fault) => {
                    case.note(format!("with {shown} it refuses to open: {fault}"));
                    continue;
                }
            };
            let pen = Pen { setup: &setup, left_out: &left_out, ..*pen };
            let mut own = Case::named("");
            match pen.write(&[BEGIN, LITTLE, END])? {
                Err(fault) if of_text && !fault.contains("panicked") => {}
                Err(fault) => own.wrong(fault),
                Ok(_) => plain_moves(&pen, &mut own)?,
            }
            let wrong = own.wrong.into_iter();
            case.wrong.extend(wrong.map(|sentence| format!("with {shown}: {sentence}")));
        }
    }
    case.facts.push(format!("{tried} values of {} options", pen.plugin.options().len()));
    Ok(())
}

/// A little of everything that moves.
const LITTLE: &[Event<'static>] = &[
    Event::Comment { text: "ALPHA" },
    turn(&ELSEWHERE),
    at(&ELSEWHERE),
    cut(&[2.0, 4.0, 80.0, 5.0, 6.0], 500.0),
    Event::Dwell { seconds: 1.5 },
    Event::Stop,
    rapid(&ELSEWHERE),
];

/// Both ends of a range, each of a choice, a text that could be a block.
fn values(spec: &OptionSpec) -> Vec<GivenValue> {
    let text = |text: &str| GivenValue::Text(text.to_owned());
    match spec.kind {
        OptionKind::Flag => vec![GivenValue::Flag(false), GivenValue::Flag(true)],
        OptionKind::Integer { min, max } => {
            vec![GivenValue::Integer(min), GivenValue::Integer(max)]
        }
        OptionKind::Number { min, max } => vec![GivenValue::Number(min), GivenValue::Number(max)],
        OptionKind::Choice(choices) => choices.iter().map(|choice| text(choice)).collect(),
        OptionKind::Text => vec![text(""), text("M88"), text("ø, 孔 (\"x\")")],
        OptionKind::Lines => vec![text(""), text("M88"), text("M88\nM89")],
    }
}

fn shown(value: &GivenValue) -> String {
    match value {
        GivenValue::Flag(flag) => flag.to_string(),
        GivenValue::Integer(integer) => integer.to_string(),
        GivenValue::Number(number) => number.to_string(),
        GivenValue::Text(text) => format!("{text:?}"),
    }
}
