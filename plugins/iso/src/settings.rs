//! What is set beside the moves: smoothing, cutting speed, clamps, registers, messages, calls, the probe.

use post_plugin::{Capabilities, Event, Feed, Meaning, NumberStyle, Setup, SpindleSense};

use crate::engine::{Engine, one_by_one};
use crate::motion::MotionWriter;
use crate::options::text;
use crate::planes::INCH;
use crate::table::{Table, Tcp};

/// Words of the machine file for these, and what of them is in force.
#[derive(Debug)]
pub(crate) struct SettingWords {
    /// Tolerance, mm, and words, the smallest first.
    levels: Vec<(f64, String)>,
    smoothing_off: String,
    /// Words of the smoothing in force.
    smoothing: Option<String>,
    /// Words that wait for the length to be off.
    waiting: Option<String>,
    clamps: Vec<ClampWords>,
    /// Places of the words' names.
    axes: Vec<String>,
    /// Constant cutting speed in force.
    surface: Option<Surface>,
    /// Words that end the program.
    pub(crate) end: String,
}

/// What clamps an axis, and lets it go.
#[derive(Debug)]
struct ClampWords {
    axis: String,
    on: String,
    off: String,
}

/// A constant cutting speed.
#[derive(Clone, Copy, Debug)]
struct Surface {
    speed: f64,
    most: Option<f64>,
    sense: SpindleSense,
}

impl SettingWords {
    pub(crate) fn new(table: &Table, setup: &Setup<'_>) -> Result<Self, String> {
        let [levels, off] = table.smoothing;
        let mut levels: Vec<(f64, String)> = text(setup, "smoothing", levels)
            .lines()
            .filter(|line| !line.trim().is_empty())
            .map(level)
            .collect::<Result<_, _>>()?;
        levels.sort_by(|one, other| one.0.total_cmp(&other.0));
        let clamps = text(setup, "clamps", "");
        let clamps = clamps.lines().filter(|line| !line.trim().is_empty());
        Ok(SettingWords {
            levels,
            smoothing_off: text(setup, "smoothing_off", off),
            smoothing: None,
            waiting: None,
            clamps: clamps.map(|line| clamp(line, setup)).collect::<Result<_, _>>()?,
            axes: setup.words.iter().map(|word| word.name.to_owned()).collect(),
            surface: None,
            end: table.end.to_owned(),
        })
    }

    pub(crate) fn capabilities(&self, table: &Table) -> Capabilities {
        let declared = [
            (!self.levels.is_empty(), Capabilities::SMOOTHING),
            (!self.clamps.is_empty(), Capabilities::CLAMP),
            (table.surface.is_some(), Capabilities::SURFACE_SPEED),
            (!table.message.is_empty(), Capabilities::MESSAGE),
            (!table.probe.is_empty(), Capabilities::PROBE),
            (!table.subprogram.number.is_empty(), Capabilities::SUBPROGRAM),
        ];
        let declared = declared.into_iter().filter(|(has, _)| *has);
        declared.fold(Capabilities::NONE, |all, (_, capability)| all | capability)
    }

    /// Words of smoothing and clamps, for reading back.
    pub(crate) fn words(&self, add: &mut dyn FnMut(&str, Meaning)) {
        for (_, words) in &self.levels {
            add(words, Meaning::Smoothing);
        }
        if !self.levels.is_empty() {
            add(&self.smoothing_off, Meaning::SmoothingOff);
        }
        for clamp in &self.clamps {
            add(&clamp.on, Meaning::Clamp);
            add(&clamp.off, Meaning::Unclamp);
        }
    }

    /// Smoothing that has waited for the length to be off.
    pub(crate) fn smoothing_due(&mut self, motion: &mut MotionWriter, out: &mut String) {
        if let Some(words) = self.waiting.take() {
            motion.line(&words, out);
            self.smoothing = Some(words);
        }
    }

    /// Ends the smoothing, if it is in force.
    pub(crate) fn end_smoothing(&mut self, motion: &mut MotionWriter, out: &mut String) {
        self.waiting = None;
        if self.smoothing.take().is_some() {
            motion.line(&self.smoothing_off, out);
        }
    }

