//! Moves that need more than axis words: first positions, tool vectors, arcs, holes.

use post_iso::{Control, Engine};
use post_plugin::{Event, Feed, Group, NumberStyle, SpindleSense, ToolPose};

use crate::Siemens;

impl Siemens {
    /// Words of moves are tool vectors.
    pub(crate) fn by_vector(&self) -> bool {
        self.vectors && self.tcp_active.is(true)
    }

    /// A move has ended there.
    pub(crate) fn stand(&mut self, words: &[f64]) {
        self.at.clear();
        self.at.extend_from_slice(words);
    }

    /// The plane of arcs and compensation, and of the tool's length.
    pub(crate) fn upright(&mut self, engine: &mut Engine, out: &mut String) {
        if self.plane.set(self.across) {
            engine.line(self.across, out);
        }
    }

    /// A transformation has ended, and perhaps the work offset: it is named again ahead of the next position.
    pub(crate) fn offset_may_be_off(&mut self, engine: &mut Engine) {
        self.offset_off = true;
        engine.offset_may_be_off();
    }

    /// The edge of the tool, unless it is in force.
    pub(crate) fn length_on(&mut self, engine: &mut Engine, out: &mut String) {
        if self.length.set(true) {
            engine.line(&format!("D{}", self.edge), out);
        }
    }

    /// Forgets what a tool change may have undone: it may have come with a safe state.
    pub(crate) fn changed(&mut self) {
        self.length.forget();
        if self.across != "G17" {
            self.plane.forget();
        }
    }

    /// Forgets what is in force, after a line of the user's own.
    pub(crate) fn forget(&mut self) {
        self.tcp_active.forget();
        self.plane.forget();
        self.vector.forget();
        self.length.forget();
    }

