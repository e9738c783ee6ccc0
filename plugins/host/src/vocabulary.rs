//! A dialect's vocabulary: taken from it word by word, and judged before anybody reads a program by it.

#![allow(unsafe_code)]

use std::borrow::Cow;
use std::ffi::c_void;

use post_plugin::raw::{PostEmitWord, PostText};
use post_plugin::{Meaning, VocabularyWord};

use crate::judge::{MOST_NAME, text};
use crate::shown::{is_odd, quoted};

/// Most words of a vocabulary.
const MOST_WORDS: usize = 1000;

/// What a plugin has told so far, or what is wrong with it.
type TakenVocabulary = Result<Vec<VocabularyWord>, String>;

/// What `ask` returns, and the words that it hands to the function that it is given.
pub(crate) fn taken<R>(ask: impl FnOnce(*mut c_void, PostEmitWord) -> R) -> (R, TakenVocabulary) {
    let mut told: TakenVocabulary = Ok(Vec::new());
    let answer = ask((&raw mut told).cast(), take);
    (answer, told)
}

unsafe extern "C" fn take(host: *mut c_void, meaning: u32, word: *const u8, len: usize) {
    // SAFETY: `host` is what `taken` waits for, and nothing else uses it meanwhile.
    let told = unsafe { &mut *host.cast::<TakenVocabulary>() };
    let Ok(words) = told else { return };
    // SAFETY: the plugin vouches for the word.
    let word = match unsafe { text(PostText { ptr: word, len }, MOST_NAME) } {
        Ok(word) => word,
        Err(lack) => {
            *told = Err(format!("a word of its vocabulary {lack}"));
            return;
        }
    };
    match Meaning::from_number(meaning) {
        // One more than is allowed is enough to refuse it.
        Some(meaning) if words.len() <= MOST_WORDS => {
            words.push(VocabularyWord { word: Cow::Owned(word.to_owned()), meaning })
        }
        Some(_) => {}
        None => {
            *told = Err(format!(
                "its vocabulary has `{}` mean {meaning}, which this version does not know",
                quoted(word)
            ));
        }
    }
}

/// Words that a reader can look for: not empty, of one line, each told once.
pub fn judge(words: Vec<VocabularyWord>) -> TakenVocabulary {
    if words.len() > MOST_WORDS {
        return Err(format!("its vocabulary has more than {MOST_WORDS} words"));
    }
    for (index, VocabularyWord { word, meaning }) in words.iter().enumerate() {
        if word.trim().is_empty() || word.trim() != word {
            return Err(format!(
                "its vocabulary has the word `{}`: a word begins and ends with a letter that is seen",
                quoted(word)
            ));
        }
        if word.len() > MOST_NAME {
            let count = word.len();
            return Err(format!(
                "a word of its vocabulary has {count} bytes, at most {MOST_NAME} are taken"
            ));
        }
        if word.contains(is_odd) {
            return Err(format!(
                "its vocabulary has the word `{}`, which no line can hold",
                quoted(word)
            ));
        }
        let same = |other: &VocabularyWord| other.word == *word && other.meaning == *meaning;
        if words[..index].iter().any(same) {
            return Err(format!(
                "its vocabulary has `{}` mean {} twice",
                quoted(word),
                meaning.name()
            ));
        }
    }
    Ok(words)
}
