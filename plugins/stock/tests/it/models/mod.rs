//! What each error model says of deviations whose peak is known.

mod harmonic;
mod parabolic;
mod sampled;
