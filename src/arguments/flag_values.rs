//! Values on the command line: points, lengths, folders.

use std::convert::Infallible;
use std::env;
use std::path::PathBuf;

use clap::ValueEnum;
use post_machine::description::{Setting, Tcp};

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum UnitsArgument {
    Mm,
    Inch,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TcpArgument {
    Control,
    Post,
}

/// Folders that the user names: on the command line, then in an environment variable.
pub fn folders(named: &[PathBuf], variable: &str) -> Vec<PathBuf> {
    let mut folders = named.to_owned();
    if let Some(more) = env::var_os(variable) {
        folders.extend(env::split_paths(&more).filter(|path| !path.as_os_str().is_empty()));
    }
    folders
}

impl From<TcpArgument> for Tcp {
    fn from(who: TcpArgument) -> Self {
        match who {
            TcpArgument::Control => Self::Control,
            TcpArgument::Post => Self::Post,
        }
    }
}

/// `NAME=VALUE`; what it means to the machine file is the loader's business.
pub fn setting(text: &str) -> Result<Setting, Infallible> {
    Ok(Setting::Written(text.to_owned()))
}

/// Three coordinates.
pub type Point = [f64; 3];

/// `X,Y,Z`.
pub fn point(text: &str) -> Result<Point, String> {
    let numbers = text
        .split(',')
        .map(|number| finite(number.trim()))
        .collect::<Result<Vec<f64>, String>>()?;
    numbers.try_into().map_err(|numbers: Vec<f64>| {
        format!(
            "three numbers are needed, X,Y,Z; there are {}",
            numbers.len()
        )
    })
}

pub fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("`{text}` is no number")),
    }
}

pub fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if number >= 0.0 => Ok(number),
        number => Err(format!("{number} is below zero")),
    }
}

pub fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if number > 0.0 => Ok(number),
        number => Err(format!("{number} is not above zero")),
    }
}
