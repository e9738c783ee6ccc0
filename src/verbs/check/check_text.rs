//! The check as text: a heading a matter, for a builder who stands beside the machine.

use std::fmt::Write as _;

use post_job::summary::warnings;
use post_job::text_table::NamedValues;
use post_machine::check::{
    AxisLine, AxisReadout, Check, Comparison, DifferenceShare, DirectionSolutions, ErrorsReport,
    LegsReport, LimitReport, LimitRoom, MachineClass, Pole, ReachableCone, Sign, Volume, number,
};

/// Width of the names.
const NAME: usize = 17;

/// The whole check.
pub fn check(check: &Check) -> String {
    let mut rows = NamedValues::default();
    rows.row("machine", &check.machine);
    for line in &check.not_known {
        rows.row("not known", line);
    }
    class(&mut rows, &check.class);
    rows.row("solved", &check.solved);
    rows.row_if("leaves the part", check.leaves.as_ref());
    for told in &check.control {
        rows.row("control", told);
    }
    let mut text = format!("{}\n{}\n", rows.lines(NAME), axes(&check.class.axes).lines(NAME));
    signs(&mut text, &check.signs);
    let mut rows = NamedValues::default();
    for axis in &check.class.axes {
        rows.row_if("set between cuts", axis.set_between_cuts.as_ref());
    }
    if let Some(typical) = &check.typical {
        solutions(&mut rows, typical);
    }
    reach(&mut rows, &check.reach);
    rows.row("singular", &check.poles.told);
    for at in &check.poles.at {
        rows.row("", pole(at));
    }
    for (index, moved) in check.words.iter().enumerate() {
        let name = if index == 0 { "words" } else { "" };
        let by = number(moved.by, 3);
        rows.row(name, format_args!("{} +{by} by itself: {}", moved.axis, moved.words));
    }
    rows.row_if("X", check.radius.as_ref());
    for limit in &check.limits {
        dependent_limit(&mut rows, limit);
    }
    if let Some(of_machine) = &check.errors {
        errors(&mut rows, of_machine);
    }
    if let Some(of_machine) = &check.legs {
        legs(&mut rows, of_machine);
    }
    if let Some(space) = &check.volume {
        volume(&mut rows, space, check.tool_length_mm);
    }
    let trip = &check.round_trip;
    rows.row(
        "round trip",
        format_args!(
            "{} random poses{}, {} solutions: tip off by at most {:.1e} mm, tool axis by {:.1e} rad",
            trip.poses,
            match trip.not_found {
                0 => String::new(),
                count => format!(", {count} not found"),
            },
            trip.solutions,
            trip.tip_mm,
            trip.axis_rad
        ),
    );
    rows.row("warnings", warnings(check.warnings.len()));
    text.push_str(&rows.lines(NAME));
    text
}

fn class(rows: &mut NamedValues, class: &MachineClass) {
    let list = |names: &[String]| match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    rows.row("chain", &class.chain);
    rows.row("class", &class.name);
    rows.row("turn the tool", list(&class.turn_the_tool));
    rows.row("carry the part", list(&class.carry_the_part));
    rows.row("carry the tool", list(&class.carry_the_tool));
    for angle in &class.angles {
        rows.row(
            "angle",
            format_args!("{} to {}: {}°", angle.from, angle.to, number(angle.value, 5)),
        );
    }
    for distance in &class.distances {
        rows.row(
            "distance",
            format_args!(
                "line of {} to {}: {} mm",
                distance.from,
                match distance.to.as_str() {
                    "gauge point" => "the gauge point".to_owned(),
                    axis => format!("line of {axis}"),
                },
                number(distance.value, 4)
            ),
        );
    }
}

