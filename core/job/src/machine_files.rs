//! Where machines come from: a file, a machine folder, or built in.

use std::collections::BTreeSet;
use std::env;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use post_machine::description::{
    self, GivenShape, MOST_BYTES, Machine, MachineReading, Setting, Source, StatedNumber,
};
use post_machine::diagnostic::{Diagnostic, nearest};

use crate::disk;
use crate::failure::Failure;
use crate::session::Session;
use crate::tools;

/// Names and texts of the machines built in.
const BUILT_IN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/machines.rs"));

/// The text of a machine of the library, which is built in.
pub fn of_library(name: &str) -> Option<&'static str> {
    let mut known = BUILT_IN.iter();
    known.find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Loads the machine `name` from the folders that the user `named`, the usual ones, or those built in, with
/// `settings` over it.
pub fn load(
    session: &Session,
    name: &str,
    named: &[PathBuf],
    settings: &[Setting],
) -> Result<Machine, Failure> {
    let read = |path: &Path| read(session, path);
    let source = source(name, named, &read)?;
    let mut machine = examine(source, named, settings, &read)?.machine?;
    equip(session, &mut machine)?;
    let heads = machine.heads.iter().map(|head| &head.machine);
    for solid in std::iter::once(&machine).chain(heads).flat_map(|machine| &machine.solids) {
        session.read_files().note("the solid", &solid.file);
    }
    let given = machine.stocks.iter().chain(&machine.fixtures);
    for body in given {
        if let GivenShape::File(file) = &body.shape {
            session.read_files().note("the body", file);
        }
    }
    Ok(machine)
}

/// Puts into a machine what the files have that its own names: tools, and errors of axes.
///
/// # Errors
/// A file that cannot be read, or what is wrong with it.
pub fn equip(session: &Session, machine: &mut Machine) -> Result<(), Failure> {
    tools::equip(session, machine)?;
    take_errors(session, machine)?;
    machine.heads.iter_mut().try_for_each(|head| take_errors(session, &mut head.machine))
}

fn take_errors(session: &Session, machine: &mut Machine) -> Result<(), Failure> {
    for table in std::mem::take(&mut machine.error_tables) {
        let text = match disk::is_file(&table.file) {
            true => read(session, &table.file),
            false => {
                let message = format!("{}: there is no such file", table.file.display());
                Err(Missing { message, help: None })
            }
        };
        let source = text.map_err(|missing| {
            Diagnostic::error("machine-errors", missing.message).at(table.place.clone())
        })?;
        machine.take_errors(&table, &source.text).map_err(|fault| *fault)?;
    }
    Ok(())
}

/// Reads the text of a file, which may be open in an editor and differ there.
pub type ReadText<'r> = &'r dyn Fn(&Path) -> Result<Source, Missing>;

/// The text of the machine `name`.
///
/// # Errors
/// There is no such machine, or its file cannot be read.
pub fn source(name: &str, named: &[PathBuf], read: ReadText<'_>) -> Result<Source, Failure> {
    let found = find_reading(name, &folders(named)?, read);
    Ok(found.map_err(Diagnostic::from)?)
}

/// What a text means as a machine; what it extends is looked for beside it first.
///
/// # Errors
/// A folder that is not there.
pub fn examine(
    source: Source,
    named: &[PathBuf],
    settings: &[Setting],
    read: ReadText<'_>,
) -> Result<MachineReading, Failure> {
    let near = near(&source.name, named)?;
    Ok(description::examine(source, settings, &mut |parent| extended(parent, &near, read)))
}

/// The text of the machine that the file `child` extends by the name `parent`.
///
/// # Errors
/// There is none, as a message.
pub fn parent(
    child: &str,
    parent: &str,
    named: &[PathBuf],
    read: ReadText<'_>,
) -> Result<Source, String> {
    let near = near(child, named).map_err(|_| "a folder of machines is not there".to_owned())?;
    extended(parent, &near, read)
}

