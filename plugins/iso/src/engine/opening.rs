//! The engine as a program begins: what table and options say.

use post_plugin::{Axes, Block, Modal, NumberStyle, OptionSpec, Setup, Standstill, Units, Value};

use super::Engine;
use super::spindle::COOLANTS;
use crate::FeedDecimals;
use crate::block_style::BlockStyle;
use crate::cycles::CycleWords;
use crate::lines::program_name;
use crate::motion::MotionWriter;
use crate::options::{flag, integer, text};
use crate::planes::PlaneWords;
use crate::settings::SettingWords;
use crate::table::{Table, Tcp};

/// Most decimals of a number with a point where the option of it is not offered.
const DECIMALS: [i64; 3] = [3, 4, 3];

impl Engine {
    pub(crate) fn new(table: &'static Table, setup: &Setup<'_>) -> Result<Self, String> {
        if setup.tcp && matches!(table.tcp, Tcp::None) {
            return Err("this control has no tool centre point control: tcp = \"post\"".to_owned());
        }
        table.axes.check(setup)?;
        let inch = setup.units == Units::Inch;
        let style = NumberStyle {
            point: true,
            trim: !flag(setup, "trailing_zeros", !table.trim),
            plus: false,
        };
        let [linear_mm, linear_inch, rotary] = DECIMALS;
        let linear = match inch {
            true => integer(setup, "decimals_inch", linear_inch),
            false => integer(setup, "decimals", linear_mm),
        };
        let rotary = integer(setup, "rotary_decimals", rotary);
        let mut axes = Axes::new(setup, linear as u8, rotary as u8, style);
        single_decimals(setup, &mut axes)?;
        let (block, tool_blocks) = numbering(table, setup);
        let work_offset = work_offset(table, setup)?;
        let feeds = feed_decimals(table, setup);
        let [tcp_on, tcp_off] = tcp_lines(table, setup)?;
        let mut codes = table.codes;
        if !flag(setup, "inverse_time", true) {
            codes.feed[1] = "";
        }
        let register = integer(setup, "length_register", 0) as u32;
        let [coolant_codes, coolant_ends] = coolant_words(table, setup);
        Ok(Engine {
            table,
            motion: MotionWriter::new(setup, codes, block, axes, style, feeds)
                .in_full(table.command_a_line, travel_feed(table, setup)),
            style: BlockStyle {
                spaces: flag(setup, "spaces", true),
                leading_zeros: flag(setup, "leading_zeros", false),
            },
            settings: SettingWords::new(table, setup)?,
            cycles: CycleWords::new(table, setup),
            plane: PlaneWords::new(table, setup, rotary as u8),
            vector: (!table.vector.is_empty() && flag(setup, "tool_vector", false)).then_some(6),
            splines: flag(setup, "splines", false),
            arcs_off_xy: flag(setup, "arcs_off_xy", !table.length.across_plane),
            title: title(table, setup),
            tool_blocks,
            restart: flag(setup, "restart", false),
            change: text(setup, "change", table.change),
            machine: setup.machine.to_owned(),
            percent: flag(setup, "percent", table.percent),
            parameters: flag(setup, "parameters", false),
            inch,
            tcp: setup.tcp,
            work_offset,
            cancel: cancel(table, setup),
            cancel_due: false,
            retract: text(setup, "retract", ""),
            tcp_on,
            tcp_off,
            most_inverse_time: match setup.option("most_inverse_time") {
                Some(Value::Number(most)) if most > 0.0 => Some(most),
                _ => None,
            },
            coolant_codes,
            coolant_ends,
            register: (register != 0).then_some(register),
            offset_active: Modal::default(),
            own_offset: false,
            length_active: Modal::default(),
            tcp_active: Modal::default(),
            follows_vector: false,
            turning: None,
            tapped: false,
            spindle: Modal::default(),
            coolant: Modal::default(),
            flowing: None,
            standstill: Standstill::default(),
        })
    }
}

/// What cancels shifts and turns: the option, whose default stands for what the table says.
fn cancel(table: &Table, setup: &Setup<'_>) -> String {
    let said = text(setup, "cancel", table.cancel);
    let is_default = |spec: &OptionSpec| spec.key == "cancel" && spec.default == Value::Text(&said);
    match table.options.iter().any(is_default) {
        true => table.cancel.to_owned(),
        false => said,
    }
}

