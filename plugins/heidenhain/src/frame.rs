//! The first and last lines of a program, remarks and lines of the user's own.

use post_plugin::{NumberStyle, Setup, Units, ascii, wrapped};

use crate::Heidenhain;

/// Characters of a program's name that the control shows (TNC 640, ISO programming 1/2015, p. 112).
const NAME_LENGTH: usize = 24;

/// Longer remarks become several; no manual gives a limit, and the screen shows as many.
const REMARK_LENGTH: usize = 80;

/// Names of the cycles that are cancelled at the start.
const GERMAN: &[(&str, &str)] = &[
    ("DATUM SHIFT", "NULLPUNKT"),
    ("MIRROR IMAGE", "SPIEGELN"),
    ("ROTATION", "DREHUNG"),
    ("SCALING", "MASSFAKTOR"),
];

impl Heidenhain {
    pub(crate) fn start(&mut self, out: &mut String) {
        self.frame("BEGIN", out);
        self.own(&self.stock.clone(), out);
        if !self.machine.is_empty() {
            self.comment(&self.machine.clone(), out);
        }
        if self.preset >= 0 {
            self.preset_row(self.preset, out);
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
        let english = [
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
        ];
        for line in english {
            let german = GERMAN.iter().find(|(english, _)| line.ends_with(english));
            match german.filter(|_| self.german) {
                Some((english, german)) => {
                    self.block.line(&line.replace(english, german), out);
                }
                None => self.block.line(line, out),
            }
        }
    }

    /// A heading, by which the control shows what the program does.
    pub(crate) fn structure(&mut self, name: &str, out: &mut String) {
        let text = ascii(name).replace('~', "-");
        if !text.trim().is_empty() {
            self.block.line(&format!("* - {:.200}", text.trim()), out);
        }
    }

    /// A label of this program by its number, another program by its name.
    pub(crate) fn subprogram(
        &mut self,
        number: Option<u32>,
        times: u32,
        name: &str,
        out: &mut String,
    ) {
        let call = match number {
            Some(number) => format!("CALL LBL {number}"),
            None => format!("CALL PGM {}", program_name(name)),
        };
        for _ in 0..times.max(1) {
            self.block.line(&call, out);
        }
        self.forget();
    }

    pub(crate) fn frame(&mut self, word: &str, out: &mut String) {
        let units = if self.inch { "INCH" } else { "MM" };
        self.block.line(&format!("{word} PGM {} {units}", self.program), out);
    }

    pub(crate) fn comment(&mut self, text: &str, out: &mut String) {
        // A tilde at the end would continue the block.
        let text = ascii(text).replace('~', "-");
        for piece in wrapped(text.trim(), REMARK_LENGTH) {
            self.block.line(format!("; {piece}").trim_end(), out);
        }
    }

    /// Lines of the user's own, a block each; one after a tilde goes on with its block and has no number.
    pub(crate) fn own(&mut self, lines: &str, out: &mut String) {
        for line in lines.lines().filter(|line| !line.is_empty()) {
            if self.goes_on {
                out.push_str(line);
                out.push('\n');
            } else {
                self.block.line(line, out);
            }
            self.goes_on = line.trim_end().ends_with('~');
        }
    }

    pub(crate) fn end(&mut self, out: &mut String) {
        self.stop(out);
        self.own(&self.ending.clone(), out);
        self.frame("END", out);
    }

    /// Forgets what is in force: after a line of the user's own nothing is known of it.
    pub(crate) fn forget(&mut self) {
        self.speed.forget();
        self.feed.forget();
        self.radius.forget();
        self.axes.forget();
        self.tcp_active.forget();
        self.vector = None;
        self.defined.clear();
        // What turns and flows was asked for all the same: a stop after it switches that off.
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

/// The corners of the stock, where the tool goes stands for it; empty if it is not known or not asked for.
pub(crate) fn stock(setup: &Setup<'_>) -> String {
    let extents = setup.ahead.and_then(|ahead| ahead.extents);
    let Some(corners) = extents.filter(|_| setup.flag("blk_form")) else {
        return String::new();
    };
    let scale = match setup.units {
        Units::Millimetre => 1.0,
        Units::Inch => 1.0 / 25.4,
    };
    let mut text = String::new();
    for (words, corner) in ["BLK FORM 0.1 Z", "BLK FORM 0.2"].into_iter().zip(corners) {
        text.push_str(words);
        for (axis, length) in ["X", "Y", "Z"].into_iter().zip(corner) {
            text.push_str(&format!(" {axis}"));
            let style = NumberStyle { plus: true, ..NumberStyle::default() };
            style.write(&mut text, length * scale, 3);
        }
        text.push('\n');
    }
    text
}
