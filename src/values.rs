//! Values on the command line: points, lengths, folders.

use std::env;
use std::path::PathBuf;

use clap::ValueEnum;

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

/// `X,Y,Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point([f64; 3]);

pub fn point(text: &str) -> Result<Point, String> {
    let numbers = text
        .split(',')
        .map(|number| finite(number.trim()))
        .collect::<Result<Vec<f64>, String>>()?;
    match numbers.try_into() {
        Ok(numbers) => Ok(Point(numbers)),
        Err(numbers) => Err(format!(
            "three numbers are needed, X,Y,Z; there are {}",
            numbers.len()
        )),
    }
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

impl Point {
    /// As the mount of the part, for `--set`.
    pub fn setting(&self) -> String {
        let [x, y, z] = &self.0;
        format!("workpiece.mount=[{x:?}, {y:?}, {z:?}]")
    }
}
