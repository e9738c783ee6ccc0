//! What each major word means: items to a typed [`Statement`].
//!
//! A known word with wrong content is a fault. Where the first item is a word without a meaning here
//! (`COOLNT/SUPER`, `LOAD/WIRE`, `CUTTER/DISPLY`), the record comes through as [`Statement::Other`],
//! so that it is reported and not guessed at.

use crate::cl::{Item, Line};
use crate::fault::SyntaxFault;
use crate::record::*;
use std::ops::Range;

type Read<T> = Result<T, SyntaxFault>;

/// A directive. Only the two that carry facts are typed; the rest is meant for one program and comes as it stands.
pub(crate) fn directive(line: &Line<'_>) -> Read<Statement> {
    match line.word.as_str() {
        "CUTTER" | "CSYS" => match statement(line)? {
            Statement::Other { .. } => Ok(other(line, true)),
            statement => Ok(statement),
        },
        _ => Ok(other(line, true)),
    }
}

/// A statement of its own.
pub(crate) fn statement(line: &Line<'_>) -> Read<Statement> {
    let Some(read) = reader(&line.word) else {
        return Ok(other(line, false));
    };
    if let Some(first) = line.items.first().filter(|_| !line.slash) {
        let message = format!("a `/` must stand between {} and what follows it", line.word);
        let span = line.word_span.end..first.start;
        return Err(SyntaxFault::new(line.text, span, message));
    }
    // CAMWorks leaves a comma out in CYCLE; anywhere else a blank between two numbers is a slip.
    if line.word != "CYCLE"
        && let Some(item) = line.items.iter().find(|item| item.comma_missing)
    {
        let span = item.start..item.start;
        return Err(SyntaxFault::new(line.text, span, "a comma is missing here"));
    }
    read(&mut Items { line, next: 0 })
}

fn other(line: &Line<'_>, directive: bool) -> Statement {
    Statement::Other {
        word: line.word.clone(),
        arguments: line.items.iter().map(Item::argument).collect(),
        directive,
    }
}

type Reader = fn(&mut Items<'_, '_>) -> Read<Statement>;

fn reader(word: &str) -> Option<Reader> {
    Some(match word {
        "GOTO" => goto,
        "GODLTA" => godlta,
        "FROM" => from,
        "HEAD" => head,
        "GOHOME" => gohome,
        "RAPID" => |items| items.nothing(Statement::Rapid),
        "FEDRAT" => fedrat,
        "SPINDL" => spindl,
        "COOLNT" => coolnt,
        "LOADTL" | "TURRET" | "TOOLNO" => load_tool,
        "LOAD" => load,
        "SELECT" => select,
        "SELCTL" => select_tool,
        "TLDATA" => tldata,
        "CUTTER" => cutter,
        "UNITS" | "UNIT" => units,
        "MULTAX" => multax,
        "MSYS" => msys,
        "CSYS" => |items| {
            Ok(Statement::Csys(
                items.array("CSYS/ and the 3 x 4 matrix, row by row")?,
            ))
        },
        "CIRCLE" => circle,
        "NURBS" => |items| items.nothing(Statement::Nurbs),
        "KNOT" => |items| Ok(Statement::Knot(items.numbers("KNOT/u,u,...")?)),
        "CNTRL" => cntrl,
        "CYCLE" => cycle,
        "CUTCOM" => cutcom,
        "ROTABL" | "ROTATE" => rotate,
        "TLAXIS" => tlaxis,
        "DELAY" | "DWELL" => delay,
        "STOP" => |items| items.nothing(Statement::Stop),
        "OPSTOP" => |items| items.nothing(Statement::OptionalStop),
        "END-OF-PATH" => |items| items.nothing(Statement::EndOfPath),
        "FINI" | "END" => |items| items.nothing(Statement::Fini),
        _ => return None,
    })
}

/// The items of a line, taken one by one.
struct Items<'l, 't> {
    line: &'l Line<'t>,
    next: usize,
}

