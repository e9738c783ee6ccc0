//! A column of the table over two others: a map for each file on each machine.

use std::fmt::Write as _;

use super::outcome::WRITTEN;
use super::table::{StudyTable, StudyValues};
use crate::files::svg::{self, label, line, upright};
use crate::text::number;

/// Room for the numbers beside and below a map, px.
const LEFT: f64 = 86.0;
const BELOW: f64 = 58.0;
const TOP: f64 = 70.0;
const RIGHT: f64 = 24.0;
/// Maps beside one another.
const ACROSS: usize = 3;
/// Least width of a cell with a number in it, px.
const TOLD: f64 = 44.0;
/// A map is about this wide and high, px.
const SPAN: [f64; 2] = [330.0, 230.0];
/// Sizes of a cell, px.
const CELL: [[f64; 2]; 2] = [[8.0, 64.0], [8.0, 30.0]];
/// Greys of the least and the largest value, 0 to 255.
const GREYS: [f64; 2] = [246.0, 130.0];

/// What is drawn over what: names of columns.
pub struct MapAxes {
    /// What goes across.
    pub x: String,
    /// What goes up.
    pub y: String,
    /// What the shade tells.
    pub value: String,
    /// Large values are the good ones.
    pub most: bool,
}

/// One cell: written with a value, or refused.
#[derive(Clone, Copy, PartialEq)]
enum MapCell {
    Empty,
    Refused,
    Value(f64),
}

/// The map of one file on one machine.
struct MapPanel {
    file: String,
    machine: String,
    /// Row by row, from the least of what goes up.
    cells: Vec<MapCell>,
}

impl MapAxes {
    /// The picture. Of several rows in one cell the best value is drawn.
    pub fn draw(&self, table: &StudyTable) -> String {
        let (xs, ys) = (places(table, &self.x), places(table, &self.y));
        let panels = self.panels(table, [&xs, &ys]);
        let cell: [f64; 2] = std::array::from_fn(|side| {
            let count = [xs.len(), ys.len()][side].max(1) as f64;
            (SPAN[side] / count).clamp(CELL[side][0], CELL[side][1])
        });
        let size = [xs.len() as f64 * cell[0], ys.len() as f64 * cell[1]];
        let pitch = [(LEFT + size[0] + RIGHT).max(300.0), TOP + size[1] + BELOW];
        let across = panels.len().clamp(1, ACROSS);
        let down = panels.len().div_ceil(across).max(1);
        let mut svg = svg::open(pitch[0] * across as f64, 44.0 + pitch[1] * down as f64);
        let values = panels.iter().flat_map(|panel| &panel.cells);
        let values: Vec<f64> = values
            .filter_map(|cell| match cell {
                MapCell::Value(value) => Some(*value),
                _ => None,
            })
            .collect();
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let middle = pitch[0] * across as f64 / 2.0;
        let note = match values.is_empty() {
            true => "nothing was written".to_owned(),
            false => format!(
                "from {} (light) to {} (dark); bold frame: {}; cross: refused",
                short(least),
                short(most),
                if self.most { "largest of all" } else { "least of all" }
            ),
        };
        label(&mut svg, [middle, 20.0], "middle", &self.value);
        label(&mut svg, [middle, 38.0], "middle", &note);
        for (index, panel) in panels.iter().enumerate() {
            let corner = [
                pitch[0] * (index % across) as f64 + LEFT,
                44.0 + pitch[1] * (index / across) as f64 + TOP,
            ];
            let middle = corner[0] + size[0] / 2.0;
            // Names without their folders, where that is enough to tell them apart.
            let short = |file: &str| {
                let name = std::path::Path::new(file).file_name();
                name.unwrap_or_default().to_string_lossy().into_owned()
            };
            let name = short(&panel.file);
            let alone = |other: &MapPanel| other.file == panel.file || short(&other.file) != name;
            let file = match panels.iter().all(alone) {
                true => &name,
                false => &panel.file,
            };
            let title = format!("{file} on {}", panel.machine);
            label(&mut svg, [middle, corner[1] - 12.0], "middle", &title);
            let best = if self.most { most } else { least };
            let shades = [least, most, best];
            draw_cells(&mut svg, panel, [corner, cell], xs.len(), shades);
            draw_axes(&mut svg, [corner, cell], [&xs, &ys]);
            label(&mut svg, [middle, corner[1] + size[1] + 40.0], "middle", &self.x);
            upright(&mut svg, [corner[0] - 66.0, corner[1] + size[1] / 2.0], &self.y);
        }
        svg.push_str("</svg>\n");
        svg
    }

