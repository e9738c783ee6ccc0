//! What the stages have found, in the units of the control, and what was taken for granted.

use post_machine::axis_words;
use post_machine::description::{Axis, CornerRule, Machine};
use post_machine::diagnostic::Diagnostic;
use post_motion::contour::{self, ContourPeak, ContourReport};
use post_motion::limits::AxisLimits;

use super::prediction::{AxisFound, ContourFound, ErrorPart, Extreme, Spread};

/// Of each axis the largest values.
pub fn axes(machine: &Machine, report: &ContourReport) -> Vec<AxisFound> {
    let limits = AxisLimits::new(machine);
    let places = axis_words::order(machine).into_iter();
    let axes = places.map(|place| {
        let (axis, peaks) = (&machine.axes[place], &report.axes[place]);
        let extreme = |peak: &ContourPeak, scale: f64, limit: f64| Extreme {
            value: peak.value * scale / axis.unit(),
            limit: Some(limit / axis.unit()).filter(|limit| limit.is_finite()),
            nc_line: peak.line,
            time_s: peak.time,
        };
        AxisFound {
            name: axis.name.clone(),
            unit: axis.unit_name(),
            servo: axis.servo.is_some(),
            following: extreme(&peaks.following, 1.0, f64::INFINITY),
            velocity: extreme(&peaks.velocity, 60.0, axis.max_feed),
            acceleration: extreme(&peaks.acceleration, 1.0, axis.max_accel),
            jerk: extreme(&peaks.jerk, 1.0, axis.max_jerk),
            jump: extreme(&peaks.jump, 60.0, limits.jump[place] * 60.0),
        }
    });
    axes.collect()
}

/// How far the tool is off its path.
pub fn contour(report: &ContourReport, against_a_path: bool) -> ContourFound {
    let part = |part: &'static str, found: &contour::ValueSpread| ErrorPart {
        part,
        tip_mm: spread(found, 1.0),
    };
    let mut parts =
        vec![part("following", &report.cuts), part("interpolation", &report.interpolation)];
    let (tip, axis) = match against_a_path {
        true => {
            parts.push(part("program", &report.program));
            (&report.asked, &report.asked_axis)
        }
        false => (&report.cuts, &report.axis),
    };
    ContourFound {
        tip_mm: spread(tip, 1.0),
        axis_deg: spread(axis, 1f64.to_degrees()),
        parts,
        left_out_mm: Extreme {
            value: report.missed.value,
            limit: None,
            nc_line: report.missed.line,
            time_s: report.missed.time,
        },
    }
}

fn spread(found: &contour::ValueSpread, unit: f64) -> Spread {
    Spread {
        largest: found.peak.value * unit,
        rms: found.rms() * unit,
        p50: found.percentile(0.5) * unit,
        p95: found.percentile(0.95) * unit,
        p99: found.percentile(0.99) * unit,
        nc_line: found.peak.line,
        cl_line: found.peak.cl_line,
        time_s: found.peak.time,
    }
}

/// What is taken for granted because the machine file does not say otherwise.
pub fn assumed(machine: &Machine) -> Vec<String> {
    let mut assumed = Vec::new();
    if machine.legs().next().is_some() {
        let legs: Vec<&str> = machine.legs().map(|leg| leg.name.as_str()).collect();
        assumed.push(format!(
            "drives that are no axes ({}) follow the axes, however fast: their largest feeds hold back what is posted, and are not in this time",
            legs.join(", ")
        ));
    }
    let without = named(machine, |axis| axis.servo.is_none());
    if without.len() == machine.axes.len() {
        assumed.push("no axis has a [servo]: all are where they are commanded".to_owned());
    } else if !without.is_empty() {
        let names = without.join(", ");
        assumed.push(format!(
            "without a [servo] {names} stand{} where they are commanded",
            if without.len() == 1 { "s" } else { "" }
        ));
    }
    let motion = &machine.motion;
    if motion.corner == CornerRule::Blend && motion.corner_tolerance.is_none() {
        assumed.push(
            "where the program names no tolerance corners are left as far as the control's rule leads: [motion] corner_tolerance".to_owned(),
        );
    }
    let lags = without.len() < machine.axes.len();
    if lags && machine.motion.in_position == 0.0 {
        assumed.push(
            "an exact stop is over when the commanded position stands: [motion] in_position"
                .to_owned(),
        );
    }
    assumed
}

/// What the machine file leaves out that makes the time of a program too short.
pub fn warn(machine: &Machine, findings: &mut Vec<Diagnostic>) {
    type Limit = fn(&Axis) -> f64;
    let keys: [(&str, Limit, &str); 2] = [
        ("max_feed", |axis| axis.max_feed, "its velocity is not limited"),
        ("max_accel", |axis| axis.max_accel, "it is at its velocity at once"),
    ];
    for (key, value, so) in keys {
        let without = named(machine, |axis| value(axis).is_infinite());
        if without.is_empty() {
            continue;
        }
        let names = without.join(", ");
        let message = match without.len() {
            1 => format!("axis {names} has no {key}: {so}"),
            _ => format!(
                "axes {names} have no {key}: {}",
                so.replace("its", "their").replace("it is", "they are")
            ),
        };
        let help = format!("{key} of [axis.{}] in the machine file", without[0]);
        findings.push(Diagnostic::warning("motion-limits", message).help(help));
    }
}

fn named(machine: &Machine, which: impl Fn(&Axis) -> bool) -> Vec<String> {
    let axes = machine.axes.iter().filter(|axis| which(axis));
    let mut names: Vec<String> = axes.map(|axis| axis.name.clone()).collect();
    names.sort_unstable();
    names
}
