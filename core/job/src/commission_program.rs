//! `post check --commission`: a program that moves each axis by itself, in the machine's own dialect.
//!
//! It is made of remarks, stops and slow straight moves alone. A first position (`Event::Position`) would put
//! tool length and TCP in force and rapid through the workspace, so none is asked for, and the dialect is told
//! that the control does not keep the tip: a word is the value of its axis. The linear words count from where
//! the axes stand at the start, which the operator sets to zero there, so the program cannot go anywhere that he
//! has not seen.

use std::path::PathBuf;

use post_machine::axis_words;
use post_machine::check::{Commission, CommissionMove, Probe, Sign, number};
use post_machine::description::{Axis, Machine, OutputUnits, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::{Batch, DialectSession, Event, Feed, Format};

use super::{JobMachine, plugin_finder};
use crate::failure::Failure;
use crate::files::{self, PathArg, Role};
use crate::session::Session;

/// A remark longer than this is no longer read whole on a control's screen.
const REMARK: usize = 58;

/// What was written.
pub struct Commissioned {
    /// Where the program stands.
    pub target: PathArg,
    /// Moves in it, one axis each.
    pub moves: usize,
    /// A text went to standard output.
    pub printed: bool,
}

/// Writes the program of a machine with a tool of `length` mm to `output`, else to `commission` with the dialect's ending.
///
/// # Errors
/// The chain cannot be solved, the dialect not be used, or the file not be written.
pub fn write(
    session: &Session,
    JobMachine { machine, finder }: &JobMachine,
    length: f64,
    output: Option<&PathArg>,
) -> Result<Commissioned, Failure> {
    let mut plain = machine.clone();
    plain.control.tcp = Tcp::Post;
    let probe = Probe::new(&plain, length).map_err(|lack| machine.unsolvable(&lack))?;
    let order = axis_words::order(&plain);
    let plan = Commission::of(&probe, &order);
    let beside = PathArg::from(PathBuf::from("commission"));
    let name = output.and_then(PathArg::stem);
    let name = name.unwrap_or_else(|| "COMMISSION".to_owned());
    let (mut dialect, _) = plugin_finder::dialect(finder, &plain, &name, None)?;
    let extension = dialect.format().extension.clone();
    let beside = || beside.map(|path| path.with_extension(&extension));
    let target = output.cloned().unwrap_or_else(beside);
    let mut writer = Writer {
        machine: &plain,
        order: &order,
        format: dialect.format().clone(),
        start: plan.start,
        batch: Batch::default(),
    };
    writer.program(&plan);
    let (mut text, mut ends) = (String::new(), Vec::new());
    dialect
        .write_batch(&writer.batch, &mut text, &mut ends)
        .map_err(|fault| Diagnostic::error("dialect", fault.message))?;
    let printed = files::write(session, &[(Role::PROGRAM, &target, &text)])?;
    Ok(Commissioned { target, moves: plan.trials.len(), printed })
}

/// A blank that a line is not broken at.
const KEEP: char = '\u{a0}';

struct Writer<'a> {
    machine: &'a Machine,
    /// Places of the axes in the order of their words.
    order: &'a [usize],
    format: Format,
    start: Joints,
    batch: Batch,
}