fn axes(axes: &[AxisLine]) -> NamedValues {
    let mut rows = NamedValues::default();
    rows.row("axis", "kind    direction                         travel");
    for axis in axes {
        let [x, y, z] = axis
            .direction
            .map(|number| format!("{:.6}", number + 0.0).replace("-0.000000", "0.000000"));
        let (kind, unit) = match axis.rotary {
            true => ("rotary", "°"),
            false => ("linear", " mm"),
        };
        let mut line = format!("{kind}  {:<34}", format!("{x} {y} {z}"));
        line.push_str(&match axis.travel {
            Some([least, most]) => format!("{} to {}{unit}", number(least, 3), number(most, 3)),
            None => "endless".to_owned(),
        });
        if let Some(at) = axis.indexed {
            let _ = write!(line, ", set between cuts, starts at {}{unit}", number(at, 3));
        }
        if let Some(feed) = axis.max_feed {
            let _ = write!(line, ", at most {}{}/min", number(feed, 1), unit);
        }
        let prime = if axis.carries_part { "'" } else { "" };
        rows.row(format_args!("{}{prime}", axis.name), line);
    }
    rows
}

fn signs(text: &mut String, signs: &[Sign]) {
    text.push_str(
        "Signs: each axis moved by itself, all others at rest. +X, +Y, +Z are those of the machine frame, Z along the\n\
         spindle; seen from +Z is from above where the spindle is upright. Compare with the machine, line by line.\n",
    );
    let _ =
        writeln!(text, "  {:<10}{:<38}  what the eye sees", "move", "the tool, seen from the part");
    for sign in signs {
        let by = number(sign.by, 3);
        let plus = if sign.by > 0.0 { "+" } else { "" };
        let _ = writeln!(
            text,
            "  {:<10}{:<38}  {}",
            format!("{} {plus}{by}", sign.axis),
            sign.tool,
            sign.seen
        );
    }
    text.push('\n');
}

fn solutions(rows: &mut NamedValues, found: &DirectionSolutions) {
    let plural = |count: usize, word: &str| match count {
        1 => format!("1 {word}"),
        count => format!("{count} {word}s"),
    };
    rows.row(
        "solutions",
        format_args!(
            "for the tool tilted {}° towards azimuth {}°: {}{}, {} inside travel",
            number(found.tilt_deg, 2),
            number(found.azimuth_deg, 2),
            match found.at_least {
                true => "at least ",
                false => "",
            },
            plural(found.ways.len(), "way"),
            plural(found.inside, "solution"),
        ),
    );
    for way in &found.ways {
        rows.row(
            "",
            format_args!(
                "{}: {}",
                readings(&way.readings),
                match way.turns {
                    _ if !way.has_positions => "no position of an index axis".to_owned(),
                    0 => "out of travel".to_owned(),
                    1 => "inside travel".to_owned(),
                    turns => format!("{turns} full turns inside travel"),
                }
            ),
        );
    }
}

fn reach(rows: &mut NamedValues, reach: &ReachableCone) {
    let tilt = |tilt: Option<f64>| {
        tilt.map_or("not even +Z".to_owned(), |tilt| format!("{}°", number(tilt, 2)))
    };
    if reach.tied_to_the_tip {
        let told = "the direction of the tool depends on the point: with the tip kept it cannot turn every way";
        rows.row("reach", told);
        return;
    }
    if reach.freedom < 2 {
        let told = match (reach.freedom, reach.single_directions) {
            (_, Some(count)) => format!(
                "{count} single directions, tilted up to {} from +Z",
                tilt(reach.tilt_in_some_azimuth_deg)
            ),
            (0, _) => format!(
                "one direction alone, tilted {} from +Z",
                tilt(reach.tilt_in_some_azimuth_deg)
            ),
            _ => format!(
                "a curve of directions, tilted up to {} from +Z",
                tilt(reach.tilt_in_some_azimuth_deg)
            ),
        };
        rows.row("reach", &told);
        return;
    }
    let mut told = format!(
        "{} % of all directions; tilt from +Z in all azimuths: {}; largest in some: {}",
        number(100.0 * reach.share_of_sphere, 1),
        tilt(reach.tilt_in_all_azimuths_deg),
        tilt(reach.tilt_in_some_azimuth_deg),
    );
    if let (Some(azimuth), true) = (
        reach.azimuth_of_largest_tilt_deg,
        reach.tilt_in_all_azimuths_deg != reach.tilt_in_some_azimuth_deg,
    ) {
        let _ = write!(told, " (azimuth {}°)", number(azimuth, 0));
    }
    rows.row("reach", &told);
    if !reach.within.is_empty() {
        let limits: Vec<String> = reach.within.iter().map(|limit| format!("`{limit}`")).collect();
        rows.row("", format_args!("where {} holds", limits.join(", ")));
    }
    if let Some(grid) = reach.searched_every_deg {
        let told = format!(
            "searched with the tip on the part origin, every {}°: at least so much",
            number(grid, 1)
        );
        rows.row("", &told);
        return;
    }
    if !reach.at_positions_alone.is_empty() {
        let told = format!(
            "of these only what the positions of {} give",
            reach.at_positions_alone.join(" and ")
        );
        rows.row("", &told);
    }
    if reach.share_of_sphere > 0.0 {
        let each: Vec<String> = reach
            .shares_by_solutions
            .iter()
            .enumerate()
            .filter(|(_, share)| **share > 0.0)
            .map(|(count, share)| format!("{count} in {} %", number(100.0 * share, 1)))
            .collect();
        rows.row("solutions inside", format_args!("of all directions: {}", each.join(", ")));
    }
}

