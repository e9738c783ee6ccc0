//! Rows of a list: cells by the names of their columns.

use super::{Cell, CellFault, SHOWN};
use crate::cl::{Direction, Point};
use crate::text::excerpt;

/// A point, and how the tool comes to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The tip.
    pub(super) point: Point,
    /// The tool axis, from the tip to the holder.
    pub(super) axis: Option<Direction>,
    /// Units a minute.
    pub(super) feed: Option<f64>,
    /// In a cut, or a rapid; none: as its place has it.
    pub(super) cuts: Option<bool>,
    /// Along an arc.
    pub(super) arc: Option<Arc>,
}

/// An arc that ends at its row's point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) centre: Point,
    /// It goes counter-clockwise about this, by the right hand.
    pub(super) axis: Direction,
}

/// What a column has. The order is that of [`NAMES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    Point,
    Axis,
    Feed,
    Rapid,
    Cut,
    Centre,
    ArcAxis,
}

/// Every column: its name, what it has, and which of three numbers it is.
const NAMES: &[(&str, Column, usize)] = &[
    ("x", Column::Point, 0),
    ("y", Column::Point, 1),
    ("z", Column::Point, 2),
    ("i", Column::Axis, 0),
    ("j", Column::Axis, 1),
    ("k", Column::Axis, 2),
    ("feed", Column::Feed, 0),
    ("rapid", Column::Rapid, 0),
    ("cut", Column::Cut, 0),
    ("arc_x", Column::Centre, 0),
    ("arc_y", Column::Centre, 1),
    ("arc_z", Column::Centre, 2),
    ("arc_i", Column::ArcAxis, 0),
    ("arc_j", Column::ArcAxis, 1),
    ("arc_k", Column::ArcAxis, 2),
];

/// The names, for messages.
const COLUMNS: &str =
    "x, y, z, i, j, k, feed, rapid or cut, arc_x, arc_y, arc_z, arc_i, arc_j, arc_k";

/// A direction shorter than this says nothing.
const NULL: f64 = 1e-9;

/// Where the columns stand in a row; a column that a list has not is none.
#[derive(Clone, Debug, Default)]
pub(super) struct RowColumns {
    count: usize,
    places: [Option<usize>; NAMES.len()],
}

/// `word` is the name of a column.
pub(super) fn is_column(word: &str) -> bool {
    NAMES.iter().any(|(name, ..)| name.eq_ignore_ascii_case(word))
}