impl Writer<'_> {
    fn program(&mut self, plan: &Commission) {
        self.batch.push(0, Event::Start);
        self.head();
        let mut trials = plan.trials.iter().peekable();
        if let Some(first) = trials.peek() {
            // Whoever has set it up as told sees no move here; else it is a slow one.
            let feed = self.feed(first);
            let words = self.words(&plan.start);
            self.batch.push(0, Event::linear(&words, feed));
        }
        while let Some(trial) = trials.next() {
            let following = trials.peek().copied();
            self.trial(trial, following);
        }
        self.batch.push(0, Event::End);
    }

    fn head(&mut self) {
        let axes = self.order.iter().map(|place| &self.machine.axes[*place]);
        let (rotary, linear): (Vec<&Axis>, Vec<&Axis>) = axes.partition(|axis| axis.joint.rotary);
        let names = |axes: &[&Axis]| {
            let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
            names.join(" ")
        };
        self.say(&format!("Commissioning of {}: each axis moves by itself", self.machine.name));
        self.say("RUN IT WITHOUT A PART, WITH AN EMPTY TABLE AND SPINDLE, IN SINGLE BLOCK, WITH A HAND ON THE FEED OVERRIDE");
        self.say("TCP and tool length compensation must be off");
        self.say("Before the start bring the axes to these machine positions, and see that nothing is in the way:");
        let at = self.told(&self.start, false);
        self.say(&at);
        let mut set = Vec::new();
        if !linear.is_empty() {
            let shown = names(&linear);
            set.push(format!("There set the work offset that is in force so that {shown} show 0"));
        }
        if !rotary.is_empty() {
            set.push(format!("the offset of {} is 0", names(&rotary)));
        }
        self.say(&set.join("; "));
        self.say("If anything else is seen than the remark before a move says, press feed hold: the machine file has that sign or direction wrong");
        let shown = self.told(&self.start, true);
        self.say(&format!("Now the display shows {shown}; else do not go on"));
        self.say("The first block after this stop must move nothing");
        self.batch.push(0, Event::Stop);
    }

    /// Away from the start, a stop, and back; the stop before it tells what must be seen.
    fn trial(&mut self, trial: &CommissionMove, following: Option<&CommissionMove>) {
        let axis = &self.machine.axes[trial.place];
        let Sign { by, tool, seen, .. } = &trial.sign;
        let unit = match (axis.joint.rotary, self.machine.control.units) {
            (true, _) => "deg",
            (false, OutputUnits::Mm) => "mm",
            (false, OutputUnits::Inch) => "inch",
        };
        let length = self.length(axis);
        let plus = if *by > 0.0 { "+" } else { "" };
        self.say(&format!("Next {} {plus}{} {unit}: {seen}", axis.name, number(by / length, 4)));
        if axis.joint.rotary {
            self.say(&format!("The tool, seen from the part: {tool}"));
        }
        self.batch.push(0, Event::Stop);
        if let Some(clamp) = &axis.clamp {
            self.batch.push(0, Event::Word { text: &clamp.off });
        }
        let mut there = self.start;
        there[trial.place] += trial.by;
        let feed = self.feed(trial);
        let words = self.words(&there);
        self.batch.push(0, Event::linear(&words, feed));
        let shown = self.told(&there, true);
        self.say(&format!("The display shows {shown}"));
        self.batch.push(0, Event::Stop);
        let words = self.words(&self.start);
        self.batch.push(0, Event::linear(&words, feed));
        if let Some(clamp) = &axis.clamp {
            self.batch.push(0, Event::Word { text: &clamp.on });
        }
        if following.is_none() {
            let shown = self.told(&self.start, true);
            self.say(&format!("The display shows {shown}"));
            self.say("All axes are tried. After this stop nothing moves");
            self.batch.push(0, Event::Stop);
        }
    }

    /// A remark, over as many lines as it needs.
    fn say(&mut self, text: &str) {
        let mut line = String::new();
        for word in text.split(' ') {
            if !line.is_empty() && line.len() + 1 + word.len() > REMARK {
                self.batch.push(0, Event::Comment { text: &line });
                line.clear();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(&word.replace(KEEP, " "));
        }
        self.batch.push(0, Event::Comment { text: &line });
    }

    /// mm in a unit of a linear word; 1 for a rotary one.
    fn length(&self, axis: &Axis) -> f64 {
        if axis.joint.rotary { 1.0 } else { axis_words::unit_length(self.machine.control.units) }
    }

    /// The words for axis values, in their order and as they are printed: linear ones from the start.
    fn words(&self, joints: &Joints) -> Vec<f64> {
        self.values(joints, true)
    }

    fn values(&self, joints: &Joints, from_start: bool) -> Vec<f64> {
        let mut shows = Joints::default();
        for (place, axis) in self.machine.axes.iter().enumerate() {
            shows[place] = if axis.joint.rotary || !from_start {
                shown(axis, joints[place])
            } else {
                joints[place] - self.start[place]
            };
        }
        // Where words are no axis values, those of other axes follow.
        let words = self.machine.word_map.as_ref().map_or(shows, |map| map.words(&shows));
        let order = self.order.iter().zip(&self.format.words);
        let values = order.map(|(place, decimals)| {
            let scale = (0..*decimals).fold(1.0, |scale, _| scale * 10.0);
            let length = self.length(&self.machine.axes[*place]);
            libm::rint(words[*place] / length * scale) / scale + 0.0
        });
        // A word that goes with the way of the tip stands still.
        values.chain(self.machine.along.iter().map(|_| 0.0)).collect()
    }

    /// `X 30.000 Y 0.000 …`.
    fn told(&self, joints: &Joints, from_start: bool) -> String {
        let values = self.values(joints, from_start);
        let each = self.order.iter().zip(&self.format.words).zip(values);
        let each = each.map(|((place, decimals), value)| {
            let name = &self.machine.axes[*place].name;
            format!("{name}{KEEP}{value:.*}", usize::from(*decimals))
        });
        each.collect::<Vec<_>>().join(" ")
    }

    fn feed(&self, trial: &CommissionMove) -> Feed {
        let axis = &self.machine.axes[trial.place];
        let inch = self.machine.control.units == OutputUnits::Inch;
        let per_minute = match (axis.joint.rotary, inch) {
            // Controls that count tenths of an inch read ten times the degrees: the first run stays slow on them.
            (true, true) => trial.feed / 10.0,
            _ => trial.feed / self.length(axis),
        };
        let scale = (0..self.format.feed).fold(1.0, |scale, _| scale * 10.0);
        Feed::PerMinute((per_minute * scale).floor().max(1.0) / scale)
    }
}

/// What the control shows of an axis: of an endless one, within its range.
fn shown(axis: &Axis, value: f64) -> f64 {
    let reading = axis.reading(value);
    match axis.range {
        None => reading,
        Some([least, _]) => {
            let least = least / axis.unit();
            let turned = reading - least;
            least + turned - 360.0 * (turned / 360.0).floor()
        }
    }
}
