//! Smooth curves through points: `post_feed::fit`.

mod anything;
mod course;
mod programs;
mod shapes;
mod streams;
