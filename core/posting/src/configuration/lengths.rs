//! Whether the axis along which the control puts the length of a tool is the one along which the tool lies.

use nalgebra::Vector3;
use post_machine::axis_words;
use post_machine::description::{LengthAxis, Machine, Tcp};
use post_machine::diagnostic::{Diagnostic, Short};
use post_machine::kinematics::Joints;
use post_plugin::Capabilities;

/// What the control does with lengths, and what was reported of it.
#[derive(Debug)]
pub(super) struct LengthAxisCheck {
    writes: Capabilities,
    /// The head in use; empty for the one that the machine starts with.
    head: String,
    /// The work offset that the CL file has named.
    offset: Option<u32>,
    /// Work offsets that were measured with the tool in the spindle: head, offset, and the tool's length.
    measured: Vec<(String, Option<u32>, f64)>,
    /// Tools whose length in the control is 0, and those whose length it has.
    zero: Vec<u32>,
    whole: Vec<u32>,
    /// Heads of which it was reported that their tool lies along another axis.
    told: Vec<String>,
}

impl LengthAxisCheck {
    pub(super) fn new(writes: Capabilities) -> Self {
        Self {
            writes,
            head: String::new(),
            offset: None,
            measured: Vec::new(),
            zero: Vec::new(),
            whole: Vec::new(),
            told: Vec::new(),
        }
    }

    pub(super) fn swap_head(&mut self, name: &str) {
        name.clone_into(&mut self.head);
    }

    pub(super) fn work_offset(&mut self, number: u32) {
        self.offset = Some(number);
    }

    /// What is to be reported before tool `tool`, of `length` mm, is used, with the head of `machine`; `base` is the machine as
    /// the dialect knows it. Where the words are axis positions they count from where the tip of the tool stands on the
    /// part origin: the control must shift the same axis by the length as they do.
    pub(super) fn check(
        &mut self,
        base: &Machine,
        machine: &Machine,
        (tool, length): (Option<u32>, Option<f64>),
    ) -> Option<Diagnostic> {
        let moves = machine.axes.iter().any(|axis| !axis.joint.rotary);
        if !moves || length == Some(0.0) || self.writes.has(Capabilities::LENGTH_IN_OFFSET) {
            return None;
        }
        if machine.control.tcp == Tcp::Control {
            return self.check_kept(base, machine);
        }
        let depth = axis_words::depth(base);
        let compensated = match machine.length_axis {
            LengthAxis::None => {
                let length = length.unwrap_or(0.0);
                return self.once(tool, true).or_else(|| self.measure(machine, length));
            }
            LengthAxis::Said(place) => Some(place),
            LengthAxis::Dialect if self.writes.has(Capabilities::LENGTH_ALONG_DEPTH) => {
                depth.filter(|place| ["X", "Y", "Z"].contains(&machine.axes[*place].word()))
            }
            LengthAxis::Dialect => machine.axes.iter().position(|axis| axis.word() == "Z"),
        };
        let (along, miss) = machine.lies_along().unzip();
        // The word that puts it on stands with that of the depth; a quill beside it does as well.
        let deep = |place| axis_words::is_depth(base, place);
        // Where the tool comes from the place where it leaves its line all words stand in one block.
        let in_one = base.frame.leave.is_some() && along.is_some() && along == compensated;
        if in_one || along.is_some_and(deep) && compensated.is_some_and(deep) {
            let miss = miss.zip(length).map_or(0.0, |(miss, length)| miss * length);
            let finding = self.once(tool, false);
            return finding.or_else(|| missed(machine, miss));
        }
        if self.told.contains(&self.head) {
            return None;
        }
        self.told.push(self.head.clone());
        let name = |place: usize| machine.axes[place].name.as_str();
        let whose = match self.head.as_str() {
            "" => format!("the tool of {}", machine.name),
            head => format!("the tool of head {head}"),
        };
        let lies = match along {
            Some(place) => format!("along {}", name(place)),
            None => leaning(machine),
        };
        let puts = match (compensated, along) {
            (Some(place), Some(lies)) if place == lies => format!(
                "the control puts its length along {}, in a block of {}, which comes near last",
                name(place),
                depth.map_or("", |depth| base.axes[depth].name.as_str())
            ),
            (Some(place), _) => format!("the control puts its length along {}", name(place)),
            (None, _) => "the control puts its length along none of the axes".to_owned(),
        };
        let help = match along {
            Some(place) if along == depth => format!(
                "[tool] length_axis = \"{}\" if this control puts it there (by a parameter, or by the tool's table); \
                 \"none\" if its length of the tool is 0 and the work offset is measured with the tool in the spindle",
                name(place)
            ),
            _ => "tcp = \"control\" (RTCP, TCPM); a drawing of the machine with its tool along the axis that is compensated; \
                  or [tool] length_axis = \"none\" if the control's length of the tool is 0 and the work offset is measured with the \
                  tool in the spindle"
                .to_owned(),
        };
        let message = format!(
            "{whose} lies {lies} where the rotary axes show 0, and {puts}: the tip would not be where the words lead it"
        );
        Some(Diagnostic::error("length-axis", message).help(help))
    }

