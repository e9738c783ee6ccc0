//! What a prediction tells, as the page has it.

use post_machine::description::Machine;
use post_report::meta::Maximum;

use crate::predict::Prediction;
use crate::text::{clock, number};

/// The largest errors, velocities and accelerations.
pub fn predicted_maxima(machine: &Machine, found: &Prediction) -> Vec<Maximum> {
    let known = |line: u64| (line > 0).then_some(line);
    let contour = &found.contour;
    let accuracy = &machine.accuracy;
    let mut maxima = vec![
        Maximum {
            name: "predicted contour error".to_owned(),
            value: contour.tip_mm.largest,
            unit: "mm",
            limit: Some(accuracy.tolerance),
            row: None,
            nc: known(contour.tip_mm.nc_line),
            cl: contour.tip_mm.cl_line,
        },
        Maximum {
            name: "predicted error of the tool axis".to_owned(),
            value: contour.axis_deg.largest,
            unit: "deg",
            limit: Some(accuracy.axis_tolerance.to_degrees()),
            row: None,
            nc: known(contour.axis_deg.nc_line),
            cl: contour.axis_deg.cl_line,
        },
    ];
    for axis in &found.axes {
        let rotary = axis.unit == "deg";
        for (what, extreme, units) in [
            ("velocity", &axis.velocity, ["mm/min", "deg/min"]),
            ("acceleration", &axis.acceleration, ["mm/s²", "deg/s²"]),
        ] {
            maxima.push(Maximum {
                name: format!("{what} of {}", axis.name),
                value: extreme.value,
                unit: units[usize::from(rotary)],
                limit: extreme.limit,
                row: None,
                nc: known(extreme.nc_line),
                cl: None,
            });
        }
    }
    maxima
}

/// Something is larger than its limit, by more than rounding.
pub fn is_exceeded(maxima: &[Maximum]) -> bool {
    let mut maxima = maxima.iter();
    maxima.any(|one| one.limit.is_some_and(|limit| one.value > limit * (1.0 + 1e-6)))
}

/// Times and feeds.
pub fn predicted_facts(found: &Prediction) -> Vec<[String; 2]> {
    let time = &found.time;
    let feed = &found.feed;
    let fact = |name: &str, value: String| [name.to_owned(), value];
    let mut facts = vec![
        fact("cycle time", clock(time.cycle_s)),
        fact("of it cutting", clock(time.cutting_s)),
        fact("of it rapids", clock(time.rapid_s)),
        fact("of it waiting", clock(time.waiting_s)),
        fact(
            "mean feed",
            format!(
                "{} mm/min, programmed {}",
                number(feed.true_mean, 0),
                number(feed.programmed_mean, 0)
            ),
        ),
        fact("set-points", format!("{}, one every {} ms", found.set_points, 1e3 * found.period_s)),
    ];
    for limit in found.time.limits.iter().take(6) {
        let axis = limit.axis.as_ref();
        let axis = axis.map_or(String::new(), |axis| format!(" of {axis}"));
        facts.push([
            format!("limited by {}{axis} ({})", limit.limit, limit.kind),
            format!("{}, {:.1} %", clock(limit.seconds), 100.0 * limit.share),
        ]);
    }
    facts
}
