//! Where a control commands the axes of a program whose every block stops: trapezoids of velocity in closed form.

/// Places of the axes in a row: X, Y, Z in mm, C in degrees.
pub const AXES: [&str; 4] = ["X", "Y", "Z", "C"];

/// Limits of the machine file: feed, mm/s or degrees/s, and acceleration.
const LIMITS: [[f64; 2]; 4] = [
    [20000.0 / 60.0, 2000.0],
    [20000.0 / 60.0, 1500.0],
    [15000.0 / 60.0, 1200.0],
    [6000.0 / 60.0, 400.0],
];

/// A block: where it goes, and its feed, mm/min or degrees/min.
type Block = ([f64; 4], f64);

/// The program, from X0 Y0 Z20 C0 on.
const BLOCKS: [Block; 13] = [
    ([0.0, 0.0, 5.0, 0.0], 3000.0),
    ([60.0, 0.0, 5.0, 0.0], 3000.0),
    ([80.0, 40.0, 5.0, 0.0], 3000.0),
    ([20.0, 70.0, 2.0, 0.0], 3000.0),
    ([-30.0, 30.0, 2.0, 0.0], 3000.0),
    ([-10.0, -20.0, 8.0, 0.0], 3000.0),
    ([0.0, 0.0, 8.0, 0.0], 3000.0),
    ([0.0, 0.0, 8.0, 40.0], 2000.0),
    ([0.0, 0.0, 8.0, -25.0], 2000.0),
    ([45.0, 5.0, 8.0, -25.0], 6000.0),
    ([-45.0, 12.0, 8.0, -25.0], 6000.0),
    ([30.0, -30.0, 8.0, -25.0], 6000.0),
    ([0.0, 0.0, 20.0, -25.0], 6000.0),
];

const START: [f64; 4] = [0.0, 0.0, 20.0, 0.0];

/// The program as text.
pub fn program() -> String {
    let mut text = "%\nO0001\nG21 G90 G94 G40 G17\nG61\nG0 X0. Y0. Z20.\n".to_owned();
    for ([x, y, z, c], feed) in BLOCKS {
        text += &format!("G1 X{x:.3} Y{y:.3} Z{z:.3} C{c:.3} F{feed:.1}\n");
    }
    text + "M30\n%\n"
}

struct Move {
    begins: f64,
    takes: f64,
    velocity: f64,
    acceleration: f64,
    way: f64,
    from: [f64; 4],
    along: [f64; 4],
}

/// The motion of the program.
pub struct Course {
    moves: Vec<Move>,
    /// How long it takes, s.
    pub seconds: f64,
}

impl Course {
    pub fn new() -> Self {
        let mut course = Self { moves: Vec::new(), seconds: 0.0 };
        let mut from = START;
        for (to, feed) in BLOCKS {
            let by: [f64; 4] = std::array::from_fn(|axis| to[axis] - from[axis]);
            let linear = (by[0] * by[0] + by[1] * by[1] + by[2] * by[2]).sqrt();
            // A block of the rotary axis alone counts its feed in degrees.
            let way = if linear > 0.0 { linear } else { by[3].abs() };
            let along = by.map(|by| by / way);
            let least = |which: usize, first: f64| {
                let axes = along.iter().zip(LIMITS).filter(|(share, _)| **share != 0.0);
                axes.map(|(share, limits)| limits[which] / share.abs()).fold(first, f64::min)
            };
            let acceleration = least(1, f64::INFINITY);
            let velocity = least(0, feed / 60.0).min((way * acceleration).sqrt());
            let takes = way / velocity + velocity / acceleration;
            course.moves.push(Move {
                begins: course.seconds,
                takes,
                velocity,
                acceleration,
                way,
                from,
                along,
            });
            course.seconds += takes;
            from = to;
        }
        course
    }

    /// Where the axes are commanded.
    pub fn at(&self, time: f64) -> [f64; 4] {
        let later = self.moves.partition_point(|one| one.begins <= time);
        let Some(one) = later.checked_sub(1).map(|place| &self.moves[place]) else {
            return START;
        };
        let since = (time - one.begins).min(one.takes);
        let rises = one.velocity / one.acceleration;
        let left = one.takes - since;
        let way = if since < rises {
            one.acceleration * since * since / 2.0
        } else if left > rises {
            one.velocity * (since - rises / 2.0)
        } else {
            one.way - one.acceleration * left * left / 2.0
        };
        std::array::from_fn(|axis| one.from[axis] + one.along[axis] * way)
    }
}
