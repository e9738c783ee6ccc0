//! The words of a control and what they mean, from its table and the options.

use std::borrow::Cow;

use post_plugin::{Cycle, Meaning, VocabularyWord};

use crate::engine::Engine;
use crate::table::{CycleReturn, Dwell, Plane, Rigid, SplineForm, Tcp};

/// Words that all controls of the family share, where the table says nothing else of them.
const SHARED: &[(&str, Meaning)] = &[
    ("(", Meaning::RemarkOpen),
    (")", Meaning::RemarkClose),
    ("N", Meaning::BlockNumber),
    ("%", Meaning::Nothing),
    ("G90", Meaning::Absolute),
    ("G91", Meaning::Incremental),
    ("I", Meaning::CentreX),
    ("J", Meaning::CentreY),
    ("K", Meaning::CentreZ),
    ("R", Meaning::Radius),
    ("F", Meaning::Feed),
    ("T", Meaning::Tool),
    ("S", Meaning::SpindleSpeed),
    ("G4", Meaning::Dwell),
    ("G80", Meaning::CycleOff),
    ("M7", Meaning::CoolantOn),
    ("M8", Meaning::CoolantOn),
    ("M9", Meaning::CoolantOff),
    ("M2", Meaning::End),
    ("M30", Meaning::End),
];

/// Words of controls whose cycles return by codes.
const CYCLES: &[(&str, Meaning)] =
    &[("G98", Meaning::ReturnStart), ("G99", Meaning::ReturnClearance)];

/// Meanings of the words of a list, in its order.
fn each<'a>(
    words: &'a [&'static str],
    meanings: &'a [Meaning],
) -> impl Iterator<Item = (&'static str, Meaning)> {
    words.iter().copied().zip(meanings.iter().copied())
}

