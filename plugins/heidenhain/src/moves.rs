//! Straight moves, the way to the part and away from it.

use post_plugin::{Feed, Group, NumberStyle};

use crate::Heidenhain;

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
        // The rotary axes have been turned; what is left of them here moves nothing else.
        self.rapid_group(words, Group::Rotary, out)?;
        if self.tcp && self.tcp_active.set(true) {
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
        Ok(())
    }

    /// Radius compensation and feed, the words behind the axes. In an inch program F counts tenths of an inch,
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
                    true => (feed * 10.0, self.feed_decimals - 1),
                    false => (feed, self.feed_decimals),
                };
                if self.feed.set(value) {
                    self.block
                        .number("F", value, decimals, NumberStyle::default());
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
        } else {
            self.own(&self.retract.clone(), out);
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
