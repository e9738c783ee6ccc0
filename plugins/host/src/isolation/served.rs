//! The inside of a library's process: it opens the library as every host does, and does what it is asked.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::os::fd::AsFd as _;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use post_plugin::{Batch, Deviation, Promise, Tolerance, WriteFault};
use rustix::process::{Pid, Resource, Rlimit, Signal, getpid, kill_process_group};

use super::channel::Channel;
use super::message::{Description, Deviations, DialectOpened, Fitted, Request, Written};
use super::progress::Progress;
use super::wire::Wire;
use crate::dialect::judged_format;
use crate::leave::{at_once, flush_libraries};
use crate::library_dialect::LibraryDialect;
use crate::library_model::LibraryModel;
use crate::{Plugin, PluginKind, ProgramSetup, Reason};

/// The word by which this program is told to serve a library.
pub(crate) const SERVE: &str = "--serve-plugin";

/// What the process of a library is called in lists of processes.
pub(crate) const LIBRARY: &str = "post-plugin";

/// Between two looks at whether the host still runs.
const LOOK: Duration = Duration::from_millis(250);

/// Serves a library, if this process was started for that: then it does not return. To be called before anything else.
pub fn serve_if_asked() {
    let words: Vec<OsString> = std::env::args_os().collect();
    if let [_, word, path, memory, host] = words.as_slice()
        && word == SERVE
    {
        let number = |word: &OsString| word.to_str().and_then(|word| word.parse::<u64>().ok());
        if let (Some(memory), Some(host)) = (number(memory), number(host)) {
            // Nobody is left to tell why.
            let _ = serve(path.as_ref(), memory, host);
        }
        at_once(2);
    }
}

fn serve(path: &Path, memory: u64, host: u64) -> io::Result<()> {
    let connection = io::stdin().as_fd().try_clone_to_owned()?;
    let shared = io::stdout().as_fd().try_clone_to_owned()?;
    // What it reads is nothing, and what it prints is no part of a program: the host tells it.
    rustix::stdio::dup2_stdin(File::open("/dev/null")?)?;
    rustix::stdio::dup2_stdout(io::stderr())?;
    Progress::share_function(&shared)?;
    let progress = Progress::of(shared)?;
    let mut server = Server {
        own: std::process::id(),
        channel: Channel::new(UnixStream::from(connection)),
        progress: Some(progress),
        opened: Opened::Nothing,
        batch: Batch::default(),
    };
    // What the system does not give is no fault of the library.
    let ready = watch(host).and_then(|()| limit(memory));
    let ready = ready.map_err(|error| Reason::NoProcess { message: error.to_string() });
    let plugin = ready.and_then(|()| Plugin::open(path).map_err(|fault| fault.reason));
    let told = plugin.as_ref().map(Description::of).map_err(Clone::clone);
    server.tell(&told)?;
    let Ok(plugin) = plugin else { return Ok(()) };
    loop {
        server.serve(&plugin)?;
    }
}

/// What the library may take, beyond what this process has mapped by now; it cannot be taken back.
fn limit(memory: u64) -> io::Result<()> {
    let most = |resource, most: u64| {
        let before = rustix::process::getrlimit(resource).maximum.unwrap_or(u64::MAX);
        let most = Some(most.min(before));
        rustix::process::setrlimit(resource, Rlimit { current: most, maximum: most })
    };
    most(Resource::Core, 0)?;
    // Not every system knows it.
    let _ = most(Resource::As, memory.saturating_add(mapped().unwrap_or(0)));
    Ok(())
}

/// Bytes of addresses that this process has now; none where the system does not tell.
fn mapped() -> Option<u64> {
    let told = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = told.split_ascii_whitespace().next()?.parse().ok()?;
    pages.checked_mul(rustix::param::page_size() as u64)
}

/// Ends this process, and what it has started, once the host does not run any more, whatever the library does.
fn watch(host: u64) -> io::Result<()> {
    let own: Pid = getpid();
    let watching = move || {
        let runs = || {
            let parent = rustix::process::getppid();
            parent.is_some_and(|parent| parent.as_raw_nonzero().get() as u64 == host)
        };
        while runs() {
            std::thread::sleep(LOOK);
        }
        // The group that it was started in: the library may have left it for one that is the user's.
        let _ = kill_process_group(own, Signal::KILL);
        at_once(2)
    };
    std::thread::Builder::new().stack_size(1 << 16).spawn(watching).map(drop)
}

/// What is open.
enum Opened {
    Nothing,
    Dialect(LibraryDialect, Promise),
    Model(LibraryModel),
}

struct Server {
    /// The process; one that the library has split off serves nobody.
    own: u32,
    channel: Channel,
    progress: Option<Progress>,
    opened: Opened,
    batch: Batch,
}

