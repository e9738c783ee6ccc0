//! What a job depends on, as one hash: whoever has an outcome of the same key need not do it again.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use super::JobStudy;
use super::inputs::{ClText, MachineTexts};
use super::job_line::JobLine;
use crate::clearance;
use crate::disk;
use crate::plugin_finder;

/// Changes when outcomes of old mean something else.
const FORMAT: &str = "post batch 1";

/// The key of a job. What is in it: the bytes of the CL file and its name (programs have it in their comments), the texts of
/// the machine and of all that it extends, its tools where a file has them, its bodies where nothing shall hit them, all settings and options, the version of `post` and the hash of its sources, names, versions and bytes of the
/// plugins.
///
/// # Errors
/// A plugin cannot be opened.
pub fn key(
    study: &JobStudy,
    job: &JobLine,
    cl: &ClText,
    texts: &MachineTexts,
    machine: &Machine,
) -> Result<String, Vec<Diagnostic>> {
    let mut hasher = blake3::Hasher::new();
    // Each part with its length, so that no two lists of parts look alike.
    let mut add = |part: &[u8]| {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    };
    add(FORMAT.as_bytes());
    add(env!("CARGO_PKG_VERSION").as_bytes());
    add(env!("POST_SOURCES").as_bytes());
    add(job.file.as_bytes());
    add(cl.hash.as_bytes());
    add(crate::files::json_line(texts).as_bytes());
    let settings = JobLine { file: String::new(), machine: None, ..job.clone() };
    add(crate::files::json_line(&settings).as_bytes());
    if let Some(file) = &machine.tool_table {
        add(format!("{:?}", file.tools).as_bytes());
    }
    add(study.options_text().as_bytes());
    if study.options.clearance {
        for file in clearance::files(machine) {
            // One that cannot be read is told when the job is done.
            let bytes = disk::read(file).unwrap_or_default();
            add(blake3::hash(&bytes).as_bytes());
        }
    }
    for name in [&machine.control.dialect, &machine.accuracy.model] {
        let plugin = study.finder.find(name);
        let plugin = plugin.map_err(|fault| vec![plugin_finder::diagnostic(&fault, &[], None)])?;
        add(plugin.name().as_bytes());
        add(plugin.version().as_bytes());
        add(plugin.hash().unwrap_or("linked").as_bytes());
    }
    Ok(hasher.finalize().to_hex().to_string())
}
