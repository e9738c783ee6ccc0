//! `[mode]`: coordinates of the control's own, in which whole operations are written.

use std::ops::Range;

use nalgebra::Vector3;
use post_grammar::text::is_unprintable;

use super::bounds::Bounds;
use super::build::Builder;
use super::file::{FeedLength, FeedMode, OneOrMoreLines, OutputUnits};
use super::quantity::KeyedNumber;
use super::table::{Spanned, keys};
use super::{Axis, FACE_MODE, Head, Machine, Tcp, WRAP_MODE};
use crate::axis_words::unit_length;
use crate::diagnostic::Short;
use crate::face_mode::FaceMode;
use crate::kinematics::{Joint, Joints, MAX_AXES};
use crate::word_map::WordMap;
use crate::wrap_mode::WrapMode;

/// Least distance of the tip from the line of the turning axis, if the file does not say, mm.
const POLE: f64 = 1.0;

/// Steps of a diameter that is printed in one unit of the program.
const PRINTED: f64 = 1e5;

/// Directions whose cosine is one but for so much are one.
const ALONG: f64 = 1e-9;

/// What lies on a line lies so near to it, mm.
const ON_LINE: f64 = 1e-4;

/// Where the axes of a mode end, mm: the real ones are held against their own travel.
const ENDS: f64 = 1e5;

const NEAREST: Bounds = Bounds { says: " mm", ..Bounds::above_zero("machine-mode") };

keys! {
    /// Coordinates of the control's own, in which whole operations are written.
    ModeFile {
        /// Polar interpolation (G12.1, TRANSMIT, G112): the control turns the part itself while a face is milled, and
        /// the words are right-angled coordinates. For a turning axis that carries the part, a linear axis along it and
        /// one that leads towards its line, the tool along it. Operations that turn the part in cuts are written so.
        face: Option<Spanned<FaceFile>>,
        /// Cylinder interpolation (G7.1, TRACYL): the word of the turning axis and the feed are those of a mantle. For one
        /// turning axis that carries the part. Operations that turn the tool axis about it in cuts are written so.
        wrap: Option<Spanned<WrapFile>>,
    }
}

keys! {
    /// Polar interpolation by the control.
    FaceFile {
        /// The line of the program that begins it, or the lines: `"G12.1"`, `["G112", "G17"]`. The turning axis stands at
        /// zero then, and the tool on the positive side.
        on: Spanned<OneOrMoreLines>,
        /// The line that ends it, or the lines: `"G13.1"`, `"TRAFOOF"`.
        off: Spanned<OneOrMoreLines>,
        /// The letter of the coordinate across that of the linear axis: "Y" for TRANSMIT and on Haas and Okuma, that of the
        /// turning axis on Fanuc (C), which need not say it behind G12.1.
        letter: Option<Spanned<String>> = Bounds::pattern("^[A-CU-Z]$"),
        /// The word of the linear axis is a radius in it, whatever `[word]` makes of it outside.
        radius: bool = Bounds::OFF,
        /// An operation that comes nearer to the line of the turning axis, mm, is written without it; 1 if not said.
        pole: Option<KeyedNumber> = NEAREST,
    }
}

keys! {
    /// Cylinder interpolation by the control.
    WrapFile {
        /// The line of the program that begins it, or the lines: `"G7.1 C{r}"`, `"TRACYL({d})"`. Between braces r is the
        /// radius and d the diameter, units of the program. The turning axis stands at zero then.
        on: Spanned<OneOrMoreLines>,
        /// The line that ends it, or the lines: `"G7.1 C0"`, `"TRAFOOF"`.
        off: Spanned<OneOrMoreLines>,
        /// Radius of the cylinder, mm: where the feed of the CL file holds as the control counts it. That of the part for one
        /// job: `--set mode.wrap.radius=40`.
        radius: KeyedNumber = NEAREST,
        /// The letter of the word along the circumference: that of the turning axis if not said (C on Fanuc), "Y" for TRACYL.
        letter: Option<Spanned<String>> = Bounds::pattern("^[A-CU-Z]$"),
        /// That word is a length along the cylinder (TRACYL), not an angle.
        lengths: bool = Bounds::OFF,
    }
}