impl Engine {
    /// The words of this control, those that the options have changed among them.
    pub(crate) fn vocabulary(&self) -> Vec<VocabularyWord> {
        use Meaning as M;
        let table = self.table;
        let own = table.words.iter().flat_map(|group| group.iter());
        let mut words: Vec<(Cow<'static, str>, Meaning)> =
            own.map(|(word, meaning)| (Cow::Borrowed(*word), *meaning)).collect();
        let mut add = |word: &str, meaning: Meaning| {
            // Without the number after it, nor the name that it is the value of: `G169 HL={h}`.
            let word = word.split('{').next().unwrap_or("").trim();
            let word = match word.strip_suffix('=') {
                Some(named) => named.rsplit_once(' ').map_or(named, |(word, _)| word),
                None => word,
            };
            if !word.is_empty() && !words.iter().any(|(known, _)| known == word) {
                words.push((word.to_owned().into(), meaning));
            }
        };
        self.mode_words(&mut add);
        self.position_words(&mut add);
        self.wait_and_cycle_words(&mut add);
        if !table.cycles.is_empty() && table.cycle_return == CycleReturn::Codes {
            CYCLES.iter().for_each(|(word, meaning)| add(word, *meaning));
        }
        add(table.probe, M::Probe);
        add(first(table.subprogram.number), M::Subprogram);
        add(table.end, M::End);
        self.own_words(&mut add);
        SHARED.iter().for_each(|(word, meaning)| add(word, *meaning));
        // What changes the tool may be what stops the program: M0 of a machine without a changer.
        for word in self.change.split_whitespace() {
            let change = (Cow::Owned(word.to_owned()), M::ToolChange);
            if !words.contains(&change) {
                words.push(change);
            }
        }
        let words = words.into_iter();
        words.map(|(word, meaning)| VocabularyWord { word, meaning }).collect()
    }

    /// Adds the words of units, motion, planes, feed, compensation, stops and spindle.
    fn mode_words(&self, add: &mut dyn FnMut(&str, Meaning)) {
        use Meaning as M;
        let table = self.table;
        let codes = &self.motion.codes;
        if let Some((letter, _)) = table.title {
            add(letter, M::Nothing);
        }
        let per_minute = match table.feed_all_axes {
            true => M::FeedPerMinuteAllAxes,
            false => M::FeedPerMinute,
        };
        let feeds = [per_minute, M::InverseTime, M::FeedPerRevolution];
        let listed = each(&codes.units, &[M::Millimetre, M::Inch])
            .chain(each(&codes.motion, &[M::Rapid, M::Linear]))
            .chain(each(&codes.arc, &[M::ArcClockwise, M::ArcCounterClockwise]))
            .chain(each(&codes.planes, &[M::PlaneXy, M::PlaneZx, M::PlaneYz]))
            .chain(each(&codes.feed, &feeds))
            .chain(each(
                &codes.compensation,
                &[M::CompensationOff, M::CompensationLeft, M::CompensationRight],
            ))
            .chain(each(&codes.stop, &[M::Stop, M::OptionalStop]))
            .chain(each(
                &table.spindle,
                &[M::SpindleClockwise, M::SpindleCounterClockwise, M::SpindleOff, M::SpindleOrient],
            ));
        for (word, meaning) in listed {
            add(word, meaning);
        }
        if !codes.compensation[1].is_empty() {
            add(codes.radius, M::RadiusRegister);
        }
    }

    /// Adds the words of machine coordinates, length, offsets, planes and splines.
    fn position_words(&self, add: &mut dyn FnMut(&str, Meaning)) {
        use Meaning as M;
        let table = self.table;
        match table.machine_off {
            "" => add(first(table.machine), M::MachineCoordinates),
            off => {
                add(table.machine, M::MachineCoordinatesOn);
                add(off, M::MachineCoordinatesOff);
            }
        }
        match table.length.is_register() {
            true => add(table.length.on, M::LengthRegister),
            false => add(table.length.on, M::LengthOn),
        }
        add(table.length.off, M::LengthOff);
        if !table.length.on.is_empty() {
            add(table.length.register, M::LengthRegister);
        }
        if let Tcp::Length(word) = table.tcp {
            add(word, M::TcpOn);
            add(table.vector, M::TcpVectorOn);
        }
        for number in 1..=MOST_OFFSETS {
            let Some(word) = (table.offset.word)(number) else {
                break;
            };
            // `G159` of `G159=7`.
            add(first(&word).split('=').next().unwrap_or(""), M::WorkOffset);
        }
        match self.plane.words() {
            Plane::None | Plane::Turns { .. } => {}
            Plane::Turned { on, off } => {
                add(on, M::TiltedPlane);
                add(off, M::TiltedPlaneOff);
            }
            Plane::Euler { on, turn, off } => {
                add(on, M::TiltedPlane);
                add(turn, M::TiltedPlaneTurn);
                add(off, M::TiltedPlaneOff);
            }
        }
        if let Plane::Turns { on, off, .. } = self.plane.words() {
            for (lines, meaning) in [(on, M::TiltedPlane), (off, M::TiltedPlaneOff)] {
                let own = lines.lines().filter(|line| !line.starts_with('{'));
                own.for_each(|line| add(line.split('[').next().unwrap_or(""), meaning));
            }
        }
        match table.splines {
            SplineForm::None => {}
            SplineForm::Knots { code, .. } | SplineForm::Even { code, .. } => add(code, M::Spline),
        }
    }

    /// Adds the words of waits, cutting speed and cycles.
    fn wait_and_cycle_words(&self, add: &mut dyn FnMut(&str, Meaning)) {
        use Meaning as M;
        let table = self.table;
        match table.dwell {
            Dwell::Milliseconds(letter) => add(&format!("G4 {letter}"), M::DwellMilliseconds),
            Dwell::Seconds(letter, _) => add(&format!("G4 {letter}"), M::DwellSeconds),
        }
        if let Some(surface) = table.surface {
            let [on, off] = surface.codes;
            add(on, M::SurfaceSpeed);
            add(off, M::SurfaceSpeedOff);
            match surface.most.len() {
                // A letter alone belongs to the word of the cutting speed.
                1 => add(&format!("{on} {}", surface.most), M::SurfaceSpeed),
                _ => add(surface.most, M::SpeedLimit),
            }
        }
        for code in self.cycles.codes() {
            for word in [code.plain, code.waits] {
                add(first(word), cycle(code.kind));
            }
        }
        match table.rigid {
            Rigid::Always => {}
            Rigid::Ahead(word) | Rigid::Alone(word) => add(word, M::Nothing),
            Rigid::Beside(word) => {
                add(word.trim_end_matches(|c: char| c.is_ascii_digit()), M::Nothing)
            }
            Rigid::Codes { codes: [right, left], pitch } => {
                for (word, meaning) in [(right, M::CycleTap), (left, M::CycleTapLeft)] {
                    add(word, meaning);
                    if !word.is_empty() {
                        add(&format!("{word} {pitch}"), meaning);
                    }
                }
            }
            Rigid::Move(word) => add(word, M::ThreadAndBack),
        }
    }
}

/// More than any control has.
const MOST_OFFSETS: u32 = 1000;

/// The first of several words: the number or the axis behind it is not its own.
fn first(words: &str) -> &str {
    words.split_whitespace().next().unwrap_or("")
}

/// What a cycle's code means.
const fn cycle(kind: Cycle) -> Meaning {
    match kind {
        Cycle::Drill => Meaning::CycleDrill,
        Cycle::Deep => Meaning::CycleDeep,
        Cycle::BreakChip => Meaning::CycleBreakChip,
        Cycle::Tap => Meaning::CycleTap,
        Cycle::TapLeft => Meaning::CycleTapLeft,
        Cycle::Ream => Meaning::CycleReam,
        Cycle::Bore => Meaning::CycleBore,
        Cycle::BoreFine => Meaning::CycleBoreFine,
        Cycle::BoreBack => Meaning::CycleBoreBack,
    }
}
