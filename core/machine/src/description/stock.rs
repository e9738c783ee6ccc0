//! The raw part: `[workpiece] stock`.

use toml::Spanned;

use super::build::Builder;
use super::quantity::KeyedNumber;
use super::table::keys;

keys! {
    /// The raw part: a box.
    StockFile {
        /// Least X, Y and Z, mm, part frame.
        min: [KeyedNumber; 3],
        /// Largest X, Y and Z, mm, part frame.
        max: [KeyedNumber; 3],
    }
}

impl Builder<'_> {
    /// The corners of the raw part, least first, mm.
    pub(super) fn stock(&mut self, stock: &Spanned<StockFile>) -> Option<[[f64; 3]; 2]> {
        let corners = [&stock.get_ref().min, &stock.get_ref().max];
        let corners: [[f64; 3]; 2] = corners.map(|corner| self.vector(corner).into());
        let flat = (0..3).any(|axis| corners[0][axis] >= corners[1][axis]);
        if flat {
            let message = "the stock has no room between its corners".to_owned();
            self.fault("machine-stock", stock.span(), message, "max is above min in X, Y and Z");
        }
        (!flat).then_some(corners)
    }
}
