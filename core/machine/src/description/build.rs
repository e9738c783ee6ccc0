//! From what a machine file says to what it means, with every refusal.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::Vector3;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::echoes;
use super::file::{ControlFile, MachineFile, Moves, Orientation, Rapid, Tcp};
use super::keys::typed;
use super::layers::{MachineSources, Merged, Source, overlay};
use super::limits::{
    MOST_BODIES, MOST_ENTRIES, MOST_FAULTS, MOST_FORMULAS, MOST_GROUPS, MOST_HEADS, MOST_OFFSETS,
    MOST_PARAMETERS, MOST_TURNS,
};
use super::numbers::EvaluatedAt;
use super::options::take_options;
use super::quantity::KeyedNumber;
use super::setting::Setting;
use super::table::KeyedValue;
use super::{
    AccuracyRules, Arcs, Axis, ControlPoint, ControlRules, Frame, GivenOption, Head, Machine,
    Profile, ProgramRules, SmoothingRules, SpindleSpeeds, TIP_WORDS, UnusedOptions, WordRule,
    linear_words, tip_words,
};
use crate::diagnostic::{Diagnostic, Short, SourcePlace};

/// The value of an expression of a machine file.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated {
    /// The file that it stands in, as the user named it.
    pub file: String,
    /// Where, bytes of the file's text, its quotes with it.
    pub span: Range<usize>,
    /// Value in the file's units.
    pub value: f64,
}

/// What a machine file was read as.
#[derive(Clone, Debug)]
pub struct MachineReading {
    /// The machine; or everything that is wrong with its file, each with its place and a remedy.
    pub machine: Result<Machine, Vec<Diagnostic>>,
    /// The expressions that have a value, in the order read; one that several machines share (heads) stands there for each.
    pub values: Vec<Evaluated>,
}

/// Loads a machine: `source`, what it extends (found by `find`), and `settings`, the last of
/// which wins.
///
/// # Errors
/// Everything that is wrong with it, each with its place and a remedy.
pub fn load(
    source: Source,
    settings: &[Setting],
    find: &mut dyn FnMut(&str) -> Result<Source, String>,
) -> Result<Machine, Vec<Diagnostic>> {
    examine(source, settings, find).machine
}

/// Loads a machine as [`load`] does, and tells the values of its expressions too, those of a file with faults as well.
pub fn examine(
    source: Source,
    settings: &[Setting],
    find: &mut dyn FnMut(&str) -> Result<Source, String>,
) -> MachineReading {
    let mut evaluated = Vec::new();
    let sources = match MachineSources::collect(source, settings, find) {
        Ok(sources) => sources,
        Err(faults) => {
            return MachineReading { machine: Err(faults), values: Vec::new() };
        }
    };
    let machine = with_heads(&sources, &mut evaluated);
    let values = evaluated.into_iter();
    let values = values.filter_map(|(span, value)| {
        let (file, span) = sources.local(span)?;
        Some(Evaluated { file: file.to_owned(), span, value })
    });
    MachineReading { machine, values: values.collect() }
}

