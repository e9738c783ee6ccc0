//! How the program of one channel waits for those of the others, and how its lines are known again.

use std::collections::HashMap;

use post_grammar::{SyncMark, Template};

use crate::program_text::{plain, unnumbered};

/// Most channels of a machine.
pub const MOST_CHANNELS: u32 = 4;

/// Words that mean something else to every control (ISO 6983 and what tap, tool change and subprograms have besides).
const TAKEN: [&str; 19] = [
    "M0", "M1", "M2", "M3", "M4", "M5", "M6", "M7", "M8", "M9", "M13", "M14", "M17", "M19", "M29",
    "M30", "M60", "M98", "M99",
];

/// What stands for channels in a line, besides `{n}` for the mark.
const CHANNELS: [&str; 4] = ["{channels}", "{digits}", "{sum}", "{others}"];

/// How a channel waits for others: `[wait]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaitRule {
    /// The line of the program, as the file has it; none if the control has no word for it.
    pub word: Option<String>,
    /// Least and largest mark of a CL file.
    pub(crate) marks: [u32; 2],
    /// Number of the channel that the machine file describes, from 1; none if nothing says it.
    pub channel: Option<u32>,
    /// How many channels there are, likewise.
    pub channels: Option<u32>,
    /// Axes that other channels have as well: places in the chain.
    pub shared: Vec<usize>,
    /// The spindle is that of other channels as well.
    pub shares_spindle: bool,
}

/// A wait as it stands in a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WaitLine {
    /// The line.
    pub text: String,
    /// The channels that wait at it, upwards; empty where nothing says which.
    pub channels: Vec<u32>,
}

/// Why there is no line for a mark: a sentence, and what helps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WaitLack {
    /// What is wrong.
    pub message: String,
    /// What would help.
    pub help: &'static str,
}

impl WaitRule {
    /// The line for a mark.
    ///
    /// # Errors
    /// The machine has no word for it, the mark is none of the control's, or the channels are not known or others.
    pub fn line(&self, mark: &SyncMark) -> Result<WaitLine, WaitLack> {
        let lack = |message: String, help| Err(WaitLack { message, help });
        let number = mark.number;
        let [least, most] = self.marks;
        if self.word.is_none() {
            let message = "the machine file has no line at which a channel waits".to_owned();
            return lack(message, "[wait] word = \"M{n}\", marks = [100, 199]");
        }
        if !(least..=most).contains(&number) {
            let message = format!(
                "mark {number}: [wait] marks of the machine file go from {least} to {most}"
            );
            return lack(message, "another number in the CAM system, or n+99 in [wait] word");
        }
        if let (Some(own), Some(said)) = (self.channel, mark.channels.first())
            && own != *said
        {
            let message =
                format!("the CL file is that of channel {said}, and this is channel {own}");
            return lack(
                message,
                "[[channel]] tables of a job count from 1, or [wait] channel says it",
            );
        }
        if mark.channels.len() == 1 {
            let message = format!("mark {number} names no channel but its own");
            return lack(message, "SYNC/mark,own channel,other channels");
        }
        let most = self.channels.unwrap_or(MOST_CHANNELS);
        if let Some(beyond) = mark.channels.iter().find(|channel| **channel > most) {
            let message = format!("mark {number} is for channel {beyond}, and there are {most}");
            return lack(message, "[wait] channels, or a [[channel]] of the job, for each");
        }
        let mut channels = mark.channels.clone();
        if channels.is_empty() {
            channels.extend(1..=self.channels.unwrap_or(0));
        }
        channels.sort_unstable();
        let own = self.channel.or(mark.channels.first().copied());
        match self.text(number, own, &channels) {
            Some(text) => Ok(WaitLine { text, channels }),
            None => lack(
                format!("mark {number} does not say which channels wait"),
                "SYNC/mark,own channel,other channels; or a job with a [[channel]] for each",
            ),
        }
    }

    /// Least and largest mark of a CL file.
    pub fn ends(&self) -> [u32; 2] {
        self.marks
    }

    /// The mark as its line has it: with the channels upwards where that names any, else without.
    pub fn written(&self, mark: &SyncMark) -> SyncMark {
        let named = CHANNELS.iter().any(|name| self.names(name));
        let channels = self.line(mark).map(|line| line.channels).unwrap_or_default();
        SyncMark { number: mark.number, channels: if named { channels } else { Vec::new() } }
    }

