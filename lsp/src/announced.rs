//! What the server says it can do.

use gen_lsp_types::{
    CodeActionKind, CodeActionOptions, CodeLensOptions, CompletionOptions, ExecuteCommandOptions,
    RenameOptions, ServerCapabilities, TextDocumentSyncKind, TextDocumentSyncOptions,
};

use super::commands;

/// Commands run in a process of their own, which a browser has none of.
const STARTS_PROGRAMS: bool = !cfg!(target_family = "wasm");

/// What it can do. Columns are UTF-16, which every editor speaks.
pub fn capabilities() -> ServerCapabilities {
    ServerCapabilities {
        text_document_sync: Some(
            TextDocumentSyncOptions {
                open_close: Some(true),
                change: Some(TextDocumentSyncKind::Incremental),
                save: Some(true.into()),
                ..TextDocumentSyncOptions::default()
            }
            .into(),
        ),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(
                ["[", ".", "\"", "'", " ", "=", "/", ","].map(str::to_owned).to_vec(),
            ),
            ..CompletionOptions::default()
        }),
        hover_provider: Some(true.into()),
        inlay_hint_provider: Some(true.into()),
        definition_provider: Some(true.into()),
        references_provider: Some(true.into()),
        rename_provider: Some(
            RenameOptions { prepare_provider: Some(true), ..RenameOptions::default() }.into(),
        ),
        code_action_provider: Some(
            CodeActionOptions {
                code_action_kinds: Some(vec![CodeActionKind::QuickFix]),
                ..CodeActionOptions::default()
            }
            .into(),
        ),
        code_lens_provider: STARTS_PROGRAMS.then(CodeLensOptions::default),
        document_symbol_provider: Some(true.into()),
        folding_range_provider: Some(true.into()),
        execute_command_provider: STARTS_PROGRAMS.then(|| ExecuteCommandOptions {
            commands: commands::NAMES.map(str::to_owned).to_vec(),
            ..ExecuteCommandOptions::default()
        }),
        ..ServerCapabilities::default()
    }
}