impl RowColumns {
    /// Of a header.
    pub(super) fn of<'n>(names: impl Iterator<Item = &'n str>) -> Result<Self, CellFault> {
        let mut columns = Self::default();
        for (cell, name) in names.enumerate() {
            columns.count = cell + 1;
            let known = NAMES.iter().position(|(known, ..)| known.eq_ignore_ascii_case(name));
            let Some(known) = known else {
                let (message, help) = match name.to_ascii_lowercase().as_str() {
                    "" => (format!("column {} has no name", cell + 1), String::new()),
                    "e" => (
                        "amounts of an extruder are not read from a list".to_owned(),
                        "leave the column out: [word.E] is = \"0.0333 * s\" in the machine file (on a printer; U, V or W on \
                         others) goes with the way of the tip; a bead of another width is a list of its own"
                            .to_owned(),
                    ),
                    _ => {
                        let name = excerpt(name, SHOWN);
                        (format!("a list of points has no column `{name}`"), String::new())
                    }
                };
                let help = if help.is_empty() { format!("expected of {COLUMNS}") } else { help };
                return Err(CellFault::at(cell, message, help));
            };
            if columns.places[known].replace(cell).is_some() {
                let message = format!("the column `{name}` stands here twice");
                return Err(CellFault::at(cell, message, "leave one of them out"));
            }
        }
        columns.whole()?;
        Ok(columns)
    }

    /// Columns that go together are there together.
    fn whole(&self) -> Result<(), CellFault> {
        let lacks = |column: Column| {
            let mut missing = NAMES
                .iter()
                .zip(&self.places)
                .filter(|((_, of, _), place)| *of == column && place.is_none())
                .map(|((name, ..), _)| *name);
            (missing.clone().count(), missing.next().unwrap_or_default())
        };
        for (column, needed) in [
            (Column::Point, true),
            (Column::Axis, false),
            (Column::Centre, self.has(Column::ArcAxis)),
            (Column::ArcAxis, self.has(Column::Centre)),
        ] {
            let (count, first) = lacks(column);
            if count > 0 && (needed || count < 3) {
                let message = format!("the column `{first}` is missing");
                return Err(CellFault::whole(message, format!("the columns are {COLUMNS}")));
            }
        }
        match self.has(Column::Rapid) && self.has(Column::Cut) {
            true => Err(CellFault::whole(
                "`rapid` and `cut` say the same".to_owned(),
                "leave one of the columns out",
            )),
            false => Ok(()),
        }
    }

    fn has(&self, column: Column) -> bool {
        NAMES.iter().zip(&self.places).any(|((_, of, _), place)| *of == column && place.is_some())
    }

    /// The row of these cells.
    pub(super) fn row(&self, cells: &[Cell]) -> Result<Row, CellFault> {
        if cells.len() != self.count {
            let plural = if cells.len() == 1 { "" } else { "s" };
            let message = format!(
                "{} value{plural} in a row, and there are {} columns",
                cells.len(),
                self.count
            );
            return Err(CellFault::whole(
                message,
                "each row has a value of each column; one that it has not is empty",
            ));
        }
        let point = self.three(Column::Point, cells)?;
        let Some(point) = point else {
            return Err(CellFault::whole(
                "a row without a position".to_owned(),
                "x, y and z are numbers",
            ));
        };
        let cuts = match self.flag(Column::Cut, cells)? {
            Some(cuts) => Some(cuts),
            None => self.flag(Column::Rapid, cells)?.map(|rapid| !rapid),
        };
        let centre = self.three(Column::Centre, cells)?;
        let about = self.direction(Column::ArcAxis, cells)?;
        let arc = match (centre, about) {
            (Some(centre), Some(axis)) => Some(Arc { centre, axis }),
            (None, None) => None,
            _ => {
                return Err(CellFault::whole(
                    "an arc needs its centre and its axis".to_owned(),
                    "arc_x, arc_y, arc_z, arc_i, arc_j, arc_k have numbers, or none of them has",
                ));
            }
        };
        if arc.is_some() && cuts == Some(false) {
            return Err(CellFault::whole(
                "an arc is no rapid".to_owned(),
                "come to its end in a cut, or on a straight line",
            ));
        }
        let feed = self.feed(cells)?;
        Ok(Row { point, axis: self.direction(Column::Axis, cells)?, feed, cuts, arc })
    }

    /// Cells of a column of three numbers, and their names.
    fn cells_of<'c>(
        &self,
        column: Column,
        cells: &'c [Cell],
    ) -> impl Iterator<Item = (&'static str, usize, &'c Cell)> {
        let found = NAMES.iter().zip(self.places).filter(move |((_, of, _), _)| *of == column);
        found.filter_map(|((name, ..), place)| Some((*name, place?, cells.get(place?)?)))
    }

    /// Three numbers; none if all of them are empty.
    fn three(&self, column: Column, cells: &[Cell]) -> Result<Option<[f64; 3]>, CellFault> {
        let empty = self.cells_of(column, cells).all(|(.., cell)| *cell == Cell::Empty);
        if empty {
            return Ok(None);
        }
        let mut numbers = [0.0; 3];
        for (number, (name, place, cell)) in numbers.iter_mut().zip(self.cells_of(column, cells)) {
            *number = number_of(name, place, cell)?;
        }
        Ok(Some(numbers))
    }

    /// Three numbers that are a direction, of length one.
    fn direction(&self, column: Column, cells: &[Cell]) -> Result<Option<Direction>, CellFault> {
        let Some(direction) = self.three(column, cells)? else {
            return Ok(None);
        };
        let longest = direction.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        if longest < NULL {
            let first = self.cells_of(column, cells).map(|(_, place, _)| place).next();
            return Err(CellFault {
                cell: first,
                message: "a direction of no length".to_owned(),
                help: "the tool axis points from the tip to the holder: 0, 0, 1".to_owned(),
            });
        }
        Ok(Some(direction))
    }

    fn feed(&self, cells: &[Cell]) -> Result<Option<f64>, CellFault> {
        let Some((name, place, cell)) = self.cells_of(Column::Feed, cells).next() else {
            return Ok(None);
        };
        if *cell == Cell::Empty {
            return Ok(None);
        }
        match number_of(name, place, cell)? {
            feed if feed > 0.0 => Ok(Some(feed)),
            feed => Err(CellFault::at(
                place,
                format!("a feed of {feed}"),
                "units a minute, above 0; an empty one is that of the settings, or of before",
            )),
        }
    }

    fn flag(&self, column: Column, cells: &[Cell]) -> Result<Option<bool>, CellFault> {
        let Some((name, place, cell)) = self.cells_of(column, cells).next() else {
            return Ok(None);
        };
        let given = match cell {
            Cell::Empty => return Ok(None),
            Cell::Flag(flag) => Some(*flag),
            Cell::Number(number) if *number == 1.0 => Some(true),
            Cell::Number(number) if *number == 0.0 => Some(false),
            _ => None,
        };
        let wrong =
            || CellFault::at(place, format!("`{name}` cannot be this"), "1 or 0, true or false");
        given.map(Some).ok_or_else(wrong)
    }
}

fn number_of(name: &str, place: usize, cell: &Cell) -> Result<f64, CellFault> {
    match cell {
        Cell::Number(number) => Ok(*number),
        Cell::Empty => {
            Err(CellFault::at(place, format!("`{name}` is empty"), "a number stands here"))
        }
        Cell::Text(text) if text.contains(',') => Err(CellFault::at(
            place,
            format!("`{name}` has a comma: a decimal comma is not read"),
            "write numbers with a point, 1.5",
        )),
        Cell::Text(_) | Cell::Flag(_) => Err(CellFault::at(
            place,
            format!("`{name}` is no number"),
            "a decimal number such as -12.5 or 1e-3; neither NaN nor infinite",
        )),
    }
}
