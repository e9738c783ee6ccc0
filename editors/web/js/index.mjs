// `nc-post`: the command `post` as functions. Each call has a disk of its own, which is gone when it is done.

import { Post } from "./module.mjs";

export { Post, PostFault } from "./module.mjs";

/** Where it writes what is told of a job, and its page. */
const SUMMARY = "post-summary.json";
const REPORT = "post-report.html";

let compiled = null;

/** The module, compiled once: beside this file in Node, from `load` elsewhere. */
async function module() {
  compiled ??= (async () => {
    const url = new URL("./post.wasm", import.meta.url);
    if (url.protocol === "file:" && globalThis.process?.versions?.node) {
      const { readFile } = await import("node:fs/promises");
      return WebAssembly.compile(await readFile(url));
    }
    return WebAssembly.compileStreaming(fetch(url));
  })();
  return compiled;
}

/** Says where the module comes from: its bytes, a WebAssembly.Module, or a Response. */
export async function load(source) {
  const made = async () => {
    const given = await source;
    if (given instanceof WebAssembly.Module) {
      return given;
    }
    return WebAssembly.compile(given instanceof Response ? await given.arrayBuffer() : given);
  };
  compiled = made();
  await compiled;
}

/** `post` with an empty disk. */
export async function open() {
  return Post.of(await module());
}

/** Options as words of the command line: `{ toolLength: 100, mount: [0, 0, 5], set: ["Lm=3", "Lz=4"], plan: true }`. */
export function words(options = {}) {
  const words = [];
  for (const [name, value] of Object.entries(options)) {
    const flag = `--${name.replaceAll("_", "-").replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`)}`;
    if (value === undefined || value === null || value === false) {
      continue;
    }
    const numbers = Array.isArray(value) && value.length > 0 && value.every((one) => typeof one === "number");
    const values = Array.isArray(value) && !numbers ? value : [numbers ? value.join(",") : value];
    for (const one of values) {
      words.push(one === true ? flag : `${flag}=${one}`);
    }
  }
  return words;
}

/** A text that is given: its name, and what it holds. */
function named(given, name) {
  return typeof given === "string" || given instanceof Uint8Array ? { name, content: given } : given;
}

/** A machine is the name of one that is built in, or the text of a file. */
function machineOf(post, machine) {
  if (typeof machine === "string" && !machine.includes("\n")) {
    return machine;
  }
  const { name, content } = named(machine, "machine.toml");
  post.put(name, content);
  return name;
}

async function begin(options) {
  const { progress, files, ...flags } = options;
  const post = await open();
  post.progress = progress ?? post.progress;
  for (const [name, content] of Object.entries(files ?? {})) {
    post.put(name, content);
  }
  return { post, flags };
}

function result(ran) {
  return { ok: ran.code === 0, ...ran };
}

function json(post, file) {
  return post.files().some(([name]) => name === file) ? JSON.parse(post.text(file)) : null;
}

/** Runs any command line of `post` on these files: what came of it, and all files that are there then. */
export async function run(words, files = {}, { progress } = {}) {
  const { post } = await begin({ files, progress });
  const ran = post.run(words);
  const there = post.files().map(([name]) => [name, post.read(name)]);
  return { ...result(ran), files: Object.fromEntries(there) };
}

/** Posts a CL file on a machine: the program, its summary and, if `report` is true, its page. */
export async function post(cl, machine, options = {}) {
  const { report, ...more } = options;
  const { post, flags } = await begin(more);
  const { name, content } = named(cl, "part.cls");
  post.put(name, content);
  // The program is called after its CL file, as the command calls it.
  const nc = name.replace(/(\.[^./]*)?$/, name.endsWith(".nc") ? ".out" : ".nc");
  const line = ["--machine", machineOf(post, machine), name, "-o", nc, "--summary", SUMMARY];
  if (report) {
    line.push("--report", REPORT);
  }
  const ran = post.run([...line, ...words(flags)]);
  const made = ran.code === 0;
  return {
    ...result(ran),
    program: made ? post.read(nc) : null,
    summary: made ? json(post, SUMMARY) : null,
    report: made && report ? post.text(REPORT) : null,
  };
}

/** Holds a program against the CL file that it was made from. */
export async function verify(program, cl, machine, options = {}) {
  const { report, ...more } = options;
  const { post, flags } = await begin(more);
  const [nc, source] = [named(program, "part.nc"), named(cl, "part.cls")];
  post.put(nc.name, nc.content);
  post.put(source.name, source.content);
  const line = ["verify", nc.name, "--machine", machineOf(post, machine), "--against", source.name];
  line.push("--summary", SUMMARY, ...(report ? ["--report", REPORT] : []));
  const ran = post.run([...line, ...words(flags)]);
  const there = post.files().some(([name]) => name === REPORT);
  return { ...result(ran), summary: json(post, SUMMARY), report: there ? post.text(REPORT) : null };
}

async function ofProgram(verb, program, machine, options, file) {
  const { post, flags } = await begin(options);
  const nc = named(program, "part.nc");
  post.put(nc.name, nc.content);
  const line = [verb, nc.name, "--machine", machineOf(post, machine), ...words(flags)];
  const ran = post.run(file ? [...line, "--json", file] : line);
  return { ...result(ran), summary: file ? json(post, file) : null };
}

/** Looks a program over, without a CL file. */
export async function lint(program, machine, options = {}) {
  return ofProgram("lint", program, machine, options, SUMMARY);
}

/** Reads a program: what it makes the machine do. */
export async function read(program, machine, options = {}) {
  return ofProgram("read", program, machine, options, null);
}

/** What a machine file means. */
export async function check(machine, options = {}) {
  const { post, flags } = await begin(options);
  const ran = post.run(["check", machineOf(post, machine), "--json", SUMMARY, ...words(flags)]);
  return { ...result(ran), summary: json(post, SUMMARY) };
}

/** The JSON Schema of machine files. */
export async function schema() {
  const post = await open();
  return JSON.parse(post.run(["schema"]).printed);
}
