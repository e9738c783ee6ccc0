//! The first and last lines of a program, remarks and lines of the user's own.

use post_plugin::{ascii, wrapped};

use crate::Heidenhain;

/// Characters of a program's name that the control shows (TNC 640, ISO programming 1/2015, p. 112).
const NAME_LENGTH: usize = 24;

/// Longer remarks become several; no manual gives a limit, and the screen shows as many.
const REMARK_LENGTH: usize = 80;

impl Heidenhain {
    pub(crate) fn start(&mut self, out: &mut String) {
        self.frame("BEGIN", out);
        if !self.machine.is_empty() {
            self.comment(&self.machine.clone(), out);
        }
        if self.preset >= 0 {
            // The second line continues the block and has no number.
            let words = format!(
                "CYCL DEF 247 DATUM SETTING ~\n    Q339=+{} ;DATUM NUMBER",
                self.preset
            );
            self.block.line(&words, out);
        }
        if self.reset {
            self.cancel(out);
        }
        self.block.line(&self.rotary_way, out);
    }

    /// What a program before, or the operator, may have left in force. Nothing of it moves an axis.
    pub(crate) fn cancel(&mut self, out: &mut String) {
        if self.rotary {
            // M128 outlives the end of a program; in a tilted plane M91 would still be the machine's own.
            self.own(&self.tcp_off.clone(), out);
            self.tcp_active.set(false);
            self.block.line("PLANE RESET STAY", out);
        }
        for line in [
            "CYCL DEF 7.0 DATUM SHIFT",
            "CYCL DEF 7.1 X+0",
            "CYCL DEF 7.2 Y+0",
            "CYCL DEF 7.3 Z+0",
            "CYCL DEF 8.0 MIRROR IMAGE",
            "CYCL DEF 8.1",
            "CYCL DEF 10.0 ROTATION",
            "CYCL DEF 10.1 ROT+0",
            "CYCL DEF 11.0 SCALING",
            "CYCL DEF 11.1 SCL 1",
        ] {
            self.block.line(line, out);
        }
    }

    pub(crate) fn frame(&mut self, word: &str, out: &mut String) {
        let units = if self.inch { "INCH" } else { "MM" };
        self.block
            .line(&format!("{word} PGM {} {units}", self.program), out);
    }

    pub(crate) fn comment(&mut self, text: &str, out: &mut String) {
        // A tilde at the end would continue the block.
        let text = ascii(text).replace('~', "-");
        for piece in wrapped(text.trim(), REMARK_LENGTH) {
            self.block.line(format!("; {piece}").trim_end(), out);
        }
    }

    /// Lines of the user's own, a block each; one behind a tilde goes on with its block and has no number.
    pub(crate) fn own(&mut self, lines: &str, out: &mut String) {
        let mut goes_on = false;
        for line in lines.lines().filter(|line| !line.is_empty()) {
            if goes_on {
                out.push_str(line);
                out.push('\n');
            } else {
                self.block.line(line, out);
            }
            goes_on = line.trim_end().ends_with('~');
        }
    }

    pub(crate) fn end(&mut self, out: &mut String) {
        self.stop(out);
        self.block.line("M30", out);
        self.frame("END", out);
    }

    /// After a line of the user's own nothing is known to be in force.
    pub(crate) fn forget(&mut self) {
        self.speed.forget();
        self.feed.forget();
        self.radius.forget();
        self.axes.forget();
        self.tcp_active.forget();
        // What turns and flows was asked for all the same: a stop behind it switches that off.
        self.spindle_on.forget();
        self.coolant_on.forget();
    }
}

/// A name that the control takes: letters, digits, `_` and `-`, as many as it shows.
pub(crate) fn program_name(name: &str) -> String {
    let plain = ascii(name);
    let allowed = |letter: char| match letter {
        letter if letter.is_ascii_alphanumeric() || letter == '-' => letter.to_ascii_uppercase(),
        _ => '_',
    };
    match plain.trim() {
        "" => "PROGRAM".to_owned(),
        plain => plain.chars().take(NAME_LENGTH).map(allowed).collect(),
    }
}
