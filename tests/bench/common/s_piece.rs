//! An S-shaped test piece of our own, in the spirit of the one of ISO 10791-7: a thin wall between two ruled flanks, S-shaped
//! in plan, milled with the side of the tool. The control points of the standard's piece are not public, and nothing
//! measured on this one can be compared with it.
//!
//! In plan the middle of the wall's foot is a sine-generated curve (Langbein, Leopold 1966): its heading is a cosine of the
//! way, so that the curvature is a sine and changes its sign in the middle. The wall leans across itself as a sine of the way
//! too, to one side in the first bend and to the other in the second; what is left in the middle is a small lean along the
//! wall, and the tool axis passes the vertical at that distance: C turns fastest, and A turns back, at the point of inflection.
//!
//! The tool touches a flank at half its height. Because the flanks are twisted it cuts up to 0.03 mm into them towards foot
//! and top.

use std::f64::consts::TAU;
use std::io::{self, Write};

/// Length of the middle of the foot, mm.
const LENGTH: f64 = 400.0;
/// Heading at both ends, and turned round in the middle, radians: more than a quarter turn makes the bends of an S.
const HEADING: f64 = 1.9;
/// Half of the wall's thickness, mm.
const HALF: f64 = 5.0;
/// Height of the wall, and of its foot above the part origin, mm.
const HEIGHT: f64 = 30.0;
const FOOT: f64 = 20.0;
/// Largest lean across the wall, and lean along it, mm a mm of height.
const ACROSS: f64 = 0.25;
const ALONG: f64 = 0.1;
/// Radius of the tool, mm.
const RADIUS: f64 = 8.0;
/// How far a cut begins before the wall and ends behind it, and how far the tool is drawn back along its axis, mm.
const BEYOND: f64 = 15.0;
const BACK: f64 = 60.0;
/// mm/min.
const FEED: f64 = 3000.0;

/// Both flanks, the left one forward and the right one back, in `cuts` equal steps of the foot's middle each.
pub fn write_s_piece(out: &mut impl Write, cuts: u64) -> io::Result<()> {
    writeln!(out, "TOOL PATH/S_FLANKS,TOOL,MILL_16")?;
    writeln!(out, "UNITS/MM")?;
    writeln!(out, "LOAD/TOOL,1,ADJUST,1")?;
    writeln!(out, "SPINDL/RPM,6000,CLW")?;
    let feet = feet(cuts);
    for side in [1.0, -1.0] {
        let ways = feet.iter().enumerate();
        let places = ways.map(|(cut, foot)| tool(LENGTH * cut as f64 / cuts as f64, *foot, side));
        let mut places: Vec<[f64; 6]> = places.collect();
        if side < 0.0 {
            places.reverse();
        }
        let last = places.len() - 1;
        let before = beyond(&places[1], &places[0]);
        let behind = beyond(&places[last - 1], &places[last]);
        for place in [drawn_back(&before), before] {
            writeln!(out, "RAPID")?;
            goto(out, &place)?;
        }
        writeln!(out, "FEDRAT/MMPM,{FEED:.1}")?;
        for place in places.iter().chain([&behind]) {
            goto(out, place)?;
        }
        writeln!(out, "RAPID")?;
        goto(out, &drawn_back(&behind))?;
    }
    writeln!(out, "SPINDL/OFF")?;
    writeln!(out, "END-OF-PATH")
}

/// The middle of the wall's foot in plan at the ends of `cuts` equal steps; half of the way stands over the part origin.
fn feet(cuts: u64) -> Vec<[f64; 2]> {
    let step = LENGTH / cuts as f64;
    // Simpson's rule: the curve bends so little over a step that it is exact to the printed digits.
    let over = |way: f64| {
        let headings = [way, way + step / 2.0, way + step].map(|way| libm::sincos(heading(way)));
        let [first, middle, last] = headings.map(|(sine, cosine)| [cosine, sine]);
        [0, 1].map(|xy| step / 6.0 * (first[xy] + 4.0 * middle[xy] + last[xy]))
    };
    let mut feet = vec![[0.0; 2]];
    for cut in 0..cuts {
        let [x, y] = feet[cut as usize];
        let [dx, dy] = over(cut as f64 * step);
        feet.push([x + dx, y + dy]);
    }
    // The curve is symmetric about the point half of the way along.
    let [x, y] = feet[cuts as usize];
    let over_origin = |foot: &[f64; 2]| [foot[0] - x / 2.0, foot[1] - y / 2.0];
    feet.iter().map(over_origin).collect()
}

/// Direction of the foot, radians from X.
fn heading(way: f64) -> f64 {
    HEADING * libm::cos(TAU * way / LENGTH)
}

/// Tip and tool axis beside the left (1) or right (-1) flank; `foot` is the middle of the wall's foot.
fn tool(way: f64, foot: [f64; 2], side: f64) -> [f64; 6] {
    let turn = TAU / LENGTH;
    let (sine, cosine) = libm::sincos(turn * way);
    let curvature = -HEADING * turn * sine;
    let (across, across_by_way) = (ACROSS * sine, ACROSS * turn * cosine);
    // Components along the wall, to its left, and up. The ruling is [ALONG, across, 1] a mm of height.
    let ruling = [ALONG, across, 1.0];
    // How a point of the flank at half the height moves with the way: the foot, and the ruling that turns with it.
    let half = HEIGHT / 2.0;
    let moves = [
        1.0 - curvature * (side * HALF + half * across),
        half * (ALONG * curvature + across_by_way),
        0.0,
    ];
    // Out of the flank: to the left of its way.
    let out = unit(cross(ruling, moves)).map(|value| side * value);
    let axis = unit(ruling);
    let tip = [RADIUS * out[0], side * HALF + RADIUS * out[1], RADIUS * out[2]];
    let (sine, cosine) = libm::sincos(heading(way));
    let turned = |[along, left, up]: [f64; 3]| {
        [cosine * along - sine * left, sine * along + cosine * left, up]
    };
    let ([x, y, z], [i, j, k]) = (turned(tip), turned(axis));
    [foot[0] + x, foot[1] + y, FOOT + z, i, j, k]
}

/// The place straight on from one to the next, [`BEYOND`] behind it.
fn beyond(from: &[f64; 6], to: &[f64; 6]) -> [f64; 6] {
    let on = unit([0, 1, 2].map(|xyz| to[xyz] - from[xyz]));
    moved(to, on, BEYOND)
}

/// Along its axis, off the part.
fn drawn_back(place: &[f64; 6]) -> [f64; 6] {
    moved(place, [place[3], place[4], place[5]], BACK)
}

fn moved(place: &[f64; 6], direction: [f64; 3], by: f64) -> [f64; 6] {
    let mut moved = *place;
    for (value, part) in moved.iter_mut().zip(direction) {
        *value += by * part;
    }
    moved
}

fn goto(out: &mut impl Write, [x, y, z, i, j, k]: &[f64; 6]) -> io::Result<()> {
    writeln!(out, "GOTO/{x:.4},{y:.4},{z:.4},{i:.7},{j:.7},{k:.7}")
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = libm::sqrt(vector.iter().map(|value| value * value).sum());
    vector.map(|value| value / length)
}
