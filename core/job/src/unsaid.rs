//! What a program leaves unsaid: where axes stand, modes that hold from whatever ran before or are left to whatever runs
//! next, and its end. A program of our own says all of that; others have it said elsewhere, perhaps.

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};
use post_plugin::{Capabilities, Meaning};
use post_readback::interpret::{ContraryMode, ModalGroup, ModesInForce, ReadReport};

use super::nc_program::DialectVocabulary;
use super::plugin_finder;

/// The word that makes the taps behind it rigid, on controls whose dialect names it.
const RIGID: &str = "M29";

/// A program that was run.
pub struct Unsaid<'a> {
    /// The program, as messages call it.
    pub name: &'a str,
    /// What its reading found.
    pub report: &'a ReadReport,
    /// What its dialect tells of its words.
    pub spoken: &'a DialectVocabulary,
    /// It was posted for this machine file.
    pub own: bool,
    /// Its last line; none: it was not run to its end.
    pub last_line: Option<u64>,
}

impl Unsaid<'_> {
    /// All that it leaves unsaid on `machine`.
    pub fn findings(&self, finder: &Finder, machine: &Machine) -> Vec<Diagnostic> {
        if let Some(empty) = self.empty() {
            return vec![empty];
        }
        let mut findings = self.starts();
        findings.extend(self.comes_down());
        findings.extend(self.unplaced());
        findings.extend(self.moved_clamped());
        findings.extend(self.frame_dropped());
        findings.extend(self.length_across());
        findings.extend(self.lengthened());
        findings.extend(self.cut_off());
        findings.extend(self.modes(finder, machine));
        findings.extend(self.contrary());
        findings.extend(self.retract());
        findings.extend(self.unended());
        findings.extend(self.own.then(|| self.left_in_force()).flatten());
        if plugin_finder::text(finder, machine, "tapping").as_deref() == Some("rigid") {
            findings.extend(self.bare_taps());
        }
        findings
    }

    fn at(&self, line: u64) -> Option<SourcePlace> {
        Some(SourcePlace::new(self.name, line, "", 0..0))
    }

    /// An error in a program of our own, else a warning.
    fn graded(&self, code: &'static str, message: String) -> Diagnostic {
        match self.own {
            true => Diagnostic::error(code, message),
            false => Diagnostic::warning(code, message),
        }
    }

    /// That no block stands in it.
    fn empty(&self) -> Option<Diagnostic> {
        self.last_line.filter(|_| self.report.blocks == 0)?;
        Some(no_program(self.name))
    }

    /// Where axes stand that it cuts with. That of rotary ones is said elsewhere where a program of another hand turns none.
    fn starts(&self) -> Vec<Diagnostic> {
        let unknown = |(line, axes): &(u64, String), taken: &str| {
            let message = format!(
                "the program cuts before it says where {axes} stands: where the machine has it then is not known{taken}"
            );
            let help = format!("lead {axes} to a position ahead of the first cut");
            Diagnostic::error("missing", message).help(help).at(self.at(*line))
        };
        let ReadReport { unsaid, unturned, .. } = self.report;
        let linear = unsaid.iter().map(|unsaid| unknown(unsaid, ""));
        let rotary = unturned.iter().map(|unturned| match self.own {
            true => unknown(unturned, ""),
            false => Diagnostic {
                severity: Severity::Warning,
                ..unknown(unturned, ", and is taken to be as the machine file starts")
            },
        });
        linear.chain(rotary).collect()
    }

    /// Where the tool comes down first.
    fn comes_down(&self) -> Option<Diagnostic> {
        let ReadReport { blind, unsaid, unturned, .. } = self.report;
        let told = unsaid.is_some() || unturned.is_some();
        let (line, axes) = blind.as_ref().filter(|_| self.own && !told)?;
        let message = format!(
            "the tool comes down before the program says where {axes} stands: it does so wherever the machine has it then"
        );
        let help = format!("lead {axes} to a position ahead of it");
        Some(Diagnostic::error("missing", message).help(help).at(self.at(*line)))
    }

    /// A part that lies where the machine happened to stand.
    fn unplaced(&self) -> Option<Diagnostic> {
        let (line, axes) = self.report.unplaced.as_ref().filter(|_| self.own)?;
        let message = format!(
            "G92 says where the part lies by where {axes} stands, and the program has not led it there"
        );
        let help = format!("lead {axes} to a position ahead of it, or name a work offset");
        Some(Diagnostic::error("missing", message).help(help).at(self.at(*line)))
    }

    /// An axis that moves in its clamp.
    fn moved_clamped(&self) -> Option<Diagnostic> {
        let (line, axis) = self.report.moved_clamped.as_ref()?;
        let message = format!("{axis} moves, and is clamped by a word of the machine file");
        let help = format!("let {axis} go ahead of it");
        Some(self.graded("nc-clamp", message).help(help).at(self.at(*line)))
    }

    /// A work offset that a transformation may have ended.
    fn frame_dropped(&self) -> Option<Diagnostic> {
        let line = self.report.frame_dropped?;
        let message = "a transformation has begun or ended, which may end the work offset (MD 10602), and no word names it again".to_owned();
        let help = "name the work offset behind TRAORI and TRAFOOF";
        Some(self.graded("nc-frame", message).help(help).at(self.at(line)))
    }

    /// A plane across which the tool does not lie.
    fn length_across(&self) -> Option<Diagnostic> {
        let line = self.report.length_across?;
        let message = "the plane is another than when the tool's length was put on, and the control lays the length along the axis across it".to_owned();
        let help = "name the plane of the tool again; `arcs_off_xy` of the dialect says that the control keeps the length where it is";
        Some(self.graded("nc-length", message).help(help).at(self.at(line)))
    }

    /// A position of the machine that the tool's length may shift.
    fn lengthened(&self) -> Option<Diagnostic> {
        let line = self.report.lengthened?;
        let message = "a position of the machine while the tool's length is in force: whether it counts there is for the control's builder to say".to_owned();
        let help = "write D0 in the block or ahead of it";
        Some(Diagnostic::warning("nc-machine", message).help(help).at(self.at(line)))
    }

    /// A cycle that no word of its own ends.
    fn cut_off(&self) -> Option<Diagnostic> {
        let line = self.report.cycle_cut_off.filter(|_| self.own)?;
        let mut words = self.spoken.words.iter();
        let off = words.find(|word| ModalGroup::of(word.meaning) == Some(ModalGroup::Cycle))?;
        let message = format!(
            "a word of motion alone ends the cycle here, {} does not: where the control lets it go on, the next position is drilled",
            off.word
        );
        let help = format!("write {} ahead of it", off.word);
        Some(Diagnostic::error("nc-modes", message).help(help).at(self.at(line)))
    }

    /// Modes that it does not set.
    fn modes(&self, finder: &Finder, machine: &Machine) -> Option<Diagnostic> {
        let words = |group: ModalGroup| {
            let words = self.spoken.words.iter();
            let words = words.filter(|word| ModalGroup::of(word.meaning) == Some(group));
            let words: Vec<&str> = words.map(|word| word.word.as_ref()).collect();
            match words.is_empty() {
                true => group.name().to_owned(),
                false => format!("{} ({})", group.name(), words.join(", ")),
            }
        };
        let is_told = |group: ModalGroup| match group {
            ModalGroup::Compensation | ModalGroup::Cycle => self.own,
            ModalGroup::TiltedPlane => self.own && self.ends_planes(finder, machine),
            _ => true,
        };
        let relied = self.report.relied.iter().filter(|(_, group)| is_told(*group));
        let (line, _) = relied.clone().next()?;
        let unset: Vec<String> = relied.map(|(_, group)| words(*group)).collect();
        let message = format!(
            "the program does not set {}: what its words mean hangs on what ran before it",
            unset.join(", nor ")
        );
        let help = "set it in the first lines of the program: a reset of the control does not";
        Some(self.graded("nc-modes", message).help(help).at(self.at(*line)))
    }

    /// Modes that it sets otherwise than the machine file has them.
    fn contrary(&self) -> impl Iterator<Item = Diagnostic> + '_ {
        self.report.contrary.iter().map(|contrary| {
            let ContraryMode { line, group, has, wants } = contrary;
            let name = group.name();
            let wanted = wants.as_deref().unwrap_or("the one that the control is set up with");
            let message = match group {
                ModalGroup::Plane => format!(
                    "the {name} is {has}, and the lengths of a turning tool act in X and Z under {wanted} alone"
                ),
                _ => format!(
                    "{name} is {has} in a straight move, and that of the machine file is {wanted}"
                ),
            };
            let help = match group {
                ModalGroup::Plane => "set G18 ahead of the first motion",
                ModalGroup::ToolFrame => {
                    "set the tool that the machine file stands for ahead of it, or name it there: `tool` of the dialect"
                }
                _ => "poses count from the frame of the machine file: set that ahead of it",
            };
            Diagnostic::error("nc-modes", message).help(help).at(self.at(*line))
        })
    }

    /// Programs of this machine end a tilted plane that was left on, by the options of their dialect.
    fn ends_planes(&self, finder: &Finder, machine: &Machine) -> bool {
        let ends = self.spoken.words.iter();
        let mut ends = ends.filter(|word| word.meaning == Meaning::TiltedPlaneOff);
        let lines = plugin_finder::text(finder, machine, "cancel").unwrap_or_default();
        let mut words = lines.split_whitespace();
        ends.any(|end| words.any(|word| word == end.word))
            || plugin_finder::flag(finder, machine, "reset") == Some(true)
                && machine.axes.iter().any(|axis| axis.joint.rotary)
    }

    /// Where the tool stands as it begins.
    fn retract(&self) -> Option<Diagnostic> {
        let (line, axes) = self.report.unretracted.as_ref().filter(|_| self.own)?;
        let message = format!(
            "{axes} is not retracted before the first tool change or the first way to the part: where it stands then is not known"
        );
        Some(Diagnostic::error("rapid", message).at(self.at(*line)))
    }

    /// That no word ends it. A control without such a word ends with the file, and so does one that runs its lines one by
    /// one.
    fn unended(&self) -> Option<Diagnostic> {
        let last_line = self.last_line.filter(|_| self.report.blocks > 0)?;
        if self.report.end.is_some() || self.spoken.writes.has(Capabilities::COMMAND_A_LINE) {
            return None;
        }
        self.spoken.words.iter().find(|word| word.meaning == Meaning::End)?;
        let message = "no word of the program ends it: the control stops there with an alarm, or goes on in what stands behind it";
        let help = "end it by the control's word: M30, M2, or M99 where it is called; it may have been cut off";
        Some(self.graded("missing", message.to_owned()).help(help).at(self.at(last_line)))
    }

    /// What it leaves to whatever runs next.
    pub fn left_in_force(&self) -> Option<Diagnostic> {
        self.last_line?;
        let end = self.report.end.as_ref()?;
        let message = |modes: &str| {
            format!("the program ends with {modes} in force: whatever runs next begins so")
        };
        self.in_force(end, &message)
    }

    /// That a tool is changed with something in force.
    pub fn change(&self) -> Option<Diagnostic> {
        let message = |modes: &str| {
            format!("the tool is changed with {modes} in force: what that does the control decides")
        };
        self.in_force(self.report.changed.as_ref()?, &message)
    }

    fn in_force(
        &self,
        held: &ModesInForce,
        message: &dyn Fn(&str) -> String,
    ) -> Option<Diagnostic> {
        if held.modes.is_empty() {
            return None;
        }
        let help = "switch it off behind the last cut that needs it";
        let finding = self.graded("nc-modes", message(&held.modes.join(" and ")));
        Some(finding.help(help).at(self.at(held.line)))
    }

    /// Taps that should be rigid without the word ahead of them that makes them so.
    fn bare_taps(&self) -> Option<Diagnostic> {
        let (line, count) = self.report.bare_taps?;
        let mut words = self.spoken.words.iter();
        words.find(|word| word.word == RIGID && word.meaning == Meaning::Nothing)?;
        let holes = if count == 1 { "a hole is".to_owned() } else { format!("{count} holes are") };
        let message = format!(
            "{holes} tapped without {RIGID} ahead of the cycle: spindle and feed go together only if a parameter says so, and a tap in a rigid holder breaks"
        );
        let help = format!(
            "write {RIGID} ahead of it, or say tapping = \"floating\" for a holder that gives way"
        );
        Some(self.graded("hole", message).help(help).at(self.at(line)))
    }
}

/// No block stands in the file of that name.
pub(crate) fn no_program(name: &str) -> Diagnostic {
    let message = "no block stands in the file: it is empty, or no program";
    let help = "name the file that the control reads; it may have been cut off as it was written";
    let place = SourcePlace::new(name, 1, "", 0..0);
    Diagnostic::error("missing", message).help(help).at(Some(place))
}