/// The F of rapids, where the control has no other speed for them.
fn travel_feed(table: &Table, setup: &Setup<'_>) -> Option<f64> {
    table.rapids_at_feed.then(|| setup.number("travel_feed"))
}

/// Decimals of feeds; an inch has one more.
fn feed_decimals(table: &Table, setup: &Setup<'_>) -> FeedDecimals {
    let inch = setup.units == Units::Inch;
    FeedDecimals {
        per_minute: integer(setup, "feed_decimals", 1) as u8 + u8::from(inch),
        inverse_time: integer(setup, "inverse_time_decimals", 3) as u8,
        per_revolution: table.per_revolution,
    }
}

/// The words that switch each of [`COOLANTS`] on, and those that end it.
fn coolant_words(table: &Table, setup: &Setup<'_>) -> [[String; COOLANTS.len()]; 2] {
    let mut usual = table.coolant.iter();
    let codes = COOLANTS.map(|(_, option, _)| text(setup, option, usual.next().unwrap_or(&"")));
    let ends = COOLANTS.map(|(_, _, option)| match text(setup, option, "") {
        end if end.is_empty() => codes[0].clone(),
        end => end,
    });
    [codes, ends]
}

/// The block under construction, and the N and step of blocks that change a tool, where only these have numbers.
fn numbering(table: &Table, setup: &Setup<'_>) -> (Block, Option<[u32; 2]>) {
    let step = integer(setup, "block_step", 10) as u32;
    let numbers = setup.option("block_numbers");
    let block = match numbers {
        Some(Value::Text("all") | Value::Flag(true)) => {
            Block::numbered("N", step, step, table.largest_number)
        }
        _ => Block::plain(),
    };
    (block, (numbers == Some(Value::Text("tools"))).then_some([step; 2]))
}

/// The work offset of the options, if the control has it.
fn work_offset(table: &Table, setup: &Setup<'_>) -> Result<String, String> {
    let first = (table.offset.word)(1).unwrap_or_default();
    let offset = text(setup, "work_offset", &first);
    if !(table.offset.known)(&offset) {
        let range = table.offset.range;
        return Err(format!("the work offset is `{offset}`, must be {range}"));
    }
    Ok(offset)
}

/// The lines that switch tool centre point control on and off.
fn tcp_lines(table: &Table, setup: &Setup<'_>) -> Result<[String; 2], String> {
    let (on, off) = match table.tcp {
        Tcp::Blocks { on, off, .. } => (on, off),
        Tcp::None | Tcp::Length(_) => ("", ""),
    };
    // Where the post keeps the tip, the words may not exist: only a machine file that names them has them written.
    let off = match text(setup, "tcp_off", "") {
        given if given.is_empty() && setup.tcp => off.to_owned(),
        given => given,
    };
    let on = text(setup, "tcp_on", on);
    if setup.tcp && matches!(table.tcp, Tcp::Blocks { on: "", .. }) && on.is_empty() {
        return Err(
            "the words of this control's tool centre point control are not beyond doubt: name them by the options \
             `tcp_on` and `tcp_off`, or say tcp = \"post\""
                .to_owned(),
        );
    }
    Ok([on, off])
}

/// The line with the program's number and name; empty if it has neither.
fn title(table: &Table, setup: &Setup<'_>) -> String {
    let name = program_name(table, setup.program);
    let name = match name.is_empty() {
        true => name,
        false => (table.remark)(&name),
    };
    match table.title {
        Some((letter, digits)) => {
            let number = integer(setup, "program_number", 1000);
            format!("{letter}{number:0digits$} {name}").trim_end().to_owned()
        }
        None => name,
    }
}

/// Decimals of single words, by the option `word_decimals`.
fn single_decimals(setup: &Setup<'_>, axes: &mut Axes) -> Result<(), String> {
    for entry in text(setup, "word_decimals", "").split_whitespace() {
        let (name, decimals) = entry.split_once('=').unwrap_or((entry, ""));
        let decimals = decimals.parse().ok().filter(|decimals| *decimals <= 6);
        let known = decimals.is_some_and(|decimals| axes.set_decimals(name, decimals));
        if !known {
            return Err(format!(
                "word_decimals has `{entry}`, must be the name of an axis, an equals sign and 0 to 6: `A=4`"
            ));
        }
    }
    Ok(())
}
