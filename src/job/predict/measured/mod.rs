//! A recorded log of a machine, and what is left between it and the prediction.

mod columns;
mod fitting;
mod log;
mod overlay;
mod report;
mod text;

pub use columns::{ColumnNames, LogUnits, column_names, log_units};
pub use fitting::{AxisFitted, fitted};
pub use log::{Log, LogForm};
pub use overlay::Overlay;
pub use report::MeasuredFound;
pub use text::{fitted_text, text};
