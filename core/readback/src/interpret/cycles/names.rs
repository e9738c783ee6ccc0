//! SINUMERIK's drilling cycles: arguments by place, levels absolute.

use post_machine::diagnostic::Diagnostic;

use super::super::spindle_request::SpindleRequest;
use super::hole::{CycleHole, HoleDwell, Pecking, SAME, Withdrawal};
use crate::CycleKind;

/// What the control knows besides the arguments; lengths in mm, feeds in mm/min.
pub(crate) struct CycleContext {
    /// mm in a unit of the program.
    pub unit: f64,
    /// The feed in force.
    pub feed: f64,
    /// Revolutions a minute.
    pub speed: f64,
}

/// The arguments of a call, by place from 1.
struct Arguments<'a> {
    name: &'a str,
    values: &'a [Option<f64>],
    unit: f64,
}

impl Arguments<'_> {
    fn given(&self, place: usize) -> Option<f64> {
        self.values.get(place - 1).copied().flatten()
    }

    fn number(&self, place: usize) -> f64 {
        self.given(place).unwrap_or(0.0)
    }

    fn length(&self, place: usize) -> f64 {
        self.number(place) * self.unit
    }

    fn refuse(&self, what: &str) -> Box<Diagnostic> {
        Diagnostic::error("nc-cycle", format!("{}: {what}", self.name)).boxed()
    }

    /// The depth, absolute or from the reference plane.
    fn depth(
        &self,
        reference: f64,
        absolute: usize,
        relative: usize,
        what: &str,
    ) -> Result<Option<f64>, Box<Diagnostic>> {
        let (absolute, relative) =
            (self.given(absolute), self.given(relative).filter(|way| *way != 0.0));
        let absolute = absolute.map(|level| level * self.unit);
        let relative = relative.map(|way| reference - libm::fabs(way) * self.unit);
        match (absolute, relative) {
            (Some(level), Some(by)) if libm::fabs(level - by) > 1e-6 => Err(self.refuse(&format!(
                "{what} is given twice, absolute {level:.4} and from the reference plane {by:.4}: which holds hangs on the software"
            ))),
            (level, by) => Ok(by.or(level)),
        }
    }

    /// A wait: seconds, or turns of the spindle where it is negative.
    fn wait(&self, place: usize) -> HoleDwell {
        let time = self.number(place);
        HoleDwell { time: libm::fabs(time), revolutions: time < 0.0 }
    }
}

/// Whether the name is that of a cycle that is made here.
pub(crate) fn known(name: &str) -> bool {
    NAMES.contains(&name)
}

const NAMES: [&str; 10] = [
    "CYCLE81", "CYCLE82", "CYCLE83", "CYCLE84", "CYCLE840", "CYCLE85", "CYCLE86", "CYCLE87",
    "CYCLE88", "CYCLE89",
];

/// The hole that a call makes.
///
/// # Errors
/// What is missing, contradictory, or not plain, by name.
pub(crate) fn hole(
    name: &str,
    values: &[Option<f64>],
    around: &CycleContext,
) -> Result<CycleHole, Box<Diagnostic>> {
    let arguments = Arguments { name, values, unit: around.unit };
    let reference = arguments.length(2);
    let bottom = arguments.depth(reference, 4, 5, "the depth")?;
    let bottom = bottom.ok_or_else(|| arguments.refuse("no depth is given"))?;
    let clear = libm::fabs(arguments.length(3));
    let up = bottom > reference;
    let away = arguments.length(1);
    let hole = CycleHole {
        clearance: if up { reference - clear } else { reference + clear },
        surface: Some(reference),
        bottom,
        away,
        feed: around.feed,
        ..CycleHole::default()
    };
    // Levels that are the same come out of different sums.
    let above = away - hole.clearance;
    if libm::fabs(above) > SAME && above * (bottom - hole.clearance) > 0.0 {
        return Err(arguments.refuse(&format!(
            "the retraction plane {away:.4} lies below the level {:.4} where the feed begins",
            hole.clearance
        )));
    }
    made(&arguments, hole, around)
}

