// Opens the worker of VS Code for the Web as the extension does, and speaks to it: `node smoke-web.mjs MODULE`.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import vm from "node:vm";
import { build } from "esbuild";

const options = { bundle: true, write: false, target: "es2022", logLevel: "error" };
const bundled = async (entry, more) => (await build({ ...options, entryPoints: [entry], ...more })).outputFiles[0].text;
// What only Node has would stop it.
const extension = await bundled("src/web.js", { platform: "browser", format: "cjs", external: ["vscode"] });
assert.ok(extension.includes("server.js"));
const source = await bundled("src/server.js", { platform: "browser", format: "iife" });

const heard = [];
const waiting = [];
const self = {
  postMessage(message) {
    heard.push(message);
    waiting.splice(0).forEach((look) => look());
  },
};
vm.runInNewContext(source, { self, WebAssembly, TextEncoder, TextDecoder, Uint8Array, setTimeout, clearTimeout });

/** The first message, past or to come, of which this holds. */
async function message(holds) {
  for (;;) {
    const found = heard.find(holds);
    if (found) {
      return found;
    }
    await new Promise((resolve) => waiting.push(resolve));
  }
}

const say = (data) => self.onmessage({ data });
say({ module: readFileSync(process.argv[2]) });
await message(({ ready }) => ready);
const read = (name) => readFileSync(new URL(`../../${name}`, import.meta.url), "utf8");
const machine = read("machines/ac-trunnion.toml");
const room = "/vscode-vfs/github/shop/machines";
say({ put: `${room}/base.toml`, bytes: new TextEncoder().encode(machine) });
const initializationOptions = { machine: `${room}/base.toml`, toolLength: 100 };
say({ jsonrpc: "2.0", id: 1, method: "initialize", params: { capabilities: {}, processId: null, rootUri: null, initializationOptions } });
const { result } = await message(({ id }) => id === 1);
assert.ok(result.capabilities.completionProvider && !result.capabilities.executeCommandProvider);
say({ jsonrpc: "2.0", method: "initialized", params: {} });

/** Opens a text: what is told of it. */
async function open(name, languageId, text, holds) {
  const uri = `file://${room}/${name}`;
  say({ jsonrpc: "2.0", method: "textDocument/didOpen", params: { textDocument: { uri, languageId, version: 1, text } } });
  const told = ({ method, params }) => method === "textDocument/publishDiagnostics" && params.uri === uri && holds(params);
  return (await message(told)).params.diagnostics;
}

// A machine that extends one of the workspace: the slip is told at once.
const own = 'extends = "base.toml"\nname = "ours"\n\n[workpeice]\nmount = [0, 0, 1]\n';
const [slip] = await open("own.toml", "toml", own, ({ diagnostics }) => diagnostics.length > 0);
assert.match(slip.message, /workpeice/);
assert.equal(slip.range.start.line, 3);
// A CL file on the machine of the settings, posted once it has rested: what the axes do stands at its lines.
await open("blade.cls", "post-cl", read("tests/samples/blade.cls"), () => true);
await new Promise((resolve) => setTimeout(resolve, 2000));
const lines = read("tests/samples/blade.cls").split("\n");
const position = { line: lines.findLastIndex((line) => line.startsWith("GOTO")), character: 3 };
say({ jsonrpc: "2.0", id: 2, method: "textDocument/hover", params: { textDocument: { uri: `file://${room}/blade.cls` }, position } });
const hover = (await message(({ id }) => id === 2)).result;
assert.match(JSON.stringify(hover), /\bC\b.*\bA\b|\bA\b.*\bC\b/, JSON.stringify(hover));
say({ report: { name: "blade.cls", text: read("tests/samples/blade.cls"), flags: ["--machine", `${room}/base.toml`, "blade.cls", "--tool-length", "100"] } });
const { html } = await message((one) => one.html || one.fault);
assert.match(html, /^<!doctype html>/);
console.log("the worker answers: faults, axes of a CL file, a report");
