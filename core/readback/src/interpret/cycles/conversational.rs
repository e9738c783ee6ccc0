//! Heidenhain's cycles of the 200 series: numbered parameters, depths from the surface.

use post_machine::diagnostic::Diagnostic;

use super::hole::{CycleHole, HoleDwell, Pecking, Withdrawal};
use crate::CycleKind;

/// Least feed that is rapid traverse.
const RAPID: f64 = 99_999.0;

/// Distance off the wall of a bored hole, mm.
const OFF_THE_WALL: f64 = 0.2;

/// The parameters of a definition.
pub(crate) struct Parameters<'a> {
    /// Number of the cycle.
    pub cycle: u32,
    /// What each says, as written.
    pub values: &'a [(u32, f64)],
    /// mm in a unit of the program.
    pub unit: f64,
    /// mm/min in a unit of a feed.
    pub feed_unit: f64,
    /// Revolutions a minute.
    pub speed: f64,
}

impl Parameters<'_> {
    fn given(&self, number: u32) -> Option<f64> {
        let mut values = self.values.iter().rev();
        values.find(|(given, _)| *given == number).map(|(_, value)| *value)
    }

    fn needed(&self, number: u32) -> Result<f64, Box<Diagnostic>> {
        self.given(number).ok_or_else(|| self.refuse(&format!("Q{number} is not given")))
    }

    fn length(&self, number: u32) -> Result<f64, Box<Diagnostic>> {
        Ok(self.needed(number)? * self.unit)
    }

    /// A length that older software does not have.
    fn length_or(&self, number: u32, otherwise: f64) -> f64 {
        self.given(number).map_or(otherwise, |value| value * self.unit)
    }

    fn feed(&self, number: u32) -> Result<f64, Box<Diagnostic>> {
        let feed = self.needed(number)?;
        match feed > 0.0 {
            true => Ok(feed * self.feed_unit),
            false => Err(self.refuse(&format!("the feed Q{number} is {feed}"))),
        }
    }

    /// The feed of the way out; 0: as in.
    fn out(&self, down: f64) -> Withdrawal {
        match self.given(208) {
            None => Withdrawal::Rapid,
            Some(feed) if feed >= RAPID => Withdrawal::Rapid,
            Some(feed) if feed > 0.0 => Withdrawal::Feed(feed * self.feed_unit),
            Some(_) => Withdrawal::Feed(down),
        }
    }

    /// Each stands once, none that the cycle has on any software is left out, and there is none that it has on none.
    fn are_of(&self, cycle: &CycleParameters) -> Result<(), Box<Diagnostic>> {
        for (place, (number, _)) in self.values.iter().enumerate() {
            if !cycle.always.contains(number) && !cycle.besides.contains(number) {
                return Err(self.refuse(&format!("Q{number} is no parameter of this cycle")));
            }
            if self.values[..place].iter().any(|(before, _)| before == number) {
                return Err(self.refuse(&format!("Q{number} is given twice")));
            }
        }
        cycle.always.iter().try_for_each(|number| self.needed(*number).map(|_| ()))
    }

    fn wait(&self, number: u32) -> HoleDwell {
        HoleDwell::seconds(self.given(number).unwrap_or(0.0))
    }

    fn refuse(&self, what: &str) -> Box<Diagnostic> {
        Diagnostic::error("nc-cycle", format!("CYCL DEF {}: {what}", self.cycle)).boxed()
    }
}

/// Parameters of a cycle, by their numbers.
struct CycleParameters {
    cycle: u32,
    /// Those that it has on any software: without one of them the control takes the definition for incomplete.
    always: &'static [u32],
    /// Those that some software has.
    besides: &'static [u32],
}

