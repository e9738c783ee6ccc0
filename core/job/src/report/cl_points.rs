//! The points of the path of a CL file as a table, told against the tips of the blocks.
//!
//! Both come as they come: they are kept on the disk, and walked through together when all are there.

use std::collections::VecDeque;
use std::io::{self, BufRead as _, BufReader, Read, Write};

use nalgebra::Vector3;
use post_machine::description::Machine;

use super::block_rows::decimals;
use super::page_table::PageTable;
use super::parts::{Parts, fault};
use crate::columns::Column;
use crate::failure::Failure;
use crate::files::Scratch;

/// The block of a line is looked for so many blocks ahead. The page has the same number.
const AHEAD: usize = 64;

/// A point of the path, as it is packed.
pub struct ClPointRow {
    /// Its line.
    pub line: u64,
    /// Where it is, mm.
    pub at: Vector3<f64>,
    /// 1: the tool comes there at rapid; 2: from elsewhere; 0: in a cut.
    pub rapid: f64,
}

/// The table; its places told against the blocks, if their tips are there.
///
/// # Errors
/// There is no place for it.
pub fn table(machine: &Machine, told: bool) -> Result<PageTable<ClPointRow>, Failure> {
    // A tenth of the decimals of the bounds: the path is looked at.
    let decimals = decimals(machine.accuracy.tolerance) - 1;
    let mut columns = vec![Column::new("line", "", 0, |row: &ClPointRow| row.line)];
    for (place, name) in ["x", "y", "z"].into_iter().enumerate() {
        let column = Column::new(name, "mm", decimals, move |row: &ClPointRow| row.at[place]);
        columns.push(match told {
            true => column.from("blocks"),
            false => column,
        });
    }
    columns.push(Column::new("rapid", "", 0, |row: &ClPointRow| row.rapid));
    PageTable::new("cl", columns)
}

/// Lines, places, and a number more, 40 bytes each.
pub struct Points {
    kept: Scratch,
    fault: Option<Failure>,
}

impl Points {
    /// None yet.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new() -> Result<Self, Failure> {
        Ok(Self { kept: Parts::scratch()?, fault: None })
    }

    /// Keeps a point.
    pub fn push(&mut self, line: u64, at: Vector3<f64>, more: f64) {
        let mut bytes = [0; 40];
        let values = [line as f64, at.x, at.y, at.z, more];
        for (place, value) in bytes.chunks_exact_mut(8).zip(values) {
            place.copy_from_slice(&value.to_le_bytes());
        }
        if let Err(error) = self.kept.write_all(&bytes) {
            self.fault.get_or_insert(fault(error));
        }
    }

    fn read(self) -> Result<PointReader<impl Read>, Failure> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        let mut kept = self.kept.reread()?;
        io::Seek::rewind(&mut kept).map_err(fault)?;
        Ok(PointReader(BufReader::new(kept)))
    }
}

struct PointReader<R>(BufReader<R>);

impl<R: Read> PointReader<R> {
    /// The next point; none at the end.
    ///
    /// # Errors
    /// They cannot be read again.
    fn next(&mut self) -> Result<Option<[f64; 5]>, Failure> {
        if self.0.fill_buf().map_err(fault)?.is_empty() {
            return Ok(None);
        }
        let mut values = [0.0; 5];
        for value in &mut values {
            let mut bytes = [0; 8];
            self.0.read_exact(&mut bytes).map_err(fault)?;
            *value = f64::from_le_bytes(bytes);
        }
        Ok(Some(values))
    }
}

/// Packs the points of a path against the ends of the blocks, each with the line of the CL file that it comes from.
///
/// # Errors
/// They cannot be read again, or not be written.
pub fn pack(
    machine: &Machine,
    path: Points,
    blocks: Points,
    parts: &mut Parts,
) -> Result<(), Failure> {
    let mut table = table(machine, true)?;
    let (mut path, mut blocks) = (path.read()?, blocks.read()?);
    let mut near: VecDeque<[f64; 5]> = VecDeque::new();
    let mut line = f64::NAN;
    while let Some([of, x, y, z, rapid]) = path.next()? {
        if of != line {
            line = of;
            walk(line, &mut near, &mut blocks)?;
        }
        let tip = near.front().map_or([0.0; 3], |block| [block[1], block[2], block[3]]);
        let at = Vector3::new(x - tip[0], y - tip[1], z - tip[2]);
        table.row(&ClPointRow { line: line as u64, at, rapid });
    }
    table.finish(parts)
}

/// Goes on to the last of the next blocks that come from a line, if it has one near.
///
/// # Errors
/// The blocks cannot be read again.
fn walk(
    line: f64,
    near: &mut VecDeque<[f64; 5]>,
    blocks: &mut PointReader<impl Read>,
) -> Result<(), Failure> {
    let mut fill = |near: &mut VecDeque<[f64; 5]>, count: usize| -> Result<(), Failure> {
        while near.len() < count
            && let Some(block) = blocks.next()?
        {
            near.push_back(block);
        }
        Ok(())
    };
    fill(near, AHEAD)?;
    let ahead = near.iter().take(AHEAD);
    let Some(place) = ahead.into_iter().position(|block| block[0] == line) else {
        return Ok(());
    };
    near.drain(..place);
    loop {
        fill(near, 2)?;
        match near.get(1) {
            Some(next) if next[0] == line => near.pop_front(),
            _ => return Ok(()),
        };
    }
}
