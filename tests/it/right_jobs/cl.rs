//! Random CL files that a machine of some kind can do: contours, five-axis cuts, holes, and the ways between them.

use std::fmt::Write;

use nalgebra::{Rotation3, Unit, Vector3};
use post_testkit::Rng;

/// How a machine may lean the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leans {
    Never,
    /// About this axis of the part.
    About(Vector3<f64>),
    AnyWay,
}

/// A CL file on its way.
pub struct Cl {
    pub text: String,
    /// What it has, for the tables of a study.
    pub has: Vec<&'static str>,
    random: Rng,
    leans: Leans,
    /// Lengths of the file are these to a millimetre.
    scale: f64,
    /// Numbers are written with so many decimals.
    decimals: usize,
    feed: f64,
    /// The place that points of an operation count from, and how it lies.
    origin: Vector3<f64>,
    turn: Rotation3<f64>,
}

impl Cl {
    /// A whole file.
    pub fn random(seed: u64, leans: Leans) -> Self {
        let mut random = Rng::new(seed);
        let inch = random.pick(5) == 0;
        let mut cl = Self {
            text: String::from("PARTNO/RANDOM\n"),
            has: Vec::new(),
            leans,
            scale: if inch { 1.0 / 25.4 } else { 1.0 },
            decimals: 4 + random.pick(4),
            feed: 0.0,
            origin: Vector3::zeros(),
            turn: Rotation3::identity(),
            random,
        };
        cl.line(if inch { "UNITS/INCHES" } else { "UNITS/MM" });
        let operations = 1 + cl.random.pick(4);
        for index in 0..operations {
            if index == 0 || cl.random.pick(3) == 0 {
                cl.tool(index as u32 + 1);
            }
            cl.operation();
        }
        cl.line("FINI");
        cl
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn has(&mut self, what: &'static str) {
        if !self.has.contains(&what) {
            self.has.push(what);
        }
    }

    fn yes(&mut self, of: usize) -> bool {
        self.random.pick(of) == 0
    }

    fn tool(&mut self, number: u32) {
        if number > 1 {
            self.has("tools");
        }
        self.line(&format!("LOADTL/{number}"));
        let speed = 500 + 10 * self.random.pick(700);
        self.line(&format!("SPINDL/RPM,{speed},CLW"));
        let coolant = ["FLOOD", "MIST", "OFF", "ON"][self.random.pick(4)];
        self.line(&format!("COOLNT/{coolant}"));
    }

    fn feed(&mut self) {
        self.feed = match self.yes(6) {
            true => self.random.range(2.0, 40.0),
            false => self.random.range(80.0, 3000.0),
        };
        let text = match self.scale < 1.0 {
            true => format!("FEDRAT/{:.3},IPM", self.feed * self.scale),
            false => format!("FEDRAT/{:.2},MMPM", self.feed),
        };
        self.line(&text);
    }

    /// Its number as the file writes it.
    fn number(&self, mm: f64) -> String {
        format!("{:.*}", self.decimals, mm * self.scale)
    }

    fn numbers(&self, mm: &[f64]) -> String {
        let numbers: Vec<String> = mm.iter().map(|mm| self.number(*mm)).collect();
        numbers.join(",")
    }

    fn part(&self, local: [f64; 3]) -> Vector3<f64> {
        self.origin + self.turn * Vector3::from(local)
    }

    fn goto_with(&mut self, local: [f64; 3], axis: Vector3<f64>) {
        let tip = self.part(local);
        let mut line = format!("GOTO/{}", self.numbers(tip.as_slice()));
        if self.leans != Leans::Never {
            let _ = write!(line, ",{:.9},{:.9},{:.9}", axis.x, axis.y, axis.z);
        }
        self.line(&line);
    }

    fn goto(&mut self, local: [f64; 3]) {
        self.goto_with(local, self.turn * Vector3::z());
    }

    fn rapid(&mut self, local: [f64; 3]) {
        self.line("RAPID");
        self.goto(local);
    }

    /// A tool axis that the machine can take, within so many degrees of Z.
    fn lean(&mut self, most: f64) -> Rotation3<f64> {
        let angle = self.random.range(-most, most).to_radians();
        match self.leans {
            Leans::Never => Rotation3::identity(),
            Leans::About(axis) => Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle),
            Leans::AnyWay => {
                let way = self.random.range(0.0, 360.0).to_radians();
                let across = Vector3::new(libm::cos(way), libm::sin(way), 0.0);
                Rotation3::from_axis_angle(&Unit::new_normalize(across), angle)
            }
        }
    }

