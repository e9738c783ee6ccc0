//! `[wait]`: how a channel of a machine with several waits for the others.

use super::Axis;
use super::bounds::Bounds;
use super::build::Builder;
use super::keys::axes_are;
use super::quantity::KeyedNumber;
use super::table::{Count, Spanned, keys};
use crate::wait_rule::{MOST_CHANNELS, WaitRule};

const CODE: &str = "machine-wait";

/// Most marks of a control: their lines are looked for in programs.
const MOST_MARKS: u32 = 1_000;

const CHANNEL: Bounds =
    Bounds::within(1.0, MOST_CHANNELS as f64, CODE, "; from 1 to 4 are possible");

keys! {
    /// How the program of one channel waits for those of the others, of a machine that runs several programs at a time. A
    /// machine file is that of one channel.
    WaitFile {
        /// The line of the program at `SYNC/n` of the CL file, a template: `"M{n+99}"`, `"WAITM({n},{channels})"`.
        /// `{channels}` are the channels that wait (1,2), `{digits}` the same without a comma (12), `{sum}` as a sum of bits
        /// (3), `{others}` those but one's own.
        word: Option<Spanned<String>>,
        /// Least and largest mark n of a CL file that the control takes, such as `[100, 199]`.
        marks: Option<Spanned<[KeyedNumber; 2]>>,
        /// Number of the channel; a job's `[[channel]]` says it.
        channel: Option<Count> = CHANNEL,
        /// How many channels there are; a job says it by its `[[channel]]` tables.
        channels: Option<Count> = CHANNEL,
        /// Axes that other channels have as well, such as C of the main spindle: a job with both is refused, for the program
        /// of each has words of all its axes.
        shared: Vec<Spanned<String>> = Bounds { default: Some("[]"), ..Bounds::ANY },
        /// The spindle is that of other channels as well: a job with both is refused, for each program stops it at its end.
        shared_spindle: bool = Bounds::OFF,
    }
}

impl Builder<'_> {
    pub(super) fn wait(&mut self, file: &WaitFile, axes: &[Axis]) -> Option<WaitRule> {
        let mut shared = Vec::new();
        for name in &file.shared {
            match axes.iter().position(|axis| axis.name == *name.get_ref()) {
                Some(joint) => shared.push(joint),
                None => {
                    let message =
                        format!("[wait] shared has {}; {}", name.get_ref(), axes_are(axes));
                    self.fault(CODE, name.span(), message, "");
                }
            }
        }
        let channel = self.counted(&file.channel).map(|channel| channel as u32);
        let channels = self.counted(&file.channels).map(|channels| channels as u32);
        if let (Some(own), Some(all), Some(said)) = (channel, channels, &file.channel)
            && own > all
        {
            let message = format!("[wait] channel {own} of {all} channels");
            self.fault(CODE, said.span(), message, "channels are counted from 1");
        }
        let word = file.word.as_ref();
        let marks = self.marks(file);
        let rule = WaitRule {
            word: word.map(|word| word.get_ref().clone()),
            marks: marks?,
            channel,
            channels,
            shared,
            shares_spindle: file.shared_spindle,
        };
        if let (Some(word), Some(fault)) = (word, rule.fault()) {
            self.fault(CODE, word.span(), fault, "word = \"M{n}\", \"WAITM({n},{channels})\"");
        }
        Some(rule)
    }

    /// Least and largest mark; none if the file says nothing of waits, or with a fault.
    fn marks(&mut self, file: &WaitFile) -> Option<[u32; 2]> {
        let help = "marks = [100, 199]: the numbers behind SYNC that the control takes";
        let Some(said) = &file.marks else {
            let word = file.word.as_ref();
            if let Some(word) = word {
                self.fault(CODE, word.span(), "[wait] has no marks".to_owned(), help);
            }
            let any = file.channel.is_some() || file.channels.is_some() || !file.shared.is_empty();
            return (word.is_none() && (any || file.shared_spindle)).then_some([0, 0]);
        };
        let [least, most] = said.get_ref().each_ref().map(|mark| self.number(mark));
        let whole = |mark: f64| mark.fract() == 0.0 && (0.0..1e6).contains(&mark);
        if !whole(least) || !whole(most) || !(0.0..f64::from(MOST_MARKS)).contains(&(most - least))
        {
            let message = format!(
                "[wait] marks from {least} to {most}: whole numbers from 0 up are possible, {MOST_MARKS} at most"
            );
            self.fault(CODE, said.span(), message, help);
            return None;
        }
        Some([least as u32, most as u32])
    }
}