/// What a mode lacks, and what would help.
struct Lack(String, &'static str);

/// The axes of a face: places in the chain.
#[derive(Clone, Copy)]
struct FaceAxes {
    turning: usize,
    across: usize,
    along: usize,
}

/// What says the letter.
const LETTER: &str = "letter = \"Y\" (TRANSMIT; G112 of Haas, G137 of Okuma), or that of the turning axis, as after G12.1 of Fanuc";

/// The lines begin the mode by Fanuc's G12.1, behind which the coordinate across has the letter of the turning axis.
fn is_fanucs(on: &[String]) -> bool {
    let mut tokens = on.iter().flat_map(|line| line.split_whitespace());
    tokens.any(|token| {
        let number = token.trim_start_matches(['G', 'g']);
        number.len() < token.len() && number.trim_start_matches('0') == "12.1"
    })
}

/// The chain that a control interpolates on a face.
const CHAIN: &str = "[mode.face] is for a turning axis that carries the part, a linear axis along it and one that leads towards \
                     its line: chain = \"[w C' b Z X (S) t]\"";

impl Builder<'_> {
    /// The machine in polar interpolation, to be put among its heads.
    pub(super) fn face(&mut self, file: &ModeFile, machine: &Machine) -> Option<Head> {
        let face = file.face.as_ref()?;
        let span = face.span();
        let said = face.get_ref();
        let on = self.lines(&said.on)?;
        let off = self.lines(&said.off)?;
        let pole = self.checked(&said.pole).unwrap_or(POLE);
        let made = face_axes(machine).and_then(|axes| {
            let centre = centre(machine, axes)?;
            let own = &machine.axes[axes.turning].name;
            let letter = said.letter.as_ref().map(|letter| letter.get_ref());
            let letter = letter.or_else(|| is_fanucs(&on).then_some(own)).ok_or_else(|| {
                let message =
                    format!("which letter the coordinate across has behind {}", on.join(" "));
                Lack(format!("{message} is not said"), LETTER)
            })?;
            check_letter(machine, [axes.across, axes.along].into_iter(), letter)?;
            let mode = FaceMode {
                on,
                off,
                letter: letter.clone(),
                pole,
                turning: axes.turning,
                across: axes.across,
                centre,
                turning_feed: machine.axes[axes.turning].max_feed,
                across_feed: machine.axes[axes.across].max_feed,
            };
            in_mode(machine, axes, said.radius, mode)
        });
        self.mode(FACE_MODE, span, made)
    }

    /// The machine in cylinder interpolation, to be put among its heads.
    pub(super) fn wrap(&mut self, file: &ModeFile, machine: &Machine) -> Option<Head> {
        let wrap = file.wrap.as_ref()?;
        let span = wrap.span();
        let said = wrap.get_ref();
        let unit = unit_length(machine.control.units);
        // The control is told of the cylinder that lengths are counted on.
        let diameter = 2.0 * self.checked(&Some(said.radius.clone()))? / unit;
        let diameter = libm::rint(diameter * PRINTED) / PRINTED;
        let radius = diameter / 2.0 * unit;
        let filled = |lines: Vec<String>| {
            let text = |value: f64| {
                let text = format!("{value:.6}");
                text.trim_end_matches('0').trim_end_matches('.').to_owned()
            };
            let fill = |line: String| {
                let line = line.replace("{r}", &text(diameter / 2.0));
                line.replace("{d}", &text(diameter))
            };
            lines.into_iter().map(fill).collect::<Vec<_>>()
        };
        let on = filled(self.lines(&said.on)?);
        let off = filled(self.lines(&said.off)?);
        let made = turning_axis(machine, said.lengths).and_then(|turning| {
            let own = &machine.axes[turning].name;
            let letter = said.letter.as_ref().map_or(own, |letter| letter.get_ref());
            let others = (0..machine.axes.len()).filter(|place| *place != turning);
            check_letter(machine, others, letter)?;
            let letter = letter.clone();
            let mode = WrapMode { on, off, letter, lengths: said.lengths, radius, turning };
            Ok(on_mantle(machine, mode))
        });
        self.mode(WRAP_MODE, span, made)
    }

    /// The machine in a mode, as one of its heads, or what it lacks for that.
    fn mode(
        &mut self,
        name: &str,
        span: Range<usize>,
        made: Result<Machine, Lack>,
    ) -> Option<Head> {
        match made {
            Ok(machine) => Some(Head { name: name.to_owned(), word: None, offset: None, machine }),
            Err(Lack(message, help)) => {
                self.fault("machine-mode", span, message, help);
                None
            }
        }
    }

    /// Lines of the program, each a block of its own.
    fn lines(&mut self, said: &Spanned<OneOrMoreLines>) -> Option<Vec<String>> {
        let lines = said.get_ref().as_slice();
        let whole = |line: &String| !line.trim().is_empty() && !line.chars().any(is_unprintable);
        if lines.is_empty() || !lines.iter().all(whole) {
            let span: Range<usize> = said.span();
            let message = "a mode begins and ends by lines of the program".to_owned();
            self.fault("machine-mode", span, message, "on = \"G12.1\", off = \"G13.1\"");
            return None;
        }
        Some(lines.to_vec())
    }
}

