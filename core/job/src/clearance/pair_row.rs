//! A row of the table of pairs.

use post_clearance::proof::Fault;

/// What is known of a pair of bodies along the program.
#[derive(Clone, Debug)]
pub struct PairRow {
    /// Their names.
    pub names: [String; 2],
    /// They are never nearer, mm, on motions that are proven to be clear; infinite where there is none.
    pub clear_by: f64,
    /// The nearest that was found, mm, and the line.
    pub nearest: (f64, u64),
    /// Motions on which they are not clear.
    pub faults: u64,
    /// The first place where they are not.
    pub fault: Option<Fault>,
    /// The worst.
    pub worst: Option<Fault>,
}

impl PairRow {
    /// A pair of which nothing is known yet.
    pub(super) fn new(names: [String; 2]) -> Self {
        let nearest = (f64::INFINITY, 0);
        Self { names, clear_by: f64::INFINITY, nearest, faults: 0, fault: None, worst: None }
    }

    /// They are a stock and what cuts it.
    pub(crate) fn is_cut(&self) -> bool {
        let begin = |names: [&str; 2]| {
            self.names.iter().zip(names).all(|(name, begins)| name.starts_with(begins))
        };
        begin(["stock", "cutter "]) || begin(["cutter ", "stock"])
    }
}