fn pole(pole: &Pole) -> String {
    let [x, y, z] = pole.axis.map(|value| number(value, 6));
    let others = match pole.others.as_slice() {
        [] => String::new(),
        others => format!(", with {}", readings(others)),
    };
    let state = if pole.missed_by_deg > 0.0 {
        format!("out of reach by {}°", number(pole.missed_by_deg, 4))
    } else if !pole.has_positions {
        "no position of an index axis".to_owned()
    } else if pole.inside {
        "inside travel".to_owned()
    } else {
        "out of travel".to_owned()
    };
    format!("({x}, {y}, {z}){others}: {state}")
}

fn dependent_limit(rows: &mut NamedValues, limit: &LimitReport) {
    rows.row("limit", &limit.keep);
    for LimitRoom { with, room } in &limit.rooms {
        let with = match with {
            Some(other) => format!("{} {}: ", other.axis, number(other.value, 3)),
            None => String::new(),
        };
        let room = match room {
            Some([least, most]) => {
                format!("{} to {} {}", number(*least, 3), number(*most, 3), limit.unit)
            }
            None => "nowhere".to_owned(),
        };
        rows.row("", format_args!("{with}{} {room}", limit.axis));
    }
}

fn errors(rows: &mut NamedValues, of_machine: &ErrorsReport) {
    for axis in &of_machine.axes {
        let [least, most] = axis.known.map(|end| number(end, 3));
        rows.row(format!("errors of {}", axis.axis), format_args!("known from {least} to {most}"));
        axis.largest.iter().for_each(|told| rows.row("", told));
    }
    let [x, y, z] = of_machine.tip.map(|value| number(value, 5));
    let together = match of_machine.tip_at.as_slice() {
        [] => "the tip stands nowhere off".to_owned(),
        at => format!(
            "the tip stands up to {} mm off, ({x}, {y}, {z}), at {}: posted words take it out",
            number(of_machine.tip_mm, 5),
            readings(at)
        ),
    };
    rows.row("errors together", together);
    if of_machine.axis_deg > 0.0 {
        let angle = number(of_machine.axis_deg, 5);
        let stays = match of_machine.axis_stays {
            true => "which stays",
            false => "of which posted words take out what the axes can",
        };
        rows.row("", format_args!("the tool axis leans up to {angle}° off, {stays}"));
    }
}

fn legs(rows: &mut NamedValues, of_machine: &LegsReport) {
    for leg in &of_machine.legs {
        let at_rest = match leg.at_rest {
            Some(value) => format!(", at rest {} {}", number(value, 3), leg.unit),
            None => ", out of reach at rest".to_owned(),
        };
        rows.row(format!("leg {}", leg.name).as_str(), format_args!("+: {}{at_rest}", leg.plus));
        if !leg.changes.is_empty() {
            rows.row("", format_args!("by 1 mm or degree of an axis: {}", leg.changes));
        }
        let ends = |ends: Option<[f64; 2]>| match ends {
            Some([least, most]) => {
                format!("{} to {} {}", number(least, 3), number(most, 3), leg.unit)
            }
            None => "nowhere".to_owned(),
        };
        let travel = leg.travel.map_or("without end".to_owned(), |travel| ends(Some(travel)));
        rows.row("", format_args!("goes {} inside travel, its own is {travel}", ends(leg.room)));
    }
    let share = 100.0 * of_machine.share_of_travel;
    rows.row("legs reach", format_args!("{} % of the travel of the axes", number(share, 1)));
    rows.row("assembly", &of_machine.assembly);
    rows.row("drives to axes", &of_machine.back);
}

