//! The tool: its call changes it and switches its length on.

use post_machine::axis_words;
use post_machine::description::LengthAxis;

use super::items::BlockItems;
use super::{Answer, feed_unit};
use crate::ProgramEvent;
use crate::interpret::block_words::BlockWords;
use crate::interpret::state::{ArcPlane, ControlState};

/// `TOOL CALL 5 Z S8000 F1200 DL+0.1`; without a tool it changes the speed alone.
pub(super) fn call(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &mut BlockWords,
) -> Answer<()> {
    let across = across(control, said)?;
    if let Some(speed) = words.take(b'S') {
        control.name_speed(speed);
        control.speed_changed();
    }
    if let Some(feed) = words.take(b'F') {
        control.modal.feed = Some(feed * feed_unit(control));
    }
    let longer = said.named(control, "DL")?.map(|longer| longer * control.modal.unit);
    let number = said.number().map(|number| number.value);
    let name = said.text().map(str::to_owned);
    let number = match number {
        None => None,
        Some(number) if number >= 0.0 && libm::trunc(number) == number && number < 1e9 => {
            Some(number as u32)
        }
        Some(number) => {
            return Err(control.refuse("nc-tool", format!("{number} is no number of a tool")));
        }
    };
    let thicker = match (said.named(control, "DR")?, said.named(control, "DR2")?) {
        (None, None) => None,
        (radius, corner) => Some([radius, corner].map(|more| more.unwrap_or(0.0))),
    };
    if number.is_none() && name.is_none() {
        control.tools.thicker = thicker.unwrap_or(control.tools.thicker);
        if let Some(longer) = longer {
            control.tools.longer = longer;
            control.length_changed()?;
        }
        return Ok(());
    }
    if control.state.tcp || control.frames.plane.is_some() {
        return Err(control.refuse(
            "nc-tool",
            "a tool call under M128 or in a tilted plane: both must end before",
        ));
    }
    control.change_tool(number, name)?;
    control.tools.by_tool = true;
    control.tools.length_on = true;
    control.tools.longer = longer.unwrap_or(0.0);
    control.tools.thicker = thicker.unwrap_or_default();
    control.tools.across = across;
    if let Some(lack) = control.lies_off(across, Some("TOOL CALL")) {
        return Err(control.refuse("nc-tool", lack));
    }
    control.length_changed()
}

/// The plane across the tool axis that a call names. The length goes along that axis, so that U, V or W is to be the one of
/// the machine file.
fn across(control: &ControlState, said: &BlockItems<'_>) -> Answer<ArcPlane> {
    let named = ["X", "Y", "Z", "U", "V", "W"].into_iter().find(|name| said.has(name));
    if let Some(name @ ("U" | "V" | "W")) = named {
        let machine = &control.machine;
        let own = machine.axes.iter().position(|axis| axis.word() == name);
        let along = match machine.length_axis {
            LengthAxis::Said(place) => Some(place),
            _ => axis_words::depth(machine),
        };
        if own.is_none() || own != along {
            let message = format!(
                "the tool lies along {name} from here, and the length goes along {}: [tool] length_axis = \"{name}\" in the machine file says otherwise",
                along.map_or("no axis", |place| &machine.axes[place].name)
            );
            return Err(control.refuse("nc-tool", message));
        }
    }
    Ok(match named {
        Some("X" | "U") => ArcPlane::Yz,
        Some("Y" | "V") => ArcPlane::Zx,
        _ => ArcPlane::Xy,
    })
}

/// `TOOL DEF 5`: it is made ready. With `L` and `R` it says what the tool measures, and the table has it otherwise.
pub(super) fn prepare(
    control: &mut ControlState,
    said: &BlockItems<'_>,
    words: &BlockWords,
) -> Answer<()> {
    if words.get(b'L').or(words.get(b'R')).is_some() {
        let message =
            "TOOL DEF with L and R: the tool is measured by the program, which is not followed";
        return Err(control.refuse("nc-tool", message));
    }
    let _by_name = said.text();
    let number = said.number().filter(|number| (0.0..1e9).contains(&number.value));
    if let Some(number) = number {
        control.tell(ProgramEvent::Preselect(number.value as u32));
    }
    Ok(())
}
