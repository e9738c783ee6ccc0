//! Which word of a control switches what.

use post_grammar::nc::NcSyntax;
use post_plugin::VocabularyWord;

/// The words of a control, ready to be looked up.
#[derive(Clone, Debug, Default)]
pub struct Lexicon {
    syntax: NcSyntax,
}

impl Lexicon {
    /// From what a dialect hands over.
    pub fn new(words: &[VocabularyWord]) -> Self {
        todo!("{words:?}")
    }

    /// What the reader of its programs must know.
    pub fn syntax(&self) -> &NcSyntax {
        &self.syntax
    }
}
