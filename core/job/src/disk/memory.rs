//! A disk in memory, for a program that runs where there is none: as much of `std::fs` as the jobs use.
//!
//! Folders are there as soon as something lies in them. There are no links and no rights, and no clock tells when a file
//! was written to. A file lies in pieces: one that grows is never copied.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Bytes of a piece.
const PIECE: usize = 1 << 18;

/// What lies on the disk, by the names of its folders and its own with `/` between.
static DISK: Mutex<Contents> =
    Mutex::new(Contents { files: BTreeMap::new(), folders: BTreeSet::new() });

struct Contents {
    files: BTreeMap<String, Arc<Mutex<Bytes>>>,
    /// Those that were made, if nothing lies in them yet.
    folders: BTreeSet<String>,
}

#[derive(Debug, Default)]
struct Bytes {
    /// All of them full but the last.
    pieces: Vec<Vec<u8>>,
    length: usize,
}

/// What is locked is whole whatever a thread died of.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a file is known by: the way to it from the root, where every path begins.
fn key(path: &Path) -> String {
    let mut parts: Vec<String> = Vec::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            Component::ParentDir => drop(parts.pop()),
            Component::Prefix(_) | Component::RootDir | Component::CurDir => {}
        }
    }
    parts.join("/")
}

impl Contents {
    /// The files below a folder, by their ways from it.
    fn below<'s>(&'s self, folder: &'s str) -> impl Iterator<Item = &'s str> {
        self.files.keys().chain(&self.folders).filter_map(move |name| match folder {
            "" => Some(name.as_str()),
            folder => name.strip_prefix(folder)?.strip_prefix('/'),
        })
    }

    fn is_folder(&self, key: &str) -> bool {
        key.is_empty() || self.folders.contains(key) || self.below(key).next().is_some()
    }
}

impl Bytes {
    fn read(&self, at: usize, into: &mut [u8]) -> usize {
        let piece =
            self.pieces.get(at / PIECE).map(|piece| &piece[(at % PIECE).min(piece.len())..]);
        let piece = piece.unwrap_or_default();
        let count = piece.len().min(into.len());
        into[..count].copy_from_slice(&piece[..count]);
        count
    }

    fn write(&mut self, mut at: usize, mut bytes: &[u8]) {
        while self.length < at {
            let zeros = vec![0; (at - self.length).min(PIECE)];
            self.write(self.length, &zeros);
        }
        while !bytes.is_empty() {
            if at / PIECE == self.pieces.len() {
                self.pieces.push(Vec::new());
            }
            let (piece, within) = (&mut self.pieces[at / PIECE], at % PIECE);
            let count = bytes.len().min(PIECE - within);
            let over = count.min(piece.len() - within);
            piece[within..within + over].copy_from_slice(&bytes[..over]);
            piece.extend_from_slice(&bytes[over..count]);
            (at, bytes) = (at + count, &bytes[count..]);
            self.length = self.length.max(at);
        }
    }
}

/// An open file. Clones have one place in it together.
#[derive(Clone, Debug)]
pub struct File {
    bytes: Arc<Mutex<Bytes>>,
    at: Arc<AtomicU64>,
    appends: bool,
}

impl File {
    fn of(bytes: Arc<Mutex<Bytes>>) -> Self {
        Self { bytes, at: Arc::default(), appends: false }
    }

    /// Opens a file to read.
    ///
    /// # Errors
    /// There is none.
    pub fn open(path: impl AsRef<Path>) -> io::Result<Self> {
        OpenOptions::new().read(true).open(path)
    }

    /// The same file, at its start, with a place of its own in it.
    pub fn reopen(&self) -> Self {
        Self::of(Arc::clone(&self.bytes))
    }

    /// The same file at the same place.
    ///
    /// # Errors
    /// None here.
    pub fn try_clone(&self) -> io::Result<Self> {
        Ok(self.clone())
    }

