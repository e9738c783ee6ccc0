//! Arguments of a verb that are made when the verb is asked for: a command line has one verb, and there are twenty.

use clap::{ArgMatches, Args, Command, FromArgMatches, Id};

/// Arguments of a verb that clap makes as late as the command line names it if they are `LATE`, with all others else:
/// help, completions and faults tell of every verb.
#[derive(Debug)]
pub struct Late<T, const LATE: bool>(pub T);

impl<T: Args, const LATE: bool> Args for Late<T, LATE> {
    fn group_id() -> Option<Id> {
        T::group_id()
    }

    fn augment_args(command: Command) -> Command {
        if LATE { command.defer(T::augment_args) } else { T::augment_args(command) }
    }

    fn augment_args_for_update(command: Command) -> Command {
        T::augment_args_for_update(command)
    }
}

impl<T: FromArgMatches, const LATE: bool> FromArgMatches for Late<T, LATE> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        T::from_arg_matches(matches).map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        self.0.update_from_arg_matches(matches)
    }
}
