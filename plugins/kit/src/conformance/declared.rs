//! What a dialect declares beyond straight moves it writes, with every number that it is given; what it does not
//! declare it refuses.

use post_plugin::{
    Capabilities, DialectSession as _, Event, Feed, List, PlaneAngles, SpindleSense, ToolPose,
    Units,
};

use super::Case;
use super::arcs::arcs;
use super::cycles::cycles;
use super::pen::{BEGIN, ELSEWHERE, END, HERE, Pen, SLOW};
use crate::{TOP, at, turn, turning};
use post_host::PluginFault;

/// Where most trials end.
const XY: &[f64] = &[30.0, 20.0, 30.0, 5.0, 6.0];
/// The end of a helix, and another one.
pub(super) const DOWN: &[f64] = &[30.0, 20.0, 25.0, 5.0, 6.0];
pub(super) const DEEPER: &[f64] = &[30.0, 20.0, 24.0, 5.0, 6.0];

pub(super) const FAST: Feed = Feed::PerMinute(450.0);

/// Events between two moves.
pub(super) type Events = Vec<Event<'static>>;

/// What is tried: events, and others from which their text must differ.
pub(super) struct CapabilityTrial {
    needs: Capabilities,
    /// What it needs besides where the control keeps the tip.
    pub(super) under_tcp: Capabilities,
    what: &'static str,
    events: Events,
    others: Vec<(&'static str, Events)>,
    /// They may leave no text.
    silent: bool,
    /// The tool is away from the part, and comes to it again afterwards.
    away: bool,
}

impl CapabilityTrial {
    pub(super) fn new(needs: Capabilities, what: &'static str, events: impl Into<Events>) -> Self {
        CapabilityTrial {
            needs,
            under_tcp: Capabilities::NONE,
            what,
            events: events.into(),
            others: Vec::new(),
            silent: false,
            away: false,
        }
    }

    pub(super) fn but(mut self, what: &'static str, events: impl Into<Events>) -> Self {
        self.others.push((what, events.into()));
        self
    }

    fn silent(mut self) -> Self {
        self.silent = true;
        self
    }

