//! Tables of a machine file, one row a key: its name, its type, what it may be, and what it means.
//!
//! From a row follow the field, how it is read, what the JSON Schema says of it (and with that the reference page and what
//! an editor shows), and the check of its number.

use std::collections::BTreeMap;
use std::fmt;
pub(crate) use std::ops::Range;

use serde::de::{DeserializeOwned, Deserializer as _, Visitor};
pub(crate) use serde_json::Value;
use serde_json::{Map, json};
pub(crate) use toml::Spanned;
use toml::de::ValueDeserializer;
pub(crate) use toml::de::{DeTable, DeValue};

use super::bounds::Bounds;

/// A key of a machine file.
#[derive(Debug)]
pub(crate) struct Key {
    /// Name of the key.
    pub name: &'static str,
    /// What it means, as an editor shows it.
    pub doc: &'static str,
    /// What it may be.
    pub bounds: Bounds,
    /// The schema of its type.
    pub schema: fn(&mut Schemas) -> Value,
    /// The file must say it.
    pub needed: fn() -> bool,
}

/// The last of `bounds`: those of a row, if it has any.
pub(crate) const fn last(bounds: &[Bounds]) -> Bounds {
    bounds[bounds.len() - 1]
}

/// A value that cannot be read: where it stands, and what is wrong.
#[derive(Debug)]
pub(crate) struct EntryError {
    pub span: Range<usize>,
    pub slip: Slip,
}

