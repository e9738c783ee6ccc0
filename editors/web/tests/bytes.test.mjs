// The module makes what the command makes, byte for byte: every sample on every machine of the library.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import os from "node:os";
import { test } from "node:test";

import { Post } from "../js/module.mjs";
import { browser, byCommand, each, jobs, module, page, told, words } from "./common.mjs";

const { machines, all } = jobs();
const threads = os.availableParallelism();
const commands = each(all, threads, byCommand);

/** A line for each place it runs in: what was compared. */
function counted(where, wanted, found) {
  const written = wanted.filter(({ code }) => code === 0).length;
  const equal = wanted.filter((one, index) => JSON.stringify(one) === JSON.stringify(found[index])).length;
  console.log(
    `${where}: ${equal} of ${wanted.length} jobs as the command, ${written} of them programs, on ${machines.length} machines`,
  );
  for (const [index, job] of all.entries()) {
    assert.deepEqual(found[index], wanted[index], `${where}: ${job.name} on ${job.machine}`);
  }
  assert.ok(written > 30, `${written} programs`);
}

test("in Node", async () => {
  const compiled = await WebAssembly.compile(readFileSync(module));
  const wanted = await commands;
  const found = [];
  for (const job of all) {
    const post = await Post.of(compiled);
    post.put(job.name, job.cl);
    const { code, printed } = post.run(words(job));
    const there = new Set(post.files().map(([name]) => name));
    const made = (name) => (there.has(name) ? post.read(name) : null);
    found.push(told(code, made("out.nc"), made("out.json"), printed));
  }
  counted("Node", wanted, found);
});

test("in the worker of the page", async (test) => {
  const chromium = await browser(test);
  if (chromium === null) {
    return;
  }
  await chromium.open(page);
  // Module and worker as they stand in the page, under its policy.
  await chromium.ask(`(async () => {
    const packed = Uint8Array.from(atob(document.getElementById("module").textContent), (one) => one.charCodeAt(0));
    const bytes = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
    const source = new Blob([document.getElementById("worker").textContent], { type: "text/javascript" });
    const worker = new Worker(URL.createObjectURL(source));
    worker.postMessage({ kind: "module", module: await WebAssembly.compile(bytes) });
    const hash = async (blob) => [...new Uint8Array(await crypto.subtle.digest("SHA-256", await blob.arrayBuffer()))]
      .map((byte) => byte.toString(16).padStart(2, "0")).join("");
    window.tried = ({ name, cl, words }) => new Promise((resolve, reject) => {
      worker.onmessage = async ({ data }) => {
        if (data.kind === "fault") reject(new Error(data.message));
        if (data.kind !== "done") return;
        const { ran, made } = data.result;
        const of = async (name) => made[name] ? hash(made[name].blob) : null;
        resolve({ code: ran.code, nc: await of("out.nc"), json: await of("out.json"), printed: await hash(new Blob([ran.printed])) });
      };
      worker.postMessage({ kind: "run", id: 0, words, files: [{ name, content: cl }], wants: ["out.nc", "out.json"] });
    });
  })()`);
  const found = [];
  for (const job of all) {
    found.push(await chromium.ask(`tried(${JSON.stringify({ ...job, words: words(job) })})`));
  }
  counted("Chromium", await commands, found);
});
