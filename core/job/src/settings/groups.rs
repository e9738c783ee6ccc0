//! The groups of settings: how a CL file is read, what is set over the machine file, how programs are made, what is told
//! of them, and how programs are read back.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread;

use post_grammar::Units;
use post_machine::description::{Setting, Tcp};
use post_posting::program::{DefaultSpindle, UnknownWordPolicy};
use post_readback::interpret::Limits;

use super::table::settings;
use super::values::{
    ANGLE, CL_WORD, COUNT, FEED, FILE, FILE_IF_ANY, FOLDER, JOBS, LENGTH, MSYS, NAME, POINT,
    PROGRAM_NUMBER, ROUNDS, SETTING, SPINDLE, SPLIT, TCP, TOLERANCE, TOOL, UNITS, UNKNOWN,
};
use crate::files::PathArg;
use crate::job_file::JobMark;

/// What becomes of points and axes in a frame of NX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Msys {
    /// They are taken as they are written.
    #[default]
    Keep,
    /// They are taken into the frame.
    Apply,
}

/// Where one CL file becomes several programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// At each operation.
    Operations,
    /// At each further tool.
    Tools,
}

settings! {
    /// How a CL file is read.
    ReadingSettings, Some("Reading");

    /// A further CL file of the same program, read behind the first: each begins as a file of its own, the tool retracted
    /// in between. Repeatable, in their order.
    many then: PathArg = FILE, "FILE";

    /// An operation that the program is made of, by its name (`TOOL PATH`; `T3` in files without any) or its number in the
    /// order of the CL files, from 1; the others are left out. Repeatable; the order stays that of the CL files.
    many operations: String = NAME, "NAME";

    /// Units of the numbers in the CL file; overrides what the file says.
    one units: Units = UNITS, "UNITS";

    /// What to do with MSYS of NX: `keep` takes points and tool axes as written, `apply` transforms them into its
    /// frame.
    given msys: Msys = MSYS, "WHAT", default || "keep".to_owned();

    /// What to do with words that have no effect: refuse the file for any of them (`error`), refuse it only for words
    /// that post does not know (`known`), leave them out with a warning (`warn`), or write them as comments (`pass`). A
    /// word that may be a move is always refused.
    given unknown: UnknownWordPolicy = UNKNOWN, "WHAT", default || "known".to_owned();

    /// Leaves a word out at your own risk: a word that post does not know, or one that changes where or whether metal
    /// is cut (`OFSETL`), `INSERT` (codes become comments), `CUTTER` (several cutters are one tool), `FINI` (the file
    /// is complete), `DEEP` and the other peck cycles (a cycle without a peck goes to depth in one move), `MOVARC`
    /// (half turns go right-handed about their axis). A word that may be a move is never left out. Repeatable.
    many allow: String = CL_WORD, "WORD";

    /// Tool number, for a CL file that loads no tool.
    one tool: u32 = TOOL, "N";

    /// Numbers tools from 1 in the order of their cutters, for a CL file that describes several and loads none.
    flag tool_from_cutter, { conflicts: Some("tool") };

    /// Spindle speed for each tool that the CL file gives none, 1/min; `off` cuts with the spindle stopped.
    one spindle: DefaultSpindle = SPINDLE, "RPM";

    /// Feed for cuts that the CL file gives none, mm/min.
    one feed: f64 = FEED, "MM_A_MINUTE";
}

