//! Values over what a machine file says, for one run.

use std::path::PathBuf;

use post_grammar::text::is_unprintable;
use serde_json::json;
use toml::de::DeTable;

use super::file::{Method, Placement, Tcp};
use crate::diagnostic::Diagnostic;

/// One value over what a machine file says; of several for one key the last wins.
///
/// A setting is a layer of the machine file like any other, so that a fault in it is shown where it stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// `NAME=VALUE` as a user writes it: a bare name is a parameter, one with dots any key; a value that is no TOML
    /// is text.
    Written(String),
    /// A number for a parameter (bare name) or for any key (with dots), in the unit of the machine file.
    Number {
        /// The parameter or the key.
        name: String,
        /// Value that it gets.
        value: f64,
    },
    /// Where the part origin sits, all axes at zero, machine frame, mm.
    Mount([f64; 3]),
    /// How the part is turned about its Z, degrees, right-handed.
    Turn(f64),
    /// Who keeps the tip on its path.
    Tcp(Tcp),
    /// The dialect, a plugin's name.
    Dialect(String),
    /// Largest deviation of the tip in cuts, mm.
    Tolerance(f64),
    /// CL points that the tolerance makes needless are left out.
    Reduce(bool),
    /// Runs of points become arcs and lines.
    FitArcs(bool),
    /// Where points are put in.
    Placement(Placement),
    /// What is done about a move that strays.
    Method(Method),
    /// The error model, a plugin's name.
    Model(String),
    /// The file of tools, as seen from the folder that the command works in.
    Tools(PathBuf),
}

/// Keys without a table: they are set by their bare names, all other bare names are parameters.
const TOP_LEVEL: [&str; 2] = ["name", "chain"];

impl Setting {
    /// The setting as a line of a machine file.
    ///
    /// # Errors
    /// A setting without a value.
    pub(super) fn line(&self) -> Result<String, Box<Diagnostic>> {
        Ok(match self {
            Self::Written(setting) if setting.contains(is_unprintable) => {
                let message = format!("--set {setting}: one line of what can be read is meant");
                return Err(Diagnostic::error("setting", message)
                    .help("write --set NAME=VALUE")
                    .boxed());
            }
            Self::Written(setting) => match setting.split_once('=') {
                Some((name, value)) => written(name.trim(), value.trim()),
                None => {
                    return Err(Diagnostic::error("setting", format!("--set {setting}: no value"))
                        .help("write --set NAME=VALUE")
                        .boxed());
                }
            },
            Self::Number { name, value } => written(name, &format!("{value:?}")),
            Self::Mount([x, y, z]) => format!("workpiece.mount = [{x:?}, {y:?}, {z:?}]"),
            Self::Turn(turn) => format!("workpiece.turn = {turn:?}"),
            Self::Tcp(tcp) => format!("control.tcp = {:?}", tcp.name()),
            Self::Dialect(dialect) => format!("control.dialect = {dialect:?}"),
            Self::Tolerance(tolerance) => format!("accuracy.tolerance = {tolerance:?}"),
            Self::Reduce(reduce) => format!("accuracy.reduce = {reduce}"),
            Self::FitArcs(fit) => format!("control.arcs.fit = {fit}"),
            Self::Placement(placement) => format!("accuracy.placement = {:?}", placement.name()),
            Self::Method(method) => format!("accuracy.method = {:?}", method.name()),
            Self::Model(model) => format!("accuracy.model = {model:?}"),
            // A text of JSON is one of TOML.
            Self::Tools(file) => format!("tools.file = {}", json!(file.to_string_lossy())),
        })
    }
}

/// `Lm` is a parameter, `accuracy.tolerance` any key; a value that is no TOML is text.
fn written(name: &str, value: &str) -> String {
    let key = if name.contains('.') || TOP_LEVEL.contains(&name) {
        name.to_owned()
    } else {
        format!("parameters.{name}")
    };
    let plain = format!("{key} = {value}");
    if DeTable::parse(&plain).is_ok() { plain } else { format!("{key} = {value:?}") }
}
