//! Writes a cutter-location file of any length: a finishing pass over a wavy surface, the tool leaning along
//! the surface's normal. `cargo run --release --example generate -- 10000000 > big.cls`
//!
//! And a blade for a disc cutter, so many rows of it:
//! `cargo run --example generate -- blade 4 > tests/samples/disc-blade.cls`
//!
//! And the flanks of an S-shaped test piece, in so many cuts each:
//! `cargo run --example generate -- s-piece 240 > tests/samples/s-piece.cls`

#[path = "common/s_piece.rs"]
mod s_piece;

use std::io::{self, BufWriter, Write};

pub use s_piece::write_s_piece;

/// Points of one row; the next row lies beside it and goes back.
const ROW: u64 = 2000;
/// Rows before the surface is gone over again.
const ROWS: u64 = 500;

/// Swing length of the disc cutter, mm.
const SWING: f64 = 312.0;
/// Points of one row of the blade.
const BLADE_ROW: usize = 25;
/// Mean and standard deviation of the largest deviation over the moves of a row, mm (Sha et al. 2022, section 3.2).
const BLADE_DEVIATION: [f64; 2] = [0.01715, 0.001348];
/// A at the second of the points of section 2.2, degrees, and X and Z there, mm.
const BLADE_END: f64 = -2.1501;
const BLADE_POINT: [f64; 2] = [36.2549, 8.2580];

fn main() -> io::Result<()> {
    let mut words = std::env::args().skip(1);
    let first = words.next();
    let number = |word: Option<String>| word.and_then(|word| word.parse().ok());
    let mut out = BufWriter::new(io::stdout().lock());
    match first.as_deref() {
        Some("blade") => write_blade(&mut out, number(words.next()).unwrap_or(4))?,
        Some("s-piece") => write_s_piece(&mut out, number(words.next()).unwrap_or(240))?,
        _ => write_file(&mut out, number(first).unwrap_or(1000))?,
    }
    out.flush()
}

/// A blade as the disc cutter of Sha et al. 2022 mills it, to and fro in `rows` rows of 25 points, and off the part
/// between them. The first half of the rows is the convex side, on the arc through the two points that section 2.2 of
/// the paper gives, the others the concave side, on the same arc the other way round. The tool stands across it, so
/// that A alone turns and C stands still. The turns of A are such that the deviations at the paper's mean
/// swing length have the mean and the standard deviation that it tells of its 24 moves.
pub fn write_blade(out: &mut impl Write, rows: u64) -> io::Result<()> {
    writeln!(out, "TOOL PATH/BLADE,TOOL,DISC_50")?;
    writeln!(out, "UNITS/MM")?;
    writeln!(out, "LOAD/TOOL,1,ADJUST,1")?;
    writeln!(out, "SPINDL/6000,RPM,CLW")?;
    let angles = blade_angles();
    for row in 0..rows {
        let back = !row.is_multiple_of(2);
        let y = 2.0 * row as f64;
        let places = (0..BLADE_ROW).map(|index| {
            let angle = angles[if back { BLADE_ROW - 1 - index } else { index }];
            blade_point(angle, y, 2 * row < rows)
        });
        let places: Vec<[f64; 6]> = places.collect();
        let over = |out: &mut dyn Write, [x, y, z, i, j, k]: [f64; 6], lift: f64| {
            let z = z + lift;
            writeln!(out, "GOTO/{x:.6},{y:.6},{z:.6},{i:.9},{j:.9},{k:.9}")
        };
        writeln!(out, "RAPID")?;
        over(out, places[0], 20.0)?;
        writeln!(out, "RAPID")?;
        over(out, places[0], 0.0)?;
        writeln!(out, "FEDRAT/MMPM,6000.0")?;
        for place in &places[1..] {
            over(out, *place, 0.0)?;
        }
        writeln!(out, "RAPID")?;
        over(out, places[BLADE_ROW - 1], 20.0)?;
    }
    writeln!(out, "SPINDL/OFF")?;
    writeln!(out, "END-OF-PATH")
}

