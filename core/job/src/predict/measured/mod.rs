//! A recorded log of a machine, and what is left between it and the prediction.

mod aligned;
mod clock;
mod coarse;
mod columns;
mod compare;
mod fitting;
mod log;
mod logged_path;
mod overlay;
mod report;
mod rows;
mod table;
mod text;
mod units;
mod zeros;

pub use columns::{ColumnNames, column_names};
pub use fitting::{AxisFitted, fitted};
pub use log::{Log, LogForm};
pub use logged_path::MeasuredPoint;
pub use overlay::Overlay;
pub use report::MeasuredFound;
pub use text::{fitted_text, text};
pub use units::{LogUnits, log_units};
pub use zeros::{LogZeros, log_zeros};
