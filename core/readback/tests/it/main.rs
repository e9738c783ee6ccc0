//! Tests of reading back on hand-made programs and courses.

mod interpret;
mod verify;