/// The machine with all its heads.
fn with_heads(
    sources: &MachineSources,
    evaluated: &mut Vec<EvaluatedAt>,
) -> Result<Machine, Vec<Diagnostic>> {
    let Merged { mut table, faults } = sources.merge()?;
    let heads = match take_heads(&mut table, sources) {
        Ok(heads) => heads,
        Err(found) => return Err([faults, found].concat()),
    };
    if heads.is_empty() {
        return read(table, sources, faults, evaluated);
    }
    let mut machine = read(table.clone(), sources, faults, evaluated)?;
    if machine.has_modes() {
        let place = heads.into_iter().next().and_then(|head| head.place);
        let message = "a machine with a mode of its control has no other heads".to_owned();
        let finding = Diagnostic::error("machine-head", message).at(place);
        return Err(vec![finding.help("a machine file for each head, or leave [mode] out")]);
    }
    for head in heads {
        let mut layered = table.clone();
        overlay(layered.get_mut(), head.overrides);
        let mut other = read(layered, sources, Vec::new(), evaluated)?;
        other.keep_frame_of(&machine);
        if !other.axes.iter().map(|axis| &axis.name).eq(machine.axes.iter().map(|axis| &axis.name))
        {
            return Err(vec![
                Diagnostic::error(
                    "machine-head",
                    format!("[head.{}] changes which axes there are, or their order", head.name),
                )
                .at(head.place)
                .help("a head says what differs: directions, points, gauge; an axis that it lacks is held with indexed = 0"),
            ]);
        }
        if other.turn != machine.turn {
            let message = format!(
                "[head.{}] turns the part: a head is swapped, and the part stays",
                head.name
            );
            return Err(vec![
                Diagnostic::error("machine-head", message)
                    .at(head.place)
                    .help("[workpiece] turn is that of the machine"),
            ]);
        }
        machine.heads.push(Head {
            name: head.name,
            word: head.word,
            offset: head.offset,
            machine: other,
        });
    }
    Ok(machine)
}

/// `[head.NAME]`: what differs with another head, and the word that swaps it in.
struct HeadLayer<'i> {
    name: String,
    place: Option<SourcePlace>,
    word: Option<String>,
    offset: Option<u32>,
    overrides: DeTable<'i>,
}

fn take_heads<'i>(
    table: &mut Spanned<DeTable<'i>>,
    sources: &MachineSources,
) -> Result<Vec<HeadLayer<'i>>, Vec<Diagnostic>> {
    let Some(heads) = table.get_mut().remove("head") else {
        return Ok(Vec::new());
    };
    let fault = |span: Range<usize>| {
        vec![
            Diagnostic::error(
                "machine-head",
                "a head is a table that says what differs".to_owned(),
            )
            .at(sources.place(span))
            .help("[head.2] with word = \"M62\" and [head.2.tool], [head.2.axis.B] …"),
        ]
    };
    let span = heads.span();
    let DeValue::Table(heads) = heads.into_inner() else {
        return Err(fault(span));
    };
    if heads.len() > MOST_HEADS {
        let message = format!("{} heads; at most {MOST_HEADS} are possible", heads.len());
        return Err(vec![Diagnostic::error("machine-head", message).at(sources.place(span))]);
    }
    let mut taken = Vec::new();
    for (name, head) in heads {
        let span = head.span();
        let DeValue::Table(mut overrides) = head.into_inner() else {
            return Err(fault(span));
        };
        let word = match overrides.remove("word") {
            None => None,
            Some(word) => match word.get_ref().as_str() {
                Some(text) => Some(text.to_owned()),
                None => return Err(fault(word.span())),
            },
        };
        let offset = match overrides.remove("offset") {
            None => None,
            Some(offset) => {
                let number = offset.get_ref().as_integer();
                match number.and_then(|number| number.as_str().parse().ok()) {
                    Some(number @ 1..=MOST_OFFSETS) => Some(number),
                    _ => return Err(vec![no_offset(sources.place(offset.span()))]),
                }
            }
        };
        let whole = |key: &str| matches!(key, "control" | "cl" | "program");
        if let Some((key, _)) = overrides.iter().find(|(key, _)| whole(key.get_ref())) {
            return Err(vec![
                Diagnostic::error("machine-head", format!("a head does not change [{}]", key.get_ref()))
                    .at(sources.place(key.span()))
                    .help("[control], [cl] and [program] hold for the whole program: units, dialect, who keeps the tip, words, text"),
            ]);
        }
        taken.push(HeadLayer {
            place: sources.place(name.span()),
            name: name.into_inner().into_owned(),
            word,
            offset,
            overrides,
        });
    }
    Ok(taken)
}

fn no_offset(place: Option<SourcePlace>) -> Diagnostic {
    let message =
        format!("the offset of a head is the number of a work offset, 1 to {MOST_OFFSETS}");
    Diagnostic::error("machine-head", message).at(place).help("1 is G54, 2 is G55, and so on")
}

