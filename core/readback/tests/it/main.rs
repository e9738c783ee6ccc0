//! Tests of reading back on hand-made programs and courses.

mod course;
mod interpret;
mod robust;
mod verify;
