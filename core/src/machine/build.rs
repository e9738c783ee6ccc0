//! From what a machine file says to what it means, with every refusal.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::Vector3;
use post_grammar::{LinkKind, parse_chain, parse_expression};
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::file::{AxisFile, MachineFile, Number, Quantity, Tcp};
use super::layers::{Source, Sources};
use super::{Accuracy, Axis, Control, GivenOption, Machine, OptionValue};
use crate::diagnostic::Diagnostic;
use crate::kinematics::{Joint, MAX_AXES, NoClosedForm};

/// Loads a machine: `source`, what it extends (found by `find`), and `settings` (`key=value`, the last wins).
///
/// # Errors
/// Everything that is wrong with it, each with its place and a remedy.
pub fn load(
    source: Source,
    settings: &[String],
    find: &mut dyn FnMut(&str) -> Result<Source, String>,
) -> Result<Machine, Vec<Diagnostic>> {
    let sources = Sources::collect(source, settings, find)?;
    let mut table = sources.merge()?;
    let mut faults = Vec::new();
    let control_options = take_options(&mut table, "control", &sources, &mut faults);
    let model_options = take_options(&mut table, "accuracy", &sources, &mut faults);
    let file = match MachineFile::deserialize(Deserializer::from(table)) {
        Ok(file) => file,
        Err(error) => {
            let place = error.span().and_then(|span| sources.place(span));
            faults.push(Diagnostic::error("machine-key", error.message()).at(place));
            return Err(faults);
        }
    };
    let mut builder = Builder {
        sources: &sources,
        parameters: &file.parameters,
        faults,
    };
    let machine = builder.machine(&file, control_options, model_options);
    match machine {
        Some(machine) if builder.faults.is_empty() => Ok(machine),
        _ => Err(builder.faults),
    }
}

/// Takes the sub-tables of `[section]` out: they belong to plugins, and only those know their keys.
fn take_options(
    table: &mut Spanned<DeTable<'_>>,
    section: &str,
    sources: &Sources,
    faults: &mut Vec<Diagnostic>,
) -> BTreeMap<String, Vec<GivenOption>> {
    let mut taken = BTreeMap::new();
    let Some(DeValue::Table(table)) = table.get_mut().get_mut(section).map(Spanned::get_mut) else {
        return taken;
    };
    let names: Vec<String> = table
        .iter()
        .filter(|(_, value)| value.get_ref().is_table())
        .map(|(key, _)| key.get_ref().to_string())
        .collect();
    for name in names {
        let Some(DeValue::Table(options)) = table.remove(name.as_str()).map(Spanned::into_inner)
        else {
            continue;
        };
        let mut given = Vec::new();
        for (key, value) in options {
            let place = sources.place(key.span());
            let text = value.get_ref().as_str().map(str::to_owned);
            let value = match value.get_ref() {
                DeValue::Boolean(flag) => Some(OptionValue::Flag(*flag)),
                DeValue::Integer(number) => {
                    i64::from_str_radix(&number.as_str().replace('_', ""), number.radix())
                        .ok()
                        .map(OptionValue::Integer)
                }
                DeValue::Float(number) => number
                    .as_str()
                    .replace('_', "")
                    .parse()
                    .ok()
                    .filter(|number: &f64| number.is_finite())
                    .map(OptionValue::Number),
                _ => text.map(OptionValue::Text),
            };
            match value {
                Some(value) => given.push(GivenOption {
                    key: key.into_inner().into_owned(),
                    value,
                    place,
                }),
                None => faults.push(
                    Diagnostic::error(
                        "machine-option",
                        format!(
                            "{} of [{section}.{name}] takes a flag, a number or a text",
                            key.get_ref()
                        ),
                    )
                    .at(place),
                ),
            }
        }
        taken.insert(name, given);
    }
    taken
}

struct Builder<'a> {
    sources: &'a Sources,
    parameters: &'a BTreeMap<String, Quantity>,
    faults: Vec<Diagnostic>,
}

