// Starts `post lsp` and shows what it answers: all else is in the language server.
"use strict";

const { execFile } = require("node:child_process");
const { mkdtemp, readFile, rm } = require("node:fs/promises");
const os = require("node:os");
const path = require("node:path");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function settings() {
  return vscode.workspace.getConfiguration("post");
}

/** What `post check` printed, beside the machine file. */
async function shown(answer) {
  if (!answer) {
    return;
  }
  const language = answer.command === "post.commission" && answer.code === 0 ? "post-nc" : "plaintext";
  const content = [answer.said, answer.printed].filter(Boolean).join("\n");
  const document = await vscode.workspace.openTextDocument({ content, language });
  await vscode.window.showTextDocument(document, { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true });
}

/** Posts the CL file that is shown, and shows its report. */
async function report() {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "post-cl" || document.uri.scheme !== "file") {
    return;
  }
  if (document.isDirty && !(await document.save())) {
    return;
  }
  const machine = settings().get("machine");
  if (!machine) {
    vscode.window.showErrorMessage("post: the setting post.machine names the machine that the file is posted on.");
    return;
  }
  const folder = await mkdtemp(path.join(os.tmpdir(), "post-"));
  try {
    const page = path.join(folder, "report.html");
    const { base: name, name: stem } = path.parse(document.uri.fsPath);
    const program = path.join(folder, `${stem}.nc`);
    const flags = ["--machine", machine, document.uri.fsPath, "-o", program, "--report", page, "--quiet"];
    const length = settings().get("toolLength");
    if (typeof length === "number") {
      flags.push("--tool-length", String(length));
    }
    const cwd = vscode.workspace.getWorkspaceFolder(document.uri)?.uri.fsPath ?? path.dirname(document.uri.fsPath);
    const said = await new Promise((resolve) => {
      execFile(settings().get("command"), flags, { cwd }, (fault, _, stderr) => {
        resolve(fault ? stderr || String(fault) : null);
      });
    });
    if (said !== null) {
      vscode.window.showErrorMessage(`post: ${said.split("\n")[0]}`);
      return;
    }
    const panel = vscode.window.createWebviewPanel("post.report", `Report: ${name}`, vscode.ViewColumn.Beside, {
      enableScripts: true,
      retainContextWhenHidden: true,
      localResourceRoots: [],
    });
    // The page holds all that it shows, and forbids itself the network.
    panel.webview.html = await readFile(page, "utf8");
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

async function activate(context) {
  client = new LanguageClient(
    "post",
    "post",
    {
      command: settings().get("command"),
      args: ["lsp", ...settings().get("arguments")],
    },
    {
      documentSelector: [
        { language: "toml" },
        { language: "post-cl" },
        { language: "post-nc" },
        { pattern: "**/*.{csv,json}" },
      ],
      initializationOptions: { machine: settings().get("machine"), toolLength: settings().get("toolLength") },
      synchronize: { configurationSection: "post" },
      middleware: {
        executeCommand: async (command, parameters, next) => {
          const answer = await next(command, parameters);
          await shown(answer);
          return answer;
        },
      },
    },
  );
  context.subscriptions.push(vscode.commands.registerCommand("post.report", report));
  await client.start();
}

function deactivate() {
  return client?.stop();
}

module.exports = { activate, deactivate };
