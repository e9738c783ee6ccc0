//! CATIA's arcs: where the tool sets out, the surface it stays on, and the curve that it goes along, nested in
//! parentheses.

use super::{Read, other};
use crate::cl::line::{LogicalLine, number_of};
use crate::cl::record::{AlongArc, Direction, Point, Statement};
use crate::fault::SyntaxFault;

/// `CIRCLE/0,0,0,10`: a word and what is behind its slash.
#[derive(Debug, PartialEq)]
struct Geometry {
    word: String,
    items: Vec<NestedItem>,
}

#[derive(Debug, PartialEq)]
enum NestedItem {
    Number(f64),
    Word(String),
    Geometry(Geometry),
}

/// Geometry within geometry within …: no CAM system goes deeper.
const DEEPEST: usize = 8;

/// `PSIS/(PLANE/(POINT/x,y,z),PERPTO,(VECTOR/i,j,k))`; any other surface is left to those who know it.
pub(crate) fn psis(line: &LogicalLine<'_>) -> Read<Statement> {
    let (_, items) = nested(line)?;
    Ok(match items.as_slice() {
        [plane] if let Some((_, normal)) = plane_across(plane) => {
            Statement::PartSurface(Some(normal))
        }
        _ => other(line, false),
    })
}

/// `TLON,GOFWD/` with an arc in its two forms; anything else is left to those who know it.
pub(crate) fn tlon(line: &LogicalLine<'_>) -> Read<Statement> {
    let (modifier, items) = nested(line)?;
    if modifier != ",GOFWD" {
        return Ok(other(line, false));
    }
    let arc = match items.as_slice() {
        [curve, NestedItem::Word(on), until] if on == "ON" => {
            circle(curve, until).or_else(|| cylinder(curve, until)).transpose()
        }
        _ => Ok(None),
    };
    match arc {
        Ok(Some(arc)) => Ok(Statement::AlongArc(arc)),
        Ok(None) => Ok(other(line, false)),
        Err(message) => {
            Err(SyntaxFault::new(line.text, line.word_span.end..line.text.len(), message))
        }
    }
}

/// `(CIRCLE/c,r),ON,(LINE/c,end)`. The line begins at the centre.
fn circle(curve: &NestedItem, until: &NestedItem) -> Option<Result<AlongArc, &'static str>> {
    let [x, y, z, radius] = numbers("CIRCLE", curve)?;
    let [from_x, from_y, from_z, ex, ey, ez] = numbers("LINE", until)?;
    if [from_x, from_y, from_z] != [x, y, z] {
        return Some(Err("the line that ends the arc does not begin at the circle's centre"));
    }
    Some(Ok(AlongArc { centre: [x, y, z], axis: None, radius, end: [ex, ey, ez] }))
}

/// `(CYLNDR/c,u,r),ON,(PLANE/PERPTO,(PLANE/(POINT/…),PERPTO,(VECTOR/…)),(POINT/c),(POINT/end))`.
fn cylinder(curve: &NestedItem, until: &NestedItem) -> Option<Result<AlongArc, &'static str>> {
    let [x, y, z, i, j, k, radius] = numbers("CYLNDR", curve)?;
    let [NestedItem::Word(across), plane, through, end] = behind("PLANE", until)? else {
        return None;
    };
    let (_, normal) = plane_across(plane)?;
    let (through, end) = (numbers::<3>("POINT", through)?, numbers("POINT", end)?);
    if across != "PERPTO" {
        return None;
    }
    if along(normal, [i, j, k]) < PARALLEL {
        return Some(Err("the plane that ends the arc does not stand along the cylinder's axis"));
    }
    let way = [through[0] - x, through[1] - y, through[2] - z];
    let across_axis = [way[1] * k - way[2] * j, way[2] * i - way[0] * k, way[0] * j - way[1] * i];
    let off = size(across_axis) / size([i, j, k]);
    if off > 1e-3 * radius.abs().max(1.0) {
        return Some(Err("the plane that ends the arc does not go through the cylinder's axis"));
    }
    Some(Ok(AlongArc { centre: [x, y, z], axis: Some([i, j, k]), radius, end }))
}

