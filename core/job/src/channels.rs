//! Programs that run at the same time, one a channel of the machine: whether their waits meet, and how long all of it takes.

use std::fmt::Write as _;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_posting::report::ReportedWait;

use crate::making::ProgramOutcome;
use crate::text::clock;
use crate::text_table::TextTable;

/// The program of a channel, made and not yet written.
pub struct ChannelProgram<'a> {
    /// What messages call its CL file.
    pub cl_file: String,
    /// The machine as the job names it: a file or a bare name.
    pub source: &'a str,
    /// The machine.
    pub machine: &'a Machine,
    /// What came of it.
    pub outcome: &'a mut ProgramOutcome,
}

/// How channels go together.
#[derive(Clone, Debug, PartialEq)]
pub struct JoinedChannels {
    /// The times are those of a prediction; else the nominal ones of the feeds, without tool changes.
    pub predicted: bool,
    /// Own time of each, and how long it waits for others, s.
    pub channels: Vec<[f64; 2]>,
    /// Places at which channels meet.
    pub meetings: usize,
    /// From the begin of all to the end of the last, s.
    pub time_s: f64,
}

/// A wait of one channel, before those of the others are known.
#[derive(Clone, Debug, PartialEq)]
struct Wait {
    mark: u32,
    /// Channels that wait, from 1, upwards.
    channels: Vec<u32>,
    /// Line of the CL file.
    line: u64,
    /// Own time before it, s.
    time_s: f64,
}

