//! What planning a curve has found, for people.

use std::fmt::Write as _;

use super::found::CurveSummary;
use super::simulate::Simulated;
use super::solve::{SolverChoice, SolverFound};
use post_job::text::number;
use post_job::text_table::{NamedValues, TextTable, or_dash};

/// How well the solvers agree where they must, as a share of every feed.
const SAME: f64 = 1e-6;

/// Width of names.
const NAME: usize = 14;

/// The tables of a plan.
pub fn text(found: &CurveSummary) -> String {
    let mut rows = NamedValues::default();
    rows.row("curve", format_args!("{} ({})", found.name, found.curve));
    rows.row("machine", format_args!("{}: {}", found.machine, found.axes.join(", ")));
    rows.row("samples", found.samples);
    rows.row("length", format_args!("{} mm", number(found.length_mm, 3)));
    let mean = 60.0 * found.length_mm / found.seconds;
    let time = format!("{} s, {} mm/min on average", number(found.seconds, 3), number(mean, 0));
    rows.row("cycle time", time);
    let of_samples = found.solvers.first().map_or(0.0, |solver| solver.seconds);
    rows.row(
        "feed spline",
        format!(
            "degree 2, slower by {} % to keep the limits between samples; the plan at the samples takes {} s",
            number(100.0 * found.spline_slower, 3),
            number(of_samples, 3)
        ),
    );
    match found.stops.as_slice() {
        [] => {}
        stops => {
            let places: Vec<String> = stops.iter().take(5).map(|at| number(*at, 4)).collect();
            let more = if stops.len() > 5 { " …" } else { "" };
            rows.row(
                "stops",
                format!(
                    "{}, where direction or curvature jumps: at parameter {}{more}",
                    stops.len(),
                    places.join(", ")
                ),
            );
        }
    }
    let mut text = rows.lines(NAME);
    limits(&mut text, found);
    solvers(&mut text, found);
    if let Some(simulated) = &found.simulated {
        simulation(&mut text, simulated);
    }
    text
}

fn limits(text: &mut String, found: &CurveSummary) {
    let heads = ["limit", "most", "largest", "share", "at mm", "active: way", "time"];
    let mut table = TextTable::headed(1, heads);
    let mut unreached = [1.0, 1.0];
    let mut unkept = false;
    for limit in &found.limits {
        unreached[0] -= limit.share_of_way;
        unreached[1] -= limit.share_of_time;
        if limit.most.is_none() && limit.largest == 0.0 {
            continue;
        }
        let decimals = decimals(limit.most.unwrap_or(limit.largest));
        let free = limit.most.is_some() && !limit.kept;
        unkept |= free;
        let percent = |share: f64| or_dash(limit.kept.then(|| format!("{:.1} %", 100.0 * share)));
        table.row([
            format!("{}, {}{}", limit.limit, limit.unit, if free { " *" } else { "" }),
            or_dash(limit.most.map(|most| number(most, decimals))),
            number(limit.largest, decimals),
            or_dash(limit.largest_share.map(|share| format!("{:.2} %", 100.0 * share))),
            number(limit.at_mm, 3),
            percent(limit.share_of_way),
            percent(limit.share_of_time),
        ]);
    }
    let mut none = vec![String::new(); 5];
    none[0].push_str("none of them within 1 %");
    none.extend(unreached.map(|share| format!("{:.1} %", 100.0 * share.max(0.0))));
    table.row(none);
    table.below(text);
    if unkept {
        text.push_str("* not kept by this solver; --solver jerk keeps limits of jerk\n");
    }
}

/// So many that four digits count.
fn decimals(size: f64) -> u8 {
    match libm::fabs(size) {
        size if size < 1.0 => 4,
        size if size < 100.0 => 2,
        size if size < 1000.0 => 1,
        _ => 0,
    }
}

