//! The server inside of another program, a page in a browser: a message in, messages out.

use std::sync::{Arc, Mutex, PoisonError};

use lsp_server::{Message, Request, Response};
use serde_json::Value;

use super::Options;
use super::background::{self, Outlet};
use super::server::{Server, about};
use post_job::session::Session;

/// A server without streams.
pub struct Embedded {
    session: Session,
    options: Options,
    /// Once the editor has said what it is.
    server: Option<Server>,
    said: Arc<Mutex<Vec<Message>>>,
}

impl Embedded {
    /// One that waits for `initialize`.
    pub fn new(session: Session, options: Options) -> Self {
        Self { session, options, server: None, said: Arc::default() }
    }

    /// Takes a message of the editor; slow work that follows from it waits for [`Embedded::work`] where there are no
    /// threads. What is none is left out: there is nobody to answer.
    pub fn take(&mut self, message: Value) {
        match (serde_json::from_value(message), &mut self.server) {
            (Ok(Message::Request(request)), server) => match (request.method.as_str(), server) {
                ("initialize", _) => self.begin(request),
                ("shutdown", _) => self.say(Response::new_ok(request.id, Value::Null)),
                (_, Some(server)) => server.request(request),
                (_, None) => {
                    let code = lsp_server::ErrorCode::ServerNotInitialized as i32;
                    self.say(Response::new_err(request.id, code, "not initialized".to_owned()));
                }
            },
            (Ok(Message::Notification(told)), Some(server)) => server.told(told),
            _ => {}
        }
    }

    fn begin(&mut self, request: Request) {
        let said = Arc::clone(&self.said);
        let outlet = Outlet::new(move |message| {
            // A list is whole whatever a thread died of.
            said.lock().unwrap_or_else(PoisonError::into_inner).push(message);
        });
        let options = self.options.clone();
        self.server = Some(Server::new(&self.session, options, outlet, &request.params));
        self.say(Response::new_ok(request.id, about()));
    }

    fn say(&self, message: impl Into<Message>) {
        self.said.lock().unwrap_or_else(PoisonError::into_inner).push(message.into());
    }

    /// Does the slow work that waits.
    pub fn work(&mut self) {
        background::work();
    }

    /// What the server has said since it was asked last.
    pub fn said(&mut self) -> Vec<Message> {
        std::mem::take(&mut *self.said.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
