//! Remarks as they come: long ones, letters of every language, letters that would end the remark.

use post_plugin::Event;

use super::Case;
use super::pen::{BEGIN, ELSEWHERE, END, Pen};
use crate::at;
use post_host::PluginFault;

/// What a remark may hold, and what it is called in a message.
const REMARKS: &[(&str, &str)] = &[
    ("an empty remark", ""),
    ("a remark with letters of other languages", "Größe µ, 孔 直径, ø12 ±0,02, Ω"),
    ("a remark with brackets and signs", "a) b ( c ] d [ ; e % / * \" ' # = <f> {g} ~ M30 \\"),
    ("a remark that ends like a block", "G0 Z-500."),
    ("a remark of one bracket", ")"),
];

/// Runs them.
pub(super) fn remarks(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    if pen.leaves_out(&Event::Comment { text: "" }) {
        return Ok(());
    }
    let long = "tool path 12 with 0.2 mm of stock ".repeat(300);
    let unbroken = "x".repeat(2000);
    let long = [
        ("a remark of 10200 letters", long.as_str()),
        ("a word of 2000 letters", unbroken.as_str()),
    ];
    for (what, text) in REMARKS.iter().chain(&long) {
        let remark = [Event::Comment { text }];
        match pen.write(&[BEGIN, &[at(&ELSEWHERE)], &remark, END])? {
            Err(fault) => case.wrong(format!("{what} is refused: {fault}")),
            Ok(written) => {
                if let Some(line) = written.part(2).lines().find(|line| ends_early(line)) {
                    case.wrong(format!(
                        "{what} ends before its line does, so that the control reads the rest: `{line}`"
                    ));
                }
            }
        }
    }
    Ok(())
}

/// A remark in brackets has more behind the closing one.
pub fn ends_early(line: &str) -> bool {
    let line = line.trim_end();
    let Some((front, remark)) = line.split_once('(') else {
        return false;
    };
    let number = front.trim().trim_start_matches(['N', ':', '/']);
    let alone = number.bytes().all(|byte| byte.is_ascii_digit());
    alone && remark.find(')').is_some_and(|end| end + 1 < remark.len())
}
