//! Layers of a machine file: what it extends, the file itself, and the settings of one run.
//!
//! Every layer is TOML. Later layers win, key by key. Spans are offsets into all layers laid end to end,
//! so that a finding in the merged table still points into the file it came from.

use std::cell::OnceCell;
use std::ops::Range;

use post_grammar::text::is_unprintable;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::file::MachineFile;
use super::keys::TAKEN_OUT;
use super::limits::{MOST_BYTES, MOST_FAULTS};
use super::setting::Setting;
use crate::diagnostic::{Diagnostic, SourcePlace, meant};

/// A text and the name that the user knows it by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// File name, or `--set`.
    pub name: String,
    /// Text of the file.
    pub text: String,
}

/// All layers as one table, and what could not be read of them.
pub(crate) struct Merged<'s> {
    /// What could be read.
    pub(crate) table: Spanned<DeTable<'s>>,
    /// What could not.
    pub(crate) faults: Vec<Diagnostic>,
}

/// A text without the lines that no TOML can hold.
#[derive(Debug)]
struct Readable {
    /// The text, blanks in the place of those lines.
    text: String,
    /// What is wrong with them, and where.
    faults: Vec<(Option<Range<usize>>, String)>,
    /// What follows a line cannot be told from its echo.
    lost: bool,
}

/// Lines that cannot be read of one text that are told.
const MOST_UNREADABLE: usize = 10;

impl Readable {
    /// Reading ends at its first fault: the line is taken out, and the rest read again.
    fn of(text: &str) -> Self {
        let mut readable = Self { text: text.to_owned(), faults: Vec::new(), lost: false };
        let mut last: Option<Range<usize>> = None;
        while readable.faults.len() < MOST_UNREADABLE {
            let (_, faults) = DeTable::parse_recoverable(&readable.text);
            let Some(fault) = faults.first() else {
                return readable;
            };
            let Some(span) = fault.span().filter(|span| span.start < text.len()) else {
                if last.is_none() {
                    readable.faults.push((fault.span(), fault.message().to_owned()));
                }
                break;
            };
            let begin = text[..span.start].rfind('\n').map_or(0, |at| at + 1);
            let end = text[span.start..].find('\n').map_or(text.len(), |at| span.start + at);
            // A bracket that nothing closes spoils line after line.
            let echo = last.is_some_and(|last| {
                begin < last.end || text[last.end..begin].trim_ascii().is_empty()
            });
            if echo {
                break;
            }
            readable.faults.push((Some(span), fault.message().to_owned()));
            // Under which table the following keys stand is not known.
            if is_header(&text[begin..end]) {
                break;
            }
            let blanks = " ".repeat(end - begin);
            readable.text.replace_range(begin..end, &blanks);
            last = Some(begin..end);
        }
        readable.lost = true;
        readable
    }
}

/// The text of a machine file with blanks in the place of lines that no TOML can hold: a line that is being written does not
/// take the rest away.
pub fn readable(text: &str) -> String {
    Readable::of(text).text
}

/// The line begins a table.
fn is_header(line: &str) -> bool {
    line.trim_ascii_start().starts_with('[')
}

/// A file that extends another may do so over so many steps.
const DEPTH: usize = 8;

/// What a setting of one run is called in place of a file.
pub(super) const SETTING: &str = "--set";

/// All texts of a machine: the file, what it extends, and the settings, in that order.
#[derive(Debug)]
pub(crate) struct MachineSources {
    sources: Vec<(usize, Source)>,
    /// What can be read of each source that is no TOML as it is.
    readable: Vec<OnceCell<Readable>>,
    /// Starts of the lines of each source: a finding is placed without a walk through the text.
    lines: Vec<Vec<usize>>,
    /// Number of sources that are files; the rest are settings.
    files: usize,
    /// The machine that the last file extends is not there.
    orphan: Option<Diagnostic>,
}