    /// The words that smooth within `tolerance`, mm.
    fn level(&self, tolerance: f64, inch: bool) -> Result<String, String> {
        let levels = self.levels.iter().rev();
        let mut fitting = levels.filter(|(least, _)| *least <= tolerance);
        let Some((_, words)) = fitting.next() else {
            return Err(format!(
                "no level of the option `smoothing` keeps the path within {tolerance} mm"
            ));
        };
        let (value, decimals) = match inch {
            true => (tolerance / INCH, 5),
            false => (tolerance, 4),
        };
        let mut number = String::new();
        let style = NumberStyle { point: true, trim: true, plus: false };
        style.write(&mut number, value, decimals);
        Ok(words.replace("{}", &number))
    }
}

/// `0.01 G5.1 Q1 R5`.
fn level(line: &str) -> Result<(f64, String), String> {
    let (tolerance, words) = line.trim().split_once(' ').unwrap_or((line, ""));
    match tolerance.parse::<f64>() {
        Ok(tolerance) if tolerance >= 0.0 && !words.trim().is_empty() => {
            Ok((tolerance, words.trim().to_owned()))
        }
        _ => Err(format!(
            "smoothing has the line `{line}`, must be a tolerance in mm and the words for it: `0.01 G5.1 Q1 R5`"
        )),
    }
}

/// `C M10 M11`.
fn clamp(line: &str, setup: &Setup<'_>) -> Result<ClampWords, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let turns = |axis: &str| {
        let mut axes = setup.words.iter();
        axes.any(|word| word.rotary && word.name == axis)
    };
    match words.as_slice() {
        [axis, ..] if !turns(axis) => {
            Err(format!("clamps has the line `{line}`, and the machine has no rotary axis {axis}"))
        }
        [axis, on, off] => Ok(ClampWords {
            axis: (*axis).to_owned(),
            on: (*on).to_owned(),
            off: (*off).to_owned(),
        }),
        _ => Err(format!(
            "clamps has the line `{line}`, must be an axis, what clamps it and what lets it go: `C M10 M11`"
        )),
    }
}

impl Engine {
    /// Any event that is no move and no frame of moves.
    pub(crate) fn setting(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let table = self.table;
        match *event {
            Event::Smoothing { tolerance, .. } if !self.settings.levels.is_empty() => {
                let words = self.settings.level(tolerance, self.inch && !table.smoothing_in_mm)?;
                if self.settings.smoothing.as_ref() != Some(&words) {
                    self.smooth(words, out);
                }
            }
            Event::SmoothingOff if !self.settings.levels.is_empty() => {
                self.settings.waiting = None;
                self.settings.smoothing = None;
                let off = std::mem::take(&mut self.settings.smoothing_off);
                self.line(&off, out);
                self.settings.smoothing_off = off;
            }
            Event::Clamp { word, on } if !self.settings.clamps.is_empty() => {
                let axis = self.settings.axes.get(word as usize);
                let mut clamps = self.settings.clamps.iter();
                // An axis without a line has no clamp.
                if let Some(clamp) = clamps.find(|clamp| Some(&clamp.axis) == axis) {
                    let codes = if on { &clamp.on } else { &clamp.off };
                    one_by_one(codes, &mut self.motion, out);
                }
            }
            Event::Message { text } if !table.message.is_empty() => {
                let remark = (table.remark)(text);
                let inner = remark.trim_start_matches('(');
                self.bare(&format!("({}{inner}", table.message), out);
            }
            Event::SurfaceSpeed { speed, most, sense } if table.surface.is_some() => {
                self.settings.surface = Some(Surface { speed, most, sense });
                self.spindle_turns();
                self.surface_speed_again(out)?;
            }
            Event::Offsets { length, radius }
                if !table.length.on.is_empty() && !table.length.by_itself =>
            {
                self.registers(length, radius)?;
            }
            Event::Subprogram { number, times, name } => {
                self.call(number, times, name, event, out)?
            }
            Event::Probe { words, feed, .. } if !table.probe.is_empty() => {
                if matches!(feed, Feed::InverseTime(_)) {
                    return Err("a probing move has no inverse-time feed".to_owned());
                }
                self.motion.settle(out);
                self.motion.probe(table.probe, words, feed, out);
            }
            ref other => return Err(other.refusal()),
        }
        Ok(())
    }