/// The cycles that are made here: TNC 426, iTNC 530 and TNC 640, user's manuals of cycles.
const CYCLES: &[CycleParameters] = &[
    CycleParameters {
        cycle: 200,
        always: &[200, 201, 206, 202, 210, 203, 204],
        besides: &[211, 395],
    },
    CycleParameters { cycle: 201, always: &[200, 201, 206, 208, 203, 204], besides: &[211] },
    CycleParameters {
        cycle: 202,
        always: &[200, 201, 206, 208, 203, 204, 214],
        besides: &[211, 336, 357],
    },
    CycleParameters {
        cycle: 203,
        always: &[200, 201, 206, 202, 210, 203, 204, 212, 213, 205],
        besides: &[211, 208, 256, 395],
    },
    CycleParameters {
        cycle: 205,
        always: &[200, 201, 206, 202, 203, 204, 212, 205, 258, 257],
        besides: &[259, 256, 211, 379, 253, 208, 395],
    },
    CycleParameters { cycle: 206, always: &[200, 201, 206, 203, 204], besides: &[211] },
    CycleParameters { cycle: 207, always: &[200, 201, 239, 203, 204], besides: &[] },
    CycleParameters {
        cycle: 209,
        always: &[200, 201, 239, 203, 204, 257, 256],
        besides: &[336, 403],
    },
    CycleParameters {
        cycle: 240,
        always: &[200, 201, 206, 203, 204],
        besides: &[343, 344, 211, 342, 253],
    },
];

/// The hole that a definition makes; none where its depth is zero, with which the control does nothing.
///
/// # Errors
/// What is missing, contradictory or not plain, by name.
pub(crate) fn hole(parameters: &Parameters<'_>) -> Result<Option<CycleHole>, Box<Diagnostic>> {
    let Some(known) = CYCLES.iter().find(|known| known.cycle == parameters.cycle) else {
        return Err(parameters.refuse("this cycle is not made here"));
    };
    parameters.are_of(known)?;
    let depth = parameters.length(201)?;
    if depth == 0.0 {
        return Ok(None);
    }
    if depth > 0.0 {
        return Err(parameters.refuse(&format!(
            "the depth Q201 is {depth}: a hole upwards is a parameter of the machine"
        )));
    }
    if parameters.given(395).is_some_and(|reference| reference != 0.0) {
        return Err(parameters.refuse(
            "Q395 counts the depth from the cylinder of the drill, and its point is not known",
        ));
    }
    let surface = parameters.length(203)?;
    let clear = libm::fabs(parameters.length(200)?);
    let away = libm::fmax(parameters.length_or(204, 0.0), clear);
    let hole = CycleHole {
        clearance: surface + clear,
        surface: Some(surface),
        bottom: surface + depth,
        away: surface + away,
        wait: parameters.wait(211),
        ..CycleHole::default()
    };
    made(parameters, hole, -depth, clear).map(Some)
}

fn made(
    parameters: &Parameters<'_>,
    hole: CycleHole,
    depth: f64,
    clear: f64,
) -> Result<CycleHole, Box<Diagnostic>> {
    Ok(match parameters.cycle {
        200 => {
            let step = parameters.length_or(202, depth);
            CycleHole {
                kind: match step < depth {
                    true => CycleKind::Deep,
                    false => CycleKind::Drill,
                },
                feed: parameters.feed(206)?,
                pecks: pecks(
                    parameters,
                    step,
                    0.0,
                    Pecking {
                        out_after: 1,
                        ahead: clear,
                        wait_out: parameters.wait(210),
                        ..Pecking::default()
                    },
                )?,
                ..hole
            }
        }
        201 => {
            let feed = parameters.feed(206)?;
            CycleHole {
                kind: CycleKind::Ream,
                feed,
                out: match parameters.out(feed) {
                    Withdrawal::Rapid => Withdrawal::Feed(RAPID),
                    other => other,
                },
                ..hole
            }
        }
        202 => bored(parameters, hole)?,
        203 => universal(parameters, hole, depth, clear)?,
        205 => deep(parameters, hole, depth)?,
        206 => {
            let feed = parameters.feed(206)?;
            CycleHole { kind: CycleKind::Tap, feed, out: Withdrawal::Thread(feed), ..hole }
        }
        207 | 209 => thread(parameters, hole, depth)?,
        _ => {
            if parameters.given(343).is_some_and(|by| by != 0.0) {
                return Err(parameters.refuse(
                    "Q343 counts by the diameter, and the point of the tool is not known",
                ));
            }
            CycleHole { feed: parameters.feed(206)?, ..hole }
        }
    })
}

