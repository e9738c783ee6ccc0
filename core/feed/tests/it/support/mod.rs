//! What the tests share.

pub mod jet;
pub mod oracle;
pub mod paths;
pub mod random;
pub mod servo;