    /// Sets the smoothing to another level, or once the length is off where the control asks for that.
    fn smooth(&mut self, words: String, out: &mut String) {
        if self.table.smoothing_anywhere || !self.length_active.is(true) {
            self.line(&words, out);
            self.settings.smoothing = Some(words);
        } else {
            // Until then the path is kept.
            self.settings.end_smoothing(&mut self.motion, out);
            self.settings.waiting = Some(words);
        }
    }

    /// The constant cutting speed in force, if one is.
    pub(crate) fn surface_speed_again(&mut self, out: &mut String) -> Result<(), String> {
        let (Some(words), Some(surface)) = (self.table.surface, self.settings.surface) else {
            return Ok(());
        };
        let style = NumberStyle::default();
        let block = &mut self.motion.block;
        // An address alone stands in the block of the speed.
        let beside = words.most.len() == 1;
        if let Some(most) = surface.most.filter(|_| !beside) {
            block.number(words.most, most, 0, style).end(out);
        }
        block.word(words.codes[0]);
        if let Some(most) = surface.most.filter(|_| beside) {
            block.number(words.most, most, 0, style);
        }
        block.number("S", surface.speed, 0, style);
        let [clockwise, counter, ..] = self.table.spindle;
        block.word(match surface.sense {
            SpindleSense::Clockwise => clockwise,
            SpindleSense::CounterClockwise => counter,
        });
        block.end(out);
        if let Some([per_minute, _]) = words.per_minute {
            // No feed by time: its word would end the cutting speed.
            self.motion.feeds_by([per_minute, "", words.codes[0]], words.codes[0]);
        }
        Ok(())
    }

    /// The word of a fixed speed, if a constant cutting speed was in force.
    pub(crate) fn end_surface_speed(&mut self) -> Option<&'static str> {
        let words = self.table.surface?;
        self.settings.surface.take()?;
        let fixed = match words.per_minute {
            Some([kept, fixed]) if self.motion.feeds_are(kept) => fixed,
            _ => words.codes[1],
        };
        if words.per_minute.is_some() {
            self.motion.feeds_by(self.table.codes.feed, fixed);
        }
        Some(fixed)
    }

    fn registers(&mut self, length: Option<u32>, radius: Option<u32>) -> Result<(), String> {
        let mut words = String::new();
        if let Some(length) = length {
            self.register = Some(length);
            if self.tcp_active.is(true) && matches!(self.table.tcp, Tcp::Length(_)) {
                return Err(
                    "another register of the length while tool centre point control is on: retract before"
                        .to_owned(),
                );
            }
            if self.length_active.is(true) {
                words = self.length()?;
            }
        }
        let named = !self.table.codes.radius.is_empty();
        if let Some(radius) = radius.filter(|_| named && self.motion.is_compensating()) {
            if !words.is_empty() {
                words.push(' ');
            }
            words.push_str(self.table.codes.radius);
            words.push_str(&radius.to_string());
        }
        if !words.is_empty() {
            self.motion.change_length(words);
        }
        Ok(())
    }

    fn call(
        &mut self,
        number: Option<u32>,
        times: u32,
        name: &str,
        event: &Event<'_>,
        out: &mut String,
    ) -> Result<(), String> {
        let forms = self.table.subprogram;
        let (form, called) = match number {
            Some(number) => (forms.number, number.to_string()),
            None => (forms.name, name.to_owned()),
        };
        if forms.number.is_empty() {
            return Err(event.refusal());
        }
        if form.is_empty() || called.is_empty() {
            return Err("this control calls subprograms by their number".to_owned());
        }
        let block = form.replace("{}", &called);
        match forms.times {
            _ if times == 1 => self.line(&block, out),
            "" => (0..times).for_each(|_| self.line(&block, out)),
            word => self.line(&format!("{block}{word}{times}"), out),
        }
        // It is not known where it has left the axes, and what it has put in force.
        self.forget();
        self.motion.moved_by_line();
        Ok(())
    }

    /// Lines of the user's own in the place of an event's.
    pub(crate) fn own_lines(&mut self, text: &str, out: &mut String) -> Result<(), String> {
        for line in text.lines() {
            crate::lines::fits(self.table, line)?;
            self.line(line, out);
        }
        Ok(())
    }

    /// Lines of the user's own that end the program.
    pub(crate) fn end_by(&mut self, lines: String) -> Result<(), String> {
        lines.lines().try_for_each(|line| crate::lines::fits(self.table, line))?;
        self.settings.end = lines;
        Ok(())
    }
}