    /// What is known of it.
    ///
    /// # Errors
    /// None here.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata { length: Some(locked(&self.bytes).length as u64) })
    }

    /// Nothing waits to be written.
    ///
    /// # Errors
    /// None here.
    pub fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    /// Nobody else is there.
    ///
    /// # Errors
    /// None here.
    pub fn try_lock(&self) -> Result<(), TryLockError> {
        Ok(())
    }

    /// Gives it a name, in the place of whatever has it.
    ///
    /// # Errors
    /// A folder has it.
    pub fn name(&self, path: &Path) -> io::Result<()> {
        let (key, mut disk) = (key(path), locked(&DISK));
        if disk.is_folder(&key) {
            return Err(ErrorKind::IsADirectory.into());
        }
        disk.files.insert(key, Arc::clone(&self.bytes));
        Ok(())
    }
}

impl Read for File {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let at = self.at.load(Ordering::Relaxed);
        let count = locked(&self.bytes).read(usize::try_from(at).unwrap_or(usize::MAX), into);
        self.at.store(at + count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

impl Write for &File {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut file = locked(&self.bytes);
        let at = match self.appends {
            true => file.length,
            false => self.at.load(Ordering::Relaxed) as usize,
        };
        file.write(at, bytes);
        self.at.store((at + bytes.len()) as u64, Ordering::Relaxed);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Write for File {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        (&*self).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for File {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => (locked(&self.bytes).length as u64).checked_add_signed(by),
            SeekFrom::Current(by) => self.at.load(Ordering::Relaxed).checked_add_signed(by),
        };
        let at = at.ok_or(ErrorKind::InvalidInput)?;
        self.at.store(at, Ordering::Relaxed);
        Ok(at)
    }
}

/// How a file is opened.
#[derive(Clone, Debug, Default)]
pub struct OpenOptions {
    appends: bool,
    creates: bool,
    empties: bool,
}

impl OpenOptions {
    /// To do nothing with it.
    pub fn new() -> Self {
        Self::default()
    }

    /// To read it, which anybody may.
    pub fn read(&mut self, _: bool) -> &mut Self {
        self
    }

    /// To write to it, which anybody may.
    pub fn write(&mut self, _: bool) -> &mut Self {
        self
    }

    /// To write at its end, wherever that is by then.
    pub fn append(&mut self, appends: bool) -> &mut Self {
        self.appends = appends;
        self
    }

    /// It is made if there is none.
    pub fn create(&mut self, creates: bool) -> &mut Self {
        self.creates = creates;
        self
    }

    /// What it holds is thrown away.
    pub fn truncate(&mut self, empties: bool) -> &mut Self {
        self.empties = empties;
        self
    }

    /// Opens it.
    ///
    /// # Errors
    /// There is none, or a folder has its name.
    pub fn open(&self, path: impl AsRef<Path>) -> io::Result<File> {
        let (key, mut disk) = (key(path.as_ref()), locked(&DISK));
        if disk.is_folder(&key) {
            return Err(ErrorKind::IsADirectory.into());
        }
        if self.creates {
            disk.files.entry(key.clone()).or_default();
        }
        let bytes = disk.files.get(&key).ok_or(ErrorKind::NotFound)?;
        if self.empties {
            *locked(bytes) = Bytes::default();
        }
        Ok(File { appends: self.appends, ..File::of(Arc::clone(bytes)) })
    }
}

/// Why a file is not locked.
#[derive(Debug)]
pub enum TryLockError {
    /// Somebody else has it.
    WouldBlock,
}

/// What is known of a file or a folder.
#[derive(Clone, Debug)]
pub struct Metadata {
    /// Of a file, bytes.
    length: Option<u64>,
}

impl Metadata {
    /// It is a file.
    pub fn is_file(&self) -> bool {
        self.length.is_some()
    }

    /// It is a folder.
    pub fn is_dir(&self) -> bool {
        self.length.is_none()
    }

    /// There are no links.
    pub fn is_symlink(&self) -> bool {
        false
    }

    /// Length, bytes.
    #[allow(clippy::len_without_is_empty, reason = "as std has it")]
    pub fn len(&self) -> u64 {
        self.length.unwrap_or(0)
    }

    /// Nobody knows when it was written to.
    ///
    /// # Errors
    /// Always.
    pub fn modified(&self) -> io::Result<SystemTime> {
        Err(ErrorKind::Unsupported.into())
    }
}

/// What is known of the file or folder at a path.
///
/// # Errors
/// There is none.
pub fn metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    let (key, disk) = (key(path.as_ref()), locked(&DISK));
    match disk.files.get(&key) {
        Some(file) => Ok(Metadata { length: Some(locked(file).length as u64) }),
        None if disk.is_folder(&key) => Ok(Metadata { length: None }),
        None => Err(ErrorKind::NotFound.into()),
    }
}

/// The same: there are no links.
///
/// # Errors
/// As [`metadata`].
pub fn symlink_metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    metadata(path)
}

