//! The process of a library, as the host sees it: asked one thing at a time, stopped where it takes too long, and told of
//! where it dies.

use std::io::{self, ErrorKind};
use std::os::fd::{BorrowedFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use rustix::process::{
    Pid, Signal, WaitId, WaitIdOptions, kill_process, kill_process_group, waitid,
};

use super::Limits;
use super::channel::Channel;
use super::message::Request;
use super::printed::Printed;
use super::progress::Progress;
use super::served::{LIBRARY, SERVE};
use super::wire::Wire;
use crate::function::Function;

/// Between two looks at a process that does not answer.
const LOOK: Duration = Duration::from_millis(100);

/// How long a process that has hung up may take to end by itself, and one that was killed to be gone.
const ENDS: Duration = Duration::from_secs(1);

/// The processes that run now: whoever ends the command kills them.
static LIVE: Mutex<Vec<Pid>> = Mutex::new(Vec::new());

fn live() -> MutexGuard<'static, Vec<Pid>> {
    // A list is whole whatever a thread died of.
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Kills the processes of all libraries, with what they have started.
pub(crate) fn kill_all() {
    for process in live().iter() {
        kill(*process);
    }
}

/// Kills a process that nobody has waited for, and the group that it was started in: it may have left that group.
fn kill(process: Pid) {
    // They may be gone already.
    let _ = kill_process_group(process, Signal::KILL);
    let _ = kill_process(process, Signal::KILL);
}

/// A library's process.
#[derive(Debug)]
pub(crate) struct Process {
    /// The library's file.
    path: PathBuf,
    child: Child,
    channel: Channel,
    progress: Progress,
    printed: Printed,
    limits: Limits,
    /// Why it is not asked any more.
    dead: Option<String>,
}

impl Process {
    /// Starts this program again, to open the library at `path`, which is called `name`. Its first message says what that is.
    pub(crate) fn start(name: &str, path: &Path, limits: Limits) -> io::Result<Self> {
        let (ours, theirs) = UnixStream::pair()?;
        ours.set_write_timeout(Some(limits.call))?;
        let (progress, shared) = Progress::new()?;
        let (printed, prints) = Printed::new(name)?;
        // A name by which it is found whatever has become of its file.
        let this = match cfg!(target_os = "linux") {
            true => "/proc/self/exe".into(),
            false => std::env::current_exe()?,
        };
        let mut command = Command::new(this);
        command.arg0(LIBRARY).arg(SERVE).arg(path).arg(limits.memory.to_string());
        command.arg(std::process::id().to_string());
        command.stdin(OwnedFd::from(theirs)).stdout(shared).stderr(prints);
        // Ctrl-C is for the command, which ends it.
        command.process_group(0);
        let mut live = live();
        let child = command.spawn()?;
        live.extend(Pid::from_raw(child.id() as i32));
        drop(live);
        Ok(Self {
            path: path.to_owned(),
            child,
            channel: Channel::new(ours),
            progress,
            printed,
            limits,
            dead: None,
        })
    }

    /// Asks it, and takes the answer.
    ///
    /// # Errors
    /// Why there is none, as a sentence about the library.
    pub(crate) fn ask<R: Wire>(&mut self, request: &Request) -> Result<R, String> {
        self.ask_with(request, |_| {})
    }

    /// As [`Process::ask`], with what `more` appends to the request.
    pub(crate) fn ask_with<R: Wire>(
        &mut self,
        request: &Request,
        more: impl FnOnce(&mut Vec<u8>),
    ) -> Result<R, String> {
        let mut left = self.limits.call;
        self.send(request.function(), |to| {
            request.put(to);
            more(to);
        })?;
        self.answer(request.function(), &mut left)
    }

    /// Sends what `fill` appends.
    pub(crate) fn send(
        &mut self,
        function: Function,
        fill: impl FnOnce(&mut Vec<u8>),
    ) -> Result<(), String> {
        if let Some(dead) = &self.dead {
            return Err(dead.clone());
        }
        self.channel.send(fill).map_err(|error| self.died(function, &error))
    }

    /// Takes the next message, for which it has `left`.
    pub(crate) fn answer<R: Wire>(
        &mut self,
        function: Function,
        left: &mut Duration,
    ) -> Result<R, String> {
        if let Some(dead) = &self.dead {
            return Err(dead.clone());
        }
        let asked = Instant::now();
        let (child, printed, most) = (&self.child, &mut self.printed, *left);
        let received = self.channel.receive(|connection| {
            loop {
                let heard = is_heard(connection, printed)?;
                match () {
                    // However much it says meanwhile.
                    () if asked.elapsed() > most => return Err(ErrorKind::TimedOut.into()),
                    () if heard => return Ok(()),
                    // What it has started may hold the connection open.
                    () if has_ended(child) => return Err(ErrorKind::UnexpectedEof.into()),
                    () => {}
                }
            }
        });
        let answer = received.and_then(|mut bytes| {
            let answer = R::take(&mut bytes).filter(|_| bytes.is_empty());
            answer.ok_or_else(|| ErrorKind::InvalidData.into())
        });
        // It hands on what it has printed before it answers.
        self.printed.tell();
        *left = left.saturating_sub(asked.elapsed());
        answer.map_err(|error| self.died(function, &error))
    }

    /// Has it close what it has open; all that it has printed is told then.
    pub(crate) fn close(&mut self) -> Result<(), String> {
        let closed = self.ask::<()>(&Request::Close);
        self.printed.tell_line();
        closed
    }

    /// How many of the `count` events of the last batch it said to have written.
    pub(crate) fn told(&self, count: usize) -> usize {
        self.progress.told(count)
    }

    /// Nothing has been told yet of the next batch.
    pub(crate) fn forget_progress(&mut self, count: usize) {
        self.progress.forget(count);
    }

    /// It may be asked.
    pub(crate) fn is_alive(&self) -> bool {
        self.dead.is_none()
    }

    /// Ends it, whatever it is at, and says why.
    pub(crate) fn stop(&mut self, message: String) -> String {
        self.end();
        self.dead = Some(message.clone());
        message
    }

    /// It answers no more: says why, and ends it with what it has started.
    fn died(&mut self, function: Function, error: &io::Error) -> String {
        let late = matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock);
        let hung_up = Instant::now();
        while !late && !has_ended(&self.child) && hung_up.elapsed() < ENDS {
            std::thread::sleep(Duration::from_millis(1));
        }
        let by_itself = has_ended(&self.child);
        let status = self.end();
        let function = self.progress.last_function().unwrap_or(function).name();
        let Limits { call, memory } = self.limits;
        let how = match status {
            _ if late => {
                format!("it did not return within {} s and was stopped", call.as_secs_f64())
            }
            Some(status) if by_itself => how_it_ended(status),
            _ if error.kind() == ErrorKind::InvalidData => {
                "it wrote to the connection of its process and was stopped".to_owned()
            }
            _ => "it closed the connection of its process and was stopped".to_owned(),
        };
        let remedy = match status {
            _ if late => "--plugin-seconds gives it more".to_owned(),
            Some(status) if by_itself && status.code().is_none() => format!(
                "the fault is in the plugin; if it wants more than {} MiB of memory, --plugin-memory gives it more",
                memory >> 20
            ),
            _ => "the fault is in the plugin: tell its author".to_owned(),
        };
        let sentence = format!(
            "{how} in the middle of its work (`{function}` of {}); {remedy}",
            self.path.display()
        );
        self.dead = Some(sentence.clone());
        sentence
    }

    /// Ends it with what it has started; says how it ended.
    fn end(&mut self) -> Option<ExitStatus> {
        let status = self.kill();
        self.printed.end();
        status
    }

    fn kill(&mut self) -> Option<ExitStatus> {
        let mut live = live();
        if let Some(process) = Pid::from_raw(self.child.id() as i32)
            && live.contains(&process)
        {
            // While nobody has waited for it, its number is its own.
            kill(process);
            live.retain(|other| *other != process);
        }
        drop(live);
        // A process that is killed ends, unless the system holds it (a disk that does not answer).
        let killed = Instant::now();
        while killed.elapsed() < ENDS {
            match self.child.try_wait() {
                Ok(None) => std::thread::sleep(Duration::from_micros(200)),
                ended => return ended.ok().flatten(),
            }
        }
        None
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.end();
    }
}

