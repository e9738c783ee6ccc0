//! What a misspelt name was most likely meant to be.

/// Letters beyond this are compared no more: a word of any length may stand in a stranger's file.
const LONGEST: usize = 64;

/// The candidate that `word` was most likely meant to be; none if none is near.
///
/// Near is the same name in other letters (`FANUC`, `dmu-50` for `dmu_50`), one slip for three letters (a letter
/// missing, doubled, wrong or exchanged with its neighbour), or the one name that begins with the word. Of several
/// that are equally near the first is taken, so the answer does not depend on anything but the order given.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters = |text: &str| -> Option<String> {
        let plain = text.chars().map(|letter| match letter {
            '_' | ' ' => '-',
            other => other.to_ascii_lowercase(),
        });
        let plain: String = plain.take(LONGEST + 1).collect();
        (plain.chars().count() <= LONGEST).then_some(plain)
    };
    let word = letters(word).filter(|word| !word.is_empty())?;
    let mut best: Option<(usize, &str)> = None;
    let mut longer = Vec::new();
    for candidate in candidates {
        let Some(plain) = letters(candidate) else {
            continue;
        };
        let slips = strsim::osa_distance(&word, &plain);
        let allowed = word.chars().count().max(plain.chars().count()).max(3) / 3;
        if slips <= allowed && best.is_none_or(|(least, _)| slips < least) {
            best = Some((slips, candidate));
        }
        if plain.starts_with(&word) {
            longer.push(candidate);
        }
    }
    let begun = || match longer.as_slice() {
        [only] => Some(*only),
        _ => None,
    };
    best.map(|(_, candidate)| candidate).or_else(begun)
}

/// `did you mean `b`? known are a, b`, or without the question where nothing is near.
pub fn meant(word: &str, known: &str, names: &[&str]) -> String {
    let all = format!("{known} {}", names.join(", "));
    match nearest(word, names.iter().copied()) {
        Some(name) => format!("did you mean `{name}`? {all}"),
        None => all,
    }
}
