//! What both grammars' builders do with pairs.

use pest::RuleType;
use pest::iterators::Pair;

use super::fault::Unreadable;

/// The next part of a rule that has one.
pub(super) fn due<'t, R: RuleType>(
    parts: &mut impl Iterator<Item = Pair<'t, R>>,
) -> Result<Pair<'t, R>, Unreadable> {
    parts.next().ok_or_else(|| Unreadable::new("something is missing here"))
}

/// The one thing that a rule holds; itself where it holds nothing.
pub(super) fn only<R: RuleType>(pair: Pair<'_, R>) -> Pair<'_, R> {
    pair.clone().into_inner().next().unwrap_or(pair)
}