/// The axes that a face is milled with.
fn face_axes(machine: &Machine) -> Result<FaceAxes, Lack> {
    let wrong = || Lack("the machine has other axes than a face is milled with".to_owned(), CHAIN);
    let place = |wanted: &dyn Fn(&Axis) -> bool| machine.axes.iter().position(wanted);
    let turning = place(&|axis| axis.joint.rotary && axis.carries_part).ok_or_else(wrong)?;
    let line = machine.axes[turning].joint.direction;
    let leads = |axis: &Axis| axis.joint.direction.dot(&line).abs();
    let along = place(&|axis| !axis.joint.rotary && leads(axis) > 1.0 - ALONG);
    let across = place(&|axis| !axis.joint.rotary && leads(axis) < ALONG);
    let (along, across) = along.zip(across).ok_or_else(wrong)?;
    let free = |axis: &Axis| axis.indexed.is_none() && axis.second.is_none();
    let upright = machine.tool_axis.dot(&line).abs() > 1.0 - ALONG;
    if machine.axes.len() != 3 || !machine.axes.iter().all(free) || !upright {
        return Err(wrong());
    }
    check_plain(machine, turning)?;
    Ok(FaceAxes { turning, across, along })
}

/// The one axis that turns the part, of a machine whose control can interpolate on a mantle.
fn turning_axis(machine: &Machine, lengths: bool) -> Result<usize, Lack> {
    let mut rotary = (0..machine.axes.len()).filter(|place| machine.axes[*place].joint.rotary);
    let turning = rotary.next().filter(|place| machine.axes[*place].carries_part);
    let free = |axis: &Axis| axis.indexed.is_none();
    let (Some(turning), None, true) = (turning, rotary.next(), machine.axes.iter().all(free))
    else {
        let message = "the machine has other axes than a mantle is milled with".to_owned();
        return Err(Lack(
            message,
            "[mode.wrap] is for one rotary axis, which carries the part: chain = \"[w C' b Z X (S) t]\"",
        ));
    };
    check_plain(machine, turning)?;
    if lengths && machine.control.units == OutputUnits::Inch {
        let message = "lengths along a cylinder are written in mm alone".to_owned();
        return Err(Lack(message, "units = \"mm\", or a word that is an angle"));
    }
    Ok(turning)
}

/// What the modes ask of a machine whose axis at `turning` carries the part.
fn check_plain(machine: &Machine, turning: usize) -> Result<(), Lack> {
    let own = |lack: &str, help| Err(Lack(lack.to_owned(), help));
    let place = turning;
    let turning = &machine.axes[turning];
    if machine.control.tcp != Tcp::Post || machine.edge.is_some() {
        return own("the mode is the control's, and so is what keeps the tip", "tcp = \"post\"");
    }
    if turning.zero != 0.0 || turning.travel.is_some() {
        return own(
            "the turning axis must turn without end and show zero in the drawing",
            "cyclic = true, and no zero",
        );
    }
    if !machine.limits.is_empty() || machine.frame.leave.is_some() {
        return own(
            "[[limit]], a travel of [word] and [control] leave are not held in the mode",
            "leave one of them out",
        );
    }
    let coupled = |map: &WordMap| map.couples() || map.factor(place) != 1.0;
    if machine.word_map.as_ref().is_some_and(coupled) {
        return own("the turning axis has a word of its own", "leave [word.C] out");
    }
    if let Some(axis) = machine.axes.iter().find(|axis| axis.max_feed.is_infinite()) {
        let message = format!("{} has no max_feed: there are no rapids in the mode", axis.name);
        return Err(Lack(message, "give every axis its max_feed"));
    }
    Ok(())
}