/// Waits for more of an answer and for what is printed, which is told; whether there is more of an answer now.
fn is_heard(connection: BorrowedFd<'_>, printed: &mut Printed) -> io::Result<bool> {
    let look = Timespec { tv_sec: 0, tv_nsec: LOOK.subsec_nanos().into() };
    let places = [connection, printed.waits_at().unwrap_or(connection)];
    let mut looked = places.map(|place| PollFd::from_borrowed_fd(place, PollFlags::IN));
    match poll(&mut looked, Some(&look)) {
        Err(Errno::INTR) => return Ok(false),
        found => found?,
    };
    let [answers, prints] = looked.map(|place| !place.revents().is_empty());
    if prints {
        printed.tell();
    }
    Ok(answers)
}

/// It has ended, and nobody has waited for it yet.
fn has_ended(child: &Child) -> bool {
    let Some(process) = Pid::from_raw(child.id() as i32) else {
        return true;
    };
    let look = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
    // It cannot be asked about once it was waited for.
    waitid(WaitId::Pid(process), look).map_or(true, |ended| ended.is_some())
}

/// Of a process that nobody stopped.
fn how_it_ended(status: ExitStatus) -> String {
    if let Some(code) = status.code() {
        return format!("it ended its process with exit code {code}");
    }
    let signal = status.signal().unwrap_or(0);
    let name = match Signal::from_named_raw(signal) {
        Some(Signal::SEGV) => ", SIGSEGV",
        Some(Signal::BUS) => ", SIGBUS",
        Some(Signal::ABORT) => ", SIGABRT",
        Some(Signal::ILL) => ", SIGILL",
        Some(Signal::FPE) => ", SIGFPE",
        Some(Signal::KILL) => ", SIGKILL",
        Some(Signal::SYS) => ", SIGSYS",
        _ => "",
    };
    format!("its process died of signal {signal}{name},")
}