settings! {
    /// What is set over the machine file for a job, and where machines and plugins are looked for.
    MachineSettings, Some("Machine");

    /// Where the part origin sits for this job, all axes at zero, machine frame, mm.
    one mount: [f64; 3] = POINT, "X,Y,Z", { hyphens: true, columns: &["mount_x_mm", "mount_y_mm", "mount_z_mm"] };

    /// How the part is turned about its Z for this job, degrees, right-handed: counter-clockwise for who looks down on
    /// it, from the machine's X to the part's, all axes at zero. The work offset is not turned: words of the tip are
    /// written along the machine's axes.
    one turn: f64 = ANGLE, "DEG", { hyphens: true, columns: &["turn_deg"] };

    /// Length of every tool from the gauge point to the tip, mm; overrides machine file and CL file.
    one tool_length: f64 = LENGTH, "MM", { hyphens: true, columns: &["tool_length_mm"] };

    /// The file that has the tools: tool table, offsets as a program, library or CSV table (`post tools --formats`); short
    /// for --set tools.file=… Lengths are taken from it, and each tool that the CL file calls must be there.
    one tools: PathArg = FILE, "FILE";

    /// Sets a parameter of the machine (`Lm=312`) or any key (`accuracy.tolerance=0.001`).
    many set: Setting = SETTING, "NAME=VALUE";

    /// Largest deviation of the tip in a cut, mm; short for --set accuracy.tolerance=…
    one tolerance: f64 = TOLERANCE, "MM", { columns: &["tolerance_mm"] };

    /// Who keeps the tip on its path, the control by RTCP (TCP, TCPM) or the post; short for --set control.tcp=…
    one tcp: Tcp = TCP, "WHO", { columns: &["tcp"] };

    /// Posts in another dialect than the machine file names, with the options that it has for that one; short for
    /// --set control.dialect=… (`post plugin list`).
    one dialect: String = NAME, "NAME", { columns: &["dialect"] };

    /// Drops CL points that the tolerance makes redundant; short for --set accuracy.reduce=true.
    flag reduce;

    /// Fits the fewest arcs and lines to runs of points within the tolerance, where the dialect has arcs; short for
    /// --set control.arcs.fit=true.
    flag fit_arcs;

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    many machines: PathBuf = FOLDER, "FOLDER";

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs its code,
    /// so only folders named here are searched.
    many plugins: PathBuf = FOLDER, "FOLDER", { heading: Some("Plugins") };
}

impl ReadingSettings {
    /// Operations are chosen, or several files are read.
    pub fn is_chosen(&self) -> bool {
        !self.then.is_empty() || !self.operations.is_empty()
    }
}

impl MachineSettings {
    /// What is set over the machine file: `set` first, then the short ones, which win.
    pub fn settings(&self) -> Vec<Setting> {
        let mut settings = tools_setting(self.tools.as_ref());
        settings.extend_from_slice(&self.set);
        settings.extend(self.mount.map(Setting::Mount));
        settings.extend(self.turn.map(Setting::Turn));
        settings.extend(self.tolerance.map(Setting::Tolerance));
        settings.extend(self.tcp.map(Setting::Tcp));
        settings.extend(self.dialect.clone().map(Setting::Dialect));
        settings.extend(self.reduce.then_some(Setting::Reduce(true)));
        settings.extend(self.fit_arcs.then_some(Setting::FitArcs(true)));
        settings
    }
}

/// What is set where a file of tools is named.
fn tools_setting(file: Option<&PathArg>) -> Vec<Setting> {
    let path = file.map(|file| file.path().unwrap_or(Path::new("/dev/stdin")).to_owned());
    path.map(Setting::Tools).into_iter().collect()
}

/// A CL file, how it is read, and the machine.
#[derive(Clone, Debug)]
pub struct JobSettings {
    /// The machine: a TOML file, or the name of one in a machine folder or built in.
    pub machine: String,
    /// The CL file.
    pub input: PathArg,
    /// How it is read.
    pub reading: ReadingSettings,
    /// What is set over the machine file.
    pub over: MachineSettings,
    /// The job file that says all of it, if one does.
    pub mark: Option<JobMark>,
}

impl JobSettings {
    /// The CL files, in their order.
    pub fn files(&self) -> impl Iterator<Item = &PathArg> {
        std::iter::once(&self.input).chain(&self.reading.then)
    }
}

