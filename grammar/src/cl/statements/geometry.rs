//! Points, directions, frames and curves.

use super::Read;
use super::items::{Items, word};
use super::technology::sense;
use crate::cl::record::{ArcMove, CircleRecord, Delta, Rotate, Sense, Statement};
use crate::fault::SyntaxFault;

pub(crate) fn goto(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "GOTO/x,y,z, GOTO/x,y,z,i,j,k or, with the direction of an edge, GOTO/x,y,z,i,j,k,u,v,w";
    if items.line.items.len() == 9 {
        let [x, y, z, i, j, k, u, v, w] = items.array(FORM)?;
        return Ok(Statement::GotoEdge { point: [x, y, z], axis: [i, j, k], edge: [u, v, w] });
    }
    let (point, axis) = items.point_or("3, 6 or 9", FORM)?;
    Ok(Statement::Goto { point, axis })
}

/// A name or a number; anything else is left to those who know it.
pub(crate) fn head(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.line.items.as_slice() {
        [name] if !name.text.is_empty() => Ok(Statement::Head(name.text.to_owned())),
        _ => items.other(),
    }
}

pub(crate) fn from(items: &mut Items<'_, '_>) -> Read<Statement> {
    let (point, axis) = items.point("FROM/x,y,z or FROM/x,y,z,i,j,k")?;
    Ok(Statement::From { point, axis })
}

pub(crate) fn cntrl(items: &mut Items<'_, '_>) -> Read<Statement> {
    let (point, axis) = items.point("CNTRL/x,y,z or CNTRL/x,y,z,i,j,k")?;
    Ok(Statement::Control { point, axis })
}

pub(crate) fn gohome(items: &mut Items<'_, '_>) -> Read<Statement> {
    if items.peek().is_none() {
        return Ok(Statement::Gohome(None));
    }
    let home = items.point("GOHOME, GOHOME/x,y,z or GOHOME/x,y,z,i,j,k")?;
    Ok(Statement::Gohome(Some(home)))
}

pub(crate) fn godlta(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "GODLTA/dx,dy,dz or GODLTA/d";
    match *items.numbers(FORM)?.as_slice() {
        [d] => Ok(Statement::Godlta(Delta::AlongAxis(d))),
        [x, y, z] => Ok(Statement::Godlta(Delta::Step([x, y, z]))),
        ref numbers => Err(items.miscounted("1 or 3", numbers.len(), FORM)),
    }
}

pub(crate) fn multax(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.line.items.as_slice() {
        [] => Ok(Statement::Multax(true)),
        [item] if word(item) == "ON" => Ok(Statement::Multax(true)),
        [item] if word(item) == "OFF" => Ok(Statement::Multax(false)),
        _ => {
            Err(items.fault(items.rest(), "MULTAX is on or off", "MULTAX, MULTAX/ON or MULTAX/OFF"))
        }
    }
}

pub(crate) fn msys(items: &mut Items<'_, '_>) -> Read<Statement> {
    let [ox, oy, oz, xi, xj, xk, yi, yj, yk] =
        items.array("MSYS/ origin, X direction, Y direction")?;
    Ok(Statement::Msys { origin: [ox, oy, oz], x: [xi, xj, xk], y: [yi, yj, yk] })
}

pub(crate) fn csys(items: &mut Items<'_, '_>) -> Read<Statement> {
    let matrix = items.array("CSYS/ and the 3 x 4 matrix, row by row")?;
    Ok(Statement::Csys(matrix))
}

pub(crate) fn nurbs(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::Nurbs)
}

pub(crate) fn knot(items: &mut Items<'_, '_>) -> Read<Statement> {
    Ok(Statement::Knot(items.numbers("KNOT/u,u,...")?))
}

/// NX gives eleven numbers: after the radius two tolerances, the cutter's diameter and its corner radius,
/// which say nothing about the arc. Creo gives seven, SolidWorks CAM six, without the radius.
pub(crate) fn circle(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "CIRCLE/x,y,z,i,j,k[,radius], then CLW, CCLW or TIMES,n as needed";
    let numbers: Vec<f64> = std::iter::from_fn(|| items.take_number()).collect();
    let radius = match numbers.len() {
        6 => None,
        7 | 11 => Some(numbers[6]),
        found => {
            let end = match items.next {
                0 => return Err(items.fault(items.rest(), "CIRCLE needs numbers", FORM)),
                next => items.line.items[next - 1].span().end,
            };
            let fault = items.miscounted("6, 7 or 11", found, FORM);
            return Err(SyntaxFault { span: fault.span.start..end, ..fault });
        }
    };
    let mut circle = CircleRecord {
        centre: [numbers[0], numbers[1], numbers[2]],
        axis: [numbers[3], numbers[4], numbers[5]],
        radius,
        // NX means its axis so that the arc goes clockwise about it.
        sense: (numbers.len() == 11).then_some(Sense::Clockwise),
        turns: None,
    };
    while let Some(item) = items.take() {
        let name = word(item);
        if let (Some(found), None) = (sense(&name), circle.sense) {
            circle.sense = Some(found);
        } else if name == "TIMES" && circle.turns.is_none() {
            circle.turns = Some(items.whole("TIMES", FORM)?);
        } else {
            return Err(items.unexpected(item, "a sense or TIMES is expected", FORM));
        }
    }
    Ok(Statement::Circle(circle))
}

