//! Error models against deviations that are known.

use post_plugin::{Curve, Deviation, ModelSession, Tolerance, length};

use super::shapes::{self, DeviationKind, KnownDeviation, TOLERANCE};
use super::{Case, Figures, Peaks, readable};
use post_host::{GivenValue, OpenedModel, Plugin, PluginFault};

/// Even pieces in which truth and curve are compared.
const PIECES: u32 = 2000;

/// The share of peak or tolerance, whichever is larger, by which the peak of a plain bow may be off.
const NEAR: f64 = 0.05;

/// The share by which a peak may fall short of the model's own curve.
const SHORT: f64 = 0.02;

/// The share of the peak by which a value may differ where it should be the same but for rounding.
const SAME: f64 = 1e-6;

/// Asking for more is worth a remark: each place costs a forward solution.
const MANY: usize = 1000;

/// Opens a session whenever a case wants a fresh one.
type Open<'a> = &'a dyn Fn() -> Result<OpenedModel, PluginFault>;

pub(super) fn test(
    plugin: &Plugin,
    options: &[(String, GivenValue)],
) -> Result<Vec<Case>, PluginFault> {
    let open = || plugin.error_model(options);
    let mut cases = Vec::new();
    for shape in shapes::all() {
        cases.push(known(&mut open()?, &shape));
    }
    for (name, number) in [("not a number", f64::NAN), ("infinite", f64::INFINITY)] {
        cases.push(no_number(&mut open()?, name, number));
    }
    cases.push(repeated(&open)?);
    cases.push(transformed(&open, "turned", turned, &TOLERANCE)?);
    let tolerance = Tolerance { tip: 3.0 * TOLERANCE.tip, axis: 3.0 * TOLERANCE.axis };
    cases.push(transformed(&open, "scaled", |it| it * 3.0, &tolerance)?);
    Ok(cases)
}

/// Fits, and notes where the model asked.
fn fit(
    model: &mut OpenedModel,
    tolerance: &Tolerance,
    at: &dyn Fn(f64) -> Deviation,
) -> (Result<Curve, String>, Vec<f64>) {
    let mut asked = Vec::new();
    let curve = model.fit(tolerance, &mut |ts, out| {
        asked.extend_from_slice(ts);
        for (t, out) in ts.iter().zip(out) {
            *out = at(*t);
        }
    });
    (curve, asked)
}

/// One shape: the contract, and how near the answer is.
fn known(model: &mut OpenedModel, shape: &KnownDeviation) -> Case {
    let mut case = Case::named(shape.name);
    let (curve, asked) = fit(model, &shape.tolerance, &shape.at);
    if let Some(t) = asked.iter().find(|t| !(0.0..=1.0).contains(*t)) {
        case.wrong(format!("it asks for the deviation at t = {t}, outside the move"));
    }
    if asked.len() > MANY && shape.kind == DeviationKind::Bow {
        case.note(format!(
            "it asks for {} places of a plain bow; each costs a forward solution",
            asked.len()
        ));
    }
    let curve = match curve {
        Ok(curve) => curve,
        Err(fault) => {
            case.wrong(format!("no answer: {fault}"));
            return case;
        }
    };
    let ts = (0..=PIECES).map(|step| f64::from(step) / f64::from(PIECES));
    let truth: Vec<(f64, Deviation)> = ts.map(|t| (t, (shape.at)(t))).collect();
    let fitted: Vec<(f64, Deviation)> =
        truth.iter().map(|(t, _)| (*t, model.value(&curve, *t))).collect();
    let there = [curve.tip_at, curve.axis_at].map(|t| model.value(&curve, t));
    if let Some(fault) = model.fault() {
        case.wrong(format!("no value of its curve: {fault}"));
        return case;
    }
    let look = |part: fn(&Deviation) -> &[f64; 3], said, said_at| {
        let (actual, actual_at) = largest(&truth, part);
        let rests = truth.iter().zip(&fitted).map(|((_, a), (_, b))| {
            let off = *a - *b;
            length(part(&off))
        });
        Peaks { actual, actual_at, said, said_at, left: rests.fold(0.0, f64::max) }
    };
    let figures = Figures {
        asked: asked.len(),
        tip: look(|it| &it.tip, curve.tip_peak, curve.tip_at),
        axis: look(|it| &it.axis, curve.axis_peak, curve.axis_at),
    };
    case.figures = Some(figures);
    let Tolerance { tip, axis } = shape.tolerance;
    let own = [largest(&fitted, |it| &it.tip), largest(&fitted, |it| &it.axis)];
    let there = [length(&there[0].tip), length(&there[1].axis)];
    judge(&mut case, shape.kind, &TIP, &figures.tip, own[0], there[0], tip);
    judge(&mut case, shape.kind, &AXIS, &figures.axis, own[1], there[1], axis);
    case
}

