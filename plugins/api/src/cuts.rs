//! A run of cuts: what [`Event::Cuts`] carries.

use crate::field::{Field, FieldReader, FieldShape, NotKnown, Promise, finite};
use crate::flat::Flat;
use crate::{Event, Feed};

/// Columns of numbers one behind the other, all of the same length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns<'a>(pub &'a [f64]);

impl<'a> Field<'a> for Columns<'a> {
    const SHAPE: FieldShape = FieldShape::List;
    // Two cuts with five words.
    const SAMPLE: Self = Columns(&[500.0, 600.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5]);

    #[inline]
    fn put(self, to: &mut Flat) {
        to.numbers(&[self.0.len() as f64]);
        to.numbers(self.0);
    }

    #[inline]
    fn get(from: &mut FieldReader<'a>) -> Result<Self, NotKnown> {
        from.list().map(Columns)
    }

    #[inline]
    fn check(self, _: &Promise) -> Result<(), String> {
        finite(self.0, "a number of its columns")
    }
}

/// The cuts of an [`Event::Cuts`], to be asked for one by one or by columns.
#[derive(Clone, Copy, Debug)]
pub struct CutRun<'a> {
    kind: Feed,
    feeds: &'a [f64],
    words: &'a [f64],
}

impl<'a> CutRun<'a> {
    /// The cuts of these `columns` in a program with so many axis words.
    ///
    /// # Errors
    /// Columns that are not one for the feeds and one for each word, all of the same length: a sentence.
    pub fn new(kind: Feed, columns: Columns<'a>, words: usize) -> Result<Self, String> {
        let count = columns.0.len() / (words + 1);
        if count == 0 || count * (words + 1) != columns.0.len() {
            return Err(format!("{} numbers are not {} columns", columns.0.len(), words + 1));
        }
        let (feeds, words) = columns.0.split_at(count);
        Ok(Self { kind, feeds, words })
    }

    /// Number of cuts, at least one.
    #[inline]
    #[expect(clippy::len_without_is_empty, reason = "there is no run without a cut")]
    pub fn len(&self) -> usize {
        self.feeds.len()
    }

    /// Kind of all feeds, with a number that is one of them.
    #[inline]
    pub fn kind(&self) -> Feed {
        self.kind
    }

    /// Feeds of all cuts.
    #[inline]
    pub fn feeds(&self) -> &'a [f64] {
        self.feeds
    }

    /// Each axis word of all cuts, in the order of [`Setup::words`](crate::Setup::words).
    #[inline]
    pub fn columns(&self) -> std::slice::ChunksExact<'a, f64> {
        self.words.chunks_exact(self.feeds.len())
    }

    /// The columns one after the other.
    pub(crate) fn words(&self) -> &'a [f64] {
        self.words
    }

    /// The words of the last cut.
    pub fn end(&self) -> impl Iterator<Item = f64> + 'a {
        self.columns().filter_map(|column| column.last().copied())
    }

    /// The cut at a place, from 0, as an event of its own; `words` is where its words are put.
    pub fn linear<'b>(&self, place: usize, words: &'b mut Vec<f64>) -> Event<'b> {
        words.clear();
        words.extend(self.columns().map(|column| column[place]));
        Event::linear(words, self.kind.with(self.feeds[place]))
    }

    /// Is it what the host promises to a dialect?
    pub(crate) fn check(&self) -> Result<(), String> {
        if self.feeds.iter().fold(true, |all, feed| all & (*feed > 0.0)) {
            return Ok(());
        }
        match self.feeds.iter().find(|feed| **feed <= 0.0 || feed.is_nan()) {
            Some(feed) => Err(format!("the feed is {feed}")),
            None => Ok(()),
        }
    }
}
