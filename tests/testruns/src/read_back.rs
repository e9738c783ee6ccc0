//! Programs read back, by a kinematics that shares no code with the command's: a chain of isometries, built
//! from the machine's TOML. Only the reader of expressions is the command's own.

use std::collections::BTreeMap;
use std::fs;

use nalgebra::{DMatrix, Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use post_grammar::parse_expression;
use toml::{Table, Value};

use post_testkit::repository;

pub type V = Vector3<f64>;

/// A pose of the tool in the part frame.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// mm.
    pub tip: V,
    /// Unit vector from the tip to the holder.
    pub axis: V,
    /// Unit vector of the leading edge; null for a tool without one.
    pub edge: V,
}

/// An axis of a machine file.
#[derive(Debug)]
pub struct Axis {
    pub name: String,
    rotary: bool,
    direction: V,
    point: V,
    /// What the control shows at the drawing's zero.
    zero: f64,
    /// In what the control shows; none if cyclic.
    pub travel: Option<[f64; 2]>,
    pub indexed: bool,
    /// Places where an indexed axis can stand, a step between them.
    pub positions: Option<Vec<f64>>,
    pub step: Option<f64>,
    /// A quill: how its way is divided is the command's affair.
    quill: bool,
    /// What its word multiplies it by: 2 of a diameter, of a machine of the library.
    factor: f64,
    /// The sign of its word is the way to a place within one turn.
    signed: bool,
    /// Errors by where it stands, as the control shows it.
    errors: Option<Errors>,
}

/// `[error.X]` with rows in the machine file, mm and mm/m.
#[derive(Debug)]
struct Errors {
    /// Places, and displacement and turn there, mm and radians.
    rows: Vec<(f64, [V; 2])>,
    /// The point whose displacement they are.
    point: V,
    /// They act on the part's side of the axis.
    before: bool,
    /// The axis turns without end, and so do they.
    endless: bool,
}

impl Errors {
    fn motion(&self, place: f64) -> Isometry3<f64> {
        let (first, motion) = self.rows[0];
        let place = if self.endless { first + (place - first).rem_euclid(360.0) } else { place };
        let mut rows = self.rows.clone();
        rows.extend(self.endless.then_some((first + 360.0, motion)));
        let after = rows.iter().position(|(at, _)| *at > place).unwrap_or(rows.len());
        let [before, after] = [after.saturating_sub(1), after.min(rows.len() - 1)];
        let ((from, one), (to, other)) = (rows[before], rows[after]);
        let share = if to > from { (place - from) / (to - from) } else { 0.0 };
        let [by, turn] = [0, 1].map(|of| one[of] + (other[of] - one[of]) * share);
        let there = Translation3::from(self.point);
        Translation3::from(by) * there * UnitQuaternion::from_scaled_axis(turn) * there.inverse()
    }
}

/// A machine file with one of its heads.
#[derive(Debug)]
pub struct Model {
    pub axes: Vec<Axis>,
    mount: V,
    gauge: V,
    tool_axis: V,
    edge: V,
    pub control_keeps_tip: bool,
    /// mm in a linear word.
    unit: f64,
    pub axis_tolerance: f64,
    pub tolerance: f64,
    /// Words that clamp and let go.
    pub clamps: Vec<String>,
}

/// The tables of `layer` laid over those of `base`.
pub fn overlay(base: &mut Table, layer: Table) {
    for (key, value) in layer {
        match (base.get_mut(&key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => overlay(old, new),
            (_, value) => {
                base.insert(key, value);
            }
        }
    }
}

/// A file of the library with what it extends.
pub fn table(machine: &str) -> Table {
    let text = fs::read_to_string(repository().join(format!("machines/{machine}.toml"))).unwrap();
    let table: Table = text.parse().unwrap();
    match table.get("extends") {
        Some(parent) => {
            let mut merged = self::table(parent.as_str().unwrap());
            overlay(&mut merged, table);
            merged
        }
        None => table,
    }
}

struct Numbers<'a> {
    parameters: Option<&'a Table>,
}

