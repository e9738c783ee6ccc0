//! Writes a cutter-location file of any length: a finishing pass over a wavy surface, the tool leaning along
//! the surface's normal. `cargo run --release --example generate -- 10000000 > big.cls`

use std::io::{self, BufWriter, Write};

/// Points of one row; the next row lies beside it and goes back.
const ROW: u64 = 2000;
/// Rows before the surface is gone over again.
const ROWS: u64 = 500;

fn main() -> io::Result<()> {
    let count = std::env::args()
        .nth(1)
        .and_then(|count| count.parse().ok())
        .unwrap_or(1000);
    let mut out = BufWriter::new(io::stdout().lock());
    write_file(&mut out, count)?;
    out.flush()
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
                writeln!(
                    out,
                    "GOTO/{x:.4},{y:.4},{:.4},{i:.6},{j:.6},{k:.6}",
                    z + 50.0
                )?;
                writeln!(out, "FEDRAT/MMPM,1500.0000")?;
            }
            1 => writeln!(out, "FEDRAT/MMPM,3000.0000")?,
            _ => {}
        }
        writeln!(out, "GOTO/{x:.4},{y:.4},{z:.4},{i:.6},{j:.6},{k:.6}")?;
    }
    writeln!(out, "RAPID")?;
    let [x, y, z, i, j, k] = point(count.saturating_sub(1));
    writeln!(
        out,
        "GOTO/{x:.4},{y:.4},{:.4},{i:.6},{j:.6},{k:.6}",
        z + 50.0
    )?;
    writeln!(out, "SPINDL/OFF")?;
    writeln!(out, "COOLNT/OFF")?;
    writeln!(out, "END-OF-PATH")
}

/// Point and tool axis: a sine in both directions, 120 by 80 mm, the tool leaning 20 degrees forward.
fn point(index: u64) -> [f64; 6] {
    let row = index / ROW;
    let along = (index % ROW) as f64 / (ROW - 1) as f64;
    let across = (row % ROWS) as f64 / (ROWS - 1) as f64;
    let u = if row.is_multiple_of(2) {
        along
    } else {
        1.0 - along
    };
    let (x, y) = (120.0 * u - 60.0, 80.0 * across - 40.0);
    let (sx, cx) = libm::sincos(x / 25.0);
    let (sy, cy) = libm::sincos(y / 30.0);
    let z = 6.0 * sx * cy + 20.0;
    // The normal of the surface, leaned forward along X.
    let normal = [-6.0 / 25.0 * cx * cy - 0.364, 6.0 / 30.0 * sx * sy, 1.0];
    let length = libm::sqrt(normal.iter().map(|n| n * n).sum());
    [
        x,
        y,
        z,
        normal[0] / length,
        normal[1] / length,
        normal[2] / length,
    ]
}