/// Autodesk's stock APT posts: centre, axis, radius, `ANGLE` and degrees.
pub(crate) fn movarc(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "MOVARC/x,y,z,i,j,k,radius,ANGLE,degrees";
    let mut numbers = [0.0; 7];
    for number in &mut numbers {
        *number = items.number("MOVARC", FORM)?;
    }
    match items.take() {
        Some(item) if word(item) == "ANGLE" => {}
        Some(item) => return Err(items.unexpected(item, "ANGLE is expected", FORM)),
        None => return Err(items.fault(items.rest(), "MOVARC needs an ANGLE", FORM)),
    }
    let degrees = items.number("ANGLE", FORM)?;
    let [x, y, z, i, j, k, radius] = numbers;
    items.nothing(Statement::ArcMove(ArcMove {
        centre: [x, y, z],
        axis: [i, j, k],
        radius,
        degrees,
    }))
}

/// A direction by its numbers; one by name is left to those who know it.
pub(crate) fn indirv(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.peek() {
        Some(item) if item.value.is_some() => Ok(Statement::SetOut(items.array("INDIRV/i,j,k")?)),
        _ => items.other(),
    }
}

pub(crate) fn autops(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::PartSurface(None))
}

pub(crate) fn mcs(items: &mut Items<'_, '_>) -> Read<Statement> {
    let [xi, xj, xk, yi, yj, yk, zi, zj, zk, ox, oy, oz] =
        items.array("MCS/ X, Y and Z direction, origin")?;
    Ok(Statement::Mcs { axes: [[xi, xj, xk], [yi, yj, yk], [zi, zj, zk]], origin: [ox, oy, oz] })
}

/// CAMWorks puts the number first, in radians, and each move is a step that is undone at the operation's end.
/// APT and NX put the axis or `ATANGL` first and write degrees. A number first without the axis could be either.
pub(crate) fn rotate(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "ROTABL/AAXIS,degrees, ROTABL/ATANGL,degrees,CLW, ROTABL/INCR,degrees,CCLW or, from CAMWorks, ROTABL/radians,AAXIS,TABLE,CCLW";
    let radians = items.peek().is_some_and(|item| item.value.is_some());
    let (mut axis, mut angle, mut turning) = (None, None, None);
    let (mut incremental, mut member) = (false, false);
    for (index, item) in items.line.items.iter().enumerate() {
        let name = word(item);
        match name.as_ref() {
            "" if angle.is_none() && item.value.is_some() => angle = item.value,
            "AAXIS" | "BAXIS" | "CAXIS" if axis.is_none() => axis = name.chars().next(),
            "TABLE" | "HEAD" => member = true,
            "INCR" => incremental = true,
            "ABSOL" | "ATANGL" if !radians => {}
            _ if turning.is_none() && sense(&name).is_some() => turning = sense(&name),
            _ if index == 0 && !name.is_empty() => return items.other(),
            _ => {
                return Err(items.unexpected(
                    item,
                    "an index move is one axis, one angle and one sense",
                    FORM,
                ));
            }
        }
    }
    let Some(angle) = angle else {
        items.next = items.line.items.len();
        return Err(items.fault(items.rest(), format!("{} needs an angle", items.line.word), FORM));
    };
    if radians && !(axis.is_some() && member) {
        let message =
            "this may be degrees or radians: with the angle first, the axis and TABLE must follow";
        return Err(items.fault(items.rest(), message, FORM));
    }
    Ok(Statement::Rotate(Rotate { axis, angle, radians, incremental, sense: turning }))
}

pub(crate) fn tlaxis(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.peek() {
        Some(item) if item.value.is_none() && !item.text.is_empty() => items.other(),
        _ => Ok(Statement::ToolAxis(items.array("TLAXIS/i,j,k")?)),
    }
}