    fn operation(&mut self) {
        self.origin = Vector3::new(
            self.random.range(-40.0, 40.0),
            self.random.range(-40.0, 40.0),
            self.random.range(-10.0, 20.0),
        );
        self.turn = Rotation3::identity();
        if self.leans != Leans::Never && self.yes(2) {
            self.has("indexed");
            self.turn = self.lean(50.0);
        }
        let leaning = self.leans != Leans::Never;
        match self.random.pick(if leaning { 12 } else { 8 }) {
            0..=3 => self.contour(),
            4..=6 => self.holes(),
            7 => self.slots(),
            8..=10 => self.strip(),
            _ => self.ring(),
        }
        match self.random.pick(12) {
            0 => {
                self.has("stop");
                self.line("STOP");
            }
            1 => {
                self.has("stop");
                self.line("OPSTOP");
            }
            _ => {}
        }
    }

    /// How high the tool goes between operations.
    fn level(&mut self) -> f64 {
        self.random.range(45.0, 70.0)
    }

    fn dwell(&mut self) {
        if self.yes(5) {
            self.has("dwell");
            let time = self.random.range(0.1, 3.0);
            self.line(&format!("DELAY/{time:.2}"));
        }
    }

    /// From the cut to the level, in one of the ways that CAM systems have.
    fn retract(&mut self, [x, y, z]: [f64; 3], level: f64) {
        match self.random.pick(5) {
            0 => {
                self.has("feed back");
                self.goto([x, y, z + 5.0]);
            }
            1 => {
                self.has("feed back");
                self.feed();
                let up = self.random.range(0.5, 12.0);
                self.goto([x, y, z + up]);
            }
            2 => self.rapid([x, y, z + 2.0]),
            _ => {}
        }
        self.rapid([x, y, level]);
    }

    /// Lines and arcs at some depths.
    fn contour(&mut self) {
        let level = self.level();
        let top = self.random.range(-3.0, 3.0);
        let depths = 1 + self.random.pick(3);
        let step = self.random.range(0.4, 3.0);
        let closed = self.yes(2);
        let compensated = self.yes(8);
        let (mut x, mut y) = (self.random.range(-20.0, 20.0), self.random.range(-20.0, 20.0));
        let start = [x, y];
        self.rapid([x, y, level]);
        let clearance = self.random.range(0.5, 5.0);
        for depth in 1..=depths {
            let z = top - step * depth as f64;
            self.rapid([x, y, z + step + clearance]);
            self.feed();
            self.goto([x, y, z]);
            self.dwell();
            if compensated {
                self.has("compensation");
                self.line("CUTCOM/LEFT,1");
            }
            if self.yes(2) {
                self.feed();
            }
            let points = 2 + self.random.pick(6);
            for _ in 0..points {
                match self.random.pick(if compensated { 1 } else { 4 }) {
                    0 | 1 => {
                        (x, y) = (self.random.range(-25.0, 25.0), self.random.range(-25.0, 25.0));
                        self.goto([x, y, z]);
                    }
                    _ => (x, y) = self.arc([x, y, z]),
                }
                if self.yes(8) {
                    self.feed();
                }
            }
            if compensated {
                self.line("CUTCOM/OFF");
                (x, y) = (x + 3.0, y + 2.0);
                self.goto([x, y, z]);
            }
            if self.yes(6) {
                self.has("coolant");
                let word = ["COOLNT/OFF", "COOLNT/MIST", "COOLNT/FLOOD"][self.random.pick(3)];
                self.line(word);
            }
            if closed {
                self.goto([start[0], start[1], z]);
                [x, y] = start;
                if depth < depths && self.yes(2) {
                    // Down where it stands, or up along the same line and across above what was cut.
                    continue;
                }
            }
            match self.random.pick(3) {
                0 => {
                    self.has("rapid beside a cut");
                    let above = z + self.random.range(0.3, 3.0);
                    self.rapid([x, y, above]);
                    (x, y) = (self.random.range(-25.0, 25.0), self.random.range(-25.0, 25.0));
                    self.rapid([x, y, above]);
                }
                _ => {
                    self.retract([x, y, z], level);
                    if depth < depths {
                        (x, y) = (self.random.range(-25.0, 25.0), self.random.range(-25.0, 25.0));
                        self.rapid([x, y, level]);
                    }
                }
            }
        }
        self.rapid([x, y, level]);
    }