    /// Offset and rotary axes first, then the length, the transformation, the plane and last the depth.
    pub(crate) fn position(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        plane_first: bool,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<(), String> {
        // The engine leaves it to the user.
        if std::mem::take(&mut self.offset_off) && self.own_offset {
            engine.line(&self.offset, out);
        }
        match plane_first || self.tcp || self.tilted {
            true => engine.write(&Event::Turn { words }, out)?,
            // All axes go at once.
            false => engine.before_position(out),
        }
        self.upright(engine, out);
        self.length_on(engine, out);
        if self.tcp && !self.tilted && self.tcp_active.set(true) {
            engine.line(&self.tcp_on, out);
            // Whether a transformation that begins keeps the frames is a machine datum.
            engine.line(&self.offset, out);
            self.vector.forget();
        }
        if plane_first {
            engine.motion.plane(words, out);
        }
        engine.motion.arrive(words, None, feed, "", out);
        self.stand(words);
        Ok(())
    }

    /// A straight move with the tool's vector in the place of rotary words; where it is not known, with those.
    pub(crate) fn go(
        &mut self,
        words: &[f64],
        tool: Option<ToolPose>,
        feed: Option<Feed>,
        engine: &mut Engine,
        out: &mut String,
    ) {
        let motion = &mut engine.motion;
        let vector = tool.map(|tool| tool.axis.map(|part| (part * 1e7).round()));
        match (vector, feed) {
            (Some(vector), _) => {
                let turned = self.vector.set(vector);
                let groups = [Group::Plane, Group::Depth];
                if !turned && !groups.iter().any(|group| motion.axes.moved_group(words, *group)) {
                    return;
                }
                if let Some(feed) = feed {
                    motion.feed_mode(feed);
                }
                motion.motion(if feed.is_some() { "G1" } else { "G0" });
                motion.write_pending();
                for group in groups {
                    motion.axes.write_group(&mut motion.block, words, group);
                }
                for (address, part) in ["A3=", "B3=", "C3="].into_iter().zip(vector) {
                    if turned {
                        motion.block.number(address, part / 1e7, 7, NumberStyle::default());
                    }
                }
                if let Some(feed) = feed {
                    motion.feed(feed);
                }
                motion.block.end(out);
            }
            (None, feed) => {
                self.vector.forget();
                // Where the vectors have brought the rotary axes is not known.
                motion.axes.forget();
                match feed {
                    Some(feed) => motion.cut(words, feed, out),
                    None => motion.rapid(words, out),
                }
            }
        }
        self.stand(words);
    }

    /// An arc in the block's plane, with its centre from the start, or its radius.
    pub(crate) fn arc(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<(), String> {
        let (&Event::Arc { feed, centre, normal, turn, radius, words, .. }, Some(linear)) =
            (event, self.linear)
        else {
            return Err(event.refusal());
        };
        let planes = ["G19", "G18", "G17"];
        let across = normal.iter().position(|part| part.abs() > 0.999_999);
        let (Some(across), false) = (across, self.at.is_empty()) else {
            return Err("an arc needs a start and one of the planes G17, G18, G19".to_owned());
        };
        let motion = &mut engine.motion;
        motion.feed_mode(feed);
        if self.plane.set(planes[across]) {
            motion.block.word(planes[across]);
        }
        let counter = (turn > 0.0) == (normal[across] > 0.0);
        motion.motion(if counter { "G3" } else { "G2" });
        motion.write_pending();
        if self.vectors && self.tcp_active.is(true) {
            // The rotary axes stand still, where the control has brought them.
            for group in [Group::Plane, Group::Depth] {
                motion.axes.write_group(&mut motion.block, words, group);
            }
        } else {
            motion.axes.write(&mut motion.block, words);
        }
        match radius {
            Some(radius) => {
                motion.block.number("CR=", radius, self.decimals, self.style);
            }
            None => {
                for (part, address) in ["I", "J", "K"].into_iter().enumerate() {
                    if part != across {
                        let offset = centre[part] - self.at[linear[part]];
                        motion.block.number(address, offset, self.decimals, self.style);
                    }
                }
            }
        }
        // Full turns before the one that ends there.
        let more = ((turn.abs() - 1e-6) / 360.0).floor();
        if more >= 1.0 {
            motion.block.number("TURN=", more, 0, NumberStyle::default());
        }
        motion.feed(feed);
        motion.block.end(out);
        self.stand(words);
        Ok(())
    }

    /// A hole: the modal call, if it is not in force, and its place.
    pub(crate) fn drill(
        &mut self,
        words: &[f64],
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<(), String> {
        let (Some([x, y, z]), Some(drilling)) = (self.linear, self.drilling) else {
            return Err("a point of a cycle comes without its cycle".to_owned());
        };
        let call = self.cycles.call(&drilling, words[z], self.turning)?;
        if self.called.as_ref() != Some(&call) {
            self.end_call(engine, out);
            self.upright(engine, out);
            if !drilling.is_thread() {
                engine.motion.feed_mode(drilling.feed);
                engine.motion.feed(drilling.feed);
                engine.motion.block.end(out);
            }
            engine.line(&call, out);
            self.called = Some(call);
        }
        let motion = &mut engine.motion;
        motion.motion("G0");
        // Both words, whatever was written before; what it says of the depth stays true at the end of the hole.
        let place = 1 << x | 1 << y;
        motion.axes.write_machine(&mut motion.block, place, words);
        motion.block.end(out);
        self.stand(words);
        Ok(())
    }

    /// Ends the modal call: any block that moves, or says how, would drill.
    pub(crate) fn end_call(&mut self, engine: &mut Engine, out: &mut String) {
        if let Some(called) = self.called.take() {
            engine.line("MCALL", out);
            self.oriented = called.starts_with("MCALL CYCLE86");
        }
    }

    /// The spindle, which boring has left oriented (CYCLE86), turns again.
    pub(crate) fn turn_again(&mut self, engine: &mut Engine, out: &mut String) {
        self.oriented = false;
        let [clockwise, counter, ..] = Self::TABLE.spindle;
        match self.turning {
            Some((_, SpindleSense::Clockwise)) => engine.line(clockwise, out),
            Some((_, SpindleSense::CounterClockwise)) => engine.line(counter, out),
            None => {}
        }
    }
}
