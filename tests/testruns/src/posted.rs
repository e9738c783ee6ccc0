//! Whole runs, from CL text to the events a dialect is asked to write, and the way back from their words.

use std::sync::Arc;

use nalgebra::Vector3;
use post_grammar::{ClReader, GotoRun, ReadError};
use post_machine::description::{Machine, Source, Tcp, load};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::{
    Batch, Capabilities, Curve, Cycle, Deviation, DialectSession, Event, Feed, Format,
    ModelSession, PlaneAngles, Tolerance, ToolPose, WriteFault,
};
use post_posting::preview::{FilePreview, PreviewPass, wants_planes};
use post_posting::program::DefaultSpindle;
use post_posting::report::PostingReport;
use post_posting::{Observer, Post, PostingRequest, TextSink};

use post_testmachines::{Reference, between};

/// What a dialect was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Line of the CL file.
    pub line: u64,
    /// Kind of the event.
    pub kind: &'static str,
    pub words: Vec<f64>,
    pub feed: Option<Feed>,
    /// Tip (mm) and tool axis of a motion, part frame.
    pub tool: Option<ToolPose>,
    /// Of an arc, what says how it goes.
    pub arc: Option<AskedArc>,
    /// Of a spline, its knots and control points.
    pub spline: Option<AskedSpline>,
    /// Any other number it has: the seconds of a dwell, the number of a tool.
    pub value: f64,
    /// An event without words as it prints for debugging, else empty.
    pub event: String,
    /// What a cycle says, if it is one.
    pub cycle: Option<AskedCycle>,
    /// What a tilted plane says, if it is one.
    pub plane: Option<AskedPlane>,
}

/// A cycle that a dialect was asked for: see [`Event::Cycle`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AskedCycle {
    pub kind: Cycle,
    pub feed: Feed,
    pub depth: f64,
    pub clearance: f64,
    pub retract: f64,
    pub step: Option<f64>,
    pub dwell: Option<f64>,
    pub pitch: Option<f64>,
}

/// A tilted plane that a dialect was asked for: see [`Event::Plane`].
#[derive(Clone, Debug, PartialEq)]
pub struct AskedPlane {
    pub origin: Vector3<f64>,
    pub x: Vector3<f64>,
    pub z: Vector3<f64>,
    pub angles: [f64; 3],
    /// All axis words: the rotary ones count.
    pub words: Vec<f64>,
}

/// How an arc goes that a dialect was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AskedArc {
    pub centre: [f64; 3],
    pub normal: [f64; 3],
    pub turn: f64,
    pub radius: Option<f64>,
}

/// The spline that a dialect was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedSpline {
    pub knots: Vec<f64>,
    pub points: Vec<f64>,
}

/// A dialect that writes nothing down but the events themselves. No word may be a negative zero, no number an
/// infinite one.
pub struct Recorder {
    format: Format,
    /// What it declares to write itself.
    pub capabilities: Capabilities,
    pub asked: Vec<Asked>,
}

impl Recorder {
    /// For a machine, its words printed with so many decimals.
    pub fn new(machine: &Machine, decimals: u8) -> Self {
        Self {
            format: Format {
                words: machine.axes.iter().map(|_| decimals).collect(),
                feed: 1,
                inverse_time: Some(4),
                feed_per_revolution: 4,
                extension: "nc".to_owned(),
                ..Format::default()
            },
            capabilities: Capabilities::NONE,
            asked: Vec::new(),
        }
    }
}

impl Recorder {
    /// Told tilted planes by these angles, with so many decimals.
    #[must_use]
    pub fn with_planes(mut self, angles: PlaneAngles, decimals: u8) -> Self {
        self.format.plane_angles = angles;
        self.format.plane_decimals = decimals;
        self.capabilities |= Capabilities::PLANE;
        self
    }
}

impl DialectSession for Recorder {
    fn capabilities(&self) -> Capabilities {
        // Its random machines have tools that lie along no axis.
        self.capabilities | Capabilities::LENGTH_IN_OFFSET
    }

