//! `post --caller`: the program that calls those of the parts of a CL file, which end as subprograms do.

use post_host::Finder;
use post_machine::description::{Machine, TextPlace};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Batch, Capabilities, DialectSession, Event, Language, Meaning};

use crate::failure::Failure;
use crate::files::PathArg;
use crate::{nc_program, plugin_finder};

/// A program that is called.
#[derive(Clone, Debug)]
pub struct CalledProgram {
    /// Its number, of a dialect whose programs have one.
    pub number: Option<u32>,
    /// Its name: that of its file, without the ending.
    pub name: String,
    /// What it does, for the operator.
    pub remark: String,
}

/// Has programs of this machine end as subprograms: by the lines of its file, else by the dialect's word, where programs
/// that are called by `number` or by name need no more than that.
///
/// # Errors
/// No word is known that ends what is called.
pub fn end_as_subprogram(
    finder: &Finder,
    machine: &mut Machine,
    number: Option<i64>,
) -> Result<(), Failure> {
    if machine.program.text(TextPlace::End).is_some() {
        return Ok(());
    }
    let spoken = nc_program::spoken(finder, machine)?;
    let plain = number.is_some() || spoken.language == Language::Names;
    let mut words = spoken.words.iter().filter(|_| plain);
    let Some(end) = words.find(|word| word.meaning == Meaning::SubprogramEnd) else {
        let message = format!(
            "--caller: the dialect {} says no word that ends a program which another one calls",
            machine.control.dialect
        );
        let help = "[program] end in the machine file says what stands in the place of M30";
        return Err(Diagnostic::error("caller", message).help(help).into());
    };
    machine.program.end_by(&end.word);
    Ok(())
}

/// The program `target` that calls these, one after the other.
///
/// # Errors
/// The dialect cannot be used, or has no words for it.
pub fn text(
    finder: &Finder,
    machine: &Machine,
    cl_file: &PathArg,
    target: &PathArg,
    calls: &[CalledProgram],
) -> Result<String, Failure> {
    let program = target.stem().unwrap_or_default();
    let (mut dialect, _) = plugin_finder::dialect(finder, machine, &program, Some(cl_file))?;
    let refused = |message: String| Diagnostic::error("caller", message);
    if !dialect.capabilities().has(Capabilities::SUBPROGRAM) {
        let message =
            format!("--caller: the dialect {} has no words for calls", machine.control.dialect);
        return Err(refused(message).help("--split alone writes programs without one").into());
    }
    let mut batch = Batch::default();
    batch.push(0, Event::Start);
    for CalledProgram { number, name, remark } in calls {
        batch.push(0, Event::Comment { text: remark });
        let name = if number.is_some() { "" } else { name };
        batch.push(0, Event::Subprogram { number: *number, times: 1, name });
    }
    batch.push(0, Event::End);
    let (mut text, mut ends) = (String::new(), Vec::new());
    dialect.write_batch(&batch, &mut text, &mut ends).map_err(|fault| {
        refused(fault.message).help("-o names the programs, in letters, digits and _")
    })?;
    Ok(text)
}
