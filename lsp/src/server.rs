//! The loop: what the editor asks and tells, one message after the other.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use gen_lsp_types::{
    CodeActionParams, CodeLensParams, CompletionParams, DefinitionParams,
    DidChangeConfigurationParams, DidChangeTextDocumentParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, DocumentSymbolParams,
    ExecuteCommandParams, FoldingRangeParams, HoverParams, InlayHintParams, MessageType,
    PrepareRenameParams, ReferenceParams, RenameParams, ShowMessageParams, Uri,
};
use lsp_server::{
    Connection, ErrorCode, Message, Notification, Request, RequestId, Response, ResponseError,
};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::background::{self, Outlet, Token};
use super::document::{Document, FileKind, Snapshot};
use super::machine::library::Library;
use super::tiers::{self, ShownMachine};
use super::{Options, announced, answers, cl, commands, uri};
use post_job::session::Session;

/// Serves an editor until it says that it ends, or is gone.
///
/// # Errors
/// What comes in is no protocol.
pub fn run(session: &Session, connection: &Connection, options: Options) -> Result<(), String> {
    let (id, params) = connection.initialize_start().map_err(|fault| fault.to_string())?;
    connection.initialize_finish(id, about()).map_err(|fault| fault.to_string())?;
    let sender = connection.sender.clone();
    let outlet = Outlet::new(move |message| drop(sender.send(message)));
    let mut server = Server::new(session, options, outlet, &params);
    for message in &connection.receiver {
        match message {
            Message::Request(request) => match connection.handle_shutdown(&request) {
                Ok(true) => break,
                Ok(false) => server.request(request),
                Err(fault) => return Err(fault.to_string()),
            },
            Message::Notification(told) => server.told(told),
            // Nothing is asked of the editor.
            Message::Response(_) => {}
        }
    }
    server.close_all();
    Ok(())
}

/// What the server is, and what it can do.
pub fn about() -> Value {
    json!({
        "capabilities": announced::capabilities(),
        "serverInfo": { "name": "post", "version": env!("CARGO_PKG_VERSION") },
    })
}

/// A question whose answer is worked out in the background.
struct Pending {
    id: RequestId,
    uri: Uri,
    token: Token,
}

/// A server at work.
pub struct Server {
    /// As the command line says.
    started: ShownMachine,
    /// As the editor's settings say over that.
    shown: ShownMachine,
    library: Library,
    documents: BTreeMap<String, Document>,
    pending: Vec<Pending>,
    outlet: Outlet,
}

/// Why a question has no answer.
struct RequestError {
    code: ErrorCode,
    message: String,
}

impl RequestError {
    fn params(message: impl ToString) -> Self {
        Self { code: ErrorCode::InvalidParams, message: message.to_string() }
    }
}

fn params<P: DeserializeOwned>(value: Value) -> Result<P, RequestError> {
    serde_json::from_value(value).map_err(RequestError::params)
}

impl Server {
    /// One for an editor that has asked for it with `params`, and hears through `outlet`.
    pub fn new(session: &Session, options: Options, outlet: Outlet, params: &Value) -> Self {
        let started = ShownMachine { machine: options.machine, tool_length: options.tool_length };
        let mut server = Self {
            shown: started.clone(),
            started,
            library: Library {
                session: session.clone(),
                machines: options.machines,
                plugins: options.plugins,
                open: BTreeMap::new(),
            },
            documents: BTreeMap::new(),
            pending: Vec::new(),
            outlet,
        };
        server.settings(&params["initializationOptions"]);
        server
    }

    /// The editor's settings: `{ "post": { "machine": …, "toolLength": … } }`, or what stands in `post`. What it leaves
    /// open is as the server was started.
    fn settings(&mut self, settings: &Value) {
        let settings = settings.get("post").unwrap_or(settings);
        if let Some(machine) = settings.get("machine") {
            let machine = machine.as_str().map(str::trim);
            let machine = machine.filter(|machine| !machine.is_empty());
            self.shown.machine =
                machine.map(str::to_owned).or_else(|| self.started.machine.clone());
        }
        if let Some(length) = settings.get("toolLength") {
            let length = length.as_f64();
            self.shown.tool_length =
                length.filter(|length| (0.0..=1e6).contains(length)).or(self.started.tool_length);
        }
    }