    fn format(&self) -> &Format {
        &self.format
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        for (index, event) in batch.iter().enumerate() {
            let spline = match event {
                Event::Spline { knots, points, .. } => {
                    Some(AskedSpline { knots: knots.0.to_vec(), points: points.0.to_vec() })
                }
                _ => None,
            };
            let arc = match event {
                Event::Arc { centre, normal, turn, radius, .. } => {
                    Some(AskedArc { centre, normal, turn, radius })
                }
                _ => None,
            };
            let (words, tool, feed, value) = match event {
                Event::Position { words, tool, feed, .. } => (words, tool, feed, 0.0),
                Event::Rapid { words, tool } => (words, tool, None, 0.0),
                Event::Linear { words, tool, feed } => (words, tool, Some(feed), 0.0),
                Event::Arc { words, tool, feed, .. } => (words, tool, Some(feed), 0.0),
                Event::CyclePoint { words, tool } => (words, tool, None, 0.0),
                Event::Dwell { seconds } => (&[][..], None, None, seconds),
                Event::ToolChange { number, .. } => (&[][..], None, None, f64::from(number)),
                _ => (&[][..], None, None, 0.0),
            };
            for word in words {
                assert!(
                    word.is_finite() && (*word != 0.0 || word.is_sign_positive()),
                    "a word is {word}"
                );
            }
            if let Some(
                Feed::PerMinute(feed) | Feed::InverseTime(feed) | Feed::PerRevolution(feed),
            ) = feed
            {
                assert!(feed.is_finite() && feed > 0.0, "a feed is {feed}");
            }
            self.asked.push(Asked {
                line: batch.line(index),
                kind: event.name(),
                words: words.to_vec(),
                feed,
                tool,
                arc,
                spline,
                value,
                event: match words {
                    [] => format!("{event:?}"),
                    _ => String::new(),
                },
                cycle: cycle(&event),
                plane: plane(&event),
            });
            out.push_str("block\n");
            ends.push(out.len());
        }
        Ok(())
    }
}

fn cycle(event: &Event<'_>) -> Option<AskedCycle> {
    let Event::Cycle { cycle, feed, depth, clearance, retract, step, dwell, pitch } = *event else {
        return None;
    };
    Some(AskedCycle { kind: cycle, feed, depth, clearance, retract, step, dwell, pitch })
}

fn plane(event: &Event<'_>) -> Option<AskedPlane> {
    let Event::Plane { origin, x, z, angles, words } = event else {
        return None;
    };
    Some(AskedPlane {
        origin: Vector3::from(*origin),
        x: Vector3::from(*x),
        z: Vector3::from(*z),
        angles: *angles,
        words: words.to_vec(),
    })
}

/// An error model that looks at 33 places and has no opinion.
pub struct Samples;

impl ModelSession for Samples {
    fn fit(
        &mut self,
        _: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let places: [f64; 33] = std::array::from_fn(|step| step as f64 / 32.0);
        let mut out = [Deviation::default(); 33];
        deviation(&places, &mut out);
        let [tip_peak, axis_peak] = peaks(&out);
        Ok(Curve { tip_peak, tip_at: 0.5, axis_peak, axis_at: 0.5, terms: [0.0; 60] })
    }

    fn value(&self, _: &Curve, _: f64) -> Deviation {
        Deviation::default()
    }
}

/// The largest lengths of the deviations of tip and tool axis.
pub(crate) fn peaks(places: &[Deviation]) -> [f64; 2] {
    let peak = |part: fn(&Deviation) -> [f64; 3]| {
        let lengths = places.iter().map(|place| Vector3::from(part(place)).norm());
        lengths.fold(0.0, f64::max)
    };
    [peak(|place| place.tip), peak(|place| place.axis)]
}

/// An output that throws away what is written.
pub struct Nowhere;