/// What a merged table means. `unread` says what of the texts could not be read; what is said of the rest is said beside
/// it.
fn read(
    mut table: Spanned<DeTable<'_>>,
    sources: &MachineSources,
    unread: Vec<Diagnostic>,
    evaluated: &mut Vec<EvaluatedAt>,
) -> Result<Machine, Vec<Diagnostic>> {
    let mut hiding = unread.clone();
    let mut faults = unread;
    let control_options = take_options(&mut table, "control", sources, &mut faults);
    let model_options = take_options(&mut table, "accuracy", sources, &mut faults);
    let mut typed = typed(table, sources, hiding.is_empty());
    faults.append(&mut typed.faults);
    hiding.append(&mut typed.hiding);
    let Some(file) = typed.file else {
        return Err(faults);
    };
    let told = faults.len();
    let mut builder = Builder {
        sources,
        parameters: &file.parameters,
        values: BTreeMap::new(),
        without: BTreeSet::new(),
        evaluated: Vec::new(),
        faults,
    };
    let machine = builder.machine(&file, control_options, model_options);
    evaluated.append(&mut builder.evaluated);
    let mut faults = builder.faults;
    if !hiding.is_empty() {
        let found = faults.split_off(told);
        faults.extend(echoes::own(found, &hiding, sources));
    }
    match machine {
        Some(machine) if faults.is_empty() => Ok(machine),
        _ => Err(faults),
    }
}

pub(super) struct Builder<'a> {
    pub(super) sources: &'a MachineSources,
    pub(super) parameters: &'a BTreeMap<String, KeyedNumber>,
    /// The parameters that have a value.
    pub(super) values: BTreeMap<&'a str, f64>,
    /// The parameters that have none, which is said.
    pub(super) without: BTreeSet<&'a str>,
    /// The expressions that have a value.
    pub(super) evaluated: Vec<EvaluatedAt>,
    pub(super) faults: Vec<Diagnostic>,
}

/// What is told by tables that say nothing of axes.
struct AxisFreeRules {
    accuracy: AccuracyRules,
    control_point: ControlPoint,
    spindle: SpindleSpeeds,
    arcs: Arcs,
    word_rules: Vec<WordRule>,
    program: ProgramRules,
    smoothing: SmoothingRules,
}

/// What helps where the control shows a tip and the chain has none of its words.
const OF_WORDS: &str = "a chain of the words that the control has, X, Y, Z and the angles of the tool, with a [[drive]] for each joint behind them; or tcp = \"post\", which writes the values of the joints";