impl Server {
    fn tell(&mut self, answer: &impl Wire) -> io::Result<()> {
        if std::process::id() != self.own {
            at_once(0);
        }
        // What it has printed is not lost if it dies of the next call, or is stopped.
        flush_libraries();
        self.channel.send(|to| answer.put(to))
    }

    /// Does the next thing that it is asked.
    fn serve(&mut self, plugin: &Plugin) -> io::Result<()> {
        let invalid = || io::Error::from(io::ErrorKind::InvalidData);
        let mut bytes = self.channel.receive(|_| Ok(()))?;
        let request = Request::take(&mut bytes).ok_or_else(invalid)?;
        if let Request::Write = request {
            self.batch.from_bytes(bytes).ok_or_else(invalid)?;
        } else if !bytes.is_empty() {
            return Err(invalid());
        }
        match request {
            Request::Dialect(setup) => {
                let opened = self.open_dialect(plugin, &setup);
                self.tell(&opened)
            }
            Request::Model(options) => {
                let opened = LibraryModel::open_plugin(plugin, &options);
                let told: Result<(), String> = opened.map(|model| {
                    self.opened = Opened::Model(model);
                });
                self.tell(&told)
            }
            Request::Write => {
                let written = self.written().ok_or_else(invalid)?;
                self.tell(&written)
            }
            Request::Vocabulary => {
                let Opened::Dialect(dialect, _) = &self.opened else { return Err(invalid()) };
                let words = dialect.vocabulary().map(|words| {
                    let told = words.into_iter();
                    told.map(|word| (word.word.into_owned(), word.meaning.number())).collect()
                });
                let words: Result<Vec<(String, u32)>, String> = words;
                self.tell(&words)
            }
            Request::ReliesOn => {
                let Opened::Dialect(dialect, _) = &self.opened else { return Err(invalid()) };
                let told = dialect.relies_on();
                self.tell(&told)
            }
            Request::Fit(tolerance) => self.fit(&tolerance),
            Request::Value(curve, places) => {
                let Opened::Model(model) = &self.opened else { return Err(invalid()) };
                let mut out: Deviations = vec![Deviation::default(); places.len()];
                let told = model.values(&curve, &places, &mut out).map(|()| out);
                self.tell(&told)
            }
            Request::Close => {
                if let Opened::Dialect(dialect, _) = &mut self.opened {
                    self.progress = dialect.progress().take();
                }
                self.opened = Opened::Nothing;
                self.tell(&())
            }
        }
    }

    fn open_dialect(&mut self, plugin: &Plugin, setup: &ProgramSetup) -> DialectOpened {
        let mut dialect = LibraryDialect::open_plugin(plugin, setup)?;
        let raw = dialect.raw_format();
        // What does not hold together the host refuses.
        let judged = raw.as_ref().ok().and_then(|raw| judged_format(raw, setup.words.len()).ok());
        if let Some((format, _)) = judged {
            let words = format.words.len();
            let promise = Promise { words, inverse_time: format.inverse_time.is_some() };
            *dialect.progress() = self.progress.take();
            self.opened = Opened::Dialect(dialect, promise);
        }
        Ok(raw)
    }

    fn written(&mut self) -> Option<Written> {
        let Opened::Dialect(dialect, promise) = &mut self.opened else { return None };
        let (mut text, mut ends) = (String::new(), Vec::new());
        let written = dialect.write(&self.batch, promise, &mut text, &mut ends);
        let fault = written.err().map(|WriteFault { index, message }| (index as u64, message));
        let ends = ends.into_iter().map(|end| end as u64).collect();
        Some(Written { text, ends, fault })
    }

    fn fit(&mut self, tolerance: &Tolerance) -> io::Result<()> {
        let Opened::Model(model) = &mut self.opened else {
            return Err(io::ErrorKind::InvalidData.into());
        };
        let (channel, own) = (&mut self.channel, self.own);
        let answer = model.answer(tolerance, &mut |places, out| {
            let found = if std::process::id() == own { wanted(channel, places) } else { None };
            match found.filter(|found| found.len() == out.len()) {
                Some(found) => out.copy_from_slice(&found),
                // The host has gone.
                None => at_once(2),
            }
        });
        self.tell(&Fitted::Answers(answer.map(Box::new)))
    }
}

/// The deviations at some places, as the host computes them.
fn wanted(channel: &mut Channel, places: &[f64]) -> Option<Deviations> {
    channel.send(|to| Fitted::Wants(places.to_vec()).put(to)).ok()?;
    let mut bytes = channel.receive(|_| Ok(())).ok()?;
    Deviations::take(&mut bytes)
}

impl Description {
    fn of(plugin: &Plugin) -> Self {
        Self {
            version: plugin.version.clone(),
            about: plugin.about.clone(),
            is_model: plugin.kind() == PluginKind::ErrorModel,
            hash: plugin.hash.clone().unwrap_or_default(),
            options: plugin.options.to_vec(),
        }
    }
}
