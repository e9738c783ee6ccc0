//! Whether holder, cutter, edge and length of a tool fit together, and whether they are there.

use post_machine::check::number as decimals;
use post_machine::description::{Machine, ToolOutline, TurnedProfile};
use post_machine::diagnostic::Diagnostic;

/// Ends that are no farther apart than this meet, mm.
const MEET: f64 = 1e-6;

/// What does not fit of the tools of a machine.
pub(super) fn of_tools(machine: &Machine) -> Vec<Diagnostic> {
    let outlines = machine.outlines.iter();
    outlines
        .flat_map(|outline| [lacking(machine, outline), unfit(machine, outline)].concat())
        .collect()
}

/// What of a tool is not there that the rest of it asks for.
fn lacking(machine: &Machine, outline: &ToolOutline) -> Vec<Diagnostic> {
    let number = outline.number;
    let drawn = !outline.cutter.is_empty();
    let listed = || machine.tool_table.as_ref()?.entry(number, number)?.total_length();
    let given = machine.tools.iter().any(|(known, _)| *known == number);
    let cut = super::cuts_stock(machine);
    let mut findings = Vec::new();
    let mut tell = |message: String, help: &str| {
        findings.push(Diagnostic::warning("clearance-body", message).help(help));
    };
    if !given && listed().is_none() {
        tell(
            format!(
                "how long tool {number} is the machine file does not say: a proof of a program that calls it is refused, unless the program or its offsets say it"
            ),
            "length = … under [tools.N]; else --offsets or --tool-length with each program",
        );
    }
    if outline.edge.is_some() && !drawn {
        tell(
            format!(
                "edge of tool {number} has no effect: its cutter is not drawn, and what it cuts is taken from no stock: a proof that leads into that is refused"
            ),
            "cutter = [[z, r], …] under [tools.N] draws it",
        );
    }
    if cut && outline.edge.is_none() && drawn {
        tell(
            format!(
                "all of the cutter of tool {number} cuts, up to its last point: no shank is held against the stock"
            ),
            "edge = … under [tools.N]: mm above the tip up to which it cuts",
        );
    }
    findings
}

/// What of a tool does not fit together.
fn unfit(machine: &Machine, outline: &ToolOutline) -> Vec<Diagnostic> {
    let ToolOutline { number, holder, cutter, edge } = outline;
    let top = |profile: &TurnedProfile| profile.points.iter().map(|[z, _]| *z).reduce(f64::max);
    let length = machine.tools.iter().find(|(known, _)| known == number).map(|(_, length)| *length);
    let (holder, cutter) = (top(holder), top(cutter));
    let mm = |value: f64| format!("{} mm", decimals(value, 3));
    let mut findings = Vec::new();
    let mut tell = |message: String, help: &str| {
        findings.push(Diagnostic::warning("clearance-body", message).help(help));
    };
    if let (Some(holder), Some(length)) = (holder, length)
        && holder > length - MEET
    {
        let (reach, long) = (mm(holder), mm(length));
        tell(
            format!(
                "the holder of tool {number} goes {reach} down, and the tool is {long} long: it ends at its tip or beyond"
            ),
            "z of a holder counts from the gauge point towards the tip, length from the gauge point to the tip",
        );
    }
    if let (Some(edge), Some(cutter)) = (edge, cutter)
        && *edge > cutter + MEET
    {
        let (edge, cutter) = (mm(*edge), mm(cutter));
        tell(
            format!(
                "edge of tool {number} is {edge} above its tip, and its cutter ends at {cutter}: nothing of it is shank"
            ),
            "z of the cutter and edge count from the tip; the shank belongs to the cutter's points",
        );
    }
    if let (Some(holder), Some(cutter), Some(length)) = (holder, cutter, length)
        && length - holder - cutter > MEET
    {
        let gap = mm(length - holder - cutter);
        tell(
            format!(
                "between cutter and holder of tool {number} nothing is drawn on {gap}: nothing is proven of what is there"
            ),
            "points of the cutter up to where the holder begins: length less the holder's last z",
        );
    }
    findings
}