impl TextSink for Nowhere {
    fn write(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

/// What came of a run.
#[derive(Debug)]
pub struct Run {
    pub asked: Vec<Asked>,
    pub report: Option<PostingReport>,
    pub findings: Vec<Diagnostic>,
}

impl Run {
    /// Blocks with a motion.
    pub fn motions(&self) -> Vec<&Asked> {
        let asked = self.asked.iter();
        asked.filter(|asked| !asked.words.is_empty()).collect()
    }

    /// The words with which CL lines that end in motion are arrived at.
    pub fn arrival(&self, line: u64) -> Option<&[f64]> {
        let asked = self.asked.iter();
        asked
            .filter(|asked| !asked.words.is_empty() && asked.line <= line)
            .map(|asked| &asked.words[..])
            .next_back()
    }

    /// The messages of all findings.
    pub fn told(&self) -> String {
        let findings = self.findings.iter();
        findings
            .map(|finding| format!("{}: {}", finding.code, finding.message))
            .collect::<Vec<_>>()
            .join("\n")
    }

    pub fn good(self, what: &str) -> Self {
        assert!(self.report.is_some(), "{what}: {}", self.told());
        self
    }
}

/// Posts a CL text on a machine whose words are printed with so many decimals.
pub fn post(
    machine: &Machine,
    decimals: u8,
    cl: &str,
    job: PostingRequest,
    model: &mut dyn ModelSession,
) -> Run {
    let dialect = Recorder::new(machine, decimals);
    watched(machine, dialect, cl, job, model, &mut [])
}

/// [`post`] for a recorder that may declare something, with all of `observers` looking on.
pub fn watched(
    machine: &Machine,
    dialect: Recorder,
    cl: &str,
    job: PostingRequest,
    model: &mut dyn ModelSession,
    observers: &mut [&mut dyn Observer],
) -> Run {
    // The path is what is looked at here, as it is: no retract behind it, and none that a machine which leans any way
    // could not make.
    let mut machine = machine.clone();
    machine.frame.retract.clear();
    framed(&machine, dialect, cl, job, model, observers)
}

/// [`watched`], with the ways from and to the retract.
pub fn framed(
    machine: &Machine,
    mut dialect: Recorder,
    cl: &str,
    mut job: PostingRequest,
    model: &mut dyn ModelSession,
    observers: &mut [&mut dyn Observer],
) -> Run {
    if job.reading.spindle == DefaultSpindle::Unknown {
        // Texts this short do not care for the spindle.
        job.reading.spindle = DefaultSpindle::Still;
    }
    let mut output = Nowhere;
    // What goes point by point goes record by record.
    let alone = job.longest_run == Some(0);
    if wants_planes(machine, dialect.capabilities()) {
        job.ahead =
            Some(Arc::new(previewed(PreviewPass::new(machine, job.reading.clone()), cl, alone)));
    }
    let mut post = Post::new(machine, job, &mut dialect, model, &mut output)
        .expect("machine and dialect agree");
    for observer in observers {
        post.watch(*observer);
    }
    let mut reader = ClReader::new(cl.as_bytes());
    let mut run = GotoRun::default();
    while !post.gave_up() {
        if !alone {
            let text = reader.next_gotos(&mut run);
            if !text.is_empty() {
                post.gotos(&run, text);
                continue;
            }
        }
        match reader.next_record() {
            Ok(Some(record)) => post.record(&record),
            Ok(None) => break,
            Err(ReadError::Syntax(fault)) => post.unreadable(&fault),
            Err(other) => panic!("{other}"),
        }
    }
    let (report, findings) = post.finish();
    Run { asked: dialect.asked, report, findings }
}

/// What a first pass over the text finds, record by record (`alone`) or as a job reads it.
fn previewed(mut pass: PreviewPass, cl: &str, alone: bool) -> FilePreview {
    let mut reader = ClReader::new(cl.as_bytes());
    let mut run = GotoRun::default();
    loop {
        if !alone {
            if pass.passes_gotos() {
                reader.skip_gotos();
            }
            let text = reader.next_gotos(&mut run);
            if !text.is_empty() {
                pass.gotos(&run, text);
                continue;
            }
        }
        match reader.next_record() {
            Ok(Some(record)) => pass.record(&record),
            _ => return pass.finish(),
        }
    }
}

/// A machine, and the same once more for the isometries.
pub struct Bench {
    /// The machine file.
    pub text: String,
    pub machine: Machine,
    pub reference: Reference,
    /// Places in the chain, in the order of the words.
    pub order: Vec<usize>,
    /// Axis values with the tip on the part origin and every rotary axis at zero.
    zero: Joints,
    decimals: u8,
    length: f64,
}

impl Bench {
    /// From the text of a machine file with three linear axes or, where the post keeps the tip, fewer.
    pub fn new(text: &str, decimals: u8, length: f64) -> Self {
        let source = Source { name: "machine.toml".to_owned(), text: text.to_owned() };
        let machine = load(source, &[], &mut |_| Err(String::new()))
            .unwrap_or_else(|faults| panic!("{faults:#?}\n{text}"));
        let reference = Reference {
            joints: machine.axes.iter().map(|axis| axis.joint).collect(),
            mount: machine.mount,
            tip: machine.gauge - machine.tool_axis * length,
            axis: machine.tool_axis,
        };
        let mut order: Vec<usize> = (0..machine.axes.len()).collect();
        order.sort_by_key(|place| "XYZABC".find(&machine.axes[*place].name));
        let mut bench = Self {
            text: text.to_owned(),
            machine,
            reference,
            order,
            zero: Joints::default(),
            decimals,
            length,
        };
        // Without three linear axes there is no position that could be counted from the part origin.
        if bench.reference.linear().len() == 3 {
            bench.zero = bench.put(Vector3::zeros(), Joints::default());
        }
        bench
    }

    /// The place of an axis in the chain.
    pub fn place(&self, name: &str) -> usize {
        let axes = self.machine.axes.iter();
        let mut named = axes.enumerate().filter(|(_, axis)| axis.name == name);
        named.next().expect("an axis of that name").0
    }

    /// Places of the rotary axes.
    pub fn rotary(&self) -> Vec<usize> {
        let joints = self.reference.joints.iter().enumerate();
        joints.filter(|(_, joint)| joint.rotary).map(|(place, _)| place).collect()
    }

    /// The linear axes where they put the tip on `tip`, the rotary ones standing as they do.
    pub fn put(&self, tip: Vector3<f64>, joints: Joints) -> Joints {
        self.reference.put(tip, joints)
    }

    /// Axis values of printed words, whoever keeps the tip.
    pub fn joints(&self, words: &[f64]) -> Joints {
        let mut joints = Joints::default();
        let mut tip = Vector3::zeros();
        for (index, (place, word)) in self.order.iter().zip(words).enumerate() {
            if self.reference.joints[*place].rotary {
                joints[*place] = word.to_radians();
            } else {
                joints[*place] = word + self.zero[*place];
                tip[index] = *word;
            }
        }
        if self.machine.control.tcp == Tcp::Control {
            joints = self.put(tip, joints);
        }
        joints
    }

    /// Tip and tool axis at `t` of a block from `from` to `to`, part frame.
    pub fn at(&self, from: &[f64], to: &[f64], t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let joints = between(&self.joints(from), &self.joints(to), t);
        let (mut tip, axis) = self.reference.forward(&joints);
        if self.machine.control.tcp == Tcp::Control {
            tip = Vector3::from_fn(|row, _| from[row] * (1.0 - t) + to[row] * t);
        }
        (tip, axis)
    }

    pub fn run(&self, cl: &str) -> Run {
        self.run_with(cl, &mut Samples, false)
    }

    /// With an error model of the test's own, and maybe nothing but its word.
    pub fn run_with(&self, cl: &str, model: &mut dyn ModelSession, trust_model: bool) -> Run {
        let job = PostingRequest {
            tool_length: Some(self.length),
            trust_model,
            ..PostingRequest::default()
        };
        post(&self.machine, self.decimals, cl, job, model)
    }
}

/// One point of a CL file, its numbers as they are written.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub rapid: bool,
}

/// A point whose numbers are those that a CL file with so many decimals holds.
pub fn point(tip: Vector3<f64>, axis: Vector3<f64>, rapid: bool) -> Point {
    let rounded =
        |vector: Vector3<f64>, scale: f64| vector.map(|value| libm::rint(value * scale) / scale);
    Point { tip: rounded(tip, 1e4), axis: rounded(axis, 1e9), rapid }
}

/// A CL file with two lines a point, its pace and its numbers.
pub fn cl(points: &[Point], feed: f64) -> String {
    let mut text = "UNITS/MM\nMULTAX/ON\nSPINDL/3000,RPM,CLW\n".to_owned();
    for Point { tip, axis, rapid } in points {
        text += &if *rapid { "RAPID\n".to_owned() } else { format!("FEDRAT/{feed},MMPM\n") };
        text += &format!(
            "GOTO/{:.4},{:.4},{:.4},{:.9},{:.9},{:.9}\n",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        );
    }
    text + "FINI\n"
}

/// Line of the CL file of point `index`.
pub fn line(index: usize) -> u64 {
    3 + 2 * (index as u64 + 1)
}