settings! {
    /// What a run writes beside what it prints, and what it finds out of its programs.
    OutputSettings, None;

    /// The NC program, `-` for standard output. [default: beside the CL file, with the dialect's ending]
    one output: PathArg = FILE, "FILE", { short: Some('o') };

    /// Writes the summary as JSON; `-` is standard output. Several programs give a list.
    one summary: PathArg = FILE, "FILE";

    /// Writes a setup sheet: part origin and work offset, tools, operations, extents, times, options; HTML with a
    /// picture if the name ends in .html, else Markdown.
    one setup_sheet: PathArg = FILE, "FILE";

    /// Writes a separate program for each operation or each tool: part-1.nc, part-2.nc, …
    one split: Split = SPLIT, "WHERE";

    /// With `--split`: the programs end as subprograms do, and one more, by the name of all, calls them in their order.
    flag caller;

    /// Verifies each program before it is written (`post verify`): reads it back, runs it as the control does and
    /// compares it with the CL file. A program that deviates is not written.
    flag verify;

    /// Proves that nothing hits anything while each program runs, before it is written (`post clearance`): reads it back, and
    /// holds the bodies of the machine file against one another along all motions. A program that is not clear is not
    /// written. Of several ways to turn the axes those are taken with which it is, where there are any.
    flag clearance;

    /// Predicts what each program does on the machine (`post predict`): cycle time, true feed, axis motion and contour
    /// error; with =FILE as JSON too (several programs give a list).
    one predict: Option<PathArg> = FILE_IF_ANY, "FILE";

    /// Tells which limit holds the planned feed where: a row for each stretch with one line of the CL file and one limit,
    /// with way (mm) and time (s, by the plan) from and to, limit, axis, least and largest feed (mm/min); planned cuts
    /// alone. CSV where the name ends in .csv, else JSON; `-` is standard output, JSON. With --split one for each program:
    /// map-1.json, map-2.json, …
    one map: PathArg = FILE, "FILE", { requires: Some("plan") };

    /// Draws the plan into this folder, as SVG: feed, velocity, acceleration and jerk of the axes, chord error and contour
    /// error along the way of the tip in planned cuts, limits drawn in; and tells beside them, as JSON, what is used of each
    /// limit. With --split a folder for each program: FOLDER-1, FOLDER-2, …
    one plan_pictures: PathArg = FILE, "FOLDER", { requires: Some("plan") };
}

settings! {
    /// What a program is made with, beside CL file and machine.
    MakingSettings, None;

    /// Program number (O1234); for several programs, that of the first. Short for --set
    /// control.DIALECT.program_number=…
    one number: u32 = PROGRAM_NUMBER, "N";

    /// Moves points of the path so that the tool, the servos in between, comes nearer to the path of the CL file; by no
    /// more than the machine file allows (`servo_compensation` under `[accuracy]`; words are rounded besides), and only
    /// where a prediction against the CL file says that it helps by a hundredth or more.
    /// Rapids, holes, tool axes and the ends of cuts stay. Arcs and splines go as moves then, and no
    /// CL point is left out. `--verify` grants the moves; `post verify` later is told so by `--tolerance`, the tolerance and
    /// the bound together. A point of the file takes 150 bytes of memory.
    flag compensate_servo;

    /// Plans the feed: the fastest that keeps the feed of the CL file, velocity and acceleration of axes and tip, and what
    /// `[plan]` of the machine file limits besides (contour error of the servos, chord error of the interpolation); jerk too
    /// with its `solver = "jerk"`.
    /// Blocks are cut where their feed changes. `--set plan.contour_error=0.02` sets a limit for one run.
    flag plan;

    /// Plans up to N more rounds while the predicted contour error (`post predict`) exceeds `[plan] contour_error`,
    /// slower where it does. Prints the cycle time of each round and of the program without a plan. Each round posts
    /// and predicts the whole program.
    one plan_rounds: u32 = ROUNDS, "N", { requires: Some("plan") };

    /// Accepts the error model's deviation where the certificate finds a larger one, and only reports the difference.
    /// (The placement `fewest` asks no model.)
    flag trust_model, { heading: Some("Plugins") };
}

settings! {
    /// How many threads work.
    ThreadSettings, None;

    /// Uses at most N threads; the output is the same for any number. [default: number of processors]
    one jobs: NonZeroUsize = JOBS, "N", { short: Some('j') };
}