impl MachineSources {
    /// Collects the file, what it extends (found by `find`), and `settings`.
    ///
    /// # Errors
    /// A file that is not found or extends itself, a setting without a value.
    pub(crate) fn collect(
        source: Source,
        settings: &[Setting],
        find: &mut dyn FnMut(&str) -> Result<Source, String>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let mut all = Self {
            sources: Vec::new(),
            readable: Vec::new(),
            lines: Vec::new(),
            files: 1,
            orphan: None,
        };
        all.push(source)?;
        while let Some(name) = all.extends() {
            let place = all.place(name.span());
            if all.files > DEPTH {
                let message = format!(
                    "more than {DEPTH} machines extend one another: do they go in a circle?"
                );
                return Err(vec![Diagnostic::error("machine-extends", message).at(place)]);
            }
            // A stranger's file may name any file of the user's: nothing of what is no machine is shown.
            let parent = find(name.get_ref()).and_then(|parent| match is_machine(&parent.text) {
                true => Ok(parent),
                false => Err(format!("{} is no machine file", parent.name)),
            });
            match parent {
                Ok(parent) => all.push(parent)?,
                Err(message) => {
                    all.orphan = Some(Diagnostic::error("machine-extends", message).at(place));
                    break;
                }
            }
            all.files += 1;
        }
        for setting in settings {
            all.push(Source {
                name: SETTING.to_owned(),
                text: setting.line().map_err(|fault| vec![*fault])?,
            })?;
        }
        Ok(all)
    }

    fn push(&mut self, source: Source) -> Result<(), Vec<Diagnostic>> {
        if source.text.len() > MOST_BYTES {
            let message = format!(
                "{} holds {} bytes; a machine file has at most {MOST_BYTES}",
                source.name,
                source.text.len()
            );
            return Err(vec![Diagnostic::error("machine", message)]);
        }
        // One more, so that a span at the very end of a text is not taken for the next one's start.
        let start = self.sources.last().map_or(0, |(start, last)| start + last.text.len() + 1);
        let ends = source.text.match_indices('\n').map(|(end, _)| end + 1);
        self.readable.push(OnceCell::new());
        self.lines.push(std::iter::once(0).chain(ends).collect());
        self.sources.push((start, source));
        Ok(())
    }

    /// What the last file extends; a file with syntax errors extends nothing here and is refused later.
    fn extends(&self) -> Option<Spanned<String>> {
        let (start, source) = self.sources.last()?;
        // Most files extend none, and need not be read for that. A key may be written by escapes.
        if !source.text.contains("extends") && !source.text.contains('\\') {
            return None;
        }
        let table = DeTable::parse(&source.text).ok()?.into_inner();
        let value = table.get("extends")?;
        let name = value.get_ref().as_str()?.to_owned();
        Some(Spanned::new(shifted(value.span(), *start), name))
    }

