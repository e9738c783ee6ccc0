//! `--sweep`: the same file on the same machine, one number of it changed step by step.

use crate::deviations::{Distribution, Keeper, KeptMove};
use post_machine::description::Setting;
use post_machine::diagnostic::Diagnostic;

use super::sweep_values::Sweep;
use post_job::DryRun;
use post_job::failure::Failure;

/// What came of one value.
pub struct Swept {
    pub value: f64,
    /// Over all moves, mm.
    pub distribution: Distribution,
    /// The move that is looked at.
    pub kept: Option<KeptMove>,
}

/// Goes over the file once for each value, and keeps move `number`.
pub fn run(dry_run: &DryRun<'_>, sweep: &Sweep, number: usize) -> Result<Vec<Swept>, Failure> {
    let mut swept = Vec::new();
    for value in &sweep.values {
        let setting = Setting::Number { name: sweep.name.clone(), value: *value };
        let machine = super::machine(dry_run, &[setting])?;
        let mut keeper = Keeper::new(number..number + 1);
        dry_run.pass(&machine, Some(&mut keeper)).map_err(|failure| {
            let mut findings = failure.findings();
            let message = format!("this is with --sweep {} = {value}", sweep.name);
            findings.push(Diagnostic::error("study", message));
            findings
        })?;
        swept.push(Swept {
            value: *value,
            distribution: Distribution::of(&mut keeper.peaks),
            kept: keeper.kept.pop(),
        });
    }
    Ok(swept)
}
