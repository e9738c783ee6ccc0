//! `post place`: where a part can sit on a machine.

mod place_text;
mod travel_picture;

use clap::{Args, ValueEnum};

use post_cli::arguments::flag_values::file;
use post_cli::arguments::flag_values::{not_negative, positive, word};
use post_cli::arguments::{Flags, JobArguments};
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::{self, PathArg, Role};
use post_job::place::{Least, PlaceRequest, place};
use post_job::session::Session;
use post_job::settings::ThreadSettings;

/// Finds where to put the part: the mount that keeps every axis inside travel, and of those the fastest.
///
/// Every mount that is named was posted in a dry run with all that posting checks: travel (between the words too),
/// rapids, retracts; on a machine with a fixture or a stock it is proven that nothing hits anything there. The answer is printed as --mount X,Y,Z, and with --search-turn as --turn DEG, with what is left of
/// each axis. The time is a minimum among the mounts that were tried, not over all there are.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post place part.cls --machine ac-trunnion
  post place part.cls --machine dmu50 --tool-length 120 --margin 10 --svg travel.svg
  post place part.cls --machine my-mill.toml --search-turn=30 --least rotary

Exit codes: 0 a mount is printed; 1 none fits, the messages say which axis is short by how much; 2 the command line is wrong.")]
pub struct PlaceArguments {
    #[command(flatten)]
    job: JobArguments,

    /// What to minimise, once every axis stays inside travel: cycle time, or the total turn of the rotary axes.
    #[arg(long, value_parser = word::<LeastWord, Least>(), default_value = "time", value_name = "WHAT")]
    least: Least,

    /// Distance that every linear axis keeps from the ends of its travel, mm.
    #[arg(long, value_name = "MM", default_value_t = 1.0, allow_hyphen_values = true, value_parser = not_negative)]
    margin: f64,

    /// Searches the turn of the part about its Z too, all the way round by steps of so many degrees, and more closely
    /// about the best of them.
    #[arg(long, value_name = "DEG", num_args = 0..=1, require_equals = true, default_missing_value = "15", value_parser = step)]
    search_turn: Option<f64>,

    /// Largest number of dry runs; at least three.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(3..))]
    runs: u32,

    /// Draws the travel of each axis, what the program uses and what is left; `-` is standard output,
    /// alone there.
    #[arg(long, value_name = "FILE", value_parser = file())]
    svg: Option<PathArg>,

    #[command(flatten)]
    threads: Flags<ThreadSettings>,
}

/// `--least`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum LeastWord {
    Time,
    Rotary,
}

impl From<LeastWord> for Least {
    fn from(word: LeastWord) -> Self {
        match word {
            LeastWord::Time => Self::Time,
            LeastWord::Rotary => Self::Rotary,
        }
    }
}

/// Degrees from turn to turn.
fn step(text: &str) -> Result<f64, String> {
    match positive(text)? {
        step if (1.0..=180.0).contains(&step) => Ok(step),
        _ => Err("steps from 1 to 180 degrees are meant".to_owned()),
    }
}

/// Places as the arguments say.
pub fn run(session: &Session, arguments: &PlaceArguments) -> Result<(), Failure> {
    let job = &arguments.job.settings();
    let request = PlaceRequest {
        least: arguments.least,
        margin: arguments.margin,
        search_turn: arguments.search_turn,
        runs: arguments.runs,
        threads: arguments.threads.0.most(),
    };
    let found = place(session, job, &request)?;
    let mut taken = false;
    if let Some(target) = &arguments.svg {
        taken = files::write(session, &[(Role::PICTURE, target, &travel_picture::draw(&found))])?;
    }
    session.findings(&found.best.findings);
    let text = place_text::text(arguments, &found);
    // Standard output is for the picture, alone there.
    terminal::print_beside(session, &text, taken);
    Ok(())
}
