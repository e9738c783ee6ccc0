// Runs command lines beside the page, so that it stays quick, and serves its editor. Whoever cancels ends this worker.

import { Post } from "../js/module.mjs";

/** The compiled module. */
let module;
/** What serves the editor; it stays from message to message. */
let server = null;

/** So much of a file is read at a time, bytes. */
const SLICE = 4 << 20;
/** A text is shown up to here, bytes. */
const SHOWN = 1 << 20;

async function put(post, { name, content }) {
  if (typeof content === "string") {
    post.put(name, content);
    return;
  }
  post.remove(name);
  post.add(name, "");
  for (let at = 0; at < content.size; at += SLICE) {
    post.add(name, new Uint8Array(await content.slice(at, at + SLICE).arrayBuffer()));
  }
}

/** Runs a command line on these files; the files of `wants` come back that are there then. */
async function run({ words, files, wants }) {
  const post = await Post.of(module);
  for (const file of files) {
    await put(post, file);
  }
  let told = 0;
  post.progress = (done, of) => {
    const now = performance.now();
    if (now - told > 50) {
      told = now;
      self.postMessage({ kind: "progress", done, of });
    }
  };
  const ran = post.run(words);
  const made = {};
  for (const name of wants) {
    if (post.files().some(([there]) => there === name)) {
      const blob = new Blob([...post.pieces(name)]);
      made[name] = { blob, begin: await blob.slice(0, SHOWN).text() };
    }
  }
  return { ran, made, memory: post.memory };
}

/** A message of the editor, and what the server has to say to it. */
async function edit({ message }) {
  server ??= await Post.of(module);
  return server.ask(message === null ? { do: "work" } : { do: "edit", message }).told;
}

const KINDS = { run, edit };

// One after the other: a message may wait for a file.
let last = Promise.resolve();
self.onmessage = ({ data }) => {
  if (data.kind === "module") {
    module = data.module;
    return;
  }
  last = last.then(async () => {
    try {
      self.postMessage({ kind: "done", id: data.id, result: await KINDS[data.kind](data) });
    } catch (fault) {
      server = data.kind === "edit" ? null : server;
      self.postMessage({ kind: "fault", id: data.id, message: String(fault.message ?? fault) });
    }
  });
};
