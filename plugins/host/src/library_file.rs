//! The file of a library: what can be known of it before any of its code runs.

use std::fs::{self, File, Metadata};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use object::read::{ExportTarget, NameOrOrdinal};
use object::{Architecture, BinaryFormat, Object as _, ObjectSegment as _};

/// Bytes of the largest library that is read.
const MOST: u64 = 1 << 30;

/// A library's file as it was when it was looked at.
#[derive(Debug, PartialEq)]
pub(crate) struct LibraryFile {
    /// Where it lies, links followed.
    pub(crate) path: PathBuf,
    /// BLAKE3 of its bytes, in hexadecimal digits.
    pub(crate) hash: String,
    stamp: Stamp,
}

/// What changes if another file takes the name, or this one is written to.
#[derive(Debug, PartialEq)]
struct Stamp {
    length: u64,
    modified: Option<SystemTime>,
    /// Device, inode, and the seconds and nanoseconds of the last change of any kind, which nobody can set.
    #[cfg(unix)]
    identity: [i128; 4],
}

impl Stamp {
    fn of(data: &Metadata) -> Self {
        #[cfg(unix)]
        let identity = {
            use std::os::unix::fs::MetadataExt as _;
            [data.dev().into(), data.ino().into(), data.ctime().into(), data.ctime_nsec().into()]
        };
        Stamp {
            length: data.len(),
            modified: data.modified().ok(),
            #[cfg(unix)]
            identity,
        }
    }
}

impl LibraryFile {
    /// Looks at the file at `path`, which must be a whole library for this system that exports `symbol` itself.
    ///
    /// # Errors
    /// Why it cannot be opened; none if it does not export the symbol.
    pub(crate) fn look(path: &Path, symbol: &str) -> Result<Self, Option<String>> {
        let (file, bytes) = Self::read(path)?;
        if !judge(&bytes, symbol)? {
            return Err(None);
        }
        Ok(file)
    }

    /// The system opens a file by its name, and no way to hand it bytes serves everyone: a copy in memory or in
    /// another folder would not find what a library looks for beside itself (`$ORIGIN`), is barred where such places
    /// are not executable, and is nameless in a debugger. So the file is looked at again once it is open: the hash
    /// that is told is that of the library that was loaded, or the library is refused.
    ///
    /// # Errors
    /// It is another file, or cannot be read any more: a library may have used up what the system lets a process open.
    pub(crate) fn look_again(&self) -> Result<(), String> {
        let again = Self::read(&self.path);
        let (again, _) =
            again.map_err(|why| format!("it is open, and cannot be read again: {why}"))?;
        match again == *self {
            true => Ok(()),
            false => Err("its file was changed while it was opened".to_owned()),
        }
    }

    fn read(path: &Path) -> Result<(Self, Vec<u8>), String> {
        let words = |error: std::io::Error| error.to_string();
        // A name without a folder would be looked for in the system's folders.
        let path = path.canonicalize().map_err(words)?;
        let data = fs::metadata(&path).map_err(words)?;
        // Reading a pipe or a device might never end; so might opening it.
        if !data.is_file() {
            return Err("it is no file".to_owned());
        }
        if data.len() > MOST {
            return Err(format!("it has more than {MOST} bytes"));
        }
        let mut bytes = Vec::new();
        let opened = File::open(&path).map_err(words)?;
        opened.take(MOST).read_to_end(&mut bytes).map_err(words)?;
        let hash = blake3::hash(&bytes).to_hex().to_string();
        let stamp = Stamp::of(&data);
        Ok((LibraryFile { path, hash, stamp }, bytes))
    }
}

/// Whether a library exports `symbol`. It must be for this system, and whole: the system maps what its headers promise
/// and dies where the file ends before that.
fn judge(bytes: &[u8], symbol: &str) -> Result<bool, String> {
    let broken = |error: object::Error| format!("it is no library: {error}");
    let file = object::File::parse(bytes).map_err(broken)?;
    if file.format() != NATIVE {
        return Err(format!("it is built for another system ({:?})", file.format()));
    }
    if let Some(here) = architecture()
        && file.architecture() != here
    {
        return Err(format!(
            "it is built for another processor ({:?}, this is {here:?})",
            file.architecture()
        ));
    }
    let cut_off = file.segments().any(|segment| {
        let (start, size) = segment.file_range();
        start.checked_add(size).is_none_or(|end| end > bytes.len() as u64)
    });
    if cut_off {
        return Err("it is cut off: its headers promise more than the file holds".to_owned());
    }
    // A library that this one needs may have the symbol too, and is no part of what is hashed.
    for export in file.exports().map_err(broken)? {
        let export = export.map_err(broken)?;
        let NameOrOrdinal::Name(name) = export.name() else {
            continue;
        };
        let name = match file.format() {
            BinaryFormat::MachO => name.strip_prefix(b"_").unwrap_or(name),
            _ => name,
        };
        if name == symbol.as_bytes() {
            return Ok(!matches!(export.target(), ExportTarget::Reexport { .. }));
        }
    }
    Ok(false)
}

/// The format of this system's libraries.
const NATIVE: BinaryFormat = if cfg!(windows) {
    BinaryFormat::Pe
} else if cfg!(target_vendor = "apple") {
    BinaryFormat::MachO
} else {
    BinaryFormat::Elf
};

/// The processor that this program is built for; none if the format's name for it is not known here.
fn architecture() -> Option<Architecture> {
    Some(match std::env::consts::ARCH {
        "x86_64" if cfg!(target_pointer_width = "64") => Architecture::X86_64,
        "x86" => Architecture::I386,
        "aarch64" => Architecture::Aarch64,
        "arm" => Architecture::Arm,
        "riscv64" => Architecture::Riscv64,
        "powerpc64" => Architecture::PowerPc64,
        "s390x" => Architecture::S390x,
        "loongarch64" => Architecture::LoongArch64,
        _ => return None,
    })
}