/// How a part of the deviation is spoken of.
struct DeviationPart {
    name: &'static str,
    unit: &'static str,
    /// Units in a mm, or in a degree.
    scale: f64,
}

const TIP: DeviationPart = DeviationPart { name: "tip", unit: "µm", scale: 1e3 };

const AXIS: DeviationPart = DeviationPart { name: "tool axis", unit: "°", scale: 1.0 };

/// Judges one part's peak against the truth and against the model's `own` largest value and the one `there`,
/// where it says that the peak stands.
fn judge(
    case: &mut Case,
    kind: DeviationKind,
    part: &DeviationPart,
    peaks: &Peaks,
    (own, own_at): (f64, f64),
    there: f64,
    tolerance: f64,
) {
    let DeviationPart { name, unit, scale } = part;
    let number = |value: f64| format!("{} {unit}", short(value * scale));
    let Peaks { actual, actual_at, said, said_at, left } = *peaks;
    let slack = actual.max(tolerance);
    if kind != DeviationKind::Rough && own > said + SHORT * slack {
        case.wrong(format!(
            "its peak of the {name} is {}, and its own curve reaches {} at t = {own_at}",
            number(said),
            number(own)
        ));
    }
    if kind != DeviationKind::Rough && there < own - NEAR * slack {
        case.wrong(format!(
            "its peak of the {name} is to stand at t = {said_at}, where its curve has {}, not at {own_at}, \
             where it has {}",
            number(there),
            number(own)
        ));
    }
    let content = said <= tolerance && actual > tolerance;
    let near = (said - actual).abs() <= NEAR * slack;
    let truth = format!(
        "it says {} for the {name}, the deviation reaches {} at t = {actual_at}",
        number(said),
        number(actual)
    );
    match kind {
        DeviationKind::Bow if content => case.wrong(format!(
            "{truth}: it is content with a plain bow over the tolerance of {}",
            number(tolerance)
        )),
        DeviationKind::Bow if !near => case.wrong(format!(
            "{truth}: on a plain bow it may be off by {}",
            number(NEAR * slack)
        )),
        DeviationKind::Bow if left > 0.25 * actual && left > NEAR * slack => case.wrong(format!(
            "its curve leaves {} of a plain bow of {} in the {name}; compensating must take most of it",
            number(left),
            number(actual)
        )),
        _ if content => case.note(format!("{truth}; the certificate will overrule it")),
        _ if !near && said < actual => case.note(format!(
            "{truth}; the certificate makes up for the difference"
        )),
        _ if !near => case.note(format!("{truth}; more points will be put in than needed")),
        _ => {}
    }
}

/// The largest length of a part, and where.
fn largest(values: &[(f64, Deviation)], part: impl Fn(&Deviation) -> &[f64; 3]) -> (f64, f64) {
    let mut best = (0.0, 0.5);
    for (t, value) in values {
        let size = length(part(value));
        if size > best.0 {
            best = (size, *t);
        }
    }
    best
}

/// Four digits that a reader can take in.
fn short(value: f64) -> String {
    readable(value, 4, 2)
}

/// Deviations that are no numbers: refused, or at least answered by numbers.
fn no_number(model: &mut OpenedModel, name: &'static str, number: f64) -> Case {
    let mut case = Case::named(name);
    let at = |_: f64| Deviation { tip: [number; 3], axis: [number; 3] };
    match model.answer(&TOLERANCE, &mut |ts, out| {
        out.iter_mut().zip(ts).for_each(|(out, t)| *out = at(*t));
    }) {
        Ok(curve) => match model.check(&curve) {
            Ok(()) => case.note(format!(
                "it answers with a tip peak of {} µm where every deviation is {number}; it should refuse",
                short(1e3 * curve.tip_peak)
            )),
            Err(fault) => case.wrong(format!("it passes on what is no number: {fault}")),
        },
        Err(fault) if fault.contains("the plugin panicked") => {
            case.wrong(format!("it does not refuse in words: {fault}"));
        }
        Err(_) => {}
    }
    case
}

