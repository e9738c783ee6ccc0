//! Cycles of languages as strokes of a hole.

#[path = "../../../../src/interpret/cycles/conversational.rs"]
mod conversational;
#[path = "../../../../src/interpret/cycles/hole.rs"]
mod hole;
#[path = "../../../../src/interpret/cycles/names.rs"]
mod names;
