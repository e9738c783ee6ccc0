// Loads the bundled extension in an editor of paper and starts the server with it: `node smoke.cjs POST`.
"use strict";

const { mkdtempSync, writeFileSync } = require("node:fs");
const Module = require("node:module");
const os = require("node:os");
const path = require("node:path");
const { buildSync } = require("esbuild");

const post = process.argv[2];
if (!post) {
  throw new Error("name the program post");
}

/** Whatever is asked of it, it has and can be called. */
function paper() {
  const made = {};
  return new Proxy(function () {}, {
    get(_, key) {
      if (key === "then" || key === Symbol.toPrimitive) {
        return undefined;
      }
      made[key] ??= key === Symbol.iterator ? function* () {} : key === "prototype" ? {} : paper();
      return made[key];
    },
    set(_, key, value) {
      made[key] = value;
      return true;
    },
    construct: paper,
    apply: paper,
  });
}

class EventEmitter {
  listeners = [];
  event = (listener) => {
    this.listeners.push(listener);
    return { dispose() {} };
  };
  fire(what) {
    this.listeners.forEach((listener) => listener(what));
  }
  dispose() {}
}

const commands = [];
const complaints = [];
const complain = (text) => {
  complaints.push(text);
  return Promise.resolve();
};
const editor = paper();
editor.version = "1.85.0";
editor.env = { language: "en", appName: "paper" };
editor.EventEmitter = EventEmitter;
editor.commands.registerCommand = (name) => {
  commands.push(name);
  return { dispose() {} };
};
editor.workspace.workspaceFolders = undefined;
editor.workspace.textDocuments = [];
editor.workspace.notebookDocuments = [];
editor.workspace.getConfiguration = () => ({
  get: (key) => ({ command: post, arguments: [], machine: "vmc", toolLength: null })[key],
});
editor.window.visibleTextEditors = [];
editor.window.activeTextEditor = undefined;
editor.window.createOutputChannel = () => ({
  append: complain,
  appendLine: complain,
  show() {},
  dispose() {},
});
for (const show of ["showErrorMessage", "showWarningMessage", "showInformationMessage"]) {
  editor.window[show] = complain;
}

const load = Module._load;
Module._load = (name, ...rest) => (name === "vscode" ? editor : load(name, ...rest));

const folder = mkdtempSync(path.join(os.tmpdir(), "post-extension-"));
const bundle = path.join(folder, "extension.js");
const built = buildSync({
  entryPoints: ["src/extension.js"],
  bundle: true,
  platform: "node",
  external: ["vscode"],
  write: false,
});
writeFileSync(bundle, built.outputFiles[0].contents);

const late = setTimeout(() => {
  console.error("the server did not start");
  process.exit(1);
}, 30000);

require(bundle)
  .activate({ subscriptions: [] })
  .then(() => {
    clearTimeout(late);
    // The server's own commands are there once it has said what it can do.
    for (const name of ["post.report", "post.check", "post.commission"]) {
      if (!commands.includes(name)) {
        throw new Error(`no command ${name}: ${commands}`);
      }
    }
    if (complaints.length > 0) {
      throw new Error(complaints.join("\n"));
    }
    console.log("the extension starts the server");
    process.exit(0);
  })
  .catch((fault) => {
    console.error(fault);
    console.error(complaints.join("\n"));
    process.exit(1);
  });
