//! What a machine file may hold: beyond these it is a slip, or the file means harm.
//!
//! A file may come from a stranger. No part of it makes work or memory that grows faster than its text, and its text has an
//! end.

/// Longest machine file, in bytes, settings and what it extends each for itself. The largest of the library has 4 kB.
pub const MOST_BYTES: usize = 1 << 20;

/// A number, in the file's units. Larger ones say "without end", which has words of its own; their squares stay finite.
pub(super) const MOST_NUMBER: f64 = 1e12;

/// Parameters. One may be defined by all others, one behind another.
pub(super) const MOST_PARAMETERS: usize = 1_000;

/// Heads: each is a machine of its own.
pub(super) const MOST_HEADS: usize = 32;

/// Entries of `[tools]`, of `[cl.words]`, and positions of an indexed axis: they are gone through one by one.
pub(super) const MOST_ENTRIES: usize = 2_000;

/// Fixtures: each is held against all else that moves.
pub(super) const MOST_BODIES: usize = 100;

/// Options of one plugin.
pub(super) const MOST_OPTIONS: usize = 200;

/// Limits that depend on other axes: each is held on every way.
pub(super) const MOST_AXIS_LIMITS: usize = 32;

/// Places at which the errors of an axis were measured.
pub(super) const MOST_ERROR_ROWS: usize = 10_000;

/// Legs: each is held on every way.
pub(super) const MOST_LEGS: usize = 12;

/// Formulas of axes: each drive works out those that it is written with.
pub(super) const MOST_FORMULAS: usize = 64;

/// Groups of axes that exclude one another.
pub(super) const MOST_GROUPS: usize = 32;

/// Ways to set all rotary axes on other full turns inside their travels: each is weighed at each point. An axis that is wound
/// up over a cut takes one for each turn.
pub(super) const MOST_TURNS: f64 = 1_000.0;

/// Faults of a file that are told.
pub(super) const MOST_FAULTS: usize = 50;

/// Number of a head's work offset: no control has as many.
pub(super) const MOST_OFFSETS: u32 = 999;
