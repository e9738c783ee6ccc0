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

/// Names of pairs in `[clearance]` that nothing has: as a warning those of bodies that are taken away.
pub(super) fn unknown(machine: &Machine) -> Vec<Diagnostic> {
    let known = |name: &str| {
        let of_tool = name.strip_prefix("holder T").or_else(|| name.strip_prefix("cutter T"));
        GENERAL.contains(&name)
            || of_tool.is_some_and(|number| number.parse::<u32>().is_ok())
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
            let message = format!("[clearance] names {name}, and nothing is called so");
            let axes = machine.axes.iter().map(|axis| axis.name.as_str());
            let own = machine.fixtures.iter().chain(machine.stocks.iter());
            let own = own.map(|body| body.name.as_str()).filter(|name| *name != "stock");
            let all: Vec<&str> = own.chain(GENERAL).chain(axes).collect();
            let help = format!("known are {}; holder T3 is that of tool 3", all.join(", "));
            let finding = Diagnostic::error("clearance-body", message).at(pair.place.clone());
            findings.push(finding.help(help));
        }
    }
    findings
}