    /// The merged table of what can be read, and beside it what cannot: all syntax errors of all layers, a machine that is
    /// not there, settings of parameters that do not exist.
    ///
    /// # Errors
    /// The same, where so little can be read that nothing is known of the rest.
    pub(crate) fn merge(&self) -> Result<Merged<'_>, Vec<Diagnostic>> {
        let mut errors: Vec<Diagnostic> = self.orphan.iter().cloned().collect();
        let mut merged = DeTable::new();
        let mut lost = false;
        let layers = (0..self.files).rev().chain(self.files..self.sources.len());
        for index in layers {
            let (start, source) = &self.sources[index];
            let start = *start;
            let (mut table, faults) = DeTable::parse_recoverable(&source.text);
            if !faults.is_empty() {
                let readable = self.readable[index].get_or_init(|| Readable::of(&source.text));
                lost |= readable.lost;
                errors.extend(readable.faults.iter().map(|(span, message)| {
                    let place = span.clone().and_then(|span| self.place(shifted(span, start)));
                    Diagnostic::error("machine-syntax", message).at(place)
                }));
                (table, _) = DeTable::parse_recoverable(&readable.text);
            }
            let layer = match start {
                0 => table.into_inner(),
                _ => moved_table(table.into_inner(), start),
            };
            self.check_texts(&layer, &mut errors);
            let is_setting = index >= self.files;
            if is_setting && let Err(error) = check_parameters(&layer, &merged) {
                errors.push(*error);
            }
            overlay(&mut merged, layer);
        }
        merged.remove("extends");
        if lost {
            return Err(errors);
        }
        Ok(Merged { table: Spanned::new(0..0, merged), faults: errors })
    }

    /// The file of a finding, and number and text of the header that it stands under; 0 above all tables.
    pub(crate) fn table_of(&self, finding: &Diagnostic) -> Option<(&str, u64, &str)> {
        let place = finding.place.as_ref()?;
        let files = &self.sources[..self.files];
        let (_, source) = files.iter().find(|(_, file)| file.name == place.file)?;
        let lines = source.text.lines().take(usize::try_from(place.line).ok()?);
        let header = lines.zip(1..).filter(|(line, _)| is_header(line)).last();
        let (text, number) = header.unwrap_or_default();
        Some((&source.name, number, text))
    }

    /// The name of the table that a finding stands in: `axis.C`, by the header above it or in the key of a setting; none
    /// above all tables.
    pub(crate) fn table_name<'f>(&'f self, finding: &'f Diagnostic) -> Option<&'f str> {
        if let Some((_, _, header)) = self.table_of(finding) {
            let name = header.trim().strip_prefix('[')?.split_once(']')?.0.trim();
            return Some(name).filter(|name| !name.is_empty() && !name.starts_with('['));
        }
        let (key, _) = finding.place.as_ref()?.text.split_once('=')?;
        Some(key.trim().rsplit_once('.')?.0)
    }

    /// The file that a span stands in, and where there; none in a setting.
    pub(crate) fn local(&self, span: Range<usize>) -> Option<(&str, Range<usize>)> {
        let files = &self.sources[..self.files];
        let index = files.iter().rposition(|(start, _)| *start <= span.start)?;
        let (start, source) = &files[index];
        let end = span.end.checked_sub(*start)?;
        (end <= source.text.len()).then(|| (source.name.as_str(), span.start - start..end))
    }

    /// The line that a span begins in.
    pub(crate) fn place(&self, span: Range<usize>) -> Option<SourcePlace> {
        let index = self.sources.iter().rposition(|(start, _)| *start <= span.start)?;
        let (start, source) = &self.sources[index];
        let text = &source.text;
        let at = (span.start - start).min(text.len());
        let number = self.lines[index].partition_point(|begin| *begin <= at);
        let begin = self.lines[index][number - 1];
        let end = self.lines[index].get(number).map_or(text.len(), |next| next - 1);
        let line = text[begin..end].trim_end_matches('\r');
        let from = (at - begin).min(line.len());
        let to = span.end.saturating_sub(start + begin).clamp(from, line.len());
        Some(SourcePlace::new(&source.name, number as u64, line, from..to))
    }

    /// Every text and key of a layer stays in its line wherever it is written: one that holds a line end could put a line
    /// into a program that nobody wrote.
    fn check_texts(&self, table: &DeTable<'_>, errors: &mut Vec<Diagnostic>) {
        for (key, value) in table {
            self.check_text(key.get_ref(), key.span(), errors);
            self.check_value(value, errors);
        }
    }

    fn check_value(&self, value: &Spanned<DeValue<'_>>, errors: &mut Vec<Diagnostic>) {
        match value.get_ref() {
            DeValue::String(text) => self.check_text(text, value.span(), errors),
            DeValue::Array(items) => {
                for item in items {
                    self.check_value(item, errors);
                }
            }
            DeValue::Table(table) => self.check_texts(table, errors),
            _ => {}
        }
    }

    fn check_text(&self, text: &str, span: Range<usize>, errors: &mut Vec<Diagnostic>) {
        let Some(odd) = text.chars().find(|letter| is_unprintable(*letter)) else {
            return;
        };
        if errors.len() >= MOST_FAULTS {
            return;
        }
        let message = format!(
            "this text holds U+{:04X}, which ends a line, switches something or hides text",
            u32::from(odd)
        );
        let fault = Diagnostic::error("machine-text", message).at(self.place(span));
        errors.push(fault.help("a text of a machine file is one line of what can be read; several lines are a list of texts"));
    }
}

/// The text is a machine file, whatever else may be wrong with it: TOML, with keys of a machine file alone.
fn is_machine(text: &str) -> bool {
    let Ok(table) = DeTable::parse(text) else {
        return false;
    };
    let mut keys = table.get_ref().keys().peekable();
    keys.peek().is_some() && keys.all(|key| is_top_key(key.get_ref()))
}