    /// Where the control keeps the tip it knows how the machine's own tool lies; of another head the machine file must
    /// say that it does, and those whose plane or tool call names the axis of the length name Z there.
    fn check_kept(&mut self, base: &Machine, machine: &Machine) -> Option<Diagnostic> {
        if self.told.contains(&self.head) {
            return None;
        }
        let whose = match self.head.as_str() {
            "" => format!("the tool of {}", machine.name),
            head => format!("the tool of head {head}"),
        };
        let named = self.writes.has(Capabilities::LENGTH_ALONG_DEPTH);
        let (message, help) = match machine.length_axis {
            LengthAxis::Said(_) => return None,
            _ if named && lies_down(machine) => (
                format!(
                    "{whose} lies across Z where the rotary axes show 0, and this control's words put its length along Z (G17, TOOL CALL Z)"
                ),
                "tcp = \"post\"; or [tool] length_axis naming the axis along which the data of the control put it all the same (Siemens: SD 42940)",
            ),
            _ if turned(base, machine) => (
                format!(
                    "{whose} lies otherwise than that of {}, and nothing says that the control keeps the tip of this head",
                    base.name
                ),
                "[head.….tool] length_axis naming the axis along which the control takes it to lie, if the head's own word switches it there; else tcp = \"post\"",
            ),
            _ => return None,
        };
        self.told.push(self.head.clone());
        Some(Diagnostic::error("length-axis", message).help(help))
    }

    /// The control has one length for a tool: with one head it cannot be 0 and with another its own.
    fn once(&mut self, tool: Option<u32>, zero: bool) -> Option<Diagnostic> {
        let tool = tool?;
        let (own, other) = match zero {
            true => (&mut self.zero, &self.whole),
            false => (&mut self.whole, &self.zero),
        };
        if !own.contains(&tool) {
            own.push(tool);
        }
        other.contains(&tool).then(|| {
            let message = format!(
                "the control must have 0 as the length of tool {tool} with one head ([tool] length_axis = \"none\"), and its own with another"
            );
            Diagnostic::error("length-axis", message)
                .help("a tool number for each: LOADTL behind HEAD")
        })
    }

    /// The control puts no length on: one work offset holds for one length.
    fn measure(&mut self, machine: &Machine, length: f64) -> Option<Diagnostic> {
        let known = self.measured.iter().find(|(head, offset, _)| {
            (head.as_str(), *offset) == (self.head.as_str(), self.offset)
        });
        let Some((_, _, first)) = known else {
            self.measured.push((self.head.clone(), self.offset, length));
            let message = format!(
                "the control must have 0 as the length of this tool, and the work offset must be measured with it in the spindle: the words count with {} mm of it",
                Short(length)
            );
            let help = "so [tool] length_axis = \"none\" has it";
            return Some(Diagnostic::warning("length-axis", message).help(help));
        };
        let other = libm::fabs(first - length) > 1e-9;
        other.then(|| {
            let message = format!(
                "a tool of {} mm, and one of {} mm before in the same work offset: {} has it measured with the tool in the spindle ([tool] length_axis = \"none\")",
                Short(length),
                Short(*first),
                machine.name
            );
            Diagnostic::error("length-axis", message)
                .help("a work offset for each tool (SET/OFSETL), or a program for each")
        })
    }
}

/// The tool lies across Z, or points the other way, where the rotary axes show zero.
fn lies_down(machine: &Machine) -> bool {
    let z = machine.axes.iter().position(|axis| axis.word() == "Z");
    let stands = |z| {
        let (zero, axis) = lies(machine)?;
        let up = machine.solver(0.0).ok()?.chain().way_of(z, &zero);
        Some(axis.dot(&up) > UPRIGHT)
    };
    z.and_then(stands) == Some(false)
}

/// The tool of one lies otherwise than that of the other where the rotary axes show zero.
fn turned(base: &Machine, machine: &Machine) -> bool {
    match (lies(base), lies(machine)) {
        (Some((_, own)), Some((_, other))) => (own - other).norm() > TURNED,
        _ => (base.tool_axis - machine.tool_axis).norm() > TURNED,
    }
}

/// The axes where the rotary ones show zero, and how the tool lies then, as the part sees it.
fn lies(machine: &Machine) -> Option<(Joints, Vector3<f64>)> {
    let zero = machine.zero_of(0.0)?;
    let axis = machine.solver(0.0).ok()?.chain().forward(&zero).axis;
    Some((zero, axis))
}

/// A tool whose direction has less of Z than this lies down.
const UPRIGHT: f64 = 0.5;

/// Tools that lie otherwise by less were measured, and are not another way round: 1 degree.
const TURNED: f64 = 0.0175;

/// A tool that leans by as little as is measured.
fn missed(machine: &Machine, miss: f64) -> Option<Diagnostic> {
    (miss > machine.accuracy.tolerance).then(|| {
        let message = format!(
            "the tool of {} leans a little from the axis along which the control puts its length: work offsets that were measured with another tool miss the tip by {miss:.3} mm",
            machine.name
        );
        Diagnostic::warning("length-axis", message)
            .help("measure the work offset with this tool, or let the control keep the tip (RTCP, TCP, TCPM): tcp = \"control\"")
    })
}

/// The direction of a tool that lies along no axis.
fn leaning(machine: &Machine) -> String {
    let shown = |axis: Vector3<f64>| {
        let [x, y, z] = [axis.x, axis.y, axis.z].map(|part| libm::rint(part * 1e4) / 1e4 + 0.0);
        format!("({x}, {y}, {z})")
    };
    let mut axis = machine.tool_axis;
    if let Some(solver) = machine.zero_of(0.0).zip(machine.solver(0.0).ok()) {
        axis = solver.1.chain().forward(&solver.0).axis;
    }
    format!("along {} as the part sees it", shown(axis))
}
