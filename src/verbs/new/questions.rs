//! The few questions of `post new`: on a terminal, or answered through a pipe.

use std::io::{self, BufRead};

use clap::ValueEnum;
use post_machine::description::Tcp;
use post_machine::diagnostic::Diagnostic;

use super::template::{ARM_LENGTHS, Class};
use super::{AxisSetting, Choices, NewArguments, dialect, range};
use crate::flag_words::TcpWord;
use post_cli::arguments::flag_values::finite;
use post_cli::terminal::tell;
use post_job::failure::Failure;

/// How often a wrong answer is asked again.
const PATIENCE: usize = 3;

/// Asks for what no flag says. An empty answer, or the end of the input, takes what stands in brackets; only the
/// class must be said.
pub fn ask(arguments: &NewArguments, choices: &mut Choices) -> Result<(), Failure> {
    let classes: Vec<String> = Class::value_variants().iter().map(|class| class.name()).collect();
    tell("How do the rotary axes stand?\n");
    for class in Class::value_variants() {
        let help = class.to_possible_value();
        let help = help.as_ref().and_then(|value| value.get_help());
        let help = help.map_or_else(String::new, ToString::to_string);
        tell(&format!("  {:<22}{help}\n", class.name()));
    }
    choices.class = question("class", "", |answer| {
        if answer.is_empty() {
            return Err(format!("one of {}", classes.join(", ")));
        }
        Class::from_str(answer, true)
    })?
    .ok_or_else(|| {
        Diagnostic::error("new", "nobody says what class the machine is of")
            .help(format!("--class {}", classes.join("|")))
    })?;
    if arguments.dialect.is_none() {
        let usual = choices.dialect.clone();
        let said =
            question("dialect of the control: fanuc, heidenhain, linuxcnc", &usual, dialect)?;
        choices.dialect = said.unwrap_or(usual);
    }
    choices.tcp = arguments.tcp.unwrap_or(choices.class.usual_tcp());
    if choices.class.keeps_tips() && arguments.tcp.is_none() {
        let said = question(
            "who keeps the tip on its path: post or control (RTCP, TCP, TCPM)",
            choices.tcp.name(),
            |answer| {
                TcpWord::from_str(answer, true)
                    .map(Tcp::from)
                    .map_err(|_| "post or control".to_owned())
            },
        )?;
        choices.tcp = said.unwrap_or(choices.tcp);
    }
    if choices.class.has_arm() && arguments.arm.is_none() {
        for ((name, what), length_of_arm) in ARM_LENGTHS.iter().zip(&mut choices.arm) {
            *length_of_arm = length(&format!("{name}: {what}, mm"), *length_of_arm)?;
        }
    }
    if choices.class.has_gauge() && arguments.gauge.is_none() {
        choices.gauge =
            length("gauge line over the table's face, all axes at zero, mm", choices.gauge)?;
    }
    if choices.class.has_pivot() && arguments.pivot.is_none() {
        choices.pivot = length("swivel axis of the head to the gauge line, mm", choices.pivot)?;
    }
    if choices.class.has_tilt() && arguments.tilt.is_none() {
        choices.tilt =
            length("tilting axis over the table's face (below is negative), mm", choices.tilt)?;
    }
    for axis in choices.class.axes() {
        let said = |given: &AxisSetting<[f64; 2]>| given.axis == axis;
        if choices.travel.iter().any(said) || choices.cyclic.iter().any(|name| name == axis) {
            continue;
        }
        let rotary = !matches!(axis, "X" | "Y" | "Z");
        let usual = match choices.class.usual_travel(axis, choices.gauge) {
            Some([least, most]) => format!("{least}:{most}"),
            None => "endless".to_owned(),
        };
        let what = match rotary {
            true => format!("travel of {axis}, degrees, or endless"),
            false => format!("travel of {axis}, mm"),
        };
        let travel = question(&what, &usual, |answer| match answer {
            "endless" if rotary => Ok(None),
            travel => range(travel).map(Some),
        })?;
        match travel.flatten() {
            Some(value) => choices.travel.push(AxisSetting { axis: axis.to_owned(), value }),
            None if rotary => choices.cyclic.push(axis.to_owned()),
            None => {}
        }
    }
    Ok(())
}

fn length(what: &str, usual: f64) -> Result<f64, Failure> {
    Ok(question(what, &usual.to_string(), finite)?.unwrap_or(usual))
}

/// Asks until the answer can be read; an empty one is `usual`. None at the end of the input.
fn question<T>(
    what: &str,
    usual: &str,
    read: impl Fn(&str) -> Result<T, String>,
) -> Result<Option<T>, Failure> {
    let mut fault = String::new();
    for _ in 0..PATIENCE {
        tell(&match usual {
            "" => format!("{what}: "),
            usual => format!("{what} [{usual}]: "),
        });
        let mut answer = String::new();
        let length = io::stdin()
            .lock()
            .read_line(&mut answer)
            .map_err(|error| Diagnostic::error("new", format!("standard input: {error}")))?;
        let ended = length == 0;
        let answer = match answer.trim() {
            "" => usual,
            answer => answer,
        };
        if ended && usual.is_empty() {
            return Ok(None);
        }
        match read(answer) {
            Ok(value) => return Ok(Some(value)),
            Err(message) => {
                tell(&format!("{message}\n"));
                fault = message;
            }
        }
    }
    Err(Diagnostic::error("new", format!("{what}: {fault}")).into())
}