/// What is wrong with a value that cannot be read.
#[derive(Debug)]
pub(crate) enum Slip {
    /// The table has other keys than this one.
    Key { name: String, known: Vec<&'static str> },
    /// The value is one of a few words, and not this one.
    Word { name: String, known: Vec<&'static str> },
    /// The table lacks a key.
    Missing(&'static str),
    /// The value is of another kind than its key asks for.
    Kind(String),
}

/// What can stand in a machine file for a key.
pub(crate) trait KeyType: Sized {
    /// The value of a key.
    ///
    /// # Errors
    /// The first thing in it that cannot be read.
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError>;

    /// The value where the file does not say it; none if it must.
    fn absent() -> Option<Self> {
        None
    }

    /// The file must say it.
    fn needed() -> bool {
        Self::absent().is_none()
    }

    /// Schema of the type; that of a table or a word is put under its name and referred to.
    fn schema(named: &mut Schemas) -> Value;
}

/// A value, where it stands, and of which key.
#[derive(Clone, Debug)]
pub(crate) struct KeyedValue<T> {
    value: T,
    span: Range<usize>,
    /// Key that it is given.
    pub key: &'static Key,
}

impl<T> KeyedValue<T> {
    /// The value.
    pub fn get_ref(&self) -> &T {
        &self.value
    }

    /// Where it stands, bytes of all layers.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }
}

/// Schemas by the names of the types that they are of.
pub(crate) type Schemas = Map<String, Value>;

/// A whole number.
pub(crate) type Count = KeyedValue<i64>;

/// Makes tables of a machine file of their rows, `key: type = bounds`; a key without bounds may be anything.
macro_rules! keys {
    ($(
        $(#[doc = $about:literal])*
        $table:ident {$(
            $(#[doc = $doc:literal])*
            $key:ident: $type:ty $(= $bounds:expr)?,
        )*}
    )*) => {$(
        $(#[doc = $about])*
        #[derive(Debug)]
        pub(crate) struct $table {$(
            $(#[doc = $doc])*
            pub $key: $type,
        )*}

        const _: () = {
            use $crate::description::table::*;

            impl $table {
                /// Keys in the order of the rows.
                pub(crate) const KEYS: &'static [Key] = &[$(Key {
                    name: stringify!($key),
                    doc: concat!($($doc),*),
                    bounds: last(&[$crate::description::bounds::Bounds::ANY $(, $bounds)?]),
                    schema: <$type>::schema,
                    needed: <$type>::needed,
                },)*];

                /// Reads what a table says that stands at `span`.
                ///
                /// # Errors
                /// The first thing in it that cannot be read.
                pub(crate) fn of(table: &DeTable<'_>, span: Range<usize>) -> Result<Self, EntryError> {
                    $(let mut $key: Option<$type> = None;)*
                    for (name, value) in table {
                        let key = known(name, Self::KEYS)?;
                        match key.name {
                            $(stringify!($key) => $key = Some(KeyType::read(value, key)?),)*
                            _ => {}
                        }
                    }
                    $(let $key = $key.or_else(KeyType::absent).ok_or_else(|| {
                        EntryError { span: span.clone(), slip: Slip::Missing(stringify!($key)) }
                    })?;)*
                    Ok(Self { $($key,)* })
                }
            }

            impl KeyType for $table {
                fn read(value: &Spanned<DeValue<'_>>, _: &'static Key) -> Result<Self, EntryError> {
                    let table = entries(value, concat!("struct ", stringify!($table)))?;
                    Self::of(table, value.span())
                }

                fn absent() -> Option<Self> {
                    Self::of(&DeTable::new(), 0..0).ok()
                }

                fn schema(named: &mut Schemas) -> Value {
                    let about = concat!($($about),*);
                    defined(named, stringify!($table), about, |named| table_schema(named, Self::KEYS))
                }
            }
        };
    )*};
}

/// Makes the words that a key can be of their rows, `Variant "word"`; behind the name of the type stands what holds where
/// the file does not say.
macro_rules! words {
    ($(
        $(#[doc = $about:literal])*
        $type:ident $(= $default:ident)? {$(
            $(#[doc = $doc:literal])*
            $variant:ident $word:literal,
        )*}
    )*) => {$(
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {$(
            $(#[doc = $doc])*
            $variant,
        )*}

        const _: () = {
            use $crate::description::table::*;

            impl $type {
                /// All of them, in the order of the rows.
                pub const ALL: &'static [Self] = &[$(Self::$variant),*];

                /// The word that a machine file has for it.
                pub fn name(self) -> &'static str {
                    match self {
                        $(Self::$variant => $word,)*
                    }
                }
            }

            $(impl Default for $type {
                fn default() -> Self {
                    Self::$default
                }
            })?

            impl KeyType for $type {
                fn read(value: &Spanned<DeValue<'_>>, _: &'static Key) -> Result<Self, EntryError> {
                    Ok(Self::ALL[word(value, &[$($word),*])?])
                }

                $(fn absent() -> Option<Self> {
                    Some(Self::$default)
                })?

                fn schema(named: &mut Schemas) -> Value {
                    let words = [$((Self::$variant.name(), concat!($($doc),*))),*];
                    words_schema(named, stringify!($type), concat!($($about),*), &words)
                }
            }
        };
    )*};
}

pub(crate) use {keys, words};

/// The key of this name.
pub(crate) fn known<S: AsRef<str>>(
    name: &Spanned<S>,
    keys: &'static [Key],
) -> Result<&'static Key, EntryError> {
    let text = name.get_ref().as_ref();
    keys.iter().find(|key| key.name == text).ok_or_else(|| EntryError {
        span: name.span(),
        slip: Slip::Key { name: text.to_owned(), known: keys.iter().map(|key| key.name).collect() },
    })
}

/// The place of the word that `value` is among those that it can be.
pub(crate) fn word(
    value: &Spanned<DeValue<'_>>,
    words: &[&'static str],
) -> Result<usize, EntryError> {
    let Some(name) = value.get_ref().as_str() else {
        let name = match value.get_ref() {
            DeValue::Boolean(flag) => flag.to_string(),
            other => other.type_str().to_owned(),
        };
        let slip = Slip::Word { name, known: words.to_vec() };
        return Err(EntryError { span: value.span(), slip });
    };
    words.iter().position(|word| *word == name).ok_or_else(|| EntryError {
        span: value.span(),
        slip: Slip::Word { name: name.to_owned(), known: words.to_vec() },
    })
}

/// The keys of a table, where `what` is expected.
pub(crate) fn entries<'v, 'i>(
    value: &'v Spanned<DeValue<'i>>,
    what: &'static str,
) -> Result<&'v DeTable<'i>, EntryError> {
    value.get_ref().as_table().ok_or_else(|| of_another_kind(value, what))
}

/// The message for a value that is no `what`.
pub(crate) fn of_another_kind(value: &Spanned<DeValue<'_>>, what: &'static str) -> EntryError {
    struct ExpectedKind(&'static str);
    impl Visitor<'_> for ExpectedKind {
        type Value = ();

        fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
            to.write_str(self.0)
        }
    }
    let error = ValueDeserializer::from(value.clone()).deserialize_any(ExpectedKind(what)).err();
    let message = error.map_or_else(String::new, |error| error.message().to_owned());
    EntryError { span: value.span(), slip: Slip::Kind(message) }
}

/// A value that serde knows.
pub(crate) fn plain<T: DeserializeOwned>(value: &Spanned<DeValue<'_>>) -> Result<T, EntryError> {
    T::deserialize(ValueDeserializer::from(value.clone())).map_err(|error| EntryError {
        span: error.span().unwrap_or_else(|| value.span()),
        slip: Slip::Kind(error.message().to_owned()),
    })
}

/// Puts a schema under its name, once; what refers to it.
pub(crate) fn defined(
    named: &mut Schemas,
    name: &str,
    doc: &str,
    schema: impl FnOnce(&mut Schemas) -> Value,
) -> Value {
    if !named.contains_key(name) {
        let mut schema = schema(named);
        schema["description"] = json!(doc.trim_ascii());
        named.insert(name.to_owned(), schema);
    }
    json!({ "$ref": format!("#/definitions/{name}") })
}

/// The schema of a table with these keys.
pub(crate) fn table_schema(named: &mut Schemas, keys: &[Key]) -> Value {
    let mut properties = Schemas::new();
    for key in keys {
        let mut schema = (key.schema)(named);
        // Keys beside a reference mean nothing in this draft.
        if schema.get("$ref").is_some() {
            schema = json!({ "allOf": [schema] });
        }
        key.bounds.describe(&mut schema);
        schema["description"] = json!(key.doc.trim_ascii());
        properties.insert(key.name.to_owned(), schema);
    }
    let mut schema =
        json!({ "type": "object", "properties": properties, "additionalProperties": false });
    let needed = keys.iter().filter(|key| (key.needed)()).map(|key| key.name);
    let needed: Vec<&str> = needed.collect();
    if !needed.is_empty() {
        schema["required"] = json!(needed);
    }
    schema
}

/// The schema of a few words, each with what it means.
pub(crate) fn words_schema(
    named: &mut Schemas,
    name: &str,
    doc: &str,
    words: &[(&str, &str)],
) -> Value {
    defined(named, name, doc, |_| {
        let words = words.iter().map(|(word, doc)| {
            json!({ "const": word, "type": "string", "description": doc.trim_ascii() })
        });
        json!({ "oneOf": words.collect::<Vec<_>>() })
    })
}

impl<T: KeyType> KeyType for KeyedValue<T> {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        Ok(Self { value: T::read(value, key)?, span: value.span(), key })
    }

    fn schema(named: &mut Schemas) -> Value {
        T::schema(named)
    }
}

impl<T: KeyType> KeyType for Spanned<T> {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        Ok(Self::new(value.span(), T::read(value, key)?))
    }

    fn schema(named: &mut Schemas) -> Value {
        T::schema(named)
    }
}

impl<T: KeyType> KeyType for Option<T> {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        T::read(value, key).map(Some)
    }

    fn absent() -> Option<Self> {
        Some(None)
    }

    fn schema(named: &mut Schemas) -> Value {
        T::schema(named)
    }
}

impl<T: KeyType> KeyType for Vec<T> {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let DeValue::Array(items) = value.get_ref() else {
            return Err(of_another_kind(value, "a sequence"));
        };
        items.iter().map(|item| T::read(item, key)).collect()
    }

    fn absent() -> Option<Self> {
        Some(Self::new())
    }

    fn schema(named: &mut Schemas) -> Value {
        json!({ "type": "array", "items": T::schema(named) })
    }
}

impl<T: KeyType, const N: usize> KeyType for [T; N] {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let DeValue::Array(items) = value.get_ref() else {
            return Err(of_another_kind(
                value,
                match N {
                    2 => "two numbers, such as [-500, 500]",
                    _ => "three numbers, such as [1, 0, 0] for X",
                },
            ));
        };
        let items: Vec<T> =
            items.iter().take(N).map(|item| T::read(item, key)).collect::<Result<_, _>>()?;
        items.try_into().map_err(|items: Vec<T>| {
            let message =
                format!("invalid length {}, expected an array of length {N}", items.len());
            EntryError { span: value.span(), slip: Slip::Kind(message) }
        })
    }

