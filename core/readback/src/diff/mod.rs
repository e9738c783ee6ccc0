//! Two programs, and what they do differently.