fn bored(parameters: &Parameters<'_>, hole: CycleHole) -> Result<CycleHole, Box<Diagnostic>> {
    let feed = parameters.feed(206)?;
    let off = OFF_THE_WALL;
    let lift = match parameters.given(214).unwrap_or(0.0) {
        0.0 => [0.0; 3],
        1.0 => [-off, 0.0, 0.0],
        2.0 => [0.0, -off, 0.0],
        3.0 => [off, 0.0, 0.0],
        4.0 => [0.0, off, 0.0],
        other => {
            return Err(parameters.refuse(&format!("the direction Q214 is {other}, which is none")));
        }
    };
    Ok(CycleHole {
        kind: match lift == [0.0; 3] {
            true => CycleKind::Bore,
            false => CycleKind::BoreFine,
        },
        feed,
        out: parameters.out(feed),
        lift,
        ..hole
    })
}

fn universal(
    parameters: &Parameters<'_>,
    hole: CycleHole,
    depth: f64,
    clear: f64,
) -> Result<CycleHole, Box<Diagnostic>> {
    let feed = parameters.feed(206)?;
    let breaks = parameters.given(213).unwrap_or(0.0);
    let step = parameters.length_or(202, depth);
    let out = parameters.out(feed);
    // After so many breaks the tool comes out; with none after each.
    let out_after = if breaks > 0.0 { libm::fmin(libm::round(breaks), 1e6) as u32 } else { 1 };
    let least = parameters.length_or(205, 0.0);
    Ok(CycleHole {
        kind: match (step < depth, out_after > 1) {
            (false, _) => CycleKind::Drill,
            (true, true) => CycleKind::BreakChip,
            (true, false) => CycleKind::Deep,
        },
        feed,
        out,
        pecks: pecks(
            parameters,
            step,
            least,
            Pecking {
                out_after,
                out_feed: match out {
                    Withdrawal::Feed(feed) => Some(feed),
                    _ => None,
                },
                back: parameters.length_or(256, OFF_THE_WALL),
                ahead: clear,
                wait_out: parameters.wait(210),
                ..Pecking::default()
            },
        )?,
        ..hole
    })
}

fn deep(
    parameters: &Parameters<'_>,
    hole: CycleHole,
    depth: f64,
) -> Result<CycleHole, Box<Diagnostic>> {
    if parameters.given(379).is_some_and(|start| start != 0.0) {
        return Err(parameters.refuse("Q379: a hole that begins deeper is not made here"));
    }
    let breaks = parameters.length_or(257, 0.0);
    let step = parameters.length_or(202, depth);
    if breaks > 0.0 && breaks < libm::fmin(step, depth) && step < depth {
        return Err(parameters
            .refuse("Q257 with Q202: chips that are broken between pecks are not made here"));
    }
    let feed = parameters.feed(206)?;
    let breaking = breaks > 0.0 && breaks < depth && step >= depth;
    Ok(CycleHole {
        kind: if breaking { CycleKind::BreakChip } else { CycleKind::Deep },
        feed,
        out: parameters.out(feed),
        pecks: pecks(
            parameters,
            if breaking { breaks } else { step },
            parameters.length_or(205, 0.0),
            Pecking {
                out_after: u32::from(!breaking),
                back: parameters.length_or(256, OFF_THE_WALL),
                ahead: parameters.length_or(258, OFF_THE_WALL),
                ..Pecking::default()
            },
        )?,
        ..hole
    })
}

fn thread(
    parameters: &Parameters<'_>,
    hole: CycleHole,
    depth: f64,
) -> Result<CycleHole, Box<Diagnostic>> {
    let pitch = parameters.length(239)?;
    if pitch == 0.0 {
        return Err(parameters.refuse("the pitch Q239 is zero"));
    }
    if parameters.speed <= 0.0 {
        return Err(
            parameters.refuse("no speed of the spindle is known, and the feed follows from it")
        );
    }
    let feed = libm::fabs(pitch) * parameters.speed;
    let breaks = parameters.length_or(257, 0.0);
    let back = parameters.given(256).unwrap_or(0.0);
    let pecked = parameters.cycle == 209 && breaks > 0.0 && breaks < depth;
    Ok(CycleHole {
        kind: match pitch > 0.0 {
            true => CycleKind::Tap,
            false => CycleKind::TapLeft,
        },
        feed,
        out: Withdrawal::Thread(feed),
        pecks: pecked.then_some(Pecking {
            first: breaks,
            least: breaks,
            // Turns of the pitch; none: all the way out.
            out_after: u32::from(back == 0.0),
            back: back * libm::fabs(pitch),
            thread: true,
            ..Pecking::default()
        }),
        ..hole
    })
}

