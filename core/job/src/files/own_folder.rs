//! A folder of files that a verb writes together, and writes again.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use post_machine::diagnostic::Diagnostic;

use super::{AtomicFile, FileFault, PathArg, Role};
use crate::disk;
use crate::session::Session;

/// The file by which a folder is known to be an earlier run's.
#[derive(Clone, Copy, Debug)]
pub struct FolderMark<'a> {
    /// Its name.
    pub name: &'static str,
    /// How it begins.
    pub begins: &'a str,
}

/// A folder whose files have known names: of what an earlier run left there nothing stays that would be taken for the
/// result of this one, and nothing is overwritten that is not of such a run.
pub struct OwnFolder<'a> {
    session: &'a Session,
    folder: &'a PathArg,
    role: Role,
    /// The files that there can be.
    names: Vec<&'static str>,
}

impl<'a> OwnFolder<'a> {
    /// The folder, which need not be there yet. Files of `names` in it are an earlier run's if `mark` is among them.
    ///
    /// # Errors
    /// It is no folder, or files in it have those names and are of no such run.
    pub fn open(
        session: &'a Session,
        folder: &'a PathArg,
        role: Role,
        mark: FolderMark<'_>,
        names: &[&'static str],
    ) -> Result<Self, Box<Diagnostic>> {
        let mut names = names.to_vec();
        if !names.contains(&mark.name) {
            names.push(mark.name);
        }
        let own = Self { session, folder, role, names };
        own.refuse_strangers(mark)?;
        Ok(own)
    }

    fn refuse_strangers(&self, mark: FolderMark<'_>) -> Result<(), Box<Diagnostic>> {
        let refuse = |message: String| {
            let finding = Diagnostic::error("output", message);
            Err(finding.help(self.role.remedy).boxed())
        };
        let (Some(place), Some(named)) = (self.folder.absolute(), self.folder.path()) else {
            return refuse("standard output is no folder".to_owned());
        };
        if disk::exists(place) && !disk::is_dir(place) {
            return refuse(format!("{} is no folder", named.display()));
        }
        let mut begin = Vec::new();
        let file = disk::File::open(place.join(mark.name));
        let read =
            file.and_then(|file| file.take(mark.begins.len() as u64).read_to_end(&mut begin));
        if read.is_ok() && begin == mark.begins.as_bytes() {
            return Ok(());
        }
        let mut names = self.names.iter();
        match names.find(|name| disk::exists(&place.join(name))) {
            None => Ok(()),
            Some(name) => refuse(format!(
                "the {what} would overwrite {}, which is of no {what}",
                named.join(name).display(),
                what = self.role.what
            )),
        }
    }

    fn path(&self, name: &str) -> PathArg {
        self.folder.map(|folder: &Path| -> PathBuf { folder.join(name) })
    }

    /// Puts files to `texts`, which take their names together; the folder is made if it is not there.
    pub fn add(
        &self,
        files: &[(&'static str, String)],
        texts: &mut Vec<AtomicFile>,
    ) -> Result<(), FileFault> {
        let place = self.folder.absolute().unwrap_or(Path::new("."));
        disk::create_dir_all(place).map_err(|error| FileFault::write(self.folder, error))?;
        let paths: Vec<PathArg> = files.iter().map(|(name, _)| self.path(name)).collect();
        let targets: Vec<(Role, &PathArg)> = paths.iter().map(|path| (self.role, path)).collect();
        let mut made = AtomicFile::create(self.session, &targets)?;
        for (file, (_, text)) in made.iter_mut().zip(files) {
            file.write_bytes(text.as_bytes())?;
        }
        texts.append(&mut made);
        Ok(())
    }

    /// Takes away what an earlier run left there, and this one did not write.
    pub fn tidy(&self, files: &[(&'static str, String)]) -> Result<(), FileFault> {
        let written = |name: &str| files.iter().any(|(known, _)| *known == name);
        for name in self.names.iter().filter(|name| !written(name)) {
            super::remove(self.session, self.role, &self.path(name))?;
        }
        Ok(())
    }
}
