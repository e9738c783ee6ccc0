//! Values as bytes between two processes of the same program. What comes back from a library's process is as
//! untrustworthy as the library: no length is believed before the bytes are there.

use post_plugin::raw::{self, PostFormat};
use post_plugin::{Accuracy, Curve, Deviation, OptionKind, OptionSpec, Tolerance, Units, Value};

use crate::{GivenValue, ProgramAhead, ProgramSetup, ProgramTool, ProgramWord};

/// A value that crosses between processes.
pub(crate) trait Wire: Sized {
    /// Appends it.
    fn put(&self, to: &mut Vec<u8>);

    /// Takes it from the front; none if it does not stand there.
    fn take(from: &mut &[u8]) -> Option<Self>;
}

macro_rules! numbers {
    ($($type:ty)*) => {$(
        impl Wire for $type {
            fn put(&self, to: &mut Vec<u8>) {
                to.extend_from_slice(&self.to_ne_bytes());
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                let (bytes, rest) = from.split_first_chunk()?;
                *from = rest;
                Some(Self::from_ne_bytes(*bytes))
            }
        }
    )*};
}

numbers!(u8 u32 i32 u64 i64 f64);

macro_rules! structs {
    ($($type:ident { $($field:ident)* })*) => {$(
        impl Wire for $type {
            fn put(&self, to: &mut Vec<u8>) {
                $(self.$field.put(to);)*
            }

            fn take(from: &mut &[u8]) -> Option<Self> {
                Some($type { $($field: Wire::take(from)?),* })
            }
        }
    )*};
}

structs! {
    ProgramSetup { program machine units tcp turns_part words options cl_file accuracy ahead }
    ProgramWord { name rotary wrapped signed depth carries_part diameter travel }
    ProgramAhead { tools extents time }
    ProgramTool { number name length diameter corner_radius }
    Accuracy { cut rapid }
    Tolerance { tip axis }
    Deviation { tip axis }
    Curve { tip_peak tip_at axis_peak axis_at terms }
    OptionSpec { key kind default help }
    PostFormat {
        size words feed inverse_time feed_per_revolution words_len extension writes most_inverse_time
        plane_angles plane_decimals language reserved rapid_feed
    }
}

impl Wire for () {
    fn put(&self, _: &mut Vec<u8>) {}

    fn take(_: &mut &[u8]) -> Option<Self> {
        Some(())
    }
}

impl Wire for bool {
    fn put(&self, to: &mut Vec<u8>) {
        to.push((*self).into());
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match u8::take(from)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl Wire for String {
    fn put(&self, to: &mut Vec<u8>) {
        (self.len() as u64).put(to);
        to.extend_from_slice(self.as_bytes());
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::try_from(u64::take(from)?).ok()?;
        let (text, rest) = from.split_at_checked(length)?;
        *from = rest;
        Some(std::str::from_utf8(text).ok()?.to_owned())
    }
}

/// For ever, as what a library declares.
impl Wire for &'static str {
    fn put(&self, to: &mut Vec<u8>) {
        (*self).to_owned().put(to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(String::take(from)?.leak())
    }
}

impl<T: Wire> Wire for Vec<T> {
    fn put(&self, to: &mut Vec<u8>) {
        (self.len() as u64).put(to);
        for item in self {
            item.put(to);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let length = usize::try_from(u64::take(from)?).ok()?;
        // Each item has a byte at least.
        let mut items = Vec::with_capacity(length.min(from.len()).min(4096));
        for _ in 0..length {
            items.push(T::take(from)?);
        }
        Some(items)
    }
}

impl<T: Wire> Wire for Box<T> {
    fn put(&self, to: &mut Vec<u8>) {
        T::put(self, to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        T::take(from).map(Box::new)
    }
}

impl<T: Wire, const N: usize> Wire for [T; N] {
    fn put(&self, to: &mut Vec<u8>) {
        for item in self {
            item.put(to);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let items: Option<Vec<T>> = (0..N).map(|_| T::take(from)).collect();
        items?.try_into().ok()
    }
}

impl<A: Wire, B: Wire> Wire for (A, B) {
    fn put(&self, to: &mut Vec<u8>) {
        self.0.put(to);
        self.1.put(to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some((A::take(from)?, B::take(from)?))
    }
}

impl<T: Wire> Wire for Option<T> {
    fn put(&self, to: &mut Vec<u8>) {
        self.is_some().put(to);
        if let Some(value) = self {
            value.put(to);
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(if bool::take(from)? { Some(T::take(from)?) } else { None })
    }
}

impl<T: Wire, E: Wire> Wire for Result<T, E> {
    fn put(&self, to: &mut Vec<u8>) {
        self.is_ok().put(to);
        match self {
            Ok(value) => value.put(to),
            Err(fault) => fault.put(to),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(if bool::take(from)? { Ok(T::take(from)?) } else { Err(E::take(from)?) })
    }
}

impl Wire for Units {
    fn put(&self, to: &mut Vec<u8>) {
        matches!(self, Units::Inch).put(to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(if bool::take(from)? { Units::Inch } else { Units::Millimetre })
    }
}

impl Wire for GivenValue {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            GivenValue::Flag(flag) => (raw::OPTION_FLAG, *flag).put(to),
            GivenValue::Integer(integer) => (raw::OPTION_INTEGER, *integer).put(to),
            GivenValue::Number(number) => (raw::OPTION_NUMBER, *number).put(to),
            GivenValue::Text(text) => (raw::OPTION_TEXT, text.clone()).put(to),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        match u32::take(from)? {
            raw::OPTION_FLAG => Wire::take(from).map(GivenValue::Flag),
            raw::OPTION_INTEGER => Wire::take(from).map(GivenValue::Integer),
            raw::OPTION_NUMBER => Wire::take(from).map(GivenValue::Number),
            raw::OPTION_TEXT => Wire::take(from).map(GivenValue::Text),
            _ => None,
        }
    }
}

impl Wire for Value<'static> {
    fn put(&self, to: &mut Vec<u8>) {
        GivenValue::from(*self).put(to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(match GivenValue::take(from)? {
            GivenValue::Flag(flag) => Value::Flag(flag),
            GivenValue::Integer(integer) => Value::Integer(integer),
            GivenValue::Number(number) => Value::Number(number),
            GivenValue::Text(text) => Value::Text(text.leak()),
        })
    }
}

impl Wire for OptionKind {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            OptionKind::Flag => raw::OPTION_FLAG.put(to),
            OptionKind::Integer { min, max } => (raw::OPTION_INTEGER, (*min, *max)).put(to),
            OptionKind::Number { min, max } => (raw::OPTION_NUMBER, (*min, *max)).put(to),
            OptionKind::Text => raw::OPTION_TEXT.put(to),
            OptionKind::Lines => raw::OPTION_LINES.put(to),
            OptionKind::Choice(choices) => (raw::OPTION_CHOICE, choices.to_vec()).put(to),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(match u32::take(from)? {
            raw::OPTION_FLAG => OptionKind::Flag,
            raw::OPTION_INTEGER => {
                OptionKind::Integer { min: Wire::take(from)?, max: Wire::take(from)? }
            }
            raw::OPTION_NUMBER => {
                OptionKind::Number { min: Wire::take(from)?, max: Wire::take(from)? }
            }
            raw::OPTION_TEXT => OptionKind::Text,
            raw::OPTION_LINES => OptionKind::Lines,
            raw::OPTION_CHOICE => OptionKind::Choice(Vec::take(from)?.leak()),
            _ => return None,
        })
    }
}
