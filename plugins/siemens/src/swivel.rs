//! Tilted planes (CYCLE800) and smoothing (CYCLE832, compressors): standard cycles whose arguments depend on the
//! software of the control.

use post_plugin::{PlaneAngles, Setup, Units};

use crate::text::{call, trimmed};

/// CYCLE800 of one control.
pub(crate) struct SwivelCall {
    retract: i64,
    record: String,
    status: i64,
    mode: i64,
    pub(crate) angles: PlaneAngles,
    /// Places of rotary axes 1 and 2 among the words: they are written as they stand.
    axes: [Option<usize>; 2],
    direction: i64,
    /// Place of the word whose sign is the direction.
    reference: Option<usize>,
    /// Arguments after the direction: a way of retract, and with new software where the plane lies.
    more: usize,
    /// Program units in a millimetre.
    scale: f64,
}

impl SwivelCall {
    pub(crate) fn new(setup: &Setup<'_>) -> Result<Self, String> {
        let place = |name: &str| {
            let mut words = setup.words.iter();
            let found = words.position(|word| word.name == name && word.rotary);
            found.ok_or_else(|| format!("`{name}` is no rotary axis of this machine"))
        };
        let (mode, angles) = match setup.text("swivel_mode") {
            "XZY" => (45, PlaneAngles::Xzy),
            "YXZ" => (54, PlaneAngles::Yxz),
            "YZX" => (30, PlaneAngles::Yzx),
            "ZXY" => (39, PlaneAngles::Zxy),
            "ZYX" => (27, PlaneAngles::Zyx),
            "direct" => (192, PlaneAngles::Rotary),
            _ => (57, PlaneAngles::Xyz),
        };
        let mut axes = [None; 2];
        for (axis, name) in axes.iter_mut().zip(setup.text("swivel_axes").split_whitespace()) {
            *axis = Some(place(name).map_err(|lack| format!("swivel_axes: {lack}"))?);
        }
        if setup.flag("swivel") && mode == 192 && axes[0].is_none() {
            return Err(
                "swivel_mode = \"direct\" writes rotary words: name the axes 1 and 2 of the swivel data record by \
                 swivel_axes"
                    .to_owned(),
            );
        }
        let reference = match setup.text("swivel_reference") {
            // The axis that tilts, as records mostly have it: the control finds the solution that stands already.
            "" => place("A").or_else(|_| place("B")).ok(),
            name => Some(place(name).map_err(|lack| format!("swivel_reference: {lack}"))?),
        };
        Ok(SwivelCall {
            retract: setup.integer("swivel_retract"),
            record: setup.text("swivel_record").replace('"', ""),
            status: setup.integer("swivel_status"),
            mode,
            angles,
            axes,
            direction: setup.integer("swivel_direction"),
            reference,
            more: if setup.text("software") == "4" { 2 } else { 1 },
            scale: scale(setup),
        })
    }

    /// The plane with this origin, mm, these angles, and the rotary axes at these words.
    pub(crate) fn plane(&self, origin: [f64; 3], angles: [f64; 3], words: &[f64]) -> String {
        let angles = match self.angles {
            PlaneAngles::Rotary => {
                let [first, second] = self.axes.map(|axis| axis.map_or(0.0, |axis| words[axis]));
                [first, second, 0.0]
            }
            _ => angles,
        };
        let direction = match self.reference {
            Some(axis) if words[axis] > 0.0 => 1,
            Some(_) => -1,
            None => self.direction,
        };
        let mut arguments = vec![
            self.retract.to_string(),
            format!("\"{}\"", self.record),
            self.status.to_string(),
            self.mode.to_string(),
        ];
        arguments.extend(origin.map(|length| trimmed(length * self.scale)));
        arguments.extend(angles.map(trimmed));
        arguments.extend([0.0; 3].map(trimmed));
        arguments.push(direction.to_string());
        arguments.extend((0..self.more).map(|_| "0".to_owned()));
        call("CYCLE800", &arguments)
    }
}

/// How the control is told that it may leave the path.
pub(crate) struct SmoothingCall {
    /// Empty: CYCLE832.
    compressor: String,
    mode: String,
    /// Packed digits; none: three arguments.
    packed: Option<i64>,
    scale: f64,
}

impl SmoothingCall {
    pub(crate) fn new(setup: &Setup<'_>) -> Self {
        let old = setup.text("software") != "4";
        SmoothingCall {
            compressor: setup.text("smoothing_by").replace("CYCLE832", ""),
            mode: setup.text("smoothing_mode").to_owned(),
            packed: old.then(|| setup.integer("smoothing_code")),
            scale: scale(setup),
        }
    }

    /// Whether the digits are known: those packed by an unknown rule are not guessed.
    pub(crate) fn known(&self) -> bool {
        self.packed != Some(0) || !self.compressor.is_empty()
    }

    /// The block for a tolerance, mm, and one of the tool axis, degrees.
    pub(crate) fn on(&self, tolerance: f64, axis: Option<f64>) -> String {
        let length = trimmed(tolerance * self.scale);
        if !self.compressor.is_empty() {
            let axis = axis.map_or(String::new(), |axis| format!(" OTOL={}", trimmed(axis)));
            return format!("{} CTOL={length}{axis}", self.compressor);
        }
        let kind = match self.mode.as_str() {
            "precision" => 4,
            "rough" => 3,
            "semifinish" => 2,
            "tolerance" if tolerance >= 0.05 => 3,
            "tolerance" if tolerance >= 0.02 => 2,
            _ => 1,
        };
        let arguments = match (self.packed, axis) {
            (Some(code), _) => vec![length, code.to_string()],
            // Ten more: the third argument is a tolerance. Without it stands a 1.
            (None, Some(axis)) => vec![length, (kind + 10).to_string(), trimmed(axis)],
            (None, None) => vec![length, kind.to_string(), "1".to_owned()],
        };
        call("CYCLE832", &arguments)
    }

    pub(crate) fn off(&self) -> &'static str {
        match self.compressor.is_empty() {
            true => "CYCLE832()",
            false => "COMPOF CTOL=-1 OTOL=-1",
        }
    }
}

/// Program units in a millimetre.
fn scale(setup: &Setup<'_>) -> f64 {
    match setup.units {
        Units::Millimetre => 1.0,
        Units::Inch => 1.0 / 25.4,
    }
}
