//! The language server of the module: what an editor says, and what it is told.

use std::cell::RefCell;

use post_job::session::Session;
use post_lsp::{Embedded, Options};
use serde_json::{Value, json};

thread_local! {
    /// One for each module, from its first message on.
    static SERVER: RefCell<Option<Embedded>> = const { RefCell::new(None) };
}

/// What the server says to what is `done` with it.
pub fn told(done: impl FnOnce(&mut Embedded)) -> Value {
    SERVER.with_borrow_mut(|server| {
        let server =
            server.get_or_insert_with(|| Embedded::new(Session::quiet(), Options::default()));
        done(server);
        json!({ "messages": server.said() })
    })
}
