//! What the events of a batch hold, laid end to end.

/// Numbers and texts of all events, one after the other.
#[derive(Debug, Default)]
pub(crate) struct Flat {
    pub(crate) numbers: Vec<f64>,
    /// Where each text ends in `text`.
    pub(crate) texts: Vec<u32>,
    pub(crate) text: String,
}

impl Flat {
    #[inline]
    pub(crate) fn numbers(&mut self, numbers: &[f64]) {
        self.numbers.extend_from_slice(numbers);
    }

    pub(crate) fn text(&mut self, text: &str) {
        self.text.push_str(text);
        self.texts.push(self.text.len() as u32);
    }
}