/// Directions whose angle has a larger cosine are one: 0.1°.
const PARALLEL: f64 = 0.999_998;

/// Cosine of the angle between two directions, whatever their sense; 0 if one is null.
fn along(a: Direction, b: Direction) -> f64 {
    let dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let sizes = size(a) * size(b);
    if sizes > 0.0 { (dot / sizes).abs() } else { 0.0 }
}

fn size(of: Direction) -> f64 {
    (of[0] * of[0] + of[1] * of[1] + of[2] * of[2]).sqrt()
}

/// `(PLANE/(POINT/x,y,z),PERPTO,(VECTOR/i,j,k))`: a point of it and its normal.
fn plane_across(item: &NestedItem) -> Option<(Point, Direction)> {
    match behind("PLANE", item)? {
        [point, NestedItem::Word(across), normal] if across == "PERPTO" => {
            Some((numbers("POINT", point)?, numbers("VECTOR", normal)?))
        }
        _ => None,
    }
}

/// What follows the word, if the item is geometry of that word.
fn behind<'i>(word: &str, item: &'i NestedItem) -> Option<&'i [NestedItem]> {
    match item {
        NestedItem::Geometry(geometry) if geometry.word == word => Some(&geometry.items),
        _ => None,
    }
}

/// The `N` numbers after the word; a fault if anything else stands there.
fn numbers<const N: usize>(word: &str, item: &NestedItem) -> Option<[f64; N]> {
    let items = behind(word, item)?;
    let mut numbers = [0.0; N];
    if items.len() != N {
        return None;
    }
    for (number, item) in numbers.iter_mut().zip(items) {
        match item {
            NestedItem::Number(value) => *number = *value,
            _ => return None,
        }
    }
    Some(numbers)
}

/// What stands between word and slash, in capitals and without blanks, and the items after it.
fn nested(line: &LogicalLine<'_>) -> Read<(String, Vec<NestedItem>)> {
    let text = line.text.split_once("$$").map_or(line.text, |(text, _)| text);
    let text = text.get(line.word_span.end..).unwrap_or_default();
    let mut code: String = text.split_whitespace().collect();
    code.make_ascii_uppercase();
    let (modifier, mut rest) = code.split_once('/').unwrap_or((&code, ""));
    let read = items(&mut rest, 0).filter(|_| rest.is_empty());
    match read {
        Some(items) => Ok((modifier.to_owned(), items)),
        None => Err(SyntaxFault::new(
            line.text,
            line.word_span.end..line.text.len(),
            "this geometry cannot be read",
        )
        .help("expected items between commas, each a number, a word or geometry in parentheses: (POINT/1,2,3)")),
    }
}

/// The items at the start of `rest`, which is left with what follows them.
fn items(rest: &mut &str, depth: usize) -> Option<Vec<NestedItem>> {
    let mut items = Vec::new();
    loop {
        items.push(item(rest, depth)?);
        match rest.strip_prefix(',') {
            Some(more) => *rest = more,
            None => return Some(items),
        }
    }
}

fn item(rest: &mut &str, depth: usize) -> Option<NestedItem> {
    if let Some(inside) = rest.strip_prefix('(') {
        if depth == DEEPEST {
            return None;
        }
        let (word, behind) = inside.split_once('/')?;
        if word.is_empty() || !word.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
            return None;
        }
        *rest = behind;
        let items = items(rest, depth + 1)?;
        *rest = rest.strip_prefix(')')?;
        let word = word.to_owned();
        return Some(NestedItem::Geometry(Geometry { word, items }));
    }
    let end = rest.find([',', '(', ')', '/']).unwrap_or(rest.len());
    let (text, behind) = rest.split_at(end);
    *rest = behind;
    if text.is_empty() {
        return None;
    }
    Some(match number_of(text) {
        Some(value) => NestedItem::Number(value),
        None => NestedItem::Word(text.to_owned()),
    })
}
