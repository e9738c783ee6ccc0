//! The check as text: a heading a matter, for a builder who stands beside the machine.

use std::fmt::Write as _;

use post_machine::check::{
    AxisLine, AxisReadout, Check, Comparison, DifferenceShare, DirectionSolutions, MachineClass,
    Pole, ReachableCone, Sign, Volume, number,
};

/// Width of the first column.
const NAME: usize = 18;

/// The whole check.
pub fn check(check: &Check) -> String {
    let mut text = String::new();
    row(&mut text, "machine", &check.machine);
    class(&mut text, &check.class);
    row(&mut text, "solved", &check.solved);
    if let Some(leaves) = &check.leaves {
        row(&mut text, "leaves the part", leaves);
    }
    text.push('\n');
    axes(&mut text, &check.class.axes);
    signs(&mut text, &check.signs);
    for axis in &check.class.axes {
        if let Some(told) = &axis.set_between_cuts {
            row(&mut text, "set between cuts", told);
        }
    }
    if let Some(typical) = &check.typical {
        solutions(&mut text, typical);
    }
    reach(&mut text, &check.reach);
    row(&mut text, "singular", &check.poles.told);
    for at in &check.poles.at {
        row(&mut text, "", &pole(at));
    }
    if let Some(space) = &check.volume {
        volume(&mut text, space, check.tool_length_mm);
    }
    let trip = &check.round_trip;
    row(
        &mut text,
        "round trip",
        &format!(
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
    row(
        &mut text,
        "warnings",
        &match check.warnings.len() {
            0 => "none".to_owned(),
            count => format!("{count}, see above"),
        },
    );
    text
}

/// Writes to a String, which cannot fail.
fn row(text: &mut String, name: &str, value: &str) {
    let _ = writeln!(text, "{name:<NAME$}{value}");
}

fn class(text: &mut String, class: &MachineClass) {
    let list = |names: &[String]| match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    row(text, "chain", &class.chain);
    row(text, "class", &class.name);
    row(text, "turn the tool", &list(&class.turn_the_tool));
    row(text, "carry the part", &list(&class.carry_the_part));
    row(text, "carry the tool", &list(&class.carry_the_tool));
    for angle in &class.angles {
        row(text, "angle", &format!("{} to {}: {}°", angle.from, angle.to, number(angle.value, 5)));
    }
    for distance in &class.distances {
        row(
            text,
            "distance",
            &format!(
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

fn axes(text: &mut String, axes: &[AxisLine]) {
    row(text, "axis", "kind    direction                         travel");
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
        row(text, &format!("{}{prime}", axis.name), &line);
    }
    text.push('\n');
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

fn solutions(text: &mut String, found: &DirectionSolutions) {
    let plural = |count: usize, word: &str| match count {
        1 => format!("1 {word}"),
        count => format!("{count} {word}s"),
    };
    row(
        text,
        "solutions",
        &format!(
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
        row(
            text,
            "",
            &format!(
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

fn reach(text: &mut String, reach: &ReachableCone) {
    let tilt = |tilt: Option<f64>| {
        tilt.map_or("not even +Z".to_owned(), |tilt| format!("{}°", number(tilt, 2)))
    };
    if reach.tied_to_the_tip {
        let told = "the direction of the tool depends on the point: with the tip kept it cannot turn every way";
        row(text, "reach", told);
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
        row(text, "reach", &told);
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
    row(text, "reach", &told);
    if let Some(grid) = reach.searched_every_deg {
        let told = format!(
            "searched with the tip on the part origin, every {}°: at least so much",
            number(grid, 1)
        );
        row(text, "", &told);
        return;
    }
    if !reach.at_positions_alone.is_empty() {
        let told = format!(
            "of these only what the positions of {} give",
            reach.at_positions_alone.join(" and ")
        );
        row(text, "", &told);
    }
    if reach.share_of_sphere > 0.0 {
        let each: Vec<String> = reach
            .shares_by_solutions
            .iter()
            .enumerate()
            .filter(|(_, share)| **share > 0.0)
            .map(|(count, share)| format!("{count} in {} %", number(100.0 * share, 1)))
            .collect();
        row(text, "solutions inside", &format!("of all directions: {}", each.join(", ")));
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

fn volume(text: &mut String, volume: &Volume, length: f64) {
    let (Some(least), Some(most)) = (volume.least, volume.most) else {
        return;
    };
    let [x, y, z] = volume.axis.map(|value| number(value, 5));
    let rotary = match volume.rotary.as_slice() {
        [] => String::new(),
        rotary => format!(", {}", readings(rotary)),
    };
    row(
        text,
        "travel of the tip",
        &format!("part frame, tool along ({x}, {y}, {z}){rotary}, {} mm long:", number(length, 3)),
    );
    let spans = ["X", "Y", "Z"].iter().enumerate().map(|(index, name)| {
        format!("{name} {} to {}", number(least[index], 3), number(most[index], 3))
    });
    row(text, "", &format!("{} mm", spans.collect::<Vec<_>>().join(", ")));
}

fn readings(readings: &[AxisReadout]) -> String {
    let each =
        readings.iter().map(|reading| format!("{} {}", reading.axis, number(reading.value, 3)));
    each.collect::<Vec<_>>().join(" ")
}

/// The comparison of two files.
pub fn comparison(compared: &Comparison) -> String {
    let mut text = String::new();
    row(
        &mut text,
        "compared",
        &format!(
            "{} with {} at equal words, tool {} mm long",
            compared.machine,
            compared.nominal,
            number(compared.tool_length_mm, 3)
        ),
    );
    let [x, y, z] = compared.tip.map(|value| number(value, 5));
    row(
        &mut text,
        "tip deviation",
        &format!("at most {:.5} mm: ({x}, {y}, {z}) in the part frame", compared.tip_mm),
    );
    row(&mut text, "", &format!("at {}", readings(&compared.tip_at)));
    shares(&mut text, &compared.tip_shares, "mm");
    row(&mut text, "axis deviation", &format!("at most {:.6}°", compared.axis_deg));
    if compared.axis_deg > 0.0 {
        row(&mut text, "", &format!("at {}", readings(&compared.axis_at)));
        shares(&mut text, &compared.axis_shares, "°");
    }
    text
}

fn shares(text: &mut String, shares: &[DifferenceShare], unit: &str) {
    row(text, "", "each difference by itself there; as vectors they add up:");
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
        row(
            text,
            "",
            &format!("  {:<24}{size}  ({x}, {y}, {z}), the files differ by {differs}", share.of),
        );
    }
    if !said {
        row(text, "", "  nothing contributes");
    }
}
