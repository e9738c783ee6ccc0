//! Straight moves, the way to the part and away from it.

use post_plugin::{CutLine, CutRun, Dialect as _, Feed, Group, NumberStyle, ToolPose};

use crate::Heidenhain;

/// Vectors have seven decimals.
const VECTOR: f64 = 1e7;

fn unit(vector: [f64; 3]) -> [f64; 3] {
    vector.map(|part| (part * VECTOR).round())
}

impl Heidenhain {
    pub(crate) fn rapid_group(
        &mut self,
        words: &[f64],
        group: Group,
        out: &mut String,
    ) -> Result<(), String> {
        if self.axes.moved_group(words, group) {
            self.block.word("L");
            self.axes.write_group(&mut self.block, words, group);
            self.finish_move(None, true, out)?;
        }
        Ok(())
    }

    pub(crate) fn approach(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        plane_first: bool,
        out: &mut String,
    ) -> Result<(), String> {
        self.radius.forget();
        // The rotary axes have been turned; what is left of them here moves nothing else, but where all axes go at once.
        if plane_first || self.tcp || self.tilted {
            self.rapid_group(words, Group::Rotary, out)?;
        }
        if self.tcp && !self.tilted && self.tcp_active.set(true) {
            self.vector = None;
            self.own(&self.tcp_on.clone(), out);
        }
        if plane_first {
            self.rapid_group(words, Group::Plane, out)?;
        }
        if self.axes.moved(words) {
            self.block.word("L");
            self.axes.write(&mut self.block, words);
            self.finish_move(feed, true, out)?;
        }
        self.stand(words);
        Ok(())
    }

    /// A straight move. With the surface's normal, and under TCP with the tool's vector if that is asked for, it is an
    /// `LN`.
    pub(crate) fn go(
        &mut self,
        words: &[f64],
        tool: Option<ToolPose>,
        normal: Option<[f64; 3]>,
        feed: Option<Feed>,
        out: &mut String,
    ) -> Result<(), String> {
        let linear = [Group::Plane, Group::Depth];
        let moved = linear.map(|group| self.axes.moved_group(words, group));
        let length = moved.contains(&true);
        let kept = self.tcp && self.tcp_active.is(true);
        if normal.is_some() && self.rotary && !kept {
            return Err(
                "a surface normal is one of the part: the control must keep the tip (M128)"
                    .to_owned(),
            );
        }
        let vector = tool.filter(|_| self.vectors && kept).map(|tool| unit(tool.axis));
        let before = std::mem::replace(&mut self.vector, vector);
        if vector.is_none() && before.is_some() {
            // Where the vectors have brought the rotary axes is not known.
            self.axes.forget();
        }
        let turned = vector.is_some() && vector != before;
        let still = vector.is_some() || !self.axes.moved_group(words, Group::Rotary);
        if !length && !turned && still {
            return Ok(());
        }
        let plain = normal.is_none() && vector.is_none();
        self.block.word(if plain { "L" } else { "LN" });
        if let (false, true, Some([x, y, z])) = (plain, length, self.linear) {
            // A block with vectors has all three, changed or not.
            self.axes.forget_some(1 << x | 1 << y | 1 << z);
        }
        if vector.is_some() {
            for group in linear {
                self.axes.write_group(&mut self.block, words, group);
            }
        } else {
            self.axes.write(&mut self.block, words);
        }
        let vectors = [(["NX", "NY", "NZ"], normal.map(unit)), (["TX", "TY", "TZ"], vector)];
        for (addresses, parts) in vectors {
            for (address, part) in addresses.into_iter().zip(parts.into_iter().flatten()) {
                self.block.number(address, part / VECTOR, 7, crate::SIGNED);
            }
        }
        self.finish_move(feed, length || turned, out)?;
        self.stand(words);
        Ok(())
    }

    /// Runs of cuts are worth more than cuts one by one.
    pub(crate) fn takes_runs(&self) -> bool {
        !self.vectors && !self.inch
    }

    /// Cuts one by one, until nothing but words and feeds is left to be written.
    pub(crate) fn cuts(&mut self, run: &CutRun<'_>, out: &mut String) -> Result<(), String> {
        let straight = self.axes.takes_cuts(run) && self.takes_runs();
        let minute = matches!(run.kind(), Feed::PerMinute(_));
        let mut words = Vec::new();
        for place in 0..run.len() {
            let carries_on = self.radius.is(self.compensation) && self.vector.is_none();
            // The first may have to switch on what a stop has switched off, or to call the tool.
            if straight && minute && carries_on && place > 0 {
                let style = NumberStyle::default();
                let line =
                    CutLine { head: "L", decimals: self.feed_decimals, style, every_feed: false };
                self.axes.write_cuts(run, place, &line, &mut self.block, &mut self.feed, out);
                self.at.clear();
                self.at.extend(run.end());
                return Ok(());
            }
            self.write(&run.linear(place, &mut words), out)?;
        }
        Ok(())
    }

    /// A move has ended there.
    pub(crate) fn stand(&mut self, words: &[f64]) {
        self.at.clear();
        self.at.extend_from_slice(words);
    }

    /// Radius compensation and feed, the words after the axes. In an inch program F counts tenths of an inch,
    /// but degrees where rotary axes move alone.
    pub(crate) fn finish_move(
        &mut self,
        feed: Option<Feed>,
        length: bool,
        out: &mut String,
    ) -> Result<(), String> {
        if self.radius.set(self.compensation) {
            self.block.word(self.compensation);
        }
        match feed {
            None => {
                // For this block alone; the F before stays in force.
                self.block.word("FMAX");
            }
            Some(Feed::PerMinute(feed)) => {
                let (value, decimals) = match self.inch && length {
                    true => (feed * 10.0, self.tenths_decimals),
                    false => (feed, self.feed_decimals),
                };
                if self.feed.set(value) {
                    self.block.number("F", value, decimals, NumberStyle::default());
                }
            }
            Some(other) => {
                return Err(format!("this control has no feed like {other}"));
            }
        }
        self.block.end(out);
        Ok(())
    }

    /// The tool leaves the part; the control keeps the tip no longer, as M91 asks for.
    pub(crate) fn leave(&mut self, axes: u32, words: &[f64], out: &mut String) {
        if self.rotary && self.tcp_active.set(false) {
            self.own(&self.tcp_off.clone(), out);
        }
        if self.retract.is_empty() {
            self.in_machine_coordinates(axes, words, out);
        } else if self.called || !self.retract.split_whitespace().any(|word| word == "M140") {
            self.own(&self.retract.clone(), out);
        } else {
            // The tool's axis is named by a TOOL CALL: the first change goes to its place by itself.
            self.stays = true;
        }
        self.axes.forget();
        self.radius.forget();
    }

    /// Axes at rapid to positions in machine coordinates, for this block alone.
    pub(crate) fn in_machine_coordinates(&mut self, axes: u32, words: &[f64], out: &mut String) {
        self.block.word("L");
        self.axes.write_machine(&mut self.block, axes, words);
        self.block.line("R0 FMAX M91", out);
        self.radius.forget();
    }
}
