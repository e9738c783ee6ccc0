//! A parabola with one fault at a time, for the tests of the conformance kit.

use post_plugin::{
    Curve, Deviation, ErrorModel, OptionKind, OptionSpec, Tolerance, Value, ask, export_error_model,
};

/// What is wrong with it.
const FAULTS: &[&str] = &[
    "nothing",
    "content",
    "understates",
    "shrinks",
    "misplaces",
    "flat",
    "grows",
    "remembers",
    "flattens",
    "offset",
    "outside",
    "timid",
    "panics",
    "passes",
    "ignores",
    "wanders",
];

struct Faulty {
    fault: String,
    /// The largest tip peak so far.
    largest: f64,
    /// The bow of the last move.
    last: Deviation,
    answers: Vec<Deviation>,
}

impl ErrorModel for Faulty {
    fn options() -> &'static [OptionSpec] {
        const OPTIONS: &[OptionSpec] = &[OptionSpec {
            key: "fault",
            kind: OptionKind::Choice(FAULTS),
            default: Value::Text("nothing"),
            help: "What is wrong with it.",
        }];
        OPTIONS
    }

    fn open(options: &[(&str, Value<'_>)]) -> Result<Self, String> {
        let fault = options.iter().find_map(|option| match *option {
            ("fault", Value::Text(fault)) => Some(fault.to_owned()),
            _ => None,
        });
        if fault.as_deref() == Some("wanders") {
            std::env::set_current_dir(std::env::temp_dir()).map_err(|error| error.to_string())?;
        }
        Ok(Faulty {
            fault: fault.unwrap_or_default(),
            largest: 0.0,
            last: Deviation::default(),
            answers: Vec::new(),
        })
    }

    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let places = match self.fault.as_str() {
            "outside" => [0.0, 0.5, 1.5],
            _ => [0.0, 0.5, 1.0],
        };
        let told = ask(deviation, &places, &mut self.answers);
        match (self.fault.as_str(), &told) {
            ("panics", Err(fault)) => panic!("{fault}"),
            ("ignores", Err(_)) => self.answers.fill(Deviation::default()),
            ("passes", Err(_)) => {}
            (_, Err(fault)) => return Err(fault.clone()),
            (_, Ok(())) => {}
        }
        let &[start, middle, end] = self.answers.as_slice() else {
            return Err("the deviation was not told at every place".to_owned());
        };
        let mut bow = middle - start.lerp(end, 0.5);
        match self.fault.as_str() {
            "flattens" => bow.tip[2] = 0.0,
            "offset" => bow.tip[0] += 0.001,
            _ => {}
        }
        self.last = bow;
        let mut curve = Curve::of(&[start, end, bow], 8, |t| self.parabola(start, end, bow, t));
        match self.fault.as_str() {
            "content" => {
                (curve.tip_peak, curve.axis_peak) = (0.0, 0.0);
                curve.terms = [0.0; 60];
            }
            "understates" => curve.tip_peak = curve.tip_peak.min(0.99 * tolerance.tip),
            "shrinks" => curve.tip_peak *= 0.8,
            "misplaces" => curve.axis_at = 0.0,
            "grows" => {
                self.largest = self.largest.max(curve.tip_peak);
                curve.tip_peak = self.largest;
            }
            "timid" if curve.tip_peak > 100.0 => return Err("that is too far".to_owned()),
            "passes" if told.is_err() => curve.tip_peak = f64::NAN,
            _ => {}
        }
        Ok(curve)
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        let bow = match self.fault.as_str() {
            "remembers" => self.last,
            _ => curve.kept(2),
        };
        self.parabola(curve.kept(0), curve.kept(1), bow, t)
    }
}

impl Faulty {
    fn parabola(&self, start: Deviation, end: Deviation, bow: Deviation, t: f64) -> Deviation {
        let height = match self.fault.as_str() {
            // As high at the middle, and nearly everywhere else.
            "flat" => (8.0 * t * (1.0 - t)).min(1.0),
            _ => 4.0 * t * (1.0 - t),
        };
        start.lerp(end, t) + bow * height
    }
}

export_error_model!(faulty, Faulty);
