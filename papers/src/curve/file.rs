//! A curve file: the path that a feed is planned along, and what it has to keep.
//!
//! JSON, all lengths in mm, all times in s. Keys whose unit is not these have it in their name.
//!
//! ```json
//! {
//!   "name": "an arc",
//!   "degree": 2,
//!   "knots": [0, 0, 0, 1, 1, 1],
//!   "control_points_mm": [[10, 0, 0], [10, 10, 0], [0, 10, 0]],
//!   "weights": [1, 0.7071067811865476, 1],
//!   "limits": {
//!     "tip": { "v": 50 },
//!     "XY": { "v": 50, "a": 200 },
//!     "chord_error_um": 0.5, "contour_error_um": 20, "interp_period_s": 0.004,
//!     "servo": { "X": { "pid": { "kp": 10, "ki": 50, "kd": 0.3, "gain": 4.988, "inertia": 7e-3, "damping": 0.0236 } } }
//!   }
//! }
//! ```
//!
//! - The tip: `degree`, `knots`, `control_points_mm` (also `P_tool_tip`; points of two coordinates lie in the XY plane)
//!   and `weights` (1 each if not said). Or `points_mm`: points that a smooth curve is laid through.
//! - The tool axis, at most one of them, a B-spline over the same knots: `second_points_mm` (also
//!   `H_second_point_on_axis`): points of the axis above the tip; `tool_axis`: directions; `rotary_deg`: control values
//!   of rotary axes by their names, `{ "A": [...], "C": [...] }`. Without any the tool stands along Z.
//! - `limits`: of axes by their names, several with the same in one word (`"XYZ"`), `v`, `a` and `j`, in mm, or with
//!   `"unit": "deg"` or `"rad"` (which is that of rotary axes if not said); `tip` the same of the tip, `v` being the
//!   feed; `servo` by axis, as `[servo.X]` of a machine file. Limits that are left out are none. `chord_error_um` and
//!   `interp_period_s` may stand beside `limits` too.
//! - `name`; `source`, `axis`, `kinematics`, `computed` and `published_times_s` are notes, and not read.
//!
//! The axes are X, Y, Z of a machine whose axes carry the tool along the part's; with limits of two rotary axes (A and
//! C, B and C), or rotary values, those of a table whose axes meet in the part origin, C carrying the part on the other.

use post_machine::diagnostic::Diagnostic;
use serde::Deserialize;
use serde::de::IgnoredAny;

use super::json_text::{JsonText, NumberText, Raw};
use super::limits::FileLimits;

/// Longest curve file, bytes.
pub const MOST_BYTES: u64 = 64 << 20;

/// The highest degree that is planned along.
const MOST_DEGREE: usize = 7;

/// No coordinate is larger, mm: a slip of the unit would be.
const MOST_COORDINATE: f64 = 1e6;

/// What a curve file says.
pub struct CurveFile {
    /// What the curve is called.
    pub name: String,
    /// The path.
    pub path: GivenPath,
    /// What it has to keep.
    pub limits: FileLimits,
}

/// The path of a curve file.
pub enum GivenPath {
    /// NURBS.
    Splines(Splines),
    /// Points of the tip, and unit vectors along the tool.
    Points(Vec<[f64; 3]>, Option<Vec<[f64; 3]>>),
}

/// The splines of a curve file, over the same knots.
pub struct Splines {
    /// Of all of them.
    pub degree: usize,
    /// Of all of them.
    pub knots: Vec<f64>,
    /// Control points of the tip, mm.
    pub tip: Vec<[f64; 3]>,
    /// Of the control points; empty where all are 1.
    pub weights: Vec<f64>,
    /// The points had two coordinates.
    pub plane: bool,
    /// How the tool points.
    pub pointing: Pointing,
}