    /// The line of a mark at which `channels` wait; none if it speaks of channels that nobody knows.
    fn text(&self, number: u32, own: Option<u32>, channels: &[u32]) -> Option<String> {
        let mut word = self.word.clone()?;
        for name in CHANNELS.iter().filter(|name| self.names(name)) {
            word = word.replace(name, &value(name, own, channels)?);
        }
        Template::parse(&word).ok()?.fill(&[f64::from(number)], 1.0).ok()
    }

    /// The line speaks of this.
    fn names(&self, name: &str) -> bool {
        self.word.as_ref().is_some_and(|word| word.contains(name))
    }

    /// What is wrong with the line, as a sentence: of two marks each must be told from the other.
    pub(crate) fn fault(&self) -> Option<String> {
        let mut word = self.word.clone()?;
        for name in CHANNELS {
            word = word.replace(name, "1");
        }
        let template = match Template::parse(&word) {
            Ok(template) => template,
            Err(fault) => return Some(fault),
        };
        let line = |mark: u32| template.fill(&[f64::from(mark)], 1.0);
        let all = (self.marks[0]..=self.marks[1]).filter_map(|mark| line(mark).ok());
        if let Some(taken) =
            all.map(|line| plain(&line)).find(|line| TAKEN.contains(&line.as_str()))
        {
            return Some(format!(
                "{taken} is no wait: marks begin behind the words that mean something else"
            ));
        }
        match (template.numbers(), line(self.marks[0]), line(self.marks[1])) {
            (1, Ok(first), Ok(last)) if first != last || self.marks[0] == self.marks[1] => None,
            (1, Err(fault), _) | (1, _, Err(fault)) => Some(fault.to_string()),
            _ => {
                Some("the line of a wait has {n}, the mark of the CL file, and no {n2}".to_owned())
            }
        }
    }

    /// Its lines, to be known again.
    pub fn lines(&self) -> WaitLines {
        let mut lines = HashMap::new();
        let named = CHANNELS.iter().any(|name| self.names(name));
        let count = self.channels.unwrap_or(MOST_CHANNELS);
        let is_own = |set: u32| self.channel.is_none_or(|own| set >> (own - 1) & 1 == 1);
        let sets = (0_u32..1 << count)
            .filter(|set| if named { set.count_ones() >= 2 && is_own(*set) } else { *set == 0 });
        for set in sets {
            let channels: Vec<u32> =
                (1..=count).filter(|channel| set >> (channel - 1) & 1 == 1).collect();
            let owns = match self.channel {
                None if named => channels.clone(),
                own => vec![own.unwrap_or_default()],
            };
            for own in owns {
                for number in self.marks[0]..=self.marks[1] {
                    if let Some(text) = self.text(number, Some(own), &channels) {
                        let channels = channels.clone();
                        lines.insert(plain(&text), SyncMark { number, channels });
                    }
                }
            }
        }
        WaitLines { lines }
    }
}

/// What stands for `name` in a line of the channel `own`; none if that is not known.
fn value(name: &str, own: Option<u32>, channels: &[u32]) -> Option<String> {
    let texts = |channels: &mut dyn Iterator<Item = &u32>, between: &str| {
        channels.map(u32::to_string).collect::<Vec<_>>().join(between)
    };
    if channels.is_empty() {
        return None;
    }
    Some(match name {
        "{channels}" => texts(&mut channels.iter(), ","),
        "{digits}" => texts(&mut channels.iter(), ""),
        "{sum}" => channels.iter().map(|channel| 1 << (channel - 1)).sum::<u32>().to_string(),
        _ => {
            let own = own?;
            texts(&mut channels.iter().filter(|channel| **channel != own), "")
        }
    })
}

/// The lines of all waits of a channel.
#[derive(Clone, Debug, Default)]
pub struct WaitLines {
    /// Each, without blanks, with its mark.
    lines: HashMap<String, SyncMark>,
}

impl WaitLines {
    /// The mark that a line of a program waits at, with the channels that it names; none if it does something else.
    pub fn mark(&self, line: &str) -> Option<&SyncMark> {
        let line = plain(line);
        self.lines.get(&line).or_else(|| self.lines.get(unnumbered(&line)))
    }
}
