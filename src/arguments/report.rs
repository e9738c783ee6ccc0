//! `--report`: what a run came to, as a page to look at.

use clap::Args;

use crate::files::PathArg;

#[derive(Clone, Debug, Args)]
pub struct ReportArguments {
    /// Writes what came of it as a page to look at: one HTML file that any browser of today shows from the disk and that
    /// loads nothing: verdict, path and machine in 3D, charts, program and CL file side by side.
    #[arg(long, value_name = "FILE", value_parser = PathArg::parser())]
    pub report: Option<PathArg>,

    /// Largest size of the report, MB: above it the texts of the programs are left out first, then further parts, and the
    /// page says so.
    #[arg(long, value_name = "MB", default_value_t = 64, requires = "report", value_parser = clap::value_parser!(u64).range(1..))]
    pub report_max: u64,
}

impl ReportArguments {
    /// Largest size, bytes.
    pub fn most(&self) -> u64 {
        self.report_max.saturating_mul(1_000_000)
    }
}