    fn away(mut self) -> Self {
        self.away = true;
        self
    }
}

/// Tries all that is declared.
pub(super) fn declared(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let opened = pen.open()?;
    let (declares, angles) = (opened.capabilities(), opened.format().plane_angles);
    let mut trials = motion();
    trials.extend(arcs());
    trials.extend(settings());
    trials.extend(cycles(declares));
    trials.push(plane(angles));
    let letter = |letter| {
        let named = Event::WordLetter { word: 0, coordinate: true, letter };
        [named, Event::linear(XY, SLOW)]
    };
    trials.push(
        CapabilityTrial::new(Capabilities::WORD_LETTER, "another letter of a word", letter("Q"))
            .but("yet another letter", letter("E")),
    );
    if pen.setup.tcp {
        trials.push(vector());
        let switch = [Event::Tcp { on: false }, Event::Tcp { on: true }];
        let what = "a switch of tool centre point control";
        trials.push(CapabilityTrial::new(Capabilities::TCP_SWITCH, what, switch));
    }
    for trial in &trials {
        let needs = match pen.setup.tcp {
            true => trial.needs.and(trial.under_tcp),
            false => trial.needs,
        };
        if declares.has(needs) {
            run(pen, trial, case)?;
        }
    }
    if declares.has(Capabilities::INSTEAD) {
        instead(pen, case, declares)?;
    }
    Ok(())
}

fn run(pen: &Pen<'_>, trial: &CapabilityTrial, case: &mut Case) -> Result<(), PluginFault> {
    let text = |events: &[Event<'_>]| pen.write_around(events, trial.away);
    let what = trial.what;
    let own = match text(&trial.events)? {
        Ok(own) => own,
        Err(fault) => {
            case.wrong(format!("it declares {what}, and refuses it: {fault}"));
            return Ok(());
        }
    };
    if !trial.silent
        && let Ok(without) = text(&[])?
        && without == own
    {
        case.wrong(format!("it declares {what}, and writes nothing"));
        return Ok(());
    }
    for (change, other) in &trial.others {
        match text(other)? {
            Ok(other) if other == own => {
                case.wrong(format!("{what}: {change} makes no difference to the text"));
            }
            Ok(_) => {}
            Err(fault) => case.wrong(format!("{what}: {change} is refused: {fault}")),
        }
    }
    Ok(())
}

fn motion() -> Vec<CapabilityTrial> {
    let mut trials = Vec::new();
    const POINTS: &[f64] = &[
        10.0, 20.0, 30.0, 5.0, 6.0, 20.0, 25.0, 30.0, 5.0, 6.0, 25.0, 15.0, 30.0, 5.0, 6.0, 30.0,
        20.0, 30.0, 5.0, 6.0,
    ];
    const OTHERS: &[f64] = &[
        10.0, 20.0, 30.0, 5.0, 6.0, 20.0, 25.5, 30.0, 5.0, 6.0, 25.0, 15.0, 30.0, 5.0, 6.0, 30.0,
        20.0, 30.0, 5.0, 6.0,
    ];
    let spline = |feed, points, weights| Event::Spline {
        feed,
        degree: 3,
        knots: List(&[0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]),
        weights: List(weights),
        points: List(points),
    };
    const EVEN: &[f64] = &[1.0; 4];
    trials.push(
        CapabilityTrial::new(Capabilities::SPLINE, "a spline", [spline(SLOW, POINTS, EVEN)])
            .but("another point", [spline(SLOW, OTHERS, EVEN)])
            .but("another weight", [spline(SLOW, POINTS, &[1.0, 2.0, 1.0, 1.0])])
            .but("another feed", [spline(FAST, POINTS, EVEN)]),
    );
    let probe = |words, feed| Event::Probe { tool: None, feed, words };
    trials.push(
        CapabilityTrial::new(Capabilities::PROBE, "a probing move", [probe(DOWN, SLOW)])
            .but("another end", [probe(DEEPER, SLOW)])
            .but("another feed", [probe(DOWN, FAST)])
            .but("a cut in its place", [Event::linear(DOWN, SLOW)]),
    );
    let surface = |normal, words| Event::Surface { tool: Some(UPRIGHT), feed: SLOW, normal, words };
    trials.push(
        CapabilityTrial::new(
            Capabilities::SURFACE,
            "a cut with a surface normal",
            [surface([0.0, 0.0, 1.0], XY)],
        )
        .but("another normal", [surface([0.0, 0.6, 0.8], XY)])
        .but("another end", [surface([0.0, 0.0, 1.0], DOWN)]),
    );
    trials
}

/// The direction of the tool, whatever the rotary words say.
fn vector() -> CapabilityTrial {
    let cut = |axis| {
        let tool = Some(ToolPose { axis, ..UPRIGHT });
        Event::Linear { tool, feed: SLOW, words: XY }
    };
    CapabilityTrial::new(Capabilities::TOOL_VECTOR, "the tool's direction", [cut([0.0, 0.6, 0.8])])
        .but("another direction", [cut([0.6, 0.0, 0.8])])
        .but("the other side", [cut([0.0, -0.6, 0.8])])
}

const UPRIGHT: ToolPose = ToolPose { tip: [30.0, 20.0, 30.0], axis: [0.0, 0.0, 1.0] };

fn settings() -> Vec<CapabilityTrial> {
    let operation = |name| Event::Operation { name };
    let message = |text| Event::Message { text };
    let smoothing = |tolerance| Event::Smoothing { tolerance, axis_tolerance: Some(0.1) };
    let offset = |number| Event::WorkOffset { number, name: "" };
    let registers = |length, radius| Event::Offsets { length, radius };
    let speed = |speed, most, sense| Event::SurfaceSpeed { speed, most, sense };
    let clamp = |word, on| Event::Clamp { word, on };
    let space = |on, register| Event::Compensate3d { on, register };
    let call = |number, times, name| Event::Subprogram { number, times, name };
    let (right, left) = (SpindleSense::Clockwise, SpindleSense::CounterClockwise);
    vec![
        CapabilityTrial::new(
            Capabilities::OPERATION,
            "an operation",
            [operation("ROUGH"), Event::OperationEnd],
        )
        .silent(),
        CapabilityTrial::new(Capabilities::MESSAGE, "a message", [message("ALPHA")])
            .but("another text", [message("OMEGA")]),
        CapabilityTrial::new(Capabilities::UNITS, "a change of units", [Event::Units(Units::Inch)])
            .but("the other units", [Event::Units(Units::Millimetre)])
            .away(),
        CapabilityTrial::new(Capabilities::WORK_OFFSET, "a work offset", [offset(2)])
            .but("another number", [offset(3)])
            .away(),
        CapabilityTrial::new(
            Capabilities::OFFSETS,
            "other registers of the tool",
            [registers(Some(7), None)],
        )
        .but("another register of the length", [registers(Some(8), None)])
        .away(),
        CapabilityTrial::new(
            Capabilities::SURFACE_SPEED,
            "a constant cutting speed",
            [speed(200.0, Some(3000.0), right)],
        )
        .but("another speed", [speed(201.0, Some(3000.0), right)])
        .but("another largest speed", [speed(200.0, Some(3100.0), right)])
        .but("the other sense", [speed(200.0, Some(3000.0), left)]),
        CapabilityTrial::new(Capabilities::CLAMP, "a clamp", [clamp(3, true)])
            .but("another axis", [clamp(4, true)])
            .but("its release", [clamp(3, false)])
            .away(),
        // Which tolerances a control tells apart is its own affair: many have a few levels, some one.
        CapabilityTrial::new(Capabilities::SMOOTHING, "smoothing", [smoothing(0.002)])
            .but("its end", [smoothing(0.002), Event::SmoothingOff])
            .away(),
        CapabilityTrial::new(
            Capabilities::COMPENSATE_3D,
            "compensation in space",
            [space(true, 5), space(false, 0)],
        )
        .but("a cut without it", [Event::linear(XY, SLOW)]),
        CapabilityTrial::new(Capabilities::SUBPROGRAM, "a subprogram", [call(Some(1234), 1, "")])
            .but("another number", [call(Some(1235), 1, "")])
            .but("how often", [call(Some(1234), 2, "")]),
    ]
}

fn plane(angles: PlaneAngles) -> CapabilityTrial {
    let plane = |x, angle| {
        let tilted = [angle, 20.5, 30.5];
        vec![
            turn(HERE),
            Event::Plane {
                origin: [x, 0.0, 0.0],
                x: [1.0, 0.0, 0.0],
                z: [0.0, 0.0, 1.0],
                angles: if angles == PlaneAngles::Rotary { [0.0; 3] } else { tilted },
                words: HERE,
            },
            at(HERE),
            Event::linear(DOWN, SLOW),
            TOP,
            Event::PlaneOff,
        ]
    };
    let trial =
        CapabilityTrial::new(Capabilities::PLANE, "a tilted plane", plane(0.0, 10.5)).away();
    if angles == PlaneAngles::Rotary {
        return trial;
    }
    let other = plane(0.0, 11.5);
    trial
        .but("another angle", other)
        // A number in either unit.
        .but("another origin", plane(25.4, 10.5))
}

/// Lines of the user's own in the place of a tool change: they stand there, the change's own do not, and the tool is
/// the new one all the same.
fn instead(pen: &Pen<'_>, case: &mut Case, declares: Capabilities) -> Result<(), PluginFault> {
    const LINES: &str = "M199 P1\nM198";
    const BACK: &[Event<'static>] = &[turning(3000.0), turn(&ELSEWHERE), at(&ELSEWHERE)];
    let text = |register, lines: Option<Event<'static>>| {
        let change = [Event::tool_change(2, register, "")];
        let came = [at(&ELSEWHERE), TOP];
        pen.write(&[BEGIN, &came, lines.as_slice(), &change, BACK, END])
    };
    const CHANGE: usize = 3;
    let lines = Some(Event::Instead { text: LINES });
    let with = match (text(5, lines)?, text(5, None)?) {
        (Ok(with), Ok(plain)) => {
            // What it would have written stands in no line of its own.
            let left = plain.part(CHANGE).lines();
            let mut left = left.filter(|line| !line.starts_with(['(', ';', '*']));
            if let Some(first) = left.find(|line| with.part(CHANGE).contains(line)) {
                case.wrong(format!(
                    "lines in the place of a tool change: `{first}` of the change is written all the same"
                ));
            }
            with
        }
        (Err(fault), _) | (_, Err(fault)) => {
            case.wrong(format!(
                "it declares lines in the place of an event's, and refuses them: {fault}"
            ));
            return Ok(());
        }
    };
    for line in LINES.lines().filter(|line| !with.text.contains(line)) {
        case.wrong(format!(
            "lines in the place of a tool change: `{line}` is not written letter for letter ({:?})",
            with.part(CHANGE)
        ));
    }
    if !declares.has(Capabilities::TOOL_TABLE)
        && let Ok(other) = text(6, lines)?
        && other.text == with.text
    {
        case.wrong(
            "lines in the place of a tool change: the new tool's register is not in force behind them"
                .to_owned(),
        );
    }
    Ok(())
}
