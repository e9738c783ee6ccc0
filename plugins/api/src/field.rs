//! The fields that events are made of: how each becomes numbers and texts, and comes back from them.
//!
//! An event crosses the border as one array of numbers and one of texts, field after field in the order of the
//! table in `event.rs`. What is missing at the end of either has its default, so an event can grow.

use crate::flat::Flat;

/// Most texts that an event has.
pub(crate) const MAX_TEXTS: usize = 2;

/// What a field takes up, for the C header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldShape {
    /// Numbers, and how many.
    Numbers(usize),
    /// A number that says how many follow, and those.
    List,
    /// A text.
    Text,
}

/// Why numbers and texts are no event of their kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotKnown;

/// What the host promises of every event: as many words as the program has, feeds that the format allows.
#[derive(Clone, Copy, Debug)]
pub struct Promise {
    /// Axis words of the program.
    pub words: usize,
    /// The control has an inverse-time feed.
    pub inverse_time: bool,
}

/// Numbers and texts of one event on their way back.
#[derive(Debug)]
pub(crate) struct FieldReader<'a> {
    numbers: &'a [f64],
    texts: [&'a str; MAX_TEXTS],
    text: usize,
}

impl<'a> FieldReader<'a> {
    #[inline]
    pub(crate) fn new(numbers: &'a [f64], texts: [&'a str; MAX_TEXTS]) -> Self {
        Self { numbers, texts, text: 0 }
    }

    #[inline]
    fn next(&mut self) -> Option<f64> {
        let (first, rest) = self.numbers.split_first()?;
        self.numbers = rest;
        Some(*first)
    }

    /// The next `N` numbers; none if there are fewer.
    #[inline]
    fn some<const N: usize>(&mut self) -> Option<[f64; N]> {
        let (first, rest) = self.numbers.split_first_chunk()?;
        self.numbers = rest;
        Some(*first)
    }

    #[inline]
    pub(crate) fn list(&mut self) -> Result<&'a [f64], NotKnown> {
        let count = whole(self.next().unwrap_or(0.0)).ok_or(NotKnown)?;
        let (list, rest) = self.numbers.split_at_checked(count as usize).ok_or(NotKnown)?;
        self.numbers = rest;
        Ok(list)
    }

    fn text(&mut self) -> &'a str {
        let text = self.texts.get(self.text).copied().unwrap_or("");
        self.text += 1;
        text
    }
}

/// A number that is whole and not negative.
#[inline]
pub(crate) fn whole(number: f64) -> Option<u32> {
    let whole = number as u32;
    (f64::from(whole) == number).then_some(whole)
}

/// A type that a field of an event may have.
pub(crate) trait Field<'a>: Copy {
    /// What it takes up.
    const SHAPE: FieldShape;
    /// A value for tests.
    const SAMPLE: Self;
    /// Appends it.
    fn put(self, to: &mut Flat);
    /// Takes it back.
    fn get(from: &mut FieldReader<'a>) -> Result<Self, NotKnown>;
    /// Is it what the host promises? A sentence if not.
    fn check(self, _: &Promise) -> Result<(), String> {
        Ok(())
    }
}

#[inline]
pub(crate) fn finite(numbers: &[f64], what: &str) -> Result<(), String> {
    // Without a branch: the compiler makes vectors of it.
    if numbers.iter().fold(true, |all, number| all & number.is_finite()) {
        return Ok(());
    }
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(number) => Err(format!("{what} is {number}")),
        None => Ok(()),
    }
}

impl<'a> Field<'a> for &'a str {
    const SHAPE: FieldShape = FieldShape::Text;
    const SAMPLE: Self = "sample";

    fn put(self, to: &mut Flat) {
        to.text(self);
    }

    fn get(from: &mut FieldReader<'a>) -> Result<Self, NotKnown> {
        Ok(from.text())
    }
}

impl Field<'_> for f64 {
    const SHAPE: FieldShape = FieldShape::Numbers(1);
    const SAMPLE: Self = 1.5;

    fn put(self, to: &mut Flat) {
        to.numbers(&[self]);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        Ok(from.next().unwrap_or(0.0))
    }

    fn check(self, _: &Promise) -> Result<(), String> {
        finite(&[self], "its number")
    }
}

impl Field<'_> for Option<f64> {
    const SHAPE: FieldShape = FieldShape::Numbers(1);
    const SAMPLE: Self = Some(2.5);

    fn put(self, to: &mut Flat) {
        to.numbers(&[self.unwrap_or(f64::NAN)]);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        Ok(from.next().filter(|number| !number.is_nan()))
    }

    fn check(self, _: &Promise) -> Result<(), String> {
        finite(self.as_slice(), "its number")
    }
}

impl Field<'_> for u32 {
    const SHAPE: FieldShape = FieldShape::Numbers(1);
    const SAMPLE: Self = 3;

    fn put(self, to: &mut Flat) {
        to.numbers(&[self.into()]);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        whole(from.next().unwrap_or(0.0)).ok_or(NotKnown)
    }
}

impl Field<'_> for Option<u32> {
    const SHAPE: FieldShape = FieldShape::Numbers(1);
    const SAMPLE: Self = Some(4);

    fn put(self, to: &mut Flat) {
        to.numbers(&[self.map_or(f64::NAN, f64::from)]);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        match from.next().filter(|number| !number.is_nan()) {
            None => Ok(None),
            Some(number) => whole(number).map(Some).ok_or(NotKnown),
        }
    }
}

