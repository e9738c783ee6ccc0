//! A real editor without a screen: Neovim, whose own client speaks to the server.

use std::fs;
use std::process::Command;

use crate::common::assert_contains;

/// Waits for findings, asks for what hovers, and writes both.
const SCRIPT: &str = r#"
local answer = {}
local client = vim.lsp.start_client({ name = "post", cmd = { vim.env.POST_BIN, "lsp" }, root_dir = vim.fn.getcwd() })
vim.lsp.buf_attach_client(0, client)
local function found() return #vim.diagnostic.get(0) > 0 end
answer.waited = vim.wait(30000, found, 50)
for _, finding in ipairs(vim.diagnostic.get(0)) do
  table.insert(answer, { line = finding.lnum, column = finding.col, code = finding.code, message = finding.message })
end
local place = { textDocument = vim.lsp.util.make_text_document_params(0), position = { line = 1, character = 1 } }
local said = vim.lsp.buf_request_sync(0, "textDocument/hover", place, 30000)
answer.hover = said[client].result.contents.value
-- A key is put right in the editor; the server hears of it by an edit of a part.
local line = vim.fn.search("max_fed")
vim.api.nvim_buf_set_text(0, line - 1, 0, line - 1, 7, { "max_feed" })
answer.cleared = vim.wait(30000, function() return #vim.diagnostic.get(0) == 0 end, 50)
vim.fn.writefile({ vim.json.encode({ answer.waited, answer[1], answer.hover, answer.cleared }) }, "answer.json")
vim.lsp.stop_client(client)
vim.cmd("qa!")
"#;

#[test]
fn neovim_shows_findings_and_what_hovers() {
    if Command::new("nvim").arg("--version").output().is_err() {
        assert!(std::env::var_os("CI").is_none(), "there is no nvim");
        eprintln!("skipped: there is no nvim");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let good = fs::read_to_string(crate::common::root().join("machines/vmc.toml")).unwrap();
    let at = good.find("max_feed").unwrap();
    let text = format!("# 𝄞\n{}max_fed{}", &good[..at], &good[at + "max_feed".len()..]);
    let line = text[..text.find("max_fed").unwrap()].matches('\n').count();
    // The second line is one that means something.
    let begin = text.find("name").unwrap();
    let text = format!("# 𝄞\n{}", &text[begin..]);
    let line = line - good[..good.find("name").unwrap()].matches('\n').count();
    fs::write(folder.path().join("mine.toml"), &text).unwrap();
    fs::write(folder.path().join("script.lua"), SCRIPT).unwrap();
    let run = Command::new("nvim")
        .args(["--headless", "--clean", "-n", "mine.toml", "-c", "luafile script.lua"])
        .current_dir(folder.path())
        .env("POST_BIN", env!("CARGO_BIN_EXE_post"))
        .env("XDG_STATE_HOME", folder.path())
        .env("XDG_CACHE_HOME", folder.path())
        .output()
        .unwrap();
    let answer = fs::read_to_string(folder.path().join("answer.json"));
    let answer = answer.unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&run.stderr)));
    let answer: serde_json::Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(answer[0], true, "{answer}");
    assert_eq!(answer[1]["line"], line, "{answer}");
    assert_contains(&answer[1]["message"].to_string(), &["max_fed", "did you mean `max_feed`?"]);
    assert_contains(&answer[2].to_string(), &["What the machine is called"]);
    assert_eq!(answer[3], true, "{answer}");
}
