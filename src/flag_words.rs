//! Words of flags that several verbs take, and what they mean.

use clap::ValueEnum;
use post_machine::description::{OutputUnits, Tcp};

/// `--units` of a machine.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum UnitsWord {
    Mm,
    Inch,
}

/// `--tcp`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TcpWord {
    Control,
    Post,
}

impl From<UnitsWord> for OutputUnits {
    fn from(word: UnitsWord) -> Self {
        match word {
            UnitsWord::Mm => Self::Mm,
            UnitsWord::Inch => Self::Inch,
        }
    }
}

impl From<TcpWord> for Tcp {
    fn from(word: TcpWord) -> Self {
        match word {
            TcpWord::Control => Self::Control,
            TcpWord::Post => Self::Post,
        }
    }
}
