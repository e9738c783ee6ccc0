//! What the control makes of words of the program, where the machine file says so.

use post_grammar::SyncMark;

use crate::description::Machine;

/// A sentence for each word whose sign is a way, and which slides have the words of the tip and other names, and how the
/// channel waits for others.
pub(super) fn told(machine: &Machine) -> Vec<String> {
    let signed = machine.axes.iter().filter(|axis| axis.signed);
    let mut all: Vec<String> = signed
        .map(|axis| {
            let name = &axis.name;
            format!("{name}-90 turns to 90° counting down, {name}90 counting up, {name}-360 to 0° counting down")
        })
        .collect();
    let renamed = machine.axes.iter().filter_map(|axis| {
        let word = axis.tip_word?;
        Some(format!(
            "{word} is the word of the slide {} and, while the control keeps it, of the tip",
            axis.name
        ))
    });
    all.extend(renamed);
    let Some(wait) = &machine.wait else {
        return all;
    };
    let line = |number: u32| {
        let mark = SyncMark { number, channels: Vec::new() };
        wait.line(&mark).map(|line| format!("SYNC/{number} is {}", line.text))
    };
    match wait.ends().map(line) {
        [Ok(first), Ok(last)] => all.push(format!("{first}, {last}")),
        [Err(lack), _] | [_, Err(lack)] => all.push(format!("SYNC: {}", lack.message)),
    }
    let shared = wait.shared.iter().map(|joint| machine.axes[*joint].name.as_str());
    let shared: Vec<&str> = shared.chain(wait.shares_spindle.then_some("the spindle")).collect();
    if !shared.is_empty() {
        all.push(format!("other channels have {} as well", shared.join(", ")));
    }
    all
}
