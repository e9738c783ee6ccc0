//! Coolant, each kind with what ends it.

use post_plugin::Coolant;

use crate::Heidenhain;

impl Heidenhain {
    /// What ends the coolant that is on; that of all, if it has no end of its own or is not known.
    pub(crate) fn end_coolant(&mut self, out: &mut String) {
        let flowing = self.flowing.take();
        let own = self.coolant_ends.iter().find(|(coolant, _)| Some(*coolant) == flowing);
        let own = own.map_or("", |(_, codes)| codes);
        for code in own.split_whitespace() {
            self.block.line(code, out);
        }
        if own.is_empty() {
            self.coolant_codes(Coolant::Off, out);
        }
        self.coolant_on.set(false);
    }

    /// The M codes of a coolant; false if it has none.
    pub(crate) fn coolant_codes(&mut self, wanted: Coolant, out: &mut String) -> bool {
        let codes = self.coolant.iter().find(|(coolant, _)| *coolant == wanted);
        let codes = codes.map_or("", |(_, codes)| codes);
        for code in codes.split_whitespace() {
            self.block.line(code, out);
        }
        !codes.is_empty()
    }

    pub(crate) fn cool(&mut self, wanted: Coolant, out: &mut String) -> Result<(), String> {
        if wanted == Coolant::Off {
            self.end_coolant(out);
            return Ok(());
        }
        if self.flowing.is_some_and(|flowing| flowing != wanted) {
            // One coolant takes the place of another.
            self.end_coolant(out);
        }
        if !self.coolant_codes(wanted, out) {
            let name = format!("{wanted:?}").to_lowercase();
            return Err(format!(
                "the M code of the coolant `{name}` is the machine builder's: set the option \
                 `coolant_{name}`"
            ));
        }
        self.coolant_on.set(true);
        self.flowing = Some(wanted);
        Ok(())
    }
}