fn made(
    arguments: &Arguments<'_>,
    hole: CycleHole,
    around: &CycleContext,
) -> Result<CycleHole, Box<Diagnostic>> {
    let hole = match arguments.name {
        "CYCLE81" | "CYCLE82" => CycleHole { wait: arguments.wait(6), ..hole },
        "CYCLE83" => deep(arguments, hole)?,
        "CYCLE84" => {
            let speed = arguments.given(11).filter(|speed| *speed != 0.0).unwrap_or(around.speed);
            let back = arguments.given(12).filter(|speed| *speed != 0.0).unwrap_or(speed);
            let hole = thread(arguments, hole, 9, [speed, back])?;
            let turning = match hole.kind {
                CycleKind::TapLeft => SpindleRequest::CounterClockwise,
                _ => SpindleRequest::Clockwise,
            };
            CycleHole {
                // The spindle is an axis in the thread: where SDAC does not turn it, it stands.
                turning: Some([turning, behind(arguments, 7).unwrap_or(SpindleRequest::Off)]),
                ..hole
            }
        }
        "CYCLE840" => {
            let hole = thread(arguments, hole, 11, [around.speed; 2])?;
            let turning = match hole.kind {
                CycleKind::TapLeft => SpindleRequest::CounterClockwise,
                _ => SpindleRequest::Clockwise,
            };
            CycleHole { turning: behind(arguments, 8).map(|behind| [turning, behind]), ..hole }
        }
        "CYCLE85" => CycleHole {
            kind: CycleKind::Ream,
            wait: arguments.wait(6),
            feed: feed(arguments, 7, around),
            out: Withdrawal::Feed(feed(arguments, 8, around)),
            ..hole
        },
        "CYCLE86" => {
            let lift = [8, 9, 10].map(|place| arguments.length(place));
            let sense = behind(arguments, 7).filter(|sense| *sense != SpindleRequest::Off);
            let sense = sense.ok_or_else(|| {
                arguments.refuse("which way the spindle turns (SDIR) is not said")
            })?;
            CycleHole {
                turning: Some([sense, SpindleRequest::Oriented]),
                kind: match lift == [0.0; 3] {
                    true => CycleKind::Bore,
                    false => CycleKind::BoreFine,
                },
                wait: arguments.wait(6),
                lift,
                ..hole
            }
        }
        "CYCLE87" => CycleHole { kind: CycleKind::Bore, stop: true, ..hole },
        "CYCLE88" => {
            CycleHole { kind: CycleKind::Bore, wait: arguments.wait(6), stop: true, ..hole }
        }
        "CYCLE89" => CycleHole {
            kind: CycleKind::Ream,
            wait: arguments.wait(6),
            out: Withdrawal::Feed(around.feed),
            ..hole
        },
        _ => return Err(arguments.refuse("this cycle is not known")),
    };
    Ok(hole)
}

/// SDAC: what the spindle does when the cycle is over.
fn behind(arguments: &Arguments<'_>, place: usize) -> Option<SpindleRequest> {
    match arguments.given(place) {
        Some(3.0) => Some(SpindleRequest::Clockwise),
        Some(4.0) => Some(SpindleRequest::CounterClockwise),
        Some(5.0) => Some(SpindleRequest::Off),
        _ => None,
    }
}

/// FFR and RFF: without them the feed in force.
fn feed(arguments: &Arguments<'_>, place: usize, around: &CycleContext) -> f64 {
    match arguments.length(place) {
        feed if feed > 0.0 => feed,
        _ => around.feed,
    }
}

/// CYCLE83: FDEP, FDPR, DAM, DTB, DTS, FRF, VARI, AXN, MDEP, VRT, DTD, DIS1 from place 6 on.
fn deep(arguments: &Arguments<'_>, hole: CycleHole) -> Result<CycleHole, Box<Diagnostic>> {
    let reference = hole.surface.unwrap_or(hole.clearance);
    let up = hole.bottom > reference;
    let first = match arguments.depth(reference, 6, 7, "the first depth")? {
        Some(level) => level,
        None => hole.bottom,
    };
    let inside = if up {
        first > reference && first <= hole.bottom
    } else {
        first < reference && first >= hole.bottom
    };
    if !inside {
        return Err(arguments.refuse(&format!(
            "the first depth is {first:.4}: it does not lie between the reference plane {reference:.4} and the bottom {:.4}",
            hole.bottom
        )));
    }
    if arguments.number(13) != 0.0 && arguments.number(13) != 3.0 {
        return Err(arguments.refuse("it drills along another axis than the tool's"));
    }
    let less = arguments.length(8);
    if less < 0.0 {
        return Err(arguments
            .refuse("pecks by a share of the one before (DAM below zero) are not made here"));
    }
    let swarf = arguments.number(12) != 0.0;
    let depth = libm::fabs(hole.bottom - reference);
    // As far above the depth that was reached as the cycle works out by itself: 0.6 mm down to 30 mm, then a fiftieth.
    let ahead = match arguments.length(17) {
        0.0 if depth <= 30.0 => 0.6,
        0.0 => libm::fmin(depth / 50.0, 7.0),
        given => libm::fabs(given),
    };
    let least = match arguments.length(14) {
        0.0 => less,
        least => least,
    };
    let back = match arguments.length(15) {
        0.0 => 1.0,
        back => libm::fabs(back),
    };
    let wait = arguments.wait(9);
    let last = match arguments.given(16) {
        Some(time) if time != 0.0 => arguments.wait(16),
        _ => wait,
    };
    let share = match arguments.number(11) {
        share if share > 0.0 => share,
        _ => 1.0,
    };
    Ok(CycleHole {
        kind: match swarf {
            true => CycleKind::Deep,
            false => CycleKind::BreakChip,
        },
        first_share: Some(share),
        wait: last,
        pecks: Some(Pecking {
            first: libm::fabs(first - reference),
            less,
            least: if less == 0.0 { libm::fabs(first - reference) } else { least },
            halved: less != 0.0,
            out_after: u32::from(swarf),
            back: if swarf { 0.0 } else { back },
            ahead,
            wait,
            wait_out: arguments.wait(10),
            ..Pecking::default()
        }),
        ..hole
    })
}

