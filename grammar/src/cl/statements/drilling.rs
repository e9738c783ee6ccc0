//! Cycles.

use super::Read;
use super::items::{Items, word};
use super::technology::feed_unit;
use crate::cl::line::LineItem;
use crate::cl::record::{Argument, Cycle, CycleDefinition, FeedRate, Statement};

/// What a record of a cycle looks like.
const FORM: &str = "CYCLE/OFF, CYCLE/ON or CYCLE/DRILL,FEDTO,depth,MMPM,feed,RAPTO,clearance,...";

/// Labelled numbers (NX, Creo, SolidWorks CAM) go to their field; bare ones to the first free one of depth,
/// clearance and return level, which is the order of APT (`CYCLE/DRILL,depth,IPM,feed,clearance`) and of CAMWorks.
pub(crate) fn cycle(items: &mut Items<'_, '_>) -> Read<Statement> {
    if let [item] = items.line.items.as_slice() {
        match word(item).as_ref() {
            "OFF" | "NOMORE" => return Ok(Statement::Cycle(Cycle::Off)),
            "ON" | "INIT" => return Ok(Statement::Cycle(Cycle::On)),
            _ => {}
        }
    }
    let mut cycle = CycleDefinition::default();
    // The kind's words stand first; a word further on is an option.
    let mut kinds_end = false;
    while let Some(item) = items.take() {
        let name = word(item);
        let labelled = labelled(&mut cycle, items, item, &name)?;
        kinds_end |= labelled || item.value.is_some();
        if labelled {
            continue;
        }
        match item.value {
            Some(value) => bare(&mut cycle, value),
            None if name.is_empty() => {
                return Err(items.unexpected(item, "a word or a number is expected", FORM));
            }
            None if matches!(name.as_ref(), "G98" | "G99") => cycle.rest.push(item.argument()),
            // The number after an option is the option's: it is no clearance.
            None if kinds_end => {
                cycle.rest.push(item.argument());
                cycle.rest.extend(items.take_number().map(Argument::Number));
            }
            None => cycle.kinds.push(name.into_owned()),
        }
    }
    if cycle.kinds.is_empty() {
        let span = items.line.items.first().map_or_else(|| items.rest(), LineItem::span);
        return Err(items.fault(span, "CYCLE needs the kind of cycle", FORM));
    }
    Ok(Statement::Cycle(Cycle::Define(Box::new(cycle))))
}

/// Takes a word that names the numbers after it; false if it is none.
fn labelled(
    cycle: &mut CycleDefinition,
    items: &mut Items<'_, '_>,
    item: &LineItem<'_>,
    name: &str,
) -> Read<bool> {
    match name {
        "FEDTO" | "DEPTH" => cycle.depth = Some(items.number(name, FORM)?),
        "RAPTO" | "CLEAR" => {
            cycle.rapid_to = Some(items.number(name, FORM)?);
            cycle.clearance = cycle.rapid_to;
        }
        // CAMWorks gives the first peck and those that follow, SolidWorks CAM each by its word.
        "STEP" | "PECKING" | "INCR" | "1STPECK" => {
            cycle.step = Some(items.number(name, FORM)?);
            cycle.later_step = items.take_number().or(cycle.later_step);
        }
        "SUBPECK" => cycle.later_step = Some(items.number(name, FORM)?),
        "PITCH" => cycle.pitch = Some(items.number(name, FORM)?),
        "TPI" => cycle.turns_per_inch = Some(items.number(name, FORM)?),
        "DIAMET" | "DIAMTR" | "DIA" => cycle.diameter = Some(items.number(name, FORM)?),
        "ANGLE" | "TLANGL" => cycle.angle = Some(items.number(name, FORM)?),
        // A kind of its own where it stands first; after that the number is what it adds to the depth.
        "THRU" if !cycle.kinds.is_empty() => match items.take_number() {
            Some(value) => cycle.break_through = Some(value),
            None => cycle.kinds.push(name.to_string()),
        },
        "NODRAG" | "ORIENT" => {
            cycle.shift = items.take_number();
            cycle.kinds.push(name.to_string());
        }
        "RTRCTO" | "RETURN" | "DWELL" => match (items.take_number(), name) {
            (Some(value), "DWELL") => cycle.dwell = Some(value),
            (Some(value), _) => cycle.retract = Some(value),
            // `RTRCTO,AUTO`, `DWELL,REV,2`
            (None, _) => {
                cycle.rest.push(item.argument());
                cycle.rest.extend(items.take().map(LineItem::argument));
                cycle.rest.extend(items.take_number().map(Argument::Number));
            }
        },
        _ if feed_unit(name).is_some() => {
            cycle.bare_before_feed = cycle.bare.len();
            cycle.feed =
                Some(FeedRate { value: Some(items.number(name, FORM)?), unit: feed_unit(name) });
        }
        _ => return Ok(false),
    }
    Ok(true)
}

/// Puts a number without a label into the first free field.
fn bare(cycle: &mut CycleDefinition, value: f64) {
    cycle.bare.push(value);
    let fields = [&mut cycle.depth, &mut cycle.clearance, &mut cycle.retract];
    match fields.into_iter().find(|field| field.is_none()) {
        Some(field) => *field = Some(value),
        None => cycle.rest.push(Argument::Number(value)),
    }
}