/// Where the machines are that the file called `name` may extend: its neighbours first.
fn near(name: &str, named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut near: Vec<PathBuf> = Path::new(name)
        .parent()
        .filter(|folder| disk::is_dir(folder))
        .map(Path::to_owned)
        .into_iter()
        .collect();
    near.extend(folders(named)?);
    Ok(near)
}

fn extended(parent: &str, near: &[PathBuf], read: ReadText<'_>) -> Result<Source, String> {
    check_extended(parent, near)?;
    find_reading(parent, near, read).map_err(|missing| match missing.help {
        Some(help) => format!("{}; {help}", missing.message),
        None => missing.message,
    })
}

/// The folders of machines: those of the command line, of the environment, and `machines` here.
///
/// # Errors
/// Each folder that the user names and that is not there: a slip would take another machine in silence.
fn folders(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut folders = named.to_owned();
    if let Some(more) = env::var_os("POST_MACHINES") {
        folders.extend(env::split_paths(&more).filter(|path| !path.as_os_str().is_empty()));
    }
    let missing: Vec<Diagnostic> = folders
        .iter()
        .filter(|folder| !disk::is_dir(folder))
        .map(|folder| {
            let message = format!("{}: no such folder", folder.display());
            Diagnostic::error("machine", message)
                .help("--machines and POST_MACHINES name folders of machine files")
        })
        .collect();
    if !missing.is_empty() {
        return Err(missing.into());
    }
    folders.push(PathBuf::from("machines"));
    Ok(folders)
}

/// A machine that is not found or not readable.
pub struct Missing {
    message: String,
    help: Option<String>,
}

impl From<Missing> for Diagnostic {
    fn from(missing: Missing) -> Self {
        let mut fault = Self::error("machine", missing.message);
        fault.help = missing.help;
        fault
    }
}

/// A name with an ending or a folder is that of a file.
pub fn is_file(name: &str) -> bool {
    let path = Path::new(name);
    path.extension().is_some_and(|ending| ending == "toml") || path.components().count() > 1
}

/// The regular file `name`: as seen from here, or, as a file that is extended is named, from the one that extends it.
fn located(name: &str, folders: &[PathBuf]) -> Option<PathBuf> {
    let beside = folders.iter().map(|folder| folder.join(name));
    std::iter::once(name.into()).chain(beside).find(|path| disk::is_file(path))
}

fn find(session: &Session, name: &str, folders: &[PathBuf]) -> Result<Source, Missing> {
    find_reading(name, folders, &|path| read(session, path))
}

fn find_reading(name: &str, folders: &[PathBuf], read: ReadText<'_>) -> Result<Source, Missing> {
    if is_file(name) {
        return read(&located(name, folders).unwrap_or_else(|| name.into()));
    }
    for folder in folders {
        let path = folder.join(format!("{name}.toml"));
        if disk::is_file(&path) {
            return read(&path);
        }
    }
    if let Some(text) = of_library(name) {
        return Ok(Source { name: format!("{name}.toml (built in)"), text: text.to_owned() });
    }
    let known = names(folders);
    let meant = nearest(name, known.iter().map(|(name, _)| name.as_str()));
    Err(Missing {
        message: format!("there is no machine {name}"),
        help: Some(match meant {
            Some(meant) => format!("did you mean {meant}? `post machines` lists them"),
            None => "`post machines` lists those that a bare name finds; a file is named with its ending .toml".to_owned(),
        }),
    })
}

/// A machine file may be a stranger's, and name any file of the user's: what it extends is a machine by its name, or a
/// regular file that ends in `.toml`. (A pipe could keep the command waiting, a device has no end.)
fn check_extended(name: &str, folders: &[PathBuf]) -> Result<(), String> {
    let path = Path::new(name);
    if !is_file(name) {
        return Ok(());
    }
    if path.extension().is_none_or(|ending| ending != "toml") {
        return Err(format!(
            "extends names a machine or a file that ends in .toml, and {name} is neither"
        ));
    }
    match located(name, folders) {
        None if disk::exists(path) => Err(format!("{name} is no regular file")),
        _ => Ok(()),
    }
}

