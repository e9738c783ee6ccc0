//! What a conversational block says besides letters with values, and what of it has been read.

use std::cell::Cell;

use post_grammar::nc::{NcBlock, NcItem, NcNumber, NcValue};

use super::{Answer, worth};
use crate::interpret::state::ControlState;

/// Most words of one block.
const MOST: usize = 128;

/// The names, named values, numbers and texts of a block. One that nothing reads might change what the block does:
/// [`BlockItems::all_read`] refuses it.
#[derive(Debug)]
pub(super) struct BlockItems<'b> {
    items: &'b [NcItem],
    /// Bits of the places in `items` of all that is no letter with a value.
    others: u128,
    /// Bits of those that have been read.
    read: Cell<u128>,
}

impl<'b> BlockItems<'b> {
    /// Those of `block`, of which what stands first is read: it says what the block is.
    pub(super) fn new(control: &ControlState, block: &'b NcBlock) -> Answer<Self> {
        let items = block.items.as_slice();
        if items.len() > MOST {
            let message = format!("more than {MOST} words in one block");
            return Err(control.refuse("nc-conversational", message));
        }
        let mut others = 0;
        for (place, item) in items.iter().enumerate() {
            others |= u128::from(!matches!(item, NcItem::Word(_))) << place;
        }
        let named = matches!(items.first(), Some(NcItem::Name(_)));
        Ok(Self { items, others, read: Cell::new(u128::from(named)) })
    }

    /// Items among `bits`, each with its bit.
    fn among(&self, bits: u128) -> impl Iterator<Item = (u128, &'b NcItem)> {
        let items = self.items;
        std::iter::successors(Some(bits), |bits| Some(bits & bits.wrapping_sub(1)))
            .take_while(|bits| *bits != 0)
            .map(move |bits| {
                let place = bits.trailing_zeros();
                (1 << place, &items[place as usize])
            })
    }

    /// What `wanted` makes of the first item among `bits` that it wants, which is read by that.
    fn first<T>(&self, bits: u128, wanted: impl Fn(&'b NcItem) -> Option<T>) -> Option<T> {
        let (bit, found) = self.among(bits).find_map(|(bit, item)| Some((bit, wanted(item)?)))?;
        self.read.set(self.read.get() | bit);
        Some(found)
    }

    /// The name stands in the block.
    pub(super) fn has(&self, wanted: &str) -> bool {
        let named = |item: &NcItem| match item {
            NcItem::Name(name) if &**name == wanted => Some(()),
            _ => None,
        };
        self.first(self.others, named).is_some()
    }

    /// Reads names that change nothing of what is followed.
    pub(super) fn pass(&self, names: &[&str]) {
        for name in names {
            let _ = self.has(name);
        }
    }

    /// The value after a longer name: `SPA+30`.
    pub(super) fn named(&self, control: &ControlState, wanted: &str) -> Answer<Option<f64>> {
        let value = self.first(self.others, |item| match item {
            NcItem::Named { name, value } if &**name == wanted => Some(value),
            _ => None,
        });
        value.map(|value| worth(control, value)).transpose()
    }

    /// Reads values after longer names that change nothing of what is followed.
    pub(super) fn pass_named(&self, control: &ControlState, names: &[&str]) -> Answer<()> {
        names.iter().try_for_each(|name| self.named(control, name).map(drop))
    }

    /// The next name that has not been read.
    pub(super) fn next_name(&self) -> Option<&'b str> {
        self.first(self.left(), |item| match item {
            NcItem::Name(name) => Some(&**name),
            _ => None,
        })
    }

    /// The next longer name with a value that has not been read.
    pub(super) fn next_named(&self) -> Option<(&'b str, &'b NcValue)> {
        self.first(self.left(), |item| match item {
            NcItem::Named { name, value } => Some((&**name, value)),
            _ => None,
        })
    }

    /// The next number alone that has not been read: of a cycle, of a tool.
    pub(super) fn number(&self) -> Option<NcNumber> {
        self.first(self.left(), |item| match item {
            NcItem::Number(number) => Some(*number),
            _ => None,
        })
    }

    /// The next text alone that has not been read.
    pub(super) fn text(&self) -> Option<&'b str> {
        self.first(self.left(), |item| match item {
            NcItem::Text(text) => Some(text.as_str()),
            _ => None,
        })
    }

    /// Reads all there is: nothing of it changes what is followed.
    pub(super) fn pass_all(&self) {
        self.read.set(u128::MAX);
    }

    fn left(&self) -> u128 {
        self.others & !self.read.get()
    }

    /// Refuses what has not been read.
    pub(super) fn all_read(&self, control: &ControlState) -> Answer<()> {
        let Some((_, item)) = self.among(self.left()).next() else {
            return Ok(());
        };
        let message = match item {
            NcItem::Number(number) => format!("the number {} belongs to no word", number.value),
            NcItem::Text(text) => format!("the text \"{text}\" says nothing in this block"),
            NcItem::Name(name) | NcItem::Named { name, .. } => {
                format!("`{name}` is not known in this block, and might change what it does")
            }
            _ => "this block says more than is followed".to_owned(),
        };
        Err(control.refuse("nc-conversational", message))
    }
}
