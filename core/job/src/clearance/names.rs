//! What a machine file calls the bodies of a pair.

use post_clearance::proof::{Body, BodyKind};
use post_machine::description::{BodyPair, Machine};
use post_machine::diagnostic::Diagnostic;

use super::bodies::link_name;

/// Names that are those of no axis and of no fixture: where a body hangs, and what it is.
const GENERAL: [&str; 6] = ["w", "b", "t", "stock", "holder", "cutter"];

/// The names of a pair mean these two bodies.
pub(super) fn mean(machine: &Machine, pair: &BodyPair, [one, other]: [&Body; 2]) -> bool {
    let [first, last] = &pair.names;
    let called = |body: &Body, name: &str| is_called(machine, body, name);
    (called(one, first) && called(other, last)) || (called(one, last) && called(other, first))
}

/// A name is that of a body, of what it is, or of what it hangs on.
fn is_called(machine: &Machine, body: &Body, name: &str) -> bool {
    let kind = match body.kind {
        BodyKind::Holder => "holder",
        BodyKind::Cutter => "cutter",
        BodyKind::Stock => "stock",
        BodyKind::Machine | BodyKind::Fixture => "",
    };
    let end = match name {
        "w" => body.link == 0,
        "t" => body.link == machine.axes.len(),
        _ => false,
    };
    body.name == name || kind == name || end || link_name(machine, body.link) == name
}

/// A tool by whose number a pair names its holder or cutter.
fn of_tool(name: &str) -> Option<(&str, u32)> {
    let (what, number) = name.split_once(" T")?;
    let number = number.parse().ok()?;
    ["holder", "cutter"].contains(&what).then_some((what, number))
}

/// The machine file, or its file of tools, has a tool of this number.
fn describes(machine: &Machine, number: u32) -> bool {
    let listed = || machine.tool_table.as_ref().and_then(|table| table.entry(number, number));
    machine.outline(number).is_some()
        || machine.tools.iter().any(|(known, _)| *known == number)
        || listed().is_some()
}

/// Names of pairs in `[clearance]` that nothing has: as a warning those of bodies that are taken away. A cutter may be that of
/// a tool which the program's CL file alone has, `called` are these; without a program that is a warning too.
pub(super) fn unknown(machine: &Machine, called: Option<&[u32]>) -> Vec<Diagnostic> {
    let known = |name: &str| {
        GENERAL.contains(&name)
            || machine.axes.iter().any(|axis| axis.name == name)
            || machine.fixtures.iter().chain(&machine.stocks).any(|body| body.name == name)
    };
    let rules = &machine.clearance;
    let mut findings = Vec::new();
    for pair in rules.named() {
        if let Some(name) = &pair.taken_away {
            let message = format!(
                "{name} is taken away: what [clearance] says of the pair is without effect"
            );
            let help = "leave the pair out as well, if the body does not come back";
            let warning = Diagnostic::warning("clearance-body", message).at(pair.place.clone());
            findings.push(warning.help(help));
        }
        let names = pair.names.iter().filter(|name| pair.taken_away.as_ref() != Some(name));
        for name in names.filter(|name| !known(name)) {
            let finding = match of_tool(name) {
                Some((what, number)) => no_tool(machine, (what, number), called),
                None => Some(no_body(machine, name)),
            };
            findings.extend(finding.map(|finding| finding.at(pair.place.clone())));
        }
    }
    findings
}

/// Nothing is called so.
fn no_body(machine: &Machine, name: &str) -> Diagnostic {
    let message = format!("[clearance] names {name}, and nothing is called so");
    let axes = machine.axes.iter().map(|axis| axis.name.as_str());
    let own = machine.fixtures.iter().chain(machine.stocks.iter());
    let own = own.map(|body| body.name.as_str()).filter(|name| *name != "stock");
    let all: Vec<&str> = own.chain(GENERAL).chain(axes).collect();
    let help = format!("known are {}; holder T3 is that of tool 3", all.join(", "));
    Diagnostic::error("clearance-body", message).help(help)
}

/// What is wrong with the holder or the cutter of a tool that a pair names.
fn no_tool(
    machine: &Machine,
    (what, number): (&str, u32),
    called: Option<&[u32]>,
) -> Option<Diagnostic> {
    let drawn = machine.outline(number).is_some_and(|outline| !outline.holder.is_empty());
    let (message, help) = match what {
        "holder" if drawn => return None,
        "holder" => (
            format!("[clearance] names holder T{number}, and no holder of tool {number} is drawn"),
            format!("holder = [[z, r], …] under [tools.{number}], or leave the pair out"),
        ),
        _ if describes(machine, number) => return None,
        _ if called.is_some_and(|called| called.contains(&number)) => return None,
        _ => (
            format!("[clearance] names cutter T{number}, and nothing describes tool {number}"),
            format!(
                "[tools.{number}], the file of tools or the CL file has it; or leave the pair out"
            ),
        ),
    };
    let finding = match what == "cutter" && called.is_none() {
        true => Diagnostic::warning("clearance-body", message),
        false => Diagnostic::error("clearance-body", message),
    };
    Some(finding.help(help))
}