impl Builder<'_> {
    fn fault(&mut self, code: &'static str, span: Range<usize>, message: String, help: &str) {
        let place = self.sources.place(span);
        let mut diagnostic = Diagnostic::error(code, message).at(place);
        if !help.is_empty() {
            diagnostic = diagnostic.help(help);
        }
        self.faults.push(diagnostic);
    }

    fn machine(
        &mut self,
        file: &MachineFile,
        mut control_options: BTreeMap<String, Vec<GivenOption>>,
        mut model_options: BTreeMap<String, Vec<GivenOption>>,
    ) -> Option<Machine> {
        // A parameter that nothing uses is checked too: it may be used tomorrow.
        for quantity in self.parameters.values() {
            self.number(quantity);
        }
        if !self.faults.is_empty() {
            // Whatever uses them would only repeat it.
            return None;
        }
        let axes = self.axes(file)?;
        let mount = match &file.workpiece.mount {
            Some(mount) => self.vector(mount),
            None => Vector3::zeros(),
        };
        let gauge = self.vector(&file.tool.gauge);
        let tool_axis = match &file.tool.axis {
            Some(axis) => self.direction("the tool axis", axis)?,
            None => Vector3::z(),
        };
        let tools = self.tools(file);
        let turns = axes.iter().any(|axis| axis.joint.rotary);
        let control = file.control.get_ref();
        if control.tcp.is_none() && turns {
            self.fault(
                "machine-tcp",
                file.control.span(),
                "[control] does not say who keeps the tip on its path while rotary axes turn"
                    .to_owned(),
                "tcp = \"control\" writes the tip and lets the control transform (G43.4, TRAORI, M128); tcp = \"post\" writes axis positions",
            );
        }
        let dialect = control.dialect.get_ref().clone();
        let options = control_options.remove(&dialect).unwrap_or_default();
        for (other, given) in control_options {
            // A machine may carry the options of several dialects; an empty name is a slip.
            if other.is_empty() || other.contains(char::is_whitespace) {
                let span = file.control.span();
                self.fault(
                    "machine-option",
                    span,
                    format!("[control.{other}] names no dialect ({} keys)", given.len()),
                    "",
                );
            }
        }
        if control.tcp == Some(Tcp::Control) {
            self.check_tip_words(&axes, file.chain.span());
        }
        let accuracy = &file.accuracy;
        let model = accuracy
            .model
            .as_ref()
            .map_or_else(|| "sampled".to_owned(), |model| model.get_ref().clone());
        if let Some(reduce) = &accuracy.reduce
            && *reduce.get_ref()
        {
            self.fault(
                "machine-reduce",
                reduce.span(),
                "reduce = true is not possible with placement = \"bisect\": every CL point is kept"
                    .to_owned(),
                "leave reduce out",
            );
        }
        let positive = |this: &mut Self, name: &str, quantity: &Option<Quantity>, default: f64| {
            let Some(quantity) = quantity else {
                return default;
            };
            let value = this.number(quantity);
            if value <= 0.0 {
                this.fault(
                    "machine-tolerance",
                    quantity.span(),
                    format!("{name} is {value}; it must be above zero"),
                    "",
                );
            }
            value
        };
        let tolerance = positive(self, "tolerance", &accuracy.tolerance, 0.005);
        let axis_tolerance = positive(self, "axis_tolerance", &accuracy.axis_tolerance, 0.05);
        let rapid_tolerance = positive(self, "rapid_tolerance", &accuracy.rapid_tolerance, 0.5);
        let machine = Machine {
            name: file.name.get_ref().clone(),
            axes,
            mount,
            gauge,
            tool_axis,
            tools,
            control: Control {
                dialect,
                dialect_place: self.sources.place(control.dialect.span()),
                options,
                tcp: if turns {
                    control.tcp.unwrap_or_default()
                } else {
                    Tcp::Post
                },
                units: control.units,
                feed: control.feed,
                feed_length: control.feed_length,
                tool_length: control.tool_length,
                insert: control.insert,
            },
            accuracy: Accuracy {
                options: model_options.remove(&model).unwrap_or_default(),
                model,
                model_place: accuracy
                    .model
                    .as_ref()
                    .and_then(|model| self.sources.place(model.span())),
                placement: accuracy.placement,
                tolerance,
                axis_tolerance: axis_tolerance.to_radians(),
                rapid_tolerance,
            },
        };
        self.check_chain(&machine, file.chain.span());
        Some(machine)
    }

    /// The axes in the order of the chain, each checked against its side of the bed.
    fn axes(&mut self, file: &MachineFile) -> Option<Vec<Axis>> {
        let chain_span = file.chain.span();
        let links = match parse_chain(file.chain.get_ref()) {
            Ok(links) => links,
            Err(fault) => {
                // One byte for the opening quote.
                let start = chain_span.start + 1;
                let span = start + fault.span.start..start + fault.span.end;
                self.fault(
                    "machine-chain",
                    span,
                    fault.message,
                    fault.help.as_deref().unwrap_or_default(),
                );
                return None;
            }
        };
        let mut axes = Vec::new();
        let mut named = BTreeSet::new();
        let mut carries_part = true;
        let mut sound = true;
        for link in links {
            let span = chain_span.start + 1 + link.span.start..chain_span.start + 1 + link.span.end;
            match link.kind {
                LinkKind::Workpiece | LinkKind::Tool | LinkKind::Spindle { .. } => {}
                LinkKind::Bed => carries_part = false,
                LinkKind::Axis { name, primed } => {
                    if primed != carries_part {
                        sound = false;
                        self.fault(
                            "machine-chain",
                            span.clone(),
                            if carries_part {
                                format!("{name} stands between the workpiece and the bed, so it carries the part: write {name}'")
                            } else {
                                format!("{name}' is primed, but it stands between the bed and the tool")
                            },
                            "a prime marks an axis that carries the workpiece (ISO 841); b is the bed",
                        );
                    }
                    if !named.insert(name.clone()) {
                        sound = false;
                        self.fault(
                            "machine-chain",
                            span,
                            format!("{name} stands twice in the chain"),
                            "",
                        );
                        continue;
                    }
                    match file.axis.get(&name) {
                        Some(axis) => match self.axis(&name, axis, carries_part) {
                            Some(axis) => axes.push(axis),
                            None => sound = false,
                        },
                        None => {
                            sound = false;
                            self.fault(
                                "machine-axis",
                                span,
                                format!("the chain has {name}, but there is no [axis.{name}]"),
                                "describe the axis, or take it out of the chain",
                            );
                        }
                    }
                }
            }
        }
        for (name, axis) in &file.axis {
            if !named.contains(name) {
                sound = false;
                self.fault(
                    "machine-axis",
                    axis.span(),
                    format!("[axis.{name}] does not stand in the chain"),
                    "put it where it belongs between w and t",
                );
            }
        }
        if axes.len() > MAX_AXES {
            sound = false;
            self.fault(
                "machine-chain",
                chain_span,
                format!("{} axes; at most {MAX_AXES} are possible", axes.len()),
                "",
            );
        }
        sound.then_some(axes)
    }

    fn axis(
        &mut self,
        name: &str,
        spanned: &Spanned<AxisFile>,
        carries_part: bool,
    ) -> Option<Axis> {
        let axis: &AxisFile = spanned.get_ref();
        let (rotary, direction) = match (&axis.linear, &axis.rotary) {
            (Some(direction), None) => (false, direction),
            (None, Some(direction)) => (true, direction),
            _ => {
                self.fault(
                    "machine-axis",
                    spanned.span(),
                    format!("{name} must be linear or rotary, one of the two"),
                    "linear = [1, 0, 0] slides along X, rotary = [0, 0, 1] turns about Z",
                );
                return None;
            }
        };
        let unit = if rotary { 1f64.to_radians() } else { 1.0 };
        let mut direction = self.direction(&format!("the direction of {name}"), direction)?;
        if axis.reversed {
            direction = -direction;
        }
        let point = match (&axis.point, rotary) {
            (Some(point), true) => self.vector(point),
            (None, true) => {
                self.fault(
                    "machine-axis",
                    spanned.span(),
                    format!("{name} turns, but the file does not say where its axis line runs"),
                    "point = [x, y, z], any point on the line, in the machine frame with all axes at zero",
                );
                return None;
            }
            (Some(point), false) => {
                self.fault(
                    "machine-axis",
                    point[0].span(),
                    format!("{name} slides: a point means nothing to it"),
                    "take the point out",
                );
                return None;
            }
            (None, false) => Vector3::zeros(),
        };
        if axis.cyclic && !rotary {
            self.fault(
                "machine-axis",
                spanned.span(),
                format!("{name} slides: it cannot be cyclic"),
                "give its travel",
            );
        }
        let travel = match (&axis.travel, axis.cyclic) {
            (Some(travel), false) => {
                let [least, most] = [&travel.get_ref()[0], &travel.get_ref()[1]]
                    .map(|quantity| self.number(quantity));
                if least >= most {
                    self.fault(
                        "machine-travel",
                        travel.span(),
                        format!("the travel of {name} goes from {least} to {most}: the first must be the smaller"),
                        "travel = [least, most]",
                    );
                }
                Some([least * unit, most * unit])
            }
            (None, true) => None,
            (Some(travel), true) => {
                self.fault(
                    "machine-travel",
                    travel.span(),
                    format!("{name} is cyclic (endless) and has travel: which of the two?"),
                    "keep one of them",
                );
                None
            }
            (None, false) => {
                self.fault(
                    "machine-travel",
                    spanned.span(),
                    format!("{name} has no travel"),
                    if rotary {
                        "travel = [-120, 30] in degrees, or cyclic = true if it turns without end"
                    } else {
                        "travel = [-300, 300] in mm, in positions of the axis"
                    },
                );
                None
            }
        };
        let rate = |this: &mut Self, key: &str, quantity: &Option<Quantity>| {
            let Some(quantity) = quantity else {
                return f64::INFINITY;
            };
            let value = this.number(quantity);
            if value <= 0.0 {
                this.fault(
                    "machine-axis",
                    quantity.span(),
                    format!("{key} of {name} is {value}; it must be above zero"),
                    "",
                );
            }
            value * unit
        };
        let max_feed = rate(self, "max_feed", &axis.max_feed);
        // Acceleration and jerk are checked now and used by the feed planner.
        rate(self, "max_accel", &axis.max_accel);
        rate(self, "max_jerk", &axis.max_jerk);
        let indexed = axis.indexed.as_ref().map(|quantity| {
            let value = self.number(quantity) * unit;
            if !rotary {
                self.fault(
                    "machine-axis",
                    quantity.span(),
                    format!("{name} slides: only a rotary axis is indexed"),
                    "",
                );
            }
            if let Some([least, most]) = travel
                && !(least..=most).contains(&value)
            {
                self.fault(
                    "machine-travel",
                    quantity.span(),
                    format!("{name} is indexed at {}, outside its travel", value / unit),
                    "",
                );
            }
            value
        });
        Some(Axis {
            name: name.to_owned(),
            carries_part,
            joint: Joint {
                rotary,
                direction,
                point,
            },
            travel,
            indexed,
            max_feed,
        })
    }

    /// Where the control keeps the tip, the linear words are its coordinates.
    fn check_tip_words(&mut self, axes: &[Axis], span: Range<usize>) {
        let linear: BTreeSet<&str> = axes
            .iter()
            .filter(|axis| !axis.joint.rotary)
            .map(|axis| axis.name.as_str())
            .collect();
        if linear != BTreeSet::from(["X", "Y", "Z"]) {
            self.fault(
                "machine-tcp",
                span,
                format!(
                    "with tcp = \"control\" the linear words are the tip's X, Y and Z, but the linear axes are called {}",
                    linear.into_iter().collect::<Vec<_>>().join(", ")
                ),
                "rename the axes, or use tcp = \"post\"",
            );
        }
    }

    fn tools(&mut self, file: &MachineFile) -> Vec<(u32, f64)> {
        let mut tools = Vec::new();
        for (number, length) in &file.tools {
            match number.parse() {
                Ok(number) => {
                    let value = self.number(length);
                    if value < 0.0 {
                        self.fault(
                            "machine-tools",
                            length.span(),
                            format!("tool {number} has the length {value}, below zero"),
                            "lengths go from the gauge point to the tip",
                        );
                    }
                    tools.push((number, value));
                }
                Err(_) => self.fault(
                    "machine-tools",
                    length.span(),
                    format!("[tools] has {number}, which is no tool number"),
                    "1 = 120.5 gives tool 1 the length 120.5 mm",
                ),
            }
        }
        tools
    }

    /// A chain that cannot be solved is refused when the machine is loaded, not at the first cut.
    fn check_chain(&mut self, machine: &Machine, span: Range<usize>) {
        let name = |joint: usize| machine.axes[joint].name.as_str();
        let Err(lack) = machine.solver(0.0) else {
            return;
        };
        let (message, help) = match lack {
            NoClosedForm::LinearAxes { count } => (
                format!("the chain has {count} linear axes; three are needed"),
                "a further linear axis (a quill) is not possible yet",
            ),
            NoClosedForm::FlatLinearAxes => (
                "the three linear axes lie in one plane: they span no volume".to_owned(),
                "check their directions",
            ),
            NoClosedForm::RotaryAxes { joints } => (
                format!(
                    "{} rotary axes move at once ({}); at most two can be free",
                    joints.len(),
                    joints
                        .iter()
                        .map(|joint| name(*joint))
                        .collect::<Vec<_>>()
                        .join(", ")
                ),
                "indexed = 0 holds an axis at an angle during cuts",
            ),
            NoClosedForm::Parallel {
                joints: [first, second],
            } => (
                format!(
                    "{} and {} turn about parallel axes: they cannot point the tool",
                    name(first),
                    name(second)
                ),
                "check their directions, or hold one with indexed = 0",
            ),
        };
        self.fault("machine-chain", span, message, help);
    }

    fn vector(&mut self, quantities: &[Quantity; 3]) -> Vector3<f64> {
        Vector3::from_fn(|row, _| self.number(&quantities[row]))
    }

    fn direction(&mut self, what: &str, quantities: &[Quantity; 3]) -> Option<Vector3<f64>> {
        let vector = self.vector(quantities);
        if vector.norm() > 1e-9 {
            return Some(vector.normalize());
        }
        let span = quantities[0].span().start..quantities[2].span().end;
        self.fault(
            "machine-direction",
            span,
            format!("{what} is null"),
            "a direction has any length but zero",
        );
        None
    }

    /// The value; 0 and a fault if it has none.
    fn number(&mut self, quantity: &Quantity) -> f64 {
        match self.evaluate(quantity.get_ref(), 0) {
            Ok(value) if value.is_finite() => value,
            Ok(value) => {
                self.fault(
                    "machine-number",
                    quantity.span(),
                    format!("{value} is no finite number"),
                    "",
                );
                0.0
            }
            Err(message) => {
                let known: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
                let help = format!("the parameters are: {}", known.join(", "));
                self.fault("machine-expression", quantity.span(), message, &help);
                0.0
            }
        }
    }

    /// Parameters may be expressions of other parameters; a circle runs into the depth limit.
    fn evaluate(&self, number: &Number, depth: usize) -> Result<f64, String> {
        let text = match number {
            Number::Value(value) => return Ok(*value),
            Number::Expression(text) => text,
        };
        if depth > self.parameters.len() {
            return Err(format!(
                "{text}: parameters that are defined by one another in a circle"
            ));
        }
        let expression =
            parse_expression(text).map_err(|fault| format!("{text}: {}", fault.message))?;
        let mut values = BTreeMap::new();
        for name in expression.names() {
            if let Some(quantity) = self.parameters.get(name) {
                values.insert(name, self.evaluate(quantity.get_ref(), depth + 1)?);
            }
        }
        expression
            .evaluate(&|name| values.get(name).copied())
            .map_err(|fault| format!("{text}: {}", fault.message))
    }
}
