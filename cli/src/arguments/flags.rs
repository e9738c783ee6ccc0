//! Flags of the command, made of the rows of the table of settings.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, PossibleValuesParser, ValueParser};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use post_job::settings::{About, SettingForm, SettingRow, SettingValue, SettingsGroup};

/// A group of settings as the command line says them.
#[derive(Clone, Debug)]
pub struct Flags<S>(pub S);

impl<S: SettingsGroup> Args for Flags<S> {
    fn augment_args(command: Command) -> Command {
        S::ROWS.iter().fold(command, |command, row| command.arg(flag(row)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<S: SettingsGroup> FromArgMatches for Flags<S> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut flags = Self(S::default());
        flags.update_from_arg_matches(matches)?;
        Ok(flags)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        for row in S::ROWS {
            for value in told(&row.about, matches) {
                let put = (row.put)(&mut self.0, &value);
                put.map_err(|why| clap::Error::raw(ErrorKind::ValueValidation, why))?;
            }
        }
        Ok(())
    }
}

/// The flag of a row.
fn flag<S: SettingsGroup>(row: &'static SettingRow<S>) -> Arg {
    let about = &row.about;
    let text = about.text();
    let help = text.strip_suffix('.').unwrap_or(&text).to_owned();
    let mut flag = Arg::new(about.name).long(about.flag()).help(help).help_heading(about.heading);
    if let Some(letter) = about.short {
        flag = flag.short(letter);
    }
    flag = match about.form {
        SettingForm::Flag => return requiring(flag.action(ArgAction::SetTrue), about),
        SettingForm::PathIfAny => {
            let flag = flag.value_name(about.value).value_parser(parser(row));
            flag.num_args(0..=1).require_equals(true)
        }
        _ => flag.value_name(about.value).value_parser(parser(row)),
    };
    if let Some(default) = about.default {
        flag = flag.default_value(default());
    }
    let action = if about.many { ArgAction::Append } else { ArgAction::Set };
    requiring(flag.action(action).allow_hyphen_values(about.hyphens), about)
}

fn requiring(flag: Arg, about: &About) -> Arg {
    let flag = about.conflicts.iter().fold(flag, |flag, other| flag.conflicts_with(*other));
    about.requires.iter().fold(flag, |flag, other| flag.requires(*other))
}

/// What refuses values of a row that are none.
fn parser<S: SettingsGroup>(row: &'static SettingRow<S>) -> ValueParser {
    match row.about.form {
        SettingForm::Words(words) => PossibleValuesParser::new(words()).into(),
        SettingForm::Whole { least, most } => match (i64::try_from(least), i64::try_from(most)) {
            (Ok(least), Ok(most)) => clap::value_parser!(i64).range(least..=most).into(),
            // As clap says it of a number without a largest.
            _ => clap::value_parser!(u64).range(least..).into(),
        },
        SettingForm::Path | SettingForm::PathIfAny => PathBufValueParser::new().into(),
        SettingForm::Flag | SettingForm::Text => ValueParser::new(move |text: &str| {
            let put = (row.put)(&mut S::default(), &SettingValue::from(text));
            put.map(|()| text.to_owned())
        }),
    }
}

/// What the command line says of a group of settings, and nothing that holds by default.
pub fn said<S: SettingsGroup>(matches: &ArgMatches) -> Vec<(&'static About, SettingValue)> {
    let rows = S::ROWS.iter().map(|row| &row.about);
    let said =
        rows.filter(|about| matches.value_source(about.name) == Some(ValueSource::CommandLine));
    said.map(|about| {
        let mut values = told(about, matches);
        let value = match (about.many, values.len()) {
            (false, 1) => values.remove(0),
            _ => SettingValue::List(values),
        };
        (about, value)
    })
    .collect()
}

/// The values that the command line has for a row.
fn told(about: &About, matches: &ArgMatches) -> Vec<SettingValue> {
    let name = about.name;
    match about.form {
        SettingForm::Flag => vec![SettingValue::Yes(matches.get_flag(name))],
        SettingForm::Text | SettingForm::Words(_) => {
            let texts = matches.get_many::<String>(name).into_iter().flatten();
            texts.map(|text| SettingValue::from(text.as_str())).collect()
        }
        SettingForm::Whole { most, .. } if i64::try_from(most).is_ok() => {
            let numbers = matches.get_many::<i64>(name).into_iter().flatten();
            numbers.map(|number| SettingValue::Whole(*number)).collect()
        }
        SettingForm::Whole { .. } => {
            let numbers = matches.get_many::<u64>(name).into_iter().flatten();
            numbers.map(|number| SettingValue::Text(number.to_string())).collect()
        }
        SettingForm::PathIfAny if matches.contains_id(name) => {
            let path = matches.get_one::<PathBuf>(name);
            vec![path.map_or(SettingValue::Yes(true), |path| SettingValue::Path(path.clone()))]
        }
        SettingForm::Path | SettingForm::PathIfAny => {
            let paths = matches.get_many::<PathBuf>(name).into_iter().flatten();
            paths.map(|path| SettingValue::Path(path.clone())).collect()
        }
    }
}