    /// Answers a question, now or later.
    pub fn request(&mut self, request: Request) {
        let Request { id, method, params } = request;
        // A fault of the program must not take the editor's server away; the question is told.
        let answered = catch_unwind(AssertUnwindSafe(|| self.answer(&id, &method, params)));
        let answered = answered.unwrap_or_else(|_| {
            Err(RequestError {
                code: ErrorCode::InternalError,
                message: format!("{method} failed, which is a fault of post"),
            })
        });
        match answered {
            Ok(Some(result)) => self.outlet.send(Response::new_ok(id, result)),
            // It is answered later.
            Ok(None) => {}
            Err(RequestError { code, message }) => {
                self.outlet.send(Response::new_err(id, code as i32, message));
            }
        }
    }

    /// The answer; none if it comes later.
    fn answer(
        &mut self,
        id: &RequestId,
        method: &str,
        value: Value,
    ) -> Result<Option<Value>, RequestError> {
        let library = &self.library;
        let answer = match method {
            "textDocument/completion" => {
                let asked: CompletionParams = params(value)?;
                let place = asked.text_document_position_params;
                let document = self.document(&place.text_document.uri)?;
                json!(answers::completion(document, place.position, library))
            }
            "textDocument/hover" => {
                let place = params::<HoverParams>(value)?.text_document_position_params;
                let document = self.document(&place.text_document.uri)?;
                json!(answers::hover(document, place.position, library, &self.shown))
            }
            "textDocument/inlayHint" => {
                let asked: InlayHintParams = params(value)?;
                let document = self.document(&asked.text_document.uri)?;
                json!(answers::hints(document, asked.range, library))
            }
            "textDocument/definition" => {
                let place = params::<DefinitionParams>(value)?.text_document_position_params;
                let document = self.document(&place.text_document.uri)?;
                json!(answers::definition(document, place.position, library))
            }
            "textDocument/references" => {
                let asked: ReferenceParams = params(value)?;
                let place = asked.text_document_position_params;
                let document = self.document(&place.text_document.uri)?;
                let all = asked.context.include_declaration;
                json!(answers::references(document, place.position, library, all))
            }
            "textDocument/prepareRename" => {
                let place = params::<PrepareRenameParams>(value)?.text_document_position_params;
                let document = self.document(&place.text_document.uri)?;
                json!(answers::prepare_rename(document, place.position))
            }
            "textDocument/rename" => {
                let asked: RenameParams = params(value)?;
                let place = asked.text_document_position_params;
                let document = self.document(&place.text_document.uri)?;
                answers::rename(document, place.position, &asked.new_name, library)
                    .map_err(RequestError::params)?
            }
            "textDocument/codeAction" => {
                let asked: CodeActionParams = params(value)?;
                let document = self.document(&asked.text_document.uri)?;
                json!(answers::actions(document, asked.range, library))
            }
            "textDocument/codeLens" => {
                let asked: CodeLensParams = params(value)?;
                json!(answers::lenses(self.document(&asked.text_document.uri)?))
            }
            "textDocument/documentSymbol" => {
                let asked: DocumentSymbolParams = params(value)?;
                return self.outline(id, &asked.text_document.uri, |of, token| {
                    cl::outline::symbols(of, token).map(|symbols| json!(symbols))
                });
            }
            "textDocument/foldingRange" => {
                let asked: FoldingRangeParams = params(value)?;
                return self.outline(id, &asked.text_document.uri, |of, token| {
                    cl::outline::folds(of, token).map(|folds| json!(folds))
                });
            }
            "workspace/executeCommand" => return self.execute(id, params(value)?),
            other => {
                return Err(RequestError {
                    code: ErrorCode::MethodNotFound,
                    message: format!("{other} is not known"),
                });
            }
        };
        Ok(Some(answer))
    }

