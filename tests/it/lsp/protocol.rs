//! The protocol: columns, edits, questions that are taken back, and whatever a broken editor sends.

use std::fmt::Write as _;
use std::time::Duration;

use serde_json::{Value, json};

use super::client::{Client, told};
use crate::common::{assert_contains, root};

const MACHINE: &str = "name = \"𝄞 mill\"
chain = \"[w b X Y Z (S) t]\"
[tool]
gauge = [0, 0, \"h\"] # 𝄞 ä
[parameters]
h = 1
[axis.X]
linear = [1, 0, 0]
travel = [0, 1]
[axis.Y]
linear = [0, 1, 0]
travel = [0, 1]
[axis.Z]
linear = [0, 0, 1]
travel = [0, 1]
[control]
dialect = \"fanuc\"
";

/// A CL file of so many points.
fn long(points: usize) -> String {
    let mut text =
        "TOOL PATH/ONE,TOOL,A\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/100,MMPM\n".to_owned();
    for point in 0..points {
        writeln!(text, "GOTO/{}.5,{}.25,10.125,0,0.1736482,0.9848078", point % 200, point % 97)
            .unwrap();
    }
    text.push_str("END-OF-PATH\nFINI\n");
    text
}

#[test]
fn edits_are_counted_in_utf_16_units() {
    let uri = "file:///nowhere/mill.toml";
    let mut client = Client::new(&[], &json!({}));
    client.open(uri, "toml", MACHINE);
    assert_eq!(client.findings(uri, 1), Vec::<Value>::new());
    // Behind a letter of two units: the `m` of mill stands in column 11.
    client.edit(uri, 2, [0, 11, 0, 15], "m\" # ");
    let found = client.findings(uri, 2);
    assert_eq!(found, Vec::<Value>::new(), "{found:#?}");
    client.edit(uri, 3, [0, 0, 0, 5], "naem ");
    let found = client.findings(uri, 3);
    assert_eq!(told(&found), ["machine-key 0:0-4"]);
    // Several edits in one message, each in the text that the one before left; one reaches behind the end of a line.
    client.tell(
        "textDocument/didChange",
        json!({
            "textDocument": { "uri": uri, "version": 4 },
            "contentChanges": [
                { "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 999 } }, "text": "# 𝄞\nname = \"a\"" },
                { "range": { "start": { "line": 1, "character": 8 }, "end": { "line": 1, "character": 9 } }, "text": "𝄞" },
                { "range": { "start": { "line": 1, "character": 10 }, "end": { "line": 1, "character": 10 } }, "text": "b" },
            ],
        }),
    );
    assert_eq!(client.findings(uri, 4), Vec::<Value>::new());
    // A finding behind letters of more than one byte.
    client.edit(uri, 5, [4, 16, 4, 17], "k");
    let found = client.findings(uri, 5);
    assert_eq!(told(&found), ["machine-expression 4:15-18"], "{found:#?}");
    client.edit(uri, 6, [1, 0, 1, 0], "\"𝄞\" = 1 #");
    let found = client.findings(uri, 6);
    assert!(told(&found).contains(&"machine-key 1:0-4".to_owned()), "{found:#?}");
}

#[test]
fn a_question_is_taken_back_or_overtaken_by_an_edit() {
    let uri = "file:///nowhere/long.cls";
    let mut client = Client::new(&[], &json!({}));
    let text = long(2_000_000);
    client.open(uri, "plaintext", &text);
    let of = json!({ "textDocument": { "uri": uri } });
    // Whether the word comes before the answer is a race on a busy machine: an answer that was quicker is a whole one,
    // and the next text is asked about.
    let mut versions = 2..52;
    let mut given_up = |method: &str, code: i64, word: &dyn Fn(&mut Client, i64, i64)| {
        let found = versions.any(|version| {
            let id = client.put(method, of.clone());
            word(&mut client, id, version);
            let answer = client.answer(id);
            if answer.get("error").is_none() {
                assert!(answer["result"].is_array(), "{answer}");
                client.edit(uri, version, [0, 10, 0, 13], "ONE");
                return false;
            }
            assert_eq!(answer["error"]["code"], code, "{answer}");
            true
        });
        assert!(found, "{method}: every answer came before the word that ends it");
    };
    given_up("textDocument/documentSymbol", -32800, &|client, id, _| {
        client.tell("$/cancelRequest", json!({ "id": id }));
    });
    given_up("textDocument/foldingRange", -32801, &|client, _, version| {
        client.edit(uri, version, [0, 10, 0, 13], "TWO");
    });
    let symbols = client.ask("textDocument/documentSymbol", of);
    assert_eq!(symbols["result"][0]["name"], "TWO");
}

/// While a long file is posted in the background, a question is answered at once, and an edit ends the work.
#[test]
fn what_is_slow_is_done_beside_and_given_up_on_edit() {
    let uri = "file:///nowhere/long.cls";
    let small = "file:///nowhere/mill.toml";
    let mut client = Client::new(&["--machine", "ac-trunnion", "--tool-length", "100"], &json!({}));
    client.open(uri, "plaintext", &long(200_000));
    client.open(small, "toml", MACHINE);
    assert_eq!(client.findings(uri, 1), Vec::<Value>::new());
    // It rests, then it is posted.
    std::thread::sleep(Duration::from_millis(600));
    let mut took: Vec<Duration> = (0..21)
        .map(|line| {
            client.hover(uri, 10 + line, 2);
            client.took
        })
        .collect();
    took.sort();
    assert!(took[10] < Duration::from_millis(250), "{took:?}");
    let mut took: Vec<Duration> = (0..21)
        .map(|_| {
            client.at("completion", small, 8, 0);
            client.hover(small, 3, 16);
            client.took
        })
        .collect();
    took.sort();
    assert!(took[10] < Duration::from_millis(250), "{took:?}");
    // A short text in its place: nothing of the long one is told behind it.
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": [{ "text": "GOTO/1,2\n" }] }),
    );
    let found = client.findings(uri, 2);
    assert_eq!(told(&found).len(), 1, "{found:#?}");
    let late = client.ask("textDocument/codeLens", json!({ "textDocument": { "uri": small } }));
    assert_eq!(late["result"].as_array().unwrap().len(), 2);
    for message in &client.told {
        let params = &message["params"];
        assert!(params["uri"] != uri || params["version"] != 1, "{message}");
    }
    assert_eq!(client.end().0, 0);
}

#[test]
fn whatever_is_sent_it_stays() {
    let uri = "file:///nowhere/mill.toml";
    let mut client = Client::new(&[], &json!({}));
    // Before anything is open.
    let refused = client.ask(
        "textDocument/hover",
        json!({ "textDocument": { "uri": uri }, "position": { "line": 0, "character": 0 } }),
    );
    assert_contains(&refused["error"]["message"].to_string(), &["is not open"]);
    let refused = client.ask("textDocument/hover", json!([1, 2]));
    assert_eq!(refused["error"]["code"], -32602);
    assert_eq!(client.ask("no/such", json!({}))["error"]["code"], -32601);
    client.tell("textDocument/didChange", json!({ "textDocument": 3 }));
    client.tell("textDocument/didClose", json!({ "textDocument": { "uri": "x" } }));
    client.tell("$/cancelRequest", json!({ "id": 99 }));
    client.tell("$/unknown", Value::Null);
    client.edit(uri, 5, [0, 0, 0, 0], "x");
    let commands = [json!("post.check"), json!("rm"), json!(null)];
    for command in commands {
        let refused = client.ask(
            "workspace/executeCommand",
            json!({ "command": command, "arguments": ["file:///etc/passwd"] }),
        );
        assert!(refused.get("error").is_some(), "{refused}");
    }
    // Texts of all kinds, places outside them, ends before beginnings.
    let odd = [
        String::new(),
        "chain".to_owned(),
        "chain = ".to_owned(),
        "chain = \"[w b\u{0}\u{202E}\r\r\n\u{FEFF}\"".to_owned(),
        format!("chain = {}", "[".repeat(20_000)),
        format!("chain = 1\n{}", "a.".repeat(20_000)),
        format!("chain = \"{}\"", "x".repeat(300_000)),
        "chain=1\n[axis]\nX = 1\n[parameters]\na = \"b\"\nb = \"a\"\n".to_owned(),
        "extends = \"/etc/passwd\"\n".to_owned(),
        "extends = \"mill\"\n".to_owned(),
    ];
    let mut version = 1;
    for kind in ["toml", "post-cl", "post-nc"] {
        let uri = format!("untitled:{kind}");
        client.open(&uri, kind, "");
        for text in &odd {
            version += 1;
            client.tell(
                "textDocument/didChange",
                json!({ "textDocument": { "uri": uri, "version": version }, "contentChanges": [{ "text": text }] }),
            );
            for (line, column) in [(0, 0), (0, 8), (1, 3), (u32::MAX, u32::MAX)] {
                let place = json!({
                    "textDocument": { "uri": uri },
                    "position": { "line": line, "character": column },
                    "context": { "includeDeclaration": true, "diagnostics": [], "triggerKind": 1 },
                    "range": { "start": { "line": line, "character": column }, "end": { "line": 0, "character": 0 } },
                    "newName": "q",
                });
                for method in [
                    "hover",
                    "completion",
                    "definition",
                    "references",
                    "prepareRename",
                    "rename",
                    "inlayHint",
                    "codeAction",
                    "codeLens",
                    "documentSymbol",
                    "foldingRange",
                ] {
                    let answer = client.ask(&format!("textDocument/{method}"), place.clone());
                    assert_ne!(answer["error"]["code"], -32603, "{method}: {answer}");
                }
            }
            version += 1;
            client.edit(&uri, version, [3, 9, 0, 1], "\u{1D11E}");
        }
    }
    assert_eq!(client.end().0, 0);
}

#[test]
fn what_is_no_protocol_ends_it_with_a_message() {
    for garbage in [
        "GET / HTTP/1.1\r\n\r\n",
        "Content-Length: 7\r\n\r\n{\"a\": }",
        "Content-Length: x\r\n\r\n",
        "Content-Length: 99999999999999\r\n\r\n{}",
        "Content-Length: 99\r\n\r\n{}",
    ] {
        let mut client = Client::silent(root(), &[]);
        client.raw(garbage.as_bytes());
        let (code, said) = client.gone();
        assert_eq!(code, 1, "{garbage}: {said}");
        assert_contains(&said, &["error[lsp]", "Language Server Protocol"]);
    }
    // An editor that is gone without a word.
    let client = Client::silent(root(), &[]);
    let (code, said) = client.gone();
    assert_eq!(code, 1, "{said}");
}