impl<'l, 't> Items<'l, 't> {
    fn peek(&self) -> Option<&'l Item<'t>> {
        self.line.items.get(self.next)
    }

    fn take(&mut self) -> Option<&'l Item<'t>> {
        let item = self.peek()?;
        self.next += 1;
        Some(item)
    }

    /// The next item, if it is a number.
    fn take_number(&mut self) -> Option<f64> {
        let value = self.peek()?.value?;
        self.next += 1;
        Some(value)
    }

    /// The number that must follow `word`.
    fn number(&mut self, word: &str, form: &str) -> Read<f64> {
        match self.peek() {
            Some(Item {
                value: Some(value), ..
            }) => {
                self.next += 1;
                Ok(*value)
            }
            Some(item) => Err(self.unexpected(item, &format!("a number must follow {word}"), form)),
            None => Err(self.fault(self.rest(), format!("a number must follow {word}"), form)),
        }
    }

    /// A tool or register number.
    fn whole(&mut self, word: &str, form: &str) -> Read<u32> {
        let span = self.peek().map_or_else(|| self.rest(), Item::span);
        let value = self.number(word, form)?;
        if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
            return Ok(value as u32);
        }
        Err(self.fault(span, format!("{value} is no whole number from 0 up"), form))
    }

    /// All items, as numbers, at least one.
    fn numbers(&self, form: &str) -> Read<Vec<f64>> {
        let number = |item: &Item<'_>| {
            item.value
                .ok_or_else(|| self.unexpected(item, "a number is expected", form))
        };
        let numbers: Vec<f64> = self.line.items.iter().map(number).collect::<Read<_>>()?;
        if numbers.is_empty() {
            let message = format!("{} needs numbers", self.line.word);
            return Err(self.fault(self.rest(), message, form));
        }
        Ok(numbers)
    }

    /// All items, as exactly so many numbers.
    fn array<const N: usize>(&self, form: &str) -> Read<[f64; N]> {
        let numbers = self.numbers(form)?;
        <[f64; N]>::try_from(numbers)
            .map_err(|numbers| self.miscounted(&N.to_string(), numbers.len(), form))
    }

    /// All items: a point, or a point and a tool axis.
    fn point(&self, form: &str) -> Read<(Point, Option<Direction>)> {
        match *self.numbers(form)?.as_slice() {
            [x, y, z] => Ok(([x, y, z], None)),
            [x, y, z, i, j, k] => Ok(([x, y, z], Some([i, j, k]))),
            ref numbers => Err(self.miscounted("3 or 6", numbers.len(), form)),
        }
    }

    /// A statement that takes no items.
    fn nothing(&self, statement: Statement) -> Read<Statement> {
        match self.peek() {
            None => Ok(statement),
            Some(_) => {
                let message = format!("nothing is expected behind {}", self.line.word);
                Err(SyntaxFault::new(self.line.text, self.rest(), message))
            }
        }
    }

    /// The first item is a word without a meaning here.
    fn other(&self) -> Read<Statement> {
        Ok(other(self.line, false))
    }

    /// From the next item to the end of the last one; the place behind the word or the last item if none is left.
    fn rest(&self) -> Range<usize> {
        let items = &self.line.items;
        let end = items.last().map_or(
            self.line.word_span.end + usize::from(self.line.slash),
            |item| item.span().end,
        );
        let end = end.min(self.line.text.len());
        self.peek().map_or(end, |item| item.start)..end
    }

    fn fault(&self, span: Range<usize>, message: impl Into<String>, form: &str) -> SyntaxFault {
        SyntaxFault::new(self.line.text, span, message).help(format!("expected {form}"))
    }

    fn unexpected(&self, item: &Item<'_>, message: &str, form: &str) -> SyntaxFault {
        let message = match item.text {
            "" => format!("{message}, nothing stands between the commas"),
            text => format!("{message}, not `{text}`"),
        };
        self.fault(item.span(), message, form)
    }

    fn miscounted(&self, expected: &str, found: usize, form: &str) -> SyntaxFault {
        let verb = if found == 1 { "is" } else { "are" };
        let message = format!(
            "{} takes {expected} numbers, {found} {verb} given",
            self.line.word
        );
        self.fault(self.line.items[0].start..self.rest().end, message, form)
    }
}

