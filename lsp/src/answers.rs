//! A question of the editor, and what is answered at once.

use std::path::PathBuf;

use gen_lsp_types::{
    CodeAction, CodeActionKind, CodeActionResponse, CodeLens, CompletionItem, Contents, Hover,
    InlayHint, Location, MarkupContent, MarkupKind, Position, PrepareRenamePlaceholder,
    Range as LspRange, TextEdit, Uri, WorkspaceEdit,
};
use serde_json::{Map, Value, json};

use super::document::{Document, FileKind, Snapshot};
use super::fixes::Change;
use super::machine::library::Library;
use super::machine::parameters::{self, Member};
use super::machine::{completion, fixes, hints, hover, lenses};
use super::positions::LineStarts;
use super::tiers::ShownMachine;
use super::{cl, findings, nc, uri};

/// What is offered.
pub fn completion(document: &Document, at: Position, library: &Library) -> Vec<CompletionItem> {
    let of = &document.now;
    match document.kind() {
        Some(FileKind::Machine) => completion::items(of, of.lines.byte(&of.text, at), library),
        Some(FileKind::Cl) => cl::completion::items(of, of.lines.byte(&of.text, at)),
        _ => Vec::new(),
    }
}

/// What is said of a place.
pub fn hover(
    document: &Document,
    at: Position,
    library: &Library,
    shown: &ShownMachine,
) -> Option<Hover> {
    let of = &document.now;
    let byte = of.lines.byte(&of.text, at);
    let line = of.lines.line_of(byte);
    let machine = shown.machine.as_deref();
    let (text, range) = match document.kind()? {
        FileKind::Machine => {
            let (text, span) = hover::text(of, byte, library)?;
            (text, Some(of.lines.range(&of.text, span)))
        }
        FileKind::Cl => {
            let posted = document.slow.posted();
            (cl::hover::text(of, line, posted.as_deref(), machine)?, None)
        }
        FileKind::Points => (cl::hover::of_point(line, document.slow.posted().as_deref()?)?, None),
        FileKind::Nc => {
            let program = document.slow.program();
            let map = document.path().and_then(|path| document.map.of(&path));
            let column = byte - of.lines.span(&of.text, line).start;
            let (program, map) = (program.as_deref(), map.as_deref());
            (nc::hover::text(of, line, column, program, map, machine)?, None)
        }
    };
    Some(Hover {
        contents: Contents::MarkupContent(MarkupContent {
            kind: MarkupKind::Markdown,
            value: text,
        }),
        range,
    })
}

/// Values of expressions.
pub fn hints(document: &Document, part: LspRange, library: &Library) -> Vec<InlayHint> {
    let of = &document.now;
    match document.kind() {
        Some(FileKind::Machine) => {
            let start = of.lines.byte(&of.text, part.start);
            let end = of.lines.byte(&of.text, part.end);
            hints::hints(of, &(start..end), library)
        }
        _ => Vec::new(),
    }
}

/// Where the name at a place is defined; of a line of a program the line of the CL file; of `extends` the machine.
pub fn definition(document: &Document, at: Position, library: &Library) -> Vec<Location> {
    let of = &document.now;
    let byte = of.lines.byte(&of.text, at);
    match document.kind() {
        Some(FileKind::Machine) => match parameters::at(&of.text, byte) {
            Some(name) => places(of, &name.name, library, Some(true)),
            None => parent(of, byte, library).into_iter().collect(),
        },
        Some(FileKind::Nc) => came_from(document, of.lines.line_of(byte)).into_iter().collect(),
        _ => Vec::new(),
    }
}

/// The file of the machine that a file extends, if a byte stands in its name.
fn parent(of: &Snapshot, byte: usize, library: &Library) -> Option<Location> {
    let line = of.lines.line_of(byte);
    let written = &of.text[of.lines.span(&of.text, line)];
    if !written.trim_ascii_start().starts_with("extends") {
        return None;
    }
    let parent = parameters::layers(of, library).into_iter().nth(1)?;
    let path = PathBuf::from(&parent.name);
    path.is_file().then(|| Location { uri: uri::of(&path), range: LspRange::default() })
}

/// The line of the CL file that a line of a program, counted from 0, came from.
fn came_from(document: &Document, line: usize) -> Option<Location> {
    let map = document.map.of(&document.path()?)?;
    let cl_line = map.line(line as u64 + 1)?.cl_line?;
    let line = u32::try_from(cl_line.checked_sub(1)?).ok()?;
    let start = Position::new(line, 0);
    Some(Location { uri: uri::of(map.cl.as_deref()?), range: LspRange::new(start, start) })
}

