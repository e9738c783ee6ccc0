//! What is said of a line of a program.

use post_machine::diagnostic::Short;
use post_readback::{MachineState, MotionKind, SpindleState};

use super::InterpretedProgram;
use super::map::ProgramMap;
use super::program::ProgramLine;
use crate::document::Snapshot;
use crate::readings;
use post_job::text::at_most;

/// What is said of a line, counted from 0, and of the word at `column`, bytes of the line; in Markdown.
pub fn text(
    of: &Snapshot,
    line: usize,
    column: usize,
    program: Option<&InterpretedProgram>,
    map: Option<&ProgramMap>,
    machine: Option<&str>,
) -> Option<String> {
    let span = of.lines.span(&of.text, line);
    let written = &of.text[span];
    let number = line as u64 + 1;
    let mut said = Vec::new();
    match program {
        Some(program) => {
            said.extend(word(written, column, program));
            if let Some((run, itself)) = program.line(number) {
                said.push(held(program, run, itself));
            }
        }
        None => said.push(match machine {
            Some(machine) => format!("On {machine}: not read yet."),
            None => {
                "The setting `post.machine` names the machine that runs this program.".to_owned()
            }
        }),
    }
    if let Some(map) = map
        && let Some(row) = map.line(number)
    {
        said.push(match row.cl_line {
            Some(cl) => format!(
                "From line {cl} of {}; tip within {} mm, tool axis within {}°",
                map.cl
                    .as_ref()
                    .and_then(|path| path.file_name())
                    .map_or("the CL file".into(), |name| name.to_string_lossy()),
                at_most(row.tip_deviation_mm, 6),
                at_most(row.axis_deviation_deg, 5)
            ),
            None => "Nothing in the CL file asks for it.".to_owned(),
        });
    }
    (!said.is_empty()).then(|| said.join("\n\n"))
}

/// What the word at a column means to the control.
fn word(line: &str, column: usize, program: &InterpretedProgram) -> Option<String> {
    let end = |letter: char| !(letter.is_ascii_alphanumeric() || letter == '.' || letter == '_');
    let from = line[..column].char_indices().rfind(|(_, letter)| end(*letter));
    let from = from.map_or(0, |(at, letter)| at + letter.len_utf8());
    let to = line[column..].find(end).map_or(line.len(), |at| column + at);
    // Words stand against one another: `G1X2.`.
    let mut written = &line[from..to];
    let mut start = from;
    while let Some(next) = written
        .char_indices()
        .skip(1)
        .find(|(at, letter)| {
            letter.is_ascii_alphabetic() && written.as_bytes()[at - 1].is_ascii_digit()
        })
        .map(|(at, _)| at)
    {
        if column < start + next {
            written = &written[..next];
            break;
        }
        start += next;
        written = &written[next..];
    }
    let plain = |word: &str| -> String {
        // `G01` and `G1` are one word.
        let letters = word.trim_end_matches(|letter: char| letter.is_ascii_digit());
        let digits = &word[letters.len()..];
        match digits.parse::<u64>() {
            Ok(number) if letters.len() == 1 => format!("{}{number}", letters.to_uppercase()),
            _ => word.to_uppercase(),
        }
    };
    let wanted = plain(written);
    let letter = written.get(..1)?.to_uppercase();
    let find = |name: &str| {
        let mut words = program.words.iter();
        words.find(|word| word.word.as_ref() == name)
    };
    let found = find(&wanted).or_else(|| find(&letter))?;
    let meaning = found.meaning.name().to_ascii_lowercase().replace('_', " ");
    Some(format!("`{written}`: {meaning}"))
}

/// What holds at a line.
fn held(program: &InterpretedProgram, run: &ProgramLine, itself: bool) -> String {
    let machine = &program.machine;
    let shown = readings::text(machine, &run.joints);
    let mut text = format!("On {}: `{shown}`", machine.name);
    let how = match run.kind.filter(|_| itself) {
        Some(MotionKind::Rapid) => Some("rapid".to_owned()),
        Some(MotionKind::Feed) => {
            Some(format!("feed {} mm/min", Short(libm::round(run.feed * 10.0) / 10.0)))
        }
        Some(MotionKind::Thread) => Some("thread".to_owned()),
        None => None,
    };
    let mut modal: Vec<String> = how.into_iter().collect();
    modal.extend(run.state.as_deref().map(modes).unwrap_or_default());
    if itself {
        // A tool change tells the tool that the state has too.
        for told in &run.told {
            if !modal.contains(told) {
                modal.push(told.clone());
            }
        }
    }
    if !modal.is_empty() {
        text.push_str(&format!("\n\n{}", modal.join(" · ")));
    }
    text
}

/// What holds while the machine moves.
fn modes(state: &MachineState) -> Vec<String> {
    let mut modes = Vec::new();
    modes.extend(state.tool.map(|tool| format!("tool {tool}")));
    if state.length != 0.0 {
        modes.push(format!("length {} mm", Short(state.length)));
    }
    modes.extend(state.work_offset.clone());
    modes.push(match state.tcp {
        true => "the control keeps the tip".to_owned(),
        false => "axis positions".to_owned(),
    });
    if state.plane.is_some() {
        modes.push("tilted plane".to_owned());
    }
    match state.compensation {
        0 => {}
        side if side < 0 => modes.push("left of the contour".to_owned()),
        _ => modes.push("right of the contour".to_owned()),
    }
    modes.push(match state.spindle {
        SpindleState::Off => "spindle off".to_owned(),
        SpindleState::Clockwise(speed) => format!("spindle {} rpm clockwise", Short(speed)),
        SpindleState::CounterClockwise(speed) => {
            format!("spindle {} rpm counter-clockwise", Short(speed))
        }
        SpindleState::Oriented => "spindle oriented".to_owned(),
        SpindleState::Surface { speed, .. } => format!("cutting speed {} m/min", Short(speed)),
    });
    let coolants = state.coolants;
    for (flows, name) in
        [(coolants.flood, "flood"), (coolants.mist, "mist"), (coolants.other, "coolant")]
    {
        if flows {
            modes.push(name.to_owned());
        }
    }
    modes.extend(state.smoothing.map(|by| format!("smoothing {} mm", Short(by))));
    modes
}
