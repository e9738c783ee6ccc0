// Puts together what is published of a module: out/package for npm, and out/post.html, which holds all that it needs.
// `node build.mjs MODULE`

import { createHash } from "node:crypto";
import { cp, mkdir, readdir, readFile, rm, writeFile } from "node:fs/promises";
import path from "node:path";
import { constants, gzipSync } from "node:zlib";

import { Post } from "./js/module.mjs";

const module = process.argv[2];
if (!module) {
  throw new Error("name the module that cargo has made");
}

/** Without sections that only a debugger reads. */
function stripped(bytes) {
  const kept = [bytes.subarray(0, 8)];
  for (let at = 8; at < bytes.length; ) {
    const begin = at;
    const id = bytes[at++];
    let [length, shift] = [0, 0];
    for (;;) {
      const byte = bytes[at++];
      length += (byte & 127) * 2 ** shift;
      shift += 7;
      if (byte < 128) {
        break;
      }
    }
    at += length;
    if (id !== 0) {
      kept.push(bytes.subarray(begin, at));
    }
  }
  return Buffer.concat(kept);
}

const wasm = stripped(await readFile(module));
const compiled = await WebAssembly.compile(wasm);

await rm("out/package", { recursive: true, force: true });
await mkdir("out/package", { recursive: true });
await writeFile("out/package/post.wasm", wasm);
for (const name of ["js/index.mjs", "js/index.d.ts", "js/module.mjs", "package.json", "README.md"]) {
  await cp(name, `out/package/${path.basename(name)}`);
}
for (const name of ["LICENSE-MIT", "LICENSE-APACHE"]) {
  await cp(`../../${name}`, `out/package/${name}`);
}

/** One script of several, the first first: what they take from one another is there without asking. */
async function joined(...names) {
  const texts = await Promise.all(names.map((name) => readFile(name, "utf8")));
  return texts.map((text) => text.replace(/^import .*\n/gm, "").replace(/^export /gm, "")).join("\n");
}

const folder = async (name, ending) => (await readdir(name)).filter((file) => ending.test(file)).sort();
const machines = {};
for (const file of await folder("../../machines", /\.toml$/)) {
  machines[path.parse(file).name] = await readFile(`../../machines/${file}`, "utf8");
}
// The samples that one of these machines makes a program of, and each machine's own.
const samples = [];
for (const [file, machine, options] of JSON.parse(await readFile("page/samples.json", "utf8"))) {
  samples.push({ name: file, text: await readFile(`../../tests/samples/${file}`, "utf8"), machine, options });
}
for (const file of await folder("../../tests/machines", /^[^.]+\.(cls|apt|ncl)$/)) {
  const text = await readFile(`../../tests/machines/${file}`, "utf8");
  samples.push({ name: file, text, machine: path.parse(file).name, options: "--tool-length 100" });
}

// A frame in the page is bound by the page's policy: it has to let the report's own script and style run.
const probe = await Post.of(compiled);
probe.put("part.cls", samples[0].text);
const line = `--machine ${samples[0].machine} part.cls -o part.nc --report part.html ${samples[0].options}`;
const ran = probe.run(line.split(" "));
if (ran.code !== 0) {
  throw new Error(`the sample is refused: ${JSON.stringify(ran)}`);
}
const policy = /script-src ('[^']*'); style-src ('[^']*')/.exec(probe.text("part.html"));

const hashed = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const script = `"use strict";\n(() => {\n${await joined("page/page.mjs", "page/editor.mjs")}\n})();`;
const worker = `"use strict";\n${await joined("js/module.mjs", "page/worker.mjs")}`;
const style = await readFile("page/page.css", "utf8");
const given = JSON.stringify({ machines, samples }).replaceAll("<", "\\u003c");
const packed = gzipSync(wasm, { level: constants.Z_BEST_COMPRESSION });
const policies = [
  "default-src 'none'",
  "connect-src 'none'",
  `script-src ${hashed(script)} ${policy[1]} blob: 'wasm-unsafe-eval'`,
  `style-src ${hashed(style)} ${policy[2]}`,
  "worker-src blob:",
  "frame-src blob:",
  "img-src data:",
  "base-uri 'none'",
  "form-action 'none'",
];
const page = `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policies.join("; ")}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>post in the browser</title>
<link rel="icon" href="data:,">
<style>${style}</style>
</head>
<body>
${await readFile("page/page.html", "utf8")}
<script type="application/json" id="given">${given}</script>
<script type="text/plain" id="worker">${worker}</script>
<script type="text/plain" id="module">${packed.toString("base64")}</script>
<script>${script}</script>
</body>
</html>
`;
await writeFile("out/post.html", page);
const size = (bytes) => `${(bytes / 1e6).toFixed(2)} MB`;
console.log(`out/package/post.wasm: ${size(wasm.length)}, packed ${size(packed.length)}`);
console.log(`out/post.html: ${size(page.length)}`);