impl Field<'_> for bool {
    const SHAPE: FieldShape = FieldShape::Numbers(1);
    const SAMPLE: Self = true;

    fn put(self, to: &mut Flat) {
        to.numbers(&[f64::from(u8::from(self))]);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        match u32::get(from)? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(NotKnown),
        }
    }
}

impl Field<'_> for [f64; 3] {
    const SHAPE: FieldShape = FieldShape::Numbers(3);
    const SAMPLE: Self = [0.0, 0.6, 0.8];

    fn put(self, to: &mut Flat) {
        to.numbers(&self);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        Ok(from.some().unwrap_or_default())
    }

    fn check(self, _: &Promise) -> Result<(), String> {
        finite(&self, "its vector")
    }
}

impl Field<'_> for [f64; 4] {
    const SHAPE: FieldShape = FieldShape::Numbers(4);
    const SAMPLE: Self = [1.0, 0.0, 0.0, 0.0];

    fn put(self, to: &mut Flat) {
        to.numbers(&self);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        Ok(from.some().unwrap_or_default())
    }

    fn check(self, _: &Promise) -> Result<(), String> {
        finite(&self, "its quaternion")
    }
}

/// The axis words of a move.
impl<'a> Field<'a> for &'a [f64] {
    const SHAPE: FieldShape = FieldShape::List;
    const SAMPLE: Self = &[1.0, 2.0, 3.0, 4.0, 5.0];

    #[inline]
    fn put(self, to: &mut Flat) {
        to.numbers(&[self.len() as f64]);
        to.numbers(self);
    }

    #[inline]
    fn get(from: &mut FieldReader<'a>) -> Result<Self, NotKnown> {
        from.list()
    }

    #[inline]
    fn check(self, promise: &Promise) -> Result<(), String> {
        if self.len() != promise.words {
            return Err(format!("{} axis words instead of {}", self.len(), promise.words));
        }
        finite(self, "an axis word")
    }
}

/// A list of numbers that are not the axis words of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct List<'a>(pub &'a [f64]);

impl<'a> Field<'a> for List<'a> {
    const SHAPE: FieldShape = FieldShape::List;
    const SAMPLE: Self = List(&[0.0, 0.5, 1.0]);

    fn put(self, to: &mut Flat) {
        self.0.put(to);
    }

    fn get(from: &mut FieldReader<'a>) -> Result<Self, NotKnown> {
        from.list().map(List)
    }

    fn check(self, _: &Promise) -> Result<(), String> {
        finite(self.0, "a number of its list")
    }
}

/// Where the tool stands against the part, as the printed words bring it there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolPose {
    /// The tip, mm, part frame, whatever the units of the program are.
    pub tip: [f64; 3],
    /// Unit vector from the tip to the spindle, part frame.
    pub axis: [f64; 3],
}

impl Field<'_> for Option<ToolPose> {
    const SHAPE: FieldShape = FieldShape::Numbers(6);
    const SAMPLE: Self = Some(ToolPose { tip: [1.0, 2.0, 3.0], axis: [0.0, 0.6, 0.8] });

    #[inline]
    fn put(self, to: &mut Flat) {
        let [x, y, z, i, j, k] = match self {
            Some(ToolPose { tip: [x, y, z], axis: [i, j, k] }) => [x, y, z, i, j, k],
            None => [f64::NAN; 6],
        };
        to.numbers(&[x, y, z, i, j, k]);
    }

    #[inline]
    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        let numbers = from.some().filter(|[x, ..]: &[f64; 6]| !x.is_nan());
        Ok(numbers.map(|[x, y, z, i, j, k]| ToolPose { tip: [x, y, z], axis: [i, j, k] }))
    }

    #[inline]
    fn check(self, _: &Promise) -> Result<(), String> {
        let Some(ToolPose { tip, axis }) = self else {
            return Ok(());
        };
        finite(&tip, "a coordinate of the tip")?;
        let square: f64 = axis.iter().map(|part| part * part).sum();
        if (square - 1.0).abs() < 1e-6 {
            Ok(())
        } else {
            let length = square.sqrt();
            Err(format!("the tool axis is {length} long, not a unit vector"))
        }
    }
}

/// Numbers that stand for a word, with their names in C.
#[derive(Clone, Copy, Debug)]
pub struct Codes {
    /// `COOLANT`.
    pub name: &'static str,
    /// `FLOOD` and its number.
    pub codes: &'static [(&'static str, u32)],
}

/// An enum whose values are numbers in the contract.
macro_rules! codes {
    ($(#[$about:meta])* $name:ident $upper:literal {
        $($(#[$doc:meta])* $variant:ident = $code:literal $c:literal,)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$doc])* $variant,)*
        }

        impl $name {
            /// Numbers of the words in the contract.
            pub(crate) const CODES: Codes = Codes {
                name: $upper,
                codes: &[$(($c, $code)),*],
            };

            pub(crate) const fn code(self) -> u32 {
                match self {
                    $($name::$variant => $code,)*
                }
            }

            pub(crate) const fn of(code: u32) -> Option<Self> {
                match code {
                    $($code => Some($name::$variant),)*
                    _ => None,
                }
            }
        }

        impl crate::field::Field<'_> for $name {
            const SHAPE: crate::field::FieldShape = crate::field::FieldShape::Numbers(1);
            const SAMPLE: Self = [$($name::$variant),*][0];

            fn put(self, to: &mut crate::flat::Flat) {
                self.code().put(to);
            }

            fn get(from: &mut crate::field::FieldReader<'_>) -> Result<Self, crate::field::NotKnown> {
                $name::of(u32::get(from)?).ok_or(crate::field::NotKnown)
            }
        }
    };
}
pub(crate) use codes;