/// How the tool points along the path.
#[derive(Clone, Debug, PartialEq)]
pub enum Pointing {
    /// Along Z.
    Fixed,
    /// From the tip to points of its axis: their control points, mm.
    Second(Vec<[f64; 3]>),
    /// Along directions of any length: their control vectors.
    Axis(Vec<[f64; 3]>),
    /// As these rotary axes stand: names and control values, radians.
    Rotary(Vec<(String, Vec<f64>)>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CurveKeys<'a> {
    name: Option<String>,
    degree: Option<usize>,
    #[serde(borrow)]
    knots: Option<Raw<'a>>,
    #[serde(alias = "P_tool_tip")]
    control_points_mm: Option<Raw<'a>>,
    weights: Option<Raw<'a>>,
    #[serde(alias = "H_second_point_on_axis")]
    second_points_mm: Option<Raw<'a>>,
    tool_axis: Option<Raw<'a>>,
    rotary_deg: Option<Raw<'a>>,
    points_mm: Option<Raw<'a>>,
    limits: Option<Raw<'a>>,
    chord_error_um: Option<Raw<'a>>,
    interp_period_s: Option<Raw<'a>>,
    #[serde(rename = "source")]
    _source: Option<IgnoredAny>,
    #[serde(rename = "axis")]
    _axis: Option<IgnoredAny>,
    #[serde(rename = "kinematics")]
    _kinematics: Option<IgnoredAny>,
    #[serde(rename = "computed")]
    _computed: Option<IgnoredAny>,
    #[serde(rename = "published_times_s")]
    _published: Option<IgnoredAny>,
}

impl CurveFile {
    /// Reads the text of a curve file that messages call `file`.
    ///
    /// # Errors
    /// What is wrong with it, where, and what would help.
    pub fn parse(file: &str, text: &str) -> Result<Self, Box<Diagnostic>> {
        let json = JsonText { file, text };
        let keys: CurveKeys<'_> = json.whole()?;
        let mut limits = FileLimits::default();
        let beside =
            [("chord_error_um", keys.chord_error_um), ("interp_period_s", keys.interp_period_s)];
        for (key, raw) in beside {
            if let Some(raw) = raw {
                limits.take(&json, key, raw)?;
            }
        }
        if let Some(raw) = keys.limits {
            for (key, value) in json.entries(raw)? {
                limits.take(&json, &key, value)?;
            }
        }
        let path = match (keys.control_points_mm, keys.points_mm) {
            (Some(points), None) => GivenPath::Splines(splines(&json, &keys, points)?),
            (None, Some(points)) => given_points(&json, &keys, points)?,
            (both, _) => {
                let message = match both {
                    Some(_) => "both control_points_mm and points_mm",
                    None => "neither control_points_mm nor points_mm",
                };
                let help = "control_points_mm, with degree and knots, is a NURBS; points_mm are points that a smooth curve is laid through";
                let fault = Diagnostic::error("curve", format!("{file} has {message}"));
                return Err(fault.help(help).boxed());
            }
        };
        Ok(Self { name: keys.name.unwrap_or_else(|| file.to_owned()), path, limits })
    }
}

/// A key that the NURBS needs.
fn needed<T: Copy>(
    json: &JsonText<'_>,
    value: Option<T>,
    name: &str,
) -> Result<T, Box<Diagnostic>> {
    value.ok_or_else(|| {
        let message = format!("{} lacks {name}", json.file);
        let help = "a NURBS has degree, knots and control_points_mm";
        Diagnostic::error("curve", message).help(help).boxed()
    })
}

fn splines<'a>(
    json: &JsonText<'a>,
    keys: &CurveKeys<'a>,
    points: Raw<'a>,
) -> Result<Splines, Box<Diagnostic>> {
    let degree = needed(json, keys.degree, "degree")?;
    let raw_knots = needed(json, keys.knots, "knots")?;
    let knots = json.numbers(raw_knots, "a knot")?;
    let (tip, plane) = coordinates(json, points)?;
    let weights = match keys.weights {
        Some(raw) => json.numbers(raw, "a weight")?,
        None => Vec::new(),
    };
    let values = |written: &[NumberText<'_>]| -> Vec<f64> {
        written.iter().map(|(value, _)| *value).collect()
    };
    let splines = Splines {
        degree,
        knots: values(&knots),
        tip: tip.iter().map(|(point, _)| *point).collect(),
        weights: values(&weights),
        plane,
        pointing: pointing(json, keys, tip.len())?,
    };
    let count = splines.tip.len();
    if !(1..=MOST_DEGREE).contains(&degree) {
        let message = format!("the degree is not one of 1 to {MOST_DEGREE}");
        return Err(json.fault(raw_knots, message, ""));
    }
    if count <= degree {
        let message = "there are fewer control points than the degree and one";
        return Err(json.fault(raw_knots, message, ""));
    }
    if knots.len() != count + degree + 1 {
        let message = format!(
            "there are {} knots; degree {degree} and {count} control points need {}",
            knots.len(),
            count + degree + 1
        );
        return Err(json.fault(raw_knots, message, ""));
    }
    let falls = knots.windows(2).position(|pair| pair[0].0 > pair[1].0).map(|before| before + 1);
    let empty = (knots[degree].0 == knots[count].0).then_some(count);
    if let Some(place) = falls.or(empty) {
        let message = format!("knot {place} does not follow the one before");
        let help = "knots never fall, and the first and the last of the curve differ";
        return Err(json.fault(knots[place].1, message, help));
    }
    let missing = (weights.len() != count).then_some(weights.len().min(count));
    let bad = weights.iter().position(|(weight, _)| *weight <= 0.0).or(missing);
    if let Some(place) = bad.filter(|_| !weights.is_empty()) {
        let message = format!("the weight of control point {place} is missing or not positive");
        let help = "a weight above zero for each control point; leave weights out where all are 1";
        let raw = weights.get(place).map_or(raw_knots, |(_, raw)| *raw);
        return Err(json.fault(raw, message, help));
    }
    if let Some(place) = corner(degree, &splines.knots, count) {
        let raw = knots.get(place).map_or(raw_knots, |(_, raw)| *raw);
        let message = format!(
            "knot {} stands {degree} times or more inside the curve, which may jump there",
            splines.knots[place]
        );
        return Err(json.fault(raw, message, "make a curve file of each part"));
    }
    Ok(splines)
}

