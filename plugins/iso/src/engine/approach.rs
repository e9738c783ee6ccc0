//! The way to a first position.

use post_plugin::{Feed, ToolPose};

use super::Engine;
use crate::table::Tcp;

impl Engine {
    /// Goes from where the tool is retracted to `words`: the plane first, where the words of the plane move the tool
    /// across, and the depth last; nothing comes in by the depth while another axis has still to move by the length.
    pub(super) fn position(
        &mut self,
        words: &[f64],
        tool: Option<ToolPose>,
        feed: Option<Feed>,
        plane_first: bool,
        out: &mut String,
    ) -> Result<(), String> {
        let keeps_tip = self.tcp && !self.plane.is_on();
        let mut length = match self.plane.is_on() && self.length_ahead_of_plane() {
            true => String::new(),
            false => self.length()?,
        };
        self.cancel_what_was(out);
        self.settings.smoothing_due(&mut self.motion, out);
        self.offset_before_position(out);
        // The rotary axes have been turned; what is left of them here moves nothing else, but where all axes go at once.
        if plane_first || keeps_tip || self.plane.is_on() {
            self.motion.turn(words, out);
        }
        let across =
            plane_first && keeps_tip && tool.is_some_and(|tool| self.motion.lies_across(tool.axis));
        if plane_first && !across {
            self.motion.plane(words, out);
        }
        if let (true, Tcp::Blocks { length_first, .. }) = (keeps_tip, self.table.tcp) {
            if self.tcp_on.contains("{h}") {
                // Its words name the register themselves.
                length.clear();
            } else if length_first {
                self.motion.line(&std::mem::take(&mut length), out);
            }
            let on = self.tcp_begin();
            self.motion.line(&on, out);
        }
        if keeps_tip && self.table.tcp_at_rapid && feed.is_some() && !length.is_empty() {
            let length = std::mem::take(&mut length);
            self.motion.at_rapid(&length, out);
        }
        if keeps_tip {
            self.tcp_active.set(true);
        }
        let axis = match self.vector.filter(|_| keeps_tip) {
            Some(decimals) => {
                self.follows_vector = true;
                self.motion.follow_vector(Some(decimals));
                Some(leaning(tool)?)
            }
            None => None,
        };
        if across {
            // Up where the tool is retracted.
            let length = std::mem::take(&mut length);
            self.motion.across(words, axis, &length, out);
        }
        self.motion.arrive(words, axis, feed, &length, out);
        self.length_active.set(true);
        Ok(())
    }
}

/// The direction of the tool, where its words are written.
pub(super) fn leaning(tool: Option<ToolPose>) -> Result<[f64; 3], String> {
    tool.map(|tool| tool.axis)
        .ok_or_else(|| "nobody knows the direction of the tool here".to_owned())
}