/// The machine as its control takes words and feeds on the mantle.
fn on_mantle(machine: &Machine, mode: WrapMode) -> Machine {
    let mut wrap = machine.clone();
    let turning = &mut wrap.axes[mode.turning];
    turning.feed_diameter = Some(2.0 * mode.radius);
    turning.clamp = None;
    if mode.lengths {
        let factor = |place: usize| machine.word_map.as_ref().map_or(1.0, |map| map.factor(place));
        let mut factors: Joints = std::array::from_fn(factor);
        factors[mode.turning] = 1f64.to_radians() * mode.radius;
        wrap.word_map = WordMap::multiples(factors);
    }
    wrap.clamps = false;
    wrap.control.feed = FeedMode::PerMinute;
    wrap.control.feed_length = Some(FeedLength::Combined);
    wrap.frame.change.clear();
    wrap.frame.park.clear();
    wrap.wrap = Some(mode);
    wrap
}

/// Value of the axis that leads to the line of the turning axis with the tip on it, mm.
fn centre(machine: &Machine, axes: FaceAxes) -> Result<f64, Lack> {
    let Joint { direction: line, point, .. } = machine.axes[axes.turning].joint;
    let aside = |place: Vector3<f64>| {
        let from = place - point;
        from - line * line.dot(&from)
    };
    let part = aside(machine.mount).norm();
    if part > ON_LINE {
        let message = format!(
            "the part origin stands {} mm beside the line of {}, from which the control counts",
            Short(part),
            machine.axes[axes.turning].name
        );
        return Err(Lack(
            message,
            "[workpiece] mount, and the origin of the CL file, on that line",
        ));
    }
    let across = machine.axes[axes.across].joint.direction;
    let tip = aside(machine.gauge);
    let centre = -across.dot(&tip);
    let missed = (tip + across * centre).norm();
    if missed > ON_LINE {
        let message = format!(
            "{} leads the tool past the line of {}, {} mm beside it",
            machine.axes[axes.across].name,
            machine.axes[axes.turning].name,
            Short(missed)
        );
        return Err(Lack(message, "[tool] gauge, so that the tool comes to the line"));
    }
    Ok(centre)
}

/// The letter of the coordinate is that of no other axis.
fn check_letter(
    machine: &Machine,
    mut others: impl Iterator<Item = usize>,
    letter: &str,
) -> Result<(), Lack> {
    let taken = |axis: usize| machine.axes[axis].name == letter;
    match others.any(taken) {
        true => {
            let message = format!("{letter} is the letter of another axis in the mode");
            Err(Lack(message, "letter = \"C\" or \"Y\""))
        }
        false => Ok(()),
    }
}

/// The machine as its control interpolates in the mode.
fn in_mode(
    machine: &Machine,
    axes: FaceAxes,
    radius: bool,
    mode: FaceMode,
) -> Result<Machine, Lack> {
    let across = machine.axes[axes.across].clone();
    let mut face = machine.clone();
    let turning = &mut face.axes[axes.turning];
    let direction = turning.joint.direction.cross(&across.joint.direction);
    let open = Some([-ENDS, ENDS]);
    *turning = Axis {
        joint: Joint { rotary: false, direction, point: Vector3::zeros() },
        name: turning.name.clone(),
        place: turning.place.clone(),
        carries_part: true,
        travel: open,
        clamp: None,
        ..across.clone()
    };
    turning.zero = 0.0;
    turning.reversed = false;
    face.axes[axes.across].travel = open;
    let factor = |place: usize| machine.word_map.as_ref().map_or(1.0, |map| map.factor(place));
    let mut factors: Joints = [1.0; MAX_AXES];
    factors[axes.across] = if radius { 1.0 } else { factor(axes.across) };
    factors[axes.along] = factor(axes.along);
    face.word_map = WordMap::multiples(factors);
    face.clamps = false;
    face.control.feed = FeedMode::PerMinute;
    face.frame.change.clear();
    face.frame.park.clear();
    face.face = Some(mode);
    match face.solver(0.0) {
        Ok(_) => Ok(face),
        Err(lack) => Err(Lack(lack.told(|joint| &machine.axes[joint].name).0, CHAIN)),
    }
}