impl ThreadSettings {
    /// Threads that work at most.
    pub fn most(&self) -> NonZeroUsize {
        if cfg!(target_family = "wasm") {
            // None can be started there.
            return NonZeroUsize::MIN;
        }
        self.jobs.or_else(|| thread::available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
    }
}

settings! {
    /// What a run came to, as a page to look at.
    ReportSettings, None;

    /// Writes a report: one self-contained HTML file with the verdict, path and machine in 3D, charts, and program and
    /// CL file side by side.
    one report: PathArg = FILE, "FILE";

    /// Largest size of the report, MB. A larger one leaves out the texts of the programs first, then other parts, and
    /// says so.
    given report_max: u64 = COUNT, "MB", default || "64".to_owned(), { requires: Some("report") };
}

impl ReportSettings {
    /// Largest size, bytes.
    pub fn most(&self) -> u64 {
        self.report_max.saturating_mul(1_000_000)
    }
}

settings! {
    /// An NC program that is read back, and the machine that runs it.
    ProgramSettings, Some("Machine"), with {
        /// The machine: a TOML file, or the name of one in a machine folder or built in.
        machine: String
    };

    /// Lengths of tools, work offsets and reference positions as the control's tables have them, a TOML file:
    /// `[work.G54]` with X, Y, Z (mm from where `mount` of the machine file has the part) and what rotary axes show there
    /// (degrees); `[length]` and `[radius]` by register, `[tool]` by tool number (mm); `[reference.1]` for G28, `[reference.2]`
    /// for G30 (machine coordinates).
    one offsets: PathArg = FILE, "FILE", { heading: Some("Reading") };

    /// Most blocks that loops, jumps and subprograms may repeat; a program that repeats more is refused.
    given most_blocks: u64 = COUNT, "N", default || Limits::default().blocks.to_string(), { heading: Some("Reading") };

    /// Length of every tool that --offsets does not name, from the gauge point to the tip, mm; overrides the machine
    /// file.
    one tool_length: f64 = LENGTH, "MM", { hyphens: true };

    /// The file that has the tools: tool table, offsets as a program, library or CSV table (`post tools --formats`); short
    /// for --set tools.file=…
    one tools: PathArg = FILE, "FILE";

    /// Where the part origin sits for this job, all axes at zero, machine frame, mm.
    one mount: [f64; 3] = POINT, "X,Y,Z", { hyphens: true };

    /// Sets a parameter of the machine (`Lm=312`) or any key (`control.tcp="post"`).
    many set: Setting = SETTING, "NAME=VALUE";

    /// Reads another dialect than the machine file names; short for --set control.dialect=… (`post plugin list`).
    one dialect: String = NAME, "NAME";

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    many machines: PathBuf = FOLDER, "FOLDER";

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs its code,
    /// so only folders named here are searched.
    many plugins: PathBuf = FOLDER, "FOLDER", { heading: Some("Plugins") };
}

impl ProgramSettings {
    /// What is set over the machine file: `set` first, then the short ones, which win.
    pub fn settings(&self) -> Vec<Setting> {
        let mut settings = tools_setting(self.tools.as_ref());
        settings.extend_from_slice(&self.set);
        settings.extend(self.mount.map(Setting::Mount));
        settings.extend(self.dialect.clone().map(Setting::Dialect));
        settings
    }
}

settings! {
    /// What is asked of every job of a batch.
    StudySettings, Some("Jobs"), with {
        /// How the CL files are read.
        reading: ReadingSettings
    };

    /// Plans the feed of each program, as `post --plan`.
    flag plan;

    /// Verifies each program against its CL file, as `post --verify`: a program that deviates is a refused job.
    flag verify;

    /// Proves that nothing hits anything while each program runs, as `post --clearance`: a program that is not clear is a
    /// refused job.
    flag clearance;

    /// Predicts what each program does, as `post --predict`: true cycle time and contour error.
    flag predict;

    /// Accepts the error model's deviation where the certificate finds a larger one, and only reports the difference.
    flag trust_model;

    /// Adds a column with the computing time of each job, s; the results then differ from run to run.
    flag timings;

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    many machines: PathBuf = FOLDER, "FOLDER", { heading: Some("Machine") };

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs its code,
    /// so only folders named here are searched.
    many plugins: PathBuf = FOLDER, "FOLDER", { heading: Some("Plugins") };
}