/// Reads a machine file from the disk.
pub fn read(session: &Session, path: &Path) -> Result<Source, Missing> {
    let fault = |why: String| Missing { message: format!("{}: {why}", path.display()), help: None };
    if disk::is_dir(path) {
        let message = format!("{} is a folder, no machine file", path.display());
        let help = "name a file in it that ends in .toml, or give the folder by --machines and the machine by its bare name";
        return Err(Missing { message, help: Some(help.to_owned()) });
    }
    let bytes = read_bounded(path).map_err(|error| fault(error.to_string()))?;
    if bytes.len() > MOST_BYTES {
        let why = format!("longer than {MOST_BYTES} bytes, which no machine file is");
        return Err(fault(why));
    }
    session.read_files().note("the machine file", path);
    let text = String::from_utf8(bytes)
        .map_err(|_| fault("a machine file is UTF-8 text, this is not".to_owned()))?;
    Ok(Source { name: path.display().to_string(), text })
}

/// The bytes of a file, up to one more than a machine file may have.
fn read_bounded(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let most = u64::try_from(MOST_BYTES).unwrap_or(u64::MAX);
    disk::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A machine that a bare name finds.
pub struct ListedMachine {
    /// The name.
    pub name: String,
    /// Its file; none if it is built in.
    pub path: Option<PathBuf>,
    /// What it is, or why it cannot be loaded.
    pub machine: Result<Machine, Failure>,
}

/// The machines that a bare name finds, those of the folders first.
///
/// # Errors
/// A folder that is not there.
pub fn list(session: &Session, named: &[PathBuf]) -> Result<Vec<ListedMachine>, Failure> {
    let listed = names(&folders(named)?).into_iter().map(|(name, path)| {
        let machine = load(session, &name, named, &[]);
        ListedMachine { name, path, machine }
    });
    Ok(listed.collect())
}

/// The numbers that the file of the machine `name` says, and those that it extends.
///
/// # Errors
/// There is no such machine, or its files cannot be read.
pub fn numbers(
    session: &Session,
    name: &str,
    named: &[PathBuf],
) -> Result<Vec<StatedNumber>, Failure> {
    let read = |path: &Path| read(session, path);
    let source = source(name, named, &read)?;
    let near = near(&source.name, named)?;
    Ok(description::stated_numbers(source, &mut |parent| extended(parent, &near, &read))?)
}

/// The text of the machine that the bare name `name` finds, as its file has it.
///
/// # Errors
/// There is no such machine.
pub fn text(session: &Session, name: &str, named: &[PathBuf]) -> Result<String, Failure> {
    if is_file(name) {
        let message = format!("{name} names a file, and a machine is printed by its bare name");
        return Err(Diagnostic::error("machine", message).into());
    }
    Ok(find(session, name, &folders(named)?).map_err(Diagnostic::from)?.text)
}

/// The bare names that find a machine from the folder of the file `beside`, and the files of those that are not built in.
pub fn known(beside: &str, named: &[PathBuf]) -> Vec<(String, Option<PathBuf>)> {
    near(beside, named).map_or_else(|_| Vec::new(), |near| names(&near))
}

/// The names that find a machine, each with the file that it finds; none for one that is built in.
fn names(folders: &[PathBuf]) -> Vec<(String, Option<PathBuf>)> {
    let mut rows: Vec<(String, Option<PathBuf>)> = Vec::new();
    for folder in folders {
        let entries = disk::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
        paths.sort();
        for path in paths {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            rows.push((name.into_owned(), Some(path)));
        }
    }
    rows.extend(BUILT_IN.iter().map(|(name, _)| ((*name).to_owned(), None)));
    // The first of a name is found.
    let mut met = BTreeSet::new();
    rows.retain(|(name, _)| met.insert(name.clone()));
    rows
}