    /// An arc in the plane of the operation: where it ends.
    fn arc(&mut self, [x, y, z]: [f64; 3]) -> (f64, f64) {
        self.has("arcs");
        let radius = self.random.range(1.0, 15.0);
        let begin = self.random.range(0.0, 360.0).to_radians();
        let sweep = self.random.range(5.0, 350.0).to_radians();
        let sense = if self.yes(2) { 1.0 } else { -1.0 };
        let centre = [x - radius * libm::cos(begin), y - radius * libm::sin(begin)];
        let end = begin + sense * sweep;
        let whole = self.yes(8);
        let to = match whole {
            true => [x, y],
            false => [centre[0] + radius * libm::cos(end), centre[1] + radius * libm::sin(end)],
        };
        let middle = self.part([centre[0], centre[1], z]);
        let normal = self.turn * Vector3::new(0.0, 0.0, sense);
        let line = format!(
            "CIRCLE/{},{:.9},{:.9},{:.9},{}",
            self.numbers(middle.as_slice()),
            normal.x,
            normal.y,
            normal.z,
            self.number(radius)
        );
        self.line(&line);
        self.goto([to[0], to[1], z]);
        (to[0], to[1])
    }

    /// Slots to and fro, along the same line.
    fn slots(&mut self) {
        self.has("to and fro");
        let level = self.level();
        let step = self.random.range(0.5, 2.0);
        let long = self.random.range(5.0, 40.0);
        self.rapid([0.0, 0.0, level]);
        self.rapid([0.0, 0.0, 2.0]);
        self.feed();
        let passes = 2 + self.random.pick(4);
        let mut x = 0.0;
        for pass in 1..=passes {
            self.goto([x, 0.0, -step * pass as f64]);
            x = long - x;
            self.goto([x, 0.0, -step * pass as f64]);
            if self.yes(3) {
                self.feed();
            }
        }
        let z = -step * passes as f64;
        match self.random.pick(3) {
            0 => {
                // Back along what was cut, at feed or at rapid.
                self.goto([long - x, 0.0, z]);
                x = long - x;
            }
            1 => {
                self.has("rapid in a cut");
                self.rapid([long - x, 0.0, z]);
                x = long - x;
            }
            _ => {}
        }
        self.retract([x, 0.0, z], level);
    }

    /// Holes by cycles.
    fn holes(&mut self) {
        self.has("holes");
        let level = self.level();
        let clear = [1.0, 2.0, 2.5, 4.687, 0.8][self.random.pick(5)];
        let depth = self.random.range(3.0, 25.0);
        let depth = (depth * 1000.0).round() / 1000.0;
        let step = self.random.range(1.5, 8.0);
        let feed = self.random.range(60.0, 600.0);
        let (x, y) = (self.random.range(-20.0, 20.0), self.random.range(-20.0, 20.0));
        self.rapid([x, y, level]);
        let [deep, clear, step] = [depth, clear, step].map(|mm| self.number(mm));
        let per_minute = match self.scale < 1.0 {
            true => format!("IPM,{:.3}", feed * self.scale),
            false => format!("MMPM,{feed:.1}"),
        };
        let dwell = match self.yes(3) {
            true => {
                self.has("dwell in a hole");
                format!(",DWELL,{:.2}", self.random.range(0.1, 2.0))
            }
            false => String::new(),
        };
        let kind = self.random.pick(7);
        let cycle = match kind {
            0 | 1 => format!("CYCLE/DRILL,DEPTH,{deep},{per_minute},CLEAR,{clear}{dwell}"),
            2 => format!("CYCLE/DEEP,DEPTH,{deep},STEP,{step},{per_minute},CLEAR,{clear}{dwell}"),
            3 => format!("CYCLE/BRKCHP,DEPTH,{deep},STEP,{step},{per_minute},CLEAR,{clear}"),
            4 => format!("CYCLE/TAP,DEPTH,{deep},{per_minute},CLEAR,{clear}"),
            5 => format!("CYCLE/BORE,DEPTH,{deep},{per_minute},CLEAR,{clear}{dwell}"),
            _ => format!("CYCLE/REAM,DEPTH,{deep},{per_minute},CLEAR,{clear}{dwell}"),
        };
        self.has(["drill", "drill", "deep", "brkchp", "tap", "bore", "ream"][kind]);
        self.line(&cycle);
        let mut last = [x, y, 0.0];
        let same = self.yes(2);
        let mut z = [-4.538, 0.0, 1.25][self.random.pick(3)];
        for hole in 0..1 + self.random.pick(5) {
            if hole > 0 {
                last[0] = self.random.range(-30.0, 30.0);
                last[1] = self.random.range(-30.0, 30.0);
            }
            if !same {
                z = self.random.range(-6.0, 3.0);
                z = (z * 1000.0).round() / 1000.0;
            }
            last[2] = z;
            self.goto(last);
        }
        self.line("CYCLE/OFF");
        self.rapid([last[0], last[1], level]);
    }

