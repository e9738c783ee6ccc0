// The worker of VS Code for the Web: messages of the editor go to the module, and what that says goes back.

import { Post } from "../../web/js/module.mjs";

/** How long a text rests before slow work on it begins, ms. */
const REST = 250;

let post;
let rest;

function say({ told }) {
  told.messages.forEach((message) => self.postMessage({ jsonrpc: "2.0", ...message }));
}

/** Posts a CL file, and answers with its report. */
function report({ name, text, flags }) {
  post.put(name, text);
  const { code, findings, said } = post.run([...flags, "-o", "post-report.nc", "--report", "post-report.html", "--quiet"]);
  const fault = findings.find(({ severity }) => severity === "error")?.message ?? said;
  return code === 0 ? { html: post.text("post-report.html") } : { fault };
}

// One after the other: the first compiles the module.
let last = Promise.resolve();

async function take(data) {
  if (data.module) {
    post = await Post.of(await WebAssembly.compile(data.module));
    self.postMessage({ ready: true });
  } else if (data.put) {
    post.put(data.put, data.bytes);
  } else if (data.report) {
    self.postMessage(report(data.report));
  } else {
    say(post.ask({ do: "edit", message: data }));
    clearTimeout(rest);
    rest = setTimeout(() => say(post.ask({ do: "work" })), REST);
  }
}

self.onmessage = ({ data }) => {
  last = last.then(() => take(data));
};
