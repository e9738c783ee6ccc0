//! `--map` and `--plan-pictures`: the plan of each program, shown.

use post_machine::description::Machine;
use post_posting::plan::{PlanWatch, PlannedPoint};

use super::parts;
use post_job::failure::Failure;
use post_job::files::{AtomicFile, FileFault, JsonRows, OwnFolder, PathArg, Role};
use post_job::plan::map::{LimitMap, MapRow};
use post_job::plan::pictures;
use post_job::plan::posted::{MARK, PlanReference, PlanTrace};
use post_job::session::Session;
use post_job::settings::OutputSettings;

const PICTURES: Role = Role { what: "plan", remedy: "name another folder with --plan-pictures" };

/// What a map is to the files of a run.
pub const MAP: Role = Role { what: "map", remedy: "name another file with --map" };

/// The places of what is shown, program by program; empty where nothing is asked for.
pub struct Places {
    pub maps: Vec<PathArg>,
    folders: Vec<PathArg>,
}

/// The files of a folder of pictures.
pub type PictureFolder = Vec<(&'static str, String)>;

impl Places {
    /// Those of so many programs.
    pub fn of(outputs: &OutputSettings, count: usize) -> Self {
        let each = |named| parts::each(named, outputs.split, count);
        Self { maps: each(&outputs.map), folders: each(&outputs.plan_pictures) }
    }

    /// The folders of pictures.
    ///
    /// # Errors
    /// Something stands in the place of one, or files in it are no pictures of a plan.
    pub fn folders<'a>(&'a self, session: &'a Session) -> Result<Vec<OwnFolder<'a>>, Failure> {
        let mut opened = Vec::with_capacity(self.folders.len());
        for folder in &self.folders {
            let folder = OwnFolder::open(session, folder, PICTURES, MARK, &pictures::NAMES);
            opened.push(folder.map_err(|fault| *fault)?);
        }
        Ok(opened)
    }
}

/// Has a program written by `write`, with one who looks on if a map or pictures of it are asked for. What `write` gives, and
/// the pictures.
///
/// # Errors
/// Those of `write`, and of writing the map.
pub fn show<T>(
    machine: &Machine,
    program: &PathArg,
    map: Option<&mut AtomicFile>,
    draws: bool,
    write: impl FnOnce(Option<&mut dyn PlanWatch>) -> Result<T, Failure>,
) -> Result<(T, Option<PictureFolder>), Failure> {
    if map.is_none() && !draws {
        return Ok((write(None)?, None));
    }
    let limited = PlanReference::new(machine);
    let gauges = limited.gauges();
    let mut shown = PlanOutputs {
        map: map.map(MapFile::new),
        along: draws.then(|| PlanTrace::new(&limited, &gauges)),
    };
    let given = write(Some(&mut shown))?;
    if let Some(map) = shown.map {
        map.finish()?;
    }
    let name = program.path().and_then(|path| path.file_name());
    let name = name.map_or("program".into(), |name| name.to_string_lossy());
    Ok((given, shown.along.map(|along| along.files(&name))))
}

/// Who looks on.
struct PlanOutputs<'a> {
    map: Option<MapFile<'a>>,
    along: Option<PlanTrace<'a>>,
}

impl PlanWatch for PlanOutputs<'_> {
    fn planned(&mut self, point: &PlannedPoint<'_>) {
        if let Some(map) = &mut self.map {
            map.take(point);
        }
        if let Some(along) = &mut self.along {
            along.take(point);
        }
    }
}

/// A map that is written as it comes.
struct MapFile<'f> {
    map: LimitMap,
    file: &'f mut AtomicFile,
    rows: MapEncoding,
}

/// How it is written.
enum MapEncoding {
    Json(JsonRows),
    /// So far without a fault, or the first.
    Csv(Result<(), FileFault>),
}

impl<'f> MapFile<'f> {
    fn new(file: &'f mut AtomicFile) -> Self {
        let rows = match file.name().to_ascii_lowercase().ends_with(".csv") {
            true => MapEncoding::Csv(file.write_bytes(MapRow::HEAD.as_bytes())),
            false => MapEncoding::Json(JsonRows::default()),
        };
        Self { map: LimitMap::default(), file, rows }
    }

    fn take(&mut self, point: &PlannedPoint<'_>) {
        if let Some(row) = self.map.take(point) {
            self.rows.row(&row, self.file);
        }
    }

    fn finish(self) -> Result<(), FileFault> {
        let Self { map, file, mut rows } = self;
        if let Some(row) = map.finish() {
            rows.row(&row, file);
        }
        match rows {
            MapEncoding::Json(rows) => rows.end(file),
            MapEncoding::Csv(written) => written,
        }
    }
}

impl MapEncoding {
    fn row(&mut self, row: &MapRow, file: &mut AtomicFile) {
        match self {
            Self::Json(rows) => rows.row(row, file),
            Self::Csv(written) if written.is_ok() => {
                *written = file.write_bytes(row.csv().as_bytes());
            }
            Self::Csv(_) => {}
        }
    }
}
