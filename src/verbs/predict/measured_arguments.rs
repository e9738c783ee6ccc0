//! `--measured`: the log that is laid over a prediction.

use clap::Args;

use post_cli::arguments::flag_values::file;
use post_cli::arguments::flag_values::positive;
use post_job::files::PathArg;
use post_job::predict::MeasuredRequest;
use post_job::predict::measured::{
    ColumnNames, LogForm, LogUnits, LogZeros, column_names, log_units, log_zeros,
};

/// A recorded log, and how it is written.
#[derive(Debug, Args)]
#[command(next_help_heading = "Measured")]
pub struct MeasuredArguments {
    /// A log that was recorded while the program ran: a table with the time and the commanded and actual positions of the
    /// axes; commas, semicolons, tabs or blanks between its columns. It is laid over the prediction (its clock and its zeros
    /// are found), and what is left is told: commanded and actual positions, following errors, contour error.
    #[arg(long, value_name = "FILE", value_parser = file())]
    measured: Option<PathArg>,

    /// Which column holds what, by name or by number from 1: "t=time,X=cmd_x,X'=act_x" is the time, X commanded and X
    /// actual. Without it the names in the log's head say so: time, t_ms; X, X_cmd, commanded_X; X', X_act, X_actual.
    #[arg(long, value_name = "LIST", value_parser = column_names, requires = "measured")]
    columns: Option<ColumnNames>,

    /// Units of the log, where its head does not say them, as X (mm), t_ms or a line of units below the names do, and they
    /// are not s, mm, deg: s, ms or us; mm, um, m or inch; deg or rad.
    #[arg(long, value_name = "LIST", value_parser = log_units, requires = "measured")]
    log_units: Option<LogUnits>,

    /// Time from row to row, seconds, of a log without times, or whose times are not to be read.
    #[arg(long, value_name = "SECONDS", value_parser = positive, requires = "measured")]
    log_period: Option<f64>,

    /// What the log counts more than the program, axis by axis in mm and degrees: "X=250,C=-90", or "none" where it counts as
    /// the machine file does. Of axes that are not named it is found, told and taken off.
    #[arg(long, value_name = "LIST", value_parser = log_zeros, requires = "measured")]
    log_zeros: Option<LogZeros>,

    /// Adjusts these numbers of the servos (X.kv,X.velocity_gain) to the log by least squares, axis by axis, and says how
    /// well each is determined; the machine file is not changed.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "measured")]
    fit: Vec<String>,
}

impl MeasuredArguments {
    /// The log that is laid over the prediction, if one is.
    pub fn request(&self) -> Option<MeasuredRequest> {
        Some(MeasuredRequest {
            log: self.measured.clone()?,
            form: LogForm {
                columns: self.columns.clone(),
                units: self.log_units.unwrap_or_default(),
                period: self.log_period,
            },
            zeros: self.log_zeros.clone().unwrap_or_default(),
            fit: self.fit.clone(),
        })
    }
}
