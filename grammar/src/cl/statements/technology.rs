//! Feeds, speeds, coolant, units, and what the program does between moves.

use super::Read;
use super::items::{Items, word};
use crate::cl::line::LineItem;
use crate::cl::record::{
    CoolantWord, Delay, FeedRate, FeedUnit, Sense, SpindleUnit, SpindleWord, Statement, SyncMark,
    Units,
};

pub(super) fn feed_unit(word: &str) -> Option<FeedUnit> {
    Some(match word {
        "MMPM" => FeedUnit::MillimetresPerMinute,
        "IPM" => FeedUnit::InchesPerMinute,
        "PERMIN" | "FPM" => FeedUnit::PerMinute,
        "MMPR" => FeedUnit::MillimetresPerRevolution,
        "IPR" => FeedUnit::InchesPerRevolution,
        "PERREV" | "FPR" => FeedUnit::PerRevolution,
        "INVERS" | "INVERSE" | "FRN" => FeedUnit::InverseTime,
        "RAPID" => FeedUnit::Rapid,
        _ => return None,
    })
}

pub(crate) fn fedrat(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "FEDRAT/value, FEDRAT/unit,value or FEDRAT/value,unit with MMPM, MMPR, IPM, IPR, PERMIN, PERREV or INVERS; or FEDRAT/RAPID";
    let mut feed = FeedRate { value: None, unit: None };
    while let Some(item) = items.take() {
        let name = word(item);
        if let (Some(value), None) = (item.value, feed.value) {
            feed.value = Some(value);
        } else if let (Some(unit), None) = (feed_unit(&name), feed.unit) {
            feed.unit = Some(unit);
        } else if matches!(name.as_ref(), "MAXIPM" | "MAXMPM" | "MAXDPM") {
            // A limit for controls that compute the feed themselves; the machine file states ours.
            items.number(&name, FORM)?;
        } else {
            return Err(items.unexpected(item, "a feed is one number and one unit", FORM));
        }
    }
    if feed.value.is_none() && feed.unit != Some(FeedUnit::Rapid) {
        return Err(items.fault(items.rest(), "FEDRAT needs a number", FORM));
    }
    Ok(Statement::Feed(feed))
}

pub(super) fn sense(word: &str) -> Option<Sense> {
    match word {
        "CLW" | "CLOCKWISE" => Some(Sense::Clockwise),
        "CCLW" | "COUNTERCLOCKWISE" => Some(Sense::CounterClockwise),
        _ => None,
    }
}

pub(crate) fn spindl(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "SPINDL/RPM,speed,CLW, SPINDL/speed,RPM,CLW, SPINDL/ON or SPINDL/OFF; units RPM, SFM, SMM (with MAXRPM,speed), senses CLW, CCLW";
    if let [item] = items.line.items.as_slice() {
        match word(item).as_ref() {
            "OFF" => return Ok(Statement::Spindle(SpindleWord::Off)),
            "LOCK" | "ORIENT" => return Ok(Statement::Spindle(SpindleWord::Orient)),
            _ => {}
        }
    }
    if items.peek().is_none() {
        return Err(items.fault(items.rest(), "SPINDL needs a speed or a word", FORM));
    }
    let (mut speed, mut unit, mut turning, mut most) = (None, None, None, None);
    while let Some(item) = items.take() {
        let name = word(item);
        if let (Some(value), None) = (item.value, speed) {
            speed = Some(value);
        } else if let (Some(found), None) = (sense(&name), turning) {
            turning = Some(found);
        } else if let (Some(found), None) = (spindle_unit(&name), unit) {
            unit = Some(found);
        } else if name == "MAXRPM" && most.is_none() {
            most = Some(items.number(&name, FORM)?);
        } else if name == "RANGE" {
            // The gear is for the machine to choose.
            items.take();
        } else if name != "ON" {
            return Err(items.unexpected(
                item,
                "a spindle speed is one number, one unit and one sense",
                FORM,
            ));
        }
    }
    if speed.is_none() && unit.is_some() {
        return Err(items.fault(items.rest(), "SPINDL needs a number with its unit", FORM));
    }
    Ok(Statement::Spindle(SpindleWord::On {
        speed,
        unit: unit.unwrap_or(SpindleUnit::Rpm),
        sense: turning,
        most,
    }))
}

pub(super) fn spindle_unit(word: &str) -> Option<SpindleUnit> {
    match word {
        "RPM" => Some(SpindleUnit::Rpm),
        "SMM" => Some(SpindleUnit::SurfaceMetric),
        "SFM" => Some(SpindleUnit::SurfaceInch),
        _ => None,
    }
}