/// A knot inside the curve that stands more often than the degree: the curve itself jumps there.
fn corner(degree: usize, knots: &[f64], count: usize) -> Option<usize> {
    (degree + 1..count).find(|place| knots[*place] == knots[(*place + degree).min(knots.len() - 1)])
}

/// How the tool points: control points as many as those of the tip.
fn pointing<'a>(
    json: &JsonText<'a>,
    keys: &CurveKeys<'a>,
    count: usize,
) -> Result<Pointing, Box<Diagnostic>> {
    let counted = |raw: Raw<'a>, found: usize| match found == count {
        true => Ok(()),
        false => {
            let message =
                format!("there are {found} control values; the tip has {count} control points");
            Err(json.fault(raw, message, "both splines have the same knots"))
        }
    };
    let vectors = |raw: Raw<'a>| -> Result<Vec<[f64; 3]>, Box<Diagnostic>> {
        let (points, _) = coordinates(json, raw)?;
        counted(raw, points.len())?;
        Ok(points.into_iter().map(|(point, _)| point).collect())
    };
    let said = [keys.second_points_mm, keys.tool_axis, keys.rotary_deg];
    if let [Some(_), Some(second), _]
    | [Some(_), None, Some(second)]
    | [None, Some(_), Some(second)] = said
    {
        let message = "the tool axis is said twice";
        let help = "one of second_points_mm, tool_axis and rotary_deg says how the tool points";
        return Err(json.fault(second, message, help));
    }
    if let Some(raw) = keys.second_points_mm {
        return Ok(Pointing::Second(vectors(raw)?));
    }
    if let Some(raw) = keys.tool_axis {
        return Ok(Pointing::Axis(vectors(raw)?));
    }
    let Some(raw) = keys.rotary_deg else {
        return Ok(Pointing::Fixed);
    };
    let mut rotary = Vec::new();
    for (name, raw) in json.entries(raw)? {
        let values = json.numbers(raw, "a control value")?;
        counted(raw, values.len())?;
        let radians = values.into_iter().map(|(value, _)| value.to_radians());
        rotary.push((name, radians.collect()));
    }
    Ok(Pointing::Rotary(rotary))
}