/// Where the parameter at a place is used, and if asked for defined.
pub fn references(
    document: &Document,
    at: Position,
    library: &Library,
    definitions: bool,
) -> Vec<Location> {
    let of = &document.now;
    let byte = of.lines.byte(&of.text, at);
    match document.kind() {
        Some(FileKind::Machine) => parameters::at(&of.text, byte).map_or_else(Vec::new, |name| {
            let which = if definitions { None } else { Some(false) };
            places(of, &name.name, library, which)
        }),
        _ => Vec::new(),
    }
}

/// Places of a parameter in all files that share it; those that define it, those that use it, or all.
fn places(of: &Snapshot, name: &str, library: &Library, defines: Option<bool>) -> Vec<Location> {
    let mut places = Vec::new();
    for member in parameters::family(of, name, library) {
        let Some(uri) = named(&member, of) else {
            continue;
        };
        let text = &member.source.text;
        let lines = LineStarts::of(text);
        for one in parameters::occurrences(text) {
            if one.name == name && defines.is_none_or(|defines| defines == one.defines) {
                places.push(Location { uri: uri.clone(), range: lines.range(text, one.span) });
            }
        }
    }
    places
}

/// The URI of a file; of the text that was asked about its own, whatever it looks like.
fn named(member: &Member, of: &Snapshot) -> Option<Uri> {
    if member.source.name == of.name {
        return Some(of.uri.clone());
    }
    member.path.as_deref().map(uri::of)
}

/// What would be renamed.
pub fn prepare_rename(document: &Document, at: Position) -> Option<PrepareRenamePlaceholder> {
    let of = &document.now;
    if document.kind()? != FileKind::Machine {
        return None;
    }
    let name = parameters::at(&of.text, of.lines.byte(&of.text, at))?;
    Some(PrepareRenamePlaceholder {
        range: of.lines.range(&of.text, name.span),
        placeholder: name.name,
    })
}

/// Renames a parameter in all files that share it.
///
/// # Errors
/// The name is none, or is taken, or a machine that is built in has it.
pub fn rename(
    document: &Document,
    at: Position,
    new: &str,
    library: &Library,
) -> Result<Value, String> {
    let of = &document.now;
    let name = (document.kind() == Some(FileKind::Machine))
        .then(|| parameters::at(&of.text, of.lines.byte(&of.text, at)))
        .flatten()
        .ok_or("no parameter stands here")?
        .name;
    if !parameters::is_name(new) {
        return Err(format!(
            "{new} is no name of a parameter: letters, digits and _, a letter first, and none of the functions"
        ));
    }
    let family = parameters::family(of, &name, library);
    let mut changes = Map::new();
    for member in &family {
        let text = &member.source.text;
        let all = parameters::occurrences(text);
        if all.iter().any(|one| one.defines && one.name == new) {
            return Err(format!("{} has a parameter {new} already", member.source.name));
        }
        let lines = LineStarts::of(text);
        let edits: Vec<TextEdit> = all
            .into_iter()
            .filter(|one| one.name == name)
            .map(|one| TextEdit { range: lines.range(text, one.span), new_text: new.to_owned() })
            .collect();
        if edits.is_empty() {
            continue;
        }
        let Some(uri) = named(member, of) else {
            return Err(format!(
                "{name} is a parameter of {}, which cannot be changed",
                member.source.name
            ));
        };
        changes.insert(uri.0, json!(edits));
    }
    Ok(json!({ "changes": changes }))
}

/// What a click puts right in a part of the text.
pub fn actions(document: &Document, part: LspRange, library: &Library) -> Vec<CodeActionResponse> {
    let of = &document.now;
    let start = of.lines.byte(&of.text, part.start);
    let end = of.lines.byte(&of.text, part.end);
    let fixes = match document.kind() {
        Some(FileKind::Machine) => fixes::fixes(of, &(start..end), library),
        Some(FileKind::Cl) => cl::fixes::fixes(of, &(start..end)),
        _ => Vec::new(),
    };
    fixes
        .into_iter()
        .map(|fix| {
            let Change { span, text } = fix.change;
            let edit = TextEdit { range: of.lines.range(&of.text, span), new_text: text };
            let changes = [(of.uri.clone(), vec![edit])];
            CodeActionResponse::CodeAction(CodeAction {
                title: fix.title,
                kind: Some(CodeActionKind::QuickFix),
                diagnostics: Some(findings::told(&[fix.finding], of)),
                is_preferred: Some(true),
                edit: Some(WorkspaceEdit {
                    changes: Some(changes.into_iter().collect()),
                    ..WorkspaceEdit::default()
                }),
                ..CodeAction::default()
            })
        })
        .collect()
}

/// What can be clicked above the text.
pub fn lenses(document: &Document) -> Vec<CodeLens> {
    match document.kind() {
        // What is no file cannot be checked.
        Some(FileKind::Machine) if document.path().is_some() => lenses::lenses(&document.now),
        _ => Vec::new(),
    }
}