    fn document(&self, uri: &Uri) -> Result<&Document, RequestError> {
        let document = self.documents.get(&uri.0);
        document.ok_or_else(|| RequestError::params(format!("{} is not open", uri.0)))
    }

    /// What needs the whole of a CL file.
    fn outline(
        &mut self,
        id: &RequestId,
        uri: &Uri,
        work: impl FnOnce(&Snapshot, &Token) -> Option<Value> + Send + 'static,
    ) -> Result<Option<Value>, RequestError> {
        let document = self.document(uri)?;
        if document.kind() != Some(FileKind::Cl) {
            return Ok(Some(json!([])));
        }
        let of = Arc::clone(&document.now);
        self.later(id, uri, move |token| Ok(work(&of, token)));
        Ok(None)
    }

    /// Answers from a thread of its own.
    fn later(
        &mut self,
        id: &RequestId,
        uri: &Uri,
        work: impl FnOnce(&Token) -> Result<Option<Value>, String> + Send + 'static,
    ) {
        let token = Token::default();
        self.pending.retain(|pending| !pending.token.is_done());
        self.pending.push(Pending { id: id.clone(), uri: uri.clone(), token: token.clone() });
        let (id, outlet) = (id.clone(), self.outlet.clone());
        background::begin(move || {
            let answer = catch_unwind(AssertUnwindSafe(|| work(&token)));
            let result = match answer {
                Ok(Ok(Some(value))) if !token.is_given_up() => Ok(value),
                Ok(Err(message)) => Err(refusal(ErrorCode::InternalError, message)),
                Err(_) => {
                    Err(refusal(ErrorCode::InternalError, "this is a fault of post".to_owned()))
                }
                _ if token.is_cancelled() => {
                    Err(refusal(ErrorCode::RequestCanceled, "cancelled".to_owned()))
                }
                _ => Err(refusal(
                    ErrorCode::ContentModified,
                    "the text was edited meanwhile".to_owned(),
                )),
            };
            token.done();
            outlet.send(Response { id, response_result: result });
        });
    }

    fn execute(
        &mut self,
        id: &RequestId,
        asked: ExecuteCommandParams,
    ) -> Result<Option<Value>, RequestError> {
        if !commands::NAMES.contains(&asked.command.as_str()) {
            return Err(RequestError::params(format!("no command {}", asked.command)));
        }
        let arguments = asked.arguments.unwrap_or_default();
        let named = arguments.first().and_then(|uri| uri.as_str());
        let uri = Uri(named.unwrap_or_default().to_owned());
        let document = self.document(&uri)?;
        let Some(path) = document.path().filter(|_| document.kind() == Some(FileKind::Machine))
        else {
            return Err(RequestError::params(format!("{} is no machine file", uri.0)));
        };
        if fs::read_to_string(&path).ok().as_ref() != Some(&document.now.text) {
            return Err(RequestError::params(
                "the file is not saved: post check reads it from the disk",
            ));
        }
        let outlet = self.outlet.clone();
        self.later(id, &uri, move |token| {
            let answer = commands::run(&asked.command, &path, token)?;
            if let Some(answer) = &answer {
                say(&outlet, answer);
            }
            Ok(answer)
        });
        Ok(None)
    }

    /// Takes what the editor tells.
    pub fn told(&mut self, told: Notification) {
        let Notification { method, params } = told;
        // What cannot be read is left out: there is nobody to answer.
        let _ = catch_unwind(AssertUnwindSafe(|| self.take(&method, params)));
    }