/// Points with the text of each, and whether they have two coordinates.
#[expect(clippy::type_complexity, reason = "points with their texts, and one word about them")]
fn coordinates<'a>(
    json: &JsonText<'a>,
    raw: Raw<'a>,
) -> Result<(Vec<([f64; 3], Raw<'a>)>, bool), Box<Diagnostic>> {
    let mut points = Vec::new();
    let mut size = None;
    for raw in json.list(raw, "points")? {
        let numbers = json.numbers(raw, "a coordinate")?;
        let count = *size.get_or_insert(numbers.len());
        if !(2..=3).contains(&numbers.len()) || numbers.len() != count {
            let message = format!("a point of {} coordinates", numbers.len());
            let help = "points have three coordinates, or all of them two";
            return Err(json.fault(raw, message, help));
        }
        if let Some((value, raw)) = numbers.iter().find(|(value, _)| value.abs() > MOST_COORDINATE)
        {
            let message =
                format!("a coordinate of {value} mm; the largest is {MOST_COORDINATE} mm");
            return Err(json.fault(raw, message, "the unit is mm"));
        }
        let at = |place: usize| numbers.get(place).map_or(0.0, |(value, _)| *value);
        points.push(([at(0), at(1), at(2)], raw));
    }
    Ok((points, size == Some(2)))
}

/// `points_mm`: three numbers each, or six with the tool axis.
fn given_points<'a>(
    json: &JsonText<'a>,
    keys: &CurveKeys<'a>,
    points: Raw<'a>,
) -> Result<GivenPath, Box<Diagnostic>> {
    let splines =
        [keys.tool_axis, keys.second_points_mm, keys.rotary_deg, keys.knots, keys.weights];
    if let Some(raw) = splines.into_iter().flatten().next() {
        let message = "this key belongs to control_points_mm, and the file has points_mm";
        let help = "a tool axis stands behind each point: [x, y, z, i, j, k]";
        return Err(json.fault(raw, message, help));
    }
    let mut tip = Vec::new();
    let mut axes = Vec::new();
    for raw in json.list(points, "points")? {
        let numbers = json.numbers(raw, "a coordinate")?;
        let numbers: Vec<f64> = numbers.into_iter().map(|(value, _)| value).collect();
        match numbers[..] {
            [x, y, z] if axes.is_empty() => tip.push([x, y, z]),
            [x, y, z, i, j, k] if axes.len() == tip.len() => {
                let length = libm::sqrt(i * i + j * j + k * k);
                if length < 1e-6 {
                    return Err(json.fault(raw, "the tool axis is null", "i, j, k is a direction"));
                }
                tip.push([x, y, z]);
                axes.push([i / length, j / length, k / length]);
            }
            _ => {
                let message = format!("a point of {} numbers", numbers.len());
                let help = "all points are x, y, z, or all x, y, z, i, j, k";
                return Err(json.fault(raw, message, help));
            }
        }
    }
    if tip.len() < 2 {
        return Err(json.fault(points, "fewer than two points are no path", ""));
    }
    let axes = (!axes.is_empty()).then_some(axes);
    Ok(GivenPath::Points(tip, axes))
}
