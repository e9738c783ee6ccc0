//! The table of settings: what a row says, and what a group of rows is told.

use post_machine::diagnostic::{Diagnostic, nearest};

use super::values::{SettingForm, SettingValue};

/// What a setting is, whoever sets it.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// Its name: that of the field, of the key and of the option; the flag has hyphens.
    pub name: &'static str,
    /// The letter that stands for it on the command line.
    pub short: Option<char>,
    /// Lines of its doc.
    pub doc: &'static [&'static str],
    /// What its value is called, `MM`; a flag has none.
    pub value: &'static str,
    /// What values it can have.
    pub form: SettingForm,
    /// It may be said again, and each value counts.
    pub many: bool,
    /// The heading that the flag stands under.
    pub heading: Option<&'static str>,
    /// The value that holds if nothing is said.
    pub default: Option<fn() -> String>,
    /// Its value may begin with a hyphen, as numbers below zero do.
    pub hyphens: bool,
    /// The setting that it cannot go with.
    pub conflicts: Option<&'static str>,
    /// The setting that it needs.
    pub requires: Option<&'static str>,
    /// Its columns in the table of a batch, whose jobs may set it; several are a list. None: all jobs have the same.
    pub columns: &'static [&'static str],
}

impl About {
    /// A row that says nothing.
    pub const NONE: Self = Self {
        name: "",
        short: None,
        doc: &[],
        value: "",
        form: SettingForm::Flag,
        many: false,
        heading: None,
        default: None,
        hyphens: false,
        conflicts: None,
        requires: None,
        columns: &[],
    };

    /// The flag without its hyphens in front.
    pub fn flag(&self) -> String {
        self.name.replace('_', "-")
    }

    /// Its doc on one line.
    pub fn text(&self) -> String {
        let lines: Vec<&str> = self.doc.iter().map(|line| line.trim()).collect();
        lines.join(" ")
    }

    /// The flag with its value, as messages have it.
    fn shown(&self) -> String {
        match self.form {
            SettingForm::Flag => format!("--{}", self.flag()),
            SettingForm::PathIfAny => format!("--{}[=<{}>]", self.flag(), self.value),
            _ => format!("--{} <{}>", self.flag(), self.value),
        }
    }

    /// What is wrong with a value.
    fn fault(&self, value: &SettingValue, why: &str) -> Diagnostic {
        let told = format!("invalid value '{value}' for '{}'", self.shown());
        let SettingForm::Words(words) = self.form else {
            return Diagnostic::error("option", format!("{told}: {why}"));
        };
        let words = words();
        let told = format!("{told}\n  [possible values: {}]", words.join(", "));
        let finding = Diagnostic::error("option", told);
        match nearest(&value.to_string(), words.iter().copied()) {
            Some(meant) => finding.help(format!("a similar value exists: '{meant}'")),
            None => finding,
        }
    }
}

/// A setting of the group `S`.
pub struct SettingRow<S> {
    /// What it is.
    pub about: About,
    /// Sets it; an error says why the value is none.
    pub put: fn(&mut S, &SettingValue) -> Result<(), String>,
}

/// A group of settings.
pub trait SettingsGroup: Default + 'static {
    /// Its rows, in the order of its fields.
    const ROWS: &'static [SettingRow<Self>];

    /// The row of that name.
    fn row(name: &str) -> Option<&'static SettingRow<Self>> {
        Self::ROWS.iter().find(|row| row.about.name == name)
    }
}

/// A group of settings, whichever it is.
pub trait AnySettingsGroup {
    /// What its settings are.
    fn about(&self) -> Vec<&'static About>;

    /// Sets the one of that name; none if it is of another group.
    fn put(&mut self, name: &str, value: &SettingValue) -> Option<Result<(), String>>;
}

impl<S: SettingsGroup> AnySettingsGroup for S {
    fn about(&self) -> Vec<&'static About> {
        Self::ROWS.iter().map(|row| &row.about).collect()
    }

    fn put(&mut self, name: &str, value: &SettingValue) -> Option<Result<(), String>> {
        let row = Self::row(name)?;
        Some(match value {
            SettingValue::List(values) if row.about.many => {
                values.iter().try_for_each(|value| (row.put)(self, value))
            }
            value => (row.put)(self, value),
        })
    }
}