    fn schema(named: &mut Schemas) -> Value {
        json!({ "type": "array", "items": T::schema(named), "minItems": N, "maxItems": N })
    }
}

/// What a user's own name is read as.
pub(crate) trait Name: Ord {
    /// A name and where it stands.
    fn of(name: &str, span: Range<usize>) -> Self;
}

impl Name for String {
    fn of(name: &str, _: Range<usize>) -> Self {
        name.to_owned()
    }
}

impl Name for Spanned<String> {
    fn of(name: &str, span: Range<usize>) -> Self {
        Self::new(span, name.to_owned())
    }
}

impl<N: Name, T: KeyType> KeyType for BTreeMap<N, T> {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let table = entries(value, "a map")?.iter();
        table
            .map(|(name, value)| Ok((N::of(name.get_ref(), name.span()), T::read(value, key)?)))
            .collect()
    }

    fn absent() -> Option<Self> {
        Some(Self::new())
    }

    fn schema(named: &mut Schemas) -> Value {
        json!({ "type": "object", "additionalProperties": T::schema(named) })
    }
}

/// Makes entries of types that serde knows, with their schemas and what holds where the file does not say it.
macro_rules! plain {
    ($($type:ty: $schema:tt, $absent:expr;)*) => {$(
        impl KeyType for $type {
            fn read(value: &Spanned<DeValue<'_>>, _: &'static Key) -> Result<Self, EntryError> {
                plain(value)
            }

            fn absent() -> Option<Self> {
                $absent
            }

            fn schema(_: &mut Schemas) -> Value {
                json!($schema)
            }
        }
    )*};
}

plain! {
    bool: { "type": "boolean" }, Some(false);
    String: { "type": "string" }, None;
    i64: { "type": "integer", "format": "uint32" }, None;
    u32: { "type": "integer", "format": "uint32" }, None;
}
