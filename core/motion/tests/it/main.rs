//! How a machine moves along a path.

mod trajectory;