/// A machine file has this key at its top.
fn is_top_key(name: &str) -> bool {
    MachineFile::KEYS.iter().any(|key| key.name == name) || TAKEN_OUT.contains(&name)
}

/// Settings of parameters must meet parameters that the machine has: a misspelt one would be lost.
fn check_parameters(layer: &DeTable<'_>, merged: &DeTable<'_>) -> Result<(), Box<Diagnostic>> {
    let parameters = |table: &DeTable<'_>| -> Vec<String> {
        table
            .get("parameters")
            .and_then(|value| value.get_ref().as_table())
            .into_iter()
            .flat_map(|table| table.keys().map(|key| key.get_ref().to_string()))
            .collect()
    };
    let known = parameters(merged);
    for name in parameters(layer) {
        if known.contains(&name) {
            continue;
        }
        let help = if known.is_empty() {
            "it has no [parameters]; any other key is set by its full name, such as accuracy.tolerance=0.001"
                .to_owned()
        } else {
            let names: Vec<&str> = known.iter().map(String::as_str).collect();
            format!(
                "{}; any other key is set by its full name, such as accuracy.tolerance=0.001",
                meant(&name, "its parameters are", &names)
            )
        };
        return Err(Diagnostic::error(
            "setting",
            format!("--set {name}: the machine has no parameter of that name"),
        )
        .help(help)
        .boxed());
    }
    Ok(())
}

/// Keys that stand in one another's place: a layer that says one of them takes the other away.
const INSTEAD: &[(&str, &str)] = &[
    ("travel", "cyclic"),
    ("distance", "plane"),
    ("positions", "step"),
    ("share", "reserve"),
    ("linear", "rotary"),
    ("loops", "transfer"),
    ("loops", "pid"),
    ("transfer", "pid"),
    ("screw", "direct"),
    ("gear", "direct"),
    // A body has one shape.
    ("block", "cylinder"),
    ("block", "radius"),
    ("block", "file"),
    ("cylinder", "file"),
    ("radius", "file"),
];

/// Lays a table over another, key by key.
pub(crate) fn overlay<'i>(base: &mut DeTable<'i>, layer: DeTable<'i>) {
    for (one, other) in INSTEAD {
        for (said, unsaid) in [(one, other), (other, one)] {
            let meant =
                layer.get(*said).is_some_and(|value| value.get_ref().as_bool() != Some(false));
            if meant && !layer.contains_key(*unsaid) {
                base.remove(*unsaid);
            }
        }
    }
    lay(base, layer);
}

/// Key by key, none in another's place.
fn lay<'i>(base: &mut DeTable<'i>, layer: DeTable<'i>) {
    for (key, value) in layer {
        let name = key.get_ref().to_string();
        let span = value.span();
        match (base.get_mut(name.as_str()), value.into_inner()) {
            (Some(old), DeValue::Table(table)) if old.get_ref().is_table() => {
                match old.get_mut() {
                    // Names of the user's own: a parameter called gear takes none called direct away.
                    DeValue::Table(old) if name == "parameters" => lay(old, table),
                    DeValue::Table(old) => overlay(old, table),
                    _ => {}
                }
            }
            (_, value) => {
                base.remove(name.as_str());
                base.insert(key, Spanned::new(span, value));
            }
        }
    }
}

fn shifted(span: Range<usize>, start: usize) -> Range<usize> {
    span.start + start..span.end + start
}

/// The table with its spans counted from `start`.
fn moved_table(table: DeTable<'_>, start: usize) -> DeTable<'_> {
    table
        .into_iter()
        .map(|(key, value)| {
            let span = shifted(key.span(), start);
            (Spanned::new(span, key.into_inner()), moved(value, start))
        })
        .collect()
}

fn moved(value: Spanned<DeValue<'_>>, start: usize) -> Spanned<DeValue<'_>> {
    let span = shifted(value.span(), start);
    let inner = match value.into_inner() {
        DeValue::Array(array) => DeValue::Array(
            array.into_iter().map(|item| moved(item, start)).collect::<DeArray<'_>>(),
        ),
        DeValue::Table(table) => DeValue::Table(moved_table(table, start)),
        scalar => scalar,
    };
    Spanned::new(span, inner)
}