    fn panels(&self, table: &StudyTable, [xs, ys]: [&[String]; 2]) -> Vec<MapPanel> {
        let text = |name: &str, row: usize| {
            let column = table.column(name);
            column.map(|values| values.text(row)).unwrap_or_default()
        };
        let mut panels: Vec<MapPanel> = Vec::new();
        for row in 0..table.rows {
            let [file, machine] = ["file", "machine"].map(|column| text(column, row));
            let named = |panel: &MapPanel| [&panel.file, &panel.machine] == [&file, &machine];
            let place = panels.iter().position(named);
            let place = place.unwrap_or_else(|| {
                panels.push(MapPanel {
                    file: file.clone(),
                    machine: machine.clone(),
                    cells: vec![MapCell::Empty; xs.len() * ys.len()],
                });
                panels.len() - 1
            });
            let at = |names: &[String], column: &str| {
                let text = text(column, row);
                names.iter().position(|name| *name == text)
            };
            let (Some(x), Some(y)) = (at(xs, &self.x), at(ys, &self.y)) else {
                continue;
            };
            let cell = &mut panels[place].cells[y * xs.len() + x];
            let value = table.column(&self.value).and_then(|all| all.number(row));
            let value = value.filter(|_| text("state", row) == WRITTEN);
            *cell = match (*cell, value) {
                (MapCell::Value(known), Some(value)) if self.most => {
                    MapCell::Value(known.max(value))
                }
                (MapCell::Value(known), Some(value)) => MapCell::Value(known.min(value)),
                (_, Some(value)) => MapCell::Value(value),
                (MapCell::Value(known), None) => MapCell::Value(known),
                (_, None) => MapCell::Refused,
            };
        }
        panels
    }
}

/// The values of a column, each once, as they are told: numbers by size, texts as they come.
fn places(table: &StudyTable, name: &str) -> Vec<String> {
    let Some(values) = table.column(name) else {
        return Vec::new();
    };
    let mut rows: Vec<usize> = (0..table.rows).collect();
    if !matches!(values, StudyValues::Texts(_)) {
        let order = |row: usize| values.number(row).unwrap_or(f64::INFINITY);
        rows.sort_by(|one, other| order(*one).total_cmp(&order(*other)));
    }
    let mut places: Vec<String> = Vec::new();
    for row in rows {
        let text = values.text(row);
        if !text.is_empty() && !places.contains(&text) {
            places.push(text);
        }
    }
    places
}

fn draw_cells(
    svg: &mut String,
    panel: &MapPanel,
    [corner, cell]: [[f64; 2]; 2],
    across: usize,
    [least, most, best]: [f64; 3],
) {
    let rows = panel.cells.len() / across.max(1);
    for (index, value) in panel.cells.iter().enumerate() {
        let x = corner[0] + (index % across) as f64 * cell[0];
        // What goes up does so in the picture.
        let y = corner[1] + (rows - 1 - index / across) as f64 * cell[1];
        match *value {
            MapCell::Empty => {}
            MapCell::Refused => {
                rect(svg, [x, y], cell, "#ffffff", 0.5);
                let room = 0.25;
                let (left, right) = (x + room * cell[0], x + (1.0 - room) * cell[0]);
                let (top, bottom) = (y + room * cell[1], y + (1.0 - room) * cell[1]);
                line(svg, [left, top], [right, bottom], "#808080", 1.0);
                line(svg, [left, bottom], [right, top], "#808080", 1.0);
            }
            MapCell::Value(value) => {
                let share = match most > least {
                    true => (value - least) / (most - least),
                    false => 0.0,
                };
                let grey = libm::rint(GREYS[0] + share * (GREYS[1] - GREYS[0])) as u8;
                let width = if value == best { 3.0 } else { 0.5 };
                let inner = width / 2.0;
                let (at, size) = ([x + inner, y + inner], [cell[0] - width, cell[1] - width]);
                rect(svg, at, size, &format!("#{grey:02x}{grey:02x}{grey:02x}"), width);
                if cell[0] >= TOLD && cell[1] >= 16.0 {
                    let middle = [x + cell[0] / 2.0, y + cell[1] / 2.0 + 4.5];
                    label(svg, middle, "middle", &short(value));
                }
            }
        }
    }
}

fn rect(svg: &mut String, [x, y]: [f64; 2], [width, height]: [f64; 2], fill: &str, line: f64) {
    // Writing to a String cannot fail.
    let _ = writeln!(
        svg,
        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"{fill}\" stroke=\"#000000\" stroke-width=\"{line}\"/>"
    );
}

/// The values beside and below, as many as have room.
fn draw_axes(svg: &mut String, [corner, cell]: [[f64; 2]; 2], [xs, ys]: [&[String]; 2]) {
    let bottom = corner[1] + ys.len() as f64 * cell[1];
    let widest = xs.iter().map(|x| x.chars().count()).max().unwrap_or(1);
    let every = |room: f64, needed: f64| libm::ceil(needed / room).max(1.0) as usize;
    let step = every(cell[0], 8.0 * widest as f64 + 8.0);
    for (index, x) in xs.iter().enumerate().step_by(step) {
        let at = corner[0] + (index as f64 + 0.5) * cell[0];
        line(svg, [at, bottom], [at, bottom + 4.0], "#000000", 1.0);
        label(svg, [at, bottom + 18.0], "middle", x);
    }
    for (index, y) in ys.iter().enumerate().step_by(every(cell[1], 16.0)) {
        let at = bottom - (index as f64 + 0.5) * cell[1];
        line(svg, [corner[0] - 4.0, at], [corner[0], at], "#000000", 1.0);
        label(svg, [corner[0] - 8.0, at + 4.5], "end", y);
    }
}

/// About four digits.
fn short(value: f64) -> String {
    let size = libm::fabs(value);
    let decimals = match size {
        _ if size >= 1000.0 => 0,
        _ if size >= 100.0 => 1,
        _ if size >= 10.0 => 2,
        _ if size >= 0.1 || size == 0.0 => 3,
        _ => 5,
    };
    number(value, decimals)
}
