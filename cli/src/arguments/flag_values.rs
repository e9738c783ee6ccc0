//! Values of flags that are no settings of a job: words that stand for one of a few things, numbers, points.

use std::convert::Infallible;

use clap::ValueEnum;
use clap::builder::{EnumValueParser, PathBufValueParser, TypedValueParser};
use post_machine::description::Setting;
use post_posting::program::DefaultSpindle;

use post_job::files::PathArg;
use post_job::settings::values::{self, SettingValue};

/// Reads one of the words `W`, and takes it for what it means.
pub fn word<W, T>() -> impl TypedValueParser<Value = T>
where
    W: ValueEnum + Clone + Send + Sync + 'static,
    T: From<W> + Clone + Send + Sync + 'static,
{
    EnumValueParser::<W>::new().map(T::from)
}

/// Reads a file, `-` for the standard streams.
pub fn file() -> impl TypedValueParser<Value = PathArg> {
    PathBufValueParser::new().map(PathArg::from)
}

/// `NAME=VALUE`; what it means to the machine file is the loader's business.
pub fn setting(text: &str) -> Result<Setting, Infallible> {
    Ok(Setting::Written(text.to_owned()))
}

/// Values of settings, of the text of a flag.
macro_rules! of_text {
    ($($name:ident: $type:ty),*) => {
        $(
            #[doc = concat!("As [`values::", stringify!($name), "`].")]
            pub fn $name(text: &str) -> Result<$type, String> {
                values::$name(&SettingValue::from(text))
            }
        )*
    };
}

of_text!(
    spindle: DefaultSpindle,
    point: [f64; 3],
    finite: f64,
    not_negative: f64,
    feed: f64,
    length: f64,
    period: f64,
    positive: f64
);