impl Numbers<'_> {
    fn number(&self, value: &Value) -> f64 {
        match value {
            Value::Integer(number) => *number as f64,
            Value::Float(number) => *number,
            Value::String(text) => {
                let expression = parse_expression(text).unwrap();
                let known = |name: &str| Some(self.number(self.parameters?.get(name)?));
                expression.evaluate(&known).unwrap()
            }
            other => panic!("{other} is no number"),
        }
    }

    fn list(&self, value: &Value) -> Vec<f64> {
        let items = value.as_array().unwrap().iter();
        items.map(|item| self.number(item)).collect()
    }

    fn vector(&self, value: Option<&Value>, default: [f64; 3]) -> V {
        value.map_or(V::from(default), |value| V::from_column_slice(&self.list(value)))
    }
}

/// Rows of errors of an axis: `EXX` is the one along X of X, `ECX` the one about Z.
fn error_rows(table: &Value, axis: &str) -> Vec<(f64, [V; 2])> {
    let number =
        |value: &Value| value.as_float().or(value.as_integer().map(|it| it as f64)).unwrap();
    let names: Vec<&str> =
        table["columns"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let micrometres = table.get("units").and_then(Value::as_str) == Some("um");
    let unit = if micrometres { 1e-3 } else { 1.0 };
    let rows = table["rows"].as_array().unwrap().iter();
    rows.map(|row| {
        let row: Vec<f64> = row.as_array().unwrap().iter().map(number).collect();
        let mut motion = [V::zeros(); 2];
        for (name, value) in names.iter().zip(&row).skip(1) {
            let letter = name.strip_prefix('E').unwrap().strip_suffix(axis).unwrap();
            let part = "XYZABC".find(letter).unwrap();
            let value = value * unit;
            motion[part / 3][part % 3] = if part > 2 { value * 1e-3 } else { value };
        }
        (row[0], motion)
    })
    .collect()
}

impl Model {
    /// A machine of the library, with `head` if it has more than one.
    pub fn new(machine: &str, head: Option<&str>) -> Self {
        let table = table(machine);
        let mut model = Self::from_table(table.clone(), head);
        model.axes.iter_mut().for_each(|axis| axis.factor = factor(&table, &axis.name));
        model
    }

    pub fn from_table(mut table: Table, head: Option<&str>) -> Self {
        let heads = table.remove("head");
        if let Some(head) = head {
            let Value::Table(overrides) = heads.unwrap()[head].clone() else {
                panic!("{head} is no table");
            };
            overlay(&mut table, overrides);
        }
        let section = |name: &str| table.get(name).and_then(Value::as_table);
        let numbers = Numbers { parameters: section("parameters") };
        let chain = table["chain"].as_str().unwrap();
        let bed = chain.split_whitespace().position(|link| link.starts_with('b'));
        let carrier = |name: &str| {
            let links = chain.split_whitespace();
            links.map(|link| link.trim_end_matches('\'')).position(|link| link == name) < bed
        };
        let names = chain
            .trim_matches(['[', ']'])
            .split_whitespace()
            .filter(|link| link.starts_with(char::is_uppercase))
            .map(|link| link.trim_end_matches('\''));
        let mut clamps = Vec::new();
        let axes = names
            .map(|name| {
                let axis = table["axis"][name].as_table().unwrap();
                let get = |key: &str| axis.get(key);
                let flag = |key: &str| get(key).and_then(Value::as_bool).unwrap_or(false);
                for key in ["clamp", "unclamp"] {
                    clamps.extend(get(key).map(|word| word.as_str().unwrap().to_owned()));
                }
                let sense = if flag("reversed") { -1.0 } else { 1.0 };
                let direction = get("rotary").or(get("linear")).unwrap();
                let rotary = get("rotary").is_some();
                let own_point = if rotary { get("point") } else { table["tool"].get("gauge") };
                let errors =
                    section("error").and_then(|errors| errors.get(name)).map(|own| Errors {
                        rows: error_rows(own, name),
                        point: numbers.vector(own.get("point").or(own_point), [0.0; 3]),
                        before: carrier(name) != rotary,
                        endless: rotary && get("travel").is_none(),
                    });
                Axis {
                    errors,
                    signed: get("way").and_then(Value::as_str) == Some("sign"),
                    name: name.to_owned(),
                    rotary: get("rotary").is_some(),
                    direction: sense * numbers.vector(Some(direction), [0.0; 3]).normalize(),
                    point: numbers.vector(get("point"), [0.0; 3]),
                    zero: get("zero").map_or(0.0, |zero| numbers.number(zero)),
                    travel: get("travel").map(|travel| numbers.list(travel).try_into().unwrap()),
                    indexed: get("indexed").is_some(),
                    positions: get("positions").map(|list| numbers.list(list)),
                    step: get("step").map(|step| numbers.number(step)),
                    quill: get("share").is_some() || flag("reserve"),
                    factor: 1.0,
                }
            })
            .collect();
        let tool = section("tool").unwrap();
        let control = section("control").unwrap();
        let says = |key: &str, text: &str| control.get(key).and_then(Value::as_str) == Some(text);
        let accuracy = |key: &str, default: f64| {
            let said = section("accuracy").and_then(|accuracy| accuracy.get(key));
            said.map_or(default, |value| numbers.number(value))
        };
        let workpiece = section("workpiece");
        let mount = workpiece.and_then(|workpiece| workpiece.get("mount"));
        let edge = numbers.vector(tool.get("edge"), [0.0; 3]);
        Self {
            axes,
            mount: numbers.vector(mount, [0.0; 3]),
            gauge: numbers.vector(tool.get("gauge"), [0.0; 3]),
            tool_axis: numbers.vector(tool.get("axis"), [0.0, 0.0, 1.0]).normalize(),
            edge: edge.try_normalize(1e-9).unwrap_or_default(),
            control_keeps_tip: says("tcp", "control"),
            unit: if says("units", "inch") { 25.4 } else { 1.0 },
            axis_tolerance: accuracy("axis_tolerance", 0.05),
            tolerance: accuracy("tolerance", 0.005),
            clamps,
        }
    }

    /// The tip with all axes at zero, machine frame.
    fn home(&self, length: f64) -> V {
        self.gauge - self.tool_axis * length
    }

    /// Positions of the linear axes with the tip on the part origin and all rotary axes showing zero; of quills and
    /// what they run along, only the sum is meant.
    fn work_offset(&self, length: f64) -> Vec<f64> {
        let linear: Vec<usize> =
            (0..self.axes.len()).filter(|place| !self.axes[*place].rotary).collect();
        if linear.is_empty() {
            return vec![0.0; self.axes.len()];
        }
        let shows = |axis: &Axis| if axis.rotary { 0.0 } else { axis.zero };
        let shown: Vec<f64> = self.axes.iter().map(shows).collect();
        let home = self.reach(&shown, length).tip;
        let directions = linear.iter().map(|place| {
            let mut further = shown.clone();
            further[*place] += 1.0;
            self.reach(&further, length).tip - home
        });
        let directions = DMatrix::from_iterator(
            3,
            linear.len(),
            directions.flat_map(|way| [way.x, way.y, way.z]),
        );
        let wanted = DMatrix::from_column_slice(3, 1, (-home).as_slice());
        let solved = directions.clone().pseudo_inverse(1e-9).unwrap() * wanted;
        let mut offset = vec![0.0; self.axes.len()];
        for (row, place) in linear.iter().enumerate() {
            offset[*place] = solved[row];
        }
        if self.axes.iter().any(|axis| axis.errors.is_some()) {
            let inverse = directions.pseudo_inverse(1e-9).unwrap();
            for _ in 0..6 {
                let stands: Vec<f64> = shown.iter().zip(&offset).map(|(a, b)| a + b).collect();
                let off = -self.reach(&stands, length).tip;
                let more = &inverse * DMatrix::from_column_slice(3, 1, off.as_slice());
                linear.iter().enumerate().for_each(|(row, place)| offset[*place] += more[row]);
            }
        }
        offset
    }

    /// The tool where the axes stand at `values`, as the control shows them, mm and degrees.
    pub fn reach(&self, values: &[f64], length: f64) -> Pose {
        let mut motion = Isometry3::identity();
        for (axis, shown) in self.axes.iter().zip(values) {
            let value = shown - axis.zero;
            let errors = axis.errors.as_ref();
            let [before, behind] =
                [true, false].map(|side| errors.filter(|own| own.before == side));
            motion *= before.map_or_else(Isometry3::identity, |own| own.motion(*shown));
            if axis.rotary {
                let direction = Unit::new_unchecked(axis.direction);
                let turn = UnitQuaternion::from_axis_angle(&direction, value.to_radians());
                let there = Translation3::from(axis.point);
                motion *= there * turn * there.inverse();
            } else {
                motion *= Translation3::from(axis.direction * value);
            }
            motion *= behind.map_or_else(Isometry3::identity, |own| own.motion(*shown));
        }
        Pose {
            tip: motion * Point3::from(self.home(length)) - Point3::from(self.mount),
            axis: motion * self.tool_axis,
            edge: motion * self.edge,
        }
    }

    /// Positions of the axes, as the control shows them, from the words of a block.
    fn values(&self, words: &[f64], length: f64) -> Vec<f64> {
        let offset = self.work_offset(length);
        let value = |((axis, word), offset): ((&Axis, &f64), f64)| match axis.rotary {
            true if axis.signed => word.abs(),
            true => *word,
            false => word * self.unit / axis.factor + offset + axis.zero,
        };
        self.axes.iter().zip(words).zip(offset).map(value).collect()
    }

    /// The tool as the words of a block place it, with a tool of `length` mm.
    pub fn pose(&self, words: &[f64], length: f64) -> Pose {
        let mut pose = self.reach(&self.values(words, length), length);
        if self.control_keeps_tip {
            let coordinate = |name: &str| {
                let place = self.axes.iter().position(|axis| axis.name == name);
                words[place.unwrap()] * self.unit
            };
            pose.tip = V::new(coordinate("X"), coordinate("Y"), coordinate("Z"));
        }
        pose
    }

    /// An axis that these words drive out of its travel. Where the control keeps the tip, or a quill shares the
    /// way, the words do not say where the linear axes stand.
    pub fn over_travel(&self, words: &[f64], length: f64) -> Option<String> {
        let linear = !self.control_keeps_tip && !self.axes.iter().any(|axis| axis.quill);
        for (axis, value) in self.axes.iter().zip(self.values(words, length)) {
            let Some([least, most]) = axis.travel.filter(|_| axis.rotary || linear) else {
                continue;
            };
            if value < least - 2e-3 || value > most + 2e-3 {
                return Some(format!("{} is at {value}, travel {least} to {most}", axis.name));
            }
        }
        None
    }
}

/// Where a block ends.
#[derive(Clone, Debug)]
pub struct Block {
    /// The words in force, in chain order.
    pub words: Vec<f64>,
    pub rapid: bool,
    /// Counted from 1.
    pub line: usize,
    /// Heads swapped in before it.
    pub swaps: usize,
}

/// The multiple of `[word.NAME] is = "2 * NAME"`; one where there is none.
fn factor(table: &Table, name: &str) -> f64 {
    let word = table.get("word").and_then(|word| word.get(name)?.get("is")?.as_str());
    let own = word.and_then(|is| is.strip_suffix(name)?.trim().strip_suffix('*'));
    own.map_or(1.0, |number| number.trim().parse().unwrap())
}

/// The motion blocks of a program, ISO or conversational, once all axes have been programmed. `swap` are words
/// that swap heads.
pub fn blocks(program: &str, names: &[&str], swap: &[String]) -> Vec<Block> {
    let mut known: BTreeMap<&str, f64> = BTreeMap::new();
    let (mut rapid, mut swaps) = (true, 0);
    let mut blocks = Vec::new();
    for (index, line) in program.lines().enumerate() {
        // The place within a turn, and the way there: `C=ACP(280.000)`.
        let ways = ["=DC(", "=ACP(", "=ACN("];
        let plain = ways.iter().fold(line.to_owned(), |line, way| line.replace(way, ""));
        let code = plain.split(['(', ';']).next().unwrap();
        let words = || code.split_whitespace();
        swaps += words().filter(|word| swap.iter().any(|swap| swap == word)).count();
        // Retracts are in machine coordinates or steps; cycles and tools have words of their own.
        let other = ["G28", "G53", "M91", "M140", "CYCL", "TOOL", "BLK", "G4", "G7.1"];
        if words().any(|word| other.contains(&word)) {
            continue;
        }
        if words().nth(1) == Some("L") {
            rapid = words().any(|word| word == "FMAX");
        }
        let mut moved = false;
        for word in words() {
            match word {
                "G0" => rapid = true,
                "G1" => rapid = false,
                _ => {
                    let name = names.iter().find(|name| word.starts_with(**name));
                    if let Some(name) = name
                        && let Ok(value) =
                            word[name.len()..].trim_start_matches('=').trim_end_matches(')').parse()
                    {
                        known.insert(name, value);
                        moved = true;
                    }
                }
            }
        }
        if moved && names.iter().all(|name| known.contains_key(name)) {
            blocks.push(Block {
                words: names.iter().map(|name| known[name]).collect(),
                rapid,
                line: index + 1,
                swaps,
            });
        }
    }
    blocks
}

/// A program whose words between G12.1 and G13.1 are written as those of X and C themselves: X and `second` are right-angled
/// there, and the words of X are `factor` radii in and out of it.
pub fn unrolled(program: &str, second: &str, factor: f64) -> String {
    let mut place: Option<[f64; 2]> = None;
    let (mut x, mut turned) = (0.0, 0.0);
    let number = |word: &str, name: &str| word.strip_prefix(name)?.parse::<f64>().ok();
    let mut lines = Vec::new();
    for line in program.lines() {
        let mut left = Vec::new();
        let mut told = false;
        for word in line.split_whitespace() {
            match (word, &mut place) {
                ("G12.1", _) => (place, turned) = (Some([x / factor, 0.0]), 0.0),
                ("G13.1", _) => place = None,
                (word, Some(place)) if number(word, "X").is_some() => {
                    place[0] = number(word, "X").unwrap() / factor;
                    told = true;
                }
                (word, Some(place)) if number(word, second).is_some() => {
                    place[1] = number(word, second).unwrap();
                    told = true;
                }
                (word, _) => left.push(word.to_owned()),
            }
            if let (Some(value), None) = (number(word, "X"), place) {
                x = value;
            }
        }
        if let (Some([first, second]), true) = (place, told) {
            let angle = libm::atan2(second, first);
            let turn = std::f64::consts::TAU;
            turned = angle + turn * libm::rint((turned - angle) / turn);
            left.push(format!("X{:.9}", factor * libm::hypot(first, second)));
            left.push(format!("C{:.9}", turned.to_degrees()));
        }
        lines.push(left.join(" "));
    }
    lines.join("\n")
}

/// A point of a CL file.
#[derive(Clone, Debug)]
pub struct Point {
    pub tip: V,
    pub axis: V,
    pub rapid: bool,
    /// Counted from 1.
    pub line: usize,
    /// The head in force.
    pub head: Option<String>,
}

/// The points of a CL file whose moves are GOTOs, drilling cycles and index moves of B; a hole is meant by its
/// bottom.
pub fn points(text: &str) -> Vec<Point> {
    let mut unit = 1.0;
    let mut axis = V::z();
    let (mut rapid, mut depth, mut head) = (false, None, None);
    // The frame that an index move of B turns the points into, seen from the part.
    let mut turned = UnitQuaternion::identity();
    let mut points = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let (word, rest) = line.split_once('/').unwrap_or((line, ""));
        let items: Vec<&str> = rest.split(',').map(str::trim).collect();
        let number = |item: &&str| item.parse::<f64>().ok();
        match word.trim() {
            "UNITS" | "UNIT" if items[0].starts_with("INCH") => unit = 25.4,
            "RAPID" => rapid = true,
            "HEAD" => head = Some(items[0].to_owned()),
            "CYCLE" => {
                let at = items.iter().position(|item| ["DEPTH", "FEDTO"].contains(item));
                depth = at.map(|at| number(&items[at + 1]).unwrap().abs() * unit);
            }
            "GOTO" => {
                let numbers: Vec<f64> = items.iter().filter_map(number).collect();
                if numbers.len() == 6 {
                    axis = V::from_column_slice(&numbers[3..]).normalize();
                }
                let tip = V::from_column_slice(&numbers[..3]) * unit;
                points.push(Point {
                    tip: turned * (tip - axis * depth.unwrap_or(0.0)),
                    axis: turned * axis,
                    rapid,
                    line: index + 1,
                    head: head.clone(),
                });
                rapid = false;
            }
            "ROTABL" if items[0] == "BAXIS" => {
                let angle = number(&items[1]).unwrap().to_radians();
                turned = UnitQuaternion::from_axis_angle(&V::y_axis(), angle);
            }
            "CIRCLE" | "NURBS" | "ROTABL" | "GODLTA" => {
                panic!("line {}: this reader does not know it", index + 1)
            }
            _ => {}
        }
    }
    points
}

/// Degrees between two unit vectors.
pub fn angle(a: V, b: V) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b)).to_degrees()
}