fn solvers(text: &mut String, found: &CurveSummary) {
    let heads =
        ["solver", "Σ f², mm²/s²", "seconds", "proven gap", "iterations", "feeds differ by"];
    let mut table = TextTable::headed(1, heads);
    for solver in &found.solvers {
        table.row([
            name(solver.solver).to_owned(),
            number(solver.sum_of_squared_feeds, 3),
            number(solver.seconds, 5),
            or_dash(solver.proven_gap.map(|gap| format!("{gap:.1e}"))),
            or_dash(solver.iterations),
            or_dash(
                (solver.solver != SolverChoice::Reach)
                    .then(|| format!("{:.1e}", solver.largest_difference)),
            ),
        ]);
    }
    table.below(text);
    let (Some(first), Some(fast)) = (found.solvers.first(), found.solvers.last()) else {
        return;
    };
    if found.solvers.len() < 2 {
        return;
    }
    let _ = writeln!(text, "{}", judged(found.monotone, first, fast));
}

/// What the first solver has against reachability analysis.
fn judged(monotone: bool, first: &SolverFound, fast: &SolverFound) -> String {
    let more = first.sum_of_squared_feeds / fast.sum_of_squared_feeds - 1.0;
    let longer = first.seconds - fast.seconds;
    let than = format!(
        "{}: Σ f² {}{} %, time {}{} s against reachability analysis",
        name(first.solver),
        sign(more),
        number(100.0 * libm::fabs(more), 5),
        sign(longer),
        number(libm::fabs(longer), 5)
    );
    if first.solver == SolverChoice::Jerk {
        return format!("{than}, which keeps no jerk: a lower bound");
    }
    match (monotone, first.largest_difference <= SAME) {
        (true, true) => format!(
            "{than}. Every limit is monotone, and both agree in every feed within 1e-6 of it"
        ),
        (true, false) => format!(
            "{than}. Every limit is monotone, and both should agree in every feed: they do not"
        ),
        (false, _) => format!(
            "{than}. Not every limit is monotone: a larger feed at a sample may forbid a larger one at the next"
        ),
    }
}

fn sign(value: f64) -> &'static str {
    if value < 0.0 { "-" } else { "+" }
}

fn name(solver: SolverChoice) -> &'static str {
    match solver {
        SolverChoice::Reach => "reach",
        SolverChoice::Interior => "interior",
        SolverChoice::Jerk => "jerk",
    }
}

fn simulation(text: &mut String, found: &Simulated) {
    let micro = |value: f64| number(1e3 * value, 2);
    let mut rows = NamedValues::default();
    rows.row(
        "simulated",
        format!(
            "{} set-points, one every {} ms, through the servos",
            found.set_points,
            number(1e3 * found.period_s, 3)
        ),
    );
    rows.row(
        "contour error",
        format!(
            "at most {} µm, {} mm along the path, where the formula says {} µm; by the formula at most {} µm",
            micro(found.largest),
            number(found.at_mm, 3),
            micro(found.formula_there),
            micro(found.formula_largest)
        ),
    );
    rows.row(
        "",
        format_args!("RMS {} µm, by the formula {} µm", micro(found.rms), micro(found.formula_rms)),
    );
    rows.row(
        "",
        format!(
            "above the formula at {} % of the set-points, by {} µm at most ({} mm along the path)",
            number(100.0 * found.share_above_formula, 1),
            micro(found.most_above_formula),
            number(found.most_above_at_mm, 3)
        ),
    );
    if let (Some(limit), Some(share)) = (found.limit, found.share_above_limit) {
        rows.row(
            "",
            match found.largest > limit {
                true => format!(
                    "above its limit of {} µm at {} % of the set-points, by {} %: the formula is one of the steady state",
                    micro(limit),
                    number(100.0 * share, 2),
                    number(100.0 * (found.largest / limit - 1.0), 1)
                ),
                false => format!("within its limit of {} µm everywhere", micro(limit)),
            },
        );
    }
    text.push('\n');
    text.push_str(&rows.lines(NAME));
}