pub(crate) fn coolnt(items: &mut Items<'_, '_>) -> Read<Statement> {
    let [item] = items.line.items.as_slice() else {
        return match items.peek() {
            Some(_) => items.other(),
            None => Err(items.fault(
                items.rest(),
                "COOLNT needs a word",
                "COOLNT/ON, OFF, FLOOD, MIST, THRU or AIR",
            )),
        };
    };
    Ok(Statement::Coolant(match word(item).as_ref() {
        "OFF" => CoolantWord::Off,
        "ON" => CoolantWord::On,
        "FLOOD" => CoolantWord::Flood,
        "MIST" => CoolantWord::Mist,
        "THRU" | "THROUGH" => CoolantWord::Through,
        "AIR" => CoolantWord::Air,
        _ => return items.other(),
    }))
}

pub(crate) fn units(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "UNITS/MM, INCH, CM, M or FEET";
    let [item] = items.line.items.as_slice() else {
        return Err(items.fault(items.rest(), "UNITS takes one word", FORM));
    };
    Ok(Statement::Units(match word(item).as_ref() {
        "MM" => Units::Millimetre,
        "INCH" | "INCHES" | "IN" => Units::Inch,
        "CM" => Units::Centimetre,
        "M" => Units::Metre,
        "FEET" | "FT" => Units::Foot,
        _ => return Err(items.unexpected(item, "a unit of length is expected", FORM)),
    }))
}

pub(crate) fn delay(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "DELAY/seconds or DELAY/turns,REV";
    let time = items.number(&items.line.word, FORM)?;
    let delay = match items.take() {
        None => Delay::Seconds(time),
        Some(item) if word(item) == "REV" => Delay::Revolutions(time),
        Some(item) => return Err(items.unexpected(item, "REV or nothing is expected", FORM)),
    };
    items.nothing(Statement::Delay(delay))
}

pub(crate) fn work_offset(items: &mut Items<'_, '_>) -> Read<Statement> {
    let set = items.line.word == "SET";
    let numbers = match items.line.items.as_slice() {
        [first, numbers @ ..] if set && word(first) == "OFSETL" => numbers,
        numbers if !set => numbers,
        _ => return items.other(),
    };
    match only_whole(numbers) {
        Some(number) => Ok(Statement::WorkOffset { number, set }),
        None => items.other(),
    }
}

pub(crate) fn subprogram(items: &mut Items<'_, '_>) -> Read<Statement> {
    match only_whole(&items.line.items) {
        Some(number) => Ok(Statement::Subprogram(number)),
        // With a name, or values to hand over, it is a form that is not known here.
        None => items.other(),
    }
}

/// The one item, if it is a whole number from 0 up.
fn only_whole(items: &[LineItem<'_>]) -> Option<u32> {
    let [item] = items else { return None };
    let value = item.value?;
    let whole = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
    whole.then_some(value as u32)
}

/// `MODE/MILL`, `MODE/TURN`; what else it may be is left to those who know it.
pub(crate) fn mode(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.line.items.as_slice() {
        [item] if word(item) == "MILL" => Ok(Statement::Milling),
        [item] if word(item) == "TURN" => Ok(Statement::Turning),
        _ => items.other(),
    }
}

pub(crate) fn rapid(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::Rapid)
}

pub(crate) fn stop(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::Stop)
}

pub(crate) fn opstop(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::OptionalStop)
}

/// `SYNC/mark`, or with the channels behind it, the file's own first, as CATIA writes them: with a comma at the end.
pub(crate) fn sync(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "SYNC/mark, or SYNC/mark,own channel,other channels";
    let number = items.whole("SYNC", FORM)?;
    let mut channels = Vec::new();
    while let Some(item) = items.peek() {
        if item.text.is_empty() && items.line.items.len() == items.next + 1 {
            break;
        }
        let channel = items.whole("SYNC", FORM)?;
        if channel == 0 || channels.contains(&channel) {
            let message = "channels are counted from 1, and each is named once";
            return Err(items.fault(item.span(), message, FORM));
        }
        channels.push(channel);
    }
    Ok(Statement::Sync(SyncMark { number, channels }))
}

pub(crate) fn end_of_path(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::EndOfPath)
}

pub(crate) fn fini(items: &mut Items<'_, '_>) -> Read<Statement> {
    items.nothing(Statement::Fini)
}
