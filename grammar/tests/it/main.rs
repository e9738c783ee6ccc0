//! Tests of the readers: CL files, structural codes, expressions, templates.

mod chain;
mod expression;
mod files;
mod nc;
mod reader;
mod statements;
mod template;

use proptest::test_runner::{Config, RngSeed};

/// How many texts are drawn, and which: `POST_ROUNDS` and `POST_SEED` count here too. Without a seed they are others
/// in every run; what fails is printed with the least text that does.
fn cases() -> Config {
    let usual = Config::default();
    Config {
        cases: usual.cases * u32::from(post_testkit::rounds()),
        rng_seed: match post_testkit::seed() {
            0 => usual.rng_seed,
            seed => RngSeed::Fixed(seed),
        },
        ..usual
    }
}