/// Pecks of `step`, each less by Q212, no less than `least`.
fn pecks(
    parameters: &Parameters<'_>,
    step: f64,
    least: f64,
    pecks: Pecking,
) -> Result<Option<Pecking>, Box<Diagnostic>> {
    if step <= 0.0 {
        // Q202 = 0 is the whole depth only with some software.
        return Err(parameters.refuse(&format!("the plunging depth is {step}")));
    }
    let less = parameters.length_or(212, 0.0);
    Ok(Some(Pecking { first: step, less, least: if less == 0.0 { step } else { least }, ..pecks }))
}

#[cfg(test)]
mod tests {
    use super::super::hole::HoleStroke;
    use super::*;

    fn strokes(cycle: u32, values: &[(u32, f64)]) -> Vec<HoleStroke> {
        let parameters = Parameters { cycle, values, unit: 1.0, feed_unit: 1.0, speed: 500.0 };
        hole(&parameters).unwrap().unwrap().strokes(50.0).unwrap()
    }

    const LEVELS: [(u32, f64); 4] = [(200, 2.0), (201, -20.0), (203, 1.0), (204, 10.0)];

    #[test]
    fn depths_count_from_the_surface() {
        use HoleStroke::{Feed, Rapid, Wait as Dwell};
        let more = [(206, 300.0), (202, 8.0), (210, 0.0), (211, 0.2), (395, 0.0)];
        let wanted = [
            Rapid(3.0),
            Feed(-7.0, 300.0),
            Rapid(3.0),
            Rapid(-5.0),
            Feed(-15.0, 300.0),
            Rapid(3.0),
            Rapid(-13.0),
            Feed(-19.0, 300.0),
            Dwell(HoleDwell::seconds(0.2)),
            Rapid(11.0),
        ];
        assert_eq!(strokes(200, &[&LEVELS[..], &more].concat()), wanted);
    }

    #[test]
    fn chips_are_broken_as_often_as_it_says() {
        use HoleStroke::{Feed, Rapid};
        let more = [
            (206, 250.0),
            (202, 8.0),
            (210, 0.0),
            (212, 0.0),
            (213, 3.0),
            (205, 0.0),
            (208, 99_999.0),
            (256, 0.2),
        ];
        let wanted = [
            Rapid(3.0),
            Feed(-7.0, 250.0),
            Rapid(-6.8),
            Feed(-15.0, 250.0),
            Rapid(-14.8),
            Feed(-19.0, 250.0),
            Rapid(11.0),
        ];
        assert_eq!(strokes(203, &[&LEVELS[..], &more].concat()), wanted);
    }

    #[test]
    fn a_thread_goes_by_its_pitch() {
        use HoleStroke::{Rapid, Thread};
        let wanted = [Rapid(3.0), Thread(-19.0, 625.0), Thread(3.0, 625.0), Rapid(11.0)];
        assert_eq!(strokes(207, &[&LEVELS[..], &[(239, -1.25)]].concat()), wanted);
    }

    #[test]
    fn what_hangs_on_the_tools_point_is_refused() {
        let refused = |cycle: u32, more: &[(u32, f64)]| {
            let values = [&LEVELS[..], more].concat();
            let parameters =
                Parameters { cycle, values: &values, unit: 1.0, feed_unit: 1.0, speed: 500.0 };
            hole(&parameters).is_err()
        };
        assert!(refused(240, &[(206, 12.0), (343, 1.0)]));
        assert!(refused(200, &[(206, 12.0), (202, 5.0), (395, 1.0)]));
        assert!(refused(204, &[(206, 12.0)]));
        assert!(refused(207, &[]));
    }
}