/// The item as a word in capitals; empty if it is a number.
fn word(item: &Item<'_>) -> String {
    match item.value {
        Some(_) => String::new(),
        None => item.text.to_ascii_uppercase(),
    }
}

fn goto(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "GOTO/x,y,z, GOTO/x,y,z,i,j,k or, with the direction of an edge, GOTO/x,y,z,i,j,k,u,v,w";
    if items.line.items.len() == 9 {
        let [x, y, z, i, j, k, u, v, w] = items.array(FORM)?;
        return Ok(Statement::GotoEdge {
            point: [x, y, z],
            axis: [i, j, k],
            edge: [u, v, w],
        });
    }
    let (point, axis) = items.point(FORM)?;
    Ok(Statement::Goto { point, axis })
}

/// A name or a number; anything else is left to those who know it.
fn head(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.line.items.as_slice() {
        [name] if !name.text.is_empty() => Ok(Statement::Head(name.text.to_owned())),
        _ => items.other(),
    }
}

fn from(items: &mut Items<'_, '_>) -> Read<Statement> {
    let (point, axis) = items.point("FROM/x,y,z or FROM/x,y,z,i,j,k")?;
    Ok(Statement::From { point, axis })
}

fn cntrl(items: &mut Items<'_, '_>) -> Read<Statement> {
    let (point, axis) = items.point("CNTRL/x,y,z or CNTRL/x,y,z,i,j,k")?;
    Ok(Statement::Control { point, axis })
}

fn gohome(items: &mut Items<'_, '_>) -> Read<Statement> {
    if items.peek().is_none() {
        return Ok(Statement::Gohome(None));
    }
    let home = items.point("GOHOME, GOHOME/x,y,z or GOHOME/x,y,z,i,j,k")?;
    Ok(Statement::Gohome(Some(home)))
}

fn godlta(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "GODLTA/dx,dy,dz or GODLTA/d";
    match *items.numbers(FORM)?.as_slice() {
        [d] => Ok(Statement::Godlta(Delta::AlongAxis(d))),
        [x, y, z] => Ok(Statement::Godlta(Delta::Step([x, y, z]))),
        ref numbers => Err(items.miscounted("1 or 3", numbers.len(), FORM)),
    }
}