impl Builder<'_> {
    pub(super) fn fault(
        &mut self,
        code: &'static str,
        span: Range<usize>,
        message: String,
        help: &str,
    ) {
        if self.faults.len() >= MOST_FAULTS {
            return;
        }
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
        let before = self.faults.len();
        self.check_sizes(file);
        if self.faults.len() > before {
            return None;
        }
        self.evaluate_parameters();
        let Some(mut axes) = self.axes(file) else {
            self.without_axes(file, &mut model_options);
            return None;
        };
        self.seconds(file, &mut axes);
        self.servos(file, &mut axes);
        let formulas = self.formulas(&file.formulas, &axes);
        let mut limits = self.dependent_limits(&file.limit, &formulas, &axes);
        let word_map = self.word_map(&file.word, &axes, &mut limits);
        limits.extend(self.legs(file, &formulas, &axes));
        let along = self.along(file, &axes);
        let wait = self.wait(&file.wait, &axes);
        let mount = file.workpiece.mount.as_ref();
        let mount = mount.map_or_else(Vector3::zeros, |mount| self.vector(mount));
        let turn = self.checked(&file.workpiece.turn).unwrap_or(0.0).to_radians();
        let gauge = self.vector(&file.tool.gauge);
        // One that is null was told, and no machine comes of it.
        let tool_axis = file.tool.axis.as_ref();
        let tool_axis = tool_axis.and_then(|axis| self.direction("the tool axis", axis));
        let tool_axis = tool_axis.unwrap_or_else(Vector3::z);
        let edge = file.tool.edge.as_ref().and_then(|edge| self.edge(edge, tool_axis));
        let (errors, error_tables) = self.axis_errors(&file.error, &mut axes, gauge);
        let length_axis = self.length_axis(file.tool.length_axis.as_ref(), &axes);
        let solution = self.solution(file, &axes);
        let rewind = file.rewind.as_ref().and_then(|rewind| self.rewind(rewind));
        let tools = self.tool_lengths(&file.tools);
        let tool_table = self.tool_table(&file.tools.keys);
        if file.control.get_ref().tcp == Some(Tcp::Control) {
            tip_words::give(&mut axes);
        }
        let options = self.control_options(file, &axes, &mut control_options);
        let mut own = self.axis_free_rules(file, &mut model_options);
        if along.is_some() && file.accuracy.rapid_tolerance.is_none() {
            // A nozzle travels at the height of its beads.
            own.accuracy.rapid_tolerance = own.accuracy.tolerance;
        }
        let nose = self.nose(&file.cl, &file.tools, &axes, word_map.as_ref(), &own.spindle);
        let solids = self.solids(&file.solids, &axes);
        let fixtures = self.fixtures(&file.fixture, &axes);
        let stocks = self.stocks(file.stock.as_ref(), &axes);
        let outlines = self.tool_outlines(&file.tools);
        let clearance = self.clearance(&file.clearance, &file.fixture, file.stock.as_ref());
        let motion = self.motion(&file.motion);
        let plan = self.plan(&file.plan, &motion, own.accuracy.tolerance);
        let unused = |section: &'static str, tables: BTreeMap<String, Vec<GivenOption>>| {
            let tables = tables.into_iter();
            tables.map(move |(plugin, options)| UnusedOptions { section, plugin, options })
        };
        let control_options = unused("control", control_options);
        let unused_options = control_options.chain(unused("accuracy", model_options)).collect();
        let mut machine = Machine {
            clamps: axes.iter().any(|axis| axis.clamp.is_some()),
            indexes: axes.iter().any(|axis| axis.indexed.is_some()),
            name: file.name.get_ref().clone(),
            control: self.control(file.control.get_ref(), &axes, options, own.arcs),
            axes,
            errors,
            error_tables,
            limits,
            word_map,
            along,
            wait,
            mount,
            mount_said: file.workpiece.mount.is_some(),
            given_travel: Vec::new(),
            turn,
            gauge,
            tool_axis,
            length_axis,
            edge,
            control_point: own.control_point,
            tools,
            tool_table,
            nose,
            spindle: own.spindle,
            word_rules: own.word_rules,
            smoothing: own.smoothing,
            program: own.program,
            accuracy: own.accuracy,
            solution,
            rewind,
            motion,
            plan,
            profile: Profile::of(&file.profile),
            frame: Frame::default(),
            heads: Vec::new(),
            face: None,
            wrap: None,
            unused_options,
            solids,
            fixtures,
            stocks,
            outlines,
            clearance,
            lint_ignored: file.lint.ignore.iter().map(|code| code.get_ref().clone()).collect(),
        };
        self.frame(file.control.get_ref(), &mut machine);
        self.check_edge(file, &machine);
        // With a number that has none, or a direction that is none, its solver would search without end.
        if self.faults.is_empty() {
            self.check_chain(&machine, file.chain.span());
        }
        if self.faults.is_empty() {
            let modes = [self.face(&file.mode, &machine), self.wrap(&file.mode, &machine)];
            machine.heads.extend(modes.into_iter().flatten());
            self.check_errors(&machine, file.error.keys().next().map_or(0..0, Spanned::span));
        }
        Some(machine)
    }

    /// The options of the dialect, taken out of those of all; what is wrong with the control on these axes.
    fn control_options(
        &mut self,
        file: &MachineFile,
        axes: &[Axis],
        all: &mut BTreeMap<String, Vec<GivenOption>>,
    ) -> Vec<GivenOption> {
        let control = file.control.get_ref();
        if control.tcp.is_none() && axes.iter().any(|axis| axis.joint.rotary) {
            let message =
                "[control] does not say who keeps the tip on its path while rotary axes turn";
            let help = "tcp = \"control\" writes the tip and lets the control transform (RTCP, TCP, TCPM: G43.4, TRAORI, M128); tcp = \"post\" writes axis positions";
            self.fault("machine-tcp", file.control.span(), message.to_owned(), help);
        }
        let options = all.remove(control.dialect.get_ref()).unwrap_or_default();
        for (other, given) in all {
            // A machine may carry the options of several dialects; an empty name is a slip.
            if other.is_empty() || other.contains(char::is_whitespace) {
                let message = format!("[control.{other}] names no dialect ({} keys)", given.len());
                self.fault("machine-option", file.control.span(), message, "");
            }
        }
        if control.tcp == Some(Tcp::Control) {
            self.check_tip_words(axes, file.chain.span());
        }
        self.check_orientation(control, file.control.span());
        self.check_rapid(axes, file);
        self.check_turns(axes, file.chain.span());
        options
    }

    fn control(
        &self,
        file: &ControlFile,
        axes: &[Axis],
        options: Vec<GivenOption>,
        arcs: Arcs,
    ) -> ControlRules {
        let turns = axes.iter().any(|axis| axis.joint.rotary);
        ControlRules {
            dialect: file.dialect.get_ref().clone(),
            dialect_place: self.sources.place(file.dialect.span()),
            options,
            tcp: if turns { file.tcp.unwrap_or_default() } else { Tcp::Post },
            units: file.units,
            feed: file.feed,
            feed_length: file.feed_length,
            tcp_feed_length: file.tcp_feed_length,
            inverse_time: file.inverse_time,
            moves: match file.orientation.is_some_and(Orientation::is_whole) {
                true => Moves::Straight,
                false => file.moves,
            },
            orientation: file.orientation,
            rapid: file.rapid,
            tool_length: file.tool_length,
            cycles: file.cycles,
            planes: file.planes,
            insert: file.insert,
            print: file.print,
            compensation_on_centre: file.compensation_on_centre,
            arcs,
        }
    }

    fn check_edge(&mut self, file: &MachineFile, machine: &Machine) {
        if let (Some(edge), true) = (&file.tool.edge, machine.pointing().is_empty()) {
            let span = edge[0].span().start..edge[2].span().end;
            let message = "the tool has a leading edge, and no rotary axis turns it";
            let help = "leave the edge out, or give the machine the rotary axis that turns the tool about its own";
            self.fault("machine-edge", span, message.to_owned(), help);
        }
    }

    /// What is told by tables that say nothing of axes.
    fn axis_free_rules(
        &mut self,
        file: &MachineFile,
        model_options: &mut BTreeMap<String, Vec<GivenOption>>,
    ) -> AxisFreeRules {
        let accuracy = self.accuracy(&file.accuracy, model_options);
        let control_point = self.control_point(&file.tool.control_point);
        let spindle = self.spindle(&file.spindle);
        let arcs = self.arcs(&file.control.get_ref().arcs);
        let word_rules = self.word_rules(&file.cl, file.control.get_ref().units);
        let rotary = file.axis.get_ref().iter().filter(|(_, axis)| axis.get_ref().rotary.is_some());
        let rotary = rotary.map(|(name, _)| name.clone()).collect();
        let mut program = self.program(&file.program, rotary);
        let smoothing = file.program.smoothing.as_ref();
        let smoothing = smoothing.map(|file| self.smoothing(file)).unwrap_or_default();
        // Dialects tell of it among what is known ahead.
        program.looks_ahead |= file.stock.is_some();
        AxisFreeRules { accuracy, control_point, spindle, arcs, word_rules, program, smoothing }
    }

    /// What is wrong with the tables that say nothing of axes.
    fn without_axes(
        &mut self,
        file: &MachineFile,
        model_options: &mut BTreeMap<String, Vec<GivenOption>>,
    ) {
        for vector in [file.workpiece.mount.as_ref(), Some(&file.tool.gauge)] {
            vector.map(|vector| self.vector(vector));
        }
        self.checked(&file.workpiece.turn);
        if let Some(axis) = &file.tool.axis {
            self.direction("the tool axis", axis);
        }
        if let Some(rewind) = &file.rewind {
            self.rewind(rewind);
        }
        self.tool_lengths(&file.tools);
        self.tool_table(&file.tools.keys);
        let accuracy = self.axis_free_rules(file, model_options).accuracy;
        let motion = self.motion(&file.motion);
        self.plan(&file.plan, &motion, accuracy.tolerance);
    }

    /// Tables that are gone through entry by entry have an end.
    fn check_sizes(&mut self, file: &MachineFile) {
        let parameters = file.parameters.values().map(KeyedValue::span);
        self.check_size("[parameters]", parameters, MOST_PARAMETERS);
        let tools = file.tools.lengths.values().map(KeyedValue::span);
        self.check_size("[tools]", tools, MOST_ENTRIES);
        let tools = file.tools.outlines.iter().map(|(_, outline)| outline.span());
        self.check_size("[tools]", tools, MOST_ENTRIES);
        let formulas = file.formulas.keys().map(Spanned::span);
        self.check_size("[formulas]", formulas, MOST_FORMULAS);
        let fixtures = file.fixture.keys().map(Spanned::span);
        self.check_size("[fixture]", fixtures, MOST_BODIES);
        let words = file.cl.words.keys().map(Spanned::span);
        self.check_size("[cl.words]", words, MOST_ENTRIES);
        let groups = file.solution.exclusive.iter();
        let groups = groups.map(|group| group.first().map_or(0..0, Spanned::span));
        self.check_size("[solution] exclusive", groups, MOST_GROUPS);
    }

    /// A table with an entry at each of `spans`.
    pub(super) fn check_size(
        &mut self,
        what: &str,
        mut spans: impl ExactSizeIterator<Item = Range<usize>>,
        most: usize,
    ) {
        let count = spans.len();
        if count > most {
            let message = format!("{what} has {count} entries; at most {most} are possible");
            let first = spans.next().unwrap_or_default();
            self.fault("machine-size", first, message, "is this a machine file?");
        }
    }

    /// All full turns of the rotary axes are weighed, with one another.
    fn check_turns(&mut self, axes: &[Axis], span: Range<usize>) {
        let rotary = axes.iter().filter(|axis| axis.joint.rotary);
        let turns = rotary.filter_map(|axis| {
            let [least, most] = axis.travel?;
            Some(libm::ceil((most - least) / TAU).max(1.0))
        });
        let turns: f64 = turns.product();
        if turns > MOST_TURNS {
            let message = format!(
                "the travels of the rotary axes hold {} ways to set them on other full turns; {MOST_TURNS} are possible",
                Short(turns)
            );
            let help = "an axis that turns without end says cyclic = true; of the others less travel is rarely missed";
            self.fault("machine-travel", span, message, help);
        }
    }

    /// A vector is told where the control keeps the tip; values of axes are no pose.
    fn check_orientation(&mut self, control: &ControlFile, span: Range<usize>) {
        let (message, help) = match control.orientation {
            Some(Orientation::Vector) if control.tcp != Some(Tcp::Control) => (
                "[control] orientation = \"vector\" is told a control that keeps the tip",
                "tcp = \"control\"; or orientation = \"axes\"",
            ),
            Some(Orientation::Axes) if control.moves == Moves::Straight => (
                "[control] orientation = \"axes\" tells no pose, and moves = \"straight\" leads the tool to poses",
                "leave one of them out",
            ),
            _ => return,
        };
        self.fault("machine-tcp", span, message.to_owned(), help);
    }

    /// A rapid is written as a feed move at the feed of its slowest axis, so that each must have one.
    fn check_rapid(&mut self, axes: &[Axis], file: &MachineFile) {
        let endless = axes.iter().find(|axis| axis.max_feed.is_infinite());
        if let (Some(Rapid::Linear), Some(axis)) = (file.control.get_ref().rapid, endless) {
            let message = format!(
                "[control] rapid = \"linear\" writes rapids at the largest feed of the axes, and {} has no max_feed",
                axis.name
            );
            let help =
                "give every axis its max_feed, or leave rapids to the control: rapid = \"rapid\"";
            self.fault("machine-feed", file.control.span(), message, help);
        }
    }

    /// Where the control keeps the tip, the linear words are its coordinates.
    fn check_tip_words(&mut self, axes: &[Axis], span: Range<usize>) {
        let linear = linear_words(axes);
        // Beside the three another may stand, with a word of its own.
        let stands = |axis: &&Axis| !axis.joint.rotary && axis.indexed.is_some();
        let standing: BTreeSet<&str> = axes.iter().filter(stands).map(Axis::word).collect();
        let moving: BTreeSet<&str> = linear.difference(&standing).copied().collect();
        if moving != BTreeSet::from(TIP_WORDS) && linear != BTreeSet::from(TIP_WORDS) {
            let words = "with tcp = \"control\" the linear words are the tip's X, Y and Z";
            let few = linear.len() < TIP_WORDS.len();
            let names = linear.into_iter().collect::<Vec<_>>().join(", ");
            let (message, help) = match names.is_empty() {
                true => (format!("{words}, and all axes of this machine turn"), OF_WORDS),
                false if few => {
                    (format!("{words}, but the linear axes are called {names}"), OF_WORDS)
                }
                false => (
                    format!("{words}, but the linear axes are called {names}"),
                    "an axis beside X, Y and Z stands while the tool cuts: indexed = … says where, and it keeps its own word; or use tcp = \"post\"",
                ),
            };
            self.fault("machine-tcp", span.clone(), message, help);
        }
        let held = |axis: &&Axis| stands(axis) && TIP_WORDS.contains(&axis.word());
        if let Some(axis) = axes.iter().find(held) {
            let message = format!(
                "with tcp = \"control\" the control moves all linear axes, and {} stands between cuts (indexed)",
                axis.name
            );
            let help = "let the axis go, or use tcp = \"post\"";
            self.fault("machine-tcp", span, message, help);
        }
    }

    /// The leading edge, made square to the tool axis.
    fn edge(&mut self, edge: &[KeyedNumber; 3], tool_axis: Vector3<f64>) -> Option<Vector3<f64>> {
        let edge_along = self.direction("the leading edge", edge)?;
        let across = edge_along - tool_axis * tool_axis.dot(&edge_along);
        if across.norm() < 0.5 {
            let message = "the leading edge must stand across the tool axis".to_owned();
            let help = "it points where the tool moves: edge = [1, 0, 0] for an upright tool";
            self.fault(
                "machine-direction",
                edge[0].span().start..edge[2].span().end,
                message,
                help,
            );
        }
        across.try_normalize(1e-9)
    }

    /// A chain that cannot be solved is refused when the machine is loaded, not at the first cut.
    fn check_chain(&mut self, machine: &Machine, span: Range<usize>) {
        match machine.solver(0.0) {
            Err(lack) => {
                let (message, help) = lack.told(|joint| &machine.axes[joint].name);
                self.fault("machine-chain", span, message, help);
            }
            // What the control does between the words is bounded for such chains alone.
            Ok(solver)
                if machine.control.tcp == Tcp::Control
                    && machine.legs().any(|leg| leg.max_feed.is_finite())
                    && solver.linear_reach().is_infinite() =>
            {
                let message = "with tcp = \"control\" the feeds of legs can be held where three linear axes stand side by side in the chain, and nothing else slides";
                let help = "write the chain of the platform so, or leave max_feed of the legs out";
                self.fault("machine-leg", span, message.to_owned(), help);
            }
            Ok(_) => {}
        }
    }
}