    /// A surface in lines, the tool leaning on the way.
    fn strip(&mut self) {
        self.has("five axes");
        let level = self.level();
        let lines = 1 + self.random.pick(3);
        let points = 3 + self.random.pick(12);
        let most = self.random.range(2.0, 40.0);
        let (first, last) = (self.lean(most), self.lean(most));
        let long = self.random.range(10.0, 50.0);
        let wave = self.random.range(0.0, 4.0);
        self.turn = Rotation3::identity();
        let axis = |t: f64| first.slerp(&last, t) * Vector3::z();
        let tip = |t: f64, y: f64| [long * t, y, wave * libm::sin(3.0 * t)];
        let up = |[x, y, z]: [f64; 3], axis: Vector3<f64>, by: f64| {
            [x + axis.x * by, y + axis.y * by, z + axis.z * by]
        };
        let back = self.yes(2);
        let pitch = self.random.range(0.3, 2.0);
        for line in 0..lines {
            let y = pitch * line as f64;
            let forth = !back || line % 2 == 0;
            let at = |step: usize| {
                let t = step as f64 / points as f64;
                if forth { t } else { 1.0 - t }
            };
            if line == 0 || !back {
                let begin = (tip(at(0), y), axis(at(0)));
                self.line("RAPID");
                self.goto_with(up(begin.0, begin.1, level), begin.1);
                self.line("RAPID");
                self.goto_with(up(begin.0, begin.1, 2.0), begin.1);
            }
            self.feed();
            for step in 0..=points {
                self.goto_with(tip(at(step), y), axis(at(step)));
            }
            let end = (tip(at(points), y), axis(at(points)));
            if line + 1 == lines || !back {
                if self.yes(3) {
                    self.has("feed back");
                    self.goto_with(up(end.0, end.1, 3.0), end.1);
                }
                self.line("RAPID");
                self.goto_with(up(end.0, end.1, level), end.1);
            }
        }
    }

    /// Round and round a cone: axes that end are wound back on the way.
    fn ring(&mut self) {
        if self.leans != Leans::AnyWay {
            return self.strip();
        }
        self.has("rounds");
        self.turn = Rotation3::identity();
        let lean = self.random.range(10.0, 45.0).to_radians();
        let radius = self.random.range(8.0, 30.0);
        let rounds = self.random.range(0.4, 2.6);
        let begin = self.random.range(0.0, 360.0).to_radians();
        let sense = if self.yes(2) { 1.0 } else { -1.0 };
        let place = |t: f64| {
            let turn = begin + sense * std::f64::consts::TAU * rounds * t;
            let out = Vector3::new(libm::cos(turn), libm::sin(turn), 0.0);
            let axis = out * libm::sin(lean) + Vector3::z() * libm::cos(lean);
            (out * radius - Vector3::z() * (4.0 * t), axis)
        };
        let level = self.level();
        let points = 20 + self.random.pick(60);
        let (tip, axis) = place(0.0);
        for by in [level, 2.0] {
            self.line("RAPID");
            self.goto_with((tip + axis * by).into(), axis);
        }
        self.feed();
        for step in 0..=points {
            let (tip, axis) = place(step as f64 / points as f64);
            self.goto_with(tip.into(), axis);
        }
        let (tip, axis) = place(1.0);
        self.line("RAPID");
        self.goto_with((tip + axis * level).into(), axis);
    }
}