    fn take(&mut self, method: &str, value: Value) -> Option<()> {
        match method {
            "textDocument/didOpen" => {
                let opened: DidOpenTextDocumentParams = params(value).ok()?;
                let item = opened.text_document;
                let language = json!(item.language_id);
                let language = language.as_str().unwrap_or_default().to_owned();
                let uri = item.uri.clone();
                let document = Document::new(item.uri, language, item.version, item.text);
                self.documents.insert(uri.0.clone(), document);
                self.changed(&uri);
            }
            "textDocument/didChange" => {
                let changed: DidChangeTextDocumentParams = params(value).ok()?;
                let named = changed.text_document;
                let uri = named.text_document_identifier.uri;
                let document = self.documents.get_mut(&uri.0)?;
                document.edit(named.version, changed.content_changes);
                for pending in self.pending.iter().filter(|pending| pending.uri == uri) {
                    pending.token.give_up();
                }
                self.changed(&uri);
            }
            "textDocument/didSave" => {
                let saved: DidSaveTextDocumentParams = params(value).ok()?;
                let document = self.documents.get_mut(&saved.text_document.uri.0)?;
                document.saved = true;
                match document.kind() {
                    // It may be the machine that the others are shown on.
                    Some(FileKind::Machine) => self.again(|kind| kind != FileKind::Machine),
                    Some(FileKind::Nc) => self.changed(&saved.text_document.uri),
                    _ => {}
                }
            }
            "textDocument/didClose" => {
                let closed: DidCloseTextDocumentParams = params(value).ok()?;
                let uri = closed.text_document.uri;
                let document = self.documents.remove(&uri.0)?;
                if let Some(path) = uri::path(&uri) {
                    self.library.open.remove(&path);
                }
                document.slow.close(&document.now, &self.outlet);
            }
            "workspace/didChangeConfiguration" => {
                let changed: DidChangeConfigurationParams = params(value).ok()?;
                self.settings(&json!(changed.settings));
                self.again(|kind| kind != FileKind::Machine);
            }
            "$/cancelRequest" => {
                let id: RequestId = serde_json::from_value(value.get("id")?.clone()).ok()?;
                let pending = self.pending.iter().find(|pending| pending.id == id)?;
                pending.token.cancel();
            }
            _ => {}
        }
        Some(())
    }

    /// A text is new or edited.
    fn changed(&mut self, uri: &Uri) {
        let Some(document) = self.documents.get(&uri.0) else {
            return;
        };
        let is_machine = document.kind() == Some(FileKind::Machine);
        if is_machine && let Some(path) = document.path() {
            self.library.open.insert(path, Arc::clone(&document.now));
        }
        tiers::begin(document, &self.library, &self.shown, &self.outlet);
        if is_machine {
            // Others may extend it.
            for (other, document) in &self.documents {
                if *other != uri.0 && document.kind() == Some(FileKind::Machine) {
                    tiers::begin(document, &self.library, &self.shown, &self.outlet);
                }
            }
        }
    }

    /// What is said of the texts of some kinds is found out again.
    fn again(&self, of: impl Fn(FileKind) -> bool) {
        for document in self.documents.values() {
            if document.kind().is_some_and(&of) {
                tiers::begin(document, &self.library, &self.shown, &self.outlet);
            }
        }
    }

    /// Gives up all that is under way.
    fn close_all(&self) {
        for document in self.documents.values() {
            document.slow.begin(document.now.version).give_up();
        }
        for pending in &self.pending {
            pending.token.cancel();
        }
    }
}

fn refusal(code: ErrorCode, message: String) -> ResponseError {
    ResponseError { code: code as i32, message, data: None }
}

/// Says in a line how a command ended: an editor need not know what to do with the answer.
fn say(outlet: &Outlet, answer: &Value) {
    let good = answer["code"] == 0;
    let text = |key: &str| answer[key].as_str().unwrap_or_default();
    let first = text("said").lines().next().unwrap_or_default();
    let message = match good {
        true => "post check: the machine file is in order".to_owned(),
        false => format!("post check: {first}"),
    };
    let kind = match good {
        true => MessageType::Info,
        false => MessageType::Error,
    };
    outlet.send(Notification::new(
        "window/showMessage".to_owned(),
        ShowMessageParams { kind, message },
    ));
}