/// CYCLE84 and CYCLE840: the pitch by value at `pitch`, by size in front of it.
fn thread(
    arguments: &Arguments<'_>,
    hole: CycleHole,
    pitch: usize,
    [speed, back]: [f64; 2],
) -> Result<CycleHole, Box<Diagnostic>> {
    let value = arguments.number(pitch);
    let value = match arguments.number(pitch - 1) {
        size if value == 0.0 && size != 0.0 => {
            return Err(arguments.refuse(&format!(
                "the pitch is that of a thread M{}: give it by value",
                libm::fabs(size)
            )));
        }
        _ => value,
    };
    if value == 0.0 {
        return Err(arguments.refuse("no pitch is given"));
    }
    if arguments.unit != 1.0 {
        return Err(arguments
            .refuse("in which unit the pitch counts in a program in inches is not settled"));
    }
    if speed <= 0.0 {
        return Err(
            arguments.refuse("no speed of the spindle is known, and the feed follows from it")
        );
    }
    Ok(CycleHole {
        kind: match value > 0.0 {
            true => CycleKind::Tap,
            false => CycleKind::TapLeft,
        },
        wait: arguments.wait(6),
        feed: libm::fabs(value) * speed,
        own_feed: true,
        out: Withdrawal::Thread(libm::fabs(value) * back),
        ..hole
    })
}

#[cfg(test)]
mod tests {
    use super::super::hole::HoleStroke;
    use super::*;

    const AROUND: CycleContext = CycleContext { unit: 1.0, feed: 120.0, speed: 500.0 };

    fn strokes(name: &str, values: &[Option<f64>]) -> Vec<HoleStroke> {
        hole(name, values, &AROUND).unwrap().strokes(100.0).unwrap()
    }

    #[test]
    fn levels_are_absolute() {
        use HoleStroke::{Feed, Rapid};
        let levels = [Some(10.0), Some(1.5), Some(2.0), Some(-11.0)];
        assert_eq!(strokes("CYCLE81", &levels), [Rapid(3.5), Feed(-11.0, 120.0), Rapid(10.0)]);
        // Depth from the reference plane, without a sign.
        let levels = [Some(10.0), Some(1.5), Some(2.0), None, Some(12.5)];
        assert_eq!(strokes("CYCLE81", &levels), [Rapid(3.5), Feed(-11.0, 120.0), Rapid(10.0)]);
    }

    #[test]
    fn a_depth_given_twice_is_refused() {
        let levels = [Some(10.0), Some(0.0), Some(2.0), Some(-11.0), Some(12.0)];
        assert!(hole("CYCLE81", &levels, &AROUND).is_err());
    }

    #[test]
    fn pecks_count_from_the_reference_plane() {
        use HoleStroke::{Feed, Rapid};
        let values = [2.0, 0.0, 2.0, -20.0, f64::NAN, f64::NAN, 6.0, 0.0, 0.0, 0.0, 1.0, 1.0];
        let values = values.map(|value: f64| (!value.is_nan()).then_some(value));
        let wanted = [
            Rapid(2.0),
            Feed(-6.0, 120.0),
            Rapid(2.0),
            Rapid(-5.4),
            Feed(-12.0, 120.0),
            Rapid(2.0),
            Rapid(-11.4),
            Feed(-18.0, 120.0),
            Rapid(2.0),
            Rapid(-17.4),
            Feed(-20.0, 120.0),
            Rapid(2.0),
        ];
        assert_eq!(strokes("CYCLE83", &values), wanted);
    }

    #[test]
    fn a_thread_needs_its_pitch() {
        use HoleStroke::{Rapid, Thread};
        let mut values = vec![
            Some(5.0),
            Some(0.0),
            Some(5.0),
            Some(-15.0),
            None,
            Some(0.0),
            Some(3.0),
            None,
            Some(1.0),
        ];
        let wanted = [Rapid(5.0), Thread(-15.0, 500.0), Thread(5.0, 500.0)];
        assert_eq!(strokes("CYCLE84", &values), wanted);
        values.truncate(7);
        assert!(hole("CYCLE84", &values, &AROUND).is_err());
    }

    #[test]
    fn fine_boring_is_lifted_off_the_wall() {
        use HoleStroke::{Aside, Feed, Rapid};
        let values = [10.0, 0.0, 2.0, -12.5, f64::NAN, 0.0, 3.0, -0.2, 0.0, 0.0, 0.0];
        let values = values.map(|value: f64| (!value.is_nan()).then_some(value));
        let wanted = [
            Rapid(2.0),
            Feed(-12.5, 120.0),
            Aside([-0.2, 0.0, 0.0]),
            Rapid(10.0),
            Aside([0.2, 0.0, 0.0]),
        ];
        assert_eq!(strokes("CYCLE86", &values), wanted);
    }
}
