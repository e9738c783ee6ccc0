//! Tools, cutters and their compensation.

use super::Read;
use super::items::{Items, word};
use crate::cl::record::{Cutcom, CutterSide, LoadTool, Statement};

pub(crate) fn load_tool(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "LOADTL/number or LOAD/TOOL,number, then LENGTH,length or ADJUST,register as needed";
    if !means_tool(items) {
        return items.other();
    }
    let mut tool = LoadTool {
        number: items.whole(&items.line.word, FORM)?,
        described: items.line.word == "TOOLNO",
        ..LoadTool::default()
    };
    while let Some(item) = items.take() {
        match word(item).as_ref() {
            name @ ("ADJUST" | "OSETNO" | "OFSTNO") if tool.register.is_none() => {
                tool.register = Some(items.whole(name, FORM)?)
            }
            "LENGTH" if tool.length.is_none() => tool.length = Some(items.number("LENGTH", FORM)?),
            _ => tool.rest.push(item.argument()),
        }
    }
    Ok(Statement::LoadTool(tool))
}

/// Takes the `TOOL` that `LOAD` and `SELECT` need; false if something else is loaded or selected.
fn means_tool(items: &mut Items<'_, '_>) -> bool {
    if !matches!(items.line.word.as_ref(), "LOAD" | "SELECT") {
        return true;
    }
    let tool = items.peek().is_some_and(|item| word(item) == "TOOL");
    items.next += usize::from(tool);
    tool
}

pub(crate) fn select_tool(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str = "SELECT/TOOL,number or SELCTL/number";
    if !means_tool(items) {
        return items.other();
    }
    let number = items.whole(&items.line.word, FORM)?;
    match items.peek() {
        None => Ok(Statement::SelectTool(number)),
        Some(item) => Err(items.unexpected(item, "one tool number is expected", FORM)),
    }
}

pub(crate) fn tldata(items: &mut Items<'_, '_>) -> Read<Statement> {
    let (mut kinds, mut numbers) = (Vec::new(), Vec::new());
    while let Some(item) = items.take() {
        match item.value {
            Some(value) => numbers.push(value),
            None => kinds.push(word(item).into_owned()),
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

pub(crate) fn cutter(items: &mut Items<'_, '_>) -> Read<Statement> {
    match items.peek() {
        Some(item) if item.value.is_none() && !item.text.is_empty() => items.other(),
        _ => Ok(Statement::Cutter(items.numbers("CUTTER/diameter,corner radius,...")?)),
    }
}

pub(crate) fn cutcom_on_centre(items: &mut Items<'_, '_>) -> Read<Statement> {
    let said = items.take().map(word).unwrap_or_default();
    Ok(Statement::CutcomOnCentre(said == "OUTPUT_ON_CENTER"))
}

pub(crate) fn cutcom(items: &mut Items<'_, '_>) -> Read<Statement> {
    const FORM: &str =
        "CUTCOM/LEFT, RIGHT, ON or OFF, then XYPLAN, YZPLAN or ZXPLAN and a register as needed";
    let first = items.take().map(word).unwrap_or_default();
    let mut cutcom = Cutcom {
        side: match first.as_ref() {
            "LEFT" => Some(CutterSide::Left),
            "RIGHT" => Some(CutterSide::Right),
            "OFF" => Some(CutterSide::Off),
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
        let plane = match name.as_ref() {
            "XYPLAN" => Some(2),
            "YZPLAN" => Some(0),
            "ZXPLAN" => Some(1),
            _ => None,
        };
        if plane.is_some() && cutcom.plane.is_none() {
            items.next += 1;
            cutcom.plane = plane;
        } else if cutcom.register.is_none()
            && (item.value.is_some() || matches!(name.as_ref(), "ADJUST" | "OSETNO" | "OFSTNO"))
        {
            items.next += usize::from(item.value.is_none());
            cutcom.register = Some(items.whole("the word of a register", FORM)?);
        } else {
            return Err(items.unexpected(item, "a plane or a register is expected", FORM));
        }
    }
    Ok(Statement::Cutcom(cutcom))
}
