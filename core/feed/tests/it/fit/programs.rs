//! Points of real programs.

use post_feed::fit::{FitPoint, FitRules, MOST};
use post_testkit::shared;

use super::course::checked;

/// Degrees, as control programs have them, in rad.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

fn rounded(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

/// The cuts of a CL file: GOTO points between rapid moves, with the angles of the tool axis about Z, then across it,
/// all rounded as a control program has them.
fn cuts(text: &str) -> Vec<Vec<FitPoint>> {
    let text = text.replace("$\r\n", "").replace("$\n", "");
    let mut cuts = vec![Vec::new()];
    let mut axis = [0.0, 0.0, 1.0];
    let mut about: f64 = 0.0;
    for line in text.lines() {
        let line = line.trim();
        if line.starts_with("RAPID") {
            cuts.push(Vec::new());
            continue;
        }
        let Some(numbers) = line.strip_prefix("GOTO") else {
            continue;
        };
        let numbers: Vec<f64> = numbers
            .trim_start_matches([' ', '/'])
            .split(',')
            .map(|number| number.trim().parse().unwrap())
            .collect();
        if numbers.len() > 5 {
            axis.copy_from_slice(&numbers[3..6]);
        }
        let across = libm::acos(axis[2].clamp(-1.0, 1.0));
        if axis[0].abs() + axis[1].abs() > 1e-4 {
            let turn = libm::atan2(axis[1], axis[0]);
            let whole = 2.0 * std::f64::consts::PI;
            about = turn + ((about - turn) / whole).round() * whole;
        }
        let mut point = [0.0; MOST];
        for (value, number) in point.iter_mut().zip(&numbers[..3]) {
            *value = rounded(*number, 0.001);
        }
        point[3] = rounded(about / DEGREE, 0.001) * DEGREE;
        point[4] = rounded(across / DEGREE, 0.001) * DEGREE;
        let last = cuts.len() - 1;
        cuts[last].push(point);
    }
    cuts
}

/// Size of the second derivative of the tip by the parameter.
fn bend(values: [f64; 3]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The same by differences, at the point between two legs.
fn difference(points: &[FitPoint], lengths: [f64; 2]) -> f64 {
    bend([0, 1, 2].map(|axis| {
        let [a, b, c] = [0, 1, 2].map(|index| points[index][axis]);
        2.0 * ((c - b) / lengths[1] - (b - a) / lengths[0]) / (lengths[0] + lengths[1])
    }))
}

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share) as usize]
}

/// How much rougher differences are than the curve: sums of all changes of the second derivative.
fn report(name: &str, tolerance: f64) -> f64 {
    let Some(path) = shared(&format!("data/cl/{name}")) else {
        return f64::INFINITY;
    };
    let text = std::fs::read_to_string(path).unwrap();
    let rules = FitRules {
        dimensions: 5,
        tolerance,
        turn_tolerance: 0.02 * DEGREE,
        corner: 20.0 * DEGREE,
        turn_weight: 20.0,
        ..FitRules::default()
    };
    let (mut points, mut pieces, mut samples) = (0, 0, 0);
    let (mut off, mut fitted, mut differences) = (Vec::new(), Vec::new(), Vec::new());
    let (mut jumps, mut raw_jumps) = (Vec::new(), Vec::new());
    for cut in cuts(&text).iter().filter(|cut| cut.len() > 1) {
        points += cut.len();
        let (legs, all) = checked(&rules, cut);
        off.extend(all);
        let mut last: Option<f64> = None;
        let mut raw: Option<f64> = None;
        for (index, leg) in legs.iter().enumerate() {
            pieces += usize::from(leg.ends);
            for sample in &leg.samples[usize::from(!leg.begins).min(leg.samples.len())..] {
                samples += 1;
                let second = &sample.values[2];
                let value = bend([second[0], second[1], second[2]]);
                if let Some(last) = last.filter(|_| !(leg.begins && sample.at == 0.0)) {
                    jumps.push((value - last).abs());
                }
                last = Some(value);
                fitted.push(value);
            }
            raw = if leg.begins || leg.samples.is_empty() || legs[index - 1].samples.is_empty() {
                None
            } else {
                let value = difference(&cut[index - 1..], [legs[index - 1].length, leg.length]);
                differences.push(value);
                if let Some(raw) = raw {
                    raw_jumps.push((value - raw).abs());
                }
                Some(value)
            };
        }
    }
    println!("{name}, {tolerance} mm: {points} points, {pieces} pieces, {samples} samples");
    let line = |what: &str, values: &mut Vec<f64>| {
        let total: f64 = values.iter().sum();
        let [half, most, all] = [0.5, 0.99, 1.0].map(|share| quantile(values, share));
        println!("  {what:34} {half:10.5} {most:10.5} {all:10.4}  sum {total:12.2}");
    };
    line("off, tolerances", &mut off);
    line("second derivative of the tip, 1/mm", &mut fitted);
    line("by differences", &mut differences);
    line("its change", &mut jumps);
    line("by differences", &mut raw_jumps);
    let [smooth, rough] = [&jumps, &raw_jumps].map(|values| values.iter().sum::<f64>());
    rough / smooth
}

#[test]
fn a_finishing_program_of_creo_is_smooth() {
    assert!(report("creo5x_4r19415_finition.ncl", 0.005) > 4.0);
    assert!(report("creo5x_4r19415_finition.ncl", 0.01) > 4.0);
}

/// Its chords of arcs stray from them by 0.05 mm: only a tolerance that allows it makes the arcs again.
#[test]
fn a_variable_contour_of_nx_is_followed() {
    report("nx_HumMan_ust_a2.cls", 0.01);
    report("nx_HumMan_ust_a2.cls", 0.1);
}