/// Values of A along a row, radians; the last is that of the paper's second point.
fn blade_angles() -> [f64; BLADE_ROW] {
    let [mean, spread] = BLADE_DEVIATION;
    let moves = (BLADE_ROW - 1) as f64;
    let mut angles = [BLADE_END.to_radians(); BLADE_ROW];
    for index in (0..BLADE_ROW - 1).rev() {
        // Whole waves over the row have the mean 0; the squares of these heights sum up to 2, so that their standard
        // deviation is 1.
        let wave = [(1.0, 1.0), (5.0, 0.8), (7.0, 0.6)].map(|(count, height)| {
            height * libm::sin(std::f64::consts::TAU * count * index as f64 / moves + count)
        });
        let deviation = mean + spread * wave.iter().sum::<f64>();
        // A turn of Δ makes the tip stray by Lm·(1 - cos(Δ/2)).
        angles[index] = angles[index + 1] - 2.0 * libm::acos(1.0 - deviation / SWING);
    }
    angles
}

/// Point and tool axis of the blade where A has this value, radians.
fn blade_point(angle: f64, y: f64, convex: bool) -> [f64; 6] {
    // Of the circle across the paper's two tool axes through its two points.
    let radius = if convex { 136.735 } else { -136.735 };
    let (sine, cosine) = libm::sincos(angle);
    let (end_sine, end_cosine) = libm::sincos(BLADE_END.to_radians());
    [
        BLADE_POINT[0] + radius * (sine - end_sine),
        y,
        BLADE_POINT[1] + radius * (cosine - end_cosine),
        sine,
        0.0,
        cosine,
    ]
}

/// A file of `count` five-axis points in the form that NX writes.
pub fn write_file(out: &mut impl Write, count: u64) -> io::Result<()> {
    writeln!(out, "TOOL PATH/WAVE_FINISH,TOOL,BALL_10")?;
    writeln!(out, "TLDATA/MILL,10.0000,5.0000,75.0000,0.0000,0.0000")?;
    writeln!(out, "UNITS/MM")?;
    writeln!(out, "LOAD/TOOL,1,ADJUST,1")?;
    writeln!(out, "SPINDL/12000,RPM,CLW")?;
    writeln!(out, "COOLNT/FLOOD")?;
    for index in 0..count {
        let [x, y, z, i, j, k] = point(index);
        match index {
            0 => {
                writeln!(out, "RAPID")?;
                writeln!(out, "GOTO/{x:.4},{y:.4},{:.4},{i:.6},{j:.6},{k:.6}", z + 50.0)?;
                writeln!(out, "FEDRAT/MMPM,1500.0000")?;
            }
            1 => writeln!(out, "FEDRAT/MMPM,3000.0000")?,
            _ => {}
        }
        writeln!(out, "GOTO/{x:.4},{y:.4},{z:.4},{i:.6},{j:.6},{k:.6}")?;
    }
    writeln!(out, "RAPID")?;
    let [x, y, z, i, j, k] = point(count.saturating_sub(1));
    writeln!(out, "GOTO/{x:.4},{y:.4},{:.4},{i:.6},{j:.6},{k:.6}", z + 50.0)?;
    writeln!(out, "SPINDL/OFF")?;
    writeln!(out, "COOLNT/OFF")?;
    writeln!(out, "END-OF-PATH")
}

/// Point and tool axis: a sine in both directions, 120 by 80 mm, the tool leaning 20 degrees forward.
pub fn point(index: u64) -> [f64; 6] {
    let row = index / ROW;
    let along = (index % ROW) as f64 / (ROW - 1) as f64;
    let across = (row % ROWS) as f64 / (ROWS - 1) as f64;
    let u = if row.is_multiple_of(2) { along } else { 1.0 - along };
    let (x, y) = (120.0 * u - 60.0, 80.0 * across - 40.0);
    let (sx, cx) = libm::sincos(x / 25.0);
    let (sy, cy) = libm::sincos(y / 30.0);
    let z = 6.0 * sx * cy + 20.0;
    // The normal of the surface, leaned forward along X.
    let normal = [-6.0 / 25.0 * cx * cy - 0.364, 6.0 / 30.0 * sx * sy, 1.0];
    let length = libm::sqrt(normal.iter().map(|n| n * n).sum());
    [x, y, z, normal[0] / length, normal[1] / length, normal[2] / length]
}
