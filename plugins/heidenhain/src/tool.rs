//! Tool calls and the spindle, whose speed belongs to them.

use post_plugin::{Event, NumberStyle, Spindle, SpindleSense, ascii};

use crate::{Heidenhain, PendingEvent, ToolCall};

impl Heidenhain {
    /// The tool call that waits, with its speed if one is known, and what waited for it.
    pub(crate) fn call_tool(&mut self, speed: Option<f64>, out: &mut String) -> Result<(), String> {
        let Some(tool) = self.tool.take() else {
            return Ok(());
        };
        match tool {
            ToolCall::Tool(tool) => {
                self.block.word("TOOL CALL").word(&tool);
                // A control that keeps the tip has its own drawing of where the tool lies.
                self.block.word(match self.tcp {
                    true => "Z",
                    false => self.axes.depth(),
                });
                if let Some(speed) = speed {
                    self.block.number("S", speed, 0, NumberStyle::default());
                }
                self.block.end(out);
            }
            ToolCall::Own(lines) => {
                let lines = match speed {
                    Some(speed) => with_speed(&lines, speed)?,
                    None => lines,
                };
                self.own(&lines, out);
            }
        }
        (self.called, self.stays) = (true, false);
        self.speed.forget();
        self.spindle_on.forget();
        self.sense = None;
        self.rpm = None;
        self.axes.forget();
        for held in std::mem::take(&mut self.held) {
            match held {
                PendingEvent::Preselect(number) => self.preselect(number, out)?,
                PendingEvent::Coolant(coolant) => self.cool(coolant, out)?,
                PendingEvent::Word(text) => self.own(&text, out),
            }
        }
        Ok(())
    }

    pub(crate) fn preselect(&mut self, number: u32, out: &mut String) -> Result<(), String> {
        let known = self.names.iter().find(|(known, _)| *known == number);
        let name = known.map_or("", |(_, name)| name);
        let tool = tool_call(number, name, self.tool_names)?;
        self.block.line(&format!("TOOL DEF {tool}"), out);
        Ok(())
    }

    pub(crate) fn turn(&mut self, spindle: Spindle, out: &mut String) -> Result<(), String> {
        let (rpm, sense) = match spindle {
            Spindle::On { rpm, sense } => (rpm, sense),
            Spindle::Off => {
                self.block.line("M5", out);
                self.spindle_on.set(false);
                self.sense = None;
                self.rpm = None;
                return Ok(());
            }
            Spindle::Orient => {
                return Err("the oriented stop is a cycle of the machine builder's".to_owned());
            }
        };
        if self.tool.is_some() {
            self.call_tool(Some(rpm), out)?;
            self.speed.set(rpm);
        } else if self.speed.set(rpm) {
            // A tool call, even one for the speed alone, is not allowed under TCP.
            let tcp = self.tcp && !self.tcp_active.is(false);
            if tcp {
                self.own(&self.tcp_off.clone(), out);
            }
            self.block.word("TOOL CALL");
            self.block.number("S", rpm, 0, NumberStyle::default()).end(out);
            // Some tool is in the spindle.
            (self.called, self.stays) = (true, false);
            if tcp {
                self.own(&self.tcp_on.clone(), out);
            }
        }
        self.block.line(turns(sense), out);
        self.spindle_on.set(true);
        self.sense = Some(sense);
        self.rpm = Some(rpm);
        Ok(())
    }

    /// A stop switches spindle and coolant off.
    pub(crate) fn halt(&mut self, word: &str, out: &mut String) {
        self.block.line(word, out);
        self.standstill.stop(true, true);
    }

    /// Ahead of `event`: what a stop has switched off, if the tool needs it now.
    pub(crate) fn resume(&mut self, event: &Event<'_>, out: &mut String) {
        let [spindle, coolant] = self.standstill.before(event);
        if let (true, Some(sense)) = (spindle, self.sense) {
            self.block.line(turns(sense), out);
        }
        if let (true, Some(flowing)) = (coolant, self.flowing) {
            self.coolant_codes(flowing, out);
        }
    }

    /// Spindle and coolant off, unless they are.
    pub(crate) fn stop(&mut self, out: &mut String) {
        if self.spindle_on.set(false) {
            self.block.line("M5", out);
        }
        if !self.coolant_on.is(false) {
            self.end_coolant(out);
        }
    }
}

/// Own lines whose `TOOL CALL` has the speed: after the tool and its axis, before feed and oversizes (`S3000 DL+0.1`).
/// A call of the speed alone after it might take the oversizes back.
///
/// # Errors
/// If it has another speed.
fn with_speed(lines: &str, speed: f64) -> Result<String, String> {
    let mut wanted = String::new();
    NumberStyle::default().write(&mut wanted, speed, 0);
    let calls = |line: &&str| line.split_whitespace().take(2).eq(["TOOL", "CALL"]);
    let Some(call) = lines.lines().find(calls) else {
        // They call a program that does.
        return Ok(format!("{lines}\nTOOL CALL S{wanted}"));
    };
    let mut words: Vec<String> = call.split_whitespace().map(str::to_owned).collect();
    let begins = |word: &String, address: &str| {
        let rest = word.strip_prefix(address);
        rest.is_some_and(|rest| {
            rest.starts_with(|c: char| c.is_ascii_digit() || "+-.Q".contains(c))
        })
    };
    match words.iter().skip(3).find(|word| begins(word, "S")) {
        Some(own) if own[1..] == wanted => return Ok(lines.to_owned()),
        Some(own) => {
            return Err(format!(
                "the lines in the place of a tool change call the tool with {own}, and the CL file asks for S{wanted}: leave \
                 the S out, it is put there"
            ));
        }
        None => {}
    }
    let oversize = |word: &String| ["F", "DL", "DR"].iter().any(|address| begins(word, address));
    let place = words.iter().skip(3).position(oversize);
    let remark = words.iter().position(|word| word.starts_with(';'));
    let ends = remark.unwrap_or(words.len());
    let place = place.map_or(ends, |place| (place + 3).min(ends));
    words.insert(place, format!("S{wanted}"));
    Ok(lines.replacen(call, &words.join(" "), 1))
}

pub(crate) fn turns(sense: SpindleSense) -> &'static str {
    match sense {
        SpindleSense::Clockwise => "M3",
        SpindleSense::CounterClockwise => "M4",
    }
}

/// A tool as a call has it: its number, or with `names` its name, if it has one.
///
/// # Errors
/// If the control has no such names.
pub(crate) fn tool_call(number: u32, name: &str, names: bool) -> Result<String, String> {
    if !names || name.is_empty() {
        return Ok(number.to_string());
    }
    // Names of the control have no blanks and few signs.
    let allowed = |letter: char| match letter {
        letter if letter.is_ascii_alphanumeric() || "#$%&.,-_".contains(letter) => letter,
        _ => '_',
    };
    let plain: String = ascii(name).to_ascii_uppercase().chars().map(allowed).collect();
    if plain.len() > 32 {
        return Err(format!(
            "the tool's name `{name}` is longer than the 32 characters that this control has: shorten it, or leave out \
             tool_names"
        ));
    }
    Ok(format!("\"{plain}\""))
}
