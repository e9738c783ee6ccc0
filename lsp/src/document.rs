//! A text that is open in the editor.

use std::path::PathBuf;
use std::sync::Arc;

use gen_lsp_types::{TextDocumentContentChangeEvent, Uri};

use super::background::BackgroundFacts;
use super::nc::map::MapCache;
use super::positions::LineStarts;
use super::{cl, machine, nc, uri};

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A machine file.
    Machine,
    /// A cutter-location file.
    Cl,
    /// A list of points in the place of a CL file.
    Points,
    /// An NC program.
    Nc,
}

/// A text at one moment.
#[derive(Debug)]
pub struct Snapshot {
    /// Its URI.
    pub uri: Uri,
    /// Its name for messages and the loader: the path, if it is a file.
    pub name: String,
    /// Counted by the editor.
    pub version: i32,
    /// The text.
    pub text: String,
    /// Its lines.
    pub lines: LineStarts,
}

/// A text that is open.
pub struct Document {
    /// As it is now.
    pub now: Arc<Snapshot>,
    /// It is as it was opened or saved last.
    pub saved: bool,
    /// The language that the editor takes it for.
    language: String,
    /// What is known of it, and what is being found out.
    pub slow: Arc<BackgroundFacts>,
    /// Of a program the map beside it.
    pub map: Arc<MapCache>,
}

/// Endings of lists of points, and of many files besides.
const LISTS: &[&str] = &["csv", "json"];

/// Languages whose headers end like Heidenhain's programs.
const OF_C: &[&str] = &["c", "cpp", "objc", "objcpp", "objective-c", "objective-cpp", "cuda-cpp"];

impl Document {
    /// As it is opened.
    pub fn new(uri: Uri, language: String, version: i32, text: String) -> Self {
        let name = match uri::path(&uri) {
            Some(path) => path.display().to_string(),
            None => uri.0.clone(),
        };
        let lines = LineStarts::of(&text);
        Self {
            now: Arc::new(Snapshot { uri, name, version, text, lines }),
            saved: true,
            language,
            slow: Arc::default(),
            map: Arc::default(),
        }
    }

    /// Takes edits, one after the other, each in the text that the one before it left.
    pub fn edit(&mut self, version: i32, changes: Vec<TextDocumentContentChangeEvent>) {
        let mut text = self.now.text.clone();
        let mut lines = self.now.lines.clone();
        for change in changes {
            match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(part) => {
                    let start = lines.byte(&text, part.range.start);
                    let end = lines.byte(&text, part.range.end).max(start);
                    text.replace_range(start..end, &part.text);
                    lines.edit(&text, &(start..end), part.text.len());
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(whole) => {
                    text = whole.text;
                    lines = LineStarts::of(&text);
                }
            }
        }
        self.now = Arc::new(Snapshot {
            uri: self.now.uri.clone(),
            name: self.now.name.clone(),
            version,
            text,
            lines,
        });
        self.saved = false;
    }

    /// Its path, if it is a file.
    pub fn path(&self) -> Option<PathBuf> {
        uri::path(&self.now.uri)
    }

    /// What it is, by the language that the editor takes it for, by its ending, and of TOML by what it says: there are
    /// other TOML files. None for what is none of ours.
    pub fn kind(&self) -> Option<FileKind> {
        let ending = self.path().and_then(|path| {
            let ending = path.extension()?.to_string_lossy().to_ascii_lowercase();
            Some(ending)
        });
        let ending = ending.as_deref().unwrap_or_default();
        match self.language.as_str() {
            "post-machine" => Some(FileKind::Machine),
            "post-cl" => Some(FileKind::Cl),
            "post-nc" => Some(FileKind::Nc),
            _ if ending == "toml" || self.language == "toml" => {
                machine::is_machine(&self.now.text).then_some(FileKind::Machine)
            }
            language if OF_C.contains(&language) => None,
            _ if cl::ENDINGS.contains(&ending) => Some(FileKind::Cl),
            _ if LISTS.contains(&ending) => {
                post_grammar::is_point_list(&self.now.text).then_some(FileKind::Points)
            }
            _ if nc::ENDINGS.contains(&ending) => Some(FileKind::Nc),
            _ => None,
        }
    }
}