/// Sets by name what was told, each in its group, in the words of the command line.
///
/// # Errors
/// A name that no group has, a value that is none, or settings that do not go together.
pub fn tell(
    told: &[(String, SettingValue)],
    groups: &mut [&mut dyn AnySettingsGroup],
) -> Result<(), Box<Diagnostic>> {
    let known: Vec<&About> = groups.iter().flat_map(|group| group.about()).collect();
    let has = |name: &str| told.iter().any(|(told, _)| told == name);
    for (name, value) in told {
        let Some(about) = known.iter().find(|about| about.name == name) else {
            let message = format!("unexpected argument '--{}' found", name.replace('_', "-"));
            let meant = nearest(name, known.iter().map(|about| about.name));
            let finding = Diagnostic::error("option", message);
            return Err(Box::new(match meant {
                Some(meant) => {
                    let meant = meant.replace('_', "-");
                    finding.help(format!("a similar argument exists: '--{meant}'"))
                }
                None => finding,
            }));
        };
        if let Some(other) = about.conflicts.filter(|other| has(other))
            && let Some(other) = known.iter().find(|about| about.name == other)
        {
            let message =
                format!("the argument '{}' cannot be used with '{}'", about.shown(), other.shown());
            return Err(Diagnostic::error("option", message).boxed());
        }
        if let Some(other) = about.requires.filter(|other| !has(other))
            && let Some(other) = known.iter().find(|about| about.name == other)
        {
            let message =
                format!("the following required arguments were not provided:\n  {}", other.shown());
            return Err(Diagnostic::error("option", message).boxed());
        }
        let put = groups.iter_mut().find_map(|group| group.put(name, value));
        put.unwrap_or(Ok(())).map_err(|why| about.fault(value, &why).boxed())?;
    }
    Ok(())
}

/// Declares a group of settings, a row each:
/// `one NAME: TYPE = READER, "VALUE";` may be left out (`Option`), `many` may be said again (`Vec`), `flag NAME;` is true or
/// not, `given NAME: TYPE = READER, "VALUE", default TEXT` always has a value. A field
/// that the group comes `with` is no row.
macro_rules! settings {
    // The shape of a field, of its value as it begins, and of how it is set.
    (@type flag) => { bool };
    (@type one $type:ty) => { Option<$type> };
    (@type many $type:ty) => { Vec<$type> };
    (@type given $type:ty) => { $type };
    (@form flag) => { $crate::settings::SettingForm::Flag };
    (@form $kind:ident $reader:expr) => { $reader.form };
    (@many many) => { true };
    (@many $kind:ident) => { false };
    (@put flag $field:expr, $value:ident) => {{ $field = $value.yes()?; }};
    (@put one $field:expr, $value:ident, $reader:expr) => {{ $field = Some(($reader.read)($value)?); }};
    (@put many $field:expr, $value:ident, $reader:expr) => {{ $field.push(($reader.read)($value)?); }};
    (@put given $field:expr, $value:ident, $reader:expr) => {{ $field = ($reader.read)($value)?; }};
    (@default given $reader:expr, $($text:expr)?) => {
        // The text stands in the table, and its reader beside it.
        ($reader.read)(&$crate::settings::SettingValue::Text(($($text)?)())).unwrap_or_default()
    };
    (@default $kind:ident $($reader:expr, $($text:expr)?)?) => { Default::default() };
    (
        $(#[doc = $about:literal])*
        $group:ident, $heading:expr $(, with { $(#[doc = $plain_doc:literal])* $plain:ident: $plain_type:ty })?;
        $(
            $(#[doc = $doc:literal])+
            $kind:ident $field:ident $(: $type:ty = $reader:expr, $value:literal
                $(, default $default:expr)?)? $(, { $($attribute:ident: $told:expr),* })?;
        )*
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug)]
        pub struct $group {
            $( $(#[doc = $plain_doc])* pub $plain: $plain_type, )*
            $( $(#[doc = $doc])+ pub $field: settings!(@type $kind $($type)?), )*
        }

        impl Default for $group {
            fn default() -> Self {
                Self {
                    $( $plain: Default::default(), )*
                    $( $field: settings!(@default $kind $($reader, $($default)?)?), )*
                }
            }
        }

        impl $crate::settings::SettingsGroup for $group {
            const ROWS: &'static [$crate::settings::SettingRow<Self>] = &[$(
                $crate::settings::SettingRow {
                    about: $crate::settings::About {
                        name: stringify!($field),
                        doc: &[$($doc),+],
                        $( value: $value, $( default: Some($default), )? )?
                        form: settings!(@form $kind $($reader)?),
                        many: settings!(@many $kind),
                        $( $($attribute: $told,)* )?
                        ..$crate::settings::About {
                            heading: $heading,
                            ..$crate::settings::About::NONE
                        }
                    },
                    put: |all, value| {
                        settings!(@put $kind all.$field, value $(, $reader)?);
                        Ok(())
                    },
                },
            )*];
        }
    };
}

pub(crate) use settings;