/// There are no links.
///
/// # Errors
/// Always.
pub fn read_link(_: impl AsRef<Path>) -> io::Result<PathBuf> {
    Err(ErrorKind::InvalidInput.into())
}

/// The way from the root to what is there.
///
/// # Errors
/// Nothing is.
pub fn canonicalize(path: impl AsRef<Path>) -> io::Result<PathBuf> {
    metadata(&path)?;
    Ok(Path::new("/").join(key(path.as_ref())))
}

/// A file is there.
pub fn is_file(path: &Path) -> bool {
    metadata(path).is_ok_and(|found| found.is_file())
}

/// A folder is there.
pub fn is_dir(path: &Path) -> bool {
    metadata(path).is_ok_and(|found| found.is_dir())
}

/// Something is there.
pub fn exists(path: &Path) -> bool {
    metadata(path).is_ok()
}

/// Opens a file to be read.
///
/// # Errors
/// There is none.
pub fn open(path: impl AsRef<Path>) -> io::Result<File> {
    File::open(path)
}

/// All of a file.
///
/// # Errors
/// There is none.
pub fn read(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// All of a text.
///
/// # Errors
/// There is none, or it is not UTF-8.
pub fn read_to_string(path: impl AsRef<Path>) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.read_to_string(&mut text)?;
    Ok(text)
}

/// What lies in a folder.
#[derive(Clone, Debug)]
pub struct DirEntry {
    path: PathBuf,
}

impl DirEntry {
    /// The folder as it was named, and its name in it.
    pub fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// Its name.
    pub fn file_name(&self) -> OsString {
        self.path.file_name().unwrap_or_default().to_owned()
    }
}

/// What lies in a folder, in the order of the names.
///
/// # Errors
/// There is no such folder.
pub fn read_dir(
    folder: impl AsRef<Path>,
) -> io::Result<impl Iterator<Item = io::Result<DirEntry>>> {
    let folder = folder.as_ref();
    let (key, disk) = (key(folder), locked(&DISK));
    if !disk.is_folder(&key) {
        return Err(ErrorKind::NotFound.into());
    }
    let below = disk.below(&key).filter_map(|way| way.split('/').next());
    let names: BTreeSet<String> = below.map(str::to_owned).collect();
    let folder = folder.to_owned();
    Ok(names.into_iter().map(move |name| Ok(DirEntry { path: folder.join(name) })))
}

/// Takes a file away; who has it open has it still.
///
/// # Errors
/// There is none.
pub fn remove_file(path: impl AsRef<Path>) -> io::Result<()> {
    let removed = locked(&DISK).files.remove(&key(path.as_ref()));
    removed.map(drop).ok_or_else(|| ErrorKind::NotFound.into())
}

/// Makes a folder.
///
/// # Errors
/// A file has its name.
pub fn create_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    let (key, mut disk) = (key(path.as_ref()), locked(&DISK));
    if disk.files.contains_key(&key) {
        return Err(ErrorKind::AlreadyExists.into());
    }
    disk.folders.insert(key);
    Ok(())
}

/// Where texts wait that have no name yet.
pub fn temp_dir() -> PathBuf {
    PathBuf::from("/tmp")
}

/// A file without a name, gone once nobody has it open.
///
/// # Errors
/// None here.
pub fn unnamed() -> io::Result<File> {
    Ok(File::of(Arc::default()))
}

/// The ways from the root to all files, and their lengths, bytes.
pub fn files() -> Vec<(String, u64)> {
    let disk = locked(&DISK);
    disk.files.iter().map(|(name, file)| (name.clone(), locked(file).length as u64)).collect()
}
