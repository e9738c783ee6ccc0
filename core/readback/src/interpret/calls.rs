//! Words that lead elsewhere: subprograms by M98, M97, M99 and G65.

use post_grammar::nc::{NcBlock, NcItem, NcValue, NcWord};
use post_plugin::Language;

use super::astray::{FlowResult, elsewhere, fault};
use super::expression::whole;
use super::variables::Variables;

/// What a block leads to, once it is run.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum BlockTransfer {
    /// The subprogram `O` of this number, called `times` times, with these variables of its own where it is a macro.
    Subprogram { number: u64, times: i64, own: Option<Vec<(String, f64)>> },
    /// The blocks from `N` of this number on.
    Local { number: u64, times: i64 },
    /// Back to the call, or to this block of the caller.
    Return { to: Option<u64> },
    /// The part that is repeated ends with this block.
    PartEnd,
}

/// Whether a block may lead elsewhere, or sets a variable.
#[inline]
pub(super) fn leads(block: &NcBlock, language: Language, variables: &Variables) -> bool {
    let letters = matches!(language, Language::Macro | Language::Rs274);
    let names = calls_by_l(block, language);
    block.items.iter().any(|item| match item {
        NcItem::Word(word) => letters && code(word).is_some() || names && word.letter == b'L',
        NcItem::Flow(_) | NcItem::Assign { .. } => true,
        NcItem::Name(name) => name.starts_with("DEF "),
        NcItem::Named { name, .. } => variables.knows(name),
        _ => false,
    })
}

/// Whether L with a number calls a subprogram. Beside a G code of Fagor it is a word of a cycle.
#[inline]
fn calls_by_l(block: &NcBlock, language: Language) -> bool {
    match language {
        Language::Names => true,
        Language::Instructions => {
            let mut items = block.items.iter();
            !items.any(|item| matches!(item, NcItem::Word(word) if word.letter == b'G'))
        }
        Language::Macro | Language::Rs274 | Language::Conversational | Language::Joints => false,
    }
}

/// The words that lead elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CallWord {
    /// M98.
    Subprogram,
    /// M97 (Haas).
    Local,
    /// M99.
    Return,
    /// G65.
    Macro,
    /// G66 and its like: a macro at every motion.
    Modal,
}

#[inline]
fn code(word: &NcWord) -> Option<CallWord> {
    let NcValue::Number(number) = &word.value else {
        return None;
    };
    match (word.letter, number.value) {
        (b'M', 98.0) => Some(CallWord::Subprogram),
        (b'M', 97.0) => Some(CallWord::Local),
        (b'M', 99.0) => Some(CallWord::Return),
        (b'G', 65.0) => Some(CallWord::Macro),
        (b'G', 66.0 | 66.1) => Some(CallWord::Modal),
        _ => None,
    }
}

/// Takes the words that lead elsewhere out of a block.
pub(super) fn take(
    block: &mut NcBlock,
    language: Language,
    variables: &Variables,
) -> FlowResult<Option<BlockTransfer>> {
    if calls_by_l(block, language) {
        // `L100`: a subprogram, of which only the main program's file is at hand.
        let mut items = block.items.iter();
        let called = items.find_map(|item| match item {
            NcItem::Word(word) if word.letter == b'L' => Some(&word.value),
            _ => None,
        });
        if let Some(number) = called {
            return Err(elsewhere(&format!("L{}", variables.worth(number)?)));
        }
    }
    if !matches!(language, Language::Macro | Language::Rs274) {
        return Ok(None);
    }
    let found = block.items.iter().find_map(|item| match item {
        NcItem::Word(word) => code(word),
        _ => None,
    });
    let Some(found) = found else {
        return Ok(None);
    };
    let value = |letter: u8| -> FlowResult<Option<f64>> {
        for item in &block.items {
            if let NcItem::Word(word) = item
                && word.letter == letter
            {
                return variables.worth(&word.value).map(Some);
            }
        }
        Ok(None)
    };
    let number = match value(b'P')? {
        Some(number) => Some(
            u64::try_from(whole(number, "the number P")?)
                .map_err(|_| fault("the number P is negative"))?,
        ),
        None => None,
    };
    let times = match value(b'L')? {
        Some(times) => whole(times, "the count L")?,
        None => 1,
    };
    let needed = || number.ok_or_else(|| fault("a subprogram is called without its number P"));
    let pending = match found {
        CallWord::Modal => {
            return Err(fault("G66 calls a macro at every motion, and that is not run"));
        }
        CallWord::Subprogram => BlockTransfer::Subprogram { number: needed()?, times, own: None },
        CallWord::Local => BlockTransfer::Local { number: needed()?, times },
        CallWord::Return => BlockTransfer::Return { to: number },
        CallWord::Macro => BlockTransfer::Subprogram {
            number: needed()?,
            times,
            own: Some(arguments(block, variables)?),
        },
    };
    block.items.retain(|item| match item {
        NcItem::Word(word) => {
            found != CallWord::Macro && code(word).is_none() && !matches!(word.letter, b'P' | b'L')
        }
        _ => true,
    });
    Ok(Some(pending))
}

/// Letters whose values a macro finds in `#1` to `#26`, in this order; `-` where no letter leads.
const MACRO_LETTERS: &[u8; 26] = b"ABCIJKDEFGHLMNOPQRSTUVWXYZ";

/// The variables of a macro that `G65` calls.
fn arguments(block: &NcBlock, variables: &Variables) -> FlowResult<Vec<(String, f64)>> {
    let mut own: Vec<(String, f64)> = Vec::new();
    for item in &block.items {
        let NcItem::Word(word) = item else {
            continue;
        };
        if matches!(word.letter, b'G' | b'P' | b'L' | b'N' | b'O') {
            continue;
        }
        let place = MACRO_LETTERS.iter().position(|letter| *letter == word.letter);
        let Some(place) = place else {
            continue;
        };
        let name = format!("#{}", place + 1);
        if own.iter().any(|(known, _)| *known == name) {
            return Err(fault(
                "a letter stands twice behind G65: what the further ones mean is not settled here",
            ));
        }
        own.push((name, variables.worth(&word.value)?));
    }
    Ok(own)
}

/// `N100`.
pub(super) fn block_number(name: &str) -> Option<u64> {
    name.strip_prefix('N')?.parse().ok()
}