fn volume(rows: &mut NamedValues, volume: &Volume, length: f64) {
    let limits: Vec<String> = volume.limited_by.iter().map(|limit| format!("`{limit}`")).collect();
    let within = limits.join(", ");
    let (Some(least), Some(most)) = (volume.least, volume.most) else {
        if !within.is_empty() {
            rows.row(
                "travel of the tip",
                format_args!("none that was found: {within} leaves nothing"),
            );
        }
        return;
    };
    let [x, y, z] = volume.axis.map(|value| number(value, 5));
    let rotary = match volume.rotary.as_slice() {
        [] => String::new(),
        rotary => format!(", {}", readings(rotary)),
    };
    rows.row(
        "travel of the tip",
        format_args!(
            "part frame, tool along ({x}, {y}, {z}){rotary}, {} mm long:",
            number(length, 3)
        ),
    );
    let spans = ["X", "Y", "Z"].iter().enumerate().map(|(index, name)| {
        format!("{name} {} to {}", number(least[index], 3), number(most[index], 3))
    });
    rows.row("", format_args!("{} mm", spans.collect::<Vec<_>>().join(", ")));
    if !within.is_empty() {
        rows.row("", format_args!("as far as what must hold between the axes leaves it: {within}"));
    }
    if let Some(open) = volume.open_mm {
        let open = number(open, 3);
        rows.row("", format_args!("found so; up to {open} mm more at an end is not ruled out"));
    }
}

fn readings(readings: &[AxisReadout]) -> String {
    let each =
        readings.iter().map(|reading| format!("{} {}", reading.axis, number(reading.value, 3)));
    each.collect::<Vec<_>>().join(" ")
}

/// The comparison of two files.
pub fn comparison(compared: &Comparison) -> String {
    let mut rows = NamedValues::default();
    rows.row(
        "compared",
        format_args!(
            "{} with {} at equal words, tool {} mm long",
            compared.machine,
            compared.nominal,
            number(compared.tool_length_mm, 3)
        ),
    );
    let [x, y, z] = compared.tip.map(|value| number(value, 5));
    rows.row(
        "tip deviation",
        format_args!("at most {:.5} mm: ({x}, {y}, {z}) in the part frame", compared.tip_mm),
    );
    rows.row("", format_args!("at {}", readings(&compared.tip_at)));
    shares(&mut rows, &compared.tip_shares, "mm");
    rows.row("axis deviation", format_args!("at most {:.6}°", compared.axis_deg));
    if compared.axis_deg > 0.0 {
        rows.row("", format_args!("at {}", readings(&compared.axis_at)));
        shares(&mut rows, &compared.axis_shares, "°");
    }
    rows.lines(NAME)
}

fn shares(rows: &mut NamedValues, shares: &[DifferenceShare], unit: &str) {
    rows.row("", "each difference by itself there; as vectors they add up:");
    let mut said = false;
    for share in shares {
        let (size, decimals) = match unit {
            "mm" => (format!("{:.5} mm", share.size), 5),
            _ => (format!("{:.6}°", share.size), 6),
        };
        if share.size < 0.5e-6 {
            continue;
        }
        said = true;
        let [x, y, z] = share.vector.map(|value| number(value, decimals));
        let differs = if share.of.starts_with("direction") {
            format!("{}°", number(share.differs_by, 6))
        } else if share.of.starts_with("zero") {
            number(share.differs_by, 6)
        } else {
            format!("{} mm", number(share.differs_by, 5))
        };
        rows.row(
            "",
            format_args!(
                "  {:<24}{size}  ({x}, {y}, {z}), the files differ by {differs}",
                share.of
            ),
        );
    }
    if !said {
        rows.row("", "  nothing contributes");
    }
}
