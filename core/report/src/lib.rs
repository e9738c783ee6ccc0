//! The report of a run: one HTML file that a browser shows from the disk, without a network.
//!
//! | part | what it is |
//! |---|---|
//! | [`table::TableWriter`] | rows of numbers, at print resolution: columns of integers, differences, byte planes, deflate |
//! | [`text::TextWriter`] | a text, line for line and without loss: templates of lines and columns of their numbers |
//! | [`solid::DrawnSolid`] | the shape of a body of the machine, from an STL file that is handed in: few triangles and sharp edges |
//! | [`meta::Meta`] | what the page tells besides: verdict, maxima, facts, events, the machine |
//! | [`document::write`] | the page, its scripts, and the parts packed into it |
//!
//! What never happens here: no file is read or written (sinks are handed in), no clock is asked, and memory does not grow
//! with the rows: every part is packed in chunks that go to their sink at once. The same rows give the same bytes.
//!
//! The page itself is hand-written (`page/`): `order.txt` names its scripts in their order.

mod base64;
mod deflate;
pub mod document;
mod integers;
pub mod meta;
mod page;
mod part;
mod sha256;
pub mod solid;
pub mod table;
mod template;
pub mod text;
