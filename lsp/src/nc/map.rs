//! The CL line that a line of a program came from, as the map beside the program tells it (`post verify --map`).

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::SystemTime;

use serde::Deserialize;

use crate::cl::ENDINGS;

/// Longest map that is read, bytes.
const MOST_BYTES: u64 = 256 << 20;

/// A map of so many bytes is read while the editor waits.
const AT_ONCE: u64 = 1 << 20;

/// What the map says of a line.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct MapLine {
    nc_line: u64,
    /// The line of the CL file; none for a motion that nothing there asks for.
    pub cl_line: Option<u64>,
    /// Largest deviation of the tip, mm.
    pub tip_deviation_mm: f64,
    /// Largest deviation of the tool axis, degrees.
    pub axis_deviation_deg: f64,
}

/// A map of a program.
#[derive(Debug)]
pub struct ProgramMap {
    rows: Vec<MapLine>,
    /// The CL file beside it, by its name.
    pub cl: Option<PathBuf>,
}

/// The map beside a program, read once.
#[derive(Debug, Default)]
pub struct MapCache {
    read: Mutex<Option<CachedMap>>,
}

/// A map as it was when it was read.
#[derive(Debug)]
struct CachedMap {
    path: PathBuf,
    changed: SystemTime,
    /// None while it is read, or if it is no map.
    map: Option<Arc<ProgramMap>>,
}

impl MapCache {
    fn lock(&self) -> MutexGuard<'_, Option<CachedMap>> {
        // What is in it is whole whatever a thread died of.
        self.read.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The map of a program: `part.map.json` or `part.nc.map.json` of `part.nc`. One that is older than the program may
    /// speak of other lines, and is not taken. A long one is read in the background, and is not there until it is.
    pub fn of(self: &Arc<Self>, program: &Path) -> Option<Arc<ProgramMap>> {
        let name = program.file_name()?.to_string_lossy().into_owned();
        let candidates = [
            program.with_extension("map.json"),
            program.with_file_name(format!("{name}.map.json")),
        ];
        let path = candidates.into_iter().find(|path| path.is_file())?;
        let about = fs::metadata(&path).ok()?;
        let changed = about.modified().ok()?;
        if changed < fs::metadata(program).ok()?.modified().ok()? {
            return None;
        }
        let mut kept = self.lock();
        if let Some(kept) = &*kept
            && kept.path == path
            && kept.changed == changed
        {
            return kept.map.clone();
        }
        let mut now = CachedMap { path: path.clone(), changed, map: None };
        let program = program.to_owned();
        if about.len() <= AT_ONCE {
            now.map = load(&path, &program).map(Arc::new);
            return kept.insert(now).map.clone();
        }
        *kept = Some(now);
        drop(kept);
        let beside = Arc::clone(self);
        thread::spawn(move || {
            let map = load(&path, &program).map(Arc::new);
            if let Some(kept) = &mut *beside.lock()
                && kept.path == path
                && kept.changed == changed
            {
                kept.map = map;
            }
        });
        None
    }
}

fn load(map: &Path, program: &Path) -> Option<ProgramMap> {
    let mut text = String::new();
    let file = File::open(map).ok()?;
    file.take(MOST_BYTES).read_to_string(&mut text).ok()?;
    let mut rows: Vec<MapLine> = serde_json::from_str(&text).ok()?;
    rows.sort_by_key(|row| row.nc_line);
    let cl = ENDINGS.iter().map(|ending| program.with_extension(ending));
    let mut cl = cl.filter(|path| path.is_file());
    Some(ProgramMap { rows, cl: cl.next() })
}

impl ProgramMap {
    /// Of a line, counted from 1: the last of its rows, where it ends.
    pub fn line(&self, line: u64) -> Option<&MapLine> {
        let behind = self.rows.partition_point(|row| row.nc_line <= line);
        let row = self.rows.get(behind.checked_sub(1)?)?;
        (row.nc_line == line).then_some(row)
    }
}
