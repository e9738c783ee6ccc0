//! Who may read and write what is written: a file that replaces another takes over its owner, its group and its rights.

use std::io;
use std::path::Path;

use crate::disk::File;

/// Gives `file` the owner, the group, the rights and the access list of the file at `target`, if there is one. The bits
/// that let a program run as somebody else (setuid, setgid) are not taken over.
///
/// # Errors
/// The system does not let this user give the file to its owner or group.
#[cfg(unix)]
pub fn take_over(file: &File, target: &Path) -> io::Result<()> {
    use std::fs::{self, Permissions};
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};

    let Ok(old) = fs::metadata(target) else {
        return Ok(());
    };
    let new = file.metadata()?;
    if (old.uid(), old.gid()) != (new.uid(), new.gid()) {
        let belongs = format!("it belongs to user {} and group {}", old.uid(), old.gid());
        fchown(file, Some(old.uid()), Some(old.gid()))
            .map_err(|error| not_kept(&format!("{belongs}, which"), error))?;
    }
    access_list::take_over(file, target).map_err(|error| not_kept("its access list", error))?;
    let rights = old.mode() & 0o777;
    if file.metadata()?.mode() & 0o7777 != rights {
        let set = file.set_permissions(Permissions::from_mode(rights));
        set.map_err(|error| not_kept(&format!("its rights ({rights:o})"), error))?;
    }
    Ok(())
}

#[cfg(unix)]
fn not_kept(what: &str, error: io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{what} cannot be kept: {error}"))
}

/// Rights of other systems come from the folder.
#[cfg(not(unix))]
pub fn take_over(_: &File, _: &Path) -> io::Result<()> {
    Ok(())
}

/// Access lists of Linux (POSIX 1003.1e draft). Without them the rights of the group would be those that the list gives
/// to somebody at all.
#[cfg(target_os = "linux")]
mod access_list {
    use std::fs::File;
    use std::io;
    use std::path::Path;

    use rustix::fs::{XattrFlags, fremovexattr, fsetxattr, getxattr};
    use rustix::io::Errno;

    const NAME: &str = "system.posix_acl_access";

    /// The longest list that Linux keeps, bytes.
    const LONGEST: usize = 1 << 16;

    pub fn take_over(file: &File, target: &Path) -> io::Result<()> {
        let mut list = vec![0; LONGEST];
        match getxattr(target, NAME, &mut list[..]) {
            Ok(length) => Ok(fsetxattr(file, NAME, &list[..length], XattrFlags::empty())?),
            // It has none, so what the folder gives to new files is taken away.
            Err(Errno::NODATA) => match fremovexattr(file, NAME) {
                Ok(()) | Err(Errno::NODATA | Errno::OPNOTSUPP) => Ok(()),
                Err(error) => Err(error.into()),
            },
            // A file system without access lists.
            Err(Errno::OPNOTSUPP) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }
}

#[cfg(all(unix, not(target_os = "linux")))]
mod access_list {
    use std::fs::File;
    use std::io;
    use std::path::Path;

    /// Rights are those of owner, group and others alone here.
    pub fn take_over(_: &File, _: &Path) -> io::Result<()> {
        Ok(())
    }
}