/// Many moves in one session: none may leave a trace, or the program would depend on how the work is shared.
fn repeated(open: Open<'_>) -> Result<Case, PluginFault> {
    let mut case = Case::named("repeated");
    let shapes = shapes::all();
    let ts = [0.0, 0.2, 0.5, 0.7, 1.0];
    let values = |model: &OpenedModel, curve: &Curve| ts.map(|t| model.value(curve, t));
    // The first answers are those of fresh sessions.
    let mut first = Vec::new();
    for shape in &shapes {
        let mut fresh = open()?;
        let Ok(curve) = fit(&mut fresh, &shape.tolerance, &shape.at).0 else {
            return Ok(case);
        };
        first.push((curve, values(&fresh, &curve)));
    }
    let mut model = open()?;
    for round in 1..=3 {
        for (index, shape) in shapes.iter().enumerate() {
            // A move that is refused may leave nothing behind either.
            let _ =
                fit(&mut model, &TOLERANCE, &|_| Deviation { tip: [f64::NAN; 3], axis: [0.0; 3] });
            let name = shape.name;
            let again = match fit(&mut model, &shape.tolerance, &shape.at).0 {
                Ok(curve) => curve,
                Err(fault) => {
                    case.wrong(format!(
                        "in round {round} it does not answer `{name}` any more: {fault}"
                    ));
                    return Ok(case);
                }
            };
            if again != first[index].0 {
                case.wrong(format!(
                    "in round {round} its answer to `{name}` is another than at first: tip peak {} µm instead \
                     of {} µm; a move must leave no trace",
                    short(1e3 * again.tip_peak),
                    short(1e3 * first[index].0.tip_peak)
                ));
                return Ok(case);
            }
            // The curve of a move before: the terms are all that a value may depend on.
            for (other, (curve, known)) in shapes.iter().zip(&first) {
                if values(&model, curve) != *known {
                    case.wrong(format!(
                        "after `{name}` the curve of `{}` has other values than before: `value` must read \
                         nothing but the curve's terms",
                        other.name
                    ));
                    return Ok(case);
                }
            }
        }
    }
    Ok(case)
}

/// A deviation in another frame, or three times as large, within three times the tolerance: the same curve,
/// so treated.
fn transformed(
    open: Open<'_>,
    name: &'static str,
    by: fn(Deviation) -> Deviation,
    tolerance: &Tolerance,
) -> Result<Case, PluginFault> {
    let mut case = Case::named(name);
    for shape in shapes::all() {
        if shape.kind == DeviationKind::Rough || shape.tolerance != TOLERANCE {
            continue;
        }
        let mut model = open()?;
        let Ok(plain) = fit(&mut model, &TOLERANCE, &shape.at).0 else {
            continue;
        };
        let what = shape.name;
        let other = match fit(&mut model, tolerance, &|t| by((shape.at)(t))).0 {
            Ok(other) => other,
            Err(fault) => {
                case.wrong(format!("no answer to `{what}`, {name}: {fault}"));
                continue;
            }
        };
        let unit = by(Deviation { tip: [1.0, 0.0, 0.0], axis: [1.0, 0.0, 0.0] });
        let peaks = [
            (&TIP, plain.tip_peak * length(&unit.tip), other.tip_peak, tolerance.tip),
            (&AXIS, plain.axis_peak * length(&unit.axis), other.axis_peak, tolerance.axis),
        ];
        for (part, due, found, tolerance) in peaks {
            if (found - due).abs() > SHORT * due.max(tolerance) {
                let [due, found] = [due, found].map(|it| short(it * part.scale));
                case.wrong(format!(
                    "the peak of the {} of `{what}`, {name}, is {found} {unit} instead of {due} {unit}",
                    part.name,
                    unit = part.unit
                ));
            }
        }
        let worst = (0..=100)
            .map(|step| f64::from(step) / 100.0)
            .map(|t| {
                let off = by(model.value(&plain, t)) - model.value(&other, t);
                let share = |off: &[f64; 3], peak: f64, tolerance: f64| {
                    length(off) / peak.max(1e-3 * tolerance)
                };
                let tip = share(&off.tip, plain.tip_peak, TOLERANCE.tip);
                let axis = share(&off.axis, plain.axis_peak, TOLERANCE.axis);
                (tip.max(axis), t)
            })
            .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
        if worst.0 > SAME {
            case.wrong(format!(
                "the curve of `{what}`, {name}, is another one: at t = {} it differs by {:.2} % of the peak",
                worst.1,
                100.0 * worst.0
            ));
        }
    }
    Ok(case)
}

/// By 60 degrees about (1, 1, 1).
fn turned(it: Deviation) -> Deviation {
    let turn = |[x, y, z]: [f64; 3]| {
        [
            (2.0 * x - y + 2.0 * z) / 3.0,
            (2.0 * x + 2.0 * y - z) / 3.0,
            (-x + 2.0 * y + 2.0 * z) / 3.0,
        ]
    };
    Deviation { tip: turn(it.tip), axis: turn(it.axis) }
}
