// The extension in VS Code for the Web: the language server is the module post.wasm in a worker, and no program is started.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/browser");

/** Machine files of a workspace that may be extended by others, at most. */
const MOST_FILES = 500;

let client;
let worker;

function settings() {
  return vscode.workspace.getConfiguration("post");
}

/** The way to a file on the module's disk: files of every kind of workspace lie there beside one another. */
function wayTo(uri) {
  const room = uri.scheme === "file" ? "" : `/${uri.scheme}/${encodeURIComponent(uri.authority)}`;
  return `${room}${uri.path}`;
}

/** As the server knows a file, and back. Its own are those of the scheme `file`. */
const known = new Map();

function toServer(uri) {
  const named = vscode.Uri.from({ scheme: "file", path: wayTo(uri) }).toString();
  known.set(named, uri);
  return named;
}

function fromServer(named) {
  return known.get(named) ?? vscode.Uri.parse(named);
}

/** The machine of the settings: a file of the workspace by the way to it, or the name of one that is built in. */
function machine() {
  const name = settings().get("machine");
  const [folder] = vscode.workspace.workspaceFolders ?? [];
  return name.endsWith(".toml") && folder ? wayTo(vscode.Uri.joinPath(folder.uri, name)) : name;
}

/** Puts a file on the module's disk. */
async function put(uri) {
  worker.postMessage({ put: wayTo(uri), bytes: await vscode.workspace.fs.readFile(uri) });
}

/** Posts the CL file that is shown, and shows its report. */
async function report() {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "post-cl") {
    return;
  }
  if (!machine()) {
    vscode.window.showErrorMessage("post: the setting post.machine names the machine that the file is posted on.");
    return;
  }
  const name = document.uri.path.split("/").pop();
  const flags = ["--machine", machine(), name];
  const length = settings().get("toolLength");
  if (typeof length === "number") {
    flags.push("--tool-length", String(length));
  }
  // A module of its own: the editor is answered meanwhile.
  const page = await begin({ name, text: document.getText(), flags });
  if (page.fault) {
    vscode.window.showErrorMessage(`post: ${page.fault}`);
    return;
  }
  const panel = vscode.window.createWebviewPanel("post.report", `Report: ${name}`, vscode.ViewColumn.Beside, {
    enableScripts: true,
    retainContextWhenHidden: true,
    localResourceRoots: [],
  });
  // The page holds all that it shows, and forbids itself the network.
  panel.webview.html = page.html;
}

let extension;

/** Starts a worker with a module, and with the machine files of the workspace on its disk. */
async function started() {
  const at = (name) => vscode.Uri.joinPath(extension, name);
  const made = new Worker(at("server.js").toString());
  const ready = new Promise((resolve, reject) => {
    made.onmessage = resolve;
    made.onerror = (event) => reject(new Error(event.message));
  });
  made.postMessage({ module: await vscode.workspace.fs.readFile(at("post.wasm")) });
  await ready;
  for (const uri of await vscode.workspace.findFiles("**/*.toml", undefined, MOST_FILES)) {
    made.postMessage({ put: wayTo(uri), bytes: await vscode.workspace.fs.readFile(uri) });
  }
  return made;
}

async function begin(job) {
  const made = await started();
  const answer = new Promise((resolve) => {
    made.onmessage = ({ data }) => resolve(data);
  });
  made.postMessage({ report: job });
  return answer.finally(() => made.terminate());
}

async function activate(context) {
  extension = context.extensionUri;
  worker = await started();
  client = new LanguageClient(
    "post",
    "post",
    {
      documentSelector: [
        { language: "toml" },
        { language: "post-cl" },
        { language: "post-nc" },
        { pattern: "**/*.{csv,json}" },
      ],
      initializationOptions: { machine: machine(), toolLength: settings().get("toolLength") },
      synchronize: { configurationSection: "post" },
      uriConverters: { code2Protocol: toServer, protocol2Code: fromServer },
    },
    worker,
  );
  const files = vscode.workspace.createFileSystemWatcher("**/*.toml", false, false, true);
  files.onDidCreate(put);
  files.onDidChange(put);
  context.subscriptions.push(files, vscode.commands.registerCommand("post.report", report));
  await client.start();
}

async function deactivate() {
  await client?.stop();
  worker?.terminate();
}

module.exports = { activate, deactivate };