/// Two channels whose machine files wait by other words: one control reads both programs, and the lines of one mark would be
/// two marks to it.
fn words_apart(programs: &[ChannelProgram<'_>]) -> Option<Diagnostic> {
    let waiting =
        programs.iter().zip(1..).filter(|(program, _)| !program.outcome.report.waits.is_empty());
    let said = waiting.filter_map(|(program, channel)| {
        Some((channel, program.machine.wait.as_ref()?.word.as_deref()?))
    });
    let said: Vec<(u32, &str)> = said.collect();
    let apart = said.windows(2).find(|pair| pair[0].1 != pair[1].1)?;
    let ((one, first), (other, second)) = (apart[0], apart[1]);
    let message = format!(
        "channels {one} and {other} wait by other lines, {first} and {second}: the control would never see them meet"
    );
    let help = "the same [wait] word in the machine files of one machine's channels";
    Some(Diagnostic::error("wait", message).help(help))
}

/// Joins the programs, in the order of their channels from 1, and tells each how long it waits.
///
/// # Errors
/// Channels wait for one another for ever or by other lines, or two of them have one axis or one spindle.
pub fn join(programs: &mut [ChannelProgram<'_>]) -> Result<JoinedChannels, Vec<Diagnostic>> {
    let shared = shared(programs);
    if !shared.is_empty() {
        return Err(shared);
    }
    if let Some(apart) = words_apart(programs) {
        return Err(vec![apart]);
    }
    let predicted = programs.iter().all(|program| {
        let ProgramOutcome { prediction, report, .. } = &*program.outcome;
        let times = prediction.as_ref().map(|prediction| &prediction.time.channel_waits_s);
        times.is_some_and(|times| times.len() == report.waits.len())
    });
    let waits: Vec<Vec<Wait>> =
        programs.iter().map(|program| waits(program.outcome, predicted)).collect();
    let met = Meeting::of(&waits).map_err(|stands| vec![deadlock(programs, &waits, &stands)])?;
    let mut channels = Vec::new();
    for (program, waited) in programs.iter_mut().zip(&met.waited) {
        let outcome = &mut *program.outcome;
        for (told, seconds) in outcome.report.waits.iter_mut().zip(waited) {
            told.waits_s = Some(*seconds);
        }
        let own = match outcome.prediction.as_ref().filter(|_| predicted) {
            Some(prediction) => prediction.time.cycle_s,
            None => outcome.report.time_s,
        };
        channels.push([own, waited.iter().sum()]);
    }
    let time_s = channels.iter().map(|[own, waited]| own + waited).fold(0.0, f64::max);
    Ok(JoinedChannels { predicted, channels, meetings: met.count, time_s })
}

/// The waits of a program, by the times of its prediction or of its feeds.
fn waits(outcome: &ProgramOutcome, predicted: bool) -> Vec<Wait> {
    let times = outcome.prediction.as_ref().map(|prediction| &prediction.time.channel_waits_s);
    let told = outcome.report.waits.iter().enumerate();
    let wait = |(index, told): (usize, &ReportedWait)| Wait {
        mark: told.mark,
        channels: told.channels.clone(),
        line: told.line,
        time_s: times
            .filter(|_| predicted)
            .and_then(|times| times.get(index).copied())
            .unwrap_or(told.time_s),
    };
    told.map(wait).collect()
}

/// Channels that met at every wait.
struct Meeting {
    /// How long each waits at each of its marks, s.
    waited: Vec<Vec<f64>>,
    /// Places at which channels met.
    count: usize,
}

impl Meeting {
    /// Lets the channels run until all are at their ends.
    ///
    /// # Errors
    /// At which of its waits each of them stands for ever.
    fn of(waits: &[Vec<Wait>]) -> Result<Self, Vec<usize>> {
        let mut waited: Vec<Vec<f64>> = vec![Vec::new(); waits.len()];
        let mut late = vec![0.0; waits.len()];
        let mut count = 0;
        loop {
            let next: Vec<Option<&Wait>> =
                waits.iter().zip(&waited).map(|(waits, met)| waits.get(met.len())).collect();
            let together = next.iter().flatten().find(|wait| {
                wait.channels.iter().all(|channel| {
                    let other = next.get(*channel as usize - 1).copied().flatten();
                    other.is_some_and(|other| {
                        (other.mark, &other.channels) == (wait.mark, &wait.channels)
                    })
                })
            });
            let Some(together) = together else {
                return match next.iter().all(Option::is_none) {
                    true => Ok(Self { waited, count }),
                    false => Err(waited.iter().map(Vec::len).collect()),
                };
            };
            let those = || together.channels.iter().map(|channel| *channel as usize - 1);
            let comes =
                |channel: usize| next[channel].map_or(0.0, |wait| wait.time_s) + late[channel];
            let at = those().map(comes).fold(0.0, f64::max);
            let waiting: Vec<(usize, f64)> =
                those().map(|channel| (channel, at - comes(channel))).collect();
            for (channel, seconds) in waiting {
                waited[channel].push(seconds);
                late[channel] += seconds;
            }
            count += 1;
        }
    }
}

/// Why channels wait for ever: where each of them stands.
fn deadlock(programs: &[ChannelProgram<'_>], waits: &[Vec<Wait>], stands: &[usize]) -> Diagnostic {
    let mut message = "the channels wait for one another for ever: ".to_owned();
    let mut first = None;
    for (index, (waits, stands)) in waits.iter().zip(stands).enumerate() {
        let program = &programs[index];
        let between = if index == 0 { "" } else { "; " };
        let _ = write!(message, "{between}channel {} ", index + 1);
        let Some(wait) = waits.get(*stands) else {
            message.push_str("comes to its end");
            continue;
        };
        let names = wait.channels.iter().filter(|channel| **channel as usize != index + 1);
        let others = names.map(u32::to_string).collect::<Vec<_>>().join(" and ");
        let _ = write!(
            message,
            "waits at mark {} for {others} ({} line {})",
            wait.mark, program.cl_file, wait.line
        );
        first.get_or_insert((program, wait.line));
    }
    let place = first.map(|(program, line)| SourcePlace::new(&program.cl_file, line, "", 0..0));
    Diagnostic::error("wait", message)
        .help("the channels that share marks need the same ones in the same order, and each names the same channels")
        .at(place)
}

/// What two channels both have: every program has words of all its axes, and ends by stopping the spindle, so that it would
/// move and stop what the other one works with.
fn shared(programs: &[ChannelProgram<'_>]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (index, one) in programs.iter().enumerate() {
        for (other_index, other) in programs.iter().enumerate().skip(index + 1) {
            let mut tell = |what: &str| {
                let message = format!(
                    "channels {} and {} both have {what}, and the program of one would move or stop it under that of the other: handing it over is not known here",
                    index + 1,
                    other_index + 1
                );
                let help = "a machine file for each channel, with the axes and the spindle that it has alone; [wait] shared names what several have";
                found.push(Diagnostic::error("channel-shared", message).help(help));
            };
            let same = one.source == other.source;
            for axis in &one.machine.axes {
                let both = other.machine.axes.iter().any(|own| own.name == axis.name);
                if both && (same || one.shares(&axis.name) || other.shares(&axis.name)) {
                    tell(&axis.name);
                }
            }
            if same || one.shares_spindle() || other.shares_spindle() {
                tell("the spindle");
            }
        }
    }
    found
}

impl ChannelProgram<'_> {
    /// Its machine file says that the spindle is that of others as well.
    fn shares_spindle(&self) -> bool {
        self.machine.wait.as_ref().is_some_and(|wait| wait.shares_spindle)
    }

    /// Its machine file says that others have the axis as well.
    fn shares(&self, axis: &str) -> bool {
        let named = |joint: &usize| self.machine.axes[*joint].name == axis;
        self.machine.wait.as_ref().is_some_and(|wait| wait.shared.iter().any(named))
    }
}

/// How the channels go together, for people.
pub fn text(joined: &JoinedChannels) -> String {
    let mut table = TextTable::headed(1, ["channel", "own time", "waits"]);
    for (index, [own, waits]) in joined.channels.iter().enumerate() {
        table.row([(index + 1).to_string(), clock(*own), clock(*waits)]);
    }
    let kind = if joined.predicted { "predicted" } else { "nominal, without tool changes" };
    format!(
        "\n{}together {}, {kind}; the channels meet {}\n",
        table.text(),
        clock(joined.time_s),
        match joined.meetings {
            1 => "once".to_owned(),
            meetings => format!("{meetings} times"),
        }
    )
}