fn feed_unit(word: &str) -> Option<FeedUnit> {
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

fn fedrat(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "FEDRAT/value, FEDRAT/unit,value or FEDRAT/value,unit with MMPM, MMPR, IPM, IPR, PERMIN, PERREV or INVERS; or FEDRAT/RAPID";
    let mut feed = FeedRate {
        value: None,
        unit: None,
    };
    while let Some(item) = items.take() {
        let name = word(item);
        if let (Some(value), None) = (item.value, feed.value) {
            feed.value = Some(value);
        } else if let (Some(unit), None) = (feed_unit(&name), feed.unit) {
            feed.unit = Some(unit);
        } else if matches!(name.as_str(), "MAXIPM" | "MAXMPM" | "MAXDPM") {
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

fn sense(word: &str) -> Option<Sense> {
    match word {
        "CLW" | "CLOCKWISE" => Some(Sense::Clockwise),
        "CCLW" | "COUNTERCLOCKWISE" => Some(Sense::CounterClockwise),
        _ => None,
    }
}

fn spindl(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "SPINDL/RPM,speed,CLW, SPINDL/speed,RPM,CLW, SPINDL/ON or SPINDL/OFF; units RPM, SFM, SMM, senses CLW, CCLW";
    if let [item] = items.line.items.as_slice() {
        match word(item).as_str() {
            "OFF" => return Ok(Statement::Spindle(Spindle::Off)),
            "LOCK" | "ORIENT" => return Ok(Statement::Spindle(Spindle::Orient)),
            _ => {}
        }
    }
    if items.peek().is_none() {
        return Err(items.fault(items.rest(), "SPINDL needs a speed or a word", FORM));
    }
    let (mut speed, mut unit, mut turning) = (None, None, None);
    while let Some(item) = items.take() {
        let name = word(item);
        if let (Some(value), None) = (item.value, speed) {
            speed = Some(value);
        } else if let (Some(found), None) = (sense(&name), turning) {
            turning = Some(found);
        } else if let (Some(found), None) = (spindle_unit(&name), unit) {
            unit = Some(found);
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
    Ok(Statement::Spindle(Spindle::On {
        speed,
        unit: unit.unwrap_or(SpindleUnit::Rpm),
        sense: turning,
    }))
}

fn spindle_unit(word: &str) -> Option<SpindleUnit> {
    match word {
        "RPM" => Some(SpindleUnit::Rpm),
        "SMM" => Some(SpindleUnit::SurfaceMetric),
        "SFM" => Some(SpindleUnit::SurfaceInch),
        _ => None,
    }
}

fn coolnt(items: &mut Items<'_, '_>) -> Read<Statement> {
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
    Ok(Statement::Coolant(match word(item).as_str() {
        "OFF" => Coolant::Off,
        "ON" => Coolant::On,
        "FLOOD" => Coolant::Flood,
        "MIST" => Coolant::Mist,
        "THRU" | "THROUGH" => Coolant::Through,
        "AIR" => Coolant::Air,
        _ => return items.other(),
    }))
}

fn load_tool(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "LOADTL/number or LOAD/TOOL,number, then LENGTH,length or ADJUST,register as needed";
    let mut tool = LoadTool {
        number: items.whole(&items.line.word, FORM)?,
        ..LoadTool::default()
    };
    while let Some(item) = items.take() {
        match word(item).as_str() {
            name @ ("ADJUST" | "OSETNO" | "OFSTNO") if tool.register.is_none() => {
                tool.register = Some(items.whole(name, FORM)?)
            }
            "LENGTH" if tool.length.is_none() => tool.length = Some(items.number("LENGTH", FORM)?),
            _ => tool.rest.push(item.argument()),
        }
    }
    Ok(Statement::LoadTool(tool))
}

/// Whether the first item is `TOOL`, which is then taken. Anything else is loaded or selected on other machines.
fn tool_word(items: &mut Items<'_, '_>) -> bool {
    let tool = items.peek().is_some_and(|item| word(item) == "TOOL");
    items.next += usize::from(tool);
    tool
}

fn load(items: &mut Items<'_, '_>) -> Read<Statement> {
    if tool_word(items) {
        load_tool(items)
    } else {
        items.other()
    }
}

fn select(items: &mut Items<'_, '_>) -> Read<Statement> {
    if tool_word(items) {
        select_tool(items)
    } else {
        items.other()
    }
}

fn select_tool(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "SELECT/TOOL,number or SELCTL/number";
    let number = items.whole(&items.line.word, FORM)?;
    match items.peek() {
        None => Ok(Statement::SelectTool(number)),
        Some(item) => Err(items.unexpected(item, "one tool number is expected", FORM)),
    }
}

fn tldata(items: &mut Items<'_, '_>) -> Read<Statement> {
    let (mut kinds, mut numbers) = (Vec::new(), Vec::new());
    while let Some(item) = items.take() {
        match item.value {
            Some(value) => numbers.push(value),
            None => kinds.push(word(item)),
        }
    }
    if kinds.is_empty() {
        return Err(items.fault(
            items.rest(),
            "TLDATA needs the kind of tool",
            "TLDATA/MILL,diameter,...",
        ));
    }
    Ok(Statement::ToolData { kinds, numbers })
}

fn cutter(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.peek() {
        Some(item) if item.value.is_none() && !item.text.is_empty() => items.other(),
        _ => Ok(Statement::Cutter(
            items.numbers("CUTTER/diameter,corner radius,...")?,
        )),
    }
}

fn units(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "UNITS/MM, INCH, CM, M or FEET";
    let [item] = items.line.items.as_slice() else {
        return Err(items.fault(items.rest(), "UNITS takes one word", FORM));
    };
    Ok(Statement::Units(match word(item).as_str() {
        "MM" => Units::Millimetre,
        "INCH" | "INCHES" | "IN" => Units::Inch,
        "CM" => Units::Centimetre,
        "M" => Units::Metre,
        "FEET" | "FT" => Units::Foot,
        _ => return Err(items.unexpected(item, "a unit of length is expected", FORM)),
    }))
}

fn multax(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.line.items.as_slice() {
        [] => Ok(Statement::Multax(true)),
        [item] if word(item) == "ON" => Ok(Statement::Multax(true)),
        [item] if word(item) == "OFF" => Ok(Statement::Multax(false)),
        _ => Err(items.fault(
            items.rest(),
            "MULTAX is on or off",
            "MULTAX, MULTAX/ON or MULTAX/OFF",
        )),
    }
}

fn msys(items: &mut Items<'_, '_>) -> Read<Statement> {
    let [ox, oy, oz, xi, xj, xk, yi, yj, yk] =
        items.array("MSYS/ origin, X direction, Y direction")?;
    Ok(Statement::Msys {
        origin: [ox, oy, oz],
        x: [xi, xj, xk],
        y: [yi, yj, yk],
    })
}

/// NX gives eleven numbers: behind the radius two tolerances, the cutter's diameter and its corner radius,
/// which say nothing about the arc. Creo gives seven, SolidWorks CAM six, without the radius.
fn circle(items: &mut Items<'_, '_>) -> Read<Statement> {
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
            return Err(SyntaxFault {
                span: fault.span.start..end,
                ..fault
            });
        }
    };
    let mut circle = Circle {
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

/// Labelled numbers (NX, Creo, SolidWorks CAM) go to their field; bare ones to the first free one of depth,
/// clearance and return level, which is the order of APT (`CYCLE/DRILL,depth,IPM,feed,clearance`) and of CAMWorks.
fn cycle(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "CYCLE/OFF, CYCLE/ON or CYCLE/DRILL,FEDTO,depth,MMPM,feed,RAPTO,clearance,...";
    if let [item] = items.line.items.as_slice() {
        match word(item).as_str() {
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
        let mut labelled = true;
        match name.as_str() {
            "FEDTO" | "DEPTH" => cycle.depth = Some(items.number(&name, FORM)?),
            "RAPTO" | "CLEAR" => cycle.clearance = Some(items.number(&name, FORM)?),
            "STEP" => cycle.step = Some(items.number(&name, FORM)?),
            // CAMWorks gives the first peck and those that follow.
            "PECKING" => {
                cycle.step = Some(items.number(&name, FORM)?);
                cycle.rest.extend(items.take_number().map(Argument::Number));
            }
            "RTRCTO" | "RETURN" | "DWELL" => match (items.take_number(), name.as_str()) {
                (Some(value), "DWELL") => cycle.dwell = Some(value),
                (Some(value), _) => cycle.retract = Some(value),
                // `RTRCTO,AUTO`, `DWELL,REV,2`
                (None, _) => {
                    cycle.rest.push(item.argument());
                    cycle.rest.extend(items.take().map(Item::argument));
                    cycle.rest.extend(items.take_number().map(Argument::Number));
                }
            },
            _ if feed_unit(&name).is_some() => {
                cycle.feed = Some(FeedRate {
                    value: Some(items.number(&name, FORM)?),
                    unit: feed_unit(&name),
                });
            }
            _ => labelled = false,
        }
        kinds_end |= labelled || item.value.is_some();
        if labelled {
            continue;
        }
        match item.value {
            Some(value) => match [&mut cycle.depth, &mut cycle.clearance, &mut cycle.retract]
                .into_iter()
                .find(|field| field.is_none())
            {
                Some(field) => *field = Some(value),
                None => cycle.rest.push(Argument::Number(value)),
            },
            None if name.is_empty() => {
                return Err(items.unexpected(item, "a word or a number is expected", FORM));
            }
            None if kinds_end || matches!(name.as_str(), "G98" | "G99") => {
                cycle.rest.push(item.argument())
            }
            None => cycle.kinds.push(name),
        }
    }
    if cycle.kinds.is_empty() {
        let span = items
            .line
            .items
            .first()
            .map_or_else(|| items.rest(), Item::span);
        return Err(items.fault(span, "CYCLE needs the kind of cycle", FORM));
    }
    Ok(Statement::Cycle(Cycle::Define(cycle)))
}

fn cutcom(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "CUTCOM/LEFT, RIGHT, ON or OFF, then XYPLAN, YZPLAN or ZXPLAN and a register as needed";
    let first = items.take().map(word).unwrap_or_default();
    let mut cutcom = Cutcom {
        side: match first.as_str() {
            "LEFT" => Some(Side::Left),
            "RIGHT" => Some(Side::Right),
            "OFF" => Some(Side::Off),
            "ON" => None,
            "" => {
                items.next = 0;
                return Err(items.fault(items.rest(), "CUTCOM needs a side", FORM));
            }
            _ => return items.other(),
        },
        plane: None,
        register: None,
    };
    while let Some(item) = items.peek() {
        let name = word(item);
        let plane = match name.as_str() {
            "XYPLAN" => Some(2),
            "YZPLAN" => Some(0),
            "ZXPLAN" => Some(1),
            _ => None,
        };
        if plane.is_some() && cutcom.plane.is_none() {
            items.next += 1;
            cutcom.plane = plane;
        } else if cutcom.register.is_none()
            && (item.value.is_some() || matches!(name.as_str(), "ADJUST" | "OSETNO" | "OFSTNO"))
        {
            items.next += usize::from(item.value.is_none());
            cutcom.register = Some(items.whole("the word of a register", FORM)?);
        } else {
            return Err(items.unexpected(item, "a plane or a register is expected", FORM));
        }
    }
    Ok(Statement::Cutcom(cutcom))
}

/// CAMWorks puts the number first, in radians, and each move is a step that is undone at the operation's end.
/// APT and NX put the axis or `ATANGL` first and write degrees. A number first without the axis could be either.
fn rotate(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "ROTABL/AAXIS,degrees, ROTABL/ATANGL,degrees,CLW, ROTABL/INCR,degrees,CCLW or, from CAMWorks, ROTABL/radians,AAXIS,TABLE,CCLW";
    let radians = items.peek().is_some_and(|item| item.value.is_some());
    let (mut axis, mut angle, mut turning) = (None, None, None);
    let (mut incremental, mut member) = (false, false);
    for (index, item) in items.line.items.iter().enumerate() {
        let name = word(item);
        match name.as_str() {
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
        return Err(items.fault(
            items.rest(),
            format!("{} needs an angle", items.line.word),
            FORM,
        ));
    };
    if radians && !(axis.is_some() && member) {
        let message =
            "this may be degrees or radians: with the angle first, the axis and TABLE must follow";
        return Err(items.fault(items.rest(), message, FORM));
    }
    Ok(Statement::Rotate(Rotate {
        axis,
        angle,
        radians,
        incremental,
        sense: turning,
    }))
}

fn tlaxis(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.peek() {
        Some(item) if item.value.is_none() && !item.text.is_empty() => items.other(),
        _ => Ok(Statement::ToolAxis(items.array("TLAXIS/i,j,k")?)),
    }
}

fn delay(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "DELAY/seconds or DELAY/turns,REV";
    let time = items.number(&items.line.word, FORM)?;
    let delay = match items.take() {
        None => Delay::Seconds(time),
        Some(item) if word(item) == "REV" => Delay::Revolutions(time),
        Some(item) => return Err(items.unexpected(item, "REV or nothing is expected", FORM)),
    };
    items.nothing(Statement::Delay(delay))
}
