//! Several texts take their names on a disk in memory, where only a folder of the same name can be in the way.

use std::io;
use std::path::PathBuf;

use super::temporary::Temporary;
use crate::disk;

/// Why not all texts have their names.
#[derive(Debug)]
pub struct NamingFault {
    /// Which one could not be given its name.
    pub index: usize,
    /// Why.
    pub error: io::Error,
    /// Those before it that have their names nevertheless: none.
    pub stuck: Vec<(usize, Option<PathBuf>)>,
}

/// Gives all texts their names, or none.
///
/// # Errors
/// A folder has one of them.
pub fn name_all(texts: &mut [(Temporary, PathBuf)]) -> Result<(), NamingFault> {
    let fault = |index, error| NamingFault { index, error, stuck: Vec::new() };
    if let Some(index) = texts.iter().position(|(_, path)| disk::is_dir(path)) {
        return Err(fault(index, io::ErrorKind::IsADirectory.into()));
    }
    for (index, (text, path)) in texts.iter().enumerate() {
        let named = text.as_file().and_then(|file| file.name(path));
        named.map_err(|error| fault(index, error))?;
    }
    Ok(())
}
