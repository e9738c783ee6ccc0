//! What a machine file may say: its keys and their types. Meaning is settled in [`super::build`].

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

/// A number, or an expression of the file's parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Number {
    Value(f64),
    Expression(String),
}

/// A number or expression and where it stands.
pub(crate) type Quantity = Spanned<Number>;

/// The whole file, `[control.<dialect>]` and `[accuracy.<model>]` apart.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MachineFile {
    pub name: Spanned<String>,
    pub chain: Spanned<String>,
    #[serde(default)]
    pub parameters: BTreeMap<String, Quantity>,
    #[serde(default)]
    pub workpiece: WorkpieceFile,
    pub tool: ToolFile,
    #[serde(default)]
    pub tools: BTreeMap<String, Quantity>,
    pub axis: BTreeMap<String, Spanned<AxisFile>>,
    pub control: Spanned<ControlFile>,
    #[serde(default)]
    pub accuracy: AccuracyFile,
    #[serde(default)]
    pub solution: SolutionFile,
    pub rewind: Option<Spanned<RewindFile>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WorkpieceFile {
    pub mount: Option<[Quantity; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolFile {
    pub gauge: [Quantity; 3],
    pub axis: Option<[Quantity; 3]>,
    pub edge: Option<[Quantity; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisFile {
    pub linear: Option<[Quantity; 3]>,
    pub rotary: Option<[Quantity; 3]>,
    pub point: Option<[Quantity; 3]>,
    pub travel: Option<Spanned<[Quantity; 2]>>,
    #[serde(default)]
    pub cyclic: bool,
    #[serde(default)]
    pub reversed: bool,
    pub zero: Option<Quantity>,
    pub range: Option<Spanned<[Quantity; 2]>>,
    pub indexed: Option<Quantity>,
    pub positions: Option<Spanned<Vec<Quantity>>>,
    pub step: Option<Quantity>,
    pub clamp: Option<Spanned<String>>,
    pub unclamp: Option<Spanned<String>>,
    pub share: Option<Quantity>,
    pub reserve: Option<Spanned<bool>>,
    pub max_feed: Option<Quantity>,
    pub max_accel: Option<Quantity>,
    pub max_jerk: Option<Quantity>,
}

/// `[solution]`: which of several solutions is taken.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SolutionFile {
    pub rule: Option<Spanned<String>>,
    #[serde(default)]
    pub prefer: BTreeMap<Spanned<String>, Side>,
    #[serde(default)]
    pub require: BTreeMap<Spanned<String>, Side>,
    #[serde(default)]
    pub start: BTreeMap<Spanned<String>, Quantity>,
    #[serde(default)]
    pub exclusive: Vec<Vec<Spanned<String>>>,
    pub look_ahead: Option<Spanned<u32>>,
    #[serde(default)]
    pub pole: Pole,
    #[serde(default)]
    pub edge: EdgeSource,
    pub corner: Option<Quantity>,
}

/// `[rewind]`: how the tool leaves the part when a cut cannot go on.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RewindFile {
    pub distance: Option<Quantity>,
    pub plane: Option<Quantity>,
    pub retract_feed: Option<Quantity>,
    pub turn_feed: Option<Quantity>,
    pub plunge_feed: Option<Quantity>,
}

/// A side of zero.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Zero and above.
    Positive,
    /// Zero and below.
    Negative,
}

/// What is done close to a singular direction.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Pole {
    /// The axis that turns the tool by nearly nothing is held, turned early or turned evenly, within
    /// `axis_tolerance`.
    #[default]
    Blend,
    /// Every point of the CL file is met exactly, whatever the axes must do for it.
    Exact,
}

/// Where a leading edge (knife, disc) points.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeSource {
    /// Along the direction of travel.
    #[default]
    Travel,
    /// Along the second vector of the CL points.
    Cl,
}

/// Who keeps the tip on its path.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Tcp {
    /// The control: linear words are the tip, rotary words the axes.
    Control,
    /// The post: all words are axis positions.
    #[default]
    Post,
}

/// How a cutting feed is written.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum FeedMode {
    /// Inverse time where rotary axes move and the control does not keep the tip, if the dialect has it; else per minute.
    #[default]
    Auto,
    /// Always per minute (G94).
    PerMinute,
    /// Always inverse time (G93).
    InverseTime,
}

/// The length that a control's feed a minute is meant along when it does not keep the tip.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum FeedLength {
    /// The linear axes alone; the rotary ones, in degrees, where no linear axis moves.
    #[default]
    Linear,
    /// Root of the sum of squares over all axes, mm and degrees alike.
    Combined,
    /// The longest axis travel, mm and degrees alike.
    Longest,
}

/// Which of the lengths that the CL file knows is the tool length.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ToolLength {
    /// `--tool-length`, the `[tools]` table, `LOADTL/…,LENGTH`.
    #[default]
    Assembly,
    /// After those, the length in `TLDATA` or `CUTTER` too.
    Cl,
}

/// What becomes of `INSERT text`.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Insert {
    /// A comment: SolidWorks CAM describes stock and tools with it, and `X85. Y38.` would be a move.
    #[default]
    Comment,
    /// A line of the program, letter for letter, as APT has it.
    Literal,
}

/// Units of the NC program.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum OutputUnits {
    /// mm, mm/min.
    #[default]
    Mm,
    /// inch, inch/min.
    Inch,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ControlFile {
    pub dialect: Spanned<String>,
    pub tcp: Option<Tcp>,
    #[serde(default)]
    pub units: OutputUnits,
    #[serde(default)]
    pub feed: FeedMode,
    #[serde(default)]
    pub feed_length: FeedLength,
    #[serde(default)]
    pub tool_length: ToolLength,
    #[serde(default)]
    pub insert: Insert,
}

/// Where points are put in.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// In the middle of every piece that is over.
    #[default]
    Bisect,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AccuracyFile {
    pub model: Option<Spanned<String>>,
    #[serde(default)]
    pub placement: Placement,
    pub tolerance: Option<Quantity>,
    pub axis_tolerance: Option<Quantity>,
    pub rapid_tolerance: Option<Quantity>,
    pub reduce: Option<Spanned<bool>>,
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a number, or an expression of parameters in quotes")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
                Ok(Number::Value(value))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
                Ok(Number::Value(value as f64))
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Number, E> {
                Ok(Number::Expression(text.to_owned()))
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}
